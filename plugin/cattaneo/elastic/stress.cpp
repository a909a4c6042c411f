#include <cattaneo/elastic/stress.hpp>
#include <cmath>

namespace cattaneo
{

double Stress::von_mises() const
{
   const double normal = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
   return std::sqrt(0.5 * normal + 3 * (xy * xy + yz * yz + xz * xz));
}

Stress stress(const Material &material, const Strain &strain)
{
   // In plane stress λ already is the value for a strain that is free across the plane.
   const bool plane = material.state == PlaneState::stress;
   const double mu = material.mu(), spherical = material.lambda() * (strain.xx + strain.yy +
                                                                     (plane ? 0 : strain.zz));
   return {spherical + 2 * mu * strain.xx,
           spherical + 2 * mu * strain.yy,
           plane ? 0 : spherical + 2 * mu * strain.zz,
           mu * strain.xy,
           mu * strain.yz,
           mu * strain.xz};
}

} // namespace cattaneo
