//  plane_receding: an elastic strip pressed onto a similar half-plane, loaded and unloaded
//
//  Thesis chapter 5. The strip, of thickness t, ends at x = 0 and is pressed by p0 on its top
//  for x > n t; its end lifts off, and slip spreads between the separation point and a stick
//  zone. ξ = x - n t is counted from the end of the load, s = -ξ at separation, e = -ξ at the
//  border of stick. Loading is self-similar: one increment is exact. Unloading is marched with
//  steps that shrink with the load. Forward slip is +x of the strip; loading drags it to -x,
//  "backward". Units t = p0 = E' = 1, E' = E/(1-ν²).
//
//  Sample runs:  plane_receding
//                plane_receding -friction 0.7 -unload "0.9 0.5 0.2 0.1" -steps 50
//                plane_receding -friction 0.7 -unload "0.9 0.5 0.2 0.1" -march exact
//                plane_receding -domain half-plane
//                plane_receding -domain th0 -friction 0.3 -order 1 -spacing 0.04 -corner 0.001
//                plane_receding -overhang 0.8 -friction 1.4
//                plane_receding -map "0.4 0.8 1.2 1.6 2 3" -spacing 0.05 -corner 0.01

#include "common/receding.hpp"
#include "common/study_output.hpp"

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <iostream>
#include <limits>

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

/// Separation and border of stick, as the thesis counts them; NaN where there is none.
struct Extent
{
   double s = none, e = none, s_error = 0, e_error = 0;
   std::vector<Zone> zones;
};

/// One loaded or partly unloaded state.
Extent extent(const ReducedProblem &problem, const ContactState &state, double overhang)
{
   Extent result;
   result.zones = zones(problem, state);
   if (!closed(result.zones.front().state))
   {
      result.s = overhang - result.zones.front().to.position;
      result.s_error = result.zones.front().to.error;
   }
   if (result.zones.back().state == NodeState::stick && result.zones.size() > 1)
   {
      result.e = overhang - result.zones.back().from.position;
      result.e_error = result.zones.back().from.error;
      // Slip within the last spacing before the end of contact does not show.
      const Index first = result.zones.back().first;
      if (!slips(result.zones[result.zones.size() - 2].state))
      {
         result.e_error = problem.arc_length[first] - problem.arc_length[first - 1];
      }
   }
   return result;
}

nlohmann::ordered_json to_json(const Extent &extent, double overhang)
{
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   for (const Zone &zone : extent.zones)
   {
      list.push_back({{"state", name(zone.state)},
                      {"from", zone.from.position - overhang},
                      {"to", zone.to.position - overhang},
                      {"from_error", zone.from.error},
                      {"to_error", zone.to.error}});
   }
   return {{"separation", miniapp::json_number(extent.s)},
           {"stick_slip", miniapp::json_number(extent.e)},
           {"separation_error", extent.s_error},
           {"stick_slip_error", extent.e_error},
           {"zones", list}};
}

void print(const Extent &extent, double overhang)
{
   for (const Zone &zone : extent.zones)
   {
      std::printf("  %s %.3f", name(zone.state), zone.to.position - overhang);
   }
   std::printf("\n");
}

/// 0 → p0 with one overhang.
LoadHistory loading(const ReducedProblem &problem, double overhang)
{
   return LoadHistory::through(problem, {{}, {{miniapp::overhang_load(overhang), 1}}});
}

double interpolate(const VectorXd &x, const VectorXd &y, double at)
{
   Index k = 1;
   while (k + 1 < x.size() && x[k] < at) { ++k; }
   return y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
}

/// History of one point of the contact line.
struct PointHistory
{
   double xi = 0;
   Index node = 0;
   std::vector<double> level, slip;
   double slips_from = none, separates_at = none; ///< p/p0 during unloading
   double step = 0; ///< half of the largest step of p/p0: what is not known of the two
};

/// What the studies' notes give for the loading phase; HP is the half-plane limit.
struct LoadingReference
{
   double n, f, s_hp, e_hp, s_th0, e_th0, s_thesis, e_thesis;
};
const LoadingReference loading_references[] = {
   {4, 0.3, 0.903, -1.858, 0.910, -1.655, none, none},
   {4, 0.5, 1.169, -0.883, none, none, none, none},
   {4, 0.7, 1.406, -0.442, 1.382, -0.351, 1.4, -0.3},
   {4, 1.0, 1.730, -0.046, none, none, none, none},
   {1.6, 0.5, 1.169, -0.883, none, none, 1.1, -0.7},
   {1.2, 0.3, 0.906, -1.859, none, none, 0.9, -1.45},
};

