#pragma once

#include <cattaneo/formulation.hpp>
#include <memory>
#include <mfem.hpp>

namespace cattaneo
{

/// Exact on straight triangles and on quads for any gradient of a shape function times the
/// radii of the operator (r, in torsion r³), and for the product of two of them on elements
/// with parallel sides. Its points lie inside the element.
const mfem::IntegrationRule &
rule_of_revolution(const mfem::FiniteElement &element,
                   const mfem::ElementTransformation &transformation, Formulation formulation);

/** Isotropic elasticity of a body of revolution, x = r and y = z, unknowns (u_r, u_z):

       a(u, v) = ∫ (λ tr ε(u) tr ε(v) + 2μ ε(u) : ε(v)) 2πr dr dz,

       ε_rr = ∂u_r/∂r,  ε_zz = ∂u_z/∂z,  ε_θθ = u_r/r,  2 ε_rz = ∂u_r/∂z + ∂u_z/∂r.

    Any order, triangles and quads, straight or curved. The rule's points lie inside the
   elements, so that r > 0 at all of them. u_r = 0 on the axis is the user's to impose
   (ElasticBody does). The coefficients must outlive the integrator. */
class AxisymmetricElasticityIntegrator : public mfem::BilinearFormIntegrator
{
public:
   /// First Lamé coefficient λ and shear modulus μ.
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
   mfem::Vector shape_, position_;
   mfem::DenseMatrix gradient_;
};

/** Torsion of a body of revolution, x = r and y = z, unknown ψ = u_θ/r:

       a(ψ, φ) = ∫ G r² ∇ψ·∇φ 2πr dr dz.

    MFEM's diffusion with the points that r³ needs. There is no 1/r, a rigid twist is a
   constant, and the axis has no condition. The coefficient G must outlive the integrator. */
class TorsionIntegrator : public mfem::DiffusionIntegrator
{
public:
   /// G, a force per area.
   explicit TorsionIntegrator(mfem::Coefficient &shear_modulus);
   /// A row for the twist of each of the element's nodes.
   void AssembleElementMatrix(const mfem::FiniteElement &element,
                              mfem::ElementTransformation &transformation,
                              mfem::DenseMatrix &matrix) override;

private:
   struct Weighted : mfem::Coefficient
   {
      explicit Weighted(mfem::Coefficient &G_) : G(G_) {}
      double Eval(mfem::ElementTransformation &transformation,
                  const mfem::IntegrationPoint &point) override;
      mfem::Coefficient &G;
      mfem::Vector position;
   };
   explicit TorsionIntegrator(std::unique_ptr<Weighted> weighted);
   std::unique_ptr<Weighted> weighted_;
};

} // namespace cattaneo
