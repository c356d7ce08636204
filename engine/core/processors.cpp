#include "engine/core/processors.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace gfxrepro {

namespace fs = std::filesystem;

namespace {

int allowedProcessors() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof(allowed), &allowed) == 0) return CPU_COUNT(&allowed);
    return static_cast<int>(std::thread::hardware_concurrency());  // of more than a cpu_set_t holds
}

/// Processors that one group's cpu.max pays for: "400000 100000" is 4, "max 100000" any number.
double quotaOf(const fs::path& group) {
    std::ifstream file(group / "cpu.max");
    double quotaUs = 0.0, periodUs = 0.0;
    if (!(file >> quotaUs >> periodUs) || quotaUs <= 0.0 || periodUs <= 0.0) {
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
    const fs::path groups = root / "sys/fs/cgroup";
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("0::/")) continue;
        fs::path group = fs::path(line.substr(4)).lexically_normal();
        for (; !group.empty(); group = group.parent_path()) {
            processors = std::min(processors, std::ceil(quotaOf(groups / group)));
        }
    }
    return std::max(1, static_cast<int>(std::min(processors, std::ceil(quotaOf(groups)))));
}

long long systemOomKills(const fs::path& root) {
    return oomKillsIn(root / "proc/vmstat");
}

long long groupOomKills(const fs::path& root) {
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("0::/")) continue;
        return oomKillsIn(root / "sys/fs/cgroup" / line.substr(4) / "memory.events");
    }
    return 0;
}

}  // namespace gfxrepro
