#include "comparison.hpp"
#include "expect_input_error.hpp"
#include "line_along.hpp"
#include "quadrature.hpp"

#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Ends and so many places between them at random, neighbours up to ten times as far apart.
std::vector<double> random_grid(double from, double to, int elements, std::mt19937 &random)
{
   std::uniform_real_distribution<double> size(0.1, 1);
   std::vector<double> grid{0};
   for (int e = 0; e < elements; ++e) { grid.push_back(grid.back() + size(random)); }
   for (double &x : grid) { x = from + (to - from) * x / grid.back(); }
   grid.back() = to;
   return grid;
}

/// A body above y = 0 and one below it, of nodes of their own.
ContactLine above(const std::vector<double> &grid, int order,
                  Formulation formulation = Formulation::plane, double y = 0)
{
   return line_along([=](double x) { return Vector2d(x, y); }, grid, order, formulation);
}
ContactLine below(std::vector<double> grid, int order,
                  Formulation formulation = Formulation::plane, double y = 0)
{
   for (double &x : grid) { x = -x; }
   std::reverse(grid.begin(), grid.end());
   return line_along([=](double x) { return Vector2d(-x, y); }, grid, order, formulation);
}

VectorXd of_nodes(const ContactLine &line, const std::function<double(double)> &f)
{
   VectorXd values(line.size());
   for (Index i = 0; i < line.size(); ++i) { values[i] = f(line.nodes[i].position[0]); }
   return values;
}

/// ∫ φ_i f over from < x < to, of every node of a straight line, by tanh-sinh quadrature.
VectorXd integrals(const ContactLine &line, const std::function<double(double)> &f, double from,
                   double to)
{
   VectorXd result = VectorXd::Zero(line.size());
   for (const LineElement &element : line.chains[0].elements)
   {
      const double a = element.points(0, 0), b = element.points(0, element.order());
      const double low = std::max(from, std::min(a, b)), high = std::min(to, std::max(a, b));
      for (Index k = 0; k <= element.order() && low < high; ++k)
      {
         const auto value = [&](double u)
         {
            const double x = low + u;
            VectorXd phi(element.order() + 1);
            lobatto_basis(element.order()).evaluate((x - a) / (b - a), phi);
            return phi[k] * f(x);
         };
         if (element.nodes[k] < 0) { continue; }
         result[element.nodes[k]] += cattaneo::test::integrate(value, 0, high - low);
      }
   }
   return result;
}

class Orders : public testing::TestWithParam<std::tuple<int, int>>
{
};

/// On the same length whatever both meshes are: own is the identity, polynomials that both
/// traces have are reproduced, and a constant pressure is that on the master.
TEST_P(Orders, OfStraightLinesReproducePolynomialsAndPressure)
{
   const auto [order1, order2] = GetParam();
   std::mt19937 random(10 * order1 + order2);
   for (int trial = 0; trial < 4; ++trial)
   {
      const ContactLine slave = above(random_grid(-1, 1, 3 + trial, random), order1),
                        master = below(random_grid(-1, 1, 5 + trial, random), order2);
      const Mortar found = mortar(slave, master);
      ASSERT_EQ(Index(found.nodes.size()), slave.size());
      EXPECT_TRUE(found.free_surface.empty());
      EXPECT_EQ(found.left_out, 0);
      for (int c : {0, 1})
      {
         const MatrixXd own = found.own[c];
         EXPECT_TRUE(own.isIdentity(1e-15));
         for (int degree = 0; degree <= std::min(order1, order2); ++degree)
         {
            const auto power = [degree = degree](double x) { return std::pow(x, degree); };
            EXPECT_LT(
               largest(found.other[c] * of_nodes(master, power) - of_nodes(slave, power)),
               1e-12)
               << degree;
         }
         const auto one = [](double) { return 1.0; };
         EXPECT_LT(largest(found.weights - integrals(slave, one, -1, 1)), 1e-13);
         EXPECT_LT(
            largest(found.other[c].transpose() * found.weights - integrals(master, one, -1, 1)),
            1e-12);
      }
      EXPECT_EQ(largest(found.gap), 0);
      EXPECT_LT(largest(found.arm), 1e-13);
      EXPECT_LT(largest(found.tangent.col(0).array() - 1), 1e-14);
   }
}

