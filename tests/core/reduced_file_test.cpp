#include "comparison.hpp"
#include "expect_input_error.hpp"

#include <array>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <shakedown_problems.hpp>
#include <string>

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
   EXPECT_EQ(back.A(), problem.A());
   EXPECT_EQ(back.B(), problem.B());
   EXPECT_EQ(back.C(), problem.C());
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

/// Two nodes: the second may not slide, and both rise together without resistance. Every entry
/// has a value of its own. Matrices are written column by column.
const char *const fields = R"(
   "A": {"rows": 2, "cols": 2, "values": [2, 0, 0, 3]},
   "B": {"rows": 2, "cols": 2, "values": [0.5, -0.5, 0, 0]},
   "C": {"rows": 2, "cols": 2, "values": [7, -7, -7, 7]},
   "H": {"rows": 2, "cols": 2, "values": [1, 4, -4, 9]},
   "gap": {"rows": 2, "cols": 1, "values": [0.125, -0.25]},
   "friction": {"rows": 2, "cols": 1, "values": [0.3, 0.4]},
   "weights": {"rows": 2, "cols": 1, "values": [11, 12]},
   "arc_length": {"rows": 2, "cols": 1, "values": [21, 22]},
   "position": {"rows": 2, "cols": 2, "values": [31, 32, 33, 34]},
   "dofs": {"rows": 2, "cols": 4, "values": [41, 42, 43, 44, 45, 46, -1, 48]},
   "patterns": [
      {"name": "P", "displacement": false,
       "q": {"rows": 2, "cols": 1, "values": [51, 0]},
       "p": {"rows": 2, "cols": 1, "values": [53, 54]}},
      {"name": "d", "displacement": true,
       "q": {"rows": 2, "cols": 1, "values": [61, 0]},
       "p": {"rows": 2, "cols": 1, "values": [63, 64]}}])";
const char *const facts = R"(,
   "coupled": true,
   "held": [1],
   "chains": [
      {"interface": "left", "first": 0, "nodes": 1, "loop": true,
       "ends": ["smooth", "corner"], "other_ends": ["axis", "unknown"], "bodies": [1, 0]},
      {"interface": "right", "first": 1, "nodes": 1, "loop": false,
       "ends": ["unknown", "smooth"], "other_ends": ["corner", "axis"], "bodies": [0, -1]}])";
const char *const motion = R"(,
   "rigid_motions": {"rows": 4, "cols": 1,
                     "values": [0, 0, 0.70710678118654757, 0.70710678118654757]})";

std::string text(int format, const std::string &rest)
{
   return R"({"format": "cattaneo reduced problem )" + std::to_string(format) + "\"," + rest +
          "}";
}

ReducedProblem read(const std::string &content)
{
   const std::string file = ::testing::TempDir() + "reduced_file_test_text.json";
   std::ofstream(file) << content;
   return load_reduced_problem(file);
}

void expect_fields(const ReducedProblem &problem)
{
   using Eigen::Matrix2d, Eigen::Vector2d;
   EXPECT_EQ(problem.A(), (Matrix2d{{2, 0}, {0, 3}}));
   EXPECT_EQ(problem.B(), (Matrix2d{{0.5, 0}, {-0.5, 0}}));
   EXPECT_EQ(problem.C(), (Matrix2d{{7, -7}, {-7, 7}}));
   EXPECT_EQ(problem.H, (Matrix2d{{1, -4}, {4, 9}}));
   EXPECT_EQ(problem.gap, Vector2d(0.125, -0.25));
   EXPECT_EQ(problem.friction, Vector2d(0.3, 0.4));
   EXPECT_EQ(problem.weights, Vector2d(11, 12));
   EXPECT_EQ(problem.arc_length, Vector2d(21, 22));
   EXPECT_EQ(problem.position, (Matrix2d{{31, 33}, {32, 34}}));
   EXPECT_EQ(problem.dofs, (Eigen::Matrix<int, 2, 4>{{41, 43, 45, -1}, {42, 44, 46, 48}}));
   ASSERT_EQ(problem.patterns.size(), 2u);
   const LoadPattern &force = problem.patterns[0], &motion = problem.patterns[1];
   EXPECT_EQ(force.name, "P");
   EXPECT_EQ(force.control, Control::force);
   EXPECT_EQ(force.q, Vector2d(51, 0));
   EXPECT_EQ(force.p, Vector2d(53, 54));
   EXPECT_EQ(motion.name, "d");
   EXPECT_EQ(motion.control, Control::displacement);
   EXPECT_EQ(motion.q, Vector2d(61, 0));
   EXPECT_EQ(motion.p, Vector2d(63, 64));
   EXPECT_TRUE(problem.coupled);
}

