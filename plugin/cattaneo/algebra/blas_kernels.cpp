#include <cattaneo/algebra/blas_kernels.hpp>
#include <cattaneo/algebra/lapack.hpp>
#include <cattaneo/algebra/openblas.hpp>
#include <set>
#if __has_include(<dlfcn.h>)
#include <dlfcn.h>
#endif

namespace cattaneo
{

namespace
{

/// Has the processor AVX2 and FMA, and does the system save their registers?
bool has_avx2()
{
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__))
   return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
   return false;
#endif
}

} // namespace

void *openblas_function([[maybe_unused]] const char *name)
{
#if defined(CATTANEO_USE_LAPACK) && __has_include(<dlfcn.h>)
   // The library that contains dgemm_, and those that it needs. In a program dgemm_ may be a
   // stub at another address; then the library that the program finds first is searched.
   Dl_info from = {};
   void *library = dladdr(reinterpret_cast<void *>(&dgemm_), &from) == 0
                      ? nullptr
                      : dlopen(from.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
   if (!library) { return dlsym(RTLD_DEFAULT, name); }
   void *function = dlsym(library, name);
   dlclose(library); // never closed, so that the pointers stay valid
   return function;
#else
   return nullptr;
#endif
}

std::string better_blas_kernels(const std::string &name, bool has_avx2)
{
   // These kernels use SSE, two numbers at a time. (AVX alone, Sandybridge and the like, is not
   // far below AVX2.)
   static const std::set<std::string> narrow = {
      "Katmai",    "Coppermine",   "Northwood",     "Prescott", "Banias", "Atom",    "Core2",
      "Penryn",    "Dunnington",   "Nehalem",       "Athlon",   "Nano",   "Opteron", "Bobcat",
      "Barcelona", "Opteron_SSE3", "Opteron(SSE3)", "Generic",  "Unknown"};
   return has_avx2 && narrow.count(name) > 0 ? "Haswell" : "";
}

BlasKernels blas_kernels()
{
   using Name = char *(*)();
   BlasKernels found;
   if (const auto name = reinterpret_cast<Name>(openblas_function("openblas_get_corename")))
   {
      found.name = name();
      found.better = better_blas_kernels(found.name, has_avx2());
   }
   return found;
}

std::string BlasKernels::statement() const
{
   if (name.empty()) { return "The kernels of this BLAS have no name: it is not OpenBLAS"; }
   const std::string sentence = "OpenBLAS works with its kernels " + name;
   if (better.empty()) { return sentence; }
   return sentence +
          ", which are far slower than this processor allows (matrix products take about five "
          "times as long): set OPENBLAS_CORETYPE=" +
          better + " before the program starts";
}

} // namespace cattaneo
