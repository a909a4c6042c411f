#include "fretting/fretting_page.hpp"

#include "fretting/hertz_surface.hpp"

#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using Json = nlohmann::ordered_json;

namespace
{

/// The range of stress that a plain specimen endures.
double endured_range(const FatigueMaterial &material)
{
   return (material.fatigue_limit_basis == Basis::range ? 1 : 2) * material.fatigue_limit.low;
}

/// Is it not safe by mode II, the measure for a slip zone that yields?
bool fails_by_mode_two(const FrettingReport &report)
{
   return report.mode_two_utilisation > 1 && report.yield_ratio_full >= 1;
}

std::string mode_two_text(const FrettingReport &report)
{
   if (!(report.mode_two_utilisation > 1)) { return ""; }
   const std::string times =
      text(" ΔK_II is %.4g times its threshold", report.mode_two_utilisation);
   return fails_by_mode_two(report)
             ? times + ", and the slip zone yields: not safe by mode II."
             : times + text(", but this measure is for a slip zone that yields, and this one "
                            "does not (%.2g of the load of full yield).",
                            report.yield_ratio_full);
}

std::string verdict_text(const FrettingReport &report, const FatigueMaterial &material)
{
   const double depth = 1e3 * report.threshold.arrest_depth;
   switch (report.threshold.verdict)
   {
   case CrackVerdict::propagates:
      return "PROPAGATES: a crack that starts at the contact edge is still driven above the "
             "threshold when it has the critical length. Expect fretting failure.";
   case CrackVerdict::arrests_beyond_a0:
      return "ARRESTS BEYOND a0: a crack grows past the critical length, but its stress "
             "intensity "
             "falls and it stops at about " +
             text("%.4g µm", depth) +
             ". Expect a crack; whether it is harmless needs the whole stress field.";
   case CrackVerdict::arrests:
      break;
   }
   if (depth == 0)
   {
      return "ARRESTS: no crack starts; the fatigue limit is not reached at the edge.";
   }
   const double endured = endured_range(material);
   const bool starts = report.edge_stress_range > endured;
   return "ARRESTS: a crack may start" +
          (starts ? text(" (the range of the edge stress, %.4g MPa, is above the range at the "
                         "fatigue limit, %.4g MPa)",
                         report.edge_stress_range, endured)
                  : "") +
          " but stops at about " + text("%.4g µm", depth) +
          ", before the critical length. Safe by this criterion, the arrest of the crack." +
          mode_two_text(report);
}

/// The validity that lowers the trust most.
std::string trust_text(const FrettingReport &report)
{
   std::string measures;
   for (const Validity &item : report.validity)
   {
      if (item.trust != report.trust || item.measure.empty()) { continue; }
      measures += (measures.empty() ? "" : ", ") + item.measure + text(" = %.4g", item.value);
   }
   return "Trust in this result: " + to_string(report.trust) +
          (measures.empty() ? "" : " (" + measures + ")");
}

const char *criterion_text(Criterion criterion)
{
   switch (criterion)
   {
   case Criterion::range:
      return "algebraic range of K_I, closed or open (B)";
   case Criterion::half_range:
      return "tensile half of the range of K_I (C)";
   case Criterion::open:
      break;
   }
   return "range of K_I while the crack is open (A)";
}

std::string number(double value, const std::string &unit = "")
{
   return text("%.4g", value) + (unit.empty() ? "" : " " + unit);
}

/// The ± of a fit; nothing for closed forms.
std::string with_error(const FittedIntensity *fit)
{
   return fit ? "± " + text("%.2g", fit->relative_error * std::abs(fit->value)) +
                   " (estimate, fitted); "
              : "";
}

/// A page with the meaning of each of its numbers, which go to the results as well.
class Page
{
public:
   explicit Page(Study &study) : study_(study) { study.lead["rows"] = Json::array(); }

   void line(const std::string &what, const std::string &value, const std::string &meaning = "")
   {
      beside(what, value, meaning);
      study_.say("   " + padded(what, 23) + padded(value, 24) + meaning);
   }
   /// A line of the page of --html alone.
   void beside(const std::string &what, const std::string &value, const std::string &meaning)
   {
      study_.lead["rows"].push_back({what, value, meaning});
   }
   void value(const std::string &key, const std::string &what, double x,
              const std::string &unit = "", const std::string &meaning = "")
   {
      study_.value(key, x);
      if (std::isfinite(x)) { line(what, number(x, unit), meaning); }
   }

private:
   Study &study_;
};

} // namespace

