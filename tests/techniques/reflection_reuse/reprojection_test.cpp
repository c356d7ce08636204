// Shift and warp of key frames made by hand.
#include "techniques/reflection_reuse/reprojection.h"

#include <algorithm>
#include <optional>

#include "tests/support/grid.h"
#include "tests/techniques/reflections/gl_calls.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflection_reuse {
namespace {

constexpr glm::ivec2 kSize{28, 24};
/// Interpolated colours in [0, 1] are kept in halves: 11 bits.
constexpr float kHalfRounding = 1e-3F;

std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y * kSize.x + x);
}
bool isInside(int x, int y) {
    return x >= 0 && y >= 0 && x < kSize.x && y < kSize.y;
}
template <class Action>
void forEachPixel(Action&& action) {
    for (const auto [y, x] : test::grid(kSize.y, kSize.x)) action(x, y);
}

/// Texels of a key frame; one mirror over the whole image, every colour another one.
struct Samples {
    std::vector<std::uint32_t> surface = std::vector<std::uint32_t>(at(0, kSize.y), 1U);
    std::vector<float> depthM = std::vector<float>(at(0, kSize.y), 2.0F);
    std::vector<float> distanceM = std::vector<float>(at(0, kSize.y), 1.0F);
    std::vector<glm::vec2> offset = std::vector<glm::vec2>(at(0, kSize.y), glm::vec2(0.0F));
    std::vector<glm::vec4> radiance;

    Samples() {
        Random random(4);
        forEachPixel(
            [&](int, int) { radiance.emplace_back(reflections::randomIn(random, 0.1F, 1), 1); });
    }
};

kit::View view(const glm::vec3& eyeWorld = glm::vec3(0.0F)) {
    return kit::viewOf(reflections::camera(eyeWorld, eyeWorld - glm::vec3(0, 0, 1)), kSize);
}
/// The eye `pixels` whole pixels of a wall at 2 m to the right: from (x·d, y·d, d) to the world.
kit::View viewToTheRight(float pixels) {
    return view(glm::vec3(kit::worldFromPixels(view()) * glm::vec4(pixels * 2.0F, 0, 0, 0)));
}

/// What the eye sees now; at first what a key frame's samples are of.
struct Seen {
    std::vector<std::uint32_t> surface;
    std::vector<float> depthM;
    kit::View from;

    explicit Seen(const Samples& samples, const kit::View& fromView = view())
        : surface(samples.surface), depthM(samples.depthM), from(fromView) {}
};

struct ReprojectionTest : reflections::ReflectionsTest {
    void upload(const Samples& samples) {
        key.emplace(view(), 10.0F);
        offsets.emplace(kSize);
        key->gbuffer.surface.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, samples.surface.data());
        key->gbuffer.depth.upload(GL_RED, GL_FLOAT, samples.depthM.data());
        key->reflection.radiance.upload(GL_RGBA, GL_FLOAT, samples.radiance.data());
        key->reflection.distance.upload(GL_RED, GL_FLOAT, samples.distanceM.data());
        offsets->offset.upload(GL_RG, GL_FLOAT, samples.offset.data());
    }

    std::vector<glm::vec4> shifted(const Samples& samples,
                                   const ReprojectionSettings& settings = {}) {
        upload(samples);
        Reprojection reprojection(shaders, settings, kSize);
        ShiftedImage result(kSize);
        reprojection.setKeyFrame(*key);
        reprojection.shift(*key, *offsets, result);
        return result.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    }

    struct Moved {
        std::vector<glm::vec4> radiance;
        std::vector<std::uint8_t> wanted;
        std::uint32_t reflectiveSamples = 0;
        std::size_t wantedCount() const {
            return static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1));
        }
    };
    /// The key frame's own colours, to what is seen.
    Moved warped(const Samples& samples, const Seen& seen,
                 const ReprojectionSettings& settings = {}) {
        upload(samples);
        reflections::GBuffer gbuffer(seen.from);
        gbuffer.surface.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, seen.surface.data());
        gbuffer.depth.upload(GL_RED, GL_FLOAT, seen.depthM.data());
        Reprojection reprojection(shaders, settings, kSize);
        reflections::ReflectionTarget target(kSize);
        gl::Texture wanted = gl::Texture::make2D(GL_R8UI, kSize);
        reprojection.setKeyFrame(*key);
        reprojection.warp(*key, key->reflection.radiance, gbuffer, target, wanted);
        return {target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1),
                reflections::readMask(wanted), reprojection.reflectiveSamples()};
    }
    Moved warped(const Samples& samples) { return warped(samples, Seen(samples)); }

    static void expectColour(const glm::vec4& found, const glm::vec4& expected, int x, int y) {
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(found[c], expected[c], kHalfRounding) << x << " " << y << " " << c;
        }
    }

    std::optional<ReflectionDepthImage> key;
    std::optional<Offsets> offsets;
};

