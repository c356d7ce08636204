// The classic depth-image mesh on the device against the CPU and known answers.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tests/techniques/soft_shadows/reconstruction_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

using kit::HostDepthImage;
namespace shapes = voxelization::shapes;

using ClassicTest = ReconstructionTest;

constexpr ReconstructionSettings kSettings{.method = Reconstruction::Classic};
/// For images of a few pixels, whose footprints are large.
constexpr ReconstructionSettings kTinyImage{.method = Reconstruction::Classic,
                                            .discontinuityPx = 0.5F};

/// Samples from rows of ids, top row first: '.' none, '1' … the id; the depth of id n is
/// `depths[n]`.
ImagePair imagesOf(const std::vector<std::string>& rows, const std::vector<float>& depths) {
    const glm::ivec2 size(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
    ImagePair images = emptyPair(size);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const char c =
                rows[static_cast<std::size_t>(size.y - 1 - y)][static_cast<std::size_t>(x)];
            if (c == '.') continue;
            const std::size_t at = images.image.indexOf({x, y});
            images.image.triangleId[at] = static_cast<std::uint32_t>(c - '0');
            images.image.depthM[at] = depths[static_cast<std::size_t>(c - '0')];
        }
    }
    return images;
}

const std::vector<glm::vec3> kFacing(4, glm::vec3(0.0F, 0.0F, 1.0F));

/// A triangle as the pixels of its samples, turned so that the smallest comes first.
using PixelTriangle = std::array<std::pair<int, int>, 3>;
PixelTriangle turned(PixelTriangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

std::multiset<PixelTriangle> pixelTriangles(const HostMesh& mesh) {
    std::multiset<PixelTriangle> triangles;
    for (const glm::uvec3& t : mesh.triangles) {
        PixelTriangle pixels;
        for (int i = 0; i < 3; ++i) {
            const CornerVertex& v = mesh.vertices.at(t[i]);
            EXPECT_EQ(v.xHalfPx % 2 + v.yHalfPx % 2, 2);  // the middle of a pixel
            pixels[static_cast<std::size_t>(i)] = {v.xHalfPx / 2, v.yHalfPx / 2};
        }
        triangles.insert(turned(pixels));
    }
    return triangles;
}

/// The larger set of triangles that no discontinuity crosses, of the two ways to split a cell.
std::multiset<PixelTriangle> expectedTriangles(const HostDepthImage& image,
                                               std::span<const glm::vec3> normals) {
    std::multiset<PixelTriangle> triangles;
    for (int y = 0; y + 1 < image.view.sizePx.y; ++y) {
        for (int x = 0; x + 1 < image.view.sizePx.x; ++x) {
            // Counter-clockwise from the lower left; the split that is preferred joins 0 and 2.
            const glm::ivec2 p[4] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
            std::vector<PixelTriangle> best;
            for (const std::array<std::array<int, 3>, 2>& split :
                 {std::array<std::array<int, 3>, 2>{{{0, 1, 2}, {2, 3, 0}}},
                  {{{1, 2, 3}, {3, 0, 1}}}}) {
                std::vector<PixelTriangle> found;
                for (const std::array<int, 3>& t : split) {
                    PixelTriangle pixels;
                    bool isWhole = true;
                    for (std::size_t i = 0; i < 3; ++i) {
                        const glm::ivec2 a = p[t[i]], b = p[t[(i + 1) % 3]];
                        isWhole = isWhole && reference::areJoined(image, a, b, normals, kSettings);
                        pixels[i] = {a.x, a.y};
                    }
                    if (isWhole) found.push_back(turned(pixels));
                }
                if (found.size() > best.size()) best = found;
            }
            triangles.insert(best.begin(), best.end());
        }
    }
    return triangles;
}

TEST_F(ClassicTest, IsTheReferencesMesh) {
    const std::vector<std::pair<const char*, scene::Mesh>> meshes{
        {"sphere", shapes::sphere(glm::vec3(0.1F, 0.2F, 0.3F), 1.0F, 6)},
        {"cube", shapes::cube(glm::vec3(0.0F), glm::vec3(1.0F, 0.7F, 0.4F))},
        {"random triangles", shapes::randomTriangles(400, 11)}};
    for (const auto& [name, mesh] : meshes) {
        SCOPED_TRACE(name);
        const std::vector<glm::vec3> normals = reference::normalsOf(mesh);
        const ImagePair images =
            traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.2F), {97, 80});
        const HostMesh measured = reconstruct(images, normals, kSettings);
        EXPECT_EQ(pixelTriangles(measured), expectedTriangles(images.image, normals));
        std::set<unsigned> used;
        for (const glm::uvec3& t : measured.triangles) used.insert({t.x, t.y, t.z});
        EXPECT_EQ(used.size(), measured.vertices.size());
        for (const CornerVertex& v : measured.vertices) {
            const glm::ivec2 pixel(v.xHalfPx / 2, v.yHalfPx / 2);
            EXPECT_EQ(v.depthM, images.image.depthM[images.image.indexOf(pixel)]);
        }
        EXPECT_LE(measured.mesh.sizeBytes(), 64 * measured.mesh.sampleCount);
    }
}

