#include "elastic_support.hpp"
#include "meshes_of_lines.hpp"

namespace
{

using namespace cattaneo;
using namespace support;
using cattaneo_test::ring_sector;
using cattaneo_test::scrambled;

/// The grid's cells without the one in the middle of three by three: attribute 1 around, 2 in
/// the hole.
mfem::Mesh frame(const std::vector<double> &x, const std::vector<double> &y)
{
   mfem::Mesh mesh(2, 16, 8, 16);
   for (double b : y)
   {
      for (double a : x) { mesh.AddVertex(a, b); }
   }
   for (int v : {0, 1, 2, 4, 6, 8, 9, 10}) { mesh.AddQuad(v, v + 1, v + 5, v + 4); }
   const int around[] = {0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4, 0}, hole[] = {5, 9, 10, 6, 5};
   for (int k = 0; k < 12; ++k) { mesh.AddBdrSegment(around[k], around[k + 1], 1); }
   for (int k = 0; k < 4; ++k) { mesh.AddBdrSegment(hole[k], hole[k + 1], 2); }
   mesh.FinalizeQuadMesh(1, 0, false);
   return mesh;
}

/// Corners with the points between them, `order` to an edge.
MatrixXd outline(const MatrixXd &corners, int order)
{
   const Eigen::Index n = corners.rows();
   MatrixXd points(n * order, 2);
   for (Eigen::Index i = 0; i < n * order; ++i)
   {
      const double s = static_cast<double>(i % order) / order;
      points.row(i) = (1 - s) * corners.row(i / order) + s * corners.row((i / order + 1) % n);
   }
   return points;
}

TEST(ContactLine, LoopsOfUnequalEdgesRunWithTheBodyOnTheLeftWhateverTheNumbering)
{
   const mfem::Mesh plain = frame({0, 1, 2.5, 3.5}, {0, 0.8, 2, 3});
   MatrixXd around(12, 2), hole(4, 2);
   around << 0, 0, 1, 0, 2.5, 0, 3.5, 0, 3.5, 0.8, 3.5, 2, 3.5, 3, 2.5, 3, 1, 3, 0, 3, 0, 2, 0,
      0.8;
   hole << 1, 0.8, 1, 2, 2.5, 2, 2.5, 0.8; // clockwise
   for (int order : {1, 2})
   {
      for (int seed = -1; seed < 6; ++seed)
      {
         mfem::Mesh mesh = seed < 0 ? mfem::Mesh(plain) : scrambled(plain, seed);
         ElasticBody body(mesh, order, Material{});
         const ContactLine line = contact_line(body, BoundaryPart({2, 1}));
         ASSERT_EQ(line.chains.size(), 2u);
         ASSERT_EQ(line.size(), 16 * order);
         double arc = 0;
         Eigen::Index at = 0;
         for (int c : {0, 1})
         {
            const MatrixXd points = outline(c ? hole : around, order);
            const Eigen::Index n = points.rows();
            EXPECT_TRUE(line.chains[c].loop);
            EXPECT_EQ(line.chains[c].first, at);
            EXPECT_EQ(line.chains[c].nodes, n);
            for (Eigen::Index i = 0; i < n; ++i, ++at)
            {
               const Eigen::RowVector2d to = points.row((i + 1) % n) - points.row(i),
                                        from = points.row(i) - points.row((i + n - 1) % n);
               const double after = to.norm(), before = from.norm();
               const Eigen::RowVector2d along = (to + from).normalized();
               EXPECT_LT((line.nodes[at].position - points.row(i).transpose()).norm(), 1e-15);
               EXPECT_LT((line.nodes[at].tangent - along.transpose()).norm(), 1e-14);
               EXPECT_NEAR(line.nodes[at].normal()[0], -along[1], 1e-14);
               EXPECT_NEAR(line.nodes[at].normal()[1], along[0], 1e-14);
               EXPECT_EQ(&line.chain_of(at), &line.chains[c]);
               EXPECT_NEAR(line.nodes[at].arc_length, arc, 1e-13);
               EXPECT_NEAR(line.nodes[at].spacing, std::min(before, after), 1e-14);
               // Linear elements give half of either edge, quadratic ones Simpson's weights.
               const double share = order == 1 ? 0.5 : i % 2 ? 2.0 / 3 : 1.0 / 3;
               EXPECT_NEAR(line.nodes[at].weight, share * (before + after), 1e-14);
               arc += after;
            }
         }
      }
   }
}

TEST(ContactLine, ChainsThatEndOnTheAxisStandBesideOthers)
{
   // The top of a disc up to r = 1, which runs to the axis, and its bottom beyond 1.25.
   mfem::Mesh mesh = rectangle_mesh({0, 0.25, 0.5, 1, 1.25, 1.5, 2}, {0, 1});
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      mfem::Array<int> v;
      mesh.GetBdrElementVertices(i, v);
      const double r = 0.5 * (mesh.GetVertex(v[0])[0] + mesh.GetVertex(v[1])[0]);
      const int attribute = mesh.GetBdrAttribute(i);
      if ((attribute == 3 && r < 1) || (attribute == 1 && r > 1.25))
      {
         mesh.SetBdrAttribute(i, 5);
      }
   }
   mesh.SetAttributes();
   const auto expect = [](const VectorXd &found, const std::vector<double> &expected)
   {
      ASSERT_EQ(found.size(), static_cast<Eigen::Index>(expected.size()));
      for (Eigen::Index i = 0; i < found.size(); ++i)
      {
         EXPECT_NEAR(found[i], expected[i], 1e-14) << i;
      }
   };
   const std::array<LineEnd, 2> inwards{LineEnd::smooth, LineEnd::symmetry},
      outwards{LineEnd::smooth, LineEnd::corner};
   for (int order : {1, 2})
   {
      ElasticBody disc(mesh, order, Material{}, Formulation::axisymmetric);
      const ContactLine line = contact_line(disc, 5);
      ASSERT_EQ(line.chains.size(), 2u);
      ASSERT_EQ(line.size(), 5 * order + 1);
      EXPECT_EQ(line.chains[0].first, 0);
      EXPECT_EQ(line.chains[0].nodes, 3 * order);
      EXPECT_EQ(line.chains[1].first, 3 * order);
      EXPECT_EQ(line.chains[0].ends, inwards);
      EXPECT_EQ(line.chains[1].ends, outwards);
      for (Eigen::Index i = 0; i < line.size(); ++i)
      {
         EXPECT_NEAR(line.nodes[i].tangent[0], line.chain_of(i).first ? 1 : -1, 1e-14);
      }
      // ∫ 2πr dr of each: the axis node's share stays with its own chain.
      const auto inner = line.chains[0].nodes, outer = line.chains[1].nodes;
      EXPECT_NEAR(line.each(&LineNode::weight).head(inner).sum(), M_PI, 1e-13);
      EXPECT_NEAR(line.each(&LineNode::weight).tail(outer).sum(), M_PI * (4 - 1.5625), 1e-13);
      if (order == 2) { continue; }
      expect(line.each(&LineNode::position).col(0), {1, 0.5, 0.25, 1.25, 1.5, 2});
      expect(line.each(&LineNode::arc_length), {0, 0.5, 0.75, 1, 1.25, 1.75});
      expect(line.each(&LineNode::spacing), {0.5, 0.25, 0.25, 0.25, 0.25, 0.5});
      // Hats: ∫ φ r dr over [a, b] is (b-a)(2a+b)/6 for the node at a, (b-a)(a+2b)/6 at b.
      expect(line.each(&LineNode::weight) / (2 * M_PI),
             {0.5 * 2.5 / 6, 0.5 * 2 / 6 + 0.25 * 1.25 / 6,
              0.25 * 1 / 6 + 0.25 * 0.5 / 6 + 0.25 * 0.25 / 6, 0.25 * 4 / 6,
              0.25 * 4.25 / 6 + 0.5 * 5 / 6, 0.5 * 5.5 / 6});
   }
}

