#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <functional>
#include <memory>

namespace cattaneo
{

/** A plane reduced problem whose stiffness S = [A Bᵀ; B C] is known by what it does, for
   contact sets so large that it is better not formed: one solve with the body a product.
   Otherwise as ReducedProblem, and as plain. */
struct AppliedProblem
{
   /// S u for u = {v; w}, both of size 2n; S is symmetric.
   std::function<Eigen::VectorXd(const Eigen::VectorXd &)> apply;
   /// Size of the diagonal entries of S (2n, positive): a scale, which only the speed of
   /// iterations depends on.
   Eigen::VectorXd diagonal;
   std::vector<LoadPattern> patterns;
   Eigen::VectorXd gap;      ///< n
   Eigen::VectorXd friction; ///< n
   /// Set where S was formed nevertheless: solve() then works with its factors. Gap, friction
   /// and patterns are those above.
   std::shared_ptr<const ReducedProblem> formed;

   Eigen::Index nodes() const { return gap.size(); }

   /// InputError if sizes disagree, or an entry is not finite or not allowed.
   void validate() const;
};

/// The problem as one that is applied.
AppliedProblem applied(const ReducedProblem &problem);

} // namespace cattaneo
