// A folder of its own for the files of each test program, so that two suites on one machine do
// not meet: testing::TempDir() is there, and all of it goes at the end.
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace
{

class OwnFolder
{
public:
   OwnFolder()
   {
      path_ = (std::filesystem::temp_directory_path() / "cattaneo_XXXXXX").string();
      if (!mkdtemp(path_.data())) { throw std::runtime_error("cannot make " + path_); }
      setenv("TEST_TMPDIR", (path_ + "/").c_str(), 1);
   }
   ~OwnFolder()
   {
      std::error_code ignored;
      std::filesystem::remove_all(path_, ignored);
   }

private:
   std::string path_;
};

const OwnFolder own_folder;

} // namespace
