// What a program of MFEM has at hand, vectors, forms, markers, coefficients and grid functions,
// says the same as the library's own words for it.
#include "comparison.hpp"
#include "elastic_support.hpp"
#include <array>
#include <cattaneo/elastic/assembly.hpp>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/output/paraview.hpp>
#include <limits>
#include <string>

namespace
{

using namespace cattaneo;
using namespace support;

/// Largest deviation of the stresses (xx, yy, zz, xy) of all elements, at their corners,
/// centres and points between, from those that are expected at (x, y).
template <class Expected>
double stress_error(const ElasticBody &body, const VectorXd &displacement,
                    const NamedLoads &loads, Expected expected)
{
   mfem::FiniteElementSpace &space = body.space();
   mfem::GridFunction u(&space);
   u.SetFromTrueDofs(to_mfem(displacement));
   double largest = 0;
   for (int e = 0; e < space.GetNE(); ++e)
   {
      mfem::ElementTransformation &at = *space.GetElementTransformation(e);
      const mfem::IntegrationRule &points =
         mfem::IntRules.Get(space.GetFE(e)->GetGeomType(), 3);
      for (int k = 0; k < points.GetNPoints(); ++k)
      {
         at.SetIntPoint(&points.IntPoint(k));
         mfem::Vector x(2);
         at.Transform(points.IntPoint(k), x);
         const Stress s = stress_at(body, u, at, loads);
         const std::array<double, 4> wanted = expected(x(0), x(1));
         const double found[] = {s.xx, s.yy, s.zz, s.xy};
         for (int c = 0; c < 4; ++c)
         {
            largest = std::max(largest, std::abs(found[c] - wanted[c]));
         }
      }
   }
   return largest;
}

/// Displacement of the body's only pattern at multiplier 1 with no forces at the contact nodes.
VectorXd without_contact(const CondensedBody &condensed)
{
   CondensedBody body = condensed;
   VectorXd f(body.S.rows());
   f << body.patterns[0].q, body.patterns[0].p;
   return body.recover(-body.S.ldlt().solve(f), VectorXd::Ones(1));
}

/// Held at three components, so that it expands freely.
void hold_loosely(ElasticBody &body)
{
   body.fix_node(0, 0, 0);
   body.fix_node(0, 0, 1);
   body.fix_node(2, 0, 1);
}

TEST(MfemDoors, ForcesOnTrueDofsAndOfLinearFormsAreThoseOfTractionsAndBodyForces)
{
   for (const char *kind : {"quads", "triangles", "nonconforming"})
   {
      mfem::Mesh mesh = block(kind);
      ElasticBody body(mesh, 2, Material{});
      body.add_traction("traction", 3, 0.5, -2.0);
      body.add_body_force("weight", 0.25, -3.0);

      mfem::Vector pull({0.5, -2.0}), weight({0.25, -3.0});
      mfem::VectorConstantCoefficient traction(pull), gravity(weight);
      mfem::Array<int> top({0, 0, 1, 0});
      mfem::LinearForm on_top(&body.space()), within(&body.space());
      on_top.AddBoundaryIntegrator(new mfem::VectorBoundaryLFIntegrator(traction), top);
      on_top.Assemble();
      within.AddDomainIntegrator(new mfem::VectorDomainLFIntegrator(gravity));
      within.Assemble();
      body.add_forces("form of the traction", on_top);
      body.add_forces("form of the weight", within);
      body.add_forces("both", to_mfem(body.patterns()[0].values));
      body.add_forces("both", within);
      const auto &patterns = body.patterns();
      EXPECT_LT(difference(patterns[2].values, patterns[0].values), 1e-13) << kind;
      EXPECT_LT(difference(patterns[3].values, patterns[1].values), 1e-13) << kind;
      EXPECT_LT(difference(patterns[4].values, patterns[0].values + patterns[1].values), 1e-13)
         << kind;
   }
}

TEST(MfemDoors, ForcesThatDoNotFitAreRefused)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   const int size = body.space().GetTrueVSize();
   mfem::Vector forces(size - 1);
   forces = 0.0;
   expect_input_error([&] { body.add_forces("P", forces); },
                      "forces 'P': " + std::to_string(size - 1) +
                         " values are given, must be " + std::to_string(size));
   forces.SetSize(size);
   forces = 0.0;
   forces(3) = nan_value;
   expect_input_error([&] { body.add_forces("P", forces); }, "the force on true dof 3 is nan");
   EXPECT_TRUE(body.patterns().empty());

