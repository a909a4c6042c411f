#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cattaneo/friction/state_equations.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/progress_report.hpp>
#include <cattaneo/wear/worn_derivative.hpp>
#include <cmath>
#include <functional>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

StiffnessChange stiffness_scale(const ReducedProblem &problem)
{
   const auto count = static_cast<Index>(problem.patterns.size());
   StiffnessChange change{problem.K, MatrixXd::Zero(problem.K.rows(), count), problem.H};
   for (Index k = 0; k < count; ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      const bool prescribed = pattern.control == Control::displacement;
      if (prescribed) { change.loads.col(k) << pattern.q, pattern.p; }
      for (Index l = 0; problem.knows_loads() && l < count; ++l)
      {
         const bool other = problem.patterns[l].control == Control::displacement;
         require(problem.H(k, l) == 0 || prescribed == other, "stiffness scale: pattern '",
                 pattern.name, "' prescribes a ", prescribed ? "displacement" : "force",
                 " and is coupled by H to '", problem.patterns[l].name,
                 "', which does not: coupled patterns must be of one kind");
         if (!prescribed) { change.H(k, l) *= -1; }
      }
   }
   return change;
}

double Parameters::dot(const Parameters &change) const
{
   double sum = 0;
   const auto add = [&](const char *what, const MatrixXd &a, const MatrixXd &b)
   {
      if (a.size() == 0 || b.size() == 0) { return; }
      require(a.rows() == b.rows() && a.cols() == b.cols(), "parameters: ", what, " is ",
              a.rows(), " × ", a.cols(), " in one and ", b.rows(), " × ", b.cols(),
              " in the other, must be equal");
      sum += a.cwiseProduct(b).sum();
   };
   add("friction", friction, change.friction);
   add("gap", gap, change.gap);
   add("multipliers", multipliers, change.multipliers);
   add("stiffness", stiffness, change.stiffness);
   add("wear", wear, change.wear);
   return sum;
}

double TraceChange::of(const Response &response) const
{
   require(found, "trace change: the derivatives are not known: ", message);
   require(response.trace == 0 || trace == 0 || response.trace == trace,
           "trace change: the response belongs to another trace, must belong to this one");
   double sum = 0;
   for (const auto &[k, weight] : response.weights)
   {
      const auto add = [&, column = static_cast<Index>(k)](const VectorXd &w, const MatrixXd &x)
      {
         if (w.size() == 0) { return; }
         require(column < x.cols() && w.size() == x.rows(), "trace change: a response has ",
                 w.size(), " weights for state ", column, ", must have ", x.rows(),
                 " for states below ", x.cols());
         sum += w.dot(x.col(column));
      };
      add(weight.displacements, displacements);
      add(weight.forces, forces);
      add(weight.multipliers, multipliers);
      add(weight.conjugates, conjugates);
      add(weight.loss, loss);
      require(weight.worn.size() == 0 || worn.cols() > 0,
              "sensitivity: the response depends on wear, but the trace was recorded without a "
              "wear law");
      add(weight.worn, worn);
   }
   return sum;
}

namespace
{

/// Changes of parameters and of states, or derivatives of one number by them: a column for each
/// state.
struct Variables
{
   Parameters by;
   MatrixXd displacements, forces, multipliers;
};

/// Called with each variable that a number depends on, and the derivative by it. The forward
/// way sums changes of the variables, the backward way adds to their derivatives.
using Visitor = std::function<void(double &variable, double derivative)>;

} // namespace

struct Sensitivity::System
{
   System(const ReducedProblem &problem, const MarchTrace &trace,
          std::vector<StiffnessChange> stiffness);

   /// The equations of the states at the end of increment k. False, with the reason, if they
   /// are singular.
   bool set(std::size_t k);
   const ContactState &state(std::size_t k) const { return trace.states[k].state; }
   /// Change of the loads over the piece of the history that state k lies in.
   VectorXd piece(std::size_t k) const
   {
      const int point = trace.states[k].point;
      return trace.history.multipliers.col(point + 1) - trace.history.multipliers.col(point);
   }
   /// Does the tangential entry of a node lack an equation of forces?
   bool sticks(std::size_t k, Index i) const
   {
      return held[i] || state(k).status[i] == NodeState::stick;
   }

