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

constexpr double eps = std::numeric_limits<double>::epsilon();
/// A pivot this small against what it is the difference of is none.
constexpr double least_pivot = 1e-11;

} // namespace

StateEquations::StateEquations(const MatrixXd &K, const VectorXd &friction)
   : K_(K), friction_(friction), n_(friction.size()), tangential_(K.rows() > n_),
     diagonal_(K.diagonal()), norm_(K.cwiseAbs().colwise().sum().maxCoeff()),
     states_(n_, NodeState::stick), held_(n_, false), slot_of_(K.rows(), -1)
{
}

std::vector<StateEquations::Equation> StateEquations::equations_of(Index node) const
{
   const NodeState state = states_[node];
   std::vector<Equation> equations;
   if (tangential_ && state != NodeState::stick && !held_[node])
   {
      equations.push_back({node, normal_row(node), sense(state) * friction_[node]});
   }
   if (!closed(state)) { equations.push_back({normal_row(node), normal_row(node), 0.0}); }
   return equations;
}

bool StateEquations::factor()
{
   ++factorisations_;
   slots_.clear();
   std::fill(slot_of_.begin(), slot_of_.end(), -1);
   for (Index i = 0; i < n_; ++i)
   {
      for (const Equation &e : equations_of(i))
      {
         slot_of_[e.row] = static_cast<Index>(slots_.size());
         slots_.push_back(e);
      }
   }
   const auto m = static_cast<Index>(slots_.size());
   if (m == 0) { return true; }
   MatrixXd M(m, m);
   for (Index c = 0; c < m; ++c)
   {
      const double *column = K_.col(slots_[c].row).data();
      for (Index r = 0; r < m; ++r)
      {
         M(r, c) = column[slots_[r].row] + slots_[r].factor * column[slots_[r].other];
      }
   }
   const Eigen::PartialPivLU<MatrixXd> lu(M);
   const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
   if (!(pivots.minCoeff() > 1e-14 * pivots.maxCoeff())) { return false; }
   if (G_.rows() < m) { G_.resize(m, m); }
   G_.topLeftCorner(m, m) = lu.inverse();
   return true;
}

bool StateEquations::insert(const Equation &e)
{
   const auto m = static_cast<Index>(slots_.size());
   if (G_.rows() <= m)
   {
      const Index capacity = std::min(K_.rows(), 2 * m + 16);
      G_.conservativeResize(capacity, capacity);
   }
   const double *column = K_.col(e.row).data(), *other = K_.col(e.other).data();
   VectorXd down(m), right(m); // the new column and row of the matrix; K is symmetric
   for (Index k = 0; k < m; ++k)
   {
      down[k] = column[slots_[k].row] + slots_[k].factor * column[slots_[k].other];
      right[k] = column[slots_[k].row] + e.factor * other[slots_[k].row];
   }
   const double corner = column[e.row] + e.factor * column[e.other];
   auto G = G_.topLeftCorner(m, m);
   const VectorXd Gd = G * down;
   const VectorXd rG = G.transpose() * right;
   const double taken = right.dot(Gd), pivot = corner - taken;
   if (!(std::abs(pivot) > least_pivot * (std::abs(corner) + std::abs(taken))))
   {
      return false;
   }
   G.noalias() += (Gd / pivot) * rG.transpose();
   G_.col(m).head(m) = -Gd / pivot;
   G_.row(m).head(m) = -rG.transpose() / pivot;
   G_(m, m) = 1 / pivot;
   slot_of_[e.row] = m;
   slots_.push_back(e);
   ++updates_;
   return true;
}

