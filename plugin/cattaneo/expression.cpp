#include <algorithm>
#include <cattaneo/expression.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>

namespace cattaneo
{

namespace
{

using Value = std::function<double(const double *)>;

/// Reads a formula from its left to its right.
class Parser
{
public:
   Parser(const std::string &called, const std::string &text,
          const std::vector<std::string> &variables)
      : called_(called), text_(text), variables_(variables)
   {
   }
   Value all()
   {
      const Value value = sum();
      check(at_ == text_.size());
      return value;
   }

private:
   void check(bool condition) const
   {
      require(condition, called_, ": '", text_, "' is not a number or a function of ",
              listed(variables_, " and "), " such as 1-3*", variables_[0], "+2*sqrt(",
              variables_.back(), ")");
   }
   char next()
   {
      while (at_ < text_.size() && text_[at_] == ' ') { ++at_; }
      return at_ < text_.size() ? text_[at_] : '\0';
   }
   bool takes(char c)
   {
      if (next() != c) { return false; }
      ++at_;
      return true;
   }
   Value sum()
   {
      Value left = product();
      for (;;)
      {
         const bool plus = takes('+');
         if (!plus && !takes('-')) { return left; }
         left = [left = std::move(left), right = product(),
                 sign = plus ? 1 : -1](const double *x) { return left(x) + sign * right(x); };
      }
   }
   Value product()
   {
      Value left = signed_power();
      for (;;)
      {
         // A number before a name multiplies it.
         const bool beside = after_number_ && std::isalpha(static_cast<unsigned char>(next()));
         if (beside || takes('*'))
         {
            left = [left = std::move(left), right = signed_power()](const double *x)
            { return left(x) * right(x); };
         }
         else if (takes('/'))
         {
            left = [left = std::move(left), right = signed_power()](const double *x)
            { return left(x) / right(x); };
         }
         else { return left; }
      }
   }
   Value signed_power()
   {
      check(++count_ <
            1000); // also limits nested brackets, so that the stack does not overflow
      if (takes('+')) { return signed_power(); }
      if (takes('-'))
      {
         return [value = signed_power()](const double *x) { return -value(x); };
      }
      Value base = single();
      if (!takes('^')) { return base; }
      return [base, exponent = signed_power()](const double *x)
      { return std::pow(base(x), exponent(x)); };
   }
   /// A number, a variable, a function or an expression in brackets.
   Value single()
   {
      after_number_ = false;
      const char first = next();
      if (takes('('))
      {
         const Value inside = sum();
         check(takes(')'));
         after_number_ = false;
         return inside;
      }
      if (std::isdigit(static_cast<unsigned char>(first)) || first == '.')
      {
         char *end = nullptr;
         const double number = std::strtod(text_.c_str() + at_, &end);
         const auto length = static_cast<std::size_t>(end - text_.c_str()) - at_;
         const bool hexadecimal =
            length > 1 && std::tolower(static_cast<unsigned char>(text_[at_ + 1])) == 'x';
         check(length > 0 && std::isfinite(number) && !hexadecimal);
         at_ += length;
         after_number_ = true;
         return [number](const double *) { return number; };
      }
      return named();
   }
   Value named()
   {
      const std::size_t from = at_;
      while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_])))
      {
         ++at_;
      }
      const std::string name = text_.substr(from, at_ - from);
      const auto variable = std::find(variables_.begin(), variables_.end(), name);
      if (variable != variables_.end())
      {
         return [k = variable - variables_.begin()](const double *x) { return x[k]; };
      }
      if (name == "pi")
      {
         return [](const double *) { return std::acos(-1.0); };
      }
      using One = double (*)(double);
      static const std::map<std::string, One> of_one = {{"abs", [](double x) { return std::abs(x); }},
                                                        {"sqrt", [](double x) { return std::sqrt(x); }},
                                                        {"exp", [](double x) { return std::exp(x); }},
                                                        {"log", [](double x) { return std::log(x); }},
                                                        {"sin", [](double x) { return std::sin(x); }},
                                                        {"cos", [](double x) { return std::cos(x); }},
                                                        {"tan", [](double x) { return std::tan(x); }},
                                                        {"atan", [](double x) { return std::atan(x); }},
                                                        {"tanh", [](double x) { return std::tanh(x); }}};
      const auto function = of_one.find(name);
      check((function != of_one.end() || name == "min" || name == "max") && takes('('));
      const Value argument = sum();
      Value result;
      if (function != of_one.end())
      {
         result = [f = function->second, argument](const double *x) { return f(argument(x)); };
      }
      else
      {
         check(takes(','));
         result = [argument, second = sum(), least = name == "min"](const double *x)
         {
            const double a = argument(x), b = second(x);
            return least == (a < b) ? a : b;
         };
      }
      check(takes(')'));
      after_number_ = false;
      return result;
   }

   const std::string &called_, &text_;
   const std::vector<std::string> &variables_;
   std::size_t at_ = 0;
   int count_ = 0;
   bool after_number_ = false;
};

} // namespace

Expression::Expression(const std::string &called, const std::string &text,
                       const std::vector<std::string> &variables)
   : text_(text), value_(Parser(called, text, variables).all())
{
}

} // namespace cattaneo
