#include <algorithm>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/curve_gaps.hpp>
#include <cattaneo/reduced/interface_rows.hpp>
#include <cattaneo/reduced/surfaces.hpp>
#include <cattaneo/rounded.hpp>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// Nodes that relative displacements determine, with those that they depend on.
using Slaves = std::map<NodeOfBody, std::vector<NodeOfBody>>;

/// The line of the other body, if its nodes are at the same places as those of this line.
ContactLine other_face(const ContactLine &line)
{
   ContactLine made = line;
   for (LineChain &chain : made.chains)
   {
      // In a loop the first node stays the first one.
      const auto number = [first = chain.first, n = chain.nodes, loop = chain.loop](Index k)
      { return k < 0 ? k : first + (loop ? (n - (k - first)) % n : n - 1 - (k - first)); };
      const double end = line.nodes[chain.first + chain.nodes - 1].arc_length;
      for (Index k = chain.first; k < chain.first + chain.nodes; ++k)
      {
         LineNode &node = made.nodes[number(k)] = line.nodes[k];
         node.tangent = -node.tangent;
         node.arc_length = end - node.arc_length;
      }
      std::swap(chain.ends[0], chain.ends[1]);
      std::reverse(chain.elements.begin(), chain.elements.end());
      for (LineElement &element : chain.elements)
      {
         std::reverse(element.nodes.begin(), element.nodes.end());
         for (Index &node : element.nodes) { node = number(node); }
         element.points = element.points.rowwise().reverse().eval();
         for (EdgeBend *bend : {element.bend ? &*element.bend : nullptr, &element.possible})
         {
            if (bend) { *bend = {-bend->end, -bend->begin}; }
         }
      }
   }
   return made;
}

/// Makes the rows of one interface.
class RowsOfInterface
{
public:
   RowsOfInterface(const Interface &given, const std::vector<CondensedBody> &bodies);

   /// Adds the rows, and marks their nodes as taken.
   void add_to(std::vector<ContactRow> &rows, Slaves &taken);
   MetInterface met;

private:
   Side side(const InterfaceSide &given) const;
   void add_curves(const ContactLine &other, const std::vector<int> &partner);
   void face_all();
   void pair_nodes();
   void meet();
   const int *faced(Index i, const Vector2d &tangent) const;
   const CondensedBody &slave_body() const { return bodies_[met.slave.body]; }
   /// The node that a node of the slave is paired with; none without a pairing.
   std::optional<NodeOfBody> partner(int node) const;
   /// Does a support hold a component of the node that a node of the slave is paired with? True
   /// without a pairing.
   bool partner_holds(int node, int component) const;
   std::vector<int> clamped_ends() const;
   ContactRow row(Index i) const;
   std::string refusal(const ContactRow &row, Index i) const;
   bool depends_on_itself(const std::vector<NodeOfBody> &determined,
                          const std::vector<NodeOfBody> &on, const Slaves &slaves) const;
   bool can_be_slave(const Slaves &taken, bool in_rings);

   const Interface &given_;
   const std::vector<CondensedBody> &bodies_;
   // What can_be_slave() finds.
   std::vector<ContactRow> rows_;
   Slaves taken_;
   std::string refused_;
};

