// The gather on the device, against mirrors that can be worked out by hand: where the key frame
// sees what a sample of the new view reflects.

#include "techniques/reflection_reuse/reprojection.h"
#include "tests/techniques/reflection_reuse/key_frame.h"

namespace gfxrepro::reflection_reuse {
namespace {

constexpr glm::ivec2 kGatherSizePx(128, 96);
constexpr float kBallRadiusM = 0.6F;
constexpr glm::vec3 kBallCentre(0.0F, 0.9F, 0.0F);

/// A convex reflector as fine as its analytic form.
scene::Scene roomWithFineBall() {
    scene::Scene scene = mattRoom();
    addPart(scene, reflections::dome(kBallCentre, kBallRadiusM, glm::pi<float>(), 192, 96),
            reflections::mirror());
    return scene;
}

/// Where an eye sees the reflection of a point in the floor y = 0.
glm::vec3 seenInMirrorFloor(const glm::vec3& point, const glm::vec3& eye) {
    const glm::dvec3 image(point.x, -point.y, point.z), from(eye);
    return image + (from - image) * (-image.y / (from.y - image.y));
}

/// Where an eye sees the reflection of a point in the ball: between the directions to the two from
/// its centre, where both rays have the same angle to the normal (Alhazen's problem), by bisection.
glm::vec3 seenInFineBall(const glm::vec3& point, const glm::vec3& eyeWorld) {
    const glm::dvec3 toEye = glm::dvec3(eyeWorld - kBallCentre),
                     toPoint = glm::dvec3(point - kBallCentre);
    const glm::dvec3 a = glm::normalize(toEye), b = glm::normalize(toPoint);
    double low = 0.0, high = 1.0;
    glm::dvec3 normal = a;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const double angle = std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0));
        normal =
            (std::sin((1.0 - middle) * angle) * a + std::sin(middle * angle) * b) / std::sin(angle);
        const glm::dvec3 surface = double{kBallRadiusM} * normal;
        const double ofEye = glm::dot(glm::normalize(toEye - surface), normal);
        const double ofPoint = glm::dot(glm::normalize(toPoint - surface), normal);
        (ofEye > ofPoint ? low : high) = middle;
    }
    return kBallCentre + kBallRadiusM * glm::vec3(normal);
}

struct GatherTest : KeyFrameTest {
    struct Gathered {
        reflections::HostGBuffer gbuffer;  // of the new view
        std::vector<float> distanceM;      // of its mirror rays, by Embree
        std::vector<glm::vec2> place;      // pixels of the key frame
        std::vector<std::uint8_t> wanted;

        /// What a sample reflects.
        glm::vec3 reflectedWorld(glm::ivec2 pixel) const {
            return gbuffer.positionWorld(pixel) +
                   distanceM[gbuffer.indexOf(pixel)] * gbuffer.mirrorDirection(pixel);
        }
    };

    /// The key frame from `camera`, gathered into the view of one that is moved. Its radiance is
    /// where it is: what is gathered is the place, to halves of it from the middle.
    Gathered gather(const scene::Scene& source, const scene::Camera& camera,
                    const glm::vec3& move) {
        key.emplace(shaders, source, camera, kGatherSizePx);
        const glm::vec2 middle = 0.5F * glm::vec2(kGatherSizePx);
        std::vector<glm::vec4> places;
        for (int y = 0; y < kGatherSizePx.y; ++y) {
            for (int x = 0; x < kGatherSizePx.x; ++x) {
                places.emplace_back(glm::vec2(x, y) + 0.5F - middle, 0, 1);
            }
        }
        key->image.reflection.radiance.upload(GL_RGBA, GL_FLOAT, places.data());
        scene::Camera moved = camera;
        moved.position += move;
        moved.target += move;
        const KeyFrame now(shaders, source, moved, kGatherSizePx);
        Reprojection reprojection(shaders, {.resampling = Resampling::Gather}, kGatherSizePx);
        reflections::ReflectionTarget target(kGatherSizePx);
        gl::Texture wanted = gl::Texture::make2D(GL_R8UI, kGatherSizePx);
        reprojection.setKeyFrame(key->image);
        reprojection.gather(key->image, now.image.gbuffer, target, wanted);
        Gathered result{now.host.gbuffer, now.host.distanceM,
                        target.radiance.read<glm::vec2>(GL_RG, GL_FLOAT, 1),
                        reflections::readMask(wanted)};
        for (glm::vec2& place : result.place) place += middle;
        EXPECT_EQ(static_cast<int>(reprojection.reflectiveSamples()),
                  reflections::forEachReflective(result.gbuffer, [](glm::ivec2, std::size_t) {}));
        return result;
    }

