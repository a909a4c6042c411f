#include <algorithm>
#include <atomic>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/friction/changing_nodes.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// With fewer nodes it is as fast to use all of them.
constexpr Index least_nodes = 24;

/// Rows of K of these nodes, one component after the other.
std::vector<Index> rows_of_nodes(const ReducedProblem &problem, const std::vector<Index> &nodes)
{
   std::vector<Index> rows;
   for (Index k = 0; k <= problem.components(); ++k)
   {
      for (const Index i : nodes) { rows.push_back(k * problem.nodes() + i); }
   }
   return rows;
}

/// Forces {q; p} of each pattern, a column each.
MatrixXd forces_of_patterns(const ReducedProblem &problem)
{
   MatrixXd forces(problem.K.rows(), problem.patterns.size());
   for (Index k = 0; k < forces.cols(); ++k)
   {
      forces.col(k) << problem.patterns[k].q, problem.patterns[k].p;
   }
   return forces;
}

/// How far a closed node with these forces is from the limits of its state: of the pressure
/// and of the reserve of friction the smaller one. Negative beyond.
double left_of_stick(const ReducedProblem &problem, const VectorXd &forces, Index i)
{
   const Index n = problem.nodes();
   const double p = forces[problem.slips() + i];
   double q = std::abs(forces[i]);
   if (problem.components() == 2) { q = std::hypot(q, forces[n + i]); }
   return std::min(p, problem.friction[i] * p - q);
}

} // namespace

/// The problem of the nodes that are kept.
struct ChangingNodes::Part
{
   Part(const ReducedProblem &all, const FrictionSettings &settings,
        const std::vector<bool> &keeps, const std::vector<NodeState> &status);

   /// Do the nodes that are left out have the states with which they were left out?
   bool fits(const std::vector<NodeState> &status) const;
   /// The kept nodes' part of a state from which marches begin.
   ContactState set_out(const ContactState &state, const SymmetricProduct &times_K);
   /// The state of all nodes that belongs to a state of the kept ones.
   ContactState all_of(const ContactState &part) const;
   /// Nodes that are left out although they would change their states.
   std::vector<Index> wrong(const ContactState &state) const;
   /// The history of the part's loads.
   LoadHistory loads(const LoadHistory &history) const;

   const ReducedProblem &all;
   std::vector<Index> nodes, stuck, open;          // numbers among all nodes
   std::vector<Index> rows, stuck_rows, open_rows; // of their entries in K
   std::shared_ptr<ReducedProblem> problem;        // its last load holds what does not change
   std::optional<FrictionSolver> solver;           // none: the open nodes are not held
   MatrixXd follows;  // {u of open_rows; F of stuck_rows} by {u of rows; multipliers}
   ContactState from; // of all nodes, from which the march began
   VectorXd from_u;   // displacements of `rows` there
};

