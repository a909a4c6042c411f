#include <algorithm>
#include <array>
#include <atomic>
#include <cattaneo/algebra/least_squares.hpp>
#include <cattaneo/friction/changing_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/joints/modal_loop.hpp>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

const double pi = std::acos(-1.0);

bool solved(FrictionStatus status)
{
   return status == FrictionStatus::converged || status == FrictionStatus::not_unique;
}

/** ∮ α cos θ dθ, with q = middle + half cos θ. Between two points α is linear in q,
    α = a + b cos θ, so that each piece has a closed form. */
double first_harmonic(const std::vector<LoopPoint> &points, double middle, double half)
{
   const auto angle = [&](double q)
   { return std::acos(std::clamp((q - middle) / half, -1.0, 1.0)); };
   const auto antiderivative = [](double a, double b, double theta)
   { return a * std::sin(theta) + b * (theta / 2 + std::sin(2 * theta) / 4); };
   double sum = 0;
   for (std::size_t k = 1; k < points.size(); ++k)
   {
      const LoopPoint &from = points[k - 1], &to = points[k];
      const double dq = to.amplitude - from.amplitude;
      if (dq == 0) { continue; } // θ stays
      const double slope = (to.force - from.force) / dq,
                   a = from.force + slope * (middle - from.amplitude), b = slope * half;
      // θ runs from 0 to π while q falls, and from π to 2π while q rises.
      const double start = angle(from.amplitude), end = angle(to.amplitude);
      const double first = dq < 0 ? start : 2 * pi - start, last = dq < 0 ? end : 2 * pi - end;
      sum += antiderivative(a, b, last) - antiderivative(a, b, first);
   }
   return sum;
}

/// Work over a curve from its beginning, by trapezoids.
double work_along(const std::vector<LoopPoint> &points)
{
   double work = 0;
   for (std::size_t k = 1; k < points.size(); ++k)
   {
      work += 0.5 * (points[k - 1].force + points[k].force) *
              (points[k].amplitude - points[k - 1].amplitude);
   }
   return work;
}

/// The least and the largest modal amplitude.
std::pair<double, double> ends(const std::vector<LoopPoint> &points)
{
   const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                  [](const LoopPoint &a, const LoopPoint &b)
                                                  { return a.amplitude < b.amplitude; });
   return {least->amplitude, most->amplitude};
}

double half_range(const std::vector<LoopPoint> &points)
{
   const auto [least, most] = ends(points);
   return 0.5 * (most - least);
}

/// Of work along a path at a state: the largest displacement times the largest force, with 13
/// digits.
double round_off_of_work(const ContactState &state)
{
   return 1e-13 * state.displacements().lpNorm<Eigen::Infinity>() *
          state.forces().lpNorm<Eigen::Infinity>();
}

/// Cycles of a march, one after the other: the points of the present one, and how far its end
/// is from its beginning.
class Cycles
{
public:
   /// @param share  of the loss of the cycle, over force times range: a smaller change counts
   ///               as none
   Cycles(double tolerance, double share, bool exact)
      : tolerance_(tolerance), share_(share), exact_(exact)
   {
   }

