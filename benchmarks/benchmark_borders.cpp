//  benchmark_borders: how often borders of zones lie within their ±, beside closed forms
//
//  A parabola between equal half-planes without a mesh, pressed (Hertz), sheared (Cattaneo),
//  sheared with tension in one body (Hills and Nowell) and unloaded (Mindlin), on lines of 8 to
//  96 elements of orders 1 to 3: lines that are centred on the contact, graded or not, and
//  lines whose elements are graded towards places off its middle. The ± is an estimate: the
//  tables say how often it holds, and by how much it is exceeded where it does not.

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

/// Ends of elements over |x| < span whose lengths follow one wave of a cosine, from 1 - wave to
/// 1 + wave of their mean, with the largest one at `about` (from -1 to 1).
std::vector<double> wave(int elements, double span, double wave, double about)
{
   std::vector<double> ends;
   const auto place = [&](double t) { return t + wave * std::sin(M_PI * (t - about)) / M_PI; };
   for (int k = 0; k <= elements; ++k)
   {
      const double t = 2.0 * k / elements - 1, from = place(-1);
      ends.push_back(span * (2 * (place(t) - from) / (place(1) - from) - 1));
   }
   return ends;
}

/// A table of shares by problem, number of elements and order.
class Table
{
public:
   /// False if there was no equilibrium.
   bool add(const Parabola &of, int elements, const std::string &name)
   {
      const auto borders = cattaneo_test::borders_of(of);
      for (std::size_t k = 0; k < borders.size(); ++k)
      {
         const std::string kind = k < 2 ? "Hertz, ends of contact" : name;
         tallies_["1 " + kind].add(borders[k]);
         tallies_["2 " + std::string(elements < 10 ? " " : "") + std::to_string(elements) +
                  " elements"]
            .add(borders[k]);
         tallies_["3 order " + std::to_string(of.order)].add(borders[k]);
         total_.add(borders[k]);
      }
      return !borders.empty();
   }
   void print(const std::string &title) const
   {
      std::printf("%-34s %7s %7s %7s %11s %11s %11s %11s\n", title.c_str(), "all", "found",
                  "inside", "share", "most error", "most error", "mean ±");
      std::printf("%-34s %7s %7s %7s %11s %11s %11s %11s\n", "", "", "", "", "of found",
                  "over its ±", "in spacings", "in spacings");
      for (const auto &[name, tally] : tallies_) { tally.print(name.substr(2)); }
      total_.print("all");
   }

private:
   std::map<std::string, Tally> tallies_;
   Tally total_;
};

} // namespace

int main()
{
   Table centred, off_centre;
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
                     if (!centred.add(of, elements, name)) { return 1; }
                  }
               }
            }
         }
         // Elements up to nine times as long at one end of the contact as at the other.
         int number = 0;
         for (const double about : {-0.6, 0.3, 0.9})
         {
            for (const double part : {0.4, 0.8})
            {
               for (const double shear : {0.15, 0.5, 0.9})
               {
                  for (const auto &[name, back_to] : {std::pair("Cattaneo", 1.0),
                                                      {"Mindlin, unloaded", 0.5},
                                                      {"Mindlin, unloaded", -0.1},
                                                      {"Mindlin, unloaded", -0.8}})
                  {
                     Parabola of;
                     const double span = 1.25 + 0.15 * (number % 4);
                     of.grid = wave(elements, span, part, about);
                     of.order = order;
                     ++number;
                     of.middle = 0.2 * (0.37 * number - std::floor(0.37 * number) - 0.5) * span;
                     of.shear = shear;
                     of.back_to = back_to;
                     if (!off_centre.add(of, elements, name)) { return 1; }
                  }
               }
            }
         }
      }
   }
   centred.print("lines centred on the contact");
   std::printf("\n");
   off_centre.print("graded lines, off the middle");
   return 0;
}
