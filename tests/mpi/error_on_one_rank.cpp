// An error that one rank alone sees must end the run on all of them, with one message and exit
// code 1; so must one that all see. The argument says which.

#include <cattaneo/input_error.hpp>
#include <common/miniapp.hpp>
#include <cstdlib>

int main(int argc, char *argv[])
{
   const int who = argc > 1 ? std::atoi(argv[1]) : -1; // -1: all
   return miniapp::run(
      [&]
      {
         cattaneo::require(who >= 0 && who != mfem::Mpi::WorldRank(), "the mesh is bad");
         MPI_Barrier(MPI_COMM_WORLD); // what a collective call would do
         return 0;
      });
}
