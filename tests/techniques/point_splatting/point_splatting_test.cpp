// The technique as a whole: parameters, metrics, images that culling, storage and modes may not
// change, and clouds that are wrong.
#include "techniques/point_splatting/point_splatting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "scenes/shared/mesh_builder.h"
#include "tests/support/grid.h"
#include "tests/techniques/point_splatting/point_clouds.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::point_splatting {
namespace {

/// A sphere with bumps: patches of every orientation, some curved.
scene::Scene bumpySphere(int count) {
    scene::Scene scene{.points = sphere(count)};
    for (glm::vec3& p : scene.points.positions) {
        p *= 1.0F + 0.04F * std::sin(9.0F * p.x) * std::sin(7.0F * p.y);
    }
    return scene;
}

struct PointSplattingTest : test::TechniqueTest {
    PointSplattingTest() : TechniqueTest(kPointSplatting, {96, 96}) {}
};

/// Pixels of different colour, and the largest difference.
std::pair<int, float> difference(const image::ImageF& a, const image::ImageF& b) {
    int pixels = 0;
    float most = 0.0F;
    for (const auto [y, x] : test::grid(a.height(), a.width())) {
        bool differs = false;
        for (int c = 0; c < a.channels(); ++c) {
            const float d = std::abs(a.at(x, y, c) - b.at(x, y, c));
            differs = differs || d > 0.0F;
            most = std::max(most, d);
        }
        pixels += differs ? 1 : 0;
    }
    return {pixels, most};
}

int coveredPixels(const image::ImageF& image) {
    return difference(image, image::ImageF(image.width(), image.height(), image.channels())).first;
}

TEST(PointSplattingParamsTest, RefusesWhatMeansNothing) {
    test::expectRefused(
        kPointSplatting,
        {
            {"{}", ""},
            {"{method: full_ewa, c_min: 0.1}", "27: 'c_min' needs 'method: adaptive'"},
            {"{level: all, target_radius_px: 3}", "32: 'target_radius_px' needs 'level: by_size'"},
            {"{level: all, fine_radius_px: 1}", "30: 'fine_radius_px' needs 'level: by_size'"},
            {"{silhouette_deg: 91}",
             "18: technique 'point_splatting': silhouette_deg is 91; allowed: 0 … 90 °"},
            {"{method: plain_points, cutoff: 3}", "32: 'cutoff' needs a method of splats"},
            {"{c_min: 4}", "9: c_min 4 is above c_max 3"},
            {"{patch_points_max: 10}", "1: patch_points_min 64 is above patch_points_max 10"},
            {"{distance: 0}",
             "12: technique 'point_splatting': distance is 0; allowed: 0.01 … 1000 of the framing "
             "distance"},
            {"{view: 30 17, distance: 2}", ""},
            {"{view: front, distance: 2}", "25: 'distance' needs a 'view' that frames it"},
            {"{method: splats}",
             "10: technique 'point_splatting': method is splats; allowed: adaptive | full_ewa | "
             "reconstruction | low_pass | sprites | plain_points"},
            {"{storge: compressed}",
             "2: technique 'point_splatting': unknown parameter 'storge'; did you mean 'storage'?"},
        });
}

TEST_F(PointSplattingTest, TheTruthOfAViewIsMadeOnce) {
    const scene::Scene scene = bumpySphere(20000);
    const std::string common = "cache: false, errors: true, pictures: true, ";
    const std::size_t bytesOfOne = expectSharedAsAlone(common, {"method: adaptive"}, scene);
    EXPECT_GT(bytesOfOne, 0U);
    // Each of what it is made regardless of.
    const std::vector<std::string> regardless = {"method: adaptive", "method: full_ewa",
                                                 "method: low_pass", "method: sprites",
                                                 "method: adaptive, target_radius_px: 0.5"};
    EXPECT_EQ(expectSharedAsAlone(common, regardless, scene), bytesOfOne);
    // What decides it.
    const std::vector<std::string> deciding = {
        "method: adaptive",  "distance: 2",          "rotation_deg: 40",  "low_pass_radius_px: 2",
        "cutoff: 2",         "visibility_offset: 2", "cull_cones: false", "patch_points_max: 500",
        "look_at: [0, 0, 0]"};
    EXPECT_GT(expectSharedAsAlone(common, deciding, scene), 8 * bytesOfOne);
}

TEST_F(PointSplattingTest, EveryMethodRunsAndRecords) {
    const scene::Scene scene = bumpySphere(20000);
    for (const char* method : {"adaptive", "full_ewa", "reconstruction", "low_pass", "sprites"}) {
        SCOPED_TRACE(method);
        const test::MetricRecorder recorder =
            recorded(fmt::format("{{method: {}, cache: false, errors: true, pictures: true, "
                                 "compression_errors: true, points_per_second: true}}",
                                 method),
                     &scene);
        const auto& metrics = recorder.metrics;
        EXPECT_EQ(metrics.at("points"), 20000.0);
        EXPECT_GT(metrics.at("drawn_points"), 1000.0);
        EXPECT_NEAR(metrics.at("drawn_pct"), metrics.at("drawn_points") / 200.0, 1e-9);
        EXPECT_NEAR(metrics.at("mode_pct/full_ewa") + metrics.at("mode_pct/reconstruction") +
                        metrics.at("mode_pct/low_pass") + metrics.at("mode_pct/sprite"),
                    100.0, 1e-9);
        EXPECT_LT(metrics.at("bytes_per_point"), 8.1);
        EXPECT_GT(metrics.at("display_psnr_db/supersampled"), 10.0);
        EXPECT_GT(metrics.at("display_psnr_db/filtered"), 10.0);
        // Of a sphere seen from some radii away, a little less than a half faces the eye.
        EXPECT_GT(metrics.at("facing_pct"), 25.0);
        EXPECT_LT(metrics.at("facing_pct"), 50.0);
        EXPECT_EQ(recorder.images.count("modes"), method == std::string("adaptive") ? 1U : 0U);
        EXPECT_EQ(metrics.count("preprocess_ms/built"), 1U);
        EXPECT_GT(metrics.at("drawn_points_per_second"), 0.0);
        EXPECT_GT(coveredPixels(recorder.images.at("image")), 1000);
        const bool isSplat = std::string(method) != "sprites";
        const std::vector<std::string> expected =
            isSplat ? std::vector<std::string>{"selection", "visibility", "splats", "normalization"}
                    : std::vector<std::string>{"selection", "sprites"};
        EXPECT_EQ(passes_, expected);
    }
}

TEST_F(PointSplattingTest, PlainPointsAreAsManyAsSpritesAndAPixelEach) {
    const scene::Scene scene = bumpySphere(20000);
    const auto drawn = [&](const char* method) {
        return recorded(
            fmt::format(
                "{{method: {}, level: all, cache: false, pictures: true, points_per_second: true}}",
                method),
            &scene);
    };
    const test::MetricRecorder plain = drawn("plain_points");
    EXPECT_EQ(passes_, (std::vector<std::string>{"selection", "points"}));
    const test::MetricRecorder sprites = drawn("sprites");
    EXPECT_EQ(plain.metrics.at("drawn_points"), sprites.metrics.at("drawn_points"));
    EXPECT_EQ(plain.metrics.at("bytes_per_point"), 12.0);
    EXPECT_EQ(plain.metrics.count("selection_ms"), 1U);
    const int pixels = coveredPixels(plain.images.at("image"));
    EXPECT_GT(pixels, 1000);
    EXPECT_LE(pixels, static_cast<int>(plain.metrics.at("drawn_points")));
    EXPECT_EQ(errorText([&] { recorded("{method: plain_points, storage: compressed}", &scene); }),
              "case.yaml:1:33: 'storage' needs a method of splats");
}

TEST_F(PointSplattingTest, CullingDropsNothingThatIsVisible) {
    const scene::Scene scene = bumpySphere(20000);
    double culled = 0.0;
    for (const float distance : {0.5F, 1.0F, 3.0F}) {
        for (int frame = 0; frame < 4; ++frame) {
            SCOPED_TRACE(fmt::format("distance {}, frame {}", distance, frame));
            const std::string yaml =
                fmt::format("cache: false, pictures: true, distance: {}", distance);
            const test::MetricRecorder with =
                recorded(fmt::format("{{{}}}", yaml), &scene, frame, 4);
            const test::MetricRecorder without =
                recorded(fmt::format("{{{}, cull_frustum: false, cull_cones: false}}", yaml),
                         &scene, frame, 4);
            // Culled patches have splats that the shaders still draw (isTurnedAway()): the filter
            // makes them reach around the outline by a level of 255 in a pixel or two.
            const auto [pixels, most] =
                difference(with.images.at("image"), without.images.at("image"));
            EXPECT_LE(pixels, 4);
            EXPECT_LE(most, 1.01F / 255.0F);
            EXPECT_EQ(without.metrics.at("patches_drawn"), without.metrics.at("patches"));
            culled += with.metrics.at("patches_outside") + with.metrics.at("patches_turned_away");
        }
    }
    EXPECT_GT(culled, 100.0);
}

TEST_F(PointSplattingTest, CompressionAndModesHardlyShow) {
    const scene::Scene scene = bumpySphere(40000);
    const test::MetricRecorder recorder =
        recorded("{cache: false, errors: true, compression_errors: true}", &scene);
    // A position is off by at most 1/4096 of a patch and a normal by 0.8°, which shading shows as
    // half a level of 255 on the average; 35 dB would be five levels.
    EXPECT_GT(recorder.metrics.at("display_psnr_db/uncompressed"), 40.0);
    // Filters alone are wrong by what they leave out, up to c_min and a c_max-th of the area.
    EXPECT_GE(recorder.metrics.at("display_psnr_db/full_ewa"), 30.0);
    EXPECT_LT(recorder.metrics.at("compression_error_of_bound/position"), 1.1);
    EXPECT_LT(recorder.metrics.at("compression_error_of_bound/normal"), 1.01);
    EXPECT_GT(recorder.metrics.at("compression_error_of_bound/position"), 0.9);
}

/// Each pixel has the colour of the mode that most of its weight is of.
TEST_F(PointSplattingTest, ModesArePictured) {
    const scene::Scene scene = bumpySphere(20000);
    const auto shares = [&](const std::string& yaml) {
        const test::MetricRecorder recorder =
            recorded(fmt::format("{{cache: false, pictures: true, level: all, {}}}", yaml), &scene);
        const image::ImageF& modes = recorder.images.at("modes");
        const image::ImageF& image = recorder.images.at("image");
        std::array<int, 3> most{};
        int covered = 0;
        for (const auto [y, x] : test::grid(modes.height(), modes.width())) {
            const float* begin = &modes.at(x, y, 0);
            covered += image.at(x, y, 0) > 0.0F ? 1 : 0;
            if (*std::max_element(begin, begin + 3) <= 0.05F) continue;
            ++most[static_cast<std::size_t>(std::max_element(begin, begin + 3) - begin)];
        }
        EXPECT_NEAR(most[0] + most[1] + most[2], covered, 0.1 * covered);
        return most;  // full EWA is red, the low-pass green, reconstruction blue
    };
    const auto all = shares("c_min: 0, c_max: 1e6");
    EXPECT_GT(all[0], 1000);
    EXPECT_EQ(all[1] + all[2], 0);
    const auto near = shares("c_min: 0, c_max: 0");
    EXPECT_GT(near[2], near[0]);  // but at the silhouette
    EXPECT_GT(near[0], 100);
    EXPECT_EQ(near[1], 0);
    const auto far = shares("c_min: 1e6, c_max: 1e6");
    EXPECT_GT(far[1], far[0]);
    EXPECT_EQ(far[2], 0);
}

/// Eq. (1) on points far smaller than pixels: full EWA is its own ideal, which a pixel's box is
/// not.
TEST_F(PointSplattingTest, FullEwaIsNearestToItsOwnFilter) {
    const scene::Scene scene = bumpySphere(40000);
    const auto metrics =
        recorded(
            "{method: full_ewa, level: all, cache: false, errors: true, distance: 2, cutoff: 3}",
            &scene)
            .metrics;
    EXPECT_GT(metrics.at("display_psnr_db/filtered"),
              metrics.at("display_psnr_db/supersampled") + 3.0);
}

TEST_F(PointSplattingTest, MorePointsArriveAndShowMore) {
    const scene::Scene scene = bumpySphere(20000);
    double formerBytes = 0.0, formerPsnr = 0.0;
    for (const float share : {0.01F, 0.1F, 0.9F}) {
        const test::MetricRecorder recorder = recorded(
            fmt::format("{{cache: false, errors: true, progressive_share: {}}}", share), &scene);
        EXPECT_GT(recorder.metrics.at("arrived_bytes"), formerBytes);
        EXPECT_LE(recorder.metrics.at("arrived_bytes"),
                  static_cast<double>(share) * 160000.0 + 8.0 * recorder.metrics.at("patches"));
        EXPECT_GE(recorder.metrics.at("display_psnr_db/supersampled"), formerPsnr);
        formerBytes = recorder.metrics.at("arrived_bytes");
        formerPsnr = recorder.metrics.at("display_psnr_db/supersampled");
    }
}

/// A ball of triangles no larger than a pixel of 96 × 96, red.
scene::Scene ballOfTriangles() {
    constexpr std::uint32_t kAround = 256, kUp = 128;
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t row = 0; row <= kUp; ++row) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double up = glm::pi<double>() * row / kUp;
            const double around = 2.0 * glm::pi<double>() * i / kAround;
            positions.emplace_back(std::sin(up) * std::sin(around), std::cos(up),
                                   std::sin(up) * std::cos(around));
            if (row == kUp) continue;
            const std::uint32_t here = row * kAround + i, next = row * kAround + (i + 1) % kAround;
            triangles.emplace_back(here, here + kAround, next + kAround);
            triangles.emplace_back(here, next + kAround, next);
        }
    }
    scene::MeshBuilder builder;
    builder.setColor({0.8F, 0.1F, 0.1F});
    builder.addIndexed(positions, positions, triangles);
    scene::Scene scene = scene::sceneOf(builder.take("ball", 0));
    scene.materials.resize(1);
    scene.materials[0].baseColor = glm::vec4(1.0F);
    return scene;
}

