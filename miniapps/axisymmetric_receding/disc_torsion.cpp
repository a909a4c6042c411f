#include "axisymmetric_receding/disc_torsion.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <tuple>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

Extent Disc::extent(const ReducedProblem &of, const ContactState &state) const
{
   // Arc length counts from the first node, radii from the axis, which belongs to the node next
   // to it.
   Extent found = miniapp::extent(of, state, true, of.position(0, 0) - of.arc_length[0]);
   found.zones.front().from.position = 0;
   return found;
}

void spinning_limit(Study &study, Disc &disc)
{
   ReducedProblem smooth = disc.problem();
   set_friction(smooth, 0);
   Run run(study, smooth);
   run.to(disc.pressed());
   disc.limit = disc.f * disc.radii().dot(run.state.p);
   const Extent found = disc.extent(smooth, run.state);
   study.title("Torsion");
   study.value("torque_limit", disc.limit, "torque of steady spinning T_s", none, "p0 t³");
   study.value("frictionless_separation", found.separation, "d/t without friction",
               found.separation_error);
}

namespace
{

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

/// A surface of the disc: its zones and the directions of slip.
void plan(Study &study, Disc &disc, const char *name, const Turned &at)
{
   const ReducedProblem &problem = disc.problem();
   const Index n = problem.nodes();
   Panel &panel =
      study.panel(Panel::Kind::plan, name,
                  text("Slip of the disc, T/T_s = %.2f", at.torque / disc.limit), "x/t", "y/t");
   panel.add(disc.extent(at.state).zones);
   const std::vector<NodeState> settled = settled_states(problem, at.state);
   for (Index i = 0; i < n; ++i)
   {
      if (!slips(settled[i])) { continue; }
      // Friction is opposed to the rate of slip.
      const auto &[v, q] = std::tie(at.state.v, at.state.q);
      panel.arrow("rate", problem.position(i, 0), std::atan2(-q[n + i], -q[i]));
      panel.arrow("total", problem.position(i, 0), std::atan2(v[n + i], v[i]));
   }
}

} // namespace

void twist(Study &study, Disc &disc, Run &run, Turning::Stop stop,
           const std::vector<double> &wanted)
{
   const ReducedProblem &problem = disc.problem();
   const Index n = problem.nodes();
   const VectorXd r = disc.radii();
   const bool by_torque = stop == Turning::Stop::torque;
   Turning turning(run, disc.pressed(), disc.limit, disc.steps);
   Turned now = turning.untwisted(run.state);
   Panel &profiles = study.lines("torsion_tractions", "Pressure p and shear |q| over f", "r/t",
                                 "p/p0, |q|/(f p0)"),
         &sliding = study.lines("slip", "Slip", "r/t", "|v| E/(p0 t)"),
         &directions = study.lines("slip_angles",
                                   "Angle of slip from the radius, of its rate and in total",
                                   "r/t", "degrees"),
         &diagram = study.panel(Panel::Kind::zones, "torsion_zones", "Zones under torsion",
                                "T/T_s", "r/t");
   const auto length = [n](const VectorXd &x)
   { return VectorXd((x.head(n).array().square() + x.tail(n).array().square()).sqrt()); };
   const auto profile = [&](double at)
   {
      const std::string label = exact_text(by_torque ? "T/T_s = " : "φ = ", at);
      profiles.add(label, r, tractions(problem, now.state.p));
      profiles.add("|q|/f: " + label, r, tractions(problem, length(now.state.q)) / disc.f,
                   "dashed");
      sliding.add(label, r.head(n - 1), length(now.state.v).head(n - 1));
      const std::vector<NodeState> settled = settled_states(problem, now.state);
      std::vector<double> radii, rate, total;
      for (Index i = 0; i < n; ++i)
      {
         if (!slips(settled[i])) { continue; }
         radii.push_back(r[i]);
         rate.push_back(slip_angle(r, now.state.q, r[i]));
         total.push_back(slip_angle(r, now.state.v, r[i]));
      }
      directions.add(label, radii, rate);
      directions.add("total: " + label, radii, total, "dashed");
   };
   double last = -1;
   const auto observe = [&](const ContactState &state, const IncrementRecord &)
   {
      const double share = torque(problem, state) / disc.limit;
      if (share <= last) { return; } // a step that was cut
      diagram.add(share, disc.extent(state).zones);
      last = share;
   };
   observe(now.state, {});
   profile(0);
   plan(study, disc, "plan_before", now);
   study.title("Slip angles at 10, 50 and 90 % of the annulus: of the rate, of the total");
   ResultTable &table = study.table("torsion", {{"torque", "T/T_s", "%.3f"},
                                                {"rotation", "rotation"},
                                                {"stick", "c/t"},
                                                {"separation", "d/t"},
                                                {"rate_10", "rate 10 %", "%.1f"},
                                                {"rate_50", "rate 50 %", "%.1f"},
                                                {"rate_90", "rate 90 %", "%.1f"},
                                                {"total_10", "total 10 %", "%.1f"},
                                                {"total_50", "total 50 %", "%.1f"},
                                                {"total_90", "total 90 %", "%.1f"},
                                                {"wanted"}});
   for (std::size_t k = 0; k < wanted.size(); ++k)
   {
      turning.on(now, stop, by_torque ? wanted[k] * disc.limit : wanted[k], observe);
      if (by_torque && now.descended)
      {
         const std::string message =
            text("there is no equilibrium at T/T_s = %g, above the greatest torque, %.4f T_s: "
                 "the disc spins",
                 wanted[k], now.greatest / disc.limit);
         study.say(message);
         study.results["status"] = name(FrictionStatus::gross_sliding);
         study.results["message"] = message;
         study.code = 2;
         break;
      }
      profile(wanted[k]);
      if (k == wanted.size() / 2) { plan(study, disc, "plan_twisted", now); }
      const Extent found = disc.extent(now.state);
      const double inner = std::isfinite(found.stick) ? found.stick : 0.0,
                   outer = std::isfinite(found.separation) ? found.separation
                                                           : disc.options.disc_radius;
      std::vector<double> rate, total;
      for (double part : {0.1, 0.5, 0.9})
      {
         const double at = inner + part * (outer - inner);
         rate.push_back(slip_angle(r, now.state.q, at));
         total.push_back(slip_angle(r, now.state.v, at));
      }
      study.row(table,
                {now.torque / disc.limit, turning.rotation(now.state), found.stick,
                 found.separation, rate[0], rate[1], rate[2], total[0], total[1], total[2],
                 by_torque ? wanted[k] : none},
                found.errors(), found.json());
   }
   // If the torque is prescribed, there is no state beyond its maximum.
   const bool rotates =
      problem.patterns[problem.pattern("twist")].control == Control::displacement;
   if (by_torque && rotates)
   {
      turning.on(now, stop, std::numeric_limits<double>::infinity(), observe);
   }
   study.value("torque_max", now.descended ? now.greatest : none);
   if (now.descended)
   {
      study.value("greatest_torque", now.greatest / disc.limit, "greatest torque", none, "T_s");
   }
}

