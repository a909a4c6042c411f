#include "expect_input_error.hpp"
#include "small_problems.hpp"

#include <algorithm>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <cmath>
#include <random>

// Laws of friction other than Coulomb's: the bound is a polyline of the pressure, of its own
// for slip forward and backward.

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

MatrixX2d points(std::initializer_list<std::pair<double, double>> all)
{
   MatrixX2d result(all.size(), 2);
   Index k = 0;
   for (const auto &[p, bound] : all) { result.row(k++) << p, bound; }
   return result;
}

/// The block of one_block(), of weight 1, with another law.
ReducedProblem block(const FrictionLaw &law)
{
   ReducedProblem problem = cattaneo_test::one_block(0);
   problem.weights = VectorXd::Ones(1);
   set_friction_law(problem, law);
   return problem;
}

/// The polyline by hand.
double strength(const MatrixX2d &law, double p)
{
   double p0 = 0, b0 = 0, slope = 0;
   for (Index k = 0; k < law.rows(); ++k)
   {
      slope = (law(k, 1) - b0) / (law(k, 0) - p0);
      if (p <= law(k, 0)) { return b0 + slope * (p - p0); }
      p0 = law(k, 0);
      b0 = law(k, 1);
   }
   return b0 + slope * (p - p0);
}

/// A polyline that never gets steeper than before, or that may.
MatrixX2d some_law(std::mt19937 &random, double steepest, bool concave)
{
   std::uniform_real_distribution<double> u(0, 1);
   const Index count = 1 + static_cast<Index>(random() % 3);
   MatrixX2d law(count, 2);
   double p = 0, b = 0, slope = steepest;
   for (Index k = 0; k < count; ++k)
   {
      const double step = 0.1 + 0.6 * u(random);
      if (k > 0) { slope = concave ? slope * u(random) : steepest * u(random); }
      p += step;
      b += slope * step;
      law.row(k) << p, b;
   }
   return law;
}

/// Three coupled nodes, under a load, with one or two components along the contact.
ReducedProblem coupled_nodes(std::mt19937 &random, Index components)
{
   std::normal_distribution<double> normal;
   const auto some = [&](Index rows, Index cols)
   { return MatrixXd(MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); })); };
   const Index n = 3, m = components * n;
   const MatrixXd M = some(m + n, m + n),
                  K = M * M.transpose() + 2 * MatrixXd::Identity(m + n, m + n);
   ReducedProblem problem;
   problem.set_stiffness(K.topLeftCorner(m, m), K.bottomLeftCorner(n, m),
                         K.bottomRightCorner(n, n));
   problem.patterns = {{"load", Control::force, some(m, 1), some(n, 1).cwiseAbs()}};
   problem.gap = VectorXd::Zero(n);
   problem.weights = VectorXd::Ones(n);
   set_friction(problem, 1);
   return problem;
}

/// Those of the plane, with as much friction as leaves one answer, or as leaves one to each
/// node alone.
ReducedProblem some_contact(std::mt19937 &random, bool concave, bool unique = true)
{
   ReducedProblem problem = coupled_nodes(random, 1);
   const Index n = problem.nodes();
   problem.patterns[0].p[random() % n] *= -0.5;
   const CriticalFriction critical = critical_friction(problem);
   const double most = unique ? 0.9 * critical.unique_below : 0.95 * critical.node;
   problem.laws.clear();
   for (Index i = 0; i < n; ++i)
   {
      problem.laws.push_back(
         {some_law(random, most, concave), some_law(random, most, concave)});
      problem.friction[i] = problem.laws.back().steepest();
   }
   return problem;
}

/// A second load pattern, and loads of these two.
void add_load(ReducedProblem &problem, std::mt19937 &random)
{
   std::normal_distribution<double> normal;
   LoadPattern second = problem.patterns[0];
   second.name = "second";
   for (double &q : second.q.reshaped()) { q = 1.5 * normal(random); }
   for (double &p : second.p.reshaped()) { p = 0.7 * normal(random); }
   problem.patterns.push_back(second);
}
VectorXd some_loads(std::mt19937 &random)
{
   std::normal_distribution<double> normal;
   VectorXd loads(2);
   loads << 0.3 + std::abs(normal(random)), normal(random);
   return loads;
}

