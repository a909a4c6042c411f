#include "expect_input_error.hpp"

void expect_input_error(const std::function<void()> &act, const std::string &part)
{
   try
   {
      act();
      ADD_FAILURE() << "no InputError; expected one that says '" << part << "'";
   }
   catch (const cattaneo::InputError &error)
   {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
   }
}
