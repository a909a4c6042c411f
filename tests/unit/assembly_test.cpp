#include "axisymmetric_integrator.hpp"
#include "elastic_support.hpp"
#include <cattaneo/elastic/assembly.hpp>

using namespace cattaneo;
using namespace support;

namespace
{

/// What MFEM makes of the same integrators, element by element.
MatrixXd by_bilinear_form(mfem::FiniteElementSpace &space,
                          const std::vector<Material> &materials, Formulation formulation)
{
   mfem::Vector lambda(static_cast<int>(materials.size())), mu(lambda.Size());
   for (int k = 0; k < lambda.Size(); ++k)
   {
      lambda(k) = materials[k].lambda();
      mu(k) = materials[k].mu();
   }
   mfem::PWConstCoefficient lambda_field(lambda), mu_field(mu);
   mfem::FunctionCoefficient moment(polar_moment);
   mfem::ProductCoefficient torsion(mu_field, moment);
   mfem::BilinearForm form(&space);
   switch (formulation)
   {
   case Formulation::plane:
      form.AddDomainIntegrator(new mfem::ElasticityIntegrator(lambda_field, mu_field));
      break;
   case Formulation::axisymmetric:
      form.AddDomainIntegrator(new AxisymmetricElasticityIntegrator(lambda_field, mu_field));
      break;
   case Formulation::torsion:
      form.AddDomainIntegrator(torsion_integrator(space, torsion));
      break;
   case Formulation::space:
      ADD_FAILURE() << "bodies of MFEM are of the plane or about an axis";
      break;
   }
   form.Assemble();
   form.Finalize();
   return dense(form.SpMat());
}

/// Two materials; quads that are rectangles, parallelograms and neither, triangles, curved
/// sides.
std::vector<mfem::Mesh> meshes()
{
   std::vector<mfem::Mesh> list;
   for (auto type : {mfem::Element::QUADRILATERAL, mfem::Element::TRIANGLE})
   {
      for (const char *shape : {"rectangles", "parallelograms", "skew", "curved"})
      {
         mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(4, 3, type, true, 2.0, 1.5);
         const std::string kind = shape;
         if (kind == "curved") { mesh.SetCurvature(2); }
         for (int e = 0; e < mesh.GetNE(); e += 3) { mesh.SetAttribute(e, 2); }
         mesh.SetAttributes();
         // A coefficient: both versions of MFEM know it.
         mfem::VectorFunctionCoefficient deformed(2,
                                                  [kind](const mfem::Vector &x, mfem::Vector &y)
                                                  {
                                                     y = x;
                                                     y(0) += 0.5;
                                                     if (kind == "parallelograms")
                                                     {
                                                        y(0) += 0.3 * x(1);
                                                     }
                                                     if (kind == "parallelograms")
                                                     {
                                                        y(1) += 0.2 * x(0);
                                                     }
                                                     if (kind == "skew" || kind == "curved")
                                                     {
                                                        y(0) += 0.1 * x(0) * x(1) * x(1);
                                                     }
                                                     if (kind == "curved")
                                                     {
                                                        y(1) += 0.1 * std::sin(2 * x(0));
                                                     }
                                                  });
         mesh.Transform(deformed);
         list.push_back(std::move(mesh));
      }
   }
   return list;
}

} // namespace

TEST(Assembly, IsThatOfTheIntegratorsOnElementsOfAnyShape)
{
   const std::vector<Material> materials{{2.0, 0.3}, {0.7, 0.45}};
   for (mfem::Mesh &mesh : meshes())
   {
      for (auto formulation :
           {Formulation::plane, Formulation::axisymmetric, Formulation::torsion})
      {
         for (int order = 1; order <= 4; ++order)
         {
            mfem::H1_FECollection collection(order, 2);
            mfem::FiniteElementSpace space(&mesh, &collection, components(formulation),
                                           mfem::Ordering::byVDIM);
            const std::unique_ptr<mfem::SparseMatrix> K =
               assemble_stiffness(space, materials, formulation);
            const MatrixXd D = dense(*K);
            EXPECT_LT(difference(D, by_bilinear_form(space, materials, formulation)), 1e-13);
            EXPECT_EQ(D, D.transpose());
         }
      }
   }
}

/// Nodes that are off by a little are off: displacements linear in x and y leave the inside of
/// any mesh without forces.
TEST(Assembly, ElementsThatAreNearlyParallelogramsAreNoneOfThem)
{
   const std::vector<Material> materials{{1.0, 0.3}};
   for (const double off : {1e-3, 1e-6, 1e-9})
   {
      mfem::Mesh mesh = rectangle_mesh({0, 1, 2}, {0, 1, 2});
      mesh.GetVertex(4)[0] += off;
      mesh.GetVertex(4)[1] -= 0.5 * off;
      for (int order : {1, 2})
      {
         mfem::H1_FECollection collection(order, 2);
         mfem::FiniteElementSpace space(&mesh, &collection, 2, mfem::Ordering::byVDIM);
         const auto K = assemble_stiffness(space, materials, Formulation::plane);
         mfem::VectorFunctionCoefficient linear(2,
                                                [](const mfem::Vector &x, mfem::Vector &u)
                                                {
                                                   u(0) = 2 * x(0) - x(1);
                                                   u(1) = 3 * x(0) + 0.5 * x(1);
                                                });
         mfem::GridFunction u(&space);
         u.ProjectCoefficient(linear);
         mfem::Vector forces(K->Height());
         K->Mult(u, forces);
         mfem::Array<int> outside, around(4);
         around = 1;
         space.GetEssentialVDofs(around, outside);
         double largest = 0;
         for (int k = 0; k < forces.Size(); ++k)
         {
            if (!outside[k]) { largest = std::max(largest, std::abs(forces(k))); }
         }
         EXPECT_LT(largest, 1e-13) << off << ' ' << order;
      }
   }
}

/// Elements of one shape share integrals; far from the origin their corners carry round-off.
TEST(Assembly, DoesNotDependOnWhereTheBodyIs)
{
   const std::vector<Material> materials{{1.0, 0.3}};
   for (double far : {0.0, 1e3, 1e6})
   {
      mfem::Mesh mesh = rectangle_mesh(uniform(far, far + 1, 4), uniform(-far, 1 - far, 4));
      mfem::H1_FECollection collection(2, 2);
      mfem::FiniteElementSpace space(&mesh, &collection, 2, mfem::Ordering::byVDIM);
      const std::unique_ptr<mfem::SparseMatrix> K =
         assemble_stiffness(space, materials, Formulation::plane);
      EXPECT_LT(difference(dense(*K), by_bilinear_form(space, materials, Formulation::plane)),
                1e-13 + 1e-15 * far);
   }
}
