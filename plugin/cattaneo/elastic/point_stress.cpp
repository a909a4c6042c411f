#include <cattaneo/elastic/point_stress.hpp>
#include <cmath>

namespace cattaneo
{

Stress stress_at(const ElasticBody &body, const mfem::GridFunction &displacement,
                 mfem::ElementTransformation &transformation)
{
   const Material &material = body.material(transformation.Attribute);
   mfem::DenseMatrix gradient;
   displacement.GetVectorGradient(transformation, gradient);
   const double shear_angle = gradient(0, 1) + gradient(1, 0);
   if (body.formulation() == Formulation::plane)
   {
      return stress(material, gradient(0, 0), gradient(1, 1), shear_angle);
   }
   mfem::Vector x(2), u(2);
   transformation.Transform(transformation.GetIntPoint(), x);
   displacement.GetVectorValue(transformation, transformation.GetIntPoint(), u);
   // Round-off of u_r over a tiny radius would be no strain.
   const double size = std::sqrt(std::abs(transformation.Weight()));
   const double hoop = x(0) > 1e-9 * size ? u(0) / x(0) : gradient(0, 0);
   return stress(material, gradient(0, 0), gradient(1, 1), hoop, shear_angle);
}

TorsionStress torsion_stress_at(const ElasticBody &body, const mfem::GridFunction &twist,
                                mfem::ElementTransformation &transformation)
{
   mfem::Vector x(2), gradient(2);
   transformation.Transform(transformation.GetIntPoint(), x);
   twist.GetGradient(transformation, gradient);
   return torsion_stress(body.material(transformation.Attribute), x(0), gradient(0),
                         gradient(1));
}

} // namespace cattaneo
