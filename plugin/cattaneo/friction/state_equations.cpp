#include <algorithm>
#include <cattaneo/friction/state_equations.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// If the corner of the borders is closer to singular than this, M₀ is factored anew.
constexpr double least_corner = 1e-9;

} // namespace

StateEquations::StateEquations(const Eigen::Ref<const MatrixXd> &K,
                               std::vector<FrictionBound> bound)
   : K_(K), times_K_(K), bound_(std::move(bound)), n_(static_cast<Index>(bound_.size())),
     tangential_(K.rows() > n_), diagonal_(K.diagonal()), arithmetic_(K),
     states_(n_, NodeState::stick), pinned_(n_, false), constant_(VectorXd::Zero(K.rows())),
     slot_of_(K.rows(), -1), border_of_(K.rows(), -1)
{
}

const VectorXd &StateEquations::round_off(const VectorXd &b, const VectorXd &x) const
{
   const bool known = known_.x.size() == x.size() && known_.x == x && known_.b == b;
   if (!known) { known_ = {b, x, arithmetic_.rows(x.cwiseAbs(), b)}; }
   return known_.rows;
}

NodeState StateEquations::frictionless_contact(Index node, const VectorXd &x) const
{
   if (!tangential_) { return NodeState::stick; }
   return x[node] >= 0 ? NodeState::forward_slip : NodeState::backward_slip;
}

template <class Visitor>
void StateEquations::for_each_equation(Index node, Visitor visit) const
{
   const NodeState state = states_[node];
   if (tangential_ && state != NodeState::stick && !pinned_[node])
   {
      const double way = sense(state);
      visit(Equation{node, normal_row(node), way * bound_[node].slope(0, way)});
   }
   if (!closed(state)) { visit(Equation{normal_row(node), normal_row(node), 0.0}); }
}

/// M₀ of the present states. Nothing changes if it is singular.
bool StateEquations::factor()
{
   ++factorisations_;
   std::vector<Equation> slots;
   for (Index i = 0; i < n_; ++i)
   {
      for_each_equation(i, [&](const Equation &e) { slots.push_back(e); });
   }
   const auto m = static_cast<Index>(slots.size());
   MatrixXd M(m, m);
   for (Index c = 0; c < m; ++c)
   {
      const double *column = K_.col(slots[c].row).data();
      for (Index r = 0; r < m; ++r)
      {
         M(r, c) = column[slots[r].row] + slots[r].factor * column[slots[r].other];
      }
   }
   DenseLU lu;
   if (!lu.compute(std::move(M))) { return false; }
   lu_ = std::move(lu);
   slots_ = std::move(slots);
   std::fill(slot_of_.begin(), slot_of_.end(), -1);
   for (Index k = 0; k < m; ++k) { slot_of_[slots_[k].row] = k; }
   forget_borders();
   return true;
}

void StateEquations::forget_borders()
{
   borders_.clear();
   std::fill(border_of_.begin(), border_of_.end(), -1);
   active_.clear();
   corner_ = DenseLU();
}

/// Columns of P for these rows, solved together.
void StateEquations::add_columns(const std::vector<Index> &rows)
{
   const auto m = static_cast<Index>(slots_.size()),
              first = static_cast<Index>(borders_.size()),
              count = static_cast<Index>(rows.size()), size = first + count;
   if (W_.rows() != m || W_.cols() < size)
   {
      const Index capacity = std::max(size, std::min(K_.rows(), 2 * size));
      W_.conservativeResize(m, capacity);
      Q_.conservativeResize(m, capacity);
      products_.conservativeResize(capacity, capacity);
   }
   for (Index k = 0; k < count; ++k)
   {
      const Index row = rows[k], slot = slot_of_[row];
      border_of_[row] = first + k;
      borders_.push_back(
         {{row, row, 0.0}, false, slot >= 0, std::numeric_limits<double>::quiet_NaN()});
      auto P = W_.col(first + k);
      if (slot >= 0) // in units of displacement
      {
         P.setZero();
         P[slot] = diagonal_[row];
         continue;
      }
      const double *column = K_.col(row).data();
      for (Index r = 0; r < m; ++r)
      {
         P[r] = column[slots_[r].row] + slots_[r].factor * column[slots_[r].other];
      }
   }
   lu_.solve(W_.middleCols(first, count));
   updates_ += count;
   // D - Q M₀⁻¹ P of the present rows.
   for (Index a = 0; a < first; ++a)
   {
      const Border &border = borders_[a];
      if (std::isnan(border.made_for)) { continue; }
      for (Index b = first; b < size; ++b)
      {
         products_(a, b) = -Q_.col(a).dot(W_.col(b));
         if (borders_[b].in_factor) { continue; }
         const double *column = K_.col(borders_[b].now.row).data();
         products_(a, b) +=
            (column[border.now.row] + border.made_for * column[border.now.other]) /
            diagonal_[border.now.row];
      }
   }
}

