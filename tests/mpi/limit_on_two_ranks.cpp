// Debian's Ipopt brings a sequential MUMPS with a stub of MPI. If the stub were linked in front
// of the real one, every rank would run alone without a word. Run on two ranks: both must know
// of each other, before and after a limit programme, and agree on the limit.

#include <cattaneo/shakedown/limit.hpp>
#include <cstdio>
#include <mpi.h>
#include <shakedown_problems.hpp>

int main(int argc, char *argv[])
{
   MPI_Init(&argc, &argv);
   int size = 0, rank = -1;
   MPI_Comm_size(MPI_COMM_WORLD, &size);
   MPI_Comm_rank(MPI_COMM_WORLD, &rank);

   using namespace cattaneo;
   const ReducedProblem problem = shakedown_test::punch_like(17);
   const LimitReport report =
      load_limit(limit_problem(problem, held_and_cycled(problem, "P", 1, "Q", -0.5)));
   const double own = report.limit;
   double sum = 0;
   MPI_Allreduce(&own, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
   const bool good = size == 2 && report.status == LimitStatus::certified && own > 0 &&
                     std::abs(sum - 2 * own) <= 1e-12 * own;
   std::printf("rank %d of %d: limit %.9f (%s), sum %.9f: %s\n", rank, size, own,
               name(report.status), sum, good ? "good" : "BAD");
   MPI_Finalize();
   return good ? 0 : 1;
}
