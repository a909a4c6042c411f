#pragma once

#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/contact/pairing.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/** A reduced problem together with the way back to the fields of its bodies. The nodes are
   those of body 1's contact line, in its order and frames. Load patterns of the bodies are
   joined by name; the friction coefficient is zero until set. */
class Reduction
{
public:
   ReducedProblem problem;
   std::vector<CondensedBody> bodies; ///< one (rigid obstacle) or two
   Counters counters;

   /// Displacement of all true dofs of body `b` (0 or 1), for relative displacements v and w of
   /// the contact nodes and multipliers of problem.patterns.
   mfem::Vector displacement(int b, const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                             const Eigen::VectorXd &multipliers);

private:
   friend Reduction reduce(CondensedBody body, const ScalarField &gap);
   friend Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing);
   Eigen::VectorXi partner_;    ///< node of body 2 for each node
   Eigen::MatrixXd compliance_; ///< (S1 + S2)^-1, on the complement of common rigid motions
};

/// One body against a rigid obstacle; gap as a function of the contact nodes' coordinates.
Reduction reduce(CondensedBody body, const ScalarField &gap = 0.0);

/** Two bodies (thesis 3.3) by the symmetric formula S = S1 - S1 (S1 + S2)^-1 S1; either or both
   may be free. Gap of the pairing, which may be overwritten in the result. InputError if a
   common rigid motion of two free bodies is loaded. */
Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing);

} // namespace cattaneo