/// Over the pixels that lie, with all beside them, where the third picture has something.
double psnrDb(const image::ImageF& a, const image::ImageF& b, const image::ImageF& where) {
    double sum = 0.0;
    int count = 0;
    for (int y = 1; y + 1 < a.height(); ++y) {
        for (int x = 1; x + 1 < a.width(); ++x) {
            bool isInside = true;
            for (int i = 0; i < 9; ++i) {
                isInside = isInside && where.at(x + i % 3 - 1, y + i / 3 - 1, 0) > 0.0F;
            }
            if (!isInside) continue;
            ++count;
            for (int c = 0; c < 3; ++c) {
                const double away = static_cast<double>(a.at(x, y, c) - b.at(x, y, c));
                sum += away * away / 3.0;
            }
        }
    }
    EXPECT_GT(count, 1000);
    return -10.0 * std::log10(sum / count);
}

/// Of the surface itself, whatever points were taken of it: a picture to which they come near.
TEST_F(PointSplattingTest, TheSurfaceIsFramedAndTracedHoweverManyPointsAreTaken) {
    const scene::Scene scene = ballOfTriangles();
    const auto pictures = [&](int points) {
        return recorded(
            fmt::format("{{cache: false, errors: true, pictures: true, points: {}}}", points),
            &scene);
    };
    const test::MetricRecorder few = pictures(500), many = pictures(300000);
    const image::ImageF& surface = many.images.at("surface");
    EXPECT_EQ(difference(few.images.at("surface"), surface), std::pair(0, 0.0F));
    const double nearDb = psnrDb(surface, many.images.at("supersampled"), surface);
    EXPECT_GT(nearDb, 45.0);
    EXPECT_LT(psnrDb(surface, few.images.at("supersampled"), surface), nearDb);
    EXPECT_GT(many.metrics.at("display_psnr_db/surface"), 20.0);
    // The ball fills the window as its box does: a pixel's middle knows where the light comes from.
    const glm::vec3 light = glm::normalize(kLightDirectionView);
    const glm::vec3 halfway = glm::normalize(light + glm::vec3(0, 0, 1));
    const float highlight = 0.15F * std::pow(halfway.z, 24.0F) * light.z;
    EXPECT_NEAR(surface.at(48, 48, 0), 0.8F * (0.1F + 0.9F * light.z) + highlight, 0.01F);
    EXPECT_NEAR(surface.at(48, 48, 1), 0.1F * (0.1F + 0.9F * light.z) + highlight, 0.01F);
    // A cloud has none, and faces that are turned away are passed.
    const scene::Scene cloud = bumpySphere(2000);
    EXPECT_EQ(
        recorded("{cache: false, errors: true}", &cloud).metrics.count("display_psnr_db/surface"),
        0U);
    scene::Scene open = scene;
    std::erase_if(open.meshes[0].triangles, [&](const glm::uvec3& triangle) {
        return open.meshes[0].positions[triangle.x].z > 0.5F;
    });
    const image::ImageF half =
        recorded("{cache: false, errors: true, pictures: true, view: 0 0, points: 1000}", &open)
            .images.at("surface");
    EXPECT_EQ(half.at(48, 48, 0), 0.0F);
}