ChangingNodes::Part::Part(const ReducedProblem &whole, const FrictionSettings &settings,
                          const std::vector<bool> &keeps, const std::vector<NodeState> &status)
   : all(whole), problem(std::make_shared<ReducedProblem>())
{
   // 1. The three kinds of nodes.
   for (Index i = 0; i < all.nodes(); ++i)
   {
      (keeps[i] ? nodes : closed(status[i]) ? stuck : open).push_back(i);
   }
   rows = rows_of_nodes(all, nodes);
   stuck_rows = rows_of_nodes(all, stuck);
   open_rows = rows_of_nodes(all, open);
   const auto kept = static_cast<Index>(rows.size()),
              held = static_cast<Index>(stuck_rows.size()),
              free = static_cast<Index>(open_rows.size()),
              loads = static_cast<Index>(all.patterns.size());
   // 2. The open nodes are eliminated: Y = L⁻¹ [K(open, kept), K(open, stuck), F(open)].
   const MatrixXd forces = forces_of_patterns(all);
   ReducedProblem &part = *problem;
   part.K = all.K(rows, rows);
   MatrixXd F = forces(rows, Eigen::all), H = all.H;
   follows.resize(free + held, kept + loads);
   follows.bottomRows(held) << all.K(stuck_rows, rows), forces(stuck_rows, Eigen::all);
   if (free > 0)
   {
      DenseCholesky factor;
      if (!factor.compute(all.K(open_rows, open_rows))) { return; }
      MatrixXd Y(free, kept + loads + held);
      Y << all.K(open_rows, rows), forces(open_rows, Eigen::all), all.K(open_rows, stuck_rows);
      factor.solve_half(Y);
      const auto of_kept = Y.leftCols(kept), of_loads = Y.middleCols(kept, loads);
      part.K = minus_square(std::move(part.K), of_kept);
      subtract_product(F, of_kept, of_loads);
      MatrixXd on_stuck = follows.bottomRows(held);
      subtract_product(on_stuck, Y.rightCols(held), Y.leftCols(kept + loads));
      follows.bottomRows(held) = on_stuck;
      const MatrixXd by_loads = transposed_product(of_loads, of_loads);
      for (Index k = 0; k < loads; ++k)
      {
         const double sign = all.patterns[k].control == Control::force ? 1 : -1;
         H.row(k) += sign * by_loads.row(k);
      }
      MatrixXd moved = -Y.leftCols(kept + loads);
      factor.solve_other_half(moved);
      follows.topRows(free) = moved;
   }
   // 3. The problem of the kept nodes.
   part.gap = all.gap(nodes);
   part.friction = all.friction(nodes);
   if (all.weights.size() > 0) { part.weights = all.weights(nodes); }
   for (const Index row : all.held)
   {
      const auto found = std::find(rows.begin(), rows.end(), row);
      if (found != rows.end()) { part.held.push_back(found - rows.begin()); }
   }
   part.rigid_motions.resize(kept, 0);
   if (!all.coupled) { part.B().setZero(); }
   join_coupling(part);
   std::string name = "held";
   for (Index k = 0; k < loads; ++k)
   {
      const LoadPattern &pattern = all.patterns[k];
      part.patterns.push_back({pattern.name, pattern.control, F.col(k).head(part.slips()),
                               F.col(k).tail(part.nodes())});
      name += pattern.name; // another name than that of any load
   }
   part.patterns.push_back(
      {name, Control::force, VectorXd::Zero(part.slips()), VectorXd::Zero(part.nodes())});
   part.H = MatrixXd::Zero(loads + 1, loads + 1);
   part.H.topLeftCorner(loads, loads) = H;
   solver.emplace(problem, settings);
}

bool ChangingNodes::Part::fits(const std::vector<NodeState> &status) const
{
   return std::all_of(open.begin(), open.end(), [&](Index i) { return !closed(status[i]); }) &&
          std::all_of(stuck.begin(), stuck.end(),
                      [&](Index i) { return status[i] == NodeState::stick; });
}

ContactState ChangingNodes::Part::set_out(const ContactState &state,
                                          const SymmetricProduct &times_K)
{
   // 1. The state, with the forces of the stuck nodes that follow from all displacements.
   const VectorXd u = state.displacements(),
                  forces = times_K(u) + all.clamped_forces(state.multipliers);
   from = state;
   from.cycle.reset();
   from.cycle_slip.clear();
   for (const Index row : stuck_rows)
   {
      (row < all.slips() ? from.q[row] : from.p[row - all.slips()]) = forces[row];
   }
   for (const Index row : all.held) { from.q[row] = 0; }
   from_u = u(rows);
   // 2. Its part.
   ReducedProblem &of = *problem;
   const Index slips = of.slips(), loads = state.multipliers.size();
   const std::vector<Index> slip_rows(rows.begin(), rows.begin() + slips);
   ContactState part;
   part.v = state.v(slip_rows);
   part.q = state.q(slip_rows);
   part.slip_origin = state.slip_origin(slip_rows);
   part.w = state.w(nodes);
   part.p = state.p(nodes);
   for (const Index i : nodes) { part.status.push_back(state.status[i]); }
   part.multipliers.resize(loads + 1);
   part.multipliers << state.multipliers, 0;
   part.time = state.time;
   part.peak_force = state.peak_force;
   // 3. The load that holds what does not change: forces that the displacements of the stuck
   // nodes cause, and round-off.
   VectorXd held = forces(rows) - of.K * from_u - of.clamped_forces(part.multipliers);
   for (const Index row : of.held) { held[row] = 0; }
   of.patterns.back().q = held.head(slips);
   of.patterns.back().p = held.tail(of.nodes());
   // 4. Likewise the conjugates.
   of.H.row(loads).setZero();
   of.H.col(loads).setZero();
   const VectorXd conjugate = conjugates(all, state),
                  of_part = conjugates(of, part).head(loads);
   for (Index k = 0; k < loads; ++k)
   {
      of.H(k, loads) = conjugate[k] - of_part[k];
      of.H(loads, k) =
         all.patterns[k].control == Control::force ? of.H(k, loads) : -of.H(k, loads);
   }
   part.multipliers[loads] = 1;
   return part;
}