TEST_F(ClassicTest, APlaneIsTwoTrianglesACell) {
    const ImagePair images = imagesOf(std::vector<std::string>(7, "11111"), {0.0F, 3.0F});
    const HostMesh measured = reconstruct(images, kFacing, kSettings);
    EXPECT_EQ(measured.mesh.sampleCount, 35U);
    EXPECT_EQ(measured.vertices.size(), 35U);
    EXPECT_EQ(measured.triangles.size(), 2U * 4 * 6);
    const reference::Shape shape = reference::shapeOf(measured.triangles, measured.vertices.size());
    EXPECT_EQ(shape.euler, 1);
    EXPECT_EQ(shape.parts, 1);
}

TEST_F(ClassicTest, NothingLeadsAcrossADiscontinuity) {
    const ImagePair images = imagesOf({"112222", "111222", "111122"}, {0.0F, 3.0F, 50.0F});
    const HostMesh measured = reconstruct(images, kFacing, kTinyImage);
    EXPECT_FALSE(measured.triangles.empty());
    for (const glm::uvec3& t : measured.triangles) {
        const float depth = measured.vertices[t.x].depthM;
        EXPECT_EQ(depth, measured.vertices[t.y].depthM);
        EXPECT_EQ(depth, measured.vertices[t.z].depthM);
    }
}

TEST_F(ClassicTest, ThreeNeighboursAreOneTriangle) {
    const std::vector<std::pair<std::vector<std::string>, PixelTriangle>> cases{
        {{"1.", "11"}, {{{0, 0}, {1, 0}, {0, 1}}}},
        {{".1", "11"}, {{{0, 0}, {1, 0}, {1, 1}}}},
        {{"11", ".1"}, {{{0, 1}, {1, 0}, {1, 1}}}},
        {{"11", "1."}, {{{0, 0}, {1, 1}, {0, 1}}}},
        {{"12", "11"}, {{{0, 0}, {1, 0}, {0, 1}}}}};  // the fourth is far behind
    for (const auto& [rows, triangle] : cases) {
        const HostMesh measured =
            reconstruct(imagesOf(rows, {0.0F, 1.0F, 80.0F}), kFacing, kTinyImage);
        EXPECT_EQ(pixelTriangles(measured), std::multiset<PixelTriangle>{triangle});
        EXPECT_EQ(measured.vertices.size(), 3U);
    }
}

TEST_F(ClassicTest, WhatHasNoTwoNeighboursIsLost) {
    for (const std::vector<std::string>& rows :
         {std::vector<std::string>{"1.1.", ".1.1"}, {"11.1"}, {"1"}, {"...."}}) {
        const HostMesh measured = reconstruct(imagesOf(rows, {0.0F, 1.0F}), kFacing, kTinyImage);
        EXPECT_TRUE(measured.vertices.empty());
        EXPECT_TRUE(measured.triangles.empty());
    }
}

TEST_F(ClassicTest, FacesTheEyeAndIsADisc) {
    const scene::Mesh mesh = shapes::sphere(glm::vec3(0.0F), 1.0F, 6);
    const ImagePair images =
        traceImages(mesh, scene::framingCamera(mesh.bounds(), 1.0F), {100, 100});
    const HostMesh measured = reconstruct(images, reference::normalsOf(mesh), kSettings);
    const reference::Shape shape = reference::shapeOf(measured.triangles, measured.vertices.size());
    EXPECT_EQ(shape.euler, 1);
    EXPECT_EQ(shape.parts, 1);
    expectFacesEye(measured);
    for (const glm::vec3& p : toWorldMesh(measured.mesh).positions)
        EXPECT_NEAR(glm::length(p), 1.0F, 0.0005F);
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
