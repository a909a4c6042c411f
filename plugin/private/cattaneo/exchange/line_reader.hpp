#pragma once

#include <cattaneo/input_error.hpp>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace cattaneo
{

/// Reads a text file line by line, in UTF-8; other lines are read as Latin-1. Errors have its
/// name and the line.
class LineReader
{
public:
   /// InputError if the file cannot be read.
   explicit LineReader(std::string file);

   /// Goes on to the next line that is not blank; false at the end of the file.
   bool next();
   const std::string &line() const { return line_; }
   const std::string &file() const { return file_; }
   int line_number() const { return number_; }

   /// Fields of the line between commas, without blanks around them. An empty field at the end
   /// of the line is left out.
   std::vector<std::string_view> fields() const;
   /// The words between blanks, commas and stars (of a comment).
   std::vector<std::string_view> words() const;
   /// Appends all words, as numbers, to `numbers`.
   void add_integers(std::vector<int> &numbers, const char *what) const;
   /// A number as C or Fortran writes it; InputError unless it is finite.
   double number(std::string_view field, const char *what) const;
   int integer(std::string_view field, const char *what) const;

   template <class... Parts>
   void require(bool condition, const Parts &...parts) const
   {
      cattaneo::require(condition, "file '", file_, "', line ", number_, ": ", parts...);
   }

private:
   std::string file_, line_;
   std::ifstream in_;
   int number_ = 0;
};

std::string_view trimmed(std::string_view text);
std::string upper_case(std::string_view text);

} // namespace cattaneo
