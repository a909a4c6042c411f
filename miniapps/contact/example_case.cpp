#include "contact/example_case.hpp"

#include "common/miniapp.hpp"
#include "common/shipped.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace miniapp
{

namespace
{

/// Names of examples, and their case files in meshes/.
const std::vector<std::pair<std::string, std::string>> examples = {
   {"joint", "bolted_joint_drawing"},
   {"pin", "pin"},
   {"dovetail", "dovetail"},
   {"pad", "fretting_pad"},
   {"punch", "rounded_punch"}};

} // namespace

std::string example_names()
{
   std::vector<std::string> names;
   for (const auto &example : examples) { names.push_back(example.first); }
   return listed(names);
}

bool prints_example(int argc, char *argv[])
{
   const std::string option = argc > 1 ? argv[1] : "";
   if (option != "--example" && option != "-example") { return false; }
   const std::string wanted = argc > 2 ? argv[2] : "";
   for (const auto &[name, file] : examples)
   {
      if (name != wanted) { continue; }
      cattaneo::require(argc == 3, "option --example stands alone: it prints a case and ends");
      std::string text = cattaneo::read_whole(shipped("meshes/" + file + ".json"));
      // Files that a case names are relative to its folder, which a printed case does not have.
      const std::string key = "\"mesh\": \"", folder = shipped("meshes/");
      for (std::size_t at = text.find(key); at != std::string::npos;
           at = text.find(key, at + 1))
      {
         text.insert(at + key.size(), folder);
      }
      if (writes()) { std::fputs(text.c_str(), stdout); }
      return true;
   }
   cattaneo::require(false, "option --example is '", wanted, "', must be one of ",
                     example_names(), " (as in --example joint > my.json)");
   return false;
}

} // namespace miniapp
