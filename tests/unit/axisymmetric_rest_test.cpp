#include "axisymmetric_integrator.hpp"
#include "cylinders.hpp"
#include "elastic_support.hpp"

// Bodies of revolution: their axis, operators of the user's own, numbering and meshes.

namespace
{

using namespace cattaneo;
using namespace support;
using cattaneo_test::cylinder;

TEST(Axisymmetric, TheAxisIsHeldAndTheOtherSideRefused)
{
   mfem::Mesh mesh = cylinder("quads");
   for (int order : {1, 3})
   {
      ElasticBody body(mesh, order, Material{}, Formulation::axisymmetric);
      EXPECT_EQ(body.essential_dofs().Size(), 3 * order + 1);
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         if (body.node_coordinates()(0, node) == 0)
         {
            EXPECT_GE(body.essential_dofs().Find(body.true_dof(node, 0)), 0);
         }
      }
      body.add_displacement("squeeze", 1, 0, [](double r, double) { return -r; });
      expect_input_error([&] { body.add_displacement("bad", 1, 0, 1.0); },
                         "must be zero on the axis");
      expect_input_error([&] { body.fix(1, 2); }, "must be 0 (r) or 1 (z)");
      expect_input_error([&] { body.add_traction("t", 3, 1.0); }, "must be two");
      for (Guide::Motion motion : {Guide::Motion::force, Guide::Motion::displacement})
      {
         const Guide::Along moves{motion, "moves"};
         Guide sideways{moves, {}}, turning{{}, {}, moves}, along_the_axis{{}, moves};
         for (const Guide *bad : {&sideways, &turning})
         {
            expect_input_error([&] { body.guide(3, *bad); }, "must not be given");
         }
         ElasticBody other(mesh, order, Material{}, Formulation::axisymmetric);
         EXPECT_NO_THROW(other.guide(3, along_the_axis));
      }
      ElasticBody torsion(mesh, order, Material{}, Formulation::torsion);
      expect_input_error([&] { torsion.fix(1, 1); }, "must be 0 (twist)");
      expect_input_error([&] { torsion.add_pressure("p", 3, 1.0); }, "must be 0 (twist)");
      // On the axis (attribute 4) nothing moves around it, whatever its angle.
      torsion.fix(4, 0);
      torsion.fix_node(0, 0.5, 0);
      EXPECT_EQ(torsion.essential_dofs().Size(), 0);
      expect_input_error([&] { torsion.add_displacement("w", 4, 0, 1.0); }, "lies on the axis");
      torsion.fix(1, 0);
      EXPECT_GT(torsion.essential_dofs().Size(), 0);
   }
   EXPECT_EQ(ElasticBody(mesh, 1, Material{}).essential_dofs().Size(), 0);
   mfem::Mesh across = cylinder("quads", -0.25);
   for (auto formulation : {Formulation::axisymmetric, Formulation::torsion})
   {
      expect_input_error([&] { ElasticBody(across, 1, Material{}, formulation); },
                         "is at r = -0.25");
      expect_input_error(
         [&] {
            ElasticBody(mesh, 1, Material{1, 0.3, PlaneState::stress}, formulation);
         },
         "plane stress");
   }
}

TEST(Axisymmetric, TakesAnOperatorOfTheUsersOwn)
{
   const Material material{2.6, 0.3};
   mfem::Mesh mesh = cylinder("triangles");
   for (auto formulation : {Formulation::axisymmetric, Formulation::torsion})
   {
      ElasticBody body(mesh, 2, material, formulation);
      mfem::H1_FECollection collection(2, 2);
      mfem::FiniteElementSpace space(&mesh, &collection, body.components(),
                                     mfem::Ordering::byNODES);
      mfem::ConstantCoefficient lambda(material.lambda()), mu(material.mu());
      mfem::FunctionCoefficient moment(polar_moment);
      mfem::ProductCoefficient torsion(mu, moment);
      mfem::BilinearForm form(&space);
      mfem::BilinearFormIntegrator *integrator = nullptr;
      if (formulation == Formulation::torsion)
      {
         integrator = torsion_integrator(space, torsion);
      }
      else { integrator = new AxisymmetricElasticityIntegrator(lambda, mu); }
      form.AddDomainIntegrator(integrator);
      form.Assemble();
      form.Finalize();
      ElasticBody own(space, form.SpMat(), formulation);
      EXPECT_EQ(own.essential_dofs().Size(), body.essential_dofs().Size());
      for (ElasticBody *one : {&body, &own})
      {
         one->fix(3, one->components() - 1);
         if (formulation == Formulation::torsion) { one->add_traction("t", 2, 1.0); }
         else { one->add_pressure("t", 2, 1.0); }
      }
      const CondensedBody a = condense(body, contact_line(body, 1)),
                          b = condense(own, contact_line(own, 1));
      EXPECT_LT(difference(a.S, b.S), 1e-12);
      EXPECT_LT(difference(a.patterns[0].q, b.patterns[0].q), 1e-11);
   }
   mfem::H1_FECollection collection(2, 2);
   mfem::FiniteElementSpace two(&mesh, &collection, 2);
   expect_input_error([&] { ElasticBody(two, mfem::SparseMatrix(), Formulation::torsion); },
                      "must have 1");
}

