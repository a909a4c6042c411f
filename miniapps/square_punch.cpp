//  square_punch: a square block pressed and sheared on a rigid plane or a half-plane
//
//  Cases I and II of the thesis (3.7): a square elastic block, |x| < a, 0 < y < 2a, is pressed
//  by P and then sheared by Q, either monotonically through a list of values or in cycles. The
//  interface is a complete contact with Coulomb friction. Units: a = P = E' = 1, with E' =
//  E/(1-ν²).
//
//  Sample runs:
//    square_punch
//    square_punch --obstacle half-plane --shear "0.25 0.75"
//    square_punch --obstacle half-plane --domain 1e4 --shear "0.25 0.75"
//    square_punch --obstacle half-plane --shear none --dislocation "0 0.7"
//    square_punch --order 1 --nodes 201 --grading 0.02
//    square_punch --obstacle half-plane --nodes 65 --cycles 3 --amplitude 0.6
//    square_punch --obstacle half-plane --nodes 65 --cycles 3
//    square_punch --friction 0 --nodes 33 --shear none
//    square_punch --shear none --cycles 2

#include "common/punch.hpp"
#include "common/run.hpp"

#include <cattaneo/input_error.hpp>

using namespace cattaneo;
using namespace miniapp;

namespace
{

/// Tractions of glide dislocations, jumps of the slip by 1 (thesis 3.9): with w = 0 they are A
/// v and B v.
void dislocations(Study &study, const ReducedProblem &problem, const Eigen::VectorXd &x,
                  const std::vector<double> &places)
{
   Panel &panel =
      study.lines("dislocations", "Tractions of a jump of slip by 1", "x/a", "q a/E', p a/E'");
   ResultTable &table =
      study.table("dislocations_near", {{"place", "jump at x/a", "%.3f"},
                                        {"near", "q at 0.2 a from it, over E'/4πr"}});
   for (const double place : places)
   {
      Eigen::Index node = 0, near = 0;
      (x.array() - place).abs().minCoeff(&node);
      ((x.array() - x[node]).abs() - 0.2).abs().minCoeff(&near);
      Eigen::VectorXd v = (x.array() > x[node]).cast<double>();
      v[node] = 0.5;
      Eigen::VectorXd q = tractions(problem, problem.A() * v),
                      p = tractions(problem, problem.B() * v), r = x.array() - x[node];
      const std::string at = exact_text("jump at ", place);
      // Values at the nodes beside a jump oscillate.
      const Eigen::Index first = std::max<Eigen::Index>(0, node - 4),
                         count = std::min<Eigen::Index>(x.size(), node + 5) - first;
      for (Eigen::VectorXd *drawn : {&q, &p})
      {
         drawn->segment(first, count).setConstant(none);
      }
      panel.add("shear, " + at, x, q);
      panel.add("pressure, " + at, x, p);
      // Within one body without ends: E'/4πr, the sign that opposes the jump.
      const double sign = q[near] * r[near] > 0 ? 1 : -1;
      const Eigen::VectorXd exact = sign / (4 * M_PI) * r.cwiseInverse();
      panel.add("infinite body: shear, " + at, x, exact, "dashed");
      study.row(table, {place, q[near] / exact[near]});
   }
   panel.limit("y", -2, 2);
}

void square_punch(Study &study)
{
   PunchOptions options;
   MarchSettings settings;
   std::string obstacle = "rigid";
   SteppingOptions stepping;
   double friction = none, amplitude = 0.8;
   std::vector<double> shear = {0.25, 0.5, 0.75, 0.9}, jumps;
   int cycles = 0;
   study.options().group("The contact");
   study.option(&obstacle, "obstacle", "Body below the block: rigid or half-plane.",
                {"rigid", "half-plane"});
   study.option(&friction, "friction",
                "Coefficient of friction; default 0.2 (rigid), 0.4 (half-plane).",
                not_negative);
   add_options(study, options);
   study.options().group("The loads");
   study.option(&shear, "shear", "Monotonic shear: values of Q/fP, or none.");
   study.option(
      &jumps, "dislocation",
      "Prints the tractions that a unit jump of the slip causes at these x/a (empty: none).",
      Check{[](double at) { return std::abs(at) < 1; }, "must be between -1 and 1"});
   study.option(&cycles, "cycles", "Cycles of Q = ± amplitude fP, after P (0: none).",
                not_negative);
   study.option(&amplitude, "amplitude", "Amplitude of the cycles in Q/fP.");
   study.option(&settings.increments, "increments",
                "Load increments between two values of the shear.", at_least(1));
   stepping.declare_with_events(study);
   study.options().renamed({{"march", "stepping"}});
   study.parse();
   study.only_if(cycles > 0, {"amplitude"}, "goes with --cycles");
   options.half_plane = obstacle == "half-plane";
   if (std::isnan(friction)) { friction = options.half_plane ? 0.4 : 0.2; }
   study.results["friction"] = friction;
   stepping.set(settings);
   if (friction == 0)
   {
      require(shear.empty() || !study.options().says("shear"),
              "option --shear gives Q/fP, so that --friction must be above 0");
      require(cycles == 0,
              "option --cycles: the amplitude is in Q/fP, so that --friction must be above 0");
      shear.clear();
   }

   Scene scene = make_punch(options);
   const ReducedProblem &problem = scene.problem();
   set_friction(scene.problem(), friction);
   study.reduced(scene);

   // Arc length runs from the left corner.
   const Eigen::VectorXd x = problem.arc_length.array() - 1;
   if (!jumps.empty()) { dislocations(study, problem, x, jumps); }
   Panel &slip = study.lines("slip", "Slip of the interface", "x/a", "v E'/P"),
         &shears = study.lines("tractions", "Pressure, and shear over f (dashed)", "x/a",
                               "p a/P, q a/(f P)");
   const auto draw = [&](double load, const ContactState &state)
   {
      slip.add(exact_text("Q/fP = ", load), x, state.v);
      // The corner node and its neighbours are singular, and do not set the scale of the
      // picture.
      const Eigen::Index skip = std::min<Eigen::Index>(12, problem.nodes() / 4);
      shears.add_tractions(exact_text("Q/fP = ", load), x, problem, state, skip,
                           problem.nodes() - 2 * skip);
   };

   Run run(study, problem, settings);
   run.to({{"P", 1}});
   const ContactState pressed = run.state;
   draw(0, pressed);
   const Zone stick = stick_zone(problem, pressed);
   const bool sticks = stick.last >= stick.first;
   study.title("P only");
   study.value("stick_left", sticks ? stick.from.position - 1 : none, "stick from x/a");
   study.value("stick_right", sticks ? stick.to.position - 1 : none, "to x/a",
               sticks ? stick.to.error : none);
   study.value("slip_edge", pressed.v[problem.nodes() - 1], "slip at the right corner");
   study.value("peak_pressure", tractions(problem, pressed.p).maxCoeff(), "peak pressure");

   ResultTable &levels = study.table("levels", {{"shear", "Q/fP", "%.3f"},
                                                {"stick_left", "stick left"},
                                                {"stick_right", "stick right"},
                                                {"dissipation", "dissipation", "%.4e"}});
   const std::size_t one_way = levels_one_way(shear);
   for (std::size_t k = 0; k < shear.size(); ++k)
   {
      const double Q = shear[k];
      run.to({{"Q", Q * friction}});
      draw(Q, run.state);
      const Zone zone = stick_zone(problem, run.state);
      const bool any = zone.last >= zone.first;
      study.row(levels,
                {Q, any ? zone.from.position - 1 : none, any ? zone.to.position - 1 : none,
                 run.state.dissipation},
                {{"stick_right", zone.to.error}}, {{"monotonic", k < one_way}});
   }

   if (cycles == 0) { return; }
   const double Q = amplitude * friction;
   run.state = pressed;
   run.state.dissipation = 0;
   // The loss is an integral over the path, so increments are finer, and of equal size in all
   // pieces.
   const int n = settings.increments;
   run.settings.increments_of_piece = {2 * n, 4 * n, 2 * n};
   run.cycle({{{"Q", Q}}, {{"Q", -Q}}}, cycles);
   report_exact_path(study, run);
   report_cycles(study, problem, run.report);
   const MarchReport &report = run.report;
   if (report.cycles.empty()) { return; }
   if (report.steady_cycle == 0)
   {
      study.value("last_loss", report.cycles.back().dissipation,
                  "loss in the last cycle (not steady yet)");
      return;
   }
   double loss = 0;
   for (int k = 1; k <= report.steady_period; ++k)
   {
      loss += report.cycles[report.cycles.size() - k].dissipation / report.steady_period;
   }
   study.value("steady_loss", loss, "steady loss per cycle");
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("square_punch", argc, argv, square_punch);
}
