#include "axisymmetric_receding/turning.hpp"

#include <algorithm>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;

double torque(const ReducedProblem &problem, const ContactState &state)
{
   return -problem.position.col(0).dot(state.q.tail(problem.nodes()));
}

NamedLoads Turning::loads(double twist) const
{
   NamedLoads all = pressed_;
   all["twist"] = twist;
   return all;
}

double Turning::rotation(const ContactState &state) const
{
   const ReducedProblem &problem = run_.solver.problem();
   const int k = problem.pattern("twist");
   const LoadPattern &pattern = problem.patterns[k];
   if (pattern.control == Control::displacement) { return state.multipliers[k]; }
   return problem.H.row(k).dot(state.multipliers) - pattern.q.dot(state.v) -
          pattern.p.dot(state.w);
}

Turned Turning::untwisted(const ContactState &loaded) const
{
   const ReducedProblem &problem = run_.solver.problem();
   Turned now;
   now.state = loaded;
   now.stiffness = -problem.position.col(0).dot(
      problem.patterns[problem.pattern("twist")].q.tail(problem.nodes()));
   return now;
}

void Turning::step(Turned &now, double by, const MarchObserver &observe)
{
   const ReducedProblem &problem = run_.solver.problem();
   run_.settings.increments = 1;
   run_.state = now.state;
   run_.march(LoadHistory::through(problem, {loads(now.at), loads(now.at + by)}), observe);
   now.state = run_.state;
   const double before = now.torque;
   now.at += by;
   now.torque = torque(problem, now.state);
   now.greatest = std::max(now.greatest, now.torque);
   now.descended = now.descended || now.torque < before;
   now.stiffness = std::max((now.torque - before) / by, 0.5 * now.stiffness);
}

void Turning::on(Turned &now, Stop stop, double value, const MarchObserver &observe)
{
   // No steps as small as round-off, because their rates would be noise.
   const double enough = (1 - 1e-9) * value;
   while (stop == Stop::torque ? now.torque < enough && !now.descended : now.at < enough)
   {
      double by = limit_ / steps_ / now.stiffness;
      if (stop == Stop::multiplier) { by = std::min(by, value - now.at); }
      Turned next = now;
      step(next, by, observe);
      if (stop == Stop::torque && next.torque > value)
      {
         // The part of the step that meets the value: false position.
         double low = 0, high = by, low_torque = now.torque, high_torque = next.torque;
         while (std::abs(next.torque - value) > 1e-6 * limit_)
         {
            const double part =
               low + (high - low) * (value - low_torque) / (high_torque - low_torque);
            next = now;
            step(next, part, observe);
            (next.torque < value ? low : high) = part;
            (next.torque < value ? low_torque : high_torque) = next.torque;
         }
         now = next;
         return;
      }
      // No round-off in the last step.
      if (stop == Stop::multiplier && by == value - now.at) { next.at = value; }
      now = next;
   }
}

} // namespace miniapp