void expect_facts(const ReducedProblem &problem)
{
   EXPECT_EQ(problem.held, std::vector<Eigen::Index>{1});
   ASSERT_EQ(problem.chains.size(), 2u);
   const auto ends = [](LineEnd a, LineEnd b) { return std::array<LineEnd, 2>{a, b}; };
   const ContactChain &left = problem.chains[0], &right = problem.chains[1];
   EXPECT_EQ(left.interface, "left");
   EXPECT_EQ(left.bodies, (std::array<int, 2>{1, 0}));
   EXPECT_EQ(right.bodies, (std::array<int, 2>{0, -1}));
   EXPECT_EQ(left.first, 0);
   EXPECT_EQ(left.nodes, 1);
   EXPECT_TRUE(left.loop);
   EXPECT_EQ(left.ends, ends(LineEnd::smooth, LineEnd::corner));
   EXPECT_EQ(left.other_ends, ends(LineEnd::symmetry, LineEnd::unknown));
   EXPECT_EQ(right.interface, "right");
   EXPECT_EQ(right.first, 1);
   EXPECT_EQ(right.nodes, 1);
   EXPECT_FALSE(right.loop);
   EXPECT_EQ(right.ends, ends(LineEnd::unknown, LineEnd::smooth));
   EXPECT_EQ(right.other_ends, ends(LineEnd::corner, LineEnd::symmetry));
}

TEST(ReducedFile, EveryFieldIsReadAndWrittenAgain)
{
   const std::string file = ::testing::TempDir() + "reduced_file_test_again.json";
   const auto again = [&](const ReducedProblem &problem)
   {
      save(problem, file);
      return load_reduced_problem(file);
   };
   const Eigen::Vector4d together(0, 0, std::sqrt(0.5), std::sqrt(0.5));
   const ReducedProblem present = read(text(2, std::string(fields) + facts + motion));
   for (const ReducedProblem &problem : {present, again(present)})
   {
      expect_fields(problem);
      expect_facts(problem);
      ASSERT_EQ(problem.rigid_motions.cols(), 1);
      EXPECT_LT((problem.rigid_motions - together).norm(), 1e-15);
   }
   // Held bodies have none.
   std::string held = fields;
   held.replace(held.find("[7, -7, -7, 7]"), 14, "[8, -7, -7, 7]");
   const ReducedProblem none = read(
      text(2, held + facts + R"(, "rigid_motions": {"rows": 4, "cols": 0, "values": []})"));
   for (const ReducedProblem &problem : {none, again(none)})
   {
      expect_facts(problem);
      EXPECT_EQ(problem.rigid_motions.rows(), 4);
      EXPECT_EQ(problem.rigid_motions.cols(), 0);
   }
   // The first format had no facts: the motion is found, and one chain is taken for granted.
   const ReducedProblem old = read(text(1, fields));
   expect_fields(old);
   EXPECT_TRUE(old.held.empty());
   for (const ReducedProblem &problem : {old, again(old)})
   {
      ASSERT_EQ(problem.chains.size(), 1u);
      EXPECT_EQ(problem.chains[0].first, 0);
      EXPECT_EQ(problem.chains[0].nodes, 2);
      EXPECT_EQ(problem.chains[0].bodies, (std::array<int, 2>{0, -1}));
      ASSERT_EQ(problem.rigid_motions.cols(), 1);
      EXPECT_LT((problem.rigid_motions * problem.rigid_motions.transpose() -
                 together * together.transpose())
                   .norm(),
                1e-14);
   }
   expect_input_error([&] { read(text(1, std::string(fields) + facts + motion)); },
                      "reduced problem 1' has the key '");
   save(present, file);
   std::string written;
   std::getline(std::ifstream(file), written, '\0');
   EXPECT_NE(written.find("\"cattaneo reduced problem 2\""), std::string::npos);
   EXPECT_EQ(written.back(), '\n');
}

