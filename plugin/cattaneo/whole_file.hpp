#pragma once

#include <string>

namespace cattaneo
{

/// All of a file; InputError, which begins with `what`, if it cannot be read.
std::string read_whole(const std::string &file, const std::string &what = "");

/// Writes a text file whole or not at all: beside it first, then renamed, so that whatever goes
/// wrong leaves an old file as it was and no half of a new one. Devices and pipes are written
/// to as they are, links followed, permissions kept. InputError if it cannot be written.
void write_whole(const std::string &file, const std::string &text);

/// InputError unless a file of that name could be written: its folder exists and may be written
/// to, and it is no folder itself. To be called before long work.
void require_writable(const std::string &file);

} // namespace cattaneo
