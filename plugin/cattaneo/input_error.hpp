#pragma once

#include <Eigen/Core>
#include <sstream>
#include <stdexcept>
#include <string>

namespace cattaneo
{

/// Bad input. The message is one sentence: what is wrong, where, the value found and what is
/// allowed. Outcomes of a solver (gross sliding, no solution) are statuses in its report, never
/// an InputError.
class InputError : public std::invalid_argument
{
public:
   using std::invalid_argument::invalid_argument;
};

/// The shortest decimal that reads back as the same number.
std::string exact_text(double value);
/// A number in a message: as a user wrote it, which is exact_text() with at most 15 digits.
/// Numbers that need more were computed, and have 12 digits, without their round-off.
std::string message_text(double value);

/// A part of a message.
template <class Part>
const Part &as_text(const Part &part)
{
   return part;
}
/// See message_text().
inline std::string as_text(double value)
{
   return message_text(value);
}
/// "(x, y)".
inline std::string as_text(const Eigen::Vector2d &place)
{
   return "(" + message_text(place[0]) + ", " + message_text(place[1]) + ")";
}

/// Throws InputError with the concatenation of @a parts unless @a condition holds.
template <class... Parts>
void require(bool condition, const Parts &...parts)
{
   if (condition) { return; }
   std::ostringstream message;
   (message << ... << as_text(parts));
   throw InputError(message.str());
}

// The usual limits of a number; @a what: where it stands and its name. All refuse infinity and
// NaN.
/// InputError unless the value is above 0.
void require_positive(const char *what, double value);
/// InputError unless the value is at least `least`.
void require_at_least(const char *what, double value, double least);
/// InputError unless the value is between both limits, which are not allowed themselves.
void require_between(const char *what, double value, double low, double high);

} // namespace cattaneo
