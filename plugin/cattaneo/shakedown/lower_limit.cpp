#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The half-planes normal·v + offset + λ slope ≥ 0 of the condition f p + side q ≥ 0 of one
/// node, one for each load vertex.
struct Condition
{
   Eigen::Vector2d normal;
   Eigen::VectorXd offset, slope;
};

/// λ1 of two nodes; @a corner is where the safe region has its critical corner.
double two_node_limit(const ReducedProblem &problem, const StuckForces &loads,
                      Eigen::VectorXd &corner)
{
   Condition conditions[2][2];
   for (int i = 0; i < 2; ++i)
   {
      for (int side = 0; side < 2; ++side)
      {
         const double f = problem.friction[i], sign = side == 0 ? 1 : -1;
         conditions[i][side] = {(f * problem.B.row(i) + sign * problem.A.row(i)).transpose(),
                                (f * loads.p0.row(i) + sign * loads.q0.row(i)).transpose(),
                                (f * loads.p1.row(i) + sign * loads.q1.row(i)).transpose()};
      }
   }
   double lowest = infinity;
   const Eigen::Index vertices = loads.vertices();
   for (int i = 0; i < 2; ++i)
   {
      const Condition &plus = conditions[i][0], &minus = conditions[i][1];
      Eigen::Matrix2d lines;
      lines << plus.normal.transpose(), minus.normal.transpose();
      // Parallel lines (an uncoupled node) meet nowhere.
      if (std::abs(lines.determinant()) <= 1e-12 * plus.normal.norm() * minus.normal.norm())
      {
         continue;
      }
      const Eigen::Matrix2d inverse = lines.inverse();
      for (Eigen::Index a = 0; a < vertices; ++a)
      {
         for (Eigen::Index b = 0; b < vertices; ++b)
         {
            // The corner moves along a line as λ grows; it is in the safe region for an
            // interval.
            const Eigen::Vector2d at =
               -(inverse * Eigen::Vector2d(plus.offset[a], minus.offset[b]));
            const Eigen::Vector2d move =
               -(inverse * Eigen::Vector2d(plus.slope[a], minus.slope[b]));
            double from = 0, to = infinity;
            for (int k = 0; k < 2; ++k)
            {
               for (int side = 0; side < 2; ++side)
               {
                  const Condition &c = conditions[k][side];
                  for (Eigen::Index j = 0; j < vertices; ++j)
                  {
                     if (k == i && j == (side == 0 ? a : b)) { continue; }
                     const double room = c.normal.dot(at) + c.offset[j];
                     const double rate = c.normal.dot(move) + c.slope[j];
                     const double zero = 1e-13 * (std::abs(c.offset[j]) + std::abs(room));
                     if (rate > 0) { from = std::max(from, -room / rate); }
                     else if (rate < 0) { to = std::min(to, -room / rate); }
                     else if (room < -zero) { to = -infinity; }
                  }
               }
            }
            if (from <= to && from < lowest)
            {
               lowest = from;
               corner = at + from * move;
            }
         }
      }
   }
   return lowest;
}

/// |M| f with blocks of two components replaced by their length; shifted, where there is one
/// rigid motion t, by multiples of tᵀ, which the forces of every state annihilate: the smaller,
/// the better. Returns the shift of each row.
Eigen::MatrixXd magnitude(const Eigen::MatrixXd &M, const Eigen::VectorXd &t,
                          const Eigen::VectorXd &weight, Eigen::VectorXd &shift)
{
   const Eigen::Index n = M.rows(), m = M.cols();
   Eigen::MatrixXd result(n, n);
   shift = Eigen::VectorXd::Zero(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if (t.size() && m == n)
      {
         // The weighted median of M_ik / t_k makes Σ_k weight_k |M_ik - shift t_k| smallest.
         std::vector<std::pair<double, double>> ratios;
         double total = 0;
         for (Eigen::Index k = 0; k < n; ++k)
         {
            if (t[k] == 0) { continue; }
            ratios.emplace_back(M(i, k) / t[k], weight[k] * std::abs(t[k]));
            total += ratios.back().second;
         }
         std::sort(ratios.begin(), ratios.end());
         double passed = 0;
         for (const auto &[ratio, share] : ratios)
         {
            shift[i] = ratio;
            passed += share;
            if (passed >= 0.5 * total) { break; }
         }
      }
      for (Eigen::Index k = 0; k < n; ++k)
      {
         result(i, k) = m == n ? std::abs(M(i, k) - (t.size() ? shift[i] * t[k] : 0.0))
                               : std::hypot(M(i, k), M(i, n + k));
      }
   }
   return result;
}

} // namespace

