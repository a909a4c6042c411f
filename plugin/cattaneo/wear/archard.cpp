#include <cattaneo/friction/energy.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/wear/worn_derivative.hpp>
#include <cmath>
#include <set>
#include <string>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

WearLaw WearLaw::uniform(const ReducedProblem &problem, double coefficient)
{
   require(std::isfinite(coefficient) && coefficient >= 0, "wear law: the coefficient is ",
           coefficient, ", must be finite and at least 0");
   WearLaw law;
   law.coefficient = VectorXd::Constant(problem.nodes(), coefficient);
   return law;
}

void WearLaw::set(const ReducedProblem &problem, const std::string &interface,
                  double coefficient_there)
{
   require(coefficient.size() == problem.nodes(), "wear law: ", coefficient.size(),
           " coefficients, must be one for each of the ", problem.nodes(), " contact nodes");
   require(std::isfinite(coefficient_there) && coefficient_there >= 0,
           "wear law: the coefficient at interface '", interface, "' is ", coefficient_there,
           ", must be finite and at least 0");
   bool found = false;
   std::set<std::string> names;
   for (const ContactChain &chain : problem.chains)
   {
      names.insert("'" + chain.interface + "'");
      if (chain.interface != interface) { continue; }
      coefficient.segment(chain.first, chain.nodes).setConstant(coefficient_there);
      found = true;
   }
   std::string all;
   for (const std::string &name : names) { all += (all.empty() ? "" : ", ") + name; }
   require(found, "wear law: the problem has no interface '", interface,
           "', must be one of: ", all);
}

void WearLaw::validate(const ReducedProblem &problem) const
{
   const Index n = problem.nodes();
   const auto check = [n](const char *what, const VectorXd &x)
   {
      require(x.size() == n, "wear law: ", x.size(), " ", what,
              "s, must be one for each of the ", n, " contact nodes");
      for (Index i = 0; i < n; ++i)
      {
         require(std::isfinite(x[i]) && x[i] >= 0, "wear law: the ", what, " of node ", i,
                 " is ", x[i], ", must not be negative");
      }
   };
   check("coefficient", coefficient);
   if (threshold.size() > 0) { check("threshold", threshold); }
   require(problem.components() > 0,
           "wear: the problem was reduced without friction, must have tangential components");
   require(problem.weights.size() == n,
           "wear: the problem has no weights of its nodes, and so no pressure");
}

namespace
{

/// Mean of the positive part of a straight line between two values, with its derivatives by
/// both.
struct PositiveMean
{
   PositiveMean(double from, double to)
   {
      const double low = std::min(from, to), high = std::max(from, to);
      // Below zero throughout: no wear.
      if (high <= 0) { return; }
      value = 0.5 * (from + to);
      by_from = by_to = 0.5;
      // Above zero throughout: the mean of both ends.
      if (low >= 0) { return; }
      // Else only the share of the line above zero counts, with half of its highest value.
      const double share = high / (high - low), by_high = share - 0.5 * share * share;
      value = 0.5 * high * share;
      by_from = from > to ? by_high : 0.5 * share * share;
      by_to = from > to ? 0.5 * share * share : by_high;
   }
   double value = 0, by_from = 0, by_to = 0;
};

/// Mean pressure of a node along its slip, above the threshold.
PositiveMean pressure(const ReducedProblem &problem, const WearLaw &law, const Rubbing &rub,
                      Index i)
{
   const double least = law.threshold.size() > 0 ? law.threshold[i] : 0.0;
   return {rub.p_from[i] / problem.weights[i] - least,
           rub.p_to[i] / problem.weights[i] - least};
}

} // namespace

VectorXd worn_depth(const ReducedProblem &problem, const WearLaw &law,
                    const ContactState &before, const ContactState &after)
{
   const Rubbing rub = rubbing(problem, before, after);
   VectorXd depth = law.coefficient.cwiseProduct(rub.way);
   if (law.of_energy) { depth = depth.cwiseProduct(problem.friction); }
   for (Index i = 0; i < depth.size(); ++i)
   {
      if (depth[i] == 0) { continue; }
      // A node without a weight has no area, and so no pressure.
      depth[i] *= problem.weights[i] > 0 ? pressure(problem, law, rub, i).value : 0.0;
   }
   return depth;
}

WornDerivative worn_derivative(const ReducedProblem &problem, const WearLaw &law,
                               const ContactState &before, const ContactState &after,
                               const Rubbing &rub, Index node)
{
   const PositiveMean mean = pressure(problem, law, rub, node);
   const double k = law.coefficient[node], f = law.of_energy ? problem.friction[node] : 1.0,
                way = rub.way[node], weight = problem.weights[node];
   WornDerivative result{rubbing_derivative(problem, before, after, node, f * k * mean.value,
                                            f * k * way * mean.by_from / weight,
                                            f * k * way * mean.by_to / weight),
                         f * way * mean.value};
   if (law.of_energy) { result.by.friction += k * way * mean.value; }
   return result;
}

double worn_volume(const ReducedProblem &problem, const VectorXd &depth)
{
   require(problem.weights.size() == depth.size(), "worn volume: ", depth.size(),
           " depths, must be one for each of the ", problem.weights.size(),
           " nodes with weights");
   return problem.weights.dot(depth);
}

} // namespace cattaneo
