#include "wear/wear_read_outs.hpp"

#include "common/run.hpp"

#include <algorithm>
#include <limits>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

ReducedProblem with_gap(ReducedProblem problem, const VectorXd &depth)
{
   problem.gap += depth;
   return problem;
}

void warn_of_depth(const ReducedProblem &problem, const VectorXd &depth,
                   const ContactState &contact)
{
   Index deepest = 0;
   const double most = depth.maxCoeff(&deepest);
   for (const ContactChain &chain : problem.chains)
   {
      if (deepest < chain.first || deepest >= chain.first + chain.nodes) { continue; }
      double from = problem.arc_length[deepest], to = from;
      for (Index i = chain.first; i < chain.first + chain.nodes; ++i)
      {
         if (depth[i] <= 0 && contact.p[i] <= 0) { continue; }
         from = std::min(from, problem.arc_length[i]);
         to = std::max(to, problem.arc_length[i]);
      }
      if (most <= 0.1 * (to - from)) { return; }
      warn(text("the largest depth, %.3g, is not small against the length that touches or is "
                "worn, %.3g, but the stiffness is that of the unworn bodies. If the units are "
                "scaled (E = 1), scale both back before you compare them",
                most, to - from));
   }
}

namespace
{

/// The place, outward from a node, at which positive values first fall to zero; the end of the
/// chain if they do not.
double crossing(const VectorXd &s, const VectorXd &value, Index from, int way)
{
   for (Index i = from; i + way >= 0 && i + way < s.size(); i += way)
   {
      if (value[i] > 0 && value[i + way] <= 0)
      {
         return s[i] + (s[i + way] - s[i]) * value[i] / (value[i] - value[i + way]);
      }
   }
   return s[way > 0 ? s.size() - 1 : 0];
}

/// Pressure in the middle of a zone, from the nodes on both sides of the middle.
double pressure_amid(const ReducedProblem &problem, const VectorXd &p, const Zone &zone)
{
   const VectorXd &s = problem.arc_length;
   const double middle = 0.5 * (zone.from.position + zone.to.position);
   Index i = zone.first;
   while (i < zone.last && s[i + 1] < middle) { ++i; }
   if (i == zone.last || s[i] >= middle) { return p[i]; }
   return p[i] + (p[i + 1] - p[i]) * (middle - s[i]) / (s[i + 1] - s[i]);
}

/// The widest stick zone. Of zones that are equally wide within round-off it is the one with
/// the largest pressure in its middle.
Zone widest_stick(const ReducedProblem &problem, const VectorXd &p, std::vector<Zone> all)
{
   const Zone widest = stick_zone(problem, all);
   const auto width = [](const Zone &zone) { return zone.to.position - zone.from.position; };
   const auto rivals = [&](const Zone &zone)
   { return zone.state == NodeState::stick && width(zone) >= (1 - 1e-6) * width(widest); };
   double most = -std::numeric_limits<double>::infinity();
   for (const Zone &zone : all)
   {
      if (rivals(zone)) { most = std::max(most, pressure_amid(problem, p, zone)); }
   }
   const auto less = [&](const Zone &zone)
   { return rivals(zone) && pressure_amid(problem, p, zone) < most - 1e-9 * std::abs(most); };
   all.erase(std::remove_if(all.begin(), all.end(), less), all.end());
   return stick_zone(problem, all);
}

} // namespace

void report_end(Study &study, const WearCase &scene, const WornOut &end, bool of_pad,
                Panel &profiles, Panel &pressures)
{
   const auto unit = [&](const char *name) { return of_pad ? name : ""; };
   study.title("Worn out");
   study.results["worn_out"] = name(end.status);
   if (end.status != FrictionStatus::converged)
   {
      study.results["worn_out_message"] = end.message;
      return study.say("   none: " + end.message);
   }
   if (end.searches == 0)
   {
      study.value("final_volume", 0, "worn out: volume");
      study.value("final_depth", 0, "worn out: largest depth");
      return study.say("   no node slips in a cycle, so nothing wears");
   }
   const ReducedProblem &problem = scene.problem;
   const VectorXd p = tractions(problem, end.contact.p);
   const Zone stick = widest_stick(problem, p, zones(problem, end.unworn, end.range));
   // If there are several lines, the line with the widest stick zone.
   Index begin = 0, nodes = problem.nodes();
   for (const ContactChain &chain : problem.chains)
   {
      if (stick.first < chain.first || stick.first >= chain.first + chain.nodes) { continue; }
      begin = chain.first;
      nodes = chain.nodes;
   }
   const VectorXd s = problem.arc_length.segment(begin, nodes),
                  overlap = end.overlap.segment(begin, nodes);
   study.value("final_stick", half_width(stick), "worn out: half-width that sticks",
               read_out_error(stick), unit("a"));
   Index first = nodes - 1, last = 0;
   for (Index i = 0; i < nodes; ++i)
   {
      if (!end.stick[begin + i] && overlap[i] <= 0) { continue; }
      first = std::min(first, i);
      last = std::max(last, i);
   }
   study.value("final_extent",
               0.5 * (crossing(s, overlap, last, 1) - crossing(s, overlap, first, -1)),
               "worn out: half-width that is worn or sticks", none, unit("a"));
   study.value("final_volume", worn_volume(problem, end.depth), "worn out: volume", none,
               unit("a³/R"));
   study.value("final_depth", end.depth.maxCoeff(), "worn out: largest depth", none,
               unit("a²/R"));
   study.value("final_pressure_centre", pressure_amid(problem, p, stick),
               "worn out: pressure in the middle of the stick zone", none, unit("P/a"));
   study.value("final_loss", settled(end.loss, 1),
               "worn out: loss of a cycle over that of the unworn contact");
   study.results["final_depths"] =
      std::vector<double>(end.depth.data(), end.depth.data() + end.depth.size());
   const VectorXd x = problem.arc_length.array() - scene.middle;
   profiles.add("worn out", x, end.depth, "dashed");
   pressures.add("worn out", x, p, "dashed");
}

void draw_loop(Panel &panel, const std::string &label, const WearCase &scene,
               const WearState &state, MarchSettings settings)
{
   const ReducedProblem worn = with_gap(scene.problem, state.depth);
   LoadHistory cycle = scene.history;
   cycle.cycles = 1;
   settings.increments = std::max(settings.increments, 20);
   ContactState contact = state.contact;
   contact.time = cycle.times[cycle.cycle_start];
   IncrementRecord start = record_of(worn, contact);
   start.cycle = 0; // the loop begins at this state
   MarchReport report = march(worn, cycle, contact, settings);
   report.increments.insert(report.increments.begin(), start);
   add_loops(panel, worn, report, ", " + label);
}

} // namespace miniapp
