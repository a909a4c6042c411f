#include "common/figure.hpp"

#include "common/miniapp.hpp"
#include "common/shipped.hpp"
#include "common/table.hpp"
#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sys/wait.h>
#include <unistd.h>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace
{

/// For the shell.
std::string argument(const std::string &text)
{
   std::string result = "'";
   for (char c : text) { result += c == '\'' ? std::string("'\\''") : std::string(1, c); }
   return result + "'";
}

bool has_python()
{
   return std::system("command -v python3 >/dev/null") == 0;
}

VectorXd vector(const std::vector<double> &values)
{
   return Eigen::Map<const VectorXd>(values.data(), values.size());
}

} // namespace

Panel::Panel(Kind kind, const std::string &name, const std::string &title,
             const std::string &x_label, const std::string &y_label)
   : name_(name), kind_(kind)
{
   static const char *const kinds[] = {"lines", "zones", "plan", "field", "scene", "map"};
   words_ = {{"kind", kinds[static_cast<std::size_t>(kind)]},
             {"title", title},
             {"x", x_label},
             {"y", y_label}};
}

namespace
{

/// Columns of a panel's table: words, and numbers.
struct PanelColumns
{
   std::vector<const char *> words, numbers;
};
const PanelColumns &columns_of(Panel::Kind kind)
{
   static const PanelColumns all[] = {
      {{"series", "style"}, {"x", "y"}},
      {{"state"}, {"time", "from", "to"}},
      {{"item"}, {"from", "to"}},
      {{"series"}, {"x", "y", "value"}},
      {{"item"}, {"x", "y", "dx", "dy"}},
      {{"item"}, {"x", "y", "value", "contact", "stick", "dx", "dy"}}};
   return all[static_cast<std::size_t>(kind)];
}

/// Nine digits are enough for a picture and a CSV file.
ordered_json rounded_to_draw(double x)
{
   if (!std::isfinite(x)) { return nullptr; }
   return std::strtod(text("%.9g", x).c_str(), nullptr);
}

} // namespace

void Panel::row(const std::vector<std::string> &words, const std::vector<double> &numbers)
{
   const PanelColumns &columns = columns_of(kind_);
   // Zones at one time lie side by side and have different states: together they are one part.
   const bool in_columns = kind_ == Kind::zones;
   const auto continues = [&](const ordered_json &part)
   {
      if (in_columns) { return true; }
      for (std::size_t k = 0; k < words.size(); ++k)
      {
         if (part[columns.words[k]] != words[k]) { return false; }
      }
      return true;
   };
   if (parts_.empty() || !continues(parts_.back()))
   {
      ordered_json &part = parts_.emplace_back();
      for (std::size_t k = 0; k < words.size(); ++k)
      {
         part[columns.words[k]] = in_columns ? ordered_json::array() : ordered_json(words[k]);
      }
      for (const char *column : columns.numbers) { part[column] = ordered_json::array(); }
   }
   for (std::size_t k = 0; in_columns && k < words.size(); ++k)
   {
      parts_.back()[columns.words[k]].push_back(words[k]);
   }
   for (std::size_t k = 0; k < numbers.size(); ++k)
   {
      parts_.back()[columns.numbers[k]].push_back(rounded_to_draw(numbers[k]));
   }
}

void add_word(ordered_json &words, const std::string &key, const std::string &word)
{
   if (!words.contains(key)) { words[key] = word; }
   else
   {
      if (!words[key].is_array()) { words[key] = ordered_json::array({words[key]}); }
      words[key].push_back(word);
   }
}

void Panel::say(const std::string &key, const std::string &word)
{
   add_word(words_, key, word);
}

bool Panel::empty() const
{
   // A panel with values of the thesis only is not drawn.
   return parts_.empty() ||
          (kind_ == Kind::zones &&
           std::all_of(parts_[0]["state"].begin(), parts_[0]["state"].end(),
                       [](const ordered_json &state) { return state == "thesis"; }));
}

ordered_json Panel::json() const
{
   ordered_json panel = {{"name", name_}};
   panel.update(words_);
   panel["parts"] = parts_;
   return panel;
}

void Panel::add(const std::string &series, const VectorXd &x, const VectorXd &y,
                const std::string &style)
{
   for (Index i = 0; i < x.size(); ++i) { row({series, style}, {x[i], y[i]}); }
}

void Panel::add(const std::string &series, const std::vector<double> &x,
                const std::vector<double> &y, const std::string &style)
{
   add(series, vector(x), vector(y), style);
}

void Panel::point(const std::string &series, double x, double y, const std::string &style)
{
   row({series, style}, {x, y});
}

void Panel::add_tractions(const std::string &label, const VectorXd &x,
                          const ReducedProblem &problem, const ContactState &state, Index first,
                          Index count)
{
   const Index n = problem.nodes();
   if (count < 0) { count = n - first; }
   const VectorXd at = x.segment(first, count);
   add(label, at, tractions(problem, state.p).segment(first, count));
   // A node without friction leaves a gap: 0/0.
   const VectorXd f = problem.friction.segment(first, count);
   if (f.isZero(0)) { return; }
   const VectorXd q = tractions(problem, state.q.head(n)).segment(first, count);
   add("q/f: " + label, at, VectorXd(q.cwiseQuotient(f)), "dashed");
}

void Panel::add(double time, const std::vector<Zone> &zones,
                const std::function<double(double)> &coordinate)
{
   for (const Zone &one : zones)
   {
      zone(time, cattaneo::name(one.state), coordinate(one.from.position),
           coordinate(one.to.position));
   }
}

