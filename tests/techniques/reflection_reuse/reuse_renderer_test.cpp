// Algorithm 8 in a room with mirrors, against rays traced from every sample.
#include "techniques/reflection_reuse/reuse_renderer.h"

#include <algorithm>
#include <cmath>

#include "techniques/reflection_reuse/reprojection.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflection_reuse/key_frame.h"
#include "tests/techniques/reflections/gl_calls.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflection_reuse {
namespace {

using reflections::HostGBuffer;

/// Of the objects of mirrorRoom(); behind it is the ball alone.
constexpr std::size_t kBlock = 7;

scene::Mesh sphere(const glm::vec3& centre, float radius) {
    return reflections::dome(centre, radius, glm::pi<float>(), 48, 24);
}

/// Four metres wide, with a mirror for the wall at −z; opposite a row of posts, between them a
/// block and a ball that mirrors.
scene::Scene mirrorRoom() {
    using reflections::matt;
    scene::Scene scene{.name = "mirror_room"};
    reflections::addRoom(
        scene, {{-2, -1.5F, -2}, {2, 1.5F, 2}},
        {matt({0.9F, 0.2F, 0.2F}), matt({0.2F, 0.8F, 0.3F}), matt({0.6F, 0.5F, 0.4F}),
         matt({0.8F, 0.8F, 0.8F}), reflections::mirror(), matt({0.3F, 0.4F, 0.9F})});
    scene::MeshBuilder posts;
    for (int i = 0; i < 8; ++i) {
        posts.addBox({-1.75F + 0.5F * static_cast<float>(i), 0, 1.8F}, {0.12F, 1.5F, 0.1F});
    }
    reflections::addPart(scene, posts.take("posts", 0), matt({0.9F, 0.9F, 0.7F}));
    reflections::addPart(scene, reflections::block({{-0.2F, -0.5F, -0.9F}, {0.3F, 0.1F, -0.5F}}),
                         matt({0.9F, 0.8F, 0.1F}));
    reflections::addPart(scene, sphere({-0.9F, -0.4F, -0.9F}, 0.4F), reflections::mirror());
    return scene;
}

/// What was seen of a frame, rows from the bottom.
struct Frame {
    HostGBuffer gbuffer;
    std::vector<glm::vec3> radiance;
    std::vector<std::uint8_t> recomputed;
    ReuseCounts counts;
    double matchingSteps = 0.0;
};

struct ReuseTest : reflections::ReflectionsTest {
    static constexpr glm::ivec2 kSize{120, 96};

    /// A scene, its truth, and what reuses reflections in it.
    struct World {
        reflections::ReflectiveScene scene;
        reflections::GpuObjects objects;
        reflections::EnvironmentMap map;
        reflections::EmbreeTracer tracer;
        ReuseRenderer renderer;
        gl::Profiler profiler{true};

        World(const gl::ShaderLibrary& shaders, const scene::Scene& source,
              const ReuseSettings& settings)
            : scene(source),
              objects(scene),
              map(shaders, scene),
              tracer(scene, {}),
              renderer(shaders, objects, tracer, settings, kSize, scene.diagonalM()) {
            map.render(objects);
            tracer.update(objects, profiler);
        }
        Frame render(const scene::Camera& camera) {
            renderer.render(kit::viewOf(camera, kSize), profiler);
            Frame frame;
            frame.gbuffer = readGBuffer(renderer.gbuffer());
            frame.radiance = renderer.reflection().radiance.read<glm::vec3>(GL_RGB, GL_FLOAT, 1);
            frame.recomputed = reflections::readMask(renderer.recomputed());
            frame.counts = renderer.counts();
            if (!frame.counts.isKeyFrame && renderer.shifted()) {
                frame.matchingSteps =
                    countMatches(renderer.keyFrame(), renderer.offsets()).meanSteps();
            }
            return frame;
        }
        std::vector<reflections::TracedSample> truth(const Frame& frame) const {
            return tracer.trace(frame.gbuffer);
        }
    };

    /// Over the reflective samples; the largest value is 1.
    static double psnrDb(const World& world, const Frame& frame) {
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        return reflections::psnrDb(frame.gbuffer, frame.radiance,
                                   [&](std::size_t i) { return truth[i].radiance; });
    }

    /// Over the reflective samples, of any channel, from `radianceOf(sample)`.
    template <class RadianceOf>
    static float largestError(const Frame& frame, const RadianceOf& radianceOf) {
        float largest = 0.0F;
        reflections::forEachReflective(frame.gbuffer, [&](glm::ivec2, std::size_t i) {
            largest =
                std::max(largest, reflections::largestDifference(frame.radiance[i], radianceOf(i)));
        });
        return largest;
    }
    static float largestError(const World& world, const Frame& frame) {
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        return largestError(frame, [&](std::size_t i) { return truth[i].radiance; });
    }

