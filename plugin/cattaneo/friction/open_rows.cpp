#include <cattaneo/algebra/products.hpp>
#include <cattaneo/friction/open_rows.hpp>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool OpenRows::eliminate(const MatrixXd &K, const std::vector<RowState> &states, bool anew,
                         Counters &counters)
{
   // 1. Rows that have changed since the elimination border it, if they are few.
   changed_.clear();
   opens_.clear();
   closes_.clear();
   if (states_.size() == states.size())
   {
      std::vector<Index> changed;
      for (std::size_t row = 0; row < states.size(); ++row)
      {
         if (states[row] != states_[row]) { changed.push_back(static_cast<Index>(row)); }
      }
      if (changed.empty()) { return !singular_; }
      if (!anew && !singular_ && pays(changed, states) && border(K, changed, states))
      {
         counters.dense_updates += static_cast<long>(changed.size());
         return true;
      }
   }
   // 2. Otherwise all open rows are eliminated.
   changed_.clear();
   opens_.clear();
   closes_.clear();
   states_ = states;
   factor(K);
   ++counters.dense_factorisations;
   return !singular_;
}

void OpenRows::factor(const MatrixXd &K)
{
   open_.clear();
   closed_.clear();
   place_.assign(states_.size(), 0);
   for (std::size_t k = 0; k < states_.size(); ++k)
   {
      const auto row = static_cast<Index>(k);
      if (states_[k] == RowState::open) { open_.push_back(row); }
      if (states_[k] != RowState::closed) { continue; }
      place_[k] = static_cast<Index>(closed_.size());
      closed_.push_back(row);
   }
   K_ = K(closed_, closed_);
   X_.resize(0, K_.cols());
   singular_ = !open_.empty() && !factor_.compute(K(open_, open_));
   if (singular_ || open_.empty()) { return; }
   X_ = K(open_, closed_);
   factor_.solve_half(X_);
   K_ = minus_square(std::move(K_), X_);
}

/// Do borders cost much less than another elimination?
bool OpenRows::pays(const std::vector<Index> &changed,
                    const std::vector<RowState> &states) const
{
   double opens = 0, closes = 0;
   for (const Index row : changed) { (states[row] == RowState::open ? opens : closes) += 1; }
   const auto open = static_cast<double>(open_.size()),
              closed = static_cast<double>(closed_.size()), free = open + opens - closes,
              held = closed - opens + closes, borders = opens + closes;
   const double of_borders = closes * open * (0.5 * open + closed) + borders * borders * closed,
                of_all = free * (free * free / 6 + 0.5 * free * held + 0.5 * held * held);
   return 4 * of_borders < of_all;
}

/// Borders the elimination with rows that have changed since. False if the corner is nearly
/// singular.
bool OpenRows::border(const MatrixXd &K, std::vector<Index> changed,
                      const std::vector<RowState> &states)
{
   for (const Index row : changed)
   {
      (states[row] == RowState::open ? opens_ : closes_).push_back(row);
   }
   const auto closed = static_cast<Index>(closed_.size()),
              opens = static_cast<Index>(opens_.size()),
              closes = static_cast<Index>(closes_.size());
   // 1. Unit forces of the rows that close, which are among the eliminated ones.
   V_ = MatrixXd::Zero(X_.rows(), closes);
   unit_.resize(closes);
   for (Index k = 0, at = 0; k < closes; ++k)
   {
      while (open_[at] != closes_[k]) { ++at; }
      unit_[k] = K(closes_[k], closes_[k]);
      V_(at, k) = unit_[k];
      place_[closes_[k]] = closed + k;
   }
   factor_.solve_half(V_);
   // 2. The equations: rows that open carry no force, and rows that close do not move.
   std::vector<Index> places;
   for (const Index row : opens_) { places.push_back(place_[row]); }
   by_rows_ = MatrixXd::Zero(opens + closes, closed + closes);
   by_rows_.topLeftCorner(opens, closed) = K_(places, Eigen::all);
   by_rows_.bottomLeftCorner(closes, closed) = -transposed_product(V_, X_);
   by_rows_.bottomRightCorner(closes, closes).diagonal() = -unit_;
   MatrixXd M(opens + closes, opens + closes);
   M.leftCols(opens) = by_rows_(Eigen::all, places);
   M.topRightCorner(opens, closes) = M.bottomLeftCorner(closes, opens).transpose();
   M.bottomRightCorner(closes, closes) = -transposed_product(V_, V_);
   constexpr double least = 1e-9;
   if (!corner_.compute(std::move(M)) || corner_.pivot_ratio() < least) { return false; }
   solved_ = by_rows_;
   corner_.solve(solved_);
   changed_ = std::move(changed);
   return true;
}

