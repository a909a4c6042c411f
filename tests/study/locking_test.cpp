#include "run_miniapp.hpp"

namespace
{

using cattaneo_test::run_miniapp;

TEST(Locking, LinearElementsAreWarnedOf)
{
   const std::string run =
      "--case meshes/dovetail.json --cycles 1 --set bodies.root.poisson=0.495 ";
   const auto linear = run_miniapp("contact", run + "--order 1"),
              quadratic = run_miniapp("contact", run + "--order 2");
   EXPECT_EQ(linear.code, 0) << linear.output;
   EXPECT_NE(linear.output.find("warning: linear elements lock"), std::string::npos);
   EXPECT_EQ(quadratic.output.find("lock"), quadratic.output.find("locks itself"));
   // A dovetail is keyed: above this friction it can stay where it was pulled to.
   const double locking = quadratic.results["critical_friction"]["locking"];
   EXPECT_GT(locking, 0.1);
   EXPECT_LE(locking, 1 + 1e-9); // tan 45° of its flank
}

} // namespace
