#pragma once

#include <algorithm>
#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

// The laws of contact and friction of one node, which all methods, checks and paths use.
//
// A node has no tangential entries without friction, one in the plane, two in the disc
// |q| <= f p (first and second tangent), where a slip increment x opposes the friction force,
// q = -f p x/|x|.

/// Tangential entries of one node, none, one or two.
using NodeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
using NodeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;

/// Length, without overflow. (It is not called `size`, because Eigen's size() of an expression
/// is the number of its entries.)
double magnitude(const NodeVector &x);

/** Bound of the tangential force of a node at its normal force p: Coulomb's f p, or that of a
    FrictionLaw. The solvers, their checks, losses and zones() use it, and the cones of
    shakedown use its pieces. Derivatives and wear support Coulomb's law only, and refuse
    another one (require_coulomb()).

    All callers take the bound at a p and in a sense of slip (+1 forward, -1 backward, 0: any
    direction of the disc), and linearise it by its slope there. So no other class has to know
    whether a bound differs from sense to sense or bends with p. */
class FrictionBound
{
public:
   FrictionBound() = default;
   explicit FrictionBound(double coefficient)
      : lines_{Line{0, coefficient}, Line{0, coefficient}}
   {
   }
   /// The law must outlive this, if it bends.
   explicit FrictionBound(const FrictionLaw &law);
   /// No friction at any p.
   bool none() const { return !law_ && lines_[0].slope == 0 && lines_[1].slope == 0; }
   /// Does the bound consist of more than one line?
   bool bends() const { return law_ != nullptr; }
   /// The lines of the pieces at p; at a bend the pieces below it.
   FrictionBound straight(double p) const;
   /// The same without intercepts: the bound of the rates of a node at p.
   FrictionBound of_rates(double p) const;
   /// The pressure at which the bound bends next, from p downwards (`way` < 0) or upwards, in
   /// either sense of slip. It may be p itself. Infinite if there is no bend.
   double bend(double p, double way) const;
   /// Nothing in tension.
   double at(double p, double sense = 0) const { return line(std::max(p, 0.0), sense); }
   /// The bound as if it did not end at p = 0: its straight piece continues into tension.
   double line(double p, double sense = 0) const
   {
      return intercept(p, sense) + slope(p, sense) * p;
   }
   /// The intercept of that line, which does not grow with p: zero in Coulomb's law.
   double intercept(double p = 0, double sense = 0) const { return piece(p, sense).intercept; }
   double slope(double p = 0, double sense = 0) const { return piece(p, sense).slope; }
   /// The larger of the slopes of both senses at that p.
   double steepness(double p) const { return std::max(slope(p, 1), slope(p, -1)); }
   /// Derivative of the bound itself; zero in tension.
   double derivative(double p, double sense = 0) const
   {
      return at(p, sense) > 0 ? slope(p, sense) : 0.0;
   }
   /// Plane: bound less the force, the reserve before the node slips in a sense. Negative
   /// beyond the bound.
   double reserve(double q, double p, double sense) const { return line(p, sense) + sense * q; }

private:
   struct Line
   {
      double intercept = 0, slope = 0;
   };
   Line piece(double p, double sense) const
   {
      return law_ ? piece_of(sense < 0 ? law_->backward : law_->forward, p) : lines_[sense < 0];
   }
   static Line piece_of(const Eigen::MatrixX2d &points, double p);

   Line lines_[2]; // forward and backward
   const FrictionLaw *law_ = nullptr;
};

/// The bound of node i of the problem, which must outlive it.
FrictionBound friction_bound(const ReducedProblem &problem, Eigen::Index i);
/// The bounds of all nodes.
std::vector<FrictionBound> friction_bounds(const ReducedProblem &problem);
/// Bounds of Coulomb's law. With ReducedProblem::friction, the steepest slopes, no law of the
/// problem exceeds them.
std::vector<FrictionBound> friction_bounds(const Eigen::VectorXd &coefficients);

/// One node at the end of an increment. Its own stiffness turns lengths into forces.
struct ContactNode
{
   NodeVector slip; ///< since the start of the increment
   NodeVector q;
   double gap = 0, p = 0;
   double kt = 0, kn = 0; ///< own stiffness
   FrictionBound bound;

   /// The trial force: the friction force that would be needed if the node had not slipped.
   NodeVector trial() const { return q - kt * slip; }
};

/// The state that friction gives the node by its trial force: stick if the bound exceeds it by
/// the margin (a force), else slip against it.
NodeState friction_state(const ContactNode &node, double margin = 0);

/** The state that follows from displacements and forces that solve the equations of the node's
    state `now`. Violations up to `tiny` (normal) and `tiny_along` (tangential) change no state,
    so that states do not alternate where two of them meet. */
NodeState wanted_state(const ContactNode &node, NodeState now, double tiny, double tiny_along);

/// The state of a node in a solution: its own, or the state that it violates least if it
/// violates its own by more than `allowed` (a force). Without friction the laws hold for either
/// sense of slip.
NodeState fitting_state(const ContactNode &node, NodeState now, double allowed);

