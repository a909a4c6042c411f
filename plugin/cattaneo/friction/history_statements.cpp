#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

LoadHistory load_history(const std::string &called, const std::string &text,
                         const ReducedProblem &problem)
{
   std::vector<NamedLoads> points;
   for (const std::string &statement : split_unquoted(called, text, ";"))
   {
      const std::string where = called + " '" + statement + "'";
      NamedLoads point;
      for (const std::string &word : split_unquoted(where, statement, ", \t\n"))
      {
         const bool quoted = word[0] == '\'' || word[0] == '"';
         const std::size_t end = quoted ? word.find(word[0], 1) : 0,
                           equals = word.find('=', end);
         require(equals != std::string::npos && (!quoted || equals == end + 1), where, ": '",
                 word,
                 "', must be PATTERN=number such as P=1, a name with spaces, commas or = in "
                 "quotes");
         const std::string name = quoted ? word.substr(1, end - 1) : word.substr(0, equals);
         require(point.count(name) == 0, where, ": '", name,
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
         point[name] = number(where, word.substr(equals + 1));
      }
      points.push_back(point);
   }
   if (points.empty())
   {
      points.resize(2);
      for (const LoadPattern &pattern : problem.patterns) { points[1][pattern.name] = 1; }
   }
   for (const auto &[name, value] : points[0])
   {
      require(value == 0, called, ": ", name, " is ", value,
              " at the first point, must be 0: the bodies start without load");
   }
   return LoadHistory::through(problem, points);
}

} // namespace cattaneo
