// A device, and whole traces of small scenes read back.
#pragma once

#include <cmath>

#include "engine/image/srgb.h"
#include "techniques/clustered_reflections/clustered_tracer.h"
#include "techniques/reflections/gbuffer.h"
#include "tests/gl/suite_device.h"
#include "tests/techniques/clustered_reflections/mirror_rooms.h"
#include "tests/techniques/reflections/gl_calls.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::clustered_reflections {

/// One frame, in the host's memory; rows from the bottom.
struct Traced {
    reflections::HostGBuffer gbuffer;
    std::vector<glm::vec3> radiance;
    std::vector<float> distanceM;
    std::vector<std::uint8_t> environment;
    std::vector<ClusterCamera> cameras;
    std::vector<std::uint16_t> clusterOfSample;
    ClusteredTracer::Drawn drawn;
    std::size_t sizeBytes = 0;
    std::vector<gl::PassTime> passes;
    std::vector<reflections::GlCall> calls;

    /// Calls action(pixel, index) for the reflective samples; returns how many there are.
    template <class Action>
    int forEachReflective(Action&& action) const {
        return reflections::forEachReflective(gbuffer, action);
    }
    int reflectiveCount() const {
        return forEachReflective([](glm::ivec2, std::size_t) {});
    }
    bool isFinite() const {
        bool isFinite = true;
        forEachReflective([&](glm::ivec2, std::size_t i) {
            const glm::vec3& c = radiance[i];
            isFinite = isFinite && std::isfinite(c.x + c.y + c.z + distanceM[i]);
        });
        return isFinite;
    }
};

struct TracerTest : test::SuiteDeviceTest {
    static Traced trace(const reflections::ReflectiveScene& scene, const scene::Camera& camera,
                        ClusteredSettings settings, int sizePx = 128) {
        settings.camera.diagonalM = scene.diagonalM();
        const reflections::GpuObjects objects(scene);
        reflections::GBuffer gbuffer(kit::viewOf(camera, glm::ivec2(sizePx)), false);
        reflections::GBufferRenderer(shaders(), scene).render(objects, gbuffer);
        reflections::EnvironmentMap map(shaders(), scene);
        map.render(objects);
        reflections::ReflectionTarget target{glm::ivec2(sizePx)};
        gl::Profiler profiler(false);
        ClusteredTracer tracer(shaders(), scene, objects, map, settings, glm::ivec2(sizePx));
        reflections::glCalls().clear();
        tracer.update(objects, profiler);
        tracer.trace(gbuffer, nullptr, target, profiler);

        Traced traced;
        traced.calls = reflections::glCalls();
        traced.gbuffer = readGBuffer(gbuffer);
        traced.radiance = target.radiance.read<glm::vec3>(GL_RGB, GL_FLOAT, 1);
        traced.distanceM = target.distance.read<float>(GL_RED, GL_FLOAT, 1);
        traced.environment = tracer.environmentSamples();
        traced.cameras = tracer.cameras();
        traced.clusterOfSample = tracer.clusters().clusterOfSample.read<std::uint16_t>(
            GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1);
        traced.drawn = tracer.drawn();
        traced.sizeBytes = tracer.sizeBytes() + gbuffer.sizeBytes() + target.sizeBytes();
        traced.passes = profiler.collect();
        return traced;
    }

    /// Of the samples that reflect; the maximum is 1.
    template <class Expected>
    static double psnrDb(const Traced& traced, const Expected& expected) {
        return reflections::psnrDb(traced.gbuffer, traced.radiance, expected);
    }

    /// The same of the means of 2 × 2 samples as they are shown, where all four are reflective.
    static double shownPsnrDb(const Traced& traced, const std::vector<glm::vec3>& expected) {
        const auto width = static_cast<std::size_t>(traced.gbuffer.view.sizePx.x);
        double sum = 0.0, count = 0.0;
        for (std::size_t i = 0; i + width + 1 < traced.radiance.size(); i += 2) {
            if (i / width % 2 == 1) continue;
            glm::vec3 mean(0.0F), expectedMean(0.0F);
            bool isWhole = true;
            for (const std::size_t k : {i, i + 1, i + width, i + width + 1}) {
                isWhole = isWhole && traced.gbuffer.isReflective(k);
                mean += 0.25F * traced.radiance[k];
                expectedMean += 0.25F * expected[k];
            }
            if (!isWhole) continue;
            for (int channel = 0; channel < 3; ++channel) {
                const float error =
                    image::srgbOf(mean[channel]) - image::srgbOf(expectedMean[channel]);
                sum += error * error / 3.0F;
            }
            count += 1.0;
        }
        return -10.0 * std::log10(sum / count);
    }
};

}  // namespace gfxrepro::clustered_reflections
