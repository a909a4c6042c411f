#include "differentiated_march.hpp"
#include "expect_input_error.hpp"
#include "random_problem.hpp"
#include "record.hpp"
#include "small_problems.hpp"

#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>

using namespace cattaneo;
using cattaneo_test::by_differences;
using cattaneo_test::Differentiated;
using cattaneo_test::directions;
using cattaneo_test::MarchCase;
using cattaneo_test::random_case;
using cattaneo_test::Read;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Everything that a march returns, and products and quotients of it.
const std::vector<std::pair<const char *, Read>> &all_responses()
{
   static const std::vector<std::pair<const char *, Read>> all = {
      {"dissipation", [](const Responses &of, const MarchTrace &trace)
       { return of.dissipation(0, trace.last()); }},
      {"loss of a node", [](const Responses &of, const MarchTrace &trace)
       { return of.dissipation(trace.at(1), trace.last(), 3); }},
      {"slip",
       [](const Responses &of, const MarchTrace &trace) { return of.slip(trace.last(), 2); }},
      {"opening", [](const Responses &of, const MarchTrace &trace)
       { return of.opening(trace.at(2), 5) + of.opening(trace.at(2), 1); }},
      {"shear", [](const Responses &of, const MarchTrace &trace)
       { return of.shear(trace.at(3), 1) - of.shear(trace.at(2), 4); }},
      {"peak pressure", [](const Responses &of, const MarchTrace &trace)
       { return of.peak_pressure(trace.at(2)); }},
      {"resultants",
       [](const Responses &of, const MarchTrace &trace)
       {
          return of.shear_resultant(trace.last()) *
                 of.normal_resultant(trace.at(3), VectorXd::LinSpaced(8, -1, 2));
       }},
      {"multiplier", [](const Responses &of, const MarchTrace &trace)
       { return of.multiplier(trace.at(3), "press") * of.slip(trace.at(3), 1); }},
      {"stiffness", [](const Responses &of, const MarchTrace &trace)
       { return of.secant_stiffness(trace.at(2), trace.at(3), "shear"); }},
      {"loss factor",
       [](const Responses &of, const MarchTrace &trace)
       {
          const Response force = of.multiplier(trace.at(2), "shear") -
                                 of.multiplier(trace.at(3), "shear"),
                         moved = of.conjugate(trace.at(2), "shear") -
                                 of.conjugate(trace.at(3), "shear");
          return of.dissipation(trace.at(2), trace.last()) / (force * moved);
       }},
   };
   return all;
}

} // namespace

class EachStepping : public testing::TestWithParam<std::tuple<Stepping, int>>
{
};

// The only oracle here is the march itself, at parameters that differ a little.
TEST_P(EachStepping, DerivativesAreThoseOfTheMarch)
{
   const auto [stepping, seed] = GetParam();
   Differentiated at(random_case(seed, stepping));
   ASSERT_TRUE(ties(at.c.problem, at.trace).empty());
   for (const Parameters &direction : directions(at.c, seed))
   {
      const TraceChange change = at.sensitivity.along(direction);
      ASSERT_TRUE(change.found) << change.message;
      for (const auto &[name, read] : all_responses())
      {
         const Response response = at.response(read);
         const Gradient gradient = at.sensitivity.gradient(response);
         ASSERT_TRUE(gradient.found) << gradient.message;
         const double forward = change.of(response), backward = gradient.by.dot(direction),
                      expected = by_differences(at.c, direction, read, 1e-6),
                      scale = std::max(std::abs(response.value), std::abs(expected));
         EXPECT_NEAR(backward, expected, 3e-8 * scale) << name;
         EXPECT_NEAR(forward, backward, 1e-12 * scale) << name;
      }
   }
}

// With loads and gaps displacements and forces are scaled, and energies twice.
TEST_P(EachStepping, EulersIdentity)
{
   const auto [stepping, seed] = GetParam();
   Differentiated at(random_case(seed, stepping));
   Parameters scaled;
   scaled.gap = at.c.problem.gap;
   scaled.multipliers = at.c.history.multipliers;
   const double degree[] = {2, 2, 1, 1, 1, 1, 2, 2, 0, 0};
   std::size_t k = 0;
   for (const auto &[name, read] : all_responses())
   {
      const Response response = at.response(read);
      EXPECT_NEAR(at.sensitivity.gradient(response).by.dot(scaled),
                  degree[k++] * response.value, 1e-10 * std::abs(response.value))
         << name;
   }
}

INSTANTIATE_TEST_SUITE_P(Sensitivity, EachStepping,
                         testing::Combine(testing::Values(Stepping::fixed, Stepping::exact),
                                          testing::Values(1, 2, 3, 4, 5, 6)));

