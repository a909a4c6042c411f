//  benchmark_scaling: time and memory against dofs, contact nodes and cycles, with exponents
//
//  Condensation of a square of quadratic elements, 1e4 to 2e6 dofs, to 201 contact nodes; a
//  block on a block twice as stiff, 51 to 4001 contact nodes, from mesh to reduced problem, and
//  its friction steps in partial slip; a punch in 1 to 1000 cycles. In space: a cube and a
//  plate of linear hexahedra, 3e4 to 3e5 dofs, to 961 contact nodes. Each row is a process of
//  its own. Times are CPU time, on one thread; exponents are fitted to all rows.

#include "common/figure.hpp"
#include "common/measure.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"
#include "common/punch.hpp"

#include <cattaneo/contact/boundary_surface.hpp>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

double cpu_seconds()
{
   timespec now{};
   clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
   return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A table whose rows are measured one by one and printed as they come.
class PrintedTable
{
public:
   PrintedTable(const char *title, std::vector<const char *> columns)
      : title_(title), columns_(std::move(columns)), data_(columns_.size() + 1)
   {
      std::printf("\n%s\n", title);
      for (const char *column : columns_) { std::printf(" %14s", column); }
      std::printf(" %14s\n", "MB");
   }
   /// The work returns the values of the columns.
   void row(const std::function<std::vector<double>()> &work)
   {
      const Measured m = in_own_process(work);
      require(m.ok && m.values.size() == columns_.size(), title_, ": a row failed");
      for (std::size_t k = 0; k < columns_.size(); ++k)
      {
         std::printf(" %14.6g", m.values[k]);
         data_[k].push_back(m.values[k]);
      }
      std::printf(" %14.0f\n", m.megabytes);
      std::fflush(stdout);
      data_.back().push_back(m.megabytes);
   }
   /// Exponents against the first column, and the panel of the columns from `first` on that
   /// `shown` names.
   miniapp::Panel finish(const char *name, const std::vector<int> &shown) const
   {
      miniapp::Panel panel(miniapp::Panel::Kind::lines, name, title_, columns_[0],
                           "seconds (CPU time)");
      panel.say("scale", "loglog");
      std::printf("%15s", "exponent");
      for (std::size_t k = 1; k < data_.size(); ++k)
      {
         std::printf(" %14.2f", log_slope(data_[0], data_[k]));
      }
      std::printf("\n");
      for (int k : shown) { panel.add(columns_[k], data_[0], data_[k]); }
      return panel;
   }

private:
   std::string title_;
   std::vector<const char *> columns_;
   std::vector<std::vector<double>> data_;
};

std::vector<double> condensation(int side)
{
   const double began = cpu_seconds();
   mfem::Mesh mesh =
      mfem::Mesh::MakeCartesian2D(side, side, mfem::Element::QUADRILATERAL, true, 1.0, 1.0);
   ElasticBody body(mesh, 2, Material{1.0, 0.3});
   for (int component : {0, 1}) { body.fix(3, component); }
   const double assembled = cpu_seconds();
   // 200 intervals between nodes, or all if there are fewer.
   const double length = std::min(1.0, 100.0 / side);
   const CondensedBody condensed =
      condense(body, contact_line(body, BoundaryPart({1}, 0, 0, length)));
   const double done = cpu_seconds();
   return {double(body.dofs()), double(condensed.line.size()), assembled - began,
           done - assembled, done - began};
}

/// A block of `side` × `side` × `layers` cubes that stands on its base, to a square of
/// 31 × 31 contact nodes in the middle of its top.
std::vector<double> condensation_in_space(int side, int layers)
{
   const double began = cpu_seconds();
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian3D(side, side, layers, mfem::Element::HEXAHEDRON,
                                                 side, side, layers);
   const int base = 1, top = 6, contact = 7, faces = 30;
   const double first = (side - faces) / 2, last = first + faces;
   for (int face = 0; face < mesh.GetNBE(); ++face)
   {
      if (mesh.GetBdrAttribute(face) != top) { continue; }
      mfem::Array<int> corners;
      mesh.GetBdrElementVertices(face, corners);
      bool within = true;
      for (const int corner : corners)
      {
         for (int axis : {0, 1})
         {
            const double at = mesh.GetVertex(corner)[axis];
            within = within && at > first - 0.5 && at < last + 0.5;
         }
      }
      if (within) { mesh.SetBdrAttribute(face, contact); }
   }
   mesh.SetAttributes();
   ElasticBody body(mesh, 1, Material{1.0, 0.3});
   for (int component : {0, 1, 2}) { body.fix(base, component); }
   const double assembled = cpu_seconds();
   const CondensedBody condensed = condense(body, contact_surface(body, contact));
   const double done = cpu_seconds();
   return {double(body.dofs()), double(condensed.nodes()), assembled - began, done - assembled,
           done - began};
}

std::vector<double> pair_of_blocks(int nodes)
{
   const double began = cpu_seconds();
   const std::vector<double> x = graded_to_ends(1, (nodes - 1) / 2, 1);
   const std::vector<double> up = graded(0, 1, x[1] - x[0], 1.5, 0.1);
   std::vector<double> down;
   for (auto y = up.rbegin(); y != up.rend(); ++y) { down.push_back(-*y); }
   down.back() = 0;
   mfem::Mesh upper_mesh = rectangle_mesh(x, up), lower_mesh = rectangle_mesh(x, down);
   ElasticBody upper(upper_mesh, 2, Material{1.0, 0.3}),
      lower(lower_mesh, 2, Material{2.0, 0.3});
   const int bottom = 1, top = 3;
   upper.add_pressure("P", top, 0.5);
   upper.add_traction("Q", top, 0.5, 0.0);
   upper.add_pressure("Q", top, [](double s, double) { return -1.5 * s; });
   for (int component : {0, 1}) { lower.fix(bottom, component); }
   const double dofs = upper.dofs() + lower.dofs();
   const ContactLine above = contact_line(upper, bottom), below = contact_line(lower, top);
   Reduction reduction =
      reduce(condense(upper, above), condense(lower, below), pair_lines(above, below));
   const double f = 0.4;
   set_friction(reduction.problem, f);
   const double reduced = cpu_seconds();

   FrictionSolver solver(reduction.problem);
   ContactState state = ContactState::virgin(reduction.problem);
   const auto step = [&](double shear)
   {
      const IncrementReport report = solver.solve(state, Vector2d(1, shear * f));
      require(report.status == FrictionStatus::converged, nodes, " nodes, Q/fP = ", shear, ": ",
              report.message);
   };
   step(0);
   step(0.7);
   const double pressed = cpu_seconds();
   const Counters before = solver.counters();
   const int steps = 5;
   for (int k = 1; k <= steps; ++k) { step(0.7 + 0.05 * k); }
   const double a_step = (cpu_seconds() - pressed) / steps;
   Counters counters = solver.counters();
   counters -= before;
   return {double(nodes),
           dofs,
           reduced - began,
           pressed - reduced,
           a_step,
           double(counters.newton_steps) / steps,
           double(counters.sweeps) / steps,
           double(counters.dense_factorisations) / steps};
}

std::vector<double> cycling(int cycles)
{
   miniapp::PunchOptions options;
   options.nodes = 101;
   miniapp::Scene punch = miniapp::make_punch(options);
   set_friction(punch.reduction.problem, 0.2);
   FrictionSolver solver(punch.reduction.problem);
   const double Q = 0.16;
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, Q), Vector2d(1, -Q), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   std::vector<double> values{double(cycles)};
   for (const bool all : {true, false})
   {
      MarchSettings settings;
      settings.increments_of_piece = {1, 5, 10, 5};
      settings.stop_at_steady_state = !all;
      ContactState state = ContactState::virgin(punch.reduction.problem);
      const double began = cpu_seconds();
      const MarchReport report = march(solver, history, state, settings);
      require(report.status == FrictionStatus::converged, "cycles: ", report.message);
      values.push_back(cpu_seconds() - began);
      values.push_back(static_cast<double>(report.counters.increments));
   }
   return values;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         std::string csv, picture;
         double largest = 2e6;
         int most = 4001;
         miniapp::Options args("benchmarks/benchmark_scaling.cpp", argc, argv);
         args.add(&largest, "dofs", "Largest number of dofs.");
         args.add(&most, "nodes", "Largest number of contact nodes.");
         args.add(&csv, "csv", "Prefix of the panels' files.", miniapp::Text::prefix);
         args.add(&picture, "plot", "File for the picture.", miniapp::Text::picture);
         args.parse();
         std::vector<miniapp::Panel> panels;
         const std::vector<const char *> columns = {"dofs", "contact nodes", "assembly s",
                                                    "condensation s", "whole s"};
         {
            PrintedTable table("Condensation of a square to 201 contact nodes or fewer",
                               columns);
            for (int side : {35, 70, 112, 223, 353, 500})
            {
               if (2.0 * (2 * side + 1) * (2 * side + 1) > 1.01 * largest) { continue; }
               table.row([=] { return condensation(side); });
            }
            panels.push_back(table.finish("dofs", {2, 3}));
         }
         const auto in_space = [&](const char *name, const char *title,
                                   const std::vector<std::pair<int, int>> &sizes)
         {
            PrintedTable table(title, columns);
            for (const auto &[side, layers] : sizes)
            {
               if (3.0 * (side + 1) * (side + 1) * (layers + 1) > 1.05 * largest) { continue; }
               table.row([side = side, layers = layers]
                         { return condensation_in_space(side, layers); });
            }
            panels.push_back(table.finish(name, {2, 3}));
         };
         in_space("cube", "Condensation of a cube of linear hexahedra to 961 contact nodes",
                  {{32, 32}, {36, 36}, {46, 46}});
         in_space("plate", "Condensation of a plate of 8 linear hexahedra to 961 contact nodes",
                  {{32, 8}, {52, 8}, {74, 8}, {104, 8}});
         {
            PrintedTable table("Two blocks: contact nodes",
                               {"contact nodes", "dofs", "to reduced s", "first steps s",
                                "warm step s", "newton/step", "sweeps/step", "dense/step"});
            for (int nodes : {51, 101, 251, 501, 1001, 2001, 4001})
            {
               if (nodes <= most)
               {
                  table.row([=] { return pair_of_blocks(nodes); });
               }
            }
            panels.push_back(table.finish("nodes", {2, 4}));
         }
         {
            PrintedTable table(
               "Cycles of 20 increments, 101 nodes, Q = 0.8 fP to and fro",
               {"cycles", "all s", "increments", "till steady s", "increments"});
            for (int cycles : {1, 10, 100, 1000})
            {
               table.row([=] { return cycling(cycles); });
            }
            panels.push_back(table.finish("cycles", {1, 3}));
         }
         miniapp::draw(panels, csv, picture);
         return 0;
      });
}
