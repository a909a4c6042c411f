#include <cattaneo/friction/energy.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/wear/archard.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

WearLaw WearLaw::uniform(const ReducedProblem &problem, double coefficient)
{
   WearLaw law;
   law.coefficient = VectorXd::Constant(problem.nodes(), coefficient);
   return law;
}

void WearLaw::set(const ReducedProblem &problem, const std::string &interface,
                  double coefficient_there)
{
   bool found = false;
   for (const ContactChain &chain : problem.chains)
   {
      if (chain.interface != interface) { continue; }
      coefficient.segment(chain.first, chain.nodes).setConstant(coefficient_there);
      found = true;
   }
   require(found, "wear law: the problem has no interface '", interface, "'");
}

void WearLaw::validate(const ReducedProblem &problem) const
{
   const Index n = problem.nodes();
   const auto check = [n](const char *what, const VectorXd &x)
   {
      require(x.size() == n, "wear law: ", x.size(), " ", what, "s for ", n,
              " contact nodes, must be one for each");
      for (Index i = 0; i < n; ++i)
      {
         require(std::isfinite(x[i]) && x[i] >= 0, "wear law: the ", what, " of node ", i,
                 " is ", x[i], ", must not be negative");
      }
   };
   check("coefficient", coefficient);
   if (threshold.size() > 0) { check("threshold", threshold); }
   require(problem.components() > 0,
           "wear: the problem was reduced without friction and knows no slip");
   require(problem.weights.size() == n,
           "wear: the problem has no weights of its nodes, and so no pressure");
}

VectorXd worn_depth(const ReducedProblem &problem, const WearLaw &law,
                    const ContactState &before, const ContactState &after)
{
   const Rubbing rub = rubbing(problem, before, after);
   VectorXd depth = law.coefficient.cwiseProduct(rub.way);
   if (law.of_energy) { depth = depth.cwiseProduct(problem.friction); }
   for (Index i = 0; i < depth.size(); ++i)
   {
      if (depth[i] == 0) { continue; }
      const double least = law.threshold.size() > 0 ? law.threshold[i] : 0.0,
                   from = rub.p_from[i] / problem.weights[i] - least,
                   to = rub.p_to[i] / problem.weights[i] - least, high = std::max(from, to);
      // A line from `from` to `to`: the mean of what is positive of it.
      const double mean = std::min(from, to) >= 0 ? 0.5 * (from + to)
                          : high <= 0             ? 0.0
                                                  : 0.5 * high * high / std::abs(to - from);
      depth[i] *= mean;
   }
   return depth;
}

double worn_volume(const ReducedProblem &problem, const VectorXd &depth)
{
   return problem.weights.dot(depth);
}

} // namespace cattaneo
