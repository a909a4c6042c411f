#include <cattaneo/algebra/one_thread.hpp>
#include <cattaneo/algebra/openblas.hpp>
#include <mutex>

namespace cattaneo
{

namespace
{

/// OpenBLAS's function; null with another BLAS, or if the number of threads cannot be changed.
struct Threads
{
   using Get = int (*)();
   using Set = void (*)(int);
   const Get get = reinterpret_cast<Get>(openblas_function("openblas_get_num_threads"));
   const Set set = reinterpret_cast<Set>(openblas_function("openblas_set_num_threads"));

   int count() const { return get && set ? get() : 1; }
};

const Threads &threads()
{
   static const Threads found;
   return found;
}

/// About 20 milliseconds of one thread: an LU factor of 1,400 rows, or a product of 1,000. For
/// less work two threads with two processors of their own save at most a third of the time, and
/// if another program runs, each call waits some milliseconds for it.
constexpr double worth_sharing = 1e9;

std::mutex guard;
int askers = 0,
    threads_before =
       1; // number of present objects, and the number of threads that the first one found

} // namespace

OneThread::OneThread(double multiplications) : asked_(multiplications < worth_sharing)
{
   if (!asked_) { return; }
   const std::lock_guard<std::mutex> lock(guard);
   if (askers++ > 0) { return; }
   threads_before = threads().count();
   if (threads_before > 1) { threads().set(1); }
}

OneThread::~OneThread()
{
   if (!asked_) { return; }
   const std::lock_guard<std::mutex> lock(guard);
   if (--askers == 0 && threads_before > 1) { threads().set(threads_before); }
}

} // namespace cattaneo
