#pragma once

#include <functional>
#include <mfem.hpp>
#include <string>

namespace cattaneo::miniapp
{

/** Parses the command line. False if the user asked for help, which has then been printed.
    InputError, in one sentence, for an unknown, incomplete or malformed option. */
bool parse(mfem::OptionsParser &options);

/// Prints the options that were given or have a default.
void echo(const mfem::OptionsParser &options);

/// Runs a program: an exception becomes one sentence on stderr and the exit code 1.
int run(const std::string &program, const std::function<void()> &body);

/// Writes a file as a whole or not at all. InputError if it cannot be written.
void write_file(const std::string &path, const std::string &text);

} // namespace cattaneo::miniapp
