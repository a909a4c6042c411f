#pragma once

#include <string>

namespace cattaneo
{

/// Content of a file. InputError, which begins with `what`, if it cannot be read.
std::string read_whole(const std::string &file, const std::string &what = "");

/// Writes a text file completely or not at all: first under another name, then renamed. If
/// anything fails, an old file stays unchanged, and no incomplete new one is left. Devices and
/// pipes are written to directly, links are followed, and permissions are kept. InputError if
/// it cannot be written.
void write_whole(const std::string &file, const std::string &text);

/// InputError unless a file of that name can be written: its folder exists and is writable, and
/// it is not a folder itself. To be called before long work.
void require_writable(const std::string &file);

} // namespace cattaneo
