#include "comparison.hpp"
#include "elastic_support.hpp"
#include <limits>
#include <string>

namespace
{

using namespace cattaneo;
using namespace support;

/// Resultant of a force pattern.
Eigen::Vector2d total(const ElasticBody &body, int pattern = 0)
{
   // The sum over true dofs is the resultant: shape functions of the true dofs sum to one.
   Eigen::Vector2d sum(0, 0);
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      for (int c = 0; c < 2; ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0) { sum[c] += body.patterns()[pattern].values(dof); }
      }
   }
   return sum;
}

/// Moment about the origin.
double moment(const ElasticBody &body, int pattern = 0)
{
   double sum = 0;
   const mfem::DenseMatrix &x = body.node_coordinates();
   for (int node = 0; node < x.Width(); ++node)
   {
      const int fx = body.true_dof(node, 0), fy = body.true_dof(node, 1);
      if (fx < 0) { continue; }
      const Eigen::VectorXd &f = body.patterns()[pattern].values;
      sum += x(0, node) * f(fy) - x(1, node) * f(fx);
   }
   return sum;
}

TEST(Body, PartialPressureIsIntegratedExactly)
{
   for (const char *kind : {"quads", "triangles", "nonconforming"})
   {
      mfem::Mesh mesh = block(kind, 7, 3);
      for (int order : {1, 2, 3, 5})
      {
         ElasticBody body(mesh, order, Material{});
         const double a = 0.3141, b = 1.7321;
         const BoundaryPart top({3}, 0, a, b);
         body.add_pressure("constant", top, 2.5);
         body.add_pressure("cubic", top, [](double x, double) { return 1 + x * x * x; });
         body.add_traction(
            "both", top, [](double x, double) { return x; }, -0.5);
         body.add_pressure("sliver", BoundaryPart({3}, 0, 0.5, 0.5 + 1e-9), 1.0);
         EXPECT_NEAR(total(body, 0)[1], -2.5 * (b - a), 1e-14);
         EXPECT_NEAR(total(body, 0)[0], 0.0, 1e-15);
         EXPECT_NEAR(moment(body, 0), -2.5 * (b * b - a * a) / 2, 1e-14);
         const auto antiderivative = [](double x) { return x + std::pow(x, 4) / 4; };
         EXPECT_NEAR(total(body, 1)[1], antiderivative(a) - antiderivative(b), 1e-14);
         EXPECT_NEAR(total(body, 2)[0], (b * b - a * a) / 2, 1e-14);
         EXPECT_NEAR(total(body, 2)[1], -0.5 * (b - a), 1e-14);
         EXPECT_NEAR(total(body, 3)[1] / -1e-9, 1.0, 1e-6);
      }
   }
}

TEST(Body, PressureOnACurvedEdgeHasTheResultantOfItsChord)
{
   // A constant pressure pushes with p times the chord, whatever the curve between its ends is.
   mfem::Mesh mesh = block("curved", 5, 3);
   ElasticBody body(mesh, 2, Material{});
   const double a = 0.35, b = 1.45;
   body.add_pressure("bottom", BoundaryPart({1}, 0, a, b), 3.0);
   // On this edge the cubic geometry passes through the mapped nodes; find the ends on it.
   const ContactLine line = contact_line(body, 1);
   const auto height = [&](double x) { return 0.1 * std::sin(2 * x); };
   EXPECT_NEAR(total(body)[1], 3.0 * (b - a), 1e-13);
   EXPECT_NEAR(total(body)[0], -3.0 * (height(b) - height(a)),
               1e-4); // geometry is interpolated
   ASSERT_GT(line.size(), 0);

   body.add_pressure("all", BoundaryPart({1, 2, 3, 4}), 1.0);
   EXPECT_LT(total(body, 1).norm(), 1e-13);
   EXPECT_NEAR(moment(body, 1), 0.0, 1e-13);
}

