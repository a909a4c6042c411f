#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/interface_rows.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;

namespace
{

/// How the boundary of the other body continues beyond the first or last node of a run.
LineEnd other_end(const MetInterface &met, Index i, bool last)
{
   const Mortar &mortar = met.mortar;
   if (met.master.body < 0) { return LineEnd::smooth; }
   const Vector2d tangent = mortar.tangent.row(i), out = last ? tangent : Vector2d(-tangent);
   const LineNode &node = met.slave.line.nodes[mortar.nodes[i]];
   for (const LineChain &chain : met.master.line.chains)
   {
      if (chain.loop) { continue; }
      for (int end : {0, 1})
      {
         const Index k = end ? chain.first + chain.nodes - 1 : chain.first;
         bool faces = false;
         for (Mortar::Matrix::InnerIterator e(mortar.other[1], i); e; ++e)
         {
            faces = faces || (e.col() == k && std::abs(e.value()) > 1e-14);
         }
         const LineNode &other = met.master.line.nodes[k];
         const double beyond = (other.position - node.position).dot(out);
         // If the other line continues beyond the slave's last node, its end is elsewhere,
         // unless the slave continues as well.
         const LineChain &own = met.slave.line.chain_of(mortar.nodes[i]);
         const bool at_end =
            mortar.nodes[i] == (last ? own.first + own.nodes - 1 : own.first) && !own.loop;
         if (!faces || (at_end && beyond > 1e-6 * node.spacing)) { continue; }
         // In a chain of one node this node is both ends: the end that does not continue
         // decides.
         if (chain.nodes == 1)
         {
            return chain.ends[0] == LineEnd::smooth ? chain.ends[1] : chain.ends[0];
         }
         // The lines run in opposite directions: the last node of the other one is at the first
         // of this one.
         if (end != (last ? 0 : 1)) { continue; }
         return chain.ends[end];
      }
   }
   return LineEnd::smooth;
}

/// Is the node of a body on one of its sides?
bool has(const MetInterface &met, const NodeOfBody &node)
{
   const auto on = [&](const Side &side)
   {
      return side.body == node.first &&
             std::count(side.nodes.begin(), side.nodes.end(), node.second) > 0;
   };
   return on(met.slave) || on(met.master);
}

} // namespace

InterfaceReport report_of(const MetInterface &met)
{
   const Interface &given = *met.given;
   const Mortar &mortar = met.mortar;
   const ContactLine &line = met.slave.line;
   InterfaceReport report;
   report.name = given.name;
   report.bodies = {met.slave.body, met.master.body};
   report.nodes = static_cast<Index>(mortar.nodes.size());
   report.tied = given.tied;
   report.of_second = met.of_second;
   report.position = line.each(&LineNode::position)(mortar.nodes, Eigen::all);
   report.outline = line.outline()(mortar.nodes, Eigen::all);
   report.tangent = mortar.tangent;
   report.turn = mortar.turn;
   for (int c : {0, 1})
   {
      for (Eigen::MatrixX2d &at : report.acts_at) { at.resize(report.nodes, 2); }
      report.acts_at[0].col(c) = mortar.own[c] * line.each(&LineNode::position).col(c);
      report.acts_at[1].col(c) = report.acts_at[0].col(c);
      if (met.master.body < 0) { continue; }
      report.acts_at[1].col(c) =
         mortar.other[c] * met.master.line.each(&LineNode::position).col(c);
   }
   report.weights = mortar.weights;
   report.spacing = line.each(&LineNode::spacing)(mortar.nodes);
   report.left_out = mortar.left_out;
   report.arm = report.nodes ? mortar.arm.cwiseAbs().maxCoeff() : 0;
   report.matching =
      met.master.body >= 0 &&
      (given.pairing || matching_nodes(met.slave.line, met.master.line).has_value());
   if (given.pairing && met.master.body >= 0)
   {
      const int differing = differing_element(met.slave.line, met.master.line, *given.pairing);
      if (differing >= 0) { report.differing = line.nodes[differing].position; }
   }
   report.chords = mortar.chords;
   report.curved = mortar.curved;
   // On an obstacle a given gap is that of its shape. Sides that match have the same chords. If
   // the user pairs two sides, one of them may be straight.
   const bool same = report.matching && !given.pairing;
   if ((given.gap && met.master.body >= 0) || given.tied || same)
   {
      report.chords.setZero(report.nodes);
      report.curved.setZero(report.nodes);
   }
   for (int k : mortar.free_surface) { report.free_surface.push_back(line.nodes[k].position); }
   for (int k : met.without_row) { report.without_row.push_back(line.nodes[k].position); }
   return report;
}

