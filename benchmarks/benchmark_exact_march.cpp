//  benchmark_exact_march: the exact path against increments, time and error
//
//  The lap joint in cycles of the remote load, the sheared square punches and the unloading of
//  a receding contact, marched from one change of state to the next and in equal increments:
//  how much longer increments take, and the error they leave in the slip at the points of the
//  history and in the dissipation.

#include "common/lap_joint_scene.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"

#include <cattaneo/friction/march.hpp>
#include <cmath>
#include <cstdio>

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

struct Run
{
   MatrixXd slip; ///< at the points of the history, one column each
   double dissipation = 0;
   MarchReport report;
   bool complete = false;
};

Run run(FrictionSolver &solver, const LoadHistory &history, Stepping stepping, int increments)
{
   Run run;
   MarchSettings settings;
   settings.stepping = stepping;
   settings.increments = increments;
   settings.stop_at_steady_state = false;
   run.slip.setZero(solver.problem().nodes(), history.pieces());
   ContactState state = ContactState::virgin(solver.problem());
   run.report = march(solver, history, state, settings,
                      [&](const ContactState &now, const IncrementRecord &)
                      { run.slip.col(static_cast<int>(std::ceil(now.time)) - 1) = now.v; });
   run.dissipation = state.dissipation;
   run.complete = run.report.status == FrictionStatus::converged && run.report.fallbacks == 0;
   return run;
}

/// False if a march ended early or had no exact path.
bool compare(const char *name, const ReducedProblem &problem, const LoadHistory &history)
{
   FrictionSolver solver(problem);
   const Run exact = run(solver, history, Stepping::exact, 1);
   std::printf("%s: %d nodes, exact path of %ld changes of state in %.3f s\n", name,
               static_cast<int>(problem.nodes()), exact.report.events, exact.report.seconds);
   std::printf("   %10s %12s %14s %18s\n", "increments", "time/exact", "error of slip",
               "of dissipation");
   bool complete = exact.complete;
   for (int increments : {10, 20, 40, 80, 160})
   {
      const Run stepped = run(solver, history, Stepping::fixed, increments);
      complete = complete && stepped.complete;
      std::printf("   %10d %12.1f %14.2e %18.2e\n", increments,
                  stepped.report.seconds / exact.report.seconds,
                  (stepped.slip - exact.slip).cwiseAbs().maxCoeff() /
                     exact.slip.cwiseAbs().maxCoeff(),
                  std::abs(stepped.dissipation / exact.dissipation - 1));
   }
   return complete;
}

LoadHistory cycles(double low, double high)
{
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, high), Vector2d(1, low), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = 3;
   return history;
}

} // namespace

int main()
{
   std::printf("increments: of each piece of the history; errors: over the largest\n\n");
   bool complete = true;
   {
      miniapp::Scene joint = miniapp::make_lap_joint({});
      set_friction(joint.reduction.problem, 0.2);
      complete &=
         compare("lap joint, T = ± 0.04 P0", joint.reduction.problem, cycles(-0.04, 0.04));
   }
   for (bool half_plane : {false, true})
   {
      miniapp::PunchOptions options;
      options.half_plane = half_plane;
      miniapp::Scene punch = miniapp::make_punch(options);
      set_friction(punch.reduction.problem, half_plane ? 0.4 : 0.2);
      const double Q = half_plane ? 0.32 : 0.16; // 0.8 f P
      complete &= compare(half_plane ? "punch on a half-plane, Q = ± 0.8 fP"
                                     : "punch on a rigid plane, Q = ± 0.8 fP",
                          punch.reduction.problem, cycles(-Q, Q));
   }
   miniapp::RecedingOptions options;
   options.spacing = 0.05;
   const miniapp::Scene scene = miniapp::make_receding(options);
   ReducedProblem problem = scene.reduction.problem;
   set_friction(problem, 0.7);
   complete &=
      compare("receding contact, unloaded to a tenth and loaded again", problem,
              LoadHistory::through({VectorXd::Zero(1), VectorXd::Constant(1, 1.0),
                                    VectorXd::Constant(1, 0.1), VectorXd::Constant(1, 1.0)}));
   return complete ? 0 : 1;
}
