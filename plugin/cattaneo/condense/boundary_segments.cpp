#include <algorithm>
#include <cattaneo/condense/boundary_segments.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace cattaneo
{

namespace
{

const double degree = std::acos(-1.0) / 180;

/// How the boundary continues from a node at which the line ends in the direction `out`. `bend`
/// is the angle between the line's last two elements.
LineEnd goes_on(const std::vector<WayOn> &ways, int node, const Eigen::Vector2d &out,
                double bend)
{
   double straightest = -2; // it is not known how the boundary continues
   for (const WayOn &way : ways)
   {
      if (way.node == node)
      {
         straightest = std::max(straightest, way.x * out[0] + way.y * out[1]);
      }
   }
   if (straightest < -1.5) { return LineEnd::unknown; }
   const double turn =
      std::clamp(1.5 * bend, LineChain::smooth_turn * degree, LineChain::corner_turn * degree);
   return straightest >= std::cos(turn) ? LineEnd::smooth : LineEnd::corner;
}

/// Refuses elements that coincide without being joined: their nodes would share the load, and
/// each would have two partners.
void check_joined(const ContactLine &line, const std::string &where)
{
   // Sorted along a direction that no mesh prefers, so that few nodes are near each other.
   std::vector<std::pair<double, const LineNode *>> along;
   double farthest = 0;
   const double near = 1e-6;
   for (const LineNode &node : line.nodes)
   {
      along.emplace_back(node.position.dot(Eigen::Vector2d(0.8191, 0.5736)), &node);
      farthest = std::max(farthest, near * node.spacing);
   }
   std::sort(along.begin(), along.end());
   for (auto one = along.begin(); one != along.end(); ++one)
   {
      const LineNode &node = *one->second;
      for (auto other = one + 1; other != along.end() && other->first - one->first <= farthest;
           ++other)
      {
         require((node.position - other->second->position).norm() >
                    near * std::min(node.spacing, other->second->spacing),
                 where, ": two nodes coincide at ", node.position,
                 ", but their elements are not joined. If two faces touch there, name each "
                 "face by itself and make a contact line of each; if the body is one piece, "
                 "merge the nodes (in Gmsh: Coherence Mesh)");
      }
   }
}

/// Links each segment to the one that starts at its end. The beginnings of chains do not depend
/// on the numbering of the mesh: open chains begin at their start, loops at the lowest (x, y),
/// and chains are in the order of these points.
std::vector<std::vector<const Segment *>> chained(const std::vector<Segment> &segments,
                                                  const std::string &where)
{
   std::map<int, const Segment *> starting;
   std::set<int> ending;
   for (const Segment &s : segments)
   {
      for (const SegmentNode *end : {&s.front(), &s.back()})
      {
         require(end == &s.front() ? starting.emplace(end->id, &s).second
                                   : ending.insert(end->id).second,
                 where, ": more than two boundary elements meet at ", end->node.position,
                 ", or one is listed twice; at most two may meet at a node");
      }
   }
   std::set<const Segment *> used;
   std::vector<std::vector<const Segment *>> chains;
   const auto follow = [&](const Segment *from)
   {
      chains.emplace_back();
      while (from && used.insert(from).second)
      {
         chains.back().push_back(from);
         const auto next = starting.find(from->back().id);
         from = next == starting.end() ? nullptr : next->second;
      }
   };
   const auto before = [](const Segment *a, const Segment *b)
   {
      const Eigen::Vector2d &i = a->front().node.position, &j = b->front().node.position;
      return std::make_pair(i[0], i[1]) < std::make_pair(j[0], j[1]);
   };
   for (const Segment &s : segments)
   {
      if (!ending.count(s.front().id)) { follow(&s); }
   }
   for (const Segment &s : segments)
   {
      if (used.count(&s)) { continue; }
      follow(&s);
      std::vector<const Segment *> &loop = chains.back();
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), before), loop.end());
   }
   std::sort(chains.begin(), chains.end(),
             [&](const auto &a, const auto &b) { return before(a.front(), b.front()); });
   return chains;
}

