#pragma once

#include <Eigen/Dense>
#include <cattaneo/readout/zones.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace miniapp
{

/** One panel of a figure, which is also one CSV file: comment lines that name it and its axes
    ("# kind: lines", "# title: …", "# x: …", "# y: …"), then a tidy table with one row a point
    (series, style, x, y), one row a zone (time, state, from, to), or one row a ring (its state,
    from, to) or arrow (rate or total, radius, angle) of a plan. miniapps/plot/plot.py draws any
    list of such files. */
class Panel
{
public:
   /// Curves of y over x.
   static Panel lines(const std::string &name, const std::string &title,
                      const std::string &x_label, const std::string &y_label);
   /// States along the contact (y) against time or load (x).
   static Panel zones(const std::string &name, const std::string &title,
                      const std::string &x_label, const std::string &y_label);

   /// A surface of revolution from above: rings in their states, arrows of slip.
   static Panel plan(const std::string &name, const std::string &title,
                     const std::string &x_label, const std::string &y_label);

   /// A curve; `style` is line, dashed (closed forms, comparisons), points, or thesis (the
   /// thesis' values, marked). Values that are not finite leave a gap.
   void add(const std::string &series, const Eigen::VectorXd &x, const Eigen::VectorXd &y,
            const std::string &style = "line");
   void add(const std::string &series, const std::vector<double> &x,
            const std::vector<double> &y, const std::string &style = "line");
   /// The zones of one state at a time; `coordinate` maps arc length to what is shown.
   void add(
      double time, const std::vector<cattaneo::Zone> &zones,
      const std::function<double(double)> &coordinate = [](double s) { return s; });

   /// Rings of a plan; positions are radii.
   void add(const std::vector<cattaneo::Zone> &rings);
   /// An arrow of a plan, shown all around: "rate" (of slip) or "total" (slip), at a radius, by
   /// its angle from the radial direction, radians.
   void arrow(const std::string &kind, double radius, double angle);

   /// A value of the thesis on a zone diagram.
   void mark(double time, double coordinate);

   /// Limits of the axes; NaN leaves one to the data. They are part of the figure only.
   void limit_x(double lo, double hi);
   void limit_y(double lo, double hi);
   /// Descending x axis: for unloading, read from left to right.
   void reverse_x() { comments_ += "# reversed: x\n"; }
   void logarithmic() { comments_ += "# scale: loglog\n"; }

   const std::string &name() const { return name_; }
   std::string csv() const;

private:
   Panel(const std::string &name, std::string comments, std::string header)
      : name_(name), comments_(std::move(comments)), rows_(std::move(header))
   {
   }
   void limit(const char *axis, double lo, double hi);
   std::string name_, comments_, rows_;
};

/// Runs a script of miniapps/plot with the first python3 that has matplotlib, as the one in the
/// path may be bare; false if there is none or the script fails.
bool run_plot_script(const std::string &script, const std::vector<std::string> &arguments);

/** Writes what the options --csv PREFIX and --plot FILE.png ask for: PREFIX_<panel>.csv for
   every panel, and the picture, drawn by miniapps/plot/plot.py. InputError if a file cannot be
   written or the script fails. Nothing for empty names. */
void output(const std::vector<Panel> &panels, const std::string &csv_prefix,
            const std::string &picture);

} // namespace miniapp
