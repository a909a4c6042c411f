#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <vector>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NonnegativeFit fit_nonnegative(const MatrixXd &G, const VectorXd &g)
{
   const double scale = g.norm();
   std::vector<Index> used;
   VectorXd x = VectorXd::Zero(G.cols());
   VectorXd r = g;
   // Whether the residual is perpendicular to the edges in use is judged relative to its own
   // size, because it may be tiny.
   const auto polish = [&]
   {
      r = g - G * x;
      if (used.empty()) { return; }
      const MatrixXd active = G(Eigen::all, used);
      r -= active * least_squares(active, r);
   };
   for (Index step = 0; step < 30 * G.rows() + 30; ++step)
   {
      Index best = 0;
      const double slope = (G.transpose() * r).maxCoeff(&best);
      // Relative to the size of the residual, because with little friction all edges are almost
      // perpendicular to it.
      if (r.norm() <= 1e-13 * scale || slope <= 1e-13 * r.norm() * G.col(best).norm())
      {
         break;
      }
      if (x[best] > 0) { break; }
      used.push_back(best);
      while (true)
      {
         const MatrixXd active = G(Eigen::all, used);
         const VectorXd trial = least_squares(active, g);
         if (trial.minCoeff() > 0)
         {
            x(used) = trial;
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
         if (kept.size() == used.size()) // no progress: round-off
         {
            polish();
            return {x, r};
         }
         used = kept;
         if (used.empty()) { break; }
      }
      // Otherwise round-off would choose edges that are already perpendicular to the residual.
      polish();
   }
   return {x, r};
}

std::optional<VectorXd> least_distance(const MatrixXd &G, const VectorXd &h)
{
   const Index k = G.cols();
   const double scale = h.size() > 0 ? h.maxCoeff() : 0;
   if (scale <= 0) { return VectorXd::Zero(k); }
   MatrixXd E(k + 1, G.rows());
   E << G.transpose(), h.transpose() / scale;
   const VectorXd r = fit_nonnegative(E, VectorXd::Unit(k + 1, k)).residual;
   if (r[k] <= 1e-12) { return {}; }
   return -scale / r[k] * r.head(k);
}

} // namespace cattaneo
