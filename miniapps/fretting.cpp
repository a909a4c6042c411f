//  fretting: will a crack grow from the edge of this contact? Slip, yield, threshold and energy
//
//  A pad is pressed on a specimen (P), sheared (Q) and the specimen is pulled (bulk stress), in
//  a cycle between the peak load and R times it, at constant P. The edge of an incomplete
//  contact knows of all that only two numbers: K_N, how fast the pressure rises, and K_T, how
//  strong the shear would be if nothing slipped. From them follow the slip zone, the stresses,
//  the growth of a crack normal to the surface, the Kitagawa-Takahashi verdict and the
//  frictional energy. The pad 'fe' finds the two numbers in a finite element solution of the
//  contact and compares slip zone and energy with the computed ones.
//
//  Units: N, mm, MPa; forces per mm of thickness. Material data in GPa, MPa and MPa sqrt(m).
//
//  Sample runs:  fretting
//                fretting -P 400 -r 50 -Q 60 -bs 80 -m Al -f 0.7
//                fretting -p flat-rounded -r 3 -b 3 -P 1000 -Q 20 -bs 20 -m Ti6Al4V
//                fretting -p kn -kn 4000 -kt 20 -f 0.6 -E 115 -m Ti6Al4V
//                fretting -p fe -Q 50
//                fretting -p fe -Q 50 -bs 30 -nodes 201
//                fretting -Q 5 -bs 10 -plot results/fretting
//                fretting -plot results/fretting -rec miniapps/data/fretting_records.csv

#include "common/contact_edges.hpp"
#include "common/figure.hpp"
#include "common/hertz_scene.hpp"
#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace cattaneo;
using namespace cattaneo::fretting;
using Json = nlohmann::ordered_json;

