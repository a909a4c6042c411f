#include "closed_form_borders.hpp"
#include "expect_input_error.hpp"
#include "sampled_tractions.hpp"

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace
{

using namespace cattaneo;
using cattaneo_test::cattaneo_mindlin;
using cattaneo_test::Sampled;

/// A row of n nodes 2 apart that are all pressed, stuck and far from their friction limit.
Sampled row(int n)
{
   Sampled s = cattaneo_mindlin(n, 0.5, 0);
   s.problem.arc_length = Eigen::VectorXd::LinSpaced(n, 0, 2 * (n - 1));
   s.problem.weights = Eigen::VectorXd::LinSpaced(n, 1, 2);
   s.state = ContactState::virgin(s.problem);
   s.state.p = 4 * s.problem.weights;
   s.state.peak_force = 1;
   return s;
}

/// The same nodes from the other end.
Sampled mirrored(const Sampled &s)
{
   Sampled image = s;
   image.problem.arc_length =
      s.problem.arc_length[s.problem.nodes() - 1] - s.problem.arc_length.reverse().array();
   image.problem.weights = s.problem.weights.reverse();
   image.problem.gap = s.problem.gap.reverse();
   for (ContactChain &chain : image.problem.chains)
   {
      std::swap(chain.ends[0], chain.ends[1]);
      std::swap(chain.other_ends[0], chain.other_ends[1]);
   }
   for (Eigen::VectorXd ContactState::*x :
        {&ContactState::v, &ContactState::w, &ContactState::q, &ContactState::p,
         &ContactState::slip_origin})
   {
      image.state.*x = (s.state.*x).reverse();
   }
   std::reverse(image.state.status.begin(), image.state.status.end());
   return image;
}

/// Expects the border of the first two zones at a distance and with an error in spacings of the
/// last node of the first zone, and the same from the other side.
void expect_border(const Sampled &s, double distance, double error, const std::string &what)
{
   const std::vector<Zone> all = zones(s.problem, s.state);
   ASSERT_EQ(all.size(), 2u) << what;
   const double node = s.problem.arc_length[all[0].last];
   EXPECT_NEAR(all[0].to.position, node + 2 * distance, 1e-9) << what;
   EXPECT_NEAR(all[0].to.error, 2 * error, 1e-9) << what;
   const Sampled image = mirrored(s);
   const std::vector<Zone> other = zones(image.problem, image.state);
   ASSERT_EQ(other.size(), 2u) << what;
   const double length = s.problem.arc_length[s.problem.nodes() - 1];
   EXPECT_NEAR(other[1].from.position, length - node - 2 * distance, 1e-9) << what;
   EXPECT_NEAR(other[1].from.error, 2 * error, 1e-9) << what;
}

// The least-squares line through y(k) at k = 0, 1, 2 vanishes at 1 - mean/((y2 - y0)/2), the
// line through the first two at -y0/(y1 - y0); likewise for k = 1, 2, 3.
TEST(Zones, EndsOfShortZonesAreThoseOfALineThroughTheirLastNodes)
{
   // The reserve f p - |q| of stuck nodes, by its square; the one node of slip says nothing.
   // (0.6, 1.6, 2.4): 1 - 1.5333/0.9; (1.6, 2.4, 3): 2 - 2.3333/0.7.
   const double reserve2[] = {0.6, 1.6, 2.4, 3.0};
   for (int stuck : {2, 3, 4, 9})
   {
      Sampled s = row(stuck + 1);
      for (int k = 0; k < stuck; ++k)
      {
         const int i = stuck - 1 - k;
         const double p = 4 + 0.3 * k;
         s.state.p[i] = p * s.problem.weights[i];
         const double q = 0.5 * p - std::sqrt(reserve2[std::min(k, 3)]);
         s.state.q[i] = (k % 2 ? q : -q) * s.problem.weights[i];
      }
      s.state.status[stuck] = NodeState::forward_slip;
      s.state.v[stuck] = 1;
      const double line = 1.5333333333333333 / 0.9 - 1, other = 2.3333333333333333 / 0.7 - 2;
      // One line without another that tells how sure it is: a spacing. None: the middle.
      expect_border(s, stuck < 3 ? 0.5 : line, stuck < 4 ? 1 : other - line, "reserve");
      // A stuck node on the limit has no reserve, and shows nothing.
      if (stuck < 4) { continue; }
      for (int k : {0, 3})
      {
         Sampled tie = s;
         const int i = stuck - 1 - k;
         tie.state.q[i] = 0.5 * (1 - 1e-13) * tie.state.p[i]; // to round-off
         expect_border(tie, 0.5, 1, "on the limit");
      }
   }
   // Slip beside nodes that are stuck on the limit, by its power 2/3, and the pressure at the
   // end of contact by its square, beside nodes that open by nothing.
   const double value[] = {0.8, 1.5, 3.0, 4.4, 5.5};
   const double from_0 = 1 - 1.7666666666666666 / 1.1, from_1 = 2 - 2.9666666666666667 / 1.45,
                two = -0.8 / 0.7;
   for (int n : {1, 2, 3, 4, 5})
   {
      Sampled slip = row(n + 4), contact = slip;
      slip.state.q = 0.5 * slip.state.p;
      for (int k = 0; k < n; ++k)
      {
         const int i = 4 + k;
         slip.state.status[i] = NodeState::backward_slip;
         slip.state.slip_origin[i] = 3;
         slip.state.v[i] = 3 - std::pow(value[k], 1.5);
         contact.state.p[i] = std::sqrt(value[k]) * contact.problem.weights[i];
      }
      for (int i = 0; i < 4; ++i)
      {
         contact.state.status[i] = NodeState::separation;
         contact.state.p[i] = 0;
      }
      // The first node behind a slip front is left out where there are enough others.
      const double front = n >= 4 ? from_1 : n == 3 ? from_0 : n == 2 ? two : -0.5;
      expect_border(slip, 1 + front,
                    n >= 4   ? from_1 - from_0
                    : n == 3 ? from_0 - two
                             : 1,
                    "slip of " + std::to_string(n));
      expect_border(contact, n >= 3 ? 1 + from_0 : 0.5, n >= 3 ? from_0 - two : 1,
                    "contact of " + std::to_string(n));
   }
   // Where the line through two is the further in, and where one ends too far in the zone.
   for (const bool inside : {false, true})
   {
      Sampled contact = row(6);
      const Eigen::Vector3d squares =
         inside ? Eigen::Vector3d(0.01, 0.01, 1) : Eigen::Vector3d(0.6, 2, 2.2);
      for (int i = 0; i < 6; ++i)
      {
         contact.state.status[i] = i < 3 ? NodeState::separation : NodeState::stick;
         contact.state.p[i] =
            i < 3 ? 0 : std::sqrt(squares[i - 3]) * contact.problem.weights[i];
      }
      // (0.6 + 2 + 2.2)/3 is 2 slopes of 0.8; the line through two vanishes at -0.6/1.4.
      expect_border(contact, inside ? 0.5 : 0, inside ? 1 : 1 - 0.6 / 1.4, "bent");
   }
}

TEST(Zones, EndsOfLongZonesAreThoseOfAParabolaThroughTheNodesThatCount)
{
   // It vanishes 0.4 spacings before the first node; whatever other nodes say is not asked.
   const auto parabola = [](int k) { return (k + 0.4) * (1 + 0.05 * k); };
   for (int n : {6, 7, 9, 14})
   {
      // Slip and opening: nodes 1 to 5.
      Sampled slip = row(n + 4), opening = slip, contact = slip;
      slip.state.q = 0.5 * slip.state.p;
      for (int k = 0; k < n; ++k)
      {
         const int i = 4 + k;
         const bool counts = k >= 1 && k <= 5;
         const double way = std::pow(parabola(k), 1.5) * (counts ? 1 : 0.7);
         slip.state.status[i] = NodeState::forward_slip;
         slip.state.v[i] = way;
         opening.state.status[i] = NodeState::separation;
         opening.state.p[i] = 0;
         opening.problem.gap[i] = 0.04 * k * way;
         opening.state.w[i] = way - opening.problem.gap[i];
         // Pressure: of seven nodes and more the third to the tenth, the second to the last but
         // two to tell how sure that is.
         const bool bears = k >= 1 && k < 10;
         contact.state.p[i] =
            std::sqrt(parabola(k)) * (bears ? 1 : 0.7) * slip.problem.weights[i];
      }
      expect_border(slip, 0.6, 0.25, "slip of " + std::to_string(n));
      expect_border(opening, 0.6, 0.25, "opening of " + std::to_string(n));
      if (n < 7) { continue; }
      for (int i = 0; i < 4; ++i)
      {
         contact.state.status[i] = NodeState::separation;
         contact.state.p[i] = 0;
      }
      expect_border(contact, 0.6, 0.5, "contact of " + std::to_string(n));
      contact.state.p[5] *= 0.2; // in the one that tells how sure it is only
      const Zone closed = contact_zone(contact.problem, contact.state);
      EXPECT_NEAR(closed.from.position, 2 * (3 + 0.6), 1e-9);
      EXPECT_GT(closed.from.error, 2 * 0.5);
   }
}

TEST(Zones, OppositeSlipMeetsWhereTheShearTractionVanishes)
{
   Sampled s = row(6);
   const double x = 5.3; // between nodes 2 and 3, at 4 and 6
   for (int i = 0; i < 6; ++i)
   {
      const double shear = 0.2 * (s.problem.arc_length[i] - x);
      s.state.status[i] = shear < 0 ? NodeState::forward_slip : NodeState::backward_slip;
      s.state.q[i] = shear * s.problem.weights[i];
      s.state.v[i] = 1;
   }
   expect_border(s, 0.65, 1, "shear");
   s.state.q.setZero();
   expect_border(s, 0.5, 1, "no shear");
}

TEST(Zones, AreSettledByWhatEachNodeBearsAndDid)
{
   Sampled s = row(8);
   s.problem.friction.tail(5).setZero();
   s.problem.held = {7};
   s.problem.gap[1] = 0.25;
   s.state.w[1] = -0.25;
   s.state.p[0] = s.state.p[1] = s.state.p[2] = 0;
   s.problem.gap[2] = 0.5;
   s.state.w[2] = -0.4;
   s.state.status = {NodeState::forward_slip, NodeState::stick, NodeState::separation,
                     NodeState::stick,        NodeState::stick, NodeState::stick,
                     NodeState::stick,        NodeState::stick};
   s.state.v << 1, 1, 1, -1, 3, 1, 1, 0;
   s.state.slip_origin << 0, 0, 0, 0, 2, 2, 1, 0;
   const NodeState out = NodeState::separation, ahead = NodeState::forward_slip,
                   back = NodeState::backward_slip;
   // Without friction nothing sticks but what is held.
   EXPECT_EQ(
      settled_states(s.problem, s.state),
      (std::vector<NodeState>{out, out, out, back, ahead, back, ahead, NodeState::stick}));
   // Where round-off alone moves it, it slips in no direction.
   ContactState rests = s.state;
   rests.v = rests.slip_origin + 1e-9 * rests.v;
   const NodeState slip = NodeState::slip;
   EXPECT_EQ(settled_states(s.problem, rests),
             (std::vector<NodeState>{out, out, out, slip, slip, slip, slip, NodeState::stick}));
   EXPECT_EQ(touching_nodes(s.problem, s.state), 2); // nodes 0 and 1
   // With friction a node slips if it is said to and moved since it stuck.
   set_friction(s.problem, 0.5);
   std::fill(s.state.status.begin() + 3, s.state.status.end(), back);
   EXPECT_EQ(settled_states(s.problem, s.state),
             (std::vector<NodeState>{out, out, out, back, back, back, NodeState::stick,
                                     NodeState::stick}));
   // A pressure that the displacements' own round-off makes is none.
   Sampled far = row(2);
   far.problem.gap.setConstant(1e6);
   far.state.w.setConstant(-1e6);
   far.state.p << 2e-10, 1;
   EXPECT_EQ(settled_states(far.problem, far.state),
             (std::vector<NodeState>{out, NodeState::stick}));
   // A node of the axis has no weight and no traction.
   s.problem.weights[5] = 0;
   const Eigen::VectorXd pressure = tractions(s.problem, s.state.p);
   EXPECT_NEAR(pressure[4], 4, 1e-14);
   EXPECT_EQ(pressure[5], 0);
   EXPECT_THROW(tractions(s.problem, Eigen::VectorXd::Ones(16)), InputError);
}

/// Contact along |x| < 1 of a closed line of length 3, stick in |x| < 0.4, with its first node
/// `begin` spacings on.
Sampled ring(int n, int begin)
{
   Sampled made = cattaneo_mindlin(n, 0.4, 0);
   const double h = 3.0 / n, radius = h / (2 * std::sin(M_PI / n));
   ReducedProblem &problem = made.problem;
   ContactState &state = made.state;
   problem.chains[0].loop = true;
   problem.weights.setConstant(h);
   problem.position.resize(n, 2);
   for (int i = 0; i < n; ++i)
   {
      const int place = (i + begin) % n;
      const double x = place * h - 1.487, far = std::abs(x), angle = 2 * M_PI * place / n;
      const bool touches = far < 1, sticks = far < 0.4;
      problem.arc_length[i] = i * h;
      problem.position.row(i) << radius * std::cos(angle), radius * std::sin(angle);
      state.status[i] = sticks    ? NodeState::stick
                        : touches ? NodeState::forward_slip
                                  : NodeState::separation;
      state.p[i] = touches ? h * std::sqrt(1 - x * x) : 0;
      state.q[i] = -0.5 * state.p[i] + (sticks ? 0.5 * h * std::sqrt(0.16 - x * x) : 0);
      state.v[i] = std::pow(std::max(0.0, far - 0.4), 1.5);
      state.w[i] = std::pow(std::max(0.0, far - 1), 1.5);
   }
   return made;
}

TEST(Zones, OfAClosedLineGoAllTheWayRoundWhereverItBegins)
{
   const int n = 61;
   const double h = 3.0 / n;
   std::map<double, double> at_first; // borders on the line that begins at x = -1.487
   for (int begin = 0; begin < n; ++begin)
   {
      const Sampled s = ring(n, begin);
      std::map<double, double> found;
      double length = 0;
      const std::vector<Zone> all = zones(s.problem, s.state);
      for (std::size_t k = 0; k < all.size(); ++k)
      {
         length += all[k].to.position - all[k].from.position;
         const Zone &next = all[(k + 1) % all.size()];
         if (next.state == all[k].state) { continue; }
         const double place = std::fmod(all[k].to.position + begin * h, 3.0);
         found[place] = all[k].to.error;
         EXPECT_EQ(next.from.error, all[k].to.error);
      }
      EXPECT_NEAR(length, 3, 1e-13) << begin;
      ASSERT_EQ(found.size(), 4u) << begin;
      if (begin == 0) { at_first = found; }
      auto border = found.begin(), before = at_first.begin();
      for (double x : {-1.0, -0.4, 0.4, 1.0})
      {
         EXPECT_LE(std::abs(border->first - 1.487 - x), border->second) << begin;
         EXPECT_NEAR((border++)->first, (before++)->first, 1e-12) << begin;
      }
   }
}

/// A body that one node holds has any tilt, another one on each path. The half-width of Hertz
/// is 1 under the whole load and grows with its root.
TEST(Zones, EndsOfAContactOfOneNodeAreKnownToASpacing)
{
   const ReducedProblem problem =
      load_reduced_problem(std::string(CATTANEO_SOURCE_DIR) + "/problems/hertz.json");
   const double middle = problem.arc_length.mean(), load = 0.001, half = std::sqrt(load);
   for (const auto &path :
        {std::vector<NamedLoads>{{}, {{"P", load}}}, {{}, {{"P", 1}}, {{"P", load}}}})
   {
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, LoadHistory::through(problem, path), state);
      ASSERT_EQ(report.status, FrictionStatus::converged);
      const Zone contact = contact_zone(problem, state);
      EXPECT_EQ(contact.first, contact.last);
      EXPECT_LE(std::abs(contact.from.position - (middle - half)), contact.from.error);
      EXPECT_LE(std::abs(contact.to.position - (middle + half)), contact.to.error);
   }
}

