#include <algorithm>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/surfaces.hpp>
#include <cattaneo/rounded.hpp>
#include <cmath>
#include <optional>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace
{

std::string called(const SurfaceNode &node)
{
   return place_text(node.position, Formulation::space);
}

/// Do supports hold a direction of a node?
bool is_held(const CondensedBody &body, int node, const Vector3d &direction)
{
   double part = 0;
   for (int c = 0; c < 3; ++c)
   {
      part += body.holds(node, c) ? direction[c] * direction[c] : 0.0;
   }
   return part > 0.5;
}

bool any_is_held(const CondensedBody &body, int node)
{
   return body.holds(node, 0) || body.holds(node, 1) || body.holds(node, 2);
}

/// The nodes of a side in the trace of its body, and its frames along what supports hold.
Side surface_side(const InterfaceSide &given, const std::vector<CondensedBody> &bodies,
                  const std::string &what)
{
   const CondensedBody &body = bodies[given.body];
   given.surface.validate();
   std::map<std::array<int, 3>, int> number;
   for (Index k = 0; k < body.surface.size(); ++k)
   {
      number[body.surface.nodes[k].dofs] = static_cast<int>(k);
   }
   Side side;
   side.body = given.body;
   side.surface = given.surface;
   meet_supports(side.surface, body);
   for (const SurfaceNode &node : side.surface.nodes)
   {
      const auto found = number.find(node.dofs);
      // Numbers of dofs alone may coincide with those of other bodies.
      const bool same = found != number.end() &&
                        (body.surface.nodes[found->second].position - node.position).norm() <=
                           1e-9 * node.spacing;
      require(same, what, ": the node ", called(node), " is none that ",
              called(bodies, given.body),
              " was condensed to, it must be condensed to the nodes of all of its interfaces "
              "(joined())");
      side.nodes.push_back(found->second);
   }
   // A node in the middle of an edge must lie between the same nodes on the side and on the
   // body, so that its unknown is the same.
   for (std::size_t k = 0; k < side.nodes.size(); ++k)
   {
      const auto &here = side.surface.nodes[k].between,
                 &there = body.surface.nodes[side.nodes[k]].between;
      std::set<Index> ends, its(there.begin(), there.end());
      for (Index end : here) { ends.insert(end < 0 ? end : side.nodes[end]); }
      require(ends == its, what, ": the node ", called(side.surface.nodes[k]),
              " is in the middle of an edge of ", here[0] < 0 ? "the body" : "this side",
              " alone, the body must be condensed to the faces of all of its interfaces "
              "(joined())");
   }
   return side;
}

/// Gaps of the unknowns of a surface whose nodes have these, each along the normal of its node.
VectorXd gaps_of_unknowns(const ContactSurface &surface, const VectorXd &gaps)
{
   Eigen::MatrixXd ways(surface.size(), 3);
   for (Index i = 0; i < surface.size(); ++i)
   {
      ways.row(i) = gaps[i] * surface.nodes[i].normal();
   }
   ways = surface.of_nodes(std::move(ways));
   VectorXd made = gaps;
   for (Index i = 0; i < surface.size(); ++i)
   {
      const SurfaceNode &node = surface.nodes[i];
      if (node.between[0] >= 0) { made[i] = ways.row(i).dot(node.normal()); }
   }
   return made;
}

/// The gaps that a caller gave for the nodes of the slave, or those of the geometry; empty if
/// neither is there.
VectorXd gaps_of(const Interface &given, const MetInterface &met, VectorXd of_geometry)
{
   const ContactSurface &surface = met.slave.surface;
   const Index n = surface.size();
   if (given.node_gaps)
   {
      require(given.node_gaps->size() == n, met.what, ": ", given.node_gaps->size(),
              " gaps for ", n, " nodes of the side that has them, must be as many");
   }
   else if (!given.gap) { return of_geometry; }
   VectorXd gaps(n);
   for (Index i = 0; i < n; ++i)
   {
      const Vector3d &x = surface.nodes[i].position;
      gaps[i] = given.node_gaps ? (*given.node_gaps)[i] : (*given.gap)(x[0], x[1], x[2]);
      require(std::isfinite(gaps[i]), met.what, ": the gap at ", called(surface.nodes[i]),
              " is ", gaps[i], ", must be finite");
   }
   return gaps_of_unknowns(surface, gaps);
}

/// Which node of the master faces each one of the slave.
std::vector<int> partners_of(const Interface &given, MetInterface &met)
{
   const Index n = met.slave.surface.size();
   require(given.pairing && met.master.surface.size() == n &&
              static_cast<Index>(given.pairing->partner.size()) == n &&
              given.pairing->gap.size() == n,
           met.what, ": contact surfaces of ", n, " and ", met.master.surface.size(),
           " nodes with a pairing of ", given.pairing ? given.pairing->partner.size() : 0,
           ", must be as many");
   std::set<int> taken;
   for (int partner : given.pairing->partner)
   {
      require(partner >= 0 && partner < n && taken.insert(partner).second, met.what,
              ": partner ", partner, " in the pairing, must be each of 0 to ", n - 1, " once");
   }
   return given.pairing->partner;
}

/// The row of a node on an obstacle.
ContactRow row_on_obstacle(const CondensedBody &body, const NodeOfBody &slave,
                           const SurfaceNode &node, const std::string &what)
{
   require(!is_held(body, slave.second, node.normal()), what, ": the contact node at ",
           called(node),
           " is fixed normal to the surface, so that it cannot open: end the contact before "
           "it");
   ContactRow row;
   row.slave = slave;
   row.axes = node.frame;
   for (int k : {0, 1}) { row.slides[k] = !is_held(body, slave.second, node.frame.row(k)); }
   row.shares = {{slave, 1, 1, 1}};
   return row;
}

/// The row of two nodes that face each other.
ContactRow row_of_pair(const std::vector<CondensedBody> &bodies, const NodeOfBody &slave,
                       const SurfaceNode &own, const NodeOfBody &master, const SurfaceNode &its,
                       const std::string &what)
{
   const CondensedBody &one = bodies[slave.first], &other = bodies[master.first];
   require(own.normal().dot(its.normal()) < 0, what,
           ": the bodies do not face each other at the contact node ", called(own));
   require(!is_held(one, slave.second, own.normal()) ||
              !is_held(other, master.second, its.normal()),
           what, ": the contact node at ", called(own),
           " is fixed normal to the surface in both bodies, so that it cannot open: end the "
           "contact before it");
   ContactRow row;
   row.slave = slave;
   // The first tangent is that of the second body if supports hold tangents only there.
   row.axes =
      frame_between(own.frame, its.frame,
                    any_is_held(other, master.second) && !any_is_held(one, slave.second));
   // A tangent does not slide if both bodies hold it.
   for (int k : {0, 1})
   {
      const Vector3d tangent = row.axes.row(k);
      row.slides[k] =
         !is_held(one, slave.second, tangent) || !is_held(other, master.second, tangent);
   }
   row.shares = {{slave, 1, 1, 1}, {master, -1, -1, -1}};
   return row;
}

/// The row of a contact node of the mortar, and what supports do not allow (empty: nothing).
ContactRow row_of_mortar(const std::vector<CondensedBody> &bodies, const MetInterface &met,
                         Index i, std::string &refused)
{
   const SurfaceMortar &mortar = met.surfaces;
   const int number = mortar.nodes[i];
   const SurfaceNode &own = met.slave.surface.nodes[number];
   const CondensedBody &slave = bodies[met.slave.body];
   ContactRow row;
   row.slave = {met.slave.body, met.slave.nodes[number]};
   const auto add =
      [&row](const Side &side, const SurfaceMortar::Matrix &shares, Index of, double sign)
   {
      for (SurfaceMortar::Matrix::InnerIterator e(shares, of); e; ++e)
      {
         // Round-off would connect nodes that do not face each other.
         const double share = sign * e.value();
         if (std::abs(share) <= 1e-14) { continue; }
         const NodeOfBody node(side.body, side.nodes[e.col()]);
         const auto same = [&node](const TraceShare &one) { return one.of == node; };
         const auto found = std::find_if(row.shares.begin(), row.shares.end(), same);
         if (found == row.shares.end()) { row.shares.push_back({node, share, share, share}); }
         else { *found = {node, found->x + share, found->y + share, found->z + share}; }
      }
   };
   add(met.slave, mortar.own, i, 1);
   add(met.master, mortar.other, i, -1);
   // 1. The mean normal lies in the planes in which supports hold the node.
   const int node = row.slave.second;
   Vector3d normal = mortar.normal.row(i);
   for (int k : {0, 1})
   {
      const Vector3d tangent = own.frame.row(k);
      if (is_held(slave, node, tangent)) { normal -= normal.dot(tangent) * tangent; }
   }
   normal.normalize();
   const Vector3d along = own.frame.row(0),
                  first = (along - normal.dot(along) * normal).normalized();
   row.axes << first.transpose(), normal.cross(first).transpose(), normal.transpose();
   // 2. What both sides hold along the surface does not slide.
   const std::string where = met.what + ": the contact node at " + called(own),
                     other_slave = met.of_second ? "first" : "second";
   if (is_held(slave, node, own.normal()))
   {
      refused = where +
                " is fixed normal to the surface, so that it cannot open: end the "
                "contact before it, or make the other side the slave (slave: " +
                other_slave + ")";
   }
   for (int k : {0, 1})
   {
      const Vector3d tangent = row.axes.row(k);
      if (!is_held(slave, node, tangent)) { continue; }
      row.slides[k] = false;
      bool both = false;
      for (SurfaceMortar::Matrix::InnerIterator e(mortar.other, i); e; ++e)
      {
         const SurfaceNode &its = met.master.surface.nodes[e.col()];
         const double off = std::abs((its.position - own.position).dot(tangent));
         both = both || (off <= 1e-6 * its.spacing &&
                         is_held(bodies[met.master.body], met.master.nodes[e.col()], tangent));
      }
      if (!both)
      {
         refused = where +
                   " is fixed along the surface, but the side that it faces is not: "
                   "make the other side the slave (slave: " +
                   other_slave + "), or fix it there as well";
      }
   }
   return row;
}

/// Makes the rows of sides whose nodes do not match, and says why not in `refused`.
std::vector<ContactRow> rows_with_slave(const std::vector<CondensedBody> &bodies,
                                        JoinedNodes &joined, MetInterface &met,
                                        std::string &refused)
{
   std::vector<ContactRow> rows;
   met.without_row.clear();
   // Each node without a row passes its part to others, whose rows may then close a ring.
   for (bool again = true; again;)
   {
      again = false;
      rows.clear();
      refused.clear();
      met.surfaces = mortar(met.slave.surface, met.master.surface, met.without_row, met.what);
      JoinedNodes trial = joined;
      for (Index i = 0; i < static_cast<Index>(met.surfaces.nodes.size()); ++i)
      {
         std::string why;
         rows.push_back(row_of_mortar(bodies, met, i, why));
         if (refused.empty()) { refused = why; }
         // A node of both sides, such as the tip of a crack, would depend on itself. Nodes of
         // the slave's own faces that have rows of other interfaces form no ring, because these
         // rows are of other parts of the faces.
         std::vector<NodeOfBody> by;
         for (const TraceShare &share : rows.back().shares)
         {
            const bool is_own = share.of.first == met.slave.body,
                       faces_itself = is_own && met.slave.body == met.master.body &&
                                      std::count(met.master.nodes.begin(),
                                                 met.master.nodes.end(), share.of.second);
            if (!is_own || faces_itself) { by.push_back(share.of); }
         }
         if (trial.determine(rows.back().slave, by)) { continue; }
         met.without_row.push_back(met.surfaces.nodes[i]);
         again = true;
      }
      if (!again && refused.empty()) { joined = std::move(trial); }
   }
   return rows;
}

/** The slave is the side that lies within the other one, else the coarser one, whose nodes are
    farther apart in the geometric mean, else the first, unless the caller named it. If supports
    do not let it be the slave, the other side is. If they let neither, `refused` says why, and
    nothing is joined. */
std::vector<ContactRow> rows_of_mortar(const std::vector<CondensedBody> &bodies,
                                       JoinedNodes &joined, MetInterface &met,
                                       std::string &refused)
{
   const Interface &given = *met.given;
   const bool free = given.slave == SlaveSide::coarser || given.slave == SlaveSide::finer;
   const auto exchange = [&met]
   {
      std::swap(met.slave, met.master);
      met.of_second = !met.of_second;
   };
   if (free)
   {
      const auto within = [&met](const Side &one, const Side &other)
      { return is_within(one.surface, other.surface, met.what); };
      const bool first = within(met.slave, met.master), second = within(met.master, met.slave);
      const auto spacing = [](const ContactSurface &surface)
      {
         double sum = 0;
         for (const SurfaceNode &node : surface.nodes) { sum += std::log(node.spacing); }
         return sum / static_cast<double>(surface.size());
      };
      const auto stiffness = [&bodies](const Side &side)
      {
         const VectorXd all = bodies[side.body].S.diagonal();
         const Index n = all.size() / 3;
         return (all.head(n) + all.segment(n, n) + all.tail(n))(side.nodes).sum();
      };
      const double coarser = spacing(met.master.surface) - spacing(met.slave.surface),
                   same = 0.01; // more than round-off
      const bool by_spacing = std::abs(coarser) <= same
                                 ? stiffness(met.slave) > 10 * stiffness(met.master)
                              : given.slave == SlaveSide::coarser ? coarser > 0
                                                                  : coarser < 0;
      if (first == second ? by_spacing : second) { exchange(); }
   }
   // A side none of whose nodes can have a row is refused, unless the other side can.
   const auto attempt = [&](MetInterface &of, JoinedNodes &nodes, std::string &why)
   {
      try
      {
         return rows_with_slave(bodies, nodes, of, why);
      }
      catch (const InputError &error)
      {
         if (!free) { throw; }
         why = error.what();
         return std::vector<ContactRow>();
      }
   };
   const JoinedNodes before = joined;
   std::vector<ContactRow> rows = attempt(met, joined, refused);
   // Interfaces may end within faces of this side, so that the first of them has their nodes.
   const double lost = met.surfaces.given_away;
   if (free && refused.empty() && lost > 0.05 * met.surfaces.weights.sum())
   {
      MetInterface turned = met;
      std::swap(turned.slave, turned.master);
      turned.of_second = !turned.of_second;
      JoinedNodes its = before;
      std::string why;
      std::vector<ContactRow> other = attempt(turned, its, why);
      if (why.empty() && turned.surfaces.given_away < 0.5 * lost)
      {
         met = std::move(turned);
         joined = std::move(its);
         rows = std::move(other);
      }
   }
   if (!refused.empty() && free)
   {
      exchange();
      std::string other;
      rows = attempt(met, joined, other);
      if (other.empty()) { refused.clear(); }
   }
   if (!refused.empty()) { return {}; }
   const SurfaceMortar &found = met.surfaces;
   met.mortar.nodes = found.nodes;
   met.mortar.weights = found.weights;
   met.mortar.gap = found.gap;
   for (Index i = 0; i < found.gap.size() && !given.gap && !given.node_gaps; ++i)
   {
      const double most = given.most_overlap * found.size[i];
      require(found.gap[i] >= -most, met.what, ": the sides overlap by ",
              rounded(-found.gap[i]), " at ", called(met.slave.surface.nodes[found.nodes[i]]),
              ", must be at most ", rounded(most), " (", given.most_overlap,
              " of the face's edge): ",
              found.gap[i] < -found.size[i]
                 ? "are these the sides that touch, and are the bodies in their places?"
              : given.tied ? "sides that are tied must touch: move one of them"
                           : "allow more for an interference fit, or give the gap");
   }
   if (given.gap || given.node_gaps) { met.mortar.gap = gaps_of(given, met, {})(found.nodes); }
   return rows;
}

/// The pairs of two sides, if every node has a partner.
std::optional<Pairing> matching_nodes(const ContactSurface &slave, const ContactSurface &master)
{
   if (slave.size() != master.size()) { return {}; }
   try
   {
      return pair_surfaces(slave, master);
   }
   catch (const InputError &)
   {
      return {};
   }
}

/// Are the faces between paired nodes the same on both sides (or none known)? Equal tractions
/// then give equal forces on nodes that face each other.
bool have_equal_faces(const ContactSurface &slave, const ContactSurface &master,
                      const Pairing &pairs)
{
   std::set<std::set<Index>> own, its;
   for (const std::vector<Index> &face : slave.faces)
   {
      std::set<Index> nodes;
      for (Index node : face) { nodes.insert(pairs.partner[node]); }
      own.insert(nodes);
   }
   for (const std::vector<Index> &face : master.faces)
   {
      its.emplace(face.begin(), face.end());
   }
   return own == its;
}

} // namespace

