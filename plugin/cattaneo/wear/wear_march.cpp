#include <algorithm>
#include <cattaneo/friction/contact_state_json.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/progress_report.hpp>
#include <cattaneo/wear/wear_cycle.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <limits>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

const char *const format_name = "cattaneo wear state 1";

/// Least number of cycles in a jump. A shorter one would march about as many cycles as it
/// saves.
constexpr double least_jump = 40;

} // namespace

WearState WearState::virgin(const ReducedProblem &problem)
{
   const VectorXd zero = VectorXd::Zero(problem.nodes());
   return {ContactState::virgin(problem), zero, zero, 0};
}

void WearState::validate(const ReducedProblem &problem) const
{
   contact.require_of(problem);
   if (marched) { marched->require_of(problem); }
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
   nlohmann::json j{{"format", format_name},
                    {"cycles", state.cycles},
                    {"depth", json_list(state.depth)},
                    {"dissipation", json_list(state.dissipation)},
                    {"contact", to_json(state.contact)}};
   if (state.marched) { j["marched"] = to_json(*state.marched); }
   write_whole(file, j.dump(1) + '\n');
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
                      if (j.contains("marched"))
                      {
                         state.marched = contact_state(j.at("marched"), file);
                      }
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

/// Depth and loss of some cycles, of each node.
struct Taken
{
   VectorXd depth, loss;
};

/// One computation in progress: its state, and the data of a cycle at this state.
struct Way
{
   WearState state; ///< with the contact from which the march goes on
   /// A cycle at this depth that repeats itself, and the contact at its end (`looked`).
   std::optional<WearCycle> look;
   ContactState looked;
   /// By how much more, at each node, a marched cycle wears than one that repeats itself. The
   /// reason is that the previous cycle has changed the gap.
   VectorXd lag;
   double lag_error = 0; ///< the error of `lag` after a jump
   bool jumped = false;  ///< the last cycles were jumped over
};

/// Events of the computation whose results are returned.
struct Noticed
{
   VectorXd mark; ///< depth of a cycle, a while ago
   double marked_at = 0, steady_cycle = 0, final_cycle = 0;
   double explicit_limit = std::numeric_limits<double>::infinity();
   long jumps = 0, implicit_cycles = 0;
   double unsettled = -1; ///< last cycle whose worn gap has no equilibrium; negative: none
};

/// The result of a jump.
struct Landing
{
   Way way;
   Taken taken;
   double bend = 0;   ///< difference of the results of one, two and three parts
   double error = 0;  ///< error of depth by this jump alone
   double unseen = 0; ///< the part of this error that shorter jumps may share
};

/// A record that is not yet given to the observer.
struct Kept
{
   WearRecord record;
   std::optional<WearState> state; ///< if the observer is to be called with it
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
   }

   WearReport run();

private:
   bool march_on();
   bool march_one(Way &way, bool handed_out);
   bool jump();
   bool look_at(Way &way, double cycles);
   std::optional<VectorXd> lag_ahead(ContactState &contact, const VectorXd &depth,
                                     const WearCycle &cycle);
   std::optional<Landing> landing(const Way &from, double cycles);
   bool land(const Way &from, double cycles, int parts, Taken &taken, ContactState &contact,
             std::vector<WearCycle> &looked_at);
   void add(Way &way, const Taken &taken, double cycles) const;
   std::optional<Taken> taken_by(const WearCycle &cycle, bool handed_out);
   bool give_up(double cycles);
   void begin_again();
   bool errors_have_grown(const Way &fine);
   void hand_out(double covered, double loss);
   void hand_out(Kept &&kept);
   WearState settled(const Way &way);
   bool is_severe(const WearCycle &cycle) const;
   bool fails(const WearCycle &cycle);
   void notice(const WearCycle &cycle);
   /// How closely a cycle is to repeat itself where a jump looks at it.
   double repeats_to() const { return 0.05 * settings_.tolerance; }
   /// Wear of a cycle below which it makes no difference to the whole depth.
   double slow(const Way &way) const { return way.state.depth.maxCoeff() / end_; }
   double done() const { return fine_.state.cycles; }
   /// Estimate of the error of depth so far.
   double error() const
   {
      return paired_ ? std::max(1.5 * apart_, 0.5 * single_) + unseen_ : 0.0;
   }

   const ReducedProblem &problem_;
   WearState &state_;
   const WearSettings &settings_;
   const WearObserver &observer_;
   WearCycles cycles_;
   const double end_;
   ProgressReport progress_;
   WearReport report_;

   Way fine_, coarse_;      // the computation that is returned, and the one with longer jumps
   bool paired_ = false;    // both differ, because jumps have been made
   double apart_ = 0;       // largest difference of depth between both so far
   double unseen_ = 0;      // error that both may share
   double single_ = 0;      // sum of the errors of the fine computation's jumps
   double local_ = 0;       // the same for the longer jumps
   Noticed noticed_;        // in the fine computation
   std::vector<Kept> kept_; // records since the first jump

   double step_ = 2 * least_jump; // cycles of the next long jump
   double rest_ = 0;              // no jump is tried before this cycle
   double patience_ = least_jump; // cycles without a jump after the next jump that fails

   // Both computations begin at this state. If their error exceeds the tolerance they begin
   // again from it, with shorter jumps.
   Way fork_;
   Noticed noticed_at_fork_;
   long marched_at_fork_ = 0;
   double strict_ = 1; // share of the tolerance that errors of single jumps may take
   int again_ = 0;
   bool jumps_ = true, hopeless_ = false;
};