TEST(ContactLine, ChainsThatStartAtTheSameXFollowEachOtherByY)
{
   mfem::Mesh plain = block("quads", 2, 5);
   for (int i = 0; i < plain.GetNBE(); ++i)
   {
      mfem::Array<int> v;
      plain.GetBdrElementVertices(i, v);
      const double y = plain.GetVertex(v[0])[1] + plain.GetVertex(v[1])[1];
      if (plain.GetBdrAttribute(i) == 2 && std::abs(y - 1) > 0.3)
      {
         plain.SetBdrAttribute(i, 5);
      }
   }
   plain.SetAttributes();
   for (int seed = 0; seed < 4; ++seed)
   {
      mfem::Mesh mesh = scrambled(plain, seed);
      ElasticBody body(mesh, 1, Material{});
      const ContactLine line = contact_line(body, 5);
      ASSERT_EQ(line.chains.size(), 2u);
      ASSERT_EQ(line.size(), 6); // two edges below and two above
      for (int i = 0; i < 6; ++i)
      {
         EXPECT_NEAR(line.nodes[i].position[1], i * 0.2, 1e-15) << i;
         EXPECT_NEAR(line.nodes[i].arc_length, (i - i / 3) * 0.2, 1e-15);
      }
   }
}

TEST(ContactLine, APartThatAnIntervalCutsFromAnArc)
{
   // Three edges of 40°. The middle one has its ends at y = sin 70° = 0.94, its top at y = 1.
   const double degree = std::acos(-1.0) / 180;
   mfem::Mesh mesh = ring_sector(8, 3, 150 * degree, 30 * degree);
   const auto ends = [](LineEnd a, LineEnd b) { return std::array<LineEnd, 2>{a, b}; };
   for (int order : {1, 2, 3})
   {
      ElasticBody body(mesh, order, Material{});
      const ContactLine middle = contact_line(body, {{1}, 1, 0.93, 2.0}),
                        all = contact_line(body, 1);
      EXPECT_EQ(middle.size(), order + 1);
      EXPECT_EQ(middle.chains[0].ends, ends(LineEnd::smooth, LineEnd::smooth));
      EXPECT_EQ(all.chains[0].ends, ends(LineEnd::corner, LineEnd::corner));
      // An element whose ends alone are inside is not; from order 2 on a node says so.
      if (order != 2) { continue; }
      const ContactLine sides = contact_line(body, {{1}, 1, -2.0, 0.99});
      ASSERT_EQ(sides.chains.size(), 2u);
      EXPECT_EQ(sides.chains[0].ends, ends(LineEnd::corner, LineEnd::smooth));
      EXPECT_EQ(sides.chains[1].ends, ends(LineEnd::smooth, LineEnd::corner));
      for (Eigen::Index i = 0; i < sides.size(); ++i)
      {
         const double angle =
            std::atan2(sides.nodes[i].position[1], sides.nodes[i].position[0]);
         EXPECT_NEAR(sides.nodes[i].arc_length,
                     (sides.chain_of(i).first ? 110 : 150) * degree - angle, 1e-8);
      }
   }
   // Chords turn at their nodes: those of 3° stand for the curve, and two of 15° that are
   // followed by more of the same; one of 40° alone does not.
   for (int elements : {3, 8, 40})
   {
      // On its side the line runs along the other axis, which changes nothing.
      mfem::Mesh side = ring_sector(1, elements, 60 * degree, -60 * degree);
      ElasticBody turned(side, 1, Material{});
      const ContactLine right = contact_line(turned, {{1}, 1, -0.35, 0.35});
      const LineEnd turn = elements == 3 ? LineEnd::corner : LineEnd::smooth;
      EXPECT_EQ(right.chains[0].ends, ends(turn, turn)) << elements;
      mfem::Mesh chords = ring_sector(1, elements, 150 * degree, 30 * degree);
      ElasticBody body(chords, 1, Material{});
      const ContactLine middle = contact_line(body, {{1}, 0, -0.35, 0.35});
      const LineEnd end = elements == 3 ? LineEnd::corner : LineEnd::smooth;
      EXPECT_EQ(middle.chains[0].ends, ends(end, end)) << elements;
   }
}

