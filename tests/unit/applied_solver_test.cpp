#include "expect_input_error.hpp"
#include "punch_problem.hpp"
#include "random_problem.hpp"

#include <cattaneo/friction/applied_solver.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <string>

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

/// The same increments with the stiffness applied and, the other way, with it factored.
void expect_same(const ReducedProblem &problem, const std::vector<VectorXd> &loads)
{
   const AppliedProblem only_applied = applied(problem);
   FrictionSolver solver(problem);
   ContactState state = virgin(only_applied), dense = ContactState::virgin(problem);
   for (const VectorXd &load : loads)
   {
      const AppliedReport report = solve(only_applied, state, load);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_LE(report.residual, 1e-9);
      EXPECT_GT(report.applications, 0);
      ASSERT_EQ(solver.solve(dense, load).status, FrictionStatus::converged);
      EXPECT_EQ(state.status, dense.status);
      const double force = dense.p.cwiseAbs().maxCoeff();
      EXPECT_LE((state.p - dense.p).cwiseAbs().maxCoeff(), 1e-8 * force);
      EXPECT_LE((state.q - dense.q).cwiseAbs().maxCoeff(), 1e-8 * force);
      const double moved = dense.v.cwiseAbs().maxCoeff() + dense.w.cwiseAbs().maxCoeff();
      EXPECT_LE((state.v - dense.v).cwiseAbs().maxCoeff(), 1e-8 * moved);
      EXPECT_LE((state.w - dense.w).cwiseAbs().maxCoeff(), 1e-8 * moved);
   }
}

VectorXd loads(double P, double Q)
{
   return Eigen::Vector2d(P, Q);
}

TEST(AppliedSolver, PunchIsPressedAndSheared)
{
   for (bool half_plane : {false, true})
   {
      SCOPED_TRACE(half_plane);
      ReducedProblem problem = cattaneo_test::punch_problem(33, half_plane);
      set_friction(problem, 0.3);
      expect_same(problem,
                  {loads(1, 0), loads(1, 0.1), loads(1, 0.2), loads(1, 0.1), loads(1, -0.15)});
   }
}

TEST(AppliedSolver, ParabolaIsPressedSlidesAndOpens)
{
   ReducedProblem problem = cattaneo_test::punch_problem(65, true);
   problem.gap = 0.8 * problem.position.col(0).cwiseAbs2();
   set_friction(problem, 0.25);
   expect_same(problem, {loads(0.2, 0), loads(0.4, 0), loads(0.4, 0.04), loads(0.4, 0.08),
                         loads(0.2, 0.02)});
}

TEST(AppliedSolver, NoFriction)
{
   ReducedProblem problem = cattaneo_test::punch_problem(65, true);
   problem.gap = 0.8 * problem.position.col(0).cwiseAbs2();
   const AppliedProblem only_applied = applied(problem);
   ContactState state = virgin(only_applied);
   ASSERT_EQ(solve(only_applied, state, loads(0.4, 0)).status, FrictionStatus::converged);
   FrictionSolver solver(problem);
   ContactState dense = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(dense, loads(0.4, 0)).status, FrictionStatus::converged);
   EXPECT_LE((state.p - dense.p).cwiseAbs().maxCoeff(), 1e-8 * dense.p.maxCoeff());
   EXPECT_LE(state.q.cwiseAbs().maxCoeff(), 1e-8 * dense.p.maxCoeff());
}

TEST(AppliedSolver, RandomProblems)
{
   std::mt19937 random(7);
   for (int k = 0; k < 30; ++k)
   {
      SCOPED_TRACE(k);
      expect_same(cattaneo_test::random_problem(12, 0.3, 0.2, random),
                  {loads(1, 0), loads(1, 0.2), loads(0.8, -0.3)});
   }
}

TEST(AppliedSolver, UnitsDoNotMatter)
{
   ReducedProblem problem = cattaneo_test::punch_problem(33, false);
   set_friction(problem, 0.3);
   const AppliedProblem plain = applied(problem);
   ContactState state = virgin(plain);
   const AppliedReport report = solve(plain, state, loads(1, 0.1));
   for (const double length : {1e-9, 1e9})
   {
      AppliedProblem scaled = plain; // displacements in another unit, a power of two near
      const double unit = std::exp2(std::round(std::log2(length)));
      scaled.apply = [&](const VectorXd &u) -> VectorXd { return plain.apply(u) / unit; };
      scaled.diagonal /= unit;
      ContactState other = virgin(scaled);
      const AppliedReport its = solve(scaled, other, loads(1, 0.1));
      EXPECT_EQ(its.newton_steps, report.newton_steps);
      EXPECT_EQ(its.applications, report.applications);
      EXPECT_LE((other.p - state.p).cwiseAbs().maxCoeff(), 1e-12 * state.p.maxCoeff());
      EXPECT_LE((other.v - unit * state.v).cwiseAbs().maxCoeff(),
                1e-12 * unit * state.v.cwiseAbs().maxCoeff());
   }
}

