#include "runner/tables/table.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/text.h"
#include "runner/config/external_program.h"
#include "runner/records/csv.h"
#include "runner/tables/calibration.h"
#include "runner/tables/default_layout.h"
#include "runner/tables/expression.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"

namespace gfxrepro::tables {

// Tables as their experiments lay them out.

namespace {

std::vector<std::string> axisNames(const std::vector<config::LayoutAxis>& axes) {
    std::vector<std::string> names;
    for (const config::LayoutAxis& axis : axes) names.push_back(axis.name);
    return names;
}

void buildCells(const config::Layout& layout, const LayoutCases& cases,
                const PrintedParameters& printed, const std::vector<Key>& columns, Table& table) {
    std::vector<std::set<std::string>> units(columns.size());
    for (TableRow& row : table.rows) {
        row.source = sceneSourceOf(layout, row.labels, cases);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (layout.computed(table.columns[i].label)) {
                row.cells.emplace_back().isPlanned = false;  // until fillComputed()
                continue;
            }
            row.cells.push_back(buildCell(makeQuery(layout, row.labels, columns[i]), cases));
            printed.compare(layout, row.labels, columns[i], cases, row.cells.back());
            const std::string& unit = row.cells.back().unit;
            if (!unit.empty()) units[i].insert(unit);
        }
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (units[i].size() == 1) table.columns[i].unit = *units[i].begin();
    }
}

/// What varies and is rounded is so in all rows and columns of its metric; what is scaled, in those
/// of its column.
void markRounded(Table& table) {
    std::map<std::tuple<std::string, std::string, Clock>, std::vector<Measured*>> alike;
    for (TableRow& row : table.rows) {
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            Cell& cell = row.cells[i];
            if (!cell.isTime && cell.seedCount < 2 && !cell.scatters) continue;
            const std::string& name = cell.metric.empty() ? table.columns[i].label : cell.metric;
            for (Measured& one : cell.values)
                alike[{name, one.statistic, Clock::Wall}].push_back(&one);
            for (Measured& one : cell.byProcess)
                alike[{name, one.statistic, Clock::Process}].push_back(&one);
        }
    }
    for (const auto& [name, values] : alike) {
        std::vector<const std::map<int, double>*> series;
        for (const Measured* value : values) series.push_back(&value->rounds);
        const double halfStep = halfStepOf(series);
        for (Measured* value : values) value->halfStep = halfStep;
    }
}

/// Rows of a scene that could not be fitted; all of them where the table is of no other.
void markUnfit(const config::Experiment& experiment, std::span<const config::Case> planned,
               Table& table) {
    const auto isUnfit = [&](const std::string& scene) {
        return std::ranges::find(experiment.printed.unfit, scene) != experiment.printed.unfit.end();
    };
    const auto axis = std::ranges::find(table.rowAxes, "scene") - table.rowAxes.begin();
    const bool isOfUnfit =
        !planned.empty() && std::ranges::all_of(planned, [&](const config::Case& item) {
            return !item.scene.isNull() && isUnfit(item.scene.text());
        });
    for (TableRow& row : table.rows) {
        const bool hasScene = axis < std::ssize(table.rowAxes);
        row.isUnfit = hasScene ? isUnfit(row.labels[static_cast<std::size_t>(axis)]) : isOfUnfit;
    }
}

/// Of each case that has swept values these in words.
LabelsOfCases namesOf(const LayoutCases& cases, const Words& words) {
    LabelsOfCases names;
    for (const CaseRecords& item : cases.cases) {
        std::vector<std::string> parts;
        for (std::size_t i = 0; i < item.axes.size(); ++i) {
            if (item.axes[i]) parts.push_back(shownValue(cases.axes[i], *item.axes[i], words));
        }
        if (!parts.empty()) names[item.id] = joined(parts);
    }
    return names;
}