MatrixXd OpenRows::stiffness(const std::vector<Index> &rows,
                             const std::vector<Index> &columns) const
{
   std::vector<Index> of_rows, of_columns;
   for (const Index row : rows) { of_rows.push_back(place_[row]); }
   for (const Index row : columns) { of_columns.push_back(place_[row]); }
   if (!bordered()) { return K_(of_rows, of_columns); }
   const Index closed = K_.rows();
   MatrixXd S = MatrixXd::Zero(rows.size(), columns.size());
   for (Index j = 0; j < S.cols(); ++j)
   {
      if (of_columns[j] >= closed) { continue; }
      for (Index i = 0; i < S.rows(); ++i)
      {
         if (of_rows[i] < closed) { S(i, j) = K_(of_rows[i], of_columns[j]); }
      }
   }
   subtract_product(S, by_rows_(Eigen::all, of_rows), solved_(Eigen::all, of_columns));
   return S;
}

OpenRows::Origin OpenRows::origin(const VectorXd &forces) const
{
   Origin origin;
   // 1. With the rows that were eliminated.
   VectorXd left = forces(closed_);
   if (!open_.empty())
   {
      origin.lift = forces(open_);
      factor_.solve_half(origin.lift);
      left -= X_.transpose() * origin.lift;
   }
   // 2. With the borders.
   if (bordered())
   {
      const auto opens = static_cast<Index>(opens_.size()),
                 closes = static_cast<Index>(closes_.size());
      origin.borders.resize(opens + closes);
      for (Index k = 0; k < opens; ++k) { origin.borders[k] = -left[place_[opens_[k]]]; }
      if (closes > 0) { origin.borders.tail(closes) = V_.transpose() * origin.lift; }
      corner_.solve(origin.borders);
      left.conservativeResizeLike(VectorXd::Zero(K_.rows() + closes));
      left += by_rows_.transpose() * origin.borders;
   }
   // 3. By rows of K.
   origin.forces = VectorXd::Zero(forces.size());
   for (const Index row : closed_) { origin.forces[row] = left[place_[row]]; }
   for (const Index row : closes_) { origin.forces[row] = left[place_[row]]; }
   for (const Index row : opens_) { origin.forces[row] = 0; }
   return origin;
}

void OpenRows::follow(const Origin &from, const std::vector<Index> &rows, const VectorXd &x,
                      VectorXd &u) const
{
   MatrixXd lift = from.lift;
   const bool any = lift.size() > 0;
   for (std::size_t r = 0; any && r < rows.size(); ++r)
   {
      const Index k = place_[rows[r]];
      if (k < X_.cols()) { lift += x[static_cast<Index>(r)] * X_.col(k); }
   }
   if (bordered())
   {
      VectorXd unknowns = from.borders;
      for (std::size_t r = 0; r < rows.size(); ++r)
      {
         unknowns -= x[static_cast<Index>(r)] * solved_.col(place_[rows[r]]);
      }
      Index at = 0;
      for (const Index row : opens_)
      {
         if (any) { lift += unknowns[at] * X_.col(place_[row]); }
         u[row] += unknowns[at++];
      }
      if (!closes_.empty()) { lift += V_ * unknowns.tail(unknowns.size() - at); }
   }
   if (!any) { return; }
   factor_.solve_other_half(lift);
   const VectorXd closed = u(closes_);
   u(open_) -= lift;
   u(closes_) = closed;
}

} // namespace cattaneo
