#include "fretting/fretting_figures.hpp"

#include "fretting/critical_planes.hpp"
#include "fretting/hertz_surface.hpp"

#include <algorithm>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using fretting::Edge; // not the edge of a zone

namespace
{

const char *const x_of_threshold = "X = ΔK_th K_N/(π σ_fl²)", *const y_of_threshold =
                                                                 "Y = ΔK_T/ΔK_th";

std::vector<double> with_design(std::vector<double> frictions, double design)
{
   if (std::find(frictions.begin(), frictions.end(), design) == frictions.end())
   {
      frictions.push_back(design);
   }
   return frictions;
}

using Curve = std::function<std::pair<double, double>(double friction, int i)>;

/// A curve for each friction coefficient, points 0 … n; the curve of the design has this name.
Panel &add_curves(Panel &panel, const std::vector<double> &frictions, double design, int n,
                  const Curve &at)
{
   for (const double f : with_design(frictions, design))
   {
      std::vector<double> x, y;
      for (int i = 0; i <= n; i++)
      {
         const auto [xi, yi] = at(f, i);
         x.push_back(xi);
         y.push_back(yi);
      }
      panel.add(exact_text("f = ", f) + (f == design ? " (design)" : ""), x, y);
   }
   return panel;
}

void mark(Panel &panel, const std::string &name, double x, double y)
{
   panel.point(name, x, y, "star");
}

} // namespace

bool has_closed_tractions(const Pad &pad)
{
   return pad.kind == "hertz" && HertzSurface(pad).valid();
}

void draw_tractions(Study &study, const Pad &pad, const SolvedPad *solved)
{
   const HertzSurface at(pad);
   if (!solved && !has_closed_tractions(pad)) { return; }
   const double a = solved ? solved->half_width : at.half_width;
   Panel &panel =
      study.lines("tractions", "On the specimen at peak load", "x [mm]", "p, q, σ_xx [MPa]");
   const std::function<double(double)> stress =
      solved ? surface_stress(pad, *solved) : [&](double x) { return at.stress(x); };
   std::vector<double> x, p, q, along;
   constexpr int half = 500;
   for (int i = -half; i <= half; i++)
   {
      x.push_back(2 * a * i / half);
      p.push_back(at.pressure(x.back()));
      q.push_back(at.shear(x.back()));
      along.push_back(stress(x.back()));
   }
   if (solved)
   {
      panel.add("pressure p", solved->positions, solved->pressure);
      panel.add("shear q", solved->positions, solved->shear);
   }
   else
   {
      panel.add("pressure p", x, p);
      panel.add("shear q", x, q);
   }
   panel.add("stress σ_xx", x, along);
   const auto slip = [&](double from, double to)
   {
      if (to > from) { panel.say("shade", text("%.9g,%.9g,slip", from, to)); }
   };
   slip(-a, solved ? -a + solved->trailing.edge.slip_zone : at.shift - at.stick);
   slip(solved ? a - solved->leading.edge.slip_zone : at.shift + at.stick, a);
}

namespace
{

/// Pressure of a flat pad with round edges, and what its edge makes of it (thesis appendix A).
void draw_profile(Study &study, const Pad &pad)
{
   const FlatRoundedContact contact =
      flat_rounded_contact(pad.normal, pad.radius, pad.flat, pad.modulus());
   const double a = contact.half_width;
   const RoundedEdge edge =
      rounded_edge(pad.normal / (M_PI * std::sqrt(2 * pad.flat)), pad.radius, pad.modulus());
   Panel &panel = study.lines("profile", "Pressure of the pad", "x/a", "p, MPa");
   std::vector<double> x, whole, alone, root;
   for (int i = 1; i <= 400; i++)
   {
      const double t = a * std::pow(0.0025 * i, 2);
      x.push_back(t / a - 1);
      whole.push_back(contact.pressure(t - a));
      alone.push_back(edge.pressure(t));
      root.push_back(contact.k_n * std::sqrt(t));
   }
   panel.add("pad", x, whole);
   panel.add("edge of a semi-infinite flat (A.1)", x, alone);
   panel.add("K_N √t", x, root);
   panel.limit("y", 0, 1.2 * contact.pressure(pad.flat));
   study.value("rounded_edge_k_n", edge.k_n);
}

} // namespace

