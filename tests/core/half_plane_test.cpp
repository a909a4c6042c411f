#include "half_planes.hpp"
#include "straight_line.hpp"

#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <record.hpp>

// Half-planes and half-spaces without a mesh, against closed solutions.

namespace
{

using namespace cattaneo;
using cattaneo_test::below;
using cattaneo_test::depth;
using cattaneo_test::even;
using cattaneo_test::half_plane;
using cattaneo_test::halving;
using cattaneo_test::halving_both_ways;
using cattaneo_test::uneven;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd solved(const MatrixXd &S, const VectorXd &f)
{
   return S.llt().solve(f);
}

/// Forces of a normal motion w if no shear acts on the contact.
VectorXd without_shear(const MatrixXd &S, const VectorXd &w)
{
   const Index n = w.size();
   const MatrixXd A = S.topLeftCorner(n, n), B = S.bottomLeftCorner(n, n);
   return S.bottomRightCorner(n, n) * w - B * solved(A, B.transpose() * w);
}

TEST(HalfPlane, UniformPressureOnAStrip)
{
   const double E = 3, nu = 0.2, length = 2;
   for (const bool strain : {true, false})
   {
      const Material material{E, nu, strain ? PlaneState::strain : PlaneState::stress};
      for (int order : {1, 2, 5, 8})
      {
         const CondensedBody body =
            condense(half_plane(E, nu, material.state), straight_line(uneven, order));
         const Index n = body.line.size();
         const VectorXd weights = body.line.each(&LineNode::weight);
         EXPECT_NEAR(weights.sum(), length, 1e-14);
         VectorXd f = VectorXd::Zero(2 * n);
         f.tail(n) = weights;
         const VectorXd u = solved(body.S, f);
         // Along the surface it is drawn to the middle: -(1-2ν)(1+ν)/2E p ((x - a) - (b - x))
         // in plane strain, -(1-ν)/2E in plane stress. The half-plane lies below: its frames
         // run against x.
         const double beta = (strain ? (1 - 2 * nu) * (1 + nu) : 1 - nu) / (2 * E);
         for (Index i = 0; i < n; ++i)
         {
            const double x = body.line.nodes[i].position[0];
            EXPECT_NEAR(u[i], beta * (2 * x - length), 1e-12) << order;
         }
         // ∫∫ ln|x-s| over the square of a length l: l² (ln l - 3/2).
         const double modulus = strain ? E / (1 - nu * nu) : E, scale = 2 / (M_PI * modulus);
         const double square = length * length;
         // A force P moves the surface by 2P/πE' ln D/x - (1+ν)P/πE from what is at the depth D
         // below it (Timoshenko and Goodier, art. 36, where 1/E stands for 1/E' and ν for
         // ν/(1-ν) in plane strain).
         const double below = (1 + nu) / (M_PI * E) / scale;
         const double work = scale * square * (std::log(depth / length) - below + 1.5);
         EXPECT_NEAR(f.dot(u), work, 1e-12 * work) << order;
         // A uniform shear along the surface: of opposite signs in front and behind.
         VectorXd shear = VectorXd::Zero(2 * n);
         shear.head(n) = weights;
         const VectorXd moved = solved(body.S, shear);
         const double along = scale * square * (std::log(depth / length) + below + 1.5);
         EXPECT_NEAR(shear.dot(moved), along, 1e-12 * along);
         for (Index i = 0; i < n; ++i)
         {
            const double x = body.line.nodes[i].position[0];
            EXPECT_NEAR(moved[n + i], -beta * (2 * x - length), 1e-12) << order;
         }
      }
   }
}

TEST(HalfPlane, RigidPunchesOnTheHalfPlane)
{
   const double E = 2, nu = 0.25, a = 1.5, modulus = E / (1 - nu * nu);
   const CondensedBody body =
      condense(half_plane(E, nu), straight_line(halving_both_ways(a, 24), 4));
   const Index n = body.line.size();
   VectorXd x(n);
   for (Index i = 0; i < n; ++i) { x[i] = -body.line.nodes[i].position[0]; } // its own frames
   const MatrixXd motions = body.rigid_motions();
   const auto S = [&](int i, int j) { return motions.col(i).dot(body.S * motions.col(j)); };
   // Elements of a 24th power of a half at the edges: what they miss of the energy.
   const double tolerance = 1e-6;

   // Frictionless (Johnson, 2.8): p = P/π√(a²-x²), and ∫ p ln|x-s| ds = P ln(a/2).
   const VectorXd pressed = without_shear(body.S, VectorXd::Ones(n));
   const double sinking = 2 / (M_PI * modulus) * (std::log(2 * depth / a) - 0.5 / (1 - nu));
   EXPECT_NEAR(pressed.sum() * sinking, 1, tolerance);
   EXPECT_NEAR(pressed.dot(x.cwiseAbs2()) / (pressed.sum() * a * a / 2), 1, tolerance);
   cattaneo_test::record("pressed", pressed.sum() * sinking);
   // Turned: M = π/4 E' a² φ.
   const VectorXd turned = without_shear(body.S, x);
   EXPECT_NEAR(turned.dot(x) / (M_PI / 4 * modulus * a * a), 1, tolerance);
   cattaneo_test::record("turned", turned.dot(x) / (M_PI / 4 * modulus * a * a));

   // Bonded, turned by a moment alone (Muskhelishvili's problem with Φ⁺ + κ Φ⁻ constant, κ =
   // 3-4ν): M = 2π G a² (1+4ε²)/(1+κ) φ, ε = ln κ/2π. Tractions oscillate at the edges.
   const double G = E / (2 * (1 + nu)), kappa = 3 - 4 * nu, e = std::log(kappa) / (2 * M_PI);
   const double moment = S(2, 2) - S(2, 0) * S(2, 0) / S(0, 0);
   EXPECT_NEAR(moment / (2 * M_PI * G * a * a * (1 + 4 * e * e) / (1 + kappa)), 1, tolerance);
   EXPECT_NEAR(S(0, 1) / S(0, 0), 0, 1e-12);
   EXPECT_NEAR(S(2, 1) / S(0, 0), 0, 1e-12);
}

TEST(HalfSpace, UniformPressureOnADisc)
{
   const double E = 3, nu = 0.2, a = 2;
   for (int order : {2, 3, 8})
   {
      const CondensedBody body =
         condense(half_plane(E, nu), straight_line(uneven, order, Formulation::axisymmetric));
      const Index n = body.line.size();
      const VectorXd weights = body.line.each(&LineNode::weight);
      EXPECT_NEAR(weights.sum(), M_PI * a * a, 1e-12);
      VectorXd f = VectorXd::Zero(2 * n);
      f.tail(n) = weights;
      const VectorXd u = solved(body.S, f);
      // The axis' share is zero from order 2 on. (Johnson, 3.30a: u_r = -(1-2ν)(1+ν) p r/2E;
      // below, frames run inwards. 3.29c: the mean of u_z is 16 (1-ν²) p a/3πE.)
      for (Index i = 0; i < n; ++i)
      {
         const double r = body.line.nodes[i].position[0];
         EXPECT_NEAR(u[i], (1 - 2 * nu) * (1 + nu) * r / (2 * E), 1e-12) << order;
      }
      const double mean = 16 * (1 - nu * nu) * a / (3 * M_PI * E);
      EXPECT_NEAR(f.dot(u) / (M_PI * a * a), mean, 1e-12) << order;
   }
}

TEST(HalfSpace, RigidPunchesOnTheHalfSpace)
{
   const double E = 2, nu = 0.25, a = 1.5, modulus = E / (1 - nu * nu), G = E / (2 * (1 + nu));
   const std::vector<double> grid = halving(0, a, 24);
   const double tolerance = 1e-6; // as in the plane
   const CondensedBody body =
      condense(half_plane(E, nu), straight_line(grid, 4, Formulation::axisymmetric));
   const Index n = body.line.size();
   const VectorXd w = VectorXd::Ones(n);
   const double smooth = without_shear(body.S, w).sum() / (2 * modulus * a);
   EXPECT_NEAR(smooth, 1, tolerance);
   cattaneo_test::record("smooth", smooth);
   // Bonded: Mossakovskii.
   const double bonded = (body.S.bottomRightCorner(n, n) * w).sum();
   EXPECT_NEAR(bonded / (4 * G * a * std::log(3 - 4 * nu) / (1 - 2 * nu)), 1, tolerance);
   cattaneo_test::record("bonded", bonded / (4 * G * a * std::log(3 - 4 * nu) / (1 - 2 * nu)));
   // Twisted: Reissner and Sagoci.
   const CondensedBody twisted =
      condense(half_plane(E, nu), straight_line(grid, 4, Formulation::torsion));
   const VectorXd r = twisted.line.each(&LineNode::position).col(0);
   EXPECT_NEAR(r.dot(twisted.S * r) / (16.0 / 3 * G * a * a * a), 1, tolerance);
   cattaneo_test::record("twisted", r.dot(twisted.S * r) / (16.0 / 3 * G * a * a * a));
}

TEST(HalfPlane, RecoversTheComponentsOfItsSurface)
{
   Eigen::Matrix2d quarter;
   quarter << 0, -1, 1, 0;
   for (const Eigen::Matrix2d &turn : {Eigen::Matrix2d(Eigen::Matrix2d::Identity()), quarter})
   {
      HalfPlane body = half_plane(2, 0.1);
      body.normal = turn * body.normal;
      body.symmetric = true;
      ContactLine other = straight_line({-3, -1, 0}, 2);
      for (LineNode &node : other.nodes)
      {
         node.position = turn * node.position;
         node.tangent = turn * node.tangent;
      }
      for (LineElement &element : other.chains[0].elements)
      {
         element.points = (turn * element.points).eval();
      }
      CondensedBody part = condense(body, other);
      const Index n = part.line.size();
      ASSERT_EQ(part.held, std::vector<int>{0});
      VectorXd u(2 * n);
      for (Index i = 0; i < 2 * n; ++i) { u[i] = 1 + 0.25 * static_cast<double>(i); }
      const VectorXd field = part.recover(u, VectorXd());
      ASSERT_EQ(field.size(), 2 * n);
      for (Index i = 0; i < n; ++i)
      {
         // On the plane of symmetry nothing moves along the surface, whatever is said.
         const LineNode &node = part.line.nodes[i];
         const Eigen::Vector2d expected =
            (i == 0 ? 0.0 : u[i]) * node.tangent + u[n + i] * node.normal();
         EXPECT_NEAR(field[i], expected[0], 1e-15) << i;
         EXPECT_NEAR(field[n + i], expected[1], 1e-15) << i;
      }
   }
}

TEST(HalfPlane, TurnedWithItsLine)
{
   const HalfPlane level = half_plane(2, 0.1);
   const ContactLine line = straight_line(uneven, 2);
   HalfPlane tilted = level;
   const Eigen::Rotation2Dd turn(2.1);
   tilted.normal = turn * level.normal;
   tilted.point = {3, -4};
   ContactLine other = line;
   for (LineNode &node : other.nodes)
   {
      node.position = tilted.point + turn * node.position;
      node.tangent = turn * node.tangent;
   }
   for (LineElement &element : other.chains[0].elements)
   {
      for (Index a = 0; a < element.points.cols(); ++a)
      {
         element.points.col(a) = tilted.point + turn * Eigen::Vector2d(element.points.col(a));
      }
   }
   const CondensedBody one = condense(level, line), two = condense(tilted, other);
   EXPECT_LT((one.S - two.S).cwiseAbs().maxCoeff(), 1e-12 * one.S.cwiseAbs().maxCoeff());
   EXPECT_LT((two.line.nodes[0].normal() - tilted.normal).norm(), 1e-15);
   // Also where it hangs on its forces: Maxwell's symmetry, to the last bit.
   HalfPlane pressed = level;
   pressed.forces = {{"P", {0, 1}}, {"Q", {1, 0}}};
   const MatrixXd S = condense(pressed, line).S;
   EXPECT_EQ(S, MatrixXd(S.transpose()));
}

TEST(HalfPlane, StiffnessScalesWithTheUnits)
{
   std::vector<double> small = uneven;
   for (double &x : small) { x *= 1e-9; }
   HalfPlane one = half_plane(1, 0.3), other = half_plane(2.1e11, 0.3);
   other.depth *= 1e-9;
   using F = Formulation;
   for (const F formulation : {F::plane, F::axisymmetric, F::torsion})
   {
      const MatrixXd S = condense(one, straight_line(uneven, 3, formulation)).S;
      const double unit = formulation == F::plane ? 2.1e11 : 2.1e11 * 1e-9;
      const MatrixXd scaled = condense(other, straight_line(small, 3, formulation)).S / unit;
      EXPECT_LT((S - scaled).cwiseAbs().maxCoeff(), 1e-12 * S.cwiseAbs().maxCoeff());
   }
}

/// As deep as asked for and no deeper, with the strongest coupling and the steepest grading.
TEST(HalfPlane, StiffnessIsPositiveDefinite)
{
   const std::vector<double> steep = halving_both_ways(1, 40);
   for (const double poisson : {-0.5, 0.0, 0.49})
   {
      for (const auto &grid : {uneven, steep})
      {
         HalfPlane body = half_plane(1, poisson);
         body.depth = 2 * (grid.back() - grid.front());
         const CondensedBody one = condense(body, straight_line(grid, 3));
         EXPECT_EQ((one.S - one.S.transpose()).cwiseAbs().maxCoeff(), 0);
         // On the scale of each node.
         const VectorXd own = one.S.diagonal().cwiseSqrt().cwiseInverse();
         const MatrixXd scaled = own.asDiagonal() * one.S * own.asDiagonal();
         EXPECT_GT(symmetric_eigenvalues(scaled).minCoeff(), 1e-4) << poisson;
      }
   }
}

TEST(HalfPlane, ErrorOfTheStiffnessIsRoundOff)
{
   for (const bool plane : {true, false})
   {
      CondensedBody body =
         condense(half_plane(1, 0.3),
                  straight_line(halving(0, 1, 20), 2,
                                plane ? Formulation::plane : Formulation::axisymmetric));
      EXPECT_GT(body.error_estimate(), 1e-16);
      EXPECT_LT(body.error_estimate(), 1e-11);
   }
}

/// Relative displacements d of two bodies, prescribed: what closes and shears a contact of
/// half-planes, which carry no other loads.
LoadPattern approach(const ReducedProblem &problem, const std::string &name, const VectorXd &d)
{
   const VectorXd f = problem.K * d;
   return {name, Control::displacement, f.head(problem.slips()), f.tail(problem.nodes())};
}

/// Two half-planes (or half-spaces) that face each other; the upper one is body 1.
struct Pair
{
   Reduction reduction;

