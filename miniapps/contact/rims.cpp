#include "contact/rims.hpp"

#include "common/miniapp.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector3d;

namespace
{

/// The least cosine of the angle between faces across an edge that is no corner, 30 degrees.
constexpr double least_cosine = 0.866;

double distance_to(const Vector3d &place, const Vector3d &from, const Vector3d &to)
{
   const Vector3d along = to - from;
   const double share = (place - from).dot(along) / along.squaredNorm();
   return (place - from - std::clamp(share, 0.0, 1.0) * along).norm();
}

/// Where a side ends.
class Rim
{
public:
   Rim(const ElasticBody &body, mfem::Mesh &mesh, const ContactSurface &side) : side_(side)
   {
      // 1. Edges of one face only.
      std::map<Edge, int> count;
      std::set<std::set<Index>> faces;
      for (const std::vector<Index> &face : side.faces)
      {
         const std::size_t corners = face.size() == 3 || face.size() == 6 ? 3 : 4;
         faces.insert({face.begin(), face.begin() + static_cast<long>(corners)});
         for (std::size_t k = 0; k < corners; ++k)
         {
            ++count[edge_of(face[k], face[(k + 1) % corners])];
         }
      }
      std::map<int, Index> number; // of a node by its first dof
      for (Index i = 0; i < side.size(); ++i) { number[side.nodes[i].dofs[0]] = i; }
      // 2. Outward normals of the faces at these edges, within the side and beyond it.
      std::map<Edge, Vector3d> rim, beyond;
      for (int e = 0; e < mesh.GetNBE(); ++e)
      {
         mfem::Array<int> vertices, dofs;
         mesh.GetBdrElementVertices(e, vertices);
         std::vector<Index> nodes;
         std::vector<Vector3d> places;
         for (const int vertex : vertices)
         {
            body.space().GetVertexDofs(vertex, dofs);
            const auto found = number.find(body.true_dof(dofs[0], 0));
            nodes.push_back(found == number.end() ? -1 : found->second);
            places.push_back(body.place(dofs[0]));
         }
         int element = 0, info = 0;
         mesh.GetBdrElementAdjacentElement(e, element, info);
         mfem::Vector middle;
         mesh.GetElementCenter(element, middle);
         Vector3d normal = (places[1] - places[0]).cross(places[2] - places[0]).normalized();
         if (normal.dot(Vector3d(middle[0], middle[1], middle[2]) - places[0]) > 0)
         {
            normal = -normal;
         }
         const bool within = faces.count({nodes.begin(), nodes.end()}) > 0;
         for (std::size_t k = 0; k < nodes.size(); ++k)
         {
            const Edge edge = edge_of(nodes[k], nodes[(k + 1) % nodes.size()]);
            const auto found = count.find(edge);
            if (found == count.end() || found->second != 1) { continue; }
            (within ? rim : beyond)[edge] = normal;
         }
      }
      std::set<Edge> on; // at which the boundary goes on
      for (const auto &[edge, normal] : rim)
      {
         const auto found = beyond.find(edge);
         if (found != beyond.end() && found->second.dot(normal) > least_cosine)
         {
            on.insert(edge);
         }
      }
      goes_on_.assign(side.size(), false);
      for (const auto &[edge, normal] : rim)
      {
         if (on.count(edge) == 0) { ends_.push_back(edge); }
         else { goes_on_[edge.first] = goes_on_[edge.second] = true; }
      }
      // Nodes in the middle of edges.
      for (Index i = 0; i < side.size(); ++i)
      {
         const auto &[a, b] = side.nodes[i].between;
         if (a >= 0 && b >= 0 && on.count(edge_of(a, b)) > 0) { goes_on_[i] = true; }
      }
   }
   bool goes_on(Index node) const { return goes_on_[node]; }
   /// How far a place is from where the body itself ends.
   double to_end(const Vector3d &place) const
   {
      double least = std::numeric_limits<double>::infinity();
      for (const auto &[a, b] : ends_)
      {
         least = std::min(least,
                          distance_to(place, side_.nodes[a].position, side_.nodes[b].position));
      }
      return least;
   }

private:
   using Edge = std::pair<Index, Index>;
   static Edge edge_of(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }
   const ContactSurface &side_;
   std::vector<Edge> ends_;
   std::vector<bool> goes_on_;
};

} // namespace

