#pragma once

#include <cattaneo/algebra/round_off.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/disc.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/state_equations.hpp>
#include <memory>

namespace cattaneo
{

// Round-off of forces, relative to the largest force. Above this value a residual within the
// round-off proves nothing,
constexpr double lost = 1e-6;
// and above this value it may hide the force that drives a sliding body.
constexpr double may_hide_sliding = 1e-10;

/// Lengths of the contact nodes: their weights, or ones if these are not known.
Eigen::VectorXd node_lengths(const ReducedProblem &problem);

struct FrictionSystem;

/// A contact without friction: nodes slip freely, and only their gaps are unknown.
struct WithoutSlip
{
   explicit WithoutSlip(const ReducedProblem &problem);
   ~WithoutSlip();
   /// Forces on the gaps while none of them opens, under clamped forces {q; p}.
   Eigen::VectorXd normal_forces(const Eigen::VectorXd &clamped) const;
   /// The slips that follow from v and the normal displacements w. Along motions that nothing
   /// holds the mean slip does not change, weighted with the contact's length.
   Eigen::VectorXd slip(const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                        const Eigen::VectorXd &clamped) const;

   const ReducedProblem &problem;
   Eigen::MatrixXd K; // of the gaps
   // Empty if the problem has no tangential displacements. Otherwise motions along the contact
   // that nothing resists, and the amount of each in given displacements.
   std::unique_ptr<SemidefiniteSolver> tangential;
   Eigen::MatrixXd slides_freely, share_of_motion;
   // The same contact, but with slip among the unknowns. Made when first needed.
   std::unique_ptr<FrictionSystem> kept;
};

/// Products with a stiffness, and the round-off of sums K u + f.
struct StiffnessProduct
{
   SymmetricProduct times;
   RoundOff arithmetic;
};

/// Each node on its own.
struct LoneNodes
{
   Eigen::VectorXd kt, kn;   // own stiffness (disc: kt is its mean)
   Eigen::VectorXd critical; // friction
};

/// Equations of the states: all at once, or the gaps and then the slip (B = 0). Each is made
/// when first needed.
struct PlaneEquations
{
   std::unique_ptr<StateEquations> coupled, normal, tangential;
};

/// Data that FrictionSolver keeps from increment to increment.
struct FrictionSystem
{
   using Index = Eigen::Index;
   using MatrixXd = Eigen::MatrixXd;
   using VectorXd = Eigen::VectorXd;

   /// `keeps_slip`: slip is among the unknowns, also where there is no friction.
   FrictionSystem(std::shared_ptr<const ReducedProblem> given, const FrictionSettings &chosen,
                  bool keeps_slip = false);
   FrictionSystem(const FrictionSystem &) = delete;

   const std::shared_ptr<const ReducedProblem>
      shared; ///< shared with other solvers of the problem
   const ReducedProblem &problem;
   FrictionSettings settings;
   Counters counters;
   const Index n, c; // nodes and tangential components (frictionless: none)
   const std::unique_ptr<WithoutSlip> without_slip; // frictionless
   const MatrixXd &K;                               // the problem's, or without slip
   const std::vector<FrictionBound> bound;          // of each node
   LoneNodes lone;
   std::shared_ptr<StiffnessProduct> product, whole_product; // of K, of the problem's K
   PlaneEquations equations;
   DiscEquations disc_equations;

   bool frictionless() const { return c == 0; }
   bool disc() const { return c == 2; }                      // friction force in the disc
   Index t(Index i, Index k = 0) const { return k * n + i; } // row of a tangential entry
   Index m(Index i) const { return c * n + i; }              // row of the normal entry
   /// Does a bound bend with the pressure?
   bool bends() const;
   /// The bounds' lines at these pressures.
   std::vector<FrictionBound> lines_at(const VectorXd &p) const;
   /// The equations of all states at once.
   StateEquations &coupled_equations();
   /// Friction of node i; if its law bends, the slope at a pressure.
   double friction(Index i, double p) const;
   /// The node whose friction at its pressure exceeds its critical value the most; if states
   /// are given it must be closed. -1: no node.
   Index above_critical(const VectorXd &p, const std::vector<NodeState> &states = {}) const;
   /// Final decision whether a state is the end of an increment from slip v_old, by the
   /// original equations. Fills in the report, relative to the force `scale`. @param slip_error
   /// see check_laws()
   bool obeys_laws(const VectorXd &v_old, const ContactState &next, double scale,
                   IncrementReport &report, const VectorXd &slip_error = {}) const;
   // See FrictionSolver.
   IncrementReport solve(ContactState &state, const VectorXd &multipliers);
   IncrementReport judge(const ContactState &before, const ContactState &after,
                         const VectorXd &slip_error = {}) const;
   /// converged, or not_unique with a closed node that is above_critical().
   IncrementReport uniqueness(const ContactState &state) const;
};

} // namespace cattaneo
