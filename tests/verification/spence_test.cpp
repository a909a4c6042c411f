#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <gtest/gtest.h>
#include <record.hpp>

// Spence (1968): pressed monotonically on an elastic half-space with friction, a rigid flat
// punch and a rigid sphere stick within the same fraction of their contact radius, at every
// load.

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

/// Half-space under contact candidates 0 < r < 1 of the given element edges; pattern "approach"
/// presses it on a rigid obstacle.
Reduction pressed(const std::vector<double> &contact, double smallest)
{
   mfem::Mesh mesh = half_space_mesh(contact, graded(0, 1, smallest, 1.25),
                                     ring_scales(1.0, 1e5, smallest, 1.25));
   ElasticBody body(mesh, 2, Material{1.0, 0.3}, Formulation::axisymmetric);
   const BoundaryPart far({3, 4});
   body.fix(far, 0);
   body.add_displacement("approach", far, 1, 1.0);
   Reduction reduction = reduce(condense(body, contact_line(body, 1)));
   set_friction(reduction.problem, 0.25);
   return reduction;
}

/// Radius of the outer end of a zone; the contact line runs inward.
double radius(const ReducedProblem &problem, const Zone &zone)
{
   return problem.position(0, 0) - (zone.from.position - problem.arc_length[0]);
}

/// Mean of the fraction that sticks under a sphere, over all loads with a contact radius above
/// a half; none is further from it than half an element at that radius for each of the two
/// radii: (1 + c/a) / (2 elements a) < 2 / elements.
double sphere_fraction(int elements)
{
   std::vector<double> even;
   for (int k = 0; k <= elements; ++k) { even.push_back(double(k) / elements); }
   Reduction round = pressed(even, 1.0 / elements);
   ReducedProblem &problem = round.problem;
   problem.gap = 0.5 * problem.position.col(0).array().square();
   const double toward = problem.patterns[0].p.sum() > 0 ? 1 : -1;
   MarchSettings settings;
   settings.increments = 2 * elements;
   std::vector<double> fractions;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Constant(1, 0.81 * toward)}),
      state, settings,
      [&](const ContactState &now, const IncrementRecord &)
      {
         // Where a node closes the slip of the others begins anew: read at equal loads instead.
         const double share = now.time * settings.increments;
         const double a = radius(problem, contact_zone(problem, now));
         if (std::abs(share - std::round(share)) > 1e-9 || a < 0.5) { return; }
         fractions.push_back(
            radius(problem, widest_zone(zones(problem, now), NodeState::stick)) / a);
      });
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_GT(fractions.size(), 10u);
   double mean = 0;
   for (double fraction : fractions) { mean += fraction / fractions.size(); }
   for (double fraction : fractions) { EXPECT_NEAR(fraction, mean, 2.0 / elements); }
   return mean;
}

TEST(Spence, PunchAndSphereStickWithinTheSameFraction)
{
   std::vector<double> edges = graded(1, 0, 1e-3, 1.25, 0.02);
   std::reverse(edges.begin(), edges.end());
   const Reduction flat = pressed(edges, 1e-3);
   // The approach is upward or downward in the mesh's frame: towards the obstacle.
   const double toward = flat.problem.patterns[0].p.sum() > 0 ? 1 : -1;
   ContactState state = ContactState::virgin(flat.problem);
   FrictionSolver solver(flat.problem);
   ASSERT_EQ(solver.solve(state, VectorXd::Constant(1, toward)).status,
             FrictionStatus::converged);
   const Zone stick = widest_zone(zones(flat.problem, state), NodeState::stick);
   const double fraction = radius(flat.problem, stick);
   EXPECT_GT(fraction, 0.2);
   EXPECT_LT(fraction, 0.9);

   // Contact that advances by whole elements: the fraction wavers about a mean that converges
   // with the elements' size, from below.
   const double coarse = sphere_fraction(25), fine = sphere_fraction(50);
   EXPECT_LT(coarse, fine);
   EXPECT_LT(fine, fraction);
   EXPECT_NEAR(2 * fine - coarse, fraction, 0.01);
   cattaneo_test::record("punch", fraction);
   cattaneo_test::record("sphere", 2 * fine - coarse);
}

} // namespace