NodeOfBody JoinedNodes::root(NodeOfBody node) const
{
   for (auto found = up_.find(node); found != up_.end(); found = up_.find(node))
   {
      node = found->second;
   }
   return node;
}

bool JoinedNodes::is_determined(const NodeOfBody &group) const
{
   return by_.count(group) > 0 || group == root({-1, 0});
}

bool JoinedNodes::depends(const NodeOfBody &one, const NodeOfBody &other) const
{
   std::set<NodeOfBody> seen;
   std::vector<NodeOfBody> open{one};
   while (!open.empty())
   {
      const NodeOfBody next = open.back();
      open.pop_back();
      if (next == other) { return true; }
      const auto found = by_.find(next);
      if (found == by_.end() || !seen.insert(next).second) { continue; }
      for (const NodeOfBody &node : found->second) { open.push_back(root(node)); }
   }
   return false;
}

bool JoinedNodes::join(const NodeOfBody &one, const NodeOfBody &other)
{
   const NodeOfBody a = root(one), b = root(other);
   const bool both = is_determined(a) && is_determined(b);
   if (both || depends(a, b) || depends(b, a)) { return false; }
   up_[a] = b;
   if (const auto found = by_.find(a); found != by_.end())
   {
      by_[b] = found->second;
      by_.erase(a);
   }
   return true;
}

