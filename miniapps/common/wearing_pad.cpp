#include "common/wearing_pad.hpp"

#include "common/hertz_scene.hpp"

#include <cattaneo/input_error.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;

namespace
{

/// How far a parabola wears in the end, over the half-width c of stick: ξ √(ξ² - 1) = (P/P*)
/// arccosh ξ.
double worn_extent(double P_over_held)
{
   double low = 1 + 1e-9, high = 1e3;
   for (int k = 0; k < 200; ++k)
   {
      const double x = std::sqrt(low * high);
      (x * std::sqrt(x * x - 1) > P_over_held * std::acosh(x) ? high : low) = x;
   }
   return low;
}

/// Grid of a contact line |x| < span of so many elements, finer toward ±c, where slip begins.
std::vector<double> grid_about(double c, double span, int elements)
{
   const int outer = std::max(2, elements / 5), inner = elements / 2 - outer;
   const auto toward_c = [](int k, int of)
   { return std::pow(static_cast<double>(k) / of, 1.8); };
   std::vector<double> half = {0}; // from 0 to span
   for (int k = inner - 1; k >= 0; --k) { half.push_back(c - c * toward_c(k, inner)); }
   for (int k = 1; k <= outer; ++k) { half.push_back(c + (span - c) * toward_c(k, outer)); }
   std::vector<double> grid;
   for (std::size_t k = half.size() - 1; k > 0; --k) { grid.push_back(-half[k]); }
   grid.insert(grid.end(), half.begin(), half.end());
   return grid;
}

} // namespace

WearCase pad_on_half_plane(Study &study, const WearingPad &pad, double shear, double friction)
{
   const auto &[profile, flat, poisson, nodes, order] = pad;
   require((nodes - 1) % (2 * order) == 0, "option --nodes is ", nodes,
           ", must be one more than a multiple of twice the order ", order);
   const bool parabola = profile == "parabola";
   const double c = parabola ? std::sqrt(1 - shear) : 1.0,
                span = parabola ? std::max(1.15, 1.1 * c * worn_extent(1 / (1 - shear)))
                                : 1 + 2 * (1 - flat);
   HalfPlanes planes;
   planes.order = order;
   planes.nodes = nodes;
   planes.material = Material{8 / M_PI * (1 - poisson * poisson), poisson, PlaneState::strain};
   planes.grid = grid_about(c, span, (nodes - 1) / order);
   Scene scene = make_scene(planes);
   WearCase result;
   ReducedProblem &problem = result.problem = scene.problem();
   problem.B().setZero(); // equal half-planes: what is there is round-off
   join_coupling(problem);
   set_friction(problem, friction);
   const VectorXd x = problem.position.col(0);
   problem.gap = parabola
                    ? VectorXd(0.5 * x.cwiseAbs2())
                    : VectorXd(0.5 * (x.cwiseAbs().array() - flat).cwiseMax(0.0).square());
   study.condensed(problem, scene.dofs);
   const double Q = shear * friction;
   result.history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"P", 1}, {"Q", Q}}, {{"P", 1}, {"Q", -Q}}, {{"P", 1}, {"Q", Q}}});
   result.history.cycle_start = 2;
   result.middle = 0.5 * (problem.arc_length.minCoeff() + problem.arc_length.maxCoeff());
   return result;
}

} // namespace miniapp
