#include "common/sweep.hpp"

#include "common/run.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace miniapp
{

using cattaneo::InputError;
using cattaneo::require;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace
{

struct SweptKey
{
   std::string name;
   std::vector<std::string> values;
};

struct Point
{
   std::vector<std::string> values, words;
   pid_t process = 0;
   bool ran = false, ended_well = false; ///< its exit code is 0
   ordered_json results = ordered_json::object();
   std::string status, message;
};

/// A number that is a word, or nothing.
ordered_json as_number(const std::string &word)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   return word.empty() || *end != 0 ? ordered_json(word) : ordered_json(value);
}

/// "0.01:0.05:9" are nine numbers from one to the other; all else is what it is.
std::vector<std::string> spread(const std::string &word)
{
   const std::vector<std::string> parts = split(word, ":");
   if (parts.size() != 3 || word.find(':') == std::string::npos) { return {word}; }
   const ordered_json from = as_number(parts[0]), to = as_number(parts[1]),
                      count = as_number(parts[2]);
   if (!from.is_number() || !to.is_number() || !count.is_number()) { return {word}; }
   const double steps = count.get<double>() - 1;
   require(steps >= 1 && steps < 1e5 && steps == std::floor(steps), "option --sweep: '", word,
           "' asks for ", parts[2], " values, must be at least 2 and at most 100000");
   std::vector<std::string> values;
   for (double k = 0; k <= steps; ++k)
   {
      values.push_back(
         text("%.12g", (from.get<double>() * (steps - k) + to.get<double>() * k) / steps));
   }
   return values;
}

std::vector<SweptKey> read_keys(const std::string &statements)
{
   std::vector<SweptKey> keys;
   for (const std::string &statement : split_unquoted("option --sweep", statements, ";"))
   {
      const auto [name, list] = assignment("option --sweep", statement, "friction=0.2 0.5");
      SweptKey key{name, {}};
      for (const SweptKey &other : keys)
      {
         require(other.name != key.name, "option --sweep: '", key.name, "' is there twice");
      }
      for (const std::string &word : split(list, " \t"))
      {
         for (const std::string &value : spread(word)) { key.values.push_back(value); }
      }
      require(!key.values.empty(), "option --sweep: '", statement, "' has no values");
      keys.push_back(key);
   }
   return keys;
}

std::string negative(const std::string &word)
{
   require(as_number(word).is_number(), "option --sweep: '", word,
           "' is the value of a key with a minus, must be a number");
   return word[0] == '-' ? word.substr(1) : '-' + word;
}

/// A key may be several places, "history.2.Q,-history.3.Q": all have the value, or its
/// negative.
std::vector<Point> make_points(const Options &options, const std::vector<SweptKey> &keys)
{
   std::vector<Point> points(1);
   for (const SweptKey &key : keys)
   {
      std::vector<Point> all;
      for (const Point &point : points)
      {
         for (const std::string &value : key.values)
         {
            all.push_back(point);
            all.back().values.push_back(value);
         }
      }
      require(all.size() <= 100000, "option --sweep asks for ", all.size(),
              " runs or more, must be at most 100000");
      points = all;
   }
   for (Point &point : points)
   {
      std::vector<std::pair<std::string, std::string>> changes;
      for (std::size_t k = 0; k < keys.size(); ++k)
      {
         for (const std::string &part : split_unquoted("option --sweep", keys[k].name, ","))
         {
            const bool back = part[0] == '-';
            changes.emplace_back(part.substr(back),
                                 back ? negative(point.values[k]) : point.values[k]);
         }
      }
      point.words = options.command(changes);
   }
   return points;
}

/// A folder for the results of the points, which goes with this.
class Folder
{
public:
   Folder()
   {
      std::string name = (fs::temp_directory_path() / "cattaneo_sweep_XXXXXX").string();
      require(mkdtemp(name.data()) != nullptr, "option --sweep: no folder can be made in '",
              fs::temp_directory_path().string(), "'");
      path_ = name;
   }
   ~Folder()
   {
      std::error_code ignored;
      fs::remove_all(path_, ignored);
   }
   Folder(const Folder &) = delete;
   std::string file(std::size_t point, const char *type) const
   {
      return path_ + "/" + std::to_string(point) + type;
   }

private:
   std::string path_;
};

/// A process that mpiexec started tells its children that they are of its job: each is one of
/// its own.
void leave_job()
{
#ifdef MFEM_USE_MPI
   for (char **variable = environ; *variable;)
   {
      const std::string name(*variable, std::strcspn(*variable, "="));
      const bool job = name.find("OMPI_") == 0 || name.find("PMIX_") == 0;
      if (job) { unsetenv(name.c_str()); }
      variable = job ? environ : variable + 1;
   }
#endif
}

/// The program of this process with other words, one thread, and nothing on the screen.
pid_t start(const std::vector<std::string> &words, const std::string &json,
            const std::string &errors)
{
   const std::string program = fs::read_symlink("/proc/self/exe").string();
   std::vector<std::string> all = {program};
   all.insert(all.end(), words.begin(), words.end());
   all.insert(all.end(), {"--json", json});
   std::vector<char *> arguments;
   for (std::string &word : all) { arguments.push_back(word.data()); }
   arguments.push_back(nullptr);
   const pid_t process = fork();
   require(process >= 0, "option --sweep: no process can be started");
   if (process > 0) { return process; }
   setpgid(0, 0); // Ctrl-C is for the sweep, which passes it on
#ifdef __linux__
   prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
   setenv("OPENBLAS_NUM_THREADS", "1", 1);
   leave_job();
   const int out = open("/dev/null", O_WRONLY);
   const int err = open(errors.c_str(), O_WRONLY | O_CREAT, 0600);
   dup2(out, STDOUT_FILENO);
   dup2(err, STDERR_FILENO);
   execv(program.c_str(), arguments.data());
   _exit(127);
}

/// What a process that has ended leaves.
void finish(Point &point, int status, const std::string &json, const std::string &errors)
{
   point.ran = true;
   point.process = 0;
   point.ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
   if (std::ifstream(json).good())
   {
      point.results = parsed(cattaneo::read_whole(json));
      point.status = point.results["status"];
      point.message = point.results.value("message", "");
      return;
   }
   std::ifstream in(errors);
   for (std::string line; std::getline(in, line);)
   {
      if (line.find("error: ") == 0) { point.message = line.substr(7); }
   }
   point.status = WIFEXITED(status) && WEXITSTATUS(status) == 1 ? "refused"
                  : WIFSIGNALED(status) && WTERMSIG(status) == SIGINT
                     ? "stopped"
                     : text("ended by signal %d", WIFSIGNALED(status) ? WTERMSIG(status) : 0);
}

/// Places of results, those with blanks or commas in quotes.
std::vector<std::string> places(const std::string &wanted)
{
   std::vector<std::string> all;
   for (const std::string &word : split_unquoted("option --sweep-results", wanted, " ,"))
   {
      all.push_back(unquoted(word));
   }
   return all;
}

/// A result by its place: "peak_pressure", "dissipation.0"; null if there is none.
ordered_json result(const ordered_json &results, const std::string &place)
{
   ordered_json at = results;
   for (const std::string &quoted : split_unquoted("option --sweep-results", place, "."))
   {
      const std::string word = unquoted(quoted);
      const ordered_json k = as_number(word);
      if (at.is_object() && at.contains(word)) { at = ordered_json(at[word]); }
      else if (at.is_array() && k.is_number() && k >= 0 && k < at.size())
      {
         at = ordered_json(at[k.get<std::size_t>()]);
      }
      else { return nullptr; }
   }
   return at.is_primitive() ? at : ordered_json();
}

/// All of them, unless it is stopped. Says at the first that ends well which of the wanted
/// results it does not have.
void run_points(std::vector<Point> &points, std::vector<std::string> wanted,
                const cattaneo::Monitor &monitor)
{
   const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
   const Folder folder;
   const Stopwatch watch;
   std::size_t next = 0, ended = 0;
   bool told = false;
   std::map<pid_t, std::size_t> running;
   while (!running.empty() || (next < points.size() && !monitor.stopped()))
   {
      for (; running.size() < cores && next < points.size() && !monitor.stopped(); ++next)
      {
         const pid_t process =
            start(points[next].words, folder.file(next, ".json"), folder.file(next, ".err"));
         running[process] = next;
      }
      if (monitor.stopped() && !told)
      {
         told = true;
         for (const auto &[process, point] : running) { kill(process, SIGINT); }
      }
      int status = 0;
      const pid_t process = waitpid(-1, &status, WNOHANG);
      if (const auto found = running.find(process); found != running.end())
      {
         const std::size_t k = found->second;
         finish(points[k], status, folder.file(k, ".json"), folder.file(k, ".err"));
         running.erase(found);
         ++ended;
         if (!points[k].ended_well) { continue; }
         for (const std::string &name : wanted)
         {
            if (!result(points[k].results, name).is_null()) { continue; }
            warn("option --sweep-results: the first point that ended has no number or word of "
                 "the name '" +
                 name + "'");
         }
         wanted.clear();
         continue;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (monitor.progress)
      {
         const auto done = static_cast<double>(ended);
         monitor.progress({done / static_cast<double>(points.size()), static_cast<long>(ended),
                           0, watch.seconds()});
      }
   }
}

/// Those that are single numbers in any point, but for its sizes, times, errors and residuals.
std::vector<std::string> single_numbers(const std::vector<Point> &points,
                                        const std::vector<SweptKey> &keys)
{
   std::set<std::string> known = {
      "contact_nodes", "dofs",       "seconds",          "seconds_condensation",
      "time",          "event_time", "largest_residual", "energy_imbalance"};
   for (const SweptKey &key : keys) { known.insert(key.name); }
   std::vector<std::string> names;
   for (const Point &point : points)
   {
      for (const auto &[name, x] : point.results.items())
      {
         const bool error = name.find("_error") != std::string::npos;
         if (x.is_number() && !error && known.insert(name).second) { names.push_back(name); }
      }
   }
   return names;
}

/// Does a result differ from point to point, by more than round-off?
bool varies(const std::vector<Point> &points, const std::string &name)
{
   const ordered_json first = result(points.front().results, name);
   return std::any_of(points.begin(), points.end(),
                      [&](const Point &point)
                      {
                         const ordered_json x = result(point.results, name);
                         if (!x.is_number() || !first.is_number()) { return x != first; }
                         const double a = x, b = first;
                         return std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b));
                      });
}

