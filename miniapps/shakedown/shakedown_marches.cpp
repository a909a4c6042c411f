#include "shakedown/shakedown_study.hpp"

#include <algorithm>
#include <array>
#include <cattaneo/shakedown/residual_forces.hpp>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// The result of a march.
const char *outcome(const TransientReport &run)
{
   return run.verdict == TransientVerdict::no_equilibrium ? name(run.status)
                                                          : name(run.verdict);
}

} // namespace

TransientReport Shakedown::counted(TransientReport run)
{
   warn_of_cut_off(run.cut_off);
   study.counters += run.counters;
   if (run.verdict == TransientVerdict::stopped) { stopped(run.message); }
   return run;
}

TransientSettings Shakedown::of_cycles(Watch &watch) const
{
   TransientSettings settings;
   settings.cycles = cycles;
   settings.march.monitor = watch.monitor();
   return settings;
}

void Shakedown::check_open_nodes()
{
   double smallest = std::numeric_limits<double>::infinity();
   const Eigen::MatrixXd vertices = cycle.multipliers(most.limit);
   for (Index j = 0; j < vertices.cols(); ++j)
   {
      smallest = std::min(smallest, part.open_gaps(most.slip, vertices.col(j)).minCoeff());
   }
   study.value("smallest_open_gap", smallest, "smallest gap of open nodes", none,
               smallest >= 0 ? "the assumption holds" : "the assumption FAILS");
   const LimitProblem all = limit_problem(whole, cycle_of(whole, reversal));
   FrictionSolver solver(whole);
   Watch watch("march of the whole contact");
   VectorXd start = VectorXd::Zero(whole.slips());
   for (std::size_t i = 0; i < part.closed.size(); ++i)
   {
      for (Index c = 0; c < whole.components(); ++c)
      {
         start[c * whole.nodes() + part.closed[i]] =
            most.slip[c * problem.nodes() + static_cast<Index>(i)];
      }
   }
   ResultTable &table =
      study.table("whole_contact", {{"load_factor", "whole contact at λ", "%.6f"},
                                    {"outcome", "outcome"},
                                    {"loss", "loss/energy", "%.2e"}});
   for (const double side : {-0.01, 0.01})
   {
      const TransientReport run =
         counted(transient(solver, all, (1 + side) * most.limit, start, of_cycles(watch)));
      const double loss = run.dissipation.empty() ? none : run.dissipation.back();
      study.row(table, {run.load_factor, outcome(run), loss / run.energy});
   }
}

void Shakedown::draw_optimal()
{
   const LimitReport &of = best();
   if (of.slip.size() == 0 || !std::isfinite(of.limit) || problem.components() != 1) { return; }
   const double at = find != "load" ? lambda_max : most.limit,
                f = find != "load" ? least.limit : friction;
   const StuckForces stuck = stuck_forces(problem, cycle);
   const VectorXd residual_q = problem.A() * of.slip, residual_p = problem.B() * of.slip;
   const Eigen::MatrixXd q = stuck.q(at), p = stuck.p(at).colwise() + residual_p;
   study
      .lines("optimal_slip", "Optimal slip", of_punch("x/a", "arc length"),
             of_punch("v E'/P", "v"))
      .add("", x, of.slip);
   Panel &residual =
            study.lines("residual", "Residual tractions", of_punch("x/a", "arc length"),
                        of_punch("-q a/P, p a/P", "-q, p")),
         &band = study.lines("optimal",
                             coulomb ? "Permissible residual shear, optimal pressures"
                                     : "Optimal residual shear",
                             of_punch("x/a", "arc length"), of_punch("-a q/P", "-q"));
   // In the thesis shear is positive in the direction of Q.
   residual.add("shear", x, VectorXd(-traction(residual_q)));
   residual.add("pressure", x, traction(residual_p));
   if (coulomb)
   {
      band.add("permissible", x, traction((-f * p + q).rowwise().maxCoeff()), "band");
      band.add("permissible", x, traction((f * p + q).rowwise().minCoeff()), "band");
   }
   band.add("optimal", x, VectorXd(-traction(residual_q)), "dashed");
   // Tractions are singular at the ends, so the end values do not set the scale of the picture.
   for (Panel *panel : {&residual, &band}) { panel->say("inside", "0.1"); }
}

