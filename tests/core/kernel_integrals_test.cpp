#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/halfplane/kept_rings.hpp>
#include <cmath>
#include <gtest/gtest.h>

// Integrals of kernels against closed forms, and against nested adaptive (tanh-sinh) quadrature
// in 30 digits by mpmath, which knows the integrals as they are written and nothing of panels.

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SurfaceElement element(std::vector<Index> unknowns, const std::vector<double> &x)
{
   return {std::move(unknowns),
           Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()))};
}

struct Entry
{
   Index i, j;
   double value;
};

void expect_entries(const MatrixXd &V, const std::vector<Entry> &entries)
{
   const double largest = V.cwiseAbs().maxCoeff();
   for (const Entry &entry : entries)
   {
      EXPECT_NEAR(V(entry.i, entry.j), entry.value, 2e-15 * largest) << entry.i << entry.j;
      EXPECT_NEAR(V(entry.j, entry.i), entry.value, 2e-15 * largest) << entry.j << entry.i;
   }
}

/// Quadratic elements of lengths 1, 0.2 and 3, beginning at x = `from`.
SurfaceTrace three_elements(double from)
{
   return {7,
           {element({0, 1, 2}, {from, from + 0.5, from + 1}),
            element({2, 3, 4}, {from + 1, from + 1.1, from + 1.2}),
            element({4, 5, 6}, {from + 1.2, from + 2.7, from + 4.2})}};
}

TEST(Quadrature, RulesAgainstClosedForms)
{
   for (int points = 1; points <= 64; points += 3)
   {
      const QuadratureRule &rule = gauss_rule(points);
      for (int k = 0; k < 2 * points; ++k)
      {
         EXPECT_NEAR((rule.weights.array() * rule.points.array().pow(k)).sum(), 1.0 / (k + 1),
                     1e-14);
      }
   }
   const QuadratureRule &rule = logarithmic_rule();
   for (int k = 0; k <= 20; ++k)
   {
      const Eigen::ArrayXd power = rule.weights.array() * rule.points.array().pow(k);
      EXPECT_NEAR(power.sum(), 1.0 / (k + 1), 1e-14);
      EXPECT_NEAR((power * rule.points.array().log()).sum(), -1.0 / ((k + 1) * (k + 1)), 1e-14);
   }
   EXPECT_NEAR(lobatto_points(3)[1], 0.5 - 0.5 / std::sqrt(5.0), 2e-16);
   EXPECT_NEAR(lobatto_points(4)[3], 0.5 + 0.5 * std::sqrt(3.0 / 7), 2e-16);
   EXPECT_EQ(lobatto_points(1), Eigen::Vector2d(0, 1));
}

TEST(KernelIntegrals, LogarithmOnUnequalElements)
{
   const SurfaceTrace trace = three_elements(0);
   expect_entries(kernel_integrals(trace, trace, logarithm()),
                  {{0, 0, -0.10416666666666666667},
                   {0, 1, -0.13888888888888888889},
                   {1, 1, -0.77777777777777777778},
                   {2, 2, -0.13901302303561006186},
                   {0, 2, 0.021719286027988829273},
                   {2, 3, -0.05391294366828483565},
                   {4, 4, -0.72366445117431820593},
                   {0, 6, 0.12362567742122506929},
                   {4, 6, 0.48321173595957471974},
                   {3, 3, -0.059723340665495117771},
                   {5, 2, 0.1802258857374066993},
                   {6, 6, -0.66284692783297257715}});
}

/// Nodes of a cubic element far from the Gauss–Lobatto points, beside one of order 1.
TEST(KernelIntegrals, LogarithmOnAStretchedElement)
{
   const SurfaceTrace trace(
      5, {element({0, 1, 2, 3}, {-1, -0.8, -0.1, 0.2}), element({3, 4}, {0.2, 0.35})});
   expect_entries(kernel_integrals(trace, trace, logarithm()),
                  {{0, 0, -0.011054029210926507805},
                   {1, 1, -0.58514606423143319545},
                   {1, 2, -0.32319832783281764012},
                   {2, 2, -0.7232143311431305252},
                   {3, 3, -0.077705375495733985437},
                   {0, 4, 0.00073616057844481573263},
                   {3, 4, -0.029166216882293773106},
                   {4, 4, -0.020515049914983082324}});
}

/// ln|x + s|, with the mirror image at x = 0, which the elements touch.
TEST(KernelIntegrals, MirrorImage)
{
   const SurfaceTrace trace = three_elements(-4.2);
   expect_entries(kernel_integrals(trace, trace.mirrored(), logarithm()),
                  {{6, 6, -0.24010580005695070092},
                   {5, 6, 0.39378973314767216673},
                   {5, 5, 4.1583071990887887853},
                   {4, 6, 0.33080753476187908866},
                   {0, 6, 0.12127789239103023094},
                   {0, 0, 0.059160181426936234974}});
}

/// Kernels at the same points do not know of each other.
TEST(KernelIntegrals, SeveralAtOnceAreEachAlone)
{
   const SurfaceTrace trace = three_elements(0);
   const RingIntegrals rings = ring_integrals(trace);
   EXPECT_EQ(rings.even, kernel_integrals(trace, trace, ring_even()));
   EXPECT_EQ(rings.odd, kernel_integrals(trace, trace, ring_odd()));
   SurfaceKernel levered = ring_odd();
   levered.value = [](double distance, double r, double s)
   { return r * s * ring_odd().value(distance, r, s); };
   EXPECT_EQ(rings.levered, kernel_integrals(trace, trace, levered));
}