   mfem::H1_FECollection collection(1, 2);
   mfem::FiniteElementSpace other(&mesh, &collection, 2);
   mfem::LinearForm form(&other);
   form.Assemble();
   expect_input_error([&] { body.add_forces("P", form); }, "must be on the space of the body");
   mfem::LinearForm forgotten(&body.space());
   mfem::Vector pull({1.0, 0.0});
   mfem::VectorConstantCoefficient traction(pull);
   forgotten.AddBoundaryIntegrator(new mfem::VectorBoundaryLFIntegrator(traction));
   for (const double left_there : {0.0, 6.9e-310}) // a pointer read as a number
   {
      forgotten = left_there;
      expect_input_error([&] { body.add_forces("P", forgotten); }, "must have been assembled");
   }
   forgotten.Assemble();
   body.add_forces("pull", forgotten);
   body.add_displacement("u", 3, 1, -0.1);
   forces = 0.0;
   expect_input_error([&] { body.add_forces("u", forces); }, "controlled by displacement");
}

TEST(MfemDoors, TrueDofsAndMarkersHoldWhatAttributesHold)
{
   for (const char *kind : {"quads", "nonconforming triangles"})
   {
      mfem::Mesh mesh = block(kind);
      ElasticBody body(mesh, 2, Material{}), by_dofs(mesh, 2, Material{}),
         by_marker(mesh, 2, Material{});
      body.fix({std::vector<int>{2, 4}}, 0);
      body.add_pressure("P", {std::vector<int>{3, 4}}, 2.0);
      mfem::Array<int> sides({0, 1, 0, 1}), dofs, loaded({0, 0, 1, 1});
      by_dofs.space().GetEssentialTrueDofs(sides, dofs, 0);
      by_dofs.fix(dofs);
      by_marker.fix(sides, 0);
      by_marker.add_pressure("P", loaded, 2.0);
      const auto held = body.essential_dofs();
      const auto list = [](const mfem::Array<int> &a)
      { return std::vector<int>(a.begin(), a.end()); };
      EXPECT_GT(held.Size(), 5);
      EXPECT_EQ(list(by_dofs.essential_dofs()), list(held)) << kind;
      EXPECT_EQ(list(by_marker.essential_dofs()), list(held)) << kind;
      EXPECT_EQ(by_marker.patterns()[0].values, body.patterns()[0].values) << kind;
      mfem::Array<int> bottom({1, 0, 0, 0});
      const ContactLine marked = contact_line(body, bottom), named = contact_line(body, 1);
      ASSERT_EQ(marked.size(), named.size());
      for (Eigen::Index i = 0; i < named.size(); ++i)
      {
         EXPECT_EQ(marked.nodes[i].dofs, named.nodes[i].dofs);
      }

      const int size = body.space().GetTrueVSize();
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({0, size}));
         },
         "fix: true dof " + std::to_string(size) + ", must be from 0 to " +
            std::to_string(size - 1));
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({2, 4}), 0);
         },
         "entry 0 of 2 is 2, must be 0 or 1");
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({0, 0}), 0);
         },
         "none of its 2 entries is 1");
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({0, 0, 0, 0, 1}), 0);
         },
         "attribute 5");
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({0, 1}), 0);
         },
         "fix: the boundary marker has 2 entries, must have 4");
      expect_input_error(
         [&] {
            body.add_pressure("P", mfem::Array<int>({0, 0, 1, 0, 0}), 1.0);
         },
         "pressure 'P': the boundary marker has 5 entries, must have 4");
      expect_input_error([&] { contact_line(body, mfem::Array<int>({1})); },
                         "the boundary marker has 1 entries, must have 4");
      expect_input_error(
         [&] {
            body.fix(mfem::Array<int>({0, 0, 0, 1}));
         },
         "fix: true dof 0 is there 3 times");
      EXPECT_EQ(list(body.essential_dofs()), list(held)) << kind;
   }
}

