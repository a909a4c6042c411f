// Statements that were wrong once: each a small problem with its answer by hand.

#include <algorithm>
#include <cattaneo/friction/free_bodies.hpp>
#include <cattaneo/friction/march.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

ReducedProblem two_nodes(const Matrix2d &A, const Matrix2d &B, const Matrix2d &C,
                         const Vector2d &q, const Vector2d &p, const Vector2d &friction)
{
   ReducedProblem problem;
   problem.set_stiffness(A, B, C);
   problem.patterns = {{"L", Control::force, q, p}};
   problem.H = MatrixXd::Zero(1, 1);
   problem.gap = Vector2d::Zero();
   problem.friction = friction;
   return problem;
}

IncrementReport loaded(const ReducedProblem &problem, ContactState &state)
{
   state = ContactState::virgin(problem);
   return FrictionSolver(problem).solve(state, VectorXd::Ones(1));
}

const Matrix2d I = Matrix2d::Identity(), O = Matrix2d::Zero(),
               free_along{{1, -1}, {-1, 1}}; // springs between the nodes only

TEST(FrictionStatements, WithoutFrictionABodyThatIsPushedAlongSlides)
{
   ContactState state;
   for (double friction : {0.0, 1e-9, 0.9})
   {
      const ReducedProblem problem = two_nodes(free_along, O, I, Vector2d(1, 1), Vector2d(1, 1),
                                               Vector2d::Constant(friction));
      const IncrementReport report = loaded(problem, state);
      EXPECT_EQ(report.status, FrictionStatus::gross_sliding) << friction;
   }
   // Shear that balances itself only stretches it.
   const ReducedProblem stretched =
      two_nodes(free_along, O, I, Vector2d(1, -1), Vector2d(1, 1), Vector2d::Zero());
   ASSERT_EQ(loaded(stretched, state).status, FrictionStatus::converged);
   EXPECT_NEAR(state.v[0] - state.v[1], -1, 1e-14);
}

TEST(FrictionStatements, WithoutFrictionABodyThatIsTwistedSpins)
{
   ReducedProblem problem = two_nodes(I, O, I, Vector2d(0, 0), Vector2d(1, 1), Vector2d(0, 0));
   MatrixXd A = MatrixXd::Identity(4, 4);
   A.bottomRightCorner(2, 2) = free_along;
   problem.set_stiffness(A, MatrixXd::Zero(2, 4), I);
   problem.patterns[0].q = Eigen::Vector4d(0, 0, 1, 1);
   ContactState state;
   EXPECT_EQ(loaded(problem, state).status, FrictionStatus::gross_sliding);
}

TEST(FrictionStatements, ASoftNodeFeelsItsCouplingBesideAStiffOne)
{
   // The soft node alone: q = v + 1 = 0.1 p and p = 1 + b v, so v = -0.9/(1 - 0.1 b).
   const double b = 0.009;
   ContactState state;
   for (double stiff : {1.0, 1e3, 1e6, 1e9, 1e12})
   {
      const ReducedProblem problem = two_nodes(
         Vector2d(stiff, 1).asDiagonal(), Vector2d(0, b).asDiagonal(),
         Vector2d(stiff, 1).asDiagonal(), Vector2d(0, 1), Vector2d(1, 1), Vector2d(0.1, 0.1));
      ASSERT_EQ(loaded(problem, state).status, FrictionStatus::converged) << stiff;
      EXPECT_NEAR(state.v[1], -0.9 / (1 - 0.1 * b), 1e-13) << stiff;
      EXPECT_NEAR(state.p[1], 1 - 0.9 * b / (1 - 0.1 * b), 1e-13) << stiff;
   }
}

TEST(FrictionStatements, SpringsOfVeryDifferentStiffnessHold)
{
   ContactState state;
   for (double soft : {1e-2, 1e-5, 1e-7})
   {
      const ReducedProblem problem =
         two_nodes(Vector2d(1e8, soft).asDiagonal(), O, Vector2d(1e8, soft).asDiagonal(),
                   Vector2d(0, 1), Vector2d(1, 1), Vector2d(0.1, 0.1));
      const IncrementReport report = loaded(problem, state);
      ASSERT_EQ(report.status, FrictionStatus::converged) << soft << ' ' << report.message;
      EXPECT_NEAR(state.v[1] * soft, -0.9, 1e-13) << soft;
   }
}

