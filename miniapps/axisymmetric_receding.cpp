//  axisymmetric_receding: an elastic disc pressed onto a half-space, unloaded, or twisted
//
//  Thesis chapter 7. The disc, of thickness t and radius b, is pressed by p0 on its top for
//  r < a; beyond r = d it lifts off, and slip spreads between d and a stick zone r < c. Loading
//  is self-similar: one increment is exact. Twisting holds the pressure and prescribes the
//  rotation of the top, of its loaded part or of the rim (the torque may then pass a maximum),
//  or the torque itself, as a shear on the loaded part. T_s = f Σ r p, with the pressure of the
//  contact without friction, is the torque of steady spinning. Units t = p0 = E = 1: rotations
//  are in p0/E, torques in p0 t³ and over the whole circumference.
//
//  Sample runs:  axisymmetric_receding
//                axisymmetric_receding -unload "0.9 0.5 0.3 0.1" -spacing 0.04
//                axisymmetric_receding -torque "0.3 0.5 0.7" -spacing 0.04
//                axisymmetric_receding -torque "0.5 0.9" -twist traction -spacing 0.05
//                axisymmetric_receding -cycles 3 -amplitude 0.6 -spacing 0.05 -steps 40
//                axisymmetric_receding -bonded "2.1 3.75 4.25 4.7" -map "0.5 1 2 3 4"
//                axisymmetric_receding -critical "1 3 5" -spacing 0.05

#include "common/disc_scene.hpp"
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

const double none = std::numeric_limits<double>::quiet_NaN(),
             infinity = std::numeric_limits<double>::infinity();

std::string text(const char *format, double value)
{
   char result[80];
   std::snprintf(result, sizeof result, format, value);
   return result;
}

/// Separation and stick radius; NaN where there is none.
struct Extent
{
   double d = none, c = none, d_error = 0, c_error = 0;
   std::vector<Zone> zones;
};

Extent extent(const ReducedProblem &problem, const ContactState &state)
{
   Extent result;
   result.zones = zones(problem, state);
   // Arc length counts from the first node, radii from the axis.
   const double shift = problem.position(0, 0) - problem.arc_length[0];
   for (Zone &zone : result.zones)
   {
      zone.from.position += shift;
      zone.to.position += shift;
   }
   result.zones.front().from.position = 0; // the axis belongs to the node next to it
   const Zone &first = result.zones.front(), &last = result.zones.back();
   if (last.state == NodeState::separation)
   {
      result.d = last.from.position;
      result.d_error = last.from.error;
   }
   if (first.state == NodeState::stick && result.zones.size() > 1)
   {
      result.c = first.to.position;
      result.c_error = first.to.error;
      // Slip within the last spacing before the end of contact does not show.
      const Index i = first.last;
      if (!slips(result.zones[1].state))
      {
         result.c_error = problem.arc_length[i + 1] - problem.arc_length[i];
      }
   }
   return result;
}

nlohmann::ordered_json to_json(const Extent &extent)
{
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   for (const Zone &zone : extent.zones)
   {
      list.push_back({{"state", name(zone.state)},
                      {"from", zone.from.position},
                      {"to", zone.to.position},
                      {"from_error", zone.from.error},
                      {"to_error", zone.to.error}});
   }
   return {{"separation", miniapp::json_number(extent.d)},
           {"stick", miniapp::json_number(extent.c)},
           {"separation_error", extent.d_error},
           {"stick_error", extent.c_error},
           {"zones", list}};
}

void print(const Extent &extent)
{
   for (const Zone &zone : extent.zones)
   {
      std::printf("  %s %.3f", name(zone.state), zone.to.position);
   }
   std::printf("\n");
}

/// Angle of slip or of friction from the radial direction at a radius, degrees: linear between
/// the nodes.
double slip_angle(const VectorXd &r, const VectorXd &vector, double radius)
{
   const Index n = r.size();
   const auto angle = [&](Index i)
   { return std::atan2(std::abs(vector[n + i]), std::abs(vector[i])) * 180 / M_PI; };
   const Index k =
      std::clamp<Index>(std::upper_bound(r.data(), r.data() + n, radius) - r.data(), 1, n - 1);
   return angle(k - 1) + (angle(k) - angle(k - 1)) * (radius - r[k - 1]) / (r[k] - r[k - 1]);
}

/// How far the twist has gone.
struct Turning
{
   ContactState state;
   double at = 0; ///< multiplier of the pattern "twist": rotation or torque
   double torque = 0, greatest = 0;
   double stiffness = 0;   ///< torque by multiplier, over the last step
   bool descended = false; ///< the torque has passed a maximum
};

/// What a wanted stop of the twist is counted in.
enum class Stop
{
   torque,
   multiplier
};

struct Study
{
   miniapp::DiscOptions options;
   double a = 0, f = 0;
   int steps = 80;
   ReducedProblem *problem = nullptr;
   Counters counters;
   miniapp::ReferenceTable table;
   nlohmann::ordered_json results;
   std::vector<miniapp::Panel> panels;
   double limit = 0; ///< T_s

