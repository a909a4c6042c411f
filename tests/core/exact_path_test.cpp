#include "random_problem.hpp"
#include "same_state.hpp"
#include "small_problems.hpp"

#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/exact_path.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/state_equations.hpp>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <tuple>

namespace
{

using namespace cattaneo;
using cattaneo_test::expect_same;
using cattaneo_test::one_block;
using cattaneo_test::random_problem;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

MarchSettings exact_settings()
{
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   settings.increments = 1;
   settings.every_event = true;
   return settings;
}

LoadHistory press_shear_and_ease(double amplitude, int cycles)
{
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, amplitude),
                            Vector2d(0.7, -amplitude), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

/// Largest violation along the straight way between two states, in plain words from v, w alone:
/// the laws of contact and friction at its end, and Coulomb's way of slipping on it.
double violation(const ReducedProblem &problem, const ContactState &before,
                 const ContactState &now)
{
   const VectorXd f = problem.clamped_forces(now.multipliers);
   const Index n = problem.nodes();
   const VectorXd q = problem.A() * now.v + problem.B().transpose() * now.w + f.head(n);
   const VectorXd p = problem.B() * now.v + problem.C() * now.w + f.tail(n);
   double worst =
      std::max((now.q - q).cwiseAbs().maxCoeff(), (now.p - p).cwiseAbs().maxCoeff());
   for (Index i = 0; i < n; ++i)
   {
      const double gap = now.w[i] + problem.gap[i], way = now.v[i] - before.v[i];
      const double spare = problem.friction[i] * p[i] - std::abs(q[i]);
      const double s = sense(now.status[i]);
      worst = std::max({worst, -gap, -p[i], -spare});
      if (closed(now.status[i])) { worst = std::max(worst, std::abs(gap)); }
      if (!closed(now.status[i])) { worst = std::max({worst, std::abs(p[i]), std::abs(q[i])}); }
      if (now.status[i] == NodeState::stick) { worst = std::max(worst, std::abs(way)); }
      if (slips(now.status[i]))
      {
         worst = std::max({worst, -s * way, std::abs(q[i] + s * problem.friction[i] * p[i])});
      }
   }
   return worst;
}

/// Two nodes on springs of their own. The second slips, the first has slipped and is at rest,
/// but for a load of `turn` that drives it back, and one of `press` on it.
struct AtRest
{
   Eigen::MatrixXd K = 2 * Eigen::MatrixXd::Identity(4, 4);
   StateEquations equations{K, friction_bounds(VectorXd(Vector2d(0.5, 0.5)))};
   std::vector<NodeState> before{NodeState::forward_slip, NodeState::forward_slip};
   ComplementarityProblem problem{
      Eigen::Vector4d(0, -1, 0, 0), {Choice::forward, Choice::forward}, {}};
   ComplementarityReport found;