TEST(Body, LoadsOnThePartsThatAnIntervalCutsFromOneArc)
{
   // A pressure p on the inner arc has the force p ∫ (cos θ, sin θ) dθ. Where y < 0.99 the
   // edge at the top is cut twice.
   const double degree = std::acos(-1.0) / 180;
   mfem::Mesh mesh = ring_sector(8, 3, 150 * degree, 30 * degree);
   struct Case
   {
      int axis;
      double lo, hi;
      std::vector<double> from, to; // angles
   };
   const double high = std::asin(0.99), inf = std::numeric_limits<double>::infinity();
   for (const Case &c : {Case{1, -2, 0.99, {30 * degree, M_PI - high}, {high, 150 * degree}},
                         Case{1, 0.99, inf, {high}, {M_PI - high}},
                         Case{0, -0.1, 0.5, {std::acos(0.5)}, {std::acos(-0.1)}},
                         Case{0, 0, 0.75, {std::acos(0.75)}, {M_PI / 2}},
                         Case{0, -inf, 0, {M_PI / 2}, {150 * degree}}})
   {
      ElasticBody body(mesh, 2, Material{});
      body.add_pressure("bore", {{1}, c.axis, c.lo, c.hi}, 3.0);
      double force[2] = {0, 0};
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         for (int k : {0, 1}) { force[k] += body.patterns()[0].values(body.true_dof(node, k)); }
      }
      double x = 0, y = 0;
      for (std::size_t k = 0; k < c.from.size(); ++k)
      {
         x += std::sin(c.to[k]) - std::sin(c.from[k]);
         y += std::cos(c.from[k]) - std::cos(c.to[k]);
      }
      EXPECT_NEAR(force[0], 3 * x, 1e-7) << c.lo << ' ' << c.hi;
      EXPECT_NEAR(force[1], 3 * y, 1e-7) << c.lo << ' ' << c.hi;
   }
}

