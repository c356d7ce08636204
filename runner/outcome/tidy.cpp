#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/output_files.h"
#include "runner/outcome/export.h"
#include "runner/outcome/results.h"
#include "runner/records/csv.h"
#include "runner/run/manifest.h"

namespace gfxrepro::outcome {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRunFile = "run.csv";
constexpr const char* kNumberColumns[] = {"case_id", "process", "frame", "repeat", "lane",   "pass",
                                          "metric",  "unit",    "value", "status", "message"};

/// A file that is there as a whole or not at all, written row after row: of millions of records no
/// second copy is made.
class CsvOutput {
  public:
    CsvOutput(const fs::path& file, const auto& columns) : file_(file) { addTexts(columns); }

    void addTexts(const auto& fields) {
        add([&](records::CsvRow& row) {
            for (const auto& field : fields) row.text(field);
        });
    }
    void add(const auto& write) {
        std::string line;
        records::CsvRow row(line);
        write(row);
        row.end();
        file_.write(line);
    }
    void commit() { file_.commit(); }

  private:
    AtomicFile file_;
};

std::string fieldText(const run::Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return records::shortestText(value.get<double>());
    return value.is_null() ? "" : value.dump();
}

using Fields = std::map<std::string, std::string>;

/// A column a part: of maps by their keys, of lists by place. `columns` gets those that are new.
void addParts(const std::string& name, const run::Json& value, Fields& fields,
              std::vector<std::string>& columns) {
    if (!value.is_structured()) {
        if (!fields.contains(name)) columns.push_back(name);
        fields[name] = fieldText(value);
        return;
    }
    for (const auto& [key, part] : value.items()) {
        addParts(name.empty() ? key : name + '.' + key, part, fields, columns);
    }
}

/// Parameters by column, and the columns in the order in which the case has them.
std::pair<Fields, std::vector<std::string>> paramsOf(const config::Case& item) {
    Fields fields;
    std::vector<std::string> columns;
    const run::Json params = item.recordedParams().toJson();
    for (const auto& [name, value] : params.items()) {
        const bool isTaken = std::ranges::find(kCaseColumns, name) != std::end(kCaseColumns);
        addParts(isTaken ? std::string(kParamPrefix) + name : name, value, fields, columns);
    }
    return {std::move(fields), std::move(columns)};
}

void writeNumbers(const fs::path& file, const std::vector<records::Record>& records) {
    CsvOutput out(file, kNumberColumns);
    for (const records::Record& record : records) {
        out.add([&](records::CsvRow& row) {
            row.text(record.caseId).integer(record.process).integer(record.frame);
            row.integer(record.repeat).text(record.lane).text(record.pass).text(record.metric);
            row.text(record.unit).number(record.value).text(records::statusName(record.status));
            row.text(record.message);
        });
    }
    out.commit();
}

void writeRun(const fs::path& file, const run::Json& manifest) {
    const claims::ReportContext context = reportContext(manifest);
    CsvOutput out(file, std::vector{"key", "value"});
    const auto add = [&](const std::string& key, const std::string& value) {
        out.addTexts(std::vector{key, value});
    };
    add("commit", context.commit);
    add("started", manifest.value("started", ""));
    add("profile", context.profile);
    add("device_class", context.deviceClass);
    add("machine", run::machineName(manifest));
    add("command", context.command);
    for (const std::string& note : run::notesOf(manifest)) add("note", note);
    out.commit();
}

/// The programs that were measured from outside, and the files that decide what they do.
void writePrograms(const fs::path& file, const run::Json& manifest) {
    const std::set<run::ProgramUse> uses = run::programsOf(manifest);
    if (uses.empty()) return;
    CsvOutput out(file, std::vector{"file", "sha256", "version"});
    for (const run::ProgramUse& use : uses) {
        out.addTexts(std::vector{use.file, use.sha256, use.version});
    }
    out.commit();
}

/// Whose random numbers a case has.
std::string_view seedsName(config::Measure::Seeds seeds) {
    using Seeds = config::Measure::Seeds;
    return seeds == Seeds::Process ? "process" : seeds == Seeds::Case ? "case" : "";
}

}  // namespace

void writeCases(const fs::path& file, std::span<const config::Case> cases) {
    std::vector<std::string> params;
    std::set<std::string> known;
    for (const config::Case& item : cases) {
        for (std::string& column : paramsOf(item).second) {
            if (known.insert(column).second) params.push_back(std::move(column));
        }
    }
    std::vector<std::string> columns(std::begin(kCaseColumns), std::end(kCaseColumns));
    columns.insert(columns.end(), params.begin(), params.end());
    CsvOutput out(file, columns);
    for (const config::Case& item : cases) {
        Fields fields = paramsOf(item).first;
        out.add([&](records::CsvRow& row) {
            const bool isTiming = item.measure.lane == config::Measure::Lane::Timing;
            row.text(item.id).text(item.experiment).text(item.technique);
            row.text(item.recordedScene()).text(isTiming ? "timing" : "quality");
            row.integer(static_cast<long long>(item.seed));
            row.text(seedsName(item.measure.seeds)).integer(item.measure.processes);
            for (const std::string& param : params) row.text(fields[param]);
        });
    }
    out.commit();
}

void writeTidy(const fs::path& runDir, const run::StoredRun& run, const fs::path& target) {
    writeFolder(target, [&](const fs::path& part) {
        takeFolder(part, runDir, run.manifest);
        writeCases(part / "cases.csv", run.plan.cases);
        writeNumbers(part / "records.csv", run.records);
        writeRun(part / kRunFile, run.manifest);
        writePrograms(part / "programs.csv", run.manifest);
    });
}

}  // namespace gfxrepro::outcome