TEST(Body, BodyForceHasItsResultant)
{
   for (const char *kind : {"quads", "triangles", "nonconforming"})
   {
      mfem::Mesh mesh = block(kind);
      ElasticBody body(mesh, 2, Material{});
      body.add_body_force(
         "weight", [](double x, double) { return x; }, -3.0);
      EXPECT_NEAR(total(body)[0], 2.0, 1e-13);
      EXPECT_NEAR(total(body)[1], -6.0, 1e-13);
   }
}

TEST(Body, LoadsThatVaryAreIntegratedExactly)
{
   // ∫ x² over [0, 2] × [0, 1] is 8/3, its moment 4; that of bilinear elements as of others.
   for (const char *kind : {"quads", "triangles"})
   {
      for (int order : {1, 2})
      {
         mfem::Mesh mesh = block(kind, 3, 2);
         ElasticBody body(mesh, order, Material{});
         body.add_body_force("weight", 0.0, [](double x, double) { return x * x; });
         EXPECT_NEAR(total(body)[0], 0, 1e-14);
         EXPECT_NEAR(total(body)[1], 8.0 / 3, 1e-13);
         EXPECT_NEAR(moment(body), 4, 1e-13);
         // A shear of x² and a pull of x³ on the top at y = 1.
         body.add_traction(
            "pull", 3, [](double x, double) { return x * x; },
            [](double x, double) { return x * x * x; });
         EXPECT_NEAR(total(body, 1)[0], 8.0 / 3, 1e-13);
         EXPECT_NEAR(total(body, 1)[1], 4, 1e-13);
         EXPECT_NEAR(moment(body, 1), 32.0 / 5 - 8.0 / 3, 1e-13);
      }
   }
   // Two components are not for a body that has but one.
   mfem::Mesh mesh = block("quads");
   ElasticBody shaft(mesh, 1, Material{}, Formulation::torsion), plane(mesh, 1, Material{});
   expect_input_error([&] { shaft.add_traction("t", 2, 1.0, 1.0); },
                      "component is 1, must be 0 (twist)");
   expect_input_error([&] { shaft.add_pressure("p", 2, 1.0); },
                      "component is 1, must be 0 (twist)");
   expect_input_error([&] { shaft.add_body_force("b", 1.0, 1.0); }, "must be 0 (twist)");
   expect_input_error([&] { plane.add_traction("t", 2, 1.0); },
                      "must be two (one only for torsion)");
   EXPECT_TRUE(shaft.patterns().empty());
   // What begins close to the axis is not on it.
   mfem::Mesh pipe = rectangle_mesh({1e-6, 0.5, 1}, {0, 1});
   EXPECT_EQ(
      ElasticBody(pipe, 1, Material{}, Formulation::axisymmetric).essential_dofs().Size(), 0);
}

TEST(Body, LoadsOfOnePatternAdd)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   body.add_pressure("p", 3, 1.0);
   body.add_pressure("p", {{3}, 0, 0.1, 0.6}, 2.0);
   body.add_body_force("p", 0.0, 1.0);
   ASSERT_EQ(body.patterns().size(), 1u);
   EXPECT_NEAR(total(body)[1], -2.0 - 1.0 + 2.0, 1e-14);
}

