#include "common/miniapp.hpp"

#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <thread>
#ifdef __GLIBC__
#include <climits>
#include <malloc.h>
#endif

namespace miniapp
{

using cattaneo::InputError;

namespace
{

/// A message may quote what a user typed, or a file. It must remain one line of text.
std::string one_line(std::string message)
{
   for (char &c : message)
   {
      if (std::iscntrl(static_cast<unsigned char>(c))) { c = ' '; }
   }
   return message;
}

/// True if the other ranks come here too within a second, because most errors occur on all of
/// them.
bool all_fail()
{
#ifdef MFEM_USE_MPI
   MPI_Request all;
   MPI_Ibarrier(MPI_COMM_WORLD, &all);
   int there = 0;
   for (int wait = 0; wait < 100 && !there; ++wait)
   {
      MPI_Test(&all, &there, MPI_STATUS_IGNORE);
      if (!there) { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }
   }
   return there != 0;
#else
   return true;
#endif
}

} // namespace

int ranks()
{
#ifdef MFEM_USE_MPI
   // Tests make scenes without starting MPI.
   return mfem::Mpi::IsInitialized() ? mfem::Mpi::WorldSize() : 1;
#else
   return 1;
#endif
}

bool writes()
{
#ifdef MFEM_USE_MPI
   return !mfem::Mpi::IsInitialized() || mfem::Mpi::Root();
#else
   return true;
#endif
}

cattaneo::CondenseSettings &condensation()
{
   static cattaneo::CondenseSettings settings;
   return settings;
}

std::unique_ptr<mfem::Mesh> distribute(mfem::Mesh mesh, [[maybe_unused]] int order)
{
#ifdef MFEM_USE_MPI
   const mfem::H1_FECollection elements(order, mesh.Dimension());
   if (ranks() > 1 && mfem::FiniteElementSpace(&mesh, &elements, 2).GetTrueVSize() >
                         condensation().direct_dofs)
   {
      cattaneo::require(mesh.GetNE() >= ranks(), "the mesh has ", mesh.GetNE(),
                        " elements for ", ranks(),
                        " ranks, must be at least one for each rank");
      return std::make_unique<mfem::ParMesh>(MPI_COMM_WORLD, mesh);
   }
#endif
   return std::make_unique<mfem::Mesh>(std::move(mesh));
}

int run(const std::function<int()> &body)
{
#ifdef __GLIBC__
   // Memory of freed matrices is kept. Otherwise the system would clear the pages of each new
   // matrix, a tenth of the time with two thousand contact nodes.
   mallopt(M_MMAP_MAX, 0);
   mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
#ifdef MFEM_USE_MPI
   mfem::Mpi::Init();
   mfem::Hypre::Init();
   if (!writes() && !std::freopen("/dev/null", "w", stdout)) { return 1; }
#endif
   const auto refused = [](const char *why)
   {
      if (all_fail())
      {
         if (writes()) { std::cerr << "error: " << one_line(why) << std::endl; }
         return 1;
      }
      // Written in one piece, so that output of other ranks does not come between.
      std::cerr << "error: " + one_line(why) + "\n" << std::flush;
#ifdef MFEM_USE_MPI
      MPI_Abort(MPI_COMM_WORLD, 1);
#endif
      return 1;
   };
   try
   {
      return body();
   }
   catch (const Leave &)
   {
      return 0;
   }
   catch (const std::bad_alloc &)
   {
      return refused("there is not enough memory for this problem: use fewer nodes");
   }
   catch (const std::exception &error) // an InputError, or a library's
   {
      return refused(error.what());
   }
}

nlohmann::ordered_json to_json(const cattaneo::Counters &counters)
{
   nlohmann::ordered_json j;
   cattaneo::Counters::for_each(counters,
                                [&](const char *name, long value) { j[name] = value; });
   return j;
}

namespace
{

std::vector<std::string> given; ///< warnings of this run
std::vector<std::string> noted;

} // namespace

const std::vector<std::string> &warnings()
{
   return given;
}

void warn(const std::string &text)
{
   if (std::find(given.begin(), given.end(), text) != given.end()) { return; }
   given.push_back(text);
   ProgressLine::clear();
   std::cout << "warning: " << text << std::endl;
}

void note(const std::string &text)
{
   if (std::find(noted.begin(), noted.end(), text) != noted.end()) { return; }
   noted.push_back(text);
   ProgressLine::clear();
   std::cout << "note: " << text << std::endl;
}

void write_json(nlohmann::ordered_json results, const std::string &file)
{
   if (file.empty() || !writes()) { return; }
   results["warnings"] = given;
   if (!noted.empty()) { results["notes"] = noted; }
   // Data of pictures have too many numbers for a line each.
   const auto shown = results.find("shown");
   if (shown == results.end())
   {
      cattaneo::write_whole(file, results.dump(2) + '\n');
      return;
   }
   const std::string last = shown->dump();
   results.erase(shown);
   std::string text = results.dump(2);
   text.replace(text.rfind("\n}"), 2, ",\n  \"shown\": ");
   cattaneo::write_whole(file, text + last + "\n}\n");
}

} // namespace miniapp