   /// True for what the reference values are of, on meshes that can be compared with them.
   bool standard() const
   {
      return options.poisson == 0.3 && options.domain == 100 && options.spacing <= 0.05;
   }
   bool is(double b_, double a_, double f_) const
   {
      return standard() && options.disc_radius == b_ && a == a_ && f == f_;
   }
   NamedLoads loads(double load, double twist = 0) const;
   double load(const ContactState &state) const;
   VectorXd radii() const { return problem->position.col(0); }
   double torque(const ContactState &state) const;
   double rotation(const ContactState &state) const;
   int marched(const MarchReport &report);

   void bonded(const std::vector<double> &wanted);
   void compare_loading(double load_radius, double friction, const Extent &found);
   int load(FrictionSolver &solver, ContactState &state);
   int map(const std::vector<double> &wanted, const std::vector<double> &frictions);
   int critical(const std::vector<double> &discs, const std::vector<double> &frictions);
   int unload(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted);

   int spinning_limit();
   Turning untwisted(const ContactState &loaded) const;
   int advance(FrictionSolver &solver, Turning &now, double by, const MarchObserver &observe);
   int turn(FrictionSolver &solver, Turning &now, Stop stop, double value,
            const MarchObserver &observe);
   int twist(FrictionSolver &solver, const ContactState &loaded, Stop stop,
             const std::vector<double> &wanted);
   int cycle(FrictionSolver &solver, const ContactState &loaded, double amplitude, int cycles);
};

/// The study's own load and its twist, if anything twists.
NamedLoads Study::loads(double load, double twist) const
{
   NamedLoads at = {{miniapp::radius_load(a), load}};
   if (options.twist != miniapp::Twist::none) { at["twist"] = twist; }
   return at;
}

double Study::load(const ContactState &state) const
{
   return named(*problem, state.multipliers).at(miniapp::radius_load(a));
}

/// Torque that the disc passes on: Σ r q_θ, opposed to its slip.
double Study::torque(const ContactState &state) const
{
   return -radii().dot(state.q.tail(problem->nodes()));
}

/// Rotation that the twist does its work on.
double Study::rotation(const ContactState &state) const
{
   const int k = problem->pattern("twist");
   const LoadPattern &pattern = problem->patterns[k];
   if (pattern.control == Control::displacement) { return state.multipliers[k]; }
   return problem->H.row(k).dot(state.multipliers) - pattern.q.dot(state.v) -
          pattern.p.dot(state.w);
}

int Study::marched(const MarchReport &report)
{
   counters += report.counters;
   miniapp::add_outcome(*problem, report, results);
   return miniapp::exit_code(*problem, report);
}

/// The bonded disc (thesis 7.3), pressed at several radii.
void Study::bonded(const std::vector<double> &wanted)
{
   const VectorXd r = radii();
   // The node next to the axis sees little area; the last three, at the 270° corner, never
   // converge.
   const Index first = 1, count = problem->nodes() - 4;
   miniapp::Panel panel =
      miniapp::Panel::lines("bonded", "Bonded disc: pressure", "r/t", "p/p0");
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::printf("\nBonded disc\n   a/t    lowest p/p0   at r/t   f for full adhesion\n");
   for (double a_ : wanted)
   {
      const LoadPattern &pattern =
         problem->patterns[problem->pattern(miniapp::radius_load(a_))];
      const VectorXd p = tractions(*problem, pattern.p).segment(first, count),
                     q = tractions(*problem, pattern.q.head(problem->nodes()))
                            .segment(first, count),
                     at = r.segment(first, count);
      Index low = 0;
      const double lowest = p.minCoeff(&low);
      const double adhesion = lowest > 0 ? q.cwiseAbs().cwiseQuotient(p).maxCoeff() : infinity;
      std::printf("%6.3g %14.3e %8.3f   ", a_, lowest, at[low]);
      std::printf(lowest > 0 ? "%.4f\n" : "none: it pulls\n", adhesion);
      list.push_back({{"load_radius", a_},
                      {"lowest_pressure", lowest},
                      {"lowest_at", at[low]},
                      {"adhesion_friction", miniapp::json_number(adhesion)}});
      panel.add(miniapp::exact_text("a = ", a_), at, p);
      const bool reference = standard() && options.disc_radius == 5;
      for (const auto &[radius, value] : {std::pair{0.5, 0.9088},
                                          {1.0, 0.8618},
                                          {2.0, 0.4829},
                                          {3.0, 0.07621},
                                          {4.0, 0.01505}})
      {
         if (!reference || a_ != 2.1) { continue; }
         Index i = 0;
         (at.array() - radius).abs().minCoeff(&i);
         table.add(miniapp::exact_text("bonded, a = 2.1: p/p0 at r/t = ", radius), value,
                   {value > 0.1 ? 5e-5 : 5e-6, 5e-4}, none, p[i]);
      }
      for (const auto &[radius, value] : {std::pair{3.75, 1.69}, {4.25, 1.07}, {4.7, 0.600}})
      {
         if (!reference || a_ != radius) { continue; }
         table.add(miniapp::exact_text("f for full adhesion, a = ", radius), value,
                   {0.005, 0.01 * value}, 0.543, adhesion);
      }
   }
   results["bonded"] = list;
   panels.push_back(panel);
}

