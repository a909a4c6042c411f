#include <cattaneo/core.hpp>
#include <gtest/gtest.h>
#include <sstream>

namespace
{

TEST(Version, TextAndNumbersAreOne)
{
   std::ostringstream text;
   text << CATTANEO_VERSION_MAJOR << '.' << CATTANEO_VERSION_MINOR << '.'
        << CATTANEO_VERSION_PATCH;
   EXPECT_EQ(text.str(), CATTANEO_VERSION);
}

} // namespace
