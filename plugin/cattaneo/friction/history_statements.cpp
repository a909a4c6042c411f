#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <set>

namespace cattaneo
{

namespace
{

/// Where a quote that opens at `from` closes; npos: it does not.
std::size_t closing(const std::string &text, std::size_t from)
{
   return text.find(text[from], from + 1);
}

/// split(), but that a quoted name ('bolt 1, w = 1' or with ") is not cut.
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
      // A quote within a name is a letter of it.
      const bool opens =
         (text[k] == '\'' || text[k] == '"') &&
         (k == 0 || std::string(",; \t\n").find(text[k - 1]) != std::string::npos);
      std::size_t to = k;
      if (opens)
      {
         to = closing(text, k);
         require(to != std::string::npos, where, ": the quote ", text[k],
                 " that begins a name has no end");
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

} // namespace

LoadHistory load_history(const std::string &called, const std::string &text,
                         const ReducedProblem &problem)
{
   NamedLoads loads;
   std::vector<NamedLoads> points;
   for (const std::string &statement : split_unquoted(called, text, ";"))
   {
      const std::string where = called + " '" + statement + "'";
      std::set<std::string> named;
      for (const std::string &word : split_unquoted(where, statement, ", \t\n"))
      {
         const bool quoted = word[0] == '\'' || word[0] == '"';
         const std::size_t end = quoted ? closing(word, 0) : 0, equals = word.find('=', end);
         require(equals != std::string::npos && (!quoted || equals == end + 1), where, ": '",
                 word,
                 "', must be PATTERN=number such as P=1, a name with spaces, commas or = in "
                 "quotes");
         const std::string name = quoted ? word.substr(1, end - 1) : word.substr(0, equals);
         require(named.insert(name).second, where, ": '", name,
                 "' is there twice, each point has one value of it; points are separated by "
                 "semicolons, as 'P=0; P=1'");
         try
         {
            problem.pattern(name);
         }
         catch (const InputError &error)
         {
            throw InputError(where + ": " + error.what());
         }
         loads[name] = number(where, word.substr(equals + 1));
      }
      points.push_back(loads);
   }
   if (points.empty())
   {
      points.emplace_back();
      for (const LoadPattern &pattern : problem.patterns) { loads[pattern.name] = 1; }
      points.push_back(loads);
   }
   for (const auto &[name, value] : points[0])
   {
      require(value == 0, called, ": ", name, " is ", value,
              " at the first point, must be 0: the bodies start without load");
   }
   return LoadHistory::through(problem, points);
}

} // namespace cattaneo
