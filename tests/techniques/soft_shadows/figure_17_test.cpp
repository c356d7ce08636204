// Two ellipses as in [xie2017] figure 17: each kind of sample that Algorithm 4 tells apart, with
// the corners that it must get.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <set>

#include "tests/support/grid.h"
#include "tests/techniques/soft_shadows/reconstruction_fixture.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::soft_shadows {
namespace {

namespace shapes = voxelization::shapes;
using ClassicTest = ReconstructionTest;
using kit::HostDepthImage;
using kit::View;

/// A flat ellipse, slanted in depth; its left and right half are two triangles' worth of ids.
struct Ellipse {
    glm::vec2 centrePx;
    glm::vec2 radiusPx;
    glm::vec3 normal;   // unit
    float depthAtAxis;  // where the view's axis meets its plane
    std::uint32_t leftId;

    bool covers(const glm::vec2& p) const {
        const glm::vec2 d = (p - centrePx) / radiusPx;
        return glm::dot(d, d) <= 1.0F;
    }
    std::uint32_t idAt(const glm::vec2& p) const { return leftId + (p.x < centrePx.x ? 0U : 1U); }
    /// n·(depth · ray − depthAtAxis · axis) = 0
    float depthAt(const View& view, const glm::vec2& p) const {
        const glm::vec3 ray = unproject(view, p, 1.0F);
        return depthAtAxis * glm::dot(normal, glm::vec3(0.0F, 0.0F, -1.0F)) / glm::dot(normal, ray);
    }
};

constexpr int kSizePx = 12;
/// A large one behind, a small one in front that hides a part of its outline, and one of less than
/// a pixel: it covers the middle of pixel (10, 1) and no corner.
const Ellipse kEllipses[] = {
    {{7.9F, 7.2F}, {1.9F, 1.6F}, glm::normalize(glm::vec3(-0.2F, 0.1F, 1.0F)), 4.0F, 3},
    {{4.6F, 5.4F}, {3.9F, 4.3F}, glm::normalize(glm::vec3(0.3F, -0.1F, 1.0F)), 9.0F, 1},
    {{10.5F, 1.5F}, {0.4F, 0.4F}, glm::vec3(0.0F, 0.0F, 1.0F), 6.0F, 5},
};

const Ellipse* ellipseAt(const glm::vec2& p) {
    for (const Ellipse& e : kEllipses) {
        if (e.covers(p)) return &e;
    }
    return nullptr;
}

struct Figure17Test : ReconstructionTest {
    void SetUp() override {
        const auto imageWithOffset = [&](float offsetPx) {
            HostDepthImage image =
                emptyImage(viewOf(originCamera(), glm::ivec2(kSizePx), glm::vec2(offsetPx)));
            for (const auto [y, x] : test::grid(kSizePx, kSizePx)) {
                const glm::vec2 p = glm::vec2(x, y) + 0.5F + offsetPx;
                const Ellipse* e = ellipseAt(p);
                if (!e) continue;
                image.depthM[image.indexOf({x, y})] = e->depthAt(view, p);
                image.triangleId[image.indexOf({x, y})] = e->idAt(p);
            }
            return image;
        };
        std::vector<glm::vec3> normals(6);
        for (const Ellipse& e : kEllipses) normals[e.leftId - 1] = normals[e.leftId] = e.normal;
        ReconstructionSettings settings;
        settings.discontinuityPx = 1.0F;  // a pixel of so small an image is large
        mesh = reconstruct({imageWithOffset(0.0F), imageWithOffset(-0.5F)}, normals, settings);
    }

    /// Vertices of a pixel's corners, counter-clockwise from the lower left.
    std::array<unsigned, 4> verticesOf(int x, int y) const {
        std::size_t quad = 0;
        for (int i = 0; i < y * kSizePx + x; ++i) {
            if (ellipseAt(glm::vec2(i % kSizePx, i / kSizePx) + 0.5F)) ++quad;
        }
        const glm::uvec3 lower = mesh.triangles.at(2 * quad);
        return {lower.x, lower.y, lower.z, mesh.triangles.at(2 * quad + 1).y};
    }
    float depthOf(unsigned vertex) const { return mesh.vertices.at(vertex).depthM; }

    const View view = viewOf(originCamera(), glm::ivec2(kSizePx));
    HostMesh mesh;
};

constexpr glm::ivec2 kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST_F(Figure17Test, EveryCornerLiesOnItsSamplesEllipse) {
    // Whether from H or from the plane: the ellipses are flat.
    std::size_t fitted = 0, samples = 0;
    std::set<unsigned> shared;
    for (const auto [y, x] : test::grid(kSizePx, kSizePx)) {
        const Ellipse* e = ellipseAt(glm::vec2(x, y) + 0.5F);
        if (!e) continue;
        ++samples;
        const auto vertices = verticesOf(x, y);
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::vec2 corner(glm::ivec2(x, y) + kCorners[k]);
            EXPECT_NEAR(depthOf(vertices[k]), e->depthAt(view, corner), 1e-4F);
            if (ellipseAt(corner) == e) shared.insert(vertices[k]);
            fitted += ellipseAt(corner) == e ? 0 : 1;
        }
    }
    EXPECT_EQ(mesh.mesh.sampleCount, samples);
    EXPECT_EQ(mesh.vertices.size(), shared.size() + fitted);
}

