#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cattaneo
{

/// JSON of a text, in which each object has each of its keys once: of two the library would
/// keep the last without a word. InputError, which begins with `what`, for a key that is there
/// twice; the library's own error for what is not JSON, as comments are unless they are
/// allowed. Compiled once: a parser takes long.
nlohmann::json parsed(const std::string &text, const std::string &what, bool comments = false);

} // namespace cattaneo
