#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace cattaneo
{

namespace
{

/// With at most so many digits the shortest decimal that reads back as the same number; without
/// one the number to `otherwise` digits.
std::string shortest_text(double value, int most, int otherwise)
{
   char text[32];
   for (int digits = 6; digits <= most; ++digits)
   {
      std::snprintf(text, sizeof text, "%.*g", digits, value);
      if (std::strtod(text, nullptr) == value) { return text; }
   }
   std::snprintf(text, sizeof text, "%.*g", otherwise, value);
   return text;
}

} // namespace

std::string exact_text(double value)
{
   return shortest_text(value, 16, 17);
}

std::string message_text(double value)
{
   return shortest_text(value, 15, 12);
}

void require_positive(const char *what, double value)
{
   require(value > 0 && std::isfinite(value), what, " is ", value,
           ", must be positive and finite");
}

void require_at_least(const char *what, double value, double least)
{
   require(value >= least && std::isfinite(value), what, " is ", value, ", must be at least ",
           least);
}

void require_between(const char *what, double value, double low, double high)
{
   require(value > low && value < high, what, " is ", value, ", must be between ", low, " and ",
           high);
}

} // namespace cattaneo
