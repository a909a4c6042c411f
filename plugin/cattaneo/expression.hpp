#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace cattaneo
{

/** A formula that a user writes: numbers, variables, pi, + - * / ^, brackets, and the functions
    abs, sqrt, exp, log, sin, cos, tan, atan, tanh, of two arguments min and max. A number
    before a variable multiplies it: 2x. InputError, with `called`, for a text that is no
    formula. */
class Expression
{
public:
   /// Reads a formula of these variables. Messages call the text `called`.
   Expression(const std::string &called, const std::string &text,
              const std::vector<std::string> &variables);

   /// The value for given variables, in their order. It may be infinite or NaN.
   double operator()(std::initializer_list<double> values) const
   {
      return value_(values.begin());
   }
   /// As it was written.
   const std::string &text() const { return text_; }

private:
   std::string text_;
   std::function<double(const double *)> value_;
};

} // namespace cattaneo
