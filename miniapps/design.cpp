//  design: finds the profile with the least pressure, or with the most or least energy loss
//
//  A pad |x| < a of a half-plane's material (no mesh, P = a = 1, E* = 4/π), or the square
//  punch on a half-plane (a = E' = 1), is flat at first. It is given a gap: free at every
//  node, a crown of few powers of x/a, or rounded, that is flat for |x| < b and of radius R
//  beyond. The goal is the smallest peak pressure under all loads (for a single load the
//  solution is the punch of uniform pressure). For a cycle of Q between ±f P times --amplitude
//  the goal is the smallest or the largest energy loss, or the smallest peak of the loss per
//  area (energy, a criterion of fretting). The gap and its curvature may have limits. With
//  --coat the program chooses the friction in zones instead of the gap. For a saved reduced
//  problem (--reduced, in its own units, through a history of your own) it can also choose
//  loads whose sum is constant (--choose): the pretensions of a row of bolts, and so where
//  bolts are needed at all. --save writes the designed problem. An optimum is a local one;
//  --starts searches from other places too: docs/design.md.
//
//  Sample runs:
//    design
//    design --scene punch --profile crown --amplitude 0.5 --lines 8
//    design --profile crown --loads "0.3 1" --weights "2 1" --lines 24
//    design --curvature 0.3 --nodes 41
//    design --profile crown --powers 2 --goal damping --amplitude 0.8 --lines 8
//    design --profile rounded --lines 24
//    design --scene punch --coat "0.2 0.8" --goal loss --amplitude 0.5 --lines 8
//    design --case problems/bolt_row.case.json

#include "common/run.hpp"
#include "common/watch.hpp"
#include "design/design_choice.hpp"
#include "design/design_read_outs.hpp"
#include "design/design_scene.hpp"

#include <cattaneo/design/design.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

using namespace cattaneo;
using namespace miniapp;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// The profile under which P presses |x| < 1 uniformly, E* = 4/π.
double uniform_profile(double x, double P)
{
   const auto part = [](double s) { return s > 0 ? s * std::log(s) : 0.0; };
   return P / 4 * (part(1 + x) + part(1 - x));
}

/// The best design from all starts, with a table of the starts if there are several.
DesignReport search(Study &study, const DesignProblem &problem, const VectorXd &start,
                    int starts, DesignSettings settings)
{
   Watch watch("design");
   settings.march.monitor = watch.monitor();
   std::vector<VectorXd> from = {start};
   for (const VectorXd &other : spread_starts(problem, start, starts - 1))
   {
      from.push_back(other);
   }
   DesignReport best;
   double at_start = none;
   ResultTable *table = nullptr;
   if (starts > 1)
   {
      table = &study.table("starts", {{"start", "start"},
                                      {"before", "before", "%.6g"},
                                      {"objective", "objective", "%.6g"},
                                      {"design", "design"}});
   }
   for (std::size_t k = 0; k < from.size(); ++k)
   {
      DesignReport report = design(problem, from[k], settings);
      const bool known = !report.traces.empty();
      if (table)
      {
         study.row(*table, {k + 1, known ? std::abs(report.objective_at_start) : none,
                            known ? std::abs(report.objective) : none, name(report.status)});
      }
      const bool better = known && (best.traces.empty() || report.objective < best.objective);
      const bool ends = report.status == DesignStatus::stopped;
      if (k == 0 && known) { at_start = report.objective_at_start; }
      if (k == 0 || better) { best = std::move(report); }
      if (ends)
      {
         best.status = DesignStatus::stopped;
         best.message = "the design was stopped on request";
         break;
      }
   }
   best.objective_at_start = at_start;
   return best;
}

