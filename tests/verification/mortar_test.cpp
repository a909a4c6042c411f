// Hertz (1882) and Cattaneo (1938), Mindlin (1949): two cylinders whose nodes do not match.
// Pressure p0 √(1 - x²/a²), a² = 4 P R/(π E*), p0 = 2 P/(π a); then under a tangential force Q
// < f P the shear f p0 [√(1 - x²/a²) - (c/a) √(1 - x²/c²)] with c = a √(1 - Q/f P).

#include <algorithm>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Index;

constexpr double friction = 0.3, half_width = 0.6, domain = 1e4;

/// A half-plane y < 0, or turned upside down, with so many elements on its contact |x| < 1.
mfem::Mesh half_plane(int elements, bool above, double radius)
{
   std::vector<double> contact;
   for (int k = 0; k <= elements; ++k) { contact.push_back(-1 + 2.0 * k / elements); }
   mfem::Mesh mesh = half_plane_mesh(contact, graded(0, 1, 2.0 / elements, 1.25),
                                     ring_scales(1.0, domain, 2.0 / elements, 1.25));
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      // A parabola where the contact is.
      if (radius > 0) { x[1] -= 0.5 * x[0] * x[0] / radius / (1 + std::pow(x[0] / 8, 4)); }
      if (above)
      {
         x[0] = -x[0];
         x[1] = -x[1];
      }
   }
   return mesh;
}

/// Root mean squares over the contact, relative to those of the closed form.
struct Errors
{
   double pressure = 0, shear = 0;
   int partial = 0; ///< states of partial slip that were compared
   Index nodes = 0;
};

/// `curved`: the radius is in the upper mesh, else in a gap that is given.
Errors errors(int below, int above, int order, SlaveSide slave, const Material &lower_material,
              const Material &upper_material, bool curved = false, double f = friction)
{
   const auto soft = [](const Material &m) { return (1 - m.poisson * m.poisson) / m.young; };
   const double modulus = 1 / (soft(lower_material) + soft(upper_material));
   const double a = half_width, P = 1e-3 * modulus, radius = M_PI * modulus * a * a / (4 * P);
   mfem::Mesh low = half_plane(below, false, 0),
              high = half_plane(above, true, curved ? radius : 0);
   ElasticBody lower(low, order, lower_material), upper(high, order, upper_material);
   const BoundaryPart far({3, 4});
   lower.fix(far, 0);
   lower.fix(far, 1);
   upper.add_displacement("shift", far, 0, 1.0);
   upper.add_traction("P", 3, 0.0, -P / (2 * domain));
   BoundaryInterface face{"contact", {0, 1}, {1, 1}, slave};
   if (!curved)
   {
      face.gap = ScalarField([=](double x, double) { return 0.5 * x * x / radius; });
   }
   Reduction reduction = reduce({{"lower", &lower}, {"upper", &upper}}, {face});
   ReducedProblem &problem = reduction.problem;
   set_friction(problem, f);
   Errors found;
   found.nodes = problem.nodes();
   const double p0 = 2 * P / (M_PI * a);
   const auto root = [](double x, double b)
   { return x * x < b * b ? std::sqrt(1 - x * x / (b * b)) : 0; };
   const auto compare =
      [&](const Eigen::VectorXd &force, const std::function<double(double)> &exact)
   {
      double off = 0, size = 0;
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         const double value = exact(problem.position(i, 0)), weight = problem.weights[i];
         off += weight * std::pow(force[i] / weight - value, 2);
         size += weight * value * value;
      }
      return std::sqrt(off / size);
   };
   MarchSettings settings;
   settings.increments = 20;
   ContactState state = ContactState::virgin(problem);
   std::vector<NamedLoads> points{{}, {{"P", 1}}};
   if (f > 0) { points.push_back({{"P", 1}, {"shift", 5 * f * P / modulus}}); }
   const MarchReport report =
      march(problem, LoadHistory::through(problem, points), state, settings,
            [&](const ContactState &now, const IncrementRecord &)
            {
               if (now.time == 1)
               {
                  // Curved sides slope by up to 2e-3, at the edge.
                  EXPECT_NEAR(now.p.sum() / P, 1, curved ? 1e-6 : 1e-9);
                  found.pressure = compare(now.p, [&](double x) { return p0 * root(x, a); });
               }
               const double Q = std::abs(now.q.sum()) / (f * P);
               if (now.time <= 1 || Q < 0.3 || Q > 0.8) { return; }
               const double c = a * std::sqrt(1 - Q);
               const double shear =
                  compare(now.q.cwiseAbs(),
                          [&](double x) { return f * p0 * (root(x, a) - c / a * root(x, c)); });
               found.shear = std::max(found.shear, shear);
               ++found.partial;
            });
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   return found;
}

// Without coupling though dissimilar, Dundurs' β = 0: (1 - 2ν)/G is the same.
const Material first{2.6, 0.3}, second{1.4, 0.4};

class NonMatching : public testing::TestWithParam<std::tuple<int, double>>
{
};

/// No worse than twice what nodes that match at the coarser side's spacing make of it,
/// whichever side is the slave.
TEST_P(NonMatching, CylindersHaveHertzsPressureAndCattaneosShear)
{
   const auto [order, ratio] = GetParam();
   const int coarse = 64 / order, fine = static_cast<int>(std::lround(coarse * ratio));
   const Errors matching = errors(coarse, coarse, order, SlaveSide::first, first, second);
   EXPECT_LT(matching.pressure, 0.01);
   for (const bool above : {true, false})
   {
      for (const SlaveSide slave : {SlaveSide::coarser, SlaveSide::finer})
      {
         const Errors other = above ? errors(coarse, fine, order, slave, first, second)
                                    : errors(fine, coarse, order, slave, first, second);
         std::cout << "order " << order << ", 1:" << ratio << ", "
                   << (above ? "upper" : "lower") << " finer, slave "
                   << (slave == SlaveSide::finer ? "finer" : "coarser") << ": pressure "
                   << other.pressure << " (matching " << matching.pressure << "), shear "
                   << other.shear << " (" << matching.shear << ")" << std::endl;
         EXPECT_GE(other.partial, 3);
         const double times = slave == SlaveSide::coarser ? 2 : 4;
         EXPECT_LT(other.pressure, times * matching.pressure);
         EXPECT_LT(other.shear, times * matching.shear);
      }
   }
}