   /// A cycle begins at a state.
   void begin(const ContactState &state, const LoopPoint &point)
   {
      begin_ = state;
      points.assign(1, point);
      loss_ = 0;
      least_ = most_ = {state.displacements(), state.forces()};
   }
   void add(const ContactState &state, const LoopPoint &point, double loss)
   {
      points.push_back(point);
      loss_ += loss;
      const Fields now{state.displacements(), state.forces()};
      for (std::size_t k = 0; k < 2; ++k)
      {
         least_[k] = least_[k].cwiseMin(now[k]);
         most_[k] = most_[k].cwiseMax(now[k]);
      }
   }
   /// The cycle ends at a state.
   void end(const ContactState &state)
   {
      // 1. The largest change, of displacements or of forces, beyond round-off.
      const Fields from{begin_.displacements(), begin_.forces()},
         to{state.displacements(), state.forces()};
      const double before = change;
      std::array<double, 2> changes{0, 0};
      for (std::size_t k = 0; k < 2; ++k)
      {
         const double by = (to[k] - from[k]).lpNorm<Eigen::Infinity>() -
                           1e-12 * to[k].lpNorm<Eigen::Infinity>();
         if (by > 0) { changes[k] = by / (most_[k] - least_[k]).lpNorm<Eigen::Infinity>(); }
      }
      change = std::max(changes[0], changes[1]);
      // 2. Changes that fall in a constant ratio add up to more than the next change.
      if (!jumped_) { ratio_ = count > 0 && before > 0 ? change / before : 1; }
      const double ratio = ratio_; // that of before a jump, if there was one
      const double left = ratio < 1 ? change * std::max(1.0, ratio / (1 - ratio)) : change;
      // 3. Work along the loop that is not lost is stored, so the state has changed. Increments
      // also lose the work of pressures on nodes that open or close within them.
      const double round_off =
         1e-12 * std::abs(points[0].force) * half_range(points) + round_off_of_work(state);
      const double allowed = std::max(
         tolerance_, share_ * loss_ / (std::abs(points[0].force) * half_range(points)));
      steady = left <= allowed && (!exact_ || std::abs(work_along(points) - loss_) <=
                                                 tolerance_ * loss_ + round_off);
      // 4. The same displacements are added in each cycle, while forces repeat.
      const VectorXd drift = to[0] - from[0];
      ratchets = !steady && changes[1] <= tolerance_ && changes[0] > 1e-6 &&
                 drift_.size() == drift.size() &&
                 (drift - drift_).norm() <= 1e-6 * drift.norm();
      // 5. Can the limit of the cycles be foreseen?
      ++count;
      find_jump(state, drift, 1e-12 * to[0].norm());
      drift_ = drift;
      if (goes_back) { steady = ratchets = false; }
   }
   /// Jumps most of the way to the limit of cycles that continue like the last ones. The
   /// equations of the node states are linear, so that this state obeys them. The rest of the
   /// way shows whether that was right: if the cycle after a jump is not the expected one,
   /// returns to the beginning of the jump.
   void jump(ContactState &state)
   {
      if (goes_back)
      {
         // A shorter jump, or at last none, past the change that prevented it.
         state = before_.state;
         drift_ = before_.drift;
         goes_back = jumped_ = false;
         left_ = rest_ = std::sqrt(left_);
         if (left_ > 0.3)
         {
            rest_ = 0.1;
            wait_ = 2;
            return;
         }
      }
      else { before_ = {state, drift_, next_}; }
      const Fields way{limit_[0] - state.displacements(), limit_[1] - state.forces()};
      state.v += (1 - left_) * way[0].head(state.v.size());
      state.w += (1 - left_) * way[0].tail(state.w.size());
      state.q += (1 - left_) * way[1].head(state.q.size());
      state.p += (1 - left_) * way[1].tail(state.p.size());
      expected_ = left_ * before_.next;
      jumped_ = true;
   }

   /// At which the present cycle began, or the last one if it has ended.
   const ContactState &start() const { return begin_; }

   std::vector<LoopPoint> points; ///< of the present cycle
   int count = 0;                 ///< ended ones
   double change = 0;             ///< of the last cycle, relative to its range
   bool steady = false;           ///< the last one
   bool ratchets = false;         ///< each cycle adds the same displacements
   bool can_jump = false;         ///< can the limit of the cycles be foreseen?
   bool goes_back = false;        ///< the last jump was wrong
   const VectorXd &drift() const { return drift_; } ///< displacements added by the last cycle

private:
   using Fields = std::array<VectorXd, 2>; // displacements, forces

