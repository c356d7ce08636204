#include "runner/run/measure.h"

#include <fmt/format.h>
#include <signal.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/gl/objects.h"
#include "engine/gl/profiler.h"
#include "runner/run/process_memory.h"
#include "runner/run/recorder.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::run {

Pacing Pacing::of(const config::Measure& measure, bool isHardware) {
    Pacing pacing;
    pacing.repeatsAtMost = measure.repeats;
    if (!isHardware || measure.lane != config::Measure::Lane::Timing) return pacing;
    pacing.warmUpS = 0.2;
    pacing.warmUpAtMostS = 3.0;
    pacing.busyS = 0.01;
    pacing.repeatsS = 0.2 / measure.frames;
    pacing.repeatsAtMost = std::max(measure.repeats, 10);
    pacing.inFlightAtMost = 8;
    return pacing;
}

bool Pacing::areSettled(const std::vector<double>& timesMs) {
    constexpr std::size_t kFrames = 3;
    constexpr double kDifference = 0.02;
    if (timesMs.size() < kFrames) return false;
    const auto [least, most] = std::minmax_element(timesMs.end() - kFrames, timesMs.end());
    return *most - *least <= kDifference * *least;
}

int Pacing::inFlight(double frameTimeMs) const {
    constexpr double kTogetherMs = 50.0;
    if (inFlightAtMost == 1 || frameTimeMs >= kTogetherMs) return 1;
    return static_cast<int>(std::clamp(std::ceil(kTogetherMs / std::max(frameTimeMs, 1e-3)), 1.0,
                                       static_cast<double>(inFlightAtMost)));
}

namespace {

constexpr double kPrimitiveTolerance = 1e-5;
constexpr double kInvocationTolerance = 1e-4;
constexpr double kFragmentTolerance = 0.01;
constexpr float kImageTolerance = 0.01F;

std::string whyCountsDiffer(const gl::Work& first, const gl::Work& other, std::size_t repeat) {
    std::string why;
    const auto compare = [&](const char* what, std::uint64_t a, std::uint64_t b, double tolerance) {
        const auto x = static_cast<double>(a), y = static_cast<double>(b);
        if (!why.empty() || std::abs(x - y) <= tolerance * std::max(x, y)) return;
        why = fmt::format("repeat {} has {} {}, repeat 0 has {}", repeat, b, what, a);
    };
    compare("primitives", first.primitives, other.primitives, kPrimitiveTolerance);
    compare("compute invocations", first.invocations, other.invocations, kInvocationTolerance);
    compare("fragments", first.fragments, other.fragments, kFragmentTolerance);
    return why;
}

bool areAlike(const ImageDigest& a, const ImageDigest& b) {
    if (a.hash == b.hash) return true;
    const float allowed = kImageTolerance * std::max(a.range, b.range);
    for (std::size_t i = 0; i < a.means.size(); ++i) {
        // The negation counts not-a-number.
        if (!(std::abs(a.means[i] - b.means[i]) <= allowed)) return false;
    }
    return true;
}

}  // namespace

ImageDigest ImageDigest::of(const image::ImageF& image) {
    ImageDigest digest;
    const std::span<const float> values = image.values();
    digest.hash =
        static_cast<double>(std::stoull(sha256(std::as_bytes(values)).substr(0, 13), nullptr, 16));
    const auto channels = static_cast<std::size_t>(image.channels());
    digest.isBlank = true;
    for (std::size_t i = channels; digest.isBlank && i < values.size(); ++i) {
        digest.isBlank = values[i] == values[i % channels];
    }
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    digest.range = *highest - *lowest;
    std::array<double, kCells * kCells> sums{};
    std::array<std::size_t, kCells * kCells> counts{};
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const auto cell = static_cast<std::size_t>(y * kCells / image.height() * kCells +
                                                       x * kCells / image.width());
            for (int c = 0; c < image.channels(); ++c) sums[cell] += image.at(x, y, c);
            counts[cell] += channels;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (counts[i] > 0)
            digest.means[i] = static_cast<float>(sums[i] / static_cast<double>(counts[i]));
    }
    return digest;
}

