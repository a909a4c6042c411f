//  benchmark_half_space: contact in three dimensions, from 200 to 2,000 rectangles
//
//  A sphere on a half-space of the same material (normal and tangential directions uncoupled),
//  and a rigid one (coupled): making the problem, pressing it, and an increment of shear to 0.9
//  of the limit. Each is a process of its own; exponents are those of seconds and memory over
//  rectangles.

#include "common/measure.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

double cpu_seconds()
{
   return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Squares within a contact of radius 1 and one around it.
Eigen::MatrixX2d squares(double edge)
{
   const int half = static_cast<int>(std::ceil(1 / edge)) + 2;
   std::vector<Vector2d> within;
   for (int j = -half; j <= half; ++j)
   {
      for (int i = -half; i <= half; ++i)
      {
         if (std::hypot(i * edge, j * edge) < 1 + 1.5 * edge)
         {
            within.emplace_back(i * edge, j * edge);
         }
      }
   }
   Eigen::MatrixX2d centres(static_cast<Eigen::Index>(within.size()), 2);
   for (std::size_t i = 0; i < within.size(); ++i)
   {
      centres.row(static_cast<Eigen::Index>(i)) = within[i];
   }
   return centres;
}

/// @return number of rectangles, seconds of making, pressing and shearing
std::vector<double> sphere(double edge, bool rigid)
{
   HalfSpace contact;
   contact.material = {1, 0.3};
   if (!rigid) { contact.other = contact.material; }
   contact.size = {edge, edge};
   contact.centres = squares(edge);
   std::vector<double> times{static_cast<double>(contact.centres.rows()), cpu_seconds()};
   ReducedProblem problem = contact.problem(contact.centres.rowwise().squaredNorm() / 20);
   times.push_back(cpu_seconds());
   const double f = 0.3, modulus = 1 / (1 - 0.09) / (rigid ? 1 : 2), P = 4.0 / 30 * modulus;
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   for (const NamedLoads &loads : {NamedLoads{{"P", P}}, {{"P", P}, {"Q1", 0.9 * f * P}}})
   {
      const IncrementReport report = solver.solve(state, problem.multipliers(loads));
      if (report.status != FrictionStatus::converged) { return {}; }
      times.push_back(cpu_seconds());
   }
   for (std::size_t k = times.size() - 1; k > 1; --k) { times[k] -= times[k - 1]; }
   times.erase(times.begin() + 1);
   return times;
}

} // namespace

int main()
{
   std::printf("%-10s %10s %9s %9s %9s %9s\n", "", "rectangles", "making", "pressing",
               "shearing", "MB");
   for (const bool rigid : {false, true})
   {
      std::vector<double> rectangles, seconds[3], memory;
      for (const double across : {15.0, 24.0, 35.0, 49.0})
      {
         const Measured run = in_own_process([&] { return sphere(2 / across, rigid); });
         if (!run.ok || run.values.size() != 4)
         {
            std::fprintf(stderr, "error: the sphere of %g squares across failed\n", across);
            return 1;
         }
         std::printf("%-10s %10.0f %9.3f %9.3f %9.3f %9.0f\n", rigid ? "coupled" : "uncoupled",
                     run.values[0], run.values[1], run.values[2], run.values[3], run.megabytes);
         rectangles.push_back(run.values[0]);
         memory.push_back(run.megabytes);
         for (std::size_t k : {0, 1, 2}) { seconds[k].push_back(run.values[k + 1]); }
      }
      std::printf("%-10s %10s %9.1f %9.1f %9.1f %9.1f\n", "", "exponent",
                  log_slope(rectangles, seconds[0]), log_slope(rectangles, seconds[1]),
                  log_slope(rectangles, seconds[2]), log_slope(rectangles, memory));
   }
   return 0;
}