struct Study
{
   miniapp::RecedingOptions options;
   bool half_plane = false, thesis_block = false;
   ReducedProblem *problem = nullptr;
   Stepping stepping = Stepping::advancing;
   Counters counters;
   miniapp::ReferenceTable table;
   nlohmann::ordered_json results;
   std::vector<miniapp::Panel> panels;

   void compare_loading(double n, double f, const Extent &found);
   int map(const std::vector<double> &overhangs, const std::vector<double> &frictions);
   void bonded(double overhang);
   int unload(FrictionSolver &solver, ContactState &state, double overhang, int steps,
              double lowest, const std::vector<double> &wanted,
              const std::vector<double> &points);
};

/// Rows of the table for a loaded state, if the notes have it: their ±, and the errors printed
/// with the edges.
void Study::compare_loading(double n, double f, const Extent &found)
{
   for (const LoadingReference &r : loading_references)
   {
      if (r.n != n || r.f != f || !(half_plane || thesis_block)) { continue; }
      const double s = half_plane ? r.s_hp : r.s_th0, e = half_plane ? r.e_hp : r.e_th0;
      char text[64];
      std::snprintf(text, sizeof text, "s/t, n = %g, f = %g", n, f);
      if (std::isfinite(s)) { table.add(text, s, {0.003, found.s_error}, r.s_thesis, found.s); }
      text[0] = 'e';
      if (std::isfinite(e)) { table.add(text, e, {0.003, found.e_error}, r.e_thesis, found.e); }
   }
   if (half_plane && n == 1.2 && f == 0.5)
   {
      table.add("length separated, n = 1.2, f = 0.5", 0.0, 0.0, 0.0,
                std::isfinite(found.s) ? n - found.s : 0.0);
   }
}

/// The bonded strip (thesis 5.2).
void Study::bonded(double overhang)
{
   const miniapp::BondedTractions b = miniapp::bonded_tractions(*problem, overhang);
   std::printf("\nBonded: corner ratio q/p %.4f (Williams %.4f), k1 %.4f, k2 %.4f, lowest "
               "pressure %.3g p0 at x > 0\n",
               b.corner_ratio, miniapp::williams_ratio[0], b.k1_pressure, b.k2_pressure,
               b.lowest_pressure);
   if (std::isfinite(b.adhesion_friction))
   {
      std::printf("  full adhesion needs f = %.4f, at x/t = %.3f\n", b.adhesion_friction,
                  b.adhesion_x);
   }
   else { std::printf("  the bonded strip pulls: no friction keeps it together\n"); }
   results["adhesion_friction"] = miniapp::json_number(b.adhesion_friction);
   results["adhesion_x"] = b.adhesion_x;
   results["corner_ratio"] = miniapp::json_number(b.corner_ratio);
   results["corner_strength"] = {b.k1_pressure, b.k2_pressure};
   results["lowest_bonded_pressure"] = b.lowest_pressure;
   if (options.order >= 2 && options.corner <= 5e-4)
   {
      // The fit leaves out eight nodes at the corner; with 0.0005 they reach into its range.
      table.add("bonded corner ratio q/p", miniapp::williams_ratio[0], {0, 0.015}, 0.543,
                b.corner_ratio);
   }
   if (half_plane && overhang == 0.8)
   {
      table.add("friction for adhesion, n = 0.8", 1.295, 0.003, none, b.adhesion_friction);
   }
   miniapp::Panel panel =
      miniapp::Panel::lines("bonded", "Bonded strip: traction ratio", "x/t", "q/p");
   const Index shown = std::lower_bound(problem->arc_length.data(),
                                        problem->arc_length.data() + problem->nodes(), 3.0) -
                       problem->arc_length.data();
   panel.add(miniapp::exact_text("n = ", overhang), problem->arc_length.segment(8, shown - 8),
             b.q.cwiseQuotient(b.p).segment(8, shown - 8));
   panel.add("Williams corner", std::vector<double>{0, 3},
             {miniapp::williams_ratio[0], miniapp::williams_ratio[0]}, "dashed");
   panels.push_back(panel);
}

