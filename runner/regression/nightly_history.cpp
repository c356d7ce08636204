#include "runner/regression/nightly_history.h"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "runner/records/csv.h"
#include "runner/report/curves.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/report/svg.h"

namespace gfxrepro::regression {

namespace {

constexpr std::string_view kHeader =
    "time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value\n";
constexpr std::size_t kColumns = 12;
constexpr std::size_t kFewestNights = 5;
constexpr std::size_t kMostNights = 100;

double numberFrom(const std::string& field, const SourceLocation& location) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) {
        throw Error(location, fmt::format("'{}' is no number", field));
    }
    return value;
}

struct Split {
    std::size_t first = 0;
    double score = 0.0;  // |rank sum − its mean| in standard deviations
};

Split clearestSplit(const std::vector<double>& ranks) {
    const auto count = static_cast<double>(ranks.size());
    Split best;
    double sum = 0.0;
    for (std::size_t first = 1; first + kFewestNights <= ranks.size(); ++first) {
        sum += ranks[first - 1];
        if (first < kFewestNights) continue;
        const auto below = static_cast<double>(first);
        const double mean = 0.5 * below * (count + 1.0);
        const double deviation = std::sqrt(below * (count - below) * (count + 1.0) / 12.0);
        const double score = std::abs(sum - mean) / deviation;
        if (score > best.score) best = {first, score};
    }
    return best;
}

}  // namespace

void appendNight(const std::filesystem::path& path, const Night& night) {
    std::string text = std::filesystem::exists(path) ? readFile(path) : std::string(kHeader);
    // A night that was torn by a crash is cut off.
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
    if (text.empty()) text = kHeader;
    for (const auto& [key, all] : night.series) {
        const Series values = key.isTime() ? standing(all) : all;
        if (values.empty()) continue;
        records::CsvRow row(text);
        row.text(night.time).text(night.commit).text(night.machine).text(key.table);
        row.text(key.technique).text(key.method).text(key.scene).text(key.params);
        row.text(key.pass).text(key.metric).text(key.unit).number(metrics::median(values));
        row.end();
    }
    writeFileAtomic(path, text);
}

std::vector<HistoryRow> readHistoryRows(const std::filesystem::path& path) {
    const std::string text = readFile(path);
    records::CsvReader reader(text, path.string());
    std::vector<std::string> fields;
    std::vector<HistoryRow> rows;
    if (!text.empty() && !text.starts_with(kHeader)) {
        throw Error({path.string(), 1, 0}, fmt::format("is no history; expected the header '{}'",
                                                       kHeader.substr(0, kHeader.size() - 1)));
    }
    for (bool isHeader = true; reader.next(fields); isHeader = false) {
        if (isHeader) continue;
        if (fields.size() != kColumns) {
            throw Error(reader.location(),
                        fmt::format("{} columns; a history has {}", fields.size(), kColumns));
        }
        const double value = numberFrom(fields[11], reader.location());
        rows.push_back({fields[0], fields[1], fields[2],
                        SeriesKey{fields[3], fields[4], fields[5], fields[6], fields[7], fields[8],
                                  fields[9], fields[10]},
                        value});
    }
    return rows;
}

SeriesMap readHistory(const std::filesystem::path& path, const std::string& machine) {
    SeriesMap history;
    if (!std::filesystem::exists(path)) return history;
    for (const HistoryRow& row : readHistoryRows(path)) {
        if (row.machine == machine) history[row.key].push_back(row.value);
    }
    return history;
}

std::optional<Step> findStep(const Series& nights, double significance, double effectFloor) {
    if (nights.size() < 2 * kFewestNights) return std::nullopt;
    const std::size_t skipped = nights.size() - std::min(nights.size(), kMostNights);
    const std::span<const double> all = std::span(nights).subspan(skipped);
    const Split best = clearestSplit(ranksOf(all));
    if (best.first == 0) return std::nullopt;
    const std::span<const double> first = all.first(best.first), rest = all.subspan(best.first);
    const double before = metrics::median(first), after = metrics::median(rest);
    if (before <= 0.0 || after <= 0.0) return std::nullopt;
    if (std::abs(std::log(after / before)) < std::log1p(effectFloor)) return std::nullopt;
    const auto splits = static_cast<double>(all.size() - 2 * kFewestNights + 1);
    const double chance = std::min(1.0, splits * rankSumChance(first, rest));
    if (chance > significance) return std::nullopt;
    return Step{skipped + best.first, after / before, chance};
}

