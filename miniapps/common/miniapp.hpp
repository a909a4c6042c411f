#pragma once

#include "common/text.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/counters.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <mfem.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace miniapp
{

/** Runs a miniapp's body and turns bad input into one sentence on stderr and exit code 1. The
    body returns the exit code: 0, or 2 for an outcome that ended the study early (gross
    sliding, …).

    On several ranks all of them run the body, and the first one speaks and writes for all; an
    error that only one rank sees ends the others too. */
int run(const std::function<int()> &body);

/// Leaves the body with exit code 0.
struct Leave
{
};

/// Number of ranks that run this program.
int ranks();

/// True on the rank that writes the files.
bool writes();

/// The mesh on which bodies of this order are made, from the given one, which every rank must
/// have. On several ranks it is an mfem::ParMesh if a body of two components is too large for a
/// factor (see condensation()). A smaller mesh stays whole on every rank, so that each rank
/// computes what a single one would, to the same bits.
std::unique_ptr<mfem::Mesh> distribute(mfem::Mesh mesh, int order);

/// The settings of condensation, as the options give them.
cattaneo::CondenseSettings &condensation();

nlohmann::ordered_json to_json(const cattaneo::Counters &counters);

/// Prints a warning, only the first time that it is given; write_json() lists all warnings.
void warn(const std::string &text);
/// The same, from parts of a sentence.
template <class... Parts>
void warn(const Parts &...parts)
{
   warn(told(parts...));
}

/// The warnings that were given.
const std::vector<std::string> &warnings();

/// Prints a note on something correct that the user may not expect; write_json() lists all
/// notes.
void note(const std::string &text);

/// Writes results as JSON, whole or not at all, and with them the lists `warnings` and `notes`
/// (if there are any); nothing if the file name is empty.
void write_json(nlohmann::ordered_json results, const std::string &file);

/// Wall time since construction, seconds.
class Stopwatch
{
public:
   double seconds() const
   {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
   }

private:
   std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

} // namespace miniapp
