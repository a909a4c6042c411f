#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/smooth_sides.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>

namespace cattaneo
{

using Eigen::Vector2d;

namespace
{

/// An edge of the boundary, in the direction with the body on its left.
struct OuterEdge
{
   int from = 0, to = 0;      ///< vertices
   int element = 0, side = 0; ///< the element, and the number of its edge
   int curve = -1;            ///< of the file
   bool wanted = false;       ///< it is on a side in contact
   bool plane = false;        ///< it may be on a plane of symmetry
   EdgeBend bend = {}, possible = {};
};

/// The vertices of an element's edge, counterclockwise.
std::array<int, 2> ends_of(const mfem::Mesh &mesh, int element, int side)
{
   mfem::Array<int> vertices;
   mesh.GetElementVertices(element, vertices);
   const int *at = mesh.GetElement(element)->GetEdgeVertices(side);
   return {vertices[at[0]], vertices[at[1]]};
}

Vector2d place_of_vertex(const mfem::Mesh &mesh, int vertex)
{
   const double *at = mesh.GetVertex(vertex);
   return {at[0], at[1]};
}

Vector2d chord_of(const mfem::Mesh &mesh, const OuterEdge &edge)
{
   return place_of_vertex(mesh, edge.to) - place_of_vertex(mesh, edge.from);
}

std::vector<OuterEdge> outer_edges(mfem::Mesh &mesh, const std::vector<int> &attributes,
                                   const std::vector<int> &curves,
                                   const std::vector<int> &planes)
{
   const auto among = [](const std::vector<int> &all, int one)
   { return std::count(all.begin(), all.end(), one) > 0; };
   std::map<std::pair<int, int>, int> elements; // of the boundary, by their ends
   mfem::Array<int> ends;
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      mesh.GetBdrElementVertices(i, ends);
      elements[std::minmax(ends[0], ends[1])] = i;
   }
   std::vector<OuterEdge> all;
   for (int face = 0; face < mesh.GetNumFaces(); ++face)
   {
      if (mesh.FaceIsInterior(face)) { continue; }
      OuterEdge edge;
      int none = 0, info = 0, other = 0;
      mesh.GetFaceElements(face, &edge.element, &none);
      mesh.GetFaceInfos(face, &info, &other);
      edge.side = info / 64;
      const auto [from, to] = ends_of(mesh, edge.element, edge.side);
      edge.from = from;
      edge.to = to;
      const auto found = elements.find(std::minmax(from, to));
      if (found != elements.end())
      {
         const int i = found->second;
         if (i < static_cast<int>(curves.size())) { edge.curve = curves[i]; }
         edge.wanted = among(attributes, mesh.GetBdrAttribute(i));
         edge.plane = among(planes, mesh.GetBdrAttribute(i));
      }
      // The axis needs no support.
      const double near = 1e-9 * chord_of(mesh, edge).norm();
      edge.plane = edge.plane || (std::abs(place_of_vertex(mesh, from)[0]) <= near &&
                                  std::abs(place_of_vertex(mesh, to)[0]) <= near);
      all.push_back(edge);
   }
   return all;
}

/// The closed lines of edges that follow each other along the boundary: the outline of a body,
/// and each hole.
std::vector<std::vector<OuterEdge *>> rims(std::vector<OuterEdge> &edges)
{
   std::map<int, std::vector<OuterEdge *>> starting;
   std::map<int, int> ending;
   for (OuterEdge &edge : edges)
   {
      starting[edge.from].push_back(&edge);
      ++ending[edge.to];
   }
   // Where two rims touch at a vertex, both end there.
   const auto next = [&](const OuterEdge *edge) -> OuterEdge *
   {
      const auto found = starting.find(edge->to);
      const bool one =
         found != starting.end() && found->second.size() == 1 && ending[edge->to] == 1;
      return one ? found->second[0] : nullptr;
   };
   std::set<const OuterEdge *> used;
   std::vector<std::vector<OuterEdge *>> all;
   const auto follow = [&](OuterEdge *edge)
   {
      all.emplace_back();
      for (; edge && used.insert(edge).second; edge = next(edge))
      {
         all.back().push_back(edge);
      }
   };
   for (OuterEdge &edge : edges)
   {
      if (starting[edge.from].size() > 1 || ending[edge.from] != 1) { follow(&edge); }
   }
   for (OuterEdge &edge : edges)
   {
      if (!used.count(&edge)) { follow(&edge); }
   }
   return all;
}

/// Finds the smooth curves through the vertices of a rim.
void find_bends(const mfem::Mesh &mesh, std::vector<OuterEdge *> rim)
{
   const bool loop = rim.front()->from == rim.back()->to;
   const auto n = static_cast<int>(rim.size());
   const auto along = [&](int k) { return chord_of(mesh, *rim[(k + n) % n]); };
   // A side ends at corners. Beyond a corner there may be a plane of symmetry.
   const auto is_corner = [&](int k) // at the beginning of edge k
   {
      const Vector2d a = along(k - 1), b = along(k);
      const double turn = std::abs(std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b)));
      return turn > SidePolygon::corner_within * std::acos(-1.0) / 180;
   };
   std::vector<int> corners;
   for (int k = loop ? 0 : 1; k < n; ++k)
   {
      if (is_corner(k)) { corners.push_back(k); }
   }
   if (loop && !corners.empty())
   {
      const int first = corners.front();
      std::rotate(rim.begin(), rim.begin() + first, rim.end());
      for (int &corner : corners) { corner -= first; }
   }
   else { corners.insert(corners.begin(), 0); }
   const bool whole = loop && corners.size() == 1 && !is_corner(0);
   corners.push_back(n);
   for (std::size_t c = 0; c + 1 < corners.size(); ++c)
   {
      const int begin = corners[c], end = corners[c + 1];
      SidePolygon side;
      side.loop = whole;
      for (int k = begin; k < end; ++k)
      {
         side.vertices.push_back(place_of_vertex(mesh, rim[k]->from));
         side.curves.push_back(rim[k]->curve);
      }
      if (!whole)
      {
         side.vertices.push_back(place_of_vertex(mesh, rim[end - 1]->to));
         const auto plane = [&](int k) { return rim[(k + n) % n]->plane; };
         if ((loop || begin > 0) && plane(begin - 1)) { side.beyond[0] = along(begin - 1); }
         if ((loop || end < n) && plane(end)) { side.beyond[1] = along(end); }
      }
      const std::vector<EdgeBend> bends = smooth_curve(side), possible = possible_curve(side);
      for (int k = begin; k < end; ++k)
      {
         rim[k]->bend = bends[k - begin];
         rim[k]->possible = possible[k - begin];
      }
   }
}

