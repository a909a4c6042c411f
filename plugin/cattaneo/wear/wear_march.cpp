#include <algorithm>
#include <cattaneo/friction/contact_state_json.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/progress_report.hpp>
#include <cattaneo/wear/wear_cycle.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

const char *const format_name = "cattaneo wear state 1";

/// Cycles that a jump must cover to be worth those that it marches.
constexpr double least_jump = 30;

} // namespace

WearState WearState::virgin(const ReducedProblem &problem)
{
   const VectorXd zero = VectorXd::Zero(problem.nodes());
   return {ContactState::virgin(problem), zero, zero, 0};
}

void WearState::validate(const ReducedProblem &problem) const
{
   contact.require_of(problem);
   const auto check = [&](const char *what, const VectorXd &x)
   {
      require(x.size() == problem.nodes() && x.allFinite() && x.minCoeff() >= 0,
              "wear state: its ", what, " must be ", problem.nodes(),
              " numbers that are not negative");
   };
   check("depth", depth);
   check("dissipation", dissipation);
   require_at_least("wear state: cycles", cycles, 0);
}

void save(const WearState &state, const std::string &file)
{
   require(state.depth.allFinite() && state.dissipation.allFinite() &&
              std::isfinite(state.cycles),
           "wear state: a value is not finite");
   write_whole(file, nlohmann::json{{"format", format_name},
                                    {"cycles", state.cycles},
                                    {"depth", json_list(state.depth)},
                                    {"dissipation", json_list(state.dissipation)},
                                    {"contact", to_json(state.contact)}}
                           .dump(1) +
                        '\n');
}

WearState load_wear_state(const std::string &file)
{
   WearState state;
   read_state_file("wear state", file, format_name,
                   [&](const nlohmann::json &j)
                   {
                      state.cycles = j.at("cycles");
                      state.depth = json_vector(j.at("depth"));
                      state.dissipation = json_vector(j.at("dissipation"));
                      state.contact = contact_state(j.at("contact"), file);
                   });
   return state;
}

void WearSettings::validate() const
{
   march.validate();
   require(tolerance == 0 || (tolerance >= 1e-8 && tolerance <= 0.1),
           "wear settings: tolerance is ", tolerance, ", must be 0 or from 1e-8 to 0.1");
   require_at_least("wear settings: final_share", final_share, 0);
   require_at_least("wear settings: steady_tolerance", steady_tolerance, 0);
}

namespace
{

double largest(const Eigen::MatrixXd &x)
{
   return x.size() ? x.cwiseAbs().maxCoeff() : 0.0;
}

/// What some cycles take.
struct Taken
{
   VectorXd depth, loss;
};

/// One wear() in progress.
class WearMarch
{
public:
   WearMarch(const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
             double cycles, WearState &state, const WearSettings &settings,
             const WearObserver &observer, const WornIncrementObserver &watch)
      : problem_(problem), state_(state), settings_(settings), observer_(observer),
        cycles_(problem, law, history, settings.march, watch), end_(cycles),
        progress_(settings.march.monitor)
   {
      report_.explicit_limit = std::numeric_limits<double>::infinity();
   }

   WearReport run();

private:
   bool march_one();
   bool jump();
   bool land(const WearCycle &first, double cycles, int parts, Taken &taken,
             ContactState &contact, std::vector<WearCycle> &looked_at);
   void take(const Taken &taken, double cycles, double loss, double error);
   bool take(const WearCycle &part, double cycles);
   bool fails(const WearCycle &cycle);
   void notice(const WearCycle &cycle);
   /// How closely a cycle is to repeat itself where a jump looks at it.
   double repeats_to() const { return 0.05 * settings_.tolerance; }
   /// Depth of a cycle that makes no difference to the whole.
   double slow() const { return state_.depth.maxCoeff() / end_; }

