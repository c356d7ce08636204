// The sections whose keys are declared where they are read: `output`, `measure`.
#include "runner/config/measure_spec.h"

#include "engine/core/params.h"
#include "runner/config/sections.h"

namespace gfxrepro::config {

bool Measure::mayContinue() const {
    return relativeError > 0.0 && lane == Lane::Timing && processes >= kFewestRounds &&
           processes < processesAtMost;
}

int Measure::certainRounds() const {
    return lane == Lane::Timing && isWithinBudget ? 1 : processes;
}

std::pair<int, int> readOutput(Params& params) {
    const int width =
        params.getInt("width", 512, {"width of the image", "pixels", 1, kMaxOutputPx});
    const int height =
        params.getInt("height", 512, {"height of the image", "pixels", 1, kMaxOutputPx});
    params.finish();
    return {width, height};
}

Measure readMeasure(Params& params, bool isOwn) {
    constexpr Choice<Measure::Lane> kLanes[] = {
        {Measure::Lane::Quality, "quality", "may run beside others"},
        {Measure::Lane::Timing, "timing", "runs alone"}};
    constexpr double kMax = 1'000'000;
    // Who says nothing of how to measure, or what to show, wants times, in about a minute.
    const bool isTimed = isOwn && !params.isGiven("lane") && !params.isGiven("scene_seeds");
    Measure measure;
    if (isTimed) {
        measure.lane = Measure::Lane::Timing;
        measure.warmup = 1;
        measure.processes = kFewestRounds;
        measure.isWithinBudget = true;
    }
    measure.lane = params.getEnum("lane", measure.lane, kLanes, {"how cases run"});
    measure.warmup = params.getInt("warmup", measure.warmup,
                                   {"iterations before the first measured one", "", 0, kMax});
    measure.repeats = params.getInt("repeats", measure.repeats,
                                    {"measured iterations in one process", "", 1, kMax});
    measure.processes =
        params.getInt("processes", measure.processes,
                      {"rounds: in each every case is run, in a process of its own", "", 1, kMax});
    measure.relativeError = params.getDouble(
        "relative_error", measure.relativeError,
        {"rounds go on until half of each 95 % interval ÷ time is no more, and then "
         "to 14, 16 or 19; with 6 processes or more in the timing lane; 0: they do not",
         "", 0, 1});
    // Who asks how well a time is known wants times.
    if (measure.relativeError > 0.0 && !params.isGiven("lane")) {
        measure.lane = Measure::Lane::Timing;
    }
    measure.processesAtMost = params.getInt("processes_at_most", measure.processesAtMost,
                                            {"rounds, where they go on", "", 1, kMax});
    measure.timeBudgetS = params.getDouble(
        "time_budget_s", measure.timeBudgetS,
        {"of all rounds of the file: none is begun to end later", "seconds", 0, 1e9});
    measure.frames = params.getInt("frames", measure.frames,
                                   {"frames of a path; each is repeated", "", 1, kMax});
    measure.sceneSeeds = params.getInt(
        "scene_seeds", measure.sceneSeeds,
        {"seeds of a generated scene, from the catalogue's on: a case each", "", 1, 1000});
    if (measure.sceneSeeds > 1 && measure.lane == Measure::Lane::Timing) {
        throw Error(params.locationOf("scene_seeds"),
                    "'scene_seeds' needs the quality lane: a time varies by the process");
    }
    measure.timeLimitS =
        params.getDouble("time_limit_s", measure.timeLimitS,
                         {"of the whole case, scene loading included", "seconds", 1e-3, 1e9});
    params.finish();
    // Rounds go on from those that an interval takes.
    const bool isOneRound = measure.relativeError > 0.0 && !params.isGiven("processes");
    if (isOneRound && measure.lane == Measure::Lane::Timing) measure.processes = kFewestRounds;
    return measure;
}

}  // namespace gfxrepro::config
