#include <cattaneo/readout/places.hpp>
#include <limits>

namespace cattaneo
{

Eigen::Vector2d place_along(const ReducedProblem &problem, const ContactChain &chain, double at)
{
   if (problem.position.rows() != problem.nodes() || problem.position.cols() < 2)
   {
      return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
   }
   const Eigen::VectorXd arc = problem.arc_length.segment(chain.first, chain.nodes);
   const auto place = [&](Eigen::Index i) -> Eigen::Vector2d
   { return problem.position.row(chain.first + i).head(2); };
   const Eigen::Index last = chain.nodes - 1;
   if (last == 0) { return place(0); }
   if (chain.loop && (at < arc[0] || at > arc[last]))
   {
      // The straight line from the last node to the first one.
      const double length = (place(0) - place(last)).norm(),
                   share = (at < arc[0] ? length + at - arc[0] : at - arc[last]) / length;
      if (share >= 0 && share <= 1) { return place(last) + share * (place(0) - place(last)); }
      at += at < arc[0] ? arc[last] - arc[0] + length : arc[0] - arc[last] - length;
   }
   Eigen::Index i = 0;
   while (i + 1 < last && arc[i + 1] < at) { ++i; }
   return place(i) + (at - arc[i]) / (arc[i + 1] - arc[i]) * (place(i + 1) - place(i));
}

} // namespace cattaneo
