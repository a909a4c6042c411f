//  benchmark_sensitivity: the gradient of a march with respect to all gaps, against the march
//
//  The lap joint in cycles of the remote load, sheared square punches and the Hertz contact
//  with a gap: dissipation and its derivatives by all gaps, frictions and load multipliers (one
//  backward march), in equal increments and on the exact path. The gradient is to cost no more
//  than twice the march; exit code 1 if it does.

#include "common/hertz_scene.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/punch.hpp"

#include <cattaneo/design/sensitivity.hpp>
#include <chrono>
#include <cstdio>

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

double seconds(const std::function<void()> &work)
{
   const auto began = std::chrono::steady_clock::now();
   work();
   return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

bool compare(const char *name, const ReducedProblem &problem, const LoadHistory &history)
{
   bool cheap = true;
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      settings.stop_at_steady_state = false;
      MarchTrace trace;
      const double marched = seconds([&] { trace = trace_march(problem, history, settings); });
      Gradient gradient;
      long factored = 0;
      const double differentiated = seconds(
         [&]
         {
            Sensitivity sensitivity(problem, trace);
            gradient =
               sensitivity.gradient(Responses(problem, trace).dissipation(0, trace.last()));
            factored = sensitivity.factorisations();
         });
      const bool complete = trace.report.status == FrictionStatus::converged && gradient.found;
      std::printf("%-28s %6d %-6s %8zu %10.4f %10.4f %8.2f %12ld\n", name,
                  static_cast<int>(problem.nodes()),
                  stepping == Stepping::fixed ? "fixed" : "exact", trace.last(), marched,
                  differentiated, differentiated / marched, factored);
      cheap = cheap && complete && differentiated <= 2 * marched;
   }
   return cheap;
}

LoadHistory cycles(double load)
{
   LoadHistory history = LoadHistory::through(
      {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, load), Vector2d(1, -load), Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = 3;
   return history;
}

} // namespace

int main()
{
   std::printf("%-28s %6s %-6s %8s %10s %10s %8s %12s\n", "", "nodes", "path", "states",
               "march, s", "gradient", "ratio", "factored");
   bool cheap = true;
   {
      miniapp::Scene joint = miniapp::make_lap_joint({});
      set_friction(joint.reduction.problem, 0.2);
      cheap &= compare("lap joint", joint.reduction.problem, cycles(0.04));
   }
   for (bool half_plane : {false, true})
   {
      miniapp::PunchOptions options;
      options.half_plane = half_plane;
      miniapp::Scene punch = miniapp::make_punch(options);
      set_friction(punch.reduction.problem, half_plane ? 0.4 : 0.2);
      cheap &= compare(half_plane ? "punch on a half-plane" : "punch on a rigid plane",
                       punch.reduction.problem, cycles(half_plane ? 0.32 : 0.16));
   }
   for (int nodes : {101, 401})
   {
      miniapp::HalfPlanes options;
      options.nodes = nodes;
      options.material = Material{8 / M_PI * 0.91, 0.3};
      miniapp::Scene pad = miniapp::make_scene(options);
      ReducedProblem &problem = pad.reduction.problem;
      problem.gap = 0.5 * problem.position.col(0).cwiseAbs2();
      set_friction(problem, 0.5);
      cheap &= compare("Hertz, half-planes", problem, cycles(0.3));
   }
   return cheap ? 0 : 1;
}
