#include <cattaneo/fretting/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo::fretting
{

using Complex = std::complex<double>;

InPlaneStress half_plane_stress(const Traction &pressure, const Traction &shear, double y)
{
   const Complex i(0, 1);
   const Complex normal = -0.5 * pressure[0], tangential = 0.5 * i * shear[0];
   Complex yy = Complex(2 * normal.real(), 2 * tangential.imag());
   // On the surface the slope may be infinite (contact edge, end of the slip zone), but its
   // product with the depth is zero.
   if (y > 0) { yy += 2.0 * i * y * std::conj(-0.5 * pressure[1] + 0.5 * i * shear[1]); }
   return {4 * (normal + tangential).real() - yy.real(), yy.real(), -yy.imag()};
}

double out_of_plane_constraint(double poisson, bool plane_stress)
{
   require(poisson > -1 && poisson < 0.5, "Poisson's ratio is ", poisson,
           "; it must be above -1 and below 0.5.");
   return plane_stress ? 0.0 : poisson;
}

double von_mises(const InPlaneStress &s, double constraint)
{
   const double sum = s.xx + s.yy, difference = s.xx - s.yy;
   return std::sqrt(0.75 * difference * difference + 3 * s.xy * s.xy +
                    0.25 * std::pow((1 - 2 * constraint) * sum, 2));
}

} // namespace cattaneo::fretting
