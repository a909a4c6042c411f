#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/load_history.hpp>

namespace cattaneo
{

/** A polygonal load cycle: the multipliers of the load patterns at vertex j are

       constant + λ varying.col(j)

    and vary linearly from each vertex to the next, from the last back to the first. λ is the
    load factor of the shakedown theorems. The conditions of no slip and no separation are
    convex in the loads, so that only the vertices matter to a limit. */
struct LoadCycle
{
   Eigen::VectorXd constant; ///< one entry for each load pattern, in their order
   Eigen::MatrixXd varying;  ///< patterns × vertices

   /// By names: a constant load, and the varying one at each vertex. through(problem, {{"P",
   /// 1}},
   /// {{{"Q", 1}}, {{"Q", -1}}}) holds P and cycles Q to and fro. InputError on an unknown
   /// name.
   static LoadCycle through(const ReducedProblem &problem, const NamedLoads &constant,
                            const std::vector<NamedLoads> &vertices);

   /// Number of vertices.
   Eigen::Index vertices() const { return varying.cols(); }

   /// The multipliers at every vertex, patterns × vertices.
   Eigen::MatrixXd multipliers(double load_factor) const;

   /// A load history through the points, then through so many cycles: through the vertices and
   /// back to the first one, or to the point before them if the cycle starts there.
   LoadHistory history(double load_factor, std::vector<Eigen::VectorXd> opening,
                       bool from_opening, int cycles) const;

   /// InputError unless the cycle fits the patterns of @a problem, is finite and has a vertex.
   void validate(const ReducedProblem &problem) const;
};

/** Thesis 4.3, figure 4.6: pattern @a held at the constant multiplier @a load, pattern @a
    cycled between λ and R λ. R = @a reversal, -1 ≤ R ≤ 1 (4.24). InputError on an unknown
    pattern. */
LoadCycle held_and_cycled(const ReducedProblem &problem, const std::string &held, double load,
                          const std::string &cycled, double reversal);

/// The forces that the loads of each vertex leave on the stuck contact nodes: `constant + λ
/// varying`.
struct StuckForces
{
   Eigen::MatrixXd q0; ///< tangential, constant part, c·n × vertices
   Eigen::MatrixXd q1; ///< tangential, times λ
   Eigen::MatrixXd p0; ///< normal (compression positive), constant part, n × vertices
   Eigen::MatrixXd p1; ///< normal, times λ

   /// Number of vertices.
   Eigen::Index vertices() const { return q0.cols(); }
   /// Tangential forces at a load factor, c·n × vertices.
   Eigen::MatrixXd q(double load_factor) const { return q0 + load_factor * q1; }
   /// Normal forces at a load factor, n × vertices.
   Eigen::MatrixXd p(double load_factor) const { return p0 + load_factor * p1; }
};

/// InputError as LoadCycle::validate().
StuckForces stuck_forces(const ReducedProblem &problem, const LoadCycle &cycle);

} // namespace cattaneo