/// s and e over n for several f (thesis figure 5.3): one condensed pair serves all.
int Study::map(const std::vector<double> &overhangs, const std::vector<double> &frictions)
{
   const miniapp::Stopwatch watch;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   miniapp::Panel panel = miniapp::Panel::lines("map", "Separation s and border of stick e",
                                                "overhang n", "s/t (upper), e/t (lower)");
   std::vector<std::vector<NodeState>> guesses(overhangs.size());
   std::printf("\n      f        n      s/t      e/t\n");
   for (double f : frictions)
   {
      set_friction(*problem, f);
      FrictionSolver solver(*problem);
      counters += solver.counters();
      std::vector<double> s, e;
      for (std::size_t k = 0; k < overhangs.size(); ++k)
      {
         ContactState state = ContactState::virgin(*problem);
         // The states of the nodes at the friction before are where the search starts.
         if (!guesses[k].empty()) { state.status = guesses[k]; }
         const MarchReport report = march(solver, loading(*problem, overhangs[k]), state);
         counters += report.counters;
         if (const int code = miniapp::exit_code(*problem, report)) { return code; }
         guesses[k] = state.status;
         const Extent found = extent(*problem, state, overhangs[k]);
         s.push_back(found.s);
         e.push_back(found.e);
         std::printf("%7.3g %8.4g %8.4f %8.4f\n", f, overhangs[k], found.s, found.e);
         list.push_back({{"friction", f},
                         {"overhang", overhangs[k]},
                         {"separation", miniapp::json_number(found.s)},
                         {"stick_slip", miniapp::json_number(found.e)}});
         compare_loading(overhangs[k], f, found);
      }
      const std::string label = miniapp::exact_text("f = ", f);
      panel.add(label, overhangs, s);
      panel.add(label, {none}, {none}); // a gap between the two curves
      panel.add(label, overhangs, e);
   }
   panel.add("thesis", std::vector<double>{1.6, 1.6, 1.2, 1.2}, {1.1, -0.7, 0.9, -1.45},
             "thesis");
   panels.push_back(panel);
   results["map"] = list;
   results["seconds_map"] = watch.seconds();
   std::printf("map of %zu states in %.2f s\n", list.size(), watch.seconds());
   return 0;
}

