// What a claim `same_mean` needs so that it can fail at all.
#pragma once

#include <string>

#include "runner/claims/claim_reader.h"
#include "runner/config/experiment.h"

namespace gfxrepro::claims {

/// The p of metrics::testMeans: what techniques record it as.
inline constexpr const char* kSameMeanMetric = "same_mean_p";

/// Why the claim cannot be judged, to follow its name; empty if it can: it reads another metric, or
/// its pictures are too few for as few false alarms.
std::string whyNotTestable(const config::Experiment& experiment, const config::ClaimSpec& claim,
                           const ClaimReader& reader);

}  // namespace gfxrepro::claims
