#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/wear/wear_cycle.hpp>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd WearCycle::compliance() const
{
   VectorXd c = VectorXd::Zero(depth.size());
   for (Index i = 0; i < c.size(); ++i)
   {
      if (depth[i] > 0 && force[i] > 0) { c[i] = depth[i] / force[i]; }
   }
   return c;
}

WearCycles::WearCycles(const ReducedProblem &problem, const WearLaw &law,
                       const LoadHistory &history, const MarchSettings &settings,
                       const WornIncrementObserver &watch)
   : problem_(problem), law_(law), solver_(problem, settings.friction), settings_(settings),
     history_(history), start_(history.times[history.cycle_start]), watch_(watch)
{
   history_.cycles = 1;
   // wear() reports the progress of all cycles, so a single one reports none. Each may be
   // stopped.
   settings_.monitor.progress = {};
   settings_.keep_increments = false;
   // Slip and forces are straight lines between two events, so that wear can be summed exactly.
   settings_.every_event = true;
   counters += solver_.counters();
}

WearCycle WearCycles::none() const
{
   const VectorXd zero = VectorXd::Zero(problem_.nodes());
   const double infinity = std::numeric_limits<double>::infinity();
   return {zero, zero, zero, VectorXd::Constant(zero.size(), infinity), 0, SlipRange(problem_),
           {},   0,    {}};
}

WearCycle WearCycles::march(const LoadHistory &part, ContactState &contact,
                            const VectorXd &depth, WearCycle cycle)
{
   const Index n = problem_.nodes();
   solver_.set_gap(problem_.gap + depth);
   const ReducedProblem &worn = solver_.problem();
   ContactState before = contact;
   // Force of each node above which it wears.
   const VectorXd threshold = law_.threshold.size() > 0
                                 ? VectorXd(law_.threshold.cwiseProduct(problem_.weights))
                                 : VectorXd::Zero(n);
   VectorXd way = VectorXd::Zero(n), along = way, in_time = way, worn_off = way, lost = way;
   VectorXd way_over = way, along_over = way; // where the force is above the threshold
   double duration = 0;
   const auto note = [&](const ContactState &after, const IncrementRecord &record)
   {
      const Rubbing rub = rubbing(worn, before, after);
      const VectorXd p = 0.5 * (rub.p_from + rub.p_to);
      const VectorXd over = (p - threshold).cwiseMax(0.0);
      worn_off += worn_depth(worn, law_, before, after);
      lost += frictional_loss(worn, before, after);
      cycle.opening = cycle.opening.cwiseMin((after.w + worn.gap).cwiseMax(0.0));
      cycle.range.note(after);
      // Only slip under pressure counts. A node that is lifted off does not wear, and one that
      // has just lifted off still has a pressure of round-off over its whole motion.
      const VectorXd slid = (p.array() > 1e-12 * after.peak_force).select(rub.way, 0);
      way += slid;
      along += p.cwiseProduct(slid);
      way_over += (over.array() > 0).select(slid, 0);
      along_over += over.cwiseProduct(slid);
      in_time += (after.time - before.time) * p;
      duration += after.time - before.time;
      if (watch_) { watch_(after, record, depth); }
      before = after;
   };
   cycle.report = cattaneo::march(solver_, part, contact, settings_, note);
   // If no node slips under a real pressure by more than a solver's tolerance (a hundredth of
   // least_slip()), nothing wears, however many such cycles follow.
   const VectorXd least = 0.01 * least_slip(worn, contact);
   if ((way.array() > least.array() &&
        along.array() > 0.01 * contact.peak_force * least.array())
          .any())
   {
      cycle.depth += worn_off;
      cycle.loss += lost;
   }
   for (Index i = 0; i < n; ++i)
   {
      // Wear takes away the force above the threshold. A node that never exceeds the threshold
      // has its mean force along its slip, one that does not slip its mean force in time.
      cycle.force[i] = along_over[i] > 0 ? along_over[i] / way_over[i]
                       : along[i] > 0    ? along[i] / way[i]
                       : duration > 0    ? in_time[i] / duration
                                         : 0;
      if (cycle.force[i] > 0) { cycle.opening[i] = 0; }
   }
   const VectorXd pressure = contact.peak_force * problem_.weights.cwiseInverse();
   cycle.negligible = 1e-12 * contact.v.cwiseAbs().maxCoeff() *
                      law_.coefficient.cwiseProduct(pressure).maxCoeff();
   counters += cycle.report.counters;
   return cycle;
}

WearCycle WearCycles::opening(ContactState &contact, const VectorXd &depth)
{
   if (history_.cycle_start == 0) { return none(); } // nothing before the cycle
   LoadHistory part = history_;
   part.times.conservativeResize(part.cycle_start + 1);
   part.multipliers.conservativeResize(Eigen::NoChange, part.cycle_start + 1);
   part.cycle_start = -1;
   return march(part, contact, depth, none());
}

