#pragma once

#include <Eigen/Core>
#include <array>
#include <cattaneo/elastic/boundary_part.hpp>
#include <mfem.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/** One boundary element as a parametrised curve x(s), 0 <= s <= 1 (the element's own reference
    coordinate), with the side of the body. The body is on the side of the mesh element to which
    the edge belongs, however both are numbered or oriented. */
class BoundaryEdge
{
public:
   BoundaryEdge(mfem::Mesh &mesh, int boundary_element);

   Eigen::Vector2d point(double s);
   /// The element's transformation, set to that point, for evaluating coefficients there.
   mfem::ElementTransformation &at(double s);
   /// dx/ds; its length is the Jacobian of the curve.
   Eigen::Vector2d derivative(double s);
   /// Unit tangent with the body on the left.
   Eigen::Vector2d tangent(double s);

   /// True if the body is on the left for growing s.
   bool body_on_left() const { return body_on_left_; }
   /// Length of the two chords through the middle: a scale for tolerances.
   double size() const { return size_; }
   /// Polynomial degree of x(s).
   int degree() const { return transformation_.OrderJ() + 1; }
   /// Gauss points (on [0, 1]) for a load that varies smoothly times a shape function of the
   /// given order: exact on straight edges for a polynomial load of degree 12.
   const mfem::IntegrationRule &rule(int order) const;

   /// The pieces [from, to] of 0 <= s <= 1 that lie in the interval of the part.
   std::vector<std::array<double, 2>> pieces(const BoundaryPart &part);

private:
   mfem::IsoparametricTransformation transformation_;
   mfem::IntegrationPoint point_;
   bool body_on_left_ = true;
   double size_ = 0.0;
};

/// Boundary elements that have an attribute of the part (its interval is ignored). InputError,
/// starting with `where`, if an attribute does not exist (with a list of those that do), the
/// interval is empty or an element is not on the boundary of the mesh.
std::vector<int> boundary_elements(const mfem::Mesh &mesh, const BoundaryPart &part,
                                   const std::string &where);

/// "boundary part with attributes 1, 2 and 0 <= x <= 1", for messages.
std::string describe(const BoundaryPart &part);

/// Coordinates this far outside an interval, relative to the size of the element, are in it.
constexpr double interval_tolerance = 1e-8;

} // namespace cattaneo
