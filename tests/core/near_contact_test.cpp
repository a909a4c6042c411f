#include "contact_laws.hpp"
#include "same_state.hpp"

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>
#include <gtest/gtest.h>

// Nodes that are far from touching are left out of a march: what it comes to is that of all.

namespace
{

using namespace cattaneo;
using cattaneo_test::expect_same;
using cattaneo_test::LawChecker;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double friction = 0.3;

/// A rigid cylinder on an elastic half-plane, unlike it, so that pressure and slip are coupled:
/// nodes from -1 to 1, above which it is x²/2R, beginning at the lowest place.
struct Cylinder
{
   double lowest;
   MatrixXd S;
   VectorXd x, gap;

   explicit Cylinder(int nodes, double at = 0.07) : lowest(at)
   {
      std::vector<double> grid;
      for (int i = 0; i < nodes; i += 2) { grid.push_back(-1 + 2.0 * i / (nodes - 1)); }
      HalfPlane below;
      below.material = {1, 0.2, PlaneState::strain};
      below.depth = 20;
      const CondensedBody body = condense(below, straight_line(grid, 2));
      S = body.S;
      x.resize(nodes);
      for (Index i = 0; i < nodes; ++i) { x[i] = body.line.nodes[i].position[0]; }
      gap = (x.array() - lowest).square() / (2 * 0.1);
      gap.array() -= gap.minCoeff();
   }

   ReducedProblem problem(const MatrixXd &K, const MatrixXd &loads, Control control) const
   {
      const Index n = x.size();
      ReducedProblem all;
      all.gap = gap;
      all.friction = VectorXd::Constant(n, friction);
      all.set_stiffness(K.topLeftCorner(n, n), K.bottomLeftCorner(n, n),
                        K.bottomRightCorner(n, n));
      for (Index k = 0; k < loads.cols(); ++k)
      {
         all.patterns.push_back(
            {k ? "Q" : "P", control, loads.col(k).head(n), loads.col(k).tail(n)});
      }
      return all;
   }

   /// Moved down and along.
   ReducedProblem moved() const
   {
      const Index n = x.size();
      MatrixXd way = MatrixXd::Zero(2 * n, 2);
      way.col(0).tail(n).setConstant(2.8);
      way.col(1).head(n).setOnes();
      return problem(S, S * way, Control::displacement);
   }

   /// Free to move and turn under forces P and Q = f P, P above its lowest point.
   ReducedProblem pressed() const
   {
      const Index n = x.size();
      MatrixXd Z = MatrixXd::Zero(2 * n, 3);
      Z.col(0).head(n).setOnes();
      Z.col(1).tail(n).setOnes();
      Z.col(2).tail(n) = x;
      MatrixXd resultants(3, 2);
      resultants << 0, friction, 1, 0, lowest, 0;
      const MatrixXd SZ = S * Z, flexibility = (Z.transpose() * SZ).inverse();
      MatrixXd K = S - SZ * flexibility * SZ.transpose();
      K = (0.5 * (K + K.transpose())).eval();
      return problem(K, SZ * flexibility * resultants, Control::force);
   }
};

/// Pressed on, then to and fro.
LoadHistory to_and_fro(double amplitude)
{
   return LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, amplitude),
                                Vector2d(1, -amplitude), Vector2d(0.4, 0.2 * amplitude)});
}

MarchSettings settings_of(Stepping stepping)
{
   MarchSettings settings;
   settings.stepping = stepping;
   settings.increments = 10;
   settings.every_event = true;
   return settings;
}

/// FrictionSolver::solve() knows nothing but the whole problem.
ContactState by_whole_increments(const ReducedProblem &problem, const LoadHistory &history,
                                 int increments)
{
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   for (int k = 0; k < history.pieces(); ++k)
   {
      const LoadPiece piece = history.piece(k);
      for (int step = 1; step <= increments; ++step)
      {
         const double share = static_cast<double>(step) / increments;
         EXPECT_EQ(solver.solve(state, piece.at(share)).status, FrictionStatus::converged);
      }
   }
   return state;
}

void expect_equal(const ContactState &a, const ContactState &b)
{
   // Both meet the equations to 1e-12 of the largest force; what differs in displacements is
   // that over a stiffness which the softest motions of the nodes do not have: a thousandth of
   // the largest entry.
   const double forces = 1e-11 * b.p.maxCoeff(), ways = 1e-9 * b.w.cwiseAbs().maxCoeff();
   EXPECT_LE((a.p - b.p).cwiseAbs().maxCoeff(), forces);
   EXPECT_LE((a.q - b.q).cwiseAbs().maxCoeff(), forces);
   EXPECT_LE((a.w - b.w).cwiseAbs().maxCoeff(), ways);
   EXPECT_LE((a.v - b.v).cwiseAbs().maxCoeff(), ways);
   EXPECT_EQ(a.status, b.status);
}

TEST(NearContact, IncrementsAreThoseOfAllNodes)
{
   const Cylinder cylinder(401);
   for (const bool free : {false, true})
   {
      const ReducedProblem problem = free ? cylinder.pressed() : cylinder.moved();
      const LoadHistory history = to_and_fro(free ? 0.7 : 0.4);
      const MarchSettings settings = settings_of(Stepping::fixed);
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, history, state, settings);
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_GE(report.counters.near_contacts, 2) << free;
      const auto open =
         std::count(state.status.begin(), state.status.end(), NodeState::separation);
      EXPECT_GT(open, 100);
      expect_equal(state, by_whole_increments(problem, history, settings.increments));
   }
}

