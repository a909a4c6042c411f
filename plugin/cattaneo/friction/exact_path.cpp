#include <algorithm>
#include <cattaneo/friction/exact_path.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void list_changes(const ContactState &from, const std::vector<NodeState> &to,
                  std::vector<StateChange> &changes)
{
   for (std::size_t i = 0; i < to.size(); ++i)
   {
      if (to[i] == from.status[i]) { continue; }
      changes.push_back(
         {from.time, from.multipliers, static_cast<Index>(i), from.status[i], to[i]});
   }
}

ExactPath::ExactPath(const ReducedProblem &problem)
   : problem_(problem),
     K_(problem.K), bounds_{friction_bounds(problem), friction_bounds(problem), {}},
     equations_(K_, bounds_.given)
{
   require(problem.components() == 1, "exact path: the reduced problem has ",
           problem.components(), " tangential components per node, must have 1");
}

/// The states from which each node may choose, by its present gap and forces.
void ExactPath::find_choices(const ContactState &state)
{
   const Index n = problem_.nodes();
   rates_.choice.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      Choice &choice = rates_.choice[i];
      const FrictionBound &bound = bounds_.given[i];
      const double q = F_[i], p = F_[n + i], way = sense(state.status[i]),
                   forward = bound.reserve(q, p, 1), backward = bound.reserve(q, p, -1);
      if (!closed(state.status[i]))
      {
         const double gap = u_[n + i] + problem_.gap[i];
         choice = K_(n + i, n + i) * gap > noise_[i] ? Choice::open : Choice::any;
      }
      else if (p <= noise_[i]) { choice = Choice::any; }
      else if (bound.none()) { choice = Choice::sliding; }
      else if (way != 0) { choice = way > 0 ? Choice::forward : Choice::backward; }
      else if (std::min(forward, backward) > noise_[i]) { choice = Choice::stick; }
      else { choice = forward < backward ? Choice::forward : Choice::backward; }
   }
}

/// Sets the piece of a node's bound at a pressure. False if the node has it already.
bool ExactPath::set_piece(Index node, double pressure)
{
   const FrictionBound piece = bounds_.given[node].straight(pressure);
   const auto same = [&](double sense)
   {
      return !bounds_.pieces[node].bends() &&
             piece.slope(0, sense) == bounds_.pieces[node].slope(0, sense) &&
             piece.intercept(0, sense) == bounds_.pieces[node].intercept(0, sense);
   };
   if (same(1) && same(-1)) { return false; }
   bounds_.pieces[node] = piece;
   equations_.set_bound(node, bounds_.given[node].of_rates(pressure));
   return true;
}

/// Sets the pieces of bounds that bend, at the present pressures; at a bend the piece above it.
/// True if a piece has changed.
bool ExactPath::find_pieces(const ContactState &state)
{
   const Index n = problem_.nodes();
   bounds_.bends.clear();
   bool changed = false;
   for (Index i = 0; i < n; ++i)
   {
      if (!bounds_.given[i].bends()) { continue; }
      const double p = closed(state.status[i]) ? std::max(F_[n + i], 0.0) : 0.0;
      const double below = bounds_.given[i].bend(p, -1), above = bounds_.given[i].bend(p, 1);
      const double nearest = p - below < above - p ? below : above;
      if (std::abs(p - nearest) > noise_[i])
      {
         changed = set_piece(i, p) || changed;
         continue;
      }
      bounds_.bends.push_back({i, nearest, 1.0});
      changed = set_piece(i, std::nextafter(nearest, 2 * nearest)) || changed;
   }
   return changed;
}

/// Changes the side of nodes at a bend whose pressures go to its other side. False if there are
/// none.
bool ExactPath::turn_bends()
{
   const Index n = problem_.nodes();
   const double tiny = 1e-12 * F_rate_.cwiseAbs().maxCoeff();
   bool turned = false;
   for (Bend &bend : bounds_.bends)
   {
      if (bend.side * F_rate_[n + bend.node] >= -tiny) { continue; }
      bend.side = -bend.side;
      set_piece(bend.node, bend.side > 0 ? std::nextafter(bend.pressure, 2 * bend.pressure)
                                         : bend.pressure);
      turned = true;
   }
   return turned;
}