bool JoinedNodes::determine(const NodeOfBody &slave, const std::vector<NodeOfBody> &by)
{
   const NodeOfBody group = root(slave);
   if (is_determined(group)) { return false; }
   for (const NodeOfBody &node : by)
   {
      if (depends(root(node), group)) { return false; }
   }
   by_[group] = by;
   return true;
}

std::vector<ContactRow> rows_on_surfaces(const Interface &given,
                                         const std::vector<CondensedBody> &bodies,
                                         JoinedNodes &joined, MetInterface &met)
{
   const bool on_obstacle = given.second.body < 0;
   const bool turned = !on_obstacle && !given.pairing && given.slave == SlaveSide::second;
   met.given = &given;
   met.what = "interface '" + given.name + "' of " + called(bodies, given.first.body) +
              " and " + called(bodies, given.second.body);
   met.of_second = turned;
   const auto count = static_cast<int>(bodies.size());
   for (const InterfaceSide *side : {&given.first, &given.second})
   {
      require(side->body >= (side == &given.first ? 0 : -1) && side->body < count, met.what,
              ": a side is of body ", side->body, ", must be from 0 to ", count - 1,
              ", or -1 for a rigid obstacle as the second");
   }
   met.slave = surface_side(turned ? given.second : given.first, bodies, met.what);
   std::vector<int> partners;
   VectorXd gaps = VectorXd::Zero(met.slave.surface.size());
   if (!on_obstacle)
   {
      met.master = surface_side(turned ? given.first : given.second, bodies, met.what);
      Interface paired = given;
      if (!paired.pairing)
      {
         paired.pairing = matching_nodes(met.slave.surface, met.master.surface);
         if (!paired.pairing ||
             !have_equal_faces(met.slave.surface, met.master.surface, *paired.pairing))
         {
            std::string refused;
            std::vector<ContactRow> made = rows_of_mortar(bodies, joined, met, refused);
            if (refused.empty()) { return made; }
            // Nodes that face each other meet one by one where supports of both sides let
            // neither be the slave.
            require(paired.pairing.has_value(), refused);
            paired.pairing = matching_nodes(met.slave.surface, met.master.surface);
            met.surfaces = {};
            met.without_row.clear();
            gaps.setZero(met.slave.surface.size());
         }
      }
      partners = partners_of(paired, met);
      gaps = paired.pairing->gap;
   }
   gaps = gaps_of(given, met, gaps);
   std::vector<ContactRow> rows;
   std::vector<double> weights, kept;
   for (int i = 0; i < static_cast<int>(met.slave.nodes.size()); ++i)
   {
      const SurfaceNode &own = met.slave.surface.nodes[i];
      const NodeOfBody slave(met.slave.body, met.slave.nodes[i]);
      const NodeOfBody master = on_obstacle
                                   ? NodeOfBody(-1, 0)
                                   : NodeOfBody(met.master.body, met.master.nodes[partners[i]]);
      // Nodes that other rows hold together already. The tip of a crack, for instance, is one
      // node.
      if (slave == master || !joined.join(slave, master))
      {
         met.without_row.push_back(i);
         continue;
      }
      if (on_obstacle)
      {
         rows.push_back(row_on_obstacle(bodies[slave.first], slave, own, met.what));
         weights.push_back(own.weight);
      }
      else
      {
         const SurfaceNode &its = met.master.surface.nodes[partners[i]];
         rows.push_back(row_of_pair(bodies, slave, own, master, its, met.what));
         weights.push_back((own.weight + its.weight) / 2);
         met.facing.push_back(partners[i]);
      }
      met.mortar.nodes.push_back(i);
      kept.push_back(gaps[i]);
   }
   require(!rows.empty(), met.what,
           ": all of its nodes are joined by other interfaces already, each place where two "
           "sides meet must be named once");
   met.mortar.weights =
      Eigen::Map<VectorXd>(weights.data(), static_cast<Index>(weights.size()));
   met.mortar.gap = Eigen::Map<VectorXd>(kept.data(), static_cast<Index>(kept.size()));
   return rows;
}