/// All answers of one increment from these slips, by trying what each node may do, piece by
/// piece.
std::vector<VectorXd> answers(const ReducedProblem &problem, const VectorXd &loads,
                              const VectorXd &old)
{
   const Index n = problem.nodes();
   const VectorXd f = problem.clamped_forces(loads);
   // 0: open, 1: sticks, then pieces forward, then pieces backward.
   std::vector<Index> counts, now(n, 0);
   for (const FrictionLaw &law : problem.laws)
   {
      counts.push_back(2 + law.forward.rows() + law.backward.rows());
   }
   std::vector<VectorXd> found;
   while (true)
   {
      MatrixXd M = MatrixXd::Identity(2 * n, 2 * n);
      VectorXd r = VectorXd::Zero(2 * n);
      for (Index i = 0; i < n; ++i)
      {
         const Index t = i, m = n + i;
         if (now[i] == 0)
         {
            M.row(t) = problem.K.row(t);
            M.row(m) = problem.K.row(m);
            r[t] = -f[t];
            r[m] = -f[m];
         }
         if (now[i] == 1) { r[t] = old[i]; }
         if (now[i] < 2) { continue; }
         const Index forward = problem.laws[i].forward.rows();
         const bool back = now[i] - 2 >= forward;
         const MatrixX2d &law = back ? problem.laws[i].backward : problem.laws[i].forward;
         const Index k = now[i] - 2 - (back ? forward : 0);
         const double p0 = k ? law(k - 1, 0) : 0, b0 = k ? law(k - 1, 1) : 0,
                      slope = (law(k, 1) - b0) / (law(k, 0) - p0), way = back ? -1 : 1;
         M.row(t) = problem.K.row(t) + way * slope * problem.K.row(m);
         r[t] = -f[t] - way * slope * f[m] - way * (b0 - slope * p0);
      }
      const VectorXd u = M.fullPivLu().solve(r), F = problem.K * u + f;
      bool obeys = true;
      for (Index i = 0; i < n; ++i)
      {
         const double q = F[i], p = F[n + i], tiny = 1e-9;
         const FrictionLaw &law = problem.laws[i];
         if (now[i] == 0)
         {
            obeys = obeys && u[n + i] >= -tiny;
            continue;
         }
         obeys = obeys && p >= -tiny && q >= -strength(law.forward, p) - tiny &&
                 q <= strength(law.backward, p) + tiny;
         if (now[i] < 2) { continue; }
         const bool back = now[i] - 2 >= law.forward.rows();
         obeys = obeys && (back ? -1 : 1) * (u[i] - old[i]) >= -tiny &&
                 std::abs(q + (back ? -strength(law.backward, p) : strength(law.forward, p))) <=
                    tiny;
      }
      if (obeys) { found.push_back(u); }
      Index k = 0;
      while (k < n && ++now[k] == counts[k]) { now[k++] = 0; }
      if (k == n) { return found; }
   }
}

/// Slips, and forces along the contact, as they are seen in a mirror.
ReducedProblem mirrored(ReducedProblem problem)
{
   const Index n = problem.nodes();
   VectorXd sign = VectorXd::Ones(2 * n);
   sign.head(n).setConstant(-1);
   problem.K = (sign.asDiagonal() * problem.K * sign.asDiagonal()).eval();
   for (LoadPattern &pattern : problem.patterns) { pattern.q *= -1; }
   for (FrictionLaw &law : problem.laws) { std::swap(law.forward, law.backward); }
   return problem;
}

} // namespace

// Bounds 0.6 forward and 1 backward under P = 2, on a spring of 2: from Q = 1.5 to -1.5 and
// back the block slips by 0.7 each way.
TEST(FrictionLaw, OneForwardAndAnotherBackwardByHand)
{
   const ReducedProblem problem = block({points({{1, 0.3}}), points({{1, 0.5}})});
   EXPECT_EQ(problem.friction[0], 0.5);
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      ContactState state = ContactState::virgin(problem);
      const auto go = [&](double from, double to, double v, double q)
      {
         const LoadHistory history = LoadHistory::through(
            problem, {{{"press", 2}, {"shear", from}}, {{"press", 2}, {"shear", to}}});
         const double before = state.dissipation;
         state.time = 0;
         const MarchReport report = march(problem, history, state, settings);
         EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
         EXPECT_EQ(report.fallbacks, 0);
         EXPECT_NEAR(state.v[0], v, 1e-12);
         EXPECT_NEAR(state.q[0], q, 1e-12);
         return state.dissipation - before;
      };
      march(problem, LoadHistory::through(problem, {{}, {{"press", 2}}}), state, settings);
      EXPECT_NEAR(go(0, 1.5, -0.25, 1), 1 * 0.25, 1e-10);
      EXPECT_NEAR(go(1.5, -1.5, 0.45, -0.6), 0.6 * 0.7, 1e-10);
      EXPECT_NEAR(go(-1.5, 1.5, -0.25, 1), 1 * 0.7, 1e-10);
   }
}

