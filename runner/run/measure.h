// The measured flow of one case, in the process that holds the device.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/image/image.h"
#include "runner/config/case.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"
#include "runner/run/scene_cache.h"

namespace gfxrepro::run {

/// On hardware a frame can take a hundredth of the time in which a clock rises (an H100 was seen to
/// go from 345 to 1,980 MHz). Once it has, times scatter little: the standard deviation of an
/// H100's is 0.05 % of a frame of 2 ms, within a process as between processes.
struct Pacing {
    double warmUpS = 0.0;        // before the first frame: at least this long,
    double warmUpAtMostS = 0.0;  // until times have settled, or this long
    double busyS = 0.0;          // before each repeat of less than 50 ms, for the device has waited
                                 // for the last one's picture
    double repeatsS = 0.0;       // repeats of a frame go on until they took this together,
    int repeatsAtMost = 1;       // or are as many
    int inFlightAtMost = 1;      // frames that are on their way at once for a frame rate

    /// Only the timing lane is paced, and only where the device that draws is hardware.
    static Pacing of(const config::Measure& measure, bool isHardware);

    /// Whether the last three differ by no more than 2 %.
    static bool areSettled(const std::vector<double>& timesMs);
    /// So many frames that they take 50 ms, at most `inFlightAtMost`.
    int inFlight(double frameTimeMs) const;
};

/// A picture in few numbers.
struct ImageDigest {
    static constexpr int kCells = 8;  // along each axis

    /// The first 52 bits of the SHA-256 of the pixels: exact in a double.
    double hash = 0.0;
    bool isBlank = false;                        // every pixel the same
    std::array<float, kCells * kCells> means{};  // of all channels over each cell
    float range = 0.0F;                          // of the pixels' values

    static ImageDigest of(const image::ImageF& image);
};

/// What one repeat of a frame did.
struct RepeatWork {
    std::optional<gl::Work> counts;
    std::optional<ImageDigest> image;
};

/// Why the times of these repeats of one frame cannot stand, with the numbers; empty if they can.
/// Primitives must be the same but for 1e-5, compute invocations but for 1e-4: a GPU's lists that
/// grow by atomic counters are in another order each time, and of two triangles at one depth the
/// first is seen (of reused reflections on an H100 one point of 2.5 million primitives, and of 1.2
/// million invocations the 64 of one work group). Fragments may
/// differ by 1 %: early depth tests of a parallel rasterizer depend on the order. Pictures may
/// differ by 1 % of their range in the mean of a cell: sums of floats do as well.
std::string whyUnequal(const std::vector<RepeatWork>& repeats);

/// What a worker has at hand for every case.
struct MeasureContext {
    gl::Device& device;
    const gl::ShaderLibrary& shaders;
    SceneCache& scenes;
    ProgramCache& programs;
    std::span<const technique::TechniqueInfo> techniques;
    std::filesystem::path runDir;
    std::string command;            // as typed
    long long baselineMemoryBytes;  // resident before the first scene was loaded
    /// Told at the begin (true) and end (false) of load, setup, warm-up, render and record.
    std::function<void(std::string_view phase, bool isBegin)> onPhase;
    /// Returns when frames may be drawn: no other worker prepares a case, or draws.
    std::function<void()> awaitTurn = [] {};
    technique::SharedResults shared = technique::SharedResults();
};

/// So that measureCase() voids the times of what was suspended. Before a process has threads.
void noticeSuspensions();

/// Process `process` of the case: constructor → load → set-up → warm-ups → frames × repeats →
/// record. A program, which starts anew for each frame, is warmed up in the first process alone.
/// Technique::recordOnce follows there, and where the picture is another than the first process's
/// or the seed is. Beside the technique's own metrics it gives, for each repeat
/// of a frame, wall_time_ms, frame_rate, gpu_time_ms and cpu_time_ms a pass, on a software device
/// with the CPU time of all threads of the process beside them (process_time_ms, of the whole frame
/// and a pass); in the timing lane work_primitives, work_fragments, work_compute_invocations and
/// work_image_digest, and the times of repeats that did not do the same are void (whyUnequal).
/// Under frame and repeat records::kSetup: setup_time_ms and the times of set-up's passes; for a
/// case with a scene load_time_ms, scene_triangles, scene_vertices, scene_source, and where all was
/// recorded peak_memory_bytes (highest resident size from loading to recording, less what other
/// cases' scenes and shared results hold) and baseline_memory_bytes. Throws what the technique
/// throws, and Error for a metric that is given twice.
CaseResult measureCase(const Case& item, int process, MeasureContext& context);

}  // namespace gfxrepro::run
