#include "runner/run/machine_state.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/text.h"
#include "runner/run/process_memory.h"
#include "runner/tables/table.h"

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

namespace {

// Shares of all processors' time from which on a machine is called loaded or stolen from, and the
// fewest seconds that are more than ticks.
constexpr double kLoadedShare = 0.05;
constexpr double kStolenShare = 0.01;
constexpr double kLeastS = 0.2;

template <class Value>
void addTo(std::optional<Value>& sum, const std::optional<Value>& value) {
    if (value) sum = sum.value_or(Value{}) + *value;
}

/// What was counted between the two; counters never go back.
template <class Value>
std::optional<Value> between(const std::optional<Value>& before,
                             const std::optional<Value>& after) {
    if (!before || !after) return std::nullopt;
    return std::max(Value{}, *after - *before);
}

template <class Value>
std::optional<Value> readValue(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number()) return std::nullopt;
    return found->get<Value>();
}

/// To a hundredth of a percent: what is less is the remainder of a subtraction.
std::string percentText(double share) {
    return fmt::format("{:.3g} %", std::round(1e4 * share) / 1e2);
}

}  // namespace

void MachineState::add(const MachineReading& before, const MachineReading& after) {
    MachineState state;
    if (before.processors && after.processors) {
        state.processorCount_ = after.processors->count;
        state.processorS_ = after.processors->timeS - before.processors->timeS;
        state.busyS_ = after.processors->busyS - before.processors->busyS;
        state.stolenS_ = after.processors->stolenS - before.processors->stolenS;
        state.ownS_ = after.ownS - before.ownS;
    }
    state.throttleCount_ = between(before.throttleCount, after.throttleCount);
    state.limitedS_ = between(before.limitedS, after.limitedS);
    for (const MachineReading* reading : {&before, &after}) {
        if (reading->heat && isHotter(state.heat_, *reading->heat)) state.heat_ = reading->heat;
    }
    add(state);
}

void MachineState::add(const MachineState& other) {
    processorCount_ = std::max(processorCount_, other.processorCount_);
    processorS_ += other.processorS_;
    busyS_ += other.busyS_;
    ownS_ += other.ownS_;
    stolenS_ += other.stolenS_;
    addTo(limitedS_, other.limitedS_);
    addTo(throttleCount_, other.throttleCount_);
    if (other.heat_ && isHotter(heat_, *other.heat_)) heat_ = other.heat_;
    gpu_.add(other.gpu_);
    for (const auto& [caseId, gpu] : other.cases_) cases_[caseId].add(gpu);
}

void MachineState::add(const std::string& caseId, const MachineState& unit) {
    add(unit);
    cases_[caseId].add(unit.gpu_);
}

double MachineState::othersS() const {
    return std::max(0.0, busyS_ - ownS_);
}

Json MachineState::json() const {
    Json json = Json::object();
    const auto put = [&](const char* key, const auto& value) {
        if (value) json[key] = *value;
    };
    if (processorS_ > 0.0) {
        json = {{"processors", processorCount_},
                {"processor_s", processorS_},
                {"busy_s", busyS_},
                {"own_s", ownS_},
                {"stolen_s", stolenS_}};
    }
    put("throttle_count", throttleCount_);
    put("limited_s", limitedS_);
    if (heat_) {
        json["hottest_c"] = heat_->temperatureC;
        json["hot_from_c"] = heat_->limitC;
    }
    if (gpu_.isKnown()) json["gpu"] = gpu_.json();
    for (const auto& [caseId, gpu] : cases_) {
        const auto moved = gpu.movedClock();
        if (!moved) continue;
        json["gpu_clock_moved"][caseId] = {{"lowest_clock_hz", moved->lowHz},
                                           {"highest_clock_hz", moved->highHz}};
    }
    return json;
}

MachineState MachineState::fromJson(const Json& json) {
    MachineState state;
    state.processorCount_ = readValue<int>(json, "processors").value_or(0);
    state.processorS_ = readValue<double>(json, "processor_s").value_or(0.0);
    state.busyS_ = readValue<double>(json, "busy_s").value_or(0.0);
    state.ownS_ = readValue<double>(json, "own_s").value_or(0.0);
    state.stolenS_ = readValue<double>(json, "stolen_s").value_or(0.0);
    state.throttleCount_ = readValue<long long>(json, "throttle_count");
    state.limitedS_ = readValue<double>(json, "limited_s");
    const auto hottest = readValue<double>(json, "hottest_c");
    const auto limit = readValue<double>(json, "hot_from_c");
    if (hottest && limit) state.heat_ = Heat{*hottest, *limit};
    if (const auto gpu = json.find("gpu"); gpu != json.end() && gpu->is_object()) {
        state.gpu_ = GpuState::fromJson(*gpu);
    }
    if (const auto moved = json.find("gpu_clock_moved"); moved != json.end()) {
        for (const auto& [caseId, gpu] : moved->items()) {
            state.cases_[caseId] = GpuState::fromJson(gpu);
        }
    }
    return state;
}