bool StateEquations::remove(Index row)
{
   const auto m = static_cast<Index>(slots_.size());
   const Index k = slot_of_[row], last = m - 1;
   const double pivot = G_(k, k);
   // 1/pivot is what the matrix without this slot leaves of its diagonal entry.
   if (!(std::abs(pivot) * norm_ > least_pivot)) { return false; }
   if (k != last)
   {
      G_.col(k).head(m).swap(G_.col(last).head(m));
      G_.row(k).head(m).swap(G_.row(last).head(m));
      slots_[k] = slots_[last];
      slot_of_[slots_[k].row] = k;
   }
   const VectorXd column = G_.col(last).head(last) / pivot;
   const VectorXd across = G_.row(last).head(last);
   G_.topLeftCorner(last, last).noalias() -= column * across.transpose();
   slots_.pop_back();
   slot_of_[row] = -1;
   ++updates_;
   return true;
}

bool StateEquations::update(Index node, NodeState state, bool held)
{
   const std::vector<Equation> old = equations_of(node);
   states_[node] = state;
   held_[node] = held;
   const std::vector<Equation> now = equations_of(node);
   // What stays is left alone: the normal equation, the tangential one if its factor stays.
   auto among = [](const Equation &e, const std::vector<Equation> &list)
   {
      for (const Equation &other : list)
      {
         if (other.row == e.row && other.factor == e.factor) { return true; }
      }
      return false;
   };
   for (const Equation &e : old)
   {
      if (!among(e, now) && !remove(e.row)) { return false; }
   }
   for (const Equation &e : now)
   {
      if (!among(e, old) && !insert(e)) { return false; }
   }
   return true;
}

bool StateEquations::set(Index node, NodeState state, bool held)
{
   const NodeState state_before = states_[node];
   const bool held_before = held_[node];
   if (state_before == state && held_before == held) { return true; }
   if (update(node, state, held) || factor()) { return true; }
   states_[node] = state_before;
   held_[node] = held_before;
   factor();
   return false;
}

bool StateEquations::set(const std::vector<NodeState> &states)
{
   std::vector<Index> changed;
   for (Index i = 0; i < n_; ++i)
   {
      if (states[i] != states_[i] || held_[i]) { changed.push_back(i); }
   }
   if (changed.empty()) { return true; }
   const std::vector<NodeState> states_before = states_;
   const std::vector<bool> held_before = held_;
   // Some four rank-one updates of m² a node against 2 m³.
   bool updated = 2 * changed.size() < slots_.size();
   for (std::size_t k = 0; updated && k < changed.size(); ++k)
   {
      updated = update(changed[k], states[changed[k]], false);
   }
   if (updated) { return true; }
   states_ = states;
   held_.assign(n_, false);
   if (factor()) { return true; }
   states_ = states_before;
   held_ = held_before;
   factor();
   return false;
}

double StateEquations::round_off(const VectorXd &b, const VectorXd &x) const
{
   return 4 * eps * (norm_ * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

bool StateEquations::solve(const VectorXd &b, VectorXd &x, VectorXd &F)
{
   x.setZero(b.size());
   F = b;
   if (slots_.empty()) { return true; }
   double before = std::numeric_limits<double>::infinity();
   bool fresh = false;
   while (true)
   {
      const auto m = static_cast<Index>(slots_.size());
      VectorXd residual(m);
      for (Index k = 0; k < m; ++k) { residual[k] = force(slots_[k], F); }
      const double largest = residual.cwiseAbs().maxCoeff();
      const double reachable = round_off(b, x);
      if (!std::isfinite(largest)) { return false; }
      if (largest <= reachable) { return true; }
      if (largest > 0.1 * before) // refinement no longer helps
      {
         if (fresh || largest < 100 * reachable) { return true; }
         fresh = true;
         if (!factor()) { return false; }
         x.setZero();
         F = b;
         before = std::numeric_limits<double>::infinity();
         continue;
      }
      before = largest;
      const VectorXd step = G_.topLeftCorner(m, m) * residual;
      for (Index k = 0; k < m; ++k) { x[slots_[k].row] -= step[k]; }
      if (2 * m > K_.rows()) { F = b + K_ * x; }
      else
      {
         F = b;
         for (const Equation &e : slots_) { F.noalias() += x[e.row] * K_.col(e.row); }
      }
   }
}

} // namespace cattaneo
