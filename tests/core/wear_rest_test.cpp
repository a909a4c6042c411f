#include "comparison.hpp"
#include "disc_problems.hpp"
#include "worn_pads.hpp"
#include "worn_problems.hpp"

#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/wear/wear_march.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <cmath>
#include <sstream>

using namespace cattaneo;
using cattaneo_test::compare;
using cattaneo_test::grid_about;
using cattaneo_test::hertz_pad;
using cattaneo_test::Jumped;
using cattaneo_test::one_increment;
using cattaneo_test::Pad;
using cattaneo_test::rounds;
using cattaneo_test::settings_with;
using cattaneo_test::small_pad;
using Eigen::VectorXd;

TEST(Wear, JumpsComeToWhatAllCyclesMarchedComeTo)
{
   const Pad pad = small_pad();
   const WearLaw law = WearLaw::uniform(pad.problem, 5e-4);
   WearState marched = WearState::virgin(pad.problem);
   EXPECT_EQ(wear(pad.problem, law, pad.history, 4000, marched, settings_with(0)).error, 0);
   for (double tolerance : {1e-1, 1e-2, 1e-3})
   {
      WearState state = WearState::virgin(pad.problem);
      const WearReport report =
         wear(pad.problem, law, pad.history, 4000, state, settings_with(tolerance));
      EXPECT_EQ(report.status, FrictionStatus::converged);
      EXPECT_EQ(state.cycles, 4000);
      EXPECT_GT(report.jumps, 0);
      EXPECT_LT(report.marched, 2500);
      const double error = largest(state.depth - marched.depth);
      EXPECT_LE(error, report.error) << tolerance;
      EXPECT_LE(report.error, tolerance * largest(marched.depth)) << tolerance;
      EXPECT_LE(error, tolerance * largest(marched.depth)) << tolerance;
      EXPECT_NEAR(worn_volume(pad.problem, state.depth), 5e-4 / 0.5 * state.dissipation.sum(),
                  1e-13);
   }
}

// A cycle that begins and ends without loads, at the start of the history or after an opening
// part: what wears in twelve cycles is what wears in three and then in nine.
TEST(Wear, CyclesFromNoLoadsGoOnFromTheirStates)
{
   const Pad pad = small_pad();
   const ReducedProblem &problem = pad.problem;
   const WearLaw law = WearLaw::uniform(problem, 1e-2);
   const NamedLoads none = {{"P", 0}, {"Q", 0}}, least = {{"P", 0.9}, {"Q", 0.1}};
   const LoadHistory whole = LoadHistory::through(
                        problem, {none, {{"P", 1}}, {{"Q", 0.3}}, least, none}, 0),
                     opened = LoadHistory::through(
                        problem, {none, none, {{"P", 1}}, {{"Q", 0.3}}, least, none}, 1);
   VectorXd depth;
   for (const LoadHistory &history : {whole, opened})
   {
      WearState at_once = WearState::virgin(problem), cut = at_once;
      EXPECT_EQ(wear(problem, law, history, 12, at_once, settings_with(0)).status,
                FrictionStatus::converged);
      for (const double cycles : {3, 12})
      {
         EXPECT_EQ(wear(problem, law, history, cycles, cut, settings_with(0)).status,
                   FrictionStatus::converged);
         cut.validate(problem);
      }
      EXPECT_GT(largest(cut.depth), 1e-4);
      EXPECT_LT(largest(cut.depth - at_once.depth), 1e-12 * largest(at_once.depth));
      // The opening part, without loads, wears nothing.
      if (depth.size() > 0) { EXPECT_LT(largest(cut.depth - depth), 1e-12 * largest(depth)); }
      depth = cut.depth;
      const WornOut end =
         worn_out(problem, history, ContactState::virgin(problem), one_increment());
      EXPECT_NE(end.message.find("no node was found that sticks"), std::string::npos)
         << end.message;
   }
}

