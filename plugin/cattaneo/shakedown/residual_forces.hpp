#pragma once

#include <Eigen/Dense>
#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/** Contact forces of a locked-in slip while the contact is closed (w = 0, thesis 4.11–4.13):
    residual tangential forces r = A v, and the normal forces B v.

       v = flexibility r + any rigid slip,   B v = transfer r,   rigidᵀ r = 0

    A is singular along the tangential rigid motions of a free body. Because the reduced
    stiffness is positive semidefinite, B v = 0 wherever A v = 0, so the residual forces
    determine every effect of the slip. Friction and loads do not enter. Compute them once and
    reuse them along a sweep. */
struct ResidualForces
{
   Eigen::MatrixXd flexibility; ///< generalised inverse of A, c·n × c·n, symmetric
   Eigen::MatrixXd transfer;    ///< M = B flexibility, n × c·n, dimensionless
   Eigen::MatrixXd rigid;       ///< basis of the slips without force, c·n × k, unit columns
   bool uncoupled = false;      ///< B is zero: slip does not change the pressure
};

/// InputError if the problem has no tangential unknowns, has a gap (use absorb_gap), or if its
/// stiffness is not positive semidefinite.
ResidualForces residual_forces(const ReducedProblem &problem);

/** Degree of coupling: the largest share of its elastic energy that a slip and an opening can
    have in common,

       β = max |wᵀ B v| / √(vᵀ A v · wᵀ C w),   0 ≤ β < 1,

    over the motions that store energy; the spectral norm of C^(-1/2) B A^(-1/2) on the
    complement of the rigid motions. It does not change with units or with any change of basis
    of slips or of openings (A → SᵀAS, C → TᵀCT, B → TᵀBS). On a family of meshes it therefore
    converges to the norm of the continuous operator. For two half-planes it is |β| of [Dundurs
    1969]; β = 0 is an uncoupled problem, for which Melan's theorem holds. */
double degree_of_coupling(const ReducedProblem &problem);

} // namespace cattaneo
