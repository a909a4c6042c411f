#include "run_miniapp.hpp"

#include "common/lap_joint_scene.hpp"

#include <cattaneo/friction/friction_solver.hpp>
#include <cmath>

namespace
{

using namespace cattaneo;
using cattaneo_test::run_miniapp;

TEST(LapJoint, WorkErrorFallsWithTheIncrements)
{
   double error = 1;
   for (const char *increments : {"10", "30", "90"})
   {
      const auto run = run_miniapp(
         "lap_joint", std::string("-spacing 0.02 -stepping fixed -increments ") + increments);
      ASSERT_EQ(run.code, 0) << run.output;
      const double signed_error = run.results["work_error"].get<double>();
      const auto &last = run.results["cycles"].back();
      const double work = last["external_work"].get<double>(),
                   loss = last["dissipation"].get<double>();
      EXPECT_NEAR(signed_error, work / loss - 1, 1e-9) << "its sign is that of the table";
      const double now = std::abs(signed_error);
      EXPECT_LT(now, 0.5 * error) << increments; // a third, at first order
      error = now;
   }
}

/// By the closed sweep of --touch: beyond that compression the ends press, before it they do
/// not.
TEST(LapJoint, ItIsSaidWhereFreeEndsTouch)
{
   const std::string narrow = "-width 0.5 -friction 0.5 -spacing 0.05 -increments 10 ";
   const auto found = run_miniapp("lap_joint", narrow + "-load -0.02 -touch");
   ASSERT_EQ(found.code, 0) << found.output;
   const double touch = found.results["touch_load"].get<double>();
   ASSERT_LT(touch, -0.03);
   const auto load = [](double T) { return "-load " + std::to_string(T); };
   const auto sweep = [](double T) { return " -load 0.01 -sweep-load " + std::to_string(T); };
   for (const double share : {0.8, 1.2})
   {
      for (const std::string &way : {load(share * touch), sweep(share * touch)})
      {
         const auto run = run_miniapp("lap_joint", narrow + way);
         ASSERT_EQ(run.code, 0) << run.output;
         EXPECT_EQ(run.output.find("free end of the laps touches") != std::string::npos,
                   share > 1)
            << run.output;
      }
   }
}

TEST(LapJoint, EdgesOfTheRecedingContactHaveIntensities)
{
   const auto small = run_miniapp("lap_joint", "-load 0.01 -increments 20");
   const auto large = run_miniapp("lap_joint", "-load 0.02 -increments 20");
   const auto coarse = run_miniapp("lap_joint", "-load 0.02 -increments 20 -spacing 0.01");
   for (const auto &run : {small, large, coarse})
   {
      ASSERT_EQ(run.code, 0) << run.output;
      ASSERT_EQ(run.results["edges"].size(), 2u) << run.output;
   }
   for (int e = 0; e < 2; ++e)
   {
      const auto &edge = large.results["edges"][e], &other = coarse.results["edges"][e];
      EXPECT_FALSE(edge["complete"].get<bool>());
      const double k_n = edge["k_n"]["value"], k_t = edge["k_t"]["value"];
      // The tractions at a spacing of 1/1600, divided by √(a² - x²) and expanded in even powers
      // of x up to x¹⁰ to x¹⁸, have K_N = 0.9218 ± 0.0008; K_T of spacings of 1/800 and 1/1600
      // is 0.01097 and 0.01098.
      for (const auto *run : {&edge, &other})
      {
         const auto &normal = (*run)["k_n"], &tangential = (*run)["k_t"];
         const double n = normal["value"], t = tangential["value"];
         EXPECT_NEAR(n, 0.9218, normal["relative_error_estimate"].get<double>() * n);
         EXPECT_NEAR(std::abs(t), 0.01098,
                     tangential["relative_error_estimate"].get<double>() * std::abs(t));
      }
      // The error of the edge's position, a quarter of a spacing, is half of these.
      EXPECT_LT(edge["k_n"]["relative_error_estimate"].get<double>(), 0.04);
      EXPECT_LT(edge["k_t"]["relative_error_estimate"].get<double>(), 0.04);
      // Half the spacing, half the error at most.
      EXPECT_LT(edge["k_t"]["relative_error_estimate"].get<double>(),
                0.5 * other["k_t"]["relative_error_estimate"].get<double>());
      EXPECT_NEAR(k_n, 0.9218, 0.005 * k_n);
      EXPECT_NEAR(std::abs(k_t), 0.01098, 0.01 * std::abs(k_t));
      EXPECT_NEAR(other["k_n"]["value"].get<double>(), k_n, 0.02 * k_n);
      EXPECT_NEAR(other["k_t"]["value"].get<double>(), k_t, 0.03 * std::abs(k_t));
      // The upper lap drags the lower one to the left: into the contact at the right edge.
      EXPECT_GT(k_t * (e == 0 ? -1 : 1), 0);
      // The stuck shear is linear in the load, but for the edge that recedes.
      const double half = small.results["edges"][e]["k_t"]["value"];
      EXPECT_NEAR(k_t, 2 * half, 0.05 * std::abs(k_t));
      // The receding edge leaves a part of the slip zone behind: the prediction, for constant
      // K_N, is too long, and the program says so.
      const double predicted = edge["slip_zone_predicted"], d = edge["slip_zone"];
      EXPECT_NEAR(predicted, 2 * std::abs(k_t) / (0.2 * k_n), 1e-12 * d);
      EXPECT_GT(predicted, d);
      EXPECT_LT(predicted, 1.4 * d);
      ASSERT_FALSE(edge["notes"].empty());
      EXPECT_NE(edge["notes"][0].get<std::string>().find("edge moves"), std::string::npos);
   }
   // Both edges together lose what the cycle loses, and are alike.
   const auto &left = large.results["edges"][0], &right = large.results["edges"][1];
   EXPECT_NEAR(left["energy"].get<double>() + right["energy"].get<double>(),
               large.results["dissipation_steady"].get<double>(),
               1e-9 * left["energy"].get<double>());
   EXPECT_NEAR(left["k_n"]["value"].get<double>(), right["k_n"]["value"].get<double>(), 1e-5);
}

/// One cycle alone can be no steady one: its figures have another name than those that are.
TEST(LapJoint, OnlyWhatIsSteadyIsCalledSo)
{
   for (const bool steady : {false, true})
   {
      const auto run =
         run_miniapp("lap_joint", "--spacing 0.05 --cycles " + std::string(steady ? "5" : "1"));
      ASSERT_EQ(run.code, 0) << run.output;
      EXPECT_EQ(run.results["steady_cycle"] > 0, steady) << run.output;
      for (const std::string name : {"c", "dissipation"})
      {
         EXPECT_EQ(run.results.contains(name + "_steady"), steady);
         EXPECT_EQ(run.results.contains(name + "_last"), !steady);
      }
   }
}

TEST(LapJoint, ContactIsUncoupledWhereItTouches)
{
   miniapp::LapJointOptions options;
   options.spacing = 0.025;
   miniapp::Scene joint = miniapp::make_lap_joint(options);
   ReducedProblem &problem = joint.reduction.problem;
   set_friction(problem, 0.2);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(1, 0)).status, FrictionStatus::converged);
   // The S shape of the overlap couples slip and opening at its free ends. With the separated
   // nodes released, what is left between the nodes in contact couples no more.
   const Eigen::Index n = problem.nodes();
   std::vector<Eigen::Index> in, free;
   for (int half = 0; half < 2; ++half)
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         (closed(state.status[i]) ? in : free).push_back(half * n + i);
      }
   }
   const Eigen::MatrixXd K = problem.K;
   const Eigen::MatrixXd S = K(in, in) - K(in, free) * K(free, free).ldlt().solve(K(free, in));
   const Eigen::Index m = S.rows() / 2;
   EXPECT_LT(S.bottomLeftCorner(m, m).cwiseAbs().maxCoeff(), 1e-7 * S.cwiseAbs().maxCoeff());
   EXPECT_LT(state.q.cwiseAbs().maxCoeff(), 1e-7 * state.p.maxCoeff());
}