namespace {

/// The first nights of new levels within [first, last), appended to `steps`.
void collectSteps(const Series& nights, std::size_t first, std::size_t last, double significance,
                  double effectFloor, std::vector<Step>& steps) {
    const auto at = [&](std::size_t index) {
        return nights.begin() + static_cast<std::ptrdiff_t>(index);
    };
    std::size_t end = last;
    for (; end >= first + 2 * kFewestNights; end -= std::min(end, kMostNights / 2)) {
        if (auto step = findStep(Series(at(first), at(end)), significance, effectFloor)) {
            step->first += first;
            const std::size_t place = step->first;
            collectSteps(nights, first, place, significance, effectFloor, steps);
            steps.push_back(*step);
            collectSteps(nights, place, last, significance, effectFloor, steps);
            return;
        }
        if (end - first <= kMostNights) return;  // all were looked at
    }
}

}  // namespace

std::vector<Step> findAllSteps(const Series& nights, double significance, double effectFloor) {
    std::vector<Step> steps;
    collectSteps(nights, 0, nights.size(), significance, effectFloor, steps);
    const std::span<const double> all(nights);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::size_t begin = i == 0 ? 0 : steps[i - 1].first;
        const std::size_t end = i + 1 == steps.size() ? nights.size() : steps[i + 1].first;
        const std::size_t first = steps[i].first;
        steps[i].ratio = metrics::median(all.subspan(first, end - first)) /
                         metrics::median(all.subspan(begin, first - begin));
    }
    return steps;
}

double significanceOf(std::size_t timeSeries) {
    return kStepRules.familyError / (static_cast<double>(timeSeries) * kStepRules.nightsAYear);
}

std::vector<std::size_t> findChanges(const Series& nights) {
    constexpr double kTolerance = 1e-4;
    std::vector<std::size_t> changes;
    for (std::size_t i = 1; i < nights.size(); ++i) {
        const double before = nights[i - 1], after = nights[i];
        const bool isWhole = before == std::round(before) && after == std::round(after);
        const double most =
            isWhole ? 0.0 : kTolerance * std::max(std::abs(before), std::abs(after));
        const bool isSame = std::isfinite(most) && std::abs(after - before) <= most;
        if (before != after && !isSame) changes.push_back(i);
    }
    return changes;
}

std::vector<SeriesStep> findSteps(const SeriesMap& history) {
    const auto count =
        std::ranges::count_if(history, [](const auto& entry) { return entry.first.isTime(); });
    const double significance = significanceOf(static_cast<std::size_t>(count));
    std::vector<SeriesStep> steps;
    for (const auto& [key, nights] : history) {
        if (!key.isTime()) continue;
        if (const auto step = findStep(nights, significance, kStepRules.effectFloor)) {
            steps.push_back({key, nights.size(), *step});
        }
    }
    return steps;
}

// The page.

using report::escapeXml;