/// Unloading from the loaded state (thesis 5.3.2).
int Study::unload(FrictionSolver &solver, ContactState &state, double overhang, int steps,
                  double lowest, const std::vector<double> &wanted,
                  const std::vector<double> &points)
{
   const ContactState full = state;
   const VectorXd x = problem->arc_length;
   const VectorXd xi = x.array() - overhang;
   const std::string load = miniapp::overhang_load(overhang);
   std::vector<NamedLoads> loads{{{load, 1}}};
   const std::vector<double> levels = miniapp::unloading_levels(steps, lowest, wanted);
   for (double level : levels) { loads.push_back({{load, level}}); }

   std::vector<PointHistory> histories;
   for (double point : points)
   {
      PointHistory h;
      h.xi = point;
      (xi.array() - point).abs().minCoeff(&h.node);
      h.level = {0.0, 1.0};
      h.slip = {0.0, interpolate(xi, full.v, point)};
      histories.push_back(h);
   }
   miniapp::Panel diagram =
      miniapp::Panel::zones("zones", "Zones during unloading", "p/p0", "ξ/t");
   diagram.add(1.0, extent(*problem, full, overhang).zones,
               [&](double s) { return s - overhang; });
   miniapp::Panel profiles = miniapp::Panel::lines("tractions", "Pressure p and shear q over f",
                                                   "ξ/t", "p/p0, q/(f p0)");
   miniapp::Panel slip_panel =
      miniapp::Panel::lines("slip", "Slip of points of the interface", "p/p0", "v E'/(p0 t)");
   const Index shown = std::lower_bound(xi.data(), xi.data() + xi.size(), 2.5) - xi.data();
   const double f = problem->friction[0];
   auto add_profile = [&](double level, const ContactState &at)
   {
      const std::string label = miniapp::exact_text("p/p0 = ", level);
      profiles.add(label, xi.head(shown), tractions(*problem, at.p).head(shown));
      profiles.add("q/f: " + label, xi.head(shown), tractions(*problem, at.q).head(shown) / f,
                   "dashed");
   };
   add_profile(1, full);

   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::printf("\n   p/p0    zones and their right ends, ξ/t\n");
   auto observe = [&](const ContactState &now, const IncrementRecord &)
   {
      const double level = named(*problem, now.multipliers).at(load);
      const Extent found = extent(*problem, now, overhang);
      diagram.add(level, found.zones, [&](double s) { return s - overhang; });
      const std::vector<NodeState> settled = settled_states(*problem, now);
      for (PointHistory &h : histories)
      {
         h.level.push_back(level);
         h.slip.push_back(interpolate(xi, now.v, h.xi));
         const NodeState status = settled[h.node];
         // Some time during the step: its middle.
         const double before = h.level[h.level.size() - 2], change = 0.5 * (level + before);
         h.step = std::max(h.step, 0.5 * (before - level));
         if (slips(status) && !std::isfinite(h.slips_from)) { h.slips_from = change; }
         if (!closed(status) && !std::isfinite(h.separates_at)) { h.separates_at = change; }
      }
      auto is = [&](double value) { return std::abs(level - value) < 1e-9; };
      if (std::none_of(wanted.begin(), wanted.end(), is)) { return; }
      std::printf("%7.3f ", level);
      print(found, overhang);
      nlohmann::ordered_json entry = {{"level", level}};
      entry.update(to_json(found, overhang));
      list.push_back(entry);
      if (is(0.5) || is(0.1)) { add_profile(level, now); }
      // Unloading at f = 0.7: separation, and the borders of the zones at half load.
      const bool reference = f == 0.7 && overhang >= 2;
      for (const auto &[p, value] : {std::pair{0.9, -1.336}, {0.2, -0.740}, {0.1, -0.594}})
      {
         if (!reference || !half_plane || !is(p)) { continue; }
         table.add(miniapp::exact_text("ξ/t of separation, unloaded to p/p0 = ", p), value,
                   {0.003, found.s_error}, none, -found.s);
      }
      // In the finite block the length beyond the load's edge, L - n, matters: two overhangs.
      const bool block = thesis_block && (overhang == 2 || overhang == 4);
      if (reference && is(0.5) && (half_plane || block) && found.zones.size() == 5)
      {
         const double hp[] = {-1.018, -0.68, -0.12, 0.61},
                      th0[] = {-1.053, -0.77, -0.18, overhang == 2 ? 0.48 : 0.502},
                      thesis[] = {-1.1, -0.7, -0.2, 0.5};
         for (int k = 0; k < 4; ++k)
         {
            const ZoneBorder &border = found.zones[k].to;
            // The inner borders are given to two digits and depend on the steps of unloading.
            const miniapp::Allowed allowed{k == 0 ? 0.003 : 0.005,
                                           border.error + (k == 0 ? 0 : 0.5 / steps)};
            table.add("ξ/t of border " + std::to_string(k + 1) + " of 4, p/p0 = 0.5",
                      half_plane ? hp[k] : th0[k], allowed, thesis[k],
                      border.position - overhang);
         }
      }
   };
   MarchSettings settings;
   settings.increments = 1;
   settings.stepping = stepping;
   state.time = 0;
   const MarchReport report =
      march(solver, LoadHistory::through(*problem, loads), state, settings, observe);
   counters += report.counters;
   if (const int code = miniapp::exit_code(*problem, report)) { return code; }
   miniapp::add_exact_path(*problem, report, settings, results);
   results["levels"] = list;
   results["unloading_increments"] = report.increments.size();
   nlohmann::ordered_json slip_list = nlohmann::ordered_json::array();
   if (!histories.empty())
   {
      std::printf("\n    ξ/t   v at p0   sticks to   separates at   ±\n");
   }
   for (const PointHistory &h : histories)
   {
      std::printf("%7.3f %9.4f %11.3f %14.3f   %s\n", h.xi, h.slip[1], h.slips_from,
                  h.separates_at, miniapp::error_text(h.step).c_str());
      slip_list.push_back({{"xi", h.xi},
                           {"level", h.level},
                           {"slip", h.slip},
                           {"slips_from", miniapp::json_number(h.slips_from)},
                           {"separates_at", miniapp::json_number(h.separates_at)},
                           {"level_error", h.step}});
      slip_panel.add(miniapp::exact_text("ξ/t = ", h.xi), h.level, h.slip);
      if (h.xi == -0.5 && f == 0.7 && overhang >= 2 && half_plane)
      {
         table.add("v E'/(p0 t) at ξ/t = -0.5, full load", -0.8245,
                   {5e-5, 0.001 + 0.02 * options.spacing}, none, h.slip[1]);
         // A step of unloading, and the point's way to the nearest node.
         table.add("p/p0 down to which ξ/t = -0.5 sticks", 0.41, {0.005, 2 * h.step}, none,
                   h.slips_from);
         if (std::isfinite(h.separates_at))
         {
            table.add("p/p0 at which ξ/t = -0.5 separates", 0.06, {0.005, 2 * h.step}, none,
                      h.separates_at);
         }
      }
   }
   results["slip_histories"] = slip_list;
   if (f == 0.7)
   {
      for (double border : {-1.1, -0.7, -0.2, 0.5}) { diagram.mark(0.5, border); }
      diagram.mark(1.0, -1.4);
      diagram.mark(1.0, 0.3);
   }
   diagram.limit_y(-2, 2.2);
   diagram.limit_x(0, none);
   diagram.reverse_x();
   profiles.limit_x(-2, 2.5);
   panels.insert(panels.begin(), {profiles, diagram, slip_panel});
   return 0;
}

