#include "common/text.hpp"

#include "common/units.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <sstream>

namespace miniapp
{

std::string exact_text(const std::string &words, double value)
{
   return words + cattaneo::exact_text(value);
}

std::string error_text(double error)
{
   if (!(error > 0) || !std::isfinite(error)) { return text("%g", error); }
   const double unit = std::pow(10.0, std::floor(std::log10(error)) - 1);
   // A whole number of units, apart from round-off, is not rounded up.
   return text("%.2g", std::ceil(error / unit * (1 - 1e-12)) * unit);
}

std::size_t characters(const std::string &text)
{
   return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
}

namespace
{

std::string blanks(const std::string &text, std::size_t width)
{
   return std::string(width - std::min(width, characters(text)), ' ');
}

} // namespace

std::string padded(const std::string &text, std::size_t width)
{
   return text + blanks(text, width);
}

std::string right(const std::string &text, std::size_t width)
{
   return blanks(text, width) + text;
}

std::string wrapped(const std::string &text, int indent)
{
   std::istringstream words(text);
   std::string word, line, result;
   const std::string margin(indent, ' ');
   while (words >> word)
   {
      if (!line.empty() && indent + line.size() + word.size() > 96)
      {
         result += margin + line + "\n";
         line.clear();
      }
      line += (line.empty() ? "" : " ") + word;
   }
   return result + margin + line + "\n";
}

std::string Units::of(int forces, int lengths) const
{
   if (length.empty() || force.empty()) { return ""; }
   const std::string power = lengths == 2 || lengths == -2 ? length + "²" : length;
   if (forces == 0) { return " [" + power + "]"; }
   return " [" + force + (lengths > 0 ? " " + power : lengths < 0 ? "/" + power : "") + "]";
}

} // namespace miniapp