TEST(Zones, OfACycleLeaveOutNodesThatWereOpenAtAnyTime)
{
   // Slip of nodes 4 to 13 by the parabola that vanishes at 7.2; node 9 opens for a while and
   // moves freely then: beyond it nothing counts, and a line through nodes 5 to 7 is left.
   Sampled s = row(14);
   const double value[] = {0.8, 1.5, 3.0, 4.4, 5.5};
   const auto slipped = [&](double share)
   {
      ContactState now = s.state;
      for (int k = 0; k < 10; ++k)
      {
         now.v[4 + k] = -share * std::pow(k < 5 ? value[k] : 7.0, 1.5);
      }
      return now;
   };
   SlipRange range(s.problem);
   ContactState stray = slipped(9);
   range.note(stray);
   range.start(slipped(-0.5)); // what was before does not count
   ContactState open = slipped(0.2);
   open.status[9] = NodeState::separation;
   open.p[9] = 0;
   range.note(open);
   range.note(slipped(0.5));
   EXPECT_NEAR(range.range()[5], std::pow(1.5, 1.5), 1e-14);
   EXPECT_FALSE(range.always_closed()[9]);
   EXPECT_TRUE(range.always_closed()[8]);
   const std::vector<Zone> all = zones(s.problem, s.state, range);
   ASSERT_EQ(all.size(), 2u);
   EXPECT_EQ(all[1].first, 4);
   EXPECT_NEAR(all[1].from.position, 8 + 2 * (2 - 2.9666666666666667 / 1.45), 1e-9);
   // Where it is the first of the nodes that slip, nothing tells where they begin to.
   SlipRange first(s.problem);
   for (double share : {-0.5, 0.2, 0.5})
   {
      ContactState now = slipped(share);
      if (share == 0.2) { now.status[4] = NodeState::separation; }
      first.note(now);
   }
   EXPECT_EQ(zones(s.problem, s.state, first)[1].from.position, 7);
   EXPECT_EQ(zones(s.problem, s.state, first)[1].from.error, 2);
   // Two tangential components: the diagonal of the box.
   ReducedProblem disc = s.problem;
   disc.set_stiffness(Eigen::MatrixXd::Identity(28, 28), Eigen::MatrixXd::Zero(14, 28),
                      disc.C());
   ContactState turning = ContactState::virgin(disc);
   SlipRange box(disc);
   box.note(turning);
   turning.v[3] = 3;
   box.note(turning);
   turning.v[3] = 0;
   turning.v[14 + 3] = -4;
   box.note(turning);
   EXPECT_DOUBLE_EQ(box.range()[3], 5);
}

