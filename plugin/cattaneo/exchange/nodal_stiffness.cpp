#include <algorithm>
#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/boundary_segments.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/middles.hpp>
#include <cattaneo/condense/row_links.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;

namespace
{

/// The possible directions, for messages.
const char *directions_of(Formulation formulation)
{
   return formulation == Formulation::space ? ", must be 1, 2 or 3" : ", must be 1 or 2";
}

constexpr const char *on_side =
   "a set of the nodes on the side alone is needed, and if this node is one of them, ";

constexpr const char *leave_free =
   "leave it free in the program that writes the matrix, and fix or move it here";

/// A boundary element through its nodes; numbers of dofs are left out.
Segment segment_through(const NodalStiffness::Nodes &nodes,
                        const NodalStiffness::Places &places, Formulation formulation,
                        double axis)
{
   const auto count = static_cast<Index>(nodes.size());
   const LobattoBasis &basis = lobatto_basis(count - 1);
   Eigen::Matrix2Xd points(2, count);
   for (Index a = 0; a < count; ++a) { points.col(a) = places.at(nodes[a]); }
   const Eigen::Matrix2Xd slopes = points * basis.slopes.transpose(); // at the nodes
   Segment segment(nodes.size());
   const QuadratureRule &rule = gauss_rule(16);
   Eigen::VectorXd phi(count);
   const auto along = [&](double t) -> double
   {
      basis.evaluate(t, phi);
      return (slopes * phi).norm();
   };
   for (Index a = 0; a < count; ++a)
   {
      SegmentNode &each = segment[a];
      each.id = nodes[a];
      each.node.position = points.col(a);
      each.node.tangent = slopes.col(a).normalized();
      each.on_axis = about_axis(formulation) && std::abs(points(0, a)) <= axis;
      if (a == 0) { continue; }
      const double from = basis.nodes[a - 1], step = basis.nodes[a] - from;
      each.node.arc_length = segment[a - 1].node.arc_length;
      for (Index k = 0; k < rule.points.size(); ++k)
      {
         each.node.arc_length += step * rule.weights[k] * along(from + step * rule.points[k]);
      }
   }
   for (Index k = 0; k < rule.points.size(); ++k)
   {
      const double ds = rule.weights[k] * along(rule.points[k]);
      const double r = points.row(0) * phi;
      for (Index a = 0; a < count; ++a)
      {
         segment[a].share += ds * phi[a];
         segment[a].node.weight += ds * phi[a] * measure(formulation, r);
      }
   }
   return segment;
}

} // namespace

std::map<NodeDof, int> NodalStiffness::rows() const
{
   std::map<NodeDof, int> rows;
   for (std::size_t row = 0; row < dofs.size(); ++row)
   {
      const NodeDof &dof = dofs[row];
      require(dof.direction >= 1 && dof.direction <= components(formulation), "stiffness '",
              name, "': row ", row, " is direction ", dof.direction, " of node ", dof.node,
              directions_of(formulation));
      require(rows.emplace(dof, row).second, "stiffness '", name, "': direction ",
              dof.direction, " of node ", dof.node, " has a second row, ", row,
              ", must have one only");
      const auto place = places.find(dof.node);
      const bool flat = formulation != Formulation::space;
      require(
         place != places.end() && place->second.allFinite() &&
            (flat || (z.count(dof.node) == 1 && std::isfinite(z.at(dof.node)))),
         "stiffness '", name, "': node ", dof.node, " has no place, must have ",
         flat ? "two" : "three",
         " finite coordinates: does the deck or the file of places belong to this matrix?");
   }
   return rows;
}