void print_page(Study &study, const Pad &pad, const SolvedPad *solved,
                const PadContact &contact, const JudgedEdge &judged,
                const FrettingSettings &criteria)
{
   const FrettingReport &r = judged.report;
   const FatigueMaterial &m = pad.material;
   const double a = contact.half_width > 0 ? contact.half_width : none;
   const std::string verdict = verdict_text(r, m);
   // The edge field knows K_N and K_T only; the solved contact has its own values beside it.
   const std::string field = "by the edge field, from K_N and K_T";
   const PadEdge *const edge = !solved                     ? nullptr
                               : judged.edge == "trailing" ? &solved->trailing
                                                           : &solved->leading;
   const EnergyComparison energy =
      edge && edge->energy ? *edge->energy : EnergyComparison{none, none, none, none};
   study.title("FRETTING ASSESSMENT: " + pad.kind + " pad, " + m.name + ", " +
               (pad.plane_stress ? "plane stress" : "plane strain"));
   study.say(wrapped(
      text(
         "E %.4g GPa, ν %.4g, ΔK_th %.4g MPa√m, fatigue limit %.4g MPa, shear yield %.4g MPa, "
         "friction %.4g",
         1e-3 * m.young, m.poisson, m.threshold / mpa_sqrt_m, m.fatigue_limit.low,
         m.shear_yield.low, pad.friction),
      3));
   study.say(wrapped(verdict, 3) + wrapped(trust_text(r) + ", see the section on trust.", 3));
   Page page(study);
   study.lead["sentence"] = verdict + " " + trust_text(r) + ".";
   study.lead["calm"] = r.threshold.verdict == CrackVerdict::arrests && !fails_by_mode_two(r);
   if (pad.kind != "kn")
   {
      page.beside(
         "loads",
         text("P %.4g, Q %.4g N/mm, bulk %.4g MPa", pad.normal, pad.shear, pad.bulk_or_none()),
         text("Q and bulk stress go between their values and %.4g times these",
              pad.load_ratio));
   }
   page.beside("material " + m.name,
               text("E %.4g GPa, ν %.4g, f %.4g", 1e-3 * m.young, m.poisson, pad.friction),
               text("ΔK_th %.4g MPa√m = %.4g MPa√mm and fatigue limit %.4g MPa, both %s; shear "
                    "yield %.4g MPa",
                    m.threshold / mpa_sqrt_m, m.threshold, m.fatigue_limit.low,
                    m.fatigue_limit_basis == Basis::range ? "ranges" : "amplitudes",
                    m.shear_yield.low));
   study.say("1. What the contact edge feels");
   page.value("half_width", "half width a", a, "mm", "of the contact");
   page.value("k_n", "K_N", contact.k_n, "MPa/√mm",
              with_error(edge ? &edge->edge.k_n : nullptr) +
                 "pressure at distance t from the edge: K_N √t");
   page.value("k_t_trailing", "K_T trailing edge", contact.k_t.trailing, "MPa√mm",
              with_error(solved ? &solved->trailing.edge.k_t : nullptr) +
                 "shear there if nothing slipped: K_T/√t");
   page.value("k_t_leading", "K_T leading edge", contact.k_t.leading, "MPa√mm",
              with_error(solved ? &solved->leading.edge.k_t : nullptr) +
                 (contact.k_t.leading < 0 ? "negative: the shear force outweighs the bulk"
                                          : "shear there if nothing slipped"));
   page.value("k_t_range", "ΔK_T", r.k_t_range, "MPa√mm",
              "range over the cycle; judged below: the " + judged.edge + " edge");

   study.title("2. Slip and stress");
   page.value("slip_zone", "slip zone d", r.slip_zone, "mm",
              (a > 0 ? number(100 * r.slip_zone / a, "% of a, ") : "") + field);
   if (edge)
   {
      page.line("slip zone d, contact", number(edge->edge.slip_zone, "mm"),
                "± " + text("%.2g", edge->edge.slip_zone_error) +
                   " (estimate), of the solved contact");
   }
   page.value("edge_stress", "edge stress", r.edge_stress, "MPa",
              "along the surface, at peak load, by the edge field");
   if (solved)
   {
      const SolvedPad::Stress stress = solved->edge_stress(judged.edge == "trailing");
      study.results["edge_stress_contact_error_estimate"] = stress.error;
      page.value("edge_stress_contact", "edge stress, contact", stress.value, "MPa",
                 "± " + text("%.2g", stress.error) +
                    " (estimate), the same of the solved contact, with bulk stress, "
                    "extrapolated to the edge (figures have less, by their nodes)");
   }
   if (pad.kind == "hertz")
   {
      // The edge field leaves out the bulk stress beside K_T, and the width of the contact.
      const HertzSurface surface(pad);
      const double at_edge =
         judged.edge == "trailing" ? -contact.half_width : contact.half_width;
      if (surface.valid())
      {
         page.value("edge_stress_contact", "edge stress, contact", surface.stress(at_edge),
                    "MPa",
                    "the same by Hertz and Mindlin, with bulk stress by Nowell and Hills");
      }
      else
      {
         page.line("edge stress, contact", "-",
                   "no closed form where an edge slips against the shear; --pad fe solves it");
      }
   }
   page.value("edge_stress_range", "edge stress, range", r.edge_stress_range, "MPa",
              "largest less least over the cycle, by the edge field; range at the fatigue "
              "limit: " +
                 number(endured_range(m), "MPa"));
   page.value("yield_ratio_first", "load / first yield", r.yield_ratio_first, "",
              "above 1: part of the slip zone yields");
   page.value("yield_ratio_full", "load / full yield", r.yield_ratio_full, "",
              "above 1: the whole slip zone yields");

   study.title("3. Crack normal to the surface at the edge");
   page.line("critical length a0", number(1e3 * r.critical_length, "µm"),
             "shorter cracks obey the fatigue limit, longer ones ΔK_th");
   page.line("K_I at a0", number(r.k_i_min) + " to " + number(r.k_i_max, "MPa√mm"),
             "over the cycle; negative: pressed shut");
   page.line("driving force / ΔK_th", number(r.threshold.drive / m.threshold),
             std::string("driving force: ") + criterion_text(criteria.criterion) +
                "; above 1 a crack of the length a0 grows");
   page.line("ΔK_T / ΔK_th", number(r.ordinate),
             "threshold curve at X = " + number(r.abscissa) + ": " +
                number(r.threshold_ordinate) + ", above which it grows (edge field alone)");
   page.value("mode_two_utilisation", "ΔK_II / its threshold", r.mode_two_utilisation, "",
              "above 1 not safe, where the slip zone yields");

   study.title("4. Frictional energy per cycle");
   const auto beside_solved =
      [&](const std::string &what, double value, const std::string &unit)
   {
      if (std::isfinite(value))
      {
         page.line(what, number(value, unit), "of the solved contact");
      }
   };
   page.value("energy_max", "energy/cycle, largest", r.energy_max, "N/mm",
              "per area (= mJ/mm²), a quarter into the slip zone, " + field);
   beside_solved("energy/cycle, largest", energy.computed_max, "N/mm");
   page.value("energy_total", "energy/cycle, total", r.energy_total, "N",
              "per mm of edge (= mJ/mm), " + field);
   beside_solved("energy/cycle, total", energy.computed_total, "N");

   study.title("5. How far to trust it");
   Json validity = Json::array();
   for (const Validity &item : r.validity)
   {
      validity.push_back({{"measure", item.measure},
                          {"value", item.measure.empty() ? none : item.value},
                          {"trust", to_string(item.trust)},
                          {"text", item.text}});
      const std::string measure =
         item.measure.empty() ? "" : item.measure + " = " + number(item.value) + ". ";
      study.say(wrapped("[" + to_string(item.trust) + "] " + measure + item.text, 3));
   }
   study.list("validity", validity);
   const double width = contact.rounded_width > 0 ? contact.rounded_width : a;
   study.results.update(
      {{"units", "N, mm, MPa, forces per mm of thickness"},
       {"pad", pad.kind},
       {"material", m.name},
       {"poisson_ratio", m.poisson},
       {"friction", pad.friction},
       {"load_ratio", pad.load_ratio},
       {"edge_width", width},
       {"judged_edge", judged.edge},
       {"critical_length", r.critical_length},
       {"k_i_max", r.k_i_max},
       {"k_i_min", r.k_i_min},
       {"k_threshold", m.threshold},
       {"fatigue_limit", m.fatigue_limit.low},
       {"mode_two_k_t", criteria.mode_two_ratio * m.threshold / mode_two_range(1)},
       {"drive", r.threshold.drive},
       {"threshold_x", r.abscissa},
       {"threshold_y", r.threshold_ordinate},
       {"design_y", r.ordinate},
       {"verdict", to_string(r.threshold.verdict)},
       {"arrest_depth", r.threshold.arrest_depth},
       {"trust", to_string(r.trust)},
       {"validity", validity}});
}

