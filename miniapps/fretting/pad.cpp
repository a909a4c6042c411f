#include "fretting/pad.hpp"

#include "common/contact_grid.hpp"
#include "common/hertz_scene.hpp"
#include "common/run.hpp"

#include <algorithm>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using fretting::Edge; // not the edge of a zone

double Pad::modulus() const
{
   return contact_modulus(material.young, material.poisson, plane_stress);
}

double Pad::half_width_under(double load) const
{
   return std::isnan(flat) ? hertz_contact(load, radius, modulus()).half_width
                           : flat_rounded_contact(load, radius, flat, modulus()).half_width;
}

PadContact calibrate(const Pad &pad)
{
   const auto given = [](double value) { return !std::isnan(value); };
   PadContact contact;
   if (pad.kind == "kn")
   {
      require(given(pad.k_n) && given(pad.k_t), "the pad 'kn' needs both --k-n and --k-t.");
      contact.half_width = given(pad.half_width) ? pad.half_width : 0;
      contact.k_n = pad.k_n;
      contact.k_t = {pad.k_t, none};
      return contact;
   }
   require(
      !given(pad.k_n) && !given(pad.k_t) && !given(pad.half_width),
      "--k-n, --k-t and --half-width are for the pad 'kn'; here they follow from the loads.");
   require(pad.kind != "hertz" || !given(pad.flat),
           "--flat is for the pads 'flat-rounded' and 'fe'.");
   require(pad.kind != "flat-rounded" || given(pad.flat),
           "the pad 'flat-rounded' needs --flat.");
   if (!given(pad.flat))
   {
      const HertzContact hertz = hertz_contact(pad.normal, pad.radius, pad.modulus());
      contact.half_width = contact.rounded_width = hertz.half_width;
      contact.k_n = hertz.k_n;
   }
   else
   {
      const FlatRoundedContact flat =
         flat_rounded_contact(pad.normal, pad.radius, pad.flat, pad.modulus());
      contact.half_width = flat.half_width;
      contact.rounded_width = flat.half_width - flat.flat;
      contact.k_n = flat.k_n;
   }
   contact.stress_gradient = edge_gradient(pad.radius, pad.modulus());
   const double limit = pad.friction * pad.normal;
   if (std::abs(pad.shear) >= limit)
   {
      throw PadSlides(told("the shear force Q = ", pad.shear,
                           " N/mm reaches the friction limit fP = ", limit,
                           " N/mm: the whole contact slides and there is no partial slip to "
                           "assess."));
   }
   contact.k_t =
      shear_intensities(contact.half_width, pad.shear, pad.bulk_or_none() - pad.bulk_pad);
   return contact;
}

namespace
{

/** Lines of a grid for a contact with a flat: half of @a elements, of one size, on each rounded
    part of width w and as far into the flat, and a little beyond. Elements between these parts
    are added, and grow toward the middle. */
std::vector<double> flat_grid(double flat, double half_width, int elements, double growth)
{
   const double w = half_width - flat, inner = std::max(flat - w, 0.0), outer = flat + 1.67 * w;
   const int zone = std::max(elements / 2, 1);
   const double step = (outer - inner) / zone;
   std::vector<double> half{0.0};
   if (inner > 0)
   {
      half = graded(inner, 0, step, growth);
      std::reverse(half.begin(), half.end());
   }
   for (int k = 1; k <= zone; ++k) { half.push_back(inner + (outer - inner) * k / zone); }
   std::vector<double> grid;
   for (std::size_t k = half.size() - 1; k > 0; --k) { grid.push_back(-half[k]); }
   grid.insert(grid.end(), half.begin(), half.end());
   return grid;
}

} // namespace

