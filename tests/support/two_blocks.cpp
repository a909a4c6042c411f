#include "two_blocks.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem reduce_two_blocks(const TwoBlocks &scene, double friction)
{
   using namespace cattaneo;
   const double L = scene.size, soft = scene.young * std::min(1.0, scene.contrast);
   std::vector<double> contact = graded_to_ends(L, scene.intervals, scene.end_ratio);
   const double first = std::min(0.9 * L, 2 * L / scene.intervals / scene.flat);
   const double growth = scene.flat > 100 ? 4 : 1.7;
   const std::vector<double> up = graded(0, 2 * L, first, growth, 0.9 * L);
   std::vector<double> down = graded(0, -3 * L, first, growth, 0.9 * L);
   std::reverse(down.begin(), down.end());
   std::vector<double> left = graded(-L, -3 * L, 0.2 * L, 1.7);
   std::reverse(left.begin(), left.end());
   mfem::Mesh upper_mesh = rectangle_mesh(contact, up);
   mfem::Mesh lower_mesh =
      rectangle_mesh(joined({left, contact, graded(L, 3 * L, 0.2 * L, 1.7)}), down);
   for (int i = 0; i < lower_mesh.GetNBE(); ++i)
   {
      mfem::Array<int> vertices;
      lower_mesh.GetBdrElementVertices(i, vertices);
      const double middle =
         0.5 * (lower_mesh.GetVertex(vertices[0])[0] + lower_mesh.GetVertex(vertices[1])[0]);
      if (lower_mesh.GetBdrAttribute(i) == 3 && std::abs(middle) < L)
      {
         lower_mesh.SetBdrAttribute(i, 5);
      }
   }
   lower_mesh.SetAttributes();
   ElasticBody upper(upper_mesh, scene.order,
                     Material{scene.young * scene.contrast, scene.poisson});
   ElasticBody lower(lower_mesh, scene.order, Material{scene.young, scene.poisson});
   const double pressure = 1e-3 * soft;
   upper.add_pressure("P", 3, pressure);
   upper.add_traction("Q", 3, pressure, 0.0);
   upper.add_pressure("Q", 3,
                      [=, balance = scene.balance](double x, double)
                      { return -6 * balance * pressure * x / L; });
   for (int component : {0, 1}) { lower.fix(1, component); }
   const CondensedBody a = condense(upper, contact_line(upper, 1));
   const CondensedBody b = condense(lower, contact_line(lower, 5));
   ReducedProblem problem = reduce(a, b, pair_lines(a.line, b.line)).problem;
   for (Eigen::Index i = 0; i < problem.nodes(); ++i)
   {
      const double x = problem.position(i, 0) / L;
      problem.gap[i] = L * (scene.gap + scene.curved_gap * x * x);
   }
   set_friction(problem, friction);
   return problem;
}

} // namespace cattaneo_test
