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

namespace fs = std::filesystem;

namespace
{

/// Devices and pipes, which are written through and not replaced.
bool stands_for_no_file(const std::string &file)
{
   return fs::exists(file) && !fs::is_regular_file(file);
}

/// Where a link leads, which stays a link.
fs::path target(const std::string &file)
{
   fs::path path = file;
   // So many links in a row can only be a ring.
   for (int links = 0; links < 40 && fs::is_symlink(path); ++links)
   {
      path = path.parent_path() / fs::read_symlink(path);
   }
   return path;
}

} // namespace

void require_writable(const std::string &file)
{
   // Fails if the name is too long for the system, if the folder has no permission, or if links
   // form a ring.
   std::error_code why_not;
   const fs::file_type type = fs::status(file, why_not).type();
   require(type != fs::file_type::none && type != fs::file_type::unknown, "cannot write file '",
           file, "': ", why_not.message());
   require(type != fs::file_type::directory, "cannot write file '", file,
           "': there is a folder of that name");
   if (stands_for_no_file(file))
   {
      require(access(file.c_str(), W_OK) == 0, "cannot write file '", file,
              "': it may not be written to");
      return;
   }
   fs::path folder = target(file).parent_path();
   if (folder.empty()) { folder = "."; }
   require(fs::is_directory(folder), "cannot write file '", file, "': there is no folder ",
           folder);
   require(access(folder.c_str(), W_OK | X_OK) == 0, "cannot write file '", file, "': folder ",
           folder, " may not be written to");
}

std::string read_whole(const std::string &file, const std::string &what)
{
   std::ifstream in(file, std::ios::binary);
   require(in.good() && !fs::is_directory(file), what, "cannot read file '", file, "'",
           fs::is_directory(file) ? ": it is a folder"
           : fs::exists(file)     ? ": it may not be read"
                                  : ": there is no such file");
   return {std::istreambuf_iterator<char>(in), {}};
}

void write_whole(const std::string &file, const std::string &text)
{
   require_writable(file);
   const bool through = stands_for_no_file(file);
   const std::string end = target(file).string(), part = through ? file : end + ".part";
   std::ofstream out(part);
   out << text;
   out.close();
   if (out.good())
   {
      std::error_code kept;
      if (!through && fs::exists(end))
      {
         fs::permissions(part, fs::status(end).permissions(), kept);
      }
      if (through || std::rename(part.c_str(), end.c_str()) == 0) { return; }
   }
   const char *reason = std::strerror(errno);
   if (!through) { std::remove(part.c_str()); }
   throw InputError("cannot write file '" + file + "': " + reason);
}

} // namespace cattaneo
