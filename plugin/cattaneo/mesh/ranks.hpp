#pragma once

#include <Eigen/Dense>
#include <functional>
#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** The ranks that share a mesh: those of an mfem::ParMesh, or this one alone. Its functions are
    collective: every rank must call them, in the same order. Only this class calls MPI. */
class Ranks
{
public:
   Ranks() = default;
   /// The ranks of an mfem::ParMesh. For another mesh, only this rank.
   explicit Ranks(const mfem::Mesh &mesh);

   /// How many.
   int size() const { return size_; }
   /// The number of this rank, from 0.
   int rank() const { return rank_; }
   /// More than one?
   bool several() const { return size_ > 1; }
   /// True if the mesh is a conforming mfem::ParMesh, even on one rank.
   bool distributed() const { return distributed_; }
   /// Is this the first of those that share the mesh?
   bool first() const { return rank_ == 0; }
   /// True on the first of all ranks of the program, whatever mesh they share.
   static bool first_of_all();

   /// True if the argument is true on any rank.
   bool any(bool here) const;
   /// Over all ranks.
   long sum(long here) const;
   /// Sums matrices of equal shape entry by entry, in place; the same bits on every rank.
   void sum(Eigen::MatrixXd &here) const;
   /// Largest of all ranks.
   double max(double here) const;
   /// The values of all ranks, in the order of the ranks.
   std::vector<double> gather(const std::vector<double> &here) const;

   /// Does work on the first rank only. Its InputError is thrown on all ranks.
   void on_first(const std::function<void()> &work) const;
   /// On the first rank the values of all ranks, in their order; empty on the others.
   std::vector<double> collect(const std::vector<double> &here) const;
   /// The same of whole numbers.
   std::vector<int> collect(const std::vector<int> &here) const;
   /// The first rank's matrix on all, whatever its shape.
   void share(Eigen::MatrixXd &matrix) const;
   /// Distributes the first rank's values to all ranks in their order; this rank gets `count`
   /// of them.
   void deal(const Eigen::VectorXd &all, int count, double *here) const;

private:
   int size_ = 1, rank_ = 0;
   bool distributed_ = false;
#ifdef MFEM_USE_MPI
   MPI_Comm comm_ = MPI_COMM_SELF;
#endif
};

} // namespace cattaneo
