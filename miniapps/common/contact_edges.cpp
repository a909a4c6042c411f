#include "common/contact_edges.hpp"

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using Json = nlohmann::ordered_json;

Json report_edge(Study &study, const SolvedEdge &solved, const std::string &name, double shift)
{
   const ContactEdge &edge = solved.edge;
   Json row = {{"edge", name},
               {"position", edge.position.position},
               {"position_error_estimate", edge.position.error},
               {"side", edge.side},
               {"complete", edge.complete}};
   const auto line = [&](const char *key, const std::string &what, double x,
                         double error = none, const std::string &more = "")
   {
      row[key] = x;
      if (!std::isnan(error)) { row[std::string(key) + "_error_estimate"] = error; }
      study.value("", x, name + what, error, more);
   };
   const auto intensity = [&](const char *key, const char *what, const FittedIntensity &k)
   {
      row[key] = {{"value", k.value},
                  {"relative_error_estimate", k.relative_error},
                  {"window", {k.window.nearest, k.window.farthest}},
                  {"nodes", k.nodes}};
      study.value("", k.value, name + what, k.relative_error * std::abs(k.value),
                  text("(fitted from %.3g to %.3g, %d nodes)", k.window.nearest,
                       k.window.farthest, k.nodes));
   };
   line("x", " edge at", edge.position.position + shift, edge.position.error);
   if (edge.why_not.empty())
   {
      intensity("k_n", ": K_N", edge.k_n);
      intensity("k_t", ": K_T", edge.k_t);
      line("slip_zone", ": slip zone", edge.slip_zone, edge.slip_zone_error,
           edge.slides ? "(the whole contact slides)" : "");
      line("slip_zone_predicted", ": slip zone from K_N and K_T", slip_zone(near_edge(edge)));
      row["slides"] = edge.slides;
      row["travel"] = solved.travel;
   }
   if (solved.energy)
   {
      row["k_t_range"] = solved.k_t_range;
      line("energy", ": energy per cycle", solved.energy->computed_total);
      line("energy_predicted", ": energy from K_N and K_T", solved.energy->predicted_total,
           none, text("(ΔK_T %.4g)", solved.k_t_range));
      line("energy_max", ": largest energy per area", solved.energy->computed_max);
      line("energy_max_predicted", ": largest from K_T", solved.energy->predicted_max);
   }
   if (solved.corner)
   {
      const CornerFit &fit = *solved.corner;
      const auto exponent = [&](const std::string &what, const auto &mode)
      {
         row["eigenvalues"].push_back(mode.eigenvalue);
         study.value("", mode.eigenvalue - 1, name + ": exponent λ-1 of " + what);
      };
      intensity("k_one", ": K_I", fit.k_one);
      if (fit.modes.two) { intensity("k_two", ": K_II", fit.k_two); }
      exponent("K_I", fit.modes.one);
      if (fit.modes.two) { exponent("K_II", *fit.modes.two); }
      line("least_friction", ": the corner slips below f", fit.least_friction);
   }
   for (const std::string &note : solved.notes) { study.say("   " + note); }
   row["notes"] = solved.notes;
   return row;
}

void report_edges(Study &study, const EdgeReport &report, double shift)
{
   study.title("Edges of the contact (units of the problem)");
   if (!report.why_not.empty()) { study.say("   not read: " + report.why_not); }
   Json &list = study.results["edges"] = Json::array();
   for (const SolvedEdge &solved : report.edges)
   {
      list.push_back(
         report_edge(study, solved, solved.edge.side > 0 ? "first" : "last", shift));
   }
   study.list("edges", list);
}

} // namespace miniapp