/// A linear displacement field has the stress that Hooke's law says, at any order, on any mesh.
TEST(Body, PassesThePatchTest)
{
   for (const char *kind : {"quads", "triangles", "nonconforming", "curved"})
   {
      for (auto state : {PlaneState::strain, PlaneState::stress})
      {
         mfem::Mesh mesh = block(kind);
         const int order = 3;
         const double E = 2.0, nu = 0.3;
         ElasticBody body(mesh, order, Material{E, nu, state});
         const mfem::DenseMatrix &x = body.node_coordinates();
         VectorXd U = VectorXd::Zero(body.stiffness().Height());
         for (int node = 0; node < x.Width(); ++node)
         {
            const int dx = body.true_dof(node, 0), dy = body.true_dof(node, 1);
            if (dx < 0) { continue; }
            U[dx] = 0.3 * x(0, node) + 0.1 * x(1, node);
            U[dy] = 0.4 * x(0, node) - 0.2 * x(1, node);
         }
         // Strains: 0.3, -0.2, shear 0.5. Stress by Hooke's law in three dimensions.
         const double G = E / (2 * (1 + nu));
         double sx, sy;
         if (state == PlaneState::strain)
         {
            const double factor = E / ((1 + nu) * (1 - 2 * nu));
            sx = factor * ((1 - nu) * 0.3 - nu * 0.2);
            sy = factor * (nu * 0.3 - (1 - nu) * 0.2);
         }
         else
         {
            sx = E / (1 - nu * nu) * (0.3 - nu * 0.2);
            sy = E / (1 - nu * nu) * (nu * 0.3 - 0.2);
         }
         const double area = kind == std::string("curved") ? 0.0 : 2.0;
         const VectorXd F = dense(body.stiffness()) * U;
         if (area > 0)
         {
            EXPECT_NEAR(0.5 * U.dot(F), 0.5 * area * (sx * 0.3 - sy * 0.2 + G * 0.25), 1e-12)
               << kind;
         }
         std::vector<bool> boundary(U.size(), false);
         mfem::Array<int> vdofs;
         mfem::FiniteElementSpace &space = body.space();
         for (int i = 0; i < mesh.GetNBE(); ++i)
         {
            space.GetBdrElementDofs(i, vdofs);
            for (int node : vdofs)
            {
               for (int c = 0; c < 2; ++c) { boundary[body.true_dof(node, c)] = true; }
            }
         }
         for (int i = 0; i < U.size(); ++i)
         {
            if (!boundary[i]) { EXPECT_NEAR(F[i], 0.0, 1e-12) << kind; }
         }
         EXPECT_DOUBLE_EQ(body.material(1).plane_modulus(),
                          state == PlaneState::strain ? E / (1 - nu * nu) : E);
      }
   }
}

TEST(Body, FixesTheNodesOfAPart)
{
   mfem::Mesh mesh = block("quads", 4, 4); // vertices every 0.5 in x, 0.25 in y
   ElasticBody body(mesh, 2, Material{});
   body.fix({{4}, 1, 0.25, 0.5}, 0); // inclusive: 0.25, 0.375, 0.5
   EXPECT_EQ(body.essential_dofs().Size(), 3);
   // Round-off of an interval's ends takes no node out, more of it does.
   ElasticBody same(mesh, 2, Material{}), fewer(mesh, 2, Material{});
   same.fix({{4}, 1, 0.25 + 1e-12, 0.5 - 1e-12}, 0);
   EXPECT_EQ(same.essential_dofs().Size(), 3);
   fewer.fix({{4}, 1, 0.25 + 1e-6, 0.5 - 1e-6}, 0);
   EXPECT_EQ(fewer.essential_dofs().Size(), 1);
   body.fix_node(1.97, 0.98, 1);
   ASSERT_EQ(body.essential_dofs().Size(), 4);
   const int expected = body.true_dof(24, 1); // vertex (2, 1)
   EXPECT_GE(body.essential_dofs().Find(expected), 0);
   body.add_displacement("pull", 2, 0, 0.5);
   EXPECT_EQ(body.essential_dofs().Size(), 4 + 9);
   // The same part again agrees with itself, another value does not.
   body.add_displacement("pull", BoundaryPart({2, 3}), 0, 0.5);
   expect_input_error([&] { body.add_displacement("pull", 2, 0, 0.6); },
                      "by one statement and");
   body.add_displacement("pull", 2, 0, 0.5 * (1 + 1e-10)); // round-off of a formula
   expect_input_error([&] { body.add_displacement("pull", 2, 0, 0.5 * (1 + 1e-7)); },
                      "by one statement and");
   body.add_displacement("other", 2, 0, 0.6);
}

