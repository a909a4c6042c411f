#include "half_space_contacts.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

namespace
{

using namespace cattaneo;
using namespace shakedown_test;

/// n nodes without coupling, each its own spring, under pressure p and shear q at λ = 1.
ReducedProblem springs(const Eigen::VectorXd &p, const Eigen::VectorXd &q)
{
   const Eigen::Index n = p.size();
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n),
                         Eigen::MatrixXd::Identity(n, n));
   problem.patterns = {{"P", Control::force, Eigen::VectorXd::Zero(n), p},
                       {"Q", Control::force, q, Eigen::VectorXd::Zero(n)}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::VectorXd::Zero(n);
   set_friction(problem, 0.5);
   return problem;
}

TEST(LoadLimit, IsThatOfTheWeakestSpring)
{
   // Each node alone: a slip centres the shear, so that 2 f p = λ (1 - R) q.
   const ReducedProblem problem = springs(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 3, 2));
   const LimitReport report =
      load_limit(limit_problem(problem, held_and_cycled(problem, "P", 2, "Q", -0.5)));
   EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   const double expected = 2 * 0.5 * (2 * 2) / (1.5 * 3);
   EXPECT_LE(report.lower, expected * (1 + 1e-14));
   EXPECT_GE(report.upper, expected * (1 - 1e-14));
   EXPECT_NEAR(report.limit, expected, 1e-8);
   EXPECT_LE(report.violation, 0);
   EXPECT_EQ(report.counters.limit_solves, 1);
}

/// What a limit does not say is in its report: for whom it holds, and for which starts.
TEST(LoadLimit, SaysOfWhichStartsItSpeaks)
{
   const auto says = [](const LimitReport &report, const std::string &words)
   {
      std::string all;
      for (const std::string &sentence : report.statement()) { all += sentence + "\n"; }
      EXPECT_NE(all.find(words), std::string::npos) << words << " in\n" << all;
   };
   const ReducedProblem alone = springs(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 3, 2));
   const LimitReport uncoupled =
      load_limit(limit_problem(alone, held_and_cycled(alone, "P", 2, "Q", -0.5)));
   EXPECT_FALSE(uncoupled.coupled);
   EXPECT_EQ(uncoupled.every_start, uncoupled.limit);
   says(uncoupled, "all nodes of the contact stay closed");
   says(uncoupled, "every start shakes down below the limit");
   EXPECT_EQ(uncoupled.of_the_mesh, "");
   // Node 1 feels the slip of node 0, the third node neither: λ1 is proven to be 0.4 at least
   // (see the lower limit's test of this chain).
   ReducedProblem chain;
   chain.set_stiffness(2 * Eigen::Matrix3d::Identity(),
                       Eigen::Matrix3d{{0, 0, 0}, {0.8, 0, 0}, {0, 0, 0}},
                       2 * Eigen::Matrix3d::Identity());
   chain.patterns = {
      {"P", Control::force, Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 1, 1)},
      {"Q", Control::force, Eigen::Vector3d(0.3, 1, 0), Eigen::Vector3d::Zero()}};
   chain.H = Eigen::Matrix2d::Zero();
   chain.gap = Eigen::Vector3d::Zero();
   set_friction(chain, 0.5);
   const LimitProblem limit = limit_problem(chain, held_and_cycled(chain, "P", 1, "Q", -1));
   const LimitReport unasked = load_limit(limit);
   EXPECT_TRUE(unasked.coupled);
   EXPECT_TRUE(std::isnan(unasked.every_start));
   EXPECT_EQ(unasked.counters.limit_solves, 1);
   says(unasked, "below the limit some start shakes down, but not every start has to");
   says(unasked, "was not computed: call lower_limit()");
   LimitSettings settings;
   settings.every_start = true;
   const LimitReport asked = load_limit(limit, settings);
   EXPECT_NEAR(asked.every_start, 0.4, 1e-7);
   EXPECT_LT(asked.every_start, asked.limit);
   says(asked, "is at least 0.4");
   const LimitReport friction = friction_limit(limit, 0.3);
   says(friction, "with more friction some start shakes down");
   // Nothing is said of a limit that is not there.
   EXPECT_TRUE(LimitReport().statement().empty());
}

