#include "common/study.hpp"

#include "common/check.hpp"
#include "common/run.hpp"
#include "common/shipped.hpp"
#include "common/sweep.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/output/streamed_file.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace miniapp
{

using nlohmann::ordered_json;
namespace fs = std::filesystem;

Study::Study(const std::string &name, int argc, char *argv[])
   : options_("miniapps/" + name + ".cpp", argc, argv), name_(name)
{
   const std::string file = shipped("miniapps/data/references.json");
   if (!fs::exists(file))
   {
      warn("nothing is compared with references: file '" + file + "' cannot be read");
      return;
   }
   references_ = cattaneo::read_whole(file);
   const bool has_study = references_.find("\"study\": \"" + name + '"') != std::string::npos;
   if (!has_study) { references_.clear(); }
}

void Study::parse()
{
   options_.group("Results, and how they are shown");
   option(&json_, "json", "File for the results.", Text::output);
   option(&csv_, "csv", "Prefix of CSV files of tables and figures.", Text::prefix);
   option(&plot_, "plot", "Picture of the results (png, pdf, svg).", Text::picture);
   option(&html_, "html",
          "File for a page (HTML) of the run, with a slider over its increments.", Text::page);
   option(&check_, "check",
          "Show bodies, contact, supports and loads in tables (and with --plot in a picture), "
          "and compute nothing.");
   options_.leave_out_of_cases("check");
   option(&verbose_, "verbose",
          "Print all: every option, all rows of long tables, how often each expensive step was "
          "done, and the kernels of OpenBLAS.");
   options_.leave_out_of_cases("verbose");
   option(
      &save_, "save",
      "File for the reduced problem (read by --reduced of march, shakedown, wear and design).",
      Text::output);
   options_.group("Many runs");
   option(&sweep_, "sweep",
          "One run for each value of an option, as 'friction=0.2 0.5' or 'order=1:4:4' "
          "(from:to:count). Several places may share a value, as history.2.Q,-history.3.Q=0.1 "
          "0.2 (a place with a minus sign gets the opposite value). Several --sweep, or "
          "semicolons, make all combinations.",
          Text::statements);
   option(&sweep_results_, "sweep-results",
          "Results in the table of a sweep, by their names in --json (dissipation.0 "
          "\"cycles.0.work Q\"); default: all results that are one number.");
   if (ranks() > 1)
   {
      options_.group("Several ranks");
      option(&condensation().direct_dofs, "direct-dofs",
             "Bodies with more dofs are distributed and condensed by iterations, smaller ones "
             "are factored by each rank.");
      option(&condensation().max_iterations, "max-iterations",
             "Largest number of iterations for a right-hand side.");
   }
   options_.parse();
   // Those of a history. Another program's option of this name is its own.
   if (const std::string amplitudes = options_.text("amplitudes");
       !amplitudes.empty() && !options_.text("amplitude").empty())
   {
      // "0.2 … 1" means nine values in equal steps.
      std::string values = amplitudes;
      for (const char *const dots : {"…", "..."})
      {
         const std::size_t at = values.find(dots);
         if (at == std::string::npos) { continue; }
         const std::vector<std::string> ends = {
            listed(split(values.substr(0, at), " "), " "),
            listed(split(values.substr(at + std::strlen(dots)), " "), " ")};
         values = ends[0] + ":" + ends[1] + ":9";
         break;
      }
      sweep_ += (sweep_.empty() ? "amplitude=" : "; amplitude=") + values;
   }
   const bool sweeps = sweep_ != "none" && !sweep_.empty();
   // A single run of a sweep has no sweep itself, but its case file may still name the results
   // that the sweep shows.
   options_.only_if(options_.says("sweep"), {"sweep-results"}, "goes with --sweep");
   cattaneo::require(!check_ || save_.empty(),
                     "option --save cannot be used with --check, which computes nothing");
   if (!sweeps) { return; }
   cattaneo::require(!check_, "option --check checks one run, it cannot be used with --sweep");
   run_sweep(*this, name_, sweep_);
}

void Study::reduced(const Scene &scene)
{
   condensed(scene);
   save(scene.reduction.problem);
}

void Study::condensed(const Scene &scene)
{
   checked_ = check_ && !scene.bodies.empty();
   counters += scene.reduction.counters;
   condensed(scene.reduction.problem, scene.dofs);
   if (!check_) { return; }
   results["status"] = "checked";
   show(*this, scene);
   throw Done();
}

void Study::condensed(const cattaneo::ReducedProblem &problem, int dofs)
{
   nodes_ = problem.nodes();
   seconds_ = watch.seconds();
   const auto left = static_cast<long>(problem.K.rows());
   dofs_ = dofs > 0 ? dofs : static_cast<int>(left);
   cattaneo::require(!check_ || checked_, "option --check: this run has no meshes to show");
   if (dofs > 0) { say(text("Condensed %d dofs to %ld in %.3g s", dofs, left, seconds_)); }
   else
   {
      std::vector<std::string> loads;
      for (const cattaneo::LoadPattern &pattern : problem.patterns)
      {
         loads.push_back(pattern.name);
      }
      say(text("A reduced problem of %ld contact nodes, %ld dofs, with the loads ",
               static_cast<long>(nodes_), left) +
          listed(loads));
   }
   if (!ProgressLine::interrupted() || check_) { return; }
   results["status"] = "stopped";
   results["message"] = "stopped before the first load";
   say("Stopped before the first load");
   throw Outcome();
}

void Study::begins(const std::string &path, bool goes_on)
{
   // Devices, pipes and links are not removed.
   const auto type = fs::symlink_status(path).type();
   const bool ours =
      type == fs::file_type::not_found ||
      (!goes_on && (type == fs::file_type::regular || type == fs::file_type::directory));
   if (writes() && ours) { begun_.paths.push_back(path); }
}

Study::Begun::~Begun()
{
   std::error_code none;
   for (const std::string &path : paths) { fs::remove_all(path, none); }
}

void Study::save(const cattaneo::ReducedProblem &problem)
{
   if (save_.empty()) { return; }
   saved_ = true;
   if (writes()) { cattaneo::save(problem, save_); }
}

std::vector<ordered_json> Study::rows_before(const std::string &table) const
{
   std::vector<ordered_json> rows;
   if (csv_.empty() || cycles_before_ == 0) { return rows; }
   for (const ordered_json &row : read_rows(csv_ + "_" + table + ".csv"))
   {
      const bool counted = row.contains("cycle") && row["cycle"].is_number();
      if (counted && row["cycle"] >= 1 && row["cycle"] <= cycles_before_)
      {
         rows.push_back(row);
      }
   }
   return rows;
}

std::string Study::history_file()
{
   if (csv_.empty() || !writes()) { return ""; }
   const std::string more = histories_++ > 0 ? "_" + std::to_string(histories_) : "";
   return csv_ + "_history" + more + ".csv";
}

void Study::write_frames(const std::string &folder, Scene &scene,
                         const std::vector<cattaneo::ContactState> &states)
{
   counters -= scene.reduction.counters; // the cost of the frames is added
   cattaneo::ReductionFields fields = scene.fields(folder);
   for (const cattaneo::ContactState &state : states) { fields.write(state); }
   counters += scene.reduction.counters;
   say(text("%zu frames in %s", states.size(), folder.c_str()));
}

void Study::title(const std::string &text)
{
   ProgressLine::clear();
   std::printf("\n%s\n", text.c_str());
}

void Study::say(const std::string &line)
{
   ProgressLine::clear();
   std::printf("%s\n", line.c_str());
   std::fflush(stdout);
}

void Study::value(const std::string &key, double x, const std::string &label, double error,
                  const std::string &unit)
{
   if (!key.empty()) { results[key] = x; }
   if (!key.empty() && !std::isnan(error)) { results[key + "_error_estimate"] = error; }
   if (is_compared(key))
   {
      found_.push_back({{"key", key}, {"computed", x}, {"error", error}, {"row", nullptr}});
   }
   if (label.empty()) { return; }
   std::string line =
      "   " + padded(label, 40) + " " + (std::isfinite(x) ? text("%.6g", x) : "-");
   values_.push_back({{"key", key}, {"label", label}, {"value", x}, {"unit", unit}});
   if (error > 0)
   {
      line += " ± " + error_text(error) + " (estimate)";
      values_.back()["error_estimate"] = error_text(error);
   }
   say(line + (unit.empty() ? "" : " " + unit));
}

ResultTable &Study::table(const std::string &name, const std::vector<Column> &columns)
{
   for (ResultTable &table : tables_)
   {
      if (table.name() == name) { return table; }
   }
   const ResultTable &made = tables_.emplace_back(name, columns);
   drawn_.push_back([&made] { return made.panel(); });
   return tables_.back();
}

void Study::list(const std::string &name, const ordered_json &rows)
{
   if (!rows.empty()) { lists_.push_back({{"name", name}, {"rows", rows}}); }
}

void Study::row(ResultTable &table, const std::vector<ordered_json> &values,
                const std::vector<std::pair<std::string, double>> &errors,
                const ordered_json &more)
{
   const ordered_json &row = table.row(values, more);
   for (const auto &[column, x] : row.items())
   {
      const std::string key = table.name() + "/" + column;
      if (!x.is_number() || !is_compared(key)) { continue; }
      double error = none;
      for (const auto &[of, its] : errors)
      {
         if (of == column) { error = its; }
      }
      found_.push_back({{"key", key}, {"computed", x}, {"error", error}, {"row", row}});
   }
}

Panel &Study::panel(Panel::Kind kind, const std::string &name, const std::string &title,
                    const std::string &x_label, const std::string &y_label)
{
   const Panel &made = panels_.emplace_back(kind, name, title, x_label, y_label);
   drawn_.push_back([&made] { return made.empty() ? ordered_json() : made.json(); });
   return panels_.back();
}

Film *Study::film(const cattaneo::ReducedProblem &problem)
{
   constexpr std::size_t most = 12;
   if (html_.empty() || !writes()) { return nullptr; }
   if (films_.size() == most)
   {
      ++more_films_;
      return nullptr;
   }
   return &films_.emplace_back(std::to_string(films_.size() + 1), problem, units);
}

void Study::compare(const std::string &name, double exact, Allowed allowed, double computed)
{
   closed_.push_back({{"name", name},
                      {"value", exact},
                      {"spread", allowed.spread},
                      {"mesh", allowed.mesh},
                      {"computed", computed}});
}

bool Study::is_compared(const std::string &key)
{
   // A text of 60 kB is searched once for each key. The package that reads it understands its
   // entries.
   const auto [known, is_new] = compared_.try_emplace(key, false);
   if (is_new) { known->second = references_.find('"' + key + '"') != std::string::npos; }
   return known->second;
}

void Study::compare_references()
{
   results["references"] = ordered_json::array();
   if ((found_.empty() && closed_.empty()) || !writes()) { return; }
   ordered_json values = options_.values();
   for (const auto &[key, x] : results.items())
   {
      if (x.is_primitive()) { values[key] = x; }
   }
   const ordered_json answer = ask_reader(
      {{"study", name_}, {"values", values}, {"found", found_}, {"closed", closed_}});
   if (answer.is_null())
   {
      say("nothing is compared with references: that needs Python 3 (Debian: python3)");
      return;
   }
   std::size_t width = 8;
   for (const ordered_json &one : answer["rows"])
   {
      width = std::max(width, characters(one["name"]));
   }
   if (answer["rows"].empty()) { return; }
   ResultTable &all = table("references", {{"quantity"},
                                           {"", padded("quantity", width)},
                                           {"reference", "reference", "%.5g"},
                                           {"spread", "its ± (estimate)", "%.2g"},
                                           {"mesh", "mesh ± (estimate)", "%.2g"},
                                           {"thesis", "thesis prints", "%.4g"},
                                           {"computed", "computed", "%.5g"},
                                           {"", "difference", "%+.2g"},
                                           {"verdict", "compared with the ±"},
                                           {"tolerance"},
                                           {"outside"}});
   const auto number = [](const ordered_json &x)
   { return x.is_null() ? none : x.get<double>(); };
   for (const ordered_json &one : answer["rows"])
   {
      const double value = number(one["value"]), computed = number(one["computed"]);
      row(all, {one["name"], padded(one["name"], width), value, number(one["spread"]),
                one["mesh"], number(one["thesis"]), computed, computed - value, one["verdict"],
                number(one["tolerance"]), one["outside"]});
   }
   for (const std::string line : answer["notes"])
   {
      std::printf("%s", wrapped(line, 2).c_str());
   }
}

void Study::finish()
{
   cattaneo::require(!check_ || checked_, "option --check: this run has no meshes to show");
   cattaneo::require(save_.empty() || saved_ || code != 0,
                     "option --save: this run has no reduced problem to save");
   begun_.paths.clear();
   compare_references();
   for (const ResultTable &table : tables_) { results[table.name()] = table.json(); }
   if (!results.contains("status")) { results["status"] = "converged"; }
   if (nodes_ > 0)
   {
      if (!results.contains("contact_nodes")) { results["contact_nodes"] = nodes_; }
      results["dofs"] = dofs_;
      results["seconds_condensation"] = seconds_;
   }
   results["seconds"] = watch.seconds();
   results["counters"] = to_json(counters);
   const cattaneo::BlasKernels kernels = cattaneo::blas_kernels();
   results["blas_kernels"] = kernels.name;
   if (verbose_) { say_more(kernels); }
   // The results are written before pictures of them.
   ordered_json run = results;
   run["shown"] = shown();
   write_long_frames(run["shown"]["marches"]);
   write_json(run, json_);
   show_results(run);
}

void Study::write_long_frames(ordered_json &marches) const
{
   constexpr std::size_t most = 1 << 20;
   if (json_.empty() || marches.empty() || !writes()) { return; }
   const std::string text = marches.dump();
   if (text.size() <= most) { return; }
   const std::string file = json_ + ".frames";
   cattaneo::write_whole(file, text);
   marches = fs::path(file).filename().string();
}

void Study::say_more(const cattaneo::BlasKernels &kernels)
{
   title(text("What it took, %.3g s", results["seconds"].get<double>()));
   cattaneo::Counters::for_each(counters,
                                [&](std::string counter, long times)
                                {
                                   std::replace(counter.begin(), counter.end(), '_', ' ');
                                   if (times > 0)
                                   {
                                      say("   " + padded(counter, 40) + " " +
                                          std::to_string(times));
                                   }
                                });
   say("   " + kernels.statement());
}

ordered_json Study::shown() const
{
   ordered_json panels = ordered_json::array(), tables = ordered_json::array(), csv = lists_,
                marches = ordered_json::array();
   for (const auto &drawn : drawn_)
   {
      ordered_json panel = drawn();
      if (!panel.is_null()) { panels.push_back(std::move(panel)); }
   }
   for (const ResultTable &table : tables_)
   {
      if (table.json().empty()) { continue; }
      const std::vector<std::string> keys = table.keys();
      if (!keys.empty()) { csv.push_back({{"name", table.name()}, {"columns", keys}}); }
      const ordered_json printed = table.printed();
      if (!printed["head"].empty() && !printed["rows"].empty()) { tables.push_back(printed); }
   }
   for (const Film &film : films_)
   {
      if (!film.empty()) { marches.push_back(film.json()); }
   }
   // What was typed, without the files that are written.
   ordered_json given = ordered_json::object();
   for (const auto &[option, value] : options_.values().items())
   {
      const bool file = option == "json" || option == "csv" || option == "plot" ||
                        option == "html" || option == "save" || option == "save-state";
      if (options_.says(option) && !file) { given[option] = value; }
   }
   return {
      {"study", name_},
      {"given", given},
      {"event", results.contains("event_loads")
                   ? event_text(results["event_time"], results["event_loads"])
                   : ""},
      {"units",
       {{"length", units.of(0, 1)}, {"pressure", units.of(1, -2)}, {"energy", units.total(1)}}},
      {"options", options_.values()},
      {"lead", lead},
      {"values", values_},
      {"tables", tables},
      {"csv", csv},
      {"panels", panels},
      {"marches", marches},
      {"more_marches", more_films_},
      {"sketch", sketch}};
}

void Study::show_results(const ordered_json &run) const
{
   const ordered_json &shown = run["shown"];
   // A study without an equilibrium may end before there is anything to draw.
   const bool drawn = !shown["panels"].empty(), tables = drawn || !shown["csv"].empty();
   cattaneo::require(drawn || code != 0 || plot_.empty(),
                     "option --plot: this run has nothing to draw");
   cattaneo::require(tables || code != 0 || csv_.empty(),
                     "option --csv: this run has no tables");
   if (has_picture() && !drawn)
   {
      std::printf("no picture: the study ended before there was anything to draw\n");
   }
   std::vector<std::pair<std::string, std::string>> wanted;
   if (!csv_.empty() && tables) { wanted.emplace_back("--csv", csv_); }
   if (!html_.empty()) { wanted.emplace_back("--html", html_); }
   if (has_picture() && drawn) { wanted.emplace_back("--plot", plot_); }
   if (wanted.empty()) { return; }
   const auto &[option, name] = wanted.back();
   const bool passing = json_.empty();
   const std::string file = !passing            ? json_
                            : option == "--csv" ? name + ".csv.json"
                                                : name + ".json";
   if (passing) { write_json(run, file); }
   show(file, passing, wanted);
}

int Study::run(const std::string &name, int argc, char *argv[],
               const std::function<void(Study &)> &body)
{
   return miniapp::run(
      [&]
      {
         const ProgressLine progress(name.c_str());
         Study study(name, argc, argv);
         try
         {
            body(study);
         }
         catch (const Done &)
         {
         }
         catch (const Outcome &)
         {
            study.code = 2;
         }
         catch (const cattaneo::WriteError &)
         {
            study.begun_.paths.clear(); // they may have taken hours
            throw;
         }
         study.finish();
         return study.code;
      });
}

} // namespace miniapp
