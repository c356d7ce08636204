// A technique run whole, as the runner does: parameters, set-up, two repetitions of a frame,
// record.
#pragma once

#include <string>
#include <vector>

#include "engine/core/files.h"
#include "runner/technique/technique.h"
#include "tests/gl/gl_fixture.h"
#include "tests/techniques/technique_recorder.h"

namespace gfxrepro::test {

/// The parameters of a case, for the technique's constructor.
inline Params paramsOf(const technique::TechniqueInfo& technique, const std::string& yaml) {
    return Params(parseYaml(yaml, "case.yaml"), "technique '" + std::string(technique.name) + "'");
}

/// Derive from it with the technique and the size of its output.
class TechniqueTest : public GlTest {
  protected:
    TechniqueTest(const technique::TechniqueInfo& technique, const glm::ivec2& outputSizePx)
        : technique_(technique), outputSizePx_(outputSizePx) {}

    /// Frame `frame` of `frameCount`, rendered twice: a repetition overwrites what the first has
    /// left. passes_ then names the second's passes.
    MetricRecorder recorded(const std::string& yaml, const scene::Scene* scene, int frame = 0,
                            int frameCount = 1) {
        Params params = paramsOf(technique_, yaml);
        const auto technique = technique_.create(params);
        NoScenes scenes;
        technique::SetupContext context{device,        shaders_, scenes,   scene,
                                        outputSizePx_, 1,        profiler_};
        context.shared = shared_;
        if (shared_) shared_->beginCase("", params.resolved());
        technique::setUp(*technique, context);
        EXPECT_TRUE(profiler_.collect().empty()) << "set-up is not timed by pass";
        technique::FrameContext frameContext{frame, frameCount, profiler_};
        technique->render(frameContext);
        profiler_.collect();
        technique->render(frameContext);
        passes_.clear();
        for (const gl::PassTime& time : profiler_.collect()) passes_.push_back(time.pass);
        MetricRecorder recorder;
        technique->record(recorder);
        technique->recordOnce(recorder);
        const config::Outputs outputs = technique::outputsOf(technique_);
        recorder.expectDeclared(outputs);
        for (const std::string& pass : passes_) EXPECT_TRUE(outputs.hasPass(pass)) << pass;
        EXPECT_TRUE(profiler_.collect().empty()) << "what is recorded is not timed by pass";
        return recorder;
    }

    /// Cases that follow one another in a worker record what each does alone, but for times.
    void expectSharedAsAlone(const std::vector<std::string>& yamls, const scene::Scene& scene) {
        technique::SharedResults shared;
        for (const std::string& yaml : yamls) {
            SCOPED_TRACE(yaml);
            const MetricRecorder alone = recorded(yaml, &scene);
            shared_ = &shared;
            const MetricRecorder shares = recorded(yaml, &scene);
            shared_ = nullptr;
            ASSERT_EQ(shares.given.size(), alone.given.size());
            for (std::size_t i = 0; i < alone.given.size(); ++i) {
                const auto& [metric, unit, pass] = alone.given[i];
                if (unit.ends_with("ms") || unit.ends_with("/s")) continue;
                const std::string key = metric + (pass.empty() ? "" : "/") + pass;
                EXPECT_EQ(shares.metrics.at(key), alone.metrics.at(key)) << key;
            }
            EXPECT_EQ(shares.images, alone.images);
        }
        shared.beginCase("", {});
        sharedBytes_ = shared.otherBytes();
    }

    const technique::TechniqueInfo& technique_;
    technique::SharedResults* shared_ = nullptr;
    std::size_t sharedBytes_ = 0;  // that these cases have left
    glm::ivec2 outputSizePx_;
    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    gl::Profiler profiler_{true};
    std::vector<std::string> passes_;
};

}  // namespace gfxrepro::test
