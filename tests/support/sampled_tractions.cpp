#include "sampled_tractions.hpp"

#include <algorithm>
#include <cmath>

namespace cattaneo_test
{

using namespace cattaneo;

Sampled cattaneo_mindlin(int n, double c, double shift)
{
   Sampled result;
   ReducedProblem &problem = result.problem;
   const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
   problem.set_stiffness(I, Eigen::MatrixXd::Zero(n, n), I);
   problem.chains = one_chain(n);
   problem.gap = Eigen::VectorXd::Zero(n);
   problem.arc_length = Eigen::VectorXd::LinSpaced(n, 0, 3);
   problem.weights = Eigen::VectorXd::Constant(n, 3.0 / (n - 1));
   set_friction(problem, 0.5);
   result.state = ContactState::virgin(problem);
   for (int i = 0; i < n; ++i)
   {
      const double x = problem.arc_length[i] - 1.5 - shift;
      double p = 0, q = 0;
      NodeState state = NodeState::separation;
      if (std::abs(x) < 1)
      {
         p = std::sqrt(1 - x * x);
         q = -0.5 * p;
         state = NodeState::forward_slip;
         // Slip grows with the power 3/2 of the distance from the front.
         result.state.v[i] = std::pow(std::max(0.0, std::abs(x) - c), 1.5);
         if (std::abs(x) < c)
         {
            q += 0.5 * std::sqrt(c * c - x * x);
            state = NodeState::stick;
         }
      }
      result.state.status[i] = state;
      result.state.p[i] = p * problem.weights[i];
      result.state.q[i] = q * problem.weights[i];
   }
   return result;
}

} // namespace cattaneo_test
