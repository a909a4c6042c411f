#include "comparison.hpp"

#include <Eigen/Dense>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/fatigue_material.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/threshold.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace
{

using namespace cattaneo::fretting;

/** K_I of an edge crack of depth c under the line stress σ(y), from distributed edge
    dislocations in the half-plane. The crack is mapped by y = c ((1+s)/2)^6, which smooths the
    corner exponents and the √y of the load at the mouth. */
template <class Function>
double dislocation_intensity(const Function &line_stress, double c)
{
   const int n = 120;
   const double grading = 6;
   const auto map = [&](double s) { return std::pow(0.5 * (1 + s), grading); };
   Eigen::MatrixXd influence(n, n);
   Eigen::VectorXd load(n), node(n);
   for (int i = 0; i < n; i++) { node[i] = std::cos((2 * i + 1) * pi / (2 * n + 1)); }
   for (int k = 0; k < n; k++)
   {
      const double x = map(std::cos(2 * (k + 1) * pi / (2 * n + 1)));
      load[k] = -pi * line_stress(c * x);
      for (int i = 0; i < n; i++)
      {
         const double y = map(node[i]), sum = x + y;
         const double kernel =
            1 / (y - x) - 1 / sum + 6 * x / (sum * sum) - 4 * x * x / (sum * sum * sum);
         influence(k, i) = 2 * pi * (1 + node[i]) / (2 * n + 1) * kernel;
      }
   }
   const Eigen::VectorXd density = influence.partialPivLu().solve(load);
   // Lagrange extrapolation to the tip s = 1.
   double tip = 0;
   for (int i = 0; i < n; i++)
   {
      double factor = 1;
      for (int j = 0; j < n; j++)
      {
         if (j != i) { factor *= (1 - node[j]) / (node[i] - node[j]); }
      }
      tip += density[i] * factor;
   }
   return -std::sqrt(2 * pi) * std::sqrt(2.0) * tip * std::sqrt(c / (0.5 * grading));
}

TEST(EdgeCrack, PowerLawFactorsAreTheKnownOnes)
{
   expect_relative(power_law_factor(0), 1.12152225523, 1e-11);
   expect_relative(power_law_factor(0.5), 0.832461362411, 1e-11);
   expect_relative(power_law_factor(1), 0.682862877687, 1e-11);
}

TEST(EdgeCrack, PowerLawFactorsAgreeWithDislocations)
{
   for (const double exponent : {0.0, 0.5, 1.0, 1.7, 3.0})
   {
      const double k =
         dislocation_intensity([=](double y) { return std::pow(y, exponent); }, 1.0);
      expect_relative(power_law_factor(exponent), k / std::sqrt(pi), 1e-11);
   }
}

TEST(EdgeCrack, FactorGivesTheSamples)
{
   expect_relative(crack_factor(0.1), 0.99785820592, 1e-11);
   expect_relative(crack_factor(1), 1.72821546912, 1e-11);
   expect_relative(crack_factor(std::numeric_limits<double>::infinity()), 1.84545280601, 1e-11);
   expect_relative(crack_closing_factor(), 1.56500339142, 1e-11);
   expect_relative(crack_factor(1e-12) / std::sqrt(pi * 1e-12), 2.24304451, 1e-5);
   expect_relative(crack_factor(1e12), 1.84545280601, 1e-11);
   EXPECT_EQ(crack_factor(0), 0);
   // Both expansions meet at 1.
   expect_relative(crack_factor(1 - 1e-12), crack_factor(1), 1e-11);
}

TEST(EdgeCrack, FactorAgreesWithDislocations)
{
   for (const double friction : {0.3, 0.8})
   {
      const Edge edge{1, 0.5 * friction, friction}; // unit slip zone
      for (const double c : {0.01, 0.1, 0.5, 1.0, 3.0, 20.0})
      {
         const double k =
            dislocation_intensity([&](double y) { return stress(edge, 0, y).xx; }, c);
         EXPECT_NEAR(crack_intensity(edge, c), k, 1e-10 * friction * crack_factor(c));
      }
   }
}

TEST(EdgeCrack, SignOfTheShearActsOnTheShearPart)
{
   const Edge plus{100, 7, 0.5}, minus{100, -7, 0.5}, none{100, 0, 0.5};
   const double c = 0.05;
   expect_relative(crack_intensity(plus, c) + crack_intensity(minus, c),
                   2 * crack_intensity(none, c), 1e-12);
   expect_relative(crack_intensity(none, c), -1.56500339142 * 100 * c, 1e-10);
   EXPECT_EQ(crack_intensity(plus, 0), 0);
}

TEST(EdgeCrack, BulkAndGradientApproachTheWholeHertzContact)
{
   // Hertz contact (a = p0 = 1) under Q and equal bulk tension in both bodies.
   const double f = 0.6, ratio = 0.1, bulk = 0.3, load = 0.5 * pi;
   CrackedEdge crack;
   crack.edge = {hertz_k_n(load, 1), shear_intensities(1, ratio * f * load, 0).trailing, f};
   double last = 1;
   for (const double c : {0.1, 0.03, 0.01})
   {
      const double exact = dislocation_intensity(
         [&](double y) { return hertz_stress(f, ratio, -1, y).xx + bulk; }, c);
      crack.bulk_stress = crack.stress_gradient = 0;
      const double bare = std::abs(crack_cycle(crack, c).max - exact);
      crack.bulk_stress = bulk;
      const double with_bulk = std::abs(crack_cycle(crack, c).max - exact);
      crack.stress_gradient = 2; // 2 p0/a
      const double with_both = std::abs(crack_cycle(crack, c).max - exact);
      EXPECT_LT(with_bulk, bare);
      EXPECT_LT(with_both, 0.25 * with_bulk);
      EXPECT_LT(with_both, last);
      last = with_both;
   }
   EXPECT_LT(last, 2e-4);
}

TEST(CrackCycle, ReversesAndTakesTheOpenPart)
{
   CrackedEdge crack;
   crack.edge = {3000, 60, 0.6};
   const double c = 0.03, n = 1.56500339142;
   const double shear = crack_intensity(crack.edge, c) + n * 3000 * c;
   const CrackCycle cycle = crack_cycle(crack, c);
   expect_relative(cycle.max, shear - n * 3000 * c, 1e-10);
   expect_relative(cycle.min, -shear - n * 3000 * c, 1e-10);
   expect_relative(cycle.drive(Criterion::range), 2 * shear, 1e-9);
   expect_relative(cycle.drive(Criterion::half_range), shear, 1e-9);
   EXPECT_EQ(cycle.drive(Criterion::open), std::max(0.0, cycle.max));
   // The other edge of a reversed cycle is as bad: only the instant differs.
   crack.edge.k_t = -60;
   expect_relative(crack_cycle(crack, c).max, cycle.max, 1e-12);
   // At R = 0 the shear does not vanish at the valley: reversed slip leaves tractions behind.
   crack.edge.k_t = 60;
   crack.stress_ratio = 0;
   const double reversed = crack_intensity_range(crack.edge, 60, c);
   expect_relative(crack_cycle(crack, c).min, shear - reversed - n * 3000 * c, 1e-9);
   EXPECT_GT(reversed, shear);
   // Bulk cycles with the load, the gradient does not.
   crack.bulk_stress = 50;
   crack.stress_gradient = 10;
   const double uniform = 50 * 1.12152225523 * std::sqrt(pi * c);
   const double linear = 10 * c * 0.682862877687 * std::sqrt(pi * c);
   expect_relative(crack_cycle(crack, c).max, cycle.max + uniform + linear, 1e-9);
   expect_relative(crack_cycle(crack, c).min, shear - reversed - n * 3000 * c + linear, 1e-9);
}

TEST(Threshold, GivesTheSamples)
{
   EXPECT_NEAR(threshold_ordinate(Criterion::open, 0.3, 0.2), 2.276629, 5e-7);
   EXPECT_NEAR(threshold_ordinate(Criterion::open, 0.8, 0.2), 1.178838, 5e-7);
   EXPECT_NEAR(threshold_ordinate(Criterion::range, 0.5, 0.2), 0.359858, 5e-7);
}

TEST(Threshold, CurvesSatisfyTheirEquations)
{
   for (const double f : {0.3, 0.8})
   {
      for (const double x : {1e-3, 0.1, 0.5, 2.0})
      {
         const double a = threshold_ordinate(Criterion::open, f, x);
         expect_relative(a * crack_factor(f * x / a), 1 + 1.56500339142 * x, 1e-10);
         const double b = threshold_ordinate(Criterion::range, f, x);
         expect_relative(2 * b * crack_factor(f * x / b), 1, 1e-10);
         const double c = threshold_ordinate(Criterion::half_range, f, x);
         expect_relative(c * crack_factor(f * x / c), 1, 1e-10);
      }
   }
}

TEST(Threshold, PointOnTheCurveIsAtTheThreshold)
{
   // In real units and for every load ratio: the cycle of the crack of depth a0 must just
   // reach.
   const double threshold = 66, critical = 0.0913, f = 0.7, k_n = 500;
   for (const double ratio : {-1.0, -0.5, 0.0, 0.6})
   {
      for (const Criterion criterion :
           {Criterion::open, Criterion::range, Criterion::half_range})
      {
         const double y = threshold_ordinate(criterion, f, k_n * critical / threshold, ratio);
         CrackedEdge crack;
         crack.edge = {k_n, y * threshold / (1 - ratio), f};
         crack.stress_ratio = ratio;
         expect_relative(crack_cycle(crack, critical).drive(criterion), threshold, 1e-9);
      }
   }
}

TEST(Threshold, VerdictsFollowTheCurve)
{
   const double threshold = 66.4, critical = 0.0913, f = 0.5;
   // Place of the minimum of curve A. To the right of it K_I falls at a0.
   const double minimum = 0.3534;
   for (const double x : {0.3 * minimum, 3 * minimum})
   {
      const double y = threshold_ordinate(Criterion::open, f, x);
      CrackedEdge crack;
      crack.edge = {x * threshold / critical, 0.5 * 0.98 * y * threshold, f};
      ThresholdReport report = assess_threshold(crack, threshold, critical);
      EXPECT_EQ(report.verdict, CrackVerdict::arrests);
      EXPECT_LE(report.arrest_depth, critical);
      EXPECT_LT(report.drive, threshold);
      crack.edge.k_t *= 1.02 / 0.98;
      report = assess_threshold(crack, threshold, critical);
      EXPECT_GT(report.drive, threshold);
      if (x < minimum)
      {
         EXPECT_EQ(report.verdict, CrackVerdict::propagates);
         EXPECT_TRUE(std::isinf(report.arrest_depth));
      }
      else
      {
         EXPECT_EQ(report.verdict, CrackVerdict::arrests_beyond_a0);
         EXPECT_GT(report.arrest_depth, critical);
         expect_relative(crack_intensity(crack.edge, report.arrest_depth), threshold, 1e-8);
      }
   }
}

TEST(Threshold, StoppedCrackIsWhereTheShortCrackThresholdIsMet)
{
   CrackedEdge crack;
   crack.edge = {2000, 30, 0.6};
   const double threshold = 66.4, critical = 0.0913;
   const ThresholdReport report = assess_threshold(crack, threshold, critical);
   ASSERT_EQ(report.verdict, CrackVerdict::arrests);
   ASSERT_GT(report.arrest_depth, 0);
   expect_relative(crack_intensity(crack.edge, report.arrest_depth),
                   threshold * std::sqrt(report.arrest_depth / critical), 1e-8);
   // So little shear that the fatigue limit is not reached at the surface: nothing starts.
   crack.edge.k_t = 0.1;
   EXPECT_EQ(assess_threshold(crack, threshold, critical).arrest_depth, 0);
}

TEST(Material, CriticalLengthsOfTable21)
{
   const auto materials =
      read_materials(std::string(CATTANEO_SOURCE_DIR) + "/miniapps/data/materials.json");
   EXPECT_NEAR(1e3 * critical_length(find_material(materials, "al")), 91.294654, 5e-7);
   EXPECT_NEAR(1e3 * critical_length(find_material(materials, "Ti6Al4V")), 25.783101, 5e-7);
   expect_relative(mpa_sqrt_m, 31.6228, 1e-5);
}

} // namespace
