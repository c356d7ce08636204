#include "runner/records/records.h"

#include <fmt/format.h>
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

/// Over the record of another row.
void readRecord(const SourceLocation& where, const std::vector<std::string>& fields,
                Record& record) {
    static const auto count = static_cast<std::size_t>(std::ranges::count(kHeader, ',') + 1);
    if (fields.size() != count) {
        throw Error(where, "expected " + std::to_string(count) + " columns, found " +
                               std::to_string(fields.size()));
    }
    if (const int schema = integerField(where, "schema", fields[0]); schema != Record::kSchema) {
        throw Error(where, "expected records of schema " + std::to_string(Record::kSchema) +
                               ", found " + std::to_string(schema));
    }
    record.caseId = fields[1];
    record.table = fields[2];
    record.technique = fields[3];
    record.method = fields[4];
    record.scene = fields[5];
    record.frame = integerField(where, "frame", fields[6]);
    record.repeat = integerField(where, "repeat", fields[7]);
    record.process = integerField(where, "process", fields[8]);
    if (record.process < 0 || record.process >= kMostProcesses) {
        throw Error(where, "column 'process': expected 0 to " + std::to_string(kMostProcesses - 1) +
                               ", found '" + fields[8] + "'");
    }
    record.lane = fields[9];
    record.pass = fields[10];
    record.metric = fields[11];
    record.unit = fields[12];
    record.value = numberField(where, fields[13]);
    const auto status = findStatus(fields[14]);
    if (!status) {
        throw Error(where,
                    "column 'status': found '" + fields[14] + "'; allowed: " + statusNames());
    }
    record.status = *status;
    record.message = fields[15];
}

void requireColumns(const fs::path& path, const std::string& first) {
    if (first != kHeader) {
        throw Error({path.string(), 1, 0}, "expected the header '" + std::string(kHeader) +
                                               "', found '" + first.substr(0, 200) + "'");
    }
}

/// A case in one process: what is measured, and written, together.
using UnitKey = std::pair<std::string, int>;
UnitKey unitOf(const Record& record) {
    return {record.caseId, record.process};
}

/// What names a value within a run.
auto keyOf(const Record& record) {
    return std::tie(record.caseId, record.process, record.frame, record.repeat, record.pass,
                    record.metric);
}

/// What was read of a unit.
struct UnitRows {
    std::size_t first = 0;      // its first row, from 0
    std::size_t beginByte = 0;  // where that begins in the file
    int count = 0;
    int expected = 0;  // as its rows say
    int lastLine = 0;
};

/// The whole units of a file, and where they end.
struct WholeUnits {
    bool hasHeader = false;
    std::vector<Record> records;
    std::size_t endBytes = 0;
};

/// Reads a file row by row, and sees to it that each of its units is whole and says nothing twice.
class UnitReader {
  public:
    UnitReader(const fs::path& path, std::size_t mostRows) : path_(path), file_(path, mostRows) {}

    WholeUnits read() {
        std::vector<std::string> fields;
        result_.hasHeader = file_.next(fields);
        const std::string first = joined(fields, ",");
        if (!result_.hasHeader && kHeader.starts_with(first)) return {};  // killed as it was made
        requireColumns(path_, first);
        result_.endBytes = file_.rowEnd();
        Record record;
        while (const std::optional<int> unitRows = readRow(fields, record)) {
            add(record, file_.location(), *unitRows);
            result_.endBytes = file_.rowEnd();
            reserve(lines_.size());
        }
        endBlock();
        if (isScattered_) requireSaidOnce(0);
        requireWholeUnits();
        return std::move(result_);
    }

  private:
    /// How many rows the row's unit has; none at the end.
    std::optional<int> readRow(std::vector<std::string>& fields, Record& record) {
        try {
            if (!file_.next(fields)) return std::nullopt;
            readRecord(file_.location(), fields, record);
            return integerField(file_.location(), "rows", fields.back());
        } catch (const Error& error) {
            if (error.where().line == 0 || !areWhole()) throw;
            const std::string text = error.what();
            throw Error(error.where(),
                        fmt::format("{}; what stands before it is whole, and stays by: "
                                    "sed -i '{},$d' {}",
                                    text.substr(toString(error.where()).size() + 2),
                                    error.where().line, shellQuoted(path_.string())));
        }
    }

    /// What was read so far.
    bool areWhole() const {
        return !units_.empty() && std::ranges::all_of(units_, [](const auto& unit) {
            return unit.second.count == unit.second.expected;
        });
    }

    /// Of a large file: a vector that grows is there twice for a moment.
    void reserve(std::size_t readRows) {
        constexpr std::size_t kSample = 4096;
        std::error_code unknown;
        if (readRows != kSample) return;
        const auto bytes = static_cast<double>(fs::file_size(path_, unknown));
        if (unknown) return;
        const double share = bytes / static_cast<double>(result_.endBytes);
        const auto rows = static_cast<std::size_t>(1.25 * share * static_cast<double>(readRows));
        result_.records.reserve(std::min(rows, kMostRecords));
        lines_.reserve(std::min(rows, kMostRecords));
    }

