//  design: the profile that presses least, or loses most or least, found by the program
//
//  A pad |x| < a of a half-plane's material (no mesh, P = a = 1, E* = 4/π), or the square punch
//  on a half-plane (a = E' = 1), flat at first, is given a gap: free at every node, or a crown
//  Σ x_k (x/a)^2k of few terms. Wanted is the least of the largest pressures under all loads,
//  which for one of them is the punch of uniform pressure; or the least, or the most, energy
//  lost in a cycle of Q between ±f P times --shear. Under bounds, and limits of curvature. With
//  --reduced any saved reduced problem, in its own units, through a history of your own; --save
//  writes the designed one. With --choose not its gap but loads of it, whose sum stays: the
//  pretensions of a row of bolts, and where there are bolts at all. An optimum is one among its
//  neighbours: docs/design.md.
//
//  Sample runs:  design
//                design --scene punch --profile crown --shear 0.5 --lines 8
//                design --profile crown --loads "0.3 1" --weights "2 1" --lines 24
//                design --curvature 0.3 --nodes 41
//                design --profile crown --terms 1 --goal damping --shear 0.8 --lines 8
//                design --case problems/bolt_row.case.json

#include "common/hertz_scene.hpp"
#include "common/punch.hpp"
#include "common/run.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/design/design.hpp>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <sstream>

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using miniapp::exact_text;
using miniapp::text;

namespace
{

struct Chosen
{
   std::string scene = "pad", profile = "free", goal = "pressure", file, history, loads_chosen;
   std::vector<double> loads = {1}, weights;
   double shear = 0, friction = miniapp::none, from = miniapp::none, most = 1,
          curvature = miniapp::none;
   int terms = 2, nodes = 65;

