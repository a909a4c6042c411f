#include "common/disc_scene.hpp"

#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <record.hpp>

// Axisymmetric contact with a half-space and its torsion, against closed solutions.

namespace
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Grid
{
   int order = 2;
   int elements = 16; ///< of the contact 0 < r < 1, of equal size
   double edge = 0;   ///< if not 0: elements of this size at r = 1, growing away from it
   double poisson = 0.3, young = 1.0, length = 1.0;
};

/// Half-space under a contact of radius `length`, held at 10⁵ times that. The far boundary of
/// the axisymmetric one can be moved up: pattern "approach".
struct HalfSpace
{
   mfem::Mesh mesh;
   ElasticBody body;
   CondensedBody condensed;

   static mfem::Mesh make(const Grid &grid)
   {
      const double first = grid.edge > 0 ? grid.edge : 1.0 / grid.elements;
      std::vector<double> contact =
         graded(1, 0, first, grid.edge > 0 ? 1.25 : 1.0, std::max(first, 0.1));
      std::reverse(contact.begin(), contact.end());
      std::vector<double> depth = graded(0, 1, first, 1.25);
      for (double &r : contact) { r *= grid.length; }
      for (double &z : depth) { z *= grid.length; }
      return half_space_mesh(contact, depth, ring_scales(1.0, 1e5, first, 1.25));
   }
   HalfSpace(const Grid &grid, Formulation formulation)
      : mesh(make(grid)), body(mesh, grid.order, {grid.young, grid.poisson}, formulation)
   {
      const BoundaryPart far({3, 4});
      body.fix(far, 0);
      if (formulation == Formulation::axisymmetric)
      {
         body.add_displacement("approach", far, 1, 1.0);
      }
      condensed = condense(body, contact_line(body, 1));
   }
};

/// Indentation by a flat punch over its closed solution: frictionless (P = 2 E* a δ), bonded
/// (P = 4 G a δ ln(3-4ν)/(1-2ν), Mossakovskii), and twisted (T = 16/3 G a³ φ, Reissner and
/// Sagoci), each minus one.
Eigen::Array3d punch_errors(const Grid &grid)
{
   const HalfSpace pressed(grid, Formulation::axisymmetric),
      twisted(grid, Formulation::torsion);
   const CondensedBody &body = pressed.condensed, &torsion = twisted.condensed;
   const Index n = body.line.size();
   const MatrixXd A = body.S.topLeftCorner(n, n), B = body.S.bottomLeftCorner(n, n),
                  C = body.S.bottomRightCorner(n, n);
   const VectorXd w = VectorXd::Constant(n, grid.length),
                  r = body.line.each(&LineNode::position).col(0);
   const double nu = grid.poisson, G = grid.young / (2 * (1 + nu)), a = grid.length;
   const double bonded = (C * w).sum();
   const VectorXd coupling = B.transpose() * w;
   const double smooth = bonded - coupling.dot(A.llt().solve(coupling)) / a;
   const double torque = r.dot(torsion.S * r);
   return {smooth / (2 * grid.young / (1 - nu * nu) * a * a) - 1,
           bonded / (4 * G * a * a * std::log(3 - 4 * nu) / (1 - 2 * nu)) - 1,
           torque / (16.0 / 3 * G * a * a * a) - 1};
}

TEST(HalfSpace, FlatPunchesConvergeWithTheSpacing)
{
   for (int order : {2, 3})
   {
      Grid grid;
      grid.order = order;
      grid.elements = 8;
      const Eigen::Array3d coarse = punch_errors(grid);
      grid.elements = 16;
      const Eigen::Array3d fine = punch_errors(grid);
      for (int k = 0; k < 3; ++k)
      {
         // Elements at a singular edge: O(h) from above, whatever their order.
         EXPECT_NEAR(std::log2(coarse[k] / fine[k]), 1, 0.1) << order << k;
         EXPECT_NEAR(2 * fine[k] - coarse[k], 0, 1e-3);
      }
   }
   Grid graded_to_edge;
   graded_to_edge.order = 3;
   graded_to_edge.edge = 5e-4;
   const Eigen::Array3d errors = punch_errors(graded_to_edge);
   for (double error : errors) { EXPECT_NEAR(error, 0, 1e-4); }
   cattaneo_test::record("smooth", 1 + errors[0]);
   cattaneo_test::record("bonded", 1 + errors[1]);
   cattaneo_test::record("twisted", 1 + errors[2]);
}