TEST_F(PointSplattingTest, SurfacesAreSampled) {
    scene::MeshBuilder builder;
    builder.addBox({0, 0, 0}, {1, 1, 1});
    const scene::Scene scene = scene::sceneOf(builder.take("box", -1));
    EXPECT_EQ(recorded("{cache: false, points: 3000}", &scene).metrics.at("points"), 3000.0);
    const scene::Scene cloud = bumpySphere(100);
    EXPECT_EQ(errorText([&] { recorded("{cache: false, points: 3000}", &cloud); }),
              "case.yaml:1:24: 'points' needs a scene without points of its own");
}

TEST_F(PointSplattingTest, CacheIsTakenAndGivesTheSameImage) {
    ASSERT_EQ(setenv("XDG_CACHE_HOME", folder.path().c_str(), 1), 0);
    const scene::Scene scene = bumpySphere(5000);
    const test::MetricRecorder first = recorded("{pictures: true}", &scene);
    const test::MetricRecorder second = recorded("{pictures: true}", &scene);
    EXPECT_EQ(first.metrics.count("preprocess_ms/built"), 1U);
    EXPECT_EQ(second.metrics.count("preprocess_ms/mapped"), 1U);
    EXPECT_EQ(difference(first.images.at("image"), second.images.at("image")), std::pair(0, 0.0F));
    EXPECT_FALSE(fs::is_empty(folder.path() / "gfxrepro" / "points"));
}

