#include "runner/cluster/submission.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/output_files.h"
#include "engine/core/text.h"
#include "runner/run/child_process.h"
#include "runner/run/plan.h"

namespace gfxrepro::cluster {

namespace fs = std::filesystem;

namespace {

constexpr int kMergeLimitMin = 60;

/// With the shaders and configs that lie beside it, whatever the user's environment says.
std::string programCommand(const Submission& submission) {
    return fmt::format("env GFXREPRO_DATA={} {}", shellQuoted(submission.program.parent_path()),
                       shellQuoted(submission.program));
}

/// `folder` is a shell word.
std::string runCommand(const Submission& submission, const std::string& folder) {
    std::string arguments;
    for (const std::string& argument : submission.runArguments) {
        arguments += shellQuoted(argument) + ' ';
    }
    return fmt::format("{} run --quiet {}--resume {}", programCommand(submission), arguments,
                       folder);
}

/// What both scripts begin with. A task of a lost node runs again; its output goes on in the file.
std::string scriptHead(const std::string& jobName, int limitMin) {
    return fmt::format(
        "#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --ntasks=1\n#SBATCH --time={}\n"
        "#SBATCH --requeue\n#SBATCH --open-mode=append\n",
        jobName, limitMin);
}

bool isStopped(const std::string& state) {
    return state != "PENDING" && state != "RUNNING" && state != "CONFIGURING" &&
           state != "COMPLETING" && state != "SUSPENDED" && state != "REQUEUED" &&
           state != "REQUEUE_HOLD" && state != "STOPPED";
}

}  // namespace

fs::path Submission::shardFolder(int index) const {
    return out / "shards" / std::to_string(index);
}

std::vector<fs::path> shardFolders(const fs::path& out) {
    std::map<long long, fs::path> folders;
    if (!fs::exists(out / "shards")) return {};
    for (const auto& entry : entriesIn(out / "shards")) {
        const auto index = parseInteger(entry.path().filename().string());
        if (index) folders[*index] = entry.path();
    }
    std::vector<fs::path> ordered;
    for (auto& [index, folder] : folders) ordered.push_back(std::move(folder));
    return ordered;
}

std::string shardCommand(const Submission& submission, int index) {
    return runCommand(submission, shellQuoted(submission.shardFolder(index)));
}

std::string mergeCommand(const Submission& submission) {
    return fmt::format("{} merge {}", programCommand(submission), shellQuoted(submission.out));
}

std::string taskScript(const Submission& submission) {
    std::string script = scriptHead("gfxrepro-" + submission.name, submission.timeLimitMin);
    if (submission.isExclusive) script += "#SBATCH --exclusive\n";
    for (const std::string& flag : submission.sbatchFlags) {
        script += fmt::format("#SBATCH {}\n", flag);
    }
    const std::string folder =
        fmt::format("{}/\"$SLURM_ARRAY_TASK_ID\"", shellQuoted(submission.out / "shards"));
    return fmt::format("{}exec {}\n", script, runCommand(submission, folder));
}

std::string mergeScript(const Submission& submission) {
    std::string script = scriptHead("gfxrepro-" + submission.name + "-merge", kMergeLimitMin);
    // No device is needed to merge, and nothing else that was asked for the tasks but the place.
    for (const std::string& flag : submission.sbatchFlags) {
        for (const char* place : {"--partition=", "--account=", "--qos=", "--clusters="}) {
            if (flag.starts_with(place)) script += fmt::format("#SBATCH {}\n", flag);
        }
    }
    return fmt::format("{}exec {}\n", script, mergeCommand(submission));
}

std::string arrayIndices(const std::vector<int>& shards) {
    std::string text;
    for (std::size_t first = 0, next; first < shards.size(); first = next) {
        for (next = first + 1; next < shards.size() && shards[next] == shards[next - 1] + 1;) {
            ++next;
        }
        text += fmt::format("{}{}", text.empty() ? "" : ",", shards[first]);
        if (next > first + 1) text += fmt::format("-{}", shards[next - 1]);
    }
    return text;
}

int timeLimitMin(const run::Plan& plan, const std::vector<int>& shardOf,
                 const std::vector<double>& timesS, bool arePredicted) {
    std::map<int, double> predictedS, allowedS;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        const config::Measure& measure = plan.cases[i].measure;
        predictedS[shardOf[i]] += timesS[i];
        // A failure is tried twice.
        allowedS[shardOf[i]] += 2.0 * measure.processes * measure.timeLimitS;
    }
    double limitS = 0.0;
    for (const auto& [shard, allowed] : allowedS) {
        const double wanted = arePredicted ? 2.0 * predictedS[shard] + 600.0 : allowed;
        limitS = std::max(limitS, std::min(wanted, allowed + 600.0));
    }
    return std::max(1, static_cast<int>(std::ceil(limitS / 60.0)));
}