// Contact |x| < 1 on a line |x| < 0.8, and on one that ends within what wears, |x| < 1.17.
TEST(Wear, ALineThatIsTooShortIsNamed)
{
   for (const double span : {0.8, 1.05, 1.3})
   {
      const Pad pad = hertz_pad(grid_about(std::min(0.7, std::sqrt(0.5)), span, 8, 8), 0.5);
      const WornOut end =
         worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem), one_increment());
      ASSERT_EQ(end.status, FrictionStatus::converged) << end.message;
      ASSERT_EQ(end.cut_off.size(), span < 1.17 ? 2u : 0u) << span;
      WearState state = WearState::virgin(pad.problem);
      WearSettings settings;
      settings.march = one_increment();
      const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, 1e-2),
                                     pad.history, 3, state, settings);
      EXPECT_EQ(report.cut_off.size(), span < 1 ? 2u : 0u) << span;
      if (span > 1) { continue; }
      EXPECT_NEAR(std::abs(end.cut_off[0].x), span, 1e-12);
   }
}

// Shipped problems, with loads, wear and increments that vary.
TEST(Wear, ToleranceHoldsOnVariantsOfShippedProblems)
{
   Jumped count;
   const int seeds = rounds(5, 200);
   const std::pair<const char *, double> shipped[] = {{"hertz", 0.35},
                                                      {"punch_on_half_plane", 0.4}};
   for (int seed = 0; seed < seeds; ++seed)
   {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> unit(0, 1);
      const auto &[name, most] = shipped[seed % 2];
      cattaneo_test::WornProblem of;
      of.problem =
         load_reduced_problem(std::string(CATTANEO_SOURCE_DIR "/problems/") + name + ".json");
      const double Q = most * (0.3 + 0.6 * unit(random)),
                   P = seed % 4 < 2 ? 1.0 : 0.8 + 0.4 * unit(random),
                   back = -Q * std::min(1.0, P) * unit(random); // neither slides
      of.history = LoadHistory::through(
         of.problem,
         {{}, {{"P", 1}}, {{"P", 1}, {"Q", Q}}, {{"P", P}, {"Q", back}}, {{"P", 1}, {"Q", Q}}});
      of.history.cycle_start = 2;
      of.law = WearLaw::uniform(of.problem, std::pow(10, -4 + 2.5 * unit(random)));
      of.cycles = std::round(std::pow(10, 2.3 + 0.7 * unit(random)));
      of.settings.tolerance = std::pow(10, -3.5 + 2.5 * unit(random));
      of.settings.march.stepping = seed % 3 == 0 ? Stepping::exact : Stepping::fixed;
      of.settings.march.increments = 1 + random() % 8;
      compare(of, std::string(name) + ", seed " + std::to_string(seed), count);
   }
   EXPECT_GT(count.all, 0.9 * seeds);
   EXPECT_GT(count.jumped, 0.4 * seeds);
}

// Errors of early jumps grow on the way of these five nodes, twentyfold: all cycles marched
// along the exact path end at 0.0005836.
TEST(Wear, ErrorsOfJumpsThatGrowAreCounted)
{
   cattaneo_test::WornProblem of;
   of.problem = load_reduced_problem(CATTANEO_SOURCE_DIR "/tests/data/unstable_wear.json");
   const double Q = 0.23271185921654777;
   of.history =
      LoadHistory::through(of.problem, {{},
                                        {{"P", 1}},
                                        {{"P", 1}, {"Q", Q}},
                                        {{"P", 0.8559051642128797}, {"Q", -0.19917847}},
                                        {{"P", 1}, {"Q", Q}}});
   of.history.cycle_start = 2;
   of.law = WearLaw::uniform(of.problem, 1.2875730965971341);
   of.cycles = 4000;
   of.settings.tolerance = 0.01;
   of.settings.march.stepping = Stepping::exact;
   Jumped count;
   compare(of, "five nodes", count);
   EXPECT_EQ(count.all, 1);
}

