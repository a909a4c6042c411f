#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdlib>
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
   // What is a whole number of units but for round-off is not rounded up.
   return text("%.2g", std::ceil(error / unit * (1 - 1e-12)) * unit);
}

std::vector<std::string> split(const std::string &text, const std::string &separators)
{
   std::vector<std::string> pieces;
   std::size_t from = 0;
   while (from <= text.size())
   {
      const std::size_t to = std::min(text.find_first_of(separators, from), text.size());
      std::string piece = text.substr(from, to - from);
      piece.erase(0, piece.find_first_not_of(" \t\n"));
      piece.erase(piece.find_last_not_of(" \t\n") + 1);
      if (!piece.empty()) { pieces.push_back(piece); }
      from = to + 1;
   }
   return pieces;
}

std::string listed(const std::vector<std::string> &pieces, const std::string &between)
{
   std::string text;
   for (const std::string &piece : pieces) { text += (text.empty() ? "" : between) + piece; }
   return text;
}

double number(const std::string &where, const std::string &word)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   cattaneo::require(!word.empty() && *end == 0 && std::isfinite(value), where, ": '", word,
                     "' is not a number");
   return value;
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

} // namespace miniapp