RowsOfInterface::RowsOfInterface(const Interface &given,
                                 const std::vector<CondensedBody> &bodies)
   : given_(given), bodies_(bodies)
{
   met.given = &given;
   met.what = "interface '" + given.name + "'";
   const auto count = static_cast<int>(bodies.size());
   for (const InterfaceSide *side : {&given.first, &given.second})
   {
      require(side->body >= (side == &given.first ? 0 : -1) && side->body < count, met.what,
              ": a side names body ", side->body, ", must be from 0 to ", count - 1,
              ", or -1 for a rigid obstacle as the second side");
   }
   met.what +=
      " of " + called(bodies, given.first.body) + " and " + called(bodies, given.second.body);
   met.slave = side(given.first);
   if (given.second.body < 0) { return; }
   met.master = side(given.second);
   const auto spacing = [](const ContactLine &line)
   { return line.each(&LineNode::spacing).array().log().mean(); };
   const double coarser = spacing(met.master.line) - spacing(met.slave.line);
   const double same = 0.01; // more than round-off
   if (given.pairing) { return; }
   // If nodes are as near to each other on both sides, a slave that is much stiffer loses
   // digits.
   const auto stiffness = [&bodies](const Side &side)
   {
      const Eigen::VectorXd own = bodies[side.body].S.diagonal();
      const Index n = own.size() / 2;
      return (own.head(n) + own.tail(n))(side.nodes).sum();
   };
   const bool much_stiffer =
      std::abs(coarser) <= same &&
      (given.slave == SlaveSide::coarser || given.slave == SlaveSide::finer) &&
      stiffness(met.slave) > 10 * stiffness(met.master);
   if (given.slave == SlaveSide::second || much_stiffer ||
       (given.slave == SlaveSide::coarser && coarser > same) ||
       (given.slave == SlaveSide::finer && coarser < -same))
   {
      std::swap(met.slave, met.master);
      met.of_second = true;
   }
}

Side RowsOfInterface::side(const InterfaceSide &given) const
{
   const CondensedBody &body = bodies_[given.body];
   std::map<std::array<int, 2>, int> number;
   for (Index k = 0; k < body.line.size(); ++k)
   {
      number[body.line.nodes[k].dofs] = static_cast<int>(k);
   }
   given.line.validate();
   Side made{given.body, given.line, {}};
   meet_supports(made.line, body);
   for (const LineNode &node : made.line.nodes)
   {
      const auto found = number.find(node.dofs);
      // Numbers of dofs may coincide with those of other bodies, so places are compared too.
      const bool same = found != number.end() &&
                        (body.line.nodes[found->second].position - node.position).norm() <=
                           1e-9 * node.spacing;
      require(same, met.what, ": ", called(bodies_, given.body),
              " was not condensed to the node ", node.position,
              ", must be condensed to the nodes of all of its interfaces "
              "(joined())");
      made.nodes.push_back(found->second);
   }
   return made;
}

/// One to one, with frames and weights between those of both sides.
void RowsOfInterface::pair_nodes()
{
   face_all();
   const Index n = met.slave.line.size();
   const Pairing &pairs = *given_.pairing;
   require(static_cast<Index>(pairs.partner.size()) == n && pairs.gap.size() == n, met.what,
           ": its pairing has ", pairs.partner.size(),
           " nodes, must have those of its first side, ", n);
   std::set<int> taken;
   for (int partner : pairs.partner)
   {
      require(partner >= 0 && partner < met.master.line.size() && taken.insert(partner).second,
              met.what, ": partner ", partner, " in the pairing, must be each of 0 to ",
              met.master.line.size() - 1, " once");
   }
   for (Mortar::Matrix &other : met.mortar.other)
   {
      other.resize(static_cast<Index>(met.mortar.nodes.size()), met.master.line.size());
      for (std::size_t i = 0; i < met.mortar.nodes.size(); ++i)
      {
         const int partner = pairs.partner[met.mortar.nodes[i]];
         other.insert(static_cast<Index>(i), partner) = 1;
      }
   }
   for (Index i = 0; i < met.mortar.weights.size(); ++i)
   {
      const int node = met.mortar.nodes[i], partner = pairs.partner[node];
      const LineNode &own = met.slave.line.nodes[node], &other = met.master.line.nodes[partner];
      const LineNode frame = mean_frame(own, other);
      require(frame.normal().dot(other.normal()) < 0, met.what,
              ": the bodies do not face each other at the contact node ", own.position);
      met.mortar.weights[i] = 0.5 * (own.weight + other.weight);
      met.mortar.tangent.row(i) = frame.tangent;
      met.mortar.turn[i] = angle_between(own.tangent, -other.tangent);
   }
   met.mortar.gap = pairs.gap(met.mortar.nodes);
   add_curves(met.master.line, pairs.partner);
}