/// Rows of the table for a loaded state that the notes have.
void Study::compare_loading(double load_radius, double friction, const Extent &found)
{
   struct
   {
      double a, f, d, c, thesis;
   } const references[] = {{0.5, 0.9, 2.625, 0.849, 2.6},
                           {2.5, 0.5, 3.728, 1.879, 3.75},
                           {2.5, 0.8, 4.046, 2.384, none}};
   for (const auto &row : references)
   {
      if (!is(5, a, f) || load_radius != row.a || friction != row.f) { continue; }
      const std::string where =
         miniapp::exact_text(", loaded, a = ", row.a) + miniapp::exact_text(", f = ", row.f);
      table.add("d/t" + where, row.d, {0.001, found.d_error}, row.thesis, found.d);
      table.add("c/t" + where, row.c, {0.001, found.c_error}, none, found.c);
   }
}

int Study::load(FrictionSolver &solver, ContactState &state)
{
   const MarchReport report =
      march(solver, LoadHistory::through(*problem, {{}, loads(1)}), state);
   if (const int code = marched(report)) { return code; }
   const Extent found = extent(*problem, state);
   std::printf("\nLoading, b = %g, a = %g, f = %g: d/t = %.4f ± %s, c/t = %.4f ± %s\n",
               options.disc_radius, a, f, found.d, miniapp::error_text(found.d_error).c_str(),
               found.c, miniapp::error_text(found.c_error).c_str());
   results.update(to_json(found));
   compare_loading(a, f, found);
   return 0;
}

/// c and d over a for several f (thesis figure 7.10): one condensed pair serves all.
int Study::map(const std::vector<double> &wanted, const std::vector<double> &frictions)
{
   const miniapp::Stopwatch watch;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   miniapp::Panel panel =
      miniapp::Panel::lines("map", "Separation d (upper) and border of stick c (lower)",
                            "radius of the load a/t", "d/t, c/t");
   std::vector<std::vector<NodeState>> guesses(wanted.size());
   std::printf("\n      f      a/t      d/t      c/t\n");
   for (double friction : frictions)
   {
      ReducedProblem rubbed = *problem;
      set_friction(rubbed, friction);
      FrictionSolver solver(rubbed);
      counters += solver.counters();
      std::vector<double> d, c;
      for (std::size_t k = 0; k < wanted.size(); ++k)
      {
         ContactState state = ContactState::virgin(rubbed);
         // The states of the nodes at the friction before are where the search starts.
         if (!guesses[k].empty()) { state.status = guesses[k]; }
         const LoadHistory loading =
            LoadHistory::through(rubbed, {{}, {{miniapp::radius_load(wanted[k]), 1}}});
         if (const int code = marched(march(solver, loading, state))) { return code; }
         guesses[k] = state.status;
         const Extent found = extent(rubbed, state);
         d.push_back(found.d);
         c.push_back(found.c);
         std::printf("%7.3g %8.4g %8.4f %8.4f\n", friction, wanted[k], found.d, found.c);
         list.push_back({{"friction", friction},
                         {"load_radius", wanted[k]},
                         {"separation", miniapp::json_number(found.d)},
                         {"stick", miniapp::json_number(found.c)}});
         if (wanted[k] != a || friction != f) { compare_loading(wanted[k], friction, found); }
      }
      panel.add(miniapp::exact_text("f = ", friction), wanted, d);
      panel.add(miniapp::exact_text("f = ", friction), {none},
                {none}); // a gap between the two curves
      panel.add(miniapp::exact_text("f = ", friction), wanted, c);
   }
   panel.add("thesis", std::vector<double>{2.5}, {3.75}, "thesis");
   panels.push_back(panel);
   results["map"] = list;
   std::printf("map of %zu states in %.2f s\n", list.size(), watch.seconds());
   return 0;
}

/// Load radius above which no point of a disc separates (thesis figure 7.8).
int Study::critical(const std::vector<double> &discs, const std::vector<double> &frictions)
{
   const miniapp::Stopwatch watch;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::vector<std::vector<double>> curves(frictions.size());
   std::printf("\n    b/t        f   critical a/t\n");
   for (double b : discs)
   {
      miniapp::DiscOptions own = options;
      own.disc_radius = b;
      own.twist = miniapp::Twist::none;
      miniapp::CriticalLoad disc(own);
      for (std::size_t k = 0; k < frictions.size(); ++k)
      {
         const double found = disc.radius(frictions[k]);
         curves[k].push_back(found);
         std::printf("%7.3g %8.3g %10.4f\n", b, frictions[k], found);
         list.push_back({{"disc_radius", b},
                         {"friction", frictions[k]},
                         {"load_radius", miniapp::json_number(found)}});
         struct
         {
            double b, f, a;
         } const references[] = {{3, 0, 2.367}, {3, 0.5, 1.733}, {3, 0.8, 1.341},
                                 {5, 0, 4.415}, {5, 0.5, 3.793}, {5, 0.8, 3.458},
                                 {8, 0, 7.427}, {8, 0.5, 6.810}, {8, 0.8, 6.492}};
         for (const auto &row : references)
         {
            if (!standard() || row.b != b || row.f != frictions[k]) { continue; }
            // The rim's node tells: first order in the spacing, most without friction.
            table.add(miniapp::exact_text("critical a/t, b = ", b) +
                         miniapp::exact_text(", f = ", row.f),
                      row.a, {0.002, 0.2 * options.spacing}, none, found);
         }
      }
      counters += disc.counters();
   }
   miniapp::Panel panel =
      miniapp::Panel::lines("critical", "Radius of the load above which nothing separates",
                            "radius of the load a/t", "radius of the disc b/t");
   for (std::size_t k = 0; k < frictions.size(); ++k)
   {
      panel.add(miniapp::exact_text("f = ", frictions[k]), curves[k], discs);
   }
   panel.add("a = b", discs, discs, "dashed");
   panels.push_back(panel);
   results["critical_load_radius"] = list;
   std::printf("%zu critical radii in %.2f s\n", list.size(), watch.seconds());
   return 0;
}

