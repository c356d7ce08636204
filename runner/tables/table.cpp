#include "runner/tables/table.h"

#include <algorithm>
#include <set>

#include "engine/core/text.h"
#include "runner/config/external_program.h"
#include "runner/records/csv.h"
#include "runner/tables/cell_builder.h"
#include "runner/tables/default_layout.h"
#include "runner/tables/fit.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed_parameters.h"

namespace gfxrepro::tables {

namespace {

/// Numbers compare as numbers: "64.0" is 64.
std::string canonicalCell(const std::string& text) {
    const auto number = parseDouble(trimmed(text));
    return number ? records::shortestText(*number) : std::string(trimmed(text));
}

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

/// Of each case that has swept values these in words.
CaseNames namesOf(const LayoutCases& cases, const Words& words) {
    CaseNames names;
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
    FrameTimes times(!config::programOf(experiment).isNull());
    for (const records::Record& record : records) {
        if (record.table == table.id) times.add(record);
    }
    table.wallNoise = times.noise(Clock::Wall);
    table.processNoise = times.noise(Clock::Process);
    table.notes = timeNotes(times, experiment.measure, namesOf(cases, table.words));
}

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

/// The columns of `printed` that name row axes and table columns.
struct PrintedColumns {
    std::vector<std::optional<std::size_t>> axes;     // beside the row axes
    std::vector<std::optional<std::size_t>> columns;  // beside the table's columns
};

PrintedColumns findColumns(const config::Printed& printed, const Table& table) {
    PrintedColumns found;
    const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
        const auto at = std::find(printed.header.begin(), printed.header.end(), name);
        if (at == printed.header.end()) return std::nullopt;
        return static_cast<std::size_t>(at - printed.header.begin());
    };
    for (const std::string& axis : table.rowAxes) found.axes.push_back(find(axis));
    for (const TableColumn& column : table.columns) found.columns.push_back(find(column.label));
    return found;
}

/// The columns of `printed` that the table does not have: a profile or a sweep took them away.
std::vector<std::string> absentColumns(const config::Printed& printed, const Table& table) {
    std::vector<std::string> absent;
    for (const std::string& name : printed.header) {
        if (std::ranges::find(table.rowAxes, name) != table.rowAxes.end()) continue;
        if (std::ranges::find(table.columns, name, &TableColumn::label) != table.columns.end()) {
            continue;
        }
        absent.push_back(name);
    }
    return absent;
}

bool isRowOf(const std::vector<std::string>& printedRow, const PrintedColumns& found,
             const TableRow& row) {
    for (std::size_t i = 0; i < found.axes.size(); ++i) {
        if (found.axes[i] && canonicalCell(printedRow[*found.axes[i]]) != row.labels[i]) {
            return false;
        }
    }
    return true;
}

void layPrintedBeside(const config::Experiment& experiment, const std::vector<Key>& columns,
                      Table& table) {
    const config::Printed& printed = experiment.printed;
    if (printed.rows.empty()) return;
    const PrintedColumns found = findColumns(printed, table);
    const std::vector<std::string> absent = absentColumns(printed, table);
    if (!absent.empty()) {
        std::vector<std::string> said;
        for (const std::string& name : absent) said.push_back(shownName(name, table.words));
        table.notes.push_back("printed columns that are not part of this run: " + joined(said));
    }
    const auto layInto = [&](TableRow& row, const std::vector<std::string>& printedRow) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (!found.columns[i] || printedRow[*found.columns[i]].empty()) continue;
            Cell& cell = row.cells[i];
            cell.printed = printedRow[*found.columns[i]];
            cell.printedValues =
                makeQuery(experiment.layout, row.labels, columns[i]).format.parse(*cell.printed);
        }
    };
    for (const std::vector<std::string>& printedRow : printed.rows) {
        bool isPlaced = false;
        for (TableRow& row : table.rows) {
            if (!isRowOf(printedRow, found, row)) continue;
            isPlaced = true;
            layInto(row, printedRow);
        }
        if (isPlaced) continue;
        Cell unplanned;
        unplanned.isPlanned = false;
        TableRow row{{}, SceneSource::Unknown, std::vector<Cell>(columns.size(), unplanned)};
        for (const auto& axis : found.axes) {
            row.labels.push_back(axis ? canonicalCell(printedRow[*axis]) : "");
        }
        layInto(row, printedRow);
        table.printedRows.push_back(std::move(row));
    }
}

