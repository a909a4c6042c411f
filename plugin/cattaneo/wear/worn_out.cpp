#include <algorithm>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/progress_report.hpp>
#include <cattaneo/wear/wear_cycle.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <limits>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Largest overlap of each node at the points of the cycle, with all but the sticking nodes
/// free; empty if these do not hold the bodies.
VectorXd overlap_of_free_nodes(const ReducedProblem &problem, const LoadHistory &history,
                               const VectorXd &slip, const std::vector<bool> &stick)
{
   const Index n = problem.nodes(), m = problem.slips();
   VectorXd u(m + n);
   // Sticking nodes keep their slip and stay closed. All other unknowns are free, and their
   // forces zero.
   u << slip, -problem.gap;
   std::vector<Index> open;
   for (Index row = 0; row < m + n; ++row)
   {
      const bool held = std::count(problem.held.begin(), problem.held.end(), row) > 0;
      if (stick[row % n] || held) { continue; }
      open.push_back(row);
      u[row] = 0;
   }
   DenseCholesky factor;
   if (!factor.compute(problem.K(open, open))) { return {}; }
   VectorXd overlap = VectorXd::Constant(n, -std::numeric_limits<double>::infinity());
   for (Index k = history.cycle_start; k < history.times.size(); ++k)
   {
      const VectorXd forces =
         problem.clamped_forces(history.multipliers.col(k)) + problem.K * u;
      VectorXd x = -forces(open);
      factor.solve(x);
      VectorXd all = u;
      all(open) = x;
      overlap = overlap.cwiseMax(-all.tail(n) - problem.gap);
   }
   for (Index i = 0; i < n; ++i)
   {
      if (stick[i]) { overlap[i] = 0; }
   }
   return overlap;
}

} // namespace

WornOut worn_out(const ReducedProblem &problem, const LoadHistory &history,
                 const ContactState &contact, const MarchSettings &settings)
{
   require_coulomb(problem, "wear");
   const WearLaw law = WearLaw::uniform(problem, 1);
   law.validate(problem);
   settings.validate();
   contact.validate(problem);
   LoadHistory once = history;
   once.cycles = 1;
   once.validate(problem);
   require(
      history.cycle_start >= 0,
      "worn out: the load history has no cycle, must have one: its last points repeat from its "
      "cycle start on");
   const Index n = problem.nodes();
   const VectorXd none = VectorXd::Zero(n);
   // Worn nodes touch without force, and open and close by round-off. The exact path would
   // follow each such change, so increments are used.
   MarchSettings by_increments = settings;
   by_increments.stepping = Stepping::fixed;
   WearCycles cycles(problem, law, history, settings),
      check(problem, law, history, by_increments);
   WornOut result{{}, {}, {}, {}, {}, contact, SlipRange(problem), {}, 0, 0, {}};
   const auto fails = [&](const WearCycle &cycle)
   {
      if (cycle.found()) { return false; }
      result.status = cycle.report.status;
      result.message = cycle.report.message.empty() ? "the cycle did not become steady"
                                                    : cycle.report.message;
      return true;
   };
   // If the state is already beyond the opening part, nothing of that is left to march.
   if (fails(cycles.opening(result.contact, none))) { return result; }
   const WearCycle first = cycles.repeated(result.contact, none, 1e-8);
   if (fails(first)) { return result; }
   result.unworn = result.contact;
   result.cut_off = cut_off_contact(problem, result.unworn);
   result.range = first.range;
   if (first.idle())
   {
      // The cycle takes no energy, so nothing wears. This also holds for a cycle in which the
      // bodies part, so that no node sticks throughout.
      result.status = FrictionStatus::converged;
      result.depth = none;
      result.overlap = -first.opening;
      result.stick.assign(n, false);
      return result;
   }
   const auto moved = [&](const WearCycle &cycle)
   {
      const VectorXd range = cycle.range.range(), least = least_slip(problem, result.contact);
      std::vector<bool> slips(n);
      for (Index i = 0; i < n; ++i) { slips[i] = range[i] > least[i]; }
      return slips;
   };
   const std::vector<bool> slips = moved(first);
   result.stick.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      result.stick[i] = !slips[i] && first.range.always_closed()[i];
   }
   ProgressReport progress(settings.monitor);
   // Each search removes nodes from the set, so it ends soon. Some more searches are allowed,
   // because locked-in slip may shift with the set.
   for (Index most = n + 20; result.searches < most;)
   {
      progress.note(std::numeric_limits<double>::quiet_NaN(), result.searches);
      if (settings.monitor.stopped())
      {
         result.status = FrictionStatus::stopped;
         result.message = "the search was stopped on request";
         return result;
      }
      ++result.searches;
      // The depth is the overlap that all but the sticking nodes would have.
      result.overlap = overlap_of_free_nodes(problem, history, result.contact.v, result.stick);
      if (result.overlap.size() == 0 ||
          std::count(result.stick.begin(), result.stick.end(), true) == 0)
      {
         result.status = FrictionStatus::gross_sliding;
         result.message =
            "no node was found that sticks throughout the cycle: wear may have no end";
         return result;
      }
      result.depth = result.overlap.cwiseMax(0.0);
      // Two cycles on that gap check it, the first of them lets the slip settle.
      WearCycle worn = check.march(result.contact, result.depth, false);
      if (worn.found()) { worn = check.march(result.contact, result.depth, false); }
      if (fails(worn)) { return result; }
      result.loss = worn.loss.sum() / first.loss.sum();
      if (result.loss <= 1e-8)
      {
         result.status = FrictionStatus::converged;
         if (result.cut_off.empty()) // pressures where overlaps would press without wear
         {
            ContactState unworn = result.contact;
            unworn.p = result.depth;
            std::fill(unworn.status.begin(), unworn.status.end(), NodeState::stick);
            result.cut_off = cut_off_contact(problem, unworn);
         }
         return result;
      }
      const std::vector<bool> slips_worn = moved(worn);
      for (Index i = 0; i < n; ++i)
      {
         const bool leaves = slips_worn[i] ? worn.depth[i] > 0 : !worn.range.always_closed()[i];
         if (leaves) { result.stick[i] = false; }
      }
   }
   std::ostringstream message;
   message << "the sticking nodes of the fully worn state were not found: slipping nodes still "
              "carry load, and a cycle loses "
           << result.loss << " of the energy of the unworn one";
   result.status = FrictionStatus::stalled;
   result.message = message.str();
   return result;
}

} // namespace cattaneo
