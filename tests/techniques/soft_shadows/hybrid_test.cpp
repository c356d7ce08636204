// [xie2017] Algorithm 4 on the device against the CPU and against known surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "tests/support/support.h"
#include "tests/techniques/soft_shadows/reconstruction_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

using kit::DepthFormat;
using kit::DepthImage;
using kit::HostDepthImage;
using kit::View;
namespace shapes = voxelization::shapes;

using HybridTest = ReconstructionTest;

constexpr ReconstructionSettings kHybridSettings;

/// The device's mesh is the reference's: quads in order, corners at their places and depths, and
/// two corners are one vertex exactly when both are the same sample of H.
void expectEqual(const HostMesh& measured, const std::vector<reference::Quad>& quads,
                 const View& view) {
    ASSERT_EQ(measured.mesh.sampleCount, quads.size());
    ASSERT_EQ(measured.triangles.size(), 2 * quads.size());
    std::map<std::pair<int, int>, unsigned> vertexOfH;
    std::set<unsigned> used;
    for (std::size_t i = 0; i < quads.size(); ++i) {
        const glm::uvec3 lower = measured.triangles[2 * i];
        const glm::uvec3 upper = measured.triangles[2 * i + 1];
        ASSERT_EQ(upper.x, lower.z);
        ASSERT_EQ(upper.z, lower.x);
        const std::array<unsigned, 4> vertices{lower.x, lower.y, lower.z, upper.y};
        for (std::size_t k = 0; k < 4; ++k) {
            const reference::Corner& corner = quads[i].corners[k];
            ASSERT_LT(vertices[k], measured.vertices.size());
            const CornerVertex& v = measured.vertices[vertices[k]];
            ASSERT_EQ(glm::ivec2(v.xHalfPx, v.yHalfPx), 2 * corner.positionPx);
            if (corner.isShared) {
                ASSERT_EQ(v.depthM, static_cast<float>(corner.depthM));
                const std::pair key(corner.positionPx.x, corner.positionPx.y);
                ASSERT_EQ(vertexOfH.emplace(key, vertices[k]).first->second, vertices[k]);
                used.insert(vertices[k]);
            } else {
                // The shader's floats: where the ray grazes the plane the quotient loses digits,
                // but no more than this share of a pixel.
                ASSERT_NEAR(v.depthM, corner.depthM,
                            0.02 * reference::footprintM(view, corner.depthM))
                    << quads[i].pixel.x << " " << quads[i].pixel.y << " corner " << k;
                ASSERT_TRUE(used.insert(vertices[k]).second) << "a private corner is shared";
            }
        }
    }
    EXPECT_EQ(used.size(), measured.vertices.size());
    EXPECT_LE(measured.mesh.sizeBytes(), 64 * quads.size());
}

struct NamedMesh {
    const char* name;
    scene::Mesh mesh;
};

std::vector<NamedMesh> meshes() {
    return {{"sphere", shapes::sphere(glm::vec3(0.1F, 0.2F, 0.3F), 1.0F, 6)},
            {"coarse sphere", shapes::sphere(glm::vec3(0.0F), 1.0F, 1)},
            {"torus", shapes::torus(glm::vec3(0.0F), 0.7F, 0.3F, 200, 100)},
            {"cube", shapes::cube(glm::vec3(0.0F), glm::vec3(1.0F, 0.7F, 0.4F))},
            {"random triangles", shapes::randomTriangles(400, 11)}};
}

TEST_F(HybridTest, IsTheReferencesMesh) {
    for (const NamedMesh& shape : meshes()) {
        const scene::Camera camera = scene::framingCamera(shape.mesh.bounds(), 1.2F);
        const std::vector<glm::vec3> normals = reference::normalsOf(shape.mesh);
        for (const glm::ivec2 size : {glm::ivec2(96, 80), glm::ivec2(33, 65)}) {
            SCOPED_TRACE(fmt::format("{} {}", shape.name, size.x));
            const ImagePair images = traceImages(shape.mesh, camera, size);
            const auto quads =
                reference::hybridQuads(images.image, images.offset, normals, kHybridSettings);
            EXPECT_GT(quads.size(), 200U);
            const HostMesh measured = reconstruct(images, normals, kHybridSettings);
            expectEqual(measured, quads, images.image.view);
            expectFacesEye(measured);
        }
    }
}

