// Random case files of contact2d: what docs/contact2d.md allows runs, and a single mistake is
// refused by one sentence that names its key, with nothing written.

#include "holds.hpp"
#include "study/run_miniapp.hpp"

#include <cattaneo/mesh/graded_mesh.hpp>

namespace
{

using namespace cattaneo_test;
using nlohmann::json;
namespace fs = std::filesystem;
using rc::gen::inRange;

/// A folder with two meshes of a few elements each, a block and a wider one below it.
class CaseFileProperties : public testing::Test
{
protected:
   void SetUp() override
   {
      folder = testing::TempDir() + "cattaneo_case_files_" + std::to_string(getpid());
      fs::create_directories(folder + "/out");
      cattaneo::rectangle_mesh({-1, 0, 1}, {0, 1}).Save(folder + "/upper.mesh");
      cattaneo::rectangle_mesh({-1, 0, 1}, {-1, 0}).Save(folder + "/lower.mesh");
   }
   void TearDown() override { fs::remove_all(folder); }

   /// Keys that are needed, and a random choice of the others.
   static json random_case()
   {
      json j = {{"mesh1", "upper.mesh"}, {"contact1", "1"}};
      const auto choose = [&](const char *key, const std::vector<json> &values)
      { j[key] = values[*inRange<std::size_t>(0, values.size()).as(key)]; };
      const auto perhaps = [&](const char *key, const std::vector<json> &values)
      {
         if (*inRange(0, 2).as(std::string("has ") + key)) { choose(key, values); }
      };
      choose("load1", {"P pressure 3 1",
                       {"P pressure 3 2-x", "P traction 3[-2<x<2] 0.1 0"},
                       "P body-force 0 -1",
                       "P displacement-y 3 -0.01"});
      choose("support1", {"3:x", json::array({"3:x"}), "@0,1:x"});
      if (*inRange(0, 2).as("two bodies"))
      {
         j["mesh2"] = "lower.mesh";
         j["contact2"] = "3";
         j["support2"] = "1:xy";
         perhaps("young2", {2, 0.5, json::array({3})});
         perhaps("poisson2", {0, 0.25, json::array({0.4})});
         perhaps("load2", {"B body-force 0 -0.1", json::array({"T traction 2 1 0"})});
      }
      perhaps("young1", {1, 10.5, json::array({2})});
      perhaps("poisson1", {0, 0.3, json::array({0.45})});
      perhaps("order", {1, 2, 3});
      perhaps("plane-stress", {true, false});
      perhaps("friction", {0, 0.2, 0.5});
      perhaps("gap", {"geometry", "closed"});
      perhaps("pairing", {1e-6, 0.1});
      perhaps("increments", {1, 3});
      perhaps("stepping", {"advancing", "fixed", "exact"});
      if (*inRange(0, 2).as("cycle"))
      {
         choose("history", {"P=0; P=1; P=0.5; P=1", {"P=0", "P=1", "P=2", "P=1"}});
         j["cycle-start"] = 1;
         perhaps("cycles", {1, 2});
      }
      return j;
   }

   cattaneo_test::Run run(const json &j) const
   {
      // Of the case before, which may have failed, nothing is left.
      fs::remove_all(folder + "/out");
      fs::create_directories(folder + "/out");
      std::ofstream(folder + "/case.json") << j.dump(3);
      return run_miniapp("contact2d", "--case '" + folder + "/case.json' --csv '" + folder +
                                         "/out/t' --paraview '" + folder +
                                         "/out/fields' --save '" + folder + "/out/p.json'");
   }

   /// Checks a case, which is kept if it fails.
   static void check(const json &j, const std::function<void()> &act)
   {
      keep_if_it_fails(".json", act,
                       [&](const std::string &file) { std::ofstream(file) << j.dump(3); });
   }