// A block that slips bears what the law allows it at its pressure, whichever piece that is.
TEST(FrictionLaw, BendsWithPressureByHand)
{
   const MatrixX2d law = points({{1, 0.6}, {3, 1}, {4, 1}});
   const ReducedProblem problem = block({law, law});
   for (const auto &[p, bound] :
        {std::pair(0.5, 0.3), {1.0, 0.6}, {2.0, 0.8}, {3.5, 1.0}, {10.0, 1.0}})
   {
      for (const double way : {-1.0, 1.0})
      {
         ContactState state = ContactState::virgin(problem);
         FrictionSolver solver(problem);
         ASSERT_EQ(solver.solve(state, Eigen::Vector2d(p, -2 * way)).status,
                   FrictionStatus::converged);
         EXPECT_NEAR(state.q[0], -way * bound, 1e-12) << p;
         EXPECT_NEAR(state.v[0], way * (2 - bound) / 2, 1e-12) << p;
         // It sticks below.
         state = ContactState::virgin(problem);
         solver.solve(state, Eigen::Vector2d(p, -way * 0.999 * bound));
         EXPECT_EQ(state.status[0], NodeState::stick) << p;
         EXPECT_NEAR(state.v[0], 0, 1e-12);
      }
   }
   // Pressed by 4 and sheared by 0.9 it sticks; unloaded to 0.5 it slips from p = 2.5 on, with
   // q = b(p) = 0.9 + 2 v: ∫ b |dv| = (0.9² - 0.3²)/4.
   MarchSettings settings;
   settings.increments = 400;
   settings.stepping = Stepping::fixed;
   ContactState state = ContactState::virgin(problem);
   const LoadHistory history = LoadHistory::through(
      problem,
      {{}, {{"press", 4}}, {{"press", 4}, {"shear", 0.9}}, {{"press", 0.5}, {"shear", 0.9}}});
   ASSERT_EQ(march(problem, history, state, settings).status, FrictionStatus::converged);
   EXPECT_NEAR(state.v[0], -0.3, 1e-12);
   EXPECT_NEAR(state.dissipation, 0.18, 1e-4);
   settings.stepping = Stepping::exact;
   state = ContactState::virgin(problem);
   const MarchReport exact = march(problem, history, state, settings);
   EXPECT_EQ(exact.fallbacks, 0) << exact.fallback_reason;
   EXPECT_NEAR(state.v[0], -0.3, 1e-12);
   EXPECT_NEAR(state.dissipation, 0.18, 1e-12); // bends are met exactly
}

