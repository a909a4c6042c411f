#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/infinity.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

namespace
{

/// Calls visit(a, b) for every pair of vertices, and for (a, a) if there is only one.
template <class Visitor>
void for_each_pair(Eigen::Index vertices, Visitor visit)
{
   if (vertices == 1) { visit(Eigen::Index(0), Eigen::Index(0)); }
   for (Eigen::Index a = 0; a < vertices; ++a)
   {
      for (Eigen::Index b = a + 1; b < vertices; ++b) { visit(a, b); }
   }
}

/// (4.9) with the pressures @a p; infinite where a sum of pressures is not positive.
PointwiseEstimate pointwise(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p,
                            const NodeList &nodes)
{
   PointwiseEstimate estimate;
   estimate.value = -1;
   for_each_pair(q.cols(),
                 [&](Eigen::Index a, Eigen::Index b)
                 {
                    const Eigen::VectorXd jump =
                       tangential_lengths(q.col(a) - q.col(b), p.rows());
                    for (const Eigen::Index i : nodes)
                    {
                       const double sum = p(i, a) + p(i, b);
                       const double f = sum > 0 ? jump[i] / sum : infinity;
                       if (f > estimate.value) { estimate = {f, i}; }
                    }
                 });
   return estimate;
}

/// Smallest cost·r over low ≤ r ≤ high with t·r = 0, which must have a solution: move the
/// cheapest first (a continuous knapsack, solved by sorting).
double cheapest(const Eigen::VectorXd &cost, const Eigen::VectorXd &t,
                const Eigen::VectorXd &low, const Eigen::VectorXd &high)
{
   const Eigen::Index n = cost.size();
   // Start where t·r is smallest and raise it to zero.
   double value = 0, missing = 0;
   std::vector<Eigen::Index> order;
   for (Eigen::Index k = 0; k < n; ++k)
   {
      if (t[k] == 0)
      {
         value += std::min(cost[k] * low[k], cost[k] * high[k]);
         continue;
      }
      const double start = t[k] > 0 ? low[k] : high[k];
      value += cost[k] * start;
      missing -= t[k] * start;
      order.push_back(k);
   }
   std::sort(order.begin(), order.end(),
             [&](Eigen::Index a, Eigen::Index b) { return cost[a] / t[a] < cost[b] / t[b]; });
   for (const Eigen::Index k : order)
   {
      const double room = std::min(std::abs(t[k]) * (high[k] - low[k]), missing);
      if (room <= 0) { continue; }
      value += room * cost[k] / t[k];
      missing -= room;
   }
   return value;
}

} // namespace

PointwiseEstimate method1_friction(const ReducedProblem &problem, const LoadCycle &cycle,
                                   double load_factor, const NodeList &nodes)
{
   require_coulomb(problem, "method 1");
   const StuckForces forces = stuck_forces(problem, cycle);
   return pointwise(forces.q(load_factor), forces.p(load_factor), chosen_nodes(problem, nodes));
}

PointwiseEstimate method1_load(const ReducedProblem &problem, const LoadCycle &cycle,
                               const NodeList &nodes)
{
   require_coulomb(problem, "method 1");
   const NodeList looked_at = chosen_nodes(problem, nodes);
   const StuckForces forces = stuck_forces(problem, cycle);
   const Eigen::Index n = problem.nodes();
   PointwiseEstimate estimate;
   estimate.value = infinity;
   for_each_pair(forces.vertices(),
                 [&](Eigen::Index a, Eigen::Index b)
                 {
                    // The constant loads are the same at a and b: their shear drops out.
                    const Eigen::VectorXd jump =
                       tangential_lengths(forces.q1.col(a) - forces.q1.col(b), n);
                    for (const Eigen::Index i : looked_at)
                    {
                       const double f = problem.friction[i];
                       const double room = f * 2 * forces.p0(i, a);
                       const double use = jump[i] - f * (forces.p1(i, a) + forces.p1(i, b));
                       const double at = room < 0 ? 0 : use > 0 ? room / use : infinity;
                       if (at < estimate.value) { estimate = {at, i}; }
                    }
                 });
   return estimate;
}

