#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// Parses a JSON text, in which C++ comments may be allowed; the library's own error if it is
/// not JSON. Compiled once, because a parser takes long to compile.
nlohmann::ordered_json parsed(const std::string &text, bool comments = false);

/// A sum, or 0 if it is round-off of parts of this size.
double settled(double sum, double size);

/// A column of a table: its key in JSON and CSV, its heading on the screen, and the format of
/// its numbers there. Without a heading it is not printed; without a key it is only printed.
struct Column
{
   std::string key, heading = "", format = "%.4f";
};

/** Rows that are stated once. They are printed, aligned, as they come. In JSON they are a list
    of objects with the columns' keys, of which cattaneo_show makes a CSV file and, if
    requested, a panel of the figure. */
class ResultTable
{
public:
   ResultTable(const std::string &name, const std::vector<Column> &columns);

   /// Values in the order of the columns: numbers (not finite: "-", null in JSON), words, zones
   /// (to_json()), or anything else, which is not printed. `more` goes only to JSON.
   const nlohmann::ordered_json &row(const std::vector<nlohmann::ordered_json> &values,
                                     const nlohmann::ordered_json &more = {});
   /// Are the following rows left out on the screen? All other outputs have them.
   void quiet(bool yes) { quiet_ = yes; }
   /// Prints the headings, unless they were printed last.
   void print_headings();

   /** Draws columns over another one: `label`s of the axes, one curve for each of `y` (its key
       and a word for it) and each value of the column `by` (whose own word is put before the
       value); without it one curve each. */
   struct Curve
   {
      std::string key, word;
   };
   ResultTable &draw(const std::string &title, const std::string &x, const std::string &x_label,
                     const std::vector<Curve> &y, const std::string &y_label,
                     const Curve &by = {});
   /// Marks values of the thesis in the figure.
   ResultTable &mark(double x, double y);
   /// Shades a stretch of x, with a word in it.
   ResultTable &shade(double from, double to, const std::string &word);
   /// The description of its panel, whose data are the rows in the results; null if it is not
   /// drawn.
   nlohmann::ordered_json panel() const;

   const std::string &name() const { return name_; }
   const nlohmann::ordered_json &json() const { return rows_; }
   std::vector<std::string> keys() const; ///< of its columns
   /// Adds a row of read_rows(), in the order of the columns.
   std::vector<nlohmann::ordered_json> values(const nlohmann::ordered_json &row) const;
   /// Its headings and rows as they are printed.
   nlohmann::ordered_json printed() const;

private:
   std::string name_;
   nlohmann::ordered_json words_; ///< of its panel
   std::vector<Column> columns_;
   nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
   std::vector<std::vector<std::string>> printed_;
   bool quiet_ = false;
};

/// Rows of a CSV file of a table, by the keys of its columns; none without the file.
std::vector<nlohmann::ordered_json> read_rows(const std::string &file);

} // namespace miniapp