/// Adds to the gaps from node to node the distances between the chords and the smooth curves.
/// For an obstacle the other line is empty.
void RowsOfInterface::add_curves(const ContactLine &other, const std::vector<int> &partner)
{
   const CurveGaps curves =
      curve_gaps(met.slave.line, met.mortar.nodes, met.mortar.tangent, other, partner);
   met.mortar.gap += curves.moved;
   for (Index i = 0; i < met.mortar.gap.size(); ++i) // round-off of equal changes on both sides
   {
      const double least = 1e-9 * met.slave.line.nodes[met.mortar.nodes[i]].spacing;
      if (std::abs(met.mortar.gap[i]) <= least) { met.mortar.gap[i] = 0; }
   }
   met.mortar.chords = curves.left;
   met.mortar.curved = curves.curved;
}

void RowsOfInterface::meet()
{
   const std::vector<int> &without = met.without_row;
   if (given_.pairing)
   {
      pair_nodes();
      return;
   }
   if (met.master.body >= 0)
   {
      met.mortar = mortar(met.slave.line, met.master.line, without, met.what);
      for (Index i = 0; i < met.mortar.gap.size() && !given_.gap && !given_.tied; ++i)
      {
         const double most = given_.most_overlap * met.mortar.size[i];
         require(met.mortar.gap[i] >= -most, met.what, ": the sides overlap by ",
                 rounded(-met.mortar.gap[i]), " at ",
                 rounded(met.slave.line.nodes[met.mortar.nodes[i]].position),
                 ", must be at most ", rounded(most), " (", given_.most_overlap,
                 " of the element's length): ",
                 met.mortar.gap[i] < -met.mortar.size[i]
                    ? "are these the sides that touch, and are the bodies in their places?"
                    : "allow more for an interference fit, or give the gap");
      }
      return;
   }
   const auto &chains = met.slave.line.chains;
   if (without.empty() || std::any_of(chains.begin(), chains.end(),
                                      [](const LineChain &c) { return c.elements.empty(); }))
   {
      face_all();
      add_curves({}, {});
      return;
   }
   // Also on an obstacle neighbours carry the force of a node without a row. The obstacle takes
   // the place of the other line, and does not move.
   met.mortar = mortar(met.slave.line, other_face(met.slave.line), without, met.what);
   for (Mortar::Matrix &other : met.mortar.other)
   {
      other = Mortar::Matrix(met.mortar.gap.size(), 0);
   }
   add_curves({}, {});
   met.mortar.gap.setZero();
   met.mortar.arm.setZero();
}

/// All nodes of the slave have a row, so far without shares of the other side.
void RowsOfInterface::face_all()
{
   const std::vector<int> &without = met.without_row;
   const ContactLine &line = met.slave.line;
   met.mortar = Mortar();
   for (Index k = 0; k < line.size(); ++k)
   {
      if (!std::count(without.begin(), without.end(), int(k)))
      {
         met.mortar.nodes.push_back(static_cast<int>(k));
      }
   }
   const auto n = static_cast<Index>(met.mortar.nodes.size());
   for (Mortar::Matrix &own : met.mortar.own)
   {
      own.resize(n, line.size());
      for (Index i = 0; i < n; ++i) { own.insert(i, met.mortar.nodes[i]) = 1; }
   }
   for (Mortar::Matrix &other : met.mortar.other) { other.resize(n, 0); }
   met.mortar.tangent = line.each(&LineNode::tangent)(met.mortar.nodes, Eigen::all);
   met.mortar.weights = line.each(&LineNode::weight)(met.mortar.nodes);
   met.mortar.gap = met.mortar.arm = met.mortar.turn = met.mortar.chords = met.mortar.curved =
      Eigen::VectorXd::Zero(n);
}

