#include "runner/outcome/import_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "engine/core/files.h"
#include "engine/core/foreign_text.h"
#include "engine/core/text.h"
#include "runner/config/outputs.h"
#include "runner/records/csv.h"

namespace gfxrepro::outcome {

namespace fs = std::filesystem;
using records::Record;

namespace {

using Names = std::vector<std::string>;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMostCellBytes = 1024;
constexpr const char* kMessage = "message";
constexpr const char* kSeed = "seed";
constexpr std::string_view kLongColumns[] = {"metric", "value", "unit"};
constexpr std::string_view kRecordColumns[] = {"pass", "frame",  "repeat", "process",
                                               "lane", "status", kMessage, kSeed};

bool isOneOf(std::string_view name, std::span<const std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
}

/// As other programs write it: with a mark of the encoding, ends of lines with a return, and a last
/// line without an end.
std::string textOf(const fs::path& file) {
    if (fs::is_regular_file(file) && fs::file_size(file) > kMostBytes) {
        throw Error({file.string(), 0, 0},
                    fmt::format("{} bytes; at most {} are read", fs::file_size(file), kMostBytes));
    }
    std::string text = readFile(file);
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    std::string plain;
    plain.reserve(text.size() + 1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isReturn = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
        if (!isReturn) plain += text[i];
    }
    if (!plain.empty() && plain.back() != '\n') plain += '\n';
    return plain;
}

/// Rows by the names of their columns.
class NamedCsv {
  public:
    explicit NamedCsv(const fs::path& file)
        : name_(file.string()), text_(textOf(file)), reader_(text_, name_) {
        if (!reader_.next(header_)) throw Error({name_, 1, 0}, "is empty; expected a header");
        for (std::size_t i = 0; i < header_.size(); ++i) {
            std::string& column = header_[i];
            column = trimmed(column);
            requireText(column, fmt::format("the name of column {}", i + 1), false);
            if (column.empty()) throw Error(where(), fmt::format("column {} has no name", i + 1));
            if (!places_.try_emplace(column, i).second) {
                throw Error(where(), fmt::format("two columns '{}'", column));
            }
        }
    }

    const Names& header() const { return header_; }
    bool has(const std::string& column) const { return places_.contains(column); }
    SourceLocation where() const { return reader_.location(); }

    /// Throws Error where the header does not have the column.
    void require(const std::string& column, const std::string& needed) const {
        if (has(column)) return;
        throw Error({name_, 1, 0}, fmt::format("no column '{}' (columns: {}); needed: {}", column,
                                               joined(header_), needed));
    }

    /// The next row that is not blank.
    bool next() {
        while (reader_.next(fields_)) {
            if (fields_.size() == 1 && header_.size() > 1 && fields_[0].empty()) continue;
            if (fields_.size() != header_.size()) {
                throw Error(where(), fmt::format("{} columns; the header has {}", fields_.size(),
                                                 header_.size()));
            }
            for (std::size_t i = 0; i < fields_.size(); ++i) {
                requireText(fields_[i], fmt::format("column '{}'", header_[i]),
                            header_[i] == kMessage);
            }
            return true;
        }
        if (fields_.size() == 1 && fields_[0].empty()) return false;
        throw Error(where(), "a quote that is not closed");
    }

    /// The cell without spaces around it; empty where there is no such column.
    std::string cell(const std::string& column) const {
        const auto place = places_.find(column);
        return place == places_.end() ? "" : std::string(trimmed(fields_[place->second]));
    }

  private:
    /// What a program said may have anything in it.
    void requireText(const std::string& text, const std::string& what, bool isMessage) const {
        const auto isControl = [&](char c) {
            return c == '\0' || (!isMessage && static_cast<unsigned char>(c) < 0x20);
        };
        if (!isMessage && text.size() > kMostCellBytes) {
            throw Error(where(), fmt::format("{}: {} bytes; at most {} are allowed", what,
                                             text.size(), kMostCellBytes));
        }
        if (std::ranges::any_of(text, isControl)) {
            throw Error(where(), what + ": a control character; allowed: text" +
                                     (isMessage ? "" : " of one line"));
        }
        if (!isUtf8(text)) throw Error(where(), what + ": is not UTF-8");
    }

