#include "expect_input_error.hpp"

#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cmath>
#include <gtest/gtest.h>

// Inside of a half-plane without a mesh, against closed solutions.

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Point = HalfPlaneField::Point;

HalfPlane half_plane(PlaneState state = PlaneState::strain)
{
   HalfPlane body;
   body.material = {2, 0.3, state};
   body.depth = 30;
   return body;
}

/// A uniform pressure (component 1) or shear (0) on -1 < x < 1, on the body's own line.
VectorXd uniform(const ContactLine &line, int component)
{
   const Index n = line.size();
   VectorXd forces = VectorXd::Zero(2 * n);
   forces.segment(component * n, n) = line.each(&LineNode::weight);
   return forces;
}

const std::vector<double> uneven_grid{-1, -0.9, 0.2, 0.25, 1};

TEST(HalfPlaneField, StressesUnderAUniformPressureAndShear)
{
   const HalfPlane body = half_plane(); // below y = 0, its tangent runs against x
   for (const int order : {1, 3})
   {
      const ContactLine line = condense(body, straight_line(uneven_grid, order)).line;
      const HalfPlaneField pressed(body, line, uniform(line, 1)),
         sheared(body, line, uniform(line, 0));
      for (const double x : {-3.0, -0.9, 0.0, 0.3, 0.99, 1.4})
      {
         for (const double z : {1e-3, 0.1, 1.0, 5.0})
         {
            // Johnson, Contact Mechanics, 2.5: tan θ = z/(x ∓ a), z the depth.
            const double one = std::atan2(z, x - 1), two = std::atan2(z, x + 1);
            const Point p = pressed.at({x, -z});
            EXPECT_NEAR(p.xx,
                        -(2 * (one - two) + std::sin(2 * one) - std::sin(2 * two)) / (2 * M_PI),
                        1e-11);
            EXPECT_NEAR(p.yy,
                        -(2 * (one - two) - std::sin(2 * one) + std::sin(2 * two)) / (2 * M_PI),
                        1e-11);
            // With y upwards, shear has the other sign than with the depth.
            EXPECT_NEAR(p.xy, -(std::cos(2 * one) - std::cos(2 * two)) / (2 * M_PI), 1e-11);
            // A shear q along +x, of which the forces along the tangent are the opposite.
            const double r = std::log(std::hypot(x - 1, z) / std::hypot(x + 1, z));
            const Point q = sheared.at({x, -z});
            EXPECT_NEAR(q.xx, -(4 * r - std::cos(2 * one) + std::cos(2 * two)) / (2 * M_PI),
                        1e-11);
            EXPECT_NEAR(q.yy, -(std::cos(2 * one) - std::cos(2 * two)) / (2 * M_PI), 1e-11);
            EXPECT_NEAR(q.xy,
                        -(2 * (one - two) + std::sin(2 * one) - std::sin(2 * two)) / (2 * M_PI),
                        1e-11);
         }
      }
      // On the surface, where the tractions are.
      EXPECT_NEAR(pressed.at({0.1, 0}).yy, -1, 1e-8);
      EXPECT_NEAR(pressed.at({0.1, 0}).xx, -1, 1e-8);
      EXPECT_NEAR(sheared.at({0.1, 0}).xy, -1, 1e-8);
      EXPECT_NEAR(pressed.at({1.5, 0}).yy, 0, 1e-8);
   }
}

