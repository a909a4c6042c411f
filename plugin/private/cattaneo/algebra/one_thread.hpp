#pragma once

#include <Eigen/Core>

namespace cattaneo
{

/// While one of these lives that was made for a small matrix, OpenBLAS works on it with one
/// thread: to share so little work out costs several times as much as the work. The number of
/// threads is the process's own, so that others who work meanwhile have one as well. Nothing
/// happens with another BLAS.
class OneThread
{
public:
   /// `rows`: of the matrix that is factored.
   explicit OneThread(Eigen::Index rows);
   ~OneThread();
   OneThread(const OneThread &) = delete;
   OneThread &operator=(const OneThread &) = delete;

private:
   const bool asked_;
};

} // namespace cattaneo
