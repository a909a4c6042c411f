#include "differentiated_march.hpp"
#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "random_problem.hpp"
#include "small_problems.hpp"

#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>
#include <complex>

using namespace cattaneo;
using cattaneo_test::by_differences;
using cattaneo_test::Differentiated;
using cattaneo_test::directions;
using cattaneo_test::MarchCase;
using cattaneo_test::random_case;
using cattaneo_test::random_problem;
using cattaneo_test::Read;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

using Complex = std::complex<long double>;
using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1>;
using ComplexMatrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic>;

/// The march again in extended precision, its states being known, with a parameter that has an
/// imaginary part: derivatives without a difference. Returns the slip at its end and the energy
/// lost.
std::pair<ComplexVector, Complex> complex_march(const MarchCase &c, const MarchTrace &trace,
                                                const Parameters &by)
{
   const Index n = c.problem.nodes();
   const Complex h(0, 1e-30L);
   const auto moved = [&](const auto &x, const auto &change)
   {
      ComplexMatrix result = x.template cast<Complex>();
      if (change.size()) { result += h * change.template cast<Complex>(); }
      return result;
   };
   const ComplexMatrix f = moved(c.problem.friction, by.friction),
                       g = moved(c.problem.gap, by.gap),
                       loads = moved(c.history.multipliers, by.multipliers);
   ComplexMatrix K = c.problem.K.cast<Complex>();
   if (by.stiffness.size()) { K *= Complex(1) + h * Complex(by.stiffness[0]); }
   ComplexVector v = ComplexVector::Zero(n), p = v, q = v;
   Complex lost = 0;
   for (std::size_t k = 1; k < trace.states.size(); ++k)
   {
      const TracedState &at = trace.states[k];
      const Complex share(at.share);
      ComplexVector b = ComplexVector::Zero(2 * n);
      for (Index j = 0; j < 2; ++j)
      {
         const Complex load =
            loads(j, at.point) + share * (loads(j, at.point + 1) - loads(j, at.point));
         b.head(n) += load * c.problem.patterns[j].q.cast<Complex>();
         b.tail(n) += load * c.problem.patterns[j].p.cast<Complex>();
      }
      ComplexMatrix M = ComplexMatrix::Identity(2 * n, 2 * n);
      ComplexVector rhs(2 * n);
      for (Index i = 0; i < n; ++i)
      {
         const NodeState state = at.state.status[i];
         const Complex slope = Complex(sense(state)) * f(i, 0);
         if (state == NodeState::stick) { rhs[i] = v[i]; }
         else
         {
            M.row(i) = K.row(i) + slope * K.row(n + i);
            rhs[i] = -b[i] - slope * b[n + i];
         }
         if (closed(state)) { rhs[n + i] = -g(i, 0); }
         else
         {
            M.row(n + i) = K.row(n + i);
            rhs[n + i] = -b[n + i];
         }
      }
      const ComplexVector u = M.partialPivLu().solve(rhs), F = b + K * u;
      for (Index i = 0; i < n; ++i)
      {
         // What stuck, or turns, sticks first while forces change linearly: friction is
         // exhausted at the share s of the increment where q0 + s dq = -way f (p0 + s dp).
         Complex step = u[i] - v[i];
         if (step.real() == 0) { continue; }
         const Complex way(step.real() > 0 ? 1 : -1),
            dq = F[i] - K(i, i) * step - q[i], dp = F[n + i] - p[i],
            start = -(q[i] + way * f(i, 0) * p[i]) / (dq + way * f(i, 0) * dp),
            p_from = p[i] + start * dp;
         if (step.real() < 0) { step = -step; }
         lost += Complex(0.5L) * f(i, 0) * (p_from + F[n + i]) * step;
      }
      v = u.head(n);
      q = F.head(n);
      p = F.tail(n);
   }
   return {v, lost};
}

} // namespace

