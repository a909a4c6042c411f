#include "closed_form_borders.hpp"
#include "expect_input_error.hpp"
#include "sampled_tractions.hpp"

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using cattaneo_test::cattaneo_mindlin;
using cattaneo_test::Sampled;

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
      const Zone stick = widest_zone(zones(s.problem, s.state), NodeState::stick);
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
      const Zone stick = widest_zone(zones(s.problem, s.state), NodeState::stick);
      EXPECT_NEAR(stick.to.position, 1.5 + shift + 0.6123, 0.1 * 0.03);
      EXPECT_NEAR(stick.from.position, 1.5 + shift - 0.6123, 0.1 * 0.03);
   }
}

/// The ± of a border is an estimate: beside closed forms it holds mostly, and nowhere is a
/// border off by two spacings, on meshes from 8 elements on. benchmark_borders prints more of
/// them.
TEST(Zones, EstimatesOfBordersMostlyHold)
{
   int found = 0, inside = 0;
   for (const int elements : {8, 10, 12, 16, 24})
   {
      for (const int order : {1, 2})
      {
         for (int k = 0; k < 9; ++k)
         {
            cattaneo_test::Parabola of;
            for (int i = 0; i <= elements; ++i)
            {
               of.grid.push_back(1.5 * (2.0 * i / elements - 1));
            }
            of.order = order;
            of.middle = 0.1 * k / elements;
            of.shear = 0.3 + 0.3 * (k % 3);
            of.back_to = k / 3 == 1 ? -0.4 : 1;
            of.shift = k / 3 == 2 ? 0.25 * of.shear : 0;
            const auto borders = cattaneo_test::borders_of(of);
            ASSERT_EQ(borders.size(), 4u) << elements << ' ' << order << ' ' << k;
            for (const cattaneo_test::KnownBorder &border : borders)
            {
               found += border.found;
               inside += border.inside();
               if (border.found) { EXPECT_LT(border.error(), 2 * border.spacing); }
            }
         }
      }
   }
   EXPECT_GT(found, 350);
   EXPECT_GT(inside, 0.9 * found);
}

TEST(Zones, FewNodesFallBackToTheMiddle)
{
   const Sampled s = cattaneo_mindlin(9, 0.3, 0);
   for (const Zone &zone : zones(s.problem, s.state))
   {
      EXPECT_LE(zone.from.position, zone.to.position);
      EXPECT_LE(zone.to.error, 0.3751) << "a spacing";
   }
   EXPECT_GT(widest_zone(zones(s.problem, s.state), NodeState::backward_slip).first,
             widest_zone(zones(s.problem, s.state), NodeState::backward_slip).last);
}

TEST(Zones, EndsOfACompleteContactAreItsEndNodes)
{
   Sampled s = cattaneo_mindlin(11, 0.5, 0);
   std::fill(s.state.status.begin(), s.state.status.end(), NodeState::stick);
   s.state.p.setOnes();
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
   // Stick, one node k of slip, separation, nodes one apart. The frictional reserve falls to
   // zero at k + 0.25 and the pressure at k - 0.2: both within what an edge may be off its
   // nodes, but then slip would end before it starts.
   const int n = 20, k = 12;
   Sampled s = cattaneo_mindlin(n, 0.5, 0);
   s.problem.arc_length = Eigen::VectorXd::LinSpaced(n, 0, n - 1);
   s.problem.weights.setOnes();
   s.state = ContactState::virgin(s.problem);
   for (int i = 0; i < n; ++i)
   {
      s.state.status[i] = i < k    ? NodeState::stick
                          : i == k ? NodeState::forward_slip
                                   : NodeState::separation;
      if (i > k) { continue; }
      const double p = i < k ? std::sqrt(k - i - 0.2) : 0.1;
      const double reserve = i < k ? 0.02 * std::sqrt(k - i + 0.25) : 0;
      s.state.p[i] = p;
      s.state.q[i] = -(0.5 * p - reserve);
   }
   s.state.v[k] = 1e-3; // else it does not slip
   // The edge of contact by itself is read where it was put.
   Sampled stuck = s;
   stuck.state.status[k] = NodeState::stick;
   EXPECT_NEAR(contact_zone(stuck.problem, stuck.state).to.position, k - 0.2, 1e-6);
   // Together its nodes are all that is known of the zone: it ends half way to the next ones.
   const std::vector<Zone> all = zones(s.problem, s.state);
   ASSERT_EQ(all.size(), 3u);
   EXPECT_EQ(all[0].to.position, k - 0.5);
   EXPECT_EQ(all[1].from.position, k - 0.5);
   EXPECT_EQ(all[1].to.position, k + 0.5);
   EXPECT_EQ(all[2].from.position, k + 0.5);
   // By a spacing at most: the borders that were put lie 0.75 and 0.7 away.
   EXPECT_EQ(all[1].from.error, 1);
   EXPECT_EQ(all[1].to.error, 1);
}

