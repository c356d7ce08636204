#include "runner/report/case_records.h"

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

AxisValues axesOf(const Record& record, const std::vector<std::string>& axes) {
    const Json params = paramsOf(record);
    AxisValues values;
    for (const std::string& axis : axes) {
        if (axis == "scene" && !record.scene.empty()) {
            values.emplace_back(record.scene);
        } else if (axis == "method" && !record.method.empty()) {
            values.emplace_back(record.method);
        } else {
            values.push_back(valueIn(params, axis));
        }
    }
    return values;
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

}  // namespace

std::string canonicalText(const config::Node& value) {
    return value.isMap() ? value.toFlowText() : jsonText(value.toJson());
}

std::vector<CaseRecords> groupByCase(const std::vector<Record>& records, std::string_view table,
                                     const std::vector<std::string>& axes) {
    std::vector<CaseRecords> cases;
    std::unordered_map<std::string_view, std::size_t> indices;
    for (const Record& record : records) {
        if (record.table != table || record.isControl()) continue;
        const auto [found, isNew] = indices.try_emplace(record.caseId, cases.size());
        if (isNew) {
            cases.push_back({record.caseId, axesOf(record, axes), {}, record.scene, record.params});
        }
        CaseRecords::Attempt& attempt = cases[found->second].processes[record.process];
        if (record.status != Status::Ok && std::isnan(record.value)) {
            attempt.rows.clear();
            attempt.failure = &record;
        } else {
            attempt.failure = nullptr;
            attempt.rows[{record.metric, record.pass, record.frame, record.repeat}] = &record;
        }
    }
    return cases;
}

CaseRecords unmeasured(const config::PaperCase& item, const std::vector<std::string>& axes) {
    Record record;
    record.scene = item.scene;
    record.params = item.params.toJson().dump();
    return {"", axesOf(record, axes), {}, record.scene, record.params};
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
