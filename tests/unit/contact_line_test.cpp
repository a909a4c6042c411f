#include "elastic_support.hpp"

namespace
{

using namespace cattaneo;
using namespace support;

TEST(ContactLine, FramesOfStraightLines)
{
   for (const char *kind : {"quads", "triangles", "nonconforming"})
   {
      mfem::Mesh mesh = block(kind);
      for (int order : {1, 2, 4})
      {
         ElasticBody body(mesh, order, Material{});
         const ContactLine bottom = contact_line(body, 1), top = contact_line(body, 3);
         for (Eigen::Index i = 0; i < bottom.size(); ++i)
         {
            EXPECT_EQ(bottom.tangent.row(i), Eigen::RowVector2d(1, 0));
            EXPECT_EQ(bottom.normal.row(i), Eigen::RowVector2d(0, 1));
            EXPECT_NEAR(bottom.arc_length[i], bottom.position(i, 0), 1e-14);
         }
         for (Eigen::Index i = 0; i < top.size(); ++i)
         {
            EXPECT_EQ(top.tangent.row(i), Eigen::RowVector2d(-1, 0));
            EXPECT_EQ(top.normal.row(i), Eigen::RowVector2d(0, -1));
            EXPECT_NEAR(top.arc_length[i], 2 - top.position(i, 0), 1e-14);
         }
         EXPECT_NEAR(bottom.weights.sum(), 2.0, 1e-14);
         EXPECT_NEAR(bottom.lumped_weights.sum(), 2.0, 1e-14);
         EXPECT_GT(bottom.weights.minCoeff(), 0.0);
      }
   }
   mfem::Mesh mesh = block("quads"); // four edges of 0.5
   ElasticBody linear(mesh, 1, Material{}), quadratic(mesh, 2, Material{});
   EXPECT_EQ(contact_line(linear, 1).size(), 5);
   const ContactLine line = contact_line(quadratic, 1);
   ASSERT_EQ(line.size(), 9);
   const double h = 0.5;
   for (int i = 0; i < 9; ++i)
   {
      // Simpson's weights: 1/6, 4/6, 1/6 of each edge.
      const bool end = i == 0 || i == 8;
      EXPECT_NEAR(line.weights[i], i % 2 ? 4 * h / 6 : (end ? h / 6 : 2 * h / 6), 1e-15);
      EXPECT_NEAR(line.lumped_weights[i], end ? h / 4 : h / 2, 1e-15);
      EXPECT_NEAR(line.spacing[i], h / 2, 1e-15);
      EXPECT_EQ(line.chain[i], 0);
   }
}

TEST(ContactLine, KeepsWholeElementsOfAnInterval)
{
   mfem::Mesh mesh = block("quads", 8, 2);
   ElasticBody body(mesh, 1, Material{});
   EXPECT_EQ(contact_line(body, {{1}, 0, 0.5, 1.5}).size(), 5);
   EXPECT_EQ(contact_line(body, {{1}, 0, 0.45, 1.55}).size(), 5);
   EXPECT_EQ(contact_line(body, {{1}, 0, 0.55, 1.45}).size(), 3);
   EXPECT_EQ(contact_line(body, {{1}, 0, 0.5 + 1e-11, 1.5}).size(), 5);
   expect_input_error(
      [&] {
         contact_line(body, {{1}, 0, 0.55, 0.7});
      },
      "no boundary elements inside");
   expect_input_error([&] { contact_line(body, 12); }, "no boundary attribute 12");
}

/// Vertices, elements and boundary elements in random order, boundary elements oriented at
/// random.
mfem::Mesh scrambled(int seed)
{
   const mfem::Mesh plain = block("quads", 6, 3);
   std::mt19937 random(seed);
   std::vector<int> vertex(plain.GetNV()), where(plain.GetNV()), element(plain.GetNE()),
      boundary(plain.GetNBE());
   for (auto *order : {&vertex, &element, &boundary})
   {
      for (std::size_t i = 0; i < order->size(); ++i) { (*order)[i] = static_cast<int>(i); }
      std::shuffle(order->begin(), order->end(), random);
   }
   for (std::size_t i = 0; i < vertex.size(); ++i) { where[vertex[i]] = static_cast<int>(i); }
   mfem::Mesh mesh(2, plain.GetNV(), plain.GetNE(), plain.GetNBE());
   for (int v : vertex) { mesh.AddVertex(plain.GetVertex(v)); }
   for (int e : element)
   {
      const int *v = plain.GetElement(e)->GetVertices();
      const int turn = static_cast<int>(random() % 4);
      mesh.AddQuad(where[v[turn]], where[v[(turn + 1) % 4]], where[v[(turn + 2) % 4]],
                   where[v[(turn + 3) % 4]]);
   }
   for (int b : boundary)
   {
      const int *v = plain.GetBdrElement(b)->GetVertices();
      const int flip = static_cast<int>(random() % 2);
      mesh.AddBdrSegment(where[v[flip]], where[v[1 - flip]], plain.GetBdrAttribute(b));
   }
   // Topology without letting the library put the boundary in order.
   mesh.FinalizeTopology(false);
   mesh.Finalize(false, false);
   return mesh;
}

TEST(ContactLine, IsOrderedWhateverTheNumberingAndOrientation)
{
   mfem::Mesh plain = block("quads", 6, 3);
   for (int order : {1, 3})
   {
      ElasticBody reference(plain, order, Material{});
      const ContactLine expected = contact_line(reference, BoundaryPart({1, 2}));
      for (int seed = 0; seed < 10; ++seed)
      {
         mfem::Mesh mesh = scrambled(seed);
         ElasticBody body(mesh, order, Material{});
         const ContactLine line = contact_line(body, BoundaryPart({2, 1}));
         EXPECT_LT(difference(line.position, expected.position), 1e-15);
         EXPECT_LT(difference(line.tangent, expected.tangent), 1e-15);
         EXPECT_LT(difference(line.normal, expected.normal), 1e-15);
         EXPECT_LT(difference(line.arc_length, expected.arc_length), 1e-15);
         EXPECT_LT(difference(line.weights, expected.weights), 1e-14);
         body.add_pressure("press", BoundaryPart({1, 2, 3, 4}), 1.0);
         EXPECT_NEAR(eigen(body.patterns()[0].values).sum(), 0.0, 1e-13);
      }
   }
}

TEST(ContactLine, AveragesTheNormalAtACorner)
{
   mfem::Mesh mesh = block("quads", 4, 2); // edges of 0.5 on the bottom and on the right
   ElasticBody body(mesh, 1, Material{});
   const ContactLine line = contact_line(body, BoundaryPart({1, 2}));
   ASSERT_EQ(line.size(), 7);
   EXPECT_NEAR(line.normal(4, 0), -std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(line.normal(4, 1), std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(line.arc_length[6], 3.0, 1e-14);
}

TEST(ContactLine, SeparateChainsAndClosedLoops)
{
   mfem::Mesh mesh = block("quads", 4, 2);
   ElasticBody body(mesh, 2, Material{});
   const ContactLine both = contact_line(body, BoundaryPart({1, 3}));
   ASSERT_EQ(both.size(), 18);
   EXPECT_EQ(both.chain[8], 0);
   EXPECT_EQ(both.chain[9], 1);
   EXPECT_NEAR(both.arc_length[8], 2.0, 1e-14);
   EXPECT_NEAR(both.arc_length[9], 2.0, 1e-14);
   EXPECT_NEAR(both.arc_length[17], 4.0, 1e-14);
   EXPECT_EQ(both.position(9, 0), 2.0);

   const ContactLine loop = contact_line(body, BoundaryPart({1, 2, 3, 4}));
   ASSERT_EQ(loop.size(), 24);
   EXPECT_EQ(loop.position(0, 0), 0.0);
   EXPECT_EQ(loop.position(0, 1), 0.0);
   EXPECT_NEAR(loop.weights.sum(), 6.0, 1e-14);
   EXPECT_NEAR(loop.lumped_weights.sum(), 6.0, 1e-14);
   EXPECT_NEAR(loop.lumped_weights[0], 0.25, 1e-15);
   EXPECT_NEAR(loop.arc_length[23], 5.75, 1e-14);
   EXPECT_NEAR(loop.normal(0, 0), std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(loop.normal(0, 1), std::sqrt(0.5), 1e-15);
}

/// Quarter ring between radii 1 and 2; attributes 1 inner arc, 2 y axis, 3 outer arc, 4 x axis.
mfem::Mesh quarter_ring(int order, int elements)
{
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 1, elements), uniform(0, 1, 2));
   mesh.SetCurvature(order);
   mesh.Transform(
      [](const mfem::Vector &in, mfem::Vector &out)
      {
         const double angle = M_PI / 2 * (1 - in(0)), radius = 1 + in(1);
         out.SetSize(2);
         out(0) = radius * std::cos(angle);
         out(1) = radius * std::sin(angle);
      });
   return mesh;
}

TEST(ContactLine, CurvedFramesAreThoseOfTheCircle)
{
   mfem::Mesh mesh = quarter_ring(10, 3);
   for (int order : {1, 2, 3})
   {
      ElasticBody body(mesh, order, Material{});
      const ContactLine inner = contact_line(body, 1), outer = contact_line(body, 3);
      EXPECT_NEAR(inner.weights.sum(), M_PI / 2, 1e-12);
      EXPECT_NEAR(outer.weights.sum(), M_PI, 1e-12);
      for (Eigen::Index i = 0; i < inner.size(); ++i)
      {
         // The material is outside the inner arc: the normal into it points outward.
         EXPECT_LT((inner.normal.row(i) - inner.position.row(i)).norm(), 1e-8);
         EXPECT_LT((outer.normal.row(i) + outer.position.row(i) / 2).norm(), 1e-8);
         EXPECT_NEAR(inner.arc_length[i],
                     std::atan2(inner.position(i, 0), inner.position(i, 1)), 1e-10);
      }
      body.add_pressure("bore", 1, 1.0);
      const VectorXd f = eigen(body.patterns()[0].values);
      double fx = 0;
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         fx += f[body.true_dof(node, 0)];
      }
      EXPECT_NEAR(fx, 1.0, 1e-13); // pressure times the chord's height
   }
}

TEST(ContactLine, IntervalOfACurvedEdgeIsCutWhereItShouldBe)
{
   mfem::Mesh mesh = quarter_ring(8, 2);
   ElasticBody body(mesh, 2, Material{});
   body.add_pressure("bore", BoundaryPart({1}, 1, 0.2, 0.7), 1.0);
   double fx = 0, fy = 0;
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      fx += body.patterns()[0].values(body.true_dof(node, 0));
      fy += body.patterns()[0].values(body.true_dof(node, 1));
   }
   EXPECT_NEAR(fx, 0.7 - 0.2, 1e-14);
   EXPECT_NEAR(fy, std::sqrt(1 - 0.04) - std::sqrt(1 - 0.49), 1e-7);
}

