#include "runner/tables/case_records.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

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

}  // namespace

std::string canonicalText(const Node& value) {
    return value.isMap() ? value.toFlowText() : textOf(value);
}

std::vector<const records::Record*> CaseRecords::Attempt::values(std::string_view metric,
                                                                 std::string_view pass) const {
    std::vector<const records::Record*> values;
    for (auto row = rows.lower_bound({metric, pass, INT_MIN, INT_MIN});
         row != rows.end() && row->first.metric == metric && row->first.pass == pass; ++row) {
        // In the order of frames: set-up's value comes first, and goes when a frame has one.
        if (row->first.frame != records::kSetup) std::erase_if(values, isOfSetup);
        values.push_back(row->second);
    }
    return values;
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
                             std::move(recorded.params)});
            isSeeded.push_back(sample.has_value());
        }
        places[item.id] = {index, sample.value_or(0)};
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
            attempt.rows[{record.metric, record.pass, record.frame, record.repeat}] = &record;
        }
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (isSeeded[i]) continue;
        const auto once = cases[i].processes;
        for (int seed = 1; seed < seedCount; ++seed) {
            for (const auto& [process, attempt] : once) {
                cases[i].processes[seed * records::kMostProcesses + process] = attempt;
            }
        }
    }
    return cases;
}

}  // namespace gfxrepro::tables
