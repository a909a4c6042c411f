#include "common/hertz_scene.hpp"
#include "common/punch.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Two chains of two nodes and one, not coupled.
ReducedProblem three_nodes()
{
   ReducedProblem problem;
   problem.set_stiffness(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(),
                         Eigen::Matrix3d::Identity());
   problem.gap = Eigen::Vector3d::Zero();
   problem.position = Eigen::MatrixXd{{0, 5}, {1, 6}, {3, 7}};
   const auto smooth = LineEnd::smooth;
   problem.chains = {{"seat", 0, 2, false, {smooth, smooth}, {smooth, smooth}},
                     {"hook", 2, 1, false, {smooth, smooth}, {smooth, smooth}}};
   set_friction(problem, 0.5);
   return problem;
}

TEST(CutOff, AsksForCompressionAndForBothBodies)
{
   ReducedProblem problem = three_nodes();
   ContactState state = ContactState::virgin(problem);
   const auto found = [&] { return cut_off_contact(problem, state); };
   state.status.assign(3, NodeState::separation);
   EXPECT_EQ(found().size(), 0u);
   state.status = {NodeState::stick, NodeState::forward_slip, NodeState::separation};
   state.p << 1, 2, 0;
   state.time = 0.25;
   ASSERT_EQ(found().size(), 2u);
   EXPECT_EQ(found()[0].node, 0);
   EXPECT_TRUE(found()[0].at_first);
   EXPECT_EQ(found()[1].node, 1);
   EXPECT_FALSE(found()[1].at_first);
   EXPECT_EQ(found()[1].x, 1);
   EXPECT_EQ(found()[1].y, 6);
   const std::string message = found()[1].message();
   EXPECT_NE(
      message.find("last node of piece 1 of the line 'seat' (node 1 at (1, 6), time 0.25)"),
      std::string::npos)
      << message;
   problem.position.resize(0, 2);
   EXPECT_EQ(found()[1].x, 0);
   EXPECT_EQ(found()[1].y, 0);
   problem = three_nodes();
   // A node that is closed but carries nothing, or the round-off of it.
   state.p << 1e-17, 2, 0;
   ASSERT_EQ(found().size(), 1u);
   EXPECT_EQ(found()[0].node, 1);
   // Nor one that carries a trillionth of what the other does while every node is pressed.
   state.status[2] = NodeState::stick;
   state.p << 2e-12, 2, 1e-12;
   ASSERT_EQ(found().size(), 1u);
   EXPECT_EQ(found()[0].node, 1);
   state.status[2] = NodeState::separation;
   state.p << 1e-17, 2, 0;
   // Either body may end; what is not known says nothing; a loop has no ends.
   for (const LineEnd end : {LineEnd::corner, LineEnd::symmetry, LineEnd::unknown})
   {
      ReducedProblem other = problem;
      other.chains[0].ends[1] = end;
      EXPECT_EQ(cut_off_contact(other, state).size(), 0u);
      other = problem;
      other.chains[0].other_ends[1] = end;
      EXPECT_EQ(cut_off_contact(other, state).size(), 0u);
   }
   problem.chains[0].loop = true;
   EXPECT_EQ(found().size(), 0u);
   // A chain of one node has it at both ends.
   state.status = {NodeState::separation, NodeState::separation, NodeState::stick};
   state.p << 0, 0, 1;
   EXPECT_EQ(found().size(), 2u);
   problem.chains.clear();
   EXPECT_EQ(found().size(), 0u);
}

/** A half-plane (E' = 1) that its far support lifts onto a rigid cylinder of radius 100 above
    x = shift; the line is |x| < 1.67. What the march says of its ends, and the force pressed at
    that time. */
struct Rolled
{
   std::vector<CutOffContact> found;
   std::vector<double> force; ///< at the times found
   double last = 0;           ///< force at the end