void draw_design(Study &study, const Pad &pad, const JudgedEdge &judged,
                 const FrettingSettings &criteria)
{
   const double f = pad.friction;
   const double constraint = out_of_plane_constraint(pad.material.poisson, pad.plane_stress);
   const FrettingReport &r = judged.report;

   Panel &field = study.panel(Panel::Kind::field, "field", "von Mises stress σ_vM/(K_N √d)",
                              "t/d", "depth y/d");
   std::vector<double> frictions_of_field = with_design({0.6, 0.8}, f);
   std::sort(frictions_of_field.begin(), frictions_of_field.end());
   for (const double friction : frictions_of_field)
   {
      const Edge unit{1, 0.5 * friction, friction};
      for (int j = 0; j <= 60; j++)
      {
         for (int i = 0; i <= 120; i++)
         {
            const double t = -1 + 0.025 * i, y = 0.025 * j;
            field.add(exact_text("f = ", friction) + (friction == f ? " (design)" : ""), t, y,
                      von_mises(stress(unit, t, y), constraint));
         }
      }
   }
   Panel &surface = study.lines("surface", "Stress along the surface", "t/d", "σ_vM/(K_N √d)");
   surface.say("shade", "0,1,slip zone");
   surface.limit("y", 0, none);
   add_curves(surface, {0.2, 0.4, 0.6, 0.8, 1.0}, f, 300,
              [&](double friction, int i)
              {
                 const double t = -1 + 0.01 * i;
                 return std::pair{t, surface_von_mises(friction, constraint, t)};
              });
   Panel &yield = study.lines("yield", "Yield of the slip zone (below both: elastic)",
                              "friction coefficient f", "load K_N √d/k");
   std::vector<double> frictions, first, full;
   for (int i = 0; i <= 90; i++)
   {
      frictions.push_back(0.1 + 0.01 * i);
      first.push_back(first_yield_load(frictions.back(), constraint));
      full.push_back(full_yield_load(frictions.back()));
   }
   yield.add("elastic limit", frictions, first);
   yield.add("whole slip zone yields", frictions, full);
   yield.limit("y", 0, 6);
   if (r.yield_ratio_full > 0) { mark(yield, "design", f, r.yield_ratio_full / f); }
   add_curves(study.lines("trajectory", "Stress intensity of a crack", "crack depth c/d",
                          "K_I,max/√(K_N K_T d)"),
              {0.3, 0.5, 0.8}, f, 200,
              [](double friction, int i)
              {
                 const Edge unit{1, 0.5 * friction, friction};
                 const double c = 0.005 * i;
                 return std::pair{c, crack_intensity(unit, c) / std::sqrt(unit.k_t)};
              });
   // K_N is constant. With R only that end of the cycle changes at which the crack is pressed
   // shut.
   Panel &ratios = study.lines("trajectory_ratios", exact_text("Open part of ΔK_I, f = ", f),
                               "crack depth c/d", "ΔK_I/√(K_N K_T d)");
   std::vector<double> depth;
   std::vector<std::pair<std::string, std::vector<double>>> curves; // equal ones are one curve
   for (const double R : {-1.0, -0.5, 0.0, 0.3, 0.6})
   {
      CrackedEdge crack;
      crack.edge = {1, 0.5 * f, f};
      crack.stress_ratio = R;
      depth.clear();
      std::vector<double> open;
      for (int i = 1; i <= 200; i++)
      {
         depth.push_back(0.005 * i);
         open.push_back(crack_cycle(crack, depth.back()).drive(Criterion::open) /
                        std::sqrt(crack.edge.k_t));
      }
      if (!curves.empty() && curves.back().second == open)
      {
         curves.back().first += exact_text(", ", R);
      }
      else { curves.emplace_back(exact_text("R = ", R), open); }
   }
   for (const auto &[name, open] : curves) { ratios.add(name, depth, open); }
   if (!pad.plane_stress)
   {
      ResultTable &transition =
         study.table("transition", {{"sliding"}, {"friction"}}); // not printed
      transition.draw("Above this friction the surface is severest (Hertz)", "sliding", "Q/fP",
                      {{"friction", "f"}}, "friction coefficient f");
      for (int i = 4; i <= 20; i++)
      {
         study.row(transition, {0.05 * i, hertz_transition_friction(constraint, 0.05 * i)});
      }
   }
   if (pad.kind == "flat-rounded") { draw_profile(study, pad); }
   Panel &threshold = study.lines("threshold", "Threshold, edge field alone (above: grows)",
                                  x_of_threshold, y_of_threshold);
   const double last = std::max(1.0, 1.5 * r.abscissa);
   const auto ordinate = [&](double friction, double x)
   { return threshold_ordinate(criteria.criterion, friction, x, pad.load_ratio); };
   add_curves(threshold, {0.3, 0.5, 0.8}, f, 99,
              [&](double friction, int i)
              {
                 const double x = last * std::pow(0.01 * (i + 1), 2);
                 return std::pair{x, ordinate(friction, x)};
              });
   mark(threshold, "design", r.abscissa, r.ordinate);
   threshold.limit("y", 0, std::max(ordinate(0.3, 0.05 * last), 1.2 * r.ordinate));

   const double width = judged.problem.rounded_width > 0 ? judged.problem.rounded_width
                                                         : judged.problem.half_width;
   Panel &diagram =
      study.lines("diagram", "Kitagawa-Takahashi: " + to_string(r.threshold.verdict),
                  "crack depth c/a0", "driving force/ΔK_th");
   diagram.say("scale", "loglog");
   // A crack that is no longer small compared with the contact is in another field.
   const double limit = 0.25 * width / r.critical_length;
   if (width > 0 && limit < 10)
   {
      diagram.say("shade", text("%g,10,too deep for this field", limit));
   }
   CrackedEdge alone = judged.problem.crack;
   alone.bulk_stress = alone.stress_gradient = 0;
   std::vector<double> c, no_growth, drive, drive_alone;
   const auto over_threshold = [&](const CrackedEdge &crack, double depth)
   {
      const double ratio =
         crack_cycle(crack, depth).drive(criteria.criterion) / pad.material.threshold;
      return ratio > 0 && (width == 0 || depth <= 0.25 * width) ? ratio : none;
   };
   for (int i = 0; i <= 120; i++)
   {
      c.push_back(0.01 * std::pow(10, i / 40.0));
      no_growth.push_back(std::min(1.0, std::sqrt(c.back())));
      drive.push_back(over_threshold(judged.problem.crack, c.back() * r.critical_length));
      drive_alone.push_back(over_threshold(alone, c.back() * r.critical_length));
   }
   diagram.add("threshold (no growth below)", c, no_growth, "dashed");
   diagram.add("crack of the design", c, drive);
   diagram.add("crack, edge field alone", c, drive_alone);
   const double at_a0 = r.threshold.drive / pad.material.threshold;
   if (at_a0 > 0.05) { mark(diagram, "design at a0", 1, at_a0); }
   const double stops = r.threshold.arrest_depth / r.critical_length;
   if (stops >= c.front() && stops <= c.back())
   {
      diagram.point("the crack stops", stops, std::min(1.0, std::sqrt(stops)), "cross");
   }
   diagram.limit("y", 0.05, none);
}

