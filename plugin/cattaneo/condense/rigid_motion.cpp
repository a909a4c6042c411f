#include <Eigen/LU>
#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

/// Factors of a matrix of few columns, by the triangle that they have in common with it.
Eigen::FullPivLU<Eigen::MatrixXd> factors_of(const Eigen::MatrixXd &matrix, double threshold)
{
   const Eigen::MatrixXd R = thin_qr(matrix).R;
   Eigen::MatrixXd square = Eigen::MatrixXd::Zero(matrix.cols(), matrix.cols());
   square.topRows(R.rows()) = R;
   Eigen::FullPivLU<Eigen::MatrixXd> factors(square);
   factors.setThreshold(threshold);
   return factors;
}

} // namespace

std::string DofPlaces::called(int dof) const
{
   return place_text(place(dof), formulation);
}

Eigen::MatrixXd rigid_at(const Eigen::Vector3d &place, const Eigen::Vector3d &centre,
                         int dimension)
{
   const Eigen::Vector3d arm = place - centre;
   Eigen::MatrixXd motions =
      Eigen::MatrixXd::Zero(dimension, dimension + dimension * (dimension - 1) / 2);
   motions.leftCols(dimension).setIdentity();
   if (dimension == 2)
   {
      motions.col(2) << -arm[1], arm[0];
      return motions;
   }
   for (int axis = 0; axis < 3; ++axis)
   {
      motions.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(arm);
   }
   return motions;
}

Eigen::MatrixXd free_rigid_motions(const DofPlaces &places, const std::vector<int> &dofs,
                                   const std::vector<bool> &held)
{
   if (about_axis(places.formulation))
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
   Eigen::AlignedBox3d whole, patch; // of all dofs, of the held ones
   std::vector<int> resting;
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      const Eigen::Vector3d place = places.place(dofs[k]);
      whole.extend(place);
      if (!held[dofs[k]]) { continue; }
      patch.extend(place);
      resting.push_back(static_cast<int>(k));
   }
   const auto half_width = [](const Eigen::AlignedBox3d &box)
   { return 0.5 * box.sizes().maxCoeff(); };
   const Eigen::Vector3d centre = (resting.empty() ? whole : patch).center();
   double scale = half_width(resting.empty() ? whole : patch);
   // With one held node the rotation about it is free, even if round-off gives this patch a
   // size.
   if (scale <= 1e-14 * (centre.lpNorm<1>() + half_width(whole))) { scale = half_width(whole); }
   if (scale <= 0) { scale = 1; }
   // Translations and rotations about the centre, of size one at the scale.
   const int dimension = cattaneo::dimension(places.formulation);
   const Eigen::Vector3d none(0, 0, 0);
   Eigen::MatrixXd rigid(dofs.size(), dimension + dimension * (dimension - 1) / 2);
   for (std::size_t k = 0; k < dofs.size(); ++k)
   {
      const Eigen::Vector3d arm = (places.place(dofs[k]) - centre) / scale;
      rigid.row(k) = rigid_at(arm, none, dimension).row(places.component[dofs[k]]);
   }
   Eigen::MatrixXd motions = Eigen::MatrixXd::Identity(rigid.cols(), rigid.cols());
   if (!resting.empty())
   {
      const auto held_by = factors_of(rows_of(rigid, resting), 1e-9);
      motions = held_by.kernel().leftCols(held_by.dimensionOfKernel());
   }
   Eigen::MatrixXd free = rigid * motions;
   for (const int k : resting) { free.row(k).setZero(); }
   for (auto motion : free.colwise())
   {
      const double largest = motion.cwiseAbs().maxCoeff();
      if (largest > 0) { motion /= largest; }
   }
   // In a set without one of the components, or with one node, motions coincide or vanish.
   if (free.cols() == 0) { return free; }
   const auto differing = factors_of(free, 1e-12);
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