/// As zones() states it: 16 spacings over the number of nodes from the middle of the border to
/// a corner that is in contact, at most the way there.
TEST(Zones, BordersNearACornerAreDoubted)
{
   const auto slipping = [](int nodes, LineEnd first, LineEnd last, LineEnd other)
   {
      Sampled s = row(30);
      ContactChain chain;
      chain.nodes = 30;
      chain.ends = {first, last};
      chain.other_ends = {other, LineEnd::smooth};
      s.problem.chains = {chain};
      for (int i = 0; i < nodes; ++i)
      {
         s.state.status[i] = NodeState::forward_slip;
         s.state.v[i] = 1;
      }
      return s;
   };
   const LineEnd corner = LineEnd::corner, smooth = LineEnd::smooth;
   // Errors in spacings, of which the border lies half of one beyond the last slipping node.
   expect_border(slipping(10, corner, smooth, smooth), 0.5, 16 / 9.5,
                 "ten nodes from a corner");
   expect_border(slipping(10, smooth, smooth, corner), 0.5, 16 / 9.5, "of the other body");
   expect_border(slipping(4, corner, smooth, smooth), 0.5, 3.5, "as far as the corner");
   expect_border(slipping(10, smooth, smooth, smooth), 0.5, 1, "no corner");
   // 19.5 spacings on the other side.
   expect_border(slipping(10, smooth, corner, smooth), 0.5, 1, "a corner far away");
   // Corners that are not in contact: the line goes on, open.
   Sampled open = slipping(10, corner, corner, smooth);
   for (int i : {0, 29})
   {
      open.state.status[i] = NodeState::separation;
      open.state.v[i] = 0;
      open.state.p[i] = 0;
   }
   EXPECT_EQ(zones(open.problem, open.state)[1].to.error, 2);
   // A loop has no ends.
   Sampled loop = slipping(10, corner, corner, corner);
   loop.problem.chains[0].loop = true;
   EXPECT_EQ(zones(loop.problem, loop.state)[0].to.error, 2);
}

