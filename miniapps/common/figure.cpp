#include "common/figure.hpp"

#include "common/miniapp.hpp"
#include "common/shipped.hpp"
#include "common/text.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// For the shell.
std::string argument(const std::string &text)
{
   std::string result = "'";
   for (char c : text) { result += c == '\'' ? std::string("'\\''") : std::string(1, c); }
   return result + "'";
}

VectorXd vector(const std::vector<double> &values)
{
   return Eigen::Map<const VectorXd>(values.data(), values.size());
}

} // namespace

Panel::Panel(Kind kind, const std::string &name, const std::string &title,
             const std::string &x_label, const std::string &y_label)
   : name_(name)
{
   static const char *const kinds[] = {"lines", "zones", "plan", "field", "scene"};
   static const char *const headers[] = {"series,style,x,y\n", "time,state,from,to\n",
                                         "item,from,to\n", "series,x,y,value\n",
                                         "item,x,y,dx,dy\n"};
   const auto k = static_cast<std::size_t>(kind);
   for (const auto &[key, word] : {std::pair<std::string, std::string>{"kind", kinds[k]},
                                   {"title", title},
                                   {"x", x_label},
                                   {"y", y_label}})
   {
      say(key + ": " + word);
   }
   rows_ = headers[k];
}

void Panel::row(const std::vector<std::string> &words, const std::vector<double> &numbers)
{
   std::vector<std::string> cells;
   for (const std::string &word : words) { cells.push_back(csv_field(word)); }
   for (double x : numbers) { cells.push_back(std::isfinite(x) ? text("%.9g", x) : ""); }
   for (std::size_t k = 0; k < cells.size(); ++k) { rows_ += (k ? "," : "") + cells[k]; }
   rows_ += '\n';
   ++points_;
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
   rows_ += text("%.9g,%s,%.9g,%.9g\n", time, state.c_str(), from, to);
   ++points_;
}

void Panel::mark(double time, double coordinate)
{
   rows_ += text("%.9g,thesis,%.9g,%.9g\n", time, coordinate, coordinate);
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

void Panel::limit(const char *axis, double lo, double hi)
{
   const auto bound = [](double x) { return std::isfinite(x) ? text("%.9g", x) : ""; };
   say(std::string("limits ") + axis + ": " + bound(lo) + "," + bound(hi));
}

void run_plot_script(const std::vector<std::string> &arguments, const std::string &picture)
{
   if (!writes()) { return; }
   std::string command =
      // Ctrl-C is for the study: a second one must not leave half a picture.
      "trap '' INT; for python in python3 /usr/bin/python3; do command -v $python >/dev/null "
      "|| continue; "
      "CATTANEO_TRIES_PYTHONS=1 $python " +
      argument(shipped("plot/plot.py"));
   for (const std::string &text : arguments) { command += " " + argument(text); }
   command += " " + argument(picture) + "; code=$?; [ $code = 3 ] || exit $code; done; exit 3";
   std::cout << std::flush;
   require(std::system(command.c_str()) == 0, "option --plot: '", picture,
           "' was not drawn; it needs Python 3 with matplotlib (Debian: python3-matplotlib)");
}

void output(const std::vector<Sheet> &sheets, const std::string &csv_prefix,
            const std::string &picture)
{
   if (!writes()) { return; }
   require(csv_prefix.empty() || !sheets.empty(), "option --csv: this run has no tables");
   std::vector<std::string> drawn;
   for (const Sheet &sheet : sheets)
   {
      const bool draw = !picture.empty() && sheet.drawn;
      if (csv_prefix.empty() && !draw) { continue; }
      const std::string name =
         (csv_prefix.empty() ? picture : csv_prefix) + "_" + sheet.name + ".csv";
      write_whole(name, sheet.text);
      if (draw) { drawn.push_back(name); }
   }
   if (picture.empty()) { return; }
   require(!drawn.empty(), "option --plot: this run has nothing to draw");
   const auto tidy = [&]
   {
      for (const std::string &name : drawn)
      {
         if (csv_prefix.empty()) { std::remove(name.c_str()); }
      }
   };
   try
   {
      run_plot_script(drawn, picture);
   }
   catch (const InputError &)
   {
      tidy();
      throw;
   }
   tidy();
}

} // namespace miniapp
