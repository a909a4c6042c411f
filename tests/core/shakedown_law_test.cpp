#include "expect_input_error.hpp"

#include <cattaneo/design/limit_gradient.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

// Shakedown limits where the bound of friction is a concave polyline of the pressure.
namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Points = Eigen::MatrixX2d;

Points points(std::initializer_list<std::pair<double, double>> list)
{
   Points all(static_cast<Index>(list.size()), 2);
   Index k = 0;
   for (const auto &[p, bound] : list) { all.row(k++) << p, bound; }
   return all;
}

/// Nodes of unit stiffness, pressed by P and sheared by Q, c components each.
ReducedProblem springs(Index n, Index c = 1)
{
   ReducedProblem problem;
   problem.set_stiffness(MatrixXd::Identity(c * n, c * n), MatrixXd::Zero(n, c * n),
                         MatrixXd::Identity(n, n));
   VectorXd shear = VectorXd::Zero(c * n);
   shear.head(n).setOnes();
   problem.patterns = {{"P", Control::force, VectorXd::Zero(c * n), VectorXd::Ones(n)},
                       {"Q", Control::force, shear, VectorXd::Zero(n)}};
   problem.H = MatrixXd::Zero(2, 2);
   problem.gap = VectorXd::Zero(n);
   problem.chains = one_chain(n);
   problem.weights = VectorXd::Ones(n);
   set_friction(problem, 0.5);
   return problem;
}

LoadCycle cycle_of(const ReducedProblem &problem, double P, double R)
{
   return LoadCycle::through(problem, {{"P", P}}, {{{"Q", 1}}, {{"Q", R}}});
}

/// The bound at p by the points themselves.
double bound_at(const Points &points, double p)
{
   double from = 0, strength = 0, slope = 0;
   for (Index k = 0; k < points.rows(); ++k)
   {
      slope = (points(k, 1) - strength) / (points(k, 0) - from);
      if (p <= points(k, 0)) { break; }
      from = points(k, 0);
      strength = points(k, 1);
   }
   return strength + slope * (p - from);
}

Points random_law(std::mt19937 &random, Index most)
{
   std::uniform_real_distribution<double> share(0, 1);
   const auto count = std::uniform_int_distribution<Index>(1, most)(random);
   Points law(count, 2);
   double p = 0, strength = 0, slope = 0.3 + 0.6 * share(random);
   for (Index k = 0; k < count; ++k)
   {
      const double step = 0.2 + 1.5 * share(random);
      p += step;
      strength += slope * step;
      law.row(k) << p, strength;
      // Sometimes the last piece is level.
      slope = k + 2 == count && share(random) < 0.4 ? 0 : slope * share(random);
   }
   return law;
}

/// All (v, λ) that are admissible: every piece of a bound, of every node at every vertex, is
/// one inequality a·(v, λ) ≤ b.
struct Admissible
{
   std::vector<VectorXd> a;
   std::vector<double> b;

   bool holds(const VectorXd &x) const
   {
      for (std::size_t k = 0; k < a.size(); ++k)
      {
         if (a[k].dot(x) > b[k] + 1e-9 * (1 + a[k].norm() * x.norm())) { return false; }
      }
      return true;
   }
   /// The largest λ of all corners, -1 if there is none.
   double largest() const;
};

Admissible admissible(const ReducedProblem &problem, const LoadCycle &cycle)
{
   Admissible all;
   std::vector<VectorXd> &a = all.a;
   std::vector<double> &b = all.b;
   const Index n = problem.nodes();
   const StuckForces loads = stuck_forces(problem, cycle);
   for (Index i = 0; i < n; ++i)
   {
      for (const double sense : {1.0, -1.0})
      {
         const Points &law = sense > 0 ? problem.laws[i].forward : problem.laws[i].backward;
         double from = 0, strength = 0;
         for (Index k = 0; k < law.rows(); ++k)
         {
            const double slope = (law(k, 1) - strength) / (law(k, 0) - from),
                         intercept = strength - slope * from;
            for (Index j = 0; j < loads.vertices(); ++j)
            {
               // -sense q ≤ slope p + intercept
               VectorXd row(n + 1);
               row.head(n) = -sense * problem.A().row(i).transpose() -
                             slope * problem.B().row(i).transpose();
               row[n] = -sense * loads.q1(i, j) - slope * loads.p1(i, j);
               a.push_back(row);
               b.push_back(intercept + sense * loads.q0(i, j) + slope * loads.p0(i, j));
            }
            from = law(k, 0);
            strength = law(k, 1);
         }
      }
   }
   return all;
}

