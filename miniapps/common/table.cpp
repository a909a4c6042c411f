#include "common/table.hpp"

#include "common/figure.hpp"
#include "common/text.hpp"
#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace miniapp
{

using nlohmann::ordered_json;

namespace
{

std::size_t width(const Column &column)
{
   return std::max<std::size_t>(10, characters(column.heading)) + 2;
}

/// As it is printed.
std::string cell(const ordered_json &value, const Column &column)
{
   if (value.is_string()) { return value.get<std::string>(); }
   if (value.is_array())
   {
      std::string zones;
      for (const ordered_json &zone : value)
      {
         zones += zone["state"].get<std::string>() + text(" %.3f  ", zone["to"].get<double>());
      }
      return zones;
   }
   if (value.is_boolean()) { return value.get<bool>() ? "yes" : "no"; }
   if (value.is_number_integer()) { return std::to_string(value.get<long>()); }
   if (!value.is_number() || !std::isfinite(value.get<double>())) { return "-"; }
   return text(column.format.c_str(), value.get<double>());
}

/// The table whose headings were printed last.
const ResultTable *&on_screen()
{
   static const ResultTable *table = nullptr;
   return table;
}

} // namespace

ordered_json parsed(const std::string &text, bool comments)
{
   return ordered_json::parse(text, nullptr, true, comments);
}

double settled(double sum, double size)
{
   return std::abs(sum) < 1e-12 * size ? 0 : sum;
}

ResultTable::ResultTable(const std::string &name, const std::vector<Column> &columns)
   : name_(name), columns_(columns)
{
}

void ResultTable::print_headings()
{
   if (on_screen() == this) { return; }
   on_screen() = this;
   std::string line;
   for (const Column &column : columns_)
   {
      if (!column.heading.empty()) { line += "  " + right(column.heading, width(column) - 2); }
   }
   if (line.empty()) { return; }
   ProgressLine::clear();
   std::printf("\n%s\n", line.c_str());
}

const ordered_json &ResultTable::row(const std::vector<ordered_json> &values,
                                     const ordered_json &more)
{
   cattaneo::require(values.size() == columns_.size(), "table ", name_, ": a row has ",
                     values.size(), " values for ", columns_.size(), " columns");
   if (!quiet_) { print_headings(); }
   ordered_json row;
   std::string line;
   std::vector<std::string> &cells = printed_.emplace_back();
   for (std::size_t k = 0; k < values.size(); ++k)
   {
      const Column &column = columns_[k];
      if (!column.key.empty()) { row[column.key] = values[k]; }
      if (!column.heading.empty())
      {
         cells.push_back(cell(values[k], column));
         line += "  " + right(cells.back(), width(column) - 2);
      }
   }
   if (!quiet_)
   {
      ProgressLine::clear();
      if (!line.empty()) { std::printf("%s\n", line.c_str()); }
      std::fflush(stdout);
   }
   if (!more.is_null()) { row.update(more); }
   rows_.push_back(row);
   return rows_.back();
}

ResultTable &ResultTable::draw(const std::string &title, const std::string &x,
                               const std::string &x_label, const std::vector<Curve> &y,
                               const std::string &y_label, const Curve &by)
{
   words_ = {{"kind", "table"}, {"title", title}, {"x", x_label}, {"y", y_label}, {"over", x}};
   for (const Curve &curve : y) { add_word(words_, "curve", curve.key + "=" + curve.word); }
   if (!by.key.empty()) { words_["by"] = by.key + "=" + by.word; }
   return *this;
}

ResultTable &ResultTable::mark(double x, double y)
{
   add_word(words_, "mark", text("%g,%g", x, y));
   return *this;
}

ResultTable &ResultTable::shade(double from, double to, const std::string &word)
{
   add_word(words_, "shade", text("%g,%g,", from, to) + word);
   return *this;
}

ordered_json ResultTable::printed() const
{
   ordered_json head = ordered_json::array();
   for (const Column &column : columns_)
   {
      if (!column.heading.empty()) { head.push_back(column.heading); }
   }
   return {{"name", name_}, {"head", head}, {"rows", printed_}};
}

ordered_json ResultTable::panel() const
{
   if (words_.is_null() || rows_.empty()) { return nullptr; }
   ordered_json panel = {{"name", name_}};
   panel.update(words_);
   return panel;
}

std::vector<std::string> ResultTable::keys() const
{
   std::vector<std::string> keys;
   for (const Column &column : columns_)
   {
      if (!column.key.empty()) { keys.push_back(column.key); }
   }
   return keys;
}

std::vector<ordered_json> ResultTable::values(const ordered_json &row) const
{
   std::vector<ordered_json> result;
   for (const Column &column : columns_)
   {
      result.push_back(row.contains(column.key) ? row[column.key] : ordered_json());
   }
   return result;
}

namespace
{

std::vector<std::string> csv_cells(const std::string &line)
{
   std::vector<std::string> cells(1);
   bool quoted = false;
   for (std::size_t k = 0; k < line.size(); ++k)
   {
      const bool quote = line[k] == '"', twice = quoted && line.compare(k, 2, "\"\"") == 0;
      if (twice) { cells.back() += line[k++]; }
      else if (quote) { quoted = !quoted; }
      else if (line[k] == ',' && !quoted) { cells.emplace_back(); }
      else { cells.back() += line[k]; }
   }
   return cells;
}

} // namespace

std::vector<ordered_json> read_rows(const std::string &file)
{
   std::vector<ordered_json> rows;
   std::vector<std::string> keys;
   std::ifstream in(file);
   for (std::string line; std::getline(in, line);)
   {
      if (line[0] == '#') { continue; }
      const std::vector<std::string> cells = csv_cells(line);
      if (keys.empty())
      {
         keys = cells;
         continue;
      }
      ordered_json &row = rows.emplace_back();
      for (std::size_t k = 0; k < std::min(keys.size(), cells.size()); ++k)
      {
         const ordered_json number = ordered_json::parse(cells[k], nullptr, false);
         row[keys[k]] = cells[k].empty()     ? ordered_json()
                        : number.is_number() ? number
                                             : ordered_json(cells[k]);
      }
   }
   return rows;
}

} // namespace miniapp
