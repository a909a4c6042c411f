#include "comparison.hpp"
#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "small_problems.hpp"

#include <algorithm>
#include <array>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/edge_report.hpp>
#include <cattaneo/fretting/from_contact.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <expect_input_error.hpp>
#include <functional>
#include <gtest/gtest.h>
#include <string>

namespace
{

using cattaneo_test::four_springs;

using namespace cattaneo;
using namespace cattaneo::fretting;
using Eigen::Index;
using Eigen::VectorXd;

const double modulus = 0.5; // E*

/** Two similar half-planes by the boundary element method: constant tractions on n cells of
    [-half, half], displacements at their centres from Flamant's solution,
    v = -(2/(π E*)) ∫ q ln|x - s| ds. Both are held by a spring so soft that the loads arrive
    whole. Patterns: "P" and "Q" of resultant 1, "bulk" of unit tension in body 2. */
ReducedProblem half_planes(int n, double half, const std::function<double(double)> &gap)
{
   ReducedProblem problem;
   const double h = 2 * half / n, soft = 1e5;
   VectorXd x(n);
   for (int i = 0; i < n; i++) { x[i] = -half + (i + 0.5) * h; }
   const auto primitive = [](double s) { return s * std::log(std::abs(s)) - s; };
   Eigen::MatrixXd G(n, n);
   for (int i = 0; i < n; i++)
   {
      for (int j = 0; j < n; j++)
      {
         const double s = x[i] - x[j];
         G(i, j) =
            soft - 2 / (pi * modulus * h) * (primitive(s + h / 2) - primitive(s - h / 2));
      }
   }
   const Eigen::MatrixXd K = G.inverse();
   const Eigen::MatrixXd symmetric = 0.5 * (K + K.transpose());
   problem.set_stiffness(symmetric, Eigen::MatrixXd::Zero(n, n), symmetric);
   const VectorXd zero = VectorXd::Zero(n), one = VectorXd::Ones(n);
   // A load moves body 1 by `soft` against no contact force: q = A (v - v_load).
   problem.patterns = {{"P", Control::force, zero, problem.C() * (soft * one)},
                       {"Q", Control::force, -problem.A() * (soft * one), zero},
                       {"bulk", Control::force, problem.A() * x / (2 * modulus), zero}};
   problem.H = Eigen::MatrixXd::Zero(3, 3);
   problem.gap = x.unaryExpr(gap);
   problem.weights = VectorXd::Constant(n, h);
   problem.chains = one_chain(n);
   problem.arc_length = x.array() + half;
   set_friction(problem, 0.5);
   return problem;
}

struct Solved
{
   ContactState pressed, peak;
   MarchReport cycles;
};

Solved solve(const ReducedProblem &problem, const Eigen::Vector3d &normal,
             const Eigen::Vector3d &cyclic)
{
   Solved result;
   ContactState state = ContactState::virgin(problem);
   march(problem, LoadHistory::through({Eigen::Vector3d::Zero(), normal}), state);
   result.pressed = state;
   state.time = 0;
   march(problem, LoadHistory::through({normal, normal + cyclic}), state);
   result.peak = state;
   state.time = 0;
   LoadHistory cycle =
      LoadHistory::through({normal + cyclic, normal - cyclic, normal + cyclic});
   cycle.cycle_start = 0;
   cycle.cycles = 3;
   result.cycles = march(problem, cycle, state);
   EXPECT_EQ(result.cycles.status, FrictionStatus::converged) << result.cycles.message;
   return result;
}

const double radius = 20, load = pi * modulus / (4 * radius); // Hertz half-width 1

ReducedProblem hertz_pair(int n)
{
   return half_planes(n, 1.4, [](double x) { return x * x / (2 * radius); });
}

TEST(FromContact, HertzIntensitiesSlipZoneAndEnergy)
{
   const ReducedProblem problem = hertz_pair(161);
   const double x = 0.3, shear = x * 0.5 * load;
   const Solved solved = solve(problem, {load, 0, 0}, {0, shear, 0});
   const std::vector<ContactEdge> edges = contact_edges(problem, solved.pressed, solved.peak);
   ASSERT_EQ(edges.size(), 2u);
   const ShearIntensities k_t = shear_intensities(1, shear, 0);
   const double k_n = hertz_k_n(load, 1), exact_slip = 1 - std::sqrt(1 - x);
   for (std::size_t e = 0; e < 2; e++)
   {
      const ContactEdge &edge = edges[e];
      const double exact = e == 0 ? k_t.trailing : k_t.leading;
      EXPECT_EQ(edge.side, e == 0 ? 1 : -1);
      EXPECT_FALSE(edge.complete);
      EXPECT_FALSE(edge.slides);
      EXPECT_NEAR(edge.position.position, e == 0 ? 0.4 : 2.4, 2e-3);
      EXPECT_NEAR(edge.k_n.value, k_n, 0.01 * k_n);
      EXPECT_NEAR(edge.k_t.value, exact, 0.01 * std::abs(exact));
      EXPECT_LT(edge.k_t.relative_error, 0.02);
      // What is stated of the error covers it.
      EXPECT_LE(std::abs(edge.k_n.value / k_n - 1), edge.k_n.relative_error);
      EXPECT_LE(std::abs(edge.k_t.value / exact - 1), edge.k_t.relative_error);
      EXPECT_GE(edge.k_n.nodes, 4);
      EXPECT_GT(edge.k_n.window.farthest, edge.k_n.window.nearest);
      // Both its ends are read between nodes, of which 161 span 2.8.
      EXPECT_NEAR(edge.slip_zone, exact_slip, 0.1 * 2.8 / 160);
      // The sheet: the near-edge field underestimates the slip zone by this factor.
      EXPECT_NEAR(slip_zone(near_edge(edge)) / edge.slip_zone, 0.5 * (1 + std::sqrt(1 - x)),
                  0.03);
      const EnergyComparison energy = compare_energy(problem, edge, solved.cycles.cycles.back(),
                                                     2 * std::abs(exact), modulus);
      const double exact_energy = 0.5 * hertz_slip_energy(0.5, load, x, modulus);
      EXPECT_NEAR(energy.computed_total, exact_energy, 0.02 * exact_energy);
      EXPECT_NEAR(energy.predicted_total,
                  slip_energy_total({k_n, exact, 0.5}, 2 * std::abs(exact), modulus),
                  0.01 * energy.predicted_total); // of K_N
      EXPECT_LT(energy.predicted_total, energy.computed_total);
   }
}

TEST(FromContact, StuckSolutionGivesTheSameIntensitiesAsTheFrictionalOne)
{
   const ReducedProblem problem = hertz_pair(121);
   const Solved solved = solve(problem, {load, 0, 0}, {0, 0.2 * 0.5 * load, 0});
   const ContactState stuck = fully_stuck(problem, solved.pressed, solved.peak);
   // It carries the whole shear force and the same pressure.
   EXPECT_NEAR(stuck.q.sum(), solved.peak.q.sum(), 1e-4 * load);
   EXPECT_LT((stuck.p - solved.peak.p).cwiseAbs().maxCoeff(), 1e-9 * load);
   const std::vector<ContactEdge> slipping =
      contact_edges(problem, solved.pressed, solved.peak);
   const std::vector<ContactEdge> sticking = contact_edges(problem, solved.pressed, stuck);
   ASSERT_EQ(sticking.size(), 2u);
   for (std::size_t e = 0; e < 2; e++)
   {
      EXPECT_NEAR(sticking[e].k_t.value, slipping[e].k_t.value, 1e-8);
      EXPECT_EQ(sticking[e].slip_zone, 0);
      EXPECT_GT(slipping[e].slip_zone, 0);
   }
}

TEST(FromContact, BulkTensionDistinguishesTheEdgesAndTheBodies)
{
   const ReducedProblem problem = hertz_pair(161);
   const double shear = 0.15 * 0.5 * load, bulk = 1e-3;
   const Solved solved = solve(problem, {load, 0, 0}, {0, shear, bulk});
   const ShearIntensities exact = shear_intensities(1, shear, bulk);
   const std::vector<ContactEdge> second = contact_edges(problem, solved.pressed, solved.peak);
   const std::vector<ContactEdge> first =
      contact_edges(problem, solved.pressed, solved.peak, CrackedBody::first);
   ASSERT_EQ(second.size(), 2u);
   EXPECT_NEAR(second[0].k_t.value, exact.trailing, 0.01 * exact.trailing);
   EXPECT_NEAR(second[1].k_t.value, exact.leading, 0.01 * exact.trailing);
   EXPECT_GT(second[0].slip_zone, second[1].slip_zone);
   for (std::size_t e = 0; e < 2; e++)
   {
      EXPECT_DOUBLE_EQ(first[e].k_t.value, -second[e].k_t.value);
      EXPECT_EQ(first[e].k_n.value, second[e].k_n.value);
   }
}

TEST(FromContact, FlatAndRoundedPadHasItsCalibration)
{
   const double flat = 0.5;
   const ReducedProblem problem = half_planes(
      281, 1.4,
      [&](double x) { return std::pow(std::max(0.0, std::abs(x) - flat), 2) / (2 * radius); });
   const double force = 0.012, shear = 0.1 * 0.5 * force;
   const FlatRoundedContact pad = flat_rounded_contact(force, radius, flat, modulus);
   ASSERT_LT(pad.half_width, 1.3);
   const Solved solved = solve(problem, {force, 0, 0}, {0, shear, 0});
   const std::vector<ContactEdge> edges = contact_edges(problem, solved.pressed, solved.peak);
   ASSERT_EQ(edges.size(), 2u);
   EXPECT_NEAR(edges[0].half_width, pad.half_width, 3e-3);
   EXPECT_NEAR(edges[0].k_n.value, pad.k_n, 0.02 * pad.k_n);
   const double k_t = shear_intensities(pad.half_width, shear, 0).trailing;
   EXPECT_NEAR(edges[0].k_t.value, k_t, 0.01 * k_t);
}

TEST(FromContact, CompleteContactIsRefusedWithAReason)
{
   const ReducedProblem problem = half_planes(41, 1, [](double) { return 0.0; });
   const Solved solved = solve(problem, {load, 0, 0}, {0, 0.1 * load, 0});
   const std::vector<ContactEdge> edges = contact_edges(problem, solved.pressed, solved.peak);
   ASSERT_EQ(edges.size(), 2u);
   for (const ContactEdge &edge : edges)
   {
      EXPECT_TRUE(edge.complete);
      EXPECT_NE(edge.why_not.find("corner"), std::string::npos) << edge.why_not;
      EXPECT_THROW(near_edge(edge), InputError);
      EXPECT_THROW(compare_energy(problem, edge, solved.cycles.cycles.back(), 1, modulus),
                   InputError);
   }
}

/// The first or the last half of a problem of an odd number of nodes that is its own mirror
/// image, up to the node on the plane of symmetry, which does not slide: v is odd about it and
/// w even, and half of the middle's force belongs to each half.
ReducedProblem half_of(const ReducedProblem &whole, bool first_half)
{
   const Index n = whole.nodes(), half = (n + 1) / 2, from = first_half ? 0 : half - 1;
   Eigen::MatrixXd odd = Eigen::MatrixXd::Zero(n, half), even = odd;
   for (Index i = 0; i < half; i++)
   {
      const Index node = from + i, image = n - 1 - node;
      odd(image, i) = -1;
      odd(node, i) = even(node, i) = even(image, i) = 1;
   }
   ReducedProblem problem;
   problem.set_stiffness(0.5 * odd.transpose() * whole.A() * odd,
                         Eigen::MatrixXd::Zero(half, half),
                         0.5 * even.transpose() * whole.C() * even);
   for (const LoadPattern &load : whole.patterns)
   {
      problem.patterns.push_back({load.name, load.control, 0.5 * odd.transpose() * load.q,
                                  0.5 * even.transpose() * load.p});
   }
   problem.H = 0.5 * whole.H;
   problem.gap = whole.gap.segment(from, half);
   problem.weights = 0.5 * even.transpose() * whole.weights;
   problem.arc_length = whole.arc_length.segment(from, half);
   problem.chains = one_chain(half);
   problem.chains[0].ends[first_half ? 1 : 0] = LineEnd::symmetry;
   set_friction(problem, 0.5);
   hold(problem, {first_half ? half - 1 : 0});
   return problem;
}

TEST(FromContact, HalfAModelHasTheEdgeOfTheWholeOneAndNoneAtItsPlane)
{
   const ReducedProblem whole = hertz_pair(121);
   const Eigen::Vector3d normal(load, 0, 0), stretched(0, 0, 2e-3);
   const Solved all = solve(whole, normal, stretched);
   const std::vector<ContactEdge> both = contact_edges(whole, all.pressed, all.peak);
   ASSERT_EQ(both.size(), 2u);
   ASSERT_GT(both[0].slip_zone, 0);
   for (const bool first_half : {true, false})
   {
      SCOPED_TRACE(first_half);
      const ReducedProblem problem = half_of(whole, first_half);
      const Solved solved = solve(problem, normal, stretched);
      const std::vector<ContactEdge> edges =
         contact_edges(problem, solved.pressed, solved.peak);
      ASSERT_EQ(edges.size(), 1u);
      const ContactEdge &edge = edges[0], &same = both[first_half ? 0 : 1];
      EXPECT_EQ(edge.side, same.side);
      EXPECT_FALSE(edge.complete);
      EXPECT_EQ(edge.why_not, "");
      const auto expect_same = [](double a, double b)
      { EXPECT_NEAR(a, b, 1e-7 * std::abs(b)); };
      expect_same(edge.position.position, same.position.position);
      expect_same(edge.half_width, same.half_width);
      expect_same(edge.slip_zone, same.slip_zone);
      expect_same(edge.k_n.value, same.k_n.value);
      // The whole model reads how K_T changes with the place of either edge and adds the two;
      // here they move together: equal up to what it states of its error.
      EXPECT_LT(same.k_t.relative_error, 0.02);
      EXPECT_NEAR(edge.k_t.value, same.k_t.value,
                  same.k_t.relative_error * std::abs(same.k_t.value));
   }
}

TEST(FromContact, APlaneOfSymmetryIsOneOfAllBodies)
{
   ContactChain chain = one_chain(3)[0];
   chain.ends[0] = LineEnd::symmetry;
   EXPECT_TRUE(chain.mirrored_at(0)); // the other one is a rigid line
   EXPECT_FALSE(chain.mirrored_at(1));
   // One body is held where the other one may move.
   chain.bodies[1] = 1;
   EXPECT_FALSE(chain.mirrored_at(0));
   chain.other_ends[0] = LineEnd::symmetry;
   EXPECT_TRUE(chain.mirrored_at(0));
   chain.loop = true;
   EXPECT_FALSE(chain.mirrored_at(0));
}

TEST(FromContact, ALineThatIsCutOffOrClosedHasNoCorners)
{
   ReducedProblem problem = half_planes(41, 1, [](double) { return 0.0; });
   const Solved solved = solve(problem, {load, 0, 0}, {0, 0.1 * load, 0});
   ContactChain &chain = problem.chains[0];
   chain.ends = chain.other_ends = {LineEnd::smooth, LineEnd::smooth};
   for (const ContactEdge &edge : contact_edges(problem, solved.pressed, solved.peak))
   {
      EXPECT_FALSE(edge.complete);
      EXPECT_NE(edge.why_not.find("cut off"), std::string::npos) << edge.why_not;
      EXPECT_THROW(near_edge(edge), InputError);
   }
   chain.other_ends = {LineEnd::corner, LineEnd::smooth};
   const std::vector<ContactEdge> edges = contact_edges(problem, solved.pressed, solved.peak);
   EXPECT_TRUE(edges[0].complete);
   EXPECT_FALSE(edges[1].complete);
   chain.loop = true;
   expect_input_error([&] { contact_edges(problem, solved.pressed, solved.peak); },
                      "is a loop, and touches at node 0");
   ContactState open = solved.peak; // at the first node, not at the last
   open.status[0] = NodeState::separation;
   open.p[0] = open.q[0] = 0;
   open.w[0] = 1;
   expect_input_error([&] { contact_edges(problem, open, open); },
                      "is a loop, and touches at node 40");
   const ReducedProblem disc = cattaneo_test::as_disc(four_springs());
   const ContactState state = ContactState::virgin(disc);
   expect_input_error([&] { contact_edges(disc, state, state); },
                      "has 2 tangential components per node");
}

TEST(FromContact, RefusesWhatItCannotJudge)
{
   const ReducedProblem coarse = hertz_pair(9);
   const Solved solved = solve(coarse, {load, 0, 0}, {0, 0.1 * 0.5 * load, 0});
   EXPECT_THROW(contact_edges(coarse, solved.pressed, solved.peak), InputError);
   EXPECT_THROW(fully_stuck(coarse, solved.pressed, solved.peak, {true}), InputError);
   // Each half of a contact must have the four nodes of a fit, and two that it leaves out
   // unless a window is named. Those just outside of the edge that is read do not count.
   for (int cells = 9; cells <= 25; cells++)
   {
      const ReducedProblem few = hertz_pair(cells);
      const Solved pressed = solve(few, {load, 0, 0}, {0, 0.1 * 0.5 * load, 0});
      const auto nodes = (pressed.peak.p.array() > 0).count();
      for (const bool window : {false, true})
      {
         FitSettings settings;
         if (window) { settings.window = {0, 2}; }
         const int least = window ? 8 : 12;
         std::string message;
         try
         {
            contact_edges(few, pressed.pressed, pressed.peak, CrackedBody::second, settings);
         }
         catch (const InputError &error)
         {
            message = error.what();
         }
         const bool said = message.find("a stretch of contact has " + std::to_string(nodes) +
                                        " nodes; the fit of its edges needs at least " +
                                        std::to_string(least) + ":") != std::string::npos;
         EXPECT_EQ(said, nodes < least) << nodes << message;
         if (nodes >= least + 3) { EXPECT_EQ(message, ""); }
      }
   }
   ReducedProblem pieces = hertz_pair(41);
   const Solved two = solve(pieces, {load, 0, 0}, {0, 0.1 * 0.5 * load, 0});
   EXPECT_NO_THROW(contact_edges(pieces, two.pressed, two.peak));
   pieces.chains = {one_chain(20)[0], one_chain(21)[0]};
   pieces.chains[1].first = 20;
   EXPECT_THROW(contact_edges(pieces, two.pressed, two.peak), InputError);
   ReducedProblem frictionless = coarse;
   frictionless.set_stiffness({}, Eigen::MatrixXd(9, 0), frictionless.C());
   EXPECT_THROW(contact_edges(frictionless, solved.pressed, solved.peak), InputError);
}

/// The problem seen from the other side: x and what points along it change their signs.
ReducedProblem mirror(const ReducedProblem &problem)
{
   ReducedProblem result = problem;
   result.set_stiffness(problem.A().reverse(), -problem.B().reverse(), problem.C().reverse());
   for (LoadPattern &pattern : result.patterns)
   {
      pattern.q = (-pattern.q.reverse()).eval();
      pattern.p.reverseInPlace();
   }
   result.gap.reverseInPlace();
   result.friction.reverseInPlace();
   result.weights.reverseInPlace();
   result.arc_length = problem.arc_length.maxCoeff() - problem.arc_length.reverse().array();
   return result;
}

TEST(FromContact, EitherEdgeHasItsOwnFrictionAndTheMirrorImageTheSame)
{
   // Friction rises along a contact that is not in the middle of its line, under shear and bulk
   // tension.
   const int n = 141;
   ReducedProblem problem =
      half_planes(n, 1.4, [](double x) { return (x - 0.15) * (x - 0.15) / (2 * radius); });
   for (int i = 0; i < n; i++) { problem.friction[i] = 0.4 + 0.2 * i / (n - 1); }
   const Eigen::Vector3d normal(load, 0, 0), cyclic(0, 0.15 * 0.5 * load, 5e-4);
   const ReducedProblem image = mirror(problem);
   const Solved here = solve(problem, normal, cyclic), there = solve(image, normal, cyclic);
   for (const CrackedBody body : {CrackedBody::first, CrackedBody::second})
   {
      const std::vector<ContactEdge> edges =
         contact_edges(problem, here.pressed, here.peak, body);
      const std::vector<ContactEdge> mirrored =
         contact_edges(image, there.pressed, there.peak, body);
      ASSERT_EQ(edges.size(), 2u);
      ASSERT_EQ(mirrored.size(), 2u);
      Index first = 0, last = n - 1;
      while (here.peak.p[first] == 0) { first++; }
      while (here.peak.p[last] == 0) { last--; }
      EXPECT_EQ(edges[0].first, first);
      EXPECT_EQ(edges[0].last, (first + last) / 2);
      EXPECT_EQ(edges[1].first, (first + last + 1) / 2);
      EXPECT_EQ(edges[1].last, last);
      EXPECT_EQ(edges[0].friction, problem.friction[first]);
      EXPECT_EQ(edges[1].friction, problem.friction[last]);
      EXPECT_NEAR(edges[0].position.position, 1.4 + 0.15 - 1, 5e-3); // Hertz
      EXPECT_NEAR(edges[1].position.position, 1.4 + 0.15 + 1, 5e-3);
      for (int e : {0, 1})
      {
         const ContactEdge &edge = edges[e], &same = mirrored[1 - e];
         EXPECT_EQ(same.side, -edge.side);
         EXPECT_EQ(same.friction, edge.friction);
         EXPECT_NEAR(same.position.position, problem.arc_length[n - 1] - edge.position.position,
                     1e-8);
         EXPECT_NEAR(same.position.error, edge.position.error, 1e-8);
         EXPECT_NEAR(same.half_width, edge.half_width, 1e-8);
         EXPECT_NEAR(same.k_n.value, edge.k_n.value, 1e-8 * edge.k_n.value);
         EXPECT_NEAR(same.k_t.value, edge.k_t.value, 1e-7 * std::abs(edge.k_t.value));
         EXPECT_NEAR(same.slip_zone, edge.slip_zone, 1e-8);
         EXPECT_NEAR(same.slip_zone_error, edge.slip_zone_error, 1e-8);
         const EdgeTractions nodes = edge_tractions(problem, here.peak, edge, body);
         for (std::size_t k = 0; k < nodes.position.size(); k++)
         {
            EXPECT_GT(edge.side * (nodes.position[k] - edge.position.position), 0);
         }
      }
   }
}

TEST(FromContact, AnEdgeThatSticksAndAContactThatSlides)
{
   // Bulk tension 4 Q/(π a) takes the shear from the leading edge: it sticks, the other slips.
   const ReducedProblem problem = hertz_pair(121), image = mirror(problem);
   const double shear = 0.2 * 0.5 * load;
   for (const int slipping : {0, 1})
   {
      const ReducedProblem &p = slipping == 0 ? problem : image;
      const Solved solved = solve(p, {load, 0, 0}, {0, shear, 4 * shear / pi});
      const std::vector<ContactEdge> edges = contact_edges(p, solved.pressed, solved.peak);
      ASSERT_EQ(edges.size(), 2u);
      const double k_t = 2 * shear / (pi * std::sqrt(2.0)); // twice that of the shear alone
      EXPECT_NEAR(edges[slipping].k_t.value, k_t, 0.01 * k_t);
      EXPECT_NEAR(edges[1 - slipping].k_t.value, 0, 0.01 * k_t);
      const double near_edge = 2 * k_t / (0.5 * hertz_k_n(load, 1)); // a lower bound
      EXPECT_GT(edges[slipping].slip_zone, near_edge);
      EXPECT_LT(edges[slipping].slip_zone, 1.5 * near_edge);
      EXPECT_EQ(edges[1 - slipping].slip_zone, 0);
      const std::vector<Zone> all = zones(p, solved.peak);
      const auto stick =
         std::find_if(all.begin(), all.end(),
                      [](const Zone &zone) { return zone.state == NodeState::stick; });
      ASSERT_NE(stick, all.end());
      EXPECT_EQ(edges[slipping].slip_zone_error,
                (slipping == 0 ? stick->from : stick->to).error +
                   edges[slipping].position.error);
   }
   // Where all has slipped by 1 the zone is the whole contact, 2 a.
   Solved sliding = solve(problem, {load, 0, 0}, {0, shear, 0});
   ContactState state = sliding.pressed;
   state.q = -0.5 * state.p;
   state.v.array() += 1;
   for (Index i = 0; i < problem.nodes(); i++)
   {
      if (state.p[i] > 0) { state.status[i] = NodeState::forward_slip; }
   }
   for (const ContactEdge &edge : contact_edges(problem, sliding.pressed, state))
   {
      EXPECT_TRUE(edge.slides);
      EXPECT_NEAR(edge.slip_zone, 2, 5e-3);
      EXPECT_NEAR(edge.half_width, 1, 3e-3);
   }
   // Nodes that are free carry nothing, to the last bit.
   const ContactState stuck = fully_stuck(problem, sliding.pressed, sliding.peak);
   for (Index i = 0; i < problem.nodes(); i++)
   {
      if (sliding.peak.p[i] > 0) { continue; }
      EXPECT_EQ(stuck.p[i], 0);
      EXPECT_EQ(stuck.q[i], 0);
   }
}

/// The two on one line, the second far behind the first; neither feels the other.
ReducedProblem one_behind_the_other(const ReducedProblem &a, const ReducedProblem &b,
                                    double offset)
{
   const Index n = a.nodes(), m = b.nodes();
   const auto joined = [&](const VectorXd &first, const VectorXd &second)
   {
      VectorXd all(n + m);
      all << first, second;
      return all;
   };
   const auto blocks = [&](const auto &first, const auto &second)
   {
      Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + m, n + m);
      all.topLeftCorner(n, n) = first;
      all.bottomRightCorner(m, m) = second;
      return all;
   };
   ReducedProblem both = a;
   both.gap = joined(a.gap, b.gap);
   both.friction = joined(a.friction, b.friction);
   both.set_stiffness(blocks(a.A(), b.A()), blocks(a.B(), b.B()), blocks(a.C(), b.C()));
   both.weights = joined(a.weights, b.weights);
   both.arc_length = joined(a.arc_length, b.arc_length.array() + offset);
   both.chains = one_chain(n + m);
   for (std::size_t k = 0; k < both.patterns.size(); k++)
   {
      both.patterns[k].q = joined(a.patterns[k].q, b.patterns[k].q);
      both.patterns[k].p = joined(a.patterns[k].p, b.patterns[k].p);
   }
   return both;
}