/// Intercepts of the bounds of nodes that slip (the part that does not grow with p), with the
/// sense of their slip.
VectorXd ExactPath::intercepts(const std::vector<NodeState> &states) const
{
   const Index n = problem_.nodes();
   VectorXd constant = VectorXd::Zero(2 * n);
   for (Index i = 0; i < n; ++i)
   {
      const double way = closed(states[i]) ? sense(states[i]) : 0;
      if (way != 0) { constant[i] = way * bounds_.pieces[i].intercept(0, way); }
   }
   return constant;
}

/// Handles a body that touches at one node and can turn about it, unless the loads are
/// balanced. One more node is set to touch; its force shows whether the loads turn the body.
/// False if there is no such body.
bool ExactPath::place_pivot(std::vector<NodeState> states)
{
   const Index n = problem_.nodes();
   const MatrixXd free = free_motions(problem_, states);
   if (free.cols() != 1) { return false; }
   pivot_.motion = free.col(0);
   double farthest = 0;
   for (Index i = 0; i < n; ++i)
   {
      // Slipping nodes around the pivot would add their friction.
      if (closed(states[i]) && std::abs(pivot_.motion[i]) > 1e-9) { return false; }
      if (closed(states[i]) || std::abs(pivot_.motion[n + i]) <= farthest) { continue; }
      farthest = std::abs(pivot_.motion[n + i]);
      pivot_.node = i;
   }
   if (pivot_.node < 0) { return false; }
   states[pivot_.node] = NodeState::forward_slip;
   rates_.choice[pivot_.node] = Choice::sliding;
   return equations_.set(states);
}

/// Rates without the node that held a pivot. The motion about the pivot is the least possible
/// one, measured with the length of the contact. False if the body is not balanced.
bool ExactPath::release_pivot()
{
   const Index n = problem_.nodes();
   rates_.choice[pivot_.node] = Choice::open;
   // The open nodes share its force, which then balances the loads.
   VectorXd share = VectorXd::Zero(2 * n);
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(equations_.states()[i]) || i == pivot_.node)
      {
         share[n + i] = pivot_.motion[n + i];
      }
   }
   share *= -F_rate_[n + pivot_.node] * pivot_.motion[n + pivot_.node] / share.squaredNorm();
   const double round_off = 1e-13 * rates_.b.cwiseAbs().maxCoeff();
   if (share.cwiseAbs().maxCoeff() > round_off ||
       !equations_.solve(rates_.b + share, u_rate_, F_rate_))
   {
      last_.failure = "the loads turn a body about its only node in contact";
      return false;
   }
   F_rate_[pivot_.node] = F_rate_[n + pivot_.node] = 0;
   const VectorXd weighted = node_lengths(problem_).replicate(2, 1).cwiseProduct(pivot_.motion);
   u_rate_ -= pivot_.motion * (weighted.dot(u_rate_) / weighted.dot(pivot_.motion));
   // Nodes that touch without force let the body turn in one direction only.
   double least = -std::numeric_limits<double>::infinity(), most = -least;
   for (Index i = 0; i < n; ++i)
   {
      const double turned = pivot_.motion[n + i];
      if (rates_.choice[i] != Choice::any || closed(equations_.states()[i]) || turned == 0)
      {
         continue;
      }
      const double bound = -u_rate_[n + i] / turned;
      if (turned > 0) { least = std::max(least, bound); }
      else { most = std::min(most, bound); }
   }
   if (least > most)
   {
      last_.failure = "no rates meet the laws of contact and friction";
      return false;
   }
   u_rate_ += std::clamp(0.0, least, most) * pivot_.motion;
   return true;
}

/// Gives the present states to the equations. If these states do not hold the bodies, finds
/// others that do. False if there are none.
bool ExactPath::set_states(const ContactState &state)
{
   std::vector<NodeState> states = state.status;
   if (equations_.set(states)) { return true; }
   // Nodes that touch without force may hold a body that the others do not.
   for (std::size_t i = 0; i < states.size(); ++i)
   {
      if (rates_.choice[i] == Choice::any) { states[i] = NodeState::stick; }
   }
   return equations_.set(states) || place_pivot(std::move(states));
}