LowerLimitReport lower_limit(const LimitProblem &problem, const LimitReport &upper,
                             const LimitSettings &settings)
{
   const ReducedProblem &reduced = problem.reduced;
   const ResidualForces &residual = problem.residual;
   const Eigen::Index n = reduced.nodes();
   LowerLimitReport report;
   report.status = upper.status;
   if (upper.status != LimitStatus::certified && upper.status != LimitStatus::bracketed)
   {
      report.message = "there is no upper limit to compare with: " + upper.message;
      return report;
   }
   if (residual.uncoupled)
   {
      report.kind = LowerLimitKind::uncoupled;
      report.value = upper.limit;
      report.slip = upper.slip;
      report.message =
         "uncoupled: every initial slip shakes down below the upper limit (proven)";
      return report;
   }
   const StuckForces loads = stuck_forces(reduced, problem.cycle);
   if (n == 2 && reduced.components() == 1)
   {
      report.kind = LowerLimitKind::two_nodes;
      report.slip = upper.slip;
      report.value = std::min(upper.limit, two_node_limit(reduced, loads, report.slip));
      report.message =
         "two nodes: exact while the contact stays closed and the rate problem has "
         "one solution";
      return report;
   }

   // The smallest F for pressures like those of the constant loads.
   const Eigen::VectorXd pressure = loads.p0.col(0).cwiseMax(1e-3 * loads.p0.maxCoeff());
   const Eigen::VectorXd t =
      residual.rigid.cols() == 1 ? Eigen::VectorXd(residual.rigid.col(0)) : Eigen::VectorXd();
   Eigen::VectorXd shift;
   const Eigen::MatrixXd F =
      magnitude(residual.transfer, t, reduced.friction.cwiseProduct(pressure), shift) *
      reduced.friction.asDiagonal();
   Eigen::MatrixXd M = residual.transfer;
   if (t.size() && M.cols() == n) { M -= shift * t.transpose(); }

   // I - F has a nonnegative inverse exactly if it maps some positive vector to a positive one.
   const Eigen::PartialPivLU<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(n, n) - F);
   const Eigen::VectorXd witness = factor.solve(pressure);
   if (!witness.allFinite() || witness.minCoeff() <= 0 ||
       (witness - F * witness).minCoeff() <= 0)
   {
      report.message = "no bound: coupling times friction is too large to bound the pressure";
      return report;
   }
   const auto lowest_pressure = [&](const Eigen::MatrixXd &p, const Eigen::MatrixXd &q)
   {
      const Eigen::MatrixXd h = p - M * q;
      return Eigen::MatrixXd(2 * h - factor.solve(h));
   };
   StuckForces lowest = loads;
   lowest.p0 = lowest_pressure(loads.p0, loads.q0);
   lowest.p1 = lowest_pressure(loads.p1, loads.q1);
   ReducedProblem uncoupled = reduced;
   uncoupled.B.setZero();
   ResidualForces shear = residual;
   shear.transfer.setZero();
   shear.uncoupled = shear.opens_freely = true;
   LimitSettings own = settings;
   own.start = nullptr;
   const LimitReport bound = load_limit(uncoupled, shear, lowest, own);
   report.counters = bound.counters;
   report.status = bound.status;
   if (bound.status != LimitStatus::certified && bound.status != LimitStatus::bracketed)
   {
      report.message =
         bound.status == LimitStatus::no_solution
            ? "no bound: some admissible slip may take so much pressure away that "
              "not even the constant loads are sure to stick"
            : bound.message;
      return report;
   }
   report.kind = LowerLimitKind::bound;
   report.value = std::min(bound.lower, upper.limit);
   report.slip = bound.slip;
   report.message =
      "every admissible closed start shakes down below this load factor (proven); "
      "the lower limit itself may be higher";
   return report;
}

} // namespace cattaneo
