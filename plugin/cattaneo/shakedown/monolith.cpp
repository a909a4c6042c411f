#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cattaneo/shakedown/infinity.hpp>
#include <cattaneo/shakedown/monolith.hpp>
#include <cmath>
#include <numeric>

namespace cattaneo
{

namespace
{

void check_vertex(const LoadCycle &cycle, Eigen::Index vertex)
{
   require(vertex >= 0 && vertex < cycle.vertices(), "monolith: vertex ", vertex,
           ", must be from 0 to ", cycle.vertices() - 1, ", a vertex of the load cycle");
}

/// Smallest x ≥ 0 at which a x² + 2 b x + c, not positive at 0, becomes positive.
double first_positive(double a, double b, double c)
{
   if (c > 0) { return 0; }
   if (a == 0) { return b > 0 ? -c / (2 * b) : infinity; }
   const double discriminant = b * b - a * c;
   if (discriminant < 0) { return infinity; }
   const double root = std::sqrt(discriminant);
   if (a > 0) { return b > 0 ? -c / (b + root) : (root - b) / a; }
   // The parabola opens downwards. It is positive between its roots, which both have the sign
   // of b.
   return b > 0 ? -c / (b + root) : infinity;
}

} // namespace

NodeList chosen_nodes(const ReducedProblem &problem, const NodeList &nodes)
{
   const Eigen::Index n = problem.nodes();
   if (nodes.empty())
   {
      NodeList all(n);
      std::iota(all.begin(), all.end(), Eigen::Index(0));
      return all;
   }
   for (const Eigen::Index i : nodes)
   {
      require(i >= 0 && i < n, "monolith: node ", i, ", must be from 0 to ", n - 1);
   }
   return nodes;
}

NodeList nodes_away_from_ends(const ReducedProblem &problem, double share)
{
   const Eigen::VectorXd &arc = problem.arc_length;
   const Eigen::Index n = problem.nodes();
   require(arc.size() == n && n > 0,
           "the nodes away from the ends of the line: the problem has ", arc.size(),
           " arc lengths, must have one for each of its ", n, " nodes");
   const auto &chains = problem.chains;
   // A loop has no ends, and a plane of symmetry is not an end. Beyond such a plane the line
   // goes on as its mirror image, so that its length counts twice.
   const bool loop = chains.size() == 1 && chains[0].loop,
              from_mirror = !chains.empty() && chains.front().mirrored_at(0),
              to_mirror = !chains.empty() && chains.back().mirrored_at(1);
   const double length = arc[n - 1] - arc[0],
                least = share * (from_mirror || to_mirror ? 2 : 1) * length;
   NodeList away;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      if ((loop || from_mirror || arc[i] - arc[0] >= least) &&
          (loop || to_mirror || arc[n - 1] - arc[i] >= least))
      {
         away.push_back(i);
      }
   }
   return away;
}

Eigen::VectorXd traction_ratio(const ReducedProblem &problem,
                               const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   const Eigen::VectorXd forces = problem.clamped_forces(multipliers);
   const Eigen::VectorXd p = forces.tail(n);
   const Eigen::VectorXd q =
      m == n ? Eigen::VectorXd(forces.head(n)) : tangential_lengths(forces.head(m), n);
   // A node without pressure cannot stick with any friction.
   return (p.array() > 0).select(q.cwiseQuotient(p), infinity);
}

std::vector<Adhesion> adhesion_map(const ReducedProblem &problem, const LoadCycle &cycle,
                                   Eigen::Index vertex, const std::vector<double> &load_factors,
                                   const NodeList &nodes)
{
   cycle.validate(problem);
   check_vertex(cycle, vertex);
   const NodeList looked_at = chosen_nodes(problem, nodes);
   std::vector<Adhesion> map;
   for (const double load_factor : load_factors)
   {
      const Eigen::VectorXd ratio =
         traction_ratio(problem, cycle.constant + load_factor * cycle.varying.col(vertex));
      Eigen::Index worst = 0;
      const double friction = ratio(looked_at).cwiseAbs().maxCoeff(&worst);
      map.push_back({load_factor, friction, looked_at[worst]});
   }
   return map;
}

Incipience incipient_separation(const ReducedProblem &problem, const LoadCycle &cycle,
                                Eigen::Index vertex, const NodeList &nodes)
{
   check_vertex(cycle, vertex);
   const StuckForces forces = stuck_forces(problem, cycle);
   Incipience first{infinity, -1};
   for (const Eigen::Index i : chosen_nodes(problem, nodes))
   {
      // The node separates when p0 + λ p1 becomes negative.
      const double at = first_positive(0, -0.5 * forces.p1(i, vertex), -forces.p0(i, vertex));
      if (at < first.load_factor) { first = {at, i}; }
   }
   return first;
}

Incipience incipient_slip(const ReducedProblem &problem, const LoadCycle &cycle,
                          Eigen::Index vertex, const NodeList &nodes)
{
   check_vertex(cycle, vertex);
   const StuckForces forces = stuck_forces(problem, cycle);
   const ConeProgramme cones = friction_cones(problem, forces);
   const StuckForces &in = cones.loads;
   const Eigen::MatrixXd bound0 = cones.bound(0, in.p0), q0 = cones.skewed(in.q0, in.p0),
                         bound1 = cones.friction.cwiseProduct(in.p1),
                         q1 = cones.skewed(in.q1, in.p1);
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   Incipience first = incipient_separation(problem, cycle, vertex, nodes);
   for (const Eigen::Index i : chosen_nodes(problem, nodes))
   {
      for (Eigen::Index j = vertex; j < q0.cols(); j += forces.vertices())
      {
         // |q|² less the bound's square as a quadratic in λ; before separation the bound is
         // positive, so the squares suffice.
         double a = -bound1(i, j) * bound1(i, j), b = -bound0(i, j) * bound1(i, j),
                c = -bound0(i, j) * bound0(i, j);
         for (Eigen::Index k = i; k < m; k += n)
         {
            a += q1(k, j) * q1(k, j);
            b += q0(k, j) * q1(k, j);
            c += q0(k, j) * q0(k, j);
         }
         const double at = first_positive(a, b, c);
         if (at < first.load_factor) { first = {at, i}; }
      }
   }
   return first;
}

} // namespace cattaneo
