#include "runner/tables/default_layout.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "engine/core/checks.h"
#include "engine/core/text.h"
#include "engine/metrics/alike.h"
#include "engine/metrics/statistics.h"
#include "runner/records/csv.h"
#include "runner/tables/case_records.h"
#include "runner/tables/frame_times.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

namespace {

/// What the place of another row, "[AXIS=VALUE, …]", is read by.
bool hasMarks(const std::string& value) {
    return value.find_first_of("[],='\"") != value.npos;
}

bool isSwitch(const std::string& value) {
    return value == "true" || value == "false";
}

/// The first such axis of the cases; one that is on and off where there is none of words.
Rivals rivalsOf(const std::vector<const config::Case*>& cases) {
    std::vector<Rivals> axes;
    for (const config::Case* item : cases) {
        for (const auto& [name, value] : item->axes.entries()) {
            const auto found = std::ranges::find(axes, name, &Rivals::axis);
            Rivals& axis = found != axes.end() ? *found : axes.emplace_back(Rivals{name, {}});
            const std::string text = canonicalText(value);
            if (std::ranges::find(axis.values, text) == axis.values.end()) {
                axis.values.push_back(text);
            }
        }
    }
    const auto isWord = [](const std::string& value) {
        return !value.empty() && !parseDouble(value) && !isSwitch(value) && value != kLeftOut &&
               !hasMarks(value);
    };
    for (const bool isOfWords : {true, false}) {
        for (Rivals& axis : axes) {
            const bool isSuch = isOfWords ? std::ranges::all_of(axis.values, isWord)
                                          : std::ranges::all_of(axis.values, isSwitch);
            if (axis.axis != "scene" && axis.values.size() > 1 && isSuch) return axis;
        }
    }
    return {};
}

/// As the table has it; what is on or off by its axis: "denoised true".
std::string rivalName(const Rivals& rivals, std::size_t which, const Words& words) {
    const std::string& value = rivals.values[which];
    return isSwitch(value) ? shownValue(rivals.axis, value, words) : value;
}

/// Where the first rival stands: what goes together with its axis is what it has of it.
std::string placeOfFirst(const Rivals& rivals, const config::Experiment& experiment,
                         const std::vector<const config::Case*>& cases) {
    std::string at = rivals.axis + "=" + rivals.values[0];
    for (const std::string& axis : config::axesBeside(experiment.sweep, rivals.axis)) {
        std::set<std::string> values;
        for (const config::Case* item : cases) {
            const Node* own = item->axes.find(rivals.axis);
            const Node* beside = item->axes.find(axis);
            const bool isFirst = own && canonicalText(*own) == rivals.values[0];
            if (isFirst && beside) values.insert(canonicalText(*beside));
        }
        const bool isOne = values.size() == 1 && !hasMarks(*values.begin());
        if (isOne) at += fmt::format(", {}={}", axis, *values.begin());
    }
    return at;
}

/// Of that column the one that divides it by its value for the first rival.
std::pair<std::string, config::Selection> columnAgainst(const Rivals& rivals,
                                                        const std::string& column,
                                                        const std::string& first,
                                                        const config::Experiment& experiment) {
    config::Selection selection;
    selection.of = fmt::format("{0} / {0}[{1}]", column, first);
    selection.format = "{median:.3g}";
    return {fmt::format("{} ÷ {}", quantityOf(column, experiment.labels).words,
                        rivalName(rivals, 0, experiment.labels)),
            std::move(selection)};
}

/// The rows in which a rival is less, or more, than the first, and by how much.
struct RivalCount {
    std::size_t rows = 0;
    double least = std::numeric_limits<double>::infinity(), most = 0.0;

    void add(double ratio) {
        ++rows;
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    /// "0.85 times", "0.85 to 0.91 times".
    std::string times() const {
        const std::string from = fmt::format("{:.3g}", least), to = fmt::format("{:.3g}", most);
        return from == to ? from + " times" : from + " to " + to + " times";
    }
};

struct RivalTally {
    RivalCount less, more;
    std::size_t open = 0;

    std::size_t rows() const { return less.rows + more.rows + open; }
};

/// The cells of a column that divides by the first rival, and how they are told from 1.
struct RivalCells {
    std::size_t axis, column;
    Clock clock;
    double noise;  // of the times that are divided; 0 of what are none
    /// Of each row the chance that one of all came out as far from 1; 0 of what does not scatter.
    std::map<std::size_t, double> chances = {};

