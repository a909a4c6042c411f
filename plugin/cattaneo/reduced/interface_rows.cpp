#include <algorithm>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/curve_gaps.hpp>
#include <cattaneo/reduced/interface_rows.hpp>
#include <cmath>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// The line of a body that lies against this one with nodes at the same places.
ContactLine other_face(const ContactLine &line)
{
   ContactLine made = line;
   for (LineChain &chain : made.chains)
   {
      // Of a loop the first node stays the first.
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

} // namespace

std::vector<int> clamped_ends(const CondensedBody &body, const ContactLine &line,
                              const std::vector<int> &nodes)
{
   std::vector<int> found;
   for (const LineChain &chain : line.chains)
   {
      const auto clamped = [&](Index k)
      { return !chain.loop && holds(body, nodes[k], 0) && holds(body, nodes[k], 1); };
      const Index last = chain.first + chain.nodes - 1;
      if (clamped(chain.first)) { found.push_back(static_cast<int>(chain.first)); }
      if (last > chain.first && clamped(last)) { found.push_back(static_cast<int>(last)); }
   }
   return found;
}

InterfaceRows::InterfaceRows(const Interface &given, const std::vector<CondensedBody> &bodies)
   : given_(given), bodies_(bodies)
{
   what_ = "interface '" + given.name + "'";
   const auto count = static_cast<int>(bodies.size());
   for (const InterfaceSide *side : {&given.first, &given.second})
   {
      require(side->body >= (side == &given.first ? 0 : -1) && side->body < count, what_,
              ": a side is of body ", side->body, ", must be from 0 to ", count - 1,
              ", or -1 for a rigid obstacle as the second");
   }
   what_ +=
      " of " + called(bodies, given.first.body) + " and " + called(bodies, given.second.body);
   slave_ = side(given.first);
   if (given.second.body < 0) { return; }
   master_ = side(given.second);
   const auto spacing = [](const ContactLine &line)
   { return line.each(&LineNode::spacing).array().log().mean(); };
   const double coarser = spacing(master_.line) - spacing(slave_.line);
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
      stiffness(slave_) > 10 * stiffness(master_);
   if (given.slave == SlaveSide::second || much_stiffer ||
       (given.slave == SlaveSide::coarser && coarser > same) ||
       (given.slave == SlaveSide::finer && coarser < -same))
   {
      std::swap(slave_, master_);
      of_second_ = true;
   }
}

Side InterfaceRows::side(const InterfaceSide &given) const
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
      // Dofs alone are numbers that other bodies have too.
      const bool same = found != number.end() &&
                        (body.line.nodes[found->second].position - node.position).norm() <=
                           1e-9 * node.spacing;
      require(same, what_, ": the node ", node.position, " is none that ",
              called(bodies_, given.body),
              " was condensed to, it must be condensed to the nodes of all of its interfaces "
              "(joined())");
      made.nodes.push_back(found->second);
   }
   return made;
}

/// One to one, with frames and weights between those of both sides.
void InterfaceRows::pair_nodes(const std::vector<int> &without)
{
   face_all(without);
   const Index n = slave_.line.size();
   const Pairing &pairs = *given_.pairing;
   require(static_cast<Index>(pairs.partner.size()) == n && pairs.gap.size() == n, what_,
           ": its pairing is of ", pairs.partner.size(), " nodes, must be of the ", n,
           " of its first side");
   for (Mortar::Matrix &other : mortar_.other)
   {
      other.resize(static_cast<Index>(mortar_.nodes.size()), master_.line.size());
      for (std::size_t i = 0; i < mortar_.nodes.size(); ++i)
      {
         const int partner = pairs.partner[mortar_.nodes[i]];
         require(partner >= 0 && partner < master_.line.size(), what_, ": partner ", partner,
                 " in its pairing, must be from 0 to ", master_.line.size() - 1);
         other.insert(static_cast<Index>(i), partner) = 1;
      }
   }
   for (Index i = 0; i < mortar_.weights.size(); ++i)
   {
      const int node = mortar_.nodes[i], partner = pairs.partner[node];
      const LineNode &own = slave_.line.nodes[node], &other = master_.line.nodes[partner];
      mortar_.weights[i] = 0.5 * (own.weight + other.weight);
      mortar_.tangent.row(i) = mean_frame(own, other).tangent;
      mortar_.turn[i] = angle_between(own.tangent, -other.tangent);
   }
   mortar_.gap = pairs.gap(mortar_.nodes);
   add_curves(master_.line, pairs.partner);
}

