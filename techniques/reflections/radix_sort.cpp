#include "techniques/reflections/radix_sort.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

constexpr std::uint32_t kDigits = 1U << RadixSort::kDigitBits;
static_assert(kDigits == RadixSort::kGroupSize, "an invocation scans one digit of its tile");

std::uint32_t tilesOf(std::uint32_t count) {
    return kit::groupsFor(count, RadixSort::kTileSize);
}

gl::Pass pass(const gl::ShaderLibrary& shaders, const char* file) {
    return {shaders,
            {file},
            {{"GROUP_SIZE", RadixSort::kGroupSize},
             {"KEYS_PER_INVOCATION", RadixSort::kKeysPerInvocation},
             {"DIGITS", kDigits}}};
}

}  // namespace

RadixSort::RadixSort(const gl::ShaderLibrary& shaders, std::uint32_t capacity)
    : count_(pass(shaders, "reflections/sort_count.comp.glsl")),
      scan_(shaders, "uint", kit::PrefixSum::Total::None),
      scatter_(pass(shaders, "reflections/sort_scatter.comp.glsl")),
      otherPairs_(std::max(capacity, 1U) * sizeof(glm::uvec2)),
      counts_(std::max(tilesOf(capacity), 1U) * kDigits * sizeof(std::uint32_t)) {}

void RadixSort::sort(gl::Buffer& pairs, std::uint32_t count, std::uint32_t keyBits) {
    GFXREPRO_ASSERT_EQ(pairs.sizeBytes(), otherPairs_.sizeBytes());
    GFXREPRO_ASSERT(count * sizeof(glm::uvec2) <= pairs.sizeBytes() && keyBits <= 32);
    if (count == 0) return;
    const std::uint32_t tiles = tilesOf(count);
    for (std::uint32_t shift = 0; shift < keyBits; shift += kDigitBits) {
        count_.set("pairCount", count);
        count_.set("shift", shift);
        count_.dispatch({tiles, 1, 1}, {{"Pairs", pairs}, {"Counts", counts_}});
        scan_.run(counts_, tiles * kDigits);
        scatter_.set("pairCount", count);
        scatter_.set("shift", shift);
        scatter_.dispatch({tiles, 1, 1},
                          {{"Pairs", pairs}, {"SortedPairs", otherPairs_}, {"Counts", counts_}});
        std::swap(pairs, otherPairs_);
    }
}

std::size_t RadixSort::sizeBytes() const {
    return otherPairs_.sizeBytes() + counts_.sizeBytes();
}

}  // namespace gfxrepro::reflections
