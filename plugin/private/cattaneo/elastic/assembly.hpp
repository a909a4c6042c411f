#pragma once

#include <cattaneo/elastic/field.hpp>
#include <cattaneo/formulation.hpp>
#include <memory>
#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** Stiffness of an isotropic body on the vdofs of an H1 space ordered byVDIM, on this rank and
    before hanging nodes are constrained. To round-off it is that of an mfem::BilinearForm with
    the same integrators. It is symmetric to the last bit, and several times faster:

    - the sparsity is that of the nodes, built once; each pair of nodes adds its 2×2 block;
    - all points of an element are integrated at once, as products of small matrices;
    - in the plane, elements that are affine (triangles with straight sides, parallelograms)
      share the integrals ∫ ∂φi/∂ξa ∂φj/∂ξb of the reference element, whatever their size.

    A body in space is assembled by MFEM's own form and integrator.

    `materials` by element attribute - 1; each attribute must have one. */
std::unique_ptr<mfem::SparseMatrix> assemble_stiffness(const mfem::FiniteElementSpace &space,
                                                       const std::vector<Material> &materials,
                                                       Formulation formulation);

/// The same for a material that varies within the elements. More points are used, which is
/// exact for Lamé coefficients of degree 4 on affine elements.
std::unique_ptr<mfem::SparseMatrix> assemble_stiffness(const mfem::FiniteElementSpace &space,
                                                       const VaryingMaterial &material,
                                                       Formulation formulation);

/// The points at which the stiffness of an element is integrated. They lie inside it, so that r
/// > 0. If forces of initial strains are integrated at the same points, a body expands without
/// stress, with curved elements too.
const mfem::IntegrationRule &
stiffness_rule(const mfem::FiniteElement &element,
               const mfem::IsoparametricTransformation &transformation, Formulation formulation,
               bool varying_material);

} // namespace cattaneo
