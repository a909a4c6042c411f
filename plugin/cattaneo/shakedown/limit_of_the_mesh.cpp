#include <algorithm>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
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

Index singular_end(const ReducedProblem &whole, const ClosedContact &part,
                   const StuckForces &stuck)
{
   // Is another node an open one on the contact line of a node?
   const auto opens_next_to = [&](Index node, Index other)
   {
      const auto on = [](const ContactChain &chain, Index i)
      { return i >= chain.first && i < chain.first + chain.nodes; };
      for (const ContactChain &chain : whole.chains)
      {
         if (on(chain, node) && !on(chain, other)) { return false; }
      }
      return std::binary_search(part.open.begin(), part.open.end(), other);
   };
   Index found = -1;
   for (Index i = 0; i < static_cast<Index>(part.closed.size()); ++i)
   {
      const Index node = part.closed[i];
      const bool within = opens_next_to(node, node - 1) || opens_next_to(node, node + 1);
      const double shear = stuck.q1.row(i).cwiseAbs().maxCoeff();
      if (within && shear > 1e-6 * stuck.q1.cwiseAbs().maxCoeff()) { found = i; }
   }
   return found;
}

} // namespace cattaneo