/// `rounder_at`: -1: the rounder of the two comes first, 1: last.
void expect_each_as_alone(int rounder_at)
{
   // The rounder one reaches the end of its line.
   const ReducedProblem usual = hertz_pair(81),
                        rounder = half_planes(91, 1.3,
                                              [=](double x)
                                              {
                                                 const double from = x - 0.6 * rounder_at;
                                                 return from * from / (1.6 * radius);
                                              });
   const ReducedProblem &first = rounder_at < 0 ? rounder : usual,
                        &second = rounder_at < 0 ? usual : rounder;
   const std::size_t at_the_end = rounder_at < 0 ? 0 : 3;
   const double offset = 10;
   const ReducedProblem both = one_behind_the_other(first, second, offset);
   const Eigen::Vector3d normal(load, 0, 0), cyclic(0, 0.15 * load, 0.1 * load); // of either
   const auto read = [&](const ReducedProblem &problem)
   {
      const Solved solved = solve(problem, normal, cyclic);
      return contact_edges(problem, solved.pressed, solved.peak);
   };
   std::vector<ContactEdge> alone = read(first);
   for (ContactEdge edge : read(second))
   {
      edge.position.position += offset;
      edge.first += first.nodes();
      edge.last += first.nodes();
      alone.push_back(edge);
   }
   const std::vector<ContactEdge> together = read(both);
   ASSERT_EQ(alone.size(), 4u);
   ASSERT_EQ(together.size(), 4u);
   for (std::size_t e = 0; e < 4; e++)
   {
      SCOPED_TRACE(e);
      const ContactEdge &a = alone[e], &b = together[e];
      EXPECT_EQ(b.complete, e == at_the_end);
      EXPECT_EQ(a.complete, e == at_the_end);
      EXPECT_EQ(b.why_not.empty(), e != at_the_end);
      EXPECT_EQ(b.side, a.side);
      EXPECT_EQ(b.first, a.first);
      EXPECT_EQ(b.last, a.last);
      const auto same = [](double x, double y) { EXPECT_NEAR(x, y, 1e-7 * std::abs(y)); };
      same(b.position.position, a.position.position);
      same(b.position.error, a.position.error);
      same(b.half_width, a.half_width);
      same(b.slip_zone, a.slip_zone);
      same(b.k_n.value, a.k_n.value);
      same(b.k_t.value, a.k_t.value);
      same(b.k_n.relative_error, a.k_n.relative_error);
      same(b.k_t.relative_error, a.k_t.relative_error);
   }
}