   AtRest(double turn, double press)
   {
      problem.b[0] = turn;
      problem.b[2] = press;
      EXPECT_TRUE(equations.set(before));
      found = solve_by_newton(equations, problem, 10);
      EXPECT_TRUE(found.solved);
      EXPECT_EQ(equations.states()[1], NodeState::forward_slip);
   }
   bool kept() { return keep_states_at_rest(equations, problem, before, found); }
};

TEST(Rates, ANodeAtRestKeepsItsState)
{
   // A 1e-13 of the loads or less is the rounding of displacements.
   AtRest rest(5e-14, 0);
   EXPECT_EQ(rest.equations.states()[0], NodeState::stick);
   EXPECT_TRUE(rest.kept());
   EXPECT_EQ(rest.equations.states(), rest.before);
   // The other node moves by 1/2 as before, and the forces are those of the displacements.
   EXPECT_EQ(rest.found.x[1], 0.5);
   EXPECT_LT(std::abs(rest.found.x[0]), 1e-13);
   EXPECT_LT((rest.K * rest.found.x + rest.problem.b - rest.found.F).norm(), 1e-14);
   EXPECT_FALSE(rest.kept()); // nothing is left to change
   // One that is driven back, or pressed, does stick.
   for (const auto &[turn, press] : {std::pair(1e-6, 0.0), std::pair(5e-14, 1.0)})
   {
      AtRest driven(turn, press);
      EXPECT_EQ(driven.equations.states()[0], NodeState::stick);
      EXPECT_FALSE(driven.kept());
      EXPECT_EQ(driven.equations.states()[0], NodeState::stick);
   }
}

TEST(StateEquations, UpdatesAgreeWithAFreshFactor)
{
   std::mt19937 random(31);
   const int n = 12;
   const ReducedProblem problem = random_problem(n, 0.6, 0.15, random);
   const Eigen::MatrixXd K = problem.K;
   StateEquations equations(K, friction_bounds(problem.friction));
   const VectorXd b = problem.clamped_forces(Vector2d(1, 0.4));
   VectorXd x, F, x_fresh, F_fresh;
   for (int k = 0; k < 400; ++k)
   {
      const auto node = static_cast<Index>(random() % n);
      ASSERT_TRUE(equations.set(node, static_cast<NodeState>(random() % 4)));
      ASSERT_TRUE(equations.solve(b, x, F));
      StateEquations fresh(K, friction_bounds(problem.friction));
      ASSERT_TRUE(fresh.set(equations.states()));
      ASSERT_TRUE(fresh.solve(b, x_fresh, F_fresh));
      EXPECT_LT((x - x_fresh).cwiseAbs().maxCoeff(), 1e-13);
      for (Index i = 0; i < n; ++i)
      {
         const NodeState s = equations.states()[i];
         const double f = problem.friction[i];
         if (s == NodeState::stick) { EXPECT_EQ(x[i], 0); }
         else { EXPECT_NEAR(F[i] + sense(s) * f * F[n + i], 0, 1e-13); }
         EXPECT_NEAR(closed(s) ? x[n + i] : F[n + i], 0, 1e-13);
      }
   }
   EXPECT_GT(equations.updates(), 100);
   EXPECT_LE(equations.factorisations(), 40);
}

TEST(StateEquations, ForcesThatWereAskedForBeforeAreThoseOfTheDisplacements)
{
   std::mt19937 random(32);
   const int n = 12;
   const ReducedProblem problem = random_problem(n, 0.6, 0.15, random);
   StateEquations equations(problem.K, friction_bounds(problem.friction));
   VectorXd x = VectorXd::Random(2 * n);
   // None, a few, and nearly all displacements are others than before.
   for (const int changes : {0, 1, 4, 20, 3, 0})
   {
      for (int k = 0; k < changes; ++k) { x[random() % (2 * n)] -= 0.5; }
      const VectorXd expected = problem.K * x;
      EXPECT_LT((equations.forces_again(x) - expected).cwiseAbs().maxCoeff(), 1e-13);
   }
   // What was asked for before begin() leaves no trace, to the last bit.
   equations.begin();
   EXPECT_EQ(equations.forces_again(x), equations.forces(x));
}

TEST(StateEquations, RefusesStatesWithoutSupport)
{
   const Eigen::Matrix2d stiffness{{1, -1}, {-1, 1}}; // free to move along and away
   Eigen::MatrixXd K = Eigen::MatrixXd::Zero(4, 4);
   K.topLeftCorner(2, 2) = K.bottomRightCorner(2, 2) = stiffness;
   StateEquations equations(K, friction_bounds(VectorXd::Constant(2, 0.5)));
   EXPECT_TRUE(equations.set(0, NodeState::forward_slip));
   EXPECT_FALSE(equations.set(1, NodeState::forward_slip));
   EXPECT_EQ(equations.states()[1], NodeState::stick);
   VectorXd x, F;
   EXPECT_TRUE(equations.solve(VectorXd::Ones(4), x, F));
   EXPECT_NEAR(F[0] + 0.5 * F[2], 0, 1e-15);
}

TEST(ExactPath, OneBlockCycleInClosedForm)
{
   // q = 2 v + λ, |q| <= f p, f p = 0.4: slip from λ = 0.4 to 1, back from 0.2 to -1, and so
   // on.
   const ReducedProblem problem = one_block(0.4);
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1), Vector2d(1, -1), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = 20;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, exact_settings());
   EXPECT_EQ(report.status, FrictionStatus::converged);
   ASSERT_EQ(report.cycles.size(), 2u); // the other 18 are not computed
   EXPECT_EQ(report.steady_cycle, 2);
   EXPECT_NEAR(report.cycles[1].dissipation, 0.48, 1e-15);
   const NodeState stick = NodeState::stick, ahead = NodeState::backward_slip,
                   back = NodeState::forward_slip; // q > 0 drives v < 0
   const std::vector<std::tuple<double, NodeState, NodeState>> expected = {
      {0.4, stick, ahead}, {1, ahead, stick},    {0.2, stick, back},
      {-1, back, stick},   {-0.2, stick, ahead}, {1, ahead, stick},
      {0.2, stick, back},  {-1, back, stick},    {-0.2, stick, ahead}};
   ASSERT_EQ(report.changes.size(), expected.size());
   for (std::size_t k = 0; k < expected.size(); ++k)
   {
      EXPECT_NEAR(report.changes[k].multipliers[1], std::get<0>(expected[k]), 1e-15);
      EXPECT_EQ(report.changes[k].from, std::get<1>(expected[k]));
      EXPECT_EQ(report.changes[k].to, std::get<2>(expected[k]));
   }
   EXPECT_EQ(report.changes[0].time, 1.4);
}

