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

/// Least-squares polynomial c0 + c1 x + … through the first `count` points.
VectorXd fit(const std::vector<double> &x, const std::vector<double> &y, Index count,
             int degree)
{
   Eigen::MatrixXd V(count, degree + 1);
   VectorXd rhs(count);
   for (Index k = 0; k < count; ++k)
   {
      for (int d = 0; d <= degree; ++d) { V(k, d) = std::pow(x[k], d); }
      rhs[k] = y[k];
   }
   return V.householderQr().solve(rhs);
}

/// Zero of c0 + c1 x + c2 x² nearest to x = 0; NaN if there is none.
double zero(const VectorXd &c)
{
   const double a = c.size() > 2 ? c[2] : 0.0;
   const double discriminant = c[1] * c[1] - 4 * a * c[0];
   if (discriminant < 0 || c[1] == 0) { return std::numeric_limits<double>::quiet_NaN(); }
   return -2 * c[0] / (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
}

/** Edge between node `first` and its neighbour `beyond`, from values on the side of `first`
   that vanish at the edge like a distance. Values beyond `last` belong to another zone. The
   middle of the two nodes, with half their distance for its error, where nothing better is
   found. */
Edge extrapolate(const VectorXd &s, const VectorXd &value, Index first, Index beyond,
                 Index last)
{
   const double spacing = std::abs(s[beyond] - s[first]);
   const Edge middle{0.5 * (s[first] + s[beyond]), 0.5 * spacing};
   const Index step = first < beyond ? -1 : 1;
   // Distances into the zone, in units of the spacing. The node at the edge itself feels that
   // the edge of the discrete solution is a node, and is left out where there are enough
   // others.
   std::vector<double> x, y;
   const Index available = std::abs(last - first) + 1;
   for (Index k = available > 4 ? 1 : 0; k < std::min<Index>(available, 9); ++k)
   {
      const Index node = first + step * k;
      x.push_back(std::abs(s[node] - s[first]) / spacing);
      y.push_back(value[node]);
   }
   const auto count = static_cast<Index>(x.size());
   if (count < 3) { return middle; }
   const double straight = zero(fit(x, y, std::max<Index>(2, (count + 1) / 2), 1));
   const double curved = count >= 5 ? zero(fit(x, y, count, 2)) : straight;
   // Into the zone is positive x; the edge lies in [-1, 0] up to a spacing.
   const double best = std::isfinite(curved) ? curved : straight;
   if (!(best > -2 && best < 1)) { return middle; }
   const double doubt = std::isfinite(straight) ? std::abs(best - straight) : 0.5;
   return {s[first] + step * best * spacing, std::min(std::max(doubt, 0.02), 0.5) * spacing};
}

const Edge &surer(const Edge &a, const Edge &b)
{
   return b.error < a.error ? b : a;
}

} // namespace

std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state,
                        const VectorXd &slip_before)
{
   const Index n = problem.nodes();
   require(problem.components() <= 1, "zones: plane problems only, this one has ",
           problem.components(), " tangential components");
   require(problem.arc_length.size() == n && problem.weights.size() == n,
           "zones: the reduced problem has no arc length or weights");
   require(slip_before.size() == 0 || slip_before.size() == state.v.size(),
           "zones: ", slip_before.size(), " slips before, the state has ", state.v.size());
   const VectorXd &s = problem.arc_length;
   const VectorXd p = tractions(problem, state.p);
   const VectorXd q = state.q.size() ? tractions(problem, state.q) : VectorXd::Zero(n);
   const VectorXd pressure2 = p.cwiseAbs2();
   VectorXd reserve2(n), opening(n), slipped = VectorXd::Zero(n);
   for (Index i = 0; i < n; ++i)
   {
      const double reserve = std::max(problem.friction[i] * p[i] - std::abs(q[i]), 0.0);
      reserve2[i] = reserve * reserve;
      opening[i] = std::pow(std::max(state.w[i] + problem.gap[i], 0.0), 2.0 / 3.0);
      if (slip_before.size())
      {
         slipped[i] = std::pow(std::abs(state.v[i] - slip_before[i]), 2.0 / 3.0);
      }
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
   // Node i is closed or sticks, j is open or slips; both zones end where theirs do.
   auto contact_edge = [&](Index i, Index j, const Zone &open)
   {
      const Index far = j > i ? open.last : open.first;
      return surer(extrapolate(s, pressure2, i, j, end_of_contact(i, i - j)),
                   extrapolate(s, opening, j, i, far));
   };
   auto stick_edge = [&](Index i, Index j, const Zone &stick, const Zone &slip)
   {
      const Edge edge = extrapolate(s, reserve2, i, j, j > i ? stick.first : stick.last);
      // Where a slip front retreats, what sticks again has slipped too: nothing vanishes there.
      if (slipped[i] > 0) { return edge; }
      return surer(edge, extrapolate(s, slipped, j, i, j > i ? slip.last : slip.first));
   };
   for (std::size_t k = 0; k + 1 < result.size(); ++k)
   {
      Zone &left = result[k], &right = result[k + 1];
      const Index i = left.last, j = right.first;
      Edge edge;
      if (!closed(left.state)) { edge = contact_edge(j, i, left); }
      else if (!closed(right.state)) { edge = contact_edge(i, j, right); }
      else if (left.state == NodeState::stick) { edge = stick_edge(i, j, left, right); }
      else if (right.state == NodeState::stick) { edge = stick_edge(j, i, right, left); }
      else
      {
         // Opposite slip on both sides: shear changes sign.
         const double total = std::abs(q[i]) + std::abs(q[j]);
         const double fraction = total > 0 ? std::abs(q[i]) / total : 0.5;
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

Zone widest_zone(const ReducedProblem &problem, const ContactState &state, NodeState which,
                 const VectorXd &slip_before)
{
   Zone widest{which, {}, {}, 0, -1};
   for (const Zone &zone : zones(problem, state, slip_before))
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
