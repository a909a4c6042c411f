#include "common/sweep.hpp"

#include "common/figure.hpp"
#include "common/study.hpp"

#include <cattaneo/algebra/blas_kernels.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace miniapp
{

using cattaneo::require;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace
{

struct SweptKey
{
   std::string name;
   std::vector<std::string> values;
};

struct Point
{
   std::vector<std::string> values, words;
};

/// The number that a word is, or nothing.
ordered_json as_number(const std::string &word)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   return word.empty() || *end != 0 ? ordered_json(word) : ordered_json(value);
}

/// "0.01:0.05:9" means nine numbers in equal steps; any other text is one value.
std::vector<std::string> spread(const std::string &word)
{
   const std::vector<std::string> parts = split(word, ":");
   const bool two =
      parts.size() == 2 && as_number(parts[0]).is_number() && as_number(parts[1]).is_number();
   require(!two, "option --sweep: '", word,
           "' is no range, must be FROM:TO:COUNT such as 1:4:4");
   if (parts.size() != 3 || word.find(':') == std::string::npos) { return {word}; }
   const ordered_json from = as_number(parts[0]), to = as_number(parts[1]),
                      count = as_number(parts[2]);
   if (!from.is_number() || !to.is_number() || !count.is_number()) { return {word}; }
   const double steps = count.get<double>() - 1;
   require(steps >= 1 && steps < 1e5 && steps == std::floor(steps), "option --sweep: '", word,
           "' asks for ", parts[2], " values, must be at least 2 and at most 100000");
   std::vector<std::string> values;
   for (double k = 0; k <= steps; ++k)
   {
      values.push_back(
         text("%.12g", (from.get<double>() * (steps - k) + to.get<double>() * k) / steps));
   }
   return values;
}

std::vector<SweptKey> read_keys(const std::string &statements)
{
   std::vector<SweptKey> keys;
   for (const std::string &statement : split_unquoted("option --sweep", statements, ";"))
   {
      const auto [name, list] = assignment("option --sweep", statement, "friction=0.2 0.5");
      SweptKey key{name, {}};
      for (const SweptKey &other : keys)
      {
         require(other.name != key.name, "option --sweep: '", key.name, "' is there twice");
      }
      for (const std::string &word : split(list, " \t"))
      {
         for (const std::string &value : spread(word)) { key.values.push_back(value); }
      }
      require(!key.values.empty(), "option --sweep: '", statement, "' has no values");
      keys.push_back(key);
   }
   return keys;
}

std::string negative(const std::string &word)
{
   require(as_number(word).is_number(), "option --sweep: '", word,
           "' must be a number, because a key with a minus gets the opposite value");
   return word[0] == '-' ? word.substr(1) : '-' + word;
}

/// A key may be several places, "history.2.Q,-history.3.Q": all have the value, or its
/// negative.
std::vector<Point> make_points(const Options &options, const std::vector<SweptKey> &keys)
{
   std::vector<Point> points(1);
   for (const SweptKey &key : keys)
   {
      std::vector<Point> all;
      for (const Point &point : points)
      {
         for (const std::string &value : key.values)
         {
            all.push_back(point);
            all.back().values.push_back(value);
         }
      }
      require(all.size() <= 100000, "option --sweep asks for ", all.size(),
              " runs or more, must be at most 100000");
      points = all;
   }
   for (Point &point : points)
   {
      std::vector<std::pair<std::string, std::string>> changes;
      for (std::size_t k = 0; k < keys.size(); ++k)
      {
         for (const std::string &part : split_unquoted("option --sweep", keys[k].name, ","))
         {
            const bool back = part[0] == '-';
            changes.emplace_back(part.substr(back),
                                 back ? negative(point.values[k]) : point.values[k]);
         }
      }
      point.words = options.command(changes);
   }
   return points;
}

ordered_json numbers_of(const std::vector<std::string> &words)
{
   ordered_json list = ordered_json::array();
   for (const std::string &word : words) { list.push_back(as_number(word)); }
   return list;
}

} // namespace

void run_sweep(const Study &study, const std::string &name, const std::string &statements)
{
   require(ranks() == 1, "option --sweep must run on one rank, this runs on ", ranks());
   // Keys and values that no option allows are refused before the first run.
   const std::vector<SweptKey> keys = read_keys(statements);
   ordered_json points = ordered_json::array(), swept = ordered_json::array();
   for (const Point &point : make_points(study.options(), keys))
   {
      points.push_back({{"values", numbers_of(point.values)}, {"words", point.words}});
   }
   for (const SweptKey &key : keys)
   {
      swept.push_back({{"name", key.name}, {"values", numbers_of(key.values)}});
   }
   const std::string plan = temporary_file(
      "cattaneo_sweep", ordered_json{{"program", fs::read_symlink("/proc/self/exe").string()},
                                     {"study", name},
                                     {"options", study.options().values()},
                                     {"keys", swept},
                                     {"points", points},
                                     {"blas_kernels", cattaneo::blas_kernels().name}}
                           .dump());
   become_reader({"--sweep", plan});
   fs::remove(plan);
   require(false, "option --sweep needs Python 3, which is not installed (Debian: python3)");
}

} // namespace miniapp
