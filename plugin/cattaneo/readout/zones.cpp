#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

VectorXd tractions(const ReducedProblem &problem, const VectorXd &nodal_forces)
{
   const Index n = problem.weights.size(), slips = problem.slips(), count = nodal_forces.size();
   const bool two = slips == 2 * n && n > 0;
   require(count == n || (two && count == slips), "tractions: nodal_forces has ", count,
           " entries, must have ", n, two ? " or " + std::to_string(slips) : "");
   if (n == 0) { return VectorXd(); } // all interfaces are tied
   const VectorXd weights = problem.weights.replicate(count / n, 1);
   return (weights.array() > 0)
      .select(nodal_forces.cwiseQuotient(weights), VectorXd::Zero(count));
}

namespace
{

/// Where c0 + c1 x + c2 x² changes sign nearest to x = 0; NaN if it does not.
double zero(const VectorXd &c)
{
   const double a = c.size() > 2 ? c[2] : 0.0;
   const double discriminant = c[1] * c[1] - 4 * a * c[0];
   if (!(discriminant > 0)) { return std::numeric_limits<double>::quiet_NaN(); }
   return -2 * c[0] / (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
}

/// Least errors of edges, in spacings.
const double by_parabola = 0.25, by_line = 0.5;

/// Where to look for an edge: between two neighbouring nodes, of which one lies in the zone
/// whose values vanish at the edge; `last` is the far end of that zone.
struct Bracket
{
   const VectorXd &s;
   Index inside, outside, last;

   Index step() const { return inside < outside ? -1 : 1; }
   Index nodes() const { return std::abs(last - inside) + 1; }
   double spacing() const { return std::abs(s[outside] - s[inside]); }
   ZoneBorder middle() const { return {0.5 * (s[inside] + s[outside]), spacing()}; }

   /// Zero of a polynomial through the nodes from..to-1 of the zone (0: `inside`), in spacings
   /// from `inside` toward the zone; NaN if there are not that many.
   double extrapolate(const VectorXd &value, Index from, Index to, int degree) const
   {
      if (nodes() < to) { return std::numeric_limits<double>::quiet_NaN(); }
      VectorXd x(to - from), y(to - from);
      for (Index k = from; k < to; ++k)
      {
         const Index node = inside + step() * k;
         x[k - from] = std::abs(s[node] - s[inside]) / spacing();
         y[k - from] = value[node];
      }
      return zero(least_squares(powers(x, degree), y));
   }

   /// The edge at `best` if that is between the two nodes or near. Its error is the difference
   /// from `other`, at least `least`, in spacings.
   bool accept(double best, double other, double least, ZoneBorder &edge) const
   {
      if (!(best > -1.3 && best < 0.3)) { return false; }
      const double doubt = std::isfinite(other) ? std::abs(best - other) : 1.0;
      edge = {s[inside] + step() * best * spacing(), std::clamp(doubt, least, 1.0) * spacing()};
      return true;
   }
};

const ZoneBorder &surer(const ZoneBorder &a, const ZoneBorder &b)
{
   return b.error < a.error ? b : a;
}

/// End of contact from inside: squared pressure. The last two nodes carry parts of elements
/// that are not wholly in contact and are left out where there are enough others.
ZoneBorder separation_edge(const Bracket &bracket, const VectorXd &pressure2)
{
   ZoneBorder edge = bracket.middle();
   const Index count = std::min<Index>(10, bracket.nodes());
   if (count >= 7)
   {
      bracket.accept(bracket.extrapolate(pressure2, 2, count, 2),
                     bracket.extrapolate(pressure2, 1, count - 2, 2), by_line, edge);
   }
   else if (count >= 3)
   {
      bracket.accept(bracket.extrapolate(pressure2, 0, 3, 1),
                     bracket.extrapolate(pressure2, 0, 2, 1), by_line, edge);
   }
   return edge;
}

/// Finds an edge from the side where a displacement goes to zero at the edge.
/// (displacement)^(2/3) is extrapolated by a parabola through five nodes behind the first one.
/// It is much smoother than nodal forces. More nodes would reach too near to the other end of
/// the zone.
bool displacement_edge(const Bracket &bracket, const VectorXd &displacement23, ZoneBorder &edge)
{
   return bracket.accept(bracket.extrapolate(displacement23, 1, 6, 2),
                         bracket.extrapolate(displacement23, 1, 5, 2), by_parabola, edge);
}

/// Slip front from the slipping side. With few nodes a straight line is used. With two it is
/// the line through them, whose error is not known.
bool slip_front(const Bracket &bracket, const VectorXd &way, ZoneBorder &edge)
{
   if (displacement_edge(bracket, way, edge)) { return true; }
   const Index first = bracket.nodes() >= 4 ? 1 : 0;
   const double best = bracket.extrapolate(way, first, first + 3, 1);
   const double last_two = bracket.extrapolate(way, 0, 2, 1);
   const double other = first ? bracket.extrapolate(way, 0, 3, 1) : last_two;
   return bracket.accept(best, other, by_line, edge) ||
          bracket.accept(last_two, std::numeric_limits<double>::quiet_NaN(), 1.0, edge);
}

/// Edge of a stick zone from the side of the sticking nodes, by the squared frictional reserve.
/// Nodes that stick on the limit have no reserve, so they do not show where slip ends.
ZoneBorder stick_edge(const Bracket &bracket, const VectorXd &reserve2)
{
   ZoneBorder edge = bracket.middle();
   for (Index k = 0; k < 4 && k < bracket.nodes(); ++k)
   {
      if (reserve2[bracket.inside + bracket.step() * k] == 0) { return edge; }
   }
   bracket.accept(bracket.extrapolate(reserve2, 0, 3, 1),
                  bracket.extrapolate(reserve2, 1, 4, 1), by_line, edge);
   return edge;
}

/// Data from which edges are extrapolated, one entry for each node.
struct Profiles
{
   std::vector<NodeState> states;
   VectorXd pressure2, reserve2, opening, way; ///< the last two to the power 2/3
   std::vector<bool> usable;                   ///< may the slip path of a node be used?
};

void check_line(const ReducedProblem &problem)
{
   const Index n = problem.nodes();
   require(problem.arc_length.size() == n && problem.weights.size() == n,
           "zones: the reduced problem has no arc length or weights");
   require(
      !problem.chains.empty(),
      "zones: the reduced problem has no chains, which say which nodes follow each other: set "
      "them (one_chain() if it is one line)");
}

/// The data without reserve and slip path.
Profiles profiles(const ReducedProblem &problem, const ContactState &state)
{
   check_line(problem);
   const Index n = problem.nodes();
   Profiles result;
   result.states = settled_states(problem, state);
   result.pressure2 = tractions(problem, state.p).cwiseAbs2();
   result.opening = (state.w + problem.gap).cwiseMax(0.0).array().pow(2.0 / 3);
   result.reserve2 = result.way = VectorXd::Zero(n);
   result.usable.assign(n, true);
   return result;
}

std::vector<int> numbers_of(const std::vector<ContactChain> &chains, Index nodes)
{
   std::vector<int> number(nodes, 0);
   int k = 0;
   for (const ContactChain &chain : chains)
   {
      std::fill_n(number.begin() + chain.first, chain.nodes, k++);
   }
   return number;
}

/// Reads the zones of some states.
class Reader
{
public:
   Reader(const VectorXd &arc_length, const std::vector<ContactChain> &chains,
          const Profiles &at, const VectorXd &shear)
      : s_(arc_length), at_(at), shear_(shear), chain_(numbers_of(chains, arc_length.size())),
        chains_(chains)
   {
   }

   std::vector<Zone> zones();

private:
   ZoneBorder border(const Zone &left, const Zone &right) const;
   ZoneBorder contact_edge(Index in, Index out, Index open_end) const;
   ZoneBorder slip_edge(Index in, Index out, Index stick_end, Index slip_end) const;
   void untangle(std::vector<Zone> &all) const;
   double doubt_of_ends(Index i, Index j, double position) const;

   bool neighbours(Index i, Index j) const
   {
      return std::min(i, j) >= 0 && std::max(i, j) < s_.size() && chain_[i] == chain_[j];
   }

   const VectorXd &s_;
   const Profiles &at_;
   const VectorXd &shear_;
   const std::vector<int> chain_;
   const std::vector<ContactChain> &chains_;
};

/// Border between the closed node `in` and the open node `out`. `open_end` is the far end of
/// the open zone.
ZoneBorder Reader::contact_edge(Index in, Index out, Index open_end) const
{
   const Index step = out < in ? 1 : -1;
   Index closed_end = in; // of the whole run of closed nodes, for their pressure
   while (neighbours(closed_end, closed_end + step) && closed(at_.states[closed_end + step]))
   {
      closed_end += step;
   }
   const ZoneBorder inside = separation_edge({s_, in, out, closed_end}, at_.pressure2);
   ZoneBorder outside;
   // A body on one node may have any tilt, so its opening does not show the edge.
   const bool tells = closed_end != in;
   return tells && displacement_edge({s_, out, in, open_end}, at_.opening, outside)
             ? surer(outside, inside)
             : inside;
}

/// Border between the sticking node `in` and the slipping node `out`, with the far ends of both
/// zones. Where the front retreats, slip does not vanish at it, and its extrapolation is
/// doubtful.
ZoneBorder Reader::slip_edge(Index in, Index out, Index stick_end, Index slip_end) const
{
   const ZoneBorder inside = stick_edge({s_, in, out, stick_end}, at_.reserve2);
   ZoneBorder outside;
   if (!at_.usable[out]) { return inside; }
   const Index step = out < in ? -1 : 1;
   Index last = out;
   while (last != slip_end && at_.usable[last + step]) { last += step; }
   return slip_front({s_, out, in, last}, at_.way, outside) ? surer(outside, inside) : inside;
}

ZoneBorder Reader::border(const Zone &left, const Zone &right) const
{
   const Index i = left.last, j = right.first;
   if (!closed(left.state)) { return contact_edge(j, i, left.first); }
   if (!closed(right.state)) { return contact_edge(i, j, right.last); }
   if (left.state == NodeState::stick) { return slip_edge(i, j, left.first, right.last); }
   if (right.state == NodeState::stick) { return slip_edge(j, i, right.last, left.first); }
   // Opposite slip on both sides: shear changes sign.
   const double total = shear_[i] + shear_[j];
   const double fraction = total > 0 ? shear_[i] / total : 0.5;
   return {s_[i] + fraction * (s_[j] - s_[i]), s_[j] - s_[i]};
}

/// The computed borders of a zone of one or two nodes may be in the wrong order. Then only its
/// nodes are known.
void Reader::untangle(std::vector<Zone> &all) const
{
   for (std::size_t k = 0; k < all.size(); ++k)
   {
      Zone &zone = all[k];
      if (zone.from.position <= zone.to.position) { continue; }
      const Index i = zone.first, j = zone.last;
      if (neighbours(i - 1, i))
      {
         zone.from = all[k - 1].to = {0.5 * (s_[i - 1] + s_[i]), s_[i] - s_[i - 1]};
      }
      if (neighbours(j, j + 1))
      {
         zone.to = all[k + 1].from = {0.5 * (s_[j] + s_[j + 1]), s_[j + 1] - s_[j]};
      }
   }
}

/// Error of a border near a corner that is in contact. Tractions there are singular, and wrong
/// over the first few nodes, so that a border four nodes from the corner may lie at it. The
/// error falls with the number of nodes between. 16 spacings over that number is a rule. It
/// covers the differences of borders between uniform meshes of 12 to 80 elements and finer
/// ones. The border lies between nodes i and j.
double Reader::doubt_of_ends(Index i, Index j, double position) const
{
   double most = 0;
   const auto look = [&](Index node, Index step)
   {
      double count = 0.5;
      while (neighbours(node, node + step) && closed(at_.states[node + step]))
      {
         node += step;
         ++count;
      }
      if (neighbours(node, node + step)) { return; } // contact ends within the line
      const ContactChain &chain = chains_[chain_[node]];
      const std::size_t end = step < 0 ? 0 : 1;
      if (chain.loop ||
          (chain.ends[end] != LineEnd::corner && chain.other_ends[end] != LineEnd::corner))
      {
         return;
      }
      most =
         std::max(most, std::min(16 / count * (s_[j] - s_[i]), std::abs(position - s_[node])));
   };
   look(i, -1);
   look(j, 1);
   return most;
}

std::vector<Zone> Reader::zones()
{
   std::vector<Zone> result;
   for (Index i = 0; i < s_.size(); ++i)
   {
      const NodeState state = at_.states[i];
      if (!neighbours(i - 1, i) || state != at_.states[i - 1])
      {
         result.push_back({state, {s_[i], 0}, {s_[i], 0}, i, i, chain_[i]});
      }
      result.back().last = i;
      result.back().to = {s_[i], 0};
   }
   for (std::size_t k = 0; k + 1 < result.size(); ++k)
   {
      if (result[k].chain != result[k + 1].chain) { continue; }
      result[k].to = result[k + 1].from = border(result[k], result[k + 1]);
   }
   untangle(result);
   for (std::size_t k = 0; k + 1 < result.size(); ++k)
   {
      Zone &left = result[k], &right = result[k + 1];
      if (left.chain != right.chain || !closed(left.state) || !closed(right.state))
      {
         continue;
      }
      const double doubt = doubt_of_ends(left.last, right.first, left.to.position);
      left.to.error = right.from.error = std::max(left.to.error, doubt);
   }
   return result;
}

/// Borders of the zones `first` to `last` - 1 of a closed line. Each is read with as many nodes
/// on either side, wherever the line begins.
void read_loop(const ReducedProblem &problem, const Profiles &at, const VectorXd &shear,
               const ContactChain &loop, Zone *first, Zone *last)
{
   const Index n = loop.nodes, end = loop.first + n - 1;
   const VectorXd &s = problem.arc_length;
   const bool placed = problem.position.rows() == s.size();
   const double closing =
      placed ? (problem.position.row(loop.first) - problem.position.row(end)).norm()
             : s[end] - s[end - 1];
   const double round = s[end] + closing - s[loop.first];
   last[-1].to = {s[loop.first] + round, 0};
   // Put the line twice, one after the other, and read the borders in the middle.
   std::vector<Index> node(2 * n);
   Profiles twice;
   for (Index k = 0; k < 2 * n; ++k)
   {
      node[k] = loop.first + k % n;
      twice.states.push_back(at.states[node[k]]);
      twice.usable.push_back(at.usable[node[k]]);
   }
   twice.pressure2 = at.pressure2(node);
   twice.reserve2 = at.reserve2(node);
   twice.opening = at.opening(node);
   twice.way = at.way(node);
   VectorXd arc = s(node);
   arc.tail(n).array() += round;
   ContactChain chain = loop;
   chain.first = 0;
   chain.nodes = 2 * n;
   const VectorXd shears = shear(node);
   for (const Zone &zone : Reader(arc, {chain}, twice, shears).zones())
   {
      if (zone.last < n / 2 || zone.last >= n / 2 + n) { continue; }
      ZoneBorder border = zone.to;
      if (zone.last >= n) { border.position -= round; }
      const Index left = loop.first + zone.last % n;
      Zone *its = std::find_if(first, last, [&](const Zone &one) { return one.last == left; });
      its->to = border;
      if (its + 1 < last) { its[1].from = border; }
      else { first->from = {border.position - round, border.error}; }
   }
}

std::vector<Zone> read_zones(const ReducedProblem &problem, const Profiles &at,
                             const VectorXd &shear)
{
   std::vector<Zone> result = Reader(problem.arc_length, problem.chains, at, shear).zones();
   Zone *first = result.data(), *const end = first + result.size();
   for (const ContactChain &chain : problem.chains)
   {
      Zone *last = first;
      while (last < end && last->chain == first->chain) { ++last; }
      if (chain.loop && chain.nodes > 2) { read_loop(problem, at, shear, chain, first, last); }
      first = last;
   }
   return result;
}

double width(const Zone &zone)
{
   return zone.to.position - zone.from.position;
}

} // namespace

std::vector<int> chain_numbers(const ReducedProblem &problem)
{
   return numbers_of(problem.chains, problem.nodes());
}

std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state)
{
   Profiles at = profiles(problem, state);
   const Index n = problem.nodes();
   const VectorXd q = tractions(problem, tangential_lengths(state.q, n));
   at.way = tangential_lengths(state.v - state.slip_origin, n).array().pow(2.0 / 3);
   VectorXd limits(n);
   for (Index i = 0; i < n; ++i)
   {
      const bool back = problem.components() == 1 && state.q[i] > 0;
      limits[i] = friction_bound(problem, i).at(state.p[i], back ? -1 : 1);
   }
   limits = tractions(problem, limits);
   for (Index i = 0; i < n; ++i)
   {
      // Within round-off of the limit there is no reserve.
      const double limit = limits[i], reserve = limit - q[i];
      if (reserve > 1e-8 * limit) { at.reserve2[i] = reserve * reserve; }
   }
   return read_zones(problem, at, q);
}