void Shakedown::marches()
{
   if (best().slip.size() == 0) { return; }
   study.title(text("Marches at %s, λ = %g … %g (shaken down: the loss decays, and is "
                    "below 1e-6)",
                    law().c_str(), lambda_max, lambda_max * reversal));
   ResultTable &table = study.table("marches", {{"start", "start"},
                                                {"first_loss", "first loss", "%.4e"},
                                                {"last_loss", "last loss", "%.4e"},
                                                {"decay", "decay", "%.3f"},
                                                {"cycles", "cycles"},
                                                {"opened_nodes", "nodes that open", "%.0f"},
                                                {"opened_loss", "loss at these", "%.1e"},
                                                {"outcome", "outcome"}});
   Panel &losses =
      study.lines("losses", "Loss in the cycle", "cycle", of_punch("loss × E'/P²", "loss"));
   losses.say("scale", "semilogy");
   FrictionSolver solver(limit.reduced);
   Watch watch("march");
   VectorXd optimal = best().slip;
   if (best().ray.size()) { optimal += lambda_max * best().ray; }
   bool opened = false;
   std::vector<std::string> ended;
   for (const auto &[start, sign] :
        {std::pair{"zero", 0.0}, {"optimal", 1.0}, {"negative optimal", -1.0}})
   {
      const TransientReport run =
         counted(transient(solver, limit, lambda_max, sign * optimal, of_cycles(watch)));
      const auto &loss = run.dissipation;
      // Without a whole cycle the value is unknown, not zero.
      const auto seen = [&](double value) { return loss.empty() ? none : value; };
      const auto opened_nodes = static_cast<double>(run.opened.size());
      const bool ends = run.status != FrictionStatus::converged;
      const NamedLoads at = ends ? named(problem, run.event_multipliers) : NamedLoads();
      ordered_json more = {{"dissipation", loss}, {"status", name(run.status)}};
      if (ends) { more.update({{"event_time", run.event_time}, {"event_loads", at}}); }
      study.row(table,
                {start, loss.empty() ? none : loss.front(), loss.empty() ? none : loss.back(),
                 seen(run.decay), loss.size(), seen(opened_nodes), seen(run.opened_loss),
                 outcome(run)},
                {}, more);
      if (ends)
      {
         study.say("      " + event_text(run.event_time, at) + ": " + run.message);
         ended.push_back(start);
         if (ended.size() == 1)
         {
            // The outcome of the march is that of the run. The limits have their own status.
            study.code = 2;
            results["status"] = name(run.status);
            results["message"] = run.message;
            results["event_time"] = run.event_time;
            results["event_loads"] = at;
         }
      }
      if (!run.opened.empty())
      {
         study.say(text("      the nodes that open: x = %.4f … %.4f", x[run.opened.front()],
                        x[run.opened.back()]));
         opened = true;
      }
      if (sign == 0)
      {
         results["dissipation_first_cycle"] = loss.empty() ? none : loss.front();
      }
      for (std::size_t k = 0; k < loss.size(); ++k)
      {
         losses.point(std::string("start: ") + start + " slip", k + 1.0,
                      loss[k] > 0 ? loss[k] : none);
      }
   }
   if (!ended.empty())
   {
      results["message"] = "marches from " + listed(ended) +
                           " slip, of the first: " + results["message"].get<std::string>();
   }
   if (opened)
   {
      study.say(std::string("Where nodes open the bounds above do not apply: they assume "
                            "that ") +
                assumption + ".");
   }
   if (most.status != LimitStatus::certified) { return; }
   const TransientBracket bracket = transient_bracket(limit, most, 0.005, of_cycles(watch));
   for (const auto *side : {&bracket.below, &bracket.above})
   {
      std::string line = text(
         "0.5 %% %s the largest load (λ = %.4f):", side == &bracket.below ? "below" : "above",
         side->front().load_factor);
      for (const TransientReport &run : *side)
      {
         line += std::string(" ") + outcome(counted(run)) + ",";
      }
      study.say(line + " from the same starts");
   }
}

void Shakedown::limit_map()
{
   const Stopwatch watch;
   ResultTable &table = study.table("map", {{"friction", "f", "%.2f"},
                                            {"reversal", "R", "%.2f"},
                                            {"ratio", "λmax/f", "%.5f"},
                                            {"load_limit"},
                                            {"lower"},
                                            {"upper"}});
   table.draw("Largest load, R = λmin/λmax", "ratio", "Qmax/fP", {{"friction", "f"}},
              "friction coefficient f", {"reversal", "R"});
   LimitReport column[4];
   for (int k = 0; k < 12; ++k)
   {
      const double f = 0.55 + 0.05 * k;
      set_friction(limit.reduced, f);
      for (int r = 0; r < 4; ++r)
      {
         const double R = std::array<double, 4>{-1, -0.75, -0.5, 0}[r];
         limit.cycle = cycle_of(problem, R);
         column[r] = largest(limit, k > 0 ? &column[r] : nullptr);
         const LimitReport &of = column[r];
         study.row(table, {f, R, of.limit / f, of.limit, of.lower, of.upper});
      }
   }
   as_before();
   results["map_seconds"] = watch.seconds();
   study.say(text("48 limits in %.1f s", watch.seconds()));
}

void Shakedown::repeat(const char *table_name, const PunchOptions &other)
{
   ResultTable &table = study.table(table_name, {{"nodes", "nodes"},
                                                 {"plane_stiffness", "plane/block", "%g"},
                                                 {"plane_poisson", "its ν", "%.3g"},
                                                 {"alpha", "Dundurs α", "%.4f"},
                                                 {"beta", "β", "%.4f"},
                                                 {"dofs", "dofs"},
                                                 {"coupling", "coupling"},
                                                 {"friction_limit", "least f", "%.6f"},
                                                 {"load_limit", "largest λ", "%.6f"},
                                                 {"load_limit_reversed", "λ, R = -1", "%.6f"}});
   Scene changed = make_punch(other);
   study.counters += changed.reduction.counters;
   LimitProblem on = limit_problem(changed.problem(), cycle_of(changed.problem(), reversal));
   set_friction(on.reduced, friction);
   const double f = smallest(on).limit, load = largest(on).limit;
   on.cycle = cycle_of(changed.problem(), -1);
   // Dundurs' constants [Dundurs 1969]. The block is body 1, and a rigid plane is infinitely
   // stiff.
   const double nu = other.poisson,
                below = std::isnan(other.plane_poisson) ? nu : other.plane_poisson,
                share = other.half_plane ? 1 / (1 + other.plane_stiffness) : 0,
                alpha = 2 * share - 1,
                beta = 0.5 * (share * (1 - 2 * below) / (1 - below) -
                              (1 - share) * (1 - 2 * nu) / (1 - nu));
   study.row(table, {other.nodes, other.half_plane ? other.plane_stiffness : none,
                     other.half_plane ? below : none, alpha, beta, changed.dofs, on.coupling, f,
                     load, largest(on).limit});
}

} // namespace miniapp
