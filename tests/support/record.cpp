#include "record.hpp"

namespace cattaneo_test
{

void record(const std::string &name, double value)
{
   char text[32];
   std::snprintf(text, sizeof text, "%.12g", value);
   testing::Test::RecordProperty(name, text);
   std::printf("%s = %s\n", name.c_str(), text);
}

} // namespace cattaneo_test