   Pair(const ContactLine &line, double poisson)
      : reduction(reduce(above(line, poisson), half_plane(1 - poisson * poisson, poisson)))
   {
   }
   /// It lies above the line, whose nodes run as those of the body do: of the line turned
   /// round.
   static CondensedBody above(const ContactLine &line, double poisson)
   {
      HalfPlane upper = half_plane(1 - poisson * poisson, poisson);
      const ContactLine below = condense(upper, line).line;
      upper.normal = {0, 1};
      return condense(upper, below);
   }
};

TEST(HalfPlane, HertzAndCattaneoOfTwoHalfPlanes)
{
   const double nu = 0.3, R = 3, a = 1, f = 0.4;
   const int elements = 80; // of -1.5 < x < 1.5
   Pair pair(straight_line(even(-1.5, 1.5, elements), 2), nu);
   ReducedProblem &problem = pair.reduction.problem;
   const Index n = problem.nodes();
   EXPECT_FALSE(problem.coupled); // equal bodies
   problem.gap = problem.position.col(0).cwiseAbs2() / (2 * R);
   // E' = 1 of each: P = π a²/8R; ∫ p ln|s| ds = P (ln(a/2) - 1/2) in the middle.
   const double P = M_PI * a * a / (8 * R), p0 = 2 * P / (M_PI * a);
   const double sinking = 4 / M_PI * P * (std::log(2 * depth / a) + 0.5 - below(nu));
   const VectorXd ones = VectorXd::Ones(n), zeros = VectorXd::Zero(n);
   problem.patterns = {approach(problem, "press", (VectorXd(2 * n) << zeros, ones).finished()),
                       approach(problem, "shift", (VectorXd(2 * n) << ones, zeros).finished())};
   problem.H = MatrixXd::Zero(2, 2);
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(sinking, 0)).status,
             FrictionStatus::converged);
   EXPECT_NEAR(state.p.sum() / P, 1, 3e-4);
   const VectorXd p = tractions(problem, state.p);
   for (Index i = 0; i < n; ++i)
   {
      const double x = problem.position(i, 0);
      if (std::abs(x) < 0.9) { EXPECT_NEAR(p[i] / p0, std::sqrt(1 - x * x), 3e-3) << x; }
   }
   // Cattaneo: sheared, the stick zone is c = a √(1 - Q/fP), and bodies that shift without slip
   // far away shift by u(Q) = f (δ(P) - δ(P*)), where Q = f (P - P*).
   const double c = 0.6, inner = M_PI * c * c / (8 * R);
   const double shift = 4 / M_PI * f *
                        (P * (std::log(2 * depth / a) + 0.5 + below(nu)) -
                         inner * (std::log(2 * depth / c) + 0.5 + below(nu)));
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(sinking, shift)).status,
             FrictionStatus::converged);
   EXPECT_NEAR(state.q.sum() / (f * (P - inner)), 1, 3e-3);
   const Zone stick = stick_zone(problem, state);
   EXPECT_NEAR(problem.position(stick.first, 0), -c, 1.5 / elements);
   EXPECT_NEAR(problem.position(stick.last, 0), c, 1.5 / elements);
}

