#include <cattaneo/elastic/stress.hpp>
#include <cmath>

namespace cattaneo
{

double Stress::von_mises() const
{
   const double normal = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
   return std::sqrt(0.5 * normal + 3 * xy * xy);
}

Stress stress(const Material &material, double strain_xx, double strain_yy, double shear_angle)
{
   const double spherical = material.lambda() * (strain_xx + strain_yy), mu = material.mu();
   Stress s;
   s.xx = spherical + 2 * mu * strain_xx;
   s.yy = spherical + 2 * mu * strain_yy;
   s.zz = material.state == PlaneState::strain ? material.poisson * (s.xx + s.yy) : 0.0;
   s.xy = mu * shear_angle;
   return s;
}

Stress stress(const Material &material, double strain_rr, double strain_zz, double strain_hoop,
              double shear_angle)
{
   const double spherical = material.lambda() * (strain_rr + strain_zz + strain_hoop);
   const double mu = material.mu();
   return {spherical + 2 * mu * strain_rr, spherical + 2 * mu * strain_zz,
           spherical + 2 * mu * strain_hoop, mu * shear_angle};
}

TorsionStress torsion_stress(const Material &material, double r, double dtwist_dr,
                             double dtwist_dz)
{
   return {material.mu() * r * dtwist_dr, material.mu() * r * dtwist_dz};
}

Stress stress_at(const ElasticBody &body, const mfem::GridFunction &displacement,
                 mfem::ElementTransformation &transformation)
{
   const Material &material = body.material(transformation.Attribute);
   mfem::DenseMatrix gradient;
   displacement.GetVectorGradient(transformation, gradient);
   const double shear_angle = gradient(0, 1) + gradient(1, 0);
   if (body.geometry() == Geometry::plane)
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
