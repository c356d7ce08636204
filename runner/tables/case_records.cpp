#include "runner/tables/case_records.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>
#include <utility>

#include "engine/metrics/alike.h"
#include "runner/config/experiment.h"
#include "runner/records/csv.h"

namespace gfxrepro::tables {

namespace {

std::string textOf(const Node& node) {
    const nlohmann::ordered_json value = node.toJson();
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return records::shortestText(value.get<double>());
    return value.dump();
}

/// "output.width": an entry of that name, or of the map within the map.
const Node* findPath(const Node& map, std::string_view path) {
    if (!map.isMap()) return nullptr;
    if (const Node* found = map.find(path)) return found;
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos) return nullptr;
    const Node* inner = map.find(path.substr(0, dot));
    return inner ? findPath(*inner, path.substr(dot + 1)) : nullptr;
}

std::optional<std::string> valueIn(const Node& params, const std::string& axis) {
    const Node* value = findPath(params, axis);
    if (!value || value->isNull()) return std::nullopt;
    return textOf(*value);
}

/// A case as its records say it.
struct Recorded {
    std::string scene;
    Node params;

    std::optional<std::string> value(const std::string& axis) const {
        if (axis == "scene") {
            if (const auto named = valueIn(params, config::kStandsFor)) return named;
            if (!scene.empty()) return scene;
        }
        return valueIn(params, axis);
    }
};

/// The axes that the sweep's `when` leaves out of the case: its parameters have them with their
/// defaults.
std::set<std::string> leftOut(const Recorded& item, const Node& when) {
    std::set<std::string> names, conditional;
    for (const auto& [axis, conditions] : when.entries()) {
        conditional.insert(axis);
        names.insert(axis);
        for (const auto& [name, value] : conditions.entries()) names.insert(name);
    }
    config::AxisPoint point;
    for (const std::string& name : names) {
        if (const auto value = item.value(name)) point.emplace_back(name, Node::scalar(*value));
    }
    config::applyWhen(when, point);
    for (const auto& [name, value] : point) conditional.erase(name);
    return conditional;
}

AxisValues axesOf(const Recorded& item, const std::vector<std::string>& axes, const Node* when) {
    const std::set<std::string> absent = when ? leftOut(item, *when) : std::set<std::string>();
    AxisValues values;
    for (const std::string& axis : axes) {
        values.push_back(absent.contains(axis) ? std::string(kLeftOut) : item.value(axis));
    }
    return values;
}

/// What of a case's identity stays when its scene is taken at another seed.
std::string familyOf(const Recorded& item) {
    Node params = item.params;
    params.erase(config::kSceneSample);
    params.erase(config::kStandsFor);
    return valueIn(item.params, config::kStandsFor).value_or(item.scene) + params.toJson().dump();
}

bool isOfSetup(const records::Record* record) {
    return record->frame == records::kSetup;
}

/// Sorts by place; of several rows of one place the last stays.
void keepLast(std::vector<const records::Record*>& rows) {
    std::ranges::stable_sort(rows, {}, CaseRecords::placeOf);
    const auto kept = std::unique(rows.rbegin(), rows.rend(), [](const auto* a, const auto* b) {
        return CaseRecords::placeOf(a) == CaseRecords::placeOf(b);
    });
    rows.erase(rows.begin(), kept.base());
    rows.shrink_to_fit();
}

}  // namespace

std::string canonicalText(const Node& value) {
    return value.isMap() ? value.toFlowText() : textOf(value);
}

std::vector<const records::Record*> CaseRecords::Attempt::values(std::string_view metric,
                                                                 std::string_view pass) const {
    std::vector<const records::Record*> values;
    const RecordPlace first{metric, pass, INT_MIN, INT_MIN};
    for (auto row = std::ranges::lower_bound(rows, first, {}, placeOf);
         row != rows.end() && (*row)->metric == metric && (*row)->pass == pass; ++row) {
        // In the order of frames: set-up's value comes first, and goes when a frame has one.
        if ((*row)->frame != records::kSetup) std::erase_if(values, isOfSetup);
        values.push_back(*row);
    }
    return values;
}

std::string CaseRecords::passOf(std::string_view metric) const {
    for (const auto& [number, attempt] : processes) {
        const RecordPlace first{metric, "", INT_MIN, INT_MIN};
        const auto row = std::ranges::lower_bound(attempt.rows, first, {}, placeOf);
        if (row != attempt.rows.end() && (*row)->metric == metric) return (*row)->pass;
    }
    return "";
}