TEST(LapJoint, ZonesDoNotDependOnTheLoadLevelOrPoissonsRatio)
{
   miniapp::LapJointOptions options;
   options.spacing = 0.025;
   miniapp::Scene joint = miniapp::make_lap_joint(options);
   set_friction(joint.reduction.problem, 0.2);
   FrictionSolver solver(joint.reduction.problem);
   ContactState low = ContactState::virgin(joint.reduction.problem), high = low;
   ASSERT_EQ(solver.solve(low, Eigen::Vector2d(1e-6, 0)).status, FrictionStatus::converged);
   ASSERT_EQ(solver.solve(high, Eigen::Vector2d(1e6, 0)).status, FrictionStatus::converged);
   EXPECT_EQ(low.status, high.status);
   EXPECT_LT((1e12 * low.p - high.p).cwiseAbs().maxCoeff(), 1e-9 * high.p.maxCoeff());
   const auto a = run_miniapp("lap_joint", "-spacing 0.0125 -poisson 0");
   const auto b = run_miniapp("lap_joint", "-spacing 0.0125 -poisson 0.4");
   ASSERT_EQ(a.code + b.code, 0) << a.output << b.output;
   for (const char *key : {"a0", "a", "c_first", "c_steady"})
   {
      EXPECT_NEAR(a.results[key].get<double>(), b.results[key].get<double>(), 1e-3) << key;
   }
}