double Admissible::largest() const
{
   double largest = -1;
   const std::size_t count = a.size();
   for (std::size_t k = 0; k < count; ++k)
   {
      for (std::size_t l = k + 1; l < count; ++l)
      {
         for (std::size_t m = l + 1; m < count; ++m)
         {
            Eigen::Matrix3d corner;
            corner << a[k].transpose(), a[l].transpose(), a[m].transpose();
            const Eigen::FullPivLU<Eigen::Matrix3d> lu(corner);
            if (!lu.isInvertible()) { continue; }
            const VectorXd x = lu.solve(Eigen::Vector3d(b[k], b[l], b[m]));
            if (x[2] > largest && holds(x)) { largest = x[2]; }
         }
      }
   }
   return largest;
}

TEST(ShakedownOfALaw, OfOneNodeIsTheStrengthAtItsPressure)
{
   ReducedProblem problem = springs(1);
   const FrictionLaw law{points({{1, 0.6}, {3, 0.8}, {4, 0.8}}), points({{1, 0.5}, {2, 0.7}})};
   set_friction_law(problem, law);
   for (const double P : {0.5, 2.0, 5.0})
   {
      const double forward = bound_at(law.forward, P), backward = bound_at(law.backward, P);
      // To and fro between λ and R λ: what is locked in moves it to the middle of both bounds.
      for (const double R : {-1.0, 0.0, 0.5})
      {
         const LimitReport limit = load_limit(limit_problem(problem, cycle_of(problem, P, R)));
         ASSERT_EQ(limit.status, LimitStatus::certified) << limit.message;
         const double expected = (forward + backward) / (1 - R);
         EXPECT_NEAR(limit.limit, expected, 1e-6 * expected) << P << ' ' << R;
         EXPECT_LE(limit.lower, expected * (1 + 1e-12));
         EXPECT_GE(limit.upper, expected * (1 - 1e-12));
      }
      // Stuck from the beginning it slips where either bound is reached.
      const Incipience slip = incipient_slip(problem, cycle_of(problem, P, -1), 0),
                       back = incipient_slip(problem, cycle_of(problem, P, -1), 1);
      EXPECT_NEAR(slip.load_factor, backward, 1e-12);
      EXPECT_NEAR(back.load_factor, forward, 1e-12);
   }
}

TEST(ShakedownOfALaw, OfADiscIsTheStrengthToAllSides)
{
   ReducedProblem problem = springs(1, 2);
   set_friction_law(problem, points({{1, 0.6}, {3, 0.8}, {4, 0.8}}));
   for (const auto &[P, strength] : {std::pair{0.5, 0.3}, {2.0, 0.7}, {9.0, 0.8}})
   {
      const LimitReport limit = load_limit(limit_problem(problem, cycle_of(problem, P, -1)));
      ASSERT_EQ(limit.status, LimitStatus::certified) << limit.message;
      EXPECT_NEAR(limit.limit, strength, 1e-6 * strength);
   }
}

TEST(ShakedownOfALaw, AgainstAllCornersOfTwoCoupledNodes)
{
   std::mt19937 random(11);
   std::normal_distribution<double> normal;
   const auto matrix = [&](Index rows, Index columns)
   { return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); })); };
   int certified = 0, level = 0;
   for (int trial = 0; trial < 300; ++trial)
   {
      ReducedProblem problem = springs(2);
      const MatrixXd G = matrix(4, 4);
      MatrixXd K = G * G.transpose() + 0.5 * MatrixXd::Identity(4, 4);
      if (trial % 3 == 0)
      {
         K.topRightCorner(2, 2).setZero();
         K.bottomLeftCorner(2, 2).setZero();
      }
      problem.set_stiffness(K.topLeftCorner(2, 2), K.bottomLeftCorner(2, 2),
                            K.bottomRightCorner(2, 2));
      problem.patterns[0].p = VectorXd::Ones(2) + 0.5 * matrix(2, 1).cwiseAbs();
      problem.patterns[0].q = 0.1 * matrix(2, 1);
      problem.patterns[1].p = 0.2 * matrix(2, 1);
      problem.patterns[1].q = matrix(2, 1);
      for (Index i = 0; i < 2; ++i)
      {
         set_friction_law(problem, FrictionLaw{random_law(random, 3), random_law(random, 3)},
                          {i});
      }
      const LoadCycle cycle = cycle_of(problem, 1, trial % 2 ? -1 : -0.3);
      const Admissible all = admissible(problem, cycle);
      const double expected = all.largest();
      const LimitReport limit = load_limit(limit_problem(problem, cycle));
      if (limit.status == LimitStatus::unlimited)
      {
         for (const double factor : {1.0, 1e3, 1e6})
         {
            VectorXd x(3);
            x << limit.slip + factor * limit.ray, factor;
            EXPECT_TRUE(all.holds(x)) << trial;
         }
         continue;
      }
      if (limit.status == LimitStatus::no_solution)
      {
         EXPECT_LT(expected, 0) << trial;
         continue;
      }
      ASSERT_EQ(limit.status, LimitStatus::certified) << trial << ' ' << limit.message;
      EXPECT_NEAR(limit.limit, expected, 1e-6 * expected + 1e-9) << trial;
      EXPECT_LE(limit.lower, expected * (1 + 1e-9)) << trial;
      EXPECT_GE(limit.upper, expected * (1 - 1e-9)) << trial;
      ++certified;
      for (const FrictionLaw &law : problem.laws)
      {
         const Index last = law.forward.rows() - 1;
         level += last > 0 && law.forward(last, 1) == law.forward(last - 1, 1);
      }
   }
   EXPECT_GT(certified, 200);
   EXPECT_GT(level, 30);
}