/// Two equal half-planes in a parabola, E' = 1, pressed to |x| < 1, then sheared by `shear` f P
/// while the lower one is pulled by a stress that grows with the shear, to `shift` times 4 f
/// p0.
struct FrettedPair
{
   double shear = 0.5, shift = 0;
   HalfPlane upper = half_plane(0.91, 0.3), lower = upper;
   ReducedProblem problem;
   ContactState state;
   bool both_ways = false; ///< was there slip forward and backward at once?
   const double f = 0.4, P = M_PI / 8, p0 = 2 * P / M_PI; // R = 1

   FrettedPair(double shear_, double shift_, const std::vector<NamedLoads> &then = {})
      : shear(shear_), shift(shift_)
   {
      upper.normal = {0, 1};
      upper.forces = {{"P", {0, -P}}, {"Q", {shear * f * P, 0}}};
      lower.bulk = {{"Q", shift * 4 * f * p0}};
      problem = reduce(condense(upper, even(-1.25, 1.25, 100), 2), lower).problem;
      problem.gap = problem.position.col(0).cwiseAbs2() / 2;
      set_friction(problem, f);
      state = ContactState::virgin(problem);
      std::vector<NamedLoads> points{{}, {{"P", 1}}, {{"P", 1}, {"Q", 1}}};
      points.insert(points.end(), then.begin(), then.end());
      const MarchReport report =
         march(problem, LoadHistory::through(problem, points), state, {},
               [&](const ContactState &, const IncrementRecord &record)
               { both_ways |= record.forward_slip > 0 && record.backward_slip > 0; });
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
      EXPECT_LT(std::abs(report.energy_imbalance), 1e-3);
   }
   /// Where its stick zone begins and ends along x.
   std::array<double, 2> stick() const
   {
      const Zone zone = widest_zone(zones(problem, state), NodeState::stick);
      const VectorXd x = problem.position.col(0);
      const double way = x[1] > x[0] ? 1 : -1;
      const auto place = [&](const ZoneBorder &at)
      { return x[0] + way * (at.position - problem.arc_length[0]); };
      const double from = place(zone.from), to = place(zone.to);
      return {std::min(from, to), std::max(from, to)};
   }
};

