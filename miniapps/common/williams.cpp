#include "common/williams.hpp"

#include <cattaneo/algebra/least_squares.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using Eigen::Index;
using Eigen::MatrixXd;

const double williams_eigenvalue[2] = {0.544483736782, 0.908529189846};
const double williams_ratio[2] = {0.543075578837, -0.218923236249};

MatrixXd williams_strengths(const Eigen::VectorXd &x, const MatrixXd &tractions)
{
   if (x.size() < 10)
   {
      return MatrixXd::Constant(2, tractions.cols(), std::numeric_limits<double>::quiet_NaN());
   }
   const double real = 1.629257376760, imaginary = 0.231250545117;
   MatrixXd modes(x.size(), 4), scaled = tractions;
   for (Index k = 0; k < x.size(); ++k)
   {
      const double scale = std::pow(x[k], 1 - williams_eigenvalue[0]),
                   phase = imaginary * std::log(x[k]);
      modes.row(k) << 1.0, scale * std::pow(x[k], williams_eigenvalue[1] - 1),
         scale * std::pow(x[k], real - 1) * std::cos(phase),
         scale * std::pow(x[k], real - 1) * std::sin(phase);
      scaled.row(k) *= scale;
   }
   return cattaneo::least_squares(modes, scaled).topRows(2);
}

} // namespace miniapp