// A block on a spring of stiffness 2 slips from Q = f P on, v = (f P - Q)/2, and loses
// f P (Q - f P)/2.
TEST(Sensitivity, BlockOnASpringInClosedForm)
{
   const double f = 0.3, P = 2, Q = 1;
   const ReducedProblem problem = cattaneo_test::one_block(f);
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"press", P}}, {{"press", P}, {"shear", Q}}});
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   const MarchTrace trace = trace_march(problem, history, settings);
   Sensitivity sensitivity(problem, trace);
   const Responses of(problem, trace);
   const Gradient lost = sensitivity.gradient(of.dissipation(0, trace.last()));
   ASSERT_TRUE(lost.found);
   EXPECT_NEAR(lost.by.friction[0], P * (Q - 2 * f * P) / 2, 1e-14);
   EXPECT_NEAR(lost.by.multipliers(0, 1) + lost.by.multipliers(0, 2), f * (Q - 2 * f * P) / 2,
               1e-14);
   EXPECT_NEAR(lost.by.multipliers(1, 2), f * P / 2, 1e-14);
   const Gradient slip = sensitivity.gradient(of.slip(trace.last(), 0));
   EXPECT_NEAR(slip.by.friction[0], P / 2, 1e-14);
   EXPECT_NEAR(slip.by.multipliers(1, 2), -0.5, 1e-14);
   EXPECT_NEAR(slip.by.gap[0], -1.5 * f, 1e-14); // p falls by 3 a unit of gap
   // The load at which it slips is f P.
   std::size_t event = 0;
   while (event < trace.last() && trace.states[event].event < 0) { ++event; }
   const Response load = of.multiplier(event, "shear");
   EXPECT_NEAR(load.value, f * P, 1e-14);
   EXPECT_NEAR(sensitivity.gradient(load).by.friction[0], P, 1e-13);
}

// Hertz: p0 = √(P E*/πR) and with it ∂p0/∂P = p0/2P and, R being that of the gap x²/2R,
// ∂p0/∂(1/R) = p0 R/2. Cattaneo: the shear amid
// the stick zone.
TEST(Sensitivity, HertzAndCattaneo)
{
   HalfPlane pad, plane;
   pad.material = plane.material = Material{8 / M_PI * 0.91, 0.3}; // a = P = R = 1
   pad.depth = plane.depth = 1e4;
   pad.normal = {0, 1};
   pad.forces = {{"P", {0, -1}}, {"Q", {1, 0}}};
   std::vector<double> grid;
   for (int k = -30; k <= 30; ++k) { grid.push_back(k / 25.0); }
   ReducedProblem problem = reduce(condense(pad, grid, 1), plane).problem;
   problem.B().setZero(); // equal half-planes
   join_coupling(problem);
   const double f = 0.5, Q = 0.3;
   set_friction(problem, f);
   const VectorXd square = problem.position.col(0).cwiseAbs2();
   problem.gap = 0.5 * square;
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", Q}}});
   MarchSettings settings;
   settings.increments_of_piece = {1, 4};
   const MarchTrace trace = trace_march(problem, history, settings);
   ASSERT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
   const Responses of(problem, trace);
   Sensitivity sensitivity(problem, trace);
   const double p0 = 2 / M_PI;
   const Response peak = of.peak_pressure(trace.at(1));
   EXPECT_NEAR(peak.value, p0, 2e-3 * p0);
   const Gradient by = sensitivity.gradient(peak);
   ASSERT_TRUE(by.found) << by.message;
   EXPECT_NEAR(by.by.multipliers(0, 1), p0 / 2, 0.02 * p0);
   EXPECT_NEAR(by.by.gap.dot(0.5 * square), p0 / 2, 0.02 * p0);
   cattaneo_test::record("by_load", by.by.multipliers(0, 1) / (p0 / 2));
   cattaneo_test::record("by_curvature", by.by.gap.dot(0.5 * square) / (p0 / 2));
   // The pressure amid it is a sum of the loads; that it does not change with friction is
   // exact.
   EXPECT_EQ(by.by.friction.norm(), 0);
   // q at the centre, with q' = f p0/a √(a² - x²) - f (p0/a) √(c² - x²), c² = 1 - Q/fP:
   // f p0 (1 - c), by f: p0 (1 - c) - p0 Q/(2 f c).
   // The two sides change their states together, one after the other.
   Parameters flatter;
   flatter.gap = 0.5 * square;
   const Read lost = [](const Responses &read, const MarchTrace &march)
   { return read.dissipation(0, march.last()); };
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchCase all{problem, history, settings};
      all.settings.stepping = stepping;
      Differentiated at(all);
      const Response energy = at.response(lost);
      EXPECT_NEAR(at.sensitivity.gradient(energy).by.dot(flatter),
                  by_differences(all, flatter, lost, 1e-5), 1e-6 * energy.value);
   }
   const double c = std::sqrt(1 - Q / f);
   const Response shear = (-1 / problem.weights[30]) * of.shear(trace.last(), 30);
   const double sign = shear.value > 0 ? 1 : -1;
   EXPECT_NEAR(sign * shear.value, f * p0 * (1 - c), 0.01 * p0);
   EXPECT_NEAR(sign * sensitivity.gradient(shear).by.friction.sum(),
               p0 * (1 - c) - p0 * Q / (2 * f * c), 0.02 * p0);
}

TEST(Sensitivity, RefusesWhatDoesNotFit)
{
   const MarchCase c = random_case(1, Stepping::fixed);
   const MarchTrace trace = trace_march(c.problem, c.history, c.settings);
   const Responses of(c.problem, trace);
   expect_input_error([&] { of.slip(trace.last() + 1, 0); }, "state");
   expect_input_error([&] { of.slip(0, 8); }, "node 8");
   expect_input_error([&] { of.slip(0, 0, 1); }, "component 1");
   expect_input_error([&] { of.multiplier(0, "pull"); }, "pull");
   expect_input_error([&] { of.slip(0, 0) / (0.0 * of.slip(0, 0)); }, "the divisor is zero");
   expect_input_error([&] { trace.at(99); }, "99");
   Sensitivity sensitivity(c.problem, trace);
   Parameters change;
   change.gap = VectorXd::Zero(3);
   expect_input_error([&] { sensitivity.along(change); }, "gap");
   expect_input_error(
      [&] {
         Sensitivity(c.problem, trace, {{MatrixXd::Zero(2, 2), {}, {}}});
      },
      "change of the stiffness");
}
