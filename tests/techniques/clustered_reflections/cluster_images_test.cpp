// Culling, places in the atlas and depth images against the host.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/random.h"
#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/clustered_reflections/visible_triangles.h"
#include "tests/support/grid.h"
#include "tests/techniques/clustered_reflections/tracer_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::clustered_reflections {
namespace {

using reflections::GpuObjects;
using reflections::ReflectiveScene;

constexpr std::uint32_t kNoReflector = 9999;  // of a scene

struct ClusterImagesTest : TracerTest {
    /// A camera that looks along `towards`, its frustum off its centre.
    static ClusterCamera cameraLooking(const glm::vec3& eye, const glm::vec3& towards,
                                       glm::ivec2 sizePx) {
        ClusterCamera camera;
        const glm::mat4 view = glm::lookAt(eye, eye + towards, glm::vec3(0.0F, 1.0F, 0.01F));
        camera.clipFromWorld = glm::frustum(-0.1F, 0.2F, -0.15F, 0.1F, 0.25F, 6.0F) * view;
        camera.eyeWorld = glm::vec4(eye, 0.25F);
        camera.planeNormal = glm::vec4(glm::normalize(towards), 6.0F);
        camera.sizePx = sizePx;
        camera.reflector = kNoReflector;
        return camera;
    }
    static constexpr std::uint32_t kSamples = 50;  // of each cluster
    /// As the painters read them: cameras, counts, and ranges of kSamples.
    struct OnDevice {
        gl::Buffer cameras;
        Clusters clusters;

        explicit OnDevice(std::vector<ClusterCamera> all) {
            const auto count = static_cast<std::uint32_t>(all.size());
            all.resize(kMaxClusters);
            cameras = gl::Buffer::of(all);
            clusters.counts = gl::Buffer::of(std::vector<std::uint32_t>{count, 0, 0});
            clusters.ranges =
                gl::Buffer::of(std::vector<glm::uvec4>(kMaxClusters, {0, kSamples, 0, 0}));
        }
    };
    static void draw(VisiblePainter& painter, const GpuObjects& objects, const OnDevice& clusters,
                     ClusterImages& images) {
        painter.draw(objects, clusters.cameras, clusters.clusters, images);
    }
    static std::vector<float> depthsOf(const ClusterImages& images) {
        return images.depth().read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
    }
    /// Of objects behind the six walls, those that a cluster's image shows.
    static std::vector<std::uint32_t> furnitureSeen(const ReflectiveScene& scene,
                                                    std::uint32_t reflector,
                                                    std::uint32_t flags = 0) {
        ClusterCamera camera = cameraLooking({0.0F, -0.5F, 1.5F}, {0.0F, 0.0F, -1.0F}, {20, 20});
        camera.reflector = reflector;
        camera.flags = flags;
        std::vector<std::uint32_t> seen =
            OneByOnePainter(shaders(), scene).objectsSeen(GpuObjects(scene), camera);
        std::erase_if(seen, [](std::uint32_t object) { return object < 6; });
        return seen;
    }
    using Objects = std::vector<std::uint32_t>;
    /// What texels of images of triangles show.
    struct ShownTexels {
        std::vector<float> depths;
        std::vector<std::uint32_t> triangles;
        AtlasState state;
    };
    static ShownTexels drawVisible(VisiblePainter& painter, const GpuObjects& objects,
                                   const OnDevice& clusters) {
        ClusterImages images(shaders(), glm::ivec2(512), false, TexelContent::Triangles);
        draw(painter, objects, clusters, images);
        return {depthsOf(images),
                images.colour().read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1),
                painter.state()};
    }
    static std::vector<ClusterCamera> randomCameras(Random& random, int count, std::uint32_t most) {
        std::vector<ClusterCamera> cameras;
        for (int i = 0; i < count; ++i) {
            const auto number = [&] { return random.uniform(-1.0F, 1.0F); };
            const glm::vec3 eye{number(), number(), number()};
            const glm::ivec2 sizePx{1 + static_cast<int>(random.index(most)),
                                    1 + static_cast<int>(random.index(most))};
            cameras.push_back(cameraLooking(eye, {number(), number(), number()}, sizePx));
        }
        return cameras;
    }
    static ReflectiveScene furnishedRoom() {
        scene::Scene scene = rooms::room();
        rooms::addFurniture(scene);
        return ReflectiveScene(scene);
    }
};