std::string whyUnequal(const std::vector<RepeatWork>& repeats) {
    for (std::size_t i = 0; i < repeats.size(); ++i) {
        const RepeatWork &first = repeats.front(), &here = repeats[i];
        if (here.image && here.image->isBlank) {
            return fmt::format("the picture of repeat {} is blank: all its pixels are the same", i);
        }
        if (first.counts && here.counts) {
            const std::string why = whyCountsDiffer(*first.counts, *here.counts, i);
            if (!why.empty()) return why;
        }
        if (first.image && here.image && !areAlike(*first.image, *here.image)) {
            return fmt::format("repeat {} drew a different picture than repeat 0", i);
        }
    }
    return "";
}

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
void recordPasses(const std::vector<gl::PassTime>& times, bool isSoftware, RunRecorder& recorder) {
    std::map<std::string, double> processTimesMs;
    for (const gl::PassTime& time : times) {
        const bool isGpu = time.clock == gl::PassTime::Clock::Gpu;
        if (time.timeMs) {
            recorder.metric(isGpu ? "gpu_time_ms" : "cpu_time_ms", *time.timeMs, time.pass);
        }
        processTimesMs[time.pass] += time.processTimeMs;
    }
    if (!isSoftware) return;
    for (const auto& [pass, timeMs] : processTimesMs) {
        recorder.metric("process_time_ms", timeMs, pass);
    }
}

/// The scheduler has to know which tables show times of set-up.
void requireOfSetup(const std::string& pass, const config::Outputs& outputs) {
    const auto isOfSetup = [&](const config::PassInfo& info) {
        return info.isOfSetup && info.name == pass;
    };
    if (std::ranges::any_of(outputs.passes, isOfSetup)) return;
    throw Error("setup() scopes the pass '" + pass + "', which is not declared as one of set-up");
}

void recordScene(const SceneCache::CachedScene& entry, RunRecorder& recorder) {
    const scene::Scene& scene = entry.scene;
    recorder.metric("scene_triangles", static_cast<double>(scene.triangleCount()));
    recorder.metric("scene_vertices", static_cast<double>(scene.vertexCount()));
    // 0 real, 1 stand-in, 2 generated: the kinds in their order.
    recorder.metric("scene_source", static_cast<int>(scene.origin.kind));
    recorder.metric("load_time_ms", entry.loadTimeMs);
}

void recordMemory(const MeasureContext& context, const SceneCache::CachedScene& entry,
                  RunRecorder& recorder) {
    const long long peakBytes = std::max(peakResidentBytes(), entry.peakResidentBytes);
    const auto otherBytes =
        static_cast<long long>(context.scenes.otherBytes() + context.shared.otherBytes());
    recorder.metric("peak_memory_bytes", static_cast<double>(peakBytes - otherBytes));
    recorder.metric("baseline_memory_bytes", static_cast<double>(context.baselineMemoryBytes));
}

std::vector<SceneUse> scenesOfCase(const SceneCache& scenes) {
    std::vector<SceneUse> used;
    for (const SceneCache::CachedScene& entry : scenes.entries()) {
        if (!entry.isOfThisCase) continue;
        const scene::Origin& origin = entry.scene.origin;
        used.push_back({entry.reference, std::string(scene::kindName(origin.kind)),
                        origin.description, origin.sha256, entry.scene.warnings});
    }
    return used;
}

bool isTime(const std::string& metric) {
    return metric == "wall_time_ms" || metric == "frame_rate" || metric == "gpu_time_ms" ||
           metric == "cpu_time_ms" || metric == "process_time_ms" || metric == "load_time_ms" ||
           metric == "setup_time_ms";
}

/// Voids the times among the samples from `first` on.
void voidTimes(CaseResult& result, std::size_t first, const std::string& why) {
    if (result.voidReason.empty()) result.voidReason = why;
    for (std::size_t i = first; i < result.samples.size(); ++i) {
        result.samples[i].isVoid = isTime(result.samples[i].metric);
    }
}

/// What a suspended process goes on by. Blocked (noticeSuspensions), it waits to be asked for.
sigset_t continuation() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGCONT);
    return signals;
}

/// Since the last call.
bool wasSuspended() {
    const sigset_t signals = continuation();
    const timespec atOnce{};
    return ::sigtimedwait(&signals, nullptr, &atOnce) == SIGCONT;
}

constexpr const char* kWasSuspended = "the process was suspended meanwhile";

/// What tells whether the repeats of a frame did the same; recorded beside their times.
class WorkGuard {
  public:
    WorkGuard(const gl::Device& device, bool isTiming)
        : isTiming_(isTiming), query_(isTiming && device.info().countsWork) {}