TEST(ShakedownOfALaw, MarchesEndBelowItAndGoOnAbove)
{
   ReducedProblem problem = springs(2);
   Eigen::Matrix2d A, C;
   A << 2, -1, -1, 2;
   C << 3, -1, -1, 3;
   problem.set_stiffness(A, MatrixXd::Zero(2, 2), C);
   problem.patterns[1].q << 1, 0.2;
   set_friction_law(
      problem, FrictionLaw{points({{0.5, 0.4}, {2, 0.6}}), points({{0.5, 0.3}, {2, 0.3}})});
   const LimitProblem of = limit_problem(problem, cycle_of(problem, 1, -1));
   const LimitReport limit = load_limit(of);
   ASSERT_EQ(limit.status, LimitStatus::certified) << limit.message;
   const LowerLimitReport lower = lower_limit(of, limit);
   EXPECT_EQ(lower.kind, LowerLimitKind::uncoupled);
   const TransientBracket bracket = transient_bracket(of, limit, 0.01);
   for (const TransientReport &below : bracket.below)
   {
      EXPECT_EQ(below.verdict, TransientVerdict::shaken_down) << below.message;
   }
   for (const TransientReport &above : bracket.above)
   {
      EXPECT_EQ(above.verdict, TransientVerdict::cyclic_slip) << above.message;
   }
}

TEST(ShakedownOfALaw, OfOnePointIsCoulombs)
{
   ReducedProblem coulomb = springs(3), law = coulomb;
   for (ReducedProblem *problem : {&coulomb, &law})
   {
      problem->patterns[1].q << 1, 0.5, -0.3;
      problem->patterns[1].p << 0.1, 0, -0.2;
   }
   set_friction_law(law, points({{2, 1}}));
   const LimitReport one = load_limit(limit_problem(coulomb, cycle_of(coulomb, 1, -0.5))),
                     other = load_limit(limit_problem(law, cycle_of(law, 1, -0.5)));
   ASSERT_EQ(one.status, LimitStatus::certified);
   ASSERT_EQ(other.status, LimitStatus::certified);
   EXPECT_NEAR(one.limit, other.limit, 1e-9 * one.limit);
}

TEST(ShakedownOfALaw, RefusesWhatIsNotKnownOfIt)
{
   ReducedProblem problem = springs(2);
   set_friction_law(problem, points({{1, 0.3}, {2, 0.9}}));
   expect_input_error([&] { load_limit(limit_problem(problem, cycle_of(problem, 1, -1))); },
                      "must be concave");
   set_friction_law(problem, points({{1, 0.3}, {2, 0.4}}));
   const LoadCycle cycle = cycle_of(problem, 1, -1);
   LimitProblem of = limit_problem(problem, cycle);
   expect_input_error([&] { friction_limit(of, 1); }, "supports Coulomb's law only");
   expect_input_error([&] { method1_friction(problem, cycle, 1); },
                      "supports Coulomb's law only");
   expect_input_error([&] { method1_load(problem, cycle); }, "supports Coulomb's law only");
   expect_input_error([&] { method2_friction(of, 1); }, "supports Coulomb's law only");
   const LimitReport limit = load_limit(of);
   expect_input_error([&] { load_limit_gradient(of, limit); }, "supports Coulomb's law only");
   of.residual.uncoupled = false;
   EXPECT_EQ(lower_limit(of, limit).kind, LowerLimitKind::none);
   set_friction(problem, 0);
   expect_input_error([&] { load_limit(limit_problem(problem, cycle)); }, "never sticks");
}

} // namespace