// H of a non-redundant image is non-redundant, too: it lacks samples and shows other surfaces.
TEST_F(HybridTest, IsTheReferencesMeshForNonRedundantImages) {
    const scene::Mesh mesh =
        shapes::joined(shapes::randomTriangles(300, 5), shapes::sphere(glm::vec3(0.5F), 0.4F, 4));
    const scene::Scene scene = scene::sceneOf(mesh);
    const kit::DrawableScene drawable(scene);
    kit::DepthImageRenderer renderer(shaders(), kit::TriangleIds::PrimitiveId,
                                     DepthFormat::Float32);
    scene::Camera camera = scene::framingCamera(mesh.bounds(), 1.0F);
    DepthImage first = renderer.makeImage(viewOf(camera, {120, 120}));
    renderer.render(drawable, first);
    camera.position += glm::vec3(0.5F, 0.1F, -0.2F);
    DepthImage second = renderer.makeImage(viewOf(camera, {120, 120}));
    DepthImage offset = renderer.makeImage(viewOf(camera, {120, 120}, glm::vec2(-0.5F)));
    const DepthImage* earlier[] = {&first};
    renderer.render(drawable, second, earlier);
    renderer.render(drawable, offset, earlier);

    const std::vector<glm::vec3> normals = reference::normalsOf(mesh);
    const ImagePair images{readDepthImage(second), readDepthImage(offset)};
    const auto quads =
        reference::hybridQuads(images.image, images.offset, normals, kHybridSettings);
    EXPECT_GT(quads.size(), 200U);
    const gl::Buffer normalBuffer = triangleNormals(mesh, device().limits());
    const HostMesh measured = readBack(
        Reconstructor(shaders(), kHybridSettings).reconstruct(second, &offset, normalBuffer));
    expectEqual(measured, quads, images.image.view);
    std::size_t fitted = 0;
    for (const reference::Quad& quad : quads) {
        fitted += static_cast<std::size_t>(
            std::ranges::count(quad.corners, false, &reference::Corner::isShared));
    }
    EXPECT_GT(fitted, quads.size());
}

TEST_F(HybridTest, SmoothSurfacesAreWatertightUpToTheSilhouette) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 6);
    const scene::Camera camera = scene::framingCamera(mesh.bounds(), 1.0F);
    const ImagePair images = traceImages(mesh, camera, {100, 100});
    const HostMesh measured = reconstruct(images, reference::normalsOf(mesh), kHybridSettings);

    // A sphere has no discontinuity within its outline: corners are missing where H misses it.
    std::map<std::pair<int, int>, int> quadsAtCorner;
    std::set<std::pair<unsigned, unsigned>> edges;
    for (const glm::uvec3& t : measured.triangles) {
        for (int i = 0; i < 3; ++i) {
            // Two triangles along one edge run along it in opposite directions.
            EXPECT_TRUE(edges.emplace(t[i], t[(i + 1) % 3]).second);
        }
    }
    std::size_t missing = 0;
    std::set<std::pair<int, int>> shared;
    const glm::ivec2 size = images.image.view.sizePx;
    const auto isSample = [&](int x, int y) {
        return images.image.triangleId[images.image.indexOf({x, y})] != 0;
    };
    const auto isCorner = [&](int x, int y) {
        return images.offset.triangleId[images.offset.indexOf({x, y})] != 0;
    };
    std::size_t innerEdges = 0;
    for (int y = 1; y < size.y - 1; ++y) {
        for (int x = 1; x < size.x - 1; ++x) {
            if (!isSample(x, y)) continue;
            for (const glm::ivec2 c : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                missing += isCorner(x + c.x, y + c.y) ? 0 : 1;
                if (isCorner(x + c.x, y + c.y)) shared.emplace(x + c.x, y + c.y);
            }
            innerEdges += isSample(x + 1, y) && isCorner(x + 1, y) && isCorner(x + 1, y + 1);
            innerEdges += isSample(x, y + 1) && isCorner(x, y + 1) && isCorner(x + 1, y + 1);
        }
    }
    EXPECT_EQ(measured.vertices.size(), shared.size() + missing);
    std::size_t pairedEdges = 0;
    for (const auto& [a, b] : edges) pairedEdges += a < b && edges.contains({b, a});
    // Each quad's diagonal is an edge of two triangles as well.
    EXPECT_EQ(pairedEdges, innerEdges + measured.mesh.sampleCount);

    const reference::Shape shape = reference::shapeOf(measured.triangles, measured.vertices.size());
    EXPECT_EQ(shape.euler, shape.parts);  // discs: no holes inside
    EXPECT_LT(shape.parts, 10);
}