/// Place of a point of an element along one of its edges (0 to 1), and the share of the edge's
/// displacement with which the point moves.
struct Blend
{
   double along, share;
};

Blend blend(mfem::Geometry::Type shape, const int *at, const mfem::IntegrationPoint &ip)
{
   const mfem::IntegrationRule &corners = *mfem::Geometries.GetVertices(shape);
   const Vector2d from(corners[at[0]].x, corners[at[0]].y),
      to(corners[at[1]].x, corners[at[1]].y), here(ip.x, ip.y);
   if (shape == mfem::Geometry::SQUARE)
   {
      const Vector2d t = to - from, e = here - from;
      return {t.dot(e), 1 - std::abs(t[0] * e[1] - t[1] * e[0])};
   }
   const std::array<double, 3> weights{1 - ip.x - ip.y, ip.x, ip.y};
   const double a = weights[at[0]], b = weights[at[1]], difference = b - a;
   const double left = (1 - difference) * (1 + difference);
   // The ends of the edge move with it.
   return {0.5 * (1 + difference), left > 1e-12 ? 4 * a * b / left : 1};
}

/// Distance of the nodes of an edge from its chord, over that of its curve: 0 for a straight
/// edge, 1 for an edge that follows the curve through the vertices.
double curved(mfem::Mesh &mesh, const OuterEdge &edge)
{
   if (!mesh.GetNodes()) { return 0; }
   const Vector2d from = place_of_vertex(mesh, edge.from), chord = chord_of(mesh, edge);
   mfem::IsoparametricTransformation plane;
   mesh.GetElementTransformation(edge.element, &plane);
   const mfem::IntegrationRule &nodes = plane.GetFE()->GetNodes();
   const int *at = mesh.GetElement(edge.element)->GetEdgeVertices(edge.side);
   double off = 0, expected = 0;
   for (int k = 0; k < nodes.GetNPoints(); ++k)
   {
      const Blend of = blend(plane.GetGeometryType(), at, nodes[k]);
      if (of.share < 1 - 1e-9) { continue; }
      const Vector2d e = Vector2d(plane.GetPointMat()(0, k), plane.GetPointMat()(1, k)) - from;
      off = std::max(off, std::abs(chord[0] * e[1] - chord[1] * e[0]) / chord.squaredNorm());
      expected = std::max(expected, std::abs(edge.bend.off(of.along)));
   }
   return expected > 0 ? off / expected : off > 1e-4 ? 1 : 0;
}