/// What smooth curves that elements are chords of make of gaps from node to node; of an
/// obstacle the line is empty.
void InterfaceRows::add_curves(const ContactLine &other, const std::vector<int> &partner)
{
   const CurveGaps curves =
      curve_gaps(slave_.line, mortar_.nodes, mortar_.tangent, other, partner);
   mortar_.gap += curves.moved;
   for (Index i = 0; i < mortar_.gap.size(); ++i) // round-off of what is the same on both sides
   {
      const double least = 1e-9 * slave_.line.nodes[mortar_.nodes[i]].spacing;
      if (std::abs(mortar_.gap[i]) <= least) { mortar_.gap[i] = 0; }
   }
   mortar_.chords = curves.left;
   mortar_.curved = curves.curved;
}

void InterfaceRows::meet(const std::vector<int> &without)
{
   if (given_.pairing)
   {
      pair_nodes(without);
      return;
   }
   if (master_.body >= 0)
   {
      mortar_ = mortar(slave_.line, master_.line, without, what_);
      for (Index i = 0; i < mortar_.gap.size() && !given_.gap && !given_.tied; ++i)
      {
         const double most = given_.most_overlap * mortar_.size[i];
         require(mortar_.gap[i] >= -most, what_, ": the sides overlap by ", -mortar_.gap[i],
                 " at ", slave_.line.nodes[mortar_.nodes[i]].position, ", at most ", most,
                 " is allowed (", given_.most_overlap, " of the element's length): ",
                 mortar_.gap[i] < -mortar_.size[i]
                    ? "are these the sides that touch, and the bodies in their places?"
                    : "allow more if they are to be pressed apart, or give the gap");
      }
      return;
   }
   const auto &chains = slave_.line.chains;
   if (without.empty() || std::any_of(chains.begin(), chains.end(),
                                      [](const LineChain &c) { return c.elements.empty(); }))
   {
      face_all(without);
      add_curves({}, {});
      return;
   }
   // Also on an obstacle neighbours carry the part of a node without a row: it is what lies
   // against the line, and does not move.
   mortar_ = mortar(slave_.line, other_face(slave_.line), without, what_);
   for (Mortar::Matrix &other : mortar_.other)
   {
      other = Mortar::Matrix(mortar_.gap.size(), 0);
   }
   add_curves({}, {});
   mortar_.gap.setZero();
   mortar_.arm.setZero();
}

/// Every node of the slave is faced, by nothing yet.
void InterfaceRows::face_all(const std::vector<int> &without)
{
   const ContactLine &line = slave_.line;
   mortar_ = Mortar();
   for (Index k = 0; k < line.size(); ++k)
   {
      if (!std::count(without.begin(), without.end(), int(k)))
      {
         mortar_.nodes.push_back(static_cast<int>(k));
      }
   }
   const auto n = static_cast<Index>(mortar_.nodes.size());
   for (Mortar::Matrix &own : mortar_.own)
   {
      own.resize(n, line.size());
      for (Index i = 0; i < n; ++i) { own.insert(i, mortar_.nodes[i]) = 1; }
   }
   for (Mortar::Matrix &other : mortar_.other) { other.resize(n, 0); }
   mortar_.tangent = line.each(&LineNode::tangent)(mortar_.nodes, Eigen::all);
   mortar_.weights = line.each(&LineNode::weight)(mortar_.nodes);
   mortar_.gap = mortar_.arm = mortar_.turn = mortar_.chords = mortar_.curved =
      Eigen::VectorXd::Zero(n);
}

