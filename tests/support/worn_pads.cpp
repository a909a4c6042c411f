#include "worn_pads.hpp"

#include "comparison.hpp"

#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

std::vector<double> grid_about(double c, double span, int inner, int outer)
{
   std::vector<double> half = {0};
   const auto toward_c = [](int k, int of) { return std::pow(double(k) / of, 1.8); };
   for (int k = inner - 1; k >= 0; --k) { half.push_back(c - c * toward_c(k, inner)); }
   for (int k = 1; k <= outer; ++k) { half.push_back(c + (span - c) * toward_c(k, outer)); }
   std::vector<double> grid;
   for (std::size_t k = half.size() - 1; k > 0; --k) { grid.push_back(-half[k]); }
   grid.insert(grid.end(), half.begin(), half.end());
   return grid;
}

Pad hertz_pad(const std::vector<double> &grid, double shear, double unit)
{
   HalfPlane pad, plane;
   pad.material = plane.material = Material{8 / M_PI * 0.91, 0.3};
   pad.depth = plane.depth = 1e4 * unit;
   pad.normal = {0, 1};
   pad.forces = {{"P", {0, -unit}}, {"Q", {unit, 0}}};
   std::vector<double> scaled;
   for (double x : grid) { scaled.push_back(unit * x); }
   Pad result;
   ReducedProblem &problem = result.problem = reduce(condense(pad, scaled, 2), plane).problem;
   problem.B().setZero(); // equal half-planes
   join_coupling(problem);
   set_friction(problem, 0.5);
   problem.gap = problem.position.col(0).array().square() / (2 * unit);
   const double Q = 0.5 * shear;
   result.history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"P", 1}, {"Q", Q}}, {{"P", 1}, {"Q", -Q}}, {{"P", 1}, {"Q", Q}}});
   result.history.cycle_start = 2;
   result.history.cycles = 1;
   return result;
}

Pad small_pad(double unit)
{
   return hertz_pad(grid_about(std::sqrt(0.5), 1.3, 10, 8), 0.5, unit);
}

MarchSettings one_increment()
{
   MarchSettings settings;
   settings.increments = 1; // exact: B = 0, P constant, Q monotone
   return settings;
}

WearSettings settings_with(double tolerance)
{
   WearSettings settings;
   settings.march = one_increment();
   settings.tolerance = tolerance;
   return settings;
}

Pad springs(const VectorXd &gap, double kt, double kn, double friction, double amplitude)
{
   const Index n = gap.size();
   Pad result;
   ReducedProblem &problem = result.problem;
   const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
   problem.set_stiffness(kt * I, 0 * I, kn * (I - Eigen::MatrixXd::Constant(n, n, 1.0 / n)));
   const VectorXd none = VectorXd::Zero(n), ones = VectorXd::Ones(n);
   problem.patterns = {{"P", Control::force, none, ones},
                       {"d", Control::displacement, -kt * ones, none}};
   problem.gap = gap;
   problem.weights = ones;
   problem.chains = one_chain(n);
   set_friction(problem, friction);
   const double d = amplitude;
   result.history = LoadHistory::through(
      problem,
      {{}, {{"P", 1}}, {{"P", 1}, {"d", d}}, {{"P", 1}, {"d", -d}}, {{"P", 1}, {"d", d}}});
   result.history.cycle_start = 2;
   result.history.cycles = 1;
   return result;
}

void compare(const WornProblem &of, const std::string &named, Jumped &count)
{
   WearSettings each = of.settings;
   each.tolerance = 0;
   WearState all = WearState::virgin(of.problem), some = all;
   std::map<double, VectorXd> depths;
   const WearReport marched =
      wear(of.problem, of.law, of.history, of.cycles, all, each,
           [&](const WearState &now, const WearRecord &) { depths[now.cycles] = now.depth; });
   if (marched.status != FrictionStatus::converged) { return; }
   const double leave = 1e-10 * largest(all.depth);
   const WearReport report =
      wear(of.problem, of.law, of.history, of.cycles, some, of.settings,
           [&](const WearState &now, const WearRecord &record)
           {
              // An estimate: seldom a row is missed, by less than itself.
              const double off = largest(now.depth - depths.at(now.cycles)) - leave;
              ++count.rows;
              count.rows_missed += off > record.error;
              EXPECT_LE(off, 2 * record.error) << named << ", cycle " << now.cycles;
           });
   ASSERT_EQ(report.status, FrictionStatus::converged) << named;
   ++count.all;
   count.jumped += report.jumps > 0;
   count.not_reached += !report.reached;
   const double error = largest(some.depth - all.depth), most = largest(all.depth),
                round_off = 1e-10 * most;
   EXPECT_LE(error, report.error + round_off) << named;
   if (report.reached)
   {
      EXPECT_LE(error, of.settings.tolerance * most + round_off) << named;
      EXPECT_LE(report.error, of.settings.tolerance * largest(some.depth) * (1 + 1e-12));
   }
   else { EXPECT_NE(report.remark, "") << named; }
}

int rounds(int few, int many)
{
   const char *full = std::getenv("CATTANEO_STRESS");
   return full && std::string(full) == "full" ? many : few;
}

} // namespace cattaneo_test
