#pragma once

#include <cmath>
#include <mfem.hpp>

/** Isotropic elasticity of a body of revolution, x = r and y = z, unknowns (u_r, u_z), for
    mfem::BilinearForm:

       a(u, v) = ∫ (λ tr ε(u) tr ε(v) + 2μ ε(u) : ε(v)) 2πr dr dz,

       ε_rr = ∂u_r/∂r,  ε_zz = ∂u_z/∂z,  ε_θθ = u_r/r,  2 ε_rz = ∂u_r/∂z + ∂u_z/∂r.

    The coefficients must outlive it. */
class AxisymmetricElasticityIntegrator : public mfem::BilinearFormIntegrator
{
public:
   AxisymmetricElasticityIntegrator(mfem::Coefficient &lambda, mfem::Coefficient &mu)
      : lambda_(lambda), mu_(mu)
   {
   }
   /// Rows {u_r; u_z} of the element's nodes, as MFEM numbers them.
   void AssembleElementMatrix(const mfem::FiniteElement &element,
                              mfem::ElementTransformation &transformation,
                              mfem::DenseMatrix &matrix) override
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

private:
   mfem::Coefficient &lambda_, &mu_;
};

/// The coefficient 2πr³ that, times the shear modulus, makes MFEM's diffusion of ψ = u_θ/r the
/// torsion of a body of revolution.
inline double polar_moment(const mfem::Vector &x)
{
   return 2 * M_PI * x(0) * x(0) * x(0);
}

/// That diffusion, with the points that r³ needs.
inline mfem::BilinearFormIntegrator *torsion_integrator(mfem::FiniteElementSpace &space,
                                                        mfem::Coefficient &stiffness)
{
   const mfem::FiniteElement &element = *space.GetFE(0);
   auto *integrator = new mfem::DiffusionIntegrator(stiffness);
   integrator->SetIntRule(&mfem::IntRules.Get(
      element.GetGeomType(),
      2 * element.GetOrder() + 4 * space.GetElementTransformation(0)->Order()));
   return integrator;
}