   std::string folder;
};

TEST_F(CaseFileProperties, ValidOnesRun)
{
   expect_holds(10,
                [&]
                {
                   const json j = random_case();
                   check(j,
                         [&]
                         {
                            const cattaneo_test::Run result = run(j);
                            RC_LOG(result.output);
                            RC_ASSERT(result.code == 0);
                            RC_ASSERT(result.results["status"] == "converged");
                            RC_ASSERT(fs::file_size(folder + "/out/t_history.csv") > 0u);
                            RC_ASSERT(fs::file_size(folder + "/out/p.json") > 0u);
                            RC_ASSERT(fs::exists(folder + "/out/fields/body1/body1.pvd"));
                         });
                });
}

/// A key, a value that it must not have, and what names it where its own name does not.
struct Mistake
{
   const char *key;
   json value;
   const char *says = nullptr;
};

TEST_F(CaseFileProperties, SingleMistakesAreNamedAndNothingIsWritten)
{
   const std::vector<Mistake> mistakes = {{"yung1", 1},
                                          {"Friction", 0.1},
                                          {"json", "r.json"},
                                          {"", 0},
                                          {"mesh1", 3},
                                          {"mesh1", "no.mesh", "no.mesh"},
                                          {"mesh1", nullptr},
                                          {"mesh2", "no.mesh", "contact2"},
                                          {"contact1", 1.5},
                                          {"contact1", {1, "3"}},
                                          {"contact1", -1},
                                          {"contact1", "7", "contact line"},
                                          {"contact1", ""},
                                          {"contact1", "1[x"},
                                          {"young1", -1, "Young's modulus"},
                                          {"young1", 0, "Young's modulus"},
                                          {"young1", "1"},
                                          {"young1", json::array()},
                                          {"poisson1", 0.5, "Poisson's ratio"},
                                          {"poisson1", -1, "Poisson's ratio"},
                                          {"poisson1", "0.3"},

                                          {"support1", 4},
                                          {"support1", "4"},
                                          {"support1", "9:x", "fix"},
                                          {"support1", "4:z"},
                                          {"load1", 1},
                                          {"load1", "P"},
                                          {"load1", "P push 3 1"},
                                          {"load1", "P pressure 9 1", "pressure 'P'"},
                                          {"load1", {1, 2}},
                                          {"order", 0},
                                          {"order", 9},
                                          {"order", 1.5},
                                          {"order", "2"},
                                          {"order", 1e10},
                                          {"plane-stress", 1},
                                          {"plane-stress", "true"},
                                          {"friction", -0.1},
                                          {"friction", "0.1"},
                                          {"friction", nullptr},
                                          {"friction", {0.1}},
                                          {"gap", "wide"},
                                          {"gap", 0},
                                          {"pairing", 0},
                                          {"pairing", -1},
                                          {"pairing", 0.5},
                                          {"pairing", "0.1"},
                                          {"history", 1},
                                          {"history", "P=1; P=2"},
                                          {"history", "P=0"},
                                          {"history", "Z=1"},
                                          {"history", "P=x"},
                                          {"cycle-start", 40, "cycle starts at point 40"},
                                          {"cycle-start", 0.5},
                                          {"cycle-start", -2},
                                          {"cycles", 0},
                                          {"cycles", -3},
                                          {"cycles", "2"},
                                          {"increments", 0},
                                          {"increments", -5},
                                          {"increments", 2.5},
                                          {"stepping", "fast"},
                                          {"stepping", true},
                                          {"edges", "1 2"},
                                          {"edges", {1}},
                                          {"edges", {1, 99}},
                                          {"edges", {"1"}}};
   expect_holds(60,
                [&]
                {
                   json j = random_case();
                   const Mistake &mistake =
                      mistakes[*inRange<std::size_t>(0, mistakes.size()).as("mistake")];
                   const std::string key = mistake.key;
                   // Only a cycle has a number of cycles, and only edges need friction.
                   RC_PRE(key != "cycles" || j.contains("cycle-start"));
                   if (key == "edges") { j["friction"] = 0.3; }
                   // In plane stress a body may keep its volume.
                   if (key == "poisson1") { j.erase("plane-stress"); }
                   j[key] = mistake.value;
                   check(j,
                         [&]
                         {
                            const cattaneo_test::Run result = run(j);
                            RC_LOG(result.output);
                            RC_ASSERT(result.code == 1);
                            RC_ASSERT(result.results.is_null());
                            RC_ASSERT(fs::is_empty(folder + "/out"));
                            const std::size_t at = result.output.find("error:");
                            RC_ASSERT(at != std::string::npos);
                            const std::string sentence = result.output.substr(at);
                            RC_ASSERT(sentence.find('\n') == sentence.size() - 1);
                            const std::string named = mistake.says ? mistake.says : key;
                            RC_ASSERT(sentence.find(named) != std::string::npos);
                         });
                });
}

} // namespace
