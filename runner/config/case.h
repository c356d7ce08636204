// What is measured, and how often: a point of an experiment's sweep, with all that decides its
// result.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/node.h"
#include "engine/core/number_range.h"

namespace gfxrepro::config {

/// Processes that a 95 % interval of a time takes (metrics::kFewestForInterval).
inline constexpr int kFewestRounds = 6;
/// Where rounds go on until times are known, of which some never are.
inline constexpr int kMostRounds = 20;
/// They are known where half of each case's 95 % interval ÷ the time of its frames is no more.
inline constexpr double kKnownTo = 0.05;
/// Of who does not say how many processes there are.
inline constexpr double kUsualTimeBudgetS = 60.0;

// What a case may have, in its config, swept, printed or varied by an assumption.
inline constexpr NumberRange kOutputSizesPx{.least = 1, .most = 16384, .isWhole = true};
inline constexpr NumberRange kFrameCounts{.least = 1, .most = 1'000'000, .isWhole = true};
inline constexpr int kDefaultOutputPx = 512;

/// How often and how a case is measured.
struct Measure {
    enum class Lane { Quality, Timing };
    Lane lane = Lane::Quality;
    int repeats = 1;    // measured iterations in one process
    int processes = 1;  // rounds, in each of which a case is run in a process of its own if more
                        // than 1; the fewest, where more may follow
    /// Timing lane: of `processes` the first alone is measured whatever it takes; the others are
    /// begun only where they end within `timeBudgetS`.
    bool isWithinBudget = false;
    double timeBudgetS = 0.0;   // of all rounds of the experiment
    int frames = 1;             // frames of a path; each is repeated
    int sceneSeeds = 1;         // samples of a generated scene: its seed and those that follow it
    double timeLimitS = 120.0;  // of the whole case, scene loading included
    /// The random numbers of a case: there are none; the same in all of its processes; or others in
    /// each. Of a technique a plan tells.
    enum class Seeds { None, Case, Process };
    Seeds seeds = Seeds::None;

    /// Iterations before the first measured one.
    int warmup() const { return lane == Lane::Timing ? 1 : 0; }
    /// Whether rounds may follow the first `processes`: in the timing lane, from kFewestRounds
    /// processes on, within `timeBudgetS`, until times are known to kKnownTo.
    bool mayContinue() const;
    /// At most.
    int mostRounds() const { return mayContinue() ? kMostRounds : processes; }
    /// Rounds that are measured whatever they take.
    int certainRounds() const;
    /// Whether a round may follow the first `rounds`, which took so long each: it ends within
    /// `timeBudgetS`; or all `processes` take half more at most, as five give no interval.
    bool mayFollow(int rounds, double roundS) const;
};

/// The key of `measure` that ends rounds.
inline constexpr const char* kTimeBudget = "time_budget_s";

/// What the seed grows by from one process of a case to the next, with Seeds::Process.
inline constexpr int kSeedsOfAProcess = 1000;

/// Begins the name of an axis that is a parameter of the generated scene: "scene.blades".
inline constexpr std::string_view kSceneAxisPrefix = "scene.";

/// In a case's recorded parameters: the scene of the table whose place its own takes, and which of
/// the seeds of a generated scene it has, from 0.
inline constexpr const char* kStandsFor = "stands_for";
inline constexpr const char* kSceneSample = "scene_sample";
inline constexpr int kMostSceneSample = 999;  // of `scene_seeds`

/// One case. Of a plan it is complete: a worker needs nothing else.
struct Case {
    std::string id;          // c and 12 hexadecimal digits of the content hash
    std::string experiment;  // "zju2005/2.1"
    std::string technique;
    Node program;                    // null, or the config's `program`
    std::string programKey;          // identity of its files; empty where it is not at hand
    Node scene;                      // null or a reference: what is loaded
    Node standsFor;                  // what the config calls it, where that is another; else null
    std::optional<int> sceneSample;  // from 0, where several seeds are measured
    Node given;    // the parameters that the config gives: a technique is made from these
    Node offered;  // null, or values that take the place of the technique's defaults
    Node params;   // every declared parameter with its value, and `scene.NAME` of a
                   // generated scene where the config gives it: what records say
    Node axes;     // the swept ones
    int outputWidthPx = 0;
    int outputHeightPx = 0;
    Measure measure;
    std::uint64_t seed = 0;

    std::string title() const;   // "zju2005/2.1 scene=models/duck"
    std::string slug() const;    // "zju2005-2.1": for file names
    std::string method() const;  // the parameter of that name; empty when there is none
    /// As the config spells it, unless another takes its place: a user's own file is an absolute
    /// path in `scene`. Empty for none.
    std::string recordedScene() const;
    /// `params` with the size of the output and which scene it is: what tables and images say.
    Node recordedParams() const;
    /// What the config gives of its generated scene, by the generator's names.
    Node sceneParams() const;
};

}  // namespace gfxrepro::config
