//  shakedown: when a cyclically sheared contact stops slipping, with a proof on either side
//
//  Chapter 4 of the thesis: a square block, |x| < a, on an elastically similar half-plane is
//  pressed by P and sheared by a Q that goes to and fro between λmin P and λmax P. With which
//  coefficient of friction, or up to which load, does the slip die out? The program gives two
//  estimates; the exact limit (Melan), with bounds that are proven for a contact whose nodes
//  all stay closed; the stick zone of the two bodies joined as one (monolith); and marches in
//  time, which report nodes that open. A limit that is decided where tractions are singular is
//  a limit of the mesh, not of the bodies, and the result says so. Units: a = P = E' = 1, with
//  E' = E/(1-ν²).
//
//  Any contact saved with --save (or save() of a reduced problem) can be used as well: name
//  the load pattern that is held and the one that is cycled. --closed keeps only the nodes
//  that stay closed in a march at the limit, and marches the whole contact on both sides of
//  the limit. With --plot the maps and the marches are made. If the law of friction is not
//  Coulomb's (by --strength, or in the file), only the largest load is found, and the law must
//  never get steeper.
//
//  Sample runs:
//    shakedown
//    shakedown --nodes 101 --find load --friction 1 --load-ratio -1 --march --cycles 30
//    shakedown --nodes 81 --map --adhesion-map
//    shakedown --find friction --tractions --transposed
//    shakedown --find load --loads-over-friction --transposed --lower
//    shakedown --nodes 33 --mesh-study "33 65 101"
//    shakedown --nodes 33 --mismatch "0.1 1 10"
//    shakedown --nodes 33 --find load --mismatch 1 --mismatch-poisson "0.3 0.45"
//    shakedown --obstacle rigid --nodes 65 --friction 0.6 --starts 4
//    shakedown --march --cycles 2
//    shakedown --nodes 33 --find load --strength ".8 .6 2 .9"

#include "shakedown/shakedown_study.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/words.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

void Shakedown::run()
{
   options();
   prepare();
   monolith();
   if (find != "load") { smallest_friction(); }
   if (find != "friction" || march || starts > 0) { largest_of_closed(); }
   if (find != "friction") { largest_load(); }
   draw_optimal();
   if (march) { marches(); }
   if (map) { limit_map(); }
   for (const double n : mesh_study)
   {
      PunchOptions other = punch;
      other.nodes = static_cast<int>(n);
      repeat("mesh_study", other);
   }
   for (const double stiffness : mismatch)
   {
      for (const double poisson : mismatch_poisson)
      {
         PunchOptions other = punch;
         other.half_plane = true;
         other.plane_stiffness = stiffness;
         other.plane_poisson = poisson;
         repeat("mismatch", other);
      }
   }
}