/// The key with the most numbers, over which results are drawn; as many as there are keys if
/// none has two.
std::size_t drawn_over(const std::vector<SweptKey> &keys)
{
   std::size_t over = keys.size(), count = 0;
   for (std::size_t k = 0; k < keys.size(); ++k)
   {
      const auto &values = keys[k].values;
      const bool numbers =
         std::all_of(values.begin(), values.end(),
                     [](const std::string &word) { return as_number(word).is_number(); });
      if (numbers && values.size() >= count && values.size() > 1)
      {
         over = k;
         count = values.size();
      }
   }
   return over;
}

/// A panel for each result over that key; of the other keys a curve each.
void draw(Study &study, const std::vector<SweptKey> &keys, const std::vector<Point> &points,
          const std::vector<std::string> &names)
{
   const std::size_t over = drawn_over(keys);
   if (over == keys.size()) { return; }
   for (const std::string &name : names)
   {
      Panel &panel =
         study.lines("over_" + keys[over].name + "_" + name, name, keys[over].name, name);
      for (const Point &point : points)
      {
         std::vector<std::string> series; // of the other keys
         for (std::size_t k = 0; k < keys.size(); ++k)
         {
            if (k != over) { series.push_back(keys[k].name + " = " + point.values[k]); }
         }
         const ordered_json y = result(point.results, name);
         if (y.is_number() && point.ended_well)
         {
            panel.point(listed(series), as_number(point.values[over]), y, "marked");
         }
      }
   }
}

} // namespace

