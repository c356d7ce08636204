#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "runner/run/machine_state.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

// Where the kernel names no temperature at which it slows a part.
constexpr double kBelowCriticalC = 5.0;
constexpr double kHotC = 95.0;
constexpr double kLeastTripC = 40.0;  // zones name trip points of 0 °C that mean none

/// Empty for a file that cannot be read.
std::vector<std::string> linesOf(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
}

/// The number that is the file's first line.
std::optional<double> numberIn(const fs::path& path) {
    const std::vector<std::string> lines = linesOf(path);
    return lines.empty() ? std::nullopt : parseDouble(trimmed(lines.front()));
}

/// Entries of a folder whose names begin so, in the order of their names; none where there is no
/// such folder.
std::vector<fs::path> entriesOf(const fs::path& folder, std::string_view begin) {
    std::error_code isAbsent;
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, isAbsent)) {
        if (entry.path().filename().string().starts_with(begin)) entries.push_back(entry.path());
    }
    std::ranges::sort(entries);
    return entries;
}

std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

double secondsOfTicks(double ticks) {
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

std::optional<MachineReading::Processors> processorsOf(const fs::path& root) {
    // cpu user nice system idle iowait irq softirq steal guest guest_nice; user counts the guests.
    constexpr std::size_t kIdle = 3, kWaiting = 4, kStolen = 7, kCount = 8;
    MachineReading::Processors processors;
    for (const std::string& line : linesOf(root / "proc/stat")) {
        if (!line.starts_with("cpu")) break;
        const std::vector<std::string> words = wordsOf(line);
        if (words.front() != "cpu") {
            ++processors.count;
            continue;
        }
        std::array<double, kCount> times{};
        for (std::size_t i = 0; i < kCount && i + 1 < words.size(); ++i) {
            times[i] = secondsOfTicks(parseDouble(words[i + 1]).value_or(0.0));
        }
        processors.timeS = std::accumulate(times.begin(), times.end(), 0.0);
        processors.stolenS = times[kStolen];
        processors.busyS = processors.timeS - times[kIdle] - times[kWaiting] - times[kStolen];
    }
    const bool isKnown = processors.count > 0 && processors.timeS > 0.0;
    return isKnown ? std::optional(processors) : std::nullopt;
}

/// Of the process and of the children that it has waited for.
double processorTimeOf(const fs::path& folder) {
    const std::vector<std::string> lines = linesOf(folder / "stat");
    if (lines.empty()) return 0.0;
    // Behind the name in parentheses: state, …; the 12th to 15th are utime stime cutime cstime.
    const std::size_t name = lines.front().rfind(')');
    if (name == std::string::npos) return 0.0;
    const std::vector<std::string> words = wordsOf(lines.front().substr(name + 1));
    double ticks = 0.0;
    for (std::size_t i = 11; i < 15 && i < words.size(); ++i) {
        ticks += parseDouble(words[i]).value_or(0.0);
    }
    return secondsOfTicks(ticks);
}

/// Of this process and its workers: those that live, those that have ended, and what these ran.
double ownTimeOf(const fs::path& root) {
    double timeS = processorTimeOf(root / "proc/self");
    for (const fs::path& thread : entriesOf(root / "proc/self/task", "")) {
        for (const std::string& line : linesOf(thread / "children")) {
            for (const std::string& id : wordsOf(line)) {
                timeS += processorTimeOf(root / "proc" / id);
            }
        }
    }
    return timeS;
}

std::optional<long long> throttleCountOf(const fs::path& root) {
    std::optional<long long> count;
    double package = 0.0;  // every core of a package tells the package's
    for (const fs::path& folder : entriesOf(root / "sys/devices/system/cpu", "cpu")) {
        const fs::path counts = folder / "thermal_throttle";
        const auto core = numberIn(counts / "core_throttle_count");
        package = std::max(package, numberIn(counts / "package_throttle_count").value_or(0.0));
        if (core) count = count.value_or(0) + static_cast<long long>(*core);
    }
    if (count) *count += static_cast<long long>(package);
    return count;
}

/// Seconds for which the limit of the control group held its tasks.
std::optional<double> limitedOf(const fs::path& root) {
    std::string group;
    for (const std::string& line : linesOf(root / "proc/self/cgroup")) {
        if (line.starts_with("0::/")) group = line.substr(4);
    }
    for (const std::string& line : linesOf(root / "sys/fs/cgroup" / group / "cpu.stat")) {
        if (!line.starts_with("throttled_usec ")) continue;
        const auto microseconds = parseDouble(trimmed(line.substr(15)));
        if (microseconds) return *microseconds * 1e-6;
    }
    return std::nullopt;
}

double limitOfZone(const fs::path& zone) {
    constexpr double kMilli = 1e-3;
    double limit = kHotC;
    std::optional<double> trip;
    for (const fs::path& type : entriesOf(zone, "trip_point_")) {
        const std::string name = type.filename().string();
        if (!name.ends_with("_type")) continue;
        const fs::path place = zone / (name.substr(0, name.size() - 4) + "temp");
        const double temperature = numberIn(place).value_or(0.0) * kMilli;
        if (temperature < kLeastTripC) continue;
        const std::vector<std::string> lines = linesOf(type);
        const std::string kind = lines.empty() ? "" : lines.front();
        if (kind == "critical") limit = std::min(limit, temperature - kBelowCriticalC);
        if (kind == "passive" || kind == "hot") {
            trip = std::min(trip.value_or(temperature), temperature);
        }
    }
    return trip.value_or(limit);
}

std::optional<Heat> heatOf(const fs::path& root) {
    std::optional<Heat> hottest;
    for (const fs::path& zone : entriesOf(root / "sys/class/thermal", "thermal_zone")) {
        const auto milli = numberIn(zone / "temp");
        if (!milli) continue;
        const Heat heat{*milli * 1e-3, limitOfZone(zone)};
        if (isHotter(hottest, heat)) hottest = heat;
    }
    return hottest;
}

}  // namespace

bool isHotter(const std::optional<Heat>& one, const Heat& other) {
    return !one || other.temperatureC - other.limitC > one->temperatureC - one->limitC;
}

MachineReading readMachine(const fs::path& root) {
    MachineReading reading;
    reading.ownS = ownTimeOf(root);
    reading.processors = processorsOf(root);
    reading.throttleCount = throttleCountOf(root);
    reading.limitedS = limitedOf(root);
    reading.heat = heatOf(root);
    return reading;
}

}  // namespace gfxrepro::run