/// Displacements have the strains of the stresses, are those of the stiffness on the surface,
/// and nothing at the depth that they are relative to.
TEST(HalfPlaneField, DisplacementsFitTheStresses)
{
   for (const PlaneState state : {PlaneState::strain, PlaneState::stress})
   {
      HalfPlane body = half_plane(state);
      body.normal = Vector2d(3, -4) / 5; // any way round
      body.point = {0.4, 2};
      const CondensedBody condensed = condense(body, uneven_grid, 2);
      const Index n = condensed.line.size();
      VectorXd forces(2 * n);
      for (Index i = 0; i < 2 * n; ++i) { forces[i] = std::cos(3.0 * i) + 0.5; }
      const HalfPlaneField field(body, condensed.line, forces);
      const double h = 1e-4, G = body.material.mu(), lambda = body.material.lambda();
      const Vector2d along(-0.8, -0.6);
      for (const double s : {-1.2, 0.05, 0.7})
      {
         const Vector2d x = body.point + s * along + 0.3 * body.normal;
         const auto slope = [&](const Vector2d &axis)
         {
            return ((field.at(x + h * axis).displacement -
                     field.at(x - h * axis).displacement) /
                    (2 * h))
               .eval();
         };
         const Vector2d dx = slope({1, 0}), dy = slope({0, 1});
         const Point at = field.at(x);
         EXPECT_NEAR(at.xx, lambda * (dx[0] + dy[1]) + 2 * G * dx[0], 1e-5);
         EXPECT_NEAR(at.yy, lambda * (dx[0] + dy[1]) + 2 * G * dy[1], 1e-5);
         EXPECT_NEAR(at.xy, G * (dx[1] + dy[0]), 1e-5);
      }
      // The work of the forces is that of the tractions on the displacements of the surface.
      const VectorXd u = condensed.S.llt().solve(forces);
      const HalfPlaneField even(body, condensed.line, uniform(condensed.line, 1));
      const VectorXd sunk = condensed.S.llt().solve(uniform(condensed.line, 1));
      double work = 0;
      const int points = 4000;
      for (int k = 0; k < points; ++k)
      {
         const double s = -1 + (2.0 * k + 1) / points;
         work += even.at(body.point + s * along).displacement.dot(body.normal) * 2 / points;
      }
      EXPECT_NEAR(work / uniform(condensed.line, 1).dot(sunk), 1, 1e-6);
   }
   HalfPlane body = half_plane();
   const std::vector<double> narrow{-1e-4, 1e-4};
   const ContactLine line = condense(body, narrow, 1).line;
   for (const int component : {0, 1})
   {
      const HalfPlaneField field(body, line, uniform(line, component));
      EXPECT_NEAR(field.at({0, -body.depth}).displacement.norm(), 0, 1e-9);
   }
}

TEST(HalfPlaneField, HertzPressedAndSheared)
{
   const double R = 3, f = 0.4, share = 0.6, P = M_PI / (8 * R) * 2 / (1 - 0.09);
   HalfPlane lower = half_plane(), upper = lower;
   upper.normal = {0, 1};
   upper.forces = {{"P", {0, -P}}, {"Q", {P, 0}}};
   std::vector<double> grid;
   for (int e = 0; e <= 120; ++e) { grid.push_back(-1.2 + 0.02 * e); }
   Reduction reduction = reduce(condense(upper, grid, 2), lower);
   ReducedProblem &problem = reduction.problem;
   problem.gap = problem.position.col(0).cwiseAbs2() / (2 * R);
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, Vector2d(1, 0)).status, FrictionStatus::converged);
   ASSERT_EQ(solver.solve(state, Vector2d(1, share * f)).status, FrictionStatus::converged);
   const double p0 = 2 * P / M_PI;
   // The field in the specimen below. Forces in its frames are those of the pad in reverse
   // order.
   const HalfPlaneField field(
      lower, reduction.bodies[1].line,
      (VectorXd(2 * problem.nodes()) << state.q.reverse(), state.p.reverse()).finished());
   for (const double x : {-1.3, -0.8, 0.0, 0.5, 1.0})
   {
      for (const double y : {0.1, 0.5, 2.0})
      {
         const fretting::InPlaneStress exact = fretting::hertz_stress(f, share, x, y);
         const Point at = field.at({x, -y});
         EXPECT_NEAR(at.xx / p0, exact.xx, 3e-3) << x << " " << y;
         EXPECT_NEAR(at.yy / p0, exact.yy, 3e-3) << x << " " << y;
         EXPECT_NEAR(at.xy / p0, -exact.xy, 3e-3) << x << " " << y; // y is a depth there
      }
   }
}