TEST(MfemDoors, AMatrixThatWasEliminatedIsRefused)
{
   mfem::Mesh mesh = block("quads");
   const ElasticBody body(mesh, 2, Material{});
   const mfem::Array<int> top({0, 0, 1, 0});
   mfem::Array<int> dofs;
   body.space().GetEssentialTrueDofs(top, dofs);
   mfem::SparseMatrix eliminated = body.stiffness();
   for (int dof : dofs) { eliminated.EliminateRowCol(dof); }
   ElasticBody own(body.space(), eliminated), sound(body.space(), body.stiffness());
   for (ElasticBody *one : {&own, &sound})
   {
      one->fix(top, 0);
      one->add_displacement("press", top, 1, [](double, double) { return -1; });
   }
   EXPECT_NO_THROW(condense(sound, contact_line(sound, 1)));
   expect_input_error([&] { condense(own, contact_line(own, 1)); },
                      "was the matrix eliminated?");
}

TEST(MfemDoors, ConstantsAsFieldsAreTheMaterial)
{
   const Material material{3.0, 0.3};
   for (const char *kind : {"quads", "triangles"})
   {
      // Far from the axis, where 1/r is a polynomial to round-off for either rule.
      mfem::Mesh mesh = block(kind);
      for (int v = 0; v < mesh.GetNV(); ++v) { mesh.GetVertex(v)[0] += 100; }
      for (Formulation formulation :
           {Formulation::plane, Formulation::axisymmetric, Formulation::torsion})
      {
         const ElasticBody body(mesh, 2, material, formulation);
         mfem::ConstantCoefficient young(3.0);
         const ElasticBody fields(mesh, 2, young, 0.3, formulation);
         EXPECT_LT(difference(dense(fields.stiffness()), dense(body.stiffness())), 1e-12)
            << kind << ", " << component_name(formulation, 0);
      }
   }
   mfem::Mesh mesh = block("quads");
   const ElasticBody stress(mesh, 2, Material{3.0, 0.3, PlaneState::stress});
   const ElasticBody fields(mesh, 2, 3.0, 0.3, Formulation::plane, PlaneState::stress);
   EXPECT_LT(difference(dense(fields.stiffness()), dense(stress.stiffness())), 1e-13);
}

TEST(MfemDoors, VaryingStiffnessIsThatOfMfem)
{
   // Linear in the place: all rules are exact on straight elements.
   const auto young = [](double x, double y) { return 1 + x + 2 * y; };
   for (const char *kind : {"quads", "triangles"})
   {
      mfem::Mesh mesh = block(kind);
      const ElasticBody body(mesh, 2, young, 0.25);
      mfem::FunctionCoefficient lambda([](const mfem::Vector &x)
                                       { return 0.4 * (1 + x(0) + 2 * x(1)); });
      mfem::FunctionCoefficient mu([](const mfem::Vector &x)
                                   { return 0.4 * (1 + x(0) + 2 * x(1)); });
      mfem::BilinearForm form(&body.space());
      auto *integrator = new mfem::ElasticityIntegrator(lambda, mu);
      integrator->SetIntRule(&mfem::IntRules.Get(mesh.GetElementGeometry(0), 8));
      form.AddDomainIntegrator(integrator);
      form.Assemble();
      form.Finalize();
      EXPECT_LT(difference(dense(body.stiffness()), dense(form.SpMat())), 1e-13) << kind;
   }
   // Piecewise: a material for each attribute.
   mfem::Mesh mesh = block("quads");
   for (int e = 0; e < mesh.GetNE(); e += 2) { mesh.SetAttribute(e, 2); }
   mesh.SetAttributes();
   mfem::Vector values({1.0, 5.0});
   mfem::PWConstCoefficient piecewise(values);
   const ElasticBody fields(mesh, 2, piecewise, 0.3);
   const ElasticBody body(mesh, 2, std::vector<Material>{{1.0, 0.3}, {5.0, 0.3}});
   EXPECT_LT(difference(dense(fields.stiffness()), dense(body.stiffness())), 1e-13);
}

TEST(MfemDoors, BarOfVaryingStiffnessStretchesAsItsCompliancesAdd)
{
   // E = 1/(1 + x), ν = 0, a pull of 1 at x = 2: σ = 1, u = x + x²/2.
   mfem::Mesh mesh = block("quads");
   ElasticBody body(
      mesh, 2, [](double x, double) { return 1 / (1 + x); }, 0.0);
   body.fix(4, 0);
   body.fix_node(0, 0, 1);
   body.add_traction("pull", 2, 1.0, 0.0);
   // The top, without its ends, is the contact, and is left alone.
   const CondensedBody condensed =
      condense(body, contact_line(body, BoundaryPart({3}, 0, 0.4, 1.6)));
   const VectorXd u = without_contact(condensed);
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      const double x = body.node_coordinates()(0, node);
      EXPECT_NEAR(u[body.true_dof(node, 0)], x + x * x / 2, 1e-12);
      EXPECT_NEAR(u[body.true_dof(node, 1)], 0, 1e-12);
   }
   EXPECT_LT(stress_error(body, u, {},
                          [](double, double) {
                             return std::array<double, 4>{1, 0, 0, 0};
                          }),
             1e-11);
}

