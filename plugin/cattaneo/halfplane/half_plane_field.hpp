#pragma once

#include <cattaneo/halfplane/half_plane.hpp>
#include <memory>

namespace cattaneo
{

/** Displacements and stresses at any point inside a half-plane under the forces of its contact
    nodes, by the closed-form kernels, without a mesh. The tractions are those of its stiffness
    S = M F⁻¹ M: M⁻¹ times the nodal forces. For the plane only. Displacements are relative to
    the half-plane's depth, whatever holds it there; those of a bulk stress are relative to
    HalfPlane::point. */
class HalfPlaneField
{
public:
   /// @a line is that of the condensed half-plane (CondensedBody::line). @a forces {q; p} act
   /// on its nodes, in their frames. @a bulk is a uniform stress along the surface that acts
   /// too, tension positive. InputError for another formulation than the plane, forces that do
   /// not fit the line, or a bulk stress that is not finite.
   HalfPlaneField(const HalfPlane &body, const ContactLine &line, const Eigen::VectorXd &forces,
                  double bulk = 0);
   ~HalfPlaneField();

   /// In x and y, stresses positive in tension.
   struct Point
   {
      Eigen::Vector2d displacement{0, 0}; ///< relative to the depth
      double xx = 0;                      ///< σ_xx
      double yy = 0;                      ///< σ_yy
      double xy = 0;                      ///< τ_xy
   };
   /// At the surface, stresses are those just below it. InputError for a point above it.
   Point at(const Eigen::Vector2d &position) const;

private:
   struct Tractions;
   std::unique_ptr<const Tractions> tractions_;
};

} // namespace cattaneo