   /// The quantity that becomes zero where a node changes its state: a gap, a pressure or the
   /// reserve of friction. Derivatives by {v; w}, {q; p}, gap and friction.
   struct Boundary
   {
      VectorXd displacements, forces;
      double gap = 0, friction = 0;
   };
   Boundary boundary(std::size_t k) const;

   // The derivative of increment k, which both ways use.
   /// Forces with the contact nodes clamped by each change of stiffness, one column each.
   MatrixXd clamped_by_stiffness(std::size_t k) const;
   /// The same for conjugates of the loads, at given displacements.
   MatrixXd conjugates_by_stiffness(std::size_t k) const;
   /// Derivative of each node's tangential equation by its coefficient of friction.
   VectorXd equations_by_friction(std::size_t k) const;
   /// Visits all variables on which a quantity of one node (its loss or its worn depth) depends
   /// through its slip over increment k. `by` has the derivatives of this quantity.
   void visit_rubbing(std::size_t k, Index node, const RubbingDerivative &by, Variables &of,
                      const Visitor &visit) const;
   /// The same for the loss, and for the worn depth, of each node that slips over the increment
   /// and whose weight is not zero.
   void visit_loss(std::size_t k, const VectorXd &weights, Variables &of,
                   const std::function<Visitor(Index node)> &visitor) const;
   void visit_worn(std::size_t k, const VectorXd &weights, Variables &of,
                   const std::function<Visitor(Index node)> &visitor) const;

   // Forward.
   /// Displacements and forces of state k for forces db with the contact nodes clamped, forces
   /// `beside` added to the equations, and given displacements of the rows without one.
   void respond(std::size_t k, const VectorXd &db, const VectorXd &beside, VectorXd &du,
                VectorXd &dF);

   // Backward. Derivatives by the quantities that state k depends on.
   struct Adjoint
   {
      VectorXd equations; ///< by a term added to the equation of each row
      VectorXd clamped;   ///< by forces with the contact nodes clamped
      VectorXd imposed;   ///< by given displacements, zero in rows with an equation
   };
   Adjoint go_back(std::size_t k, const VectorXd &displacements, const VectorXd &forces);
   /// Rate at which a boundary comes nearer along the loads of the piece, by its Adjoint. If it
   /// is zero to round-off, the boundary does not decide how far the path goes, and the event
   /// is at the load before.
   double approach(std::size_t k, const Adjoint &of) const;
   /// Is the share of state k of its piece that of the state before?
   bool goes_with_the_last(std::size_t k) const
   {
      return trace.states[k - 1].point == trace.states[k].point;
   }
   /// Do forces, or derivatives by displacements, have a part along the free motions?
   bool pushes(const VectorXd &forces) const
   {
      const VectorXd along = free.transpose() * forces;
      return along.size() > 0 &&
             along.cwiseAbs().maxCoeff() > 1e-9 * forces.cwiseAbs().maxCoeff();
   }
   bool wears() const { return trace.wear.coefficient.size() > 0; }
   /// Was the wear since the beginning of increment k added to the gap before increment k + 1?
   bool updates_gap_after(std::size_t k) const
   {
      return k + 1 < trace.states.size() && trace.states[k + 1].depth != trace.states[k].depth;
   }

   const ReducedProblem &problem;
   const MarchTrace &trace;
   const std::vector<StiffnessChange> stiffness;
   const Index n, m; ///< nodes, slips
   const MatrixXd &K;
   MatrixXd F;    ///< forces of the patterns, one column each
   VectorXd acts; ///< their sign in the conjugates, see conjugates()
   std::vector<bool> held;
   const bool frictionless;
   std::string message;
   // Equations of the node states that were set last.
   MatrixXd free; ///< motions that they leave to a body; equations are then of K_held
   StateEquations *equations = nullptr;

