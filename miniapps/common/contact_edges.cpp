#include "common/contact_edges.hpp"

namespace miniapp
{

using namespace cattaneo;
using namespace cattaneo::fretting;
using Json = nlohmann::ordered_json;

void report_edge(Study &study, const SolvedEdge &solved, const std::string &name, double shift)
{
   const ContactEdge &edge = solved.edge;
   const auto line =
      [&](const std::string &what, double x, double error = none, const std::string &more = "")
   { study.value("", x, name + what, error, more); };
   const auto intensity = [&](const char *what, const FittedIntensity &k)
   {
      line(what, k.value, k.relative_error * std::abs(k.value),
           text("(fitted from %.3g to %.3g, %d nodes)", k.window.nearest, k.window.farthest,
                k.nodes));
   };
   line(" edge at", edge.position.position + shift, edge.position.error);
   if (edge.why_not.empty())
   {
      intensity(": K_N", edge.k_n);
      intensity(": K_T", edge.k_t);
      line(": slip zone", edge.slip_zone, edge.slip_zone_error,
           edge.slides ? "(the whole contact slides)" : "");
      line(": slip zone from K_N and K_T", slip_zone(near_edge(edge)));
   }
   if (solved.energy)
   {
      line(": energy per cycle", solved.energy->computed_total);
      line(": energy from K_N and K_T", solved.energy->predicted_total, none,
           text("(ΔK_T %.4g)", solved.k_t_range));
      line(": largest energy per area", solved.energy->computed_max);
      line(": largest from K_T", solved.energy->predicted_max);
   }
   if (solved.corner)
   {
      const CornerFit &fit = *solved.corner;
      intensity(": K_I", fit.k_one);
      if (fit.modes.two) { intensity(": K_II", fit.k_two); }
      line(": exponent λ-1 of K_I", fit.modes.one.eigenvalue - 1);
      if (fit.modes.two) { line(": exponent λ-1 of K_II", fit.modes.two->eigenvalue - 1); }
      line(": the corner slips below f", fit.least_friction);
   }
   for (const std::string &note : solved.notes) { study.say("   " + note); }
}

void report_edges(Study &study, const EdgeReport &report, double shift)
{
   study.title("Edges of the contact (units of the problem)");
   if (!report.why_not.empty()) { study.say("   not read: " + report.why_not); }
   Json &list = study.results["edges"] = Json::array();
   for (const SolvedEdge &solved : report.edges)
   {
      report_edge(study, solved, solved.edge.side > 0 ? "first" : "last", shift);
      list.push_back(to_json(solved));
      list.back()["x"] = solved.edge.position.position + shift; // as it is printed
   }
}

namespace
{

Json to_json(const FittedIntensity &fitted)
{
   return {{"value", fitted.value},
           {"relative_error", fitted.relative_error},
           {"window", {fitted.window.nearest, fitted.window.farthest}},
           {"nodes", fitted.nodes}};
}

} // namespace

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

} // namespace miniapp