    static double share(const ReuseCounts& counts) {
        return static_cast<double>(counts.recomputedSamples) / counts.reflectiveSamples;
    }

    /// Before the mirror, looking at it; moved by `x` metres along it.
    static scene::Camera front(float x = 0.0F) {
        return reflections::camera({0.5F + x, 0.2F, 1.2F}, {0.1F + x, 0, -2});
    }
    /// At a wall that does not mirror.
    static scene::Camera atMattWall() {
        return reflections::camera({0.5F, 0.2F, 0}, {0.5F, 0.1F, 2});
    }
};

/// As the thesis has them; {} is the default.
const ReuseSettings kPrintedSettings{.matching = {.matching = Matching::FirstOrder},
                                     .reprojection = {.resampling = Resampling::Twice}};

TEST_F(ReuseTest, TheFirstFrameIsAKeyFrameAndTraced) {
    World world(shaders, mirrorRoom(), {});
    const Frame frame = world.render(front());
    EXPECT_TRUE(frame.counts.isKeyFrame);
    EXPECT_GT(frame.counts.reflectiveSamples, 5000U);
    EXPECT_EQ(frame.counts.recomputedSamples, frame.counts.reflectiveSamples);
    EXPECT_GT(psnrDb(world, frame), 60.0);  // halves
}

TEST_F(ReuseTest, ACameraThatStandsStillRecomputesNothing) {
    for (const ReuseSettings& settings : {ReuseSettings{}, kPrintedSettings, {.isDirect = true}}) {
        World world(shaders, mirrorRoom(), settings);
        const Frame key = world.render(front());
        for (int i = 0; i < 2; ++i) {
            const Frame frame = world.render(front());
            EXPECT_FALSE(frame.counts.isKeyFrame);
            EXPECT_EQ(frame.counts.recomputedSamples, 0U);
            EXPECT_EQ(frame.counts.reflectiveSamples, key.counts.reflectiveSamples);
            // One unit of the last place of a half in [½, 1], twice: interpolation at a corner
            // rounds, in the shift and in the warp.
            EXPECT_LE(largestError(frame, [&](std::size_t s) { return key.radiance[s]; }),
                      2.0F / 2048.0F);
        }
    }
}

TEST_F(ReuseTest, GatheredAMirrorKeepsItsImageToo) {
    World gathered(shaders, mirrorRoom(), {.keyFrameThreshold = 1.0F});
    gathered.render(front());
    for (const float x : {0.1F, 0.2F}) {
        const Frame frame = gathered.render(front(x));
        // Sharp edges that miss by half a pixel cost more of it than blurred ones (27 dB).
        EXPECT_GT(psnrDb(gathered, frame), 24.0) << x;
        EXPECT_LT(share(frame.counts), 0.35) << x;
    }
}

TEST_F(ReuseTest, EveryReflectiveSampleIsReusedOrRecomputed) {
    World world(shaders, mirrorRoom(), {.keyFrameThreshold = 1.0F});
    world.render(front());
    for (const float x : {0.02F, 0.1F, 0.3F}) {
        const Frame frame = world.render(front(x));
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        std::uint32_t reflective = 0, recomputed = 0;
        for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
            if (frame.gbuffer.isReflective(i)) {
                ++reflective;
                EXPECT_TRUE(std::isfinite(frame.radiance[i].x + frame.radiance[i].y));
                EXPECT_GT(frame.radiance[i].x, 0.0F);  // nothing in the room is black
            }
            if (frame.recomputed[i] == 0) continue;
            ++recomputed;
            EXPECT_TRUE(frame.gbuffer.isReflective(i));
            // Just what the tracer says.
            EXPECT_LE(reflections::largestDifference(frame.radiance[i], truth[i].radiance), 1e-3F);
        }
        EXPECT_EQ(frame.counts.reflectiveSamples, reflective);
        EXPECT_EQ(frame.counts.recomputedSamples, recomputed);
        EXPECT_GT(recomputed, 0U);
        EXPECT_LT(recomputed, reflective / 2);
    }
}

