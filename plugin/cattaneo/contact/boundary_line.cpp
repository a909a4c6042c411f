#include <algorithm>
#include <cattaneo/condense/boundary_segments.hpp>
#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
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

double length(BoundaryEdge &edge, double from, double to)
{
   const mfem::IntegrationRule &rule = edge.rule(edge.degree());
   double sum = 0.0;
   for (int k = 0; k < rule.GetNPoints(); ++k)
   {
      sum += rule.IntPoint(k).weight *
             edge.derivative(from + (to - from) * rule.IntPoint(k).x).norm();
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
      const double ds = ip.weight * edge.derivative(ip.x).norm();
      element.CalcShape(ip, shape);
      for (int a = 0; a < dofs.Size(); ++a)
      {
         const double share = ds * shape(a);
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
      const int second = body.components() == 2 ? body.global_dof(dof, 1) : -1;
      result.push_back({number(body, dof),
                        {{body.global_dof(dof, 0), second},
                         {x(0, dof), x(1, dof)},
                         edge.tangent(nodes[a].x),
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

/// How the boundary goes on at the ends of the given segments, on all ranks.
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
      int element = 0, none = 0, info = 0, other_info = 0, hanging = 0;
      mesh.GetFaceElements(face, &element, &none);
      mesh.GetFaceInfos(face, &info, &other_info, &hanging);
      // A neighbour here, on another rank, or of another size.
      if (other_info >= 0 || hanging >= 0) { continue; }
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

} // namespace

ContactLine contact_line(const ElasticBody &body, const BoundaryPart &part)
{
   const std::string where = "contact line";
   require(body.formulation() != Formulation::space,
           "contact line: the body is in space, its contact is a surface (contact_surface)");
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
   require(!segments.empty(), where, ": no boundary elements lie within the ", describe(part));
   return line_of(segments, ways_on(body, segments), body.formulation(), where);
}

} // namespace cattaneo