TEST_F(PointSplattingTest, RepairsBadPointsAndSaysSo) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scene::Scene scene = bumpySphere(3000);
    scene.points.normals[3] = glm::vec3(nan);
    scene.points.normals[4] = glm::vec3(0.0F);
    scene.points.radii[5] = 0.0F;
    scene.points.positions[6].y = nan;
    scene.points.positions[7] = scene.points.positions[8];
    const auto metrics = recorded("{cache: false}", &scene).metrics;
    EXPECT_EQ(metrics.at("normals_estimated"), 2.0);
    EXPECT_EQ(metrics.at("radii_estimated"), 1.0);
    EXPECT_EQ(metrics.at("points_dropped"), 2.0);
    EXPECT_EQ(metrics.at("points"), 2998.0);
}

TEST_F(PointSplattingTest, DrawsOnePointAndManyAtOnePlace) {
    scene::Scene one;
    one.points.positions = {{1, 2, 3}};
    scene::Scene equal;
    equal.points.positions.assign(500, {1, 2, 3});
    for (const char* method : {"adaptive", "full_ewa", "reconstruction", "low_pass", "sprites"}) {
        SCOPED_TRACE(method);
        const std::string yaml = fmt::format(
            "{{method: {}, cache: false, pictures: true, errors: true, compression_errors: true}}",
            method);
        const test::MetricRecorder single = recorded(yaml, &one);
        EXPECT_EQ(single.metrics.at("points"), 1.0);
        EXPECT_GT(coveredPixels(single.images.at("image")), 0);
        const test::MetricRecorder many = recorded(yaml, &equal);
        EXPECT_EQ(many.metrics.at("points_dropped"), 499.0);
        EXPECT_EQ(difference(single.images.at("image"), many.images.at("image")),
                  std::pair(0, 0.0F));
    }
}

