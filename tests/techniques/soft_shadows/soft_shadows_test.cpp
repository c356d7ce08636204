// The technique as a whole: parameters, metrics, scenes whose shadows every method knows.
#include "techniques/soft_shadows/soft_shadows.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "engine/core/random.h"
#include "scenes/shared/mesh_builder.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::soft_shadows {
namespace {

struct SoftShadowsTest : test::TechniqueTest {
    SoftShadowsTest() : TechniqueTest(kSoftShadows, {48, 48}) {}

    using Metrics = std::map<std::string, double>;

    /// `method` with references and shadow maps of 192², 16 light samples and what `more` says.
    Metrics run(const std::string& method, const std::string& more, const scene::Scene& scene) {
        const bool takesImages =
            method == "non_redundant" || method == "conventional" || method == "depth_peeling";
        const char* sizes = method == "ray_traced" ? ""
                            : takesImages          ? ", shadow_map_size: 192, reference_size: 192"
                                                   : ", shadow_map_size: 192";
        const std::string yaml = fmt::format("{{method: {}, light_grid: 4{}{}{}}}", method, sizes,
                                             more.empty() ? "" : ", ", more);
        return recorded(yaml, &scene).metrics;
    }
};

constexpr const char* kReconstructing[] = {"non_redundant", "conventional", "depth_peeling"};

scene::Scene sceneFrom(scene::MeshBuilder& builder) {
    scene::Scene scene = scene::sceneOf(builder.take("test", -1));
    const scene::Camera camera{.position = {1.0F, 4.0F, 5.0F}, .verticalFovRad = 0.8F};
    scene.cameras = {camera};
    return scene;
}

/// A plate that floats over a floor; the reference images see all that can cast.
scene::Scene plateOverFloor() {
    scene::MeshBuilder builder;
    builder.addBox({0, -0.05F, 0}, {1.5F, 0.05F, 1.5F});
    builder.addBox({0, 0.7F, 0}, {0.5F, 0.05F, 0.5F});
    return sceneFrom(builder);
}

/// Boxes over a floor, many behind each other as seen from the light.
scene::Scene clutter() {
    scene::MeshBuilder builder;
    builder.addBox({0, -1.1F, 0}, {1.5F, 0.1F, 1.5F});
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 centre{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const glm::vec3 half{random.uniform(0.05F, 0.25F), random.uniform(0.02F, 0.04F),
                             random.uniform(0.05F, 0.25F)};
        builder.addBox(centre, half);
    }
    return sceneFrom(builder);
}

TEST(SoftShadowsParamsTest, RefusesWhatMeansNothing) {
    const std::string needsImages =
        "needs a method that takes depth images: non_redundant, conventional or depth_peeling";
    test::expectRefused(
        kSoftShadows,
        {
            {"{}", ""},
            {"{light_ratio: 0}", ""},  // a point
            {"{method: geometry, reference_size: 64}", "36: 'reference_size' " + needsImages},
            {"{method: pcss, simplify_to: 0.5}", "29: 'simplify_to' " + needsImages},
            {"{reconstruction: classic, grazing_limit: 4}",
             "42: 'grazing_limit' needs 'reconstruction: hybrid'"},
            {"{method: ray_traced, shadow_map_size: 64}", ""},  // of the truth
            {"{method: ray_traced, errors: false, shadow_map_size: 64}",
             "54: 'shadow_map_size' needs a method that draws shadow maps, or 'errors: true'"},
            {"{method: pcss, measured: depth_and_pass}",
             "26: 'measured: depth_and_pass' needs a method that draws a shadow map for each light "
             "sample"},
            {"{measured: depth_and_pass, pictures: true}",
             "38: 'pictures' needs 'measured: soft_shadow'"},
            {"{light_ratio: -1}",
             "15: technique 'soft_shadows': light_ratio is -1; allowed: 0 … 16"},
        });
}

TEST_F(SoftShadowsTest, TheTruthsOfALightAreMadeOnce) {
    const scene::Scene scene = clutter();
    const std::string common =
        "traced_truth: true, pictures: true, light_grid: 4, shadow_map_size: 96, ";
    const std::size_t bytesOfOne = expectSharedAsAlone(common, {"method: geometry"}, scene);
    EXPECT_GT(bytesOfOne, 0U);
    // Each of what they are made regardless of.
    const std::string images = "reference_size: 96";
    const std::vector<std::string> regardless = {
        images,
        images + ", method: conventional",
        images + ", method: depth_peeling",
        "method: ray_traced",
        "method: pcss",
        images + ", redundancy: visibility",
        images + ", reference_images: 2",
        "reference_size: 64",
        images + ", reconstruction: classic",
        images + ", discontinuity: 9",
        images + ", grazing_limit: 1",
        images + ", merge_rows: true",
        images + ", simplify_to: 0.5, simplification_error: 0.01"};
    EXPECT_EQ(expectSharedAsAlone(common, regardless, scene), bytesOfOne);
    // What decides them.
    const std::vector<std::string> deciding = {"",
                                               "light_ratio: 0.3",
                                               "light_height: 2",
                                               "ground: false",
                                               "ground_size: 3",
                                               "shadow_bias: 3"};
    EXPECT_EQ(expectSharedAsAlone(common + "method: geometry, ", deciding, scene), 6 * bytesOfOne);
}

TEST_F(SoftShadowsTest, RefusesScenesThatCastNothingAndLightsInside) {
    const auto message = [&](const std::string& yaml, const scene::Scene* scene) {
        return errorText([&] { recorded(yaml, scene); });
    };
    EXPECT_EQ(message("{}", nullptr), "the technique needs a scene, and the case has none");
    const scene::Scene empty;
    EXPECT_EQ(message("{}", &empty), "technique 'soft_shadows' needs a scene with triangles");
    scene::MeshBuilder point;
    point.addTriangle(glm::vec3(1), glm::vec3(1), glm::vec3(1));
    const scene::Scene pointScene = sceneFrom(point);
    EXPECT_EQ(message("{}", &pointScene),
              "technique 'soft_shadows' needs a scene with some extent; all of its points are one");
    const scene::Scene plate = plateOverFloor();
    EXPECT_EQ(message("{light_height: 0.05}", &plate).substr(0, 29),
              "the scene's box comes within ");
    EXPECT_EQ(message("{light_height: 4, light_elevation_deg: 20, light_ratio: 16}", &plate),
              "the light reaches below the floor: raise light_height or light_elevation_deg, lower "
              "light_ratio, or 'ground: false'");
    if (device.limits().maxTextureSizePx >= 32768) GTEST_SKIP() << "no size is too large here";
    EXPECT_EQ(
        message("{reference_size: 32768}", &plate),
        fmt::format("a 2D texture of 32768 pixels is beyond this device's GL_MAX_TEXTURE_SIZE = {}",
                    device.limits().maxTextureSizePx));
}

TEST_F(SoftShadowsTest, APictureOfNothingIsRefusedAndTheShareOfOneIsRecorded) {
    scene::Scene scene = plateOverFloor();
    const double withGround = run("geometry", "", scene).at("coverage_pct");
    const double without = run("geometry", "ground: false", scene).at("coverage_pct");
    EXPECT_GT(without, 0.0);
    EXPECT_GT(withGround, without);
    EXPECT_LE(withGround, 100.0);
    scene.cameras.push_back(scene.cameras[0]);
    scene.cameras[1].name = "near";
    scene.cameras[1].position = {0.5F, 2.0F, 2.5F};
    EXPECT_GT(run("geometry", "ground: false, view: near", scene).at("coverage_pct"), without);
    EXPECT_THAT(errorText([&] { run("geometry", "view: back", scene); }),
                StartsWith("the scene has no path or camera 'back'"));
    scene.cameras[0].target = {1.0F, 9.0F, 4.0F};  // up and away
    for (const std::string method : {"geometry", "non_redundant", "ray_traced"}) {
        EXPECT_EQ(errorText([&] { run(method, "", scene); }),
                  "the picture shows no surface: from (1, 4, 5) nothing of the scene or its ground "
                  "is in view; change the scene's camera");
    }
}

TEST_F(SoftShadowsTest, ShadowMapsOfTheGeometryAreTheTruth) {
    const Metrics metrics =
        run("geometry", "traced_truth: true, light_views: true", plateOverFloor());
    EXPECT_EQ(metrics.at("visibility_error_mean/geometry"), 0.0);
    EXPECT_EQ(metrics.at("intensity_error_max/geometry"), 0.0);
    EXPECT_EQ(metrics.at("missing_pct/inside"), 0.0);
    // Only samples that pass the plate's edges within a texel or so differ.
    EXPECT_GT(metrics.at("visibility_error_mean/ray_traced"), 0.0);
    EXPECT_LT(metrics.at("visibility_error_mean/ray_traced"), 1.0);
}

TEST_F(SoftShadowsTest, ReferenceImagesThatSeeAllGiveTheTruth) {
    const scene::Scene scene = plateOverFloor();
    for (const char* method : kReconstructing) {
        SCOPED_TRACE(method);
        const Metrics metrics = run(method, "traced_truth: true", scene);
        EXPECT_LT(metrics.at("visibility_error_mean/geometry"), 1.0);
        EXPECT_LT(metrics.at("visibility_error_mean/ray_traced"), 1.5);
        EXPECT_LE(metrics.at("bytes_per_sample"), 64.0);
    }
}

TEST_F(SoftShadowsTest, HiddenCastersAreFoundByNonRedundantImagesOnly) {
    const scene::Scene scene = clutter();
    const Metrics conventional = run("conventional", "", scene);
    for (const char* redundancy : {"redundancy: pixel", "redundancy: visibility"}) {
        const Metrics nonRedundant = run("non_redundant", redundancy, scene);
        for (const char* error :
             {"visibility_error_mean/geometry", "intensity_error_mean/geometry"}) {
            EXPECT_LT(nonRedundant.at(error), 0.8 * conventional.at(error)) << redundancy << error;
        }
    }
}

TEST_F(SoftShadowsTest, IntensityErrorsAreAtMostVisibilityErrors) {
    const scene::Scene scene = clutter();
    for (const char* method : kReconstructing) {
        SCOPED_TRACE(method);
        const Metrics metrics = run(method, "reconstruction: classic", scene);
        for (const char* statistic : {"mean", "max"}) {
            const double visibility =
                metrics.at(fmt::format("visibility_error_{}/geometry", statistic));
            EXPECT_GT(visibility, 0.0);
            EXPECT_LE(metrics.at(fmt::format("intensity_error_{}/geometry", statistic)),
                      visibility);
        }
    }
}

TEST_F(SoftShadowsTest, LightOfNoSizeCastsHardShadows) {
    const scene::Scene scene = clutter();
    for (const char* method : {"non_redundant", "depth_peeling", "ray_traced"}) {
        SCOPED_TRACE(method);
        const Metrics metrics = run(method, "light_ratio: 0", scene);
        // All samples of the light are one: all of a pixel's are wrong in one direction, or none.
        EXPECT_GT(metrics.at("visibility_error_mean/geometry"), 0.0);
        EXPECT_EQ(metrics.at("visibility_error_mean/geometry"),
                  metrics.at("intensity_error_mean/geometry"));
        EXPECT_EQ(metrics.at("visibility_error_max/geometry"), 256.0);
    }
}

TEST_F(SoftShadowsTest, FilteredShadowsAreNearTheTruthOfOnePlate) {
    const scene::Scene scene = plateOverFloor();
    // One plate is what both assume; the mean error stays below 2 % of the light's samples.
    EXPECT_LT(run("pcss", "", scene).at("intensity_error_mean/geometry"), 5.0);
    EXPECT_LT(run("variance", "", scene).at("intensity_error_mean/geometry"), 5.0);
    // A search of no width finds what the shadow map says.
    EXPECT_LT(run("pcss", "light_ratio: 0", scene).at("intensity_error_mean/geometry"), 1.0);
}

TEST_F(SoftShadowsTest, NothingCastsNothing) {
    scene::MeshBuilder builder;
    builder.addQuad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    const scene::Scene scene = sceneFrom(builder);
    for (const char* method :
         {"geometry", "non_redundant", "conventional", "depth_peeling", "ray_traced", "pcss"}) {
        SCOPED_TRACE(method);
        const Metrics metrics = run(method, "ground: false, traced_truth: true", scene);
        EXPECT_EQ(metrics.at("intensity_error_max/geometry"), 0.0);
        EXPECT_EQ(metrics.at("intensity_error_max/ray_traced"), 0.0);
    }
}

TEST_F(SoftShadowsTest, FloorBeyondTheFarPlaneIsLit) {
    // The floor of 12 diagonals reaches far behind what the light's views hold.
    const Metrics metrics =
        run("geometry", "ground_size: 12, traced_truth: true", plateOverFloor());
    EXPECT_LT(metrics.at("visibility_error_mean/ray_traced"), 1.0);
}

TEST_F(SoftShadowsTest, ThinSurfacesShadowTheirFarSides) {
    // The camera looks at the dark side of a sheet that has no other geometry behind it.
    scene::MeshBuilder builder;
    builder.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    scene::Scene scene = sceneFrom(builder);
    scene.materials.push_back({.isDoubleSided = true});
    scene.meshes.front().material = 0;
    const Metrics metrics = run("geometry", "light_azimuth_deg: 180, traced_truth: true", scene);
    EXPECT_LT(metrics.at("visibility_error_mean/ray_traced"), 1.0);
}

TEST_F(SoftShadowsTest, TimesItsThreeStepsOrTheYardstick) {
    const scene::Scene scene = plateOverFloor();
    run("non_redundant", "", scene);
    EXPECT_EQ(passes_, (std::vector<std::string>{"reference_images", "reconstruction",
                                                 "offset_images", "soft_shadow"}));
    const Metrics metrics = run("conventional", "measured: depth_and_pass", scene);
    EXPECT_EQ(passes_, (std::vector<std::string>{"reference_images", "reconstruction",
                                                 "offset_images", "depth_and_pass"}));
    EXPECT_FALSE(metrics.contains("visibility_error_mean/geometry"));
    run("ray_traced", "", scene);
    EXPECT_EQ(passes_, (std::vector<std::string>{"soft_shadow"}));
}

TEST_F(SoftShadowsTest, SameCaseGivesTheSameNumbersAndPictures) {
    const scene::Scene scene = clutter();
    const char* yaml =
        "{reference_size: 96, shadow_map_size: 96, light_grid: 3, light_views: true, pictures: "
        "true}";
    const test::MetricRecorder a = recorded(yaml, &scene);
    const test::MetricRecorder b = recorded(yaml, &scene);
    EXPECT_EQ(a.metrics, b.metrics);
    ASSERT_EQ(a.images.size(), 7U);
    for (const auto& [name, image] : a.images) {
        EXPECT_TRUE(std::ranges::equal(image.values(), b.images.at(name).values())) << name;
    }
}

struct Strip {
    glm::vec2 centre, along;  // on the plane y = 0, (x, z); half its length
    float halfWidth;

