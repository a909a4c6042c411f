#include "contact_laws.hpp"
#include "elastic_support.hpp"

#include <Eigen/Geometry>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/pairing.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Solid = mfem::Element::Type;

/// Attributes that MFEM gives to the sides of a block.
constexpr int low_z = 1, low_y = 2, high_x = 3, high_y = 4, low_x = 5, high_z = 6;

const std::array<Solid, 3> solids = {Solid::HEXAHEDRON, Solid::WEDGE, Solid::TETRAHEDRON};

/// A block of cells, with the corner of smallest coordinates at `corner`.
mfem::Mesh brick(Solid solid, const std::array<int, 3> &cells, const Vector3d &size,
                 const Vector3d &corner = Vector3d::Zero())
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian3D(cells[0], cells[1], cells[2], solid, size[0],
                                                 size[1], size[2]);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      for (int c = 0; c < 3; ++c) { mesh.GetVertex(v)[c] += corner[c]; }
   }
   return mesh;
}

void turn_mesh(mfem::Mesh &mesh, const Matrix3d &turn)
{
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      Eigen::Map<Vector3d> at(mesh.GetVertex(v));
      at = (turn * at).eval();
   }
}

const Matrix3d tilted =
   (Eigen::AngleAxisd(0.7, Vector3d::UnitX()) * Eigen::AngleAxisd(-1.1, Vector3d::UnitY()) *
    Eigen::AngleAxisd(0.4, Vector3d::UnitZ()))
      .toRotationMatrix();

/// Resultant force and moment about the origin of a load.
std::pair<Vector3d, Vector3d> resultant(const ElasticBody &body, int load)
{
   Vector3d force = Vector3d::Zero(), moment = force;
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      Vector3d at;
      for (int c = 0; c < 3; ++c)
      {
         at[c] = body.patterns()[load].values(body.true_dof(node, c));
      }
      force += at;
      moment += body.place(node).cross(at);
   }
   return {force, moment};
}

/// A displacement of all dofs, from a function of the place.
VectorXd field_on(const ElasticBody &body, const std::function<Vector3d(const Vector3d &)> &u)
{
   VectorXd made(body.dofs());
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      const Vector3d at = u(body.place(node));
      for (int c = 0; c < 3; ++c) { made[body.true_dof(node, c)] = at[c]; }
   }
   return made;
}

VectorXd times(const mfem::SparseMatrix &K, const VectorXd &u)
{
   mfem::Vector product(K.Height());
   K.Mult(to_mfem(u), product);
   return view(product);
}

std::vector<ContactState> marched(ReducedProblem problem, double friction,
                                  const std::vector<VectorXd> &loads)
{
   set_friction(problem, friction);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   cattaneo_test::LawChecker laws(problem, state);
   std::vector<ContactState> all;
   for (const VectorXd &each : loads)
   {
      const VectorXd before = state.v;
      EXPECT_EQ(solver.solve(state, each).status, FrictionStatus::converged);
      EXPECT_LE(laws.violation(before, state), 1) << laws.what();
      all.push_back(state);
   }
   return all;
}

