#include "common/receding.hpp"

#include "common/contact_grid.hpp"
#include "common/miniapp.hpp"
#include "common/text.hpp"
#include "common/williams.hpp"

#include <algorithm>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void RecedingOptions::validate() const
{
   require(corner > 0 && corner <= spacing, "option --corner is ", corner,
           ", must be above 0 and at most the spacing ", spacing);
   require(growth > 1 && growth <= 2, "growth is ", growth, ", must be above 1 and at most 2");
   require(side == 0 || (side > 1 && domain > 0), "option --side is ", side,
           domain > 0 ? ", must be 0 or above 1 (in t)"
                      : ", belongs to a block: --domain must give its depth");
   require(!overhangs.empty(), "option --overhang has no value, must have at least one");
   for (double n : overhangs)
   {
      require(n > 0 && n < length, "option --overhang or --map: ", n,
              " must be between 0 and the strip's length ", length, " (in t)");
      require(std::count(overhangs.begin(), overhangs.end(), n) == 1, "the overhang ", n,
              " is given twice: each value makes a load pattern, so give it once");
   }
}

std::string overhang_load(double overhang)
{
   return exact_text("n = ", overhang);
}

Scene make_receding(const RecedingOptions &options)
{
   options.validate();
   Scene scene;
   const Material material = unit_material(options.poisson);
   const int bottom = 1, right = 2, top = 3;
   const double L = options.length, growth = options.growth;
   // Elements hold as many intervals between nodes as their order says.
   const double h = options.spacing * options.order;
   double h_corner = options.corner * options.order;

   // Slip and separation lie within 2 t of the load's edge.
   const double n_max = *std::max_element(options.overhangs.begin(), options.overhangs.end());
   const double fine_end = std::min(L, n_max + 2.5);
   std::vector<double> contact = graded(0, fine_end, h_corner, growth, h);
   if (fine_end < L) { contact = joined({contact, graded(fine_end, L, h, growth)}); }
   if (!options.grid.empty())
   {
      contact = options.grid;
      h_corner = smallest_step(contact);
   }
   const auto refined = [&](mfem::Mesh mesh, int body)
   {
      if (options.refine) { options.refine(mesh, body); }
      return mesh;
   };

   mfem::Mesh above =
      rectangle_mesh(contact, graded(0, 1, h_corner, growth, 0.4 * (growth - 1)));
   ElasticBody &strip = scene.add(refined(std::move(above), 0), options.order, material);
   for (double n : options.overhangs)
   {
      strip.add_pressure(overhang_load(n), BoundaryPart({top}, 0, n, L), 1.0);
   }
   // The contact node at the end of the line stays free: a contact dof cannot be fixed, and L
   // is far from the zones of interest.
   const double clear = 0.4 * h_corner / options.order;
   strip.fix(BoundaryPart({right}, 1, clear, 1), 0);

   CondensedBody upper = condense(strip, contact_line(strip, bottom), condensation());
   if (options.domain == 0)
   {
      HalfPlane below;
      below.material = material;
      below.point = {L, 0};
      below.symmetric = true;
      below.depth = 1e3 * L;
      scene.reduction = reduce(std::move(upper), below);
      return scene;
   }
   const double side = options.side > 0 ? options.side : options.domain;
   std::vector<double> outside = graded(0, -side, contact[1] - contact[0], growth);
   std::reverse(outside.begin(), outside.end());
   std::vector<double> depth = graded(0, -options.domain, h_corner, growth);
   std::reverse(depth.begin(), depth.end());
   ElasticBody &block = scene.add(refined(rectangle_mesh(joined({outside, contact}), depth), 1),
                                  options.order, material);
   block.fix(bottom, 1);
   block.fix(BoundaryPart({right}, 1, -options.domain, -clear), 0);

   scene.reduction =
      stacked(std::move(upper), block, contact_line(block, BoundaryPart({top}, 0, 0, L)));
   return scene;
}

BondedTractions bonded_tractions(const ReducedProblem &problem, double overhang)
{
   BondedTractions result;
   const LoadPattern &load = problem.patterns[problem.pattern(overhang_load(overhang))];
   result.p = tractions(problem, load.p);
   result.q = tractions(problem, load.q);
   const VectorXd &x = problem.arc_length;
   // The last few nodes at the corner never converge. The fit starts well away from them, so
   // that their error remains small.
   const Index skip = 8;
   Index first = skip, last = skip;
   while (first < x.size() && x[first] < 0.005) { ++first; }
   while (last < x.size() && x[last] <= 0.05) { ++last; }
   MatrixXd both(x.size(), 2);
   both << result.p, result.q;
   const Index count = std::max<Index>(0, last - first);
   result.strengths =
      williams_strengths(x.segment(first, count), both.middleRows(first, count));
   result.corner_ratio = result.strengths(0, 1) / result.strengths(0, 0);

   // At the corner itself the exact ratio replaces that of the nodes.
   result.adhesion_friction = williams_ratio[0];
   result.lowest_pressure = std::numeric_limits<double>::infinity();
   for (Index i = skip; i < x.size(); ++i)
   {
      result.lowest_pressure = std::min(result.lowest_pressure, result.p[i]);
      const double ratio = std::abs(result.q[i]) / result.p[i];
      if (result.p[i] > 0 && ratio > result.adhesion_friction)
      {
         result.adhesion_friction = ratio;
         result.adhesion_x = x[i];
      }
   }
   if (result.lowest_pressure <= 0)
   {
      result.adhesion_friction = std::numeric_limits<double>::infinity();
   }
   return result;
}

PointHistory::PointHistory(double xi_, const VectorXd &positions, const VectorXd &slip_)
   : xi(xi_), positions_(positions)
{
   (positions.array() - xi).abs().minCoeff(&node);
   slip.push_back(interpolated(slip_));
}

double PointHistory::interpolated(const VectorXd &of) const
{
   const VectorXd &x = positions_;
   Index k = 1;
   while (k + 1 < x.size() && x[k] < xi) { ++k; }
   return of[k - 1] + (of[k] - of[k - 1]) * (xi - x[k - 1]) / (x[k] - x[k - 1]);
}

void PointHistory::note(double now, const VectorXd &slip_, NodeState status)
{
   // The change occurs during the step; its middle is taken.
   const double before = level.back(), change = 0.5 * (now + before);
   level.push_back(now);
   slip.push_back(interpolated(slip_));
   step = std::max(step, 0.5 * (before - now));
   if (slips(status) && !std::isfinite(slips_from)) { slips_from = change; }
   if (!closed(status) && !std::isfinite(separates_at)) { separates_at = change; }
}

} // namespace miniapp
