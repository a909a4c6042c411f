#include <algorithm>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/words.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace cattaneo
{

namespace
{

constexpr const char *blanks = " \t\r";

/// The whole field as a number, or false.
template <class Number>
bool parse(std::string_view field, Number &value)
{
   if (!field.empty() && field.front() == '+') { field.remove_prefix(1); }
   const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
   return error == std::errc() && end == field.data() + field.size();
}

/// Latin-1, the alphabet of older programs, in UTF-8.
std::string from_latin_1(const std::string &text)
{
   std::string result;
   for (const char each : text)
   {
      const auto letter = static_cast<unsigned char>(each);
      if (letter >= 0x80) { result += static_cast<char>(0xC0 | letter >> 6); }
      result += static_cast<char>(letter < 0x80 ? letter : 0x80 | (letter & 0x3F));
   }
   return result;
}

} // namespace

std::string_view trimmed(std::string_view text)
{
   const std::size_t first = text.find_first_not_of(blanks);
   if (first == std::string_view::npos) { return {}; }
   return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string upper_case(std::string_view text)
{
   std::string result(text);
   for (char &c : result)
   {
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
   }
   return result;
}

LineReader::LineReader(std::string file) : file_(std::move(file)), in_(file_)
{
   const bool folder = std::filesystem::is_directory(file_);
   cattaneo::require(in_.good() && !folder, "cannot read file '", file_, "'",
                     folder                           ? ": it is a folder"
                     : std::filesystem::exists(file_) ? ""
                                                      : ": there is no such file");
}

bool LineReader::next()
{
   while (std::getline(in_, line_))
   {
      ++number_;
      // The byte order mark that Windows puts before UTF-8.
      if (number_ == 1 && line_.rfind("\xEF\xBB\xBF", 0) == 0) { line_.erase(0, 3); }
      const bool ascii =
         std::all_of(line_.begin(), line_.end(), [](char c) { return (c & 0x80) == 0; });
      if (!ascii && !is_utf8(line_)) { line_ = from_latin_1(line_); }
      if (!trimmed(line_).empty()) { return true; }
   }
   return false;
}

std::vector<std::string_view> LineReader::fields() const
{
   std::vector<std::string_view> found;
   std::string_view rest = trimmed(line_);
   while (!rest.empty())
   {
      const std::size_t end = std::min(rest.find(','), rest.size());
      found.push_back(trimmed(rest.substr(0, end)));
      rest = trimmed(rest.substr(std::min(end + 1, rest.size())));
   }
   return found;
}

std::vector<std::string_view> LineReader::words() const
{
   constexpr const char *separators = " \t\r,*";
   std::vector<std::string_view> found;
   const std::string_view line = line_;
   for (std::size_t from = line.find_first_not_of(separators); from < line.size();)
   {
      const std::size_t end = std::min(line.find_first_of(separators, from), line.size());
      found.push_back(line.substr(from, end - from));
      from = line.find_first_not_of(separators, end);
   }
   return found;
}

void LineReader::add_integers(std::vector<int> &numbers, const char *what) const
{
   for (const std::string_view word : words()) { numbers.push_back(integer(word, what)); }
}

double LineReader::number(std::string_view field, const char *what) const
{
   double value = 0;
   bool good = parse(field, value);
   if (!good) // Fortran's double precision: 1.5D+03
   {
      std::string text(field);
      std::replace_if(
         text.begin(), text.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
      good = parse(std::string_view(text), value);
   }
   require(good && std::isfinite(value), what, " is '", field, "', must be a finite number");
   return value;
}

int LineReader::integer(std::string_view field, const char *what) const
{
   int value = 0;
   require(parse(field, value), what, " is '", field, "', must be an integer");
   return value;
}

} // namespace cattaneo
