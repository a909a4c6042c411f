#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/extreme_eigenvalues.hpp>
#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/free_bodies.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Can forces inside the cones of friction f balance each other? All edges count alike, so the
/// question is whether zero is in the convex hull of the edges. If the pressure of a node does
/// no work on any rigid motion, supports balance it, and also its shear, at any friction. This
/// does not count as locking, because elasticity decides which forces such a node can carry.
bool locks(const ReducedProblem &problem, double f)
{
   const MatrixXd &Z = problem.rigid_motions;
   const MatrixXd edges =
      cone_edges(Z, std::vector<FrictionBound>(problem.nodes(), FrictionBound(f)));
   const Index n = problem.nodes(), m = problem.slips();
   const double round_off = 1e-9 * Z.cwiseAbs().maxCoeff();
   MatrixXd G(Z.cols() + 1, edges.cols());
   Index used = 0;
   for (Index k = 0; k < edges.cols(); ++k)
   {
      const auto edge = edges.col(k);
      if (Z.row(m + k / 2 % n).norm() <= round_off) { continue; }
      if (edge.norm() > 1e-12 * (1 + f)) { G.col(used++) << edge / edge.norm(), 1; }
   }
   G.conservativeResize(Eigen::NoChange, used);
   const VectorXd target = VectorXd::Unit(Z.cols() + 1, Z.cols());
   return used > 0 && fit_nonnegative(G, target).residual.norm() < 1e-9;
}

/// Cones grow with friction, so bisection finds the critical value. If pressures balance each
/// other without friction (a pin in its hole, a plate between two others), friction is not the
/// cause. Such pressures cannot persist without a load, because they do no work on nodes
/// that stay closed.
double locking_friction(const ReducedProblem &problem)
{
   double low = 1e-6, high = 1e6;
   if (problem.rigid_motions.cols() == 0 || !locks(problem, high) || locks(problem, 0))
   {
      return infinity;
   }
   while (high > (1 + 1e-12) * low)
   {
      const double middle = std::sqrt(low * high);
      (locks(problem, middle) ? high : low) = middle;
   }
   return high;
}

double uniqueness_bound(const ReducedProblem &problem)
{
   if (!problem.coupled) { return infinity; }
   // There is a motion without resistance: C is singular, or the Schur complement of C in K is.
   if (problem.rigid_motions.cols() > 0) { return 0; }
   const Index n = problem.nodes(), m = problem.slips();
   const VectorXd s = problem.C().diagonal().cwiseSqrt().cwiseInverse(),
                  st = s.replicate(m / n, 1);
   const MatrixXd C = s.asDiagonal() * problem.C() * s.asDiagonal();
   const double of_C = largest_eigenvalue(C);
   DenseCholesky factor;
   if (smallest_eigenvalue(C) <= 1e-11 * of_C || !factor.compute(C)) { return 0; }
   MatrixXd X = s.asDiagonal() * problem.B() * st.asDiagonal();
   factor.solve_half(X);
   const MatrixXd coupling = -minus_square(MatrixXd::Zero(m, m), X),
                  rest = st.asDiagonal() * problem.A() * st.asDiagonal() - coupling;
   const double a = smallest_eigenvalue(rest), c = std::sqrt(of_C),
                b = std::sqrt(largest_eigenvalue(coupling));
   if (a <= 0 || a <= 1e-11 * largest_eigenvalue(rest)) { return 0; }
   const double worst = std::min(b, std::sqrt(a));
   return (a + worst * worst) / (c * worst);
}

} // namespace

CriticalFriction critical_friction(const ReducedProblem &problem)
{
   problem.validate();
   CriticalFriction result;
   result.node = result.locking = result.unique_below = infinity;
   const Index n = problem.nodes(), c = problem.components();
   if (c == 0) { return result; }
   for (Index i = 0; i < n; ++i)
   {
      const double alone = critical_friction(lone_node(problem, i));
      if (alone < result.node)
      {
         result.node = alone;
         result.weakest_node = i;
      }
   }
   result.locking = locking_friction(problem);
   result.unique_below = uniqueness_bound(problem);
   return result;
}

bool can_lock(const ReducedProblem &problem)
{
   return problem.rigid_motions.cols() > 0 && problem.components() > 0 &&
          locks(problem, problem.friction.maxCoeff());
}

} // namespace cattaneo
