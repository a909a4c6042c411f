#include <algorithm>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;

double share_of_ends(const ReducedProblem &problem, const StuckForces &stuck,
                     const LimitReport &limit, double load_factor)
{
   if (limit.mechanism.slip.size() == 0) { return std::numeric_limits<double>::quiet_NaN(); }
   const Index n = problem.nodes();
   const Eigen::MatrixXd q =
      stuck.q(load_factor).colwise() + Eigen::VectorXd(problem.A() * limit.slip);
   const Eigen::VectorXd &arc = problem.arc_length;
   double at_ends = 0, all = 0;
   for (Index i = 0; i < n; ++i)
   {
      const double from_end = std::min(arc[i] - arc[0], arc[n - 1] - arc[i]);
      for (Index j = 0; j < q.cols(); ++j)
      {
         const auto of_node = Eigen::seqN(i, problem.components(), n);
         const double work =
            std::max(-q(of_node, j).dot(limit.mechanism.slip(of_node, j)), 0.0);
         all += work;
         if (from_end < 0.01 * (arc[n - 1] - arc[0])) { at_ends += work; }
      }
   }
   return at_ends / all;
}

Index singular_end(const ReducedProblem &problem, const StuckForces &stuck)
{
   const double least = 1e-6 * stuck.q1.cwiseAbs().maxCoeff();
   Index found = -1;
   for (const ContactChain &chain : problem.chains)
   {
      for (const std::size_t end : {0, 1})
      {
         const Index node = chain.first + (end == 0 ? 0 : chain.nodes - 1);
         const bool sheared = stuck.q1.row(node).cwiseAbs().maxCoeff() > least;
         if (chain.ends[end] == LineEnd::open && sheared) { found = std::max(found, node); }
      }
   }
   return found;
}

std::string figure_of_the_mesh(bool friction)
{
   return std::string("; this limit ") +
          (friction ? "rises as the spacing of the nodes falls"
                    : "falls with the spacing of the nodes") +
          " and is no limit of the bodies";
}

std::string mesh_statement(const ReducedProblem &problem, const StuckForces &stuck,
                           const LimitReport &limit, double load_factor, bool friction)
{
   const Eigen::VectorXd &arc = problem.arc_length;
   if (!limit.proven() || arc.size() != problem.nodes()) { return ""; }
   const Index end = singular_end(problem, stuck);
   if (end >= 0)
   {
      return "the contact ends at the arc length " + nine_digits(arc[end]) +
             ", inside of its line: there the pressure falls to zero and the stuck shear is "
             "singular" +
             figure_of_the_mesh(friction);
   }
   const double share = share_of_ends(problem, stuck, limit, load_factor);
   if (!(share > 0.2)) { return ""; }
   return std::to_string(std::lround(100 * share)) +
          " % of the mechanism's work is done within 1 % of the ends of the contact line, "
          "where "
          "tractions are singular" +
          figure_of_the_mesh(friction);
}

} // namespace cattaneo
