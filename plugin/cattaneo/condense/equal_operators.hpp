#pragma once

#include <mfem.hpp>

namespace cattaneo
{

/// True if two sparse matrices have the same pattern and entries equal to 1e-12 of the largest.
bool equal_operators(const mfem::SparseMatrix &A, const mfem::SparseMatrix &B);

} // namespace cattaneo
