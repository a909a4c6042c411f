#include "common/figure.hpp"

#include "common/miniapp.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;

namespace
{

std::string number(double value)
{
   if (!std::isfinite(value)) { return ""; }
   char text[32];
   std::snprintf(text, sizeof text, "%.9g", value);
   return text;
}

std::string quoted(const std::string &text)
{
   return text.find_first_of(",\"") == std::string::npos ? text : '"' + text + '"';
}

/// For the shell.
std::string argument(const std::string &text)
{
   std::string result = "'";
   for (char c : text) { result += c == '\'' ? std::string("'\\''") : std::string(1, c); }
   return result + "'";
}

std::string comments(const char *kind, const std::string &title, const std::string &x_label,
                     const std::string &y_label)
{
   return std::string("# kind: ") + kind + "\n# title: " + title + "\n# x: " + x_label +
          "\n# y: " + y_label + "\n";
}

} // namespace

Panel Panel::lines(const std::string &name, const std::string &title,
                   const std::string &x_label, const std::string &y_label)
{
   return {name, comments("lines", title, x_label, y_label), "series,style,x,y\n"};
}

Panel Panel::zones(const std::string &name, const std::string &title,
                   const std::string &x_label, const std::string &y_label)
{
   return {name, comments("zones", title, x_label, y_label), "time,state,from,to\n"};
}

Panel Panel::plan(const std::string &name, const std::string &title, const std::string &x_label,
                  const std::string &y_label)
{
   return {name, comments("plan", title, x_label, y_label), "item,from,to\n"};
}

void Panel::add(const std::string &series, const VectorXd &x, const VectorXd &y,
                const std::string &style)
{
   for (Eigen::Index i = 0; i < x.size(); ++i)
   {
      rows_ += quoted(series) + ',' + style + ',' + number(x[i]) + ',' + number(y[i]) + '\n';
   }
}

void Panel::add(const std::string &series, const std::vector<double> &x,
                const std::vector<double> &y, const std::string &style)
{
   add(series, VectorXd(Eigen::Map<const VectorXd>(x.data(), x.size())),
       VectorXd(Eigen::Map<const VectorXd>(y.data(), y.size())), style);
}

void Panel::add(double time, const std::vector<Zone> &zones,
                const std::function<double(double)> &coordinate)
{
   for (const Zone &zone : zones)
   {
      rows_ += number(time) + ',' + cattaneo::name(zone.state) + ',' +
               number(coordinate(zone.from.position)) + ',' +
               number(coordinate(zone.to.position)) + '\n';
   }
}

void Panel::add(const std::vector<Zone> &rings)
{
   for (const Zone &ring : rings)
   {
      rows_ += std::string(cattaneo::name(ring.state)) + ',' + number(ring.from.position) +
               ',' + number(ring.to.position) + '\n';
   }
}

void Panel::arrow(const std::string &kind, double radius, double angle)
{
   rows_ += kind + ',' + number(radius) + ',' + number(angle) + '\n';
}

void Panel::mark(double time, double coordinate)
{
   rows_ += number(time) + ",thesis," + number(coordinate) + "," + number(coordinate) + "\n";
}

void Panel::limit(const char *axis, double lo, double hi)
{
   comments_ += std::string("# limits ") + axis + ": " + number(lo) + "," + number(hi) + "\n";
}

void Panel::limit_x(double lo, double hi)
{
   limit("x", lo, hi);
}

void Panel::limit_y(double lo, double hi)
{
   limit("y", lo, hi);
}

std::string Panel::csv() const
{
   return comments_ + rows_;
}

bool run_plot_script(const std::string &script, const std::vector<std::string> &arguments)
{
   if (!writes()) { return true; }
   std::string command =
      "for python in python3 /usr/bin/python3; do if $python -c 'import matplotlib' "
      "2>/dev/null; "
      "then exec $python " +
      argument(std::string(CATTANEO_SOURCE_DIR) + "/miniapps/plot/" + script);
   for (const std::string &text : arguments) { command += " " + argument(text); }
   std::cout << std::flush;
   return std::system((command + "; fi; done; exit 3").c_str()) == 0;
}

void output(const std::vector<Panel> &panels, const std::string &csv_prefix,
            const std::string &picture)
{
   if ((csv_prefix.empty() && picture.empty()) || !writes()) { return; }
   if (panels.empty()) { warn("options --csv and --plot: this run has no figures"); }
   if (panels.empty()) { return; }
   const std::string prefix = csv_prefix.empty() ? picture : csv_prefix;
   std::vector<std::string> names;
   for (const Panel &panel : panels)
   {
      names.push_back(prefix + "_" + panel.name() + ".csv");
      write_whole(names.back(), panel.csv());
   }
   if (picture.empty()) { return; }
   std::vector<std::string> arguments = names;
   arguments.push_back(picture);
   const bool drawn = run_plot_script("plot.py", arguments);
   if (csv_prefix.empty())
   {
      for (const std::string &name : names) { std::remove(name.c_str()); }
   }
   require(drawn, "option --plot: '", picture,
           "' was not drawn; it needs Python 3 with matplotlib (Debian: python3-matplotlib)");
}

} // namespace miniapp
