#include <algorithm>
#include <cattaneo/fretting/edge_report.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <sstream>

namespace cattaneo::fretting
{

namespace
{

/// A sentence with its numbers to three digits.
template <class... Parts>
std::string sentence(const Parts &...parts)
{
   std::ostringstream text;
   text.precision(3);
   (text << ... << parts);
   return text.str();
}

void predict(const MarchedStates &states, const ContactEdge *before,
             const ContactEdge *opposite, SolvedEdge &solved)
{
   const ContactEdge &edge = solved.edge;
   const double d = slip_zone(near_edge(edge));
   const Eigen::VectorXd &arc = states.problem.arc_length;
   const Eigen::Index end = edge.side > 0 ? edge.first : edge.last;
   const double spacing = std::abs(arc[end + edge.side] - arc[end]);
   if (edge.slip_zone < 2 * spacing && d > 0)
   {
      solved.notes.push_back(sentence("the computed slip zone of ", edge.slip_zone,
                                      " is shorter than two spacings of the nodes (", spacing,
                                      "): its length and energy are not resolved"));
   }
   else if (d < 2 * spacing && d > 0)
   {
      solved.notes.push_back(sentence("the slip zone from K_N and K_T, ", d,
                                      ", is shorter than two spacings of the nodes (", spacing,
                                      "); the computed slip zone is longer"));
   }
   // If the next term of the expansion changes the fit by more than a tenth, the nodes are too
   // few, or too far from the edge, to resolve the square root.
   if (std::max(edge.k_n.relative_error, edge.k_t.relative_error) > 0.1 && d > 0)
   {
      solved.notes.push_back("the fit is uncertain: refine the contact near its edge");
   }
   if (edge.slides)
   {
      solved.notes.push_back("the contact beside this edge slides as a whole");
   }
   if (before)
   {
      solved.travel = edge.position.position - before->position.position;
      // The predictions take K_N as constant, so the edge must not move. A tenth of the slip
      // zone is tolerated.
      if (std::abs(solved.travel) > 0.1 * d)
      {
         solved.notes.push_back(sentence("the edge moves by ", solved.travel,
                                         " under the cyclic loads, which is not small against "
                                         "the slip zone from K_N and K_T, ",
                                         d, ": the predictions assume a constant K_N"));
      }
   }
   if (!states.cycle) { return; }
   if (states.modulus <= 0)
   {
      solved.notes.push_back(
         "no energy is predicted, because the bodies have different materials");
      return;
   }
   if (!opposite || !opposite->why_not.empty())
   {
      solved.notes.push_back("no edge at the other end of the cycle corresponds to this one: "
                             "no energy is predicted");
      return;
   }
   solved.k_t_range = std::abs(edge.k_t.value - opposite->k_t.value);
   solved.energy =
      compare_energy(states.problem, edge, *states.cycle, solved.k_t_range, states.modulus);
}

void fit_at_corner(const MarchedStates &states, SolvedEdge &solved)
{
   solved.notes.push_back(solved.edge.why_not);
   if (!states.corner || !solved.edge.complete) { return; }
   try
   {
      const CornerModes modes = states.corner(solved.edge.side);
      const ContactState stuck =
         fully_stuck(states.problem, ContactState::virgin(states.problem), states.peak);
      solved.corner = fit_corner(modes, edge_tractions(states.problem, stuck, solved.edge));
   }
   catch (const InputError &error)
   {
      solved.notes.push_back(std::string("not fitted as a corner: ") + error.what());
   }
}

} // namespace

EdgeReport read_edges(const MarchedStates &states)
try
{
   const std::vector<ContactEdge> edges =
      contact_edges(states.problem, states.pressed, states.peak, states.cracked);
   const std::vector<ContactEdge> before =
      contact_edges(states.problem, states.pressed, states.pressed, states.cracked);
   // In a cycle between zero and the peak the pressed state is the other end.
   const std::vector<ContactEdge> opposite =
      !states.opposite ? std::vector<ContactEdge>()
      : states.opposite == &states.pressed
         ? before
         : contact_edges(states.problem, states.pressed, *states.opposite, states.cracked);
   // Edges of two states correspond one to one only if both have the same number. Otherwise a
   // stretch of contact has appeared or vanished, and nothing is compared.
   const auto like = [&](const std::vector<ContactEdge> &all, std::size_t e)
   { return all.size() == edges.size() ? &all[e] : nullptr; };
   EdgeReport report;
   for (std::size_t e = 0; e < edges.size(); e++)
   {
      SolvedEdge solved;
      solved.edge = edges[e];
      if (!solved.edge.why_not.empty()) { fit_at_corner(states, solved); }
      else { predict(states, like(before, e), like(opposite, e), solved); }
      report.edges.push_back(solved);
   }
   if (edges.empty())
   {
      report.why_not = "there is no edge: nothing is in contact, or the contact reaches from "
                       "one plane of symmetry to the other";
   }
   return report;
}
catch (const InputError &error)
{
   return {{}, error.what()};
}

} // namespace cattaneo::fretting