// Nowell and Hills: under Q that pushes the pad along x and a tension σ of what it stands on,
// both in proportion, the stick zone |x - e| < c has c = a √(1 - Q/fP), e = a σ/(4 f p0), as
// long as it stays inside of the contact on the whole way: 1 - √(1 - λ Q/fP) >= λ e/a for all λ
// from 0 to 1, that is e/a <= Q/2fP. Beyond that an edge slips back from the beginning.
// Unloaded or reversed both are those of half the change of Q and of σ (Masing).
TEST(HalfPlane, BulkStressMovesTheStickZone)
{
   const double spacing = 2.5 / 200;
   for (const double sign : {1.0, -1.0})
   {
      const FrettedPair pair(0.6, 0.2 * sign);
      const double c = std::sqrt(1 - 0.6);
      const auto [from, to] = pair.stick();
      EXPECT_NEAR(0.5 * (from + to), 0.2 * sign, 0.1 * spacing);
      EXPECT_NEAR(0.5 * (to - from), c, 0.2 * spacing);
      const std::string name = sign > 0 ? "step" : "opposition";
      cattaneo_test::record("shift_in_" + name, 0.5 * (from + to));
      cattaneo_test::record("stick_in_" + name, 0.5 * (to - from));
      const FrettedPair back(0.6, 0.2 * sign, {{{"P", 1}, {"Q", -1}}});
      const auto [low, high] = back.stick();
      EXPECT_NEAR(0.5 * (low + high), 0.2 * sign, 0.1 * spacing);
      EXPECT_NEAR(0.5 * (high - low), c, 0.2 * spacing);
      const FrettedPair half(0.6, 0.2 * sign, {{{"P", 1}, {"Q", 0}}});
      const auto [left, right] = half.stick();
      EXPECT_NEAR(0.5 * (left + right), 0.1 * sign, 0.1 * spacing);
      EXPECT_NEAR(0.5 * (right - left), std::sqrt(1 - 0.3), 0.2 * spacing);
   }
   // Both senses of slip are there on the way once the stick zone reaches the edge on it, and
   // none before. (Slip back begins in no more than the last elements: a third above.)
   EXPECT_FALSE(FrettedPair(0.6, 0.97 * 0.3).both_ways);
   EXPECT_TRUE(FrettedPair(0.6, 1.3 * 0.3).both_ways);
   EXPECT_FALSE(FrettedPair(0.3, -0.97 * 0.15).both_ways);
   EXPECT_TRUE(FrettedPair(0.3, -1.3 * 0.15).both_ways);
}

