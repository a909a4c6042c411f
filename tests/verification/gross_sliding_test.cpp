// A free block slides when the shear reaches f P, whatever its elasticity: equilibrium alone
// says so.

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Vector2d;

TEST(GrossSliding, HappensAtCoulombsLimit)
{
   for (double young : {0.91, 1.0, 1e9})
   {
      for (int order : {1, 2})
      {
         mfem::Mesh mesh =
            mfem::Mesh::MakeCartesian2D(20, 10, mfem::Element::QUADRILATERAL, true, 2.0, 2.0);
         ElasticBody block(mesh, order, Material{young, 0.3});
         block.add_pressure("P", 3, 0.5);
         block.add_traction("Q", 3, 0.5, 0.0);
         block.add_pressure("Q", 3, [](double x, double) { return -3 * (x - 1); });
         Reduction reduction = reduce(condense(block, contact_line(block, 1)));
         set_friction(reduction.problem, 0.3);
         ContactState state = ContactState::virgin(reduction.problem);
         const MarchReport report = march(
            reduction.problem,
            LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.4)}), state);
         EXPECT_EQ(report.status, FrictionStatus::gross_sliding) << report.message;
         EXPECT_NEAR(report.event_multipliers[1], 0.3, 1e-9);
         // The state left is the last equilibrium, not a runaway.
         EXPECT_LT(state.v.cwiseAbs().maxCoeff() * young, 1e3);
         EXPECT_NEAR(state.q.sum(), -report.event_multipliers[1], 1e-9);
      }
   }
}

} // namespace
