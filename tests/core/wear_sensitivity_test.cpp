#include "expect_input_error.hpp"
#include "random_problem.hpp"

#include <cattaneo/design/sensitivity.hpp>
#include <gtest/gtest.h>

using namespace cattaneo;
using cattaneo_test::random_problem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

struct WearCase
{
   ReducedProblem problem;
   LoadHistory history;
   WearLaw law;
   WearSettings settings;
   double cycles = 12;
};

/// Pressed and sheared to and fro, with nodes that open, close and turn; a law of each kind.
WearCase random_wear(int seed, Stepping stepping)
{
   std::mt19937 random(seed);
   WearCase c;
   c.problem = random_problem(7, 0.3, 0.3, random);
   for (double &f : c.problem.friction) { f *= 1 + 0.3 * std::cos(7 * f + random() % 100); }
   c.problem.gap.array() += 0.05;
   c.problem.weights = VectorXd::LinSpaced(7, 0.5, 1.3);
   c.history = LoadHistory::through(c.problem, {{},
                                                {{"press", 1.1}, {"shear", 0.3}},
                                                {{"press", 1.2}, {"shear", 0.6}},
                                                {{"press", 0.9}, {"shear", -0.7}},
                                                {{"press", 1.2}, {"shear", 0.6}}});
   c.history.cycle_start = 2;
   c.history.cycles = 1;
   c.law = WearLaw::uniform(c.problem, 4e-3);
   if (seed % 3 == 1) { c.law.threshold = VectorXd::Constant(7, 0.1); }
   c.law.of_energy = seed % 3 == 2;
   c.settings.march.stepping = stepping;
   c.settings.march.increments = 3;
   c.settings.march.single_increment_if_exact = false;
   c.settings.update = seed % 2 ? GapUpdate::cycle : GapUpdate::piece;
   return c;
}

/// wear() itself, with parameters changed.
WearState worn(WearCase c, const Parameters &by, double h)
{
   if (by.friction.size()) { c.problem.friction += h * by.friction; }
   if (by.gap.size()) { c.problem.gap += h * by.gap; }
   if (by.multipliers.size()) { c.history.multipliers += h * by.multipliers; }
   if (by.wear.size()) { c.law.coefficient += h * by.wear; }
   if (by.stiffness.size()) { c.problem.K *= 1 + h * by.stiffness[0]; }
   WearState state = WearState::virgin(c.problem);
   const WearReport report = wear(c.problem, c.law, c.history, c.cycles, state, c.settings);
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_EQ(report.implicit_cycles, 0);
   return state;
}

} // namespace

class EachLaw : public testing::TestWithParam<std::tuple<Stepping, int>>
{
};

// Depths after many cycles, through all updates of the gap, against wear() at parameters
// nearby.
TEST_P(EachLaw, DerivativesOfWornDepthAreThoseOfWear)
{
   const auto [stepping, seed] = GetParam();
   const WearCase c = random_wear(seed, stepping);
   WearState state = WearState::virgin(c.problem);
   const MarchTrace trace =
      trace_wear(c.problem, c.law, c.history, c.cycles, state, c.settings);
   ASSERT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
   // The trace is that of wear(), to the last bit.
   const WearState again = worn(c, {}, 0);
   EXPECT_EQ(state.depth, again.depth);
   EXPECT_EQ(trace.states.back().state.v, again.marched->v);
   const Responses of(c.problem, trace);
   const std::size_t last = trace.last();
   EXPECT_NEAR(trace.states[last].state.time, 2 + 2 * c.cycles, 1e-12);
   EXPECT_NEAR(of.worn_volume(0, last).value, worn_volume(c.problem, state.depth), 1e-13);
   ASSERT_GT(state.depth.maxCoeff(), 0);
   Sensitivity sensitivity(c.problem, trace, {stiffness_scale(c.problem)});
   std::srand(seed);
   std::vector<Parameters> directions(5);
   directions[0].friction = VectorXd::Random(7);
   directions[1].gap = VectorXd::Random(7);
   directions[2].multipliers = MatrixXd::Random(2, 5);
   directions[2].multipliers.col(0).setZero();
   directions[2].multipliers.col(4) = directions[2].multipliers.col(2);
   directions[3].wear = VectorXd::Random(7) * 0.1;
   directions[4].stiffness = VectorXd::Ones(1);
   const double scale = state.depth.maxCoeff(), h = 1e-6;
   for (const Parameters &direction : directions)
   {
      const WearState above = worn(c, direction, h), below = worn(c, direction, -h);
      const TraceChange change = sensitivity.along(direction);
      ASSERT_TRUE(change.found) << change.message;
      for (Index i = 0; i < 7; ++i)
      {
         const Response depth = of.worn_depth(0, last, i), slip = of.slip(last, i);
         EXPECT_NEAR(depth.value, state.depth[i], 1e-13 * scale);
         const double expected = (above.depth[i] - below.depth[i]) / (2 * h),
                      slipped = (above.marched->v[i] - below.marched->v[i]) / (2 * h);
         EXPECT_NEAR(change.of(depth), expected, 1e-7 * (scale + std::abs(expected))) << i;
         EXPECT_NEAR(change.of(slip), slipped, 1e-7 * (1 + std::abs(slipped))) << i;
         for (const Response &response : {depth, slip})
         {
            const Gradient gradient = sensitivity.gradient(response);
            ASSERT_TRUE(gradient.found) << gradient.message;
            EXPECT_NEAR(gradient.by.dot(direction), change.of(response),
                        1e-11 * (1 + std::abs(change.of(response))));
         }
      }
   }
}