TEST(Body, SaysWhatIsWrong)
{
   mfem::Mesh mesh = block("quads");
   expect_input_error([&] { ElasticBody(mesh, 0, Material{}); }, "order is 0");
   expect_input_error([&] { ElasticBody(mesh, 1, Material{}).add_pressure("", 1, 1.0); },
                      "a load pattern has no name");
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, Material{1.0, 0.5});
      },
      "below 0.5 in plane strain");
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, Material{1.0, nan_value});
      },
      "Poisson's ratio is nan");
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, Material{-1.0, 0.3});
      },
      "Young's modulus is -1");
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, Material{nan_value, 0.3});
      },
      "Young's modulus is nan");
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, Material{1.0, 1.0, PlaneState::stress});
      },
      "below 1 in plane stress");
   EXPECT_NO_THROW(ElasticBody(mesh, 1, Material{1.0, 0.5, PlaneState::stress}));
   for (const PlaneState state : {PlaneState::strain, PlaneState::stress})
   {
      expect_input_error(
         [&] {
            ElasticBody(mesh, 1, Material{1.0, -1.0, state});
         },
         "Poisson's ratio is -1, must be above -1");
      expect_input_error(
         [&] {
            ElasticBody(mesh, 1, Material{std::numeric_limits<double>::infinity(), 0.3, state});
         },
         "Young's modulus is inf");
   }
   expect_input_error([&] { ElasticBody(mesh, 1, std::vector<Material>()); }, "no material");
   expect_input_error(
      [&] { ElasticBody(mesh, 1, std::vector<Material>(mesh.attributes.Max() + 1)); },
      "materials, must be ");
   mesh.SetAttribute(2, 3);
   mesh.SetAttributes();
   expect_input_error(
      [&] {
         ElasticBody(mesh, 1, {Material{}, Material{}});
      },
      "element attribute 3");
   EXPECT_NO_THROW(ElasticBody(mesh, 1, Material{}));
   mfem::Mesh line = mfem::Mesh::MakeCartesian1D(1);
   expect_input_error([&] { ElasticBody(line, 1, Material{}); }, "dimension 1");
   mfem::Mesh broken = block("quads");
   broken.GetVertex(3)[0] = nan_value;
   expect_input_error([&] { ElasticBody(broken, 1, Material{}); }, "node 3");

   ElasticBody body(mesh, 1, Material{});
   expect_input_error([&] { body.fix(7, 0); }, "no boundary attribute 7; it has: 1, 2, 3, 4");
   expect_input_error([&] { body.fix(1, 2); }, "component is 2");
   expect_input_error(
      [&] {
         body.fix({{1}, 0, 5.0, 6.0}, 0);
      },
      "no nodes lie on the boundary part");
   expect_input_error([&] { body.fix({{1}, 0, 1.0, 0.0}, 0); }, "interval from 1 to 0");
   expect_input_error([&] { body.fix({{1}, 2, 0.0, 1.0}, 0); }, "axis of the interval is 2");
   expect_input_error([&] { body.fix({{1}, 0, nan_value, 1.0}, 0); }, "interval from nan");
   expect_input_error([&] { body.fix(BoundaryPart(std::vector<int>{}), 0); },
                      "no boundary attribute");
   expect_input_error([&] { body.fix_node(nan_value, 0, 0); }, "must be finite");
   expect_input_error([&] { body.add_pressure("p", 9, 1.0); }, "no boundary attribute 9");
   expect_input_error(
      [&] {
         body.add_pressure("p", {{3}, 0, 7, 8}, 1.0);
      },
      "no boundary elements lie on the boundary part");
   expect_input_error([&] { body.add_pressure("p", 3, nan_value); },
                      "pressure 'p': the value at");
   expect_input_error([&] { body.add_body_force("b", 0.0, nan_value); }, "body force 'b'");
   body.add_pressure("load", 3, 1.0);
   expect_input_error([&] { body.add_displacement("load", 2, 0, 1.0); }, "controlled by force");
   body.add_displacement("move", 2, 0, 1.0);
   expect_input_error([&] { body.add_traction("move", 3, 0.0, 1.0); },
                      "controlled by displacement");
   expect_input_error([&] { body.add_displacement("move", 2, 0, nan_value); }, "the value at");
   expect_input_error([&] { body.material(4); }, "element attribute 4");
}

