#include "techniques/clustered_reflections/cluster_cameras.h"

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/techniques/clustered_reflections/cluster_fixture.h"
#include "tests/techniques/clustered_reflections/clusters_on_host.h"

namespace gfxrepro::clustered_reflections {
namespace {

const glm::mat4 kIdentity(1.0F);

struct Case {
    CameraSettings settings;
    reflections::HostGBuffer host;
    std::vector<std::vector<glm::ivec2>> samples;
    std::vector<glm::uvec4> ranges;
    std::vector<ClusterCamera> cameras;
};

struct ClusterCamerasTest : ClusterTest {
    Case build(const reflections::ReflectiveScene& scene, const kit::View& view,
               const CameraSettings& settings, const BinSettings& bins = {},
               const std::vector<std::uint8_t>* wanted = nullptr) {
        const reflections::GBuffer gbuffer = render(scene, view);
        ClusterBuilder builder(shaders, scene, Clustering::NormalBins, bins, view.sizePx);
        gl::Texture mask;
        if (wanted != nullptr) mask = reflections::maskTexture(*wanted, view.sizePx);
        builder.build(gbuffer, wanted != nullptr ? &mask : nullptr);
        ClusterCameras cameras(shaders, settings);
        for (int i = 0; i < 2; ++i) cameras.build(gbuffer, builder.clusters());
        Case result{settings, readGBuffer(gbuffer), {}, {}, {}};
        result.samples = samplesOf(builder.clusters());
        result.ranges = builder.clusters().ranges.read<glm::uvec4>(result.samples.size());
        result.cameras = cameras.cameras().read<ClusterCamera>(result.samples.size());
        expectAsOnHost(result);
        return result;
    }

    /// Against double precision. 2e-5 of lengths of some metres: positions and normals are floats;
    /// 1e-3 of f and of image coordinates: ends of rays, up to maxSlope · 10 m away from where they
    /// begin, hang on the last digits of normals.
    static void expectAsOnHost(const Case& c) {
        for (std::size_t i = 0; i < c.samples.size(); ++i) {
            SCOPED_TRACE(i);
            const ClusterCamera device = c.cameras[i];
            const ClusterCamera host =
                cameraOnHost(c.host, c.samples[i], (c.ranges[i].w & 1U) != 0, c.settings);
            EXPECT_EQ(device.reflector, host.reflector);
            EXPECT_EQ(device.flags, host.flags);
            const float scale = 1.0F + glm::length(glm::vec3(host.eyeWorld));
            EXPECT_LT(glm::distance(glm::vec3(device.centreWorld), glm::vec3(host.centreWorld)),
                      2e-5F);
            EXPECT_LT(glm::distance(glm::vec3(device.planeNormal), glm::vec3(host.planeNormal)),
                      2e-5F);
            EXPECT_LT(glm::distance(glm::vec3(device.eyeWorld), glm::vec3(host.eyeWorld)),
                      1e-3F * scale);
            EXPECT_NEAR(device.centreWorld.w, host.centreWorld.w, 1e-3F * host.centreWorld.w);
            EXPECT_NEAR(device.eyeWorld.w, host.eyeWorld.w, 1e-3F * host.eyeWorld.w);
            EXPECT_NEAR(device.planeNormal.w, host.planeNormal.w, 1e-3F * host.planeNormal.w);
            const glm::vec2 allowed = 1.0F + 2e-3F * glm::vec2(host.sizePx);
            EXPECT_TRUE(glm::all(
                glm::lessThanEqual(glm::abs(glm::vec2(device.sizePx - host.sizePx)), allowed)))
                << device.sizePx.x << ' ' << device.sizePx.y << " host " << host.sizePx.x << ' '
                << host.sizePx.y;
            const float middle = 0.5F * (host.planeNormal.w - host.eyeWorld.w);
            for (const glm::ivec2 pixel : {c.samples[i].front(), c.samples[i].back()}) {
                const glm::vec4 p(
                    c.host.positionWorld(pixel) + middle * glm::vec3(host.planeNormal), 1.0F);
                glm::vec4 a = device.clipFromWorld * p, b = host.clipFromWorld * p;
                // Without room the depth range is as thin as rounding.
                if ((host.flags & kNoRoom) != 0) a.z = b.z = 0.0F;
                EXPECT_LT(glm::distance(glm::vec3(a) / a.w, glm::vec3(b) / b.w), 2e-3F);
            }
        }
    }