TEST_F(ReuseTest, AMirrorKeepsItsImageWhenTheEyeMoves) {
    World world(shaders, mirrorRoom(), kPrintedSettings);
    World direct(shaders, mirrorRoom(), {.isDirect = true});
    world.render(front());
    direct.render(front());
    for (const float x : {0.1F, 0.2F}) {
        const Frame frame = world.render(front(x));
        ASSERT_FALSE(frame.counts.isKeyFrame);
        EXPECT_LT(share(frame.counts), 0.1);
        const double reusedDb = psnrDb(world, frame);
        // Offsets are whole pixels: edges of the room's corners and of the block miss by up to one.
        EXPECT_GT(reusedDb, 23.0) << x;
        EXPECT_GT(reusedDb, psnrDb(direct, direct.render(front(x))) + 3.0) << x;
    }
}

TEST_F(ReuseTest, OnlyWhatTheKeyFrameDidNotSeeIsRecomputed) {
    scene::Scene scene = mirrorRoom();
    scene.instances.resize(kBlock + 1);  // no ball: every reflection is in the plane z = −2
    World world(shaders, scene, kPrintedSettings);
    const Frame key = world.render(front());
    const std::vector<reflections::TracedSample> keyTruth = world.truth(key);
    const Frame frame = world.render(front(0.1F));
    ASSERT_FALSE(frame.counts.isKeyFrame);
    const std::vector<reflections::TracedSample> truth = world.truth(frame);
    const glm::vec3 keyEye = key.gbuffer.view.eyeWorld;

    std::uint32_t wronglyRecomputed = 0;
    reflections::forEachReflective(frame.gbuffer, [&](glm::ivec2 pixel, std::size_t i) {
        if (frame.recomputed[i] == 0) return;
        // The image behind the mirror, and where the key frame's eye sees it.
        const glm::vec3 reflected = frame.gbuffer.positionWorld(pixel) +
                                    truth[i].distanceM * frame.gbuffer.mirrorDirection(pixel);
        const glm::vec3 image(reflected.x, reflected.y, -4.0F - reflected.z);
        const auto seenAt = kit::pixelOf(key.gbuffer.view, image);
        if (!seenAt) return;
        // Two samples around, all mirroring the same object at the same distance: the image was
        // seen, and no edge is near.
        const float distanceM =
            glm::distance(image, keyEye) * (1.0F - (-2.0F - keyEye.z) / (image.z - keyEye.z));
        for (int y = -2; y <= 2; ++y) {
            for (int x = -2; x <= 2; ++x) {
                const glm::ivec2 at = *seenAt + glm::ivec2(x, y);
                if (key.gbuffer.reflectorAt(at) == 0) return;
                const float keyM = keyTruth[key.gbuffer.indexOf(at)].distanceM;
                if (std::abs(keyM - distanceM) > 0.2F) return;
                // The surface itself has to be seen from both views, too.
                if (!frame.gbuffer.isReflective(frame.gbuffer.indexOf(pixel))) return;
            }
        }
        ++wronglyRecomputed;
    });
    // Stray samples whose search ends early.
    EXPECT_LE(wronglyRecomputed, frame.counts.reflectiveSamples / 100);
    EXPECT_GT(frame.counts.recomputedSamples, 0U);
}

TEST_F(ReuseTest, AJumpIsTracedWholeAndTheNextFrameIsAKeyFrame) {
    scene::Scene scene = mirrorRoom();
    scene.materials[5] = reflections::mirror();  // the wall at +z, behind the camera
    World world(shaders, scene, {});
    world.render(front());
    const Frame jump = world.render(atMattWall());
    EXPECT_FALSE(jump.counts.isKeyFrame);
    EXPECT_GT(jump.counts.reflectiveSamples, 1000U);
    EXPECT_EQ(jump.counts.recomputedSamples, jump.counts.reflectiveSamples);
    EXPECT_GT(psnrDb(world, jump), 60.0);
    EXPECT_TRUE(world.render(atMattWall()).counts.isKeyFrame);
    const Frame after = world.render(atMattWall());
    EXPECT_FALSE(after.counts.isKeyFrame);
    EXPECT_EQ(after.counts.recomputedSamples, 0U);
}

