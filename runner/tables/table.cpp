#include "runner/tables/table.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/text.h"
#include "runner/records/csv.h"
#include "runner/tables/calibration.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"

namespace gfxrepro::tables {

// A table and its plots for whoever laid out none.

namespace {

constexpr double kMebibyte = 1 << 20;

/// What was recorded of a metric and pass.
struct Series {
    std::string metric, pass, unit;
    std::size_t order = 0;  // in which it was recorded
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    bool isWhole = true;
    std::set<std::string> cases = {};

    bool isOfMebibytes() const { return unit == "byte" && most >= kMebibyte; }
    std::string label() const {
        if (metric == "wall_time_ms") return "frame_ms";
        if (metric == "gpu_time_ms" || metric == "cpu_time_ms") return pass + "_ms";
        std::string name = metric;
        if (isOfMebibytes() && name.ends_with("_bytes")) name.replace(name.size() - 5, 5, "mib");
        return pass.empty() ? name : name + '_' + pass;
    }
    std::string shown(double value) const {
        return isOfMebibytes() ? fmt::format("{:.4g}", value / kMebibyte)
                               : records::shortestText(
                                     isWhole ? value : std::stod(fmt::format("{:.4g}", value)));
    }
};

std::vector<Series> seriesOf(const std::string& table,
                             const std::vector<records::Record>& records) {
    std::map<std::pair<std::string, std::string>, std::size_t> places;
    std::vector<Series> all;
    for (const records::Record& record : records) {
        const bool isOfTable = record.table == table && record.process >= 0;
        if (!isOfTable || record.metric.empty() || std::isnan(record.value)) continue;
        const auto [place, isNew] = places.try_emplace({record.metric, record.pass}, places.size());
        if (isNew) all.push_back({record.metric, record.pass, record.unit, all.size()});
        Series& series = all[place->second];
        series.least = std::min(series.least, record.value);
        series.most = std::max(series.most, record.value);
        series.isWhole &= record.value == std::round(record.value);
        series.cases.insert(record.caseId);
    }
    return all;
}

/// In the order of declaration, without details.
std::vector<Series> declared(std::vector<Series> all, const config::Outputs& outputs) {
    std::erase_if(all, [&](const Series& series) {
        if (series.metric == "scene_source") return true;  // a row's mark
        if (outputs.metrics.empty()) return false;
        const config::MetricInfo* info = outputs.find(series.metric);
        return !info || info->isDetail || info->name != series.metric;
    });
    const auto rank = [&](const Series& series) {
        const auto at =
            std::ranges::find(outputs.metrics, series.metric, &config::MetricInfo::name);
        const bool isPass = series.metric == "gpu_time_ms" || series.metric == "cpu_time_ms";
        const int group = series.metric == "wall_time_ms" ? 0 : isPass ? 1 : 2;
        return std::tuple(group, group < 2 ? outputs.metrics.begin() : at, series.order);
    };
    std::ranges::stable_sort(all, {}, rank);
    return all;
}

/// Counts as they are, other numbers as far as they are worth reading.
std::string formatOf(const Series& series) {
    constexpr double kManyDigits = 1e4;
    if (series.isOfMebibytes()) return "{median:.4g}";
    return series.isWhole || series.most >= kManyDigits ? "{median:.0f}" : "{median:.4g}";
}

struct Axis {
    std::size_t index;
    std::vector<double> numbers;  // those of its labels; empty where one is none
    std::size_t count = 0;        // of its labels
};

Axis axisOf(const Table& table, std::size_t index) {
    std::set<std::string> labels;
    std::set<double> numbers;
    for (const TableRow& row : table.rows) {
        labels.insert(row.labels[index]);
        if (const auto number = parseDouble(row.labels[index])) numbers.insert(*number);
    }
    const bool isOfNumbers = numbers.size() == labels.size();
    return {
        index,
        isOfNumbers ? std::vector<double>(numbers.begin(), numbers.end()) : std::vector<double>(),
        labels.size()};
}

/// Values over several powers of two are told apart on a logarithmic axis alone.
bool isWide(double least, double most, double factor) {
    return least > 0.0 && most / least >= factor;
}

bool isWide(const Table& table, const std::vector<std::string>& columns) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (std::ranges::find(columns, table.columns[i].label) == columns.end()) continue;
        for (const TableRow& row : table.rows) {
            if (row.cells[i].values.empty()) continue;
            least = std::min(least, row.cells[i].values[0].value);
            most = std::max(most, row.cells[i].values[0].value);
        }
    }
    return isWide(least, most, 20.0);
}

