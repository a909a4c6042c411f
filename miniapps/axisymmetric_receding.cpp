//  axisymmetric_receding: an elastic disc pressed onto a half-space, unloaded, or twisted
//
//  Thesis chapter 7. The disc, of thickness t and radius b, is pressed by p0 on its top for
//  r < a; beyond r = d it lifts off, and slip spreads between d and a stick zone r < c. Loading
//  is self-similar: one increment is exact. Twisting turns the whole top by a prescribed angle
//  with the pressure held, so that the torque may pass a maximum; T_s = f Σ r p with the
//  pressure of the contact without friction is what steady spinning meets. Units t = p0 = E
//  = 1.
//
//  Sample runs:  axisymmetric_receding
//                axisymmetric_receding -unload "0.9 0.5 0.3 0.1" -spacing 0.04
//                axisymmetric_receding -torque "0.3 0.5 0.7" -spacing 0.04

#include "common/disc_scene.hpp"
#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/zones.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <iostream>
#include <limits>

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

/// Separation and stick radius; NaN where there is none.
struct Extent
{
   double d = none, c = none;
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
   const Zone &first = result.zones.front(), &last = result.zones.back();
   if (last.state == NodeState::separation) { result.d = last.from.position; }
   if (first.state == NodeState::stick && result.zones.size() > 1)
   {
      result.c = first.to.position;
   }
   return result;
}

nlohmann::ordered_json to_json(const Extent &extent)
{
   auto number = [](double x)
   { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr); };
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   for (const Zone &zone : extent.zones)
   {
      list.push_back(
         {{"state", name(zone.state)}, {"from", zone.from.position}, {"to", zone.to.position}});
   }
   return {{"separation", number(extent.d)}, {"stick", number(extent.c)}, {"zones", list}};
}

void print(const Extent &extent)
{
   for (const Zone &zone : extent.zones)
   {
      std::printf("  %s %.3f", name(zone.state), zone.to.position);
   }
   std::printf("\n");
}

struct Study
{
   ReducedProblem *problem = nullptr;
   Counters counters;
   miniapp::ReferenceTable table;
   nlohmann::ordered_json results;
   double a = 0, b = 0, f = 0;
   bool standard = false; ///< ν and domain of the reference values

   bool is(double b_, double a_, double f_) const
   {
      return standard && b == b_ && a == a_ && f == f_;
   }
   VectorXd loads(double load, double rotation) const;
   int load(FrictionSolver &solver, ContactState &state);
   int unload(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted,
              int steps);
   int twist(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted,
             int steps);
   double torque(const ContactState &state) const;
};

VectorXd Study::loads(double load, double rotation) const
{
   VectorXd at = VectorXd::Zero(problem->patterns.size());
   at[0] = load;
   if (at.size() > 1) { at[problem->pattern("twist")] = rotation; }
   return at;
}

/// Torque that the disc passes on: Σ r q_θ, opposed to its slip.
double Study::torque(const ContactState &state) const
{
   const Index n = problem->nodes();
   return -problem->position.col(0).dot(state.q.tail(n));
}

int Study::load(FrictionSolver &solver, ContactState &state)
{
   const MarchReport report =
      march(solver, LoadHistory::through({loads(0, 0), loads(1, 0)}), state);
   counters += report.counters;
   results["status"] = name(report.status);
   if (const int code = miniapp::exit_code(report)) { return code; }
   const Extent found = extent(*problem, state);
   std::printf("\nLoading, b = %g, a = %g, f = %g: d/t = %.4f, c/t = %.4f\n", b, a, f, found.d,
               found.c);
   results.update(to_json(found));
   // ± of the reference and a tenth of the spacing for the read-out.
   const double tolerance = 0.001 + 0.1 * (problem->arc_length[1] - problem->arc_length[0]);
   struct
   {
      double b, a, f, d, c, thesis;
   } const references[] = {{5, 0.5, 0.9, 2.625, 0.849, 2.6},
                           {5, 2.5, 0.5, 3.728, 1.879, 3.75},
                           {5, 2.5, 0.8, 4.046, 2.384, none}};
   for (const auto &r : references)
   {
      if (!is(r.b, r.a, r.f)) { continue; }
      table.add("d/t, loaded", r.d, tolerance, r.thesis, found.d);
      table.add("c/t, loaded", r.c, tolerance, none, found.c);
   }
   return 0;
}