TEST_F(ClusterImagesTest, NoObjectThatReachesIntoTheFrustumIsCulled) {
    const ReflectiveScene scene = furnishedRoom();
    const GpuObjects objects(scene);
    const OneByOnePainter painter(shaders(), scene);
    Random random(1);
    int culled = 0;
    for (const ClusterCamera& camera : randomCameras(random, 60, 100)) {
        const std::vector<std::uint32_t> seen = painter.objectsSeen(objects, camera);
        culled += static_cast<int>(scene.objects().size() - seen.size());
        for (std::uint32_t i = 0; i < objects.objectCount(); ++i) {
            const reflections::Object& object = scene.objects()[i];
            bool isInside = false;  // points of its triangles, not its box
            for (int point = 0; point < 400 && !isInside; ++point) {
                const std::uint32_t triangle =
                    object.firstTriangle + random.index(object.triangleCount);
                const glm::uvec3 corners = scene.geometry().triangles[triangle];
                glm::vec2 b{random.uniform(), random.uniform()};
                if (b.x + b.y > 1.0F) b = 1.0F - b;
                const auto& positions = scene.geometry().positions;
                const glm::vec3 p = positions[corners.x] * (1.0F - b.x - b.y) +
                                    positions[corners.y] * b.x + positions[corners.z] * b.y;
                const glm::vec4 clip = camera.clipFromWorld * glm::vec4(p, 1.0F);
                isInside = clip.w > 0.0F && std::abs(clip.x) < clip.w &&
                           std::abs(clip.y) < clip.w && std::abs(clip.z) < clip.w;
            }
            if (isInside) {
                EXPECT_NE(std::find(seen.begin(), seen.end(), i), seen.end()) << i;
            }
        }
    }
    EXPECT_GT(culled, 100);
}

TEST_F(ClusterImagesTest, TheOwnReflectorIsSeenByConcaveClustersOnly) {
    scene::Scene room = rooms::room();
    rooms::add(room, rooms::bowl({0.0F, -0.4F, 0.0F}, 0.5F), glm::vec3(1.0F),
               rooms::Surface::Mirror);
    const ReflectiveScene scene(room);
    EXPECT_EQ(furnitureSeen(scene, kNoReflector), Objects{6});
    EXPECT_EQ(furnitureSeen(scene, 1), Objects{});
    EXPECT_EQ(furnitureSeen(scene, 1, kShowsOwn), Objects{6});
}

TEST_F(ClusterImagesTest, WhatLiesBackToBackIsLeftOut) {
    // A hollow ball: the outside, and an inside that faces inwards.
    scene::Mesh hollow = voxelization::shapes::sphere({0.0F, -0.4F, 0.0F}, 0.5F, 4);
    scene::Mesh inside = voxelization::shapes::sphere({0.0F, -0.4F, 0.0F}, 0.45F, 4);
    hollow.normals = scene::vertexNormals(hollow);
    inside.normals = scene::vertexNormals(inside);
    for (glm::vec3& normal : inside.normals) normal = -normal;
    scene::Scene room = rooms::room();
    rooms::add(room, reflections::joined(hollow, inside), glm::vec3(1.0F), rooms::Surface::Mirror);
    const ReflectiveScene scene(room, {.splitsParts = true});
    ASSERT_EQ(scene.reflectorCount(), 2);
    EXPECT_EQ(reflectorFamilies(scene), (std::vector<std::uint32_t>{0, 4 | 1, 4 | 2}));
    EXPECT_EQ(furnitureSeen(scene, kNoReflector), (Objects{6, 7}));
    for (const std::uint32_t reflector : {1U, 2U}) {
        EXPECT_EQ(furnitureSeen(scene, reflector), Objects{});
        EXPECT_EQ(furnitureSeen(scene, reflector, kShowsOwn), Objects{5 + reflector});
    }
}