/// The noise of a table of times, what ended its rounds, and what stands out.
void addTimes(const config::Experiment& experiment, const std::vector<records::Record>& records,
              const LayoutCases& cases, Table& table) {
    if (experiment.measure.lane != config::Measure::Lane::Timing) return;
    FrameTimes times(table.goesByClock);
    for (const records::Record& record : records) {
        if (record.table == table.id) times.add(record);
    }
    table.wallNoise = times.noise(Clock::Wall);
    table.processNoise = times.noise(Clock::Process);
    table.notes = timeNotes(times, experiment.measure, namesOf(cases, table.words));
}

}  // namespace

std::string seedNote(const Table& table) {
    const auto columnsWith = [&](const std::function<bool(const Cell&)>& isSuch) {
        std::vector<std::string> columns;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const bool hasSome = std::ranges::any_of(
                table.rows, [&](const TableRow& row) { return isSuch(row.cells[i]); });
            if (hasSome) columns.push_back(quantityOf(table.columns[i], table.words).words);
        }
        return joined(columns);
    };
    std::string note;
    if (const std::string columns = columnsWith(&Cell::isOfOneSeed); !columns.empty()) {
        note = fmt::format(
            "One seed, and another would give other numbers: {}. How far apart they are `measure: "
            "{{processes: 6}}` tells where the seed is not swept.",
            columns);
    }
    const auto differs = [](const Cell& cell) {
        if (!cell.scatters || cell.values.empty()) return false;
        const Measured& first = cell.values[0];
        return first.isOverProcesses || first.interval.low != first.interval.high;
    };
    if (const std::string columns = columnsWith(differs); !columns.empty()) {
        note += fmt::format(
            "{}Repeats or processes came to different numbers, and no seed is declared: {}.",
            note.empty() ? "" : " ", columns);
    }
    return note;
}

namespace {

/// With a value, or with a time that was taken beside other cases and is no result.
bool isRecorded(const Cell& cell) {
    return !cell.values.empty() || cell.status == records::Status::Ambiguous;
}

/// What the cases of a cell did not record is blank where others of its row and of its column were
/// recorded: other methods, or more images, have it. A whole row or column without a value is
/// missing, as one of a misspelt metric, and so is what is printed.
void blankWhatOthersHave(Table& table) {
    std::vector<bool> isOfOthers;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        isOfOthers.push_back(std::ranges::any_of(
            table.rows, [&](const TableRow& row) { return isRecorded(row.cells[i]); }));
    }
    for (TableRow& row : table.rows) {
        if (std::ranges::none_of(row.cells, isRecorded)) continue;
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            Cell& cell = row.cells[i];
            if (!cell.isUnrecorded || !isOfOthers[i] || cell.printed) continue;
            cell.isPlanned = false;
            cell.measured.clear();
        }
    }
}

}  // namespace

bool Table::hasSources() const {
    return std::ranges::any_of(
        rows, [](const TableRow& row) { return row.source != SceneSource::Unknown; });
}

bool Table::hasCell(const std::function<bool(const Cell&)>& isSuch) const {
    return std::ranges::any_of(
        rows, [&](const TableRow& row) { return std::ranges::any_of(row.cells, isSuch); });
}

bool Table::hasCalibrated() const {
    return hasCell([](const Cell& cell) { return cell.isCalibrated && cell.isPlanned; });
}

bool Table::hasShown(Bounds bounds) const {
    return hasCell(
        [&](const Cell& cell) { return cell.hasShownBounds() && cell.bounds() == bounds; });
}

bool Table::hasPrinted() const {
    return hasCell([](const Cell& cell) { return cell.printed.has_value(); });
}

std::optional<std::size_t> Table::findColumn(std::string_view name) const {
    const auto found = std::ranges::find(columns, name, &TableColumn::label);
    if (found == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - columns.begin());
}

std::string Table::rowName(std::size_t row) const {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < rowAxes.size(); ++i) {
        const std::string& value = rows[row].labels[i];
        parts.push_back(rowAxes[i].empty() ? value : rowAxes[i] + "=" + value);
    }
    return joined(parts);
}

std::string canonicalCell(std::string_view text) {
    const auto number = parseDouble(trimmed(text));
    return number ? records::shortestText(*number) : std::string(trimmed(text));
}