/// With one answer to each increment the path is that to which ever smaller increments come,
/// and its work is what the loads put in, whatever bends the pressures pass on their way.
TEST(FrictionLaw, BendsAreEventsOfThePath)
{
   int passed = 0, marched = 0;
   for (unsigned seed = 1; seed <= 60; ++seed)
   {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      ReducedProblem problem = some_contact(random, seed % 3 > 0);
      add_load(problem, random);
      problem.H = MatrixXd::Zero(2, 2);
      std::vector<VectorXd> loads{VectorXd::Zero(2)};
      for (int k = 0; k < 4; ++k) { loads.push_back(some_loads(random)); }
      const LoadHistory history = LoadHistory::through(loads);
      MarchSettings settings;
      settings.every_event = true;
      ContactState path = ContactState::virgin(problem), before = path;
      const MarchReport report = march(
         problem, history, path, settings,
         [&](const ContactState &now, const IncrementRecord &)
         {
            for (Index i = 0; i < 3; ++i)
            {
               const FrictionLaw &law = problem.laws[i];
               const double p = std::max(now.p[i], 0.0), tiny = 1e-11 * now.peak_force;
               EXPECT_GE(now.q[i], -strength(law.forward, p) - tiny);
               EXPECT_LE(now.q[i], strength(law.backward, p) + tiny);
               // No pressure passes a bend within a step.
               for (const MatrixX2d *of : {&law.forward, &law.backward})
               {
                  for (Index k = 0; k + 1 < of->rows(); ++k)
                  {
                     const double bend = (*of)(k, 0), far = 1e-9 * now.peak_force;
                     const bool below = before.p[i]<bend - far, above = before.p[i]> bend + far;
                     EXPECT_FALSE(below && now.p[i] > bend + far && closed(now.status[i]));
                     EXPECT_FALSE(above && now.p[i] < bend - far && closed(now.status[i]));
                     passed += closed(now.status[i]) && std::abs(now.p[i] - bend) < far;
                  }
               }
            }
            before = now;
         });
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.fallbacks, 0) << report.fallback_reason;
      EXPECT_LT(std::abs(report.energy_imbalance), 1e-11);
      ++marched;
      if (seed > 20) { continue; } // ten thousands of increments
      double error[2];
      for (const int fine : {0, 1})
      {
         MarchSettings fixed;
         fixed.stepping = Stepping::fixed;
         fixed.increments = fine ? 500 : 50;
         ContactState state = ContactState::virgin(problem);
         march(problem, history, state, fixed);
         error[fine] = (state.v - path.v).cwiseAbs().maxCoeff();
      }
      EXPECT_LT(error[1], 0.3 * error[0] + 1e-9);
   }
   EXPECT_EQ(marched, 60);
   EXPECT_GT(passed, 100);
}

// A law that gets steeper lets a block slip at first and holds it later, also when all loads
// grow in proportion: one increment is not exact, and none is skipped. Shear 0.4 p meets the
// bound 0.2 p up to p = 1, so that q = -0.2 and 2 v = 0.2 there; beyond, where the bound grows
// by more than the shear, the block stays.
TEST(FrictionLaw, BentByPressureIsNoSingleIncrement)
{
   const MatrixX2d law = points({{1, 0.2}, {2, 1.2}});
   const ReducedProblem problem = block({law, law});
   const LoadHistory history =
      LoadHistory::through(problem, {{}, {{"press", 2}, {"shear", 0.8}}});
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      ContactState state = ContactState::virgin(problem);
      ASSERT_EQ(march(problem, history, state, settings).status, FrictionStatus::converged);
      EXPECT_NEAR(state.v[0], -0.1, 1e-12);
      EXPECT_EQ(state.status[0], NodeState::stick);
   }
}

// Weights that round do not: a point on the line of its neighbours changes nothing of a law,
// and the steepest slope is that of the law as it is kept, of forces.
TEST(FrictionLaw, RoundingOfItsPointsMakesNoOther)
{
   std::mt19937 random(11);
   std::uniform_real_distribution<double> u(0.1, 0.9);
   for (int k = 0; k < 500; ++k)
   {
      const double p0 = u(random), p1 = p0 + u(random), between = p0 + u(random) * (p1 - p0);
      const double slope = u(random), flatter = u(random) * slope;
      const auto bound = [&](double p) { return slope * p0 + flatter * (p - p0); };
      const FrictionLaw law{
         points({{p0, bound(p0)}, {between, bound(between)}, {p1, bound(p1)}}),
         points({{1, 1}})};
      EXPECT_TRUE(law.concave());
      FrictionLaw bent = law;
      bent.forward(1, 1) -= 1e-6 * slope * (p1 - p0);
      EXPECT_FALSE(bent.concave());
      ReducedProblem problem = block(FrictionLaw{points({{1, 1}}), points({{1, 1}})});
      problem.weights[0] = u(random);
      set_friction_law(problem, FrictionLaw{points({{100, 10}, {100.001, 60}}), law.forward});
      problem.validate();
      EXPECT_NEAR(problem.friction[0], 5e4, 1e-3);
   }
}

