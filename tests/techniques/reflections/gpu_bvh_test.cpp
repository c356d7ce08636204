// The device's BVH: a tree with boxes that hold what is below, and Embree's hits.
#include "techniques/reflections/gpu_ray_tracer.h"

#include <fmt/format.h>
#include <algorithm>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "engine/raycast/ray_tracer.h"
#include "engine/scene/load.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

struct Ray {
    glm::vec3 origin;
    float tMin;
    glm::vec3 direction;  // unit
    float tMax;
};
struct DeviceHit {
    float t;
    std::uint32_t triangle;
    glm::vec2 barycentric;
};
constexpr std::uint32_t kNone = 0xFFFFFFFFU;

constexpr const char* kTraceShader = R"(#version 450 core
#include "reflections/bvh.glsl"
layout(local_size_x = 64) in;
struct Ray { vec3 origin; float tMin; vec3 direction; float tMax; };
struct Hit { float t; uint triangle; vec2 barycentric; };
layout(std430) readonly buffer Rays { Ray rays[]; };
layout(std430) writeonly buffer Hits { Hit hits[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(rays.length())) return;
    RayHit hit;
    bool isHit = closestHit(rays[i].origin, rays[i].direction, rays[i].tMin, rays[i].tMax, hit);
    hits[i] = Hit(hit.t, isHit ? hit.triangle : 0xFFFFFFFFu, hit.barycentric);
}
)";

/// What differs from Embree, in rays.
struct Differences {
    std::size_t hits = 0;  // of Embree
    /// One hits and the other does not, or at another distance …
    std::size_t grazes = 0;         // … at the edge of the triangle in question
    std::size_t others = 0;         // … elsewhere
    std::size_t otherTriangle = 0;  // at the same distance: shared edges and overlaid triangles
    std::size_t barycentrics = 0;   // of the same triangle, by more than 1e-3
};

struct GpuBvhTest : ReflectionsTest {
    void pose(const scene::Scene& scene) {
        reflective_.emplace(scene);
        objects_.emplace(*reflective_);
        bvh_.emplace(shaders, *objects_);
        posed_ = reflective_->scene();
        bvh_->build(profiler);
    }
    void move(std::span<const glm::mat4> poses) {
        objects_->setPoses(poses);
        for (std::size_t i = 0; i < poses.size(); ++i) posed_.instances[i].worldFromMesh = poses[i];
        bvh_->build(profiler);
    }

    std::vector<DeviceHit> trace(const std::vector<Ray>& rays) {
        // Written beside copies of the includes, as a library has one folder.
        const gl::Buffer rayBuffer = gl::Buffer::of(rays);
        const gl::Buffer hits(rays.size() * sizeof(DeviceHit));
        for (const char* name : {"bvh.glsl", "bvh_layout.glsl"}) {
            const auto path = dataFolder("shaders") / "reflections" / name;
            folder.write(fmt::format("reflections/{}", name), readFile(path));
        }
        const gl::Pass trace = pass({{"trace.comp.glsl", kTraceShader}});
        trace.dispatch({(rays.size() + 63) / 64, 1, 1},
                       gl::Resources{{"Rays", rayBuffer}, {"Hits", hits}}.with(bvh_->resources()));
        return hits.read<DeviceHit>(rays.size());
    }

    Differences compare(const std::vector<Ray>& rays) {
        const raycast::RayTracer truth(posed_);
        // A ray that starts near a triangle's plane: coordinates are rounded, not distances.
        const float roundingM = 1e-5F * glm::length(posed_.bounds().size());
        const std::vector<DeviceHit> hits = trace(rays);
        Differences differences;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto expected =
                truth.closestHit(rays[i].origin, rays[i].direction, rays[i].tMin, rays[i].tMax);
            const std::uint32_t expectedTriangle = expected ? expected->flattenedTriangle : kNone;
            const DeviceHit& hit = hits[i];
            differences.hits += expected.has_value();
            if (!expected && hit.triangle == kNone) continue;
            const bool isSameDistance =
                expected && hit.triangle != kNone &&
                std::abs(hit.t - expected->distance) <= 1e-4F * expected->distance + roundingM;
            if (!isSameDistance) {
                const bool isGraze =
                    (expected && isAtEdge(truth, rays[i], expectedTriangle)) ||
                    (hit.triangle != kNone && isAtEdge(truth, rays[i], hit.triangle));
                ++(isGraze ? differences.grazes : differences.others);
            } else if (hit.triangle != expectedTriangle) {
                ++differences.otherTriangle;
            } else if (glm::length(hit.barycentric - expected->barycentric) > 1e-3F) {
                ++differences.barycentrics;
            }
        }
        // Of the device and Embree, which round differently, at most 1 ray in 10,000 each.
        EXPECT_LE(differences.grazes, 1 + rays.size() / 10'000);
        EXPECT_EQ(differences.others, 0U);
        return differences;
    }