   /// If displacements of cycles fall like powers of few numbers, they have a limit. It is the
   /// mean of the states at the ends of the last cycles, with the weights that make the mean of
   /// their changes least (reduced rank extrapolation).
   void find_jump(const ContactState &state, const VectorXd &drift, double round_off)
   {
      // 1. After a jump one cycle shows whether it was right. If so, the rest of the way may be
      // shorter, as far as the limit is known.
      can_jump = goes_back = false;
      const bool same = begin_.status == state.status;
      if (jumped_)
      {
         jumped_ = false;
         ends_.clear();
         goes_back =
            !same || (drift - expected_).norm() > 0.3 * expected_.norm() + unknown_ + round_off;
         if (!goes_back)
         {
            rest_ = std::max(rest_ * rest_, 1e-8);
            next_ = growth_ * drift;
         }
         can_jump = goes_back || goes_on(drift, round_off);
         if (can_jump) { return; }
      }
      // 2. The ends of consecutive cycles without a change of a node's state between them.
      const Fields from{begin_.displacements(), begin_.forces()};
      if (!same) { ends_.clear(); }
      else
      {
         if (ends_.empty() || ends_.back()[0] != from[0]) { ends_.assign(1, from); }
         ends_.push_back({state.displacements(), state.forces()});
      }
      if (ends_.size() > most_changes + 1) { ends_.erase(ends_.begin()); }
      if (wait_ > 0)
      {
         --wait_;
         return;
      }
      // 3. As few of them as are enough, but three, which show a ratio twice.
      for (std::size_t changes = 2; changes < ends_.size() && !can_jump; ++changes)
      {
         can_jump = ends_.size() > 3 && extrapolate(changes) && goes_on(drift, round_off);
      }
   }
   /// Is the limit known so well that most of the way to it can be left out?
   bool goes_on(const VectorXd &drift, double round_off)
   {
      const double size = drift.norm();
      left_ = std::max(rest_, 3 * unknown_ / size);
      return size > 2 * round_off && left_ < 0.4;
   }
   /// Finds the limit by that many changes. False if they do not determine it.
   bool extrapolate(std::size_t changes)
   {
      // 1. The weights.
      const std::size_t first = ends_.size() - changes;
      const auto change_of = [&](std::size_t k) -> VectorXd
      { return ends_[first + k][0] - ends_[first + k - 1][0]; };
      const VectorXd last = change_of(changes - 1);
      MatrixXd others(last.size(), static_cast<Index>(changes) - 1);
      for (std::size_t k = 0; k + 1 < changes; ++k)
      {
         others.col(static_cast<Index>(k)) = change_of(k) - last;
      }
      const VectorXd weights = least_squares(others, -last);
      const double of_last = 1 - weights.sum();
      unknown_ = (last + others * weights).norm();
      if (weights.cwiseAbs().sum() + std::abs(of_last) > 1e5 || of_last == 0) { return false; }
      // 2. The limit, and the next change by the same relation between changes.
      next_ = VectorXd::Zero(last.size());
      for (std::size_t field = 0; field < 2; ++field)
      {
         limit_[field] = of_last * ends_.back()[field];
      }
      for (std::size_t k = 0; k + 1 < changes; ++k)
      {
         const double weight = weights[static_cast<Index>(k)];
         next_ -= weight / of_last * change_of(k + 1);
         for (std::size_t field = 0; field < 2; ++field)
         {
            limit_[field] += weight * ends_[first + k][field];
         }
      }
      growth_ = next_.norm() / last.norm();
      return growth_ < 2;
   }

   static constexpr std::size_t most_changes = 6;
   double tolerance_, share_;
   bool exact_;
   double loss_ = 0;
   ContactState begin_;
   Fields least_, most_;
   VectorXd drift_;           // of the displacements in the previous cycle
   double ratio_ = 1;         // of the last two changes
   std::vector<Fields> ends_; // of cycles without a jump between them
   Fields limit_;             // to which they lead
   double unknown_ = 0;       // a change of a cycle that it still has
   VectorXd next_, expected_; // changes by the next cycle without and after a jump
   double growth_ = 0;        // of that change
   double rest_ = 0.1;        // share of the way that a jump leaves, if the limit is known
   double left_ = 0;          // that the next jump leaves
   bool jumped_ = false;
   int wait_ = 0; // cycles without a jump
   struct
   {
      ContactState state;
      VectorXd drift, next;
   } before_; // the last jump
};

