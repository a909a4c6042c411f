#include "elastic_support.hpp"
#include "meshes_of_lines.hpp"

namespace
{

using namespace cattaneo;
using namespace support;
using cattaneo_test::ring_sector;
using cattaneo_test::scrambled;

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
            EXPECT_EQ(bottom.nodes[i].tangent, Eigen::Vector2d(1, 0));
            EXPECT_EQ(bottom.nodes[i].normal(), Eigen::Vector2d(0, 1));
            EXPECT_NEAR(bottom.nodes[i].arc_length, bottom.nodes[i].position[0], 1e-14);
         }
         for (Eigen::Index i = 0; i < top.size(); ++i)
         {
            EXPECT_EQ(top.nodes[i].tangent, Eigen::Vector2d(-1, 0));
            EXPECT_EQ(top.nodes[i].normal(), Eigen::Vector2d(0, -1));
            EXPECT_NEAR(top.nodes[i].arc_length, 2 - top.nodes[i].position[0], 1e-14);
         }
         EXPECT_NEAR(bottom.each(&LineNode::weight).sum(), 2.0, 1e-14);
         EXPECT_GT(bottom.each(&LineNode::weight).minCoeff(), 0.0);
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
      EXPECT_NEAR(line.nodes[i].weight, i % 2 ? 4 * h / 6 : (end ? h / 6 : 2 * h / 6), 1e-15);
      EXPECT_NEAR(line.nodes[i].spacing, h / 2, 1e-15);
      EXPECT_EQ(&line.chain_of(i), &line.chains[0]);
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
      "no boundary elements lie within");
   expect_input_error([&] { contact_line(body, 12); }, "no boundary attribute 12");
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
         mfem::Mesh mesh = scrambled(plain, seed);
         ElasticBody body(mesh, order, Material{});
         const ContactLine line = contact_line(body, BoundaryPart({2, 1}));
         EXPECT_LT(
            difference(line.each(&LineNode::position), expected.each(&LineNode::position)),
            1e-15);
         EXPECT_LT(difference(line.each(&LineNode::tangent), expected.each(&LineNode::tangent)),
                   1e-15);
         EXPECT_LT(difference(line.each(&LineNode::normal), expected.each(&LineNode::normal)),
                   1e-15);
         EXPECT_LT(
            difference(line.each(&LineNode::arc_length), expected.each(&LineNode::arc_length)),
            1e-15);
         EXPECT_LT(difference(line.each(&LineNode::weight), expected.each(&LineNode::weight)),
                   1e-14);
         body.add_pressure("press", BoundaryPart({1, 2, 3, 4}), 1.0);
         EXPECT_NEAR(body.patterns()[0].values.sum(), 0.0, 1e-13);
      }
   }
}