TEST(ReducedFile, SaysWhichFactIsWrong)
{
   const std::string good = text(2, std::string(fields) + facts + motion);
   const auto refused =
      [&](const std::string &from, const std::string &to, const std::string &said)
   {
      std::string content = good;
      const auto at = content.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      content.replace(at, from.size(), to);
      expect_input_error([&] { read(content); }, said);
   };
   refused("problem 2", "problem 4",
           "with the value 'cattaneo reduced problem 2' (or its versions 1 or 3)");
   refused("problem 2", "problem 3", "lacks the key 'laws'");
   refused("\"held\": [1]", "\"held\": [1.0]", "a held row is 1.0, must be a whole number");
   refused("\"held\": [1]", "\"held\": [1, 1]", "row 1 of A is listed as held twice");
   refused("\"held\": [1]", "\"held\": [1], \"held\": [1]", "key 'held' is there twice");
   refused(", \"bodies\": [1, 0]", ", \"body\": 1, \"bodies\": [1, 0]",
           "a chain has the key 'body'");
   refused("\"displacement\": ", "\"dispalcement\": true, \"displacement\": ",
           "a load pattern has the key 'dispalcement'");
   refused("[\"smooth\", \"corner\"]", "[\"smooth\", \"bend\"]", "the end of a line is 'bend'");
   refused("\"held\": [1],", "", "held");
   refused("\"coupled\": true,", "", "coupled");
   refused("\"coupled\": true,", "\"coupled\": false,",
           "`coupled` is false, but B is not zero");
   refused("\"coupled\": true,", "\"coupled\": 1,", "is not a reduced problem");
   refused(", \"bodies\": [1, 0]", "", "bodies");
   refused("\"bodies\": [1, 0]", "\"bodies\": [1]", "is not a reduced problem");
   refused("\"bodies\": [1, 0]", "\"bodies\": [2, 2]", "of body 2 that faces body 2");
   refused("\"bodies\": [1, 0]", "\"bodies\": [-1, 0]", "of body -1 that faces body 0");
   refused("\"bodies\": [1, 0]", "\"bodies\": [0, -2]", "of body 0 that faces body -2");
   refused("\"bodies\": [1, 0]", "\"bodies\": [0, 2]", "of body 0 that faces body 2");
   refused("[0.125, -0.25]", "[0.125]", "1 entries for a matrix of 2×1");
   refused("{\"rows\": 2, \"cols\": 1, \"values\": [0.125, -0.25]}",
           "{\"rows\": 1, \"cols\": 1, \"values\": [0.125]}", "gap has 1 entries, must be 2");
   refused("rigid_motions", "rigid motions", "rigid_motions");
   refused("\"held\": [1]", "\"held\": [2]", "held row 2 of A, must be from 0 to 1");
   refused("\"held\": [1]", "\"held\": [-1]", "held row -1 of A");
   refused("\"held\": [1]", "\"held\": [0]", "row 0 of A is listed as held");
   refused("[61, 0]", "[61, 1]",
           "row 1 of A is listed as held, must be neither coupled nor loaded");
   refused("[0.5, -0.5, 0, 0]", "[0.5, -0.5, 1, -1]", "row 1 of A is listed as held");
   refused("[2, 0, 0, 3]", "[2, 0.1, 0.1, 3]", "row 1 of A is listed as held");
   refused("\"first\": 1", "\"first\": 0", "a chain of 1 nodes begins at node 0");
   refused("\"first\": 1, \"nodes\": 1", "\"first\": 1, \"nodes\": 0", "a chain of 0 nodes");
   refused("\"first\": 1, \"nodes\": 1", "\"first\": 1, \"nodes\": 2",
           "have 3 nodes, must have all 2");
   refused("\"rows\": 4, \"cols\": 1", "\"rows\": 2, \"cols\": 2",
           "rigid motions have 2 rows, must have 4");
   refused("0.70710678118654757]", "0.70710679]", "the rigid motions must be orthonormal");
   refused("[0, 0, 0.70710678118654757, 0.70710678118654757]", "[1, 0, 0, 0]",
           "a rigid motion causes forces of");
   refused("[0, 0, 0.70710678118654757, 0.70710678118654757]", "[0, 0, 1, 0]",
           "a rigid motion causes forces of");
   // Normal forces against it, tangential ones: of B alone, which is 0.5 beside C's 7.
   refused("[0.5, -0.5, 0, 0]", "[0.5, -0.4, 0, 0]", "a rigid motion causes forces of");
   refused("[11, 12]", "[11, 12, 13]", "3 entries for a matrix of 2×1");
   refused("[0.125, -0.25]", "[0.125, null]", "is not a reduced problem");
   refused("[0.3, 0.4]", "[0.3, -0.5]",
           "friction coefficient -0.5 at node 1, must not be negative");
   refused("[7, -7, -7, 7]", "[7, -7, -7, 0]", "diagonal of C is 0 at row 1");
   refused("[7, -7, -7, 7]", "[7, -7, -7.0001, 7]", "C is not symmetric");
   refused("\"rows\": 2, \"cols\": 2, \"values\": [1, 4, -4, 9]",
           "\"rows\": 1, \"cols\": 1, \"values\": [1]",
           "must have a row and a column for each of the 2 load patterns");
   const auto one_less = [&](const std::string &key, int columns, const std::string &values,
                             const std::string &fewer)
   {
      const auto entry = [&](int rows, const std::string &list)
      {
         return "\"" + key + "\": {\"rows\": " + std::to_string(rows) +
                ", \"cols\": " + std::to_string(columns) + ", \"values\": [" + list + "]}";
      };
      refused(entry(2, values), entry(1, fewer), key);
   };
   one_less("weights", 1, "11, 12", "11");
   one_less("arc_length", 1, "21, 22", "21");
   one_less("position", 2, "31, 32, 33, 34", "31, 33");
   one_less("dofs", 4, "41, 42, 43, 44, 45, 46, -1, 48", "41, 43, 45, -1");
   refused("\"name\": \"d\"", "\"name\": \"P\"", "two load patterns are named 'P'");
   refused("[51, 0]", "[51, 0, 0]", "3 entries for");
   refused("{\"rows\": 2, \"cols\": 1, \"values\": [53, 54]}",
           "{\"rows\": 1, \"cols\": 1, \"values\": [53]}",
           "p of pattern 'P' has 1 entries, must be 2");
}

