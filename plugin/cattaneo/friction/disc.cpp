// Contact with two tangential components per node.

#include <algorithm>
#include <cattaneo/friction/disc.hpp>
#include <cattaneo/friction/methods.hpp>
#include <limits>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

void DiscEquations::begin()
{
   origin_ = {};
   factored_.clear();
   refines_ = false;
   anew_ = true;
   // Borders depend on earlier steps.
   if (open_rows_.bordered()) { rows_.clear(); }
}

/// The open nodes, where all forces are zero, leave a stiffness of the closed ones.
bool DiscEquations::eliminate_open(Increment &at)
{
   FrictionSystem &s = at.system;
   const bool anew = std::exchange(anew_, false);
   // B = 0: the gaps are found apart from the rest, and slip does not change the pressure.
   const Index components = s.problem.coupled ? 3 : 2;
   std::vector<RowState> rows(s.K.rows(), RowState::absent);
   for (Index i = 0; i < s.n; ++i)
   {
      const RowState state = closed(at.status[i]) ? RowState::closed : RowState::open;
      for (Index k = 0; k < components; ++k) { rows[s.t(i, k)] = state; }
   }
   if (rows_ == rows) { return !singular_; }
   origin_ = {};
   slipping_.clear();
   slips_.clear();
   singular_ = !open_rows_.eliminate(s.K, rows, anew, s.counters);
   rows_ = std::move(rows);
   return !singular_;
}

/// The nodes that slip, and the stiffness between them: {q; p} by {x}.
void DiscEquations::gather(const Increment &at)
{
   const FrictionSystem &s = at.system;
   std::vector<Index> slipping;
   for (Index i = 0; i < s.n; ++i)
   {
      if (slips(at.status[i])) { slipping.push_back(i); }
   }
   if (slipping == slipping_) { return; }
   slipping_ = slipping;
   std::vector<Index> rows;
   for (Index k = 0; k < (s.problem.coupled ? 3 : 2); ++k)
   {
      for (const Index i : slipping) { rows.push_back(s.t(i, k)); }
   }
   slips_.assign(rows.begin(), rows.begin() + 2 * static_cast<Index>(slipping.size()));
   of_slip_ = open_rows_.stiffness(rows, slips_);
}

/// Forces of the closed nodes if all nodes are at u and the open nodes then move until they
/// carry no force.
DiscEquations::Origin DiscEquations::origin_at(const Increment &at, const VectorXd &u) const
{
   return {u, open_rows_.origin(at.f + at.system.product->times(u))};
}

DiscEquations::Linearised DiscEquations::linearise(const Increment &at) const
{
   const auto count = static_cast<Index>(slipping_.size());
   const FrictionSystem &s = at.system;
   Linearised to{Eigen::Matrix2Xd(2, count), Eigen::Matrix2Xd(2, count),
                 Eigen::Matrix2Xd(2, count), VectorXd(count)};
   for (Index r = 0; r < count; ++r)
   {
      const Index i = slipping_[r];
      const DiscSlip &slip = at.direction[i];
      to.along.col(r) = slip.n;
      to.across.col(r) = (1 - slip.share) * slip.t();
      to.own.col(r) = slip.share * s.lone.kt[i] * slip.t();
      to.slope[r] = s.problem.coupled ? s.bound[i].slope(at.F[s.m(i)]) : 0.0;
   }
   return to;
}

/// Residuals of the equations of the slipping nodes at an origin: n·q - f p, then (1 - β) t·q +
/// β k t·x.
VectorXd DiscEquations::imbalance(const Increment &at, const Origin &from) const
{
   const FrictionSystem &s = at.system;
   const auto count = static_cast<Index>(slipping_.size());
   VectorXd off(2 * count);
   for (Index r = 0; r < count; ++r)
   {
      const Index i = slipping_[r];
      const DiscSlip &to = at.direction[i];
      const VectorXd &forces = from.open.forces;
      const Vector2d q(forces[s.t(i, 0)], forces[s.t(i, 1)]);
      const Vector2d slip = at.along(from.u, i) - at.along(at.start.v, i);
      // B = 0: slip does not change the pressure, which is known.
      const double p = s.problem.coupled ? forces[s.m(i)] : at.F[s.m(i)];
      // A bound with bends is replaced by the line of its piece at the present pressure.
      const FrictionBound line = s.bound[i].straight(std::max(at.F[s.m(i)], 0.0));
      off[r] = to.n.dot(q) - line.line(p);
      off[count + r] =
         (1 - to.share) * to.t().dot(q) + to.share * s.lone.kt[i] * to.t().dot(slip);
   }
   return off;
}