    /// (along, across) of a point, each from −1 to 1 on the strip.
    glm::vec2 at(const glm::vec2& point) const {
        const glm::vec2 d = point - centre;
        const float length = glm::length(along);
        return {glm::dot(d, along) / (length * length),
                (d.x * along.y - d.y * along.x) / (length * halfWidth)};
    }
    /// Which of the strip's two triangles holds a point; 0: neither.
    int triangleAt(const glm::vec2& point) const {
        const glm::vec2 place = at(point);
        if (std::max(std::abs(place.x), std::abs(place.y)) >= 1.0F) return 0;
        return place.x > place.y ? 1 : 2;
    }
};

constexpr float kSideM = 4.0F, kSeenM = 3.6F, kSpecksM = 1.0F, kFloorM = -0.3F;

/// Strips of 1 to 4 pixels' width at every angle, one in each cell of a grid.
std::vector<Strip> flatStrips(float pixelM) {
    constexpr int kCells = 14;
    std::vector<Strip> strips;
    Random random(5);
    for (int cell = 0; cell < kCells * kCells; ++cell) {
        const glm::vec2 place = (glm::vec2(cell % kCells, cell / kCells) + 0.5F) / float{kCells};
        const float angle = random.uniform(0.0F, 6.2831853F);
        strips.push_back(
            {0.93F * kSeenM * (place - 0.5F),
             random.uniform(0.075F, 0.11F) * glm::vec2(std::cos(angle), std::sin(angle)),
             pixelM * random.uniform(0.5F, 2.0F)});
    }
    return strips;
}

/// The strips, a floor under them, and far above them four specks, so that the views from the
/// light's corners have the plane in different grids. The camera looks down; its near plane hides
/// the strips, not the floor.
scene::Scene sceneOfStrips(const std::vector<Strip>& strips) {
    scene::MeshBuilder builder;
    const auto add = [&](const Strip& strip, float y) {
        const glm::vec3 centre(strip.centre.x, y, strip.centre.y),
            along(strip.along.x, 0, strip.along.y);
        const glm::vec3 across =
            strip.halfWidth * glm::normalize(glm::vec3(strip.along.y, 0, -strip.along.x));
        builder.addQuad(centre - along - across, centre + along - across, centre + along + across,
                        centre - along + across);
    };
    add({{0, 0}, {0.5F * kSideM, 0}, 0.5F * kSideM}, kFloorM);
    for (const glm::vec2& corner : {glm::vec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}}) {
        add({0.5F * kSideM * corner, {1e-4F, 0}, 1e-4F}, kSpecksM);
    }
    for (const Strip& strip : strips) add(strip, 0.0F);
    scene::Scene scene = scene::sceneOf(builder.take("strips", -1));
    scene::Camera camera;
    camera.position = {0, 3, 0};
    camera.target = {0, 0, 0};
    camera.up = {0, 0, 1};
    camera.verticalFovRad = 2.0F * std::atan(0.5F * kSeenM / (camera.position.y - kFloorM));
    camera.nearM = camera.position.y - 0.5F * kFloorM;
    scene.cameras = {camera};
    return scene;
}

