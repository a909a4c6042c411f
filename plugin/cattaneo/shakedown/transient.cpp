#include <algorithm>
#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <cmath>
#include <random>

namespace cattaneo
{

namespace
{

/// Do the constant loads lie between the last and the first vertex?
bool starts_at_constant(const LoadCycle &cycle)
{
   // constant + λ varying: zero must lie between the two varying parts.
   const Eigen::VectorXd a = cycle.varying.col(cycle.vertices() - 1), b = cycle.varying.col(0);
   const double size = a.norm() * b.norm();
   return size == 0 || a.dot(b) <= -(1 - 1e-12) * size;
}

/// Was a solution found?
bool solved(FrictionStatus status)
{
   return status == FrictionStatus::converged || status == FrictionStatus::not_unique;
}

/// The slip, over the elastic slip, and the loss, over the scale of losses, that count as none.
constexpr double nothing = 1e-9;

/// The slip path of each node that carries a force at some time of a cycle, cycle by cycle. Its
/// motion while it is open counts too, because the next cycle reverses it.
class CycleWay
{
public:
   explicit CycleWay(const ContactState &start) : v_(start.v), p_(start.p)
   {
      now_ = before_ = most_p_ = Eigen::VectorXd::Zero(start.p.size());
   }
   void note(const ContactState &state, int cycle)
   {
      if (cycle != cycle_)
      {
         before_ = last();
         now_.setZero();
         most_p_.setZero();
         cycle_ = cycle;
      }
      now_ += tangential_lengths(state.v - v_, now_.size());
      most_p_ = most_p_.cwiseMax(p_).cwiseMax(state.p);
      least_ = nothing * state.peak_force;
      v_ = state.v;
      p_ = state.p;
   }
   Eigen::VectorXd last() const
   {
      return (most_p_.array() > least_).select(now_, Eigen::VectorXd::Zero(now_.size()));
   }
   Eigen::VectorXd of_two() const { return last().cwiseMax(before_); }

private:
   Eigen::VectorXd v_, p_, now_, before_, most_p_;
   double least_ = 0; // force above which a node counts as loaded
   int cycle_ = 0;
};

/** Do losses fall towards zero? Three losses, ten cycles apart (fewer if there are not so many
    cycles), are continued as a geometric series. The answer is yes if its limit is less than
    half of the last loss. A loss that falls towards a level has that level as its limit. */
bool falls_to_nothing(const std::vector<double> &loss)
{
   const std::size_t last = loss.size() - 1, step = std::min<std::size_t>(10, last / 2);
   if (step == 0) { return false; }
   const double first = loss[last - 2 * step], middle = loss[last - step], end = loss[last];
   const double bend = first - 2 * middle + end;
   if (!(end <= middle * std::pow(0.999, step)) || !(bend > 0)) { return false; }
   return (first * end - middle * middle) / bend <= 0.5 * end;
}

} // namespace

const char *name(TransientVerdict verdict)
{
   const char *const names[] = {"shaken down",    "moves only at nodes that open",
                                "cyclic slip",    "still slipping",
                                "no equilibrium", "stopped"};
   return names[static_cast<int>(verdict)];
}

void TransientSettings::validate() const
{
   require_at_least("transient: cycles", cycles, 1);
   require_between("transient: shaken_down", shaken_down, 0, 1);
   require(!std::isnan(upper), "transient: `upper` is not a number, must be a load factor");
   march.validate();
}

void CounterExampleSettings::validate() const
{
   require_at_least("counter-example: starts", starts, 0);
   require_at_least("counter-example: halvings", halvings, 1);
   transient.validate();
}

TransientReport transient(FrictionSolver &solver, const LimitProblem &problem,
                          double load_factor, const Eigen::VectorXd &start,
                          const TransientSettings &settings)
{
   settings.validate();
   const ReducedProblem &reduced = problem.reduced;
   const LoadCycle &cycle = problem.cycle;
   TransientReport report;
   report.load_factor = load_factor;
   const Eigen::MatrixXd q = stuck_forces(reduced, cycle).q(load_factor);
   report.energy =
      0.5 * q.cwiseProduct(problem.residual.flexibility * q).colwise().sum().maxCoeff();
   report.elastic_slip = (problem.residual.flexibility * q).cwiseAbs().maxCoeff();

   ContactState state = ContactState::with_slip(reduced, start);
   const Counters before = solver.counters();
   const IncrementReport pressed = solver.solve(state, cycle.constant);
   report.counters += solver.counters();
   report.counters -= before;
   report.status = pressed.status;
   report.message = pressed.message;
   report.event_multipliers = cycle.constant;
   report.slip = state.v;
   if (!solved(pressed.status)) { return report; }

   const LoadHistory history =
      cycle.history(load_factor, {cycle.constant}, starts_at_constant(cycle), settings.cycles);
   state.time = 0;
   state.cycle_slip.clear();
   SlipRange slip(reduced); // of the present cycle
   CycleWay way(state);
   int cycle_now = 0;
   const auto observe = [&](const ContactState &now, const IncrementRecord &record)
   {
      way.note(now, record.cycle);
      if (record.cycle != cycle_now) { slip.start(now); }
      else { slip.note(now); }
      cycle_now = record.cycle;
   };
   // A march ends when slip changes little from cycle to cycle. Changes are compared with the
   // elastic slip, and not with a start that may be much larger. They cannot be resolved below
   // the round-off of the start.
   MarchSettings marching = settings.march;
   marching.every_event = true; // slip is largest and smallest at events
   const double begun = start.lpNorm<Eigen::Infinity>();
   if (begun > report.elastic_slip && report.elastic_slip > 0)
   {
      const double least = std::min(1e-13, marching.steady_tolerance);
      marching.steady_tolerance =
         std::max(least, marching.steady_tolerance * report.elastic_slip / begun);
   }
   const MarchReport marched = march(solver, history, state, marching, observe);
   report.status = marched.status;
   report.message = marched.message;
   report.event_time = marched.event_time;
   report.event_multipliers = marched.event_multipliers;
   report.steady_cycle = marched.steady_cycle;
   report.steady_period = marched.steady_period;
   report.cut_off = marched.cut_off;
   report.counters += marched.counters;
   report.slip = state.v;
   for (std::size_t i = 0; i < slip.always_closed().size(); ++i)
   {
      if (!slip.always_closed()[i]) { report.opened.push_back(static_cast<Eigen::Index>(i)); }
   }
   std::vector<double> loss; // at the nodes that stay closed
   for (const CycleRecord &record : marched.cycles)
   {
      report.dissipation.push_back(record.dissipation);
      const Eigen::VectorXd sizes = record.node_dissipation.cwiseAbs();
      report.opened_loss = sizes(report.opened).sum();
      loss.push_back(sizes.sum() - report.opened_loss);
   }
   if (marched.status == FrictionStatus::stopped)
   {
      report.verdict = TransientVerdict::stopped;
   }
   if (loss.empty()) { return report; }

   const double scale = std::max(report.dissipation[0], report.energy);
   const double little = settings.shaken_down * scale, none = nothing * scale;
   const std::size_t cycles = loss.size();
   // In a steady state of period two one of both cycles may lose and slip little, so the larger
   // values count.
   const bool alike = marched.steady_period == 1 || cycles < 2;
   const double last = alike ? loss.back() : std::max(loss.back(), loss[cycles - 2]);
   report.cycle_slip = alike ? way.last() : way.of_two();
   Eigen::VectorXd closed_slip = report.cycle_slip;
   closed_slip(report.opened).setZero();
   const double slips = nothing * report.elastic_slip;
   // The limit says nothing about nodes that open, so their slip is judged apart.
   const double opened_slip =
      report.opened.empty() ? 0 : report.cycle_slip(report.opened).maxCoeff();
   bool opened_moves = report.opened_loss > none || opened_slip > slips;
   if (solved(marched.status))
   {
      // With period two compare sums over two cycles.
      std::vector<double> periods = loss;
      for (std::size_t i = cycles - 1; marched.steady_period == 2 && i > 0; --i)
      {
         periods[i] += periods[i - 1];
      }
      if (marched.steady_period == 2) { periods.erase(periods.begin()); }
      const bool falls = falls_to_nothing(periods);
      // Slip whose loss still falls geometrically is not steady, even if it changes little.
      const bool steady = marched.steady_cycle > 0 && !falls;
      if (steady) { opened_moves = opened_slip > slips; }
      const bool goes_on =
         steady ? closed_slip.maxCoeff() > slips : last > little || !(falls || last <= none);
      // Above the upper limit slip at nodes that stay closed never ends. If it seems to have
      // ended, the nodes that open account for it, however little they move.
      const bool forbidden = load_factor > settings.upper;
      opened_moves = opened_moves || (forbidden && !report.opened.empty());
      if (goes_on && steady) { report.verdict = TransientVerdict::cyclic_slip; }
      else if (goes_on || (forbidden && report.opened.empty()))
      {
         report.verdict = TransientVerdict::still_slipping;
      }
      else
      {
         report.verdict =
            opened_moves ? TransientVerdict::slips_and_opens : TransientVerdict::shaken_down;
      }
   }
   std::size_t end = 0;
   const bool ends = report.verdict == TransientVerdict::shaken_down ||
                     report.verdict == TransientVerdict::slips_and_opens;
   while (end < cycles && (!ends || loss[end] > little)) { ++end; }
   if (end >= 2)
   {
      const std::size_t first = std::min(end / 2, end - 2);
      if (loss[first] > 0)
      {
         report.decay =
            std::pow(loss[end - 1] / loss[first], 1.0 / static_cast<double>(end - 1 - first));
      }
   }
   return report;
}

TransientBracket transient_bracket(const LimitProblem &problem, const LimitReport &limit,
                                   double margin, const TransientSettings &settings)
{
   require_between("transient bracket: margin", margin, 0, 1);
   require(limit.slip.size() == problem.reduced.slips(),
           "transient bracket: the limit has no optimal slip: ", limit.message);
   FrictionSolver solver(problem.reduced, settings.march.friction);
   TransientSettings with = settings;
   if (limit.proven()) { with.upper = std::min(with.upper, limit.upper); }
   TransientBracket bracket;
   for (const double sign : {0.0, 1.0, -1.0})
   {
      bracket.below.push_back(
         transient(solver, problem, limit.limit * (1 - margin), sign * limit.slip, with));
      bracket.above.push_back(
         transient(solver, problem, limit.limit * (1 + margin), sign * limit.slip, with));
   }
   return bracket;
}

CounterExample find_counter_example(const LimitProblem &problem, const LimitReport &limit,
                                    double proven, const CounterExampleSettings &settings)
{
   settings.validate();
   const ReducedProblem &reduced = problem.reduced;
   const Eigen::Index m = reduced.slips(), n = reduced.nodes();
   require(limit.slip.size() == m,
           "counter-example: the limit has no optimal slip: ", limit.message);
   FrictionSolver solver(reduced, settings.transient.march.friction);
   CounterExample found;
   found.quiet = proven;
   if (problem.residual.uncoupled)
   {
      found.quiet = limit.limit;
      found.message = "uncoupled: there is none (proven)";
      return found;
   }

   // Starts are multiples of the optimal slip, and random slips whose residual shear can be
   // held by friction under the constant loads.
   std::mt19937 random(settings.seed);
   std::uniform_real_distribution<double> uniform(-1, 1);
   const Eigen::VectorXd
      pressed = reduced.clamped_forces(problem.cycle.constant).tail(n).cwiseMax(0.0),
      strength = reduced.friction.cwiseProduct(pressed);
   std::vector<Eigen::VectorXd> starts;
   for (const double factor : {-1.0, -3.0, 3.0, 0.0}) { starts.push_back(factor * limit.slip); }
   for (int k = 0; k < settings.starts; ++k)
   {
      Eigen::VectorXd shear(m);
      for (Eigen::Index i = 0; i < m; ++i) { shear[i] = uniform(random) * strength[i % n]; }
      // Every second start has shear that changes its sign only once, at a random place.
      if (k % 2 == 1)
      {
         const double position = uniform(random), height = uniform(random);
         for (Eigen::Index i = 0; i < m; ++i)
         {
            const double x = 2.0 * static_cast<double>(i % n) / static_cast<double>(n) - 1;
            shear[i] = (x < position ? 1 : -1) * height * strength[i % n];
         }
      }
      starts.push_back(problem.residual.flexibility * shear);
   }

   double low = proven, high = limit.limit, trial = 0.98 * limit.limit;
   for (int k = 0; k < settings.halvings && trial > low; ++k)
   {
      bool cycles = false;
      for (const Eigen::VectorXd &start : starts)
      {
         const TransientReport report =
            transient(solver, problem, trial, start, settings.transient);
         ++found.marches;
         found.counters += report.counters;
         if (report.verdict == TransientVerdict::stopped)
         {
            found.message =
               "stopped before all starts were tried: nothing is known of the rest";
            return found;
         }
         // Only a steady cycle with slip at closed nodes counts; a slow decay, nodes that open
         // or a lost equilibrium do not.
         if (report.verdict == TransientVerdict::slips_and_opens && trial < found.opens)
         {
            found.opens = trial;
            found.opening_start = start;
         }
         if (report.verdict == TransientVerdict::cyclic_slip)
         {
            cycles = found.found = true;
            found.load_factor = trial;
            found.start = start;
            found.dissipation = report.dissipation.back() - report.opened_loss;
            break;
         }
      }
      if (cycles) { high = trial; }
      else
      {
         low = found.quiet = trial;
         if (!found.found) { break; }
      }
      trial = 0.5 * (low + high);
   }
   if (std::isfinite(found.opens))
   {
      // Slips that press some nodes, and take more pressure from others than these have.
      const Eigen::VectorXd pressure = pressed.cwiseMax(1e-6 * pressed.maxCoeff());
      for (int k = 0; k <= 4; ++k)
      {
         const Eigen::VectorXd slip =
            problem.residual.flexibility * reduced.B().row((n - 1) * k / 4).transpose();
         const double share =
            (reduced.B() * slip).cwiseAbs().cwiseQuotient(pressure).maxCoeff();
         if (share == 0) { continue; }
         for (const double factor : {3.0, -3.0}) { starts.push_back(factor / share * slip); }
      }
      bool opens = true;
      for (int k = 0; k < settings.halvings && opens; ++k)
      {
         opens = false;
         for (auto start = starts.begin(); start != starts.end() && !opens; ++start)
         {
            const TransientReport report =
               transient(solver, problem, 0.5 * found.opens, *start, settings.transient);
            ++found.marches;
            found.counters += report.counters;
            opens = report.verdict == TransientVerdict::slips_and_opens;
            if (opens) { found.opening_start = *start; }
         }
         if (opens) { found.opens *= 0.5; }
      }
   }
   found.message =
      found.found
         ? "a start was found from which the contact slips for ever below the upper limit "
           "(observed)"
         : "no start was found from which the contact slips for ever (observed, not proven)";
   return found;
}

} // namespace cattaneo