TEST_F(HybridTest, CornersLieOnTheSurface) {
    const glm::vec3 centre(0.1F, 0.2F, 0.3F);
    const scene::Mesh mesh = shapes::sphere(centre, 1.0F, 6);
    const ImagePair images =
        traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.0F), {100, 100});
    const HostMesh measured = reconstruct(images, reference::normalsOf(mesh), kHybridSettings);
    const scene::Mesh world = toWorldMesh(measured.mesh);
    // Of a pixel at the far side, which is farther than every sample.
    const double footprint = reference::footprintM(
        images.image.view, glm::distance(images.image.view.eyeWorld, centre) + 1.0F);
    const double limit = kHybridSettings.grazingLimitPx;
    std::size_t exact = 0;
    for (const glm::vec3& p : world.positions) {
        const double error = std::abs(glm::length(p - centre) - 1.0F);
        // The polyhedron's faces lie up to 0.0004 inside of the sphere.
        if (error < 0.0005) ++exact;
        // Fitted corners lie within half a pixel's diagonal of a plane that touches the sphere
        // (on it, unless it grazes), at most this far from where it does: in depth the limit, to
        // the side a pixel. The sphere has left the plane there by (limit² + 1²) / (2 · radius).
        const double sagitta = 0.5 * (limit * limit + 1.0) * footprint * footprint;
        EXPECT_LT(error, 0.71 * footprint + sagitta + 0.0005);
    }
    EXPECT_GE(static_cast<std::ptrdiff_t>(exact),
              std::ranges::count_if(measured.vertices, [&](const CornerVertex& v) {
                  const glm::ivec2 place(v.xHalfPx / 2, v.yHalfPx / 2);
                  return place.x < 100 && place.y < 100 &&
                         v.depthM == images.offset.depthM[images.offset.indexOf(place)];
              }));
}

TEST_F(HybridTest, PlanesThatSlantAwayAreBounded) {
    // A floor seen from just above it: the sample's plane ends in a horizon within its pixel.
    const View view = viewOf(originCamera(), {4, 4});
    ImagePair images = emptyPair({4, 4});
    const std::size_t at = images.image.indexOf({1, 1});
    images.image.depthM[at] = 10.0F;
    images.image.triangleId[at] = 1;
    const float down = -0.25F;  // slope of the ray through the pixel's middle
    for (const float tilt : {0.02F, 0.2F}) {
        const glm::vec3 normal = glm::normalize(glm::vec3(0.0F, 1.0F, down + tilt));
        const std::vector<glm::vec3> normals{normal};
        const HostMesh measured = reconstruct(images, normals, kHybridSettings);
        expectEqual(measured,
                    reference::hybridQuads(images.image, images.offset, normals, kHybridSettings),
                    view);
        const float footprint = 10.0F * 2.0F / 4.0F;
        ASSERT_EQ(measured.vertices.size(), 4U);
        float lowest = 1e9F, highest = 0.0F;
        for (const CornerVertex& v : measured.vertices) {
            lowest = std::min(lowest, v.depthM);
            highest = std::max(highest, v.depthM);
            EXPECT_LE(std::abs(v.depthM - 10.0F),
                      1.0001F * kHybridSettings.grazingLimitPx * footprint);
        }
        EXPECT_GT(lowest, 0.0F);
        EXPECT_FLOAT_EQ(highest, 10.0F + kHybridSettings.grazingLimitPx * footprint);
    }
}