TEST(HalfSpace, StiffnessScalesWithTheUnits)
{
   for (auto formulation : {Formulation::axisymmetric, Formulation::torsion})
   {
      Grid grid;
      grid.elements = 8;
      const HalfSpace one(grid, formulation);
      grid.length = 1e-9;
      grid.young = 2.1e11;
      const HalfSpace other(grid, formulation);
      const MatrixXd S = other.condensed.S / (grid.length * grid.young);
      EXPECT_LT((S - one.condensed.S).cwiseAbs().maxCoeff(),
                1e-11 * one.condensed.S.cwiseAbs().maxCoeff());
   }
}

struct Hertz
{
   double radius = 0.7, sphere = 5;
   Grid grid;
   double E = 1 / (1 - 0.09), approach = radius * radius / sphere;
   double p0 = 2 * E * radius / (M_PI * sphere);
   double load = 4.0 / 3 * E * std::pow(radius, 3) / sphere;
   VectorXd r, p; ///< tractions
   double total = 0, found_radius = 0, axis_overlap = 0;

   explicit Hertz(int order, int elements)
   {
      grid.order = order;
      grid.elements = elements;
      HalfSpace space(grid, Formulation::axisymmetric);
      Reduction reduction =
         reduce(space.condensed, [&](double x, double) { return x * x / (2 * sphere); });
      const ReducedProblem &problem = reduction.problem;
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      const VectorXd multiplier = VectorXd::Constant(1, approach);
      EXPECT_EQ(solver.solve(state, multiplier).status, FrictionStatus::converged);
      EXPECT_EQ(solver.counters().tangential_unknowns, 0);
      r = problem.position.col(0);
      p = tractions(problem, state.p);
      total = state.p.sum();
      // The line of a body below runs to the axis.
      const double end = problem.arc_length[0];
      found_radius = 1 + end - contact_zone(problem, state).from.position;
      const VectorXd u = reduction.displacement(0, state.v, state.w, multiplier);
      const mfem::DenseMatrix &x = space.body.node_coordinates();
      for (int node = 0; node < x.Width(); ++node)
      {
         // The sphere's lowest point does not move: the surface's must stay at or below it.
         if (x(0, node) == 0 && x(1, node) == 0)
         {
            axis_overlap = u(space.body.true_dof(node, 1));
         }
      }
   }
};

TEST(HalfSpace, HertzIndentation)
{
   const Hertz fine(2, 32);
   EXPECT_NEAR(fine.total / fine.load, 1, 2e-4);
   EXPECT_NEAR(fine.found_radius, fine.radius, 0.05 / 64);
   cattaneo_test::record("load", fine.total / fine.load);
   cattaneo_test::record("radius", fine.found_radius / fine.radius);
   for (Index i = 0; i < fine.r.size(); ++i)
   {
      const double x = fine.r[i] / fine.radius;
      if (x < 0.8) { EXPECT_NEAR(fine.p[i] / fine.p0, std::sqrt(1 - x * x), 1.5e-3); }
   }
}

/// The axis node is no contact node: what that costs.
TEST(HalfSpace, TheFreeAxisNodeStaysWithTheContact)
{
   for (int order : {2, 3})
   {
      const Hertz coarse(order, 8), fine(order, 16);
      const auto pressure_error = [](const Hertz &hertz)
      {
         const Index first = hertz.p.size() - 1;
         const double x = hertz.r[first] / hertz.radius;
         return std::abs(hertz.p[first] / hertz.p0 - std::sqrt(1 - x * x));
      };
      // O(h³), and the pressure of the first node is as good as that of the others.
      EXPECT_LT(std::abs(fine.axis_overlap), std::abs(coarse.axis_overlap) / 6);
      EXPECT_LT(std::abs(fine.axis_overlap), 1e-4 * fine.approach);
      EXPECT_LT(pressure_error(fine), 1e-3);
   }
}

