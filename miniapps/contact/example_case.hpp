#pragma once

#include <string>

namespace miniapp
{

/// "joint, pin, …"
std::string example_names();

/// Prints the case that --example names, with names of files that are valid in any folder.
/// False if the command line has no such option; InputError for an unknown name.
bool prints_example(int argc, char *argv[]);

} // namespace miniapp
