#include "plane_receding/bonded_strip.hpp"

#include "common/receding_study.hpp"
#include "common/williams.hpp"

#include <algorithm>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

Index nodes_before(const VectorXd &x, double at)
{
   return std::lower_bound(x.data(), x.data() + x.size(), at) - x.data();
}

namespace
{

/// Traction ratio of the bonded strip for several n (thesis figure 5.2), and the overhangs at
/// which its kind changes.
void bonded_strips(Study &study, const RecedingOptions &options, const ReducedProblem &problem,
                   const std::vector<double> &overhangs, Panel &panel)
{
   study.title("Bonded strips");
   ResultTable &table =
      study.table("bonded_strips", {{"overhang", "n", "%.4g"},
                                    {"second_strength", "second strength"},
                                    {"adhesion_friction", "f for full adhesion"},
                                    {"adhesion_x", "needed at x/t"},
                                    {"lowest_pressure", "lowest p/p0", "%.3e"}});
   const Index shown = nodes_before(problem.arc_length, 3.0) - 8;
   for (const double n : overhangs)
   {
      const BondedTractions b = bonded_tractions(problem, n);
      study.row(table,
                {n, b.strengths(1, 0), b.adhesion_friction, b.adhesion_x, b.lowest_pressure});
      if (b.lowest_pressure <= 0) { continue; }
      panel.add(exact_text("n = ", n), problem.arc_length.segment(8, shown),
                b.q.cwiseQuotient(b.p).segment(8, shown));
   }
   const auto changing_from = [&](double from, double to, auto figure)
   {
      return changing(from, to,
                      [&, of = options](const std::vector<double> &several) mutable
                      {
                         of.overhangs = several;
                         const Scene scene = make_receding(of);
                         std::vector<double> figures;
                         for (double n : several)
                         {
                            figures.push_back(figure(bonded_tractions(scene.problem(), n)));
                         }
                         return figures;
                      });
   };
   // The overhang from which on the largest ratio is not at the corner.
   study.value("rising_from",
               changing_from(0.05, 0.5,
                             [](const BondedTractions &b)
                             { return b.adhesion_x > 0 ? 1 : -1; }),
               "n from which q/p rises away from the corner");
   study.value(
      "pulling_from",
      changing_from(0.5, 4, [](const BondedTractions &b) { return b.lowest_pressure; }),
      "n from which it pulls somewhere");
}

} // namespace

void report_bonded(Study &study, const RecedingOptions &options, const ReducedProblem &problem,
                   double overhang, const std::vector<double> &others)
{
   const BondedTractions b = bonded_tractions(problem, overhang);
   study.title("Bonded strip");
   study.value("corner_ratio", b.corner_ratio, "q/p at the corner (Williams: 0.5431)");
   study.say(std::isnan(b.strengths(0, 0))
                ? "   the mesh has too few nodes near the corner to fit its singular terms"
                : text("   strengths of its singular terms: %.4f and %.4f", b.strengths(0, 0),
                       b.strengths(1, 0)));
   study.results["corner_strength"] = {b.strengths(0, 0), b.strengths(1, 0)};
   study.value("lowest_bonded_pressure", b.lowest_pressure, "lowest pressure at x > 0", none,
               "p0");
   study.value("adhesion_friction", b.adhesion_friction, "friction for full adhesion", none,
               std::isfinite(b.adhesion_friction) ? "" : "none: the strip pulls");
   study.value("adhesion_x", b.adhesion_x, "needed at x/t");
   Panel &panel = study.lines("bonded", "Bonded strip: traction ratio", "x/t", "q/p");
   if (others.empty())
   {
      const Index shown = nodes_before(problem.arc_length, 3.0) - 8;
      panel.add(exact_text("n = ", overhang), problem.arc_length.segment(8, shown),
                b.q.cwiseQuotient(b.p).segment(8, shown));
   }
   else { bonded_strips(study, options, problem, others, panel); }
   panel.add("Williams corner", std::vector<double>{0, 3},
             {williams_ratio[0], williams_ratio[0]}, "dashed");
}

} // namespace miniapp
