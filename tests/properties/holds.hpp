#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <string>

namespace cattaneo_test
{

/// A property holds in so many random cases (in proportion more if RC_PARAMS has a max_success
/// above its default of 100); if not, the test fails with the smallest case that was found.
template <class Property>
void expect_holds(int cases, Property &&property)
{
   namespace rapid = rc::detail;
   rapid::TestParams params = rapid::configuration().testParams;
   params.maxSuccess = std::max(1, cases * params.maxSuccess / 100);
   rapid::TestMetadata metadata;
   metadata.id = testing::UnitTest::GetInstance()->current_test_info()->name();
   metadata.description = metadata.id;
   const rapid::TestResult result =
      rapid::checkTestable(std::forward<Property>(property), metadata, params);
   if (result.is<rapid::SuccessResult>()) { return; }
   std::ostringstream message;
   rapid::printResultMessage(result, message);
   FAIL() << message.str();
}

/// Runs a check. What fails is written by `write(file)`, over the larger cases that failed
/// before it, so that in the end the file holds the smallest; its path is in the message.
inline void keep_if_it_fails(const std::string &extension, const std::function<void()> &check,
                             const std::function<void(const std::string &)> &write)
{
   std::string why;
   try
   {
      return check();
   }
   catch (const rc::detail::CaseResult &result)
   {
      if (result.type != rc::detail::CaseResult::Type::Failure) { throw; }
      why = result.description;
   }
   catch (const std::exception &error)
   {
      why = error.what();
   }
   const auto *test = testing::UnitTest::GetInstance()->current_test_info();
   const std::string file = (std::filesystem::current_path() / "failed_").string() +
                            test->test_suite_name() + "_" + test->name() + extension;
   write(file);
   RC_FAIL(why + "\nThe case is in " + file);
}

/// Integers from -most to most, the smaller the simpler.
inline rc::Gen<int> around_zero(int most)
{
   return rc::gen::map(rc::gen::inRange(0, 2 * most + 1),
                       [](int k) { return k % 2 ? -(k + 1) / 2 : k / 2; });
}

} // namespace cattaneo_test
