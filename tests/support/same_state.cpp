#include "same_state.hpp"

namespace cattaneo_test
{

void expect_same(const cattaneo::ContactState &a, const cattaneo::ContactState &b)
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
   ASSERT_EQ(a.cycle.has_value(), b.cycle.has_value());
   if (!a.cycle) { return; }
   EXPECT_EQ(a.cycle->cycle, b.cycle->cycle);
   EXPECT_EQ(a.cycle->whole, b.cycle->whole);
   EXPECT_EQ(a.cycle->dissipation, b.cycle->dissipation);
   EXPECT_EQ(a.cycle->external_work, b.cycle->external_work);
   EXPECT_EQ(a.cycle->normal_work, b.cycle->normal_work);
   EXPECT_EQ(a.cycle->slip_change, b.cycle->slip_change);
   EXPECT_EQ(a.cycle->node_dissipation, b.cycle->node_dissipation);
   ASSERT_EQ(a.cycle->loops.size(), b.cycle->loops.size());
   for (std::size_t k = 0; k < a.cycle->loops.size(); ++k)
   {
      EXPECT_EQ(a.cycle->loops[k].work(), b.cycle->loops[k].work());
      EXPECT_EQ(a.cycle->loops[k].force_range(), b.cycle->loops[k].force_range());
      EXPECT_EQ(a.cycle->loops[k].displacement_range(), b.cycle->loops[k].displacement_range());
   }
}

} // namespace cattaneo_test