/// The load taken back to each of the wanted levels (descending), in steps that shrink with it.
int Study::unload(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted)
{
   const Index n = problem->nodes();
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   miniapp::Panel profiles = miniapp::Panel::lines("unloading", "Pressure p and shear q over f",
                                                   "r/t", "p/p0, q/(f p0)"),
                  diagram =
                     miniapp::Panel::zones("zones", "Zones during unloading", "P/P0", "r/t");
   auto add_profile = [&](double level, const ContactState &at)
   {
      const std::string label = miniapp::exact_text("P/P0 = ", level);
      profiles.add(label, radii(), tractions(*problem, at.p));
      profiles.add("q/f: " + label, radii(), tractions(*problem, at.q.head(n)) / f, "dashed");
   };
   diagram.add(1.0, extent(*problem, state).zones);
   add_profile(1, state);
   std::vector<NamedLoads> points{loads(1)};
   for (double level : miniapp::unloading_levels(steps, wanted.back(), wanted))
   {
      points.push_back(loads(level));
   }
   MarchSettings settings;
   settings.increments = 1;
   state.time = 0;
   std::printf("\n   P/P0    zones and their outer ends, r/t\n");
   auto observe = [&](const ContactState &now, const IncrementRecord &)
   {
      const Extent found = extent(*problem, now);
      diagram.add(load(now), found.zones);
      auto is_at = [&](double level) { return std::abs(load(now) - level) < 1e-9; };
      const auto target = std::find_if(wanted.begin(), wanted.end(), is_at);
      if (target == wanted.end()) { return; }
      if (is_at(0.5) || is_at(0.1)) { add_profile(*target, now); }
      std::printf("%7.3g  ", *target);
      print(found);
      nlohmann::ordered_json row = {{"level", *target}};
      row.update(to_json(found));
      list.push_back(row);
      if (!is(5, 2.5, 0.5)) { return; }
      for (const auto &[at, d] : {std::pair{0.9, 3.670}, {0.3, 3.254}, {0.1, 3.068}})
      {
         if (is_at(at))
         {
            table.add(miniapp::exact_text("d/t at P/P0 = ", at), d, {0.01, found.d_error}, none,
                      found.d);
         }
      }
      const double borders[] = {1.715, 2.415, 3.015, 3.402}, thesis[] = {1.6, 2.3, 2.9, 3.4};
      for (std::size_t k = 0; is_at(0.5) && k < 4 && k < found.zones.size(); ++k)
      {
         table.add("border " + std::to_string(k + 1) + " at P/P0 = 0.5", borders[k],
                   {0.01, found.zones[k].to.error}, thesis[k], found.zones[k].to.position);
         diagram.mark(0.5, thesis[k]);
      }
   };
   const int code =
      marched(march(solver, LoadHistory::through(*problem, points), state, settings, observe));
   results["unloading"] = list;
   diagram.reverse_x();
   panels.push_back(profiles);
   panels.push_back(diagram);
   return code;
}

/// T_s from the pressure of the contact without friction: steady spinning leaves none to the
/// radial direction.
int Study::spinning_limit()
{
   ReducedProblem smooth = *problem;
   set_friction(smooth, 0);
   ContactState pressed = ContactState::virgin(smooth);
   const LoadHistory pressing = LoadHistory::through(smooth, {{}, loads(1)});
   if (const int code = marched(march(smooth, pressing, pressed))) { return code; }
   limit = f * radii().dot(pressed.p);
   const Extent found = extent(smooth, pressed);
   const double d = found.d;
   results["torque_limit"] = limit;
   std::printf("\nTorsion: T_s = %.4f p0 t³, d/t without friction = %.4f\n", limit, d);
   if (is(5, 2.5, 0.5))
   {
      table.add("T_s/(p0 t³)", 17.106, {0.001, 0.004}, none, limit);
      table.add("d/t without friction", 3.1705, {5e-5, found.d_error}, none, d);
   }
   return 0;
}

/// Before the twist: what it would do to the bonded disc is its first stiffness.
Turning Study::untwisted(const ContactState &loaded) const
{
   Turning now;
   now.state = loaded;
   now.stiffness =
      -radii().dot(problem->patterns[problem->pattern("twist")].q.tail(problem->nodes()));
   return now;
}

