//  benchmark_shakedown: time of certified shakedown limits, alone and along a sweep
//
//  A square block on a rigid plane, graded to its corners: single limits with 101 to 513
//  contact nodes, and the map of figure 4.18, 4 reversals by 12 friction coefficients, with 145
//  nodes.

#include "common/miniapp.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cstdio>

using namespace cattaneo;

namespace
{

ReducedProblem punch(int nodes)
{
   const std::vector<double> contact = graded_to_ends(1.0, (nodes - 1) / 2, 0.01);
   mfem::Mesh mesh = rectangle_mesh(contact, graded(0, 2, contact[1] - contact[0], 1.25, 0.2));
   ElasticBody block(mesh, 2, Material{0.91, 0.3, PlaneState::strain});
   const int bottom = 1, top = 3;
   block.add_pressure("P", top, 0.5);
   block.add_traction("Q", top, 0.5, 0.0);
   block.add_pressure("Q", top, [](double x, double) { return -3 * x; });
   ReducedProblem problem = reduce(condense(block, contact_line(block, bottom))).problem;
   set_friction(problem, 0.85);
   return problem;
}

} // namespace

int main()
{
   std::printf(" nodes   preparation   largest load              smallest friction\n"
               "                   s   s      (iterations, gap)    s      (programmes, gap)\n");
   for (const int nodes : {101, 201, 513})
   {
      const ReducedProblem reduced = punch(nodes);
      const miniapp::Stopwatch watch;
      const LimitProblem problem =
         limit_problem(reduced, held_and_cycled(reduced, "P", 1, "Q", -0.5));
      const double preparation = watch.seconds();
      const LimitReport load = load_limit(problem);
      const LimitReport friction = friction_limit(problem, 0.6);
      std::printf("%6d %13.3f   %-6.3f (%d, %.0e)         %-6.3f (%ld, %.0e)   %s, %s\n", nodes,
                  preparation, load.seconds, load.iterations, load.upper - load.lower,
                  friction.seconds, friction.counters.limit_solves,
                  friction.upper - friction.lower, name(load.status), name(friction.status));
   }

   const miniapp::Stopwatch watch;
   const ReducedProblem reduced = punch(145);
   LimitProblem problem = limit_problem(reduced, held_and_cycled(reduced, "P", 1, "Q", -1));
   int certified = 0, iterations = 0;
   for (const double reversal : {-1.0, -0.75, -0.5, 0.0})
   {
      problem.cycle = held_and_cycled(reduced, "P", 1, "Q", reversal);
      LimitReport last;
      for (int k = 0; k < 12; ++k)
      {
         set_friction(problem.reduced, 0.55 + 0.05 * k);
         LimitSettings settings;
         if (k > 0) { settings.start = &last; }
         LimitReport next = load_limit(problem, settings);
         certified += next.status == LimitStatus::certified;
         iterations += next.iterations;
         last = std::move(next);
      }
   }
   std::printf(
      "map of 48 limits, 145 nodes, from the mesh: %.2f s, %d certified, %.1f iterations "
      "each\n",
      watch.seconds(), certified, iterations / 48.0);
   return 0;
}
