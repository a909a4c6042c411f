#include "frame_of_bars.hpp"

#include <cmath>

namespace cattaneo_test
{

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Frame::Frame(int across, int up, bool lies_above, double stiffness)
   : columns(across), rows(up), above(lies_above),
     K(MatrixXd::Zero(2 * points(), 2 * points())), x(points()), y(points())
{
   for (int p = 0; p < points(); ++p)
   {
      x[p] = p % columns;
      y[p] = p / columns + (above ? 0 : 1 - rows);
   }
   double k = stiffness;
   for (int p = 0; p < points(); ++p)
   {
      for (int q = p + 1; q < points(); ++q)
      {
         const Eigen::Vector2d along(x[q] - x[p], y[q] - y[p]);
         if (along.norm() > 1.5) { continue; }
         const Eigen::Vector4d stretch =
            (Eigen::Vector4d() << -along, along).finished() / along.norm();
         const std::vector<int> dofs{2 * p, 2 * p + 1, 2 * q, 2 * q + 1};
         K(dofs, dofs) += k * stretch * stretch.transpose();
         k *= 1.01;
      }
   }
}

std::vector<int> Frame::contact() const
{
   std::vector<int> dofs;
   for (int c : {0, 1})
   {
      for (int i = 0; i < columns; ++i) { dofs.push_back(2 * point_of_contact(i) + c); }
   }
   return dofs;
}

ContactLine Frame::line() const
{
   ContactLine line;
   line.chains = {{0, columns}};
   for (int i = 0; i < columns; ++i)
   {
      const int p = point_of_contact(i);
      line.nodes.push_back(
         {{2 * p, 2 * p + 1}, {x[p], y[p]}, {above ? 1 : -1, 0}, 1, double(i), 1});
   }
   return line;
}

AssembledBody Frame::body(bool held) const
{
   AssembledBody made;
   made.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   made.places = {VectorXd(2 * points()), VectorXd(2 * points()), {}, Formulation::plane};
   for (int dof = 0; dof < 2 * points(); ++dof)
   {
      made.places.x[dof] = x[dof / 2];
      made.places.y[dof] = y[dof / 2];
      made.places.component.push_back(dof % 2);
   }
   for (int i = 0; held && i < columns; ++i)
   {
      const int p = above ? points() - columns + i : i;
      made.fixed.insert(made.fixed.end(), {2 * p, 2 * p + 1});
   }
   VectorXd pull = VectorXd::LinSpaced(2 * points(), -1, 1),
            lift = VectorXd::Zero(2 * points());
   made.loads = {{"pull", Control::force, pull}};
   if (held)
   {
      for (int dof : made.fixed) { lift[dof] = dof % 2 ? 0.1 : -0.02 * dof; }
      made.loads.push_back({"lift", Control::displacement, lift});
   }
   return made;
}

} // namespace cattaneo_test