/// A node of the master that is at the same place along a tangent as a row's node, the nearest
/// one; or none.
const int *InterfaceRows::faced(Index i, const Vector2d &tangent) const
{
   const Vector2d &place = slave_.line.nodes[mortar_.nodes[i]].position;
   const LineNode *nearest = nullptr;
   const int *found = nullptr;
   for (std::size_t m = 0; m < master_.nodes.size(); ++m)
   {
      const LineNode &node = master_.line.nodes[m];
      const double off = std::abs((node.position - place).dot(tangent));
      if (off <= 1e-6 * node.spacing &&
          (!nearest || (node.position - place).norm() < (nearest->position - place).norm()))
      {
         nearest = &node;
         found = &master_.nodes[m];
      }
   }
   return found;
}

bool InterfaceRows::partner_is_free(int node) const
{
   if (!given_.pairing || master_.body < 0) { return false; }
   const std::vector<int> &partners = given_.pairing->partner;
   const bool known = node < static_cast<int>(partners.size()) && partners[node] >= 0 &&
                      partners[node] < static_cast<int>(master_.nodes.size());
   if (!known) { return false; } // which pair_nodes() refuses
   const int partner = master_.nodes[partners[node]];
   const CondensedBody &body = bodies_[master_.body];
   return !holds(body, partner, 0) && !holds(body, partner, 1);
}

ContactRow InterfaceRows::row(Index i) const
{
   const CondensedBody &body = bodies_[slave_.body];
   const int node = mortar_.nodes[i], k = slave_.nodes[node];
   ContactRow made{slave_.body, k, mortar_.tangent.row(i), !holds(body, k, 0), {}};
   if ((holds(body, k, 0) || holds(body, k, 1)) && partner_is_free(node))
   {
      // Either of two paired nodes may be the one that relative displacements determine.
      made.body = master_.body;
      made.node = master_.nodes[given_.pairing->partner[node]];
      made.slides = true;
   }
   const auto on_axes = [](const LineNode &at)
   { return at.tangent.cwiseAbs().minCoeff() == 0; };
   if (!made.slides && on_axes(slave_.line.nodes[node]))
   {
      // A plane of symmetry, if what it faces has the same one, is across the contact. The mean
      // of all normals that the row sees beside it need not be.
      const int *other = faced(i, slave_.line.nodes[node].tangent);
      if (!other || on_axes(bodies_[master_.body].line.nodes[*other]))
      {
         made.tangent = slave_.line.nodes[node].tangent;
      }
   }
   std::map<NodeOfBody, Vector2d> shares;
   for (int c : {0, 1})
   {
      for (Mortar::Matrix::InnerIterator e(mortar_.own[c], i); e; ++e)
      {
         shares.try_emplace({slave_.body, slave_.nodes[e.col()]}, 0, 0).first->second[c] +=
            e.value();
      }
      for (Mortar::Matrix::InnerIterator e(mortar_.other[c], i); e; ++e)
      {
         shares.try_emplace({master_.body, master_.nodes[e.col()]}, 0, 0).first->second[c] -=
            e.value();
      }
   }
   for (const auto &[of, share] : shares)
   {
      // Round-off of functions that only touch the part would tie nodes that do not meet.
      if (share.cwiseAbs().maxCoeff() <= 1e-14) { continue; }
      made.shares.push_back({of.first, of.second, share[0], share[1]});
   }
   return made;
}

void InterfaceRows::check_row(const ContactRow &row, Index i) const
{
   const Vector2d &place = slave_.line.nodes[mortar_.nodes[i]].position;
   require(!holds(bodies_[row.body], row.node, 1), what_, ": the contact node at ", place,
           " is fixed normal to the line, it must be able to open: the contact line must end "
           "before it, or the other side be the slave (slave: ",
           of_second_ ? "first" : "second", ")");
   if (row.slides || master_.body < 0) { return; }
   const int *other = given_.pairing ? &master_.nodes[given_.pairing->partner[mortar_.nodes[i]]]
                                     : faced(i, row.tangent);
   require(other && holds(bodies_[master_.body], *other, 0), what_, ": the contact node at ",
           place,
           " is fixed along the line, and what it faces is not: the other side must be the "
           "slave (slave: ",
           of_second_ ? "first" : "second", "), or be fixed there as well");
}

