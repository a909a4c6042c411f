#include <cattaneo/elastic/ranks.hpp>
#include <numeric>

namespace cattaneo
{

#ifdef MFEM_USE_MPI

Ranks::Ranks(const mfem::Mesh &mesh)
{
   if (const auto *parallel = dynamic_cast<const mfem::ParMesh *>(&mesh))
   {
      comm_ = parallel->GetComm();
      MPI_Comm_size(comm_, &size_);
      MPI_Comm_rank(comm_, &rank_);
   }
}

namespace
{

template <class T>
T reduced(MPI_Comm comm, int size, T here, MPI_Datatype type, MPI_Op op)
{
   T all = here;
   if (size > 1) { MPI_Allreduce(&here, &all, 1, type, op, comm); }
   return all;
}

} // namespace

bool Ranks::any(bool here) const
{
   return reduced(comm_, size_, here ? 1 : 0, MPI_INT, MPI_MAX) != 0;
}
long Ranks::sum(long here) const
{
   return reduced(comm_, size_, here, MPI_LONG, MPI_SUM);
}
double Ranks::sum(double here) const
{
   return reduced(comm_, size_, here, MPI_DOUBLE, MPI_SUM);
}
double Ranks::max(double here) const
{
   return reduced(comm_, size_, here, MPI_DOUBLE, MPI_MAX);
}

void Ranks::sum(Eigen::MatrixXd &here) const
{
   if (size_ == 1) { return; }
   // Reduced on one rank and handed out: an all-reduce may add in another order elsewhere.
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

#else

Ranks::Ranks(const mfem::Mesh &) {}
bool Ranks::any(bool here) const
{
   return here;
}
long Ranks::sum(long here) const
{
   return here;
}
double Ranks::sum(double here) const
{
   return here;
}
void Ranks::sum(Eigen::MatrixXd &) const {}
double Ranks::max(double here) const
{
   return here;
}
std::vector<double> Ranks::gather(const std::vector<double> &here) const
{
   return here;
}

#endif

} // namespace cattaneo