/// Bars of unequal steps in one mesh, one above the other, between each two heights.
mfem::Mesh bars(const std::vector<double> &x, const std::vector<std::array<double, 2>> &heights)
{
   const int n = static_cast<int>(x.size()), count = static_cast<int>(heights.size());
   mfem::Mesh mesh(2, 2 * n * count, (n - 1) * count, 2 * (n - 1) * count);
   for (int b = 0; b < count; ++b)
   {
      for (double y : heights[b])
      {
         for (double at : x) { mesh.AddVertex(at, y); }
      }
      const int low = 2 * n * b, high = low + n;
      for (int i = 0; i + 1 < n; ++i)
      {
         mesh.AddQuad(low + i, low + i + 1, high + i + 1, high + i);
         mesh.AddBdrSegment(low + i, low + i + 1, 1);
         mesh.AddBdrSegment(high + i, high + i + 1, 3);
      }
   }
   mesh.FinalizeQuadMesh(1, 0, false);
   return mesh;
}

/// Message of the refusal; empty if the lines were paired.
std::string refusal(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   try
   {
      pair_lines(line1, line2, tolerance);
      return "";
   }
   catch (const InputError &error)
   {
      return error.what();
   }
}

TEST(Pairing, AllowsAnOffsetByTheShorterEdgeOfEitherBody)
{
   // Edges of 0.1 at the left end only: an offset of 0.011 is too large for the nodes there.
   const std::vector<double> x = {0, 0.1, 0.5, 1.5, 2};
   const auto line = [](std::vector<double> at, double shift, bool upper)
   {
      for (double &value : at) { value += shift; }
      mfem::Mesh mesh = rectangle_mesh(at, upper ? uniform(0.25, 1, 1) : uniform(-1, 0, 1));
      ElasticBody body(mesh, 1, Material{});
      return contact_line(body, upper ? 1 : 3);
   };
   for (double sign : {1.0, -1.0})
   {
      const ContactLine above = line(x, 0, true), near = line(x, sign * 0.0099, false),
                        far = line(x, sign * 0.0101, false);
      // The line of the lower body runs to -x.
      const Pairing pairing = pair_lines(above, near, 0.1);
      for (int i = 0; i < 5; ++i)
      {
         EXPECT_EQ(pairing.partner[i], 4 - i);
         EXPECT_NEAR(pairing.gap[i], 0.25, 1e-15);
         EXPECT_NEAR(near.nodes[i].arc_length, 2 - x[4 - i], 1e-14);
      }
      EXPECT_NE(
         refusal(above, far, 0.1).find("of body 1 (5 nodes): (0, 0.25), (0.1, 0.25); of"),
         std::string::npos)
         << refusal(above, far, 0.1);
   }
   // Edges of 1 against one of 0.1 at x = 0, which decides on either side.
   const ContactLine wide = line({0, 1, 2}, 0, true), fine = line({0.03, 0.13, 2}, 0, false);
   EXPECT_NE(refusal(wide, fine, 0.1).find("of body 1 (3 nodes): (0, 0.25), (1, 0.25);"),
             std::string::npos);
   EXPECT_NE(refusal(fine, wide, 0.1).find("of body 2 (3 nodes): (0, 0.25), (1, 0.25)"),
             std::string::npos)
      << refusal(fine, wide, 0.1);
   // A gap of 1e-10 is round-off of edges of 1, not of those of 0.001.
   const ContactLine rough = line({0, 0.001, 1, 2}, 0, false);
   ContactLine lifted = line({0, 0.001, 1, 2}, 0, true);
   lifted.chains[0].elements.clear(); // which would have to be lifted, too
   for (LineNode &node : lifted.nodes) { node.position[1] = 1e-10; }
   const VectorXd gap = pair_lines(lifted, rough).gap;
   EXPECT_EQ(gap, Eigen::Vector4d(1e-10, 1e-10, 0, 0));
   for (LineNode &node : lifted.nodes) { node.position[1] = -1e-3; } // an overlap
   EXPECT_EQ(pair_lines(lifted, rough).gap, Eigen::Vector4d::Constant(-1e-3));
}

