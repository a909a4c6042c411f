#pragma once

#include <algorithm>
#include <cattaneo/friction/contact_state.hpp>
#include <cmath>
#include <limits>
#include <string>

namespace cattaneo_test
{

/** Is a state a solution? The laws of contact and friction in plain words, from displacements
    alone (forces are formed anew), for one and two tangential components. All violations are
    forces: displacements count by the node's own stiffness. */
class LawChecker
{
public:
   /// `start`: the state before the first increment that is checked; initial slip loads it.
   LawChecker(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &start);

   /// Largest violation of an increment from slip `v_old` to `state`, over what its node is
   /// allowed, ten times the solvers' tolerance (1e-12 of the largest load so far) and the
   /// round-off of its own forces: a solution if at most 1. Displacements so large that
   /// round-off hides the forces are none.
   double violation(const Eigen::VectorXd &v_old, const cattaneo::ContactState &state);
   /// Round-off of the forces of an increment from slip `v_old` to displacements u at `loads`,
   /// over the largest force so far.
   double round_off(const Eigen::VectorXd &v_old, const Eigen::VectorXd &u,
                    const Eigen::VectorXd &loads) const;
   /// What was worst, and at which node.
   const std::string &what() const { return what_; }

private:
   void note(double violation, Eigen::Index node, const char *what);

   const cattaneo::ReducedProblem &problem_;
   const Eigen::Index n_, c_;
   const Eigen::MatrixXd K_;
   Eigen::VectorXd sums_; // of the sizes in each row of K
   double norm_ = 0, peak_ = 0, worst_ = 0;
   double allowed_ = 0; // violation of the node at hand
   std::string what_;
};

/// True if `motion` {v; w} proves that there is no equilibrium under these clamped forces: it
/// costs no elastic energy, the loads drive it, and no force inside any friction cone opposes
/// it enough (Farkas). Independent of how the motion was found.
bool proves_mechanism(const cattaneo::ReducedProblem &problem, const Eigen::VectorXd &motion,
                      const Eigen::VectorXd &clamped_forces);

} // namespace cattaneo_test