/// Nodes that match have P = 1, the other line in its own direction.
TEST_P(Orders, OfMatchingLinesArePermutations)
{
   const auto [order, same] = GetParam();
   if (order != same) { return; }
   std::mt19937 random(order);
   const std::vector<double> grid = random_grid(0, 3, 6, random);
   for (Formulation formulation : {Formulation::plane, Formulation::axisymmetric})
   {
      const Mortar found =
         mortar(above(grid, order, formulation), below(grid, order, formulation));
      for (int c : {0, 1})
      {
         const MatrixXd P = found.other[c];
         EXPECT_LT(largest(P.rowwise().reverse() - MatrixXd::Identity(P.rows(), P.cols())),
                   1e-14)
            << order;
      }
   }
}

INSTANTIATE_TEST_SUITE_P(Mortar, Orders,
                         testing::Combine(testing::Range(1, 9),
                                          testing::Values(1, 2, 3, 5, 8)));

/// A master that ends anywhere on an element of the slave: the slave's weights stay positive,
/// rows are of a translation, and what a constant pressure gives both bodies is in balance.
TEST(Mortar, OfAnElementThatIsFacedInPartIsPositive)
{
   for (int order = 1; order <= 8; ++order)
   {
      for (int end = 1; end < 100; end += 2)
      {
         const double reach = 2 + end / 100.0;
         const ContactLine slave = above({0, 1, 2, 3, 4}, order),
                           master = below({0.3, 0.9, 1.7, reach}, 2);
         const Mortar found = mortar(slave, master);
         ASSERT_GT(found.weights.minCoeff(), 0) << order << " " << reach;
         EXPECT_FALSE(found.free_surface.empty());
         EXPECT_EQ(found.left_out, 0) << order << " " << reach;
         EXPECT_NEAR(found.weights.sum(), reach - 0.3, 1e-12);
         for (int c : {0, 1})
         {
            const MatrixXd own = found.own[c], other = found.other[c];
            for (std::size_t i = 0; i < found.nodes.size(); ++i)
            {
               EXPECT_GT(own(Index(i), found.nodes[i]), 0);
            }
            EXPECT_LT(largest(own.rowwise().sum().array() - 1), 1e-12);
            EXPECT_LT(largest(other.rowwise().sum().array() - 1), 1e-12);
            const auto x = [](double s) { return s; };
            const auto one = [](double) { return 1.0; };
            EXPECT_LT(largest(own * of_nodes(slave, x) - other * of_nodes(master, x)), 1e-11)
               << order << " " << reach;
            EXPECT_LT(
               largest(own.transpose() * found.weights - integrals(slave, one, 0.3, reach)),
               1e-12);
            EXPECT_LT(
               largest(other.transpose() * found.weights - integrals(master, one, 0.3, reach)),
               1e-12);
            EXPECT_LT(largest(own), 12) << order << " " << reach; // nothing is extrapolated
         }
      }
   }
}

/// A master within one element of the slave that no node lies over cannot be told from it.
TEST(Mortar, OfAMasterBetweenTwoNodesLeavesTheLine)
{
   expect_input_error(
      [] {
         mortar(above({0, 1}, 1), below({0.4, 0.6}, 1));
      },
      "no node of the slave lies over the master");
   const Mortar found = mortar(above({0, 1, 2}, 1), below({0.9, 1.2}, 1));
   EXPECT_EQ(found.nodes, (std::vector<int>{1}));
   EXPECT_EQ(found.free_surface, (std::vector<int>{0, 2}));
   EXPECT_NEAR(found.weights[0], 0.3, 1e-14);
}

/// A part of the master between two nodes that have no row beside it is told to be left out.
TEST(Mortar, TellsWhatItLeavesOut)
{
   const auto from_right = [](double x) { return Vector2d(-x, 0); };
   const ContactLine master =
      joined({line_along(from_right, {-2.55, -2.45}, 1),
              line_along(from_right, {-1.2, -0.9}, 1, Formulation::plane, 100)});
   for (bool curved : {false, true})
   {
      const Mortar found = mortar(above({0, 1, 2, 3}, curved ? 2 : 1), master);
      const double weight = found.weights.sum();
      // Quadratic elements have a node at 2.5, within the part between 2 and 3.
      EXPECT_NEAR(weight, curved ? 0.4 : 0.3, 1e-14);
      EXPECT_NEAR(found.left_out, curved ? 0 : 0.1, 1e-14);
   }
}