TEST_F(PointSplattingTest, RefusesScenesWithoutPoints) {
    const auto message = [&](const scene::Scene* scene) {
        return errorText([&] { recorded("{cache: false}", scene); });
    };
    EXPECT_EQ(message(nullptr), "the technique needs a scene, and the case has none");
    scene::Scene empty;
    EXPECT_EQ(message(&empty),
              "technique 'point_splatting' needs a scene with points or triangles");
    empty.points.positions.assign(4, glm::vec3(std::numeric_limits<float>::infinity()));
    EXPECT_EQ(message(&empty), "no point with a finite position");
}

TEST_F(PointSplattingTest, SaysThatTexturesAreLeftOut) {
    const scene::Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                           .triangles = {{0, 1, 2}}};
    scene::Scene scene = sceneOf(mesh);
    scene.name = "t";
    const auto said = [&] {
        testing::internal::CaptureStderr();
        recorded("{cache: false, points: 100}", &scene);
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(said(), "");
    scene.meshes[0].texcoords.assign(3, glm::vec2(0.0F));
    scene.meshes[0].material = 0;
    scene.materials = {{.baseColorTexture = 0}};
    scene.textures = {image::Image8(1, 1, 3)};
    EXPECT_EQ(said(), "warning: scene 't': its points have no colours of its textures\n");
}