TEST(NearContact, ExactPathObeysTheLawsAndNamesTheNodes)
{
   const Cylinder cylinder(301);
   for (const bool free : {false, true})
   {
      const ReducedProblem problem = free ? cylinder.pressed() : cylinder.moved();
      ContactState state = ContactState::virgin(problem), before = state;
      LawChecker laws(problem, state);
      double worst = 0;
      int events = 0;
      const auto observe = [&](const ContactState &now, const IncrementRecord &increment)
      {
         worst = std::max(worst, laws.violation(before.v, now));
         if (const Index i = increment.event; i >= 0)
         {
            // It has come to a boundary of its state, in forces.
            const double bound = friction * now.p[i],
                         off = closed(before.status[i])
                                  ? std::min(now.p[i], bound - std::abs(now.q[i]))
                                  : problem.C()(i, i) * (now.w[i] + problem.gap[i]);
            EXPECT_LE(std::abs(off), 1e-9 * now.peak_force) << i;
            ++events;
         }
         before = now;
      };
      const MarchReport report = march(problem, to_and_fro(free ? 0.7 : 0.4), state,
                                       settings_of(Stepping::exact), observe);
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_GE(report.counters.near_contacts, 2);
      EXPECT_LE(worst, 1) << free;
      EXPECT_GT(events, 100);
      // The changes lead from the first state to the last.
      if (report.fallbacks > 0) { continue; }
      std::vector<NodeState> status = ContactState::virgin(problem).status;
      for (const StateChange &change : report.changes)
      {
         EXPECT_EQ(change.multipliers.size(), 2);
         EXPECT_EQ(status[change.node], change.from);
         status[change.node] = change.to;
      }
      EXPECT_EQ(status, state.status);
   }
}

TEST(NearContact, NodesThatTouchTogetherAreMetByTheExactPath)
{
   // One node alone bears at first, about which the loads do not turn the cylinder; then two at
   // a time come to touch, which hold it so softly that round-off decides which is first.
   for (const int nodes : {41, 301})
   {
      const ReducedProblem problem = Cylinder(nodes, 0).pressed();
      ContactState state = ContactState::virgin(problem), before = state;
      LawChecker laws(problem, state);
      double worst = 0;
      const auto observe = [&](const ContactState &now, const IncrementRecord &)
      {
         worst = std::max(worst, laws.violation(before.v, now));
         before = now;
      };
      const LoadHistory history =
         LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.9)});
      const MarchReport report =
         march(problem, history, state, settings_of(Stepping::exact), observe);
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_EQ(report.fallbacks, 0) << nodes << ": " << report.fallback_reason;
      EXPECT_LE(worst, 1) << nodes << ": " << laws.what();
      EXPECT_GT(std::count_if(state.status.begin(), state.status.end(), closed), 0.1 * nodes);
   }
}

TEST(NearContact, MarchIsTakenUpToTheLastBit)
{
   const ReducedProblem problem = Cylinder(301).pressed();
   const LoadHistory history = to_and_fro(0.7);
   {
      const Stepping stepping = Stepping::fixed;
      std::vector<ContactState> states;
      const auto keep = [&](const ContactState &state, const IncrementRecord &increment)
      {
         if (increment.resumes) { states.push_back(state); }
      };
      ContactState end = ContactState::virgin(problem);
      march(problem, history, end, settings_of(stepping), keep);
      ASSERT_GT(states.size(), 20u);
      for (const std::size_t k : {std::size_t(3), states.size() / 2, states.size() - 4})
      {
         ContactState state = states[k];
         march(problem, history, state, settings_of(stepping));
         expect_same(state, end);
      }
   }
}

TEST(NearContact, IsNotMadeWhereItDoesNotPay)
{
   // Few nodes, no friction, and contact everywhere.
   const Cylinder few(101), many(301);
   ReducedProblem smooth = many.moved(), flat = many.moved();
   set_friction(smooth, 0);
   flat.gap.setZero();
   for (const ReducedProblem &problem : {few.moved(), smooth, flat})
   {
      ContactState state = ContactState::virgin(problem);
      const MarchReport report =
         march(problem, to_and_fro(0.4), state, settings_of(Stepping::fixed));
      EXPECT_EQ(report.status, FrictionStatus::converged);
      EXPECT_EQ(report.counters.near_contacts, 0);
   }
}

TEST(NearContact, WhatIsFarAndBearsTakesPart)
{
   // An initial slip far from the contact loads it, until nodes there are let go by the first
   // increment.
   const ReducedProblem problem = Cylinder(301).moved();
   VectorXd slip = VectorXd::Zero(problem.slips());
   slip.head(40).setConstant(0.01);
   ContactState state = ContactState::with_slip(problem, slip), start = state;
   LawChecker laws(problem, start);
   FrictionSolver solver(problem);
   ContactState whole = start;
   ASSERT_EQ(solver.solve(whole, Vector2d(0.1, 0)).status, FrictionStatus::converged);
   const LoadHistory history = LoadHistory::through({Vector2d(0, 0), Vector2d(0.1, 0)});
   MarchSettings settings = settings_of(Stepping::fixed);
   settings.increments = 1;
   const MarchReport report = march(problem, history, state, settings);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   EXPECT_LE(laws.violation(start.v, state), 1) << laws.what();
   expect_equal(state, whole);
}

} // namespace