    /// Every start and end point (where the ray meets the far plane, for those within the greatest
    /// slope) lies in the image; planes have all theirs in it. Returns how many rays were too
    /// steep.
    static int expectRaysInImages(const Case& c) {
        int tooSteep = 0;
        for (std::size_t i = 0; i < c.samples.size(); ++i) {
            const ClusterCamera& camera = c.cameras[i];
            const glm::dvec3 n(camera.planeNormal), eye(camera.eyeWorld);
            const auto expectInside = [&](const glm::dvec3& p, const char* what) {
                const glm::dvec4 clip = glm::dmat4(camera.clipFromWorld) * glm::dvec4(p, 1.0);
                EXPECT_GT(clip.w, 0.0) << what;
                // 1 + 1e-3: the half pixel around the box is less than rounding in large images.
                EXPECT_LE(std::abs(clip.x / clip.w), 1.001) << what << " of cluster " << i;
                EXPECT_LE(std::abs(clip.y / clip.w), 1.001) << what << " of cluster " << i;
            };
            for (const glm::ivec2 pixel : c.samples[i]) {
                const glm::dvec3 start(c.host.positionWorld(pixel));
                const glm::dvec3 direction(c.host.mirrorDirection(pixel));
                expectInside(start, "start");
                const double approach = glm::dot(n, direction);
                const double lateral = glm::length(direction - approach * n);
                const bool isPlanar = (camera.flags & kPlanarCluster) != 0;
                if (!isPlanar && approach * double{c.settings.maxSlope} < lateral) {
                    ++tooSteep;
                    continue;
                }
                const double way =
                    (double{camera.planeNormal.w} - glm::dot(start - eye, n)) / approach;
                expectInside(start + std::max(way, 0.0) * direction, "end");
            }
        }
        return tooSteep;
    }
};

/// Of a sample in the image of the only cluster.
glm::vec2 imagePx(const Case& c, glm::ivec2 pixel) {
    const ClusterCamera& camera = c.cameras[0];
    const glm::vec4 clip = camera.clipFromWorld * glm::vec4(c.host.positionWorld(pixel), 1.0F);
    return (0.5F + 0.5F * glm::vec2(clip) / clip.w) * glm::vec2(camera.sizePx);
}

/// Mirrored in the plane through `point`.
glm::dvec3 mirrored(const glm::dvec3& eye, const glm::dvec3& point, const glm::dvec3& normal) {
    return eye - 2.0 * glm::dot(eye - point, normal) * normal;
}

TEST_F(ClusterCamerasTest, PlanarMirrorHasTheMirroredEye) {
    const glm::vec3 eye(0.7F, 0.4F, 3.0F);
    for (const float turn : {0.0F, 0.5F, 1.2F}) {
        const glm::mat4 pose = glm::rotate(kIdentity, turn, {0.3F, 1.0F, 0.1F});
        const Case c = build(MirrorScene().add(squareMesh(), pose).get(),
                             viewFrom(eye, {0, 0, 0}, {256, 192}), {.diagonalM = 10.0F});
        ASSERT_EQ(c.cameras.size(), 1U);
        const ClusterCamera& camera = c.cameras[0];
        glm::dvec3 normal = glm::normalize(glm::dvec3(pose * glm::vec4(0, 0, 1, 0)));
        const glm::dvec3 expected = mirrored(glm::dvec3(eye), glm::dvec3(0.0), normal);
        EXPECT_LT(glm::distance(glm::dvec3(camera.eyeWorld), expected), 1e-5);
        EXPECT_EQ(camera.centreWorld.w, 1.0F);
        EXPECT_EQ(camera.flags, kPlanarCluster);
        EXPECT_EQ(camera.reflector, 1U);
        EXPECT_NEAR(camera.planeNormal.w - camera.eyeWorld.w, 10.0, 1e-5);
        EXPECT_EQ(expectRaysInImages(c), 0);
        // The image just holds the mirror: samples reach to half a texel from all four borders.
        glm::vec2 least(1e9F), most(-1e9F);
        for (const glm::ivec2 pixel : c.samples[0]) {
            least = glm::min(least, imagePx(c, pixel));
            most = glm::max(most, imagePx(c, pixel));
        }
        const glm::vec2 size(camera.sizePx);
        EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(least - 0.5F), glm::vec2(0.05F))));
        EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(size - most - 0.5F), glm::vec2(0.05F))));
    }
}

