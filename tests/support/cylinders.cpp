#include "cylinders.hpp"

#include "elastic_support.hpp"

#include <cmath>

namespace cattaneo_test
{

using support::block;

mfem::Mesh cylinder(const std::string &kind, double inner, int nr, int nz)
{
   mfem::Mesh mesh = block(kind == "triangles" ? kind : "quads", nr, nz);
   const auto distort = [&](double r, double z, double *to)
   {
      const double bubble = std::sin(0.5 * M_PI * r) * std::sin(M_PI * z);
      to[0] = inner + r + 0.12 * bubble;
      to[1] = z - 0.09 * bubble;
   };
   if (kind == "curved")
   {
      mesh.SetCurvature(2);
      // MFEM 4.6 takes no lambda that captures.
      mfem::VectorFunctionCoefficient distorted(2, [&](const mfem::Vector &x, mfem::Vector &y)
                                                { distort(x(0), x(1), y.GetData()); });
      mesh.Transform(distorted);
      return mesh;
   }
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      distort(x[0], x[1], x);
   }
   return mesh;
}

} // namespace cattaneo_test
