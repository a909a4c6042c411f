#include "fretting/critical_planes.hpp"

#include <algorithm>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cmath>
#include <deque>
#include <memory>

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using Eigen::Index;

namespace
{

struct NamedCriterion
{
   PlaneCriterion criterion;
   const char *key, *name, *unit;
};
constexpr NamedCriterion named_criteria[] = {
   {PlaneCriterion::findley, "findley", "Findley", "MPa"},
   {PlaneCriterion::smith_watson_topper, "smith_watson_topper", "Smith–Watson–Topper", "MPa"},
   {PlaneCriterion::fatemi_socie, "fatemi_socie", "Fatemi–Socie", "strain"}};

/// The specimen, a half-plane below its surface, at the instants of the cycle.
class Specimen
{
public:
   /// At each @a step-th instant.
   Specimen(const Pad &pad, const SolvedPad &solved, std::size_t step)
      : constraint_(out_of_plane_constraint(pad.material.poisson, pad.plane_stress))
   {
      HalfPlane body;
      body.material = {pad.material.young, pad.material.poisson,
                       pad.plane_stress ? PlaneState::stress : PlaneState::strain};
      body.depth = 1e4 * solved.half_width;
      std::vector<double> grid;
      const Index n = solved.positions.size();
      for (Index i = 0; i < n; i += pad.order) { grid.push_back(solved.positions[i]); }
      const ContactLine line = condense(body, straight_line(grid, pad.order)).line;
      for (std::size_t k = step - 1; k < solved.cycle.size(); k += step)
      {
         const PadInstant &instant = solved.cycle[k];
         // Nodes of the surface below follow each other against x, and so do their tangents.
         Eigen::VectorXd forces(2 * n);
         forces << -instant.shear.reverse(), instant.pressure.reverse();
         fields_.emplace_back(body, line, forces);
         bulk_.push_back(instant.bulk);
      }
   }

   /// σ_xx on the surface at the last instant, which is the peak.
   double at_surface(double x) const { return fields_.back().at({x, 0}).xx + bulk_.back(); }

   /// The mean of the stresses between the surface and a depth.
   StressCycle averaged(double x, double depth) const
   {
      StressCycle cycle = StressCycle::Zero(static_cast<Index>(fields_.size()), 4);
      // Stresses change fastest at the surface, so the depth is cut into parts of growing size,
      // each with Gauss' rule.
      const mfem::IntegrationRule &rule = mfem::IntRules.Get(mfem::Geometry::SEGMENT, 3);
      double from = 0;
      for (const double to : {1.0 / 16, 1.0 / 4, 1.0})
      {
         for (int k = 0; k < rule.Size(); ++k)
         {
            const mfem::IntegrationPoint &point = rule.IntPoint(k);
            add(cycle, x, depth * (from + point.x * (to - from)), point.weight * (to - from));
         }
         from = to;
      }
      return cycle;
   }

private:
   void add(StressCycle &cycle, double x, double depth, double weight) const
   {
      for (std::size_t k = 0; k < fields_.size(); ++k)
      {
         const HalfPlaneField::Point at = fields_[k].at({x, -depth});
         const double xx = at.xx + bulk_[k];
         cycle.row(static_cast<Index>(k)) +=
            weight * Eigen::RowVector4d(xx, at.yy, constraint_ * (xx + at.yy), at.xy);
      }
   }

   double constraint_;
   std::deque<HalfPlaneField> fields_; // they do not move
   std::vector<double> bulk_;
};

/** Places along the surface, over the half-width: a uniform net, and places ever closer to the
    edges of the contact, down to half of the depth, as stresses change fastest there. */
std::vector<double> places_along(double depth)
{
   std::vector<double> places;
   for (int k = -30; k <= 30; ++k) { places.push_back(k / 20.0); }
   for (double step = 0.025; step > 0.5 * depth; step /= 2)
   {
      for (const double edge : {-1.0, 1.0})
      {
         places.insert(places.end(), {edge - step, edge + step});
      }
   }
   std::sort(places.begin(), places.end());
   return places;
}

} // namespace

std::function<double(double)> surface_stress(const Pad &pad, const SolvedPad &solved)
{
   const auto specimen = std::make_shared<Specimen>(pad, solved, solved.cycle.size());
   return [specimen](double x) { return specimen->at_surface(x); };
}

