#include "contact_laws.hpp"
#include "enumeration.hpp"
#include "random_problem.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Right half of a wedge with flanks at the angle `alpha` to its axis, point down, in a rigid
/// groove; pattern "P" of resultant 1 drives it in.
ReducedProblem wedge(double alpha, int rows = 8)
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(6, rows, mfem::Element::QUADRILATERAL, true);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      x[0] *= 1 + x[1] * std::tan(alpha);
   }
   ElasticBody body(mesh, 2, Material{1.0, 0.3});
   body.fix({4}, 0); // the axis
   body.add_pressure("P", 3, 1 / (1 + std::tan(alpha)));
   return reduce(condense(body, contact_line(body, 2))).problem;
}

MarchReport drive_in_and_release(const ReducedProblem &problem, ContactState &state)
{
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   settings.increments = 40;
   state = ContactState::virgin(problem);
   return march(problem,
                LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1), VectorXd::Zero(1)}),
                state, settings);
}

TEST(CriticalFriction, AWedgeLocksAboveTheTangentOfItsFlank)
{
   for (double alpha : {0.1, 0.2, 0.3})
   {
      ReducedProblem problem = wedge(alpha);
      const CriticalFriction critical = critical_friction(problem);
      EXPECT_NEAR(critical.locking, std::tan(alpha), 1e-8);
      EXPECT_GT(critical.node, critical.locking);
      // Below, nothing holds it: when the load is gone, so are all forces.
      ContactState state;
      set_friction(problem, 0.99 * critical.locking);
      EXPECT_EQ(drive_in_and_release(problem, state).status, FrictionStatus::converged);
      EXPECT_LT(state.p.cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_LT(state.q.cwiseAbs().maxCoeff(), 1e-11);
      // Above, it stays where it was driven.
      set_friction(problem, 1.1 * critical.locking);
      EXPECT_EQ(drive_in_and_release(problem, state).status, FrictionStatus::converged);
      const double balance = std::sin(alpha) * state.p.sum() + std::cos(alpha) * state.q.sum();
      EXPECT_GT(state.p.sum(), 0.1) << "alpha " << alpha;
      EXPECT_NEAR(balance, 0, 1e-11);
      // With no load and that slip there are two answers: locked, and free of all forces.
      LawChecker laws(problem, state);
      for (NodeState &s : state.status)
      {
         if (slips(s)) { s = NodeState::stick; }
      }
      EXPECT_LE(laws.violation(state.v, state), 1) << laws.what();
      ContactState free = ContactState::virgin(problem);
      free.multipliers = VectorXd::Zero(1);
      free.status.clear();
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         free.status.push_back(state.v[i] < 0   ? NodeState::forward_slip
                               : state.v[i] > 0 ? NodeState::backward_slip
                                                : NodeState::stick);
      }
      EXPECT_LE(laws.violation(state.v, free), 1) << laws.what();
   }
}

// It holds until its last node slips. Beyond, no states of the nodes are an equilibrium: it
// jumps.
TEST(CriticalFriction, AWedgeThatIsPulledFreeSaysSo)
{
   ReducedProblem problem = wedge(0.2, 3);
   set_friction(problem, 0.6);
   for (auto stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      ContactState state = ContactState::virgin(problem);
      const VectorXd none = VectorXd::Zero(1), pressed = VectorXd::Ones(1);
      const MarchReport report =
         march(problem, LoadHistory::through({none, pressed, -0.9 * pressed}), state, settings);
      EXPECT_EQ(report.status, FrictionStatus::stalled);
      EXPECT_NE(report.message.find("jumps free"), std::string::npos) << report.message;
      EXPECT_LT(report.event_multipliers[0], -0.05);
      EXPECT_GT(report.event_multipliers[0], -0.5);
      const VectorXd beyond = report.event_multipliers.array() - 1e-3;
      EXPECT_TRUE(enumerate_solutions(problem, state.v, beyond).empty());
      EXPECT_FALSE(enumerate_solutions(problem, state.v, report.event_multipliers).empty());
   }
}

