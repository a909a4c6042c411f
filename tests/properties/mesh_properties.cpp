// Random meshes: contact lines, condensed stiffnesses and reduced problems do not depend on how
// elements, vertices and bodies are numbered and turned.

#include "holds.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <mfem.hpp>
#include <numeric>
#include <random>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Grid of quads between the lines x and y, turned, mirrored in the y axis, numbered and
/// oriented at random (0: in order). Boundary attributes: 1 bottom, 2 right, 3 top, 4 left.
struct Grid
{
   std::vector<double> x, y;
   double bend = 0;  ///< the grid line y = 0 becomes the parabola y = bend x²
   int quarters = 0; ///< turns by 90°
   bool mirrored = false;
   unsigned numbering = 0;

   mfem::Mesh mesh() const
   {
      const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
      std::mt19937 random(numbering);
      const auto shuffled = [&](int n)
      {
         std::vector<int> order(static_cast<std::size_t>(n));
         std::iota(order.begin(), order.end(), 0);
         if (numbering) { std::shuffle(order.begin(), order.end(), random); }
         return order;
      };
      const auto some = [&](int n) { return numbering ? static_cast<int>(random() % n) : 0; };
      mfem::Mesh mesh(2, (nx + 1) * (ny + 1), nx * ny, 2 * (nx + ny), 2);
      std::vector<int> number((nx + 1) * (ny + 1));
      int count = 0;
      for (int at : shuffled((nx + 1) * (ny + 1)))
      {
         number[at] = count++;
         const double a = x[at % (nx + 1)], b = y[at / (nx + 1)] + bend * a * a;
         const double s = mirrored ? -a : a;
         const double turned[4][2] = {{s, b}, {-b, s}, {-s, -b}, {b, -s}};
         mesh.AddVertex(turned[quarters][0], turned[quarters][1]);
      }
      const auto vertex = [&](int i, int j) { return number[i + j * (nx + 1)]; };
      for (int e : shuffled(nx * ny))
      {
         const int i = e % nx, j = e / nx;
         int corners[4] = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1),
                           vertex(i, j + 1)};
         if (mirrored) { std::reverse(corners, corners + 4); }
         std::rotate(corners, corners + some(4), corners + 4);
         mesh.AddQuad(corners);
      }
      for (int e : shuffled(2 * (nx + ny)))
      {
         const bool level = e < 2 * nx; // bottom or top
         const int k = level ? e % nx : (e - 2 * nx) % ny,
                   far = level ? e / nx : (e - 2 * nx) / ny;
         int ends[2] = {level ? vertex(k, far * ny) : vertex(far * nx, k),
                        level ? vertex(k + 1, far * ny) : vertex(far * nx, k + 1)};
         if (some(2)) { std::swap(ends[0], ends[1]); }
         mesh.AddBdrSegment(ends, level ? (far ? 3 : 1) : (far ? 2 : 4));
      }
      mesh.FinalizeMesh();
      return mesh;
   }

   /// Length of the polygon that the bottom is.
   double bottom() const
   {
      double length = 0;
      for (std::size_t i = 1; i < x.size(); ++i)
      {
         length += std::hypot(x[i] - x[i - 1], bend * (x[i] * x[i] - x[i - 1] * x[i - 1]));
      }
      return length;
   }
   double right() const { return y.back() - y.front(); }
};

std::vector<double> lines(double from, const char *name)
{
   const auto steps =
      *rc::gen::resize(5, rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(
                             rc::gen::resize(100, rc::gen::inRange(1, 9)))))
          .as(name);
   std::vector<double> list{from};
   for (int step : steps) { list.push_back(list.back() + 0.25 * step); }
   return list;
}

/** A condensed body, and how far from exact arithmetic its numbers can be.

    S = Eᵀ K E and loads are Eᵀ K r, where E are the motions of all nodes that follow a unit
    motion of one contact node, r those under the load with the contact clamped. Round-off in
    the entries of K, and elimination, which is exact for a matrix K + δK with |δK| ≤ N ε |K| of
    N unknowns, change them by Eᵀ δK E and Eᵀ δK r: few nodes that hold a large body move it
    far, E is large, and digits go. */
