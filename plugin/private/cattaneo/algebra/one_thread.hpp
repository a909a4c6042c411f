#pragma once

namespace cattaneo
{

/** While one of these lives that was made for little work, OpenBLAS does it with one thread.
    Threads wait for each other several times in a call: to share little work out costs more
   than the work, and where other programs have the processors, many times as much. The bits of
   what is done do not depend on the number of threads then.

    The number of threads is the process's own, so that others who work meanwhile have one as
    well. Nothing happens with another BLAS. */
class OneThread
{
public:
   /// `multiplications` of what is done meanwhile.
   explicit OneThread(double multiplications);
   ~OneThread();
   OneThread(const OneThread &) = delete;
   OneThread &operator=(const OneThread &) = delete;

   /// Factor for products and solutions that use each entry of a matrix once. They wait for
   /// memory, so one of their multiplications counts as so many in a product of matrices.
   static constexpr double reads_once = 16;

private:
   const bool asked_;
};

} // namespace cattaneo
