//  benchmark_mortar: error and time of interfaces whose nodes match, and of those that do not
//
//  Two half-planes, one with a cylinder's profile, are pressed together (Hertz) and sheared
//  (Cattaneo, Mindlin): the error of the tractions, root mean squares over the contact relative
//  to the closed forms, and the processor seconds from the meshes to the last state. `coarser`
//  elements are on 3.3 half-widths of the contact, the other body has so many times more; 1:1
//  once with the formulas of matching nodes and once as any other interface.

#include <algorithm>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>

using namespace cattaneo;

namespace
{

constexpr double friction = 0.3, half_width = 0.6, domain = 1e4, young = 1, poisson = 0.3;
const double modulus = young / (2 * (1 - poisson * poisson)), load = 1e-3 * modulus,
             radius = M_PI * modulus * half_width * half_width / (4 * load);

mfem::Mesh half_plane(int elements, bool above)
{
   std::vector<double> contact;
   for (int k = 0; k <= elements; ++k) { contact.push_back(-1 + 2.0 * k / elements); }
   mfem::Mesh mesh = half_plane_mesh(contact, graded(0, 1, 2.0 / elements, 1.25),
                                     ring_scales(1.0, domain, 2.0 / elements, 1.25));
   for (int v = 0; above && v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      x[0] = -x[0];
      x[1] = -x[1];
   }
   return mesh;
}

Reduction reduced(ElasticBody &lower, ElasticBody &upper, bool matching)
{
   const auto gap = [](double x, double) { return 0.5 * x * x / radius; };
   if (!matching)
   {
      return reduce({{"lower", &lower}, {"upper", &upper}},
                    {{"contact", {0, 1}, {1, 1}, SlaveSide::coarser, ScalarField(gap)}});
   }
   const ContactLine line1 = contact_line(lower, 1), line2 = contact_line(upper, 1);
   const Pairing pairs = pair_lines(line1, line2);
   Reduction made = reduce(condense(lower, line1), condense(upper, line2), pairs);
   for (Eigen::Index i = 0; i < made.problem.nodes(); ++i)
   {
      made.problem.gap[i] = gap(made.problem.position(i, 0), 0);
   }
   return made;
}

/// Relative root mean square of nodal forces against a traction.
template <class Exact>
double error(const ReducedProblem &problem, const Eigen::VectorXd &force, Exact exact)
{
   double off = 0, size = 0;
   for (Eigen::Index i = 0; i < problem.nodes(); ++i)
   {
      const double value = exact(problem.position(i, 0)), weight = problem.weights[i];
      off += weight * std::pow(force[i] / weight - value, 2);
      size += weight * value * value;
   }
   return std::sqrt(off / size);
}

void row(int order, int below, int above, bool matching)
{
   const std::clock_t began = std::clock();
   mfem::Mesh low = half_plane(below, false), high = half_plane(above, true);
   ElasticBody lower(low, order, Material{young, poisson}),
      upper(high, order, Material{young, poisson});
   const BoundaryPart far({3, 4});
   for (int component : {0, 1}) { lower.fix(far, component); }
   upper.add_displacement("shift", far, 0, 1.0);
   upper.add_traction("P", 3, 0.0, -load / (2 * domain));
   Reduction reduction = reduced(lower, upper, matching);
   ReducedProblem &problem = reduction.problem;
   set_friction(problem, friction);
   const double p0 = 2 * load / (M_PI * half_width);
   const auto root = [](double x, double b)
   { return x * x < b * b ? std::sqrt(1 - x * x / (b * b)) : 0; };
   double pressure = 0, shear = 0;
   ContactState state = ContactState::virgin(problem);
   const LoadHistory history = LoadHistory::through(
      problem, {{}, {{"P", 1}}, {{"P", 1}, {"shift", 5 * friction * load / modulus}}});
   const MarchReport report =
      march(problem, history, state, {},
            [&](const ContactState &now, const IncrementRecord &)
            {
               if (now.time <= 1)
               {
                  pressure =
                     error(problem, now.p, [&](double x) { return p0 * root(x, half_width); });
                  return;
               }
               const double Q = std::abs(now.q.sum()) / (friction * load);
               if (Q < 0.3 || Q > 0.8) { return; }
               const double c = half_width * std::sqrt(1 - Q);
               const auto exact = [&](double x)
               { return friction * p0 * (root(x, half_width) - c / half_width * root(x, c)); };
               shear = std::max(shear, error(problem, now.q.cwiseAbs(), exact));
            });
   const double seconds = double(std::clock() - began) / CLOCKS_PER_SEC;
   std::printf("%5d %9d %9d %-9s %8ld %10.5f %10.5f %9.3f  %s\n", order, below, above,
               matching ? "matching" : "mortar", static_cast<long>(problem.nodes()), pressure,
               shear, seconds, name(report.status));
   std::fflush(stdout);
}

} // namespace

int main()
{
   std::printf("%5s %9s %9s %-9s %8s %10s %10s %9s\n", "order", "coarser", "other", "nodes",
               "nodes", "pressure", "shear", "seconds");
   for (int order : {1, 2})
   {
      for (int coarser : {32, 64, 128})
      {
         const int elements = coarser / order;
         row(order, elements, elements, true);
         for (double ratio : {1.0, 1.37, 3.0})
         {
            row(order, elements, static_cast<int>(std::lround(ratio * elements)), false);
         }
      }
   }
   return 0;
}