TEST(Pairing, FindsThePartnerOfEveryNode)
{
   const std::vector<double> x = graded_to_ends(1, 300, 0.01);
   mfem::Mesh up = rectangle_mesh(x, {0, 0.5, 1}),
              down = rectangle_mesh(x, {-1.25, -0.75, -0.25});
   ElasticBody upper(up, 2, Material{}), lower(down, 2, Material{});
   const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
   const Pairing pairing = pair_lines(line1, line2);
   const int n = static_cast<int>(line1.size());
   for (int i = 0; i < n; ++i)
   {
      EXPECT_EQ(pairing.partner[i], n - 1 - i);
      EXPECT_NEAR(pairing.gap[i], 0.25, 1e-15);
   }
   const Pairing swapped = pair_lines(line2, line1);
   EXPECT_EQ(swapped.partner, pairing.partner);
   EXPECT_LT((swapped.gap - pairing.gap).norm(), 1e-14);
}

TEST(Pairing, SaysWhichNodesHaveNoPartner)
{
   std::vector<double> x = uniform(0, 1, 4);
   mfem::Mesh up = rectangle_mesh(x, {0, 1});
   x[2] += 1e-5;
   mfem::Mesh down = rectangle_mesh(x, {-1, 0});
   ElasticBody upper(up, 1, Material{}), lower(down, 1, Material{});
   const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
   expect_input_error([&] { pair_lines(line1, line2); },
                      "of body 1 (5 nodes): (0.5, 0); of body 2 (5 nodes): (0.50001, 0)");
   EXPECT_EQ(pair_lines(line1, line2, 1e-3).partner[2], 2);
   mfem::Mesh fine = rectangle_mesh(uniform(0, 1, 40), {-1, 0});
   ElasticBody other(fine, 1, Material{});
   expect_input_error([&] { pair_lines(line1, contact_line(other, 3)); }, " … and 28 more");
   // Lines that look the same way do not face each other.
   expect_input_error([&] { pair_lines(line1, line1); }, "without a partner");
   expect_input_error([&] { pair_lines(line1, line2, 0.0); }, "tolerance is 0");
}

