#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;

namespace
{

/// Rigid motions of the traces of bodies about a point, with rotations divided by a size.
MatrixXd about(const CondensedBody &body, const Eigen::Vector3d &centre, double size)
{
   MatrixXd R = body.rigid_motions(centre);
   const Index translations = dimension(body.line.formulation);
   if (R.cols() > 1) { R.rightCols(R.cols() - translations) /= size; }
   return R;
}

/** Rigid motions that all bodies of a group may do, as columns of coefficients. The free
    motions of a body are a part of the rigid motions, so that each direction of these is either
    free or not. The values are therefore 0 or 1 (for hinges only approximately, depending on
    their distance). */
MatrixXd common_coefficients(const std::vector<CondensedBody> &bodies,
                             const std::vector<int> &group, const Eigen::Vector3d &centre,
                             double size)
{
   MatrixXd resisted;
   for (int b : group)
   {
      const ThinQR R = thin_qr(about(bodies[b], centre, size));
      const MatrixXd &Q = bodies[b].free_motions;
      MatrixXd rest = R.Q;
      add_product(rest, Q, transposed_product(Q, R.Q), -1);
      const SymmetricModes modes = symmetric_modes(transposed_product(rest, rest));
      const Index held = (modes.values.array() > 1e-9).count();
      // Motions Rc that are free: those whose part along the resisted directions vanishes.
      MatrixXd rows = transposed_product(modes.vectors.rightCols(held), R.R);
      for (Index k = 0; k < rows.rows(); ++k) { rows.row(k).normalize(); }
      resisted.conservativeResize(resisted.rows() + held, R.R.cols());
      resisted.bottomRows(held) = rows;
   }
   const SymmetricModes modes = symmetric_modes(transposed_product(resisted, resisted));
   return modes.vectors.leftCols((modes.values.array() < 1e-14).count());
}

} // namespace

MatrixXd common_motions(const std::vector<CondensedBody> &bodies, const std::vector<int> &group,
                        const RelativeDisplacement &map)
{
   Eigen::AlignedBox3d box;
   for (int b : group)
   {
      const Eigen::MatrixX3d places = bodies[b].places();
      for (Index i = 0; i < places.rows(); ++i) { box.extend(Eigen::Vector3d(places.row(i))); }
   }
   const double size = box.diagonal().norm() > 0 ? box.diagonal().norm() : 1;
   const MatrixXd c = common_coefficients(bodies, group, box.center(), size);
   MatrixXd motions = MatrixXd::Zero(map.size(), c.cols());
   if (c.cols() == 0) { return motions; }
   for (int b : group)
   {
      motions.middleRows(map.offsets[b], static_cast<Index>(map.free[b].size())) =
         rows_of(product(about(bodies[b], box.center(), size), c), map.free[b]);
   }
   return thin_qr(motions).Q;
}

MatrixXd motions_apart(const std::vector<CondensedBody> &bodies,
                       const RelativeDisplacement &map, const MatrixXd &Y)
{
   MatrixXd all = MatrixXd::Zero(map.size(), 0);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const MatrixXd &own = bodies[b].free_motions;
      all.conservativeResizeLike(MatrixXd::Zero(map.size(), all.cols() + own.cols()));
      all.rightCols(own.cols())
         .middleRows(map.offsets[b], static_cast<Index>(map.free[b].size())) =
         rows_of(own, map.free[b]);
   }
   if (Y.cols() == 0) { return all; }
   const MatrixXd along = transposed_product(Y, all);
   const SymmetricModes modes = symmetric_modes(transposed_product(along, along));
   return product(all, modes.vectors.leftCols(all.cols() - Y.cols()));
}

} // namespace cattaneo