TEST(FromContact, TwoContactsOnALineAreReadAsEachAlone)
{
   expect_each_as_alone(1);
}

TEST(FromContact, TwoContactsOfWhichTheFirstHasNoFittedEdgeAreReadAsEachAlone)
{
   expect_each_as_alone(-1);
}

TEST(FromContact, StuckNodesKeepTheirSlipAndOthersMoveFreely)
{
   ReducedProblem problem = four_springs();
   problem.gap[0] = 0.01;
   ContactState pressed = ContactState::virgin(problem);
   pressed.v << 0.2, -0.1, 7, 7;
   ContactState loaded = pressed;
   loaded.multipliers << 1, 2;
   loaded.p << 1, 1, 1, 0;
   loaded.peak_force = 1;
   loaded.status = {NodeState::stick, NodeState::forward_slip, NodeState::stick,
                    NodeState::separation};
   const ContactState stuck = fully_stuck(problem, pressed, loaded, {true, true, false, false});
   // q = 2 v + 2 Q of the tied ones, v = -Q of the others; p = 4 w + P, w = -g where closed.
   const auto expect = [](const VectorXd &found, const Eigen::Vector4d &expected)
   { EXPECT_LT((found - expected).norm(), 1e-14) << found.transpose(); };
   expect(stuck.v, {0.2, -0.1, -0.7, -0.3});
   expect(stuck.q, {0.6, -1.8, 0, 0});
   expect(stuck.w, {-0.01, 0, 0, 0.1});
   expect(stuck.p, {0.96, 1, 1, 0});
   expect(stuck.slip_origin, pressed.v);
   EXPECT_EQ(stuck.status, (std::vector<NodeState>{NodeState::stick, NodeState::stick,
                                                   NodeState::stick, NodeState::separation}));
   // By default those that are closed are tied.
   expect(fully_stuck(problem, pressed, loaded).v, {0.2, -0.1, 7, -0.3});
}

