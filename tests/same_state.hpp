#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <gtest/gtest.h>

namespace cattaneo_test
{

/// Every field of two states, to the last bit.
inline void expect_same(const cattaneo::ContactState &a, const cattaneo::ContactState &b)
{
   EXPECT_EQ(a.v, b.v);
   EXPECT_EQ(a.w, b.w);
   EXPECT_EQ(a.q, b.q);
   EXPECT_EQ(a.p, b.p);
   EXPECT_EQ(a.slip_origin, b.slip_origin);
   EXPECT_EQ(a.status, b.status);
   EXPECT_EQ(a.multipliers, b.multipliers);
   EXPECT_EQ(a.time, b.time);
   EXPECT_EQ(a.step, b.step);
   EXPECT_EQ(a.peak_force, b.peak_force);
   EXPECT_EQ(a.dissipation, b.dissipation);
   EXPECT_EQ(a.cycle_slip, b.cycle_slip);
}

} // namespace cattaneo_test