/// The matrix of the equations times x.
VectorXd DiscEquations::times(const Linearised &to, const VectorXd &x) const
{
   const auto count = static_cast<Index>(slipping_.size());
   const VectorXd q = of_slip_ * x;
   const auto first = q.head(count).array(), second = q.segment(count, count).array();
   VectorXd y(2 * count);
   y.head(count) = to.along.row(0).transpose().array() * first +
                   to.along.row(1).transpose().array() * second;
   if (q.size() > 2 * count) { y.head(count) -= to.slope.cwiseProduct(q.tail(count)); }
   y.tail(count) = to.across.row(0).transpose().array() * first +
                   to.across.row(1).transpose().array() * second +
                   to.own.row(0).transpose().array() * x.head(count).array() +
                   to.own.row(1).transpose().array() * x.tail(count).array();
   return y;
}

bool DiscEquations::factor(const Linearised &to)
{
   const auto count = static_cast<Index>(slipping_.size());
   const VectorXd along0 = to.along.row(0), along1 = to.along.row(1),
                  across0 = to.across.row(0), across1 = to.across.row(1);
   MatrixXd M(2 * count, 2 * count);
   for (Index column = 0; column < 2 * count; ++column)
   {
      const auto q = of_slip_.col(column);
      const auto first = q.head(count), second = q.segment(count, count);
      M.col(column).head(count) = along0.cwiseProduct(first) + along1.cwiseProduct(second);
      M.col(column).tail(count) = across0.cwiseProduct(first) + across1.cwiseProduct(second);
      if (q.size() > 2 * count)
      {
         M.col(column).head(count) -= to.slope.cwiseProduct(q.tail(count));
      }
   }
   M.bottomLeftCorner(count, count).diagonal() += to.own.row(0).transpose();
   M.bottomRightCorner(count, count).diagonal() += to.own.row(1).transpose();
   factored_ = slipping_;
   return factor_.compute(std::move(M));
}

/// Solves with the factor of an earlier step, in which some of the nodes may not have slipped:
/// these have their own two equations, and those that slip no longer do not move.
VectorXd DiscEquations::with_factor(const Linearised &to, const VectorXd &r) const
{
   const auto count = static_cast<Index>(slipping_.size()),
              known = static_cast<Index>(factored_.size());
   if (factored_ == slipping_)
   {
      VectorXd x = r;
      factor_.solve(x);
      return x;
   }
   VectorXd of_factor = VectorXd::Zero(2 * known), x(2 * count);
   std::vector<Index> slot(count, -1);
   for (Index k = 0; k < count; ++k)
   {
      const auto found = std::lower_bound(factored_.begin(), factored_.end(), slipping_[k]);
      if (found == factored_.end() || *found != slipping_[k]) { continue; }
      slot[k] = found - factored_.begin();
      of_factor[slot[k]] = r[k];
      of_factor[known + slot[k]] = r[count + k];
   }
   factor_.solve(of_factor);
   for (Index k = 0; k < count; ++k)
   {
      if (slot[k] >= 0)
      {
         x[k] = of_factor[slot[k]];
         x[count + k] = of_factor[known + slot[k]];
         continue;
      }
      Eigen::Matrix2d own;
      for (const Index c : {0, 1})
      {
         const auto q = of_slip_.col(c * count + k);
         const Vector2d force(q[k], q[count + k]);
         own(0, c) = to.along.col(k).dot(force) -
                     (q.size() > 2 * count ? to.slope[k] * q[2 * count + k] : 0.0);
         own(1, c) = to.across.col(k).dot(force) + to.own(c, k);
      }
      const double det = own.determinant();
      const Vector2d b(r[k], r[count + k]);
      x[k] = (own(1, 1) * b[0] - own(0, 1) * b[1]) / det;
      x[count + k] = (own(0, 0) * b[1] - own(1, 0) * b[0]) / det;
   }
   return x;
}