void print_solution(Study &study, const SolvedPad &solved)
{
   study.title(text("6. The solved contact (%ld nodes, %.4g s)",
                    static_cast<long>(solved.positions.size()), solved.seconds));
   const double middle =
      0.5 * (solved.trailing.edge.position.position + solved.leading.edge.position.position);
   Json &fe = study.results["fe"];
   fe = {{"half_width", solved.half_width},
         {"steady_cycle", solved.steady_cycle},
         {"dofs", solved.dofs},
         {"seconds", solved.seconds},
         {"counters", to_json(solved.counters)}};
   for (const bool trailing : {true, false})
   {
      const PadEdge &solution = trailing ? solved.trailing : solved.leading;
      const char *const name = trailing ? "trailing" : "leading";
      Json &j = fe[name];
      j = report_edge(study, solution, name, -middle);
      j["slip_zone_reversed"] = solution.reversed_slip_zone;
      j["resolved"] = solution.resolved;
      if (solution.edge.k_t.value != 0 && !solution.resolved)
      {
         study.say(wrapped("The slip zone is shorter than two spacings of the contact nodes (" +
                              number(solved.spacing, "mm") +
                              "): its computed length and energy are not resolved; K_N and K_T "
                              "are. More --nodes resolve it.",
                           6));
      }
   }
   study.list("edges", {fe["trailing"], fe["leading"]});
}

} // namespace miniapp