TEST(Body, RefusesWhatAContactLineCannotUse)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody good(mesh, 2, Material{});
   const mfem::SparseMatrix &K = good.stiffness();
   for (int basis : {mfem::BasisType::Positive, mfem::BasisType::ClosedUniform})
   {
      mfem::H1_FECollection collection(2, 2, basis);
      mfem::FiniteElementSpace space(&mesh, &collection, 2);
      expect_input_error([&] { ElasticBody(space, K); }, "must be Gauss-Lobatto");
   }
   mfem::L2_FECollection discontinuous(2, 2);
   mfem::FiniteElementSpace l2(&mesh, &discontinuous, 2);
   expect_input_error([&] { ElasticBody(l2, K); }, "must be H1");
   mfem::H1_FECollection collection(2, 2);
   mfem::FiniteElementSpace scalar(&mesh, &collection, 1), space(&mesh, &collection, 2);
   expect_input_error([&] { ElasticBody(scalar, K); }, "1 components");
   mfem::Mesh refinable = block("nonconforming");
   mfem::FiniteElementSpace mixed(&refinable, &collection, 2);
   mixed.SetElementOrder(0, 3);
   mixed.Update(false);
   expect_input_error([&] { ElasticBody(mixed, K); }, "varies from element to element");
   mfem::SparseMatrix small(4);
   small.Finalize();
   expect_input_error([&] { ElasticBody(space, small); }, "4×4");
   mfem::SparseMatrix skew(K);
   skew.GetData()[skew.GetI()[5]] += 0.1;
   skew.GetData()[skew.GetI()[5] + 1] += 0.2;
   expect_input_error([&] { ElasticBody(space, skew); }, "not symmetric");
   mfem::SparseMatrix turned(K);
   turned *= -1;
   expect_input_error(
      [&]
      {
         const ElasticBody body(space, turned);
         condense(body, contact_line(body, 1));
      },
      "the stiffness of the contact nodes has a negative mean diagonal");
   // An asymmetry of 1e-8 of the largest entry is too much, one of 1e-12 is round-off.
   const double largest = K.MaxNorm();
   for (const double off : {1e-8, 1e-12})
   {
      mfem::SparseMatrix nearly(K);
      nearly.GetData()[nearly.GetI()[5] + 1] += off * largest;
      const auto take = [&] { ElasticBody(space, nearly); };
      if (off == 1e-8) { expect_input_error(take, "not symmetric"); }
      else { EXPECT_NO_THROW(take()); }
   }
   mfem::SparseMatrix infinite(K);
   infinite.GetData()[3] = nan_value;
   expect_input_error([&] { ElasticBody(space, infinite); }, "must be finite");
   mfem::SparseMatrix open(K.Height());
   expect_input_error([&] { ElasticBody(space, open); }, "not finalized");
}

TEST(GradedMesh, StepsGrowAndEndWhereTheyShould)
{
   for (double to : {1.0, -1.0, 37.3, 1e4})
   {
      const std::vector<double> x = graded(0.0, to, 0.01, 1.3, 500.0);
      EXPECT_EQ(x.front(), 0.0);
      EXPECT_EQ(x.back(), to);
      const double direction = to > 0 ? 1 : -1;
      EXPECT_NEAR(direction * (x[1] - x[0]), 0.01, 1e-15);
      for (std::size_t k = 1; k + 1 < x.size(); ++k)
      {
         const double ratio = (x[k + 1] - x[k]) / (x[k] - x[k - 1]);
         EXPECT_GT(direction * (x[k + 1] - x[k]), 0);
         EXPECT_GT(ratio, 0.74);
         EXPECT_LT(ratio, 1.3 * 1.26);
         EXPECT_LT(std::abs(x[k + 1] - x[k]), 500 * 1.26);
      }
   }
   EXPECT_EQ(graded(0, 1, 5, 1.2), (std::vector<double>{0, 1}));
   // 1 + 10 is 4 too much, more than a quarter of both: both are scaled by 7/11.
   const std::vector<double> scaled = graded(0, 7, 1, 10);
   ASSERT_EQ(scaled.size(), 3u);
   EXPECT_NEAR(scaled[1], 7.0 / 11, 1e-15);
   EXPECT_EQ(graded(2, 3, 0.25, 1.0), (std::vector<double>{2, 2.25, 2.5, 2.75, 3}));
   expect_input_error([] { graded(0, 0, 1, 1); }, "must be finite and different");
   expect_input_error([] { graded(0, 1, 0, 1); }, "first step is 0");
   expect_input_error([] { graded(0, 1, 0.1, 0.9); }, "growth is 0.9");
   expect_input_error([] { graded(0, 1, 1e-12, 1.0); }, "too small");
   expect_input_error([] { graded(0, 1, 0.1, 1.1, 0.0); }, "largest step is 0");
}

