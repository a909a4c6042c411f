#include "punch_problem.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem punch_problem(int nodes, bool half_plane)
{
   using namespace cattaneo;
   const int order = 2, bottom = 1, top = 3, surface = 1, far_bottom = 3;
   const Material material{0.91, 0.3, PlaneState::strain};
   const std::vector<double> contact = graded_to_ends(1.0, (nodes - 1) / order, 0.05);
   const double smallest = contact[1] - contact[0];
   mfem::Mesh mesh = rectangle_mesh(contact, graded(0, 2, smallest, 1.3, 0.2));
   ElasticBody block(mesh, order, material);
   block.add_pressure("P", top, 0.5);
   block.add_traction("Q", top, 0.5, 0.0);
   block.add_pressure("Q", top, [](double x, double) { return -3 * x; });
   CondensedBody condensed = condense(block, contact_line(block, bottom));
   if (!half_plane) { return reduce(std::move(condensed)).problem; }
   mfem::Mesh plane_mesh = half_plane_mesh(contact, graded(0, 1, smallest, 1.3, 0.2),
                                           ring_scales(1, 1e3, smallest, 1.3));
   ElasticBody plane(plane_mesh, order, material);
   for (int component : {0, 1}) { plane.fix(far_bottom, component); }
   const ContactLine facing = contact_line(plane, surface);
   const Pairing pairing = pair_lines(condensed.line, facing);
   return reduce(std::move(condensed), condense(plane, facing), pairing).problem;
}

} // namespace cattaneo_test