Table transposed(const Table& table, std::size_t rowAxis) {
    GFXREPRO_ASSERT(rowAxis < table.rowAxes.size());
    const auto without = [rowAxis](std::vector<std::string> labels) {
        labels.erase(labels.begin() + static_cast<std::ptrdiff_t>(rowAxis));
        return labels;
    };
    Table result = table;
    result.rowAxes = without(table.rowAxes);
    result.rowAxes.emplace_back(config::kColumnAxis);
    result.columns.clear();
    result.rows.clear();
    std::map<std::string, std::size_t> columns;
    for (const TableRow& row : table.rows) {
        const std::string& label = row.labels[rowAxis];
        if (columns.try_emplace(label, columns.size()).second)
            result.columns.push_back({label, ""});
    }
    Cell unplanned;
    unplanned.isPlanned = false;
    std::map<std::vector<std::string>, std::size_t> places;  // labels → index in result.rows
    for (const TableRow& row : table.rows) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            std::vector<std::string> labels = without(row.labels);
            labels.push_back(table.columns[i].label);
            const auto [place, isNew] = places.try_emplace(labels, result.rows.size());
            if (isNew) {
                result.rows.push_back({std::move(labels), row.source,
                                       std::vector<Cell>(result.columns.size(), unplanned)});
            }
            result.rows[place->second].isUnfit |= row.isUnfit;
            result.rows[place->second].cells[columns.at(row.labels[rowAxis])] = row.cells[i];
        }
    }
    return result;
}

Table buildTable(const config::Experiment& given, std::span<const config::Case> planned,
                 const std::vector<records::Record>& records, const Doubt& doubt) {
    config::Experiment experiment = given;
    Table table;
    std::vector<std::string> notes, against;
    Rivals rivals;
    if (given.hasDefaultLayout()) {
        DefaultLayout made = defaultLayout(given, planned, records);
        experiment.layout = std::move(made.layout);
        table.constants = std::move(made.constants);
        notes = std::move(made.notes);
        rivals = std::move(made.rivals);
        against = std::move(made.against);
    }
    table.id = experiment.id;
    table.slug = experiment.slug();
    table.label = experiment.label();
    table.title = experiment.title;
    table.goesByClock = config::goesByClock(experiment);
    table.words = experiment.labels;
    table.hardware = experiment.printed.hardware;
    table.remark = experiment.printed.remark;
    if (experiment.technique.empty()) layPrintedAlone(experiment.printed, table);
    if (!experiment.layout.isGiven) return table;

    const config::Layout& layout = experiment.layout;
    LayoutCases cases = gatherCases(experiment, planned, records);
    if (cases.isOfProgram) cases.doubt.add(doubt);
    const std::vector<Key> columns = collectKeys(layout.columns, cases);
    table.rowAxes = axisNames(layout.rows);
    for (const Key& column : columns) {
        table.columns.push_back({joined(column, "_"), "", {}, config::Better::Neither, column});
    }
    for (Key& row : collectKeys(layout.rows, cases)) {
        table.rows.push_back({std::move(row), SceneSource::Unknown, {}});
    }
    const PrintedParameters printed(experiment);
    table.isPublished = experiment.isPublished();
    table.knowsPrintedParameters = printed.isKnown();
    table.isPrintUnsaid = printed.isUnsaid();
    buildCells(layout, cases, printed, columns, table);
    markRounded(table);
    for (TableRow& row : table.rows) {
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            row.cells[i].isCalibrated =
                config::isCalibrated(experiment, row.labels, table.columns[i].label);
        }
    }
    if (!experiment.printed.unfit.empty()) markUnfit(experiment, planned, table);
    if (given.hasDefaultLayout()) describeColumns(given, layout, table);
    addTimes(experiment, records, cases, table);
    table.notes.insert(table.notes.end(), notes.begin(), notes.end());
    layPrintedBeside(experiment, table);
    blankWhatOthersHave(table);
    fillComputed(layout, table);
    if (std::string note = seedNote(table); !note.empty()) table.notes.push_back(std::move(note));
    compareRivals(rivals, against, table);
    for (std::string& note : cellNotes(table)) table.notes.push_back(std::move(note));
    for (std::string& note : config::ownTruths(experiment, planned)) {
        table.notes.push_back(std::move(note));
    }
    for (std::string& note : fitNotes(fitOf(experiment, table), table)) {
        table.notes.push_back(std::move(note));
    }
    return table;
}

