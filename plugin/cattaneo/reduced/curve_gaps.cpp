#include <cattaneo/reduced/curve_gaps.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixX2d;

CurveGaps curve_gaps(const ContactLine &line, const std::vector<int> &nodes,
                     const MatrixX2d &tangents, const ContactLine &other,
                     const std::vector<int> &partner)
{
   MatrixX2d normals(tangents.rows(), 2);
   normals << -tangents.col(1), tangents.col(0);
   const auto across = [&](const auto &of_line)
   {
      MatrixX2d all = of_line(line)(nodes, Eigen::all);
      const MatrixX2d its = of_line(other);
      for (Index i = 0; i < all.rows() && other.size() > 0; ++i)
      {
         all.row(i) -= its.row(partner[nodes[i]]);
      }
      Eigen::VectorXd sums = normals.cwiseProduct(all).rowwise().sum();
      for (Index i = 0; i < sums.size(); ++i)
      {
         if (std::abs(sums[i]) <= 1e-9 * line.nodes[nodes[i]].spacing) { sums[i] = 0; }
      }
      return sums;
   };
   return {across([](const ContactLine &one) -> MatrixX2d
                  { return one.outline() - one.each(&LineNode::position); }),
           across([](const ContactLine &one) -> MatrixX2d { return one.off_unmeasured(); }),
           across([](const ContactLine &one) { return one.bulges(); })};
}

} // namespace cattaneo