// Where all that three nodes may do is tried there is one answer, and it is the solver's, by
// each method.
TEST(FrictionLaw, AgainstAllThatNodesMayDo)
{
   int slipping = 0, bent = 0;
   for (unsigned seed = 1; seed <= 150; ++seed)
   {
      std::mt19937 random(seed);
      const bool concave = seed % 3 > 0;
      const ReducedProblem problem = some_contact(random, concave);
      const double load = seed % 2 ? 1.0 : 0.3;
      const std::vector<VectorXd> all =
         answers(problem, VectorXd::Constant(1, load), VectorXd::Zero(3));
      ASSERT_GE(all.size(), 1u) << seed;
      for (const VectorXd &u : all) { ASSERT_LT((u - all[0]).norm(), 1e-7) << seed; }
      for (const FrictionMethod method :
           {FrictionMethod::automatic, FrictionMethod::gauss_seidel})
      {
         FrictionSettings settings;
         settings.method = method;
         FrictionSolver solver(problem, settings);
         ContactState state = ContactState::virgin(problem);
         const IncrementReport report = solver.solve(state, VectorXd::Constant(1, load));
         ASSERT_EQ(report.status, FrictionStatus::converged) << seed << report.message;
         ASSERT_LT((state.displacements() - all[0]).norm(), 1e-7) << seed;
         for (Index i = 0; i < 3; ++i)
         {
            slipping += slips(state.status[i]);
            const MatrixX2d &law =
               state.q[i] > 0 ? problem.laws[i].backward : problem.laws[i].forward;
            bent += slips(state.status[i]) && state.p[i] > law(0, 0) && law.rows() > 1;
         }
      }
   }
   EXPECT_GT(slipping, 100); // the nodes do what is to be tested
   EXPECT_GT(bent, 30);
}

/// Increments with exactly one answer by trying all, each of which must be the solver's, and
/// the others.
struct Tried
{
   int single = 0, others = 0;
   long pivots = 0; ///< of the solvers
};
/// The loads of 700 contacts change at once, three times.
Tried large_increments(bool unique, const FrictionSettings &settings = {})
{
   Tried tried;
   for (unsigned seed = 1; seed <= 700; ++seed)
   {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      ReducedProblem problem = some_contact(random, seed % 3 > 0, unique);
      add_load(problem, random);
      FrictionSolver solver(problem, settings);
      ContactState state = ContactState::virgin(problem);
      for (int k = 0; k < 3; ++k)
      {
         const VectorXd loads = some_loads(random);
         const std::vector<VectorXd> all = answers(problem, loads, state.v);
         const bool one = !all.empty() && std::all_of(all.begin(), all.end(),
                                                      [&](const VectorXd &u)
                                                      { return (u - all[0]).norm() < 1e-7; });
         const IncrementReport report = solver.solve(state, loads);
         ++(one ? tried.single : tried.others);
         if (!one) { continue; }
         EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
         EXPECT_LT((state.displacements() - all[0]).norm(), 1e-7);
      }
      tried.pivots += solver.counters().pivots;
   }
   return tried;
}

// The pieces of the laws at the start are seldom those at the end, of which there is exactly
// one.
TEST(FrictionLaw, LargeIncrementsAgainstAllThatNodesMayDo)
{
   const Tried tried = large_increments(true);
   EXPECT_EQ(tried.single, 2100);
}

// The same by Lemke's method, to which the end of a piece is an exchange; Newton's step only
// checks what it found.
TEST(FrictionLaw, LemkeAloneAgainstAllThatNodesMayDo)
{
   FrictionSettings lemke_alone;
   lemke_alone.sweeps = 0;
   lemke_alone.max_newton = 1;
   const Tried tried = large_increments(true, lemke_alone);
   EXPECT_EQ(tried.single, 2100);
   EXPECT_GT(tried.pivots, 5000);
}

// With more friction bodies jump, and another set of pieces than that of the start may be the
// only one with an answer.
TEST(FrictionLaw, JumpsAgainstAllThatNodesMayDo)
{
   const Tried tried = large_increments(false);
   EXPECT_GT(tried.single, 1500);
   EXPECT_GT(tried.others, 10);
}