    std::string name_, text_;
    records::CsvReader reader_;
    Names header_, fields_;
    std::map<std::string, std::size_t> places_;
};

int integerCell(const NamedCsv& csv, const std::string& column, int absent, int least, int most) {
    const std::string text = csv.cell(column);
    if (text.empty()) return absent;
    const auto value = parseInteger(text);
    if (value && *value >= least && *value <= most) return static_cast<int>(*value);
    throw Error(csv.where(), fmt::format("column '{}': '{}'; allowed: a whole number from {} to {}",
                                         column, text, least, most));
}

double numberCell(const NamedCsv& csv, const std::string& column, records::Status status) {
    const std::string text = csv.cell(column);
    if (text.empty() && status != records::Status::Ok) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto value = parsedNumber<double>(text);
    const bool isTooLarge = value && std::isinf(*value) && text.find_first_of("iI") == text.npos;
    if (value && !std::isnan(*value) && !isTooLarge) return *value;
    throw Error(csv.where(), fmt::format("column '{}': '{}'; allowed: a number, inf, or nothing in "
                                         "a row whose status is not ok",
                                         column, text));
}

std::string laneCell(const NamedCsv& csv) {
    const std::string lane = csv.cell("lane");
    if (lane.empty()) return "timing";
    if (lane == "timing" || lane == "quality") return lane;
    throw Error(csv.where(),
                fmt::format("column 'lane': '{}'; allowed: timing (the default), quality", lane));
}

records::Status statusCell(const NamedCsv& csv) {
    const std::string status = csv.cell("status");
    if (status.empty()) return records::Status::Ok;
    try {
        return records::statusFromName(status);
    } catch (const Error& error) {
        throw Error(csv.where(), fmt::format("column 'status': {}", error.what()));
    }
}

/// What a row says of its record beside metric, unit and value.
Record recordOf(const NamedCsv& csv) {
    constexpr int kMost = std::numeric_limits<int>::max();
    Record record;
    record.process = integerCell(csv, "process", 0, 0, records::kMostProcesses - 1);
    record.frame = integerCell(csv, "frame", 0, records::kSetup, kMost);
    record.repeat = integerCell(csv, "repeat", 0, records::kSetup, kMost);
    record.lane = laneCell(csv);
    record.pass = csv.cell("pass");
    record.status = statusCell(csv);
    record.message = csv.cell(kMessage);
    return record;
}

/// Takes the rows in turn, and refuses what contradicts an earlier one.
class Rows {
  public:
    explicit Rows(const ImportFiles& files) : files_(files) {}

    void add(const NamedCsv& csv, std::size_t caseIndex, Record record, const std::string& column) {
        const int line = csv.where().line;
        const auto [unit, isNewMetric] =
            units_.try_emplace(record.metric, std::pair(record.unit, line));
        if (!isNewMetric && unit->second.first != record.unit) {
            throw Error(csv.where(),
                        fmt::format("'{}' has the unit '{}'; in line {} it has '{}'", record.metric,
                                    record.unit, unit->second.second, unit->second.first));
        }
        const auto [lane, isNewCase] = lanes_.try_emplace(caseIndex, std::pair(record.lane, line));
        if (!isNewCase && lane->second.first != record.lane) {
            throw Error(csv.where(),
                        fmt::format("column 'lane': '{}'; the same case has '{}' in line {}",
                                    record.lane, lane->second.first, lane->second.second));
        }
        requireSeed(csv, record.metric, line);
        const auto [known, isNew] = lines_.try_emplace(
            {caseIndex, record.process, record.frame, record.repeat, record.pass, record.metric},
            line);
        if (!isNew) {
            throw Error(csv.where(),
                        fmt::format("'{}' of this case stands in line {} already; columns "
                                    "process, seed, frame and repeat tell measurements apart",
                                    column, known->second));
        }
        const bool hasSeed = !files_.isSeedSwept && !csv.cell(kSeed).empty();
        rows.push_back({caseIndex, std::move(record), line, hasSeed, !csv.cell("frame").empty()});
    }

    std::vector<ImportedRow> rows;

