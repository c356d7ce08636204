// The guard of times: repeats of a frame must have done the same work, and shown something.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/image/image.h"

namespace gfxrepro::run {

/// A picture in few numbers.
struct ImageDigest {
    static constexpr int kCells = 8;  // along each axis

    /// The first 52 bits of the SHA-256 of the pixels: exact in a double.
    double hash = 0.0;
    bool isBlank = false;                        // every pixel the same
    std::array<float, kCells * kCells> means{};  // of all channels over each cell
    float range = 0.0F;                          // of the pixels' values

    static ImageDigest of(const image::ImageF& image);
};

/// What one repeat of a frame did.
struct RepeatWork {
    std::optional<gl::Work> counts;
    std::optional<ImageDigest> image;
};

/// Why the times of these repeats of one frame cannot stand, with the numbers; empty if they can.
/// Primitives must be the same but for 1e-5, compute invocations but for 1e-4: a GPU's lists that
/// grow by atomic counters are in another order each time, and of two triangles at one depth the
/// first is seen (of reused reflections on an H100 one point of 2.5 million primitives, and of 1.2
/// million invocations the 64 of one work group). Fragments may
/// differ by 1 %: early depth tests of a parallel rasterizer depend on the order. Pictures may
/// differ by 1 % of their range in the mean of a cell: sums of floats do as well.
std::string whyUnequal(const std::vector<RepeatWork>& repeats);

}  // namespace gfxrepro::run