void NodalStiffness::validate() const
{
   const Index size = K.rows();
   require(size > 0 && K.cols() == size && static_cast<Index>(dofs.size()) == size,
           "stiffness '", name, "': it is ", size, "×", K.cols(), " with ", dofs.size(),
           " dofs, must be square and have a dof for each row");
   require(formulation != Formulation::torsion, "stiffness '", name,
           "': its formulation is torsion, must be plane, axisymmetric or space");
   require(M.rows() == M.cols() && (M.rows() == size || M.rows() == 0), "stiffness '", name,
           "': its mass M is ", M.rows(), "×", M.cols(), ", must be ", size, "×", size,
           " as the stiffness");
   rows();
   const double near_axis = axis();
   for (const auto &[node, place] : places)
   {
      require(formulation != Formulation::axisymmetric || place[0] >= -near_axis, "stiffness '",
              name, "': node ", node, " is at r = ", place[0],
              ", a body about an axis must have r >= 0");
   }
   for (std::size_t k = 0; k < fixed.size(); ++k)
   {
      require(fixed[k] >= 0 && fixed[k] < size && (k == 0 || fixed[k - 1] < fixed[k]),
              "stiffness '", name, "': row ", fixed[k],
              " is fixed, rows must increase from 0 to ", size - 1);
   }
   for (const BodyLoad &load : loads)
   {
      require(load.values.size() == size, "stiffness '", name, "': load '", load.name, "' has ",
              load.values.size(), " values, must have ", size);
   }
}

bool NodalStiffness::has_set(const std::string &set) const
{
   return sets.count(upper_case(set)) == 1;
}

const NodalStiffness::Nodes &NodalStiffness::nodes_of(const std::string &set) const
{
   const auto found = sets.find(upper_case(set));
   if (found != sets.end()) { return found->second; }
   std::vector<std::string> known;
   for (const auto &[each, nodes] : sets) { known.push_back(each); }
   throw InputError("stiffness '" + name + "': there is no set '" + set +
                    "', must be one of: " + (known.empty() ? "none" : listed(known)));
}

std::vector<int> NodalStiffness::rows_of(const Nodes &nodes, int direction,
                                         bool missing_allowed) const
{
   require(direction >= 1 && direction <= components(formulation), "stiffness '", name,
           "': direction ", direction, directions_of(formulation));
   const std::map<NodeDof, int> all = rows();
   std::vector<int> found;
   for (int node : nodes)
   {
      require(places.count(node) == 1, "stiffness '", name, "': there is no node ", node);
      const auto row = all.find({node, direction});
      found.push_back(row == all.end() ? -1 : row->second);
      require(row != all.end() || missing_allowed, "stiffness '", name, "': direction ",
              direction, " of node ", node, " has no row: ", leave_free);
   }
   return found;
}

BodyLoad &NodalStiffness::load_of(const std::string &load, Control control)
{
   for (BodyLoad &each : loads)
   {
      if (each.name != load) { continue; }
      require(each.control == control, "stiffness '", name, "': load '", load,
              "' has forces and displacements, must have forces only or displacements only");
      return each;
   }
   loads.push_back({load, control, Eigen::VectorXd::Zero(K.rows())});
   return loads.back();
}

void NodalStiffness::fix(const Nodes &nodes, int direction)
{
   std::set<int> all(fixed.begin(), fixed.end());
   for (int row : rows_of(nodes, direction, supports_left_out))
   {
      if (row >= 0) { all.insert(row); }
   }
   fixed.assign(all.begin(), all.end());
}

void NodalStiffness::add_forces(const std::string &load, const Nodes &nodes, int direction,
                                double force)
{
   const std::vector<int> at = rows_of(nodes, direction, supports_left_out);
   Eigen::VectorXd &values = load_of(load, Control::force).values;
   for (int row : at)
   {
      if (row >= 0) { values[row] += force; }
   }
}

void NodalStiffness::add_displacement(const std::string &load, const Nodes &nodes,
                                      int direction, double value)
{
   const std::vector<int> at = rows_of(nodes, direction, false);
   // In an eliminated support the forces that its motion would need are lost.
   for (std::size_t k = 0; supports_left_out && k < at.size(); ++k)
   {
      bool coupled = false;
      for (Matrix::InnerIterator entry(K, at[k]); entry; ++entry)
      {
         coupled = coupled || (entry.col() != at[k] && entry.value() != 0);
      }
      require(coupled, "stiffness '", name, "': load '", load, "' moves node ", nodes[k],
              " in direction ", direction,
              ", whose row holds nothing but its diagonal, as of an eliminated support: ",
              leave_free);
   }
   fix(nodes, direction);
   Eigen::VectorXd &values = load_of(load, Control::displacement).values;
   for (int row : at) { values[row] = value; }
}

