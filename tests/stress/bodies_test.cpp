// Whole chain, from mesh to march, at extremes of stiffness, size, friction, Poisson's ratio,
// gap, shape of elements and number of nodes. Every increment is verified.

#include "outcomes.hpp"
#include "punch_problem.hpp"
#include "two_blocks.hpp"

#include <cattaneo/friction/friction_solver.hpp>
#include <gtest/gtest.h>
#include <sstream>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Vector2d;

/// Pressed, sheared to and fro at `share` of the sliding limit, half unloaded.
LoadHistory to_and_fro(double friction, double share = 0.7)
{
   const double q = share * friction;
   return LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, q), Vector2d(1, -q),
                                Vector2d(0.5, 0.4 * q), Vector2d(1, 0)});
}

template <class... Words>
std::string text(const Words &...words)
{
   std::ostringstream out;
   (out << ... << words);
   return out.str();
}

/// Both ways of stepping.
void run(const std::string &family, const std::string &name, const ReducedProblem &problem,
         const LoadHistory &history)
{
   for (Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      MarchSettings settings;
      settings.stepping = stepping;
      settings.increments = stepping == Stepping::fixed ? 2 : 6;
      ContactState state = ContactState::virgin(problem);
      const Verdict verdict = march_and_verify(problem, history, state, settings);
      record(family, text(name, ", stepping ", static_cast<int>(stepping)), verdict);
   }
}

TEST(Bodies, StiffnessContrast)
{
   const std::string family = "bodies, stiffness contrast 1e-8 to 1e8";
   for (double contrast : {1e-8, 1e-4, 0.1, 1.0, 10.0, 1e4, 1e8})
   {
      for (double friction : {0.0, 0.3, 1.0})
      {
         TwoBlocks scene;
         scene.contrast = contrast;
         run(family, text("contrast ", contrast, ", f ", friction),
             reduce_two_blocks(scene, friction), to_and_fro(friction));
      }
   }
   EXPECT_EQ(count(family, Outcome::verified), 7 * 6);
}

TEST(Bodies, Size)
{
   const std::string family = "bodies, size 1e-9 to 1e9, modulus 1e-9 to 1e11";
   for (double size : {1e-9, 1e-3, 1.0, 1e9})
   {
      for (double young : {1e-9, 1.0, 1e11})
      {
         TwoBlocks scene;
         scene.size = size;
         scene.young = young;
         scene.contrast = 3;
         run(family, text("size ", size, ", E ", young), reduce_two_blocks(scene, 0.4),
             to_and_fro(0.4));
      }
   }
   EXPECT_EQ(count(family, Outcome::verified), 12 * 2);
}

TEST(Bodies, Friction)
{
   const std::string family = "bodies, friction 0 to 10";
   for (double friction : {0.0, 1e-12, 1e-6, 0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0})
   {
      for (double contrast : {0.2, 1.0, 50.0})
      {
         TwoBlocks scene;
         scene.contrast = contrast;
         run(family, text("f ", friction, ", contrast ", contrast),
             reduce_two_blocks(scene, friction), to_and_fro(friction));
      }
   }
   EXPECT_EQ(count(family, Outcome::stalled), 0);
   EXPECT_EQ(count(family, Outcome::gross_sliding), 0); // 70 % of the limit
}

TEST(Bodies, PoissonsRatio)
{
   const std::string family = "bodies, Poisson's ratio -0.9 to 0.4999";
   for (double poisson : {-0.9, 0.0, 0.3, 0.49, 0.4999})
   {
      for (int order : {1, 2, 3})
      {
         TwoBlocks scene;
         scene.poisson = poisson;
         scene.contrast = 4;
         scene.order = order;
         run(family, text("nu ", poisson, ", order ", order), reduce_two_blocks(scene, 0.5),
             to_and_fro(0.5));
      }
   }
   EXPECT_EQ(count(family, Outcome::verified), 15 * 2);
}

/// Way of the load P by its work, frictionless.
double compliance(double poisson, int order)
{
   TwoBlocks scene;
   scene.poisson = poisson;
   scene.order = order;
   const ReducedProblem problem = reduce_two_blocks(scene, 0.0);
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   EXPECT_EQ(solver.solve(state, Vector2d(1, 0)).status, FrictionStatus::converged);
   const LoadPattern &load = problem.patterns[0];
   return problem.H(0, 0) - load.q.dot(state.v) - load.p.dot(state.w);
}

