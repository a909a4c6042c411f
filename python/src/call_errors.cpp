// Errors of calls whose arguments do not fit: one sentence that names the argument.
//
// nanobind reports such errors in one place, by PyErr_SetString, as a list of signatures and
// types. The linker passes this text to functions of this file first (see CMakeLists.txt).

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <nanobind/nanobind.h>
#include <string>
#include <string_view>
#include <vector>

namespace
{

using Words = std::vector<std::string>;

std::string trimmed(std::string_view text)
{
   const std::size_t from = text.find_first_not_of(' '), to = text.find_last_not_of(" \n");
   return from == std::string_view::npos ? "" : std::string(text.substr(from, to + 1 - from));
}

/// Pieces between commas outside of brackets and quotes. The text ends at a closing bracket
/// that was not opened in it.
Words pieces(std::string_view text)
{
   Words all;
   std::string piece;
   int depth = 0;
   char quote = 0;
   for (const char c : text)
   {
      if (quote != 0) { quote = c == quote ? 0 : quote; }
      else if (c == '\'' || c == '"') { quote = c; }
      else if (c == '(' || c == '[' || c == '{') { ++depth; }
      else if (c == ')' || c == ']' || c == '}')
      {
         if (--depth < 0) { break; }
      }
      if (c != ',' || depth > 0 || quote != 0)
      {
         piece += c;
         continue;
      }
      all.push_back(trimmed(piece));
      piece.clear();
   }
   if (!trimmed(piece).empty()) { all.push_back(trimmed(piece)); }
   return all;
}

/// Types as users know them: without the names of modules.
std::string plain(const std::string &type)
{
   std::string made;
   for (std::size_t at = 0; at < type.size(); ++at)
   {
      made += type[at];
      const bool of_module =
         type[at] == '.' && at + 1 < type.size() && std::isalpha(type[at + 1]) != 0;
      if (of_module) { made.erase(made.find_last_of(" [|,(", made.size() - 2) + 1); }
   }
   return made == "NoneType"                         ? "None"
          : made == "nb_func" || made == "nb_method" ? "function"
                                                     : made;
}

/// The type of an argument.
struct Given
{
   std::string type;
   bool own = false; ///< a class of this package

