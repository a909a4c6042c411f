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

/// Largest number of rows of a march that a picture shows.
constexpr std::size_t most_drawn = 4096;

/** Data of one panel of a figure. In JSON it has its words (kind, title, x, y, …) and `parts`,
    each of which has its words (a curve has series and style) and a list of
   numbers for each column: of the points (series, style, x, y), zones (time, state, from, to),
   rings (state, from, to) and arrows (rate or total, radius, angle) of a plan, points of a
   field (series, x, y, value). The package cattaneo_show draws it, and writes its CSV file. */
class Panel
{
public:
   enum class Kind
   {
      lines, ///< curves of y over x
      zones, ///< states along the contact (y) against time or load (x)
      plan,  ///< a surface of revolution from above: rings in their states, arrows of slip
      field, ///< a field over x and y
      scene, ///< bodies with their supports and loads
      map    ///< a value on triangles of a surface, with arrows and outlines
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
   /// Adds the next point of a curve.
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
   /// Adds a value of the thesis to a zone diagram.
   void mark(double time, double coordinate);
   /// Adds rings to a plan; positions are radii.
   void add(const std::vector<cattaneo::Zone> &rings);
   /// Adds an arrow to a plan, shown at several angles around it: "rate" (of slip) or "total"
   /// (slip), at a radius, by its angle from the radial direction, radians.
   void arrow(const std::string &kind, double radius, double angle);
   /// Adds an item to a scene, by its kind: an edge of a body, an arrow, or a mark (without
   /// extent).
   void item(const std::string &item, const Eigen::Vector2d &from,
             const Eigen::Vector2d &extent);
   /// Adds a value to a field.
   void add(const std::string &series, double x, double y, double value);

   /// Adds a corner of a triangle to a map; three that follow each other are a triangle.
   /// `contact`, `stick`: the state of the node there.
   void corner(const Eigen::Vector2d &at, double value, bool contact, bool stick);
   /// Adds an arrow to a map.
   void arrow(const Eigen::Vector2d &at, const Eigen::Vector2d &extent);

   /// A setting that only the figure uses: "limits x", "0,1" (if a side is empty, the data
   /// decide); "reversed", "x"; "scale", "loglog" or "semilogx" or "semilogy"; "shade",
   /// "0,1,slip zone", which may be given several times.
   void say(const std::string &key, const std::string &word);
   void limit(const char *axis, double lo, double hi);

   const std::string &name() const { return name_; }
   bool empty() const;
   /// Its name, its words and its parts.
   nlohmann::ordered_json json() const;

private:
   void row(const std::vector<std::string> &words, const std::vector<double> &numbers);
   std::string name_;
   Kind kind_;
   nlohmann::ordered_json words_;
   std::vector<nlohmann::ordered_json> parts_;
};

/// Adds a value to the words of a panel. If the key has a value already, it gets a list.
void add_word(nlohmann::ordered_json &words, const std::string &key, const std::string &word);

/// Makes a temporary file that other programs may read or overwrite.
std::string temporary_file(const std::string &name, const std::string &text);

/** Has the package cattaneo_show make files of a run that was written as JSON. InputError if it
    cannot, which says how to make them later; the JSON stays.
    @param passing the JSON was written only for this, and is removed if it succeeds
    @param wanted option and file: --csv (a prefix), --html, --plot */
void show(const std::string &run, bool passing,
          const std::vector<std::pair<std::string, std::string>> &wanted);

/// The answer of cattaneo_show to a question about references (compare.py); null if there is no
/// Python. InputError if it cannot answer.
nlohmann::ordered_json ask_reader(const nlohmann::ordered_json &question);

/// Replaces this program by cattaneo_show with these arguments. Returns only if there is no
/// Python, with nothing changed.
void become_reader(const std::vector<std::string> &words);

/// Draws panels that belong to no study, but to a benchmark, and writes their CSV files. Does
/// nothing for empty names.
void draw(const std::vector<Panel> &panels, const std::string &csv, const std::string &picture);

} // namespace miniapp