/// How the boundary goes on at both ends of a chain.
std::array<LineEnd, 2> ends_of(const std::vector<const Segment *> &chain, bool loop,
                               const std::vector<WayOn> &ways)
{
   if (loop) { return {LineEnd::smooth, LineEnd::smooth}; }
   const auto bend = [&](std::size_t a)
   {
      return a + 1 < chain.size() // without a next element: no bend
                ? std::acos(std::clamp(
                     chain[a]->back().node.tangent.dot(chain[a + 1]->front().node.tangent),
                     -1.0, 1.0))
                : 0.0;
   };
   const auto end_at = [&](const SegmentNode &end, const Eigen::Vector2d &out, double turn)
   { return end.on_axis ? LineEnd::symmetry : goes_on(ways, end.id, out, turn); };
   const SegmentNode &first = chain.front()->front(), &last = chain.back()->back();
   return {end_at(first, -first.node.tangent, bend(0)),
           end_at(last, last.node.tangent, bend(std::max<std::size_t>(chain.size(), 2) - 2))};
}

/// All nodes of a chain, with the sums of their elements' contributions, and its elements.
struct JoinedSegments
{
   std::vector<SegmentNode> nodes;
   std::vector<LineElement> elements; ///< of nodes of the chain
};

/// `start` is the arc length at the beginning; afterwards it is that of the next chain.
JoinedSegments join(const std::vector<const Segment *> &chain, double &start)
{
   JoinedSegments result;
   std::vector<SegmentNode> &nodes = result.nodes;
   const int first = chain.front()->front().id;
   for (const Segment *segment : chain)
   {
      LineElement element;
      element.points.resize(2, static_cast<Eigen::Index>(segment->size()));
      for (std::size_t a = 0; a < segment->size(); ++a)
      {
         const SegmentNode &part_of = (*segment)[a];
         std::size_t at = nodes.size();
         if (a == 0 && segment != chain.front()) { --at; }
         else if (part_of.id == first && !nodes.empty()) { at = 0; }
         else
         {
            nodes.push_back({part_of.id, part_of.node, 0.0, part_of.on_axis});
            LineNode &added = nodes.back().node;
            added.tangent.setZero();
            added.weight = 0;
            added.arc_length += start;
            added.spacing = std::numeric_limits<double>::infinity();
         }
         LineNode &node = nodes[at].node;
         node.weight += part_of.node.weight;
         node.tangent += part_of.share * part_of.node.tangent;
         nodes[at].share += part_of.share;
         if (a > 0)
         {
            const double step = part_of.node.arc_length - (*segment)[a - 1].node.arc_length;
            LineNode &previous = nodes[element.nodes.back()].node;
            previous.spacing = std::min(previous.spacing, step);
            node.spacing = std::min(node.spacing, step);
         }
         element.nodes.push_back(static_cast<Eigen::Index>(at));
         element.points.col(static_cast<Eigen::Index>(a)) = node.position;
      }
      start += segment->back().node.arc_length;
      result.elements.push_back(element);
   }
   return result;
}

/// Nodes on the axis are left out of the line, and their weight goes to a neighbour.
void give_weights_of_axis(std::vector<SegmentNode> &nodes, const std::string &where)
{
   std::size_t next = nodes.size();
   for (std::size_t i = nodes.size(); i-- > 0;)
   {
      if (!nodes[i].on_axis)
      {
         next = i;
         continue;
      }
      require(next < nodes.size() || i > 0, where, ": the node at ", nodes[i].node.position,
              " is the only one, and lies on the axis; a contact line needs more nodes");
      nodes[next < nodes.size() ? next : i - 1].node.weight += nodes[i].node.weight;
   }
}