TEST_F(ClusterImagesTest, PartsOfOneObjectThatDoNotTouchSeeEachOther) {
    scene::Scene room = rooms::room();
    rooms::add(room, rooms::potAndKnob(), glm::vec3(1.0F), rooms::Surface::Mirror);
    const ReflectiveScene split(room, {.splitsParts = true});
    ASSERT_EQ(split.reflectorCount(), 2);
    EXPECT_EQ(furnitureSeen(split, 1), Objects{7});
    EXPECT_EQ(furnitureSeen(split, 2), Objects{6});
    EXPECT_EQ(furnitureSeen(ReflectiveScene(room), 1), Objects{});
}

TEST_F(ClusterImagesTest, PlacesLieInTheAtlasAndApart) {
    const ReflectiveScene scene = furnishedRoom();
    const GpuObjects objects(scene);
    CameraSettings settings;
    VisiblePainter painter(shaders(), scene, objects, settings, 0.0F);
    ClusterImages images(shaders(), glm::ivec2(512), false, TexelContent::Triangles);
    Random random(2);
    const struct {
        int count;
        std::uint32_t mostPx;
        bool fits;
    } cases[] = {{1, 500, true}, {40, 60, true}, {300, 90, false}, {3000, 40, false}, {0, 1, true}};
    for (const auto& one : cases) {
        std::vector<ClusterCamera> cameras = randomCameras(random, one.count, one.mostPx);
        if (one.count > 10) cameras[3].flags = kNoRoom;
        draw(painter, objects, OnDevice(cameras), images);
        const AtlasState state = painter.state();
        EXPECT_EQ(state.scale == 1.0F, one.fits) << one.count;
        const auto places = painter.places().read<glm::ivec4>(cameras.size());
        std::vector<std::uint8_t> taken(512 * 512);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::ivec2 wanted = imageSizePx(cameras[i], settings, kSamples);
            const glm::ivec4& place = places[i];
            ASSERT_TRUE(place.x >= 0 && place.x + place.z <= 512) << i;
            ASSERT_TRUE(place.y >= 0 && place.y + place.w <= 512) << i;
            if (one.fits || wanted.x == 0) {
                EXPECT_EQ(glm::ivec2(place.z, place.w), wanted) << i;
            } else {
                EXPECT_GE(place.z, 1);
                EXPECT_GE(place.w, 1);
            }
            for (int y = place.y; y < place.y + place.w; ++y) {
                for (int x = place.x; x < place.x + place.z; ++x) {
                    std::uint8_t& texel = taken[static_cast<std::size_t>(y * 512 + x)];
                    ASSERT_EQ(texel, 0) << i;
                    texel = 1;
                }
            }
        }
    }
}

TEST_F(ClusterImagesTest, DepthsAreNearOverTheDistanceAlongTheAxis) {
    const ReflectiveScene scene(rooms::room());
    const GpuObjects objects(scene);
    const ClusterCamera camera = cameraLooking({0.1F, 0.2F, 0.3F}, {0.0F, 0.0F, -1.0F}, {40, 30});
    ClusterImages images(shaders(), glm::ivec2(64), false);
    OneByOnePainter painter(shaders(), scene);
    painter.draw(objects, camera, camera.sizePx, images);
    const std::vector<float> depths = depthsOf(images);
    const glm::dmat4 worldFromClip = glm::inverse(glm::dmat4(camera.clipFromWorld));
    for (const auto [y, x] : test::grid(30, 40)) {
        const glm::dvec4 clip((x + 0.5) / 20.0 - 1.0, (y + 0.5) / 15.0 - 1.0, 0.0, 1.0);
        const glm::dvec4 world = worldFromClip * clip;
        const glm::vec3 eye(camera.eyeWorld);
        const glm::vec3 direction = glm::normalize(glm::vec3(world / world.w) - eye);
        const glm::vec3 hit(reflections::wallHit(rooms::kWalls, eye, direction).position);
        const float z = glm::dot(hit - eye, glm::vec3(camera.planeNormal));
        EXPECT_NEAR(depths[static_cast<std::size_t>(y * 64 + x)], 0.25F / z, 1e-4F / z)
            << x << ' ' << y;
    }
}

