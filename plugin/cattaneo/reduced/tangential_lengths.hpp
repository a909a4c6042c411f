#pragma once

#include <Eigen/Core>
#include <cmath>

namespace cattaneo
{

/// Lengths of the tangential vectors of n nodes (n rows) from slips or tangential forces (c·n
/// rows, component by component). Zero without tangential components. Columns are states, or
/// load vertices.
template <class Entries>
typename Entries::PlainObject tangential_lengths(const Eigen::MatrixBase<Entries> &x,
                                                 Eigen::Index n)
{
   using Lengths = typename Entries::PlainObject;
   if (x.rows() == 0) { return Lengths::Zero(n, x.cols()); }
   if (x.rows() == n) { return x.cwiseAbs(); }
   return x.topRows(n).binaryExpr(x.bottomRows(n),
                                  [](double a, double b) { return std::hypot(a, b); });
}

} // namespace cattaneo
