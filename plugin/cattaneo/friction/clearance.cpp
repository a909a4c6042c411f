#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <cattaneo/friction/clearance.hpp>
#include <vector>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::optional<VectorXd> taken_up_clearance(const ReducedProblem &problem,
                                           const VectorXd &clamped_forces)
{
   const Index n = problem.nodes(), slips = problem.slips();
   std::vector<Index> touching, open;
   for (Index i = 0; i < n; ++i)
   {
      if (problem.gap[i] > 0)
      {
         open.push_back(i);
         continue;
      }
      for (Index row = i; row < slips + n; row += n) { touching.push_back(row); }
   }
   const MatrixXd &all = problem.rigid_motions;
   if (all.cols() == 0 || open.empty()) { return {}; }
   const MatrixXd Z = at_rest(all, all(touching, Eigen::all));
   // Round-off of loads that balance each other moves nothing.
   const VectorXd d = -(Z.transpose() * clamped_forces);
   if (d.size() == 0 || d.norm() <= 1e-9 * clamped_forces.norm()) { return {}; }
   const MatrixXd W = Z.bottomRows(n)(open, Eigen::all);
   const VectorXd g = problem.gap(open), closing = -(W * d);
   const auto unborne = [&](const MatrixXd &rows)
   { return fit_nonnegative(rows.transpose(), -d).residual.norm(); };
   const double negligible = 1e-9 * d.norm();
   if (unborne(W) > negligible) { return {}; }
   for (double far = 10; far < 1e7; far *= 10)
   {
      const double t = far * g.maxCoeff() / closing.maxCoeff();
      const std::optional<VectorXd> rest = least_distance(W, t * closing - g);
      if (!rest) { continue; }
      const VectorXd c = *rest + t * d, left = g + W * c;
      std::vector<Index> bearing;
      for (Index k = 0; k < left.size(); ++k)
      {
         if (left[k] <= 1e-9 * far * g.maxCoeff()) { bearing.push_back(k); }
      }
      if (bearing.empty() || unborne(W(bearing, Eigen::all)) > negligible) { continue; }
      VectorXd u = Z * c;
      // Round-off must not look like penetration.
      for (Index i : open) { u[slips + i] = std::max(u[slips + i], -problem.gap[i]); }
      return u;
   }
   return {};
}

} // namespace cattaneo
