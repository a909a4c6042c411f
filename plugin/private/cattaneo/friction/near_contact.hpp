#pragma once

#include <array>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace cattaneo
{

/** Eliminates the nodes of a reduced problem, those with the largest initial gap first, an
    eighth of them at a time. Each step is done once, when it is first needed. Its bits do not
    depend on the number of later steps. */
class FarFirst
{
public:
   using Index = Eigen::Index;

   /// Keeps a reference to the problem.
   explicit FarFirst(const ReducedProblem &problem);

   /// Ranks of the nodes, the nearest of which has rank 0.
   const std::vector<Index> &rank() const { return rank_; }
   /// Number of nodes in the nearest eighths.
   Index nodes(int eighths) const { return (rank_size() * eighths + 7) / 8; }
   /// Fewest eighths with at least this number of nodes.
   int eighths(Index nodes) const;

   /// Eliminates all but the nearest eighths. False if that does not determine the
   /// displacements of the others.
   bool leave(int eighths);
   /// Rows of K in the order in which they are eliminated.
   const std::vector<Index> &rows() const { return rows_; }
   /// Number of rows that are eliminated before the nearest eighths.
   Index before(int eighths) const { return begin_[8 - eighths]; }
   /// Stiffness of the rows that are kept, in their order.
   Eigen::MatrixXd stiffness(int eighths) const;
   /// Condenses loads on all rows, in their order. Entries of the rows that are kept become the
   /// loads on these, entries before them become data for locate().
   void condense(int eighths, Eigen::VectorXd &loads) const;
   /// Finds the displacements of eliminated rows from those of the rows that are kept. On
   /// entry, the entries that stand before the kept rows are the condensed loads (with the sign
   /// of b in K u = b).
   void locate(int eighths, Eigen::VectorXd &u) const;

private:
   struct Step
   {
      DenseCholesky factor;
      Eigen::MatrixXd Y; // L⁻¹ K(rows of the step, rows after it)
   };
   Index rank_size() const { return static_cast<Index>(rank_.size()); }

   const Eigen::MatrixXd &K_;
   std::vector<Index> rank_, rows_;
   std::array<Index, 9> begin_{}; // of the rows of each step
   std::vector<Step> steps_;
};

/** The problem of the nodes that may soon touch. The others carry no forces and are eliminated,
    K_nn - K_nf K_ff⁻¹ K_fn with n for near and f for far. A last load pattern, different for
    each state, compensates the round-off of the elimination. */
class NearContact
{
public:
   using Index = Eigen::Index;

   /// Keeps references to both and a product with K; `far` has eliminated all but the eighths.
   /// InputError if the kept rows make no reduced problem, because a motion of the bodies
   /// hardly moves them.
   NearContact(const ReducedProblem &whole, const SymmetricProduct &times_K,
               const FarFirst &far, int eighths);

   const ReducedProblem &problem() const { return *problem_; }
   int eighths() const { return eighths_; }
   /// Number in the whole problem of a node.
   Index node(Index near) const { return nodes_[near]; }
   /// Multipliers of the near problem, from those of the whole problem.
   Eigen::VectorXd loads(const Eigen::VectorXd &multipliers) const;
   /// Corrects the loads by the round-off of the near problem at a state. Returns false, and
   /// changes nothing, if nodes that are left out carry forces there.
   bool correct(const ContactState &whole);
   /// The same, and returns the near nodes' part of the state.
   std::optional<ContactState> part(const ContactState &whole);
   /// Number of calls of correct(). The loads are those of the last one, and hold for its state
   /// and for states that follow from it.
   long parts() const { return parts_; }
   /// The state of all nodes that follows `before` if the near nodes' state is `part`.
   ContactState whole(const ContactState &before, const ContactState &part) const;
   /// Made with these settings when first needed.
   FrictionSolver &solver(const FrictionSettings &settings);
   /// Counters of the solver, if there is one.
   Counters counters() const { return solver_ ? solver_->counters() : Counters(); }

private:
   const ReducedProblem &whole_;
   const SymmetricProduct &times_K_;
   const FarFirst &far_;
   const int eighths_;
   long parts_ = 0;
   std::vector<Index> nodes_, rows_;        // in the whole problem
   std::vector<Index> slips_;               // those of rows_ that are tangential
   std::vector<Index> place_;               // of each row of rows_ in the near problem
   std::vector<Eigen::VectorXd> condensed_; // of each pattern, see FarFirst::condense()
   std::shared_ptr<ReducedProblem> problem_;
   std::optional<FrictionSolver> solver_;
};

/** Increments of a solver's problem without the nodes that are far from touching, if most nodes
    are. The number of nodes follows from the state at the start. It grows if others come to
    touch, and all nodes are used if that fails too. Every state is checked in the whole
    problem. */
class NearContacts
{
public:
   explicit NearContacts(FrictionSolver &solver);

   /// As FrictionSolver::solve().
   IncrementReport solve(ContactState &state, const Eigen::VectorXd &multipliers);

   /// Near problem with which an increment is tried, and the state of its nodes at the start.
   struct Way
   {
      std::shared_ptr<NearContact> near;
      ContactState part;
   };
   /// Fewest eighths of the nodes for an increment from that state; 0: all nodes are needed.
   int eighths(const ContactState &state);
   /// Empty if so few nodes do not suffice.
   std::optional<Way> set_out(const ContactState &state, int eighths);
   /// Number of eighths needed to include also the nodes beyond the given eighths that have
   /// closed their gaps; 0: there are no such nodes.
   int touched(const ContactState &state, int eighths) const;

   const ReducedProblem &problem() const { return problem_; }
   /// Counters of the near problems' solvers, and how many near problems were made.
   Counters counters() const;

private:
   std::shared_ptr<NearContact> near(int eighths);

   FrictionSolver &solver_;
   const ReducedProblem &problem_;
   const bool worthwhile_;
   std::unique_ptr<FarFirst> far_; // made when first needed, as the next
   std::unique_ptr<SymmetricProduct> times_K_;
   // Two are kept: an increment often begins with one and ends with the next.
   std::vector<std::pair<int, std::shared_ptr<NearContact>>> kept_;
   std::array<bool, 8> fails_{}; // to be made, of each number of eighths
   Counters counters_;           // of near problems that are no longer kept
};

} // namespace cattaneo