WearCycle WearCycles::march(ContactState &contact, const VectorXd &depth, bool update)
{
   contact.time = start_;
   WearCycle all = none();
   if (!update) { all = march(history_, contact, depth, none()); }
   for (Index point = history_.cycle_start; update && point + 1 < history_.times.size();
        ++point)
   {
      LoadHistory piece;
      piece.times = history_.times.segment(point, 2);
      piece.multipliers = history_.multipliers.middleCols(point, 2);
      const VectorXd so_far = depth + all.depth;
      all = march(piece, contact, so_far, std::move(all));
      if (!all.found()) { break; }
   }
   marched += all.found();
   return all;
}

WearCycle WearCycles::repeated(ContactState &contact, const VectorXd &depth, double share,
                               double least, double cycles)
{
   WearCycle before = march(contact, depth, false);
   std::vector<VectorXd> passed;
   double change_before = 0;
   for (int k = 0; k < 30 && before.found(); ++k)
   {
      passed.push_back(before.depth);
      WearCycle cycle = march(contact, depth, false);
      if (!cycle.found()) { return cycle; }
      const double most = std::max(cycle.depth.maxCoeff(), least),
                   change = (cycle.depth - before.depth).cwiseAbs().maxCoeff();
      // Bound the sum of the changes in all cycles that are still to come. At worst each is as
      // large as this one. If this one is smaller than the one before, they are taken to go on
      // falling by the same factor.
      double left = cycles * change;
      if (change < change_before)
      {
         left = std::min(left, change * change / (change_before - change));
      }
      if (left <= share * most || change <= 1e-11 * most || cycle.idle())
      {
         VectorXd off = VectorXd::Zero(depth.size());
         for (const VectorXd &lost : passed) { off += (lost - cycle.depth).cwiseAbs(); }
         cycle.passing = off.maxCoeff();
         cycle.lag = passed.front() - cycle.depth;
         return cycle;
      }
      change_before = change;
      before = std::move(cycle);
   }
   if (before.found()) { before.report.status = FrictionStatus::stalled; }
   return before;
}

bool WearCycles::settle(ContactState &contact, const VectorXd &depth)
{
   solver_.set_gap(problem_.gap + depth);
   const Counters before = solver_.counters();
   const FrictionStatus status = solver_.solve(contact, contact.multipliers).status;
   counters += solver_.counters();
   counters -= before;
   return status == FrictionStatus::converged || status == FrictionStatus::not_unique;
}

VectorXd implicit_wear(const ReducedProblem &problem, const WearCycle &cycle, double cycles)
{
   // The pressures p' at the end of these cycles follow from δw = u - c p' and p' = p + C δw,
   // with the openings u of the worn surfaces. So p' = (1 + C c)⁻¹ (p + C u), which is a
   // contact without friction and with another stiffness.
   const Index n = problem.nodes();
   const VectorXd c = cycles * cycle.compliance(), root = c.cwiseSqrt();
   const MatrixXd half = root.asDiagonal() * problem.C();
   MatrixXd inner = half * root.asDiagonal();
   inner.diagonal().array() += 1;
   DenseCholesky factor;
   if (!factor.compute(inner)) { return {}; }
   const MatrixXd removed = half.transpose() * factor.solved(half);
   ReducedProblem layered;
   layered.K = problem.C() - 0.5 * (removed + removed.transpose());
   layered.rigid_motions = rigid_openings(problem);
   layered.gap = cycle.opening;
   layered.friction = VectorXd::Zero(n);
   layered.weights = problem.weights;
   layered.chains = one_chain(n);
   // (1 + C c)⁻¹ p = p - C √c (1 + √c C √c)⁻¹ √c p
   const VectorXd p =
      cycle.force - half.transpose() * factor.solved(root.cwiseProduct(cycle.force));
   layered.patterns = {{"pressure", Control::force, VectorXd(), p}};
   ContactState state = ContactState::virgin(layered);
   FrictionSolver solver(layered);
   if (solver.solve(state, VectorXd::Ones(1)).status != FrictionStatus::converged)
   {
      return {};
   }
   return c.cwiseProduct(state.p.cwiseMax(0.0));
}

double explicit_limit(const ReducedProblem &problem, const WearCycle &cycle)
{
   const VectorXd root = cycle.compliance().cwiseSqrt();
   if (root.isZero(0)) { return std::numeric_limits<double>::infinity(); }
   return 2 /
          symmetric_eigenvalues(root.asDiagonal() * problem.C() * root.asDiagonal()).maxCoeff();
}

} // namespace cattaneo