namespace
{

using fretting::Edge; // not the edge of a zone

const double pi = std::acos(-1.0);
const double unset = std::numeric_limits<double>::quiet_NaN();
bool given(double value)
{
   return !std::isnan(value);
}

/// The contact and its loads, as given on the command line or by one test record.
struct Design
{
   std::string pad = "hertz";
   double radius = 100, flat = unset;
   double normal = 400, shear = 50;
   double bulk = unset, bulk_pad = 0;
   double load_ratio = -1;
   double friction = unset;
   double k_n = unset, k_t = unset, half_width = unset;
   int nodes = 101, order = 2; ///< of the finite element contact
};

struct Setting
{
   FatigueMaterial material;
   FrettingSettings criteria;
   bool plane_stress = false;
};

/// Both edges of the contact, where they are known.
struct Contact
{
   double half_width = 0.0, rounded_width = 0.0, k_n = 0.0;
   ShearIntensities k_t; ///< leading: NaN if unknown
   double stress_gradient = 0.0;
};

/// One edge of the finite element contact over one steady cycle.
struct SolvedEdge : miniapp::SolvedEdge
{
   double reversed_slip_zone = 0.0; ///< computed, back at peak load
};

struct SolvedContact
{
   double half_width = 0.0, spacing = 0.0; ///< of the contact and of its nodes
   SolvedEdge trailing, leading;
   FrictionStatus status = FrictionStatus::converged;
   int steady_cycle = 0, dofs = 0;
   double seconds = 0.0;
   Counters counters;
};

/// Fewer spacings than two do not carry the slip in a zone, nor its energy.
bool resolved(const SolvedEdge &edge, const SolvedContact &solved)
{
   const double predicted = slip_zone(near_edge(edge.edge));
   return std::min(predicted, edge.edge.slip_zone) >= 2 * solved.spacing;
}

double bulk_of(const Design &design)
{
   return given(design.bulk) ? design.bulk : 0;
}

/// The cylinder on a half-plane, pressed and sheared by finite elements.
SolvedContact solve_contact(const Design &design, const Setting &setting,
                            const Contact &closed_form)
{
   const miniapp::Stopwatch watch;
   const FatigueMaterial &m = setting.material;
   miniapp::HalfPlanes options;
   options.order = design.order;
   options.nodes = design.nodes;
   options.half_width = closed_form.half_width;
   options.material = {m.young, m.poisson,
                       setting.plane_stress ? PlaneState::stress : PlaneState::strain};
   options.load = design.normal;
   options.bulk = bulk_of(design) != 0;
   options.bulk_pad = design.bulk_pad != 0;
   // The far size costs the bulk's equilibrium digits; the contact does not feel it.
   options.domain = 1e3;
   miniapp::HertzScene scene = make_scene(options);
   ReducedProblem &problem = scene.reduction.problem;
   set_friction(problem, design.friction);
   problem.gap = problem.position.col(0).array().square() / (2 * design.radius);

   /// The normal load, and a share of the peak of what varies.
   const auto loads = [&](double share)
   {
      NamedLoads at = {{"P", 1}, {"Q", share * (design.shear / design.normal)}};
      if (options.bulk) { at["bulk"] = share * bulk_of(design); }
      if (options.bulk_pad) { at["bulk pad"] = share * design.bulk_pad; }
      return at;
   };

   SolvedContact solved;
   solved.dofs = scene.dofs;
   solved.counters = scene.reduction.counters;
   FrictionSolver solver(problem);
   solved.counters += solver.counters();
   ContactState state = ContactState::virgin(problem);
   const auto go = [&](LoadHistory history)
   {
      state.time = 0;
      const MarchReport report = march(solver, history, state);
      solved.counters += report.counters;
      miniapp::warn_of_cut_off(report.cut_off);
      require(report.status == FrictionStatus::converged,
              "the finite element contact ends in '", name(report.status),
              "' before the peak load: ", report.message);
      return report;
   };
   go(LoadHistory::through(problem, {{}, loads(0)}));
   const ContactState pressed = state;
   go(LoadHistory::through(problem, {loads(0), loads(1)}));
   const ContactState peak = state;
   LoadHistory cycle =
      LoadHistory::through(problem, {loads(1), loads(design.load_ratio), loads(1)});
   cycle.cycle_start = 0;
   cycle.cycles = 4;
   const MarchReport report = go(cycle);
   solved.steady_cycle = report.steady_cycle;

   const double modulus = contact_modulus(m.young, m.poisson, setting.plane_stress);
   const std::vector<ContactEdge> edges = contact_edges(problem, pressed, peak);
   const std::vector<ContactEdge> reversed = contact_edges(problem, pressed, state);
   require(edges.size() == 2 && reversed.size() == 2, "the finite element contact has ",
           edges.size(), " edges instead of 2: refine it with --nodes.");
   for (const std::size_t e : {0, 1})
   {
      // Shear on the specimen points into the contact at its left edge if Q > 0.
      SolvedEdge &solution = e == 0 ? solved.trailing : solved.leading;
      solution.edge = edges[e];
      solution.reversed_slip_zone = reversed[e].slip_zone;
      solution.k_t_range = (1 - design.load_ratio) * std::abs(edges[e].k_t.value);
      solution.energy =
         compare_energy(problem, edges[e], report.cycles.back(), solution.k_t_range, modulus);
   }
   solved.half_width = edges[0].half_width;
   solved.spacing = 2 * options.span * options.half_width / (options.nodes - 1);
   solved.seconds = watch.seconds();
   return solved;
}

/** What the finite elements give beside the closed forms of Hertz and Mindlin (with bulk
   stress: Nowell and Hills, as long as both edges slip in the sense of the shear). */
miniapp::ReferenceTable compare(const Design &design, const Setting &setting,
                                const Contact &closed_form, const SolvedContact &solved)
{
   const FatigueMaterial &m = setting.material;
   const double modulus = contact_modulus(m.young, m.poisson, setting.plane_stress);
   const double a = closed_form.half_width;
   const double limit = design.friction * design.normal, x = std::abs(design.shear) / limit;
   const double peak_pressure = 2 * design.normal / (pi * a);
   const double stick = a * std::sqrt(1 - x);
   const double shift = a * (bulk_of(design) - design.bulk_pad) * (design.shear < 0 ? -1 : 1) /
                        (4 * design.friction * peak_pressure);
   miniapp::ReferenceTable table;
   // Closed forms have no spread: what differs is the mesh's, edges by the error of their
   // read-out.
   table.add("half width a, mm", a, {0, solved.trailing.edge.position.error}, unset,
             solved.half_width);
   const auto error = [](const FittedIntensity &fitted)
   { return fitted.relative_error * std::abs(fitted.value); };
   for (const bool trailing : {true, false})
   {
      const SolvedEdge &edge = trailing ? solved.trailing : solved.leading;
      const std::string where = trailing ? ", trailing edge" : ", leading edge";
      table.add("K_N, MPa/sqrt(mm)" + where, closed_form.k_n, {0, error(edge.edge.k_n)}, unset,
                edge.edge.k_n.value);
      table.add("K_T, MPa sqrt(mm)" + where,
                trailing ? closed_form.k_t.trailing : closed_form.k_t.leading,
                {0, error(edge.edge.k_t)}, unset, edge.edge.k_t.value);
      if (!resolved(edge, solved)) { continue; }
      const double slip = a - stick + (trailing ? shift : -shift);
      if (a - stick >= std::abs(shift))
      {
         table.add("slip zone d, mm" + where, slip, {0, edge.edge.slip_zone_error}, unset,
                   edge.edge.slip_zone);
      }
      if (shift == 0 && x > 0)
      {
         // The sheet's limits: d is underestimated by this factor; the energy is exact Hertz.
         const double spread = edge.edge.slip_zone_error / edge.edge.slip_zone;
         const double factor = 0.5 * (1 + std::sqrt(1 - x));
         table.add("predicted / computed d" + where, factor, {0, factor * (0.02 + spread)},
                   unset, slip_zone(near_edge(edge.edge)) / edge.edge.slip_zone);
         const double y = 0.5 * (1 - design.load_ratio) * x;
         const double energy =
            0.5 * hertz_slip_energy(design.friction, design.normal, y, modulus);
         table.add("energy per cycle, N" + where, energy, {0, 0.02 * energy}, unset,
                   edge.energy->computed_total);
         const Edge exact{closed_form.k_n, closed_form.k_t.trailing, design.friction};
         const double ratio =
            slip_energy_total(exact, (1 - design.load_ratio) * std::abs(exact.k_t), modulus) /
            energy;
         table.add("predicted / computed energy" + where, ratio, {0, 0.05 * ratio}, unset,
                   edge.energy->predicted_total / edge.energy->computed_total);
      }
   }
   return table;
}

Contact calibrate(const Design &design, const Setting &setting)
{
   Contact contact;
   if (design.pad == "kn")
   {
      require(given(design.k_n) && given(design.k_t),
              "the pad 'kn' needs both --k-n and --k-t.");
      contact.half_width = given(design.half_width) ? design.half_width : 0;
      contact.k_n = design.k_n;
      contact.k_t = {design.k_t, unset};
      return contact;
   }
   require(design.pad == "hertz" || design.pad == "flat-rounded" || design.pad == "fe",
           "the pad is '", design.pad, "'; it must be hertz, flat-rounded, fe or kn.");
   require(
      !given(design.k_n) && !given(design.k_t) && !given(design.half_width),
      "--k-n, --k-t and --half-width are for the pad 'kn'; here they follow from the loads.");
   const FatigueMaterial &material = setting.material;
   const double modulus =
      contact_modulus(material.young, material.poisson, setting.plane_stress);
   if (design.pad != "flat-rounded")
   {
      require(!given(design.flat), "--flat is for the pad 'flat-rounded'.");
      const HertzContact hertz = hertz_contact(design.normal, design.radius, modulus);
      contact.half_width = contact.rounded_width = hertz.half_width;
      contact.k_n = hertz.k_n;
   }
   else
   {
      require(given(design.flat), "the pad 'flat-rounded' needs --flat.");
      const FlatRoundedContact pad =
         flat_rounded_contact(design.normal, design.radius, design.flat, modulus);
      contact.half_width = pad.half_width;
      contact.rounded_width = pad.half_width - pad.flat;
      contact.k_n = pad.k_n;
   }
   contact.stress_gradient = edge_gradient(design.radius, modulus);
   const double limit = design.friction * design.normal;
   require(std::abs(design.shear) < limit, "the shear force Q = ", design.shear,
           " N/mm reaches the friction limit fP = ", limit,
           " N/mm: the whole contact slides and there is no partial slip to assess.");
   contact.k_t =
      shear_intensities(contact.half_width, design.shear, bulk_of(design) - design.bulk_pad);
   return contact;
}

/// The intensities that the finite elements gave, in place of the closed forms.
Contact replace_intensities(Contact contact, const SolvedContact &solved)
{
   contact.half_width = contact.rounded_width = solved.half_width;
   contact.k_n = 0.5 * (solved.trailing.edge.k_n.value + solved.leading.edge.k_n.value);
   contact.k_t = {solved.trailing.edge.k_t.value, solved.leading.edge.k_t.value};
   return contact;
}

struct EdgeAssessment
{
   FrettingProblem problem;
   FrettingReport report;
   std::string edge;
   Contact contact;
};

/// The edge whose crack is driven harder.
EdgeAssessment assess_design(const Design &design, const Setting &setting,
                             const Contact &contact)
{
   EdgeAssessment worst;
   for (const bool trailing : {true, false})
   {
      const double k_t = trailing ? contact.k_t.trailing : contact.k_t.leading;
      if (!given(k_t)) { continue; }
      FrettingProblem problem;
      problem.crack.edge = {contact.k_n, k_t, design.friction};
      problem.crack.stress_ratio = design.load_ratio;
      problem.crack.stress_gradient = contact.stress_gradient;
      problem.bulk_known = given(design.bulk);
      if (problem.bulk_known)
      {
         problem.crack.bulk_stress = 0.5 * (design.bulk + design.bulk_pad);
      }
      problem.material = setting.material;
      problem.plane_stress = setting.plane_stress;
      problem.half_width = contact.half_width;
      problem.rounded_width = contact.rounded_width;
      const FrettingReport report = assess(problem, setting.criteria);
      if (trailing || report.threshold.drive > worst.report.threshold.drive)
      {
         worst = {problem, report, trailing ? "trailing" : "leading", contact};
      }
   }
   return worst;
}

// --- the page
// -----------------------------------------------------------------------------------

/// Padded to a width counted in characters, not in the bytes that printf counts.
std::string padded(const std::string &text, std::size_t width)
{
   std::size_t characters = 0;
   for (const char c : text) { characters += (c & 0xC0) != 0x80; }
   return text + std::string(width > characters ? width - characters : 0, ' ');
}

void print_line(const std::string &what, const std::string &value, const std::string &meaning)
{
   std::cout << "   " << padded(what, 23) << padded(value, 24) << meaning << "\n";
}

std::string number(double value, const char *unit = "")
{
   char text[64];
   std::snprintf(text, sizeof text, "%.4g%s%s", value, *unit ? " " : "", unit);
   return text;
}

/// Text broken into lines of a page, each with the same indentation.
std::string wrap(const std::string &text, int indent)
{
   std::istringstream words(text);
   std::string word, line, result;
   const std::string margin(indent, ' ');
   while (words >> word)
   {
      if (!line.empty() && indent + line.size() + word.size() > 96)
      {
         result += margin + line + "\n";
         line.clear();
      }
      line += (line.empty() ? "" : " ") + word;
   }
   return result + margin + line + "\n";
}

std::string verdict_text(const FrettingReport &report)
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
             number(depth, "µm") +
             ". Expect a crack; whether it is harmless needs the whole stress field.";
   case CrackVerdict::arrests:
      break;
   }
   if (depth == 0)
   {
      return "ARRESTS: no crack starts; the fatigue limit is not reached at the edge.";
   }
   return "ARRESTS: a crack may start but stops at about " + number(depth, "µm") +
          ", before the critical length. Safe by this criterion.";
}

