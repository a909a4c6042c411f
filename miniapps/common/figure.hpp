#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/readout/zones.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// As much of a march as a picture can show, whatever its length.
constexpr std::size_t most_drawn = 4096;

/** Data of one panel of a figure, in two forms. In JSON it has its words (kind, title, x, y, …)
    and `parts`, each of which has its words (a curve has series and style) and a list of
   numbers for each column. The CSV file has the words as comment lines ("# kind: lines") and a
   tidy table: one row a point (series, style, x, y), a zone (time, state, from, to), a ring
   (its state, from, to) or arrow (rate or total, radius, angle) of a plan, or a point of a
   field (series, x, y, value). The package cattaneo_show draws it. */
class Panel
{
public:
   enum class Kind
   {
      lines, ///< curves of y over x
      zones, ///< states along the contact (y) against time or load (x)
      plan,  ///< a surface of revolution from above: rings in their states, arrows of slip
      field, ///< a value over x and y
      scene  ///< bodies with their supports and loads
   };
   Panel(Kind kind, const std::string &name, const std::string &title,
         const std::string &x_label, const std::string &y_label);

   /// A curve; `style` is line, dashed (closed forms, comparisons), points, band (limits, one
   /// curve above and one below), or thesis (the thesis' values, marked). Values that are not
   /// finite leave a gap.
   void add(const std::string &series, const Eigen::VectorXd &x, const Eigen::VectorXd &y,
            const std::string &style = "line");
   void add(const std::string &series, const std::vector<double> &x,
            const std::vector<double> &y, const std::string &style = "line");
   /// The next point of a curve.
   void point(const std::string &series, double x, double y, const std::string &style = "line");
   /// Pressure, and dashed shear over friction (if there is any), of `count` nodes from
   /// `first` on.
   void add_tractions(const std::string &label, const Eigen::VectorXd &x,
                      const cattaneo::ReducedProblem &problem,
                      const cattaneo::ContactState &state, Eigen::Index first = 0,
                      Eigen::Index count = -1);
   /// The zones of one state at a time; `coordinate` maps arc length to what is shown.
   void add(
      double time, const std::vector<cattaneo::Zone> &zones,
      const std::function<double(double)> &coordinate = [](double s) { return s; });
   void zone(double time, const std::string &state, double from, double to);
   /// A value of the thesis on a zone diagram.
   void mark(double time, double coordinate);
   /// Rings of a plan; positions are radii.
   void add(const std::vector<cattaneo::Zone> &rings);
   /// An arrow of a plan, shown all around: "rate" (of slip) or "total" (slip), at a radius, by
   /// its angle from the radial direction, radians.
   void arrow(const std::string &kind, double radius, double angle);
   /// An item of a scene: an edge of a body, an arrow, or a mark (without extent), by its kind.
   void item(const std::string &item, const Eigen::Vector2d &from,
             const Eigen::Vector2d &extent);
   /// A value of a field.
   void add(const std::string &series, double x, double y, double value);

   /// A word of the figure alone: "limits x", "0,1" (a side that is empty is left to the data);
   /// "reversed", "x"; "scale", "loglog" or "semilogx" or "semilogy"; "shade", "0,1,slip zone",
   /// which may be said several times.
   void say(const std::string &key, const std::string &word);
   void limit(const char *axis, double lo, double hi);

   const std::string &name() const { return name_; }
   bool empty() const;
   std::string csv() const; ///< nothing without points
   /// Its name, its words and its parts.
   nlohmann::ordered_json json() const;

private:
   void row(const std::vector<std::string> &words, const std::vector<double> &numbers);
   std::string name_;
   Kind kind_;
   nlohmann::ordered_json words_;
   std::vector<nlohmann::ordered_json> parts_;
};

/// Words of a panel as comment lines of its CSV file.
std::string comments(const nlohmann::ordered_json &words);

/// Adds a word to those of a panel; a key that has one already then has a list of them.
void add_word(nlohmann::ordered_json &words, const std::string &key, const std::string &word);

/// A CSV file, and what is drawn of it (null: nothing).
struct Sheet
{
   std::string name, csv;
   nlohmann::ordered_json panel;
};

/// Writes PREFIX_<sheet>.csv for every sheet; nothing for an empty prefix. InputError if there
/// is no sheet or a file cannot be written.
void write_csv(const std::vector<Sheet> &sheets, const std::string &prefix);

/// Makes a file for others to read or overwrite, among those that are temporary.
std::string temporary_file(const std::string &name, const std::string &text);

/** Has the package cattaneo_show make a picture or a page ("--plot", "--html") of a run that
   was written as JSON. InputError if it cannot, which says how it is made later; the JSON
   stays.
    @param passing whether the JSON is written for this alone, and goes with success */
void show(const std::string &run, bool passing, const std::string &option,
          const std::string &file);

/// What cattaneo_show answers to a question about references (compare.py); null if there is no
/// Python. InputError if it cannot answer.
nlohmann::ordered_json ask_reader(const nlohmann::ordered_json &question);

/// Becomes cattaneo_show with these words: returns only if there is no Python, with nothing
/// changed.
void become_reader(const std::vector<std::string> &words);

/// Draws panels that belong to no study, those of a benchmark. Nothing for an empty name.
void draw(const std::vector<Sheet> &sheets, const std::string &picture);

} // namespace miniapp