TEST(Pairing, TakesTheNearestOfSeveralLinesAndOnlyOnce)
{
   const std::vector<double> x = {0, 0.3, 1};
   mfem::Mesh upper = bars(x, {{1, 2}, {4, 5}}), lower = bars(x, {{0, 0.9}, {3, 3.8}}),
              below = bars(x, {{0, 0.9}, {-3, -2}});
   for (double angle : {0.0, 1.0, 2.5})
   {
      for (mfem::Mesh *mesh : {&upper, &lower, &below}) { rotate(*mesh, angle); }
      ElasticBody a(upper, 1, Material{}), b(lower, 1, Material{}), c(below, 1, Material{});
      const ContactLine bottoms = contact_line(a, 1), tops = contact_line(b, 3);
      const Pairing pairing = pair_lines(bottoms, tops);
      for (int i = 0; i < 6; ++i)
      {
         const Eigen::Vector2d across =
            bottoms.nodes[i].position - tops.nodes[pairing.partner[i]].position;
         const double expected = across.norm() < 0.15 ? 0.1 : 0.2;
         EXPECT_NEAR(across.norm(), expected, 1e-14);
         EXPECT_NEAR(pairing.gap[i], expected, 1e-14);
      }
      EXPECT_NEAR(pairing.gap.sum(), 3 * 0.1 + 3 * 0.2, 1e-13);
      for (mfem::Mesh *mesh : {&upper, &lower, &below}) { rotate(*mesh, -angle); }
   }
   // Both bars above face the upper one of those below, each of whose nodes has one partner.
   ElasticBody a(upper, 1, Material{}), c(below, 1, Material{});
   const std::string message = refusal(contact_line(a, 1), contact_line(c, 3), 1e-6);
   EXPECT_NE(message.find("of body 1 (6 nodes): (0, 4), (0.3, 4), (1, 4); of body 2 (6 nodes): "
                          "(1, -2), (0.3, -2), (0, -2)"),
             std::string::npos)
      << message;
}

/// Two blocks of a mesh side by side, not joined at x = 0, or a distance apart there.
mfem::Mesh two_blocks(double apart)
{
   mfem::Mesh left = rectangle_mesh(uniform(-1, 0, 4), {0, 1}),
              right = rectangle_mesh(uniform(apart, 1, 4), {0, 1});
   mfem::Mesh *both[] = {&left, &right};
   return {both, 2};
}

