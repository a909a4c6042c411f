#include "expect_input_error.hpp"
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

// Half-planes without a mesh: symmetry, other bodies over them, forces far away and what is
// refused.

namespace
{

using namespace cattaneo;
using cattaneo_test::below;
using cattaneo_test::depth;
using cattaneo_test::even;
using cattaneo_test::half_plane;
using cattaneo_test::uneven;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Half a line beside a plane of symmetry behaves as the whole line does in symmetric motions.
TEST(HalfPlane, APlaneOfSymmetryIsHalfOfTheWhole)
{
   const int order = 3;
   const std::vector<double> half{-3, -1.2, -1, -0.1, 0};
   std::vector<double> whole = half;
   for (std::size_t k = half.size() - 1; k-- > 0;) { whole.push_back(-half[k]); }
   HalfPlane body = half_plane(2, 0.1);
   body.point = {7, 0.5};
   const auto shifted = [&](const std::vector<double> &grid, double turn)
   {
      ContactLine line = straight_line(grid, order);
      if (turn < 0) // the other side of the plane
      {
         std::vector<double> other;
         for (auto x = grid.rbegin(); x != grid.rend(); ++x) { other.push_back(-*x); }
         line = straight_line(other, order);
      }
      for (LineNode &node : line.nodes) { node.position += body.point; }
      for (LineElement &element : line.chains[0].elements)
      {
         element.points.colwise() += body.point;
      }
      return line;
   };
   const CondensedBody all = condense(body, shifted(whole, 1));
   body.symmetric = true;
   for (const double side : {1.0, -1.0})
   {
      const CondensedBody part = condense(body, shifted(half, side));
      const Index n = part.line.size(), N = all.line.size();
      ASSERT_EQ(N, 2 * n - 1);
      const Index middle = side > 0 ? 0 : n - 1; // the line below runs against x
      EXPECT_EQ(part.held, std::vector<int>{static_cast<int>(middle)});
      EXPECT_EQ(part.line.chains[0].ends[side > 0 ? 0 : 1], LineEnd::symmetry);
      EXPECT_EQ(part.S.row(middle).norm(), 0);
      // Node i of the part at its place in the whole, and mirrored.
      MatrixXd T = MatrixXd::Zero(2 * N, 2 * n);
      for (Index i = 0; i < n; ++i)
      {
         const Index at = side > 0 ? n - 1 + i : i, mirror = N - 1 - at;
         T(N + at, n + i) = T(N + mirror, n + i) = 1;
         if (i == middle) { continue; }
         T(at, i) = 1;
         T(mirror, i) = -1;
      }
      const MatrixXd both = T.transpose() * all.S * T;
      EXPECT_LT((both - 2 * part.S).cwiseAbs().maxCoeff(),
                1e-11 * part.S.cwiseAbs().maxCoeff());
   }
}

/// A pin-jointed frame of one row of cells over the nodes of a line, held by nothing.
CondensedBody frame(const std::vector<double> &x, double push, double height = 1)
{
   const auto n = static_cast<int>(x.size());
   MatrixXd K = MatrixXd::Zero(4 * n, 4 * n);
   AssembledBody body;
   body.places = {VectorXd(4 * n), VectorXd(4 * n), {}, Formulation::plane};
   for (int dof = 0; dof < 4 * n; ++dof)
   {
      const int point = dof / 2;
      body.places.x[dof] = x[point % n];
      body.places.y[dof] = point / n * height;
      body.places.component.push_back(dof % 2);
   }
   for (int p = 0; p < 2 * n; ++p)
   {
      for (int q = p + 1; q < 2 * n; ++q)
      {
         if (std::abs(p % n - q % n) > 1) { continue; }
         const Eigen::Vector2d along(body.places.x[2 * q] - body.places.x[2 * p],
                                     body.places.y[2 * q] - body.places.y[2 * p]);
         const Eigen::Vector4d stretch =
            (Eigen::Vector4d() << -along, along).finished() / along.norm();
         const std::vector<int> dofs{2 * p, 2 * p + 1, 2 * q, 2 * q + 1};
         K(dofs, dofs) += (1 + 0.1 * p) * stretch * stretch.transpose();
      }
   }
   body.K = SharedMatrix(Eigen::SparseMatrix<double, Eigen::RowMajor>(K.sparseView()));
   VectorXd load = VectorXd::Zero(4 * n);
   for (int i = n; i < 2 * n; ++i)
   {
      load.segment<2>(2 * i) << 0.3 * push, -push * (1 + 0.2 * i);
   }
   body.loads = {{"P", Control::force, load}};
   return condense(body, straight_line(x, 1));
}

/// A free body that is pressed by forces knows nothing of where the half-plane's displacements
/// vanish.
TEST(HalfPlane, ForcedContactDoesNotKnowTheDepth)
{
   HalfPlane body = half_plane(2, 0.1);
   const CondensedBody free = frame({-1, -0.4, 0, 0.7, 1.5}, 1);
   const Reduction shallow = reduce(free, body);
   body.depth = 1e5;
   const Reduction deep = reduce(free, body);
   const ReducedProblem &one = shallow.problem, &other = deep.problem;
   one.validate();
   const double unit = one.K.cwiseAbs().maxCoeff();
   EXPECT_LT((one.K - other.K).cwiseAbs().maxCoeff(), 1e-12 * unit);
   EXPECT_LT((one.patterns[0].q - other.patterns[0].q).norm(), 1e-12);
   EXPECT_LT((one.patterns[0].p - other.patterns[0].p).norm(), 1e-12);
   EXPECT_EQ(one.rigid_motions.cols(), 3);
   EXPECT_NEAR(one.patterns[0].p.sum(), 5 + 0.2 * (5 + 6 + 7 + 8 + 9), 1e-12);
   EXPECT_EQ(one.gap.norm(), 0);
   // The load itself goes down with the half-plane: 2/πE' ln(D₂/D₁) of its resultant.
   const double P = one.patterns[0].p.sum(), Q = one.patterns[0].q.sum();
   const double modulus = 2 / (1 - 0.01);
   EXPECT_NEAR(other.H(0, 0) - one.H(0, 0),
               2 / (M_PI * modulus) * std::log(1e5 / depth) * (P * P + Q * Q), 1e-10);
}

/// A drawn curve over the half-plane: the gap is its height, and the pairing is by the places
/// along the surface.
TEST(HalfPlane, CurvedLineOverIt)
{
   for (const double unit : {1.0, 1e-9}) // of lengths
   {
      std::vector<double> grid = {-1, -0.4, 0, 0.7, 1.5};
      for (double &x : grid) { x *= unit; }
      CondensedBody drawn = frame(grid, 1, unit);
      const MatrixXd flat = reduce(drawn, half_plane(2, 0.1)).problem.K;
      const auto lift = [=](double x) { return 0.01 * x * x / unit; };
      for (LineNode &node : drawn.line.nodes) { node.position[1] = lift(node.position[0]); }
      for (LineElement &element : drawn.line.chains[0].elements)
      {
         for (Index a = 0; a < 2; ++a) { element.points(1, a) = lift(element.points(0, a)); }
      }
      const Reduction reduction = reduce(drawn, half_plane(2, 0.1));
      const ReducedProblem &problem = reduction.problem;
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         EXPECT_NEAR(problem.gap[i], lift(problem.position(i, 0)), 1e-15 * unit);
      }
      EXPECT_LT((problem.K - flat).cwiseAbs().maxCoeff(), 1e-12 * flat.cwiseAbs().maxCoeff());
      // The nodes of its surface run the other way. Their spacing is the distance of the nearer
      // neighbour.
      const std::vector<double> spacing = {0.8, 0.7, 0.4, 0.4, 0.6};
      for (std::size_t k = 0; k < 5; ++k)
      {
         EXPECT_NEAR(reduction.bodies.back().line.nodes[k].spacing, spacing[k] * unit,
                     1e-12 * unit);
      }
   }
}