/// GMRES with the factor of an earlier step. False if it does not converge soon.
bool DiscEquations::iterate(const Linearised &to, const VectorXd &r, VectorXd &x) const
{
   // The solution needs no more accuracy than Newton's step itself, because the next step
   // corrects the rest.
   constexpr double enough = 1e-6;
   // A step of the iteration reads two matrices; a factorisation costs a hundred times as much.
   constexpr int most = 16;
   const double size = r.norm();
   if (size == 0)
   {
      x = r;
      return true;
   }
   MatrixXd V(r.size(), most + 1), Z(r.size(), most), H = MatrixXd::Zero(most + 1, most);
   VectorXd g = VectorXd::Unit(most + 1, 0) * size;
   std::vector<Eigen::JacobiRotation<double>> turned;
   V.col(0) = r / size;
   for (int k = 0; k < most; ++k)
   {
      // 1. One more direction, made orthogonal to all before.
      Z.col(k) = with_factor(to, V.col(k));
      VectorXd w = times(to, Z.col(k));
      if (!w.allFinite()) { return false; }
      H.col(k).head(k + 1) = V.leftCols(k + 1).transpose() * w;
      w -= V.leftCols(k + 1) * H.col(k).head(k + 1);
      H(k + 1, k) = w.norm();
      if (H(k + 1, k) > 0) { V.col(k + 1) = w / H(k + 1, k); }
      // 2. Rotations keep the small least squares triangular.
      for (int j = 0; j < k; ++j) { H.col(k).applyOnTheLeft(j, j + 1, turned[j].adjoint()); }
      Eigen::JacobiRotation<double> turn;
      turn.makeGivens(H(k, k), H(k + 1, k));
      turned.push_back(turn);
      H.col(k).applyOnTheLeft(k, k + 1, turn.adjoint());
      g.applyOnTheLeft(k, k + 1, turn.adjoint());
      // 3. The last entry after the rotations is the residual.
      if (std::abs(g[k + 1]) > enough * size) { continue; }
      if (H(k, k) == 0) { return false; }
      const VectorXd y =
         H.topLeftCorner(k + 1, k + 1).triangularView<Eigen::Upper>().solve(g.head(k + 1));
      x = Z.leftCols(k + 1) * y;
      return true;
   }
   return false;
}

/// Solves the equations for x, from a first guess there, with the right-hand side b.
bool DiscEquations::solve_slip(Increment &at, const Linearised &equations, const VectorXd &b,
                               VectorXd &x)
{
   // Few equations are factored at once, which is fast.
   constexpr Index few = 64;
   if (x.size() == 0) { return true; }
   if (x.size() > few && !factored_.empty())
   {
      VectorXd change;
      if (iterate(equations, b - times(equations, x), change))
      {
         x += change;
         return true;
      }
   }
   ++at.system.counters.dense_factorisations;
   if (!factor(equations))
   {
      factored_.clear();
      return false;
   }
   x = b;
   factor_.solve(x);
   return true;
}