/// The load taken back to each of the wanted levels (descending), in steps that shrink with it.
int Study::unload(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted,
                  int steps)
{
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::printf("\n   P/P0    zones and their outer ends, r/t\n");
   double level = 1;
   for (double target : wanted)
   {
      std::vector<VectorXd> points{loads(level, 0)};
      while (level > target)
      {
         level = std::max(target, level - std::min(1.0 / steps, 0.2 * level));
         points.push_back(loads(level, 0));
      }
      MarchSettings settings;
      settings.increments = 1;
      state.time = 0;
      const MarchReport report = march(solver, LoadHistory::through(points), state, settings);
      counters += report.counters;
      if (const int code = miniapp::exit_code(report)) { return code; }
      const Extent found = extent(*problem, state);
      std::printf("%7.3g  ", target);
      print(found);
      nlohmann::ordered_json row = {{"level", target}};
      row.update(to_json(found));
      list.push_back(row);
      if (!is(5, 2.5, 0.5)) { continue; }
      for (const auto &[at, d] : {std::make_pair(0.9, 3.670), {0.3, 3.254}, {0.1, 3.068}})
      {
         if (target == at)
         {
            table.add("d/t at P/P0 = " + std::to_string(at).substr(0, 3), d, 0.01, none,
                      found.d);
         }
      }
      const double borders[] = {1.715, 2.415, 3.015, 3.402}, thesis[] = {1.6, 2.3, 2.9, 3.4};
      for (std::size_t k = 0; target == 0.5 && k < 4 && k < found.zones.size(); ++k)
      {
         table.add("border " + std::to_string(k + 1) + " at P/P0 = 0.5", borders[k], 0.01,
                   thesis[k], found.zones[k].to.position);
      }
   }
   results["unloading"] = list;
   return 0;
}

