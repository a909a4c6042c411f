#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cattaneo
{

/// Parses a JSON text. InputError, which begins with `what`, if an object has a key twice, as
/// the library would silently keep the last one. The library's own error if the text is not
/// JSON, or has comments although they are not allowed. Compiled once, because a parser takes
/// long to compile.
nlohmann::json parsed(const std::string &text, const std::string &what, bool comments = false);

} // namespace cattaneo