   StateEquations as_given;
   std::unique_ptr<StateEquations> as_held;
   MatrixXd K_held, held_motions;        ///< K plus a stiffness against these motions
   long factorisations = 0, updates = 0; ///< of equations that were discarded
};

Sensitivity::System::System(const ReducedProblem &problem, const MarchTrace &trace,
                            std::vector<StiffnessChange> changes)
   : problem(problem), trace(trace), stiffness(std::move(changes)), n(problem.nodes()),
     m(problem.slips()), K(problem.K), held(n, false),
     frictionless(problem.friction.maxCoeff() == 0), as_given(K, friction_bounds(problem))
{
   const auto count = static_cast<Index>(problem.patterns.size());
   require(problem.components() <= 1, "sensitivity: the problem has ", problem.components(),
           " tangential components per node, at most 1 is supported");
   require(!trace.states.empty(),
           "sensitivity: the trace has no state, must have at least one");
   trace.history.validate(problem);
   for (const TracedState &traced : trace.states)
   {
      traced.state.validate(problem);
      require(traced.point >= 0 && traced.point + 1 < trace.history.times.size(),
              "sensitivity: a state follows point ", traced.point,
              " of the history, must follow one from 0 to ",
              static_cast<Index>(trace.history.times.size()) - 2);
   }
   for (const StiffnessChange &change : stiffness)
   {
      require(change.K.rows() == K.rows() && change.K.cols() == K.cols(),
              "sensitivity: a change of the stiffness is ", change.K.rows(), " × ",
              change.K.cols(), ", must be ", K.rows(), " × ", K.rows());
      require(change.loads.cols() == 0 ||
                 (change.loads.rows() == K.rows() && change.loads.cols() == count),
              "sensitivity: a change of the loads is ", change.loads.rows(), " × ",
              change.loads.cols(), ", must be ", K.rows(), " × ", count);
      require(change.H.rows() == 0 || (change.H.rows() == count && change.H.cols() == count),
              "sensitivity: a change of H is ", change.H.rows(), " × ", change.H.cols(),
              ", must be ", count, " × ", count);
   }
   F.resize(K.rows(), count);
   acts.resize(count);
   for (Index k = 0; k < count; ++k)
   {
      F.col(k) << problem.patterns[k].q, problem.patterns[k].p;
      acts[k] = problem.patterns[k].control == Control::force ? -1 : 1;
   }
   for (Index row : problem.held) { held[row % n] = true; }
   if (wears()) { trace.wear.validate(problem); }
}

bool Sensitivity::System::set(std::size_t k)
{
   std::vector<NodeState> states = state(k).status;
   // 1. Motions that these states leave to a body make the equations singular. A stiffness
   // against them is added. Balanced forces do not push them, so its size does not matter.
   free = free_motions(problem, states);
   if (free.cols() > 0 && (held_motions.cols() != free.cols() || held_motions != free))
   {
      if (as_held)
      {
         factorisations += as_held->factorisations();
         updates += as_held->updates();
      }
      held_motions = free;
      as_held.reset();
      K_held = K + K.diagonal().mean() * free * free.transpose();
      as_held = std::make_unique<StateEquations>(K_held, friction_bounds(problem));
   }
   equations = free.cols() > 0 ? as_held.get() : &as_given;
   // 2. A held node never slips. Closed, it counts as stuck. Open, only its opening is free.
   std::vector<Index> open;
   for (Index i = 0; i < n; ++i)
   {
      if (!held[i]) { continue; }
      if (closed(states[i])) { states[i] = NodeState::stick; }
      else { open.push_back(i); }
   }
   bool done = equations->set(states);
   for (Index i : open) { done = done && equations->set(i, NodeState::separation, true); }
   if (!done)
   {
      std::ostringstream text;
      text << "the states at time " << state(k).time
           << " leave a body free to move, and its motion has no derivatives";
      message = text.str();
   }
   return done;
}

