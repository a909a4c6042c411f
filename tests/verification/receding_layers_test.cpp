#include "common/lap_joint_scene.hpp"
#include "common/receding.hpp"
#include "common/williams.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <record.hpp>
#include <string>

// Frictionless receding contact of layers by a Fourier integral equation, independent of finite
// elements, against the reduced problem; and the eigenvalues of the re-entrant corner.

namespace
{

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Layers
{
   double half_width, peak; // a/h, peak over p0
   VectorXd c;              // of the pressure

   double pressure(double x) const
   {
      const double theta = std::acos(x / half_width);
      double p = 0; // √(1 - s²) U_2j(s) = sin((2j+1)θ)
      for (int j = 0; j < c.size(); ++j) { p += c[j] * std::sin((2 * j + 1) * theta); }
      return p;
   }
};

/** A layer of thickness 1, pressed by p0 = 1 over |x| < w/2 of one side, with its other side on
    its mirror image (two equal layers) or on a similar half-plane, without friction. The slope
    of that side (and the half-plane's) under even pressures p̂(ξ) on it and t̂(ξ) on the outer
    side is proportional to

       ∫ (p̂ (F₁ [+ 1]) - t̂ F₂) sin ξx dξ,   F₁ = (sinh 2ξ + 2ξ)/D,
       F₂ = 2 (sinh ξ + ξ cosh ξ)/D,  D = cosh 2ξ - 1 - 2ξ².

    The pressure √(1 - s²) Σ c_j U_2j(s), s = x/a, has the transform Σ c_j (-1)^j π (2j+1)
    J_2j+1(ξa)/ξ, and its half-plane slope is closed: π (-1)^j sin((2j+1) asin s). c_0 follows
    from the resultant, the others from points where the slope vanishes; at one point more it
    does only for the right a. */
Layers solve_layers(double w, bool half_plane)
{
   constexpr int terms = 20;
   const double step = 0.02, bodies = half_plane ? 2.0 : 1.0;
   VectorXd c(terms);
   auto mismatch = [&](double a)
   {
      MatrixXd M(terms, terms);
      VectorXd x(terms), rhs = VectorXd::Zero(terms);
      for (int i = 0; i < terms; ++i)
      {
         const double angle = 0.5 * M_PI * (i + 0.5) / terms;
         x[i] = a * std::sin(angle);
         for (int j = 0; j < terms; ++j)
         {
            M(i, j) = bodies * M_PI * (j % 2 ? -1.0 : 1.0) * std::sin((2 * j + 1) * angle);
         }
      }
      c[0] = w / (0.5 * M_PI * a);
      rhs = -c[0] * M.col(0);
      for (double xi = 0.5 * step; xi < 30; xi += step)
      {
         const double D = std::cosh(2 * xi) - 1 - 2 * xi * xi;
         const double f1 = (std::sinh(2 * xi) + 2 * xi) / D - 1;
         const double f2 = 2 * (std::sinh(xi) + xi * std::cosh(xi)) / D;
         const double load = 2 * std::sin(0.5 * xi * w) / xi;
         double hats[terms];
         for (int j = 0; j < terms; ++j)
         {
            hats[j] = (j % 2 ? -1.0 : 1.0) * M_PI * (2 * j + 1) *
                      std::cyl_bessel_j(2 * j + 1, xi * a) / xi;
         }
         for (int i = 0; i < terms; ++i)
         {
            const double wave = std::sin(xi * x[i]) * step;
            // Together these two are bounded at ξ = 0: layer and load are in equilibrium.
            rhs[i] += (load * f2 - c[0] * hats[0] * f1) * wave;
            for (int j = 1; j < terms; ++j) { M(i, j) += hats[j] * f1 * wave; }
         }
      }
      const MatrixXd A = M.rightCols(terms - 1);
      c.tail(terms - 1) = A.topRows(terms - 1).partialPivLu().solve(rhs.head(terms - 1)).eval();
      return rhs[terms - 1] - A.row(terms - 1).dot(c.tail(terms - 1));
   };
   // The contact is at least as long as under a point load, and not much longer than the load.
   double lo = half_plane ? 1.2 : 0.8, hi = 0.5 * w + 1.5;
   const bool sign = mismatch(lo) > 0;
   EXPECT_NE(sign, mismatch(hi) > 0);
   for (int k = 0; k < 24; ++k)
   {
      const double mid = 0.5 * (lo + hi);
      ((mismatch(mid) > 0) == sign ? lo : hi) = mid;
   }
   Layers result{0.5 * (lo + hi), 0, c};
   // Under a wide load the pressure is highest near the load's ends.
   for (int k = 0; k < 200; ++k)
   {
      result.peak = std::max(result.peak, result.pressure(result.half_width * k / 200));
   }
   return result;
}

TEST(RecedingLayers, IntegralEquationGivesTheNotedLengths)
{
   // Three decimals of other solutions; the lengths differ by up to 1.4e-3 from this one, which
   // does not change in the fifth decimal with more terms or a finer quadrature.
   const double w[] = {1, 2, 4};
   const double two[] = {1.009, 1.403, 2.392}, two_peak[] = {0.790, 1.0468, 1.0336};
   const double plane[] = {1.431, 1.724, 2.603}, plane_peak[] = {0.618, 0.918, 1.033};
   for (int k = 0; k < 3; ++k)
   {
      Layers found = solve_layers(w[k], false);
      EXPECT_NEAR(found.half_width, two[k], 2e-3);
      EXPECT_NEAR(found.peak, two_peak[k], 1e-3);
      found = solve_layers(w[k], true);
      EXPECT_NEAR(found.half_width, plane[k], 2e-3);
      EXPECT_NEAR(found.peak, plane_peak[k], 1e-3);
   }
   // Point load on a half-plane, and on its mirror image.
   EXPECT_NEAR(solve_layers(1e-3, true).half_width, 1.323, 2e-3);
   EXPECT_NEAR(solve_layers(1e-3, false).half_width, 0.857, 2e-3);
}

TEST(RecedingLayers, LapJointWithLongFreeEndsMatchesTheIntegralEquation)
{
   miniapp::LapJointOptions options;
   options.widths = {0.5, 1, 2}; // w/h = 1, 2, 4 with h = t/2
   options.protrusion = 6;
   miniapp::Scene joint = miniapp::make_lap_joint(options);
   ReducedProblem &problem = joint.reduction.problem;
   set_friction(problem, 0.0);
   FrictionSolver solver(problem);
   EXPECT_TRUE(solver.frictionless());
   for (int k = 0; k < 3; ++k)
   {
      const Layers exact = solve_layers(2 * options.widths[k], false);
      ContactState state = ContactState::virgin(problem);
      const VectorXd loads =
         problem.multipliers({{miniapp::pinch_load(0, options.widths[k]), 1}});
      ASSERT_EQ(solver.solve(state, loads).status, FrictionStatus::converged);
      const Zone contact = contact_zone(problem, state);
      // In units of h: a fifth of the spacing.
      EXPECT_NEAR(contact.to.position - contact.from.position, exact.half_width, 0.005);
      const double peak = tractions(problem, state.p).maxCoeff();
      EXPECT_NEAR(peak, exact.peak, 1e-3);
      const std::string of = std::to_string(1 << k);
      cattaneo_test::record("half_width_" + of, contact.to.position - contact.from.position);
      cattaneo_test::record("peak_" + of, peak);
   }
}

TEST(RecedingLayers, StripOnAHalfPlaneMatchesTheIntegralEquation)
{
   // The end x = L is a plane of symmetry: a load of 2 on an infinite strip. The half-plane
   // itself, and a block of 10⁴ thicknesses.
   const Layers exact = solve_layers(2, true);
   for (const double domain : {0.0, 1e4})
   {
      miniapp::RecedingOptions options;
      options.length = 7;
      options.overhangs = {6};
      options.domain = domain;
      options.corner = options.spacing;
      miniapp::Scene scene = miniapp::make_receding(options);
      ReducedProblem &problem = scene.reduction.problem;
      set_friction(problem, 0.0);
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      ASSERT_EQ(solver.solve(state, VectorXd::Ones(1)).status, FrictionStatus::converged);
      const double half_width = 7 - contact_zone(problem, state).from.position;
      EXPECT_NEAR(half_width, exact.half_width, 0.2 * options.spacing);
      cattaneo_test::record(domain == 0 ? "half_width" : "half_width_on_a_block", half_width);
      // The strip's node on the symmetry plane is free to move sideways and spoils its
      // neighbours.
      const VectorXd p = tractions(problem, state.p);
      for (Eigen::Index i = 0; i < problem.nodes() - 6; ++i)
      {
         const double x = 7 - problem.arc_length[i];
         if (x < 0.9 * exact.half_width) { EXPECT_NEAR(p[i], exact.pressure(x), 3e-3); }
      }
   }
}

/// Roots of sin(3πλ/2) = ±λ: the corner of 270° (Williams 1952).
TEST(Williams, EigenvaluesAndTractionRatiosOfTheReEntrantCorner)
{
   const double alpha = 0.75 * M_PI; // half the solid angle
   for (int mode = 0; mode < 2; ++mode)
   {
      const double sign = mode == 0 ? 1.0 : -1.0;
      auto equation = [&](double l) { return std::sin(2 * alpha * l) - sign * l; };
      double lo = mode == 0 ? 0.3 : 0.8, hi = mode == 0 ? 0.7 : 0.97;
      for (int k = 0; k < 60; ++k)
      {
         const double mid = 0.5 * (lo + hi);
         ((equation(mid) > 0) == (equation(lo) > 0) ? lo : hi) = mid;
      }
      EXPECT_NEAR(lo, miniapp::williams_eigenvalue[mode], 1e-11);
      const std::string of = std::to_string(mode + 1);
      cattaneo_test::record("eigenvalue_" + of, miniapp::williams_eigenvalue[mode]);
      cattaneo_test::record("traction_ratio_" + of, std::abs(miniapp::williams_ratio[mode]));
      // Airy's function r^(λ+1) F(θ), θ from the bisector of the solid, with cosines (mode I)
      // or sines (II) of (λ±1)θ; free faces at ±α. The interface is at θ = α - π/2.
      const double l = lo, t = alpha - 0.5 * M_PI;
      const bool even = mode == 0;
      auto f = [&](double m, double x) { return even ? std::cos(m * x) : std::sin(m * x); };
      auto df = [&](double m, double x)
      { return even ? -m * std::sin(m * x) : m * std::cos(m * x); };
      const double A = -f(l - 1, alpha) / f(l + 1, alpha);
      EXPECT_NEAR(A * df(l + 1, alpha) + df(l - 1, alpha), 0, 1e-9);
      const double normal = l * (l + 1) * (A * f(l + 1, t) + f(l - 1, t));
      const double shear = -l * (A * df(l + 1, t) + df(l - 1, t));
      EXPECT_NEAR(std::abs(shear / normal), std::abs(miniapp::williams_ratio[mode]), 1e-10);
   }
}

} // namespace
