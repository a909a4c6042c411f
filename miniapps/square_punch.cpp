//  square_punch: a square block pressed and sheared on a rigid plane or a half-plane
//
//  Cases I and II of the thesis (3.7): a square elastic block, |x| < a, 0 < y < 2a, is pressed
//  by P and then sheared by Q, monotonically through a list of values or cyclically. The
//  interface is a complete contact with Coulomb friction. Units a = P = E' = 1, E' = E/(1-ν²).
//
//  Sample runs:  square_punch
//                square_punch -obstacle half-plane --shear "0.25 0.75"
//                square_punch -obstacle half-plane -domain 1e4 --shear "0.25 0.75"
//                square_punch -order 1 -nodes 201 -grading 0.02
//                square_punch -obstacle half-plane -nodes 65 -cycles 3 -amplitude 0.6
//                square_punch -obstacle half-plane -nodes 65 -cycles 3 -march exact
//                square_punch -friction 0 -nodes 33 -shear none

#include "common/punch.hpp"
#include "common/study_output.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <iostream>
#include <limits>

using namespace cattaneo;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

/// Reference values for f = 0.2 (rigid) and 0.4 (half-plane), ν = 0.3; see the studies' notes:
/// they were computed on graded quadratic meshes. Their own spread; what the mesh adds is the
/// error of the read-out and, of a loss, 0.5 % (bilinear elements: 1 %).
struct Reference
{
   double stick_half_width, stick_spread;
   std::vector<std::pair<double, double>> stick_right; ///< Q/fP, x/a
   double right_spread;
   double dissipation; ///< of a steady cycle of Q = ± 0.8 fP, ± 0.3 %
};

const Reference rigid_reference{
   0.471, 0.003, {{0.25, 0.19}, {0.5, -0.203}, {0.75, -0.511}, {0.9, -0.729}}, 0.005, 9.17e-4};
