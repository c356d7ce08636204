// Objects cut into smooth parts that bend to one side.
#include "techniques/reflections/reflectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/shared/mesh_builder.h"
#include "techniques/reflections/surfaces.h"

namespace gfxrepro::reflections {
namespace {

constexpr int kAround = 48;

/// A surface of revolution around y: `outline` is (radius, height), from one end to the other.
scene::Mesh turned(const std::vector<glm::vec2>& outline) {
    scene::Mesh mesh;
    const auto rows = static_cast<unsigned>(outline.size());
    for (int i = 0; i <= kAround; ++i) {
        // The last column repeats the first, up to rounding.
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / kAround;
        for (const glm::vec2& p : outline) {
            mesh.positions.emplace_back(p.x * std::cos(angle), p.y, p.x * std::sin(angle));
        }
    }
    for (unsigned i = 0; i < kAround; ++i) {
        for (unsigned j = 0; j + 1 < rows; ++j) {
            const unsigned a = i * rows + j, b = a + rows;
            mesh.triangles.emplace_back(a, a + 1, b + 1);
            mesh.triangles.emplace_back(a, b + 1, b);
        }
    }
    mesh.normals = scene::vertexNormals(mesh);
    return mesh;
}

/// Outside up, round the rim, and inside down: a thick bowl with a smooth rim.
std::vector<glm::vec2> bowlOutline() {
    std::vector<glm::vec2> outline;
    constexpr int kSteps = 16, kRim = 6;
    const auto at = [](float radius, float angle) {
        return glm::vec2(radius * std::sin(angle), -radius * std::cos(angle));
    };
    const float last = 0.5F * glm::pi<float>();
    for (int k = 0; k <= kSteps; ++k) {
        outline.push_back(at(1.0F, last * static_cast<float>(k) / kSteps));
    }
    for (int k = 1; k < kRim; ++k) {
        const float angle = glm::pi<float>() * static_cast<float>(k) / kRim;
        outline.emplace_back(0.95F + 0.05F * std::cos(angle), 0.05F * std::sin(angle));
    }
    for (int k = kSteps; k >= 0; --k) {
        outline.push_back(at(0.9F, last * static_cast<float>(k) / kSteps));
    }
    return outline;
}

std::size_t countOf(const Parts& parts) {
    return parts.isConcave.size();
}

scene::Mesh boxMesh() {
    scene::MeshBuilder builder;
    builder.addBox(glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F));
    return builder.take("box", 0);
}

TEST(ReflectorParts, ABallIsOne) {
    std::vector<glm::vec2> outline;
    for (int k = 0; k <= 24; ++k) {
        const float angle = glm::pi<float>() * static_cast<float>(k) / 24.0F;
        outline.emplace_back(std::sin(angle), -std::cos(angle));
    }
    const scene::Mesh smooth = turned(outline);
    EXPECT_EQ(countOf(partsOf(smooth)), 1U);
    scene::Mesh flat;  // shaded flat, of triangles that are no planes by themselves
    for (const glm::uvec3& corners : smooth.triangles) {
        const auto first = static_cast<unsigned>(flat.positions.size());
        for (int k = 0; k < 3; ++k) flat.positions.push_back(smooth.positions[corners[k]]);
        const glm::vec3 a = flat.positions[first];
        const glm::vec3 normal =
            glm::cross(flat.positions[first + 1] - a, flat.positions[first + 2] - a);
        flat.normals.insert(flat.normals.end(), 3, normal);
        flat.triangles.emplace_back(first, first + 1, first + 2);
    }
    EXPECT_EQ(countOf(partsOf(flat)), 1U);
}

TEST(ReflectorParts, ABoxHasSixSides) {
    EXPECT_EQ(countOf(partsOf(boxMesh())), 6U);
}

TEST(ReflectorParts, InsideAndOutsideOfABowlAreApart) {
    const scene::Mesh mesh = turned(bowlOutline());
    const Parts parts = partsOf(mesh);
    ASSERT_EQ(countOf(parts), 2U);
    EXPECT_EQ(parts.isConcave, (std::vector<std::uint8_t>{0, 1}));
    // The inside lies within 0.92 of the centre, the outside beyond 0.98; the rim is the outside's.
    int inside = 0, outside = 0;
    for (std::size_t t = 0; t < parts.ofTriangle.size(); ++t) {
        glm::vec3 middle(0.0F);
        for (int k = 0; k < 3; ++k) middle += mesh.positions[mesh.triangles[t][k]] / 3.0F;
        if (middle.y > -0.15F) continue;
        const bool isInside = glm::length(middle) < 0.95F;
        (isInside ? inside : outside) += 1;
        EXPECT_EQ(parts.ofTriangle[t], isInside ? 1U : 0U) << glm::length(middle);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(outside, 100);
}

TEST(ReflectorParts, PartsThatDoNotTouchAreApartUnlessTheyAreSmall) {
    scene::MeshBuilder builder;
    builder.addQuad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    builder.addQuad({3, 0, 1}, {5, 0, 1}, {5, 0, -1}, {3, 0, -1});
    for (const float x : {8.0F, 9.0F, 10.0F}) {
        builder.addQuad({x, 0, 0.05F}, {x + 0.1F, 0, 0.05F}, {x + 0.1F, 0, 0}, {x, 0, 0});
    }
    const Parts parts = partsOf(builder.take("quads", 0));
    EXPECT_EQ(parts.ofTriangle, (std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2, 2, 2, 2, 2}));
}

TEST(ReflectorParts, SmallOnesAreJoinedWithinAPlaneAndNotFromWallToWall) {
    scene::MeshBuilder builder;
    for (int i = 0; i < 25; ++i) {  // tiles of two walls that face each other
        const float y = static_cast<float>(i / 5), z = static_cast<float>(i % 5);
        builder.addQuad({0, y, z}, {0, y + 0.9F, z}, {0, y + 0.9F, z + 0.9F}, {0, y, z + 0.9F});
        builder.addQuad({4, y, z}, {4, y, z + 0.9F}, {4, y + 0.9F, z + 0.9F}, {4, y + 0.9F, z});
    }
    const Parts parts = partsOf(builder.take("tiles", 0));
    ASSERT_EQ(countOf(parts), 2U);
    for (std::size_t t = 0; t < parts.ofTriangle.size(); ++t) {
        EXPECT_EQ(parts.ofTriangle[t], t / 2 % 2) << t;
    }
}

TEST(ReflectorParts, SmallWallsOfOneNormalAreApartBesideALargeFloor) {
    scene::MeshBuilder builder;
    builder.addQuad({-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    for (int i = 0; i < 25; ++i) {  // tiles of two walls, one behind the other, and of one across
        const float x = static_cast<float>(i / 5), y = static_cast<float>(1 + i % 5);
        const float far = x + 0.9F, up = y + 0.9F;
        builder.addQuad({x, y, 0}, {far, y, 0}, {far, up, 0}, {x, up, 0});
        builder.addQuad({x + 9, y, -9}, {far + 9, y, -9}, {far + 9, up, -9}, {x + 9, up, -9});
        builder.addQuad({-9, y, far}, {-9, y, x}, {-9, up, x}, {-9, up, far});
    }
    const Parts parts = partsOf(builder.take("tiles", 0));
    ASSERT_EQ(countOf(parts), 3U);  // the floor, and no two walls of one normal together
    for (std::size_t t = 2; t < parts.ofTriangle.size(); t += 6) {
        EXPECT_NE(parts.ofTriangle[t], 0U) << t;
        EXPECT_NE(parts.ofTriangle[t + 2], 0U) << t;
        EXPECT_NE(parts.ofTriangle[t], parts.ofTriangle[t + 2]) << t;
    }
}

TEST(ReflectorParts, ThinSidesLeaveAMirrorPlanar) {
    scene::MeshBuilder builder;
    builder.addBox(glm::vec3(0.0F), glm::vec3(1.0F, 1.0F, 0.01F));
    const scene::Mesh mesh = builder.take("mirror", 0);
    const Parts parts = partsOf(mesh);
    EXPECT_EQ(countOf(parts), 3U);  // front, back, and the four sides
    for (std::size_t t = 0; t < parts.ofTriangle.size(); ++t) {
        const float z = mesh.normals[mesh.triangles[t].x].z;
        for (std::size_t u = 0; u < parts.ofTriangle.size(); ++u) {
            const float other = mesh.normals[mesh.triangles[u].x].z;
            EXPECT_EQ(parts.ofTriangle[t] == parts.ofTriangle[u], z == other) << t << ' ' << u;
        }
    }
}

TEST(ReflectorParts, AFlatShadedBevelLeavesAMirrorPlanar) {
    scene::MeshBuilder builder;
    builder.addQuad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    builder.addQuad({1, 0, 1}, {1.01F, -0.01F, 1}, {1.01F, -0.01F, -1}, {1, 0, -1});  // 45°
    scene::Mesh mesh = builder.take("mirror", 0);
    EXPECT_EQ(partsOf(mesh).ofTriangle, (std::vector<std::uint32_t>{0, 0, 1, 1}));
    // Bent by its normals, it is one surface.
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (mesh.positions[v].x == 1.0F) mesh.normals[v] = glm::normalize(glm::vec3(0.4F, 1, 0));
    }
    EXPECT_EQ(countOf(partsOf(mesh)), 1U);
}

TEST(ReflectorParts, NothingAndDegenerateTrianglesAreNoError) {
    EXPECT_EQ(countOf(partsOf({})), 0U);
    const scene::Mesh mesh{.positions = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                           .triangles = {{0, 1, 2}, {0, 2, 3}, {3, 3, 3}}};
    EXPECT_EQ(partsOf(mesh).ofTriangle.size(), 3U);
}

TEST(ReflectorParts, BecomeObjectsThatMoveTogether) {
    scene::Scene scene{.name = "test",
                       .meshes = {boxMesh(), boxMesh()},
                       .materials = {{.metallic = 1.0F, .roughness = 0.0F}, {}}};
    scene.meshes[1].material = 1;  // diffuse: stays whole
    scene.instances = {{1}, {0}, {0}};
    scene.motions = {{.instance = 0}, {.instance = 2}};
    const ReflectiveScene whole(scene);
    EXPECT_EQ(whole.reflectorCount(), 2);
    EXPECT_EQ(whole.wholeReflectorCount(), 2);
    EXPECT_FALSE(whole.objects()[1].isPlanar);
    const ReflectiveScene split(scene, {.splitsParts = true});
    EXPECT_EQ(split.objects().size(), 13U);
    EXPECT_EQ(split.reflectorCount(), 12);
    EXPECT_EQ(split.wholeReflectorCount(), 2);
    EXPECT_EQ(split.scene().motions.size(), 7U);
    EXPECT_EQ(split.scene().motions[0].instance, 0);
    EXPECT_EQ(split.scene().motions[6].instance, 12);
    EXPECT_EQ(split.scene().triangleCount(), whole.scene().triangleCount());
    for (int i = 1; i < 13; ++i) {
        const Object& object = split.objects()[static_cast<std::size_t>(i)];
        EXPECT_EQ(object.reflector, i);
        EXPECT_EQ(object.wholeReflector, i < 7 ? 1 : 2);
        EXPECT_TRUE(object.isPlanar);
    }
}

}  // namespace
}  // namespace gfxrepro::reflections
