#pragma once

#include <cattaneo/condense/assembled_body.hpp>

namespace cattaneo
{

/// Rigid motions that the supports leave free.
struct FreeMotions
{
   int count = 0;           ///< the supports leave free; motions that K does not resist follow
   Eigen::MatrixXd contact; ///< at the contact dofs, one column per motion
   Eigen::MatrixXd resultant; ///< work of each pattern's forces (columns) on each motion
};

/// Free motions of a body whose contact dofs are given. InputError if some motions stay free
/// even with the contact nodes held.
FreeMotions find_free_motions(const AssembledBody &body, const std::vector<int> &contact);

/** Properties of a free body: rigid motions meet no resistance, and the clamped contact
    balances the loads. In exact arithmetic nothing changes if these properties are imposed. In
    floating point a motion that is large far from the contact (turning a half-plane of 10⁴
    contact widths) would leave round-off of 10⁻⁴ of the stiffness. All in global components. */
class Equilibrium
{
public:
   explicit Equilibrium(const FreeMotions &free);
   /// Imposes them on the contact forces of the clamped loads, one column per pattern.
   void impose_on_forces(Eigen::MatrixXd &f) const;
   /// Imposes them on the reduced stiffness S.
   void impose_on_stiffness(Eigen::MatrixXd &S) const;
   /// The motions of the contact dofs, orthonormal columns.
   const Eigen::MatrixXd &motions() const { return Q_; }

private:
   Eigen::MatrixXd Q_;
   Eigen::MatrixXd balance_; ///< Qᵀ f
};

} // namespace cattaneo