// A march in a mirror has the mirrored states, to the last bit; and a law of one point is
// Coulomb's.
TEST(FrictionLaw, MirrorsAndIsCoulombsOfOnePoint)
{
   for (unsigned seed = 1; seed <= 20; ++seed)
   {
      std::mt19937 random(seed);
      const ReducedProblem problem = some_contact(random, true), other = mirrored(problem);
      const auto marched = [](const ReducedProblem &of)
      {
         ContactState state = ContactState::virgin(of);
         const MarchReport report = march(
            of, LoadHistory::through(of, {{}, {{"load", 1}}, {{"load", 0.2}}, {{"load", 0.9}}}),
            state);
         EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
         EXPECT_LT(report.energy_imbalance, 0.02);
         return state;
      };
      const ContactState here = marched(problem), there = marched(other);
      EXPECT_LT((here.v + there.v).cwiseAbs().maxCoeff(), 1e-11) << seed;
      EXPECT_LT((here.q + there.q).cwiseAbs().maxCoeff(), 1e-11) << seed;
      EXPECT_LT((here.w - there.w).cwiseAbs().maxCoeff(), 1e-11) << seed;
      EXPECT_NEAR(here.dissipation, there.dissipation, 1e-11) << seed;
      ReducedProblem coulomb = problem, said = problem;
      set_friction(coulomb, 0.25);
      set_friction_law(said, points({{2, 0.5}}));
      const ContactState one = marched(coulomb), two = marched(said);
      EXPECT_EQ(one.v, two.v);
      EXPECT_EQ(one.q, two.q);
      EXPECT_EQ(one.dissipation, two.dissipation);
   }
}

// Two nodes of a body that only friction keeps from sliding, each under the pressure 1: they
// hold 7/15 each, and not more.
TEST(FrictionLaw, ABodySlidesBeyondWhatTheLawHolds)
{
   ReducedProblem problem;
   Eigen::Matrix2d A;
   A << 2, -2, -2, 2;
   problem.set_stiffness(A, Eigen::Matrix2d::Zero(), 3 * Eigen::Matrix2d::Identity());
   ASSERT_EQ(problem.rigid_motions.cols(), 1);
   const Eigen::Vector2d none(0, 0), both(1, 1);
   problem.patterns = {{"P", Control::force, none, both}, {"Q", Control::force, both, none}};
   problem.gap = none;
   problem.weights = both;
   const MatrixX2d law = points({{0.5, 0.4}, {2, 0.6}});
   set_friction_law(problem, law);
   for (const double way : {-1.0, 1.0})
   {
      ContactState state = ContactState::virgin(problem);
      FrictionSolver solver(problem);
      EXPECT_EQ(solver.solve(state, Eigen::Vector2d(1, way * 0.4666)).status,
                FrictionStatus::converged);
      EXPECT_EQ(solver.solve(state, Eigen::Vector2d(1, way * 0.4668)).status,
                FrictionStatus::gross_sliding);
      state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem, LoadHistory::through(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", way}}}),
               state);
      EXPECT_EQ(report.status, FrictionStatus::gross_sliding) << report.message;
      EXPECT_NEAR(report.event_multipliers[1], way * 7 / 15, 1e-7);
   }
   // One way it holds less.
   set_friction_law(problem, FrictionLaw{law, points({{1, 0.1}})});
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   EXPECT_EQ(solver.solve(state, Eigen::Vector2d(1, 0.11)).status,
             FrictionStatus::gross_sliding);
   EXPECT_EQ(solver.solve(state, Eigen::Vector2d(1, -0.46)).status, FrictionStatus::converged);
}

// Two free bodies in contact at one node under P = 2: forward, q < 0, they hold 0.5 + 0.1·2,
// and backward 0.2 + 0.3·2. A force Q pushes forward where the clamped node would need q = -Q.
TEST(FrictionLaw, FreeBodiesAreHeldByTheWayTheyWouldSlip)
{
   ReducedProblem problem;
   problem.set_stiffness(MatrixXd::Zero(1, 1), MatrixXd::Zero(1, 1), MatrixXd::Zero(1, 1));
   problem.rigid_motions = Eigen::Matrix2d::Identity();
   problem.patterns = {{"load", Control::force, VectorXd::Zero(1), VectorXd::Zero(1)}};
   problem.gap = VectorXd::Zero(1);
   problem.weights = VectorXd::Ones(1);
   const FrictionLaw law{points({{1, 0.6}, {2, 0.7}}), points({{1, 0.5}, {2, 0.8}})};
   set_friction_law(problem, law);
   const std::vector<FrictionBound> pieces{FrictionBound(law).straight(2)};
   for (const double push : {0.69, 0.71, 0.79, 0.81, -0.69, -0.71, -0.79, -0.81})
   {
      SCOPED_TRACE(push);
      const Mechanism found = find_mechanism(problem, pieces, Eigen::Vector2d(-push, 2), 1e-12);
      EXPECT_EQ(found.exists, push > 0.7 || push < -0.8);
      if (!found.exists) { continue; }
      EXPECT_TRUE(found.slides);
      EXPECT_LT(push * found.motion[0], 0); // clamped forces do work along it
   }
}

