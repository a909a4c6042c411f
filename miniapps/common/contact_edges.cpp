#include "common/contact_edges.hpp"

#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using Json = nlohmann::ordered_json;

namespace
{

void predict(const EdgeStudy &study, const ContactEdge *before, const ContactEdge *opposite,
             SolvedEdge &solved)
{
   const ContactEdge &edge = solved.edge;
   const double d = slip_zone(near_edge(edge));
   const Eigen::VectorXd &arc = study.problem.arc_length;
   const Eigen::Index end = edge.side > 0 ? edge.first : edge.last;
   const double spacing = std::abs(arc[end + edge.side] - arc[end]);
   if (std::min(d, edge.slip_zone) < 2 * spacing && d > 0)
   {
      solved.notes.push_back(
         text("a slip zone of %.3g is shorter than two spacings of the nodes (%.3g): its "
              "computed length and energy are not resolved",
              std::min(d, edge.slip_zone), spacing));
   }
   // A fit that its own next term changes by a tenth has not found the square root.
   if (std::max(edge.k_n.relative_error, edge.k_t.relative_error) > 0.1 && d > 0)
   {
      solved.notes.push_back("the fit is uncertain: refine the contact near its edge");
   }
   if (edge.slides) { solved.notes.push_back("the whole stretch of contact slides"); }
   if (before)
   {
      solved.travel = edge.position.position - before->position.position;
      // The slip zone's length follows from the pressure at its root: a tenth is what the
      // fields can bear.
      if (std::abs(solved.travel) > 0.1 * d)
      {
         solved.notes.push_back(
            text("the edge moves by %.3g under the cyclic loads, the slip zone is %.3g: K_N is "
                 "not constant, as the predictions take it to be",
                 solved.travel, d));
      }
   }
   if (!study.cycle) { return; }
   if (study.modulus <= 0)
   {
      solved.notes.push_back("no energy is predicted: the bodies are not of one material");
      return;
   }
   if (!opposite || !opposite->why_not.empty())
   {
      solved.notes.push_back("this edge has no like at the other end of the cycle: no energy "
                             "is predicted");
      return;
   }
   solved.k_t_range = std::abs(edge.k_t.value - opposite->k_t.value);
   solved.energy =
      compare_energy(study.problem, edge, *study.cycle, solved.k_t_range, study.modulus);
}

void fit_at_corner(const EdgeStudy &study, SolvedEdge &solved)
{
   solved.notes.push_back(solved.edge.why_not);
   if (!study.corner || !solved.edge.complete) { return; }
   try
   {
      const CornerModes modes = study.corner(solved.edge.side);
      const ContactState stuck =
         fully_stuck(study.problem, ContactState::virgin(study.problem), study.peak);
      solved.corner = fit_corner(modes, edge_tractions(study.problem, stuck, solved.edge));
   }
   catch (const InputError &error)
   {
      solved.notes.push_back(std::string("not fitted as a corner: ") + error.what());
   }
}

} // namespace

EdgeReport read_edges(const EdgeStudy &study)
{
   EdgeReport report;
   try
   {
      const std::vector<ContactEdge> edges =
         contact_edges(study.problem, study.pressed, study.peak, study.cracked);
      const std::vector<ContactEdge> before =
         contact_edges(study.problem, study.pressed, study.pressed, study.cracked);
      // A cycle between nothing and the peak has the pressed state as its other end.
      const std::vector<ContactEdge> opposite =
         !study.opposite ? std::vector<ContactEdge>()
         : study.opposite == &study.pressed
            ? before
            : contact_edges(study.problem, study.pressed, *study.opposite, study.cracked);
      for (std::size_t e = 0; e < edges.size(); e++)
      {
         SolvedEdge solved;
         solved.edge = edges[e];
         if (!solved.edge.why_not.empty()) { fit_at_corner(study, solved); }
         else
         {
            // Edges correspond while no stretch of contact is born or dies.
            const auto like = [&](const std::vector<ContactEdge> &all)
            { return all.size() == edges.size() ? &all[e] : nullptr; };
            predict(study, like(before), like(opposite), solved);
         }
         report.edges.push_back(solved);
      }
      if (edges.empty())
      {
         report.why_not = "nothing is in contact, or all between planes of symmetry";
      }
   }
   catch (const InputError &error)
   {
      report = {};
      report.why_not = error.what();
   }
   return report;
}