TEST(ContactLine, NodesThatLieOnOneAnotherAreRefused)
{
   for (double apart : {0.0, 1e-12, 1e-8})
   {
      mfem::Mesh mesh = two_blocks(apart);
      for (int order : {1, 2})
      {
         ElasticBody body(mesh, order, Material{});
         expect_input_error([&] { contact_line(body, 1); }, "two nodes coincide at (");
         // What is not in contact is the user's own: a crack, for instance.
         EXPECT_NO_THROW(contact_line(body, BoundaryPart({1}, 0, -1, -0.5)));
      }
   }
   mfem::Mesh slit = two_blocks(1e-3);
   EXPECT_NO_THROW(contact_line(ElasticBody(slit, 2, Material{}), 1));
}

TEST(ContactLine, AnEdgeNextToNothingBesideOthersIsRefused)
{
   for (const double thin : {1e-9, 1e-7})
   {
      mfem::Mesh mesh = rectangle_mesh({0, 0.5, 0.5 + thin, 1, 1.5}, {0, 0.5, 1});
      for (int order : {1, 2})
      {
         ElasticBody body(mesh, order, Material{});
         body.fix(3, 0);
         body.fix(3, 1);
         expect_input_error([&] { condense(body, contact_line(body, 1)); },
                            "the node at (0.5, 0) to its neighbours");
      }
   }
   // A grading reaches any length step by step.
   std::vector<double> x{0, 1};
   while (x[1] > 1e-9) { x.insert(x.begin() + 1, 0.1 * x[1]); }
   mfem::Mesh graded = rectangle_mesh(x, {0, 1});
   ElasticBody body(graded, 1, Material{});
   EXPECT_NO_THROW(contact_line(body, 1).validate());
}

/// Quads of the given corners, of which some edges are boundary elements, each with its
/// attribute.
mfem::Mesh patchwork(const std::vector<std::array<double, 2>> &corners,
                     const std::vector<std::array<int, 4>> &quads,
                     const std::vector<std::array<int, 3>> &edges)
{
   mfem::Mesh mesh(2, static_cast<int>(corners.size()), static_cast<int>(quads.size()),
                   static_cast<int>(edges.size()));
   for (const auto &x : corners) { mesh.AddVertex(x.data()); }
   for (const auto &v : quads) { mesh.AddQuad(v.data()); }
   for (const auto &[a, b, attribute] : edges) { mesh.AddBdrSegment(a, b, attribute); }
   mesh.FinalizeQuadMesh(1, 0, false);
   return mesh;
}

TEST(ContactLine, TheStraightestOfSeveralWaysOnDecides)
{
   // Two blocks that share one corner: from the upper one's bottom the lower one's top goes on.
   mfem::Mesh mesh(2, 7, 2, 1);
   for (const auto &[x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}, {2, 1}, {2, 2}, {1, 2}})
   {
      mesh.AddVertex(x, y);
   }
   mesh.AddQuad(0, 1, 2, 3);
   mesh.AddQuad(2, 4, 5, 6);
   mesh.AddBdrSegment(2, 4, 1);
   mesh.FinalizeQuadMesh(1, 0, false);
   ElasticBody body(mesh, 1, Material{});
   const ContactLine line = contact_line(body, 1);
   EXPECT_EQ(line.chains[0].ends[0], LineEnd::smooth);
   EXPECT_EQ(line.chains[0].ends[1], LineEnd::corner);
}

