#pragma once

#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/friction/open_rows.hpp>

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
   /// Displacements and forces from which slip is counted.
   struct Origin
   {
      VectorXd u;
      OpenRows::Origin open;
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

   // Data that depend only on node states are kept from increment to increment, but borders of
   // the open rows are not.
   OpenRows open_rows_;
   std::vector<RowState> rows_; // states of all rows of K; empty: nothing is eliminated yet
   bool singular_ = false;
   std::vector<Index> slipping_; // nodes
   std::vector<Index> slips_;    // their tangential rows of K
   MatrixXd of_slip_;            // forces on the slipping nodes by their slips

   // Data of one increment.
   Origin origin_;               // empty: none yet for these open nodes
   DenseLU factor_;              // of the equations of an earlier step
   std::vector<Index> factored_; // their nodes; empty: no factor
   bool refines_ = false;
   bool anew_ = true; // no step yet
};

/// Semismooth Newton steps from the present states, until the laws hold or the residual stops
/// falling.
bool newton_in_the_disc(Increment &at);

} // namespace cattaneo