TEST(ReducedFile, ProblemsWithoutFrictionOrWithTorsion)
{
   ReducedProblem smooth = shakedown_test::random_contact(3, 4, 2, true);
   smooth.set_stiffness({}, Eigen::MatrixXd(4, 0), smooth.C());
   for (LoadPattern &pattern : smooth.patterns) { pattern.q.resize(0); }
   const std::string file = ::testing::TempDir() + "reduced_file_test_components.json";
   save(smooth, file);
   const ReducedProblem back = load_reduced_problem(file);
   EXPECT_EQ(back.components(), 0);
   EXPECT_EQ(back.B().rows(), 4);
   EXPECT_EQ(back.C(), smooth.C());
   EXPECT_FALSE(back.coupled);
   ReducedProblem disc = shakedown_test::random_contact(3, 4, 2, true);
   const double large = 100 * disc.C().norm();
   disc.set_stiffness(large * Eigen::MatrixXd::Identity(8, 8),
                      disc.C() * Eigen::MatrixXd::Random(4, 8), disc.C()); // semidefinite
   for (LoadPattern &pattern : disc.patterns) { pattern.q = Eigen::VectorXd::Random(8); }
   save(disc, file);
   EXPECT_EQ(load_reduced_problem(file).components(), 2);
   EXPECT_EQ(load_reduced_problem(file).B(), disc.B());
}