TEST_F(ClusterImagesTest, WhatLiesBeyondTheFarPlaneIsNotDrawn) {
    const ReflectiveScene scene(rooms::room());
    const GpuObjects objects(scene);
    ClusterCamera camera = cameraLooking({0.1F, 0.2F, 0.3F}, {0.6F, 0.0F, -0.8F}, {40, 30});
    ClusterImages images(shaders(), glm::ivec2(64), false);
    OneByOnePainter painter(shaders(), scene);
    const auto drawnTexels = [&] {
        painter.draw(objects, camera, camera.sizePx, images);
        const std::vector<float> depths = depthsOf(images);
        int drawn = 0;
        for (int pixel = 0; pixel < 40 * 30; ++pixel) {
            const float depth = depths[static_cast<std::size_t>(pixel / 40 * 64 + pixel % 40)];
            drawn += depth > 0.0F ? 1 : 0;
            if (depth > 0.0F) EXPECT_LE(0.25F / depth, camera.planeNormal.w + 1e-3F);
        }
        return drawn;
    };
    EXPECT_EQ(drawnTexels(), 40 * 30);  // the room is closed
    // The edge between the walls +x and −z is 3.0 away along the axis, the walls beside it nearer.
    camera.planeNormal.w = 2.6F;
    const int near = drawnTexels();
    EXPECT_GT(near, 40);
    EXPECT_LT(near, 40 * 30 - 40);
}

TEST_F(ClusterImagesTest, NorInImagesOfTriangles) {
    const ReflectiveScene scene(rooms::room());
    const GpuObjects objects(scene);
    ClusterCamera camera = cameraLooking({0.1F, 0.2F, 0.3F}, {0.6F, 0.0F, -0.8F}, {40, 30});
    camera.planeNormal.w = 2.6F;
    ClusterImages images(shaders(), glm::ivec2(64), false, TexelContent::Triangles);
    VisiblePainter painter(shaders(), scene, objects, {}, 0.0F);
    draw(painter, objects, OnDevice({camera}), images);
    int drawn = 0;
    for (const float depth : depthsOf(images)) {
        if (depth <= 0.0F) continue;
        ++drawn;
        EXPECT_LE(0.25F / depth, camera.planeNormal.w + 1e-3F);
    }
    EXPECT_GT(drawn, 40);
    EXPECT_LT(drawn, 40 * 30 - 40);
}

