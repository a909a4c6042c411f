#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cmath>
#include <optional>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Normal forces after gaps have changed, with normal displacements only. Closed nodes may
/// open, and open ones may close. Empty if no solution is found.
std::optional<VectorXd> forces_after(const MatrixXd &C, const VectorXd &p, VectorXd open,
                                     const VectorXd &change)
{
   open += change;
   std::vector<bool> bears(p.size());
   for (Index i = 0; i < p.size(); ++i) { bears[i] = p[i] > 0 || open[i] < 0; }
   std::optional<VectorXd> found;
   // The sets of nodes settle in a few rounds. If they cycle, the last one is taken.
   for (int round = 0; round < 50; ++round)
   {
      std::vector<int> closed, free;
      for (Index i = 0; i < p.size(); ++i)
      {
         (bears[i] ? closed : free).push_back(static_cast<int>(i));
      }
      // Closed nodes move by the change of their gap; the others get no force.
      VectorXd moved = VectorXd::Zero(p.size());
      for (const int i : closed) { moved[i] = -open[i]; }
      if (!free.empty())
      {
         DenseCholesky follows;
         if (!follows.compute(block_of(C, free, free))) { return found; }
         VectorXd its = -p(free) - product(block_of(C, free, closed), rows_of(moved, closed));
         follows.solve(its);
         for (std::size_t k = 0; k < free.size(); ++k)
         {
            moved[free[k]] = its[static_cast<Index>(k)];
         }
      }
      VectorXd force = p + C * moved;
      for (const int i : free) { force[i] = 0; }
      found = force.cwiseMax(0);
      bool settled = true;
      const double least = 1e-12 * p.cwiseAbs().maxCoeff();
      for (Index i = 0; i < p.size(); ++i)
      {
         const bool bears_on = bears[i] ? force[i] > -least : open[i] + moved[i] < 0;
         settled = settled && bears_on == bears[i];
         bears[i] = bears_on;
      }
      if (settled) { break; }
   }
   return found;
}

} // namespace

ChordalError chordal_error(const Reduction &reduction, const VectorXd &p, const VectorXd &w)
{
   const ReducedProblem &problem = reduction.problem;
   const Index n = problem.nodes();
   require(p.size() == n, "chordal error: ", p.size(), " normal forces, must be ", n);
   require(w.size() == n || w.size() == 0, "chordal error: ", w.size(),
           " normal displacements, must be ", n, " or none");
   VectorXd off = VectorXd::Zero(n);
   for (const InterfaceReport &face : reduction.interfaces)
   {
      if (face.tied || face.chords.size() != face.nodes) { continue; }
      off.segment(face.first, face.nodes) = face.chords;
   }
   if (off.isZero(0)) { return {}; }
   const ChordalError unknown{HUGE_VAL, HUGE_VAL};
   const bool bears = p.maxCoeff() > 0;
   // Openings of the nodes. If they are not known, open nodes stay open.
   VectorXd open = VectorXd::Constant(n, HUGE_VAL);
   if (w.size() == n) { open = problem.gap + w; }
   else if (!bears) { open = problem.gap; }
   for (Index i = 0; i < n; ++i)
   {
      if (p[i] > 0 || open[i] < 0) { open[i] = 0; }
   }
   if (!bears)
   {
      // May the smooth sides meet? The estimate has an error of a tenth.
      const bool meet = (off.array() < 0 && (open + 1.1 * off).array() < 0).any();
      if (meet && (problem.gap.array() >= 0).any()) { return unknown; }
      return {};
   }
   const auto after = forces_after(problem.C(), p, open, off);
   if (!after) { return unknown; }
   const VectorXd now = p.cwiseQuotient(problem.weights),
                  then = after->cwiseQuotient(problem.weights);
   Index largest = 0;
   const double peak = now.maxCoeff(&largest);
   // The pressures are only round-off compared with those of the curves, so no change can be
   // given.
   if (peak <= 1e-9 * then.maxCoeff()) { return unknown; }
   const double of_peak = std::max(std::abs(then.maxCoeff() - peak), peak - then[largest]);
   return {(then - now).cwiseAbs().maxCoeff() / peak, of_peak / peak};
}

} // namespace cattaneo