void report_critical_planes(Study &study, const Pad &pad, const SolvedPad &solved,
                            const std::vector<SolvedPad> &coarser, double depth,
                            const PlaneWeights &weights)
{
   const double a = solved.half_width;
   const Specimen specimen(pad, solved, 1);
   std::deque<Specimen> less;
   for (const SolvedPad &coarse : coarser) { less.emplace_back(pad, coarse, 2); }
   const StressCycle plain = plain_fatigue_cycle(pad.material);
   std::vector<Column> columns{{"x"}};
   std::vector<ResultTable::Curve> curves;
   std::vector<double> limits;
   for (const NamedCriterion &one : named_criteria)
   {
      limits.push_back(critical_plane(one.criterion, plain, pad.material, weights).value);
      columns.push_back({one.key});
      columns.push_back({std::string(one.key) + "_angle"});
      curves.push_back({one.key, one.name});
   }
   columns.push_back({"limit"});
   curves.push_back({"limit", "limit (above it a crack starts)"});
   ResultTable &along = study.table("planes", columns);
   along.draw(text("Critical planes, averaged over %.4g mm of depth", depth), "x", "x / a",
              curves, "criterion over its limit");
   const auto plane_of = [&](std::size_t c, const StressCycle &cycle)
   {
      CriticalPlane plane =
         critical_plane(named_criteria[c].criterion, cycle, pad.material, weights);
      plane.value /= limits[c];
      return plane;
   };
   const std::vector<double> places = places_along(depth / a);
   std::vector<std::vector<double>> shares(limits.size());
   for (const double x : places)
   {
      const StressCycle cycle = specimen.averaged(x * a, depth);
      std::vector<nlohmann::ordered_json> row{x};
      for (std::size_t c = 0; c < limits.size(); ++c)
      {
         const CriticalPlane plane = plane_of(c, cycle);
         shares[c].push_back(plane.value);
         row.insert(row.end(), {plane.value, plane.angle * 180 / M_PI});
      }
      row.emplace_back(1);
      study.row(along, row);
   }
   study.title(text("7. Criteria on critical planes, stresses averaged over %.4g µm of depth",
                    1e3 * depth));
   ResultTable &table =
      study.table("critical_planes", {{"criterion", "           criterion"},
                                      {"edge", "    edge"},
                                      {"value", "value", "%.4g"},
                                      {"limit", "its limit", "%.4g"},
                                      {"unit", "unit"},
                                      {"share", "of the limit", "%.4g"},
                                      {"error_estimate", "± (estimate)", "%.1g"},
                                      {"x", "at x / a", "%.3f"},
                                      {"angle", "normal, °", "%.1f"}});
   const std::size_t middle = places.size() / 2;
   std::string above; // the criteria that exceed their limits
   for (std::size_t c = 0; c < limits.size(); ++c)
   {
      for (const bool right : {false, true})
      {
         const auto begin = shares[c].begin() + (right ? middle + 1 : 0),
                    end = right ? shares[c].end() : shares[c].begin() + middle + 1;
         const std::size_t k = std::max_element(begin, end) - shares[c].begin();
         // The maximum lies between the neighbours of the largest value. The interval is
         // reduced by thirds.
         double low = places[k == 0 ? k : k - 1],
                high = places[std::min(k + 1, places.size() - 1)];
         const auto share = [&](double x)
         { return plane_of(c, specimen.averaged(x * a, depth)).value; };
         while (high - low > 1e-3)
         {
            const double left = low + (high - low) / 3, right_of = high - (high - low) / 3;
            if (share(left) < share(right_of)) { low = left; }
            else { high = right_of; }
         }
         const double between = 0.5 * (low + high),
                      x = share(between) > shares[c][k] ? between : places[k];
         const CriticalPlane most = plane_of(c, specimen.averaged(x * a, depth));
         double error = 0;
         for (const Specimen &other : less)
         {
            const double differs = most.value - plane_of(c, other.averaged(x * a, depth)).value;
            error = std::max(error, std::abs(differs));
         }
         const bool trailing = !right == (pad.shear >= 0);
         if (most.value > 1)
         {
            above += (above.empty() ? "" : ", ") + std::string(named_criteria[c].name) +
                     (trailing ? ", trailing" : ", leading") +
                     text(" edge, %.3g of its limit", most.value);
         }
         study.row(table, {named_criteria[c].name, trailing ? "trailing" : "leading",
                           most.value * limits[c], limits[c], named_criteria[c].unit,
                           most.value, error, x, most.angle * 180 / M_PI});
      }
   }
   // The head of the page must not be read without the criteria that contradict it.
   if (!above.empty())
   {
      study.lead["sentence"] = study.lead["sentence"].get<std::string>() +
                               " Critical planes say that a crack starts: " + above + ".";
      study.lead["calm"] = false;
   }
   study.results["planes_depth"] = depth;
   study.say(
      "\n" +
      wrapped("The limit is what a plain specimen endures at its fatigue limit: "
              "above 1 a crack starts. ±, an estimate, is the larger difference to 1/2 and 5/8 "
              "as many nodes. Angles are of the plane's normal from the surface: 0 is a crack "
              "normal to it.",
              3));
}

} // namespace miniapp