   explicit Given(const std::string &full)
      : type(plain(full)), own(full.rfind("cattaneo.", 0) == 0)
   {
   }
};

struct Parameter
{
   std::string name, type;
   bool needed = true, by_name = false;
};

struct Signature
{
   std::string text; ///< of all parameters, without self
   std::vector<Parameter> parameters;
   bool any_name = false; ///< takes other names too
};

Signature signature_of(const std::string &line)
{
   Signature made;
   bool by_name = false;
   for (const std::string &piece : pieces(line.substr(line.find('(') + 1)))
   {
      made.any_name = made.any_name || piece.rfind("**", 0) == 0;
      if (piece == "*") { by_name = true; }
      if (piece[0] == '*' || piece == "/" || piece == "self") { continue; }
      const std::size_t colon = piece.find(':'), equal = piece.find(" = ");
      Parameter one{trimmed(piece.substr(0, std::min(colon, equal))), "",
                    equal == std::string::npos, by_name};
      if (colon != std::string::npos)
      {
         one.type = plain(trimmed(piece.substr(colon + 1, equal - colon - 1)));
      }
      made.text +=
         (made.text.empty() ? "" : ", ") + one.name + (one.type.empty() ? "" : ": " + one.type);
      made.parameters.push_back(one);
   }
   return made;
}

/// The alternatives of a type, as of "A | list[B | C] | None".
Words alternatives(const std::string &type)
{
   Words all(1);
   int depth = 0;
   for (const char c : type)
   {
      depth += c == '[' || c == '(' ? 1 : c == ']' || c == ')' ? -1 : 0;
      if (c == '|' && depth == 0) { all.emplace_back(); }
      else { all.back() += c; }
   }
   for (std::string &one : all) { one = trimmed(one); }
   return all;
}

/// Is it certain that no object of this type fits? None of this package's classes derives from
/// another one. Nothing is known of classes of other packages.
bool misfits(const std::string &needed, const Given &given)
{
   const Words all = alternatives(needed);
   if (all.size() > 1)
   {
      return std::all_of(all.begin(), all.end(),
                         [&](const std::string &one) { return misfits(one, given); });
   }
   const auto is_one_of = [&](std::initializer_list<const char *> types)
   { return std::find(types.begin(), types.end(), given.type) != types.end(); };
   const bool function = is_one_of({"function", "method", "builtin_function_or_method"}),
              known = given.own || function ||
                      is_one_of({"int", "float", "str", "bool", "list", "dict", "tuple", "set",
                                 "bytes", "None", "complex", "module"});
   if (!known || needed == "object" || needed == "Any") { return false; }
   if (needed == "float") { return !is_one_of({"int", "float", "bool"}); }
   if (needed == "int") { return !is_one_of({"int", "bool"}); }
   if (needed.rfind("Callable", 0) == 0) { return !function && !given.own; }
   if (needed == "ArrayLike" || needed.find('.') != std::string::npos) { return false; }
   const std::string outer = needed.substr(0, needed.find('['));
   if (outer == "Sequence" || outer == "list" || outer == "tuple")
   {
      return !is_one_of({"list", "tuple", "str", "bytes"});
   }
   if (outer == "Mapping" || outer == "dict") { return given.type != "dict"; }
   return needed != given.type;
}

/// The one sentence about a call that fits no signature.
std::string sentence(const std::string &message)
{
   const std::string invoked = "\nInvoked with types: ";
   const std::size_t at = message.find("(): incompatible function arguments"),
                     types = message.rfind(invoked);
   if (types == std::string::npos) { return message; }
   std::string name = message.substr(0, at);
   std::vector<Signature> signatures;
   bool method = false;
   for (std::size_t from = message.find('\n'); from < types;)
   {
      const std::size_t to = message.find('\n', from + 1);
      const std::string line = trimmed(message.substr(from + 1, to - from - 1));
      if (line.find('(') != std::string::npos)
      {
         signatures.push_back(signature_of(line));
         method = method || line.find("(self") != std::string::npos;
      }
      from = to;
   }
   std::vector<Given> given;
   std::vector<std::pair<std::string, Given>> named;
   for (const std::string &piece : pieces(message.substr(types + invoked.size())))
   {
      if (piece.rfind("kwargs = {", 0) != 0)
      {
         given.emplace_back(piece);
         continue;
      }
      for (const std::string &one : pieces(piece.substr(10)))
      {
         const std::size_t colon = one.find(':');
         named.emplace_back(trimmed(one.substr(0, colon)),
                            Given(trimmed(one.substr(colon + 1))));
      }
   }
   if (method && !given.empty())
   {
      name = name == "__init__" ? given[0].type : given[0].type + "." + name;
      given.erase(given.begin());
   }
   std::string must, has;
   for (const Signature &each : signatures)
   {
      must += (must.empty() ? "(" : " or (") + each.text + ")";
   }
   for (const Given &each : given) { has += (has.empty() ? "" : ", ") + each.type; }
   for (const auto &[key, each] : named)
   {
      has += (has.empty() ? "" : ", ") + key + ": " + each.type;
   }
   const std::string all = name + "(): the arguments are (" + has + "), must be " + must;
   if (signatures.size() != 1) { return all; }

   // One signature: the argument that does not fit is known.
   const Signature &one = signatures[0];
   std::size_t places = 0;
   while (places < one.parameters.size() && !one.parameters[places].by_name) { ++places; }
   if (given.size() > places)
   {
      return name + "(): " +
             (given.size() == 1 ? "there is 1 argument"
                                : "there are " + std::to_string(given.size()) + " arguments") +
             " without a name, must be " +
             (places == 0 ? "none" : "at most " + std::to_string(places) + ": " + must);
   }
   for (const auto &each : named)
   {
      const bool known = std::any_of(one.parameters.begin(), one.parameters.end(),
                                     [&](const Parameter &p) { return p.name == each.first; });
      if (!known && !one.any_name)
      {
         return name + "(): it has no argument '" + each.first + "', must be " + must;
      }
   }
   for (std::size_t k = 0; k < one.parameters.size(); ++k)
   {
      const Parameter &p = one.parameters[k];
      const auto its = std::find_if(named.begin(), named.end(),
                                    [&](const auto &each) { return each.first == p.name; });
      if (k >= given.size() && its == named.end())
      {
         if (p.needed)
         {
            return name + "(): argument '" + p.name + "' is missing" +
                   (p.type.empty() ? "" : ", must be of type " + p.type);
         }
         continue;
      }
      const Given &its_type = k < given.size() ? given[k] : its->second;
      if (misfits(p.type, its_type))
      {
         return name + "(): argument '" + p.name + "' is of type " + its_type.type +
                ", must be of type " + p.type;
      }
   }
   return all;
}

} // namespace

extern "C"
{
   void __real_PyErr_SetString(PyObject *type, const char *message);

   void __wrap_PyErr_SetString(PyObject *type, const char *message)
   {
      const std::string_view begins = "(): incompatible function arguments";
      if (type == PyExc_TypeError && message &&
          std::string_view(message).find(begins) != std::string_view::npos)
      {
         try
         {
            __real_PyErr_SetString(type, sentence(message).c_str());
            return;
         }
         catch (...) // nanobind's text is better than none
         {
         }
      }
      __real_PyErr_SetString(type, message);
   }

   PyObject *__wrap_PyErr_Format(PyObject *type, const char *format, ...)
   {
      va_list values;
      va_start(values, format);
      const bool no_constructor = std::string_view(format) == "%s: no constructor defined!";
      PyErr_FormatV(type,
                    no_constructor
                       ? "%s cannot be called: such objects are made by functions or static "
                         "methods, which help() of the class or of its module names"
                       : format,
                    values);
      va_end(values);
      return nullptr;
   }
}
