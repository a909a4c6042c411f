// Torsion of two equal spheres (Lubkin 1951): a contact of Hertz' pressure in which an annulus
// slips circumferentially. The reduced problem is made here from the half-space's kernel.

#include "common/twisted_bodies.hpp"
#include "comparison.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <record.hpp>

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Complete elliptic integrals of the parameter m = k².
double K(double m)
{
   return std::comp_ellint_1(std::sqrt(m));
}
double E(double m)
{
   return std::comp_ellint_2(std::sqrt(m));
}

/// ∫ (s² J2(ks)/k) (r² J2(kr)/k) dk over k from 0 to ∞ (Weber–Schafheitlin), symmetric.
double kernel(double r, double s)
{
   const double a = std::min(r, s), b = std::max(r, s);
   if (a == 0) { return 0; }
   const double m = a * a / (b * b);
   // a⁴ b/8 · F(-1/2, 3/2; 3; m), and F = (16/π) ∫ sin²cos² (1 - m sin²)^½ over a quarter turn.
   double integral = 0;
   if (m < 0.3)
   {
      double term = pi / 16;
      for (int k = 0; std::abs(term) > 1e-18; ++k)
      {
         integral += term;
         term *= (k - 0.5) * (k + 1.5) / ((k + 3.0) * (k + 1.0)) * m;
      }
   }
   else
   {
      const double first = m < 1 ? (1 - m) * (2 - m) * K(m) : 0.0;
      integral = (2 * (m * m - m + 1) * E(m) - first) / (15 * m * m);
   }
   return a * a * a * a * b * 2 / pi * integral;
}

/// Two half-spaces of shear modulus G = 1 that touch in r < 1, pressed by P = 1: n rings with a
/// shear traction proportional to r in each, slip averaged with the weight r².
struct Spheres
{
   ReducedProblem problem; ///< patterns press, torque, and a radial one that stays at zero
   VectorXd arm;           ///< torque of a unit force of each ring
   MatrixXd compliance;    ///< of the circumferential forces

   Spheres(int n, double friction)
   {
      VectorXd edge(n + 1);
      for (int i = 0; i <= n; ++i) { edge[i] = double(i) / n; }
      VectorXd square(n);
      arm.resize(n);
      problem.weights.resize(n);
      problem.chains = one_chain(n);
      problem.arc_length.resize(n);
      VectorXd pressure(n);
      auto outside = [](double r) { return std::pow(1 - r * r, 1.5); }; // of Hertz' force
      for (int i = 0; i < n; ++i)
      {
         const double a = edge[i], b = edge[i + 1];
         square[i] = (b * b * b - a * a * a) / 3;
         arm[i] = (b * b * b * b - a * a * a * a) / 4 / square[i];
         pressure[i] = outside(a) - outside(b);
         problem.weights[i] = pi * (b * b - a * a);
         problem.arc_length[i] = 0.5 * (a + b);
      }
      compliance.resize(n, n);
      for (int i = 0; i < n; ++i)
      {
         for (int j = 0; j < n; ++j)
         {
            const double sum = kernel(edge[i + 1], edge[j + 1]) - kernel(edge[i], edge[j + 1]) -
                               kernel(edge[i + 1], edge[j]) + kernel(edge[i], edge[j]);
            compliance(i, j) = 2 * sum / (2 * pi * square[i] * square[j]);
         }
      }
      MatrixXd A = compliance.llt().solve(MatrixXd::Identity(n, n));
      A = (0.5 * (A + A.transpose())).eval();
      // Under a torque the rotation is free: no stiffness against it.
      const VectorXd held = A * arm;
      const double stiffness = arm.dot(held);
      MatrixXd both = MatrixXd::Zero(2 * n, 2 * n);
      both.topLeftCorner(n, n) = A;
      both.bottomRightCorner(n, n) = A - held * held.transpose() / stiffness;
      // A as C: any would do, the pressure is given and no node opens.
      problem.set_stiffness(both, MatrixXd::Zero(n, 2 * n), A);
      problem.patterns = {{"press", Control::force, VectorXd::Zero(2 * n), pressure},
                          {"torque", Control::force, VectorXd::Zero(2 * n), VectorXd::Zero(n)}};
      problem.patterns[1].q.tail(n) = -held / stiffness;
      problem.H = Eigen::Matrix2d::Zero();
      problem.gap = VectorXd::Zero(n);
      set_friction(problem, friction);
   }

   /// Relative rotation of the bodies far away.
   double rotation(const ContactState &state) const
   {
      // Least squares: v = Φ arm + D q ring by ring.
      const Index n = problem.nodes();
      const VectorXd rigid = state.v.tail(n) - compliance * state.q.tail(n);
      return rigid.dot(arm) / arm.squaredNorm();
   }
};

