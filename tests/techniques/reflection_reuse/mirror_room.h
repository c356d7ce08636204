// A room with a mirror for a wall, rendered by reuse and, for truth, traced.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "techniques/reflection_reuse/reuse_renderer.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflection_reuse {

using reflections::HostGBuffer;

/// Of the objects of mirrorRoom().
enum RoomObject { kMirrorWall = 4, kPosts = 6, kBlock = 7, kBall = 8 };

inline scene::Mesh sphere(const glm::vec3& centre, float radius) {
    constexpr unsigned kAround = 48, kUp = 24;
    scene::Mesh mesh;
    for (unsigned j = 0; j <= kUp; ++j) {
        for (unsigned i = 0; i <= kAround; ++i) {
            const float azimuth =
                2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
            const float polar = std::numbers::pi_v<float> * static_cast<float>(j) / kUp;
            const glm::vec3 normal(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                   std::sin(polar) * std::sin(azimuth));
            mesh.positions.push_back(centre + radius * normal);
            mesh.normals.push_back(normal);
            if (j == kUp || i == kAround) continue;
            const unsigned at = j * (kAround + 1) + i;
            const unsigned below = at + kAround + 1;
            mesh.triangles.emplace_back(at, at + 1, below);
            mesh.triangles.emplace_back(at + 1, below + 1, below);
        }
    }
    return mesh;
}

/// Four metres wide, with a mirror for the wall at −z; opposite a row of posts, between them a
/// block and a ball that mirrors.
inline scene::Scene mirrorRoom() {
    using reflections::matt;
    scene::Scene scene;
    scene.name = "mirror_room";
    reflections::addRoom(
        scene, {{-2, -1.5F, -2}, {2, 1.5F, 2}},
        {matt({0.9F, 0.2F, 0.2F}), matt({0.2F, 0.8F, 0.3F}), matt({0.6F, 0.5F, 0.4F}),
         matt({0.8F, 0.8F, 0.8F}), reflections::mirror(), matt({0.3F, 0.4F, 0.9F})});
    scene::MeshBuilder posts;
    for (int i = 0; i < 8; ++i) {
        posts.addBox({-1.75F + 0.5F * static_cast<float>(i), 0, 1.8F}, {0.12F, 1.5F, 0.1F});
    }
    reflections::addPart(scene, posts.take("posts", 0), matt({0.9F, 0.9F, 0.7F}));
    reflections::addPart(scene, reflections::block({{-0.2F, -0.5F, -0.9F}, {0.3F, 0.1F, -0.5F}}),
                         matt({0.9F, 0.8F, 0.1F}));
    reflections::addPart(scene, sphere({-0.9F, -0.4F, -0.9F}, 0.4F), reflections::mirror());
    return scene;
}

/// What was seen of a frame, rows from the bottom.
struct Frame {
    HostGBuffer gbuffer;
    std::vector<glm::vec3> radiance;
    std::vector<std::uint8_t> recomputed;
    ReuseCounts counts;
};

class ReuseTest : public reflections::ReflectionsTest {
  protected:
    static constexpr glm::ivec2 kSize{120, 96};

    /// A scene, its truth, and what reuses reflections in it.
    struct World {
        reflections::ReflectiveScene scene;
        reflections::GpuObjects objects;
        reflections::EnvironmentMap map;
        reflections::EmbreeTracer tracer;
        ReuseRenderer renderer;
        gl::Profiler profiler{true};

        World(const gl::ShaderLibrary& shaders, const scene::Scene& source,
              const ReuseSettings& settings)
            : scene(source),
              objects(scene),
              map(shaders, scene),
              tracer(shaders, scene, map, {}),
              renderer(shaders, objects, tracer, settings, kSize, scene.diagonalM()) {
            map.render(objects);
            tracer.update(objects, profiler);
        }
        /// Puts an object `by` metres from where it is.
        void move(std::size_t object, const glm::vec3& by) {
            std::vector<glm::mat4> poses(objects.poses().begin(), objects.poses().end());
            poses[object][3] += glm::vec4(by, 0.0F);
            objects.setPoses(poses);
            tracer.update(objects, profiler);
        }
        Frame render(const scene::Camera& camera) {
            renderer.render(kit::viewOf(camera, kSize), profiler);
            Frame frame;
            frame.gbuffer = readGBuffer(renderer.gbuffer());
            frame.radiance = renderer.reflection().radiance.read<glm::vec3>(GL_RGB, GL_FLOAT, 1);
            frame.recomputed =
                renderer.recomputed().read<std::uint8_t>(GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1);
            frame.counts = renderer.counts();
            return frame;
        }
        std::vector<reflections::TracedSample> truth(const Frame& frame) const {
            return tracer.trace(frame.gbuffer);
        }
    };

    /// Over the reflective samples; the largest value is 1.
    static double psnrDb(const World& world, const Frame& frame) {
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        double sum = 0.0, count = 0.0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (!frame.gbuffer.isReflective(i)) continue;
            const glm::vec3 error = frame.radiance[i] - truth[i].radiance;
            sum += double{glm::dot(error, error)} / 3.0;
            count += 1.0;
        }
        return -10.0 * std::log10(sum / count);
    }

    static double share(const ReuseCounts& counts) {
        return static_cast<double>(counts.recomputedSamples) / counts.reflectiveSamples;
    }

    /// Before the mirror, looking at it; moved by `x` metres along it.
    static scene::Camera front(float x = 0.0F) {
        return reflections::camera({0.5F + x, 0.2F, 1.2F}, {0.1F + x, 0, -2});
    }
    /// At a wall that does not mirror.
    static scene::Camera atMattWall() {
        return reflections::camera({0.5F, 0.2F, 0}, {0.5F, 0.1F, 2});
    }
};

}  // namespace gfxrepro::reflection_reuse
