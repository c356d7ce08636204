// A plan handed to other machines: what each of them is told, as text, and
// the copy of the program that it measures with.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/run/plan.h"

namespace gfxrepro::cluster {

/// Everything that the commands and scripts of a submission say.
///
/// Files: OUT/submitted-plan.json and OUT/submitted-program (what is measured, and by which build),
/// OUT/predictions.csv (by which the shards were cut), OUT/submission.json, OUT/shards/<k> (a run
/// each, whose plan is there before its task), OUT/task.sh and merge.sh (Slurm), OUT/commands.txt;
/// OUT itself becomes the merged run.
struct Submission {
    std::string name;                       // of the job: "zju2005"
    std::filesystem::path program;          // absolute; shaders/ and configs/ lie beside it
    std::vector<std::string> runArguments;  // of every shard: where models lie, how many jobs
    std::filesystem::path out;              // absolute
    int shardCount = 1;
    int timeLimitMin = 60;                 // of the longest shard
    bool isExclusive = false;              // a shard has timing cases, which stand no neighbours
    std::vector<std::string> sbatchFlags;  // after ours, so that theirs win

    std::filesystem::path shardFolder(int index) const;
};

/// The folders of the shards below a submission's, by their numbers.
std::vector<std::filesystem::path> shardFolders(const std::filesystem::path& out);

/// The command of shard `index` (from 1): begins it, or goes on where it is begun.
std::string shardCommand(const Submission& submission, int index);
std::string mergeCommand(const Submission& submission);

/// The array job's script, and the script of the job that merges after it. sbatch's own options
/// stand in both as #SBATCH lines.
std::string taskScript(const Submission& submission);
std::string mergeScript(const Submission& submission);

/// "1-4", "2,4": of the array that runs these shards.
std::string arrayIndices(const std::vector<int>& shards);

/// The limit of the longest shard: twice what is predicted and ten minutes; where nothing is, and
/// at most, what its cases may take by their own limits.
int timeLimitMin(const run::Plan& plan, const std::vector<int>& shardOf,
                 const std::vector<double>& timesS, bool arePredicted);

/// What squeue says of a job's array tasks ("F_K" → state, "F" for a job without an array), from
/// the output of `squeue -h -r -o "%F_%K %T"`.
std::map<std::string, std::string> parseQueue(const std::string& squeueOutput);

/// How far a shard is, from its files.
struct ShardProgress {
    int unitCount = 0;
    int finished = 0;  // `ok` or `flaky`
    int failed = 0;
    std::string problem = {};  // for which a merge refuses it
    bool isComplete() const { return problem.empty() && unitCount == finished + failed; }
};

/// Whether the queue has a task that is not at its end.
bool isUnderWay(const std::map<std::string, std::string>& queue, const std::string& task);

/// What is known of a shard: from its files first, from the queue (none: it did not answer) second.
std::string stateOf(const ShardProgress& progress,
                    const std::optional<std::map<std::string, std::string>>& queue,
                    const std::string& task);

/// A folder with the running program, the shaders and configs that it finds, and the libraries of a
/// bundle: what is built later changes nothing of it. Is made where it is not there. Throws Error
/// where it cannot be made or run there, and where it is not the build `buildId`.
void keepProgram(const std::filesystem::path& folder, const std::string& buildId);

/// The program in such a folder.
std::filesystem::path keptProgram(const std::filesystem::path& folder);

}  // namespace gfxrepro::cluster
