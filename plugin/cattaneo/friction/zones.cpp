#include <cattaneo/dense_algebra.hpp>
#include <cattaneo/friction/zones.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

VectorXd tractions(const ReducedProblem &problem, const VectorXd &nodal_forces)
{
   require(problem.weights.size() == nodal_forces.size(), "tractions: ", nodal_forces.size(),
           " nodal forces for ", problem.weights.size(), " weights");
   VectorXd t(nodal_forces.size());
   for (Index i = 0; i < t.size(); ++i)
   {
      t[i] = problem.weights[i] > 0 ? nodal_forces[i] / problem.weights[i] : 0.0;
   }
   return t;
}

namespace
{

/// Lengths of the tangential vectors of n nodes; zero without tangential components.
VectorXd lengths(const VectorXd &x, Index n)
{
   if (x.size() == n) { return x.cwiseAbs(); }
   VectorXd length = VectorXd::Zero(n);
   for (Index i = 0; i < n && x.size() > 0; ++i) { length[i] = std::hypot(x[i], x[n + i]); }
   return length;
}

/// Least-squares polynomial c0 + c1 x + … of the given degree.
VectorXd fit(const std::vector<double> &x, const std::vector<double> &y, int degree)
{
   const auto count = static_cast<Index>(x.size());
   Eigen::MatrixXd V(count, degree + 1);
   for (Index k = 0; k < count; ++k)
   {
      for (int d = 0; d <= degree; ++d) { V(k, d) = std::pow(x[k], d); }
   }
   return least_squares(V, Eigen::Map<const VectorXd>(y.data(), count));
}

/// Zero of c0 + c1 x + c2 x² nearest to x = 0; NaN if there is none.
double zero(const VectorXd &c)
{
   const double a = c.size() > 2 ? c[2] : 0.0;
   const double discriminant = c[1] * c[1] - 4 * a * c[0];
   if (discriminant < 0 || c[1] == 0) { return std::numeric_limits<double>::quiet_NaN(); }
   return -2 * c[0] / (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
}

/// Where to look for an edge: between two neighbouring nodes, of which one lies in the zone
/// whose values vanish at the edge; `last` is the far end of that zone.
struct Bracket
{
   const VectorXd &s;
   Index inside, outside, last;

   Index step() const { return inside < outside ? -1 : 1; }
   Index nodes() const { return std::abs(last - inside) + 1; }
   double spacing() const { return std::abs(s[outside] - s[inside]); }
   Edge middle() const { return {0.5 * (s[inside] + s[outside]), 0.5 * spacing()}; }

   /// Zero of a polynomial through the nodes from..to-1 of the zone (0: `inside`), in spacings
   /// from `inside` toward the zone; NaN if there are not that many.
   double extrapolate(const VectorXd &value, Index from, Index to, int degree) const
   {
      if (nodes() < to) { return std::numeric_limits<double>::quiet_NaN(); }
      std::vector<double> x, y;
      for (Index k = from; k < to; ++k)
      {
         const Index node = inside + step() * k;
         x.push_back(std::abs(s[node] - s[inside]) / spacing());
         y.push_back(value[node]);
      }
      return zero(fit(x, y, degree));
   }

   /// The edge at `best` if that is between the two nodes or near; `other` tells how sure it
   /// is.
   bool accept(double best, double other, Edge &edge) const
   {
      if (!(best > -1.3 && best < 0.3)) { return false; }
      const double doubt = std::isfinite(other) ? std::abs(best - other) : 0.5;
      edge = {s[inside] + step() * best * spacing(), std::clamp(doubt, 0.02, 0.5) * spacing()};
      return true;
   }
};

const Edge &surer(const Edge &a, const Edge &b)
{
   return b.error < a.error ? b : a;
}

/// End of contact from inside: squared pressure. The last two nodes carry parts of elements
/// that are not wholly in contact and are left out where there are enough others.
Edge separation_edge(const Bracket &bracket, const VectorXd &pressure2)
{
   Edge edge = bracket.middle();
   const Index count = std::min<Index>(10, bracket.nodes());
   if (count >= 7)
   {
      bracket.accept(bracket.extrapolate(pressure2, 2, count, 2),
                     bracket.extrapolate(pressure2, 1, count - 2, 2), edge);
   }
   else if (count >= 3)
   {
      bracket.accept(bracket.extrapolate(pressure2, 0, 3, 1),
                     bracket.extrapolate(pressure2, 0, 2, 1), edge);
   }
   return edge;
}

/// An edge from the side where a displacement vanishes at it: (displacement)^(2/3), a parabola
/// through five nodes behind the first one. Much smoother than nodal forces, but more nodes
/// would reach into whatever ends the zone on its other side.
bool displacement_edge(const Bracket &bracket, const VectorXd &displacement23, Edge &edge)
{
   return bracket.accept(bracket.extrapolate(displacement23, 1, 6, 2),
                         bracket.extrapolate(displacement23, 1, 5, 2), edge);
}

/// Slip front from the slipping side: a straight line where there are only few nodes.
bool slip_front(const Bracket &bracket, const VectorXd &way, Edge &edge)
{
   if (displacement_edge(bracket, way, edge)) { return true; }
   const Index first = bracket.nodes() >= 4 ? 1 : 0;
   const double best = bracket.extrapolate(way, first, first + 3, 1);
   const double other = bracket.extrapolate(way, 0, 3, 1);
   return bracket.accept(best, first ? other : bracket.extrapolate(way, 0, 2, 1), edge);
}

/// Edge of a stick zone from its own side: squared frictional reserve.
Edge stick_edge(const Bracket &bracket, const VectorXd &reserve2)
{
   Edge edge = bracket.middle();
   bracket.accept(bracket.extrapolate(reserve2, 0, 3, 1),
                  bracket.extrapolate(reserve2, 1, 4, 1), edge);
   return edge;
}

} // namespace

std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state)
{
   const Index n = problem.nodes();
   require(problem.arc_length.size() == n && problem.weights.size() == n,
           "zones: the reduced problem has no arc length or weights");
   const VectorXd &s = problem.arc_length;
   const VectorXd p = tractions(problem, state.p);
   const VectorXd q = tractions(problem, lengths(state.q, n));
   const VectorXd pressure2 = p.cwiseAbs2();
   VectorXd reserve2(n), opening(n), way = lengths(state.v - state.slip_origin, n);
   for (Index i = 0; i < n; ++i)
   {
      const double reserve = std::max(problem.friction[i] * p[i] - q[i], 0.0);
      reserve2[i] = reserve * reserve;
      opening[i] = std::pow(std::max(state.w[i] + problem.gap[i], 0.0), 2.0 / 3);
      way[i] = std::pow(way[i], 2.0 / 3);
   }
   std::vector<Zone> result;
   for (Index i = 0; i < n; ++i)
   {
      if (i == 0 || state.status[i] != state.status[i - 1])
      {
         result.push_back({state.status[i], {s[i], 0}, {s[i], 0}, i, i});
      }
      result.back().last = i;
      result.back().to = {s[i], 0};
   }
   // Runs of closed nodes, for the pressure at their ends.
   auto end_of_contact = [&](Index i, Index step)
   {
      while (i + step >= 0 && i + step < n && closed(state.status[i + step])) { i += step; }
      return i;
   };
   // Node i is closed, j is open; the far ends of both.
   auto contact_edge = [&](Index i, Index j, Index closed_end, Index open_end)
   {
      const Edge inside = separation_edge({s, i, j, closed_end}, pressure2);
      Edge outside;
      return displacement_edge({s, j, i, open_end}, opening, outside) ? surer(inside, outside)
                                                                      : inside;
   };
   // Node i sticks, j slips; the far ends of both zones. Where the front retreats, slip does
   // not vanish at it and its extrapolation is in doubt.
   auto slip_edge = [&](Index i, Index j, Index stick_end, Index slip_end)
   {
      const Edge inside = stick_edge({s, i, j, stick_end}, reserve2);
      Edge outside;
      return slip_front({s, j, i, slip_end}, way, outside) ? surer(outside, inside) : inside;
   };
   for (std::size_t k = 0; k + 1 < result.size(); ++k)
   {
      Zone &left = result[k], &right = result[k + 1];
      const Index i = left.last, j = right.first;
      Edge edge;
      if (!closed(left.state)) { edge = contact_edge(j, i, end_of_contact(j, 1), left.first); }
      else if (!closed(right.state))
      {
         edge = contact_edge(i, j, end_of_contact(i, -1), right.last);
      }
      else if (left.state == NodeState::stick)
      {
         edge = slip_edge(i, j, left.first, right.last);
      }
      else if (right.state == NodeState::stick)
      {
         edge = slip_edge(j, i, right.last, left.first);
      }
      else
      {
         // Opposite slip on both sides: shear changes sign.
         const double total = q[i] + q[j];
         const double fraction = total > 0 ? q[i] / total : 0.5;
         edge = {s[i] + fraction * (s[j] - s[i]), 0.5 * (s[j] - s[i])};
      }
      left.to = right.from = edge;
   }
   // A zone of a node or two may come out inside out: its nodes are all that is known of it.
   for (std::size_t k = 0; k < result.size(); ++k)
   {
      Zone &zone = result[k];
      if (zone.from.position <= zone.to.position) { continue; }
      if (k > 0)
      {
         const Index i = zone.first;
         zone.from = result[k - 1].to = {0.5 * (s[i - 1] + s[i]), 0.5 * (s[i] - s[i - 1])};
      }
      if (k + 1 < result.size())
      {
         const Index i = zone.last;
         zone.to = result[k + 1].from = {0.5 * (s[i] + s[i + 1]), 0.5 * (s[i + 1] - s[i])};
      }
   }
   return result;
}

Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which)
{
   Zone widest{which, {}, {}, 0, -1};
   for (const Zone &zone : zones(problem, state))
   {
      const bool wider =
         widest.first > widest.last ||
         zone.to.position - zone.from.position > widest.to.position - widest.from.position;
      if (zone.state == which && wider) { widest = zone; }
   }
   return widest;
}

Zone contact_zone(const ReducedProblem &problem, const ContactState &state)
{
   Zone contact{NodeState::stick, {}, {}, 0, -1};
   for (const Zone &zone : zones(problem, state))
   {
      if (!closed(zone.state)) { continue; }
      if (contact.first > contact.last)
      {
         contact.first = zone.first;
         contact.from = zone.from;
      }
      contact.last = zone.last;
      contact.to = zone.to;
   }
   return contact;
}

} // namespace cattaneo