std::map<std::string, std::string> parseQueue(const std::string& squeueOutput) {
    std::map<std::string, std::string> states;
    std::istringstream lines(squeueOutput);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string task, state, more;
        const bool isTask = words >> task >> state && !(words >> more) &&
                            task.find_first_not_of("0123456789_N/A") == task.npos;
        if (!isTask) continue;  // a notice
        states[task.substr(0, task.find("_N/A"))] = state;
    }
    return states;
}

bool isUnderWay(const std::map<std::string, std::string>& queue, const std::string& task) {
    const auto found = queue.find(task);
    return found != queue.end() && !isStopped(found->second);
}

std::string stateOf(const ShardProgress& progress,
                    const std::optional<std::map<std::string, std::string>>& queue,
                    const std::string& task) {
    if (!progress.problem.empty()) return progress.problem;
    if (progress.isComplete()) return "complete";
    if (task.empty()) return "not complete";
    if (!queue) return "unknown: the queue does not answer";
    const auto found = queue->find(task);
    if (found == queue->end()) return "lost: not complete and not in the queue";
    return (isStopped(found->second) ? "stopped: " : "") + found->second;
}

namespace {

constexpr std::chrono::seconds kStartLimit{60};
constexpr const char* kSelf = "/proc/self/exe";

void copyParts(const fs::path& folder) {
    constexpr auto kAll = fs::copy_options::recursive;
    fs::create_directories(folder);
    fs::copy_file(kSelf, keptProgram(folder));  // also where another build has its name by now
    for (const char* name : {"shaders", "configs"}) {
        fs::copy(dataFolder(name), folder / name, kAll);
    }
    const fs::path libraries = fs::read_symlink(kSelf).parent_path() / "lib";  // scripts/bundle
    if (!fs::is_directory(libraries)) return;
    // Larger than all the rest, and replaced, not written to, by whoever installs anew. Of a link
    // what it leads to: the folder becomes a part of a run, which holds none.
    for (const fs::directory_entry& entry : entriesIn(libraries)) {
        shareFile(fs::canonical(entry), folder / "lib" / entry.path().filename());
    }
}

void requireBuild(const fs::path& folder, const std::string& buildId) {
    const std::string build = run::buildIdOf(keptProgram(folder), folder / "shaders");
    if (build == buildId) return;
    throw Error(
        fmt::format("{}: is not the program that was submitted (build {} then, {} now); "
                    "submit again, to another folder",
                    folder.string(), buildId.substr(0, 12), build.substr(0, 12)));
}

/// A disk may forbid it.
void requireRuns(const fs::path& folder) {
    const run::ProgramEnd end = run::runToEnd({keptProgram(folder), "--version"}, kStartLimit);
    if (end.exitCode == 0) return;
    throw Error(fmt::format("{}: cannot be run there (exit code {}): {}",
                            keptProgram(folder).string(), end.exitCode, end.output));
}

}  // namespace

fs::path keptProgram(const fs::path& folder) {
    return folder / "gfxrepro";
}

void keepProgram(const fs::path& folder, const std::string& buildId) {
    if (fs::exists(folder)) return requireBuild(folder, buildId);
    fs::path made = folder;  // all of it is there, or none
    made += ".tmp" + std::to_string(::getpid());
    try {
        copyParts(made);
        requireBuild(made, buildId);
        requireRuns(made);
        fs::rename(made, folder);
    } catch (const std::exception& error) {
        std::error_code ignored;
        fs::remove_all(made, ignored);
        fs::remove(folder.parent_path(), ignored);  // where there is nothing else
        throw Error(
            fmt::format("no copy of the program for the tasks could be made: {}", error.what()));
    }
}

}  // namespace gfxrepro::cluster
