#include "common/hertz_scene.hpp"

#include "common/contact_grid.hpp"
#include "common/miniapp.hpp"

#include <cattaneo/algebra/least_squares.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;

namespace
{

/// Loads of a body whose face of attribute `top`, of half-width L at height H above the
/// contact, takes P as pressure and Q as shear with the linear pressure that balances its
/// moment. `turn` is -1 for the body below, the half-turn image of the one above.
void load(ElasticBody &body, int top, double L, double H, double P, double turn)
{
   body.add_pressure("P", top, P / (2 * L));
   body.add_traction("Q", top, turn * P / (2 * L), 0.0);
   const double slope = -turn * 1.5 * P * H / (L * L * L);
   body.add_pressure("Q", top, [=](double x, double) { return slope * x; });
}

} // namespace

void HalfPlanes::validate() const
{
   require(!grid.empty() || (nodes >= 9 && (nodes - 1) % order == 0), "option --nodes is ",
           nodes, ", must be at least 9 and one more than a multiple of the order ", order);
   check_growth(growth);
   require(half_width > 0 && load > 0, "the half-width ", half_width, " and the load ", load,
           " of the contact must be positive");
}

Scene make_scene(const HalfPlanes &options)
{
   options.validate();
   Scene scene;
   const double domain = options.domain * options.half_width;
   const std::vector<double> contact =
      options.grid.empty() ? graded_to_ends(options.span * options.half_width,
                                            (options.nodes - 1) / options.order, 1.0)
                           : options.grid;
   if (options.domain == 0)
   {
      HalfPlane pad, specimen;
      pad.material = specimen.material = options.material;
      pad.depth = specimen.depth = 1e4 * contact.back();
      pad.normal = {0, 1};
      pad.forces = {{"P", {0, -options.load}}, {"Q", {options.load, 0}}};
      if (options.bulk) { specimen.bulk = {{"bulk", 1.0}}; }
      if (options.bulk_pad) { pad.bulk = {{"bulk pad", 1.0}}; }
      scene.reduction = reduce(condense(pad, contact, options.order), specimen);
      return scene;
   }
   const double span = contact.back(), h = smallest_step(contact),
                growth = element_growth(options.growth, options.order);
   const std::vector<double> depth = graded(0, span, h, growth, 0.8 * (growth - 1) * span);
   const std::vector<double> rings = ring_scales(span, domain, h, growth);
   const int surface = 1, far = 3, sides = 4;
   std::vector<CondensedBody> condensed;
   for (double turn : {-1.0, 1.0}) // the mesh is the lower body, its half-turn the upper one
   {
      mfem::Mesh mesh = half_plane_mesh(contact, depth, rings);
      ElasticBody &body = scene.add(turn > 0 ? std::move(mesh) : half_turn(std::move(mesh)),
                                    options.order, options.material);
      load(body, far, domain, domain, options.load, -turn);
      const bool specimen = turn > 0;
      if (specimen ? options.bulk : options.bulk_pad)
      {
         body.add_traction(
            specimen ? "bulk" : "bulk pad", sides,
            [](double x, double) { return x > 0 ? 1.0 : -1.0; }, 0.0);
      }
      const ContactLine line = contact_line(body, surface);
      condensed.push_back(condense(body, line, condensation(),
                                   condensed.empty() ? nullptr : &condensed.front()));
   }
   const Pairing pairing = pair_lines(condensed[0].line, condensed[1].line);
   scene.reduction = reduce(condensed[0], condensed[1], pairing);
   return scene;
}

Scene make_scene(const BlockOnHalfPlane &options)
{
   Scene scene;
   const double growth = 1.25;
   const std::vector<double> contact =
      graded_to_ends(1.0, (options.nodes - 1) / options.order, 1.0);
   const double h = contact[1] - contact[0];
   const int bottom = 1, top = 3;
   ElasticBody &block = scene.add(rectangle_mesh(contact, graded(0, 2, h, growth, 0.1)),
                                  options.order, options.material);
   load(block, top, 1, 2, options.load, 1);
   CondensedBody above = condense(block, contact_line(block, bottom), condensation());
   if (options.domain == 0)
   {
      HalfPlane plane;
      plane.material = options.material;
      plane.depth = 1e4;
      scene.reduction = reduce(std::move(above), plane);
      return scene;
   }
   ElasticBody &plane = scene.add(half_plane_mesh(contact, graded(0, 1, h, growth, 0.1),
                                                  ring_scales(1, options.domain, h, growth)),
                                  options.order, options.material);
   const int surface = 1, far = 3;
   for (int component : {0, 1}) { plane.fix(far, component); }
   scene.reduction = stacked(std::move(above), plane, contact_line(plane, surface));
   return scene;
}

double peak_pressure(const ReducedProblem &problem, const ContactState &state,
                     double half_width)
{
   const Eigen::VectorXd p = tractions(problem, state.p), x = problem.position.col(0);
   Eigen::Index top = 0;
   p.maxCoeff(&top);
   Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(x.size(), 3), squares = rows.leftCols(1);
   for (Eigen::Index i = 0; i < x.size(); ++i)
   {
      const double s = (x[i] - x[top]) / half_width, weight = std::sqrt(problem.weights[i]);
      if (std::abs(s) > 0.5) { continue; }
      rows.row(i) << weight, weight * s, weight * s * s;
      squares(i, 0) = weight * p[i] * p[i];
   }
   const Eigen::MatrixXd c = least_squares(rows, squares);
   return std::sqrt(c(0) - c(1) * c(1) / (4 * c(2)));
}

Deviation deviation(const ReducedProblem &problem, const Eigen::VectorXd &nodal_forces,
                    double scale, const std::function<double(double)> &exact)
{
   const Eigen::VectorXd traction = tractions(problem, nodal_forces),
                         x = problem.position.col(0);
   Deviation result;
   for (Eigen::Index i = 0; i < x.size(); ++i)
   {
      const double d = std::abs(traction[i] - exact(x[i])) / scale;
      result.largest = std::max(result.largest, d);
      result.mean += problem.weights[i] / problem.weights.sum() * d * d;
   }
   result.mean = std::sqrt(result.mean);
   return result;
}

} // namespace miniapp
