#include "enumeration.hpp"

namespace cattaneo_test
{

std::vector<EnumeratedSolution> enumerate_solutions(const cattaneo::ReducedProblem &problem,
                                                    const Eigen::VectorXd &v_old,
                                                    const Eigen::VectorXd &multipliers,
                                                    double slack)
{
   using cattaneo::NodeState;
   const Eigen::Index n = problem.nodes();
   const Eigen::MatrixXd K = problem.K;
   Eigen::VectorXd start(2 * n);
   start << v_old, -problem.gap;
   const Eigen::VectorXd clamped = problem.clamped_forces(multipliers);
   const Eigen::VectorXd b = clamped + K * start;
   const double force =
      std::max(clamped.cwiseAbs().maxCoeff(), (K * start).cwiseAbs().maxCoeff());
   const Eigen::VectorXd d = K.diagonal().cwiseSqrt(); // unit displacement: √(own stiffness)
   std::vector<EnumeratedSolution> found;
   const NodeState all[] = {NodeState::stick, NodeState::separation, NodeState::forward_slip,
                            NodeState::backward_slip};
   long combinations = 1;
   for (Eigen::Index i = 0; i < n; ++i) { combinations *= 4; }
   for (long code = 0; code < combinations; ++code)
   {
      std::vector<NodeState> states(n);
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      Eigen::VectorXd rhs = Eigen::VectorXd::Zero(2 * n);
      long rest = code;
      for (Eigen::Index i = 0; i < n; ++i, rest /= 4)
      {
         const NodeState s = states[i] = all[rest % 4];
         const double f = problem.friction[i];
         const Eigen::Index t = i, m = n + i;
         if (s == NodeState::stick) { M(t, t) = 1; }
         else
         {
            const double sf = cattaneo::sense(s) * f;
            M.row(t) = (K.row(t) + sf * K.row(m)) / d[t];
            rhs[t] = -(b[t] + sf * b[m]) / d[t];
         }
         if (s == NodeState::separation)
         {
            M.row(m) = K.row(m) / d[m];
            rhs[m] = -b[m] / d[m];
         }
         else { M(m, m) = 1; }
      }
      // Columns in units of 1/√(own stiffness) as well, save where a displacement is given.
      for (Eigen::Index r = 0; r < 2 * n; ++r) { M.col(r) /= d[r]; }
      for (Eigen::Index i = 0; i < n; ++i)
      {
         if (states[i] == NodeState::stick) { M(i, i) = 1; }
         if (states[i] != NodeState::separation) { M(n + i, n + i) = 1; }
      }
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(M);
      const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
      if (!(pivots.minCoeff() > 1e-9 * pivots.maxCoeff())) { continue; }
      Eigen::VectorXd z = lu.solve(rhs);
      z += lu.solve(rhs - M * z);
      const Eigen::VectorXd x = z.cwiseQuotient(d), F = b + K * x;
      EnumeratedSolution solution;
      solution.margin = 1e300;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double p = F[n + i], q = F[i], f = problem.friction[i];
         const double s = cattaneo::sense(states[i]);
         const double margin =
            states[i] == NodeState::separation ? x[n + i] * d[n + i] * d[n + i]
            : states[i] == NodeState::stick    ? std::min(p, f * p - std::abs(q))
                                               : std::min(p, s * x[i] * d[i] * d[i]);
         solution.margin = std::min(solution.margin, margin / force);
      }
      if (!(solution.margin >= -slack)) { continue; }
      solution.states = states;
      solution.u = start + x;
      found.push_back(solution);
   }
   return found;
}

} // namespace cattaneo_test
