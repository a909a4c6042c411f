#include "expect_input_error.hpp"

#include <cattaneo/design/edge_response.hpp>
#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>
#include <gtest/gtest.h>

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// A half-plane's pad |x| < span on another one, E* = 4/π: a parabola x²/2 has a = 1 under P
/// = 1.
ReducedProblem pad(double span, int elements)
{
   HalfPlane upper, lower;
   upper.material = lower.material = Material{8 / M_PI * 0.91, 0.3};
   upper.depth = lower.depth = 1e4;
   upper.normal = {0, 1};
   upper.forces = {{"P", {0, -1}}, {"Q", {1, 0}}};
   std::vector<double> grid;
   for (int k = 0; k <= elements; ++k) { grid.push_back(span * (2.0 * k / elements - 1)); }
   ReducedProblem problem = reduce(condense(upper, grid, 1), lower).problem;
   problem.B().setZero(); // equal half-planes
   join_coupling(problem);
   set_friction(problem, 0.5);
   problem.gap.setZero();
   return problem;
}

MarchTrace pressed_and_sheared(const ReducedProblem &problem, double P = 1, double Q = 0.3)
{
   MarchSettings settings;
   settings.increments_of_piece = {1, 4};
   const MarchTrace trace = trace_march(
      problem, LoadHistory::through(problem, {{}, {{"P", P}}, {{"P", P}, {"Q", Q}}}), settings);
   EXPECT_EQ(trace.report.status, FrictionStatus::converged) << trace.report.message;
   return trace;
}

} // namespace

// Hertz, a² = P/κ of a parabola κ x²/2 and K_N = p0 √(2/a) = (2/π) P/a √(2/a): as P^(1/4) and
// as κ^(3/4).
TEST(EdgeResponse, MovingEdgeOfHertz)
{
   ReducedProblem problem = pad(1.25, 100);
   const VectorXd parabola = 0.5 * problem.position.col(0).cwiseAbs2();
   problem.gap = parabola;
   const MarchTrace trace = pressed_and_sheared(problem);
   const std::size_t pressed = trace.at(1);
   const ContactState &state = trace.states[pressed].state;
   const std::vector<ContactEdge> edges =
      contact_edges(problem, state, trace.states.back().state);
   ASSERT_EQ(edges.size(), 2u);
   const double k_n = 2 / M_PI * std::sqrt(2.0);
   Sensitivity sensitivity(problem, trace);
   for (const ContactEdge &edge : edges)
   {
      const MovingEdge moving = moving_edge(problem, trace, pressed, edge);
      EXPECT_NEAR(moving.position.value, edge.position.position, edge.position.error);
      EXPECT_NEAR(moving.position.value, 1.25 - edge.side, 5e-3); // arc length from the end
      EXPECT_NEAR(moving.k_n.value, edge.k_n.value, edge.k_n.relative_error * k_n);
      EXPECT_NEAR(moving.k_n.value, k_n, 0.01 * k_n);
      const Gradient position = sensitivity.gradient(moving.position),
                     intensity = sensitivity.gradient(moving.k_n);
      ASSERT_TRUE(position.found && intensity.found);
      EXPECT_NEAR(-edge.side * position.by.multipliers(0, 1), 0.5, 0.03);
      EXPECT_NEAR(-edge.side * position.by.gap.dot(parabola), -0.5, 0.03);
      EXPECT_NEAR(intensity.by.multipliers(0, 1), k_n / 4, 0.05 * k_n);
      EXPECT_NEAR(intensity.by.gap.dot(parabola), 0.75 * k_n, 0.05 * k_n);
      // Exact in the discrete problem: equal to differences of marches.
      const double h = 1e-6;
      double moved[2], grown[2];
      for (const int way : {0, 1})
      {
         const MarchTrace other = pressed_and_sheared(problem, 1 + (way ? h : -h));
         FitSettings same;
         same.window = fit_edge(edge_tractions(problem, state, edge)).k_n.window;
         const MovingEdge read = moving_edge(problem, other, other.at(1), edge, same);
         moved[way] = read.position.value;
         grown[way] = read.k_n.value;
      }
      EXPECT_NEAR(position.by.multipliers(0, 1), (moved[1] - moved[0]) / (2 * h), 1e-7);
      EXPECT_NEAR(intensity.by.multipliers(0, 1), (grown[1] - grown[0]) / (2 * h), 1e-7);
   }
}

