// Ends of a contact that a support holds: planes of symmetry, and supports that are none.
#include "elastic_support.hpp"

#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/interfaces.hpp>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Index;
using Eigen::Vector2d;

/// [0, 2] × [y, y + 1], leaning up by a slope along x, its sides upright; turned by quarters.
mfem::Mesh leaning(int elements, double y, double slope, int quarters)
{
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 2, elements), uniform(y, y + 1, 3));
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      x[1] += slope * x[0];
   }
   rotate(mesh, quarters * std::acos(-1.0) / 2);
   return mesh;
}

Vector2d turned(const Vector2d &of, int quarters)
{
   Vector2d made = of;
   for (int k = 0; k < quarters; ++k) { made = Vector2d(-made[1], made[0]); }
   return made;
}

/// The force that a contact transfers, in the directions of the block before it was turned.
Vector2d force_on(const Reduction &reduction, const ContactState &state, int quarters)
{
   Vector2d sum(0, 0);
   const InterfaceReport &face = reduction.interfaces[0];
   for (Index i = 0; i < face.nodes; ++i)
   {
      const Vector2d t = face.tangent.row(i), n(-t[1], t[0]);
      sum += (face.of_second ? -1 : 1) * (state.q[i] * t + state.p[i] * n);
   }
   return turned(sum, 4 - quarters);
}

/// A block on a slope, pressed down by 10 per length, without friction: what it stands on
/// pushes it across the slope, whatever supports hold of it along the level.
struct OnASlope
{
   double slope;
   int quarters;
   bool both_ends;
   mfem::Mesh mesh, base_mesh;
   std::unique_ptr<ElasticBody> block, base;
   ContactLine line, below;

