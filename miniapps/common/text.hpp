#pragma once

#include <cattaneo/words.hpp>
#include <cstdio>
#include <sstream>
#include <string>

namespace miniapp
{

using cattaneo::listed;
using cattaneo::number;
using cattaneo::split;
using cattaneo::split_unquoted;
using cattaneo::unquoted;

/// A name with a number, so exact that different numbers have different names: "f = 0.5".
std::string exact_text(const std::string &words, double value);

/// The text of an error that is printed beside its value: two digits, the last one rounded up,
/// because it is a bound.
std::string error_text(double error);

/// The text that printf() would write.
template <class... Values>
std::string text(const char *format, Values... values)
{
   std::string result(std::snprintf(nullptr, 0, format, values...), ' ');
   std::snprintf(result.data(), result.size() + 1, format, values...);
   return result;
}

/// A sentence from parts, as a stream would write them.
template <class... Parts>
std::string told(const Parts &...parts)
{
   std::ostringstream all;
   (all << ... << parts);
   return all.str();
}

/// Number of characters of UTF-8 text, which has more bytes.
std::size_t characters(const std::string &text);
/// The text with spaces behind it, or before it, up to a width counted in characters (UTF-8).
std::string padded(const std::string &text, std::size_t width);
std::string right(const std::string &text, std::size_t width);

/// Text broken into lines of a page, each with the same indentation.
std::string wrapped(const std::string &text, int indent);

} // namespace miniapp
