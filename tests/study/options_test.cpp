// Mistakes that can be made with any miniapp: one sentence that names the option, exit code 1
// and no file.

#include "study/run_miniapp.hpp"

#include <array>
#include <filesystem>
#include <fstream>

namespace
{

using cattaneo_test::run_miniapp;
namespace fs = std::filesystem;

const char *const programs[] = {"square_punch", "hertz",     "plane_receding",
                                "shakedown",    "lap_joint", "axisymmetric_receding"};

class Options : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "options";
      fs::remove_all(folder);
      fs::create_directories(folder);
   }
   void TearDown() override { fs::remove_all(folder); }

   void expect_refused(const std::string &program, const std::string &options,
                       const std::vector<std::string> &words) const
   {
      const auto run = run_miniapp(program, options);
      const std::string what = program + " " + options + "\n" + run.output;
      EXPECT_EQ(run.code, 1) << what;
      EXPECT_TRUE(run.results.is_null()) << what;
      EXPECT_TRUE(fs::is_empty(folder)) << what;
      const std::size_t at = run.output.find("error: ");
      ASSERT_NE(at, std::string::npos) << what;
      EXPECT_EQ(run.output.find('\n', at), run.output.size() - 1) << what;
      for (const std::string &word : words)
      {
         EXPECT_NE(run.output.find(word, at), std::string::npos) << word << ": " << what;
      }
   }

   std::string folder;
};

TEST_F(Options, NumbersAreNamedWithTheirOption)
{
   for (const char *program : programs)
   {
      expect_refused(program, "--friction abc", {"option --friction", "'abc'", "not a number"});
      expect_refused(program, "--friction 0,3", {"option --friction", "'0,3'", "not a number"});
      expect_refused(program, "--friction nan", {"option --friction", "'nan'"});
      expect_refused(program, "--friction ''", {"option --friction", "''", "not a number"});
      expect_refused(program, "--friction -0.5", {"option --friction", "-0.5"});
      expect_refused(program, "--order 1.5", {"option --order", "'1.5'", "an integer"});
      expect_refused(program, "--order 99999999999", {"option --order", "too large"});
      expect_refused(program, "--poisson -2", {"Poisson's ratio", "-2", "above -1"});
   }
   expect_refused("fretting", "-P abc", {"option -P", "'abc'", "not a number"});
   expect_refused("fretting", "-nodes 1.5", {"option -nodes", "'1.5'", "an integer"});
   // -1 is no longer "as the obstacle has it".
   expect_refused("square_punch", "--friction -1", {"option --friction", "-1"});
}

TEST_F(Options, EveryOptionHasAValue)
{
   for (const char *program : programs)
   {
      expect_refused(program, "--save --order 2", {"option --save has no value"});
      expect_refused(program, "--friction --order 2", {"option --friction has no value"});
   }
   expect_refused("fretting", "--plot -P 3", {"option --plot has no value"});
   expect_refused("hertz", "-friction 0.1 --friction 0.2", {"option --friction", "twice"});
}

/// An option that the chosen way of running does not use would change nothing, without a word.
TEST_F(Options, WhatARunDoesNotUseIsRefused)
{
   for (const auto &[program, options, option, with] : std::vector<std::array<std::string, 4>>{
           {"hertz", "--sweep-results half_width", "--sweep-results", "--sweep"},
           {"march", "-reduced problems/hertz.json -frames all", "--frames", "--csv"},
           {"march", "-reduced problems/hertz.json -max-sweeps 7", "--max-sweeps", "--method"},
           {"axisymmetric_receding", "-critical-bonded", "--critical-bonded", "--critical"},
           {"axisymmetric_receding", "-map-friction 0.5", "--map-friction", "--map"},
           {"axisymmetric_receding", "-amplitude 0.5", "--amplitude", "--cycles"},
           {"axisymmetric_receding", "-load-cycles 5", "--load-cycles", "--cycle-to"},
           {"axisymmetric_receding", "-twist rim", "--twist", "--torque"},
           {"plane_receding", "-map-friction 0.5", "--map-friction", "--map"},
           {"plane_receding", "-cycles 5", "--cycles", "--cycle-to"},
           {"square_punch", "-amplitude 0.5", "--amplitude", "--cycles"},
           {"lap_joint", "-sweep-friction 0.5", "--sweep-friction", "--sweep-load"},
           {"lap_joint", "-frames 3", "--frames", "--paraview"},
           {"fretting", "-p fe -findley 0.2", "--findley", "--averaging-depth"},
           {"lap_joint", "-snug 0.1", "--snug", "--bolts"},
           {"shakedown", "-reduced problems/square_punch.json -nodes 51", "--nodes", "punch"},
           {"shakedown", "-mismatch-poisson 0.2", "--mismatch-poisson", "--mismatch"},
           {"shakedown", "-reversal -1 -lambda-min -0.2", "--lambda-min", "--reversal"}})
   {
      expect_refused(program, options, {"option " + option + " does nothing", with});
   }
}

