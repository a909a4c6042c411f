#include "common/punch.hpp"

#include <algorithm>
#include <cattaneo/elastic/graded_mesh.hpp>
#include <cattaneo/input_error.hpp>

namespace miniapp
{

using namespace cattaneo;

void PunchOptions::validate() const
{
   require(order >= 1 && order <= 8, "option --order is ", order, ", must be 1 to 8");
   require(nodes >= 3 && (nodes - 1) % order == 0, "option --nodes is ", nodes,
           ", must be at least 3 and one more than a multiple of the order ", order);
   require(grading > 0 && grading <= 1, "option --grading is ", grading,
           ", must be above 0 and at most 1");
   require(growth > 1 && growth <= 2, "growth is ", growth, ", must be above 1 and at most 2");
   require(domain > 2, "option --domain is ", domain, ", must be above 2 (in a)");
}

Punch make_punch(const PunchOptions &options)
{
   options.validate();
   Punch punch;
   const Material material{1 - options.poisson * options.poisson, options.poisson,
                           PlaneState::strain};
   const std::vector<double> contact =
      graded_to_ends(1.0, (options.nodes - 1) / options.order, options.grading);
   const double smallest = contact[1] - contact[0];
   const double largest = contact[contact.size() / 2 + 1] - contact[contact.size() / 2];

   // From the contact upward, no coarser than a tenth of the height.
   const std::vector<double> height =
      graded(0, 2, smallest, options.growth, std::max(0.2, largest));
   punch.meshes.push_back(std::make_unique<mfem::Mesh>(rectangle_mesh(contact, height)));
   punch.bodies.push_back(
      std::make_unique<ElasticBody>(*punch.meshes[0], options.order, material));
   ElasticBody &block = *punch.bodies[0];
   const int bottom = 1, top = 3;
   block.add_pressure("P", top, 0.5);
   block.add_traction("Q", top, 0.5, 0.0);
   block.add_pressure("Q", top, [](double x, double) { return -3 * x; });
   CondensedBody condensed = condense(block, contact_line(block, bottom));
   punch.dofs = block.space().GetTrueVSize();
   if (!options.half_plane)
   {
      punch.reduction = reduce(std::move(condensed));
      return punch;
   }

   const double L = options.domain;
   std::vector<double> left = graded(-1, -L, smallest, options.growth);
   std::reverse(left.begin(), left.end());
   const std::vector<double> width =
      joined({left, contact, graded(1, L, smallest, options.growth)});
   std::vector<double> depth = graded(0, -L, smallest, options.growth);
   std::reverse(depth.begin(), depth.end());
   punch.meshes.push_back(std::make_unique<mfem::Mesh>(rectangle_mesh(width, depth)));
   punch.bodies.push_back(
      std::make_unique<ElasticBody>(*punch.meshes[1], options.order, material));
   ElasticBody &plane = *punch.bodies[1];
   plane.fix(bottom, 0);
   plane.fix(bottom, 1);
   const ContactLine facing = contact_line(plane, BoundaryPart({top}, 0, -1, 1));
   const Pairing pairing = pair_lines(condensed.line, facing);
   punch.dofs += plane.space().GetTrueVSize();
   punch.reduction = reduce(std::move(condensed), condense(plane, facing), pairing);
   return punch;
}

} // namespace miniapp