TEST_F(ReprojectionTest, AConstantOffsetMovesTheImage) {
    for (const Forward forward : {Forward::Grid, Forward::Splats}) {
        Samples samples;
        for (glm::vec2& offset : samples.offset) offset = {3, -2};
        const std::vector<glm::vec4> result = shifted(samples, {.forward = forward});
        forEachPixel([&](int x, int y) {
            const glm::vec4 expected =
                isInside(x - 3, y + 2) ? samples.radiance[at(x - 3, y + 2)] : glm::vec4(0.0F);
            expectColour(result[at(x, y)], expected, x, y);
        });
    }
}

/// A reflection that moves by eight pixels onto another one: of both the one with the shorter path
/// from the eye wins.
TEST_F(ReprojectionTest, TheNearestReflectionWins) {
    const struct {
        float movedDepthM, movedDistanceM, otherDepthM, otherDistanceM;
        bool movedOneWins;
    } cases[] = {{2.0F, 0.5F, 2.0F, 6.0F, true},
                 {2.0F, 6.0F, 2.0F, 0.5F, false},
                 // The one that is nearer to its mirror is farther from the eye.
                 {8.0F, 1.0F, 2.0F, 4.0F, false},
                 // A ray that left the scene reflects the farthest: the diagonal is 10.
                 {2.0F, 0.0F, 2.0F, 9.0F, false}};
    for (const auto& one : cases) {
        Samples samples;
        forEachPixel([&](int x, int y) {
            const bool isMoved = x < 12;
            samples.offset[at(x, y)] = {isMoved ? 8 : 0, 0};
            samples.depthM[at(x, y)] = isMoved ? one.movedDepthM : one.otherDepthM;
            samples.distanceM[at(x, y)] = isMoved ? one.movedDistanceM : one.otherDistanceM;
        });
        const std::vector<glm::vec4> result = shifted(samples);
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 13; x < 19; ++x) {  // both are there
                const int from = one.movedOneWins ? x - 8 : x;
                expectColour(result[at(x, y)], samples.radiance[at(from, y)], x, y);
            }
        }
    }
}

/// A patch of 4 × 4 samples around the middle, drawn apart to `scale` times its size; the other
/// samples have no match.
void drawApart(Samples& samples, float scale) {
    forEachPixel([&](int x, int y) {
        const bool isPatch = x >= 12 && x < 16 && y >= 10 && y < 14;
        const glm::vec2 toMiddle = glm::vec2(x, y) - glm::vec2(13.5F, 11.5F);
        samples.offset[at(x, y)] = isPatch ? (scale - 1.0F) * toMiddle : glm::vec2(kInvalidOffset);
    });
}

std::ptrdiff_t validCount(const std::vector<glm::vec4>& image) {
    return std::count_if(image.begin(), image.end(), [](const auto& t) { return t.a == 1.0F; });
}

TEST_F(ReprojectionTest, TrianglesMayGrowSixteenfold) {
    Samples samples;
    drawApart(samples, 3.9F);  // 15.2 times the area: 11.7 pixels wide
    EXPECT_GE(validCount(shifted(samples)), 11 * 11);
    drawApart(samples, 4.1F);  // 16.8 times
    // But for the samples themselves on the patch's rim.
    EXPECT_LE(validCount(shifted(samples)), 12);
    EXPECT_GE(validCount(shifted(samples, {.maxGrowth = 17.0F})), 12 * 12);
}

/// A patch that grows too much, and around it what stays where it is, farther.
Samples grownPatch() {
    Samples samples;
    drawApart(samples, 4.1F);
    forEachPixel([&](int x, int y) {
        if (x >= 11 && x < 17 && y >= 9 && y < 15) return;
        samples.offset[at(x, y)] = {0, 0};
        samples.distanceM[at(x, y)] = 5.0F;
    });
    return samples;
}

TEST_F(ReprojectionTest, TrianglesThatGrowTooMuchHideWhatIsFarther) {
    Samples samples = grownPatch();
    const std::vector<glm::vec4> result = shifted(samples);
    // Inside of the patch, which reaches from x = 13.5 − 1.5 · 4.1 to the right; without it the
    // surroundings show, up to x = 10.
    EXPECT_EQ(result[at(9, 12)].a, 0.0F);
    for (int y = 9; y < 15; ++y) {
        for (int x = 11; x < 17; ++x) samples.offset[at(x, y)] = glm::vec2(kInvalidOffset);
    }
    EXPECT_EQ(shifted(samples)[at(9, 12)].a, 1.0F);
}