TEST(LoadLimit, IsGrossSlidingForAFreeBodyUnderSteadyShear)
{
   // R = 1: any distribution of the shear is within reach, until all nodes slide: λ ΣQ = Σ f P.
   for (const unsigned seed : {1u, 2u, 3u})
   {
      ReducedProblem problem = random_contact(seed, 6, 1, true);
      problem.patterns[1].p.setZero();
      set_friction(problem, 0.2);
      const LimitReport report =
         load_limit(limit_problem(problem, held_and_cycled(problem, "press", 1, "shear", 1)));
      // The pattern's own shear has a resultant here.
      const double expected =
         (0.2 * problem.patterns[0].p.sum() - problem.patterns[0].q.sum()) /
         problem.patterns[1].q.sum();
      ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
      EXPECT_NEAR(report.limit, expected, 1e-6 * expected) << seed;
   }
}

TEST(LoadLimit, EqualsBruteForce)
{
   for (unsigned seed = 0; seed < 12; ++seed)
   {
      const Eigen::Index n = 2 + seed % 2;
      const bool rigid = seed % 4 >= 2;
      const ReducedProblem problem = random_contact(seed, n, 1, rigid);
      const LoadCycle cycle = random_cycle(seed, 3, 2 + seed % 3);
      const LimitProblem limit = limit_problem(problem, cycle);
      EXPECT_EQ(limit.residual.rigid.cols(), rigid ? 1 : 0);
      const double expected = brute_force_load(problem, cycle);
      const LimitReport report = load_limit(limit);
      ASSERT_EQ(report.status, LimitStatus::certified) << seed << ": " << report.message;
      EXPECT_NEAR(report.limit, expected, 1e-7 * expected) << seed;
      EXPECT_LE(report.lower, expected * (1 + 1e-12)) << seed;
      EXPECT_GE(report.upper, expected * (1 - 1e-12)) << seed;
   }
}

TEST(FrictionLimit, InvertsTheLoadLimit)
{
   for (const bool rigid : {false, true})
   {
      LimitProblem problem =
         limit_problem(random_contact(7, 9, 1, rigid), random_cycle(7, 3, 4));
      const double load_factor = 0.4;
      const LimitReport friction = friction_limit(problem, load_factor);
      ASSERT_EQ(friction.status, LimitStatus::certified) << friction.message;
      EXPECT_LE(friction.upper - friction.lower, 1e-6 * friction.upper);
      EXPECT_LE(friction.violation, 0);
      set_friction(problem.reduced, friction.upper);
      EXPECT_GE(load_limit(problem).upper, load_factor);
      set_friction(problem.reduced, friction.lower);
      EXPECT_LE(load_limit(problem).lower, load_factor);
   }
}

TEST(FrictionLimit, IsThatOfTheWeakestSpring)
{
   const ReducedProblem problem = springs(Eigen::Vector2d(1, 2), Eigen::Vector2d(0.3, 1));
   const LimitReport report =
      friction_limit(limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5)), 1.0);
   EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_NEAR(report.limit, 1.5 * 1 / (2 * 2), 1e-6);
   EXPECT_LE(report.lower, 0.375);
   EXPECT_GE(report.upper, 0.375);
}