TEST_F(HybridTest, OneTriangleHasNoDiscontinuityInItself) {
    // A corner far off the sample's plane: valid by the id alone.
    ImagePair images = emptyPair({2, 2});
    images.image.depthM[3] = 10.0F;
    images.image.triangleId[3] = 1;
    images.offset.depthM[3] = 90.0F;
    images.offset.triangleId[3] = 1;
    const std::vector<glm::vec3> normals(2, glm::vec3(0.0F, 0.0F, 1.0F));
    const auto sharedCorners = [&] {
        return std::ranges::count(reconstruct(images, normals, kHybridSettings).vertices, 90.0F,
                                  &CornerVertex::depthM);
    };
    EXPECT_EQ(sharedCorners(), 1);
    images.offset.triangleId[3] = 2;
    EXPECT_EQ(sharedCorners(), 0);
}

TEST_F(HybridTest, TheThresholdCountsInFootprints) {
    const std::vector<glm::vec3> normals(2, glm::vec3(0.0F, 0.0F, 1.0F));
    const float footprint = 10.0F * 2.0F / 2.0F;
    for (const float limitPx : {0.5F, 4.0F}) {
        for (const float factor : {0.99F, 1.01F}) {
            ImagePair images = emptyPair({2, 2});
            images.image.depthM[3] = 10.0F;
            images.image.triangleId[3] = 1;
            images.offset.depthM[3] = 10.0F + factor * limitPx * footprint;
            images.offset.triangleId[3] = 2;
            const ReconstructionSettings settings{.discontinuityPx = limitPx};
            EXPECT_EQ(std::ranges::count(reconstruct(images, normals, settings).vertices,
                                         images.offset.depthM[3], &CornerVertex::depthM),
                      factor < 1.0F ? 1 : 0);
        }
    }
}

/// The quads of a merged mesh, as the pixels between their corners.
std::map<std::pair<int, int>, std::size_t> pixelsOfQuads(const HostMesh& merged) {
    std::map<std::pair<int, int>, std::size_t> quadOf;
    for (std::size_t i = 0; i < merged.triangles.size(); i += 2) {
        const CornerVertex& low = merged.vertices[merged.triangles[i].x];
        const CornerVertex& high = merged.vertices[merged.triangles[i].z];
        EXPECT_EQ(high.yHalfPx, low.yHalfPx + 2) << "one row";
        for (int x = low.xHalfPx / 2; x < high.xHalfPx / 2; ++x) {
            EXPECT_TRUE(quadOf.emplace(std::pair(x, low.yHalfPx / 2), i / 2).second);
        }
    }
    return quadOf;
}

