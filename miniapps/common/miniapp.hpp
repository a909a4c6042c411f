#pragma once

#include "common/options.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/friction/march.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <mfem.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/** Runs a miniapp's body and turns bad input into one sentence on stderr and exit code 1. The
   body returns the exit code: 0, or 2 for an outcome that ended the study early (gross sliding,
   …).

    On several ranks all of them run the body, and the first one speaks and writes for all; an
   error that only one rank sees ends the others too. */
int run(const std::function<int()> &body);

/// True on the rank that writes files.
bool writes();

/// A mesh for bodies of this order to be made on, of the given one, which every rank must have.
/// On several ranks an mfem::ParMesh if a body of two components is too large for a factor (see
/// condensation()); smaller ones every rank has for itself, so that it does what one alone
/// would do, to the same bits.
std::unique_ptr<mfem::Mesh> distribute(mfem::Mesh mesh, int order);

/// What Options::parse() leaves to MFEM: parses the options, echoes them, prints help for -h.
/// Leaves through run() with exit code 0 after help and 1, with one sentence, after a bad
/// option. On several ranks there are two more options, which say how bodies are condensed.
void parse(mfem::OptionsParser &options);

/// How bodies are to be condensed, as the options say.
cattaneo::CondenseSettings condensation();

/// Numbers of a list option, separated by spaces or commas, or "none"; InputError naming the
/// option.
std::vector<double> numbers(const char *option, const std::string &text);

/// InputError unless the value of an option is one of `allowed`.
void check_choice(const char *option, const std::string &value,
                  const std::vector<std::string> &allowed);

/// How a march steps, by the name that option -march gives; InputError naming the option.
cattaneo::Stepping stepping(const char *option, const std::string &value);
extern const char *const stepping_help;

/// Of an exact march: its changes of state, printed (their number) and added to the results
/// (the list), and whether it had to fall back. Nothing for other marches.
void add_exact_path(const cattaneo::ReducedProblem &problem,
                    const cattaneo::MarchReport &report,
                    const cattaneo::MarchSettings &settings, nlohmann::ordered_json &results);

/// Levels of a load that is taken back, descending from below 1 to `lowest`: steps of 1/steps
/// that shrink with the load, and all of `wanted`. None is a round-off away from another: the
/// states of so small a step would be noise.
std::vector<double> unloading_levels(int steps, double lowest, std::vector<double> wanted);

/// Warns of contact that reached an end of its line where the bodies go on, once for each end.
void warn_of_cut_off(const std::vector<cattaneo::CutOffContact> &ends);

/// Exit code of a march's outcome; prints where and why it ended early, was not unique or left
/// its exact path, and by how much its increments matter where contact advanced with friction.
int exit_code(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report);

/// Adds the status of a march and, of one that is not `converged`, what there is to say: where
/// and why it ended (`message`, `event_time`, `event_loads`), and from where on its states are
/// one of several (`not_unique`).
void add_outcome(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report,
                 nlohmann::ordered_json &results);

nlohmann::ordered_json to_json(const cattaneo::Counters &counters);

/// A name with a number so exact that no two numbers share one: "f = 0.5".
std::string exact_text(const std::string &words, double value);

/// An error as it is printed beside its value: two digits, the last one rounded up, since it is
/// a bound.
std::string error_text(double error);

/// JSON has no infinity or NaN: unknown or unbounded is null.
nlohmann::ordered_json json_number(double value);

/// Prints a warning, once however often it is given; the results of write_json() list them.
void warn(const std::string &text);

/// Writes results as JSON, whole or not at all, and with them the list `warnings`; nothing if
/// the file name is empty.
void write_json(nlohmann::ordered_json results, const std::string &file);

/** How far a computed value may be from its reference, in the units of the value: the spread of
    the reference itself, and the share of the mesh and of the increments, where that can be
    said. Whatever is outside of the first is marked, whether or not the second explains it. */
struct Allowed
{
   Allowed(double spread_, double mesh_ = 0) : spread(spread_), mesh(mesh_) {}
   double spread, mesh;
};

/// The table at the end of a study: reference | its ± | mesh ± | thesis | computed |
/// difference.
class ReferenceTable
{
public:
   /// Thesis: NaN where it gives none.
   void add(const std::string &name, double reference, Allowed allowed, double thesis,
            double computed);
   /// A line below the table: why the thesis differs, for instance.
   void note(const std::string &text) { notes_.push_back(text); }
   bool empty() const { return rows_.empty(); }
   void print() const;
   nlohmann::ordered_json json() const;

private:
   struct Row
   {
      std::string name;
      double reference;
      Allowed allowed;
      double thesis, computed;
   };
   std::vector<Row> rows_;
   std::vector<std::string> notes_;
};

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