/// One step of the twist.
int Study::advance(FrictionSolver &solver, Turning &now, double by,
                   const MarchObserver &observe)
{
   MarchSettings settings;
   settings.increments = 1;
   now.state.time = 0;
   const MarchReport report =
      march(solver, LoadHistory::through(*problem, {loads(1, now.at), loads(1, now.at + by)}),
            now.state, settings, observe);
   if (const int code = marched(report)) { return code; }
   const double before = now.torque;
   now.at += by;
   now.torque = torque(now.state);
   now.greatest = std::max(now.greatest, now.torque);
   now.descended = now.descended || now.torque < before;
   now.stiffness = std::max((now.torque - before) / by, 0.5 * now.stiffness);
   return 0;
}

/// Turns until the torque or the multiplier has a value, or the torque has passed its maximum
/// (by itself not an end for the multiplier). Steps aim at T_s/steps.
int Study::turn(FrictionSolver &solver, Turning &now, Stop stop, double value,
                const MarchObserver &observe)
{
   // Not by steps of a round-off: their rates would be noise.
   const double enough = (1 - 1e-9) * value;
   while (stop == Stop::torque ? now.torque < enough && !now.descended : now.at < enough)
   {
      double step = limit / steps / now.stiffness;
      if (stop == Stop::multiplier) { step = std::min(step, value - now.at); }
      Turning next = now;
      if (const int code = advance(solver, next, step, observe)) { return code; }
      if (stop == Stop::torque && next.torque > value)
      {
         // The part of the step that meets the value: false position.
         double low = 0, high = step, low_torque = now.torque, high_torque = next.torque;
         while (std::abs(next.torque - value) > 1e-6 * limit)
         {
            const double by =
               low + (high - low) * (value - low_torque) / (high_torque - low_torque);
            next = now;
            if (const int code = advance(solver, next, by, observe)) { return code; }
            (next.torque < value ? low : high) = by;
            (next.torque < value ? low_torque : high_torque) = next.torque;
         }
         now = next;
         return 0;
      }
      // No round-off in the last step.
      if (stop == Stop::multiplier && step == value - now.at) { next.at = value; }
      now = next;
   }
   return 0;
}

