#include "fretting/hertz_surface.hpp"

#include <algorithm>
#include <cmath>

namespace miniapp
{

namespace
{

double ellipse_at(double xi)
{
   return std::sqrt(std::max(0.0, 1 - xi * xi));
}

/// σ_xx on the surface due to a shear √(1 - ξ²) along x is -2 times this.
double of_elliptic_shear(double xi)
{
   const double outside = std::sqrt(std::max(0.0, xi * xi - 1));
   return xi - std::copysign(outside, xi);
}

} // namespace

HertzSurface::HertzSurface(const Pad &pad)
   : half_width(pad.half_width_under(pad.normal)),
     stick(half_width *
           std::sqrt(std::max(0.0, 1 - std::abs(pad.shear) / (pad.friction * pad.normal)))),
     shift(0), sign_(pad.shear < 0 ? -1 : 1), peak_(2 * pad.normal / (M_PI * half_width)),
     friction_(pad.friction), bulk_(pad.bulk_or_none())
{
   // In the stick zone the strains of shear and bulk stress cancel.
   shift = sign_ * half_width * (bulk_ - pad.bulk_pad) / (4 * friction_ * peak_);
}

bool HertzSurface::valid() const
{
   return stick > 0 && std::abs(shift) + stick <= half_width;
}

double HertzSurface::pressure(double x) const
{
   return peak_ * ellipse_at(x / half_width);
}

double HertzSurface::shear(double x) const
{
   return sign_ * friction_ * peak_ *
          (ellipse_at(x / half_width) - stick / half_width * ellipse_at((x - shift) / stick));
}

double HertzSurface::stress(double x) const
{
   const double of_shear = of_elliptic_shear(x / half_width) -
                           stick / half_width * of_elliptic_shear((x - shift) / stick);
   return -2 * sign_ * friction_ * peak_ * of_shear - pressure(x) + bulk_;
}

} // namespace miniapp
