// The technique as a whole: parameters, metrics, methods against each other, the choice of key
// frames.
#include "techniques/reflection_reuse/reflection_reuse.h"

#include <fmt/format.h>

#include <algorithm>

#include "techniques/clustered_reflections/clustered_reflections.h"
#include "tests/techniques/clustered_reflections/room.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::reflection_reuse {
namespace {

scene::Camera cameraAt(const glm::vec3& position, const glm::vec3& target) {
    return {.position = position, .target = target, .verticalFovRad = 0.9F};
}

/// The room of chapter 4's tests: a mirror for a floor and a bent column. `walk` goes sideways,
/// `rest` and `still` (of no length) nowhere, `jump` looks down on one corner of the mirror and
/// then on others; `none` has no keys.
scene::Scene roomWithPaths() {
    scene::Scene scene = clustered_reflections::roomWithMirrors();
    const scene::Camera begin = cameraAt({0.2F, 1.2F, 1.4F}, {0, 0.35F, -0.6F});
    const scene::Camera end = cameraAt({-0.7F, 1.1F, 1.3F}, {0, 0.35F, -0.6F});
    scene.paths = {{"walk", {begin, end}},
                   {"rest", {begin}},
                   {"still", {begin, begin, begin}},
                   {"jump",
                    {cameraAt({1.2F, 0.5F, 1.2F}, {1.1F, 0, 1.1F}),
                     cameraAt({-1.2F, 0.5F, 1.2F}, {-1.1F, 0, 1.1F})}},
                   {"none", {}}};
    return scene;
}

/// Algorithms 8 and 9 as the thesis has them, which is not the default.
constexpr const char* kPrinted = ", matching: first_order, resampling: twice";

TEST(ReuseParamsTest, ReflectionsAreGatheredByDefault) {
    const auto settingsOf = [](const std::string& yaml) {
        Params params = test::paramsOf(kReflectionReuse, yaml);
        return ReuseParams(params).reuse;
    };
    EXPECT_EQ(settingsOf("{}").reprojection.resampling, Resampling::Gather);
    const ReuseSettings printed = settingsOf(fmt::format("{{method: reuse{}}}", kPrinted));
    EXPECT_EQ(printed.matching.matching, Matching::FirstOrder);
    EXPECT_EQ(printed.reprojection.resampling, Resampling::Twice);
}

struct ReflectionReuseTest : test::TechniqueTest {
    ReflectionReuseTest() : TechniqueTest(kReflectionReuse, {64, 48}) {}

    /// What is recorded of frames 0 … frameCount − 1, each rendered `repeats` times.
    std::vector<test::MetricRecorder> recorded(
        const std::string& yaml, const scene::Scene* scene, int frameCount, int repeats = 1,
        const technique::TechniqueInfo& info = kReflectionReuse) {
        std::vector<int> frames;
        for (int frame = 0; frame < frameCount; ++frame) frames.push_back(frame);
        return recordedFrames(yaml, scene, frames, frameCount, repeats, info);
    }
    /// Of the frames that have it; NaN where none has.
    static double meanOf(const std::vector<test::MetricRecorder>& frames, const char* metric) {
        double sum = 0.0, count = 0.0;
        for (const test::MetricRecorder& frame : frames) {
            const auto found = frame.metrics.find(metric);
            if (found == frame.metrics.end()) continue;
            sum += found->second;
            count += 1.0;
        }
        return sum / count;
    }
    /// K for a key frame, r for one that reuses it.
    static std::string kindsOf(const std::vector<test::MetricRecorder>& frames) {
        std::string kinds;
        for (const test::MetricRecorder& frame : frames) {
            kinds += frame.metrics.at("is_key_frame") == 1.0 ? 'K' : 'r';
        }
        return kinds;
    }