    void add(const Record& record, const SourceLocation& where, int expected) {
        const std::size_t row = result_.records.size();
        if (!unit_ || unitOf(record) != unit_->first) {
            endBlock();
            blockBegin_ = row;
            const auto [unit, isNew] =
                units_.try_emplace(unitOf(record), UnitRows{row, result_.endBytes, 0, expected, 0});
            isScattered_ |= !isNew;  // as an import's may be
            unit_ = &*unit;
        }
        UnitRows& rows = unit_->second;
        ++rows.count;
        rows.lastLine = where.line;
        rows.expected = std::max(rows.expected, expected);
        result_.records.push_back(record);
        lines_.push_back(where.line);
    }

    void endBlock() { requireSaidOnce(blockBegin_); }

    /// Throws Error where a row from `begin` on gives a value again.
    void requireSaidOnce(std::size_t begin) const {
        std::vector<std::size_t> order;
        for (std::size_t i = begin; i < result_.records.size(); ++i) {
            if (result_.records[i].status == Status::Ok) order.push_back(i);
        }
        const auto key = [&](std::size_t row) { return keyOf(result_.records[row]); };
        std::ranges::stable_sort(order, {}, key);
        const auto twice = std::ranges::adjacent_find(order, {}, key);
        if (twice == order.end()) return;
        const Record& record = result_.records[*twice];
        throw Error({path_.string(), lines_[*(twice + 1)], 0},
                    "'" + record.metric + "' of case " + record.caseId + ", process " +
                        std::to_string(record.process) + ", frame " + std::to_string(record.frame) +
                        ", repeat " + std::to_string(record.repeat) + " was given in line " +
                        std::to_string(lines_[*twice]) + " already; a value is recorded once");
    }

    /// Leaves out the last unit where rows of it are missing: its write was cut. Throws Error where
    /// rows of another one are.
    void requireWholeUnits() {
        for (const auto& unit : units_) {
            const auto& [key, rows] = unit;
            const bool isCut = &unit == unit_ && rows.count < rows.expected &&
                               rows.first + static_cast<std::size_t>(rows.count) == lines_.size();
            if (rows.count == rows.expected || isCut) continue;
            throw Error({path_.string(), rows.lastLine, 0},
                        "case " + key.first + ", process " + std::to_string(key.second) + " has " +
                            std::to_string(rows.count) + " of " + std::to_string(rows.expected) +
                            " rows");
        }
        if (!unit_ || unit_->second.count == unit_->second.expected) return;
        result_.records.resize(unit_->second.first);
        result_.endBytes = unit_->second.beginByte;
    }

    fs::path path_;
    CsvFile file_;
    WholeUnits result_;
    std::vector<int> lines_;  // of the rows
    std::map<UnitKey, UnitRows> units_;
    std::pair<const UnitKey, UnitRows>* unit_ = nullptr;  // of the row that was read last
    std::size_t blockBegin_ = 0;                          // its first row of those together
    bool isScattered_ = false;                            // a unit's rows are not all together
};

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
    if (path.has_parent_path()) makeFolder(path.parent_path());
    return path;
}

/// Of a records.csv with so many rows, its header among them, and bytes.
void requireReadable(const fs::path& path, std::size_t rows, std::uintmax_t bytes,
                     std::size_t mostRows) {
    if (rows <= mostRows && bytes <= kMostRecordBytes) return;
    throw FullError(
        fmt::format("{}: would have {} rows and {} bytes; at most {} rows and {} bytes are read. "
                    "Measure the rest in a run of its own (--only, --shard)",
                    path.string(), rows, bytes, mostRows, kMostRecordBytes));
}

/// The rows as the file has them.
std::string blockOf(const std::vector<Record>& rows) {
    std::map<UnitKey, int> counts;
    for (const Record& row : rows) ++counts[unitOf(row)];
    std::string block;
    for (const Record& row : rows) appendRow(block, row, counts.at(unitOf(row)));
    return block;
}

}  // namespace

RecordWriter::RecordWriter(const fs::path& path, std::size_t mostRows)
    : path_(path), file_(inItsFolder(path)), mostRows_(mostRows) {
    const WholeUnits found = UnitReader(path, kMostRecords).read();
    file_.cut(found.endBytes);
    if (!found.hasHeader) file_.append(std::string(kHeader) + '\n');
    rowCount_ = 1 + found.records.size();
}

void RecordWriter::requireRoom(const std::vector<Record>& rows) const {
    requireReadable(path_, rowCount_ + rows.size(), file_.sizeBytes() + blockOf(rows).size(),
                    mostRows_);
}

void RecordWriter::append(const std::vector<Record>& rows) {
    const std::string block = blockOf(rows);
    requireReadable(path_, rowCount_ + rows.size(), file_.sizeBytes() + block.size(), mostRows_);
    if (!block.empty()) file_.append(block);
    rowCount_ += rows.size();
}

void writeRecords(const fs::path& path, const std::vector<Record>& rows) {
    std::map<UnitKey, int> counts;
    for (const Record& row : rows) ++counts[unitOf(row)];
    AtomicFile file(path);
    std::string line = std::string(kHeader) + '\n';
    std::uintmax_t bytes = line.size();
    file.write(line);
    for (const Record& row : rows) {
        line.clear();
        appendRow(line, row, counts.at(unitOf(row)));
        bytes += line.size();
        file.write(line);
    }
    requireReadable(path, rows.size() + 1, bytes, kMostRecords);
    file.commit();
}

std::vector<Record> readRecords(const fs::path& path) {
    return UnitReader(path, kMostRecords).read().records;
}

}  // namespace gfxrepro::records