void NodalStiffness::add_traction(const std::string &load, const Nodes &nodes,
                                  const Vector2d &traction, int order)
{
   const std::map<NodeDof, int> all = rows();
   const double near_axis = axis();
   const std::vector<Nodes> elements = elements_on(nodes, order);
   Eigen::VectorXd &values = load_of(load, Control::force).values;
   for (const Nodes &element : elements)
   {
      for (const SegmentNode &each : segment_through(element, places, formulation, near_axis))
      {
         for (int c : {0, 1})
         {
            const auto row = all.find({each.id, c + 1});
            require(row != all.end() || supports_left_out, "stiffness '", name, "': direction ",
                    c + 1, " of node ", each.id, " is loaded, but has no row in the matrix");
            if (row != all.end()) { values[row->second] += each.node.weight * traction[c]; }
         }
      }
   }
}

double NodalStiffness::axis() const
{
   double farthest = 0;
   for (const auto &[node, place] : places) { farthest = std::max(farthest, place[0]); }
   return 1e-9 * farthest;
}

Eigen::Vector3d NodalStiffness::place(int node) const
{
   const Vector2d &at = places.at(node);
   return {at[0], at[1], formulation == Formulation::space ? z.at(node) : 0.0};
}

void NodalStiffness::require_free(const DofPlaces &at) const
{
   constexpr const char *in_plane[] = {"a translation along x", "a translation along y",
                                       "a rotation"};
   constexpr const char *in_space[] = {"a translation along x", "a translation along y",
                                       "a translation along z", "a rotation about x",
                                       "a rotation about y",    "a rotation about z"};
   const int dimension = cattaneo::dimension(formulation), count = 3 * (dimension - 1);
   const Eigen::Vector3d origin(0, 0, 0);
   Eigen::MatrixXd motions(K.rows(), count);
   for (Index row = 0; row < motions.rows(); ++row)
   {
      const auto dof = static_cast<int>(row);
      motions.row(row) = rigid_at(at.place(dof), origin, dimension).row(at.component[dof]);
   }
   for (int motion = 0; motion < count; ++motion)
   {
      // About an axis the only rigid motion is along it.
      if (about_axis(formulation) && motion != 1) { continue; }
      const Eigen::VectorXd u = motions.col(motion);
      const double energy = u.dot(K * u), size = u.cwiseAbs().dot(K.cwiseAbs() * u.cwiseAbs());
      std::ostringstream share; // with no more digits than are meaningful
      share.precision(2);
      share << std::abs(energy) / size;
      require(
         std::abs(energy) <= 1e-12 * size, "stiffness '", name, "': it resists ",
         (dimension == 3 ? in_space : in_plane)[motion], " by a share of ", share.str(),
         " of its entries, must be at most 1e-12 without supports: are its rows in another "
         "order than its dofs, was it eliminated, has it less than 13 digits, or were "
         "supports left out of it (supports_left_out)?");
   }
}

AssembledBody NodalStiffness::body() const
{
   validate();
   AssembledBody body;
   const auto size = static_cast<Index>(dofs.size());
   body.K = SharedMatrix(K.pruned()); // stored entries connect nodes
   body.loads = loads;
   body.grounded = supports_left_out;
   body.places = {Eigen::VectorXd(size), Eigen::VectorXd(size), {}, formulation};
   std::set<int> held(fixed.begin(), fixed.end());
   Eigen::AlignedBox3d box;
   for (const NodeDof &dof : dofs) { box.extend(place(dof.node)); }
   const double away = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff(),
                extent = box.sizes().maxCoeff();
   require(
      extent == 0 || std::numeric_limits<double>::epsilon() * away <= 1e-8 * extent,
      "stiffness '", name, "': its nodes are ", away, " away from the origin, and ", extent,
      " from one another, so that less than 8 digits of their distances are left: move the "
      "origin nearer to the body");
   const double near_axis = axis();
   if (formulation == Formulation::space) { body.places.z.resize(size); }
   for (Index row = 0; row < size; ++row)
   {
      const Vector2d &place = places.at(dofs[row].node);
      if (formulation == Formulation::space) { body.places.z[row] = z.at(dofs[row].node); }
      body.places.x[row] = place[0];
      body.places.y[row] = place[1];
      body.places.component.push_back(dofs[row].direction - 1);
      const bool on_axis = formulation == Formulation::axisymmetric && place[0] <= near_axis;
      if (on_axis && dofs[row].direction == 1) { held.insert(static_cast<int>(row)); }
   }
   body.fixed.assign(held.begin(), held.end());
   if (fixed.empty() && !supports_left_out)
   {
      body.validate(); // an asymmetric part would resist motions too
      require_free(body.places);
   }
   return body;
}

