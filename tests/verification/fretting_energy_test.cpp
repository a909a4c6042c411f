#include "comparison.hpp"

#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <quadrature.hpp>

namespace
{

using namespace cattaneo::fretting;
using cattaneo::test::integrate;
using cattaneo::test::integrate_to_infinity;

TEST(SlipEnergy, GivesTheSample)
{
   const Edge edge{4000, 20, 0.6};
   const double modulus = contact_modulus(115000, 0.3);
   expect_relative(slip_zone(edge), 1.0 / 60, 1e-14);
   expect_relative(reversed_slip_zone(edge, 40), 1.0 / 60, 1e-14);
   expect_relative(slip_energy_max(40, modulus), 0.04385853871, 1e-9);
   expect_relative(slip_energy_total(edge, 40, modulus), 4.419477202e-4, 1e-9);
   expect_relative(slip_energy_density(edge, 40, modulus, 1.0 / 240), 0.04385853871, 1e-9);
   const double sum = integrate(
      [&](double t) { return slip_energy_density(edge, 40, modulus, t); }, 0, 1.0 / 60);
   expect_relative(sum, 4.419477202e-4, 1e-9);
}

TEST(SlipEnergy, IsTheWorkOfTheTractions)
{
   // Reversal by ΔK_T: the change of traction is the partial slip solution at twice the
   // friction; σ_xx = (2/π) PV ∫ q/(s-t) ds, the relative strain of two similar bodies is
   // σ_xx/E*, the slip is its integral from the stick zone, and each of the two strokes
   // dissipates f p times it.
   const double f = 0.6, k_n = 4000, range = 40, modulus = 60000;
   const Edge edge{k_n, 0, f};
   const double d = reversed_slip_zone(edge, range);
   const auto q = [&](double s)
   { return 2 * f * k_n * (s < d ? std::sqrt(s) : d / (std::sqrt(s) + std::sqrt(s - d))); };
   const auto stress = [&](double t)
   {
      const double at = q(t);
      const auto regular = [&](double s) { return s == t ? 0.0 : (q(s) - at) / (s - t); };
      const auto far = [&](double s) { return q(s) / (s - t); };
      const double sum = integrate(regular, 0, t) + integrate(regular, t, d) +
                         at * std::log((d - t) / t) + integrate(far, d, 4 * d) +
                         integrate_to_infinity(far, 4 * d);
      return 2 / pi * sum;
   };
   for (const double tau : {0.1, 0.25, 0.7})
   {
      const double slip = integrate([&](double t) { return stress(t) / modulus; }, tau * d, d);
      const double work = 2 * f * k_n * std::sqrt(tau * d) * slip;
      expect_relative(slip_energy_density(edge, range, modulus, tau * d), work, 1e-6);
   }
}

TEST(SlipEnergy, HertzFormulaIsTheWorkOfTheTractions)
{
   const double a = 1.5, p0 = 250, f = 0.7, modulus = 50000, load = 0.5 * pi * a * p0;
   for (const double x : {0.01, 0.3, 0.9})
   {
      const double c = a * std::sqrt(1 - x);
      // Reversal by 2Q: in the slip zones σ_xx = -(4 f p0/a) √(x²-c²) (Hertz ellipses
      // superposed).
      const auto slip = [&](double at)
      {
         return integrate([&](double s)
                          { return 4 * f * p0 / a * std::sqrt((s - c) * (s + c)) / modulus; },
                          c, at);
      };
      const double work =
         2 * integrate([&](double s)
                       { return 2 * f * p0 / a * std::sqrt((a - s) * (a + s)) * slip(s); },
                       c, a);
      expect_relative(hertz_slip_energy(f, load, x, modulus), work);
   }
   EXPECT_EQ(hertz_slip_energy(f, load, 0, modulus), 0);
   expect_relative(hertz_slip_energy(f, load, 0.02 - 1e-12, modulus),
                   hertz_slip_energy(f, load, 0.02, modulus), 1e-9);
}

TEST(SlipEnergy, NearEdgeIsTheSmallSlipLimitOfHertz)
{
   const double a = 1.5, p0 = 250, f = 0.7, modulus = 50000, load = 0.5 * pi * a * p0;
   for (const double x : {0.2, 0.01, 1e-4})
   {
      const double k_t = shear_intensities(a, x * f * load, 0).trailing;
      const Edge edge{hertz_k_n(load, a), k_t, f};
      const double ratio =
         2 * slip_energy_total(edge, 2 * k_t, modulus) / hertz_slip_energy(f, load, x, modulus);
      EXPECT_LT(ratio, 1);
      EXPECT_NEAR(ratio, 1, x);
   }
}

TEST(Measures, StressRangeAndModeTwo)
{
   // A full reversal doubles the peak value √(8 f K_N K_T).
   const Edge edge{3000, 15, 0.5};
   expect_relative(edge_stress_range(edge, 30), 2 * std::sqrt(8 * 0.5 * 3000 * 15), 1e-13);
   // ΔK_T at ΔK_II = 0.8 ΔK_I.
   expect_relative(mode_two_range(0.319153824), 0.8);
   EXPECT_EQ(edge_stress_range(edge, 0), 0);
}

} // namespace