/// Nothing is computed for what would then not be written or shown.
TEST_F(Options, EmptyNamesAndScenesThatAreNoneAreRefused)
{
   for (const char *written : {"--json", "--csv", "--html", "--plot", "--save"})
   {
      expect_refused("hertz", std::string(written) + " ''", {written, "is empty"});
   }
   for (const char *program : {"design", "wear", "fretting", "fretting -p fe"})
   {
      const std::string words = program;
      const std::size_t end = std::min(words.find(' '), words.size());
      expect_refused(words.substr(0, end), words.substr(end) + " --check",
                     {"option --check", "no scene of meshes"});
   }
   expect_refused("lap_joint", "--bolts 100000", {"--bolts", "contact nodes", "20000"});
   expect_refused("lap_joint", "-spacing 0.05 --cycles 2147483647", {"cycles", "at most"});
}

/// -h lists every option with both its names and what it is, and nothing is computed.
TEST_F(Options, HelpListsThem)
{
   const auto run = run_miniapp("fretting", "-P 300 -h");
   EXPECT_EQ(run.code, 0);
   EXPECT_TRUE(run.results.is_null());
   for (const char *words :
        {"-P, --normal-load <number>, default 400", "-f, --friction <number>\n",
         "-p, --pad <hertz|flat-rounded|fe|kn>, default hertz",
         "-ps, --plane-stress or -no-ps, --plane-strain\n", "--json <text>"})
   {
      EXPECT_NE(run.output.find(words), std::string::npos) << words << "\n" << run.output;
   }
}

TEST_F(Options, FilesAreCheckedBeforeTheWork)
{
   const std::string none = "'" + folder + "/none/x";
   for (const char *program : programs)
   {
      expect_refused(program, "--save " + none + "'", {"option --save", "no folder"});
      expect_refused(program, "--save '" + folder + "'",
                     {"option --save", "a folder of that name"});
   }
   const std::string endless(300, 'x');
   for (const std::string option : {"save", "csv", "plot", "html"})
   {
      expect_refused("hertz", "--" + option + " " + endless,
                     {"option --" + option, "File name too long"});
   }
   expect_refused("contact", "--case meshes/dovetail.json --paraview " + endless,
                  {"option --paraview", "File name too long"});
   expect_refused("contact", "--case meshes/dovetail.json --set bodies.root.mesh=" + endless,
                  {"mesh file cannot be read"});
   for (const std::string program : {"fretting", "contact", "shakedown", "lap_joint", "hertz",
                                     "square_punch", "plane_receding", "axisymmetric_receding"})
   {
      const std::string what = program == "contact" ? "--case meshes/dovetail.json " : "";
      expect_refused(program, what + "--csv " + none + "'", {"option --csv", "no folder"});
      expect_refused(program, what + "--plot " + none + ".png'",
                     {"option --plot", "no folder"});
      expect_refused(program, what + "--plot '" + folder + "/x.xyz'",
                     {"option --plot", ".png"});
   }
   expect_refused("fretting", "--young 210000", {"option --young", "210000", "GPa, not MPa"});
   expect_refused("fretting", "--threshold -1", {"option --threshold", "-1", "positive"});
   expect_refused("lap_joint", "--paraview meshes/README.md/fields",
                  {"option --paraview", "no folder"});
   const std::string save = " --save '" + testing::TempDir();
   expect_refused("hertz", save + "hertz.json'", {"--json", "--save", "name another"});
   // What would write over a table of the run, or write nothing.
   const std::string csv = "--csv '" + folder + "/t' ";
   expect_refused("hertz", csv + "--save '" + folder + "/t_pressure.csv'",
                  {"option --save", "t_pressure.csv", "tables of option --csv"});
   expect_refused("fretting", save + "none.json'", {"--save", "no reduced problem"});
   expect_refused("hertz", "--check" + save + "none.json'", {"--save", "--check stops before"});
}