TEST(MfemDoors, MaterialsOfAPointAreChecked)
{
   mfem::Mesh mesh = block("quads");
   expect_input_error(
      [&]
      {
         ElasticBody(
            mesh, 1, [](double x, double) { return 1 - x; }, 0.3);
      },
      "Young's modulus is -");
   expect_input_error([&] { ElasticBody(mesh, 1, 1.0, 0.5); }, "Poisson's ratio is 0.5");
   expect_input_error([&] { ElasticBody(mesh, 1, nan_value, 0.3); }, "must be finite");
   expect_input_error(
      [&] { ElasticBody(mesh, 1, 1.0, 0.3, Formulation::axisymmetric, PlaneState::stress); },
      "plane stress");
   const ElasticBody body(mesh, 1, 1.0, 0.3);
   expect_input_error([&] { body.material(1); }, "its material varies");
}

TEST(MfemDoors, AMaterialThatIsNoneSaysWhere)
{
   mfem::Mesh mesh = rectangle_mesh({2, 3}, {4, 5});
   mfem::FunctionCoefficient young([](const mfem::Vector &x) { return x(1) - x(0); });
   mfem::ConstantCoefficient poisson(0.7);
   expect_input_error([&] { ElasticBody(mesh, 1, young, poisson); }, "found at (2.");
   expect_input_error([&] { ElasticBody(mesh, 1, young, poisson); }, ", 4.");
}

TEST(MfemDoors, LoadsOfCoefficientsAreThoseOfFunctions)
{
   mfem::Mesh mesh = block("triangles");
   ElasticBody body(mesh, 2, Material{});
   const auto f = [](double x, double y) { return 1 + x * x - 3 * y; };
   mfem::FunctionCoefficient c([&](const mfem::Vector &x) { return f(x(0), x(1)); });
   // A grid function, which a boundary element finds by its own numbering.
   mfem::H1_FECollection collection(2, 2);
   mfem::FiniteElementSpace scalar(&mesh, &collection);
   mfem::GridFunction field(&scalar);
   field.ProjectCoefficient(c);
   mfem::GridFunctionCoefficient g(&field);
   for (int of : {0, 1, 2})
   {
      const std::string name = std::to_string(of);
      const Field value = of == 0 ? Field(f) : of == 1 ? Field(c) : Field(g);
      body.add_pressure("pressure " + name, BoundaryPart({3}, 0, 0.3, 1.7), value);
      body.add_traction("traction " + name, 2, value, 2.0);
      body.add_body_force("force " + name, 0.0, value);
   }
   for (int k = 3; k < 9; ++k)
   {
      EXPECT_LT(difference(body.patterns()[k].values, body.patterns()[k % 3].values), 1e-13);
   }
   mfem::ConstantCoefficient bad(nan_value);
   expect_input_error([&] { body.add_pressure("P", 3, bad); }, "must be finite");
}

TEST(MfemDoors, FreeExpansionIsWithoutStressInThePlane)
{
   // A linear temperature strains a body without stress in the plane; in plane strain the
   // thickness cannot follow, σzz = -E α T. A constant one needs no straight elements.
   const double E = 2.0, nu = 0.3;
   for (const char *kind : {"quads", "triangles", "nonconforming", "curved"})
   {
      const bool curved = std::string(kind) == "curved";
      mfem::Mesh mesh = block(kind);
      const double slope = curved ? 0 : 1;
      const auto strain = [slope](double x, double y)
      { return 1e-3 * (1 + slope * (2 * x - y)); };
      for (PlaneState state : {PlaneState::strain, PlaneState::stress})
      {
         ElasticBody body(mesh, curved ? 3 : 2, Material{E, nu, state});
         hold_loosely(body);
         body.add_initial_strain("T", strain);
         const VectorXd u =
            without_contact(condense(body, contact_line(body, BoundaryPart({3}, 0, 0.4, 1.6))));
         EXPECT_GT(u.cwiseAbs().maxCoeff(), 1e-3);
         const double half = 0.5; // λ = 0.5: half the displacement, half the strain
         EXPECT_LT(
            stress_error(
               body, half * u, {{"T", half}},
               [&](double x, double y)
               {
                  const bool thick = state == PlaneState::strain;
                  return std::array<double, 4>{0, 0, thick ? -E * half * strain(x, y) : 0, 0};
               }),
            1e-13)
            << kind;
      }
   }
}