bool CaseRecords::scatters(std::string_view metric, std::string_view pass) const {
    std::map<std::pair<int, int>, double> first;  // by the scene's seed and the frame
    for (const auto& [number, attempt] : processes) {
        if (attempt.failure) continue;
        for (const records::Record* row : attempt.values(metric, pass)) {
            const auto [found, isNew] =
                first.try_emplace({number / records::kMostProcesses, row->frame}, row->value);
            if (!metrics::areAlike(found->second, row->value)) return true;
        }
    }
    return false;
}

bool CaseRecords::isTakenAgain(std::string_view metric, std::string_view pass) const {
    std::map<std::pair<int, int>, std::size_t> counts;  // by the scene's seed and the frame
    for (const auto& [number, attempt] : processes) {
        for (const records::Record* row : attempt.values(metric, pass)) {
            ++counts[{number / records::kMostProcesses, row->frame}];
        }
    }
    const bool isOfEach =
        std::ranges::all_of(counts, [](const auto& entry) { return entry.second > 1; });
    return isOfEach || (!isOfElsewhere && processes.size() > 1);
}

bool CaseRecords::isWithout(std::string_view metric, std::string_view pass) const {
    return !processes.empty() && std::ranges::all_of(processes, [&](const auto& process) {
        return !process.second.failure && process.second.values(metric, pass).empty();
    });
}

bool CaseRecords::isWithoutFrame(std::string_view metric, std::string_view pass) const {
    return std::ranges::all_of(processes, [&](const auto& process) {
        return std::ranges::all_of(process.second.values(metric, pass), isOfSetup);
    });
}

bool CaseRecords::isOfItsSeed(std::string_view metric) const {
    const bool isOurs = config::isOfDevice(metric) || config::isTestOfMeans(metric);
    return !config::isTimeMetric(metric) && (isOfElsewhere || !isOurs);
}

std::vector<CaseRecords> groupByCase(std::span<const config::Case> planned,
                                     const std::vector<records::Record>& records,
                                     std::string_view table, const std::vector<std::string>& axes,
                                     const Node* when) {
    struct Place {
        std::size_t index;  // in `cases`
        int sample;
    };
    std::vector<CaseRecords> cases;
    std::vector<bool> isSeeded;
    std::unordered_map<std::string_view, Place> places;  // by the case's id
    std::unordered_map<std::string, std::size_t> families;
    for (const config::Case& item : planned) {
        if (item.experiment != table) continue;
        const std::optional<int> sample = item.sceneSample;
        Recorded recorded{item.recordedScene(), item.recordedParams()};
        const std::size_t next = cases.size();
        const std::size_t index =
            sample ? families.try_emplace(familyOf(recorded), next).first->second : next;
        if (index == next) {
            AxisValues values = axesOf(recorded, axes, when);
            cases.push_back({item.id,
                             std::move(values),
                             {},
                             std::move(recorded.scene),
                             std::move(recorded.params),
                             item.measure.seeds,
                             item.seed});
            cases.back().processesAsked = item.measure.processes;
            isSeeded.push_back(sample.has_value());
        }
        places[item.id] = {index, sample.value_or(0)};
        cases[index].sceneSeeds = std::max(cases[index].sceneSeeds, sample.value_or(0) + 1);
    }
    int seedCount = 1;
    for (const records::Record& record : records) {
        const auto found = places.find(record.caseId);
        if (found == places.end()) continue;  // of another table
        const auto [index, sample] = found->second;
        seedCount = std::max(seedCount, sample + 1);
        CaseRecords::Attempt& attempt =
            cases[index].processes[sample * records::kMostProcesses + record.process];
        if (record.status != records::Status::Ok && std::isnan(record.value)) {
            attempt.rows.clear();
            attempt.failure = &record;
        } else {
            attempt.failure = nullptr;
            attempt.rows.push_back(&record);
        }
    }
    for (CaseRecords& one : cases) {
        for (auto& [process, attempt] : one.processes) keepLast(attempt.rows);
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (isSeeded[i]) continue;
        const auto once = cases[i].processes;
        cases[i].isRepeated = seedCount > 1 && once.size() > 1;
        for (int seed = 1; seed < seedCount; ++seed) {
            for (const auto& [process, attempt] : once) {
                cases[i].processes[seed * records::kMostProcesses + process] = attempt;
            }
        }
    }
    return cases;
}

}  // namespace gfxrepro::tables
