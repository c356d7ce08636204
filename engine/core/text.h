// Small text helpers: suggestions for misspelt names, joined lists, strict number parsing, UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro {

/// The candidate with the smallest edit distance to `name`, if it is near enough to be meant
/// (at most a third of the name's length, at least 1; case is ignored).
std::optional<std::string> nearestName(std::string_view name,
                                       std::span<const std::string> candidates);

/// "; did you mean 'x'?" or "" — ready to be appended to a message.
std::string suggestion(std::string_view name, std::span<const std::string> candidates);

/// The same, or where none is near "; allowed: a, b, c".
std::string suggestionOrAll(std::string_view name, std::span<const std::string> candidates);

/// "a, b, c".
std::string joined(std::span<const std::string> items, std::string_view separator = ", ");

std::vector<std::string> split(std::string_view text, char separator);
std::string_view trimmed(std::string_view text);
/// Of ASCII letters.
std::string lowerCase(std::string_view text);

/// The whole text as a decimal number ("12", "-3", "1e-3"), independent of the locale; no leading
/// zeros, no octal or hexadecimal forms, no infinities. Empty when it is anything else.
std::optional<double> parseDouble(std::string_view text);
std::optional<long long> parseInteger(std::string_view text);

/// Bytes of the UTF-8 character that a text begins with; 0 where it is none.
std::size_t utf8Length(std::string_view text);
/// Whether all of it is UTF-8.
bool isUtf8(std::string_view text);

/// Columns on a screen: `…` is one of them and three bytes.
std::size_t columnsOf(std::string_view text);

/// For /bin/sh: as it is where that is safe, else in single quotes.
std::string shellQuoted(const std::string& argument);

}  // namespace gfxrepro
