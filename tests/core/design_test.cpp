#include "expect_input_error.hpp"
#include "small_problems.hpp"

#include <atomic>
#include <cattaneo/design/design.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// A flat pad |x| < 1 on a half-plane of the same material, pressed by P and sheared by Q; E* =
/// 8/π /2, so that a parabola x²/2 would have a = 1 under P = 1.
ReducedProblem flat_pad(int elements, double friction)
{
   HalfPlane pad, plane;
   pad.material = plane.material = Material{8 / M_PI * 0.91, 0.3};
   pad.depth = plane.depth = 1e4;
   pad.normal = {0, 1};
   pad.forces = {{"P", {0, -1}}, {"Q", {1, 0}}};
   std::vector<double> grid;
   for (int k = -elements; k <= elements; k += 2) { grid.push_back(double(k) / elements); }
   ReducedProblem problem = reduce(condense(pad, grid, 1), plane).problem;
   problem.B().setZero(); // equal half-planes
   join_coupling(problem);
   set_friction(problem, friction);
   problem.gap.setZero();
   return problem;
}

/// Every node's gap is free but that of the middle one.
DesignProblem free_profile(const ReducedProblem &flat, double most)
{
   const Index n = flat.nodes(), middle = n / 2;
   DesignProblem design;
   design.problem = flat;
   MatrixXd G = MatrixXd::Zero(n, n - 1);
   for (Index i = 0, j = 0; i < n; ++i)
   {
      if (i != middle) { G(i, j++) = 1; }
   }
   design.variables = gap_variables(G);
   design.low = VectorXd::Zero(n - 1);
   design.high = VectorXd::Constant(n - 1, most);
   return design;
}

/// The profile under which P presses |x| < 1 uniformly.
double uniform_profile(double x, double P, double E_star)
{
   const auto part = [](double s) { return s > 0 ? s * std::log(s) : 0.0; };
   return P / (M_PI * E_star) * (part(1 + x) + part(1 - x));
}

} // namespace

// The least peak pressure of all profiles is the uniform one, P/2a. The profile is interpolated
// and meets the closed form in the mean over each element: where that goes like s ln s, s the
// distance from the end, an error of the order of the spacing.
TEST(Design, PunchOfUniformPressureFromAFlatOne)
{
   std::vector<double> errors;
   for (int elements : {8, 16, 32})
   {
      const ReducedProblem flat = flat_pad(elements, 0.3);
      DesignProblem problem = free_profile(flat, 2);
      problem.cases = {{"pressed", LoadHistory::through(flat, {{}, {{"P", 1}}})}};
      const DesignReport report = design(problem, VectorXd::Zero(problem.low.size()));
      ASSERT_EQ(report.status, DesignStatus::optimal) << report.message;
      EXPECT_GT(report.objective_at_start, 0.6);
      EXPECT_NEAR(report.objective, 0.5, 1e-6);
      const ContactState &state = report.traces[0].states.back().state;
      for (Index i = 0; i < flat.nodes(); ++i)
      {
         EXPECT_NEAR(state.p[i] / flat.weights[i], 0.5, 1e-6) << i;
      }
      const VectorXd gap = problem.with(report.x).gap;
      double error = 0;
      for (Index i = 0; i < flat.nodes(); ++i)
      {
         error = std::max(error,
                          std::abs(gap[i] - uniform_profile(flat.position(i, 0), 1, 4 / M_PI)));
      }
      errors.push_back(error);
      // The multipliers are those of a resultant that is given: the nodes' shares of the
      // length.
      EXPECT_EQ(static_cast<Index>(report.active.size()), flat.nodes());
      for (const ActiveResponse &active : report.active)
      {
         EXPECT_NEAR(active.multiplier, flat.weights[active.index] / 2, 1e-5);
      }
   }
   EXPECT_GT(std::log2(errors[0] / errors[1]), 0.9);
   EXPECT_GT(std::log2(errors[1] / errors[2]), 0.9);
   EXPECT_LT(errors[2], 0.02 * uniform_profile(1, 1, 4 / M_PI));
}

