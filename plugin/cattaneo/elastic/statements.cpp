#include <algorithm>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/expression.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdlib>

namespace cattaneo
{

namespace
{

/// Refuses a point far outside the body, because its nearest node is not the node that the user
/// meant.
void check_point(const ElasticBody &body, const std::string &where,
                 const Eigen::Vector3d &point)
{
   const Eigen::AlignedBox3d box = body.box();
   const double slack = 0.01 * box.sizes().norm();
   const auto text = [&](const Eigen::Vector3d &place)
   { return place_text(place, body.formulation()); };
   require(box.exteriorDistance(point) <= slack, where, ": ", text(point),
           " lies outside of the body, which extends from ", text(box.min()), " to ",
           text(box.max()));
}

/// The components that a text names, of a body in space.
std::vector<int> components_in_space(const std::string &where, const std::string &text)
{
   std::vector<int> own;
   bool known = !text.empty();
   for (std::size_t k = 0; k < text.size(); ++k)
   {
      known = known && text[k] >= 'x' && text[k] <= 'z' && text.find(text[k]) == k;
      own.push_back(text[k] - 'x');
   }
   require(known, where, ": component '", text, "', must be some of x, y and z, as xyz");
   return own;
}

/// The named components that a body of this formulation has. About an axis r and z belong to
/// the axisymmetric body and t to the torsion body, so the result may be empty.
std::vector<int> components(const std::string &where, const std::string &text,
                            Formulation formulation)
{
   if (formulation == Formulation::space) { return components_in_space(where, text); }
   const bool plane = formulation == Formulation::plane;
   std::vector<int> own;
   bool known = !text.empty();
   for (std::size_t k = 0; k < text.size(); ++k)
   {
      const char c = text[k];
      const int number = c == 'x' || (!plane && c == 'r')   ? 0
                         : c == 'y' || (!plane && c == 'z') ? 1
                         : !plane && c == 't'               ? 2
                                                            : -1;
      known = known && number >= 0 && text.find(c) == k;
      const bool around = formulation == Formulation::torsion;
      if ((number == 2) == around) { own.push_back(around ? 0 : number); }
   }
   require(known, where, ": component '", text, "', must be ",
           plane ? "x, y or xy" : "some of r, z and t (around the axis), as rz");
   return own;
}

/// Whether a kind of load acts around an axis.
bool around(const std::string &kind)
{
   return kind == "traction-t" || kind == "twist";
}

/// An attribute by its number, or those of a name.
std::vector<int> attributes_of(const std::string &word, const BodyTerms &terms,
                               const std::string &error)
{
   auto named = terms.boundary.find(word);
   if (named == terms.boundary.end()) { named = terms.boundary.find(upper_case(word)); }
   if (named != terms.boundary.end())
   {
      require(!named->second.empty(), error, "; ", named->first,
              " is no part of the boundary: it must be whole edges, with the nodes in their "
              "middles");
      return named->second;
   }
   char *end = nullptr;
   const long number = std::strtol(word.c_str(), &end, 10);
   std::vector<std::string> names;
   for (const auto &[name, its] : terms.boundary)
   {
      if (!its.empty()) { names.push_back(name); }
   }
   const bool is_number = terms.numbered && *end == 0 && number > 0 && number < 1000000000;
   // The text is a name that does not exist; for anything else the message shows the form.
   const bool is_name = !word.empty() && word.find_first_of("[]<>:") == std::string::npos;
   require(is_number || !is_name || names.empty(), error.substr(0, error.find("', must be")),
           "': there is no part of the boundary '", word, "', must be one of: ", listed(names),
           terms.numbered ? ", or an attribute such as 3" : "");
   require(is_number, error,
           names.empty() ? terms.numbered ? "; the mesh has no names of curves"
                                          : "; the deck has no names of parts of the boundary"
                         : "; names are " + listed(names));
   return {static_cast<int>(number)};
}

} // namespace

BoundaryPart boundary_part(const std::string &called, const std::string &text,
                           const BodyTerms &terms)
{
   const std::string form = terms.numbered
                               ? "', must be names or boundary attributes such as 3 or 3,4, "
                                 "perhaps with an interval such as 3[-1<x<1]"
                               : "', must be names of surfaces or sets of nodes, perhaps with "
                                 "an interval such as TOP[-1<x<1]";
   const std::size_t bracket = std::min(text.find('['), text.size());
   std::vector<int> attributes;
   for (const std::string &word : split(text.substr(0, bracket), ","))
   {
      for (int its : attributes_of(word, terms, called + ": '" + text + form))
      {
         if (std::find(attributes.begin(), attributes.end(), its) == attributes.end())
         {
            attributes.push_back(its);
         }
      }
   }
   require(!attributes.empty(), called, ": '", text, form);
   if (bracket == text.size()) { return attributes; }
   require(text.back() == ']', called, ": '", text, form);
   // Several intervals are separated by commas: [-1<x<1,0<y<2].
   const std::vector<std::string> axes = {"x", "y", "z"};
   std::vector<BoundaryPart::Interval> intervals;
   for (const std::string &one :
        split(text.substr(bracket + 1, text.size() - bracket - 2), ","))
   {
      const std::vector<std::string> bounds = split(one, "<");
      const auto axis =
         bounds.size() == 3 ? std::find(axes.begin(), axes.end(), bounds[1]) : axes.end();
      require(axis != axes.end(), called, ": '", text, form);
      intervals.push_back({static_cast<int>(axis - axes.begin()), number(called, bounds[0]),
                           number(called, bounds[2])});
   }
   require(!intervals.empty(), called, ": '", text, form);
   BoundaryPart made(attributes, intervals[0].axis, intervals[0].lo, intervals[0].hi);
   made.also.assign(intervals.begin() + 1, intervals.end());
   return made;
}

ScalarField scalar_field(const std::string &called, const std::string &text,
                         Formulation formulation)
{
   std::vector<std::string> variables = {"x", "y"};
   if (formulation == Formulation::space)
   {
      const Expression value(called, text, {"x", "y", "z"});
      return [value](double x, double y, double z) { return value({x, y, z}); };
   }
   if (formulation != Formulation::plane) { variables = {"x", "y", "r", "z"}; }
   const Expression value(called, text, variables);
   return [value](double x, double y) { return value({x, y, x, y}); };
}

void add_supports(ElasticBody &body, const std::string &called, const std::string &text,
                  const BodyTerms &terms)
{
   for (const std::string &statement : split(text, " ;\t\n"))
   {
      const std::string where = called + " '" + statement + "'";
      const std::size_t colon = statement.find(':');
      require(colon != std::string::npos, where,
              ": must be attributes:components such as 1:xy, or @x,y",
              body.formulation() == Formulation::space ? ",z" : "",
              ":components for the node there");
      const std::string place = statement.substr(0, colon);
      const std::vector<int> fixed =
         components(where, statement.substr(colon + 1), body.formulation());
      if (place[0] == '@')
      {
         const std::vector<std::string> point = split(place.substr(1), ",");
         const bool space = body.formulation() == Formulation::space;
         require(point.size() == (space ? 3 : 2), where, ": '", place,
                 "', must be a point such as ", space ? "@0,-1,2" : "@0,-1");
         Eigen::Vector3d at(0, 0, 0);
         for (std::size_t k = 0; k < point.size(); ++k) { at[k] = number(where, point[k]); }
         check_point(body, where, at);
         for (int component : fixed)
         {
            if (space) { body.fix_node(at[0], at[1], at[2], component); }
            else { body.fix_node(at[0], at[1], component); }
         }
         continue;
      }
      const BoundaryPart part = boundary_part(where, place, terms);
      try
      {
         for (int component : fixed) { body.fix(part, component); }
      }
      catch (const InputError &error)
      {
         throw InputError(where + ": " + error.what());
      }
   }
}

std::vector<int> supported_attributes(const std::string &called, const std::string &text,
                                      const BodyTerms &terms)
{
   std::vector<int> all;
   for (const std::string &statement : split(text, " ;\t\n"))
   {
      const std::string place = statement.substr(0, statement.find(':'));
      if (place[0] == '@') { continue; }
      const BoundaryPart part = boundary_part(called + " '" + statement + "'", place, terms);
      all.insert(all.end(), part.attributes.begin(), part.attributes.end());
   }
   return all;
}

void add_loads(ElasticBody &body, const std::string &called, const std::string &text,
               const BodyTerms &terms)
{
   struct Kind
   {
      const char *name;
      std::size_t words;
      const char *form, *of; ///< the formulations that have it: p(lane), a(xis), s(pace)
   };
   static const Kind kinds[] = {
      {"pressure", 4, "PATTERN pressure WHERE p", "pas"},
      {"traction", 5, "PATTERN traction WHERE tx ty", "pa"},
      {"traction", 6, "PATTERN traction WHERE tx ty tz", "s"},
      {"body-force", 4, "PATTERN body-force bx by", "pa"},
      {"body-force", 5, "PATTERN body-force bx by bz", "s"},
      {"displacement-x", 4, "PATTERN displacement-x WHERE u", "ps"},
      {"displacement-y", 4, "PATTERN displacement-y WHERE u", "ps"},
      {"displacement-r", 4, "PATTERN displacement-r WHERE u", "a"},
      {"displacement-z", 4, "PATTERN displacement-z WHERE u", "as"},
      {"temperature", 3, "PATTERN temperature T", "pas"},
      {"initial-strain", 3, "PATTERN initial-strain e, or xx yy xy zz", "pa"},
      {"initial-strain", 3, "PATTERN initial-strain e", "s"},
      {"traction-t", 4, "PATTERN traction-t WHERE t", "a"},
      {"twist", 4, "PATTERN twist WHERE angle", "a"}};
   const bool plane = body.formulation() == Formulation::plane,
              space = body.formulation() == Formulation::space;
   const char letter = plane ? 'p' : space ? 's' : 'a';
   for (const std::string &statement : split(text, ";\n"))
   {
      const std::string where = called + " '" + statement + "'";
      const std::vector<std::string> words = split(statement, " \t");
      require(words.size() >= 2, where, ": must be PATTERN KIND WHERE VALUES");
      const std::string &pattern = words[0];
      require_pattern_name(where, pattern);
      const Kind *kind = nullptr;
      std::vector<std::string> known;
      for (const Kind &k : kinds)
      {
         if (std::string(k.of).find(letter) == std::string::npos) { continue; }
         if (words[1] == k.name) { kind = &k; }
         known.push_back(k.name);
      }
      require(kind, where, ": kind '", words[1], "' is not one of ", listed(known),
              std::find(known.begin(), known.end(), pattern) == known.end()
                 ? ""
                 : ": a load begins with its name, as P " + pattern);
      const bool tensor = words[1] == "initial-strain" && words.size() == 6 && !space;
      require(words.size() == kind->words || tensor, where, ": has ", words.size(),
              " words, must be ", kind->form,
              words.size() > kind->words ? ": a function is one word, without spaces" : "");
      if (around(words[1]) != (body.formulation() == Formulation::torsion)) { continue; }
      const auto field = [&](std::size_t k)
      { return scalar_field(where, words[k], body.formulation()); };
      const std::string name = kind->name;
      if (name == "body-force" && space)
      {
         body.add_body_force(pattern, field(2), field(3), field(4));
      }
      else if (name == "body-force") { body.add_body_force(pattern, field(2), field(3)); }
      else if (tensor)
      {
         body.add_initial_strain(pattern, {field(2), field(3), field(4), field(5)});
      }
      else if (name == "initial-strain") { body.add_initial_strain(pattern, field(2)); }
      else if (name == "temperature")
      {
         require(!std::isnan(terms.expansion), where,
                 ": the body's coefficient of thermal expansion is not given, must be (key "
                 "'expansion' of a case)");
         const double expansion = terms.expansion;
         body.add_initial_strain(pattern,
                                 [expansion, T = field(2)](double x, double y, double z)
                                 { return expansion * T(x, y, z); });
      }
      else
      {
         const BoundaryPart part = boundary_part(where, words[2], terms);
         if (name == "pressure") { body.add_pressure(pattern, part, field(3)); }
         else if (name == "traction-t") { body.add_traction(pattern, part, field(3)); }
         else if (name == "twist") { body.add_displacement(pattern, part, 0, field(3)); }
         else if (name == "traction" && space)
         {
            body.add_traction(pattern, part, field(3), field(4), field(5));
         }
         else if (name == "traction") { body.add_traction(pattern, part, field(3), field(4)); }
         else
         {
            const char last = name.back();
            const int component = last == 'x' || last == 'r' ? 0 : space && last == 'z' ? 2 : 1;
            body.add_displacement(pattern, part, component, field(3));
         }
      }
   }
}

bool twists(const std::string &supports, const std::string &loads)
{
   const std::vector<std::string> held = split(supports, " ;\t\n"), all = split(loads, ";\n");
   return std::any_of(held.begin(), held.end(),
                      [](const std::string &statement)
                      {
                         const std::size_t colon = statement.rfind(':');
                         return colon != std::string::npos &&
                                statement.find('t', colon) != std::string::npos;
                      }) ||
          std::any_of(all.begin(), all.end(),
                      [](const std::string &statement)
                      {
                         const std::vector<std::string> words = split(statement, " \t");
                         return words.size() > 1 && around(words[1]);
                      });
}

} // namespace cattaneo
