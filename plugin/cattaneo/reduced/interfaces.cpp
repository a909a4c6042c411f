#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/interface_rows.hpp>
#include <map>
#include <numeric>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;

namespace
{

/// Contact nodes by whether their interface is tied.
void sort_out(const std::vector<InterfaceRows> &facings, UnionRows &rows)
{
   int row = 0;
   for (const InterfaceRows &facing : facings)
   {
      for (Index i = 0; i < facing.nodes(); ++i)
      {
         (facing.tied() ? rows.tied : rows.free).push_back(row++);
      }
   }
}

/// Numbers of the bodies that interfaces join, without those that touch an obstacle.
std::vector<std::vector<int>> groups_of(std::size_t bodies,
                                        const std::vector<InterfaceRows> &facings)
{
   std::vector<int> group(bodies);
   std::iota(group.begin(), group.end(), 0);
   const auto join = [&](int a, int b)
   {
      const int from = group[a], to = group[b];
      std::replace(group.begin(), group.end(), from, to);
   };
   for (const InterfaceRows &facing : facings)
   {
      if (facing.master().body >= 0) { join(facing.slave().body, facing.master().body); }
   }
   std::map<int, std::vector<int>> members;
   for (std::size_t b = 0; b < bodies; ++b)
   {
      members[group[b]].push_back(static_cast<int>(b));
   }
   for (const InterfaceRows &facing : facings)
   {
      if (facing.master().body < 0) { members.erase(group[facing.slave().body]); }
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

} // namespace

Reduction reduce(std::vector<CondensedBody> bodies, const std::vector<Interface> &interfaces)
{
   require_some(bodies, interfaces);
   // What has formulas of its own.
   const Interface &one = interfaces.front();
   const auto is_all = [&](const InterfaceSide &side, int b)
   {
      const ContactLine &line = bodies[b].line;
      std::vector<int> numbers(line.size());
      std::iota(numbers.begin(), numbers.end(), 0);
      return side.body == b && clamped_ends(bodies[b], line, numbers).empty() &&
             side.line.size() == line.size() &&
             std::equal(line.nodes.begin(), line.nodes.end(), side.line.nodes.begin(),
                        [](const LineNode &i, const LineNode &j) { return i.dofs == j.dofs; });
   };
   const auto named = [&](Reduction reduction)
   {
      for (ContactChain &chain : reduction.problem.chains) { chain.interface = one.name; }
      reduction.interfaces[0].name = one.name;
      return reduction;
   };
   if (interfaces.size() == 1 && !one.tied && is_all(one.first, 0))
   {
      if (bodies.size() == 1 && one.second.body < 0)
      {
         return named(reduce(std::move(bodies[0]), one.gap.value_or(0.0)));
      }
      if (bodies.size() == 2 && (one.pairing || one.slave != SlaveSide::second) &&
          is_all(one.second, 1))
      {
         if (auto pairing =
                one.pairing ? one.pairing : matching_nodes(bodies[0].line, bodies[1].line))
         {
            Reduction made =
               named(reduce(std::move(bodies[0]), std::move(bodies[1]), *pairing));
            if (!one.gap) { return made; }
            // Said of the nodes, whatever the geometry is.
            for (Index i = 0; i < made.problem.nodes(); ++i)
            {
               const Vector2d x = made.problem.position.row(i);
               made.problem.gap[i] = (*one.gap)(x[0], x[1]);
            }
            made.interfaces[0].chords.setZero();
            made.interfaces[0].curved.setZero();
            return made;
         }
      }
   }
   return reduce_by_rows(std::move(bodies), interfaces);
}

Reduction reduce_by_rows(std::vector<CondensedBody> bodies,
                         const std::vector<Interface> &interfaces)
{
   Reduction result;
   for (const CondensedBody &body : bodies) { result.counters += body.counters; }
   ++result.counters.unions;
   result.bodies = std::move(bodies);
   std::vector<InterfaceRows> facings;
   auto rows = std::make_shared<UnionRows>();
   rows->rows = rows_of(interfaces, result.bodies, facings);
   rows->groups = groups_of(result.bodies.size(), facings);
   sort_out(facings, *rows);
   const auto n = static_cast<Index>(rows->free.size()); // none where all is tied
   const auto count = static_cast<int>(result.bodies.size());
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   const Block block = united(result.bodies, *rows, result.pattern_, problem.patterns);
   result.union_ = block.way_back;
   result.rows_ = std::move(rows);
   take(std::move(block), problem);
   problem.weights = problem.arc_length = Eigen::VectorXd::Zero(n);
   problem.position.resize(n, 2);
   problem.dofs = Eigen::MatrixXi::Constant(n, 2 * count, -1);
   std::array<Index, 2> next{0, 0}; // of nodes that are not tied, and of those that are
   for (const InterfaceRows &facing : facings)
   {
      InterfaceReport report = facing.report();
      report.first = next[report.tied];
      next[report.tied] += report.nodes;
      if (!report.tied) { facing.add_facts(problem, report.first, report.matching, facings); }
      result.interfaces.push_back(std::move(report));
   }
   return result;
}

SeparateBodies separate(const std::vector<CondensedBody> &bodies,
                        const std::vector<Interface> &interfaces)
{
   require_some(bodies, interfaces);
   for (const Interface &interface : interfaces)
   {
      require(!interface.tied, "interface '", interface.name,
              "': it is tied, its bodies have no displacements of their own there");
   }
   std::vector<InterfaceRows> facings;
   const RelativeDisplacement map(bodies, rows_of(interfaces, bodies, facings));
   SeparateBodies result;
   const Reduction::PatternIndex index = join(bodies, result.patterns);
   result.L = map.G;
   result.K = Eigen::MatrixXd::Zero(map.size(), map.size());
   std::vector<Eigen::MatrixXd> forces;
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const std::vector<int> &free = map.free[b];
      const auto rows = static_cast<Index>(free.size());
      result.K.block(map.offsets[b], map.offsets[b], rows, rows) = bodies[b].S(free, free);
      forces.push_back(
         clamped_forces(bodies[b], index[b], static_cast<Index>(result.patterns.size())));
   }
   result.loads = map.stacked(forces);
   for (LoadPattern &pattern : result.patterns) { pattern.q = pattern.p = Eigen::VectorXd(); }
   return result;
}

} // namespace cattaneo