TEST(Zones, StickUpToTheEndsIsKnownToASpacing)
{
   // Spacings 1, 2 and 3 at the ends; nothing slips.
   Sampled s = row(6);
   s.problem.arc_length << 0, 1, 3, 5, 7, 10;
   Zone stick = stick_zone(s.problem, s.state);
   EXPECT_EQ(stick.from.error, 1);
   EXPECT_EQ(stick.to.error, 3);
   // Open at the ends: the spacing from the last stuck node on.
   for (int i : {0, 5})
   {
      s.state.status[i] = NodeState::separation;
      s.state.p[i] = 0;
   }
   stick = stick_zone(s.problem, s.state);
   EXPECT_EQ(stick.first, 1);
   EXPECT_EQ(stick.last, 4);
   EXPECT_EQ(stick.from.error, 1);
   EXPECT_EQ(stick.to.error, 3);
   // The widest is the longest, not the one of most nodes: here 7 to 10 after 0 to 3.
   s = row(6);
   s.problem.arc_length << 0, 0.1, 0.2, 3, 7, 20;
   s.state.status[3] = NodeState::forward_slip;
   s.state.v[3] = 1;
   EXPECT_EQ(widest_zone(zones(s.problem, s.state), NodeState::stick).first, 4);
   // A node that opens between parts the contact.
   s.state.status[3] = NodeState::separation;
   s.state.p[3] = 0;
   const std::vector<Zone> contact = contact_zones(zones(s.problem, s.state));
   ASSERT_EQ(contact.size(), 2u);
   EXPECT_EQ(contact[0].last, 2);
   EXPECT_EQ(contact[1].first, 4);
}

} // namespace