namespace {

/// Of a time the same by the process's CPU time, formatted likewise; nothing is planned where it
/// has none.
Cell processCell(const Cell& cell) {
    Cell own;
    own.isPlanned = !cell.byProcess.empty();
    if (!own.isPlanned) return own;
    own.status = cell.status;
    own.message = cell.message;
    own.values = cell.byProcess;
    own.measured = cell.measuredByProcess;
    own.low = cell.lowByProcess;
    own.high = cell.highByProcess;
    own.caseIds = cell.caseIds;
    own.isTime = true;
    own.timePower = cell.timePower;
    own.isWithinNoise = cell.isWithinNoise;
    own.unit = cell.unit;
    return own;
}

}  // namespace

void showProcessTimes(const std::vector<std::string>& labels, Table& table) {
    for (const std::string& label : labels) {
        const auto place = table.findColumn(label);
        if (!place) continue;
        const auto next = static_cast<std::ptrdiff_t>(*place) + 1;
        TableColumn column = table.columns[*place];
        const std::string own = column.parts.empty() ? label : column.parts.back();
        const std::string name = "cpu_" + own;
        column.label = label.substr(0, label.size() - own.size()) + name;
        if (table.findColumn(column.label)) continue;
        if (!column.parts.empty()) column.parts.back() = name;
        column.doc = "CPU time of all threads of the process, which claims and comparisons go by";
        table.words[name] = quantityOf(own, table.words, column.unit).words + ", CPU";
        table.columns.insert(table.columns.begin() + next, std::move(column));
        for (auto* rows : {&table.rows, &table.printedRows}) {
            for (TableRow& row : *rows) {
                const Cell cell = processCell(row.cells[*place]);
                row.cells.insert(row.cells.begin() + next, cell);
            }
        }
    }
}

std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const config::Case> planned,
                               const std::vector<records::Record>& records,
                               std::span<const config::Experiment> measured) {
    const auto doubts = doubtsOf(measured.empty() ? experiments : measured, planned, records);
    std::vector<Table> tables;
    for (const config::Experiment& experiment : experiments) {
        const auto doubt = doubts.find(experiment.id);
        tables.push_back(buildTable(experiment, planned, records,
                                    doubt == doubts.end() ? Doubt() : doubt->second));
    }
    return tables;
}

// Times that are not of one clock.

namespace {

void widen(std::optional<ClockRange>& range, const ClockRange& by) {
    const ClockRange before = range.value_or(by);
    range = {std::min(before.lowHz, by.lowHz), std::max(before.highHz, by.highHz)};
}

}  // namespace

void markMovedClocks(const MovedClocks& moved, Table& table) {
    if (moved.empty()) return;
    for (TableRow& row : table.rows) {
        for (Cell& cell : row.cells) {
            if (!cell.isTime || cell.values.empty()) continue;
            for (const std::string& caseId : cell.caseIds) {
                const auto clock = moved.find(caseId);
                if (clock != moved.end()) widen(cell.movedClock, clock->second);
            }
        }
    }
}

std::optional<ClockRange> movedClock(const Table& table, std::size_t column) {
    std::optional<ClockRange> range;
    for (const TableRow& row : table.rows) {
        if (row.cells[column].movedClock) widen(range, *row.cells[column].movedClock);
    }
    return range;
}

std::optional<ClockRange> movedClock(const Table& table) {
    std::optional<ClockRange> range;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (const auto clock = movedClock(table, i)) widen(range, *clock);
    }
    return range;
}

std::string clockText(const ClockRange& clock) {
    return fmt::format("{:.3g} and {:.3g} GHz", 1e-9 * clock.lowHz, 1e-9 * clock.highHz);
}

std::string movedClockLegend(const ClockRange& clock) {
    return "timed while the GPU's clock moved between " + clockText(clock);
}

}  // namespace gfxrepro::tables