/// A pull above f P0 is no row of zeros: what the march did not come to is not known.
TEST(LapJoint, SweepKnowsNothingOfWhatSlidAway)
{
   const auto run =
      run_miniapp("lap_joint", "-spacing 0.05 -increments 5 -sweep-load '0.05 0.3' "
                               "-sweep-friction 0.2");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &held = run.results["sweep"][0], &slid = run.results["sweep"][1];
   EXPECT_EQ(slid["status"], "gross sliding");
   EXPECT_EQ(slid["a0"], held["a0"]); // both were pinched alike
   EXPECT_GT(slid["a0"], 0.5);
   for (const char *key :
        {"a", "c_first", "c_steady", "dissipation_first", "dissipation_steady", "steady_cycle"})
   {
      EXPECT_TRUE(slid[key].is_null()) << key;
      EXPECT_GT(held[key], 0) << key;
   }
}

/// Equal laps that nothing pulls are sheared nowhere: what is left of it is round-off, and
/// shown as none.
TEST(LapJoint, WhatNothingPullsHasNoShear)
{
   const auto run = run_miniapp("lap_joint", "-load 0 -spacing 0.025");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_LT(run.results["asymmetry"].get<double>(), 1e-7); // of p
   EXPECT_EQ(run.results["residual_shear"], 0);
   ASSERT_EQ(run.results["edges"].size(), 2u);
   for (const auto &edge : run.results["edges"])
   {
      EXPECT_EQ(edge["k_t"]["value"], 0) << edge;
      EXPECT_EQ(edge["slip_zone_predicted"], 0) << edge;
   }
}

TEST(LapJoint, DissipationFallsWithFrictionAndRisesWithLoad)
{
   const auto run = run_miniapp(
      "lap_joint", "-sweep-load '0.02 0.04' -sweep-friction '0.2 0.4 0.8' -spacing 0.00625");
   ASSERT_EQ(run.code, 0) << run.output;
   const auto &sweep = run.results["sweep"];
   ASSERT_EQ(sweep.size(), 6u);
   auto loss = [&](int friction, int load)
   { return sweep[2 * friction + load]["dissipation_steady"].get<double>(); };
   // The notes: 1.938e-4 at f = 0.2, T = 0.04, ±0.3 %, with 20 increments 0.2 % and the mesh
   // less; and about T^2.9, two digits of an exponent that a mesh of few slipping nodes shifts.
   EXPECT_NEAR(loss(0, 1), 1.938e-4, 0.006 * 1.938e-4);
   for (int k = 0; k < 3; ++k)
   {
      EXPECT_NEAR(std::log2(loss(k, 1) / loss(k, 0)), 2.9, 0.15) << k;
   }
   // A slip zone that stays near its edge loses ΔK_T³/(f K_N): half at twice the friction. The
   // edge recedes by more than short zones are long, which costs them more; a zone wider than
   // near the edge loses 5 % less of the difference.
   for (int k = 0; k < 2; ++k)
   {
      EXPECT_GT(loss(k, 1) / loss(k + 1, 1), 1.9) << k;
      EXPECT_LT(loss(k, 1) / loss(k + 1, 1), 4.0) << k;
   }
   EXPECT_EQ(run.results["counters"]["factorisations"], 1);
}

TEST(LapJoint, OrderOfTighteningMattersOnlyForUnequalLaps)
{
   const std::string options =
      "-bolts '-1.2 0 1.2' -friction 0.2 -load 0.1 -spacing 0.025 -increments 20";
   const auto equal = run_miniapp("lap_joint", options);
   ASSERT_EQ(equal.code, 0) << equal.output;
   const auto &same = equal.results["tightening"];
   ASSERT_EQ(same.size(), 2u);
   const auto unequal = run_miniapp("lap_joint", options + " -lower-thickness 2");
   ASSERT_EQ(unequal.code, 0) << unequal.output;
   const auto &other = unequal.results["tightening"];
   ASSERT_EQ(other.size(), 2u);
   for (int k = 0; k < 2; ++k)
   {
      EXPECT_LT(same[k]["residual_shear"].get<double>(), 1e-3);
      EXPECT_GT(other[k]["residual_shear"].get<double>(), 1e-2);
   }
   EXPECT_EQ(unequal.results["counters"]["factorisations"], 2);
}

} // namespace
