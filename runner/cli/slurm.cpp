#include "runner/cli/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "engine/core/error.h"
#include "engine/core/text.h"
#include "runner/cluster/submission.h"
#include "runner/run/child_process.h"

namespace gfxrepro::cli {

namespace {

constexpr std::chrono::seconds kSlurmLimit{120};  // for an answer

}  // namespace

/// The number is what --parsable prints last: "123" or "123;cluster".
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

}  // namespace gfxrepro::cli
