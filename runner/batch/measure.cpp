#include "runner/batch/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "runner/batch/equal_work.h"
#include "runner/batch/process_memory.h"
#include "runner/batch/recorder.h"
#include "runner/batch/run_directory.h"
#include "runner/report/frame_times.h"

namespace gfxrepro::batch {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Says when a phase begins and ends, at an exception too, and adds its time to `spentS`.
class PhaseScope {
  public:
    PhaseScope(const MeasureContext& context, std::string_view phase, double& spentS)
        : context_(context), phase_(phase), spentS_(spentS) {
        context_.onPhase(phase_, true);
    }
    ~PhaseScope() {
        spentS_ += 1e-3 * millisecondsSince(begin_);
        context_.onPhase(phase_, false);
    }
    PhaseScope(const PhaseScope&) = delete;
    PhaseScope& operator=(const PhaseScope&) = delete;

  private:
    const MeasureContext& context_;
    std::string_view phase_;
    double& spentS_;
    Clock::time_point begin_ = Clock::now();
};

/// Where cores are the device their time is recorded, too: of scopes of one name on both clocks
/// together.
void recordPasses(gl::Profiler& profiler, bool isSoftware, RunRecorder& recorder) {
    std::map<std::string, double> processTimesMs;
    for (const gl::PassTime& time : profiler.collect()) {
        const bool isGpu = time.clock == gl::PassTime::Clock::Gpu;
        recorder.metric(isGpu ? "gpu_time_ms" : "cpu_time_ms", time.timeMs, "ms", time.pass);
        processTimesMs[time.pass] += time.processTimeMs;
    }
    if (!isSoftware) return;
    for (const auto& [pass, timeMs] : processTimesMs) {
        recorder.metric("process_time_ms", timeMs, "ms", pass);
    }
}

std::string kindName(scene::Origin::Kind kind) {
    switch (kind) {
        case scene::Origin::Kind::Real:
            return "real";
        case scene::Origin::Kind::StandIn:
            return "stand-in";
        case scene::Origin::Kind::Generated:
            break;
    }
    return "generated";
}

/// 0 real, 1 stand-in, 2 generated, as scene_source in records.csv.
int kindNumber(scene::Origin::Kind kind) {
    switch (kind) {
        case scene::Origin::Kind::Real:
            return 0;
        case scene::Origin::Kind::StandIn:
            return 1;
        case scene::Origin::Kind::Generated:
            break;
    }
    return 2;
}

void recordScene(const SceneCache::Entry& entry, RunRecorder& recorder) {
    const scene::Scene& scene = entry.scene;
    recorder.metric("scene_triangles", static_cast<double>(scene.triangleCount()), "triangle", "");
    recorder.metric("scene_vertices", static_cast<double>(scene.vertexCount()), "vertex", "");
    recorder.metric("scene_source", kindNumber(scene.origin.kind), "enum", "");
    recorder.metric("load_time_ms", entry.loadTimeMs, "ms", "");
}

void recordMemory(const MeasureContext& context, const SceneCache::Entry& entry,
                  RunRecorder& recorder) {
    const long long peakBytes = std::max(peakResidentBytes(), entry.peakResidentBytes);
    const auto otherBytes = static_cast<long long>(context.scenes.otherBytes());
    recorder.metric("peak_memory_bytes", static_cast<double>(peakBytes - otherBytes), "byte", "");
    recorder.metric("baseline_memory_bytes", static_cast<double>(context.baselineMemoryBytes),
                    "byte", "");
}

bool isTimeOfFrame(const std::string& metric) {
    return metric == "wall_time_ms" || metric == "frame_rate" || metric == "gpu_time_ms" ||
           metric == "cpu_time_ms" || metric == "process_time_ms";
}

/// What tells whether the repeats of a frame did the same; recorded beside their times.
class WorkGuard {
  public:
    WorkGuard(const gl::Device& device, bool isTiming)
        : isTiming_(isTiming),
          query_(isTiming && device.hasExtension("GL_ARB_pipeline_statistics_query")) {}

    void beginFrame() { repeats_.clear(); }
    void beginRepeat() const { query_.begin(); }
    /// After the clock has stopped.
    void endRepeat(const technique::Technique& technique, RunRecorder& recorder) {
        query_.end();
        if (!isTiming_) return;
        RepeatWork work;
        work.counts = query_.result();
        if (work.counts) {
            const gl::Work& counts = *work.counts;
            const auto record = [&](const char* name, std::uint64_t count, const char* unit) {
                recorder.metric(name, static_cast<double>(count), unit, "");
            };
            record("work_primitives", counts.primitives, "primitive");
            record("work_fragments", counts.fragments, "fragment");
            record("work_compute_invocations", counts.invocations, "1");
        }
        if (const gl::Texture* image = technique.frameImage()) {
            work.image = ImageDigest::of(image->readImage(4));
            recorder.metric("work_image_digest", work.image->hash, "1", "");
        }
        repeats_.push_back(std::move(work));
    }
    /// Voids the times among the samples from `first` on where the repeats were not alike.
    void endFrame(int frame, std::size_t first, CaseResult& result) const {
        const std::string why = whyUnequal(repeats_);
        if (why.empty()) return;
        if (result.voidReason.empty()) result.voidReason = fmt::format("frame {}: {}", frame, why);
        for (std::size_t i = first; i < result.samples.size(); ++i) {
            result.samples[i].isVoid = isTimeOfFrame(result.samples[i].metric);
        }
    }

