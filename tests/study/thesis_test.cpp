// The thesis' studies in one process: the scene of each, solved, beside the studies' notes.
// Values have the ± of the notes and of a read-out of edges, a tenth of the spacing of the
// contact nodes.

#include "common/disc_scene.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;

/// The state of a problem at the end of a march through loads by name, from rest.
ContactState after_loads(const ReducedProblem &problem, const std::vector<NamedLoads> &loads)
{
   std::vector<NamedLoads> points = {{}};
   points.insert(points.end(), loads.begin(), loads.end());
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, LoadHistory::through(problem, points), state);
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   return state;
}

double half_width(const Zone &zone)
{
   return 0.5 * (zone.to.position - zone.from.position);
}

// Part A: 201 nodes, 0.02 a apart in the middle.
TEST(ThesisStudies, StickOfThePressedSquarePunch)
{
   miniapp::Scene scene = miniapp::make_punch({});
   ReducedProblem &problem = scene.problem();
   set_friction(problem, 0.2);
   const ContactState pressed = after_loads(problem, {{{"P", 1}}});
   EXPECT_NEAR(half_width(stick_zone(problem, pressed)), 0.471, 0.003 + 0.002);
   EXPECT_NEAR(pressed.v.cwiseAbs().maxCoeff(), 0.0496, 5e-4);
   // Arc length begins at the left corner, at x = -a.
   const double ends[] = {0.19, -0.203, -0.511, -0.729}, shears[] = {0.25, 0.5, 0.75, 0.9};
   std::vector<NamedLoads> loads = {{{"P", 1}}};
   for (int k = 0; k < 4; ++k)
   {
      loads.push_back({{"P", 1}, {"Q", 0.2 * shears[k]}});
      const ContactState sheared = after_loads(problem, loads);
      EXPECT_NEAR(stick_zone(problem, sheared).to.position - 1, ends[k], 0.005 + 0.002)
         << shears[k];
   }
}

// Part B: a strip whose end lifts off a block of 10⁴ t, n = 4; ξ counts from the end of the
// load.
TEST(ThesisStudies, BordersOfThePlaneRecedingContact)
{
   miniapp::RecedingOptions options;
   options.domain = 1e4;
   miniapp::Scene scene = miniapp::make_receding(options);
   ReducedProblem &problem = scene.problem();
   struct
   {
      double friction, s, e;
   } const references[] = {
      {0.3, 0.903, -1.858}, {0.5, 1.169, -0.883}, {0.7, 1.406, -0.442}, {1, 1.730, -0.046}};
   for (const auto &[friction, s, e] : references)
   {
      set_friction(problem, friction);
      const ContactState loaded = after_loads(problem, {{{miniapp::overhang_load(4), 1}}});
      EXPECT_NEAR(4 - contact_zone(problem, loaded).from.position, s, 0.003 + 0.002)
         << friction;
      EXPECT_NEAR(4 - stick_zone(problem, loaded).from.position, e, 0.003 + 0.002) << friction;
   }
}

// Part D: a disc on a half-space, b = 5.
TEST(ThesisStudies, BordersOfTheAxisymmetricRecedingContact)
{
   miniapp::DiscOptions options;
   options.load_radii = {0.5, 2.5};
   miniapp::Scene scene = miniapp::make_disc(options);
   ReducedProblem &problem = scene.problem();
   struct
   {
      double radius, friction, d, c;
   } const references[] = {
      {0.5, 0.9, 2.625, 0.849}, {2.5, 0.5, 3.728, 1.879}, {2.5, 0.8, 4.046, 2.384}};
   for (const auto &[radius, friction, d, c] : references)
   {
      set_friction(problem, friction);
      const ContactState loaded = after_loads(problem, {{{miniapp::radius_load(radius), 1}}});
      EXPECT_NEAR(contact_zone(problem, loaded).to.position, d, 0.001 + 0.002) << radius;
      EXPECT_NEAR(stick_zone(problem, loaded).to.position, c, 0.001 + 0.002) << radius;
   }
}

// Part C: T = 0.04 P0, f = 0.2; nodes are 0.0125 t apart.
TEST(ThesisStudies, ContactOfThePulledLapJoint)
{
   miniapp::Scene scene = miniapp::make_lap_joint({});
   ReducedProblem &problem = scene.problem();
   set_friction(problem, 0.2);
   const std::string pinch = miniapp::pinch_load(0, 1);
   const NamedLoads pinched = {{pinch, 1}}, pulled = {{pinch, 1}, {"T", 0.04}};
   const double read_out = 0.1 * 0.0125;
   const ContactState first = after_loads(problem, {pinched}),
                      second = after_loads(problem, {pinched, pulled});
   EXPECT_NEAR(half_width(contact_zone(problem, first)), 0.7011, 5e-4 + read_out);
   EXPECT_NEAR(tractions(problem, first.p).maxCoeff(), 1.0468, 2e-4 + 1e-3);
   EXPECT_NEAR(half_width(contact_zone(problem, second)), 0.6596, 5e-4 + read_out);
   EXPECT_NEAR(half_width(stick_zone(problem, second)), 0.760 * 0.6596, 5e-4 + read_out);
}

// Part A: a block on a half-plane, Q to and fro. Extremes of tractions lie between the nodes,
// of a part in two hundred.
TEST(ThesisLimits, ShakedownOfABlock)
{
   miniapp::PunchOptions options;
   options.half_plane = true;
   ReducedProblem problem = miniapp::make_punch(options).problem();
   for (const auto &[friction, ratio, limit, spread] : {std::tuple{0.85, -1.0, 0.8040, 3e-4},
                                                        {1.0, -1.0, 0.8059, 3e-4},
                                                        {0.85, -0.5, 0.9915, 5e-5}})
   {
      set_friction(problem, friction);
      const LoadCycle cycle =
         LoadCycle::through(problem, {{"P", 1}}, {{{"Q", 1}}, {{"Q", ratio}}});
      const LimitReport report = load_limit(limit_problem(problem, cycle));
      ASSERT_EQ(report.status, LimitStatus::certified);
      EXPECT_NEAR(report.limit / friction, limit, spread + 7.5e-4) << friction << " " << ratio;
   }
}

} // namespace