   OnASlope(double slope, int quarters = 0, bool both_ends = false, int elements = 6,
            bool base_held = false)
      : slope(slope), quarters(quarters), both_ends(both_ends),
        mesh(leaning(6, 0, slope, quarters)), base_mesh(leaning(elements, -1, slope, quarters))
   {
      block = std::make_unique<ElasticBody>(mesh, 2, Material{1100, 0.0});
      base = std::make_unique<ElasticBody>(base_mesh, 2, Material{1100, 0.2});
      const int level = quarters % 2;
      block->fix(left, level);
      if (both_ends) { block->fix(right, level); }
      for (int c : {0, 1}) { base->fix(bottom, c); }
      if (base_held) { base->fix(left, level); }
      const Vector2d down = turned({0, -10}, quarters);
      block->add_traction("G", top, down[0], down[1]);
      line = contact_line(*block, bottom);
      below = contact_line(*base, top);
   }
   void expect_across(Reduction reduction, const std::string &what) const
   {
      ContactState state = ContactState::virgin(reduction.problem);
      const MarchReport report = march(
         reduction.problem, LoadHistory::through(reduction.problem, {{}, {{"G", 1}}}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << what;
      const Vector2d force = force_on(reduction, state, quarters);
      // The top is 2 √(1 + slope²) long.
      EXPECT_NEAR(std::abs(force[1]), 20 * std::hypot(1, slope), 1e-8) << what;
      EXPECT_NEAR(force[0] / force[1], -slope, 1e-9) << what;
   }
};

TEST(HeldEnd, ABlockOnASlopeIsPushedAcrossIt)
{
   for (const double slope : {0.17, 0.1, -0.1, 0.03, 2e-3, 2e-4, 1e-4, 1e-6, 1e-8, 0.0})
   {
      for (const auto &[quarters, both_ends] :
           std::vector<std::pair<int, bool>>{{0, false}, {1, false}, {0, true}, {3, true}})
      {
         const std::string scene = "slope " + std::to_string(slope) + ", turned " +
                                   std::to_string(quarters) + (both_ends ? ", both ends" : "");
         for (const int elements : {6, 9})
         {
            for (const bool base_held : {false, true})
            {
               const OnASlope of(slope, quarters, both_ends, elements, base_held);
               const CondensedBody block = condense(*of.block, of.line),
                                   base = condense(*of.base, of.below);
               const std::string what =
                  scene + ", " + std::to_string(elements) + (base_held ? ", base held" : "");
               const std::vector<CondensedBody> both{block, base};
               for (const SlaveSide slave : {SlaveSide::second, SlaveSide::coarser})
               {
                  const std::vector<Interface> one{{"i", {0, of.line}, {1, of.below}, slave}};
                  of.expect_across(reduce(both, one),
                                   what + ", slave " + std::to_string(int(slave)));
               }
               if (elements != 6) { continue; }
               const Pairing pairs = pair_lines(block.line, base.line);
               of.expect_across(reduce(block, base, pairs), what + ", paired");
               of.expect_across(reduce(base, block, pair_lines(base.line, block.line)),
                                what + ", paired the other way");
            }
         }
         const OnASlope of(slope, quarters, both_ends);
         const CondensedBody block = condense(*of.block, of.line);
         of.expect_across(reduce(block), scene + ", on an obstacle");
         const std::vector<Interface> floor{{"floor", {0, of.line}, {}}};
         of.expect_across(reduce(std::vector<CondensedBody>{block}, floor),
                          scene + ", at an interface with an obstacle");
         HalfPlane ground;
         ground.material = {1100, 0.2};
         ground.depth = 100;
         ground.point = Vector2d(0, 0);
         ground.normal = turned(Vector2d(slope, -1).normalized(), quarters);
         ground.symmetric = false;
         of.expect_across(reduce(block, ground), scene + ", on a half-plane");
      }
   }
}

/// From a hundredth of a degree on a support is no plane of symmetry, and nobody has to say so.
TEST(HeldEnd, APlaneOfSymmetryIsOneToAHundredthOfADegree)
{
   for (const auto &[degrees, symmetric] : std::vector<std::pair<double, bool>>{
           {0, true}, {0.009, true}, {0.011, false}, {5, false}})
   {
      const OnASlope of(std::tan(degrees * std::acos(-1.0) / 180));
      const CondensedBody block = condense(*of.block, of.line);
      const ContactLine &line = block.line;
      const std::size_t end = line.nodes.front().position[0] < 1e-9 ? 0 : 1;
      EXPECT_EQ(line.chains[0].ends[end], symmetric ? LineEnd::symmetry : LineEnd::corner)
         << degrees;
      // The line's own normal is kept, whatever its end is taken for.
      const Vector2d normal = Vector2d(-of.slope, 1).normalized();
      EXPECT_NEAR((line.nodes[end ? line.size() - 1 : 0].normal() - normal).norm(), 0, 1e-12);
      const Reduction reduction = reduce(block);
      const std::vector<std::string> said =
         geometry_warnings(reduction, VectorXd::Ones(line.size()));
      EXPECT_EQ(said.size(), degrees == 0.009 ? 1u : 0u);
      if (!said.empty())
      {
         EXPECT_NE(said[0].find("is taken for a plane of symmetry, although the line is 0.009 "
                                "degrees off it"),
                   std::string::npos)
            << said[0];
      }
      HalfPlane ground{{1100, 0.2}, 100};
      ground.normal = -normal;
      Reduction standing;
      if (symmetric)
      {
         expect_input_error([&] { standing = reduce(block, ground); }, "a plane of symmetry");
         const std::vector<Interface> foot{{"foot", {0, of.line}, {1, {}}}};
         expect_input_error([&] { reduce(std::vector<CondensedBody>{block}, foot, ground); },
                            "a plane of symmetry");
      }
      else { standing = reduce(block, ground); }
   }
}

/// Chords of a circle that meets its plane of symmetry at 90 degrees do so themselves, and
/// chords of one that does not, do not. The circle has the radius 10.
TEST(HeldEnd, ChordsOfACurveMeetItsPlaneOfSymmetry)
{
   const auto held_end = [](double from, int order)
   {
      mfem::Mesh mesh = rectangle_mesh(uniform(0, 2, 8), uniform(0, 1, 3));
      // MFEM 4.6 takes no lambda that captures.
      mfem::VectorFunctionCoefficient arc(2,
                                          [=](const mfem::Vector &x, mfem::Vector &y)
                                          {
                                             const double angle = from + 0.1 * x(0);
                                             y(0) = (10 - x(1)) * std::sin(angle);
                                             y(1) = -(10 - x(1)) * std::cos(angle);
                                          });
      mesh.Transform(arc);
      ElasticBody body(mesh, order, Material{1, 0.3});
      body.fix_node((10) * std::sin(from), -10 * std::cos(from), 0);
      body.fix(top, 1);
      const CondensedBody condensed = condense(body, contact_line(body, bottom));
      const LineChain &chain = condensed.line.chains[0];
      const bool symmetric = chain.ends[0] == LineEnd::symmetry;
      EXPECT_EQ(condensed.line.nodes[0].normal() == Vector2d(0, 1), symmetric);
      return symmetric;
   };
   for (int order : {1, 2, 3})
   {
      EXPECT_TRUE(held_end(0, order)) << order;
      EXPECT_FALSE(held_end(0.05, order)) << order;
      EXPECT_FALSE(held_end(-0.05, order)) << order;
      // Half of a chord, as if the node held were the middle of one.
      EXPECT_FALSE(held_end(0.0125, order)) << order;
   }
}

/// What a node that is held askew moves by is what its body moves it by.
TEST(HeldEnd, FieldsAndMatricesFollowANodeThatIsHeldAskew)
{
   const OnASlope of(0.1);
   CondensedBody block = condense(*of.block, of.line);
   const Index n = block.line.size();
   ASSERT_EQ(block.held.size(), 1u);
   EXPECT_LT(block.error_estimate(), 1e-9);
   // Its stiffness by the whole matrix, for displacements that are across what is held.
   const MatrixXd K = dense(of.block->stiffness());
   VectorXd u = VectorXd::LinSpaced(2 * n, -1, 2);
   u[block.held[0]] = 0;
   const VectorXd field = block.recover(u, VectorXd::Zero(1)), forces = K * field;
   VectorXd expected(2 * n);
   for (Index i = 0; i < n; ++i)
   {
      const LineNode &node = block.line.nodes[i];
      const Vector2d f(forces[node.dofs[0]], forces[node.dofs[1]]),
         moved(field[node.dofs[0]], field[node.dofs[1]]);
      EXPECT_NEAR(moved.dot(node.normal()), u[n + i], 1e-12);
      if (i == block.held[0])
      {
         EXPECT_EQ(moved[0], 0);
         expected[i] = 0;
         // Across what is held a force along the normal does what this one does.
         expected[n + i] = f[1] / node.normal()[1];
         continue;
      }
      EXPECT_NEAR(moved.dot(node.tangent), u[i], 1e-12);
      expected[i] = f.dot(node.tangent);
      expected[n + i] = f.dot(node.normal());
   }
   EXPECT_LT((block.S * u - expected).norm(), 1e-9 * expected.norm());
   // An obstacle may move along what is free, which slides along its slope there.
   Reduction reduction = reduce(block);
   reduction.add_obstacle_motion("up", 0.0, 1.0);
   expect_input_error([&] { reduction.add_obstacle_motion("along", 1.0, 0.0); },
                      "along the fixed component of the node (0, 0)");
}

/// How friction is shared with a support is not determined, which is said.
TEST(HeldEnd, FrictionThatASupportMayTakeIsSaid)
{
   const OnASlope of(0.1);
   Reduction reduction = reduce(condense(*of.block, of.line));
   const VectorXd p = VectorXd::Ones(reduction.problem.nodes());
   EXPECT_TRUE(geometry_warnings(reduction, p).empty()); // without friction
   set_friction(reduction.problem, 0.3);
   const std::vector<std::string> said = geometry_warnings(reduction, p);
   ASSERT_EQ(said.size(), 1u);
   EXPECT_NE(said[0].find("along x, 5.711 degrees off the contact there"), std::string::npos)
      << said[0];
}

} // namespace
