// What sbatch and squeue are asked, and what they answer.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gfxrepro::cli {

/// What sbatch said: a job's number, or why it refused it.
struct SbatchAnswer {
    std::string job;
    std::string cluster;  // empty: the one that takes jobs by default
    std::string refusal;
};

/// Throws Error where sbatch took something and gave no number.
SbatchAnswer sbatch(std::vector<std::string> arguments);

/// The states of these jobs' tasks on the cluster ("": the default one), as cluster::parseQueue()
/// gives them. None when squeue is not there or does not answer: then nothing is known, least of
/// all an end. A queue forgets jobs that ended, and answers.
std::optional<std::map<std::string, std::string>> askQueue(const std::vector<std::string>& jobs,
                                                           const std::string& cluster);

}  // namespace gfxrepro::cli