const Reference half_plane_reference{
   0.909, 0.002, {{0.25, 0.737}, {0.75, -0.526}}, 0.002, 3.377e-3};

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         miniapp::StudyOutput output;
         miniapp::PunchOptions options;
         const char *obstacle = "rigid";
         double friction = none; // by the obstacle
         const char *shear_list = "0.25 0.5 0.75 0.9";
         int cycles = 0;
         double amplitude = 0.8;
         int increments = 20;
         const char *march_by = "advancing";

         miniapp::Options args(argc, argv);
         args.AddOption(&obstacle, "-obstacle", "--obstacle",
                        "What the block stands on: rigid or half-plane.");
         args.AddOption(&friction, "-friction", "--friction",
                        "Coefficient of friction; default 0.2 (rigid), 0.4 (half-plane).");
         add_options(args, options);
         args.AddOption(&shear_list, "-shear", "--shear",
                        "Monotonic shear: list of Q/fP, or none.");
         args.AddOption(&cycles, "-cycles", "--cycles",
                        "Cycles of Q = ± amplitude fP, after P (0: none).");
         args.AddOption(&amplitude, "-amplitude", "--amplitude",
                        "Amplitude of the cycles in Q/fP.");
         args.AddOption(&increments, "-increments", "--increments",
                        "Load increments between two values of the shear.");
         args.AddOption(&march_by, "-march", "--march", miniapp::stepping_help);
         output.add_options(args);
         args.parse();

         miniapp::check_choice("--obstacle", obstacle, {"rigid", "half-plane"});
         options.half_plane = std::string(obstacle) == "half-plane";
         if (std::isnan(friction)) { friction = options.half_plane ? 0.4 : 0.2; }
         require(friction >= 0, "option --friction is ", friction, ", must not be negative");
         require(cycles >= 0, "option --cycles is ", cycles, ", must not be negative");
         const std::vector<double> shear = miniapp::numbers("--shear", shear_list);
         require(increments >= 1, "option --increments is ", increments,
                 ", must be at least 1");

         miniapp::Punch punch = miniapp::make_punch(options);
         ReducedProblem &problem = punch.reduction.problem;
         set_friction(problem, friction);
         output.reduced(problem, punch.dofs);

         // Arc length runs from the left corner: x = s - 1 in the tables.
         auto x = [](const ZoneBorder &edge) { return edge.position - 1; };
         MarchSettings settings;
         settings.increments = increments;
         settings.stepping = miniapp::stepping("--march", march_by);
         FrictionSolver solver(problem, settings.friction);
         const Counters made = solver.counters();
         ContactState state = ContactState::virgin(problem);
         const auto sheared = [](double Q) { return NamedLoads{{"P", 1}, {"Q", Q}}; };
         MarchReport report =
            march(solver, LoadHistory::through(problem, {{}, {{"P", 1}}}), state, settings);
         int code = miniapp::exit_code(problem, report);
         Counters counters = punch.reduction.counters;
         counters += made;
         counters += report.counters;

         const bool standard = options.poisson == 0.3 && options.unbounded() &&
                               friction == (options.half_plane ? 0.4 : 0.2);
         const Reference &reference =
            options.half_plane ? half_plane_reference : rigid_reference;
         miniapp::ReferenceTable table;
         nlohmann::ordered_json results;

         const Zone stick = stick_zone(problem, state);
         const bool sticks = stick.last >= stick.first;
         const double edge_slip = state.v[problem.nodes() - 1];
         const ContactState pressed = state;
         miniapp::Panel slip =
            miniapp::Panel::lines("slip", "Slip of the interface", "x/a", "v E'/P");
         miniapp::Panel shear_traction = miniapp::Panel::lines(
            "tractions", "Shear over f, and pressure (dashed)", "x/a", "q a/(f P), p a/P");
         auto draw = [&](double load, const ContactState &at)
         {
            const Eigen::VectorXd position = problem.arc_length.array() - 1;
            const std::string label = miniapp::exact_text("Q/fP = ", load);
            slip.add(label, position, at.v);
            // The corner's node and its neighbours: the singularity, not the picture's scale.
            const Eigen::Index skip = 12, count = problem.nodes() - 2 * skip;
            if (count < 2 || friction == 0) { return; }
            shear_traction.add(label, position.segment(skip, count),
                               tractions(problem, at.q).segment(skip, count) / friction);
            shear_traction.add("p: " + label, position.segment(skip, count),
                               tractions(problem, at.p).segment(skip, count), "dashed");
         };
         draw(0, pressed);
         if (code == 0)
         {
            results["stick_left"] = sticks ? nlohmann::ordered_json(x(stick.from)) : nullptr;
            results["stick_right"] = sticks ? nlohmann::ordered_json(x(stick.to)) : nullptr;
            results["slip_edge"] = edge_slip;
            results["peak_pressure"] = tractions(problem, state.p).maxCoeff();
            std::cout << "\nP only:  stick from ";
            if (sticks) { std::cout << x(stick.from) << " to " << x(stick.to); }
            else { std::cout << "none"; }
            std::cout << ", slip at the right corner " << edge_slip << std::endl;
            if (standard && sticks)
            {
               table.add("stick half-width, P only", reference.stick_half_width,
                         {reference.stick_spread, stick.to.error}, none, x(stick.to));
               if (!options.half_plane)
               {
                  table.add("v(corner), P only", 0.0496, 5e-4, none, edge_slip);
               }
            }
         }

         nlohmann::ordered_json levels = nlohmann::ordered_json::array();
         if (code == 0 && !shear.empty())
         {
            std::cout << "\n  Q/fP   stick left   stick right   dissipation\n";
         }
         for (std::size_t k = 0; k < shear.size() && code == 0; ++k)
         {
            const LoadHistory further = LoadHistory::through(
               problem, {named(problem, state.multipliers), sheared(shear[k] * friction)});
            state.time = 0;
            report = march(solver, further, state, settings);
            counters += report.counters;
            code = miniapp::exit_code(problem, report);
            if (code != 0) { break; }
            draw(shear[k], state);
            const Zone zone = stick_zone(problem, state);
            const bool any = zone.last >= zone.first;
            nlohmann::ordered_json level = {{"shear", shear[k]},
                                            {"dissipation", state.dissipation}};
            level["stick_left"] = any ? nlohmann::ordered_json(x(zone.from)) : nullptr;
            level["stick_right"] = any ? nlohmann::ordered_json(x(zone.to)) : nullptr;
            levels.push_back(level);
            std::printf("%6.3f   %10.4f   %11.4f   %11.4e\n", shear[k],
                        any ? x(zone.from) : none, any ? x(zone.to) : none, state.dissipation);
            for (const auto &[load, right] : reference.stick_right)
            {
               if (standard && any && load == shear[k])
               {
                  table.add(miniapp::exact_text("right end of stick, Q/fP = ", load), right,
                            {reference.right_spread, zone.to.error}, none, x(zone.to));
               }
            }
         }
         if (!levels.empty()) { results["levels"] = levels; }

         if (cycles > 0 && code == 0)
         {
            ContactState cyclic = pressed;
            cyclic.time = 0;
            cyclic.dissipation = 0;
            const double Q = amplitude * friction;
            LoadHistory history =
               LoadHistory::through(problem, {sheared(0), sheared(Q), sheared(-Q), sheared(0)});
            history.cycle_start = 0;
            history.cycles = cycles;
            // Loss is an integral over the path: finer increments, of equal size in both
            // pieces.
            settings.increments_of_piece = {2 * increments, 4 * increments, 2 * increments};
            report = march(solver, history, cyclic, settings);
            counters += report.counters;
            code = miniapp::exit_code(problem, report);
            miniapp::add_exact_path(problem, report, settings, results);
            nlohmann::ordered_json losses = nlohmann::ordered_json::array();
            std::cout << "\n cycle   dissipation   external work   slip change\n";
            for (std::size_t k = 0; k < report.cycles.size(); ++k)
            {
               const CycleRecord &cycle = report.cycles[k];
               std::printf("%6zu   %11.4e   %13.4e   %11.2e\n", k + 1, cycle.dissipation,
                           cycle.external_work, cycle.slip_change);
               losses.push_back(cycle.dissipation);
            }
            if (report.steady_cycle)
            {
               std::cout << "steady from cycle " << report.steady_cycle << ", period "
                         << report.steady_period << std::endl;
            }
            results["dissipation"] = losses;
            results["steady_cycle"] = report.steady_cycle;
            results["energy_imbalance"] = report.energy_imbalance;
            if (standard && amplitude == 0.8 && report.cycles.size() > 1)
            {
               table.add("steady loss a cycle, Q = ±0.8 fP", reference.dissipation,
                         {0.003 * reference.dissipation,
                          (options.order == 1 ? 0.01 : 0.005) * reference.dissipation},
                         none, report.cycles.back().dissipation);
            }
         }
         miniapp::add_outcome(problem, report, results);
         output.write(results, counters, table, {slip, shear_traction});
         return code;
      });
}
