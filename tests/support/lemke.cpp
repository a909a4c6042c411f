#include "lemke.hpp"

namespace cattaneo_test
{

namespace
{

using Tableau = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Row that leaves the basis: least ratio of the right-hand side to the entering column; ties
/// are decided by the rows of the basis inverse (lexicographic rule). -1 if no entry is
/// positive.
Eigen::Index leaving_row(const Tableau &T, const Eigen::VectorXd &column, Eigen::Index rhs,
                         const std::vector<Eigen::Index> &basis, Eigen::Index artificial)
{
   const Eigen::Index N = T.rows();
   const double pivot_floor = 1e-11 * std::max(1.0, column.cwiseAbs().maxCoeff());
   std::vector<Eigen::Index> tied;
   double least = std::numeric_limits<double>::infinity();
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (column[i] <= pivot_floor) { continue; }
      least = std::min(least, T(i, rhs) / column[i]);
   }
   const double slack = 1e-13 * std::max(std::abs(least), 1e-300);
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (column[i] > pivot_floor && T(i, rhs) / column[i] <= least + slack)
      {
         tied.push_back(i);
      }
   }
   if (tied.empty()) { return -1; }
   // The artificial variable leaves whenever it can: that ends the method.
   for (Eigen::Index i : tied)
   {
      if (basis[i] == artificial) { return i; }
   }
   for (Eigen::Index k = 0; tied.size() > 1 && k < N; ++k)
   {
      double smallest = std::numeric_limits<double>::infinity();
      for (Eigen::Index i : tied) { smallest = std::min(smallest, T(i, k) / column[i]); }
      std::vector<Eigen::Index> still;
      for (Eigen::Index i : tied)
      {
         if (T(i, k) / column[i] <= smallest + 1e-14 * std::abs(smallest))
         {
            still.push_back(i);
         }
      }
      tied = still;
   }
   return tied.front();
}

} // namespace

LemkeReport lemke(const Eigen::MatrixXd &M, const Eigen::VectorXd &b,
                  const Eigen::VectorXd &cover, long max_pivots)
{
   const Eigen::Index N = b.size();
   LemkeReport report;
   report.z = Eigen::VectorXd::Zero(N);
   if (N == 0 || b.minCoeff() >= 0)
   {
      report.solved = true;
      return report;
   }
   // Columns: s (0 … N-1), z (N … 2N-1), the artificial variable (2N), right-hand side (2N+1).
   const Eigen::Index artificial = 2 * N, rhs = 2 * N + 1;
   Tableau T(N, 2 * N + 2);
   T.leftCols(N).setIdentity();
   T.middleCols(N, N) = -M;
   T.col(artificial) = -cover;
   T.col(rhs) = b;
   std::vector<Eigen::Index> basis(N);
   for (Eigen::Index i = 0; i < N; ++i) { basis[i] = i; }

   Eigen::Index row = 0, entering = artificial;
   b.cwiseQuotient(cover).minCoeff(&row);
   while (true)
   {
      const Eigen::VectorXd column = T.col(entering);
      T.row(row) /= column[row];
      for (Eigen::Index i = 0; i < N; ++i)
      {
         if (i != row && column[i] != 0) { T.row(i) -= column[i] * T.row(row); }
      }
      ++report.pivots;
      const Eigen::Index left = basis[row];
      basis[row] = entering;
      if (left == artificial)
      {
         report.solved = true;
         break;
      }
      if (report.pivots >= max_pivots) { return report; }
      entering = left < N ? left + N : left - N; // the complement of what left
      row = leaving_row(T, T.col(entering), rhs, basis, artificial);
      if (row < 0) { return report; }
   }
   for (Eigen::Index i = 0; i < N; ++i)
   {
      if (basis[i] >= N && basis[i] < artificial) { report.z[basis[i] - N] = T(i, rhs); }
   }
   return report;
}