namespace
{

/// The cells between commas; an empty cell counts too.
std::vector<std::string> cells_of(const std::string &line)
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

/// One test.
struct Record
{
   Pad pad;
   std::string series = "tests";
   double cycles = none, runout = 0, yield = none, threshold_ratio = none;

   void read(const std::vector<std::string> &columns, const std::vector<std::string> &cells,
             const std::vector<FatigueMaterial> &materials, const std::string &where)
   {
      require(cells.size() == columns.size(), where, ": there are ", cells.size(),
              " values for ", columns.size(), " columns.");
      const std::map<std::string, double *> targets{{"cycles", &cycles},
                                                    {"runout", &runout},
                                                    {"P", &pad.normal},
                                                    {"Q", &pad.shear},
                                                    {"bulk", &pad.bulk},
                                                    {"bulk_pad", &pad.bulk_pad},
                                                    {"load_ratio", &pad.load_ratio},
                                                    {"radius", &pad.radius},
                                                    {"flat", &pad.flat},
                                                    {"friction", &pad.friction},
                                                    {"yield", &yield},
                                                    {"threshold_ratio", &threshold_ratio}};
      const double common_friction = std::exchange(pad.friction, none);
      bool own_material = false;
      for (std::size_t i = 0; i < cells.size(); i++)
      {
         const std::string &column = columns[i], &cell = cells[i];
         const bool word = column == "series" || column == "pad" || column == "material";
         const auto target = targets.find(column);
         require(word || target != targets.end(), where, ": there is no column '", column,
                 "'.");
         if (cell.empty()) { continue; }
         if (column == "series") { series = cell; }
         else if (column == "pad")
         {
            require(cell == "hertz" || cell == "flat-rounded" || cell == "fe", where,
                    ": the pad is '", cell, "', must be hertz, flat-rounded or fe.");
            pad.kind = cell;
         }
         else if (column == "material")
         {
            pad.material = find_material(materials, cell);
            own_material = true;
         }
         else { *target->second = number(where + ", column " + column, cell); }
      }
      require(!own_material || !std::isnan(pad.friction), where,
              ": a test with a material of its own needs its friction, in a column friction.");
      if (std::isnan(pad.friction)) { pad.friction = common_friction; }
      if (!std::isnan(yield)) { pad.material.shear_yield = {yield, yield}; }
      if (!std::isnan(threshold_ratio)) { pad.material.threshold_ratio = threshold_ratio; }
      pad.material.validate();
      require(cycles > 0, where, ": the number of cycles must be given and positive.");
      require(runout == 0 || runout == 1, where, ": runout is ", runout,
              "; it must be 0 or 1.");
   }
};

/** The level of a measure that divides broken from lasting tests with the fewest tests on its
    wrong side. Of several such levels it is the middle of the widest gap (by ratio). NaN if no
    level is better than calling all tests broken, or all lasting. */
struct DividingLevel
{
   double level = none;
   int wrong = 0;