/// A uniform stress has the forces of its tractions, whatever the elements are: bodies, loads
/// and their integrals are exact for it.
TEST(BodiesInSpace, UniformStressIsInBalance)
{
   Matrix3d strain;
   strain << 3, 0.4, -0.7, 0.4, -2, 0.9, -0.7, 0.9, 1.5;
   const Material material{3, 0.3};
   const Matrix3d stress =
      material.lambda() * strain.trace() * Matrix3d::Identity() + 2 * material.mu() * strain;
   for (const Solid solid : solids)
   {
      for (const int order : {1, 2, 3})
      {
         mfem::Mesh mesh = brick(solid, {3, 2, 2}, {3, 2, 2});
         // Within, elements are no parallelepipeds.
         for (int v = 0; v < mesh.GetNV(); ++v)
         {
            double *x = mesh.GetVertex(v);
            const bool inner =
               x[0] > 0 && x[0] < 3 && x[1] > 0 && x[1] < 2 && x[2] > 0 && x[2] < 2;
            for (int c = 0; c < 3 && inner; ++c) { x[c] += 0.1 * (c + 1) * (x[0] - 1.3); }
         }
         turn_mesh(mesh, tilted);
         ElasticBody body(mesh, order, material);
         EXPECT_EQ(body.formulation(), Formulation::space);
         const Matrix3d global = tilted * stress * tilted.transpose();
         for (int side = 1; side <= 6; ++side)
         {
            const std::array<Vector3d, 6> normals = {Vector3d(0, 0, -1), Vector3d(0, -1, 0),
                                                     Vector3d(1, 0, 0),  Vector3d(0, 1, 0),
                                                     Vector3d(-1, 0, 0), Vector3d(0, 0, 1)};
            const Vector3d t = global * tilted * normals[side - 1];
            body.add_traction("S", side, t[0], t[1], t[2]);
         }
         const VectorXd u = field_on(body,
                                     [&](const Vector3d &x) -> Vector3d
                                     { return tilted * strain * tilted.transpose() * x; });
         const VectorXd &forces = body.patterns()[0].values;
         EXPECT_LT((times(body.stiffness(), u) - forces).cwiseAbs().maxCoeff(),
                   1e-12 * largest(forces))
            << "solid " << solid << " of order " << order;
         mfem::GridFunction field(&body.space());
         field.SetFromTrueDofs(to_mfem(u));
         mfem::ElementTransformation &at = *mesh.GetElementTransformation(1);
         at.SetIntPoint(&mfem::Geometries.GetCenter(mesh.GetElementBaseGeometry(1)));
         const Stress found = stress_at(body, field, at);
         Matrix3d all;
         all << found.xx, found.xy, found.xz, found.xy, found.yy, found.yz, found.xz, found.yz,
            found.zz;
         EXPECT_LT((all - global).norm(), 1e-12 * global.norm());
         const Matrix3d deviator = stress - stress.trace() / 3 * Matrix3d::Identity();
         EXPECT_NEAR(found.von_mises(), std::sqrt(1.5) * deviator.norm(), 1e-11);
      }
   }
}

/// Two bodies with matching nodes under a uniform stress bear it at each node of their contact.
TEST(BodiesInSpace, ContactBearsAUniformStress)
{
   Matrix3d stress;
   stress << 0.3, 0.1, 0.2, 0.1, -0.4, -0.25, 0.2, -0.25, -1;
   stress = (tilted * stress * tilted.transpose()).eval();
   for (const Solid solid : solids)
   {
      for (const int order : {1, 2})
      {
         mfem::Mesh above = brick(solid, {3, 2, 1}, {3, 2, 1}),
                    below = brick(solid, {3, 2, 2}, {3, 2, 2}, {0, 0, -2});
         for (mfem::Mesh *mesh : {&above, &below}) { turn_mesh(*mesh, tilted); }
         ElasticBody upper(above, order, Material{2, 0.3}), lower(below, order, {2, 0.3});
         const std::array<Vector3d, 6> normals = {Vector3d(0, 0, -1), Vector3d(0, -1, 0),
                                                  Vector3d(1, 0, 0),  Vector3d(0, 1, 0),
                                                  Vector3d(-1, 0, 0), Vector3d(0, 0, 1)};
         for (int side = 1; side <= 6; ++side)
         {
            const Vector3d t = stress * tilted * normals[side - 1];
            if (side != low_z) { upper.add_traction("S", side, t[0], t[1], t[2]); }
            if (side != high_z) { lower.add_traction("S", side, t[0], t[1], t[2]); }
         }
         // Held as it must be and not more, so that supports bear nothing.
         const auto hold = [&](const Vector3d &corner, const std::vector<int> &components)
         {
            const Vector3d x = tilted * corner;
            for (const int c : components) { lower.fix_node(x[0], x[1], x[2], c); }
         };
         hold({0, 0, -2}, {0, 1, 2});
         hold({3, 0, -2}, {1, 2});
         hold({0, 2, -2}, {0});
         const ContactSurface foot = contact_surface(upper, low_z),
                              head = contact_surface(lower, high_z);
         EXPECT_EQ(foot.size(), order == 1 ? 12 : 35);
         EXPECT_NEAR(foot.weights().sum(), 6, 1e-12);
         EXPECT_EQ(foot.has_middles(), order == 2 && foot.faces[0].size() == 6);
         const Reduction reduction =
            reduce(condense(upper, foot), condense(lower, head), pair_surfaces(foot, head));
         const ContactState state =
            marched(reduction.problem, 0.9, {VectorXd::Constant(1, 1)}).front();
         const MatrixXd forces = reduction.contact_forces(0, state.q, state.p);
         // The lower one pushes on the face whose normal out of the upper one is -z.
         const Vector3d traction = stress * tilted * Vector3d(0, 0, -1);
         const MatrixXd expected = foot.forces_at_nodes(foot.weights() * traction.transpose());
         EXPECT_LT(difference(forces, expected), 1e-12)
            << "solid " << solid << " of order " << order;
      }
   }
}