INSTANTIATE_TEST_SUITE_P(WearSensitivity, EachLaw,
                         testing::Combine(testing::Values(Stepping::fixed, Stepping::exact),
                                          testing::Values(1, 2, 3, 4, 5, 6)));

// Springs of their own beneath a block that is moved by ±d with the pressure given: each cycle
// wears k p 4 (d - f p/kt)/weight, whatever was worn before.
TEST(WearSensitivity, OfSpringsInClosedForm)
{
   const double kt = 5, f = 0.5, P = 1, d = 1, k = 1e-3, weight = 2;
   ReducedProblem problem;
   const MatrixXd one = MatrixXd::Ones(1, 1);
   problem.set_stiffness(kt * one, 0 * one, 1e-12 * one); // P is carried whatever the gap
   const VectorXd none = VectorXd::Zero(1), unit = VectorXd::Ones(1);
   problem.patterns = {{"P", Control::force, none, unit},
                       {"d", Control::displacement, -kt * unit, none}};
   problem.gap = none;
   problem.weights = weight * unit;
   problem.chains = one_chain(1);
   set_friction(problem, f);
   LoadHistory history = LoadHistory::through(
      problem,
      {{}, {{"P", P}}, {{"P", P}, {"d", d}}, {{"P", P}, {"d", -d}}, {{"P", P}, {"d", d}}});
   history.cycle_start = 2;
   const int cycles = 7;
   const MarchTrace trace = trace_wear(problem, WearLaw::uniform(problem, k), history, cycles);
   ASSERT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
   const Responses of(problem, trace);
   const Response depth = of.worn_depth(trace.at(2), trace.last(), 0);
   EXPECT_NEAR(depth.value, cycles * k * P * 4 * (d - f * P / kt) / weight, 1e-12);
   const Gradient by = Sensitivity(problem, trace).gradient(depth);
   ASSERT_TRUE(by.found) << by.message;
   EXPECT_NEAR(by.by.wear[0], depth.value / k, 1e-10);
   EXPECT_NEAR(by.by.friction[0], -cycles * k * 4 * P * P / kt / weight, 1e-10);
   // By the pressure at all points of the cycle together.
   EXPECT_NEAR(by.by.multipliers.row(0).sum(), cycles * k * 4 * (d - 2 * f * P / kt) / weight,
               1e-10);
}

TEST(WearSensitivity, RefusesWhatHasNoDerivatives)
{
   WearCase c = random_wear(1, Stepping::fixed);
   c.settings.tolerance = 1e-3;
   expect_input_error([&] { trace_wear(c.problem, c.law, c.history, 3, c.settings); },
                      "tolerance");
   c.settings.tolerance = 0;
   expect_input_error(
      [&] { trace_wear(c.problem, WearLaw::uniform(c.problem, 50), c.history, 3, c.settings); },
      "implicit");
   const MarchTrace plain = trace_march(c.problem, c.history);
   expect_input_error([&] { Responses(c.problem, plain).worn_depth(0, 1, 0); },
                      "without a wear law");
   Parameters by;
   by.wear = VectorXd::Ones(7);
   expect_input_error([&] { Sensitivity(c.problem, plain).along(by); }, "law");
}
