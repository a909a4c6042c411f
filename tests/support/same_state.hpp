#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <gtest/gtest.h>

namespace cattaneo_test
{

/// Every field of two states, to the last bit.
void expect_same(const cattaneo::ContactState &a, const cattaneo::ContactState &b);

} // namespace cattaneo_test
