#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/elastic/boundary_face.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

BoundaryFace::BoundaryFace(mfem::Mesh &mesh, int boundary_element) : low_(3), high_(3)
{
   mesh.GetBdrElementTransformation(boundary_element, &transformation_);
   low_ = std::numeric_limits<double>::max();
   high_ = -std::numeric_limits<double>::max();
   mfem::Array<int> vertices;
   mesh.GetBdrElementVertices(boundary_element, vertices);
   const mfem::IntegrationRule &ends =
      *mfem::Geometries.GetVertices(mesh.GetBdrElementGeometry(boundary_element));
   for (int k = 0; k < ends.GetNPoints(); ++k)
   {
      const Eigen::Vector3d x = place(ends[k]);
      for (int c = 0; c < 3; ++c)
      {
         low_[c] = std::min(low_[c], x[c]);
         high_[c] = std::max(high_[c], x[c]);
      }
   }
   size_ = std::hypot(high_[0] - low_[0], high_[1] - low_[1], high_[2] - low_[2]);

   // A direction from the middle of the face to the middle of the reference element, mapped by
   // the element's Jacobian, points to the body's side of the face, where both are curved too.
   int element = 0, info = 0;
   mesh.GetBdrElementAdjacentElement(boundary_element, element, info);
   const mfem::Geometry::Type shape = mesh.GetElementBaseGeometry(element);
   const mfem::IntegrationRule &corners = *mfem::Geometries.GetVertices(shape);
   const mfem::IntegrationPoint &centre = mfem::Geometries.GetCenter(shape);
   const int face = info / 64, count = mesh.GetElement(element)->GetNFaceVertices(face);
   const int *its = mesh.GetElement(element)->GetFaceVertices(face);
   mfem::IntegrationPoint middle;
   middle.Set3(0, 0, 0);
   for (int k = 0; k < count; ++k)
   {
      middle.x += corners[its[k]].x / count;
      middle.y += corners[its[k]].y / count;
      middle.z += corners[its[k]].z / count;
   }
   mfem::IsoparametricTransformation solid;
   mesh.GetElementTransformation(element, &solid);
   solid.SetIntPoint(&middle);
   const mfem::DenseMatrix &J = solid.Jacobian();
   const Eigen::Map<const Eigen::Matrix3d> jacobian(J.Data());
   inside_ =
      jacobian * Eigen::Vector3d(centre.x - middle.x, centre.y - middle.y, centre.z - middle.z);
   const mfem::IntegrationPoint &own =
      mfem::Geometries.GetCenter(mesh.GetBdrElementGeometry(boundary_element));
   sign_ = inward(own).dot(inside_) > 0 ? 1 : -1;
}

mfem::ElementTransformation &BoundaryFace::at(const mfem::IntegrationPoint &point)
{
   transformation_.SetIntPoint(&point);
   return transformation_;
}

Eigen::Vector3d BoundaryFace::place(const mfem::IntegrationPoint &point)
{
   mfem::Vector x(3);
   transformation_.Transform(point, x);
   return {x[0], x[1], x[2]};
}

Eigen::Vector3d BoundaryFace::inward(const mfem::IntegrationPoint &point)
{
   const mfem::DenseMatrix &J = at(point).Jacobian();
   const Eigen::Map<const Eigen::Matrix<double, 3, 2>> tangents(J.Data());
   const Eigen::Vector3d one = tangents.col(0), other = tangents.col(1);
   return sign_ * one.cross(other);
}

const mfem::IntegrationRule &BoundaryFace::rule(int order) const
{
   return mfem::IntRules.Get(transformation_.GetGeometryType(),
                             order + 6 + 2 * transformation_.OrderJ());
}

bool BoundaryFace::within(const BoundaryPart &part, const std::string &where)
{
   const double slack = interval_tolerance * size_;
   for (const BoundaryPart::Interval &one : part.intervals())
   {
      const double low = low_[one.axis], high = high_[one.axis];
      // A face across the interval's end at one value of the coordinate lies on its end.
      const bool at_end =
         high - low <= slack && high >= one.lo - slack && low <= one.hi + slack;
      const bool beside = high <= one.lo + slack || low >= one.hi - slack;
      if (beside && !at_end) { return false; }
   }
   const char *names[] = {"x", "y", "z"};
   for (const BoundaryPart::Interval &one : part.intervals())
   {
      const double low = low_[one.axis], high = high_[one.axis];
      require(low >= one.lo - slack && high <= one.hi + slack, where, ": the ", describe(part),
              " cuts a face, which reaches from ", names[one.axis], " = ", low, " to ", high,
              ": in space an interval must end where faces end");
   }
   return true;
}

} // namespace cattaneo
