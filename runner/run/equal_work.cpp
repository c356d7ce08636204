#include "runner/run/equal_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/core/hash.h"

namespace gfxrepro::run {

namespace {

constexpr double kPrimitiveTolerance = 1e-5;
constexpr double kInvocationTolerance = 1e-4;
constexpr double kFragmentTolerance = 0.01;
constexpr float kImageTolerance = 0.01F;

std::string whyCountsDiffer(const gl::Work& first, const gl::Work& other, std::size_t repeat) {
    std::string why;
    const auto compare = [&](const char* what, std::uint64_t a, std::uint64_t b, double tolerance) {
        const auto x = static_cast<double>(a), y = static_cast<double>(b);
        if (!why.empty() || std::abs(x - y) <= tolerance * std::max(x, y)) return;
        why = fmt::format("repeat {} has {} {}, repeat 0 has {}", repeat, b, what, a);
    };
    compare("primitives", first.primitives, other.primitives, kPrimitiveTolerance);
    compare("compute invocations", first.invocations, other.invocations, kInvocationTolerance);
    compare("fragments", first.fragments, other.fragments, kFragmentTolerance);
    return why;
}

bool areAlike(const ImageDigest& a, const ImageDigest& b) {
    if (a.hash == b.hash) return true;
    const float allowed = kImageTolerance * std::max(a.range, b.range);
    for (std::size_t i = 0; i < a.means.size(); ++i) {
        // The negation counts not-a-number.
        if (!(std::abs(a.means[i] - b.means[i]) <= allowed)) return false;
    }
    return true;
}

}  // namespace

ImageDigest ImageDigest::of(const image::ImageF& image) {
    ImageDigest digest;
    const std::span<const float> values = image.values();
    digest.hash =
        static_cast<double>(std::stoull(sha256(std::as_bytes(values)).substr(0, 13), nullptr, 16));
    const auto channels = static_cast<std::size_t>(image.channels());
    digest.isBlank = true;
    for (std::size_t i = channels; digest.isBlank && i < values.size(); ++i) {
        digest.isBlank = values[i] == values[i % channels];
    }
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    digest.range = *highest - *lowest;
    std::array<double, kCells * kCells> sums{};
    std::array<std::size_t, kCells * kCells> counts{};
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const auto cell = static_cast<std::size_t>(y * kCells / image.height() * kCells +
                                                       x * kCells / image.width());
            for (int c = 0; c < image.channels(); ++c) sums[cell] += image.at(x, y, c);
            counts[cell] += channels;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (counts[i] > 0)
            digest.means[i] = static_cast<float>(sums[i] / static_cast<double>(counts[i]));
    }
    return digest;
}

std::string whyUnequal(const std::vector<RepeatWork>& repeats) {
    for (std::size_t i = 0; i < repeats.size(); ++i) {
        const RepeatWork &first = repeats.front(), &here = repeats[i];
        if (here.image && here.image->isBlank) {
            return fmt::format("the picture of repeat {} is blank: all its pixels are the same", i);
        }
        if (first.counts && here.counts) {
            const std::string why = whyCountsDiffer(*first.counts, *here.counts, i);
            if (!why.empty()) return why;
        }
        if (first.image && here.image && !areAlike(*first.image, *here.image)) {
            return fmt::format("repeat {} drew a different picture than repeat 0", i);
        }
    }
    return "";
}

}  // namespace gfxrepro::run