/// Areas that reconstructions shadow too much and too little, m² on the strips' plane, worked out
/// from pixel grids alone: a sample stands for its pixel, wherever the pixel's middle lies on the
/// strip. Conventional images add up; of non-redundant ones a later image adds the samples that
/// land on a pixel of no earlier one (algorithm 3).
glm::dvec2 wrongAreas(const std::vector<Strip>& strips, const std::vector<kit::View>& views,
                      bool isNonRedundant, float pixelM) {
    const float stepM = pixelM / 5.0F, marginM = 1.5F * pixelM;
    const auto middleAt = [](const kit::View& view, const glm::vec2& point) {
        const glm::vec2 pixel = glm::floor(*kit::project(view, {point.x, 0, point.y}));
        const glm::vec3 middle = kit::unproject(view, pixel + 0.5F, view.eyeWorld.y);
        return glm::vec2(middle.x, middle.z);
    };
    glm::dvec2 areas(0.0);
    for (const Strip& strip : strips) {
        const float length = glm::length(strip.along);
        const glm::vec2 along = strip.along / length, across(along.y, -along.x);
        for (float u = -length - marginM; u < length + marginM; u += stepM) {
            for (float v = -strip.halfWidth - marginM; v < strip.halfWidth + marginM; v += stepM) {
                const glm::vec2 point = strip.centre + u * along + v * across;
                bool isCovered = false;
                for (std::size_t i = 0; i < views.size() && !isCovered; ++i) {
                    const glm::vec2 middle = middleAt(views[i], point);
                    const int triangle = strip.triangleAt(middle);
                    isCovered = triangle != 0;
                    for (std::size_t j = 0; j < i && isNonRedundant && isCovered; ++j) {
                        isCovered = strip.triangleAt(middleAt(views[j], middle)) != triangle;
                    }
                }
                const bool isInside = strip.triangleAt(point) != 0;
                areas += double{stepM} * stepM *
                         glm::dvec2(isCovered && !isInside, !isCovered && isInside);
            }
        }
    }
    return areas;
}