    const Measured* ratioOf(const Cell& cell) const {
        const Measured* ratio = cell.isOk() ? cell.find("", clock) : nullptr;
        return ratio && ratio->value > 0.0 ? ratio : nullptr;
    }
    /// Of numbers that another measurement would not change.
    static bool isKnown(const Cell& cell) {
        return cell.isOk() && !cell.isTime && cell.seedCount == 0 && !cell.scatters &&
               cell.onceAlong.empty() && cell.bounds() == Bounds::None &&
               !cell.values[0].isOverProcesses;
    }
    bool isTold(std::size_t row, const Cell& cell, const Measured& ratio) const {
        constexpr double kBothEnds = 0.05;
        if (isKnown(cell)) return !metrics::areAlike(ratio.value, 1.0);
        const bool isSure = ratio.bounds == Bounds::Interval &&
                            (ratio.interval.high < 1.0 || ratio.interval.low > 1.0) &&
                            !metrics::areAlike(ratio.interval.high, 1.0) &&
                            !metrics::areAlike(ratio.interval.low, 1.0);
        const auto chance = chances.find(row);
        return isSure && std::abs(std::log(ratio.value)) > noise &&
               (chance == chances.end() || chance->second <= kBothEnds);
    }
};

/// Looks at all rows and rivals together: of many some are apart by chance.
void findChances(const Table& table, const std::string& first, RivalCells& cells) {
    std::vector<std::size_t> rows;
    std::vector<std::map<int, double>> series;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const Measured* ratio = cells.ratioOf(table.rows[row].cells[cells.column]);
        const bool isOther = table.rows[row].labels[cells.axis] != first;
        if (!isOther || !ratio || ratio->areDraws || ratio->bounds != Bounds::Interval) continue;
        std::map<int, double> logs;
        bool isCertain = true, isPositive = true;
        for (const auto& [round, value] : ratio->rounds) {
            isCertain &= value == ratio->value;
            isPositive &= value > 0.0;
            logs[round] = std::log(value);
        }
        if (isCertain || !isPositive) continue;
        rows.push_back(row);
        series.push_back(std::move(logs));
    }
    if (series.size() < 2) return;
    const std::vector<double> chances = metrics::jointChances(series, true);
    for (std::size_t i = 0; i < rows.size(); ++i) cells.chances[rows[i]] = chances[i];
}

/// Marks the cells that are not apart.
RivalTally rivalTallyOf(Table& table, const RivalCells& cells, const std::string& rival) {
    RivalTally tally;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        TableRow& row = table.rows[i];
        const Measured* ratio = cells.ratioOf(row.cells[cells.column]);
        if (row.labels[cells.axis] != rival || !ratio) continue;
        const bool isTold = cells.isTold(i, row.cells[cells.column], *ratio);
        row.cells[cells.column].isWithinNoise = !isTold;
        if (!isTold) {
            ++tally.open;
        } else {
            (ratio->value < 1.0 ? tally.less : tally.more).add(ratio->value);
        }
    }
    return tally;
}

/// What less and more of the metric is called, and what of a rival is divided.
struct RivalWords {
    const char *less, *more, *what;

    static RivalWords of(const std::string& metric, Clock clock) {
        if (config::isTimeMetric(metric)) {
            return {"faster", "slower", clock == Clock::Process ? "CPU time" : "time"};
        }
        if (config::isPictureError(metric)) {
            return {"nearer to its truth", "farther from its truth", "error"};
        }
        return {"lower", "higher", "value"};
    }
};

/// "fast is faster than plain in 2 of 3 rows (0.85 to 0.91 times its time)".
std::string rivalSentence(const RivalTally& tally, const std::string& rival,
                          const std::string& first, const RivalWords& words) {
    std::vector<std::string> parts;
    const auto part = [&](std::size_t rows, const std::string& what, const std::string& times) {
        if (rows == 0) return;
        const std::string where = tally.rows() == 1 ? "the one row"
                                  : rows == tally.rows()
                                      ? (rows == 2 ? "both rows" : fmt::format("all {} rows", rows))
                                      : fmt::format("{} of {} rows", rows, tally.rows());
        parts.push_back(fmt::format("{} in {}{}", what, where, times));
    };
    const auto compared = [&](const RivalCount& count, const char* what) {
        part(count.rows, fmt::format("{} is {} than {}", rival, what, first),
             fmt::format(" ({} its {})", count.times(), words.what));
    };
    compared(tally.less, words.less);
    compared(tally.more, words.more);
    if (tally.open > 1 && tally.open == tally.rows()) {
        return fmt::format("{} and {} cannot be told apart in any of {} rows", rival, first,
                           tally.open);
    }
    part(tally.open, fmt::format("{} and {} cannot be told apart", rival, first), "");
    return joined(parts, "; ");
}

}  // namespace