  private:
    /// One value without a seed beside those of several would count as what never varies.
    void requireSeed(const NamedCsv& csv, const std::string& metric, int line) {
        if (metric.empty() || files_.isSeedLeftOut) return;
        const auto said = [](const std::string& seed) {
            return seed.empty() ? "no seed" : "the seed '" + seed + "'";
        };
        const std::string seed = csv.cell(kSeed);
        const auto [first, isNew] = seeds_.try_emplace(metric, std::pair(seed, line));
        const auto& [firstSeed, firstLine] = first->second;
        if (isNew || firstSeed.empty() == seed.empty()) return;
        throw Error(
            csv.where(),
            fmt::format(
                "'{}' has {}; in line {} it has {}; allowed: one in all of its "
                "rows, or in none; what draws no random numbers has the same value "
                "with each{}",
                metric, said(seed), firstLine, said(firstSeed),
                files_.isSeedSwept ? ", or 'when: {seed: …}' in the sweep leaves it without" : ""));
    }

    const ImportFiles& files_;
    using Key = std::tuple<std::size_t, int, int, int, std::string, std::string>;
    std::map<Key, int> lines_;
    std::map<std::string, std::pair<std::string, int>> units_;  // by metric: unit, line
    std::map<std::size_t, std::pair<std::string, int>> lanes_;  // by case: lane, line
    std::map<std::string, std::pair<std::string, int>> seeds_;  // by metric: seed, line
};

/// Of the columns those of the cases. Throws Error for what cannot be one of them.
Names caseColumns(const NamedCsv& csv, const ImportFiles& files) {
    Names columns;
    for (const std::string& name : csv.header()) {
        const bool isMetric =
            std::ranges::any_of(files.metrics, [&](const auto& m) { return m.first == name; });
        const bool isParameter = files.isSeedSwept && name == kSeed;
        if (isMetric || (isOneOf(name, kRecordColumns) && !isParameter)) continue;
        if (isOneOf(name, kLongColumns)) {
            if (files.metrics.empty()) continue;
            throw Error(csv.where(), fmt::format("column '{}' beside --metric; allowed: one of "
                                                 "the two forms",
                                                 name));
        }
        if (name == "case_id" || name == "stands_for" || name == "scene_sample") {
            throw Error(csv.where(), fmt::format("column '{}' says nothing of a case here; "
                                                 "allowed: columns of its parameters",
                                                 name));
        }
        columns.push_back(name);
    }
    return columns;
}

/// A column "a" that is text and "a.b" that is a part of it cannot both be.
void requireNoParts(const NamedCsv& csv, const Names& columns) {
    const std::set<std::string> all(columns.begin(), columns.end());
    for (const std::string& name : columns) {
        for (std::size_t dot = name.find('.'); dot != name.npos; dot = name.find('.', dot + 1)) {
            if (!all.contains(name.substr(0, dot))) continue;
            throw Error({csv.where().file, 1, 0},
                        fmt::format("columns '{}' and '{}': the second is a part of the first",
                                    name.substr(0, dot), name));
        }
    }
}

ImportedCase caseOf(const NamedCsv& csv, const Names& columns) {
    ImportedCase item{{}, csv.where()};
    for (const std::string& column : columns) {
        if (std::string text = csv.cell(column); !text.empty()) {
            item.cells.emplace_back(column, std::move(text));
        }
    }
    return item;
}

void requireColumns(const NamedCsv& csv, const ImportFiles& files) {
    for (const auto& [column, unit] : files.metrics) csv.require(column, "what --metric names");
    if (files.metrics.empty()) {
        csv.require("metric", "metric, value; or --metric COLUMN=UNIT for each column of numbers");
        csv.require("value", "metric, value");
    }
    if (!files.isSeedSwept && csv.has(kSeed) && csv.has("process")) {
        throw Error(csv.where(),
                    "columns 'seed' and 'process': a seed is of a process of its own; allowed: one "
                    "of the two, or the column 'params.seed' for a parameter");
    }
}

/// The records of one row of the file.
void addRow(const NamedCsv& csv, const ImportFiles& files, std::size_t caseIndex, Record record,
            Rows& rows) {
    if (files.metrics.empty()) {
        record.metric = csv.cell("metric");
        record.unit = csv.cell("unit");
        if (record.metric.empty() && record.status == records::Status::Ok) {
            throw Error(csv.where(),
                        "column 'metric' is empty; allowed: nothing only in a row "
                        "whose status is not ok");
        }
        record.value = numberCell(csv, "value", record.status);
        rows.add(csv, caseIndex, record, record.metric);
        return;
    }
    bool isEmpty = true;
    for (const auto& [column, unit] : files.metrics) {
        if (csv.cell(column).empty()) continue;
        Record one = record;
        one.metric = column;
        one.unit = unit;
        one.value = numberCell(csv, column, record.status);
        rows.add(csv, caseIndex, std::move(one), column);
        isEmpty = false;
    }
    if (!isEmpty) return;
    if (record.status == records::Status::Ok) {
        throw Error(csv.where(), "no number; allowed: none only in a row whose status is not ok");
    }
    record.value = std::numeric_limits<double>::quiet_NaN();
    rows.add(csv, caseIndex, std::move(record), "status");
}

/// What has neither a seed, beside others that have, nor a frame is the set-up's: it draws no
/// random numbers.
void placeSeedless(ImportedNumbers& numbers) {
    if (std::ranges::none_of(numbers.cases, &ImportedCase::hasSeeds)) return;
    for (ImportedRow& row : numbers.rows) {
        const bool isOfFrame = row.hasFrame || config::isTimeMetric(row.record.metric);
        if (!row.hasSeed && !isOfFrame) row.record.frame = records::kSetup;
    }
}

/// Where no two cases share a process, or a seed, but share all, those of each are counted from 0;
/// else a case lacks those that others have.
void countProcesses(ImportedNumbers& numbers) {
    const bool areSeeds = std::ranges::any_of(numbers.cases, &ImportedCase::hasSeeds);
    std::vector<std::set<int>> processes(numbers.cases.size());
    for (const ImportedRow& row : numbers.rows) {
        if (row.hasSeed == areSeeds) processes[row.caseIndex].insert(row.record.process);
    }
    std::map<int, const std::set<int>*> first;
    for (const std::set<int>& own : processes) {
        for (const int process : own) {
            if (*first.try_emplace(process, &own).first->second != own) return;
        }
    }
    for (ImportedRow& row : numbers.rows) {
        const std::set<int>& own = processes[row.caseIndex];
        if (row.hasSeed != areSeeds) continue;
        row.record.process =
            static_cast<int>(std::distance(own.begin(), own.find(row.record.process)));
    }
}

}  // namespace

std::string ImportedCase::cell(std::string_view column) const {
    for (const auto& [name, text] : cells) {
        if (name == column) return text;
    }
    return "";
}

ImportedNumbers readImport(const ImportFiles& files) {
    ImportedNumbers numbers;
    std::map<std::string, std::size_t> places;
    NamedCsv csv(files.file);
    requireColumns(csv, files);
    numbers.columns = caseColumns(csv, files);
    requireNoParts(csv, numbers.columns);
    Rows rows(files);
    std::map<std::string, int> seeds;  // in the order of the file
    while (csv.next()) {
        std::string key;
        for (const std::string& column : numbers.columns) key += csv.cell(column) + '\x1f';
        const auto [known, isNew] = places.try_emplace(key, numbers.cases.size());
        if (isNew) numbers.cases.push_back(caseOf(csv, numbers.columns));
        const std::size_t place = known->second;
        Record record = recordOf(csv);
        if (const std::string seed = csv.cell(kSeed); !files.isSeedSwept && !seed.empty()) {
            record.process = seeds.try_emplace(seed, static_cast<int>(seeds.size())).first->second;
            numbers.cases[place].hasSeeds = true;
        }
        addRow(csv, files, place, std::move(record), rows);
    }
    if (rows.rows.empty()) throw Error({files.file.string(), 0, 0}, "has a header and no row");
    numbers.rows = std::move(rows.rows);
    placeSeedless(numbers);
    countProcesses(numbers);
    return numbers;
}

}  // namespace gfxrepro::outcome
