#include "disc_problems.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem random_disc_problem(int n, double friction, double coupling,
                                             std::mt19937 &random)
{
   std::normal_distribution<double> normal;
   auto matrix = [&](int rows, int cols)
   {
      return Eigen::MatrixXd(
         Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random); }));
   };
   cattaneo::ReducedProblem problem = random_problem(n, friction, coupling, random);
   const Eigen::MatrixXd R = matrix(2 * n, 2 * n);
   problem.set_stiffness(Eigen::MatrixXd::Identity(2 * n, 2 * n) + R * R.transpose() / (2 * n),
                         coupling / std::sqrt(n) * matrix(n, 2 * n), problem.C());
   for (cattaneo::LoadPattern &pattern : problem.patterns)
   {
      const Eigen::VectorXd radial = pattern.q;
      pattern.q.resize(2 * n);
      pattern.q << radial, 0.3 * matrix(n, 1);
   }
   Eigen::VectorXd twist = Eigen::VectorXd::Zero(2 * n);
   twist.tail(n) = matrix(n, 1);
   problem.patterns.push_back(
      {"twist", cattaneo::Control::force, twist, Eigen::VectorXd::Zero(n)});
   problem.H = Eigen::MatrixXd::Identity(3, 3);
   return problem;
}

cattaneo::ReducedProblem as_disc(const cattaneo::ReducedProblem &plane)
{
   const Eigen::Index n = plane.nodes();
   cattaneo::ReducedProblem problem = plane;
   Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n), B = A.topRows(n);
   A.topLeftCorner(n, n) = A.bottomRightCorner(n, n) = plane.A();
   B.leftCols(n) = plane.B();
   problem.set_stiffness(A, B, plane.C());
   for (cattaneo::LoadPattern &pattern : problem.patterns)
   {
      pattern.q.conservativeResizeLike(Eigen::VectorXd::Zero(2 * n));
   }
   return problem;
}

} // namespace cattaneo_test