/// Lubkin's solution for P = G = a = 1 with the stick radius c.
double lubkin_rotation(double f, double c)
{
   const double m = 1 - c * c;
   return 3 * f * (K(m) - E(m)) / (2 * pi);
}

double lubkin_torque(double f, double c)
{
   // (4 f/π) ∫ s² E(1 - s²) ds from c to 1, by Simpson's rule.
   const int steps = 2000;
   double sum = 0;
   for (int k = 0; k <= steps; ++k)
   {
      const double s = c + (1 - c) * k / steps;
      sum += (k == 0 || k == steps ? 1 : 2 + 2 * (k % 2)) * s * s * E(1 - s * s);
   }
   return 4 * f / pi * sum * (1 - c) / steps / 3;
}

TEST(Lubkin, StickRadiusAndRotationConverge)
{
   const double f = 0.3;
   double last_rotation = 0;
   for (int n : {50, 100, 200})
   {
      const Spheres spheres(n, f);
      FrictionSolver solver(spheres.problem);
      double worst_rotation = 0, worst_stick = 0;
      for (double c : {0.9, 0.7, 0.5, 0.3})
      {
         const double torque = lubkin_torque(f, c);
         ContactState state = ContactState::virgin(spheres.problem);
         const MarchReport report = march(
            solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, torque)}),
            state);
         ASSERT_EQ(report.status, FrictionStatus::converged);
         EXPECT_NEAR(-spheres.arm.dot(state.q.tail(n)), torque, 1e-12);
         EXPECT_TRUE(state.v.head(n).isZero(0));
         const double exact = lubkin_rotation(f, c);
         worst_rotation =
            std::max(worst_rotation, std::abs(spheres.rotation(state) / exact - 1));
         const Zone stick = widest_zone(zones(spheres.problem, state), NodeState::stick);
         worst_stick = std::max(worst_stick, std::abs(stick.to.position - c));
         EXPECT_LT(report.counters.newton_steps, 5 * 21); // in 21 increments
      }
      std::printf("%d rings: rotation %.2e, stick radius %.2e\n", n, worst_rotation,
                  worst_stick);
      EXPECT_LT(worst_stick, 0.1 / n); // in spacings, as zones() says of slip fronts
      if (n == 200) { cattaneo_test::record("stick_error", worst_stick); }
      if (last_rotation > 0) { EXPECT_NEAR(last_rotation / worst_rotation, 4, 0.3); }
      last_rotation = worst_rotation;
   }
   EXPECT_LT(last_rotation, 2e-4); // second order in the spacing
   cattaneo_test::record("rotation_error", last_rotation);
}

TEST(Lubkin, TorqueCycleFollowsMasing)
{
   // Every reversal starts a Lubkin solution of twice the friction: the branches of a cycle are
   // the first loading doubled, and the loss is 8 ∫ T dΦ - 4 T Φ of the first loading.
   const double f = 0.3, c = 0.4;
   const double torque = lubkin_torque(f, c), rotation = lubkin_rotation(f, c);
   double area = 0;
   const int pieces = 400;
   for (int k = 0; k < pieces; ++k)
   {
      const double c0 = 1 + (c - 1) * k / pieces, c1 = 1 + (c - 1) * (k + 1.0) / pieces;
      area += 0.5 * (lubkin_torque(f, c0) + lubkin_torque(f, c1)) *
              (lubkin_rotation(f, c1) - lubkin_rotation(f, c0));
   }
   const double loss = 8 * area - 4 * torque * rotation;
   const Spheres spheres(100, f);
   LoadHistory history =
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, torque),
                            Vector2d(1, -torque), Vector2d(1, torque)});
   history.cycle_start = 2;
   history.cycles = 5;
   MarchSettings settings;
   settings.increments = 80;
   ContactState state = ContactState::virgin(spheres.problem);
   double half = 0; // rotation at half the torque on the way down
   const MarchReport report = march(spheres.problem, history, state, settings,
                                    [&](const ContactState &now, const IncrementRecord &record)
                                    {
                                       if (record.cycle == 1 && now.time == 2.25)
                                       {
                                          half = spheres.rotation(now);
                                       }
                                    });
   ASSERT_EQ(report.status, FrictionStatus::converged);
   EXPECT_EQ(report.steady_cycle, 1); // already the first cycle is the steady one
   EXPECT_NEAR(report.cycles[0].dissipation, loss, 0.005 * loss); // 80 steps, 100 rings
   cattaneo_test::record("loss", report.cycles[0].dissipation / loss);
   EXPECT_LT(std::abs(report.energy_imbalance), 1e-3); // what 80 steps miss of the work
   // Half way down (T = 0.5 T_max) the reversal has gone through a quarter of its range.
   double low = c, high = 1;
   for (int k = 0; k < 60; ++k)
   {
      const double middle = 0.5 * (low + high);
      (lubkin_torque(f, middle) > 0.25 * torque ? low : high) = middle;
   }
   const double expected = rotation - 2 * lubkin_rotation(f, low);
   EXPECT_NEAR(half, expected, 1e-3 * rotation);
}