   const ReducedProblem &problem_;
   WearState &state_;
   const WearSettings &settings_;
   const WearObserver &observer_;
   WearCycles cycles_;
   const double end_;
   ProgressReport progress_;
   WearReport report_;
   double step_ = least_jump;     // cycles of the next jump
   double rest_ = 0;              // no jump is tried before this cycle,
   double patience_ = least_jump; // which is so many on
   bool jumped_ = false;          // the last cycles were jumped over
   VectorXd mark_;                // depth of a cycle, a while ago
   double marked_at_ = 0;
};

bool WearMarch::fails(const WearCycle &cycle)
{
   report_.last = cycle.report;
   for (const CutOffContact &end : cycle.report.cut_off)
   {
      const auto same = [&](const CutOffContact &other)
      { return other.node == end.node && other.at_first == end.at_first; };
      std::vector<CutOffContact> &all = report_.cut_off;
      if (std::none_of(all.begin(), all.end(), same)) { all.push_back(end); }
   }
   if (cycle.report.status != FrictionStatus::converged)
   {
      report_.status = cycle.report.status;
      report_.message = cycle.report.message;
   }
   return !cycle.found();
}

/// Adds what some cycles have taken.
void WearMarch::take(const Taken &taken, double cycles, double loss, double error)
{
   state_.depth += taken.depth;
   state_.dissipation += taken.loss;
   state_.cycles += cycles;
   state_.contact.dissipation = state_.dissipation.sum();
   report_.error += error;
   WearRecord record;
   record.cycles = state_.cycles;
   record.covered = cycles;
   record.volume = worn_volume(problem_, state_.depth);
   record.depth = state_.depth.maxCoeff();
   record.dissipation = state_.contact.dissipation;
   record.loss = loss;
   record.error = error;
   if (observer_) { observer_(state_, record); }
   progress_.note(state_.cycles / end_, cycles_.marched);
}

/// Steady and final states, and the limit of explicit updates.
void WearMarch::notice(const WearCycle &cycle)
{
   const double most = cycle.depth.maxCoeff();
   if (!report_.final_cycle && most <= settings_.final_share * state_.depth.maxCoeff() &&
       settings_.final_share > 0)
   {
      report_.final_cycle = state_.cycles;
   }
   if (mark_.size() > 0 && state_.cycles < 1.25 * marked_at_) { return; }
   report_.explicit_limit = std::min(report_.explicit_limit, explicit_limit(problem_, cycle));
   const bool steady =
      mark_.size() > 0 && most > 0 &&
      (cycle.depth - mark_).cwiseAbs().maxCoeff() <= settings_.steady_tolerance * most;
   if (!steady) { report_.steady_cycle = 0; }
   else if (!report_.steady_cycle) { report_.steady_cycle = marked_at_; }
   mark_ = cycle.depth;
   marked_at_ = state_.cycles;
}

/// What a part of the march wears becomes part of the state. False if it was not found.
bool WearMarch::take(const WearCycle &cycle, double cycles)
{
   Taken taken{cycle.depth, cycle.loss};
   // No eigenvalue is larger than the largest sum of a row, which is cheap.
   const VectorXd rows = problem_.C().cwiseAbs().rowwise().sum();
   const double bound = cycle.compliance().cwiseProduct(rows).maxCoeff();
   if (bound > 1 && explicit_limit(problem_, cycle) < 2)
   {
      taken.depth = implicit_wear(problem_, cycle, 1);
      if (taken.depth.size() == 0)
      {
         report_.status = FrictionStatus::stalled;
         report_.message = "the contact that a cycle wears was not found";
         return false;
      }
      for (Index i = 0; i < taken.loss.size(); ++i)
      {
         if (cycle.depth[i] > 0) { taken.loss[i] *= taken.depth[i] / cycle.depth[i]; }
      }
      ++report_.implicit_cycles;
   }
   take(taken, cycles, cycle.loss.sum(), 0);
   return true;
}

bool WearMarch::march_one()
{
   ContactState contact = state_.contact;
   const WearCycle cycle =
      cycles_.march(contact, state_.depth, settings_.update == GapUpdate::piece);
   if (fails(cycle)) { return false; }
   notice(cycle);
   state_.contact = std::move(contact);
   jumped_ = false;
   return take(cycle, 1);
}

/// Implicit jumps in equal parts. False if the contact is not found at the end of one of them.
bool WearMarch::land(const WearCycle &first, double cycles, int parts, Taken &taken,
                     ContactState &contact, std::vector<WearCycle> &looked_at)
{
   looked_at.clear();
   const double part = cycles / parts;
   taken = {VectorXd::Zero(problem_.nodes()), VectorXd::Zero(problem_.nodes())};
   WearCycle cycle = first;
   for (int k = 0; k < parts; ++k)
   {
      if (k > 0)
      {
         cycle = cycles_.repeated(contact, state_.depth + taken.depth, repeats_to(), slow());
         if (!cycle.found()) { return false; }
      }
      const VectorXd depth = implicit_wear(problem_, cycle, part);
      if (depth.size() == 0) { return false; }
      for (Index i = 0; i < depth.size(); ++i)
      {
         if (depth[i] > 0) { taken.loss[i] += depth[i] * cycle.loss[i] / cycle.depth[i]; }
      }
      taken.depth += depth;
      looked_at.push_back(cycle);
   }
   return true;
}

/// True if cycles were jumped over, or if the jump is to be tried again with fewer.
bool WearMarch::jump()
{
   const double cycles = std::min(std::floor(step_), end_ - state_.cycles);
   ContactState contact = state_.contact;
   const auto give_up = [&]
   {
      step_ = std::max(least_jump, 0.3 * cycles);
      rest_ = state_.cycles + patience_;
      patience_ *= 2;
      return false;
   };
   const WearCycle first = cycles_.repeated(contact, state_.depth, repeats_to(), slow());
   if (!first.found()) { return give_up(); }
   ContactState reached = contact;
   Taken one, two, three;
   std::vector<WearCycle> looked_at;
   if (!land(first, cycles, 1, one, reached, looked_at) ||
       !land(first, cycles, 2, two, reached, looked_at) ||
       !land(first, cycles, 3, three, reached, looked_at))
   {
      return give_up();
   }
   // To parts of one explicit cycle (see wear()), through the results of one, two and three.
   const auto extrapolated = [cycles](const std::vector<std::pair<int, const VectorXd *>> &of)
   {
      VectorXd sum = VectorXd::Zero(of[0].second->size());
      for (const auto &[parts, x] : of)
      {
         double weight = 1;
         for (const auto &[others, y] : of)
         {
            const double part = cycles / parts, other = cycles / others;
            if (y != x) { weight *= (-1 - other) / (part - other); }
         }
         sum += weight * *x;
      }
      return sum;
   };
   Taken best{extrapolated({{1, &one.depth}, {2, &two.depth}, {3, &three.depth}}),
              extrapolated({{1, &one.loss}, {2, &two.loss}, {3, &three.loss}})};
   // Backwards the compliance c of a part, which is that of its beginning, is the one of the
   // end of a cycle: Σ (change of c) p too much, from the cycles at 0, 1/3 and 2/3 of the jump.
   const VectorXd too_much =
      1.5 *
      (looked_at[2].compliance() - looked_at[0].compliance()).cwiseProduct(looked_at[1].force);
   for (Index i = 0; i < too_much.size(); ++i)
   {
      if (!(first.depth[i] > 0)) { continue; }
      best.depth[i] -= too_much[i];
      best.loss[i] -= too_much[i] * first.loss[i] / first.depth[i];
   }
   // What grows is not extrapolated to less than nothing.
   for (Index i = 0; i < best.depth.size(); ++i)
   {
      if (best.depth[i] > 0 && best.loss[i] >= 0) { continue; }
      best.depth[i] = three.depth[i];
      best.loss[i] = three.loss[i];
   }
   const double bend =
      (best.depth + too_much - extrapolated({{2, &two.depth}, {3, &three.depth}}))
         .cwiseAbs()
         .maxCoeff() +
      0.5 * too_much.cwiseAbs().maxCoeff();
   // What passes is no wear of the jump: after marched cycles it is lost, after a jump it comes
   // of the gap that has changed at once.
   const double passing = jumped_ ? 0.0 : first.passing;
   // The cycles that were looked at repeat themselves to this, however short the jump is.
   const double error =
      bend + passing + repeats_to() * std::max(best.depth.maxCoeff(), slow() * cycles);
   // Half by what the jump adds, half by its share of all cycles.
   const double allowed = 0.5 * settings_.tolerance * (best.depth.maxCoeff() + slow() * cycles);
   const double factor = bend > 0 ? std::cbrt(0.5 * allowed / bend) : 4.0;
   if (error > allowed)
   {
      if (cycles <= least_jump || passing > 0.5 * allowed) { return give_up(); }
      step_ = std::max(least_jump, cycles * std::clamp(factor, 0.2, 0.7));
      return true;
   }
   step_ = std::max(least_jump, cycles * std::clamp(factor, 0.5, 4.0));
   state_.contact = std::move(reached);
   state_.contact.time = cycles_.start();
   notice(first);
   take(best, cycles, first.loss.sum(), error);
   ++report_.jumps;
   jumped_ = true;
   patience_ = least_jump;
   return true;
}

WearReport WearMarch::run()
{
   bool goes_on = true;
   if (cycles_.begins(state_.contact))
   {
      ContactState contact = state_.contact; // a state stands before the opening part or after
      const WearCycle opening = cycles_.opening(contact, state_.depth);
      goes_on = !fails(opening);
      if (goes_on)
      {
         state_.contact = std::move(contact);
         goes_on = take(opening, 0);
      }
   }
   rest_ = state_.cycles + 2;
   while (goes_on && state_.cycles < end_ && !report_.final_cycle)
   {
      if (settings_.march.monitor.stopped())
      {
         report_.status = FrictionStatus::stopped;
         report_.message = "the wear was asked to stop";
         break;
      }
      const bool may_jump = settings_.tolerance > 0 && state_.cycles >= rest_ &&
                            end_ - state_.cycles >= least_jump;
      goes_on = (may_jump && jump()) || march_one();
   }
   report_.marched = cycles_.marched;
   report_.counters = cycles_.counters;
   report_.seconds = progress_.seconds();
   progress_.end(std::min(1.0, state_.cycles / std::max(end_, 1.0)), cycles_.marched);
   return report_;
}

} // namespace

