#include "two_lines.hpp"

namespace cattaneo_test
{

cattaneo::ReducedProblem twice(const cattaneo::ReducedProblem &one)
{
   using Eigen::Index;
   using Eigen::MatrixXd;
   using Eigen::VectorXd;
   const Index n = one.nodes();
   cattaneo::ReducedProblem two = one;
   std::vector<Index> rows[2];
   for (const Index k : {0, 1})
   {
      for (Index i = 0; i < 2 * n; ++i)
      {
         rows[k].push_back(i < n ? i + k * n : i + n + k * n);
      }
   }
   two.K = MatrixXd::Zero(4 * n, 4 * n);
   const Index motions = one.rigid_motions.cols();
   two.rigid_motions = MatrixXd::Zero(4 * n, 2 * motions);
   for (const Index k : {0, 1})
   {
      two.K(rows[k], rows[k]) = one.K;
      two.rigid_motions(rows[k], Eigen::seqN(k * motions, motions)) = one.rigid_motions;
   }
   const auto join = [](const VectorXd &first, const VectorXd &second)
   {
      VectorXd all(first.size() + second.size());
      all << first, second;
      return all;
   };
   for (auto &pattern : two.patterns)
   {
      pattern.q = join(pattern.q, pattern.q);
      pattern.p = join(pattern.p, pattern.p);
   }
   two.H = 2 * one.H;
   two.gap = join(one.gap, one.gap);
   two.friction = join(one.friction, one.friction);
   two.weights = join(one.weights, one.weights);
   two.arc_length = join(one.arc_length, one.arc_length.array() + 100);
   two.position = one.position.replicate(2, 1);
   two.dofs = one.dofs.replicate(2, 1);
   two.chains.push_back(one.chains[0]);
   two.chains[1].first = n;
   two.chains[1].interface = "\"other\"";
   return two;
}

} // namespace cattaneo_test