   bool loses() const { return goal != "pressure"; }
};

ReducedProblem make_problem(miniapp::Study &study, const Chosen &chosen)
{
   if (!chosen.file.empty())
   {
      ReducedProblem problem = load_reduced_problem(chosen.file);
      if (!std::isnan(chosen.friction)) { set_friction(problem, chosen.friction); }
      require(problem.arc_length.size() > 0 && problem.weights.size() > 0, "'", chosen.file,
              "' has no arc_length or no weights, which a design needs");
      study.condensed(problem, 0);
      return problem;
   }
   require(chosen.nodes % 4 == 1, "option --nodes is ", chosen.nodes,
           ", must be one more than a multiple of 4");
   miniapp::Scene scene;
   // Finer toward the ends, where profiles and pressures are steepest.
   const int elements = chosen.nodes / 2;
   std::vector<double> grid;
   for (int k = 0; k <= elements; ++k) { grid.push_back(-std::cos(M_PI * k / elements)); }
   if (chosen.scene == "pad")
   {
      miniapp::HalfPlanes planes;
      planes.nodes = chosen.nodes;
      planes.material = Material{8 / M_PI * 0.91, 0.3, PlaneState::strain};
      planes.grid = grid;
      scene = make_scene(planes);
      scene.problem().B().setZero(); // equal half-planes: what is there is round-off
      join_coupling(scene.problem());
   }
   else
   {
      miniapp::PunchOptions punch;
      punch.half_plane = true;
      punch.nodes = chosen.nodes;
      punch.grid = grid;
      scene = make_punch(punch);
   }
   ReducedProblem problem = scene.problem();
   problem.gap.setZero();
   set_friction(problem, std::isnan(chosen.friction) ? 0.3 : chosen.friction);
   study.condensed(problem, scene.dofs);
   return problem;
}

std::vector<DesignCase> make_cases(const Chosen &chosen, const ReducedProblem &problem)
{
   const double sign = chosen.goal == "damping" ? -1 : 1;
   if (!chosen.file.empty())
   {
      const LoadHistory history = load_history("history", chosen.history, problem);
      return {{"history", history, sign, chosen.from}};
   }
   std::vector<DesignCase> cases;
   for (std::size_t k = 0; k < chosen.loads.size(); ++k)
   {
      const double P = chosen.loads[k], Q = chosen.shear * problem.friction[0] * P;
      std::vector<NamedLoads> points = {{}, {{"P", P}}};
      if (Q > 0)
      {
         for (double sheared : {Q, -Q, Q}) { points.push_back({{"P", P}, {"Q", sheared}}); }
      }
      cases.push_back({exact_text("P = ", P), LoadHistory::through(problem, points),
                       sign * chosen.weights[k], chosen.loses() ? 2.0 : 1.0});
   }
   return cases;
}

/// Bodies that nothing keeps from moving apart, all nodes alike: only differences of gaps
/// count.
bool moves_apart(const ReducedProblem &problem)
{
   const VectorXd forces = problem.C() * VectorXd::Ones(problem.nodes());
   return forces.cwiseAbs().maxCoeff() <= 1e-6 * problem.C().cwiseAbs().maxCoeff();
}

/// The node amid those with the least gap.
Index touching_node(const VectorXd &x, const VectorXd &gap)
{
   Index node = 0;
   for (Index i = 1; i < gap.size(); ++i)
   {
      const bool as_near = gap[i] == gap[node] && std::abs(x[i]) < std::abs(x[node]);
      if (gap[i] < gap[node] || as_near) { node = i; }
   }
   return node;
}

/// Patterns by their names, separated by semicolons.
std::vector<Index> chosen_loads(const std::string &names, const ReducedProblem &problem)
{
   std::vector<Index> found;
   std::istringstream all(names);
   for (std::string name; std::getline(all, name, ';');)
   {
      const std::size_t from = name.find_first_not_of(" '\""),
                        to = name.find_last_not_of(" '\"");
      name = from == std::string::npos ? "" : name.substr(from, to - from + 1);
      const Index k = problem.pattern(name);
      require(std::find(found.begin(), found.end(), k) == found.end(),
              "option --choose names '", name, "' twice");
      found.push_back(k);
   }
   require(found.size() > 1, "option --choose is '", names,
           "', must be two loads at least, separated by semicolons: their sum stays");
   return found;
}

/** Variables that add to the multipliers of loads wherever one of them acts, so that their sum
    stays: none below zero, none by more than `most`. */
void choose_loads(DesignProblem &problem, const std::vector<Index> &loads, double most)
{
   const MatrixXd M = problem.cases[0].history.multipliers(loads, Eigen::all);
   const auto count = M.rows();
   require(M.minCoeff() >= 0, "option --choose: a load is ", M.minCoeff(),
           " in the history, must not be negative");
   require(M.maxCoeff() > 0,
           "option --choose: its loads are zero in the history, one must act");
   problem.low = VectorXd::Constant(count, -most);
   problem.high = VectorXd::Constant(count, most);
   for (Index j = 0; j < count; ++j)
   {
      Parameters change;
      change.multipliers = MatrixXd::Zero(problem.problem.patterns.size(), M.cols());
      for (Index k = 0; k < M.cols(); ++k)
      {
         if (M.col(k).maxCoeff() == 0) { continue; }
         change.multipliers(loads[j], k) = 1;
         problem.low[j] = std::max(problem.low[j], -M(j, k));
      }
      problem.variables.push_back(std::move(change));
   }
   problem.limits = MatrixXd::Ones(1, count);
   problem.least = problem.most = VectorXd::Zero(1);
}

/// The history of a case with what its variables add.
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

/// What a case comes to, by a march alone.
struct Marched
{
   double peak = 0, lost = 0;
   ContactState at_peak;
};

Marched march_case(const DesignProblem &problem, const VectorXd &x, const DesignCase &of,
                   MarchSettings settings)
{
   settings.stop_at_steady_state = false;
   const ReducedProblem with = problem.with(x);
   const MarchTrace trace = trace_march(with, with_variables(problem, of, x), settings);
   const double end = of.history.times[of.history.times.size() - 1],
                from = std::isnan(of.from) ? end : of.from;
   if (trace.report.time < end) { return {miniapp::none, miniapp::none, {}}; }
   Marched result;
   for (double time : of.history.times)
   {
      const ContactState &state = trace.states[trace.at(time)].state;
      const double peak = tractions(with, state.p).maxCoeff();
      if (time == from) { result.lost = -state.dissipation; }
      if (time < from || peak <= result.peak) { continue; }
      result.peak = peak;
      result.at_peak = state;
   }
   result.lost += trace.states.back().state.dissipation;
   return result;
}

/// Variables of the gap, of nodes or of a crown, at places from the middle of the line.
void choose_gap(DesignProblem &problem, const Chosen &chosen, const VectorXd &x)
{
   const ReducedProblem &flat = problem.problem;
   const Index n = flat.nodes();
   const bool free = chosen.profile == "free";
   // Where bodies can move apart a node that touches stays: only differences of gaps count.
   const bool apart = moves_apart(flat);
   MatrixXd G = MatrixXd::Identity(n, free ? n : chosen.terms);
   if (free && apart)
   {
      const Index node = touching_node(x, flat.gap);
      G.middleCols(node, n - 1 - node) = G.rightCols(n - 1 - node).eval();
      G.conservativeResize(n, n - 1);
   }
   for (Index j = 0; !free && j < G.cols(); ++j)
   {
      G.col(j) = (x / x.cwiseAbs().maxCoeff()).array().square().pow(static_cast<double>(j + 1));
   }
   problem.variables = gap_variables(G);
   problem.low = VectorXd::Zero(G.cols());
   // What begins flat is crowned. What has a gap may also be too round: other nodes come before
   // the one that stays, so that no shape is left out; of bodies that are held, by their gaps.
   if (apart && !chosen.file.empty()) { problem.low.setConstant(-chosen.most); }
   problem.high = VectorXd::Constant(G.cols(), chosen.most);
   if (!std::isnan(chosen.curvature))
   {
      limit_curvature(problem, -chosen.curvature, chosen.curvature);
   }
}

/// The profile under which P presses |x| < 1 uniformly, E* = 4/π.
double uniform_profile(double x, double P)
{
   const auto part = [](double s) { return s > 0 ? s * std::log(s) : 0.0; };
   return P / 4 * (part(1 + x) + part(1 - x));
}

/// The goal along each variable through the optimum: it is to have its least value there.
void draw_lines(miniapp::Study &study, const DesignProblem &problem, const DesignReport &report,
                const Chosen &chosen, const MarchSettings &settings, int steps)
{
   miniapp::Panel &panel =
      study.panel(miniapp::Panel::Kind::lines, "lines", "Along each variable, others optimal",
                  "variable", chosen.loses() ? "energy lost" : "largest pressure, weighted");
   double best = report.objective;
   for (Index j = 0; j < report.x.size(); ++j)
   {
      std::vector<double> at, values;
      for (int k = 0; k <= steps; ++k)
      {
         VectorXd x = report.x;
         x[j] = problem.low[j] + (problem.high[j] - problem.low[j]) * k / steps;
         double value = chosen.loses() ? 0.0 : -INFINITY;
         for (const DesignCase &load_case : problem.cases)
         {
            const Marched marched = march_case(problem, x, load_case, settings);
            if (chosen.loses()) { value += load_case.weight * marched.lost; }
            else { value = std::max(value, load_case.weight * marched.peak); }
         }
         at.push_back(x[j]);
         values.push_back(std::abs(value));
         if (value < best) { best = value; }
      }
      panel.add(exact_text("x", j + 1), at, values);
      panel.add("", {report.x[j]}, {std::abs(report.objective)}, "points");
   }
   study.value("best_of_lines", (report.objective - best) / std::abs(report.objective),
               "how much better any point of these lines is");
}

void design_contact(miniapp::Study &study)
{
   Chosen chosen;
   std::string stepping = "advancing";
   int lines = 0;
   DesignSettings settings;
   using miniapp::at_least;
   study.option(&chosen.scene, "scene", "Pad on a half-plane, or square punch on one.",
                {"pad", "punch"});
   study.option(&chosen.profile, "profile", "Gap free at nodes, or of even powers.",
                {"free", "crown"});
   study.option(&chosen.terms, "terms", "Crown: its powers, x², x⁴, …", miniapp::within(1, 8));
   study.option(&chosen.goal, "goal",
                "Least largest pressure; least loss in a cycle, or most (damping).",
                {"pressure", "loss", "damping"});
   study.option(&chosen.loads, "loads", "Normal load P of each case.", miniapp::positive);
   study.option(&chosen.weights, "weights", "Of each case; default: 1.", miniapp::positive);
   study.option(&chosen.shear, "shear", "Amplitude of Q/fP.", miniapp::at_least_below(0, 1));
   study.option(&chosen.friction, "friction", "Default: 0.3, of --reduced the file's.",
                miniapp::positive);
   study.option(
      &chosen.most, "most",
      "Most that a gap changes by against the node that touches (of bodies that are held: that "
      "is added to it), or largest x_k of the crown.",
      miniapp::positive);
   study.option(&chosen.curvature, "curvature", "Largest of the gap; default: no limit.",
                miniapp::positive);
   study.option(&chosen.nodes, "nodes", "Contact nodes, one more than a multiple of 4.",
                at_least(9));
   study.option(&settings.march.increments, "increments",
                "Increments between two points of the history.", at_least(1));
   study.option(&stepping, "stepping", miniapp::stepping_help, miniapp::stepping_choices);
   study.option(&settings.tolerance, "tolerance", "Of the conditions of optimality.",
                miniapp::between(0, 1));
   study.option(&lines, "lines", "Steps of a sweep along each variable.", at_least(0));
   study.option(&chosen.file, "reduced", "Reduced problem, in place of the scenes.",
                miniapp::Text::input);
   study.option(&chosen.history, "history",
                "With --reduced: load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'.",
                miniapp::Text::statements);
   study.option(&chosen.from, "from",
                "With --reduced: time from which on its points count; default: the last.");
   study.option(
      &chosen.loads_chosen, "choose",
      "With --reduced: loads that are chosen in place of the gap, as 'bolt 1; bolt 2'; "
      "their sum stays, none goes below zero.");
   study.parse();
   settings.march.stepping = miniapp::stepping(stepping);
   const Chosen usual;
   require(chosen.file.empty() == chosen.history.empty(),
           "options --reduced and --history: one needs the other");
   require(!chosen.file.empty() || std::isnan(chosen.from), "option --from is of --reduced");
   require(chosen.file.empty() ||
              (chosen.scene == usual.scene && chosen.loads == usual.loads &&
               chosen.shear == 0 && chosen.weights.empty() && chosen.nodes == usual.nodes),
           "options --scene, --loads, --weights, --shear and --nodes are of the scenes, "
           "--reduced has its own contact and --history");
   require(!chosen.loses() || chosen.shear > 0 || !std::isnan(chosen.from), "option --goal is ",
           chosen.goal, ", which needs a cycle: --shear, of --reduced --from");
   if (chosen.weights.empty()) { chosen.weights.assign(chosen.loads.size(), 1.0); }
   require(chosen.weights.size() == chosen.loads.size(), "option --weights has ",
           chosen.weights.size(), " entries, --loads has ", chosen.loads.size());

   DesignProblem problem;
   problem.problem = make_problem(study, chosen);
   const ReducedProblem &flat = problem.problem;
   const Index n = flat.nodes();
   const VectorXd &s = flat.arc_length, x = s.array() - 0.5 * (s.minCoeff() + s.maxCoeff());
   const bool loads = !chosen.loads_chosen.empty();
   require(
      !loads || (!chosen.file.empty() && chosen.profile == usual.profile &&
                 std::isnan(chosen.curvature)),
      "option --choose is of --reduced, and not beside --profile or --curvature: loads are "
      "chosen in place of the gap");
   const bool free = chosen.profile == "free";
   require(!free || lines == 0, "option --lines is of the crown, whose variables are few");
   problem.cases = make_cases(chosen, flat);
   const std::vector<Index> chosen_patterns =
      loads ? chosen_loads(chosen.loads_chosen, flat) : std::vector<Index>();
   if (loads) { choose_loads(problem, chosen_patterns, chosen.most); }
   else { choose_gap(problem, chosen, x); }
   const VectorXd none = VectorXd::Zero(problem.low.size());
   if (chosen.loses())
   {
      problem.goal = DesignGoal::least_sum;
      problem.objective = [](const Responses &of, const std::vector<std::size_t> &states)
      { return std::vector<Response>{of.dissipation(states.front(), states.back())}; };
   }

   DesignReport report;
   {
      miniapp::Watch watch("design");
      settings.march.monitor = watch.monitor();
      report = design(problem, none, settings);
      settings.march.monitor = {};
   }
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
      throw miniapp::Outcome();
   }
   study.save(problem.with(report.x));
   if (report.status != DesignStatus::optimal)
   {
      miniapp::warn("this is the best design of those that were tried, it need not be an "
                    "optimum: " +
                    report.message);
   }
   study.value("objective_at_start", std::abs(report.objective_at_start),
               chosen.goal + " of the start");
   study.value("objective", std::abs(report.objective), chosen.goal + " of the design");
   study.value("stationarity", report.stationarity, "gradient that is left");
   study.value("complementarity", report.complementarity, "multipliers times what is left");
   study.value("violation", report.violation, "limits violated by");
   study.results["variables"] =
      std::vector<double>(report.x.data(), report.x.data() + report.x.size());
   study.say(text("   %d iterations, %ld marches, %.2g s; %s", report.iterations,
                  report.marches, report.seconds, name(report.status)));

