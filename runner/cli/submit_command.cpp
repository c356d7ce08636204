// A plan handed to other machines: as a Slurm array job with a merge behind it, or as commands.
#include <fmt/core.h>
#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/forecast.h"
#include "runner/cluster/shards.h"
#include "runner/cluster/submission.h"
#include "runner/run/child_process.h"
#include "runner/run/plan_json.h"
#include "runner/run/run.h"
#include "runner/run/twins.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;
using cluster::Submission;
using run::Json;

namespace {

constexpr std::chrono::seconds kSlurmLimit{120};  // for an answer

/// What sbatch said: a job's number, or why it refused it.
struct SbatchAnswer {
    std::string job;
    std::string cluster;  // empty: the one that takes jobs by default
    std::string refusal;
};

/// The number is what --parsable prints last: "123" or "123;cluster". Throws Error where sbatch
/// took something and gave none.
SbatchAnswer sbatch(std::vector<std::string> arguments) {
    constexpr int kNotFound = 127;  // env's
    arguments.insert(arguments.begin(), {"/usr/bin/env", "sbatch", "--parsable"});
    const run::ProgramEnd end = run::runToEnd(arguments, kSlurmLimit);
    const std::string text(trimmed(end.output));
    if (end.exitCode != 0) {
        return {"", "",
                fmt::format("sbatch did not take the job (exit code {}): {}{}", end.exitCode, text,
                            end.exitCode == kNotFound
                                ? "; where there is no Slurm, --engine commands prints commands"
                                : "")};
    }
    const std::string last = text.substr(text.rfind('\n') + 1);
    const std::size_t jobEnd = std::min(last.find(';'), last.size());
    const std::string job = last.substr(0, jobEnd);
    const std::string cluster = last.substr(std::min(jobEnd + 1, last.size()));
    if (parseInteger(job)) return {job, cluster, ""};
    throw Error(
        "sbatch gave no number of a job, so what is queued is not known; squeue shows it: " + text);
}

/// The states of these jobs' tasks on the cluster ("": the default one), as cluster::parseQueue()
/// gives them. None when squeue is not there or does not answer: then nothing is known, least of
/// all an end. A queue forgets jobs that ended, and answers.
std::optional<std::map<std::string, std::string>> askQueue(const std::vector<std::string>& jobs,
                                                           const std::string& cluster) {
    std::vector<std::string> command = {"/usr/bin/env", "squeue",  "-h", "-r",
                                        "-t",           "all",     "-j", joined(jobs, ","),
                                        "-o",           "%F_%K %T"};
    if (!cluster.empty()) command.push_back("--clusters=" + cluster);
    const run::ProgramEnd end = run::runToEnd(command, kSlurmLimit);
    // Its answer to the number of a single job that it has forgotten.
    if (end.output.find("Invalid job id") != std::string::npos) {
        return std::map<std::string, std::string>();
    }
    if (end.exitCode != 0) return std::nullopt;
    std::map<std::string, std::string> states = cluster::parseQueue(end.output);
    const std::string_view said = trimmed(end.output);
    const bool isHead = said == "CLUSTER: " + cluster;  // of an answer without a task
    const bool isNotice = states.empty() && !said.empty() && !isHead;
    if (isNotice) return std::nullopt;  // it says something else: not that the jobs are forgotten
    return states;
}

constexpr double kShardS = 1800.0;  // predicted, of a shard, where no number of them is given
constexpr int kUnknownShards = 8;   // where nothing is predicted either
constexpr const char* kUnknownJob = "?";

/// What of a submission is kept in submission.json.
struct Stored {
    std::vector<std::string> asked;
    std::vector<int> unitCounts;  // a shard each
    std::string arrayJob;         // empty: none; kUnknownJob: sbatch was asked, and gave no number
    std::string mergeJob;
    std::string cluster;  // that took them; empty: the one that takes jobs by default
};

fs::path storedFile(const fs::path& out) {
    return out / "submission.json";
}

std::optional<Stored> readStored(const fs::path& out) {
    if (!fs::exists(storedFile(out))) return std::nullopt;
    static constexpr JsonMember kMembers[] = {
        {"/run_arguments", JsonKind::List}, {"/run_arguments", JsonKind::Texts},
        {"/units", JsonKind::List},         {"/units", JsonKind::Ints},
        {"/array_job", JsonKind::Text},     {"/merge_job", JsonKind::Text},
        {"/cluster", JsonKind::Text, false}};
    const SourceLocation where{storedFile(out).string(), 0, 0};
    const Json json = parseJsonObject(MappedFile(storedFile(out)).text(), where);
    requireMembers(json, kMembers, where);
    return Stored{json.at("run_arguments"), json.at("units"), json.at("array_job"),
                  json.at("merge_job"), json.value("cluster", "")};
}

/// What its tasks measure, whatever becomes of the configs.
fs::path frozenPlan(const fs::path& out) {
    return out / cluster::kSubmittedPlan;
}

/// The program that they run, whatever is built later.
fs::path programFolder(const fs::path& out) {
    return out / "submitted-program";
}

void writeStored(const fs::path& out, const Stored& stored) {
    const Json json = {{"run_arguments", stored.asked},
                       {"units", stored.unitCounts},
                       {"array_job", stored.arrayJob},
                       {"merge_job", stored.mergeJob},
                       {"cluster", stored.cluster}};
    writeFileAtomic(storedFile(out), json.dump(1) + '\n');
}

/// All that was asked for: a submission that is continued must ask for the same.
std::vector<std::string> askedFor(const SubmitOptions& options, const run::Request& request) {
    std::vector<std::string> arguments = request.configs;
    const auto add = [&](const char* option, const std::string& value) {
        arguments.insert(arguments.end(), {option, value});
    };
    add("--profile", options.selection.profile);
    add("--device", request.device);
    add("--assets", fs::absolute(assetsFolder(options.selection.assets)));
    for (const std::string& set : request.sets) add("--set", set);
    for (const std::string& sweep : request.sweeps) add("--sweep", sweep);
    for (const std::string& only : request.only) add("--only", only);
    if (options.jobs > 0) add("--jobs", std::to_string(options.jobs));
    return arguments;
}

/// As many as were asked for or as the predicted time fills; not more than can be filled.
int shardCountOf(const SubmitOptions& options, int most, const std::vector<double>& timesS,
                 bool arePredicted) {
    if (options.shardCount > 0) return std::min(options.shardCount, most);
    const double totalS = std::accumulate(timesS.begin(), timesS.end(), 0.0);
    const int wanted =
        arePredicted ? static_cast<int>(std::ceil(totalS / kShardS)) : kUnknownShards;
    return std::clamp(wanted, 1, most);
}

/// A submission with its cut: which shard has how many units.
struct Cut {
    Submission submission;
    std::vector<std::string> asked;
    std::vector<int> shardOf;  // of each case of the plan
    std::vector<int> unitCounts;
    std::vector<double> timesS;  // predicted, a shard each
    cluster::Predictor predictor;
    run::Plan plan;
};

Cut cutPlan(const Context& context, const SubmitOptions& options) {
    const run::Request request =
        requestOf(options.selection, findPaperConfigs(options.selection.names));
    const fs::path out = fs::absolute(options.out).lexically_normal();
    const std::string& assets = options.selection.assets;
    Cut cut;
    cut.asked = askedFor(options, request);
    // A submission that is continued is cut as it was, from the plan as it was.
    const std::optional<Stored> before = readStored(out);
    const bool isBegun = before.has_value();
    const bool isFrozen = isBegun && before->asked == cut.asked && fs::exists(frozenPlan(out));
    if (isFrozen) {
        cut.plan = run::Plan::fromJsonFile(frozenPlan(out));
        warnOfChangedConfigs(cut.plan, "what was submitted is measured");
    } else {
        cut.plan = planFor(context, request, options.selection.profile, assets,
                           deviceClassFor(options.selection));
    }
    History history = isBegun ? openHistory({out / "predictions.csv"}, "")
                              : openHistory(options.from, cut.plan.deviceClass);
    const bool arePredicted = !forecastText(cut.plan, history, 1).empty();
    const std::vector<double> timesS =
        run::withoutTwins(cut.plan.cases, cluster::caseTimesS(cut.plan, history.predictor));
    Submission& s = cut.submission;
    s.name = runSlug(cut.plan);
    s.program = cluster::keptProgram(programFolder(out));
    s.runArguments = {"--assets", fs::absolute(assetsFolder(assets))};
    if (options.jobs > 0)
        s.runArguments.insert(s.runArguments.end(), {"--jobs", std::to_string(options.jobs)});
    s.out = out;
    const auto most =
        std::max(static_cast<int>(cluster::indivisibleGroups(cut.plan.cases).size()), 1);
    s.shardCount = shardCountOf(options, most, timesS, arePredicted);
    if (!options.partition.empty()) s.sbatchFlags.push_back("--partition=" + options.partition);
    if (!options.gres.empty()) s.sbatchFlags.push_back("--gres=" + options.gres);
    s.sbatchFlags.insert(s.sbatchFlags.end(), options.sbatchFlags.begin(),
                         options.sbatchFlags.end());

    cut.shardOf = cluster::cutShards(cut.plan.cases, timesS, s.shardCount);
    s.timeLimitMin = cluster::timeLimitMin(cut.plan, cut.shardOf, timesS, arePredicted);
    cut.unitCounts.resize(static_cast<std::size_t>(s.shardCount));
    cut.timesS.resize(cut.unitCounts.size());
    for (std::size_t i = 0; i < cut.plan.cases.size(); ++i) {
        const config::Measure& measure = cut.plan.cases[i].measure;
        s.isExclusive = s.isExclusive || measure.lane == config::Measure::Lane::Timing;
        const auto shard = static_cast<std::size_t>(cut.shardOf[i]);
        cut.unitCounts[shard] += measure.certainRounds();
        cut.timesS[shard] += timesS[i];
    }
    const bool isCut = static_cast<std::size_t>(most) == cut.plan.cases.size();
    const std::string why = isCut ? "" : " as timing cases of one table and twins stay together,";
    tell("{} cases in {} shard{}{} of {} to {} units{}\n", cut.plan.cases.size(), s.shardCount,
         s.shardCount == 1 ? "" : "s",
         options.shardCount > most ? fmt::format(" and not {},{}", options.shardCount, why) : "",
         *std::ranges::min_element(cut.unitCounts), *std::ranges::max_element(cut.unitCounts),
         arePredicted ? fmt::format(", the longest of about {}",
                                    durationText(*std::ranges::max_element(cut.timesS)))
                      : "; no earlier run tells their time");
    cut.predictor = std::move(history.predictor);
    return cut;
}

/// The shards of one plan with their folders, as far as they are looked at.
struct Parts {
    std::string whole;  // the plan's SHA-256
    std::map<int, fs::path> folders = {};