SolvedPad solve(Study &study, const Pad &pad, const PadContact &closed_form, bool saves)
{
   const double flat = std::isnan(pad.flat) ? 0 : pad.flat;
   const Stopwatch watch;
   Counters before = study.counters;
   HalfPlanes options;
   options.order = pad.order;
   options.nodes = pad.nodes;
   options.half_width = closed_form.half_width;
   options.material = {pad.material.young, pad.material.poisson,
                       pad.plane_stress ? PlaneState::stress : PlaneState::strain};
   options.load = pad.normal;
   options.bulk = pad.bulk_or_none() != 0;
   options.bulk_pad = pad.bulk_pad != 0;
   options.validate();
   const int elements = (pad.nodes - 1) / pad.order;
   options.grid =
      flat > 0 ? flat_grid(flat, options.half_width, elements, element_growth(0, pad.order))
               : graded_to_ends(options.span * options.half_width, elements, 1);
   Scene scene = make_scene(options);
   study.counters += scene.reduction.counters;
   ReducedProblem &problem = scene.problem();
   set_friction(problem, pad.friction);
   problem.gap =
      (problem.position.col(0).array().abs() - flat).max(0).square() / (2 * pad.radius);

   for (LoadPattern &pattern : problem.patterns)
   {
      if (pattern.name == "P") { pattern.size = {"force", pad.normal, {0, -1}, "the pad"}; }
      else if (pattern.name == "Q") { pattern.size = {"force", pad.normal, {1, 0}, "the pad"}; }
      else { pattern.size = {"stress", 1, {0, 0}, ""}; }
   }
   study.units = {"mm", "N", true};

   /// The normal load, and a share of the peak of what varies.
   const auto loads = [&](double share)
   {
      NamedLoads at = {{"P", 1}, {"Q", share * (pad.shear / pad.normal)}};
      if (options.bulk) { at["bulk"] = share * pad.bulk_or_none(); }
      if (options.bulk_pad) { at["bulk pad"] = share * pad.bulk_pad; }
      return at;
   };
   Run run(study, problem);
   run.leaves = false;
   const auto check = [](const MarchReport &report)
   {
      require(report.status == FrictionStatus::converged,
              "the finite element contact ends in '", name(report.status),
              "' before the peak load: ", report.message);
   };
   check(run.to(loads(0)));
   const ContactState pressed = run.state;
   check(run.to(loads(1)));
   const ContactState peak = run.state;
   check(run.cycle({loads(pad.load_ratio)}, 4));

   const std::vector<ContactEdge> edges = contact_edges(problem, pressed, peak);
   const std::vector<ContactEdge> reversed = contact_edges(problem, pressed, run.state);
   require(edges.size() == 2 && reversed.size() == 2, "the finite element contact has ",
           edges.size(), " edges instead of 2: refine it with --nodes.");
   SolvedPad solved;
   solved.dofs = scene.dofs;
   solved.steady_cycle = run.report.steady_cycle;
   if (solved.steady_cycle == 0)
   {
      warn("the cycle of the finite element pad is not steady after four cycles: energies and "
           "stresses are those of the fourth");
   }
   solved.half_width = edges[0].half_width;
   solved.spacing = smallest_step(options.grid) / pad.order;
   for (const std::size_t e : {0, 1})
   {
      // Shear on the specimen points into the contact at its left edge if Q > 0.
      PadEdge &edge = e == 0 ? solved.trailing : solved.leading;
      edge.edge = edges[e];
      edge.reversed_slip_zone = reversed[e].slip_zone;
      edge.k_t_range = (1 - pad.load_ratio) * std::abs(edges[e].k_t.value);
      edge.energy = compare_energy(problem, edges[e], run.report.cycles.back(), edge.k_t_range,
                                   pad.modulus());
      edge.resolved =
         std::min(slip_zone(near_edge(edges[e])), edges[e].slip_zone) >= 2 * solved.spacing;
   }
   solved.positions = problem.position.col(0);
   if (saves) { study.save(problem); }
   // Once through the steady cycle, in eighths of its ranges.
   for (int k = 1; k <= 16; ++k)
   {
      const double share = std::abs(1 - k / 8.0);
      check(run.to(loads(pad.load_ratio + share * (1 - pad.load_ratio))));
      solved.cycle.push_back(
         {-run.state.q, run.state.p, options.bulk ? run.load("bulk") : 0.0});
   }
   solved.pressure = tractions(problem, run.state.p); // at the peak again
   solved.shear = -tractions(problem, run.state.q);
   solved.seconds = watch.seconds();
   solved.counters = study.counters;
   solved.counters -= before;
   return solved;
}

SolvedPad::Stress SolvedPad::edge_stress(bool trailing) const
{
   const double side = trailing ? -1 : 1, least = 0.25 * spacing;
   const auto with_every = [&](Eigen::Index step)
   {
      // Shear over the root of the distance t from the edge, piecewise linear, constant up to
      // its first node: its integral over t is known.
      std::vector<double> t{0}, g{0};
      for (Eigen::Index i = 0; i < positions.size(); i += step)
      {
         const Eigen::Index node = trailing ? i : positions.size() - 1 - i;
         const double away = half_width - side * positions[node];
         if (pressure[node] <= 0 || away < least) { continue; }
         t.push_back(away);
         g.push_back(shear[node] / std::sqrt(away));
      }
      if (g.size() > 1) { g[0] = g[1]; }
      double sum = 0;
      for (std::size_t i = 1; i < t.size(); ++i)
      {
         const double slope = (g[i] - g[i - 1]) / (t[i] - t[i - 1]),
                      constant = g[i] - slope * t[i];
         sum += 2 * constant * (std::sqrt(t[i]) - std::sqrt(t[i - 1])) +
                2.0 / 3 * slope * (std::pow(t[i], 1.5) - std::pow(t[i - 1], 1.5));
      }
      return cycle.back().bulk - side * 2 / M_PI * sum;
   };
   const double value = with_every(1);
   return {value, std::abs(value - with_every(2))};
}

