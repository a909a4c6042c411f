#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/ranks.hpp>
#include <numeric>
#include <optional>

namespace cattaneo
{

bool Ranks::any(bool here) const
{
   return max(here ? 1.0 : 0.0) > 0;
}

long Ranks::sum(long here) const
{
   const std::vector<double> all = gather({static_cast<double>(here)});
   return static_cast<long>(std::accumulate(all.begin(), all.end(), 0.0));
}

double Ranks::max(double here) const
{
   const std::vector<double> all = gather({here});
   return *std::max_element(all.begin(), all.end());
}

#ifdef MFEM_USE_MPI

Ranks::Ranks(const mfem::Mesh &mesh)
{
   if (const auto *parallel = dynamic_cast<const mfem::ParMesh *>(&mesh))
   {
      comm_ = parallel->GetComm();
      MPI_Comm_size(comm_, &size_);
      MPI_Comm_rank(comm_, &rank_);
      distributed_ = !mesh.ncmesh;
   }
}

bool Ranks::first_of_all()
{
   return !mfem::Mpi::IsInitialized() || mfem::Mpi::Root();
}

void Ranks::sum(Eigen::MatrixXd &here) const
{
   if (size_ == 1) { return; }
   // Sum on one rank and send the result to all. An all-reduce may add in another order on each
   // rank, and the bits would differ.
   const auto count = static_cast<int>(here.size());
   MPI_Reduce(rank_ == 0 ? MPI_IN_PLACE : here.data(), here.data(), count, MPI_DOUBLE, MPI_SUM,
              0, comm_);
   MPI_Bcast(here.data(), count, MPI_DOUBLE, 0, comm_);
}

std::vector<double> Ranks::gather(const std::vector<double> &here) const
{
   if (size_ == 1) { return here; }
   const auto count = static_cast<int>(here.size());
   std::vector<int> counts(size_), starts(size_, 0);
   MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
   std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
   std::vector<double> all(starts.back() + counts.back());
   MPI_Allgatherv(here.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(),
                  MPI_DOUBLE, comm_);
   return all;
}

void Ranks::on_first(const std::function<void()> &work) const
{
   if (!several())
   {
      work();
      return;
   }
   std::optional<InputError> error;
   if (first())
   {
      try
      {
         work();
      }
      catch (const InputError &found)
      {
         error = found;
      }
   }
   std::string message = error ? error->what() : "";
   int length = error ? static_cast<int>(message.size()) : -1;
   MPI_Bcast(&length, 1, MPI_INT, 0, comm_);
   if (length < 0) { return; }
   message.resize(length);
   MPI_Bcast(message.data(), length, MPI_CHAR, 0, comm_);
   throw InputError(message);
}

namespace
{

/// How many values each rank has and where they start, on the first rank.
struct Counts
{
   std::vector<int> counts, starts;

   Counts(MPI_Comm comm, int size, std::size_t here) : counts(size), starts(size + 1, 0)
   {
      const auto own = static_cast<int>(here);
      MPI_Gather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm);
      std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
   }
};

template <class T>
std::vector<T> collected(MPI_Comm comm, int size, int rank, const std::vector<T> &here,
                         MPI_Datatype type)
{
   if (size == 1) { return here; }
   const Counts of(comm, size, here.size());
   std::vector<T> all(rank == 0 ? of.starts.back() : 0);
   MPI_Gatherv(here.data(), static_cast<int>(here.size()), type, all.data(), of.counts.data(),
               of.starts.data(), type, 0, comm);
   return all;
}

} // namespace

std::vector<double> Ranks::collect(const std::vector<double> &here) const
{
   return collected(comm_, size_, rank_, here, MPI_DOUBLE);
}
std::vector<int> Ranks::collect(const std::vector<int> &here) const
{
   return collected(comm_, size_, rank_, here, MPI_INT);
}

void Ranks::share(Eigen::MatrixXd &matrix) const
{
   if (!several()) { return; }
   long shape[2] = {matrix.rows(), matrix.cols()};
   MPI_Bcast(shape, 2, MPI_LONG, 0, comm_);
   if (!first()) { matrix.resize(shape[0], shape[1]); }
   MPI_Bcast(matrix.data(), static_cast<int>(matrix.size()), MPI_DOUBLE, 0, comm_);
}

void Ranks::deal(const Eigen::VectorXd &all, int count, double *here) const
{
   if (!several())
   {
      std::copy_n(all.data(), count, here);
      return;
   }
   const Counts of(comm_, size_, count);
   MPI_Scatterv(all.data(), of.counts.data(), of.starts.data(), MPI_DOUBLE, here, count,
                MPI_DOUBLE, 0, comm_);
}

#else

bool Ranks::first_of_all()
{
   return true;
}

Ranks::Ranks(const mfem::Mesh &) {}
void Ranks::sum(Eigen::MatrixXd &) const {}
std::vector<double> Ranks::gather(const std::vector<double> &here) const
{
   return here;
}
void Ranks::on_first(const std::function<void()> &work) const
{
   work();
}
std::vector<double> Ranks::collect(const std::vector<double> &here) const
{
   return here;
}
std::vector<int> Ranks::collect(const std::vector<int> &here) const
{
   return here;
}
void Ranks::share(Eigen::MatrixXd &) const {}
void Ranks::deal(const Eigen::VectorXd &all, int count, double *here) const
{
   std::copy_n(all.data(), count, here);
}

#endif

} // namespace cattaneo
