#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>

namespace miniapp
{

using cattaneo::InputError;

namespace
{

cattaneo::CondenseSettings condense_settings;

/// Leaves the body with an exit code.
struct Leave
{
   int code;
};

/// What a user typed or a file held may stand in a message: it must stay one line of text.
std::string one_line(std::string message)
{
   for (char &c : message)
   {
      if (std::iscntrl(static_cast<unsigned char>(c))) { c = ' '; }
   }
   return message;
}

/// MFEM's text without the values that were not set: a number without a default is NaN, which
/// says nothing to the reader.
std::string without_unset(const std::string &text)
{
   const std::string none = ", current value: nan";
   std::istringstream lines(text);
   std::string result;
   for (std::string line; std::getline(lines, line);)
   {
      const bool unset = line.size() > 4 && line.substr(line.size() - 4) == " nan";
      const auto at = line.find(none);
      if (at != std::string::npos) { line.erase(at, none.size()); }
      else if (unset) { continue; }
      result += line + "\n";
   }
   return result;
}

/// Tests make scenes without starting MPI.
int world_size()
{
#ifdef MFEM_USE_MPI
   return mfem::Mpi::IsInitialized() ? mfem::Mpi::WorldSize() : 1;
#else
   return 1;
#endif
}

/// True if the other ranks come here too, within a second: most errors are seen by all alike.
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

bool writes()
{
#ifdef MFEM_USE_MPI
   return !mfem::Mpi::IsInitialized() || mfem::Mpi::Root();
#else
   return true;
#endif
}

std::unique_ptr<mfem::Mesh> distribute(mfem::Mesh mesh, [[maybe_unused]] int order)
{
#ifdef MFEM_USE_MPI
   const mfem::H1_FECollection elements(order, mesh.Dimension());
   if (world_size() > 1 && mfem::FiniteElementSpace(&mesh, &elements, 2).GetTrueVSize() >
                              condense_settings.direct_dofs)
   {
      cattaneo::require(mesh.GetNE() >= world_size(), "the mesh has ", mesh.GetNE(),
                        " elements for ", world_size(),
                        " ranks, there must be at least one for each");
      return std::make_unique<mfem::ParMesh>(MPI_COMM_WORLD, mesh);
   }
#endif
   return std::make_unique<mfem::Mesh>(std::move(mesh));
}

int run(const std::function<int()> &body)
{
#ifdef MFEM_USE_MPI
   mfem::Mpi::Init();
   mfem::Hypre::Init();
   if (!writes() && !std::freopen("/dev/null", "w", stdout)) { return 1; }
#endif
   try
   {
      return body();
   }
   catch (const Leave &leave)
   {
      return leave.code;
   }
   catch (const InputError &error)
   {
      if (all_fail())
      {
         if (writes()) { std::cerr << "error: " << one_line(error.what()) << std::endl; }
         return 1;
      }
      // In one piece: what other ranks write must not come between.
      std::cerr << "error: " + one_line(error.what()) + "\n" << std::flush;
#ifdef MFEM_USE_MPI
      MPI_Abort(MPI_COMM_WORLD, 1);
#endif
      return 1;
   }
}

void parse(mfem::OptionsParser &options)
{
   if (world_size() > 1)
   {
      options.AddOption(
         &condense_settings.direct_dofs, "-direct-dofs", "--direct-dofs",
         "Bodies of more dofs than this are distributed and condensed by iterations, "
         "others factored by every rank.");
      options.AddOption(&condense_settings.max_iterations, "-max-iterations",
                        "--max-iterations", "Most iterations for a right-hand side.");
   }
   options.Parse();
   if (options.Help())
   {
      std::ostringstream help;
      options.PrintHelp(help);
      std::cout << without_unset(help.str());
      throw Leave{0};
   }
   if (!options.Good())
   {
      // MFEM's message has empty lines around it and may stream a null pointer.
      std::ostringstream text;
      options.PrintError(text);
      std::istringstream words(text.str());
      std::string message, word;
      while (words >> word) { message += " " + word; }
      if (writes())
      {
         std::cerr << "error:" << one_line(message) << " (-h lists the options)" << std::endl;
      }
      throw Leave{1};
   }
   std::ostringstream values;
   options.PrintOptions(values);
   std::cout << without_unset(values.str()) << std::endl;
}

std::vector<double> numbers(const char *option, const std::string &text)
{
   std::vector<double> values;
   if (text == "none") { return values; }
   std::string word;
   for (char c : text + " ")
   {
      if (c != ' ' && c != ',')
      {
         word += c;
         continue;
      }
      if (word.empty()) { continue; }
      char *end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      cattaneo::require(*end == 0 && std::isfinite(value), "option ", option, ": '", word,
                        "' is not a number");
      values.push_back(value);
      word.clear();
   }
   return values;
}

cattaneo::CondenseSettings condensation()
{
   return condense_settings;
}

void check_choice(const char *option, const std::string &value,
                  const std::vector<std::string> &allowed)
{
   std::string list;
   for (const std::string &choice : allowed)
   {
      if (choice == value) { return; }
      list += (list.empty() ? "" : ", ") + choice;
   }
   throw InputError(std::string("option ") + option + ": '" + value + "' is not one of " +
                    list);
}

const char *const stepping_help =
   "advancing (increments, halved while contact advances by more than a node), fixed "
   "(increments) or exact (from one change of state to the next).";

cattaneo::Stepping stepping(const char *option, const std::string &value)
{
   check_choice(option, value, {"advancing", "fixed", "exact"});
   return value == "exact"   ? cattaneo::Stepping::exact
          : value == "fixed" ? cattaneo::Stepping::fixed
                             : cattaneo::Stepping::advancing;
}

void add_exact_path(const cattaneo::ReducedProblem &problem,
                    const cattaneo::MarchReport &report,
                    const cattaneo::MarchSettings &settings, nlohmann::ordered_json &results)
{
   if (settings.stepping != cattaneo::Stepping::exact) { return; }
   std::cout << "exact path: " << report.changes.size() << " changes of state" << std::endl;
   nlohmann::ordered_json changes = nlohmann::ordered_json::array();
   for (const cattaneo::StateChange &change : report.changes)
   {
      changes.push_back({{"time", change.time},
                         {"loads", named(problem, change.multipliers)},
                         {"node", change.node},
                         {"from", name(change.from)},
                         {"to", name(change.to)}});
   }
   results["state_changes"] = changes;
   results["fallbacks"] = report.fallbacks;
   results["fallback_reason"] = report.fallback_reason;
}

std::vector<double> unloading_levels(int steps, double lowest, std::vector<double> wanted)
{
   double level = 1;
   while (level > lowest)
   {
      level = std::max(lowest, level - std::min(1.0 / steps, 0.2 * level));
      wanted.push_back(level);
   }
   std::sort(wanted.rbegin(), wanted.rend());
   std::vector<double> levels;
   for (double p : wanted)
   {
      if (p < 1 && (levels.empty() || levels.back() - p > 1e-9)) { levels.push_back(p); }
   }
   return levels;
}

void warn_of_cut_off(const std::vector<cattaneo::CutOffContact> &ends)
{
   // Once for each end, however many marches a study consists of.
   static std::set<std::tuple<Eigen::Index, bool, double, double>> known;
   for (const cattaneo::CutOffContact &end : ends)
   {
      if (known.insert({end.node, end.at_first, end.x, end.y}).second) { warn(end.message()); }
   }
}

namespace
{

/// "time 0.3 (P = 1, 'n = 4' = 0.2)"
std::string event_text(const cattaneo::ReducedProblem &problem, double time,
                       const Eigen::VectorXd &multipliers)
{
   std::ostringstream text;
   text << "time " << time;
   const char *before = " (";
   for (const auto &[name, value] : named(problem, multipliers))
   {
      // Names of studies' loads hold numbers of their own.
      const char *quote = name.find(' ') == std::string::npos ? "" : "'";
      text << before << quote << name << quote << " = " << value;
      before = ", ";
   }
   text << ")";
   return text.str();
}

} // namespace

int exit_code(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report)
{
   warn_of_cut_off(report.cut_off);
   if (report.fallbacks > 0)
   {
      std::cout << "\n"
                << report.fallbacks
                << " increments where there is no exact path: " << report.fallback_reason
                << std::endl;
   }
   if (report.advance_error > 1e-6)
   {
      std::cout << "\nContact advanced with friction, whose forces depend on how that is cut "
                   "into increments: by up to "
                << error_text(report.advance_error) << " of the largest nodal force"
                << std::endl;
   }
   if (report.stalled > 0)
   {
      std::cout << "\n"
                << report.stalled << " increments stalled and were passed by shorter ones"
                << std::endl;
   }
   if (report.status == cattaneo::FrictionStatus::converged) { return 0; }
   if (const auto &first = report.not_unique)
   {
      std::cout << "\nNot unique: from " << event_text(problem, first->time, first->multipliers)
                << " on, the states are one of several:\n  " << first->message << std::endl;
   }
   if (report.status != cattaneo::FrictionStatus::not_unique)
   {
      std::cout << "\nEnded with status '" << name(report.status) << "' at "
                << event_text(problem, report.event_time, report.event_multipliers) << ":\n  "
                << report.message << std::endl;
   }
   return 2;
}

void add_outcome(const cattaneo::ReducedProblem &problem, const cattaneo::MarchReport &report,
                 nlohmann::ordered_json &results)
{
   results["status"] = name(report.status);
   if (report.status == cattaneo::FrictionStatus::converged) { return; }
   results["message"] = report.message;
   results["event_time"] = report.event_time;
   results["event_loads"] = named(problem, report.event_multipliers);
   if (const auto &first = report.not_unique)
   {
      results["not_unique"] = {{"time", first->time},
                               {"loads", named(problem, first->multipliers)},
                               {"message", first->message}};
   }
}

nlohmann::ordered_json to_json(const cattaneo::Counters &counters)
{
   nlohmann::ordered_json j;
   cattaneo::Counters::for_each(counters,
                                [&](const char *name, long value) { j[name] = value; });
   return j;
}

std::string exact_text(const std::string &words, double value)
{
   return words + cattaneo::exact_text(value);
}

std::string error_text(double error)
{
   char text[32];
   if (!(error > 0) || !std::isfinite(error))
   {
      std::snprintf(text, sizeof text, "%g", error);
      return text;
   }
   const double unit = std::pow(10.0, std::floor(std::log10(error)) - 1);
   // What is a whole number of units but for round-off is not rounded up.
   std::snprintf(text, sizeof text, "%.2g", std::ceil(error / unit * (1 - 1e-12)) * unit);
   return text;
}

nlohmann::ordered_json json_number(double value)
{
   return std::isfinite(value) ? nlohmann::ordered_json(value)
                               : nlohmann::ordered_json(nullptr);
}

namespace
{

/// Of this run.
std::vector<std::string> &warnings()
{
   static std::vector<std::string> list;
   return list;
}

} // namespace

void warn(const std::string &text)
{
   std::vector<std::string> &given = warnings();
   if (std::find(given.begin(), given.end(), text) != given.end()) { return; }
   given.push_back(text);
   std::cout << "warning: " << text << std::endl;
}

void write_json(nlohmann::ordered_json results, const std::string &file)
{
   if (file.empty() || !writes()) { return; }
   results["warnings"] = warnings();
   cattaneo::write_whole(file, results.dump(2) + '\n');
}

void ReferenceTable::add(const std::string &name, double reference, Allowed allowed,
                         double thesis, double computed)
{
   rows_.push_back({name, reference, allowed, thesis, computed});
}

namespace
{

/// Outside of the reference's own ±, and whether the mesh explains it; NaN is outside. A
/// closed form has no ±.
std::string verdict(double difference, const Allowed &allowed)
{
   if (std::abs(difference) <= allowed.spread) { return ""; }
   const bool explained = std::abs(difference) <= allowed.spread + allowed.mesh;
   if (explained && allowed.spread == 0) { return "within the mesh's ±"; }
   return explained ? "outside, within the mesh's ±" : "outside";
}

} // namespace

void ReferenceTable::print() const
{
   if (rows_.empty()) { return; }
   // Columns are counted in characters, names are in UTF-8.
   const auto characters = [](const std::string &text) {
      return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
   };
   std::ptrdiff_t width = 8;
   for (const Row &row : rows_) { width = std::max(width, characters(row.name)); }
   const auto padded = [&](const std::string &name)
   { return name + std::string(width - characters(name), ' '); };
   std::printf("\n%s | %11s %9s %9s | %8s | %11s | %10s\n", padded("quantity").c_str(),
               "reference", "its ±", "mesh ±", "thesis", "computed", "difference");
   for (const Row &row : rows_)
   {
      char thesis[32] = "-", mesh[32] = "-";
      if (std::isfinite(row.thesis))
      {
         std::snprintf(thesis, sizeof thesis, "%.4g", row.thesis);
      }
      if (row.allowed.mesh > 0) { std::snprintf(mesh, sizeof mesh, "%.2g", row.allowed.mesh); }
      const double difference = row.computed - row.reference;
      std::printf("%s | %11.5g %8.2g %8s | %8s | %11.5g | %+10.2g  %s\n",
                  padded(row.name).c_str(), row.reference, row.allowed.spread, mesh, thesis,
                  row.computed, difference, verdict(difference, row.allowed).c_str());
   }
   for (const std::string &note : notes_) { std::printf("  %s\n", note.c_str()); }
   std::fflush(stdout);
}

nlohmann::ordered_json ReferenceTable::json() const
{
   nlohmann::ordered_json list = nlohmann::ordered_json::array();
   for (const Row &row : rows_)
   {
      nlohmann::ordered_json j = {
         {"quantity", row.name},
         {"reference", row.reference},
         {"spread", row.allowed.spread},
         {"mesh", row.allowed.mesh},
         {"tolerance", row.allowed.spread + row.allowed.mesh},
         {"computed", json_number(row.computed)},
         {"outside", !(std::abs(row.computed - row.reference) <= row.allowed.spread)}};
      if (std::isfinite(row.thesis)) { j["thesis"] = row.thesis; }
      list.push_back(j);
   }
   return list;
}

} // namespace miniapp
