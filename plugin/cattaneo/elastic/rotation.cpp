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
   require(body.formulation() != Formulation::space,
           "largest rotation: the body is in space, must be in a plane");
   Rotation most;
   mfem::DenseMatrix gradient;
   mfem::Vector x(2);
   for (int e = 0; e < space.GetNE(); ++e)
   {
      mfem::ElementTransformation &at = *space.GetElementTransformation(e);
      at.SetIntPoint(&mfem::Geometries.GetCenter(at.GetGeometryType()));
      field.GetVectorGradient(at, gradient);
      const double angle = 0.5 * (gradient(1, 0) - gradient(0, 1));
      if (std::abs(angle) <= std::abs(most.angle)) { continue; }
      at.Transform(at.GetIntPoint(), x);
      most = {angle, {x[0], x[1]}};
   }
   const std::vector<double> all =
      body.ranks().gather({most.angle, most.place[0], most.place[1]});
   for (std::size_t k = 0; k < all.size(); k += 3)
   {
      if (std::abs(all[k]) > std::abs(most.angle))
      {
         most = {all[k], {all[k + 1], all[k + 2]}};
      }
   }
   return most;
}

} // namespace cattaneo
