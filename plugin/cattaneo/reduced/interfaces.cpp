#include <algorithm>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/interface_rows.hpp>
#include <cattaneo/reduced/surfaces.hpp>
#include <map>
#include <numeric>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;

namespace
{

/// Contact nodes by whether their interface is tied.
void sort_out(const std::vector<MetInterface> &met, UnionRows &rows)
{
   int row = 0;
   for (const MetInterface &interface : met)
   {
      for (Index i = 0; i < interface.nodes(); ++i)
      {
         (interface.given->tied ? rows.tied : rows.free).push_back(row++);
      }
   }
}

/// Numbers of the bodies that interfaces join, without those that touch an obstacle.
std::vector<std::vector<int>> groups_of(std::size_t bodies,
                                        const std::vector<MetInterface> &met)
{
   std::vector<int> group(bodies);
   std::iota(group.begin(), group.end(), 0);
   const auto join = [&](int a, int b)
   {
      const int from = group[a], to = group[b];
      std::replace(group.begin(), group.end(), from, to);
   };
   for (const MetInterface &interface : met)
   {
      if (interface.master.body >= 0) { join(interface.slave.body, interface.master.body); }
   }
   std::map<int, std::vector<int>> members;
   for (std::size_t b = 0; b < bodies; ++b)
   {
      members[group[b]].push_back(static_cast<int>(b));
   }
   for (const MetInterface &interface : met)
   {
      if (interface.master.body < 0) { members.erase(group[interface.slave.body]); }
   }
   std::vector<std::vector<int>> result;
   for (auto &[number, list] : members) { result.push_back(std::move(list)); }
   return result;
}

void require_some(const std::vector<CondensedBody> &bodies,
                  const std::vector<Interface> &interfaces)
{
   require(!bodies.empty() && !interfaces.empty(), "reduce: ", bodies.size(), " bodies and ",
           interfaces.size(), " interfaces, must be at least one of each");
}

/// Do supports hold an end of a line in both components? Then it has no row, and its neighbours
/// carry its part (not in a pairing).
bool has_clamped_end(const CondensedBody &body)
{
   const auto clamped = [&](Index node)
   {
      const auto k = static_cast<int>(node);
      return holds(body, k, 0) && holds(body, k, 1);
   };
   return std::any_of(body.line.chains.begin(), body.line.chains.end(),
                      [&](const LineChain &chain) {
                         return !chain.loop && (clamped(chain.first) ||
                                                clamped(chain.first + chain.nodes - 1));
                      });
}

/// The interface of two bodies whose whole lines match, node by node, as a pairing.
std::vector<Interface> paired_if_matching(const std::vector<CondensedBody> &bodies,
                                          std::vector<Interface> interfaces)
{
   Interface &one = interfaces.front();
   const auto is_all = [&](const InterfaceSide &side, int b)
   {
      const ContactLine &line = bodies[b].line;
      return side.body == b && side.line.size() == line.size() && !has_clamped_end(bodies[b]) &&
             std::equal(line.nodes.begin(), line.nodes.end(), side.line.nodes.begin(),
                        [](const LineNode &i, const LineNode &j) { return i.dofs == j.dofs; });
   };
   if (one.first.surface.size() == 0 && bodies.size() == 2 && interfaces.size() == 1 &&
       !one.tied && !one.pairing && one.slave != SlaveSide::second && is_all(one.first, 0) &&
       is_all(one.second, 1))
   {
      one.pairing = matching_nodes(bodies[0].line, bodies[1].line);
   }
   return interfaces;
}

} // namespace

Reduction reduce(std::vector<CondensedBody> bodies, const std::vector<Interface> &given)
{
   require_some(bodies, given);
   const std::vector<Interface> interfaces = paired_if_matching(bodies, given);
   Reduction result;
   for (const CondensedBody &body : bodies) { result.counters += body.counters; }
   const bool alone =
      bodies.size() == 1 && interfaces.size() == 1 && interfaces[0].second.body < 0;
   result.counters.unions += !alone;
   result.bodies = std::move(bodies);
   std::vector<MetInterface> met;
   auto rows = std::make_shared<UnionRows>();
   rows->rows = rows_of(interfaces, result.bodies, met);
   rows->groups = groups_of(result.bodies.size(), met);
   sort_out(met, *rows);
   const auto n = static_cast<Index>(rows->free.size()); // none if all interfaces are tied
   const auto count = static_cast<int>(result.bodies.size());
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   Block block = united(result.bodies, *rows, result.pattern_, problem.patterns);
   result.union_ = block.way_back;
   result.rows_ = std::move(rows);
   const std::vector<InterfaceReport::Moved> moved = block.moved;
   const bool in_space = result.bodies[0].line.formulation == Formulation::space;
   const int components = in_space ? 3 : 2;
   // If a load moved one of two tangents, the law would have to know the slip along it.
   if (in_space && !moved.empty())
   {
      const ContactRow &at = result.rows_->rows[result.rows_->free[moved[0].node % n]];
      require(
         false, "reduce: load '", problem.patterns[moved[0].pattern].name,
         "' moves the contact node at ",
         place_text(result.bodies[at.slave.first].places().row(at.slave.second),
                    Formulation::space),
         " along the surface, and the other side cannot follow: end the contact before it");
   }
   take(std::move(block), components, problem);
   problem.weights = Eigen::VectorXd::Zero(n);
   if (!in_space) { problem.arc_length = Eigen::VectorXd::Zero(n); }
   problem.position.resize(n, components);
   problem.dofs = Eigen::MatrixXi::Constant(n, components * count, -1);
   std::array<Index, 2> next{0, 0}; // of nodes that are not tied, and of those that are
   auto row = result.rows_->rows.begin();
   for (const MetInterface &interface : met)
   {
      InterfaceReport report =
         in_space ? report_on_surfaces(interface, {row, row + interface.nodes()})
                  : report_of(interface);
      row += interface.nodes();
      report.first = next[report.tied];
      next[report.tied] += report.nodes;
      if (!report.tied && in_space) { add_surface_facts(problem, report.first, interface); }
      else if (!report.tied)
      {
         add_facts(problem, report.first, report.matching, interface, met);
         double thickness = result.bodies[report.bodies[0]].thickness;
         if (report.bodies[1] >= 0)
         {
            thickness = std::min(thickness, result.bodies[report.bodies[1]].thickness);
         }
         problem.weights.segment(report.first, report.nodes) *= thickness;
      }
      for (const InterfaceReport::Moved &one : moved)
      {
         const bool its =
            !report.tied && one.node >= report.first && one.node < report.first + report.nodes;
         if (its) { report.moved.push_back(one); }
      }
      result.interfaces.push_back(std::move(report));
   }
   return result;
}