/// Finds rates with which all nodes obey the laws: by Newton's steps from the present states or
/// from known rates, then by Lemke's method from several starts, at last as a body that
/// is balanced on one node (place_pivot()). False if there are none. @param present states of
/// the nodes; nodes at rest keep theirs
bool ExactPath::search_rates(std::optional<ComplementarityReport> known,
                             const std::vector<NodeState> &present)
{
   std::vector<NodeState> states = equations_.states();
   ComplementarityReport found = solve_by_newton(
      equations_, rates_, 30, known ? std::move(*known) : ComplementarityReport());
   counters_.newton_steps += found.newton_steps;
   last_.found_by = "event path";
   unsigned seed = 0;
   for (double slack : {1.0, 0.1, 10.0, 0.01, 1.0, 1e-3, 1.0, 0.1})
   {
      if (found.solved) { break; }
      const VectorXd rest = VectorXd::Zero(K_.rows());
      if (!equations_.set(states)) { break; }
      found = solve_by_lemke(equations_, rates_, rest, rest, slack, ++seed);
      counters_.pivots += found.pivots;
      last_.found_by = "event path, Lemke";
   }
   if (!found.solved && pivot_.node < 0)
   {
      // Nodes that touch may carry no force if the body is balanced about another node.
      for (std::size_t i = 0; i < states.size(); ++i)
      {
         if (rates_.choice[i] == Choice::any) { states[i] = NodeState::separation; }
      }
      found.solved =
         place_pivot(std::move(states)) && equations_.solve(rates_.b, found.x, found.F);
   }
   if (found.solved && pivot_.node < 0)
   {
      keep_states_at_rest(equations_, rates_, present, found);
   }
   u_rate_ = std::move(found.x);
   F_rate_ = std::move(found.F);
   return found.solved;
}

/// Rates of displacements and forces over the rest of the path.
bool ExactPath::find_rates(const ContactState &state, const PathWay &way)
{
   // 1. The pieces of bounds that bend.
   const bool pieces_changed = find_pieces(state);
   // 2. Rates that were found before hold as long as pieces, states and loads' path are the
   // same.
   std::optional<ComplementarityReport> known;
   if (!pieces_changed && bounds_.bends.empty() && known_.to.size() == way.multipliers.size() &&
       known_.to == way.multipliers && known_.from == state.multipliers &&
       equations_.states() == state.status)
   {
      known.emplace();
      known->x = u_rate_;
      known->F = F_rate_;
   }
   known_.to.resize(0);
   last_.ended = false;
   // 3. The pressure of each node at a bend goes to one side of it. A few rounds find the
   // sides, if they exist.
   const std::size_t most_turns = 2 * bounds_.bends.size() + 1;
   for (std::size_t turns = 0; turns < most_turns; ++turns)
   {
      // 4. Equations that can be solved.
      find_choices(state);
      pivot_.node = -1;
      if (!set_states(state))
      {
         last_.failure = "the equations of the present states are singular";
         return false;
      }
      // 5. Rates that meet the laws.
      last_.ended = !search_rates(std::exchange(known, std::nullopt), state.status);
      if (last_.ended)
      {
         last_.failure = "no rates meet the laws of contact and friction";
         return false;
      }
      if (turn_bends()) { continue; }
      // 6. The node that was set to touch is open again.
      if (pivot_.node < 0) { return true; }
      last_.found_by = "event path, pivot";
      return release_pivot();
   }
   last_.failure = "no rates are on one side of each bend of a law of friction";
   return false;
}

/// Distance of a node from a boundary of its state, as a force. It is computed from the
/// gap of an open node. For a closed node it is computed from the bound of friction in a sense
/// of slip, or for sense 0 from the pressure. rate() tells how fast it changes.
double ExactPath::left(Index i, double sense) const
{
   const Index m = problem_.nodes() + i;
   if (rates_.choice[i] == Choice::open) { return K_(m, m) * (u_[m] + problem_.gap[i]); }
   return sense == 0 ? F_[m] : bounds_.given[i].reserve(F_[i], F_[m], sense);
}
double ExactPath::rate(Index i, double sense) const
{
   const Index m = problem_.nodes() + i;
   if (rates_.choice[i] == Choice::open) { return K_(m, m) * u_rate_[m]; }
   if (sense == 0) { return F_rate_[m]; }
   return equations_.bound()[i].slope(F_[m], sense) * F_rate_[m] + sense * F_rate_[i];
}

/// The boundaries that nodes may reach, as arguments of left(). Nodes on a boundary have rates
/// that lead away from it.
template <class Visitor>
void ExactPath::for_each_boundary(Visitor visit) const
{
   for (Index i = 0; i < problem_.nodes(); ++i)
   {
      const Choice choice = rates_.choice[i];
      switch (choice)
      {
      case Choice::any:
         break;
      case Choice::stick:
         visit(i, 1);
         visit(i, -1);
         break;
      case Choice::open:
      case Choice::sliding:
         visit(i, 0);
         break;
      case Choice::forward:
      case Choice::backward:
         if (slips(equations_.states()[i])) { visit(i, 0); }
         else { visit(i, choice == Choice::forward ? -1 : 1); }
         break;
      }
   }
}