   if (loads)
   {
      miniapp::Table &table = study.table(
         "loads", {{"load", "load"}, {"before", "before", "%.6g"}, {"after", "after", "%.6g"}});
      const LoadHistory after = with_variables(problem, problem.cases[0], report.x);
      for (Index k : chosen_patterns)
      {
         study.row(table, {flat.patterns[k].name,
                           problem.cases[0].history.multipliers.row(k).maxCoeff(),
                           after.multipliers.row(k).maxCoeff()});
      }
   }
   const VectorXd gap = problem.with(report.x).gap;
   study.results["gap"] = std::vector<double>(gap.data(), gap.data() + n);
   miniapp::Panel *profiles = nullptr;
   if (!loads)
   {
      profiles = &study.panel(miniapp::Panel::Kind::lines, "profile", "Gap", "x", "gap");
      profiles->add("before", x, flat.gap, "dashed");
      profiles->add("after", x, gap);
   }
   miniapp::Panel &pressures = study.panel(miniapp::Panel::Kind::lines, "pressure",
                                           "Pressure where it is largest", "x", "p");
   miniapp::Table &table = study.table("cases", {{"case", "case"},
                                                 {"peak_before", "peak before", "%.6g"},
                                                 {"peak_after", "after", "%.6g"},
                                                 {"lost_before", "lost before", "%.4g"},
                                                 {"lost_after", "after", "%.4g"}});
   for (const DesignCase &load_case : problem.cases)
   {
      const Marched before = march_case(problem, none, load_case, settings.march),
                    after = march_case(problem, report.x, load_case, settings.march);
      study.row(table, {load_case.name, before.peak, after.peak, before.lost, after.lost});
      pressures.add(load_case.name + ", before", x, tractions(flat, before.at_peak.p),
                    "dashed");
      pressures.add(load_case.name + ", after", x, tractions(flat, after.at_peak.p));
   }
   const bool sweeps = lines > 0 && report.status != DesignStatus::stopped;
   if (sweeps) { draw_lines(study, problem, report, chosen, settings.march, lines); }
   if (chosen.file.empty() && chosen.scene == "pad" && free && !chosen.loses() &&
       chosen.loads.size() == 1 && std::isnan(chosen.curvature) &&
       uniform_profile(1, chosen.loads[0]) < chosen.most)
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
   return miniapp::Study::run("design", argc, argv, design_contact);
}
