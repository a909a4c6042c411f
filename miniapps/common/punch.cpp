#include "common/punch.hpp"

#include "common/contact_grid.hpp"
#include "common/miniapp.hpp"

#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;

void PunchOptions::validate() const
{
   require(!grid.empty() || (nodes >= 3 && (nodes - 1) % order == 0), "option --nodes is ",
           nodes, ", must be at least 3 and one more than a multiple of the order ", order);
   check_growth(growth);
   require(plane_stiffness > 0, "stiffness of the half-plane over the block's is ",
           plane_stiffness, ", must be positive");
}

void add_options(Study &study, PunchOptions &options)
{
   study.option(&options.poisson, "poisson", "Poisson's ratio of both bodies.");
   study.options().group("The mesh");
   study.option(&options.order, "order", "Order of the elements.", within(1, 8));
   study.option(&options.nodes, "nodes", "Contact nodes.");
   study.option(
      &options.grading, "grading",
      "Size of the contact elements at the corners over the size in the middle (1: uniform).",
      above_up_to(0, 1));
   study.option(&options.domain, "domain", domain_help, none_or_above(2));
}

Scene make_punch(const PunchOptions &options)
{
   options.validate();
   Scene scene;
   const Material material = unit_material(options.poisson);
   Material plane_material = material;
   if (!std::isnan(options.plane_poisson)) { plane_material.poisson = options.plane_poisson; }
   plane_material.young = options.plane_stiffness * (1 - std::pow(plane_material.poisson, 2));
   const std::vector<double> contact =
      options.grid.empty()
         ? graded_to_ends(1.0, (options.nodes - 1) / options.order, options.grading)
         : options.grid;
   const double smallest = smallest_step(contact), largest = largest_step(contact);

   // Away from the contact elements grow, more slowly where the order is low: a bilinear mesh
   // that is coarse above the contact misses the block's compliance.
   const bool low = options.order == 1 && options.growth == 0;
   const double growth = low ? 1.1 : element_growth(options.growth, options.order);
   const double coarsest = std::max(low ? 0.04 : 0.8 * (growth - 1), largest);
   const auto refined = [&](mfem::Mesh mesh, int body)
   {
      if (options.refine) { options.refine(mesh, body); }
      return mesh;
   };
   const std::vector<double> height = graded(0, 2, smallest, growth, coarsest);
   ElasticBody &block =
      scene.add(refined(rectangle_mesh(contact, height), 0), options.order, material);
   const int bottom = 1, top = 3;
   block.add_pressure("P", top, 0.5);
   block.add_traction("Q", top, 0.5, 0.0);
   block.add_pressure("Q", top, [](double x, double) { return -3 * x; });
   CondensedBody condensed = condense(block, contact_line(block, bottom), condensation());
   if (!options.half_plane)
   {
      scene.reduction = reduce(std::move(condensed));
      return scene;
   }
   if (options.domain == 0)
   {
      HalfPlane plane;
      plane.material = plane_material;
      plane.depth = 1e4;
      scene.reduction = reduce(std::move(condensed), plane);
      return scene;
   }

   mfem::Mesh below = half_plane_mesh(contact, graded(0, 1, smallest, growth, coarsest),
                                      ring_scales(1, options.domain, smallest, growth));
   ElasticBody &plane = scene.add(refined(std::move(below), 1), options.order, plane_material);
   const int surface = 1, far_bottom = 3;
   for (int component : {0, 1}) { plane.fix(far_bottom, component); }
   scene.reduction = stacked(std::move(condensed), plane, contact_line(plane, surface));
   return scene;
}

} // namespace miniapp