/// A loop that was found, or why there is none.
struct Swing
{
   FrictionStatus status = FrictionStatus::converged;
   std::string message;
   double event_force = 0; ///< at which equilibria end
   bool rough = false;     ///< it was abandoned before it was steady, see Swings::to_and_fro()
   ModalLoop loop;
};

/// Swings of one load about a state.
class Swings
{
public:
   /// @param increments  of each half of a cycle, if there is no exact path
   /// @param share       see Cycles
   Swings(ChangingNodes &nodes, const ReducedProblem &problem, Index load,
          const ModalLoopSettings &settings, int increments, double share = 0)
      : nodes_(nodes), problem_(problem), load_(load), settings_(settings),
        march_(settings.march), share_(share)
   {
      march_.increments_of_piece.clear();
      march_.every_event = march_.stepping == Stepping::exact && problem_.components() < 2;
      march_.increments = march_.every_event ? 1 : increments;
      march_.keep_increments = false;
      march_.loss_error = false;
      march_.stop_at_steady_state = false;
   }

   /// From a state to the force, and then to and fro until a cycle repeats. A loop that is far
   /// from the requested size is abandoned as soon as this is certain. @param off logarithm of
   /// the size over that, for the force and half the range of q; 0: it
   ///             is not far
   Swing to_and_fro(double force, ContactState state,
                    const std::function<double(double, double)> &off) const
   {
      Swing made;
      Cycles cycles(settings_.steady_tolerance, exact() ? 0 : share_, exact());
      while (true)
      {
         // 1. March until a cycle repeats, or until the limit of the cycles can be foreseen.
         const bool opens = state.multipliers[load_] != force;
         make_ready(state);
         cycles.begin(state, point(state));
         const double start = opens ? 1 : 0;
         std::atomic<bool> stop{settings_.march.monitor.stopped()};
         MarchSettings march = march_;
         march.monitor.stop = &stop;
         const MarchReport report = nodes_.march(
            history(state, force, opens, settings_.cycles - cycles.count), state, march,
            [&](const ContactState &now, const IncrementRecord &record)
            {
               if (settings_.march.monitor.stopped()) { stop = true; }
               const LoopPoint here{record.multipliers[load_], record.conjugates[load_]};
               if (record.cycle == 0)
               {
                  // The first cycle begins at the last of these points.
                  cycles.begin(now, here);
                  return;
               }
               cycles.add(now, here, record.friction_work);
               if (std::abs(here.force + force) <= 1e-12 * force) { made.loop.trough = now; }
               if (record.time < start + 2 * record.cycle) { return; }
               cycles.end(now);
               made.rough =
                  !cycles.steady &&
                  cycles.change < 0.02 * std::abs(off(force, half_range(cycles.points)));
               if (cycles.steady || cycles.ratchets || made.rough || cycles.can_jump)
               {
                  stop = true;
               }
               else if (cycles.count < settings_.cycles) { cycles.begin(now, here); }
            });
         if (nodes_.repeats())
         {
            if (cycles.goes_back) { cycles.jump(state); }
            else { state = cycles.start(); }
            continue;
         }
         // 2. Has a stop been requested, or is there no equilibrium?
         made.status = report.not_unique ? FrictionStatus::not_unique : report.status;
         made.message = report.not_unique ? report.not_unique->message : report.message;
         const bool known = solved(made.status) || (made.status == FrictionStatus::stopped &&
                                                    !settings_.march.monitor.stopped());
         if (!known || report.cycles.empty())
         {
            if (report.event_multipliers.size() > load_)
            {
               made.event_force = std::abs(report.event_multipliers[load_]);
            }
            return made;
         }
         if (made.status == FrictionStatus::stopped)
         {
            made.status = FrictionStatus::converged;
            made.message.clear();
         }
         // 3. The loop, or continue from the limit of the cycles.
         if (cycles.steady || cycles.ratchets || made.rough || cycles.count >= settings_.cycles)
         {
            read(cycles, report.cycles.back(), force, std::move(state), made.loop);
            return made;
         }
         cycles.jump(state);
      }
   }