namespace
{

/// A crown x²/2R + c x⁴ on the flat pad, for a small load that counts twice and a large one.
DesignProblem crowned_pad()
{
   const ReducedProblem flat = flat_pad(30, 0.3);
   DesignProblem problem;
   problem.problem = flat;
   const VectorXd square = flat.position.col(0).cwiseAbs2();
   MatrixXd G(flat.nodes(), 2);
   G << 0.5 * square, square.cwiseAbs2();
   problem.variables = gap_variables(G);
   problem.low = Eigen::Vector2d(0.02, 0);
   problem.high = Eigen::Vector2d(1, 1);
   for (const double P : {0.3, 1.0})
   {
      problem.cases.push_back({P < 1 ? "idle" : "full",
                               LoadHistory::through(flat, {{}, {{"P", P}}}),
                               P < 1 ? 2.0 : 1.0});
   }
   return problem;
}

/// The peak pressures of all cases, weighted, by marches alone.
VectorXd peaks(const DesignProblem &problem, const VectorXd &x)
{
   VectorXd result(problem.cases.size());
   for (std::size_t c = 0; c < problem.cases.size(); ++c)
   {
      const ReducedProblem with = problem.with(x);
      ContactState state = ContactState::virgin(with);
      march(with, problem.cases[c].history, state);
      result[static_cast<Index>(c)] =
         problem.cases[c].weight * state.p.cwiseQuotient(with.weights).maxCoeff();
   }
   return result;
}

} // namespace

// No other profile of the family is better in the worse of two cases, neither in a sweep over
// all nor nearby. Differences of marches confirm the optimality that the report states.
TEST(Design, CrownForTwoLoadsAgainstASweep)
{
   const DesignProblem problem = crowned_pad();
   const DesignReport report = design(problem, Eigen::Vector2d(0.8, 0.1));
   ASSERT_NE(report.status, DesignStatus::no_equilibrium);
   EXPECT_NEAR(peaks(problem, report.x).maxCoeff(), report.objective, 1e-9);
   EXPECT_LT(report.objective, report.objective_at_start);
   double best = 1e9;
   for (int i = 0; i <= 24; ++i)
   {
      for (int j = 0; j <= 24; ++j)
      {
         const Eigen::Vector2d x(0.02 + 0.98 * i / 24, j / 24.0);
         best = std::min(best, peaks(problem, x).maxCoeff());
      }
   }
   EXPECT_LT(report.objective, best + 1e-9);
   // The sweep is so coarse that it only comes near.
   EXPECT_GT(report.objective, 0.93 * best);
   for (const Eigen::Vector2d &step :
        {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1),
         Eigen::Vector2d(1, -1), Eigen::Vector2d(-1, 3), Eigen::Vector2d(-3, 1)})
   {
      for (const double h : {1e-2, -1e-2, 1e-4, -1e-4})
      {
         const VectorXd x = (report.x + h * step).cwiseMax(problem.low).cwiseMin(problem.high);
         EXPECT_GT(peaks(problem, x).maxCoeff(), report.objective - 1e-8) << x.transpose();
      }
   }
   EXPECT_EQ(report.status, DesignStatus::optimal)
      << report.message << report.stationarity << ' ' << report.complementarity << ' '
      << report.x.transpose() << ' ' << report.ties.size();
   // Karush, Kuhn and Tucker by differences of marches.
   double shares = 0;
   VectorXd gradient = report.bound_multipliers;
   for (const ActiveResponse &active : report.active)
   {
      shares += active.multiplier;
      EXPECT_NEAR(active.value, report.objective, 1e-5);
      const Index node = static_cast<Index>(active.index);
      for (Index j = 0; j < 2; ++j)
      {
         const auto value = [&](double h)
         {
            const ReducedProblem with = problem.with(report.x + h * VectorXd::Unit(2, j));
            ContactState state = ContactState::virgin(with);
            march(with, problem.cases[active.load_case].history, state);
            return problem.cases[active.load_case].weight * state.p[node] / with.weights[node];
         };
         gradient[j] += active.multiplier * (value(1e-6) - value(-1e-6)) / 2e-6;
      }
   }
   EXPECT_NEAR(shares, 1, 1e-5);
   EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-5);
}