TEST(FromContact, EnergyOfAnEdgeIsThatOfItsNodesAndOfThoseThatRubBeyond)
{
   const int n = 10;
   ReducedProblem problem;
   problem.set_stiffness({}, Eigen::MatrixXd(n, 0), Eigen::MatrixXd::Identity(n, n));
   problem.weights.resize(n);
   problem.weights << 1, 1, 4, 1, 1, 2, 0, 2, 1, 1;
   CycleRecord cycle;
   cycle.node_dissipation.resize(n);
   cycle.node_dissipation << 50, 0, 2, 3, 0, 4, 5, 7, 0, 60;
   ContactEdge edge;
   edge.first = 3;
   edge.last = 5;
   edge.k_n.value = 2;
   edge.k_t.value = 0.3;
   edge.friction = 0.5;
   edge.side = 1; // beyond node 3 lies node 2, which rubs, and 1, which does not
   const EnergyComparison left = compare_energy(problem, edge, cycle, 0.2, 8);
   EXPECT_DOUBLE_EQ(left.computed_total, 2 + 3 + 0 + 4);
   EXPECT_DOUBLE_EQ(left.computed_max, 3);
   // π/3 ΔK² d_r/E*, d_r = 0.2/(0.5·2); √3 ΔK²/E*.
   EXPECT_NEAR(left.predicted_total, pi / 3 * 0.04 * 0.2 / 8, 1e-17);
   EXPECT_NEAR(left.predicted_max, std::sqrt(3.0) * 0.04 / 8, 1e-17);
   edge.side = -1; // beyond node 5 lie 6, without a weight, and 7
   const EnergyComparison right = compare_energy(problem, edge, cycle, 0.2, 8);
   EXPECT_DOUBLE_EQ(right.computed_total, 3 + 0 + 4 + 5 + 7);
   EXPECT_DOUBLE_EQ(right.computed_max, 3.5);
   // To the ends of the line and no further.
   edge.first = edge.last = 1;
   edge.side = 1;
   EXPECT_DOUBLE_EQ(compare_energy(problem, edge, cycle, 0.2, 8).computed_total, 50);
   edge.first = edge.last = n - 2;
   edge.side = -1;
   EXPECT_DOUBLE_EQ(compare_energy(problem, edge, cycle, 0.2, 8).computed_total, 60);
   edge.first = edge.last = 0;
   edge.side = 1;
   EXPECT_DOUBLE_EQ(compare_energy(problem, edge, cycle, 0.2, 8).computed_total, 50);
   edge.first = edge.last = n - 1;
   edge.side = -1;
   EXPECT_DOUBLE_EQ(compare_energy(problem, edge, cycle, 0.2, 8).computed_total, 60);
   const auto refused = [&](const char *said)
   { expect_input_error([&] { compare_energy(problem, edge, cycle, 0.2, 8); }, said); };
   edge.last = n;
   refused("the edge is of nodes 9 to 10, must be of 0 to 9");
   edge.first = -1;
   edge.last = 0;
   refused("the edge is of nodes -1 to 0, must be of 0 to 9");
   edge.first = 0;
   const Eigen::VectorXd weights = problem.weights;
   problem.weights.resize(0);
   refused("the problem has 0 weights, must have one for each of its 10 nodes");
   problem.weights = weights;
   cycle.node_dissipation.conservativeResize(n - 1);
   refused("the dissipation of 9 nodes, must have that of all 10");
}

