#include "common/twisted_bodies.hpp"

#include "common/contact_grid.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>

namespace miniapp
{

using namespace cattaneo;

Scene make_scene(const TwistedBodies &options)
{
   const int bottom = 1, side = 2, top = 3;
   const std::vector<double> &contact = options.contact;
   const double last = contact.back() - contact[contact.size() - 2];
   const std::vector<double> radii =
      joined({contact, graded(contact.back(), options.far, last, options.growth)});
   const std::vector<double> up =
      graded(0, options.far, smallest_step(contact), options.growth);
   std::vector<double> down;
   for (auto z = up.rbegin(); z != up.rend(); ++z) { down.push_back(-*z); }
   down.back() = 0;
   const BoundaryPart upper_far({side, top}), lower_far({bottom, side}),
      above({bottom}, 0, 0, contact.back()), below({top}, 0, 0, contact.back());
   const Material material{1.0, options.poisson};
   Scene scene;
   ElasticBody &upper = scene.add(rectangle_mesh(radii, up), options.order, material,
                                  Formulation::axisymmetric),
               &lower = scene.add(rectangle_mesh(radii, down), options.order, material,
                                  Formulation::axisymmetric);
   scene.add_torsion(options.order, material);
   ElasticBody &turned = *scene.torsion[0], &held = *scene.torsion[1];
   upper.fix(upper_far, 0);
   upper.add_displacement("approach", upper_far, 1, -1.0);
   lower.fix(lower_far, 0);
   lower.fix(lower_far, 1);
   turned.add_displacement("twist", upper_far, 0, 1.0);
   held.fix(lower_far, 0);
   const ContactLine one = contact_line(upper, above), other = contact_line(lower, below);
   scene.reduction =
      reduce(condense(upper, one), condense(lower, other), pair_lines(one, other));
   scene.reduction.add_torsion(condense(turned, contact_line(turned, above)),
                               condense(held, contact_line(held, below)));
   ReducedProblem &problem = scene.reduction.problem;
   problem.gap = problem.position.col(0).cwiseAbs2() / (2 * options.sphere);
   return scene;
}

} // namespace miniapp