/// q = 2 v + 1, f p = 0.4: loaded in proportion it slips from the first on.
TEST(ExactPath, APieceThatTakesOneIncrementListsItsChangesAtItsStart)
{
   const ReducedProblem problem = one_block(0.4);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 1)}), state, exact_settings());
   EXPECT_EQ(report.counters.increments, 1);
   EXPECT_NEAR(state.v[0], -0.3, 1e-15);
   ASSERT_EQ(report.changes.size(), 1u);
   EXPECT_EQ(report.changes[0].time, 0);
   EXPECT_EQ(report.changes[0].multipliers, Vector2d(0, 0));
   EXPECT_EQ(report.changes[0].node, 0);
   EXPECT_EQ(report.changes[0].from, NodeState::stick);
   EXPECT_EQ(report.changes[0].to, NodeState::backward_slip);
}

TEST(ExactPath, LawsHoldOnEveryStretchOfRandomProblems)
{
   std::mt19937 random(32);
   int changes = 0, stretches = 0;
   for (int k = 0; k < 60; ++k)
   {
      const int n = 2 + k % 25;
      ReducedProblem problem = random_problem(n, 0.05 + 0.02 * k, 0.2, random);
      if (k % 4 == 0) { problem.friction[k % n] = 0; }
      problem.patterns[1].control = Control::displacement;
      problem.H = Eigen::Matrix2d{{1.3, 0.4}, {-0.4, 2.1}};
      ContactState state = ContactState::virgin(problem), before = state;
      std::vector<NodeState> states = state.status;
      const MarchReport report =
         march(problem, press_shear_and_ease(0.8, 3), state, exact_settings(),
               [&](const ContactState &now, const IncrementRecord &record)
               {
                  EXPECT_LT(violation(problem, before, now), 1e-12) << "problem " << k;
                  EXPECT_GT(record.dissipation, -1e-13);
                  before = now;
                  ++stretches;
               });
      ASSERT_EQ(report.status, FrictionStatus::converged) << "problem " << k;
      EXPECT_EQ(report.fallbacks, 0) << report.fallback_reason;
      EXPECT_LT(std::abs(report.energy_imbalance), 1e-13);
      EXPECT_LT(report.largest_residual, 1e-13);
      EXPECT_GT(report.largest_residual, 0);
      double time = 0;
      for (const StateChange &change : report.changes)
      {
         EXPECT_EQ(states[change.node], change.from);
         EXPECT_NE(change.from, change.to);
         EXPECT_GE(change.time, time);
         states[change.node] = change.to;
         time = change.time;
      }
      EXPECT_EQ(states, state.status);
      changes += static_cast<int>(report.changes.size());
   }
   EXPECT_GT(changes, 1000);
   EXPECT_GT(stretches, 1000);
}