TEST(Axisymmetric, NumberingOfTheMeshDoesNotMatter)
{
   for (auto formulation : {Formulation::axisymmetric, Formulation::torsion})
   {
      mfem::Mesh mesh = cylinder("quads"), other = cylinder("quads");
      mfem::Array<int> order(other.GetNE());
      for (int e = 0; e < order.Size(); ++e) { order[e] = (5 * e + 3) % order.Size(); }
      other.ReorderElements(order);
      const auto condensed = [&](mfem::Mesh &one)
      {
         ElasticBody body(one, 3, Material{}, formulation);
         body.fix(3, body.components() - 1);
         return condense(body, contact_line(body, 1));
      };
      const CondensedBody a = condensed(mesh), b = condensed(other);
      EXPECT_EQ(a.line.each(&LineNode::position), b.line.each(&LineNode::position));
      EXPECT_LT(difference(a.S, b.S), 1e-12);
   }
}

/// A body that is moved along its axis is an equal one; only its factor is shared.
TEST(Axisymmetric, EqualBodiesShareOneFactor)
{
   mfem::Mesh here = rectangle_mesh(uniform(0, 2, 4), uniform(0, 1, 4)),
              there = rectangle_mesh(uniform(0, 2, 4), uniform(8, 9, 4));
   for (auto formulation : {Formulation::axisymmetric, Formulation::torsion})
   {
      ElasticBody a(here, 2, Material{}, formulation), b(there, 2, Material{}, formulation);
      for (ElasticBody *body : {&a, &b}) { body->fix(3, body->components() - 1); }
      const CondensedBody first = condense(a, contact_line(a, 1));
      EXPECT_EQ(first.counters.factorisations, 1);
      const CondensedBody second = condense(b, contact_line(b, 1), {}, &first);
      EXPECT_EQ(second.counters.factorisations, 0);
      EXPECT_EQ(first.S, second.S);
   }
}

/// Half-space meshes are the right half of half-plane ones.
TEST(Axisymmetric, HalfSpaceMesh)
{
   mfem::Mesh mesh = half_space_mesh(uniform(0, 1, 3), uniform(0, 1, 2), {1, 2, 5});
   EXPECT_EQ(mesh.GetNE(), 3 * 2 + 2 * 5);
   double area = 0;
   for (int e = 0; e < mesh.GetNE(); ++e) { area += mesh.GetElementVolume(e); }
   EXPECT_NEAR(area, 25, 1e-12);
   double length[6] = {};
   for (int i = 0; i < mesh.GetNBE(); ++i)
   {
      mfem::ElementTransformation &edge = *mesh.GetBdrElementTransformation(i);
      mfem::IntegrationPoint middle;
      middle.Set1w(0.5, 1.0);
      edge.SetIntPoint(&middle);
      length[mesh.GetBdrAttribute(i)] += edge.Weight();
      mfem::Vector x;
      edge.Transform(middle, x);
      const int attribute = mesh.GetBdrAttribute(i);
      EXPECT_TRUE(attribute == 5   ? x(0) == 0
                  : attribute == 3 ? x(1) == -5
                  : attribute == 4 ? x(0) == 5
                                   : x(1) == 0);
   }
   for (int attribute = 1; attribute <= 5; ++attribute)
   {
      EXPECT_NEAR(length[attribute], attribute == 1 ? 1 : attribute == 2 ? 4 : 5, 1e-12);
   }
   expect_input_error(
      [] {
         half_space_mesh(uniform(-1, 1, 3), uniform(0, 1, 2), {1, 2});
      },
      "must start on the axis");
}

} // namespace