void design_contact(Study &study)
{
   DesignScene chosen;
   DesignChoice choice;
   SteppingOptions stepping;
   int lines = 0, starts = 1;
   DesignSettings settings;
   study.options().group("The contact");
   study.option(&chosen.scene, "scene", "Pad or square punch on a half-plane.",
                {"pad", "punch"});
   study.options().group("Choice and goal");
   study.option(&choice.profile, "profile",
                "Shape of the gap: free at each node, a sum of few powers (crown), or flat "
                "with rounded ends.",
                {"free", "crown", "rounded"});
   study.option(&choice.powers, "powers", "Powers of the crown; odd powers make it asymmetric.",
                within(1, 16));
   study.option(
      &chosen.goal, "goal",
      "pressure: smallest peak pressure. For a cycle: loss, the smallest energy loss; damping, "
      "the largest; or energy, the smallest peak of the loss per area.",
      {"pressure", "loss", "damping", "energy"});
   study.options().group("The loads");
   study.option(&chosen.loads, "loads", "Normal load P of each case.", positive);
   study.option(&chosen.weights, "weights", "Weight of each case; default: 1.", positive);
   study.option(&chosen.shear, "amplitude", "Amplitude of Q/fP.", at_least_below(0, 1));
   study.options().group("The contact");
   study.option(&chosen.friction, "friction",
                "Coefficient of friction; default: 0.3, with --reduced that of the file.",
                positive);
   study.options().group("Choice and goal");
   study.option(
      &choice.most, "most",
      "Largest change of a gap relative to the node that touches (for held bodies: "
      "largest addition to the gap), largest part of each power of the crown, or largest "
      "1/R. With --choose: largest change of a load.",
      positive);
   study.option(&choice.curvature, "curvature",
                "Largest curvature of the gap; default: no limit.", positive);
   study.options().group("The contact");
   study.option(&chosen.nodes, "nodes",
                "Number of contact nodes, one more than a multiple of 4.", at_least(9));
   study.options().group("The loads");
   study.option(&settings.march.increments, "increments",
                "Load increments between two points of the history.", at_least(1));
   stepping.declare(study);
   study.options().group("The search");
   study.option(&settings.tolerance, "optimality-error",
                "Tolerance of the conditions of optimality.", between(0, 1));
   study.option(&lines, "lines", "Steps of a sweep along each variable.", at_least(0));
   study.option(&starts, "starts",
                "Number of searches from different places; the best result is kept.",
                at_least(1));
   study.options().group("A saved problem in place of the scenes");
   study.option(&chosen.file, "reduced", "Reduced problem, in place of the scenes.",
                Text::input);
   study.option(&chosen.history, "history",
                "With --reduced: load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'.",
                Text::statements);
   study.option(&chosen.from, "from",
                "With --reduced: the objective counts points of the history from this time on; "
                "default: the last point.");
   study.option(&choice.loads, "choose",
                "With --reduced: loads that are chosen in place of the gap, as 'bolt 1; bolt "
                "2'. Their sum stays the same, and none falls below zero.");
   study.options().group("Choice and goal");
   study.option(&choice.coat, "coat",
                "Chooses the friction in place of the gap, between these two numbers.",
                not_negative);
   study.option(&choice.zones, "zones",
                "With --coat: number of zones of equal length on each line.", at_least(1));
   study.options().renamed({{"shear", "amplitude"}, {"tolerance", "optimality-error"}});
   study.parse();
   stepping.set(settings.march);
   const bool saved = !chosen.file.empty(), own_gap = choice.what() == "gap",
              free = own_gap && choice.profile == "free";
   study.only_if(saved, {"history", "from"}, "goes with --reduced");
   study.only_if(saved, {"choose"}, "goes with --reduced, the scenes have no loads to choose");
   study.only_if(!saved, {"scene", "loads", "weights", "amplitude", "nodes"},
                 "belongs to the scenes, --reduced has its own contact and --history");
   study.only_if(own_gap, {"profile", "curvature"},
                 "belongs to a gap that is chosen, which --choose and --coat replace");
   study.only_if(!choice.coat.empty(), {"zones"}, "goes with --coat");
   study.only_if(choice.profile == "crown", {"powers"}, "goes with --profile crown");
   study.only_if(!free, {"lines"}, "is not for a free profile, which has too many variables");
   study.only_if(
      choice.loads.empty(), {"lines"},
      "is not for --choose, where the sum of the loads stays and no load changes alone");
   require(!saved || !chosen.history.empty(),
           "option --history is empty, must be the loads of --reduced");
   require(!chosen.cycles() || chosen.shear > 0 || !std::isnan(chosen.from),
           "option --goal is ", chosen.goal,
           ", which needs a cycle: give --amplitude, or with --reduced the option --from");
   if (chosen.weights.empty()) { chosen.weights.assign(chosen.loads.size(), 1.0); }
   require(chosen.weights.size() == chosen.loads.size(), "option --weights has ",
           chosen.weights.size(), " entries, --loads has ", chosen.loads.size());

   require(choice.loads.empty() || choice.coat.empty(),
           "options --choose and --coat cannot be used together: take one of them");

   DesignProblem problem;
   problem.problem = make_problem(study, chosen);
   const ReducedProblem &flat = problem.problem;
   const Index n = flat.nodes();
   const VectorXd x = places(flat);
   choice.begins_flat = !saved;
   problem.cases = make_cases(chosen, flat);
   const DesignVariables variables = choose_variables(problem, choice);
   if (chosen.goal == "energy")
   {
      problem.objective = [&flat](const Responses &of, const std::vector<std::size_t> &states)
      { return densities(flat, of, states); };
   }
   else if (chosen.cycles())
   {
      problem.goal = DesignGoal::least_sum;
      problem.objective = [](const Responses &of, const std::vector<std::size_t> &states)
      { return std::vector<Response>{of.dissipation(states.front(), states.back())}; };
   }

   const DesignReport report = search(study, problem, variables.start, starts, settings);
   study.results["design"] = name(report.status);
   study.results["message"] = report.message;
   study.results["ties"] = report.ties.size();
   if (report.status != DesignStatus::optimal && report.status != DesignStatus::improved)
   {
      study.code = 2;
      study.results["status"] = name(report.status);
   }
   if (report.traces.empty())
   {
      study.say("   no design: " + report.message);
      if (report.status == DesignStatus::no_equilibrium)
      {
         report_event(study, problem, variables.start, settings.march);
      }
      throw Outcome();
   }
   study.save(problem.with(report.x));
   if (report.status != DesignStatus::optimal)
   {
      warn("this is the best design that was tried, but it need not be an optimum: " +
           report.message);
   }
   study.value("objective_at_start", std::abs(report.objective_at_start),
               chosen.goal + " of the start");
   study.value("objective", std::abs(report.objective), chosen.goal + " of the design");
   study.value("stationarity", report.stationarity, "gradient that is left");
   study.value("complementarity", report.complementarity,
               "multipliers times distances to limits");
   study.value("violation", report.violation, "limits violated by");
   study.results["variables"] =
      std::vector<double>(report.x.data(), report.x.data() + report.x.size());
   study.say(text("   %d iterations, %ld marches, %.2g s; %s", report.iterations,
                  report.marches, report.seconds, name(report.status)));

   if (!free)
   {
      ResultTable &table = study.table(
         "chosen",
         {{"variable", "variable"}, {"before", "before", "%.6g"}, {"after", "after", "%.6g"}});
      for (Index j = 0; j < report.x.size(); ++j)
      {
         study.row(table, {variables.names[j], variables.before[j] + variables.start[j],
                           variables.before[j] + report.x[j]});
      }
   }
   const VectorXd gap = problem.with(report.x).gap;
   study.results["gap"] = std::vector<double>(gap.data(), gap.data() + n);
   Panel *profiles = nullptr;
   if (own_gap)
   {
      profiles = &study.lines("profile", "Gap", "x", "gap");
      profiles->add("before", x, flat.gap, "dashed");
      profiles->add("after", x, gap);
   }
   report_cases(study, problem, report, variables, chosen.goal, settings.march);
   const bool sweeps = lines > 0 && report.status != DesignStatus::stopped;
   if (sweeps)
   {
      draw_lines(study, problem, report, variables, chosen.goal, settings.march, lines);
   }
   if (!saved && chosen.scene == "pad" && free && !chosen.cycles() &&
       chosen.loads.size() == 1 && std::isnan(choice.curvature) &&
       uniform_profile(1, chosen.loads[0]) < choice.most)
   {
      const double P = chosen.loads[0];
      const VectorXd exact = x.unaryExpr([P](double at) { return uniform_profile(at, P); });
      profiles->add("uniform pressure", x, exact, "points");
      const VectorXd p = tractions(flat, report.traces[0].states.back().state.p);
      study.value("spread", (p.maxCoeff() - p.minCoeff()) / p.mean(), "p varies by");
      study.value("profile_error", (gap - exact).cwiseAbs().maxCoeff() / exact.maxCoeff(),
                  "largest error of the gap, of its largest");
      study.compare("uniform pressure P/2a", P / 2, {0, 1e-6 * P}, p.maxCoeff());
      study.compare("gap at the ends (P ln 4)/4", exact.maxCoeff(),
                    {0, 0.01 * exact.maxCoeff()}, gap[0]);
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("design", argc, argv, design_contact);
}