TEST_F(ClusterCamerasTest, FacingMirrorIsSampledAsTheScreenIs) {
    const Case c = build(MirrorScene().add(squareMesh()).get(),
                         viewFrom({0, 0, 4}, {0, 0, 0}, {320, 240}), {.diagonalM = 5.0F});
    ASSERT_EQ(c.cameras.size(), 1U);
    const glm::ivec2 first = c.samples[0].front(), last = c.samples[0].back();
    EXPECT_EQ(c.cameras[0].sizePx, last - first + 1);
    // Texel by texel, left and right exchanged, as a mirror shows it.
    for (const glm::ivec2 pixel : c.samples[0]) {
        const glm::vec2 px = imagePx(c, pixel);
        EXPECT_NEAR(px.x, static_cast<float>(last.x - pixel.x) + 0.5F, 0.02F);
        EXPECT_NEAR(px.y, static_cast<float>(pixel.y - first.y) + 0.5F, 0.02F);
    }
}

TEST_F(ClusterCamerasTest, ConvexClustersMoveTheEyeTowardsThem) {
    const glm::vec3 eye(1.0F, 0.8F, 3.5F);
    const Case c = build(MirrorScene().add(ball()).get(), viewFrom(eye, {0, 0, 0}, {300, 300}),
                         {.diagonalM = 10.0F});
    int within = 0;
    for (const ClusterCamera& camera : c.cameras) {
        const glm::dvec3 centre(camera.centreWorld);
        const glm::dvec3 e0 = mirrored(glm::dvec3(eye), centre, glm::dvec3(camera.planeNormal));
        EXPECT_GT(camera.centreWorld.w, 0.0F);
        if ((camera.flags & kRaysTurned) == 0) {
            EXPECT_LT(camera.centreWorld.w, 1.0F);
            ++within;
        }
        EXPECT_LE(camera.centreWorld.w, 1.0F);
        const glm::dvec3 expected = centre + (e0 - centre) * double{camera.centreWorld.w};
        EXPECT_LT(glm::distance(glm::dvec3(camera.eyeWorld), expected), 1e-5);
    }
    EXPECT_GT(within, 5);
    EXPECT_GT(c.cameras.size(), 25U);
    EXPECT_GT(expectRaysInImages(c), 0);  // at the silhouette they are
}

TEST_F(ClusterCamerasTest, OneClusterOfAWholeBallHasACameraBehindAllSamples) {
    const reflections::ReflectiveScene scene = MirrorScene().add(ball()).get();
    for (const float distance : {1.2F, 4.0F}) {
        const Case c = build(scene, viewFrom({0, 0, distance}, {0, 0, 0}, {128, 128}, 1.2F),
                             {.diagonalM = 10.0F}, kOneBin);
        ASSERT_EQ(c.cameras.size(), 1U);
        const ClusterCamera& camera = c.cameras[0];
        EXPECT_GT(camera.eyeWorld.w, 0.0F);
        float nearest = 1e9F;
        for (const glm::ivec2 pixel : c.samples[0]) {
            const glm::vec3 fromEye = c.host.positionWorld(pixel) - glm::vec3(camera.eyeWorld);
            nearest = std::min(nearest, glm::dot(fromEye, glm::vec3(camera.planeNormal)));
        }
        EXPECT_GT(nearest, 0.0F);
        EXPECT_GT(camera.eyeWorld.w, nearest);
        expectRaysInImages(c);
    }
}