TEST(MfemDoors, ExpansionInOneDirectionIsATensor)
{
   // ε₀ = diag(2, -1, 0)·10⁻³ and a shear: compatible, so that u follows it, without stress.
   mfem::Mesh mesh = block("triangles");
   ElasticBody body(mesh, 1, Material{2.0, 0.3});
   hold_loosely(body);
   mfem::DenseMatrix e(3);
   e = 0.0;
   e(0, 0) = 2e-3;
   e(1, 1) = -1e-3;
   e(0, 1) = e(1, 0) = 0.5e-3;
   mfem::MatrixConstantCoefficient strain(e);
   body.add_initial_strain("grown", strain);
   const VectorXd u =
      without_contact(condense(body, contact_line(body, BoundaryPart({3}, 0, 0.4, 1.6))));
   const auto none = [](double, double) { return std::array<double, 4>{}; };
   EXPECT_LT(stress_error(body, u, {{"grown", 1}}, none), 1e-15);
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      const double x = body.node_coordinates()(0, node), y = body.node_coordinates()(1, node);
      // (2, 0) stays at the height of (0, 0): all of the shear is in u_x.
      EXPECT_NEAR(u[body.true_dof(node, 0)], 2e-3 * x + 1e-3 * y, 1e-15);
      EXPECT_NEAR(u[body.true_dof(node, 1)], -1e-3 * y, 1e-15);
   }
   // What an isotropic strain is as a tensor.
   mfem::IdentityMatrixCoefficient identity(3);
   body.add_initial_strain("tensor", identity);
   body.add_initial_strain("isotropic", 1.0);
   EXPECT_LT(difference(body.patterns()[1].values, body.patterns()[2].values), 1e-15);
}

TEST(MfemDoors, HeatedCylinderHasTheStressesOfTheTextbook)
{
   // Plane strain, strain α T = k (1 - r²/R²), R = 2, free at r = R (Timoshenko & Goodier,
   // article 151): with m(r) = (1/r²) ∫ α T r dr from 0 to r,
   //    σr = E/(1-ν) (m(R) - m(r)),  σθ = E/(1-ν) (m(R) + m(r) - αT),  σz = ν (σr + σθ) - E αT.
   const double E = 2.0, nu = 0.3, k = 1e-3, R = 2;
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 3, Material{E, nu}, Formulation::axisymmetric);
   body.fix(std::vector<int>{1, 3}, 1);
   const auto strain = [=](double r, double) { return k * (1 - r * r / (R * R)); };
   body.add_initial_strain("T", strain);
   const VectorXd u =
      without_contact(condense(body, contact_line(body, BoundaryPart({2}, 1, 0.3, 0.7))));
   const auto m = [=](double r) { return k * (0.5 - r * r / (4 * R * R)); };
   EXPECT_LT(stress_error(
                body, u, {{"T", 1}},
                [&](double r, double z)
                {
                   const double sr = E / (1 - nu) * (m(R) - m(r)),
                                st = E / (1 - nu) * (m(R) + m(r) - strain(r, z));
                   return std::array<double, 4>{sr, nu * (sr + st) - E * strain(r, z), st, 0};
                }),
             1e-12);
}