/// Under a bulk stress alone the surface has the strain of Hooke's law, and the loads of a
/// half-plane obey Maxwell's rule: what one moves per unit of the other is the same both ways.
TEST(HalfPlane, BulkStressStrainsTheSurface)
{
   const double E = 2, nu = 0.3, stress = 0.7;
   struct Kind
   {
      PlaneState state;
      Formulation formulation;
      double strain;
   };
   for (const Kind &kind : {Kind{PlaneState::strain, Formulation::plane, (1 - nu * nu) / E},
                            Kind{PlaneState::stress, Formulation::plane, 1 / E},
                            Kind{PlaneState::strain, Formulation::axisymmetric, (1 - nu) / E}})
   {
      const bool plane = kind.formulation == Formulation::plane;
      HalfPlane body = half_plane(E, nu, kind.state);
      body.bulk = {{"B", stress}};
      if (plane) { body.point = {0.6, 0}; }
      const CondensedBody alone = condense(body, straight_line(uneven, 3, kind.formulation));
      const Index n = alone.line.size();
      ASSERT_EQ(alone.patterns.size(), 1u);
      VectorXd f(2 * n);
      f << alone.patterns[0].q, alone.patterns[0].p;
      const VectorXd u = solved(alone.S, -f);
      for (Index i = 0; i < n; ++i)
      {
         const LineNode &node = alone.line.nodes[i];
         const double x = node.position[0] - body.point[0];
         EXPECT_NEAR(u[i] * node.tangent[0], stress * kind.strain * x, 1e-12);
         EXPECT_NEAR(u[n + i], 0, 1e-12);
      }
      // With a far force of the same name as one of two bulk stresses.
      body.forces = {{"P", {0, 3}}, {"B", {0, -2}}};
      body.bulk.push_back({"C", 5});
      const CondensedBody all = condense(body, straight_line(uneven, 3, kind.formulation));
      ASSERT_EQ(all.patterns.size(), 3u);
      EXPECT_LT((all.H - all.H.transpose()).cwiseAbs().maxCoeff(),
                1e-13 * all.H.cwiseAbs().maxCoeff());
      // By energies: with u given, ½ (u - R y - u₀ λ)ᵀ S (…) - λ F y at its least over y.
      HalfPlane held = body;
      held.forces.clear();
      held.bulk.clear();
      const CondensedBody fixed = condense(held, straight_line(uneven, 3, kind.formulation));
      const VectorXd sunk = fixed.rigid_motions().col(plane ? 1 : 0);
      const VectorXd given = VectorXd::LinSpaced(2 * n, -1, 2);
      const Eigen::Vector3d loads(0.3, -0.4, 0.2); // of P, B and C
      const VectorXd strained = u / stress * (stress * loads[1] + 5 * loads[2]);
      // About an axis it goes along that alone; in the plane sideways as well, without a force.
      MatrixXd R(2 * n, plane ? 2 : 1);
      R.col(0) = sunk;
      if (plane) { R.col(1) = fixed.rigid_motions().col(0); }
      VectorXd F = VectorXd::Zero(R.cols());
      F[0] = 3 * loads[0] - 2 * loads[1];
      const VectorXd y =
         solved(R.transpose() * fixed.S * R, F + R.transpose() * fixed.S * (given - strained));
      const VectorXd moved = fixed.S * (given - R * y - strained);
      VectorXd found = all.S * given, conjugate = all.H * loads;
      for (Index k = 0; k < 3; ++k)
      {
         found.head(n) += loads[k] * all.patterns[k].q;
         found.tail(n) += loads[k] * all.patterns[k].p;
         conjugate[k] -=
            all.patterns[k].q.dot(given.head(n)) + all.patterns[k].p.dot(given.tail(n));
      }
      const double size = moved.cwiseAbs().maxCoeff();
      EXPECT_LT((found - moved).cwiseAbs().maxCoeff(), 1e-11 * size);
      EXPECT_EQ(all.patterns[0].name, "P");
      EXPECT_NEAR(conjugate[0], 3 * y[0], 1e-11 * size);
      EXPECT_NEAR(conjugate[1], u.dot(moved) - 2 * y[0], 1e-11 * size);
      EXPECT_NEAR(conjugate[2], 5 / stress * u.dot(moved), 1e-11 * size);
   }
}