TEST(GradedMesh, LastStepsTakeUpWhatIsMissing)
{
   const auto expect = [](const std::vector<double> &found, const std::vector<double> &expected)
   {
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k)
      {
         EXPECT_NEAR(found[k], expected[k], 1e-14);
      }
   };
   // 0.1 is missing: of two steps, 0.6 ≥ 4·0.1; 0.05: of one; 0.05 too much: of one.
   expect(graded(0, 1, 0.3, 1), {0, 0.3, 0.65, 1});
   expect(graded(0, 0.95, 0.3, 1), {0, 0.3, 0.6, 0.95});
   expect(graded(1, 0, 0.35, 1), {1, 0.65, 0.3, 0});
   // Steps grow to the largest: 1, 2, 3, 3 and 1 of missing shared by the last two.
   expect(graded(0, 10, 1, 2, 3), {0, 1, 3, 6.5, 10});
   expect_input_error([] { joined({{0, 1}, {}}); }, "a list of coordinates is empty");
   expect_input_error([] { graded_to_ends(0, 4, 1); }, "half length is 0");
   expect_input_error([] { graded_to_ends(-1, 4, 1); }, "half length is -1");
}

TEST(GradedMesh, RingsGrowTwiceAsFastBeyondThreeHalfWidths)
{
   const std::vector<double> r = ring_scales(2, 100, 0.1, 1.25);
   EXPECT_EQ(r.front(), 1);
   EXPECT_NEAR(r.back(), 50, 1e-12);
   EXPECT_NEAR(r[1], 1.05, 1e-14); // first/a
   EXPECT_NEAR((r[2] - r[1]) / (r[1] - r[0]), 1.25, 1e-12);
   std::size_t k = 0;
   while (k + 1 < r.size() && r[k] < 3 - 1e-12) { ++k; }
   EXPECT_NEAR(r[k], 3, 1e-12);
   EXPECT_NEAR((r[k + 2] - r[k + 1]) / (r[k + 1] - r[k]), 1.5, 1e-12);
   EXPECT_NEAR(r[k + 1] - r[k], r[k] - r[k - 1], 1e-12); // as thick as the last one
   // But a tenth of the half-width at least.
   const std::vector<double> fine = ring_scales(1, 100, 0.01, 1.0);
   k = 0;
   while (k + 1 < fine.size() && fine[k] < 3 - 1e-12) { ++k; }
   EXPECT_NEAR(fine[k + 1] - fine[k], 0.1, 1e-12);
   expect_input_error([] { ring_scales(1, 4, 0.1, 1.2); }, "the domain is 4, must be above 4");
}