std::size_t measuredCount(const Table& table, std::size_t column) {
    return static_cast<std::size_t>(std::ranges::count_if(
        table.rows, [&](const TableRow& row) { return row.cells[column].isOk(); }));
}

/// What is counted in frames, and one frame does not have.
std::vector<std::string> frameNotes(const config::Experiment& experiment,
                                    const std::vector<Series>& recorded) {
    std::vector<std::string> notes;
    if (experiment.measure.frames > 1 || recorded.empty()) return notes;
    for (const config::MetricInfo& info : experiment.outputs.metrics) {
        const bool isRecorded =
            std::ranges::find(recorded, info.name, &Series::metric) != recorded.end();
        if (info.unit != "frame" || isRecorded) continue;
        notes.push_back(fmt::format(
            "One frame of each case is measured: the {}, and whatever follows from frames before, "
            "needs several (`measure: {{frames: 20}}`).",
            quantityOf(info.name, experiment.labels).words));
    }
    return notes;
}

struct DefaultLayout {
    config::Layout layout;               // not given where nothing was recorded
    std::vector<std::string> constants;  // "triangles 69451": alike in all cases, so no column
    /// Of one frame alone, where the technique declares a number of frames, which no case recorded.
    std::vector<std::string> notes;
};

/// For an experiment of one's own without a `layout`: a row a point of its sweep; columns are the
/// times of a frame and its passes, then the metrics in the order in which the technique declares
/// them (Experiment::outputs), without details. Of plans that do not know what was declared: all,
/// as recorded. A MiB and more is shown in MiB.
DefaultLayout defaultLayout(const config::Experiment& experiment,
                            std::span<const config::Case> planned,
                            const std::vector<records::Record>& records) {
    DefaultLayout result;
    std::set<std::string> axes;
    for (const config::Case& item : planned) {
        if (item.experiment != experiment.id) continue;
        for (const auto& [axis, value] : item.axes.entries()) {
            if (axes.insert(axis).second) result.layout.rows.push_back({axis, {}});
        }
    }
    const std::vector<Series> all = seriesOf(experiment.id, records);
    result.notes = frameNotes(experiment, all);
    std::set<std::string> measured;
    for (const Series& series : all) measured.insert(series.cases.begin(), series.cases.end());
    config::LayoutAxis columns{"measured", {}};
    std::set<std::string> labels;
    for (const Series& series : declared(all, experiment.outputs)) {
        if (axes.contains(series.metric)) continue;  // its axis says it
        const bool isTime = config::isTimeMetric(series.metric);
        const bool isConstant = series.least == series.most && !isTime && measured.size() > 1 &&
                                series.cases.size() == measured.size();
        if (isConstant) {
            result.constants.push_back(quantityOf(series.label(), experiment.labels, series.unit)
                                           .with(series.shown(series.most)));
            continue;
        }
        config::Selection selection;
        selection.metric = series.metric;
        selection.pass = series.pass;
        selection.format = formatOf(series);
        if (series.isOfMebibytes()) selection.scale = 1.0 / kMebibyte;
        std::string label = series.label();
        if (!labels.insert(label).second) {  // a pass on both clocks
            label = series.metric + '_' + series.pass;
            labels.insert(label);
        }
        columns.labels.emplace_back(label, std::move(selection));
    }
    result.layout.isGiven = !columns.labels.empty();
    result.layout.columns.push_back(std::move(columns));
    return result;
}

