// Two tangents: the loads of an increment grow to their full values, while slip is counted from
// the start of the increment.

#include <algorithm>
#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::VectorXd;

/// Newton's steps reach the end of small increments. For each part of the loads they begin
/// where the steps for a smaller part ended. For all parts, slip is counted from the start of
/// the increment, so that the answer is that of one increment.
Search growing_load(Increment &at)
{
   constexpr double least = 1.0 / 64; // step, a share of the loads
   constexpr int most = 24;
   const VectorXd before = at.start.multipliers;
   Increment::Place last{at.u, at.status};
   // Newton's steps have failed with the full change of the loads.
   double done = 0, step = 0.5;
   for (int k = 0; k < most && step >= least; ++k)
   {
      // 1. The next part of the loads, from the end of the last one.
      const double share = std::min(done + step, 1.0);
      if (share == 1)
      {
         at.move_to(last.u, last.status);
         if (newton(at)) { return Search::found; }
         step *= 0.5;
         continue;
      }
      const VectorXd loads = before + share * (at.multipliers - before);
      Increment part(at.system, at.start, loads);
      if (done > 0) { part.move_to(last.u, last.status); }
      // 2. If this fails, half of the step; otherwise up to twice the loads.
      if (!newton(part))
      {
         step *= 0.5;
         continue;
      }
      last = {part.u, part.status};
      done = share;
      step = std::max(2 * step, done);
   }
   return Search::not_here;
}

} // namespace cattaneo