TEST(Zones, NodesThatLieOnTheLimitAndDoNotMoveStickWhateverTheirStatus)
{
   // A reload peak: slip in |x| > 0.8, on the limit in |x| > 0.6, and the states there a toss.
   std::vector<Zone> first;
   for (unsigned toss : {0u, 0x5555u, 0xffffu, 0x3c3cu})
   {
      Sampled s = cattaneo_mindlin(101, 0.6, 0);
      for (int i = 0; i < 101; ++i)
      {
         const double x = std::abs(s.problem.arc_length[i] - 1.5);
         s.state.slip_origin[i] = s.state.v[i] - std::pow(std::max(0.0, x - 0.8), 1.5);
         const bool tie = x > 0.6 && x < 0.8;
         // A tie that the solver calls slip may have moved by a round-off.
         if (tie && ((toss >> (i % 16)) & 1)) { s.state.slip_origin[i] -= 1e-17; }
         else if (tie) { s.state.status[i] = NodeState::stick; }
      }
      const std::vector<Zone> all = zones(s.problem, s.state);
      ASSERT_EQ(all.size(), 5u) << toss;
      EXPECT_NEAR(all[2].from.position, 1.5 - 0.8, 1e-10);
      EXPECT_NEAR(all[2].to.position, 1.5 + 0.8, 1e-10);
      if (first.empty()) { first = all; }
      for (std::size_t k = 0; k < all.size(); ++k)
      {
         EXPECT_EQ(all[k].first, first[k].first);
         EXPECT_EQ(all[k].to.position, first[k].to.position);
         EXPECT_EQ(all[k].to.error, first[k].to.error);
      }
   }
}

TEST(Zones, WithoutForceNothingIsInContact)
{
   // Back at zero load what touches carries nothing, whatever its status.
   Sampled s = cattaneo_mindlin(21, 0.6, 0);
   s.state.peak_force = s.state.p.maxCoeff();
   for (int i = 0; i < 21; ++i)
   {
      s.state.p[i] = (i % 3 - 1) * 1e-17;
      s.state.q[i] = (i % 5 - 2) * 1e-17;
      s.state.status[i] = i % 2 ? NodeState::stick : NodeState::forward_slip;
   }
   const std::vector<Zone> all = zones(s.problem, s.state);
   ASSERT_EQ(all.size(), 1u);
   EXPECT_EQ(all[0].state, NodeState::separation);
   EXPECT_GT(contact_zone(s.problem, s.state).first, contact_zone(s.problem, s.state).last);
}

TEST(Zones, OfACycleAreReadFromSlipAlone)
{
   // The border at 0.7123, in whatever states the cycle's last increment left the nodes.
   for (int states = 0; states < 3; ++states)
   {
      Sampled s = cattaneo_mindlin(101, 0.4, 0);
      SlipRange range(s.problem);
      for (double load : {0.3, 1.0, -0.2, 0.5})
      {
         ContactState now = s.state;
         for (int i = 0; i < 101; ++i)
         {
            const double x = std::abs(s.problem.arc_length[i] - 1.5);
            now.v[i] = 5 + load * std::pow(std::max(0.0, x - 0.7123), 1.5);
         }
         range.note(now);
      }
      for (NodeState &node : s.state.status)
      {
         if (closed(node) && states == 1) { node = NodeState::stick; }
         if (closed(node) && states == 2) { node = NodeState::backward_slip; }
      }
      const std::vector<Zone> all = zones(s.problem, s.state, range);
      const Zone held = stick_zone(s.problem, all);
      EXPECT_NEAR(held.from.position, 1.5 - 0.7123, 1e-10);
      EXPECT_NEAR(held.to.position, 1.5 + 0.7123, 1e-10);
      ASSERT_EQ(all.size(), 5u);
      EXPECT_EQ(all[1].state, NodeState::slip);
   }
}

TEST(Zones, EndWhereAChainEnds)
{
   // Two feet, 0 … 1 and 1 … 2 in arc length, which may grow from one to the other or not.
   for (bool grows : {true, false})
   {
      Sampled s = cattaneo_mindlin(12, 0.5, 0);
      s.state.p.setOnes();
      s.state.status.assign(12, NodeState::stick);
      for (int i = 0; i < 12; ++i) { s.problem.arc_length[i] = 0.2 * (i < 6 ? i : i - 1); }
      s.problem.chains.assign(2, one_chain(6).front());
      s.problem.chains[1].first = 6;
      if (grows) { s.problem.arc_length.tail(6).array() += 0.1; }
      const std::vector<Zone> all = zones(s.problem, s.state);
      ASSERT_EQ(all.size(), 2u);
      EXPECT_EQ(all[0].last, 5);
      EXPECT_EQ(all[1].first, 6);
      EXPECT_EQ(all[1].chain, 1);
      EXPECT_DOUBLE_EQ(all[0].to.position, 1);
      const Zone contact = contact_zone(s.problem, s.state);
      EXPECT_NEAR(contact.to.position - contact.from.position, 1, 1e-14);
      EXPECT_EQ(contact_zones(all).size(), 2u);
      // In the second foot a border lies between nodes, halfway where nothing tells where.
      s.state.p.tail(2).setZero();
      s.state.status[10] = s.state.status[11] = NodeState::separation;
      const std::vector<Zone> open = zones(s.problem, s.state);
      ASSERT_EQ(open.size(), 3u);
      EXPECT_EQ(open[1].to.position, open[2].from.position);
      EXPECT_GT(open[1].to.position, s.problem.arc_length[9]);
      EXPECT_LT(open[1].to.position, s.problem.arc_length[10]);
      s.problem.chains.clear();
      expect_input_error([&] { zones(s.problem, s.state); },
                         "which say which nodes follow each other");
   }
}

TEST(Zones, StickThatReachesTheEdgeOfContactIsKnownToASpacing)
{
   // No node slips: how far it reaches between the last two does not show.
   const Sampled s = cattaneo_mindlin(101, 0.999, 0);
   const Zone stick = stick_zone(s.problem, s.state),
              contact = contact_zone(s.problem, s.state);
   EXPECT_EQ(stick.last, contact.last);
   EXPECT_GE(stick.to.error, 0.03 * (1 - 1e-12));
   EXPECT_LT(contact.to.error, 0.03);
}

} // namespace