TEST(ContactLine, AveragesTheNormalAtACorner)
{
   mfem::Mesh mesh = block("quads", 4, 2); // edges of 0.5 on the bottom and on the right
   ElasticBody body(mesh, 1, Material{});
   const ContactLine line = contact_line(body, BoundaryPart({1, 2}));
   ASSERT_EQ(line.size(), 7);
   EXPECT_NEAR(line.nodes[4].normal()[0], -std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(line.nodes[4].normal()[1], std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(line.nodes[6].arc_length, 3.0, 1e-14);
}

TEST(ContactLine, SeparateChainsAndClosedLoops)
{
   mfem::Mesh mesh = block("quads", 4, 2);
   ElasticBody body(mesh, 2, Material{});
   const ContactLine both = contact_line(body, BoundaryPart({1, 3}));
   ASSERT_EQ(both.size(), 18);
   EXPECT_EQ(&both.chain_of(8), &both.chains[0]);
   EXPECT_EQ(&both.chain_of(9), &both.chains[1]);
   EXPECT_NEAR(both.nodes[8].arc_length, 2.0, 1e-14);
   EXPECT_NEAR(both.nodes[9].arc_length, 2.0, 1e-14);
   EXPECT_NEAR(both.nodes[17].arc_length, 4.0, 1e-14);
   EXPECT_EQ(both.nodes[9].position[0], 2.0);

   const ContactLine loop = contact_line(body, BoundaryPart({1, 2, 3, 4}));
   ASSERT_EQ(loop.size(), 24);
   EXPECT_EQ(loop.nodes[0].position[0], 0.0);
   EXPECT_EQ(loop.nodes[0].position[1], 0.0);
   EXPECT_NEAR(loop.each(&LineNode::weight).sum(), 6.0, 1e-14);
   EXPECT_NEAR(loop.nodes[23].arc_length, 5.75, 1e-14);
   EXPECT_NEAR(loop.nodes[0].normal()[0], std::sqrt(0.5), 1e-15);
   EXPECT_NEAR(loop.nodes[0].normal()[1], std::sqrt(0.5), 1e-15);
}

/// Quarter ring between radii 1 and 2; attributes 1 inner arc, 2 y axis, 3 outer arc, 4 x axis.
mfem::Mesh quarter_ring(int order, int elements)
{
   return ring_sector(order, elements, M_PI / 2, 0);
}

/// x(s) of an element by MFEM's own nodal basis of its order.
Eigen::Vector2d point_on(const LineElement &element, double s)
{
   const mfem::H1_SegmentElement basis(static_cast<int>(element.order()));
   mfem::IntegrationPoint ip;
   ip.x = s;
   mfem::Vector shape(basis.GetDof());
   basis.CalcShape(ip, shape);
   std::vector<int> along(shape.Size());
   std::iota(along.begin(), along.end(), 0);
   std::sort(along.begin(), along.end(),
             [&](int a, int b) { return basis.GetNodes()[a].x < basis.GetNodes()[b].x; });
   Eigen::Vector2d x(0, 0);
   for (int a = 0; a < shape.Size(); ++a) { x += shape(along[a]) * element.points.col(a); }
   return x;
}

TEST(ContactLine, ElementsAreTheBoundarysOwnInTheOrderOfTheLine)
{
   // An arc about the origin, in a mesh that is bent as the elements are: half way along an
   // element the mesh's own edge and the line's element are one curve.
   for (int order : {1, 2, 3, 5})
   {
      mfem::Mesh mesh = ring_sector(order, 4, M_PI / 2, 0);
      ElasticBody body(mesh, order, Material{});
      for (int attribute : {1, 3})
      {
         const ContactLine line = contact_line(body, attribute);
         const std::vector<LineElement> &elements = line.chains[0].elements;
         ASSERT_EQ(elements.size(), 4u);
         for (std::size_t e = 0; e < 4; ++e)
         {
            ASSERT_EQ(elements[e].order(), order);
            for (int a = 0; a <= order; ++a)
            {
               EXPECT_EQ(elements[e].nodes[a], static_cast<Eigen::Index>(e) * order + a);
               EXPECT_EQ(elements[e].points.col(a), line.nodes[elements[e].nodes[a]].position);
            }
            // The mesh's edge at its middle, of the element whose ends these are.
            const Eigen::Vector2d middle = point_on(elements[e], 0.5);
            double nearest = 1;
            for (int b = 0; b < mesh.GetNBE(); ++b)
            {
               if (mesh.GetBdrAttribute(b) != attribute) { continue; }
               mfem::Vector x(2);
               mesh.GetBdrElementTransformation(b)->Transform(
                  mfem::Geometries.GetCenter(mfem::Geometry::SEGMENT), x);
               nearest = std::min(nearest, (middle - Eigen::Vector2d(x(0), x(1))).norm());
            }
            EXPECT_LT(nearest, 1e-14) << order;
         }
      }
   }
   // A loop's last element ends at its first node.
   mfem::Mesh plain = block("quads", 4, 2);
   ElasticBody body(plain, 2, Material{});
   const ContactLine loop = contact_line(body, BoundaryPart({1, 2, 3, 4}));
   ASSERT_EQ(loop.chains[0].elements.size(), 12u);
   EXPECT_EQ(loop.chains[0].elements[11].nodes, (std::vector<Eigen::Index>{22, 23, 0}));
   // Two chains count on; a node on the axis is none of the line, but its place is known.
   ElasticBody disc(plain, 2, Material{}, Formulation::axisymmetric);
   const ContactLine faces = contact_line(disc, BoundaryPart({1, 3}));
   EXPECT_EQ(faces.formulation, Formulation::axisymmetric);
   ASSERT_EQ(faces.chains.size(), 2u);
   const LineElement &first = faces.chains[0].elements.front(),
                     &last = faces.chains[1].elements.back();
   EXPECT_EQ(first.nodes, (std::vector<Eigen::Index>{-1, 0, 1}));
   EXPECT_EQ(last.nodes, (std::vector<Eigen::Index>{14, 15, -1}));
   EXPECT_EQ(faces.chains[1].elements.front().nodes, (std::vector<Eigen::Index>{8, 9, 10}));
   EXPECT_EQ(first.points.col(0), Eigen::Vector2d(0, 0));
   EXPECT_EQ(last.points.col(2), Eigen::Vector2d(0, 1));
}

TEST(ContactLine, CurvedFramesAreThoseOfTheCircle)
{
   mfem::Mesh mesh = quarter_ring(10, 3);
   for (int order : {1, 2, 3})
   {
      ElasticBody body(mesh, order, Material{});
      const ContactLine inner = contact_line(body, 1), outer = contact_line(body, 3);
      EXPECT_NEAR(inner.each(&LineNode::weight).sum(), M_PI / 2, 1e-12);
      EXPECT_NEAR(outer.each(&LineNode::weight).sum(), M_PI, 1e-12);
      for (Eigen::Index i = 0; i < inner.size(); ++i)
      {
         // The material is outside the inner arc: the normal into it points outward.
         EXPECT_LT((inner.nodes[i].normal() - inner.nodes[i].position).norm(), 1e-8);
         EXPECT_LT((outer.nodes[i].normal() + outer.nodes[i].position / 2).norm(), 1e-8);
         EXPECT_NEAR(inner.nodes[i].arc_length,
                     std::atan2(inner.nodes[i].position[0], inner.nodes[i].position[1]), 1e-10);
      }
      body.add_pressure("bore", 1, 1.0);
      const VectorXd f = body.patterns()[0].values;
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
   // 1e-5 over the shorter distance of nodes there, 0.25 - 1e-5, and a little more.
   expect_input_error(
      [&] { pair_lines(line1, line2); },
      "a tolerance of 4.1e-05 would pair all nodes; the nearest nodes are 0 apart");
   EXPECT_EQ(pair_lines(line1, line2, 4.1e-5).partner[2], 2);
   EXPECT_EQ(pair_lines(line1, line2, 1e-3).partner[2], 2);
   mfem::Mesh fine = rectangle_mesh(uniform(0, 1, 40), {-1, 0});
   ElasticBody other(fine, 1, Material{});
   expect_input_error([&] { pair_lines(line1, contact_line(other, 3)); }, " … and 28 more");
   // Lines that look the same way do not face each other.
   expect_input_error([&] { pair_lines(line1, line1); }, "without a partner");
   expect_input_error([&] { pair_lines(line1, line1); }, "do not face each other");
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

TEST(ContactLine, KnowsHowTheBoundaryGoesOnHoweverItIsTurned)
{
   const double degree = std::acos(-1.0) / 180;
   for (const char *kind : {"quads", "triangles", "curved"})
   {
      for (const double turn : {25.0, 65.0, 160.0, -115.0})
      {
         for (const double angle : {-11.0, -9.0, 9.0, 11.0})
         {
            mfem::Mesh mesh = part_of_a_bottom(kind, std::tan(angle * degree));
            rotate(mesh, turn * degree);
            const ContactLine line = contact_line(ElasticBody(mesh, 1, Material{}), 5);
            ASSERT_EQ(line.chains.size(), 1u);
            EXPECT_EQ(line.chains[0].ends[0], LineEnd::smooth) << kind << ' ' << turn;
            EXPECT_EQ(line.chains[0].ends[1],
                      std::abs(angle) < 10 ? LineEnd::smooth : LineEnd::corner)
               << kind << ' ' << turn << ' ' << angle;
         }
      }
   }
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