    void beginFrame() {
        repeats_.clear();
        wasSuspended();
    }
    void beginRepeat() const { query_.begin(); }
    /// After the clock has stopped.
    void endRepeat(const technique::Technique& technique, RunRecorder& recorder) {
        query_.end();
        if (!isTiming_) return;
        RepeatWork work;
        work.counts = query_.result();
        if (work.counts) {
            const gl::Work& counts = *work.counts;
            recorder.metric("work_primitives", static_cast<double>(counts.primitives));
            recorder.metric("work_fragments", static_cast<double>(counts.fragments));
            recorder.metric("work_compute_invocations", static_cast<double>(counts.invocations));
        }
        if (const gl::Texture* image = technique.frameImage()) {
            work.image = ImageDigest::of(image->readImage(4));
            recorder.metric("work_image_digest", work.image->hash);
        }
        repeats_.push_back(std::move(work));
    }
    /// Voids the times among the samples from `first` on where the repeats were not alike.
    void endFrame(int frame, std::size_t first, CaseResult& result) const {
        const bool isLonger = isTiming_ && wasSuspended();
        const std::string why = isLonger ? kWasSuspended : whyUnequal(repeats_);
        if (!why.empty()) voidTimes(result, first, fmt::format("frame {}: {}", frame, why));
    }

  private:
    bool isTiming_;
    gl::WorkQuery query_;
    std::vector<RepeatWork> repeats_;
};

/// Frames that one render() draws: all, of a program that gives them in one run.
int framesAtOnce(const Case& item) {
    const bool areAll = !item.program.isNull() && config::readProgram(item.program).givesAllFrames;
    return areAll ? item.measure.frames : 1;
}

/// The frames of one case, drawn and timed.
class FrameLoop {
  public:
    FrameLoop(const Case& item, int process, bool drawsOnDevice, technique::Technique& technique,
              gl::Profiler& profiler, const MeasureContext& context)
        : item_(item),
          process_(process),
          measure_(item.measure),
          atOnce_(framesAtOnce(item)),
          technique_(technique),
          profiler_(profiler),
          context_(context),
          isSoftware_(context.device.info().isSoftware),
          pacing_(Pacing::of(item.measure, drawsOnDevice && !isSoftware_)),
          guard_(context.device, item.measure.lane == config::Measure::Lane::Timing) {}

    /// Warm-ups, then every frame with its repeats; what the last repeat of a frame left is
    /// recorded. Of frames that are drawn at once one record() follows another, in their order.
    /// Whether recordOnce() was among it.
    bool run(RunRecorder& recorder, CaseResult& result) {
        bool isWhole = false;
        for (int frame = 0; frame < measure_.frames; frame += atOnce_) {
            technique::FrameContext frameContext{frame, measure_.frames, profiler_};
            const std::size_t firstSample = result.samples.size();
            guard_.beginFrame();
            if (frame == 0 && !isWarm()) {
                double spentS = 0.0;
                {
                    const PhaseScope phase(context_, "warm-up", spentS);
                    warmUp(frameContext);
                }
                result.cost.renderS += spentS;
                if (isOfProgram()) result.cost.onceS += spentS;
            }
            {
                const PhaseScope phase(context_, "render", result.cost.renderS);
                repeat(frameContext, recorder);
            }
            guard_.endFrame(frame, firstSample, result);
            const PhaseScope phase(context_, "record", result.cost.recordS);
            const std::string image = digestOfImage();
            for (int drawn = frame; drawn < frame + atOnce_; ++drawn) {
                recorder.setIteration(drawn, 0);
                technique_.record(recorder);
                if (isRecorded(drawn, image)) {
                    recorder.compareWithTruths();
                } else {
                    recordOnce(recorder, result);
                    isWhole = true;
                }
            }
            context_.device.finish("recording");
            profiler_.collect();
        }
        return isWhole;
    }