/// s and e as the block grows toward a half-plane.
int domain_study(miniapp::RecedingOptions options, double overhang, double friction,
                 Counters &counters)
{
   std::printf("\nDomain study, n = %g, f = %g\n  length    depth     side      s/t      e/t\n",
               overhang, friction);
   options.overhangs = {overhang};
   for (const auto &[length, depth, side] : {std::array<double, 3>{20, 200, 80},
                                             {20, 1e4, 1e4},
                                             {50, 1e3, 1e3},
                                             {100, 1e4, 1e4},
                                             {400, 1e5, 1e5},
                                             {100, 0, 0}}) // a half-plane without a mesh
   {
      options.length = length;
      options.depth = depth;
      options.side = side;
      miniapp::Receding scene = miniapp::make_receding(options);
      ReducedProblem &problem = scene.reduction.problem;
      set_friction(problem, friction);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, loading(problem, overhang), state);
      counters += scene.reduction.counters;
      counters += report.counters;
      if (const int code = miniapp::exit_code(problem, report)) { return code; }
      const Extent found = extent(problem, state, overhang);
      std::printf("%8g %8g %8g %8.4f %8.4f\n", length, depth, side, found.s, found.e);
   }
   return 0;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         miniapp::StudyOutput output;
         Study study;
         miniapp::RecedingOptions &options = study.options;
         const char *domain = "hp", *unload_list = "", *slip_list = "-0.5 0 0.5";
         const char *map_list = "", *map_friction_list = "0.3 0.5 0.7 1";
         const char *march_by = "advancing";
         double overhang = 4, friction = 0.7, length = 0, depth = 0, side = 0, lowest = 0.05;
         int steps = 50;
         bool study_domain = false;
         miniapp::Options args(argc, argv);
         args.AddOption(&overhang, "-overhang", "--overhang",
                        "n: the strip's end to the edge of the load, in t.");
         args.AddOption(&friction, "-friction", "--friction", "Coefficient of friction.");
         args.AddOption(
            &domain, "-domain", "--domain",
            "hp (a block close to a half-plane), half-plane (itself, without a mesh) or th0 "
            "(a finite block).");
         args.AddOption(&length, "-length", "--length",
                        "Length of the strip in t (0: the domain's).");
         args.AddOption(&depth, "-depth", "--depth",
                        "Depth of the block below in t (0: the domain's).");
         args.AddOption(&side, "-side", "--side",
                        "Block beyond the strip's end in t (0: the domain's).");
         args.AddOption(&options.order, "-order", "--order", "Order of the elements.");
         args.AddOption(&options.spacing, "-spacing", "--spacing",
                        "Distance of the contact nodes, in t.");
         args.AddOption(&options.corner, "-corner", "--corner",
                        "Distance of the contact nodes at the strip's end, in t.");
         args.AddOption(&options.poisson, "-poisson", "--poisson",
                        "Poisson's ratio of both bodies.");
         args.AddOption(&unload_list, "-unload", "--unload",
                        "Unloading: list of p/p0 to report (empty: none).");
         args.AddOption(&steps, "-steps", "--steps", "Unloading: steps of 1/steps of p0.");
         args.AddOption(&march_by, "-march", "--march", miniapp::stepping_help);
         args.AddOption(&lowest, "-lowest", "--lowest",
                        "Unloading: p/p0 at which it ends; steps shrink toward it.");
         args.AddOption(&slip_list, "-slip", "--slip",
                        "Unloading: list of ξ/t whose slip is followed.");
         args.AddOption(&map_list, "-map", "--map", "Map of s and e: list of n (empty: none).");
         args.AddOption(&map_friction_list, "-map-friction", "--map-friction",
                        "Map of s and e: list of f.");
         args.AddOption(&study_domain, "-domain-study", "--domain-study", "-no-domain-study",
                        "--no-domain-study", "Print s and e for growing domains.");
         output.add_options(args);
         args.parse();

         miniapp::check_choice("--domain", domain, {"hp", "half-plane", "th0"});
         const bool hp = std::string(domain) == "hp", th0 = std::string(domain) == "th0";
         if (th0) { options.thesis_domain(); }
         else { options.half_plane_domain(); }
         if (!hp && !th0) { options.depth = options.side = 0; }
         const bool own = length != 0 || depth != 0 || side != 0;
         study.half_plane = hp && !own;
         study.thesis_block = th0 && !own;
         if (length != 0) { options.length = length; }
         if (depth != 0) { options.depth = depth; }
         if (side != 0) { options.side = side; }
         require(friction > 0, "option --friction is ", friction, ", must be positive");
         require(steps >= 2, "option --steps is ", steps, ", must be at least 2");
         require(lowest > 0 && lowest < 1, "option --lowest is ", lowest,
                 ", must be between 0 and 1");
         const std::vector<double> wanted = miniapp::numbers("--unload", unload_list);
         for (double level : wanted)
         {
            require(level > 0 && level < 1, "option --unload: ", level,
                    " must be between 0 and 1");
         }
         const std::vector<double> points = miniapp::numbers("--slip", slip_list);
         study.stepping = miniapp::stepping("--march", march_by);
         const std::vector<double> map_n = miniapp::numbers("--map", map_list);
         const std::vector<double> map_f =
            miniapp::numbers("--map-friction", map_friction_list);
         require(map_n.empty() || !map_f.empty(),
                 "option --map-friction is empty, must list the "
                 "coefficients of the map");
         for (double f : map_f)
         {
            require(f > 0, "option --map-friction: ", f, " must be positive");
         }
         for (double point : points)
         {
            require(wanted.empty() ||
                       (point >= -overhang && point <= options.length - overhang),
                    "option --slip: ", point, " must be on the strip, from ", -overhang, " to ",
                    options.length - overhang, " (in t)");
         }
         options.overhangs = {overhang};
         for (double n : map_n)
         {
            auto &all = options.overhangs;
            if (std::find(all.begin(), all.end(), n) == all.end()) { all.push_back(n); }
         }

         miniapp::Receding scene = miniapp::make_receding(options);
         ReducedProblem &problem = scene.reduction.problem;
         study.problem = &problem;
         study.counters = scene.reduction.counters;
         set_friction(problem, friction);
         output.reduced(problem, scene.dofs);
         study.bonded(overhang);

         set_friction(problem, friction);
         FrictionSolver solver(problem);
         study.counters += solver.counters();
         ContactState state = ContactState::virgin(problem);
         const MarchReport report = march(solver, loading(problem, overhang), state);
         study.counters += report.counters;
         int code = miniapp::exit_code(problem, report);
         if (code == 0)
         {
            const Extent found = extent(problem, state, overhang);
            std::printf("\nLoading, n = %g, f = %g: s/t = %.4f ± %s, e/t = %.4f ± %s\n",
                        overhang, friction, found.s, miniapp::error_text(found.s_error).c_str(),
                        found.e, miniapp::error_text(found.e_error).c_str());
            study.results.update(to_json(found, overhang));
            study.compare_loading(overhang, friction, found);
         }
         if (code == 0 && !wanted.empty())
         {
            code = study.unload(solver, state, overhang, steps, lowest, wanted, points);
         }
         if (code == 0 && !map_n.empty()) { code = study.map(map_n, map_f); }
         if (code == 0 && study_domain)
         {
            code = domain_study(options, overhang, friction, study.counters);
         }
         if (study.half_plane || study.thesis_block)
         {
            study.table.note(
               "The thesis' block is finite, of unknown size: truncation carries a "
               "remote tension that moves e at first order");
            study.table.note(
               "(compare --domain hp and th0); s is less sensitive, and its values "
               "were read off figures.");
         }
         miniapp::add_outcome(problem, report, study.results);
         output.write(study.results, study.counters, study.table, study.panels);
         return code;
      });
}