TEST(ContactLine, RefusesLinesThatForkTurnBackOrLieInside)
{
   // Two blocks that share the corner 2: of each, one edge runs to it and one away from it.
   const std::vector<std::array<double, 2>> tie = {{0, 0}, {1, 0}, {1, 1}, {0, 1},
                                                   {2, 1}, {2, 2}, {1, 2}};
   const auto fork = [&](const std::vector<std::array<int, 3>> &edges)
   {
      mfem::Mesh mesh = patchwork(tie, {{0, 1, 2, 3}, {2, 4, 5, 6}}, edges);
      ElasticBody body(mesh, 1, Material{});
      return contact_line(body, 1);
   };
   const char *forks = "more than two boundary elements meet at (1, 1)";
   expect_input_error([&] { fork({{1, 2, 1}, {6, 2, 1}}); }, forks);
   expect_input_error([&] { fork({{2, 3, 1}, {2, 4, 1}}); }, forks);
   EXPECT_EQ(fork({{1, 2, 1}, {2, 3, 1}}).size(), 3);
   // A slit from its tip 4 to the right: both faces meet there, and their tangents cancel.
   mfem::Mesh slit = patchwork(
      {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0, 2}, {1, 2}, {2, 2}, {2, 1}},
      {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 9, 8, 7}},
      {{4, 5, 1}, {4, 9, 1}, {3, 4, 2}});
   ElasticBody cracked(slit, 1, Material{});
   expect_input_error([&] { contact_line(cracked, 1); },
                      "the line turns back on itself at (1, 1)");
   for (const auto &act : {std::function<void()>([&] { contact_line(cracked, 2); }),
                           std::function<void()>([&] { cracked.fix(2, 0); }),
                           std::function<void()>([&] { cracked.add_pressure("p", 2, 1.0); })})
   {
      expect_input_error(act, "(attribute 2) lies between two elements");
   }
}

TEST(ContactLine, IntervalsOfAPartAreOfOneCoordinateAndMayBeAPoint)
{
   mfem::Mesh mesh = block("quads", 4, 2);
   ElasticBody body(mesh, 1, Material{});
   body.fix({{1, 3}, 0, 0.5, 0.5}, 1); // a node at the bottom, one at the top
   EXPECT_EQ(body.essential_dofs().Size(), 2);
   expect_input_error([&] { body.fix({{1}, 0, 0.6, 0.5}, 0); }, "to 0.5, must not be empty");
   expect_input_error([&] { body.fix({{1}, 2, 0, 1}, 0); }, "axis of the interval is 2");
   expect_input_error([&] { body.fix(std::vector<int>{}, 0); },
                      "no boundary attribute is named");
   expect_input_error(
      [&] {
         body.fix({{2, 4}, 1, 0.1, 0.2}, 0);
      },
      "boundary part with attributes 2, 4 and 0.1 <= y <= 0.2");
   expect_input_error(
      [&] {
         body.fix({{3}, 0, 0.1, 0.2}, 0);
      },
      "boundary part with attribute 3 and 0.1 <= x <= 0.2");
   const ContactLine line = contact_line(body, 2);
   expect_input_error([&] { pair_lines(line, line, 0.5); },
                      "tolerance is 0.5, must be above 0");
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
   ElasticBody disc(mesh, 2, Material{}, Formulation::axisymmetric);
   const ContactLine bottom = contact_line(disc, 1);
   EXPECT_EQ(bottom.chains[0].ends[0], LineEnd::symmetry);
   EXPECT_EQ(bottom.chains[0].ends[1], LineEnd::corner);
   EXPECT_EQ(bottom.chains[0].first, 0);
   EXPECT_EQ(bottom.chains[0].nodes, bottom.size());
}

