#include "runner/regression/history_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "engine/core/files.h"
#include "engine/metrics/statistics.h"
#include "runner/report/curves.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/report/svg.h"

namespace gfxrepro::regression {

using report::escapeXml;

namespace {

using NightOf = MachineHistory::NightOf;

/// The nights of a machine by time and commit, in order, with their place.
using Places = std::map<std::pair<std::string, std::string>, std::size_t>;

void findSeriesChanges(SeriesHistory& series, double significance) {
    const auto add = [&](std::size_t at, double ratio, double chance) {
        series.changes.push_back({series.nights[at], series.nights[at - 1], ratio, chance});
    };
    if (series.key.isTime()) {
        for (const Step& step :
             findAllSteps(series.values, significance, StepRules{}.effectFloor)) {
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

/// Titles, with the parameters where several series have one.
std::vector<std::string> machineTitles(const MachineHistory& history) {
    std::map<std::string, int> counts;
    for (const SeriesHistory& series : history.series) ++counts[series.key.title()];
    std::vector<std::string> titles;
    for (const SeriesHistory& series : history.series) {
        titles.push_back(series.key.title());
        if (counts[titles.back()] > 1) titles.back() += " " + series.key.params;
    }
    return titles;
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
        "<div class=\"scroll\"><table><thead><tr><th>since</th><th></th><th>series</th><th "
        "class=\"num\">after / before</th><th>last commit before</th><th>first commit after</th>"
        "<th class=\"num\">chance</th></tr></thead>\n<tbody>\n";
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
        const std::span<const double> values = std::span(series.values).subspan(begin, end - begin);
        const double median = metrics::summarize(values, metrics::Statistic::Median);
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
        "<table><thead><tr><th>night</th><th>commit</th></tr></thead>\n<tbody>\n";
    for (const NightOf& night : history.nights) {
        html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escapeXml(night.time),
                            escapeXml(night.commit));
    }
    return html + "</tbody></table></div></details>\n";
}

std::string machineHtml(const MachineHistory& history, std::size_t machine) {
    const std::vector<std::string> titles = machineTitles(history);
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
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>gfxrepro: {0}</title>\n<style>\n{1}</style>\n"
        "</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
        "<p>One point a night: the median over the processes of that night; its commit is the "
        "point's title. A line is the median of a level. A time has a step where the levels before "
        "and after differ by 5 % or more and the exact chance of so clear a difference, were there "
        "none, is within what the nightly may take: one false alarm in twenty years over all "
        "series "
        "of the machine. Other values are marked where they are another than the night before.</p>"
        "\n",
        escapeXml(title), report::kStyle);
    for (std::size_t i = 0; i < histories.size(); ++i) html += machineHtml(histories[i], i);
    writeFileAtomic(file, html + "</main>\n</body>\n</html>\n");
}

}  // namespace gfxrepro::regression
