#include "elastic_support.hpp"

#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/friction/march.hpp>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Index;

const Material steel{2.0, 0.3};
/// Three plates one on the other, 0 < x < 2, of nodes of their own.
struct Stack
{
   std::vector<mfem::Mesh> meshes;
   std::vector<std::unique_ptr<ElasticBody>> bodies;
   std::vector<NamedBody> named;
   std::vector<BoundaryInterface> interfaces{{"low", {0, top}, {1, bottom}},
                                             {"high", {1, top}, {2, bottom}}};

   /// Elements along each plate; the meshes are moved before anything is built on them.
   Stack(
      const std::vector<int> &elements, int order,
      const std::function<void(mfem::Mesh &)> &move = [](mfem::Mesh &) {})
   {
      for (std::size_t k = 0; k < elements.size(); ++k)
      {
         const double y = static_cast<double>(k);
         meshes.push_back(rectangle_mesh(uniform(0, 2, elements[k]), uniform(y, y + 1, 2)));
      }
      for (mfem::Mesh &mesh : meshes)
      {
         move(mesh);
         bodies.push_back(std::make_unique<ElasticBody>(mesh, order, steel));
         named.push_back({"plate " + std::to_string(bodies.size()), bodies.back().get()});
      }
   }
};

/// A constant pressure and a constant shear are so whatever the meshes: the exact field has no
/// relative displacement, so that the clamped forces are those of the traction.
TEST(InterfacesOfBodies, PassThePatchTest)
{
   for (int order = 1; order <= 4; ++order)
   {
      for (const std::vector<int> &elements :
           {std::vector<int>{8, 11, 8}, {3, 9, 4}, {4, 3, 11}, {11, 8, 24}})
      {
         Stack stack(elements, order);
         stack.bodies[0]->fix(bottom, 0);
         stack.bodies[0]->fix(bottom, 1);
         // With u = 0 below a shear alone is uniform; a pressure needs its strain there.
         const double pressure = 0.7, shear = 0.4;
         const double across = -pressure * (1 - 0.3 * 0.3) / 2.0,
                      along = pressure * 0.3 * 1.3 / 2.0;
         stack.bodies[0]->add_displacement("wide", bottom, 0,
                                           [=](double x, double) { return along * x; });
         stack.bodies[2]->add_pressure("press", top, pressure);
         for (auto &body : stack.bodies)
         {
            body->add_traction("shear", right, 0.0, shear);
            body->add_traction("shear", left, 0.0, -shear);
         }
         stack.bodies[2]->add_traction("shear", top, shear, 0.0);
         Reduction reduction = reduce(stack.named, stack.interfaces);
         const ReducedProblem &problem = reduction.problem;
         problem.validate();
         EXPECT_EQ(reduction.counters.factorisations,
                   elements == std::vector<int>({8, 11, 8}) ? 3 : 3);
         ASSERT_EQ(reduction.interfaces.size(), 2u);
         const Index n = problem.nodes();
         EXPECT_EQ(problem.rigid_motions.cols(), 6);
         const LoadPattern &press = problem.patterns[problem.pattern("press")],
                           &wide = problem.patterns[problem.pattern("wide")],
                           &turn = problem.patterns[problem.pattern("shear")];
         // Normals into the slave: of a slave below, y is down and x backwards.
         for (Index i = 0; i < n; ++i)
         {
            const double weight = problem.weights[i];
            EXPECT_NEAR((press.p[i] + wide.p[i]) / weight, pressure, 1e-11) << order;
            EXPECT_NEAR((press.q[i] + wide.q[i]) / weight, 0, 1e-11) << order;
            EXPECT_NEAR(turn.p[i] / weight, 0, 1e-11) << order;
            EXPECT_NEAR(turn.q[i] / weight, -shear, 1e-11) << order;
         }
         // And the fields are the exact ones.
         VectorXd loads = VectorXd::Zero(Index(problem.patterns.size()));
         for (const char *name : {"press", "wide", "shear"})
         {
            loads[problem.pattern(name)] = 1;
         }
         for (int b = 0; b < 3; ++b)
         {
            const ElasticBody &body = *stack.bodies[b];
            const VectorXd u =
               reduction.displacement(b, VectorXd::Zero(n), VectorXd::Zero(n), loads);
            const mfem::DenseMatrix &x = body.node_coordinates();
            for (int node = 0; node < x.Width(); ++node)
            {
               const double G = 2.0 / 2.6, X = x(0, node), Y = x(1, node);
               EXPECT_NEAR(u[body.true_dof(node, 0)], along * X + shear / G * Y, 1e-11);
               EXPECT_NEAR(u[body.true_dof(node, 1)], across * Y, 1e-11);
            }
         }
      }
   }
}

