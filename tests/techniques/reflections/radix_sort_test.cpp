// The device's sort against std::stable_sort.
#include "techniques/reflections/gpu_ray_tracer.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "tests/gl/gl_fixture.h"

namespace gfxrepro::reflections {
namespace {

struct RadixSortTest : test::GlTest {
    /// Sorts keys with their places as values; values tell whether equal keys kept their order.
    void expectSorted(const std::vector<std::uint32_t>& keys, std::uint32_t keyBits,
                      std::size_t capacity) {
        std::vector<glm::uvec2> pairs(capacity, glm::uvec2(0));
        for (std::uint32_t i = 0; i < keys.size(); ++i) pairs[i] = {keys[i], i};
        std::vector<glm::uvec2> expected(pairs.begin(),
                                         pairs.begin() + static_cast<std::ptrdiff_t>(keys.size()));
        std::stable_sort(expected.begin(), expected.end(),
                         [](const glm::uvec2& a, const glm::uvec2& b) { return a.x < b.x; });
        gl::Buffer buffer = gl::Buffer::of(pairs);
        RadixSort sort(shaders_, static_cast<std::uint32_t>(capacity));
        sort.sort(buffer, static_cast<std::uint32_t>(keys.size()), keyBits);
        EXPECT_TRUE(buffer.read<glm::uvec2>(keys.size()) == expected)
            << keys.size() << " keys of " << keyBits << " bits";
    }
    std::vector<std::uint32_t> randomKeys(std::size_t count, std::uint32_t keyBits) {
        std::vector<std::uint32_t> keys(count);
        for (std::uint32_t& key : keys) key = random_.next() >> (32 - keyBits);
        return keys;
    }

    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    Random random_{7};
};

TEST_F(RadixSortTest, AgreesWithAStableSort) {
    for (const std::size_t count : {1U, 2U, 63U, 64U, 65U, RadixSort::kTileSize - 1,
                                    RadixSort::kTileSize, RadixSort::kTileSize + 1, 50'001U}) {
        expectSorted(randomKeys(count, 30), 30, count);
    }
}

TEST_F(RadixSortTest, KeepsTheOrderOfEqualKeys) {
    expectSorted(randomKeys(30'000, 2), 30, 30'000);  // four different keys
    expectSorted(std::vector<std::uint32_t>(30'000, 0x3FFFFFFFU), 30, 30'000);
}

TEST_F(RadixSortTest, TakesOtherWidthsAndLessThanItsCapacity) {
    expectSorted(randomKeys(5'000, 1), 1, 5'000);
    expectSorted(randomKeys(5'000, 12), 12, 5'000);
    expectSorted(randomKeys(5'000, 32), 32, 5'000);
    expectSorted(randomKeys(5'000, 30), 30, 9'000);
}

TEST_F(RadixSortTest, SortsNothingAtAll) {
    gl::Buffer pairs = gl::Buffer::of(std::vector<glm::uvec2>{{5, 6}});
    RadixSort(shaders_, 1).sort(pairs, 0, 30);
    EXPECT_EQ(pairs.read<glm::uvec2>(1).front(), glm::uvec2(5, 6));
}

}  // namespace
}  // namespace gfxrepro::reflections
