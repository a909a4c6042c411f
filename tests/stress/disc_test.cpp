// Random dense reduced problems of two tangential components: friction in the disc.

#include "contact_laws.hpp"
#include "disc_problems.hpp"
#include "outcomes.hpp"

#include <cattaneo/friction/friction_solver.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Random eigenvectors, eigenvalues over `decades`; friction at `times` the value above which a
/// node need not have a unique answer.
ReducedProblem disc_problem(int n, double decades, double times, std::mt19937 &random)
{
   std::normal_distribution<double> normal;
   std::uniform_real_distribution<double> uniform(0, 1);
   ReducedProblem problem = random_disc_problem(n, 0.0, 0.0, random);
   const MatrixXd R = MatrixXd::NullaryExpr(3 * n, 3 * n, [&] { return normal(random); });
   const MatrixXd Q = R.householderQr().householderQ();
   const VectorXd eigenvalues =
      VectorXd::NullaryExpr(3 * n, [&] { return std::pow(10, -decades * uniform(random)); });
   MatrixXd K = Q * eigenvalues.asDiagonal() * Q.transpose();
   K = (0.5 * (K + K.transpose())).eval();
   problem.set_stiffness(K.topLeftCorner(2 * n, 2 * n), K.bottomLeftCorner(n, 2 * n),
                         K.bottomRightCorner(n, n));
   for (Index i = 0; i < n; ++i)
   {
      const Eigen::Matrix2d own = problem.A()({i, n + i}, {i, n + i});
      const double least =
         Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(own).eigenvalues().minCoeff();
      const double coupling = std::hypot(problem.B()(i, i), problem.B()(i, n + i));
      problem.friction[i] = std::min(10.0, times * least / coupling);
   }
   return problem;
}

void run_discs(const std::string &row, double decades, double least, double most, unsigned seed,
               double stalls_allowed)
{
   std::mt19937 random(seed);
   std::uniform_real_distribution<double> uniform(0, 1);
   const int runs = cases(80, 1500);
   long increments = 0, missed = 0;
   for (int k = 0; k < runs; ++k)
   {
      const int n = 1 + k % 16;
      ReducedProblem problem =
         disc_problem(n, decades, least * std::pow(most / least, uniform(random)), random);
      if (k % 3 == 0) { problem.gap.setZero(); }
      if (k % 5 == 0) { problem.gap[n - 1] = -0.2; }
      if (k % 7 == 0) { problem.friction[0] = 0; }
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      if (k % 2)
      {
         state = ContactState::with_slip(
            problem, VectorXd::NullaryExpr(2 * n, [&] { return uniform(random) - 0.5; }));
      }
      LawChecker laws(problem, state);
      for (const Vector3d &loads : {Vector3d(1, 0, 0), Vector3d(1, 0.7, 0.5),
                                    Vector3d(0.8, -0.6, 0.9), Vector3d(0.1, 0.2, -0.3)})
      {
         const VectorXd v_old = state.v;
         const ContactState before = state;
         const IncrementReport report = solver.solve(state, loads);
         count_method(report);
         Verdict verdict;
         verdict.what = report.message;
         if (report.status == FrictionStatus::converged ||
             report.status == FrictionStatus::not_unique)
         {
            verdict.outcome = report.status == FrictionStatus::converged ? Outcome::verified
                                                                         : Outcome::not_unique;
            verdict.violation = laws.violation(v_old, state);
            if (!(verdict.violation <= 1))
            {
               verdict.outcome = Outcome::wrong;
               verdict.what = laws.what();
            }
         }
         else
         {
            // There is no way to try all directions: another method must not find an answer
            // where there is said to be none.
            verdict.outcome = report.status == FrictionStatus::stalled ? Outcome::stalled
                              : report.status == FrictionStatus::no_solution
                                 ? Outcome::no_solution
                                 : Outcome::gross_sliding;
            FrictionSettings by_node;
            by_node.method = FrictionMethod::gauss_seidel;
            by_node.max_sweeps = 5000;
            ContactState other = before;
            const FrictionStatus status =
               FrictionSolver(problem, by_node).solve(other, loads).status;
            const bool exists =
               (status == FrictionStatus::converged || status == FrictionStatus::not_unique) &&
               LawChecker(laws).violation(v_old, other) <= 1;
            missed += exists;
            if (report.message.empty() || (exists && verdict.outcome != Outcome::stalled))
            {
               verdict.outcome = Outcome::wrong;
               verdict.what += ": but sweeps find an answer";
            }
         }
         record(row, "problem " + std::to_string(k), verdict);
         ++increments;
      }
   }
   if (missed)
   {
      remark(row + ": sweeps find an answer for " + std::to_string(missed) + " of the stalled");
   }
   EXPECT_LE(count(row, Outcome::stalled), stalls_allowed * increments);
}

TEST(Disc, BelowCriticalFriction)
{
   run_discs("disc, below critical friction", 2, 0.01, 0.95, 400, 0.0);
}
TEST(Disc, AboveCriticalFriction)
{
   run_discs("disc, above critical friction", 2, 1.05, 30, 401, 0.0);
}
TEST(Disc, BadlyConditioned)
{
   // Strong coupling of many nodes, each below its critical friction: there may be no answer.
   run_discs("disc, condition 1e6", 6, 0.01, 0.95, 402, 0.002);
}

} // namespace