TEST(FrictionLimit, DiscOfOneSpringIsHalfTheLargestDistance)
{
   // One node, three load vertices whose shears form a 3-4-5 triangle: the smallest disc that
   // holds it has the long side as its diameter.
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Zero(1, 2),
                         Eigen::MatrixXd::Identity(1, 1));
   problem.patterns = {
      {"P", Control::force, Eigen::Vector2d::Zero(), Eigen::VectorXd::Constant(1, 10)},
      {"r", Control::force, Eigen::Vector2d(1, 0), Eigen::VectorXd::Zero(1)},
      {"c", Control::force, Eigen::Vector2d(0, 1), Eigen::VectorXd::Zero(1)}};
   problem.H = Eigen::MatrixXd::Zero(3, 3);
   problem.gap = Eigen::VectorXd::Zero(1);
   set_friction(problem, 0.5);
   LoadCycle cycle{Eigen::Vector3d(1, 0, 0), Eigen::MatrixXd::Zero(3, 3)};
   cycle.varying.bottomRows(2) << 0, 3, 0, 0, 0, 4;
   const LimitProblem limit = limit_problem(problem, cycle);
   const LimitReport friction = friction_limit(limit, 1.0);
   EXPECT_EQ(friction.status, LimitStatus::certified) << friction.message;
   EXPECT_NEAR(friction.limit, 0.25, 1e-6);
   const LimitReport load = load_limit(limit);
   EXPECT_EQ(load.status, LimitStatus::certified) << load.message;
   EXPECT_NEAR(load.limit, 0.5 * 10 / 2.5, 1e-6);
   EXPECT_NEAR(load.slip[0], -1.5 * load.limit, 1e-4);
   EXPECT_NEAR(load.slip[1], -2.0 * load.limit, 1e-4);
}

/// A flat punch of 69 squares, shear there and back. Of equal bodies slip leaves the pressure
/// alone, and by symmetry no residual helps: the node whose shear first exhausts its friction
/// decides. Of a rigid one it does, and plain arithmetic and weak duality prove the limit.
TEST(LoadLimit, OfAPunchOnAHalfSpace)
{
   const double f = 0.3;
   const Material material{2.6, 0.3};
   for (const bool rigid : {false, true})
   {
      HalfSpace punch =
         cattaneo_test::contact_of(material, rigid ? std::nullopt : std::optional(material), 1,
                                   cattaneo_test::cells(9, 1, 4.5));
      punch.ends = true;
      ReducedProblem problem = punch.problem(Eigen::VectorXd::Zero(punch.centres.rows()));
      ASSERT_EQ(problem.nodes(), 69);
      set_friction(problem, f);
      const LoadCycle cycle =
         LoadCycle::through(problem, {{"P", 1}}, {{{"Q1", 1}}, {{"Q1", -1}}});
      const LimitReport report = load_limit(limit_problem(problem, cycle));
      ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
      const StuckForces stuck = stuck_forces(problem, cycle);
      const Eigen::VectorXd shear =
         stuck.q1.col(0).head(69).cwiseAbs2() + stuck.q1.col(0).tail(69).cwiseAbs2();
      const double first = f * (stuck.p0.col(0).array() / shear.array().sqrt()).minCoeff();
      if (!rigid) { EXPECT_NEAR(report.limit, first, 1e-6 * first); }
      EXPECT_LE(report.limit, f * (1 + 1e-9)); // all slides
   }
}