/// What the technique declares of each metric, beside the table's columns.
void describeColumns(const config::Experiment& experiment, const config::Layout& layout,
                     Table& table) {
    for (TableColumn& column : table.columns) {
        for (const auto& [label, selection] : layout.columns.front().labels) {
            const config::MetricInfo* info =
                label == column.label ? experiment.outputs.find(*selection.metric) : nullptr;
            if (!info) continue;
            column.doc = info->doc;
            column.better = info->better;
        }
    }
}

}  // namespace

std::vector<config::PlotSpec> defaultPlots(const Table& table) {
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < table.rowAxes.size(); ++i) axes.push_back(axisOf(table, i));
    const auto x =
        std::ranges::max_element(axes, {}, [](const Axis& axis) { return axis.numbers.size(); });
    if (x == axes.end() || x->numbers.size() < 2) return {};
    config::PlotSpec plot;
    plot.x = table.rowAxes[x->index];
    plot.isLogX = isWide(x->numbers.front(), x->numbers.back(), 4.0);
    for (const Axis& axis : axes) {
        if (axis.index == x->index) continue;
        if (!plot.by && axis.count > 1) {
            plot.by = table.rowAxes[axis.index];
        } else {
            plot.panels.push_back(table.rowAxes[axis.index]);
        }
    }
    constexpr std::size_t kMostCurves = 6;
    std::vector<std::string> times, others;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const TableColumn& column = table.columns[i];
        if (measuredCount(table, i) < 2) continue;
        const bool isTime = table.rows.front().cells[i].isTime && column.label.ends_with("_ms");
        const std::size_t most = plot.by ? 1 : kMostCurves;
        if (isTime && times.size() < most) times.push_back(column.label);
        if (!table.rows.front().cells[i].isTime && column.better != config::Better::Neither &&
            others.empty()) {
            others.push_back(column.label);
        }
    }
    std::vector<config::PlotSpec> plots;
    for (const std::vector<std::string>& columns : {times, others}) {
        if (columns.empty()) continue;
        const auto first = std::ranges::find(table.columns, columns[0], &TableColumn::label);
        plot.y = columns;
        plot.isLogY = isWide(table, columns);
        plot.title = fmt::format(
            "{} over {}",
            columns.size() > 1 ? "Times" : quantityOf(columns[0], table.words, first->unit).text(),
            quantityOf(plot.x, table.words).words);
        if (const auto better = config::betterText(first->better); !better.empty()) {
            plot.title += fmt::format(" ({})", better);
        }
        plots.push_back(plot);
    }
    return plots;
}

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
    std::vector<std::string> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const bool isOfOne = std::ranges::any_of(
            table.rows, [&](const TableRow& row) { return row.cells[i].isOfOneSeed(); });
        if (isOfOne) columns.push_back(quantityOf(table.columns[i], table.words).words);
    }
    if (columns.empty()) return "";
    return fmt::format(
        "One seed, and another would give other numbers: {}. How far apart they are `measure: "
        "{{seeds: process, processes: 6}}` tells.",
        joined(columns));
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
    table.goesByClock = config::goesByClock(experiment);
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
    if (std::string note = seedNote(table); !note.empty()) table.notes.push_back(std::move(note));
    layPrintedBeside(experiment, table);
    blankWhatOthersHave(table);
    for (std::string& note : fitNotes(fitOf(experiment, table), table)) {
        table.notes.push_back(std::move(note));
    }
    return table;
}

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
        column.doc = "CPU time of all threads of the process, by which claims are judged";
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
                               const std::vector<records::Record>& records) {
    std::vector<Table> tables;
    for (const config::Experiment& experiment : experiments) {
        tables.push_back(buildTable(experiment, planned, records));
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