void Shakedown::options()
{
   std::string obstacle = "half-plane";
   study.options().group("The loads and the friction");
   study.option(&friction, "friction",
                "Coefficient of friction, for the largest load and the marches; default: 0.85, "
                "with --reduced that of the file.",
                positive);
   study.option(&lambda_max, "lambda-max",
                "Largest cycled load, for the smallest friction and the marches.", positive);
   study.option(&lambda_min, "lambda-min", "Smallest cycled load.");
   study.option(&reversal, "load-ratio",
                "R = λmin/λmax, instead of --lambda-min: -1 for a load to and fro, 0 for a "
                "pulsating one.",
                Check{[](double R) { return R >= -1 && R <= 1; }, "must be between -1 and 1"});
   study.options().group("Limits, and what is shown of them");
   study.option(&find, "find",
                "The smallest friction for the loads, the largest load for the friction, or "
                "both: friction, load or both.",
                {"friction", "load", "both"});
   study.option(&map, "map",
                "Computes the largest load against friction for several R (figure 4.18); also "
                "with --plot or --html.");
   study.option(&adhesion, "adhesion-map",
                "Computes the friction that prevents all slip under a monotonic load (figure "
                "4.3); also with --plot or --html.");
   study.option(&steps, "tractions",
                "Prints the tractions of the monolith and the steps of the estimates (figures "
                "4.4 to 4.14).");
   study.options().group("Marches");
   study.option(&march, "march",
                "Marches in time from three initial slips (zero, optimal and negative "
                "optimal); their outcome is then that of the run; also with --plot or --html.");
   study.option(&cycles, "cycles", "Largest number of cycles of a march.", at_least(1));
   study.option(
      &starts, "starts",
      "Number of random starts in the search for a start that slips for ever (0: none).",
      not_negative);
   study.options().group("Limits, and what is shown of them");
   study.option(
      &lower_limits, "lower",
      "Also find the load that is proven to shake down from every start, with and without "
      "slip at nodes near the ends.");
   study.option(&load_ratios, "loads-over-friction",
                "Prints the largest loads over f for R = -1 with f = 0.85 and 1, and for R = "
                "-0.5 with f = 0.85 (chapter 4).");
   study.option(
      &transposed, "transposed",
      "The smallest friction, and the ratios of --loads-over-friction, with the block B of the "
      "stiffness transposed, as (4.10) is printed.");
   study.option(&corner, "left-out",
                "Share of the contact length that pointwise figures leave out at each end, "
                "where nodal ratios do not converge.",
                at_least_below(0, 0.5));
   study.option(&mesh_study, "mesh-study",
                "Numbers of contact nodes with which the limits are repeated.");
   study.option(&mismatch, "mismatch",
                "Ratios of the stiffness E' of the half-plane to that of the block, for which "
                "the limits are repeated.",
                positive);
   study.option(
      &mismatch_poisson, "mismatch-poisson",
      "Poisson's ratios of the half-plane for --mismatch (default: that of the block).",
      at_least_below(0, 0.5));
   study.options().group("The contact");
   study.option(&obstacle, "obstacle", "Body below the block: rigid or half-plane.",
                {"rigid", "half-plane"});
   add_options(study, punch);
   study.options().group("The loads and the friction");
   strength.emplace(study);
   study.options().group("A saved problem in place of the punch");
   study.option(&reduced, "reduced", "A saved reduced problem instead of the punch.",
                Text::input);
   study.option(&held, "held", "Load pattern that is held at 1.");
   study.option(&cycled, "cycled", "Load pattern that is cycled.");
   study.option(&closed, "closed",
                "Keep only the nodes that stay closed in three cycles at the largest load "
                "(--lambda-max, or with --find load the limit).");
   study.options().renamed({{"reversal", "load-ratio"},
                            {"load-ratios", "loads-over-friction"},
                            {"corner", "left-out"}});
   study.parse();
   saved = !reduced.empty();
   strength->check();
   study.only_if(!saved,
                 {"obstacle", "poisson", "order", "nodes", "grading", "domain", "tractions",
                  "mesh-study", "mismatch"},
                 "is for the punch, not for a saved problem");
   study.only_if(std::isnan(reversal), {"lambda-min"},
                 "gives the same as --load-ratio: use one of them");
   punch.half_plane = obstacle == "half-plane";
   study.only_if(!mismatch.empty(), {"mismatch-poisson"}, "goes with --mismatch");
   if (mismatch_poisson.empty()) { mismatch_poisson = {punch.poisson}; }
   if (std::isnan(reversal))
   {
      require(std::abs(lambda_min) <= lambda_max, "option --lambda-min is ", lambda_min,
              ", must be from ", -lambda_max, " to ", lambda_max,
              ", the value of --lambda-max. If the most negative load is the larger one, "
              "change all signs");
      reversal = lambda_min / lambda_max;
   }
   results["reversal"] = reversal;
   require(held != cycled, "options --held and --cycled are both '", held,
           "', must be two load patterns");
   if (study.draws()) { map = adhesion = march = true; }
}

void Shakedown::prepare()
{
   if (saved)
   {
      gapped = load_reduced_problem(reduced);
      std::vector<std::string> loads;
      for (const LoadPattern &pattern : gapped.patterns) { loads.push_back(pattern.name); }
      require(loads.size() <= 2 || study.options().says("cycled"), "'", reduced,
              "' has the loads ", listed(loads),
              ": option --cycled must name the one that is cycled, and --held the one that is "
              "held");
   }
   else
   {
      scene = make_punch(punch);
      gapped = scene.problem();
   }
   take_law();
   whole = gapped.gap.isZero(0) ? gapped : absorb_gap(gapped);
   problem = whole;
   if (closed) { keep_closed(lambda_max); }
   set_up();
   if (saved) { study.condensed(gapped, 0); }
   else { study.condensed(scene); }
   study.save(gapped);
   study.value("coupling", limit.coupling, "degree of coupling (0: none, 1: most)");
   study.say(std::string("The limits are those of a contact without separation: ") +
             assumption + ".");
   results["limit_assumption"] = assumption;
   results["contact_nodes"] = problem.nodes();
   standard = !saved && coulomb && punch.half_plane && punch.order > 1 && punch.unbounded();
   results["standard"] = standard;
   // The error of the mesh: the extremes lie between nodes, so it is of second order in their
   // spacing.
   results["mesh_error_estimate"] =
      30.0 / std::pow(static_cast<double>(problem.nodes() - 1), 2);
}