bool DiscEquations::solve(Increment &at)
{
   FrictionSystem &s = at.system;
   // 1. Without coupling the gaps and pressures are known first.
   if (!s.problem.coupled && !solve_normal(at)) { return false; }
   // 2. The open nodes are eliminated.
   if (!eliminate_open(at)) { return false; }
   gather(at);
   // 3. Displacements are counted from a state without slip and with closed gaps. It stays the
   // same as long as the same nodes are open.
   if (origin_.u.size() == 0)
   {
      VectorXd u = at.u;
      for (Index i = 0; i < s.n; ++i)
      {
         for (Index k = 0; k < 2; ++k) { u[s.t(i, k)] = at.start.v[s.t(i, k)]; }
         if (s.problem.coupled) { u[s.m(i)] = closed(at.status[i]) ? -s.problem.gap[i] : 0.0; }
      }
      origin_ = origin_at(at, u);
   }
   const Linearised equations = linearise(at);
   for (bool again = false;; again = true)
   {
      // 4. The slip that solves the equations …
      const Origin from = again ? origin_at(at, at.u) : origin_;
      VectorXd x = from.u(slips_) - at.u(slips_);
      if (!solve_slip(at, equations, imbalance(at, from), x)) { return false; }
      at.u = from.u;
      at.u(slips_) -= x;
      // 5. … and the displacements of the open nodes that follow.
      open_rows_.follow(from.open, slips_, -x, at.u);
      // 6. Solve once more from there, if refinement is on, or if the round-off of the origin
      // is a large part of the result.
      if (again || !(refines_ || cancels(s.K.diagonal(), from.u, at.u))) { break; }
   }
   at.F = at.f + s.product->times(at.u);
   return true;
}

namespace
{

/// How many nodes changed their state, and how many of these opened or closed.
struct Changes
{
   Index states = 0, contacts = 0;
};

/// Takes the states in which the natural map has the nodes, and their directions of slip. A
/// node that closes starts with slip if it has moved along the surface. If it stuck first,
/// Newton's steps would repeat themselves.
Changes take_natural_states(Increment &at)
{
   const FrictionSystem &s = at.system;
   // Violations that are too small to change a state.
   const VectorXd tiny =
      (0.5 * at.round_off()).cwiseMax(0.1 * s.settings.tolerance * at.reference);
   Changes changed;
   for (Index i = 0; i < s.n; ++i)
   {
      const ContactNode node = at.node(i);
      const NodeState now = at.status[i];
      const double apart = node.kn * node.gap - node.p, along = at.round_off_along(tiny, i);
      NodeState next = NodeState::separation;
      if (closed(now) ? apart <= tiny[s.m(i)] : apart < -tiny[s.m(i)])
      {
         next = friction_state(node, slips(now) ? -along : along);
      }
      if (next == NodeState::slip)
      {
         at.direction[i] = DiscSlip(node.trial(), node.bound.at(node.p));
      }
      changed.states += next != now;
      changed.contacts += closed(next) != closed(now);
      at.status[i] = next;
   }
   return changed;
}

} // namespace

bool newton_in_the_disc(Increment &at)
{
   at.system.disc_equations.begin();
   take_natural_states(at);
   Increment::Place best;
   double least = std::numeric_limits<double>::infinity(), before = least;
   constexpr int enough = 8;
   int patience = enough;
   Index fewest = at.system.n;
   for (int k = 0; k < at.system.settings.max_newton && patience > 0; ++k)
   {
      // 1. The linear equations of the present states and directions.
      if (!solve_for_states(at)) { break; }
      const bool small = at.residuals();
      const double size = std::max(at.report.residual_normal, at.report.residual_tangential);
      if (size < least)
      {
         least = size;
         best = {at.u, at.status};
      }
      // 2. Their solution is the end if its states are the same.
      const Changes changed = take_natural_states(at);
      const bool same = changed.states == 0;
      if (same && small && at.ends_here()) { return true; }
      // 3. The steps end if for some time neither the residual has fallen nor fewer nodes have
      // opened or closed. Where contact recedes over many nodes the residual falls only at the
      // end. If the states do not change, the solution is the same, and more steps can only
      // refine it.
      const bool fewer = changed.contacts > 0 && changed.contacts < fewest;
      fewest = std::min(fewest, changed.contacts);
      if (size < 0.5 * before || fewer)
      {
         before = size < 0.5 * before ? size : before;
         patience = enough;
         continue;
      }
      --patience;
      if (same) { at.system.disc_equations.refine(); }
   }
   // 4. If round-off is as large as the tolerance, it changes states at every step. Then the
   // best displacements of all steps are checked with a tolerance of the size of round-off.
   if (best.status.empty()) { return false; }
   at.move_to(best.u, best.status);
   return at.ends_here();
}

} // namespace cattaneo
