#pragma once

#include <string>

namespace cattaneo
{

/** The kernels of OpenBLAS that this process uses. OpenBLAS chooses them when the process
    starts, by the name of the processor. A processor that this version of OpenBLAS does not
    know may get kernels that are twenty years old. The environment variable OPENBLAS_CORETYPE,
    set before the process starts, chooses others. */
struct BlasKernels
{
   std::string name; ///< OpenBLAS's name, such as "Haswell"; empty with another BLAS or none
   std::string
      better; ///< name of safe kernels that are far faster on this processor; empty: none

   /// One sentence with the name of the kernels. If others are far faster, it says what to do.
   std::string statement() const;
};

/// The kernels of this process.
BlasKernels blas_kernels();

/// Kernels that are far faster than the named ones, on a processor with or without AVX2 and
/// FMA. Empty: there are none. Kernels with an unknown name count as good.
std::string better_blas_kernels(const std::string &name, bool has_avx2);

} // namespace cattaneo