const char *criterion_name(Criterion criterion)
{
   switch (criterion)
   {
   case Criterion::range:
      return "range";
   case Criterion::half_range:
      return "half-range";
   case Criterion::open:
      break;
   }
   return "open";
}

Criterion criterion_of(const std::string &name)
{
   for (const Criterion c : {Criterion::open, Criterion::range, Criterion::half_range})
   {
      if (name == criterion_name(c)) { return c; }
   }
   throw InputError("the criterion is '" + name + "'; it must be open, range or half-range.");
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
   return "part of the cycle in which the crack is open (A)";
}

void print_page(const Design &design, const Setting &setting, const EdgeAssessment &judged)
{
   const FrettingReport &r = judged.report;
   const FatigueMaterial &m = setting.material;
   const Contact &contact = judged.contact;
   const double a = contact.half_width;
   std::cout << "\nFRETTING ASSESSMENT: " << design.pad << " pad, " << m.name << ", "
             << (setting.plane_stress ? "plane stress" : "plane strain") << "\n";
   std::cout << wrap("E " + number(1e-3 * m.young, "GPa") + ", ν " + number(m.poisson) +
                        ", ΔK_th " + number(m.threshold / mpa_sqrt_m, "MPa√m") +
                        ", fatigue limit " + number(m.fatigue_limit.low, "MPa") +
                        ", shear yield " + number(m.shear_yield.low, "MPa") + ", friction " +
                        number(design.friction),
                     3)
             << "\n";
   std::cout << wrap(verdict_text(r), 3)
             << wrap("Trust in this result: " + to_string(r.trust) + " (see the last section).",
                     3);

   std::cout << "\n1. What the contact edge feels\n";
   if (a > 0) { print_line("half width a", number(a, "mm"), "of the contact"); }
   print_line("K_N", number(contact.k_n, "MPa/√mm"),
              "pressure at distance t from the edge: K_N √t");
   print_line("K_T trailing edge", number(contact.k_t.trailing, "MPa√mm"),
              "shear there if nothing slipped: K_T/√t");
   if (given(contact.k_t.leading))
   {
      print_line("K_T leading edge", number(contact.k_t.leading, "MPa√mm"),
                 contact.k_t.leading < 0 ? "negative: the shear force outweighs the bulk" : "");
   }
   print_line("ΔK_T", number(r.k_t_range, "MPa√mm"),
              "range over the cycle; judged below: the " + judged.edge + " edge");

   std::cout << "\n2. Slip and stress\n";
   print_line("slip zone d", number(r.slip_zone, "mm"),
              a > 0 ? number(100 * r.slip_zone / a, "% of a") : "");
   print_line("edge stress", number(r.edge_stress, "MPa"),
              "along the surface at the contact edge, at peak load");
   print_line("its range", number(r.edge_stress_range, "MPa"),
              "fatigue limit " + number(m.fatigue_limit.low, "MPa"));
   print_line("load / first yield", number(r.yield_ratio_first),
              "above 1: part of the slip zone yields");
   print_line("load / full yield", number(r.yield_ratio_full),
              "above 1: the whole slip zone yields");

   std::cout << "\n3. Crack normal to the surface at the edge\n";
   print_line("critical length a0", number(1e3 * r.critical_length, "µm"),
              "shorter cracks obey the fatigue limit, longer ones ΔK_th");
   print_line("K_I at a0", number(r.k_i_min) + " to " + number(r.k_i_max, "MPa√mm"),
              "over the cycle; negative: pressed shut");
   print_line("driving force / ΔK_th", number(r.threshold.drive / m.threshold),
              criterion_text(setting.criteria.criterion));
   print_line("ΔK_T / ΔK_th", number(r.ordinate),
              "threshold curve at X = " + number(r.abscissa) + ": " +
                 number(r.threshold_ordinate) + " (edge field alone)");
   print_line("ΔK_II / its threshold", number(r.mode_two_utilisation),
              "above 1 unsafe; for when the slip zone yields");

   std::cout << "\n4. Frictional energy per cycle\n";
   print_line("largest", number(r.energy_max, "N/mm"),
              "per area (= mJ/mm²), a quarter into the slip zone");
   print_line("total", number(r.energy_total, "N"), "per mm of edge (= mJ/mm)");

   std::cout << "\n5. How far to trust it\n";
   for (const Validity &item : r.validity)
   {
      const std::string head =
         "[" + to_string(item.trust) + "] " +
         (item.measure.empty() ? "" : item.measure + " = " + number(item.value) + ". ");
      std::cout << wrap(head + item.text, 3);
   }
   std::cout << std::flush;
}

