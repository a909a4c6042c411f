#pragma once

#include <cattaneo/design/march_trace.hpp>
#include <map>

namespace cattaneo
{

/// Derivatives of a response by the entries of one state. Empty: it does not depend on these.
struct StateWeights
{
   Eigen::VectorXd displacements; ///< {v; w}
   Eigen::VectorXd forces;        ///< {q; p}
   Eigen::VectorXd multipliers;   ///< of the load patterns
   Eigen::VectorXd conjugates;    ///< of their conjugates
   Eigen::VectorXd loss;          ///< of each node over the increment that ends in the state
   Eigen::VectorXd worn;          ///< of the depth that it wears off at each node
};

/** A number that a march returned, with its derivatives by the states of the trace. Sensitivity
    differentiates it by parameters. Responses returns such numbers; their sums, products and
    quotients are such numbers too. */
struct Response
{
   double value = 0;                            ///< the number itself
   std::map<std::size_t, StateWeights> weights; ///< by index of the state in the trace
   std::uint64_t trace = 0;                     ///< MarchTrace::number of that; 0: not known

   /// Value and derivatives of the sum. InputError here and below if both are known to be of
   /// different traces.
   Response &operator+=(const Response &other) { return add(other, 1); }
   /// Value and derivatives of the difference.
   Response &operator-=(const Response &other) { return add(other, -1); }
   /// Value and derivatives times a factor.
   Response &operator*=(double factor);

private:
   Response &add(const Response &other, double factor);
};

/// Value and derivatives of the sum.
Response operator+(Response a, const Response &b);
/// Value and derivatives of the difference.
Response operator-(Response a, const Response &b);
/// Value and derivatives times a factor.
Response operator*(double factor, Response a);
/// Value and derivatives of the product.
Response operator*(const Response &a, const Response &b);
/// Value and derivatives of the quotient; b must not be zero.
Response operator/(const Response &a, const Response &b);

/** The numbers of a trace. States are given by their index in it (MarchTrace::at(), last());
    InputError for a state that the trace does not have, and for a node, a component or a
    pattern that the problem does not have. */
class Responses
{
public:
   /// Both must outlive this.
   Responses(const ReducedProblem &problem, const MarchTrace &trace);

   /// Energy lost by friction between two states, at all nodes …
   Response dissipation(std::size_t from, std::size_t to) const;
   /// … or at one.
   Response dissipation(std::size_t from, std::size_t to, Eigen::Index node) const;
   /// Depth that a node loses between two states, by the law of the trace (MarchTrace::wear).
   /// InputError if the trace has no law of wear.
   Response worn_depth(std::size_t from, std::size_t to, Eigen::Index node) const;
   /// Volume that all nodes lose, see the function worn_volume().
   Response worn_volume(std::size_t from, std::size_t to) const;
   /// Displacements and nodal forces of a node; component: 0, with two tangents also 1.
   Response slip(std::size_t state, Eigen::Index node, int component = 0) const;
   /// w: without the gap.
   Response opening(std::size_t state, Eigen::Index node) const;
   /// q of the node.
   Response shear(std::size_t state, Eigen::Index node, int component = 0) const;
   /// p of the node, compression positive.
   Response normal_force(std::size_t state, Eigen::Index node) const;
   /// Normal force over weight. InputError if the node has none.
   Response pressure(std::size_t state, Eigen::Index node) const;
   /// The largest pressure of all nodes (of several equal ones the first; derivatives are then
   /// one-sided).
   Response peak_pressure(std::size_t state) const;
   /// Sum of q times lever arms (size n; empty: 1).
   Response shear_resultant(std::size_t state, const Eigen::VectorXd &arm = {},
                            int component = 0) const;
   /// Sum of p times lever arms (size n; empty: 1).
   Response normal_resultant(std::size_t state, const Eigen::VectorXd &arm = {}) const;
   /// Load multiplier of a pattern, and its conjugate (see conjugates(); InputError if H is not
   /// known).
   Response multiplier(std::size_t state, const std::string &pattern) const;
   /// Conjugate of a load: the displacement of a force, the reaction of a displacement.
   Response conjugate(std::size_t state, const std::string &pattern) const;
   /// Change of force over change of displacement of a pattern between two states. For a
   /// pattern of displacement the force is its reaction. InputError if the displacement does
   /// not change.
   Response secant_stiffness(std::size_t from, std::size_t to,
                             const std::string &pattern) const;

private:
   const ContactState &state(std::size_t k) const;
   /// Row of K of a node, component -1: the normal one.
   Eigen::Index row(Eigen::Index node, int component) const;
   Response entry(std::size_t k, Eigen::VectorXd StateWeights::*what, const Eigen::VectorXd &of,
                  const Eigen::VectorXd &weights) const;
   Response worn(std::size_t from, std::size_t to, const Eigen::VectorXd &weights) const;
   Response resultant(std::size_t k, const Eigen::VectorXd &arm, int component) const;
   Eigen::VectorXd unit(Eigen::Index size, Eigen::Index k) const;

   const ReducedProblem &problem_;
   const MarchTrace &trace_;
};

} // namespace cattaneo
