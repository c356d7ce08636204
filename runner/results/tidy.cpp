#include "runner/results/tidy.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "engine/core/files.h"
#include "runner/records/csv.h"
#include "runner/results/made_from.h"
#include "runner/results/results.h"
#include "runner/run/manifest.h"

namespace gfxrepro::results {

namespace fs = std::filesystem;
using records::Frame;
using records::FrameValue;

namespace {

FrameValue tidyValue(const run::Json& value) {
    if (value.is_boolean()) return value.get<bool>();
    if (value.is_number_integer()) return value.get<long long>();
    if (value.is_number()) return value.get<double>();
    if (value.is_string()) return value.get<std::string>();
    return std::monostate{};
}

constexpr const char* kRunFile = "run.csv";

using Fields = std::map<std::string, FrameValue>;

/// A column a part: of maps by their keys, of lists by place. `columns` gets those that are new.
void addParts(const std::string& name, const run::Json& value, Fields& fields,
              std::vector<std::string>& columns) {
    if (!value.is_structured()) {
        if (!fields.contains(name)) columns.push_back(name);
        fields[name] = tidyValue(value);
        return;
    }
    for (const auto& [key, part] : value.items()) {
        addParts(name.empty() ? key : name + '.' + key, part, fields, columns);
    }
}

std::string columnOf(const std::string& param) {
    const bool isTaken = std::ranges::find(kCaseColumns, param) != std::end(kCaseColumns);
    return isTaken ? std::string(kParamPrefix) + param : param;
}

/// Parameters by column, and the columns in the order in which the case has them.
std::pair<Fields, std::vector<std::string>> paramsOf(const config::Case& item) {
    Fields fields;
    std::vector<std::string> columns;
    const run::Json params = item.recordedParams().toJson();
    for (const auto& [name, value] : params.items()) {
        addParts(columnOf(name), value, fields, columns);
    }
    return {std::move(fields), std::move(columns)};
}

std::string laneOf(const config::Case& item) {
    return item.measure.lane == config::Measure::Lane::Timing ? "timing" : "quality";
}

/// The parameters of `cases` as a row each, for more of them than a table of SQLite has columns.
Frame parameterFrame(const Frame& cases) {
    constexpr std::size_t kFirst = std::size(kCaseColumns);
    const std::size_t count = cases.columns.size() - kFirst;
    return {"case_params",
            {"case_id", "param", "value"},
            cases.rowCount * count,
            // Of one case after another each row is made once.
            [cases, count, at = cases.rowCount,
             row = std::vector<FrameValue>{}](std::size_t i) mutable {
                if (i / count != std::exchange(at, i / count)) row = cases.row(at);
                const std::size_t column = kFirst + i % count;
                return std::vector<FrameValue>{row.front(), cases.columns[column], row[column]};
            }};
}

/// `cases` with its first columns alone.
Frame withoutParameters(const Frame& cases) {
    Frame frame = cases;
    frame.columns.resize(std::size(kCaseColumns));
    frame.row = [cases, size = frame.columns.size()](std::size_t i) {
        std::vector<FrameValue> row = cases.row(i);
        row.resize(size);
        return row;
    };
    return frame;
}

Frame axisFrame(const run::Plan& plan) {
    std::vector<std::vector<FrameValue>> rows;
    std::map<std::string, std::set<std::string>> known;
    for (const config::Case& item : plan.cases) {
        std::set<std::string>& own = known[item.experiment];
        for (const auto& [axis, value] : item.axes.entries()) {
            if (!own.insert(axis).second) continue;
            rows.push_back({item.experiment, static_cast<long long>(own.size()),
                            axis == "scene" ? axis : columnOf(axis)});
        }
    }
    const std::size_t count = rows.size();
    return {
        "axes", {"experiment", "place", "axis"}, count, [rows = std::move(rows)](std::size_t i) {
            return rows[i];
        }};
}

Frame runFrame(const run::StoredRun& run) {
    const claims::ReportContext context = reportContext(run.manifest);
    std::vector<std::pair<std::string, std::string>> entries = {
        {"commit", context.commit},
        {"started", run.manifest.value("started", "")},
        {"profile", context.profile},
        {"device_class", context.deviceClass},
        {"machine", run::machineName(run.manifest)},
        {"command", context.command}};
    for (const std::string& note : run::notesOf(run.manifest)) entries.emplace_back("note", note);
    const std::size_t count = entries.size();
    return {"run", {"key", "value"}, count, [entries = std::move(entries)](std::size_t i) {
                return std::vector<FrameValue>{entries[i].first, entries[i].second};
            }};
}

/// The programs that were measured from outside, and the files that decide what they do.
Frame programFrame(const run::Json& manifest) {
    const std::set<run::ProgramUse> uses = run::programsOf(manifest);
    std::vector<std::vector<FrameValue>> rows;
    for (const run::ProgramUse& use : uses) rows.push_back({use.file, use.sha256, use.version});
    const std::size_t count = rows.size();
    return {
        "programs", {"file", "sha256", "version"}, count, [rows = std::move(rows)](std::size_t i) {
            return rows[i];
        }};
}

}  // namespace

Frame caseFrame(std::span<const config::Case> cases) {
    Frame frame{"cases", {kCaseColumns, std::end(kCaseColumns)}, cases.size(), {}};
    std::set<std::string> known;
    for (const config::Case& item : cases) {
        for (std::string& column : paramsOf(item).second) {
            if (known.insert(column).second) frame.columns.push_back(std::move(column));
        }
    }
    frame.row = [cases, columns = frame.columns](std::size_t i) {
        const config::Case& item = cases[i];
        std::vector<FrameValue> row = {item.id,        item.experiment,
                                       item.technique, item.recordedScene(),
                                       laneOf(item),   static_cast<long long>(item.seed)};
        Fields fields = paramsOf(item).first;
        for (std::size_t at = row.size(); at < columns.size(); ++at) {
            row.push_back(std::move(fields[columns[at]]));
        }
        return row;
    };
    return frame;
}

Frame recordFrame(const std::vector<records::Record>& records) {
    return {"records",
            {"case_id", "process", "frame", "repeat", "lane", "pass", "metric", "unit", "value",
             "status", "message"},
            records.size(),
            [&records](std::size_t i) {
                const records::Record& row = records[i];
                return std::vector<FrameValue>{row.caseId,
                                               static_cast<long long>(row.process),
                                               static_cast<long long>(row.frame),
                                               static_cast<long long>(row.repeat),
                                               row.lane,
                                               row.pass,
                                               row.metric,
                                               row.unit,
                                               row.value,
                                               std::string(records::statusName(row.status)),
                                               row.message};
            }};
}

void writeTidy(const fs::path& runDir, const run::StoredRun& run, const fs::path& target) {
    if (fs::exists(target)) {
        throw Error(target.string() + ": is there already; give another folder");
    }
    takeFolder(target, runDir, run.manifest);
    std::vector<Frame> frames = {caseFrame(run.plan.cases), recordFrame(run.records),
                                 axisFrame(run.plan), runFrame(run), programFrame(run.manifest)};
    records::writeFrameCsv(target / "cases.csv", frames[0]);
    records::writeFrameCsv(target / "records.csv", frames[1]);
    records::writeFrameCsv(target / kRunFile, frames[3]);
    if (frames[4].rowCount > 0) records::writeFrameCsv(target / "programs.csv", frames[4]);
    if (frames[0].columns.size() > records::kMostSqliteColumns) {
        frames.push_back(parameterFrame(frames[0]));
        frames[0] = withoutParameters(frames[0]);
    }
    const records::FrameIndex indices[] = {{"records", "case_id"}, {"records", "metric"}};
    records::writeSqlite(target / "run.sqlite", frames, indices);
}

std::map<std::string, std::string> exportedRun(const fs::path& folder) {
    std::map<std::string, std::string> entries;
    const fs::path file = folder / kRunFile;
    if (!fs::is_regular_file(file)) return entries;
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> fields;
    while (reader.next(fields)) {
        if (fields.size() == 2) entries.emplace(fields[0], fields[1]);
    }
    return entries;
}

}  // namespace gfxrepro::results