TEST_F(ReuseTest, TheThresholdDecidesOnTheNextFrame) {
    const auto keyFrames = [&](float threshold, float step) {
        World world(shaders, mirrorRoom(), {.keyFrameThreshold = threshold});
        std::string pattern;
        double former = 0.0;
        for (int i = 0; i < 7; ++i) {
            const ReuseCounts counts = world.render(front(static_cast<float>(i) * step)).counts;
            if (i > 0 && threshold > 0.0F) {
                EXPECT_EQ(counts.isKeyFrame, former > double{threshold}) << i;
            }
            former = counts.isKeyFrame ? 0.0 : share(counts);
            pattern += counts.isKeyFrame ? 'k' : '.';
        }
        return pattern;
    };
    EXPECT_EQ(keyFrames(0.0F, 0.05F), "k.k.k.k");
    EXPECT_EQ(keyFrames(0.0F, 0.0F), "k......");  // nothing to recompute
    EXPECT_EQ(keyFrames(1.0F, 0.2F), "k......");
    const std::string middle = keyFrames(0.24F, 0.1F);
    EXPECT_GT(std::count(middle.begin(), middle.end(), 'k'), 1) << middle;
    EXPECT_LT(std::count(middle.begin(), middle.end(), 'k'), 4) << middle;
}

TEST_F(ReuseTest, ReflectorsMayLeaveTheViewAndComeBack) {
    World world(shaders, mirrorRoom(), {});
    const Frame key = world.render(front());
    for (int i = 0; i < 2; ++i) {
        const Frame away = world.render(atMattWall());
        EXPECT_FALSE(away.counts.isKeyFrame);
        EXPECT_EQ(away.counts.reflectiveSamples, 0U);
        EXPECT_EQ(away.counts.recomputedSamples, 0U);
    }
    const Frame back = world.render(front());
    EXPECT_FALSE(back.counts.isKeyFrame);
    EXPECT_LT(share(back.counts), 0.05);
    EXPECT_GT(psnrDb(world, back), 30.0);
}

TEST_F(ReuseTest, AKeyFrameWithoutReflectorsHasNothingToReuse) {
    World world(shaders, mirrorRoom(), {});
    EXPECT_EQ(world.render(atMattWall()).counts.reflectiveSamples, 0U);
    const Frame frame = world.render(front());
    EXPECT_FALSE(frame.counts.isKeyFrame);
    EXPECT_EQ(frame.counts.recomputedSamples, frame.counts.reflectiveSamples);
    EXPECT_TRUE(world.render(front()).counts.isKeyFrame);
}

TEST_F(ReuseTest, SearchesBeginWhereTheLastOnesEnded) {
    ReuseSettings settings{.keyFrameThreshold = 1.0F,
                           .matching = {.matching = Matching::SecondOrder},
                           .reprojection = {.resampling = Resampling::Twice}};
    World world(shaders, mirrorRoom(), settings);
    world.render(front());
    const double first = world.render(front(0.1F)).matchingSteps;
    EXPECT_GT(first, 0.5);
    EXPECT_LT(world.render(front(0.1F)).matchingSteps, 0.5 * first);
    // Offsets of another key frame would send the search astray.
    settings.keyFrameThreshold = 0.0F;
    World often(shaders, mirrorRoom(), settings);
    often.render(front());
    EXPECT_EQ(often.render(front(0.1F)).matchingSteps, first);
    EXPECT_TRUE(often.render(front(0.1F)).counts.isKeyFrame);
    EXPECT_LT(often.render(front(0.1F)).matchingSteps, 0.1);
}

TEST_F(ReuseTest, TheDeviceHasAFrameToDrawWhileTheLastOnesCountIsWaitedFor) {
    World world(shaders, mirrorRoom(), {});
    world.render(front());
    world.render(front(0.02F));
    gl::Profiler untimed(false);
    reflections::glCalls().clear();
    world.renderer.render(kit::viewOf(front(0.04F), kSize), untimed);
    const std::vector<reflections::GlCall>& calls = reflections::glCalls();
    const auto firstWait = std::ranges::find(calls, reflections::GlCall::Wait);
    EXPECT_EQ(std::count(calls.begin(), firstWait, reflections::GlCall::DrawObject),
              world.objects.objectCount());  // its G-buffer
}

TEST_F(ReuseTest, PassesAreThoseOfTheThesis) {
    World world(shaders, mirrorRoom(), kPrintedSettings);
    world.render(front());
    world.profiler.collect();
    world.render(front(0.05F));
    std::vector<std::string> passes;
    for (const gl::PassTime& time : world.profiler.collect()) passes.push_back(time.pass);
    EXPECT_EQ(passes, (std::vector<std::string>{"diffuse", "pixel_matching", "reflection_shift",
                                                "reflection_warp", "recompute", "transfer",
                                                "intersection"}));
}

// The gather on the device, against mirrors that can be worked out by hand: where the key frame
// sees what a sample of the new view reflects.

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
        for (const auto [y, x] : test::grid(kGatherSizePx.y, kGatherSizePx.x)) {
            places.emplace_back(glm::vec2(x, y) + 0.5F - middle, 0, 1);
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