TEST_F(ClusterCamerasTest, ConcaveClustersMoveTheEyeAway) {
    // A bowl of radius 4, seen from near its surface: rays part from each other less than a
    // plane's.
    const glm::mat4 pose = glm::scale(kIdentity, glm::vec3(-4.0F));
    const Case c =
        build(MirrorScene().add(cap(0.5F), pose).get(),
              viewFrom({0, 0, -2.8F}, {0, 0, -4}, {200, 200}), {.diagonalM = 1.0F}, kOneBin);
    ASSERT_EQ(c.cameras.size(), 1U);
    EXPECT_GT(c.cameras[0].centreWorld.w, 1.2F);
    EXPECT_LE(c.cameras[0].centreWorld.w, 16.0F);
    EXPECT_LT(c.cameras[0].eyeWorld.z, -4.0F - 1.2F);
    EXPECT_EQ(expectRaysInImages(c), 0);
}

TEST_F(ClusterCamerasTest, EyeInsideABallSeesItsInside) {
    for (const BinSettings& bins : {BinSettings{}, kOneBin}) {
        const Case c = build(MirrorScene().add(ball()).get(),
                             viewFrom({0.3F, 0.1F, 0.2F}, {0, 0, -1}, {128, 96}, 2.4F),
                             {.diagonalM = 3.0F}, bins);
        ASSERT_FALSE(c.cameras.empty());
        for (const ClusterCamera& camera : c.cameras) EXPECT_GT(camera.eyeWorld.w, 0.0F);
        expectRaysInImages(c);
    }
}

