#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/random.h"
#include "engine/scene/polygon.h"
#include "engine/scene/scene_reference.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

using Corners = std::vector<glm::vec3>;

Mesh triangle() {
    return Mesh{.name = "triangle",
                .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                .triangles = {{0, 1, 2}}};
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
    const Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    .texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
                    .triangles = {{0, 1, 2}, {0, 3, 1}, {1, 1, 2}},
                    .isFlat = true};
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

Node reference(const std::string& text) {
    return Node::scalar(text, SourceLocation{"t.yaml", 5, 8});
}

TEST(SceneReference, HasParametersAndSeed) {
    const SceneReference city =
        SceneReference::from(reference("outdoor/city?towers=4&width_m=0.5@3"));
    EXPECT_EQ(city.name, "outdoor/city");
    EXPECT_EQ(city.params.toFlowText(), "{towers: 4, width_m: 0.5}");
    EXPECT_EQ(city.seed, "3");
    EXPECT_EQ(city.text(), "outdoor/city?towers=4&width_m=0.5@3");
    for (const char* text : {"outdoor/city", "outdoor/city@3", "outdoor/city?density=0.5"}) {
        EXPECT_EQ(SceneReference::from(reference(text)).text(), text);
        EXPECT_EQ(sceneName(text), "outdoor/city") << text;
        EXPECT_FALSE(isSceneFile(text)) << text;
    }
}

TEST(SceneReference, IsAFileWhereTheNameHasAnExtension) {
    for (const char* text : {"scan.glb", "dir.x/a@3.glb"}) {
        EXPECT_TRUE(isSceneFile(text)) << text;
        EXPECT_EQ(sceneName(text), text);
        EXPECT_EQ(SceneReference::from(reference(text)).name, text);
    }
    EXPECT_TRUE(isSceneFile("scan.glb?x=1"));
}

TEST(SceneReference, TakesSeedAndParameters) {
    EXPECT_EQ(withSeed(reference("a@5"), 7).text(), "a@7");
    EXPECT_EQ(withSeed(reference("a?n=1"), 7).text(), "a?n=1@7");
    const Node params = parseYaml("{n: 2, kind: tall, lit: true}", "p.yaml");
    EXPECT_EQ(withSceneParams(reference("a@5"), params).text(), "a?n=2&kind=tall&lit=true@5");
    EXPECT_EQ(withSceneParams(reference("a?m=1&n=1"), params).text(),
              "a?m=1&n=2&kind=tall&lit=true");
    EXPECT_EQ(withSeed(reference("a@5"), 7).location().line, 5);
}

TEST(SceneReference, RefusesWhatIsNoParameter) {
    const auto errorOf = [](const std::string& text) {
        return errorText([&] { SceneReference::from(reference(text)); });
    };
    EXPECT_EQ(errorOf("a?blades"),
              "t.yaml:5:8: scene 'a?blades': 'blades' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(errorOf("a?n=1&=2"),
              "t.yaml:5:8: scene 'a?n=1&=2': '=2' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(errorOf("a?n=[1, 2]"),
              "t.yaml:5:8: scene 'a?n=[1, 2]': 'n=[1, 2]' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(
        errorText([] { withSceneParams(reference("a"), parseYaml("n: [1, 2]", "p.yaml")); }),
        "p.yaml:1:4: scene parameter 'n' is [1, 2]; allowed: a number, true, false or a name");
}

/// Of all triangles together; those that overlap count twice.
double filledArea(PolygonFiller& filler, const Corners& corners) {
    double area = 0.0;
    for (const glm::uvec3& t : filler.fill(corners)) {
        const glm::dvec3 a(corners[t.x]);
        area += 0.5 *
                glm::length(glm::cross(glm::dvec3(corners[t.y]) - a, glm::dvec3(corners[t.z]) - a));
    }
    return area;
}

/// From each corner on, in both directions, and with each axis upwards.
void expectArea(const Corners& corners, double area) {
    for (std::size_t first = 0; first < corners.size(); ++first) {
        for (const bool isTurned : {false, true}) {
            for (int axis = 0; axis < 3; ++axis) {
                Corners variant;
                for (const glm::vec3& c : corners) {
                    variant.push_back({c[axis], c[(axis + 1) % 3], c[(axis + 2) % 3]});
                }
                std::rotate(variant.begin(), variant.begin() + static_cast<long>(first),
                            variant.end());
                if (isTurned) std::reverse(variant.begin(), variant.end());
                PolygonFiller filler;
                EXPECT_NEAR(filledArea(filler, variant), area, 1e-5 * area)
                    << first << ' ' << isTurned << ' ' << axis;
                EXPECT_EQ(filler.fill(variant).size(), corners.size() - 2);
                EXPECT_EQ(filler.overlappingCount(), 0U);
            }
        }
    }
}

