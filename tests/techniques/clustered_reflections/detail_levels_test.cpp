// Chunks and levels of detail against what they are made of.
#include "techniques/clustered_reflections/visible_triangles.h"

#include <algorithm>
#include <array>

#include "tests/support/grid.h"
#include "tests/techniques/clustered_reflections/cluster_fixture.h"

namespace gfxrepro::clustered_reflections {
namespace {

using reflections::ReflectiveScene;

/// [0, 1]² of 2 · cells² triangles in the plane y = 0; `light` is the vertices' colour.
template <class Light>
scene::Mesh sheet(unsigned cells, const Light& light) {
    scene::Mesh mesh;
    for (unsigned i = 0; i <= cells; ++i) {
        for (unsigned j = 0; j <= cells; ++j) {
            const glm::vec2 at = glm::vec2(i, j) / static_cast<float>(cells);
            mesh.positions.push_back({at.x, 0.0F, at.y});
            mesh.normals.push_back({0.0F, 1.0F, 0.0F});
            mesh.colors.push_back(glm::vec3(light(at)));
        }
    }
    for (const auto [i, j] : test::grid<unsigned>(cells, cells)) {
        const unsigned corner = i * (cells + 1) + j, below = corner + cells + 1;
        mesh.triangles.push_back({corner, below, corner + 1});
        mesh.triangles.push_back({corner + 1, below, below + 1});
    }
    return mesh;
}

std::size_t trianglesOf(const DetailLevels& levels, const DetailLevel& level) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < level.chunkCount; ++i) {
        count += levels.chunks[level.firstChunk + i].triangleCount;
    }
    return count;
}

/// Calls action(triangle, chunk) for all of a level.
template <class Action>
void forEachTriangle(const DetailLevels& levels, const DetailLevel& level, const Action& action) {
    for (std::uint32_t c = 0; c < level.chunkCount; ++c) {
        const DetailChunk& chunk = levels.chunks[level.firstChunk + c];
        for (std::uint32_t t = 0; t < chunk.triangleCount; ++t) {
            action(levels.triangles[chunk.firstTriangle + t], chunk);
        }
    }
}

std::array<std::uint32_t, 3> sorted(const glm::uvec3& triangle) {
    std::array<std::uint32_t, 3> corners{triangle.x, triangle.y, triangle.z};
    std::sort(corners.begin(), corners.end());
    return corners;
}

TEST(DetailLevelsTest, TheFinestLevelsHoldEveryTriangleOnce) {
    const ReflectiveScene scene = MirrorScene()
                                      .add(ball())
                                      .add(squareMesh())
                                      .add(scene::Mesh{})
                                      .add(cap(1.0F, 10), glm::mat4(1.0F), false)
                                      .get();
    for (const bool isSimplified : {false, true}) {
        const DetailLevels levels = detailLevels(scene, isSimplified);
        std::vector<std::array<std::uint32_t, 3>> expected, found;
        for (const glm::uvec3& triangle : scene.geometry().triangles) {
            expected.push_back(sorted(triangle));
        }
        for (const DetailPart& part : levels.parts) {
            const DetailLevel& finest = levels.levels[part.firstLevel];
            EXPECT_EQ(finest.errorMesh, 0.0F);
            EXPECT_EQ(part.levelCount > 1, isSimplified && trianglesOf(levels, finest) > 2);
            forEachTriangle(levels, finest, [&](const glm::uvec4& triangle, const auto& chunk) {
                EXPECT_LE(chunk.triangleCount, kChunkTriangles);
                EXPECT_EQ(chunk.object, part.object);
                EXPECT_EQ(triangle.w, part.object);
                found.push_back(sorted(glm::uvec3(triangle)));
            });
        }
        std::sort(expected.begin(), expected.end());
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
        ASSERT_EQ(levels.firstTriangleOfObject.size(), scene.objects().size() + 1);
        EXPECT_EQ(levels.firstTriangleOfObject.back(), levels.triangles.size());
        EXPECT_EQ(levels.firstTriangleOfObject[2],
                  levels.firstTriangleOfObject[3]);  // without triangles
    }
}

TEST(DetailLevelsTest, CoarserLevelsHaveFewerTrianglesNoFartherThanTheySay) {
    const ReflectiveScene scene = MirrorScene().add(ball()).get();
    const DetailLevels levels = detailLevels(scene, true);
    for (const DetailPart& part : levels.parts) {
        ASSERT_GE(part.levelCount, 4U);
        for (std::uint32_t i = 1; i < part.levelCount; ++i) {
            const DetailLevel& level = levels.levels[part.firstLevel + i];
            const DetailLevel& finer = levels.levels[part.firstLevel + i - 1];
            EXPECT_LT(trianglesOf(levels, level), trianglesOf(levels, finer));
            EXPECT_GE(level.errorMesh, finer.errorMesh);
            float farthest = 0.0F;  // of the triangles' middles from the ball
            forEachTriangle(levels, level, [&](const glm::uvec4& triangle, const auto&) {
                const auto& p = scene.geometry().positions;
                const glm::vec3 middle = (p[triangle.x] + p[triangle.y] + p[triangle.z]) / 3.0F;
                farthest = std::max(farthest, std::abs(1.0F - glm::length(middle)));
            });
            // The error is a mean over a corner's triangles (quadrics), so that single ones may be
            // farther.
            EXPECT_LT(farthest, 4.0F * level.errorMesh + 2e-3F) << i;
        }
    }
}

TEST(DetailLevelsTest, ColoursAreKeptAsShapeIs) {
    const auto plain = [](const glm::vec2&) { return 0.5F; };
    const auto spot = [](const glm::vec2& at) {
        return glm::distance(at, glm::vec2(0.5F)) < 0.25F ? 0.1F : 0.9F;
    };
    const auto errorOfTenth = [](const scene::Mesh& mesh) {
        const ReflectiveScene scene = MirrorScene().add(mesh).get();
        const DetailLevels levels = detailLevels(scene, true);
        const DetailPart& part = levels.parts.front();
        for (std::uint32_t i = 1; i < part.levelCount; ++i) {
            const DetailLevel& level = levels.levels[part.firstLevel + i];
            if (trianglesOf(levels, level) * 20 < mesh.triangles.size()) return level.errorMesh;
        }
        return 1e9F;
    };
    EXPECT_LT(errorOfTenth(sheet(32, plain)), 1e-3F);
    EXPECT_GT(errorOfTenth(sheet(32, spot)), 1e-2F);
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