/// A node of the master that is at the same place along a tangent as a row's node, the nearest
/// one; or none.
const int *RowsOfInterface::faced(Index i, const Vector2d &tangent) const
{
   const Vector2d &place = met.slave.line.nodes[met.mortar.nodes[i]].position;
   const LineNode *nearest = nullptr;
   const int *found = nullptr;
   for (std::size_t m = 0; m < met.master.nodes.size(); ++m)
   {
      const LineNode &node = met.master.line.nodes[m];
      const double off = std::abs((node.position - place).dot(tangent));
      if (off <= 1e-6 * node.spacing &&
          (!nearest || (node.position - place).norm() < (nearest->position - place).norm()))
      {
         nearest = &node;
         found = &met.master.nodes[m];
      }
   }
   return found;
}

std::optional<NodeOfBody> RowsOfInterface::partner(int node) const
{
   if (!given_.pairing || met.master.body < 0) { return std::nullopt; }
   const std::vector<int> &partners = given_.pairing->partner;
   const bool known = node < static_cast<int>(partners.size()) && partners[node] >= 0 &&
                      partners[node] < static_cast<int>(met.master.nodes.size());
   if (!known) { return std::nullopt; } // which pair_nodes() refuses
   return NodeOfBody(met.master.body, met.master.nodes[partners[node]]);
}

bool RowsOfInterface::partner_holds(int node, int component) const
{
   const std::optional<NodeOfBody> other = partner(node);
   return !other || holds(bodies_[other->first], other->second, component);
}

/// Ends of the slave that supports hold in both components. Nodes that cannot move have no row,
/// unless the node that they are paired with can move perpendicular to the line.
std::vector<int> RowsOfInterface::clamped_ends() const
{
   std::vector<int> found;
   for (const LineChain &chain : met.slave.line.chains)
   {
      const auto clamped = [&](Index k)
      {
         const auto node = static_cast<int>(k);
         return !chain.loop && holds(slave_body(), met.slave.nodes[k], 0) &&
                holds(slave_body(), met.slave.nodes[k], 1) && partner_holds(node, 1);
      };
      const Index last = chain.first + chain.nodes - 1;
      if (clamped(chain.first)) { found.push_back(static_cast<int>(chain.first)); }
      if (last > chain.first && clamped(last)) { found.push_back(static_cast<int>(last)); }
   }
   return found;
}

ContactRow RowsOfInterface::row(Index i) const
{
   const int node = met.mortar.nodes[i], k = met.slave.nodes[node];
   ContactRow made;
   made.slave = {met.slave.body, k};
   made.tangent = met.mortar.tangent.row(i);
   made.slides[0] = !holds(slave_body(), k, 0) || !partner_holds(node, 0);
   const auto on_axes = [](const LineNode &at)
   { return at.tangent.cwiseAbs().minCoeff() == 0; };
   if (!made.slides[0] && on_axes(met.slave.line.nodes[node]))
   {
      // If both sides end at the same plane of symmetry, the plane is perpendicular to the
      // contact. The mean of the normals near the node need not lie in the plane.
      const int *other = faced(i, met.slave.line.nodes[node].tangent);
      if (!other || on_axes(bodies_[met.master.body].line.nodes[*other]))
      {
         made.tangent = met.slave.line.nodes[node].tangent;
      }
   }
   std::map<NodeOfBody, Vector2d> shares;
   for (int c : {0, 1})
   {
      for (Mortar::Matrix::InnerIterator e(met.mortar.own[c], i); e; ++e)
      {
         shares.try_emplace({met.slave.body, met.slave.nodes[e.col()]}, 0, 0)
            .first->second[c] += e.value();
      }
      for (Mortar::Matrix::InnerIterator e(met.mortar.other[c], i); e; ++e)
      {
         shares.try_emplace({met.master.body, met.master.nodes[e.col()]}, 0, 0)
            .first->second[c] -= e.value();
      }
   }
   for (const auto &[of, share] : shares)
   {
      // Round-off of functions that only touch the part would connect nodes that do not face
      // each other.
      if (share.cwiseAbs().maxCoeff() <= 1e-14) { continue; }
      made.shares.push_back({of, share[0], share[1]});
   }
   return made;
}

