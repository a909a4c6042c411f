#include "comparison.hpp"
#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "random_problem.hpp"
#include "worn_pads.hpp"
#include "worn_problems.hpp"

#include <atomic>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/wear/wear_march.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <cmath>

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
using cattaneo_test::springs;
using Eigen::Index;
using Eigen::VectorXd;

TEST(Wear, TheWornOutParabolaIsThatOfCiavarellaAndHills)
{
   struct Expected
   {
      double shear, extent, volume, depth, pressure;
   };
   // Closed forms in units a = P = R = 1 (Ciavarella and Hills 1999).
   for (const Expected &e : {Expected{0.5, 1.169186, 0.0726252, 0.1127331, 0.6752372},
                             Expected{0.2, 1.055433, 0.0052070, 0.0232868, 0.6405863}})
   {
      const double c = std::sqrt(1 - e.shear);
      const Pad pad = hertz_pad(grid_about(c, 1.1 * e.extent, 30, 20), e.shear);
      const ReducedProblem &problem = pad.problem;
      const WornOut end =
         worn_out(problem, pad.history, ContactState::virgin(problem), one_increment());
      ASSERT_EQ(end.status, FrictionStatus::converged) << end.message;
      EXPECT_LT(end.loss, 1e-10); // what slips carries nothing
      EXPECT_EQ(end.searches, 1); // the stick zone keeps its shape
      const Zone stick = stick_zone(problem, zones(problem, end.unworn, end.range));
      EXPECT_NEAR(0.5 * (stick.to.position - stick.from.position), c, 1e-3);
      // The smallest element is 1/460 of c: an edge there is known to about that.
      EXPECT_NEAR(worn_volume(problem, end.depth), e.volume, 0.01 * e.volume);
      EXPECT_NEAR(end.depth.maxCoeff(), e.depth, 0.005 * e.depth);
      const VectorXd x = problem.position.col(0), p = tractions(problem, end.contact.p);
      for (Index i = 0; i < x.size(); ++i)
      {
         const double ratio = std::abs(x[i]) / c, held = 1 - e.shear;
         const double depth =
            ratio <= 1
               ? 0.0
               : 0.5 * e.shear * std::acosh(ratio) -
                    0.5 * c * c * (ratio * std::sqrt(ratio * ratio - 1) - std::acosh(ratio));
         EXPECT_NEAR(end.depth[i], std::max(0.0, depth), 0.01 * e.depth) << x[i];
         if (ratio > 0.9) { continue; }
         const double root = std::sqrt(c * c - x[i] * x[i]);
         const double pressure = 2 / M_PI * root + (1 - held) / (M_PI * root);
         EXPECT_NEAR(p[i], pressure, 0.01 * pressure) << x[i];
         if (x[i] == 0) { EXPECT_NEAR(p[i], e.pressure, 2e-3); }
      }
   }
}

TEST(Wear, TheMarchApproachesTheWornOutStateAndItsVolumeIsThatOfItsEnergy)
{
   const Pad pad = small_pad();
   const WornOut end =
      worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem), one_increment());
   ASSERT_EQ(end.status, FrictionStatus::converged) << end.message;
   for (GapUpdate update : {GapUpdate::cycle, GapUpdate::piece})
   {
      const double k = 0.02;
      WearState state = WearState::virgin(pad.problem);
      WearSettings settings = settings_with(0);
      settings.update = update;
      double away = 1;
      VectorXd before = state.depth;
      const WearReport report = wear(
         pad.problem, WearLaw::uniform(pad.problem, k), pad.history, 600, state, settings,
         [&](const WearState &now, const WearRecord &record)
         {
            EXPECT_NEAR(record.volume, k / 0.5 * record.dissipation, 1e-13 * record.volume);
            EXPECT_GE((now.depth - before).minCoeff(), 0);
            before = now.depth;
            const double distance = largest(now.depth - end.depth);
            EXPECT_LE(distance, away * (1 + 1e-12));
            away = distance;
         });
      EXPECT_EQ(report.status, FrictionStatus::converged);
      EXPECT_EQ(report.marched, 600);
      EXPECT_LT(away, 1e-3 * largest(end.depth));
   }
}

