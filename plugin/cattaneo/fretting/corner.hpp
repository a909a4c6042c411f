#pragma once

#include <cattaneo/readout/edge_fit.hpp>
#include <optional>

namespace cattaneo::fretting
{

/** The corner of a complete contact: a pad and a cracked body of the same material meet,
    bonded, at a point. Angles that each fills there, radians: a square punch on a half-plane
    has π/2 and π. */
struct Corner
{
   double pad_angle = 0.0;  ///< that the pad fills, radians
   double body_angle = 0.0; ///< that the body fills, radians
};

/// The corner of an elastic pad bonded to a rigid body.
struct RigidCorner
{
   double pad_angle = 0.0;    ///< radians
   double poisson = 0.0;      ///< of the body on the rigid one
   bool plane_stress = false; ///< else plane strain
};

/** One of Williams' eigensolutions of the bonded corner. On the interface, at distance r from
    the corner,

        p = K pressure r^{λ-1},   q = K shear r^{λ-1},

    p > 0 in compression, q the traction on the body, > 0 into the contact.

    Similar bodies are a notch that the material fills over pad_angle + body_angle. K is
    normalised as usual by the stress r^{λ-1} on the bisector of the material: K_I > 0 is
    compression across it, K_II > 0 shear σ_rθ with θ from the body to the pad. On a rigid body
    K is the pressure: pressure = 1. */
struct CornerMode
{
   double eigenvalue = 0.0; ///< λ; the stress is singular if λ < 1
   double pressure = 0.0;   ///< p of the mode at unit distance, compression positive
   /// q of the mode at unit distance, positive on the body into the contact
   double shear = 0.0;
   /// Shear on the *pad* into the contact over the pressure. Square punch on a half-plane:
   /// 0.543075578837 in mode I, -0.218923236249 in mode II. It is infinite, with no defined
   /// sign, if the mode has no pressure (equal angles, mode II).
   double traction_ratio() const { return -shear / pressure; }
};

/// In the order of the eigenvalues.
struct CornerModes
{
   CornerMode one;                ///< the stronger singularity
   std::optional<CornerMode> two; ///< none if there is no second real eigenvalue to fit
};

/** Similar bodies: I solves sin λα + λ sin α = 0 and II sin λα - λ sin α = 0, λ ≠ 1, α the sum
    of the angles. Roots by bracketing, to round-off: 0.544483736782 and 0.908529189846 for the
    square punch on a half-plane. Mode II is singular for sums above 257.45° only.
    InputError unless both angles are positive and π < sum <= 2π: a smaller one has no
    singularity. */
CornerModes corner_modes(const Corner &corner);

/** On a rigid body: the roots below 1 of κ sin²λα + λ² sin²α = (κ+1)²/4, clamped and free face
    [Williams 1952], κ = 3-4ν or, in plane stress, (3-ν)/(1+ν). A right angle has one of them,
    0.7112 for ν = 0.3 in plane strain.
    InputError unless 0 < angle < π and 0 <= ν < 0.5; if nothing is singular; and if the roots
    are complex, as for wide angles: the tractions then change sign ever faster towards the
    corner and have no intensity. */
CornerModes corner_modes(const RigidCorner &corner);

/// The fit of the tractions near a corner.
struct CornerFit
{
   FittedIntensity k_one; ///< units: stress · length^{1-λ_I}
   FittedIntensity k_two; ///< units: stress · length^{1-λ_II}; zero without a second mode
   CornerModes modes;     ///< the eigensolutions that were fitted
   /// Friction below which the corner slips however small the load, |q/p| of mode one.
   double least_friction = 0.0;
};

/** The strength of the modes from fully stuck tractions near a corner, by least squares of p
    and q together, both weighted with r^{1-λ_I}, with a term of the next order, r^{λ_I}, for
    each. The window is chosen as that of fit_edge(): the one of least reported error, which is
    the larger of the standard error and the change when those two terms are left out. Nodes
    without pressure count here: a bonded corner may pull. A second mode that is not singular is
    fitted as a regular term.

    @param tractions edge is the position of the corner, shear is that on the body
    InputError as fit_edge(). */
CornerFit fit_corner(const CornerModes &modes, const EdgeTractions &tractions,
                     const FitSettings &settings = {});

} // namespace cattaneo::fretting
