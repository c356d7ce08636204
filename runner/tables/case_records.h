// The records of an experiment, ordered by case.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/case.h"
#include "runner/config/experiment.h"
#include "runner/records/records.h"

namespace gfxrepro::tables {

/// One text for one value, however it is spelt: 64 and 64.0, or a scene as text or as a map.
std::string canonicalText(const Node& value);

/// The values of a case beside a list of axes; empty where the case has none.
using AxisValues = std::vector<std::optional<std::string>>;

/// In place of the value of an axis that does not apply to a case.
inline constexpr std::string_view kLeftOut = "–";

/// The axis whose values are draws of one number.
inline constexpr std::string_view kSeedAxis = "seed";

/// A case with the last attempt of each of its processes; without any where it was not run. Where
/// scenes are taken at several seeds, a seed is to a case what a process is to a time: cases that
/// differ by it alone are one, whose process k has the k-th seed.
struct CaseRecords {
    struct RecordPlace {
        std::string_view metric;
        std::string_view pass;
        int frame = 0;
        int repeat = 0;
        auto operator<=>(const RecordPlace&) const = default;
    };
    struct Attempt {
        std::vector<const records::Record*> rows;  // by placeOf(), one of each; millions
        /// The values of a metric and pass: of its frames, or of set-up where no frame has one.
        std::vector<const records::Record*> values(std::string_view metric,
                                                   std::string_view pass) const;
        const records::Record* failure = nullptr;  // why the case has no rows
    };

    static RecordPlace placeOf(const records::Record* row) {
        return {row->metric, row->pass, row->frame, row->repeat};
    }

    /// Whether repeats or processes of one scene and frame came to values of it that differ by more
    /// than rounding. Where no random numbers are declared, it was measured more than once.
    bool scatters(std::string_view metric, std::string_view pass) const;
    /// Whether processes or repeats tell that it came out alike, or did not. A program says all in
    /// each process.
    bool isTakenAgain(std::string_view metric, std::string_view pass) const;
    /// Whether it ran, and recorded no such number.
    bool isWithout(std::string_view metric, std::string_view pass) const;
    /// Whether it stands under frame −1 alone, and so has no seed.
    bool isWithoutFrame(std::string_view metric, std::string_view pass) const;
    /// Whether other random numbers could give another value of the metric: it is neither a time,
    /// nor, of what is measured here, a count of the device or a test of several seeds.
    bool isOfItsSeed(std::string_view metric) const;

    /// The first pass of which it is recorded; empty also where that is none.
    std::string passOf(std::string_view metric) const;

    std::string id;
    AxisValues axes;
    std::map<int, Attempt> processes;
    std::string scene;  // Case::recordedScene()
    Node params;        // Case::recordedParams()
    config::Measure::Seeds seeds = config::Measure::Seeds::None;
    std::uint64_t seed = 0;  // of its first process
    int sceneSeeds = 1;      // at how many its scene is taken
    /// Its scene has no seeds, where others have: its processes stand there once for each of these.
    bool isRepeated = false;
    bool isOfElsewhere = false;  // LayoutCases
    /// Of a program or an import whose sweep has an axis `seed`: which of its values, from 0.
    std::optional<int> sweptSeed = {};
    bool isSeedARun = false;  // each of them was taken in one process, which timed it
    int processesAsked = 1;   // by the plan; rounds of times may end before
    /// Of a program without a seed one process of several that were asked for: nobody knows whether
    /// another comes to the same.
    bool isRunOnce = false;

    std::uint64_t seedOf(int process) const {
        if (sweptSeed && seeds == config::Measure::Seeds::None)
            return static_cast<std::uint64_t>(*sweptSeed);
        const bool isOther = seeds == config::Measure::Seeds::Process;
        return seed +
               (isOther ? static_cast<std::uint64_t>(process) * config::kSeedsOfAProcess : 0);
    }
};

/// The cases of `table` in the order of the plan, with their records, which must outlive the
/// result. A later row of a case replaces an earlier one of the same place; a failure replaces all
/// before it. Beside cases at several seeds those without a seed count at each. On an axis that
/// `when` of the sweep leaves out of a case it has the value kLeftOut.
std::vector<CaseRecords> groupByCase(std::span<const config::Case> planned,
                                     const std::vector<records::Record>& records,
                                     std::string_view table, const std::vector<std::string>& axes,
                                     const Node* when = nullptr);

}  // namespace gfxrepro::tables
