#include <algorithm>
#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace cattaneo
{

namespace
{

/// A number of a scalar node that all ranks share.
int number(const ElasticBody &body, int scalar_dof)
{
   return body.ranks().distributed() ? body.global_dof(scalar_dof, 0) : scalar_dof;
}

/// A node as one boundary element knows it. Of `node`, the weight and the tangent are those of
/// this element, and the arc length counts from its first node.
struct SegmentNode
{
   int id = 0; ///< the same on all ranks and in all elements
   LineNode node;
   double share = 0; ///< ∫φ ds
   bool on_axis = false;

   /// Calls visit(value&) for every number of it.
   template <class Visitor>
   void for_each(Visitor visit)
   {
      visit(id);
      for (int &dof : node.dofs) { visit(dof); }
      for (double &x : node.position) { visit(x); }
      for (double &t : node.tangent) { visit(t); }
      visit(node.weight);
      visit(node.arc_length);
      visit(share);
      visit(on_axis);
   }
};

/// The nodes of one boundary element, in the direction with the body on the left.
using Segment = std::vector<SegmentNode>;

double length(BoundaryEdge &edge, double from, double to)
{
   const mfem::IntegrationRule &rule = edge.rule(edge.degree());
   double sum = 0.0;
   for (int k = 0; k < rule.GetNPoints(); ++k)
   {
      const auto d = edge.derivative(from + (to - from) * rule.IntPoint(k).x);
      sum += rule.IntPoint(k).weight * std::hypot(d[0], d[1]);
   }
   return sum * (to - from);
}

Segment segment(const ElasticBody &body, int boundary_element, BoundaryEdge &edge)
{
   const mfem::FiniteElementSpace &space = body.space();
   const mfem::FiniteElement &element = *space.GetBE(boundary_element);
   mfem::Array<int> dofs;
   space.GetBdrElementDofs(boundary_element, dofs);
   const mfem::IntegrationRule &nodes = element.GetNodes();
   std::vector<int> order(dofs.Size());
   std::iota(order.begin(), order.end(), 0);
   const bool forward = edge.body_on_left();
   std::sort(order.begin(), order.end(),
             [&](int a, int b)
             { return forward ? nodes[a].x < nodes[b].x : nodes[a].x > nodes[b].x; });

   std::vector<double> weights(dofs.Size(), 0.0), shares(dofs.Size(), 0.0);
   mfem::Vector shape(dofs.Size());
   const mfem::IntegrationRule &rule = edge.rule(element.GetOrder());
   for (int k = 0; k < rule.GetNPoints(); ++k)
   {
      const mfem::IntegrationPoint &ip = rule.IntPoint(k);
      const auto d = edge.derivative(ip.x);
      element.CalcShape(ip, shape);
      for (int a = 0; a < dofs.Size(); ++a)
      {
         const double share = ip.weight * std::hypot(d[0], d[1]) * shape(a);
         shares[a] += share;
         weights[a] += share * measure(body.formulation(), edge.point(ip.x)[0]);
      }
   }
   const mfem::DenseMatrix &x = body.node_coordinates();
   Segment result;
   double distance = 0.0;
   for (std::size_t k = 0; k < order.size(); ++k)
   {
      const int a = order[k], dof = dofs[a];
      if (k > 0) { distance += std::abs(length(edge, nodes[order[k - 1]].x, nodes[a].x)); }
      const auto tangent = edge.tangent(nodes[a].x);
      const int second = body.components() == 2 ? body.global_dof(dof, 1) : -1;
      result.push_back({number(body, dof),
                        {{body.global_dof(dof, 0), second},
                         {x(0, dof), x(1, dof)},
                         {tangent[0], tangent[1]},
                         weights[a],
                         distance},
                        shares[a],
                        body.on_axis(dof)});
   }
   return result;
}

/// Every rank gets the segments of all.
void share(const Ranks &ranks, std::vector<Segment> &segments)
{
   if (!ranks.several()) { return; }
   std::vector<double> packed;
   for (Segment &segment : segments)
   {
      packed.push_back(static_cast<double>(segment.size()));
      for (SegmentNode &node : segment)
      {
         node.for_each([&](auto value) { packed.push_back(static_cast<double>(value)); });
      }
   }
   packed = ranks.gather(packed);
   segments.clear();
   for (auto value = packed.begin(); value != packed.end();)
   {
      segments.emplace_back(static_cast<std::size_t>(*value++));
      for (SegmentNode &node : segments.back())
      {
         node.for_each([&](auto &x) { x = static_cast<std::decay_t<decltype(x)>>(*value++); });
      }
   }
}

const double degree = std::acos(-1.0) / 180;

/// An outer edge of the body, seen from a node that it shares with the line. (One that is on
/// the line leaves it backwards there.)
struct WayOn
{
   int node;
   double x, y; ///< unit vector that leaves the node
};

/// Of all ranks, at the ends of the given segments.
std::vector<WayOn> ways_on(const ElasticBody &body, const std::vector<Segment> &segments)
{
   std::set<int> ends;
   for (const Segment &s : segments) { ends.insert({s.front().id, s.back().id}); }
   const mfem::FiniteElementSpace &space = body.space();
   mfem::Mesh &mesh = *space.GetMesh();
   mfem::Array<int> vertices, dofs;
   std::vector<double> packed;
   const auto node_of = [&](int vertex)
   {
      space.GetVertexDofs(vertex, dofs);
      return number(body, dofs[0]);
   };
   for (int face = 0; face < mesh.GetNumFaces(); ++face)
   {
      int element = 0, other = 0, info = 0, other_info = 0, hanging = 0;
      mesh.GetFaceElements(face, &element, &other);
      mesh.GetFaceInfos(face, &info, &other_info, &hanging);
      // A neighbour here, on another rank, or of another size.
      if (other >= 0 || other_info >= 0 || hanging >= 0) { continue; }
      mesh.GetElementVertices(element, vertices);
      const int *at = mesh.GetElement(element)->GetEdgeVertices(info / 64);
      const int nodes[] = {node_of(vertices[at[0]]), node_of(vertices[at[1]])};
      for (int k : {0, 1})
      {
         if (!ends.count(nodes[k])) { continue; }
         const mfem::IntegrationRule &corners =
            *mfem::Geometries.GetVertices(mesh.GetElementBaseGeometry(element));
         const mfem::IntegrationPoint &here = corners[at[k]], &there = corners[at[1 - k]];
         mfem::IsoparametricTransformation plane;
         mesh.GetElementTransformation(element, &plane);
         plane.SetIntPoint(&here);
         const mfem::DenseMatrix &J = plane.Jacobian();
         const double dx = there.x - here.x, dy = there.y - here.y;
         const double x = J(0, 0) * dx + J(0, 1) * dy, y = J(1, 0) * dx + J(1, 1) * dy;
         const double length = std::hypot(x, y);
         for (double value : {double(nodes[k]), x / length, y / length})
         {
            packed.push_back(value);
         }
      }
   }
   packed = body.ranks().gather(packed);
   std::vector<WayOn> ways;
   for (std::size_t k = 0; k < packed.size(); k += 3)
   {
      ways.push_back({static_cast<int>(packed[k]), packed[k + 1], packed[k + 2]});
   }
   return ways;
}

/// How the boundary goes on from a node at which the line ends in the direction `out`; `bend`:
/// angle between its last two elements.
LineEnd goes_on(const std::vector<WayOn> &ways, int node, const Eigen::Vector2d &out,
                double bend)
{
   double straightest = -1; // an outer edge ends nowhere: there is a way on
   for (const WayOn &way : ways)
   {
      if (way.node == node)
      {
         straightest = std::max(straightest, way.x * out[0] + way.y * out[1]);
      }
   }
   const double turn =
      std::clamp(1.5 * bend, LineChain::smooth_turn * degree, LineChain::corner_turn * degree);
   return straightest >= std::cos(turn) ? LineEnd::smooth : LineEnd::corner;
}

std::string coordinates(const LineNode &node)
{
   return "(" + std::to_string(node.position[0]) + ", " + std::to_string(node.position[1]) +
          ")";
}

/// Nodes of elements that lie on one another without being joined would bear side by side, and
/// have two partners each.
void check_joined(const ContactLine &line, const std::string &where)
{
   // In the order along a direction that no mesh has, few are near each other.
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
                 where, ": two nodes lie on one another at ", coordinates(node),
                 ", the elements there are not joined: make them one node (in Gmsh: Coherence "
                 "Mesh)");
      }
   }
}