std::vector<NodalStiffness::Nodes> NodalStiffness::elements_on(const Nodes &nodes,
                                                               int order) const
{
   for (int node : nodes)
   {
      require(places.count(node) == 1, "stiffness '", name, "': there is no node ", node);
   }
   std::vector<Nodes> elements;
   if (order == 0)
   {
      require(
         !edges.empty(), "stiffness '", name,
         "': no elements are known, nodes must be given in order, with an order of elements");
      const std::set<int> among(nodes.begin(), nodes.end());
      for (const Nodes &edge : edges)
      {
         if (std::all_of(edge.begin(), edge.end(), [&](int n) { return among.count(n) == 1; }))
         {
            elements.push_back(edge);
         }
      }
      require(!elements.empty(), "stiffness '", name,
              "': no outer edge of an element has all of its "
              "nodes among the ",
              nodes.size(),
              " given, there must be one at least: are they on the boundary, with the nodes in "
              "the middles of edges?");
      return elements;
   }
   const auto step = static_cast<std::size_t>(order);
   require(order > 0 && order <= LobattoBasis::highest_order && nodes.size() > step &&
              (nodes.size() - 1) % step == 0,
           "stiffness '", name, "': ", nodes.size(), " nodes in elements of order ", order,
           ", must be of order 1 to 8, and one more node than a multiple of it");
   for (std::size_t first = 0; first + 1 < nodes.size(); first += step)
   {
      elements.emplace_back(nodes.begin() + first, nodes.begin() + first + step + 1);
   }
   return elements;
}

void NodalStiffness::require_body_on_left(const ContactLine &line) const
{
   std::set<int> on_line;
   for (const LineNode &node : line.nodes) { on_line.insert({node.dofs[0], node.dofs[1]}); }
   double depth = 0;
   for (const LineNode &node : line.nodes)
   {
      for (Matrix::InnerIterator entry(K, node.dofs[0]); entry; ++entry)
      {
         if (on_line.count(static_cast<int>(entry.col())) == 1) { continue; }
         const Vector2d &inside = places.at(dofs[entry.col()].node);
         depth += (inside - node.position).normalized().dot(node.normal());
      }
   }
   require(
      depth >= 0, "stiffness '", name,
      "': the body is on the right of its contact nodes, which must be given the other way "
      "round");
}

std::vector<NodalStiffness::Nodes> NodalStiffness::faces_on(const Nodes &nodes) const
{
   require(formulation == Formulation::space, "stiffness '", name, "': it is ",
           cattaneo::name(formulation),
           ", where contact is on a line, must be in space for a surface");
   require(!faces.empty(), "stiffness '", name,
           "': no elements are known, a surface must be given by its faces");
   const std::set<int> among(nodes.begin(), nodes.end());
   std::vector<Nodes> found;
   for (const Nodes &face : faces)
   {
      if (std::all_of(face.begin(), face.end(), [&](int n) { return among.count(n) == 1; }))
      {
         found.push_back(face);
      }
   }
   require(!found.empty(), "stiffness '", name,
           "': no outer face of an element has all of its nodes among the ", nodes.size(),
           " given, there must be one at least");
   return found;
}

ContactSurface NodalStiffness::contact_surface(const Nodes &nodes) const
{
   return contact_surface(faces_on(nodes));
}