/// Twists to each of the wanted torques (ascending), and on past the greatest; or to each of
/// the wanted multipliers.
int Study::twist(FrictionSolver &solver, const ContactState &loaded, Stop stop,
                 const std::vector<double> &wanted)
{
   const Index n = problem->nodes();
   const VectorXd r = radii();
   const bool reference = is(5, 2.5, 0.5) && options.twist == miniapp::Twist::top;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   miniapp::Panel profiles = miniapp::Panel::lines("torsion", "Pressure p and shear |q| over f",
                                                   "r/t", "p/p0, |q|/(f p0)"),
                  sliding = miniapp::Panel::lines("slip", "Slip", "r/t", "|v| E/(p0 t)"),
                  diagram = miniapp::Panel::zones("torsion_zones", "Zones under torsion",
                                                  "T/T_s", "r/t");
   const auto length = [&](const VectorXd &x)
   { return VectorXd((x.head(n).array().square() + x.tail(n).array().square()).sqrt()); };
   const auto plan = [&](const char *panel_name, double share, const Turning &at)
   {
      miniapp::Panel panel = miniapp::Panel::plan(
         panel_name, text("Slip of the disc, T/T_s = %.2f", share), "x/t", "y/t");
      const Extent found = extent(*problem, at.state);
      panel.add(found.zones);
      const std::vector<NodeState> settled = settled_states(*problem, at.state);
      for (Index i = 0; i < n; ++i)
      {
         // Friction is opposed to the rate of slip.
         if (slips(settled[i]))
         {
            panel.arrow("rate", r[i], std::atan2(-at.state.q[n + i], -at.state.q[i]));
            panel.arrow("total", r[i], std::atan2(at.state.v[n + i], at.state.v[i]));
         }
      }
      return panel;
   };
   const auto profile = [&](const std::string &label, const Turning &at)
   {
      profiles.add(label, r, tractions(*problem, at.state.p));
      profiles.add("|q|/f: " + label, r, tractions(*problem, length(at.state.q)) / f, "dashed");
      sliding.add(label, r.head(n - 1), length(at.state.v).head(n - 1));
   };
   double last = -1;
   const auto observe = [&](const ContactState &now, const IncrementRecord &)
   {
      const double share = torque(now) / limit;
      if (share <= last) { return; } // a step that was cut
      diagram.add(share, extent(*problem, now).zones);
      last = share;
   };

   Turning now = untwisted(loaded);
   observe(loaded, {});
   const char *const counted = stop == Stop::torque ? "T/T_s = " : "φ = ";
   profile(miniapp::exact_text(counted, 0), now);
   std::vector<miniapp::Panel> plans{plan("plan_before", 0, now)};
   std::printf(
      "  T/T_s   rotation    c/t      d/t     slip angle at 10/50/90 %% of the annulus: "
      "rate, total\n");
   int code = 0;
   for (std::size_t k = 0; k < wanted.size() && code == 0; ++k)
   {
      code =
         turn(solver, now, stop, stop == Stop::torque ? wanted[k] * limit : wanted[k], observe);
      if (code != 0 || (stop == Stop::torque && now.descended)) { break; }
      const Extent found = extent(*problem, now.state);
      profile(miniapp::exact_text(counted, wanted[k]), now);
      const double share = now.torque / limit;
      if (k == wanted.size() / 2) { plans.push_back(plan("plan_twisted", share, now)); }
      double rate[3], total[3];
      for (int j = 0; j < 3; ++j)
      {
         const double part = j == 0 ? 0.1 : j == 1 ? 0.5 : 0.9;
         const double inner = std::isfinite(found.c) ? found.c : 0.0;
         const double outer = std::isfinite(found.d) ? found.d : options.disc_radius;
         const double at = inner + part * (outer - inner);
         rate[j] = slip_angle(r, now.state.q, at);
         total[j] = slip_angle(r, now.state.v, at);
      }
      nlohmann::ordered_json row = {{"torque", share}, {"rotation", rotation(now.state)}};
      row.update(to_json(found));
      row["slip_angle_rate"] = rate;
      row["slip_angle_total"] = total;
      list.push_back(row);
      std::printf("%7.3f %10.4f %8.4f %8.4f     %.1f %.1f %.1f, %.1f %.1f %.1f\n", share,
                  rotation(now.state), found.c, found.d, rate[0], rate[1], rate[2], total[0],
                  total[1], total[2]);
      if (!reference || stop != Stop::torque) { continue; }
      // First order in the steps.
      const double by_steps = 0.003 * 80.0 / steps;
      for (const auto &[T, c, d] :
           {std::array<double, 3>{0.3, 1.829, 3.617}, {0.7, 1.564, 3.431}})
      {
         if (wanted[k] != T) { continue; }
         table.add(miniapp::exact_text("c/t at T/T_s = ", T), c,
                   {0.003, found.c_error + by_steps}, none, found.c);
         table.add(miniapp::exact_text("d/t at T/T_s = ", T), d,
                   {0.003, found.d_error + by_steps}, none, found.d);
      }
      const double rates[] = {14, 49, 77}, totals[] = {8, 13, 37};
      for (int j = 0; j < 3 && wanted[k] == 0.5; ++j)
      {
         const std::string where = j == 0 ? "10 %" : j == 1 ? "50 %" : "90 %";
         table.add("slip angle at " + where + ", rate, °", rates[j], 1, none, rate[j]);
         table.add("slip angle at " + where + ", total, °", totals[j], 1, none, total[j]);
      }
   }
   results["torsion"] = list;
   // Under control of the torque there is nothing beyond its maximum.
   const bool rotates =
      problem->patterns[problem->pattern("twist")].control == Control::displacement;
   if (code == 0 && stop == Stop::torque && rotates)
   {
      code = turn(solver, now, Stop::torque, infinity, observe);
   }
   results["torque_max"] = miniapp::json_number(now.descended ? now.greatest : none);
   if (now.descended)
   {
      std::printf("greatest torque %.5f T_s\n", now.greatest / limit);
      if (reference)
      {
         table.add("T_max/T_s", 1.0037, {5e-5, 5e-4}, none, now.greatest / limit);
      }
   }
   panels.insert(panels.end(), {profiles, sliding, diagram});
   panels.insert(panels.end(), plans.begin(), plans.end());
   return code;
}

/** Cycles of the twist between ± what first brings the torque to `amplitude` T_s. Rotation is
   held between its limits, so that the torque may relax; torque is, under --twist traction. */