/// Turns the top until the torque has passed its maximum. Steps aim at equal steps of torque.
int Study::twist(FrictionSolver &solver, ContactState state, const std::vector<double> &wanted,
                 int steps)
{
   const Index n = problem->nodes();
   const VectorXd r = problem->position.col(0);
   ReducedProblem smooth = *problem;
   set_friction(smooth, 0);
   ContactState pressed = ContactState::virgin(smooth);
   const MarchReport alone =
      march(smooth, LoadHistory::through({loads(0, 0), loads(1, 0)}), pressed);
   if (const int code = miniapp::exit_code(alone)) { return code; }
   const double limit = f * r.dot(pressed.p);
   results["torque_limit"] = limit;
   std::printf("\nTorsion: T_s = %.4f p0 t³, d/t without friction = %.4f\n", limit,
               extent(smooth, pressed).d);
   const bool reference = is(5, 2.5, 0.5);
   if (reference)
   {
      table.add("T_s/(p0 t³)", 17.106, 0.005, none, limit);
      table.add("d/t without friction", 3.1705, 0.003, none, extent(smooth, pressed).d);
   }
   MarchSettings settings;
   settings.increments = 1;
   const Index rotation = problem->pattern("twist");
   const double bonded =
      -r.dot(problem->patterns[rotation].q.tail(n)); // torque of a unit angle
   double stiffness = bonded, angle = 0, greatest = 0;
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   std::size_t next = 0;
   std::printf("  T/T_s     c/t      d/t     slip angle at 10/50/90 %% of the annulus: rate, "
               "total\n");
   while (angle < 100 * limit / bonded)
   {
      const ContactState before = state;
      const double step = limit / steps / stiffness;
      auto turn = [&](ContactState &from, double by)
      {
         from.time = 0;
         const MarchReport report =
            march(solver, LoadHistory::through({loads(1, angle), loads(1, angle + by)}), from,
                  settings);
         counters += report.counters;
         return miniapp::exit_code(report);
      };
      if (const int code = turn(state, step)) { return code; }
      const double old = torque(before), now = torque(state);
      // A wanted torque lies within the step: that part of it.
      if (next < wanted.size() && now >= wanted[next] * limit)
      {
         ContactState at = before;
         if (const int code = turn(at, step * (wanted[next] * limit - old) / (now - old)))
         {
            return code;
         }
         const Extent found = extent(*problem, at);
         nlohmann::ordered_json row = {{"torque", torque(at) / limit}};
         row.update(to_json(found));
         double rate[3], total[3];
         for (int k = 0; k < 3; ++k)
         {
            const double share = k == 0 ? 0.1 : k == 1 ? 0.5 : 0.9;
            Index i = 0;
            (r.array() - (found.c + share * (found.d - found.c))).abs().minCoeff(&i);
            rate[k] = std::atan2(std::abs(at.q[n + i]), std::abs(at.q[i])) * 180 / M_PI;
            total[k] = std::atan2(std::abs(at.v[n + i]), std::abs(at.v[i])) * 180 / M_PI;
         }
         row["slip_angle_rate"] = rate;
         row["slip_angle_total"] = total;
         list.push_back(row);
         std::printf("%7.3f %8.4f %8.4f     %.1f %.1f %.1f, %.1f %.1f %.1f\n",
                     torque(at) / limit, found.c, found.d, rate[0], rate[1], rate[2], total[0],
                     total[1], total[2]);
         for (const auto &[T, c, d] :
              {std::array<double, 3>{0.3, 1.829, 3.617}, {0.7, 1.564, 3.431}})
         {
            if (!reference || wanted[next] != T) { continue; }
            const std::string where = " at T/T_s = " + std::to_string(T).substr(0, 3);
            table.add("c/t" + where, c, 0.003 + 0.2 / steps, none, found.c);
            table.add("d/t" + where, d, 0.003 + 0.2 / steps, none, found.d);
         }
         const double rates[] = {14, 49, 77}, totals[] = {8, 13, 37};
         for (int k = 0; k < 3 && reference && wanted[next] == 0.5; ++k)
         {
            const std::string where = k == 0 ? "10 %" : k == 1 ? "50 %" : "90 %";
            table.add("slip angle at " + where + ", rate, °", rates[k], 1, none, rate[k]);
            table.add("slip angle at " + where + ", total, °", totals[k], 1, none, total[k]);
         }
         ++next;
      }
      angle += step;
      greatest = std::max(greatest, now);
      if (now <= old) { break; }
      stiffness = std::max((now - old) / step, 0.5 * stiffness);
   }
   results["torque_max"] = greatest;
   results["torsion"] = list;
   std::printf("greatest torque %.5f T_s\n", greatest / limit);
   if (reference) { table.add("T_max/T_s", 1.0037, 0.0005, none, greatest / limit); }
   return 0;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const miniapp::Stopwatch watch;
         Study study;
         miniapp::DiscOptions options;
         const char *unload_list = "", *torque_list = "", *json = "";
         double friction = 0.5, load_radius = 2.5;
         int steps = 40;
         mfem::OptionsParser args(argc, argv);
         args.AddOption(&options.disc_radius, "-disc-radius", "--disc-radius", "b, in t.");
         args.AddOption(&load_radius, "-load-radius", "--load-radius", "a, in t.");
         args.AddOption(&friction, "-friction", "--friction", "Coefficient of friction.");
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
         args.AddOption(&steps, "-steps", "--steps", "Steps of 1/steps of the load or of T_s.");
         args.AddOption(&json, "-json", "--json", "File for the results.");
         miniapp::parse(args);
         require(friction > 0, "option --friction is ", friction, ", must be positive");
         require(steps >= 2, "option --steps is ", steps, ", must be at least 2");
         std::vector<double> levels = miniapp::numbers("--unload", unload_list),
                             torques = miniapp::numbers("--torque", torque_list);
         for (double level : levels)
         {
            require(level > 0 && level < 1, "option --unload: ", level,
                    " must be between 0 and 1");
         }
         for (double torque : torques)
         {
            require(torque > 0 && torque <= 1, "option --torque: ", torque,
                    " must be above 0 and at most 1");
         }
         std::sort(levels.rbegin(), levels.rend());
         std::sort(torques.begin(), torques.end());

         options.load_radii = {load_radius};
         if (!torques.empty()) { options.twist = miniapp::Twist::top; }
         miniapp::Disc scene = miniapp::make_disc(options);
         ReducedProblem &problem = scene.reduction.problem;
         set_friction(problem, friction);
         study.problem = &problem;
         study.counters = scene.reduction.counters;
         study.a = load_radius;
         study.b = options.disc_radius;
         study.f = friction;
         study.standard = options.poisson == 0.3 && options.domain == 100;
         const double condensed = watch.seconds();
         std::cout << "Condensed " << scene.dofs << " dofs to "
                   << (problem.components() + 1) * problem.nodes() << " in " << condensed
                   << " s" << std::endl;

         const miniapp::Stopwatch solving;
         FrictionSolver solver(problem);
         ContactState state = ContactState::virgin(problem);
         int code = study.load(solver, state);
         if (code == 0 && !levels.empty())
         {
            code = study.unload(solver, state, levels, steps);
         }
         if (code == 0 && !torques.empty())
         {
            code = study.twist(solver, state, torques, steps);
         }
         std::printf("%.2f s in the friction solver, %ld increments, %ld Newton steps\n",
                     solving.seconds(), study.counters.increments, study.counters.newton_steps);
         study.table.print();
         nlohmann::ordered_json &results = study.results;
         results["contact_nodes"] = problem.nodes();
         results["dofs"] = scene.dofs;
         results["seconds"] = watch.seconds();
         results["seconds_condensation"] = condensed;
         results["counters"] = miniapp::to_json(study.counters);
         results["references"] = study.table.json();
         miniapp::write_json(results, json);
         return code;
      });
}
