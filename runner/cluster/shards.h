// A plan cut into parts that separate machines run.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "runner/run/plan.h"

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

/// Marks the plan as shard `shard` of a cut by these times.
void takeShard(run::Plan& plan, const run::Shard& shard, std::span<const double> timesS);

}  // namespace gfxrepro::cluster