// What a cycle takes of each spring is known by hand, p (4 d - 4 f p/kt) k with pressures by
// the gaps; jumps come to what the recurrence comes to, within what they report.
TEST(Wear, JumpsOverSpringsFollowTheRecurrence)
{
   const double kt = 5, kn = 2, f = 0.5, d = 1;
   for (const auto &[k, height, tolerance] :
        {std::tuple{1e-4, 0.1, 1e-1}, std::tuple{1e-4, 0.3, 1e-3}, std::tuple{3e-4, 0.1, 1e-2},
         std::tuple{1e-3, 0.1, 1e-3}, std::tuple{1e-3, 0.3, 1e-2}})
   {
      VectorXd gap(4);
      gap << 0, height / 3, height, 2 * height / 3;
      const Pad pad = springs(gap, kt, kn, f, d);
      WearState state = WearState::virgin(pad.problem);
      const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, k), pad.history,
                                     1000, state, settings_with(tolerance));
      VectorXd depth = VectorXd::Zero(4);
      for (int cycle = 0; cycle <= 1000; ++cycle)
      {
         const VectorXd g = gap + depth,
                        p = VectorXd::Ones(4) - kn * (g.array() - g.mean()).matrix();
         const double ways = cycle == 0 ? 1 : 4; // the opening part goes to d once
         depth += ways * k * p.cwiseProduct((d - f / kt * p.array()).matrix());
      }
      EXPECT_GT(report.jumps, 2);
      EXPECT_LE(largest(state.depth - depth), report.error);
      EXPECT_LE(report.error, tolerance * largest(depth));
   }
}

// What follows a state that has seen the opening part, and some cycles, comes to the same end.
TEST(Wear, WornOutOfALaterStateIsThatOfTheVirginOne)
{
   const Pad pad = small_pad();
   WearState state = WearState::virgin(pad.problem);
   wear(pad.problem, WearLaw::uniform(pad.problem, 0), pad.history, 2, state, settings_with(0));
   const WornOut early = worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem),
                                  one_increment()),
                 late = worn_out(pad.problem, pad.history, state.contact, one_increment());
   ASSERT_EQ(late.status, FrictionStatus::converged) << late.message;
   EXPECT_EQ(late.stick, early.stick);
   EXPECT_LT(largest(late.depth - early.depth), 1e-9 * largest(early.depth));
}

TEST(Wear, ABlockThatSlidesOnSpringsWearsUntilItsPressureIsUniform)
{
   // Pressures p = 1 - kn (g - mean g) decay to 1: each cycle slips 4 (d - f p/kt) and takes
   // off k p times that, of which small differences keep the share 1 - 4 k kn (d - 2 f/kt).
   const double kt = 5, kn = 2, f = 0.5, d = 1, k = 1e-3;
   VectorXd gap(4);
   gap << 0, 1e-4, 3e-4, 2e-4;
   const Pad pad = springs(gap, kt, kn, f, d);
   WearState state = WearState::virgin(pad.problem);
   std::vector<double> spread;
   WearSettings settings = settings_with(0);
   const auto note = [&](const WearState &now, const WearRecord &record)
   {
      const VectorXd p = now.contact.p;
      if (record.cycles > 0) { spread.push_back(p.maxCoeff() - p.minCoeff()); }
      EXPECT_NEAR(p.sum(), 4, 1e-12);
   };
   const WearLaw law = WearLaw::uniform(pad.problem, k);
   WearReport report = wear(pad.problem, law, pad.history, 40, state, settings, note);
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   const double share = 1 - 4 * k * kn * (d - 2 * f / kt);
   // Gaps of 3e-4 change pressures by 6e-4: linear to that.
   EXPECT_NEAR(std::pow(spread[39] / spread[19], 1.0 / 20), share, 1e-5);
   EXPECT_NEAR(report.explicit_limit, 2 / (4 * k * kn * (d - f / kt)), 2);
   // Then all wear alike, for good: jumps of any length have no error.
   settings.tolerance = 1e-3;
   report = wear(pad.problem, law, pad.history, 1e6, state, settings);
   EXPECT_GT(report.steady_cycle, 0);
   EXPECT_EQ(state.cycles, 1e6);
   EXPECT_LT(largest(state.contact.p - VectorXd::Ones(4)), 1e-6);
   const double whole = k * 4 * (d - f / kt) * 1e6;
   EXPECT_LT(largest(state.depth / whole - VectorXd::Ones(4)), 1e-3);
   // No node sticks: there is no end.
   const WornOut end = worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem));
   EXPECT_EQ(end.status, FrictionStatus::gross_sliding);
}