void mark_rims(Scene &scene, const std::vector<Interface> &given)
{
   ReducedProblem &problem = scene.problem();
   std::set<Index> marked;
   for (std::size_t k = 0; k < given.size(); ++k)
   {
      const InterfaceReport &face = scene.reduction.interfaces[k];
      if (face.tied || face.nodes == 0) { continue; }
      const auto rim_of = [&](const InterfaceSide &side)
      { return Rim(*scene.bodies[side.body], *scene.meshes[side.body], side.surface); };
      const InterfaceSide &one = face.of_second ? given[k].second : given[k].first,
                          &other = face.of_second ? given[k].first : given[k].second;
      const Rim own = rim_of(one);
      std::map<int, Index> row; // by the first dof of its node
      for (Index i = 0; i < face.nodes; ++i)
      {
         row[problem.dofs(face.first + i, 3 * face.bodies[0])] = i;
      }
      const bool rigid = other.body < 0;
      std::optional<Rim> facing;
      if (!rigid) { facing.emplace(rim_of(other)); }
      // 1. The side with the nodes goes on, and the other one does not end there.
      for (Index node = 0; node < one.surface.size(); ++node)
      {
         const auto found = row.find(one.surface.nodes[node].dofs[0]);
         if (found == row.end() || !own.goes_on(node)) { continue; }
         const Index i = found->second;
         const Vector3d place = face.places.row(i);
         const bool ends = facing && facing->to_end(place) < 0.5 * face.spacing[i];
         if (!ends) { marked.insert(face.first + i); }
      }
      // 2. The other side goes on, and the one with the nodes does not end there.
      for (Index node = 0; !rigid && node < other.surface.size(); ++node)
      {
         if (!facing->goes_on(node)) { continue; }
         const Vector3d place = other.surface.nodes[node].position;
         Index nearest = 0;
         const double away =
            (face.places.rowwise() - place.transpose()).rowwise().norm().minCoeff(&nearest);
         const double spacing = face.spacing[nearest];
         if (away < 0.75 * spacing && own.to_end(place) > 0.5 * spacing)
         {
            marked.insert(face.first + nearest);
         }
      }
   }
   problem.rim.assign(marked.begin(), marked.end());
}

namespace
{

/// The largest angle between faces of a side at each of its nodes, in degrees.
std::vector<double> turns_of(const ContactSurface &side)
{
   std::vector<std::vector<Vector3d>> normals(side.size());
   for (const std::vector<Index> &face : side.faces)
   {
      const Vector3d &from = side.nodes[face[0]].position;
      Vector3d normal = (side.nodes[face[1]].position - from)
                           .cross(side.nodes[face[2]].position - from)
                           .normalized();
      Vector3d into = Vector3d::Zero();
      for (const Index node : face) { into += side.nodes[node].normal(); }
      if (normal.dot(into) < 0) { normal = -normal; }
      for (const Index node : face) { normals[node].push_back(normal); }
   }
   std::vector<double> turns;
   for (const std::vector<Vector3d> &its : normals)
   {
      double least = 1; // cosine
      for (std::size_t a = 0; a < its.size(); ++a)
      {
         for (std::size_t b = 0; b < a; ++b) { least = std::min(least, its[a].dot(its[b])); }
      }
      turns.push_back(std::acos(std::clamp(least, -1.0, 1.0)) * 180 / std::acos(-1.0));
   }
   return turns;
}

} // namespace

