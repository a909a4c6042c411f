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

/// How many ranks run this.
int ranks();

/// True on the rank that writes files.
bool writes();

/// A mesh for bodies of this order to be made on, of the given one, which every rank must have.
/// On several ranks an mfem::ParMesh if a body of two components is too large for a factor (see
/// condensation()); smaller ones every rank has for itself, so that it does what one alone
/// would do, to the same bits.
std::unique_ptr<mfem::Mesh> distribute(mfem::Mesh mesh, int order);

/// How bodies are to be condensed, as the options say.
cattaneo::CondenseSettings &condensation();

nlohmann::ordered_json to_json(const cattaneo::Counters &counters);

/// Prints a warning, once however often it is given; the results of write_json() list them.
void warn(const std::string &text);
/// The same, from parts of a sentence.
template <class... Parts>
void warn(const Parts &...parts)
{
   warn(told(parts...));
}

/// Those that were given.
const std::vector<std::string> &warnings();

/// Prints what was done that the user may not expect, though it is right; the results of
/// write_json() list it.
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