struct JudgedBody : CondensedBody
{
   double stiffness_error, load_error;

   JudgedBody(CondensedBody condensed, const ElasticBody &body)
      : CondensedBody(std::move(condensed))
   {
      const Index contact = S.cols();
      MatrixXd sizes(contact + 1, contact + 1);
      std::vector<mfem::Vector> moved, pulled;
      for (Index k = 0; k <= contact; ++k)
      {
         VectorXd u = VectorXd::Zero(contact);
         if (k < contact) { u[k] = 1; }
         VectorXd x = recover(u, VectorXd::Constant(1, k < contact ? 0 : 1)).cwiseAbs();
         moved.emplace_back(static_cast<int>(x.size()));
         pulled.emplace_back(static_cast<int>(x.size()));
         std::copy(x.begin(), x.end(), moved.back().GetData());
         body.stiffness().AbsMult(moved.back(), pulled.back());
      }
      for (Index k = 0; k <= contact; ++k)
      {
         for (Index l = 0; l <= contact; ++l) { sizes(k, l) = moved[k] * pulled[l]; }
      }
      // Once for the elimination and once for taking off what it left of rigid motions.
      const double share = 2 * body.dofs() * std::numeric_limits<double>::epsilon();
      stiffness_error = share * sizes.topLeftCorner(contact, contact).maxCoeff();
      load_error = share * sizes.col(contact).head(contact).maxCoeff();
   }
};

struct Scene
{
   Grid grid;
   int order = 1;
   bool around_corner = false;
   double poisson = 0;

   Scene()
   {
      grid.x = lines(-1, "steps in x, quarters");
      grid.y = lines(0, "steps in y, quarters");
      grid.bend = 0.05 * *around_zero(2).as("bend, 1/20");
      order = *rc::gen::inRange(1, 4).as("order");
      around_corner = *rc::gen::arbitrary<bool>().as("contact on the right too");
      poisson = 0.1 * *rc::gen::inRange(0, 5).as("ten times Poisson's ratio");
   }
   BoundaryPart contact() const
   {
      return around_corner ? BoundaryPart(std::vector<int>{1, 2}) : BoundaryPart(1);
   }
   JudgedBody body(const Grid &other) const
   {
      mfem::Mesh mesh = other.mesh();
      ElasticBody body(mesh, order, Material{1, poisson});
      body.add_pressure("P", 4, [](double, double) { return 1.0; });
      return {condense(body, contact_line(body, contact())), body};
   }
   void write(const std::string &file) const
   {
      std::ofstream out(file);
      out.precision(17);
      grid.mesh().Print(out);
   }
};

void check(const Scene &scene, const std::function<void()> &act)
{
   keep_if_it_fails(".mesh", act, [&](const std::string &file) { scene.write(file); });
}

/// Largest entry of a - b over that of b, or over `least` if that is larger.
double difference(const MatrixXd &a, const MatrixXd &b, double least = 0)
{
   RC_ASSERT(a.rows() == b.rows());
   RC_ASSERT(a.cols() == b.cols());
   return (a - b).cwiseAbs().maxCoeff() / std::max(least, b.cwiseAbs().maxCoeff());
}

/// Coordinates are of order one; loads of the free body are those of its clamped contact.
constexpr double geometric = 1e-13, elastic = 1e-10;

void expect_same_stiffness(const JudgedBody &b, const JudgedBody &a, const MatrixXd &S)
{
   RC_ASSERT((b.S - S).cwiseAbs().maxCoeff() < a.stiffness_error + b.stiffness_error);
}

void expect_same_load(const JudgedBody &b, const JudgedBody &a, const VectorXd &of_b,
                      const VectorXd &of_a)
{
   RC_ASSERT((of_b - of_a).cwiseAbs().maxCoeff() < a.load_error + b.load_error);
}

