// Scenes whose reflections can be worked out by hand, and what the tests of tracers share.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "techniques/reflections/embree_tracer.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {

inline scene::Material matt(const glm::vec3& colour) {
    return scene::Material{.baseColor = glm::vec4(colour, 1.0F)};
}
inline scene::Material glowing(const glm::vec3& colour) {
    scene::Material material = matt(glm::vec3(0.0F));
    material.emissive = colour;
    return material;
}
inline scene::Material mirror(float glossiness = 0.0F) {
    scene::Material material = matt(glm::vec3(0.4F, 0.3F, 0.2F));
    material.metallic = 1.0F;
    material.roughness = glossiness;
    return material;
}

/// The inside of a box: walls −x, +x, −y (the floor), +y, −z, +z are objects 0 to 5.
inline void addRoom(scene::Scene& scene, const scene::Box& box,
                    const std::vector<scene::Material>& materials) {
    const glm::vec3 half = 0.5F * box.size();
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        glm::vec3 centre = box.centre(), u(0.0F), v(0.0F);
        centre[axis] = side % 2 == 0 ? box.min[axis] : box.max[axis];
        u[(axis + 1) % 3] = half[(axis + 1) % 3];
        v[(axis + 2) % 3] = half[(axis + 2) % 3];
        addPart(scene, rectangle(centre, u, v), materials[static_cast<std::size_t>(side)]);
    }
}

constexpr glm::vec3 kWallColours[6] = {{0.9F, 0.2F, 0.2F}, {0.2F, 0.8F, 0.3F}, {0.6F, 0.5F, 0.4F},
                                       {0.8F, 0.8F, 0.8F}, {0.3F, 0.4F, 0.9F}, {0.9F, 0.8F, 0.3F}};
/// Walls of these colours.
inline scene::Scene mattRoom(const scene::Box& box) {
    scene::Scene scene{.name = "room"};
    std::vector<scene::Material> materials;
    for (const glm::vec3& colour : kWallColours) materials.push_back(matt(colour));
    addRoom(scene, box, materials);
    return scene;
}

/// A closed box, one object.
inline scene::Mesh block(const scene::Box& box) {
    scene::Scene sides;
    addRoom(sides, box, std::vector<scene::Material>(6));
    return scene::flattened(sides);
}

/// Where a ray from inside meets the walls of a box, in double precision.
struct WallHit {
    double distanceM = 0.0;
    int side = 0;  // as addRoom() counts them
    glm::dvec3 position{0.0};
    glm::vec3 normal{0.0F};      // into the room
    double edgeDistanceM = 0.0;  // to the next wall
};
inline WallHit wallHit(const scene::Box& box, const glm::dvec3& origin,
                       const glm::dvec3& direction) {
    WallHit hit{.distanceM = std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) continue;
        const bool isUpper = direction[axis] > 0.0;
        const double wall = double{isUpper ? box.max[axis] : box.min[axis]};
        const double distance = (wall - origin[axis]) / direction[axis];
        if (distance >= hit.distanceM) continue;
        hit.distanceM = distance;
        hit.side = 2 * axis + (isUpper ? 1 : 0);
        hit.normal = glm::vec3(0.0F);
        hit.normal[axis] = isUpper ? -1.0F : 1.0F;
    }
    hit.position = origin + hit.distanceM * direction;
    hit.edgeDistanceM = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (axis == hit.side / 2) continue;
        hit.edgeDistanceM = std::min({hit.edgeDistanceM, hit.position[axis] - double{box.min[axis]},
                                      double{box.max[axis]} - hit.position[axis]});
    }
    return hit;
}

inline scene::Camera camera(const glm::vec3& position, const glm::vec3& target) {
    return scene::Camera{.position = position,
                         .target = target,
                         .verticalFovRad = 0.9F,
                         .nearM = 0.05F,
                         .farM = 50.0F};
}

/// A scene ready to be traced, drawn from one view; `glossiness` is that of all reflectors.
struct Prepared {
    ReflectiveScene scene;
    GpuObjects objects;
    EnvironmentMap map;
    GBufferRenderer renderer;
    GBuffer gbuffer;

    Prepared(const gl::ShaderLibrary& shaders, const scene::Scene& source,
             const scene::Camera& from, glm::ivec2 sizePx, std::optional<float> glossiness = {})
        : scene([&] {
              ReflectiveScene result(source);
              if (glossiness) result.setGlossiness(*glossiness);
              return result;
          }()),
          objects(scene),
          map(shaders, scene),
          renderer(shaders, scene),
          gbuffer(kit::viewOf(from, sizePx)) {
        map.render(objects);
        renderer.render(objects, gbuffer);
    }
};

/// Also traced by Embree.
struct EmbreeTrace {
    Prepared prepared;
    EmbreeTracer tracer;
    HostGBuffer gbuffer;
    std::vector<TracedSample> samples;

    EmbreeTrace(const gl::ShaderLibrary& shaders, const scene::Scene& source,
                const scene::Camera& from, glm::ivec2 sizePx, const LobeSettings& lobe,
                gl::Profiler& profiler)
        : prepared(shaders, source, from, sizePx), tracer(prepared.scene, lobe) {
        tracer.update(prepared.objects, profiler);
        gbuffer = readGBuffer(prepared.gbuffer);
        samples = tracer.trace(gbuffer);
    }
};

struct TracerTest : ReflectionsTest {
    EmbreeTrace trace(const scene::Scene& source, const scene::Camera& from, glm::ivec2 sizePx,
                      const LobeSettings& lobe = {}) {
        return {shaders, source, from, sizePx, lobe, profiler};
    }
};

/// Of the samples that reflect; the maximum is 1.
template <class Expected>
double psnrDb(const HostGBuffer& gbuffer, const std::vector<glm::vec3>& radiance,
              const Expected& expected) {
    double sum = 0.0;
    const int count = forEachReflective(gbuffer, [&](glm::ivec2, std::size_t i) {
        const glm::vec3 error = radiance[i] - expected(i);
        sum += double{glm::dot(error, error)} / 3.0;
    });
    return -10.0 * std::log10(sum / count);
}

inline float largestDifference(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 difference = glm::abs(a - b);
    return std::max({difference.x, difference.y, difference.z});
}

}  // namespace gfxrepro::reflections
