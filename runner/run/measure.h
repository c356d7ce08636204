// The measured flow of one case, in the process that holds the device.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "runner/run/plan.h"
#include "runner/run/program_cache.h"
#include "runner/run/protocol.h"
#include "runner/run/scene_cache.h"

namespace gfxrepro::run {

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
};

/// Constructor → load → set-up → warm-ups → frames × repeats → record. Beside the technique's own
/// metrics it gives, for each repeat of a frame, wall_time_ms, frame_rate, gpu_time_ms and
/// cpu_time_ms a pass, on a software device with the CPU time of all threads of the process beside
/// them (process_time_ms, of the whole frame and a pass); in the timing lane work_primitives,
/// work_fragments, work_compute_invocations and work_image_digest, and the times of repeats that
/// did not do the same are void (equal_work.h). Under frame and repeat records::kSetup:
/// setup_time_ms and the times of set-up's passes; for a case with a scene load_time_ms,
/// scene_triangles, scene_vertices, scene_source, peak_memory_bytes (highest resident size from
/// loading to recording, less what other cached scenes hold) and baseline_memory_bytes. Throws what
/// the technique throws, and Error for a metric that is given twice.
CaseResult measureCase(const Case& item, MeasureContext& context);

}  // namespace gfxrepro::run
