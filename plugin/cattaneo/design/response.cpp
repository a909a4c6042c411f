#include <cattaneo/design/response.hpp>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

constexpr VectorXd StateWeights::*all_weights[] = {
   &StateWeights::displacements, &StateWeights::forces, &StateWeights::multipliers,
   &StateWeights::conjugates,    &StateWeights::loss,   &StateWeights::worn};

} // namespace

Response &Response::operator*=(double factor)
{
   value *= factor;
   for (auto &[k, weight] : weights)
   {
      for (const auto part : all_weights) { weight.*part *= factor; }
   }
   return *this;
}

Response &Response::add(const Response &other, double factor)
{
   require(trace == 0 || other.trace == 0 || trace == other.trace,
           "response: two responses belong to different traces, both must belong to one");
   trace = std::max(trace, other.trace);
   value += factor * other.value;
   for (const auto &[k, weight] : other.weights)
   {
      StateWeights &sum = weights[k];
      for (const auto part : all_weights)
      {
         const VectorXd &more = weight.*part;
         if (more.size() == 0) { continue; }
         if ((sum.*part).size() == 0) { sum.*part = VectorXd::Zero(more.size()); }
         sum.*part += factor * more;
      }
   }
   return *this;
}

Response operator+(Response a, const Response &b)
{
   return a += b;
}
Response operator-(Response a, const Response &b)
{
   return a -= b;
}
Response operator*(double factor, Response a)
{
   return a *= factor;
}
Response operator*(const Response &a, const Response &b)
{
   Response product = b.value * a + a.value * b;
   product.value = a.value * b.value;
   return product;
}
Response operator/(const Response &a, const Response &b)
{
   require(b.value != 0, "response: the divisor is zero, must be nonzero");
   Response quotient = (1 / b.value) * a - (a.value / (b.value * b.value)) * b;
   quotient.value = a.value / b.value;
   return quotient;
}

Responses::Responses(const ReducedProblem &problem, const MarchTrace &trace)
   : problem_(problem), trace_(trace)
{
   for (const TracedState &traced : trace.states) { traced.state.validate(problem); }
}

const ContactState &Responses::state(std::size_t k) const
{
   require(k < trace_.states.size(), "responses: state ", k, ", must be below ",
           trace_.states.size(), ", the number of states of the trace");
   return trace_.states[k].state;
}

Index Responses::row(Index node, int component) const
{
   const Index n = problem_.nodes();
   require(node >= 0 && node < n, "responses: node ", node, ", must be from 0 to ", n - 1);
   require(component >= -1 && component < problem_.components(),
           "responses: tangential component ", component, ", must be below ",
           problem_.components(), ", the number of tangential components");
   return component < 0 ? problem_.slips() + node : component * n + node;
}

VectorXd Responses::unit(Index size, Index k) const
{
   return VectorXd::Unit(size, k);
}

Response Responses::entry(std::size_t k, VectorXd StateWeights::*what, const VectorXd &of,
                          const VectorXd &weights) const
{
   Response response;
   response.trace = trace_.number;
   response.value = weights.dot(of);
   response.weights[k].*what = weights;
   return response;
}

Response Responses::dissipation(std::size_t from, std::size_t to) const
{
   state(to);
   require(from <= to, "responses: dissipation from state ", from, " to state ", to,
           ", the second must not be the earlier one");
   Response sum;
   for (std::size_t k = from + 1; k <= to && problem_.components() > 0; ++k)
   {
      const VectorXd lost = frictional_loss(problem_, state(k - 1), state(k));
      sum += entry(k, &StateWeights::loss, lost, VectorXd::Ones(lost.size()));
   }
   return sum;
}

Response Responses::dissipation(std::size_t from, std::size_t to, Index node) const
{
   row(node, -1);
   Response sum = dissipation(from, to);
   sum.value = 0;
   for (auto &[k, weight] : sum.weights)
   {
      sum.value += frictional_loss(problem_, state(k - 1), state(k))[node];
      weight.loss = unit(weight.loss.size(), node);
   }
   return sum;
}