TEST_F(ReprojectionTest, NothingIsStretchedAcrossASilhouette) {
    Samples samples;
    forEachPixel([&](int x, int y) {
        samples.offset[at(x, y)] = {x < 14 ? -4 : 4, 0};  // a cell of 9 times its area between
        samples.depthM[at(x, y)] = x < 14 ? 2.0F : 2.2F;
    });
    const auto middleAlpha = [&](const std::vector<glm::vec4>& image) {
        float sum = 0.0F;
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 10; x < 18; ++x) sum += image[at(x, y)].a;
        }
        return sum / static_cast<float>(8 * kSize.y);
    };
    EXPECT_EQ(middleAlpha(shifted(samples)), 0.0F);
    // All but the uppermost or the lowest row, whose upper or lower edge is drawn or not.
    EXPECT_GE(middleAlpha(shifted(samples, {.silhouette = 0.2F})), 0.9F);
    forEachPixel([&](int x, int y) {
        samples.depthM[at(x, y)] = 2.0F;
        samples.surface[at(x, y)] = x < 14 ? 1 : 2;
    });
    EXPECT_EQ(middleAlpha(shifted(samples)), 0.0F);
}

TEST_F(ReprojectionTest, AReflectionStaysOnItsReflector) {
    Samples samples;
    forEachPixel([&](int x, int y) {
        const bool isOther = x >= 10 && x < 16 && y >= 8 && y < 14;
        samples.surface[at(x, y)] = isOther ? 2 : 1;
        samples.offset[at(x, y)] = isOther ? glm::vec2(0.0F) : glm::vec2(5, 0);
        samples.distanceM[at(x, y)] = isOther ? 5.0F : 0.5F;
    });
    const std::vector<glm::vec4> result = shifted(samples);
    for (int y = 8; y < 14; ++y) {
        for (int x = 10; x < 16; ++x) {
            expectColour(result[at(x, y)], samples.radiance[at(x, y)], x, y);
        }
    }
}

TEST_F(ReprojectionTest, SplatsLeaveHolesWhereAGridDoesNot) {
    Samples samples;
    forEachPixel([&](int x, int y) { samples.offset[at(x, y)] = {x, 0}; });
    const std::vector<glm::vec4> grid = shifted(samples);
    const std::vector<glm::vec4> splats = shifted(samples, {.forward = Forward::Splats});
    for (int y = 1; y + 1 < kSize.y; ++y) {
        for (int x = 0; x < kSize.x; ++x) {
            EXPECT_EQ(grid[at(x, y)].a, 1.0F) << x << " " << y;
            EXPECT_EQ(splats[at(x, y)].a, x % 2 == 0 ? 1.0F : 0.0F) << x << " " << y;
        }
    }
    expectColour(grid[at(7, 5)], 0.5F * (samples.radiance[at(3, 5)] + samples.radiance[at(4, 5)]),
                 7, 5);
}

TEST_F(ReprojectionTest, TheSameViewReusesEverySample) {
    // Specks, lines and areas of three reflectors at jumping depths: nearly all are on a rim.
    Samples samples;
    Random random(11);
    forEachPixel([&](int x, int y) {
        samples.surface[at(x, y)] = x < 9 ? 1U : static_cast<std::uint32_t>(random.index(4));
        samples.depthM[at(x, y)] = x < 9 ? 3.0F : random.uniform(1.0F, 9.0F);
    });
    const Moved result = warped(samples);
    EXPECT_EQ(result.wantedCount(), 0U);
    std::uint32_t reflective = 0;
    forEachPixel([&](int x, int y) {
        if (samples.surface[at(x, y)] == 0) return;
        ++reflective;
        expectColour(result.radiance[at(x, y)], samples.radiance[at(x, y)], x, y);
    });
    EXPECT_EQ(result.reflectiveSamples, reflective);
}

TEST_F(ReprojectionTest, AWallMovesWithTheEye) {
    const Samples samples;
    const Moved result = warped(samples, Seen(samples, viewToTheRight(4.0F)));
    forEachPixel([&](int x, int y) {
        ASSERT_EQ(result.wanted[at(x, y)], x + 4 < kSize.x ? 0 : 1) << x << " " << y;
        if (x + 4 < kSize.x) {
            expectColour(result.radiance[at(x, y)], samples.radiance[at(x + 4, y)], x, y);
        }
    });
}