INSTANTIATE_TEST_SUITE_P(Mortar, NonMatching,
                         testing::Combine(testing::Values(1, 2), testing::Values(1.37, 3.0)));

/// With the radius in the mesh, and bodies of very different stiffness without friction.
TEST(Mortar, CurvedAndDissimilarCylindersHaveHertzsPressure)
{
   const Material hard{100, 0.2}, soft{1, 0.45};
   for (int order : {1, 2})
   {
      const int n = 64 / order;
      for (const bool hard_below : {true, false})
      {
         const Material &low = hard_below ? hard : soft, &high = hard_below ? soft : hard;
         const double matching =
            errors(n, n, order, SlaveSide::first, low, high, false, 0).pressure;
         EXPECT_LT(matching, 0.02);
         for (bool curved : {false, true})
         {
            const int finer = curved ? 137 * n / 100 : 3 * n;
            const double found =
               errors(n, finer, order, SlaveSide::coarser, low, high, curved, 0).pressure;
            std::cout << "order " << order << ", " << (hard_below ? "hard" : "soft")
                      << " slave, " << finer << " on " << n << (curved ? ", curved" : "")
                      << ": pressure " << found << " (matching " << matching << ")"
                      << std::endl;
            EXPECT_LT(found, 2 * matching);
         }
      }
   }
}

/// The same of spheres, pressure p0 √(1 - r²/a²), a³ = 3 P R/(4 E*), p0 = 3 P/(2π a²): the
/// weight of the circumference and the axis.
double sphere_error(int below, int above, int order)
{
   const auto half_space = [](int elements, bool upper)
   {
      std::vector<double> contact;
      for (int k = 0; k <= elements; ++k) { contact.push_back(1.0 * k / elements); }
      mfem::Mesh mesh = half_space_mesh(contact, graded(0, 1, 1.0 / elements, 1.25),
                                        ring_scales(1.0, domain, 1.0 / elements, 1.25));
      if (!upper) { return mesh; }
      // Its mirror image, whose elements turn the other way round.
      mfem::Mesh mirrored(2, mesh.GetNV(), mesh.GetNE(), mesh.GetNBE());
      mfem::Array<int> at;
      for (int v = 0; v < mesh.GetNV(); ++v)
      {
         mirrored.AddVertex(mesh.GetVertex(v)[0], -mesh.GetVertex(v)[1]);
      }
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mesh.GetElementVertices(e, at);
         mirrored.AddQuad(at[3], at[2], at[1], at[0]);
      }
      for (int e = 0; e < mesh.GetNBE(); ++e)
      {
         mesh.GetBdrElementVertices(e, at);
         mirrored.AddBdrSegment(at[1], at[0], mesh.GetBdrAttribute(e));
      }
      mirrored.FinalizeQuadMesh(1, 0, true);
      return mirrored;
   };
   const double a = half_width, P = 1e-3, modulus = 1 / ((1 - 0.09) / 2.6 + (1 - 0.16) / 1.4),
                radius = 4 * modulus * a * a * a / (3 * P);
   mfem::Mesh low = half_space(below, false), high = half_space(above, true);
   ElasticBody lower(low, order, first, Formulation::axisymmetric),
      upper(high, order, second, Formulation::axisymmetric);
   lower.fix(BoundaryPart({3, 4}), 0);
   lower.fix(BoundaryPart({3, 4}), 1);
   upper.fix(4, 0);
   upper.add_traction("P", 3, 0.0, -P / (M_PI * domain * domain));
   BoundaryInterface face{"contact", {0, 1}, {1, 1}};
   face.gap = ScalarField([=](double r, double) { return 0.5 * r * r / radius; });
   Reduction reduction = reduce({{"lower", &lower}, {"upper", &upper}}, {face});
   const ReducedProblem &problem = reduction.problem;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem, LoadHistory::through(problem, {{}, {{"P", 1}}}), state);
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_NEAR(state.p.sum() / P, 1, 1e-9);
   double off = 0, size = 0;
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      const double r = problem.position(i, 0), weight = problem.weights[i];
      const double exact =
         r < a ? 1.5 * P / (M_PI * a * a) * std::sqrt(1 - r * r / (a * a)) : 0;
      off += weight * std::pow(state.p[i] / weight - exact, 2);
      size += weight * exact * exact;
   }
   return std::sqrt(off / size);
}

TEST(Mortar, SpheresHaveHertzsPressure)
{
   for (int order : {1, 2})
   {
      const int n = 36 / order;
      const double matching = sphere_error(n, n, order);
      EXPECT_LT(matching, 0.03);
      for (double ratio : {1.37, 3.0})
      {
         const int fine = static_cast<int>(std::lround(n * ratio));
         for (const bool upper : {true, false})
         {
            const double found =
               upper ? sphere_error(n, fine, order) : sphere_error(fine, n, order);
            std::cout << "spheres, order " << order << ", 1:" << ratio << ": pressure " << found
                      << " (matching " << matching << ")" << std::endl;
            EXPECT_LT(found, 2 * matching);
         }
      }
   }
}

} // namespace