ContactState ChangingNodes::Part::all_of(const ContactState &part) const
{
   const Index loads = from.multipliers.size(), slips = all.slips();
   ContactState next = from;
   next.time = part.time;
   next.step = part.step;
   next.multipliers = part.multipliers.head(loads);
   next.peak_force = std::max(from.peak_force, part.peak_force);
   next.dissipation = from.dissipation + part.dissipation;
   // 1. What the nodes that are left out do.
   const VectorXd u = part.displacements(), F = part.forces();
   VectorXd change(follows.cols());
   change << u - from_u, next.multipliers - from.multipliers;
   const VectorXd other = product(follows, change);
   const auto put = [&](VectorXd &tangential, VectorXd &normal, Index row, double value)
   { (row < slips ? tangential[row] : normal[row - slips]) = value; };
   const auto free = static_cast<Index>(open_rows.size());
   for (Index k = 0; k < free; ++k)
   {
      const Index row = open_rows[k];
      (row < slips ? next.v[row] : next.w[row - slips]) += other[k];
   }
   for (std::size_t k = 0; k < stuck_rows.size(); ++k)
   {
      const Index row = stuck_rows[k];
      (row < slips ? next.q[row] : next.p[row - slips]) += other[free + static_cast<Index>(k)];
   }
   for (const Index row : all.held) { next.v[row] = next.q[row] = 0; }
   next.slip_origin = next.v; // of the nodes that do not slip
   // 2. What the kept nodes do.
   for (std::size_t k = 0; k < rows.size(); ++k)
   {
      const auto at = static_cast<Index>(k);
      put(next.v, next.w, rows[k], u[at]);
      put(next.q, next.p, rows[k], F[at]);
      if (at < part.slip_origin.size()) { next.slip_origin[rows[k]] = part.slip_origin[at]; }
   }
   for (std::size_t k = 0; k < nodes.size(); ++k) { next.status[nodes[k]] = part.status[k]; }
   return next;
}

std::vector<Index> ChangingNodes::Part::wrong(const ContactState &state) const
{
   // No more than the solver allows at the nodes that it has.
   const double allowed = solver->settings().tolerance * state.peak_force;
   const VectorXd forces = state.forces();
   std::vector<Index> found;
   for (const Index i : stuck)
   {
      if (!(left_of_stick(all, forces, i) >= -allowed)) { found.push_back(i); }
   }
   for (const Index i : open)
   {
      if (!(all.C()(i, i) * (state.w[i] + all.gap[i]) >= -allowed)) { found.push_back(i); }
   }
   return found;
}

LoadHistory ChangingNodes::Part::loads(const LoadHistory &history) const
{
   LoadHistory made = history;
   const Index loads = history.multipliers.rows();
   made.multipliers.conservativeResize(loads + 1, Eigen::NoChange);
   made.multipliers.row(loads).setOnes();
   return made;
}

ChangingNodes::ChangingNodes(FrictionSolver &solver)
   : solver_(solver), problem_(solver.problem()),
     // The states of a bound that bends, and of a contact that advances along a chain, depend
     // on more than the nodes that are kept.
     worthwhile_(problem_.nodes() >= least_nodes && problem_.laws.empty() &&
                 !solver.frictionless() && problem_.knows_loads() &&
                 (problem_.components() == 1 || problem_.chains.empty()) &&
                 solver.settings().method != FrictionMethod::gauss_seidel),
     times_K_(problem_.K)
{
}

ChangingNodes::~ChangingNodes() = default;

Index ChangingNodes::kept() const
{
   return part_ ? static_cast<Index>(part_->nodes.size()) : problem_.nodes();
}

/// Do nodes that stick hold all bodies?
bool ChangingNodes::holds(const std::vector<Index> &stuck) const
{
   constexpr double well = 1e-6; // square of the share of a motion that these nodes have
   const MatrixXd &Z = problem_.rigid_motions;
   if (Z.cols() == 0) { return true; }
   const MatrixXd there = Z(rows_of_nodes(problem_, stuck), Eigen::all);
   return there.rows() >= Z.cols() &&
          symmetric_eigenvalues(transposed_product(there, there)).minCoeff() > well;
}