std::vector<Zone> zones(const ReducedProblem &problem, const ContactState &state,
                        const SlipRange &slip)
{
   Profiles at = profiles(problem, state);
   const Index n = problem.nodes();
   const VectorXd range = slip.range(), least = least_slip(problem, state);
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(at.states[i])) { continue; }
      at.states[i] = range[i] > least[i] ? NodeState::slip : NodeState::stick;
   }
   at.way = range.array().pow(2.0 / 3);
   at.usable = slip.always_closed();
   return read_zones(problem, at, VectorXd::Zero(n));
}

Zone widest_zone(const std::vector<Zone> &zones, NodeState which)
{
   Zone widest{which, {}, {}, 0, -1};
   for (const Zone &zone : zones)
   {
      const bool wider = widest.first > widest.last || width(zone) > width(widest);
      if (zone.state == which && wider) { widest = zone; }
   }
   return widest;
}

Zone stick_zone(const ReducedProblem &problem, const std::vector<Zone> &zones)
{
   Zone stick = widest_zone(zones, NodeState::stick);
   if (stick.first > stick.last) { return stick; }
   const VectorXd &s = problem.arc_length;
   const std::vector<int> chain = chain_numbers(problem);
   const auto on_chain = [&](Index node)
   { return node >= 0 && node < s.size() && chain[node] == stick.chain; };
   const auto slips_at = [&](Index node)
   {
      return std::any_of(zones.begin(), zones.end(),
                         [&](const Zone &zone) {
                            return slips(zone.state) && zone.first <= node && node <= zone.last;
                         });
   };
   const auto doubt = [&](Index end, Index step, ZoneBorder &edge)
   {
      if (on_chain(end + step) && slips_at(end + step)) { return; }
      const Index next = on_chain(end + step) ? end + step : end - step;
      if (on_chain(next)) { edge.error = std::max(edge.error, std::abs(s[next] - s[end])); }
   };
   doubt(stick.first, -1, stick.from);
   doubt(stick.last, 1, stick.to);
   // Where slip changes its direction, a single node sticks even if the bodies have no stick
   // zone there.
   if (stick.first != stick.last) { return stick; }
   for (const Index step : {-1, 1})
   {
      ZoneBorder &edge = step < 0 ? stick.from : stick.to;
      const Index next = stick.first + step;
      if (!on_chain(next)) { continue; }
      edge.error = std::max(edge.error, std::abs(s[next] - s[stick.first]));
   }
   return stick;
}

Zone stick_zone(const ReducedProblem &problem, const ContactState &state)
{
   return stick_zone(problem, zones(problem, state));
}

std::vector<Zone> contact_zones(const std::vector<Zone> &zones)
{
   std::vector<Zone> result;
   const Zone *before = nullptr;
   for (const Zone &zone : zones)
   {
      if (closed(zone.state))
      {
         if (!before || !closed(before->state) || before->chain != zone.chain)
         {
            result.push_back(zone);
            result.back().state = NodeState::stick;
         }
         result.back().last = zone.last;
         result.back().to = zone.to;
      }
      before = &zone;
   }
   return result;
}

Zone contact_zone(const ReducedProblem &problem, const ContactState &state)
{
   return widest_zone(contact_zones(zones(problem, state)), NodeState::stick);
}

} // namespace cattaneo
