#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// JSON of a text, in which comments of C++ may be allowed, or the library's own error.
/// Compiled once: a parser takes long.
nlohmann::ordered_json parsed(const std::string &text, bool comments = false);

/// A sum without what is round-off of parts of this size.
double settled(double sum, double size);

/// A column of a table: its key in JSON and CSV, what stands above it on the screen, and how a
/// number is written there. Without a heading it is not printed, without a key nothing else.
struct Column
{
   std::string key, heading = "", format = "%.4f";
};

/** Rows that are stated once: printed, aligned, as they come; in JSON a list of objects with
    the columns' keys; a CSV file with one column each; and, if asked for, a panel of the
    figure. */
class ResultTable
{
public:
   ResultTable(const std::string &name, const std::vector<Column> &columns);

   /// Values in the order of the columns: numbers (not finite: "-", null in JSON), words, zones
   /// (to_json()), or whatever else is not printed. `more` goes to JSON alone.
   const nlohmann::ordered_json &row(const std::vector<nlohmann::ordered_json> &values,
                                     const nlohmann::ordered_json &more = {});
   /// Whether the rows that follow are left out on the screen; all else has them.
   void quiet(bool yes) { quiet_ = yes; }
   /// Prints the headings, if they do not stand there.
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
   /// Values of the thesis, marked in the figure.
   ResultTable &mark(double x, double y);
   /// A stretch of x with a word in it.
   ResultTable &shade(double from, double to, const std::string &word);
   /// How it is drawn, whose rows are those of the results of its name; null if it is not.
   nlohmann::ordered_json panel() const;

   const std::string &name() const { return name_; }
   const nlohmann::ordered_json &json() const { return rows_; }
   std::string csv() const; ///< nothing without rows
   /// A row of read_rows() in the order of the columns.
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

/// Of a list of objects: a column for each number and word in them, "k_n.value" of those
/// within, "notes.0" of lists.
std::string csv_of(const nlohmann::ordered_json &rows);

/// Rows of what ResultTable::csv() made, by the keys of its columns; none without the file.
std::vector<nlohmann::ordered_json> read_rows(const std::string &file);

} // namespace miniapp