// Cattaneo and Mindlin: under a constant force P the shift is u(Q) = f (δ(P) - δ(P - Q/f)),
// where δ(P) = 4/π P (ln(2 depth/a) + 1/2 + κ) with a² ~ P. What is linear in P encloses no
// area: with g(P) = -2/π P ln P and its integral G, the loop of Masing's rule loses 4 Q u - 8 ∫
// u dQ = 4 f² (P - P*)(g(P) - g(P*)) - 8 f² (g(P)(P - P*) - G(P) + G(P*)).
TEST(HalfPlane, LoopOfCattaneoAndMindlin)
{
   const double nu = 0.3, R = 3, a = 1, f = 0.4, c = 0.6;
   const double P = M_PI * a * a / (8 * R), inner = M_PI * c * c / (8 * R);
   const double sinking = 4 / M_PI * P * (std::log(2 * depth / a) + 0.5 - below(nu));
   const auto by_depth = [nu](double force, double half_width)
   { return 4 / M_PI * force * (std::log(2 * depth / half_width) + 0.5 + below(nu)); };
   const double shift = f * (by_depth(P, a) - by_depth(inner, c)), Q = f * (P - inner);
   const auto g = [](double p) { return -2 / M_PI * p * std::log(p); };
   const auto G = [](double p) { return -2 / M_PI * p * p * (0.5 * std::log(p) - 0.25); };
   const double loss = 4 * f * f * (P - inner) * (g(P) - g(inner)) -
                       8 * f * f * (g(P) * (P - inner) - G(P) + G(inner));
   double error[2];
   int level = 0;
   for (const int elements : {30, 60})
   {
      Pair pair(straight_line(even(-1.5, 1.5, elements), 2), nu);
      ReducedProblem &problem = pair.reduction.problem;
      const Index n = problem.nodes();
      problem.gap = problem.position.col(0).cwiseAbs2() / (2 * R);
      const VectorXd ones = VectorXd::Ones(n), zeros = VectorXd::Zero(n);
      const VectorXd down = (VectorXd(2 * n) << zeros, ones).finished(),
                     along = (VectorXd(2 * n) << ones, zeros).finished();
      problem.patterns = {approach(problem, "press", down), approach(problem, "shift", along)};
      // Reactions of whole bodies that move: the resultants of p and of q.
      MatrixXd motions(2 * n, 2);
      motions << down, along;
      problem.H = motions.transpose() * problem.K * motions;
      set_friction(problem, f);
      LoadHistory history =
         LoadHistory::through(problem, {{},
                                        {{"press", sinking}},
                                        {{"press", sinking}, {"shift", shift}},
                                        {{"press", sinking}, {"shift", -shift}},
                                        {{"press", sinking}, {"shift", shift}}});
      history.cycle_start = 2;
      history.cycles = 2;
      MarchSettings settings;
      settings.stepping = Stepping::exact;
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = march(problem, history, state, settings);
      ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
      const IncrementRecord &last = report.increments.back();
      EXPECT_NEAR(last.conjugates[0], state.p.sum(), 1e-12);
      EXPECT_NEAR(last.conjugates[1], state.q.sum(), 1e-12);
      const Loop &loop = report.cycles.back().loops[1];
      EXPECT_NEAR(loop.work(), report.cycles.back().dissipation, 1e-12);
      EXPECT_NEAR(loop.stiffness() / (Q / shift), 1, 4e-3);
      EXPECT_NEAR(loop.loss_factor() / (loss / (M_PI * Q * shift)), 1, 0.03);
      error[level++] = std::abs(loop.work() / loss - 1);
   }
   EXPECT_LT(error[0], 0.03);
   EXPECT_LT(error[1], 0.5 * error[0]);
}