/// What an edge darkens beyond itself, by its length and a pixel. An image's own edge lies
/// anywhere within half a pixel of it, so the farthest of n lies outside by
/// 1/2 − (1 − 2^−(n+1)) / (n + 1) in the mean.
double darkOfEdge(int imageCount) {
    return 0.5 - (1.0 - std::pow(2.0, -(imageCount + 1))) / (imageCount + 1);
}

TEST_F(SoftShadowsTest, StripsUnderASmallLightAreAsDarkAndLitAsTheirPixelsSay) {
    constexpr int kReferenceSize = 256;
    outputSizePx_ = {720, 720};
    const glm::vec3 half{0.5F * kSideM, 0.5F * (kSpecksM - kFloorM), 0.5F * kSideM};
    const glm::vec3 middle{0, 0.5F * (kSpecksM + kFloorM), 0};
    const auto lightOf = [&](float ratio) {
        return makeAreaLight({middle - half, middle + half},
                             {.sizeRatio = ratio, .azimuthRad = 0.0F, .elevationRad = 1.5707963F});
    };
    const kit::View centre = lightView(lightOf(0.0F), lightOf(0.0F).centre, kReferenceSize);
    const float lightM = centre.eyeWorld.y;
    const float pixelM = kit::footprintPerDepth(centre) * lightM;
    // The image holds the box's top, two pixels aside: no view is turned against the box.
    EXPECT_NEAR(pixelM, kSideM / (kReferenceSize - 4) * lightM / (lightM - kSpecksM),
                1e-3F * pixelM);
    const std::vector<Strip> strips = flatStrips(pixelM);
    const scene::Scene scene = sceneOfStrips(strips);
    double edgesM = 0.0;
    for (const Strip& strip : strips) {
        edgesM += 4.0 * double{glm::length(strip.along) + strip.halfWidth};
    }
    // Of all that the picture shows, as seen on the strips' plane from the light.
    const double pictureM2 = std::pow(kSeenM * lightM / (lightM - kFloorM), 2.0);
    for (const char* method : kReconstructing) {
        for (const float ratio : {0.05F, 0.08F}) {
            SCOPED_TRACE(fmt::format("{} {}", method, ratio));
            const Metrics metrics =
                recorded(fmt::format("{{method: {}, light_ratio: {}, light_elevation_deg: 90, "
                                     "light_azimuth_deg: 0, light_grid: 1, reference_size: {}, "
                                     "shadow_map_size: 2048, ground: false}}",
                                     method, ratio, kReferenceSize),
                         &scene)
                    .metrics;
            const bool isPeeling = method == std::string("depth_peeling");
            std::vector<kit::View> views;
            const AreaLight light = lightOf(ratio);
            for (int corner = 0; corner < (isPeeling ? 1 : 4); ++corner) {
                views.push_back(lightView(light, isPeeling ? light.centre : light.corner(corner),
                                          kReferenceSize));
            }
            const glm::dvec2 expected =
                wrongAreas(strips, views, method == std::string("non_redundant"), pixelM) /
                pictureM2 * 256.0;
            const double dark = metrics.at("wrongly_dark_mean/geometry");
            if (method != std::string("non_redundant")) {
                const double ofEdge = dark / 256.0 * pictureM2 / (edgesM * double{pixelM});
                EXPECT_NEAR(ofEdge / darkOfEdge(isPeeling ? 1 : 4), 1.0, 0.15);
            }
            const double lit = metrics.at("wrongly_lit_mean/geometry");
            EXPECT_NEAR(dark, expected.x, 0.15 * expected.x);
            // What four images leave lit is hardly there: a hundredth of the other side is as good.
            EXPECT_NEAR(lit, expected.y, std::max(0.15 * expected.y, 0.01 * expected.x));
        }
    }
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
