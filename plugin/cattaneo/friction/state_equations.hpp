#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>
#include <vector>

namespace cattaneo
{

/** The linear equations that a set of node states stands for, with their inverse, which follows
    changes of single nodes by rank-one updates: O(m²) a change for m unknowns, where a
    factorisation costs O(m³).

    With the displacements x = {x_t; x_n} counted from stick (x = 0: no slip, closed) and forces
    F = {q; p} = b + K x, K = [A Bᵀ; B C]:

        stick:       x_t = 0, x_n = 0
        slip:        x_n = 0, q ± f p = 0
        separation:  q = 0,   p = 0
        separation of a node that is held: x_t = 0, p = 0

    A stiffness of n rows for n nodes has no tangential unknowns (no friction anywhere). */
class StateEquations
{
public:
   /// Keeps references to both: K of size (c+1)·n, c = 0 or 1, and n friction coefficients.
   StateEquations(const Eigen::MatrixXd &K, const Eigen::VectorXd &friction);

   const Eigen::MatrixXd &stiffness() const { return K_; }
   const Eigen::VectorXd &diagonal() const { return diagonal_; } ///< of K
   const std::vector<NodeState> &states() const { return states_; }
   /// Changes the states of all nodes or of one. False if the equations would be singular: then
   /// nothing has changed.
   bool set(const std::vector<NodeState> &states);
   bool set(Eigen::Index node, NodeState state, bool held = false);
   /// A node in separation that does not move along the contact.
   bool held(Eigen::Index node) const { return held_[node]; }

   /// Solves for x and F, both of the size of K, refined to round-off. False if they are not
   /// finite.
   bool solve(const Eigen::VectorXd &b, Eigen::VectorXd &x, Eigen::VectorXd &F);

   /// What round-off leaves of forces of such size.
   double round_off(const Eigen::VectorXd &b, const Eigen::VectorXd &x) const;

   long factorisations() const { return factorisations_; }
   long updates() const { return updates_; }

private:
   /// Row of K of an equation and the row added to it with `factor`.
   struct Equation
   {
      Eigen::Index row, other;
      double factor;
   };

   Eigen::Index normal_row(Eigen::Index node) const { return tangential_ ? n_ + node : node; }
   std::vector<Equation> equations_of(Eigen::Index node) const;
   double force(const Equation &e, const Eigen::VectorXd &F) const
   {
      return F[e.row] + e.factor * F[e.other];
   }
   bool factor();
   bool insert(const Equation &e);
   bool remove(Eigen::Index row);
   bool update(Eigen::Index node, NodeState state, bool held);

   const Eigen::MatrixXd &K_;
   const Eigen::VectorXd &friction_;
   const Eigen::Index n_;
   const bool tangential_;
   const Eigen::VectorXd diagonal_;
   const double norm_; // row sums of K
   std::vector<NodeState> states_;
   std::vector<bool> held_;
   std::vector<Equation> slots_;       // the unknown of a slot is x[row]
   std::vector<Eigen::Index> slot_of_; // of each row of K, -1: no unknown
   Eigen::MatrixXd G_;                 // its leading block is the inverse
   long factorisations_ = 0, updates_ = 0;
};

} // namespace cattaneo
