#pragma once

#include <cstdio>
#include <gtest/gtest.h>
#include <string>

namespace cattaneo_test
{

/// A number of this test that docs/verification.md shows: printed, and in the JSON that gtest
/// writes, where tests/docs/check.py finds it by its name.
inline void record(const std::string &name, double value)
{
   char text[32];
   std::snprintf(text, sizeof text, "%.12g", value);
   testing::Test::RecordProperty(name, text);
   std::printf("%s = %s\n", name.c_str(), text);
}

} // namespace cattaneo_test