void InterfaceRows::add_rows(std::vector<ContactRow> &rows, Slaves &taken)
{
   try
   {
      add_slave(rows, taken, true);
   }
   catch (const InputError &refused)
   {
      const bool free = given_.slave == SlaveSide::coarser || given_.slave == SlaveSide::finer;
      if (!free || master_.body < 0 || given_.pairing) { throw; }
      std::swap(slave_, master_);
      of_second_ = !of_second_;
      try
      {
         // Rings would be of a place that is named twice, the other way round.
         add_slave(rows, taken, false);
      }
      catch (const InputError &)
      {
         throw refused; // which is of the side that should be it
      }
   }
}

void InterfaceRows::add_slave(std::vector<ContactRow> &rows, Slaves &taken, bool in_rings)
{
   const auto place = [this](int node) { return NodeOfBody(slave_.body, slave_.nodes[node]); };
   without_row_.clear();
   for (int k : clamped_ends(bodies_[slave_.body], slave_.line, slave_.nodes))
   {
      if (!partner_is_free(k)) { without_row_.push_back(k); }
   }
   for (int k = 0; k < static_cast<int>(slave_.nodes.size()); ++k)
   {
      if (taken.count(place(k)) && !std::count(without_row_.begin(), without_row_.end(), k))
      {
         without_row_.push_back(k);
      }
   }
   // Each node without a row gives its part to its neighbours, which may close a ring then.
   while (true)
   {
      require(without_row_.size() < slave_.nodes.size(), what_, ": all nodes of ",
              called(bodies_, slave_.body),
              " there carry rows of interfaces before it, or would close a ring of them: "
              "each place where two sides meet must be named once, or the other side be the "
              "slave (slave: ",
              of_second_ ? "first" : "second", ")");
      meet(without_row_);
      auto slaves = taken;
      const std::size_t before = without_row_.size();
      std::vector<ContactRow> own;
      for (Index i = 0; i < static_cast<Index>(mortar_.nodes.size()); ++i)
      {
         own.push_back(row(i));
         const NodeOfBody slave(own.back().body, own.back().node);
         require(slave == place(mortar_.nodes[i]) || taken.count(slave) == 0, what_,
                 ": the node of ", called(bodies_, slave.first), " at ",
                 bodies_[slave.first].line.nodes[slave.second].position,
                 " carries a row of another interface, and supports hold the one that it is "
                 "paired with: the other interface must leave it out");
         std::vector<NodeOfBody> on;
         // A tip, which both sides have: where they match it would face itself, and its shares
         // cancel.
         const bool tip = slave_.body == master_.body &&
                          std::count(master_.nodes.begin(), master_.nodes.end(),
                                     slave_.nodes[mortar_.nodes[i]]) > 0;
         for (const TraceShare &share : own.back().shares)
         {
            const NodeOfBody node(share.body, share.node);
            if (node != slave) { on.push_back(node); }
         }
         // Does anything that it depends on depend on it?
         bool on_itself = tip;
         std::set<NodeOfBody> seen;
         std::vector<NodeOfBody> open = on;
         while (!open.empty() && !on_itself)
         {
            const NodeOfBody next = open.back();
            open.pop_back();
            if (!seen.insert(next).second) { continue; }
            const auto found = slaves.find(next);
            if (found == slaves.end()) { continue; }
            on_itself = std::count(found->second.begin(), found->second.end(), slave) > 0;
            open.insert(open.end(), found->second.begin(), found->second.end());
         }
         require(!on_itself || tip || in_rings, what_, ": its rows would close a ring");
         if (on_itself) { without_row_.push_back(mortar_.nodes[i]); }
         else { slaves[slave] = on; }
      }
      if (without_row_.size() > before) { continue; }
      for (Index i = 0; i < static_cast<Index>(own.size()); ++i) { check_row(own[i], i); }
      taken = std::move(slaves);
      slides_.clear();
      for (std::size_t i = 0; i < own.size(); ++i)
      {
         ContactRow &made = own[i];
         slides_.push_back(made.slides);
         mortar_.tangent.row(static_cast<Index>(i)) = made.tangent;
         rows.push_back(std::move(made));
      }
      return;
   }
}