/// The equation of a present border: its row of Q, and that of D - Q M₀⁻¹ P.
void StateEquations::set_equation(Index a, const Equation &now)
{
   const auto size = static_cast<Index>(borders_.size());
   Border &border = borders_[a];
   border.now = now;
   border.made_for = now.factor;
   const double *column = K_.col(now.row).data(), *other = K_.col(now.other).data(),
                unit = diagonal_[now.row]; // K is symmetric
   for (Index k = 0; k < static_cast<Index>(slots_.size()); ++k)
   {
      const Index at = slots_[k].row;
      Q_(k, a) = (column[at] + now.factor * other[at]) / unit;
   }
   products_.row(a).head(size).noalias() = -Q_.col(a).transpose() * W_.leftCols(size);
   for (Index b = 0; b < size; ++b)
   {
      if (borders_[b].in_factor) { continue; }
      const Index at = borders_[b].now.row;
      products_(a, b) += (column[at] + now.factor * other[at]) / unit;
   }
}

/// Writes the present states as borders of M₀. False if M₀ should rather be factored anew.
bool StateEquations::border()
{
   const auto m = static_cast<Index>(slots_.size());
   std::vector<Equation> now(K_.rows(), Equation{-1, -1, 0.0});
   for (Index i = 0; i < n_; ++i)
   {
      for_each_equation(i, [&](const Equation &e) { now[e.row] = e; });
   }
   std::vector<Index> rows, fresh;
   for (Index row = 0; row < K_.rows(); ++row)
   {
      const Index slot = slot_of_[row];
      const bool present = now[row].row >= 0;
      if (slot < 0 ? !present : (present && now[row].factor == slots_[slot].factor))
      {
         continue;
      }
      rows.push_back(row);
      if (border_of_[row] < 0) { fresh.push_back(row); }
   }
   // m² a border against m³/3.
   const auto most = static_cast<std::size_t>(std::max<Index>(16, m / 8));
   if (borders_.size() + fresh.size() > most) { return false; }
   if (!fresh.empty()) { add_columns(fresh); }
   active_.clear();
   for (Index row : rows)
   {
      const Index a = border_of_[row];
      active_.push_back(a);
      Border &border = borders_[a];
      border.present = now[row].row >= 0;
      if (!border.present || now[row].factor == border.made_for) { continue; }
      set_equation(a, now[row]);
   }
   const auto count = static_cast<Index>(active_.size());
   MatrixXd corner(count, count);
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      for (Index b = 0; b < count; ++b)
      {
         corner(a, b) = border.present ? products_(active_[a], active_[b])
                                       : -W_(slot_of_[border.now.row], active_[b]);
      }
   }
   return corner_.compute(std::move(corner)) && corner_.pivot_ratio() > least_corner;
}

/// True if M₀ is that of the present states.
bool StateEquations::is_factored() const
{
   std::size_t count = 0;
   bool same = true;
   for (Index i = 0; i < n_; ++i)
   {
      for_each_equation(i,
                        [&](const Equation &e)
                        {
                           const Index slot = slot_of_[e.row];
                           same = same && slot >= 0 && slots_[slot].factor == e.factor;
                           ++count;
                        });
   }
   return same && count == slots_.size();
}

bool StateEquations::adopt()
{
   for (Index i = 0; tangential_ && i < n_; ++i)
   {
      const double way = sense(states_[i]);
      constant_[i] = way * bound_[i].intercept(0, way);
   }
   if (!anew_) { return border() || factor(); }
   anew_ = false;
   forget_borders();
   return is_factored() || factor();
}

bool StateEquations::set(std::vector<NodeState> states, std::vector<bool> pinned)
{
   if (!anew_ && !bound_changed_ && states == states_ && pinned == pinned_) { return true; }
   bound_changed_ = false;
   states_.swap(states);
   pinned_.swap(pinned);
   if (adopt()) { return true; }
   states_.swap(states);
   pinned_.swap(pinned);
   adopt();
   return false;
}

bool StateEquations::set(Index node, NodeState state, bool pinned)
{
   std::vector<NodeState> states = states_;
   std::vector<bool> all_pinned = pinned_;
   states[node] = state;
   all_pinned[node] = pinned;
   return set(std::move(states), std::move(all_pinned));
}

bool StateEquations::set(const std::vector<NodeState> &states)
{
   return set(states, std::vector<bool>(n_, false));
}

VectorXd StateEquations::forces_again(const VectorXd &x)
{
   std::vector<Index> changed;
   for (Index row = 0; row < base_.size(); ++row)
   {
      if (x[row] != base_[row]) { changed.push_back(row); }
   }
   // This reads whole columns of K. A product with all of K reads one triangle, half of it, so
   // that columns pay only if few entries changed.
   const bool few = 4 * static_cast<Index>(changed.size()) <= base_.size();
   if (base_.size() == 0 || !few)
   {
      base_ = x;
      base_forces_ = times_K_(x);
      return base_forces_;
   }
   VectorXd F = base_forces_;
   for (const Index row : changed) { F += (x[row] - base_[row]) * K_.col(row); }
   return F;
}