/// A half-space and its torsion have the same integrals, which are made once; another line has
/// its own.
TEST(KernelIntegrals, TorsionHasThoseOfItsBody)
{
   const std::vector<double> grid = {0, 0.4, 0.7, 1}, other = {0, 0.5, 1};
   HalfPlane body;
   body.material = {1, 0.3};
   const CondensedBody pressed = condense(body, grid, 2, Formulation::axisymmetric);
   HalfPlane copy = body;
   const CondensedBody turned = condense(copy, grid, 2, Formulation::torsion);
   EXPECT_EQ(body.rings->made(), 1);
   HalfPlane alone;
   alone.material = body.material;
   EXPECT_EQ(condense(alone, grid, 2, Formulation::torsion).S, turned.S);
   EXPECT_EQ(alone.rings->made(), 1);
   EXPECT_EQ(condense(alone, grid, 2, Formulation::axisymmetric).S, pressed.S);
   EXPECT_EQ(alone.rings->made(), 1);
   condense(alone, other, 2, Formulation::torsion);
   EXPECT_EQ(alone.rings->made(), 2);
}

/// Moments ∫∫ x^m s^n G(x, s) over 0 < x, s < 1 of one element, and of parts that differ by 10⁶
/// in length.
TEST(KernelIntegrals, PartsOfALineAreTheLine)
{
   const auto trace = [](const std::vector<double> &grid, int order)
   {
      std::vector<SurfaceElement> elements;
      Index next = 0;
      for (std::size_t e = 0; e + 1 < grid.size(); ++e, next += order)
      {
         SurfaceElement made;
         const Eigen::ArrayXd t = lobatto_points(order);
         made.x = (1 - t) * grid[e] + t * grid[e + 1];
         for (Index a = 0; a <= order; ++a) { made.unknowns.push_back(next + a); }
         elements.push_back(made);
      }
      return SurfaceTrace(next + 1, elements);
   };
   const auto moment = [](const SurfaceTrace &line, const SurfaceKernel &kernel, int m, int n)
   {
      VectorXd f(line.unknowns()), g(line.unknowns());
      for (const SurfaceElement &e : line.elements())
      {
         f(e.unknowns) = e.x.array().pow(m);
         g(e.unknowns) = e.x.array().pow(n);
      }
      return f.dot(kernel_integrals(line, line, kernel) * g);
   };
   // By hand: -3/2, -7/16 and -35/72.
   const std::vector<double> whole{0, 1}, parts{0, 1e-6, 2e-6, 0.3, 0.7, 0.7001, 1};
   for (const int order : {2, 5, 8})
   {
      for (const auto &grid : {whole, parts})
      {
         const SurfaceTrace line = trace(grid, order);
         EXPECT_NEAR(moment(line, logarithm(), 0, 0), -1.5, 1e-14);
         EXPECT_NEAR(moment(line, logarithm(), 1, 1), -7.0 / 16, 1e-14);
         EXPECT_NEAR(moment(line, logarithm(), 0, 2), -35.0 / 72, 1e-14);
         // Bessel's functions: ∫∫ r s ∫ J₀ J₀ = ∫ J₁(k)²/k² dk, and r² s² with J₁: ∫ J₂²/k².
         EXPECT_NEAR(moment(line, ring_even(), 0, 0), 4 / (3 * M_PI), 1e-14);
         EXPECT_NEAR(moment(line, ring_odd(), 1, 1), 4 / (15 * M_PI), 1e-14);
      }
   }
}

TEST(KernelIntegrals, RingsByEllipticIntegrals)
{
   // s = 1; both formulas of the header by mpmath in 30 digits.
   const double values[][3] = {{0.1, 0.10025141609100382091, 0.0050188680487773054571},
                               {0.5, 0.53659100357468218753, 0.13896654948167025891},
                               {0.99, 2.1155094784999956257, 1.4821302256816254289},
                               {1.01, 2.1399707032619985976, 1.500224760549363377},
                               {3.0, 1.0296603754637626235, 0.17413620058289766942}};
   for (const auto &[r, even, odd] : values)
   {
      const double distance = std::abs(r - 1);
      EXPECT_NEAR(ring_even().value(distance, r, 1) / even, 1, 1e-14);
      EXPECT_NEAR(ring_odd().value(distance, r, 1) / odd, 1, 1e-14);
   }
   // Far apart and close together: leading terms r²/2s, and r/π (ln(8r/d) - 2).
   EXPECT_NEAR(ring_odd().value(1 - 1e-9, 1e-9, 1) / 0.5e-18, 1, 1e-14);
   EXPECT_NEAR(ring_even().value(1e-12, 1, 1 + 1e-12) / (std::log(8e12) / M_PI), 1, 1e-11);
   EXPECT_NEAR(ring_odd().value(1e-12, 1, 1 + 1e-12) / ((std::log(8e12) - 2) / M_PI), 1, 1e-11);
}

} // namespace