TEST(CriticalFriction, AFlatContactNeverLocks)
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(4, 4, mfem::Element::QUADRILATERAL, true);
   ElasticBody free(mesh, 2, Material{1.0, 0.3}), held(mesh, 2, Material{1.0, 0.3});
   const CriticalFriction of_free =
      critical_friction(reduce(condense(free, contact_line(free, 1))).problem);
   EXPECT_TRUE(std::isinf(of_free.locking));
   EXPECT_EQ(of_free.unique_below, 0); // it may slide away
   for (int component : {0, 1}) { held.fix(3, component); }
   const CriticalFriction of_held =
      critical_friction(reduce(condense(held, contact_line(held, 1))).problem);
   EXPECT_TRUE(std::isinf(of_held.locking));
   EXPECT_GT(of_held.unique_below, 0);
   EXPECT_LE(of_held.unique_below, of_held.node);
}

/// A bar between two rigid walls that hold it across: it may slide along, and at any friction
/// the walls' pressures balance. Its directions say nothing of a lock; nor do they if supports
/// press a free sliding block.
TEST(CriticalFriction, PressuresThatBalanceAreNoLock)
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(4, 4, mfem::Element::QUADRILATERAL, true);
   ElasticBody between(mesh, 2, Material{1.0, 0.3}), sliding(mesh, 2, Material{1.0, 0.3});
   const CriticalFriction of_bar = critical_friction(
      reduce({{"bar", &between}}, {{"below", {0, 1}, {}}, {"above", {0, 3}, {}}}).problem);
   EXPECT_TRUE(std::isinf(of_bar.locking)) << of_bar.locking;
   sliding.fix(3, 1);
   const CriticalFriction of_block =
      critical_friction(reduce(condense(sliding, contact_line(sliding, 1))).problem);
   EXPECT_TRUE(std::isinf(of_block.locking)) << of_block.locking;
}

TEST(CriticalFriction, OneNodeIsSharp)
{
   std::mt19937 random(1);
   ReducedProblem problem = random_problem(1, 0.0, 0.0, random);
   const auto one = [](double x) { return MatrixXd::Constant(1, 1, x); };
   for (double b : {0.01, 0.5, -0.9})
   {
      problem.set_stiffness(one(1), one(b), one(2));
      const CriticalFriction critical = critical_friction(problem);
      EXPECT_NEAR(critical.node, 1 / std::abs(b), 1e-14);
      EXPECT_NEAR(critical.unique_below, 1 / std::abs(b), 1e-12);
   }
   problem.set_stiffness(one(1), one(0), one(2));
   EXPECT_TRUE(std::isinf(critical_friction(problem).unique_below));
   // Strong coupling: the bound is safe, no more. In displacements over which C is 1 the node
   // has the coupling b = B / C and the stiffness a + b² = A / C; the bound (a + t²) / t, least
   // at t = √a < b, is 2 √a.
   problem.set_stiffness(one(1), one(1.3), one(2));
   const double bound = critical_friction(problem).unique_below;
   EXPECT_LT(bound, 1 / 1.3);
   EXPECT_NEAR(bound, 2 * std::sqrt(0.5 - 0.65 * 0.65), 1e-12);
}

/// By trying all states: never two answers below the bound, and sometimes above.
TEST(CriticalFriction, BelowTheBoundThereIsOneAnswer)
{
   std::mt19937 random(7);
   std::normal_distribution<double> normal;
   int several = 0;
   for (int k = 0; k < 400; ++k)
   {
      const int n = 1 + k % 4;
      ReducedProblem problem = random_problem(n, 0.0, 0.25, random);
      const CriticalFriction critical = critical_friction(problem);
      ASSERT_GT(critical.unique_below, 0);
      ASSERT_LE(critical.unique_below, critical.node * (1 + 1e-12));
      const VectorXd v_old = 0.3 * VectorXd::NullaryExpr(n, [&] { return normal(random); });
      for (double friction : {0.999 * critical.unique_below, 10 * critical.node})
      {
         set_friction(problem, friction);
         std::size_t answers = 0;
         for (const EnumeratedSolution &solution :
              enumerate_solutions(problem, v_old, Vector2d(1, 3 * normal(random))))
         {
            answers += solution.margin > 1e-9;
         }
         if (friction < critical.unique_below) { EXPECT_LE(answers, 1u) << "problem " << k; }
         else { several += answers > 1; }
      }
   }
   EXPECT_GE(several, 5);
}

} // namespace
