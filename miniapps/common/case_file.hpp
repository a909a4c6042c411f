#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace miniapp
{

/** The keys of a case file that stand for options, with their values. The one place that knows
    of versions: the key "version" says which one a file is written in, without it 1, the only
    one there is (docs/contact2d.md). InputError if the file cannot be read, is no JSON object,
    has a key twice or is of another version. */
nlohmann::json read_case(const std::string &file);

} // namespace miniapp
