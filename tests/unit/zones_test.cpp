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
   // Right half of a Cattaneo–Mindlin contact: opening beyond the edge and slip behind the
   // front go as the 3/2 power of the distance; pressure and reserve are spoilt.
   const int n = 101;
   Sampled s = cattaneo_mindlin(n, 0.6123, 0.0037);
   for (int i = 0; i < n; ++i)
   {
      const double x = s.problem.arc_length[i] - 1.5 - 0.0037;
      s.state.w[i] = std::pow(std::max(std::abs(x) - 1, 0.0), 1.5) * (1 + 0.3 * std::abs(x));
      s.state.v[i] = 7 + std::pow(std::max(std::abs(x) - 0.6123, 0.0), 1.5);
      const double noise = 1 + 0.05 * (i % 2);
      s.state.p[i] *= noise;
      s.state.q[i] *= noise;
   }
   const Eigen::VectorXd before = Eigen::VectorXd::Constant(n, 7);
   const std::vector<Zone> all = zones(s.problem, s.state, before);
   ASSERT_EQ(all.size(), 5u);
   const double expected[] = {-1, -0.6123, 0.6123, 1};
   for (int k = 0; k < 4; ++k)
   {
      // A hundredth of the spacing; the opening's own curvature makes its edges inexact.
      EXPECT_NEAR(all[k].to.position, 1.5037 + expected[k], 3e-4);
      EXPECT_GE(all[k].to.error, std::abs(all[k].to.position - 1.5037 - expected[k]));
   }
   EXPECT_THROW(zones(s.problem, s.state, Eigen::VectorXd::Zero(3)), std::invalid_argument);
}

TEST(Zones, ASlipFrontThatRetreatedIsNotReadFromSlip)
{
   Sampled s = cattaneo_mindlin(101, 0.6123, 0.0037);
   for (int i = 0; i < 101; ++i) { s.state.v[i] = 1e-3 * i; } // slip in the stick zone as well
   const std::vector<Zone> with = zones(s.problem, s.state, Eigen::VectorXd::Constant(101, -1));
   const std::vector<Zone> without = zones(s.problem, s.state);
   EXPECT_EQ(with[1].to.position, without[1].to.position);
   EXPECT_EQ(with[2].to.position, without[2].to.position);
}

} // namespace