/// Share of the rest of the path until a node reaches a boundary of its state, or until the
/// stop if that comes first.
double ExactPath::share_to_event(double stop)
{
   double share = stop;
   last_.event = -1;
   for_each_boundary(
      [&](Index i, double sense)
      {
         // A boundary that is reached exactly at the stop, to round-off, is not an event before
         // it: a node that comes back to its friction limit when the load turns has not
         // slipped.
         const double value = left(i, sense), change = rate(i, sense);
         if (value + stop * change >= -noise_[i]) { return; }
         const double to = std::max(value, 0.0) / -change;
         if (to >= share) { return; }
         share = to;
         last_.event = i;
      });
   // The pressure of a closed node may reach the next bend of its bound.
   const Index n = problem_.nodes();
   for (Index i = 0; i < n; ++i)
   {
      const double change = F_rate_[n + i];
      if (!bounds_.given[i].bends() || !closed(equations_.states()[i]) || change == 0)
      {
         continue;
      }
      const double p = F_[n + i],
                   bend = bounds_.given[i].bend(p + std::copysign(noise_[i], change), change),
                   to = (bend - p) / change;
      if (std::abs(bend - p) - stop * std::abs(change) >= -noise_[i] || to >= share)
      {
         continue;
      }
      share = to;
      last_.event = i;
   }
   return share;
}

/// If the step passed a boundary by more than round-off, the share by which it was too long.
double ExactPath::share_past_event() const
{
   double back = 0;
   for_each_boundary(
      [&](Index i, double sense)
      {
         const double value = left(i, sense), change = rate(i, sense);
         if (value < -noise_[i] && change < 0) { back = std::max(back, value / change); }
      });
   return back;
}

namespace
{

/// Would the correction of a step reverse the slip of a node, in contradiction to its state?
bool turns(const VectorXd &step, const VectorXd &correction,
           const std::vector<NodeState> &states)
{
   for (std::size_t i = 0; i < states.size(); ++i)
   {
      const double way = closed(states[i]) ? sense(states[i]) : 0;
      const auto row = static_cast<Index>(i);
      if (way * step[row] >= 0 && way * (step[row] + correction[row]) < 0) { return true; }
   }
   return false;
}

} // namespace

bool ExactPath::starts_from(const ContactState &state) const
{
   const Index n = problem_.nodes();
   const VectorXd u = state.displacements();
   const VectorXd f = problem_.clamped_forces(state.multipliers);
   // Ten times the tolerance of an increment of the solver.
   const double allowed = 1e-11 * std::max(state.peak_force, f.cwiseAbs().maxCoeff());
   const VectorXd round_off = 4 * equations_.round_off(f, u);
   bool starts =
      check_laws(problem_, state.v, state, f + equations_.forces(u), allowed, round_off).obeyed;
   for (Index i = 0; i < n; ++i)
   {
      const double limit = std::max({allowed, round_off[i], round_off[n + i]}),
                   way = sense(state.status[i]),
                   off = bounds_.given[i].reserve(state.q[i], state.p[i], way),
                   gap = K_(n + i, n + i) * (state.w[i] + problem_.gap[i]);
      starts = starts && (!closed(state.status[i]) || gap <= limit) &&
               (way == 0 || std::abs(off) <= limit);
   }
   return starts;
}

/// Sets the path of the loads, the present displacements and forces, and their round-off.
/// Returns the largest force so far.
double ExactPath::set_out(const ContactState &state, const PathWay &way)
{
   const Index n = problem_.nodes();
   const VectorXd f = problem_.clamped_forces(state.multipliers);
   const VectorXd f_end = problem_.clamped_forces(way.multipliers);
   u_ = state.displacements();
   F_ = state.forces();
   // Relative to the present forces, because larger forces later give no information about
   // present gaps.
   const double present =
      std::max({state.peak_force, f.cwiseAbs().maxCoeff(), F_.cwiseAbs().maxCoeff()});
   const VectorXd round_off = equations_.round_off(f, u_);
   noise_ = round_off.head(n).cwiseMax(round_off.tail(n));
   noise_ = noise_.cwiseMax(1e-13 * (present > 0 ? present : f_end.cwiseAbs().maxCoeff()));
   rates_.b = f_end - f;
   return present;
}