TEST(Limit, DegenerateCasesHaveStatusesAndMessages)
{
   const ReducedProblem problem = random_contact(3, 5, 1, true);
   // No shear: nothing to limit; and what the pressing alone needs is below what it needs with
   // it.
   LoadCycle steady{Eigen::Vector3d(1, 0, 0), Eigen::MatrixXd::Zero(3, 2)};
   LimitReport report = load_limit(limit_problem(problem, steady));
   EXPECT_EQ(report.status, LimitStatus::unlimited);
   EXPECT_NE(report.message, "");
   // A shear that the pressing itself causes can be relieved altogether: no friction needed.
   ReducedProblem relieved = problem;
   relieved.patterns[0].q = relieved.A() * Eigen::VectorXd::LinSpaced(5, 0, 0.1);
   report = friction_limit(limit_problem(relieved, steady), 1.0);
   EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_LT(report.upper, 1e-6);
   // Load that varies by pressing harder.
   const ReducedProblem simple = springs(Eigen::Vector2d(1, 1), Eigen::Vector2d(1, 1));
   report = load_limit(
      limit_problem(simple, {Eigen::Vector2d(1, 0), Eigen::Matrix2d{{0, 1}, {0, 0}}}));
   EXPECT_EQ(report.status, LimitStatus::unlimited);
   EXPECT_EQ(report.upper, std::numeric_limits<double>::infinity());
   EXPECT_GT(report.lower, 1e3);

   // Pulling: nothing presses the contact together.
   report =
      load_limit(limit_problem(problem, held_and_cycled(problem, "press", -1, "shear", 0)));
   EXPECT_EQ(report.status, LimitStatus::no_solution);
   report = friction_limit(
      limit_problem(problem, held_and_cycled(problem, "press", -1, "shear", 0)), 1);
   EXPECT_EQ(report.status, LimitStatus::no_solution);

   // Constant shear above gross sliding: no state, however the shear is distributed.
   LoadCycle sliding{Eigen::Vector3d(1, 50, 0), Eigen::MatrixXd::Zero(3, 2)};
   sliding.varying.row(2) << 1, -1;
   report = load_limit(limit_problem(problem, sliding));
   EXPECT_EQ(report.status, LimitStatus::no_solution);
   EXPECT_NE(report.message.find("proven"), std::string::npos) << report.message;

   // Cyclic pull-off of one node: no friction coefficient helps an uncoupled one.
   ReducedProblem pulled = springs(Eigen::Vector2d(1, 1), Eigen::Vector2d(0.1, 0.1));
   pulled.patterns[1].p = Eigen::Vector2d(0, -2);
   report = friction_limit(limit_problem(pulled, held_and_cycled(pulled, "P", 1, "Q", 0)), 1.0);
   EXPECT_EQ(report.status, LimitStatus::no_solution);
   EXPECT_NE(report.message.find("proven"), std::string::npos) << report.message;
   // It is the separation that limits the load.
   report = load_limit(limit_problem(pulled, held_and_cycled(pulled, "P", 1, "Q", 0)));
   EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_LT(report.limit, 0.5);

   // R towards 1: the limit tends to that of the steady shear.
   ReducedProblem steadier = problem;
   double last = 0;
   for (const double reversal : {0.0, 0.9, 0.999, 1.0})
   {
      report = load_limit(
         limit_problem(steadier, held_and_cycled(steadier, "press", 1, "shear", reversal)));
      ASSERT_EQ(report.status, LimitStatus::certified) << reversal << report.message;
      EXPECT_GE(report.limit, last * (1 - 1e-6));
      last = report.limit;
   }
}

/// One node of stiffness 1 in each direction, friction f, whose slip presses by @a press.
ReducedProblem one_node(double press, double f, Eigen::Index components)
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Identity(components, components),
                         press * Eigen::RowVectorXd::Unit(components, 0),
                         Eigen::MatrixXd::Identity(1, 1));
   const auto pattern = [&](const char *name, double q, double p)
   {
      return LoadPattern{name, Control::force, q * Eigen::VectorXd::Unit(components, 0),
                         Eigen::VectorXd::Constant(1, p)};
   };
   problem.patterns = {pattern("shear", 1, 0), pattern("more shear", 1, 0),
                       pattern("pressure", 0, 1)};
   if (components == 2) { problem.patterns[1].q = Eigen::Vector2d(0, 1); }
   problem.H = Eigen::MatrixXd::Zero(3, 3);
   problem.gap = Eigen::VectorXd::Zero(1);
   set_friction(problem, f);
   return problem;
}

