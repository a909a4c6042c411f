#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace cattaneo
{

void write_whole(const std::string &file, const std::string &text)
{
   const std::string part = file + ".part";
   std::ofstream out(part);
   out << text;
   out.close();
   if (out.good() && std::rename(part.c_str(), file.c_str()) == 0) { return; }
   const char *reason = std::strerror(errno);
   std::remove(part.c_str());
   throw InputError("cannot write file '" + file + "': " + reason);
}

void require_writable(const std::string &file)
{
   std::filesystem::path folder = std::filesystem::path(file).parent_path();
   if (folder.empty()) { folder = "."; }
   require(std::filesystem::is_directory(folder), "cannot write file '", file,
           "': there is no folder ", folder);
   require(!std::filesystem::is_directory(file), "cannot write file '", file,
           "': there is a folder of that name");
   require(access(folder.c_str(), W_OK | X_OK) == 0, "cannot write file '", file, "': folder ",
           folder, " may not be written to");
}

} // namespace cattaneo