/// The same of blocks that stand on a plane of symmetry, whose contact nodes there are held.
TEST(InterfacesOfBodies, PassThePatchTestOnAPlaneOfSymmetry)
{
   Stack stack({5, 7, 3}, 2);
   for (auto &body : stack.bodies) { body->fix(left, 0); }
   stack.bodies[0]->fix(bottom, 1);
   stack.bodies[2]->add_pressure("press", top, 0.7);
   Reduction reduction = reduce(stack.named, stack.interfaces);
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   EXPECT_EQ(problem.held.size(), 2u);
   EXPECT_EQ(problem.rigid_motions.cols(), 2);
   for (Index i = 0; i < problem.nodes(); ++i)
   {
      EXPECT_NEAR(problem.patterns[0].p[i] / problem.weights[i], 0.7, 1e-11);
      EXPECT_NEAR(problem.patterns[0].q[i] / problem.weights[i], 0, 1e-11);
   }
   for (const ContactChain &chain : problem.chains)
   {
      EXPECT_TRUE(chain.mirrored_at(0) != chain.mirrored_at(1));
   }
}

/// Solved with friction: a stack that is pressed and sheared below the limit sticks, and its
/// resultants are those of the loads.
TEST(InterfacesOfBodies, StickUniformly)
{
   Stack stack({8, 11, 8}, 2);
   stack.bodies[0]->fix(bottom, 0);
   stack.bodies[0]->fix(bottom, 1);
   for (auto &body : stack.bodies)
   {
      body->add_traction("shear", right, 0.0, 1.0);
      body->add_traction("shear", left, 0.0, -1.0);
   }
   stack.bodies[2]->add_traction("shear", top, 1.0, 0.0);
   stack.bodies[2]->add_pressure("press", top, 1.0);
   Reduction reduction = reduce(stack.named, stack.interfaces);
   ReducedProblem &problem = reduction.problem;
   set_friction(problem, 0.5);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report =
      march(problem,
            LoadHistory::through(problem, {{}, {{"press", 1}}, {{"press", 1}, {"shear", 0.1}}}),
            state);
   EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   EXPECT_NEAR(state.p.sum(), 4, 1e-9); // of two interfaces
   EXPECT_NEAR(std::abs(state.q.sum()), 0.4, 1e-9);
}

/// Turned and scaled as a whole, and with elements in another order, it is the same.
TEST(InterfacesOfBodies, DoNotDependOnFrameUnitAndNumbering)
{
   const auto build = [](const std::function<void(mfem::Mesh &)> &move, double angle)
   {
      Stack stack({5, 7, 4}, 2, move);
      stack.bodies[0]->fix(bottom, 0);
      stack.bodies[0]->fix(bottom, 1);
      stack.bodies[2]->add_traction("P", top, std::sin(angle), -std::cos(angle));
      return reduce(stack.named, stack.interfaces).problem;
   };
   const ReducedProblem plain = build([](mfem::Mesh &) {}, 0);
   const auto same = [&](const ReducedProblem &other, double unit)
   {
      ASSERT_EQ(plain.nodes(), other.nodes());
      // Chains of one line may begin at either end.
      EXPECT_LT(difference(other.K, plain.K), 1e-9);
      EXPECT_LT(difference(other.patterns[0].p / unit, plain.patterns[0].p), 1e-9);
      EXPECT_LT(difference(other.weights / unit, plain.weights), 1e-12);
   };
   same(build([](mfem::Mesh &mesh) { rotate(mesh, 0.5); }, 0.5), 1);
   for (double unit : {1e-6, 1e5})
   {
      same(build(
              [=](mfem::Mesh &mesh)
              {
                 for (int v = 0; v < mesh.GetNV(); ++v)
                 {
                    for (int c : {0, 1}) { mesh.GetVertex(v)[c] *= unit; }
                 }
              },
              0),
           unit);
   }
   same(build(
           [](mfem::Mesh &mesh)
           {
              mfem::Array<int> order(mesh.GetNE());
              for (int e = 0; e < order.Size(); ++e) { order[e] = (e * 7 + 3) % order.Size(); }
              if (order.Size() % 7 == 0)
              {
                 for (int e = 0; e < order.Size(); ++e) { order[e] = order.Size() - 1 - e; }
              }
              mesh.ReorderElements(order);
           },
           0),
        1);
}