/// How the other body goes on beyond the first or last node of a run.
LineEnd InterfaceRows::other_end(Index i, bool last) const
{
   if (master_.body < 0) { return LineEnd::smooth; }
   const Vector2d tangent = mortar_.tangent.row(i), out = last ? tangent : Vector2d(-tangent);
   const LineNode &node = slave_.line.nodes[mortar_.nodes[i]];
   for (const LineChain &chain : master_.line.chains)
   {
      if (chain.loop) { continue; }
      for (int end : {0, 1})
      {
         const Index k = end ? chain.first + chain.nodes - 1 : chain.first;
         bool faces = false;
         for (Mortar::Matrix::InnerIterator e(mortar_.other[1], i); e; ++e)
         {
            faces = faces || (e.col() == k && std::abs(e.value()) > 1e-14);
         }
         const LineNode &other = master_.line.nodes[k];
         const double beyond = (other.position - node.position).dot(out);
         // A line that runs on beyond the slave's last node has its end elsewhere, unless the
         // slave goes on as well.
         const LineChain &own = slave_.line.chain_of(mortar_.nodes[i]);
         const bool at_end =
            mortar_.nodes[i] == (last ? own.first + own.nodes - 1 : own.first) && !own.loop;
         if (!faces || (at_end && beyond > 1e-6 * node.spacing)) { continue; }
         // The lines run against each other: its last node is at this one's first.
         if (end != (last ? 0 : 1)) { continue; }
         return chain.ends[end];
      }
   }
   return LineEnd::smooth;
}

InterfaceReport InterfaceRows::report() const
{
   const ContactLine &line = slave_.line;
   InterfaceReport report;
   report.name = given_.name;
   report.bodies = {slave_.body, master_.body};
   report.nodes = static_cast<Index>(mortar_.nodes.size());
   report.tied = given_.tied;
   report.of_second = of_second_;
   report.position = line.each(&LineNode::position)(mortar_.nodes, Eigen::all);
   report.outline = line.outline()(mortar_.nodes, Eigen::all);
   report.tangent = mortar_.tangent;
   report.turn = mortar_.turn;
   for (int c : {0, 1})
   {
      for (Eigen::MatrixX2d &at : report.acts_at) { at.resize(report.nodes, 2); }
      report.acts_at[0].col(c) = mortar_.own[c] * line.each(&LineNode::position).col(c);
      report.acts_at[1].col(c) = report.acts_at[0].col(c);
      if (master_.body < 0) { continue; }
      report.acts_at[1].col(c) =
         mortar_.other[c] * master_.line.each(&LineNode::position).col(c);
   }
   report.weights = mortar_.weights;
   report.spacing = line.each(&LineNode::spacing)(mortar_.nodes);
   report.left_out = mortar_.left_out;
   report.arm = report.nodes ? mortar_.arm.cwiseAbs().maxCoeff() : 0;
   report.matching = master_.body >= 0 &&
                     (given_.pairing || matching_nodes(slave_.line, master_.line).has_value());
   if (given_.pairing && master_.body >= 0)
   {
      const int differing = differing_element(slave_.line, master_.line, *given_.pairing);
      if (differing >= 0) { report.differing = line.nodes[differing].position; }
   }
   report.chords = mortar_.chords;
   report.curved = mortar_.curved;
   // On an obstacle the gap that is given is that of its shape. Sides that match have the same
   // chords; of those that are paired by name one may be straight.
   const bool same = report.matching && !given_.pairing;
   if ((given_.gap && master_.body >= 0) || given_.tied || same)
   {
      report.chords.setZero(report.nodes);
      report.curved.setZero(report.nodes);
   }
   for (int k : mortar_.free_surface) { report.free_surface.push_back(line.nodes[k].position); }
   for (int k : without_row_) { report.without_row.push_back(line.nodes[k].position); }
   return report;
}

bool InterfaceRows::has(const NodeOfBody &node) const
{
   const auto on = [&](const Side &side)
   {
      return side.body == node.first &&
             std::count(side.nodes.begin(), side.nodes.end(), node.second) > 0;
   };
   return on(slave_) || on(master_);
}