/// [-2, 2] × [0, 1] whose bottom is attribute 5 in |x| < 1, and is lifted by `rise` per x
/// beyond x = 1.
mfem::Mesh part_of_a_bottom(const char *kind, double rise)
{
   const std::vector<double> x = uniform(-2, 2, 16), y = uniform(0, 1, 4);
   mfem::Mesh mesh = kind == std::string("triangles")
                        ? mfem::Mesh::MakeSimplicial(rectangle_mesh(x, y))
                        : rectangle_mesh(x, y);
   if (kind == std::string("curved")) { mesh.SetCurvature(2); }
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      if (mesh.GetBdrAttribute(i) != 1) { continue; }
      mfem::Vector centre(2);
      mesh.GetBdrElementTransformation(i)->Transform(
         mfem::Geometries.GetCenter(mfem::Geometry::SEGMENT), centre);
      if (std::abs(centre(0)) < 1) { mesh.SetBdrAttribute(i, 5); }
   }
   mesh.SetAttributes();
   mesh.Transform(
      [rise](const mfem::Vector &from, mfem::Vector &to)
      {
         to = from;
         to(1) += rise * std::max(from(0) - 1, 0.0) * (1 - from(1));
      });
   return mesh;
}

TEST(ContactLine, KnowsHowTheBoundaryGoesOn)
{
   const double degree = std::acos(-1.0) / 180;
   for (const char *kind : {"quads", "triangles", "curved"})
   {
      // The part of an edge: smoothly to the left, by an angle to the right, either way.
      for (const double angle : {-30.0, -11.0, -9.0, 0.0, 9.0, 11.0, 30.0})
      {
         mfem::Mesh mesh = part_of_a_bottom(kind, std::tan(angle * degree));
         ElasticBody body(mesh, 1, Material{});
         const ContactLine line = contact_line(body, 5);
         ASSERT_EQ(line.chains.size(), 1u);
         EXPECT_EQ(line.chains[0].first, 0);
         EXPECT_EQ(line.chains[0].nodes, 9);
         EXPECT_FALSE(line.chains[0].loop);
         EXPECT_EQ(line.chains[0].ends[0], LineEnd::smooth) << kind;
         EXPECT_EQ(line.chains[0].ends[1],
                   std::abs(angle) < 10 ? LineEnd::smooth : LineEnd::corner)
            << kind << ' ' << angle;
         // The whole side ends at the block's corners.
         const ContactLine whole = contact_line(body, std::vector<int>{1, 5});
         EXPECT_EQ(whole.chains[0].ends[0], LineEnd::corner);
         EXPECT_EQ(whole.chains[0].ends[1], LineEnd::corner);
         // Along the top the line runs to -x; an interval of it has smooth ends.
         const ContactLine top = contact_line(body, {{3}, 0, -1.0, 2.0});
         EXPECT_EQ(top.chains[0].ends[0], LineEnd::corner);
         EXPECT_EQ(top.chains[0].ends[1], LineEnd::smooth);
         // Two pieces of the bottom, each with a corner outside.
         const ContactLine pieces = contact_line(body, 1);
         ASSERT_EQ(pieces.chains.size(), 2u);
         EXPECT_EQ(pieces.chains[1].first, 5);
         EXPECT_EQ(pieces.chains[1].nodes, 5);
         EXPECT_EQ(pieces.chains[0].ends[0], LineEnd::corner);
         EXPECT_EQ(pieces.chains[0].ends[1], LineEnd::smooth);
         EXPECT_EQ(pieces.chains[1].ends[1], LineEnd::corner);
      }
   }
}

