
#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>

#include "engine/core/hash.h"
#include "engine/raycast/ray_tracer.h"
#include "engine/scene/animation.h"
#include "scenes/registry.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

Scene generatedBathroom(std::uint64_t seed = 1, const std::string& yaml = "{}") {
    Params params(parseYaml(yaml, "t.yaml"), "generator 'bathroom'");
    return findGenerator(registeredGenerators(), "bathroom", {}).generate(params, seed);
}

const Scene& bathroomScene() {
    static const Scene scene = generatedBathroom();
    return scene;
}

const Mesh& meshOf(const Scene& scene, std::size_t instance) {
    return scene.meshes.at(static_cast<std::size_t>(scene.instances.at(instance).mesh));
}
const Material& materialOf(const Scene& scene, std::size_t instance) {
    return scene.materials.at(static_cast<std::size_t>(meshOf(scene, instance).material));
}
bool isReflector(const Scene& scene, std::size_t instance) {
    return materialOf(scene, instance).roughness == 0.0F;
}
bool isPlanar(const Mesh& mesh) {
    return std::all_of(mesh.normals.begin(), mesh.normals.end(), [&](const glm::vec3& normal) {
        return glm::length(normal - mesh.normals[0]) < 1e-3F;
    });
}

template <class T>
std::string digestOfBathroom(const std::vector<T>& values) {
    return sha256(std::as_bytes(std::span(values)));
}
std::string digestOfBathroom(const Scene& scene) {
    std::string digests;
    for (const Mesh& mesh : scene.meshes) {
        digests += digestOfBathroom(mesh.positions) + digestOfBathroom(mesh.normals) +
                   digestOfBathroom(mesh.colors) + digestOfBathroom(mesh.texcoords) +
                   digestOfBathroom(mesh.triangles);
    }
    for (const image::Image8& texture : scene.textures) {
        digests += sha256(std::as_bytes(texture.values()));
    }
    return sha256(digests);
}

TEST(Bathroom, HasThePrintedCounts) {
    for (const std::uint64_t seed : {1U, 2U, 9U}) {
        SCOPED_TRACE(seed);
        const Scene scene = generatedBathroom(seed);
        std::size_t diffuse = 0, reflective = 0, reflectors = 0;
        std::set<int> meshes;
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            meshes.insert(scene.instances[i].mesh);
            const std::size_t triangles = meshOf(scene, i).triangles.size();
            (isReflector(scene, i) ? reflective : diffuse) += triangles;
            reflectors += isReflector(scene, i);
        }
        EXPECT_EQ(diffuse, 44'000U);
        EXPECT_EQ(reflective, 46'000U);
        EXPECT_EQ(reflectors, 15U);
        EXPECT_EQ(meshes.size(), scene.instances.size());  // an instance, a mesh
    }
}

TEST(Bathroom, ReflectorsAreMirrorsAndAllElseIsDiffuse) {
    const Scene& scene = bathroomScene();
    std::set<std::string> planar;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Material& material = materialOf(scene, i);
        SCOPED_TRACE(material.name);
        if (isReflector(scene, i)) {
            EXPECT_GE(material.metallic, 0.2F);
            EXPECT_LE(material.metallic, 0.95F);
            EXPECT_EQ(material.emissive, glm::vec3(0.0F));
            if (isPlanar(meshOf(scene, i))) planar.insert(material.name);
        } else {
            EXPECT_EQ(material.roughness, 1.0F);
            EXPECT_EQ(material.metallic, 0.0F);
        }
        EXPECT_EQ(material.transmission, 0.0F);
    }
    EXPECT_EQ(planar, (std::set<std::string>{"cabinet_door", "mirror", "wall_panel"}));
}

