// What the machine gives to processes: how many processors, and when memory was not enough.
#pragma once

#include <filesystem>

namespace gfxrepro {

/// At least 1: those that it may run on (a cluster's job, taskset), and no more than its control
/// groups of either version pay for (its own and those above; 3.5 processors' time counts as 4).
/// `root` stands for /, in tests another folder.
int usableProcessors(const std::filesystem::path& root = "/");

/// Processes that the kernel has killed for want of memory, of the machine's or of a control
/// group's, since its start; 0 if it does not tell. `root` as above.
long long systemOomKills(const std::filesystem::path& root = "/");
/// Likewise of this process's own control group alone; of version 2 with those below it.
long long groupOomKills(const std::filesystem::path& root = "/");

}  // namespace gfxrepro