cattaneo::ContactState state_of(const cattaneo::ReducedProblem &problem,
                                const cattaneo::ContactState &before,
                                const Eigen::VectorXd &multipliers,
                                const std::vector<cattaneo::NodeState> &states)
{
   using cattaneo::NodeState;
   const Eigen::Index n = problem.nodes();
   const Eigen::MatrixXd K = problem.K;
   const Eigen::VectorXd clamped = problem.clamped_forces(multipliers);
   Eigen::VectorXd u(2 * n);
   u << before.v, -problem.gap;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if (!closed(states[i])) { u[n + i] = 0; }
   }
   Eigen::MatrixXd M = Eigen::MatrixXd::Identity(2 * n, 2 * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if (states[i] == NodeState::stick) { continue; }
      M.row(i) = K.row(i) + sense(states[i]) * problem.friction[i] * K.row(n + i);
      if (!closed(states[i])) { M.row(n + i) = K.row(n + i); }
   }
   const Eigen::PartialPivLU<Eigen::MatrixXd> factor(M);
   for (int round = 0; round < 3; ++round)
   {
      const Eigen::VectorXd F = clamped + K * u;
      Eigen::VectorXd rest = Eigen::VectorXd::Zero(2 * n);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         if (states[i] == NodeState::stick) { continue; }
         rest[i] = F[i] + sense(states[i]) * problem.friction[i] * F[n + i];
         if (!closed(states[i])) { rest[n + i] = F[n + i]; }
      }
      u -= factor.solve(rest);
   }
   const Eigen::VectorXd F = clamped + K * u;
   cattaneo::ContactState state = before;
   state.multipliers = multipliers;
   state.status = states;
   state.v = u.head(n);
   state.w = u.tail(n);
   state.q = F.head(n);
   state.p = F.tail(n);
   state.peak_force = std::max(before.peak_force, clamped.cwiseAbs().maxCoeff());
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if (!closed(states[i])) { state.q[i] = state.p[i] = 0; }
   }
   return state;
}

std::optional<cattaneo::ContactState> solve_by_lemke(const cattaneo::ReducedProblem &problem,
                                                     const cattaneo::ContactState &before,
                                                     const Eigen::VectorXd &multipliers)
{
   using cattaneo::NodeState;
   using Eigen::MatrixXd;
   using Eigen::VectorXd;
   const Eigen::Index n = problem.nodes(), N = 3 * n;
   VectorXd closed_and_stuck(2 * n);
   closed_and_stuck << before.v, -problem.gap;
   VectorXd base = problem.clamped_forces(multipliers) + problem.K * closed_and_stuck;
   const double force = base.cwiseAbs().maxCoeff();
   if (force > 0) { base /= force; }
   // Non-dimensional unknowns: each displacement in units of (largest force)/(own stiffness)^½.
   const VectorXd dn = problem.C().diagonal().cwiseSqrt().cwiseInverse(),
                  dt = problem.A().diagonal().cwiseSqrt().cwiseInverse();
   const MatrixXd A = dt.asDiagonal() * problem.A() * dt.asDiagonal(),
                  B = dn.asDiagonal() * problem.B() * dt.asDiagonal(),
                  C = dn.asDiagonal() * problem.C() * dn.asDiagonal();
   // Friction between rows scaled by dt and rows scaled by dn.
   const VectorXd f = problem.friction.cwiseProduct(dt.cwiseQuotient(dn));
   const MatrixXd fB = f.asDiagonal() * B, fC = f.asDiagonal() * C;
   MatrixXd M(N, N);
   M << C, B, -B, fC + B.transpose(), fB + A, -fB - A, fC - B.transpose(), fB - A, A - fB;
   const VectorXd q = dt.asDiagonal() * base.head(n), p = dn.asDiagonal() * base.tail(n);
   const VectorXd fp = f.asDiagonal() * p;
   VectorXd b(N);
   b << p, fp + q, fp - q;
   // The cover is a loading path: extra pressure z0 at every node, and with it extra strength
   // against slip, fading together. An even cover reaches a solution in 98 of 100 random
   // problems with f up to 3, uneven ones in the rest (20,000 of 20,000).
   LemkeReport report;
   std::mt19937_64 random(1);
   for (int trial = 0; trial < 60 && !report.solved; ++trial)
   {
      auto uneven = [&]
      { return trial ? std::exp(3 * std::ldexp(double(random() >> 11), -53) - 1.5) : 1; };
      VectorXd cover(N);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         cover[i] = uneven();
         cover[n + i] = f[i] * cover[i] + 2 * uneven();
         cover[2 * n + i] = f[i] * cover[i] + 2 * uneven();
      }
      report = lemke(M, b, cover, 20 * N);
   }
   if (!report.solved) { return {}; }
   std::vector<NodeState> states(n, NodeState::stick);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double slip = report.z[n + i] - report.z[2 * n + i];
      if (report.z[i] > 0) { states[i] = NodeState::separation; }
      else if (slip > 0) { states[i] = NodeState::forward_slip; }
      else if (slip < 0) { states[i] = NodeState::backward_slip; }
   }
   cattaneo::ContactState state = state_of(problem, before, multipliers, states);
   if (!state.v.allFinite() || !state.w.allFinite()) { return {}; } // singular
   return state;
}

} // namespace cattaneo_test
