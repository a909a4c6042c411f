#pragma once

#include <cstdio>
#include <gtest/gtest.h>
#include <string>

namespace cattaneo_test
{

/// A number of this test that docs/verification.md shows: printed, and in the JSON that gtest
/// writes, where tests/docs/check.py finds it by its name.
void record(const std::string &name, double value);

} // namespace cattaneo_test
