#pragma once

#include <string>
#include <vector>

namespace cattaneo
{

/// Pieces of a text between separators (any of these characters), without spaces, tabs and line
/// ends around them; empty ones are left out.
std::vector<std::string> split(const std::string &text, const std::string &separators);
/// The same, but that names in quotes ('bolt 1, w = 1' or with ") are not cut; quotes begin
/// them only where a piece begins or after a blank, a comma, a semicolon or a dot, else they
/// are letters. InputError "WHERE: …" for a quote without an end.
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

/// Text that JSON can hold.
bool is_utf8(const std::string &text);

/// InputError, which begins with `where`, for a key that an object of a JSON text has twice: of
/// the two a parser keeps the last without a word. Comments are passed over, and what is not
/// JSON is not looked at.
void require_single_keys(const std::string &where, const std::string &text);

/// InputError, which begins with `where`, for a name of a load that statements cannot hold.
void require_pattern_name(const std::string &where, const std::string &pattern);

} // namespace cattaneo
