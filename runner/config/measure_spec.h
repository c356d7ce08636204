// How often and how a case is measured.
#pragma once

namespace gfxrepro::config {

/// Processes that a 95 % interval of a time takes (metrics::kFewestForInterval).
inline constexpr int kFewestRounds = 6;

/// How often and how a case is measured.
struct Measure {
    enum class Lane { Quality, Timing };
    Lane lane = Lane::Quality;
    int warmup = 0;     // iterations before the first measured one
    int repeats = 1;    // measured iterations in one process
    int processes = 1;  // rounds, in each of which a case is run in a process of its own if more
                        // than 1; the fewest, where more may follow:
    /// Timing lane, from metrics::kFewestForInterval processes on: rounds go on until half of each
    /// case's 95 % interval ÷ the time of its frames is no more than this. 0: they do not.
    double relativeError = 0.0;
    int processesAtMost = 20;
    double timeBudgetS = 60.0;  // of all rounds of the experiment
    int frames = 1;             // frames of a path; each is repeated
    int sceneSeeds = 1;         // samples of a generated scene: its seed and those that follow it
    /// Timing lane: of `processes` the first alone is measured whatever it takes; the others are
    /// begun only where they end within `timeBudgetS`.
    bool isWithinBudget = false;
    double timeLimitS = 120.0;  // of the whole case, scene loading included

    /// Whether rounds may follow the first `processes`.
    bool mayContinue() const;
    /// Rounds that are measured whatever they take.
    int certainRounds() const;
};

}  // namespace gfxrepro::config
