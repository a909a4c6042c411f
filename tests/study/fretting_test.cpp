// Corners of a square punch: intensities and exponents of their own.

#include "common/punch.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <comparison.hpp>

namespace
{

TEST(Fretting, SquarePunchIsACornerWithIntensitiesOfItsOwn)
{
   using namespace cattaneo;
   double before[2] = {0, 0};
   for (const int nodes : {101, 201})
   {
      miniapp::PunchOptions options;
      options.half_plane = true;
      options.nodes = nodes;
      options.domain = 1e3;
      miniapp::Scene punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(
         problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      const auto edges = contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      double found[2];
      for (const auto &edge : edges)
      {
         EXPECT_TRUE(edge.complete);
         EXPECT_THROW(fretting::near_edge(edge), InputError);
         const fretting::CornerFit fit =
            fretting::fit_corner(fretting::corner_modes(fretting::Corner{pi / 2, pi}),
                                 edge_tractions(problem, state, edge));
         // Symmetric: both corners alike, K_II included, as shear counts into the contact.
         if (edge.side > 0)
         {
            found[0] = fit.k_one.value;
            found[1] = fit.k_two.value;
         }
         else
         {
            EXPECT_NEAR(fit.k_one.value, found[0], 1e-6 * found[0]);
            EXPECT_NEAR(fit.k_two.value, found[1], 1e-5);
         }
         EXPECT_LT(fit.k_one.relative_error, 0.02);
         EXPECT_GT(fit.k_one.value, 0);
      }
      if (nodes == 201)
      {
         EXPECT_NEAR(found[0], before[0], 0.01 * before[0]);
         EXPECT_NEAR(found[1], before[1], 0.02 * found[0]);
      }
      std::copy(found, found + 2, before);
      RecordProperty("k_one", std::to_string(found[0]));
   }
}

TEST(Fretting, SquarePunchOnARigidPlaneHasItsOwnExponent)
{
   using namespace cattaneo;
   const fretting::CornerModes modes =
      fretting::corner_modes(fretting::RigidCorner{pi / 2, 0.3});
   double before = 0;
   for (const int nodes : {101, 201})
   {
      miniapp::PunchOptions options;
      options.nodes = nodes;
      options.grading = 1e-3;
      miniapp::Scene punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 2); // nothing slips
      ContactState state = ContactState::virgin(problem);
      march(problem, LoadHistory::through({Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0)}),
            state);
      const auto edges = contact_edges(problem, state, state);
      ASSERT_EQ(edges.size(), 2u);
      const EdgeTractions tractions = edge_tractions(problem, state, edges[0]);
      const fretting::CornerFit fit = fretting::fit_corner(modes, tractions);
      EXPECT_LT(fit.k_one.relative_error, 0.02);
      EXPECT_EQ(fit.k_two.nodes, 0);
      if (nodes == 201) { EXPECT_NEAR(fit.k_one.value, before, 0.005 * before); }
      before = fit.k_one.value;
      // Pressure and shear fall as r^{λ-1} with the mode's ratio: a slope over a decade, far
      // from the element at the corner and from the middle of the punch.
      std::vector<std::size_t> near;
      for (std::size_t i = 0; i < tractions.position.size(); i++)
      {
         const double r = tractions.position[i] - tractions.edge;
         if (r > 2e-3 && r < 2e-2) { near.push_back(i); }
      }
      ASSERT_GT(near.size(), 6u);
      const std::size_t i = near.front(), k = near.back();
      const double slope = std::log(tractions.pressure[k] / tractions.pressure[i]) /
                           std::log((tractions.position[k] - tractions.edge) /
                                    (tractions.position[i] - tractions.edge));
      EXPECT_NEAR(slope, modes.one.eigenvalue - 1, 0.01);
      EXPECT_NEAR(tractions.shear[i] / tractions.pressure[i], modes.one.shear, 0.01);
   }
}

} // namespace
