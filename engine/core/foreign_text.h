// What other programs write: numbers, and text that need not be UTF-8.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/core/text.h"

namespace gfxrepro {

/// Bytes that are no UTF-8 are taken for characters of Latin-1.
inline std::string asUtf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        if (length > 0) {
            result += text.substr(0, length);
        } else {
            const auto byte = static_cast<unsigned char>(text[0]);
            result += static_cast<char>(0xC0 | byte >> 6);
            result += static_cast<char>(0x80 | (byte & 0x3F));
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

/// The whole word as a number, independent of the locale, also with zeros before it; "nan" and
/// "inf" are numbers here, what is too large becomes infinite and what is too small 0. Empty when
/// it is anything else.
template <class T>
std::optional<T> parsedNumber(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    T value{};
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (stop != word.data() + word.size() || word.empty()) return std::nullopt;
    if (error == std::errc()) return value;
    // from_chars does not say on which side it left the range.
    if (error == std::errc::result_out_of_range && std::is_floating_point_v<T>) {
        const std::string text(word);
        if constexpr (std::is_same_v<T, float>) return std::strtof(text.c_str(), nullptr);
        return static_cast<T>(std::strtod(text.c_str(), nullptr));
    }
    return std::nullopt;
}

}  // namespace gfxrepro
