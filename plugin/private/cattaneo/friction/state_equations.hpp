#pragma once

#include <Eigen/Dense>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/algebra/round_off.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <vector>

namespace cattaneo
{

/** The linear equations of a set of node states. They are factored once and updated when states
    change: O(m²) a change for m unknowns, while a factorisation costs O(m³).

    With the displacements x = {x_t; x_n} counted from stick (x = 0: no slip, closed) and forces
    F = {q; p} = b + K x, K = [A Bᵀ; B C]:

        stick:       x_t = 0, x_n = 0
        slip:        x_n = 0, q ± bound = 0
        separation:  q = 0,   p = 0
        separation of a pinned node:      x_t = 0, p = 0

    A stiffness of n rows for n nodes has no tangential unknowns (no friction anywhere).

    M₀ is the matrix of the states that were factored last. Where states have changed since,
    rows and columns are added to it (a border): M₀ x + P z = r₀, Q x + D z = r₁. There are
    three kinds.

    * An unknown is no longer one, as where a node begins to stick: the new row is x = 0, and
      the new z is the residual force of its old equation.
    * An unknown is new: it is the new z, and the new row is its equation.
    * An unknown has another equation, as where slip reverses: the new row is that equation,
      and the new z is the residual force of the old one.

    M₀⁻¹ P is kept as long as M₀. */
class StateEquations
{
public:
   /// Keeps a reference to K, of size (c+1)·n, c = 0 or 1, with bounds for n nodes.
   StateEquations(const Eigen::Ref<const Eigen::MatrixXd> &K, std::vector<FrictionBound> bound);

   Eigen::Index nodes() const { return n_; }
   /// Another bound of a node, which the next set() uses.
   void set_bound(Eigen::Index node, const FrictionBound &bound)
   {
      bound_[node] = bound;
      bound_changed_ = true;
   }
   bool tangential() const { return tangential_; } ///< has tangential unknowns
   const Eigen::Ref<const Eigen::MatrixXd> &stiffness() const { return K_; }
   const Eigen::VectorXd &diagonal() const { return diagonal_; }      ///< of K
   const std::vector<FrictionBound> &bound() const { return bound_; } ///< of each node
   const std::vector<NodeState> &states() const { return states_; }
   /// Row of K of a node's normal entry; that of the tangential one is the node's number.
   Eigen::Index normal_row(Eigen::Index node) const { return tangential_ ? n_ + node : node; }
   /// In contact a node without friction, or without a tangential unknown, does not stick …
   bool frictionless(Eigen::Index node) const { return !tangential_ || bound_[node].none(); }
   /// … and this is its state after the displacements x. The sense of slip does not matter.
   NodeState frictionless_contact(Eigen::Index node, const Eigen::VectorXd &x) const;
   /// Changes the states of all nodes or of one. False if the equations would be singular: then
   /// nothing has changed.
   bool set(const std::vector<NodeState> &states);
   bool set(Eigen::Index node, NodeState state, bool pinned = false);
   /// A node in separation that does not move along the contact.
   bool pinned(Eigen::Index node) const { return pinned_[node]; }

   /// From here on results do not depend, to the last bit, on earlier factors and borders: the
   /// next set() keeps the factor only if it belongs to its states.
   void begin()
   {
      anew_ = true;
      base_.resize(0);
   }

   /// Solves for x and F, both of the size of K, refined to round-off. False if they are not
   /// finite.
   bool solve(const Eigen::VectorXd &b, Eigen::VectorXd &x, Eigen::VectorXd &F);

   /** The adjoint of solve(), for a scalar value with the derivatives g by x (size of K). Its
       derivatives by the forces b are -z. Its derivatives by a term that is added to the
       equation of a row are -y, zero in rows without an equation. If the equations are E F = 0,
       then z = Eᵀ y. In rows with an equation g - K z is zero, to round-off. */
   void solve_transposed(const Eigen::VectorXd &g, Eigen::VectorXd &y,
                         Eigen::VectorXd &z) const;

   /// Round-off of the forces b + K x, row by row. The result of the last call is kept.
   const Eigen::VectorXd &round_off(const Eigen::VectorXd &b, const Eigen::VectorXd &x) const;
   /// An upper bound of it in any row, without a product with K.
   double most_round_off(const Eigen::VectorXd &b, const Eigen::VectorXd &x) const
   {
      return arithmetic_.most(x, b);
   }

   /// K x
   Eigen::VectorXd forces(const Eigen::VectorXd &x) const { return times_K_(x); }
   /// K x. If few entries of x changed since an earlier call (after begin()), only their
   /// columns are read.
   Eigen::VectorXd forces_again(const Eigen::VectorXd &x);

   long factorisations() const { return factorisations_; }
   /// How often an unknown was bordered to the factor.
   long updates() const { return updates_; }

private:
   bool set(std::vector<NodeState> states, std::vector<bool> pinned);
   /// Row of K of an equation and the row added to it with `factor`.
   struct Equation
   {
      Eigen::Index row, other;
      double factor;
   };
   /// A border: for an unknown that was added, removed, or has another equation.
   struct Border
   {
      Equation now;    // if present
      bool present;    // false: x = 0
      bool in_factor;  // one of the unknowns of M₀
      double made_for; // factor of the equation in Q_, NaN: none yet
   };

   template <class Visitor>
   void for_each_equation(Eigen::Index node, Visitor visit) const;
   bool is_factored() const;
   double force(const Equation &e, const Eigen::VectorXd &F) const
   {
      return F[e.row] + e.factor * F[e.other] + constant_[e.row];
   }
   bool factor();
   void forget_borders();
   bool border();
   bool adopt();
   void add_columns(const std::vector<Eigen::Index> &rows);
   void set_equation(Eigen::Index border, const Equation &now);
   void step(const Eigen::VectorXd &F, Eigen::VectorXd &x) const;
   void step_transposed(const Eigen::VectorXd &g, Eigen::VectorXd &y) const;

   const Eigen::Ref<const Eigen::MatrixXd> K_;
   const SymmetricProduct times_K_;
   std::vector<FrictionBound> bound_;
   bool bound_changed_ = false; // since set()
   const Eigen::Index n_;
   const bool tangential_;
   const Eigen::VectorXd diagonal_;
   const RoundOff arithmetic_;
   /// The last call of round_off().
   mutable struct
   {
      Eigen::VectorXd b, x, rows;
   } known_;
   std::vector<NodeState> states_;
   std::vector<bool> pinned_;
   Eigen::VectorXd base_, base_forces_; // forces_again(): of a call before
   Eigen::VectorXd
      constant_; // of each row: the part of its friction bound that does not grow with p

   DenseLU lu_;                        // of M₀
   std::vector<Equation> slots_;       // of M₀: the unknown of a slot is x[row]
   std::vector<Eigen::Index> slot_of_; // of each row of K, -1: no unknown

   std::vector<Border> borders_;         // all rows bordered since M₀ was factored
   std::vector<Eigen::Index> border_of_; // of each row of K, -1: none
   std::vector<Eigen::Index> active_;    // those that M₀ needs at present
   Eigen::MatrixXd W_;                   // M₀⁻¹ P, a column per border
   Eigen::MatrixXd Q_;                   // transposed, a column per border that is present
   Eigen::MatrixXd products_;            // D - Q M₀⁻¹ P
   DenseLU corner_;                      // of its active rows and columns
   bool anew_ = true;
   long factorisations_ = 0, updates_ = 0;
};

} // namespace cattaneo
