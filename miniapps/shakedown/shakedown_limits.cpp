#include "common/williams.hpp"
#include "shakedown/shakedown_study.hpp"

#include <algorithm>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

void Shakedown::report(const std::string &what, const LimitReport &of, double load_factor,
                       double f)
{
   const bool found =
      of.status == LimitStatus::certified || of.status == LimitStatus::bracketed;
   const std::string limit_of =
      "exact limit of the " + what +
      (what == "friction" ? text(", f, for λ from %g to %g", lambda_max, lambda_max * reversal)
                          : ", λ, for " + law() + text(" and R = %g", reversal));
   study.value(what + "_limit", of.limit, limit_of);
   results[what + "_limit_status"] = name(of.status);
   study.say(found ? text("      proven between %.8f and %.8f", of.lower, of.upper)
                   : std::string("      none: ") + name(of.status));
   study.say(text("      %s; violation %.1e, %ld programmes, %d iterations, %.3f s",
                  of.message.empty() ? name(of.status) : of.message.c_str(), of.violation,
                  of.counters.limit_solves, of.iterations, of.seconds));
   if (what == "friction" || find == "load")
   {
      // If a limit was not found, nothing is proven. An unlimited load is proven up to `lower`.
      const bool bounds = found || of.status == LimitStatus::unlimited;
      results["bound_lower"] = bounds ? of.lower : std::nan("");
      results["bound_upper"] = bounds ? of.upper : std::nan("");
      results["violation"] = of.violation;
      results["status"] = name(of.status);
      study.lead = {
         {"sentence",
          told(
             "The ", limit_of,
             found ? told(", is ", name(of.status), ": it lies between ",
                          text("%.8f", of.lower), " and ", text("%.8f", of.upper))
                   : told(": ", name(of.status)),
             ". This holds for the mesh of this run, and as long as all nodes of the contact "
             "stay closed. Adhesion and the methods 1 and 2 are computed at nodes, with the ± "
             "of the mesh in the table of references.",
             saved ? ""
                   : " λ = Q/P is the cycled load, from λmax to R λmax; f the coefficient of "
                     "friction; v slip; a the half-width of the contact; E' = E/(1-ν²). P = a "
                     "= E' = 1.")},
         {"rows", ordered_json::array()}};
   }
   if (!found) { return; }
   results[what + "_limit_starts"] = of.starts;
   if (what == "friction") { study.say("      " + of.starts); }
   const double share = share_of_ends(problem, stuck_forces(problem, cycle), of, load_factor);
   // The report says where the mesh decides a limit. For the punch this is known to be so below
   // the friction that its corners need.
   std::string why = of.of_the_mesh;
   if (why.empty() && standard && f < williams_ratio[0])
   {
      why = text("%.0f %% of the mechanism's work is done within 1 %% of the ends of the "
                 "contact line, where tractions are singular",
                 100 * share) +
            figure_of_the_mesh(what == "friction");
   }
   results[what + "_limit_work_at_ends"] = share;
   results[what + "_limit_of_the_mesh"] = !why.empty();
   if (why.empty()) { return; }
   study.say("      of this mesh only: " + why);
   results[what + "_limit_statement"] = why;
}