    /// Samples of the key frame's reflector around a place, of nine.
    int countAround(const glm::vec2& placePx, int reflector) const {
        int count = 0;
        for (int i = 0; i < 9; ++i) {
            const glm::ivec2 at =
                glm::ivec2(glm::floor(placePx)) + glm::ivec2(i % 3 - 1, i / 3 - 1);
            count += key->host.gbuffer.reflectorAt(at) == reflector ? 1 : 0;
        }
        return count;
    }

    /// Each sample's place lies where `seenIn(point, eye)` says, or it is wanted. How many of those
    /// there are whose place or own surface the key frame does not show.
    template <class SeenIn>
    int expectPlaces(const Gathered& result, const SeenIn& seenIn, float meanErrorPx) const {
        int inside = 0, outside = 0, wanted = 0, far = 0;
        float errorSumPx = 0.0F, movedPx = 0.0F;
        reflections::forEachReflective(result.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
            const glm::vec3 seen = seenIn(result.reflectedWorld(pixel), key->eyeWorld());
            const glm::vec2 expected = kit::project(key->image.gbuffer.view, seen).value();
            const int around = std::min(countAround(expected, result.gbuffer.reflector(index)),
                                        ownAround(result, pixel));
            if (around == 0) {
                ++outside;
                EXPECT_EQ(result.wanted[index], 1) << pixel.x << ", " << pixel.y;
            }
            if (around < 9 || isEdge(result, pixel, expected)) return;
            ++inside;
            wanted += result.wanted[index];
            if (result.wanted[index] != 0) return;
            const float errorPx = glm::length(result.place[index] - expected);
            far += errorPx > 0.5F ? 1 : 0;
            errorSumPx += errorPx;
            const glm::vec2 here = glm::vec2(pixel) + 0.5F;
            movedPx = std::max(movedPx, glm::length(result.place[index] - here));
        });
        EXPECT_GT(inside, 1500);
        EXPECT_GT(movedPx, 2.0F);
        // Next to the rim, where the reflection bends most.
        EXPECT_LE(wanted, 0.005 * inside) << wanted << " of " << inside;
        EXPECT_LE(far, 0.01 * inside) << far << " of " << inside;
        EXPECT_LE(errorSumPx / static_cast<float>(inside), meanErrorPx);
        return outside;
    }
    /// Whether samples of the key frame around a place show what is farther or nearer than what a
    /// sample reflects.
    bool isEdge(const Gathered& result, glm::ivec2 pixel, const glm::vec2& placePx) const {
        const float lengthM = result.distanceM[result.gbuffer.indexOf(pixel)];
        for (int i = 0; i < 9; ++i) {
            const glm::ivec2 at =
                glm::ivec2(glm::floor(placePx)) + glm::ivec2(i % 3 - 1, i / 3 - 1);
            const float shownM = glm::distance(key->host.reflectedPositionWorld(at),
                                               result.gbuffer.positionWorld(pixel));
            if (std::abs(shownM - lengthM) > 0.08F * lengthM) return true;
        }
        return false;
    }
    /// Samples of the reflector where the key frame sees the sample's own place.
    int ownAround(const Gathered& result, glm::ivec2 pixel) const {
        const std::optional<glm::vec2> own =
            kit::project(key->image.gbuffer.view, result.gbuffer.positionWorld(pixel));
        return own ? countAround(*own, result.gbuffer.reflectorAt(pixel)) : 0;
    }

    std::optional<KeyFrame> key;
};