void run_sweep(Study &study, const std::string &statements, const std::string &wanted)
{
   require(ranks() == 1, "option --sweep is for one rank, this runs on ", ranks());
   const std::vector<SweptKey> keys = read_keys(statements);
   std::vector<Point> points = make_points(study.options(), keys);
   require(!study.has_picture() || drawn_over(keys) < keys.size(),
           "option --plot: no key of the sweep has two numbers to draw results over");
   Watch watch("sweep");
   run_points(points, places(wanted), watch.monitor());
   const std::size_t asked = points.size();
   points.erase(std::remove_if(points.begin(), points.end(),
                               [](const Point &point) { return !point.ran; }),
                points.end());
   const auto refused = [](const Point &point) { return point.status == "refused"; };
   require(points.empty() || !std::all_of(points.begin(), points.end(), refused),
           "every point of the sweep is refused, the first one: ",
           points.empty() ? "" : points[0].message);

   const std::vector<std::string> names =
      wanted.empty() ? single_numbers(points, keys) : places(wanted);
   const auto is_there = [&](const std::string &name)
   {
      const auto has = [&](const Point &point)
      { return !result(point.results, name).is_null(); };
      return points.empty() || std::any_of(points.begin(), points.end(), has);
   };
   // Of points that end early nothing is known of what they would have had.
   const bool ended_well = std::any_of(points.begin(), points.end(),
                                       [](const Point &point) { return point.ended_well; });
   require(!ended_well || names.empty() || std::any_of(names.begin(), names.end(), is_there),
           "option --sweep-results: no point has a number or a word of the name ",
           names.empty() ? "" : told("'", names[0], "'"), ", must be one of ",
           listed(single_numbers(points, keys)),
           ", or a place as levels.0.slip, with blanks in quotes");
   for (const std::string &name : names)
   {
      if (is_there(name)) { continue; }
      // What was computed stays, and the others that were asked for.
      study.code = 2;
      study.results["message"] = "option --sweep-results: no point has a number or a word of "
                                 "the name '" +
                                 name + "', must be one of " +
                                 listed(single_numbers(points, keys)) +
                                 ", or a place as levels.0.slip, with blanks in quotes";
      study.say("\n" + study.results["message"].get<std::string>());
   }
   std::vector<Column> columns;
   for (const SweptKey &key : keys) { columns.push_back({key.name, key.name, "%g"}); }
   constexpr std::size_t most = 9; // on the screen and in the figure
   std::vector<std::string> shown;
   for (const std::string &name : names)
   {
      const bool show =
         shown.size() < most && (!wanted.empty() || (!points.empty() && varies(points, name)));
      if (show) { shown.push_back(name); }
      columns.push_back({name, show ? name : "", "%.5g"});
   }
   columns.push_back({"status", "status"});
   const bool events =
      std::any_of(points.begin(), points.end(),
                  [](const Point &point) { return point.results.contains("event_loads"); });
   if (events)
   {
      columns.push_back({"event_time"});
      columns.push_back({"", "at"});
   }
   columns.push_back({"message"});
   ResultTable &table = study.table("sweep", columns);
   long converged = 0;
   std::set<std::string> refusals;
   for (const Point &point : points)
   {
      std::vector<ordered_json> row;
      for (const std::string &value : point.values) { row.push_back(as_number(value)); }
      for (const std::string &name : names) { row.push_back(result(point.results, name)); }
      row.push_back(point.status);
      ordered_json more;
      if (events)
      {
         const ordered_json &of = point.results;
         const bool ended = of.contains("event_loads");
         row.push_back(ended ? of["event_time"] : ordered_json());
         row.push_back(ended ? event_text(of["event_time"], of["event_loads"]) : "");
         if (ended) { more["event_loads"] = of["event_loads"]; }
      }
      row.push_back(point.message);
      study.row(table, row, {}, more);
      if (point.status == "refused") { refusals.insert(point.message); }
      converged += point.ended_well ? 1 : 0;
      for (const auto &warning : point.results.value("warnings", ordered_json::array()))
      {
         warn(warning.get<std::string>());
      }
      cattaneo::Counters counters;
      const ordered_json spent = point.results.value("counters", ordered_json::object());
      cattaneo::Counters::for_each(counters, [&](const char *name, long &value)
                                   { value = spent.value(name, 0L); });
      study.counters += counters;
   }
   for (const std::string &message : refusals) { study.say("refused: " + message); }
   if (shown.size() < names.size())
   {
      study.say(text("%zu more results, which do not vary or are too many, are in --json and "
                     "--csv alone; --sweep-results names those to be shown",
                     names.size() - shown.size()));
   }
   // Where none varies, the first of them that are asked for or found.
   if (shown.empty() && !names.empty()) { shown.push_back(names.front()); }
   draw(study, keys, points, shown);
   study.results["points"] = points.size();
   if (study.code == 2) { study.results["status"] = "ended early"; }
   if (converged == static_cast<long>(asked)) { return; }
   study.code = 2;
   study.results["status"] = points.size() < asked ? "stopped" : "ended early";
   study.results["message"] = text("%ld of %zu points converged", converged, asked);
   study.say("\n" + study.results["message"].get<std::string>());
}

} // namespace miniapp