TEST_F(Figure17Test, S0HasFourValidCornersThatNeighboursShare) {
    const auto s0 = verticesOf(3, 5);  // its right neighbour is of the other triangle
    const auto right = verticesOf(4, 5);
    const auto above = verticesOf(3, 6);
    EXPECT_EQ(s0[1], right[0]);
    EXPECT_EQ(s0[2], right[3]);
    EXPECT_EQ(s0[3], above[0]);
    EXPECT_EQ(s0[2], above[1]);
    EXPECT_EQ(s0[2], verticesOf(4, 6)[0]);
}

TEST_F(Figure17Test, S2MissesOneCorner) {
    // Pixel (1, 7): its upper left corner (1, 8) lies outside of the ellipse.
    ASSERT_TRUE(ellipseAt({1.5F, 7.5F}));
    ASSERT_FALSE(ellipseAt({1.0F, 8.0F}));
    const auto s2 = verticesOf(1, 7);
    int inOtherQuads = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) inOtherQuads += mesh.triangles[t][i] == s2[3];
    }
    EXPECT_EQ(inOtherQuads, 1);  // c₃ is in one of its own two triangles only
    const auto right = verticesOf(2, 7);
    EXPECT_EQ(s2[1], right[0]);
    EXPECT_EQ(s2[2], right[3]);
}

TEST_F(Figure17Test, S3AndS4HavePrivateCornersOnOneRay) {
    // Pixels (5, 7) of the large and (6, 7) of the small ellipse, side by side.
    const Ellipse *small = &kEllipses[0], *large = &kEllipses[1];
    ASSERT_EQ(ellipseAt({5.5F, 7.5F}), large);
    ASSERT_EQ(ellipseAt({6.5F, 7.5F}), small);
    const auto s3 = verticesOf(5, 7);
    const auto s4 = verticesOf(6, 7);
    for (const auto& [a, b] : {std::pair(s3[1], s4[0]), std::pair(s3[2], s4[3])}) {
        EXPECT_NE(a, b);
        const CornerVertex &va = mesh.vertices[a], &vb = mesh.vertices[b];
        EXPECT_EQ(va.xHalfPx, vb.xHalfPx);
        EXPECT_EQ(va.yHalfPx, vb.yHalfPx);
        const glm::vec2 corner(0.5F * static_cast<float>(va.xHalfPx),
                               0.5F * static_cast<float>(va.yHalfPx));
        EXPECT_NEAR(va.depthM, large->depthAt(view, corner), 1e-4F);
        EXPECT_NEAR(vb.depthM, small->depthAt(view, corner), 1e-4F);
        EXPECT_GT(va.depthM - vb.depthM, 2.0F);
    }
}

TEST_F(Figure17Test, S5StandsAlone) {
    ASSERT_EQ(ellipseAt({10.5F, 1.5F}), &kEllipses[2]);
    const auto s5 = verticesOf(10, 1);
    for (const unsigned v : s5) {
        EXPECT_FLOAT_EQ(depthOf(v), 6.0F);
        int uses = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            for (int i = 0; i < 3; ++i) uses += t[i] == v;
        }
        EXPECT_EQ(uses, v == s5[0] || v == s5[2] ? 2 : 1);
    }
}

// The classic depth-image mesh on the device against the CPU and known answers.

constexpr ReconstructionSettings kSettings{.method = Reconstruction::Classic};
/// For images of a few pixels, whose footprints are large.
constexpr ReconstructionSettings kTinyImage{.method = Reconstruction::Classic,
                                            .discontinuityPx = 0.5F};

/// Samples from rows of ids, top row first: '.' none, '1' … the id; the depth of id n is
/// `depths[n]`.
ImagePair imagesOf(const std::vector<std::string>& rows, const std::vector<float>& depths) {
    const glm::ivec2 size(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
    ImagePair images = emptyPair(size);
    for (const auto [y, x] : test::grid(size.y, size.x)) {
        const char c = rows[static_cast<std::size_t>(size.y - 1 - y)][static_cast<std::size_t>(x)];
        if (c == '.') continue;
        const std::size_t at = images.image.indexOf({x, y});
        images.image.triangleId[at] = static_cast<std::uint32_t>(c - '0');
        images.image.depthM[at] = depths[static_cast<std::size_t>(c - '0')];
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
