#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using namespace cattaneo::fretting;

constexpr PlaneCriterion all_criteria[] = {
   PlaneCriterion::findley, PlaneCriterion::smith_watson_topper, PlaneCriterion::fatemi_socie};

FatigueMaterial steel()
{
   FatigueMaterial material;
   material.young = 200e3;
   material.poisson = 0.3;
   material.shear_yield = {250, 300};
   material.fatigue_limit = {400, 500};
   return material;
}

StressCycle cycle_of(std::initializer_list<Eigen::RowVector4d> instants)
{
   StressCycle cycle(instants.size(), 4);
   Eigen::Index k = 0;
   for (const auto &instant : instants) { cycle.row(k++) = instant; }
   return cycle;
}

double value(PlaneCriterion criterion, const StressCycle &cycle,
             const PlaneWeights &weights = {})
{
   return critical_plane(criterion, cycle, steel(), weights).value;
}

StressCycle random_cycle(unsigned seed, int instants)
{
   std::mt19937 engine(seed);
   std::uniform_real_distribution<double> stress(-300, 300);
   StressCycle cycle(instants, 4);
   for (Eigen::Index i = 0; i < cycle.size(); ++i) { cycle.data()[i] = stress(engine); }
   return cycle;
}

TEST(CriticalPlane, ReversedTensionHasItsClosedForms)
{
   const double S = 180, E = 200e3, nu = 0.3, yield = std::sqrt(3) * 250;
   const StressCycle cycle = cycle_of({{S, 0, 0, 0}, {-S, 0, 0, 0}});
   for (const double k : {0.0, 0.2, 0.3, 1.0})
   {
      const PlaneWeights weights = {k, k};
      // S/2 |sin 2θ| + k S/2 (1 + cos 2θ) is largest where tan 2θ = 1/k.
      const CriticalPlane plane =
         critical_plane(PlaneCriterion::findley, cycle, steel(), weights);
      EXPECT_NEAR(plane.value, 0.5 * S * (k + std::hypot(1, k)), 1e-11 * S) << k;
      EXPECT_NEAR(std::abs(std::tan(2 * plane.angle)) * k, 1, k > 0 ? 1e-5 : 1) << k;
      // (1+ν) S/E |sin 2θ| (1 + κ (1 + cos 2θ)/2), κ = k S/σ_y: κ c² + (1 + κ/2) c = κ/2.
      const double kappa = k * S / yield, b = 1 + 0.5 * kappa,
                   c = kappa > 0 ? (std::sqrt(b * b + 2 * kappa * kappa) - b) / (2 * kappa) : 0;
      EXPECT_NEAR(value(PlaneCriterion::fatemi_socie, cycle, weights),
                  (1 + nu) * S / E * std::sqrt(1 - c * c) * (1 + 0.5 * kappa * (1 + c)), 1e-14)
         << k;
   }
   const CriticalPlane opened =
      critical_plane(PlaneCriterion::smith_watson_topper, cycle, steel());
   EXPECT_NEAR(opened.value, S * S / E, 1e-13);
   EXPECT_NEAR(std::remainder(opened.angle, M_PI), 0, 1e-6);
}

TEST(CriticalPlane, ReversedShearHasItsClosedForms)
{
   const double T = 120;
   const StressCycle cycle = cycle_of({{0, 0, 0, T}, {0, 0, 0, -T}});
   EXPECT_NEAR(value(PlaneCriterion::findley, cycle, {0.3, 1}), T * std::hypot(1, 0.3),
               1e-11 * T);
   EXPECT_NEAR(value(PlaneCriterion::smith_watson_topper, cycle), 1.3 * T * T / 200e3, 1e-13);
}

TEST(CriticalPlane, PressureTakesWhatNeedsTension)
{
   const StressCycle pressed = cycle_of({{-50, -80, -39, 0}, {-250, -80, -99, 0}});
   EXPECT_EQ(value(PlaneCriterion::smith_watson_topper, pressed), 0);
   // Half of the range of shear, at 45°.
   EXPECT_NEAR(value(PlaneCriterion::fatemi_socie, pressed), 2 * 1.3 / 200e3 * 50, 1e-15);
   // A stress that does not change fatigues nothing but by Findley's normal stress.
   const StressCycle constant = cycle_of({{100, 0, 0, 0}, {100, 0, 0, 0}});
   EXPECT_EQ(value(PlaneCriterion::smith_watson_topper, constant), 0);
   EXPECT_EQ(value(PlaneCriterion::fatemi_socie, constant), 0);
   EXPECT_NEAR(value(PlaneCriterion::findley, constant), 30, 1e-11);
}

