#include <cattaneo/mesh/filled_corner.hpp>

#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

FilledCorner filled_corner(mfem::Mesh &mesh, const Eigen::Vector2d &point)
{
   FilledCorner corner;
   for (int element = 0; element < mesh.GetNE(); ++element)
   {
      const mfem::IntegrationRule &vertices =
         *mfem::Geometries.GetVertices(mesh.GetElementBaseGeometry(element));
      mfem::ElementTransformation &map = *mesh.GetElementTransformation(element);
      const int count = vertices.GetNPoints();
      for (int k = 0; k < count; ++k)
      {
         const mfem::IntegrationPoint &here = vertices.IntPoint(k);
         map.SetIntPoint(&here);
         mfem::Vector at(2);
         map.Transform(here, at);
         const mfem::DenseMatrix &J = map.Jacobian();
         // The element's two edges at this vertex: a curved one by its tangent.
         const auto edge = [&](int other)
         {
            const mfem::IntegrationPoint &there = vertices.IntPoint(other);
            const double x = there.x - here.x, y = there.y - here.y;
            return Eigen::Vector2d(J(0, 0) * x + J(0, 1) * y, J(1, 0) * x + J(1, 1) * y);
         };
         const Eigen::Vector2d next = edge((k + 1) % count),
                               last = edge((k + count - 1) % count);
         const double distance = std::hypot(at[0] - point[0], at[1] - point[1]);
         if (distance > 1e-6 * next.norm()) { continue; }
         corner.angle +=
            std::abs(std::atan2(next[0] * last[1] - next[1] * last[0], next.dot(last)));
         const int attribute = mesh.GetAttribute(element);
         require(corner.attribute == 0 || corner.attribute == attribute,
                 "elements of the attributes ", corner.attribute, " and ", attribute,
                 " meet at the corner ", point,
                 ", must be one attribute: exponents are known for one material on each side "
                 "of the contact only");
         corner.attribute = attribute;
      }
   }
   require(corner.attribute > 0, "the point ", point, " is not a vertex of the mesh");
   return corner;
}

} // namespace cattaneo