// A node on a spring of stiffness 1 whose slip of 1 changes its pressure by 1/2: critical is a
// friction of 2. The law has a slope of 10 up to the pressure 0.1, and 1/2 beyond.
TEST(FrictionLaw, IsCriticalByItsSlopeAtThePressure)
{
   ReducedProblem problem = block({points({{1, 0.5}}), points({{1, 0.5}})});
   problem.set_stiffness(MatrixXd::Ones(1, 1), MatrixXd::Constant(1, 1, 0.5),
                         MatrixXd::Constant(1, 1, 3));
   const MatrixX2d law = points({{0.1, 1}, {1.1, 1.5}});
   set_friction_law(problem, law);
   EXPECT_DOUBLE_EQ(critical_friction(problem).node, 2);
   for (const auto &[press, status] : {std::pair(0.05, FrictionStatus::not_unique),
                                       std::pair(2.0, FrictionStatus::converged)})
   {
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      const IncrementReport report = solver.solve(state, Eigen::Vector2d(press, 0));
      EXPECT_EQ(report.status, status) << press << report.message;
      EXPECT_EQ(solver.judge(ContactState::virgin(problem), state).status, status) << press;
   }
}

// With torsion the same law holds in all directions: a node on springs alike slips along its
// load, with the force that the law has.
TEST(FrictionLaw, HoldsInAllDirectionsWithTorsion)
{
   ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix2d::Identity(), MatrixXd::Zero(1, 2),
                         MatrixXd::Constant(1, 1, 3.0));
   problem.patterns = {{"P", Control::force, VectorXd::Zero(2), VectorXd::Ones(1)},
                       {"T", Control::force, Eigen::Vector2d(0.6, -0.8), VectorXd::Zero(1)}};
   problem.gap = VectorXd::Zero(1);
   problem.weights = VectorXd::Constant(1, 2);
   set_friction_law(problem, points({{0.5, 0.3}, {1.5, 0.5}, {2, 0.5}})); // of tractions
   for (const auto &[p, bound] : {std::pair(0.5, 0.3), {2.0, 0.8}, {3.5, 1.0}, {10.0, 1.0}})
   {
      ContactState state = ContactState::virgin(problem);
      FrictionSolver solver(problem);
      ASSERT_EQ(solver.solve(state, Eigen::Vector2d(p, 2)).status, FrictionStatus::converged);
      EXPECT_NEAR(state.q[0], 0.6 * bound, 1e-10) << p;
      EXPECT_NEAR(state.q[1], -0.8 * bound, 1e-10) << p;
      EXPECT_NEAR(state.v[0], -0.6 * (2 - bound) / 2, 1e-10) << p;
   }
   expect_input_error(
      [&] {
         set_friction_law(problem, FrictionLaw{points({{1, 0.3}}), points({{1, 0.4}})});
      },
      "must be the same for both with two tangents");
}

