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
   double load_factor = 0;    ///< of a friction limit: by the load factor it is of
   Eigen::VectorXd gap;       ///< by the gap that the closed contact bridges, size n
   Eigen::VectorXd stiffness; ///< by each StiffnessChange
};

/** Of load_limit(). The programme's own multipliers are the mechanism {s_j; o_j} that proves
    the upper bound, and say what each datum does to the limit (the envelope theorem; the slip v
    is the best one):

        dλ = Σ_j [ Σ_i |s_ij| p_ij df_i + s_jᵀ dq_j + o_jᵀ dp_j ],

    q_j, p_j the forces at vertex j. Derivatives by the stiffness hold v, of which λ does not
    change in first order. The relative error is about the square root of that of the limit, as
    slip and mechanism are known so well; where there are several mechanisms derivatives are
    one-sided, and these are one of them. A gap is one that is already closed, as that which
    absorb_gap() has made a load of.

    `found` is false if the limit is not known from either side. InputError for sizes that do
    not fit. */
LimitGradient load_limit_gradient(const LimitProblem &problem, const LimitReport &limit,
                                  const std::vector<StiffnessChange> &stiffness = {});

/// Of friction_limit(): the friction coefficient, the same at all nodes, that makes up for what
/// a datum does to the work of the mechanism.
LimitGradient friction_limit_gradient(const LimitProblem &problem, double load_factor,
                                      const LimitReport &limit,
                                      const std::vector<StiffnessChange> &stiffness = {});

} // namespace cattaneo
