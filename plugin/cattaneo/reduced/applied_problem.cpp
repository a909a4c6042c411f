#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/applied_problem.hpp>

namespace cattaneo
{

void AppliedProblem::validate() const
{
   const Eigen::Index n = nodes();
   require(n > 0 && friction.size() == n && diagonal.size() == 2 * n, "applied problem: ", n,
           " gaps, ", friction.size(), " friction coefficients and ", diagonal.size(),
           " diagonal entries, must be n, n and 2n");
   require(static_cast<bool>(apply), "applied problem: there is nothing that applies it");
   require(gap.allFinite(), "applied problem: a gap is not finite");
   require(friction.allFinite() && friction.minCoeff() >= 0, "applied problem: friction is ",
           friction.minCoeff(), ", must be finite and not negative");
   require(diagonal.allFinite() && diagonal.minCoeff() > 0,
           "applied problem: a diagonal entry is ", diagonal.minCoeff(),
           ", must be finite and positive");
   require(!formed || formed->nodes() == n, "applied problem: ", n, " nodes, ",
           formed ? formed->nodes() : 0, " in the stiffness that was formed, must be as many");
   for (const LoadPattern &pattern : patterns)
   {
      require(pattern.q.size() == n && pattern.p.size() == n && pattern.q.allFinite() &&
                 pattern.p.allFinite(),
              "applied problem: load pattern '", pattern.name, "' has ", pattern.q.size(),
              " tangential and ", pattern.p.size(), " normal forces, must be ", n,
              " of each, all finite");
   }
}

AppliedProblem applied(const ReducedProblem &problem)
{
   problem.validate();
   require(problem.components() == 1, "applied problem: the reduced problem has ",
           problem.components(), " tangential components a node, must have 1");
   AppliedProblem result;
   const Eigen::MatrixXd S = problem.K;
   result.apply = [S](const Eigen::VectorXd &u) -> Eigen::VectorXd { return S * u; };
   result.diagonal = S.diagonal();
   result.patterns = problem.patterns;
   result.gap = problem.gap;
   result.friction = problem.friction;
   return result;
}

} // namespace cattaneo
