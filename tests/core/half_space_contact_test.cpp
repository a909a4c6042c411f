#include "expect_input_error.hpp"
#include "half_space_contacts.hpp"

#include <algorithm>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/halfplane/heights.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <record.hpp>

// Contact of half-spaces in three dimensions, tractions uniform on rectangles: against point
// forces, closed solutions, invariances, and the output of Kalker's CONTACT.

namespace
{

using namespace cattaneo;
using cattaneo_test::cells;
using cattaneo_test::conjugate;
using cattaneo_test::contact_of;
using cattaneo_test::FactorsOfIncrements;
using cattaneo_test::kalkers_spence;
using cattaneo_test::marched;
using cattaneo_test::number_closed;
using cattaneo_test::number_of;
using cattaneo_test::of_shear;
using cattaneo_test::Places;
using cattaneo_test::sheared_spheres;
using cattaneo_test::ShearedSpheres;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Boussinesq and Cerruti: surface displacements of a half-space z > 0 by a force at a point of
/// its surface (Johnson 1985, 3.19 and 3.75), columns: forces along x, y and z.
Matrix3d point_force(double G, double nu, const Vector2d &way)
{
   const double r = way.norm(), x = way[0], y = way[1], c = 1 / (4 * M_PI * G),
                odd = (1 - 2 * nu) / (r * r);
   Matrix3d u;
   u << 2 * (1 - nu) / r + 2 * nu * x * x / (r * r * r), 2 * nu * x * y / (r * r * r), -odd * x,
      2 * nu * x * y / (r * r * r), 2 * (1 - nu) / r + 2 * nu * y * y / (r * r * r), -odd * y,
      odd * x, odd * y, 2 * (1 - nu) / r;
   return c * u;
}

TEST(HalfSpaceContact, ARectangleIsTheIntegralOfPointForces)
{
   // The second body takes the opposite shear, and its normal is the other one.
   const double G = 2, nu = 0.2, other_G = 5, other_nu = 0.4;
   HalfSpace contact;
   contact.material = of_shear(G, nu);
   contact.other = of_shear(other_G, other_nu);
   contact.size = {0.7, 0.3};
   contact.centres = Places(1, 2);
   contact.centres << 0.2, -0.1;
   const Matrix3d turned = Eigen::Vector3d(-1, -1, 1).asDiagonal();
   const QuadratureRule &rule = gauss_rule(64);
   Places points(5, 2);
   points << 0.2, 0.6, 1.3, -0.1, 2, 2, -0.7, 0.4, 40, -3;
   for (const Vector2d point : points.rowwise())
   {
      Matrix3d expected = Matrix3d::Zero();
      for (Index i = 0; i < 64; ++i)
      {
         for (Index j = 0; j < 64; ++j)
         {
            const Vector2d from =
               contact.centres.row(0).transpose() +
               contact.size.cwiseProduct(Vector2d(rule.points[i] - 0.5, rule.points[j] - 0.5));
            expected += rule.weights[i] * rule.weights[j] *
                        (point_force(G, nu, point - from) +
                         turned * point_force(other_G, other_nu, point - from) * turned);
         }
      }
      for (Index k = 0; k < 3; ++k)
      {
         const VectorXd moved =
            contact.displacements(point.transpose(), VectorXd::Unit(3, k)).row(0).transpose();
         EXPECT_LT((moved - expected.col(k)).norm(), 1e-13 * expected.norm()) << k;
      }
   }
}

/// Love: the middle of a square of edge l under a uniform pressure p sinks by
/// (4/π) ln(1 + √2) (1 - ν²) p l/E, its corners by half of that.
TEST(HalfSpaceContact, UniformPressureOnASquare)
{
   const double E = 3, nu = 0.3, edge = 0.8, p = 2;
   const HalfSpace contact = contact_of({E, nu}, {}, edge, Places::Zero(1, 2));
   Places points(3, 2);
   points << 0, 0, edge / 2, edge / 2, edge / 2, 0;
   const Eigen::MatrixX3d u =
      contact.displacements(points, Eigen::Vector3d(0, 0, p * edge * edge));
   const double sinks = 4 / M_PI * std::log(1 + std::sqrt(2.0)) * (1 - nu * nu) * p * edge / E;
   EXPECT_NEAR(u(0, 2), sinks, 1e-14 * sinks);
   EXPECT_NEAR(u(1, 2), sinks / 2, 1e-14 * sinks);
   // The middle of a side: half of what two such squares side by side have in their middle,
   // where four rectangles of edges l and l/2 meet with their corners.
   const auto corner = [](double a, double b) // of ∫ 1/r over a rectangle
   { return a * std::asinh(b / a) + b * std::asinh(a / b); };
   EXPECT_NEAR(u(2, 2), 2 * corner(edge, edge / 2) * (1 - nu * nu) * p / (M_PI * E),
               1e-14 * sinks);
   EXPECT_TRUE(u.leftCols(2).row(0).isZero(0));
}

/// Forces do the same work on displacements of others as the others' on theirs, and the
/// stiffness is symmetric to the last bit; what nothing resists meets no force.
TEST(HalfSpaceContact, TheStiffnessIsSymmetric)
{
   HalfSpace contact = contact_of(of_shear(1, 0.1), of_shear(4, 0.3), 0.1, cells(9, 0.1, 0.4));
   contact.size = {0.1, 0.2};
   contact.centres.col(1) *= 2;
   contact.turns = true;
   const Index n = contact.centres.rows();
   std::mt19937 random(1);
   std::normal_distribution<double> normal;
   const auto forces = [&]
   { return VectorXd::NullaryExpr(3 * n, [&] { return normal(random); }); };
   const VectorXd first = forces(), second = forces();
   const auto work = [&](const VectorXd &of, const VectorXd &on)
   {
      const Eigen::MatrixX3d u = contact.displacements(contact.centres, of);
      return on.dot(Eigen::Map<const VectorXd>(u.data(), u.size()));
   };
   EXPECT_NEAR(work(first, second), work(second, first), 1e-13 * work(first, first));
   EXPECT_GT(work(first, first), 0);

   const ReducedProblem problem = contact.problem(VectorXd::Zero(n));
   EXPECT_TRUE(problem.coupled);
   EXPECT_EQ(problem.components(), 2);
   EXPECT_TRUE((problem.K - problem.K.transpose()).isZero(0));
   EXPECT_EQ(problem.rigid_motions.cols(), 4);
   EXPECT_LT((problem.K * problem.rigid_motions).norm(), 1e-13 * problem.K.norm());
   // Displacements of forces that balance are those of the closed forms but for the far body's
   // motion: K of them is the forces again.
   const MatrixXd &Z = problem.rigid_motions;
   const VectorXd balanced = first - Z * (Z.transpose() * first);
   const Eigen::MatrixX3d u = contact.displacements(contact.centres, balanced);
   EXPECT_LT((problem.K * Eigen::Map<const VectorXd>(u.data(), u.size()) - balanced).norm(),
             1e-11 * balanced.norm());
}

/// Boussinesq and Cerruti: stresses xx, yy, zz, yz, zx and xy of a half-space z > 0 by a unit
/// force along z (first column) and along x (second) at the origin (Johnson 1985, 3.20, 3.76).
Eigen::Matrix<double, 6, 2> stress_of_forces(double nu, const Eigen::Vector3d &at)
{
   const double x = at[0], y = at[1], z = at[2], R = at.norm(), r2 = x * x + y * y,
                R3 = R * R * R, R5 = R3 * R * R, k = 1 - 2 * nu, s = R + z, flat = 1 - z / R;
   Eigen::Matrix<double, 6, 2> stress;
   stress.col(0) << k / r2 * (flat * (x * x - y * y) / r2 + z * y * y / R3) -
                       3 * z * x * x / R5,
      k / r2 * (flat * (y * y - x * x) / r2 + z * x * x / R3) - 3 * z * y * y / R5,
      -3 * z * z * z / R5, -3 * y * z * z / R5, -3 * x * z * z / R5,
      k / r2 * (2 * flat * x * y / r2 - x * y * z / R3) - 3 * x * y * z / R5;
   const double common = 1 / (R3 * s * s) + 2 / (R * R * s * s * s);
   stress.col(1) << -3 * x * x * x / R5 +
                       k * (x / R3 - 3 * x / (R * s * s) + x * x * x * common),
      -3 * x * y * y / R5 + k * (x / R3 - x / (R * s * s) + x * y * y * common),
      -3 * x * z * z / R5, -3 * x * y * z / R5, -3 * x * x * z / R5,
      -3 * x * x * y / R5 + k * (-y / (R * s * s) + x * x * y * common);
   return stress / (2 * M_PI);
}

TEST(HalfSpaceContact, StressesAreThoseOfPointForces)
{
   const double nu = 0.2, other_nu = 0.4;
   HalfSpace contact;
   contact.material = of_shear(2, nu);
   contact.other = of_shear(5, other_nu);
   contact.size = {0.7, 0.3};
   contact.centres = Places(1, 2);
   contact.centres << 0.2, -0.1;
   const QuadratureRule &rule = gauss_rule(64);
   Eigen::MatrixX3d points(5, 3);
   points << 0.3, -0.05, 0.4, 1.3, -0.2, 0.3, -0.4, 0.9, 1e-3, 40, -3, 7, -2, -1.5, 0.6;
   for (const Eigen::Vector3d point : points.rowwise())
   {
      Eigen::Matrix<double, 6, 2> expected = expected.Zero(), below = below.Zero();
      for (Index i = 0; i < 64; ++i)
      {
         for (Index j = 0; j < 64; ++j)
         {
            Eigen::Vector3d way = point;
            way.head(2) -=
               contact.centres.row(0).transpose() +
               contact.size.cwiseProduct(Vector2d(rule.points[i] - 0.5, rule.points[j] - 0.5));
            const double weight = rule.weights[i] * rule.weights[j];
            expected += weight * stress_of_forces(nu, way);
            below += weight * stress_of_forces(other_nu, way);
         }
      }
      const auto stresses = [&](const Eigen::Vector3d &at, const Eigen::Vector3d &force)
      { return VectorXd(contact.stresses(at.transpose(), force).row(0).transpose()); };
      const double allowed = 1e-12 * expected.norm();
      EXPECT_LT((stresses(point, {0, 0, 1}) - expected.col(0)).norm(), allowed) << point;
      EXPECT_LT((stresses(point, {1, 0, 0}) - expected.col(1)).norm(), allowed) << point;
      // In the body below, which shear pulls the other way: mirrored, z is -z.
      const Eigen::Vector3d mirrored(point[0], point[1], -point[2]);
      VectorXd other = below.col(0);
      other.segment(3, 2) *= -1;
      EXPECT_LT((stresses(mirrored, {0, 0, 1}) - other).norm(), allowed) << point;
      other = -below.col(1);
      other.segment(3, 2) *= -1;
      EXPECT_LT((stresses(mirrored, {1, 0, 0}) - other).norm(), allowed) << point;
      // Along y: x and y exchanged, of a rectangle likewise.
      HalfSpace turned = contact;
      turned.size = contact.size.reverse();
      turned.centres = contact.centres.rowwise().reverse();
      const VectorXd along_y = turned
                                  .stresses(Eigen::RowVector3d(point[1], point[0], point[2]),
                                            Eigen::Vector3d(0, 1, 0))
                                  .row(0)
                                  .transpose();
      VectorXd exchanged = expected.col(1);
      std::swap(exchanged[0], exchanged[1]);
      std::swap(exchanged[3], exchanged[4]);
      EXPECT_LT((along_y - exchanged).norm(), allowed) << point;
   }
   // Just inside, the surface bears what acts on it, and nothing beside it.
   const Eigen::Vector3d force(0.3, -0.2, 0.5);
   const double area = contact.size.prod();
   Eigen::MatrixX3d surface(2, 3);
   surface << 0.3, -0.05, 0, 0.3, 0.4, 0;
   const auto at = contact.stresses(surface, force);
   EXPECT_NEAR(at(0, 2), -force[2] / area, 1e-14);
   EXPECT_NEAR(at(0, 3), -force[1] / area, 1e-14);
   EXPECT_NEAR(at(0, 4), -force[0] / area, 1e-14);
   EXPECT_LT(at.row(1).segment(2, 3).norm(), 1e-14);
   contact.other.reset();
   expect_input_error([&] { contact.stresses(Eigen::RowVector3d(0, 0, -1), force); },
                      "z = -1 lies in the body below, which is rigid");
}

/// Bodies of one material, and unlike ones with the same (1-2ν)/G, have no coupling, exactly.
TEST(HalfSpaceContact, WhereNothingCouples)
{
   const Places centres = cells(5, 0.1, 1);
   const VectorXd gap = VectorXd::Zero(centres.rows());
   const Material soft = of_shear(1, 0.1), stiff = of_shear(0.4 / 0.8, 0.3);
   for (const auto &[above, below, coupled] :
        {std::tuple(soft, std::optional<Material>(soft), false),
         {soft, std::optional<Material>(stiff), false},
         {soft, std::optional<Material>(), true},
         {soft, std::optional<Material>(of_shear(1, 0.3)), true}})
   {
      const ReducedProblem problem = contact_of(above, below, 0.1, centres).problem(gap);
      EXPECT_EQ(problem.coupled, coupled);
      EXPECT_EQ(problem.B().isZero(0), !coupled);
   }
   // Incompressible on a rigid body: 1 - 2ν is zero.
   const HalfSpace rubber = contact_of({1, 0.5 - 1e-16}, {}, 0.1, centres);
   EXPECT_LT(rubber.problem(gap).B().norm(), 1e-14 * rubber.problem(gap).C().norm());
}

/** Kalker's CONTACT, example "cattaneo" (its own reference output): two equal spheres pressed,
    then sheared. All digits that it prints. */
TEST(HalfSpaceContact, KalkersContactCattaneo)
{
   const double edge = 0.13333, P = 9.1954, f = 0.4;
   const Material material = of_shear(200, 0.42);
   const HalfSpace contact = contact_of(material, material, edge, cells(19, edge, 10));
   ReducedProblem problem = contact.problem(0.01 * contact.centres.rowwise().squaredNorm());
   set_friction(problem, f);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(marched(problem, {{}, {{"P", P}}}, state).status, FrictionStatus::converged);
   EXPECT_NEAR(conjugate(problem, state, "P"), 1.998e-2, 0.5e-5);
   EXPECT_NEAR(state.p.maxCoeff() / (edge * edge), 4.393, 0.5e-3);
   EXPECT_EQ(number_closed(state), 177);
   cattaneo_test::record("approach", conjugate(problem, state, "P"));
   cattaneo_test::record("pressure", state.p.maxCoeff() / (edge * edge));

   const MarchReport sheared =
      marched(problem, {{}, {{"P", P}}, {{"P", P}, {"Q1", 7.0 / 8 * f * P}}}, state);
   ASSERT_EQ(sheared.status, FrictionStatus::converged);
   EXPECT_NEAR(conjugate(problem, state, "Q1"), 8.155e-3, 0.5e-6);
   EXPECT_EQ(number_of(state, NodeState::stick), 45);
   EXPECT_EQ(number_of(state, NodeState::slip), 132);
   EXPECT_NEAR(state.dissipation, 2.750e-3, 0.5e-6);
   const VectorXd forces = state.forces();
   const Eigen::MatrixX3d u = contact.displacements(contact.centres, forces);
   const double energy = forces.dot(Eigen::Map<const VectorXd>(u.data(), u.size())) / 2;
   EXPECT_NEAR(energy, 8.525e-2, 0.5e-5);
   cattaneo_test::record("shift", conjugate(problem, state, "Q1"));
   cattaneo_test::record("loss", state.dissipation);
   cattaneo_test::record("energy", energy);
}

/// CONTACT's example "spence35", coupled, with a force in stages. The cells that may touch
/// reach twice as far as the contact.
TEST(HalfSpaceContact, KalkersContactSpence)
{
   ReducedProblem problem = kalkers_spence(1.3);
   ContactState state = ContactState::virgin(problem);
   FrictionSolver solver(problem);
   FactorsOfIncrements factors;
   for (const double P : {1.1e-5, 8.8e-5, 2.96e-4, 7.02e-4, 1.372e-3, 2.37e-3})
   {
      VectorXd loads = VectorXd::Zero(3);
      loads[problem.pattern("P")] = P;
      ASSERT_EQ(solver.solve(state, loads).status, FrictionStatus::converged) << P;
      factors.note(solver.counters());
   }
   EXPECT_LE(factors.most, 20);
   EXPECT_LE(factors.mean(), 6);
   EXPECT_EQ(solver.counters().sweeps, 0);
   EXPECT_NEAR(conjugate(problem, state, "P"), 2.901e-3, 0.5e-6);
   EXPECT_NEAR(state.p.maxCoeff() / problem.weights[0], 3.941e-3, 0.5e-6);
   EXPECT_EQ(number_closed(state), 29);
   EXPECT_EQ(number_of(state, NodeState::stick), 5);
   cattaneo_test::record("approach", conjugate(problem, state, "P"));
   cattaneo_test::record("pressure", state.p.maxCoeff() / problem.weights[0]);
}

/// 177 and 489 squares within the contact. What is left after unloading is a sixth of the
/// shift; the loss collects the errors of both ways.
TEST(HalfSpaceContact, HertzCattaneoMindlin)
{
   const ShearedSpheres coarse = sheared_spheres(15), fine = sheared_spheres(25);
   for (const auto &[error, allowed] : {std::pair(coarse, 2e-3), {fine, 5e-4}})
   {
      EXPECT_NEAR(error.approach, 0, allowed);
      EXPECT_NEAR(error.loading, 0, allowed);
      EXPECT_NEAR(error.unloading, 0, 6 * allowed);
      EXPECT_NEAR(error.loss, 0, 4 * allowed);
   }
   cattaneo_test::record("approach", 1 + fine.approach);
   cattaneo_test::record("loading", 1 + fine.loading);
   cattaneo_test::record("unloading", 1 + fine.unloading);
   cattaneo_test::record("loss", 1 + fine.loss);
}

/// Hertz (Johnson 1985, 4.26 to 4.28): unlike curvatures, an ellipse of contact.
TEST(HalfSpaceContact, HertzOfAnEllipse)
{
   const double a = 1.5, b = 0.8, p0 = 0.05, E = 2, nu = 0.25, modulus = E / (1 - nu * nu),
                k = std::sqrt(1 - b * b / (a * a)), K = std::comp_ellint_1(k),
                L = std::comp_ellint_2(k), unit = p0 / modulus;
   const double along = unit * b / (a * a) * (K - L) / (k * k),
                across = unit * b / (a * a) * (a * a / (b * b) * L - K) / (k * k),
                P = 2.0 / 3 * p0 * M_PI * a * b, approach = unit * b * K;
   HalfSpace contact = contact_of({E, nu}, {}, 1, cells(23, 1, 11.2));
   contact.size = {2 * a / 19, 2 * b / 19};
   contact.centres = contact.centres * contact.size.asDiagonal();
   const VectorXd x = contact.centres.col(0), y = contact.centres.col(1);
   const ReducedProblem problem =
      contact.problem(along * x.cwiseAbs2() + across * y.cwiseAbs2());
   ContactState state = ContactState::virgin(problem); // no friction
   ASSERT_EQ(marched(problem, {{}, {{"P", P}}}, state).status, FrictionStatus::converged);
   EXPECT_NEAR(conjugate(problem, state, "P") / approach, 1, 2e-3);
   cattaneo_test::record("approach", conjugate(problem, state, "P") / approach);
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      const double r = std::hypot(x[i] / a, y[i] / b);
      const double p = state.p[i] / problem.weights[i];
      if (r < 0.8) { EXPECT_NEAR(p, p0 * std::sqrt(1 - r * r), 1e-2 * p0) << r; }
      EXPECT_FALSE(r > 1.1 && p > 0) << r;
   }
}