TEST(Bathroom, MeshesAreSound) {
    for (const Mesh& mesh : bathroomScene().meshes) {
        SCOPED_TRACE(mesh.name);
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
        std::size_t badVertices = 0;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::vec3 p = mesh.positions[i], c = mesh.colors[i];
            // Negations count not-a-number. A window's depth outside the room at most.
            badVertices +=
                !(std::abs(glm::length(mesh.normals[i]) - 1.0F) < 1e-4F) ||
                !(std::min({p.x, p.y, p.z + 0.2F}) > -1e-3F) ||
                !(p.x < 3.401F && p.y < 2.601F && p.z < 4.001F) ||
                !(std::min({c.x, c.y, c.z}) >= 0.0F && std::max({c.x, c.y, c.z}) <= 1.0F);
        }
        EXPECT_EQ(badVertices, 0U);
        std::size_t against = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x];
            const glm::vec3 cross = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
            const glm::vec3 normals = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
            against += !(glm::dot(cross, normals) > 0.0F);
        }
        EXPECT_EQ(against, 0U);
    }
}

TEST(Bathroom, LightsLeaveWhiteBelowSaturation) {
    const Scene& scene = bathroomScene();
    ASSERT_GE(scene.lights.size(), 2U);
    ASSERT_LE(scene.lights.size(), 4U);  // as many as the techniques take
    // Irradiance of the floor and the walls by the formula in scene.h, with the ambient term of
    // techniques/reflections/surfaces.h.
    const auto irradianceAt = [&](const glm::vec3& position, const glm::vec3& normal) {
        glm::vec3 sum(0.30F + 0.10F * normal.y);
        for (const PointLight& light : scene.lights) {
            const glm::vec3 to = light.position - position;
            const float distance = glm::length(to), ratio = distance / light.radiusM;
            sum += light.intensity *
                   (std::max(glm::dot(to, normal) / distance, 0.0F) / (1.0F + ratio * ratio));
        }
        return sum;
    };
    double sum = 0.0;
    float brightest = 0.0F;
    int count = 0;
    for (float x = 0.2F; x < 3.3F; x += 0.3F) {
        for (float z = 0.2F; z < 3.9F; z += 0.3F) {
            const glm::vec3 e = irradianceAt({x, 0.0F, z}, {0.0F, 1.0F, 0.0F});
            brightest = std::max({brightest, e.x, e.y, e.z});
            sum += (e.x + e.y + e.z) / 3.0F;
            ++count;
        }
    }
    EXPECT_LT(brightest, 1.0F);
    EXPECT_GT(sum / count, 0.5);
}

TEST(Bathroom, MotionsMoveWhatStandsFree) {
    const Scene& scene = bathroomScene();
    std::set<std::string> names;
    for (const Motion& motion : scene.motions) {
        names.insert(meshOf(scene, static_cast<std::size_t>(motion.instance)).name);
    }
    EXPECT_EQ(names, (std::set<std::string>{"bulb", "dispenser", "pendant", "shaving_mirror"}));
    EXPECT_EQ(names.size(), scene.motions.size());  // at most one an instance
}

TEST(Bathroom, PathsStayClearOfGeometry) {
    const Scene& scene = bathroomScene();
    const raycast::RayTracer tracer(scene);
    ASSERT_EQ(scene.paths.size(), 3U);
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].name, "overview");
    constexpr int kFrames = 300, kDirections = 200;
    for (const CameraPath& path : scene.paths) {
        SCOPED_TRACE(path.name);
        float nearest = 1e9F;
        std::size_t misses = 0;
        glm::vec3 last = cameraAt(path, 0.0).position;
        for (int frame = 0; frame <= kFrames; ++frame) {
            const Camera camera = cameraAt(path, frame / static_cast<double>(kFrames));
            EXPECT_NEAR(camera.nearM, 0.05F, 1e-6F);
            for (int k = 0; k < kDirections; ++k) {
                const float y = 1.0F - 2.0F * (static_cast<float>(k) + 0.5F) / kDirections;
                const float radius = std::sqrt(1.0F - y * y);
                const float angle = 2.39996F * static_cast<float>(k);
                const auto hit = tracer.closestHit(
                    camera.position, {radius * std::cos(angle), y, radius * std::sin(angle)});
                // The room is shut on all sides.
                misses += !hit.has_value();
                if (hit) nearest = std::min(nearest, hit->distance);
            }
            const glm::vec3 step = camera.position - last;
            if (frame > 0) {
                EXPECT_FALSE(tracer.isOccluded(last, step, 0.0F, glm::length(step)));
            }
            last = camera.position;
        }
        EXPECT_EQ(misses, 0U);
        EXPECT_GT(nearest, 0.25F);
    }
}

