#pragma once

#include <cattaneo/friction/friction_system.hpp>
#include <cattaneo/friction/mechanism.hpp>
#include <optional>

namespace cattaneo
{

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
   /// Gives the nodes of an accepted end states that fit how they slip and what they bear.
   void name_states(ContactState &next) const;
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