void Shakedown::monolith()
{
   const Incipience opening = incipient_separation(problem, cycle, 0, inner);
   const Incipience slip = incipient_slip(problem, cycle, 0, inner);
   const auto place = [&](const Incipience &at)
   { return at.node >= 0 ? text("at x = %.3f", x[at.node]) : ""; };
   study.title("Monolith, away from the ends");
   study.value("first_slip", slip.load_factor, "first slip away from the ends at λ", none,
               place(slip));
   study.value("first_opening", opening.load_factor, "first opening away from the ends at λ",
               none, place(opening));
   for (const auto &[key, at] : {std::pair("first_slip_x", slip), {"first_opening_x", opening}})
   {
      study.results[key] = at.node >= 0 ? x[at.node] : none;
   }
   // Beyond this load a node has opened: nothing adheres there, whatever the friction.
   double opens = incipient_separation(problem, cycle, 0).load_factor;
   const char *by = "the nodal forces of this mesh";
   if (standard)
   {
      // Beyond the third element and up to 5 % of the half-width: the load at which the mode
      // I intensity of the pressure vanishes.
      const VectorXd &arc = problem.arc_length;
      const Index first = 3 * punch.order,
                  count = std::lower_bound(arc.data() + first, arc.data() + arc.size(), 0.05) -
                          (arc.data() + first);
      Eigen::MatrixXd p(count, 2);
      p << traction(problem.patterns[problem.pattern(held)].p).segment(first, count),
         traction(problem.patterns[problem.pattern(cycled)].p).segment(first, count);
      const Eigen::MatrixXd K = williams_strengths(arc.segment(first, count), p);
      const double corner_opens = -K(0, 0) / K(0, 1);
      results["corner_opening"] = corner_opens;
      if (std::isfinite(corner_opens)) // the mesh is fine enough for the fit
      {
         study.value("corner_opening", corner_opens, "trailing corner opens at λ (a fit)");
         opens = std::min(opening.load_factor, corner_opens);
         by = "the fit";
      }
      ResultTable &table = study.table("adhesion", {{"load_factor", "λ", "%.1f"},
                                                    {"friction", "f for full adhesion"},
                                                    {"x", "at x", "%.3f"}});
      for (const Adhesion &at : adhesion_map(problem, cycle, 0, {0.4, 0.6, 0.8}, inner))
      {
         study.row(table, {at.load_factor, at.friction, largest_inside(at)});
      }
      if (std::isfinite(corner_opens)) { leave_corner(opens); }
   }
   if (adhesion) { draw_adhesion(opens, by); }
   if (steps) { draw_monolith(); }
}

double Shakedown::largest_inside(const Adhesion &at) const
{
   const VectorXd ratio =
      traction_ratio(problem, cycle.constant + at.load_factor * cycle.varying.col(0));
   const auto slope = [&](Index k)
   { return (std::abs(ratio[k + 1]) - std::abs(ratio[k])) / (x[k + 1] - x[k]); };
   const Index i = at.node;
   if (i == 0 || i + 1 == x.size()) { return x[i]; }
   const double before = slope(i - 1), after = slope(i);
   return 0.5 * (x[i - 1] + x[i] + (x[i + 1] - x[i - 1]) * before / (before - after));
}

void Shakedown::leave_corner(double opens)
{
   const auto of = [&](double load_factor)
   { return adhesion_map(problem, cycle, 0, {load_factor}, inner).front(); };
   double low = 0, high = opens;
   if (of(low).friction > williams_ratio[0] || of(high).friction < williams_ratio[0])
   {
      return;
   }
   while (high - low > 1e-6)
   {
      const double middle = 0.5 * (low + high);
      (of(middle).friction < williams_ratio[0] ? low : high) = middle;
   }
   study.value("corner_decides_up_to", low, "the corner decides adhesion up to λ");
   study.value("leaves_corner_to", largest_inside(of(high)), "and then a place inside, x");
}

void Shakedown::draw_adhesion(double opens, const char *by)
{
   ResultTable &table = study.table("adhesion_map", {{"load_factor", "λ", "%.3f"},
                                                     {"", "f for full adhesion"},
                                                     {"", "at x"},
                                                     {"open"},
                                                     {"friction"},
                                                     {"x"}});
   table
      .draw("Friction for full adhesion", "load_factor", "λ = Qmax/P", {{"friction", "f"}},
            "friction coefficient f")
      .shade(opens, 1, "an end is open");
   std::vector<double> factors;
   for (int k = 0; k <= 40; ++k) { factors.push_back(0.025 * k); }
   for (const Adhesion &at : adhesion_map(problem, cycle, 0, factors, inner))
   {
      const bool open = at.load_factor > opens;
      const bool at_corner = standard && at.friction < williams_ratio[0];
      const double f = at_corner ? williams_ratio[0] : at.friction,
                   where = at_corner ? 1.0 : x[at.node];
      study.row(table,
                {at.load_factor, open ? "open" : text("%.4f", f),
                 open ? "" : text("%.3f", where), open, open ? none : f, open ? none : where});
   }
   study.value("adhesion_opens", opens);
   study.say(text("open: beyond λ = %.4f an end of the contact has opened, and no friction "
                  "adheres there (by %s)",
                  opens, by));
   if (!standard) { return; }
   const VectorXd ratios = traction_ratio(problem, cycle.constant);
   const double at_node = std::max(std::abs(ratios[0]), std::abs(ratios[ratios.size() - 1]));
   study.value("corner_node_ratio", at_node);
   study.say(wrapped(
      text(
         "f = %.4f at x = 1 is the ratio of the singular tractions. The forces of the "
         "corner node have the ratio %.4f under P alone, on any mesh. With friction between "
         "the two a march slips at that node and the next one. This slip falls as the mesh is "
         "refined. It is an artefact.",
         williams_ratio[0], at_node),
      0));
}

