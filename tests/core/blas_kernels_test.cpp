#include <cattaneo/algebra/blas_kernels.hpp>
#include <cstdlib>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;

TEST(BlasKernels, ThoseFarBelowTheProcessorAreKnown)
{
   // Two numbers at a time (SSE) on a processor that does eight products of them.
   for (const char *narrow : {"Prescott", "Core2", "Penryn", "Nehalem", "Barcelona", "Atom"})
   {
      EXPECT_EQ(better_blas_kernels(narrow, true), "Haswell") << narrow;
      EXPECT_EQ(better_blas_kernels(narrow, false), "") << narrow;
   }
   for (const char *wide : {"Sandybridge", "Haswell", "Zen", "SkylakeX", "Cooperlake",
                            "SapphireRapids", "OfTheFuture", "NEOVERSEN1", ""})
   {
      EXPECT_EQ(better_blas_kernels(wide, true), "") << wide;
   }
}

TEST(BlasKernels, AreThoseThatWereAskedFor)
{
   const BlasKernels kernels = blas_kernels();
   if (kernels.name.empty()) { GTEST_SKIP() << "the BLAS is not OpenBLAS"; }
   const char *asked = std::getenv("OPENBLAS_CORETYPE");
   if (asked && *asked) { EXPECT_STRCASEEQ(kernels.name.c_str(), asked); }
   EXPECT_NE(kernels.statement().find(kernels.name), std::string::npos);
   EXPECT_EQ(kernels.statement().find("OPENBLAS_CORETYPE=") == std::string::npos,
             kernels.better.empty());
}

} // namespace
