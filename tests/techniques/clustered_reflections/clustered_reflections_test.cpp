// The technique as a whole: parameters, metrics, methods against each other.
#include "techniques/clustered_reflections/clustered_reflections.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "runner/config/experiment.h"
#include "tests/support/grid.h"
#include "tests/techniques/clustered_reflections/mirror_rooms.h"
#include "tests/techniques/clustered_reflections/room.h"
#include "tests/techniques/reflections/traced_scenes.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::clustered_reflections {
namespace {

struct ClusteredReflectionsTest : test::TechniqueTest {
    ClusteredReflectionsTest() : TechniqueTest(kClusteredReflections, {48, 40}) {}

    using Metrics = std::map<std::string, double>;

    Metrics run(const std::string& yaml, const scene::Scene& scene) {
        return recorded(yaml, &scene).metrics;
    }
};

constexpr const char* kMethods[] = {"clustered", "environment_map", "screen_space", "ray_traced",
                                    "embree"};

// [xie2017] Sec. 4.7.4 recommends the second of its ways with the own reflector.
TEST(ReflectionParamsTest, ConcaveClustersShowTheirOwnReflectorByDefault) {
    Params params = test::paramsOf(kClusteredReflections, "{}");
    const ReflectionParams defaults(params);
    EXPECT_EQ(defaults.clustered.ownReflector, OwnReflector::ConcaveDiffuse);
    EXPECT_TRUE(defaults.reflectors.splitsParts);
}

TEST_F(ClusteredReflectionsTest, TheTruthOfAFrameIsTracedOnce) {
    scene::Scene scene = rooms::room();
    rooms::addFurniture(scene);
    rooms::add(scene, rooms::potAndKnob(), glm::vec3(0.5F), rooms::Surface::Mirror);
    scene.cameras = {{.position = {0.9F, 0.4F, 1.4F}, .verticalFovRad = 1.0F}};
    const std::string glossy = "pictures: true, glossiness: 0.2, rays: 8, converged_rays: 16, ";
    const std::size_t bytesOfOne = expectSharedAsAlone(glossy, {"method: clustered"}, scene);
    const std::size_t bytesOfTruth =  // without an environment map
        expectSharedAsAlone(glossy, {"method: ray_traced"}, scene);
    EXPECT_GT(bytesOfTruth, 0U);
    const std::size_t bytesOfMap = bytesOfOne - bytesOfTruth;
    EXPECT_EQ(bytesOfMap, (6U * 4U + 4U) * 512U * 512U);  // colours of a cube, and depths of a face
    // Each of what it is traced regardless of.
    const std::vector<std::string> regardless = {
        "method: clustered",    "method: environment_map",
        "method: screen_space", "method: ray_traced",
        "method: embree",       "clustering: kd_tree",
        "bin_gain: 4",          "own_reflector: whole_scene, own_back: true"};
    EXPECT_EQ(expectSharedAsAlone(glossy, regardless, scene), bytesOfOne);
    // What decides it; where clusters are only counted, another one is traced.
    const std::vector<std::string> deciding = {glossy + "method: clustered",
                                               glossy + "method: clustered, supersampling: 2",
                                               glossy + "reflector_parts: false",
                                               glossy + "texture_filter: finest_level",
                                               "glossiness: 0.4, rays: 8",
                                               "glossiness: 0.2, rays: 12",
                                               "glossiness: 0.2, rays: 8",
                                               "glossiness: 0.2, reflector_roughness: 0.1",
                                               "depth_images: none",
                                               ""};
    EXPECT_GT(expectSharedAsAlone("", deciding, scene), 4 * bytesOfMap + 8 * bytesOfTruth);
}

// Views that were chosen do not tell what a path shows.
TEST(ReflectionParamsTest, ErrorsOfBothWaysAreMeasuredOnAllCameraPaths) {
    const fs::path configs = GFXREPRO_CONFIGS;
    for (const char* const profile : {"full", "paper"}) {
        std::set<std::pair<std::string, OwnReflector>> measured;
        for (const config::Case& one : config::expandCases(config::loadExperiment(
                 configs / "xie2017" / "section-4.7.4.yaml", {.profile = profile}, configs))) {
            Params params = test::paramsOf(kClusteredReflections, one.given.toJson().dump());
            const ReflectionParams read(params);
            if (!read.measuresErrors) continue;
            measured.emplace(one.scene.toJson().dump() + read.view, read.clustered.ownReflector);
        }
        EXPECT_EQ(measured.size(), 4U * 2U) << profile;
    }
}

// A table whose numbers do not depend on the depth images may have others than the thesis draws;
// its page says so.
TEST(ReflectionParamsTest, TablesNameTheirOwnDepthImages) {
    const fs::path configs = GFXREPRO_CONFIGS;
    int named = 0;
    for (const auto& entry : fs::directory_iterator(configs / "xie2017")) {
        if (entry.path().extension() != ".yaml") continue;
        for (const char* const profile : {"quick", "full", "paper"}) {
            const config::Experiment table =
                config::loadExperiment(entry.path(), {.profile = profile}, configs);
            if (table.technique != kClusteredReflections.name) continue;
            const nlohmann::ordered_json params = table.params.toJson();
            for (const char* const name : {"depth_images", "depth_image_scale", "level_error_px",
                                           "texels_per_sample", "least_samples"}) {
                if (!params.contains(name)) continue;
                EXPECT_TRUE(std::ranges::count(table.assumptions, name, &config::Assumption::name))
                    << table.id << ' ' << name;
                ++named;
            }
        }
    }
    EXPECT_GE(named, 3 * 3);  // tables 19 and 21, section 4.7.1
}

TEST(ReflectionParamsTest, RefusesWhatMeansNothing) {
    test::expectRefused(
        kClusteredReflections,
        {
            {"{}", ""},
            {"{glossiness: -1}", ""},  // as the materials say
            {"{glossiness: -0.5}",
             "14: technique 'clustered_reflections': glossiness is -0.5; allowed: -1, 0 … 1"},
            {"{glossiness: 1.5}",
             "14: technique 'clustered_reflections': glossiness is 1.5; allowed: -1 … 1"},
            {"{glossiness: 0.001}",
             "14: technique 'clustered_reflections': glossiness is 0.001, which is drawn as a "
             "mirror; allowed: -1, 0, 0.002 … 1"},
            {"{glossiness: 0.002}", ""},
            {"{method: embree, bin_gain: 2}", "28: 'bin_gain' needs 'method: clustered'"},
            {"{method: ray_traced, depth_images: visible}",
             "36: 'depth_images' needs 'method: clustered'"},
            {"{clustering: kd_tree, least_samples: 9}",
             "38: 'least_samples' needs 'clustering: normal_bins'"},
            {"{level_error_px: 0.5}", "18: 'level_error_px' needs 'depth_images: visible'"},
            {"{depth_images: none, pictures: true}",
             "32: 'pictures' needs 'depth_images' other than none"},
            {"{method: embree, own_reflector: whole_scene}",
             "33: 'own_reflector' needs 'method: clustered'"},
            {"{errors: false, converged_rays: 256}", "33: 'converged_rays' needs 'errors: true'"},
            {"{supersampling: 0}",
             "17: technique 'clustered_reflections': supersampling is 0; allowed: 1 … 8 samples"},
            {"{glosiness: 0.2}",
             "2: technique 'clustered_reflections': unknown parameter 'glosiness'; did you mean "
             "'glossiness'?"},
        });
}

TEST_F(ClusteredReflectionsTest, RefusesScenesWithoutReflectorsAndUnknownViews) {
    const auto message = [&](const std::string& yaml, const scene::Scene* scene) {
        return errorText([&] { recorded(yaml, scene); });
    };
    EXPECT_EQ(message("{}", nullptr), "the technique needs a scene, and the case has none");
    scene::Scene dull;
    addRoom(dull);
    EXPECT_EQ(message("{}", &dull),
              "scene 'room' has no reflectors: no material's roughness is at most 0.4; "
              "'reflector_roughness: 1' takes them all");
    const scene::Scene room = roomWithMirror();
    EXPECT_EQ(message("{view: path_1}", &room),
              "the scene has no path or camera 'path_1'; paths: none; cameras: 'front', 'ceiling'; "
              "or 'AZIMUTH ELEVATION' in degrees, or 'X Y Z > X Y Z' from and to, with more such "
              "behind ';' a path");
}

TEST_F(ClusteredReflectionsTest, EveryMethodRecordsSharesMemoryAndErrors) {
    const scene::Scene scene = roomWithMirrors();
    for (const char* method : kMethods) {
        SCOPED_TRACE(method);
        const Metrics metrics = run(fmt::format("{{method: {}}}", method), scene);
        EXPECT_GT(metrics.at("reflective_pct"), 20.0);
        EXPECT_GT(metrics.at("planar_pct"), 10.0);
        EXPECT_LT(metrics.at("planar_pct"), 100.0);
        EXPECT_EQ(metrics.at("visible_reflectors"), 2.0);
        EXPECT_EQ(metrics.at("reflectors"), 2.0);
        EXPECT_GE(metrics.at("memory_bytes"), metrics.at("frame_buffer_bytes"));
        // G-buffer and target have 36 bytes a sample, 4 more where rays are traced, the output 8 a
        // pixel; so have the images of a cluster, with 4 bytes more where they have no pyramid.
        const std::string_view name(method);
        const bool isClustered = name == "clustered";
        const int ofSample = 24 + (name == "ray_traced" || name == "embree" ? 4 : 0) + 12;
        EXPECT_EQ(metrics.at("frame_buffer_bytes"),
                  48 * 40 * (4 * ofSample + 8) + (isClustered ? 2048 * 2048 * 8 + 4 : 0));
        EXPECT_TRUE(metrics.contains("channel_error"));
        EXPECT_TRUE(metrics.contains("display_flip"));
        EXPECT_TRUE(metrics.contains("display_psnr_db"));
        EXPECT_EQ(metrics.contains("clusters"), isClustered);
        EXPECT_EQ(metrics.contains("occlusion_error_pct"), isClustered);
        EXPECT_EQ(passes_.front(), isClustered ? "first_pass_and_clustering" : "first_pass");
        EXPECT_EQ(passes_.back(), "composite");
    }
}

TEST_F(ClusteredReflectionsTest, EmbreeAgreesWithItself) {
    const Metrics metrics = run("{method: embree}", roomWithMirrors());
    EXPECT_EQ(metrics.at("channel_error"), 0.0);
    EXPECT_EQ(metrics.at("channel_error_image"), 0.0);
    EXPECT_EQ(metrics.at("display_flip"), 0.0);
    EXPECT_EQ(metrics.at("display_psnr_db"), 120.0);
}

TEST_F(ClusteredReflectionsTest, RayTracingOnTheDeviceAgreesWithEmbree) {
    const scene::Scene scene = roomWithMirrors();
    // Rays along edges may go either way.
    EXPECT_LT(run("{method: ray_traced}", scene).at("channel_error"), 0.5);
    EXPECT_LT(run("{method: ray_traced, glossiness: 0.2}", scene).at("channel_error"), 0.5);
}

TEST_F(ClusteredReflectionsTest, PlanarMirrorsHaveNoOcclusionError) {
    const scene::Scene scene = roomWithMirror();
    for (const char* options : {"", "depth_images: visible", "march: hierarchical",
                                "depth_images: visible, march: hierarchical", "supersampling: 3"}) {
        SCOPED_TRACE(options);
        const Metrics metrics = run(fmt::format("{{{}}}", options), scene);
        EXPECT_EQ(metrics.at("planar_pct"), 100.0);
        EXPECT_EQ(metrics.at("clusters"), 1.0);
        EXPECT_EQ(metrics.at("occlusion_error_pct"), 0.0);
        EXPECT_EQ(metrics.at("occlusion_error_planar_pct"), 0.0);
        EXPECT_EQ(metrics.at("occlusion_self_pct"), 0.0);
        // At most a few samples where walls stand on the mirror: no texel lies between.
        EXPECT_LT(metrics.at("environment_pct"), 0.2);
        // Resampling of stripes and edges alone.
        EXPECT_LT(metrics.at("channel_error"), 3.0);
    }
}

// [xie2017] Sec. 4.7.2: a pinhole has a planar mirror's rays as points, and those of a lobe as
// lines.
TEST_F(ClusteredReflectionsTest, ALobesRaysAreFollowedForMoreStepsThanAMirrors) {
    for (const char* drawing : {"one_by_one", "visible"}) {
        const auto stepsOf = [&](const char* glossiness) {
            return run(fmt::format("{{depth_images: {}, rays: 8, glossiness: {}}}", drawing,
                                   glossiness),
                       roomWithMirror())
                .at("march_steps");
        };
        const double mirror = stepsOf("0"), narrow = stepsOf("0.1"), wide = stepsOf("0.3");
        EXPECT_GE(mirror, 1.0) << drawing;
        EXPECT_LE(mirror, 2.0) << drawing;  // both ends
        EXPECT_GT(narrow, mirror) << drawing;
        EXPECT_GT(wide, 1.1 * narrow) << drawing;
    }
}

TEST_F(ClusteredReflectionsTest, ClustersAreNearerToTheTruthThanAnEnvironmentMap) {
    for (const scene::Scene& scene : {roomWithMirror(), roomWithMirrors()}) {
        const Metrics clustered = run("{}", scene);
        const Metrics environment = run("{method: environment_map}", scene);
        for (const char* error : {"channel_error", "channel_error_image", "display_flip"}) {
            EXPECT_LT(2.0 * clustered.at(error), environment.at(error)) << error;
        }
    }
}

TEST_F(ClusteredReflectionsTest, ConvexMirrorsDoNotShowThemselves) {
    // A green column in a room without green; from its silhouette rays leave along its surface.
    scene::Scene scene = roomWithColumn({.baseColor = {0, 1, 0, 1}, .metallic = 1, .roughness = 0});
    for (const char* options : {"{pictures: true}", "{pictures: true, depth_images: visible}"}) {
        SCOPED_TRACE(options);
        const image::ImageF reflection = recorded(options, &scene).images.at("reflection");
        int reflecting = 0, green = 0;
        for (const auto [y, x] : test::grid(reflection.height(), reflection.width())) {
            const glm::vec3 color(reflection.at(x, y, 0), reflection.at(x, y, 1),
                                  reflection.at(x, y, 2));
            reflecting += color != glm::vec3(0.0F) ? 1 : 0;
            green += color.y > 0.05F && color.y > 2.0F * std::max(color.x, color.z) ? 1 : 0;
        }
        EXPECT_GT(reflecting, 50);
        // The environment map has the column where it is near, for some of the silhouette.
        EXPECT_LT(green, reflecting / 20);
    }
}

TEST_F(ClusteredReflectionsTest, MoreBinsGiveMoreClustersAndSmallerOcclusionErrors) {
    const scene::Scene scene = roomWithMirrors();
    const Metrics coarse = run("{reflector_parts: false, bin_gain: 1e-6}", scene);
    const Metrics fine = run("{reflector_parts: false, bin_exponent: 0}", scene);
    EXPECT_EQ(coarse.at("clusters"), 2.0);
    EXPECT_GT(fine.at("clusters"), 6.0);
    EXPECT_GT(coarse.at("occlusion_error_pct"), 0.0);
    EXPECT_LT(fine.at("occlusion_error_pct"), 0.5 * coarse.at("occlusion_error_pct"));
    EXPECT_EQ(coarse.at("occlusion_error_planar_pct"), 0.0);
}

TEST_F(ClusteredReflectionsTest, ABowlHasItsHitsOnItselfEitherWay) {
    scene::Scene scene = rooms::room();
    rooms::add(scene, rooms::bowl({0.0F, -0.4F, 0.0F}, 0.8F), {1.0F, 0.0F, 1.0F},
               rooms::Surface::Mirror);
    scene.cameras = {reflections::camera({0.3F, 1.2F, 1.2F}, {0.0F, -0.6F, 0.0F})};
    for (const char* own : {"concave_diffuse", "whole_scene"}) {
        SCOPED_TRACE(own);
        const Metrics shown = run(fmt::format("{{own_reflector: {}}}", own), scene);
        EXPECT_LT(shown.at("occlusion_self_pct"), 1.0);
        EXPECT_NEAR(shown.at("occlusion_error_pct"),
                    shown.at("occlusion_hidden_pct") + shown.at("occlusion_near_pct") +
                        shown.at("occlusion_side_pct") + shown.at("occlusion_self_pct"),
                    1e-9);
    }
}

TEST_F(ClusteredReflectionsTest, ClustersAndTheirOcclusionErrorsNeedNoDepthImages) {
    const scene::Scene scene = roomWithMirrors();
    for (const char* clustering : {"normal_bins", "kd_tree"}) {
        const Metrics drawn = run(fmt::format("{{clustering: {}}}", clustering), scene);
        const Metrics none =
            run(fmt::format("{{clustering: {}, depth_images: none}}", clustering), scene);
        EXPECT_EQ(passes_,
                  (std::vector<std::string>{"first_pass_and_clustering", "cluster_cameras"}));
        for (const auto& [name, value] : none) EXPECT_EQ(value, drawn.at(name)) << name;
        EXPECT_GT(none.at("clusters"), 1.0);
        EXPECT_GT(none.at("occlusion_error_pct"), 0.0);
        for (const char* ofPictures : {"channel_error", "display_flip", "display_psnr_db",
                                       "environment_pct", "drawn_triangles", "texels_per_sample"}) {
            EXPECT_FALSE(none.contains(ofPictures)) << ofPictures;
        }
    }
}

TEST_F(ClusteredReflectionsTest, OcclusionErrorsOfOneReflectorAlone) {
    scene::Scene scene = roomWithMirrors();
    scene.meshes.back().name = "column";
    const Metrics all = run("{bin_gain: 1e-6}", scene);
    const Metrics column = run("{bin_gain: 1e-6, errors_of: column}", scene);
    EXPECT_GT(column.at("occlusion_error_pct"), 2.0 * all.at("occlusion_error_pct"));
    EXPECT_EQ(column.at("clusters"), all.at("clusters"));
    EXPECT_EQ(errorText([&] { run("{errors_of: vase}", scene); }),
              "the scene has no reflector 'vase' ('errors_of'); reflectors: column, part");
}

TEST_F(ClusteredReflectionsTest, ViewsWithoutReflectorsHaveNoErrors) {
    scene::Scene scene = roomWithMirrors();
    scene.lights = {{}};
    for (const char* method : kMethods) {
        SCOPED_TRACE(method);
        testing::internal::CaptureStderr();
        const Metrics metrics =
            run(fmt::format("{{method: {}, view: ceiling, pictures: true}}", method), scene);
        EXPECT_EQ(
            testing::internal::GetCapturedStderr(),
            fmt::format(
                "warning: scene '{}': a frame shows no reflector; no errors are measured of it\n",
                scene.name));
        EXPECT_EQ(metrics.at("reflective_pct"), 0.0);
        EXPECT_EQ(metrics.at("visible_reflectors"), 0.0);
        for (const char* error :
             {"planar_pct", "channel_error", "channel_error_image", "display_flip",
              "display_psnr_db", "environment_pct", "occlusion_error_pct", "clusters",
              "drawn_triangles", "drawn_left_out"}) {
            EXPECT_FALSE(metrics.contains(error)) << error;
        }
    }
}

TEST_F(ClusteredReflectionsTest, ObjectsMoveWhereAsked) {
    const scene::Scene scene = roomWithMirrors();
    const auto picture = [&](const std::string& yaml, int frame) {
        return recorded(yaml, &scene, frame, 4).images.at("result");
    };
    for (const char* method : {"clustered", "ray_traced"}) {
        SCOPED_TRACE(method);
        const std::string still = fmt::format("{{method: {}, pictures: true}}", method);
        const std::string moving =
            fmt::format("{{method: {}, pictures: true, motion: true}}", method);
        EXPECT_EQ(picture(still, 0), picture(still, 2));
        EXPECT_NE(picture(moving, 0), picture(moving, 2));
        // The truth moves along.
        const double error = recorded(moving, &scene, 1, 4).metrics.at("channel_error");
        EXPECT_LT(error, 1.5 * recorded(still, &scene, 1, 4).metrics.at("channel_error") + 0.5);
    }
}

TEST_F(ClusteredReflectionsTest, AConvergedTruthTellsManyRaysFromFew) {
    const scene::Scene scene = roomWithMirrors();
    // Ray tracing errs against it by its number of rays alone.
    const auto error = [&](int rays) {
        return run(fmt::format("{{method: embree, glossiness: 0.3, far_exponent: 0.5, rays: {}, "
                               "converged_rays: 256}}",
                               rays),
                   scene);
    };
    const Metrics few = error(2), many = error(49), all = error(256);
    EXPECT_EQ(few.at("channel_error"), 0.0);
    EXPECT_GT(few.at("channel_error_converged"), 2.0 * many.at("channel_error_converged"));
    EXPECT_GT(many.at("channel_error_converged"), 0.0);
    EXPECT_EQ(all.at("channel_error_converged"), 0.0);
    EXPECT_FALSE(run("{method: embree}", scene).contains("channel_error_converged"));
}

TEST_F(ClusteredReflectionsTest, GlossinessOverridesMaterials) {
    const scene::Scene scene = roomWithMirrors();
    const auto truth = [&](const std::string& yaml) {
        return recorded(yaml, &scene).images.at("truth");
    };
    EXPECT_EQ(truth("{method: embree, pictures: true}"),
              truth("{method: embree, pictures: true, glossiness: 0}"));
    EXPECT_NE(truth("{method: embree, pictures: true}"),
              truth("{method: embree, pictures: true, glossiness: 0.3}"));
}

TEST_F(ClusteredReflectionsTest, SaysHowManyRaysMaterialsAskFor) {
    scene::Scene scene = roomWithMirror();
    scene.lights = {{}};
    const auto said = [&](const std::string& options) {
        testing::internal::CaptureStderr();
        run("{method: environment_map" + options + "}", scene);
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(said(""), "");  // mirrors
    for (scene::Material& material : scene.materials) {
        if (material.metallic > 0.0F) material.roughness = 0.25F;
    }
    EXPECT_EQ(said(""),
              "warning: scene 'room': what reflects is as rough as its materials say, with up to "
              "18 rays a sample; 'glossiness: 0' makes mirrors of it, 'rays' sets how many\n");
    EXPECT_EQ(said(", glossiness: 0"), "");
    EXPECT_EQ(said(", rays: 8"), "");
}

TEST_F(ClusteredReflectionsTest, SameCaseGivesTheSameNumbersAndPictures) {
    const scene::Scene scene = roomWithMirrors();
    const test::MetricRecorder a = recorded("{pictures: true}", &scene);
    const test::MetricRecorder b = recorded("{pictures: true}", &scene);
    EXPECT_EQ(a.metrics, b.metrics);
    ASSERT_EQ(a.images.size(), 9U);
    for (const auto& [name, image] : a.images) {
        EXPECT_TRUE(std::ranges::equal(image.values(), b.images.at(name).values())) << name;
    }
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
