#include "expect_input_error.hpp"
#include "small_problems.hpp"

#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/words.hpp>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;
using Words = std::vector<std::string>;

TEST(Words, PiecesOfATextAndBack)
{
   EXPECT_EQ(split(" a b;;\tc \n; ", ";"), (Words{"a b", "c"}));
   EXPECT_EQ(split("1, 2 3", ", "), (Words{"1", "2", "3"}));
   EXPECT_EQ(split("", ","), Words());
   EXPECT_EQ(listed({"a", "b c"}), "a, b c");
   EXPECT_EQ(listed({"a", "b"}, "; "), "a; b");
   EXPECT_EQ(listed({}), "");
}

// RFC 4180, 2.5 to 2.7.
TEST(Words, FieldsOfATable)
{
   EXPECT_EQ(csv_field("bolt 1 w = 1"), "bolt 1 w = 1");
   EXPECT_EQ(csv_field("bolt 1, w = 1"), "\"bolt 1, w = 1\"");
   EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
   EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
   EXPECT_EQ(csv_field(""), "");
}

TEST(Words, NumbersAreWholeWordsAndFinite)
{
   EXPECT_EQ(number("here", "-.5e1"), -5);
   EXPECT_EQ(number("here", "0"), 0);
   for (const char *word : {"", "x", "1x", "1,5", "1 2", "nan", "inf", "1e999"})
   {
      expect_input_error([&] { number("option --a", word); },
                         "option --a: '" + std::string(word) + "' is not a number");
   }
}

TEST(HistoryStatements, PointsKeepWhatIsNotNamed)
{
   const ReducedProblem problem = cattaneo_test::one_block(0.5);
   const LoadHistory history =
      load_history("history", "press=0; press=1 ;shear=.2, press=2\n; shear=-0.2", problem);
   EXPECT_EQ(history.times, Eigen::Vector4d(0, 1, 2, 3));
   EXPECT_EQ(history.multipliers,
             (Eigen::Matrix<double, 2, 4>{{0, 1, 2, 2}, {0, 0, 0.2, -0.2}}));
   EXPECT_EQ(history.cycle_start, -1);
   const LoadHistory all = load_history("history", "", problem);
   EXPECT_EQ(all.multipliers, (Eigen::Matrix2d{{0, 1}, {0, 1}}));
}

TEST(HistoryStatements, MistakesAreQuoted)
{
   const ReducedProblem problem = cattaneo_test::one_block(0.5);
   const auto refused = [&](const std::string &text, const std::string &part)
   { expect_input_error([&] { load_history("--history", text, problem); }, part); };
   refused("press=0; press", "--history 'press': 'press', must be PATTERN=number");
   refused("press=0; press=1x", "'press=1x': '1x' is not a number");
   refused("press=0; pres=1", "there is no load 'pres', must be one of: ");
   refused("press=0; press=1 press=2", "'press' is named twice");
   refused("press=1; press=2", "--history: press is 1 at the first point, must be 0, because "
                               "the bodies start without load: "
                               "begin with 'press=0'");
   refused("press=0", "--history has one point, must have two at least, as 'press=0; press=1'");
}

// Studies name loads "bolt 1, w = 1": in quotes every name can be said, and a quote within a
// name is a letter of it.
TEST(HistoryStatements, NamesInQuotes)
{
   ReducedProblem problem = cattaneo_test::one_block(0.5);
   problem.patterns[0].name = "bolt 1, w = 1; outer";
   problem.patterns[1].name = "a='2";
   const Eigen::Matrix<double, 2, 3> wanted{{0, 1, 2}, {0, 0.5, -0.5}};
   for (const char *text :
        {"'bolt 1, w = 1; outer'=0; \"a='2\"=0.5, 'bolt 1, w = 1; outer'=1;"
         "'bolt 1, w = 1; outer'=2 \"a='2\"=-0.5",
         "; ;'bolt 1, w = 1; outer'=0;\"bolt 1, w = 1; outer\"=1\t\"a='2\"=.5"
         ";\"a='2\"=-.5\n\"bolt 1, w = 1; outer\"=2"})
   {
      EXPECT_EQ(load_history("history", text, problem).multipliers, wanted) << text;
   }
   problem.patterns[1].name = "d'";
   EXPECT_EQ(load_history("history", "d'=0; d'=3", problem).multipliers(1, 1), 3);
   expect_input_error([&] { load_history("--history", "d'=0; 'bolt 1=1", problem); },
                      "the quote ' that begins a name is not closed");
   expect_input_error([&] { load_history("--history", "d'=0; 'bolt 1' 1", problem); },
                      "''bolt 1'', must be PATTERN=number");
}

} // namespace
