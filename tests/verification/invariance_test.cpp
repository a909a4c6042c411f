// The whole chain, from mesh to march, must not care about units, orientation or numbering.

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Block |x| < L on a wider block, pressed and sheared by its top, in the units of a length `L`
/// and a modulus `E`, turned by `angle`, mirrored in x or with another numbering of the
/// elements.
struct Variant
{
   double L = 1, E = 1, angle = 0;
   bool mirrored = false, renumbered = false, swapped = false;
   int order = 2, increments = 6;
   Stepping stepping = Stepping::exact;
};

struct Result
{
   VectorXd v, p, q, w;
   double dissipation = 0, largest_residual = 0;
   long newton_steps = 0;
   FrictionStatus status = FrictionStatus::stalled;
};

mfem::Mesh place(mfem::Mesh mesh, const Variant &variant)
{
   const double c = std::cos(variant.angle), s = std::sin(variant.angle);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      const double a = x[0] * variant.L, b = x[1] * variant.L;
      x[0] = c * a - s * b;
      x[1] = s * a + c * b;
   }
   if (variant.renumbered)
   {
      mfem::Array<int> order;
      mesh.GetHilbertElementOrdering(order);
      mesh.ReorderElements(order);
   }
   return mesh;
}

Result solve(const Variant &variant)
{
   const std::vector<double> contact = graded_to_ends(1, 16, 0.2);
   mfem::Mesh upper_mesh = place(rectangle_mesh(contact, graded(0, 2, 0.05, 1.5)), variant);
   std::vector<double> depth = graded(0, -3, 0.05, 1.5);
   std::reverse(depth.begin(), depth.end());
   std::vector<double> left = graded(-1, -3, 0.05, 1.5);
   std::reverse(left.begin(), left.end());
   mfem::Mesh lower_mesh =
      place(rectangle_mesh(joined({left, contact, graded(1, 3, 0.05, 1.5)}), depth), variant);
   const Material soft{variant.E, 0.3}, hard{2.5 * variant.E, 0.2};
   ElasticBody upper(upper_mesh, variant.order, soft), lower(lower_mesh, variant.order, hard);
   const double c = std::cos(variant.angle), s = std::sin(variant.angle), L = variant.L;
   const double pressure = 1e-3 * variant.E, sense = variant.mirrored ? -1 : 1;
   upper.add_pressure("P", 3, pressure);
   const double shear = sense * 1e-3 * variant.E;
   upper.add_traction("Q", 3, shear * c, shear * s);
   upper.add_pressure(
      "Q", 3, [=](double x, double y) { return -6 * shear * (c * x + s * y) / (2 * L); });
   for (int component : {0, 1}) { lower.fix(1, component); }
   // The contact part of the wide block's top: by position, in its own frame.
   mfem::Mesh &mesh = lower_mesh;
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      mfem::Array<int> vertices;
      mesh.GetBdrElementVertices(i, vertices);
      double along = 0;
      for (int v : vertices)
      {
         along += 0.5 * (c * mesh.GetVertex(v)[0] + s * mesh.GetVertex(v)[1]) / L;
      }
      if (mesh.GetBdrAttribute(i) == 3 && std::abs(along) < 1) { mesh.SetBdrAttribute(i, 5); }
   }
   mesh.SetAttributes();
   const CondensedBody a = condense(upper, contact_line(upper, 1));
   const CondensedBody b = condense(lower, contact_line(lower, 5));
   Reduction reduction = variant.swapped ? reduce(b, a, pair_lines(b.line, a.line))
                                         : reduce(a, b, pair_lines(a.line, b.line));
   set_friction(reduction.problem, 0.3);
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.2), Vector2d(1, -0.2), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = 2;
   MarchSettings settings;
   settings.increments = variant.increments;
   settings.stepping = variant.stepping;
   ContactState state = ContactState::virgin(reduction.problem);
   const MarchReport report = march(reduction.problem, history, state, settings);
   Result result;
   result.v = state.v / L;
   result.w = state.w / L;
   result.p = state.p / (variant.E * L);
   result.q = state.q / (variant.E * L);
   result.dissipation = state.dissipation / (variant.E * L * L);
   result.largest_residual = report.largest_residual;
   result.newton_steps = report.counters.newton_steps;
   result.status = report.status;
   return result;
}

