#include "common/shipped.hpp"

#include <filesystem>

namespace miniapp
{

std::string shipped(const std::string &name)
{
   namespace fs = std::filesystem;
   std::error_code unknown;
   const fs::path program = fs::read_symlink("/proc/self/exe", unknown),
                  installed = program.parent_path() / CATTANEO_SHARE_FROM_PROGRAM;
   const fs::path beside = installed / name;
   if (!unknown && fs::exists(beside)) { return beside.lexically_normal().string(); }
   return CATTANEO_SOURCE_DIR "/" + name;
}

} // namespace miniapp