  private:
    bool isOfProgram() const { return !item_.program.isNull(); }
    /// A program starts anew for every frame.
    bool isWarm() const { return isOfProgram() && process_ > 0; }
    bool isOfOneSeed() const { return measure_.seeds != config::Measure::Seeds::Process; }
    /// Whether what is recorded once is of one process of several.
    bool isOfOneProcess() const { return isOfOneSeed() && measure_.processes > 1; }
    /// Before record(), which may draw again; empty where nobody asks, or there is none.
    std::string digestOfImage() const {
        const gl::Texture* image = isOfOneProcess() ? technique_.frameImage() : nullptr;
        return image ? std::to_string(ImageDigest::of(image->readImage(4)).hash) : "";
    }
    /// Whether the case's first process recorded the same once. It leaves its digest to the others,
    /// which may not find it: the run was interrupted between them.
    bool isRecorded(int frame, const std::string& image) const {
        if (!isOfOneProcess()) return false;
        std::string digest = technique_.pictureDigest();
        if (digest.empty()) digest = image;
        const std::filesystem::path file =
            context_.runDir / kScratchFolder / fmt::format("picture-{}-{}", item_.id, frame);
        if (process_ > 0) {
            return digest.empty() || (std::filesystem::exists(file) && readFile(file) == digest);
        }
        if (!digest.empty()) writeFileAtomic(file, digest);
        return false;
    }
    void recordOnce(RunRecorder& recorder, CaseResult& result) {
        const Clock::time_point begin = Clock::now();
        technique_.recordOnce(recorder);
        recorder.compareWithTruths();
        if (isOfOneSeed()) result.cost.onceS += 1e-3 * millisecondsSince(begin);
    }
    void render(technique::FrameContext& frame) {
        const gl::DebugGroup group(context_.device, "frame");
        technique_.render(frame);
    }
    /// The time of a frame whose passes nobody asks for.
    double drawUnmeasuredMs(technique::FrameContext& frame) {
        const Clock::time_point begin = Clock::now();
        render(frame);
        context_.device.finish("warming up");
        profiler_.collect();
        return millisecondsSince(begin);
    }
    void warmUp(technique::FrameContext& frame) {
        for (int i = 0; i < measure_.warmup(); ++i) drawUnmeasuredMs(frame);
        const Clock::time_point begin = Clock::now();
        const auto spentS = [&] { return 1e-3 * millisecondsSince(begin); };
        std::vector<double> timesMs;
        while (spentS() < pacing_.warmUpS ||
               (spentS() < pacing_.warmUpAtMostS && !Pacing::areSettled(timesMs))) {
            timesMs.push_back(drawUnmeasuredMs(frame));
        }
    }
    void keepBusy(technique::FrameContext& frame) {
        const Clock::time_point begin = Clock::now();
        while (1e-3 * millisecondsSince(begin) < pacing_.busyS) drawUnmeasuredMs(frame);
    }
    void repeat(technique::FrameContext& frame, RunRecorder& recorder) {
        double spentS = 0.0;
        for (int i = 0;
             i < measure_.repeats || (i < pacing_.repeatsAtMost && spentS < pacing_.repeatsS);
             ++i) {
            if (pacing_.inFlight(lastMs_) > 1) keepBusy(frame);
            lastMs_ = measureFrame(frame, i, recorder);
            spentS += 1e-3 * lastMs_ * atOnce_;
        }
    }
    /// Its wall time, in ms; of frames that are drawn at once, that of all ÷ their number.
    double measureFrame(technique::FrameContext& frame, int repeat, RunRecorder& recorder) {
        const auto recordOfEach = [&](const char* metric, double value) {
            for (int drawn = frame.frame; drawn < frame.frame + atOnce_; ++drawn) {
                recorder.setIteration(drawn, repeat);
                recorder.metric(metric, value);
            }
        };
        guard_.beginRepeat();
        const double processBeginMs = gl::processTimeMs();
        const Clock::time_point begin = Clock::now();
        render(frame);
        context_.device.finish("rendering");
        const double wallTimeMs = millisecondsSince(begin) / atOnce_;
        const double processTimeMs = gl::processTimeMs() - processBeginMs;
        recordOfEach("wall_time_ms", wallTimeMs);
        if (const auto elsewhere = technique_.usageElsewhere()) {
            recordOfEach("process_time_ms", elsewhere->processTimeMs / atOnce_);
        } else if (isSoftware_) {
            recordOfEach("process_time_ms", processTimeMs / atOnce_);
        }
        recorder.setIteration(frame.frame, repeat);
        recordPasses(profiler_.collect(), isSoftware_, recorder);
        guard_.endRepeat(technique_, recorder);
        recordOfEach("frame_rate", 1000.0 / timeInFlightMs(frame, wallTimeMs));
        return wallTimeMs;
    }
    /// The time of a frame of several that follow one another without a wait for each.
    double timeInFlightMs(technique::FrameContext& frame, double wallTimeMs) {
        const int count = pacing_.inFlight(wallTimeMs);
        if (count == 1 || atOnce_ > 1) return wallTimeMs;
        const Clock::time_point begin = Clock::now();
        for (int i = 0; i < count; ++i) {
            render(frame);
            gl::orderAllMemory();
        }
        context_.device.finish("rendering frames in flight");
        const double timeMs = millisecondsSince(begin) / count;
        profiler_.collect();
        return timeMs;
    }

