#include <cattaneo/elastic/rotation.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

Rotation largest_rotation(const ElasticBody &body, const Eigen::VectorXd &displacement)
{
   mfem::FiniteElementSpace &space = body.space();
   mfem::GridFunction field(&space);
   field.SetFromTrueDofs(to_mfem(displacement));
   Rotation most;
   mfem::DenseMatrix gradient;
   mfem::Vector x(body.components());
   const bool in_space = body.formulation() == Formulation::space;
   for (int e = 0; e < space.GetNE(); ++e)
   {
      mfem::ElementTransformation &at = *space.GetElementTransformation(e);
      at.SetIntPoint(&mfem::Geometries.GetCenter(at.GetGeometryType()));
      field.GetVectorGradient(at, gradient);
      double angle = 0.5 * (gradient(1, 0) - gradient(0, 1));
      if (in_space)
      {
         angle = std::hypot(angle, 0.5 * (gradient(2, 1) - gradient(1, 2)),
                            0.5 * (gradient(0, 2) - gradient(2, 0)));
      }
      if (std::abs(angle) <= std::abs(most.angle)) { continue; }
      at.Transform(at.GetIntPoint(), x);
      most = {angle, {x[0], x[1], in_space ? x[2] : 0}};
   }
   const std::vector<double> all =
      body.ranks().gather({most.angle, most.place[0], most.place[1], most.place[2]});
   for (std::size_t k = 0; k < all.size(); k += 4)
   {
      if (std::abs(all[k]) > std::abs(most.angle))
      {
         most = {all[k], {all[k + 1], all[k + 2], all[k + 3]}};
      }
   }
   return most;
}

} // namespace cattaneo
