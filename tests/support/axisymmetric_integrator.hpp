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
                              mfem::DenseMatrix &matrix) override;

private:
   mfem::Coefficient &lambda_, &mu_;
};

/// The coefficient 2πr³ that, times the shear modulus, makes MFEM's diffusion of ψ = u_θ/r the
/// torsion of a body of revolution.
double polar_moment(const mfem::Vector &x);

/// That diffusion, with the points that r³ needs.
mfem::BilinearFormIntegrator *torsion_integrator(mfem::FiniteElementSpace &space,
                                                 mfem::Coefficient &stiffness);
