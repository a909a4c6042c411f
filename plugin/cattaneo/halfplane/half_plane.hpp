#pragma once

#include <cattaneo/material.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cattaneo
{

/// A force on the half-plane itself, from far away. It is per unit thickness; about an axis it
/// is the resultant over the whole circumference, along the axis.
struct FarForce
{
   std::string pattern;   ///< load pattern it belongs to
   Eigen::Vector2d force; ///< per unit multiplier, in x and y
};

/** A uniform stress along the surface of a half-plane, as in a specimen under tension
    (positive). About an axis it is the same in all directions along the surface. It strains the
    surface, but HalfPlane::point keeps its place. The stiffness of the contact does not change.
    Its load pattern is one of forces. The conjugate is the volume that the contact adds to the
    half-plane's extension along the stress. The extension by the uniform strain itself is
    infinite and left out. */
struct BulkStress
{
   std::string pattern; ///< load pattern it belongs to, which may have a far force as well
   double stress = 0;   ///< per unit multiplier, force per area
};

/// Internal: the axisymmetric integrals of the contact line that was condensed last.
class KeptRings;
/// Makes an empty cache.
std::shared_ptr<KeptRings> keep_rings();

/** An elastic half-plane (in axisymmetry and torsion a half-space) with a straight surface: a
    body without a mesh. It is truly infinite, so there is no error of a finite domain. */
struct HalfPlane
{
   Material material; ///< must be plane strain in axisymmetry and torsion
   /** Depth of the point below each force to which displacements in the plane are relative, >
       0. The displacement under a force grows with the depth without bound (a logarithm), so a
       prescribed displacement has no meaning without a depth. Results under given forces,
       relative displacements of the contact among them, do not depend on it. It must be at
       least twice the length of the contact line, so that S is positive definite; 1e4 times is
       fine. Not needed in axisymmetry, where displacements are relative to infinity. */
   double depth = 0;
   /// A point of the surface, on the axis of symmetry if there is one. Bulk stresses do not
   /// move it.
   Eigen::Vector2d point{0, 0};
   Eigen::Vector2d normal{0, -1}; ///< into the half-plane, a unit vector
   /// In the plane: is the line through `point` along the normal a plane of symmetry? Contact
   /// then lies on one side of it, and the surface must be horizontal or vertical. Not given
   /// means no. It must be given, either way, if a contact line ends at a plane of symmetry, as
   /// in half a model (a node that its body holds along the surface, LineChain::symmetry_turn).
   std::optional<bool> symmetric = {};
   /// The given value; false if there is none.
   bool is_symmetric() const { return symmetric.value_or(false); }
   /** Without far forces the half-plane is held at its depth, in axisymmetry at infinity. With
       far forces it moves freely under them and the contact, without rotation. They are load
       patterns, whose conjugates are the half-plane's displacements far away. With a plane of
       symmetry they must act along the normal. None of them twists. */
   std::vector<FarForce> forces = {};
   /// Uniform stresses along the surface, see BulkStress. None of them twists.
   std::vector<BulkStress> bulk = {};
   /// Thickness in the plane, > 0. Forces and stiffness are those of this thickness.
   double thickness = 1;
   /// Axisymmetric integrals that condense() keeps, because the torsion of the same contact
   /// line needs them again. Copies share them.
   std::shared_ptr<KeptRings> rings = keep_rings();

   /// Strain of the surface under a bulk stress of 1: 1/E', about an axis (1-ν)/E.
   double bulk_strain(Formulation formulation) const;
   /// The sum of the bulk stresses under these multipliers, which are 0 for loads that are not
   /// named.
   double bulk_stress(const NamedLoads &loads) const;

   /// InputError for a material that is not valid, a normal of another length than 1 (or not
   /// along the axis, if there is one), or if a condition above is not met.
   void validate(Formulation formulation) const;
};

/** A half-plane condensed to the contact nodes of the body that presses on it: S = M F⁻¹ M. F
    are the double integrals of the closed-form kernel with the functions of that body's trace,
    and M = ∫ φ_i φ_j. Tractions and displacements are interpolated with the same functions and
    agree with the kernel in the mean with each of them. S is symmetric and positive definite,
    and nodal forces do work on nodal displacements.

    @a line is that of the body that presses, with elements of orders 1 to 8. Its nodes are
    projected onto the straight surface along the normal. The line of the result has the nodes
    in reversed order: its node i is node n - 1 - i of @a line. All its frames are along the
    surface, which goes on smoothly. Its only dofs are the components of these nodes.

    A node on the axis, or on the plane of symmetry, is treated as in a mesh: on the axis it
    carries no force, on the plane of symmetry it does not slip (CondensedBody::held).

    InputError if the line has no elements, if they turn back along the surface or overlap, or
    as of HalfPlane::validate(). */
CondensedBody condense(const HalfPlane &body, const ContactLine &line);

/// The same on its own trace, for the first of two half-planes that meet; the second is
/// condensed to the line of the first. The trace is straight_line() along the surface from
/// `point` on (about an axis from the axis on). Its nodes run with the body on the left, that
/// is outwards if the body is above.
CondensedBody condense(const HalfPlane &body, const std::vector<double> &grid, int order,
                       Formulation formulation = Formulation::plane);

/** Any number of bodies, of which one or more stand on one half-plane and influence each other
    through it. The half-plane is the last body, with number bodies.size(), and the second side
    of their interfaces. Its lines and the pairings, one to one, need not be given. The gap is
    that of the geometry unless it is given, as for a single body. The half-plane is condensed
    once, to all lines. InputError if no body stands on it, if lines overlap along its surface,
    or as of reduce(bodies, interfaces). */
Reduction reduce(std::vector<CondensedBody> bodies, std::vector<Interface> interfaces,
                 const HalfPlane &half_plane);

/// A body pressed on a half-plane. The gap is that of the geometry: the distance of the body's
/// contact nodes from the surface.
Reduction reduce(CondensedBody body, const HalfPlane &half_plane);

} // namespace cattaneo
