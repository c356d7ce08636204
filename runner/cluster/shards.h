// A plan cut into parts that separate machines run, and their runs put together into one, as if one
// machine had measured it all.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/run/plan.h"
#include "runner/run/run.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::cluster {

/// "2/4"; its cases are still empty. Throws UsageError.
run::Shard parseShard(std::string_view text);

/// What is not cut: the timing cases of an experiment, whose times stand in one table and are
/// measured alternately on one device; and twins, which are measured once where they are together.
/// Every other case is alone. Indices into `cases`.
std::vector<std::vector<std::size_t>> indivisibleGroups(std::span<const config::Case> cases);

/// The shard (from 0) of each case: the groups by falling time, each to the shard that has least
/// (longest processing time first; Graham 1969: at most 4/3 of the best possible end). Depends on
/// nothing but its arguments.
std::vector<int> cutShards(std::span<const config::Case> cases, std::span<const double> timesS,
                           int count);

/// The plan of one shard: the cases that `shardOf` gives it, with their experiments and scenes. It
/// has the size of what the shard measures, however large the whole is.
run::Plan shardPlan(const run::Plan& whole, const run::Shard& shard, std::span<const int> shardOf);

/// Where the whole plan of shards lies: two folders above those of a submission, and in the folder
/// of one that was cut by hand.
inline constexpr const char* kSubmittedPlan = "submitted-plan.json";
inline constexpr const char* kWholePlan = "whole-plan.json";

/// A shard's run, and where it lies.
struct ShardRun {
    std::filesystem::path path;
    run::StoredRun run;
};

/// The plan that the runs were cut from, for the class of device that they measured on. Throws
/// Error where it is at hand of none of them, or is another than was cut.
run::Plan wholePlan(const std::vector<ShardRun>& shards);

/// One run of the whole plan: the records in the order of the plan, the manifests together.
/// `commandLine` is the one invocation of the new manifest. Throws Error for shards of different
/// plans, for a case that two of them have or the plan has not, where the times of one table are
/// from different machines, and for more rows or bytes than are read of a run.
run::StoredRun mergeRuns(run::Plan whole, const std::vector<ShardRun>& shards,
                         const std::string& commandLine);

/// Of the units of the plan those without a row: "zju2005/2.1 scene=models/duck".
std::vector<std::string> missingUnits(const run::StoredRun& run);
/// Which of the cut's shards are not there: "2/4".
std::vector<std::string> missingShards(const std::vector<ShardRun>& shards);

/// Writes plan, manifest, records, journal and images into `directory`, the plan last.
void writeMerged(const run::RunDirectory& directory, const std::vector<ShardRun>& shards,
                 const run::StoredRun& merged);

}  // namespace gfxrepro::cluster