/// Every study takes a case file: by the long names of its options, overridden by the command
/// line; what is written is no part of a case.
TEST_F(Options, EveryStudyTakesACaseFile)
{
   const auto write = [&](const char *text)
   {
      const std::string file = testing::TempDir() + "study_case.json";
      std::ofstream(file) << text;
      return "--case '" + file + "'";
   };
   const auto run =
      run_miniapp("square_punch", write(R"({"obstacle": "half-plane", "nodes": 33, "shear":
                                            [0.25, 0.75], "friction": 0.3})") +
                                     " --friction 0.4");
   ASSERT_EQ(run.code, 0) << run.output;
   EXPECT_EQ(run.results["contact_nodes"], 33);
   EXPECT_EQ(run.results["friction"], 0.4);
   ASSERT_EQ(run.results["levels"].size(), 2u);
   EXPECT_EQ(run.results["levels"][1]["shear"], 0.75);
   const auto without = run_miniapp("square_punch", write(R"({"nodes": 33, "shear": "none"})"));
   ASSERT_EQ(without.code, 0) << without.output;
   EXPECT_TRUE(without.results["levels"].empty()) << without.results["levels"];
   expect_refused("square_punch", write(R"({"shear": "some"})"),
                  {"key 'shear'", "some", "array of numbers", "none"});
   for (const char *program : programs)
   {
      expect_refused(program, write(R"({"friction": "much"})"), {"key 'friction'", "a number"});
      expect_refused(program, write(R"({"friction": -1})"), {"option --friction", "-1"});
      expect_refused(program, write(R"({"json": "x.json"})"), {"unknown key 'json'"});
   }
   expect_refused("fretting", write(R"({"pad": "ball"})"), {"option --pad", "'ball'", "hertz"});
   expect_refused("hertz", write(R"({"body": 3})"), {"key 'body'", "3", "a string"});
}

/// --plot FILE of every study, in every format, is a picture and leaves nothing else behind.
TEST_F(Options, EveryStudyDrawsAPicture)
{
   const std::string reduced = testing::TempDir() + "drawn.json";
   const std::pair<const char *, std::string> runs[] = {
      {"square_punch", "-nodes 33 -save '" + reduced + "'"},
      {"shakedown", "-nodes 17 -cycles 3"},
      {"shakedown", "-find load -friction 0.8 -cycles 3 -reduced '" + reduced + "'"},
      {"hertz", "-nodes 33"},
      {"plane_receding", "-spacing 0.1 -corner 0.02"},
      {"axisymmetric_receding", "-spacing 0.1"},
      {"lap_joint", "-spacing 0.05 -increments 5"},
      {"contact", "--case meshes/rounded_punch.json --cycles 1"},
      {"march", "-case problems/sliders.case.json"},
      {"fretting", "-Q 50"}};
   std::size_t pictures = 0;
   for (const auto &[program, options] : runs)
   {
      const char *types[] = {".png", ".pdf", ".svg"};
      const std::string picture = folder + "/" + std::to_string(pictures) + types[pictures % 3];
      ++pictures;
      const auto run = run_miniapp(program, options + " --plot '" + picture + "'");
      EXPECT_EQ(run.code, 0) << program << " " << options << "\n" << run.output;
      EXPECT_TRUE(fs::exists(picture) && fs::file_size(picture) > 5000) << picture;
      EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), pictures) << program;
   }
}

TEST_F(Options, ListsAndChoicesSayWhatIsAllowed)
{
   expect_refused("lap_joint", "--bolts '0 0'", {"option --bolts", "two bolts at 0"});
   expect_refused("lap_joint", "--bolts ''", {"option --bolts"});
   expect_refused("lap_joint", "--remote -1", {"option --remote is -1"});
   expect_refused("lap_joint", "--sweep-load 0.01 --sweep-friction -1",
                  {"option --sweep-friction", "-1"});
   expect_refused("lap_joint", "--sweep-load 0.02 --sweep-width 0",
                  {"--sweep-width", "0", "positive"});
   expect_refused("plane_receding", "--length 1", {"--overhang", "4", "length 1"});
   expect_refused("plane_receding", "--length -1", {"--length", "-1"});
   expect_refused("plane_receding", "--unload 0.5 --slip 99", {"--slip", "99", "on the strip"});
   expect_refused("plane_receding", "--map 4 --map-friction ''", {"--map-friction"});
   expect_refused("plane_receding", "--map 4 --map-friction -1", {"--map-friction", "-1"});
   expect_refused("shakedown", "--lambda-max 0.2 --lambda-min 0.5",
                  {"--lambda-min", "0.5", "0.2"});
   expect_refused("shakedown", "--reversal 2", {"--reversal", "2", "-1 and 1"});
   expect_refused("shakedown", "--held Q", {"--held", "--cycled", "'Q'"});
}

} // namespace