   bool exact() const { return march_.every_event; }

   /// The first loading to the force of a loop, for comparison.
   void compare(const ContactState &from, ModalLoop &loop) const
   {
      std::vector<LoopPoint> points;
      do {
         ContactState state = from;
         make_ready(state);
         points.assign(1, {0, 0});
         const LoopPoint start = point(state);
         nodes_.march(history(state, loop.force, true, 0), state, march_,
                      [&](const ContactState &, const IncrementRecord &record) {
                         points.push_back({record.multipliers[load_],
                                           record.conjugates[load_] - start.amplitude});
                      });
      } while (nodes_.repeats());
      // Masing: both branches of the loop are the first curve with twice its size.
      const LoopPoint &end = points.back();
      loop.omega_first = std::sqrt(end.force / end.amplitude);
      const double masing = 8 * (work_along(points) - 0.5 * end.force * end.amplitude);
      loop.zeta_masing = masing / (2 * pi * end.force * end.amplitude);
   }

private:
   LoopPoint point(const ContactState &state) const
   {
      return {state.multipliers[load_], conjugates(problem_, state)[load_]};
   }
   static void make_ready(ContactState &state)
   {
      state.time = state.step = state.dissipation = 0;
      state.cycle.reset();
      state.cycle_slip.clear();
   }
   /// `opens`: begins with the path to the force. @param cycles 0: only that path
   LoadHistory history(const ContactState &state, double force, bool opens, int cycles) const
   {
      const std::vector<double> way =
         cycles == 0 ? std::vector<double>{state.multipliers[load_], force}
         : opens     ? std::vector<double>{state.multipliers[load_], force, -force, force}
                     : std::vector<double>{force, -force, force};
      const auto points = static_cast<Index>(way.size());
      LoadHistory made;
      made.times = VectorXd::LinSpaced(points, 0, static_cast<double>(points - 1));
      made.multipliers = state.multipliers.replicate(1, points);
      made.multipliers.row(load_) = Eigen::Map<const Eigen::RowVectorXd>(way.data(), points);
      made.cycle_start = cycles == 0 ? -1 : opens ? 1 : 0;
      made.cycles = std::max(cycles, 1);
      return made;
   }
   void read(const Cycles &cycles, const CycleRecord &last, double force, ContactState state,
             ModalLoop &loop) const
   {
      const std::vector<LoopPoint> &points = cycles.points;
      const auto [least, most] = ends(points);
      const double half = 0.5 * (most - least), middle = 0.5 * (most + least);
      loop.cycle = cycles.count;
      loop.steady = cycles.steady;
      loop.change = cycles.change;
      if (cycles.ratchets)
      {
         Index row = 0;
         loop.ratchet = cycles.drift().cwiseAbs().maxCoeff(&row);
         loop.ratchet_node = row % problem_.nodes();
      }
      loop.force = force;
      loop.amplitude = half;
      loop.energy = 0.5 * force * half;
      loop.omega_secant = std::sqrt(force / half);
      loop.dissipation = last.dissipation;
      loop.node_dissipation = last.node_dissipation;
      // Nodes at the limit of friction slip by the round-off of the displacements, and lose the
      // round-off of the work. Nothing has slipped then.
      if (loop.dissipation <= round_off_of_work(state))
      {
         loop.dissipation = 0;
         loop.node_dissipation.setZero();
      }
      loop.area = work_along(points);
      loop.zeta_secant = loop.dissipation / (2 * pi * force * half);
      const double square = first_harmonic(points, middle, half) / (pi * half);
      loop.omega = std::sqrt(square);
      loop.zeta = loop.dissipation / (2 * pi * square * half * half);
      loop.middle = middle;
      loop.points = points;
      for (LoopPoint &each : loop.points) { each.amplitude -= middle; }
      loop.peak = std::move(state);
   }

   ChangingNodes &nodes_;
   const ReducedProblem &problem_;
   Index load_;
   const ModalLoopSettings &settings_;
   MarchSettings march_;
   double share_;
};