TEST(ExactPath, SteppingConvergesToItInFirstOrder)
{
   std::mt19937 random(33);
   for (int n : {8, 24})
   {
      const ReducedProblem problem = random_problem(n, 0.3, 0.12, random);
      const LoadHistory history = LoadHistory::through(
         {Vector2d(0, 0), Vector2d(1, 0.1), Vector2d(0.8, 0.9), Vector2d(0.9, -0.5),
          Vector2d(0.6, 0.1), Vector2d(1.1, 0.8), Vector2d(0.7, -0.7)});
      // Slip at the points of the history.
      auto slip = [&](const MarchSettings &settings)
      {
         Eigen::MatrixXd v(n, history.pieces());
         ContactState state = ContactState::virgin(problem);
         const MarchReport report =
            march(problem, history, state, settings,
                  [&](const ContactState &now, const IncrementRecord &)
                  { v.col(static_cast<Index>(std::ceil(now.time)) - 1) = now.v; });
         EXPECT_EQ(report.fallbacks, 0);
         return v;
      };
      const Eigen::MatrixXd exact = slip(exact_settings());
      std::vector<double> errors;
      for (int increments : {10, 100, 1000, 10000})
      {
         MarchSettings settings;
         settings.stepping = Stepping::fixed;
         settings.increments = increments;
         errors.push_back((slip(settings) - exact).cwiseAbs().maxCoeff() /
                          exact.cwiseAbs().maxCoeff());
      }
      EXPECT_GT(errors[0], 1e-6) << "nodes " << n;
      // First order, up to the luck of where increments end.
      for (std::size_t k = 1; k < errors.size(); ++k)
      {
         EXPECT_LT(errors[k], 3 * errors[0] * std::pow(0.1, k)) << "nodes " << n << " k " << k;
      }
   }
}

TEST(ExactPath, ReturnToTheLimitWhereTheLoadTurnsIsNotSlip)
{
   // Nodes that slip in the first loading and not back in unloading are at their limit again at
   // the end of the second loading, and only there.
   std::mt19937 random(37);
   int back_at_limit = 0;
   for (int k = 0; k < 20; ++k)
   {
      const ReducedProblem problem = random_problem(12, 0.5, 0.1, random);
      LoadHistory history = LoadHistory::through(
         {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.7), Vector2d(1, 0)});
      history.cycle_start = 1;
      history.cycles = 4;
      MarchSettings settings = exact_settings();
      settings.stop_at_steady_state = false;
      ContactState state = ContactState::virgin(problem), trough = state, first;
      march(problem, history, state, settings,
            [&](const ContactState &now, const IncrementRecord &record)
            {
               const double pieces = now.time - 1;
               if (pieces == 1) { first = now; }
               if (pieces > 0 && std::fmod(pieces, 2) == 0) { trough = now; }
               if (std::fmod(pieces, 2) != 1 || record.cycle < 2) { return; }
               for (int i = 0; i < 12; ++i)
               {
                  if (slips(now.status[i]))
                  {
                     EXPECT_GT(std::abs(now.v[i] - trough.v[i]), 1e-12) << "problem " << k;
                  }
                  else if (slips(first.status[i])) { ++back_at_limit; }
               }
            });
   }
   EXPECT_GT(back_at_limit, 20);
}