/// Why supports do not let a node carry a row; empty if they do.
std::string RowsOfInterface::refusal(const ContactRow &row, Index i) const
{
   const int node = met.mortar.nodes[i];
   const Vector2d &place = met.slave.line.nodes[node].position;
   const std::string where = met.what + ": the contact node at " + as_text(place),
                     other_slave = met.of_second ? "first" : "second";
   if (holds(slave_body(), row.slave.second, 1) && partner_holds(node, 1))
   {
      return where +
             " is fixed normal to the line, so that it cannot open: end the contact line "
             "before it, or make the other side the slave (slave: " +
             other_slave + ")";
   }
   if (row.slides[0] || met.master.body < 0 || given_.pairing) { return {}; }
   const int *other = faced(i, row.tangent);
   if (other && holds(bodies_[met.master.body], *other, 0)) { return {}; }
   return where +
          " is fixed along the line, but the side that it faces is not: make the other side "
          "the slave (slave: " +
          other_slave + "), or fix it there as well";
}

/// Do some nodes depend, directly or through others, on a node that they determine?
bool RowsOfInterface::depends_on_itself(const std::vector<NodeOfBody> &determined,
                                        const std::vector<NodeOfBody> &on,
                                        const Slaves &slaves) const
{
   std::set<NodeOfBody> seen;
   std::vector<NodeOfBody> open = on;
   while (!open.empty())
   {
      const NodeOfBody next = open.back();
      open.pop_back();
      if (!seen.insert(next).second) { continue; }
      const auto found = slaves.find(next);
      if (found == slaves.end()) { continue; }
      for (const NodeOfBody &node : determined)
      {
         if (std::count(found->second.begin(), found->second.end(), node) > 0) { return true; }
      }
      open.insert(open.end(), found->second.begin(), found->second.end());
   }
   return false;
}

void RowsOfInterface::add_to(std::vector<ContactRow> &rows, Slaves &taken)
{
   if (!can_be_slave(taken, true))
   {
      const bool free = given_.slave == SlaveSide::coarser || given_.slave == SlaveSide::finer;
      const std::string refused = refused_; // of the side that should be the slave
      require(free && met.master.body >= 0 && !given_.pairing, refused);
      std::swap(met.slave, met.master);
      met.of_second = !met.of_second;
      // A ring here would come from a place that is named twice, with the sides exchanged.
      require(can_be_slave(taken, false), refused);
   }
   taken = std::move(taken_);
   for (std::size_t i = 0; i < rows_.size(); ++i)
   {
      met.mortar.tangent.row(static_cast<Index>(i)) = rows_[i].tangent;
      rows.push_back(std::move(rows_[i]));
   }
}