/// The force of a loop of a size, between one that is too small and one that is too large: by
/// regula falsi of logarithms, in which an end that is kept a second time counts half
/// (Illinois).
class ForceSearch
{
public:
   ForceSearch(double first, double power, double tolerance)
      : force(first), power_(power), tolerance_(tolerance)
   {
   }

   /// A loop with the force has this size, relative to the requested size.
   void found(double value)
   {
      const double off = std::log(value);
      if (value > 1)
      {
         high_ = force;
         at_high_ = off;
         if (side_ == 1) { at_low_ *= 0.5; }
         side_ = 1;
      }
      else
      {
         // The joint depends on its history: a force may now have a smaller effect than before.
         if (std::isfinite(at_high_) && high_ - force <= 1e-7 * high_)
         {
            high_ = at_high_ = infinity;
         }
         low_ = force;
         at_low_ = off;
         if (side_ == -1) { at_high_ *= 0.5; }
         side_ = -1;
      }
      next(value);
   }
   /// No loop has the force, nor any force beyond `limit`.
   void slides(double limit)
   {
      high_ = sliding = std::min(force, limit > low_ ? limit : force);
      at_high_ = infinity;
      side_ = 0;
      next(1);
   }
   /// Do both ends agree? The largest loop before the joint slides need not be so accurate.
   bool closed() const
   {
      const double allowed = std::isnan(sliding) ? 1e-9 : std::max(1e-9, 100 * tolerance_);
      return std::isfinite(high_) && high_ - low_ <= allowed * high_;
   }

   double force;
   double sliding = std::numeric_limits<double>::quiet_NaN();

private:
   void next(double value)
   {
      // A structure in which nothing slips is linear, and a joint that slips is softer.
      if (low_ == 0 && std::isnan(sliding)) { force /= std::pow(value, power_); }
      else if (std::isfinite(at_high_) && low_ > 0)
      {
         force = std::exp(std::log(low_) +
                          (std::log(high_) - std::log(low_)) * at_low_ / (at_low_ - at_high_));
      }
      else if (std::isfinite(high_)) { force = 0.5 * (low_ + high_); }
      else { force /= std::pow(value, power_); }
   }

   static constexpr double infinity = std::numeric_limits<double>::infinity();
   double power_, tolerance_, low_ = 0, high_ = infinity, at_low_ = 0, at_high_ = infinity;
   int side_ = 0; // of the last loop
};

/// Loops of one mode about a state, each after those that were not larger.
class Curve
{
public:
   Curve(FrictionSolver &solver, const ReducedProblem &problem, const ContactState &state,
         const std::string &load, double omega, const ModalLoopSettings &settings)
      : problem_(problem), state_(state), load_(static_cast<Index>(problem.pattern(load))),
        settings_(settings), omega_(omega), below_(state), nodes_(solver), first_nodes_(solver),
        // Forces are sought with half of the increments of the result.
        swings_(nodes_, problem, load_, settings, std::max(1, settings.march.increments / 2),
                nearly()),
        first_(first_nodes_, problem, load_, settings,
               std::max(1, settings.march.increments / 2))
   {
      require(problem.patterns[load_].control == Control::force, "modal loop: the load '", load,
              "' prescribes displacements, must be forces");
      require_positive("modal loop: omega", omega);
      require(problem.knows_loads(),
              "modal loop: the response H of the loads is not known, must be");
      require(settings.cycles >= 2, "modal loop: cycles is ", settings.cycles,
              ", must be at least 2, because the first cycle is not steady");
      require(state.multipliers.size() == static_cast<Index>(problem.patterns.size()) &&
                 state.multipliers[load_] == 0,
              "modal loop: the state does not have the loads of the problem, or that of '",
              load, "' is not zero");
   }