void cycle(Study &study, Disc &disc, Run &run, double amplitude, int cycles)
{
   const ReducedProblem &problem = disc.problem();
   Turning turning(run, disc.pressed(), disc.limit, disc.steps);
   Turned now = turning.untwisted(run.state);
   turning.on(now, Turning::Stop::torque, amplitude * disc.limit);
   require(!now.descended, "option --amplitude is ", amplitude,
           ", which is above the greatest torque, ", now.greatest / disc.limit, " T_s");
   run.state = now.state;
   run.settings.increments =
      std::max(2, static_cast<int>(std::ceil(2 * amplitude * disc.steps)));
   Panel &diagram = study.panel(Panel::Kind::zones, "cycle_zones", "Zones under cyclic torsion",
                                "cycles of the torque", "r/t");
   std::vector<Extent> ends{disc.extent(now.state)};
   std::vector<double> torques{now.torque};
   diagram.add(0, ends[0].zones);
   LoadHistory history = LoadHistory::through(
      problem, {turning.loads(now.at), turning.loads(-now.at), turning.loads(now.at)});
   history.cycle_start = 0;
   history.cycles = cycles;
   run.march(history,
             [&](const ContactState &at, const IncrementRecord &record)
             {
                const Extent found = disc.extent(at);
                diagram.add(0.5 * record.time, found.zones);
                const double twist = named(problem, at.multipliers).at("twist");
                if (std::abs(twist) < (1 - 1e-9) * now.at) { return; }
                ends.push_back(found);
                torques.push_back(torque(problem, at));
             });
   study.title(text("Cycles of the %s between ± %.4f, %d increments each way; d/t before %.4f",
                    disc.options.twist == Twist::traction ? "torque" : "rotation", now.at,
                    run.settings.increments, ends[0].separation));
   ResultTable &table =
      study.table("cycles", {{"cycle", "cycle"},
                             {"torque_there", "T/T_s there"},
                             {"torque_back", "and back"},
                             {"stick_there", "c/t there"},
                             {"stick_back", "and back"},
                             {"separation_there", "d/t there"},
                             {"separation_back", "and back"},
                             {"dissipation", "dissipation", "%.5e"},
                             {"external_work", "external work", "%.5e"},
                             {"work twist"},
                             {"stiffness twist", "stiffness twist", "%.4e"},
                             {"loss_factor twist", "loss factor twist", "%.4f"}});
   const auto &records = run.report.cycles;
   for (std::size_t k = 0; k < records.size() && 2 * k + 2 < ends.size(); ++k)
   {
      const Extent &there = ends[2 * k + 1], &back = ends[2 * k + 2];
      const LoopFigures loop =
         figures(problem, run.report, records[k], problem.pattern("twist"));
      study.row(
         table,
         {k + 1, torques[2 * k + 1] / disc.limit, torques[2 * k + 2] / disc.limit, there.stick,
          back.stick, there.separation, back.separation, records[k].dissipation,
          external_work(problem, run.report, records[k]), loop.work, loop.stiffness,
          loop.loss_factor},
         {},
         {{"normal_work", records[k].normal_work}, {"slip_change", records[k].slip_change}});
   }
   report_steady(study, run.report);
}

} // namespace miniapp
