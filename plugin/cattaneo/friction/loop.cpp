#include <algorithm>
#include <cattaneo/friction/energy.hpp>
#include <cattaneo/friction/loop.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

Eigen::VectorXd conjugates(const ReducedProblem &problem, const ContactState &state)
{
   const auto count = static_cast<Eigen::Index>(problem.patterns.size());
   require(state.multipliers.size() == count && state.v.size() == problem.slips() &&
              state.w.size() == problem.nodes(),
           "conjugates: the state has ", state.w.size(), " nodes and ",
           state.multipliers.size(), " load multipliers, must have ", problem.nodes(), " and ",
           count, " as the reduced problem");
   Eigen::VectorXd result = Eigen::VectorXd::Zero(count);
   if (problem.knows_loads()) { result = problem.H * state.multipliers; }
   for (Eigen::Index k = 0; k < count; ++k)
   {
      const LoadPattern &pattern = problem.patterns[k];
      result[k] += (pattern.control == Control::force ? -1 : 1) * work(pattern, state);
   }
   return result;
}

Loop::Point Loop::point(double multiplier, double conjugate) const
{
   return control_ == Control::force ? Point{multiplier, conjugate}
                                     : Point{conjugate, multiplier};
}

Loop::Loop(Control control, double multiplier, double conjugate, bool whole)
   : control_(control), whole_(whole), least_(point(multiplier, conjugate)), most_(least_),
     last_(least_)
{
}

void Loop::add(double multiplier, double conjugate)
{
   const Point next = point(multiplier, conjugate);
   work_ += 0.5 * (last_.force + next.force) * (next.displacement - last_.displacement);
   last_ = next;
   least_ = {std::min(least_.force, next.force),
             std::min(least_.displacement, next.displacement)};
   most_ = {std::max(most_.force, next.force), std::max(most_.displacement, next.displacement)};
}

bool Loop::swings() const
{
   return whole_ && (control_ == Control::force ? force_range() : displacement_range()) > 0;
}

double Loop::stiffness() const
{
   return swings() ? force_range() / displacement_range() : std::nan("");
}

double Loop::loss_factor() const
{
   const double product = force_range() * displacement_range();
   return swings() && product > 0 ? 4 * work_ / (M_PI * product) : std::nan("");
}

} // namespace cattaneo
