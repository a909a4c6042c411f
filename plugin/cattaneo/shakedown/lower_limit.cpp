#include <algorithm>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/infinity.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cmath>

namespace cattaneo
{

namespace
{

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
   Condition conditions[4]; // 2 i + side
   for (int k = 0; k < 4; ++k)
   {
      const int i = k / 2;
      const double f = problem.friction[i], sign = k % 2 == 0 ? 1 : -1;
      conditions[k] = {f * problem.B().row(i) + sign * problem.A().row(i),
                       f * loads.p0.row(i) + sign * loads.q0.row(i),
                       f * loads.p1.row(i) + sign * loads.q1.row(i)};
   }
   double lowest = infinity;
   const Eigen::Index vertices = loads.vertices();
   for (int i = 0; i < 2; ++i)
   {
      const Condition &plus = conditions[2 * i], &minus = conditions[2 * i + 1];
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
            for (int k = 0; k < 4; ++k)
            {
               const Condition &c = conditions[k];
               for (Eigen::Index j = 0; j < vertices; ++j)
               {
                  if (k / 2 == i && j == (k % 2 == 0 ? a : b)) { continue; }
                  const double room = c.normal.dot(at) + c.offset[j];
                  const double rate = c.normal.dot(move) + c.slope[j];
                  const double zero = 1e-13 * (std::abs(c.offset[j]) + std::abs(room));
                  if (rate > 0) { from = std::max(from, -room / rate); }
                  else if (rate < 0) { to = std::min(to, -room / rate); }
                  else if (room < -zero) { to = -infinity; }
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

/// Length of each node's block in each row of M. If there is one rigid motion t, each row is
/// first shifted by the multiple of tᵀ that makes the weighted sum of its lengths smallest.
/// `shift` gets that multiple for each row.
Eigen::MatrixXd magnitude(const Eigen::MatrixXd &M, const Eigen::VectorXd &t,
                          const Eigen::VectorXd &weight, Eigen::VectorXd &shift)
{
   const Eigen::Index n = M.rows();
   shift = Eigen::VectorXd::Zero(n);
   if (M.cols() == 2 * n)
   {
      return (M.leftCols(n).array().square() + M.rightCols(n).array().square()).sqrt();
   }
   if (t.size() == 0) { return M.cwiseAbs(); }
   Eigen::MatrixXd result(n, n);
   for (Eigen::Index i = 0; i < n; ++i)
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
      result.row(i) = (M.row(i) - shift[i] * t.transpose()).cwiseAbs();
   }
   return result;
}

} // namespace

LeastPressure least_pressure(const ReducedProblem &problem, const ResidualForces &residual,
                             const Eigen::VectorXd &pressure)
{
   const Eigen::Index n = problem.nodes();
   const Eigen::MatrixXd &M = residual.transfer;
   const auto f = problem.friction.asDiagonal();
   const Eigen::VectorXd t = residual.rigid.cols() == 1 && M.cols() == n
                                ? Eigen::VectorXd(residual.rigid.col(0))
                                : Eigen::VectorXd();
   const Eigen::VectorXd weight = problem.friction.cwiseProduct(pressure);
   LeastPressure least;

   // If y violates its condition by δ, y + δ z meets it, for any row z > 0 with z ≥ 1 + |z f
   // M|. The solution of z (I - F) = 1 is such a row if it is positive. It is positive exactly
   // if the repetition below, y ← magnitude(M - y f M), contracts.
   Eigen::VectorXd first_shift, shift;
   const Eigen::MatrixXd F = f * magnitude(M, t, weight, first_shift);
   const Eigen::RowVectorXd ones = Eigen::RowVectorXd::Ones(n);
   const Eigen::MatrixXd contraction = Eigen::MatrixXd::Identity(n, n) - F;
   DenseLU factors;
   if (!factors.compute(contraction)) { return least; }
   Eigen::VectorXd lifted = Eigen::VectorXd::Ones(n);
   factors.solve_transposed(lifted);
   const Eigen::RowVectorXd z = lifted.transpose();
   if (!z.allFinite() || z.minCoeff() <= 0 || (z - z * F).minCoeff() < 0.5) { return least; }

   Eigen::MatrixXd y = magnitude(M, t, weight, shift);
   double excess = infinity;
   for (int repetition = 0; repetition < 1000; ++repetition)
   {
      const Eigen::MatrixXd next = magnitude(M - y * f * M, t, weight, shift);
      excess = std::max((next - y).maxCoeff(), 0.0);
      if ((next - y).cwiseAbs().maxCoeff() <= 1e-13 * y.maxCoeff()) { break; }
      y = next;
   }
   // Twice: z meets its own condition to round-off.
   y += Eigen::VectorXd::Constant(n, 2 * excess) * z;
   shift.array() -= 2 * excess * z.transpose().cwiseProduct(problem.friction).dot(first_shift);
   least.exists = true;
   least.by_normal = Eigen::MatrixXd::Identity(n, n) - y * f;
   least.by_shear = -least.by_normal * M;
   if (t.size()) { least.by_shear += shift * t.transpose(); }
   return least;
}

LowerLimitReport lower_limit(const LimitProblem &problem, const LimitReport &upper,
                             const LimitSettings &settings, const NodeList &apart)
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
   if (!reduced.laws.empty())
   {
      report.message = "no bound: if slip changes pressures (B is not zero), "
                       "a bound is known for "
                       "Coulomb's law only";
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

   const LeastPressure least =
      least_pressure(reduced, residual, loads.p0.col(0).cwiseMax(1e-3 * loads.p0.maxCoeff()));
   if (!least.exists)
   {
      report.message =
         "no bound: the product of coupling and friction is too large to bound the pressure";
      return report;
   }
   StuckForces lowest = loads;
   lowest.p0 = least.by_normal * loads.p0 + least.by_shear * loads.q0;
   lowest.p1 = least.by_normal * loads.p1 + least.by_shear * loads.q1;
   // There is no condition on the exempt nodes: any force that they could ever carry is
   // allowed.
   for (const Eigen::Index node : apart.empty() ? apart : chosen_nodes(reduced, apart))
   {
      lowest.p0.row(node).setConstant(loads.p0.cwiseAbs().sum());
      lowest.p1.row(node).setZero();
   }
   ReducedProblem uncoupled = reduced;
   uncoupled.B().setZero();
   join_coupling(uncoupled);
   const Eigen::MatrixXd slips = rigid_slips(reduced), openings = rigid_openings(reduced);
   uncoupled.rigid_motions.setZero(reduced.K.rows(), slips.cols() + openings.cols());
   uncoupled.rigid_motions.topLeftCorner(slips.rows(), slips.cols()) = slips;
   uncoupled.rigid_motions.bottomRightCorner(openings.rows(), openings.cols()) = openings;
   ResidualForces shear = residual;
   shear.transfer.setZero();
   shear.uncoupled = true;
   LimitSettings own = settings;
   own.start = nullptr;
   const LimitReport bound = load_limit(uncoupled, shear, lowest, own);
   report.counters = bound.counters;
   report.status = bound.status;
   if (bound.status != LimitStatus::certified && bound.status != LimitStatus::bracketed)
   {
      report.message = bound.message;
      Eigen::Index node = 0;
      if (bound.status == LimitStatus::no_solution && lowest.p0.col(0).minCoeff(&node) <= 0)
      {
         report.message =
            "no bound: an admissible slip may take all pressure from node " +
            std::to_string(node) +
            " even under the constant loads, but the proof needs pressure at every node";
      }
      else if (bound.status == LimitStatus::no_solution)
      {
         report.message = "no bound: some admissible slip may take away so much pressure that "
                          "nodes may slip even under the constant loads";
      }
      return report;
   }
   report.kind = apart.empty() ? LowerLimitKind::bound : LowerLimitKind::apart;
   report.value = std::min(bound.lower, upper.limit);
   report.slip = bound.slip;
   if (!apart.empty())
   {
      report.message = "below this load factor, slip that goes on for ever in a closed contact "
                       "includes slip at an exempt node (proven)";
      return report;
   }
   report.message =
      "below this load factor every admissible start with closed contact shakes down (proven); "
      "the lower limit itself may be higher";
   return report;
}

void tell_starts(LimitReport &upper, const LowerLimitReport &lower)
{
   if (!upper.coupled)
   {
      upper.every_start = upper.limit;
      upper.starts = "uncoupled: every start shakes down below the limit (proven)";
      return;
   }
   const bool known = lower.kind != LowerLimitKind::none && lower.kind != LowerLimitKind::apart;
   if (known) { upper.every_start = lower.value; }
   upper.starts =
      "coupled (degree " + nine_digits(upper.coupling) +
      "): below the limit some start shakes down, but not every start has to, and a march from "
      "rest may slip for ever; λ1, below which every start shakes down, ";
   if (lower.kind == LowerLimitKind::two_nodes)
   {
      upper.starts += "is " + nine_digits(lower.value) +
                      " (two nodes: exact while the contact stays "
                      "closed and the rate problem has one solution)";
   }
   else if (known) { upper.starts += "is at least " + nine_digits(lower.value) + " (proven)"; }
   else if (lower.message.empty()) { upper.starts += "was not computed: call lower_limit()"; }
   else { upper.starts += "is not known: " + lower.message; }
}

} // namespace cattaneo
