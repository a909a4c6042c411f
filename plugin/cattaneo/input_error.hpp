#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace cattaneo
{

/// Bad input. The message is one sentence: what, where, the value found and what is allowed.
/// Outcomes of a solver (gross sliding, no solution) are statuses in its report, never this.
class InputError : public std::invalid_argument
{
public:
   using std::invalid_argument::invalid_argument;
};

/// Throws InputError with the concatenation of @a parts unless @a condition holds.
template <class... Parts>
void require(bool condition, const Parts &...parts)
{
   if (condition) { return; }
   std::ostringstream message;
   message.precision(17);
   (message << ... << parts);
   throw InputError(message.str());
}

} // namespace cattaneo