/// Frictionless layer on a half-space, by a Hankel integral equation (STUDIES D): the limit of
/// large discs, which they approach with 1/b².
TEST(AxisymmetricReceding, LargeDiscsReachTheLayer)
{
   const double exact[] = {1.8079, 2.0381, 2.7930}, radii[] = {8, 12};
   double found[2][3];
   for (int k : {0, 1})
   {
      miniapp::DiscOptions options;
      options.disc_radius = radii[k];
      options.load_radii = {0.5, 1, 2};
      options.spacing = 0.04;
      miniapp::Scene scene = miniapp::make_disc(options);
      EXPECT_EQ(scene.reduction.counters.assemblies, 1); // of the disc, and nothing twists
      EXPECT_EQ(scene.reduction.problem.components(), 1);
      FrictionSolver solver(scene.reduction.problem);
      for (int a = 0; a < 3; ++a)
      {
         ContactState state = ContactState::virgin(scene.reduction.problem);
         ASSERT_EQ(solver.solve(state, VectorXd::Unit(3, a)).status, FrictionStatus::converged);
         found[k][a] = contact_zone(scene.reduction.problem, state).to.position;
      }
      EXPECT_EQ(solver.counters().tangential_unknowns, 0);
   }
   for (int a = 0; a < 3; ++a)
   {
      const double share = radii[0] * radii[0] / (radii[1] * radii[1]);
      const double limit = (found[1][a] - share * found[0][a]) / (1 - share);
      // A tenth of the spacing.
      EXPECT_NEAR(limit, exact[a], 0.004);
      cattaneo_test::record(std::string("radius_") + "012"[a], limit);
   }
}

/// A large disc that is bonded is part of the half-space: Love's (1929) stresses at depth t
/// under a uniform pressure, by their Hankel integrals.
TEST(AxisymmetricReceding, BondedDiscCarriesLovesStresses)
{
   miniapp::DiscOptions options;
   options.disc_radius = 10;
   options.load_radii = {2.1};
   const miniapp::Scene scene = miniapp::make_disc(options);
   const ReducedProblem &problem = scene.reduction.problem;
   const VectorXd p = tractions(problem, problem.patterns[0].p),
                  q = tractions(problem, problem.patterns[0].q);
   const double a = 2.1;
   double worst = 0;
   int compared = 0;
   for (Index i = 10; i < problem.nodes(); i += 25)
   {
      const double r = problem.position(i, 0);
      if (r > 4) { break; } // further out the shear feels the rim: 1e-3 of its peak
      double normal = 0, shear = 0;
      const double step = 0.02;
      for (double k = 0.5 * step; k < 40; k += step)
      {
         const double weight = a * std::exp(-k) * std::cyl_bessel_j(1, k * a) * step;
         normal += (1 + k) * weight * std::cyl_bessel_j(0, k * r);
         shear += k * weight * std::cyl_bessel_j(1, k * r);
      }
      ++compared;
      worst = std::max({worst, std::abs(p[i] - normal), std::abs(q[i] + shear)});
      EXPECT_NEAR(p[i], normal, 2e-4) << r;
      // The half-space pulls the disc's underside inward.
      EXPECT_NEAR(q[i], -shear, 2e-4) << r;
   }
   EXPECT_GT(compared, 7);
   cattaneo_test::record("largest_difference", worst);
}

