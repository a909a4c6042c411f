#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace miniapp
{

/// The keys of a case file that stand for options, with their values.
struct CaseFile
{
   nlohmann::ordered_json keys;
   int version = 1; ///< that the file is written in (docs/contact2d.md)
};

/** The key "version" says which version a file is written in, without it 1. InputError if the
    file cannot be read, is no JSON object, has a key twice or is of a version beyond the newest
    that is known. */
CaseFile read_case(const std::string &file, int newest);

} // namespace miniapp
