#include "runner/run/process_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace gfxrepro::run {

long long residentBytes(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
    long long totalPages = 0;
    long long residentPages = 0;
    if (!(file >> totalPages >> residentPages)) return 0;
    return residentPages * ::sysconf(_SC_PAGESIZE);
}

namespace {

/// Adds the processes that a thread of `pid` started; proc(5).
void addChildren(pid_t pid, std::vector<pid_t>& all) {
    std::error_code isGone;
    const std::filesystem::path tasks = "/proc/" + std::to_string(pid) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks, isGone)) {
        std::ifstream file(task.path() / "children");
        for (pid_t child; file >> child;) all.push_back(child);
    }
}

}  // namespace

std::vector<pid_t> processTree(pid_t pid) {
    std::vector<pid_t> all = {pid};
    for (std::size_t i = 0; i < all.size(); ++i) addChildren(all[i], all);
    return all;
}

long long peakResidentBytes() {
    std::ifstream file("/proc/self/status");
    std::string word;
    while (file >> word) {
        long long kibibytes = 0;
        if (word == "VmHWM:" && file >> kibibytes) return kibibytes * 1024;
    }
    return 0;
}

void resetPeakResident() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets VmHWM
}

}  // namespace gfxrepro::run