// A body that touches, pulled at one node as hard as it is pressed at the other: the node that
// is pulled rises by 0.3. What 0.1 + 0.2 leaves of the balance decides nothing.
TEST(FrictionStatements, RoundOffOfALoadDecidesNothing)
{
   ContactState state;
   for (const Vector2d &p :
        {Vector2d(-0.3, 0.3), Vector2d(-0.3, 0.1 + 0.2), Vector2d(-(0.1 + 0.2), 0.3)})
   {
      for (const Vector2d &q : {Vector2d(0, 0), p})
      {
         const ReducedProblem problem =
            two_nodes(free_along, O, free_along, q, p, Vector2d(0.1, 0.1));
         const IncrementReport report = loaded(problem, state);
         ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
         EXPECT_NEAR(state.w[0] - state.w[1], 0.3, 1e-14);
         EXPECT_LT(state.p.cwiseAbs().maxCoeff(), 1e-15);
      }
   }
}

TEST(FrictionStatements, ALeverOfRoundOffBalancesNothing)
{
   ReducedProblem problem =
      two_nodes(free_along, O, I, Vector2d(1, 1), Vector2d(1, 1), Vector2d::Zero());
   for (double lever : {0.0, 1e-17, 1e-15})
   {
      problem.rigid_motions = Eigen::Vector4d(1, 1, lever, -lever);
      const Mechanism found =
         find_mechanism(problem, problem.clamped_forces(VectorXd::Ones(1)), 1e-12);
      EXPECT_TRUE(found.exists && found.slides) << lever;
   }
}

/// A soft mode of stiffness e, from a slip of -2e8 back to one of 1: the round-off of where the
/// nodes come from is none of the answer's.
TEST(FrictionStatements, ASlipFromFarAwayLeavesNoRoundOff)
{
   const double e = std::ldexp(1, -30), f = 0.1;
   const Matrix2d soft{{1, 1 - e}, {1 - e, 1}};
   for (int components : {1, 2})
   {
      for (double coupling : {0.0, 0.1}) // of the sum of slips, which is none
      {
         const MatrixXd B = MatrixXd::Constant(2, 2, coupling);
         ReducedProblem problem =
            two_nodes(soft, B, I, Vector2d(1, -1), Vector2d(0, 0), Vector2d(f, f));
         problem.patterns.push_back({"P", Control::force, Vector2d(0, 0), Vector2d(1, 1)});
         problem.H = MatrixXd::Zero(2, 2);
         if (components == 2)
         {
            MatrixXd wide = MatrixXd::Identity(4, 4), beside = MatrixXd::Zero(2, 4);
            wide.topLeftCorner(2, 2) = soft;
            beside.leftCols(2) = B;
            problem.set_stiffness(wide, beside, problem.C());
            for (LoadPattern &pattern : problem.patterns)
            {
               pattern.q.conservativeResizeLike(VectorXd::Zero(4));
            }
         }
         ContactState state = ContactState::virgin(problem);
         FrictionSolver solver(problem);
         EXPECT_EQ(solver.solve(state, Vector2d(0.3, 1)).status, FrictionStatus::converged);
         EXPECT_NEAR(e * state.v[0], -0.2, 1e-7); // 0.3 + e v = f p, ε 2e8
         const IncrementReport back = solver.solve(state, Vector2d(-f - e, 1));
         EXPECT_EQ(back.status, FrictionStatus::converged);
         EXPECT_NEAR(state.v[0], 1, 1e-6); // round-off of the load over e
         EXPECT_LT(back.round_off, 1e-14);
         EXPECT_LT(back.residual_tangential, 1e-14);
         EXPECT_NEAR(state.q[0], -f, 1e-15);
      }
   }
}

TEST(FrictionStatements, WhatIsPulledOffLiftsOff)
{
   ContactState state;
   // Pulled straight, and to the side as well: nothing bears, nothing slides.
   for (double shear : {0.0, 0.5})
   {
      const ReducedProblem problem =
         two_nodes(free_along, O, free_along, Vector2d(shear, shear), Vector2d(-1, -1),
                   Vector2d(0.3, 0.3));
      const IncrementReport report = loaded(problem, state);
      EXPECT_EQ(report.status, FrictionStatus::no_solution);
      EXPECT_NE(report.message.find("lifts off"), std::string::npos) << report.message;
   }
}