TEST(GradedMesh, HalfPlanesHaveTheirPartsAndOutline)
{
   // A box of 2 × 1 and a ring three times as large: 6 × 3.
   mfem::Mesh mesh = half_plane_mesh({-1, 0, 1}, {0, 0.5, 1}, {1, 2, 3});
   EXPECT_EQ(mesh.GetNE(), 4 + 2 * 6);
   ElasticBody body(mesh, 1, Material{});
   for (int part : {1, 2, 3, 4}) { body.add_pressure(std::to_string(part), part, 1.0); }
   body.add_traction("beside", 2, 1.0, 0.0);
   body.add_traction("sides", 4, 0.0, 1.0);
   EXPECT_NEAR(total(body, 0)[1], -2, 1e-14); // the contact
   EXPECT_NEAR(total(body, 1)[1], -4, 1e-14); // beside it
   EXPECT_NEAR(total(body, 2)[1], 6, 1e-14);  // below
   EXPECT_NEAR(total(body, 3).norm(), 0, 1e-14);
   EXPECT_NEAR(moment(body, 2), 0, 1e-13);
   EXPECT_NEAR(total(body, 4)[0], 4, 1e-14);
   EXPECT_NEAR(total(body, 5)[1], 2 * 3, 1e-14);
   body.add_body_force("area", 1.0, 0.0);
   EXPECT_NEAR(total(body, 6)[0], 18, 1e-13);
   const std::vector<double> line = {-1, 0, 1}, depth = {0, 1}, scale = {1, 2};
   expect_input_error(
      [&] {
         half_plane_mesh({-1, 0, 2}, depth, scale);
      },
      "the contact runs from -1 to 2, must be symmetric");
   expect_input_error([&] { half_plane_mesh(line, {0.5, 1}, scale); }, "depth starts at 0.5");
   expect_input_error([&] { half_plane_mesh(line, depth, {2, 3}); }, "scale starts at 2");
   expect_input_error(
      [&] {
         half_plane_mesh(line, depth, {1, 1});
      },
      "grid line 1 in scale is 1");
   expect_input_error(
      [&] {
         half_space_mesh({0.5, 1}, depth, scale);
      },
      "the contact starts at 0.5");
}

TEST(GradedMesh, IsSymmetricToTheLastBit)
{
   for (int n : {1, 2, 3, 10, 101, 256})
   {
      const std::vector<double> x = graded_to_ends(0.7, n, 0.05);
      ASSERT_EQ(x.size(), n + 1u);
      EXPECT_EQ(x.back(), 0.7);
      for (int i = 0; i <= n; ++i)
      {
         EXPECT_EQ(x[i], -x[n - i]);
         if (i > 0) { EXPECT_GT(x[i], x[i - 1]); }
      }
      if (n > 2) { EXPECT_NEAR((x[1] - x[0]) / (x[n / 2 + 1] - x[n / 2]), 0.05, 1e-12) << n; }
   }
   expect_input_error([] { graded_to_ends(1, 0, 1); }, "0 intervals");
   expect_input_error([] { graded_to_ends(1, 4, 1.5); }, "end ratio is 1.5");
   EXPECT_EQ(joined({{0, 1}, {1, 2, 3}}), (std::vector<double>{0, 1, 2, 3}));
   expect_input_error([] { joined({{0, 1}, {2, 3}}); }, "starts at 2");
}

TEST(GradedMesh, RectangleHasItsBoundaryAttributes)
{
   mfem::Mesh mesh = rectangle_mesh({-2, -1, 0, 5}, {0, 1e-3, 7});
   EXPECT_EQ(mesh.GetNE(), 6);
   EXPECT_EQ(mesh.GetNBE(), 10);
   ElasticBody body(mesh, 1, Material{});
   body.add_pressure("bottom", 1, 1.0);
   body.add_pressure("right", 2, 1.0);
   body.add_pressure("top", 3, 1.0);
   body.add_pressure("left", 4, 1.0);
   EXPECT_NEAR(total(body, 0)[1], 7, 1e-13);
   EXPECT_NEAR(total(body, 1)[0], -7, 1e-13);
   EXPECT_NEAR(total(body, 2)[1], -7, 1e-13);
   EXPECT_NEAR(total(body, 3)[0], 7, 1e-13);
   expect_input_error([] { rectangle_mesh({0, 1, 1}, {0, 1}); }, "grid line 2 in x is 1");
   expect_input_error([] { rectangle_mesh({0, 1}, {0}); }, "1 grid lines in y");
}

} // namespace
