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

Stress stress(const Material &material, const Strain &strain)
{
   return material.state == PlaneState::stress
             ? stress(material, strain.xx, strain.yy, strain.xy)
             : stress(material, strain.xx, strain.yy, strain.zz, strain.xy);
}

TorsionStress torsion_stress(const Material &material, double r, double dtwist_dr,
                             double dtwist_dz)
{
   return {material.mu() * r * dtwist_dr, material.mu() * r * dtwist_dz};
}

} // namespace cattaneo