/// Where each cycle takes as much as the one before, the tenth takes a tenth of all so far: it
/// is where a march ends that a share of a tenth ends, and not before.
TEST(Wear, EndsAtTheShareThatIsCalledFinal)
{
   const double kt = 5, f = 0.5, d = 1, k = 1e-3;
   const Pad pad = springs(VectorXd::Zero(4), kt, 2, f, d);
   const WearLaw law = WearLaw::uniform(pad.problem, k);
   WearSettings settings = settings_with(0);
   settings.final_share = 0.1;
   WearState state = WearState::virgin(pad.problem);
   const WearReport report = wear(pad.problem, law, pad.history, 40, state, settings);
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_GE(report.final_cycle, 10);
   EXPECT_LE(report.final_cycle, 11);
   EXPECT_LE(state.cycles, 11);
   // And a quarter of a cycle on the way to the first turn.
   const double cycle = k * 4 * (d - f / kt);
   EXPECT_LT(largest(state.depth / cycle - VectorXd::Constant(4, state.cycles + 0.25)), 1e-9);
   settings.final_share = 0;
   state = WearState::virgin(pad.problem);
   EXPECT_EQ(wear(pad.problem, law, pad.history, 40, state, settings).final_cycle, 0);
   EXPECT_EQ(state.cycles, 40);
}

TEST(Wear, WhereACycleWearsMoreThanTheContactGivesWayByItsUpdateIsImplicit)
{
   // 4 k kn (d - f/kt) = 7.2: the explicit update multiplies differences by -6.2 a cycle.
   VectorXd gap(4);
   gap << 0, 1e-4, 3e-4, 2e-4;
   const Pad pad = springs(gap, 5, 2, 0.5, 1);
   WearState state = WearState::virgin(pad.problem);
   const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, 1), pad.history,
                                  40, state, settings_with(0));
   ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_NEAR(report.explicit_limit, 2 / 7.2, 1e-3);
   EXPECT_EQ(report.implicit_cycles, 41); // with the opening part
   EXPECT_LT(largest(state.contact.p - VectorXd::Ones(4)), 1e-9);
   EXPECT_LT(largest(state.depth - state.depth.mean() * VectorXd::Ones(4)), 4e-4);
}

TEST(Wear, OneIncrementWearsWhatThePressureAlongItsSlipSays)
{
   // One node, pressure from 3 to 1 over weight 2, slip 0.4: traction from 1.5 to 0.5.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Zero(1, 1),
                         Eigen::MatrixXd::Ones(1, 1));
   problem.weights = VectorXd::Constant(1, 2);
   set_friction(problem, 0.5);
   ContactState before = ContactState::virgin(problem), after = before;
   before.p[0] = 3;
   after.p[0] = 1;
   before.q[0] = 1.5;
   after.q[0] = 0.5;
   after.v[0] = -0.4;
   before.status[0] = after.status[0] = NodeState::backward_slip;
   WearLaw law = WearLaw::uniform(problem, 10);
   EXPECT_NEAR(worn_depth(problem, law, before, after)[0], 10 * 1.0 * 0.4, 1e-14);
   law.threshold = VectorXd::Constant(1, 0.25); // all above it
   EXPECT_NEAR(worn_depth(problem, law, before, after)[0], 10 * 0.75 * 0.4, 1e-14);
   law.threshold[0] = 1; // half of the way, 0.25 on the mean of it
   EXPECT_NEAR(worn_depth(problem, law, before, after)[0], 10 * 0.125 * 0.4, 1e-14);
   law.threshold[0] = 2;
   EXPECT_EQ(worn_depth(problem, law, before, after)[0], 0);
   law.threshold[0] = 0;
   law.of_energy = true;
   EXPECT_NEAR(worn_depth(problem, law, before, after)[0], 10 * 0.5 * 1.0 * 0.4, 1e-14);
}

TEST(Wear, DependsNeitherOnUnitsNorOnTheSide)
{
   const Pad pad = small_pad(), large = small_pad(1e3);
   WearState state = WearState::virgin(pad.problem), scaled = WearState::virgin(large.problem);
   for (double tolerance : {0.0, 1e-2})
   {
      wear(pad.problem, WearLaw::uniform(pad.problem, 1e-3), pad.history, 200, state,
           settings_with(tolerance));
      wear(large.problem, WearLaw::uniform(large.problem, 1e-3), large.history, 200, scaled,
           settings_with(tolerance));
      // Per unit thickness forces go with lengths: pressures stay.
      EXPECT_LT(largest(scaled.depth / 1e3 - state.depth), 1e-9 * largest(state.depth));
      EXPECT_LT(largest(state.depth - state.depth.reverse()), 1e-9 * largest(state.depth));
   }
}

