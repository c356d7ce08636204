#include "techniques/kit/draws.h"

#include <utility>
#include <vector>

#include "tests/gl/gl_fixture.h"

namespace gfxrepro::kit {
namespace {

struct FlushedDrawsTest : test::GlTest {
    using Pieces = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    static Pieces piecesOf(FlushedDraws draws) {
        Pieces pieces;
        draws.draw(7, 100'000, [&](std::uint32_t first, std::uint32_t count) {
            pieces.emplace_back(first, count);
        });
        return pieces;
    }
};

TEST_F(FlushedDrawsTest, AreSplitOnSoftwareDevicesAlone) {
    const Pieces whole{{7, 100'000}}, split{{7, 65'536}, {7 + 65'536, 100'000 - 65'536}};
    EXPECT_EQ(piecesOf(FlushedDraws(false)), whole);
    EXPECT_EQ(piecesOf(FlushedDraws(true)), split);
    EXPECT_EQ(piecesOf(FlushedDraws()), device.info().isSoftware ? split : whole);
}

}  // namespace
}  // namespace gfxrepro::kit
