#include "differentiated_march.hpp"

#include "random_problem.hpp"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MarchCase random_case(int seed, Stepping stepping, int increments)
{
   std::mt19937 random(seed);
   MarchCase result;
   result.problem = random_problem(8, 0.3, 0.3, random);
   for (double &f : result.problem.friction)
   {
      f *= 1 + 0.3 * std::cos(7 * f + random() % 100);
   }
   result.problem.gap.array() += 0.05; // nothing touches by itself
   result.history = LoadHistory::through(result.problem, {{},
                                                          {{"press", 1}},
                                                          {{"press", 1.2}, {"shear", 0.6}},
                                                          {{"press", 0.9}, {"shear", -0.7}},
                                                          {{"press", 1.2}, {"shear", 0.5}}});
   result.settings.stepping = stepping;
   result.settings.increments = increments;
   result.settings.single_increment_if_exact = false;
   return result;
}

MarchCase changed(MarchCase c, const Parameters &by, double h)
{
   if (by.friction.size()) { c.problem.friction += h * by.friction; }
   if (by.gap.size()) { c.problem.gap += h * by.gap; }
   if (by.multipliers.size()) { c.history.multipliers += h * by.multipliers; }
   if (by.stiffness.size())
   {
      const double s = h * by.stiffness[0];
      c.problem.K *= 1 + s;
      c.problem.H *= 1 - s; // of forces, as all patterns of these cases
   }
   return c;
}

double by_differences(const MarchCase &c, const Parameters &by, const Read &read, double h)
{
   const auto value = [&](double step)
   {
      const MarchCase other = changed(c, by, step);
      const MarchTrace trace = trace_march(other.problem, other.history, other.settings);
      EXPECT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
      return read(Responses(other.problem, trace), trace).value;
   };
   return (value(h) - value(-h)) / (2 * h);
}

std::vector<Parameters> directions(const MarchCase &c, int seed)
{
   std::srand(seed);
   std::vector<Parameters> all(4);
   all[0].friction = VectorXd::Random(c.problem.nodes());
   all[1].gap = VectorXd::Random(c.problem.nodes());
   all[2].multipliers =
      MatrixXd::Random(c.history.multipliers.rows(), c.history.multipliers.cols());
   all[2].multipliers.col(0).setZero(); // where the virgin state stands
   all[3].stiffness = VectorXd::Ones(1);
   return all;
}

Differentiated::Differentiated(const MarchCase &given)
   : c(given), trace(trace_march(c.problem, c.history, c.settings)),
     sensitivity(c.problem, trace, {stiffness_scale(c.problem)})
{
   EXPECT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
}

Response Differentiated::response(const Read &read) const
{
   return read(Responses(c.problem, trace), trace);
}

} // namespace cattaneo_test