/// Can the nodes of the slave carry the rows? Not if supports hold them, or if other rows
/// determine all of them; `in_rings`: nodes that would depend on themselves are left out. Makes
/// the rows, or says why not.
bool RowsOfInterface::can_be_slave(const Slaves &taken, bool in_rings)
{
   const auto place = [this](int node)
   { return NodeOfBody(met.slave.body, met.slave.nodes[node]); };
   std::vector<int> &without = met.without_row = clamped_ends();
   for (int k = 0; k < static_cast<int>(met.slave.nodes.size()); ++k)
   {
      if (taken.count(place(k)) && !std::count(without.begin(), without.end(), k))
      {
         without.push_back(k);
      }
   }
   // Each node without a row passes its part to its neighbours, and their rows may then close a
   // ring.
   for (std::size_t before = without.size() + 1; without.size() != before;)
   {
      if (without.size() >= met.slave.nodes.size())
      {
         refused_ =
            met.what + ": all nodes of " + called(bodies_, met.slave.body) +
            " there are in contact by earlier interfaces, or would close a ring of interfaces: "
            "name each place where two sides meet once, or make the other side "
            "the slave (slave: " +
            (met.of_second ? "first" : "second") + ")";
         return false;
      }
      meet();
      taken_ = taken;
      rows_.clear();
      before = without.size();
      for (Index i = 0; i < met.nodes(); ++i)
      {
         const int number = met.mortar.nodes[i];
         rows_.push_back(row(i));
         const ContactRow &made = rows_.back();
         // Where supports hold the slave, the row determines the displacement of its partner
         // instead.
         std::vector<NodeOfBody> determined{made.slave};
         const auto needs = [&](int component)
         {
            return holds(slave_body(), made.slave.second, component) &&
                   !partner_holds(number, component);
         };
         if (const std::optional<NodeOfBody> other = partner(number); needs(0) || needs(1))
         {
            require(taken_.count(*other) == 0, met.what, ": the node of ",
                    called(bodies_, other->first), " at ",
                    bodies_[other->first].line.nodes[other->second].position,
                    " is in contact in another interface too, and supports hold the node that "
                    "faces it here: the other interface must end before this node");
            const bool alone = !partner_holds(number, 0) && !partner_holds(number, 1);
            if (alone) { determined = {*other}; }
            else { determined.push_back(*other); }
         }
         std::vector<NodeOfBody> on;
         for (const TraceShare &share : made.shares)
         {
            if (std::count(determined.begin(), determined.end(), share.of) == 0)
            {
               on.push_back(share.of);
            }
         }
         // A tip belongs to both sides. If they match it would face itself, and its shares
         // cancel.
         const bool tip = met.slave.body == met.master.body &&
                          std::count(met.master.nodes.begin(), met.master.nodes.end(),
                                     met.slave.nodes[number]) > 0,
                    on_itself = tip || depends_on_itself(determined, on, taken_);
         if (on_itself && !tip && !in_rings)
         {
            refused_ = met.what + ": its contact nodes would close a ring of interfaces";
            return false;
         }
         if (on_itself) { without.push_back(number); }
         for (const NodeOfBody &node : determined)
         {
            if (!on_itself) { taken_[node] = on; }
         }
      }
   }
   for (Index i = 0; i < met.nodes(); ++i)
   {
      refused_ = refusal(rows_[i], i);
      if (!refused_.empty()) { return false; }
   }
   return true;
}

} // namespace

std::vector<ContactRow> rows_of(const std::vector<Interface> &interfaces,
                                const std::vector<CondensedBody> &bodies,
                                std::vector<MetInterface> &met)
{
   for (const CondensedBody &body : bodies)
   {
      require(body.line.formulation == bodies[0].line.formulation &&
                 body.line.formulation != Formulation::torsion,
              "reduce: the bodies must be all plane, all axisymmetric or all in space (add "
              "torsion to their reduction)");
   }
   // A node of several interfaces belongs to the first of them. Ties come before all others,
   // because a node where a tie and a contact meet cannot open.
   std::vector<std::size_t> order(interfaces.size());
   std::iota(order.begin(), order.end(), 0);
   std::stable_partition(order.begin(), order.end(),
                         [&](std::size_t k) { return interfaces[k].tied; });
   std::vector<std::vector<ContactRow>> rows_of_each(interfaces.size());
   met.resize(interfaces.size());
   const bool in_space = bodies[0].line.formulation == Formulation::space;
   Slaves taken;
   JoinedNodes joined;
   std::set<int> touched;
   for (const std::size_t k : order)
   {
      if (in_space)
      {
         rows_of_each[k] = rows_on_surfaces(interfaces[k], bodies, joined, met[k]);
      }
      else
      {
         RowsOfInterface made(interfaces[k], bodies);
         made.add_to(rows_of_each[k], taken);
         met[k] = std::move(made.met);
      }
      touched.insert({interfaces[k].first.body, interfaces[k].second.body});
   }
   std::vector<ContactRow> rows;
   for (std::vector<ContactRow> &its : rows_of_each)
   {
      std::move(its.begin(), its.end(), std::back_inserter(rows));
   }
   for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
   {
      require(touched.count(b), "reduce: ", called(bodies, b),
              " is in no interface, so nothing touches it: name an interface for it, or leave "
              "it out");
   }
   choose_dependents(bodies, rows);
   if (in_space) { require_dependents(bodies, rows); }
   return rows;
}

} // namespace cattaneo