/// Direction in which the boundary goes on from an end of a chain; zero if it is not known.
Eigen::Vector2d way_on(const std::vector<WayOn> &ways, const SegmentNode &end,
                       const Eigen::Vector2d &out)
{
   if (end.on_axis) { return {0, 1}; }
   Eigen::Vector2d found(0, 0);
   for (const WayOn &way : ways)
   {
      const Eigen::Vector2d leaves(way.x, way.y);
      if (way.node == end.id && (found.isZero(0) || leaves.dot(out) > found.dot(out)))
      {
         found = leaves;
      }
   }
   return found;
}

/// Largest distance of inner nodes of an element from its chord, in lengths of the chord.
double off_chord(const LineElement &element)
{
   double off = 0;
   for (Eigen::Index a = 1; a < element.order(); ++a)
   {
      off = std::max(off, std::abs(element.off_chord(a)));
   }
   return off;
}

/// Gives straight elements the smooth curve on which their ends lie. If other elements of the
/// chain are curved, the mesh has curved elements where its curves are, so its straight
/// elements are meant to be straight.
void find_bends(JoinedSegments &joined, const std::vector<const Segment *> &chain, bool loop,
                const std::vector<WayOn> &ways)
{
   SidePolygon side;
   side.loop = loop;
   for (const LineElement &element : joined.elements)
   {
      side.vertices.emplace_back(element.points.leftCols(1));
   }
   if (!loop)
   {
      side.vertices.emplace_back(joined.elements.back().points.rightCols(1));
      const SegmentNode &first = chain.front()->front(), &last = chain.back()->back();
      side.beyond = {way_on(ways, first, -first.node.tangent),
                     way_on(ways, last, last.node.tangent)};
   }
   const std::vector<EdgeBend> bends = smooth_curve(side), possible = possible_curve(side);
   // Inner nodes of a file with few digits are off the chord as well.
   std::vector<bool> curved;
   for (std::size_t e = 0; e < bends.size(); ++e)
   {
      curved.push_back(off_chord(joined.elements[e]) >
                       std::max(1e-4, 0.1 * std::abs(bends[e].off(0.5))));
   }
   const bool knows = std::count(curved.begin(), curved.end(), true) > 0;
   for (std::size_t e = 0; e < bends.size(); ++e)
   {
      if (curved[e]) { continue; }
      joined.elements[e].bend = knows ? EdgeBend() : bends[e];
      if (!knows) { joined.elements[e].possible = possible[e]; }
   }
}

/// Appends a chain to the line.
void append(JoinedSegments joined, LineChain chain, ContactLine &line, const std::string &where)
{
   give_weights_of_axis(joined.nodes, where);
   chain.first = line.size();
   std::vector<Eigen::Index> number; // in the line
   for (SegmentNode &each : joined.nodes)
   {
      number.push_back(each.on_axis ? -1 : line.size());
      if (each.on_axis) { continue; }
      LineNode &node = each.node;
      const double size = std::hypot(node.tangent[0], node.tangent[1]);
      // Exactly opposite tangents cancel to round-off.
      require(size > 1e-9 * each.share, where, ": the line turns back on itself at ",
              node.position);
      node.tangent /= size;
      line.nodes.push_back(node);
   }
   chain.nodes = line.size() - chain.first;
   chain.elements = std::move(joined.elements);
   for (LineElement &element : chain.elements)
   {
      for (Eigen::Index &node : element.nodes) { node = number[node]; }
   }
   line.chains.push_back(std::move(chain));
}

} // namespace

ContactLine line_of(const std::vector<Segment> &segments, const std::vector<WayOn> &ways,
                    Formulation formulation, const std::string &where)
{
   ContactLine line;
   line.formulation = formulation;
   double start = 0.0;
   for (const std::vector<const Segment *> &chain : chained(segments, where))
   {
      LineChain described;
      described.loop = chain.front()->front().id == chain.back()->back().id;
      described.ends = ends_of(chain, described.loop, ways);
      JoinedSegments all = join(chain, start);
      find_bends(all, chain, described.loop, ways);
      append(std::move(all), described, line, where);
   }
   line.validate();
   check_joined(line, where);
   return line;
}

} // namespace cattaneo