/// However the disc is turned, the bonded contact carries the torque.
TEST(AxisymmetricReceding, TorqueOfTheContactIsThatOfTheTwist)
{
   using miniapp::Twist;
   for (Twist twist : {Twist::top, Twist::loaded, Twist::rim, Twist::traction})
   {
      miniapp::DiscOptions options;
      options.spacing = 0.1;
      options.twist = twist;
      const miniapp::Scene scene = miniapp::make_disc(options);
      const ReducedProblem &problem = scene.reduction.problem;
      ASSERT_EQ(problem.components(), 2);
      EXPECT_EQ(scene.reduction.counters.assemblies, 2);
      const LoadPattern &pattern = problem.patterns.back();
      const Index n = problem.nodes();
      // Friction, or the bond, holds the disc back.
      const double torque = -pattern.q.tail(n).dot(problem.position.col(0));
      const bool rotation = pattern.control == Control::displacement;
      EXPECT_EQ(rotation, twist != Twist::traction);
      EXPECT_NEAR(torque, rotation ? problem.H(1, 1) : 1.0, 1e-10 * torque);
   }
}

void expect_disc_of_studies_d(miniapp::DiscOptions options)
{
   options.load_radii = {0.5, 2.1, 2.5, 3.75, 4.25, 4.7};
   miniapp::Scene scene = miniapp::make_disc(options);
   ReducedProblem &problem = scene.reduction.problem;
   const Index n = problem.nodes();

   // Bonded: what the clamped contact carries.
   const double r[] = {0.5, 1, 2, 3, 4}, bonded[] = {0.9088, 0.8618, 0.4829, 0.07621, 0.01505};
   const VectorXd t = tractions(problem, problem.patterns[1].p);
   int found = 0;
   for (Index i = 0; i < n; ++i)
   {
      for (int k = 0; k < 5; ++k)
      {
         if (std::abs(problem.position(i, 0) - r[k]) > 1e-9) { continue; }
         ++found;
         EXPECT_NEAR(t[i], bonded[k], 2e-4);
      }
   }
   EXPECT_EQ(found, 5);
   const double adhesion[] = {1.69, 1.07, 0.600};
   for (int k = 0; k < 3; ++k)
   {
      const LoadPattern &pattern = problem.patterns[3 + k];
      const Index inner = n - 4; // the last nodes at the corner of 270° never converge
      EXPECT_NEAR(
         (pattern.q.head(inner).cwiseAbs().array() / pattern.p.head(inner).array()).maxCoeff(),
         adhesion[k], 0.005);
   }

   const auto solved = [&](double friction, int pattern)
   {
      set_friction(problem, friction);
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      EXPECT_EQ(solver.solve(state, VectorXd::Unit(6, pattern)).status,
                FrictionStatus::converged);
      return state;
   };
   const auto separation = [&](const ContactState &state)
   { return contact_zone(problem, state).to.position; };
   const auto stick = [&](const ContactState &state)
   { return widest_zone(zones(problem, state), NodeState::stick).to.position; };
   const ContactState smooth = solved(0.0, 2);
   EXPECT_NEAR(separation(smooth), 3.1705, 0.001);
   EXPECT_NEAR(smooth.p.sum(), M_PI * 2.5 * 2.5, 1e-10);
   EXPECT_NEAR(0.5 * smooth.p.dot(problem.position.col(0)), 17.106, 0.001); // T_s
   const ContactState half = solved(0.5, 2), most = solved(0.8, 2), small = solved(0.9, 0);
   EXPECT_NEAR(separation(half), 3.728, 0.002);
   EXPECT_NEAR(stick(half), 1.879, 0.002);
   EXPECT_NEAR(separation(most), 4.046, 0.002);
   EXPECT_NEAR(stick(most), 2.384, 0.002);
   EXPECT_NEAR(separation(small), 2.625, 0.002);
   EXPECT_NEAR(stick(small), 0.849, 0.002);
}

/// The cylinder that the references are of, and the half-space itself.
TEST(AxisymmetricReceding, DiscOfStudiesD)
{
   miniapp::DiscOptions options;
   options.domain = 100;
   expect_disc_of_studies_d(options);
   options.domain = 0;
   // The quotient of tractions where both are small asks for it.
   options.spacing = 0.01;
   expect_disc_of_studies_d(options);
}

} // namespace