TEST(FromContact, TractionsOfAnEdgeNeedItsPlaces)
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero(),
                         Eigen::Matrix2d::Identity());
   problem.weights = Eigen::Vector2d(1, 2);
   ContactState state = ContactState::virgin(problem);
   state.p << 3, 8;
   ContactEdge edge;
   edge.side = 1;
   edge.first = 0;
   edge.last = 1;
   edge.position.position = -1;
   const auto refused = [&](const char *said)
   { expect_input_error([&] { edge_tractions(problem, state, edge); }, said); };
   refused("the problem has 0 arc lengths for its 2 nodes");
   problem.arc_length = Eigen::Vector2d(0, 1);
   EXPECT_EQ(edge_tractions(problem, state, edge).pressure, (std::vector<double>{3, 4}));
   edge.last = 2;
   refused("the edge is of nodes 0 to 2, must be of 0 to 1");
   edge.last = 1;
   state.q.resize(0);
   refused("nodal_forces has 0 entries, must have 2");
}

// --- corners

/// Does a note of the edge say this?
bool notes_say(const SolvedEdge &solved, const std::string &words)
{
   return std::any_of(solved.notes.begin(), solved.notes.end(),
                      [&](const std::string &note)
                      { return note.find(words) != std::string::npos; });
}

TEST(EdgeReport, OfAHertzContactHasTheClosedFormsOfItsCycle)
{
   const ReducedProblem problem = hertz_pair(161);
   const double x = 0.3, shear = x * 0.5 * load;
   const Solved solved = solve(problem, {load, 0, 0}, {0, shear, 0});
   ContactState opposite = solved.peak;
   opposite.time = 0;
   march(
      problem,
      LoadHistory::through({Eigen::Vector3d(load, shear, 0), Eigen::Vector3d(load, -shear, 0)}),
      opposite);
   MarchedStates states{problem, solved.pressed, solved.peak};
   for (const SolvedEdge &one : read_edges(states).edges) // of two states there is no energy
   {
      EXPECT_FALSE(one.energy || one.corner);
      EXPECT_EQ(one.k_t_range, 0);
      EXPECT_TRUE(one.notes.empty()) << one.notes[0];
   }
   states.opposite = &opposite;
   states.cycle = &solved.cycles.cycles.back();
   for (const SolvedEdge &one : read_edges(states).edges)
   {
      EXPECT_FALSE(one.energy);
      EXPECT_TRUE(notes_say(one, "have different materials"));
   }
   states.modulus = modulus;
   const EdgeReport report = read_edges(states);
   EXPECT_TRUE(report.why_not.empty());
   ASSERT_EQ(report.edges.size(), 2u);
   const double k_t = shear_intensities(1, shear, 0).trailing,
                energy = 0.5 * hertz_slip_energy(0.5, load, x, modulus);
   for (const SolvedEdge &one : report.edges)
   {
      EXPECT_NEAR(one.travel, 0, 1e-9); // similar bodies: shear leaves the pressure alone
      EXPECT_NEAR(one.k_t_range, 2 * k_t, 0.02 * k_t);
      ASSERT_TRUE(one.energy);
      EXPECT_NEAR(one.energy->computed_total, energy, 0.02 * energy);
      EXPECT_EQ(one.energy->predicted_total,
                slip_energy_total(near_edge(one.edge), one.k_t_range, modulus));
      EXPECT_TRUE(one.notes.empty()) << one.notes[0];
   }
   states.opposite = &solved.pressed; // half the cycle, as far as it is told
   EXPECT_NEAR(read_edges(states).edges[0].k_t_range, k_t, 0.01 * k_t);
   states.opposite = nullptr;
   EXPECT_TRUE(notes_say(read_edges(states).edges[0], "no edge at the other end"));
}