std::vector<std::string> MachineState::problems() const {
    std::vector<std::string> problems;
    if (othersS() > std::max(kLeastS, kLoadedShare * processorS_)) {
        problems.push_back(fmt::format("other processes took {} of {} processor{}",
                                       percentText(othersS() / processorS_), processorCount_,
                                       processorCount_ == 1 ? "" : "s"));
    }
    if (stolenS_ > std::max(kLeastS, kStolenShare * processorS_)) {
        problems.push_back(fmt::format("the host took {} of the processors' time",
                                       percentText(stolenS_ / processorS_)));
    }
    if (throttleCount_.value_or(0) > 0) {
        problems.push_back(fmt::format("cores were throttled for heat {} time{}", *throttleCount_,
                                       *throttleCount_ == 1 ? "" : "s"));
    }
    if (limitedS_.value_or(0.0) > kLeastS) {
        problems.push_back(
            fmt::format("the CPU limit of its control group held it for {:.3g} s", *limitedS_));
    }
    if (heat_ && heat_->temperatureC >= heat_->limitC) {
        problems.push_back(fmt::format("it was hot, {:.0f} °C of {:.0f} °C at which it is slowed",
                                       heat_->temperatureC, heat_->limitC));
    }
    for (std::string& problem : gpu_.problems()) problems.push_back(std::move(problem));
    return problems;
}

std::string MachineState::sentence() const {
    if (!isKnown()) return "";
    const std::vector<std::string> wrong = problems();
    if (!wrong.empty()) {
        return fmt::format("The machine was disturbed while this was timed: {}.",
                           joined(wrong, "; "));
    }
    // Too short to tell: less than the kernel's ticks, and yet a large share.
    if (othersS() > kLoadedShare * processorS_ || stolenS_ > kStolenShare * processorS_) return "";
    std::vector<std::string> parts;
    if (processorS_ > 0.0) {
        parts.push_back(fmt::format("other processes took {} of {} processor{}, the host {}",
                                    percentText(othersS() / processorS_), processorCount_,
                                    processorCount_ == 1 ? "" : "s",
                                    percentText(stolenS_ / processorS_)));
    }
    if (const std::string gpu = gpu_.text(); !gpu.empty()) parts.push_back(gpu);
    return fmt::format("Nothing disturbed the machine while this was timed{}{}.",
                       parts.empty() ? "" : ": ", joined(parts, "; "));
}

void MachineWatch::unitBegan(const Unit& unit) {
    before_.reset();
    gpuState_ = {};
    wasTimed_ = false;
    if (unit.item->measure.lane == config::Measure::Lane::Timing) before_ = readMachine(root_);
    next_.unitBegan(unit);
}

void MachineWatch::tick(std::string_view phase) {
    if (before_) readGpu(phase == "render");
    next_.tick(phase);
}

/// Right behind timed work its clock is still that of the work.
void MachineWatch::readGpu(bool isTimed) {
    if (const auto reading = gpu_()) {
        const std::vector<int> own = processTree(::getpid());
        gpuState_.add(*reading, {own.begin(), own.end()}, isTimed || wasTimed_);
    }
    wasTimed_ = isTimed;
}

void MachineWatch::unitEnded(const Unit& unit, records::Status status, const std::string& message) {
    // Timing units run alone: the one that ends is the one that began, and a twin follows it.
    if (unit.item->measure.lane == config::Measure::Lane::Timing) {
        if (before_) {
            if (wasTimed_) readGpu(false);
            state_ = {};
            state_.add(*before_, readMachine(root_));
            state_.add(gpuState_);
            before_.reset();
        } else if (!unit.measuredAs) {
            state_ = {};
        }
        if (state_.isKnown()) {
            tables_[unit.item->experiment].add(unit.item->id, state_);
            Json event = {{"event", "machine_state"},
                          {"table", unit.item->experiment},
                          {"unit", unit.item->id},
                          {"process", unit.process}};
            event.update(state_.json());
            directory_.note(event);
        }
    }
    next_.unitEnded(unit, status, message);
}

Json MachineWatch::states() const {
    Json states = Json::object();
    for (const auto& [table, state] : tables_) states[table] = state.json();
    return states;
}

std::string MachineWatch::warning() const {
    constexpr std::size_t kMostNamed = 3;
    std::vector<std::string> parts;
    std::size_t others = 0;
    for (const auto& [table, state] : tables_) {
        const std::vector<std::string> problems = state.problems();
        if (problems.empty()) continue;
        if (parts.size() == kMostNamed) {
            ++others;
            continue;
        }
        parts.push_back(fmt::format("while {} was timed {}", table, joined(problems, "; ")));
    }
    if (parts.empty()) return "";
    if (others > 0) parts.push_back(fmt::format("and so with {} more", others));
    return "the machine was not quiet: " + joined(parts, "; ");
}

std::map<std::string, MachineState> machineStatesIn(const std::vector<Json>& journal) {
    std::map<std::string, MachineState> tables;
    for (const Json& event : journal) {
        const std::string name = event.value("event", "");
        const std::string table = event.value("table", "");
        if (name == "machine") tables.erase(table);  // measured again from there
        if (name != "machine_state") continue;
        tables[table].add(event.value("unit", ""), MachineState::fromJson(event));
    }
    return tables;
}

tables::MovedClocks movedClocks(const Json& manifest) {
    tables::MovedClocks clocks;
    const Json states = manifest.value("machine_states", Json::object());
    for (const Json& json : states) {
        const MachineState state = MachineState::fromJson(json);
        for (const auto& [caseId, gpu] : state.cases_) {
            if (const auto moved = gpu.movedClock()) clocks[caseId] = *moved;
        }
    }
    return clocks;
}

std::string machineStateNote(const Json& manifest, const std::string& table) {
    const auto states = manifest.find("machine_states");
    if (states == manifest.end() || !states->is_object()) return "";
    const auto state = states->find(table);
    if (state == states->end() || !state->is_object()) return "";
    return MachineState::fromJson(*state).sentence();
}

}  // namespace gfxrepro::run