/// A block is pressed on another one and sheared to and fro, in plane strain, and as a slice of
/// one element and of three between walls without friction.
TEST(BodiesInSpace, ExtrudedPlaneProblemIsThePlaneOne)
{
   const double thick = 0.7;
   const std::vector<Eigen::Vector2d> path = {{1, 0},    {1, 0.2}, {1, 0.3},
                                              {1, 0.36}, {1, 0.1}, {1, -0.33}};
   const std::vector<VectorXd> loads(path.begin(), path.end());
   for (const Solid flat : {Solid::QUADRILATERAL, Solid::TRIANGLE})
   {
      for (const int order : {1, 2})
      {
         const auto mesh_of = [&](double y, double height)
         {
            mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(6, 3, flat, true, 3, height);
            for (int v = 0; v < mesh.GetNV(); ++v) { mesh.GetVertex(v)[1] += y; }
            return mesh;
         };
         mfem::Mesh above = mesh_of(0, 2), below = mesh_of(-1, 1);
         ElasticBody upper(above, order, Material{2, 0.3}), lower(below, order, {5, 0.2});
         for (const int c : {0, 1}) { lower.fix(bottom, c); }
         upper.add_pressure("P", top, 1.0);
         upper.add_traction("Q", top, 1.0, 0.0);
         const CondensedBody one = condense(upper, contact_line(upper, bottom)),
                             two = condense(lower, contact_line(lower, top));
         const Reduction plane = reduce(one, two, pair_lines(one.line, two.line));
         const std::vector<ContactState> expected = marched(plane.problem, 0.4, loads);
         // Some of all states are there, or the comparison says little.
         std::array<int, 3> seen{};
         for (const ContactState &state : expected)
         {
            for (const NodeState each : state.status)
            {
               ++seen[!closed(each) ? 0 : slips(each) ? 1 : 2];
            }
         }
         ASSERT_TRUE(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
         for (const int layers : {1, 3})
         {
            const std::unique_ptr<mfem::Mesh> above3(Extrude2D(&above, layers, thick)),
               below3(Extrude2D(&below, layers, thick));
            ElasticBody first(*above3, order, Material{2, 0.3}),
               second(*below3, order, Material{5, 0.2});
            // MFEM gives both ends of what is extruded the attributes after those of the sides.
            const std::vector<int> walls(above3->bdr_attributes.begin() + 4,
                                         above3->bdr_attributes.end());
            ASSERT_FALSE(walls.empty());
            first.fix(walls, 2);
            second.fix(walls, 2);
            for (const int c : {0, 1, 2}) { second.fix(bottom, c); }
            first.add_pressure("P", top, 1.0);
            first.add_traction("Q", top, 1.0, 0.0, 0.0);
            const ContactSurface foot = contact_surface(first, bottom),
                                 head = contact_surface(second, top);
            const Reduction reduction =
               reduce(condense(first, foot), condense(second, head), pair_surfaces(foot, head));
            EXPECT_EQ(reduction.problem.nodes(), plane.problem.nodes() * (layers * order + 1));
            const std::vector<ContactState> states = marched(reduction.problem, 0.4, loads);
            for (std::size_t k = 0; k < states.size(); ++k)
            {
               const MatrixXd forces = reduction.contact_forces(0, states[k].q, states[k].p),
                              flat_forces =
                                 plane.contact_forces(0, expected[k].q, expected[k].p);
               MatrixXd sums = MatrixXd::Zero(flat_forces.rows(), 2);
               for (Eigen::Index i = 0; i < foot.size(); ++i)
               {
                  Eigen::Index m = 0;
                  while (std::abs(one.line.nodes[m].position[0] - foot.nodes[i].position[0]) >
                         1e-9)
                  {
                     ++m;
                  }
                  sums.row(m) += forces.row(i).head(2);
                  EXPECT_NEAR(states[k].w[i], expected[k].w[m], 1e-10 * largest(expected[k].w));
               }
               EXPECT_LT(difference(sums, thick * flat_forces), 1e-10)
                  << "type " << flat << ", order " << order << ", " << layers << " layers";
            }
         }
      }
   }
}

TEST(BodiesInSpace, LoadsHaveTheirResultants)
{
   for (const Solid solid : solids)
   {
      for (const int order : {1, 2})
      {
         mfem::Mesh mesh = brick(solid, {2, 3, 2}, {2, 3, 1});
         ElasticBody body(mesh, order, Material{});
         body.add_pressure("pressure", high_x, [](double, double y, double) { return y; });
         body.add_traction(
            "traction", high_y, 1.0, [](double x, double) { return x; },
            [](double, double, double z) { return z * z; });
         body.add_body_force(
            "weight", 0.0, [](double x, double) { return -x; }, -2.0);
         body.add_pressure("half", BoundaryPart({high_z}, 0, 1, 2), 1.0);
         const auto expect = [&](int load, const Vector3d &force, const Vector3d &moment)
         {
            const auto [f, m] = resultant(body, load);
            EXPECT_LT((f - force).norm(), 1e-13 * 10) << body.patterns()[load].name;
            EXPECT_LT((m - moment).norm(), 1e-13 * 30) << body.patterns()[load].name;
         };
         // By hand: integrals over 0 < y < 3, 0 < z < 1 at x = 2, and so on.
         expect(0, {-4.5, 0, 0}, {0, -2.25, 9});
         expect(1, {2, 2, 2.0 / 3}, {3 * 2.0 / 3 - 1, 1 - 2.0 / 3, 8.0 / 3 - 6});
         expect(2, {0, -6, -12}, {-12 * 1.5 + 3, 12, -8});
         expect(3, {0, 0, -3}, {-4.5, 4.5, 0});
         const ElasticBody::Extent part = body.extent(BoundaryPart({high_z}, 0, 1, 2));
         EXPECT_NEAR(part.size, 3, 1e-14);
         EXPECT_LT((part.middle - Vector3d(1.5, 1.5, 1)).norm(), 1e-14);
         expect_input_error(
            [&] { body.add_pressure("cut", BoundaryPart({high_z}, 0, 0.5, 2), 1.0); },
            "in space an interval must end where faces end");
      }
   }
   // All over a curved body a pressure has no resultant.
   mfem::Mesh ball = brick(Solid::HEXAHEDRON, {2, 2, 2}, {2, 2, 2}, {-1, -1, -1});
   ball.SetCurvature(2);
   ball.Transform(
      [](const mfem::Vector &x, mfem::Vector &y)
      {
         y = x;
         const double cube = x.Normlinf();
         if (cube > 0) { y *= (1 + cube) / (1 + x.Norml2()); }
      });
   ElasticBody body(ball, 2, Material{});
   body.add_pressure("P", {{1, 2, 3, 4, 5, 6}}, 1.0);
   const auto [f, m] = resultant(body, 0);
   EXPECT_LT(f.norm(), 1e-13);
   EXPECT_LT(m.norm(), 1e-13);
}

TEST(BodiesInSpace, FreeExpansionHasNoStress)
{
   mfem::Mesh mesh = brick(Solid::TETRAHEDRON, {2, 2, 2}, {1, 1, 1});
   ElasticBody body(mesh, 2, Material{2, 0.3});
   body.add_initial_strain("T", [](double, double, double) { return 0.01; });
   const VectorXd u = field_on(body, [](const Vector3d &x) -> Vector3d { return 0.01 * x; });
   const VectorXd &forces = body.patterns()[0].values;
   EXPECT_LT((times(body.stiffness(), u) - forces).norm(), 1e-13 * forces.norm());
   mfem::GridFunction field(&body.space());
   field.SetFromTrueDofs(to_mfem(u));
   mfem::ElementTransformation &at = *mesh.GetElementTransformation(0);
   at.SetIntPoint(&mfem::Geometries.GetCenter(mfem::Geometry::TETRAHEDRON));
   EXPECT_LT(stress_at(body, field, at, {{"T", 1}}).von_mises(), 1e-14);
   EXPECT_LT(std::abs(stress_at(body, field, at, {{"T", 1}}).xx), 1e-14);
   // A shear strain is one of its tensor.
   mfem::DenseMatrix shear(3);
   shear = 0.0;
   shear(0, 2) = shear(2, 0) = 0.5;
   mfem::MatrixConstantCoefficient strain(shear);
   body.add_initial_strain("shear", strain);
   const VectorXd v = field_on(body, [](const Vector3d &x) { return Vector3d(x[2], 0, 0); });
   const VectorXd &of_shear = body.patterns()[1].values;
   EXPECT_LT((times(body.stiffness(), v) - of_shear).norm(), 1e-13 * of_shear.norm());
}

TEST(BodiesInSpace, MaterialsFormsAndOperatorsAreTheUsers)
{
   mfem::Mesh mesh = brick(Solid::HEXAHEDRON, {3, 1, 1}, {3, 1, 1});
   for (int e = 0; e < mesh.GetNE(); ++e) { mesh.SetAttribute(e, e == 1 ? 2 : 1); }
   mesh.SetAttributes();
   const ElasticBody two(mesh, 2, std::vector<Material>{{2, 0.3}, {5, 0.1}});
   const ElasticBody varies(
      mesh, 2, [](double x, double, double) { return x > 1 && x < 2 ? 5 : 2; },
      [](double x, double) { return x > 1 && x < 2 ? 0.1 : 0.3; });
   EXPECT_LT(difference(dense(varies.stiffness()), dense(two.stiffness())), 1e-12);
   // MFEM's own form, integrator and true dofs.
   mfem::H1_FECollection collection(2, 3);
   mfem::FiniteElementSpace space(&mesh, &collection, 3, mfem::Ordering::byNODES);
   mfem::Vector lambda(2), mu(2);
   for (const int k : {0, 1})
   {
      const Material &one = two.material(k + 1);
      lambda[k] = one.lambda();
      mu[k] = one.mu();
   }
   mfem::PWConstCoefficient of_lambda(lambda), of_mu(mu);
   mfem::BilinearForm form(&space);
   form.AddDomainIntegrator(new mfem::ElasticityIntegrator(of_lambda, of_mu));
   form.Assemble();
   form.Finalize();
   ElasticBody users(space, form.SpMat());
   ElasticBody own(mesh, 2, std::vector<Material>{{2, 0.3}, {5, 0.1}});
   std::vector<MatrixXd> stiffness;
   for (ElasticBody *body : {&users, &own})
   {
      mfem::Array<int> essential, marker(6);
      marker = 0;
      marker[low_x - 1] = 1;
      body->space().GetEssentialTrueDofs(marker, essential);
      body->fix(essential);
      stiffness.push_back(condense(*body, contact_surface(*body, low_z)).S);
   }
   EXPECT_LT(difference(stiffness[0], stiffness[1]), 1e-12);
}

TEST(BodiesInSpace, PrescribedDisplacementsFollowTheirFunction)
{
   mfem::Mesh mesh = brick(Solid::WEDGE, {2, 2, 2}, {1, 1, 1});
   ElasticBody body(mesh, 1, Material{});
   body.add_displacement("D", high_z, 2,
                         [](double x, double y, double z) { return x + 2 * y + 3 * z; });
   for (const int c : {0, 1, 2}) { body.fix(low_z, c); }
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      const Vector3d x = body.place(node);
      const double expected = x[2] == 1 ? x[0] + 2 * x[1] + 3 : 0;
      EXPECT_EQ(body.patterns()[0].values[body.true_dof(node, 2)], expected);
   }
   EXPECT_EQ(body.prescribed_dofs("D").size(), 9u);
}

