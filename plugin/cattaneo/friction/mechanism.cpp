#include <cattaneo/friction/mechanism.hpp>
#include <cattaneo/friction/semidefinite.hpp>
#include <vector>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Residual g - G x of min |G x - g| over x >= 0 (Lawson and Hanson's active set; G has few
/// rows).
VectorXd nonnegative_residual(const MatrixXd &G, const VectorXd &g)
{
   const double scale = g.norm();
   std::vector<Index> used;
   VectorXd x = VectorXd::Zero(G.cols());
   VectorXd r = g;
   for (Index step = 0; step < 30 * G.rows() + 30; ++step)
   {
      Index best = 0;
      const double slope = (G.transpose() * r).maxCoeff(&best);
      if (r.norm() <= 1e-12 * scale || slope <= 1e-12 * scale * G.col(best).norm()) { break; }
      if (x[best] > 0) { break; }
      used.push_back(best);
      while (true)
      {
         const MatrixXd active = G(Eigen::all, used);
         const VectorXd trial = active.completeOrthogonalDecomposition().solve(g);
         if (trial.minCoeff() > 0)
         {
            for (std::size_t k = 0; k < used.size(); ++k) { x[used[k]] = trial[k]; }
            break;
         }
         double fraction = 1;
         for (std::size_t k = 0; k < used.size(); ++k)
         {
            if (trial[k] <= 0)
            {
               fraction = std::min(fraction, x[used[k]] / (x[used[k]] - trial[k] + 1e-300));
            }
         }
         std::vector<Index> kept;
         for (std::size_t k = 0; k < used.size(); ++k)
         {
            double &value = x[used[k]];
            value += fraction * (trial[k] - value);
            if (trial[k] > 0 || value > 1e-14 * x.maxCoeff()) { kept.push_back(used[k]); }
            else { value = 0; }
         }
         if (kept.size() == used.size()) { return g - G * x; } // no progress: round-off
         used = kept;
         if (used.empty()) { break; }
      }
      r = g - G * x;
   }
   return r;
}

} // namespace

MatrixXd rigid_motions(const ReducedProblem &problem)
{
   return SemidefiniteSolver(problem.stiffness()).null_space();
}

Mechanism find_mechanism(const ReducedProblem &problem, const MatrixXd &Z,
                         const VectorXd &clamped_forces)
{
   Mechanism mechanism;
   if (Z.cols() == 0) { return mechanism; }
   const Index n = problem.nodes(), m = problem.A.rows();
   // Equilibrium along the rigid motions: Zᵀ{q; p} = Zᵀ f^w. Columns of G: the two edges
   // (± f, 1) of every node's friction cone.
   MatrixXd G(Z.cols(), 2 * n);
   for (Index i = 0; i < n; ++i)
   {
      const VectorXd normal = Z.row(m + i);
      const VectorXd tangential = m ? VectorXd(Z.row(i)) : VectorXd::Zero(Z.cols());
      G.col(2 * i) = normal + problem.friction[i] * tangential;
      G.col(2 * i + 1) = normal - problem.friction[i] * tangential;
   }
   const VectorXd g = Z.transpose() * clamped_forces;
   const VectorXd r = nonnegative_residual(G, g);
   if (r.norm() <= 1e-9 * g.norm() || g.norm() == 0) { return mechanism; }
   mechanism.exists = true;
   mechanism.motion = Z * r;
   mechanism.motion /= mechanism.motion.cwiseAbs().maxCoeff();
   mechanism.slides = m > 0 && mechanism.motion.head(m).cwiseAbs().maxCoeff() > 1e-6;
   return mechanism;
}

} // namespace cattaneo