    /// Whether a ray passes a triangle within 1e-4 of its size at an edge, in double precision:
    /// rounding may then decide whether it is met.
    static bool isAtEdge(const raycast::RayTracer& truth, const Ray& ray, std::uint32_t triangle) {
        const raycast::WorldTriangle corners = truth.triangle(triangle);
        const glm::dvec3 a(corners.corners[0]);
        const glm::dvec3 ab = glm::dvec3(corners.corners[1]) - a;
        const glm::dvec3 ac = glm::dvec3(corners.corners[2]) - a;
        const glm::dvec3 normal = glm::cross(ab, ac), direction(ray.direction);
        const glm::dvec3 origin = glm::dvec3(ray.origin) - a;
        const glm::dvec3 point =
            origin - glm::dot(origin, normal) / glm::dot(direction, normal) * direction;
        const double ofB = glm::dot(glm::cross(point, ac), normal) / glm::dot(normal, normal);
        const double ofC = glm::dot(glm::cross(ab, point), normal) / glm::dot(normal, normal);
        return std::abs(std::min({ofB, ofC, 1.0 - ofB - ofC})) < 1e-4;
    }

    /// From points in and around the box into random directions.
    std::vector<Ray> randomRays(std::size_t count, float tMin = 0.0F, float tMax = 1e30F) {
        const scene::Box box = posed_.bounds();
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 place = randomIn(random_, -1.0F, 1.0F);
            rays.push_back({box.centre() + 0.75F * place * (box.size() + 0.1F), tMin,
                            glm::normalize(randomIn(random_, -1.0F, 1.0F)), tMax});
        }
        return rays;
    }

    /// Every node and leaf is reached once from the root, its box holding what is below.
    void expectTree() {
        const auto nodes = bvh_->nodes().read<GpuBvh::Node>(bvh_->nodeCount());
        const auto leaves = bvh_->triangles().read<GpuBvh::Triangle>(bvh_->triangleCount());
        std::vector<int> nodeVisits(nodes.size()), leafVisits(leaves.size());
        std::vector<int> triangleVisits(leaves.size());
        std::size_t deepest = 0, boxesOff = 0;
        struct Visit {
            std::uint32_t child;
            scene::Box box;
            std::size_t depth;
        };
        const scene::Box all{glm::vec3(-INFINITY), glm::vec3(INFINITY)};
        std::vector<Visit> stack = {{0, all, 0}};
        const auto isInside = [](const glm::vec3& p, const scene::Box& box) {
            return glm::all(glm::lessThanEqual(box.min, p)) &&
                   glm::all(glm::lessThanEqual(p, box.max));
        };
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            deepest = std::max(deepest, visit.depth);
            if ((visit.child & GpuBvh::kLeaf) != 0) {
                const std::uint32_t leaf = visit.child & ~GpuBvh::kLeaf;
                ASSERT_LT(leaf, leaves.size());
                ++leafVisits[leaf];
                ASSERT_LT(leaves[leaf].triangle, leaves.size());
                ++triangleVisits[leaves[leaf].triangle];
                for (const glm::vec3& p : {leaves[leaf].a, leaves[leaf].b, leaves[leaf].c}) {
                    boxesOff += !isInside(p, visit.box);
                }
                continue;
            }
            ASSERT_LT(visit.child, nodes.size());
            ASSERT_EQ(++nodeVisits[visit.child], 1);
            const GpuBvh::Node& node = nodes[visit.child];
            for (const glm::vec3& p : {node.leftMin, node.leftMax, node.rightMin, node.rightMax}) {
                boxesOff += !isInside(p, visit.box);
            }
            stack.push_back({node.left, {node.leftMin, node.leftMax}, visit.depth + 1});
            stack.push_back({node.right, {node.rightMin, node.rightMax}, visit.depth + 1});
        }
        const int leafReaches = leaves.size() == 1 ? 2 : 1;  // the only leaf is both children
        for (const int visits : nodeVisits) ASSERT_EQ(visits, 1);
        for (const int visits : leafVisits) ASSERT_EQ(visits, leafReaches);
        for (const int visits : triangleVisits) ASSERT_EQ(visits, leafReaches);
        EXPECT_EQ(boxesOff, 0U);
        EXPECT_LE(deepest, 62U) << "the stack of bvh.glsl holds 64";
    }

    Random random_{11};
    std::optional<ReflectiveScene> reflective_;
    std::optional<GpuObjects> objects_;
    std::optional<GpuBvh> bvh_;
    scene::Scene posed_;
};