/// A bulk stress: uniform, with the strains of Hooke's law, turned with the surface.
TEST(HalfPlaneField, BulkStressIsUniform)
{
   for (const PlaneState state : {PlaneState::strain, PlaneState::stress})
   {
      HalfPlane body = half_plane();
      body.material.state = state;
      body.point = {0.3, 2};
      const double nu = body.material.poisson, E = body.material.young, stress = 1.5,
                   zz = state == PlaneState::strain ? nu * stress : 0;
      for (const bool upright : {false, true})
      {
         if (upright) { body.normal = {1, 0}; }
         ContactLine line = straight_line({-1, 0, 1}, 2);
         for (LineNode &node : line.nodes)
         {
            node.position =
               body.point + (upright ? Vector2d(0, node.position[0]) : node.position);
            if (upright) { node.tangent = {0, -1}; }
         }
         for (auto &element : line.chains[0].elements)
         {
            for (Index a = 0; a < element.points.cols(); ++a)
            {
               const double x = element.points(0, a);
               element.points.col(a) = body.point + (upright ? Vector2d(0, x) : Vector2d(x, 0));
            }
         }
         const HalfPlaneField field(body, line, VectorXd::Zero(2 * line.size()), stress);
         const Vector2d from = upright ? Vector2d(0.5, 0.2) : Vector2d(0.2, -0.5);
         const Point at = field.at(body.point + from);
         const int along = upright ? 1 : 0;
         EXPECT_NEAR(along ? at.yy : at.xx, stress, 1e-14);
         EXPECT_NEAR(along ? at.xx : at.yy, 0, 1e-14);
         EXPECT_NEAR(at.xy, 0, 1e-14);
         EXPECT_NEAR(at.displacement[along], (stress - nu * zz) / E * from[along], 1e-14);
         EXPECT_NEAR(at.displacement[1 - along], -nu * (stress + zz) / E * from[1 - along],
                     1e-14);
      }
   }
   const ContactLine line = condense(half_plane(), {0.0, 1.0}, 1).line;
   expect_input_error([&] { HalfPlaneField(half_plane(), line, VectorXd::Zero(4), NAN); },
                      "the bulk stress is nan, must be finite");
}

TEST(HalfPlaneField, APlaneOfSymmetryIsAMirror)
{
   HalfPlane whole = half_plane(), half = whole;
   half.symmetric = true;
   const ContactLine all = condense(whole, straight_line({-2, -1, 0, 1, 2}, 2)).line,
                     right = condense(half, straight_line({0, 1, 2}, 2)).line;
   const Index n = right.size();
   VectorXd own(2 * n), both = VectorXd::Zero(2 * all.size());
   for (Index i = 0; i < n; ++i)
   {
      const double x = right.nodes[i].position[0];
      own[i] = x == 0 ? 0 : std::sin(3 + x);
      own[n + i] = std::cos(2 * x);
      for (Index k = 0; k < all.size(); ++k)
      {
         if (std::abs(std::abs(all.nodes[k].position[0]) - x) > 1e-12) { continue; }
         const double side = all.nodes[k].position[0] < 0 ? -1 : 1;
         both[k] = side * own[i];
         both[all.size() + k] = x == 0 ? 2 * own[n + i] : own[n + i];
      }
   }
   const HalfPlaneField a(whole, all, both), b(half, right, own);
   for (const Vector2d &x : {Vector2d(0, -1), Vector2d(0.7, -0.2), Vector2d(-1.1, -0.4)})
   {
      const Point p = a.at(x), q = b.at(x);
      EXPECT_LT((p.displacement - q.displacement).norm(), 1e-12);
      EXPECT_NEAR(p.xx, q.xx, 1e-12);
      EXPECT_NEAR(p.yy, q.yy, 1e-12);
      EXPECT_NEAR(p.xy, q.xy, 1e-12);
   }
}

TEST(HalfPlaneField, BadInputIsNamed)
{
   const HalfPlane body = half_plane();
   const ContactLine line = condense(body, uneven_grid, 2).line;
   const HalfPlaneField field(body, line, uniform(line, 1));
   expect_input_error([&] { field.at({0, 0.1}); }, "(0, 0.1) is above its surface");
   expect_input_error([&] { HalfPlaneField(body, line, VectorXd::Ones(3)); },
                      "there are 3 forces, must be finite and two for each of the 9 nodes");
   const ContactLine round =
      condense(body, std::vector<double>{0, 1}, 2, Formulation::axisymmetric).line;
   expect_input_error([&] { HalfPlaneField(body, round, VectorXd::Ones(4)); }, "must be plane");
}

} // namespace