/// The same by forces from far away: a half-plane that no support holds.
TEST(HalfPlane, FarForcesPressAndShear)
{
   const double nu = 0.3, R = 3, a = 1, f = 0.4, c = 0.6, P = M_PI * a * a / (8 * R);
   const int elements = 80; // of -1.5 < x < 1.5
   HalfPlane upper = half_plane(1 - nu * nu, nu), lower = upper;
   upper.normal = {0, 1};
   upper.forces = {{"P", {0, -P}}, {"Q", {P, 0}}};
   for (const bool turned : {false, true}) // the lower one is loaded, and bodies change places
   {
      if (turned)
      {
         upper.normal = {0, -1};
         lower.normal = {0, 1};
         upper.forces = {{"P", {0, P}}, {"Q", {P, 0}}};
      }
      const CondensedBody loaded = condense(upper, even(-1.5, 1.5, elements), 2);
      // What moves freely meets no resistance, and the clamped contact holds the loads.
      EXPECT_LT((loaded.S * loaded.free_motions).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_NEAR(loaded.patterns[0].p.sum(), P, 1e-14);
      EXPECT_NEAR(std::abs(loaded.patterns[1].q.sum()), P, 1e-14);
      ReducedProblem problem = reduce(loaded, lower).problem;
      const Index n = problem.nodes();
      // With one material pressure moves nothing along the contact, even if one body is free.
      EXPECT_FALSE(problem.coupled);
      HalfPlane other = lower;
      other.material.poisson = 0.2;
      EXPECT_TRUE(reduce(loaded, other).problem.coupled);
      problem.gap = problem.position.col(0).cwiseAbs2() / (2 * R);
      set_friction(problem, f);
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      ASSERT_EQ(solver.solve(state, Eigen::Vector2d(1, 0)).status, FrictionStatus::converged);
      EXPECT_NEAR(state.p.sum(), P, 1e-14);
      const VectorXd p = tractions(problem, state.p);
      for (Index i = 0; i < n; ++i)
      {
         const double x = problem.position(i, 0);
         if (std::abs(x) < 0.9)
         {
            EXPECT_NEAR(p[i] / (2 * P / (M_PI * a)), std::sqrt(1 - x * x), 3e-3) << x;
         }
      }
      const VectorXd sunk = conjugates(problem, state);
      EXPECT_NEAR(sunk[0] / (P * P) / (4 / M_PI * (std::log(2 * depth / a) + 0.5 - below(nu))),
                  1, 1e-3);
      ASSERT_EQ(solver.solve(state, Eigen::Vector2d(1, f * (1 - c * c))).status,
                FrictionStatus::converged);
      const Zone stick = stick_zone(problem, state);
      EXPECT_NEAR(std::abs(problem.position(stick.first, 0)), c, 1.5 / elements);
      EXPECT_NEAR(std::abs(problem.position(stick.last, 0)), c, 1.5 / elements);
   }
   // A half-space: Hertz again, P = 4/3 E* a³/R, approach a²/R.
   HalfPlane sphere = half_plane(1 - nu * nu, nu);
   sphere.normal = {0, 1};
   const double load = 4.0 / 3 * 0.5 / R;
   sphere.forces = {{"P", {0, -load}}};
   ReducedProblem problem =
      reduce(condense(sphere, even(0, 1.5, 60), 2, Formulation::axisymmetric),
             half_plane(1 - nu * nu, nu))
         .problem;
   problem.gap = problem.position.col(0).cwiseAbs2() / (2 * R);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   ASSERT_EQ(solver.solve(state, VectorXd::Ones(1)).status, FrictionStatus::converged);
   EXPECT_NEAR(contact_zone(problem, state).to.position, 1, 0.005);
   EXPECT_NEAR(conjugates(problem, state)[0] / load * R, 1, 1e-3);
}

/// A line of its own runs with the body on the left, whichever side that is, so that two meet
/// node by node, and by dual functions where their nodes differ: they bear one pressure.
TEST(HalfSpace, LinesOfTheirOwnRunWithTheBodyOnTheLeft)
{
   HalfPlane above = half_plane(1, 0.3), below = half_plane(1, 0.3);
   above.normal = {0, 1};
   for (const Formulation formulation : {Formulation::axisymmetric, Formulation::plane})
   {
      for (const HalfPlane *body : {&above, &below})
      {
         const ContactLine line = condense(*body, even(0, 1, 6), 2, formulation).line;
         for (Index i = 1; i < line.size(); ++i)
         {
            const Eigen::Vector2d step = line.nodes[i].position - line.nodes[i - 1].position;
            EXPECT_GT(step.dot(line.nodes[i].tangent), 0) << i;
            EXPECT_NEAR(line.nodes[i].arc_length - line.nodes[i - 1].arc_length, step.norm(),
                        1e-14);
         }
      }
   }
   const double pi = std::acos(-1.0);
   for (const int elements : {6, 5})
   {
      const std::vector<CondensedBody> bodies{
         condense(above, even(0, 1, 6), 2, Formulation::axisymmetric),
         condense(below, even(0, 1, elements), 2, Formulation::axisymmetric)};
      const Interface contact{"contact", {0, bodies[0].line}, {1, bodies[1].line}};
      const Reduction met = reduce(bodies, {contact});
      const ReducedProblem &problem = met.problem;
      EXPECT_NEAR(problem.weights.sum(), pi, 1e-12);
      // Pressed flat by the displacement d, as two rigid punches: F = 2 a E d / (1 - nu^2) of
      // each; the two are one behind the other.
      const double force = problem.C().sum();
      EXPECT_NEAR(force / (1 / (1 - 0.09)), 1, 0.02) << elements;
   }
}

TEST(Pairing, NamesEachNodeOfTheOtherBodyOnce)
{
   const CondensedBody body = frame({-1, -0.4, 0, 0.7, 1.5}, 1);
   for (const auto &[last, says] :
        {std::pair(5, "partner 5"), {-1, "partner -1"}, {3, "partner 3"}})
   {
      expect_input_error(
         [&, last = last] {
            reduce(body, body, Pairing{{4, 3, 2, 1, last}, VectorXd::Zero(5)});
         },
         says + std::string(" in the pairing, must be each of 0 to 4 once"));
   }
   expect_input_error(
      [&] {
         reduce(body, body, Pairing{{3, 2, 1, 0}, VectorXd::Zero(4)});
      },
      "the contact lines have 5 and 5 nodes and the pairing 4");
}

TEST(HalfPlane, BadInputIsNamed)
{
   const ContactLine line = straight_line(uneven, 2);
   const auto refused = [&](HalfPlane body, const ContactLine &on, const std::string &says)
   { expect_input_error([&] { condense(body, on); }, says); };
   const HalfPlane good = half_plane(1, 0.3);
   HalfPlane bad = good;
   // What ends at a held node may be half a model, or be held by a wall.
   ContactLine ends = line;
   ends.chains[0].ends[1] = LineEnd::symmetry;
   refused(bad, ends, "along the surface: say whether this is a plane of symmetry");
   bad.symmetric = false;
   EXPECT_NO_THROW(condense(bad, ends));
   bad = good;
   bad.depth = 0;
   refused(bad, line,
           "relative is 0, must be given, and be at least twice the length of the contact, 4");
   bad.depth = 3.99;
   refused(bad, line, "relative is 3.99, must be given, and be at least twice the length");
   bad.depth = 4;
   EXPECT_NO_THROW(condense(bad, line));
   bad = good;
   bad.normal = {0, -2};
   refused(bad, line, "normal of its surface is (0, -2), must be of length 1");
   bad = good;
   bad.material.poisson = 0.5;
   refused(bad, line, "Poisson's ratio is 0.5");
   bad = good;
   bad.symmetric = true;
   bad.point = {1, 0};
   refused(bad, line, "crosses the plane of symmetry");
   bad.normal = {std::sqrt(0.5), std::sqrt(0.5)};
   refused(bad, line, "horizontal or vertical");
   const auto loaded = [&](std::vector<FarForce> forces, const std::string &says)
   {
      HalfPlane body = good;
      body.symmetric = true;
      body.forces = std::move(forces);
      refused(body, line, says);
   };
   loaded({{"", {0, 1}}}, "has no pattern");
   loaded({{"P", {1, 1}}}, "along the normal");
   loaded({{"P", {0, 1}}, {"P", {0, 2}}}, "two far forces have the pattern 'P'");
   const auto pulled = [&](std::vector<BulkStress> bulk, const std::string &says)
   {
      HalfPlane body = good;
      body.bulk = std::move(bulk);
      refused(body, line, says);
   };
   pulled({{"", 1}}, "a bulk stress has no pattern");
   pulled({{"B", NAN}}, "the bulk stress of the pattern 'B' is nan");
   pulled({{"B", 1}, {"B", 2}}, "two bulk stresses have the pattern 'B'");
   expect_input_error([&] { condense(good, {0, 1, 1}, 2); }, "1 and 1 follow each other");
   const ContactLine round = straight_line(uneven, 2, Formulation::axisymmetric);
   refused(bad, round, "along the axis");
   bad.normal = {0, -1};
   refused(bad, round, "must be false there");
   bad = good;
   bad.material.state = PlaneState::stress;
   refused(bad, round, "must be of plane strain");
   refused(good, straight_line(uneven, 9),
           "order of a contact element is 9, must be from 1 to 8");
   ContactLine points_alone = line;
   points_alone.chains[0].elements.clear();
   refused(good, points_alone, "the contact line has no elements");
   ContactLine backwards = line;
   for (LineNode &node : backwards.nodes) { node.position[0] *= -1; }
   for (LineElement &element : backwards.chains[0].elements) { element.points.row(0) *= -1; }
   backwards.nodes[1].position[0] = backwards.chains[0].elements[0].points(0, 1) = 0.1;
   refused(good, backwards, "turns back on itself");
   ContactLine overlapping = line;
   overlapping.nodes.back().position[0] = overlapping.chains[0].elements[3].points(0, 2) = 1;
   overlapping.nodes[7].position[0] = overlapping.chains[0].elements[3].points(0, 1) = 1.05;
   refused(good, overlapping, "elements must lie side by side");
}

} // namespace