/// Triangles with corners near random points of a cube.
scene::Mesh soup(std::size_t count, float size, unsigned seed) {
    Random random(seed);
    scene::Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 centre = randomIn(random, -1.0F, 1.0F);
        for (int corner = 0; corner < 3; ++corner) {
            mesh.positions.push_back(centre + size * randomIn(random, -1.0F, 1.0F));
        }
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

TEST_F(GpuBvhTest, MeetsWhatEmbreeMeetsInSoups) {
    for (const auto& [count, size] : {std::pair{1000U, 0.1F}, {20'000U, 0.05F}, {50U, 1.0F}}) {
        pose(scene::sceneOf(soup(count, size, count)));
        expectTree();
        for (const auto& rays : {randomRays(20'000), randomRays(20'000, 0.2F, 0.7F)}) {
            const Differences differences = compare(rays);
            EXPECT_GT(differences.hits, rays.size() / 50);
            EXPECT_EQ(differences.otherTriangle, 0U) << count;
            EXPECT_EQ(differences.barycentrics, 0U) << count;
        }
    }
}

TEST_F(GpuBvhTest, TakesFewTriangles) {
    for (const std::size_t count : {1U, 2U, 3U, 5U}) {
        pose(scene::sceneOf(soup(count, 1.0F, 3)));
        expectTree();
        const Differences differences = compare(randomRays(5'000));
        EXPECT_GT(differences.hits, 50U);
        EXPECT_EQ(differences.otherTriangle, 0U) << count;
    }
}

TEST_F(GpuBvhTest, TellsEqualCentresApartByTheirPlaces) {
    // Many triangles of one centre, so of one code; and exact copies of a single one.
    scene::Mesh fan;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const float angle = static_cast<float>(i);
        const glm::vec3 reach(std::cos(angle), std::sin(angle), 0.2F * std::sin(0.37F * angle));
        fan.positions.insert(fan.positions.end(), {reach, -reach, 0.9F * reach});
        fan.positions.back() = glm::vec3(0.3F * reach.y, -0.3F * reach.x, 0.0F);
        fan.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    pose(scene::sceneOf(fan));
    expectTree();
    EXPECT_GT(compare(randomRays(5'000)).hits, 50U);

    const scene::Mesh one = soup(1, 1.0F, 5);
    scene::Mesh copies{.positions = one.positions};
    copies.triangles.assign(5000, one.triangles.front());
    pose(scene::sceneOf(copies));
    expectTree();
    EXPECT_GT(compare(randomRays(5'000)).hits, 50U);
}

TEST_F(GpuBvhTest, PassesThroughTrianglesWithoutArea) {
    scene::Mesh mesh = soup(200, 0.5F, 6);
    for (std::size_t i = 0; i < 100; ++i) {
        const glm::uvec3 t = mesh.triangles[i];
        mesh.positions[t.y] =
            i % 2 == 0 ? mesh.positions[t.x] : 0.5F * (mesh.positions[t.x] + mesh.positions[t.z]);
    }
    for (std::size_t i = 0; i < 20; ++i) {
        mesh.positions[mesh.triangles[i].z] = mesh.positions[mesh.triangles[i].x];
    }
    pose(scene::sceneOf(mesh));
    expectTree();
    const Differences differences = compare(randomRays(20'000));
    EXPECT_GT(differences.hits, 1000U);
    EXPECT_EQ(differences.otherTriangle, 0U);
}

// Rays through the corners and along the faces and axes of a closed box: no direction component or
// flat box of a node may make them slip.
TEST_F(GpuBvhTest, LeavesNoGapBetweenTriangles) {
    scene::MeshBuilder builder;
    for (const auto [x, z] : test::grid(4, 4)) builder.addBox(glm::vec3(x, 0, z), glm::vec3(0.5F));
    pose(scene::sceneOf(builder.take("boxes", -1)));
    std::vector<Ray> rays;
    const auto step = [&] { return 0.5F * static_cast<float>(random_.index(9)) - 0.5F; };
    for (int i = 0; i < 20'000; ++i) {
        // From above towards points of the faces' half-grid: corners, edges, diagonals.
        const glm::vec3 target{step(), 0.5F, step()};
        const bool isInside =
            target.x > -0.5F && target.x < 3.5F && target.z > -0.5F && target.z < 3.5F;
        if (!isInside) continue;
        const glm::vec3 origin = i % 3 == 0 ? target + glm::vec3(0, 2, 0)
                                            : glm::vec3(0.37F * static_cast<float>(i % 11), 3.0F,
                                                        0.29F * static_cast<float>(i % 13));
        rays.push_back({origin, 0.0F, glm::normalize(target - origin), 1e30F});
    }
    ASSERT_GT(rays.size(), 5000U);
    std::size_t lost = 0;
    for (const DeviceHit& hit : trace(rays)) lost += hit.triangle == kNone || hit.t > 10.0F;
    EXPECT_EQ(lost, 0U);
}

TEST_F(GpuBvhTest, FollowsMovedObjects) {
    scene::Scene scene = scene::sceneOf(soup(3000, 0.1F, 8));
    scene.meshes.push_back(soup(1000, 0.2F, 9));
    scene.instances.push_back({.mesh = 1});
    scene.instances.push_back(
        {.mesh = 0, .worldFromMesh = glm::translate(glm::mat4(1.0F), {2.5F, 0, 0})});
    pose(scene);
    EXPECT_GT(compare(randomRays(10'000)).hits, 500U);
    const glm::mat4 poses[] = {
        glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3(1, 2, 3))),
        glm::scale(glm::translate(glm::mat4(1.0F), {0.0F, 4.0F, -7.0F}), {2.0F, -0.5F, 1.0F}),
        glm::translate(glm::mat4(1.0F), {-30.0F, 0.2F, 0.1F}),
    };
    move(poses);
    expectTree();
    const Differences differences = compare(randomRays(40'000));
    EXPECT_GT(differences.hits, 500U);
    EXPECT_EQ(differences.otherTriangle, 0U);
}

TEST_F(GpuBvhTest, MeetsWhatEmbreeMeetsOnTheBunny) {
    const auto path = test::asset("bunny/bun_zipper.ply");
    if (!path) GTEST_SKIP() << "GFXREPRO_ASSETS has no bunny/bun_zipper.ply";
    pose(scene::loadScene(*path));
    expectTree();
    const auto rays = randomRays(100'000);
    const Differences differences = compare(rays);
    EXPECT_GT(differences.hits, 5000U);
    // A closed mesh of shared edges: rays through one may be reported for either triangle.
    EXPECT_LE(differences.otherTriangle, rays.size() / 10'000);
}

// The device's sort against std::stable_sort.

struct RadixSortTest : test::GlTest {
    /// Sorts keys with their places as values; values tell whether equal keys kept their order.
    void expectSorted(const std::vector<std::uint32_t>& keys, std::uint32_t keyBits,
                      std::size_t capacity) {
        std::vector<glm::uvec2> pairs(capacity, glm::uvec2(0));
        for (std::uint32_t i = 0; i < keys.size(); ++i) pairs[i] = {keys[i], i};
        std::vector<glm::uvec2> expected(pairs.begin(),
                                         pairs.begin() + static_cast<std::ptrdiff_t>(keys.size()));
        std::stable_sort(expected.begin(), expected.end(),
                         [](const glm::uvec2& a, const glm::uvec2& b) { return a.x < b.x; });
        gl::Buffer buffer = gl::Buffer::of(pairs);
        RadixSort sort(shaders_, static_cast<std::uint32_t>(capacity));
        sort.sort(buffer, static_cast<std::uint32_t>(keys.size()), keyBits);
        EXPECT_TRUE(buffer.read<glm::uvec2>(keys.size()) == expected)
            << keys.size() << " keys of " << keyBits << " bits";
    }
    std::vector<std::uint32_t> randomKeys(std::size_t count, std::uint32_t keyBits) {
        std::vector<std::uint32_t> keys(count);
        for (std::uint32_t& key : keys) key = random_.next() >> (32 - keyBits);
        return keys;
    }

    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    Random random_{7};
};

TEST_F(RadixSortTest, AgreesWithAStableSort) {
    for (const std::size_t count : {1U, 2U, 63U, 64U, 65U, RadixSort::kTileSize - 1,
                                    RadixSort::kTileSize, RadixSort::kTileSize + 1, 50'001U}) {
        expectSorted(randomKeys(count, 30), 30, count);
    }
}

TEST_F(RadixSortTest, KeepsTheOrderOfEqualKeys) {
    expectSorted(randomKeys(30'000, 2), 30, 30'000);  // four different keys
    expectSorted(std::vector<std::uint32_t>(30'000, 0x3FFFFFFFU), 30, 30'000);
}

TEST_F(RadixSortTest, TakesOtherWidthsAndLessThanItsCapacity) {
    expectSorted(randomKeys(5'000, 1), 1, 5'000);
    expectSorted(randomKeys(5'000, 12), 12, 5'000);
    expectSorted(randomKeys(5'000, 32), 32, 5'000);
    expectSorted(randomKeys(5'000, 30), 30, 9'000);
}

TEST_F(RadixSortTest, SortsNothingAtAll) {
    gl::Buffer pairs = gl::Buffer::of(std::vector<glm::uvec2>{{5, 6}});
    RadixSort(shaders_, 1).sort(pairs, 0, 30);
    EXPECT_EQ(pairs.read<glm::uvec2>(1).front(), glm::uvec2(5, 6));
}

}  // namespace
}  // namespace gfxrepro::reflections
