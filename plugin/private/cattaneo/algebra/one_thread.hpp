#pragma once

namespace cattaneo
{

/** While an object with a small `multiplications` exists, OpenBLAS uses one thread. Threads
    wait for each other several times in a call, so that sharing little work costs more than the
    work itself, and many times as much if other programs use the processors. The bits of the
    results then do not depend on the number of threads.

    The setting holds for the whole process, so that other work at the same time has one thread
    as well. With another BLAS nothing happens. */
class OneThread
{
public:
   /// @a multiplications: number of multiplications of the work that follows.
   explicit OneThread(double multiplications);
   ~OneThread();
   OneThread(const OneThread &) = delete;
   OneThread &operator=(const OneThread &) = delete;

   /// Factor for products and solutions that use each entry of a matrix once. They wait for
   /// memory, so that one multiplication in them costs as much as this number of
   /// multiplications in a product of matrices.
   static constexpr double reads_once = 16;

private:
   const bool asked_;
};

} // namespace cattaneo