   /// @a tests: the measure and whether it broke.
   explicit DividingLevel(std::vector<std::pair<double, bool>> tests)
   {
      std::sort(tests.begin(), tests.end());
      const auto count = static_cast<int>(tests.size());
      int broke = 0;
      for (const auto &test : tests) { broke += test.second; }
      wrong = std::min(broke, count - broke);
      // Broken ones below the level, and lasting ones above it.
      int now = count - broke;
      double widest = 0;
      for (int k = 0; k + 1 < count; ++k)
      {
         now += tests[k].second ? 1 : -1;
         const double below = tests[k].first, above = tests[k + 1].first, gap = above / below;
         if (above > below && (now < wrong || (now == wrong && widest > 0 && gap > widest)))
         {
            wrong = now;
            widest = gap;
            level = std::sqrt(below * above);
         }
      }
   }
};

} // namespace

void correlate(Study &study, const std::string &file, const Pad &common,
               const FrettingSettings &criteria, const std::vector<FatigueMaterial> &materials)
{
   std::ifstream stream(file);
   require(stream.good(), "cannot read the test records ", file, ".");
   study.title("Tests of " + file);
   ResultTable &table = study.table("records", {{"series", "series"},
                                                {"material"},
                                                {"cycles", "cycles", "%.3g"},
                                                {"runout"},
                                                {"friction"},
                                                {"edge_stress_range", "Δσ, MPa", "%.4g"},
                                                {"threshold_x", "X", "%.4g"},
                                                {"design_y", "Y", "%.4g"},
                                                {"k_t_range", "ΔK_T", "%.4g"},
                                                {"energy_max", "energy", "%.4g"},
                                                {"energy_total"},
                                                {"yield_load"},
                                                {"trust", "trust"}});
   const auto over_life = [&](const char *name, const char *title, const char *y) -> Panel &
   {
      Panel &panel = study.lines(name, title, "life, cycles", y);
      panel.say("scale", "semilogx");
      return panel;
   };
   Panel &stress = over_life("stress", "Edge stress range", "Δσ_xx, MPa"),
         &tests = study.lines("threshold_tests", "Tests and threshold", x_of_threshold,
                              y_of_threshold),
         &mode_two = over_life("mode_two", "Mode II", "ΔK_T, MPa√mm"),
         &energy = over_life("energy", "Largest frictional energy", "energy a cycle, mJ/mm²"),
         &total =
            over_life("energy_all", "Frictional energy of the edge", "energy a cycle, mJ/mm");
   double least = std::numeric_limits<double>::infinity(), most = 0, furthest = 0;
   std::map<std::string, FatigueMaterial> used;
   std::map<std::string, std::set<double>> ratios; // load ratios of the tests of a material
   struct Measure
   {
      const char *name;
      Panel *panel; ///< over life
      bool divides; ///< is its dividing level drawn there?
      double (*of)(const FrettingReport &);
      std::vector<std::pair<double, bool>> tests = {}; ///< and whether the test broke
   };
   using Of = const FrettingReport &;
   Measure measures[] = {
      {"edge stress range", &stress, false, [](Of r) { return r.edge_stress_range; }},
      {"Y over threshold", nullptr, false,
       [](Of r) { return r.ordinate / r.threshold_ordinate; }},
      {"range of K_T", &mode_two, false, [](Of r) { return r.k_t_range; }},
      {"largest energy", &energy, true, [](Of r) { return r.energy_max; }},
      {"energy of the edge", &total, true, [](Of r) { return r.energy_total; }}};
   long count = 0, broke = 0;
   std::set<std::pair<double, double>> rubbed; // friction and load ratio
   std::vector<std::string> columns;
   int number = 0;
   for (std::string line; std::getline(stream, line);)
   {
      number++;
      if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') { continue; }
      const std::vector<std::string> cells = cells_of(line);
      if (columns.empty())
      {
         columns = cells;
         continue;
      }
      const std::string where = file + ", line " + std::to_string(number);
      Record test{common};
      try
      {
         test.read(columns, cells, materials, where);
         PadContact contact = calibrate(test.pad);
         if (test.pad.kind == "fe")
         {
            contact = solve(study, test.pad, contact, false).in_place_of(contact);
         }
         const FrettingReport r = judge(test.pad, contact, criteria).report;
         used.emplace(test.pad.material.name, test.pad.material);
         rubbed.insert({test.pad.friction, test.pad.load_ratio});
         ratios[test.pad.material.name].insert(test.pad.load_ratio);
         ++count;
         broke += test.runout != 1;
         study.row(table, {test.series, test.pad.material.name, test.cycles, test.runout,
                           test.pad.friction, r.edge_stress_range, r.abscissa, r.ordinate,
                           r.k_t_range, r.energy_max, r.energy_total,
                           r.yield_ratio_full / test.pad.friction, to_string(r.trust)});
         const bool trusted = r.trust != Trust::poor;
         const auto add = [&](Panel &panel, double x, double y)
         {
            panel.point(test.series, x, y, test.runout == 1 ? "hollow" : "points");
            if (!trusted) { panel.point("crossed: trust is poor", x, y, "cross"); }
         };
         add(tests, r.abscissa, r.ordinate);
         for (Measure &measure : measures)
         {
            const double value = measure.of(r);
            measure.tests.emplace_back(value, test.runout != 1);
            if (measure.panel) { add(*measure.panel, test.cycles, value); }
         }
         least = std::min(least, test.cycles);
         most = std::max(most, test.cycles);
         furthest = std::max(furthest, r.abscissa);
      }
      catch (const InputError &error)
      {
         const std::string what = error.what();
         throw InputError(what.rfind(where, 0) == 0 ? what : where + ": " + what);
      }
   }
   require(most > 0, "there are no tests in ", file, ".");
   const auto across = [&](Panel &panel, const std::string &name, double y) {
      panel.add(name, std::vector<double>{least, most}, {y, y}, "dashed");
   };
   for (const auto &[material, properties] : used)
   {
      const std::string of = used.size() > 1 ? ", " + material : "";
      const auto level = [&](Panel &panel, const std::string &name, double y)
      { across(panel, name + of, y); };
      level(stress,
            properties.fatigue_limit_basis == Basis::range ? "range at the plain fatigue limit"
                                                           : "amplitude of the plain limit",
            properties.fatigue_limit.low);
      const double threshold =
         criteria.mode_two_ratio * properties.threshold / mode_two_range(1);
      level(mode_two, "mode II threshold", threshold);
      // At a higher load ratio the range falls, at most until the largest value of the cycle is
      // the same.
      for (const double R : ratios[material])
      {
         const double measured_at = properties.threshold_ratio;
         if (R > measured_at)
         {
            level(mode_two, exact_text("reduced to R = ", R) + " at most",
                  threshold * (1 - R) / (1 - measured_at));
         }
      }
   }
   if (broke > 0 && broke < count)
   {
      study.title("Level of each measure that divides broken tests from lasting ones best");
      ResultTable &dividing =
         study.table("dividing_levels", {{"measure", "measure            "},
                                         {"level", "level", "%.4g"},
                                         {"wrong", "tests on its wrong side"},
                                         {"tests", "of"}});
      for (const Measure &measure : measures)
      {
         const DividingLevel best(measure.tests);
         study.row(dividing, {measure.name, best.level, best.wrong, count});
         if (!measure.divides || !std::isfinite(best.level)) { continue; }
         across(*measure.panel, "divides broken from lasting best", best.level);
      }
   }
   double highest = 0;
   for (const auto &[friction, load_ratio] : rubbed)
   {
      std::vector<double> x, y;
      for (int i = 1; i <= 100; i++)
      {
         x.push_back(1.4 * furthest * std::pow(0.01 * i, 2));
         y.push_back(threshold_ordinate(criteria.criterion, friction, x.back(), load_ratio));
      }
      tests.add(rubbed.size() == 1
                   ? "threshold"
                   : exact_text("threshold, f = ", friction) + exact_text(", R = ", load_ratio),
                x, y, "dashed");
      highest = std::max(highest, 2 * y[50]);
   }
   tests.limit("y", 0, highest);
   for (Panel *panel : {&stress, &mode_two, &energy, &total}) { panel->limit("y", 0, none); }
}

} // namespace miniapp
