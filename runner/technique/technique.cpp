#include "runner/technique/technique.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "runner/config/external_program.h"

namespace gfxrepro::technique {

void Recorder::share(std::string_view name, double part, double whole, std::string_view unit,
                     std::string_view pass) {
    if (whole == 0.0) return;
    metric(name, 100.0 * part / whole, pass);
    metric(std::string(name).append(config::kShareOf), whole, pass, unit);
}

std::span<const config::MetricInfo> commonMetrics() {
    using config::Better;
    using Of = config::MetricInfo::Of;
    constexpr bool kIsDetail = true, kIsOfSetup = true;
    static const std::vector<config::MetricInfo> metrics = {
        {"wall_time_ms", "ms", "time of a frame, from the first call until the device is done",
         Better::Lower, false, Of::Whole},
        {"gpu_time_ms", "ms", "time of a pass, by the device's clock", Better::Lower, false,
         Of::Pass},
        {"cpu_time_ms", "ms", "time of a pass on the processor", Better::Lower, false, Of::Pass},
        {"frame_rate", "1/s", "frames per second: 1000 ÷ wall_time_ms", Better::Higher, kIsDetail,
         Of::Whole},
        {"process_time_ms", "ms",
         "CPU time of all threads in a frame or a pass; on a software device alone", Better::Lower,
         kIsDetail, Of::Either},
        {"setup_time_ms", "ms", "time to make buffers, textures and shaders, once in each process",
         Better::Lower, kIsDetail, Of::Whole, kIsOfSetup},
        {"load_time_ms", "ms", "time to read or generate the scene, once in each worker",
         Better::Lower, kIsDetail, Of::Whole, kIsOfSetup},
        {"scene_triangles", "triangle", "triangles of the scene as it is loaded", Better::Neither,
         kIsDetail, Of::Whole},
        {"scene_vertices", "vertex", "vertices of the scene as it is loaded", Better::Neither,
         kIsDetail, Of::Whole},
        {"scene_source", "enum", "0 for a real model, 1 for a stand-in, 2 for a generated scene",
         Better::Neither, kIsDetail, Of::Whole},
        {"peak_memory_bytes", "byte",
         "most memory that the process held, without other cases' scenes", Better::Lower, kIsDetail,
         Of::Whole, kIsOfSetup},
        {"baseline_memory_bytes", "byte", "memory that the process held before its first case",
         Better::Neither, kIsDetail, Of::Whole, kIsOfSetup},
        {"work_primitives", "primitive", "primitives that a repeat drew, as the device counts them",
         Better::Neither, kIsDetail, Of::Whole},
        {"work_fragments", "fragment", "fragments that a repeat drew, as the device counts them",
         Better::Neither, kIsDetail, Of::Whole},
        {"work_compute_invocations", "1",
         "compute invocations of a repeat, as the device counts them", Better::Neither, kIsDetail,
         Of::Whole},
        {"work_image_digest", "1", "hash of the picture: equal where repeats drew the same",
         Better::Neither, kIsDetail, Of::Whole},
    };
    return metrics;
}

namespace {

/// Declares the errors of its pictures, once.
config::Outputs withPictureErrors(config::Outputs outputs) {
    for (const std::string& picture : outputs.withTruth) {
        if (outputs.hasPass(picture)) continue;
        outputs.passes.push_back({picture, "the picture against its truth"});
    }
    if (outputs.withTruth.empty()) return outputs;
    for (const config::MetricInfo& error : config::pictureErrors()) {
        if (!outputs.find(error.name)) outputs.metrics.push_back(error);
    }
    return outputs;
}

}  // namespace

config::Outputs outputsOf(const TechniqueInfo& technique, const Node& program) {
    const config::Outputs own = technique.outputs();
    const std::span<const config::MetricInfo> common = commonMetrics();
    config::Outputs all{{common.begin(), common.end()}, own.passes, own.areRandom, own.withTruth};
    if (program.isNull()) {
        for (config::MetricInfo info : own.metrics) {
            const bool isOfPasses =
                std::ranges::find(own.ofPasses, info.name) != own.ofPasses.end();
            if (isOfPasses) info.of = config::MetricInfo::Of::Pass;
            all.metrics.push_back(std::move(info));
        }
        return withPictureErrors(std::move(all));
    }
    const config::Outputs said = config::readProgram(program).outputs;
    for (const config::MetricInfo& info : said.metrics) {
        const auto isTaken = [&](const config::Outputs& outputs) {
            return outputs.find(info.name);
        };
        if (!isTaken(all) && !isTaken(own)) continue;
        throw Error(config::placeOfMetric(program, info.name),
                    "program: metric '" + info.name +
                        "' is recorded of every case already; give it another name");
    }
    all.metrics.insert(all.metrics.end(), said.metrics.begin(), said.metrics.end());
    all.metrics.insert(all.metrics.end(), own.metrics.begin(), own.metrics.end());
    all.passes.insert(all.passes.end(), said.passes.begin(), said.passes.end());
    all.withTruth = said.withTruth;
    all.tested = said.tested;
    return withPictureErrors(std::move(all));
}

std::unique_ptr<Technique> makeTechnique(const TechniqueInfo& info, const Node& program,
                                         Params& params) {
    if (info.createFrom && program.isNull()) {
        throw Error("technique '" + std::string(info.name) +
                    "' needs 'program': see 'gfxrepro describe config'");
    }
    if (info.createFrom) return info.createFrom(program, params);
    if (!program.isNull()) {
        throw Error(program.location(),
                    "'program': technique '" + std::string(info.name) + "' takes none");
    }
    return info.create(params);
}

void Technique::requireFrames(int frameCount) const {
    if (frameCount == 1) return;
    throw Error(
        fmt::format("{} frames: the technique draws the same in each; allowed: 1", frameCount));
}

void setUp(Technique& technique, SetupContext& context) {
    if (!context.scene && technique.sceneNeed() != SceneNeed::Nothing) {
        throw Error("the technique needs a scene, and the case has none");
    }
    if (context.scene) technique.requireScene(*context.scene);
    technique.setup(context);
}

bool needsDevice(const TechniqueInfo& info, const Node& program) {
    if (info.isOnCpu) return false;
    return !info.createFrom || program.isNull() || config::readProgram(program).usesGpu;
}

const TechniqueInfo& findTechnique(std::span<const TechniqueInfo> techniques, std::string_view name,
                                   const SourceLocation& where) {
    std::vector<std::string> names;
    for (const TechniqueInfo& info : techniques) {
        if (info.name == name) return info;
        names.emplace_back(info.name);
    }
    throw Error(where, "unknown technique '" + std::string(name) + "'" + suggestion(name, names) +
                           "; known: " + joined(names));
}

}  // namespace gfxrepro::technique