Sensitivity::System::Boundary Sensitivity::System::boundary(std::size_t k) const
{
   const ContactState &now = state(k);
   const Index i = trace.states[k].event;
   Boundary at{VectorXd::Zero(K.rows()), VectorXd::Zero(K.rows())};
   // An open node closes where w + g = 0.
   if (!closed(now.status[i]))
   {
      at.displacements[m + i] = 1;
      at.gap = 1;
   }
   // A slipping node, or one without friction, opens where p = 0.
   else if (slips(now.status[i]) || m == 0) { at.forces[m + i] = 1; }
   // A sticking node begins to slip where f p - |q| = 0.
   else
   {
      at.forces[i] = now.q[i] < 0 ? 1 : -1;
      at.forces[m + i] = problem.friction[i];
      at.friction = now.p[i];
   }
   return at;
}

void Sensitivity::System::respond(std::size_t k, const VectorXd &db, const VectorXd &beside,
                                  VectorXd &du, VectorXd &dF)
{
   // Sticking nodes keep the given slip and closed ones the given opening. Only the other rows
   // have equations.
   VectorXd imposed = VectorXd::Zero(K.rows());
   for (Index i = 0; i < n; ++i)
   {
      if (m > 0 && sticks(k, i)) { imposed[i] = du[i]; }
      if (closed(state(k).status[i])) { imposed[m + i] = du[m + i]; }
   }
   VectorXd x, forces;
   equations->solve(db + K * imposed + beside, x, forces);
   du = imposed + x;
   // The equations may contain a stiffness that was added, so that forces are then formed with
   // K.
   dF = free.cols() > 0 ? VectorXd(db + K * du) : VectorXd(forces - beside);
}

Sensitivity::System::Adjoint Sensitivity::System::go_back(std::size_t k,
                                                          const VectorXd &displacements,
                                                          const VectorXd &forces)
{
   // respond() maps {db, beside, imposed} to {du, dF}. This is its transpose.
   Adjoint adjoint;
   VectorXd z;
   equations->solve_transposed(displacements + K * forces, adjoint.equations, z);
   adjoint.equations *= -1;
   adjoint.clamped = forces - z;
   adjoint.imposed = displacements + K * adjoint.clamped;
   for (Index i = 0; i < n; ++i)
   {
      if (m > 0 && !sticks(k, i)) { adjoint.imposed[i] = 0; }
      if (!closed(state(k).status[i])) { adjoint.imposed[m + i] = 0; }
   }
   return adjoint;
}

double Sensitivity::System::approach(std::size_t k, const Adjoint &of) const
{
   const VectorXd along = F * piece(k);
   const double rate = of.clamped.dot(along),
                most = of.clamped.cwiseAbs().dot(along.cwiseAbs());
   return std::abs(rate) > 1e-12 * most ? rate : 0.0;
}

MatrixXd Sensitivity::System::clamped_by_stiffness(std::size_t k) const
{
   const VectorXd u = state(k).displacements();
   MatrixXd by(K.rows(), stiffness.size());
   for (std::size_t j = 0; j < stiffness.size(); ++j)
   {
      const StiffnessChange &change = stiffness[j];
      auto column = by.col(static_cast<Index>(j));
      column = change.K * u;
      if (change.loads.cols() > 0) { column += change.loads * state(k).multipliers; }
   }
   return by;
}

MatrixXd Sensitivity::System::conjugates_by_stiffness(std::size_t k) const
{
   MatrixXd by = MatrixXd::Zero(F.cols(), static_cast<Index>(stiffness.size()));
   for (std::size_t j = 0; j < stiffness.size(); ++j)
   {
      const StiffnessChange &change = stiffness[j];
      auto column = by.col(static_cast<Index>(j));
      if (change.H.rows() > 0) { column += change.H * state(k).multipliers; }
      if (change.loads.cols() == 0) { continue; }
      column += acts.cwiseProduct(change.loads.transpose() * state(k).displacements());
   }
   return by;
}

