#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

struct LemkeReport
{
   bool solved = false; ///< false: ray termination or too many pivots
   long pivots = 0;
   Eigen::VectorXd z;
};

/** Linear complementarity problem  s = M z + b,  s >= 0, z >= 0, sᵀz = 0  by Lemke's method
   with a dense tableau and the lexicographic rule (no cycling). Cost O(N²) a pivot, typically
   O(N) pivots: a fallback for small or stubborn problems. The path starts at z = 0 with the
   right-hand side b + z0·cover, z0 large; for matrices that are not copositive another cover
   (positive entries) may reach a solution where one ends in a ray. */
LemkeReport lemke(const Eigen::MatrixXd &M, const Eigen::VectorXd &b,
                  const Eigen::VectorXd &cover, long max_pivots);

} // namespace cattaneo