/** Torsion of two equal spheres (Lubkin 1951), the closed form that
    HalfSpace.HertzAndLubkinOfTwoHalfSpaces holds the axisymmetric path against. Normal and
    tangential directions are uncoupled, so that any ν is exact. */
TEST(HalfSpaceContact, Lubkin)
{
   const double nu = 0.3, R = 5, a = 0.7, f = 0.3, G = 1.5,
                P = 8.0 / 3 * G / (1 - nu) / 2 * a * a * a / R;
   const double edge = 2 * a / 15, c = 0.4, m = 1 - c * c / (a * a), k = std::sqrt(m);
   HalfSpace contact =
      contact_of(of_shear(G, nu), of_shear(G, nu), edge, cells(19, edge, a + 1.5 * edge));
   contact.turns = true;
   ReducedProblem problem = contact.problem(contact.centres.rowwise().squaredNorm() / (2 * R));
   set_friction(problem, f);
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
   ContactState state = ContactState::virgin(problem);
   const NamedLoads pressed{{"P", P}}, twisted{{"P", P}, {"T", torque}};
   ASSERT_EQ(marched(problem, {{}, pressed, twisted}, state).status, FrictionStatus::converged);
   EXPECT_NEAR(conjugate(problem, state, "P") / (a * a / R), 1, 2e-3);
   // Under the middle, which torsion leaves as it is (Johnson 1985, 3.45): a cell of the rim is
   // far from there.
   const double p0 = 1.5 * P / (M_PI * a * a);
   for (const double z : {0.2, 0.7, 1.5})
   {
      const double d = z / a, vertical = -1 / (1 + d * d),
                   along = -(1 + nu) * (1 - d * std::atan(1 / d)) + 0.5 / (1 + d * d);
      const Eigen::RowVectorXd stress =
         contact.stresses(Eigen::RowVector3d(0, 0, z), state.forces()).row(0) / p0;
      EXPECT_NEAR(stress[2], vertical, 2e-3) << z;
      EXPECT_NEAR(stress[0], along, 2e-3) << z;
      EXPECT_NEAR(stress[1], along, 2e-3) << z;
   }
   EXPECT_NEAR(conjugate(problem, state, "T") / turn, 1, 1e-2);
   EXPECT_NEAR(std::sqrt(number_of(state, NodeState::stick) * edge * edge / M_PI), c,
               0.5 * edge);
   EXPECT_NEAR(conjugate(problem, state, "Q1"), 0, 1e-9 * a * turn);
   cattaneo_test::record("turn", conjugate(problem, state, "T") / turn);
   // It spins at 3π f P a/16.
   FrictionSolver solver(problem);
   VectorXd loads = VectorXd::Zero(4);
   loads[problem.pattern("P")] = P;
   for (const auto &[share, status] :
        {std::pair(0.99, FrictionStatus::converged), {1.01, FrictionStatus::gross_sliding}})
   {
      loads[problem.pattern("T")] = share * 3 * M_PI / 16 * f * P * a;
      EXPECT_EQ(solver.solve(state, loads).status, status) << share;
   }
}