VectorXd Sensitivity::System::equations_by_friction(std::size_t k) const
{
   const ContactState &now = state(k);
   VectorXd by = VectorXd::Zero(n);
   for (Index i = 0; m > 0 && i < n; ++i)
   {
      if (!sticks(k, i)) { by[i] = sense(now.status[i]) * now.p[i]; }
   }
   return by;
}

void Sensitivity::System::visit_rubbing(std::size_t k, Index i, const RubbingDerivative &by,
                                        Variables &of, const Visitor &visit) const
{
   const auto now = static_cast<Index>(k), before = now - 1;
   visit(of.forces(i, before), by.q0[0]);
   visit(of.forces(i, now), by.q1[0]);
   visit(of.forces(m + i, before), by.p0);
   visit(of.forces(m + i, now), by.p1);
   visit(of.displacements(i, now), by.slip[0]);
   visit(of.displacements(i, before), -by.slip[0]);
   visit(of.by.friction[i], by.friction);
   for (std::size_t s = 0; s < stiffness.size(); ++s)
   {
      visit(of.by.stiffness[static_cast<Index>(s)], by.stiffness[0] * stiffness[s].K(i, i));
   }
}

void Sensitivity::System::visit_loss(std::size_t k, const VectorXd &weights, Variables &of,
                                     const std::function<Visitor(Index)> &visitor) const
{
   if (m == 0 || weights.isZero(0)) { return; }
   const Rubbing rub = rubbing(problem, state(k - 1), state(k));
   for (Index i = 0; i < n; ++i)
   {
      if (weights[i] == 0 || rub.way[i] == 0) { continue; }
      visit_rubbing(k, i, loss_derivative(problem, state(k - 1), state(k), rub, i), of,
                    visitor(i));
   }
}

void Sensitivity::System::visit_worn(std::size_t k, const VectorXd &weights, Variables &of,
                                     const std::function<Visitor(Index)> &visitor) const
{
   if (m == 0 || !wears() || weights.isZero(0)) { return; }
   const Rubbing rub = rubbing(problem, state(k - 1), state(k));
   for (Index i = 0; i < n; ++i)
   {
      if (weights[i] == 0 || rub.way[i] == 0 || !(problem.weights[i] > 0)) { continue; }
      const WornDerivative worn =
         worn_derivative(problem, trace.wear, state(k - 1), state(k), rub, i);
      const Visitor visit = visitor(i);
      visit_rubbing(k, i, worn.by, of, visit);
      visit(of.by.wear[i], worn.coefficient);
   }
}

Sensitivity::Sensitivity(const ReducedProblem &problem, const MarchTrace &trace,
                         std::vector<StiffnessChange> stiffness)
   : system_(std::make_unique<System>(problem, trace, std::move(stiffness)))
{
   require_coulomb(problem, "sensitivities");
}
Sensitivity::~Sensitivity() = default;
Sensitivity::Sensitivity(Sensitivity &&) noexcept = default;

long Sensitivity::factorisations() const
{
   const System &s = *system_;
   return s.factorisations + s.as_given.factorisations() +
          (s.as_held ? s.as_held->factorisations() : 0);
}
long Sensitivity::updates() const
{
   const System &s = *system_;
   return s.updates + s.as_given.updates() + (s.as_held ? s.as_held->updates() : 0);
}

namespace
{

/// Reports how many states are done. True, with the reason, if the monitor asks to stop.
bool stopped(const Monitor &monitor, ProgressReport &progress, Index done, Index all,
             std::string &why)
{
   progress.note(static_cast<double>(done) / static_cast<double>(all), done);
   if (!monitor.stopped()) { return false; }
   why = "it was stopped on request";
   return true;
}

} // namespace

