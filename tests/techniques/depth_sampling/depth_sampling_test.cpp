// The technique as a whole: parameters, metrics, invariants of the definitions.
#include "techniques/depth_sampling/depth_sampling.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::depth_sampling {
namespace {

struct DepthSamplingTest : test::TechniqueTest {
    using Metrics = std::map<std::string, double>;

    DepthSamplingTest() : TechniqueTest(kDepthSampling, {96, 96}) {}

    Metrics run(const std::string& yaml, const scene::Scene& scene) {
        return recordedFrames(yaml, &scene, {0}, 1, 1, technique_).front().metrics;
    }
};

scene::Camera lookingAt(const glm::vec3& eye, const glm::vec3& target) {
    scene::Camera camera{.position = eye, .target = target};
    camera.verticalFovRad = 2.0F * std::atan(0.5F);  // an image as high as its distance
    return camera;
}

/// A card of side 1 a third of the way from the eye to a wall that fills the picture.
scene::Scene cardBeforeWall() {
    scene::MeshBuilder builder;
    builder.addQuad({-0.5F, -0.5F, 1}, {0.5F, -0.5F, 1}, {0.5F, 0.5F, 1}, {-0.5F, 0.5F, 1});
    builder.addQuad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
    scene::Scene scene = scene::sceneOf(builder.take("card", -1));
    scene.cameras = {lookingAt({0, 0, 4}, {0, 0, 0})};
    return scene;
}

/// Boxes in front of a floor, many behind each other.
scene::Scene clutter() {
    scene::MeshBuilder builder;
    builder.addBox({0, -1.1F, 0}, {3, 0.1F, 3});
    Random random(7);
    for (int i = 0; i < 90; ++i) {
        const glm::vec3 centre{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const glm::vec3 half{random.uniform(0.02F, 0.2F), random.uniform(0.02F, 0.2F),
                             random.uniform(0.02F, 0.2F)};
        builder.addBox(centre, half);
    }
    scene::Scene scene = scene::sceneOf(builder.take("clutter", -1));
    scene.cameras = {lookingAt({1, 2, 5}, {0, 0, 0})};
    return scene;
}

TEST_F(DepthSamplingTest, TheMethodsHaveTheirOutputFramesInCommon) {
    const scene::Scene scene = clutter();
    const std::string frames = "output_frames: 20, ";
    const std::string both = "usefulness: true, availability: true, ";
    constexpr std::size_t kBytesOfOne = std::size_t{20} * 96 * 96 * 8;
    EXPECT_EQ(expectSharedAsAlone(frames + both, {"method: conventional"}, scene), kBytesOfOne);
    // Each of what they are drawn regardless of.
    const std::vector<std::string> regardless = {
        both + "method: conventional",
        both + "method: non_redundant",
        both + "method: depth_peeling",
        both + "method: depth_peeling, peeled_from: first_view",
        "method: non_redundant, usefulness: true",
        "method: non_redundant, availability: true"};
    EXPECT_EQ(expectSharedAsAlone(frames, regardless, scene), kBytesOfOne);
    // What decides them.
    const std::vector<std::string> deciding = {"method: conventional",  "views: 4",
                                               "view_distance: 0.5",    "view_spread: 0.3",
                                               "depth_format: unorm24", "frame_size: 80"};
    EXPECT_GT(expectSharedAsAlone(frames + both, deciding, scene), 5 * kBytesOfOne);
}

TEST(DepthSamplingParamsTest, RefusesWhatMeansNothing) {
    test::expectRefused(
        kDepthSampling,
        {
            {"{}", ""},
            {"{placement: automatic, views: 16}", ""},
            {"{placement: automatic, redundancy: visibility}",
             "13: 'placement: automatic' needs 'redundancy: pixel'"},
            {"{method: depth_peeling, placement: automatic}",
             "36: 'placement: automatic' chooses views; 'method: depth_peeling' has only one"},
            {"{placement: automatic, views: 1}",
             "31: 'placement: automatic' needs 2 views or more; found 1"},
            {"{redundancy: visibility, depth_format: unorm24}",
             "40: 'depth_format' needs 'redundancy: pixel'"},
            {"{redundancy: visibility, triangle_ids: primitive_id}",
             "40: 'triangle_ids' needs 'redundancy: pixel'"},
            {"{redundancy: visibility, measured: output_frame}",
             "36: 'measured: output_frame' needs 'redundancy: pixel'"},
            {"{output_frames: 10}",
             "17: 'output_frames' needs 'usefulness', 'availability', 'pictures' or 'measured: "
             "output_frame'"},
            {"{frame_size: 10}",
             "14: 'frame_size' needs 'usefulness', 'availability', 'pictures' or 'measured: "
             "output_frame'"},
            {"{frame_size: 10, availability: true}", ""},
            {"{views: 17}", "9: technique 'depth_sampling': views is 17; allowed: 1 … 16 images"},
        });
}

TEST_F(DepthSamplingTest, SaysNothingOfUsefulSamplesThatNobodyCounted) {
    const scene::Scene scene = clutter();
    for (const std::string redundancy : {"pixel", "visibility"}) {
        const Metrics metrics =
            run("{method: non_redundant, redundancy: " + redundancy + "}", scene);
        EXPECT_GT(metrics.at("occluded_pct/image_1"), 0) << redundancy;
        for (const auto& [name, value] : metrics) {
            EXPECT_EQ(name.find("useful"), std::string::npos) << redundancy << ' ' << name;
        }
    }
}

TEST_F(DepthSamplingTest, NeedsASceneWithTriangles) {
    EXPECT_EQ(errorText([&] { recorded("{}", nullptr); }),
              "the technique needs a scene, and the case has none");
    const scene::Scene empty{.name = "void"};
    EXPECT_EQ(errorText([&] { recorded("{}", &empty); }),
              "technique 'depth_sampling' needs a scene with triangles");
}

// All views coincide: an image after the first is the next layer. The card covers 32 of 96 pixels
// each way (side 1 at distance 3 in a picture that is 3 high there); behind it lies the wall.
TEST_F(DepthSamplingTest, CoincidingViewsPeelAnalyticLayers) {
    const scene::Scene scene = cardBeforeWall();
    for (const std::string redundancy : {"pixel", "visibility"}) {
        const std::string common =
            ", redundancy: " + redundancy +
            ", view_spread: 0, usefulness: true, availability: true, output_frames: 3}";
        const Metrics peeled = run("{method: depth_peeling" + common, scene);
        EXPECT_EQ(peeled.at("samples/image_0"), 96 * 96) << redundancy;
        EXPECT_EQ(peeled.at("samples/image_1"), 32 * 32) << redundancy;
        EXPECT_EQ(peeled.at("samples/image_2"), 0) << redundancy;
        EXPECT_EQ(peeled.at("occluded_pct/image_0"), 0) << redundancy;
        EXPECT_EQ(peeled.at("occluded_pct/image_1"), 100) << redundancy;
        EXPECT_EQ(peeled.at("coverage_pct/image_2"), 0) << redundancy;
        EXPECT_FALSE(peeled.contains("occluded_pct/image_2")) << "a share of nothing";
        EXPECT_EQ(peeled.at("coverage_pct/image_0"), 100) << redundancy;
        EXPECT_NEAR(peeled.at("coverage_pct/image_1"), 100.0 / 9.0, 1e-9) << redundancy;
        EXPECT_EQ(peeled.at("useful_pct/image_1"), 0) << redundancy;
        EXPECT_EQ(peeled.at("available_min_pct"), 100) << redundancy;
        EXPECT_EQ(run("{method: non_redundant" + common, scene), peeled) << redundancy;
        const Metrics conventional = run("{method: conventional" + common, scene);
        EXPECT_EQ(conventional.at("redundant_pct/image_0"), 0) << redundancy;
        EXPECT_EQ(conventional.at("redundant_pct/image_1"), 100) << redundancy;
    }
}

// One view: all output frames are taken from it.
TEST_F(DepthSamplingTest, AnOutputFrameAtAReferenceViewFindsEverything) {
    const scene::Scene scene = clutter();
    for (const char* redundancy : {"pixel", "visibility"}) {
        const Metrics metrics =
            run(std::string("{views: 1, availability: true, output_frames: 2, redundancy: ") +
                    redundancy + "}",
                scene);
        EXPECT_EQ(metrics.at("available_mean_pct"), 100) << redundancy;
        EXPECT_EQ(metrics.at("available_min_pct"), 100) << redundancy;
        // Frames that are alike: their mean is as certain as all their samples.
        EXPECT_EQ(metrics.at("available_mean_pct_of"), 2 * metrics.at("available_min_pct_of"))
            << redundancy;
        EXPECT_EQ(metrics.at("unavailable_mean_pct"), 0) << redundancy;
        EXPECT_EQ(metrics.at("output_frames"), 2) << redundancy;
    }
}

TEST_F(DepthSamplingTest, OccludedIsUpToTheOwnViewOrFromAll) {
    const scene::Scene scene = clutter();
    for (const std::string redundancy : {"pixel", "visibility"}) {
        const auto counted = [&](const char* method, const char* occluded) {
            return run(
                fmt::format("{{method: {}, redundancy: {}{}}}", method, redundancy, occluded),
                scene);
        };
        const Metrics own = counted("non_redundant", ", occluded: up_to_own");
        const Metrics all = counted("non_redundant", ", occluded: all");
        EXPECT_EQ(counted("non_redundant", ""), own);
        for (const char* image : {"occluded_pct/image_0", "occluded_pct/image_2"}) {
            EXPECT_EQ(own.at(image), all.at(image)) << "there is no further view";
        }
        // The third view sees some of what the first two do not.
        EXPECT_LT(all.at("occluded_pct/image_1"), own.at("occluded_pct/image_1")) << redundancy;
        EXPECT_GT(all.at("occluded_pct/image_1"), 0.0) << redundancy;
    }
}

TEST_F(DepthSamplingTest, MeasuresKeepTheirBounds) {
    const scene::Scene scene = clutter();
    for (const std::string redundancy : {"pixel", "visibility"}) {
        std::map<std::string, Metrics> of;
        for (const std::string method : {"conventional", "non_redundant", "depth_peeling"}) {
            of[method] = run(
                "{method: " + method + ", redundancy: " + redundancy +
                    ", usefulness: true, availability: true, output_frames: 20, frame_size: 48}",
                scene);
            const Metrics& metrics = of[method];
            double usefulSumPct = 0.0;
            for (const char* pass : {"/image_0", "/image_1", "/image_2"}) {
                const auto at = [&](const std::string& name) { return metrics.at(name + pass); };
                const std::string where = redundancy + " " + method + pass;
                EXPECT_GT(at("samples"), 0) << where;
                EXPECT_NEAR(at("useful_pct") * at("occluded_pct") / 100.0,
                            at("useful_of_samples_pct"), 1e-9)
                    << where;
                EXPECT_LE(at("useful_of_samples_pct"), at("occluded_pct")) << where;
                usefulSumPct += at("useful_of_samples_pct");
                if (method == "conventional") {
                    EXPECT_EQ(at("occluded_pct"), 0) << where;
                } else {
                    EXPECT_EQ(at("redundant_pct"), 0) << where;  // claim N1
                }
            }
            EXPECT_NEAR(metrics.at("useful_sum_pct"), usefulSumPct, 1e-9);
            EXPECT_LE(metrics.at("available_min_pct"), metrics.at("available_mean_pct"));
            EXPECT_GE(metrics.at("available_mean_pct_of"), 1);
            EXPECT_LE(metrics.at("available_mean_pct_of"), 20 * 48 * 48);
        }
        // Image 1 keeps every sample of the conventional image 1 that image 0 lacks; only the
        // others make room for occluded ones. (Image 2 may lose some to occluded ones of image 1.)
        const Metrics& conventional = of["conventional"];
        const Metrics& nonRedundant = of["non_redundant"];
        EXPECT_GT(nonRedundant.at("occluded_pct/image_1"), 0) << redundancy;
        EXPECT_LE(nonRedundant.at("occluded_pct/image_1"), conventional.at("redundant_pct/image_1"))
            << redundancy;
        EXPECT_EQ(nonRedundant.at("samples/image_0"), conventional.at("samples/image_0"));
        EXPECT_GE(nonRedundant.at("useful_sum_pct"), 0.1) << redundancy;
        // A point that V sees is in V's non-redundant image, or in an earlier one. Not so by
        // pixels: what was dropped lands beside the pixel that it was found in, as seen from a
        // third view.
        if (redundancy == "pixel") continue;
        EXPECT_GE(nonRedundant.at("available_mean_pct"), conventional.at("available_mean_pct"));
        EXPECT_GE(nonRedundant.at("available_min_pct"), conventional.at("available_min_pct"));
        EXPECT_LT(conventional.at("available_min_pct"), 100);
    }
}

// Only from the middle of V₀V₁ does one see the card behind the hole in a wall; the fixed views
// stand at the ends. All is inside of every frustum: what lies outside does not decide.
// (Conventional images: a non-redundant one sees the wall behind anyway, where the first wall is
// redundant.)
TEST_F(DepthSamplingTest, AutomaticPlacementFindsWhatTheEndsMiss) {
    scene::MeshBuilder builder;
    for (const float side : {-1.0F, 1.0F}) {
        builder.addBox({side * 0.85F, 0, 0}, {0.45F, 1.3F, 0.05F});
        builder.addBox({0, side * 0.85F, 0}, {0.4F, 0.45F, 0.05F});
    }
    builder.addBox({0, 0, -4}, {0.8F, 0.8F, 0.05F});
    scene::Scene scene = scene::sceneOf(builder.take("hole", -1));
    scene.cameras = {lookingAt({0, 0, 3}, {0, 0, 0})};
    const std::string common =
        "{method: conventional, views: 2, view_spread: 0.6, availability: true, output_frames: 40, "
        "placement: ";
    const Metrics fixed = run(common + "fixed}", scene);
    const Metrics automatic = run(common + "automatic}", scene);
    EXPECT_LT(automatic.at("unavailable_mean_pct"), 0.8 * fixed.at("unavailable_mean_pct"));
}

TEST_F(DepthSamplingTest, GeometryShaderIdsGiveTheSameSamples) {
    const scene::Scene scene = clutter();
    const std::string common = "{method: non_redundant, triangle_ids: ";
    EXPECT_EQ(run(common + "geometry_shader}", scene), run(common + "primitive_id}", scene));
}

TEST_F(DepthSamplingTest, StandsWhereItsViewSays) {
    scene::Scene scene = clutter();
    EXPECT_NE(run("{method: non_redundant, view: 110 35}", scene),
              run("{method: non_redundant}", scene));
    scene.cameras.front().verticalFovRad = scene::Camera().verticalFovRad;
    const Metrics first = run("{method: non_redundant}", scene);
    scene.cameras.front().name = "door";
    scene.cameras.insert(scene.cameras.begin(), lookingAt({0, 0, 40}, {0, 0, 80}));
    EXPECT_EQ(run("{method: non_redundant, view: door}", scene), first);
    EXPECT_EQ(run("{method: non_redundant, view: 1 2 5 > 0 0 0}", scene), first);
    Params params = test::paramsOf(technique_, "{view: 1 2 5 > 1 2 5}");
    const auto technique = technique_.create(params);
    EXPECT_EQ(errorText([&] { technique->requireScene(scene); }),
              "view '1 2 5 > 1 2 5': from 1 2 5 to the same point; allowed: to another one");
}

// The camera looks away from everything.
TEST_F(DepthSamplingTest, NothingInViewIsAnError) {
    scene::Scene scene = cardBeforeWall();
    scene.name = "cards";
    scene.cameras = {lookingAt({0, 0, 4}, {0, 0, 40})};
    for (const std::string method : {"conventional", "non_redundant", "depth_peeling"}) {
        for (const std::string redundancy : {"pixel", "visibility"}) {
            EXPECT_EQ(errorText([&] {
                          run("{method: " + method + ", redundancy: " + redundancy +
                                  ", view_spread: 0, usefulness: true, availability: true, "
                                  "output_frames: 2}",
                              scene);
                      }),
                      "reference image 0 has no sample: from (0, 0, 4) nothing of scene 'cards' is "
                      "in view; change 'view', 'view_distance', 'view_spread', 'view_yaw_deg' or "
                      "'view_pitch_deg'")
                << method << ' ' << redundancy;
        }
    }
}

TEST_F(DepthSamplingTest, SharesOfPixelsAreThoseOfSamplesTimesCoverage) {
    const Metrics metrics = run("{method: conventional, view_spread: 0.1}", clutter());
    for (const std::string image : {"image_0", "image_1", "image_2"}) {
        const double coverage = metrics.at("coverage_pct/" + image) / 100.0;
        EXPECT_GT(coverage, 0.05);
        EXPECT_LT(coverage, 0.95);
        EXPECT_NEAR(metrics.at("redundant_of_pixels_pct/" + image),
                    metrics.at("redundant_pct/" + image) * coverage, 1e-9);
    }
    EXPECT_GT(metrics.at("redundant_of_pixels_pct/image_1"), 0);
}

TEST_F(DepthSamplingTest, RefusesViewsInsideOfGeometry) {
    scene::MeshBuilder builder;
    builder.addBox({0, 0, 0}, {1, 1, 1});
    builder.addBox({0, 0, 4}, {2, 2, 2});
    scene::Scene scene = scene::sceneOf(builder.take("boxes", -1));
    scene.cameras = {lookingAt({0, 0, 4}, {0, 0, 0})};
    const std::string rest =
        " is inside of geometry or looks at an open surface from behind: 1024 of 1024 rays that "
        "meet the scene meet the back of a single-sided triangle first; change 'view_distance', "
        "'view_spread', 'view_yaw_deg' or 'view_pitch_deg', or make the material double-sided";
    EXPECT_EQ(errorText([&] { run("{view_spread: 0}", scene); }), "view 0 at (0, 0, 4)" + rest);
    EXPECT_EQ(errorText([&] { run("{view_distance: 2, view_spread: 0}", scene); }), "no error");
    // A sheet that is drawn from both sides has no inside.
    scene.materials = {scene::Material{.isDoubleSided = true}};
    scene.meshes[0].material = 0;
    EXPECT_EQ(errorText([&] { run("{view_spread: 0}", scene); }), "no error");
    // Nor has one with a second side on the same points, whichever of them a ray reports.
    scene.materials[0].isDoubleSided = false;
    EXPECT_EQ(errorText([&] { run("{view_spread: 0}", scene); }), "view 0 at (0, 0, 4)" + rest);
    scene::addBackSides(scene.meshes[0]);
    EXPECT_EQ(errorText([&] { run("{view_spread: 0}", scene); }), "no error");
}

TEST_F(DepthSamplingTest, TimesImagesOrOneOutputFrame) {
    const scene::Scene scene = clutter();
    const auto passes = [&](gl::PassTime::Clock clock) {
        std::set<std::string> names;
        for (const gl::PassTime& pass : passTimes_) {
            if (pass.clock == clock) names.insert(pass.pass);
        }
        return names;
    };
    using Names = std::set<std::string>;
    run("{views: 2}", scene);
    EXPECT_EQ(passes(gl::PassTime::Clock::Gpu), (Names{"image_0", "image_1", "reference_images"}));
    run("{views: 2, redundancy: visibility}", scene);
    EXPECT_EQ(passes(gl::PassTime::Clock::Cpu), (Names{"image_0", "image_1", "reference_images"}));
    EXPECT_EQ(passes(gl::PassTime::Clock::Gpu), Names{});

    const std::string common = "{method: non_redundant, output_frames: 1, ";
    const Metrics frame = run(common + "measured: output_frame}", scene);
    EXPECT_EQ(passes(gl::PassTime::Clock::Gpu), (Names{"availability_test", "output_frame"}));
    const Metrics all = run(common + "availability: true}", scene);
    EXPECT_EQ(frame.at("available_pct/output_frame"), all.at("available_mean_pct"));
    EXPECT_FALSE(frame.contains("available_mean_pct"));
}

TEST_F(DepthSamplingTest, SavesPictures) {
    const scene::Scene scene = clutter();
    for (const char* redundancy : {"pixel", "visibility"}) {
        const test::MetricRecorder recorder =
            recorded(std::string("{views: 2, method: non_redundant, usefulness: true, pictures: "
                                 "true, output_frames: 2, frame_size: 40, redundancy: ") +
                         redundancy + "}",
                     &scene);
        for (const char* name : {"image_0", "image_1", "classes_0", "classes_1"}) {
            EXPECT_EQ(recorder.images.at(name).width(), 96) << redundancy << name;
        }
        EXPECT_EQ(recorder.images.at("output_frame").width(), 40) << redundancy;
        EXPECT_EQ(recorder.images.at("unavailable").width(), 40) << redundancy;
        EXPECT_EQ(recorder.images.size(), 6U) << redundancy;
    }
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