/// Subtracts from x the displacements by the residual forces of the equations.
void StateEquations::step(const VectorXd &F, VectorXd &x) const
{
   const auto m = static_cast<Index>(slots_.size()), count = static_cast<Index>(active_.size());
   VectorXd y(m), z(count);
   for (Index k = 0; k < m; ++k) { y[k] = force(slots_[k], F); }
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      if (border.in_factor)
      {
         y[slot_of_[border.now.row]] = 0;
      } // the old equation no longer exists
   }
   lu_.solve(y);
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      z[a] = border.present
                ? force(border.now, F) / diagonal_[border.now.row] - Q_.col(active_[a]).dot(y)
                : -y[slot_of_[border.now.row]];
   }
   corner_.solve(z);
   for (Index a = 0; a < count; ++a) { y -= z[a] * W_.col(active_[a]); }
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      if (!border.in_factor) { x[border.now.row] -= z[a]; }
      else if (!border.present) { y[slot_of_[border.now.row]] = 0; }
   }
   for (Index k = 0; k < m; ++k) { x[slots_[k].row] -= y[k]; }
}

/// The transpose of step(), statement by statement from its end: adds the contribution of the
/// unknowns' g to y, the values of the equations.
void StateEquations::step_transposed(const VectorXd &g, VectorXd &y) const
{
   const auto m = static_cast<Index>(slots_.size()), count = static_cast<Index>(active_.size());
   VectorXd of_slots(m), z(count);
   for (Index k = 0; k < m; ++k) { of_slots[k] = g[slots_[k].row]; }
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      const Index row = border.now.row;
      if (border.in_factor && !border.present) { of_slots[slot_of_[row]] = 0; }
      z[a] = border.in_factor ? 0.0 : g[row];
   }
   for (Index a = 0; a < count; ++a) { z[a] -= W_.col(active_[a]).dot(of_slots); }
   corner_.solve_transposed(z);
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      const Index row = border.now.row;
      if (border.present)
      {
         y[row] += z[a] / diagonal_[row];
         of_slots -= z[a] * Q_.col(active_[a]);
      }
      else { of_slots[slot_of_[row]] -= z[a]; }
   }
   lu_.solve_transposed(of_slots);
   for (Index a = 0; a < count; ++a)
   {
      const Border &border = borders_[active_[a]];
      if (border.in_factor) { of_slots[slot_of_[border.now.row]] = 0; }
   }
   for (Index k = 0; k < m; ++k) { y[slots_[k].row] += of_slots[k]; }
}

void StateEquations::solve_transposed(const VectorXd &g, VectorXd &y, VectorXd &z) const
{
   const auto visit_all = [&](auto visit)
   {
      for (Index i = 0; i < n_; ++i) { for_each_equation(i, visit); }
   };
   const auto step = [&](const VectorXd &left)
   {
      step_transposed(left, y);
      z.setZero(K_.rows());
      visit_all(
         [&](const Equation &e)
         {
            z[e.row] += y[e.row];
            z[e.other] += e.factor * y[e.row];
         });
   };
   y.setZero(K_.rows());
   step(g);
   // Once more, with the residual of round-off.
   const VectorXd through = times_K_(z);
   VectorXd left = VectorXd::Zero(K_.rows());
   visit_all([&](const Equation &e) { left[e.row] = g[e.row] - through[e.row]; });
   step(left);
}

bool StateEquations::solve(const VectorXd &b, VectorXd &x, VectorXd &F)
{
   x.setZero(b.size());
   F = b;
   std::vector<Equation> equations;
   for (Index i = 0; i < n_; ++i)
   {
      for_each_equation(i, [&](const Equation &e) { equations.push_back(e); });
   }
   double before = std::numeric_limits<double>::infinity();
   bool fresh = active_.empty();
   while (true)
   {
      if (!F.allFinite()) { return false; }
      const VectorXd reachable = round_off(b, x);
      double largest = 0; // over the smallest that can be reached
      for (const Equation &e : equations)
      {
         // Numbers below the smallest normal double have no digits.
         const double left =
            std::max({reachable[e.row], std::abs(e.factor) * reachable[e.other],
                      std::numeric_limits<double>::min()});
         const double off = std::abs(force(e, F));
         if (off > 0) { largest = std::max(largest, off / left); }
      }
      if (largest <= 1) { return true; }
      if (!(largest <= 0.1 * before)) // refinement no longer helps
      {
         if (fresh || largest < 100) { return true; }
         fresh = true;
         if (!factor()) { return false; }
         x.setZero();
         F = b;
         before = std::numeric_limits<double>::infinity();
         continue;
      }
      before = largest;
      step(F, x);
      if (2 * static_cast<Index>(equations.size()) > K_.rows()) { F = b + times_K_(x); }
      else
      {
         F = b;
         for (const Equation &e : equations) { F.noalias() += x[e.row] * K_.col(e.row); }
      }
   }
}

} // namespace cattaneo
