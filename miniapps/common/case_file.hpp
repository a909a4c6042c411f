#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace miniapp
{

/** The keys of a case file that stand for options, with their values. Comments are allowed.
    InputError if the file cannot be read, is not a JSON object, has a key twice, or is of
   another version; 0: the file need not name a version. */
nlohmann::ordered_json read_case(const std::string &file, int version);

} // namespace miniapp