/// Calls move(node, share, displacement) for the nodes of an element that move with its edge.
/// `share` is that of the edge's displacement.
template <class Move>
void along_edge(const mfem::Mesh &mesh, const OuterEdge &edge, Move move)
{
   const mfem::FiniteElementSpace &space = *mesh.GetNodalFESpace();
   const Vector2d chord = chord_of(mesh, edge);
   const mfem::FiniteElement &map = *space.GetFE(edge.element);
   const int *at = mesh.GetElement(edge.element)->GetEdgeVertices(edge.side);
   mfem::Array<int> dofs;
   space.GetElementDofs(edge.element, dofs);
   for (int k = 0; k < dofs.Size(); ++k)
   {
      const Blend of = blend(map.GetGeomType(), at, map.GetNodes()[k]);
      move(dofs[k], of.share,
           Vector2d(of.share * edge.bend.off(of.along) * Vector2d(chord[1], -chord[0])));
   }
}

void add(mfem::Mesh &mesh, const std::vector<std::pair<int, Vector2d>> &moved)
{
   const mfem::FiniteElementSpace &space = *mesh.GetNodalFESpace();
   for (const auto &[node, by] : moved)
   {
      for (int c : {0, 1}) { (*mesh.GetNodes())(space.DofToVDof(node, c)) += by[c]; }
   }
   mesh.NodesUpdated();
}

/// Moves nodes of the elements beside bent edges.
void move_beside(mfem::Mesh &mesh, const std::vector<const OuterEdge *> &bent)
{
   std::vector<std::pair<int, Vector2d>> moved;
   for (const OuterEdge *edge : bent)
   {
      along_edge(mesh, *edge,
                 [&](int node, double, const Vector2d &by) { moved.emplace_back(node, by); });
   }
   add(mesh, moved);
}

/// Moves all nodes by a displacement that is harmonic within. It is given along the bent edges,
/// and zero along all other edges of the boundary.
void move_all(mfem::Mesh &mesh, const std::vector<OuterEdge> &edges,
              const std::vector<const OuterEdge *> &bent)
{
   const std::set<const OuterEdge *> bends(bent.begin(), bent.end());
   mfem::FiniteElementSpace space(&mesh, mesh.GetNodalFESpace()->FEColl());
   std::map<int, Vector2d> known;
   for (const OuterEdge &edge : edges)
   {
      along_edge(mesh, edge,
                 [&](int node, double share, const Vector2d &by)
                 {
                    if (share < 1 - 1e-9) { return; }
                    const auto at = known.emplace(node, Vector2d(0, 0)).first;
                    if (bends.count(&edge)) { at->second += by; }
                 });
   }
   mfem::Array<int> fixed;
   for (const auto &[node, by] : known) { fixed.Append(node); }
   mfem::BilinearForm laplace(&space);
   laplace.AddDomainIntegrator(new mfem::DiffusionIntegrator);
   laplace.Assemble();
   std::vector<Vector2d> all(space.GetNDofs(), Vector2d(0, 0));
   for (int c : {0, 1})
   {
      mfem::GridFunction moved(&space);
      mfem::LinearForm none(&space);
      none.Assemble();
      moved = 0.0;
      for (const auto &[node, by] : known) { moved(node) = by[c]; }
      mfem::SparseMatrix A;
      mfem::Vector B, X;
      laplace.FormLinearSystem(fixed, moved, none, A, X, B);
      mfem::GSSmoother smoother(A);
      mfem::PCG(A, smoother, B, X, -1, 2000, 1e-16, 0.0);
      laplace.RecoverFEMSolution(X, none, moved);
      for (int k = 0; k < moved.Size(); ++k) { all[k][c] = moved(k); }
   }
   std::vector<std::pair<int, Vector2d>> list;
   for (std::size_t k = 0; k < all.size(); ++k)
   {
      list.emplace_back(static_cast<int>(k), all[k]);
   }
   add(mesh, list);
}

