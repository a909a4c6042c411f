#include <Eigen/LU>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

/// Factors of a matrix of up to three columns; columns that it lacks are zero.
Eigen::FullPivLU<Eigen::Matrix3d> three_columns(const Eigen::MatrixXd &matrix, double threshold)
{
   const Eigen::MatrixXd R = thin_qr(matrix).R;
   Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
   square.topLeftCorner(R.rows(), R.cols()) = R;
   Eigen::FullPivLU<Eigen::Matrix3d> factors(square);
   factors.setThreshold(threshold);
   return factors;
}

} // namespace

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
   Eigen::AlignedBox2d whole, patch; // of all dofs, of the held ones
   std::vector<std::size_t> resting;
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      const Eigen::Vector2d place(places.x[dofs[k]], places.y[dofs[k]]);
      whole.extend(place);
      if (!held[dofs[k]]) { continue; }
      patch.extend(place);
      resting.push_back(k);
   }
   const auto half_width = [](const Eigen::AlignedBox2d &box)
   { return 0.5 * box.sizes().maxCoeff(); };
   const Eigen::Vector2d centre = (resting.empty() ? whole : patch).center();
   double scale = half_width(resting.empty() ? whole : patch);
   // One held node: turning about it is free, whatever round-off says of its spread.
   if (scale <= 1e-14 * (centre.lpNorm<1>() + half_width(whole))) { scale = half_width(whole); }
   if (scale <= 0) { scale = 1; }
   // x, y and the rotation about the centre, of size one at the scale.
   Eigen::MatrixXd rigid(dofs.size(), 3);
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      const double dx = (places.x[dofs[k]] - centre[0]) / scale,
                   dy = (places.y[dofs[k]] - centre[1]) / scale;
      if (places.component[dofs[k]] == 0) { rigid.row(k) << 1, 0, -dy; }
      else { rigid.row(k) << 0, 1, dx; }
   }
   Eigen::MatrixXd motions = Eigen::Matrix3d::Identity();
   if (!resting.empty())
   {
      const auto held_by = three_columns(rigid(resting, Eigen::all), 1e-9);
      motions = held_by.kernel().leftCols(held_by.dimensionOfKernel());
   }
   Eigen::MatrixXd free = rigid * motions;
   for (const std::size_t k : resting) { free.row(k).setZero(); }
   for (auto motion : free.colwise())
   {
      const double largest = motion.cwiseAbs().maxCoeff();
      if (largest > 0) { motion /= largest; }
   }
   // In a set without y, or with one node, motions coincide or vanish.
   if (free.cols() == 0) { return free; }
   const auto differing = three_columns(free, 1e-12);
   if (differing.rank() == free.cols()) { return free; }
   const Eigen::VectorXi order = differing.permutationQ().indices();
   return free(Eigen::all, order.head(differing.rank()));
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