// A block that Q shears to and fro loses 2 f P (Q - f P) a cycle (on a spring of stiffness 2):
// most with f P = Q/2.
TEST(Design, FrictionOfMostDamping)
{
   DesignProblem problem;
   problem.problem = cattaneo_test::one_block(0.1);
   problem.variables.resize(1);
   problem.variables[0].friction = VectorXd::Ones(1);
   problem.low = VectorXd::Zero(1);
   problem.high = VectorXd::Constant(1, 0.35);
   LoadHistory history =
      LoadHistory::through(problem.problem, {{},
                                             {{"press", 2}},
                                             {{"press", 2}, {"shear", 0.8}},
                                             {{"press", 2}, {"shear", -0.8}},
                                             {{"press", 2}, {"shear", 0.8}}});
   history.cycle_start = 2;
   history.cycles = 1;
   problem.cases = {{"cycle", history, -1, 2}};
   problem.goal = DesignGoal::least_sum;
   problem.objective = [](const Responses &of, const std::vector<std::size_t> &states)
   { return std::vector<Response>{of.dissipation(states.front(), states.back())}; };
   DesignSettings settings;
   settings.march.stepping = Stepping::exact;
   const DesignReport report = design(problem, VectorXd::Constant(1, 0.0), settings);
   EXPECT_EQ(report.status, DesignStatus::optimal) << report.message;
   EXPECT_NEAR(0.1 + report.x[0], 0.8 / 2 / 2, 1e-7);
   EXPECT_NEAR(-report.objective, 2 * 0.4 * (0.8 - 0.4), 1e-12);
   // Where that is more than is allowed the bound holds it, with the slope that is left.
   problem.high[0] = 0.05;
   const DesignReport held = design(problem, VectorXd::Constant(1, 0.0), settings);
   EXPECT_EQ(held.status, DesignStatus::optimal) << held.message;
   EXPECT_NEAR(held.x[0], 0.05, 1e-7);
   EXPECT_NEAR(held.bound_multipliers[0], 2 * 2 * (0.8 - 2 * 0.15 * 2), 1e-6);
   // The least is without friction. Bounds that let it be negative are no reason to throw away
   // what was found above.
   problem.cases[0].weight = 1;
   problem.low[0] = -1;
   const DesignReport least = design(problem, VectorXd::Constant(1, 0.05), settings);
   EXPECT_GE(0.1 + least.x[0], 0);
   EXPECT_LT(least.objective, 0.1 * least.objective_at_start) << least.message;
   expect_input_error([&] { design(problem, VectorXd::Constant(1, -0.5), settings); },
                      "negative");
}

// Under limits of curvature a profile is between the flat one and that of uniform pressure.
TEST(Design, LimitsOfCurvature)
{
   const ReducedProblem flat = flat_pad(16, 0.3);
   DesignProblem problem = free_profile(flat, 2);
   problem.cases = {{"pressed", LoadHistory::through(flat, {{}, {{"P", 1}}})}};
   const double most = 0.35;
   limit_curvature(problem, -0.1, most);
   const DesignReport report = design(problem, VectorXd::Zero(problem.low.size()));
   EXPECT_EQ(report.status, DesignStatus::optimal) << report.message;
   EXPECT_LT(report.objective, report.objective_at_start - 0.05);
   EXPECT_GT(report.objective, 0.5 + 1e-4);
   const VectorXd gap = problem.with(report.x).gap, x = flat.arc_length;
   double largest = 0;
   for (Index i = 1; i + 1 < flat.nodes(); ++i)
   {
      const double h = x[i + 1] - x[i];
      largest = std::max(largest, (gap[i + 1] - 2 * gap[i] + gap[i - 1]) / (h * h));
   }
   EXPECT_NEAR(largest, most, 1e-6);
   EXPECT_GT(report.limit_multipliers.maxCoeff(), 1e-6);
}

