// Plans, runs and pasts made by hand.
#pragma once

#include <string>

#include "runner/cluster/predictions.h"
#include "runner/cluster/shards.h"

namespace gfxrepro::test {

/// A case of technique "mock" with `method` and the number `size` as parameters and axes; its id is
/// "<experiment> <method> <size>".
config::Case makeCase(const std::string& experiment, const std::string& method, int size,
                      config::Measure::Lane lane = config::Measure::Lane::Quality);

/// A past case whose iteration takes `renderS` and nothing else takes time.
cluster::PastCase makePast(const config::Case& item, double renderS);

/// A row of the metric "number" for a case.
records::Record makeRow(const config::Case& item, double value, int process = 0);

/// The run of the shard `index`/`count` of `plan` with rows of all its `cases` (places in the
/// plan), on a machine with this renderer, in the folder "s<index>".
cluster::ShardRun makeShard(const run::Plan& plan, int index, int count,
                            const std::vector<std::size_t>& cases,
                            const std::string& renderer = "GPU A");

}  // namespace gfxrepro::test