void Panel::zone(double time, const std::string &state, double from, double to)
{
   row({state}, {time, from, to});
}

void Panel::mark(double time, double coordinate)
{
   row({"thesis"}, {time, coordinate, coordinate});
}

void Panel::add(const std::vector<Zone> &rings)
{
   for (const Zone &ring : rings)
   {
      row({cattaneo::name(ring.state)}, {ring.from.position, ring.to.position});
   }
}

void Panel::arrow(const std::string &kind, double radius, double angle)
{
   row({kind}, {radius, angle});
}

void Panel::item(const std::string &item, const Eigen::Vector2d &from,
                 const Eigen::Vector2d &extent)
{
   row({item}, {from[0], from[1], extent[0], extent[1]});
}

void Panel::add(const std::string &series, double x, double y, double value)
{
   row({series}, {x, y, value});
}

void Panel::corner(const Eigen::Vector2d &at, double value, bool contact, bool stick)
{
   row({"corner"}, {at[0], at[1], value, contact ? 1.0 : 0.0, stick ? 1.0 : 0.0, 0, 0});
}

void Panel::arrow(const Eigen::Vector2d &at, const Eigen::Vector2d &extent)
{
   row({"arrow"}, {at[0], at[1], extent.norm(), 0, 0, extent[0], extent[1]});
}

void Panel::limit(const char *axis, double lo, double hi)
{
   const auto bound = [](double x) { return std::isfinite(x) ? text("%.9g", x) : ""; };
   say(std::string("limits ") + axis, bound(lo) + "," + bound(hi));
}

std::string temporary_file(const std::string &name, const std::string &text)
{
   const std::string folder = fs::temp_directory_path().string();
   std::string file = folder + "/" + name + "_XXXXXX";
   const int made = mkstemp(file.data());
   require(made >= 0, "no file can be made in '", folder, "'");
   close(made);
   write_whole(file, text);
   return file;
}

void show(const std::string &run, bool passing,
          const std::vector<std::pair<std::string, std::string>> &wanted)
{
   if (!writes()) { return; }
   const std::string reader =
      "python3 " + argument(shipped("python/cattaneo_show")) + " " + argument(run);
   const auto command = [&](const auto &files)
   {
      std::string words = reader;
      for (const auto &[option, file] : files) { words += " " + option + " " + argument(file); }
      return words;
   };
   std::cout << std::flush;
   // Ctrl-C stops the study. A second one must not leave an incomplete picture.
   const bool python = has_python();
   const int status =
      python ? std::system(("trap '' INT; CATTANEO_PROGRAM=1 " + command(wanted)).c_str()) : -1;
   if (status == 0)
   {
      if (passing) { std::remove(run.c_str()); }
      return;
   }
   constexpr int no_matplotlib = 3; // then all but the picture was made
   const bool but_picture = WIFEXITED(status) && WEXITSTATUS(status) == no_matplotlib;
   std::vector<std::pair<std::string, std::string>> missing;
   std::vector<std::string> said;
   for (const auto &[option, file] : wanted)
   {
      if (but_picture && option != "--plot") { continue; }
      missing.emplace_back(option, file);
      said.push_back("option " + option + ": '" + file + (option == "--csv" ? "_….csv" : "") +
                     "' was not made");
   }
   require(false, listed(said),
           !python       ? ", because it needs Python 3 (Debian: python3)"
           : but_picture ? ", because it needs Python 3 with matplotlib (Debian: "
                           "python3-matplotlib)"
                         : "",
           "; the run is in '", run, "', and this makes it later: ", command(missing));
}

ordered_json ask_reader(const ordered_json &question)
{
   if (!has_python()) { return nullptr; }
   const std::string file = temporary_file("cattaneo_references", question.dump());
   std::cout << std::flush;
   const int code =
      std::system(("trap '' INT; python3 -I -S " +
                   argument(shipped("python/cattaneo_show/compare.py")) + " " + argument(file))
                     .c_str());
   const std::string answer = read_whole(file);
   std::remove(file.c_str());
   require(code == 0, "the values of this run could not be compared with references.json");
   return parsed(answer);
}

void become_reader(const std::vector<std::string> &words)
{
   // Before MPI ends, because without Python the program goes on.
   if (!has_python()) { return; }
   std::vector<std::string> all = {"python3", shipped("python/cattaneo_show")};
   all.insert(all.end(), words.begin(), words.end());
   std::vector<char *> arguments;
   for (std::string &word : all) { arguments.push_back(word.data()); }
   arguments.push_back(nullptr);
   std::cout << std::flush;
   std::fflush(stdout);
#ifdef MFEM_USE_MPI
   mfem::Mpi::Finalize();
#endif
   execvp("python3", arguments.data());
}

void draw(const std::vector<Panel> &panels, const std::string &csv, const std::string &picture)
{
   if ((csv.empty() && picture.empty()) || !writes()) { return; }
   ordered_json all = ordered_json::array();
   for (const Panel &panel : panels) { all.push_back(panel.json()); }
   const std::string run = (picture.empty() ? csv : picture) + ".shown.json";
   write_whole(run, ordered_json{{"shown", {{"panels", all}}}}.dump() + "\n");
   std::vector<std::pair<std::string, std::string>> wanted;
   if (!csv.empty()) { wanted.emplace_back("--csv", csv); }
   if (!picture.empty()) { wanted.emplace_back("--plot", picture); }
   show(run, true, wanted);
}

} // namespace miniapp
