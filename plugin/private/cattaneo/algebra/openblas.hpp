#pragma once

namespace cattaneo
{

/// The function with this name in the OpenBLAS that computes our products and factors; null
/// with another BLAS. It is searched in the library of dgemm_, because a process may have more
/// than one OpenBLAS: NumPy brings its own.
void *openblas_function(const char *name);

} // namespace cattaneo