ContactSurface NodalStiffness::contact_surface(const std::vector<Nodes> &on) const
{
   validate();
   require(formulation == Formulation::space, "stiffness '", name, "': it is ",
           cattaneo::name(formulation),
           ", where contact is on a line, must be in space for a surface");
   const std::string where = "contact surface of '" + name + "'";
   const std::map<NodeDof, int> all = rows();
   const auto known = [&](int id)
   {
      require(places.count(id) == 1, "stiffness '", name, "': there is no node ", id);
      SurfaceNode node;
      node.position = place(id);
      for (int c : {0, 1, 2})
      {
         const auto row = all.find({id, c + 1});
         require(row != all.end(), where, ": direction ", c + 1, " of node ", id,
                 " has no row: ", on_side, leave_free);
         node.dofs[c] = row->second;
      }
      return node;
   };
   // Nodes that K couples with all nodes of a face, and that lie off the face, are on the
   // body's side.
   const auto inside = [&](std::size_t f)
   {
      const Nodes &face = on[f];
      Eigen::Vector3d middle(0, 0, 0), way(0, 0, 0);
      for (int id : face) { middle += place(id) / static_cast<double>(face.size()); }
      std::map<int, std::size_t> seen; // by how many nodes of the face
      for (int id : face)
      {
         std::set<int> its;
         for (Matrix::InnerIterator e(K, all.at({id, 1})); e; ++e)
         {
            its.insert(dofs[e.col()].node);
         }
         for (int other : its) { ++seen[other]; }
      }
      for (const auto &[other, times] : seen)
      {
         const bool own = std::count(face.begin(), face.end(), other) > 0;
         if (times == face.size() && !own) { way += place(other) - middle; }
      }
      return way;
   };
   return surface_of(on, known, inside, where);
}

void NodalStiffness::add_surface_traction(const std::string &load, const Nodes &nodes,
                                          const Eigen::Vector3d &traction)
{
   const ContactSurface surface = contact_surface(nodes);
   Eigen::VectorXd &values = load_of(load, Control::force).values;
   const Eigen::VectorXd areas = surface.forces_at_nodes(surface.weights()); // ∫N dA
   for (Index i = 0; i < surface.size(); ++i)
   {
      for (int c : {0, 1, 2}) { values[surface.nodes[i].dofs[c]] += areas[i] * traction[c]; }
   }
}

ContactLine NodalStiffness::contact_line(const Nodes &nodes, int order) const
{
   validate();
   require(formulation != Formulation::space, "stiffness '", name,
           "': it is in space, where contact is on a surface: use contact_surface()");
   const std::string where = "contact line of '" + name + "'";
   const std::vector<Nodes> elements = elements_on(nodes, order);
   const std::map<NodeDof, int> all = rows();
   const double near_axis = axis();
   std::vector<Segment> segments;
   std::set<int> ends;
   for (const Nodes &element : elements)
   {
      segments.push_back(segment_through(element, places, formulation, near_axis));
      ends.insert({element.front(), element.back()});
      for (SegmentNode &each : segments.back())
      {
         if (each.on_axis) { continue; }
         for (int c : {0, 1})
         {
            const auto row = all.find({each.id, c + 1});
            require(row != all.end(), where, ": direction ", c + 1, " of node ", each.id,
                    " has no row: ", on_side, leave_free);
            each.node.dofs[c] = row->second;
         }
      }
   }
   std::vector<WayOn> ways;
   for (const Nodes &edge : edges)
   {
      if (ends.count(edge.front()) + ends.count(edge.back()) == 0) { continue; }
      const Segment way = segment_through(edge, places, formulation, near_axis);
      const Vector2d &leaves = way.front().node.tangent, back = -way.back().node.tangent;
      ways.push_back({edge.front(), leaves[0], leaves[1]});
      ways.push_back({edge.back(), back[0], back[1]});
   }
   ContactLine line = line_of(segments, ways, formulation, where);
   if (order > 0) { require_body_on_left(line); }
   return line;
}