/// Smallest determinant of an element's mapping over its mean.
double evenness(mfem::Mesh &mesh, int element)
{
   mfem::IsoparametricTransformation plane;
   mesh.GetElementTransformation(element, &plane);
   double least = std::numeric_limits<double>::infinity(), sum = 0;
   const auto look = [&](const mfem::IntegrationPoint &ip)
   {
      plane.SetIntPoint(&ip);
      const mfem::DenseMatrix &J = plane.Jacobian();
      const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
      least = std::min(least, det);
      return det;
   };
   const mfem::IntegrationRule &rule =
      mfem::IntRules.Get(plane.GetGeometryType(), 2 * plane.GetFE()->GetOrder() + 2);
   double weights = 0;
   for (int k = 0; k < rule.GetNPoints(); ++k)
   {
      sum += rule[k].weight * look(rule[k]);
      weights += rule[k].weight;
   }
   const mfem::IntegrationRule &nodes = plane.GetFE()->GetNodes();
   for (int k = 0; k < nodes.GetNPoints(); ++k) { look(nodes[k]); }
   return least * weights / sum;
}

/// Moves nodes onto the curves of as many edges as possible without folding an element. Returns
/// these edges. The edges `in_contact` come first.
std::vector<const OuterEdge *>
move_onto_curves(mfem::Mesh &mesh, int order, const std::vector<OuterEdge> &edges,
                 const std::vector<const OuterEdge *> &bent,
                 const std::vector<const OuterEdge *> &in_contact)
{
   using Edges = std::vector<const OuterEdge *>;
   const mfem::FiniteElementSpace *space = mesh.GetNodalFESpace();
   const int before_order = space ? space->GetMaxElementOrder() : 1;
   std::map<int, double> before; // of elements, as meshed
   const auto note = [&](int e) { before.emplace(e, evenness(mesh, e)); };
   const auto unsound = [&]
   {
      std::vector<int> noted;
      for (const auto &each : before) { noted.push_back(each.first); }
      const std::vector<int> folded = folded_elements(mesh, noted);
      std::set<int> found_so(folded.begin(), folded.end());
      // The evenness of an element may fall to 0.3 of its value as meshed.
      for (const auto &[e, was] : before)
      {
         if (!(evenness(mesh, e) > 0.3 * was)) { found_so.insert(e); }
      }
      return found_so;
   };
   for (const OuterEdge *edge : bent) { note(edge->element); }
   if (before_order < order) { mesh.SetCurvature(order, false, 2, mfem::Ordering::byVDIM); }
   const mfem::Vector as_meshed = *mesh.GetNodes();
   const auto put_back = [&]
   {
      static_cast<mfem::Vector &>(*mesh.GetNodes()) = as_meshed;
      mesh.NodesUpdated();
   };
   const auto without = [](const Edges &all, const std::set<int> &elements, bool free_alone)
   {
      Edges left;
      std::copy_if(all.begin(), all.end(), std::back_inserter(left),
                   [&](const OuterEdge *edge) {
                      return (free_alone && edge->wanted) || elements.count(edge->element) == 0;
                   });
      return left;
   };
   // 1. Move the nodes of the elements beside the curves. Done if no element folds.
   move_beside(mesh, bent);
   const std::set<int> folding = unsound();
   if (folding.empty()) { return bent; }
   // 2. Else move the nodes of all elements.
   put_back();
   for (int e = 0; e < mesh.GetNE(); ++e) { note(e); }
   move_all(mesh, edges, bent);
   if (unsound().empty()) { return bent; }
   // 3. Else leave free edges straight where their elements folded in step 1.
   put_back();
   const Edges most = without(bent, folding, true);
   move_beside(mesh, most);
   if (unsound().empty()) { return most; }
   // 4. Else leave all free edges straight, and move all nodes for those in contact.
   put_back();
   move_all(mesh, edges, in_contact);
   if (unsound().empty()) { return in_contact; }
   // 5. Else leave all edges straight whose elements folded in step 1. This cannot fold others,
   // because no element has nodes that move with the edge of another one.
   put_back();
   const Edges sound = without(bent, folding, false);
   move_beside(mesh, sound);
   return sound;
}

/// How far the curve of an edge leaves its chord, to the right, at 0 <= s <= 1.
double off(const mfem::Mesh &mesh, const OuterEdge &edge, double s)
{
   return edge.bend.off(s) * chord_of(mesh, edge).norm();
}