void require_dependents(const std::vector<CondensedBody> &bodies,
                        const std::vector<ContactRow> &rows)
{
   std::set<std::pair<NodeOfBody, int>> taken;
   for (const ContactRow &row : rows)
   {
      for (int c = 0; c < 3; ++c)
      {
         const NodeOfBody &node = row.dependent[c];
         const bool its = !holds(bodies[node.first], node.second, row.component[c]);
         const bool slides = c == 2 || row.slides[c];
         require((its || !slides) && (!its || taken.emplace(node, row.component[c]).second),
                 "reduce: several interfaces meet at the node ",
                 called(bodies[row.slave.first].surface.nodes[row.slave.second]), " of ",
                 called(bodies, row.slave.first),
                 ", and their rows cannot be told apart there: exchange the two sides of one "
                 "of them");
      }
   }
}

InterfaceReport report_on_surfaces(const MetInterface &met, const std::vector<ContactRow> &rows)
{
   InterfaceReport report;
   report.name = met.given->name;
   report.bodies = {met.slave.body, met.master.body};
   report.nodes = met.nodes();
   report.tied = met.given->tied;
   report.of_second = met.of_second;
   report.matching = !met.facing.empty();
   report.weights = met.mortar.weights;
   report.spacing.resize(report.nodes);
   report.turn = VectorXd::Zero(report.nodes);
   report.frames.resize(report.nodes, 9);
   report.places.resize(report.nodes, 3);
   for (Index i = 0; i < report.nodes; ++i)
   {
      const SurfaceNode &node = met.slave.surface.nodes[met.mortar.nodes[i]];
      const Matrix3d &axes = rows[i].axes;
      report.frames.row(i) << axes.row(0), axes.row(1), axes.row(2);
      report.places.row(i) = node.position;
      report.spacing[i] = node.spacing;
      if (met.facing.empty()) { continue; }
      const Vector3d normal = met.master.surface.nodes[met.facing[i]].normal();
      report.turn[i] =
         std::atan2(node.normal().cross(-normal).norm(), node.normal().dot(-normal));
   }
   if (met.surfaces.nodes.size() > 0)
   {
      report.turn = met.surfaces.turn;
      // A given gap is that of the sides as they are meant.
      const bool given = met.given->gap || met.given->node_gaps;
      report.chords = given ? VectorXd(VectorXd::Zero(report.nodes)) : met.surfaces.chords;
      report.left_out = met.surfaces.left_out;
   }
   for (int k : met.without_row)
   {
      report.in_rings.push_back(met.slave.surface.nodes[k].position);
   }
   return report;
}