namespace {

using NightOf = MachineHistory::NightOf;

constexpr std::string_view kExplanation =
    "One point a night: the median over the processes of that night; its commit is the point's "
    "title. A dashed line is the median of a level. A time has a step where the levels before and "
    "after differ by 5 % or more and the exact chance of so clear a difference, were there none, "
    "is within what the nightly may take: one false alarm in twenty years over all series of the "
    "machine. Other values are marked where they are another than the night before.";

/// The nights of a machine by time and commit, in order, with their place.
using Places = std::map<std::pair<std::string, std::string>, std::size_t>;

void findSeriesChanges(SeriesHistory& series, double significance) {
    const auto add = [&](std::size_t at, double ratio, double chance) {
        series.changes.push_back({series.nights[at], series.nights[at - 1], ratio, chance});
    };
    if (series.key.isTime()) {
        for (const Step& step : findAllSteps(series.values, significance, kStepRules.effectFloor)) {
            add(step.first, step.ratio, step.chance);
        }
        return;
    }
    for (const std::size_t at : findChanges(series.values)) {
        add(at, series.values[at] / series.values[at - 1], 0.0);
    }
}

MachineHistory historyOf(const std::string& machine, std::span<const HistoryRow* const> rows) {
    MachineHistory history;
    history.machine = machine;
    Places places;
    for (const HistoryRow* row : rows) places[{row->time, row->commit}] = 0;
    for (auto& [night, place] : places) {
        place = history.nights.size();
        history.nights.push_back({night.first, night.second});
    }
    std::map<SeriesKey, std::map<std::size_t, double>> values;
    std::size_t timeCount = 0;
    for (const HistoryRow* row : rows) {
        auto& own = values[row->key];
        if (own.empty() && row->key.isTime()) ++timeCount;
        own[places.at({row->time, row->commit})] = row->value;
    }
    for (const auto& [key, own] : values) {
        SeriesHistory series{key, {}, {}, {}};
        for (const auto& [night, value] : own) {
            series.nights.push_back(night);
            series.values.push_back(value);
        }
        findSeriesChanges(series, significanceOf(timeCount));
        history.series.push_back(std::move(series));
    }
    return history;
}

std::string dayOf(const std::string& time) {
    return time.substr(0, 10);
}

/// The place of one of its nights among those that have a value.
std::size_t placeOf(std::size_t night, const SeriesHistory& series) {
    return static_cast<std::size_t>(std::ranges::find(series.nights, night) -
                                    series.nights.begin());
}

std::string changeText(const SeriesHistory& series, const SeriesChange& change) {
    if (series.key.isTime()) return fmt::format("× {:.3f}", change.ratio);
    return fmt::format("{:.6g} → {:.6g}", series.values[placeOf(change.before, series)],
                       series.values[placeOf(change.night, series)]);
}

bool isWorse(const SeriesHistory& series, const SeriesChange& change) {
    return !series.key.isTime() || change.ratio > 1.0;
}

std::string wordOf(const SeriesHistory& series, const SeriesChange& change) {
    if (!series.key.isTime()) return "changed";
    return change.ratio > 1.0 ? "slower" : "faster";
}

std::string anchorOf(std::size_t machine, std::size_t series) {
    return fmt::format("series-{}-{}", machine, series);
}

std::string changesHtml(const MachineHistory& history, std::size_t machine,
                        const std::vector<std::string>& titles) {
    std::map<std::size_t, std::string, std::greater<>> rows;  // the newest first
    for (std::size_t i = 0; i < history.series.size(); ++i) {
        const SeriesHistory& series = history.series[i];
        for (const SeriesChange& change : series.changes) {
            const NightOf& after = history.nights[change.night];
            rows[change.night] += fmt::format(
                "<tr><th scope=\"row\">{}</th><td><span class=\"badge {}\">{}</span></td><td><a "
                "href=\"#{}\">{}</a></td><td class=\"num\">{}</td><td>{}</td><td>{}</td><td "
                "class=\"num\">{}</td></tr>\n",
                escapeXml(after.time), isWorse(series, change) ? "fails" : "holds",
                wordOf(series, change), anchorOf(machine, i), escapeXml(titles[i]),
                escapeXml(changeText(series, change)),
                escapeXml(history.nights[change.before].commit), escapeXml(after.commit),
                series.key.isTime() ? fmt::format("{:.1g}", change.chance) : "");
        }
    }
    if (rows.empty()) return "<p>No series changed.</p>\n";
    std::string html =
        "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">since</th><td></td><th "
        "scope=\"col\">series</th><th scope=\"col\" "
        "class=\"num\">after / before</th><th scope=\"col\">last commit before</th><th "
        "scope=\"col\">first commit after</th>"
        "<th scope=\"col\" class=\"num\">chance</th></tr></thead>\n<tbody>\n";
    for (const auto& [night, text] : rows) html += text;
    return html + "</tbody></table></div>\n";
}

tables::FigurePoint pointAt(std::size_t night, std::optional<double> value,
                            std::string remark = "") {
    tables::FigurePoint point;
    point.x = static_cast<double>(night);
    point.y = value;
    point.remark = std::move(remark);
    return point;
}

/// A point a night, and the median of each level between changes as a line.
tables::FigureCurve curveOf(const MachineHistory& history, const SeriesHistory& series) {
    tables::FigureCurve curve{series.key.title(), {}, {}};
    for (std::size_t night = 0; night < history.nights.size(); ++night) {
        curve.points.push_back(pointAt(night, std::nullopt));
    }
    for (std::size_t i = 0; i < series.nights.size(); ++i) {
        const NightOf& night = history.nights[series.nights[i]];
        curve.points[series.nights[i]] =
            pointAt(series.nights[i], series.values[i],
                    fmt::format("{}, {}: {:.6g} {}", night.time, night.commit, series.values[i],
                                series.key.unit));
    }
    if (!series.key.isTime()) return curve;
    for (std::size_t level = 0, begin = 0; level <= series.changes.size(); ++level) {
        const bool isLast = level == series.changes.size();
        const std::size_t end =
            isLast ? series.nights.size() : placeOf(series.changes[level].night, series);
        const double median = metrics::median(std::span(series.values).subspan(begin, end - begin));
        curve.reference.push_back(pointAt(series.nights[begin], median));
        curve.reference.push_back(pointAt(series.nights[end - 1], median));
        curve.reference.push_back(pointAt(series.nights[end - 1], std::nullopt));
        begin = end;
    }
    return curve;
}

std::string curveHtml(const MachineHistory& history, const SeriesHistory& series,
                      const std::string& title, const std::string& anchor) {
    tables::Figure figure;
    for (const NightOf& night : history.nights) figure.xNames.push_back(dayOf(night.time));
    figure.curveNames = {title};
    figure.panels = {{"", series.key.unit, {curveOf(history, series)}}};
    for (const SeriesChange& change : series.changes) {
        figure.panels[0].marks.push_back({static_cast<double>(change.night) - 0.5,
                                          series.key.isTime() ? changeText(series, change) : "",
                                          isWorse(series, change)});
    }
    return fmt::format(
        "<figure class=\"curve\" id=\"{}\">\n{}{}<figcaption>{}</figcaption></figure>\n", anchor,
        report::figureSvg(figure, title, report::kWidePx),
        report::figureSvg(figure, title, report::kNarrowPx), escapeXml(title));
}

std::string nightsHtml(const MachineHistory& history) {
    std::string html =
        "<details class=\"cases\"><summary>Nights and commits</summary>\n<div class=\"scroll\">"
        "<table><thead><tr><th scope=\"col\">night</th><th scope=\"col\">commit</th></tr></thead>\n"
        "<tbody>\n";
    for (const NightOf& night : history.nights) {
        html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escapeXml(night.time),
                            escapeXml(night.commit));
    }
    return html + "</tbody></table></div></details>\n";
}

