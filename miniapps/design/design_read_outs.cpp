#include "design/design_read_outs.hpp"

#include "common/run.hpp"

#include <algorithm>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// The history of a case with the changes by the variables.
LoadHistory with_variables(const DesignProblem &problem, const DesignCase &of,
                           const VectorXd &x)
{
   LoadHistory history = of.history;
   for (Index j = 0; j < x.size(); ++j)
   {
      const MatrixXd &change = problem.variables[j].multipliers;
      if (change.size() > 0) { history.multipliers += x[j] * change; }
   }
   return history;
}

/// The result of a case, by a march alone.
struct Marched
{
   double peak = 0, lost = 0; ///< in the states at the points that count, and between them
   double density = 0;        ///< largest loss of a node per area
   VectorXd densities;        ///< of all nodes with a weight
   ContactState at_peak;

   double of(const std::string &goal) const
   {
      return goal == "pressure" ? peak : goal == "energy" ? density : lost;
   }
};

Marched march_case(const DesignProblem &problem, const VectorXd &x, const DesignCase &of,
                   MarchSettings settings)
{
   settings.stop_at_steady_state = false;
   const ReducedProblem with = problem.with(x);
   const MarchTrace trace = trace_march(with, with_variables(problem, of, x), settings);
   const double end = of.history.times[of.history.times.size() - 1], from = of.from;
   Marched result;
   if (trace.report.time < end)
   {
      result.peak = result.lost = result.density = none;
      return result;
   }
   for (double time : of.history.times)
   {
      const ContactState &state = trace.states[trace.at(time)].state;
      const double peak = tractions(with, state.p).maxCoeff();
      if (time == from) { result.lost = -state.dissipation; }
      if (time < from || (result.at_peak.p.size() > 0 && peak <= result.peak)) { continue; }
      result.peak = peak;
      result.at_peak = state;
   }
   result.lost += trace.states.back().state.dissipation;
   const std::vector<Response> all =
      densities(with, Responses(with, trace), {trace.at(from), trace.last()});
   result.densities.resize(static_cast<Index>(all.size()));
   std::transform(all.begin(), all.end(), result.densities.begin(),
                  [](const Response &each) { return each.value; });
   result.density = result.densities.maxCoeff();
   return result;
}

} // namespace

std::vector<Response> densities(const ReducedProblem &problem, const Responses &of,
                                const std::vector<std::size_t> &states)
{
   std::vector<Response> all;
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      const double weight = problem.weights[i];
      if (weight <= 0) { continue; }
      all.push_back(1 / weight * of.dissipation(states.front(), states.back(), i));
   }
   return all;
}

void report_event(Study &study, const DesignProblem &problem, const VectorXd &x,
                  MarchSettings settings)
{
   settings.stop_at_steady_state = false;
   const ReducedProblem with = problem.with(x);
   for (const DesignCase &load_case : problem.cases)
   {
      const MarchReport march =
         trace_march(with, with_variables(problem, load_case, x), settings).report;
      if (march.status == FrictionStatus::converged ||
          march.status == FrictionStatus::not_unique)
      {
         continue;
      }
      const NamedLoads loads = named(with, march.event_multipliers);
      study.results["event_time"] = march.event_time;
      study.results["event_loads"] = loads;
      return study.say("   that is at " + event_text(march.event_time, loads));
   }
}

VectorXd places(const ReducedProblem &problem)
{
   const VectorXd &s = problem.arc_length;
   return s.array() - 0.5 * (s.minCoeff() + s.maxCoeff());
}

void report_cases(Study &study, const DesignProblem &problem, const DesignReport &report,
                  const DesignVariables &variables, const std::string &goal,
                  const MarchSettings &settings)
{
   const ReducedProblem &flat = problem.problem;
   const Index n = flat.nodes();
   const VectorXd x = places(flat);
   Panel &pressures = study.lines("pressure", "Pressure where it is largest", "x", "p");
   Panel *energies = nullptr;
   if (goal == "energy")
   {
      energies = &study.lines("energy", "Energy lost in the cycle", "x", "per area");
   }
   ResultTable &table = study.table("cases", {{"case", "case"},
                                              {"peak_before", "peak before", "%.6g"},
                                              {"peak_after", "after", "%.6g"},
                                              {"lost_before", "lost before", "%.4g"},
                                              {"lost_after", "after", "%.4g"},
                                              {"density_before", "per area", "%.4g"},
                                              {"density_after", "after", "%.4g"}});
   for (const DesignCase &load_case : problem.cases)
   {
      const Marched before = march_case(problem, variables.start, load_case, settings),
                    after = march_case(problem, report.x, load_case, settings);
      study.row(table, {load_case.name, before.peak, after.peak, before.lost, after.lost,
                        before.density, after.density});
      if (before.at_peak.p.size() > 0) // if the first start has an equilibrium
      {
         pressures.add(load_case.name + ", before", x, tractions(flat, before.at_peak.p),
                       "dashed");
      }
      pressures.add(load_case.name + ", after", x, tractions(flat, after.at_peak.p));
      if (energies && before.densities.size() == n && after.densities.size() == n)
      {
         energies->add(load_case.name + ", before", x, before.densities, "dashed");
         energies->add(load_case.name + ", after", x, after.densities);
      }
   }
}

void draw_lines(Study &study, const DesignProblem &problem, const DesignReport &report,
                const DesignVariables &variables, const std::string &goal,
                const MarchSettings &settings, int steps)
{
   Panel &panel = study.lines("lines", "Along each variable, others optimal", "variable",
                              goal + ", weighted");
   double best = report.objective;
   for (Index j = 0; j < report.x.size(); ++j)
   {
      std::vector<double> at, values;
      for (int k = 0; k <= steps; ++k)
      {
         VectorXd x = report.x;
         x[j] = problem.low[j] + (problem.high[j] - problem.low[j]) * k / steps;
         if (violated_limit(problem, x) >= 0) { continue; }
         VectorXd of(problem.cases.size());
         for (std::size_t c = 0; c < problem.cases.size(); ++c)
         {
            const DesignCase &load_case = problem.cases[c];
            of[static_cast<Index>(c)] =
               load_case.weight * march_case(problem, x, load_case, settings).of(goal);
         }
         const double value = !of.allFinite()                             ? none
                              : problem.goal == DesignGoal::least_largest ? of.maxCoeff()
                                                                          : of.sum();
         at.push_back(x[j] + variables.before[j]);
         values.push_back(std::abs(value));
         if (value < best) { best = value; }
      }
      panel.add(variables.names[j], at, values);
      panel.add("", {report.x[j] + variables.before[j]}, {std::abs(report.objective)},
                "points");
   }
   // If the loss goes to zero, its change is measured by the loss at the start.
   const double size =
      std::max(std::abs(report.objective), std::abs(report.objective_at_start));
   study.value("best_of_lines", (report.objective - best) / size,
               "how much better any point of these lines is");
}

} // namespace miniapp