// In the worn-out contact what slips touches without force, and opens and closes by round-off:
// no increment is cut for that, however long it goes on. (With two tangential components; in
// the plane nothing is cut.)
TEST(Wear, WhatTouchesWithoutForceCutsNoIncrement)
{
   const Pad pad = small_pad();
   const ReducedProblem disc = cattaneo_test::as_disc(pad.problem);
   WearState state = WearState::virgin(disc);
   const WearReport report =
      wear(disc, WearLaw::uniform(disc, 0.05), pad.history, 1500, state, settings_with(0));
   EXPECT_EQ(report.status, FrictionStatus::converged);
   const WornOut end =
      worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem), one_increment());
   EXPECT_LT(largest(state.depth - end.depth), 1e-10 * largest(end.depth));
   EXPECT_LT(report.counters.increments, 2 * 1500 + 500);
}

namespace
{

/// One node on springs of 1 along and across. P goes from 1 to `least` and back while Q goes
/// from its largest value to minus that and back: it lifts off in each cycle and wears down to
/// the largest load.
cattaneo_test::WornProblem lifting_node(double least, double Q, double k, double cycles)
{
   cattaneo_test::WornProblem of;
   ReducedProblem &problem = of.problem;
   const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
   problem.set_stiffness(one, 0 * one, one);
   problem.patterns = {{"P", Control::force, VectorXd::Zero(1), VectorXd::Ones(1)},
                       {"Q", Control::force, VectorXd::Ones(1), VectorXd::Zero(1)}};
   problem.gap = VectorXd::Zero(1);
   problem.weights = VectorXd::Ones(1);
   problem.chains = one_chain(1);
   set_friction(problem, 0.5);
   of.history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"P", 1}, {"Q", Q}}, {{"P", least}, {"Q", -Q}}, {{"P", 1}, {"Q", Q}}});
   of.history.cycle_start = 2;
   of.law = WearLaw::uniform(problem, k);
   of.cycles = cycles;
   of.settings.march.stepping = Stepping::exact;
   return of;
}

} // namespace

// One node that lifts off in each cycle. Lifted off, it slips far without wear.
TEST(Wear, ToleranceHoldsWhereANodeLiftsOff)
{
   Jumped count;
   for (const auto &[least, Q, k] : {std::tuple{0.5, 1.0, 0.1},
                                     {0.7, 2.0, 0.1},
                                     {0.3, 0.6, 0.1},
                                     {-1.0, 1.0, 0.1},
                                     {0.7, 1.0, 0.5},
                                     {0.3, 2.0, 0.5}})
   {
      for (const double tolerance : {1e-2, 1e-3, 3e-4, 1e-4})
      {
         cattaneo_test::WornProblem of = lifting_node(least, Q, k, 3000);
         of.settings.tolerance = tolerance;
         std::ostringstream named;
         named << "P to " << least << ", Q " << Q << ", k " << k << ", tolerance " << tolerance;
         compare(of, named.str(), count);
      }
   }
   EXPECT_EQ(count.all, 24);
   EXPECT_EQ(count.jumped, 24);
   EXPECT_EQ(count.not_reached, 0);
   EXPECT_EQ(count.rows_missed, 0);
}

// What each cycle takes of that node is known by hand, whatever round-off its pressure has when
// it lifts off: no cycle is so severe that its own update is implicit, which halves it.
TEST(Wear, ANodeThatLiftsOffWearsByItsRecurrence)
{
   const double f = 0.5, least = 0.7, Q = 1, k = 0.5, falls = 1 - least;
   const cattaneo_test::WornProblem of = lifting_node(least, Q, k, 1500);
   WearState state = WearState::virgin(of.problem);
   std::vector<double> depth;
   wear(of.problem, of.law, of.history, of.cycles, state, of.settings,
        [&](const WearState &now, const WearRecord &) { depth.push_back(now.depth[0]); });
   ASSERT_EQ(depth.size(), 1501u);
   for (std::size_t n = 100; n + 1 < depth.size(); ++n)
   {
      const double before = 1 - depth[n - 1], p = 1 - depth[n];
      // It slips from where q has turned to -f p until it lifts off, from where it touches
      // until the end, and as it takes in the gap that the cycle before wore.
      const double there = 2 * Q + f * falls, back = 2 * Q - f * falls,
                   turned = p * (1 - 2 * f * falls / there);
      const double taken = (there * turned * turned + back * p * p) / (2 * falls) +
                           f * (before - p) * 0.5 * (before + p);
      EXPECT_NEAR(depth[n + 1] - depth[n], k * taken, 1e-8 * k * taken) << n;
   }
}