void InterfaceRows::add_facts(ReducedProblem &problem, Index first, bool matching,
                              const std::vector<InterfaceRows> &all) const
{
   const ContactLine &line = slave_.line;
   const Eigen::MatrixX2d outline = line.outline();
   const auto n = static_cast<Index>(mortar_.nodes.size());
   for (Index i = 0; i < n; ++i)
   {
      const LineNode &node = line.nodes[mortar_.nodes[i]];
      const double x = node.position[0], y = node.position[1];
      // An obstacle is as far away as the outline of the side is, of a pair of bodies a gap is
      // said of the nodes.
      const double gap = !given_.gap        ? mortar_.gap[i]
                         : master_.body < 0 ? (*given_.gap)(outline(mortar_.nodes[i], 0),
                                                            outline(mortar_.nodes[i], 1))
                                            : (*given_.gap)(x, y);
      require(std::isfinite(gap), what_, ": the gap at ", node.position, " is ", gap,
              ", must be finite");
      problem.gap[first + i] = gap;
      problem.weights[first + i] = mortar_.weights[i];
      problem.arc_length[first + i] = node.arc_length;
      problem.position.row(first + i) = node.position;
      problem.dofs.block(first + i, 2 * slave_.body, 1, 2) << node.dofs[0], node.dofs[1];
      if (matching)
      {
         Index facing = 0;
         for (Mortar::Matrix::InnerIterator e(mortar_.other[1], i); e; ++e)
         {
            if (std::abs(e.value()) > 0.5) { facing = e.col(); }
         }
         const auto &dofs = master_.line.nodes[facing].dofs;
         problem.dofs.block(first + i, 2 * master_.body, 1, 2) << dofs[0], dofs[1];
      }
   }
   // Nodes that follow each other, one run a chain.
   for (Index begin = 0; begin < n;)
   {
      const LineChain &chain = line.chain_of(mortar_.nodes[begin]);
      Index end = begin + 1;
      while (end < n && mortar_.nodes[end] == mortar_.nodes[end - 1] + 1 &&
             mortar_.nodes[end] < chain.first + chain.nodes)
      {
         ++end;
      }
      ContactChain made;
      made.interface = given_.name;
      made.first = first + begin;
      made.nodes = end - begin;
      made.loop = chain.loop && made.nodes == chain.nodes;
      made.bodies = {slave_.body, master_.body};
      for (bool last : {false, true})
      {
         const Index i = last ? end - 1 : begin;
         const Index outer = last ? chain.first + chain.nodes - 1 : chain.first;
         bool at_end = !chain.loop; // or beyond it all nodes are others'
         for (Index k = mortar_.nodes[i]; k != outer && at_end;)
         {
            k += last ? 1 : -1;
            at_end = std::count(without_row_.begin(), without_row_.end(), int(k)) > 0;
         }
         // Contact that goes on as another interface, tied or not, does not end here.
         const bool goes_on =
            at_end &&
            std::any_of(
               all.begin(), all.end(),
               [&](const InterfaceRows &other) {
                  return &other != this && other.has({slave_.body, slave_.nodes[outer]});
               });
         made.ends[last] = !at_end                                          ? LineEnd::smooth
                           : goes_on && chain.ends[last] == LineEnd::smooth ? LineEnd::unknown
                                                                            : chain.ends[last];
         made.other_ends[last] = made.loop ? LineEnd::smooth : other_end(i, last);
      }
      problem.chains.push_back(made);
      begin = end;
   }
}

std::vector<ContactRow> rows_of(const std::vector<Interface> &interfaces,
                                const std::vector<CondensedBody> &bodies,
                                std::vector<InterfaceRows> &facings)
{
   for (const CondensedBody &body : bodies)
   {
      require(body.line.formulation == bodies[0].line.formulation &&
                 body.line.formulation != Formulation::torsion,
              "reduce: the bodies must be all plane or all axisymmetric");
   }
   std::vector<ContactRow> rows;
   Slaves taken;
   std::set<int> touched;
   for (const Interface &interface : interfaces)
   {
      facings.emplace_back(interface, bodies);
      facings.back().add_rows(rows, taken);
      touched.insert({interface.first.body, interface.second.body});
   }
   for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
   {
      require(touched.count(b), "reduce: ", called(bodies, b),
              " is at no interface, nothing touches it: it must be at one, or be left out");
   }
   return rows;
}

} // namespace cattaneo
