#pragma once

#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/friction_system.hpp>
#include <optional>

namespace cattaneo
{

/// What weak springs on the rigid motions of free bodies came to.
struct OnSprings
{
   /// The motion of a body that slides away, which no spring stops, or of one that spins, which
   /// friction in the disc can hide from springs (find_spinning()).
   Mechanism away;
   std::optional<ContactState> state; ///< with the weakest spring that stopped the bodies
   bool bear_nothing = false;         ///< that spring bears nothing: the state is an answer
};

/// Why an increment has no end, if that was found out.
struct Cause
{
   Mechanism mechanism;
   double lost_in_round_off = 0; ///< round-off of a solution that moves too far; 0: none
};

/// One increment: where it starts, where it stands, and what was found out about it.
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

   /// Stands at the start, with the loads of the end.
   Increment(FrictionSystem &system, const ContactState &start, const VectorXd &multipliers);

   FrictionSystem &system;
   const ContactState &start;
   const VectorXd &multipliers;

   VectorXd f;    // forces with v = w = 0 at the new loads
   VectorXd u, F; // displacements {v; w} and forces {q; p} (frictionless: w, p)
   std::vector<NodeState> status;
   std::vector<DiscSlip> direction; // disc: of the slipping nodes, as last linearised
   VectorXd piece; // plane, bounds that bend: a pressure on the piece that each node is on
   double reference = 0; // largest force so far, the scale of residuals
   // Where the last sweeps ended; without sweeps the start. Further sweeps set out from there,
   // and the first try of damped Newton. All others depart from the start of the increment.
   Place swept;

   IncrementReport report;
   ContactState next; // the end that ends_here() judged last
   Cause cause;
   std::optional<OnSprings> springs; // if asked, see moves_away()

   double scale() const { return reference > 0 ? reference : 1.0; }
   double gap(Index i) const { return u[system.m(i)] + system.problem.gap[i]; }
   /// The tangential entries of node i.
   NodeVector along(const VectorXd &x, Index i) const;
   NodeVector slip(Index i) const { return along(u, i) - along(start.v, i); }
   ContactNode node(Index i) const;
   /// Round-off of each row of F, see RoundOff.
   VectorXd round_off() const { return system.product->arithmetic.rows(u.cwiseAbs(), f); }
   /// What friction lets a node's rows leave of round-off: that of its own forces and of its
   /// bound.
   double round_off_along(const VectorXd &rows, Index i) const;

   void move_to(const VectorXd &displacements, const std::vector<NodeState> &states);
   void move_to(const ContactState &there);
   /// The pieces at the present pressures, of bounds that bend.
   void find_pieces();
   void go_back() { move_to(swept.u, swept.status); }
   /// The state at the end, with exact zeros where the node states say zero.
   ContactState end() const;
   /// Gives the nodes of an accepted end states that fit how they slip and what they bear.
   void fit_states(ContactState &next) const;
   /// Is the state where it stands the end of the increment? By the equations and the laws as
   /// they are given (FrictionSystem::obeys_laws()). No state is accepted without this. One of
   /// free bodies that passes may still be discarded, where round-off may hide that they move
   /// away (FrictionSystem::solve(), lemke_from_afar(), damped_newton()).
   bool ends_here();
   /// Fills the report with what the natural map leaves where it stands: a measure of the way
   /// that is left. True if that may be small enough for ends_here(), which asks for more.
   bool residuals();
   /// True if no admissible contact forces can balance the loads: there is no equilibrium. It
   /// is Cause::mechanism then.
   bool finds_mechanism();
};

} // namespace cattaneo
