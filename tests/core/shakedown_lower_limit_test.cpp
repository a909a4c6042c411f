#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

namespace
{

using namespace cattaneo;
using namespace shakedown_test;

/** Slip of a closed contact in the last of @a cycles cycles, by small implicit steps: at each,
    node after node, q beyond ±f p is brought back to it by its own slip. Independent of the
    library; good for moderate friction. Returns -1 if a node separates. */
double slip_in_the_last_cycle(const ReducedProblem &problem, const LoadCycle &cycle,
                              double load_factor, Eigen::VectorXd v, int cycles)
{
   const Eigen::Index n = problem.nodes();
   const int steps = 10;
   double last = 0;
   const auto hold = [&](const Eigen::VectorXd &multipliers)
   {
      const Eigen::VectorXd clamped = problem.clamped_forces(multipliers);
      const Eigen::VectorXd before = v;
      for (int sweep = 0; sweep < 2000; ++sweep)
      {
         double change = 0;
         for (Eigen::Index i = 0; i < n; ++i)
         {
            const double f = problem.friction[i];
            const double q = clamped[i] + problem.A().row(i).dot(v);
            const double p = clamped[n + i] + problem.B().row(i).dot(v);
            double step = 0;
            if (q > f * p)
            {
               step = -(q - f * p) / (problem.A()(i, i) - f * problem.B()(i, i));
            }
            else if (q < -f * p)
            {
               step = -(q + f * p) / (problem.A()(i, i) + f * problem.B()(i, i));
            }
            v[i] += step;
            change = std::max(change, std::abs(step));
         }
         if (change < 1e-15) { break; }
      }
      last += (v - before).cwiseAbs().sum();
      const Eigen::VectorXd p = clamped.tail(n) + problem.B() * v;
      return p.minCoeff() > -1e-12;
   };
   for (int k = 0; k < cycles; ++k)
   {
      last = 0;
      for (Eigen::Index j = 0; j < cycle.vertices(); ++j)
      {
         const Eigen::VectorXd from = cycle.multipliers(load_factor).col(j);
         const Eigen::VectorXd to =
            cycle.multipliers(load_factor).col((j + 1) % cycle.vertices());
         for (int s = 1; s <= steps; ++s)
         {
            if (!hold(from + (to - from) * s / steps)) { return -1; }
         }
      }
      if (last < 1e-13) { break; }
   }
   return last;
}

/** Node 1 feels the slip of node 0 in its pressure, node 0 does not feel node 1: whether every
    start shakes down can be said by hand. Node 0 ends anywhere in |a v0| ≤ f P - λ r; node 1
    then sticks if f (P + b v0) ≥ λ s. So λ1 is decided by the lowest v0, λ2 by the highest. */
ReducedProblem chain(double a, double b, double r, double s)
{
   ReducedProblem problem;
   problem.set_stiffness(a * Eigen::Matrix2d::Identity(), Eigen::Matrix2d{{0, 0}, {b, 0}},
                         a * Eigen::Matrix2d::Identity());
   problem.patterns = {{"P", Control::force, Eigen::Vector2d::Zero(), Eigen::Vector2d(1, 1)},
                       {"Q", Control::force, Eigen::Vector2d(r, s), Eigen::Vector2d::Zero()}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector2d::Zero();
   set_friction(problem, 0.5);
   return problem;
}

TEST(LowerLimit, OfAChainOfTwoNodesByHand)
{
   const double a = 2, b = 0.8, r = 0.3, s = 1, f = 0.5;
   const ReducedProblem problem = chain(a, b, r, s);
   const LimitProblem limit = limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
   const LimitReport upper = load_limit(limit);
   // f (1 ± b (f - λ r) / a) = λ s
   EXPECT_NEAR(upper.limit, f * (1 + b * f / a) / (s + f * b * r / a), 1e-8);
   const LowerLimitReport lower = lower_limit(limit, upper);
   EXPECT_EQ(lower.kind, LowerLimitKind::two_nodes);
   EXPECT_NEAR(lower.value, f * (1 - b * f / a) / (s - f * b * r / a), 1e-12);
}

TEST(LowerLimit, OfTwoUnlikeNodesByHandInAnyOrderAndSense)
{
   // As above with unlike nodes and a load between λ and R λ. Node 0 ends anywhere in
   // -f0 P0 - R λ r ≤ a0 v0 ≤ f0 P0 - λ r; node 1 sticks somewhere if half its range of shear,
   // λ s (1 - R)/2, is within f1 (P1 + b v0).
   const double a0 = 2, a1 = 3, r = 0.3, s = 1, f0 = 0.4, f1 = 0.5, P0 = 1.2, P1 = 0.9,
                R = -0.6;
   for (const double b : {0.8, -0.8})
   {
      const double half = s * (1 - R) / 2, c = f1 * b / a0;
      const double at_low = (f1 * P1 - c * f0 * P0) / (half + c * R * r),
                   at_high = (f1 * P1 + c * f0 * P0) / (half + c * r);
      const double expected = b > 0 ? at_low : at_high, best = b > 0 ? at_high : at_low;
      const double v0 = (b > 0 ? -f0 * P0 - R * expected * r : f0 * P0 - expected * r) / a0,
                   v1 = -expected * s * (1 + R) / 2 / a1;
      for (const int first : {0, 1})
      {
         for (const double sense : {1.0, -1.0})
         {
            const int second = 1 - first;
            ReducedProblem problem = chain(1, 0, 0, 0);
            problem.A().setZero();
            problem.B().setZero();
            problem.A()(first, first) = a0;
            problem.A()(second, second) = a1;
            problem.B()(second, first) = sense * b;
            complete(problem);
            problem.patterns[0].p[first] = P0;
            problem.patterns[0].p[second] = P1;
            problem.patterns[1].q[first] = sense * r;
            problem.patterns[1].q[second] = sense * s;
            problem.friction[first] = f0;
            problem.friction[second] = f1;
            const LimitProblem limit =
               limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", R));
            const LimitReport upper = load_limit(limit);
            ASSERT_EQ(upper.status, LimitStatus::certified) << upper.message;
            EXPECT_NEAR(upper.limit, best, 1e-7);
            const LowerLimitReport lower = lower_limit(limit, upper);
            ASSERT_EQ(lower.kind, LowerLimitKind::two_nodes);
            EXPECT_NEAR(lower.value, expected, 1e-12);
            EXPECT_NEAR(lower.slip[first], sense * v0, 1e-12);
            EXPECT_NEAR(lower.slip[second], sense * v1, 1e-12);
         }
      }
   }
}

TEST(LowerLimit, OfOneNodeThatPressesItselfByHand)
{
   // q = ±λ + a v, p = P + b v. The best slip is none: λ2 = f P. With M = b/a and h = P ∓ M λ
   // the lowest pressure at ±λ is h/(1 + f M), that with q = -f p; a slip between both keeps
   // |q*| ≤ f p_low up to λ = f P/(1 + f M), at a v = -f P f M/(1 + f M)².
   const double a = 2, P = 1.5, f = 0.5;
   for (const double b : {1.0, -1.0, 3.0})
   {
      ReducedProblem problem;
      problem.set_stiffness(Eigen::MatrixXd::Constant(1, 1, a),
                            Eigen::MatrixXd::Constant(1, 1, b),
                            Eigen::MatrixXd::Constant(1, 1, 10));
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1), one = Eigen::VectorXd::Ones(1);
      problem.patterns = {{"P", Control::force, zero, one}, {"Q", Control::force, one, zero}};
      problem.H = Eigen::MatrixXd::Zero(2, 2);
      problem.gap = zero;
      set_friction(problem, f);
      const LimitProblem limit =
         limit_problem(problem, held_and_cycled(problem, "P", P, "Q", -1));
      EXPECT_NEAR(limit.coupling, std::abs(b) / std::sqrt(10 * a), 1e-14);
      const LimitReport upper = load_limit(limit);
      ASSERT_EQ(upper.status, LimitStatus::certified) << upper.message;
      EXPECT_EQ(upper.coupling, limit.coupling);
      EXPECT_NEAR(upper.limit, f * P, 1e-6);
      const LowerLimitReport lower = lower_limit(limit, upper);
      ASSERT_EQ(lower.kind, LowerLimitKind::bound) << lower.message;
      const double M = std::abs(b) / a;
      EXPECT_NEAR(lower.value, f * P / (1 + f * M), 1e-6);
      EXPECT_LE(lower.value, f * P / (1 + f * M) + 1e-14);
      EXPECT_NEAR(a * lower.slip[0], (b > 0 ? -1 : 1) * f * P * f * M / std::pow(1 + f * M, 2),
                  1e-5);
   }
}

TEST(LowerLimit, HasNothingToSayWithoutAnUpperOne)
{
   ReducedProblem problem = chain(2, 0.8, 0.3, 1);
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", -1, "Q", -1));
   const LimitReport upper = load_limit(limit);
   ASSERT_EQ(upper.status, LimitStatus::no_solution);
   const LowerLimitReport lower = lower_limit(limit, upper);
   EXPECT_EQ(lower.kind, LowerLimitKind::none);
   EXPECT_EQ(lower.status, LimitStatus::no_solution);
   EXPECT_EQ(lower.value, 0);
   EXPECT_NE(lower.message.find(upper.message), std::string::npos) << lower.message;
}

TEST(LowerLimit, OfTwoNodesAgreesWithMarches)
{
   // Random coupled pairs: below λ1 every start shakes down; half-way to λ2 some start does
   // not, and some does.
   std::mt19937 random(11);
   int pairs = 0;
   for (unsigned seed = 100; seed < 160 && pairs < 8; ++seed)
   {
      ReducedProblem problem = random_contact(seed, 2, 1, false);
      for (LoadPattern &pattern : problem.patterns) { pattern.p = pattern.p.cwiseAbs(); }
      problem.patterns[1].p.setZero();
      const LoadCycle cycle = held_and_cycled(problem, "press", 1, "shear", -0.7);
      const LimitProblem limit = limit_problem(problem, cycle);
      const LimitReport upper = load_limit(limit);
      ASSERT_EQ(upper.status, LimitStatus::certified) << upper.message;
      const LowerLimitReport lower = lower_limit(limit, upper);
      ASSERT_EQ(lower.kind, LowerLimitKind::two_nodes);
      EXPECT_LE(lower.value, upper.limit);
      // The theory is for a rate problem with one solution.
      if ((problem.friction.asDiagonal() * problem.B().cwiseAbs() *
           problem.A().diagonal().cwiseInverse().asDiagonal())
             .maxCoeff() > 0.5)
      {
         continue;
      }
      if (lower.value < 0.05 * upper.limit || lower.value > 0.9 * upper.limit) { continue; }
      ++pairs;
      const double just_above = lower.value + 0.1 * (upper.limit - lower.value);
      int closed_below = 0, cyclic = 0, shaken = 0;
      for (int k = 0; k < 100; ++k)
      {
         const Eigen::VectorXd start = 2 * random_matrix(random, 2, 1);
         const double below =
            slip_in_the_last_cycle(problem, cycle, 0.98 * lower.value, start, 3000);
         closed_below += below >= 0;
         EXPECT_LT(below, 1e-9) << seed << ' ' << start.transpose();
         // Around the critical corner, where starts that cycle are first found.
         const double above =
            slip_in_the_last_cycle(problem, cycle, just_above, lower.slip + 0.5 * start, 500);
         cyclic += above > 1e-4;
         shaken += above >= 0 && above < 1e-9;
      }
      EXPECT_GT(closed_below, 20) << seed;
      EXPECT_GT(cyclic, 0) << seed << ' ' << lower.value << ' ' << upper.limit;
      EXPECT_GT(shaken, 0) << seed;
   }
   EXPECT_EQ(pairs, 8);
}

TEST(LowerLimit, NodesSetApartOfAChainByHand)
{
   // The chain, and a third node that nothing concerns. p at node 1 is 1 + 0.4 (residual shear
   // of node 0), at least 1 - 0.4 (0.5 + q of node 0) = 0.8 ∓ 0.12 λ at Q = ±λ; node 1 then
   // needs λ ± r ≤ 0.4 ∓ 0.06 λ with one r: λ = 0.4. Node 0 alone needs 0.3 λ ≤ 0.5, which is
   // more than the upper limit, 0.6/1.06.
   ReducedProblem problem;
   Eigen::Matrix3d A = 2 * Eigen::Matrix3d::Identity(), B = Eigen::Matrix3d::Zero();
   B(1, 0) = 0.8;
   problem.set_stiffness(A, B, A);
   problem.patterns = {
      {"P", Control::force, Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 1, 1)},
      {"Q", Control::force, Eigen::Vector3d(0.3, 1, 0), Eigen::Vector3d::Zero()}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector3d::Zero();
   set_friction(problem, 0.5);
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", -1);
   const LimitProblem limit = limit_problem(problem, cycle);
   const LimitReport upper = load_limit(limit);
   EXPECT_NEAR(upper.limit, 0.6 / 1.06, 1e-7);
   const auto apart = [&](const NodeList &nodes)
   { return lower_limit(limit, upper, {}, nodes); };
   EXPECT_EQ(apart({}).kind, LowerLimitKind::bound);
   for (const NodeList &nodes : {NodeList{}, {0}, {2}, {0, 2}})
   {
      EXPECT_NEAR(apart(nodes).value, 0.4, 1e-7) << nodes.size();
   }
   for (const NodeList &nodes : {NodeList{1}, {1, 2}, {0, 1}})
   {
      const LowerLimitReport report = apart(nodes);
      EXPECT_EQ(report.kind, LowerLimitKind::apart);
      EXPECT_NEAR(report.value, 0.6 / 1.06, 1e-7) << nodes.size();
      EXPECT_NE(report.message.find("exempt node"), std::string::npos);
   }
   // Between the two node 1 does slip for ever, from the lowest v0, and without any other.
   EXPECT_GT(slip_in_the_last_cycle(problem, cycle, 0.5, Eigen::Vector3d(-1, 0, 0), 200), 1e-3);
   EXPECT_LT(slip_in_the_last_cycle(problem, cycle, 0.39, Eigen::Vector3d(-1, 0, 0), 200),
             1e-12);
   EXPECT_THROW(apart({3}), InputError);
}

TEST(LowerLimit, BoundHoldsInMarches)
{
   for (const unsigned seed : {1u, 2u, 3u, 4u})
   {
      ReducedProblem problem = random_contact(seed, 5, 1, seed % 2 == 0);
      problem.set_stiffness(problem.A(), 0.2 * problem.B(), problem.C());
      const LoadCycle cycle = held_and_cycled(problem, "press", 1, "shear", -0.7);
      const LimitProblem limit = limit_problem(problem, cycle);
      const LimitReport upper = load_limit(limit);
      const LowerLimitReport lower = lower_limit(limit, upper);
      ASSERT_EQ(lower.kind, LowerLimitKind::bound) << lower.message;
      EXPECT_GT(lower.value, 0);
      EXPECT_LE(lower.value, upper.limit);
      std::mt19937 random(seed);
      for (int k = 0; k < 20; ++k)
      {
         const double last = slip_in_the_last_cycle(problem, cycle, 0.99 * lower.value,
                                                    random_matrix(random, 5, 1), 2000);
         EXPECT_LT(std::abs(last), 1e-9) << seed;
      }
   }
}

TEST(LowerLimit, LeastPressureIsThatOfTheWorstState)
{
   // The pressures of all admissible states: extreme where every node is about to slip, in one
   // of the two senses.
   const int n = 6;
   for (const unsigned seed : {3u, 4u, 5u})
   {
      ReducedProblem problem = random_contact(seed, n, 1, false);
      problem.set_stiffness(problem.A(), 0.3 * problem.B(), problem.C());
      const ResidualForces residual = residual_forces(problem);
      const Eigen::VectorXd load = Eigen::VectorXd::Ones(n);
      const LeastPressure least = least_pressure(problem, residual, load);
      ASSERT_TRUE(least.exists);
      const Eigen::MatrixXd &M = residual.transfer;
      std::mt19937 random(seed);
      const Eigen::VectorXd shear = 0.1 * random_matrix(random, n, 1);
      const Eigen::VectorXd h = load - M * shear;
      Eigen::VectorXd lowest = Eigen::VectorXd::Constant(n, 1e9);
      for (int senses = 0; senses < (1 << n); ++senses)
      {
         Eigen::MatrixXd slipping = Eigen::MatrixXd::Identity(n, n);
         for (int k = 0; k < n; ++k)
         {
            const double sign = senses & (1 << k) ? 1 : -1;
            slipping.col(k) -= sign * problem.friction[k] * M.col(k);
         }
         const Eigen::VectorXd p = slipping.partialPivLu().solve(h);
         ASSERT_GT(p.minCoeff(), 0);
         lowest = lowest.cwiseMin(p);
      }
      const Eigen::VectorXd bound = least.by_normal * load + least.by_shear * shear;
      EXPECT_LT((bound - lowest).cwiseAbs().maxCoeff(), 1e-11) << seed;
   }
}

TEST(LowerLimit, LeastPressureHoldsForFreeBodiesAndDiscs)
{
   for (const int components : {1, 2})
   {
      const int n = 6;
      ReducedProblem problem = random_contact(7, n, components, true);
      problem.set_stiffness(problem.A(), 0.3 * problem.B(), problem.C());
      const ResidualForces residual = residual_forces(problem);
      const Eigen::VectorXd load = Eigen::VectorXd::Ones(n);
      const LeastPressure least = least_pressure(problem, residual, load);
      ASSERT_TRUE(least.exists);
      std::mt19937 random(8);
      const Eigen::VectorXd shear = 0.05 * random_matrix(random, components * n, 1);
      const Eigen::VectorXd bound = least.by_normal * load + least.by_shear * shear;
      int admissible = 0;
      double nearest = 1e9;
      for (int k = 0; k < 20000; ++k)
      {
         const Eigen::VectorXd slip =
            residual.flexibility * (0.4 * random_matrix(random, components * n, 1));
         const Eigen::VectorXd q = shear + problem.A() * slip, p = load + problem.B() * slip;
         bool inside = p.minCoeff() > 0;
         for (int i = 0; i < n; ++i)
         {
            const double size = components == 1 ? std::abs(q[i]) : std::hypot(q[i], q[n + i]);
            inside = inside && size <= problem.friction[i] * p[i];
         }
         if (!inside) { continue; }
         admissible++;
         nearest = std::min(nearest, (p - bound).minCoeff());
      }
      EXPECT_GT(admissible, 20);
      EXPECT_GE(nearest, 0);
   }
}

TEST(LowerLimit, OfAnUncoupledContactIsTheUpper)
{
   const ReducedProblem problem = punch_like(33, 0);
   const LimitProblem limit =
      limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5));
   const LimitReport upper = load_limit(limit);
   const LowerLimitReport lower = lower_limit(limit, upper);
   EXPECT_EQ(lower.kind, LowerLimitKind::uncoupled);
   EXPECT_EQ(lower.value, upper.limit);
   std::mt19937 random(5);
   EXPECT_LT(slip_in_the_last_cycle(problem, limit.cycle, 0.9 * upper.limit,
                                    0.2 * random_matrix(random, 33, 1), 300),
             1e-9);
}