Method2Estimate method2_friction(const LimitProblem &problem, double load_factor,
                                 const NodeList &nodes)
{
   const ReducedProblem &reduced = problem.reduced;
   const Eigen::Index n = reduced.nodes();
   require_coulomb(reduced, "method 2");
   require(reduced.components() == 1, "estimate by method 2: the problem has ",
           reduced.components(), " tangential components, must have 1");
   require(problem.residual.rigid.cols() <= 1, "estimate by method 2: the contact has ",
           problem.residual.rigid.cols(), " tangential rigid motions, must have at most 1");
   const StuckForces forces = stuck_forces(reduced, problem.cycle);
   const Eigen::MatrixXd q = forces.q(load_factor), p = forces.p(load_factor);
   const Eigen::MatrixXd &M = problem.residual.transfer;

   Method2Estimate estimate;
   const NodeList looked_at = chosen_nodes(reduced, nodes);
   const double f1 = pointwise(q, p, looked_at).value;
   if (!std::isfinite(f1))
   {
      estimate.message = "the stuck contact is in tension at a node";
      return estimate;
   }
   estimate.residual_low = (-f1 * p - q).rowwise().maxCoeff();
   estimate.residual_high = (f1 * p - q).rowwise().minCoeff();
   // At the node that decides f1 both ends are equal, up to rounding. A node that was left out
   // may need more than f1. Its range is then empty, and it gets the middle of both ends.
   const Eigen::VectorXd middle = 0.5 * (estimate.residual_low + estimate.residual_high);
   estimate.residual_low = estimate.residual_low.cwiseMin(middle);
   estimate.residual_high = estimate.residual_high.cwiseMax(middle);
   const Eigen::VectorXd &low = estimate.residual_low, &high = estimate.residual_high;
   const Eigen::VectorXd t = problem.residual.rigid.cols()
                                ? Eigen::VectorXd(problem.residual.rigid.col(0))
                                : Eigen::VectorXd(Eigen::VectorXd::Zero(n));
   const Eigen::VectorXd width = high - low;
   const double smallest = cheapest(t, Eigen::VectorXd::Zero(n), low, high);
   const double largest = -cheapest(-t, Eigen::VectorXd::Zero(n), low, high);
   estimate.exists = smallest <= 0 && largest >= 0;
   if (!estimate.exists)
   {
      estimate.message = "every residual shear within the limits of method 1 (thesis 4.9) has "
                         "a resultant, must have none";
      return estimate;
   }

   // The same relative height in the range of each node; zero is the middle without a rigid
   // motion.
   const double span = t.dot(width);
   const double height =
      t.isZero() || span == 0 ? 0.5 : std::min(1.0, std::max(0.0, -t.dot(low) / span));
   estimate.natural_residual = low + height * width;
   const auto with_residual = [&](const Eigen::VectorXd &r)
   { return pointwise(q, p.colwise() + Eigen::VectorXd(M * r), looked_at).value; };
   estimate.natural = with_residual(estimate.natural_residual);

   Eigen::VectorXd lowest(n);
   for (Eigen::Index i = 0; i < n; ++i) { lowest[i] = cheapest(M.row(i), t, low, high); }
   estimate.high = pointwise(q, p.colwise() + lowest, looked_at).value;

   // Least friction over the choices: quasi-convex, solved as friction_limit does, with (4.9)
   // as cones: half the jump of the shear against f times the mean pressure.
   ConeProgramme programme;
   programme.residual = &problem.residual;
   programme.pressure_only = true;
   programme.r_low = low;
   programme.r_high = high;
   programme.ceiling = 1e6;
   const Eigen::Index vertices = forces.vertices();
   const Eigen::Index pairs = std::max<Eigen::Index>(1, vertices * (vertices - 1) / 2);
   StuckForces &loads = programme.loads;
   loads.q0.resize(n, pairs);
   loads.p0.resize(n, pairs);
   Eigen::Index pair = 0;
   for_each_pair(vertices,
                 [&](Eigen::Index a, Eigen::Index b)
                 {
                    loads.q0.col(pair) = 0.5 * (q.col(a) - q.col(b));
                    loads.p0.col(pair++) = 0.5 * (p.col(a) + p.col(b));
                 });
   // The others get so much pressure that they never decide.
   std::vector<bool> decides(n, false);
   for (const Eigen::Index i : looked_at) { decides[i] = true; }
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if (decides[i]) { continue; }
      loads.q0.row(i).setZero();
      loads.p0.row(i).setConstant(p.row(i).cwiseAbs().maxCoeff() + 2 * std::abs(lowest[i]));
   }
   loads.q1 = Eigen::MatrixXd::Zero(n, pairs);
   programme.force_scale = loads.p0.cwiseAbs().rowwise().maxCoeff();
   estimate.low = estimate.natural;
   ConeStart start;
   start.r = estimate.natural_residual;
   constexpr int max_programmes = 20;
   for (int k = 0; k < max_programmes && estimate.low > 0; ++k)
   {
      programme.friction.setConstant(n, pairs, estimate.low);
      const Eigen::MatrixXd pressure = loads.p0.colwise() + Eigen::VectorXd(M * start.r);
      loads.p1 = -pressure / estimate.low;
      programme.theta_scale = estimate.low;
      const ConeSolution solution = solve(programme, {}, start);
      ++estimate.counters.limit_solves;
      if (solution.outcome == ConeOutcome::unavailable || solution.r.size() != n)
      {
         estimate.low = std::numeric_limits<double>::quiet_NaN();
         estimate.message = solution.message;
         return estimate;
      }
      const double next = with_residual(solution.r);
      const bool settled = !(next < estimate.low * (1 - 1e-9));
      estimate.low = std::min(estimate.low, next);
      if (settled) { break; }
      start.r = solution.r;
   }
   return estimate;
}

} // namespace cattaneo
