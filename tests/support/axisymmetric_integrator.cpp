#include "axisymmetric_integrator.hpp"

void AxisymmetricElasticityIntegrator::AssembleElementMatrix(
   const mfem::FiniteElement &element, mfem::ElementTransformation &transformation,
   mfem::DenseMatrix &matrix)
{
   const int n = element.GetDof();
   mfem::Vector shape(n), position(2);
   mfem::DenseMatrix gradient(n, 2);
   matrix.SetSize(2 * n);
   matrix = 0.0;
   const mfem::IntegrationRule &points = mfem::IntRules.Get(
      element.GetGeomType(), 2 * (element.GetOrder() + transformation.Order()));
   for (int k = 0; k < points.GetNPoints(); ++k)
   {
      const mfem::IntegrationPoint &point = points.IntPoint(k);
      transformation.SetIntPoint(&point);
      transformation.Transform(point, position);
      element.CalcPhysShape(transformation, shape);
      element.CalcPhysDShape(transformation, gradient);
      const double r = position(0);
      const double weight = point.weight * transformation.Weight() * 2 * M_PI * r;
      const double lambda = weight * lambda_.Eval(transformation, point);
      const double mu = weight * mu_.Eval(transformation, point);
      for (int j = 0; j < n; ++j)
      {
         const double dr = gradient(j, 0), dz = gradient(j, 1), hoop = shape(j) / r;
         // Stresses of a unit u_r, and of a unit u_z, of node j.
         const double spherical_r = lambda * (dr + hoop), spherical_z = lambda * dz;
         for (int i = 0; i < n; ++i)
         {
            const double er = gradient(i, 0), ez = gradient(i, 1), eh = shape(i) / r;
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

double polar_moment(const mfem::Vector &x)
{
   return 2 * M_PI * x(0) * x(0) * x(0);
}

mfem::BilinearFormIntegrator *torsion_integrator(mfem::FiniteElementSpace &space,
                                                 mfem::Coefficient &stiffness)
{
   const mfem::FiniteElement &element = *space.GetFE(0);
   auto *integrator = new mfem::DiffusionIntegrator(stiffness);
   integrator->SetIntRule(&mfem::IntRules.Get(
      element.GetGeomType(),
      2 * element.GetOrder() + 4 * space.GetElementTransformation(0)->Order()));
   return integrator;
}