TEST(Wear, GoesOnFromASavedStateToTheSameBits)
{
   const Pad pad = small_pad();
   const WearLaw law = WearLaw::uniform(pad.problem, 1e-2);
   WearState whole = WearState::virgin(pad.problem), half = whole;
   wear(pad.problem, law, pad.history, 20, whole, settings_with(0));
   wear(pad.problem, law, pad.history, 7, half, settings_with(0));
   const std::string file = testing::TempDir() + "wear.json";
   save(half, file);
   WearState again = load_wear_state(file);
   wear(pad.problem, law, pad.history, 20, again, settings_with(0));
   EXPECT_EQ(again.depth, whole.depth);
   EXPECT_EQ(again.dissipation, whole.dissipation);
   EXPECT_EQ(again.contact.v, whole.contact.v);
   EXPECT_EQ(again.cycles, 20);
   expect_input_error([] { load_wear_state("nowhere.json"); }, "nowhere.json");
   save(half.contact, file);
   expect_input_error([&] { load_wear_state(file); }, "wear state");
   // Bodies that are twice as stiff have other forces at the same displacements.
   Pad stiff = pad;
   stiff.problem.K *= 2;
   expect_input_error([&]
                      { wear(stiff.problem, law, stiff.history, 20, half, settings_with(0)); },
                      "another reduced problem");
   EXPECT_EQ(half.cycles, 7);
}

TEST(Wear, WithoutKNothingWears)
{
   const Pad pad = small_pad();
   WearState state = WearState::virgin(pad.problem);
   const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, 0), pad.history,
                                  100, state, settings_with(1e-3));
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_TRUE(state.depth.isZero(0));
   EXPECT_GT(state.dissipation.sum(), 0);
   EXPECT_TRUE(std::isinf(report.explicit_limit));
}

TEST(Wear, GrossSlidingEndsItWithItsStatus)
{
   const Pad pad = hertz_pad(grid_about(0.7, 1.3, 10, 8), 1.1);
   WearState state = WearState::virgin(pad.problem);
   const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, 1e-3), pad.history,
                                  10, state, settings_with(0));
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_EQ(state.cycles, 0);
   EXPECT_EQ(worn_out(pad.problem, pad.history, ContactState::virgin(pad.problem)).status,
             FrictionStatus::gross_sliding);
}