// --- JSON
// ---------------------------------------------------------------------------------------

Json to_json(const Design &design, const Setting &setting, const EdgeAssessment &judged)
{
   const FrettingReport &r = judged.report;
   const Contact &contact = judged.contact;
   const double width = contact.rounded_width > 0 ? contact.rounded_width : contact.half_width;
   Json validity = Json::array();
   for (const Validity &item : r.validity)
   {
      validity.push_back(
         {{"measure", item.measure},
          {"value", item.measure.empty() ? Json(nullptr) : miniapp::json_number(item.value)},
          {"trust", to_string(item.trust)},
          {"text", item.text}});
   }
   return {
      {"units", "N, mm, MPa, forces per mm of thickness"},
      {"pad", design.pad},
      {"material", setting.material.name},
      {"friction", design.friction},
      {"load_ratio", design.load_ratio},
      {"half_width", miniapp::json_number(contact.half_width > 0 ? contact.half_width : unset)},
      {"edge_width", miniapp::json_number(width > 0 ? width : unset)},
      {"k_n", contact.k_n},
      {"k_t_trailing", contact.k_t.trailing},
      {"k_t_leading", miniapp::json_number(contact.k_t.leading)},
      {"judged_edge", judged.edge},
      {"k_t_range", r.k_t_range},
      {"slip_zone", r.slip_zone},
      {"edge_stress", r.edge_stress},
      {"edge_stress_range", r.edge_stress_range},
      {"yield_ratio_first", r.yield_ratio_first},
      {"yield_ratio_full", r.yield_ratio_full},
      {"critical_length", r.critical_length},
      {"k_i_max", r.k_i_max},
      {"k_i_min", r.k_i_min},
      {"k_threshold", setting.material.threshold},
      {"fatigue_limit", setting.material.fatigue_limit.low},
      {"mode_two_k_t",
       setting.criteria.mode_two_ratio * setting.material.threshold / mode_two_range(1)},
      {"criterion", criterion_name(setting.criteria.criterion)},
      {"drive", r.threshold.drive},
      {"threshold_x", r.abscissa},
      {"threshold_y", r.threshold_ordinate},
      {"design_y", r.ordinate},
      {"verdict", to_string(r.threshold.verdict)},
      {"arrest_depth", miniapp::json_number(r.threshold.arrest_depth)},
      {"mode_two_utilisation", r.mode_two_utilisation},
      {"energy_max", r.energy_max},
      {"energy_total", r.energy_total},
      {"trust", to_string(r.trust)},
      {"validity", validity}};
}