    /// Why the shard that a folder holds is none of them, or none that is not there already.
    std::string whyNot(const std::optional<run::Shard>& shard, const fs::path& folder) {
        if (!shard || shard->whole != whole) {
            return "no part of the submitted plan: it was replaced";
        }
        const auto [first, isNew] = folders.try_emplace(shard->index, folder);
        if (isNew) return "";
        return fmt::format("the shard {} once more: {} holds it, too", shard->name(),
                           first->second.string());
    }
};

/// What a folder holds, whichever of the `parts` it is, as for a merge; of the merged run, which is
/// none, `parts` is null.
cluster::ShardProgress progressOf(const fs::path& folder, int unitCount, Parts* parts) {
    cluster::ShardProgress progress{unitCount, 0, 0};
    if (!run::holdsRun(folder)) return progress;
    try {
        std::optional<run::Plan> plan;
        if (parts) {
            plan = run::planWithUnreadExperiments(folder / "plan.json");
            progress.problem = parts->whyNot(plan->shard, folder);
        }
        const run::Completeness counts = run::readCompleteness(folder, plan ? &*plan : nullptr);
        progress.unitCount = counts.units;
        progress.finished = counts.measured();
        progress.failed = counts.failed;
    } catch (const Error& error) {
        progress.problem = error.what();
    }
    return progress;
}

std::vector<std::string> storedJobs(const Stored& stored) {
    std::vector<std::string> jobs;
    for (const std::string& job : {stored.arrayJob, stored.mergeJob}) {
        if (!job.empty() && job != kUnknownJob) jobs.push_back(job);
    }
    return jobs;
}

std::optional<std::map<std::string, std::string>> askForStored(const Stored& stored) {
    const std::vector<std::string> jobs = storedJobs(stored);
    if (jobs.empty()) return std::nullopt;
    return cli::askQueue(jobs, stored.cluster);
}

std::string taskOf(const Stored& stored, int shard) {
    return stored.arrayJob.empty() ? "" : fmt::format("{}_{}", stored.arrayJob, shard);
}

int printStatus(const fs::path& out) {
    const std::optional<Stored> stored = readStored(out);
    if (!stored) throw Error(out.string() + ": holds no submission");
    const auto queue = askForStored(*stored);
    std::vector<std::vector<std::string>> rows = {{"shard", "done", "failed", "state"}};
    const auto count = static_cast<int>(stored->unitCounts.size());
    Parts parts{sha256OfFile(frozenPlan(out))};
    bool isComplete = true;
    for (int k = 1; k <= count; ++k) {
        const cluster::ShardProgress progress =
            progressOf(out / "shards" / std::to_string(k),
                       stored->unitCounts[static_cast<std::size_t>(k - 1)], &parts);
        isComplete = isComplete && progress.isComplete();
        rows.push_back({run::Shard{k, count}.name(),
                        fmt::format("{}/{}", progress.finished, progress.unitCount),
                        std::to_string(progress.failed),
                        cluster::stateOf(progress, queue, taskOf(*stored, k))});
    }
    const bool isMerged = fs::exists(out / "plan.json");
    cluster::ShardProgress merged{isMerged ? 0 : 1, 0, 0};
    if (isMerged) merged = progressOf(out, 0, nullptr);
    rows.push_back({"merge",
                    isMerged ? fmt::format("{}/{}", merged.finished, merged.unitCount) : "",
                    isMerged ? std::to_string(merged.failed) : "",
                    cluster::stateOf(merged, queue, stored->mergeJob)});
    fmt::print("{}", alignedColumns(rows));
    const bool isWhole = isMerged && merged.isComplete() && merged.failed == 0;
    return isComplete && isWhole ? kExitOk : kExitIncomplete;
}

/// Plan and cut are there once; a shard gets its own cases with the hash of the whole, so that its
/// task reads nothing else.
void freeze(const Context& context, const Cut& cut, bool isBegun) {
    const Submission& s = cut.submission;
    const fs::path file = frozenPlan(s.out);
    if (!isBegun || !fs::exists(file)) cut.plan.writeFile(file);
    run::Shard shard{1, s.shardCount, sha256OfFile(file),
                     deviceFor(context, cut.plan.request.device, cut.plan.experiments)};
    for (; shard.index <= s.shardCount; ++shard.index) {
        const fs::path folder = s.shardFolder(shard.index);
        if (isBegun && fs::exists(folder / "plan.json")) continue;
        if (run::holdsRun(folder)) {
            throw Error(folder.string() + ": holds a run already; give another folder");
        }
        cluster::shardPlan(cut.plan, shard, cut.shardOf).writeFile(folder / "plan.json");
    }
}

/// Of a submission that was refused nothing stays that could be taken for queued.
void removeRefused(const fs::path& out) {
    std::error_code isNotEmpty;
    for (const fs::path& shard : cluster::shardFolders(out)) {
        if (!run::holdsRun(shard)) fs::remove(shard / "plan.json");
        fs::remove(shard, isNotEmpty);
    }
    for (const fs::path& file : {storedFile(out), frozenPlan(out), out / "predictions.csv",
                                 out / "task.sh", out / "merge.sh"}) {
        fs::remove(file);
    }
    fs::remove_all(programFolder(out));
    for (const fs::path& folder : {out / "shards", out}) fs::remove(folder, isNotEmpty);
}

/// The array job's and the merge job's arguments; `arrayJob` is known when the second is asked for.
std::vector<std::string> arrayArguments(const Submission& s, const std::string& indices) {
    return {"--array=" + indices, fmt::format("--output={}", (s.out / "task-%a.txt").string()),
            s.out / "task.sh"};
}
std::vector<std::string> mergeArguments(const Submission& s, const std::string& arrayJob,
                                        const std::string& cluster) {
    std::vector<std::string> arguments = {
        fmt::format("--output={}", (s.out / "merge.txt").string()), s.out / "merge.sh"};
    if (!arrayJob.empty()) arguments.insert(arguments.begin(), "--dependency=afterany:" + arrayJob);
    if (!cluster.empty()) arguments.insert(arguments.begin(), "--clusters=" + cluster);
    return arguments;
}

std::vector<int> incompleteShards(const Cut& cut) {
    std::vector<int> incomplete;
    const Submission& s = cut.submission;
    const fs::path plan = frozenPlan(s.out);
    Parts parts{fs::exists(plan) ? sha256OfFile(plan) : ""};  // else a dry run
    for (int k = 1; k <= s.shardCount; ++k) {
        const cluster::ShardProgress progress =
            progressOf(s.shardFolder(k), cut.unitCounts[static_cast<std::size_t>(k - 1)], &parts);
        if (!progress.problem.empty()) {
            throw Error(fmt::format("{}: {}", s.shardFolder(k).string(), progress.problem));
        }
        if (!progress.isComplete()) incomplete.push_back(k);
    }
    return incomplete;
}

/// Nothing is queued twice. Throws where the queue has one of the shards or the merge, and, unless
/// forced to, where it may have.
void requireNotQueued(const Stored& before, const fs::path& out, const std::vector<int>& shards,
                      bool isForced) {
    std::map<std::string, std::string> tasks;  // what each is, by the queue's name
    if (!before.arrayJob.empty()) {
        for (const int k : shards) tasks[taskOf(before, k)] = fmt::format("shard {}", k);
    }
    const bool isMerged = fs::exists(out / "plan.json") && progressOf(out, 0, nullptr).isComplete();
    if (!before.mergeJob.empty() && !isMerged) tasks[before.mergeJob] = "the merge";
    if (tasks.empty()) return;
    const auto queue = askForStored(before);
    for (const auto& [task, name] : tasks) {
        if (!queue || !cluster::isUnderWay(*queue, task)) continue;
        throw Error(fmt::format("{}: {} is {} already; wait, or scancel {}", out.string(), name,
                                queue->at(task), task.substr(0, task.find('_'))));
    }
    const bool isUnknown = before.arrayJob == kUnknownJob || before.mergeJob == kUnknownJob;
    if (isForced || (queue && !isUnknown)) return;
    throw Error(fmt::format(
        "{}: {}, so {} may be queued; look with squeue, and submit again with "
        "--force where nothing is",
        out.string(), isUnknown ? "sbatch gave no number of a job" : "the queue does not answer",
        tasks.begin()->second));
}

/// The number of the job that is asked for: until it is known the file says that it is not.
SbatchAnswer sbatchStored(const std::vector<std::string>& arguments, const fs::path& out,
                          Stored& stored, std::string Stored::*job) {
    stored.*job = std::string(kUnknownJob);
    writeStored(out, stored);
    SbatchAnswer answer = sbatch(arguments);
    stored.*job = answer.job;
    if (!answer.job.empty()) stored.cluster = answer.cluster;
    writeStored(out, stored);
    return answer;
}

int submitToSlurm(const Cut& cut, const std::optional<Stored>& before,
                  const SubmitOptions& options) {
    const Submission& s = cut.submission;
    const std::vector<int> pending = incompleteShards(cut);
    if (before) requireNotQueued(*before, s.out, pending, options.isForced);
    const std::string indices = cluster::arrayIndices(pending);
    if (options.isDryRun) {
        fmt::print("# {}\n{}# {}\n{}", (s.out / "task.sh").string(), cluster::taskScript(s),
                   (s.out / "merge.sh").string(), cluster::mergeScript(s));
        if (!pending.empty()) fmt::print("sbatch {}\n", joined(arrayArguments(s, indices), " "));
        fmt::print("sbatch {}\n", joined(mergeArguments(s, pending.empty() ? "" : "JOB", ""), " "));
        return kExitOk;
    }
    writeFileAtomic(s.out / "task.sh", cluster::taskScript(s));
    writeFileAtomic(s.out / "merge.sh", cluster::mergeScript(s));
    Stored stored{cut.asked, cut.unitCounts, "", "", ""};
    if (!pending.empty()) {
        const SbatchAnswer array =
            sbatchStored(arrayArguments(s, indices), s.out, stored, &Stored::arrayJob);
        if (!array.refusal.empty()) {
            if (before) {
                writeStored(s.out, *before);
            } else {
                removeRefused(s.out);
            }
            throw Error(array.refusal + "; nothing was queued");
        }
    }
    const SbatchAnswer merge = sbatchStored(mergeArguments(s, stored.arrayJob, stored.cluster),
                                            s.out, stored, &Stored::mergeJob);
    if (!merge.refusal.empty()) {
        throw Error(fmt::format(
            "the merge: {}; {}; submit again when the shards are complete", merge.refusal,
            pending.empty() ? "nothing was queued" : "array " + stored.arrayJob + " is queued"));
    }
    fmt::print("array {} (shards {}), merge {}; gfxrepro submit --status {}\n",
               pending.empty() ? "none" : stored.arrayJob, pending.empty() ? "none" : indices,
               stored.mergeJob, s.out.string());
    return kExitOk;
}

int writeCommands(const Cut& cut, bool isDryRun) {
    const Submission& s = cut.submission;
    std::string commands;
    for (int k = 1; k <= s.shardCount; ++k) commands += cluster::shardCommand(s, k) + '\n';
    const std::string merge = cluster::mergeCommand(s) + '\n';
    fmt::print("{}{}", commands, merge);
    if (isDryRun) return kExitOk;
    writeFileAtomic(s.out / "commands.txt", commands);
    writeFileAtomic(s.out / "merge.sh", "#!/bin/sh\n" + merge);
    writeStored(s.out, {cut.asked, cut.unitCounts, "", "", ""});
    tell("parallel --jobs 1 < {}; sh {}\n", (s.out / "commands.txt").string(),
         (s.out / "merge.sh").string());
    return kExitOk;
}

}  // namespace