struct Shares {
    double average = 0.0, highest = 0.0;              // reflective pixels, %
    double planarAverage = 0.0, planarHighest = 0.0;  // of these, %
};

Shares sharesOf(const Scene& scene, const raycast::RayTracer& tracer, const CameraPath& path) {
    constexpr int kFrames = 30, kSizePx = 48;
    std::vector<bool> reflective, planar;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        reflective.push_back(isReflector(scene, i));
        planar.push_back(isPlanar(meshOf(scene, i)));
    }
    Shares shares;
    for (int frame = 0; frame < kFrames; ++frame) {
        const Camera camera = cameraAt(path, (frame + 0.5) / kFrames);
        const glm::vec3 forward = glm::normalize(camera.target - camera.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float slope = std::tan(0.5F * camera.verticalFovRad);
        double mirrors = 0.0, flats = 0.0;
        for (int pixel = 0; pixel < kSizePx * kSizePx; ++pixel) {
            const glm::vec2 place =
                (glm::vec2(pixel % kSizePx, pixel / kSizePx) + 0.5F) * (2.0F / kSizePx) - 1.0F;
            const auto hit = tracer.closestHit(
                camera.position, forward + slope * (right * place.x + up * place.y), camera.nearM);
            if (!hit || !reflective[hit->instance]) continue;
            ++mirrors;
            flats += planar[hit->instance];
        }
        const double share = 100.0 * mirrors / (kSizePx * kSizePx);
        const double planarShare = mirrors > 0.0 ? 100.0 * flats / mirrors : 0.0;
        shares.average += share / kFrames;
        shares.highest = std::max(shares.highest, share);
        shares.planarAverage += planarShare / kFrames;
        shares.planarHighest = std::max(shares.planarHighest, planarShare);
    }
    return shares;
}

TEST(Bathroom, PathsSeeThePrintedSharesOfReflectors) {
    // [xie2017] Tables 13 and 21.
    constexpr Shares kPrinted[] = {{45.0, 55.0, 17.0, 33.0}, {44.0, 58.0, 20.0, 34.0}};
    const Scene& scene = bathroomScene();
    const raycast::RayTracer tracer(scene);
    for (std::size_t i = 0; i < 2; ++i) {
        SCOPED_TRACE(scene.paths.at(i).name);
        const Shares shares = sharesOf(scene, tracer, scene.paths[i]);
        EXPECT_NEAR(shares.average, kPrinted[i].average, 5.0);
        EXPECT_NEAR(shares.highest, kPrinted[i].highest, 10.0);
        EXPECT_NEAR(shares.planarAverage, kPrinted[i].planarAverage, 5.0);
        EXPECT_NEAR(shares.planarHighest, kPrinted[i].planarHighest, 10.0);
    }
}

TEST(Bathroom, SameBytesOnEveryMachine) {
    // A difference here is a changed generator (then kGeneratorVersion goes up) or a compiler that
    // reorders floating point.
    EXPECT_EQ(digestOfBathroom(bathroomScene()),
              "bd96704f0307c39b9b9ef19196215d854dd19f3fa35b54274634dcd6b5113f15");
    EXPECT_NE(digestOfBathroom(generatedBathroom(3)), digestOfBathroom(generatedBathroom(4)));
}

TEST(Bathroom, HasNoParameters) {
    EXPECT_EQ(errorText([] { generatedBathroom(1, "{triangles: 48}"); }),
              "t.yaml:1:2: generator 'bathroom': unknown parameter 'triangles'; it has none");
}

}  // namespace
}  // namespace gfxrepro::scene