void print(const EdgeReport &report, const std::function<double(double)> &coordinate)
{
   std::printf("\nEdges of the contact (units of the problem)\n");
   if (!report.why_not.empty()) { std::printf("   not read: %s\n", report.why_not.c_str()); }
   for (const SolvedEdge &solved : report.edges)
   {
      const ContactEdge &edge = solved.edge;
      std::printf(" %s edge at %.5g ± %s\n", edge.side > 0 ? "first" : "last",
                  coordinate(edge.position.position), error_text(edge.position.error).c_str());
      const auto line = [](const char *what, const FittedIntensity &fitted)
      {
         std::printf("   %-12s %11.4e ± %s %%, fitted from %.3g to %.3g (%d nodes)\n", what,
                     fitted.value, error_text(100 * fitted.relative_error).c_str(),
                     fitted.window.nearest, fitted.window.farthest, fitted.nodes);
      };
      if (edge.why_not.empty())
      {
         line("K_N", edge.k_n);
         line("K_T", edge.k_t);
         std::printf("   slip zone    %11.4e ± %s, predicted %.4e\n", edge.slip_zone,
                     error_text(edge.slip_zone_error).c_str(), slip_zone(near_edge(edge)));
      }
      if (solved.energy)
      {
         std::printf("   energy/cycle %11.4e, predicted %.4e (ΔK_T %.3e)\n",
                     solved.energy->computed_total, solved.energy->predicted_total,
                     solved.k_t_range);
      }
      if (solved.corner)
      {
         const CornerFit &fit = *solved.corner;
         line("K_I", fit.k_one);
         if (fit.modes.two) { line("K_II", fit.k_two); }
         std::printf("   exponents λ-1 %.4f", fit.modes.one.eigenvalue - 1);
         if (fit.modes.two) { std::printf(", %.4f", fit.modes.two->eigenvalue - 1); }
         std::printf("; the corner slips below f = %.4f\n", fit.least_friction);
      }
      for (const std::string &note : solved.notes) { std::printf("   %s\n", note.c_str()); }
   }
}

Json to_json(const FittedIntensity &fitted)
{
   return {{"value", fitted.value},
           {"relative_error", fitted.relative_error},
           {"window", {fitted.window.nearest, fitted.window.farthest}},
           {"nodes", fitted.nodes}};
}

Json to_json(const SolvedEdge &solved)
{
   const ContactEdge &edge = solved.edge;
   Json j = {{"position", edge.position.position},
             {"position_error", edge.position.error},
             {"side", edge.side},
             {"complete", edge.complete}};
   if (edge.why_not.empty())
   {
      j["k_n"] = to_json(edge.k_n);
      j["k_t"] = to_json(edge.k_t);
      j["slip_zone"] = edge.slip_zone;
      j["slip_zone_error"] = edge.slip_zone_error;
      j["slip_zone_predicted"] = slip_zone(near_edge(edge));
      j["slides"] = edge.slides;
      j["travel"] = solved.travel;
   }
   if (solved.energy)
   {
      j["k_t_range"] = solved.k_t_range;
      j["energy"] = solved.energy->computed_total;
      j["energy_predicted"] = solved.energy->predicted_total;
      j["energy_max"] = solved.energy->computed_max;
      j["energy_max_predicted"] = solved.energy->predicted_max;
   }
   if (solved.corner)
   {
      const CornerFit &fit = *solved.corner;
      j["eigenvalues"] = {fit.modes.one.eigenvalue};
      j["k_one"] = to_json(fit.k_one);
      if (fit.modes.two)
      {
         j["eigenvalues"].push_back(fit.modes.two->eigenvalue);
         j["k_two"] = to_json(fit.k_two);
      }
      j["least_friction"] = fit.least_friction;
   }
   j["notes"] = solved.notes;
   return j;
}

Json to_json(const EdgeReport &report)
{
   Json list = Json::array();
   for (const SolvedEdge &solved : report.edges) { list.push_back(to_json(solved)); }
   return list;
}

} // namespace miniapp