TEST(PolygonFiller, FillsConcavePolygons) {
    expectArea({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0);
    expectArea({{2, 0, 0}, {1, 0.5F, 0}, {0, 0, 0}, {1, 2, 0}}, 1.5);
    // Its inner corner, and then each corner, several times.
    expectArea({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0);
    Corners often;
    for (const glm::vec3& corner :
         Corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}) {
        often.insert(often.end(), 3, corner);
    }
    expectArea(often, 3.0);
    // Corners on a straight edge.
    expectArea({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}}, 3.0);
}

TEST(PolygonFiller, LeavesAFanWhereItFills) {
    PolygonFiller filler;
    const std::vector<glm::uvec3> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    const Corners convex{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    EXPECT_TRUE(std::ranges::equal(filler.fill(convex), fan));
    const Corners dent{{1, 1, 0}, {0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};  // all from (1, 1)
    EXPECT_TRUE(std::ranges::equal(filler.fill(dent), fan));
}

/// A hole is written as two edges on each other that join it to the border.
TEST(PolygonFiller, LeavesAHoleThatIsJoinedToTheBorder) {
    const Corners ring{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                       {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    PolygonFiller filler;
    EXPECT_NEAR(filledArea(filler, ring), 12.0, 1e-9);
    EXPECT_EQ(filler.overlappingCount(), 0U);
}

TEST(PolygonFiller, CountsWhatCrossesItself) {
    PolygonFiller filler;
    filler.fill(Corners{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(filler.overlappingCount(), 1U);
    filler.fill(Corners{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, -1, 0}, {0, 4, 0}});
    EXPECT_EQ(filler.overlappingCount(), 2U);
    filler.fill(Corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(filler.overlappingCount(), 2U);
}

/// Stars about the origin, with as many reflex corners as others, in any plane.
TEST(PolygonFiller, FillsRandomPolygons) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        const int count = 4 + static_cast<int>(random.index(60));
        const glm::vec3 u = glm::normalize(
            glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const glm::vec3 v = glm::normalize(glm::cross(u, glm::vec3(0.3F, 0.5F, 0.8F)));
        Corners corners;
        double area = 0.0;
        double before = 0.0, first = 0.0;
        const double step = 2.0 * 3.14159265358979 / count;
        for (int i = 0; i < count; ++i) {
            const double radius{random.uniform(0.2F, 3.0F)};
            const double angle = step * i;
            corners.push_back(static_cast<float>(radius * std::cos(angle)) * u +
                              static_cast<float>(radius * std::sin(angle)) * v);
            if (i == 0) first = radius;
            area += 0.5 * std::sin(step) * radius * before;
            before = radius;
        }
        area += 0.5 * std::sin(step) * before * first;
        PolygonFiller filler;
        EXPECT_NEAR(filledArea(filler, corners), area, 1e-4 * area) << round;
        EXPECT_EQ(filler.overlappingCount(), 0U) << round;
    }
}

/// A spiral has two ears; a comb of teeth too many is a fan, and counted.
TEST(PolygonFiller, FillsLongPolygonsUpToItsLimit) {
    Corners spiral;
    const auto at = [](double turns, double radius) {
        return glm::vec3(radius * std::cos(6.2831853 * turns), radius * std::sin(6.2831853 * turns),
                         0.0);
    };
    for (int i = 0; i < 2000; ++i) spiral.push_back(at(i / 100.0, 10.0 + i / 100.0));
    for (int i = 1999; i >= 0; --i) spiral.push_back(at(i / 100.0, 9.6 + i / 100.0));
    PolygonFiller filler;
    filler.fill(spiral);
    EXPECT_EQ(filler.overlappingCount(), 0U);

    Corners comb{{0, -1, 0}};
    for (int i = 0; i < 5000; ++i) comb.emplace_back(i, i % 2, 0);
    std::reverse(comb.begin() + 1, comb.end());
    EXPECT_EQ(filler.fill(comb).size(), comb.size() - 2);
    EXPECT_EQ(filler.overlappingCount(), 1U);
}

}  // namespace
}  // namespace gfxrepro::scene
