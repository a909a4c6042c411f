#include "common/revolved_receding.hpp"

#include <algorithm>
#include <cattaneo/elastic/graded_mesh.hpp>
#include <cattaneo/input_error.hpp>

namespace miniapp
{

using namespace cattaneo;

void RevolvedOptions::validate() const
{
   require(order >= 1 && order <= 8, "option --order is ", order, ", must be 1 to 8");
   require(spacing > 0 && spacing <= 0.5, "option --spacing is ", spacing,
           ", must be above 0 and at most 0.5 (in t)");
   require(disc_radius > 0, "option --disc-radius is ", disc_radius, ", must be positive");
   require(load_radius > 0 && load_radius <= disc_radius, "option --load-radius is ",
           load_radius, ", must be above 0 and at most the disc's radius ", disc_radius);
   require(domain > disc_radius, "option --domain is ", domain,
           ", must be above the disc's radius ", disc_radius);
   require(poisson > -1 && poisson < 0.5, "option --poisson is ", poisson,
           ", must be between -1 and 0.5");
   require(growth > 1 && growth <= 2, "growth is ", growth, ", must be above 1 and at most 2");
}

RevolvedReceding make_receding(const RevolvedOptions &options)
{
   options.validate();
   RevolvedReceding scene;
   const Material material{1.0, options.poisson, PlaneState::strain};
   const int bottom = 1, right = 2, top = 3;
   const double b = options.disc_radius, R = options.domain;
   // Elements hold as many intervals between nodes as their order says.
   const double h = options.spacing * options.order;
   const std::vector<double> contact = graded(0, b, h, 1.0);
   scene.meshes.push_back(std::make_unique<mfem::Mesh>(
      rectangle_mesh(contact, graded(0, 1, h, options.growth, 0.1))));
   std::vector<double> depth = graded(0, -R, h, options.growth);
   std::reverse(depth.begin(), depth.end());
   scene.meshes.push_back(std::make_unique<mfem::Mesh>(
      rectangle_mesh(joined({contact, graded(b, R, h, options.growth)}), depth)));

   auto add_bodies = [&](Geometry geometry)
   {
      for (auto &mesh : scene.meshes)
      {
         scene.bodies.push_back(
            std::make_unique<ElasticBody>(*mesh, options.order, material, geometry));
         scene.dofs += scene.bodies.back()->space().GetTrueVSize();
      }
      ElasticBody &cylinder = *scene.bodies.back();
      for (int k = 0; k < cylinder.components(); ++k)
      {
         cylinder.fix(BoundaryPart({bottom, right}), k);
      }
   };
   auto condensed = [&](int first)
   {
      const ElasticBody &disc = *scene.bodies[first], &cylinder = *scene.bodies[first + 1];
      return std::make_pair(
         condense(disc, contact_line(disc, bottom)),
         condense(cylinder, contact_line(cylinder, BoundaryPart({top}, 0, 0, b))));
   };
   add_bodies(Geometry::axisymmetric);
   scene.bodies[0]->add_pressure("load", BoundaryPart({top}, 0, 0, options.load_radius), 1.0);
   auto pair = condensed(0);
   const ContactLine above = contact_line(*scene.bodies[0], bottom);
   const ContactLine below = contact_line(*scene.bodies[1], BoundaryPart({top}, 0, 0, b));
   scene.reduction =
      reduce(std::move(pair.first), std::move(pair.second), pair_lines(above, below));
   if (options.torsion)
   {
      add_bodies(Geometry::torsion);
      scene.bodies[2]->add_displacement("rotation", top, 0, 1.0);
      auto twisting = condensed(2);
      scene.reduction.add_torsion(std::move(twisting.first), std::move(twisting.second));
   }
   return scene;
}

} // namespace miniapp
