#pragma once

#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/friction/contact_law.hpp>

namespace cattaneo
{

struct Increment;

/** Newton's equations of contact with two tangential components per node, where friction is in
    the disc |q| <= f p. Open nodes carry no force and are eliminated. Closed nodes do not move
    along the normal, and sticking nodes do not move at all. Two unknowns are left for each node
    that slips. Their equations are linearised about a direction of slip (DiscSlip).

    The directions change from step to step, and with them a part of each equation. A step is
    solved by iterations (GMRES, [Saad 1986]) that are preconditioned by the factor of an
    earlier step of the same increment. If these do not converge soon, the equations are
    factored. */
class DiscEquations
{
public:
   using Index = Eigen::Index;
   using MatrixXd = Eigen::MatrixXd;
   using VectorXd = Eigen::VectorXd;

   /// Discards all of an earlier increment, except data that depend only on node states.
   void begin();
   /// Moves to the solution of the linear equations of the present states and directions. False
   /// if they are singular.
   bool solve(Increment &at);
   /// From now on, in this increment, each solution is refined by a second one that starts from
   /// it.
   void refine() { refines_ = true; }

private:
   /// Displacements and forces from which slip is counted, with the open nodes' share of the
   /// forces.
   struct Origin
   {
      VectorXd u;
      VectorXd forces; // {q; p} of the closed nodes
      MatrixXd lift;   // L⁻¹ forces of the open nodes, a column
   };
   /// The linearised equations of each slipping node, along the trial force and across it.
   struct Linearised
   {
      Eigen::Matrix2Xd along, across, own; // a column per node; own: stiffness across
      VectorXd slope;                      // of the bound with the pressure
   };

   bool eliminate_open(Increment &at);
   void gather(const Increment &at);
   Origin origin_at(const Increment &at, const VectorXd &u) const;
   Linearised linearise(const Increment &at) const;
   VectorXd imbalance(const Increment &at, const Origin &from) const;
   bool factor(const Linearised &equations);
   VectorXd times(const Linearised &equations, const VectorXd &x) const;
   VectorXd with_factor(const Linearised &equations, const VectorXd &r) const;
   bool iterate(const Linearised &equations, const VectorXd &r, VectorXd &x) const;
   bool solve_slip(Increment &at, const Linearised &equations, const VectorXd &b, VectorXd &x);

   // Data that depend only on node states are kept from increment to increment.
   std::vector<signed char> is_open_; // for each node; empty: nothing is eliminated yet
   std::vector<Index> open_, closed_; // rows of K: all components of the open, closed nodes
   std::vector<Index> place_;         // of a closed node's first component among `closed_`
   Index closed_nodes_ = 0;
   DenseCholesky open_factor_; // L Lᵀ of the open ones
   MatrixXd X_;                // L⁻¹ K(open, closed)
   MatrixXd K_;                // K(closed, closed) - Xᵀ X
   bool singular_ = false;
   std::vector<Index> slipping_; // nodes
   MatrixXd of_slip_;            // forces on the slipping nodes by their slips

   // Data of one increment.
   Origin origin_;               // empty: none yet for these open nodes
   DenseLU factor_;              // of the equations of an earlier step
   std::vector<Index> factored_; // their nodes; empty: no factor
   bool refines_ = false;
};

/// Semismooth Newton steps from the present states, until the laws hold or the residual stops
/// falling.
bool newton_in_the_disc(Increment &at);

} // namespace cattaneo
