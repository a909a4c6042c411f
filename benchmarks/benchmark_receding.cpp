//  benchmark_receding: whole studies of receding contact, from mesh to result
//
//  The lap joint on a converged mesh, 3 cycles of 40 increments; and the map of separation and
//  stick of the plane receding contact on a half-plane, 15 overhangs by 4 coefficients of
//  friction.

#include "common/lap_joint_scene.hpp"
#include "common/miniapp.hpp"
#include "common/receding.hpp"

#include <cattaneo/friction/march.hpp>
#include <cstdio>

using namespace cattaneo;
using Eigen::Vector2d;
using Eigen::VectorXd;

int main()
{
   std::printf("%-52s %9s %11s\n", "study", "seconds", "condensing");
   {
      const miniapp::Stopwatch watch;
      miniapp::LapJointOptions options;
      options.spacing = 0.00625;
      miniapp::Scene joint = miniapp::make_lap_joint(options);
      const double condensed = watch.seconds();
      set_friction(joint.reduction.problem, 0.2);
      LoadHistory history = LoadHistory::through(
         {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.04), Vector2d(1, 0)});
      history.cycle_start = 1;
      history.cycles = 3;
      MarchSettings settings;
      settings.increments = 20;
      settings.stop_at_steady_state = false;
      ContactState state = ContactState::virgin(joint.reduction.problem);
      const MarchReport report = march(joint.reduction.problem, history, state, settings);
      if (report.status != FrictionStatus::converged || report.counters.increments < 121)
      {
         return 1;
      }
      std::printf("%-52s %9.3f %11.3f\n", "lap joint, 3 cycles of 40 increments",
                  watch.seconds(), condensed);
   }
   const miniapp::Stopwatch watch;
   miniapp::RecedingOptions options;
   options.overhangs = {0.2, 0.4, 0.6, 0.8, 1, 1.2, 1.4, 1.6, 1.8, 2, 2.25, 2.5, 3, 3.5, 4};
   options.spacing = 0.04;
   options.corner = 0.01;
   miniapp::Scene scene = miniapp::make_receding(options);
   const double condensed = watch.seconds();
   ReducedProblem &problem = scene.reduction.problem;
   std::vector<std::vector<NodeState>> guess(options.overhangs.size());
   for (double f : {0.3, 0.5, 0.7, 1.0})
   {
      set_friction(problem, f);
      FrictionSolver solver(problem);
      for (std::size_t k = 0; k < options.overhangs.size(); ++k)
      {
         ContactState state = ContactState::virgin(problem);
         // The states of the nodes at the friction before are where the search starts.
         if (!guess[k].empty()) { state.status = guess[k]; }
         const VectorXd load = VectorXd::Unit(options.overhangs.size(), k);
         if (solver.solve(state, load).status != FrictionStatus::converged) { return 1; }
         guess[k] = state.status;
      }
   }
   std::printf("%-52s %9.3f %11.3f\n", "map of 15 overhangs by 4 frictions, half-plane",
               watch.seconds(), condensed);
   return 0;
}