PadContact SolvedPad::in_place_of(PadContact contact) const
{
   contact.rounded_width += half_width - contact.half_width;
   contact.half_width = half_width;
   contact.k_n = 0.5 * (trailing.edge.k_n.value + leading.edge.k_n.value);
   contact.k_t = {trailing.edge.k_t.value, leading.edge.k_t.value};
   return contact;
}

void compare(Study &study, const Pad &pad, const PadContact &closed_form,
             const SolvedPad &solved)
{
   const double a = closed_form.half_width, modulus = pad.modulus();
   const double limit = pad.friction * pad.normal, x = std::abs(pad.shear) / limit;
   // The stick zone is as wide as the contact under the load P - Q/f alone would be.
   const double stick = x == 0 ? a : pad.half_width_under(pad.normal * (1 - x));
   const double bulk = pad.bulk_or_none() - pad.bulk_pad;
   const bool hertz = std::isnan(pad.flat);
   const double shift = a * bulk * (pad.shear < 0 ? -1 : 1) * M_PI * a /
                        (8 * pad.friction * pad.normal); // of a Hertz contact
   // Closed forms have no spread. Differences come from the mesh; those of edges are the error
   // of their positions.
   study.compare("half width a, mm", a, {0, solved.trailing.edge.position.error},
                 solved.half_width);
   const auto error = [](const FittedIntensity &fitted)
   { return fitted.relative_error * std::abs(fitted.value); };
   for (const bool trailing : {true, false})
   {
      const PadEdge &solution = trailing ? solved.trailing : solved.leading;
      const ContactEdge &edge = solution.edge;
      const std::string where = trailing ? ", trailing edge" : ", leading edge";
      study.compare("K_N, MPa/sqrt(mm)" + where, closed_form.k_n, {0, error(edge.k_n)},
                    edge.k_n.value);
      study.compare("K_T, MPa sqrt(mm)" + where,
                    trailing ? closed_form.k_t.trailing : closed_form.k_t.leading,
                    {0, error(edge.k_t)}, edge.k_t.value);
      if (!solution.resolved) { continue; }
      if ((hertz || bulk == 0) && a - stick >= std::abs(shift))
      {
         study.compare("slip zone d, mm" + where, a - stick + (trailing ? shift : -shift),
                       {0, edge.slip_zone_error}, edge.slip_zone);
      }
      if (shift != 0 || x == 0) { continue; }
      // The near edge misses d by this factor; under a Hertz contact the energy is known too.
      const Edge exact{closed_form.k_n, closed_form.k_t.trailing, pad.friction};
      const double spread = edge.slip_zone_error / edge.slip_zone;
      const double factor = slip_zone(exact) / (a - stick);
      study.compare("predicted / computed d" + where, factor, {0, factor * (0.02 + spread)},
                    slip_zone(near_edge(edge)) / edge.slip_zone);
      if (!hertz) { continue; }
      const double energy = 0.5 * hertz_slip_energy(pad.friction, pad.normal,
                                                    0.5 * (1 - pad.load_ratio) * x, modulus);
      study.compare("energy per cycle, N" + where, energy, {0, 0.02 * energy},
                    solution.energy->computed_total);
      const double ratio =
         slip_energy_total(exact, (1 - pad.load_ratio) * std::abs(exact.k_t), modulus) / energy;
      study.compare("predicted / computed energy" + where, ratio, {0, 0.05 * ratio},
                    solution.energy->predicted_total / solution.energy->computed_total);
   }
}

JudgedEdge judge(const Pad &pad, const PadContact &contact, const FrettingSettings &criteria)
{
   // Two equal edges differ by the error of their positions. The trailing one then represents
   // both, as it does if closed forms make them equal.
   constexpr double alike = 1e-6;
   JudgedEdge worst;
   for (const bool trailing : {true, false})
   {
      const double k_t = trailing ? contact.k_t.trailing : contact.k_t.leading;
      if (std::isnan(k_t)) { continue; }
      FrettingProblem problem;
      problem.crack.edge = {contact.k_n, k_t, pad.friction};
      problem.crack.stress_ratio = pad.load_ratio;
      problem.crack.stress_gradient = contact.stress_gradient;
      problem.bulk_known = !std::isnan(pad.bulk);
      if (problem.bulk_known) { problem.crack.bulk_stress = 0.5 * (pad.bulk + pad.bulk_pad); }
      problem.material = pad.material;
      problem.plane_stress = pad.plane_stress;
      problem.half_width = contact.half_width;
      problem.rounded_width = contact.rounded_width;
      const FrettingReport report = assess(problem, criteria);
      if (trailing || report.threshold.drive > (1 + alike) * worst.report.threshold.drive)
      {
         worst = {problem, report, trailing ? "trailing" : "leading"};
      }
   }
   return worst;
}

} // namespace miniapp
