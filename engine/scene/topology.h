// How triangles hang together: which corners share a vertex, and which an edge.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

// A hash table from keys to consecutive numbers, for the millions of edges of a mesh.

inline std::uint64_t mixedBits(std::uint64_t key) {
    // The finalizer of SplitMix64 (Steele et al. 2014): every input bit moves every output bit.
    key = (key ^ (key >> 30)) * 0xBF58476D1CE4E5B9ULL;
    key = (key ^ (key >> 27)) * 0x94D049BB133111EBULL;
    return key ^ (key >> 31);
}
inline std::uint64_t mixedBits(const std::array<std::uint32_t, 3>& key) {
    return mixedBits(mixedBits((std::uint64_t{key[0]} << 32) | key[1]) + key[2]);
}

/// Numbers keys from 0 in order of first appearance. Open addressing with linear probing: several
/// times faster than std::unordered_map here, where building the table is most of the work.
template <class Key>
class KeyNumbers {
  public:
    explicit KeyNumbers(std::size_t expected = 16)
        : slots_(std::bit_ceil(expected * 2 + 16), kEmpty) {
        keys_.reserve(expected);
    }

    /// The key's number, and whether it is new.
    std::pair<std::uint32_t, bool> number(const Key& key) {
        if (keys_.size() * 2 >= slots_.size()) grow();
        std::uint32_t& slot = slots_[find(key)];
        const bool isNew = slot == kEmpty;
        if (isNew) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return {slot, isNew};
    }
    std::size_t size() const { return keys_.size(); }

  private:
    static constexpr std::uint32_t kEmpty = 0xFFFFFFFF;

    std::size_t find(const Key& key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>(mixedBits(key)) & mask;
        while (slots_[at] != kEmpty && keys_[slots_[at]] != key) at = (at + 1) & mask;
        return at;
    }
    void grow() {
        slots_.assign(slots_.size() * 2, kEmpty);
        for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[find(keys_[i])] = i;
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Key> keys_;
};

/// Vertices at equal positions share one id: seams of attributes close, cracks do not.
struct Welding {
    std::vector<std::uint32_t> idOfVertex;  // ids count from 0 in order of first appearance
    std::uint32_t count = 0;
};
Welding weldedByPosition(std::span<const glm::vec3> positions);

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Which vertices triangles use. One object serves many meshes over one large array: each takes
/// time in proportion to its triangles.
class UsedVertices {
  public:
    /// Those used, ascending; the triangles name their places among them afterwards. All corners
    /// are below `vertexCount`.
    std::vector<std::uint32_t> renumber(std::span<glm::uvec3> triangles, std::size_t vertexCount);

  private:
    std::vector<std::uint32_t> placeOf_;  // of each vertex; kNone between calls
};

/// Drops the vertices that no triangle uses; the others keep their order. Returns how many.
std::size_t dropUnusedVertices(Mesh& mesh);

/// Every edge once, with the corners that lie along it. Corner 3t+i is the side of triangle t from
/// its vertex i to vertex (i+1) mod 3. Triangles with two corners at one position enclose nothing
/// and take no part.
struct EdgeTable {
    std::vector<std::uint32_t> edgeOfCorner;  // kNone for triangles that take no part
    std::vector<std::uint32_t> nextCorner;    // chain of an edge's corners, ends with kNone
    std::vector<std::uint32_t> firstCorner;   // of each edge
};
EdgeTable edgesOf(std::span<const glm::uvec3> triangles, const Welding& welding);

}  // namespace gfxrepro::scene
