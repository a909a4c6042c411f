// An error must end the run on all ranks, with one message and exit code 1, whoever sees it.
// The argument says what goes wrong.

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/input_error.hpp>
#include <common/miniapp.hpp>
#include <limits>

int main(int, char *argv[])
{
   const std::string what = argv[1];
   return miniapp::run(
      [&]
      {
         const std::string rank = std::to_string(mfem::Mpi::WorldRank());
         cattaneo::require(what != "all" && what != rank, "the mesh is bad");
         mfem::Mesh whole =
            mfem::Mesh::MakeCartesian2D(8, 8, mfem::Element::QUADRILATERAL, true);
         mfem::ParMesh mesh(MPI_COMM_WORLD, whole);
         if (what == "mesh" && rank == "1")
         {
            mesh.GetVertex(0)[0] = std::numeric_limits<double>::quiet_NaN();
         }
         cattaneo::ElasticBody body(mesh, 2, cattaneo::Material{1, 0.3});
         cattaneo::CondenseSettings settings;
         settings.direct_dofs = 0;
         if (what == "iterations") { settings.max_iterations = 1; }
         condense(body, contact_line(body, 1), settings);
         return 0; // without an error, or where another rank's is not heard of
      });
}