Json to_json(const SolvedEdge &solved, bool resolved)
{
   Json j = miniapp::to_json(solved);
   j["slip_zone_reversed"] = solved.reversed_slip_zone;
   j["resolved"] = resolved;
   return j;
}

Json to_json(const SolvedContact &solved)
{
   return {{"half_width", solved.half_width},
           {"trailing", to_json(solved.trailing, resolved(solved.trailing, solved))},
           {"leading", to_json(solved.leading, resolved(solved.leading, solved))},
           {"steady_cycle", solved.steady_cycle},
           {"dofs", solved.dofs},
           {"seconds", solved.seconds},
           {"counters", miniapp::to_json(solved.counters)}};
}

void print_solution(const SolvedContact &solved, const miniapp::ReferenceTable &table)
{
   std::cout << "\n6. The finite element contact (" << solved.dofs << " dofs, "
             << number(solved.seconds, "s") << ")\n";
   for (const bool trailing : {true, false})
   {
      const SolvedEdge &solution = trailing ? solved.trailing : solved.leading;
      const ContactEdge &edge = solution.edge;
      std::cout << (trailing ? "   trailing edge\n" : "   leading edge\n");
      const auto line = [](const char *what, const FittedIntensity &fitted, const char *unit)
      {
         print_line(what, number(fitted.value, unit),
                    "± " + number(100 * fitted.relative_error, "%") + ", fitted from " +
                       number(fitted.window.nearest) + " to " +
                       number(fitted.window.farthest, "mm") + " (" +
                       std::to_string(fitted.nodes) + " nodes)");
      };
      line("K_N", edge.k_n, "MPa/√mm");
      line("K_T", edge.k_t, "MPa√mm");
      print_line("slip zone d", number(edge.slip_zone, "mm"),
                 "± " + number(edge.slip_zone_error, "mm") + "; from K_N and K_T " +
                    number(slip_zone(near_edge(edge)), "mm") +
                    (edge.slides ? "; the whole contact slides" : ""));
      print_line("energy per cycle", number(solution.energy->computed_total, "N"),
                 "from K_N and K_T " + number(solution.energy->predicted_total, "N"));
      print_line("largest per area", number(solution.energy->computed_max, "N/mm"),
                 "from K_T " + number(solution.energy->predicted_max, "N/mm"));
      if (edge.k_t.value != 0 && !resolved(solution, solved))
      {
         std::cout << wrap("The slip zone is shorter than two spacings of the contact nodes (" +
                              number(solved.spacing, "mm") +
                              "): its computed length and energy are not resolved; K_N and K_T "
                              "are. More --nodes resolve it.",
                           6);
      }
   }
   std::cout << std::flush;
   table.print();
}

