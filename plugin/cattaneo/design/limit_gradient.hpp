#pragma once

#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/shakedown/limit.hpp>

namespace cattaneo
{

/// Derivatives of a shakedown limit by the data of its problem.
struct LimitGradient
{
   bool found = false;        ///< the derivatives are known
   std::string message;       ///< why not
   Eigen::VectorXd friction;  ///< by f of each node, size n; of a friction limit, none
   Eigen::VectorXd constant;  ///< by the constant multiplier of each pattern
   Eigen::MatrixXd varying;   ///< by the varying one at each vertex, patterns × vertices
   double load_factor = 0;    ///< of a friction limit: by its load factor
   Eigen::VectorXd gap;       ///< by the gap that the closed contact bridges, size n
   Eigen::VectorXd stiffness; ///< by each StiffnessChange
};

/** Derivatives of load_limit(). The multipliers of its programme are the mechanism {s_j; o_j}
    that proves the upper bound. They tell how each datum changes the limit (the envelope
    theorem; the slip v is the best one):

        dλ = Σ_j [ Σ_i |s_ij| p_ij df_i + s_jᵀ dq_j + o_jᵀ dp_j ],

    with the forces q_j, p_j at vertex j. Derivatives by the stiffness keep v, because λ does
    not change with v in first order. The relative error is about the square root of that of the
    limit, because slip and mechanism have errors of that order. Where there are several
    mechanisms derivatives are one-sided, and these belong to one of them. Derivatives by the
    gap are those by a gap that is already closed, which absorb_gap() has made a load.

    `found` is false if the limit is not known from either side. InputError for sizes that do
    not fit. */
LimitGradient load_limit_gradient(const LimitProblem &problem, const LimitReport &limit,
                                  const std::vector<StiffnessChange> &stiffness = {});

/// Derivatives of friction_limit() by each datum: how much the friction must change, equally at
/// all nodes, to compensate for the change of the mechanism's work that the datum causes.
LimitGradient friction_limit_gradient(const LimitProblem &problem, double load_factor,
                                      const LimitReport &limit,
                                      const std::vector<StiffnessChange> &stiffness = {});

} // namespace cattaneo
