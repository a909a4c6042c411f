#pragma once

#include <cattaneo/friction/energy.hpp>
#include <cattaneo/wear/archard.hpp>

namespace cattaneo
{

/// Derivatives of the worn_depth() of one node with a weight, over an increment: by the
/// arguments of its Rubbing, and by Archard's k there.
struct WornDerivative
{
   RubbingDerivative by;
   double coefficient = 0;
};
WornDerivative worn_derivative(const ReducedProblem &problem, const WearLaw &law,
                               const ContactState &before, const ContactState &after,
                               const Rubbing &rub, Eigen::Index node);

} // namespace cattaneo