TEST(ReducedFile, RefusesAProblemThatKeepsARigidMotionToItself)
{
   // Three nodes on springs between neighbours: all may slide, and all may open, together.
   const Eigen::Matrix3d springs{{1, -1, 0}, {-1, 2, -1}, {0, -1, 1}};
   const std::string file = ::testing::TempDir() + "reduced_file_motions.json";
   ReducedProblem problem;
   problem.set_stiffness(3 * springs, Eigen::Matrix3d::Zero(), 5 * springs);
   problem.H.resize(0, 0);
   save(problem, file);
   EXPECT_EQ(load_reduced_problem(file).rigid_motions.cols(), 2);
   const std::string whole = content(file);
   problem.rigid_motions = problem.rigid_motions.leftCols(1).eval();
   const std::string says =
      "it lists 1 rigid motions, must list all 2 that the stiffness does not resist";
   expect_input_error([&] { save(problem, file); }, says);
   EXPECT_EQ(content(file), whole);
   // As another program may have written it.
   nlohmann::json j = nlohmann::json::parse(whole);
   auto &motions = j["rigid_motions"];
   motions["cols"] = 1;
   motions["values"].erase(motions["values"].begin() + 6, motions["values"].end());
   std::ofstream(file) << j;
   expect_input_error([&] { load_reduced_problem(file); }, says);
}