void expect_equal(const Result &a, const Result &b, double tolerance)
{
   EXPECT_EQ(a.status, FrictionStatus::converged);
   EXPECT_EQ(b.status, FrictionStatus::converged);
   const double slip = a.v.cwiseAbs().maxCoeff(), force = a.p.cwiseAbs().maxCoeff();
   EXPECT_LT((a.v - b.v).cwiseAbs().maxCoeff(), tolerance * slip);
   EXPECT_LT((a.p - b.p).cwiseAbs().maxCoeff(), tolerance * force);
   EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), tolerance * force);
   EXPECT_NEAR(a.dissipation, b.dissipation, tolerance * a.dissipation);
}

TEST(Invariance, SomethingHappens)
{
   const Result result = solve({});
   EXPECT_EQ(result.status, FrictionStatus::converged);
   EXPECT_GT(result.dissipation, 1e-9);
   EXPECT_LE(result.largest_residual, 1e-12);
}

TEST(Invariance, Units)
{
   const Result reference = solve({});
   // Metres and pascals, millimetres and megapascals, and far beyond: same answer, same work.
   for (const auto &[L, E] :
        {std::pair(1e-3, 1e11), std::pair(1.0, 1e5), std::pair(1e9, 1e9), std::pair(1e-9, 1e9),
         std::pair(1e9, 1e-9), std::pair(1e-9, 1e-9)})
   {
      Variant variant;
      variant.L = L;
      variant.E = E;
      const Result other = solve(variant);
      expect_equal(reference, other, 1e-9);
      EXPECT_EQ(reference.newton_steps, other.newton_steps) << "L = " << L << ", E = " << E;
   }
}

TEST(Invariance, Rotation)
{
   const Result reference = solve({});
   for (double angle : {0.3, 1.0, 2.5, M_PI, -1.7})
   {
      Variant variant;
      variant.angle = angle;
      expect_equal(reference, solve(variant), 1e-9);
   }
}

TEST(Invariance, Mirror)
{
   Variant variant;
   variant.mirrored = true;
   const Result reference = solve({});
   Result mirrored = solve(variant);
   mirrored.v = -mirrored.v.reverse().eval();
   mirrored.q = -mirrored.q.reverse().eval();
   mirrored.p = mirrored.p.reverse().eval();
   expect_equal(reference, mirrored, 1e-9);
}

TEST(Invariance, NumberingOfElements)
{
   Variant variant;
   variant.renumbered = true;
   expect_equal(solve({}), solve(variant), 1e-9);
}

TEST(Invariance, SwappingTheBodies)
{
   // Seen from body 2, tangents point the other way and nodes run the other way: so do slip and
   // shear in sign and order.
   Variant variant;
   variant.swapped = true;
   const Result reference = solve({});
   Result swapped = solve(variant);
   swapped.v = swapped.v.reverse().eval();
   swapped.q = swapped.q.reverse().eval();
   swapped.p = swapped.p.reverse().eval();
   expect_equal(reference, swapped, 1e-9);
}

TEST(Invariance, HalvingTheIncrementsConverges)
{
   // The limit of an invariance: cutting the path finer changes the loss less and less.
   double loss[4];
   for (int k = 0; k < 4; ++k)
   {
      Variant variant;
      variant.increments = 6 << k;
      variant.stepping = Stepping::fixed; // the exact path does not depend on them
      loss[k] = solve(variant).dissipation;
   }
   const double coarse = std::abs(loss[1] - loss[0]), fine = std::abs(loss[3] - loss[2]);
   EXPECT_LT(fine, 0.5 * coarse);
   EXPECT_LT(fine, 0.01 * loss[3]);
}

} // namespace
