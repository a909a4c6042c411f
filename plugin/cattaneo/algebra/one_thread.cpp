#include <cattaneo/algebra/one_thread.hpp>
#include <mutex>

#if defined(CATTANEO_USE_LAPACK) && defined(__ELF__)
// OpenBLAS's own; null with another BLAS.
extern "C"
{
   __attribute__((weak)) void openblas_set_num_threads(int threads);
   __attribute__((weak)) int openblas_get_num_threads();
}
#endif

namespace cattaneo
{

namespace
{

#if defined(CATTANEO_USE_LAPACK) && defined(__ELF__)
int blas_threads()
{
   return openblas_set_num_threads && openblas_get_num_threads ? openblas_get_num_threads() : 1;
}
void set_blas_threads(int threads)
{
   openblas_set_num_threads(threads);
}
#else
int blas_threads()
{
   return 1;
}
void set_blas_threads(int) {}
#endif

/// OpenBLAS spends some ten milliseconds of two threads on an LU factor before they pay.
constexpr Eigen::Index small = 1000;

std::mutex guard;
int askers = 0, threads_before = 1; // who lives, and what the first of them found

} // namespace

OneThread::OneThread(Eigen::Index rows) : asked_(rows < small)
{
   if (!asked_) { return; }
   const std::lock_guard<std::mutex> lock(guard);
   if (askers++ > 0) { return; }
   threads_before = blas_threads();
   if (threads_before > 1) { set_blas_threads(1); }
}

OneThread::~OneThread()
{
   if (!asked_) { return; }
   const std::lock_guard<std::mutex> lock(guard);
   if (--askers == 0 && threads_before > 1) { set_blas_threads(threads_before); }
}

} // namespace cattaneo