WearReport wear(const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
                double cycles, WearState &state, const WearSettings &settings,
                const WearObserver &observer, const WornIncrementObserver &watch)
{
   require_coulomb(problem, "wear");
   settings.validate();
   law.validate(problem);
   state.validate(problem);
   LoadHistory once = history;
   once.cycles = 1;
   once.validate(problem);
   require_at_least("wear: cycles", cycles, 0);
   require(cycles == std::floor(cycles) && cycles <= 1e15, "wear: cycles is ", cycles,
           ", must be a whole number up to 1e15");
   require(history.cycle_start >= 0, "wear: the load history has no cycle");
   require(state.cycles <= cycles, "wear: cycles is ", cycles, ", of which the state has seen ",
           state.cycles);
   const bool begins = state.contact.time < history.times[history.cycle_start];
   const VectorXd loads = history.multipliers.col(begins ? 0 : history.cycle_start);
   require(largest(state.contact.multipliers - loads) <= 1e-9 * largest(history.multipliers),
           "wear: the state has the load multipliers (", state.contact.multipliers.transpose(),
           "), the history begins ", begins ? "" : "its cycle ", "with (", loads.transpose(),
           ")");
   return WearMarch(problem, law, once, cycles, state, settings, observer, watch).run();
}

} // namespace cattaneo
