#include <algorithm>
#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/halfplane/surface_trace.hpp>
#include <cattaneo/input_error.hpp>
#include <limits>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index highest_order = LobattoBasis::highest_order;

/// A rule that is exact for two functions times the element's slope times a polynomial of
/// degree 4.
const QuadratureRule &product_rule(const SurfaceElement &element)
{
   return gauss_rule(static_cast<int>(2 * element.order() + 3));
}

/// w at the points, times the slope and the weights of the rule.
VectorXd weighted(const SurfaceElement &element, const SurfacePoints &at,
                  const SurfaceTrace::Weight &w, const VectorXd &rule)
{
   VectorXd values = at.dx.cwiseProduct(rule);
   for (Index k = 0; k < values.size(); ++k) { values[k] *= w(element.x[0] + at.x[k]); }
   return values;
}

} // namespace

SurfaceTrace::SurfaceTrace(Index unknowns, std::vector<SurfaceElement> elements)
   : unknowns_(unknowns), elements_(std::move(elements))
{
   std::sort(elements_.begin(), elements_.end(),
             [](const SurfaceElement &a, const SurfaceElement &b) { return a.x[0] < b.x[0]; });
   double end = -std::numeric_limits<double>::infinity();
   for (const SurfaceElement &element : elements_)
   {
      const Index order = element.order();
      require(order >= 1 && order <= highest_order,
              "half-plane: the order of a contact element is ", order, ", must be from 1 to ",
              highest_order);
      // Checked between the nodes too, where the slope could change its sign: at 4 points for
      // each node.
      const SurfacePoints at = points(element, VectorXd::LinSpaced(4 * order + 1, 0, 1));
      require(at.dx.minCoeff() > 0, "half-plane: the contact element from ", element.x[0],
              " to ", element.x[order],
              " along the surface turns back on itself: its nodes must follow each other along "
              "the surface");
      require(element.x[0] >= end,
              "half-plane: two contact elements overlap on the surface, one begins at ",
              element.x[0], ", the other ends at ", end, ": elements must lie side by side");
      end = element.x[order];
   }
}

SurfaceTrace SurfaceTrace::mirrored() const
{
   std::vector<SurfaceElement> turned = elements_;
   for (SurfaceElement &element : turned)
   {
      element.x = -element.x.reverse().eval();
      std::reverse(element.unknowns.begin(), element.unknowns.end());
   }
   return {unknowns_, std::move(turned)};
}

SurfacePoints SurfaceTrace::points(const SurfaceElement &element, const VectorXd &t) const
{
   const LobattoBasis &functions = lobatto_basis(element.order());
   const MatrixXd values = functions.values(t);
   // Places are counted from the first node, so that small elements far from the origin lose no
   // digits.
   const VectorXd from_first = element.x.array() - element.x[0];
   return {values * from_first, values * (functions.slopes * from_first), values.transpose()};
}

VectorXd SurfaceTrace::integral(const Weight &w) const
{
   VectorXd result = VectorXd::Zero(unknowns_);
   for (const SurfaceElement &element : elements_)
   {
      const QuadratureRule &rule = product_rule(element);
      const SurfacePoints at = points(element, rule.points);
      result(element.unknowns) += at.phi * weighted(element, at, w, rule.weights);
   }
   return result;
}

Eigen::SparseMatrix<double> SurfaceTrace::mass(const Weight &w) const
{
   std::vector<Eigen::Triplet<double>> entries;
   for (const SurfaceElement &element : elements_)
   {
      const QuadratureRule &rule = product_rule(element);
      const SurfacePoints at = points(element, rule.points);
      const MatrixXd own =
         at.phi * weighted(element, at, w, rule.weights).asDiagonal() * at.phi.transpose();
      for (Index a = 0; a < own.rows(); ++a)
      {
         for (Index b = 0; b < own.cols(); ++b)
         {
            entries.emplace_back(element.unknowns[a], element.unknowns[b], own(a, b));
         }
      }
   }
   Eigen::SparseMatrix<double> result(unknowns_, unknowns_);
   result.setFromTriplets(entries.begin(), entries.end());
   return result;
}

MatrixXd SurfaceTrace::ordered_integral(const Weight &f, const Weight &g) const
{
   MatrixXd result = MatrixXd::Zero(unknowns_, unknowns_);
   VectorXd before = VectorXd::Zero(unknowns_); // ∫ g φ_j of the elements so far
   for (const SurfaceElement &element : elements_)
   {
      const QuadratureRule &rule = product_rule(element);
      const SurfacePoints outer = points(element, rule.points);
      const VectorXd fw = weighted(element, outer, f, rule.weights);
      result(element.unknowns, Eigen::all) += (outer.phi * fw) * before.transpose();
      for (Index k = 0; k < fw.size(); ++k)
      {
         const double t = rule.points[k];
         const SurfacePoints inner = points(element, t * rule.points);
         const VectorXd up_to = inner.phi * weighted(element, inner, g, t * rule.weights);
         result(element.unknowns, element.unknowns) +=
            fw[k] * outer.phi.col(k) * up_to.transpose();
      }
      before(element.unknowns) += outer.phi * weighted(element, outer, g, rule.weights);
   }
   return result;
}

Eigen::SparseMatrix<double> kept_of(const Eigen::SparseMatrix<double> &mass,
                                    const std::vector<int> &kept)
{
   std::vector<Index> position(2 * mass.rows(), -1);
   for (std::size_t a = 0; a < kept.size(); ++a) { position[kept[a]] = static_cast<Index>(a); }
   std::vector<Eigen::Triplet<double>> entries;
   for (const int unknown : kept)
   {
      const Index first = unknown / mass.rows() * mass.rows();
      for (Eigen::SparseMatrix<double>::InnerIterator entry(mass, unknown % mass.rows()); entry;
           ++entry)
      {
         const Index row = position[first + entry.row()];
         if (row >= 0) { entries.emplace_back(row, position[unknown], entry.value()); }
      }
   }
   const auto size = static_cast<Index>(kept.size());
   Eigen::SparseMatrix<double> M(size, size);
   M.setFromTriplets(entries.begin(), entries.end());
   return M;
}

} // namespace cattaneo