void Shakedown::take_law()
{
   if (strength->given()) { strength->set(gapped); }
   else if (!saved || !std::isnan(friction))
   {
      friction = std::isnan(friction) ? 0.85 : friction;
      set_friction(gapped, friction);
   }
   coulomb = gapped.laws.empty();
   if (coulomb)
   {
      friction = gapped.friction.maxCoeff();
      require(gapped.friction.minCoeff() == friction, "'", reduced,
              "' has coefficients of friction from ", gapped.friction.minCoeff(), " to ",
              friction, ", limits need a single one: give --friction");
      require(friction > 0, "'", reduced, "' has no friction: give --friction");
      results["friction"] = friction;
      return;
   }
   const char *why = "knows Coulomb's law alone, and the contact has another law of friction "
                     "(of --strength, or of its file: --friction takes its place)";
   study.only_if(false, {"map", "mesh-study", "mismatch", "tractions"}, why);
   require(find == "load" || !study.options().says("find"), "option --find is '", find,
           "', must be load: the smallest friction coefficient ", why);
   find = "load";
   map = false;
}

void Shakedown::keep_closed(double load_factor)
{
   Watch watch("march");
   const StayedClosed stayed =
      stay_closed(gapped, cycle_of(gapped, reversal), load_factor, 3, watch.monitor());
   const MarchReport &march = stayed.march;
   if (march.status == FrictionStatus::stopped)
   {
      stopped("the nodes that stay closed were not found yet");
   }
   warn_of_cut_off(march.cut_off);
   require(march.status == FrictionStatus::converged,
           "option --closed: the march ended with status '", name(march.status),
           "': ", march.message);
   part = closed_contact(whole, stayed.nodes);
   problem = part.reduced;
   study.say(text("%zu of %ld nodes stay closed at λ = %g; the limits assume that they do "
                  "and that the others stay open",
                  part.closed.size(), static_cast<long>(whole.nodes()), load_factor));
   results["closed_nodes"] = part.closed.size();
}

void Shakedown::set_up()
{
   cycle = cycle_of(problem, reversal);
   const VectorXd &arc = problem.arc_length;
   const Index n = problem.nodes();
   require(arc.size() == n && problem.weights.size() == n,
           "the reduced problem has no arc length or no weights");
   // In the tables x runs from -a to a.
   x = arc.array() - (saved ? 0.0 : arc[0] + 0.5 * (arc[n - 1] - arc[0]));
   inner = nodes_away_from_ends(problem, corner);
   limit = limit_problem(problem, cycle);
}

void Shakedown::largest_of_closed()
{
   most = largest(limit);
   const int repetitions = closed && find == "load" ? 10 : 0;
   for (int k = 0; k < repetitions && most.status == LimitStatus::certified; ++k)
   {
      const NodeList before = part.closed;
      keep_closed(most.limit);
      if (part.closed == before) { break; }
      set_up();
      most = largest(limit);
   }
}

LoadCycle Shakedown::cycle_of(const ReducedProblem &of, double R) const
{
   NamedLoads constant = {{held, 1}};
   // The forces that close an initial gap always act.
   for (const LoadPattern &pattern : of.patterns)
   {
      if (pattern.name == "gap") { constant["gap"] = 1; }
   }
   return LoadCycle::through(of, constant, {{{cycled, 1}}, {{cycled, R}}});
}

LimitReport Shakedown::largest(const LimitProblem &of, const LimitReport *start)
{
   Watch watch("largest load");
   LimitSettings settings;
   settings.start = start;
   settings.monitor = watch.monitor();
   return counted(load_limit(of, settings));
}

LimitReport Shakedown::smallest(const LimitProblem &of)
{
   Watch watch("smallest friction");
   LimitSettings settings;
   settings.monitor = watch.monitor();
   return counted(friction_limit(of, lambda_max, settings));
}

LimitReport Shakedown::counted(LimitReport report)
{
   study.counters += report.counters;
   if (report.status == LimitStatus::stopped)
   {
      // Before the first programme has ended, nothing is known of the limit.
      if (!(report.lower < report.upper)) { stopped("a limit was not found yet"); }
      results["bound_lower"] = report.lower;
      results["bound_upper"] = report.upper;
      stopped(text("a limit that is proven to lie between %g and %g was not found yet",
                   report.lower, report.upper));
   }
   if (report.status != LimitStatus::certified && report.status != LimitStatus::unlimited)
   {
      study.code = 2;
   }
   return report;
}

void Shakedown::stopped(const std::string &message)
{
   study.say("Stopped: " + message);
   results["status"] = "stopped";
   results["message"] = message;
   throw Outcome();
}

void Shakedown::as_before()
{
   limit.cycle = cycle;
   set_friction(limit.reduced, friction);
}

} // namespace miniapp

int main(int argc, char *argv[])
{
   return miniapp::Study::run("shakedown", argc, argv,
                              [](miniapp::Study &study) { miniapp::Shakedown(study).run(); });
}
