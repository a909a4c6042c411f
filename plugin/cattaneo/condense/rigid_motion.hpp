#pragma once

#include <Eigen/Dense>
#include <cattaneo/algebra/shared_matrix.hpp>
#include <cattaneo/formulation.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// The place of each true dof: its node's coordinates and its component.
struct DofPlaces
{
   Eigen::VectorXd x;          ///< coordinate of the node of each dof, r about an axis
   Eigen::VectorXd y;          ///< the other one, z about an axis
   std::vector<int> component; ///< of each dof: 0 along x (r) or the twist, 1 along y (z)
   Formulation formulation = Formulation::plane; ///< decides which motions are rigid
   Eigen::VectorXd z = {};                       ///< in space the third coordinate, else none

   /// Coordinates of the node of a dof; z is 0 except in space.
   Eigen::Vector3d place(int dof) const
   {
      return {x[dof], y[dof], formulation == Formulation::space ? z[dof] : 0.0};
   }
   /// The same as a text for messages: "(x, y)", in space "(x, y, z)".
   std::string called(int dof) const;
};

/** Displacements of a place in rigid motions, as columns: the translations, then the rotations
    about `centre`. In the plane two and one, in space three and three (about x, y and z); the
    third component of a plane place is 0.
    @param dimension 2 or 3, the rows */
Eigen::MatrixXd rigid_at(const Eigen::Vector3d &place, const Eigen::Vector3d &centre,
                         int dimension);

/** Rigid motions of a set of dofs (plane: x, y, rotation; in space three translations and three
    rotations; axisymmetric: along the axis; torsion: about it) that vanish at the held ones, as
    independent columns over the dofs of the set, each scaled to a largest entry of about 1. The
    rank is decided relative to the distances between the held nodes, so that a small patch
    holds a large body as well as a large patch does. */
Eigen::MatrixXd free_rigid_motions(const DofPlaces &places, const std::vector<int> &dofs,
                                   const std::vector<bool> &held);

/// An orthogonal set of combinations of the given motions that K does not resist: a user's
/// operator may contain elastic foundations. `motions` are columns over `dofs`, a union of
/// whole components.
Eigen::MatrixXd unresisted(const SparseView &K, const std::vector<int> &dofs,
                           const Eigen::MatrixXd &motions);

/// Combinations of motions, orthonormal columns, whose energy is the round-off of a matrix of
/// 13 digits. Given are the energies of each two motions, Rᵀ K R, and the sum over all motions
/// of |r|ᵀ |K| |r|, the energy with every entry taken positive. A foundation below 1e-13 of
/// that sum cannot be distinguished from none.
Eigen::MatrixXd unresisted_combinations(const Eigen::MatrixXd &energy, double size);

} // namespace cattaneo