int submit(const Context& context, const SubmitOptions& options) {
    if (options.isStatus) {
        if (options.selection.names.size() != 1) throw UsageError("submit: --status needs one DIR");
        return printStatus(fs::absolute(options.selection.names.front()).lexically_normal());
    }
    if (options.selection.names.empty() || options.out.empty()) {
        throw UsageError(
            "submit: give PAPER, PAPER/TABLE or config files and --out DIR, or --status DIR");
    }
    for (fs::path at = fs::absolute(options.out); at.has_relative_path(); at = at.parent_path()) {
        if (!fs::exists(at) || fs::is_directory(at)) continue;
        throw Error(at.string() + ": is a file; --out names a folder");
    }
    const Cut cut = cutPlan(context, options);
    const Submission& s = cut.submission;
    const std::optional<Stored> before = readStored(s.out);
    if (before && (before->asked != cut.asked || before->unitCounts != cut.unitCounts)) {
        throw Error(s.out.string() + ": holds another submission; give another folder");
    }
    // What lies in a folder without a submission was never queued: a killed submit left it.
    if (!options.isDryRun) {
        if (!before) fs::remove_all(programFolder(s.out));
        cluster::keepProgram(programFolder(s.out), cut.plan.buildId);
        if (!before) cluster::writePredictions(s.out / "predictions.csv", cut.plan, cut.predictor);
        freeze(context, cut, before.has_value());
    }
    if (options.engine == "commands") return writeCommands(cut, options.isDryRun);
    return submitToSlurm(cut, before, options);
}

}  // namespace gfxrepro::cli