Reduction reduce(CondensedBody body, const ScalarField &gap)
{
   require(body.line.formulation != Formulation::torsion,
           "reduce: the body is of torsion, must be added to a reduction (add_torsion())");
   Interface contact;
   contact.gap = gap;
   contact.first = {0, body.line, body.surface};
   const Index n =
      body.line.formulation == Formulation::space ? body.S.rows() : body.line.size();
   for (int row : body.held)
   {
      require(row < n, "reduce: the contact node at ", body.line.nodes[row % n].position,
              " is fixed normal to the line, so that it cannot open: end the contact line "
              "end before it");
   }
   std::vector<CondensedBody> bodies;
   bodies.push_back(std::move(body));
   return reduce(std::move(bodies), std::vector<Interface>{contact});
}

Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing)
{
   const Index n = body1.nodes();
   require(body1.line.formulation == body2.line.formulation &&
              body1.line.formulation != Formulation::torsion,
           "reduce: the bodies must be both plane, both axisymmetric or both in space (add "
           "torsion to their reduction)");
   require(body2.nodes() == n && static_cast<Index>(pairing.partner.size()) == n &&
              pairing.gap.size() == n,
           "reduce: the contact ", body1.surface.size() > 0 ? "surfaces" : "lines", " have ", n,
           " and ", body2.nodes(), " nodes and the pairing ", pairing.partner.size(),
           ", must be equally many");
   Interface contact;
   contact.first = {0, body1.line, body1.surface};
   contact.second = {1, body2.line, body2.surface};
   contact.pairing = pairing;
   std::vector<CondensedBody> bodies;
   bodies.push_back(std::move(body1));
   bodies.push_back(std::move(body2));
   Reduction made = reduce(std::move(bodies), std::vector<Interface>{contact});
   const InterfaceReport &report = made.interfaces[0];
   require(report.without_row.empty(), "reduce: the contact node at ",
           report.without_row.empty() ? Eigen::Vector2d() : report.without_row[0],
           " is fixed normal to the line, so that it cannot open: end the contact line "
           "end before it");
   return made;
}

SeparateBodies separate(const std::vector<CondensedBody> &bodies,
                        const std::vector<Interface> &interfaces)
{
   require_some(bodies, interfaces);
   for (const Interface &interface : interfaces)
   {
      require(!interface.tied, "interface '", interface.name,
              "': it is tied, so that its bodies have no displacements of their own there");
   }
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      require(bodies[b].moved.size() == 0, "separate: a load moves contact nodes of ",
              called(bodies, static_cast<int>(b)),
              ", which is possible for united bodies only: end the contact before these nodes");
   }
   std::vector<MetInterface> met;
   const RelativeDisplacement map(bodies, rows_of(interfaces, bodies, met));
   SeparateBodies result;
   const Reduction::PatternIndex index = join(bodies, result.patterns);
   result.L = map.G;
   result.K = Eigen::MatrixXd::Zero(map.size(), map.size());
   std::vector<Eigen::MatrixXd> forces;
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const std::vector<int> &free = map.free[b];
      const auto rows = static_cast<Index>(free.size());
      result.K.block(map.offsets[b], map.offsets[b], rows, rows) =
         block_of(bodies[b].S, free, free);
      forces.push_back(
         clamped_forces(bodies[b], index[b], static_cast<Index>(result.patterns.size())));
   }
   result.loads = map.stacked(forces);
   for (LoadPattern &pattern : result.patterns) { pattern.q = pattern.p = Eigen::VectorXd(); }
   return result;
}

} // namespace cattaneo
