#include "contact2d/own_options.hpp"

namespace miniapp
{

void add_options(Study &study, BodyOptions &body, const std::string &k, const char *mesh_help)
{
   study.option(&body.mesh, "mesh" + k, mesh_help, Text::input);
   study.option(
      &body.young, "young" + k, "Young's modulus: one, or one for each element attribute.",
      Check{[](double E) { return E > 0; }, "must be positive, as Young's modulus is"});
   study.option(&body.poisson, "poisson" + k,
                "Poisson's ratio: one, or one for each element attribute.");
   study.option(&body.contact, "contact" + k,
                "Boundary attributes of the contact, as 3 or 3,4 or 3[-1<x<1].",
                Text::attributes);
   study.option(&body.support, "support" + k,
                "Fixed components, as '1:xy 2:x @0,-1:x' (attributes, or the node near a "
                "point).",
                Text::statements);
   study.option(
      &body.load, "load" + k,
      "Loads 'PATTERN KIND WHERE VALUES; …', as 'P pressure 3 100; Q traction 3 1 0'; "
      "kinds: pressure, traction, body-force, displacement-x, displacement-y.",
      Text::statements);
}

void add_options(Study &study, HalfPlaneOptions &half_plane)
{
   study.option(&half_plane.young, "half-plane-young",
                "Young's modulus of a half-plane without a mesh, in place of body 2.",
                positive);
   study.option(&half_plane.poisson, "half-plane-poisson", "Poisson's ratio of the half-plane.",
                between(-1, 0.5));
   study.option(&half_plane.depth, "half-plane-depth",
                "Depth of the half-plane that displacements are relative to; without it none "
                "are given, and none can be prescribed.",
                positive);
   study.options().in_object("half-plane", {"young", "poisson"});
}

} // namespace miniapp