void compareRivals(const Rivals& rivals, const std::vector<std::string>& columns, Table& table) {
    std::vector<std::string> told, open;
    const auto axis = std::ranges::find(table.rowAxes, rivals.axis);
    for (const std::string& label : columns) {
        const auto column = table.findColumn(label);
        if (!column || axis == table.rowAxes.end()) continue;
        std::string metric;
        bool canBeTold = false, hasProcessTimes = !table.goesByClock;
        for (const TableRow& row : table.rows) {
            const Cell& cell = row.cells[*column];
            hasProcessTimes &= cell.values.empty() || !cell.byProcess.empty();
            if (cell.bounds() != Bounds::Interval && !RivalCells::isKnown(cell)) continue;
            canBeTold = true;
            metric = row.cells[*column - 1].metric;  // of the column beside which it stands
        }
        if (!canBeTold) continue;
        const std::string& divided = table.columns[*column - 1].label;
        const Clock clock = hasProcessTimes ? Clock::Process : Clock::Wall;
        const bool isTime = config::isTimeMetric(metric);
        RivalCells cells{static_cast<std::size_t>(axis - table.rowAxes.begin()), *column, clock,
                         isTime ? columnNoise(table, {divided}, clock).value_or(0.0) : 0.0};
        findChances(table, rivals.values[0], cells);
        const auto nameOf = [&](std::size_t i) {  // as in the row
            return shownName(rivalName(rivals, i, table.words), table.words);
        };
        if (hasProcessTimes)
            table.judgedByProcess.insert(table.judgedByProcess.end(), {divided, label});
        for (std::size_t i = 1; i < rivals.values.size(); ++i) {
            const RivalTally tally = rivalTallyOf(table, cells, rivals.values[i]);
            if (tally.rows() == 0) continue;
            (tally.open == tally.rows() ? open : told)
                .push_back(fmt::format(
                    "{}: {}.", label.substr(0, label.find(" ÷ ")),
                    rivalSentence(tally, nameOf(i), nameOf(0), RivalWords::of(metric, clock))));
        }
    }
    table.toldNotes = told.size();
    table.notes.insert(table.notes.begin(), open.begin(), open.end());
    table.notes.insert(table.notes.begin(), told.begin(), told.end());
}

namespace {

constexpr double kMebibyte = 1 << 20;

/// A step of a frame on either clock.
bool isPassTime(const std::string& metric) {
    return metric == "gpu_time_ms" || metric == "cpu_time_ms";
}

/// What was recorded of a metric and pass.
struct Series {
    std::string metric, pass, unit;
    std::size_t order = 0;  // in which it was recorded
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    bool isWhole = true;
    std::set<std::string> cases = {};
    bool isOfOnlyPicture = false;  // which its label need not say

    bool isOfMebibytes() const { return unit == "byte" && most >= kMebibyte; }
    std::string label() const {
        if (metric == "wall_time_ms") return "frame_ms";
        if (isPassTime(metric)) return pass + "_ms";
        std::string name = metric;
        if (isOfMebibytes() && name.ends_with("_bytes")) name.replace(name.size() - 5, 5, "mib");
        return pass.empty() || isOfOnlyPicture ? name : name + '_' + pass;
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
    std::set<std::string> pictures;  // that have errors
    for (const Series& series : all) {
        if (config::isPictureError(series.metric)) pictures.insert(series.pass);
    }
    for (Series& series : all) {
        series.isOfOnlyPicture = pictures.size() == 1 && series.pass == *pictures.begin() &&
                                 std::ranges::count(all, series.metric, &Series::metric) == 1;
    }
    return all;
}

/// A time that the runner takes beside those of frames, as an import may have it.
bool isByTheWay(const std::string& metric) {
    return metric == "process_time_ms" || metric == "setup_time_ms" || metric == "load_time_ms";
}

/// Without details: the times that a program says of itself, that of a frame, memory, errors of
/// pictures, what else is declared in its order, then the passes.
std::vector<Series> declared(std::vector<Series> all, const config::Experiment& experiment) {
    const config::Outputs& outputs = experiment.outputs;
    std::erase_if(all, [&](const Series& series) {
        if (series.metric == "scene_source") return true;  // a row's mark
        if (outputs.metrics.empty()) return false;
        const config::MetricInfo* info = outputs.find(series.metric);
        return !info || info->isDetail || info->name != series.metric;
    });
    enum Group { ItsOwnTime, FrameTime, Memory, PictureError, Other, Pass };
    const auto groupOf = [&](const Series& series) {
        if (series.metric == "wall_time_ms") return FrameTime;
        if (isPassTime(series.metric)) return Pass;
        const bool isItsOwn = config::goesByClock(experiment) && series.metric.ends_with("_ms") &&
                              !isByTheWay(series.metric);
        if (isItsOwn) return ItsOwnTime;
        if (series.unit == "byte") return Memory;
        return config::isPictureError(series.metric) ? PictureError : Other;
    };
    const auto rank = [&](const Series& series) {
        const auto at =
            std::ranges::find(outputs.metrics, series.metric, &config::MetricInfo::name);
        const Group group = groupOf(series);
        const bool isByTheRunner = group == FrameTime || group == Pass;
        return std::tuple(group, isByTheRunner ? outputs.metrics.begin() : at, series.order);
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
            "needs several (`output: {{frames: 20}}`).",
            quantityOf(info.name, experiment.labels).words));
    }
    return notes;
}

