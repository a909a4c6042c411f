#pragma once

#include <cattaneo/shakedown/limit.hpp>
#include <functional>
#include <string>

namespace cattaneo
{

/** The convex programme behind every limit (thesis 4.3.2; [Melan 1936]):

       largest θ for which one residual state r, constant in time, leaves every node inside its
       friction cone at every load vertex j,

       |q + a p| ≤ f p + s0 + θ s1,   q = q0_j + θ q1_j + r,   p = p0_j + θ p1_j + M r,

    rigidᵀ r = 0. Coulomb's cones have neither the skew a nor the strengths s. For another law
    each pair of straight pieces of its bounds for slip forward and backward is such a cone. The
    columns of all matrices are the vertices with the first pieces, then with the second ones,
    and so on. With one tangential component it is a linear programme, with two (torsion) a
    second-order cone programme. p ≥ 0 is implied. */
struct ConeProgramme
{
   const ResidualForces *residual = nullptr; ///< not owned
   Eigen::MatrixXd friction;                 ///< f ≥ 0, n × columns
   Eigen::MatrixXd skew;                     ///< a, n × columns; empty: none
   Eigen::MatrixXd strength0, strength1;     ///< s0 and s1, n × columns; empty: none
   StuckForces loads;                        ///< q0, q1, p0, p1 with θ for λ, in columns
   /// Optional bounds r_low ≤ r ≤ r_high, size c·n; none if empty.
   Eigen::VectorXd r_low, r_high;
   /// Leave r out of the tangential forces, so that it only changes pressures.
   bool pressure_only = false;
   double ceiling = 0; ///< θ is searched up to here, in units of theta_scale
   /// Residual forces are searched up to here, in typical forces: if friction can lock the
   /// contact, admissible states have no bound, and the iterates would grow without end.
   double reach = 1e7;

   Eigen::VectorXd force_scale; ///< a typical force of each node, positive, size n
   double theta_scale = 1;      ///< a typical θ, positive

   Eigen::Index nodes() const { return friction.rows(); }
   Eigen::Index components() const { return loads.q0.rows() / friction.rows(); }
   /// The right side of the bounds, f p + s0 + θ s1, and q + a p for the forces {q; p}.
   Eigen::MatrixXd bound(double theta, const Eigen::MatrixXd &p) const;
   Eigen::MatrixXd skewed(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p) const;
};

/// The cones of the friction of a problem under @a loads; residual forces and scales are left
/// open. InputError for a law that is not concave, because a condition that holds at two
/// vertices need not hold between them.
ConeProgramme friction_cones(const ReducedProblem &problem, const StuckForces &loads);

/// Motions dual to the cones, for every column: `limit` ≥ |slip| multiplies the bound.
struct ConeMechanism
{
   Eigen::MatrixXd slip;  ///< c·n × columns
   Eigen::MatrixXd limit; ///< n × columns

   /// f limit + a slip, the factor of p.
   Eigen::MatrixXd opening(const ConeProgramme &programme) const;
   /// The same as motions at the load vertices; `vertices` is their number.
   CollapseMechanism at_vertices(const ConeProgramme &programme, Eigen::Index vertices) const;
};

struct ConeSettings
{
   int max_iterations = 300;
   /// Stopping tolerance of the scaled optimality conditions.
   double tolerance = 1e-10;
   /// Every cone is narrowed by this share of the node's typical force, so that the solution
   /// stays inside in spite of rounding and small violations by the solver.
   double margin = 1e-10;
   /// Called in every iteration with its number; false ends it with the present point.
   std::function<bool(int)> goes_on;
};

/// Start of the solver: a residual state and, from an earlier solution, its mechanism.
struct ConeStart
{
   double theta = 0;
   Eigen::VectorXd r;       ///< empty: zero
   ConeMechanism mechanism; ///< empty: none, a cold start
};

enum class ConeOutcome
{
   solved,
   ceiling,    ///< θ reaches the ceiling
   infeasible, ///< no residual state is inside all cones, whatever θ
   failed,
   stopped,    ///< by ConeSettings::goes_on
   unavailable ///< built without Ipopt
};

struct ConeSolution
{
   ConeOutcome outcome = ConeOutcome::failed;
   std::string message;
   double theta = 0;
   Eigen::VectorXd r; ///< residual tangential forces, c·n
   ConeMechanism mechanism;
   int iterations = 0;
};

ConeSolution solve(const ConeProgramme &programme, const ConeSettings &settings,
                   const ConeStart &start);
/// The same for a programme with two tangential components and no bounds of r, by interior
/// points of its cones. Their equations are dense, and as many as r has entries, however many
/// vertices there are.
ConeSolution solve_by_interior_points(const ConeProgramme &programme,
                                      const ConeSettings &settings, const ConeStart &start);

/// How the round-off of the forces is counted.
enum class Rounding
{
   ignored,
   against,  ///< largest, to the unsafe side: forces that are admissible even so are proven to
             ///< be
   in_favour ///< to the safe side: forces that violate even so violate by more than round-off
};

/// Contact forces at each load vertex (column) if the contact is stuck after a given residual
/// slip.
struct SlippedForces
{
   Eigen::MatrixXd q;                ///< tangential forces
   Eigen::MatrixXd p;                ///< normal forces
   Eigen::MatrixXd q_error, p_error; ///< bounds of their round-off; 0 if ignored
};

SlippedForces slipped_forces(const ReducedProblem &problem, const StuckForces &loads,
                             double theta, const Eigen::VectorXd &slip, Rounding rounding);

/// Largest (|q + a p| - f p - s) / force scale over all nodes and columns: at most 0 inside
/// every cone.
/// Plain arithmetic from the slip and the matrices of the reduced problem.
double worst_violation(const ConeProgramme &programme, const ReducedProblem &problem,
                       double theta, const Eigen::VectorXd &slip,
                       Rounding rounding = Rounding::ignored);

/** A proven upper bound of θ by weak duality. For motions with A Σslip + Bᵀ Σopening = 0,
    summed over the columns, limit ≥ |slip| and opening = f limit + a slip, each admissible
    state does work

       0 ≤ Σ_j limit·(f p + s) + slip·(q + a p)
         = Σ_j opening·(p0 + θ p1) + slip·(q0 + θ q1) + limit·(s0 + θ s1),

    so that θ ≤ W0 / (-W1) if W1 < 0. @a mechanism comes from a solver with small residuals.
    First it is changed to satisfy both conditions to round-off, by the smallest changes in the
    norm of the cones' barrier. This is done twice: from the mechanism as it is given, and after
    it was moved into its cones by the least share of its limits (1e-10 to 1e-5) that leaves
    room for the changes. The smaller of both bounds is used. The remaining residual of the
    first condition, multiplied by @a slip_size, a bound of the slips, is added, and so is the
    round-off of the works. Infinite if W1 ≥ 0 or if the mechanism cannot be repaired. The
    mechanism comes back scaled to W1 = -1. */
double weak_duality_bound(const ConeProgramme &programme, const ReducedProblem &problem,
                          ConeMechanism &mechanism, double slip_size);

} // namespace cattaneo