// --- figures
// ------------------------------------------------------------------------------------

/// Comma-separated table built up in memory.
class Table
{
public:
   explicit Table(const std::string &header)
   {
      text_.precision(10);
      text_ << header << "\n";
   }
   template <class... Values>
   void row(const Values &...values)
   {
      const char *comma = "";
      ((text_ << comma << values, comma = ","), ...);
      text_ << "\n";
   }
   std::string text() const { return text_.str(); }

private:
   std::ostringstream text_;
};

std::vector<double> with_design(std::vector<double> frictions, double design)
{
   if (std::find(frictions.begin(), frictions.end(), design) == frictions.end())
   {
      frictions.push_back(design);
   }
   return frictions;
}

/// Tables of the universal curves and of the design, by file name.
std::map<std::string, std::string> figure_tables(const Design &design, const Setting &setting,
                                                 const EdgeAssessment &judged)
{
   const double f = design.friction;
   const double constraint =
      out_of_plane_constraint(setting.material.poisson, setting.plane_stress);
   std::map<std::string, std::string> tables;

   Table field("friction,t_over_d,y_over_d,von_mises");
   for (const double friction : with_design({0.8, 0.6}, f))
   {
      const Edge unit{1, 0.5 * friction, friction};
      for (int j = 0; j <= 60; j++)
      {
         for (int i = 0; i <= 120; i++)
         {
            const double t = -1 + 0.025 * i, y = 0.025 * j;
            field.row(friction, t, y, von_mises(stress(unit, t, y), constraint));
         }
      }
   }
   tables["field.csv"] = field.text();

   Table surface("friction,t_over_d,von_mises");
   for (const double friction : with_design({0.2, 0.4, 0.6, 0.8, 1.0}, f))
   {
      for (int i = 0; i <= 300; i++)
      {
         const double t = -1 + 0.01 * i;
         surface.row(friction, t, surface_von_mises(friction, constraint, t));
      }
   }
   tables["surface.csv"] = surface.text();

   Table yield("friction,first,full");
   for (int i = 0; i <= 90; i++)
   {
      const double friction = 0.1 + 0.01 * i;
      yield.row(friction, first_yield_load(friction, constraint), full_yield_load(friction));
   }
   tables["yield.csv"] = yield.text();

   Table trajectory("friction,c_over_d,k_i");
   for (const double friction : with_design({0.3, 0.5, 0.8}, f))
   {
      const Edge unit{1, 0.5 * friction, friction};
      for (int i = 0; i <= 200; i++)
      {
         const double c = 0.005 * i;
         trajectory.row(friction, c, crack_intensity(unit, c) / std::sqrt(unit.k_t));
      }
   }
   tables["trajectory.csv"] = trajectory.text();

   Table threshold("friction,x,y");
   for (const double friction : with_design({0.3, 0.5, 0.8}, f))
   {
      const double last = std::max(1.0, 1.5 * judged.report.abscissa);
      for (int i = 1; i <= 100; i++)
      {
         const double x = last * std::pow(0.01 * i, 2);
         threshold.row(
            friction, x,
            threshold_ordinate(setting.criteria.criterion, friction, x, design.load_ratio));
      }
   }
   tables["threshold.csv"] = threshold.text();

   Table diagram("c_over_a0,drive,drive_edge_alone");
   CrackedEdge alone = judged.problem.crack;
   alone.bulk_stress = alone.stress_gradient = 0;
   for (int i = 0; i <= 120; i++)
   {
      const double c = 0.01 * std::pow(10, i / 40.0), depth = c * judged.report.critical_length;
      const auto drive = [&](const CrackedEdge &crack)
      {
         return crack_cycle(crack, depth).drive(setting.criteria.criterion) /
                setting.material.threshold;
      };
      diagram.row(c, drive(judged.problem.crack), drive(alone));
   }
   tables["diagram.csv"] = diagram.text();
   return tables;
}