TEST_F(ReprojectionTest, OtherDepthsAndReflectorsAreWanted) {
    const Samples samples;
    Seen seen(samples);
    seen.depthM.assign(seen.depthM.size(), 2.0F * 1.02F);
    EXPECT_EQ(warped(samples, seen).wantedCount(), seen.depthM.size());
    EXPECT_EQ(warped(samples, seen, {.depthTolerance = 0.03F}).wantedCount(), 0U);
    seen = Seen(samples);
    seen.surface[at(5, 5)] = 2;
    seen.surface[at(6, 5)] = 0;  // nothing to want
    const Moved result = warped(samples, seen);
    EXPECT_EQ(result.wantedCount(), 1U);
    EXPECT_EQ(result.wanted[at(5, 5)], 1);
}

TEST_F(ReprojectionTest, InvalidSamplesAreWanted) {
    Samples samples;
    samples.radiance[at(9, 7)].a = 0.0F;
    samples.radiance[at(20, 3)].a = 0.0F;
    const Moved result = warped(samples);
    EXPECT_EQ(result.wantedCount(), 2U);
    EXPECT_EQ(result.wanted[at(9, 7)], 1);
    EXPECT_EQ(result.wanted[at(20, 3)], 1);
}

TEST_F(ReprojectionTest, WarpingKeepsTheRuleOfGrowthToo) {
    // Four pixels' width of the wall, from 2 m to 0.4 m: 25 times the area.
    const Samples samples;
    Seen seen(samples, view({0, 0, -1.6F}));
    seen.depthM.assign(seen.depthM.size(), 0.4F);
    EXPECT_EQ(warped(samples, seen).wantedCount(), seen.depthM.size());
    EXPECT_EQ(warped(samples, seen, {.maxGrowth = 26.0F}).wantedCount(), 0U);
}

TEST_F(ReprojectionTest, SplitDrawsCoverTheSame) {
    constexpr glm::ivec2 kLarge{300, 260};  // 461,000 indices: three draws
    const std::size_t count = 300 * 260;
    const kit::View view = kit::viewOf(reflections::camera({0, 0, 0}, {0, 0, -1}), kLarge);
    ReflectionDepthImage large(view, 10.0F);
    const std::vector<std::uint32_t> surface(count, 1);
    const std::vector<float> depthM(count, 2.0F);
    std::vector<glm::vec4> radiance;
    Random random(7);
    for (std::size_t i = 0; i < count; ++i) {
        radiance.emplace_back(reflections::randomIn(random, 0.1F, 1), 1);
    }
    large.gbuffer.surface.upload(GL_RED_INTEGER, GL_UNSIGNED_INT, surface.data());
    large.gbuffer.depth.upload(GL_RED, GL_FLOAT, depthM.data());
    large.reflection.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    large.reflection.distance.upload(GL_RED, GL_FLOAT, depthM.data());
    Offsets none(kLarge);
    none.offset.clearToZero();
    for (const Forward forward : {Forward::Grid, Forward::Splats}) {
        for (const bool splitsDraws : {false, true}) {
            Reprojection reprojection(shaders, {.forward = forward, .splitsDraws = splitsDraws},
                                      kLarge);
            ShiftedImage result(kLarge);
            reprojection.setKeyFrame(large);
            reprojection.shift(large, none, result);
            const bool isGrid = forward == Forward::Grid;
            EXPECT_EQ(reprojection.cells().counts().cells, isGrid ? 299U * 259U : 0U);
            EXPECT_EQ(reprojection.cells().counts().points, isGrid ? 2U * (300U + 258U) : count);
            const auto shown = result.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_LE(glm::distance(shown[i], radiance[i]), 2 * kHalfRounding) << i;
            }
        }
    }
}

TEST_F(ReprojectionTest, AListIsDrawnByOneCommandWhereTheDeviceNeedsNoMore) {
    using enum reflections::GlCall;
    upload(Samples());
    ShiftedImage result(kSize);
    for (const bool splitsDraws : {false, true}) {
        Reprojection reprojection(shaders, {.splitsDraws = splitsDraws}, kSize);
        reprojection.setKeyFrame(*key);
        reflections::glCalls().clear();
        reprojection.shift(*key, *offsets, result);
        const std::vector<reflections::GlCall> calls = reflections::glCalls();
        const auto count = [&](reflections::GlCall call) {
            return std::ranges::count(calls, call);
        };
        EXPECT_EQ(count(DrawList), 2);                // triangles, points
        EXPECT_EQ(count(Flush), 0);                   // short ones share a flush
        EXPECT_EQ(count(Wait), splitsDraws ? 1 : 0);  // how long the lists are
    }
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
