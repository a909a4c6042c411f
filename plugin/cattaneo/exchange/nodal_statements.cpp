#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

void add_supports(NodalStiffness &body, const std::string &called, const std::string &text)
{
   for (const std::string &statement : split(text, " ;\t\n"))
   {
      const std::size_t colon = std::min(statement.find(':'), statement.size());
      const std::string components = statement.substr(std::min(colon + 1, statement.size()));
      require(components == "x" || components == "y" || components == "xy", called, " '",
              statement, "': must be SET:x, SET:y or SET:xy");
      for (char c : components)
      {
         body.fix(body.nodes_of(statement.substr(0, colon)), c == 'x' ? 1 : 2);
      }
   }
}

void add_loads(NodalStiffness &body, const std::string &called, const std::string &text,
               int order)
{
   for (const std::string &statement : split(text, ";\n"))
   {
      const std::string where = called + " '" + statement + "'";
      const std::vector<std::string> words = split(statement, " \t");
      const std::string kind = words.size() > 1 ? words[1] : "";
      const bool moves = kind == "displacement-x" || kind == "displacement-y";
      require((moves && words.size() == 4) ||
                 ((kind == "force" || kind == "traction") && words.size() == 5),
              where,
              ": must be PATTERN force SET fx fy, PATTERN traction SET tx ty, PATTERN "
              "displacement-x SET u or PATTERN displacement-y SET u, with numbers");
      const std::string &pattern = words[0];
      require_pattern_name(where, pattern);
      const NodalStiffness::Nodes &nodes = body.nodes_of(words[2]);
      const std::string alone = where + ": a matrix takes numbers, no functions";
      const double first = number(alone, words[3]);
      if (moves) { body.add_displacement(pattern, nodes, kind.back() == 'x' ? 1 : 2, first); }
      else if (kind == "traction")
      {
         body.add_traction(pattern, nodes, {first, number(alone, words[4])}, order);
      }
      else
      {
         body.add_forces(pattern, nodes, 1, first);
         body.add_forces(pattern, nodes, 2, number(alone, words[4]));
      }
   }
}

} // namespace cattaneo