void add_surface_facts(ReducedProblem &problem, Index first, const MetInterface &met)
{
   const Index n = met.nodes();
   problem.gap.segment(first, n) = met.mortar.gap;
   problem.weights.segment(first, n) = met.mortar.weights;
   for (Index i = 0; i < n; ++i)
   {
      const SurfaceNode &node = met.slave.surface.nodes[met.mortar.nodes[i]];
      problem.position.row(first + i) = node.position;
      for (int c = 0; c < 3; ++c)
      {
         problem.dofs(first + i, 3 * met.slave.body + c) = node.dofs[c];
         if (met.facing.empty()) { continue; }
         problem.dofs(first + i, 3 * met.master.body + c) =
            met.master.surface.nodes[met.facing[i]].dofs[c];
      }
   }
}

Reduction reduce(CondensedBody body, const VectorXd &gap)
{
   require(body.line.formulation == Formulation::space,
           "reduce: gaps of each node are for a body in space, the body is ",
           name(body.line.formulation), ", whose gap is a function of the place");
   require(gap.size() == body.nodes(), "reduce: ", gap.size(), " gaps for ", body.nodes(),
           " contact nodes, must be as many");
   Interface contact;
   contact.first.body = 0;
   contact.first.surface = body.surface;
   contact.node_gaps = gap;
   std::vector<CondensedBody> bodies;
   bodies.push_back(std::move(body));
   return reduce(std::move(bodies), std::vector<Interface>{contact});
}

} // namespace cattaneo
