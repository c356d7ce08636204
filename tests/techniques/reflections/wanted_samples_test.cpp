// Every tracer writes the samples that are wanted, and leaves the others alone.

#include <functional>
#include <string>

#include "techniques/reflections/gpu_ray_tracer.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflections {
namespace {

using Made = std::unique_ptr<ReflectionTracer>;
using Passes = std::vector<std::string>;

struct Case {
    const char* name;
    std::function<Made(Prepared&)> make;
    float tolerance;  // of what is written beside what all of it together is
    Passes passes;    // of an update and a trace
};

using WantedSamplesTest = ReflectionsTest;

TEST_F(WantedSamplesTest, AreAllThatIsWritten) {
    constexpr glm::ivec2 kSizePx(65, 47);  // no multiple of a group's
    constexpr glm::vec4 kLeftThere(5.0F);
    scene::Scene room = mattRoom({glm::vec3(-2, 0, -2), glm::vec3(2, 2.5F, 2)});
    room.materials[2] = mirror();
    Prepared prepared(shaders, room, camera({0.3F, 1.3F, 1.6F}, {0, 0.3F, -0.6F}), kSizePx);
    const float diagonalM = prepared.scene.diagonalM();
    const Case cases[] = {
        {"environment",
         [&](Prepared& p) -> Made {
             return std::make_unique<EnvironmentTracer>(shaders, p.map, LobeSettings{}, diagonalM);
         },
         0.0F,
         {"environment_map", "intersection"}},
        {"screen space",
         [&](Prepared& p) -> Made {
             return std::make_unique<ScreenSpaceTracer>(shaders, p.map, LobeSettings{}, diagonalM,
                                                        0.3F);
         },
         0.0F,
         {"intersection"}},
        {"compute",
         [&](Prepared& p) -> Made {
             return std::make_unique<GpuRayTracer>(shaders, p.objects, LobeSettings{}, diagonalM);
         },
         0.0F,
         {}},
        {"Embree",
         [&](Prepared& p) -> Made {
             return std::make_unique<EmbreeTracer>(p.scene, LobeSettings{});
         },
         1.0F / 2048.0F,  // halves
         {"bvh_build", "transfer", "intersection"}},
    };
    const HostGBuffer host = readGBuffer(prepared.gbuffer);
    std::vector<std::uint8_t> isWanted(host.depthM.size());
    for (std::size_t i = 0; i < isWanted.size(); ++i) isWanted[i] = i % 3 == 0 ? 1 : 0;
    const std::vector<glm::vec4> before(isWanted.size(), kLeftThere);
    for (const Case& one : cases) {
        SCOPED_TRACE(one.name);
        const Made tracer = one.make(prepared);
        const auto traced = [&](const gl::Texture* wanted) {
            ReflectionTarget target(kSizePx);
            target.radiance.upload(GL_RGBA, GL_FLOAT, before.data());
            tracer->trace(prepared.gbuffer, wanted, target, profiler);
            return std::pair(target.radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1),
                             target.distance.read<float>(GL_RED, GL_FLOAT, 1));
        };
        tracer->update(prepared.objects, profiler);
        const gl::Texture wanted = maskTexture(isWanted, kSizePx);
        const auto [radiance, distanceM] = traced(&wanted);
        Passes passes;
        for (const gl::PassTime& time : profiler.collect()) {
            const bool isCpu = time.clock == gl::PassTime::Clock::Cpu;
            EXPECT_EQ(isCpu, one.name == std::string("Embree"));
            passes.push_back(time.pass);
        }
        if (!one.passes.empty()) {
            EXPECT_EQ(passes, one.passes);
        }

        const auto [all, allDistanceM] = traced(nullptr);
        int written = 0;
        for (std::size_t i = 0; i < isWanted.size(); ++i) {
            if (isWanted[i] == 0 || !host.isReflective(i)) {
                ASSERT_EQ(radiance[i], kLeftThere) << "is left alone";
                continue;
            }
            ++written;
            ASSERT_LE(largestDifference(glm::vec3(radiance[i]), glm::vec3(all[i])), one.tolerance);
            ASSERT_EQ(radiance[i].a, 1.0F);
            ASSERT_EQ(distanceM[i], allDistanceM[i]);
        }
        EXPECT_GT(written, 300);
        const gl::Texture none = maskTexture(std::vector<std::uint8_t>(isWanted.size()), kSizePx);
        EXPECT_EQ(traced(&none).first, before);
        profiler.collect();
    }
}

}  // namespace
}  // namespace gfxrepro::reflections