std::vector<NodalStiffness> NodalStiffness::parts() const
{
   validate();
   // Rows of eliminated supports count as missing.
   std::set<int> gone;
   if (supports_left_out)
   {
      AssembledBody all = body();
      all.fixed.clear(); // fixed or not
      const std::vector<int> rows = all.eliminated();
      gone.insert(rows.begin(), rows.end());
      // Round-off in them connects no bodies.
      if (const Matrix apart = without_links(all.K, rows).view();
          apart.nonZeros() < all.K.view().nonZeros())
      {
         NodalStiffness made = *this;
         made.K = apart;
         return made.parts();
      }
   }
   // Rows of one node belong to one body, whether K connects them or not.
   std::vector<Eigen::Triplet<double>> links;
   int last = -1, last_node = 0;
   for (const auto &[dof, row] : rows())
   {
      if (last >= 0 && last_node == dof.node) { links.emplace_back(last, row, 1.0); }
      last = row;
      last_node = dof.node;
   }
   Matrix linked(K.rows(), K.cols());
   linked.setFromTriplets(links.begin(), links.end());
   std::vector<std::vector<int>> groups =
      SharedMatrix(K.cwiseAbs().pruned() + linked + Matrix(linked.transpose()))
         .connected_parts();
   const auto is_gone = [&](int row) { return gone.count(row) == 1; };
   std::map<int, std::size_t> owner; // of nodes
   for (std::size_t g = 0; g < groups.size(); ++g)
   {
      if (std::all_of(groups[g].begin(), groups[g].end(), is_gone)) { continue; }
      for (int row : groups[g]) { owner[dofs[row].node] = g; }
   }
   // Supported nodes that have no rows are those of the body whose edges they are on.
   for (bool more = true; more;)
   {
      more = false;
      for (const Nodes &edge : edges)
      {
         const auto known = std::find_if(edge.begin(), edge.end(),
                                         [&](int node) { return owner.count(node) == 1; });
         for (int node : edge)
         {
            more = (known != edge.end() && owner.emplace(node, owner[*known]).second) || more;
         }
      }
   }
   for (int row : gone)
   {
      const auto found = owner.find(dofs[row].node);
      if (found == owner.end()) { continue; }
      std::vector<int> &rows = groups[found->second];
      if (!std::binary_search(rows.begin(), rows.end(), row))
      {
         rows.insert(std::upper_bound(rows.begin(), rows.end(), row), row);
      }
   }
   std::vector<std::size_t> order; // by the lowest number of a node
   for (const auto &[node, group] : owner)
   {
      if (std::find(order.begin(), order.end(), group) == order.end())
      {
         order.push_back(group);
      }
   }
   // Which of the bodies have supports. Empty if no supports are known, or if they are on nodes
   // that may belong to any body.
   std::set<std::size_t> supported;
   for (int node : on_springs)
   {
      supported.insert(owner.count(node) ? owner.at(node) : order.size());
   }
   std::map<NodeDof, int> known = rows();
   for (int row : gone) { known.erase(dofs[row]); }
   const double near_axis = axis();
   for (const auto &[node, place] : places)
   {
      const bool on_axis = formulation == Formulation::axisymmetric && place[0] <= near_axis,
                 flat = formulation != Formulation::space;
      if ((on_axis || known.count({node, 1}) == 1) && known.count({node, 2}) == 1 &&
          (flat || known.count({node, 3}) == 1))
      {
         continue;
      }
      supported.insert(owner.count(node) == 1 ? owner.at(node) : order.size());
   }
   const bool told = !supported.empty() && supported.count(order.size()) == 0;
   std::vector<NodalStiffness> found;
   for (std::size_t group : order)
   {
      found.push_back(part(groups[group], owner, group));
      found.back().supports_left_out =
         supports_left_out && (!told || supported.count(group) == 1);
   }
   for (std::size_t b = 0; b < found.size(); ++b)
   {
      if (found[b].name.empty()) { found[b].name = "body " + std::to_string(b + 1); }
   }
   return found;
}

