#pragma once

#include <cattaneo/elastic/material.hpp>
#include <cattaneo/formulation.hpp>
#include <memory>
#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** The stiffness of an isotropic body on the vdofs of an H1 space ordered byVDIM, on this rank
   and before hanging nodes are constrained: what an mfem::BilinearForm of the same integrators
   would give, to round-off and symmetric to the last bit, several times faster:

    - the sparsity is that of the nodes, built once; each pair of nodes adds its 2×2 block;
    - all points of an element are integrated at once, as products of small matrices;
    - in the plane, elements that are affine (triangles with straight sides, parallelograms)
      share the integrals ∫ ∂φi/∂ξa ∂φj/∂ξb of the reference element, whatever their size.

    `materials`: by element attribute - 1; all attributes are taken to have one. */
std::unique_ptr<mfem::SparseMatrix> assemble_stiffness(const mfem::FiniteElementSpace &space,
                                                       const std::vector<Material> &materials,
                                                       Formulation formulation);

} // namespace cattaneo
