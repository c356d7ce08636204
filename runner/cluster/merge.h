// The runs of a plan's shards put together into one run, as if one machine had measured it all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/run/run.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::cluster {

/// A shard's run and where it lies.
struct ShardRun {
    std::filesystem::path path;
    run::StoredRun run;
};

/// One run of the whole plan: the records in the order of the plan, the manifests together.
/// `commandLine` is the one invocation of the new manifest. Throws Error for shards of different
/// plans, for a case that two of them have, and where the times of one table are from different
/// machines.
run::StoredRun mergeRuns(const std::vector<ShardRun>& shards, const std::string& commandLine);

/// Of the units of the plan those without a row: "zju2005/2.1 scene=models/duck".
std::vector<std::string> missingUnits(const run::StoredRun& run);
/// Which of the cut's shards are not there: "2/4".
std::vector<std::string> missingShards(const std::vector<ShardRun>& shards);

/// Writes plan, manifest, records, journal, images and artifacts into `directory`, the plan last.
void writeMerged(const run::RunDirectory& directory, const std::vector<ShardRun>& shards,
                 const run::StoredRun& merged);

}  // namespace gfxrepro::cluster