int Study::cycle(FrictionSolver &solver, const ContactState &loaded, double amplitude,
                 int cycles)
{
   Turning now = untwisted(loaded);
   if (const int code = turn(solver, now, Stop::torque, amplitude * limit, {})) { return code; }
   require(!now.descended, "option --amplitude is ", amplitude,
           ", which is above the greatest torque, ", now.greatest / limit, " T_s");
   LoadHistory history =
      LoadHistory::through(*problem, {loads(1, now.at), loads(1, -now.at), loads(1, now.at)});
   history.cycle_start = 0;
   history.cycles = cycles;
   MarchSettings settings;
   settings.increments = std::max(2, static_cast<int>(std::ceil(2 * amplitude * steps)));
   ContactState &state = now.state;
   state.time = 0;
   std::vector<Extent> ends{extent(*problem, state)};
   std::vector<double> torques{torque(state)};
   miniapp::Panel diagram = miniapp::Panel::zones("cycle_zones", "Zones under cyclic torsion",
                                                  "cycles of the torque", "r/t");
   diagram.add(0, ends[0].zones);
   const MarchReport report =
      march(solver, history, state, settings,
            [&](const ContactState &at, const IncrementRecord &record)
            {
               const Extent found = extent(*problem, at);
               diagram.add(0.5 * record.time, found.zones);
               if (std::abs(named(*problem, at.multipliers).at("twist")) < (1 - 1e-9) * now.at)
               {
                  return;
               }
               ends.push_back(found);
               torques.push_back(torque(at));
            });
   const int code = marched(report);
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::printf("\nCycles of the %s between ± %.4f, %d increments each way\n cycle    T/T_s "
               "(there, back)     c/t (there, back)     d/t (there, back)   dissipation   "
               "external work\n",
               options.twist == miniapp::Twist::traction ? "torque" : "rotation", now.at,
               settings.increments);
   for (std::size_t k = 0; k < report.cycles.size() && 2 * k + 2 < ends.size(); ++k)
   {
      const CycleRecord &record = report.cycles[k];
      const Extent &there = ends[2 * k + 1], &back = ends[2 * k + 2];
      const double T1 = torques[2 * k + 1] / limit, T2 = torques[2 * k + 2] / limit;
      std::printf("%6zu %10.4f %8.4f %12.4f %8.4f %12.4f %8.4f %13.5e %15.5e\n", k + 1, T1, T2,
                  there.c, back.c, there.d, back.d, record.dissipation, record.external_work);
      list.push_back(
         {{"torque", {T1, T2}},
          {"stick", {miniapp::json_number(there.c), miniapp::json_number(back.c)}},
          {"separation", {miniapp::json_number(there.d), miniapp::json_number(back.d)}},
          {"dissipation", record.dissipation},
          {"external_work", record.external_work},
          {"normal_work", record.normal_work},
          {"slip_change", record.slip_change}});
   }
   std::printf("d before the cycles %.4f; energy balance to %.1e; %s\n", ends[0].d,
               report.energy_imbalance,
               report.steady_cycle > 0
                  ? text("steady from cycle %.0f", report.steady_cycle).c_str()
                  : "not steady yet");
   results["cycles"] = list;
   results["energy_imbalance"] = report.energy_imbalance;
   results["steady_cycle"] = report.steady_cycle;
   panels.push_back(diagram);
   return code;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         miniapp::StudyOutput output;
         Study study;
         miniapp::DiscOptions &options = study.options;
         const char *unload_list = "", *torque_list = "", *rotation_list = "", *twist = "top";
         const char *bonded_list = "", *map_list = "", *map_friction_list = "0.5 0.8";
         const char *critical_list = "", *critical_friction_list = "0 0.5 0.8";
         double friction = 0.5, load_radius = 2.5, amplitude = 0.5;
         int cycles = 0;
         miniapp::Options args(argc, argv);
         args.AddOption(&options.disc_radius, "-disc-radius", "--disc-radius", "b, in t.");
         args.AddOption(&load_radius, "-load-radius", "--load-radius", "a, in t.");
         args.AddOption(&friction, "-friction", "--friction",
                        "Coefficient of friction (0: no tangential unknowns).");
         args.AddOption(&options.poisson, "-poisson", "--poisson",
                        "Poisson's ratio of both bodies.");
         args.AddOption(&options.domain, "-domain", "--domain",
                        "Radius and depth of the cylinder below, in t.");
         args.AddOption(&options.order, "-order", "--order", "Order of the elements.");
         args.AddOption(&options.spacing, "-spacing", "--spacing",
                        "Distance of the contact nodes, in t.");
         args.AddOption(&unload_list, "-unload", "--unload",
                        "Unloading: list of P/P0 to report (empty: none).");
         args.AddOption(&torque_list, "-torque", "--torque",
                        "Torsion: list of T/T_s to report (empty: none).");
         args.AddOption(&rotation_list, "-rotation", "--rotation",
                        "Torsion: list of rotations to report instead, in p0/E.");
         args.AddOption(&twist, "-twist", "--twist",
                        "What twists: rotation of the top, of its loaded part or of the rim, "
                        "or traction, a torque, on the loaded part.");
         args.AddOption(&cycles, "-cycles", "--cycles", "Torsion: cycles to and fro.");
         args.AddOption(&amplitude, "-amplitude", "--amplitude",
                        "Torsion: T/T_s that the cycles start from.");
         args.AddOption(&study.steps, "-steps", "--steps",
                        "Steps of 1/steps of the load or of T_s.");
         args.AddOption(&bonded_list, "-bonded", "--bonded",
                        "Bonded disc: list of a to report.");
         args.AddOption(&map_list, "-map", "--map", "Map of c and d: list of a (empty: none).");
         args.AddOption(&map_friction_list, "-map-friction", "--map-friction",
                        "Map of c and d: list of f.");
         args.AddOption(&critical_list, "-critical", "--critical",
                        "Critical radius of the load: list of b (empty: none).");
         args.AddOption(&critical_friction_list, "-critical-friction", "--critical-friction",
                        "Critical radius of the load: list of f.");
         output.add_options(args);
         args.parse();
         require(friction >= 0, "option --friction is ", friction, ", must not be negative");
         require(study.steps >= 2, "option --steps is ", study.steps, ", must be at least 2");
         require(cycles >= 0, "option --cycles is ", cycles, ", must not be negative");
         require(amplitude > 0 && amplitude <= 1, "option --amplitude is ", amplitude,
                 ", must be above 0 and at most 1");
         std::vector<double> levels = miniapp::numbers("--unload", unload_list),
                             torques = miniapp::numbers("--torque", torque_list),
                             rotations = miniapp::numbers("--rotation", rotation_list);
         const std::vector<double> bonded = miniapp::numbers("--bonded", bonded_list),
                                   map_a = miniapp::numbers("--map", map_list),
                                   map_f =
                                      miniapp::numbers("--map-friction", map_friction_list),
                                   discs = miniapp::numbers("--critical", critical_list),
                                   critical_f = miniapp::numbers("--critical-friction",
                                                                 critical_friction_list);
         for (double level : levels)
         {
            require(level > 0 && level < 1, "option --unload: ", level,
                    " must be between 0 and 1");
         }
         const auto positive = [](const char *option, const std::vector<double> &values)
         {
            for (double value : values)
            {
               require(value > 0, "option ", option, ": ", value, " must be positive");
            }
         };
         positive("--torque", torques);
         positive("--rotation", rotations);
         positive("--map-friction", map_f);
         for (double f : critical_f)
         {
            require(f >= 0, "option --critical-friction: ", f, " must not be negative");
         }
         for (double b : discs)
         {
            require(b >= 1, "option --critical: ", b,
                    " must be at least 1 (radius of a disc, in t)");
         }
         require(map_a.empty() || !map_f.empty(),
                 "option --map-friction is empty, must list the coefficients of the map");
         require(discs.empty() || !critical_f.empty(),
                 "option --critical-friction is empty, must list the coefficients");
         require(torques.empty() || rotations.empty(),
                 "options --torque and --rotation exclude each other");
         const bool twists = !torques.empty() || !rotations.empty() || cycles > 0;
         require(
            friction > 0 || (levels.empty() && !twists),
            "option --friction is 0: unloading is loading backwards, and nothing resists a "
            "twist");
         miniapp::check_choice("--twist", twist, {"top", "loaded", "rim", "traction"});
         require(
            rotations.empty() || std::string(twist) != "traction",
            "option --rotation does not go with --twist traction, which prescribes torque");
         std::sort(levels.rbegin(), levels.rend());
         std::sort(torques.begin(), torques.end());
         std::sort(rotations.begin(), rotations.end());
         options.load_radii = {load_radius};
         for (const auto &[option, list] : {std::pair{"--bonded", bonded}, {"--map", map_a}})
         {
            for (double a : list)
            {
               require(a > 0 && a <= options.disc_radius, "option ", option, ": ", a,
                       " must be above 0 and at most the disc's radius ", options.disc_radius);
               auto &all = options.load_radii;
               if (std::find(all.begin(), all.end(), a) == all.end()) { all.push_back(a); }
            }
         }
         if (twists)
         {
            options.twist = std::string(twist) == "top"      ? miniapp::Twist::top
                            : std::string(twist) == "loaded" ? miniapp::Twist::loaded
                            : std::string(twist) == "rim"    ? miniapp::Twist::rim
                                                             : miniapp::Twist::traction;
         }

         miniapp::Disc scene = miniapp::make_disc(options);
         ReducedProblem &problem = scene.reduction.problem;
         set_friction(problem, friction);
         study.problem = &problem;
         study.counters = scene.reduction.counters;
         study.a = load_radius;
         study.f = friction;
         output.reduced(problem, scene.dofs);

         const miniapp::Stopwatch solving;
         FrictionSolver solver(problem);
         study.counters += solver.counters();
         ContactState state = ContactState::virgin(problem);
         if (!bonded.empty()) { study.bonded(bonded); }
         int code = study.load(solver, state);
         if (code == 0 && !levels.empty()) { code = study.unload(solver, state, levels); }
         if (code == 0 && twists) { code = study.spinning_limit(); }
         if (code == 0 && !torques.empty())
         {
            code = study.twist(solver, state, Stop::torque, torques);
         }
         if (code == 0 && !rotations.empty())
         {
            code = study.twist(solver, state, Stop::multiplier, rotations);
         }
         if (code == 0 && cycles > 0) { code = study.cycle(solver, state, amplitude, cycles); }
         if (code == 0 && !map_a.empty()) { code = study.map(map_a, map_f); }
         if (code == 0 && !discs.empty()) { code = study.critical(discs, critical_f); }
         std::printf("\n%.2f s in the studies, %ld increments, %ld Newton steps\n",
                     solving.seconds(), study.counters.increments, study.counters.newton_steps);
         if (!study.table.empty())
         {
            study.table.note("The thesis names neither ν nor the extent of its half-space, and "
                             "its values were read off figures.");
         }
         if (!torques.empty())
         {
            study.table.note("Its slip directions are those of the total slip; friction is "
                             "opposed to the rate, tens of degrees away.");
         }
         if (!bonded.empty())
         {
            study.table.note("Its bonded numbers (critical a = 2.1, separation at 0.65 b for "
                             "a = 0.5) hang on p ~ 1e-3 p0 near the rim:");
            study.table.note("ill-conditioned, so the profile is compared. f > 0.543 keeps "
                             "the corner together, not the whole edge.");
         }
         output.write(study.results, study.counters, study.table, study.panels);
         return code;
      });
}
