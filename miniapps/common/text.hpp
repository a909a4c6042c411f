#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace miniapp
{

/// A name with a number so exact that no two numbers share one: "f = 0.5".
std::string exact_text(const std::string &words, double value);

/// An error as it is printed beside its value: two digits, the last one rounded up, since it is
/// a bound.
std::string error_text(double error);

/// As printf() would write it.
template <class... Values>
std::string text(const char *format, Values... values)
{
   std::string result(std::snprintf(nullptr, 0, format, values...), ' ');
   std::snprintf(result.data(), result.size() + 1, format, values...);
   return result;
}

/// Pieces of a text between separators, without spaces around them; empty ones are left out.
std::vector<std::string> split(const std::string &text, const std::string &separators);
/// Pieces with something between them.
std::string listed(const std::vector<std::string> &pieces, const std::string &between = ", ");

/// A word that is a finite number; InputError "WHERE: 'WORD' is not a number".
double number(const std::string &where, const std::string &word);

/// Of UTF-8, not its bytes.
std::size_t characters(const std::string &text);
/// With spaces behind it, or before it, up to a width counted in characters: text is UTF-8.
std::string padded(const std::string &text, std::size_t width);
std::string right(const std::string &text, std::size_t width);

/// Text broken into lines of a page, each with the same indentation.
std::string wrapped(const std::string &text, int indent);

} // namespace miniapp