TEST(Limit, OfANodePressedByItsOwnSlipOnly)
{
   // q = 1 + v ± λ, p = -v / 2: the slip v = -1 gives p = 1/2 and room for λ = f / 2; more slip
   // gives as much pressure as it takes shear. No load presses.
   const ReducedProblem plane = one_node(-0.5, 0.1, 1);
   const LimitProblem limit =
      limit_problem(plane, held_and_cycled(plane, "shear", 1, "more shear", -1));
   const LimitReport load = load_limit(limit);
   ASSERT_EQ(load.status, LimitStatus::certified) << load.message;
   EXPECT_NEAR(load.limit, 0.05, 1e-7);
   EXPECT_LE(load.lower, 0.05 * (1 + 1e-14));
   EXPECT_GE(load.upper, 0.05 * (1 - 1e-14));
   // A load that varies by 1e-20 of it may do so 1e20 times as often.
   LoadCycle weak = held_and_cycled(plane, "shear", 1, "more shear", -1);
   weak.varying *= 1e-20;
   const LimitReport often = load_limit(limit_problem(plane, weak));
   ASSERT_EQ(often.status, LimitStatus::certified) << often.message;
   EXPECT_NEAR(often.limit, 0.05e20, 1e13);
   // λ = 1: f ≥ (|1 - s| + 1) / (s / 2) for the slip -s, least at any s ≥ 1.
   const LimitReport friction = friction_limit(limit, 1);
   ASSERT_EQ(friction.status, LimitStatus::certified) << friction.message;
   EXPECT_NEAR(friction.limit, 2, 1e-5);

   // In the disc, with λ across: λ² = (f s / 2)² - (1 - s)², largest at s = 1 / (1 - f²/4).
   const ReducedProblem disc = one_node(-0.5, 0.1, 2);
   const LimitReport across =
      load_limit(limit_problem(disc, held_and_cycled(disc, "shear", 1, "more shear", -1)));
   ASSERT_EQ(across.status, LimitStatus::certified) << across.message;
   EXPECT_NEAR(across.limit, 0.05 / std::sqrt(1 - 0.0025), 1e-7);
}

TEST(Limit, IsNoneWhereAnySlipIsHeld)
{
   // f |B| > A: a slip presses more than it takes friction to hold, and so holds any load.
   for (const Eigen::Index components : {1, 2})
   {
      const ReducedProblem problem = one_node(-0.5, 2.5, components);
      const LimitProblem limit =
         limit_problem(problem, held_and_cycled(problem, "shear", 1, "more shear", -1));
      const LimitReport report = load_limit(limit);
      ASSERT_EQ(report.status, LimitStatus::unlimited) << report.message;
      EXPECT_NE(report.message.find("proven"), std::string::npos);
      EXPECT_EQ(report.limit, std::numeric_limits<double>::infinity());
      for (const double factor : {1.0, 1e6, 1e12})
      {
         const Eigen::VectorXd slip = report.slip + factor * report.ray;
         for (const double side : {-1.0, 1.0})
         {
            const double along = 1 + (components == 1 ? side * factor : 0) + slip[0];
            const double across = components == 1 ? 0 : side * factor + slip[1];
            EXPECT_LT(std::hypot(along, across), 2.5 * -0.5 * slip[0]) << factor;
         }
      }
   }
   // Without coupling: a steady shear is taken by a slip, however large, and just so.
   const ReducedProblem steady = one_node(0, 0.5, 1);
   const LimitReport report =
      load_limit(limit_problem(steady, held_and_cycled(steady, "pressure", 1, "shear", 1)));
   EXPECT_EQ(report.status, LimitStatus::unlimited) << report.message;
   // The slip that frees the node of a shear of whole numbers does so without round-off, and of
   // any other to the 16 digits of the shear: half of them are left at 1e8 times friction.
   EXPECT_GE(report.lower, 1e8 * 0.5);
}

TEST(Limit, MayLieFarBeyondGrossSliding)
{
   // Shear between 0 and λ, p = 1 - b v with f b = 1 - 2^-20: the slip -x holds the unloaded
   // node if x ≤ f (1 + b x), and the loaded one if λ - x ≤ f (1 + b x). So λ = 2 f / (1 - f
   // b).
   const double small = std::ldexp(1, -20);
   const ReducedProblem problem = one_node(-0.5, 2 * (1 - small), 1);
   const LimitReport report =
      load_limit(limit_problem(problem, held_and_cycled(problem, "pressure", 1, "shear", 0)));
   ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_NEAR(report.limit * small / (4 * (1 - small)), 1, 1e-6);
}