TEST(AppliedSolver, SaysWhenItStalls)
{
   ReducedProblem problem = cattaneo_test::punch_problem(33, false);
   set_friction(problem, 0.3);
   const AppliedProblem only_applied = applied(problem);
   ContactState state = virgin(only_applied);
   const ContactState before = state;
   AppliedSettings settings;
   settings.max_newton = 1;
   AppliedReport report = solve(only_applied, state, loads(1, 0.1), settings);
   EXPECT_EQ(report.status, FrictionStatus::stalled);
   EXPECT_NE(report.message.find("cut the increment"), std::string::npos);
   EXPECT_EQ(state.status, before.status);
   EXPECT_EQ(state.v, before.v);
   settings = {};
   settings.max_iterations = 1;
   report = solve(only_applied, state, loads(1, 0.1), settings);
   EXPECT_EQ(report.status, FrictionStatus::stalled);
   EXPECT_NE(report.message.find("iterations"), std::string::npos);
   // More than friction can hold: no answer, and none is made up.
   EXPECT_EQ(solve(only_applied, state, loads(1, 0.5)).status, FrictionStatus::stalled);
}

TEST(AppliedSolver, RefusesBadInput)
{
   ReducedProblem problem = cattaneo_test::punch_problem(9, false);
   AppliedProblem bad = applied(problem);
   ContactState state = virgin(bad);
   EXPECT_THROW(solve(bad, state, VectorXd::Ones(3)), InputError);
   AppliedSettings settings;
   settings.tolerance = 0;
   EXPECT_THROW(solve(bad, state, loads(1, 0), settings), InputError);
   settings = {};
   settings.max_iterations = 0;
   EXPECT_THROW(solve(bad, state, loads(1, 0), settings), InputError);
   settings = {};
   settings.max_newton = 0;
   EXPECT_THROW(solve(bad, state, loads(1, 0), settings), InputError);
   expect_input_error([] { AppliedProblem().validate(); }, "0 gaps, 0 friction coefficients");
   ContactState other = state;
   other.v.conservativeResize(8);
   expect_input_error([&] { solve(bad, other, loads(1, 0)); }, "state has 9 nodes");
   other = state;
   other.status.pop_back();
   expect_input_error([&] { solve(bad, other, loads(1, 0)); },
                      "state has 8 nodes, the problem 9");
   bad.diagonal[2] = 0;
   EXPECT_THROW(solve(bad, state, loads(1, 0)), InputError);
   bad = applied(problem);
   bad.apply = nullptr;
   EXPECT_THROW(bad.validate(), InputError);
   bad = applied(problem);
   bad.friction[0] = -1;
   EXPECT_THROW(bad.validate(), InputError);
}

TEST(AppliedSolver, SaysWhatIsWrongWithAnAppliedProblem)
{
   const ReducedProblem problem = cattaneo_test::punch_problem(9, false);
   const auto refused =
      [&](const std::string &said, const std::function<void(AppliedProblem &)> &spoil)
   {
      AppliedProblem bad = applied(problem);
      EXPECT_NO_THROW(bad.validate());
      spoil(bad);
      expect_input_error([&] { bad.validate(); }, said);
   };
   const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
   refused("0 gaps", [](auto &p) { p.gap.resize(0); });
   refused("8 friction coefficients", [](auto &p) { p.friction = VectorXd::Ones(8); });
   refused("17 diagonal entries", [](auto &p) { p.diagonal = VectorXd::Ones(17); });
   refused("nothing that applies it", [](auto &p) { p.apply = nullptr; });
   refused("a gap is not finite", [&](auto &p) { p.gap[3] = nan; });
   refused("friction is", [&](auto &p) { p.friction[3] = infinity; });
   refused("friction is -1", [](auto &p) { p.friction[3] = -1; });
   refused("a diagonal entry is 0", [](auto &p) { p.diagonal[17] = 0; });
   refused("a diagonal entry is", [&](auto &p) { p.diagonal[17] = infinity; });
   refused("load pattern 'Q' has 9 tangential and 8 normal forces",
           [](auto &p) { p.patterns[1].p = VectorXd::Ones(8); });
   refused("load pattern 'P' has 8 tangential and 9 normal forces",
           [](auto &p) { p.patterns[0].q = VectorXd::Ones(8); });
   refused("load pattern 'P'", [&](auto &p) { p.patterns[0].q[2] = nan; });
   refused("7 in the stiffness that was formed",
           [](auto &p)
           {
              auto formed = std::make_shared<ReducedProblem>();
              formed->set_stiffness({}, Eigen::MatrixXd(7, 0), Eigen::MatrixXd::Identity(7, 7));
              p.formed = formed;
           });
   // Gap, friction, diagonal and product are the problem's own.
   ReducedProblem other = problem;
   other.gap = VectorXd::LinSpaced(9, 0, 1);
   other.friction = VectorXd::LinSpaced(9, 0.1, 0.9);
   const AppliedProblem same = applied(other);
   EXPECT_EQ(same.gap, other.gap);
   EXPECT_EQ(same.friction, other.friction);
   EXPECT_EQ(same.diagonal, other.K.diagonal());
   const VectorXd u = VectorXd::LinSpaced(18, -1, 2);
   EXPECT_LT((same.apply(u) - other.K * u).norm(), 1e-14);
   // Torsion has two components, a problem without friction none.
   other.set_stiffness(Eigen::MatrixXd::Identity(18, 18), Eigen::MatrixXd::Zero(9, 18),
                       other.C());
   for (LoadPattern &pattern : other.patterns) { pattern.q = VectorXd::Zero(18); }
   other.rigid_motions.reset();
   expect_input_error([&] { applied(other); }, "2 tangential components a node, must have 1");
}

} // namespace
