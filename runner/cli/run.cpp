#include "runner/batch/run.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/cli/progress.h"
#include "runner/core/files.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kSeed = 1;

int jobsOf(const RunOptions& options) {
    if (options.jobs > 0) return options.jobs;
    const unsigned cores = std::thread::hardware_concurrency();
    return cores <= 2 ? 1 : static_cast<int>(cores / 2);
}

/// What a run goes by: its plan, its folder, and what is left to do.
struct Prepared {
    batch::Plan plan;
    batch::RunDirectory directory;
    batch::Json manifest;
    batch::SchedulerOptions scheduler;
};

batch::Plan makePlan(const Context& context, const batch::Request& request,
                     const std::string& profile, const std::string& assets,
                     const gl::DeviceInfo& device) {
    const scene::Catalog catalog = openCatalog(assets);
    batch::Plan plan =
        batch::makePlan(loadExperiments(request, profile), catalog, context.techniques, profile,
                        device.isSoftware ? "software" : "gpu", kSeed);
    plan.request = request;
    return plan;
}

/// "zju2005-2.1" for one experiment, "zju2005" for several of a paper.
std::string runSlug(const batch::Plan& plan) {
    if (plan.experiments.empty()) return "empty";
    if (plan.experiments.size() == 1) return plan.experiments.front().slug();
    const std::string& id = plan.experiments.front().id;
    return id.substr(0, id.find('/'));
}

Prepared prepareNew(const Context& context, const RunOptions& options,
                    const batch::Request& request, batch::PhaseClock& phases) {
    const Selection& selection = options.selection;
    const batch::SchedulerOptions scheduler{
        request.device, fs::absolute(assetsFolder(selection.assets)), jobsOf(options), {}};
    // Experiments are read first: what is wrong in a config is said before a device is asked for.
    loadExperiments(request, selection.profile);
    const gl::DeviceInfo device = batch::probeDevice(scheduler, phases);
    batch::Plan plan =
        makePlan(context, request, selection.profile, scheduler.assetsFolder, device);
    const fs::path path =
        options.out.empty() ? batch::defaultRunPath(runSlug(plan)) : fs::path(options.out);
    batch::RunDirectory directory = batch::RunDirectory::create(path);
    batch::Json manifest = batch::newManifest(plan, device);
    batch::beginInvocation(manifest, context.commandLine);
    // The plan last: a folder with a plan has all that a resumed run needs.
    writeFileAtomic(directory.manifestFile(), manifest.dump(2) + '\n');
    writeFileAtomic(directory.planFile(), plan.toJson().dump(1) + '\n');
    return {std::move(plan), std::move(directory), std::move(manifest), scheduler};
}

Prepared prepareResumed(const Context& context, const RunOptions& options,
                        batch::PhaseClock& phases) {
    batch::RunDirectory directory = batch::RunDirectory::open(options.resume);
    batch::StoredRun stored = batch::readRun(options.resume);
    const batch::SchedulerOptions scheduler{stored.plan.request.device,
                                            fs::absolute(assetsFolder(options.selection.assets)),
                                            jobsOf(options),
                                            {}};
    const gl::DeviceInfo device = batch::probeDevice(scheduler, phases);
    const batch::Plan now =
        makePlan(context, stored.plan.request, stored.plan.profile, scheduler.assetsFolder, device);
    if (const std::string reason = batch::planDifference(stored.plan, now); !reason.empty()) {
        throw Error(options.resume + ": cannot be resumed: " + reason +
                    "; start a new run instead");
    }
    batch::beginInvocation(stored.manifest, context.commandLine);
    return {std::move(stored.plan), std::move(directory), std::move(stored.manifest), scheduler};
}

void saveManifest(const Context& context, Prepared& run, const batch::PhaseClock& phases) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - context.start;
    batch::endInvocation(run.manifest, phases, wall.count());
    writeFileAtomic(run.directory.manifestFile(), run.manifest.dump(2) + '\n');
}

