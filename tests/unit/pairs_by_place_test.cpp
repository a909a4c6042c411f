// Nodes that coincide where elements do not: orders that differ, normals that differ.
#include "elastic_support.hpp"

#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/interfaces.hpp>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Index;

/// Two plates, 0 < x < 6 and 2 high each, whose nodes between them coincide: 6 elements of
/// order 2 above, 12 of order 1 below. The lower one may lean up by a slope.
struct Plates
{
   mfem::Mesh upper_mesh = rectangle_mesh(uniform(0, 6, 6), uniform(0, 2, 2)), lower_mesh;
   std::unique_ptr<ElasticBody> upper, lower;
   CondensedBody first, second;
   InterfaceSide on, below;

   Plates(double young_above, double young_below, double slope = 0)
   {
      lower_mesh = rectangle_mesh(uniform(0, 6, 12), uniform(-2, 0, 2));
      for (int v = 0; v < lower_mesh.GetNV(); ++v)
      {
         double *x = lower_mesh.GetVertex(v);
         x[1] += slope * x[0];
      }
      upper = std::make_unique<ElasticBody>(upper_mesh, 2, Material{young_above, 0.3});
      lower = std::make_unique<ElasticBody>(lower_mesh, 1, Material{young_below, 0.3});
      upper->fix(left, 0);
      lower->fix(left, 0);
      lower->fix(bottom, 1);
      upper->add_pressure("P", top, 1.0);
      on = {0, contact_line(*upper, bottom)};
      below = {1, contact_line(*lower, top)};
      first = condense(*upper, on.line);
      second = condense(*lower, below.line);
   }
   Reduction reduced(SlaveSide slave) const
   {
      const std::vector<Interface> one{{"i", on, below, slave}};
      return reduce(std::vector<CondensedBody>{first, second}, one);
   }
};

ContactState pressed(const Reduction &reduction, double factor = 1)
{
   const ReducedProblem &problem = reduction.problem;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem, LoadHistory::through(problem, {{}, {{"P", factor}}}), state);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   return state;
}

/// Without friction each plate shortens by 2 (1 - ν²)/E under the pressure 1, everywhere.
TEST(PairsByPlace, AUniformPressureIsUniformWhateverTheOrders)
{
   for (const auto &[above, below] : {std::array<double, 2>{1e3, 1e3}, {1e6, 1e3}, {1e3, 1e6}})
   {
      const Plates plates(above, below);
      for (const SlaveSide slave :
           {SlaveSide::coarser, SlaveSide::finer, SlaveSide::first, SlaveSide::second})
      {
         const Reduction reduction = plates.reduced(slave);
         EXPECT_FALSE(reduction.interfaces[0].matching);
         EXPECT_FALSE(reduction.interfaces[0].differing.has_value());
         const ContactState state = pressed(reduction);
         const ReducedProblem &problem = reduction.problem;
         ASSERT_EQ(problem.nodes(), 13);
         for (Index i = 0; i < problem.nodes(); ++i)
         {
            // A slave that is 1000 times as stiff loses three digits, which is not chosen.
            const bool asked = slave == SlaveSide::first || slave == SlaveSide::second;
            EXPECT_NEAR(state.p[i] / problem.weights[i], 1, asked ? 1e-11 : 1e-12)
               << above << " on " << below << ", node " << i;
         }
         const double shortened = 2 * (1 - 0.3 * 0.3) * (1 / above + 1 / below);
         EXPECT_NEAR(conjugates(problem, state)[0], 6 * shortened, 1e-11 * 6 * shortened);
         EXPECT_TRUE(geometry_warnings(reduction, state.p).empty());
      }
   }
}

/// An edge of a tenth of its neighbours is no matter while the pressure is uniform, and is
/// named where its nodes bear more than the others.
TEST(PairsByPlace, ShortEdgesThatBearMoreThanTheirNeighboursAreNamed)
{
   mfem::Mesh mesh = rectangle_mesh({0, 1, 2, 3, 3.1, 4, 5, 6}, uniform(0, 2, 2));
   ElasticBody body(mesh, 1, Material{1e3, 0.3});
   body.fix(left, 0);
   body.add_pressure("P", top, 1.0);
   const ContactLine line = contact_line(body, bottom);
   const Reduction reduction = reduce(condense(body, line));
   const VectorXd even = reduction.problem.weights;
   EXPECT_TRUE(geometry_warnings(reduction, even).empty());
   for (Index i = 0; i < even.size(); ++i)
   {
      VectorXd uneven = even;
      uneven[i] *= 1.5;
      const double x = reduction.interfaces[0].position(i, 0);
      const bool at_short_edge = x > 2.9 && x < 3.2;
      const std::vector<std::string> said = geometry_warnings(reduction, uneven);
      ASSERT_EQ(said.size(), at_short_edge ? 1u : 0u) << x;
      if (at_short_edge)
      {
         EXPECT_NE(said[0].find("has 1.5 times"), std::string::npos) << said[0];
      }
   }
}