TEST(EdgeReport, SaysWhatIsNotToBeTrusted)
{
   const ReducedProblem problem = hertz_pair(41); // a slip zone of 0.01, nodes 0.07 apart
   const Solved solved = solve(problem, {load, 0, 0}, {0, 0.02 * 0.5 * load, 0});
   const EdgeReport report = read_edges({problem, solved.pressed, solved.peak});
   ASSERT_EQ(report.edges.size(), 2u);
   EXPECT_TRUE(
      notes_say(report.edges[0], "shorter than two spacings of the nodes (0.0683)")); // 2.8/41
   ContactState apart = solved.pressed;
   apart.status.assign(41, NodeState::separation);
   apart.p.setZero();
   apart.q.setZero();
   EXPECT_NE(read_edges({problem, apart, apart}).why_not, "");
   ReducedProblem smooth = problem;
   set_friction(smooth, 0);
   const EdgeReport refused = read_edges({smooth, solved.pressed, solved.peak});
   EXPECT_TRUE(refused.edges.empty());
   EXPECT_NE(refused.why_not.find("friction"), std::string::npos) << refused.why_not;
}

TEST(EdgeReport, ACornerIsFittedWhereItsModesAreKnown)
{
   const ReducedProblem problem = half_planes(41, 1, [](double) { return 0.0; });
   const Solved solved = solve(problem, {load, 0, 0}, {0, 0.1 * load, 0});
   MarchedStates states{problem, solved.pressed, solved.peak};
   for (const SolvedEdge &one : read_edges(states).edges)
   {
      EXPECT_FALSE(one.corner);
      EXPECT_TRUE(notes_say(one, one.edge.why_not));
      EXPECT_EQ(one.travel, 0);
   }
   states.corner = [](int side)
   {
      require(side > 0, "nobody knows");
      return corner_modes(Corner{pi / 2, pi});
   };
   const EdgeReport report = read_edges(states);
   ASSERT_EQ(report.edges.size(), 2u);
   ASSERT_TRUE(report.edges[0].corner);
   EXPECT_NEAR(report.edges[0].corner->least_friction, 0.543075578837, 1e-11);
   EXPECT_GT(report.edges[0].corner->k_one.nodes, 3);
   EXPECT_FALSE(report.edges[1].corner);
   EXPECT_TRUE(notes_say(report.edges[1], "not fitted as a corner: nobody knows"));
}

TEST(Corner, SquarePunchOnAHalfPlane)
{
   const CornerModes modes = corner_modes(Corner{pi / 2, pi});
   EXPECT_NEAR(modes.one.eigenvalue, 0.544483736782, 1e-12);
   EXPECT_NEAR(modes.two->eigenvalue, 0.908529189846, 1e-12);
   EXPECT_NEAR(modes.one.traction_ratio(), 0.543075578837, 1e-11);
   EXPECT_NEAR(modes.two->traction_ratio(), -0.218923236249, 1e-11);
}

