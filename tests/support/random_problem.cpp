#include "random_problem.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem random_problem(int n, double friction, double coupling,
                                        std::mt19937 &random)
{
   std::normal_distribution<double> normal;
   auto matrix = [&](int rows, int cols)
   {
      return Eigen::MatrixXd(
         Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); }));
   };
   cattaneo::ReducedProblem problem;
   const Eigen::MatrixXd R = matrix(n, n), T = matrix(n, n);
   const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
   problem.set_stiffness(I + R * R.transpose() / n, coupling / std::sqrt(n) * matrix(n, n),
                         I + T * T.transpose() / n);
   const Eigen::VectorXd p = Eigen::VectorXd::Constant(n, 1.0) + 0.8 * matrix(n, 1);
   problem.patterns = {{"press", cattaneo::Control::force, 0.3 * matrix(n, 1), p},
                       {"shear", cattaneo::Control::force, matrix(n, 1), 0.5 * matrix(n, 1)}};
   problem.H = Eigen::MatrixXd::Identity(2, 2);
   problem.gap = (0.3 * matrix(n, 1)).cwiseAbs().cwiseMax(0.1).array() - 0.1;
   problem.weights = Eigen::VectorXd::Ones(n);
   problem.chains = cattaneo::one_chain(n);
   set_friction(problem, friction);
   return problem;
}

} // namespace cattaneo_test