/// Rings one in the other (Lamé): a closed, curved line whose nodes do not match, two free
/// bodies that only the contact and each other hold. Pressure 925,926 Pa of the closed form.
TEST(InterfacesOfBodies, OfRingsHaveLamesPressure)
{
   const auto ring = [](int around, double from, double to, double phase)
   {
      const int rows = 5;
      mfem::Mesh closed(2, around * rows, around * (rows - 1), 2 * around);
      for (int j = 0; j < rows; ++j)
      {
         for (int i = 0; i < around; ++i)
         {
            const double r = from + (to - from) * j / (rows - 1),
                         angle = 2 * M_PI * i / around + phase;
            closed.AddVertex(r * std::cos(angle), r * std::sin(angle));
         }
      }
      for (int j = 0; j + 1 < rows; ++j)
      {
         for (int i = 0; i < around; ++i)
         {
            const int next = (i + 1) % around;
            closed.AddQuad(j * around + i, (j + 1) * around + i, (j + 1) * around + next,
                           j * around + next);
         }
      }
      for (int i = 0; i < around; ++i)
      {
         const int next = (i + 1) % around;
         closed.AddBdrSegment(i, next, 1);
         closed.AddBdrSegment((rows - 1) * around + i, (rows - 1) * around + next, 2);
      }
      closed.FinalizeQuadMesh(1, 0, true);
      closed.SetCurvature(2);
      closed.Transform(
         [=](const mfem::Vector &x, mfem::Vector &y)
         {
            // The middles of chords onto their arcs.
            const double step = (std::atan2(x(1), x(0)) - phase) * around / (2 * M_PI);
            const bool middle = std::abs(step - std::round(step)) > 0.25;
            y.SetSize(2);
            y = x;
            y *= middle ? 1 / std::cos(M_PI / around) : 1.0;
         });
      return closed;
   };
   double before = 0;
   for (int n : {16, 32})
   {
      mfem::Mesh inside = ring(n, 0.2, 0.6, 0.1), outside = ring(n * 137 / 100, 0.6, 1.0, 0);
      ElasticBody inner(inside, 2, Material{1e9, 0.2}), outer(outside, 2, Material{1e9, 0.2});
      outer.add_pressure("P", 2, 1e6);
      Reduction reduction =
         reduce({{"inner", &inner}, {"outer", &outer}},
                {{"fit", {0, 2}, {1, 1}, SlaveSide::coarser, ScalarField(0.0)}});
      const ReducedProblem &problem = reduction.problem;
      problem.validate();
      EXPECT_TRUE(problem.chains[0].loop);
      EXPECT_EQ(problem.rigid_motions.cols(), 3);
      double error = 0;
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         error = std::max(error,
                          std::abs(problem.patterns[0].p[i] / problem.weights[i] / 925926 - 1));
      }
      EXPECT_LT(error, n == 16 ? 1e-2 : 2.5e-3) << n;
      EXPECT_LT(reduction.interfaces[0].arm, 1e-5);
      if (before > 0) { EXPECT_LT(error, before / 2); }
      before = error;
   }
}

TEST(InterfacesOfBodies, NameWhatDoesNotFit)
{
   Stack stack({5, 7, 4}, 2);
   stack.bodies[0]->fix(bottom, 0);
   stack.bodies[0]->fix(bottom, 1);
   expect_input_error(
      [&] {
         reduce(stack.named, {{"low", {0, top}, {1, bottom}}});
      },
      "body 'plate 3' is in no interface");
   expect_input_error(
      [&] {
         reduce(stack.named, {{"low", {0, top}, {3, bottom}}});
      },
      "interface 'low': a side names body 3");
   expect_input_error(
      [&] {
         reduce({stack.named[0], stack.named[1]}, {{"low", {0, top}, {1, top}}});
      },
      "interface 'low' of body 'plate 1' and body 'plate 2': the lines face each other "
      "nowhere");
   expect_input_error(
      [&] {
         reduce({stack.named[1], stack.named[2]}, {{"through", {0, bottom}, {1, top}}});
      },
      "interface 'through' of body 'plate 2' and body 'plate 3': the sides overlap by ");
}

} // namespace
