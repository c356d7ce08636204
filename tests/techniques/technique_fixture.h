// A technique run whole, as the runner does: parameters, set-up, two repetitions of a frame,
// record.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
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

/// What a technique says against parameters; "": nothing. A case is YAML and what comes behind
/// "case.yaml:1:".
inline void expectRefused(const technique::TechniqueInfo& technique,
                          std::initializer_list<std::pair<const char*, std::string>> cases) {
    for (const auto& [yaml, expected] : cases) {
        const std::string message = errorText([&] {
            Params params = paramsOf(technique, yaml);
            technique.create(params);
        });
        EXPECT_EQ(message, expected.empty() ? "no error" : "case.yaml:1:" + expected) << yaml;
    }
}

/// Derive from it with the technique and the size of its output.
struct TechniqueTest : GlTest {
    TechniqueTest(const technique::TechniqueInfo& technique, const glm::ivec2& outputSizePx)
        : technique_(technique), outputSizePx_(outputSizePx) {}

    /// What is recorded of some of `frameCount` frames, each rendered `repeats` times: a repetition
    /// overwrites what the one before has left.
    std::vector<MetricRecorder> recordedFrames(const std::string& yaml, const scene::Scene* scene,
                                               const std::vector<int>& frames, int frameCount,
                                               int repeats, const technique::TechniqueInfo& info) {
        Params params = paramsOf(info, yaml);
        const auto technique = info.create(params);
        NoScenes scenes;
        technique::SetupContext context{device,        shaders_, scenes,   scene,
                                        outputSizePx_, 1,        profiler_};
        context.shared = shared_;
        if (shared_) shared_->beginCase(std::to_string(frameCount), params.resolved());
        technique::setUp(*technique, context);
        EXPECT_TRUE(profiler_.collect().empty()) << "set-up is not timed by pass";
        const config::Outputs outputs = technique::outputsOf(info);
        std::vector<MetricRecorder> recorders(frames.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            technique::FrameContext frameContext{frames[i], frameCount, profiler_};
            for (int repeat = 0; repeat < repeats; ++repeat) {
                technique->render(frameContext);
                passTimes_ = profiler_.collect();
            }
            passes_.clear();
            for (const gl::PassTime& time : passTimes_) passes_.push_back(time.pass);
            technique->record(recorders[i]);
            technique->recordOnce(recorders[i]);
            recorders[i].expectDeclared(outputs);
            for (const std::string& pass : passes_) EXPECT_TRUE(outputs.hasPass(pass)) << pass;
            EXPECT_TRUE(profiler_.collect().empty()) << "what is recorded is not timed by pass";
        }
        return recorders;
    }
    /// Frame `frame` of `frameCount`, rendered twice.
    MetricRecorder recorded(const std::string& yaml, const scene::Scene* scene, int frame = 0,
                            int frameCount = 1) {
        return recordedFrames(yaml, scene, {frame}, frameCount, 2, technique_).front();
    }

    /// Cases of all of `frameCount` frames that follow one another in a worker record what each
    /// does alone, but for times. Each is "{", what they have in `common`, and its own parameters.
    /// Returns the bytes that they leave to be shared.
    std::size_t expectSharedAsAlone(const std::string& common, const std::vector<std::string>& own,
                                    const scene::Scene& scene, int frameCount = 1) {
        technique::SharedResults shared;
        std::vector<int> frames;
        for (int frame = 0; frame < frameCount; ++frame) frames.push_back(frame);
        for (const std::string& parameters : own) {
            const std::string yaml = "{" + common + parameters + "}";
            SCOPED_TRACE(yaml);
            const auto recordedOf = [&](technique::SharedResults* results) {
                shared_ = results;
                return recordedFrames(yaml, &scene, frames, frameCount, 2, technique_);
            };
            const auto allAlone = recordedOf(nullptr), allShare = recordedOf(&shared);
            shared_ = nullptr;
            for (std::size_t frame = 0; frame < frames.size(); ++frame) {
                const MetricRecorder &alone = allAlone[frame], &shares = allShare[frame];
                EXPECT_EQ(shares.given.size(), alone.given.size());
                for (const auto& [metric, pass] : alone.given) {
                    if (config::isTimeMetric(metric)) continue;
                    const std::string key = metric + (pass.empty() ? "" : "/") + pass;
                    EXPECT_EQ(shares.metrics.at(key), alone.metrics.at(key)) << key;
                }
                EXPECT_EQ(shares.images, alone.images);
            }
        }
        shared.beginCase("", {});
        return shared.otherBytes();
    }

    const technique::TechniqueInfo& technique_;
    technique::SharedResults* shared_ = nullptr;
    glm::ivec2 outputSizePx_;
    gl::ShaderLibrary shaders_{dataFolder("shaders")};
    gl::Profiler profiler_{true};
    std::vector<gl::PassTime> passTimes_;  // of the last frame
    std::vector<std::string> passes_;
};

}  // namespace gfxrepro::test
