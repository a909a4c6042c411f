#include <cattaneo/elastic/axisymmetric.hpp>
#include <cattaneo/formulation.hpp>

namespace cattaneo
{

const mfem::IntegrationRule &
rule_of_revolution(const mfem::FiniteElement &element,
                   const mfem::ElementTransformation &transformation, Formulation formulation)
{
   const int power = formulation == Formulation::torsion ? 3 : 1;
   return mfem::IntRules.Get(element.GetGeomType(),
                             2 * element.GetOrder() + (power + 1) * transformation.Order());
}

void AxisymmetricElasticityIntegrator::AssembleElementMatrix(
   const mfem::FiniteElement &element, mfem::ElementTransformation &transformation,
   mfem::DenseMatrix &matrix)
{
   const int n = element.GetDof();
   shape_.SetSize(n);
   gradient_.SetSize(n, 2);
   position_.SetSize(2);
   matrix.SetSize(2 * n);
   matrix = 0.0;
   const mfem::IntegrationRule &points =
      rule_of_revolution(element, transformation, Formulation::axisymmetric);
   for (int k = 0; k < points.GetNPoints(); ++k)
   {
      const mfem::IntegrationPoint &point = points.IntPoint(k);
      transformation.SetIntPoint(&point);
      transformation.Transform(point, position_);
      element.CalcPhysShape(transformation, shape_);
      element.CalcPhysDShape(transformation, gradient_);
      const double r = position_(0);
      const double weight =
         point.weight * transformation.Weight() * measure(Formulation::axisymmetric, r);
      const double lambda = weight * lambda_.Eval(transformation, point);
      const double mu = weight * mu_.Eval(transformation, point);
      for (int j = 0; j < n; ++j)
      {
         const double dr = gradient_(j, 0), dz = gradient_(j, 1), hoop = shape_(j) / r;
         // Stresses of a unit u_r, and of a unit u_z, of node j.
         const double spherical_r = lambda * (dr + hoop), spherical_z = lambda * dz;
         for (int i = 0; i < n; ++i)
         {
            const double er = gradient_(i, 0), ez = gradient_(i, 1), eh = shape_(i) / r;
            matrix(i, j) +=
               (er + eh) * spherical_r + mu * (2 * er * dr + 2 * eh * hoop + ez * dz);
            matrix(n + i, j) += ez * spherical_r + mu * er * dz;
            matrix(i, n + j) += (er + eh) * spherical_z + mu * ez * dr;
            matrix(n + i, n + j) += ez * spherical_z + mu * (2 * ez * dz + er * dr);
         }
      }
   }
   matrix.Symmetrize(); // to the last bit
}

double TorsionIntegrator::Weighted::Eval(mfem::ElementTransformation &transformation,
                                         const mfem::IntegrationPoint &point)
{
   transformation.Transform(point, position);
   const double r = position(0), arm = lever(Formulation::torsion, r);
   return G.Eval(transformation, point) * arm * arm * measure(Formulation::torsion, r);
}

TorsionIntegrator::TorsionIntegrator(mfem::Coefficient &shear_modulus)
   : TorsionIntegrator(std::make_unique<Weighted>(shear_modulus))
{
}

TorsionIntegrator::TorsionIntegrator(std::unique_ptr<Weighted> weighted)
   : mfem::DiffusionIntegrator(*weighted), weighted_(std::move(weighted))
{
   weighted_->position.SetSize(2);
}

void TorsionIntegrator::AssembleElementMatrix(const mfem::FiniteElement &element,
                                              mfem::ElementTransformation &transformation,
                                              mfem::DenseMatrix &matrix)
{
   SetIntRule(&rule_of_revolution(element, transformation, Formulation::torsion));
   mfem::DiffusionIntegrator::AssembleElementMatrix(element, transformation, matrix);
}

} // namespace cattaneo
