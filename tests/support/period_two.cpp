#include "period_two.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem period_two(double stored)
{
   using namespace cattaneo;
   const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
   const double soft = std::ldexp(1.0, -30);
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Vector3d(1, 1, soft).asDiagonal(),
                         Eigen::Matrix3d{{0, 2, 0}, {-2, 0, 0}, {0, 0, 0}},
                         8 * Eigen::Matrix3d::Identity());
   problem.patterns = {{"P", Control::force, std::sqrt(2 * soft * stored) * zero.Unit(2),
                        Eigen::Vector3d(2, 2, 8)},
                       {"Q0", Control::force, zero.Unit(0), zero},
                       {"Q1", Control::force, zero.Unit(1), zero}};
   problem.H = Eigen::Matrix3d::Zero();
   problem.chains = one_chain(3);
   problem.gap = zero;
   set_friction(problem, 0.5);
   return problem;
}

Eigen::MatrixXd loads_of_period_two()
{
   Eigen::MatrixXd loads(3, 4);
   loads << 1, 1, 1, 1, -1.5, 1, 0, 0, 0, 0, -1.5, 1;
   return loads;
}

double loss_of_period_two(double x)
{
   return 2 - x - 4 * x * x;
}

} // namespace cattaneo_test