TEST(FrictionStatements, ALossWhereSlipTurnsIsThatOfTheLinearPath)
{
   // q = v + Q, p = P, f = ½: at P = 4 the shear falls to -6 and the node slips by 4 against 2;
   // then P falls to 0.4 and Q rises to 2: it sticks until s = 4/9.8 of the way, where
   // p = 4 - 3.6 s, and slips back by 5.8 against f p, which falls linearly to 0.2.
   ReducedProblem problem;
   problem.set_stiffness(MatrixXd::Ones(1, 1), MatrixXd::Zero(1, 1), MatrixXd::Ones(1, 1));
   const VectorXd zero = VectorXd::Zero(1), one = VectorXd::Ones(1);
   problem.patterns = {{"P", Control::force, zero, one}, {"Q", Control::force, one, zero}};
   problem.H = MatrixXd::Zero(2, 2);
   problem.gap = zero;
   problem.friction = 0.5 * one;
   const double turn = 4 - 3.6 * 4 / 9.8, truth = 8 + 0.25 * (turn + 0.4) * 5.8;
   for (int increments : {1, 2, 20, 21})
   {
      for (Stepping stepping : {Stepping::fixed, Stepping::exact})
      {
         ContactState state = ContactState::virgin(problem);
         MarchSettings settings;
         settings.increments = increments;
         settings.stepping = stepping;
         const MarchReport report =
            march(problem,
                  LoadHistory::through(
                     {Vector2d(0, 0), Vector2d(4, 0), Vector2d(4, -6), Vector2d(0.4, 2)}),
                  state, settings);
         for (const IncrementRecord &record : report.increments)
         {
            EXPECT_GE(record.dissipation, 0);
         }
         // Where slip begins within an increment that found the node stuck, the pressure at its
         // start counts instead of the one where it begins: at most f Δp |Δv|/2 of one step.
         const bool exact = stepping == Stepping::exact || increments == 1;
         EXPECT_NEAR(state.dissipation, truth,
                     exact ? 1e-13 : 0.25 * 3.6 * 5.8 / increments / increments)
            << increments;
      }
   }
}

// A state found by whatever way is judged by the same laws.
TEST(FrictionStatements, JudgesWhatItIsGiven)
{
   const ReducedProblem problem =
      two_nodes(2 * I, 0.1 * I, 2 * I, Vector2d(0.3, 1), Vector2d(1, 1), Vector2d(0.5, 0.5));
   FrictionSolver solver(problem);
   const ContactState start = ContactState::virgin(problem);
   ContactState found;
   ASSERT_EQ(loaded(problem, found).status, FrictionStatus::converged);
   EXPECT_EQ(solver.judge(start, found).status, FrictionStatus::converged);
   const auto refused = [&](auto spoil)
   {
      ContactState other = found;
      spoil(other);
      const IncrementReport report = solver.judge(start, other);
      EXPECT_EQ(report.status, FrictionStatus::stalled);
      // The force of 1e-6, or of a displacement of 1e-6 against a stiffness of 2.
      EXPECT_GT(std::max(report.residual_normal, report.residual_tangential), 0.9e-6);
   };
   refused([](ContactState &s) { s.q[0] += 1e-6; });
   refused([](ContactState &s) { s.p[1] -= 1e-6; });
   refused([](ContactState &s) { s.v[0] += 1e-6; });
   refused([](ContactState &s) { s.w[1] -= 1e-6; });
   refused([](ContactState &s) { s.multipliers[0] += 1e-6; });
   // It slipped, but not from there.
   ContactState elsewhere = start;
   elsewhere.v[1] = found.v[1] - 1;
   EXPECT_EQ(solver.judge(elsewhere, found).status, FrictionStatus::stalled);
   // A slip with its friction, of a state before that is known to so much, may be none; what
   // the state breaks otherwise is not excused.
   const auto node = std::find_if(found.status.begin(), found.status.end(), slips);
   ASSERT_NE(node, found.status.end());
   const auto k = node - found.status.begin();
   elsewhere.v = found.v;
   elsewhere.v[k] += 1e-6 * sense(*node);
   EXPECT_EQ(solver.judge(elsewhere, found).status, FrictionStatus::stalled);
   EXPECT_EQ(solver.judge(elsewhere, found, Vector2d::Constant(0.9e-6)).status,
             FrictionStatus::stalled);
   EXPECT_EQ(solver.judge(elsewhere, found, Vector2d::Constant(1.1e-6)).status,
             FrictionStatus::converged);
   ContactState loose = found;
   loose.q[k] *= 1 + 1e-6;
   EXPECT_EQ(solver.judge(elsewhere, loose, Vector2d::Constant(1.1e-6)).status,
             FrictionStatus::stalled);
}

} // namespace