TEST_F(ClusterImagesTest, TrianglesThatMayBeSeenShowWhatAllTrianglesShow) {
    const ReflectiveScene scene = furnishedRoom();
    const GpuObjects objects(scene);
    Random random(4);
    const std::vector<ClusterCamera> cameras = randomCameras(random, 30, 60);
    const OnDevice clusters(cameras);
    VisiblePainter painter(shaders(), scene, objects, {}, 0.0F);
    const ShownTexels shown = drawVisible(painter, objects, clusters);
    ASSERT_EQ(shown.state.scale, 1.0F);
    EXPECT_EQ(shown.state.leftOut, 0U);
    const auto places = painter.places().read<glm::ivec4>(cameras.size());
    const auto triangles = scene.geometry().triangles.size();

    OneByOnePainter one(shaders(), scene);
    ClusterImages alone(shaders(), glm::ivec2(512), false);
    std::size_t texels = 0, drawn = 0, different = 0, allTriangles = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const glm::ivec4 place = places[i];
        allTriangles += one.draw(objects, cameras[i], {place.z, place.w}, alone);
        const std::vector<float> depths = depthsOf(alone);
        for (const auto [y, x] : test::grid(place.w, place.z)) {
            const float expected = depths[static_cast<std::size_t>(y * 512 + x)];
            const auto at = static_cast<std::size_t>((y + place.y) * 512 + x + place.x);
            ++texels;
            drawn += expected > 0.0F;
            different += std::abs(shown.depths[at] - expected) > 2e-5F;
            if (shown.depths[at] > 0.0F) ASSERT_LT(shown.triangles[at], triangles);
        }
    }
    EXPECT_GT(shown.state.triangles, 0U);
    EXPECT_LT(shown.state.triangles, allTriangles / 3);
    // Corners are rounded at another place: outlines through the middle of a texel.
    EXPECT_GT(texels, 20'000U);
    EXPECT_GT(drawn, texels / 4);
    EXPECT_LT(different, texels / 500);

    // The same again: no order of what runs at once is seen.
    const ShownTexels again = drawVisible(painter, objects, clusters);
    EXPECT_EQ(again.state.triangles, shown.state.triangles);
    for (std::size_t i = 0; i < shown.depths.size(); ++i) {
        ASSERT_EQ(again.depths[i], shown.depths[i]);
        if (shown.depths[i] > 0.0F) ASSERT_EQ(again.triangles[i], shown.triangles[i]);
    }
}

TEST_F(ClusterImagesTest, SimplifiedObjectsAreDrawnOfFewerTrianglesAboutWhereTheyAre) {
    const ReflectiveScene scene = furnishedRoom();
    const GpuObjects objects(scene);
    Random random(5);
    const std::vector<ClusterCamera> cameras = randomCameras(random, 30, 40);
    const OnDevice clusters(cameras);
    VisiblePainter whole(shaders(), scene, objects, {}, 0.0F);
    VisiblePainter simplified(shaders(), scene, objects, {}, 1.0F);
    const ShownTexels expected = drawVisible(whole, objects, clusters);
    const ShownTexels shown = drawVisible(simplified, objects, clusters);
    EXPECT_LT(shown.state.triangles, expected.state.triangles);
    std::size_t texels = 0, different = 0;
    for (std::size_t i = 0; i < expected.depths.size(); ++i) {
        if (expected.depths[i] == 0.0F) continue;
        ++texels;
        different += std::abs(shown.depths[i] / expected.depths[i] - 1.0F) > 0.05F;
    }
    EXPECT_GT(texels, 5'000U);
    EXPECT_LT(different, texels / 25);  // outlines, a texel wide
}

TEST_F(ClusterImagesTest, ImagesHaveNoMoreTexelsThanTheirSamplesAskFor) {
    const ReflectiveScene scene = furnishedRoom();
    const GpuObjects objects(scene);
    Random random(6);
    const std::vector<ClusterCamera> cameras = randomCameras(random, 40, 60);
    const CameraSettings settings{.texelsPerSample = 8.0F};
    VisiblePainter painter(shaders(), scene, objects, settings, 0.0F);
    ClusterImages images(shaders(), glm::ivec2(512), false, TexelContent::Triangles);
    draw(painter, objects, OnDevice(cameras), images);
    const auto places = painter.places().read<glm::ivec4>(cameras.size());
    int smaller = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::ivec2 size(places[i].z, places[i].w);
        const glm::ivec2 whole = cameras[i].sizePx;
        EXPECT_EQ(size, imageSizePx(cameras[i], settings, kSamples));
        // Each side is rounded up.
        EXPECT_LE((size.x - 1) * (size.y - 1), static_cast<int>(8 * kSamples));
        if (whole.x * whole.y <= static_cast<int>(8 * kSamples)) EXPECT_EQ(size, whole);
        smaller += size != whole;
    }
    EXPECT_GT(smaller, 10);
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