TEST(ExactPath, CutAtAnyEventGivesTheSameToRoundOff)
{
   std::mt19937 random(34);
   const ReducedProblem problem = random_problem(12, 0.3, 0.1, random);
   const LoadHistory history = press_shear_and_ease(0.8, 2);
   ContactState whole = ContactState::virgin(problem);
   std::vector<ContactState> passed;
   march(problem, history, whole, exact_settings(),
         [&](const ContactState &state, const IncrementRecord &) { passed.push_back(state); });
   const std::string file = testing::TempDir() + "cattaneo_exact_state.json";
   ASSERT_GT(passed.size(), 20u);
   for (const ContactState &cut : passed)
   {
      save(cut, file);
      ContactState rest = load_contact_state(file);
      const MarchReport report = march(problem, history, rest, exact_settings());
      EXPECT_EQ(report.fallbacks, 0);
      EXPECT_LT((rest.v - whole.v).cwiseAbs().maxCoeff(), 1e-13) << "cut at " << cut.time;
      EXPECT_LT((rest.p - whole.p).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_EQ(rest.status, whole.status);
      EXPECT_NEAR(rest.dissipation, whole.dissipation, 1e-13);
      EXPECT_EQ(rest.time, whole.time);
   }
   std::remove(file.c_str());
}

/// Increments are stops of the path: they change neither where it leads nor how often its
/// equations are factored, and rows are there at each of them, whatever lies between.
TEST(ExactPath, StopsAreRowsAndNoFactors)
{
   std::mt19937 random(38);
   for (int k = 0; k < 10; ++k)
   {
      const ReducedProblem problem = random_problem(6 + k, 0.15 + 0.03 * k, 0.1, random);
      const LoadHistory history = press_shear_and_ease(0.8, 2);
      MarchSettings settings;
      settings.increments = 1;
      ContactState once = ContactState::virgin(problem);
      const MarchReport first = march(problem, history, once, settings);
      ASSERT_EQ(first.status, FrictionStatus::converged);
      EXPECT_EQ(first.counters.increments, history.pieces());
      EXPECT_TRUE(first.changes.empty());
      for (const int stops : {7, 40})
      {
         settings.increments = stops;
         ContactState state = ContactState::virgin(problem);
         double time = 0;
         const MarchReport report =
            march(problem, history, state, settings,
                  [&](const ContactState &now, const IncrementRecord &record)
                  {
                     EXPECT_NEAR(now.time, time + 1.0 / stops, 1e-12);
                     EXPECT_EQ(record.time, now.time);
                     EXPECT_EQ(record.event, -1);
                     time = now.time;
                  });
         EXPECT_EQ(report.counters.increments, stops * history.pieces());
         EXPECT_EQ(report.events, first.events);
         EXPECT_EQ(report.counters.dense_factorisations, first.counters.dense_factorisations);
         EXPECT_EQ(report.counters.newton_steps - first.counters.newton_steps, 0);
         EXPECT_LT((state.p - once.p).cwiseAbs().maxCoeff(), 1e-12 * once.peak_force);
         EXPECT_LT((state.q - once.q).cwiseAbs().maxCoeff(), 1e-12 * once.peak_force);
         EXPECT_NEAR(state.dissipation, once.dissipation, 1e-12);
         EXPECT_LT(std::abs(report.energy_imbalance), 1e-12);
         double lost = 0, work = 0;
         for (const IncrementRecord &record : report.increments)
         {
            lost += record.dissipation;
            work += record.external_work;
         }
         EXPECT_NEAR(lost, state.dissipation, 1e-13);
         // Rows of events, in place of stops, add up to the same.
         settings.every_event = true;
         ContactState every = ContactState::virgin(problem);
         const MarchReport all = march(problem, history, every, settings);
         settings.every_event = false;
         EXPECT_EQ(all.events, report.events);
         EXPECT_EQ(all.changes.size(), static_cast<std::size_t>(all.events));
         double all_work = 0;
         for (const IncrementRecord &record : all.increments)
         {
            all_work += record.external_work;
         }
         EXPECT_NEAR(all_work, work, 1e-12);
         EXPECT_LT((every.q - state.q).cwiseAbs().maxCoeff(), 1e-12 * once.peak_force);
      }
   }
}

TEST(ExactPath, TakenUpAtAnyStopComesToTheSameForces)
{
   std::mt19937 random(39);
   int taken_up = 0;
   for (int k = 0; k < 10; ++k)
   {
      const ReducedProblem problem = random_problem(5 + k, 0.15 + 0.04 * k, 0.1, random);
      const LoadHistory history = press_shear_and_ease(0.8, 2);
      MarchSettings settings;
      settings.increments = 5;
      settings.stop_at_steady_state = false;
      std::vector<ContactState> stops;
      ContactState whole = ContactState::virgin(problem), again = whole;
      const MarchReport report =
         march(problem, history, whole, settings,
               [&](const ContactState &now, const IncrementRecord &) { stops.push_back(now); });
      ASSERT_EQ(report.status, FrictionStatus::converged);
      ASSERT_EQ(report.fallbacks, 0);
      // The same once more has the same bits.
      march(problem, history, again, settings);
      expect_same(again, whole);
      for (ContactState &stop : stops)
      {
         const double time = stop.time;
         EXPECT_EQ(march(problem, history, stop, settings).status, FrictionStatus::converged);
         EXPECT_LT((stop.q - whole.q).cwiseAbs().maxCoeff(), 1e-12 * whole.peak_force) << time;
         EXPECT_LT((stop.p - whole.p).cwiseAbs().maxCoeff(), 1e-12 * whole.peak_force) << time;
         EXPECT_EQ(stop.status, whole.status);
         ++taken_up;
      }
   }
   EXPECT_GT(taken_up, 200);
}

TEST(ExactPath, UnitsDoNotMatter)
{
   std::mt19937 random(35);
   const ReducedProblem problem = random_problem(15, 0.4, 0.12, random);
   ReducedProblem scaled = problem;
   const double length = std::ldexp(1.0, -20), force = std::ldexp(1.0, 27); // exact in binary
   scaled.K *= force / length;
   scaled.gap *= length;
   for (LoadPattern &pattern : scaled.patterns)
   {
      pattern.q *= force;
      pattern.p *= force;
   }
   ContactState a = ContactState::virgin(problem), b = ContactState::virgin(scaled);
   const MarchReport ra = march(problem, press_shear_and_ease(0.8, 2), a, exact_settings());
   const MarchReport rb = march(scaled, press_shear_and_ease(0.8, 2), b, exact_settings());
   ASSERT_EQ(ra.changes.size(), rb.changes.size());
   for (std::size_t k = 0; k < ra.changes.size(); ++k)
   {
      EXPECT_EQ(ra.changes[k].time, rb.changes[k].time);
      EXPECT_EQ(ra.changes[k].node, rb.changes[k].node);
      EXPECT_EQ(ra.changes[k].to, rb.changes[k].to);
   }
   EXPECT_EQ(a.v * length, b.v);
   EXPECT_EQ(a.p * force, b.p);
   EXPECT_EQ(ra.counters.newton_steps, rb.counters.newton_steps);
   EXPECT_GT(ra.counters.newton_steps, 0);
}

TEST(ExactPath, GrossSlidingAtItsExactLoad)
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d{{1, -1}, {-1, 1}}, Eigen::Matrix2d::Zero(),
                         Eigen::Matrix2d{{1, -1}, {-1, 1}});
   problem.patterns = {{"press", Control::force, Vector2d(0, 0), Vector2d(0.5, 0.5)},
                       {"shear", Control::force, Vector2d(0.8, 0.2), Vector2d(0, 0)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Vector2d(0, 0);
   set_friction(problem, 0.4);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)}),
            state, exact_settings());
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NEAR(report.event_multipliers[1], 0.4, 1e-15); // Q = f P
   EXPECT_NEAR(report.event_time, 1.4, 1e-15);
   EXPECT_EQ(report.time, report.event_time);
   ASSERT_EQ(report.changes.size(), 1u); // the first node slips, the second cannot but slide
   EXPECT_NEAR(report.changes[0].multipliers[1], 0.25, 1e-15); // 0.8 Q = 0.5 f P
   EXPECT_EQ(report.fallbacks, 0);
}