/// Of a table without a measurement.
void layPrintedAlone(const config::Printed& printed, Table& table) {
    if (printed.rows.empty()) return;
    table.isOnlyPrinted = true;
    table.rowAxes = {printed.header[0]};
    for (std::size_t i = 1; i < printed.header.size(); ++i) {
        table.columns.push_back(
            {printed.header[i], "", {}, config::Better::Neither, {printed.header[i]}});
    }
    for (const std::vector<std::string>& printedRow : printed.rows) {
        TableRow row{{printedRow[0]}, SceneSource::Unknown, {}};
        for (std::size_t i = 1; i < printedRow.size(); ++i) {
            Cell cell;
            cell.isPlanned = false;
            if (!printedRow[i].empty()) cell.printed = printedRow[i];
            row.cells.push_back(std::move(cell));
        }
        table.rows.push_back(std::move(row));
    }
}

}  // namespace

const Measured* Cell::find(const std::string& statistic, Clock clock) const {
    for (const Measured& candidate : clock == Clock::Wall ? values : byProcess) {
        if (statistic.empty() || candidate.statistic == statistic) return &candidate;
    }
    return nullptr;
}

std::string_view sceneSourceName(SceneSource source) {
    switch (source) {
        case SceneSource::Real:
            return "real";
        case SceneSource::Generated:
            return "generated";
        case SceneSource::StandIn:
            return "stand-in";
        case SceneSource::Unknown:
            break;
    }
    return "";
}

bool Table::hasSources() const {
    return std::any_of(rows.begin(), rows.end(),
                       [](const TableRow& row) { return row.source != SceneSource::Unknown; });
}

bool Table::hasCalibrated() const {
    return std::ranges::any_of(rows, [](const TableRow& row) {
        return std::ranges::any_of(
            row.cells, [](const Cell& cell) { return cell.isCalibrated && cell.isPlanned; });
    });
}

bool Table::hasShown(Bounds bounds) const {
    return std::ranges::any_of(rows, [&](const TableRow& row) {
        return std::ranges::any_of(row.cells, [&](const Cell& cell) {
            return cell.hasShownBounds() && cell.bounds() == bounds;
        });
    });
}

std::string Table::rowName(std::size_t row) const {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < rowAxes.size(); ++i) {
        const std::string& value = rows[row].labels[i];
        parts.push_back(rowAxes[i].empty() ? value : rowAxes[i] + "=" + value);
    }
    return joined(parts);
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
            result.rows[place->second].cells[columns.at(row.labels[rowAxis])] = row.cells[i];
        }
    }
    return result;
}

Table buildTable(const config::Experiment& given, std::span<const config::Case> planned,
                 const std::vector<records::Record>& records) {
    config::Experiment experiment = given;
    Table table;
    std::vector<std::string> notes;
    if (given.hasDefaultLayout()) {
        DefaultLayout made = defaultLayout(given, planned, records);
        experiment.layout = std::move(made.layout);
        table.constants = std::move(made.constants);
        notes = std::move(made.notes);
    }
    table.id = experiment.id;
    table.slug = experiment.slug();
    table.label = experiment.label();
    table.title = experiment.title;
    table.words = experiment.labels;
    table.hardware = experiment.printed.hardware;
    table.remark = experiment.printed.remark;
    if (experiment.technique.empty()) layPrintedAlone(experiment.printed, table);
    if (!experiment.layout.isGiven) return table;

    const config::Layout& layout = experiment.layout;
    const LayoutCases cases = gatherCases(experiment, planned, records);
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
    buildCells(layout, cases, printed, columns, table);
    for (TableRow& row : table.rows) {
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            row.cells[i].isCalibrated =
                config::isCalibrated(experiment, row.labels, table.columns[i].label);
        }
    }
    if (given.hasDefaultLayout()) describeColumns(given, layout, table);
    addTimes(experiment, records, cases, table);
    table.notes.insert(table.notes.end(), notes.begin(), notes.end());
    layPrintedBeside(experiment, columns, table);
    blankWhatOthersHave(table);
    for (std::string& note : fitNotes(fitOf(experiment, table), table)) {
        table.notes.push_back(std::move(note));
    }
    return table;
}

std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const config::Case> planned,
                               const std::vector<records::Record>& records) {
    std::vector<Table> tables;
    for (const config::Experiment& experiment : experiments) {
        tables.push_back(buildTable(experiment, planned, records));
    }
    return tables;
}

}  // namespace gfxrepro::tables