/// The nodes that may change their states if the loads change so (a column for each point of
/// the way), by the response with closed nodes glued. Empty: it is not known.
std::vector<bool> ChangingNodes::guess(const MatrixXd &changes, const ContactState &state) const
{
   // 1. Changes of the gaps of open nodes, and of the forces of the closed ones.
   std::vector<Index> open, shut;
   for (Index i = 0; i < problem_.nodes(); ++i)
   {
      (closed(state.status[i]) ? shut : open).push_back(i);
   }
   const std::vector<Index> open_rows = rows_of_nodes(problem_, open),
                            shut_rows = rows_of_nodes(problem_, shut);
   const MatrixXd forces = product(forces_of_patterns(problem_), stretch_ * changes);
   MatrixXd moved = forces(open_rows, Eigen::all);
   if (!open.empty())
   {
      DenseCholesky factor;
      if (!factor.compute(problem_.K(open_rows, open_rows))) { return {}; }
      moved = -factor.solved(std::move(moved));
   }
   MatrixXd loaded = forces(shut_rows, Eigen::all);
   if (!open.empty()) { loaded += product(problem_.K(shut_rows, open_rows), moved); }
   // 2. Nodes that are near the limit of their state at one of the points, or now.
   const double near = 1e-6 * state.p.cwiseAbs().maxCoeff();
   const Index m = problem_.slips();
   std::vector<bool> found(problem_.nodes());
   for (const Index i : shut)
   {
      found[i] = state.status[i] != NodeState::stick || !(problem_.friction[i] > 0);
   }
   const VectorXd u = state.displacements(), F = state.forces();
   for (Index k = -1; k < changes.cols(); ++k)
   {
      VectorXd u_there = u, F_there = F;
      for (std::size_t r = 0; k >= 0 && r < open_rows.size(); ++r)
      {
         u_there[open_rows[r]] += moved(static_cast<Index>(r), k);
      }
      for (std::size_t r = 0; k >= 0 && r < shut_rows.size(); ++r)
      {
         F_there[shut_rows[r]] += loaded(static_cast<Index>(r), k);
      }
      for (const Index i : shut)
      {
         found[i] = found[i] || left_of_stick(problem_, F_there, i) <= near;
      }
      for (const Index i : open)
      {
         const double gap = u_there[m + i] + problem_.gap[i];
         found[i] = found[i] || problem_.C()(i, i) * gap <= near;
      }
   }
   return found;
}

/// A march begins at a state.
void ChangingNodes::Watch::begin(const ReducedProblem &problem, const ContactState &state)
{
   cycles = false;
   status = state.status;
   changes.assign(problem.nodes(), false);
   least = VectorXd::Constant(problem.nodes(), std::numeric_limits<double>::infinity());
   most = VectorXd::Zero(problem.nodes());
   look(problem, state);
}

void ChangingNodes::Watch::look(const ReducedProblem &problem, const ContactState &state)
{
   const VectorXd forces = state.forces();
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      if (slips(state.status[i]) || state.status[i] != status[i]) { changes[i] = true; }
      if (changes[i]) { continue; }
      const double left = closed(status[i]) ? left_of_stick(problem, forces, i)
                                            : problem.C()(i, i) * (state.w[i] + problem.gap[i]);
      least[i] = std::min(least[i], left);
      most[i] = std::max(most[i], left);
   }
}

/// Nodes that changed their states, or came near to that.
std::vector<bool> ChangingNodes::Watch::found() const
{
   constexpr double near = 0.05;
   std::vector<bool> nodes = changes;
   for (std::size_t i = 0; i < nodes.size(); ++i)
   {
      const auto at = static_cast<Index>(i);
      nodes[i] = nodes[i] || !(least[at] > near * most[at]);
   }
   return nodes;
}