/// Linear elements lock as the material becomes incompressible, quadratic ones do not: the
/// miniapps warn of it from 0.49 on.
TEST(Bodies, LinearElementsLock)
{
   std::string rows = "compliance of order 1 and 2 over that of order 4:";
   double linear = 1;
   for (double poisson : {0.3, 0.45, 0.49, 0.499, 0.4999})
   {
      const double exact = compliance(poisson, 4);
      const double quadratic = compliance(poisson, 2) / exact;
      const double before = linear;
      linear = compliance(poisson, 1) / exact;
      rows += text("  nu ", poisson, ": ", linear, ", ", quadratic);
      EXPECT_LT(linear, before);
      EXPECT_GT(quadratic, 0.97);
      EXPECT_LE(quadratic, 1 + 1e-9);
      if (poisson == 0.4999) { EXPECT_LT(linear, 0.8); }
   }
   remark(rows);
}

TEST(Bodies, Gap)
{
   const std::string family = "bodies, gap 1e-14 to 1 of the size";
   for (double gap : {1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0})
   {
      for (bool curved : {false, true})
      {
         for (double friction : {0.0, 0.4})
         {
            TwoBlocks scene;
            scene.contrast = 2;
            (curved ? scene.curved_gap : scene.gap) = gap;
            run(family, text(curved ? "parabolic " : "uniform ", gap, ", f ", friction),
                reduce_two_blocks(scene, friction), to_and_fro(friction));
         }
      }
   }
   EXPECT_EQ(count(family, Outcome::verified), 36 * 2);
}

/// A block under P, pushed at height h by (1 - balance) of Q, tips about its corner when
/// P L = (1 - balance) Q h, h = 2 L.
TEST(Bodies, Tipping)
{
   const std::string family = "bodies, tipping";
   for (double contrast : {0.02, 1.0, 50.0})
   {
      for (double tips_at : {0.6, 1.0, 3.0})
      {
         TwoBlocks scene;
         scene.contrast = contrast;
         scene.balance = 1 - 0.5 / tips_at;
         const ReducedProblem problem = reduce_two_blocks(scene, 1.2 * tips_at);
         for (Stepping stepping : {Stepping::fixed, Stepping::exact})
         {
            MarchSettings settings;
            settings.stepping = stepping;
            ContactState state = ContactState::virgin(problem);
            const Verdict verdict = march_and_verify(
               problem,
               LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 2 * tips_at)}),
               state, settings);
            record(family, text("contrast ", contrast, ", at ", tips_at), verdict);
            EXPECT_NEAR(verdict.report.event_multipliers[1], tips_at, 1e-8 * tips_at);
         }
      }
   }
   EXPECT_EQ(count(family, Outcome::stalled), 0);
}

TEST(Bodies, ShapeOfElements)
{
   const std::string family = "bodies, aspect ratio up to 1e5";
   for (double ratio : {1e2, 1e4, 1e5})
   {
      for (int order : {1, 2})
      {
         TwoBlocks scene;
         scene.order = order;
         scene.contrast = 2;
         scene.flat = ratio; // wide and low
         run(family, text("flat ", ratio, ", order ", order), reduce_two_blocks(scene, 0.4),
             to_and_fro(0.4));
         scene.flat = 0.25; // narrow and high, at the corners
         scene.intervals = 16;
         scene.end_ratio = 1 / ratio;
         run(family, text("high ", ratio, ", order ", order), reduce_two_blocks(scene, 0.4),
             to_and_fro(0.4));
      }
   }
   EXPECT_EQ(count(family, Outcome::verified), 12 * 2);
}

TEST(Bodies, NumberOfNodes)
{
   const std::string family = "punch, 3 to 1001 nodes (full: 4001)";
   const int most = extent() == Extent::full ? 4001 : extent() == Extent::usual ? 1001 : 129;
   for (bool half_plane : {false, true})
   {
      for (int nodes : {3, 5, 9, 33, 129, 401, 1001, 2001, 4001})
      {
         if (nodes > (half_plane ? most / 2 : most)) { break; }
         ReducedProblem problem = punch_problem(nodes, half_plane);
         set_friction(problem, 0.2);
         MarchSettings settings;
         settings.stepping = Stepping::fixed;
         settings.increments = 2;
         ContactState state = ContactState::virgin(problem);
         const LoadHistory history = LoadHistory::through(
            {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 0.12), Vector2d(1, -0.05)});
         record(family, text(nodes, " nodes, half-plane ", half_plane),
                march_and_verify(problem, history, state, settings));
      }
   }
   EXPECT_EQ(count(family, Outcome::stalled), 0);
}

} // namespace