TEST(Wear, RandomContactsWearByTheirEnergyAndComeToAnEnd)
{
   std::mt19937 random(5);
   int ends = 0;
   for (int round = 0; round < 40; ++round)
   {
      const ReducedProblem problem =
         cattaneo_test::random_problem(6, 0.4, round % 2 ? 0.2 : 0.0, random);
      const double Q = 0.4;
      LoadHistory history = LoadHistory::through(problem, {{},
                                                           {{"press", 2}},
                                                           {{"press", 2}, {"shear", Q}},
                                                           {{"press", 2}, {"shear", -Q}},
                                                           {{"press", 2}, {"shear", Q}}});
      history.cycle_start = 2;
      WearState state = WearState::virgin(problem);
      const double k = 0.01;
      const WearReport report = wear(problem, WearLaw::uniform(problem, k), history, 60, state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << round << report.message;
      EXPECT_GE(state.depth.minCoeff(), 0);
      if (report.implicit_cycles == 0)
      {
         EXPECT_NEAR(state.depth.sum(), k / 0.4 * state.dissipation.sum(),
                     1e-12 * (1 + state.depth.sum()));
      }
      const WornOut end = worn_out(problem, history, ContactState::virgin(problem));
      if (end.status != FrictionStatus::converged) { continue; }
      ++ends;
      EXPECT_GE(end.depth.minCoeff(), 0);
      EXPECT_LT(end.loss, 1e-8) << round;
   }
   EXPECT_GT(ends, 20);
}

namespace
{

/// `pattern` between ±amplitude, after "press" to 2.
LoadHistory pressed(const ReducedProblem &problem, const std::string &pattern, double amplitude)
{
   LoadHistory history = LoadHistory::through(problem, {{},
                                                        {{"press", 2}},
                                                        {{"press", 2}, {pattern, amplitude}},
                                                        {{"press", 2}, {pattern, -amplitude}},
                                                        {{"press", 2}, {pattern, amplitude}}});
   history.cycle_start = 2;
   return history;
}

} // namespace

TEST(Wear, UpdatesAfterEachCycleAreOfFirstOrder)
{
   // Half of k for twice the cycles is the same wear with half the error.
   std::mt19937 random(3);
   cattaneo_test::random_problem(6, 0.4, 0.1, random); // nothing slips in the first
   for (int round = 0; round < 5; ++round)
   {
      const ReducedProblem problem = cattaneo_test::random_problem(6, 0.4, 0.1, random);
      const LoadHistory history = pressed(problem, "shear", 0.4);
      std::vector<VectorXd> depths;
      for (int halves = 0; halves < 4; ++halves)
      {
         WearState state = WearState::virgin(problem);
         wear(problem, WearLaw::uniform(problem, 0.04 / (1 << halves)), history, 20 << halves,
              state);
         depths.push_back(state.depth);
      }
      for (int halves = 0; halves < 2; ++halves)
      {
         const double change = largest(depths[halves] - depths[halves + 1]),
                      next = largest(depths[halves + 1] - depths[halves + 2]);
         EXPECT_NEAR(change / next, 2, 0.2) << round;
      }
   }
}

TEST(Wear, SlipOfTwoComponentsWearsByItsEnergyToo)
{
   std::mt19937 random(11);
   double worn = 0;
   for (int round = 0; round < 20; ++round)
   {
      const ReducedProblem problem =
         cattaneo_test::random_disc_problem(5, 0.4, round % 2 ? 0.2 : 0.0, random);
      const LoadHistory history = pressed(problem, "twist", 0.8);
      WearState state = WearState::virgin(problem);
      WearSettings settings;
      settings.march.increments = 8;
      const double k = 2e-3;
      const WearReport report =
         wear(problem, WearLaw::uniform(problem, k), history, 20, state, settings);
      if (report.status != FrictionStatus::converged || report.implicit_cycles > 0)
      {
         continue;
      }
      EXPECT_GE(state.depth.minCoeff(), 0);
      const double volume = worn_volume(problem, state.depth);
      EXPECT_NEAR(volume, k / 0.4 * state.dissipation.sum(), 1e-13 * volume);
      worn += volume;
   }
   EXPECT_GT(worn, 0);
}

TEST(Wear, BadInputIsNamed)
{
   const Pad pad = small_pad();
   const ReducedProblem &problem = pad.problem;
   WearState state = WearState::virgin(problem);
   WearLaw law = WearLaw::uniform(problem, 1);
   const auto run = [&](double cycles, const WearSettings &settings = {})
   { wear(problem, law, pad.history, cycles, state, settings); };
   expect_input_error([&] { run(1.5); }, "cycles is 1.5");
   expect_input_error([&] { run(-1); }, "cycles");
   WearSettings settings;
   settings.tolerance = 0.5;
   expect_input_error([&] { run(1, settings); }, "tolerance is 0.5");
   settings.tolerance = 5e-9;
   expect_input_error([&] { run(1, settings); }, "tolerance is 5e-09");
   LoadHistory open = pad.history;
   open.cycle_start = -1;
   expect_input_error([&] { wear(problem, law, open, 1, state); }, "no cycle");
   expect_input_error([&] { worn_out(problem, open, state.contact); }, "no cycle");
   state.cycles = 2;
   expect_input_error([&] { run(1); }, "must be at least 2");
   state.cycles = 0;
   run(1);
   LoadHistory other = pad.history;
   other.multipliers.rightCols(3) *= 0.5;
   expect_input_error([&] { wear(problem, law, other, 3, state); }, "load multipliers");
   // Loads that are larger than the state's differ no less than those that are smaller.
   other.multipliers.rightCols(3) *= 4;
   expect_input_error([&] { wear(problem, law, other, 3, state); }, "load multipliers");
   state.depth[3] = -1;
   expect_input_error([&] { run(1); }, "depth");
   state = WearState::virgin(problem);
   law.coefficient[2] = -1;
   expect_input_error([&] { run(1); }, "coefficient of node 2 is -1");
   law = WearLaw::uniform(problem, 1);
   law.threshold = VectorXd::Ones(3);
   expect_input_error([&] { run(1); }, "threshold");
   expect_input_error([&] { law.set(problem, "nowhere", 1); }, "nowhere");
}

TEST(Wear, ToleranceHoldsOnRandomSmallProblems)
{
   Jumped count;
   const int seeds = rounds(45, 2000);
   for (int seed = 0; seed < seeds; ++seed)
   {
      compare(cattaneo_test::random_worn_problem(seed), "seed " + std::to_string(seed), count);
   }
   EXPECT_GT(count.all, 0.9 * seeds);
   EXPECT_GT(count.jumped, 0.6 * seeds);
   EXPECT_LE(count.not_reached, 0.01 * seeds);
   EXPECT_LE(static_cast<double>(count.rows_missed), 1e-3 * static_cast<double>(count.rows));
}

// Two nodes are dragged to and fro, and stay closed: p = 1 - C depth, whatever has been marched
// or jumped over. A cycle there loses f p times the way of each node, 4 (1 - f p/k) with the
// stiffness k = 1/1.3 of both together.
TEST(Wear, StatesAreThoseOfTheWornContact)
{
   ReducedProblem problem;
   Eigen::Matrix2d G;
   G << 1, 0.3, 0.3, 1;
   const Eigen::Matrix2d C = G.inverse();
   problem.set_stiffness(C, Eigen::Matrix2d::Zero(), C);
   const VectorXd none = VectorXd::Zero(2), ones = VectorXd::Ones(2);
   problem.patterns = {{"P", Control::force, none, ones},
                       {"D", Control::displacement, C * ones, none}};
   problem.gap = none;
   problem.weights = ones;
   problem.chains = one_chain(2);
   set_friction(problem, 0.3);
   LoadHistory history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"P", 1}, {"D", 1}}, {{"P", 1}, {"D", -1}}, {{"P", 1}, {"D", 1}}});
   history.cycle_start = 2;
   const auto closed_form = [&](const WearState &now)
   {
      const VectorXd p = ones - C * now.depth;
      EXPECT_LT(largest(now.contact.p - p), 1e-12);
      EXPECT_LT(largest(now.contact.w + now.depth), 1e-12); // closed
      EXPECT_LT(largest(now.contact.q.cwiseAbs() - 0.3 * p), 1e-12);
   };
   for (const double tolerance : {0.0, 1e-1, 1e-2, 1e-3})
   {
      WearState state = WearState::virgin(problem);
      WearSettings settings;
      settings.tolerance = tolerance;
      settings.march.stepping = Stepping::exact;
      const WearReport report =
         wear(problem, WearLaw::uniform(problem, 1e-4), history, 4000, state, settings,
              [&](const WearState &now, const WearRecord &record)
              {
                 closed_form(now);
                 // Each cycle marched loses as much, but for what one wears of it.
                 const double p = 1 - now.depth[0] / 1.3,
                              loss = 2 * 0.3 * p * 4 * (1 - 0.3 * p * 1.3);
                 if (record.cycles > 0) { EXPECT_NEAR(record.loss, loss, 1e-3 * loss); }
              });
      EXPECT_EQ(report.jumps > 0, tolerance > 0);
      closed_form(state);
      EXPECT_EQ(report.records.back().cycles, 4000);
   }
}

