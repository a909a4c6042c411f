#pragma once

#include <cattaneo/algebra/semidefinite.hpp>
#include <cattaneo/friction/contact_laws.hpp>
#include <cattaneo/friction/friction_disc.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/mechanism.hpp>
#include <cattaneo/friction/state_equations.hpp>
#include <limits>
#include <optional>

namespace cattaneo
{

/// What FrictionSolver keeps, and the increment that it works at.
struct FrictionSolver::Implementation
{
   using Index = Eigen::Index;
   using MatrixXd = Eigen::MatrixXd;
   using Vector2d = Eigen::Vector2d;
   using VectorXd = Eigen::VectorXd;
   static constexpr double eps = std::numeric_limits<double>::epsilon();

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

   ReducedProblem problem;
   FrictionSettings settings;
   Counters counters;

   Index n = 0, c = 0; // nodes and tangential components (frictionless: none)
   const bool frictionless;
   bool uncoupled = false;
   VectorXd ktt, ktn, knn; // each node's own stiffness block (disc: ktt is its mean)
   VectorXd critical;      // friction of each node
   VectorXd no_friction;   // zeros
   MatrixXd normal;        // frictionless: the normal stiffness, slip eliminated
   const MatrixXd &K;      // the problem's, or `normal` if frictionless
   std::unique_ptr<RoundOff> arithmetic; // of sums K u + f
   // Frictionless: motions along the contact that nothing resists, and how much of each is in
   // some displacements, by the length of the contact.
   MatrixXd slides_freely, share_of_motion;
   std::unique_ptr<RoundOff> whole_arithmetic; // frictionless with slip: of the problem's K
   double critical_friction = std::numeric_limits<double>::infinity();
   Index critical_node = 0;
   std::unique_ptr<SemidefiniteSolver> tangential; // frictionless: A⁻¹
   // Equations of the states: all at once, or the gaps and then the slip (B = 0).
   std::unique_ptr<StateEquations> coupled_equations, normal_equations, tangential_equations;
   EliminatedNodes eliminated;
   std::unique_ptr<MatrixXd> motions; // rigid motions, found when first needed
   Mechanism mechanism;
   std::unique_ptr<FrictionSolver> smooth;   // disc: the contact without friction, when asked
   std::unique_ptr<Implementation> slippery; // see solve_whole()
   bool brief = false;                       // give up where sweeps, active set and path fail
   std::optional<Mechanism> away;            // what moves_away() found, if asked
   std::optional<ContactState> rested;       // what the weakest spring holds, if not away
   bool at_rest = false;                     // it bears nothing
   bool from_here = false;                   // see refined()
   double lost_in_round_off = 0; // round-off of a solution that moves too far; 0: none

   // One increment's working set.
   VectorXd f;    // forces with v = w = 0 at the new loads
   VectorXd u, F; // displacements {v; w} and forces {q; p} (frictionless: w, p)
   VectorXd v_old;
   std::vector<NodeState> status;
   std::vector<DiscSlip> direction; // disc: of the slipping nodes, as last linearised
   double reference = 0;            // largest force so far, the scale of residuals

   /// `tangential_unknowns`: also without friction.
   Implementation(const ReducedProblem &given, const FrictionSettings &chosen,
                  bool tangential_unknowns = false);

   bool disc() const { return c == 2; } // friction force in the disc |q| <= f p
   Index t(Index i) const { return i; } // row of node i's tangential entry
   Index t(Index i, Index k) const { return k * n + i; } // and of its k-th
   Index m(Index i) const { return c * n + i; }          // row of its normal entry
   double gap(Index i) const { return u[m(i)] + problem.gap[i]; }
   double slip(Index i) const { return u[t(i)] - v_old[i]; }
   Vector2d disc_slip(Index i) const { return at(u, i) - at(v_old, i); }
   Vector2d disc_trial(Index i) const { return at(F, i) - ktt[i] * disc_slip(i); }
   /// The two tangential entries of node i.
   Vector2d at(const VectorXd &x, Index i) const { return {x[i], x[n + i]}; }
   double bound(Index i) const { return problem.friction[i] * std::max(F[m(i)], 0.0); }

   void start(const ContactState &state, const VectorXd &multipliers);
   void finish(ContactState &state, const VectorXd &multipliers);
   void sweep();
   void set_node(Index i, double x, double y, NodeState state);
   DiscNode disc_node(Index i) const; // without its forces
   void move_disc_node(Index i);
   bool newton(int steps);
   bool newton_accepted(IncrementReport &report);
   bool newton_disc(int steps);
   bool solve_for_states();
   bool refined();
   bool solve_coupled();
   bool solve_normal();
   bool solve_uncoupled();
   bool eliminate_open();
   bool solve_disc();
   VectorXd closed_gaps() const;
   bool solve_equations(std::unique_ptr<StateEquations> &equations,
                        const Eigen::Ref<const MatrixXd> &stiffness,
                        const std::vector<NodeState> &states, const VectorXd &f, VectorXd &u,
                        VectorXd &forces);
   bool update_states();
   bool lemke_start();
   VectorXd natural_map() const;
   MatrixXd natural_map_derivative() const;
   bool damped_newton();
   void states_of_natural_map();
   bool residuals(IncrementReport &report) const;
   bool accepted(const IncrementReport &report);
   bool obeys_laws(const ContactState &next, IncrementReport &report) const;
   bool runs_away(const IncrementReport &report, const ContactState &state,
                  const VectorXd &multipliers);
   bool finds_mechanism(const VectorXd &multipliers);
   void find_motions();
   bool settles(IncrementReport &report);
   IncrementReport solve_whole(ContactState &state, const VectorXd &multipliers);
   bool moves_away(const ContactState &state, const VectorXd &multipliers);
   bool spins(const VectorXd &multipliers);
   bool drifts(const ContactState &state, const VectorXd &multipliers);
   Index above_critical() const;
   void explain_failure(IncrementReport &report) const;
   static constexpr double may_hide_sliding = 1e-10; // round-off of forces, relative
   /// Violations that do not change the state of a node, for each row.
   VectorXd noise() const
   {
      return (0.5 * round_off()).cwiseMax(0.1 * settings.tolerance * reference);
   }
   /// Of each row of F, see RoundOff.
   VectorXd round_off() const { return arithmetic->rows(u.cwiseAbs(), f); }
   IncrementReport solve(ContactState &state, const VectorXd &multipliers);
   IncrementReport judge(const ContactState &before, const ContactState &after);
   IncrementReport uniqueness(const std::vector<NodeState> &states) const;
   bool run_gauss_seidel(IncrementReport &report);
   bool run_automatic(IncrementReport &report, const ContactState &state,
                      const VectorXd &multipliers);
   bool run_lemke(IncrementReport &report);
   bool run_damped_newton(IncrementReport &report, const ContactState &state,
                          double operations);
   bool run_path(IncrementReport &report, const ContactState &state);
   bool polished(IncrementReport &report);
};

} // namespace cattaneo