// By another formulation, in extended precision and without differences: to round-off.
TEST(Sensitivity, AgreesWithComplexStepsInExtendedPrecision)
{
   bool turned = false;
   for (int seed = 1; seed <= 10; ++seed)
   {
      Differentiated at(random_case(seed, Stepping::fixed, seed % 3 + 1));
      const Responses of(at.c.problem, at.trace);
      const std::size_t last = at.trace.last();
      for (const Parameters &direction : directions(at.c, seed))
      {
         const auto [v, lost] = complex_march(at.c, at.trace, direction);
         const Response dissipation = of.dissipation(0, last);
         ASSERT_NEAR(static_cast<double>(lost.real()), dissipation.value,
                     1e-11 * dissipation.value);
         const double expected = static_cast<double>(lost.imag() / 1e-30L);
         EXPECT_NEAR(at.sensitivity.gradient(dissipation).by.dot(direction), expected,
                     1e-11 * std::max(std::abs(expected), dissipation.value));
         for (Index i = 0; i < 8; ++i)
         {
            const double slipped = static_cast<double>(v[i].imag() / 1e-30L);
            EXPECT_NEAR(at.sensitivity.gradient(of.slip(last, i)).by.dot(direction), slipped,
                        1e-11 * std::max(1.0, std::abs(slipped)));
         }
      }
      for (std::size_t k = 1; k <= last; ++k)
      {
         for (Index i = 0; i < 8; ++i)
         {
            turned = turned || sense(at.trace.states[k - 1].state.status[i]) *
                                     sense(at.trace.states[k].state.status[i]) <
                                  0;
         }
      }
   }
   EXPECT_TRUE(turned); // within an increment, by what was asked
}

// Sheared just to where it slips, a block has two derivatives: zero if Q falls, -1/2 if it
// rises. Both are had, and the tie has a name.
TEST(Sensitivity, TiesAreNamedAndHaveTwoSides)
{
   const ReducedProblem problem = cattaneo_test::one_block(0.5);
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"press", 1}}, {{"press", 1}, {"shear", 0.5}}});
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   MarchTrace trace = trace_march(problem, history, settings);
   const std::vector<Tie> tied = ties(problem, trace);
   ASSERT_EQ(tied.size(), 1u);
   EXPECT_EQ(tied[0].state, trace.last());
   EXPECT_EQ(tied[0].node, 0);
   const auto derivative = [&]
   {
      return Sensitivity(problem, trace)
         .gradient(Responses(problem, trace).slip(trace.last(), 0))
         .by.multipliers(1, 2);
   };
   const double one = derivative();
   trace.states.back().state.status[0] = tied[0].other;
   const double other = derivative();
   EXPECT_NEAR(std::max(one, other), 0, 1e-14);
   EXPECT_NEAR(std::min(one, other), -0.5, 1e-14);
   EXPECT_TRUE(ties(cattaneo_test::one_block(0.6), trace).size() <= 1);
}

// A block that touches at rest and is dragged while it is pressed: with a little more gap it is
// free until it closes, and slides less. The exact path has another derivative on either side.
TEST(Sensitivity, ANodeThatTouchesAtRestIsTiedWhereThePathIsFollowed)
{
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   const auto marched = [&](double gap)
   {
      ReducedProblem problem = cattaneo_test::one_block(0.3);
      problem.patterns[0].q[0] = 0.2;
      problem.gap[0] = gap;
      const LoadHistory history = LoadHistory::through(
         problem,
         {{}, {{"press", 1}}, {{"press", 1}, {"shear", 1}}, {{"press", 1}, {"shear", -1}}});
      return std::pair{problem, trace_march(problem, history, settings)};
   };
   const auto loss = [&](double gap)
   {
      const auto [problem, trace] = marched(gap);
      return Responses(problem, trace).dissipation(0, trace.last()).value;
   };
   const double h = 1e-6, right = (loss(h) - loss(0)) / h, left = (loss(0) - loss(-h)) / h;
   ASSERT_GT(std::abs(right - left), 1e-3);
   const auto [problem, trace] = marched(0);
   const std::vector<Tie> tied = ties(problem, trace);
   ASSERT_FALSE(tied.empty());
   EXPECT_EQ(tied[0].state, 0u);
   EXPECT_EQ(tied[0].node, 0);
   const auto [apart, later] = marched(0.01);
   EXPECT_TRUE(ties(apart, later).empty());
}