/// Turned by a right angle, mirrored, numbered otherwise, in other units, or with the bodies
/// exchanged, a coupled contact has the same answer.
TEST(HalfSpaceContact, NothingDependsOnTheFrame)
{
   const Index m = 7;
   HalfSpace contact = contact_of(of_shear(1, 0.1), of_shear(6, 0.3), 0.2, cells(m, 0.2, 9));
   contact.size = {0.2, 0.25};
   contact.centres.col(1) *= 1.25;
   contact.turns = true;
   const Index n = contact.centres.rows();
   const VectorXd x = contact.centres.col(0), y = contact.centres.col(1);
   const VectorXd gap =
      0.3 * x.array().square() + 0.2 * (y.array() - 0.1).square() + 0.1 * x.array() * y.array();
   const double P = 0.6, Q1 = 0.1, Q2 = -0.07, T = 0.01;
   struct Answer
   {
      VectorXd p, q1, q2;
      Eigen::Vector4d moved; // approach, shifts, turn
   };
   const auto answer =
      [&](const HalfSpace &of, const VectorXd &gaps, double q1, double q2, double torque)
   {
      ReducedProblem problem = of.problem(gaps);
      set_friction(problem, 0.4);
      ContactState state = ContactState::virgin(problem);
      const NamedLoads pressed{{"P", P}};
      const NamedLoads sheared{{"P", P}, {"Q1", q1}, {"Q2", q2}, {"T", torque}};
      EXPECT_EQ(marched(problem, {{}, pressed, sheared}, state, 4).status,
                FrictionStatus::converged);
      EXPECT_GT(number_of(state, NodeState::slip), 5);
      EXPECT_GT(number_of(state, NodeState::stick), 5);
      EXPECT_GT(number_of(state, NodeState::separation), 5);
      const VectorXd q = state.q, moved = conjugates(problem, state);
      const auto of_load = [&](const char *load) { return moved[problem.pattern(load)]; };
      return Answer{state.p, q.head(n), q.tail(n),
                    Eigen::Vector4d(of_load("P"), of_load("Q1"), of_load("Q2"), of_load("T"))};
   };
   const Answer first = answer(contact, gap, Q1, Q2, T);
   // Increments are solved to 1e-12 of the largest force; a flexible far body multiplies it.
   const auto same = [&](const Answer &other, const VectorXd &p, const VectorXd &q1,
                         const VectorXd &q2, const Eigen::Vector4d &moved)
   {
      EXPECT_LT((other.p - p).norm() + (other.q1 - q1).norm() + (other.q2 - q2).norm(),
                1e-9 * first.p.norm());
      EXPECT_LT((other.moved - moved).norm(), 1e-9 * moved.norm());
   };
   const auto [approach, shift1, shift2, turn] =
      std::tuple(first.moved[0], first.moved[1], first.moved[2], first.moved[3]);

   HalfSpace turned = contact;
   turned.centres << -y, x;
   turned.size = contact.size.reverse();
   same(answer(turned, gap, -Q2, Q1, T), first.p, -first.q2, first.q1,
        {approach, -shift2, shift1, turn});

   HalfSpace mirrored = contact;
   mirrored.centres.col(0) *= -1;
   same(answer(mirrored, gap, -Q1, Q2, -T), first.p, -first.q1, first.q2,
        {approach, -shift1, shift2, -turn});

   HalfSpace exchanged = contact;
   std::swap(exchanged.material, *exchanged.other);
   same(answer(exchanged, gap, -Q1, -Q2, -T), first.p, -first.q1, -first.q2,
        {approach, -shift1, -shift2, -turn});

   std::vector<int> order(static_cast<std::size_t>(n));
   std::iota(order.begin(), order.end(), 0);
   std::shuffle(order.begin(), order.end(), std::mt19937(3));
   HalfSpace renumbered = contact;
   renumbered.centres = contact.centres(order, Eigen::all).eval();
   same(answer(renumbered, gap(order), Q1, Q2, T), first.p(order), first.q1(order),
        first.q2(order), first.moved);

   // Lengths in thousandths, moduli in millionths: forces keep their numbers, torques do not.
   HalfSpace fine = contact;
   fine.centres *= 1e3;
   fine.size *= 1e3;
   fine.material.young *= 1e-6;
   fine.other->young *= 1e-6;
   same(answer(fine, 1e3 * gap, Q1, Q2, 1e3 * T), first.p, first.q1, first.q2,
        {1e3 * approach, 1e3 * shift1, 1e3 * shift2, turn});

   // A state goes on where it was left.
   ReducedProblem problem = contact.problem(gap);
   set_friction(problem, 0.4);
   const std::vector<NamedLoads> points{{}, {{"P", P}}, {{"P", P}, {"Q1", Q1}, {"Q2", Q2}}};
   ContactState whole = ContactState::virgin(problem), parts = whole;
   marched(problem, points, whole, 2);
   marched(problem, {points[0], points[1]}, parts, 2);
   marched(problem, points, parts, 2);
   EXPECT_EQ(whole.q, parts.q);
}

