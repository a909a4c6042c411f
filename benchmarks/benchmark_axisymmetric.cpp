//  benchmark_axisymmetric: whole studies of the disc on a half-space, from mesh to result
//
//  Loading and 40 steps of torsion at a spacing of 0.02 t; and the map of the critical load
//  radius, 7 discs by 4 coefficients of friction.

#include "common/disc_scene.hpp"
#include "common/miniapp.hpp"

#include <cattaneo/friction/march.hpp>
#include <cmath>
#include <cstdio>

using namespace cattaneo;
using Eigen::Vector2d;

int main()
{
   std::printf("%-52s %9s %11s\n", "study", "seconds", "condensing");
   {
      const miniapp::Stopwatch watch;
      miniapp::DiscOptions options;
      options.twist = miniapp::Twist::top;
      miniapp::Scene scene = miniapp::make_disc(options);
      const double condensed = watch.seconds();
      ReducedProblem &problem = scene.reduction.problem;
      set_friction(problem, 0.5);
      // The bonded disc would meet the spinning limit at this angle, roughly.
      const double f_r_p = 0.5 * problem.position.col(0).dot(problem.patterns[0].p);
      const double stiffness =
         std::abs(problem.position.col(0).dot(problem.patterns[1].q.tail(problem.nodes())));
      MarchSettings settings;
      settings.increments_of_piece = {1, 40};
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(
         problem,
         LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, f_r_p / stiffness)}),
         state, settings);
      if (report.status != FrictionStatus::converged || report.counters.increments < 41)
      {
         return 1;
      }
      std::printf("%-52s %9.3f %11.3f\n", "loading and 40 steps of torsion, spacing 0.02 t",
                  watch.seconds(), condensed);
   }
   const miniapp::Stopwatch watch;
   double condensing = 0;
   for (double b : {3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0})
   {
      miniapp::DiscOptions options;
      options.disc_radius = b;
      const miniapp::Stopwatch one;
      miniapp::CriticalLoad disc(options);
      condensing += one.seconds();
      for (double f : {0.0, 0.3, 0.5, 0.8})
      {
         if (!std::isfinite(disc.radius(f))) { return 1; }
      }
   }
   std::printf("%-52s %9.3f %11.3f\n", "critical load radius, 7 discs by 4 frictions",
               watch.seconds(), condensing);
   return 0;
}