// The same surface from fewer quads: each sample in one, and only samples of one triangle in it.
TEST_F(HybridTest, MergedRowsCoverTheSameSamplesInTheSamePlanes) {
    const ReconstructionSettings merging{.mergesRows = true};
    for (const auto& [name, mesh] : meshes()) {
        SCOPED_TRACE(name);
        const scene::Camera camera = scene::framingCamera(mesh.bounds(), 1.2F);
        const ImagePair images = traceImages(mesh, camera, {160, 120});
        const std::vector<glm::vec3> normals = reference::normalsOf(mesh);
        const HostMesh whole = reconstruct(images, normals, kHybridSettings);
        const HostMesh merged = reconstruct(images, normals, merging);
        expectFacesEye(merged);
        EXPECT_EQ(merged.vertices.size(), whole.vertices.size());
        const auto quadOf = pixelsOfQuads(merged);
        EXPECT_EQ(quadOf.size(), whole.mesh.sampleCount);
        std::map<std::size_t, std::set<std::uint32_t>> trianglesOfQuad;
        for (const auto& [pixel, quad] : quadOf) {
            const auto at = images.image.indexOf({pixel.first, pixel.second});
            trianglesOfQuad[quad].insert(images.image.triangleId[at]);
        }
        for (const auto& [quad, ids] : trianglesOfQuad) EXPECT_EQ(ids.size(), 1U);
        EXPECT_LE(merged.triangles.size(), whole.triangles.size());
    }
}

TEST_F(HybridTest, AWallOfOneTriangleIsAQuadARow) {
    ImagePair images = emptyPair({40, 30});
    for (kit::HostDepthImage* image : {&images.image, &images.offset}) {
        std::ranges::fill(image->depthM, 10.0F);
        std::ranges::fill(image->triangleId, 1U);
    }
    const std::vector<glm::vec3> normals{glm::vec3(0.0F, 0.0F, 1.0F)};
    const ReconstructionSettings merging{.mergesRows = true};
    const HostMesh merged = reconstruct(images, normals, merging);
    EXPECT_EQ(merged.mesh.sampleCount, 1200U);
    // H ends before the last column's and the last row's outer corners: those keep their quads.
    EXPECT_EQ(merged.mesh.triangleCount, 2 * (29 * 2 + 40));
}

TEST_F(HybridTest, AnImageWithoutSamplesIsAnEmptyMesh) {
    const ImagePair images = emptyPair({40, 30});
    const HostMesh measured = reconstruct(images, std::vector<glm::vec3>(1), kHybridSettings);
    EXPECT_EQ(measured.mesh.vertexCount, 0U);
    EXPECT_EQ(measured.mesh.triangleCount, 0U);
    EXPECT_EQ(measured.mesh.sampleCount, 0U);
    EXPECT_EQ(measured.mesh.sizeBytes(), 0U);
    EXPECT_TRUE(toWorldMesh(measured.mesh).triangles.empty());
}

TEST_F(HybridTest, OnePixelIsOneQuad) {
    ImagePair images = emptyPair({1, 1});
    images.image.depthM[0] = 2.0F;
    images.image.triangleId[0] = 1;
    images.offset.depthM[0] = 2.5F;
    images.offset.triangleId[0] = 1;
    const std::vector<glm::vec3> normals{glm::vec3(0.0F, 0.0F, 1.0F)};
    const HostMesh measured = reconstruct(images, normals, kHybridSettings);
    const scene::Mesh world = toWorldMesh(measured.mesh);
    ASSERT_EQ(world.positions.size(), 4U);
    const glm::vec3 expected[] = {{-2.5F, -2.5F, -2.5F}, {2, -2, -2}, {-2, 2, -2}, {2, 2, -2}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_LT(glm::distance(world.positions[i], expected[i]), 1e-5F) << i;
    }
}

TEST_F(HybridTest, IsolatedSamplesHaveQuadsOfTheirOwn) {
    ImagePair images = emptyPair({50, 34});
    std::uint32_t samples = 0;
    for (int y = 0; y < 34; ++y) {
        for (int x = y % 2; x < 50; x += 2, ++samples) {
            images.image.depthM[images.image.indexOf({x, y})] = 3.0F;
            images.image.triangleId[images.image.indexOf({x, y})] = 1;
        }
    }
    const std::vector<glm::vec3> normals{glm::vec3(0.0F, 0.0F, 1.0F)};
    const HostMesh measured = reconstruct(images, normals, kHybridSettings);
    EXPECT_EQ(measured.mesh.sampleCount, samples);
    EXPECT_EQ(measured.vertices.size(), 4 * samples);
    EXPECT_EQ(measured.triangles.size(), 2 * samples);
    EXPECT_EQ(measured.mesh.sizeBytes(), 56 * samples);
    const reference::Shape shape = reference::shapeOf(measured.triangles, measured.vertices.size());
    EXPECT_EQ(shape.parts, samples);
    EXPECT_EQ(shape.euler, samples);
}

