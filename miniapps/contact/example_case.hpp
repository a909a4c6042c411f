#pragma once

#include <string>

namespace miniapp
{

/// "joint, pin, …"
std::string example_names();

/// Prints the case that --example names, whose files are named so that it runs from any folder.
/// False if the command line has no such option; InputError for a name that is none.
bool prints_example(int argc, char *argv[]);

} // namespace miniapp
