#pragma once

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/reduced/applied_problem.hpp>

namespace cattaneo
{

/** One plane or axisymmetric body against a rigid obstacle, reduced to its contact nodes as by
    condense() and reduce(), but with a stiffness that is applied: each product is one solve
   with the body, and nothing is formed that is as large as the square of the contact set. For
    contact sets so large that S does not fit (docs/ranks.md says when).

    A body that condense() would factor is, and its S is formed: with the factor it is at hand.
    It is formed for small contact sets too (CondenseSettings::formed_nodes).
    Otherwise a product is collective: every rank must call it, with the same displacements.
   What it needs is kept alive by the result; what it did is added to `counters`, if given,
   which must then live as long. Errors as condense(). */
AppliedProblem apply_reduction(const ElasticBody &body, const ContactLine &line,
                               const ScalarField &gap, const CondenseSettings &settings = {},
                               Counters *counters = nullptr);

} // namespace cattaneo
