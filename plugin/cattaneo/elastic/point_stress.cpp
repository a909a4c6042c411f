#include <cattaneo/elastic/point_stress.hpp>
#include <cmath>

namespace cattaneo
{

Stress stress_at(const ElasticBody &body, const mfem::GridFunction &displacement,
                 mfem::ElementTransformation &transformation, const NamedLoads &loads)
{
   if (body.stress_law()) { return body.stress_law()(displacement, transformation, loads); }
   const Material material = body.material(transformation);
   mfem::DenseMatrix gradient;
   displacement.GetVectorGradient(transformation, gradient);
   Strain strain{gradient(0, 0), gradient(1, 1), 0, gradient(0, 1) + gradient(1, 0)};
   if (body.formulation() == Formulation::space)
   {
      strain.zz = gradient(2, 2);
      strain.yz = gradient(1, 2) + gradient(2, 1);
      strain.xz = gradient(0, 2) + gradient(2, 0);
   }
   if (body.formulation() == Formulation::axisymmetric)
   {
      mfem::Vector x(2), u(2);
      transformation.Transform(transformation.GetIntPoint(), x);
      displacement.GetVectorValue(transformation, transformation.GetIntPoint(), u);
      // Very near the axis u_r / r is round-off over a tiny radius. Take its limit there.
      const double size = std::sqrt(std::abs(transformation.Weight()));
      strain.zz = x(0) > 1e-9 * size ? u(0) / x(0) : gradient(0, 0);
   }
   strain.add(-1, body.initial_strain(transformation, loads));
   return stress(material, strain);
}

TorsionStress torsion_stress_at(const ElasticBody &body, const mfem::GridFunction &twist,
                                mfem::ElementTransformation &transformation)
{
   mfem::Vector x(2), gradient(2);
   transformation.Transform(transformation.GetIntPoint(), x);
   twist.GetGradient(transformation, gradient);
   const double factor = body.material(transformation).mu() * x(0);
   return {factor * gradient(0), factor * gradient(1)};
}

} // namespace cattaneo
