#pragma once

#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/friction_system.hpp>
#include <optional>

namespace cattaneo
{

/// Result of weak springs on the rigid motions of free bodies.
struct OnSprings
{
   /// The motion of a body that slides away, which no spring stops, or of a body that spins,
   /// which springs may miss because of friction in the disc (find_spinning()).
   Mechanism away;
   std::optional<ContactState> state; ///< with the weakest spring that stopped the bodies
   bool bear_nothing = false; ///< that spring carries no force, so the state is an answer
};

/// Why an increment has no solution, if known.
struct Cause
{
   Mechanism mechanism;
   double lost_in_round_off =
      0; ///< round-off of a solution with too large displacements; 0: none
};

/// One increment: its start, its present displacements and forces, and what was found about it.
struct Increment
{
   using Index = Eigen::Index;
   using VectorXd = Eigen::VectorXd;

   /// Displacements, with the states of the nodes there.
   struct Place
   {
      VectorXd u;
      std::vector<NodeState> status;
   };

   /// The increment at its start, with the loads of its end.
   Increment(FrictionSystem &system, const ContactState &start, const VectorXd &multipliers);

   FrictionSystem &system;
   const ContactState &start;
   const VectorXd &multipliers;

   VectorXd f;    // forces with v = w = 0 at the new loads
   VectorXd u, F; // displacements {v; w} and forces {q; p} (frictionless: w, p)
   std::vector<NodeState> status;
   std::vector<DiscSlip> direction; // disc: for slipping nodes, as last linearised
   VectorXd piece; // plane, bounds that bend: a pressure on the present piece of each node
   double reference = 0; // largest force so far, the scale of residuals
   // End of the sweeps before Newton's steps; without sweeps the start.
   Place swept;

   IncrementReport report;
   ContactState next; // the report of the last call of ends_here()
   Cause cause;
   std::optional<OnSprings> springs; // set by moves_away()

   double scale() const { return reference > 0 ? reference : 1.0; }
   double gap(Index i) const { return u[system.m(i)] + system.problem.gap[i]; }
   /// The tangential entries of node i.
   NodeVector along(const VectorXd &x, Index i) const;
   NodeVector slip(Index i) const { return along(u, i) - along(start.v, i); }
   ContactNode node(Index i) const;
   /// Round-off of each row of F, see RoundOff.
   VectorXd round_off() const { return system.product->arithmetic.rows(u.cwiseAbs(), f); }
   /// Round-off of a node's rows: that of its own forces and of its bound.
   double round_off_along(const VectorXd &rows, Index i) const;

   void move_to(const VectorXd &displacements, const std::vector<NodeState> &states);
   void move_to(const ContactState &there);
   /// For each bound that bends: finds its straight piece at the node's present pressure.
   void find_pieces();
   void go_back() { move_to(swept.u, swept.status); }
   /// The state at the end, with exact zeros where the node states say zero.
   ContactState end() const;
   /// Gives the nodes of an accepted end the states that fit their slips and forces.
   void fit_states(ContactState &next) const;
   /// Is the present state the end of the increment, by the equations and the laws as they are
   /// given (FrictionSystem::obeys_laws())? No state is accepted without this check. With free
   /// bodies a state that passes may still be discarded, as round-off may hide that they move
   /// away (FrictionSystem::solve(), lemke_from_afar(), damped_newton()).
   bool ends_here();
   /// Fills the report with the residual of the natural map in the present state. True if it
   /// may be small enough for ends_here(), whose check is stricter.
   bool residuals();
   /// True if no admissible contact forces can balance the loads: there is no equilibrium. It
   /// is Cause::mechanism then.
   bool finds_mechanism();
};

} // namespace cattaneo