// One node above a threshold: wear ends where its pressure is that of the threshold, and a jump
// must not go beyond what all cycles have worn by then.
TEST(Wear, ToleranceHoldsAboveAThreshold)
{
   Jumped count;
   for (const double tolerance : {0.1, 0.03, 1e-3})
   {
      cattaneo_test::WornProblem of;
      ReducedProblem &problem = of.problem;
      const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
      problem.set_stiffness(one, 0 * one, one);
      problem.patterns = {{"P", Control::displacement, VectorXd::Zero(1), VectorXd::Ones(1)},
                          {"Q", Control::displacement, VectorXd::Ones(1), VectorXd::Zero(1)}};
      problem.gap = VectorXd::Zero(1);
      problem.weights = VectorXd::Ones(1);
      problem.chains = one_chain(1);
      set_friction(problem, 0.5);
      of.history = LoadHistory::through(
         problem,
         {{}, {{"P", 1}}, {{"P", 1}, {"Q", 1}}, {{"P", 0.8}, {"Q", -1}}, {{"P", 1}, {"Q", 1}}});
      of.history.cycle_start = 2;
      of.law = WearLaw::uniform(problem, 0.1);
      of.law.threshold = VectorXd::Constant(1, 0.1);
      of.cycles = 400;
      of.settings.tolerance = tolerance;
      of.settings.march.stepping = Stepping::exact;
      of.settings.march.increments = 1;
      compare(of, "tolerance " + std::to_string(tolerance), count);
   }
   EXPECT_EQ(count.all, 3);
}

// The second node slips in no cycle that repeats itself at one gap. It wears only as its
// neighbour does, a little more from cycle to cycle, until both run away.
TEST(Wear, ToleranceHoldsWhereANodeWearsOnlyAsItsNeighbourDoes)
{
   Jumped count;
   for (const double tolerance : {0.1, 0.01})
   {
      cattaneo_test::WornProblem of;
      ReducedProblem &problem = of.problem;
      Eigen::Matrix2d A, C;
      A << 5.67, -3.67, -3.67, 4.01;
      C << 3.45, -2, -2, 4.61;
      problem.set_stiffness(A, Eigen::Matrix2d::Zero(), C);
      const VectorXd none = VectorXd::Zero(2);
      problem.patterns = {{"P", Control::force, none, Eigen::Vector2d(1.3, 1.1)},
                          {"Q", Control::force, Eigen::Vector2d(2, 1.2), none}};
      problem.gap = Eigen::Vector2d(0.06, 0);
      problem.weights = VectorXd::Ones(2);
      problem.chains = one_chain(2);
      set_friction(problem, 0.75);
      problem.friction[1] = 0.59;
      of.history = LoadHistory::through(problem, {{},
                                                  {{"P", 1}},
                                                  {{"P", 1}, {"Q", 0.57}},
                                                  {{"P", 0.41}, {"Q", 0}},
                                                  {{"P", 1}, {"Q", 0.57}}});
      of.history.cycle_start = 2;
      of.law.coefficient = Eigen::Vector2d(0.07, 0.15);
      of.cycles = 201;
      of.settings.tolerance = tolerance;
      of.settings.march.stepping = Stepping::exact;
      of.settings.march.increments = 1;
      compare(of, "tolerance " + std::to_string(tolerance), count);
   }
   EXPECT_EQ(count.all, 2);
}