/// The rim of 5 × 5 cells is the outer 16, that of a column of two is both. Contact that is
/// pressed there is said to be cut off, once in a march, unless a body ends there.
TEST(HalfSpaceContact, ContactAtTheRimIsCutOff)
{
   HalfSpace contact = contact_of({1, 0.3}, {}, 0.1, cells(5, 0.1, 1));
   const VectorXd gap = contact.centres.rowwise().squaredNorm() / 2;
   ReducedProblem problem = contact.problem(gap);
   EXPECT_EQ(problem.rim.size(), 16u);
   for (const Index node : problem.rim)
   {
      EXPECT_NEAR(contact.centres.row(node).cwiseAbs().maxCoeff(), 0.2, 1e-12);
   }
   set_friction(problem, 0.3);
   ContactState state = ContactState::virgin(problem);
   EXPECT_TRUE(marched(problem, {{}, {{"P", 1e-3}}}, state).cut_off.empty());
   EXPECT_GT(number_closed(state), 0);
   state = ContactState::virgin(problem);
   const MarchReport report =
      marched(problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q1", 0.1}}}, state, 2);
   ASSERT_EQ(report.cut_off.size(), 1u);
   EXPECT_EQ(report.cut_off[0].chain, -1);
   EXPECT_NE(report.cut_off[0].message().find("up to the rim of its surface"),
             std::string::npos);
   contact.ends = true;
   problem = contact.problem(gap);
   EXPECT_TRUE(problem.rim.empty());
   problem.rim = {25};
   expect_input_error([&] { problem.validate(); }, "node 25 of the rim, must be from 0 to 24");
   contact.ends = false;
   contact.centres = contact.centres.topRows(2).eval();
   EXPECT_EQ(contact.problem(gap.head(2)).rim.size(), 2u);
}

/// A force along x at one place, and a pressure at another: r × F by hand.
TEST(HalfSpaceContact, ResultantOfTwoForces)
{
   const HalfSpace contact = contact_of({1, 0.3}, {}, 0.5, cells(2, 0.5, 1));
   VectorXd forces = VectorXd::Zero(12);
   forces[3] = 2;     // along x at (0.25, 0.25)
   forces[4 + 1] = 7; // along y at (0.25, -0.25)
   forces[8] = 5;     // a pressure at (-0.25, -0.25)
   Eigen::Matrix<double, 6, 1> expected;
   expected << 2, 7, 5, -0.25 * 5, 0.25 * 5, 0.25 * 7 - 0.25 * 2;
   EXPECT_LT((contact.resultant(forces) - expected).norm(), 1e-14);
   expect_input_error([&] { contact.resultant(forces.head(8)); }, "8 nodal forces, must be 12");
}

/// ½ f (p₀ + p₁)|Δv| and -½(q₀ + q₁)·Δv are one where slip keeps its direction; where it turns
/// the second is less, and balances the energy: work of the loads less that of friction and of
/// pressures is what the bodies store.
TEST(HalfSpaceContact, WorkOfFrictionBalancesTheEnergy)
{
   ReducedProblem problem = kalkers_spence(1.3);
   ContactState state = ContactState::virgin(problem);
   const double P = 2.37e-3, Q = 0.2 * P;
   const auto energy = [&]
   {
      const VectorXd u = state.displacements(), loads = state.multipliers;
      return 0.5 * u.dot(problem.K * u) + 0.5 * loads.dot(problem.H * loads);
   };
   double before = 0, normal = 0;
   ContactState last = state;
   MarchSettings settings;
   settings.increments = 4;
   const MarchReport report = march(
      problem,
      LoadHistory::through(
         problem, {{}, {{"P", P}}, {{"P", P}, {"Q1", Q}}, {{"P", P}, {"Q1", 0}, {"Q2", Q}}}),
      state, settings,
      [&](const ContactState &at, const IncrementRecord &record)
      {
         normal -= 0.5 * (at.p + last.p).dot(at.w - last.w);
         last = at;
         EXPECT_LE(record.friction_work, record.dissipation * (1 + 1e-12));
      });
   ASSERT_EQ(report.status, FrictionStatus::converged);
   double work = 0, friction = 0, lost = 0;
   for (const IncrementRecord &each : report.increments)
   {
      work += each.external_work;
      friction += each.friction_work;
      lost += each.dissipation;
   }
   EXPECT_NEAR(work - friction - normal, energy() - before, 1e-11 * work);
   EXPECT_LT(friction, lost);
   EXPECT_GT(friction, 0.5 * lost);
}

/// A sphere under more shear than friction holds slides where the shear is f P, in any
/// direction, also of a load that turns. Along one line that is found without a failed
/// increment.
TEST(HalfSpaceContact, SlidesAtTheLimitOfFriction)
{
   ReducedProblem problem = kalkers_spence(1.3);
   const double P = 2.37e-3, limit = 0.2986 * P;
   const auto slides = [&](const NamedLoads &last)
   {
      ContactState state = ContactState::virgin(problem);
      const MarchReport report = marched(
         problem, {{}, {{"P", P}}, {{"P", P}, {"Q1", 0.5 * limit}, {"Q2", 0}}, last}, state, 2);
      EXPECT_EQ(report.status, FrictionStatus::gross_sliding);
      const VectorXd loads = report.event_multipliers;
      EXPECT_NEAR(std::hypot(loads[problem.pattern("Q1")], loads[problem.pattern("Q2")]), limit,
                  1e-7 * limit);
      return report.counters.rejected_increments;
   };
   EXPECT_EQ(slides({{"P", P}, {"Q1", 1.3 * limit}, {"Q2", 0}}), 0);
   slides({{"P", P}, {"Q1", 0.5 * limit}, {"Q2", 1.3 * limit}});
}

TEST(HalfSpaceContact, SaysWhatItCannotTake)
{
   const HalfSpace good = contact_of({1, 0.3}, {}, 0.1, cells(3, 0.1, 1));
   const VectorXd gap = VectorXd::Zero(9);
   const auto refused = [&](const std::function<void(HalfSpace &)> &change, const char *part)
   {
      HalfSpace bad = good;
      change(bad);
      expect_input_error([&] { bad.problem(gap); }, part);
   };
   EXPECT_NO_THROW(good.problem(gap));
   expect_input_error([&] { good.problem(gap.head(8)); },
                      "8 gaps, must be 9, one for each rectangle");
   refused(
      [](HalfSpace &bad) {
         bad.other = Material{1, 0.3, PlaneState::stress};
      },
      "plane stress, must be of plane strain");
   refused([](HalfSpace &bad) { bad.size[1] = 0; }, "(0.1, 0), must be positive");
   refused([](HalfSpace &bad) { bad.centres(4, 0) += 0.01; }, "rectangle 4 is (0.01, 0)");
   refused([](HalfSpace &bad) { bad.centres.row(4) = bad.centres.row(2); }, "is there twice");
   refused([](HalfSpace &bad) { bad.centres.resize(0, 2); },
           "neither rectangles nor triangles");
   refused([](HalfSpace &bad) { bad.centres(0, 0) = NAN; }, "not finite");
   HalfSpace one = good;
   one.centres = Places::Zero(1, 2);
   expect_input_error([&] { one.problem(VectorXd::Zero(1)); },
                      "there is one rectangle, must be at least two");
   expect_input_error([&] { good.displacements(Places::Zero(1, 2), gap); }, "27");
   ReducedProblem problem = good.problem(gap);
   const ContactState virgin = ContactState::virgin(problem);
   EXPECT_EQ(contact_areas(problem, virgin).contact.nodes,
             0); // without load nothing is pressed
   problem.weights.resize(0);
   expect_input_error([&] { contact_areas(problem, virgin); }, "no weights");
}

/// Steps of 2 and 3 µm, heights in nanometres: a plane, which is met everywhere.
TEST(Heights, AreThoseOfTheFile)
{
   const std::string file = testing::TempDir() + "surface.sdf";
   const auto written = [&](const std::string &header, const std::string &data)
   {
      std::ofstream(file) << header << data;
      return read_heights(file, 1e-6);
   };
   const std::string header = "aBCR-1.0\nManufacID   = none\nNumPoints   = 3\nNumProfiles = 2\n"
                              "Xscale      = 2.00e-006\nYscale      = 3.00e-006\n"
                              "Zscale      = 1.00e-009\nZresolution = -1\n*\n";
   const Heights heights = written(header, " 100 110 120\n 130\n140 150 \n*\nby hand\n");
   Places points(3, 2);
   points << -2, -1.5, 0.7, 1.2, 2, 1.5;
   const VectorXd z = heights.at(points);
   for (Index i = 0; i < 3; ++i)
   {
      EXPECT_NEAR(z[i], 1e-3 * (125 + 5 * points(i, 0) + 10 * points(i, 1)), 1e-15);
   }
   expect_input_error([&] { heights.at(Places::Constant(1, 2, 1.6)); }, "|y| <= 1.5");
   expect_input_error([&] { written(header, "1 2 3 4 5"); }, "there are 5 heights, must be");
   expect_input_error([&] { written(header, "1 2 3 4 5 six"); }, "'six' is not a number");
   expect_input_error([&] { written("aBCR-1.0\nNumPoints = 3\n*\n", ""); }, "has no Xscale");
   expect_input_error([&] { written("bBCR-1.0", ""); }, "its first line must be");
   expect_input_error([&] { read_heights(file + ".none"); }, "surface.sdf.none");
   const Heights holed = written(header, "1 2 3 4 5 BAD");
   EXPECT_NO_THROW(holed.at(Places::Constant(1, 2, -0.1)));
   expect_input_error([&] { holed.at(Places::Constant(1, 2, 0.1)); }, "was not measured");
}

} // namespace