   /// The loop of the next size.
   ModalLoop loop(double size)
   {
      require_positive("modal loop: size", size);
      if (size_ > 0)
      {
         omega_ = std::max(0.5 * secant_, secant_ + slope_ * std::log(size / size_));
      }
      const bool by_energy = settings_.size == LoopSize::energy;
      const double first = by_energy ? omega_ * std::sqrt(2 * size) : omega_ * omega_ * size;
      // Forces of a smaller loop are round-off of those of the state: frequencies are wrong by
      // some 1e-6 here.
      const LoadPattern &pattern = problem_.patterns[load_];
      const double unit = std::hypot(pattern.q.norm(), pattern.p.norm()),
                   least =
                      unit > 0 ? 1e-7 * std::hypot(state_.p.norm(), state_.q.norm()) / unit : 0;
      require(first >= (1 - 1e-6) * least, pattern.name, ": ",
              by_energy ? "energy " : "amplitude ", size, " must be at least ",
              by_energy ? 0.5 * std::pow(least / omega_, 2) : least / (omega_ * omega_),
              ": forces of a smaller one are round-off of those that hold the joint together");
      ForceSearch search(std::max(first, least_), by_energy ? 0.5 : 1, settings_.tolerance);
      ModalLoop best;
      std::string slides;
      const auto value_of = [&](double force, double half)
      { return (by_energy ? 0.5 * force * half : half) / size; };
      const auto off = [&](double force, double half)
      {
         const double value = value_of(force, half);
         // Accepts the largest loop before the joint slides, whatever its size.
         return std::abs(value - 1) <= settings_.tolerance || slides.size() > 0
                   ? 0
                   : std::log(value);
      };
      // 1. Loops of more and more suitable forces.
      for (int count = 0; count < 100 && !search.closed(); ++count)
      {
         Swing trial = swings_.to_and_fro(search.force, below_, off);
         if (!solved(trial.status))
         {
            if (trial.status == FrictionStatus::stopped ||
                trial.status == FrictionStatus::stalled)
            {
               best.status = trial.status;
               best.message = trial.message;
               return best;
            }
            slides = trial.message;
            search.slides(trial.event_force);
            continue;
         }
         const double value = value_of(trial.loop.force, trial.loop.amplitude);
         const bool enough = std::abs(value - 1) <= settings_.tolerance,
                    unsteady = !trial.loop.steady && !trial.rough;
         if (unsteady && !slides.empty()) { break; } // close below the force at which it slides
         if (value <= 1 && !unsteady)
         {
            below_ = trial.loop.peak;
            least_ = trial.loop.force;
         }
         if (!trial.rough && (value <= 1 || enough || unsteady))
         {
            best = std::move(trial.loop);
            best.status = trial.status;
            best.message = trial.message;
         }
         if (enough || unsteady) { break; }
         search.found(value);
      }
      const double reached = best.force > 0 ? value_of(best.force, best.amplitude) : 0;
      // 2. Increments are refined, and the first loading is compared.
      if (!swings_.exact() && best.steady) { refine(best); }
      if (!solved(best.status)) { return best; }
      if (best.force > 0) { first_.compare(state_, best); }
      // 3. The frequency at which the next size begins, and the outcome.
      if (best.steady) { foresee(best, size); }
      if (best.force > 0 && !best.steady) { best.message = why_not_steady(best); }
      else if (std::abs(reached - 1) > settings_.tolerance)
      {
         best.status = std::isnan(search.sliding) ? FrictionStatus::no_solution
                                                  : FrictionStatus::gross_sliding;
         best.sliding_force = search.sliding;
         best.message =
            std::isnan(search.sliding)
               ? "no loop of the requested size was found"
               : "the joint slides as a whole before a loop has this size: " + slides;
      }
      return best;
   }

private:
   /// A loop that is compared with another one need not be as steady as the result.
   double nearly() const { return 0.05 * settings_.increment_error; }

   /// The loop is marched again with twice as many increments, until that changes little, and
   /// then until it is steady.
   void refine(ModalLoop &best)
   {
      int increments = std::max(1, settings_.march.increments / 2);
      for (int doubled = 0; doubled < 4; ++doubled)
      {
         increments *= 2;
         const ModalLoop coarse = best;
         bool little = false;
         for (const double share : {nearly(), 0.0})
         {
            const Swings finer(nodes_, problem_, load_, settings_, increments, share);
            Swing found =
               finer.to_and_fro(best.force, best.peak, [](double, double) { return 0.0; });
            const int cycles = best.cycle;
            best = std::move(found.loop);
            best.cycle += cycles;
            best.status = found.status;
            best.message = found.message;
            little = find_errors(coarse, best);
            if (!solved(best.status) || !best.steady) { return; }
            if (!little && doubled < 3) { break; }
         }
         if (little) { return; }
      }
   }