// The same block in a disc slips, without forward and backward.
TEST(Sensitivity, TiesOfTwoTangentialComponentsAreOfStickAndSlip)
{
   const ReducedProblem problem = cattaneo_test::as_disc(cattaneo_test::one_block(0.5));
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"press", 1}}, {{"press", 1}, {"shear", 0.5}}});
   MarchSettings settings;
   settings.stepping = Stepping::fixed;
   MarchTrace trace = trace_march(problem, history, settings);
   for (NodeState taken : {NodeState::stick, NodeState::slip})
   {
      trace.states.back().state.status[0] = taken;
      const std::vector<Tie> tied = ties(problem, trace);
      ASSERT_EQ(tied.size(), 1u);
      EXPECT_EQ(tied[0].taken, taken);
      EXPECT_EQ(tied[0].other, taken == NodeState::stick ? NodeState::slip : NodeState::stick);
   }
}

// Without friction nothing is to be known of where a body slides to, but all of its pressures.
TEST(Sensitivity, SlidingBodyWithoutFriction)
{
   std::mt19937 random(3);
   ReducedProblem problem = random_problem(6, 0, 0, random);
   const VectorXd along = VectorXd::Ones(6) / std::sqrt(6.0);
   const MatrixXd keep = MatrixXd::Identity(6, 6) - along * along.transpose();
   MatrixXd motion = MatrixXd::Zero(12, 1);
   motion.topRows(6) = along;
   problem.set_stiffness(keep * MatrixXd(problem.A()) * keep, MatrixXd::Zero(6, 6),
                         MatrixXd(problem.C()), motion);
   for (LoadPattern &pattern : problem.patterns) { pattern.q = (keep * pattern.q).eval(); }
   problem.patterns[1].q += along;
   MarchCase c{problem, LoadHistory::through(problem, {{}, {{"press", 1}}}), {}};
   Differentiated at(c);
   const Responses of(at.c.problem, at.trace);
   const Gradient pressed = at.sensitivity.gradient(of.normal_force(at.trace.last(), 2));
   ASSERT_TRUE(pressed.found) << pressed.message;
   for (const Parameters &direction : directions(at.c, 1))
   {
      if (direction.friction.size() || direction.multipliers.size()) { continue; }
      const double expected = by_differences(
         at.c, direction,
         [](const Responses &read, const MarchTrace &trace)
         { return read.normal_force(trace.last(), 2); },
         1e-6);
      Parameters without = pressed.by;
      without.friction.resize(0);
      without.multipliers.resize(0, 0);
      EXPECT_NEAR(without.dot(direction), expected, 1e-7);
   }
   EXPECT_TRUE(std::isnan(pressed.by.friction[0]));
   EXPECT_TRUE(std::isnan(pressed.by.multipliers(1, 1)));
   EXPECT_NEAR(pressed.by.multipliers(0, 1),
               by_differences(
                  at.c,
                  [&]
                  {
                     Parameters more;
                     more.multipliers = MatrixXd::Zero(2, 2);
                     more.multipliers(0, 1) = 1;
                     return more;
                  }(),
                  [](const Responses &read, const MarchTrace &trace)
                  { return read.normal_force(trace.last(), 2); },
                  1e-6),
               1e-7);
   EXPECT_FALSE(at.sensitivity.gradient(of.slip(at.trace.last(), 2)).found);
   EXPECT_TRUE(
      at.sensitivity.gradient(of.slip(at.trace.last(), 2) - of.slip(at.trace.last(), 3)).found);
}

