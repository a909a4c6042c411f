//  benchmark_foundation: time and memory from mesh to solved contact
//
//  Each scene runs in a process of its own, so that its time is what a user waits for and its
//  peak memory is its own. Scenes: the punch on a rigid plane with 40 increments; condensation
//  of 17,372 and 262,656 dofs; 100 cycles of shear after condensation.

#include "common/measure.hpp"
#include "common/miniapp.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cstdio>
#include <cstdlib>

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

struct Block
{
   mfem::Mesh mesh;
   std::unique_ptr<ElasticBody> body;
   Reduction reduction;
};

/// Uniform block of 2 × height, bilinear, loaded by P and Q on top.
std::unique_ptr<Block> make_block(int columns, int rows, double height, bool held)
{
   auto block = std::make_unique<Block>();
   block->mesh = mfem::Mesh::MakeCartesian2D(columns, rows, mfem::Element::QUADRILATERAL, true,
                                             2.0, height);
   block->body = std::make_unique<ElasticBody>(block->mesh, 1, Material{0.91, 0.3});
   ElasticBody &body = *block->body;
   body.add_pressure("P", 3, 0.5);
   body.add_traction("Q", 3, 0.5, 0.0);
   body.add_pressure("Q", 3, [=](double x, double) { return 1.5 * height * (1 - x); });
   if (held)
   {
      body.fix(3, 0);
      body.fix(3, 1);
   }
   block->reduction = reduce(condense(body, contact_line(body, 1)));
   set_friction(block->reduction.problem, 0.2);
   return block;
}

void punch()
{
   auto block = make_block(100, 50, 2.0, false);
   MarchSettings settings;
   settings.increments = 20;
   settings.single_increment_if_exact = false;
   ContactState state = ContactState::virgin(block->reduction.problem);
   const MarchReport report =
      march(block->reduction.problem,
            LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.18)}), state,
            settings);
   if (report.counters.increments != 40) { std::exit(3); }
}

void medium()
{
   make_block(100, 85, 2.0, true);
}
void large()
{
   make_block(512, 255, 1.0, true);
}

void cycles()
{
   auto block = make_block(100, 50, 2.0, false);
   FrictionSolver solver(block->reduction.problem);
   ContactState state = ContactState::virgin(block->reduction.problem);
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.16), Vector2d(1, -0.16), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = 100;
   MarchSettings settings;
   settings.increments_of_piece = {1, 5, 10, 5};
   settings.stop_at_steady_state = false;
   const miniapp::Stopwatch watch;
   const MarchReport report = march(solver, history, state, settings);
   std::printf(
      "  (100 cycles of 20 increments: %.3f s after condensation, %.2f active-set steps an "
      "increment)\n",
      watch.seconds(), double(report.counters.newton_steps) / report.counters.increments);
   if (report.counters.increments != 2001) { std::exit(3); }
}

struct Scene
{
   const char *what;
   void (*run)();
};

const Scene scenes[] = {
   {"10,302 dofs, 101 nodes, 40 increments", punch},
   {"17,372 dofs to 202, with assembly", medium},
   {"262,656 dofs to 1,026, with assembly", large},
   {"10,302 dofs, 100 cycles of 20 increments", cycles},
};

} // namespace

int main()
{
   std::printf("%-44s %9s %9s %9s\n", "from mesh to answer", "seconds", "CPU", "MB");
   for (const Scene &scene : scenes)
   {
      // The best of three: what the machine can do when nothing disturbs it.
      Measured best;
      for (int k = 0; k < 3; ++k)
      {
         const Measured m = in_own_process(
            [&]
            {
               scene.run();
               return std::vector<double>();
            });
         if (!m.ok)
         {
            std::fprintf(stderr, "error: the scene of %s failed\n", scene.what);
            return 1;
         }
         if (k == 0 || m.wall < best.wall) { best = m; }
      }
      std::printf("%-44s %9.3f %9.3f %9.0f\n", scene.what, best.wall, best.cpu, best.megabytes);
   }
   return 0;
}
