#pragma once

#include <cattaneo/material.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/// On a half-plane itself, from far away: per unit thickness, or about an axis the resultant of
/// the whole circumference, along the axis.
struct FarForce
{
   std::string pattern;   ///< load pattern it belongs to
   Eigen::Vector2d force; ///< per unit multiplier, in x and y
};

/** A uniform stress along the surface of a half-plane, as a specimen has that is pulled:
   tension positive, in the plane along x of a level surface, about an axis the same in all
   directions along it. It strains the surface, which stays where it is at HalfPlane::point; the
   half-plane feels the contact as without it. Its load pattern is one of forces, whose
   conjugate is the volume that the contact adds to the half-plane's extension along the stress:
   that of the uniform strain itself, which has no bound, is left out. */
struct BulkStress
{
   std::string pattern; ///< load pattern it belongs to, which may have a far force as well
   double stress = 0;   ///< per unit multiplier, force per area
};

/// Integrals about an axis of the contact line that was condensed last (an inner matter).
class KeptRings;
/// None of them yet.
std::shared_ptr<KeptRings> keep_rings();

/** An elastic half-plane, in axisymmetry and torsion half-space, with a straight surface: a
    body without a mesh. It is as large as it looks: no domain, and no error of one. */
struct HalfPlane
{
   Material material; ///< of axisymmetry and torsion: plane strain
   /** Depth of the point below each force to which displacements in the plane are relative,
       > 0. Under a force a half-plane moves without bound as the depth grows (a logarithm), so
       a prescribed displacement has no meaning without it. Results under given forces,
       relative displacements of the contact among them, do not depend on it. At least
       twice the length of the contact line, then S is positive definite; 1e4 times is fine. Not
       asked for in axisymmetry, where displacements are relative to infinity. */
   double depth = 0;
   /// A point of the surface, on the axis of symmetry if there is one. Bulk stresses do not
   /// move it.
   Eigen::Vector2d point{0, 0};
   Eigen::Vector2d normal{0, -1}; ///< into the half-plane, a unit vector
   /// In the plane: is the line through `point` along the normal one of symmetry? Contact then
   /// lies on one side of it. The surface must be horizontal or vertical. Not said: there is no
   /// such line; but where a contact line ends at a plane of symmetry (a node that its body
   /// holds along the surface, LineChain::symmetry_turn), as half a model does, it must be
   /// said.
   std::optional<bool> symmetric = {};
   /// What is said of it; nothing said: false.
   bool is_symmetric() const { return symmetric.value_or(false); }
   /** With none it is held: at its depth, in axisymmetry at infinity. With some it goes,
       without turning, where they and the contact take it: load patterns, whose conjugates are
       its displacements there. Beside a plane of symmetry they act along the normal. None of
       them twists. */
   std::vector<FarForce> forces = {};
   /// Uniform stresses along the surface, see there; none of them twists.
   std::vector<BulkStress> bulk = {};
   /// Thickness in the plane, > 0. Forces and stiffness are those of this thickness.
   double thickness = 1;
   /// What condense() has integrated about an axis: the torsion of the same contact line has
   /// the same integrals. Copies share it.
   std::shared_ptr<KeptRings> rings = keep_rings();

   /// How much of its length the surface grows by under a bulk stress of 1: 1/E', about an axis
   /// (1-ν)/E.
   double bulk_strain(Formulation formulation) const;
   /// The sum of its bulk stresses under these multipliers; 0 of loads that are not named.
   double bulk_stress(const NamedLoads &loads) const;

   /// InputError for a material that is none, a normal of another length than 1 (not along the
   /// axis, if there is one), and what is said above.
   void validate(Formulation formulation) const;
};

/** A half-plane condensed to the contact nodes of the body that presses on it: S = M F⁻¹ M,
    where F are the double integrals of the closed-form kernel with the functions of that
    body's trace, and M = ∫ φ_i φ_j (tractions are interpolated as displacements are, each is
    right in the mean with all functions). Symmetric, positive definite, and nodal forces do
    work on nodal displacements.

    @a line: of the body that presses, with its elements of orders 1 to 8. Its nodes are taken
    where they lie over the straight surface, along the normal. The result's line has the nodes
    in reversed order, of its node i the other's n - 1 - i, and all frames along the surface,
    which goes on smoothly. Its dofs are the components of these nodes alone.

    A node on the axis, or on the plane of symmetry, is treated as in a mesh: on the axis it
    carries no force, on the plane of symmetry it does not slip (CondensedBody::held).

    InputError if the line has no elements, if they turn back along the surface or overlap, or
    see HalfPlane. */
CondensedBody condense(const HalfPlane &body, const ContactLine &line);

/// The same on a trace of its own, straight_line() along its surface from `point` on (from the
/// axis; its nodes run with the body on the left, so outwards where that is above): of two
/// half-planes that meet the one, on whose line the other is condensed.
CondensedBody condense(const HalfPlane &body, const std::vector<double> &grid, int order,
                       Formulation formulation = Formulation::plane);

/** Any number of bodies of which one or more stand on one half-plane, with lines that feel each
    other through it: the last body, of number bodies.size(), which is the second side of their
    interfaces. Lines and pairings there, one to one, need not be given. The gap is that of the
    geometry unless it is given, as of a body alone; the half-plane is condensed once, to all
    lines. InputError if none stands on it, if lines overlap along its surface, or as of
    reduce(bodies, interfaces). */
Reduction reduce(std::vector<CondensedBody> bodies, std::vector<Interface> interfaces,
                 const HalfPlane &half_plane);

/// A body pressed on a half-plane. The gap is that of the geometry: how far the body's contact
/// nodes lie from the surface.
Reduction reduce(CondensedBody body, const HalfPlane &half_plane);

} // namespace cattaneo
