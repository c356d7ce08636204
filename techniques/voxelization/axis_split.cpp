#include "techniques/voxelization/axis_split.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace gfxrepro::voxelization {
namespace {

constexpr std::size_t kTrianglesPerChunk = 1 << 15;

/// A run of triangles: the axis of each, and how many there are of each axis.
struct Chunk {
    std::array<std::size_t, 3> counts{};
    std::array<std::uint8_t, kTrianglesPerChunk> axes;
};

}  // namespace

Axis dominantAxis(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 area = glm::abs(glm::cross(b - a, c - a));
    if (area.z >= area.x && area.z >= area.y) return Axis::Z;
    return area.y >= area.x ? Axis::Y : Axis::X;
}

void splitByAxis(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 AxisSplit& split) {
    std::vector<Chunk> chunks((triangles.size() + kTrianglesPerChunk - 1) / kTrianglesPerChunk);
    const auto trianglesOf = [&](std::size_t chunk) {
        const std::size_t first = chunk * kTrianglesPerChunk;
        return triangles.subspan(first, std::min(kTrianglesPerChunk, triangles.size() - first));
    };
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Chunk& chunk = chunks[c];
        std::size_t i = 0;
        for (const glm::uvec3& t : trianglesOf(c)) {
            const Axis axis = dominantAxis(positions[t.x], positions[t.y], positions[t.z]);
            chunk.axes[i++] = static_cast<std::uint8_t>(axis);
            ++chunk.counts[static_cast<std::size_t>(axis)];
        }
    });

    // Turn the counts into the place of each chunk's first triangle of an axis.
    std::size_t next = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = next;
        for (Chunk& chunk : chunks) next += std::exchange(chunk.counts[axis], next);
        split.ranges[axis] = {static_cast<int>(first), static_cast<int>(next - first)};
    }

    split.triangles.resize(triangles.size());
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Chunk& chunk = chunks[c];
        std::size_t i = 0;
        for (const glm::uvec3& t : trianglesOf(c)) {
            split.triangles[chunk.counts[chunk.axes[i++]]++] = t;
        }
    });
}

}  // namespace gfxrepro::voxelization
