#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/json_text.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdlib>

namespace cattaneo
{

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

std::vector<std::string> split_unquoted(const std::string &where, const std::string &text,
                                        const std::string &separators)
{
   std::vector<std::string> pieces(1);
   for (std::size_t k = 0; k < text.size(); ++k)
   {
      if (separators.find(text[k]) != std::string::npos)
      {
         pieces.emplace_back();
         continue;
      }
      const bool opens =
         (text[k] == '\'' || text[k] == '"') &&
         (k == 0 || std::string(",;. \t\n").find(text[k - 1]) != std::string::npos);
      std::size_t to = k;
      if (opens)
      {
         to = text.find(text[k], k + 1);
         require(to != std::string::npos, where, ": the quote ", text[k],
                 " that begins a name is not closed");
      }
      pieces.back() += text.substr(k, to - k + 1);
      k = to;
   }
   std::vector<std::string> all;
   for (const std::string &piece : pieces)
   {
      for (const std::string &trimmed : split(piece, "")) { all.push_back(trimmed); }
   }
   return all;
}

std::string unquoted(const std::string &name)
{
   const bool quoted = name.size() > 1 && (name[0] == '\'' || name[0] == '"') &&
                       name.find(name[0], 1) == name.size() - 1;
   return quoted ? name.substr(1, name.size() - 2) : name;
}

std::string listed(const std::vector<std::string> &pieces, const std::string &between)
{
   std::string text;
   for (const std::string &piece : pieces) { text += (text.empty() ? "" : between) + piece; }
   return text;
}

std::string csv_field(const std::string &text)
{
   if (text.find_first_of(",\"\n\r") == std::string::npos) { return text; }
   std::string quoted = "\"";
   for (const char c : text) { quoted += c == '"' ? "\"\"" : std::string(1, c); }
   return quoted + '"';
}

double number(const std::string &where, const std::string &word)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   require(!word.empty() && *end == 0 && std::isfinite(value), where, ": '", word,
           "' is not a number");
   return value;
}

bool is_utf8(const std::string &text)
{
   using nlohmann::json;
   const std::string kept = json(text).dump(-1, ' ', false, json::error_handler_t::ignore);
   return json::parse(kept) == json(text);
}

void require_single_keys(const std::string &where, const std::string &text)
{
   try
   {
      parsed(text, where, true);
   }
   catch (const nlohmann::json::exception &)
   {
      return; // no JSON
   }
}

void require_pattern_name(const std::string &where, const std::string &pattern)
{
   require(pattern.find_first_of("=,\"") == std::string::npos, where, ": pattern name '",
           pattern, "' must not hold =, a comma or a quote");
   require(is_utf8(pattern), where, ": the pattern name is not UTF-8");
}

} // namespace cattaneo