TEST(Corner, OtherAngles)
{
   // A crack: both exponents 1/2, and on its own line K_I, K_II are the tractions.
   const CornerModes crack = corner_modes(Corner{pi, pi});
   EXPECT_NEAR(crack.one.eigenvalue, 0.5, 1e-14);
   EXPECT_NEAR(crack.two->eigenvalue, 0.5, 1e-14);
   EXPECT_NEAR(crack.one.pressure, 1, 1e-12);
   EXPECT_NEAR(crack.one.shear, 0, 1e-12);
   EXPECT_NEAR(crack.two->shear, 1, 1e-12);
   EXPECT_NEAR(crack.two->pressure, 0, 1e-12);
   // Roots solve the characteristic equation, and mode II passes λ = 1 at tan α = α.
   for (const double sum : {3.3, 3.9, 4.3, 4.49, 4.50, 4.9, 5.5, 6.2})
   {
      const CornerModes modes = corner_modes(Corner{sum - 2.0, 2.0});
      const double one = modes.one.eigenvalue, two = modes.two->eigenvalue;
      EXPECT_NEAR(std::sin(one * sum) + one * std::sin(sum), 0, 1e-13);
      EXPECT_NEAR(std::sin(two * sum) - two * std::sin(sum), 0, 1e-9);
      EXPECT_GE(one, 0.5);
      EXPECT_LT(one, 1);
      EXPECT_EQ(two<1, sum> 4.493409457909064);
      EXPECT_GT(std::abs(two - 1), 1e-4);
   }
   // Exchanging pad and body mirrors the corner: the shear changes sides, and so does K_II.
   const CornerModes a = corner_modes(Corner{1.6, 3.2}), b = corner_modes(Corner{3.2, 1.6});
   EXPECT_NEAR(a.one.shear, -b.one.shear, 1e-12);
   EXPECT_NEAR(a.two->pressure, -b.two->pressure, 1e-12);
   EXPECT_THROW(corner_modes(Corner{1.5, 1.6}), InputError);
   EXPECT_THROW(corner_modes(Corner{4, 3}), InputError);
   EXPECT_THROW(corner_modes(Corner{-1, 5}), InputError);
}

/// Bonded to a rigid body, from Airy's function r^{λ+1} [A cos (λ+1)θ + B sin (λ+1)θ +
/// C cos (λ-1)θ + D sin (λ-1)θ]: the smallest singular value of the conditions u(0) = 0,
/// σ_θθ(α) = σ_rθ(α) = 0 over the largest, and the shear on the body over the pressure at 0.
std::array<double, 2> clamped_wedge(double lambda, double angle, double kappa)
{
   const double up = lambda + 1, down = lambda - 1;
   const auto normal = [&](double t) -> Eigen::RowVector4d
   {
      return lambda * up *
             Eigen::RowVector4d(std::cos(up * t), std::sin(up * t), std::cos(down * t),
                                std::sin(down * t));
   };
   const auto shear = [&](double t) -> Eigen::RowVector4d
   {
      return -lambda * Eigen::RowVector4d(-up * std::sin(up * t), up * std::cos(up * t),
                                          -down * std::sin(down * t),
                                          down * std::cos(down * t));
   };
   Eigen::Matrix4d conditions;
   conditions.row(0) << -up, 0, kappa - lambda, 0;
   conditions.row(1) << 0, -up, 0, -(kappa + lambda);
   conditions.row(2) = normal(angle);
   conditions.row(3) = shear(angle);
   const Eigen::JacobiSVD<Eigen::Matrix4d> svd(conditions, Eigen::ComputeFullV);
   const Eigen::Vector4d mode = svd.matrixV().col(3);
   const auto values = svd.singularValues();
   // Outward of the pad at θ = 0 is -y: p = -σ_θθ; on the body σ_rθ acts into the contact.
   return {values[3] / values[0], -shear(0).dot(mode) / normal(0).dot(mode)};
}

TEST(Corner, PadBondedToARigidBody)
{
   // Right angle: the exponent of stress is λ-1 = -0.289 for ν = 0.3, -0.405 without change of
   // volume (butt joints: Reedy 1990; die swell); for ν = 0 uniform compression is exact.
   EXPECT_NEAR(corner_modes(RigidCorner{pi / 2, 0.3}).one.eigenvalue, 0.7112, 5e-5);
   EXPECT_NEAR(corner_modes(RigidCorner{pi / 2, 0.4999999}).one.eigenvalue, 0.5946, 5e-5);
   EXPECT_NEAR(corner_modes(RigidCorner{pi / 2, 1e-6}).one.eigenvalue, 1, 1e-2);
   EXPECT_THROW(corner_modes(RigidCorner{pi / 2, 0}), InputError);
   int single = 0, both = 0;
   for (const double angle : {1.3, 1.5, pi / 2, 1.8, 2.1, 2.3, 2.36})
   {
      for (const double nu : {0.2, 0.3, 0.45})
      {
         for (const bool plane_stress : {false, true})
         {
            const double kappa = plane_stress ? (3 - nu) / (1 + nu) : 3 - 4 * nu;
            CornerModes modes;
            try
            {
               modes = corner_modes(RigidCorner{angle, nu, plane_stress});
            }
            catch (const InputError &)
            {
               continue;
            }
            (modes.two ? both : single)++;
            for (const CornerMode &mode : {modes.one, modes.two.value_or(modes.one)})
            {
               EXPECT_GT(mode.eigenvalue, 0.4);
               EXPECT_LT(mode.eigenvalue, 1);
               const auto [singular, ratio] = clamped_wedge(mode.eigenvalue, angle, kappa);
               EXPECT_NEAR(singular, 0, 1e-13) << angle << " " << nu;
               EXPECT_NEAR(mode.shear, ratio, 1e-10) << angle << " " << nu;
            }
         }
      }
   }
   EXPECT_GT(single, 10);
   EXPECT_GT(both, 3);
   // Towards a half-plane the roots are 1/2 ± i ln κ / 2π: no intensity; sharp pads: none.
   for (const double angle : {3.0, 0.5, 0.0, pi})
   {
      EXPECT_THROW(corner_modes(RigidCorner{angle, 0.3}), InputError) << angle;
   }
   EXPECT_THROW(corner_modes(RigidCorner{pi / 2, 0.5}), InputError);
   EXPECT_THROW(corner_modes(RigidCorner{pi / 2, -0.1}), InputError);
}

EdgeTractions corner_tractions(const CornerModes &modes, double one, double two, double smooth)
{
   const CornerMode second = modes.two.value_or(CornerMode{1, 0, 0});
   EdgeTractions tractions;
   tractions.edge = 2;
   for (int i = 0; i < 60; i++)
   {
      const double r = 0.01 * i;
      const double first = one * std::pow(r, modes.one.eigenvalue - 1);
      const double other = two * std::pow(r, second.eigenvalue - 1);
      tractions.position.push_back(2 - r); // contact to the left of the corner
      tractions.pressure.push_back(
         i ? first * modes.one.pressure + other * second.pressure + smooth * r : 0);
      tractions.shear.push_back(
         i ? -(first * modes.one.shear + other * second.shear - smooth * r) : 0);
   }
   return tractions;
}

