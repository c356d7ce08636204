// A room with a mirror for a wall, rendered by reuse and, for truth, traced.
#pragma once

#include <algorithm>
#include <cmath>

#include "techniques/reflection_reuse/reuse_renderer.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflection_reuse {

using reflections::HostGBuffer;

/// Of the objects of mirrorRoom(); behind it is the ball alone.
constexpr std::size_t kBlock = 7;

inline scene::Mesh sphere(const glm::vec3& centre, float radius) {
    return reflections::dome(centre, radius, glm::pi<float>(), 48, 24);
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
    double matchingSteps = 0.0;
};

struct ReuseTest : reflections::ReflectionsTest {
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
              tracer(scene, {}),
              renderer(shaders, objects, tracer, settings, kSize, scene.diagonalM()) {
            map.render(objects);
            tracer.update(objects, profiler);
        }
        Frame render(const scene::Camera& camera) {
            renderer.render(kit::viewOf(camera, kSize), profiler);
            Frame frame;
            frame.gbuffer = readGBuffer(renderer.gbuffer());
            frame.radiance = renderer.reflection().radiance.read<glm::vec3>(GL_RGB, GL_FLOAT, 1);
            frame.recomputed = reflections::readMask(renderer.recomputed());
            frame.counts = renderer.counts();
            if (!frame.counts.isKeyFrame && renderer.shifted()) {
                frame.matchingSteps =
                    countMatches(renderer.keyFrame(), renderer.offsets()).meanSteps();
            }
            return frame;
        }
        std::vector<reflections::TracedSample> truth(const Frame& frame) const {
            return tracer.trace(frame.gbuffer);
        }
    };

    /// Over the reflective samples; the largest value is 1.
    static double psnrDb(const World& world, const Frame& frame) {
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        return reflections::psnrDb(frame.gbuffer, frame.radiance,
                                   [&](std::size_t i) { return truth[i].radiance; });
    }

    /// Over the reflective samples, of any channel, from `radianceOf(sample)`.
    template <class RadianceOf>
    static float largestError(const Frame& frame, const RadianceOf& radianceOf) {
        float largest = 0.0F;
        reflections::forEachReflective(frame.gbuffer, [&](glm::ivec2, std::size_t i) {
            largest =
                std::max(largest, reflections::largestDifference(frame.radiance[i], radianceOf(i)));
        });
        return largest;
    }
    static float largestError(const World& world, const Frame& frame) {
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        return largestError(frame, [&](std::size_t i) { return truth[i].radiance; });
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
