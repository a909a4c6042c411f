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
   Counters counters;                 ///< sum over the bodies and all later recoveries

   /// Displacement of all true dofs of body `b` (0 or 1), for relative displacements v and w of
   /// the contact nodes and multipliers of problem.patterns. One solve with that body's factor.
   /// If two free bodies move together unresisted, the common motion is the one of least
   /// squares zero.
   mfem::Vector displacement(int b, const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                             const Eigen::VectorXd &multipliers);

private:
   friend Reduction reduce(CondensedBody body, const ScalarField &gap);
   friend Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing);
   struct Union; ///< how two bodies share a relative displacement
   std::shared_ptr<const Union> union_;
   std::vector<std::vector<int>>
      pattern_; ///< by body and its pattern: index in problem.patterns
};

/// One body against a rigid obstacle; gap as a function of the contact nodes' coordinates.
Reduction reduce(CondensedBody body, const ScalarField &gap = 0.0);

/** Two bodies (thesis 3.3) by the symmetric formulas

       S = S1 - S1 (S1 + S2)⁻¹ S1,     f = f1 - S1 (S1 + S2)⁻¹ (f1 - f2);

    either or both may be free. Gap of the pairing, which may be overwritten in the result. Body
   2's frames are turned onto the opposite of body 1's first. InputError if a common rigid
   motion of two free bodies is loaded, or if a pattern is force-controlled in one and
   displacement-controlled in the other. */
Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing);

} // namespace cattaneo