TEST(HalfSpace, HertzAndLubkinOfTwoHalfSpaces)
{
   const double nu = 0.3, R = 5, a = 0.7, f = 0.3, E = 1 - nu * nu, G = E / (2 * (1 + nu));
   const int elements = 48;
   const std::vector<double> grid = even(0, 1, elements);
   Pair pair(straight_line(grid, 2, Formulation::axisymmetric), nu);
   const ContactLine twisting = straight_line(grid, 2, Formulation::torsion);
   pair.reduction.add_torsion(Pair::above(twisting, nu), condense(half_plane(E, nu), twisting));
   ReducedProblem &problem = pair.reduction.problem;
   const Index n = problem.nodes();
   const VectorXd r = problem.position.col(0);
   problem.gap = r.cwiseAbs2() / (2 * R);
   const double modulus = 0.5, P = 4.0 / 3 * modulus * a * a * a / R,
                p0 = 2 * modulus * a / (M_PI * R);
   const VectorXd zeros = VectorXd::Zero(n), ones = VectorXd::Ones(n);
   problem.patterns = {
      approach(problem, "press", (VectorXd(3 * n) << zeros, zeros, ones).finished()),
      approach(problem, "twist", (VectorXd(3 * n) << zeros, r, zeros).finished())};
   problem.H = MatrixXd::Zero(2, 2);
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(a * a / R, 0)).status,
             FrictionStatus::converged);
   EXPECT_NEAR(state.p.sum() / P, 1, 3e-4);
   cattaneo_test::record("load", state.p.sum() / P);
   const VectorXd p = tractions(problem, state.p);
   for (Index i = 0; i < n; ++i)
   {
      const double x = r[i] / a;
      if (x < 0.85) { EXPECT_NEAR(p[i] / p0, std::sqrt(1 - x * x), 2e-3) << x; }
   }
   // Lubkin: with m = 1 - c²/a², Φ = 3fP (K(m) - E(m))/2πGa², T = 4fP/πa² ∫_c^a s² E(1-s²/a²)
   // ds.
   const double c = 0.4, m = 1 - c * c / (a * a), k = std::sqrt(m);
   const double turn =
      3 * f * P * (std::comp_ellint_1(k) - std::comp_ellint_2(k)) / (2 * M_PI * G * a * a);
   const QuadratureRule &rule = gauss_rule(40);
   double torque = 0;
   for (Index i = 0; i < rule.points.size(); ++i)
   {
      const double s = c + (a - c) * rule.points[i];
      torque +=
         (a - c) * rule.weights[i] * s * s * std::comp_ellint_2(std::sqrt(1 - s * s / (a * a)));
   }
   torque *= 4 * f * P / (M_PI * a * a);
   ASSERT_EQ(solver.solve(state, Eigen::Vector2d(a * a / R, turn)).status,
             FrictionStatus::converged);
   const double reached = std::abs(state.q.segment(n, n).dot(r)) / torque;
   EXPECT_NEAR(reached, 1, 1e-3);
   cattaneo_test::record("torque", reached);
}

} // namespace