std::vector<std::string> split(const std::string &line)
{
   std::vector<std::string> cells;
   std::istringstream stream(line);
   for (std::string cell; std::getline(stream, cell, ',');)
   {
      const auto first = cell.find_first_not_of(" \t\r"), last = cell.find_last_not_of(" \t\r");
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
   }
   return cells;
}

/** Measures of the tests in a file: a header line, then one test a line, '#' for comments.
   Columns cycles (required), and series, runout (0 or 1), P, Q, bulk, bulk_pad, load_ratio,
   radius, flat, friction; where a column is missing, the command line's value holds. */
std::string correlate(const std::string &file, const Design &common, const Setting &setting)
{
   std::ifstream stream(file);
   require(stream.good(), "cannot read the test records ", file, ".");
   Table table("series,cycles,runout,friction,edge_stress_range,threshold_x,design_y,k_t_range,"
               "energy_max,energy_total,trust");
   std::vector<std::string> columns;
   int number = 0, tests = 0;
   for (std::string line; std::getline(stream, line);)
   {
      number++;
      if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') { continue; }
      const std::vector<std::string> cells = split(line);
      if (columns.empty())
      {
         columns = cells;
         continue;
      }
      const std::string where = file + ", line " + std::to_string(number);
      require(cells.size() == columns.size(), where, ": there are ", cells.size(),
              " values for ", columns.size(), " columns.");
      Design design = common;
      std::string series = "tests";
      double cycles = unset, runout = 0;
      const std::map<std::string, double *> targets{{"cycles", &cycles},
                                                    {"runout", &runout},
                                                    {"P", &design.normal},
                                                    {"Q", &design.shear},
                                                    {"bulk", &design.bulk},
                                                    {"bulk_pad", &design.bulk_pad},
                                                    {"load_ratio", &design.load_ratio},
                                                    {"radius", &design.radius},
                                                    {"flat", &design.flat},
                                                    {"friction", &design.friction}};
      for (std::size_t i = 0; i < cells.size(); i++)
      {
         if (columns[i] == "series")
         {
            series = cells[i];
            continue;
         }
         const auto target = targets.find(columns[i]);
         require(target != targets.end(), where, ": there is no column '", columns[i], "'.");
         char *end = nullptr;
         *target->second = std::strtod(cells[i].c_str(), &end);
         require(!cells[i].empty() && *end == '\0' && std::isfinite(*target->second), where,
                 ": '", cells[i], "' in column ", columns[i], " is not a number.");
      }
      require(cycles > 0, where, ": the number of cycles must be given and positive.");
      require(runout == 0 || runout == 1, where, ": runout is ", runout,
              "; it must be 0 or 1.");
      try
      {
         Contact contact = calibrate(design, setting);
         if (design.pad == "fe")
         {
            contact = replace_intensities(contact, solve_contact(design, setting, contact));
         }
         const FrettingReport report = assess_design(design, setting, contact).report;
         table.row(series, cycles, runout, design.friction, report.edge_stress_range,
                   report.abscissa, report.ordinate, report.k_t_range, report.energy_max,
                   report.energy_total, to_string(report.trust));
      }
      catch (const InputError &error)
      {
         throw InputError(where + ": " + error.what());
      }
      tests++;
   }
   require(tests > 0, "there are no tests in ", file, ".");
   return table.text();
}

// --- options
// ------------------------------------------------------------------------------------

void replace(double from, double scale, double &to)
{
   if (given(from)) { to = from * scale; }
}