TEST(Design, RefusesWhatDoesNotFitAndSaysWhatHasNoEquilibrium)
{
   DesignProblem problem = crowned_pad();
   const VectorXd start = Eigen::Vector2d(0.5, 0.1);
   expect_input_error([&] { design(problem, VectorXd::Zero(3)); },
                      "the start has 3 values, must have one for each of the 2 variables");
   expect_input_error([&] { design(problem, Eigen::Vector2d(0, 0)); },
                      "variable 0 starts at 0");
   DesignProblem other = problem;
   other.high[1] = INFINITY;
   expect_input_error([&] { design(other, start); }, "variable 1 has the bounds");
   other = problem;
   other.cases.clear();
   expect_input_error([&] { design(other, start); }, "no load case");
   other = problem;
   other.cases[0].from = 9;
   expect_input_error([&] { design(other, start); }, "'idle' has no point");
   other = problem;
   other.variables[0].gap.resize(3);
   expect_input_error([&] { design(other, start); }, "variable 0 has 3 gaps");
   other = problem;
   other.cases[1].history = LoadHistory::through(
      problem.problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", 5}}}); // slides away
   const DesignReport report = design(other, start);
   EXPECT_EQ(report.status, DesignStatus::no_equilibrium);
   EXPECT_NE(report.message.find("full"), std::string::npos) << report.message;
   EXPECT_TRUE(std::isnan(report.objective) && std::isnan(report.objective_at_start));
   std::atomic<bool> stop{true};
   DesignSettings settings;
   settings.march.monitor.stop = &stop;
   const DesignReport stopped = design(problem, start, settings);
   EXPECT_EQ(stopped.status, DesignStatus::stopped);
   EXPECT_TRUE(std::isnan(stopped.objective) ||
               stopped.objective <= stopped.objective_at_start);
}

// What is not known of a design is not reported as zero.
TEST(Design, ThatDidNotEndKnowsNoConditions)
{
   const ReducedProblem flat = flat_pad(16, 0.3);
   DesignProblem problem = free_profile(flat, 2);
   problem.cases = {{"pressed", LoadHistory::through(flat, {{}, {{"P", 1}}})}};
   DesignSettings settings;
   settings.max_iterations = 1;
   const DesignReport report = design(problem, VectorXd::Zero(problem.low.size()), settings);
   EXPECT_EQ(report.status, DesignStatus::improved);
   EXPECT_NE(report.message.find("not converged after"), std::string::npos) << report.message;
   EXPECT_TRUE(std::isnan(report.stationarity) && std::isnan(report.complementarity));
   EXPECT_EQ(report.violation, 0); // there is no limit
}

// A start outside of a limit is no design to be returned, whether or not the limits can hold.
TEST(Design, StartsWhereLimitsHold)
{
   DesignProblem problem = crowned_pad();
   problem.limits = MatrixXd::Ones(1, 2);
   for (const double least : {1.5, 1000.0})
   {
      problem.least = VectorXd::Constant(1, least);
      problem.most = VectorXd::Constant(1, 2000);
      expect_input_error([&] { design(problem, Eigen::Vector2d(0.5, 0.1)); },
                         "limit 0 is 0.6 at the start, must be from");
   }
}

namespace
{

/// Flat for |x| < b, a parabola of curvature c beyond: not linear in b.
VectorXd rounded(const VectorXd &x, const VectorXd &values, MatrixXd &by)
{
   for (Index i = 0; i < x.size(); ++i)
   {
      const double beyond = std::max(0.0, std::abs(x[i]) - values[0]);
      by(i, 0) = -values[1] * beyond;
      by(i, 1) = 0.5 * beyond * beyond;
   }
   return values[1] * by.col(1);
}

DesignProblem rounded_pad()
{
   DesignProblem problem;
   problem.problem = flat_pad(32, 0.3);
   const VectorXd x = problem.problem.arc_length.array() - 1;
   problem.shape = [x](const VectorXd &values, MatrixXd &by) { return rounded(x, values, by); };
   problem.variables.resize(2);
   problem.low = VectorXd::Zero(2);
   problem.high = Eigen::Vector2d(1, 4);
   problem.cases = {{"pressed", LoadHistory::through(problem.problem, {{}, {{"P", 1}}})}};
   return problem;
}

} // namespace

// Flat and radius of a rounded punch, which the gap is not linear in: none of a grid over all
// of them presses less, nor any nearby; and there is a best one inside.
TEST(Design, FlatAndRadiusOfARoundedPunchAgainstASweep)
{
   const DesignProblem problem = rounded_pad();
   const DesignReport report = design(problem, Eigen::Vector2d(0.5, 0));
   EXPECT_EQ(report.status, DesignStatus::optimal) << report.message;
   EXPECT_GT(report.objective, 0.5); // what no profile is better than
   EXPECT_GT((report.x - problem.low).minCoeff(), 0.01);
   EXPECT_GT((problem.high - report.x).minCoeff(), 0.01);
   EXPECT_NEAR(peaks(problem, report.x)[0], report.objective, 1e-9);
   double best = 1e9;
   for (int i = 0; i <= 20; ++i)
   {
      for (int j = 0; j <= 40; ++j)
      {
         const Eigen::Vector2d x(i / 20.0, j / 10.0);
         best = std::min(best, peaks(problem, x)[0]);
      }
   }
   EXPECT_LT(report.objective, best + 1e-9);
   EXPECT_GT(report.objective, 0.97 * best); // the grid comes near
   for (int k = 0; k < 16; ++k)
   {
      for (const double h : {1e-2, 1e-4})
      {
         const Eigen::Vector2d step(std::cos(k * M_PI / 8), std::sin(k * M_PI / 8));
         EXPECT_GT(peaks(problem, report.x + h * step)[0], report.objective - 1e-8) << k;
      }
   }
}

// With derivatives that are not those of its values any design would be called optimal.
TEST(Design, RefusesAShapeWithOtherDerivatives)
{
   DesignProblem problem = rounded_pad();
   const auto good = problem.shape;
   for (const Index column : {0, 1})
   {
      problem.shape = [good, column](const VectorXd &values, MatrixXd &by)
      {
         VectorXd gap = good(values, by);
         by.col(column) *= 1.1;
         return gap;
      };
      expect_input_error([&] { design(problem, Eigen::Vector2d(0.5, 1)); },
                         "returns for variable " + std::to_string(column));
   }
   problem.shape = [](const VectorXd &, MatrixXd &) { return VectorXd(VectorXd::Zero(3)); };
   expect_input_error([&] { design(problem, Eigen::Vector2d(0.5, 1)); },
                      "`shape` returned 3 gaps");
   problem.shape = good;
   expect_input_error([&] { limit_curvature(problem, -1, 1); }, "must be linear in them");
   EXPECT_EQ(problem.with(Eigen::Vector2d(0.25, 2)).gap[0], 0.75 * 0.75);
}

// Bounds that are far away, as where there are none: a cube bends along the way into them.
TEST(Design, TakesAShapeThatBendsWithinFarBounds)
{
   DesignProblem problem = rounded_pad();
   const VectorXd x = problem.problem.arc_length.array() - 1;
   problem.high = Eigen::Vector2d(1e6, 1e6);
   for (const double factor : {1.0, 1.1})
   {
      problem.shape = [x, factor](const VectorXd &values, MatrixXd &by)
      {
         by.col(0) = factor * 3 * values[0] * values[0] * x.cwiseAbs2();
         by.col(1) = std::exp(-values[1]) * x.cwiseAbs2().cwiseAbs2();
         return VectorXd(std::pow(values[0], 3) * x.cwiseAbs2() +
                         (1 - std::exp(-values[1])) * x.cwiseAbs2().cwiseAbs2());
      };
      DesignSettings settings;
      settings.max_iterations = 1;
      const auto search = [&] { design(problem, Eigen::Vector2d(0.5, 0.5), settings); };
      if (factor == 1) { search(); }
      else { expect_input_error(search, "returns for variable 0"); }
   }
   // Where it begins level, beside what does not depend on it, a slope is still a wrong one.
   problem.shape = [x](const VectorXd &values, MatrixXd &by)
   {
      by.col(0) = 3 * values[0] * x.cwiseAbs2();
      return VectorXd(1 + values[0] * values[0] * x.array().square());
   };
   problem.low = Eigen::Vector2d(-1, -1);
   problem.high = Eigen::Vector2d(1, 1);
   expect_input_error([&] { design(problem, Eigen::Vector2d(0, 0)); },
                      "returns for variable 0");
}

// Starts are apart from one another, spread over the box, and where all limits hold; along what
// is fixed to one value none moves.
TEST(Design, StartsAreSpreadWithinBoundsAndLimits)
{
   DesignProblem problem = crowned_pad();
   problem.low = Eigen::Vector2d(-1, 2);
   problem.high = Eigen::Vector2d(3, 10);
   const Eigen::Vector2d start(0, 2.5);
   const std::vector<VectorXd> all = spread_starts(problem, start, 64);
   ASSERT_EQ(all.size(), 64u);
   int quarters[4] = {};
   for (std::size_t k = 0; k < all.size(); ++k)
   {
      ASSERT_GE((all[k] - problem.low).minCoeff(), 0);
      ASSERT_GE((problem.high - all[k]).minCoeff(), 0);
      ++quarters[(all[k][0] > 1) + 2 * (all[k][1] > 6)];
      for (std::size_t other = 0; other < k; ++other)
      {
         // 64 points that share the area alike are about 1/8 of a side apart.
         const VectorXd apart = (all[k] - all[other]).cwiseQuotient(Eigen::Vector2d(4, 8));
         EXPECT_GT(apart.norm(), 0.05);
      }
   }
   for (const int count : quarters) { EXPECT_NEAR(count, 16, 2); }
   problem.limits = MatrixXd::Ones(2, 2);
   problem.limits(0, 1) = 0;
   problem.least = Eigen::Vector2d(-0.5, -1e9);
   problem.most = Eigen::Vector2d(0.5, 6);
   for (const VectorXd &x : spread_starts(problem, start, 64))
   {
      EXPECT_LE(std::abs(x[0]), 0.5 + 1e-12);
      EXPECT_LE(x.sum(), 6 + 1e-12);
   }
   problem.least = problem.most = Eigen::Vector2d(0, 2.5); // both fixed
   EXPECT_LT((spread_starts(problem, start, 1)[0] - start).cwiseAbs().maxCoeff(), 1e-12);
   problem.limits.row(0).setOnes();
   problem.least = problem.most = Eigen::Vector2d(2.5, 2.5); // one, said twice
   double spread = 0;
   for (const VectorXd &x : spread_starts(problem, start, 8))
   {
      EXPECT_NEAR(x.sum(), 2.5, 1e-12);
      ASSERT_GE((x - problem.low).minCoeff(), 0);
      ASSERT_GE((problem.high - x).minCoeff(), 0);
      spread = std::max(spread, std::abs(x[0] - start[0]));
   }
   EXPECT_GT(spread, 0.1);
   expect_input_error([&] { spread_starts(problem, Eigen::Vector2d(0, 0), 1); },
                      "variable 1 starts at 0");
}

// From a corner of what is allowed, as where bolts are not tightened at first, straight lines
// to most places leave it at once. Of shares that add up to one each place but those above the
// corner has a nearest one elsewhere.
TEST(Design, StartsAreSpreadFromACornerToo)
{
   DesignProblem problem = crowned_pad();
   problem.variables.resize(4, problem.variables[0]);
   problem.low = VectorXd::Zero(4);
   problem.high = VectorXd::Ones(4);
   problem.limits = MatrixXd::Ones(1, 4);
   problem.least = problem.most = VectorXd::Ones(1);
   for (Index corner = 0; corner < 4; ++corner)
   {
      const VectorXd start = VectorXd::Unit(4, corner);
      const std::vector<VectorXd> all = spread_starts(problem, start, 32);
      VectorXd most = VectorXd::Zero(4);
      for (std::size_t k = 0; k < all.size(); ++k)
      {
         EXPECT_NEAR(all[k].sum(), 1, 1e-12);
         ASSERT_GE((all[k] - problem.low).minCoeff(), 0);
         ASSERT_GE((problem.high - all[k]).minCoeff(), 0);
         EXPECT_GT((all[k] - start).norm(), 1e-3) << k;
         most = most.cwiseMax(all[k]);
      }
      EXPECT_GT(most.minCoeff(), 0.4); // each of the others has much of it at times
   }
}