/// Advances by a share of the path, to these loads. Returns the part of the share that was
/// taken back because an event came earlier.
double ExactPath::go(double share, const std::vector<NodeState> &states, const VectorXd &loads)
{
   const Index n = problem_.nodes();
   const VectorXd step = share * u_rate_;
   u_ += step;
   // A node closes when its gap is round-off; the remaining gap goes into the forces.
   for (Index i = 0; i < n; ++i)
   {
      if (closed(states[i])) { u_[n + i] = -problem_.gap[i]; }
   }
   F_ += share * F_rate_;
   // Round-off accumulates over events, and stays after displacements have become small.
   // Solving the equations of the states again removes it.
   const VectorXd clamped = problem_.clamped_forces(loads);
   const VectorXd forces = clamped + equations_.forces(u_);
   const VectorXd drift = (forces - F_).cwiseAbs() - 0.5 * equations_.round_off(clamped, u_);
   const bool drifted = drift.maxCoeff() > 0;
   const VectorXd constant = intercepts(states);
   VectorXd correction, corrected;
   last_.slip_error = VectorXd::Zero(n);
   // A step may be so short that the correction would reverse its slip. Then the displacements
   // are as accurate without the correction.
   if ((share < 1 && !drifted) || !equations_.solve(forces + constant, correction, corrected) ||
       (!drifted && turns(step, correction, states)))
   {
      return 0;
   }
   u_ += correction;
   F_ = corrected - constant;
   // The state before had this error already, so it does not count as slip.
   last_.slip_error = correction.head(n).cwiseAbs();
   // If little resists a rotation, the correction can carry a node past its event. Then go back
   // to the event.
   const double back = std::min(share, share_past_event());
   u_ -= back * u_rate_;
   F_ -= back * F_rate_;
   return back;
}

/// The present displacements and forces as a state with these loads. `present` is the largest
/// force so far.
void ExactPath::write(ContactState &state, std::vector<NodeState> states, double present) const
{
   const Index n = problem_.nodes();
   // The loads of the rest of the path are still to come.
   state.peak_force =
      std::max({present, F_.cwiseAbs().maxCoeff(),
                problem_.clamped_forces(state.multipliers).cwiseAbs().maxCoeff()});
   state.status = std::move(states);
   state.v = u_.head(n);
   state.w = u_.tail(n);
   state.q = F_.head(n);
   state.p = F_.tail(n);
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(state.status[i])) { state.q[i] = state.p[i] = 0; }
   }
   for (const Index row : problem_.held) { state.v[row] = state.q[row] = 0; }
}

bool ExactPath::advance(ContactState &state, const PathWay &way,
                        std::vector<StateChange> &changes)
{
   // 1. The states that each node may choose, and the rates of the chosen ones.
   const double present = set_out(state, way),
                peak = std::max(present,
                                problem_.clamped_forces(way.multipliers).cwiseAbs().maxCoeff());
   const long factored = equations_.factorisations();
   const bool found = find_rates(state, way);
   counters_.dense_factorisations += equations_.factorisations() - factored;
   if (!found) { return false; }
   std::vector<NodeState> states = equations_.states();
   if (pivot_.node >= 0) { states[pivot_.node] = NodeState::separation; }
   else if (free_motions(problem_, states).cols() > 0)
   {
      last_.failure = "a body slips at all of its contact nodes";
      return false;
   }

   // 2. Go to the next event or the stop. If the states hardly hold the bodies, round-off hides
   // an imbalance.
   const double rest = way.time - state.time,
                stop = way.stop == way.time ? 1 : (way.stop - state.time) / rest;
   double share = share_to_event(stop);
   const VectorXd by = share * rates_.b, step = share * u_rate_;
   if (equations_.most_round_off(by, step) > 1e-6 * peak &&
       equations_.round_off(by, step).maxCoeff() > 1e-6 * peak)
   {
      last_.failure = "contact in the present node states does not hold the bodies";
      return false;
   }
   list_changes(state, states, changes);
   const auto loads = [&]
   {
      return share == stop
                ? way.at_stop
                : VectorXd(state.multipliers + share * (way.multipliers - state.multipliers));
   };
   share -= go(share, states, loads());

   // 3. The rates hold for the rest of the path, which is shorter now.
   u_rate_ *= 1 - share;
   F_rate_ *= 1 - share;
   state.time = share == stop ? way.stop : state.time + share * rest;
   state.multipliers = loads();
   known_.from = state.multipliers;
   known_.to = way.multipliers;
   write(state, std::move(states), present);
   return true;
}

} // namespace cattaneo
