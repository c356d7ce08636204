#include "engine/scene/height_noise.h"

#include <cmath>
#include <iterator>

#include "engine/core/wide.h"

namespace gfxrepro::scene {
namespace {

float fade(float t) {
    return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F);
}

/// SplitMix64's finish over the lattice point, the octave and the seed.
std::uint64_t hashOf(std::int64_t x, std::int64_t y, int octave, std::uint64_t seed) {
    std::uint64_t z = seed + 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(octave + 1);
    for (const std::int64_t part : {x, y}) {
        z ^= static_cast<std::uint64_t>(part);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        z ^= z >> 31;
    }
    return z;
}

/// Both components in [−1, 1].
glm::vec2 gradientAt(std::int64_t x, std::int64_t y, int octave, std::uint64_t seed) {
    const std::uint64_t hash = hashOf(x, y, octave, seed);
    return {static_cast<float>((hash >> 8) & 0xFFFFFF) * 0x1p-23F - 1.0F,
            static_cast<float>((hash >> 40) & 0xFFFFFF) * 0x1p-23F - 1.0F};
}

/// columns: slope in x and value at each lattice point.
GFXREPRO_WIDE void interpolate(const glm::vec2* __restrict columns, double x, double step,
                               std::int64_t count, float* __restrict to) {
    for (int i = 0; i < count; ++i) {
        const double at = x + i * step;
        const int cell = static_cast<int>(at);
        const auto fx = static_cast<float>(at - cell);
        const glm::vec2 west = columns[cell], east = columns[cell + 1];
        to[i] = between(west.y + west.x * fx, east.y + east.x * (fx - 1.0F), fade(fx));
    }
}

}  // namespace

glm::dvec2 NoiseRow::origin() const {
    return 0.5 + 0.5 * glm::dvec2(gradientAt(-1, -1, octave_, seed_));
}

void NoiseRow::evaluate(double x, double y, double step, std::vector<float>& to) {
    const auto count = static_cast<std::int64_t>(to.size());
    const auto row = static_cast<std::int64_t>(std::floor(y));
    const auto fy = static_cast<float>(y - static_cast<double>(row));
    const float wy = fade(fy);
    const auto last = static_cast<std::int64_t>(x + static_cast<double>(count - 1) * step) + 1;
    columns_.resize(static_cast<std::size_t>(last + 1));
    for (std::int64_t c = 0; c <= last; ++c) {
        const glm::vec2 north = gradientAt(c, row, octave_, seed_);
        const glm::vec2 south = gradientAt(c, row + 1, octave_, seed_);
        columns_[static_cast<std::size_t>(c)] = {between(north.x, south.x, wy),
                                                 between(north.y * fy, south.y * (fy - 1.0F), wy)};
    }
    interpolate(columns_.data(), x, step, std::ssize(to), to.data());
}

}  // namespace gfxrepro::scene
