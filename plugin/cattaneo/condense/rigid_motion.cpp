#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

Eigen::MatrixXd free_rigid_motions(const DofPlaces &places, const std::vector<int> &dofs,
                                   const std::vector<bool> &held)
{
   if (places.formulation != Formulation::plane)
   {
      const int last = components(places.formulation) - 1; // the component that moves
      const auto moves = [&](int dof) { return places.component[dof] == last; };
      const bool holds = std::any_of(dofs.begin(), dofs.end(),
                                     [&](int dof) { return held[dof] && moves(dof); });
      Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(dofs.size(), holds ? 0 : 1);
      for (std::size_t k = 0; !holds && k < dofs.size(); ++k)
      {
         motion(k, 0) = moves(dofs[k]) ? 1.0 : 0.0;
      }
      return motion;
   }
   // Centre and half width of a bounding box, of all dofs or of the held ones.
   struct Box
   {
      double x = 0.0, y = 0.0, size = 0.0;
   };
   const auto box_of = [&](bool held_only)
   {
      const double inf = std::numeric_limits<double>::infinity();
      double lo[2] = {inf, inf}, hi[2] = {-inf, -inf};
      for (int dof : dofs)
      {
         if (held_only && !held[dof]) { continue; }
         const double point[2] = {places.x[dof], places.y[dof]};
         for (int c = 0; c < 2; ++c)
         {
            lo[c] = std::min(lo[c], point[c]);
            hi[c] = std::max(hi[c], point[c]);
         }
      }
      return Box{0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]),
                 0.5 * std::max(hi[0] - lo[0], hi[1] - lo[1])};
   };
   const auto count =
      std::count_if(dofs.begin(), dofs.end(), [&](int dof) { return held[dof]; });
   const Box whole = box_of(false);
   Eigen::Matrix3d motions = Eigen::Matrix3d::Identity();
   Box patch = whole;
   int rank = 0;
   if (count > 0)
   {
      patch = box_of(true);
      // One held node: turning about it is free, whatever round-off says of its spread.
      if (patch.size <= 1e-14 * (std::abs(patch.x) + std::abs(patch.y) + whole.size))
      {
         patch.size = whole.size;
      }
      const double scale = patch.size > 0 ? patch.size : 1.0;
      Eigen::MatrixXd rows(count, 3);
      Eigen::Index k = 0;
      for (int dof : dofs)
      {
         if (!held[dof]) { continue; }
         if (places.component[dof] == 0)
         {
            rows.row(k++) << 1, 0, -(places.y[dof] - patch.y) / scale;
         }
         else { rows.row(k++) << 0, 1, (places.x[dof] - patch.x) / scale; }
      }
      // Singular values of the rows are those of their triangular factor.
      const Eigen::MatrixXd R = Eigen::HouseholderQR<Eigen::MatrixXd>(rows).matrixQR().topRows(
         std::min<Eigen::Index>(count, 3));
      const Eigen::MatrixXd upper = R.triangularView<Eigen::Upper>();
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullV);
      for (Eigen::Index i = 0; i < svd.singularValues().size(); ++i)
      {
         if (svd.singularValues()[i] > 1e-9 * svd.singularValues()[0]) { ++rank; }
      }
      motions = svd.matrixV();
      motions.row(2) /= scale;
   }
   else { motions(2, 2) = whole.size > 0 ? 1 / whole.size : 1.0; }

   Eigen::MatrixXd free(dofs.size(), 3 - rank);
   for (int m = 0; m < free.cols(); ++m)
   {
      const Eigen::Vector3d motion = motions.col(rank + m);
      for (std::size_t k = 0; k < dofs.size(); ++k)
      {
         const int dof = dofs[k];
         const bool along_x = places.component[dof] == 0;
         free(k, m) = along_x ? motion[0] - motion[2] * (places.y[dof] - patch.y)
                              : motion[1] + motion[2] * (places.x[dof] - patch.x);
         if (held[dof]) { free(k, m) = 0.0; }
      }
      const double largest = free.col(m).cwiseAbs().maxCoeff();
      if (largest > 0) { free.col(m) /= largest; }
   }
   // Of a set without any y, or of one node, motions are the same or none at all.
   if (free.cols() == 0) { return free; }
   Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(free);
   factor.setThreshold(1e-12);
   const Eigen::Index independent = factor.rank();
   if (independent == free.cols()) { return free; }
   Eigen::MatrixXd kept =
      factor.householderQ() * Eigen::MatrixXd::Identity(free.rows(), independent);
   for (Eigen::Index m = 0; m < independent; ++m)
   {
      kept.col(m) /= kept.col(m).cwiseAbs().maxCoeff();
   }
   return kept;
}

Eigen::MatrixXd unresisted(const SparseView &K, const std::vector<int> &dofs,
                           const Eigen::MatrixXd &motions)
{
   if (motions.cols() == 0) { return motions; }
   std::vector<int> place(K.rows(), -1);
   for (std::size_t k = 0; k < dofs.size(); ++k) { place[dofs[k]] = static_cast<int>(k); }
   Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(dofs.size(), motions.cols());
   Eigen::MatrixXd sizes = forces;
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      for (SparseView::InnerIterator e(K, dofs[k]); e; ++e)
      {
         const auto motion = motions.row(place[e.col()]);
         forces.row(k) += e.value() * motion;
         sizes.row(k) += std::abs(e.value()) * motion.cwiseAbs();
      }
   }
   return motions * unresisted_combinations(motions.transpose() * forces,
                                            motions.cwiseAbs().cwiseProduct(sizes).sum());
}

Eigen::MatrixXd unresisted_combinations(const Eigen::MatrixXd &energy, double size)
{
   if (energy.cols() == 0) { return energy; }
   const SymmetricModes modes = symmetric_modes(0.5 * (energy + energy.transpose()));
   // Matrices of other programs have 13 digits.
   return modes.vectors.leftCols((modes.values.array() <= 1e-13 * size).count());
}

} // namespace cattaneo