/// ", 3 failed"; nothing for none.
std::string countText(int count, std::string_view what) {
    return count > 0 ? fmt::format(", {} {}", count, what) : "";
}

void printClaims(const std::vector<report::ClaimResult>& claims) {
    fmt::print("claims: {}\n", report::claimSummaryLine(claims));
    for (const report::ClaimResult& claim : claims) {
        if (claim.verdict != report::Verdict::Fails) continue;
        fmt::print("  {} {} fails: {}; measured {}, required {}\n", claim.table, claim.id,
                   claim.text, claim.measured, claim.required);
    }
}

/// Runs what is left; with `results`, makes tables, claims and report from it.
int execute(const Context& context, const RunOptions& options, const batch::Request& request,
            bool results) {
    batch::PhaseClock phases;
    Prepared run = options.resume.empty() ? prepareNew(context, options, request, phases)
                                          : prepareResumed(context, options, phases);
    run.scheduler.expectations = batch::Expectations(run.plan.request.configs, run.plan.deviceClass,
                                                     batch::utcTime().substr(0, 10));
    const std::vector<batch::Unit> units = batch::remainingUnits(run.plan, run.directory);
    run.directory.log({{"event", "begin"}, {"command", context.commandLine}});
    Progress progress(static_cast<int>(units.size()), options.isQuiet);
    const batch::RunOutcome outcome =
        batch::runUnits(units, run.directory, run.scheduler, phases, progress);
    progress.clear();
    run.directory.log({{"event", outcome.isInterrupted ? "interrupted" : "end"},
                       {"finished", outcome.finished},
                       {"failed", outcome.failed}});
    batch::addScenes(run.manifest, outcome.scenes);
    saveManifest(context, run, phases);
    const std::string path = run.directory.path().string();
    if (outcome.isInterrupted) {
        fmt::print(stderr, "interrupted; continue with: gfxrepro {} --resume {}\n",
                   results ? "reproduce" : "run", path);
        return kExitInterrupted;
    }
    for (const std::string& line : outcome.complaints) fmt::print(stderr, "{}\n", line);
    fmt::print("{} of {} finished{}{}{}{}; records: {}\n", outcome.finished,
               batch::measuredCount(units), countText(outcome.flaky, "flaky"),
               countText(outcome.voided, "with void times"), countText(outcome.failed, "failed"),
               countText(outcome.expected, "failed or skipped as expected"),
               run.directory.recordsFile().string());
    if (!results) return outcome.failed + outcome.voided > 0 ? kExitIncomplete : kExitOk;

    const std::vector<report::ClaimResult> claims =
        batch::writeResults(path, batch::readRun(path), {});
    saveManifest(context, run, phases);
    printClaims(claims);
    fmt::print("report: {}\n", (run.directory.path() / "report.html").string());
    const bool anyFails = std::any_of(claims.begin(), claims.end(), [](const auto& claim) {
        return claim.verdict == report::Verdict::Fails;
    });
    if (anyFails) return kExitClaimFailed;
    return outcome.failed + outcome.voided > 0 ? kExitIncomplete : kExitOk;
}

batch::Request requestOf(const Selection& selection, const std::vector<std::string>& files) {
    batch::Request request{{}, selection.sets, selection.sweeps, selection.device};
    for (const std::string& file : files) {
        request.configs.push_back(fs::absolute(file).lexically_normal());
    }
    return request;
}

}  // namespace

int run(const Context& context, const RunOptions& options) {
    const std::vector<std::string>& files = options.selection.names;
    if (options.resume.empty() == files.empty()) {
        throw UsageError("run: give config files, or --resume DIR alone");
    }
    return execute(context, options, requestOf(options.selection, files), false);
}

int reproduce(const Context& context, const RunOptions& options) {
    std::vector<std::string> files;
    if (options.resume.empty()) files = findPaperConfigs(options.selection.names);
    return execute(context, options, requestOf(options.selection, files), true);
}

}  // namespace gfxrepro::cli