// Random coupled nodes with torsion whose laws get steeper too, so that a piece's straight line
// lies below zero elsewhere: forces in equilibrium, within the bound, at it against the slip.
TEST(FrictionLaw, WithTorsionNodesSlipAgainstWhatTheLawHolds)
{
   int slipping = 0;
   for (unsigned seed = 0; seed < 200; ++seed)
   {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      ReducedProblem problem = coupled_nodes(random, 2);
      const Index n = problem.nodes();
      const CriticalFriction critical = critical_friction(problem);
      const double most = 0.9 * std::min(critical.unique_below, critical.node);
      std::vector<MatrixX2d> laws;
      for (Index i = 0; i < n; ++i)
      {
         laws.push_back(some_law(random, most, false));
         laws.back().col(1).array() -= 0.8 * laws.back()(0, 1);
         set_friction_law(problem, laws.back(), {i});
      }
      add_load(problem, random);
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      for (int k = 0; k < 3; ++k)
      {
         const VectorXd loads = some_loads(random), old = state.v;
         const IncrementReport report = solver.solve(state, loads);
         ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
         const VectorXd u = state.displacements(),
                        F = problem.K * u + problem.clamped_forces(loads);
         // Forces and slips are of the size of one and solved to some twelve digits of it.
         const double tiny = 1e-9;
         for (Index i = 0; i < n; ++i)
         {
            const double p = F[2 * n + i], gap = u[2 * n + i];
            const Eigen::Vector2d q(F[i], F[n + i]), slip(u[i] - old[i], u[n + i] - old[n + i]);
            EXPECT_GT(std::min(p, gap), -tiny);
            EXPECT_LT(std::abs(p * gap), tiny);
            const double bound = p > 0 ? strength(laws[i], p) : 0;
            EXPECT_LT(q.norm(), bound + tiny);
            if (gap > tiny) { continue; }
            EXPECT_LT((slip.norm() * q + bound * slip).norm(), tiny);
            slipping += slip.norm() > 1e-3;
         }
      }
   }
   EXPECT_GT(slipping, 100);
}

// Files keep the laws, and who does not know of them cannot read these; all that knows
// Coulomb's law alone says so.
TEST(FrictionLaw, IsSavedAndRefusedWhereItIsNotKnown)
{
   std::mt19937 random(7);
   const ReducedProblem problem = some_contact(random, true);
   const std::string file = testing::TempDir() + "laws.json";
   save(problem, file);
   const ReducedProblem again = load_reduced_problem(file);
   ASSERT_EQ(again.laws.size(), 3u);
   for (std::size_t i = 0; i < 3; ++i)
   {
      EXPECT_EQ(again.laws[i].forward, problem.laws[i].forward);
      EXPECT_EQ(again.laws[i].backward, problem.laws[i].backward);
   }
   ReducedProblem other = problem;
   set_friction(other, 0.1);
   EXPECT_TRUE(other.laws.empty());
   other = problem;
   other.friction.setConstant(0.1);
   expect_input_error([&] { other.validate(); }, "has the steepest slope");
   other = problem;
   other.laws.pop_back();
   expect_input_error([&] { other.validate(); }, "2 laws of friction for 3 nodes");
   other = problem;
   for (const auto &[law, words] :
        {std::pair(points({{1, 0.3}, {1, 0.4}}), "the pressure must increase"),
         {points({{1, 0.3}, {2, 0.2}}), "the pressure must increase"},
         {points({{0, 0.1}}), "the pressure must increase"},
         {points({}), "must have at least one point"}})
   {
      expect_input_error([&, of = law] { set_friction_law(other, of); }, words);
   }
   other.weights.resize(0);
   expect_input_error([&] { set_friction_law(other, points({{1, 0.3}})); }, "no weights");
   const LoadHistory history = LoadHistory::through(problem, {{}, {{"load", 1}}});
   expect_input_error([&] { worn_out(problem, history, ContactState::virgin(problem)); },
                      "wear supports Coulomb's law only");
}

// A state is of the problem that it was solved in, and of no other of its size; one before any
// load has no forces, whatever slip it begins with.
TEST(ContactStates, AreOfTheProblemTheyWereSolvedIn)
{
   const ReducedProblem problem = cattaneo_test::four_springs();
   ReducedProblem other = problem;
   other.K *= 2;
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(1, 1)).status, FrictionStatus::converged);
   state.require_of(problem);
   expect_input_error([&] { state.require_of(other); }, "another reduced problem");
   ContactState::with_slip(problem, Eigen::Vector4d(0.1, 0, -0.2, 0)).require_of(problem);
   ContactState::virgin(problem).require_of(other);
   // Loads that change places are others, and no node is to be blamed for it.
   ReducedProblem turned = problem;
   std::swap(turned.patterns[0], turned.patterns[1]);
   const std::string file = ::testing::TempDir() + "contact_states.json";
   save(state, file);
   const ContactState saved = load_contact_state(file);
   EXPECT_EQ(saved.loads, problem.load_names());
   saved.require_of(problem);
   expect_input_error([&] { saved.require_of(turned); },
                      "contact state: its loads are " + problem.patterns[0].name + ", " +
                         problem.patterns[1].name +
                         ", must be those of the reduced problem in the same order: " +
                         problem.patterns[1].name + ", " + problem.patterns[0].name);
}
