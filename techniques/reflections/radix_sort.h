// Sorting on the device.
#pragma once

#include <cstdint>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "techniques/kit/prefix_sum.h"

namespace gfxrepro::reflections {

/// A stable radix sort from the least significant digit (Satish et al. 2009, "Designing Efficient
/// Sorting Algorithms for Manycore GPUs"), six bits a pass: each tile of keys counts its digits,
/// one scan over all tiles' counts gives every tile's first place of a digit, and each tile puts
/// its pairs there.
class RadixSort {
  public:
    /// Pairs that one work group takes, and digits of a pass.
    static constexpr std::uint32_t kGroupSize = 64, kKeysPerInvocation = 32;
    static constexpr std::uint32_t kTileSize = kGroupSize * kKeysPerInvocation;
    static constexpr std::uint32_t kDigitBits = 6;

    /// For at most `capacity` pairs.
    RadixSort(const gl::ShaderLibrary& shaders, std::uint32_t capacity);
    /// Sorts uvec2(key, value) by the lower `keyBits` bits of the keys. `pairs` holds `capacity`
    /// of them, of which the first `count` count; it is swapped with a buffer of this object. Ends
    /// with a barrier for storage.
    void sort(gl::Buffer& pairs, std::uint32_t count, std::uint32_t keyBits);
    std::size_t sizeBytes() const;

  private:
    gl::Pass count_;
    kit::PrefixSum scan_;
    gl::Pass scatter_;
    gl::Buffer otherPairs_, counts_;
};

}  // namespace gfxrepro::reflections
