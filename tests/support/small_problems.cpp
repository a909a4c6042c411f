#include "small_problems.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem one_block(double f)
{
   cattaneo::ReducedProblem problem;
   problem.set_stiffness(Eigen::MatrixXd::Constant(1, 1, 2.0), Eigen::MatrixXd::Zero(1, 1),
                         Eigen::MatrixXd::Constant(1, 1, 3.0));
   problem.patterns = {
      {"press", cattaneo::Control::force, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)},
      {"shear", cattaneo::Control::force, Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1)}};
   problem.H = Eigen::Matrix2d::Zero();
   problem.gap = Eigen::VectorXd::Zero(1);
   cattaneo::set_friction(problem, f);
   return problem;
}

cattaneo::ReducedProblem four_springs()
{
   cattaneo::ReducedProblem problem;
   problem.set_stiffness(2 * Eigen::Matrix4d::Identity(), Eigen::Matrix4d::Zero(),
                         4 * Eigen::Matrix4d::Identity());
   const Eigen::Vector4d none = Eigen::Vector4d::Zero();
   problem.patterns = {
      {"P", cattaneo::Control::force, none, Eigen::Vector4d(1, 1, 1, -0.4)},
      {"Q right", cattaneo::Control::force, Eigen::Vector4d(0.1, -0.8, 0.7, 0.3), none}};
   problem.H = Eigen::MatrixXd::Zero(2, 2);
   problem.gap = Eigen::Vector4d(0, 0, 0, 0.05);
   problem.chains = cattaneo::one_chain(4);
   problem.weights = Eigen::Vector4d(0.25, 0.5, 1, 2);
   problem.arc_length = Eigen::Vector4d(0, 1.0 / 3, 0.5, 2);
   problem.position.resize(4, 2);
   problem.position << -1, 5, -2, 6, -3, 7, -4, 1.0 / 7;
   cattaneo::set_friction(problem, 0.5);
   return problem;
}

cattaneo::LoadHistory press_then_shear(double amplitude, int cycles)
{
   cattaneo::LoadHistory history = cattaneo::LoadHistory::through(
      {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, amplitude),
       Eigen::Vector2d(1, -amplitude), Eigen::Vector2d(1, 0)});
   history.cycle_start = 1;
   history.cycles = cycles;
   return history;
}

} // namespace cattaneo_test
