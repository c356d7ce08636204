// What a claim `same_mean` needs so that it can fail at all.
#pragma once

#include <string>

#include "runner/config/experiment.h"
#include "runner/report/claim_reader.h"

namespace gfxrepro::report {

/// The p of metrics::testMeans: what techniques record it as.
inline constexpr const char* kSameMeanMetric = "same_mean_p";

/// Why the claim cannot be judged, to follow its name; empty if it can: it reads another metric, or
/// its pictures are too few for as few false alarms.
std::string whyNotTestable(const config::Experiment& experiment, const config::ClaimSpec& claim,
                           const ClaimReader& reader);

}  // namespace gfxrepro::report