// The largest images of [xie2017] table 9, at their largest mesh: no corner is shared.
TEST_F(HybridTest, TakesTheLargestImages) {
    ImagePair images = emptyPair({1536, 1536});
    constexpr std::uint32_t kSamples = 1536 * 1536;
    images.image.depthM.assign(kSamples, 3.0F);
    images.image.triangleId.assign(kSamples, 1);
    const std::vector<glm::vec3> normals{glm::vec3(0.0F, 0.0F, 1.0F)};
    const HostMesh measured = reconstruct(images, normals, kHybridSettings);
    ASSERT_EQ(measured.vertices.size(), 4 * kSamples);
    EXPECT_EQ(measured.mesh.sizeBytes(), 56 * static_cast<std::size_t>(kSamples));
    // The first and the last vertex are corners of the image; every vertex is used.
    EXPECT_EQ(measured.vertices.front().xHalfPx, 0);
    EXPECT_EQ(measured.vertices.back().xHalfPx, 2 * 1536);
    EXPECT_EQ(measured.vertices.back().yHalfPx, 2 * 1536);
    std::vector<bool> isUsed(measured.vertices.size());
    for (const glm::uvec3& t : measured.triangles) isUsed[t.x] = isUsed[t.y] = isUsed[t.z] = true;
    EXPECT_EQ(std::count(isUsed.begin(), isUsed.end(), true), 4 * kSamples);
}

TEST_F(HybridTest, RepeatsToTheByte) {
    const scene::Mesh mesh = shapes::randomTriangles(400, 3);
    const std::vector<glm::vec3> normals = reference::normalsOf(mesh);
    const ImagePair images =
        traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.0F), {130, 90});
    const HostMesh a = reconstruct(images, normals, kHybridSettings);
    const HostMesh b = reconstruct(images, normals, kHybridSettings);
    EXPECT_EQ(a.triangles, b.triangles);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(
        std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(CornerVertex)),
        0);
}

TEST_F(HybridTest, OneReconstructorTakesImagesOfSeveralSizes) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 3);
    const gl::Buffer normals = triangleNormals(mesh, device().limits());
    Reconstructor reconstructor(shaders(), kHybridSettings);
    for (const int size : {64, 20, 90}) {
        const ImagePair images =
            traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.0F), {size, size});
        DepthImage image(images.image.view, DepthFormat::Float32);
        DepthImage offset(images.offset.view, DepthFormat::Float32);
        writeDepthImage(images.image, image);
        writeDepthImage(images.offset, offset);
        expectEqual(readBack(reconstructor.reconstruct(image, &offset, normals)),
                    reference::hybridQuads(images.image, images.offset, reference::normalsOf(mesh),
                                           kHybridSettings),
                    images.image.view);
    }
}

TEST_F(HybridTest, NormalsBeyondAStorageBlockAreRefused) {
    scene::Mesh mesh = shapes::cube(glm::vec3(0.0F), glm::vec3(1.0F));
    gl::DeviceLimits limits = device().limits();
    limits.maxStorageBlockBytes = 191;
    EXPECT_EQ(errorText([&] { triangleNormals(mesh, limits); }),
              "the normals of 12 triangles take 192 bytes; the device's storage blocks hold 191");
    limits.maxStorageBlockBytes = 192;
    const auto normals = triangleNormals(mesh, limits).read<glm::vec4>(12);
    const std::vector<glm::vec3> expected = reference::normalsOf(mesh);
    for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(glm::vec3(normals[t]), expected[t]);
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
