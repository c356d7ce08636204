#include "runner/claims/claim_same_mean.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/metrics/mean_test.h"
#include "runner/config/external_program.h"

namespace gfxrepro::claims {

namespace {

/// The fewest pictures of a truth that has several; 0 where none has.
int truthFramesOf(const config::ExternalProgram& program) {
    int fewest = 0;
    for (const config::ProgramPicture& picture : program.pictures) {
        if (picture.truthFrames < 2) continue;
        fewest = fewest == 0 ? picture.truthFrames : std::min(fewest, picture.truthFrames);
    }
    return fewest;
}

}  // namespace

std::string whyNotTestable(const config::Experiment& experiment, const config::ClaimSpec& claim,
                           const ClaimReader& reader) {
    if (!reader.readsOnly(kSameMeanMetric)) {
        return fmt::format(
            "is 'same_mean': allowed: a column of the metric {}, without 'scale' "
            "and alone",
            kSameMeanMetric);
    }
    const Node& node = config::programOf(experiment);
    if (node.isNull()) return "";  // a technique that records it knows its samples
    const int truths = truthFramesOf(config::readProgram(node));
    if (truths == 0) {
        return "is 'same_mean' and needs an image whose truth has several 'frames': {frame: 1000, "
               "frames: 6}";
    }
    const int frames = experiment.measure.frames;
    if (frames < 2) return "is 'same_mean' and needs 'measure.frames', a seed each: 2 or more";
    const auto rows = static_cast<double>(reader.rowCount());
    const double least =
        rows * metrics::leastP(static_cast<std::size_t>(frames), static_cast<std::size_t>(truths));
    if (least <= *claim.low) return "";
    return fmt::format(
        "asks for {:.3g} % of false alarms over {} row{}, and could not fail: {} frames and {} of "
        "the truth come to no p below {:.2g} %; take more ('measure.frames', 'truth: {{frames}}')",
        100.0 * *claim.low, rows, rows == 1.0 ? "" : "s", frames, truths, 100.0 * least);
}

}  // namespace gfxrepro::claims
