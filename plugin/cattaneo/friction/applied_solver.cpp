#include <algorithm>
#include <cattaneo/friction/applied_solver.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <unsupported/Eigen/IterativeSolvers>

namespace cattaneo
{
namespace
{
struct AppliedMatrix;
}
} // namespace cattaneo

namespace Eigen::internal
{

template <>
struct traits<cattaneo::AppliedMatrix> : traits<SparseMatrix<double>>
{
};

} // namespace Eigen::internal

namespace cattaneo
{
namespace
{

/// What Eigen needs to know of a matrix that can be applied.
struct AppliedMatrix : Eigen::EigenBase<AppliedMatrix>
{
   using Scalar = double;
   using RealScalar = double;
   using StorageIndex = int;
   enum
   {
      ColsAtCompileTime = Eigen::Dynamic,
      MaxColsAtCompileTime = Eigen::Dynamic,
      IsRowMajor = false
   };

   std::function<Eigen::VectorXd(const Eigen::VectorXd &)> times;
   Eigen::Index size = 0;

   Eigen::Index rows() const { return size; }
   Eigen::Index cols() const { return size; }
   template <class Vector>
   Eigen::Product<AppliedMatrix, Vector, Eigen::AliasFreeProduct>
   operator*(const Eigen::MatrixBase<Vector> &x) const
   {
      return {*this, x.derived()};
   }
};

} // namespace
} // namespace cattaneo

namespace Eigen::internal
{

template <class Vector>
struct generic_product_impl<cattaneo::AppliedMatrix, Vector, SparseShape, DenseShape,
                            GemvProduct>
   : generic_product_impl_base<cattaneo::AppliedMatrix, Vector,
                               generic_product_impl<cattaneo::AppliedMatrix, Vector>>
{
   using Scalar = double;
   template <class Result>
   static void scaleAndAddTo(Result &result, const cattaneo::AppliedMatrix &A, const Vector &x,
                             const Scalar &factor)
   {
      result += factor * A.times(x);
   }
};

} // namespace Eigen::internal

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

void AppliedSettings::validate() const
{
   require(tolerance > 0 && tolerance < 1, "applied settings: tolerance is ", tolerance,
           ", must be between 0 and 1");
   require(max_newton >= 1, "applied settings: max_newton is ", max_newton,
           ", must be at least 1");
   require(max_iterations >= 1, "applied settings: max_iterations is ", max_iterations,
           ", must be at least 1");
}

namespace
{

/// One increment at work.
struct Increment
{
   const AppliedProblem &problem;
   AppliedReport &report;
   const Index n;
   const VectorXd v_old;
   std::vector<NodeState> status;
   VectorXd f; ///< forces with v = w = 0 at the new loads
   VectorXd u; ///< {v; w}
   VectorXd F; ///< {q; p} = f + S u
   double reference;

   Increment(const AppliedProblem &given, AppliedReport &filled, const ContactState &state,
             const VectorXd &multipliers)
      : problem(given), report(filled), n(given.nodes()), v_old(state.v), status(state.status),
        f(VectorXd::Zero(2 * n)), u(2 * n)
   {
      for (std::size_t k = 0; k < problem.patterns.size(); ++k)
      {
         const double factor = multipliers[static_cast<Index>(k)];
         f.head(n) += factor * problem.patterns[k].q;
         f.tail(n) += factor * problem.patterns[k].p;
      }
      u << state.v, state.w;
      for (Index i = 0; i < n; ++i)
      {
         if (closed(status[i])) { u[n + i] = -problem.gap[i]; }
      }
      F = times(u);
      reference =
         std::max({state.peak_force, f.cwiseAbs().maxCoeff(), F.cwiseAbs().maxCoeff()});
      reference = std::max(
         reference, -(problem.gap.array() * problem.diagonal.tail(n).array()).minCoeff());
      if (reference == 0) { reference = 1; }
      F += f;
   }

   VectorXd times(const VectorXd &x)
   {
      ++report.applications;
      return problem.apply(x);
   }
   double gap(Index i) const { return u[n + i] + problem.gap[i]; }
   double bound(Index i) const { return problem.friction[i] * std::max(F[n + i], 0.0); }
   double trial(Index i) const { return F[i] - problem.diagonal[i] * (u[i] - v_old[i]); }

   /// Largest residual of the natural map, relative.
   double residual() const
   {
      double largest = 0;
      for (Index i = 0; i < n; ++i)
      {
         const double closing = std::min(problem.diagonal[n + i] * gap(i), F[n + i]);
         const double sliding = F[i] - std::clamp(trial(i), -bound(i), bound(i));
         largest = std::max({largest, std::abs(closing), std::abs(sliding)});
      }
      return largest / reference;
   }

   /// The states that displacements and forces ask for; true if none changed. Violations below
   /// `tiny` change nothing.
   bool update_states(double tiny)
   {
      bool same = true;
      for (Index i = 0; i < n; ++i)
      {
         NodeState next = status[i];
         if (!closed(next))
         {
            // A node that penetrates sticks first: which way it slips is not known yet.
            if (problem.diagonal[n + i] * gap(i) < -tiny) { next = NodeState::stick; }
         }
         else if (F[n + i] < -tiny) { next = NodeState::separation; }
         else
         {
            const double margin = bound(i) + (slips(next) ? -tiny : tiny);
            next = trial(i) < -margin  ? NodeState::forward_slip
                   : trial(i) > margin ? NodeState::backward_slip
                                       : NodeState::stick;
         }
         same = same && next == status[i];
         status[i] = next;
      }
      return same;
   }