/** Three nodes of A = 1, of which the first two press each other by their slip, the third is by
    itself. With h = 1 - b λ, what P = 1 and Q = λ leave at a node whose neighbour carries no
    shear, the lowest pressure of an admissible state is that of both slipping:
    p0 = h - f b p1, p1 = h + f b p0, so p0 = h (1 - f b)/(1 + (f b)²). */
ReducedProblem mutual(double b, bool feedback)
{
   ReducedProblem problem;
   const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
   problem.set_stiffness(I, Eigen::Matrix3d{{0, feedback ? b : 0, 0}, {b, 0, 0}, {0, 0, 0}},
                         10 * I); // semidefinite, and no slip feels it
   const Eigen::Vector3d one = Eigen::Vector3d::Ones(), zero = Eigen::Vector3d::Zero();
   problem.patterns = {{"P", Control::force, zero, one}, {"Q", Control::force, one, zero}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = zero;
   set_friction(problem, 0.5);
   return problem;
}

TEST(LowerLimit, SaysWhenItKnowsNothing)
{
   const auto find = [](const ReducedProblem &problem)
   {
      const LimitProblem limit =
         limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -1));
      const LimitReport upper = load_limit(limit);
      // What is not known is not for want of an upper limit: node 2 slips for ever at f P.
      EXPECT_NEAR(upper.limit, 0.5, 1e-6) << upper.message;
      return lower_limit(limit, upper);
   };
   // f b = 0.9. At Q = ±λ a slip v must keep ±λ + v within f (1 ∓ b λ) 0.1/1.81: half the sum
   // of both is λ <= f 0.1/1.81.
   const LowerLimitReport known = find(mutual(1.8, true));
   EXPECT_EQ(known.kind, LowerLimitKind::bound) << known.message;
   EXPECT_NEAR(known.value, 0.5 * 0.1 / 1.81, 1e-7);
   // f b = 1.1: an admissible slip empties a node, and slips of both feed on each other.
   const LowerLimitReport mutually = find(mutual(2.2, true));
   EXPECT_EQ(mutually.kind, LowerLimitKind::none) << mutually.value;
   EXPECT_EQ(mutually.value, 0);
   EXPECT_NE(mutually.message.find("the product of coupling and friction is too large"),
             std::string::npos)
      << mutually.message;
   // Only node 1 feels node 0: 1 - f b = -0.1 of its pressure may be left.
   const LowerLimitReport emptied = find(mutual(2.2, false));
   EXPECT_EQ(emptied.kind, LowerLimitKind::none) << emptied.value;
   EXPECT_EQ(emptied.value, 0);
   EXPECT_NE(emptied.message.find("all pressure from node 1"), std::string::npos)
      << emptied.message;
}

} // namespace