/// The last bits of a solver's point fall otherwise in other units, and on other processors.
/// Here they decide: the forces at the limit are up to 4e6 of those that the loads bring.
TEST(Limit, DoesNotDependOnRoundOff)
{
   constexpr double press = -0.3;
   const std::pair<double, double> units[] = {{1, 1}, {3, 1}, {1.0 / 7, 3}, {1024, 1.0 / 3}};
   for (const int digits : {12, 20})
   {
      for (const auto &[stiffness, load] : units)
      {
         const double small = std::ldexp(1, -digits);
         ReducedProblem problem = one_node(press, (1 - small) / -press, 1);
         problem.K *= stiffness;
         for (LoadPattern &pattern : problem.patterns)
         {
            pattern.q *= load;
            pattern.p *= load;
         }
         LimitProblem limit =
            limit_problem(problem, held_and_cycled(problem, "pressure", 1, "shear", 0));
         const LimitReport report = load_limit(limit);
         SCOPED_TRACE("2^-" + std::to_string(digits) + ", stiffness " +
                      std::to_string(stiffness) + ", load " + std::to_string(load));
         ASSERT_EQ(report.status, LimitStatus::certified) << report.message;
         // As in the test above, of the numbers as they were rounded.
         const long double a = problem.A()(0, 0), b = -problem.B()(0, 0),
                           f = problem.friction[0], exact = 2 * f * a / (a - f * b);
         constexpr long double arithmetic = 16 * 1e-19L; // of the line above; lost by a - f b
         EXPECT_LE(report.lower, exact * (1 + arithmetic / small));
         EXPECT_GE(report.upper, exact * (1 - arithmetic / small));
         EXPECT_LE(report.upper - report.lower, 1e-6L * exact);

         // The friction that a tenth of this load needs, of the same two conditions.
         const double factor = static_cast<double>(0.1L * exact);
         const LimitReport friction = friction_limit(limit, factor);
         ASSERT_EQ(friction.status, LimitStatus::certified) << friction.message;
         const long double least = factor * a / (2 * a + factor * b);
         EXPECT_LE(friction.lower, least * (1 + arithmetic));
         EXPECT_GE(friction.upper, least * (1 - arithmetic));

         // Friction that wedges the node holds any load.
         set_friction(limit.reduced, (1 + 2 * small) / -press);
         const LimitReport wedged = load_limit(limit);
         EXPECT_EQ(wedged.status, LimitStatus::unlimited) << wedged.message;
         EXPECT_NE(wedged.message.find("(proven)"), std::string::npos) << wedged.message;
      }
   }
}

TEST(Limit, ComesAfterTheConstantLoads)
{
   // Nothing varies, but the constant shear is beyond gross sliding (q = 5 on a free body of
   // two nodes, f p = 0.1).
   ReducedProblem free = springs(Eigen::Vector2d(1, 1), Eigen::Vector2d(5, 5));
   free.A() << 1, -1, -1, 1;
   complete(free);
   set_friction(free, 0.1);
   LoadCycle cycle{Eigen::Vector2d(1, 1), Eigen::MatrixXd::Zero(2, 2)};
   LimitReport report = load_limit(limit_problem(free, cycle));
   EXPECT_EQ(report.status, LimitStatus::no_solution);
   EXPECT_NE(report.message.find("proven"), std::string::npos) << report.message;
   // 50 times the friction is enough.
   report = friction_limit(limit_problem(free, cycle), 1);
   EXPECT_NEAR(report.limit, 5, 1e-5);

   // Nothing is constant: pressure and shear grow together. No limit if the shear is below
   // friction; zero if the unloaded vertex lets no slip stay that the other one needs.
   const ReducedProblem node = one_node(0, 0.5, 1);
   LoadCycle together{Eigen::Vector3d::Zero(), Eigen::MatrixXd::Zero(3, 2)};
   together.varying.col(0) << 0.4, 0, 1;
   report = load_limit(limit_problem(node, together));
   EXPECT_EQ(report.status, LimitStatus::unlimited) << report.message;
   together.varying(0, 0) = 0.6;
   report = load_limit(limit_problem(node, together));
   EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
   EXPECT_NEAR(report.limit, 0, 1e-9);
   // No load at all.
   report =
      load_limit(limit_problem(node, {Eigen::Vector3d::Zero(), Eigen::MatrixXd::Zero(3, 2)}));
   EXPECT_EQ(report.status, LimitStatus::unlimited);
   report = friction_limit(
      limit_problem(node, {Eigen::Vector3d::Zero(), Eigen::MatrixXd::Zero(3, 2)}), 1);
   EXPECT_EQ(report.limit, 0);
}

