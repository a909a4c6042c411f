#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double chordal_error(const Reduction &reduction, const VectorXd &p)
{
   const ReducedProblem &problem = reduction.problem;
   const Index n = problem.nodes();
   require(p.size() == n, "chordal error: ", p.size(), " normal forces, must be ", n);
   VectorXd off = VectorXd::Zero(n);
   for (const InterfaceReport &face : reduction.interfaces)
   {
      if (face.tied || face.chords.size() != face.nodes) { continue; }
      off.segment(face.first, face.nodes) = face.chords;
   }
   std::vector<int> bear, open;
   for (Index i = 0; i < n; ++i) { (p[i] > 0 ? bear : open).push_back(static_cast<int>(i)); }
   if (bear.empty())
   {
      // Smooth sides may meet, as far as the estimate is known, which is to a tenth of itself.
      const Eigen::Array<bool, Eigen::Dynamic, 1> meet =
         off.array() < 0 && (problem.gap + 1.1 * off).array() < 0;
      return (meet && problem.gap.array() >= 0).any() ? HUGE_VAL : 0;
   }
   if (off(bear).isZero(0)) { return 0; }
   // Open nodes move freely meanwhile.
   const MatrixXd C = problem.C();
   VectorXd force = C(bear, bear) * off(bear);
   DenseCholesky follows;
   if (!open.empty() && follows.compute(C(open, open)))
   {
      VectorXd moved = C(open, bear) * off(bear);
      follows.solve(moved);
      force -= C(bear, open) * moved;
   }
   const VectorXd weights = problem.weights(bear);
   return force.cwiseQuotient(weights).cwiseAbs().maxCoeff() /
          p(bear).cwiseQuotient(weights).maxCoeff();
}

} // namespace cattaneo