    const Case& item_;
    int process_;
    const config::Measure& measure_;
    int atOnce_;
    technique::Technique& technique_;
    gl::Profiler& profiler_;
    const MeasureContext& context_;
    bool isSoftware_;
    Pacing pacing_;
    WorkGuard guard_;
    double lastMs_ = 0.0;  // wall time of the last measured frame
};

/// What a case is beside its parameters.
std::string workOf(const Case& item, const std::string& scene) {
    return fmt::format("{} {} {} {} {} {}", item.technique, scene, item.outputWidthPx,
                       item.outputHeightPx, item.seed, item.measure.frames);
}

}  // namespace

void noticeSuspensions() {
    const sigset_t signals = continuation();
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

CaseResult measureCase(const Case& item, int process, MeasureContext& context) {
    CaseResult result;
    const SourceLocation nowhere;
    const technique::TechniqueInfo& info =
        technique::findTechnique(context.techniques, item.technique, nowhere);
    const config::Outputs outputs = technique::outputsOf(info, item.program);
    RunRecorder recorder(context.runDir, context.command, item, outputs, result);
    Params params(item.given, "technique '" + item.technique + "'");
    if (!item.offered.isNull()) params.offer(item.offered);

    const std::string sceneName = item.scene.isNull() ? "" : item.scene.text();
    context.scenes.beginCase(sceneName);
    const bool isTiming = item.measure.lane == config::Measure::Lane::Timing;
    context.shared.beginCase(workOf(item, sceneName), item.params);
    resetPeakResident();
    wasSuspended();
    const std::unique_ptr<technique::Technique> technique =
        technique::makeTechnique(info, item.program, params);
    if (context.device.isNone() && technique::needsDevice(info, item.program)) {
        throw UnsupportedError("technique '" + item.technique + "' needs a graphics device");
    }
    if (!item.program.isNull()) result.programs = context.programs.require(item, params.resolved());
    const SceneCache::CachedScene* scene = nullptr;
    if (!sceneName.empty()) {
        const PhaseScope phase(context, "load", result.cost.loadS);
        scene = &context.scenes.get(sceneName);
        recordScene(*scene, recorder);
    }

    gl::Profiler profiler(context.device.info());
    technique::SetupContext setup{context.device,
                                  context.shaders,
                                  context.scenes,
                                  scene ? &scene->scene : nullptr,
                                  {item.outputWidthPx, item.outputHeightPx},
                                  item.seed,
                                  profiler,
                                  context.runDir / kScratchFolder,
                                  isTiming ? nullptr : &context.shared};
    {
        const PhaseScope phase(context, "setup", result.cost.setupS);
        const Clock::time_point begin = Clock::now();
        technique::setUp(*technique, setup);
        context.device.finish("setting up");
        recorder.metric("setup_time_ms", millisecondsSince(begin));
        const std::vector<gl::PassTime> times = profiler.collect();
        for (const gl::PassTime& time : times) requireOfSetup(time.pass, outputs);
        recordPasses(times, context.device.info().isSoftware, recorder);
    }
    if (isTiming && wasSuspended()) {
        voidTimes(result, 0, fmt::format("set-up: {}", kWasSuspended));
    }
    context.awaitTurn();
    const bool isWhole = FrameLoop(item, process, technique::needsDevice(info, item.program),
                                   *technique, profiler, context)
                             .run(recorder, result);
    recorder.setIteration(records::kSetup, records::kSetup);
    result.cost.peakBytes = std::max(peakResidentBytes(), scene ? scene->peakResidentBytes : 0);
    if (const auto elsewhere = technique->usageElsewhere()) {
        result.cost.peakBytes += elsewhere->peakBytes;
        const bool isOfOneSeed = item.measure.seeds != config::Measure::Seeds::Process;
        if (!isOfOneSeed) result.cost.onceS += elsewhere->onceS;
        recorder.metric("peak_memory_bytes", static_cast<double>(elsewhere->peakBytes));
    } else if (scene && isWhole) {
        recordMemory(context, *scene, recorder);
    }
    result.scenes = scenesOfCase(context.scenes);
    return result;
}

}  // namespace gfxrepro::run