/// One to one is what was asked for, and what comes of it is said.
TEST(PairsByPlace, APairingThatIsAskedForIsTakenAndWarnedOf)
{
   const Plates plates(1e3, 1e6);
   EXPECT_FALSE(matching_nodes(plates.first.line, plates.second.line).has_value());
   const Pairing pairs = pair_lines(plates.first.line, plates.second.line);
   EXPECT_GE(differing_element(plates.first.line, plates.second.line, pairs), 0);
   Interface one{"i", plates.on, plates.below};
   one.pairing = pairs;
   const std::vector<CondensedBody> both{plates.first, plates.second};
   for (const Reduction &reduction :
        {reduce(plates.first, plates.second, pairs), reduce(both, std::vector<Interface>{one})})
   {
      ASSERT_TRUE(reduction.interfaces[0].differing.has_value());
      EXPECT_EQ((*reduction.interfaces[0].differing)[1], 0);
      const ContactState state = pressed(reduction);
      const VectorXd pressure = state.p.cwiseQuotient(reduction.problem.weights);
      EXPECT_GT(pressure.maxCoeff(), 1.05); // what is warned of
      const std::vector<std::string> said = geometry_warnings(reduction, state.p);
      ASSERT_EQ(said.size(), 1u);
      EXPECT_NE(said[0].find("elements of the bodies differ"), std::string::npos) << said[0];
   }
   // Elements that are the same are paired, and nothing is said.
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 6, 6), uniform(-2, 0, 2));
   const ElasticBody equal(mesh, 2, Material{1e3, 0.3});
   EXPECT_TRUE(matching_nodes(plates.first.line, contact_line(equal, top)).has_value());
}

/// Rings of elements of order 2 whose nodes coincide, one turned by half an element.
TEST(PairsByPlace, ElementsOfALoopMayBeSetOffByHalfOfOne)
{
   const auto ring = [](int turned, bool outer)
   {
      const int n = 16;
      ContactLine line;
      LineChain chain;
      chain.loop = true;
      chain.nodes = n;
      for (int k = 0; k < n; ++k)
      {
         // Against each other: the body on the left.
         const double angle = 2 * std::acos(-1.0) * (outer ? -k : k + turned) / n;
         LineNode node;
         node.dofs = {2 * k, 2 * k + 1};
         node.position = {std::cos(angle), std::sin(angle)};
         node.tangent = {-std::sin(angle), std::cos(angle)};
         if (outer) { node.tangent = -node.tangent; }
         node.weight = 0.4; // as if they were of order 1: elements alone tell
         node.arc_length = k * 0.39;
         node.spacing = 0.39;
         line.nodes.push_back(node);
      }
      for (int k = 0; k < n; k += 2)
      {
         LineElement element;
         element.nodes = {k, k + 1, (k + 2) % n};
         element.points.resize(2, 3);
         for (int a : {0, 1, 2})
         {
            element.points.col(a) = line.nodes[element.nodes[a]].position;
         }
         chain.elements.push_back(element);
      }
      line.chains = {chain};
      return line;
   };
   EXPECT_TRUE(matching_nodes(ring(0, false), ring(0, true)).has_value());
   EXPECT_TRUE(matching_nodes(ring(2, false), ring(0, true)).has_value());
   EXPECT_FALSE(matching_nodes(ring(1, false), ring(0, true)).has_value());
   // Without elements weights are what is left.
   ContactLine one = ring(1, false), other = ring(0, true);
   one.chains[0].elements.clear();
   EXPECT_TRUE(matching_nodes(one, other).has_value());
   for (std::size_t k = 0; k < 16; ++k) { one.nodes[k].weight = k % 2 ? 0.52 : 0.26; }
   EXPECT_FALSE(matching_nodes(one, other).has_value());
}

/// Normals that differ by 0.12: not small against friction of 0.1, small against 0.7.
TEST(PairsByPlace, NormalsThatDifferAreSaidWhereTheyBear)
{
   const Plates plates(1e3, 1e3, 0.12);
   Interface one{"wedge", plates.on, plates.below};
   one.gap = 0.0;
   Interface paired = one;
   paired.pairing = pair_lines(plates.first.line, plates.second.line, 0.2);
   for (const bool by_pairs : {false, true})
   {
      Reduction reduction = reduce(std::vector<CondensedBody>{plates.first, plates.second},
                                   std::vector<Interface>{by_pairs ? paired : one});
      const double turn = std::atan(0.12);
      for (Index i = 0; i < reduction.problem.nodes(); ++i)
      {
         EXPECT_NEAR(reduction.interfaces[0].turn[i], turn, 1e-12);
      }
      const VectorXd p = VectorXd::Ones(reduction.problem.nodes());
      const auto normals = [&](double friction, const VectorXd &forces)
      {
         set_friction(reduction.problem, friction);
         std::string all;
         for (const std::string &said : geometry_warnings(reduction, forces))
         {
            if (said.find("normals") != std::string::npos) { all += said; }
         }
         return all;
      };
      EXPECT_NE(normals(0.1, p).find("differ by 0.1194 rad (6.843 degrees), which is not small "
                                     "compared with the friction 0.1"),
                std::string::npos)
         << normals(0.1, p);
      EXPECT_EQ(normals(0.7, p), "");
      EXPECT_EQ(normals(0, p), "");
      EXPECT_EQ(normals(0.1, 0 * p), "");
      // The node that bears is the one that is named.
      VectorXd last = 0 * p;
      last[4] = 2;
      EXPECT_NE(normals(0.1, last).find("at node 4 at ("), std::string::npos);
   }
   const Plates flat(1e3, 1e3);
   Reduction agree = flat.reduced(SlaveSide::first);
   set_friction(agree.problem, 1e-3);
   EXPECT_TRUE(geometry_warnings(agree, VectorXd::Ones(13)).empty());
   expect_input_error([&] { geometry_warnings(agree, VectorXd::Ones(2)); },
                      "geometry warnings: 2 normal forces, must be 13");
}

} // namespace