/// Nodes without a row leave their part to their neighbours.
TEST(Mortar, OfNodesWithoutRowsKeepsTheirPressure)
{
   for (int order = 1; order <= 4; ++order)
   {
      const ContactLine slave = above({0, 1, 2, 3, 4}, order), master = below({0, 1.3, 4}, 3);
      const Mortar found = mortar(slave, master, {0, static_cast<int>(slave.size()) - 1});
      EXPECT_EQ(Index(found.nodes.size()), slave.size() - 2);
      EXPECT_TRUE(found.free_surface.empty());
      const auto one = [](double) { return 1.0; };
      EXPECT_GT(found.weights.minCoeff(), 0);
      EXPECT_LT(largest(found.own[0].transpose() * found.weights - integrals(slave, one, 0, 4)),
                1e-13);
      EXPECT_LT(
         largest(found.other[1].transpose() * found.weights - integrals(master, one, 0, 4)),
         1e-13);
   }
}

/// A slave over two masters whose joint lies anywhere, also within one of its elements, and of
/// the second interface the nodes that the first has carry no row: a constant pressure is one
/// on all three lines, and linear displacements open nothing.
TEST(Mortar, OverTwoNeighboursKeepsTheirPressure)
{
   std::mt19937 random(11);
   for (int order = 1; order <= 8; ++order)
   {
      for (const Formulation formulation : {Formulation::plane, Formulation::axisymmetric})
      {
         const auto measure = [=](double x)
         { return formulation == Formulation::plane ? 1.0 : 2 * pi * x; };
         const ContactLine slave = above(random_grid(1, 3, 5, random), order, formulation);
         const auto &element = slave.chains[0].elements[2].points;
         for (double share : {0.001, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 0.999})
         {
            const double joint = element(0, 0) + share * (element(0, order) - element(0, 0));
            const ContactLine left = below(random_grid(1, joint, 4, random), 2, formulation),
                              right = below(random_grid(joint, 3, 6, random), 1, formulation);
            for (bool right_first : {false, true})
            {
               const ContactLine &one = right_first ? right : left,
                                 &two = right_first ? left : right;
               const Mortar first = mortar(slave, one),
                            second = mortar(slave, two, first.nodes);
               VectorXd carried = -integrals(slave, measure, 1, 3);
               for (const Mortar *made : {&first, &second})
               {
                  const ContactLine &master = made == &first ? one : two;
                  carried += made->own[1].transpose() * made->weights;
                  EXPECT_EQ(made->left_out, 0);
                  EXPECT_GT(made->weights.minCoeff(), 0);
                  const VectorXd on_master = made->other[1].transpose() * made->weights;
                  EXPECT_LT(largest(on_master - integrals(master, measure, 1, 3)), 1e-11)
                     << order << " " << share;
                  for (int c : {0, 1})
                  {
                     const auto x = [](double x) { return x; };
                     EXPECT_LT(largest(made->own[c] * of_nodes(slave, x) -
                                       made->other[c] * of_nodes(master, x)),
                               1e-12);
                  }
               }
               EXPECT_LT(largest(carried), 1e-11) << order << " " << share;
            }
         }
      }
   }
}

/// The same of an arc within two rings' arcs: together they carry its whole length.
TEST(Mortar, OverTwoNeighboursOfAnArcIsWhole)
{
   for (int order = 1; order <= 3; ++order)
   {
      for (double share : {0.02, 0.3, 0.6, 0.95})
      {
         const double joint = 0.1 + 1.3 * (4 + share) / 10;
         const ContactLine disc =
                              line_along(circle({2, 3}, 1), uniform_grid(0.1, 1.4, 10), order),
                           one = line_along(circle({2, 3}, 1, true),
                                            uniform_grid(-joint, -0.1, 7), order),
                           two = line_along(circle({2, 3}, 1, true),
                                            uniform_grid(-1.4, -joint, 9), order);
         const Mortar first = mortar(disc, one), second = mortar(disc, two, first.nodes);
         EXPECT_EQ(first.left_out + second.left_out, 0);
         // Chords of 0.13 are shorter than their arcs by 7e-4, and ends face across mean
         // tangents.
         EXPECT_NEAR(first.weights.sum(), joint - 0.1, 2e-3) << order << " " << share;
         EXPECT_NEAR(second.weights.sum(), 1.4 - joint, 2e-3) << order << " " << share;
      }
   }
}

