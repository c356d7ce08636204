#include "runner/report/case_records.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "runner/core/text.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

namespace {

using Json = nlohmann::ordered_json;

std::string jsonText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return shortestText(value.get<double>());
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

Json paramsOf(const Record& record) {
    if (record.params.empty()) return {};
    try {
        return Json::parse(record.params);
    } catch (const Json::exception& error) {
        throw Error("case " + record.caseId + " of " + record.table +
                    ": its params are not JSON: " + error.what());
    }
}

AxisValues axesOf(const Record& record, const Json& params, const std::vector<std::string>& axes) {
    AxisValues values;
    for (const std::string& axis : axes) {
        if (const auto named = valueIn(params, kStandsFor); axis == "scene" && named) {
            values.push_back(named);
        } else if (axis == "scene" && !record.scene.empty()) {
            values.emplace_back(record.scene);
        } else if (axis == "method" && !record.method.empty()) {
            values.emplace_back(record.method);
        } else {
            values.push_back(valueIn(params, axis));
        }
    }
    return values;
}

/// What of a case's identity stays when its scene is taken at another seed; and that seed's number.
struct Family {
    std::string name;
    std::optional<int> sample;
};

Family familyOf(const Record& record, Json params) {
    const Json* sample = findPath(params, kSceneSample);
    if (!sample) return {record.caseId, std::nullopt};
    const int number = sample->get<int>();
    const std::string scene = valueIn(params, kStandsFor).value_or(record.scene);
    params.erase(kSceneSample);
    params.erase(kStandsFor);
    return {scene + params.dump(), number};
}

std::optional<std::string> plannedValue(const config::CaseSpec& spec, const Json& params,
                                        const std::string& axis) {
    for (const auto& [name, value] : spec.axes) {
        if (name == axis && !value.isNull()) return canonicalText(value);
    }
    if (axis == "scene" && !spec.scene.isNull()) return canonicalText(spec.scene);
    if (axis == "output.width") return std::to_string(spec.outputWidthPx);
    if (axis == "output.height") return std::to_string(spec.outputHeightPx);
    return valueIn(params, axis);
}

bool isOfSetup(const Record* record) {
    return record->frame == kSetup;
}

}  // namespace

std::string canonicalText(const config::Node& value) {
    return value.isMap() ? value.toFlowText() : jsonText(value.toJson());
}

std::vector<const Record*> CaseRecords::Attempt::values(std::string_view metric,
                                                        std::string_view pass) const {
    std::vector<const Record*> values;
    for (auto row = rows.lower_bound({metric, pass, INT_MIN, INT_MIN});
         row != rows.end() && row->first.metric == metric && row->first.pass == pass; ++row) {
        // In the order of frames: set-up's value comes first, and goes when a frame has one.
        if (row->first.frame != kSetup) std::erase_if(values, isOfSetup);
        values.push_back(row->second);
    }
    return values;
}

std::vector<CaseRecords> groupByCase(const std::vector<Record>& records, std::string_view table,
                                     const std::vector<std::string>& axes) {
    struct Place {
        std::size_t index;  // in `cases`
        int firstProcess;
    };
    std::vector<CaseRecords> cases;
    std::vector<bool> isSeeded;
    std::unordered_map<std::string, std::size_t> families;
    std::unordered_map<std::string_view, Place> places;
    int seedCount = 1;
    for (const Record& record : records) {
        if (record.table != table) continue;
        const auto [found, isNew] = places.try_emplace(record.caseId, Place{0, 0});
        if (isNew) {
            const Json params = paramsOf(record);
            const Family family = familyOf(record, params);
            const auto [known, isFirst] = families.try_emplace(family.name, cases.size());
            if (isFirst) {
                cases.push_back(
                    {record.caseId, axesOf(record, params, axes), {}, record.scene, record.params});
                isSeeded.push_back(family.sample.has_value());
            }
            found->second = {known->second, family.sample.value_or(0) * kMostProcesses};
            seedCount = std::max(seedCount, family.sample.value_or(0) + 1);
        }
        const Place& place = found->second;
        CaseRecords::Attempt& attempt =
            cases[place.index].processes[place.firstProcess + record.process];
        if (record.status != Status::Ok && std::isnan(record.value)) {
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
                cases[i].processes[seed * kMostProcesses + process] = attempt;
            }
        }
    }
    return cases;
}

CaseRecords unmeasured(const config::PaperCase& item, const std::vector<std::string>& axes) {
    Record record;
    record.scene = item.scene;
    record.params = item.params.toJson().dump();
    return {"", axesOf(record, paramsOf(record), axes), {}, record.scene, record.params};
}

std::vector<PlannedCase> planCases(const config::Experiment& experiment,
                                   const std::vector<std::string>& axes) {
    std::vector<PlannedCase> planned;
    for (const config::CaseSpec& spec : config::expandCases(experiment)) {
        const Json params = spec.params.toJson();
        PlannedCase result;
        for (const std::string& axis : axes) {
            result.axes.push_back(plannedValue(spec, params, axis));
        }
        result.identity = params.dump() + spec.scene.toFlowText() +
                          std::to_string(spec.outputWidthPx) + 'x' +
                          std::to_string(spec.outputHeightPx);
        planned.push_back(std::move(result));
    }
    return planned;
}

}  // namespace gfxrepro::report
