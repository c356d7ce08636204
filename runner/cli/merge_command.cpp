// Shards into one run.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/core/near_file.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/reading_commands.h"
#include "runner/cluster/shards.h"
#include "runner/cluster/submission.h"
#include "runner/run/manifest.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostNamed = 20;

bool isSubmission(const fs::path& folder) {
    return fs::exists(folder / cluster::kSubmittedPlan) || fs::exists(folder / "shards");
}

cluster::ShardRun readShard(const fs::path& folder) {
    cluster::ShardRun shard{folder, run::readPart(folder)};
    run::noteChangedImages(shard.run.manifest, folder);
    return shard;
}

/// Those of the folders that hold a run; the others are said. A submission stands for its shards,
/// of which some may not be begun.
std::vector<fs::path> foldersOfRuns(const std::vector<std::string>& given) {
    std::vector<fs::path> folders;
    for (const fs::path folder : given) {
        const bool isOfShards = isSubmission(folder);
        for (const fs::path& shard :
             isOfShards ? cluster::shardFolders(folder) : std::vector<fs::path>{folder}) {
            if (run::holdsRun(shard)) {
                folders.push_back(shard);
            } else if (!isOfShards) {
                tell("{}: {}\n", folder.string(),
                     fs::exists(folder) ? "holds no run"
                                        : "there is no such folder" + suggestedFile(folder));
            }
        }
    }
    if (folders.empty()) throw Error("merge: none of the folders holds a run");
    return folders;
}

/// A merge may be made again, unless something was measured into it since.
run::RunDirectory openTarget(const fs::path& out, const run::Plan& plan) {
    if (!fs::exists(out / "plan.json")) return run::RunDirectory::create(out);
    const run::Json before = run::readManifest(out / "manifest.json");
    if (before.value("plan", "") == plan.hash && run::isOnlyMerged(before)) {
        return run::RunDirectory::open(out);
    }
    throw Error(out.string() +
                ": holds a run that is no merge of these shards; give another "
                "folder");
}

void printMissing(const std::vector<cluster::ShardRun>& shards,
                  const std::vector<std::string>& units) {
    for (const std::string& shard : cluster::missingShards(shards)) {
        say("missing: shard {}\n", shard);
    }
    for (std::size_t i = 0; i < std::min(units.size(), kMostNamed); ++i) {
        say("missing: {}\n", units[i]);
    }
    if (units.size() > kMostNamed) say("missing: {} more\n", units.size() - kMostNamed);
}

}  // namespace

int merge(const Context& context, std::string out, const std::vector<std::string>& shards) {
    const std::vector<fs::path> folders = foldersOfRuns(shards);
    if (out.empty() && shards.size() == 1 && isSubmission(shards.front())) out = shards.front();
    if (out.empty()) {
        throw UsageError(
            "merge: --out is missing: folder of the whole run; for example: gfxrepro merge "
            "shard-1 shard-2 --out whole");
    }
    std::vector<cluster::ShardRun> runs;
    for (const fs::path& folder : folders) runs.push_back(readShard(folder));
    const run::StoredRun merged =
        cluster::mergeRuns(cluster::wholePlan(runs), runs, context.commandLine);
    {
        const run::RunDirectory directory = openTarget(out, merged.plan);
        cluster::writeMerged(directory, runs, merged);
    }
    const std::vector<std::string> missing = cluster::missingUnits(merged);
    const run::Completeness counts = run::completeness(merged);
    printMissing(runs, missing);
    say("merged {} shard{} into {}: {} of {} measured, {} failed, {} missing\n", runs.size(),
        runs.size() == 1 ? "" : "s", out, counts.measured(), counts.units, counts.failed,
        counts.missing);
    const int verdict = conclude(out);
    if (counts.isComplete()) return verdict;
    say("what is missing or failed is measured by: gfxrepro run --resume {}\n", out);
    return kExitIncomplete;
}

}  // namespace gfxrepro::cli
