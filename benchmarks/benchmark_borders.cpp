//  benchmark_borders: how often borders of zones lie within their ±, beside closed forms
//
//  A parabola between equal half-planes without a mesh, pressed (Hertz), sheared (Cattaneo),
//  sheared with tension in one body (Hills and Nowell) and unloaded (Mindlin), on lines of 8 to
//  96 elements of orders 1 to 3 that are shifted, and graded or not. The ± is an estimate: the
//  table says how often it holds, and by how much it is exceeded where it does not.

#include <cattaneo/input_error.hpp>
#include <closed_form_borders.hpp>
#include <cstdio>
#include <map>

using cattaneo_test::KnownBorder;
using cattaneo_test::Parabola;

namespace
{

/// What became of the borders of one kind.
struct Tally
{
   long all = 0, found = 0, inside = 0;
   double most = 0;          ///< error over estimate
   double spacings = 0;      ///< the largest error
   double mean_estimate = 0; ///< in spacings, a sum

   void add(const KnownBorder &border)
   {
      ++all;
      if (!border.found) { return; }
      ++found;
      inside += border.inside();
      mean_estimate += border.estimate / border.spacing;
      spacings = std::max(spacings, border.error() / border.spacing);
      if (border.estimate > 0) { most = std::max(most, border.error() / border.estimate); }
   }
   void print(const std::string &name) const
   {
      const double count = static_cast<double>(std::max(found, 1l));
      std::printf("%-34s %7ld %7ld %7ld %9.2f %% %11.2f %11.2f %11.2f\n", name.c_str(), all,
                  found, inside, 100 * static_cast<double>(inside) / count, most, spacings,
                  mean_estimate / count);
   }
};

/// Ends of elements over |x| < span, the outer ones `ratio` times as long as the middle ones.
std::vector<double> line(int elements, double span, double ratio)
{
   std::vector<double> ends{0};
   for (int k = 0; k < elements; ++k)
   {
      const double place = std::abs(2 * (k + 0.5) / elements - 1);
      ends.push_back(ends.back() + 1 + (ratio - 1) * place);
   }
   const double scale = 2 * span / ends.back();
   for (double &x : ends) { x = scale * x - span; }
   return ends;
}

} // namespace

int main()
{
   std::map<std::string, Tally> tallies; // by problem, and by number of elements
   Tally total;
   for (const int elements : {8, 10, 12, 16, 24, 32, 48, 96})
   {
      for (const int order : {1, 2, 3})
      {
         for (const double ratio : {1.0, 0.4})
         {
            for (const double span : {1.2, 1.7})
            {
               int number = 0;
               for (const double shear : {0.3, 0.6, 0.9})
               {
                  for (const auto &[name, back_to, shift] :
                       {std::tuple("Cattaneo", 1.0, 0.0),
                        {"Mindlin, unloaded", -0.4, 0.0},
                        {"Hills and Nowell, tension", 1.0, 0.25}})
                  {
                     Parabola of;
                     of.grid = line(elements, span, ratio);
                     of.order = order;
                     // Off the nodes, each time elsewhere within an element.
                     ++number;
                     of.middle = (0.37 * number - std::floor(0.37 * number)) * span / elements;
                     of.shear = shear;
                     of.back_to = back_to;
                     of.shift = shift * shear;
                     const auto borders = cattaneo_test::borders_of(of);
                     if (borders.empty()) { return 1; }
                     for (std::size_t k = 0; k < borders.size(); ++k)
                     {
                        const std::string kind = k < 2 ? "Hertz, ends of contact" : name;
                        tallies["1 " + kind].add(borders[k]);
                        tallies["2 " + std::string(elements < 10 ? " " : "") +
                                std::to_string(elements) + " elements"]
                           .add(borders[k]);
                        tallies["3 order " + std::to_string(order)].add(borders[k]);
                        total.add(borders[k]);
                     }
                  }
               }
            }
         }
      }
   }
   std::printf("%-34s %7s %7s %7s %11s %11s %11s %11s\n", "borders", "all", "found", "inside",
               "share", "most error", "most error", "mean ±");
   std::printf("%-34s %7s %7s %7s %11s %11s %11s %11s\n", "", "", "", "", "of found",
               "over its ±", "in spacings", "in spacings");
   for (const auto &[name, tally] : tallies) { tally.print(name.substr(2)); }
   total.print("all");
   return 0;
}
