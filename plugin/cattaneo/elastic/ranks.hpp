#pragma once

#include <Eigen/Dense>
#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** The ranks that share a mesh: those of an mfem::ParMesh, or this one alone. What it does is
    collective: every rank must call it, in the same order. The one place that speaks MPI. */
class Ranks
{
public:
   Ranks() = default;
   explicit Ranks(const mfem::Mesh &mesh);

   int size() const { return size_; }
   int rank() const { return rank_; }
   bool several() const { return size_ > 1; }

   /// True if it is on any rank.
   bool any(bool here) const;
   long sum(long here) const;
   double sum(double here) const;
   /// Sums matrices of equal shape entry by entry, in place; the same bits on every rank.
   void sum(Eigen::MatrixXd &here) const;
   double max(double here) const;
   /// The values of all ranks, in the order of the ranks.
   std::vector<double> gather(const std::vector<double> &here) const;

private:
   int size_ = 1, rank_ = 0;
#ifdef MFEM_USE_MPI
   MPI_Comm comm_ = MPI_COMM_SELF;
#endif
};

} // namespace cattaneo
