#pragma once

#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/counters.hpp>
#include <vector>

namespace cattaneo
{

/// An open row carries no force, a closed one has a given displacement, and an absent one is
/// not in the equations.
enum class RowState : signed char
{
   closed,
   open,
   absent
};

/** Elimination of the open rows of a stiffness, which carry no force, so that the stiffness of
    the closed ones is left (Schur's complement).

    Few rows that open or close do not pay for another elimination. They border the last one.
    A row that opens adds its displacement to the unknowns, and a row that closes adds the force
    that keeps it at rest. */
class OpenRows
{
public:
   using Index = Eigen::Index;
   using MatrixXd = Eigen::MatrixXd;
   using VectorXd = Eigen::VectorXd;

   /// Displacements from which the open rows move until they carry no force.
   struct Origin
   {
      VectorXd forces;  ///< of the closed rows then; of all rows of K
      MatrixXd lift;    ///< L⁻¹ forces of the rows that are eliminated, a column
      VectorXd borders; ///< unknowns of the borders
   };

   /// False if the stiffness of the open rows is singular. `anew`: without borders, so that the
   /// result does not depend on earlier states.
   bool eliminate(const MatrixXd &K, const std::vector<RowState> &states, bool anew,
                  Counters &counters);
   /// Does the present elimination have borders?
   bool bordered() const { return !changed_.empty(); }

   /// The stiffness that is left, of closed rows by closed rows.
   MatrixXd stiffness(const std::vector<Index> &rows, const std::vector<Index> &columns) const;
   /// `forces`: of all rows of K, at displacements.
   Origin origin(const VectorXd &forces) const;
   /// Moves the open rows of u as they follow from the origin, and from displacements x of some
   /// closed rows.
   void follow(const Origin &from, const std::vector<Index> &rows, const VectorXd &x,
               VectorXd &u) const;

private:
   bool pays(const std::vector<Index> &changed, const std::vector<RowState> &states) const;
   bool border(const MatrixXd &K, std::vector<Index> changed,
               const std::vector<RowState> &states);
   void factor(const MatrixXd &K);

   std::vector<RowState> states_;     // with which rows were eliminated; empty: nothing yet
   std::vector<Index> open_, closed_; // rows of K
   std::vector<Index> place_;         // of a row among the closed ones, then among `closes_`
   DenseCholesky factor_;             // L Lᵀ of the open rows
   MatrixXd X_;                       // L⁻¹ K(open, closed)
   MatrixXd K_;                       // K(closed, closed) - Xᵀ X
   bool singular_ = false;

   // Borders: displacements of rows that have opened since, and forces of rows that have
   // closed, in units of displacement.
   std::vector<Index> changed_, opens_, closes_; // rows of K; all of them
   VectorXd unit_;                               // stiffness of the rows that close
   MatrixXd V_;       // L⁻¹ of the unit forces of the rows that close
   MatrixXd by_rows_; // equations of the borders by closed rows and rows that close
   MatrixXd solved_;  // M⁻¹ by_rows_
   DenseLU corner_;   // M: equations of the borders by their unknowns
};

} // namespace cattaneo