/// τ_a + k σ_n,max is the largest of all choices of three instants, each a sinusoid.
TEST(CriticalPlane, FindleyIsTheLargestOfAllTriplesOfInstants)
{
   for (unsigned seed = 0; seed < 40; ++seed)
   {
      const StressCycle cycle = random_cycle(seed, 2 + seed % 7);
      const double k = 0.1 * (seed % 5);
      double expected = -1e300;
      for (Eigen::Index a = 0; a < cycle.rows(); ++a)
      {
         for (Eigen::Index b = 0; b < cycle.rows(); ++b)
         {
            for (Eigen::Index c = 0; c < cycle.rows(); ++c)
            {
               const auto half = [&](Eigen::Index i)
               { return 0.5 * (cycle(i, 0) - cycle(i, 1)); };
               const double by_cos = 0.5 * (cycle(a, 3) - cycle(b, 3)) + k * half(c),
                            by_sin = 0.5 * (half(b) - half(a)) + k * cycle(c, 3);
               expected = std::max(expected, 0.5 * k * (cycle(c, 0) + cycle(c, 1)) +
                                                std::hypot(by_cos, by_sin));
            }
         }
      }
      EXPECT_NEAR(value(PlaneCriterion::findley, cycle, {k, 1}), expected, 1e-4 * expected)
         << seed;
   }
}

TEST(CriticalPlane, TurnsWithTheStresses)
{
   const double turn = 0.7, c = std::cos(turn), s = std::sin(turn);
   for (unsigned seed = 0; seed < 20; ++seed)
   {
      const StressCycle cycle = random_cycle(seed, 5);
      StressCycle turned = cycle;
      for (Eigen::Index i = 0; i < cycle.rows(); ++i)
      {
         const double x = cycle(i, 0), y = cycle(i, 1), t = cycle(i, 3);
         turned.row(i) << c * c * x + s * s * y - 2 * c * s * t,
            s * s * x + c * c * y + 2 * c * s * t, cycle(i, 2),
            c * s * (x - y) + (c * c - s * s) * t;
      }
      for (const PlaneCriterion criterion : all_criteria)
      {
         const CriticalPlane before = critical_plane(criterion, cycle, steel()),
                             after = critical_plane(criterion, turned, steel());
         EXPECT_NEAR(after.value, before.value, 1e-4 * before.value) << seed;
         EXPECT_GE(before.angle, 0);
         EXPECT_LT(before.angle, M_PI);
         const double off = std::remainder(after.angle - before.angle - turn, M_PI);
         EXPECT_LT(std::abs(off), 1e-2) << seed;
      }
   }
}

// Under tension along any direction the plane of largest normal stress has that direction as
// its normal, on whichever side of the planes that are tried it lies.
TEST(CriticalPlane, IsFoundBetweenThePlanesThatAreTried)
{
   for (const double degrees : {30.1, 30.2, 30.3, 30.4, 120.6, 120.9})
   {
      const double angle = degrees * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
      StressCycle cycle(2, 4);
      cycle.row(0) << c * c, s * s, 0, c * s;
      cycle.row(1) = -cycle.row(0);
      const CriticalPlane found =
         critical_plane(PlaneCriterion::smith_watson_topper, cycle, steel());
      EXPECT_LT(std::abs(std::remainder(found.angle - angle, M_PI)), 1e-6) << degrees;
   }
}

TEST(CriticalPlane, APlainSpecimenIsAtItsLimit)
{
   FatigueMaterial material = steel();
   EXPECT_EQ(plain_fatigue_cycle(material), cycle_of({{200, 0, 0, 0}, {-200, 0, 0, 0}}));
   material.fatigue_limit_basis = Basis::amplitude;
   material.threshold_ratio = 0;
   EXPECT_EQ(plain_fatigue_cycle(material), cycle_of({{800, 0, 0, 0}, {0, 0, 0, 0}}));
}

TEST(CriticalPlane, RefusesWhatIsNoCycle)
{
   EXPECT_THROW(value(PlaneCriterion::findley, StressCycle(0, 4)), InputError);
   StressCycle cycle = random_cycle(1, 3);
   EXPECT_THROW(value(PlaneCriterion::findley, cycle, {-0.1, 1}), InputError);
   cycle(1, 2) = std::nan("");
   EXPECT_THROW(value(PlaneCriterion::findley, cycle), InputError);
}

} // namespace