/// The state that the natural map gives the node, independent of its present one.
NodeState natural_state(const ContactNode &node);

/// The laws as one equation, the natural map: zero in a solution, otherwise forces.
struct NodeResidual
{
   double normal; ///< the smaller of k gap and p
   /// q minus the trial force limited by the bound. [Alart 1991], with the node's own
   /// stiffness.
   NodeVector tangential;
};

NodeResidual residual(const ContactNode &node);

/** Derivative of the tangential residual: (1 - P) dq + P k dx - slope n dp, where n is the
    direction of the trial force, and P projects a change onto what the bound leaves free. In
    stick P = 1, n = 0; in slip of the plane P = 0; in that of the disc P = β t tᵀ with t across
    n and β = (bound)/|trial|, since the derivative of τ/|τ| is (1 - n nᵀ)/|τ|. */
struct FrictionDerivative
{
   NodeMatrix P;
   NodeVector n;
   double slope = 0;
};

FrictionDerivative friction_derivative(const ContactNode &node);

/** Linearised slip of a node in the disc. With the unit vectors n along the trial force and t
    across, and β as above, Newton's equations for the new q, p and x are

        n·q - f p = 0,      (1 - β) t·q + β k t·x = 0. */
struct DiscSlip
{
   Eigen::Vector2d n = Eigen::Vector2d::UnitX();
   double share = 0; ///< β, at most 1

   DiscSlip() = default;
   /// |trial| > 0.
   DiscSlip(const Eigen::Vector2d &trial, double bound);
   Eigen::Vector2d t() const { return {-n[1], n[0]}; }
};

/// A node that moves alone: q = q0 + A x + b y and p = p0 + b·x + c y, with x its slip
/// increment and y its gap. [A b; bᵀ c] is its own block of the reduced stiffness.
struct LoneNode
{
   NodeMatrix A;
   NodeVector b;
   double c;
   NodeVector q0;
   double p0;
   FrictionBound bound;
};

/// Stiffness and bound of node i, without forces.
LoneNode lone_node(const ReducedProblem &problem, Eigen::Index i);

struct NodeMove
{
   bool found = false; ///< false: no state obeys the laws (above the critical friction)
   NodeState state = NodeState::stick;
   NodeVector slip;
   double gap = 0;
};

/** Exact state of the node: separation if it opens when free, else stick if friction suffices,
    else slip. In the disc, with s = f p/|x|, slip is (A + s I) x = -q0, and what remains is one
    equation for s, which changes sign between s = 0 (p of the node without friction, not
    negative or it would have opened) and s = ∞ (|q0| - f p0, positive or it would have
    stuck). */
NodeMove solve_node(const LoneNode &node);

/** Critical coefficient of friction of a single node: above it the node has two answers for
    some loads, below it one for all loads. It is the least mᵀA m/|bᵀm| over the directions m of
    slip (A/|b| where there is one). Two answers, Δx their difference, have Δxᵀ Δq = Δxᵀ A Δx
    and, by Coulomb's law, Δxᵀ Δq <= f |Δp| |Δx| with Δp = bᵀΔx. If that holds along m, stick
    and slip along m are both solutions under a pressure that is large compared with their
    difference. */
double critical_friction(const LoneNode &node);

/// Distance of a state from a solution of an increment, in forces.
struct LawCheck
{
   double normal = 0, tangential = 0; ///< largest violations
   bool obeyed = true; ///< no node violates its laws by more than it is allowed to
};

/** Judges the end of an increment that began with the slip v_old, from the problem as it is
    given: the stated forces are those of the stated displacements, F = K u + Σ λ_k f_k, and
    these obey the laws: no penetration, no tension, no pressure across a gap, no friction
    beyond its bound, and a node that slips has the friction force of its bound against the
    slip. A gap and a slip are multiplied by the node's own stiffness; for a slip that does not
    oppose its friction see slip_violation().

    `forces`: K u + Σ λ_k f_k of the state's own displacements, {q; p}, formed anew by the
    caller from the stiffness as it is given. `allowed`: the tolerance of each node, a force.
    `round_off`: the round-off of each row of {q; p}. The direction of a slip in the disc is
    uncertain by the round-off of displacements over its length. This is allowed too, but it is
    counted in the result.

    `slip_error`: error of each slip since v_old, if it is larger than the round-off of the
    displacement, as where the closed nodes hardly hold a body. A slip shorter than its error
    has no direction. Empty: the errors are not known. */
LawCheck check_laws(const ReducedProblem &problem, const Eigen::VectorXd &v_old,
                    const ContactState &state, const Eigen::VectorXd &forces, double allowed,
                    const Eigen::VectorXd &round_off, const Eigen::VectorXd &slip_error = {});

/// Violation of the law of friction by a closed node: the force beyond the bound. If a slip x
/// does not oppose the force, it is the smaller of the missing force, |q + bound x/|x||, and
/// the slip times the node's own stiffness. `uncertain` is the error of x: it excuses an angle
/// of that size, and any angle of a shorter slip.
double slip_violation(const ContactNode &node, double uncertain = 0);
/// Round-off of displacements of this size.
double slip_round_off(double size);

} // namespace cattaneo
