// One run of a program, to its end.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace gfxrepro::external {

struct ProcessStart {
    std::vector<std::string> arguments;  // the first is the program: a path, or a name in PATH
    std::vector<std::pair<std::string, std::string>> environment;  // added to ours
    std::filesystem::path folder;                                  // in which it runs
    /// Appended to through the descriptor that GFXREPRO_METRICS_FD names, and by the name in
    /// GFXREPRO_METRICS_FILE.
    std::filesystem::path metricsFile;
    std::filesystem::path machineRoot = "/";  // in tests another folder
};

struct ProcessEnd {
    int waitStatus = 0;          // of waitpid
    std::string output;          // standard output and error
    double processTimeMs = 0.0;  // CPU time, user and system, of it and of all that it waited for
    bool isOutOfMemory = false;  // it failed, or what it waited for, by a kill for want of memory
    /// Resident at once, of the largest of these; no less than what this process had on its own
    /// when it started the program, a few MiB.
    long long peakBytes = 0;
};

/// Output beyond which a program is ended.
inline constexpr std::size_t kMostOutputBytes = std::size_t{16} << 20;

/// Waits for the end. The program reads nothing, is in the process group of this process and dies
/// with it; what it started and left behind is ended. Throws Error where it cannot be started, and
/// where it prints more than kMostOutputBytes.
ProcessEnd runProcess(const ProcessStart& start);

/// "" for an end with exit code 0; "exit code 3", "SIGSEGV".
std::string whyEnded(int waitStatus);

}  // namespace gfxrepro::external
