#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>

namespace
{

using namespace cattaneo;

TEST(ReducedFile, RestoresEveryBit)
{
   ReducedProblem problem = shakedown_test::random_contact(1, 5, 2, true);
   problem.patterns[1].control = Control::displacement;
   problem.weights = Eigen::VectorXd::Constant(5, 1.0 / 3);
   problem.dofs = Eigen::MatrixXi::Random(5, 4);
   const std::string file = ::testing::TempDir() + "reduced_file_test.json";
   save(problem, file);
   const ReducedProblem back = load_reduced_problem(file);
   EXPECT_EQ(back.A, problem.A);
   EXPECT_EQ(back.B, problem.B);
   EXPECT_EQ(back.C, problem.C);
   EXPECT_EQ(back.H, problem.H);
   EXPECT_EQ(back.gap, problem.gap);
   EXPECT_EQ(back.friction, problem.friction);
   EXPECT_EQ(back.weights, problem.weights);
   EXPECT_EQ(back.dofs, problem.dofs);
   EXPECT_EQ(back.arc_length.size(), 0);
   ASSERT_EQ(back.patterns.size(), problem.patterns.size());
   for (std::size_t k = 0; k < back.patterns.size(); ++k)
   {
      EXPECT_EQ(back.patterns[k].name, problem.patterns[k].name);
      EXPECT_EQ(back.patterns[k].control, problem.patterns[k].control);
      EXPECT_EQ(back.patterns[k].q, problem.patterns[k].q);
      EXPECT_EQ(back.patterns[k].p, problem.patterns[k].p);
   }
}

TEST(ReducedFile, RefusesWhatItDidNotWrite)
{
   const std::string file = ::testing::TempDir() + "reduced_file_test_bad.json";
   EXPECT_THROW(load_reduced_problem(file + ".missing"), InputError);
   for (const char *text : {"", "{}", "[1, 2]", R"({"format": "something else"})",
                            R"({"format": "cattaneo reduced problem 1", "A": 3})"})
   {
      std::ofstream(file) << text;
      EXPECT_THROW(load_reduced_problem(file), InputError) << text;
   }
   EXPECT_THROW(save(shakedown_test::random_contact(1, 2, 1, false), "/nonexistent/x.json"),
                InputError);
}

TEST(ReducedFile, RefusesWhatIsNoProblem)
{
   const ReducedProblem good = shakedown_test::random_contact(1, 5, 1, false);
   const std::string file = ::testing::TempDir() + "reduced_file_test_wrong.json";
   const auto refused =
      [&](const char *word, const std::function<void(ReducedProblem &)> &spoil)
   {
      ReducedProblem bad = good;
      spoil(bad);
      save(bad, file);
      try
      {
         load_reduced_problem(file);
         ADD_FAILURE() << "not refused: " << word;
      }
      catch (const InputError &error)
      {
         EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      }
   };
   refused("weights", [](ReducedProblem &p) { p.weights = Eigen::VectorXd::Ones(4); });
   refused("arc_length", [](ReducedProblem &p) { p.arc_length = Eigen::VectorXd::Ones(6); });
   refused("position", [](ReducedProblem &p) { p.position = Eigen::MatrixXd::Ones(5, 3); });
   refused("dofs", [](ReducedProblem &p) { p.dofs = Eigen::MatrixXi::Zero(5, 3); });
   refused("two load patterns are named 'press'",
           [](ReducedProblem &p) { p.patterns[2].name = "press"; });
   refused("3 tangential components",
           [](ReducedProblem &p)
           {
              p.A = Eigen::MatrixXd::Identity(15, 15);
              p.B = Eigen::MatrixXd::Zero(5, 15);
           });
   // Sizes whose product overflows to the number of entries.
   std::ofstream(file) << R"({"format": "cattaneo reduced problem 1",
      "A": {"rows": 4294967296, "cols": 4294967296, "values": []}})";
   EXPECT_THROW(load_reduced_problem(file), InputError);
}

} // namespace
