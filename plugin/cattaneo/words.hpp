#pragma once

#include <string>
#include <vector>

namespace cattaneo
{

/// Pieces of a text between separators (any of these characters), without spaces, tabs and line
/// ends around them; empty ones are left out.
std::vector<std::string> split(const std::string &text, const std::string &separators);
/// The same, but names in quotes ('bolt 1, w = 1' or with ") are not cut. A quote begins a name
/// only at the beginning of a piece or after a blank, a comma, a semicolon or a dot; elsewhere
/// it is a letter. InputError "WHERE: …" for a quote without an end.
std::vector<std::string> split_unquoted(const std::string &where, const std::string &text,
                                        const std::string &separators);
/// A name without the quotes around it, if it has some.
std::string unquoted(const std::string &name);
/// Pieces with something between them.
std::string listed(const std::vector<std::string> &pieces, const std::string &between = ", ");

/// A word that is a finite number and nothing else; InputError "WHERE: 'WORD' is not a number".
double number(const std::string &where, const std::string &word);

/// A field of a table in CSV (RFC 4180): in quotes if it has a comma, a quote or a line break.
std::string csv_field(const std::string &text);

/// Is the text valid UTF-8, as JSON requires?
bool is_utf8(const std::string &text);

/// InputError, which begins with `where`, if an object of a JSON text has a key twice, as a
/// parser silently keeps the last one. Comments are skipped, and text that is not JSON is not
/// checked.
void require_single_keys(const std::string &where, const std::string &text);

/// InputError, which begins with `where`, for a load's name that statements cannot contain.
void require_pattern_name(const std::string &where, const std::string &pattern);

} // namespace cattaneo
