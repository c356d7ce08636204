#include "engine/core/processors.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/text.h"

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

int allowedProcessors() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof(allowed), &allowed) == 0) return CPU_COUNT(&allowed);
    return static_cast<int>(std::thread::hardware_concurrency());  // of more than a cpu_set_t holds
}

/// The folders of this process's group and of those above it, its own first, the root last. Of a
/// controller that has groups of its own (version 1), else of those that all have (version 2).
std::vector<fs::path> groupsOf(const fs::path& root, const std::string& controller) {
    fs::path hierarchy = root / "sys/fs/cgroup", group;
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {  // "4:cpu,cpuacct:/jobs/12", "0::/jobs/12"
        const std::size_t names = line.find(':') + 1, path = line.find(":/", names);
        if (names == 0 || path == line.npos) continue;
        const bool isOfAll = path == names;
        const std::vector<std::string> own = split(line.substr(names, path - names), ',');
        if (!isOfAll && std::ranges::find(own, controller) == own.end()) continue;
        group = fs::path(line.substr(path + 2)).lexically_normal();
        if (isOfAll) continue;
        hierarchy /= controller;
        break;
    }
    std::vector<fs::path> groups;
    for (; !group.empty(); group = group.parent_path()) groups.push_back(hierarchy / group);
    groups.push_back(hierarchy);
    return groups;
}

/// Processors that one group pays for: "400000 100000" of cpu.max is 4, "max 100000" any number.
double quotaOf(const fs::path& group) {
    std::ifstream file(group / "cpu.max"), quotaFile(group / "cpu.cfs_quota_us"),
        periodFile(group / "cpu.cfs_period_us");
    double quotaUs = 0.0, periodUs = 0.0;
    const bool isThere =
        file >> quotaUs >> periodUs || (quotaFile >> quotaUs && periodFile >> periodUs);
    if (!isThere || quotaUs <= 0.0 || periodUs <= 0.0) {
        return std::numeric_limits<double>::infinity();
    }
    return quotaUs / periodUs;
}

/// The count in a file of names and numbers.
long long oomKillsIn(const fs::path& counts) {
    std::ifstream file(counts);
    std::string name;
    long long value = 0;
    while (file >> name >> value) {
        if (name == "oom_kill") return value;
    }
    return 0;
}

}  // namespace

int usableProcessors(const fs::path& root) {
    double processors = std::max(1, allowedProcessors());
    for (const fs::path& group : groupsOf(root, "cpu")) {
        processors = std::min(processors, std::ceil(quotaOf(group)));
    }
    return std::max(1, static_cast<int>(processors));
}

long long systemOomKills(const fs::path& root) {
    return oomKillsIn(root / "proc/vmstat");
}

long long groupOomKills(const fs::path& root) {
    for (const fs::path& group : groupsOf(root, "memory")) {
        if (!fs::is_directory(group)) continue;  // a container has its own as the root
        return std::max(oomKillsIn(group / "memory.events"),
                        oomKillsIn(group / "memory.oom_control"));
    }
    return 0;
}

}  // namespace gfxrepro
