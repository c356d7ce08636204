// What several formats of pictures have: colour profiles, Exif, and what is said of each alike.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "engine/image/formats.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {

using Part = std::span<const std::byte>;

std::size_t numberAt(Part part, std::size_t at, std::size_t count, bool isLittle) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < count && at + i < part.size(); ++i) {
        const auto digit = std::to_integer<std::size_t>(part[at + i]);
        value = isLittle ? value | digit << 8 * i : value << 8 | digit;
    }
    return value;
}

std::string_view textOf(Part part) {
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

void noteAspect(double across, double down, std::vector<std::string>& notes) {
    constexpr double kRounding = 0.01;
    if (!(across > 0.0 && down > 0.0) || std::abs(across - down) <= kRounding * down) return;
    notes.push_back(
        fmt::format("left out: its pixels are {:.4g} times as wide as high", down / across));
}

void noteBehind(std::span<const std::byte> behind, std::vector<std::string>& notes) {
    constexpr std::string_view kFilling(" \t\r\n\0", 5);
    if (textOf(behind).find_first_not_of(kFilling) == std::string_view::npos) return;
    notes.push_back(fmt::format("left out: {} byte{} behind its end", behind.size(),
                                behind.size() == 1 ? "" : "s"));
}

int orientationOf(Part tags) {
    if (tags.size() < 8) return 1;
    const bool isLittle = tags[0] == std::byte{'I'};
    const std::size_t first = numberAt(tags, 4, 4, isLittle);
    const std::size_t count = numberAt(tags, first, 2, isLittle);
    for (std::size_t i = 0; i < count && first + 2 + 12 * (i + 1) <= tags.size(); ++i) {
        const std::size_t entry = first + 2 + 12 * i;
        if (numberAt(tags, entry, 2, isLittle) != 0x0112) continue;
        const std::size_t value = numberAt(tags, entry + 8, 2, isLittle);
        return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
    }
    return 1;
}

namespace {

/// Of a profile (ICC.1); empty where it has no such tag.
Part tagOf(Part profile, const std::string& name) {
    constexpr std::size_t kTags = 128, kTagBytes = 12;
    const std::size_t count = numberAt(profile, kTags, 4, false);
    for (std::size_t i = 0; i < count && kTags + 4 + kTagBytes * (i + 1) <= profile.size(); ++i) {
        const Part tag = profile.subspan(kTags + 4 + kTagBytes * i, kTagBytes);
        const std::size_t at = numberAt(tag, 4, 4, false), size = numberAt(tag, 8, 4, false);
        if (!textOf(tag).starts_with(name) || at > profile.size()) continue;
        return profile.subspan(at).first(std::min(size, profile.size() - at));
    }
    return {};
}

double fixedAt(Part bytes, std::size_t at) {
    return static_cast<std::int32_t>(numberAt(bytes, at, 4, false)) / 65536.0;
}

/// The light of a value by a curve: of samples, one exponent, or the parameters that sRGB has.
/// Not a number of others.
double lightBy(Part curve, double value) {
    const std::size_t count = numberAt(curve, 8, 4, false);
    const auto parameter = [&](std::size_t i) { return fixedAt(curve, 12 + 4 * i); };
    if (textOf(curve).starts_with("para") && count >> 16 == 3) {
        const double a = parameter(1), b = parameter(2), c = parameter(3), d = parameter(4);
        return value < d ? c * value : std::pow(a * value + b, parameter(0));
    }
    if (!textOf(curve).starts_with("curv")) return std::numeric_limits<double>::quiet_NaN();
    const auto sample = [&](std::size_t i) {
        return static_cast<double>(numberAt(curve, 12 + 2 * i, 2, false));
    };
    if (count < 2) return std::pow(value, count == 0 ? 1.0 : sample(0) / 256.0);
    const double place = value * static_cast<double>(count - 1);
    const auto below = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(below);
    return ((1.0 - part) * sample(below) + part * sample(std::min(below + 1, count - 1))) / 65535.0;
}

}  // namespace

bool isProfileOfSrgb(std::span<const std::byte> profile, bool isLinear) {
    struct Primary {
        const char* letter;
        std::array<double, 3> xyz;  // under ICC's D50
    };
    static constexpr Primary kSrgb[] = {{"r", {0.4361, 0.2225, 0.0139}},
                                        {"g", {0.3851, 0.7169, 0.0971}},
                                        {"b", {0.1431, 0.0606, 0.7141}}};
    static constexpr Primary kGrey[] = {{"k", {}}};
    const bool isGrey = !tagOf(profile, "kTRC").empty();
    if (!tagOf(profile, "A2B0").empty()) return false;  // a table, which goes first
    constexpr double kTolerance = 0.004;                // a step of 8 bits
    for (const auto& [letter, xyz] : isGrey ? std::span<const Primary>(kGrey) : kSrgb) {
        const Part given = tagOf(profile, std::string(letter) + "XYZ");
        for (std::size_t i = 0; i < 3 && !isGrey; ++i) {
            if (std::abs(fixedAt(given, 8 + 4 * i) - xyz[i]) > kTolerance) return false;
        }
        const Part curve = tagOf(profile, std::string(letter) + "TRC");
        for (int step = 0; step <= 16; ++step) {
            const double value = step / 16.0;
            const double wanted = isLinear ? value : linearOf(static_cast<float>(value));
            if (!(std::abs(lightBy(curve, value) - wanted) < kTolerance)) return false;
        }
    }
    return true;
}

ImageF turnedAsExif(const ImageF& image, std::span<const std::byte> exif) {
    const int orientation = orientationOf(exif);
    if (orientation == 1) return image;
    const bool isTransposed = orientation >= 5;
    const bool isMirrored = orientation == 2 || orientation == 3 || orientation >= 7;
    const bool isUpsideDown =
        orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    ImageF result(isTransposed ? image.height() : image.width(),
                  isTransposed ? image.width() : image.height(), image.channels());
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            const int u = isTransposed ? y : x, v = isTransposed ? x : y;
            for (int c = 0; c < image.channels(); ++c) {
                result.at(x, y, c) = image.at(isMirrored ? image.width() - 1 - u : u,
                                              isUpsideDown ? image.height() - 1 - v : v, c);
            }
        }
    }
    return result;
}

}  // namespace gfxrepro::image