TEST(Lubkin, SpinsAtThreeSixteenthsOfPi)
{
   const double f = 0.3;
   const Spheres spheres(100, f);
   const double limit = f * spheres.arm.dot(spheres.problem.patterns[0].p);
   EXPECT_NEAR(limit, 3 * pi / 16 * f, 1e-4 * limit); // T_s of Hertz' pressure
   cattaneo_test::record("spinning_torque", limit / (3 * pi / 16 * f));
   ContactState state = ContactState::virgin(spheres.problem);
   const MarchReport report = march(
      spheres.problem,
      LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 2 * limit)}), state);
   EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
   EXPECT_NE(report.message.find("spins"), std::string::npos) << report.message;
   EXPECT_NEAR(report.event_multipliers[1], limit, 1e-8 * limit);

   // A prescribed rotation goes on: the torque stays at its limit.
   ReducedProblem turned = spheres.problem;
   const Index n = turned.nodes();
   turned.A().bottomRightCorner(n, n) = turned.A().topLeftCorner(n, n);
   complete(turned);
   turned.patterns[1] = {"rotation", Control::displacement, VectorXd::Zero(2 * n),
                         VectorXd::Zero(n)};
   turned.patterns[1].q.tail(n) = -turned.A().topLeftCorner(n, n) * spheres.arm;
   turned.H(1, 1) = -spheres.arm.dot(turned.patterns[1].q.tail(n));
   state = ContactState::virgin(turned);
   const MarchReport going =
      march(turned, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 10 * f)}),
            state);
   EXPECT_EQ(going.status, FrictionStatus::converged);
   EXPECT_NEAR(-spheres.arm.dot(state.q.tail(n)), limit, 1e-12);
   EXPECT_EQ(going.increments.back().slip, n);
   EXPECT_LT(std::abs(going.energy_imbalance), 0.02); // what 20 steps miss of the work
}

/// The same by finite elements: two bodies that meet in r < 1 with a gap r²/(2 R), pressed to a
/// contact of radius 0.7 and turned against each other at their far ends.
TEST(Lubkin, FiniteElements)
{
   const double f = 0.3, a = 0.7, h = 1.0 / 32;
   miniapp::TwistedBodies bodies;
   for (int i = 0; i <= 32; ++i) { bodies.contact.push_back(i * h); }
   const double sphere = bodies.sphere, poisson = bodies.poisson;
   miniapp::Scene scene = miniapp::make_scene(bodies);
   ReducedProblem &problem = scene.reduction.problem;
   const Index n = problem.nodes();
   const VectorXd radius = problem.position.col(0);
   set_friction(problem, f);
   FrictionSolver solver(problem);
   const double approach = a * a / sphere, G = 0.5 / (1 + poisson);
   ContactState pressed = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(pressed, Vector2d(approach, 0)).status, FrictionStatus::converged);
   const double load = pressed.p.sum();
   EXPECT_NEAR(load, 4.0 / 3 * 0.5 / (1 - poisson * poisson) * a * a * a / sphere, 4e-4 * load);
   EXPECT_LT(pressed.q.cwiseAbs().maxCoeff(), 1e-9 * load); // equal bodies: B = 0
   for (double c : {0.9, 0.7, 0.5, 0.3})
   {
      ContactState state = pressed;
      const double rotation = f * load / (G * a * a) * lubkin_rotation(1, c);
      ASSERT_EQ(solver.solve(state, Vector2d(approach, rotation)).status,
                FrictionStatus::converged);
      const double torque = -radius.dot(state.q.tail(n)) / (load * a);
      const Zone stick = widest_zone(zones(problem, state), NodeState::stick);
      const double found = (radius[0] + stick.to.position - problem.arc_length[0]) / a;
      std::printf("c = %.1f: stick radius %+.2e, torque %+.2e\n", c, found - c,
                  torque / lubkin_torque(f, c) - 1);
      // Edges are right to a tenth of the spacing, and the torque to as much of the radius.
      const double read_out = 0.1 * 0.5 * h / a;
      EXPECT_NEAR(found, c, read_out);
      EXPECT_NEAR(torque, lubkin_torque(f, c), read_out * torque);
      EXPECT_LT((state.p - pressed.p).cwiseAbs().maxCoeff(), 1e-9 * load); // d stays
   }
}

} // namespace