/// Places in space and the rim of a surface come back; a file of before has neither, and is as
/// it was for lines.
TEST(ReducedFile, KeepsPlacesInSpaceAndTheRim)
{
   const std::string file = ::testing::TempDir() + "reduced_file_surface.json";
   ReducedProblem problem = shakedown_test::random_contact(1, 3, 2, false);
   save(problem, file);
   EXPECT_EQ(content(file).find("rim"), std::string::npos);
   EXPECT_TRUE(load_reduced_problem(file).rim.empty());
   problem.position = Eigen::Matrix3d{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
   problem.rim = {0, 2};
   save(problem, file);
   const ReducedProblem again = load_reduced_problem(file);
   EXPECT_EQ(again.position, problem.position);
   EXPECT_EQ(again.rim, problem.rim);
   nlohmann::json j = nlohmann::json::parse(content(file));
   j["rim"] = {0.5};
   std::ofstream(file) << j;
   expect_input_error([&] { load_reduced_problem(file); }, "a node of the rim is 0.5");
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

// Laws of friction in a file of format 2 would be passed over, as would any misspelt key.
TEST(ReducedFile, RefusesKeysThatItDoesNotKnow)
{
   const std::string file = ::testing::TempDir() + "reduced_file_test_keys.json";
   save(shakedown_test::random_contact(1, 2, 1, false), file);
   nlohmann::json j = nlohmann::json::parse(std::ifstream(file));
   for (const char *key : {"laws", "frictions"})
   {
      nlohmann::json with = j;
      with[key] = nlohmann::json::array();
      std::ofstream(file) << with;
      expect_input_error([&] { load_reduced_problem(file); },
                         "has the key '" + std::string(key) + "'");
   }
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
      save(good, file);
      expect_input_error([&] { save(bad, file); }, word);
      EXPECT_EQ(load_reduced_problem(file).gap, good.gap); // the good one is still there
   };
   refused("gap", [](ReducedProblem &p) { p.gap[1] = NAN; });
   refused("pattern 'caf\xe9'", [](ReducedProblem &p) { p.patterns[1].name = "caf\xe9"; });
   refused("interface 'caf\xe9'",
           [](ReducedProblem &p)
           {
              p.chains = one_chain(5);
              p.chains[0].interface = "caf\xe9";
           });
   refused("weights", [](ReducedProblem &p) { p.weights = Eigen::VectorXd::Ones(4); });
   refused("arc_length", [](ReducedProblem &p) { p.arc_length = Eigen::VectorXd::Ones(6); });
   refused(
      "arc_length of node 3 is 1, must be above that of the node before it in its chain, 2",
      [](ReducedProblem &p)
      {
         p.chains = one_chain(5);
         p.arc_length.resize(5);
         p.arc_length << 0, 1, 2, 1, 3;
      });
   refused("a load pattern has an empty name",
           [](ReducedProblem &p) { p.patterns[1].name = ""; });
   refused("position", [](ReducedProblem &p) { p.position = Eigen::MatrixXd::Ones(5, 4); });
   refused("dofs", [](ReducedProblem &p) { p.dofs = Eigen::MatrixXi::Zero(5, 3); });
   refused("two load patterns are named 'press'",
           [](ReducedProblem &p) { p.patterns[2].name = "press"; });
   refused("3 tangential components",
           [](ReducedProblem &p) {
              p.set_stiffness(Eigen::MatrixXd::Identity(15, 15), Eigen::MatrixXd::Zero(5, 15),
                              p.C());
           });
   // The same in a file, with one node that slides in three directions.
   const auto square = [](const char *name, int rows, int columns, const char *values)
   {
      return "\"" + std::string(name) + "\": {\"rows\": " + std::to_string(rows) +
             ", \"cols\": " + std::to_string(columns) + ", \"values\": [" + values + "]}";
   };
   std::string three = square("A", 3, 3, "1, 0, 0, 0, 1, 0, 0, 0, 1") + "," +
                       square("B", 1, 3, "0, 0, 0") + "," + square("C", 1, 1, "1") + "," +
                       square("H", 0, 0, "");
   for (const char *name : {"gap", "friction", "weights", "arc_length"})
   {
      three += "," + square(name, 1, 1, "0");
   }
   three += "," + square("position", 0, 0, "") + "," + square("dofs", 0, 0, "");
   expect_input_error([&] { read(text(1, three)); }, "3 tangential components");
   // Sizes whose product overflows to the number of entries.
   std::ofstream(file) << R"({"format": "cattaneo reduced problem 1",
      "A": {"rows": 4294967296, "cols": 4294967296, "values": []}})";
   EXPECT_THROW(load_reduced_problem(file), InputError);
}

// What the bodies' supports leave free is the same whether it is stated or sought in matrices
// that condensation has rounded. Entries are rounded to 1e-15 of the largest and the softest
// other motion meets more than 1e-5 of that: what is found is off by 1e-10 and less, and a
// motion that is another one by 1.
TEST(ReducedFile, MotionsThatProblemsStateAreFoundInTheirMatrices)
{
   const std::string folder = std::string(CATTANEO_SOURCE_DIR) + "/problems/";
   for (const char *name : {"bolt_row", "hertz", "lap_joint", "punch_on_half_plane",
                            "random_near_critical", "receding_strip", "square_punch", "wedge"})
   {
      const ReducedProblem stated = load_reduced_problem(folder + name + ".json");
      ReducedProblem found = stated;
      found.set_stiffness(stated.A(), stated.B(), stated.C());
      ASSERT_EQ(found.rigid_motions.cols(), stated.rigid_motions.cols()) << name;
      const Eigen::MatrixXd both =
         found.rigid_motions * (found.rigid_motions.transpose() * stated.rigid_motions);
      EXPECT_LT((both - stated.rigid_motions).norm(), 1e-9) << name;
   }
}

} // namespace
