// How many processors this process may use.
#pragma once

#include <filesystem>

namespace gfxrepro {

/// At least 1: those that it may run on (a cluster's job, taskset), and no more than its control
/// groups pay for (version 2: cpu.max of its own and of those above; 3.5 processors' time counts as
/// 4). `root` stands for /, in tests another folder.
int usableProcessors(const std::filesystem::path& root = "/");

}  // namespace gfxrepro
