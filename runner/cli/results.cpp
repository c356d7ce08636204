// Tables, claims and report, made again from a run's records; no GPU needed.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "runner/batch/run.h"
#include "runner/cli/commands.h"
#include "runner/cli/results.h"

namespace gfxrepro::cli {

namespace {

/// Says what is missing; the exit code of a command that has nothing worse to report.
int completenessCode(const batch::StoredRun& run) {
    const batch::Completeness counts = batch::completeness(run);
    if (counts.missing + counts.failed == 0) return kExitOk;
    fmt::print("incomplete: {} not run, {} failed\n", counts.missing, counts.failed);
    return kExitIncomplete;
}

}  // namespace

int conclude(const std::filesystem::path& runDir) {
    const std::vector<report::ClaimResult> claims =
        batch::writeResults(runDir, batch::readRun(runDir), {});
    fmt::print("claims: {}\n", report::claimSummaryLine(claims));
    bool anyFails = false;
    for (const report::ClaimResult& claim : claims) {
        if (claim.verdict != report::Verdict::Fails) continue;
        anyFails = true;
        fmt::print("  {} {} fails: {}; measured {}, required {}\n", claim.table, claim.id,
                   claim.text, claim.measured, claim.required);
    }
    fmt::print("report: {}\n", (runDir / "report.html").string());
    return anyFails ? kExitClaimFailed : kExitOk;
}

int table(const std::string& runDir) {
    const batch::StoredRun run = batch::readRun(runDir);
    batch::writeResults(runDir, run, {.tables = true, .claims = false, .report = false});
    for (const config::Experiment& experiment : run.plan.experiments) {
        fmt::print("{}: tables/{}.csv .md .tex\n", experiment.id, experiment.slug());
    }
    return completenessCode(run);
}

int claims(const std::string& runDir) {
    const batch::StoredRun run = batch::readRun(runDir);
    const std::vector<report::ClaimResult> results =
        batch::writeResults(runDir, run, {.tables = false, .claims = true, .report = false});
    for (const report::ClaimResult& claim : results) {
        fmt::print("{} {}: {}{}\n", claim.table, claim.id, report::verdictName(claim.verdict),
                   claim.reason.empty() ? "" : "; " + claim.reason);
    }
    fmt::print("{}\n", report::claimSummaryLine(results));
    const bool anyFails = std::any_of(results.begin(), results.end(), [](const auto& claim) {
        return claim.verdict == report::Verdict::Fails;
    });
    const int code = completenessCode(run);
    return anyFails ? kExitClaimFailed : code;
}

int report(const std::string& runDir) {
    const batch::StoredRun run = batch::readRun(runDir);
    batch::writeResults(runDir, run, {.tables = false, .claims = false, .report = true});
    fmt::print("report: {}\n", (std::filesystem::path(runDir) / "report.html").string());
    return completenessCode(run);
}

}  // namespace gfxrepro::cli
