#include "runner/records/records.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/csv.h"

namespace gfxrepro::records {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kHeader =
    "schema,case,table,technique,method,scene,frame,repeat,process,lane,pass,metric,unit,value,"
    "status,message,rows";

constexpr std::array<std::string_view, 10> kStatusNames = {
    "ok",  "ambiguous", "flaky",       "unsupported", "timeout",
    "oom", "crash",     "device-lost", "missing",     "error"};

std::optional<Status> findStatus(std::string_view name) {
    const auto found = std::find(kStatusNames.begin(), kStatusNames.end(), name);
    if (found == kStatusNames.end()) return std::nullopt;
    return static_cast<Status>(found - kStatusNames.begin());
}

std::string statusNames() {
    return joined(std::vector<std::string>(kStatusNames.begin(), kStatusNames.end()));
}

void appendRow(std::string& out, const Record& record, int unitRows) {
    CsvRow row(out);
    row.integer(Record::kSchema).text(record.caseId).text(record.table).text(record.technique);
    row.text(record.method).text(record.scene);
    row.integer(record.frame).integer(record.repeat).integer(record.process);
    row.text(record.lane).text(record.pass).text(record.metric).text(record.unit);
    row.number(record.value).text(statusName(record.status)).text(record.message);
    row.integer(unitRows).end();
}

int integerField(const SourceLocation& where, std::string_view column, const std::string& text) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column '" + std::string(column) + "': expected an integer, found '" +
                               text + "'");
    }
    return value;
}

double numberField(const SourceLocation& where, const std::string& text) {
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) {
        throw Error(where, "column 'value': expected a number or nothing, found '" + text + "'");
    }
    return value;
}

Record recordFromFields(const SourceLocation& where, std::vector<std::string>& fields) {
    static const auto count = static_cast<std::size_t>(std::ranges::count(kHeader, ',') + 1);
    if (fields.size() != count) {
        throw Error(where, "expected " + std::to_string(count) + " columns, found " +
                               std::to_string(fields.size()));
    }
    if (const int schema = integerField(where, "schema", fields[0]); schema != Record::kSchema) {
        throw Error(where, "expected records of schema " + std::to_string(Record::kSchema) +
                               ", found " + std::to_string(schema));
    }
    Record record;
    record.caseId = std::move(fields[1]);
    record.table = std::move(fields[2]);
    record.technique = std::move(fields[3]);
    record.method = std::move(fields[4]);
    record.scene = std::move(fields[5]);
    record.frame = integerField(where, "frame", fields[6]);
    record.repeat = integerField(where, "repeat", fields[7]);
    record.process = integerField(where, "process", fields[8]);
    if (record.process < 0 || record.process >= kMostProcesses) {
        throw Error(where, "column 'process': expected 0 to " + std::to_string(kMostProcesses - 1) +
                               ", found '" + fields[8] + "'");
    }
    record.lane = std::move(fields[9]);
    record.pass = std::move(fields[10]);
    record.metric = std::move(fields[11]);
    record.unit = std::move(fields[12]);
    record.value = numberField(where, fields[13]);
    const auto status = findStatus(fields[14]);
    if (!status) {
        throw Error(where,
                    "column 'status': found '" + fields[14] + "'; allowed: " + statusNames());
    }
    record.status = *status;
    record.message = std::move(fields[15]);
    return record;
}

void checkHeader(const fs::path& path, std::string_view text) {
    const std::string_view first = text.substr(0, text.find('\n'));
    if (first != kHeader) {
        throw Error({path.string(), 1, 0}, "expected the header '" + std::string(kHeader) +
                                               "', found '" + std::string(first.substr(0, 200)) +
                                               "'");
    }
}

/// A case in one process: what is measured, and written, together.
using UnitKey = std::pair<std::string_view, int>;
UnitKey unitOf(const Record& record) {
    return {record.caseId, record.process};
}

/// What names a value within a run.
auto keyOf(const Record& record) {
    return std::tie(record.caseId, record.process, record.frame, record.repeat, record.pass,
                    record.metric);
}

struct Row {
    Record record;
    int line = 0;
    int unitRows = 0;         // as written
    std::size_t endByte = 0;  // in the file
};

