#pragma once

namespace cattaneo
{

/// A function of the OpenBLAS that our products and factors are made with, by its name; null
/// with another BLAS. It is looked for where dgemm_ comes from, since a process may hold more
/// than one: NumPy brings its own.
void *openblas_function(const char *name);

} // namespace cattaneo
