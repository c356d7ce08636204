#include "runner/run/gpu_state.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

#include "engine/core/text.h"
#include "runner/tables/moved_clocks.h"

namespace gfxrepro::run {

namespace {

// Below this share of a moment it rests, and its clock falls.
constexpr double kBusyShare = 0.5;
// A clock that moves by more moves times by more than they are asked to be known to.
constexpr double kSteady = 1.05;

using Value = std::optional<double>;

void lower(Value& least, const Value& value) {
    if (value) least = std::min(least.value_or(*value), *value);
}

void raise(Value& most, const Value& value) {
    if (value) most = std::max(most.value_or(*value), *value);
}

Value numberOf(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? Value(found->get<double>()) : Value();
}

}  // namespace

void GpuState::add(const gl::GpuReading& reading, const std::set<int>& own, bool isTimed) {
    ++samples_;
    if (isTimed && reading.busyShare.value_or(1.0) >= kBusyShare) {
        lower(lowestHz_, reading.clockHz);
        raise(highestHz_, reading.clockHz);
        throttledBy_.insert(reading.throttled.begin(), reading.throttled.end());
    }
    raise(maxHz_, reading.maxClockHz);
    raise(highestPowerW_, reading.powerW);
    raise(powerLimitW_, reading.powerLimitW);
    raise(hottestC_, reading.temperatureC);
    raise(mostMemoryBytes_, reading.memoryUsedBytes);
    // In a container ids are those of another system: whoever cannot be seen is not counted.
    const auto isOther = [&](int id) {
        return !own.contains(id) && std::filesystem::exists("/proc/" + std::to_string(id));
    };
    others_ =
        std::max(others_, static_cast<int>(std::ranges::count_if(reading.processes, isOther)));
}

void GpuState::add(const GpuState& other) {
    samples_ += other.samples_;
    lower(lowestHz_, other.lowestHz_);
    raise(highestHz_, other.highestHz_);
    raise(maxHz_, other.maxHz_);
    raise(highestPowerW_, other.highestPowerW_);
    raise(powerLimitW_, other.powerLimitW_);
    raise(hottestC_, other.hottestC_);
    raise(mostMemoryBytes_, other.mostMemoryBytes_);
    others_ = std::max(others_, other.others_);
    throttledBy_.insert(other.throttledBy_.begin(), other.throttledBy_.end());
}

Json GpuState::json() const {
    Json json = {{"samples", samples_}};
    const auto put = [&](const char* key, const Value& value) {
        if (value) json[key] = *value;
    };
    put("lowest_clock_hz", lowestHz_);
    put("highest_clock_hz", highestHz_);
    put("max_clock_hz", maxHz_);
    put("highest_power_w", highestPowerW_);
    put("power_limit_w", powerLimitW_);
    put("hottest_c", hottestC_);
    put("most_memory_bytes", mostMemoryBytes_);
    json["other_processes"] = others_;
    json["throttled_by"] = throttledBy_;
    return json;
}

GpuState GpuState::fromJson(const Json& json) {
    GpuState state;
    state.samples_ = static_cast<int>(numberOf(json, "samples").value_or(0.0));
    state.lowestHz_ = numberOf(json, "lowest_clock_hz");
    state.highestHz_ = numberOf(json, "highest_clock_hz");
    state.maxHz_ = numberOf(json, "max_clock_hz");
    state.highestPowerW_ = numberOf(json, "highest_power_w");
    state.powerLimitW_ = numberOf(json, "power_limit_w");
    state.hottestC_ = numberOf(json, "hottest_c");
    state.mostMemoryBytes_ = numberOf(json, "most_memory_bytes");
    state.others_ = static_cast<int>(numberOf(json, "other_processes").value_or(0.0));
    if (const auto by = json.find("throttled_by"); by != json.end() && by->is_array()) {
        for (const Json& reason : *by) {
            if (reason.is_string()) state.throttledBy_.insert(reason.get<std::string>());
        }
    }
    return state;
}

std::optional<tables::ClockRange> GpuState::movedClock() const {
    if (!lowestHz_ || !highestHz_ || *highestHz_ <= kSteady * *lowestHz_) return std::nullopt;
    return tables::ClockRange{*lowestHz_, *highestHz_};
}

std::vector<std::string> GpuState::problems() const {
    std::vector<std::string> problems;
    if (const auto moved = movedClock()) {
        problems.push_back("the GPU's clock moved between " + tables::clockText(*moved));
    }
    if (!throttledBy_.empty()) {
        const std::vector<std::string> reasons(throttledBy_.begin(), throttledBy_.end());
        problems.push_back("the GPU's clock was held down by " + joined(reasons, " and "));
    }
    if (others_ > 0) {
        problems.push_back(
            fmt::format("{} other process{} used the GPU", others_, others_ == 1 ? "" : "es"));
    }
    return problems;
}

std::string GpuState::text() const {
    std::vector<std::string> parts;
    if (highestHz_) parts.push_back(fmt::format("at {:.3g} GHz", *highestHz_ * 1e-9));
    if (hottestC_) parts.push_back(fmt::format("up to {:.0f} °C", *hottestC_));
    if (highestPowerW_) parts.push_back(fmt::format("with up to {:.0f} W", *highestPowerW_));
    return parts.empty() ? "" : "the GPU ran " + joined(parts, ", ");
}

}  // namespace gfxrepro::run