   /// Errors by a loop with half as many increments. Are they small?
   bool find_errors(const ModalLoop &coarse, ModalLoop &loop) const
   {
      loop.omega_error = std::abs(loop.omega - coarse.omega);
      // Nodes that open or close within increments lose work that is not friction's.
      const double square = std::pow(loop.omega * loop.amplitude, 2),
                   other = std::abs(loop.area - loop.dissipation) / (2 * pi * square);
      loop.zeta_error = std::max(std::abs(loop.zeta - coarse.zeta), other);
      return loop.omega_error <= 0.1 * settings_.increment_error * loop.omega &&
             loop.zeta_error <= settings_.increment_error * loop.zeta + 1e-9;
   }

   /// The secant frequency changes with the logarithm of the size as between the last two.
   void foresee(const ModalLoop &loop, double size)
   {
      const double way = std::log(size / size_);
      slope_ = size_ > 0 && way > 0 ? (loop.omega_secant - secant_) / way : 0;
      size_ = size;
      secant_ = omega_ = loop.omega_secant;
   }

   std::string why_not_steady(const ModalLoop &loop) const
   {
      std::ostringstream message;
      message << std::setprecision(3);
      if (loop.ratchet > 0)
      {
         message << "the joint ratchets: forces repeat, and each cycle moves node "
                 << loop.ratchet_node << " on by " << loop.ratchet;
      }
      else
      {
         message << "not steady after " << loop.cycle << " cycles, ";
         const double work = std::abs(loop.area - loop.dissipation);
         if (!swings_.exact() || loop.change > settings_.steady_tolerance ||
             work <= settings_.steady_tolerance * loop.dissipation)
         {
            message << "the last one still changed the state by " << loop.change
                    << " of its range";
         }
         else
         {
            message << "which repeat, but the work along one is " << loop.area
                    << " and the loss by friction " << loop.dissipation
                    << ": the exact path lacks points, a march by fixed increments has no need "
                       "of them";
         }
      }
      return message.str();
   }

   const ReducedProblem &problem_;
   const ContactState &state_;
   Index load_;
   const ModalLoopSettings &settings_;
   double omega_;                             // at which the next loop begins
   double size_ = 0, secant_ = 0, slope_ = 0; // of the last steady loop
   ContactState below_;                // at the end of the largest loop that was not too large
   double least_ = 0;                  // its force
   ChangingNodes nodes_, first_nodes_; // of loops, and of the first loading
   Swings swings_, first_;
};

} // namespace

ModalLoop modal_loop(FrictionSolver &solver, const ReducedProblem &problem,
                     const ContactState &state, const std::string &load, double omega,
                     double size, const ModalLoopSettings &settings)
{
   return Curve(solver, problem, state, load, omega, settings).loop(size);
}

std::vector<ModalLoop> modal_curve(FrictionSolver &solver, const ReducedProblem &problem,
                                   const ContactState &state, const std::string &load,
                                   double omega, const std::vector<double> &sizes,
                                   const ModalLoopSettings &settings)
{
   Curve curve(solver, problem, state, load, omega, settings);
   std::vector<ModalLoop> all;
   for (std::size_t k = 0; k < sizes.size(); ++k)
   {
      require(k == 0 || sizes[k] > sizes[k - 1], "modal curve: size ", sizes[k], " follows ",
              sizes[k == 0 ? 0 : k - 1], ", must be larger");
      if (k > 0 && std::isfinite(all.back().sliding_force))
      {
         all.push_back(all.back());
         continue;
      }
      all.push_back(curve.loop(sizes[k]));
   }
   return all;
}

} // namespace cattaneo
