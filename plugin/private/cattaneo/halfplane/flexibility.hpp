#pragma once

#include <cattaneo/halfplane/kernel_integrals.hpp>
#include <cattaneo/material.hpp>

namespace cattaneo
{

/** Flexibility of a half-plane (or half-space) for tractions Σ t_j φ_j on its surface. F t are
    the integrals of the displacements with the functions, ∫ φ_i u, in local right-handed frames
    with the normal into the body. All tangential unknowns come first, then all normal ones;
    torsion has the twist alone. Symmetric to the last bit. */
using Flexibility = Eigen::MatrixXd;

/** Plane strain or stress, x along the tangent (Timoshenko and Goodier, Theory of Elasticity,
    art. 36; E' = Material::plane_modulus(), G the shear modulus):

       u_x = 2/(πE') ∫ (ln D/|x-s| + κ) t_x ds - β ∫ sgn(x-s) t_y ds,   β = (1-2ν)(1+ν)/2E
       u_y = 2/(πE') ∫ (ln D/|x-s| - κ) t_y ds + β ∫ sgn(x-s) t_x ds,   κ = E'/4G

    relative to the point at the depth D below each force. If x = 0 is a plane of symmetry,
    beside which the trace lies, the forces of its mirror image act as well. InputError if D is
    less than twice the length of the trace, with its image. */
Flexibility plane_flexibility(const SurfaceTrace &trace, const Material &material, double depth,
                              bool symmetric);

/** Axisymmetry, x = r; with J the Bessel functions and p = t_z, q = t_r of rings
    ([Johnson 1985], 3.8),

       u_r = (1-ν)/G ∫∫ J₁(kr) J₁(ks) dk q s ds + side (1-2ν)/2G ∫_{s<r} p s/r ds
       u_z = (1-ν)/G ∫∫ J₀(kr) J₀(ks) dk p s ds + side (1-2ν)/2G ∫_{s>r} q ds

    relative to infinity, in frames whose tangent runs outwards (side -1) or inwards (side 1),
    all integrated over the circumference. `rings` are the integrals of the trace. */
Flexibility axisymmetric_flexibility(const SurfaceTrace &trace, const RingIntegrals &rings,
                                     const Material &material, double side);

/// Torsion, unknowns ψ = u_θ/r: u_θ = 1/G ∫∫ J₁(kr) J₁(ks) dk t_θ s ds, t_θ = r Σ t_j φ_j, and
/// a force does work with the lever r. `rings` are the integrals of the trace.
Flexibility torsion_flexibility(const RingIntegrals &rings, const Material &material);

} // namespace cattaneo
