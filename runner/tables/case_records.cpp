#include "runner/tables/case_records.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <unordered_map>

#include "runner/records/csv.h"

namespace gfxrepro::tables {

namespace {

using Json = nlohmann::ordered_json;

std::string jsonText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return records::shortestText(value.get<double>());
    return value.dump();
}

/// "output.width": an entry of that name, or of the map within the map.
const Json* findPath(const Json& map, std::string_view path) {
    if (!map.is_object()) return nullptr;
    const std::string name(path);
    if (const auto found = map.find(name); found != map.end()) return &*found;
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos) return nullptr;
    const auto inner = map.find(name.substr(0, dot));
    return inner == map.end() ? nullptr : findPath(*inner, path.substr(dot + 1));
}

std::optional<std::string> valueIn(const Json& params, const std::string& axis) {
    const Json* value = findPath(params, axis);
    if (!value || value->is_null()) return std::nullopt;
    return jsonText(*value);
}

AxisValues axesOf(const PlannedCase& item, const std::vector<std::string>& axes) {
    AxisValues values;
    for (const std::string& axis : axes) {
        if (const auto named = valueIn(item.params, kStandsFor); axis == "scene" && named) {
            values.push_back(named);
        } else if (axis == "scene" && !item.scene.empty()) {
            values.emplace_back(item.scene);
        } else {
            values.push_back(valueIn(item.params, axis));
        }
    }
    return values;
}

std::optional<int> sampleOf(const PlannedCase& item) {
    const Json* sample = findPath(item.params, kSceneSample);
    return sample ? std::optional(sample->get<int>()) : std::nullopt;
}

/// What of a case's identity stays when its scene is taken at another seed.
std::string familyOf(const PlannedCase& item) {
    Json params = item.params;
    params.erase(kSceneSample);
    params.erase(kStandsFor);
    return valueIn(item.params, kStandsFor).value_or(item.scene) + params.dump();
}

bool isOfSetup(const records::Record* record) {
    return record->frame == records::kSetup;
}

}  // namespace

std::string canonicalText(const config::Node& value) {
    return value.isMap() ? value.toFlowText() : jsonText(value.toJson());
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

std::vector<CaseRecords> groupByCase(std::span<const PlannedCase> planned,
                                     const std::vector<records::Record>& records,
                                     std::string_view table, const std::vector<std::string>& axes) {
    struct Place {
        std::size_t index;  // in `cases`
        int sample;
    };
    std::vector<CaseRecords> cases;
    std::vector<bool> isSeeded;
    std::unordered_map<std::string_view, Place> places;  // by the case's id
    std::unordered_map<std::string, std::size_t> families;
    for (const PlannedCase& item : planned) {
        if (item.table != table) continue;
        const std::optional<int> sample = sampleOf(item);
        const std::size_t next = cases.size();
        const std::size_t index =
            sample ? families.try_emplace(familyOf(item), next).first->second : next;
        if (index == next) {
            cases.push_back({item.id, axesOf(item, axes), {}, item.scene, item.params});
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