Response Responses::worn(std::size_t from, std::size_t to, const VectorXd &weights) const
{
   state(to);
   require(from <= to, "responses: wear from state ", from, " to state ", to,
           ", the second must not be the earlier one");
   require(trace_.wear.coefficient.size() > 0,
           "responses: the trace was recorded without a wear law");
   trace_.wear.validate(problem_);
   Response sum;
   for (std::size_t k = from + 1; k <= to; ++k)
   {
      sum +=
         entry(k, &StateWeights::worn,
               cattaneo::worn_depth(problem_, trace_.wear, state(k - 1), state(k)), weights);
   }
   return sum;
}
Response Responses::worn_depth(std::size_t from, std::size_t to, Index node) const
{
   row(node, -1);
   return worn(from, to, unit(problem_.nodes(), node));
}
Response Responses::worn_volume(std::size_t from, std::size_t to) const
{
   return worn(from, to, problem_.weights);
}

Response Responses::slip(std::size_t k, Index node, int component) const
{
   const VectorXd u = state(k).displacements();
   require(component >= 0, "responses: tangential component ", component,
           ", must be 0 or more");
   return entry(k, &StateWeights::displacements, u, unit(u.size(), row(node, component)));
}
Response Responses::opening(std::size_t k, Index node) const
{
   const VectorXd u = state(k).displacements();
   return entry(k, &StateWeights::displacements, u, unit(u.size(), row(node, -1)));
}
Response Responses::shear(std::size_t k, Index node, int component) const
{
   const VectorXd F = state(k).forces();
   require(component >= 0, "responses: tangential component ", component,
           ", must be 0 or more");
   return entry(k, &StateWeights::forces, F, unit(F.size(), row(node, component)));
}
Response Responses::normal_force(std::size_t k, Index node) const
{
   const VectorXd F = state(k).forces();
   return entry(k, &StateWeights::forces, F, unit(F.size(), row(node, -1)));
}

Response Responses::pressure(std::size_t k, Index node) const
{
   Response force = normal_force(k, node);
   require(problem_.weights.size() == problem_.nodes() && problem_.weights[node] > 0,
           "responses: node ", node, " has no weight, which its pressure needs");
   return (1 / problem_.weights[node]) * std::move(force);
}

Response Responses::peak_pressure(std::size_t k) const
{
   const VectorXd &p = state(k).p;
   require(problem_.weights.size() == p.size(),
           "responses: the problem has no weights of its nodes, which pressures need");
   Index peak = 0;
   for (Index i = 1; i < p.size(); ++i)
   {
      // p over weight, except for nodes on an axis, which have no weight.
      if (p[i] * problem_.weights[peak] > p[peak] * problem_.weights[i]) { peak = i; }
   }
   return pressure(k, peak);
}

Response Responses::resultant(std::size_t k, const VectorXd &arm, int component) const
{
   const Index n = problem_.nodes();
   require(arm.size() == 0 || arm.size() == n, "responses: ", arm.size(),
           " lever arms, must be none or ", n, ", one for each node");
   const VectorXd F = state(k).forces();
   VectorXd weights = VectorXd::Zero(F.size());
   weights.segment(row(0, component), n) = arm.size() ? arm : VectorXd(VectorXd::Ones(n));
   return entry(k, &StateWeights::forces, F, weights);
}
Response Responses::shear_resultant(std::size_t k, const VectorXd &arm, int component) const
{
   require(component >= 0, "responses: tangential component ", component,
           ", must be 0 or more");
   return resultant(k, arm, component);
}
Response Responses::normal_resultant(std::size_t k, const VectorXd &arm) const
{
   return resultant(k, arm, -1);
}

Response Responses::multiplier(std::size_t k, const std::string &pattern) const
{
   const VectorXd &loads = state(k).multipliers;
   return entry(k, &StateWeights::multipliers, loads,
                unit(loads.size(), problem_.pattern(pattern)));
}

Response Responses::conjugate(std::size_t k, const std::string &pattern) const
{
   require(problem_.knows_loads(),
           "responses: the problem has no H, which the conjugates of its loads need");
   const VectorXd all = conjugates(problem_, state(k));
   return entry(k, &StateWeights::conjugates, all, unit(all.size(), problem_.pattern(pattern)));
}

Response Responses::secant_stiffness(std::size_t from, std::size_t to,
                                     const std::string &pattern) const
{
   const Response load = multiplier(to, pattern) - multiplier(from, pattern),
                  moved = conjugate(to, pattern) - conjugate(from, pattern);
   const bool force = problem_.patterns[problem_.pattern(pattern)].control == Control::force;
   return force ? load / moved : moved / load;
}

} // namespace cattaneo
