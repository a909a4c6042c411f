#pragma once

#include <string>

namespace miniapp
{

/// The place of a file that comes with the programs, "miniapps/data/references.json": beside
/// the installed program that runs, PREFIX/share/cattaneo/, else in the sources that it was
/// built from.
std::string shipped(const std::string &name);

} // namespace miniapp