/// The wall behind the middle of an edge: its thickness to the nearest other edge, and how much
/// the curves of both edges would add to it where the edges are straight.
std::optional<WallOfChords> wall_behind(const mfem::Mesh &mesh, const OuterEdge &edge,
                                        const std::vector<OuterEdge> &edges,
                                        const std::set<const OuterEdge *> &curved)
{
   const Vector2d chord = chord_of(mesh, edge).normalized(), into(-chord[1], chord[0]);
   WallOfChords found;
   found.place = 0.5 * (place_of_vertex(mesh, edge.from) + place_of_vertex(mesh, edge.to));
   found.wall = std::numeric_limits<double>::infinity();
   for (const OuterEdge &other : edges)
   {
      const Vector2d from = place_of_vertex(mesh, other.from) - found.place,
                     along = chord_of(mesh, other);
      // The line into the body crosses the other edge at this place.
      const double across = along.dot(chord);
      if (&other == &edge || std::abs(across) < 1e-9 * along.norm()) { continue; }
      const double s = -from.dot(chord) / across;
      const double depth = into.dot(from + s * along);
      if (s < 0 || s > 1 || depth <= 0 || depth >= found.wall) { continue; }
      found.wall = depth;
      found.off = off(mesh, edge, 0.5) + (curved.count(&other) ? 0 : off(mesh, other, s));
   }
   if (std::isinf(found.wall)) { return std::nullopt; }
   return found;
}

} // namespace

SmoothSides curve_sides(mfem::Mesh &mesh, int order, const std::vector<int> &attributes,
                        const std::vector<int> &curves, const std::vector<int> &planes)
{
#ifdef MFEM_USE_MPI
   require(dynamic_cast<const mfem::ParMesh *>(&mesh) == nullptr,
           "curve sides: the mesh is distributed, it must be curved before it is");
#endif
   SmoothSides found;
   const bool splines = mesh.NURBSext != nullptr, many = !mesh.Conforming();
   if (splines || many || mesh.Dimension() != 2 || mesh.SpaceDimension() != 2) { return found; }
   std::vector<OuterEdge> edges = outer_edges(mesh, attributes, curves, planes);
   using Edges = std::vector<const OuterEdge *>;
   Edges bent, in_contact;
   for (const std::vector<OuterEdge *> &rim : rims(edges))
   {
      find_bends(mesh, rim);
      // If the mesh has curved edges here, its straight ones are meant to be straight.
      const bool knows =
         std::any_of(rim.begin(), rim.end(),
                     [&](const OuterEdge *edge) { return curved(mesh, *edge) > 0.1; });
      if (knows)
      {
         for (OuterEdge *edge : rim) { edge->bend = edge->possible = {}; }
         continue;
      }
      for (const OuterEdge *edge : rim)
      {
         if (edge->wanted)
         {
            found.chords.push_back({place_of_vertex(mesh, edge->from),
                                    place_of_vertex(mesh, edge->to), edge->bend,
                                    edge->possible});
         }
         if (edge->bend.straight()) { continue; }
         bent.push_back(edge);
         if (!edge->wanted) { continue; }
         ++found.edges;
         found.most = std::max(found.most, std::abs(off(mesh, *edge, 0.5)));
         in_contact.push_back(edge);
      }
   }
   if (bent.empty()) { return found; }
   // In a periodic mesh elements do not share their nodes.
   const mfem::FiniteElementSpace *space = mesh.GetNodalFESpace();
   const bool periodic =
      space && dynamic_cast<const mfem::L2_FECollection *>(space->FEColl()) != nullptr;
   const Edges moved =
      order < 2 || periodic ? Edges() : move_onto_curves(mesh, order, edges, bent, in_contact);
   const std::set<const OuterEdge *> curved(moved.begin(), moved.end());
   // Edges of sides in contact that had to stay straight.
   Edges folding;
   for (const OuterEdge *edge : bent)
   {
      const bool lies_on = curved.count(edge) > 0;
      if (edge->wanted)
      {
         found.moved = found.moved || lies_on;
         if (!lies_on && order >= 2 && !periodic) { folding.push_back(edge); }
         continue;
      }
      ++(lies_on ? found.free_edges : found.free_chords);
      if (lies_on) { continue; }
      const auto wall = wall_behind(mesh, *edge, edges, curved);
      const auto share = [](const WallOfChords &of) { return std::abs(of.off) / of.wall; };
      if (wall && (!found.thinned || share(*wall) > share(*found.thinned)))
      {
         found.thinned = wall;
      }
   }
   const auto stays = [&](const SideChord &chord)
   {
      return std::any_of(folding.begin(), folding.end(),
                         [&](const OuterEdge *edge)
                         {
                            return place_of_vertex(mesh, edge->from) == chord.from &&
                                   place_of_vertex(mesh, edge->to) == chord.to;
                         });
   };
   const auto first = std::stable_partition(found.chords.begin(), found.chords.end(),
                                            [&](const SideChord &c) { return !stays(c); });
   found.folding.assign(first, found.chords.end());
   found.chords.erase(first, found.chords.end());
   return found;
}

} // namespace cattaneo