  private:
    bool isTiming_;
    gl::WorkQuery query_;
    std::vector<RepeatWork> repeats_;
};

/// Warm-ups, then every frame with its repeats; what the last repeat of a frame left is recorded.
void renderAndRecord(const Case& item, technique::Technique& technique, gl::Profiler& profiler,
                     const MeasureContext& context, RunRecorder& recorder, CaseResult& result) {
    const int frames = item.measure.frames;
    const bool isSoftware = context.device.info().isSoftware;
    WorkGuard guard(context.device, item.measure.lane == config::Measure::Lane::Timing);
    for (int frame = 0; frame < frames; ++frame) {
        technique::FrameContext frameContext{frame, frames, profiler};
        const std::size_t firstSample = result.samples.size();
        guard.beginFrame();
        {
            const PhaseScope phase(context, "render", result.cost.renderS);
            for (int i = 0; frame == 0 && i < item.measure.warmup; ++i) {
                technique.render(frameContext);
                context.device.finish("warming up");
                profiler.collect();
            }
            std::vector<double> timesMs;
            for (int repeat = 0; report::isRepeated(item.measure, timesMs); ++repeat) {
                recorder.setIteration(frame, repeat);
                guard.beginRepeat();
                const double processBeginMs = gl::processTimeMs();
                const Clock::time_point begin = Clock::now();
                technique.render(frameContext);
                context.device.finish("rendering");
                const double wallTimeMs = millisecondsSince(begin);
                const double processTimeMs = gl::processTimeMs() - processBeginMs;
                timesMs.push_back(wallTimeMs);
                recorder.metric("wall_time_ms", wallTimeMs, "ms", "");
                recorder.metric("frame_rate", 1000.0 / wallTimeMs, "1/s", "");
                if (const auto elsewhere = technique.usageElsewhere()) {
                    recorder.metric("process_time_ms", elsewhere->processTimeMs, "ms", "");
                } else if (isSoftware) {
                    recorder.metric("process_time_ms", processTimeMs, "ms", "");
                }
                recordPasses(profiler, isSoftware, recorder);
                guard.endRepeat(technique, recorder);
            }
        }
        guard.endFrame(frame, firstSample, result);
        const PhaseScope phase(context, "record", result.cost.recordS);
        recorder.setIteration(frame, 0);
        technique.record(recorder);
        recorder.checkTruths();
        context.device.finish("recording");
        profiler.collect();
    }
}

}  // namespace

CaseResult measureCase(const Case& item, MeasureContext& context) {
    CaseResult result;
    const SourceLocation nowhere;
    const technique::TechniqueInfo& info =
        technique::findTechnique(context.techniques, item.technique, nowhere);
    RunRecorder recorder(context.runDir, context.command, item,
                         technique::outputsOf(info, item.program), result);
    config::Params params(item.given, "technique '" + item.technique + "'");
    if (!item.offered.isNull()) params.offer(item.offered);

    const std::string sceneName = item.scene.isNull() ? "" : item.scene.text();
    context.scenes.beginCase(sceneName);
    resetPeakResident();
    const std::unique_ptr<technique::Technique> technique =
        technique::makeTechnique(info, item.program, params);
    if (context.device.isNone() && technique::needsDevice(info, item.program)) {
        throw UnsupportedError("technique '" + item.technique + "' needs a graphics device");
    }
    if (!item.program.isNull()) {
        result.programs = context.programs.require(item, params.resolved());
    }
    const SceneCache::Entry* scene = nullptr;
    if (!sceneName.empty()) {
        const PhaseScope phase(context, "load", result.cost.loadS);
        scene = &context.scenes.get(sceneName);
        recordScene(*scene, recorder);
    }

    gl::Profiler profiler(context.device.info().isSoftware);
    technique::SetupContext setup{context.device,
                                  context.shaders,
                                  context.scenes,
                                  scene ? &scene->scene : nullptr,
                                  {item.outputWidthPx, item.outputHeightPx},
                                  item.seed,
                                  profiler,
                                  context.runDir / kScratchFolder};
    {
        const PhaseScope phase(context, "setup", result.cost.setupS);
        const Clock::time_point begin = Clock::now();
        technique->setup(setup);
        context.device.finish("setting up");
        recorder.metric("setup_time_ms", millisecondsSince(begin), "ms", "");
        recordPasses(profiler, context.device.info().isSoftware, recorder);
    }
    renderAndRecord(item, *technique, profiler, context, recorder, result);
    recorder.setIteration(report::kSetup, report::kSetup);
    result.cost.peakBytes = std::max(peakResidentBytes(), scene ? scene->peakResidentBytes : 0);
    if (const auto elsewhere = technique->usageElsewhere()) {
        result.cost.peakBytes += elsewhere->peakBytes;
        recorder.metric("peak_memory_bytes", static_cast<double>(elsewhere->peakBytes), "byte", "");
    } else if (scene) {
        recordMemory(context, *scene, recorder);
    }

    for (const SceneCache::Entry& entry : context.scenes.entries()) {
        if (!entry.isOfThisCase) continue;
        const scene::Origin& origin = entry.scene.origin;
        result.scenes.push_back(
            {entry.reference, kindName(origin.kind), origin.description, origin.sha256});
    }
    return result;
}

}  // namespace gfxrepro::batch