   /// Moves the nodes that the states leave free until their equations hold to `to`, a force.
   bool solve_equations(double to, int max_iterations)
   {
      // Row and what is added to it, as often as there are unknowns.
      std::vector<Index> rows, others;
      std::vector<double> factors;
      for (Index i = 0; i < n; ++i)
      {
         if (closed(status[i])) { u[n + i] = -problem.gap[i]; }
         if (status[i] == NodeState::stick)
         {
            u[i] = v_old[i];
            continue;
         }
         rows.push_back(i);
         others.push_back(n + i);
         factors.push_back(sense(status[i]) * problem.friction[i]);
      }
      for (Index i = 0; i < n; ++i)
      {
         if (closed(status[i])) { continue; }
         rows.push_back(n + i);
         others.push_back(n + i);
         factors.push_back(0);
      }
      F = f + times(u);
      if (rows.empty()) { return true; }
      const VectorXd factor =
         Eigen::Map<const VectorXd>(factors.data(), static_cast<Index>(factors.size()));
      const auto equations = [&](const VectorXd &forces) -> VectorXd
      { return forces(rows) + factor.cwiseProduct(forces(others)); };

      // Scaled from both sides to a diagonal of about one.
      const VectorXd scale = problem.diagonal(rows).cwiseSqrt();
      const double largest = scale.maxCoeff();
      AppliedMatrix matrix;
      matrix.size = static_cast<Index>(rows.size());
      matrix.times = [&](const VectorXd &x) -> VectorXd
      {
         VectorXd moved = VectorXd::Zero(2 * n);
         moved(rows) = x.cwiseQuotient(scale);
         return equations(times(moved)).cwiseQuotient(scale);
      };
      const VectorXd rhs = -equations(F).cwiseQuotient(scale);
      if (largest * rhs.norm() <= to) { return true; }
      Eigen::GMRES<AppliedMatrix, Eigen::IdentityPreconditioner> gmres(matrix);
      gmres.set_restart(std::min<Index>(max_iterations, matrix.size));
      gmres.setMaxIterations(max_iterations);
      gmres.setTolerance(to / (largest * rhs.norm()));
      const VectorXd step = gmres.solve(rhs);
      if (gmres.info() != Eigen::Success || !step.allFinite()) { return false; }
      u(rows) += step.cwiseQuotient(scale);
      F = f + times(u);
      return true;
   }
};

AppliedReport solve_formed(const AppliedProblem &problem, ContactState &state,
                           const VectorXd &multipliers)
{
   ReducedProblem formed = *problem.formed;
   formed.gap = problem.gap;
   formed.friction = problem.friction;
   formed.patterns = problem.patterns;
   FrictionSolver solver(formed);
   const IncrementReport increment = solver.solve(state, multipliers);
   AppliedReport report;
   report.status = increment.status;
   report.message = increment.message;
   report.residual = std::max(increment.residual_normal, increment.residual_tangential);
   report.newton_steps = solver.counters().newton_steps;
   return report;
}

} // namespace

AppliedReport solve(const AppliedProblem &problem, ContactState &state,
                    const VectorXd &multipliers, const AppliedSettings &settings)
{
   settings.validate();
   problem.validate();
   const Index n = problem.nodes();
   require(state.v.size() == n && state.w.size() == n &&
              static_cast<Index>(state.status.size()) == n,
           "applied solver: the state has ", state.status.size(), " nodes, the problem ", n);
   require(multipliers.size() == static_cast<Index>(problem.patterns.size()) &&
              multipliers.allFinite(),
           "applied solver: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size(), ", all finite");
   if (problem.formed) { return solve_formed(problem, state, multipliers); }
   AppliedReport report;
   Increment at(problem, report, state, multipliers);
   // The equations of a set of states that will change are solved a hundredth of the way.
   const double tight = 0.1 * settings.tolerance;
   report.residual = at.residual();
   at.update_states(tight * at.reference);
   for (report.newton_steps = 1; report.newton_steps <= settings.max_newton;
        ++report.newton_steps)
   {
      const double to = at.reference * std::max(tight, 0.01 * std::min(report.residual, 1.0));
      if (!at.solve_equations(to, settings.max_iterations))
      {
         report.message = std::to_string(settings.max_iterations) +
                          " iterations did not solve the equations of the node states";
         return report;
      }
      report.residual = at.residual();
      if (at.update_states(to) && report.residual <= settings.tolerance)
      {
         report.status = FrictionStatus::converged;
         state.multipliers = multipliers;
         state.peak_force = at.reference;
         state.status = at.status;
         state.v = at.u.head(n);
         state.w = at.u.tail(n);
         state.q = at.F.head(n);
         state.p = at.F.tail(n);
         for (Index i = 0; i < n; ++i)
         {
            if (!closed(state.status[i])) { state.q[i] = state.p[i] = 0; }
         }
         return report;
      }
   }
   report.newton_steps = settings.max_newton;
   report.message = "the node states have not settled after " +
                    std::to_string(settings.max_newton) + " active sets: cut the increment";
   return report;
}

ContactState virgin(const AppliedProblem &problem)
{
   problem.validate();
   const Index n = problem.nodes();
   ContactState state;
   state.v = state.w = state.q = state.p = state.slip_origin = VectorXd::Zero(n);
   for (Index i = 0; i < n; ++i)
   {
      state.status.push_back(problem.gap[i] > 0 ? NodeState::separation : NodeState::stick);
   }
   state.multipliers = VectorXd::Zero(static_cast<Index>(problem.patterns.size()));
   return state;
}

} // namespace cattaneo
