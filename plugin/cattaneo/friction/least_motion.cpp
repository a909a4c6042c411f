// Bodies that slip at every node, which only the history of their slip holds in place.

#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd free_motions(const ReducedProblem &problem, const std::vector<NodeState> &states)
{
   const MatrixXd &Z = problem.rigid_motions;
   const Index n = problem.nodes(), slips = problem.slips();
   std::vector<Index> held;
   for (Index i = 0; i < n && Z.cols() > 0; ++i)
   {
      if (closed(states[i])) { held.push_back(slips + i); }
      for (Index row = i; states[i] == NodeState::stick && row < slips; row += n)
      {
         held.push_back(row);
      }
   }
   return held.empty() ? MatrixXd(Z.rows(), 0) : at_rest(Z, Z(held, Eigen::all));
}

bool take_least_motion(Increment &at)
{
   const FrictionSystem &s = at.system;
   if (s.c != 1) { return false; }
   const MatrixXd free = free_motions(s.problem, at.status);
   if (free.cols() == 0) { return false; }
   // Rows that only move one way: slip and gaps.
   std::vector<Index> bounded;
   std::vector<double> way;
   for (Index i = 0; i < s.n; ++i)
   {
      bounded.push_back(closed(at.status[i]) ? s.t(i) : s.m(i));
      way.push_back(closed(at.status[i]) ? sense(at.status[i]) : 1.0);
   }
   // Motions whose squares, by the length of the contact, are of size one.
   const VectorXd unit = node_lengths(s.problem).replicate(2, 1).cwiseSqrt();
   const MatrixXd R = thin_qr(unit.asDiagonal() * free).R;
   const MatrixXd motions =
      R.transpose().triangularView<Eigen::Lower>().solve(free.transpose()).transpose();
   const Eigen::Map<const VectorXd> sign(way.data(), static_cast<Index>(way.size()));
   const MatrixXd G = sign.asDiagonal() * motions(bounded, Eigen::all);
   VectorXd from = at.start.displacements();
   from.tail(s.n) = -s.problem.gap;
   VectorXd u = at.u;
   // Twice: what it had moved before may have been large.
   for (int k = 0; k < 2; ++k)
   {
      const VectorXd moved = u - at.start.displacements();
      u -= motions * (motions.transpose() * unit.cwiseAbs2().cwiseProduct(moved));
      const VectorXd left = u - from;
      const auto back = least_distance(G, -sign.cwiseProduct(VectorXd(left(bounded))));
      if (!back) { return false; }
      u += motions * *back;
   }
   at.take(u, at.status);
   return true;
}

} // namespace cattaneo
