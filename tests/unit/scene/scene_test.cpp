#include "engine/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gfxrepro::scene {
namespace {

Mesh triangle() {
    Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

glm::vec3 faceNormal(const Mesh& mesh, std::size_t index) {
    const glm::uvec3 t = mesh.triangles[index];
    return glm::normalize(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                     mesh.positions[t.z] - mesh.positions[t.x]));
}

TEST(Scene, BoundsAndCountsAreOfInstancesAndPoints) {
    Scene scene = sceneOf(triangle());
    scene.instances.push_back({0, glm::translate(glm::mat4(1.0F), glm::vec3(5, 0, 0))});
    scene.points.positions = {{0, 0, -7}};
    EXPECT_EQ(scene.triangleCount(), 2U);
    EXPECT_EQ(scene.vertexCount(), 6U);
    EXPECT_EQ(scene.bounds().min, glm::vec3(0, 0, -7));
    EXPECT_EQ(scene.bounds().max, glm::vec3(6, 1, 0));
    EXPECT_EQ(scene.meshes[0].sizeBytes(), 3U * 12 + 3 * 12 + 12);
    EXPECT_TRUE(Scene{}.bounds().isEmpty());
}

TEST(Flattened, CopiesASingleIdentity) {
    Mesh mesh = triangle();
    mesh.material = 3;
    mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}};
    const Mesh flat = flattened(sceneOf(mesh));
    EXPECT_EQ(flat.positions, mesh.positions);
    EXPECT_EQ(flat.texcoords, mesh.texcoords);
    EXPECT_EQ(flat.triangles, mesh.triangles);
    EXPECT_EQ(flat.material, 3);
}

TEST(Flattened, JoinsInstancesAndDropsWhatNotAllHave) {
    Scene scene = sceneOf(triangle());
    Mesh other = triangle();
    other.colors = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    scene.meshes.push_back(other);
    scene.instances.push_back({1, glm::translate(glm::mat4(1.0F), glm::vec3(0, 0, 2))});
    const Mesh flat = flattened(scene);
    EXPECT_EQ(flat.positions.size(), 6U);
    EXPECT_EQ(flat.positions[3], glm::vec3(0, 0, 2));
    EXPECT_EQ(flat.triangles[1], glm::uvec3(3, 4, 5));
    EXPECT_EQ(flat.normals.size(), 6U);
    EXPECT_TRUE(flat.colors.empty());
}

TEST(Flattened, MirroredInstancesKeepTheirOutside) {
    Scene scene = sceneOf(triangle());
    scene.instances[0].worldFromMesh = glm::scale(glm::mat4(1.0F), glm::vec3(1, 1, -3));
    const Mesh flat = flattened(scene);
    EXPECT_EQ(flat.normals[0], glm::vec3(0, 0, -1));
    EXPECT_EQ(faceNormal(flat, 0), glm::vec3(0, 0, -1));
}

TEST(Flattened, TurnsNormalsByTheInverseTranspose) {
    Mesh mesh = triangle();
    const float half = std::sqrt(0.5F);
    mesh.normals = {{half, half, 0}, {half, half, 0}, {half, half, 0}};
    Scene scene = sceneOf(mesh);
    scene.instances[0].worldFromMesh = glm::scale(glm::mat4(1.0F), glm::vec3(2, 1, 1));
    const glm::vec3 expected = glm::normalize(glm::vec3(0.5F, 1, 0));
    EXPECT_LT(glm::length(flattened(scene).normals[0] - expected), 1e-6F);
}

TEST(Flattened, SurvivesSingularMatrices) {
    Scene scene = sceneOf(triangle());
    scene.instances[0].worldFromMesh = glm::mat4(0.0F);
    EXPECT_EQ(flattened(scene).normals[0], glm::vec3(0));
}

TEST(VertexNormals, AreWeightedByAreaAndZeroWithoutAny) {
    Mesh mesh;  // a large triangle facing +z and a small one facing +x share vertex 0
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    const auto normals = vertexNormals(mesh);
    EXPECT_LT(glm::length(normals[0] - glm::normalize(glm::vec3(1, 0, 4))), 1e-6F);
    EXPECT_EQ(normals[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(normals[5], glm::vec3(0));
}

TEST(VertexNormals, HoldForTinyTriangles) {
    Mesh mesh = triangle();
    for (glm::vec3& position : mesh.positions) position *= 1e-25F;
    EXPECT_EQ(vertexNormals(mesh)[0], glm::vec3(0, 0, 1));
}

TEST(TriangleNormals, EachTriangleHasItsOwnCorners) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 1, 2}};
    mesh.isFlat = true;
    const Mesh flat = withTriangleNormals(mesh);
    EXPECT_EQ(flat.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
    EXPECT_EQ(flat.positions[4], glm::vec3(0, 0, 1));
    EXPECT_EQ(flat.texcoords[4], glm::vec2(1, 1));
    EXPECT_TRUE(flat.colors.empty());
    EXPECT_FALSE(flat.isFlat);
    for (std::size_t i = 0; i < 9; ++i) {
        const glm::vec3 expected = i < 3 ? glm::vec3(0, 0, 1) : glm::vec3(0, i < 6 ? 1 : 0, 0);
        EXPECT_EQ(flat.normals[i], expected) << i;
    }
}

/// Depth and the two slopes of a point as the camera sees it.
glm::vec3 seen(const Camera& camera, const glm::vec3& point) {
    const glm::vec3 view =
        glm::vec3(glm::lookAt(camera.position, camera.target, camera.up) * glm::vec4(point, 1.0F));
    return {view.x / -view.z, view.y / -view.z, -view.z};
}

TEST(FramingCamera, HoldsTheWholeBoxTightly) {
    for (const float aspect : {0.5F, 1.0F, 2.5F}) {
        for (const glm::vec3 size : {glm::vec3(1), glm::vec3(100, 1, 1), glm::vec3(0.1F, 9, 3)}) {
            Box box;
            box.add(glm::vec3(3, -2, 8));
            box.add(glm::vec3(3, -2, 8) + size);
            const Camera camera = framingCamera(box, aspect);
            const float slope = std::tan(camera.verticalFovRad / 2);
            float fill = 0.0F;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::vec3 point(corner & 1 ? box.max.x : box.min.x,
                                      corner & 2 ? box.max.y : box.min.y,
                                      corner & 4 ? box.max.z : box.min.z);
                const glm::vec3 at = seen(camera, point);
                EXPECT_GT(at.z, camera.nearM);
                EXPECT_LT(at.z, camera.farM);
                fill = std::max({fill, std::abs(at.x) / (slope * aspect), std::abs(at.y) / slope});
            }
            EXPECT_LT(fill, 1.0F);
            EXPECT_GT(fill, 0.8F);
        }
    }
}

TEST(FramingCamera, LooksAtEmptyAndFlatBoxes) {
    const Camera empty = framingCamera(Box{}, 1.0F);
    EXPECT_EQ(empty.target, glm::vec3(0));
    EXPECT_GT(empty.nearM, 0.0F);
    EXPECT_GT(empty.farM, empty.nearM);
    Box point;
    point.add(glm::vec3(1, 2, 3));
    EXPECT_EQ(framingCamera(point, 1.0F).target, glm::vec3(1, 2, 3));
}

}  // namespace
}  // namespace gfxrepro::scene
