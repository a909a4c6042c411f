#include <algorithm>
#include <gtest/gtest.h>
#include <string>

// A build without Ipopt has no limits and no designs: the tests of these say that they are
// skipped.

namespace
{

class WithoutIpopt : public testing::EmptyTestEventListener
{
   void OnTestStart(const testing::TestInfo &test) override
   {
      const char *const suites[] = {
         "CounterExample", "Design",    "FrictionLimit", "Limit",          "LoadLimit",
         "LowerLimit",     "Method2",   "LimitGradient", "LimitOfTheMesh", "ShakedownOfALaw",
         "ThesisLimits",   "Transient", "WeakDuality"};
      const std::string suite = test.test_suite_name();
      if (std::find(std::begin(suites), std::end(suites), suite) != std::end(suites))
      {
         GTEST_SKIP() << "built without Ipopt (CATTANEO_USE_IPOPT=OFF)";
      }
   }
};

// The list of listeners owns it.
const bool listens = []
{
   testing::UnitTest::GetInstance()->listeners().Append(new WithoutIpopt);
   return true;
}();

} // namespace