TEST_F(PointSplattingTest, TakesCamerasAndPathsOfTheScene) {
    scene::Scene scene = bumpySphere(20000);
    const auto seen = [&](const std::string& view) {
        return recorded("{cache: false, pictures: true, view: " + view + "}", &scene)
            .images.at("image");
    };
    const image::ImageF framed = seen("30 17"), above = seen("30 80");
    EXPECT_GT(difference(framed, above).first, 100);
    scene::Camera camera = scene::framingCamera(scene.bounds(), 1.0F);
    camera.name = "far";
    camera.position = camera.target + 2.0F * (camera.position - camera.target);
    camera.nearM = 0.1F;
    camera.farM = 100.0F;
    scene.cameras = {camera};
    const int covered = coveredPixels(seen("far"));
    EXPECT_NEAR(static_cast<double>(coveredPixels(framed)) / covered, 4.0, 0.5);  // its rim blurs
    camera.name.clear();
    scene.paths = {{"walk", {camera}}};
    EXPECT_EQ(coveredPixels(seen("walk")), covered);
    EXPECT_EQ(
        errorText([&] { seen("none"); }),
        "the scene has no path or camera 'none'; paths: 'walk'; cameras: 'far'; or 'AZIMUTH "
        "ELEVATION' in degrees, or 'X Y Z > X Y Z' from and to, with more such behind ';' a path");
}

TEST(TurntableCamera, HoldsTheBoxFromEverySide) {
    const scene::Box box{{-1, 0, 2}, {3, 1, 4}};
    for (const float rotation : {0.0F, 1.0F, 3.0F, 5.0F}) {
        const scene::Camera camera = turntableCamera(box, 1.0F, {1.0F, rotation, glm::vec3(0.5F)});
        EXPECT_EQ(camera.target, box.centre());
        const float distance = glm::length(camera.position - camera.target);
        EXPECT_NEAR(distance, glm::length(scene::framingCamera(box, 1.0F).position - box.centre()),
                    1e-4F * distance);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 at((corner & 1) != 0 ? box.min.x : box.max.x,
                               (corner & 2) != 0 ? box.min.y : box.max.y,
                               (corner & 4) != 0 ? box.min.z : box.max.z);
            const float depth =
                glm::dot(at - camera.position, glm::normalize(camera.target - camera.position));
            EXPECT_GT(depth, camera.nearM);
            EXPECT_LT(depth, camera.farM);
        }
    }
    for (const glm::vec3& towardsEye : {glm::vec3(0, 1, 2), glm::vec3(0, 1, 0)}) {
        const scene::Camera framing = scene::framingCamera(box, 1.0F, towardsEye);
        ViewSettings settings{.towardsEye = towardsEye};
        const scene::Camera camera = turntableCamera(box, 1.0F, settings);
        EXPECT_EQ(camera.position, framing.position);
        EXPECT_EQ(camera.up, framing.up);
        settings.rotationRad = 1.0F;  // turned about the vertical
        const scene::Camera turned = turntableCamera(box, 1.0F, settings);
        EXPECT_NEAR(turned.position.y, camera.position.y, 1e-5F);
        EXPECT_EQ(turned.up == camera.up, towardsEye.z != 0.0F);
    }
    const scene::Camera moved = turntableCamera(box, 1.0F, {0.1F, 0.0F, {0, 0, 1}});
    EXPECT_EQ(moved.target, glm::vec3(-1, 0, 4));
    EXPECT_GT(moved.nearM, 0.0F);
}

}  // namespace
}  // namespace gfxrepro::point_splatting