/// Bodies of revolution: weights over the circumference, and displacements that are even or odd
/// in r to the axis, where there is no node.
TEST(Mortar, OfBodiesOfRevolutionHasTheWeightOfTheCircumference)
{
   const auto around = [=](double r) { return 2 * pi * r; };
   const auto axisymmetric = Formulation::axisymmetric;
   std::mt19937 random(5);
   for (int order1 = 2; order1 <= 4; ++order1)
   {
      for (int order2 = 2; order2 <= 4; ++order2)
      {
         const ContactLine slave = above(random_grid(0, 1.5, 4, random), order1, axisymmetric),
                           master = below(random_grid(0, 1.5, 7, random), order2, axisymmetric);
         const Mortar found = mortar(slave, master);
         EXPECT_LT(largest(found.weights - integrals(slave, around, 0, 1.5)), 1e-13);
         EXPECT_LT(largest(found.other[1].transpose() * found.weights -
                           integrals(master, around, 0, 1.5)),
                   1e-13);
         for (int degree : {0, 1, 2, 3, 4})
         {
            if (degree > std::min(order1, order2)) { continue; }
            const auto power = [=](double r) { return std::pow(r, degree); };
            const int c = degree % 2 == 0 ? 1 : 0; // z even, r odd
            EXPECT_LT(
               largest(found.other[c] * of_nodes(master, power) - of_nodes(slave, power)),
               1e-12)
               << order1 << order2 << degree;
         }
      }
   }
   // Off the axis, and of order 1.
   const ContactLine slave = above({1, 1.4, 2}, 1, axisymmetric),
                     master = below({1, 1.2, 1.5, 2}, 1, axisymmetric);
   const Mortar found = mortar(slave, master);
   EXPECT_LT(
      largest(found.other[0].transpose() * found.weights - integrals(master, around, 1, 2)),
      1e-13);
}

/// A disc in a ring with a clearance, concentric: the gap is the clearance wherever, and what
/// is left is the chordal error of the elements. Either may be the slave.
TEST(Mortar, OfConcentricArcsConvergesToTheClearance)
{
   for (int order = 1; order <= 3; ++order)
   {
      double before = 0, known_before = 0;
      for (int n : {8, 16, 32})
      {
         const double clearance = 0.05;
         const ContactLine disc =
                              line_along(circle({2, 3}, 1), uniform_grid(0.1, 1.4, n), order),
                           ring = line_along(circle({2, 3}, 1 + clearance, true),
                                             uniform_grid(-1.4, -0.1, 3 * n / 2), order);
         double error = 0, known = 0;
         for (bool swapped : {false, true})
         {
            const Mortar found = swapped ? mortar(ring, disc) : mortar(disc, ring);
            const ContactLine &slave = swapped ? ring : disc;
            for (std::size_t i = 0; i < found.nodes.size(); ++i)
            {
               const auto k = static_cast<Index>(i);
               const Vector2d radial =
                  (slave.nodes[found.nodes[i]].position - Vector2d(2, 3)).normalized();
               // Out of the ring's middle it is into the ring, and out of the disc.
               const Vector2d tangent = found.tangent.row(k);
               const Vector2d normal(-tangent[1], tangent[0]);
               EXPECT_NEAR(normal.dot(radial), swapped ? 1 : -1, 1e-2);
               // At the ends no neighbour averages the normals, and half an element is faced.
               if (i < 2 * std::size_t(order) || i + 2 * order >= found.nodes.size())
               {
                  continue;
               }
               const double off = clearance - found.gap[k];
               error = std::max(error, std::abs(off));
               known = std::max(known, std::abs(found.chords[k] - off));
               EXPECT_LT(std::abs(found.arm[k]), 0.1 / n);
            }
         }
         EXPECT_LT(error, 0.3 * std::pow(1.3 / n, 2));
         if (before > 0) { EXPECT_LT(error, before / 3.5) << order << " " << n; }
         before = error;
         // What chords are told to be off by is most of it. The rest is of curves of a higher
         // order, and of the clearance, which is averaged over normals that turn.
         EXPECT_LT(known, 0.2 * error) << order << " " << n;
         if (known_before > 0) { EXPECT_LT(known, known_before / 3.5) << order << " " << n; }
         known_before = known;
      }
   }
}