/// A wall at ±(1, 0, −1) · side whose front, hardly turned to the origin, faces away from it.
void addWall(scene::Mesh& mesh, float side) {
    const glm::vec3 centre(-side, 0.0F, -1.0F), normal = glm::normalize(glm::vec3(side, 0, -0.8F));
    const glm::vec3 across = 0.3F * glm::cross({0, 1, 0}, normal), up(0, 0.3F, 0);
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (const glm::vec3& corner : {-across - up, across - up, across + up, up - across}) {
        mesh.positions.push_back(centre + corner);
        mesh.normals.push_back(normal);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

TEST_F(ClusterCamerasTest, EyeBehindTheFittingPlaneIsFlagged) {
    // Each wall faces the eye a little, but their mean normal points away from it.
    scene::Mesh walls;
    addWall(walls, 1.0F);
    addWall(walls, -1.0F);
    const Case c =
        build(MirrorScene().add(walls).get(), viewFrom({0, 0, 0}, {0, 0, -1}, {128, 64}, 1.6F),
              {.diagonalM = 3.0F}, kOneBin);
    ASSERT_EQ(c.cameras.size(), 1U);
    EXPECT_LT(c.cameras[0].planeNormal.z, -0.99F);
    EXPECT_NE(c.cameras[0].flags & kEyeBehind, 0U);
    EXPECT_GT(c.cameras[0].eyeWorld.w, 0.0F);
    expectRaysInImages(c);
}

TEST_F(ClusterCamerasTest, EdgeOnMirrorKeepsAThinImage) {
    // The least height is 1 mm.
    for (const float height : {5e-3F, 5e-4F}) {
        const glm::mat4 pose = glm::rotate(kIdentity, -1.5707964F, {1, 0, 0});
        const Case c = build(MirrorScene().add(squareMesh(), pose).get(),
                             viewFrom({0, height, 1.5F}, {0, 0, 0}, {16, 256}, 3.0F * height),
                             {.diagonalM = 10.0F});
        ASSERT_EQ(c.cameras.size(), 1U);
        const std::uint32_t behind = height < 1e-3F ? kEyeBehind : 0U;
        EXPECT_EQ(c.cameras[0].flags, kPlanarCluster | behind);
        EXPECT_NEAR(c.cameras[0].eyeWorld.w, std::max(height, 1e-3F), 1e-5F);
        if (behind == 0) {
            EXPECT_EQ(expectRaysInImages(c), 0);
        }
    }
}

TEST_F(ClusterCamerasTest, ClustersOfOneSampleHaveAnImageOfOneTexelAtLeast) {
    std::vector<std::uint8_t> wanted(64 * 64, 0);
    wanted[32 * 64 + 30] = 1;
    const Case c = build(MirrorScene().add(ball()).get(), viewFrom({0, 0, 4}, {0, 0, 0}, {64, 64}),
                         {.diagonalM = 10.0F}, {}, &wanted);
    ASSERT_EQ(c.cameras.size(), 1U);
    EXPECT_EQ(c.cameras[0].centreWorld.w, 1.0F);
    EXPECT_EQ(c.cameras[0].sizePx, glm::ivec2(1));
    EXPECT_EQ(expectRaysInImages(c), 0);
}

TEST_F(ClusterCamerasTest, LobesWidenTheImageAndPullTheFarPlaneIn) {
    reflections::ReflectiveScene scene = MirrorScene().add(squareMesh()).get();
    const kit::View view = viewFrom({0, 0, 4}, {0, 0, 0}, {160, 120});
    const CameraSettings settings{.diagonalM = 10.0F};
    const Case mirror = build(scene, view, settings);
    for (const float glossiness : {0.2F, 0.6F}) {
        scene.setGlossiness(glossiness);
        const Case c = build(scene, view, settings);
        ASSERT_EQ(c.cameras.size(), 1U);
        const ClusterCamera& camera = c.cameras[0];
        EXPECT_EQ(camera.centreWorld.w, 1.0F);
        const float way = farPlaneM(settings.lobe, glossiness, 10.0F);
        EXPECT_NEAR(camera.planeNormal.w - camera.eyeWorld.w, way, 1e-4F);
        EXPECT_GT(camera.sizePx.x, mirror.cameras[0].sizePx.x);
        // All rays of all lobes end in the image, and it is not much wider than they need.
        glm::dvec2 reach(0.0);
        for (const glm::ivec2 pixel : c.samples[0]) {
            const glm::vec3 p = c.host.positionWorld(pixel), axis = c.host.mirrorDirection(pixel);
            for (int i = 0; i < 49; ++i) {
                const glm::dvec3 d(lobeDirection(settings.lobe, axis, glossiness, i, 49));
                const glm::dvec3 end = glm::dvec3(p) + d * (double{way} / d.z);
                const glm::dvec4 clip = glm::dmat4(camera.clipFromWorld) * glm::dvec4(end, 1.0);
                reach = glm::max(reach, glm::abs(glm::dvec2(clip) / clip.w));
            }
        }
        EXPECT_LE(reach.x, 1.0);
        EXPECT_LE(reach.y, 1.0);
        EXPECT_GT(reach.x, 0.9);
        EXPECT_GT(reach.y, 0.9);
    }
    scene.setGlossiness(0.9F);
    const Case rough = build(scene, view, settings);
    EXPECT_EQ(rough.cameras[0].flags, kPlanarCluster | kNoRoom);
}

TEST_F(ClusterCamerasTest, NoClustersNeedNoCameras) {
    const Case c = build(MirrorScene().add(ball(), kIdentity, false).get(),
                         viewFrom({0, 0, 4}, {0, 0, 0}, {64, 64}), {.diagonalM = 10.0F});
    EXPECT_TRUE(c.cameras.empty());
}

TEST_F(ClusterCamerasTest, TwoRunsGiveTheSameBits) {
    const reflections::ReflectiveScene scene = MirrorScene().add(ball()).get();
    const kit::View view = viewFrom({1, 0.8F, 3.5F}, {0, 0, 0}, {200, 200});
    const Case a = build(scene, view, {.diagonalM = 10.0F});
    const Case b = build(scene, view, {.diagonalM = 10.0F});
    ASSERT_EQ(a.cameras.size(), b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        EXPECT_EQ(std::memcmp(&a.cameras[i], &b.cameras[i], sizeof(ClusterCamera)), 0);
    }
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