// A body that touches at one node may turn about it: what that does not matter to is known all
// the same, and of the rest it is said.
TEST(Sensitivity, BodyThatTouchesAtOneNode)
{
   std::mt19937 random(5);
   ReducedProblem problem = random_problem(3, 0.3, 0, random);
   const Eigen::Vector3d turn = Eigen::Vector3d(-1, 0, 1) / std::sqrt(2.0);
   const Eigen::Matrix3d keep = Eigen::Matrix3d::Identity() - turn * turn.transpose();
   MatrixXd motion = MatrixXd::Zero(6, 1);
   motion.bottomRows(3) = turn;
   problem.set_stiffness(MatrixXd(problem.A()), MatrixXd::Zero(3, 3),
                         keep * MatrixXd(problem.C()) * keep, motion);
   problem.gap = Eigen::Vector3d(9, 0, 9);
   for (LoadPattern &pattern : problem.patterns)
   {
      pattern.p =
         pattern.name == "press" ? Eigen::Vector3d(0.2, 1, 0.2) : Eigen::Vector3d(0, 0, 0);
   }
   const MarchCase c{problem, LoadHistory::through(problem, {{}, {{"press", 1}}}), {}};
   MarchTrace trace = trace_march(problem, c.history, c.settings);
   // It may lean on another node without a force; here it stands upright.
   const std::size_t last = trace.last();
   ContactState &state = trace.states[last].state;
   state.w[0] = state.w[2] = 0.5 * (state.w[0] + state.w[2]);
   state.status = {NodeState::separation, state.status[1], NodeState::separation};
   Sensitivity sensitivity(problem, trace);
   const Responses of(problem, trace);
   const Read force = [](const Responses &read, const MarchTrace &march)
   { return read.normal_force(march.last(), 1) + read.slip(march.last(), 0); };
   const Gradient pressed = sensitivity.gradient(force(of, trace));
   ASSERT_TRUE(pressed.found) << pressed.message;
   for (const Parameters &direction : directions(c, 2))
   {
      if (direction.stiffness.size()) { continue; }
      EXPECT_NEAR(pressed.by.dot(direction), by_differences(c, direction, force, 1e-6), 1e-7);
   }
   const Gradient outside = sensitivity.gradient(of.opening(last, 0));
   EXPECT_FALSE(outside.found);
   EXPECT_NE(outside.message.find("free"), std::string::npos) << outside.message;
   EXPECT_TRUE(sensitivity.gradient(of.opening(last, 0) + of.opening(last, 2)).found);
}

TEST(Sensitivity, DerivativesTimesChangesAreSummedOverAllParameters)
{
   Parameters by, change;
   by.friction = Eigen::Vector2d(1, 2);
   by.gap = Eigen::Vector2d(3, 4);
   by.multipliers = Eigen::Matrix2d{{5, 6}, {7, 8}};
   by.stiffness = Eigen::Vector3d(9, 10, 11);
   EXPECT_EQ(by.dot(change), 0);
   change.friction = Eigen::Vector2d(10, 1);
   change.multipliers = Eigen::Matrix2d{{1, 0}, {0, -1}};
   change.stiffness = Eigen::Vector3d(0, 2, 1);
   change.wear = Eigen::Vector2d(100, 100); // of which no derivative is given
   EXPECT_EQ(by.dot(change), (10 + 2) + (5 - 8) + (20 + 11));
   change.stiffness = Eigen::Vector2d(1, 1);
   expect_input_error(
      [&] { by.dot(change); },
      "parameters: stiffness is 3 × 1 in one and 2 × 1 in the other, must be equal");
}

// A response of another march has states of the same sizes, and derivatives that mean nothing.
TEST(Sensitivity, ResponsesAreOfTheirOwnMarch)
{
   const MarchCase one = random_case(1, Stepping::fixed);
   MarchCase two = one;
   two.problem.gap *= 2;
   const MarchTrace mine = trace_march(one.problem, one.history, one.settings),
                    theirs = trace_march(two.problem, two.history, two.settings), copy = mine;
   ASSERT_EQ(mine.states.size(), theirs.states.size());
   const Response own = Responses(one.problem, copy).peak_pressure(mine.last()),
                  other = Responses(two.problem, theirs).peak_pressure(theirs.last());
   Sensitivity sensitivity(one.problem, mine);
   EXPECT_TRUE(sensitivity.gradient(own).found);
   expect_input_error([&] { sensitivity.gradient(other); }, "belongs to another trace");
   expect_input_error([&] { sensitivity.gradient(2 * (other * other)); },
                      "belongs to another trace");
   expect_input_error([&] { own + other; }, "belong to different traces");
   Parameters change;
   change.gap = VectorXd::Ones(one.problem.nodes());
   const TraceChange along = sensitivity.along(change);
   EXPECT_TRUE(std::isfinite(along.of(own)));
   expect_input_error([&] { along.of(other); }, "belongs to another trace");
}
