#include <cattaneo/elastic/mass.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cmath>

namespace cattaneo
{

SharedMatrix mass_matrix(const ElasticBody &body, const std::vector<double> &density)
{
   require(body.formulation() != Formulation::torsion,
           "mass: the body is one of torsion, must be plane or axisymmetric");
   require(!body.ranks().distributed(), "mass: the body is on several ranks, must be on one");
   mfem::FiniteElementSpace &space = body.space();
   const int attributes =
      space.GetMesh()->attributes.Size() > 0 ? space.GetMesh()->attributes.Max() : 1;
   require(density.size() == 1 || density.size() == static_cast<std::size_t>(attributes),
           "mass: there are ", density.size(),
           " densities, must be one, or one for each element attribute of the mesh, 1 to ",
           attributes);
   for (const double rho : density)
   {
      require(rho > 0 && std::isfinite(rho), "mass: a density is ", rho,
              ", must be positive and finite");
   }
   mfem::Vector values(attributes);
   for (int a = 0; a < attributes; ++a) { values[a] = density[density.size() == 1 ? 0 : a]; }
   mfem::PWConstCoefficient each(values);
   mfem::FunctionCoefficient circumference([](const mfem::Vector &x)
                                           { return 2 * std::acos(-1.0) * x(0); });
   mfem::ProductCoefficient around(each, circumference);
   const bool axis = body.formulation() == Formulation::axisymmetric;
   mfem::Coefficient &rho = axis ? static_cast<mfem::Coefficient &>(around) : each;
   mfem::BilinearForm form(&space);
   // The circumference is of the degree of the geometry.
   form.AddDomainIntegrator(new mfem::VectorMassIntegrator(rho, axis ? 2 : 0));
   form.Assemble();
   form.Finalize();
   // Of a mesh with hanging nodes the true dofs are fewer.
   mfem::SparseMatrix made;
   mfem::Array<int> none;
   form.FormSystemMatrix(none, made);
   // Eigen expects the columns of a row in their order.
   made.SortColumnIndices();
   Eigen::SparseMatrix<double, Eigen::RowMajor> copy(view(made));
   return SharedMatrix(std::move(copy));
}

} // namespace cattaneo