void add_facts(ReducedProblem &problem, Index first, bool matching, const MetInterface &met,
               const std::vector<MetInterface> &all)
{
   const Interface &given = *met.given;
   const Mortar &mortar = met.mortar;
   const ContactLine &line = met.slave.line;
   const Eigen::MatrixX2d outline = line.outline();
   const auto n = static_cast<Index>(mortar.nodes.size());
   for (Index i = 0; i < n; ++i)
   {
      const LineNode &node = line.nodes[mortar.nodes[i]];
      const double x = node.position[0], y = node.position[1];
      // On an obstacle the gap is that of the side's outline, between two bodies that of the
      // nodes.
      const double gap = !given.gap            ? mortar.gap[i]
                         : met.master.body < 0 ? (*given.gap)(outline(mortar.nodes[i], 0),
                                                              outline(mortar.nodes[i], 1))
                                               : (*given.gap)(x, y);
      require(std::isfinite(gap), met.what, ": the gap at ", node.position, " is ", gap,
              ", must be finite");
      problem.gap[first + i] = gap;
      problem.weights[first + i] = mortar.weights[i];
      problem.arc_length[first + i] = node.arc_length;
      problem.position.row(first + i) = node.position;
      problem.dofs.block(first + i, 2 * met.slave.body, 1, 2) << node.dofs[0], node.dofs[1];
      if (matching)
      {
         Index facing = 0;
         for (Mortar::Matrix::InnerIterator e(mortar.other[1], i); e; ++e)
         {
            if (std::abs(e.value()) > 0.5) { facing = e.col(); }
         }
         const auto &dofs = met.master.line.nodes[facing].dofs;
         problem.dofs.block(first + i, 2 * met.master.body, 1, 2) << dofs[0], dofs[1];
      }
   }
   // Nodes that follow each other, one run a chain.
   for (Index begin = 0; begin < n;)
   {
      const LineChain &chain = line.chain_of(mortar.nodes[begin]);
      Index end = begin + 1;
      while (end < n && mortar.nodes[end] == mortar.nodes[end - 1] + 1 &&
             mortar.nodes[end] < chain.first + chain.nodes)
      {
         ++end;
      }
      ContactChain made;
      made.interface = given.name;
      made.first = first + begin;
      made.nodes = end - begin;
      made.loop = chain.loop && made.nodes == chain.nodes;
      made.bodies = {met.slave.body, met.master.body};
      for (bool last : {false, true})
      {
         const Index i = last ? end - 1 : begin;
         const Index outer = last ? chain.first + chain.nodes - 1 : chain.first;
         bool at_end = !chain.loop; // or all nodes beyond belong to other interfaces
         for (Index k = mortar.nodes[i]; k != outer && at_end;)
         {
            k += last ? 1 : -1;
            at_end = std::count(met.without_row.begin(), met.without_row.end(), int(k)) > 0;
         }
         // A contact that continues as another interface, tied or not, does not end here.
         const bool goes_on =
            at_end &&
            std::any_of(
               all.begin(), all.end(),
               [&](const MetInterface &other) {
                  return &other != &met && has(other, {met.slave.body, met.slave.nodes[outer]});
               });
         made.ends[last] = !at_end                                          ? LineEnd::smooth
                           : goes_on && chain.ends[last] == LineEnd::smooth ? LineEnd::unknown
                                                                            : chain.ends[last];
         made.other_ends[last] = made.loop ? LineEnd::smooth : other_end(met, i, last);
      }
      problem.chains.push_back(made);
      begin = end;
   }
}

} // namespace cattaneo