TEST(BodiesInSpace, RefuseWhatTheyCannotTake)
{
   mfem::Mesh mesh = brick(Solid::HEXAHEDRON, {1, 1, 1}, {1, 1, 1});
   Material stress;
   stress.state = PlaneState::stress;
   expect_input_error([&] { ElasticBody(mesh, 1, stress); }, "in plane stress");
   expect_input_error([&] { ElasticBody(mesh, 1, Material{}, Formulation::axisymmetric); },
                      "the formulation is axisymmetric");
   mfem::Mesh flat = mfem::Mesh::MakeCartesian2D(1, 1, Solid::QUADRILATERAL);
   expect_input_error([&] { ElasticBody(flat, 1, Material{}, Formulation::space); },
                      "the mesh is of dimension 2");
   ElasticBody body(mesh, 1, Material{});
   expect_input_error([&] { body.fix(1, 3); }, "must be 0 (x), 1 (y) or 2 (z)");
   expect_input_error([&] { body.fix_node(0, 0, 0); }, "two coordinates are given");
   expect_input_error([&] { body.add_traction("P", 1, 0.0, 0.0); }, "must be 3");
   expect_input_error([&] { body.add_body_force("P", 0.0, 0.0); }, "must be 3");
   expect_input_error([&] { contact_line(body, 1); }, "its contact is a surface");
   expect_input_error([&] { contact_surface(body, 7); }, "no boundary attribute 7");
   ElasticBody plane(flat, 1, Material{});
   expect_input_error([&] { plane.fix_node(0, 0, 0, 0); }, "three coordinates are given");
   expect_input_error([&] { plane.add_traction("P", 1, 0.0, 0.0, 0.0); }, "must be 2");
   expect_input_error([&] { contact_surface(plane, 1); }, "must be in space");
   mfem::Mesh refined = brick(Solid::HEXAHEDRON, {2, 1, 1}, {2, 1, 1});
   refined.EnsureNCMesh();
   mfem::Array<int> first;
   first.Append(0);
   refined.GeneralRefinement(first, 1);
   expect_input_error([&] { ElasticBody(refined, 1, Material{}); }, "nonconforming");
}