/// Two arcs of one circle whose edges do not match, on chords or with nodes on the circle: the
/// gap is zero, to round-off, whatever the lengths of the edges; with a clearance it is that,
/// but for its mean over normals that turn along an element.
TEST(Mortar, OfArcsOfOneCircleHasNoGap)
{
   std::mt19937 random(11);
   const auto arc = [&](double radius, double from, double to, int edges, int order, bool moved)
   {
      const std::vector<double> grid = random_grid(from, to, edges, random);
      const auto place = [=](double angle)
      { return Vector2d(radius * std::cos(angle), radius * std::sin(angle)); };
      const auto bend = [=](double one, double two) // half of the angle, in a hole negative
      {
         const double half = 0.5 * std::abs(two - one) * (from < to ? 1 : -1);
         return EdgeBend{half, half};
      };
      const auto on_edges = [=](double angle)
      {
         const auto next =
            std::find_if(grid.begin() + 1, grid.end() - 1,
                         [&](double end) { return (end - angle) * (to - from) >= 0; });
         const double begin = *(next - 1), end = *next, s = (angle - begin) / (end - begin);
         const Vector2d a = place(begin), chord = place(end) - a;
         const double off = moved ? bend(begin, end).off(s) : 0;
         return Vector2d(a + s * chord + off * Vector2d(chord[1], -chord[0]));
      };
      ContactLine line = line_along(on_edges, grid, order);
      for (std::size_t e = 0; e + 1 < grid.size(); ++e)
      {
         line.chains[0].elements[e].bend = bend(grid[e], grid[e + 1]);
      }
      return line;
   };
   for (int order = 1; order <= 3; ++order)
   {
      for (bool moved : {false, true})
      {
         for (double clearance : {0.0, 1e-3})
         {
            const ContactLine disc = arc(1, 0.1, 1.5, 11, order, moved),
                              hole = arc(1 + clearance, 1.5, 0.1, 7, order, moved);
            // A row sees two elements, over which normals turn by no more than that.
            double turn = 0;
            for (const ContactLine *line : {&disc, &hole})
            {
               for (const LineElement &element : line->chains[0].elements)
               {
                  turn = std::max(turn, 4 * std::abs(element.bend->begin));
               }
            }
            for (bool swapped : {false, true})
            {
               const Mortar found = swapped ? mortar(hole, disc) : mortar(disc, hole);
               EXPECT_LT((found.gap.array() - clearance).abs().maxCoeff(),
                         clearance * turn * turn + 1e-13)
                  << order << moved << swapped;
               EXPECT_LT(found.arm.cwiseAbs().maxCoeff(), clearance * turn + 1e-13);
            }
         }
      }
   }
}

/// Two discs side by side: the gap between them, at the height y of the point between,
/// √(R² - y²) away from each middle, does not depend on which is the slave.
TEST(Mortar, OfTwoDiscsHasTheGapBetweenThem)
{
   const double R1 = 1, R2 = 2;
   const auto gap = [&](double y)
   { return R1 - std::sqrt(R1 * R1 - y * y) + R2 - std::sqrt(R2 * R2 - y * y); };
   const ContactLine left = line_along(circle({-R1, 0}, R1), uniform_grid(-0.2, 0.2, 30), 2),
                     right = line_along(circle({R2, 0}, R2),
                                        uniform_grid(M_PI - 0.12, M_PI + 0.12, 34), 2);
   for (bool swapped : {false, true})
   {
      const Mortar found = swapped ? mortar(right, left) : mortar(left, right);
      const ContactLine &slave = swapped ? right : left;
      for (std::size_t i = 3; i + 3 < found.nodes.size(); ++i)
      {
         const double y = slave.nodes[found.nodes[i]].position[1];
         // Across the mean normal it is that at the height half way: the rest is of fourth
         // order.
         EXPECT_NEAR(found.gap[Index(i)], gap(y), 2e-4 * gap(y) + 2 * std::pow(y, 4) + 1e-7);
      }
   }
}