TEST(ExactPath, SettlesAStateThatIsNoEquilibriumFirst)
{
   ReducedProblem problem = one_block(0.4);
   problem.gap[0] = 0.1;
   const auto first_of = [&](const ContactState &start, const LoadHistory &history,
                             ContactState &state, MarchReport &report)
   {
      ContactState first;
      state = start;
      report = march(problem, history, state, exact_settings(),
                     [&](const ContactState &now, const IncrementRecord &)
                     {
                        if (first.v.size() == 0) { first = now; }
                     });
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.fallbacks, 0) << report.fallback_reason;
      return first;
   };
   const LoadHistory load = LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0.1)});
   ContactState start = ContactState::virgin(problem), state;
   MarchReport report;
   // Said to stick, but a tenth apart: it closes at P = 0.3, where v = -0.015, and sticks.
   for (NodeState said : {NodeState::separation, NodeState::stick, NodeState::forward_slip})
   {
      start.status[0] = said;
      const ContactState first = first_of(start, load, state, report);
      EXPECT_EQ(first.status[0], NodeState::separation) << name(said);
      EXPECT_NEAR(first.time, said == NodeState::separation ? 0.3 : 0, 1e-15);
      EXPECT_NEAR(state.p[0], 0.7, 1e-15);
      EXPECT_NEAR(state.w[0], -0.1, 1e-15);
      EXPECT_NEAR(state.v[0], -0.015, 1e-15);
      EXPECT_NEAR(state.q[0], 0.07, 1e-15);
      ASSERT_EQ(report.changes.size(), 1u);
      EXPECT_NEAR(report.changes[0].time, 0.3, 1e-15);
      EXPECT_EQ(report.changes[0].from, NodeState::separation);
      EXPECT_EQ(report.changes[0].to, NodeState::stick);
   }
   // Pressed by 1, an initial slip of 1 springs back to where q = 2 v = 0.4; from Q = -0.8 on
   // it slips on, to v = 0.3.
   problem.gap[0] = 0;
   start = ContactState::with_slip(problem, VectorXd::Ones(1));
   start.multipliers = Vector2d(1, 0);
   const LoadHistory shear = LoadHistory::through({Vector2d(1, 0), Vector2d(1, -1)});
   const ContactState slid = first_of(start, shear, state, report);
   EXPECT_EQ(slid.time, 0);
   EXPECT_NEAR(slid.v[0], 0.2, 1e-15);
   EXPECT_NEAR(state.v[0], 0.3, 1e-15);
   EXPECT_NEAR(state.slip_origin[0], 0.2, 1e-15);
   EXPECT_NEAR(report.changes.back().multipliers[1], -0.8, 1e-14);
   EXPECT_NEAR(state.dissipation, 0.5 * 0.4 * 0.8 + 0.4 * 0.1, 1e-15);
   // Slip that its friction does not oppose, and forces that are not those of the slip.
   ContactState pressed = ContactState::virgin(problem);
   FrictionSolver(problem).solve(pressed, Vector2d(1, 0.3));
   const ExactPath path(problem);
   EXPECT_TRUE(path.starts_from(pressed));
   for (int k = 0; k < 4; ++k)
   {
      ContactState other = pressed;
      if (k == 0) { other.status[0] = NodeState::backward_slip; } // q = 0.3, f p = 0.4
      if (k == 1) { other.q[0] = 0.3 + 1e-6; }
      if (k == 2) { other.v[0] = 0.1; } // q = 0.5
      if (k == 3) { other.w[0] = 1e-6; }
      EXPECT_FALSE(path.starts_from(other)) << k;
   }
   FrictionSolver(problem).solve(pressed, Vector2d(1, 0.6));
   EXPECT_EQ(pressed.status[0], NodeState::backward_slip);
   EXPECT_TRUE(path.starts_from(pressed));
   pressed.status[0] = NodeState::forward_slip;
   EXPECT_FALSE(path.starts_from(pressed));
}

TEST(ExactPath, AboveCriticalFrictionNothingIsSilent)
{
   std::mt19937 random(36);
   int converged = 0, not_unique = 0;
   for (int k = 0; k < 60; ++k)
   {
      ReducedProblem problem = random_problem(6, 1.0 + 0.2 * k, 0.35, random);
      ContactState state = ContactState::virgin(problem), before = state;
      const MarchReport report =
         march(problem, press_shear_and_ease(0.8, 1), state, exact_settings(),
               [&](const ContactState &now, const IncrementRecord &)
               {
                  EXPECT_LT(violation(problem, before, now), 1e-10) << "problem " << k;
                  before = now;
               });
      EXPECT_EQ(report.fallbacks > 0, !report.fallback_reason.empty());
      converged += report.status == FrictionStatus::converged;
      not_unique += report.status == FrictionStatus::not_unique;
      if (report.status == FrictionStatus::converged) { continue; }
      EXPECT_FALSE(report.message.empty());
      EXPECT_EQ(report.event_multipliers.size(), 2);
   }
   EXPECT_GT(converged, 0);
   EXPECT_GT(not_unique, 0);
}

} // namespace