std::string machineHtml(const MachineHistory& history, std::size_t machine) {
    const std::vector<std::string> titles = titlesOf(keysOf(history.series));
    std::size_t unchanged = 0;
    std::string curves, table;
    for (std::size_t i = 0; i < history.series.size(); ++i) {
        const SeriesHistory& series = history.series[i];
        if (!series.key.isTime() && series.changes.empty()) {
            ++unchanged;
            continue;
        }
        if (table != series.key.table) {
            if (!table.empty()) curves += "</div>\n";
            curves +=
                fmt::format("<h3>{}</h3>\n<div class=\"curves\">\n", escapeXml(series.key.table));
            table = series.key.table;
        }
        curves += curveHtml(history, series, titles[i], anchorOf(machine, i));
    }
    if (!table.empty()) curves += "</div>\n";
    std::string html = fmt::format(
        "<section class=\"page\">\n<h2>{}</h2>\n<p class=\"soft\">{} {}, {} to {}; {} series.</p>\n"
        "<h3>Changes</h3>\n{}",
        escapeXml(history.machine), history.nights.size(),
        history.nights.size() == 1 ? "night" : "nights", dayOf(history.nights.front().time),
        dayOf(history.nights.back().time), history.series.size(),
        changesHtml(history, machine, titles));
    html += curves;
    if (unchanged > 0) {
        html += fmt::format("<p class=\"soft\">{} that {} no {} never changed.</p>\n",
                            unchanged == 1 ? "One series" : fmt::format("{} series", unchanged),
                            unchanged == 1 ? "is" : "are", unchanged == 1 ? "time" : "times");
    }
    return html + nightsHtml(history) + "</section>\n";
}

}  // namespace

std::vector<MachineHistory> historiesOf(std::span<const HistoryRow> rows) {
    std::map<std::string, std::vector<const HistoryRow*>> machines;
    for (const HistoryRow& row : rows) machines[row.machine].push_back(&row);
    std::vector<MachineHistory> histories;
    for (const auto& [machine, own] : machines) histories.push_back(historyOf(machine, own));
    return histories;
}

void writeHistoryPage(const std::filesystem::path& file, const std::string& title,
                      std::span<const MachineHistory> histories) {
    std::string html = report::headOfFile(title) + fmt::format("<main>\n<h1>{}</h1>\n<p>{}</p>\n",
                                                               escapeXml(title), kExplanation);
    for (std::size_t i = 0; i < histories.size(); ++i) html += machineHtml(histories[i], i);
    writeFileAtomic(file, html + "</main>\n</body>\n</html>\n");
}

}  // namespace gfxrepro::regression
