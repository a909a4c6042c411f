// Random case files: what docs/contact.md allows runs, and a single mistake is refused by one
// sentence that names its key, with nothing written.

#include "holds.hpp"
#include "run_miniapp.hpp"

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
      json j = {{"version", 2}};
      json &upper =
         j["bodies"]["upper"] = {{"mesh", "upper.mesh"}, {"young", 1}, {"poisson", 0.3}};
      json &face = j["interfaces"]["face"] = {{"between", json::array({"upper:1"})}};
      const auto draw = [&](const std::string &name, const std::vector<json> &values)
      { return values[*inRange<std::size_t>(0, values.size()).as(name)]; };
      const auto choose = [&](const char *key, const std::vector<json> &values)
      { j[key] = draw(key, values); };
      const auto perhaps = [&](const char *key, const std::vector<json> &values)
      {
         if (*inRange(0, 2).as(std::string("has ") + key)) { choose(key, values); }
      };
      const auto perhaps_of =
         [&](json &object, const char *key, const std::vector<json> &values)
      {
         if (*inRange(0, 2).as(std::string("has ") + key)) { object[key] = draw(key, values); }
      };
      upper["load"] = draw("load", {"P pressure 3 1",
                                    {"P pressure 3 2-x", "P traction 3[-2<x<2] 0.1 0"},
                                    "P body-force 0 -1",
                                    "P displacement-y 3 -0.01"});
      upper["support"] = draw("support", {"3:x", json::array({"3:x"}), "@0,1:x"});
      if (*inRange(0, 2).as("two bodies"))
      {
         json lower = {
            {"mesh", "lower.mesh"}, {"young", 1}, {"poisson", 0.3}, {"support", "1:xy"}};
         perhaps_of(lower, "young", {2, 0.5, json::array({3})});
         perhaps_of(lower, "poisson", {0, 0.25, json::array({0.4})});
         perhaps_of(lower, "load", {"B body-force 0 -0.1", json::array({"T traction 2 1 0"})});
         j["bodies"]["lower"] = lower;
         face["between"].push_back("lower:3");
         perhaps_of(face, "pairing", {1e-6, 0.1});
         perhaps_of(face, "slave", {"coarser", "finer", "first", "second"});
      }
      perhaps_of(upper, "young", {1, 10.5, json::array({2})});
      perhaps_of(upper, "poisson", {0, 0.3, json::array({0.45})});
      perhaps("analysis", {"plane strain", "plane stress"});
      perhaps_of(face, "friction", {0, 0.2, 0.5, "0.2+0.1*x^2"});
      perhaps_of(face, "gap", {"geometry", "closed", 0.001});
      perhaps("order", {1, 2, 3});
      perhaps("increments", {1, 3});
      perhaps("stepping", {"exact", "fixed"});
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
      // The case before may have failed: remove all that it left.
      fs::remove_all(folder + "/out");
      fs::create_directories(folder + "/out");
      std::ofstream(folder + "/case.json") << j.dump(3);
      return run_miniapp("contact", "--case '" + folder + "/case.json' --csv '" + folder +
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
                            RC_ASSERT(fs::exists(folder + "/out/fields/upper/upper.pvd"));
                         });
                });
}

/// A place (a JSON pointer), a value that it must not have, and what names it where its last
/// key does not.
struct Mistake
{
   const char *place;
   json value;
   const char *says = nullptr;
};

TEST_F(CaseFileProperties, SingleMistakesAreNamedAndNothingIsWritten)
{
   const std::vector<Mistake> mistakes = {
      {"/yung", 1},
      {"/Friction", 0.1},
      {"/json", "r.json"},
      {"/version", 1},
      {"/version", nullptr},
      {"/bodies/upper/mesh", 3},
      {"/bodies/upper/mesh", "no.mesh", "no.mesh"},
      {"/bodies/upper/mesh", nullptr},
      {"/bodies/upper/matrix", "no.sti"},
      {"/bodies/other/mesh", "no.mesh", "bodies.other"},
      {"/interfaces/face/between", 1.5},
      {"/interfaces/face/between", {"upper:1", 3}},
      {"/interfaces/face/between", "upper:-1"},
      {"/interfaces/face/between", "upper:7", "contact line"},
      {"/interfaces/face/between", "upper"},
      {"/interfaces/face/between", "upper:1[x"},
      {"/interfaces/face/between", "nobody:1"},
      {"/bodies/upper/young", -1},
      {"/bodies/upper/young", 0},
      {"/bodies/upper/young", "1"},
      {"/bodies/upper/young", json::array()},
      {"/bodies/upper/poisson", 0.5, "Poisson's ratio"},
      {"/bodies/upper/poisson", -1, "Poisson's ratio"},
      {"/bodies/upper/poisson", "0.3"},
      {"/bodies/upper/support", 4},
      {"/bodies/upper/support", "4"},
      {"/bodies/upper/support", "9:x", "fix"},
      {"/bodies/upper/support", "4:z"},
      {"/bodies/upper/load", 1},
      {"/bodies/upper/load", "P"},
      {"/bodies/upper/load", "P push 3 1"},
      {"/bodies/upper/load", "P pressure 9 1", "pressure 'P'"},
      {"/bodies/upper/load", {1, 2}},
      {"/order", 0},
      {"/order", 9},
      {"/order", 1.5},
      {"/order", "2"},
      {"/order", 1e10},
      {"/analysis", 1},
      {"/analysis", "plane"},
      {"/interfaces/face/friction", -0.1},
      {"/interfaces/face/friction", "0.1*"},
      {"/interfaces/face/friction", nullptr},
      {"/interfaces/face/friction", {0.1}},
      {"/interfaces/face/gap", "wide"},
      {"/interfaces/face/gap", json::array()},
      {"/interfaces/face/pairing", 0},
      {"/interfaces/face/pairing", -1},
      {"/interfaces/face/pairing", 0.5},
      {"/interfaces/face/pairing", "0.1"},
      {"/history", 1},
      {"/history", "P=1; P=2"},
      {"/history", "P=0"},
      {"/history", "Z=1"},
      {"/history", "P=x"},
      {"/cycle-start", 40, "cycle starts at point 40"},
      {"/cycle-start", 0.5},
      {"/cycle-start", -2},
      {"/cycles", 0},
      {"/cycles", -3},
      {"/cycles", "2"},
      {"/increments", 0},
      {"/increments", -5},
      {"/increments", 2.5},
      {"/stepping", "fast"},
      {"/stepping", true},
      {"/edges", "1 2"},
      {"/edges", {1}},
      {"/edges", {1, 99}},
      {"/edges", {"1"}}};
   expect_holds(60,
                [&]
                {
                   json j = random_case();
                   const Mistake &mistake =
                      mistakes[*inRange<std::size_t>(0, mistakes.size()).as("mistake")];
                   const std::string place = mistake.place,
                                     key = place.substr(place.rfind('/') + 1);
                   // Only a cycle has a number of cycles, and only edges need friction.
                   RC_PRE(key != "cycles" || j.contains("cycle-start"));
                   if (key == "edges") { j["interfaces"]["face"]["friction"] = 0.3; }
                   // In plane stress a body may keep its volume.
                   if (key == "poisson") { j.erase("analysis"); }
                   j[json::json_pointer(place)] = mistake.value;
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