NodalStiffness NodalStiffness::part(const std::vector<int> &rows,
                                    const std::map<int, std::size_t> &owner,
                                    std::size_t group) const
{
   NodalStiffness own;
   own.formulation = formulation;
   std::vector<int> number(dofs.size(), -1);
   for (int row : rows)
   {
      number[row] = static_cast<int>(own.dofs.size());
      own.dofs.push_back(dofs[row]);
   }
   for (const auto &[node, of] : owner)
   {
      if (of != group) { continue; }
      own.places[node] = places.at(node);
      if (formulation == Formulation::space) { own.z[node] = z.at(node); }
   }
   const auto part_of = [&](const Matrix &whole)
   {
      std::vector<Eigen::Triplet<double>> entries;
      for (int row : rows)
      {
         for (Matrix::InnerIterator entry(whole, row); entry; ++entry)
         {
            const int column = number[entry.col()];
            if (entry.value() == 0 || column < 0) { continue; } // between bodies
            entries.emplace_back(number[row], column, entry.value());
         }
      }
      Matrix made(rows.size(), rows.size());
      made.setFromTriplets(entries.begin(), entries.end());
      return made;
   };
   own.K = part_of(K);
   if (M.rows() > 0) { own.M = part_of(M); }
   for (int row : fixed)
   {
      if (number[row] >= 0) { own.fixed.push_back(number[row]); }
   }
   for (const BodyLoad &load : loads)
   {
      const Eigen::VectorXd values = load.values(rows);
      if (!values.isZero(0)) { own.loads.push_back({load.name, load.control, values}); }
   }
   const auto is_own = [&](int node) { return own.places.count(node) == 1; };
   std::copy_if(on_springs.begin(), on_springs.end(), std::back_inserter(own.on_springs),
                is_own);
   const auto all_own = [&](const Nodes &side)
   { return std::all_of(side.begin(), side.end(), is_own); };
   std::copy_if(edges.begin(), edges.end(), std::back_inserter(own.edges), all_own);
   std::copy_if(faces.begin(), faces.end(), std::back_inserter(own.faces), all_own);
   std::size_t smallest = 0;
   for (const auto &[set, nodes] : sets)
   {
      Nodes kept;
      bool others = false;
      for (int node : nodes)
      {
         const auto found = owner.find(node);
         if (found == owner.end()) { continue; }
         if (found->second == group) { kept.push_back(node); }
         else { others = true; }
      }
      if (!others && kept.size() == own.places.size() &&
          (smallest == 0 || nodes.size() < smallest))
      {
         own.name = set;
         smallest = nodes.size();
      }
      if (!kept.empty()) { own.sets[set] = std::move(kept); }
   }
   return own;
}

NodalStiffness nodal_stiffness(const CondensedBody &body)
{
   const ContactLine &line = body.line;
   require(line.formulation != Formulation::torsion,
           "stiffness of a condensed body: its formulation is torsion, must be plane, "
           "axisymmetric or "
           "space");
   const FrameChange back = frames_of(body).inverse();
   const Index n = body.nodes();
   const int count = components(line.formulation);
   const Eigen::MatrixX3d places = body.places();
   const Middles middles(body.surface);
   Eigen::MatrixXd S = back.both(body.S);
   middles.stiffness_to_nodes(S);
   NodalStiffness result;
   result.name = body.name;
   result.formulation = line.formulation;
   std::vector<int> rows; // of {x; y}, that are not held
   for (Index i = 0; i < n; ++i)
   {
      const auto node = static_cast<int>(i + 1);
      result.places[node] = places.row(i).head(2);
      if (count == 3) { result.z[node] = places(i, 2); }
      result.sets["CONTACT"].push_back(node);
      for (int c = 0; c < count; ++c)
      {
         const Index row = i + c * n;
         if (S(row, row) == 0) { continue; }
         rows.push_back(static_cast<int>(row));
         result.dofs.push_back({node, c + 1});
      }
   }
   const int free = about_axis(line.formulation) ? 1 : 3 * (count - 1);
   result.supports_left_out = body.free_motions.cols() < free;
   result.K = Eigen::MatrixXd(S(rows, rows)).sparseView();
   for (const LoadPattern &pattern : body.patterns)
   {
      Eigen::VectorXd forces(count * n);
      forces << pattern.q, pattern.p;
      Eigen::MatrixXd loads = -back.rows(forces);
      middles.forces_to_nodes(loads);
      result.loads.push_back({pattern.name, Control::force, loads(rows, 0)});
   }
   return result;
}

} // namespace cattaneo