TEST(MfemDoors, InitialStrainsThatNothingCouldMeanAreRefused)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   mfem::IdentityMatrixCoefficient two(2);
   expect_input_error([&] { body.add_initial_strain("T", two); }, "is 2×2, must be 3×3");
   mfem::DenseMatrix e(3);
   e = 0.0;
   e(0, 1) = 1;
   mfem::MatrixConstantCoefficient skew(e);
   expect_input_error([&] { body.add_initial_strain("T", skew); }, "must be finite, symmetric");
   expect_input_error([&] { body.add_initial_strain("T", nan_value); }, "must be finite");
   ElasticBody twisting(mesh, 1, Material{}, Formulation::torsion);
   expect_input_error([&] { twisting.add_initial_strain("T", 1.0); }, "the body is of torsion");
   ElasticBody own(body.space(), body.stiffness());
   expect_input_error([&] { own.add_initial_strain("T", 1.0); },
                      "stiffness that was given as a matrix");

   // Stresses need to know how hot it is.
   ElasticBody hot(mesh, 1, Material{});
   hot.add_initial_strain("T", 1.0);
   mfem::GridFunction u(&hot.space());
   u = 0.0;
   mfem::ElementTransformation &at = *mesh.GetElementTransformation(0);
   at.SetIntPoint(&mfem::Geometries.GetCenter(mfem::Geometry::SQUARE));
   expect_input_error([&] { stress_at(hot, u, at); }, "multiplier of the initial strain 'T'");
   EXPECT_NEAR(stress_at(hot, u, at, {{"T", -2}}).xx, 2 / (1 - 2 * 0.3), 1e-14);
   BodyFields fields(hot, testing::TempDir() + "hot", "body");
   expect_input_error([&] { fields.write(VectorXd::Zero(hot.space().GetTrueVSize()), 0); },
                      "multiplier of the initial strain 'T'");
   fields.write(VectorXd::Zero(hot.space().GetTrueVSize()), 0, {{"T", -2}});
   EXPECT_NEAR(fields.field("sigma_yy").Max(), 2 / (1 - 2 * 0.3), 1e-14);
}

TEST(MfemDoors, DisplacementsOfAGridFunctionAreThoseOfItsComponents)
{
   for (const char *kind : {"triangles", "nonconforming"})
   {
      mfem::Mesh mesh = block(kind);
      ElasticBody body(mesh, 2, Material{});
      body.add_displacement("u", 3, 0, [](double x, double y) { return x * y; });
      body.add_displacement("u", 3, 1, [](double x, double) { return 2 - x * x; });
      mfem::VectorFunctionCoefficient function(2,
                                               [](const mfem::Vector &x, mfem::Vector &u)
                                               {
                                                  u(0) = x(0) * x(1);
                                                  u(1) = 2 - x(0) * x(0);
                                               });
      mfem::GridFunction u(&body.space());
      u.ProjectCoefficient(function);
      body.add_displacement("grid function", 3, u);
      EXPECT_LT(difference(body.patterns()[1].values, body.patterns()[0].values), 1e-14)
         << kind;
      EXPECT_EQ(body.patterns()[1].control, Control::displacement);

      mfem::H1_FECollection collection(2, 2);
      mfem::FiniteElementSpace other(&mesh, &collection, 2);
      mfem::GridFunction elsewhere(&other);
      elsewhere = 0.0;
      expect_input_error([&] { body.add_displacement("P", 3, elsewhere); },
                         "displacement 'P': the grid function is on a space of " +
                            std::to_string(other.GetVSize()) +
                            " dofs, must be on the space of the body");
      u = nan_value;
      expect_input_error([&] { body.add_displacement("P", 3, u); }, "must be finite");
   }
}

TEST(MfemDoors, StressesOfAUsersOperatorAreAskedOfTheUser)
{
   mfem::Mesh mesh = block("quads");
   const ElasticBody body(mesh, 2, Material{2.0, 0.3});
   ElasticBody own(body.space(), body.stiffness());
   EXPECT_FALSE(own.has_stress());
   own.set_stress(
      [&](const mfem::GridFunction &u, mfem::ElementTransformation &at, const NamedLoads &loads)
      {
         Stress s = stress_at(body, u, at);
         s.xy += loads.at("Q");
         return s;
      });
   ASSERT_TRUE(own.has_stress());
   const VectorXd u = VectorXd::Random(body.space().GetTrueVSize());
   const std::string folder = testing::TempDir() + "stress";
   BodyFields expected(body, folder, "body"), fields(own, folder, "own");
   expected.write(u, 0);
   fields.write(u, 0, {{"Q", 7}});
   const mfem::GridFunction &sigma = expected.field("sigma_xx"),
                            &tau = expected.field("tau_xy");
   for (int k = 0; k < sigma.Size(); ++k)
   {
      EXPECT_EQ(fields.field("sigma_xx")(k), sigma(k));
      EXPECT_NEAR(fields.field("tau_xy")(k), tau(k) + 7, 1e-13);
   }
   ElasticBody twisting(mesh, 1, Material{}, Formulation::torsion);
   expect_input_error([&] { twisting.set_stress({}); }, "one of torsion");
}

} // namespace
