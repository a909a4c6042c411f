#pragma once

#include <cattaneo/algebra/round_off.hpp>
#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/mechanism.hpp>
#include <cattaneo/friction/state_equations.hpp>
#include <limits>
#include <optional>

namespace cattaneo
{

// Round-off of forces, over the largest: above this a residual within it shows nothing,
constexpr double lost = 1e-6;
// and above this it may hide what drives a body that slides.
constexpr double may_hide_sliding = 1e-10;

/// What FrictionSolver keeps from increment to increment.
struct FrictionSystem
{
   using Index = Eigen::Index;
   using MatrixXd = Eigen::MatrixXd;
   using VectorXd = Eigen::VectorXd;

   /// Stiffness of the closed nodes when the open ones are free, kept for as long as these are
   /// the same.
   struct EliminatedNodes
   {
      std::vector<signed char> key;
      std::vector<Index> open, kept; // rows of K: all components of the open, closed nodes
      std::vector<Index> place;      // of a closed node's first component among `kept`
      Eigen::LLT<MatrixXd> factor;   // L Lᵀ of the open ones
      MatrixXd X;                    // L⁻¹ K(open, kept)
      MatrixXd K;                    // K(kept, kept) - Xᵀ X
      bool singular = false;
   };

   /// `tangential_unknowns`: also without friction.
   FrictionSystem(const ReducedProblem &given, const FrictionSettings &chosen,
                  bool tangential_unknowns = false);
   FrictionSystem(const FrictionSystem &) = delete;

   ReducedProblem problem;
   FrictionSettings settings;
   Counters counters;

   Index n = 0, c = 0; // nodes and tangential components (frictionless: none)
   const bool frictionless;
   bool uncoupled = true;                // slip does not change the pressure
   std::vector<FrictionBound> bound;     // of each node
   VectorXd ktt, knn;                    // each node's own stiffness (disc: ktt is its mean)
   VectorXd critical;                    // friction of each node
   MatrixXd normal;                      // frictionless: the normal stiffness, slip eliminated
   const MatrixXd &K;                    // the problem's, or `normal` if frictionless
   std::unique_ptr<RoundOff> arithmetic; // of sums K u + f

   // Frictionless: tangential displacements follow by A⁻¹; motions along the contact that
   // nothing resists, and how much of each is in some displacements, by the length of the
   // contact.
   std::unique_ptr<SemidefiniteSolver> tangential;
   MatrixXd slides_freely, share_of_motion;
   std::unique_ptr<RoundOff> whole_arithmetic; // of the problem's K

   // Equations of the states: all at once, or the gaps and then the slip (B = 0).
   std::unique_ptr<StateEquations> coupled_equations, normal_equations, tangential_equations;
   EliminatedNodes eliminated;
   std::unique_ptr<FrictionSolver> smooth;   // disc: the contact without friction, when asked
   std::unique_ptr<FrictionSystem> slippery; // see solve_whole()
   bool brief = false;                       // give up where sweeps, active set and path fail

   bool disc() const { return c == 2; }                      // friction force in the disc
   Index t(Index i, Index k = 0) const { return k * n + i; } // row of a tangential entry
   Index m(Index i) const { return c * n + i; }              // row of the normal entry
   /// The first node with friction above its critical value, closed if states are given; -1: no
   /// node.
   Index above_critical(const std::vector<NodeState> *states = nullptr) const;
   /// The last word on a state as the end of an increment from slip v_old, in the equations as
   /// they are given, and what is reported of it, over the force `scale`.
   bool obeys_laws(const VectorXd &v_old, const ContactState &next, double scale,
                   IncrementReport &report) const;
   // See FrictionSolver.
   IncrementReport solve(ContactState &state, const VectorXd &multipliers);
   IncrementReport judge(const ContactState &before, const ContactState &after) const;
   /// converged, or not_unique with a closed node of these states that is above_critical().
   IncrementReport uniqueness(const std::vector<NodeState> &states) const;
};

/// One increment: where it starts, where it stands, and what was found out about it.
struct Increment
{
   using Index = Eigen::Index;
   using VectorXd = Eigen::VectorXd;

   /// Stands at the start, with the loads of the end.
   Increment(FrictionSystem &system, const ContactState &start, const VectorXd &multipliers);

   FrictionSystem &system;
   const ContactState &start;
   const VectorXd &multipliers;

   VectorXd v_old;
   VectorXd f;    // forces with v = w = 0 at the new loads
   VectorXd u, F; // displacements {v; w} and forces {q; p} (frictionless: w, p)
   std::vector<NodeState> status;
   std::vector<DiscSlip> direction; // disc: of the slipping nodes, as last linearised
   double reference = 0;            // largest force so far, the scale of residuals
   // Where the last sweeps ended, from which every method sets out.
   VectorXd u_swept;
   std::vector<NodeState> status_swept;

   IncrementReport report;
   Mechanism mechanism;
   std::optional<Mechanism> away;      // what moves_away() found, if asked
   std::optional<ContactState> rested; // what the weakest spring holds, if not away
   bool at_rest = false;               // it bears nothing
   double lost_in_round_off = 0;       // round-off of a solution that moves too far; 0: none

   double scale() const { return reference > 0 ? reference : 1.0; }
   double gap(Index i) const { return u[system.m(i)] + system.problem.gap[i]; }
   /// The tangential entries of node i.
   NodeVector along(const VectorXd &x, Index i) const;
   NodeVector slip(Index i) const { return along(u, i) - along(v_old, i); }
   ContactNode node(Index i) const;
   /// Of each row of F, see RoundOff.
   VectorXd round_off() const { return system.arithmetic->rows(u.cwiseAbs(), f); }
   /// What friction lets a node's rows leave of round-off: that of its own forces and of its
   /// bound.
   double round_off_along(const VectorXd &rows, Index i) const;

   void take(const VectorXd &displacements, const std::vector<NodeState> &states);
   void go_back() { take(u_swept, status_swept); }
   /// The state at the end, with exact zeros where the node states say zero.
   ContactState end() const;
   /// Fills the report with the residuals of where it stands. False if one is too large.
   bool residuals();
   /// residuals() of a solution: false too where it moves so far that its forces cannot be told
   /// from round-off, which is remembered.
   bool solved();
   /// True if no admissible contact forces can balance the loads: there is nothing to search
   /// for.
   bool finds_mechanism();
};

} // namespace cattaneo