TEST(ContactLine, LoopsAndTheAxisHaveNoEnds)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 2, Material{});
   const ContactLine around = contact_line(body, std::vector<int>{1, 2, 3, 4});
   ASSERT_EQ(around.chains.size(), 1u);
   EXPECT_TRUE(around.chains[0].loop);
   EXPECT_EQ(around.chains[0].nodes, around.size());
   EXPECT_EQ(around.chains[0].ends[0], LineEnd::smooth);
   // About an axis at r = 0, whose node is no contact node.
   ElasticBody disc(mesh, 2, Material{}, Geometry::axisymmetric);
   const ContactLine bottom = contact_line(disc, 1);
   EXPECT_EQ(bottom.chains[0].ends[0], LineEnd::axis);
   EXPECT_EQ(bottom.chains[0].ends[1], LineEnd::corner);
   EXPECT_EQ(bottom.chains[0].first, 0);
   EXPECT_EQ(bottom.chains[0].nodes, bottom.size());
}

TEST(ContactLine, EndsTravelInTheReducedProblem)
{
   // A punch of width 2 on the middle of a wider block: its corners, the block goes on.
   mfem::Mesh narrow = rectangle_mesh(uniform(-1, 1, 8), uniform(0, 1, 4));
   mfem::Mesh wide = part_of_a_bottom("quads", 0);
   wide.Transform(
      [](const mfem::Vector &x, mfem::Vector &y)
      {
         y = x;
         y *= -1; // the other way up
      });
   ElasticBody punch(narrow, 1, Material{}), block(wide, 1, Material{});
   block.fix(3, 0);
   block.fix(3, 1);
   const CondensedBody upper = condense(punch, contact_line(punch, 1)),
                       lower = condense(block, contact_line(block, 5));
   const auto ends = [](LineEnd a, LineEnd b) { return std::array<LineEnd, 2>{a, b}; };
   const auto both_corners = ends(LineEnd::corner, LineEnd::corner);
   const auto both_smooth = ends(LineEnd::smooth, LineEnd::smooth);
   const Reduction pair = reduce(upper, lower, pair_lines(upper.line, lower.line));
   ASSERT_EQ(pair.problem.chains.size(), 1u);
   EXPECT_EQ(pair.problem.chains[0].ends, both_corners);
   EXPECT_EQ(pair.problem.chains[0].other_ends, both_smooth);
   const Reduction turned = reduce(lower, upper, pair_lines(lower.line, upper.line));
   EXPECT_EQ(turned.problem.chains[0].ends, both_smooth);
   EXPECT_EQ(turned.problem.chains[0].other_ends, both_corners);
   const Reduction rigid = reduce(upper);
   EXPECT_EQ(rigid.problem.chains[0].ends, both_corners);
   EXPECT_EQ(rigid.problem.chains[0].other_ends, both_smooth);
   // Unequal ends stay at their ends: a corner of both at the right.
   mfem::Mesh shifted = rectangle_mesh(uniform(0, 2, 8), uniform(0, 1, 4));
   mfem::Mesh base = rectangle_mesh(uniform(-2, 2, 16), uniform(-1, 0, 4));
   ElasticBody right(shifted, 1, Material{}), under(base, 1, Material{});
   under.fix(1, 0);
   under.fix(1, 1);
   const CondensedBody a = condense(right, contact_line(right, 1)),
                       b = condense(under, contact_line(under, {{3}, 0, 0.0, 2.0}));
   const Reduction step = reduce(a, b, pair_lines(a.line, b.line));
   EXPECT_EQ(step.problem.chains[0].ends, both_corners);
   EXPECT_EQ(step.problem.chains[0].other_ends, ends(LineEnd::smooth, LineEnd::corner));
}

} // namespace
