#include "common/critical_planes.hpp"

#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cmath>
#include <deque>

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
   const char *key, *name;
};
constexpr NamedCriterion named_criteria[] = {
   {PlaneCriterion::findley, "findley", "Findley"},
   {PlaneCriterion::smith_watson_topper, "smith_watson_topper", "Smith–Watson–Topper"},
   {PlaneCriterion::fatemi_socie, "fatemi_socie", "Fatemi–Socie"}};

/// The specimen, a half-plane below its surface, at the instants of the cycle.
class Specimen
{
public:
   Specimen(const Pad &pad, const SolvedPad &solved)
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
      for (const PadInstant &instant : solved.cycle)
      {
         // Nodes of the surface below follow each other against x, and so do their tangents.
         Eigen::VectorXd forces(2 * n);
         forces << -instant.shear.reverse(), instant.pressure.reverse();
         fields_.emplace_back(body, line, forces);
         bulk_.push_back(instant.bulk);
      }
   }

   /// The mean of the stresses between the surface and a depth; at the surface if that is 0.
   StressCycle averaged(double x, double depth) const
   {
      StressCycle cycle = StressCycle::Zero(static_cast<Index>(fields_.size()), 4);
      if (depth == 0)
      {
         add(cycle, x, 0, 1);
         return cycle;
      }
      // Stresses change fastest at the surface: parts of growing size, each by Gauss' rule.
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

} // namespace

void report_critical_planes(Study &study, const Pad &pad, const SolvedPad &solved, double depth,
                            const PlaneWeights &weights)
{
   const Specimen specimen(pad, solved);
   const StressCycle plain = plain_fatigue_cycle(pad.material);
   std::vector<Column> columns{{"x"}};
   std::vector<Table::Curve> curves;
   std::vector<double> limits;
   for (const NamedCriterion &one : named_criteria)
   {
      limits.push_back(critical_plane(one.criterion, plain, pad.material, weights).value);
      columns.push_back({one.key});
      columns.push_back({std::string(one.key) + "_angle"});
      curves.push_back({one.key, one.name});
   }
   Table &along = study.table("planes", columns);
   along.draw("Critical planes along the surface", "x", "x / a", curves,
              "share of what a plain specimen endures");
   struct Worst
   {
      double share = 0, x = 0, angle = 0;
   };
   Worst worst[std::size(named_criteria)][2]; // by criterion and half of the surface
   // The edges of the contact are where stresses change fastest, and lie among the places.
   const int places = 30;
   for (int k = -places; k <= places; ++k)
   {
      const double x = 1.5 * k / places;
      const StressCycle cycle = specimen.averaged(x * solved.half_width, depth);
      std::vector<nlohmann::ordered_json> row{x};
      for (std::size_t c = 0; c < limits.size(); ++c)
      {
         const CriticalPlane plane =
            critical_plane(named_criteria[c].criterion, cycle, pad.material, weights);
         const Worst here{plane.value / limits[c], x, plane.angle * 180 / M_PI};
         row.push_back(here.share);
         row.push_back(here.angle);
         Worst &most = worst[c][k > 0];
         if (here.share > most.share) { most = here; }
      }
      study.row(along, row);
   }
   study.title(text("7. Criteria on critical planes, stresses averaged over %.4g µm of depth",
                    1e3 * depth));
   Table &table = study.table("critical_planes", {{"criterion", "           criterion"},
                                                  {"edge", "    edge"},
                                                  {"share", "of the limit", "%.4g"},
                                                  {"x", "at x / a", "%.3f"},
                                                  {"angle", "normal, °", "%.1f"}});
   for (std::size_t c = 0; c < limits.size(); ++c)
   {
      for (const int right : {0, 1})
      {
         const Worst &most = worst[c][right];
         const bool trailing = (right == 0) == (pad.shear >= 0);
         study.row(table, {named_criteria[c].name, trailing ? "trailing" : "leading",
                           most.share, most.x, most.angle});
      }
   }
   study.results["planes_depth"] = depth;
   study.say("\n" + wrapped("The limit is what a plain specimen endures at its fatigue limit: "
                            "above 1 a crack starts. Angles are of the plane's normal from the "
                            "surface: 0 is a crack normal to it.",
                            3));
}

} // namespace miniapp
