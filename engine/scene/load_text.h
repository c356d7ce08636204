// What the loaders of text formats share: numbers and colours.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace gfxrepro::scene {

/// The whole word as a number, independent of the locale; "nan" and "inf" are numbers here, what is
/// too large becomes infinite and what is too small 0. Empty when it is anything else.
template <class T>
std::optional<T> parsedNumber(std::string_view word) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    T value{};
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (stop != word.data() + word.size() || word.empty()) return std::nullopt;
    if (error == std::errc()) return value;
    if (error == std::errc::result_out_of_range && std::numeric_limits<T>::has_infinity) {
        // from_chars does not say on which side it left the range; the exponent does.
        const bool isTiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
        return isTiny ? T{0} : std::numeric_limits<T>::infinity();
    }
    return std::nullopt;
}

/// A word of a file as messages show it: in a file of zeros one has gigabytes, and a message ends
/// at the first of them.
inline std::string inQuotes(std::string_view word) {
    constexpr std::size_t kMostBytes = 100;
    std::string text(word.substr(0, kMostBytes));
    std::ranges::replace(text, '\0', '?');
    if (word.size() == text.size()) return '\'' + text + '\'';
    return '\'' + text + "…' (" + std::to_string(word.size()) + " bytes)";
}

/// IEC 61966-2-1, for values from 0 to 1.
inline float linearFromSrgb(float srgb) {
    return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

inline bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A direction of unit length. One that is so already keeps its bits (saved files come back as they
/// were); one without a direction becomes zero.
inline glm::vec3 unitNormal(const glm::vec3& normal) {
    const float squaredLength = glm::dot(normal, normal);
    if (std::abs(squaredLength - 1.0F) < 1e-4F) return normal;
    const glm::vec3 unit = normal / std::sqrt(squaredLength);
    return isFinite(unit) ? unit : glm::vec3(0.0F);
}

}  // namespace gfxrepro::scene
