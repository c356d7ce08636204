#include "techniques/kit/prefix_sum.h"

#include <vector>

#include "engine/core/random.h"
#include "tests/techniques/kit/depth_image_fixture.h"

namespace gfxrepro::kit {
namespace {

struct PrefixSumTest : DepthImageTest {
    /// What becomes of the values, with one behind them that is 77 before.
    template <class T>
    std::vector<T> summed(std::vector<T> values, const char* type, PrefixSum::Total total) {
        const auto count = static_cast<unsigned>(values.size());
        values.push_back(T(77U));
        const gl::Buffer buffer = gl::Buffer::of(values);
        PrefixSum(shaders, type, total).run(buffer, count);
        return buffer.read<T>(values.size());
    }
};

TEST_F(PrefixSumTest, SumsWhatIsBeforeEachValue) {
    Random random(3);
    for (const std::size_t count : {0U, 1U, 2U, 255U, 256U, 257U, 10007U}) {
        std::vector<unsigned> values;
        std::vector<glm::uvec4> vectors;
        for (std::size_t i = 0; i < count; ++i) {
            values.push_back(static_cast<unsigned>(random.index(1000)));
            vectors.emplace_back(values.back(), 1U, 0U, static_cast<unsigned>(random.index(9)));
        }
        std::vector<unsigned> sums;
        std::vector<glm::uvec4> vectorSums;
        unsigned sum = 0;
        glm::uvec4 vectorSum(0U);
        for (std::size_t i = 0; i < count; ++i) {
            sums.push_back(sum);
            vectorSums.push_back(vectorSum);
            sum += values[i];
            vectorSum += vectors[i];
        }
        vectorSums.push_back(vectorSum);
        EXPECT_EQ(summed(vectors, "uvec4", PrefixSum::Total::Behind), vectorSums) << count;
        sums.push_back(77);  // left alone
        EXPECT_EQ(summed(values, "uint", PrefixSum::Total::None), sums) << count;
    }
}

}  // namespace
}  // namespace gfxrepro::kit