/// What is declared of the metric; errors that were taken elsewhere are known by their names.
const config::MetricInfo* infoOf(const std::string& metric, const config::Experiment& experiment) {
    if (const config::MetricInfo* info = experiment.outputs.find(metric)) return info;
    const auto errors = config::pictureErrors();
    const auto known = std::ranges::find(errors, metric, &config::MetricInfo::name);
    return known == errors.end() ? nullptr : &*known;
}

/// Whether a claim names the column.
bool isClaimed(const std::string& label, const config::Experiment& experiment) {
    const auto isIn = [&](const auto& text) { return text.find(label) != text.npos; };
    return std::ranges::any_of(experiment.claims, [&](const config::ClaimSpec& claim) {
        const auto isOfColumns = [&](const auto& chosen) {
            return chosen.first == config::kColumnAxis &&
                   matchesAny(Node::scalar(label, {}, true), Node::sequence(chosen.second));
        };
        return claim.over == label || std::ranges::any_of(claim.operands, isIn) ||
               std::ranges::any_of(claim.at, isOfColumns);
    });
}

}  // namespace

DefaultLayout defaultLayout(const config::Experiment& experiment,
                            std::span<const config::Case> planned,
                            const std::vector<records::Record>& records) {
    DefaultLayout result;
    std::set<std::string> axes;
    std::vector<const config::Case*> own;
    for (const config::Case& item : planned) {
        if (item.experiment != experiment.id) continue;
        own.push_back(&item);
        for (const auto& [axis, value] : item.axes.entries()) {
            if (axes.insert(axis).second) result.layout.rows.push_back({axis, {}});
        }
    }
    result.rivals = rivalsOf(own);
    const std::string first =
        result.rivals.isThere() ? placeOfFirst(result.rivals, experiment, own) : "";
    const std::vector<Series> all = seriesOf(experiment.id, records);
    result.notes = frameNotes(experiment, all);
    std::set<std::string> measured;
    for (const Series& series : all) measured.insert(series.cases.begin(), series.cases.end());
    config::LayoutAxis columns{"measured", {}};
    std::set<std::string> labels;
    bool hasError = false;
    // The time that leads, and the first error.
    const auto isRivals = [&](const Series& series, bool isFirst) {
        if (!result.rivals.isThere()) return false;
        if (isFirst && config::isTimeMetric(series.metric)) return true;
        const config::MetricInfo* info = infoOf(series.metric, experiment);
        const bool isError = info && info->better == config::Better::Lower && !hasError &&
                             !config::isTimeMetric(series.metric) && series.unit != "byte";
        hasError |= isError;
        return isError;
    };
    for (const Series& series : declared(all, experiment)) {
        if (axes.contains(series.metric)) continue;  // its axis says it
        const bool isTime = config::isTimeMetric(series.metric);
        const bool isConstant = series.least == series.most && !isTime && measured.size() > 1 &&
                                series.cases.size() == measured.size() &&
                                !isClaimed(series.label(), experiment);
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
        if (isRivals(series, columns.labels.size() == 1)) {
            columns.labels.push_back(columnAgainst(result.rivals, label, first, experiment));
            result.against.push_back(columns.labels.back().first);
        }
    }
    result.layout.isGiven = !columns.labels.empty();
    result.layout.columns.push_back(std::move(columns));
    return result;
}

void describeColumns(const config::Experiment& experiment, const config::Layout& layout,
                     Table& table) {
    for (TableColumn& column : table.columns) {
        for (const auto& [label, selection] : layout.columns.front().labels) {
            const config::MetricInfo* info = label == column.label && selection.metric
                                                 ? infoOf(*selection.metric, experiment)
                                                 : nullptr;
            if (!info) continue;
            column.doc = info->doc;
            column.better = info->better;
        }
    }
}

}  // namespace gfxrepro::tables