    scene::Scene room_ = roomWithPaths();
};

TEST_F(ReflectionReuseTest, TheTruthsOfAPathAreTracedOnce) {
    const std::string walk = "pictures: true, view: walk, path_frames: ";
    constexpr std::size_t kFrame = 64 * 48 * 3 * sizeof(float);
    EXPECT_EQ(expectSharedAsAlone(walk, {"6, method: ray_traced"}, room_, 3), 3 * kFrame);
    // Each of what they are traced regardless of.
    const std::vector<std::string> regardless = {
        "6, method: ray_traced", "6, method: reuse",
        "6, method: direct",     "6, method: direct, forward: splats",
        "6, resampling: twice",  "6, resampling: twice, matching: second_order"};
    EXPECT_EQ(expectSharedAsAlone(walk, regardless, room_, 3), 3 * kFrame);
    // What decides them. The first frame is a key frame, which is not judged.
    const std::vector<std::string> deciding = {"6, first_frame: 1", "6, blend: reflectivity",
                                               "6, glossiness: 0.2", "6, supersampling: 2", "9"};
    EXPECT_EQ(expectSharedAsAlone(walk, deciding, room_, 3), 5 * 2 * kFrame);
}

TEST(ReuseParamsTest, RefusesWhatMeansNothing) {
    test::expectRefused(
        kReflectionReuse,
        {
            {"{}", ""},
            {"{method: direct, forward: splats, threshold: 1}", ""},
            {"{threshold: 1.5}",
             "13: technique 'reflection_reuse': threshold is 1.5; allowed: 0 … 1"},
            {"{method: ray_traced, threshold: 0.3}",
             "33: 'threshold' needs 'method: reuse' or 'method: direct'"},
            {"{method: direct, matching: second_order}", "28: 'matching' needs 'method: reuse'"},
            {"{method: direct, resampling: gather}", "30: 'resampling' needs 'method: reuse'"},
            {"{matching: second_order}", "12: 'matching' needs 'resampling: twice'"},
            {"{resampling: gather, exhaustive_samples: 9}",
             "42: 'exhaustive_samples' needs 'resampling: twice'"},
            {"{max_growth: 2}", "14: 'max_growth' needs 'resampling: twice' or 'method: direct'"},
            {"{resampling: twice, matching: second_order, max_growth: 2}", ""},
            {"{resampling: thrice}",
             "14: technique 'reflection_reuse': resampling is thrice; allowed: twice | gather"},
            {"{glossiness: -0.5}",
             "14: technique 'reflection_reuse': glossiness is -0.5; allowed: -1, 0 … 1"},
            {"{method: direct, exhaustive_samples: 9}",
             "38: 'exhaustive_samples' needs 'method: reuse'"},
            {"{path_frames: 50, first_frame: 50}",
             "32: 'first_frame' is 50; the path has frames 0 … 49 ('path_frames')"},
            {"{path_frames: 0}",
             "15: technique 'reflection_reuse': path_frames is 0; allowed: 1 … 1000000 frames"},
            {"{tracer: optix}",
             "10: technique 'reflection_reuse': tracer is optix; allowed: compute | embree | "
             "clustered"},
            {"{glosiness: 0.2}",
             "2: technique 'reflection_reuse': unknown parameter 'glosiness'; did you mean "
             "'glossiness'?"},
        });
}

TEST_F(ReflectionReuseTest, RefusesScenesWithoutReflectorsUnknownViewsAndFramesBehindThePath) {
    const auto message = [&](const std::string& yaml, const scene::Scene* scene, int frames = 1) {
        return errorText([&] { recorded(yaml, scene, frames); });
    };
    EXPECT_EQ(message("{}", nullptr), "the technique needs a scene, and the case has none");
    scene::Scene dull;
    clustered_reflections::addRoom(dull);
    EXPECT_EQ(message("{}", &dull),
              "scene 'room' has no reflectors: no material's roughness is at most 0.4; "
              "'reflector_roughness: 1' takes them all");
    EXPECT_EQ(message("{view: run}", &room_),
              "the scene has no path or camera 'run'; paths: 'walk', 'rest', 'still', 'jump', "
              "'none'; cameras: 'front', 'ceiling'; or 'AZIMUTH ELEVATION' in degrees, or 'X Y Z > "
              "X Y Z' from and to, with more such behind ';' a path");
    EXPECT_EQ(message("{view: none}", &room_), "the camera path 'none' has no keys");
    EXPECT_EQ(message("{path_frames: 10, first_frame: 8}", &room_, 3),
              "frames 8 … 10 do not lie on a path of 10 ('first_frame', 'path_frames')");
}

TEST_F(ReflectionReuseTest, EveryMethodAndTracerRecordsSharesMemoryAndErrors) {
    for (const char* method : {"reuse", "direct", "ray_traced"}) {
        for (const char* tracer : {"compute", "embree", "clustered"}) {
            SCOPED_TRACE(fmt::format("{} {}", method, tracer));
            const auto frames =
                recorded(fmt::format("{{method: {}, tracer: {}, path_frames: 40{}}}", method,
                                     tracer, std::string(method) == "reuse" ? kPrinted : ""),
                         &room_, 2);
            EXPECT_EQ(passes_.front(), "diffuse");
            EXPECT_EQ(passes_.back(), "composite");
            EXPECT_EQ(std::ranges::count(passes_, "recompute"), 1);
            const bool isReuse = std::string(method) == "reuse";
            const bool isTraced = std::string(method) == "ray_traced";
            EXPECT_EQ(std::ranges::count(passes_, "pixel_matching"), isReuse ? 1 : 0);
            EXPECT_EQ(std::ranges::count(passes_, "reflection_warp"), isTraced ? 0 : 1);
            const auto& metrics = frames[1].metrics;
            EXPECT_GT(metrics.at("reflective_pct"), 20.0);
            // G-buffer and target have 36 bytes a sample, the output 8 a pixel.
            EXPECT_GE(metrics.at("memory_bytes"), 64 * 48 * (36 + 8));
            EXPECT_TRUE(metrics.contains("display_flip"));
            EXPECT_TRUE(metrics.contains("display_psnr_db"));
            EXPECT_LT(metrics.at("channel_error"), 40.0);
            EXPECT_EQ(metrics.contains("recomputed_pct"), !isTraced);
            EXPECT_EQ(metrics.contains("undetected_pct"), !isTraced);
            EXPECT_EQ(metrics.contains("matching_steps"), isReuse);
            EXPECT_EQ(metrics.contains("unmatched_pct"), isReuse);
            EXPECT_EQ(metrics.contains("unshifted_pct"), isReuse);
            EXPECT_FALSE(metrics.contains("key_frame_interval"));
            if (isTraced) continue;
            EXPECT_EQ(kindsOf(frames), "Kr");
            EXPECT_EQ(frames[0].metrics.at("saved_pct"), 0.0);
            EXPECT_FALSE(frames[0].metrics.contains("recomputed_pct"));
            EXPECT_FALSE(frames[0].metrics.contains("channel_error")) << "a key frame is traced";
            EXPECT_NEAR(metrics.at("saved_pct"), 100.0 - metrics.at("recomputed_pct"), 1e-9);
        }
    }
}

TEST_F(ReflectionReuseTest, GatheringTakesNoMatchingLessMemoryAndErrsLess) {
    const auto twice = recorded("{tracer: embree, path_frames: 20, resampling: twice}", &room_, 4);
    const auto gathered = recorded("{tracer: embree, path_frames: 20}", &room_, 4);
    EXPECT_EQ(std::ranges::count(passes_, "pixel_matching"), 0);
    EXPECT_EQ(std::ranges::count(passes_, "reflection_shift"), 0);
    EXPECT_EQ(std::ranges::count(passes_, "reflection_warp"), 1);
    EXPECT_EQ(kindsOf(twice), "Krrr");
    EXPECT_EQ(kindsOf(gathered), "Krrr");
    for (std::size_t i = 1; i < 4; ++i) {
        const auto& a = gathered[i].metrics;
        const auto& b = twice[i].metrics;
        EXPECT_LT(a.at("channel_error"), b.at("channel_error")) << i;
        for (const char* none : {"matching_steps", "unmatched_pct", "unshifted_pct"}) {
            EXPECT_FALSE(a.contains(none)) << none << i;
        }
        // R instead of cells, shifted image and a depth buffer.
        EXPECT_LT(a.at("memory_bytes"), b.at("memory_bytes")) << i;
    }
}

TEST_F(ReflectionReuseTest, CountsDoNotDependOnTheTracer) {
    const auto countsOf = [&](const char* tracer) {
        return recorded(
            fmt::format(
                "{{view: walk, tracer: {}, path_frames: 12, threshold: 0.1, errors: false}}",
                tracer),
            &room_, 8);
    };
    const auto embree = countsOf("embree"), compute = countsOf("compute");
    EXPECT_EQ(kindsOf(embree), kindsOf(compute));
    EXPECT_GE(std::ranges::count(kindsOf(embree), 'K'), 2);
    for (std::size_t i = 0; i < embree.size(); ++i) {
        const auto& a = embree[i].metrics;
        const auto& b = compute[i].metrics;
        EXPECT_EQ(a.at("reflective_pct"), b.at("reflective_pct")) << i;
        // Rays along edges may go either way, and with them the lengths that samples move by.
        EXPECT_NEAR(a.at("saved_pct"), b.at("saved_pct"), 0.5) << i;
    }
}

TEST_F(ReflectionReuseTest, GlossyReflectionsAreTracedByTheirRaysAndReused) {
    const auto errorOf = [&](const char* more) {
        return meanOf(recorded(fmt::format("{{glossiness: 0.3, rays: 8, path_frames: 20{}}}", more),
                               &room_, 2),
                      "channel_error");
    };
    EXPECT_LT(errorOf(", method: ray_traced"), 0.5);  // as mirrors: the truth takes the same rays
    EXPECT_LT(errorOf(""), 4.0);
    // What moves is the mirror ray's reflection, whatever the lobe.
    const auto reused =
        recorded("{glossiness: 0.3, rays: 8, path_frames: 20, resampling: twice}", &room_, 2);
    const auto mirrors = recorded("{glossiness: 0, path_frames: 20, resampling: twice}", &room_, 2);
    EXPECT_EQ(reused[1].metrics.at("matching_steps"), mirrors[1].metrics.at("matching_steps"));
    EXPECT_NE(reused[1].metrics.at("channel_error"), mirrors[1].metrics.at("channel_error"));
}

TEST_F(ReflectionReuseTest, RayTracingIsTheTruth) {
    EXPECT_EQ(meanOf(recorded("{method: ray_traced, tracer: embree}", &room_, 2), "channel_error"),
              0.0);
    // Rays along edges may go either way.
    EXPECT_LT(meanOf(recorded("{method: ray_traced}", &room_, 2), "channel_error"), 0.5);
}

// One tracer behind both chapters: what they ray trace of a frame is the same, each measured by its
// own technique.
TEST_F(ReflectionReuseTest, RayTracesAFrameAsClusteredReflectionsDoes) {
    for (const bool byEmbree : {false, true}) {
        const test::MetricRecorder here =
            recorded(fmt::format("{{method: ray_traced, tracer: {}, blend: reflectivity, view: "
                                 "rest, pictures: true}}",
                                 byEmbree ? "embree" : "compute"),
                     &room_, 1)[0];
        const test::MetricRecorder there =
            recorded(fmt::format("{{method: {}, supersampling: 1, view: rest, pictures: true}}",
                                 byEmbree ? "embree" : "ray_traced"),
                     &room_, 1, 1, clustered_reflections::kClusteredReflections)[0];
        for (const char* const picture : {"result", "truth"}) {
            EXPECT_EQ(here.images.at(picture), there.images.at(picture)) << picture << byEmbree;
        }
        for (const char* const metric :
             {"reflective_pct", "channel_error", "channel_error_image"}) {
            EXPECT_EQ(here.metrics.at(metric), there.metrics.at(metric)) << metric << byEmbree;
        }
    }
}

TEST_F(ReflectionReuseTest, ACameraAtRestRecomputesNothing) {
    // A path of one key; one of no length; a camera.
    for (const char* view : {"rest", "still", "front"}) {
        for (const char* method : {"reuse", "direct", "reuse, resampling: twice"}) {
            SCOPED_TRACE(fmt::format("{} {}", view, method));
            const auto frames = recorded(
                fmt::format("{{view: {}, method: {}, tracer: embree}}", view, method), &room_, 3);
            EXPECT_EQ(kindsOf(frames), "Krr");
            for (std::size_t i = 1; i < 3; ++i) {
                EXPECT_EQ(frames[i].metrics.at("recomputed_pct"), 0.0);
                // Half-precision radiance is interpolated at the very pixel centres.
                EXPECT_LT(frames[i].metrics.at("channel_error"), 0.05);
            }
        }
    }
}

TEST_F(ReflectionReuseTest, ReuseIsNearerToTheTruthThanDirectReprojection) {
    const auto error = [&](const char* method) {
        return meanOf(
            recorded(fmt::format("{{method: {}, tracer: embree, threshold: 1, path_frames: 12}}",
                                 method),
                     &room_, 8),
            "channel_error");
    };
    // Both resample stripes of few pixels; where they are is what reuse has right.
    EXPECT_LT(1.25 * error("reuse"), error("direct"));
    EXPECT_LT(1.25 * error("reuse, resampling: twice, forward: splats"),
              error("direct, forward: splats"));
}

TEST_F(ReflectionReuseTest, AJumpIsRecomputedAndMakesTheNextFrameAKeyFrame) {
    const std::string kJump = "{view: jump, path_frames: 3, tracer: embree, pictures: true";
    const auto frames = recorded(kJump + "}", &room_, 3);
    EXPECT_EQ(kindsOf(frames), "KrK");
    EXPECT_GT(frames[1].metrics.at("recomputed_pct"), 60.0);
    EXPECT_FALSE(frames[0].metrics.contains("key_frame_interval"));
    EXPECT_EQ(frames[2].metrics.at("key_frame_interval"), 2.0);
    // What was traced is right, whatever the key frame showed.
    const auto traced = recorded(kJump + ", method: ray_traced}", &room_, 3);
    EXPECT_EQ(frames[2].images.at("result"), traced[2].images.at("result"));
    EXPECT_LT(frames[1].metrics.at("channel_error"), 8.0);
    // The next frame's pictures have the key frame; the last has no next.
    EXPECT_FALSE(frames[0].images.contains("result"));
    EXPECT_TRUE(frames[1].images.contains("key_frame"));
}

TEST_F(ReflectionReuseTest, TheThresholdDecidesWhatIsAKeyFrame) {
    const auto kinds = [&](const char* options) {
        return kindsOf(
            recorded(fmt::format("{{path_frames: 40, errors: false, {}}}", options), &room_, 6));
    };
    EXPECT_EQ(kinds("threshold: 0"), "KrKrKr");  // every frame recomputes some
    EXPECT_EQ(kinds("threshold: 1"), "Krrrrr");
    EXPECT_EQ(kinds("threshold: 0, view: rest, method: direct"), "Krrrrr");  // 0 is not more
}

// The runner warms up on the first frame and may repeat each.
TEST_F(ReflectionReuseTest, RenderingAFrameAgainChangesNothing) {
    for (const char* options : {"threshold: 0", "threshold: 1", "threshold: 1, resampling: twice",
                                "method: direct, threshold: 0"}) {
        SCOPED_TRACE(options);
        const std::string yaml =
            fmt::format("{{path_frames: 40, tracer: embree, pictures: true, {}}}", options);
        const auto once = recorded(yaml, &room_, 4);
        const auto thrice = recorded(yaml, &room_, 4, 3);
        for (std::size_t i = 0; i < once.size(); ++i) {
            SCOPED_TRACE(i);
            EXPECT_EQ(once[i].metrics, thrice[i].metrics);
            ASSERT_EQ(once[i].images.size(), thrice[i].images.size());
            for (const auto& [name, image] : once[i].images) {
                EXPECT_TRUE(std::ranges::equal(image.values(), thrice[i].images.at(name).values()))
                    << name;
            }
        }
    }
}

TEST_F(ReflectionReuseTest, FramesLieOnThePathWhereAsked) {
    const auto result = [&](const char* options, std::size_t frame) {
        const auto frames = recorded(
            fmt::format("{{method: ray_traced, errors: false, pictures: true, {}}}", options),
            &room_, 2);
        return frames[frame].images.at("result");
    };
    const image::ImageF third = result("path_frames: 10, first_frame: 3", 0);
    EXPECT_EQ(third, result("path_frames: 10, first_frame: 2", 1));
    EXPECT_EQ(third, result("path_frames: 20, first_frame: 6", 0));
    EXPECT_NE(third, result("path_frames: 10, first_frame: 2", 0));
}

TEST_F(ReflectionReuseTest, ViewsWithoutReflectorsRecordNothingReflected) {
    room_.lights = {{}};
    for (const char* method : {"reuse", "direct", "ray_traced"}) {
        SCOPED_TRACE(method);
        testing::internal::CaptureStderr();
        const auto frames = recorded(
            fmt::format("{{view: ceiling, pictures: true, method: {}}}", method), &room_, 3);
        const std::string isStill =
            method == std::string("ray_traced")
                ? ""
                : "warning: scene 'room': the camera stands still over 3 frames: what is saved "
                  "tells nothing of a path ('view')\n";
        EXPECT_EQ(testing::internal::GetCapturedStderr(),
                  isStill +
                      "warning: scene 'room': a frame shows no reflector; no errors are measured "
                      "of it\n");
        for (const test::MetricRecorder& frame : frames) {
            EXPECT_EQ(frame.metrics.at("reflective_pct"), 0.0);
            // Claims on what there is not are left unmeasured.
            for (const char* none :
                 {"saved_pct", "recomputed_pct", "unmatched_pct", "unshifted_pct", "undetected_pct",
                  "channel_error", "channel_error_image", "display_flip", "display_psnr_db"}) {
                EXPECT_FALSE(frame.metrics.contains(none)) << none;
            }
        }
        if (std::string(method) == "ray_traced") continue;
        EXPECT_EQ(kindsOf(frames), "Krr");
    }
}

TEST_F(ReflectionReuseTest, ObjectsThatMoveLeaveGhosts) {
    const auto error = [&](const char* motion) {
        return meanOf(
            recorded(
                fmt::format(
                    "{{view: rest, motion: {}, tracer: embree, threshold: 1, path_frames: 40}}",
                    motion),
                &room_, 5),
            "channel_error");
    };
    const double ghosts = error("true");
    EXPECT_GT(ghosts, 0.1);
    EXPECT_LT(3.0 * error("false"), ghosts);
}

TEST_F(ReflectionReuseTest, MatchesAreComparedWithTheWholeReflector) {
    for (const char* matching : {"first_order", "second_order"}) {
        const auto frames =
            recorded(fmt::format("{{resampling: twice, matching: {}, exhaustive_samples: 200, "
                                 "errors: false, path_frames: 40, threshold: 1}}",
                                 matching),
                     &room_, 3);
        EXPECT_FALSE(frames[0].metrics.contains("wrong_minimum_pct"));
        // A plane has one minimum, and the column bends one way.
        EXPECT_LT(frames[2].metrics.at("wrong_minimum_pct"), 5.0) << matching;
        EXPECT_LT(frames[2].metrics.at("unmatched_pct"), 50.0) << matching;
    }
}

TEST_F(ReflectionReuseTest, ShowsPicturesOfEveryStep) {
    const auto frames = recorded(
        "{pictures: true, path_frames: 40, supersampling: 2, resampling: twice}", &room_, 2);
    EXPECT_TRUE(frames[0].images.empty()) << "the next frame has the key frame";
    const char* expected[] = {"error",  "error_60", "recomputed", "reflection",
                              "result", "truth",    "undetected"};
    for (const char* name : expected) EXPECT_TRUE(frames[1].images.contains(name)) << name;
    for (const char* name : {"key_frame", "offsets", "shifted"}) {
        ASSERT_TRUE(frames[1].images.contains(name)) << name;
        EXPECT_EQ(frames[1].images.at(name).width(), 64) << name;
    }
    const auto alone = recorded("{pictures: true, path_frames: 40, supersampling: 2}", &room_, 1);
    for (const char* name : {"error", "error_60", "recomputed", "reflection", "result", "truth"}) {
        EXPECT_TRUE(alone[0].images.contains(name)) << name;
    }
    EXPECT_EQ(frames[1].images.at("key_frame"), alone[0].images.at("result"));
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
