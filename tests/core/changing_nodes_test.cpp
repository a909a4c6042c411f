#include <cattaneo/condense/condense.hpp>
#include <cattaneo/friction/changing_nodes.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <gtest/gtest.h>

// Nodes that keep their states while a load swings are left out of a march: what it comes to is
// that of all.

namespace
{

using namespace cattaneo;
using Eigen::VectorXd;

/// A parabola of another material on a half-plane, so that pressure and slip are coupled.
struct Parabola
{
   ReducedProblem problem;
   ContactState pressed;

   Parabola()
   {
      HalfPlane pad, plane;
      pad.material = Material{1, 0.3};
      plane.material = Material{3, 0.1};
      pad.depth = plane.depth = 100;
      pad.normal = {0, 1};
      pad.forces = {{"P", {0, -1}}, {"Q", {1, 0}}};
      std::vector<double> grid;
      for (int k = -60; k <= 60; k += 2) { grid.push_back(2.0 * k / 60); }
      problem = reduce(condense(pad, grid, 1), plane).problem;
      set_friction(problem, 0.4);
      problem.gap = problem.position.col(0).cwiseAbs2() / 2;
      pressed = ContactState::virgin(problem);
      march(problem, LoadHistory::through(problem, {{}, {{"P", 1}}}), pressed);
      pressed.time = 0;
   }
   /// Two cycles of Q from the present state.
   LoadHistory swing(double Q) const
   {
      LoadHistory made =
         LoadHistory::through(problem, {{{"P", 1}}, {{"Q", Q}}, {{"Q", -Q}}, {{"Q", Q}}}, 1, 2);
      return made;
   }
};

struct Row
{
   ContactState state;
   IncrementRecord record;
};

} // namespace

TEST(ChangingNodes, TheMarchIsThatOfAllNodes)
{
   const Parabola on;
   FrictionSolver solver(on.problem);
   ChangingNodes nodes(solver);
   MarchSettings settings;
   settings.increments = 4;
   settings.stop_at_steady_state = false;
   for (const double Q : {0.02, 0.1, 0.3})
   {
      SCOPED_TRACE(Q);
      std::vector<Row> all, few;
      ContactState whole = on.pressed;
      const MarchReport expected =
         march(solver, on.swing(Q), whole, settings,
               [&](const ContactState &state, const IncrementRecord &record) {
                  all.push_back({state, record});
               });
      ASSERT_EQ(expected.status, FrictionStatus::converged);
      ContactState state;
      MarchReport report;
      int marches = 0;
      do {
         few.clear();
         state = on.pressed;
         report = nodes.march(on.swing(Q), state, settings,
                              [&](const ContactState &now, const IncrementRecord &record) {
                                 few.push_back({now, record});
                              });
         ASSERT_LT(++marches, 20);
      } while (nodes.repeats());
      EXPECT_EQ(report.status, FrictionStatus::converged);
      EXPECT_LT(nodes.kept(), on.problem.nodes());
      ASSERT_EQ(few.size(), all.size());
      // Both obey the laws to 1e-12 of the largest force, and lengths follow from forces.
      const double force = whole.p.maxCoeff(),
                   length = whole.displacements().cwiseAbs().maxCoeff();
      for (std::size_t k = 0; k < all.size(); ++k)
      {
         SCOPED_TRACE(k);
         EXPECT_LT((few[k].state.forces() - all[k].state.forces()).cwiseAbs().maxCoeff(),
                   1e-10 * force);
         EXPECT_LT(
            (few[k].state.displacements() - all[k].state.displacements()).cwiseAbs().maxCoeff(),
            1e-10 * length);
         EXPECT_LT((few[k].record.conjugates - all[k].record.conjugates).cwiseAbs().maxCoeff(),
                   1e-10 * length);
         EXPECT_EQ(few[k].record.multipliers, all[k].record.multipliers);
         EXPECT_NEAR(few[k].record.dissipation, all[k].record.dissipation,
                     1e-10 * force * length);
      }
      ASSERT_EQ(report.cycles.size(), 2u);
      const VectorXd &lost = report.cycles[1].node_dissipation;
      ASSERT_EQ(lost.size(), on.problem.nodes());
      EXPECT_LT((lost - expected.cycles[1].node_dissipation).cwiseAbs().maxCoeff(),
                1e-10 * force * length);
      EXPECT_GT(lost.sum(), 0);
   }
}

/// The linear response foresees less slip than there is, so that nodes have to join.
TEST(ChangingNodes, NodesJoinWhereTheGuessWasTooSmall)
{
   const Parabola on;
   FrictionSolver solver(on.problem);
   ChangingNodes nodes(solver);
   MarchSettings settings;
   settings.increments = 4;
   const auto none = [](const ContactState &, const IncrementRecord &) {};
   ContactState state = on.pressed;
   // A swing that begins at zero and is nearly as large as the bound, 0.4: all nodes but a few
   // slip, x²/a² > 1 - 0.37/0.4, and glued nodes would exceed it in no more than 0.69.
   LoadHistory once = LoadHistory::through(on.problem, {{{"P", 1}}, {{"Q", 0.37}}});
   nodes.march(once, state, settings, none);
   EXPECT_TRUE(nodes.repeats());
   const auto before = nodes.kept();
   int marches = 1;
   while (nodes.repeats())
   {
      state = on.pressed;
      nodes.march(once, state, settings, none);
      ASSERT_LT(++marches, 20);
   }
   EXPECT_GT(nodes.kept(), before);
   ContactState whole = on.pressed;
   march(solver, once, whole, settings);
   EXPECT_LT((state.q - whole.q).cwiseAbs().maxCoeff(), 1e-10 * whole.p.maxCoeff());
}