TraceChange Sensitivity::along(const Parameters &change, const Monitor &monitor)
{
   System &s = *system_;
   const Index n = s.n, m = s.m, count = s.F.cols(), points = s.trace.history.times.size(),
               states = static_cast<Index>(s.trace.states.size());
   const auto check = [](const char *what, const MatrixXd &x, Index rows, Index columns)
   {
      require(x.size() == 0 || (x.rows() == rows && x.cols() == columns),
              "sensitivity: a change of ", what, " is ", x.rows(), " × ", x.cols(),
              ", must be ", rows, " × ", columns);
      require(x.allFinite(), "sensitivity: a change of ", what, " is not finite");
   };
   check("friction", change.friction, n, 1);
   check("gap", change.gap, n, 1);
   check("multipliers", change.multipliers, count, points);
   check("stiffness", change.stiffness, static_cast<Index>(s.stiffness.size()), 1);
   check("wear", change.wear, n, 1);
   require(change.wear.size() == 0 || s.wears(),
           "sensitivity: wear is changed, but the trace was recorded without a wear law");
   TraceChange result;
   result.displacements = result.forces = MatrixXd::Zero(m + n, states);
   result.multipliers = result.conjugates = MatrixXd::Zero(count, states);
   result.loss = MatrixXd::Zero(n, states);
   result.worn = MatrixXd::Zero(n, s.wears() ? states : 0);
   const auto or_zero = [](const MatrixXd &x, Index rows, Index columns)
   { return x.size() > 0 ? x : MatrixXd(MatrixXd::Zero(rows, columns)); };
   Variables x{{or_zero(change.friction, n, 1), or_zero(change.gap, n, 1),
                or_zero(change.multipliers, count, points),
                or_zero(change.stiffness, static_cast<Index>(s.stiffness.size()), 1),
                or_zero(change.wear, s.wears() ? n : 0, 1)},
               result.displacements,
               result.forces,
               result.multipliers};
   VectorXd gap = x.by.gap;
   Index in_gap = 0; // the last state whose wear is in the gap
   double share_change = 0;
   ProgressReport progress(monitor);
   for (Index k = 1; k < states; ++k)
   {
      if (stopped(monitor, progress, k - 1, states - 1, result.message)) { return result; }
      const TracedState &traced = s.trace.states[k];
      // 1. The equations of the node states at the end of increment k.
      if (!s.set(k))
      {
         result.message = s.message;
         return result;
      }
      // 2. If wear was added to the gap before this increment, the change of wear is added too.
      if (s.wears() && s.updates_gap_after(k - 1))
      {
         gap += result.worn.middleCols(in_gap + 1, k - 1 - in_gap).rowwise().sum();
         in_gap = k - 1;
      }
      // 3. Changes of the loads, the stiffness and friction add forces to the equations.
      VectorXd loads = (1 - traced.share) * x.by.multipliers.col(traced.point) +
                       traced.share * x.by.multipliers.col(traced.point + 1);
      const VectorXd clamped = s.F * loads + s.clamped_by_stiffness(k) * x.by.stiffness;
      VectorXd beside = VectorXd::Zero(m + n);
      if (m > 0) { beside.head(n) = s.equations_by_friction(k).cwiseProduct(x.by.friction); }
      if (s.frictionless && s.pushes(clamped + beside))
      {
         result.message = "a load pushes a body that is free to slide without friction";
         return result;
      }
      // 4. Sticking nodes keep the slip of the state before, closed nodes have w = -g.
      VectorXd du = x.displacements.col(k - 1), dF;
      du.tail(n) = -gap;
      s.respond(k, clamped, beside, du, dF);
      // 5. If the increment ends where a node changes its state, the load there is an unknown
      // too. Its change keeps the node on its boundary. If the boundary does not come nearer
      // along the loads, the event is taken at the load of the state before, and has the same
      // derivative as that load.
      if (traced.event < 0) { share_change = 0; }
      else
      {
         const System::Boundary at = s.boundary(k);
         const double rate = s.approach(k, s.go_back(k, at.displacements, at.forces));
         const double off = at.displacements.dot(du) + at.forces.dot(dF) +
                            at.gap * gap[traced.event] +
                            at.friction * x.by.friction[traced.event];
         if (rate != 0) { share_change = -off / rate; }
         else if (!s.goes_with_the_last(k)) { share_change = 0; }
         VectorXd du_rate = VectorXd::Zero(m + n), dF_rate;
         s.respond(k, s.F * s.piece(k), VectorXd::Zero(m + n), du_rate, dF_rate);
         du += share_change * du_rate;
         dF += share_change * dF_rate;
         loads += share_change * s.piece(k);
      }
      // 6. Conjugates, loss and wear follow from displacements and forces.
      x.displacements.col(k) = du;
      x.forces.col(k) = dF;
      x.multipliers.col(k) = loads;
      result.conjugates.col(k) = s.conjugates_by_stiffness(k) * x.by.stiffness +
                                 s.acts.cwiseProduct(s.F.transpose() * du);
      if (s.problem.knows_loads()) { result.conjugates.col(k) += s.problem.H * loads; }
      const auto sum_of = [k](MatrixXd &sums)
      {
         return [&sums, k](Index i) -> Visitor
         {
            double &sum = sums(i, k);
            return [&sum](double &variable, double by) { sum += by * variable; };
         };
      };
      s.visit_loss(k, VectorXd::Ones(n), x, sum_of(result.loss));
      s.visit_worn(k, VectorXd::Ones(n), x, sum_of(result.worn));
   }
   result.displacements = std::move(x.displacements);
   result.forces = std::move(x.forces);
   result.multipliers = std::move(x.multipliers);
   result.trace = s.trace.number;
   result.found = true;
   return result;
}