void Shakedown::smallest_friction()
{
   study.title(text("Smallest friction for λ = %g … %g", lambda_max, lambda_max * reversal));
   const PointwiseEstimate first = method1_friction(problem, cycle, lambda_max, inner);
   study.value("method1", first.value, "f by method 1 (thesis, 4.9)", none,
               text("at x = %.3f", x[first.node]));
   if (problem.components() == 1) { method2(first.value); }
   least = smallest(limit);
   report("friction", least, lambda_max, least.limit);
   if (!transposed) { return; }
   const LimitReport other = smallest(limit_problem(with_B_transposed(), cycle));
   study.value("friction_limit_transposed", other.limit, "exact with B transposed");
}

/// The coupling block of (4.10) as printed is the transpose of (3.25)'s.
ReducedProblem Shakedown::with_B_transposed() const
{
   ReducedProblem other = problem;
   other.B() = problem.B().transpose().eval();
   complete(other); // the rigid motions of the bodies are not those of this matrix
   return other;
}

void Shakedown::method2(double f1)
{
   const Method2Estimate second = method2_friction(limit, lambda_max, inner);
   study.counters += second.counters;
   if (steps) { draw_estimates(second, f1); }
   if (!second.exists)
   {
      study.say("   method 2: none: " + second.message);
      return;
   }
   study.value("method2_low", second.low, "f by method 2, least of all residual tractions");
   study.value("method2_high", second.high, "f by method 2, most of all residual tractions");
   study.value("method2_natural", second.natural,
               "f by method 2, residual traction without resultant");
   Panel &panel = study.lines("method2", "Permissible residual shear, method 1",
                              of_punch("x/a", "arc length"), of_punch("-a q/P", "-q"));
   panel.add("permissible", x, -traction(second.residual_high), "band");
   panel.add("permissible", x, -traction(second.residual_low), "band");
   panel.add("without resultant", x, -traction(second.natural_residual), "dashed");
   panel.say("inside", "0.1");
}

void Shakedown::largest_load()
{
   study.title(text("Largest load for %s and R = %g", law().c_str(), reversal));
   if (coulomb)
   {
      study.value("method1_load", method1_load(problem, cycle, inner).value,
                  "λ by method 1 (thesis, 4.9)");
   }
   report("load", most, most.limit, friction);
   results["load_limit_lower"] = most.lower;
   results["load_limit_upper"] = most.upper;
   if (most.status == LimitStatus::certified) { lower(); }
   if (std::isfinite(most.upper) && !part.open.empty()) { check_open_nodes(); }
   if (load_ratios) { ratios(); }
}

void Shakedown::ratios()
{
   std::vector<Column> columns = {
      {"reversal", "R", "%g"}, {"friction", "f", "%g"}, {"ratio", "exact λ/f", "%.5f"}};
   if (transposed) { columns.push_back({"transposed", "with B transposed", "%.5f"}); }
   ResultTable &table = study.table("load_ratio", columns);
   LimitProblem other;
   if (transposed) { other = limit_problem(with_B_transposed(), cycle); }
   for (const auto &[R, f] : {std::pair{-1.0, 0.85}, {-1.0, 1.0}, {-0.5, 0.85}})
   {
      limit.cycle = other.cycle = cycle_of(problem, R);
      set_friction(limit.reduced, f);
      // Often one of these limits was just found.
      const bool known = R == reversal && f == friction;
      const double load = known ? most.limit : largest(limit).limit;
      std::vector<ordered_json> row = {R, f, load / f};
      if (transposed)
      {
         set_friction(other.reduced, f);
         row.emplace_back(largest(other).limit / f);
      }
      study.row(table, row);
   }
   as_before();
   study.value("method1_ratio",
               method1_load(problem, cycle_of(problem, -1), inner).value / friction,
               "method 1, λ/f at R = -1");
}