TEST(ContactLine, OtherEndsWithinALineOfTheOtherBodyAndOfLoops)
{
   const auto ends = [](LineEnd a, LineEnd b) { return std::array<LineEnd, 2>{a, b}; };
   // Two blocks on one: its line runs from x = 3, where the block goes on, to its corner at 0.
   mfem::Mesh two(2, 8, 2, 2), one = rectangle_mesh(uniform(0, 4, 4), uniform(-1, 0, 2));
   for (double x : {0.0, 1.0, 2.0, 3.0})
   {
      for (double y : {0.0, 1.0}) { two.AddVertex(x, y); }
   }
   for (int v : {0, 4})
   {
      two.AddQuad(v, v + 2, v + 3, v + 1);
      two.AddBdrSegment(v, v + 2, 1);
   }
   two.FinalizeQuadMesh(1, 0, false);
   ElasticBody blocks(two, 1, Material{}), base(one, 1, Material{});
   base.fix(1, 0);
   base.fix(1, 1);
   const CondensedBody above = condense(blocks, contact_line(blocks, 1)),
                       below = condense(base, contact_line(base, {{3}, 0, 0.0, 3.0}));
   const Reduction reduction = reduce(above, below, pair_lines(above.line, below.line));
   const auto &chains = reduction.problem.chains;
   ASSERT_EQ(chains.size(), 2u);
   EXPECT_EQ(chains[0].other_ends, ends(LineEnd::corner, LineEnd::smooth));
   EXPECT_EQ(chains[1].other_ends, ends(LineEnd::smooth, LineEnd::smooth));
   EXPECT_EQ(chains[0].first, 0);
   EXPECT_EQ(chains[1].first, 2);
   EXPECT_EQ(chains[1].interface, "contact");

   // A block in a frame: both lines are loops, and run against each other from one corner.
   mfem::Mesh ring = frame({0, 1, 2.5, 3.5}, {0, 0.8, 2, 3}),
              filling = rectangle_mesh({1, 2.5}, {0.8, 2});
   ElasticBody hole(ring, 2, Material{}), block(filling, 2, Material{});
   hole.fix(1, 0);
   hole.fix(1, 1);
   const CondensedBody inner =
                          condense(block, contact_line(block, std::vector<int>{1, 2, 3, 4})),
                       outer = condense(hole, contact_line(hole, 2));
   const Pairing pairing = pair_lines(inner.line, outer.line);
   ASSERT_EQ(pairing.partner.size(), 8u);
   for (int i = 0; i < 8; ++i) { EXPECT_EQ(pairing.partner[i], (8 - i) % 8); }
   const Reduction loops = reduce(inner, outer, pairing);
   EXPECT_TRUE(loops.problem.chains[0].loop);
   EXPECT_EQ(loops.problem.chains[0].ends, ends(LineEnd::smooth, LineEnd::smooth));
   EXPECT_EQ(loops.problem.chains[0].other_ends, ends(LineEnd::smooth, LineEnd::smooth));

   // One linear element from the axis has one contact node. Of the other body's it is both the
   // end at the axis and the one from which the body goes on.
   mfem::Mesh pin = rectangle_mesh({0, 1}, {0, 1}), pad = rectangle_mesh({0, 1, 2}, {-1, 0});
   ElasticBody narrow(pin, 1, Material{}, Formulation::axisymmetric),
      wide(pad, 1, Material{}, Formulation::axisymmetric);
   wide.fix(1, 1);
   narrow.fix(3, 1);
   const CondensedBody a = condense(narrow, contact_line(narrow, 1)),
                       b = condense(wide, contact_line(wide, {{3}, 0, 0.0, 1.0}));
   ASSERT_EQ(a.line.size(), 1);
   const Reduction up = reduce(a, b, pair_lines(a.line, b.line));
   EXPECT_EQ(up.problem.chains[0].ends, ends(LineEnd::symmetry, LineEnd::corner));
   EXPECT_EQ(up.problem.chains[0].other_ends, ends(LineEnd::symmetry, LineEnd::symmetry));
   mfem::Mesh turned = rectangle_mesh({0, 1, 2}, {0, 1}),
              below_it = rectangle_mesh({0, 1}, {-1, 0});
   ElasticBody wide_above(turned, 1, Material{}, Formulation::axisymmetric),
      narrow_below(below_it, 1, Material{}, Formulation::axisymmetric);
   wide_above.fix(3, 1);
   narrow_below.fix(1, 1);
   const CondensedBody c = condense(narrow_below, contact_line(narrow_below, 3)),
                       d = condense(wide_above, contact_line(wide_above, {{1}, 0, 0.0, 1.0}));
   const Reduction down = reduce(c, d, pair_lines(c.line, d.line));
   EXPECT_EQ(down.problem.chains[0].ends, ends(LineEnd::corner, LineEnd::symmetry));
   EXPECT_EQ(down.problem.chains[0].other_ends, ends(LineEnd::symmetry, LineEnd::symmetry));
}

} // namespace
