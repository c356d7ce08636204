#include "runner/run/kernel_gpu.h"

#include <algorithm>
#include <utility>

#include "engine/core/text.h"
#include "runner/run/kernel_files.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

using Value = std::optional<double>;

// Each process's descriptors are looked at: too many to do it with every reading.
constexpr double kUsersEveryS = 5.0;

Value scaled(const Value& value, double unit) {
    return value ? Value(*value * unit) : Value();
}

/// The first of these that is there.
Value firstOf(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
        if (const Value value = numberIn(file)) return value;
    }
    return std::nullopt;
}

/// Lines "1: 2105Mhz *" of pp_dpm_sclk: the star is at the one that is set.
struct ClockFile {
    double hertz = 0.0;
    bool isSet = false;
};
std::vector<ClockFile> clocksIn(const fs::path& file) {
    std::vector<ClockFile> clocks;
    for (const std::string& line : linesOf(file)) {
        const std::size_t colon = line.find(':'), unit = line.find("Mhz");
        if (colon == std::string::npos || unit == std::string::npos || unit < colon) continue;
        const auto megahertz = parseDouble(trimmed(line.substr(colon + 1, unit - colon - 1)));
        if (megahertz) clocks.push_back({*megahertz * 1e6, line.ends_with('*')});
    }
    return clocks;
}

/// The words of nvml's reasons for those of Intel's: of power, of heat here or elsewhere on the
/// board, of the voltage regulator.
const char* reasonOf(const std::string& name) {
    if (name.starts_with("pl")) return "its power limit";
    const bool isHeat = name == "thermal" || name == "prochot" || name == "ratl" ||
                        name == "vr_thermalert" || name == "soc_thermal" || name == "mem_thermal";
    return isHeat ? "heat" : "the hardware";
}

/// Files like throttle_reason_pl1, of which one that is not 0 holds.
void addReasons(const fs::path& folder, const std::string& begin, std::vector<std::string>& to) {
    for (const fs::path& file : entriesOf(folder, begin)) {
        const std::string name = file.filename().string().substr(begin.size());
        if (name == "status" || numberIn(file).value_or(0.0) == 0.0) continue;
        const std::string reason = reasonOf(name);
        if (std::ranges::find(to, reason) == to.end()) to.push_back(reason);
    }
}

}  // namespace

KernelGpu::KernelGpu(fs::path root, const std::string& node) : root_(std::move(root)), node_(node) {
    if (node.empty()) return;
    device_ = root_ / "sys/class/drm" / fs::path(node).filename() / "device";
    for (const fs::path& card : entriesOf(device_ / "drm", "card")) card_ = card;
}

Value KernelGpu::Counter::rate(const Value& count, double nowS) {
    const Value before = std::exchange(last, count);
    const double sinceS = nowS - std::exchange(lastS, nowS);
    if (!before || !count || sinceS <= 0.0 || *count < *before) return std::nullopt;
    return (*count - *before) / sinceS;
}

void KernelGpu::readAmd(gl::GpuReading& reading) const {
    for (const ClockFile& clock : clocksIn(device_ / "pp_dpm_sclk")) {
        reading.maxClockHz = std::max(reading.maxClockHz.value_or(0.0), clock.hertz);
        if (clock.isSet) reading.clockHz = clock.hertz;
    }
    reading.memoryUsedBytes = numberIn(device_ / "mem_info_vram_used");
    reading.busyShare = scaled(numberIn(device_ / "gpu_busy_percent"), 0.01);
}

void KernelGpu::readIntel(gl::GpuReading& reading, double nowS) {
    const fs::path i915 = card_ / "gt/gt0", xe = device_ / "tile0/gt0";
    const auto clock = [&](const char* ofI915, const char* old, const char* ofXe) {
        return scaled(firstOf({i915 / ofI915, card_ / old, xe / "freq0" / ofXe}), 1e6);
    };
    // Of one that sleeps it is 0.
    const Value now = clock("rps_act_freq_mhz", "gt_act_freq_mhz", "act_freq");
    if (now.value_or(0.0) > 0.0) reading.clockHz = now;
    if (const Value most = clock("rps_RP0_freq_mhz", "gt_RP0_freq_mhz", "rp0_freq")) {
        reading.maxClockHz = most;
    }
    const Value rest =
        restMs_.rate(firstOf({i915 / "rc6_residency_ms", card_ / "power/rc6_residency_ms",
                              xe / "gtidle/idle_residency_ms"}),
                     nowS);
    if (rest) reading.busyShare = std::clamp(1.0 - 1e-3 * *rest, 0.0, 1.0);
    addReasons(i915, "throttle_reason_", reading.throttled);
    addReasons(xe / "freq0/throttle", "reason_", reading.throttled);
}

void KernelGpu::readSensors(gl::GpuReading& reading, double nowS) {
    constexpr double kMilli = 1e-3, kMicro = 1e-6;
    for (const fs::path& sensors : entriesOf(device_ / "hwmon", "hwmon")) {
        if (const Value clock = numberIn(sensors / "freq1_input")) reading.clockHz = clock;
        reading.temperatureC =
            scaled(firstOf({sensors / "temp1_input", sensors / "temp2_input"}), kMilli);
        const Value powerUw = firstOf({sensors / "power1_average", sensors / "power1_input"});
        const Value energyUw =
            energyUj_.rate(firstOf({sensors / "energy1_input", sensors / "energy2_input"}), nowS);
        reading.powerW = scaled(powerUw ? powerUw : energyUw, kMicro);
        const Value limit =
            scaled(firstOf({sensors / "power1_cap", sensors / "power1_max"}), kMicro);
        if (limit.value_or(0.0) > 0.0) reading.powerLimitW = limit;  // 0: there is none
    }
}

void KernelGpu::findUsers(double nowS) {
    if (usersAtS_ && nowS < *usersAtS_ + kUsersEveryS) return;
    usersAtS_ = nowS;
    users_.clear();
    for (const fs::path& process : entriesOf(root_ / "proc", "")) {
        const auto id = parseInteger(process.filename().string());
        if (!id) continue;
        std::error_code error;  // of what is another user's, and of what has just ended
        for (fs::directory_iterator file(process / "fd", error);
             !error && file != fs::directory_iterator(); file.increment(error)) {
            std::error_code isClosed;
            if (fs::read_symlink(file->path(), isClosed) != node_) continue;
            users_.push_back(static_cast<int>(*id));
            break;
        }
    }
}

std::optional<gl::GpuReading> KernelGpu::read(double nowS) {
    std::error_code isAbsent;
    if (device_.empty() || !fs::is_directory(device_, isAbsent)) return std::nullopt;
    gl::GpuReading reading;
    readAmd(reading);
    readIntel(reading, nowS);
    readSensors(reading, nowS);
    const bool isTold = reading.clockHz || reading.maxClockHz || reading.temperatureC ||
                        reading.powerW || reading.busyShare || reading.memoryUsedBytes;
    if (!isTold) return std::nullopt;
    findUsers(nowS);
    reading.processes = users_;
    return reading;
}

}  // namespace gfxrepro::run