bool WearMarch::fails(const WearCycle &cycle)
{
   report_.last = cycle.report;
   for (const CutOffContact &end : cycle.report.cut_off)
   {
      const auto same = [&](const CutOffContact &other) { return other.same_place(end); };
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

/// The state as the user reads it. Its contact is settled on the worn gap.
WearState WearMarch::settled(const Way &way)
{
   WearState state = way.state;
   // The contact has also marched cycles that only look where a jump leads. Their energy does
   // not count.
   state.contact.dissipation = state.dissipation.sum();
   if (way.jumped) { return state; }
   ContactState contact = state.contact;
   if (!cycles_.settle(contact, state.depth))
   {
      noticed_.unsettled = state.cycles;
      return state;
   }
   state.marched = std::move(state.contact);
   state.contact = std::move(contact);
   return state;
}

/// Adds depth and loss of some cycles to a state.
void WearMarch::add(Way &way, const Taken &taken, double cycles) const
{
   WearState &state = way.state;
   state.depth += taken.depth;
   state.dissipation += taken.loss;
   state.cycles += cycles;
   way.look.reset();
}

void WearMarch::hand_out(Kept &&kept)
{
   report_.records.push_back(kept.record);
   if (kept.state && observer_) { observer_(*kept.state, kept.record); }
}

/// Records the fine computation as it stands. Records since the first jump are kept back until
/// the jumps are accepted, because errors may still discard them.
void WearMarch::hand_out(double covered, double loss)
{
   const WearState &state = fine_.state;
   Kept kept;
   WearRecord &record = kept.record;
   record.cycles = state.cycles;
   record.covered = covered;
   record.volume = worn_volume(problem_, state.depth);
   record.depth = state.depth.maxCoeff();
   record.dissipation = state.dissipation.sum();
   record.loss = loss;
   record.error = error();
   const double from = covered > 0 ? state.cycles - covered : -1;
   if (observer_ && (!settings_.observed || settings_.observed(from, state.cycles)))
   {
      kept.state = settled(fine_);
   }
   if (paired_) { kept_.push_back(std::move(kept)); }
   else { hand_out(std::move(kept)); }
   progress_.note(state.cycles / end_, cycles_.marched);
}

/// Steady and final states, and the limit of explicit updates.
void WearMarch::notice(const WearCycle &cycle)
{
   const double most = cycle.depth.maxCoeff();
   Noticed &seen = noticed_;
   if (!seen.final_cycle && most <= settings_.final_share * fine_.state.depth.maxCoeff() &&
       settings_.final_share > 0)
   {
      seen.final_cycle = done();
   }
   if (seen.mark.size() > 0 && done() < 1.25 * seen.marked_at) { return; }
   seen.explicit_limit = std::min(seen.explicit_limit, explicit_limit(problem_, cycle));
   const bool steady =
      seen.mark.size() > 0 && most > 0 &&
      (cycle.depth - seen.mark).cwiseAbs().maxCoeff() <= settings_.steady_tolerance * most;
   if (!steady) { seen.steady_cycle = 0; }
   else if (!seen.steady_cycle) { seen.steady_cycle = seen.marked_at; }
   seen.mark = cycle.depth;
   seen.marked_at = done();
}

/// Whether a cycle wears so much that its own update must be implicit.
bool WearMarch::is_severe(const WearCycle &cycle) const
{
   // No eigenvalue is larger than the largest sum of a row, which is cheap.
   const VectorXd rows = problem_.C().cwiseAbs().rowwise().sum();
   const double bound = cycle.compliance().cwiseProduct(rows).maxCoeff();
   return bound > 1 && explicit_limit(problem_, cycle) < 2;
}

/// Wear and loss of a part of the march. None if it was not found.
std::optional<Taken> WearMarch::taken_by(const WearCycle &cycle, bool handed_out)
{
   Taken taken{cycle.depth, cycle.loss};
   if (is_severe(cycle))
   {
      taken.depth = implicit_wear(problem_, cycle, 1);
      if (taken.depth.size() == 0)
      {
         report_.status = FrictionStatus::stalled;
         report_.message = "no steady contact was found for the wear of a cycle";
         return {};
      }
      for (Index i = 0; i < taken.loss.size(); ++i)
      {
         if (cycle.depth[i] > 0) { taken.loss[i] *= taken.depth[i] / cycle.depth[i]; }
      }
      noticed_.implicit_cycles += handed_out;
   }
   return taken;
}

bool WearMarch::march_one(Way &way, bool handed_out)
{
   ContactState contact = way.state.contact;
   const WearCycle cycle =
      cycles_.march(contact, way.state.depth, settings_.update == GapUpdate::piece);
   if (fails(cycle)) { return false; }
   if (handed_out) { notice(cycle); }
   const std::optional<Taken> taken = taken_by(cycle, handed_out);
   if (!taken) { return false; }
   way.state.contact = std::move(contact);
   add(way, *taken, 1);
   way.jumped = false;
   return true;
}

/// Marches one more cycle in both computations. False if it was not found.
bool WearMarch::march_on()
{
   const double lost = fine_.state.dissipation.sum();
   if (!march_one(fine_, true)) { return false; }
   const double loss = fine_.state.dissipation.sum() - lost;
   if (paired_)
   {
      if (!march_one(coarse_, false)) { return false; }
      apart_ = std::max(apart_, largest(fine_.state.depth - coarse_.state.depth));
      if (errors_have_grown(fine_)) { return true; }
   }
   hand_out(1, loss);
   return true;
}

/// Computes Way::lag at a depth where a cycle repeats itself: marches cycles on a gap that
/// grows by one cycle's wear each. None if a cycle was not found.
std::optional<VectorXd> WearMarch::lag_ahead(ContactState &contact, const VectorXd &depth,
                                             const WearCycle &cycle)
{
   constexpr int most = 10;
   VectorXd before, lag;
   for (int k = 1; k <= most; ++k)
   {
      const WearCycle next = cycles_.march(contact, depth + k * cycle.depth, false);
      if (!next.found()) { return {}; }
      if (k > 1)
      {
         // The wear of cycle k contains k times a constant change by the growing gap. Without
         // that part the rest must agree from cycle to cycle.
         const VectorXd found = next.depth - cycle.depth - k * (next.depth - before);
         const bool same =
            k > 2 && largest(found - lag) <=
                        std::max(0.1 * largest(found),
                                 0.05 * settings_.tolerance * cycle.depth.maxCoeff());
         lag = found;
         if (same) { break; }
      }
      before = next.depth;
   }
   return lag;
}

/// Marches cycles at the present depth until one repeats itself, closely enough for a jump over
/// `cycles` of them. False if none does.
bool WearMarch::look_at(Way &way, double cycles)
{
   if (way.look) { return true; }
   ContactState contact = way.state.contact;
   WearCycle cycle =
      cycles_.repeated(contact, way.state.depth, repeats_to(), slow(way), cycles);
   if (!cycle.found()) { return false; }
   // After a marched cycle, the first cycle that is marched here already contains the lag.
   // After a jump the lag is computed on a gap that grows as in the next cycles, because some
   // nodes that slip on a growing gap would not slip on a fixed one.
   const VectorXd predicted = way.lag;
   way.lag = cycle.lag;
   way.lag_error = 0;
   if (way.jumped)
   {
      ContactState ahead = contact;
      const std::optional<VectorXd> lag = lag_ahead(ahead, way.state.depth, cycle);
      if (!lag) { return false; }
      way.lag = *lag;
      way.lag_error = largest(way.lag - predicted);
   }
   way.look = std::move(cycle);
   way.looked = std::move(contact);
   return true;
}

/// A jump in equal implicit parts. False if the contact is not found at the end of a part.
bool WearMarch::land(const Way &from, double cycles, int parts, Taken &taken,
                     ContactState &contact, std::vector<WearCycle> &looked_at)
{
   looked_at.clear();
   const double part = cycles / parts;
   taken = {VectorXd::Zero(problem_.nodes()), VectorXd::Zero(problem_.nodes())};
   WearCycle cycle = *from.look;
   for (int k = 0; k < parts; ++k)
   {
      if (k > 0)
      {
         cycle = cycles_.repeated(contact, from.state.depth + taken.depth, repeats_to(),
                                  slow(from), part);
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

/// A jump from a state with a known cycle (look_at()), and a known cycle at its end. None if
/// either is not found.
std::optional<Landing> WearMarch::landing(const Way &from, double cycles)
{
   Landing result{from, {}};
   const WearCycle &first = *from.look;
   ContactState &reached = result.way.state.contact;
   reached = from.looked;
   Taken one, two, three;
   std::vector<WearCycle> looked_at;
   if (!land(from, cycles, 1, one, reached, looked_at) ||
       !land(from, cycles, 2, two, reached, looked_at) ||
       !land(from, cycles, 3, three, reached, looked_at))
   {
      return {};
   }
   // Extrapolates the results of one, two and three parts to parts without length. The weights
   // are those of a parabola in the length of a part.
   const auto extrapolated =
      [](const VectorXd &of_one, const VectorXd &of_two, const VectorXd &of_three)
   { return VectorXd(0.5 * of_one - 4 * of_two + 4.5 * of_three); };
   Taken &best = result.taken;
   best = {extrapolated(one.depth, two.depth, three.depth),
           extrapolated(one.loss, two.loss, three.loss)};
   result.bend = largest(best.depth - (3 * three.depth - 2 * two.depth));
   const VectorXd sum = best.depth; // of cycles between those at the start and at the end
   // Updates after each cycle wear off more: half of the fall of the wear of a cycle from the
   // start of the jump to its end, which cycles a third of the jump apart show.
   const VectorXd steps = 1.5 * (looked_at[1].depth - looked_at[2].depth);
   best.depth += steps;
   best.loss += 1.5 * (looked_at[1].loss - looked_at[2].loss);
   result.unseen = 0.1 * largest(steps);
   // A growing quantity is not extrapolated below zero.
   for (Index i = 0; i < best.depth.size(); ++i)
   {
      if (best.depth[i] > 0 && best.loss[i] >= 0) { continue; }
      best.depth[i] = three.depth[i];
      best.loss[i] = three.loss[i];
   }
   // A transient is not part of the wear of the jump. After marched cycles it has decayed, and
   // after a jump it comes from the sudden change of the gap.
   const double passing = from.jumped ? 0.0 : std::max(0.0, first.passing - largest(first.lag));
   result.error = result.bend + passing;
   // The contribution of the changing gap is proportional to the square of the wear of a cycle.
   const double slower = best.depth.maxCoeff() / (cycles * first.depth.maxCoeff());
   if (first.depth.maxCoeff() > 0)
   {
      result.way.lag = slower * slower * from.lag;
      const VectorXd more = (cycles * result.way.lag).cwiseMax(-0.5 * best.depth);
      double left_out = 0; // at nodes that wear only because the gap changes
      for (Index i = 0; i < more.size(); ++i)
      {
         if (!(first.depth[i] > 0))
         {
            left_out = std::max(left_out, std::abs(more[i]));
            continue;
         }
         best.depth[i] += more[i];
         best.loss[i] += more[i] * first.loss[i] / first.depth[i];
      }
      // The loss of such a node is not known, so jumps leave its wear out. That error may grow
      // without end. It counts ten times, which shortens the jump.
      result.error += 10 * left_out;
      result.unseen += 0.25 * largest(more) + left_out;
   }
   reached.time = cycles_.start();
   add(result.way, best, cycles);
   result.way.jumped = true;
   if (!look_at(result.way, cycles)) { return {}; }
   // The contribution of the changing gap varies between start and end of the jump. Half of the
   // change is its error.
   result.unseen += 0.5 * cycles * result.way.lag_error;
   // The layer is only a model of how the wear of a cycle falls as the gap grows. The marched
   // cycles limit it. The jump may wear at most its number of cycles times the largest wear of
   // one of them, and at least that number times the smallest. All jumps may fail in the same
   // way, so the excess also counts as unseen.
   VectorXd least = result.way.look->depth, most = least;
   for (const WearCycle &cycle : looked_at)
   {
      least = least.cwiseMin(cycle.depth);
      most = most.cwiseMax(cycle.depth);
   }
   const double outside =
      std::max({0.0, (cycles * least - sum).maxCoeff(), (sum - cycles * most).maxCoeff()});
   // Wear stops at the gap at which a node just touches. A node that the jump wore and that
   // then no longer touches was worn too far. Both computations have this error, because such a
   // node wears no further.
   double past = 0;
   for (Index i = 0; i < best.depth.size(); ++i)
   {
      if (first.depth[i] > 0 && best.depth[i] > 0)
      {
         past = std::max(past, std::min(best.depth[i], result.way.look->opening[i]));
      }
   }
   result.error += outside + past;
   result.unseen += outside + past;
   reached = result.way.looked;
   return result;
}

/// Gives up the present jump. Returns false, because no cycles were jumped over.
bool WearMarch::give_up(double cycles)
{
   step_ = std::max(least_jump, 0.3 * cycles);
   // If the jumps so far have covered hardly more cycles than they marched, march these cycles
   // instead.
   const double covered = done() - fork_.state.cycles;
   const double from = done();
   if (paired_ && covered < 2.0 * static_cast<double>(cycles_.marched - marched_at_fork_))
   {
      begin_again();
   }
   rest_ = from + patience_;
   patience_ *= 2;
   return false;
}

/// Returns both computations to the state before the first jump.
void WearMarch::begin_again()
{
   fine_ = fork_;
   noticed_ = noticed_at_fork_;
   paired_ = false;
   apart_ = unseen_ = single_ = local_ = 0;
   kept_.clear();
   step_ = 2 * least_jump;
}

/// If the error exceeds the tolerance, both computations begin again with shorter jumps, in the
/// end with none. True if so.
bool WearMarch::errors_have_grown(const Way &fine)
{
   const double tolerated = settings_.tolerance * fine.state.depth.maxCoeff();
   if (hopeless_ || error() <= tolerated) { return false; }
   ++again_;
   strict_ *= std::clamp(0.5 * tolerated / error(), 0.1, 0.4);
   begin_again();
   const double to_march = end_ - done();
   if (again_ > 5 || to_march < static_cast<double>(cycles_.marched - marched_at_fork_))
   {
      jumps_ = to_march > 1e5;
      hopeless_ = jumps_;
   }
   return true;
}

/// True if cycles were jumped over, or if the jump is to be tried again in another way.
bool WearMarch::jump()
{
   const double left = end_ - done();
   double cycles = 2 * std::floor(0.5 * std::min(step_, left));
   if (cycles < least_jump) { return false; }
   if (!paired_)
   {
      fork_ = fine_;
      noticed_at_fork_ = noticed_;
      marched_at_fork_ = cycles_.marched;
   }
   if (!look_at(fine_, cycles)) { return give_up(cycles); }
   if (!paired_) { coarse_ = fine_; }
   if (!look_at(coarse_, cycles)) { return give_up(cycles); }
   // If the lag is a large part of the wear, nodes wear mainly because the gap changes. A cycle
   // at a fixed gap then tells nothing about a jump.
   const double pace = fine_.look->depth.maxCoeff();
   if (largest(fine_.lag) > std::max(0.1 * pace, settings_.tolerance * slow(fine_)))
   {
      return give_up(cycles);
   }
   // A cycle with an implicit update of its own cannot be summed over many.
   if (is_severe(*fine_.look)) { return give_up(cycles); }

   // The coarse computation takes the long jump, the fine one two jumps of half the length.
   const std::optional<Landing> whole = landing(coarse_, cycles);
   if (!whole) { return give_up(cycles); }
   const double added = whole->taken.depth.maxCoeff() + slow(fine_) * cycles,
                allowed = strict_ * settings_.tolerance * added;
   const auto shorter = [&](double bend)
   {
      if (cycles <= least_jump) { return give_up(cycles); }
      const double factor = bend > 0 ? std::cbrt(0.5 * allowed / bend) : 1.0;
      step_ = std::max(least_jump, cycles * std::clamp(factor, 0.2, 0.7));
      return true;
   };
   if (whole->error > allowed) { return shorter(whole->bend); }
   const std::optional<Landing> half = landing(fine_, 0.5 * cycles);
   if (!half) { return give_up(cycles); }
   const std::optional<Landing> second = landing(half->way, 0.5 * cycles);
   if (!second) { return give_up(cycles); }
   if (half->error + second->error > allowed) { return shorter(half->bend + second->bend); }
   const double apart = largest(second->way.state.depth - whole->way.state.depth);
   // If both results differ by more than the error of the jump, it is less smooth than it
   // seems.
   if (apart > apart_ + allowed) { return shorter(8 * (apart - apart_)); }

   paired_ = true;
   apart_ = std::max(apart_, apart);
   unseen_ += 0.2 * settings_.tolerance * added + half->unseen + second->unseen;
   single_ += half->error + second->error;
   local_ += whole->error;
   if (errors_have_grown(second->way)) { return true; }
   const double bend = std::max(whole->bend, 0.25 * (apart - apart_));
   step_ =
      std::max(least_jump,
               cycles * std::clamp(bend > 0 ? std::cbrt(0.5 * allowed / bend) : 4.0, 0.5, 4.0));
   coarse_ = whole->way;
   notice(*fine_.look);
   for (const Landing &at : {*half, *second})
   {
      fine_ = at.way;
      ++noticed_.jumps;
      hand_out(0.5 * cycles, fine_.look->loss.sum());
   }
   patience_ = least_jump;
   return true;
}

WearReport WearMarch::run()
{
   bool goes_on = true;
   fine_.state = state_;
   if (state_.marched) { fine_.state.contact = *state_.marched; }
   fine_.state.marched.reset();
   if (cycles_.begins(fine_.state.contact))
   {
      // The march may begin before or after the opening part. Wear in this part counts, but the
      // part is not a cycle.
      ContactState contact = fine_.state.contact;
      const WearCycle opening = cycles_.opening(contact, fine_.state.depth);
      goes_on = !fails(opening);
      if (goes_on)
      {
         fine_.state.contact = std::move(contact);
         const std::optional<Taken> taken = taken_by(opening, true);
         goes_on = taken.has_value();
         if (taken)
         {
            add(fine_, *taken, 0);
            hand_out(0, opening.loss.sum());
         }
      }
   }
   rest_ = done() + 2;
   while (goes_on && done() < end_ && !noticed_.final_cycle)
   {
      if (settings_.march.monitor.stopped())
      {
         report_.status = FrictionStatus::stopped;
         report_.message = "the computation of wear was stopped on request";
         break;
      }
      // No jumps if the gap is updated within a cycle: a cycle at a fixed gap does not show
      // that wear.
      const bool may_jump = settings_.tolerance > 0 && settings_.update == GapUpdate::cycle &&
                            jumps_ && done() >= rest_;
      goes_on = (may_jump && jump()) || march_on();
   }
   report_.error = error();
   std::ostringstream remark;
   if (hopeless_ && error() > settings_.tolerance * fine_.state.depth.maxCoeff())
   {
      report_.reached = false;
      report_.error = std::numeric_limits<double>::infinity();
      remark
         << "the wear is unstable, and the error of the final depth is above the tolerance: "
            "with jumps over twice as many cycles the depth differs by "
         << apart_ << ". Tolerance 0 marches all cycles";
   }
   else if (again_ > 0 && !jumps_)
   {
      remark << "the wear is unstable: errors of jumps grew, so that all cycles were marched. "
                "Other "
                "increments may give another final depth";
   }
   else if (again_ > 0 && apart_ > 10 * local_)
   {
      remark << "the wear is unstable: errors of jumps grew by a factor of " << apart_ / local_
             << ". Other increments may give another final depth";
   }
   for (Kept &kept : kept_) { hand_out(std::move(kept)); }
   state_ = settled(fine_);
   if (noticed_.unsettled >= 0)
   {
      remark << (remark.str().empty() ? "" : ". ") << "after cycle " << noticed_.unsettled
             << " no equilibrium was found at the worn gap: the returned contact is that "
                "before the wear of this cycle was added to the gap";
   }
   report_.remark = remark.str();
   report_.marched = cycles_.marched;
   report_.counters = cycles_.counters;
   report_.jumps = noticed_.jumps;
   report_.explicit_limit = noticed_.explicit_limit;
   report_.implicit_cycles = noticed_.implicit_cycles;
   report_.steady_cycle = noticed_.steady_cycle;
   report_.final_cycle = noticed_.final_cycle;
   report_.seconds = progress_.seconds();
   progress_.end(std::min(1.0, done() / std::max(end_, 1.0)), cycles_.marched);
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
   require(
      history.cycle_start >= 0,
      "wear: the load history has no cycle, must have one: its last points repeat from its "
      "cycle start on");
   require(state.cycles <= cycles, "wear: cycles is ", cycles, ", must be at least ",
           state.cycles, ", the cycles that the state has had already");
   const bool begins = state.contact.time < history.times[history.cycle_start];
   const VectorXd loads = history.multipliers.col(begins ? 0 : history.cycle_start);
   require(largest(state.contact.multipliers - loads) <= 1e-9 * largest(history.multipliers),
           "wear: the state has the load multipliers (", state.contact.multipliers.transpose(),
           "), the history must begin ", begins ? "" : "its cycle ",
           "with them, but begins with (", loads.transpose(), ")");
   return WearMarch(problem, law, once, cycles, state, settings, observer, watch).run();
}

} // namespace cattaneo