TEST(Limit, OutcomesHaveNames)
{
   EXPECT_STREQ(name(LimitStatus::certified), "certified");
   EXPECT_STREQ(name(LimitStatus::bracketed), "bracketed");
   EXPECT_STREQ(name(LimitStatus::unlimited), "unlimited");
   EXPECT_STREQ(name(LimitStatus::no_solution), "no solution");
   EXPECT_STREQ(name(LimitStatus::failed), "failed");
   EXPECT_STREQ(name(LimitStatus::unavailable), "unavailable");
}

TEST(Limit, RefusesBadInput)
{
   ReducedProblem problem = random_contact(3, 4, 1, false);
   const LoadCycle cycle = random_cycle(3, 3, 2);
   EXPECT_THROW(limit_problem(problem, random_cycle(3, 2, 2)), InputError);
   EXPECT_THROW(held_and_cycled(problem, "press", 1, "shear", 1.5), InputError);
   EXPECT_THROW(held_and_cycled(problem, "press", 1, "bend", 0), InputError);
   const auto refused = [](auto spoil)
   {
      LimitSettings settings;
      EXPECT_NO_THROW(settings.validate());
      spoil(settings);
      EXPECT_THROW(settings.validate(), InputError);
   };
   refused([](LimitSettings &s) { s.tolerance = 0.9e-9; });
   refused([](LimitSettings &s) { s.tolerance = 1; });
   refused([](LimitSettings &s) { s.max_iterations = 0; });
   refused([](LimitSettings &s) { s.largest_factor = 0; });
   refused([](LimitSettings &s) { s.largest_factor = INFINITY; });
   refused([](LimitSettings &s) { s.largest_friction = 0; });
   refused([](LimitSettings &s) { s.largest_friction = INFINITY; });
   EXPECT_THROW(friction_limit(limit_problem(problem, cycle), NAN), InputError);
   LimitProblem mixed = limit_problem(problem, cycle);
   mixed.residual = residual_forces(random_contact(3, 5, 1, false));
   EXPECT_THROW(load_limit(mixed), InputError);
   EXPECT_THROW(friction_limit(mixed, 1), InputError);
   LimitSettings settings;
   settings.tolerance = 0;
   EXPECT_THROW(load_limit(limit_problem(problem, cycle), settings), InputError);
   problem.friction[2] = 0;
   EXPECT_THROW(load_limit(limit_problem(problem, cycle)), InputError);
   problem.gap[1] = 1;
   EXPECT_THROW(limit_problem(problem, cycle), InputError);
   problem.gap[1] = 0;
   // A slip that needs no tangential force but changes the pressure would be free energy.
   problem.A() = Eigen::MatrixXd::Identity(4, 4) - Eigen::MatrixXd::Constant(4, 4, 0.25);
   problem.B() = Eigen::MatrixXd::Identity(4, 4);
   complete(problem);
   EXPECT_THROW(limit_problem(problem, cycle), InputError);
}

TEST(Limit, DoesNotDependOnUnits)
{
   const ReducedProblem problem = punch_like(33);
   const LoadCycle cycle = held_and_cycled(problem, "P", 1, "Q", -0.5);
   const LimitReport load = load_limit(limit_problem(problem, cycle));
   const LimitReport friction = friction_limit(limit_problem(problem, cycle), 0.6);
   ASSERT_EQ(load.status, LimitStatus::certified);
   ASSERT_EQ(friction.status, LimitStatus::certified);
   for (const double force : {1e-9, 1e9})
   {
      for (const double length : {1e-9, 1e9})
      {
         ReducedProblem scaled = problem;
         scaled.K *= force / length;
         for (LoadPattern &pattern : scaled.patterns)
         {
            pattern.q *= force;
            pattern.p *= force;
         }
         const LimitProblem limit = limit_problem(scaled, cycle);
         const LimitReport other = load_limit(limit);
         EXPECT_EQ(other.iterations, load.iterations);
         EXPECT_NEAR(other.limit, load.limit, 1e-10);
         EXPECT_NEAR(other.upper, load.upper, 1e-10);
         EXPECT_LT((other.slip / length - load.slip).norm(), 1e-6 * load.slip.norm());
         const LimitReport smallest = friction_limit(limit, 0.6);
         EXPECT_EQ(smallest.iterations, friction.iterations);
         EXPECT_NEAR(smallest.limit, friction.limit, 1e-9);
      }
   }
}

