// Two ellipses as in [xie2017] figure 17: each kind of sample that Algorithm 4 tells apart, with
// the corners that it must get.
#include <gtest/gtest.h>

#include <set>

#include "tests/techniques/soft_shadows/reconstruction_fixture.h"

namespace gfxrepro::soft_shadows {
namespace {

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
            for (int y = 0; y < kSizePx; ++y) {
                for (int x = 0; x < kSizePx; ++x) {
                    const glm::vec2 p = glm::vec2(x, y) + 0.5F + offsetPx;
                    const Ellipse* e = ellipseAt(p);
                    if (!e) continue;
                    image.depthM[image.indexOf({x, y})] = e->depthAt(view, p);
                    image.triangleId[image.indexOf({x, y})] = e->idAt(p);
                }
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
    for (int y = 0; y < kSizePx; ++y) {
        for (int x = 0; x < kSizePx; ++x) {
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

}  // namespace
}  // namespace gfxrepro::soft_shadows