/// From each segment to the one that starts where it ends. Where chains start does not depend
/// on the numbering of the mesh: open chains at their start, loops at the lowest (x, y), and
/// chains in the order of these points.
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
                 where, ": more than two boundary elements meet at ", coordinates(end->node),
                 ", or one is there twice");
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
      return a + 1 < chain.size() // else of one element
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

/// All nodes of a chain, with the sums of what their elements give them, and its elements.
struct JoinedSegments
{
   std::vector<SegmentNode> nodes;
   std::vector<LineElement> elements; ///< of nodes of the chain
};

/// The arc length begins at `start`, and is where the next chain begins afterwards.
JoinedSegments joined(const std::vector<const Segment *> &chain, double &start)
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

/// Nodes on the axis are left out of the line, their weight goes to a neighbour.
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
      require(next < nodes.size() || i > 0, where, ": the node at ", coordinates(nodes[i].node),
              " is alone on the axis");
      nodes[next < nodes.size() ? next : i - 1].node.weight += nodes[i].node.weight;
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
              coordinates(node));
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

ContactLine contact_line(const ElasticBody &body, const BoundaryPart &part)
{
   const std::string where = "contact line";
   mfem::FiniteElementSpace &space = body.space();
   mfem::Mesh &mesh = *space.GetMesh();
   const mfem::DenseMatrix &x = body.node_coordinates();
   std::vector<Segment> segments;
   mfem::Array<int> dofs;
   for (int i : boundary_elements(mesh, part, where))
   {
      BoundaryEdge edge(mesh, i);
      const double slack = interval_tolerance * edge.size();
      space.GetBdrElementDofs(i, dofs);
      const bool inside = std::all_of(dofs.begin(), dofs.end(),
                                      [&](int node) {
                                         return x(part.axis, node) >= part.lo - slack &&
                                                x(part.axis, node) <= part.hi + slack;
                                      });
      if (inside) { segments.push_back(segment(body, i, edge)); }
   }
   share(body.ranks(), segments);
   require(!segments.empty(), where, ": there are no boundary elements inside the ",
           describe(part));

   ContactLine line;
   line.formulation = body.formulation();
   double start = 0.0;
   const std::vector<WayOn> ways = ways_on(body, segments);
   for (const std::vector<const Segment *> &chain : chained(segments, where))
   {
      LineChain described;
      described.loop = chain.front()->front().id == chain.back()->back().id;
      described.ends = ends_of(chain, described.loop, ways);
      append(joined(chain, start), described, line, where);
   }
   line.validate();
   check_joined(line, where);
   return line;
}

} // namespace cattaneo