std::vector<NodeAtCorner>
nodes_at_corners(const Scene &scene, const std::vector<Interface> &given,
                 const std::vector<std::optional<Eigen::Vector3d>> &planes)
{
   std::vector<NodeAtCorner> found;
   for (std::size_t k = 0; k < given.size(); ++k)
   {
      const InterfaceReport &face = scene.reduction.interfaces[k];
      if (face.tied || face.nodes == 0) { continue; }
      for (Index i = 0; i < face.nodes && planes[k]; ++i)
      {
         const Vector3d normal = face.frames.row(i).segment<3>(6);
         const double cosine = std::abs(normal.dot(planes[k]->normalized())),
                      degrees = std::acos(std::min(cosine, 1.0)) * 180 / std::acos(-1.0);
         if (degrees <= 15) { continue; }
         found.push_back({face.first + i, degrees, face.places.row(i), face.name, true});
      }
      for (const InterfaceSide *side : {&given[k].first, &given[k].second})
      {
         if (side->body < 0 || planes[k]) { continue; }
         const std::vector<double> turns = turns_of(side->surface);
         for (Index node = 0; node < side->surface.size(); ++node)
         {
            // 30 degrees is the angle between the edges of a circle of twelve nodes.
            if (turns[node] <= 30.5) { continue; }
            const Vector3d place = side->surface.nodes[node].position;
            Index nearest = 0;
            const double away =
               (face.places.rowwise() - place.transpose()).rowwise().norm().minCoeff(&nearest);
            if (away >= 0.5 * face.spacing[nearest]) { continue; }
            found.push_back({face.first + nearest, turns[node], place, face.name, false});
         }
      }
   }
   return found;
}

void warn_of_seams(const Scene &scene, const std::vector<Interface> &given)
{
   for (std::size_t k = 0; k < given.size(); ++k)
   {
      const InterfaceReport &face = scene.reduction.interfaces[k];
      if (face.matching || face.bodies[1] < 0) { continue; }
      const ContactSurface &side = (face.of_second ? given[k].second : given[k].first).surface;
      double lost = 0;
      for (const SurfaceNode &node : side.nodes)
      {
         const bool its = std::any_of(face.in_rings.begin(), face.in_rings.end(),
                                      [&](const Vector3d &place)
                                      { return (place - node.position).norm() == 0; });
         lost += its ? node.weight : 0;
      }
      const double share = lost / (lost + face.weights.sum());
      if (share <= 0.1) { continue; }
      const CondensedBody &body = scene.reduction.bodies[face.bodies[0]];
      warn(told("interface '", face.name, "': nodes of body ", body.name, " with up to ",
                std::lround(100 * share),
                " % of its area belong to other interfaces, which meet it within faces of this "
                "body. Forces act there on the other nodes of these faces, so that pressures "
                "and moments are means. Make the other side the slave (key 'slave'), or end "
                "faces where interfaces end"));
   }
}

namespace
{

/// Triangles between the corners of a face.
std::vector<std::array<Vector3d, 3>> triangles_of(const ContactSurface &side,
                                                  const std::vector<Index> &face)
{
   const auto at = [&](std::size_t k) { return side.nodes[face[k]].position; };
   std::vector<std::array<Vector3d, 3>> made{{at(0), at(1), at(2)}};
   if (face.size() != 3 && face.size() != 6) { made.push_back({at(0), at(2), at(3)}); }
   return made;
}

/// Does a face of a side that looks against a direction lie over a place, along it?
bool lies_over(const ContactSurface &side, const Vector3d &place, const Vector3d &along)
{
   for (const std::vector<Index> &face : side.faces)
   {
      if (side.nodes[face[0]].normal().dot(along) > -0.5) { continue; }
      for (const std::array<Vector3d, 3> &corners : triangles_of(side, face))
      {
         // Parts of the triangle's area, all of one sign within it. A place on the seam of two
         // sides lies over neither.
         std::array<double, 3> part{};
         for (std::size_t k = 0; k < 3; ++k)
         {
            part[k] = along.dot((corners[k] - place).cross(corners[(k + 1) % 3] - place));
         }
         const double round_off = 1e-9 * std::abs(part[0] + part[1] + part[2]);
         const auto [least, most] = std::minmax_element(part.begin(), part.end());
         if (*least > round_off || *most < -round_off) { return true; }
      }
   }
   return false;
}

/// A part of a body that faces the other sides of two interfaces.
struct FacedTwice
{
   double area = 0;
   Vector3d place{0, 0, 0};
};

/// Of the faces that two sides of a body share, those of which more than a twentieth faces both
/// of the sides opposite. Areas are those of 8 × 8 parts whose middles do.
FacedTwice faced_twice(const ContactSurface &one, const ContactSurface &other,
                       const ContactSurface &opposite, const ContactSurface &its_opposite)
{
   const auto dofs_of = [](const ContactSurface &side, const std::vector<Index> &face)
   {
      std::set<int> dofs;
      for (const Index node : face) { dofs.insert(side.nodes[node].dofs[0]); }
      return dofs;
   };
   std::set<std::set<int>> shared;
   for (const std::vector<Index> &face : other.faces) { shared.insert(dofs_of(other, face)); }
   FacedTwice all;
   constexpr int parts = 8;
   for (const std::vector<Index> &face : one.faces)
   {
      if (shared.count(dofs_of(one, face)) == 0) { continue; }
      double whole = 0, twice = 0;
      Vector3d place(0, 0, 0);
      for (const std::array<Vector3d, 3> &corners : triangles_of(one, face))
      {
         const Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0];
         Vector3d normal = u.cross(v);
         const double area = 0.5 * normal.norm() / (parts * parts);
         if (area == 0) { continue; }
         normal *= (one.nodes[face[0]].normal().dot(normal) < 0 ? -1 : 1) / normal.norm();
         for (int i = 0; i < parts; ++i)
         {
            for (int j = 0; j < 2 * (parts - i) - 1; ++j)
            {
               // Triangles that stand on a row, and those that hang between them.
               const double middle = j % 2 == 0 ? 1. / 3 : 2. / 3, row = i + middle,
                            column = j / 2 + middle;
               const Vector3d here = corners[0] + (column * u + row * v) / parts;
               whole += area;
               if (!lies_over(opposite, here, normal)) { continue; }
               if (!lies_over(its_opposite, here, normal)) { continue; }
               twice += area;
               place = here;
            }
         }
      }
      if (twice <= 0.05 * whole) { continue; }
      all.area += twice;
      all.place = place;
   }
   return all;
}

} // namespace

