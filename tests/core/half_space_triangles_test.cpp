#include "expect_input_error.hpp"
#include "half_space_contacts.hpp"

#include <algorithm>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <record.hpp>

// Contact of half-spaces in three dimensions, tractions uniform on triangles: against point
// forces, published integrals, closed solutions, rectangles, and invariances.

namespace
{

using namespace cattaneo;
using cattaneo_test::conjugate;
using cattaneo_test::disc_of_triangles;
using cattaneo_test::marched;
using cattaneo_test::mean_square;
using cattaneo_test::number_of;
using cattaneo_test::of_shear;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Polygon skew{{0.1, -0.2}, {0.9, 0.1}, {0.3, 0.6}};

/// Boussinesq and Cerruti: displacements at a point of the surface by a force at its origin
/// (Johnson 1985, 3.19 and 3.75), columns: forces along x, y and z.
Matrix3d by_force(double G, double nu, const Vector2d &way)
{
   const double r = way.norm(), odd = (1 - 2 * nu) / (r * r);
   Matrix3d u = 2 * (1 - nu) / r * Matrix3d::Identity();
   u.topLeftCorner<2, 2>() += 2 * nu / (r * r * r) * way * way.transpose();
   u.topRightCorner<2, 1>() = -odd * way;
   u.bottomLeftCorner<1, 2>() = odd * way.transpose();
   return u / (4 * M_PI * G);
}

/// ∫ f over a triangle by Gauss's rule in both parameters of rays from its first corner, which
/// cancel a singularity of 1/r there.
template <class Value, class Function>
Value by_rays(const Polygon &triangle, const Value &zero, const Function &f)
{
   const QuadratureRule &rule = gauss_rule(64);
   Value sum = zero;
   const Vector2d a = triangle[1] - triangle[0], b = triangle[2] - triangle[1];
   const double twice = a[0] * b[1] - a[1] * b[0];
   for (Index i = 0; i < 64; ++i)
   {
      for (Index j = 0; j < 64; ++j)
      {
         const double along = rule.points[i];
         sum += rule.weights[i] * rule.weights[j] * along * twice *
                f(triangle[0] + along * (a + rule.points[j] * b));
      }
   }
   return sum;
}

HalfSpace of_triangle(const Material &material, const Polygon &triangle)
{
   HalfSpace contact;
   contact.material = material;
   contact.vertices.resize(3, 2);
   for (Index k = 0; k < 3; ++k)
   {
      contact.vertices.row(k) = triangle[static_cast<std::size_t>(k)];
   }
   contact.triangles.resize(1, 3);
   contact.triangles << 0, 1, 2;
   return contact;
}

TEST(HalfSpaceTriangles, DisplacementsAreThoseOfPointForces)
{
   const double G = 2, nu = 0.2;
   const HalfSpace contact = of_triangle(of_shear(G, nu), skew);
   const double area = contact.areas()[0];
   EXPECT_NEAR(area, (0.8 * 0.8 - 0.3 * 0.2) / 2, 1e-15);
   EXPECT_LT((contact.middles().row(0) - Eigen::RowVector2d(1.3 / 3, 0.5 / 3)).norm(), 1e-15);
   Eigen::MatrixX2d points(4, 2);
   points << 0.4, 0.2, 0.5, 0.1, 1.2, 0.9, -5, 3; // two within, two outside
   for (const Vector2d point : points.rowwise())
   {
      // Triangles from the point to each side, of either sign.
      Matrix3d expected = Matrix3d::Zero();
      for (std::size_t k = 0; k < 3; ++k)
      {
         expected +=
            by_rays({point, skew[k], skew[(k + 1) % 3]}, Matrix3d(Matrix3d::Zero()),
                    [&](const Vector2d &from) { return by_force(G, nu, point - from); });
      }
      expected /= area;
      for (Index k = 0; k < 3; ++k)
      {
         const VectorXd moved =
            contact.displacements(point.transpose(), VectorXd::Unit(3, k)).row(0).transpose();
         EXPECT_LT((moved - expected.col(k)).norm(), 1e-12 * expected.norm()) << point;
      }
   }
}

/// Two triangles make a rectangle, whose own stresses are checked against point forces. Then
/// one of them alone bears its traction at the surface.
TEST(HalfSpaceTriangles, StressesOfTwoAreThoseOfTheirRectangle)
{
   HalfSpace rectangle;
   rectangle.material = of_shear(2, 0.2);
   rectangle.other = of_shear(5, 0.4);
   rectangle.size = {0.7, 0.3};
   rectangle.centres = Eigen::RowVector2d(0.2, -0.1);
   HalfSpace two = rectangle;
   two.centres.resize(0, 2);
   two.vertices.resize(4, 2);
   two.vertices << -0.15, -0.25, 0.55, -0.25, 0.55, 0.05, -0.15, 0.05;
   two.triangles.resize(2, 3);
   two.triangles << 0, 1, 2, 3, 0, 2;
   Eigen::MatrixX3d points(5, 3);
   points << 0.3, -0.05, 0.4, 1.3, -0.2, -0.3, -0.4, 0.9, 1e-3, 40, -3, 7, -2, -1.5, -0.6;
   const Vector3d force(0.3, -0.2, 0.5);
   VectorXd halves(6);
   halves << 0.15, 0.15, -0.1, -0.1, 0.25, 0.25;
   const MatrixXd expected = rectangle.stresses(points, force),
                  found = two.stresses(points, halves);
   for (Index i = 0; i < 5; ++i)
   {
      EXPECT_LT((found.row(i) - expected.row(i)).norm(), 1e-12 * expected.row(i).norm()) << i;
   }
   VectorXd first(6);
   first << 0.3, 0, -0.2, 0, 0.5, 0;
   Eigen::MatrixX3d surface(2, 3);
   surface << 0.3, -0.2, 0, 0.1, 0.02, 0; // within the first triangle, within the other one
   const auto at = two.stresses(surface, first);
   const double area = 0.7 * 0.3 / 2;
   EXPECT_LT((at.row(0).segment(2, 3) - Eigen::RowVector3d(-0.5, 0.2, -0.3) / area).norm(),
             1e-13 / area);
   EXPECT_LT(at.row(1).segment(2, 3).norm(), 1e-13 / area);
   Eigen::Matrix<double, 6, 1> sum;
   sum << 0.3, -0.2, 0.5, -0.15 * 0.5, -0.95 / 3 * 0.5, -0.95 / 3 * 0.2 + 0.15 * 0.3;
   EXPECT_LT((two.resultant(first) - sum).norm(), 1e-15);
}

VectorXd values(const KernelIntegrals &I)
{
   VectorXd all(5);
   all << static_cast<double>(I.xx), static_cast<double>(I.yy), static_cast<double>(I.xy),
      static_cast<double>(I.x), static_cast<double>(I.y);
   return all;
}

/// The mean potential of a triangle on itself [Eibert and Hansen 1995]: ∫∫ 1/r is
/// -4/3 A² Σ ln(1 - 2a/(a + b + c))/a. Of a square of edge 1 it is 4 (ln(1 + √2) + (1 - √2)/3).
TEST(HalfSpaceTriangles, PublishedIntegrals)
{
   const auto potential = [](const Polygon &of)
   {
      const KernelIntegrals I = integrals_over(of, of);
      EXPECT_NEAR(static_cast<double>(I.x), 0, 1e-15);
      EXPECT_NEAR(static_cast<double>(I.y), 0, 1e-15);
      return static_cast<double>(I.xx + I.yy);
   };
   EXPECT_NEAR(potential({{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
               4 * (std::asinh(1) + (1 - std::sqrt(2.0)) / 3), 1e-14);
   double around = 0, sum = 0;
   for (std::size_t k = 0; k < 3; ++k) { around += (skew[k] - skew[(k + 1) % 3]).norm(); }
   for (std::size_t k = 0; k < 3; ++k)
   {
      const double edge = (skew[k] - skew[(k + 1) % 3]).norm();
      sum -= std::log(1 - 2 * edge / around) / edge;
   }
   EXPECT_NEAR(potential(skew), 4.0 / 3 * area(skew) * area(skew) * sum, 1e-14);
}

/// Of two triangles: Gauss's rule over the first one of what the second one does at its points,
/// where they are apart. Those that touch or overlap: the sum over the parts of both, whatever
/// the kernel is. Some edges are parallel, or nearly so, and some lie on one line.
TEST(HalfSpaceTriangles, IntegralsOverTwoTriangles)
{
   const auto moved = [](const Polygon &triangle, double x, double y, double turn = 0)
   {
      Polygon result;
      for (const Vector2d &each : triangle)
      {
         result.emplace_back(x + std::cos(turn) * each[0] - std::sin(turn) * each[1],
                             y + std::sin(turn) * each[0] + std::cos(turn) * each[1]);
      }
      return result;
   };
   // Apart: also at both sides of the distance from which a rule stands for the closed form.
   for (const Polygon &other :
        {moved(skew, 1.5, 0.2), moved(skew, -1, 1.2, 0.7), moved(skew, -0.9, -1.1, 1e-7),
         moved(skew, 3.6, 0, 2.2), moved(skew, 4.2, 0, M_PI), moved(skew, 3, -4, -1.1),
         moved(skew, -40, 7, 0.3)})
   {
      VectorXd expected =
         by_rays(other, VectorXd(VectorXd::Zero(5)),
                 [&](const Vector2d &point) { return values(integrals_at(point, skew)); });
      const VectorXd found = values(integrals_over(other, skew)),
                     back = values(integrals_over(skew, other));
      EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm()) << other[0];
      expected.tail(2) *= -1; // these kernels are odd
      EXPECT_LT((back - expected).norm(), 1e-10 * expected.norm()) << other[0];
   }
   const auto parts = [](const Polygon &of)
   {
      const Vector2d a = (of[0] + of[1]) / 2, b = (of[1] + of[2]) / 2, c = (of[2] + of[0]) / 2;
      return std::vector<Polygon>{{of[0], a, c}, {a, of[1], b}, {c, b, of[2]}, {a, b, c}};
   };
   for (const Polygon &other :
        {skew, Polygon{skew[1], skew[0], {0.5, -0.9}}, moved(skew, 0.2, 0.1, 0.1),
         Polygon{skew[2], {-1, 1}, {-1, 0.5}}, moved(skew, 1e-3, 0, 1e-5)})
   {
      VectorXd sum = VectorXd::Zero(5);
      for (const Polygon &first : parts(other))
      {
         for (const Polygon &second : parts(skew))
         {
            sum += values(integrals_over(first, second));
         }
      }
      EXPECT_LT((values(integrals_over(other, skew)) - sum).norm(), 1e-11 * sum.norm())
         << other[2];
   }
}

struct Sheared
{
   double approach, shift, unloading, loss; ///< shares of the closed forms
};

/// Cattaneo's and Mindlin's spheres of ν = 0, as in sheared_spheres(): radius of contact 1, on
/// a disc of triangles of radius 1.15.
Sheared sheared(int rings)
{
   const double f = 0.3, s = 0.9, R = 10, P = 4.0 / 3 / R, Q = s * f * P;
   const double full = 3 * f * P / 16 * (2 + 2);
   const auto shift = [&](double share) { return full * (1 - std::pow(1 - share, 2.0 / 3)); };
   const double loss =
      4 * Q * shift(s) - 8 * f * P * full * (s - 0.6 * (1 - std::pow(1 - s, 5.0 / 3)));
   const HalfSpace contact = disc_of_triangles(of_shear(1, 0), of_shear(1, 0), rings, 1.15);
   ReducedProblem problem = contact.problem(mean_square(contact) / (2 * R));
   set_friction(problem, f);
   ContactState state = ContactState::virgin(problem);
   const NamedLoads pressed{{"P", P}, {"Q1", 0}}, there{{"P", P}, {"Q1", Q}},
      back{{"P", P}, {"Q1", -Q}};
   std::vector<NamedLoads> way{{}};
   const auto go = [&](const NamedLoads &loads)
   {
      way.push_back(loads);
      EXPECT_EQ(marched(problem, way, state).status, FrictionStatus::converged);
   };
   Sheared result{};
   go(pressed);
   result.approach = conjugate(problem, state, "P") * R;
   const ContactAreas closed = contact_areas(problem, state);
   EXPECT_NEAR(closed.contact.area, M_PI, closed.contact.error);
   go(there);
   result.shift = conjugate(problem, state, "Q1") / shift(s);
   const ContactAreas areas = contact_areas(problem, state);
   EXPECT_NEAR(areas.stick.area, M_PI * std::pow(1 - s, 2.0 / 3), areas.stick.error);
   const RadialEdges edges = radial_edges(problem, state);
   EXPECT_NEAR(edges.contact.radius, 1, edges.contact.error);
   EXPECT_NEAR(edges.stick.radius, std::cbrt(1 - s), edges.stick.error);
   const double width = 1.15 / rings; // of a ring: whole triangles of it are in or out
   EXPECT_LT(edges.contact.error, width);
   EXPECT_LT(edges.stick.error, width);
   const double first = state.dissipation;
   go(pressed);
   result.unloading = conjugate(problem, state, "Q1") / (shift(s) - 2 * shift(s / 2));
   go(back);
   go(there);
   result.loss = (state.dissipation - first) / loss;
   return result;
}

/// What whole triangles leave of the outline falls with their area, as it does with rectangles.
TEST(HalfSpaceTriangles, HertzCattaneoMindlin)
{
   for (const int rings : {5, 10})
   {
      const Sheared spheres = sheared(rings);
      const double share = 1.15 * 1.15 / (6 * rings * rings); // of a triangle in the contact
      EXPECT_NEAR(spheres.approach, 1, share / 2);
      EXPECT_NEAR(spheres.shift, 1, share / 2);
      // These hang on few triangles at the edge of stick.
      EXPECT_NEAR(spheres.unloading, 1, 4 * share);
      EXPECT_NEAR(spheres.loss, 1, 4 * share);
      if (rings < 10) { continue; }
      cattaneo_test::record("approach", spheres.approach);
      cattaneo_test::record("shift", spheres.shift);
      cattaneo_test::record("loss", spheres.loss);
   }
}

/// Turned by any angle, mirrored, its triangles and vertices numbered otherwise and their
/// corners in the other sense, in other units, or with the bodies exchanged, a coupled contact
/// has the same answer. A state goes on where it was left.
TEST(HalfSpaceTriangles, NothingDependsOnTheFrame)
{
   HalfSpace contact = disc_of_triangles(of_shear(1, 0.1), of_shear(6, 0.3), 4, 1.2);
   contact.turns = true;
   const Index n = contact.nodes();
   const Eigen::MatrixX2d middle = contact.middles();
   const VectorXd x = middle.col(0), y = middle.col(1);
   const VectorXd gap = 0.09 * x.array().square() + 0.06 * (y.array() - 0.1).square() +
                        0.03 * x.array() * y.array();
   const double P = 0.25, Q1 = 0.04, Q2 = -0.03, T = 0.004;
   struct Answer
   {
      VectorXd p, q1, q2;
      Eigen::Vector4d moved; // approach, shifts, turn
   };
   const auto answer =
      [&](const HalfSpace &of, const VectorXd &gaps, const Vector2d &q, double torque)
   {
      ReducedProblem problem = of.problem(gaps);
      set_friction(problem, 0.4);
      ContactState state = ContactState::virgin(problem);
      const NamedLoads pressed{{"P", P}};
      const NamedLoads sheared{{"P", P}, {"Q1", q[0]}, {"Q2", q[1]}, {"T", torque}};
      EXPECT_EQ(marched(problem, {{}, pressed, sheared}, state, 4).status,
                FrictionStatus::converged);
      EXPECT_GT(number_of(state, NodeState::slip), 5);
      EXPECT_GT(number_of(state, NodeState::stick), 5);
      EXPECT_GT(number_of(state, NodeState::separation), 5);
      return Answer{
         state.p, state.q.head(n), state.q.tail(n),
         Eigen::Vector4d(conjugate(problem, state, "P"), conjugate(problem, state, "Q1"),
                         conjugate(problem, state, "Q2"), conjugate(problem, state, "T"))};
   };
   const Answer first = answer(contact, gap, {Q1, Q2}, T);
   // Increments are solved to 1e-12 of the largest force; a flexible far body multiplies it.
   const auto same = [&](const Answer &other, const VectorXd &p, const VectorXd &q1,
                         const VectorXd &q2, const Eigen::Vector4d &moved)
   {
      EXPECT_LT((other.p - p).norm() + (other.q1 - q1).norm() + (other.q2 - q2).norm(),
                1e-8 * first.p.norm());
      EXPECT_LT((other.moved - moved).norm(), 1e-8 * moved.norm());
   };
   const auto [approach, shift1, shift2, turn] =
      std::tuple(first.moved[0], first.moved[1], first.moved[2], first.moved[3]);

   // By 0.7: the rule of far triangles turns with them.
   const double c = std::cos(0.7), s = std::sin(0.7);
   HalfSpace turned = contact;
   turned.vertices << c * contact.vertices.col(0) - s * contact.vertices.col(1),
      s * contact.vertices.col(0) + c * contact.vertices.col(1);
   same(answer(turned, gap, {c * Q1 - s * Q2, s * Q1 + c * Q2}, T), first.p,
        c * first.q1 - s * first.q2, s * first.q1 + c * first.q2,
        {approach, c * shift1 - s * shift2, s * shift1 + c * shift2, turn});

   HalfSpace mirrored = contact;
   mirrored.vertices.col(0) *= -1;
   same(answer(mirrored, gap, {-Q1, Q2}, -T), first.p, -first.q1, first.q2,
        {approach, -shift1, shift2, -turn});

   HalfSpace exchanged = contact;
   std::swap(exchanged.material, *exchanged.other);
   same(answer(exchanged, gap, {-Q1, -Q2}, -T), first.p, -first.q1, -first.q2,
        {approach, -shift1, -shift2, -turn});

   std::vector<int> order(static_cast<std::size_t>(n));
   std::iota(order.begin(), order.end(), 0);
   std::shuffle(order.begin(), order.end(), std::mt19937(3));
   HalfSpace renumbered = contact;
   const int last = static_cast<int>(contact.vertices.rows()) - 1;
   renumbered.vertices = contact.vertices.colwise().reverse();
   renumbered.triangles = last - contact.triangles(order, std::vector{2, 0, 1}).array();
   renumbered.triangles.topRows(9) = renumbered.triangles.topRows(9).rowwise().reverse().eval();
   same(answer(renumbered, gap(order), {Q1, Q2}, T), first.p(order), first.q1(order),
        first.q2(order), first.moved);

   // Lengths in thousandths, moduli in millionths: forces keep their numbers, torques do not.
   HalfSpace fine = contact;
   fine.vertices *= 1e3;
   fine.material.young *= 1e-6;
   fine.other->young *= 1e-6;
   same(answer(fine, 1e3 * gap, {Q1, Q2}, 1e3 * T), first.p, first.q1, first.q2,
        {1e3 * approach, 1e3 * shift1, 1e3 * shift2, turn});

   ReducedProblem problem = contact.problem(gap);
   set_friction(problem, 0.4);
   const std::vector<NamedLoads> points{{}, {{"P", P}}, {{"P", P}, {"Q1", Q1}, {"Q2", Q2}}};
   ContactState whole = ContactState::virgin(problem), parts = whole;
   marched(problem, points, whole, 2);
   marched(problem, {points[0], points[1]}, parts, 2);
   marched(problem, points, parts, 2);
   EXPECT_EQ(whole.q, parts.q);
}

/// ½ ∮ x dy - y dx
double enclosed(const Eigen::MatrixX2d &line)
{
   double twice = 0;
   for (Index k = 1; k < line.rows(); ++k)
   {
      twice += line(k - 1, 0) * line(k, 1) - line(k, 0) * line(k - 1, 1);
   }
   return twice / 2;
}

/// A ring of cells has an outer and an inner outline, cells that touch with a corner one each.
TEST(HalfSpaceTriangles, Outlines)
{
   const HalfSpace squares =
      cattaneo_test::contact_of({1, 0.3}, {}, 0.1, cattaneo_test::cells(3, 0.1, 1));
   std::vector<bool> ring(9, true);
   ring[4] = false;
   std::vector<Eigen::MatrixX2d> lines = squares.outlines(ring);
   ASSERT_EQ(lines.size(), 2u);
   EXPECT_NEAR(enclosed(lines[0]), 0.09, 1e-15);
   EXPECT_NEAR(enclosed(lines[1]), -0.01, 1e-15); // clockwise
   EXPECT_EQ(lines[0].rows(), 13);
   EXPECT_EQ(lines[0].row(0), lines[0].row(12));
   const std::vector<bool> diagonal{true, false, false, false, true, false, false, false, true};
   lines = squares.outlines(diagonal);
   ASSERT_EQ(lines.size(), 3u);
   for (const Eigen::MatrixX2d &line : lines)
   {
      EXPECT_EQ(line.rows(), 5);
      EXPECT_NEAR(enclosed(line), 0.01, 1e-15);
   }
   EXPECT_TRUE(squares.outlines(std::vector<bool>(9)).empty());
   expect_input_error([&] { squares.outlines(std::vector<bool>(8)); }, "8 values, must be 9");

   // Some triangles run clockwise.
   HalfSpace disc = disc_of_triangles({1, 0.3}, {}, 3, 1);
   disc.triangles.topRows(20) = disc.triangles.topRows(20).rowwise().reverse().eval();
   std::vector<bool> annulus(54, true);
   std::fill_n(annulus.begin(), 6, false);
   lines = disc.outlines(annulus);
   ASSERT_EQ(lines.size(), 2u);
   EXPECT_EQ(std::max(lines[0].rows(), lines[1].rows()), 19);
   EXPECT_EQ(std::min(lines[0].rows(), lines[1].rows()), 7);
   EXPECT_NEAR(enclosed(lines[0]) + enclosed(lines[1]), disc.areas().tail(48).sum(), 1e-14);
}

TEST(HalfSpaceTriangles, SaysWhatItCannotTake)
{
   const HalfSpace good = disc_of_triangles({1, 0.3}, {}, 2, 1);
   const auto refused = [&](const std::function<void(HalfSpace &)> &change, const char *part)
   {
      HalfSpace bad = good;
      change(bad);
      expect_input_error([&] { bad.problem(VectorXd::Zero(24)); }, part);
   };
   EXPECT_EQ(good.problem(VectorXd::Zero(24)).rim.size(), 12u); // one on each of twelve edges
   expect_input_error([&] { good.problem(VectorXd::Zero(8)); },
                      "8 gaps, must be 24, one for each triangle");
   refused([](HalfSpace &bad) { bad.centres.resize(2, 2); }, "2 rectangles and 24 triangles");
   refused([](HalfSpace &bad) { bad.triangles(3, 1) = 19; }, "vertex 19, must be from 0 to 18");
   refused([](HalfSpace &bad) { bad.triangles(3, 1) = bad.triangles(3, 0); }, "has no area");
   refused([](HalfSpace &bad) { bad.vertices(3, 1) = NAN; }, "not finite");
   refused([](HalfSpace &bad) { bad.triangles.row(3) = bad.triangles.row(1); },
           "triangles 1 and 3 lie on the same side of their common edge");
   refused(
      [](HalfSpace &bad)
      {
         // The same place by vertices of its own.
         const auto k = bad.vertices.rows();
         bad.vertices.conservativeResize(k + 3, 2);
         for (Index i = 0; i < 3; ++i)
         {
            bad.vertices.row(k + i) = bad.vertices.row(bad.triangles(3, i));
            bad.triangles(4, i) = static_cast<int>(k + i);
         }
      },
      "the triangles 3 and 4 lie on each other");
   refused([](HalfSpace &bad) { bad.triangles.resize(0, 3); },
           "neither rectangles nor triangles");
}

} // namespace
