#include "contact/own_bodies.hpp"

#include <algorithm>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/filled_corner.hpp>
#include <cmath>

/// The moduli and angles of the bodies, for edges and corners of contact.
namespace miniapp
{

using namespace cattaneo;

namespace
{

bool similar(const Material &a, const Material &b)
{
   return a.young == b.young && a.poisson == b.poisson;
}

} // namespace

double OwnBodies::modulus() const
{
   const Material &m = materials[0][0];
   if (materials.size() == 1 || materials[0].size() > 1 || materials[1].size() > 1 ||
       !similar(m, materials[1][0]))
   {
      return 0;
   }
   return fretting::contact_modulus(m.young, m.poisson, m.state == PlaneState::stress);
}

fretting::CornerModes OwnBodies::corner(int end) const
{
   struct Wedge
   {
      double angle; ///< that the body fills
      Material material;
   };
   const auto wedge = [&](int body, bool at_first)
   {
      if (half_plane && body == 1) { return Wedge{std::acos(-1.0), half_plane->material}; }
      const auto &nodes = line(body).nodes;
      const FilledCorner filled =
         filled_corner(*scene.meshes[body], (at_first ? nodes.front() : nodes.back()).position);
      const std::size_t last = materials[body].size() - 1;
      return Wedge{filled.angle,
                   materials[body][std::min<std::size_t>(filled.attribute - 1, last)]};
   };
   const Wedge pad = wedge(0, end > 0);
   if (materials.size() == 1)
   {
      return fretting::corner_modes(fretting::RigidCorner{
         pad.angle, pad.material.poisson, pad.material.state == PlaneState::stress});
   }
   const Wedge body = wedge(1, end < 0);
   require(similar(pad.material, body.material),
           "the bodies have different materials at this corner, and exponents are known for "
           "one material only");
   const double gap = 2 * std::acos(-1.0) - pad.angle - body.angle;
   require(gap > 1e-6, "the surfaces of both bodies go on smoothly there, so the contact line "
                       "is too short: name more of the boundary as contact");
   return fretting::corner_modes(fretting::Corner{pad.angle, body.angle});
}

} // namespace miniapp