void warn_of_faces_covered_twice(const Scene &scene, const std::vector<Interface> &given)
{
   const auto sides_of = [](const Interface &face) {
      return std::array<const InterfaceSide *, 2>{&face.first, &face.second};
   };
   for (std::size_t k = 0; k < given.size(); ++k)
   {
      for (std::size_t l = 0; l < k; ++l)
      {
         const auto its = sides_of(given[l]), own = sides_of(given[k]);
         if (its[1]->body < 0 || own[1]->body < 0) { continue; }
         FacedTwice most;
         int body = -1;
         for (const std::size_t a : {0, 1})
         {
            for (const std::size_t b : {0, 1})
            {
               if (its[a]->body != own[b]->body) { continue; }
               const FacedTwice found = faced_twice(its[a]->surface, own[b]->surface,
                                                    its[1 - a]->surface, own[1 - b]->surface);
               if (found.area <= most.area) { continue; }
               most = found;
               body = its[a]->body;
            }
         }
         if (body < 0) { continue; }
         warn(told("interfaces '", given[l].name, "' and '", given[k].name, "': about ",
                   most.area, " of the area of body ", scene.reduction.bodies[body].name,
                   " faces the other sides of both, for instance at (", most.place[0], ", ",
                   most.place[1], ", ", most.place[2],
                   "). It counts twice in areas, and both pass forces there. Move bodies apart "
                   "that overlap each other, or end one of these interfaces there (by an "
                   "interval, as in top[0<x<2])"));
      }
   }
}

void warn_of_corners(const std::vector<NodeAtCorner> &corners, const Eigen::VectorXd &p)
{
   const NodeAtCorner *worst = nullptr;
   for (const NodeAtCorner &one : corners)
   {
      const bool bears = p[one.node] > 1e-9 * p.maxCoeff();
      if (bears && (!worst || one.degrees > worst->degrees)) { worst = &one; }
   }
   if (!worst) { return; }
   const std::string at =
      told("at (", worst->place[0], ", ", worst->place[1], ", ", worst->place[2], ")");
   const long degrees = std::lround(worst->degrees);
   warn(worst->off_plane
           ? told("interface '", worst->interface, "': node ", worst->node, " ", at,
                  " carries a force although its normal is ", degrees,
                  " degrees off that of the plane. Forces and areas are wrong there: name no "
                  "boundary around a corner as contact")
           : told("interface '", worst->interface, "': its side turns by ", degrees,
                  " degrees ", at,
                  ", where it carries a force. A contact node has one normal, so forces and "
                  "areas are wrong there: make each face a separate interface, or give a curve "
                  "more nodes"));
}

} // namespace miniapp