/// Throws Error where a value is given again.
void checkKeys(const fs::path& path, const std::vector<Row>& rows) {
    std::vector<const Row*> order;
    for (const Row& row : rows) {
        if (row.record.status == Status::Ok) order.push_back(&row);
    }
    std::ranges::stable_sort(order, {}, [](const Row* row) { return keyOf(row->record); });
    const auto twice =
        std::ranges::adjacent_find(order, {}, [](const Row* row) { return keyOf(row->record); });
    if (twice == order.end()) return;
    const Record& record = (*twice)->record;
    throw Error({path.string(), (*(twice + 1))->line, 0},
                "'" + record.metric + "' of case " + record.caseId + ", process " +
                    std::to_string(record.process) + ", frame " + std::to_string(record.frame) +
                    ", repeat " + std::to_string(record.repeat) + " was given in line " +
                    std::to_string((*twice)->line) + " already; a value is recorded once");
}

/// Leaves out the last unit where rows of it are missing: its write was cut. Throws Error where
/// rows of another one are.
void requireWholeUnits(const fs::path& path, std::vector<Row>& rows) {
    if (rows.empty()) return;
    std::map<UnitKey, int> counts;
    for (const Row& row : rows) ++counts[unitOf(row.record)];
    const UnitKey last = unitOf(rows.back().record);
    std::size_t whole = rows.size();
    for (std::size_t i = rows.size(); i-- > 0;) {
        const Row& row = rows[i];
        const int count = counts.at(unitOf(row.record));
        if (count == row.unitRows) continue;
        if (unitOf(row.record) != last || count > row.unitRows) {
            throw Error({path.string(), row.line, 0}, "case " + row.record.caseId + ", process " +
                                                          std::to_string(row.record.process) +
                                                          " has " + std::to_string(count) + " of " +
                                                          std::to_string(row.unitRows) + " rows");
        }
        whole = i;
    }
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(whole), rows.end());
}

/// The whole units of a file, and where they end.
struct WholeUnits {
    std::vector<Record> records;
    std::size_t endBytes = 0;
};
WholeUnits readWholeUnits(const fs::path& path, std::string_view text) {
    checkHeader(path, text);
    CsvReader reader(text, path.string());
    std::vector<std::string> fields;
    std::vector<Row> rows;
    WholeUnits result;
    while (reader.next(fields)) {
        if (result.endBytes == 0) {
            result.endBytes = reader.rowEnd();  // the header's
            continue;
        }
        const SourceLocation where = reader.location();
        Record record = recordFromFields(where, fields);
        rows.push_back({std::move(record), where.line, integerField(where, "rows", fields.back()),
                        reader.rowEnd()});
    }
    checkKeys(path, rows);
    requireWholeUnits(path, rows);
    if (!rows.empty()) result.endBytes = rows.back().endByte;
    result.records.reserve(rows.size());
    for (Row& row : rows) result.records.push_back(std::move(row.record));
    return result;
}

}  // namespace

std::string_view statusName(Status status) {
    return kStatusNames[static_cast<std::size_t>(status)];
}

Status statusFromName(std::string_view name) {
    if (const auto status = findStatus(name)) return *status;
    throw Error("unknown status '" + std::string(name) + "'; allowed: " + statusNames());
}

namespace {

fs::path inItsFolder(const fs::path& path) {
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    return path;
}

}  // namespace

RecordWriter::RecordWriter(const fs::path& path) : file_(inItsFolder(path)) {
    const std::string header = std::string(kHeader) + '\n';
    const MappedFile file(path);
    const bool isNew = header != file.text() && header.starts_with(file.text());
    file_.cut(isNew ? 0 : readWholeUnits(path, file.text()).endBytes);
    if (isNew) file_.append(header);
}

void RecordWriter::append(const std::vector<Record>& rows) {
    std::map<UnitKey, int> counts;
    for (const Record& row : rows) ++counts[unitOf(row)];
    std::string block;
    for (const Record& row : rows) appendRow(block, row, counts.at(unitOf(row)));
    if (!block.empty()) file_.append(block);
}

std::vector<Record> readRecords(const fs::path& path) {
    const MappedFile file(path);
    if (std::string_view(kHeader).starts_with(file.text())) return {};  // killed while it was made
    return readWholeUnits(path, file.text()).records;
}

}  // namespace gfxrepro::records