// A stuck contact has K_T = Q/(π √(2a)), in proportion to Q whatever the friction.
TEST(EdgeResponse, StuckShearOfHertz)
{
   ReducedProblem problem = pad(1.25, 100);
   problem.gap = 0.5 * problem.position.col(0).cwiseAbs2();
   const MarchTrace trace = pressed_and_sheared(problem);
   const std::size_t pressed = trace.at(1);
   const std::vector<ContactEdge> edges = contact_edges(
      problem, trace.states[pressed].state, trace.states.back().state, CrackedBody::first);
   const MarchTrace stuck = trace_stuck(problem, trace, pressed, trace.last());
   Sensitivity sensitivity(problem, stuck);
   for (const ContactEdge &edge : edges)
   {
      const EdgeIntensities read =
         edge_intensities(problem, stuck, stuck.last(), edge, CrackedBody::first);
      EXPECT_NEAR(std::abs(read.k_t.value), 0.3 / (M_PI * std::sqrt(2.0)), 2e-3);
      EXPECT_EQ(read.k_t.value > 0, edge.k_t.value > 0);
      const Gradient by = sensitivity.gradient(read.k_t);
      ASSERT_TRUE(by.found) << by.message;
      EXPECT_NEAR(by.by.multipliers(1, 2), read.k_t.value / 0.3, 1e-10);
      EXPECT_LT(by.by.friction.cwiseAbs().maxCoeff(), 1e-12);
      // K_N of the same nodes: in proportion to loads and gaps together (Euler).
      const Gradient of_n = sensitivity.gradient(read.k_n);
      EXPECT_NEAR(of_n.by.multipliers.cwiseProduct(stuck.history.multipliers).sum() +
                     of_n.by.gap.dot(problem.gap),
                  read.k_n.value, 1e-10);
   }
   expect_input_error([&] { trace_stuck(problem, trace, 2, 2); }, "must come later");
   expect_input_error([&] { trace_stuck(problem, trace, 0, 99); }, "state 99");
}

// The corners of a flat pad: both strengths are linear in loads and small gaps.
TEST(EdgeResponse, CornersOfAFlatPad)
{
   const ReducedProblem flat = pad(1, 60);
   const fretting::CornerModes modes =
      corner_modes(fretting::Corner{0.5 * M_PI, M_PI}); // any pair will do
   const auto read = [&](const ReducedProblem &problem, double Q, const FitSettings &settings)
   {
      const MarchTrace trace = pressed_and_sheared(problem, 1, Q);
      ContactEdge edge;
      edge.position.position = problem.arc_length[0];
      edge.first = 0;
      edge.last = 30;
      const MarchTrace stuck = trace_stuck(problem, trace, trace.at(1), trace.last());
      return std::pair{stuck, corner_intensities(problem, stuck, stuck.last(), edge, modes,
                                                 CrackedBody::first, settings)};
   };
   FitSettings settings;
   settings.window = {0.08, 0.6};
   const auto [trace, at] = read(flat, 0.2, settings);
   Sensitivity sensitivity(flat, trace);
   for (const Response &response : {at.k_one, at.k_two})
   {
      const Gradient by = sensitivity.gradient(response);
      ASSERT_TRUE(by.found) << by.message;
      EXPECT_NEAR(by.by.multipliers.cwiseProduct(trace.history.multipliers).sum(),
                  response.value, 1e-10 * std::abs(response.value));
      EXPECT_GT(std::abs(response.value), 1e-3);
   }
   const double dQ = 0.05;
   const CornerIntensities more = read(flat, 0.2 + dQ, settings).second;
   EXPECT_NEAR(sensitivity.gradient(at.k_two).by.multipliers(1, 2),
               (more.k_two.value - at.k_two.value) / dQ, 1e-9);
   ReducedProblem bent = flat;
   bent.gap[20] = 1e-7;
   const double change = read(bent, 0.2, settings).second.k_one.value - at.k_one.value;
   EXPECT_NEAR(sensitivity.gradient(at.k_one).by.gap[20], change / 1e-7,
               1e-6 * std::abs(change / 1e-7));
}
