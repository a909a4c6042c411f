#pragma once

#include <cattaneo/halfplane/half_plane.hpp>
#include <memory>

namespace cattaneo
{

/** Displacements and stresses inside of a half-plane under the forces of its contact nodes, by
    the closed-form kernels: at any point, without a mesh. The tractions are those that its
    stiffness S = M F⁻¹ M knows, M⁻¹ times the nodal forces. Of the plane; displacements are
    relative to the half-plane's depth, whatever it stands on, those of a bulk stress to the
    point of its surface, HalfPlane::point. */
class HalfPlaneField
{
public:
   /// @a line: of the condensed half-plane (CondensedBody::line). @a forces: on its nodes,
   /// {q; p} in their frames. @a bulk: uniform stress along the surface that acts beside them,
   /// tension positive. InputError for another formulation than the plane, forces that do not
   /// fit the line, or a bulk stress that is not finite.
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
   /// On the surface stresses are those just below it. InputError for a point above it.
   Point at(const Eigen::Vector2d &position) const;

private:
   struct Tractions;
   std::unique_ptr<const Tractions> tractions_;
};

} // namespace cattaneo
