#include "wear/wearing_pad.hpp"

#include "common/hertz_scene.hpp"

#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;

namespace
{

constexpr double modulus = 4 / M_PI; ///< E*, with which a = 1 under P = 1 if R = 1

/** The half-width to which a pad with the flat half-width `flat` between radii 1 is worn in the
    end, if |x| < c sticks and slipping parts carry no force. The share `shear` of P = 1, which
    the unworn contact of half-width c does not carry, presses on it as under a rigid punch.
    Contact grows as a row of such punches (Jäger 1998), dP = E* a arccos(flat/a) da, each of
    which lifts the surface beyond it by (2/πE*) arccosh(x/a) dP. At the border both lifts are
    equal. */
double worn_extent(double flat, double c, double shear)
{
   const auto left = [&](double x) // of the gap that wear must take, over 2/πE*
   {
      // The integrand ends like a square root. With an angle as the variable it is smooth
      // there.
      double gap = 0;
      constexpr int steps = 400;
      for (int k = 0; k < steps; ++k)
      {
         const double angle = M_PI / 2 * (k + 0.5) / steps,
                      a = x - (x - c) * std::cos(angle) * std::cos(angle),
                      da = (x - c) * std::sin(2 * angle) * M_PI / 2 / steps;
         gap += modulus * a * std::acos(flat / a) * std::acosh(x / a) * da;
      }
      return shear * std::acosh(x / c) - gap;
   };
   double low = c, high = 2 * c;
   while (left(high) > 0) { high *= 2; }
   for (int k = 0; k < 60; ++k)
   {
      const double x = 0.5 * (low + high);
      (x > c && left(x) <= 0 ? high : low) = x;
   }
   return high;
}

/// Grid of a contact line |x| < span with the given number of elements, finer toward ±c, where
/// slip begins.
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
   const double b = profile == "parabola" ? 0.0 : flat;
   const auto half_width = [b = b](double P)
   { return fretting::flat_rounded_contact(P, 1, b, modulus).half_width; };
   // The stick zone is the contact under the load that remains beside the shear (Cattaneo,
   // Jäger).
   const double c = half_width(1 - shear), a = half_width(1);
   const double span = std::max(1.15 * a, 1.1 * worn_extent(b, c, shear));
   HalfPlanes planes;
   planes.order = order;
   planes.nodes = nodes;
   planes.material =
      Material{2 * modulus * (1 - poisson * poisson), poisson, PlaneState::strain};
   planes.grid = grid_about(c, span, (nodes - 1) / order);
   Scene scene = make_scene(planes);
   WearCase result;
   ReducedProblem &problem = result.problem = scene.problem();
   problem.B().setZero(); // equal half-planes: the value is round-off
   join_coupling(problem);
   set_friction(problem, friction);
   const VectorXd x = problem.position.col(0);
   problem.gap = 0.5 * (x.cwiseAbs().array() - b).cwiseMax(0.0).square();
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