TEST(Limit, WarmStartTakesFewerIterationsToTheSameAnswer)
{
   const ReducedProblem punch = punch_like(65);
   LimitProblem problem = limit_problem(punch, held_and_cycled(punch, "P", 1, "Q", -0.5));
   const LimitReport first = load_limit(problem);
   set_friction(problem.reduced, 0.87);
   const LimitReport cold = load_limit(problem);
   LimitSettings settings;
   settings.start = &first;
   const LimitReport warm = load_limit(problem, settings);
   EXPECT_EQ(warm.status, LimitStatus::certified);
   EXPECT_LT(2 * warm.iterations, cold.iterations);
   EXPECT_NEAR(warm.limit, cold.limit, 1e-7 * cold.limit);
}

TEST(WeakDuality, BoundsTheLimitFromAnyMotion)
{
   // Whatever motion it is given: the repaired one must bound the brute-force limit from above.
   int finite = 0, close = 0;
   for (unsigned seed = 0; seed < 60; ++seed)
   {
      const Eigen::Index n = 2 + seed % 2;
      const ReducedProblem problem = random_contact(seed, n, 1, seed % 4 >= 2);
      const LoadCycle cycle = random_cycle(seed, 3, 2);
      const ResidualForces residual = residual_forces(problem);
      ConeProgramme programme;
      programme.residual = &residual;
      programme.friction = problem.friction.replicate(1, 2);
      programme.loads = stuck_forces(problem, cycle);
      programme.force_scale = Eigen::VectorXd::Ones(n);
      const double limit = brute_force_load(problem, cycle);
      std::mt19937 random(seed);
      for (int k = 0; k < 50; ++k)
      {
         const Eigen::MatrixXd opened = 0.5 * random_matrix(random, n, 2).cwiseAbs();
         ConeMechanism motion{random_matrix(random, n, 2),
                              opened.cwiseQuotient(programme.friction)};
         const double bound = weak_duality_bound(programme, problem, motion, 0);
         const CollapseMechanism mechanism = motion.at_vertices(programme, 2);
         EXPECT_GE(bound, limit * (1 - 1e-12)) << seed << ' ' << k;
         finite += std::isfinite(bound);
         close += bound < 2 * limit;
         if (!std::isfinite(bound)) { continue; }
         // The mechanism that proves it does so by its own figures.
         const Eigen::VectorXd imbalance =
            problem.A() * mechanism.slip.rowwise().sum() +
            problem.B().transpose() * mechanism.opening.rowwise().sum();
         EXPECT_LT(imbalance.norm(), 1e-11 * mechanism.opening.norm());
         for (Eigen::Index j = 0; j < 2; ++j)
         {
            EXPECT_GE((mechanism.opening.col(j) -
                       problem.friction.cwiseProduct(mechanism.slip.col(j).cwiseAbs()))
                         .minCoeff(),
                      -1e-14 * mechanism.opening.maxCoeff());
         }
      }
   }
   EXPECT_GT(finite, 100);
   EXPECT_GT(close, 0);
}

TEST(WeakDuality, ClosesTheGapOfDiscsThatNearlyWedge)
{
   // Mechanisms at the surface of their cones, which have no room for a repair of their own.
   for (const unsigned seed : {33, 86, 138})
   {
      SCOPED_TRACE(seed);
      const RandomLimit random = random_limit(seed, 2);
      const LimitReport report = friction_limit(limit_problem(random.problem, random.cycle), 1);
      EXPECT_EQ(report.status, LimitStatus::certified) << report.message;
      EXPECT_LE(report.violation, 0);
      EXPECT_LE(report.upper - report.lower, 1e-6 * report.upper);
   }
}

} // namespace