TEST(MeshProperties, ContactLinesHaveTheLengthAndTheNormalsOfTheBoundary)
{
   expect_holds(
      300,
      []
      {
         const Scene scene;
         check(scene,
               [&]
               {
                  mfem::Mesh mesh = scene.grid.mesh();
                  ElasticBody body(mesh, scene.order, Material{1, scene.poisson});
                  const ContactLine line = contact_line(body, scene.contact());
                  const double length =
                     scene.grid.bottom() + (scene.around_corner ? scene.grid.right() : 0);
                  const Index last = line.size() - 1;
                  RC_ASSERT(std::abs(line.each(&LineNode::weight).sum() - length) <
                            geometric * length);
                  RC_ASSERT(line.each(&LineNode::weight).minCoeff() > 0);
                  RC_ASSERT(std::abs(line.nodes[last].arc_length - line.nodes[0].arc_length -
                                     length) < geometric * length);
                  for (Index i = 0; i <= last; ++i)
                  {
                     const Eigen::Vector2d t = line.nodes[i].tangent,
                                           n = line.nodes[i].normal();
                     RC_ASSERT(std::abs(n.norm() - 1) < geometric);
                     // Right-handed: the normal is the tangent turned by 90°.
                     RC_ASSERT((n - Eigen::Vector2d(-t[1], t[0])).norm() < geometric);
                  }
               });
      });
}

TEST(MeshProperties, NumbersAndOrientationsDoNotMatter)
{
   expect_holds(
      100,
      []
      {
         const Scene scene;
         Grid other = scene.grid;
         other.numbering = *rc::gen::inRange(1u, 1000u).as("numbering");
         check(scene,
               [&]
               {
                  const JudgedBody a = scene.body(scene.grid), b = scene.body(other);
                  RC_ASSERT(difference(b.line.each(&LineNode::position),
                                       a.line.each(&LineNode::position), 1) < geometric);
                  RC_ASSERT(difference(b.line.each(&LineNode::weight),
                                       a.line.each(&LineNode::weight)) < geometric);
                  RC_ASSERT(difference(b.line.each(&LineNode::arc_length),
                                       a.line.each(&LineNode::arc_length), 1) < geometric);
                  RC_ASSERT(difference(b.line.each(&LineNode::normal),
                                       a.line.each(&LineNode::normal)) < geometric);
                  expect_same_stiffness(b, a, a.S);
                  expect_same_load(b, a, b.patterns[0].q, a.patterns[0].q);
                  expect_same_load(b, a, b.patterns[0].p, a.patterns[0].p);
               });
      });
}

TEST(MeshProperties, ATurnedBodyIsTheSameInItsOwnFrames)
{
   expect_holds(60,
                []
                {
                   const Scene scene;
                   Grid other = scene.grid;
                   other.quarters = *rc::gen::inRange(1, 4).as("quarters of a turn");
                   check(scene,
                         [&]
                         {
                            const JudgedBody a = scene.body(scene.grid), b = scene.body(other);
                            MatrixXd turned = a.line.each(&LineNode::position),
                                     normal = a.line.each(&LineNode::normal);
                            for (MatrixXd *vectors : {&turned, &normal})
                            {
                               for (int k = 0; k < other.quarters; ++k)
                               {
                                  const VectorXd x = vectors->col(0);
                                  vectors->col(0) = -vectors->col(1);
                                  vectors->col(1) = x;
                               }
                            }
                            RC_ASSERT(difference(b.line.each(&LineNode::position), turned, 1) <
                                      geometric);
                            RC_ASSERT(difference(b.line.each(&LineNode::normal), normal) <
                                      geometric);
                            RC_ASSERT(difference(b.line.each(&LineNode::weight),
                                                 a.line.each(&LineNode::weight)) < geometric);
                            expect_same_stiffness(b, a, a.S);
                            expect_same_load(b, a, b.patterns[0].p, a.patterns[0].p);
                         });
                });
}

/// The mirror image runs the other way, and its shear with it.
TEST(MeshProperties, AMirroredBodyIsMirrored)
{
   expect_holds(
      60,
      []
      {
         const Scene scene;
         Grid other = scene.grid;
         other.mirrored = true;
         check(scene,
               [&]
               {
                  const JudgedBody a = scene.body(scene.grid), b = scene.body(other);
                  const Index n = a.line.size();
                  RC_ASSERT(b.line.size() == n);
                  MatrixXd mirror = MatrixXd::Zero(2 * n, 2 * n);
                  for (Index i = 0; i < n; ++i)
                  {
                     mirror(i, n - 1 - i) = -1;
                     mirror(n + i, 2 * n - 1 - i) = 1;
                  }
                  RC_ASSERT(difference(b.line.each(&LineNode::position).col(0),
                                       -a.line.each(&LineNode::position).col(0).reverse(),
                                       1) < geometric);
                  RC_ASSERT(difference(b.line.each(&LineNode::weight),
                                       a.line.each(&LineNode::weight).reverse()) < geometric);
                  expect_same_stiffness(b, a, mirror * a.S * mirror.transpose());
                  expect_same_load(b, a, b.patterns[0].q, -a.patterns[0].q.reverse());
               });
      });
}