// Asked to stop in the middle of a cycle, nothing more is marched, and the state stands where
// the cycle began.
TEST(Wear, StopsWithinACycle)
{
   const Pad pad = small_pad();
   for (const int when : {3, 20, 130})
   {
      std::atomic<bool> stop{false};
      WearSettings settings;
      settings.march.increments = 10;
      settings.march.stepping = Stepping::fixed;
      settings.march.single_increment_if_exact = false;
      settings.march.monitor.stop = &stop;
      WearState state = WearState::virgin(pad.problem);
      int marched = 0;
      const auto watch =
         [&](const ContactState &, const IncrementRecord &, const VectorXd &) // 20 an opening
      { stop = ++marched >= when; };
      const WearReport report = wear(pad.problem, WearLaw::uniform(pad.problem, 1e-4),
                                     pad.history, 1000, state, settings, {}, watch);
      EXPECT_EQ(report.status, FrictionStatus::stopped);
      EXPECT_EQ(marched, when);
      EXPECT_EQ(state.cycles, std::max(0, (when - 20) / 20));
      stop = false;
      settings.march.monitor = {};
      EXPECT_EQ(wear(pad.problem, WearLaw::uniform(pad.problem, 1e-4), pad.history,
                     state.cycles + 1, state, settings)
                   .status,
                FrictionStatus::converged);
   }
}