/// Where a long element of the slave ends at a short one both see what faces them there, and
/// not what the long one cannot follow: a kink of the master amid the long element. Polynomials
/// and a constant pressure are what they are with any mesh.
TEST(Mortar, LongElementsBesideShortOnesSeeWhatIsNear)
{
   for (int order = 1; order <= 4; ++order)
   {
      for (const double size : {0.1, 0.01, 1e-4})
      {
         // A short one between long ones, and long ones beside many that are short.
         for (const std::vector<double> &grid :
              {std::vector<double>{-2, -1, 0, size, 1, 2},
               std::vector<double>{-2, -1, 0, size, 2 * size, 3 * size, 1, 2}})
         {
            const std::vector<double> faces{-2, -1.3, -0.6, 0.4, 1.2, 2};
            const ContactLine slave = above(grid, order), master = below(faces, order);
            const Mortar found = mortar(slave, master);
            ASSERT_EQ(Index(found.nodes.size()), slave.size());
            for (int degree = 0; degree <= order; ++degree)
            {
               const auto power = [=](double x) { return std::pow(x, degree); };
               EXPECT_LT(
                  largest(found.other[1] * of_nodes(master, power) - of_nodes(slave, power)),
                  1e-11)
                  << order << " " << size << " " << degree;
            }
            const auto one = [](double) { return 1.0; };
            EXPECT_LT(largest(found.other[1].transpose() * found.weights -
                              integrals(master, one, -2, 2)),
                      1e-12);
            const auto kink = [](double x) { return std::abs(x + 0.6) + std::abs(x - 0.4); };
            const VectorXd seen = found.other[1] * of_nodes(master, kink);
            for (Index i = 0; i < slave.size(); ++i)
            {
               const double x = slave.nodes[i].position[0];
               if (x < 0 || x > (grid.size() - 5) * size) { continue; }
               EXPECT_NEAR(seen[i], kink(x), 2 * size) << order << " " << size << " " << x;
            }
         }
      }
   }
}

/// The same whatever the plane is called, and whatever the unit of length.
TEST(Mortar, DoesNotDependOnFrameAndUnit)
{
   const auto build = [](double scale, double angle, const Vector2d &shift)
   {
      const Eigen::Rotation2Dd turn(angle);
      const auto moved = [=](const Curve &curve) -> Curve
      { return [=](double t) -> Vector2d { return scale * (turn * curve(t)) + shift; }; };
      return mortar(line_along(moved(circle({0, 1}, 1)), uniform_grid(-2.2, -1.2, 9), 2),
                    line_along(moved(straight({1, 0}, {-1, 0})), uniform_grid(0, 1, 23), 3));
   };
   const Mortar plain = build(1, 0, {0, 0});
   for (double scale : {1e-6, 1.0, 1e6})
   {
      const Mortar turned = build(scale, 0.7, scale * Vector2d(3, -2));
      ASSERT_EQ(plain.nodes, turned.nodes);
      EXPECT_LT(largest(MatrixXd(plain.other[0]) - MatrixXd(turned.other[0])), 1e-11);
      EXPECT_LT(largest(plain.gap - turned.gap / scale), 1e-13);
      EXPECT_LT(largest(plain.weights - turned.weights / scale), 1e-13);
   }
}

TEST(Mortar, RefusesLinesThatDoNotFit)
{
   const ContactLine line = above({0, 1, 2}, 2);
   expect_input_error(
      [&] {
         mortar(line, above({0, 1, 2}, 2), {}, "interface 'flank'");
      },
      "interface 'flank': the lines face each other nowhere: their outward normals are (0, -1) "
      "and (0, -1) in the mean, must be opposite: are these the sides that touch? (one reaches "
      "from (0, 0) to (2, 0)");
   expect_input_error(
      [&] {
         mortar(line, below({2, 3}, 2));
      },
      "face each other nowhere: they lie beside each other");
   expect_input_error(
      [&] {
         mortar(line, below({0, 2}, 2, Formulation::axisymmetric));
      },
      "must be both plane or both axisymmetric");
   ContactLine bare = below({0, 2}, 2);
   bare.chains[0].elements.clear();
   expect_input_error([&] { mortar(line, bare); }, "has no elements");
   expect_input_error([&] { mortar(line, below({0, 2}, 2), {7}); }, "must be from 0 to 4");
}

} // namespace