/// CalculiX writes its stiffness of two blocks' elements: C3D4 and C3D8 are MFEM's of order 1,
/// straight C3D10 of order 2.
TEST(BodiesInSpace, StiffnessIsThatOfCalculiX)
{
   if (std::system("command -v ccx > /dev/null") != 0)
   {
      GTEST_SKIP() << "there is no ccx (Debian: calculix-ccx) to write the matrix";
   }
   struct Case
   {
      const char *type;
      Solid solid;
      int order;
   };
   for (const Case &each : {Case{"C3D4", Solid::TETRAHEDRON, 1},
                            {"C3D8", Solid::HEXAHEDRON, 1},
                            {"C3D10", Solid::TETRAHEDRON, 2}})
   {
      mfem::Mesh mesh = brick(each.solid, {2, 2, 1}, {1, 1.5, 0.7});
      const ElasticBody body(mesh, each.order, Material{200, 0.3});
      std::ofstream deck("bodies_in_space.inp");
      deck.precision(17);
      deck << "*NODE\n";
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         const Vector3d x = body.place(node);
         deck << node + 1 << ", " << x[0] << ", " << x[1] << ", " << x[2] << "\n";
      }
      deck << "*ELEMENT, TYPE=" << each.type << ", ELSET=ALL\n";
      mfem::Array<int> nodes;
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         body.space().GetElementDofs(e, nodes);
         // MFEM has the edges of a tetrahedron as 01 02 03 12 13 23, CalculiX as 01 12 20 03 ….
         const std::vector<int> order = {0, 1, 2, 3, 4, 7, 5, 6, 8, 9};
         deck << e + 1;
         for (int k = 0; k < nodes.Size(); ++k)
         {
            deck << ", " << nodes[nodes.Size() == 10 ? order[k] : k] + 1;
         }
         deck << "\n";
      }
      deck << "*MATERIAL, NAME=M\n*ELASTIC\n200., 0.3\n*DENSITY\n1.\n"
           << "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n"
           << "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n*END STEP\n";
      deck.close();
      ASSERT_EQ(std::system("ccx bodies_in_space > /dev/null"), 0);
      const NodalStiffness read = read_stiffness("bodies_in_space.sti");
      ASSERT_EQ(read.K.rows(), body.dofs());
      const MatrixXd theirs = MatrixXd(read.K), ours = dense(body.stiffness());
      MatrixXd sorted(theirs.rows(), theirs.cols());
      const auto dof = [&](Eigen::Index row)
      { return body.true_dof(read.dofs[row].node - 1, read.dofs[row].direction - 1); };
      for (Eigen::Index i = 0; i < theirs.rows(); ++i)
      {
         for (Eigen::Index k = 0; k < theirs.rows(); ++k)
         {
            sorted(dof(i), dof(k)) = theirs(i, k);
         }
      }
      EXPECT_LT(difference(sorted, ours), 1e-10) << each.type;
   }
   for (const auto &file : std::filesystem::directory_iterator("."))
   {
      if (file.path().stem() == "bodies_in_space") { std::filesystem::remove(file); }
   }
}

} // namespace