TEST(MeshProperties, CondensedStiffnessIsSymmetricAndResistsNoRigidMotion)
{
   expect_holds(
      100,
      []
      {
         const Scene scene;
         check(scene,
               [&]
               {
                  const JudgedBody body = scene.body(scene.grid);
                  const ContactLine &line = body.line;
                  expect_same_stiffness(body, body, body.S.transpose());
                  MatrixXd x(line.size(), 2);
                  for (int motion = 0; motion < 3; ++motion)
                  {
                     x.setZero();
                     if (motion < 2) { x.col(motion).setOnes(); }
                     else
                     {
                        x.col(0) = -line.each(&LineNode::position).col(1);
                        x.col(1) = line.each(&LineNode::position).col(0);
                     }
                     VectorXd u(2 * line.size());
                     u << (line.each(&LineNode::tangent).array() * x.array()).rowwise().sum(),
                        (line.each(&LineNode::normal).array() * x.array()).rowwise().sum();
                     RC_ASSERT((body.S * u).cwiseAbs().maxCoeff() <
                               body.stiffness_error * u.cwiseAbs().sum());
                  }
               });
      });
}

/// Which body is called the first decides where the line starts; frames of body 2 are turned by
/// 180°, so that relative displacements keep their signs.
TEST(MeshProperties, SwappedBodiesAreTheSameProblem)
{
   expect_holds(
      60,
      []
      {
         Scene scene;
         scene.around_corner = false;
         Grid below = scene.grid;
         below.y = lines(0, "steps in y of the lower body, quarters");
         std::reverse(below.y.begin(), below.y.end());
         for (double &y : below.y) { y *= -1; }
         const double young = *rc::gen::inRange(1, 20).as("modulus of the lower body");
         check(scene,
               [&]
               {
                  mfem::Mesh meshes[] = {scene.grid.mesh(), below.mesh()};
                  ElasticBody upper(meshes[0], scene.order, Material{1, scene.poisson}),
                     lower(meshes[1], scene.order, Material{young, 0.2});
                  upper.add_pressure("P", 3, 1.0);
                  upper.add_traction("Q", 2, 0.3, 0.1);
                  for (int component : {0, 1}) { lower.fix(1, component); }
                  lower.add_pressure("Q", 4, 0.2);
                  const ContactLine line1 = contact_line(upper, 1),
                                    line2 = contact_line(lower, 3);
                  const CondensedBody a = condense(upper, line1), b = condense(lower, line2);
                  const ReducedProblem one = reduce(a, b, pair_lines(line1, line2)).problem;
                  const ReducedProblem two = reduce(b, a, pair_lines(line2, line1)).problem;
                  const auto turned = [](const MatrixXd &M)
                  { return MatrixXd(M.colwise().reverse().rowwise().reverse()); };
                  // The normal stiffness of a free body on two nodes is nothing but round-off.
                  const double scale = one.A().cwiseAbs().maxCoeff();
                  RC_ASSERT(difference(two.A(), turned(one.A())) < elastic);
                  RC_ASSERT(difference(two.B(), turned(one.B()), scale) < elastic);
                  RC_ASSERT(difference(two.C(), turned(one.C()), scale) < elastic);
                  for (const LoadPattern &pattern : one.patterns)
                  {
                     const LoadPattern &same =
                        two.patterns[static_cast<std::size_t>(two.pattern(pattern.name))];
                     RC_ASSERT(difference(same.q, pattern.q.reverse(), 1) < elastic);
                     RC_ASSERT(difference(same.p, pattern.p.reverse(), 1) < elastic);
                  }
               });
      });
}

} // namespace