TEST_F(GatherTest, PlanarMirrorsShowThePointWhereItIsFound) {
    int outside = 0;
    for (const glm::vec3& move : {glm::vec3(0.15F, 0, 0), glm::vec3(-0.2F, 0.1F, 0),
                                  glm::vec3(0.1F, -0.15F, -0.3F), glm::vec3(0, 0.3F, 0.2F)}) {
        const Gathered result = gather(roomWithMirrorFloor(), aboveFloor(), move);
        outside += expectPlaces(result, seenInMirrorFloor, 0.02F);
    }
    EXPECT_GT(outside, 100);
}

TEST_F(GatherTest, BallsShowThePointWhereItIsFound) {
    for (const glm::vec3& move : {glm::vec3(0.15F, 0, 0), glm::vec3(-0.2F, 0.1F, 0.1F)}) {
        const Gathered result = gather(roomWithFineBall(), beforeBall(), move);
        expectPlaces(result, seenInFineBall, 0.1F);
    }
}

/// Posts before a wall: the key frame shows, from beside, what of the wall they hide now.
TEST_F(GatherTest, OfSeveralPlacesTheNearestPointCounts) {
    scene::Scene source = roomWithMirrorFloor();
    for (int i = 0; i < 4; ++i) {
        const float x = -0.9F + 0.5F * static_cast<float>(i);
        addPart(source, reflections::block({{x, 0.3F, -1.1F}, {x + 0.15F, 1.6F, -1.09F}}),
                reflections::matt({0.9F, 0.2F, 0.9F}));
    }
    const Gathered result = gather(source, aboveFloor(), {0.25F, 0, 0});
    // Whether a sample of the key frame around a place shows a point.
    const auto isShown = [&](const glm::vec2& placePx, const glm::vec3& point) {
        for (int i = 0; i < 9; ++i) {
            const glm::ivec2 at =
                glm::ivec2(glm::floor(placePx)) + glm::ivec2(i % 3 - 1, i / 3 - 1);
            if (key->host.gbuffer.reflectorAt(at) != 0 &&
                glm::distance(key->host.reflectedPositionWorld(at), point) < 0.3F) {
                return true;
            }
        }
        return false;
    };
    int onPosts = 0, reused = 0, wrong = 0;
    reflections::forEachReflective(result.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const glm::vec3 point = result.reflectedWorld(pixel);
        if (result.wanted[index] != 0) return;
        ++reused;
        onPosts += point.z > -1.2F && point.z < -1.0F ? 1 : 0;
        wrong += isShown(result.place[index], point) ? 0 : 1;
    });
    EXPECT_GT(onPosts, 400);
    EXPECT_LE(wrong, 0.0075 * reused) << wrong << " of " << reused;
}

TEST_F(GatherTest, TheSameViewFindsEverySampleWhereItIs) {
    const Gathered result = gather(roomWithAll(), aboveFloor(), glm::vec3(0));
    reflections::forEachReflective(result.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        ASSERT_EQ(result.wanted[index], 0) << pixel.x << ", " << pixel.y;
        ASSERT_LE(glm::distance(result.place[index], glm::vec2(pixel) + 0.5F), 0.05F);
    });
}

TEST_F(GatherTest, OtherReflectorsAreNeverAsked) {
    const Gathered result = gather(roomWithAll(), aboveFloor(), {0.15F, 0.05F, 0});
    int found = 0;
    reflections::forEachReflective(result.gbuffer, [&](glm::ivec2, std::size_t index) {
        if (result.wanted[index] != 0) return;
        ++found;
        EXPECT_GT(countAround(result.place[index], result.gbuffer.reflector(index)), 0);
    });
    EXPECT_GT(found, 4000);
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
