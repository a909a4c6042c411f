#pragma once

#include <Eigen/Dense>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/readout/zones.hpp>
#include <functional>
#include <string>
#include <vector>

namespace miniapp
{

/// As much of a march as a picture can show, whatever its length.
constexpr std::size_t most_drawn = 4096;

/** One panel of a figure, which is also one CSV file: comment lines that name it and its axes
    ("# kind: lines", "# title: …", "# x: …", "# y: …"), then a tidy table: one row a point
    (series, style, x, y), a zone (time, state, from, to), a ring (its state, from, to) or arrow
    (rate or total, radius, angle) of a plan, or a point of a field (series, x, y, value).
    miniapps/plot/plot.py draws any list of such files, and every ResultTable that says how. */
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
   /// Of a scene: an edge of a body, an arrow, or a mark (without extent), named by its kind.
   void item(const std::string &item, const Eigen::Vector2d &from,
             const Eigen::Vector2d &extent);
   /// A value of a field.
   void add(const std::string &series, double x, double y, double value);

   /// A word of the figure alone: "limits x: 0,1" (a side that is empty is left to the data),
   /// "reversed: x", "scale: loglog" or "semilogx" or "semilogy", "shade: 0,1,slip zone".
   void say(const std::string &comment) { comments_ += "# " + comment + "\n"; }
   void limit(const char *axis, double lo, double hi);

   const std::string &name() const { return name_; }
   /// Nothing if it has no points.
   std::string csv() const { return points_ > 0 ? comments_ + rows_ : ""; }

private:
   void row(const std::vector<std::string> &words, const std::vector<double> &numbers);
   std::string name_, comments_, rows_;
   int points_ = 0;
};

/// A CSV file, and whether it is drawn.
struct Sheet
{
   std::string name, text;
   bool drawn = true;
};

/** Writes what the options --csv PREFIX and --plot FILE.png ask for: PREFIX_<sheet>.csv for
    every sheet, and the picture of those that are drawn, by miniapps/plot/plot.py. InputError
    if there is nothing to be written, a file cannot be written or the script fails. Nothing for
    empty names. */
void output(const std::vector<Sheet> &sheets, const std::string &csv_prefix,
            const std::string &picture);

/// Runs plot.py with the first python3 that has matplotlib, as the one in the path may be bare.
/// InputError if there is none or the script fails.
void run_plot_script(const std::vector<std::string> &arguments, const std::string &picture);

} // namespace miniapp
