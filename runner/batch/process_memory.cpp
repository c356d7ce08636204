#include "runner/batch/process_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace gfxrepro::batch {

long long residentBytes(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
    long long totalPages = 0;
    long long residentPages = 0;
    if (!(file >> totalPages >> residentPages)) return 0;
    return residentPages * ::sysconf(_SC_PAGESIZE);
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

long long systemOomKills() {
    std::ifstream file("/proc/vmstat");
    std::string name;
    long long value = 0;
    while (file >> name >> value) {
        if (name == "oom_kill") return value;
    }
    return 0;
}

}  // namespace gfxrepro::batch