   Rolled(double shift, double height)
   {
      const auto line = graded_to_ends(1.67, 30, 1);
      const double h = line[1] - line[0];
      mfem::Mesh mesh =
         half_plane_mesh(line, graded(0, 1.67, h, 1.25, 0.3), ring_scales(1.67, 1e3, h, 1.25));
      ElasticBody body(mesh, 2, {1 - 0.3 * 0.3, 0.3, PlaneState::strain});
      body.fix(3, 0);
      body.add_displacement("lift", 3, 1, height);
      const Reduction reduction =
         reduce(condense(body, contact_line(body, 1)),
                [=](double x, double) { return (x - shift) * (x - shift) / 200; });
      ReducedProblem problem = reduction.problem;
      set_friction(problem, 0.3);
      ContactState state = ContactState::virgin(problem);
      MarchSettings settings;
      settings.increments = 40;
      std::vector<std::pair<double, double>> history;
      const MarchReport report = march(
         problem, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}), state, settings,
         [&](const ContactState &now, const IncrementRecord &)
         { history.emplace_back(now.time, now.p.sum()); });
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      found = report.cut_off;
      for (const CutOffContact &end : found)
      {
         for (const auto &[time, pressed] : history)
         {
            if (time == end.time) { force.push_back(pressed); }
         }
      }
      last = history.back().second;
   }
};

TEST(CutOff, APadThatRollsOffItsLineIsFoundWhenItDoes)
{
   // Hertz: a² = 4 P R/(π E'). Contact around 0.9 reaches the line's end at 1.67 when a = 0.77,
   // and the other end never; around 0 both when a = 1.67.
   const auto force = [](double a) { return std::acos(-1.0) * a * a / 400; };
   const Rolled middle(0, 0.04);
   EXPECT_EQ(middle.found.size(), 0u);
   EXPECT_LT(middle.last, force(1.67));
   EXPECT_GT(middle.last, force(0.8));
   const Rolled off(0.9, 0.04);
   ASSERT_EQ(off.found.size(), 1u);
   ASSERT_EQ(off.force.size(), 1u);
   EXPECT_NEAR(off.found[0].x, 1.67, 1e-9);
   // A node is reached half a spacing (0.056) early or late, an increment is 1/40.
   EXPECT_GT(off.force[0], force(0.77 - 0.056));
   EXPECT_LT(off.force[0], force(0.77 + 0.056) + off.last / 20);
   const Rolled both(0, 0.2);
   EXPECT_EQ(both.found.size(), 2u);
}

TEST(CutOff, LinesNamedTooShortAreFoundBetweenTwoBodies)
{
   // Two half-planes pressed to the half-width 1; the candidates span 1.67, and 0.835.
   for (const double expected : {1.0, 0.5})
   {
      const double radius = 100, E_star = 0.5;
      miniapp::HalfPlanes options;
      options.nodes = 61;
      options.half_width = expected;
      options.domain = 1e3;
      options.material = {1 - 0.3 * 0.3, 0.3, PlaneState::strain};
      options.load = std::acos(-1.0) * E_star / (4 * radius);
      miniapp::Scene scene = make_scene(options);
      ReducedProblem &problem = scene.reduction.problem;
      problem.gap = problem.position.col(0).array().square() / (2 * radius);
      set_friction(problem, 0.3);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      ASSERT_EQ(report.cut_off.size(), expected == 1 ? 0u : 2u);
      if (expected == 1) { continue; }
      EXPECT_NEAR(std::abs(report.cut_off[0].x), 0.835, 1e-12);
      EXPECT_NEAR(report.cut_off[0].x + report.cut_off[1].x, 0, 1e-12);
   }
}

TEST(CutOff, CornersOfAPunchEndTheirContact)
{
   // All of its nodes are closed, and the half-plane goes on; the rigid plane as well.
   for (const bool half_plane : {true, false})
   {
      miniapp::PunchOptions options;
      options.half_plane = half_plane;
      options.nodes = 33;
      options.domain = 100;
      miniapp::Scene punch = miniapp::make_punch(options);
      ReducedProblem &problem = punch.reduction.problem;
      set_friction(problem, 0.4);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem,
               LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.2)}), state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_TRUE(closed(state.status.front()) && closed(state.status.back()));
      EXPECT_EQ(report.cut_off.size(), 0u);
   }
}

} // namespace
