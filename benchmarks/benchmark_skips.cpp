//  benchmark_skips: what a scene does not need is not done: counters and gains
//
//  Each row runs one scene twice: as it is, and so that it needs what it would otherwise skip.
//  Both counts are of the reports' counters; seconds are processor time, the best of several.

#include "common/disc_scene.hpp"
#include "common/hertz_scene.hpp"
#include "common/punch.hpp"
#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cstdio>
#include <ctime>
#include <functional>

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

/// What a run does that is worth timing, and what it counts.
using Run = std::function<long()>;

void row(const char *skipped, const char *counter, const Run &without, const Run &with)
{
   double seconds[2];
   long count[2];
   const Run *const runs[] = {&without, &with};
   for (int k = 0; k < 2; ++k)
   {
      seconds[k] = 1e300;
      for (int repeat = 0; repeat < 3; ++repeat)
      {
         const std::clock_t began = std::clock();
         count[k] = (*runs[k])();
         seconds[k] = std::min(seconds[k], double(std::clock() - began) / CLOCKS_PER_SEC);
      }
   }
   std::printf("%-58s %-22s %6ld %6ld %8.4f %8.4f %7.1f\n", skipped, counter, count[0],
               count[1], seconds[0], seconds[1], seconds[1] / seconds[0]);
   std::fflush(stdout);
}

/// Punch on a rigid plane, in thesis units; loads P and Q.
miniapp::Scene punch(bool half_plane = false, double plane_stiffness = 1)
{
   miniapp::PunchOptions options;
   options.half_plane = half_plane;
   options.domain = 1e4;
   options.plane_stiffness = plane_stiffness;
   return miniapp::make_punch(options);
}

ReducedProblem punch_problem(double friction)
{
   ReducedProblem problem = punch().reduction.problem;
   set_friction(problem, friction);
   return problem;
}

Counters marched(const ReducedProblem &problem, const std::vector<Eigen::VectorXd> &points,
                 const MarchSettings &settings = {}, int cycles = 0)
{
   LoadHistory history = LoadHistory::through(points);
   if (cycles > 0)
   {
      history.cycle_start = 1;
      history.cycles = cycles;
   }
   ContactState state = ContactState::virgin(problem);
   return march(problem, history, state, settings).counters;
}

} // namespace

int main()
{
   std::printf("%-58s %-22s %6s %6s %8s %8s %7s\n", "skipped", "counter", "as is", "needed",
               "s as is", "s needed", "gain");
   const Eigen::VectorXd none = Vector2d(0, 0), pressed = Vector2d(1, 0),
                         sheared = Vector2d(1, 0.15), back = Vector2d(1, -0.15);
   const ReducedProblem smooth = punch_problem(0), rough = punch_problem(0.2);
   MarchSettings cut;
   cut.single_increment_if_exact = false;

   row(
      "frictionless contact: no tangential unknowns", "tangential_unknowns",
      [&]
      {
         return marched(smooth, {none, pressed}, cut).increments,
                FrictionSolver(smooth).counters().tangential_unknowns;
      },
      [&]
      {
         return marched(rough, {none, pressed}, cut).increments,
                FrictionSolver(rough).counters().tangential_unknowns;
      });
   row(
      "first proportional loading without a gap: one increment", "increments",
      [&] {
         return marched(rough, {none, pressed}).increments;
      },
      [&] {
         return marched(rough, {none, pressed}, cut).increments;
      });
   MarchSettings all_cycles;
   all_cycles.stop_at_steady_state = false;
   row(
      "steady state reached: 100 cycles are not marched", "increments",
      [&] {
         return marched(rough, {none, pressed, sheared, back, pressed}, {}, 100).increments;
      },
      [&]
      {
         return marched(rough, {none, pressed, sheared, back, pressed}, all_cycles, 100)
            .increments;
      });
   row(
      "rigid obstacle: one body", "factorisations",
      [] { return punch().reduction.counters.factorisations; },
      [] { return punch(true).reduction.counters.factorisations; });
   miniapp::HalfPlanes equal;
   equal.nodes = 201;
   equal.domain = 1e4;
   miniapp::Scene pair = miniapp::make_scene(equal);
   ElasticBody &upper = *pair.bodies[0], &lower = *pair.bodies[1];
   const ContactLine above = contact_line(upper, 1), below = contact_line(lower, 1);
   const CondensedBody first = condense(upper, above);
   row(
      "two equal bodies: one factorisation", "factorisations",
      [&] { return condense(lower, below, {}, &first).counters.factorisations; },
      [&] { return condense(lower, below).counters.factorisations; });
   row(
      "20 load steps: loads are condensed once a pattern", "back_substitutions",
      [&] { return condense(lower, below, {}, &first).counters.back_substitutions; },
      [&]
      {
         long count = 0;
         for (int k = 0; k < 20; ++k)
         {
            count += condense(lower, below, {}, &first).counters.back_substitutions;
         }
         return count;
      });
   const auto disc = [](miniapp::Twist twist)
   {
      miniapp::DiscOptions options;
      options.domain = 100;
      options.spacing = 0.05;
      options.twist = twist;
      return miniapp::make_disc(options).reduction.counters.assemblies;
   };
   row(
      "no torsion: no torsion operator", "assemblies",
      [&] { return disc(miniapp::Twist::none); }, [&] { return disc(miniapp::Twist::top); });
   miniapp::Scene block = punch();
   set_friction(block.reduction.problem, 0.2);
   const auto with_fields = [&](bool wanted)
   {
      const ReducedProblem &problem = block.reduction.problem;
      ContactState state = ContactState::virgin(problem);
      const long before = block.reduction.counters.field_recoveries;
      march(problem, LoadHistory::through({none, pressed, sheared}), state, {},
            [&](const ContactState &now, const IncrementRecord &)
            {
               if (wanted) { block.reduction.displacement(0, now.v, now.w, now.multipliers); }
            });
      return block.reduction.counters.field_recoveries - before;
   };
   row(
      "no fields requested: none recovered", "field_recoveries",
      [&] { return with_fields(false); }, [&] { return with_fields(true); });

   ReducedProblem uncoupled = pair.reduction.problem;
   for (Eigen::Index i = 0; i < uncoupled.nodes(); ++i)
   {
      const double x = uncoupled.position(i, 0);
      uncoupled.gap[i] = x * x / (M_PI * M_PI); // of half-width 1 under the load 1, roughly
   }
   set_friction(uncoupled, 0.3);
   ReducedProblem coupled = uncoupled;
   // Couple the bodies by so little that results do not change. Rigid motions must stay free,
   // so their part is removed.
   Eigen::VectorXd both = Eigen::VectorXd::Zero(coupled.K.rows());
   both[0] = both[coupled.slips()] = 1;
   both -= coupled.rigid_motions * (coupled.rigid_motions.transpose() * both);
   coupled.K += 1e-9 * coupled.C().maxCoeff() * both * both.transpose();
   complete(coupled);
   const Eigen::VectorXd normal = Vector2d(1, 0), shear = Vector2d(1, 0.2);
   row(
      "uncoupled bodies: pressed in one increment, gaps apart", "increments",
      [&] {
         return marched(uncoupled, {none, normal, shear}).increments;
      },
      [&] {
         return marched(coupled, {none, normal, shear}).increments;
      });
   return 0;
}