TEST(Corner, FitRecoversTheIntensities)
{
   // The third sum is below 4.49: its mode II is regular. The last has no second mode.
   for (const CornerModes &modes :
        {corner_modes(Corner{pi / 2, pi}), corner_modes(Corner{1.9, 2.9}),
         corner_modes(Corner{1.3, 2.9}), corner_modes(Corner{2.5, 2.5}),
         corner_modes(RigidCorner{pi / 2, 0.3})})
   {
      const CornerFit exact = fit_corner(modes, corner_tractions(modes, 1.3, -0.4, 0));
      const CornerFit fit = fit_corner(modes, corner_tractions(modes, 1.3, -0.4, 0.2));
      EXPECT_NEAR(exact.k_one.value, 1.3, 1e-9);
      EXPECT_LT(std::abs(fit.k_one.value - 1.3), 1.3 * fit.k_one.relative_error);
      EXPECT_LT(fit.k_one.relative_error, 0.03);
      EXPECT_NEAR(fit.k_one.value, 1.3, 0.01);
      EXPECT_GT(fit.k_one.nodes, 3);
      if (!modes.two)
      {
         EXPECT_EQ(fit.k_two.nodes, 0);
         continue;
      }
      EXPECT_NEAR(exact.k_two.value, -0.4, 1e-9);
      EXPECT_NEAR(fit.k_two.value, -0.4, 0.01);
      EXPECT_LT(std::abs(fit.k_two.value + 0.4), 0.4 * fit.k_two.relative_error);
      EXPECT_LT(fit.k_two.relative_error, 0.03);
   }
   const CornerModes punch = corner_modes(Corner{pi / 2, pi});
   EXPECT_NEAR(fit_corner(punch, corner_tractions(punch, 1, 0.1, 0)).least_friction,
               0.543075578837, 1e-9);
}

TEST(Corner, WindowsOfAFitAreWhatItSays)
{
   // Nodes 1/64 apart, whose distances are exact.
   const CornerModes modes = corner_modes(Corner{pi / 2, pi});
   EdgeTractions tractions; // to the left of a corner at 0
   for (int i = 1; i < 60; i++)
   {
      const double r = i / 64.0, one = std::pow(r, modes.one.eigenvalue - 1),
                   two = 0.2 * std::pow(r, modes.two->eigenvalue - 1);
      tractions.position.push_back(-r);
      tractions.pressure.push_back(one * modes.one.pressure + two * modes.two->pressure);
      tractions.shear.push_back(-one * modes.one.shear - two * modes.two->shear);
   }
   FitSettings settings;
   settings.window = {3 / 64.0, 8 / 64.0}; // both ends are in it
   const CornerFit named = fit_corner(modes, tractions, settings);
   EXPECT_EQ(named.k_one.nodes, 6);
   EXPECT_EQ(named.k_two.nodes, 6);
   EXPECT_EQ(named.k_one.window.nearest, 3 / 64.0);
   EXPECT_EQ(named.k_two.window.farthest, 8 / 64.0);
   EXPECT_NEAR(named.k_one.value, 1, 1e-9);
   EXPECT_NEAR(named.k_two.value, 0.2, 1e-9);
   // From the 20th node on the field is another: a chosen window ends before, and says where.
   for (std::size_t i = 19; i < tractions.position.size(); i++) { tractions.pressure[i] *= 2; }
   for (const int skip : {0, 2, 5})
   {
      settings = {};
      settings.skip = skip;
      const CornerFit fit = fit_corner(modes, tractions, settings);
      EXPECT_EQ(fit.k_one.window.nearest, (skip + 1) / 64.0);
      EXPECT_EQ(fit.k_one.window.farthest, (skip + fit.k_one.nodes) / 64.0);
      EXPECT_LT(fit.k_one.window.farthest, 20 / 64.0);
      EXPECT_NEAR(fit.k_one.value, 1, 1e-9);
   }
   // Seen with pad and body exchanged the shear changes its sign, not the friction it takes.
   const CornerModes exchanged = corner_modes(Corner{pi, pi / 2});
   EXPECT_LT(exchanged.one.traction_ratio(), 0);
   EXPECT_NEAR(fit_corner(exchanged, corner_tractions(exchanged, 1, 0.1, 0)).least_friction,
               0.543075578837, 1e-9);
}

TEST(Corner, ErrorsAreThoseOfLeastSquaresByHand)
{
   // One mode without shear: the pressure times r^{1-λ} is the line K + c r, at r = 1, 2, 3, 4,
   // and δ (1, -1, -1, 1), which is orthogonal to it. Eight values less three unknowns leave
   // five degrees of freedom, so that the variance is 4 δ²/5; that of K is 1/4 + 2.5²/5 = 3/2
   // times as large. Without c the fit is the mean: it changes by 2.5 c.
   CornerModes modes;
   modes.one.eigenvalue = 0.75;
   modes.one.pressure = 1;
   modes.one.shear = 0;
   FitSettings settings;
   settings.window = {0.5, 4.5};
   const double K = 2, delta = 0.01;
   for (const double c : {0.0, 0.1})
   {
      EdgeTractions tractions;
      tractions.edge = 0;
      for (const int r : {1, 2, 3, 4})
      {
         const double value = K + c * r + (r == 1 || r == 4 ? delta : -delta);
         tractions.position.push_back(r);
         tractions.pressure.push_back(value * std::pow(r, -0.25));
         tractions.shear.push_back(0);
      }
      const CornerFit fit = fit_corner(modes, tractions, settings);
      EXPECT_NEAR(fit.k_one.value, K, 1e-13);
      EXPECT_NEAR(fit.k_one.relative_error * K, c > 0 ? 2.5 * c : delta * std::sqrt(1.2),
                  1e-12);
   }
}

TEST(Corner, FitRefusesBadInput)
{
   const CornerModes corner = corner_modes(Corner{pi / 2, pi});
   const EdgeTractions good = corner_tractions(corner, 1, 1, 0); // nodes 0.01 apart
   // Why something is refused, or nothing.
   const auto refusal = [&](const EdgeTractions &tractions, const FitWindow &window)
   {
      FitSettings settings;
      settings.window = window;
      try
      {
         const CornerFit fit = fit_corner(corner, tractions, settings);
         EXPECT_NEAR(fit.k_one.value, 1, 1e-9);
         return std::string();
      }
      catch (const InputError &error)
      {
         return std::string(error.what());
      }
   };
   const auto expect_refused =
      [&](const EdgeTractions &tractions, const FitWindow &window, const std::string &part)
   {
      const std::string message = refusal(tractions, window);
      EXPECT_NE(message.find(part), std::string::npos) << message;
   };
   const FitWindow four = {0.005, 0.045}, three = {0.005, 0.035};
   EXPECT_EQ(refusal(good, {}), "");
   EXPECT_EQ(refusal(good, four), "");
   expect_refused(good, three, "there are 3 nodes in the window");
   expect_refused(good, {0.1, 0.05}, "window");
   EdgeTractions bad = good;
   bad.shear.pop_back();
   expect_refused(bad, four, "59 shear tractions");
   bad = good;
   bad.pressure.push_back(1);
   expect_refused(bad, four, "61 pressures");
   bad = good;
   bad.edge = 1.905; // between nodes 9 and 10
   expect_refused(bad, four, "is on the other side of the edge at 1.905");
   for (std::vector<double> EdgeTractions::*list :
        {&EdgeTractions::position, &EdgeTractions::pressure, &EdgeTractions::shear})
   {
      bad = good;
      (bad.*list)[3] = std::nan("");
      expect_refused(bad, four, "node 3 has");
   }
}

} // namespace