int program(int argc, char *argv[])
{
   Design design;
   Setting setting;
   std::string material = "Al", criterion = "open";
   std::string material_file =
      std::string(CATTANEO_SOURCE_DIR) + "/miniapps/data/materials.json";
   std::string json, plot, records;
   double young = unset, poisson = unset, threshold = unset, limit = unset, yield = unset;

   miniapp::Options options(argc, argv);
   options.AddOption(&design.pad, "-p", "--pad",
                     "hertz (cylinder on flat), fe (the same by finite elements), "
                     "flat-rounded, or kn (K_N and K_T given).");
   options.AddOption(&design.radius, "-r", "--radius",
                     "Radius of the pad or of its edges, mm.");
   options.AddOption(&design.flat, "-b", "--flat",
                     "Half width of the flat, mm (flat-rounded).");
   options.AddOption(&design.normal, "-P", "--normal-load",
                     "Normal force, N/mm, constant (not for kn).");
   options.AddOption(&design.shear, "-Q", "--shear-load",
                     "Shear force on the specimen at peak load, N/mm (not for kn).");
   options.AddOption(
      &design.bulk, "-bs", "--bulk",
      "Bulk stress in the specimen at peak load, MPa (default: none, and said so).");
   options.AddOption(&design.bulk_pad, "-bp", "--bulk-pad",
                     "Bulk stress in the pad at peak load, MPa.");
   options.AddOption(&design.load_ratio, "-lr", "--load-ratio",
                     "R, least over peak value of shear and bulk, -1 <= R < 1.");
   options.AddOption(&design.friction, "-f", "--friction",
                     "Friction coefficient (default: middle of the material's interval).");
   options.AddOption(&design.k_n, "-kn", "--k-n", "K_N in MPa/sqrt(mm) (pad kn).");
   options.AddOption(&design.k_t, "-kt", "--k-t", "K_T at peak load in MPa sqrt(mm) (pad kn).");
   options.AddOption(&design.half_width, "-a", "--half-width",
                     "Half width of the contact, mm (pad kn, for the validity only).");
   options.AddOption(&design.nodes, "-nodes", "--nodes", "Contact nodes (pad fe).");
   options.AddOption(&design.order, "-order", "--order", "Order of the elements (pad fe).");
   options.AddOption(&material, "-m", "--material", "Name of a material record.");
   options.add(miniapp::Options::Names::input, &material_file, "-mf", "--material-file",
               "File of material records, JSON.");
   options.AddOption(&young, "-E", "--young", "Young's modulus, GPa (default: the record's).");
   options.AddOption(&poisson, "-nu", "--poisson", "Poisson's ratio (default: the record's).");
   options.AddOption(&threshold, "-kth", "--threshold",
                     "Threshold dK_th, MPa sqrt(m), range or amplitude as the fatigue limit.");
   options.AddOption(&limit, "-sfl", "--fatigue-limit", "Plain fatigue limit, MPa.");
   options.AddOption(&yield, "-k", "--shear-yield", "Yield stress in pure shear, MPa.");
   options.AddOption(&setting.plane_stress, "-ps", "--plane-stress", "-no-ps", "--plane-strain",
                     "Plane stress or plane strain.");
   options.AddOption(&criterion, "-c", "--criterion",
                     "What drives the crack: open (part of the cycle), range, or half-range.");
   options.add(miniapp::Options::Names::output, &json, "-j", "--json",
               "Write the assessment to this JSON file.");
   options.add(miniapp::Options::Names::folder, &plot, "-plot", "--plot",
               "Write tables and figures to this directory.");
   options.add(miniapp::Options::Names::input, &records, "-rec", "--records",
               "CSV of tests (P, Q, bulk, ..., cycles, runout) to correlate; needs --plot.");
   options.parse();

   require(!given(young) || (young > 0 && young < 2000), "option --young is ", young,
           ", must be positive and below 2000 (GPa, not MPa)");
   require(!given(threshold) || threshold > 0, "option --threshold is ", threshold,
           ", must be positive (MPa sqrt(m))");
   setting.criteria.criterion = criterion_of(criterion);
   FatigueMaterial &m = setting.material;
   m = find_material(read_materials(material_file), material);
   replace(young, 1e3, m.young);
   replace(poisson, 1, m.poisson);
   replace(threshold, mpa_sqrt_m, m.threshold);
   if (given(limit)) { m.fatigue_limit = {limit, limit}; }
   if (given(yield)) { m.shear_yield = {yield, yield}; }
   m.validate();
   if (!given(design.friction))
   {
      require(m.friction.high > 0, "the material ", m.name,
              " has no friction coefficient; give one with --friction.");
      design.friction = m.friction.middle();
   }
   require(
      design.friction > 0, "the friction coefficient is ", design.friction,
      "; it must be positive: without friction nothing sticks and there is no partial slip.");
   require(records.empty() || !plot.empty(), "--records needs --plot for its figures.");

   const bool solve = design.pad == "fe";

   Contact contact = calibrate(design, setting);
   SolvedContact solved;
   miniapp::ReferenceTable table;
   if (solve)
   {
      solved = solve_contact(design, setting, contact);
      table = compare(design, setting, contact, solved);
      contact = replace_intensities(contact, solved);
   }
   const EdgeAssessment judged = assess_design(design, setting, contact);
   Json document = to_json(design, setting, judged);
   if (solve)
   {
      document["fe"] = to_json(solved);
      document["references"] = table.json();
   }
   std::map<std::string, std::string> files;
   if (!plot.empty())
   {
      files = figure_tables(design, setting, judged);
      files["assessment.json"] = document.dump(3) + "\n";
      if (!records.empty()) { files["records.csv"] = correlate(records, design, setting); }
   }
   miniapp::write_json(document, json);
   if (!plot.empty() && miniapp::writes())
   {
      std::error_code error;
      std::filesystem::create_directories(plot, error);
      // The tests of an earlier run would belong to another design.
      std::filesystem::remove(plot + "/records.csv", error);
      for (const auto &[name, text] : files) { write_whole(plot + "/" + name, text); }
   }
   print_page(design, setting, judged);
   if (solve) { print_solution(solved, table); }
   if (!plot.empty())
   {
      require(miniapp::run_plot_script("fretting.py", {plot}), "the data are in ", plot,
              ", but the figures could not be drawn; this needs python3 with matplotlib.");
   }
   return 0;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run([&] { return program(argc, argv); });
}