/// Chooses the nodes for a march. False if all nodes are needed.
bool ChangingNodes::choose(const LoadHistory &history, const ContactState &state)
{
   MatrixXd changes = history.multipliers;
   changes.colwise() -= state.multipliers;
   const double swing =
      (changes.rowwise().maxCoeff().cwiseMax(0.0) - changes.rowwise().minCoeff().cwiseMin(0.0))
         .maxCoeff();
   const bool same = swing <= swing_ * (1 + 1e-9);
   const auto count = [](const std::vector<bool> &nodes)
   { return std::count(nodes.begin(), nodes.end(), true); };
   // 1. For the same range, nodes that have changed in the cycles before, if they are much
   // fewer than the present ones, and those that had to join.
   if (!same) { joined_.clear(); }
   std::vector<bool> keeps;
   if (same && watch_.cycles)
   {
      keeps = watch_.found();
      for (const Index i : joined_) { keeps[i] = true; }
      if (4 * count(keeps) > 3 * kept()) { keeps.clear(); }
   }
   if (part_ && same && keeps.empty())
   {
      if (!joins_ && part_->fits(state.status)) { return true; }
      keeps.assign(problem_.nodes(), false);
      for (const Index i : part_->nodes) { keeps[i] = true; }
      for (const Index i : joined_) { keeps[i] = true; }
   }
   // 2. Otherwise a guess.
   if (keeps.empty()) { keeps = guess(changes, state); }
   if (keeps.empty()) { return false; }
   for (std::size_t i = 0; i < keeps.size(); ++i)
   {
      if (slips(state.status[i])) { keeps[i] = true; }
   }
   // 3. Their problem.
   joins_ = false;
   swing_ = std::max(swing, same ? swing_ : 0.0);
   part_.reset();
   if (count(keeps) == 0) { keeps[0] = true; }
   std::vector<Index> stuck;
   for (Index i = 0; i < problem_.nodes(); ++i)
   {
      if (!keeps[i] && closed(state.status[i])) { stuck.push_back(i); }
   }
   if (4 * count(keeps) > 3 * problem_.nodes() || !holds(stuck)) { return false; }
   part_ = std::make_unique<Part>(problem_, solver_.settings(), keeps, state.status);
   if (!part_->solver) { part_.reset(); }
   return part_ != nullptr;
}

MarchReport ChangingNodes::march(const LoadHistory &history, ContactState &state,
                                 const MarchSettings &settings, const MarchObserver &observer)
{
   repeats_ = false;
   if (!worthwhile_) { return cattaneo::march(solver_, history, state, settings, observer); }
   const bool all = std::exchange(all_, false) || !choose(history, state);
   watch_.begin(problem_, state);
   if (all)
   {
      MarchReport report =
         cattaneo::march(solver_, history, state, settings,
                         [&](const ContactState &now, const IncrementRecord &record)
                         {
                            watch_.look(problem_, now);
                            observer(now, record);
                         });
      watch_.cycles = !report.cycles.empty();
      return report;
   }
   // 1. The march of the nodes that are kept. It stops where one that was left out would change
   // its state.
   ContactState part = part_->set_out(state, times_K_), last = state;
   const auto loads = state.multipliers.size();
   std::atomic<bool> stop{settings.monitor.stopped()};
   MarchSettings own = settings;
   own.monitor.stop = &stop;
   MarchReport report =
      cattaneo::march(*part_->solver, part_->loads(history), part, own,
                      [&](const ContactState &now, const IncrementRecord &found)
                      {
                         if (repeats_) { return; }
                         last = part_->all_of(now);
                         const std::vector<Index> wrong = part_->wrong(last);
                         if (!wrong.empty())
                         {
                            joined_.insert(joined_.end(), wrong.begin(), wrong.end());
                            joins_ = repeats_ = stop = true;
                            stretch_ *= 1.25;
                            return;
                         }
                         IncrementRecord record = found;
                         record.multipliers.conservativeResize(loads);
                         record.conjugates.conservativeResize(loads);
                         watch_.look(problem_, last);
                         observer(last, record);
                         if (settings.monitor.stopped()) { stop = true; }
                      });
   if (repeats_) { return report; }
   // 2. Outcomes other than equilibria are left to all nodes, and the last state is judged with
   // all nodes.
   const bool smooth =
      report.status == FrictionStatus::converged || report.status == FrictionStatus::stopped;
   const FrictionStatus judged = solver_.judge(last, last).status;
   if (!smooth || report.fallbacks > 0 || judged != FrictionStatus::converged)
   {
      repeats_ = all_ = true;
      // Critical friction is a property of all nodes.
      if (report.not_unique || judged == FrictionStatus::not_unique) { worthwhile_ = false; }
      return report;
   }
   // 3. Results of all nodes.
   watch_.cycles = !report.cycles.empty();
   state = std::move(last);
   for (CycleRecord &cycle : report.cycles)
   {
      VectorXd lost = VectorXd::Zero(problem_.nodes());
      lost(part_->nodes) = cycle.node_dissipation;
      cycle.node_dissipation = std::move(lost);
   }
   if (report.event_multipliers.size() > loads)
   {
      report.event_multipliers.conservativeResize(loads);
   }
   return report;
}

} // namespace cattaneo