void Shakedown::lower()
{
   // For uncoupled contacts and for two nodes it is known without an optimisation.
   const bool known = limit.residual.uncoupled || problem.nodes() == 2;
   if (!known && !lower_limits && starts == 0)
   {
      const char *const statement =
         "slip changes the pressure here (B is not zero): up to this load some starts shake "
         "down, and others may slip for ever";
      study.say(std::string("      ") + statement +
                "; --lower gives the load that is proven for all starts");
      results["lower_limit_statement"] = statement;
      return;
   }
   Watch watch("lower limit");
   LimitSettings settings;
   settings.monitor = watch.monitor();
   const LowerLimitReport proven = lower_limit(limit, most, settings);
   study.counters += proven.counters;
   if (proven.status == LimitStatus::stopped) { stopped("the lower limit was not found yet"); }
   tell_starts(most, proven);
   study.say("   " + most.starts);
   results["load_limit_starts"] = most.starts;
   if (proven.kind != LowerLimitKind::none) { study.value("lower_limit", proven.value, "λ1"); }
   results["lower_limit_statement"] = proven.message;
   if (lower_limits &&
       (proven.kind == LowerLimitKind::bound || proven.kind == LowerLimitKind::none))
   {
      lower_apart(settings);
   }
   if (starts == 0)
   {
      if (proven.kind == LowerLimitKind::bound || proven.kind == LowerLimitKind::none)
      {
         study.say("   nothing was observed: --starts N marches from N random slips");
      }
      return;
   }
   CounterExampleSettings search;
   search.starts = starts;
   search.transient = of_cycles(watch);
   const CounterExample found = find_counter_example(limit, most, proven.value, search);
   study.counters += found.counters;
   study.say(text("   %s: %d marches", found.message.c_str(), found.marches));
   study.value("counter_example", found.found ? found.load_factor : none,
               "smallest λ that slips on");
   study.value("quiet_up_to", found.quiet);
   study.value("opens_at", found.opens, "smallest λ that leaves nodes opening and slipping");
   if (settings.monitor.stopped()) { stopped(found.message); }
}

void Shakedown::lower_apart(const LimitSettings &settings)
{
   ResultTable &table =
      study.table("lower_limits_apart", {{"apart", "exempt nodes"},
                                         {"distance", "up to from an end", "%.4g"},
                                         {"load_factor", "λ"},
                                         {"share", "over λ2", "%.4f"}});
   const VectorXd &arc = problem.arc_length;
   std::size_t before = 0;
   for (const double share : {0.0, 0.0025, 0.005, 0.01, 0.025})
   {
      NodeList apart, inside = nodes_away_from_ends(problem, share);
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         if (!std::binary_search(inside.begin(), inside.end(), i)) { apart.push_back(i); }
      }
      if (apart.size() == before || inside.empty()) { continue; }
      before = apart.size();
      const LowerLimitReport of = lower_limit(limit, most, settings, apart);
      study.counters += of.counters;
      if (of.status == LimitStatus::stopped)
      {
         stopped("the lower limits with exempt nodes were not found yet");
      }
      if (of.kind != LowerLimitKind::apart) { continue; }
      if (table.json().empty()) { study.say("      " + of.message + ":"); }
      study.row(table, {apart.size(), share * (arc[arc.size() - 1] - arc[0]), of.value,
                        of.value / most.limit});
   }
}

std::string Shakedown::law() const
{
   return coulomb ? text("f = %g", friction) : "the law of friction given";
}

VectorXd Shakedown::traction(const VectorXd &force) const
{
   return force.cwiseQuotient(problem.weights);
}

} // namespace miniapp
