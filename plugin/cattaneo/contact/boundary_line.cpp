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

/// Nodes (their numbers) of one boundary element, in the direction with the body on the left.
struct Segment
{
   std::vector<int> nodes;
   std::vector<double> distance; ///< arc length from the first node
   std::vector<double> weights;  ///< ∫φ ds, or ∫φ 2πr ds
   std::vector<double> shares;   ///< ∫φ ds
   std::vector<std::array<double, 2>> tangents;
};

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
   Segment result;
   double distance = 0.0;
   for (std::size_t k = 0; k < order.size(); ++k)
   {
      const int a = order[k];
      if (k > 0) { distance += std::abs(length(edge, nodes[order[k - 1]].x, nodes[a].x)); }
      result.nodes.push_back(number(body, dofs[a]));
      result.distance.push_back(distance);
      result.weights.push_back(weights[a]);
      result.shares.push_back(shares[a]);
      result.tangents.push_back(edge.tangent(nodes[a].x));
   }
   return result;
}

/// What is known of a node, wherever it is: the same on all ranks.
struct Node
{
   double x = 0, y = 0;
   std::array<int, 2> dofs{-1, -1};
   bool on_axis = false;
};

/// Every rank gets the segments and nodes of all.
void share(const Ranks &ranks, std::vector<Segment> &segments, std::map<int, Node> &nodes)
{
   if (!ranks.several()) { return; }
   std::vector<double> packed;
   for (const Segment &s : segments)
   {
      packed.push_back(static_cast<double>(s.nodes.size()));
      for (std::size_t a = 0; a < s.nodes.size(); ++a)
      {
         const Node &node = nodes.at(s.nodes[a]);
         for (double value : {double(s.nodes[a]), s.distance[a], s.weights[a], s.shares[a],
                              s.tangents[a][0], s.tangents[a][1], node.x, node.y,
                              double(node.dofs[0]), double(node.dofs[1]), double(node.on_axis)})
         {
            packed.push_back(value);
         }
      }
   }
   packed = ranks.gather(packed);
   segments.clear();
   for (std::size_t k = 0; k < packed.size();)
   {
      const auto next = [&] { return packed[k++]; };
      const auto next_int = [&] { return static_cast<int>(next()); };
      Segment s;
      const int count = next_int();
      for (int a = 0; a < count; ++a)
      {
         s.nodes.push_back(next_int());
         s.distance.push_back(next());
         s.weights.push_back(next());
         s.shares.push_back(next());
         s.tangents.emplace_back();
         for (double &component : s.tangents.back()) { component = next(); }
         Node &node = nodes[s.nodes.back()];
         node.x = next();
         node.y = next();
         for (int &dof : node.dofs) { dof = next_int(); }
         node.on_axis = next() != 0;
      }
      segments.push_back(s);
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
   for (const Segment &s : segments) { ends.insert({s.nodes.front(), s.nodes.back()}); }
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

/// How the boundary goes on from a node in whose direction (x, y) the line ends; `bend`: angle
/// between its last two elements.
LineEnd goes_on(const std::vector<WayOn> &ways, int node, double x, double y, double bend)
{
   double straightest = -1; // an outer edge ends nowhere: there is a way on
   for (const WayOn &way : ways)
   {
      if (way.node == node) { straightest = std::max(straightest, way.x * x + way.y * y); }
   }
   const double turn =
      std::clamp(1.5 * bend, LineChain::smooth_turn * degree, LineChain::corner_turn * degree);
   return straightest >= std::cos(turn) ? LineEnd::smooth : LineEnd::corner;
}

/// Nodes of elements that lie on one another without being joined would bear side by side, and
/// have two partners each.
void check_joined(const ContactLine &line, const std::string &where)
{
   // In the order along a direction that no mesh has, few are near each other.
   const Eigen::VectorXd along = line.position * Eigen::Vector2d(0.8191, 0.5736);
   std::vector<Eigen::Index> order(line.size());
   std::iota(order.begin(), order.end(), 0);
   std::sort(order.begin(), order.end(),
             [&](Eigen::Index a, Eigen::Index b) { return along[a] < along[b]; });
   const double near = 1e-6;
   const double farthest = near * line.spacing.maxCoeff();
   for (std::size_t k = 0; k < order.size(); ++k)
   {
      const Eigen::Index i = order[k];
      for (std::size_t l = k + 1; l < order.size() && along[order[l]] - along[i] <= farthest;
           ++l)
      {
         const Eigen::Index j = order[l];
         require((line.position.row(i) - line.position.row(j)).norm() >
                    near * std::min(line.spacing[i], line.spacing[j]),
                 where, ": two nodes lie on one another at (", line.position(i, 0), ", ",
                 line.position(i, 1),
                 "), the elements there are not joined: make them one node (in Gmsh: Coherence "
                 "Mesh)");
      }
   }
}

} // namespace

ContactLine contact_line(const ElasticBody &body, const BoundaryPart &part)
{
   const std::string where = "contact line";
   mfem::FiniteElementSpace &space = body.space();
   mfem::Mesh &mesh = *space.GetMesh();
   const mfem::DenseMatrix &x = body.node_coordinates();
   std::vector<Segment> segments;
   std::map<int, Node> nodes;
   const auto coordinates = [&nodes](int id)
   {
      const Node &node = nodes.at(id);
      return "(" + std::to_string(node.x) + ", " + std::to_string(node.y) + ")";
   };
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
      if (!inside) { continue; }
      segments.push_back(segment(body, i, edge));
      for (int dof : dofs)
      {
         const bool two = body.components() == 2;
         nodes[number(body, dof)] = {
            x(0, dof),
            x(1, dof),
            {body.global_dof(dof, 0), two ? body.global_dof(dof, 1) : -1},
            body.on_axis(dof)};
      }
   }
   share(body.ranks(), segments, nodes);
   require(!segments.empty(), where, ": there are no boundary elements inside the ",
           describe(part));

   // Chains: from each segment to the one that starts where it ends.
   std::map<int, int> starting, ending;
   for (std::size_t k = 0; k < segments.size(); ++k)
   {
      const int first = segments[k].nodes.front(), last = segments[k].nodes.back();
      require(starting.emplace(first, k).second, where,
              ": more than two boundary elements meet at ", coordinates(first),
              ", or one is there twice");
      require(ending.emplace(last, k).second, where,
              ": more than two boundary elements meet at ", coordinates(last),
              ", or one is there twice");
   }
   // Where chains start does not depend on the numbering of the mesh: open chains at their
   // start, loops at the lowest (x, y), and chains in the order of these points.
   const auto before = [&](int a, int b)
   {
      const int i = segments[a].nodes.front(), j = segments[b].nodes.front();
      return std::make_pair(nodes.at(i).x, nodes.at(i).y) <
             std::make_pair(nodes.at(j).x, nodes.at(j).y);
   };
   std::vector<bool> used(segments.size(), false);
   const auto follow = [&](int start)
   {
      std::vector<int> chain;
      for (int k = start; !used[k];)
      {
         used[k] = true;
         chain.push_back(k);
         const auto next = starting.find(segments[k].nodes.back());
         if (next == starting.end()) { break; }
         k = next->second;
      }
      return chain;
   };
   std::vector<std::vector<int>> chains;
   for (std::size_t k = 0; k < segments.size(); ++k)
   {
      if (!ending.count(segments[k].nodes.front()))
      {
         chains.push_back(follow(static_cast<int>(k)));
      }
   }
   for (std::size_t k = 0; k < segments.size(); ++k)
   {
      if (used[k]) { continue; }
      std::vector<int> loop = follow(static_cast<int>(k));
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), before), loop.end());
      chains.push_back(loop);
   }
   std::sort(chains.begin(), chains.end(),
             [&](const std::vector<int> &a, const std::vector<int> &b)
             { return before(a.front(), b.front()); });

   ContactLine line;
   std::vector<int> numbers;
   std::vector<double> arc, weights, lumped, spacing;
   std::vector<std::array<double, 2>> tangent;
   double start = 0.0;
   const std::vector<WayOn> ways = ways_on(body, segments);
   for (std::size_t c = 0; c < chains.size(); ++c)
   {
      const Segment &opening = segments[chains[c].front()],
                    &closing = segments[chains[c].back()];
      const int ends[] = {opening.nodes.front(), closing.nodes.back()};
      const auto &in = opening.tangents.front(), &out = closing.tangents.back();
      LineChain described;
      described.loop = ends[0] == ends[1];
      const auto bend = [&](std::size_t a, std::size_t b)
      {
         const auto &from = segments[chains[c][a]].tangents.back(),
                    &to = segments[chains[c][b]].tangents.front();
         return std::acos(std::clamp(from[0] * to[0] + from[1] * to[1], -1.0, 1.0));
      };
      const std::size_t last = chains[c].size() - 1;
      described.ends = {
         goes_on(ways, ends[0], -in[0], -in[1], last > 0 ? bend(0, 1) : 0.0),
         goes_on(ways, ends[1], out[0], out[1], last > 0 ? bend(last - 1, last) : 0.0)};
      for (std::size_t k : {0, 1})
      {
         if (described.loop) { described.ends[k] = LineEnd::smooth; }
         else if (nodes.at(ends[k]).on_axis) { described.ends[k] = LineEnd::axis; }
      }
      line.chains.push_back(described);
      const std::size_t first = numbers.size();
      double end = start;
      for (int k : chains[c])
      {
         const Segment &s = segments[k];
         for (std::size_t a = 0; a < s.nodes.size(); ++a)
         {
            const bool repeats = a == 0 && k != chains[c].front();
            const bool closes = a + 1 == s.nodes.size() && s.nodes[a] == numbers[first] &&
                                numbers.size() > first + 1;
            std::size_t node = numbers.size();
            if (repeats) { --node; }
            else if (closes) { node = first; }
            else
            {
               numbers.push_back(s.nodes[a]);
               line.chain.push_back(static_cast<int>(c));
               arc.push_back(end + s.distance[a]);
               weights.push_back(0.0);
               lumped.push_back(0.0);
               spacing.push_back(std::numeric_limits<double>::infinity());
               tangent.push_back({0.0, 0.0});
            }
            weights[node] += s.weights[a];
            for (int i = 0; i < 2; ++i) { tangent[node][i] += s.shares[a] * s.tangents[a][i]; }
            if (a > 0)
            {
               const double step = s.distance[a] - s.distance[a - 1];
               const std::size_t previous = closes ? numbers.size() - 1 : node - 1;
               for (std::size_t i : {previous, node})
               {
                  lumped[i] += 0.5 * step;
                  spacing[i] = std::min(spacing[i], step);
               }
            }
         }
         end += s.distance.back();
      }
      start = end;
   }

   const auto leave_out = [&](std::size_t node)
   {
      const auto drop = [node](auto &list)
      { list.erase(list.begin() + static_cast<std::ptrdiff_t>(node)); };
      drop(numbers);
      drop(line.chain);
      drop(arc);
      drop(weights);
      drop(lumped);
      drop(spacing);
      drop(tangent);
   };
   for (std::size_t node = numbers.size(); node-- > 0;)
   {
      if (!nodes.at(numbers[node]).on_axis) { continue; }
      const auto neighbour = [&](std::size_t other)
      { return other < line.chain.size() && line.chain[other] == line.chain[node]; };
      require(neighbour(node + 1) || neighbour(node - 1), where, ": the node at ",
              coordinates(numbers[node]), " is alone on the axis");
      weights[neighbour(node + 1) ? node + 1 : node - 1] += weights[node];
      leave_out(node);
   }

   const auto n = static_cast<Eigen::Index>(numbers.size());
   for (Eigen::Index i = n; i-- > 0;)
   {
      LineChain &chain = line.chains[line.chain[i]];
      chain.first = i;
      ++chain.nodes;
   }
   line.position.resize(n, 2);
   line.tangent.resize(n, 2);
   line.normal.resize(n, 2);
   line.arc_length = Eigen::Map<Eigen::VectorXd>(arc.data(), n);
   line.weights = Eigen::Map<Eigen::VectorXd>(weights.data(), n);
   line.lumped_weights = Eigen::Map<Eigen::VectorXd>(lumped.data(), n);
   line.spacing = Eigen::Map<Eigen::VectorXd>(spacing.data(), n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const int id = numbers[i];
      const Node &node = nodes.at(id);
      require(line.weights[i] > 0, where, ": the weight of the node at ", coordinates(id),
              " is ", line.weights[i], ", must be positive");
      const double size = std::hypot(tangent[i][0], tangent[i][1]);
      // Exactly opposite tangents cancel to round-off.
      require(size > 1e-9 * line.lumped_weights[i], where,
              ": the line turns back on itself at ", coordinates(id));
      line.position.row(i) << node.x, node.y;
      line.tangent.row(i) << tangent[i][0] / size, tangent[i][1] / size;
      line.normal.row(i) << -line.tangent(i, 1), line.tangent(i, 0);
      line.dofs.push_back(node.dofs);
   }
   check_joined(line, where);
   return line;
}

} // namespace cattaneo
