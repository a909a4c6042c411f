#include <cattaneo/input_error.hpp>
#include <cattaneo/output/streamed_file.hpp>
#include <cattaneo/whole_file.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace cattaneo
{

namespace
{

/// The part of an old file that is kept.
std::string kept_lines(const std::string &file, const std::string &header, double time,
                       const std::function<void(const std::string &)> &check)
{
   std::ifstream in(file);
   std::string line, last, kept = header + '\n';
   if (!std::getline(in, line)) { return kept; }
   require(line == header, "file '", file, "' cannot be continued: its first line is '", line,
           "', must be '", header, "'");
   // Only a line with an end is complete.
   while (std::getline(in, line) && !in.eof())
   {
      if (!(std::strtod(line.c_str(), nullptr) <= time)) { break; }
      kept += line + '\n';
      last = line;
   }
   if (check && !last.empty()) { check(last); }
   return kept;
}

} // namespace

StreamedFile::StreamedFile(const std::string &file, const std::string &header) : file_(file)
{
   write_whole(file, header + '\n');
   open();
}

StreamedFile::StreamedFile(const std::string &file, const std::string &header, double time,
                           const std::function<void(const std::string &)> &check)
   : file_(file)
{
   write_whole(file, kept_lines(file, header, time, check));
   open();
}

void StreamedFile::open()
{
   out_.open(file_, std::ios::app);
   require(out_.good(), "cannot write file '", file_, "': ", std::strerror(errno));
}

void StreamedFile::add(const std::string &lines)
{
   out_ << lines << std::flush;
   if (out_.good()) { return; }
   throw WriteError("cannot continue file '" + file_ + "': " + std::strerror(errno));
}

} // namespace cattaneo
