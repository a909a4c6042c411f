#include <algorithm>
#include <cattaneo/condense/stiffness_error.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr Index probes = 3;

/// Standard normal numbers, the same with every library (Box and Muller).
MatrixXd normal(Index rows, Index columns)
{
   std::mt19937 random(1);
   const auto uniform = [&] { return (random() + 0.5) / 4294967296.0; };
   const double turn = 2 * std::acos(-1.0);
   MatrixXd x(rows, columns);
   for (Index k = 0; k < x.size(); ++k)
   {
      const double radius = std::sqrt(-2 * std::log(uniform()));
      x(k) = radius * std::cos(turn * uniform());
   }
   return x;
}

/// A number in [-1, 1] for an entry of a symmetric matrix.
double noise(int i, int j)
{
   std::uint64_t z = (static_cast<std::uint64_t>(std::min(i, j)) << 32) +
                     static_cast<std::uint64_t>(std::max(i, j)) + 0x9e3779b97f4a7c15ULL;
   z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
   z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
   return static_cast<double>((z ^ (z >> 31)) >> 11) / 4503599627370496.0 - 1;
}

} // namespace

StiffnessProbes::StiffnessProbes(const MatrixXd &S, const MatrixXd &motions) : Q_(motions)
{
   // Motions without resistance are fixed, so that the rest is positive definite.
   MatrixXd held = S;
   if (Q_.cols() > 0)
   {
      held.selfadjointView<Eigen::Lower>().rankUpdate(Q_, S.trace() /
                                                             static_cast<double>(S.rows()));
   }
   if (!factor_.compute(std::move(held))) { return; }
   u_ = normal(S.rows(), probes);
   factor_.solve_other_half(u_);
   u_ -= Q_ * (Q_.transpose() * u_);
}

double StiffnessProbes::bound(MatrixXd differences) const
{
   if (u_.size() == 0 || !differences.allFinite())
   {
      return std::numeric_limits<double>::infinity();
   }
   differences -= Q_ * (Q_.transpose() * differences);
   factor_.solve_half(differences);
   return 10 * std::sqrt(2 / std::acos(-1.0)) * differences.colwise().norm().maxCoeff();
}

double stiffness_error(const SharedMatrix &stiffness, const std::vector<int> &keep, int contact,
                       const SparseFactor &factor, const MatrixXd &S, const MatrixXd &motions)
{
   const StiffnessProbes probe(S, motions);
   const MatrixXd &u = probe.motions();
   if (u.size() == 0) { return std::numeric_limits<double>::infinity(); }
   const auto size = static_cast<Index>(keep.size()), interior = size - contact;
   MatrixXd rhs = MatrixXd::Zero(size, probes);
   rhs.bottomRows(contact) = factor.push(u);
   const MatrixXd W =
      factor.solve(rhs); // its contact part is the tested motion: u, apart from errors

   // K W in extended precision, and (δK) W.
   const SparseView K = stiffness.view();
   std::vector<Index> position(K.rows(), -1);
   for (Index a = 0; a < size; ++a) { position[keep[a]] = a; }
   Eigen::VectorXd scale = Eigen::VectorXd::Zero(K.rows());
   for (int i : keep) { scale[i] = std::sqrt(std::abs(stiffness.diagonal(i))); }
   Extended force = Extended::Zero(size, probes);
   MatrixXd change = MatrixXd::Zero(size, probes);
   const double unit = 2 * std::numeric_limits<double>::epsilon();
   for (Index a = 0; a < size; ++a)
   {
      const int i = keep[a];
      for (SparseView::InnerIterator entry(K, i); entry; ++entry)
      {
         const auto j = static_cast<int>(entry.col());
         const Index b = position[j];
         if (b < 0) { continue; }
         const double by = unit * noise(i, j) * scale[i] * scale[j];
         for (Index c = 0; c < probes; ++c)
         {
            force(a, c) += static_cast<long double>(entry.value()) * W(b, c);
            change(a, c) += by * W(b, c);
         }
      }
   }
   // Both errors as forces at the contact: -K_CI K_II⁻¹ r = (S + shift) U_C, where U is the
   // factor's solution for {r; 0}.
   MatrixXd rest = MatrixXd::Zero(size, probes);
   rest.topRows(interior) = force.topRows(interior).cast<double>() - change.topRows(interior);
   const MatrixXd through = factor.push(factor.solve(rest).bottomRows(contact));
   const Extended moved = W.bottomRows(contact).cast<long double>();
   Extended difference =
      (change.bottomRows(contact) - through).cast<long double>() - force.bottomRows(contact);
   for (Index i = 0; i < contact; ++i) // a column at a time: S is symmetric
   {
      difference.row(i) += S.col(i).cast<long double>().transpose().lazyProduct(moved);
   }
   return probe.bound(difference.cast<double>());
}

} // namespace cattaneo
