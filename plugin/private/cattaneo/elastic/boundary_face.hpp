#pragma once

#include <Eigen/Core>
#include <cattaneo/elastic/boundary_part.hpp>
#include <mfem.hpp>
#include <string>

namespace cattaneo
{

/** One boundary element of a mesh in space, with the side of the body. That is the side of the
    mesh element to which the face belongs, however both are numbered or oriented. */
class BoundaryFace
{
public:
   BoundaryFace(mfem::Mesh &mesh, int boundary_element);

   /// The transformation with this point set, for functions that are evaluated there.
   mfem::ElementTransformation &at(const mfem::IntegrationPoint &point);
   Eigen::Vector3d place(const mfem::IntegrationPoint &point);
   /// The normal into the body; its length is the Jacobian of the face.
   Eigen::Vector3d inward(const mfem::IntegrationPoint &point);
   /// From the middle of the face into the body, however the face is oriented.
   const Eigen::Vector3d &inside() const { return inside_; }
   /// Diameter of the box around its vertices: a scale for tolerances.
   double size() const { return size_; }
   /// Points for a load that varies smoothly times a shape function of the given order: exact
   /// on plane triangles and parallelograms for a polynomial load of degree 6.
   const mfem::IntegrationRule &rule(int order) const;

   /// Does the whole face lie within the interval of the part? InputError, which begins with
   /// `where`, if a part of it does: in space no face is cut.
   bool within(const BoundaryPart &part, const std::string &where);

private:
   mfem::IsoparametricTransformation transformation_;
   mfem::Vector low_, high_; ///< of the box around its vertices
   Eigen::Vector3d inside_{0, 0, 0};
   double sign_ = 1, size_ = 0;
};

} // namespace cattaneo
