#include <algorithm>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <sstream>

namespace cattaneo
{

BoundaryEdge::BoundaryEdge(mfem::Mesh &mesh, int boundary_element)
{
   mesh.GetBdrElementTransformation(boundary_element, &transformation_);
   size_ = (point(0.5) - point(0.0)).norm() + (point(1.0) - point(0.5)).norm();

   // A direction that points into the reference element, mapped to the plane, points to the
   // body's side of the tangent also where element and edge are curved.
   int element = 0, info = 0;
   mesh.GetBdrElementAdjacentElement(boundary_element, element, info);
   const mfem::Geometry::Type shape = mesh.GetElementBaseGeometry(element);
   const int *ends = mesh.GetElement(element)->GetEdgeVertices(info / 64);
   const mfem::IntegrationRule &corners = *mfem::Geometries.GetVertices(shape);
   const mfem::IntegrationPoint &centre = mfem::Geometries.GetCenter(shape);
   mfem::IntegrationPoint edge_middle;
   edge_middle.Set2(0.5 * (corners[ends[0]].x + corners[ends[1]].x),
                    0.5 * (corners[ends[0]].y + corners[ends[1]].y));
   mfem::IsoparametricTransformation plane;
   mesh.GetElementTransformation(element, &plane);
   plane.SetIntPoint(&edge_middle);
   const mfem::DenseMatrix &J = plane.Jacobian();
   const double dx = centre.x - edge_middle.x, dy = centre.y - edge_middle.y;
   const double inward[2] = {J(0, 0) * dx + J(0, 1) * dy, J(1, 0) * dx + J(1, 1) * dy};
   const auto along = derivative(0.5);
   body_on_left_ = along[0] * inward[1] - along[1] * inward[0] > 0;
}

Eigen::Vector2d BoundaryEdge::point(double s)
{
   mfem::Vector x(2);
   mfem::IntegrationPoint ip;
   ip.Set1w(s, 0.0);
   transformation_.Transform(ip, x);
   return {x(0), x(1)};
}

mfem::ElementTransformation &BoundaryEdge::at(double s)
{
   point_.Set1w(s, 0.0);
   transformation_.SetIntPoint(&point_);
   return transformation_;
}

Eigen::Vector2d BoundaryEdge::derivative(double s)
{
   const mfem::DenseMatrix &J = at(s).Jacobian();
   return {J(0, 0), J(1, 0)};
}

Eigen::Vector2d BoundaryEdge::tangent(double s)
{
   return (body_on_left_ ? 1.0 : -1.0) * derivative(s).normalized();
}

const mfem::IntegrationRule &BoundaryEdge::rule(int order) const
{
   // On a straight edge the rule is exact for a shape function times a load of degree 12. On a
   // curved one the length of the derivative is not a polynomial, so many points are used. That
   // is cheap, because the sum is over the boundary only.
   const int g = degree();
   return mfem::IntRules.Get(mfem::Geometry::SEGMENT,
                             g == 1 ? order + 12 : std::min(2 * order + 4 * g + 12, 60));
}

std::vector<std::array<double, 2>> BoundaryEdge::pieces(const BoundaryPart &part)
{
   const auto coordinate = [&](double s) { return point(s)[part.axis]; };
   // Find where the curve crosses the ends of the interval. Samples are so dense that there is
   // at most one turning point between two of them.
   const int samples = degree() == 1 ? 1 : 4 * degree();
   std::vector<double> cuts{0.0, 1.0};
   for (double bound : {part.lo, part.hi})
   {
      if (!std::isfinite(bound)) { continue; }
      const auto distance = [&](double s) { return coordinate(s) - bound; };
      double before = distance(0.0);
      for (int k = 0; k < samples; ++k)
      {
         const double a = static_cast<double>(k) / samples, b = (k + 1.0) / samples;
         const double after = distance(b);
         if (before == 0) { cuts.push_back(a); }
         else if ((before < 0) != (after < 0)) { cuts.push_back(find_root(distance, a, b)); }
         before = after;
      }
   }
   std::sort(cuts.begin(), cuts.end());
   std::vector<std::array<double, 2>> inside;
   for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
   {
      if (cuts[k + 1] - cuts[k] < 1e-15) { continue; }
      const double middle = coordinate(0.5 * (cuts[k] + cuts[k + 1]));
      if (middle >= part.lo && middle <= part.hi) { inside.push_back({cuts[k], cuts[k + 1]}); }
   }
   return inside;
}

std::string describe(const BoundaryPart &part)
{
   std::vector<std::string> attributes;
   for (int a : part.attributes) { attributes.push_back(std::to_string(a)); }
   std::ostringstream text;
   text << "boundary part with attribute" << (attributes.size() > 1 ? "s " : " ")
        << listed(attributes);
   const char *names[] = {"x", "y", "z"};
   for (const BoundaryPart::Interval &one : part.intervals())
   {
      if (!std::isfinite(one.lo) && !std::isfinite(one.hi)) { continue; }
      text << " and " << one.lo << " <= " << names[one.axis] << " <= " << one.hi;
   }
   return text.str();
}

std::vector<int> boundary_elements(const mfem::Mesh &mesh, const BoundaryPart &part,
                                   const std::string &where)
{
   const bool space = mesh.Dimension() == 3;
   for (const BoundaryPart::Interval &one : part.intervals())
   {
      require(one.axis >= 0 && one.axis < mesh.Dimension(), where, ": axis of the interval is ",
              one.axis, ", must be ", space ? "0 (x), 1 (y) or 2 (z)" : "0 (x) or 1 (y)");
      require(one.lo <= one.hi, where, ": interval from ", one.lo, " to ", one.hi,
              ", must not be empty");
   }
   require(space || part.also.empty(), where, ": a part of a plane body has ",
           part.also.size() + 1, " intervals, must have one");
   require(!part.attributes.empty(), where,
           ": no boundary attribute is named, must be at least one");
   std::vector<std::string> known;
   for (int a : mesh.bdr_attributes) { known.push_back(std::to_string(a)); }
   for (int a : part.attributes)
   {
      require(mesh.bdr_attributes.Find(a) >= 0, where, ": the mesh has no boundary attribute ",
              a, "; it has: ", known.empty() ? "none" : listed(known));
   }
   const int largest = mesh.bdr_attributes.Max();
   require(part.marked == 0 || part.marked == largest, where, ": the boundary marker has ",
           part.marked, " entries, must have ", largest,
           " (one for each boundary attribute up to the largest)");
   std::vector<int> elements;
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      const int attribute = mesh.GetBdrAttribute(i);
      if (std::find(part.attributes.begin(), part.attributes.end(), attribute) ==
          part.attributes.end())
      {
         continue;
      }
      int element = 0, info = 0;
      mesh.GetBdrElementAdjacentElement(i, element, info);
      mfem::Array<int> faces, orientations;
      if (space) { mesh.GetElementFaces(element, faces, orientations); }
      else { mesh.GetElementEdges(element, faces, orientations); }
      require(!mesh.FaceIsInterior(faces[info / 64]), where, ": boundary element ", i,
              " (attribute ", attribute,
              ") lies between two elements, must be on the outer boundary");
      elements.push_back(i);
   }
   return elements;
}

} // namespace cattaneo
