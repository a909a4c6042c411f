#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace cattaneo
{

std::string exact_text(double value)
{
   char text[32];
   for (int digits = 6; digits <= 17; ++digits)
   {
      std::snprintf(text, sizeof text, "%.*g", digits, value);
      if (std::strtod(text, nullptr) == value) { break; }
   }
   return text;
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
