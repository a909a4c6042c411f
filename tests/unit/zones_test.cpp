#include <cattaneo/friction/zones.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;

/// Tractions of Hertz and Cattaneo–Mindlin on n nodes of [-1.5, 1.5]: a = 1, stick in |x| < c.
struct Sampled
{
   ReducedProblem problem;
   ContactState state;
};

Sampled cattaneo_mindlin(int n, double c, double shift)
{
   Sampled result;
   ReducedProblem &problem = result.problem;
   problem.C = Eigen::MatrixXd::Identity(n, n);
   problem.A = problem.C;
   problem.B = Eigen::MatrixXd::Zero(n, n);
   problem.gap = Eigen::VectorXd::Zero(n);
   problem.arc_length = Eigen::VectorXd::LinSpaced(n, 0, 3);
   problem.weights = Eigen::VectorXd::Constant(n, 3.0 / (n - 1));
   set_friction(problem, 0.5);
   result.state = ContactState::virgin(problem);
   for (int i = 0; i < n; ++i)
   {
      const double x = problem.arc_length[i] - 1.5 - shift;
      double p = 0, q = 0;
      NodeState state = NodeState::separation;
      if (std::abs(x) < 1)
      {
         p = std::sqrt(1 - x * x);
         q = -0.5 * p;
         state = NodeState::forward_slip;
         // Slip grows with the power 3/2 of the distance from the front.
         result.state.v[i] = std::pow(std::max(0.0, std::abs(x) - c), 1.5);
         if (std::abs(x) < c)
         {
            q += 0.5 * std::sqrt(c * c - x * x);
            state = NodeState::stick;
         }
      }
      result.state.status[i] = state;
      result.state.p[i] = p * problem.weights[i];
      result.state.q[i] = q * problem.weights[i];
   }
   return result;
}

TEST(Zones, EdgesOfHertzAndCattaneoMindlinAreFoundBetweenNodes)
{
   for (double shift : {0.0, 0.0037, 0.011, 0.023})
   {
      const Sampled s = cattaneo_mindlin(101, 0.6123, shift);
      const std::vector<Zone> all = zones(s.problem, s.state);
      ASSERT_EQ(all.size(), 5u);
      const double expected[] = {-1, -0.6123, 0.6123, 1};
      for (int k = 0; k < 4; ++k)
      {
         EXPECT_NEAR(all[k].to.position, 1.5 + shift + expected[k], 1e-10);
         EXPECT_EQ(all[k].to.position, all[k + 1].from.position);
         EXPECT_GT(all[k].to.error, 0);
         EXPECT_LE(all[k].to.error, 0.015 + 1e-12);
      }
      const Zone stick = widest_zone(s.problem, s.state, NodeState::stick);
      EXPECT_EQ(stick.first, all[2].first);
      const Zone contact = contact_zone(s.problem, s.state);
      EXPECT_NEAR(contact.to.position - contact.from.position, 2, 1e-10);
   }
}

TEST(Zones, StickThatGrowsIsReadFromItsReserve)
{
   // The slipping nodes did not start to slip at this edge: their way does not vanish there.
   for (double shift : {0.0, 0.0037, 0.011, 0.023})
   {
      Sampled s = cattaneo_mindlin(101, 0.6123, shift);
      s.state.slip_origin.array() -= 1;
      const Zone stick = widest_zone(s.problem, s.state, NodeState::stick);
      EXPECT_NEAR(stick.to.position, 1.5 + shift + 0.6123, 0.1 * 0.03);
      EXPECT_NEAR(stick.from.position, 1.5 + shift - 0.6123, 0.1 * 0.03);
   }
}

TEST(Zones, FewNodesFallBackToTheMiddle)
{
   const Sampled s = cattaneo_mindlin(9, 0.3, 0);
   for (const Zone &zone : zones(s.problem, s.state))
   {
      EXPECT_LE(zone.from.position, zone.to.position);
      EXPECT_LE(zone.to.error, 0.1876);
   }
   EXPECT_GT(widest_zone(s.problem, s.state, NodeState::backward_slip).first,
             widest_zone(s.problem, s.state, NodeState::backward_slip).last);
}

TEST(Zones, EndsOfACompleteContactAreItsEndNodes)
{
   Sampled s = cattaneo_mindlin(11, 0.5, 0);
   std::fill(s.state.status.begin(), s.state.status.end(), NodeState::stick);
   const std::vector<Zone> all = zones(s.problem, s.state);
   ASSERT_EQ(all.size(), 1u);
   EXPECT_EQ(all[0].from.position, 0);
   EXPECT_EQ(all[0].to.position, 3);
   EXPECT_EQ(all[0].to.error, 0);
}

TEST(Zones, OpeningAndSlipFindTheEdgesWherePressureAndReserveAreRough)
{
   // Opening beyond the edge and slip behind the front go as the 3/2 power of the distance,
   // but not exactly so; pressure and reserve are spoilt.
   const int n = 101;
   Sampled s = cattaneo_mindlin(n, 0.6123, 0.0037);
   for (int i = 0; i < n; ++i)
   {
      const double x = std::abs(s.problem.arc_length[i] - 1.5 - 0.0037);
      s.state.w[i] = std::pow(std::max(x - 1, 0.0), 1.5) * (1 + 0.3 * x);
      s.state.slip_origin[i] = 7;
      s.state.v[i] = 7 + std::pow(std::max(x - 0.6123, 0.0), 1.5) * (1 - 0.2 * x);
      const double noise = 1 + 0.05 * (i % 2);
      s.state.p[i] *= noise;
      s.state.q[i] *= noise;
   }
   const std::vector<Zone> all = zones(s.problem, s.state);
   ASSERT_EQ(all.size(), 5u);
   const double expected[] = {-1, -0.6123, 0.6123, 1};
   for (int k = 0; k < 4; ++k)
   {
      EXPECT_NEAR(all[k].to.position, 1.5037 + expected[k], 0.01 * 0.03);
      EXPECT_GE(all[k].to.error, std::abs(all[k].to.position - 1.5037 - expected[k]));
   }
}

TEST(Zones, AZoneNeverEndsBeforeItStarts)
{
   // One node of slip between stick and separation, with values that extrapolate wildly.
   Sampled s = cattaneo_mindlin(41, 0.95, 0.0);
   for (int i = 0; i < 41; ++i) { s.state.p[i] *= 1 + 0.5 * std::sin(3.0 * i); }
   for (const Zone &zone : zones(s.problem, s.state))
   {
      EXPECT_LE(zone.from.position, zone.to.position);
   }
}

} // namespace
