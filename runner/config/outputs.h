// What is recorded of a case, as it is declared: metrics, and the steps of an algorithm. `describe`
// lists them, `check` and the recorder refuse others, and a table without a layout shows them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"

namespace gfxrepro::config {

/// Which way a metric is better.
enum class Better { Neither, Lower, Higher };

struct MetricInfo {
    /// What a value is of: the whole frame or case, a pass, or either, as the technique gives it.
    enum class Of { Whole, Pass, Either };
    std::string name;  // snake_case with its unit where it has one: "memory_bytes"
    std::string unit;  // spelt out: "voxel", "byte", "ms", "1"; of all its passes
    std::string doc;
    Better better = Better::Neither;
    /// Explains or checks others: a table without a layout leaves it to records.csv.
    bool isDetail = false;
    Of of = Of::Either;
    /// Of what is done before the first frame, at least in part.
    bool isOfSetup = false;
};

/// What a time is of, or a metric is told apart by. A name that ends in '*' stands for all that
/// begin so: "image_*".
struct PassInfo {
    std::string name;
    std::string doc;
    bool isOfSetup = false;  // setup() scopes it
};

/// In the order in which they are shown.
struct Outputs {
    std::vector<MetricInfo> metrics = {};
    std::vector<PassInfo> passes = {};
    /// They depend on the seed of SetupContext: Monte Carlo, jitter, a random order. Not where it
    /// only makes an input that all methods share.
    bool areRandom = false;
    /// The pictures of which a truth is recorded: the runner takes their errors (pictureErrors).
    std::vector<std::string> withTruth = {};
    /// The metrics that are given of passes alone (Of::Pass), by their names.
    std::vector<std::string> ofPasses = {};
    /// Those of a program whose truth has several pictures: same_mean_p and bias_seen are of them.
    std::vector<std::string> tested = {};

    /// Of the share `m`, `m`_of is a metric, too. Null where there is none.
    const MetricInfo* find(std::string_view metric) const;
    bool hasPass(std::string_view pass) const;
    /// Throw Error with the nearest name for what is not declared; `owner` begins the message.
    void requireMetric(std::string_view metric, const std::string& owner,
                       const SourceLocation& where = {}) const;
    void requirePass(std::string_view pass, const std::string& owner,
                     const SourceLocation& where = {}) const;
};

/// What is recorded of each picture that has a truth; its name is the pass. Of several truths the
/// first counts, which the report shows, too.
std::span<const MetricInfo> pictureErrors();
bool isPictureError(std::string_view metric);
/// Whether the metric is a test of several pictures: same_mean_p or bias_seen.
bool isTestOfMeans(std::string_view metric);

/// The column of wall_time_ms in a table that nobody laid out.
inline constexpr std::string_view kFrameTime = "frame_ms";

/// Ends the name of what a share is of.
inline constexpr std::string_view kShareOf = "_of";

/// "lower is better", "higher is better", "".
std::string_view betterText(Better better);

/// What a metric does as all times double: 1 doubles, -1 halves (a rate), 0 stays.
int timePower(std::string_view metric);
/// Whether a metric is a time or a number per time: what claims of a `kind` are about.
bool isTimeMetric(std::string_view metric);
/// What the device counts of each repeat.
bool isOfDevice(std::string_view metric);

/// Claims know times and rates by their names (timePower) and judge everything else from
/// one sample. Why a metric of that name and unit would be taken for what it is not, as a sentence;
/// empty where it is not. A time is `…_ms` in ms, or `…_us_per_…` in us; what is per second is
/// `…frame_rate` or `…_per_second`.
std::string whyNoTimeName(std::string_view name, std::string_view unit);

}  // namespace gfxrepro::config