Gradient Sensitivity::gradient(const Response &response, const Monitor &monitor)
{
   System &s = *system_;
   const Index n = s.n, m = s.m, count = s.F.cols(),
               states = static_cast<Index>(s.trace.states.size());
   Gradient result;
   Variables x{{VectorXd::Zero(n), VectorXd::Zero(n),
                MatrixXd::Zero(count, s.trace.history.times.size()),
                VectorXd::Zero(static_cast<Index>(s.stiffness.size())),
                VectorXd::Zero(s.wears() ? n : 0)},
               MatrixXd::Zero(m + n, states),
               MatrixXd::Zero(m + n, states),
               MatrixXd::Zero(count, states)};
   Parameters &by = x.by;
   MatrixXd &by_u = x.displacements, &by_F = x.forces, &by_loads = x.multipliers;
   const auto weighted = [](const VectorXd &weights)
   {
      return [&weights](Index i) -> Visitor
      {
         return [weight = weights[i]](double &variable, double derivative)
         { variable += weight * derivative; };
      };
   };
   require(response.trace == 0 || s.trace.number == 0 || response.trace == s.trace.number,
           "sensitivity: the response belongs to another trace, must belong to this one");
   // The response is a function of states. Express its derivatives by displacements, forces and
   // multipliers of each state.
   for (const auto &[k, weight] : response.weights)
   {
      const auto size = [&](const VectorXd &x, Index expected)
      {
         require(x.size() == 0 || x.size() == expected, "sensitivity: a response has ",
                 x.size(), " weights for a state, must have ", expected);
         return x.size() > 0;
      };
      const auto column = static_cast<Index>(k);
      require(column < states, "sensitivity: a response depends on state ", k,
              ", must depend on states below ", states, ", the number of states of the trace");
      if (size(weight.displacements, m + n)) { by_u.col(column) += weight.displacements; }
      if (size(weight.forces, m + n)) { by_F.col(column) += weight.forces; }
      if (size(weight.multipliers, count)) { by_loads.col(column) += weight.multipliers; }
      if (size(weight.loss, m > 0 ? n : 0) && k > 0)
      {
         s.visit_loss(k, weight.loss, x, weighted(weight.loss));
      }
      require(weight.worn.size() == 0 || s.wears(),
              "sensitivity: the response depends on wear, but the trace was recorded without a "
              "wear law");
      if (size(weight.worn, n) && k > 0)
      {
         s.visit_worn(k, weight.worn, x, weighted(weight.worn));
      }
      if (!size(weight.conjugates, count)) { continue; }
      const VectorXd acting = s.acts.cwiseProduct(weight.conjugates);
      by_u.col(column) += s.F * acting;
      if (s.problem.knows_loads())
      {
         by_loads.col(column) += s.problem.H.transpose() * weight.conjugates;
      }
      if (k > 0)
      {
         by.stiffness += s.conjugates_by_stiffness(k).transpose() * weight.conjugates;
      }
   }
   // Then go back through the states. Each passes its derivatives on to the parameters and to
   // the state before.
   double by_share = 0; // derivative by the load of an event, from later states at that load
   VectorXd by_worn = VectorXd::Zero(n); // by wear that was added to the gap of later states
   ProgressReport progress(monitor);
   for (Index k = states - 1; k > 0; --k)
   {
      if (stopped(monitor, progress, states - 1 - k, states - 1, result.message))
      {
         return result;
      }
      const TracedState &traced = s.trace.states[k];
      const ContactState &now = traced.state;
      // 1. Wear of this increment acts on later states through their gap.
      if (s.wears() && s.updates_gap_after(k)) { by_worn = by.gap; }
      s.visit_worn(k, by_worn, x, weighted(by_worn));
      // 2. Nothing to do if nothing depends on this state.
      if (by_share == 0 && by_u.col(k).isZero(0) && by_F.col(k).isZero(0) &&
          by_loads.col(k).isZero(0))
      {
         continue;
      }
      if (!s.set(k))
      {
         result.message = s.message;
         return result;
      }
      // 3. The motion of a body that the states leave free is not determined, so there is no
      // derivative of what depends on it. A load that would push such a body without friction
      // has none either.
      if (s.pushes(by_u.col(k)))
      {
         std::ostringstream message;
         message << "it depends on the motion of a body that is free to move at time "
                 << now.time;
         result.message = message.str();
         return result;
      }
      for (Index j = 0; s.frictionless && j < count; ++j)
      {
         if (s.pushes(s.F.col(j))) { by.multipliers.row(j).setConstant(std::nan("")); }
      }
      if (s.frictionless && s.free.cols() > 0) { by.friction.setConstant(std::nan("")); }
      // 4. The transposed equations, and at an event the transpose of step 5 of along().
      System::Adjoint at = s.go_back(k, by_u.col(k), by_F.col(k));
      if (traced.event < 0) { by_share = 0; }
      else
      {
         const System::Boundary boundary = s.boundary(k);
         const System::Adjoint met = s.go_back(k, boundary.displacements, boundary.forces);
         const double rate = s.approach(k, met);
         by_share += (s.F.transpose() * at.clamped + by_loads.col(k)).dot(s.piece(k));
         if (rate != 0)
         {
            const double moved = -by_share / rate;
            at.equations += moved * met.equations;
            at.clamped += moved * met.clamped;
            at.imposed += moved * met.imposed;
            by.gap[traced.event] += moved * boundary.gap;
            by.friction[traced.event] += moved * boundary.friction;
         }
         if (rate != 0 || !s.goes_with_the_last(k)) { by_share = 0; }
      }
      // 5. Derivatives by the parameters, and by the slip of the state before where nodes
      // stick.
      const VectorXd by_load = s.F.transpose() * at.clamped + by_loads.col(k);
      by.multipliers.col(traced.point) += (1 - traced.share) * by_load;
      by.multipliers.col(traced.point + 1) += traced.share * by_load;
      by.gap -= at.imposed.tail(n);
      by_u.col(k - 1).head(m) += at.imposed.head(m);
      if (m > 0)
      {
         by.friction += s.equations_by_friction(k).cwiseProduct(at.equations.head(n));
      }
      by.stiffness += s.clamped_by_stiffness(k).transpose() * at.clamped;
   }
   result.by = std::move(by);
   result.found = true;
   return result;
}

} // namespace cattaneo
