#include "comparison.hpp"

#include <array>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/near_edge.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <quadrature.hpp>

namespace
{

using namespace cattaneo::fretting;
using cattaneo::test::integrate;
using cattaneo::test::integrate_to_infinity;

/// Edge of unit slip zone and unit K_N: stresses are then in K_N √d.
Edge unit_edge(double friction)
{
   return {1.0, 0.5 * friction, friction};
}

/// Flamant's solution for unit forces at distance x along the surface: pressure, then shear.
InPlaneStress flamant(double p, double q, double x, double y)
{
   const double r4 = std::pow(x * x + y * y, 2), c = -2 / (pi * r4);
   return {c * (p * y * x * x + q * x * x * x), c * (p * y * y * y + q * x * y * y),
           c * (p * y * y * x + q * x * x * y)};
}

/// Superposition of Flamant's solutions with the tractions of the near-edge field.
InPlaneStress integrated_stress(double f, double t, double y)
{
   std::array<double, 3> result{};
   const auto part = [&](int component)
   {
      const auto of = [&](double s, double q)
      {
         const InPlaneStress stress = flamant(std::sqrt(s), q, t - s, y);
         return component == 0 ? stress.xx : component == 1 ? stress.yy : stress.xy;
      };
      const auto slip = [&](double s) { return of(s, f * std::sqrt(s)); };
      const auto stick = [&](double s)
      { return of(s, f / (std::sqrt(s) + std::sqrt(std::max(0.0, s - 1)))); };
      return integrate(slip, 0, 1) + integrate(stick, 1, 4) + integrate_to_infinity(stick, 4);
   };
   for (int k = 0; k < 3; k++) { result[k] = part(k); }
   return {result[0], result[1], result[2]};
}

TEST(NearEdgeField, GivesTheSamples)
{
   const InPlaneStress a = stress(unit_edge(0.8), 0.5, 0.3);
   expect_relative(a.xx, -0.0465260136501, 1e-11);
   expect_relative(a.yy, -0.573965289834, 1e-11);
   expect_relative(a.xy, -0.126846556441, 1e-11);
   const InPlaneStress b = stress(unit_edge(0.3), 2, 1);
   expect_relative(b.xx, -1.44634631865, 1e-11);
   expect_relative(b.yy, -1.39742959529, 1e-11);
   expect_relative(b.xy, 0.243649453235, 1e-11);
}

TEST(NearEdgeField, IsTheFieldOfItsTractions)
{
   for (const double f : {0.3, 0.8})
   {
      for (const auto &point : {std::array{0.5, 0.3}, {2.0, 1.0}, {-0.7, 0.4}, {0.0, 2.5}})
      {
         const InPlaneStress closed = stress(unit_edge(f), point[0], point[1]);
         const InPlaneStress integrated = integrated_stress(f, point[0], point[1]);
         EXPECT_NEAR(closed.xx, integrated.xx, 1e-8);
         EXPECT_NEAR(closed.yy, integrated.yy, 1e-8);
         EXPECT_NEAR(closed.xy, integrated.xy, 1e-8);
      }
   }
}

TEST(NearEdgeField, MeetsItsTractionsOnTheSurface)
{
   const Edge edge{4000, 20, 0.6};
   for (const double t : {-0.01, 1e-4, 0.01, slip_zone(edge), 0.05})
   {
      const InPlaneStress surface = stress(edge, t, 0);
      const double p = t > 0 ? 4000 * std::sqrt(t) : 0;
      EXPECT_NEAR(surface.yy, -p, 1e-10);
      EXPECT_NEAR(surface.xy, -shear_traction(edge, t), 1e-10);
      EXPECT_NEAR(pressure(edge, t), p, 1e-10);
   }
   expect_relative(slip_zone(edge), 1.0 / 60, 1e-14);
   // (2.12) with √2: in the stick zone √(2 f K_N K_T) (√τ - √(τ-1)).
   expect_relative(shear_traction(edge, 3.0 / 60),
                   std::sqrt(2 * 0.6 * 4000 * 20) * (std::sqrt(3.0) - std::sqrt(2.0)), 1e-12);
}

TEST(NearEdgeField, HasTheSameValuesInOtherUnits)
{
   // MPa and m: K_N in MPa/√m, K_T in MPa√m.
   const Edge mm{4000, 20, 0.6};
   const Edge m{4000 * std::sqrt(1e3), 20 / std::sqrt(1e3), 0.6};
   expect_relative(slip_zone(m), 1e-3 * slip_zone(mm), 1e-14);
   expect_relative(stress(m, 1e-5, 2e-5).xx, stress(mm, 1e-2, 2e-2).xx, 1e-12);
}

TEST(NearEdgeField, NegativeShearFlipsTheShearPartOnly)
{
   const Edge plus{1, 0.25, 0.5}, minus{1, -0.25, 0.5};
   const Edge none{1, 0, 0.5};
   for (const auto &point : {std::array{0.5, 0.0}, {-1.0, 0.0}, {1.7, 0.6}})
   {
      const InPlaneStress a = stress(plus, point[0], point[1]),
                          b = stress(minus, point[0], point[1]);
      const InPlaneStress c = stress(none, point[0], point[1]);
      EXPECT_NEAR(a.xx + b.xx, 2 * c.xx, 1e-14);
      EXPECT_NEAR(a.yy + b.yy, 2 * c.yy, 1e-14);
      EXPECT_NEAR(a.xy + b.xy, 2 * c.xy, 1e-14);
   }
   EXPECT_EQ(slip_zone(minus), slip_zone(plus));
   EXPECT_EQ(edge_stress(minus), -edge_stress(plus));
   EXPECT_EQ(edge_stress(none), 0);
   EXPECT_EQ(slip_zone(none), 0);
}

TEST(NearEdgeField, EdgeStressIsExactForHertzAtAnyShear)
{
   const double a = 1.7, p0 = 300, f = 0.6;
   for (const double x : {0.1, 0.5, 0.99})
   {
      const double load = 0.5 * pi * a * p0;
      const Edge edge{hertz_k_n(load, a), shear_intensities(a, x * f * load, 0).trailing, f};
      // Cattaneo–Mindlin: σ_xx(-a) = (2/π) ∫ q/(s+a) ds over the contact.
      const double c = a * std::sqrt(1 - x);
      const auto q = [&](double s)
      {
         const double full = std::sqrt(s * (2 * a - s));
         const double stick = c * c - (s - a) * (s - a);
         return f * p0 / a * (full - (stick > 0 ? std::sqrt(stick) : 0.0));
      };
      double exact = 0;
      const double ends[] = {0, a - c, a + c, 2 * a};
      for (int i = 0; i < 3; i++)
      {
         exact += 2 / pi * integrate([&](double s) { return q(s) / s; }, ends[i], ends[i + 1]);
      }
      expect_relative(edge_stress(edge), exact);
      expect_relative(edge_stress(edge), stress(edge, 0, 0).xx, 1e-14);
      expect_relative(edge_stress(edge), std::sqrt(8 * f * edge.k_n * edge.k_t), 1e-14);
   }
}

TEST(NearEdgeField, IsTheLimitOfCattaneoMindlin)
{
   const double a = 2, p0 = 200, f = 0.5, load = 0.5 * pi * a * p0;
   double last = 0;
   for (const double x : {0.5, 0.1, 0.01, 1e-4})
   {
      const Edge edge{hertz_k_n(load, a), shear_intensities(a, x * f * load, 0).trailing, f};
      const double c = a * std::sqrt(1 - x), exact = a - c;
      expect_relative(slip_zone(edge) / exact, 0.5 * (1 + std::sqrt(1 - x)), 1e-10);
      const double t = 2 * exact;
      const double q =
         f * p0 / a * (std::sqrt(t * (2 * a - t)) - std::sqrt(c * c - std::pow(a - t, 2)));
      const double error = std::abs(shear_traction(edge, t) / q - 1);
      EXPECT_LT(error, x);
      if (last > 0) { EXPECT_LT(error, last); }
      last = error;
   }
}

TEST(Calibration, HertzFollowsFromTheEdgeOfItsPressure)
{
   const double modulus = contact_modulus(115000, 0.3);
   const HertzContact contact = hertz_contact(500, 10, modulus);
   const double a = contact.half_width, p0 = contact.peak_pressure;
   // Force balance, and the mutual curvature 1/R = 2 p0/(a E*).
   expect_relative(0.5 * pi * a * p0, 500, 1e-14);
   expect_relative(2 * p0 / (a * modulus), 0.1, 1e-14);
   const double t = 1e-12;
   expect_relative(contact.k_n, p0 * std::sqrt(t / a * (2 - t / a)) / std::sqrt(t), 1e-10);
   // dP/da from the load as a function of the half width.
   const auto load = [&](double half) { return half * half * pi * modulus / 40; };
   const double h = 1e-3 * a;
   expect_relative(contact.k_n, symmetric_k_n(a, (load(a + h) - load(a - h)) / (2 * h)), 1e-9);
}

TEST(Calibration, FlatAndRoundedPadGivesTheSample)
{
   const FlatRoundedContact contact =
      flat_rounded_contact(1000, 3, 3, contact_modulus(115000, 0.3));
   expect_relative(contact.half_width, 3.09387232416, 1e-11);
   expect_relative(contact.k_n, 4118.68289887, 1e-11);
   expect_relative(contact.pressure(0), 104.150791810, 1e-11);
}

TEST(Calibration, FlatAndRoundedPressureCarriesTheLoadAndHasTheIntensity)
{
   const double modulus = contact_modulus(74000, 0.33);
   for (const double load : {1e-3, 1.0, 300.0, 2e4})
   {
      const FlatRoundedContact c = flat_rounded_contact(load, 5, 2, modulus);
      const auto p = [&](double x) { return c.pressure(x); };
      const double sum = integrate(p, 0, 2) + integrate(p, 2, c.half_width);
      expect_relative(2 * sum, load);
      // p/√t tends to K_N with an error of order t over the rounded width.
      const double t = 1e-4 * (c.half_width - 2);
      const double near = c.pressure(c.half_width - t) / std::sqrt(t);
      const double nearer = c.pressure(c.half_width - t / 4) / std::sqrt(t / 4);
      expect_relative((4 * nearer - near) / 3, c.k_n, 2e-7);
      // The load rate: K_N = (√(2/a)/π) dP/da.
      const double h = 1e-4 * load;
      const double da = flat_rounded_contact(load + h, 5, 2, modulus).half_width -
                        flat_rounded_contact(load - h, 5, 2, modulus).half_width;
      expect_relative(symmetric_k_n(c.half_width, 2 * h / da), c.k_n, 1e-7);
   }
}

TEST(Calibration, FlatAndRoundedPressureClosesTheGap)
{
   // The relative slope of the surfaces must be that of the pad: 0 on the flat, x-b over R
   // beyond.
   const double modulus = 60000;
   const FlatRoundedContact c = flat_rounded_contact(800, 4, 1.5, modulus);
   const auto slope = [&](double x)
   {
      // (2/πE*) PV ∫ p(s)/(x-s) ds, the singularity taken out by subtraction.
      const double a = c.half_width, p = c.pressure(x);
      const auto f = [&](double s) { return s == x ? 0.0 : (c.pressure(s) - p) / (x - s); };
      double sum = p * std::log((a + x) / (a - x));
      const double ends[] = {-a, -1.5, std::min(x, 1.5), std::max(x, 1.5), a};
      for (int i = 0; i < 4; i++) { sum += integrate(f, ends[i], ends[i + 1]); }
      return 2 / (pi * modulus) * sum;
   };
   EXPECT_NEAR(slope(0.7), 0, 1e-9);
   expect_relative(slope(1.6), 0.1 / 4, 1e-6);
}

TEST(Calibration, PadWithoutFlatIsHertz)
{
   const double modulus = 50000;
   const FlatRoundedContact pad = flat_rounded_contact(400, 6, 0, modulus);
   const HertzContact hertz = hertz_contact(400, 6, modulus);
   expect_relative(pad.half_width, hertz.half_width, 1e-12);
   expect_relative(pad.k_n, hertz.k_n, 1e-12);
   expect_relative(pad.pressure(0), hertz.peak_pressure, 1e-12);
   expect_relative(pad.pressure(0.6 * pad.half_width), 0.8 * hertz.peak_pressure, 1e-12);
}

TEST(Calibration, RoundedEdgeJoinsTheNearAndTheFarField)
{
   const double radius = 2, modulus = 60000;
   const RoundedEdge edge = rounded_edge(150, radius, modulus);
   const double a = edge.rounded_width;
   expect_relative(edge.k_p, 2 * modulus * std::pow(a, 1.5) / (3 * pi * radius), 1e-12);
   expect_relative(edge.k_n, 2 * modulus * std::sqrt(a) / (pi * radius), 1e-12);
   expect_relative(edge.pressure(1e-9 * a) / std::sqrt(1e-9 * a), edge.k_n, 1e-8);
   expect_relative(edge.pressure(1e4 * a) * std::sqrt(1e4 * a), edge.k_p, 1e-4);
   // A lightly loaded wide flat pad has such edges, with K_P = P/(π√(2b)).
   const double b = 50, load = 150 * pi * std::sqrt(2 * b);
   const FlatRoundedContact pad = flat_rounded_contact(load, radius, b, modulus);
   expect_relative(pad.half_width - b, a, 2e-2);
   expect_relative(pad.k_n, edge.k_n, 2e-2);
   expect_relative(pad.pressure(b - a), edge.pressure(2 * a), 2e-2);
}

TEST(Calibration, ShearIntensitiesFollowFromTheStuckTractions)
{
   const double a = 1.3, Q = 70, bulk = 40, t = 1e-10;
   const double root = std::sqrt(t * (2 * a - t));
   const double from_shear = Q / (pi * root), from_bulk = bulk * (a - t) / (4 * root);
   const ShearIntensities k = shear_intensities(a, Q, bulk);
   expect_relative(k.trailing, (from_shear + from_bulk) * std::sqrt(t), 1e-9);
   expect_relative(k.leading, (from_bulk - from_shear) * std::sqrt(t), 1e-9);
   EXPECT_LT(shear_intensities(a, Q, 0).leading, 0);
   // Bulk tension σ0 in the cracked body is met if each body's surface strains by half of it:
   // the tractions ±σ0 x/(4√(a²-x²)) cause σ_xx = -σ0/2 inside the contact.
   const auto q = [&](double s) { return -s / std::sqrt(a * a - s * s); };
   const double x = 0.4;
   const auto f = [&](double s) { return s == x ? 0.0 : (q(s) - q(x)) / (s - x); };
   double sum = q(x) * std::log((a - x) / (a + x));
   sum += integrate(f, -a, x) + integrate(f, x, a);
   expect_relative(bulk / 4 * 2 / pi * sum, -bulk / 2, 1e-6);
}

TEST(Calibration, GradientIsThatOfTheWholeContactBelowItsEdge)
{
   const double modulus = 60000, radius = 4;
   const FlatRoundedContact c = flat_rounded_contact(800, radius, 1.5, modulus);
   const double a = c.half_width;
   const auto excess = [&](double y)
   {
      const auto line = [&](double s) { return flamant(c.pressure(s - a), 0, -s, y).xx; };
      const double whole = integrate(line, 0, a - 1.5) + integrate(line, a - 1.5, a + 1.5) +
                           integrate(line, a + 1.5, 2 * a);
      return whole - stress({c.k_n, 0, 1}, 0, y).xx;
   };
   // The next term is as y^(3/2): two depths give the limit.
   const double y = 1e-3 * (a - 1.5);
   const double limit = 2 * excess(y) / y - excess(4 * y) / (4 * y);
   expect_relative(edge_gradient(radius, modulus), limit, 1e-3);
   // Hertz: 2 p0/a.
   const HertzContact hertz = hertz_contact(500, radius, modulus);
   expect_relative(edge_gradient(radius, modulus), 2 * hertz.peak_pressure / hertz.half_width,
                   1e-14);
}

TEST(Yield, SurfaceFormulasAgreeWithTheField)
{
   for (const double constraint : {0.0, 0.3, 0.45})
   {
      for (const double f : {0.2, 0.8, 1.5})
      {
         for (const double t : {-3.0, -0.2, 0.0, 0.3, 0.99, 1.0, 1.4, 6.0})
         {
            expect_relative(surface_von_mises(f, constraint, t),
                            von_mises(stress(unit_edge(f), t, 0), constraint), 1e-12);
         }
      }
   }
}

TEST(Yield, MapBoundsTheSlipZone)
{
   expect_relative(first_yield_load(0.2, 0.3), 3.273268354, 1e-9);
   expect_relative(first_yield_load(0.5, 0.3), 1.815682598, 1e-9);
   for (const double f : {0.2, 0.5, 1.0, 1.6})
   {
      double most = 0, least = 1e9;
      for (int k = 0; k <= 100000; k++)
      {
         const double v = von_mises(stress(unit_edge(f), 1e-5 * k, 0), 0.3);
         most = std::max(most, v);
         least = std::min(least, v);
      }
      expect_relative(first_yield_load(f, 0.3), std::sqrt(3.0) / most, 1e-8);
      expect_relative(full_yield_load(f), std::sqrt(3.0) / least, 1e-8);
   }
}

TEST(Yield, VonMisesIsThatOfTheThreeDimensionalStress)
{
   const InPlaneStress s{3, -5, 2};
   for (const double c : {0.0, 0.3})
   {
      const double z = c * (s.xx + s.yy);
      const double square = s.xx * s.xx + s.yy * s.yy + z * z -
                            (s.xx * s.yy + s.yy * z + z * s.xx) + 3 * s.xy * s.xy;
      expect_relative(von_mises(s, c), std::sqrt(square), 1e-14);
   }
}

TEST(HertzField, IsTheFieldOfItsTractions)
{
   const double f = 0.5, x = 0.6, c = std::sqrt(1 - x);
   const double X = -0.8, Y = 0.4;
   const InPlaneStress closed = hertz_stress(f, x, X, Y);
   double xx = 0, yy = 0, xy = 0;
   const double ends[] = {-1, -c, c, 1};
   for (int i = 0; i < 3; i++)
   {
      const auto at = [&](double s)
      {
         const double stick = c * c - s * s;
         const double p = std::sqrt(1 - s * s);
         return flamant(p, f * (p - (stick > 0 ? std::sqrt(stick) : 0.0)), X - s, Y);
      };
      xx += integrate([&](double s) { return at(s).xx; }, ends[i], ends[i + 1]);
      yy += integrate([&](double s) { return at(s).yy; }, ends[i], ends[i + 1]);
      xy += integrate([&](double s) { return at(s).xy; }, ends[i], ends[i + 1]);
   }
   EXPECT_NEAR(closed.xx, xx, 1e-9);
   EXPECT_NEAR(closed.yy, yy, 1e-9);
   EXPECT_NEAR(closed.xy, xy, 1e-9);
}

TEST(HertzField, SeverestPointComesToTheSurface)
{
   const double f = hertz_transition_friction(0.3, 1);
   EXPECT_NEAR(f, 0.262825847, 5e-10);
   EXPECT_NEAR(hertz_transition_friction(0.3, 0.5), 0.398, 5e-4);
   // Sliding has the surface maximum √(3f² + m(1+f²)); a fine grid below must not exceed it.
   const double surface = std::sqrt(3 * f * f + 0.16 * (1 + f * f));
   double below = 0;
   for (double x = -1; x < 1; x += 0.002)
   {
      for (double y = 0.1; y < 1; y += 0.002)
      {
         below = std::max(below, von_mises(hertz_stress(f, 1, x, y), 0.3));
      }
   }
   expect_relative(below, surface, 1e-5);
   EXPECT_EQ(hertz_transition_friction(0, 1), 0);
}

} // namespace
