#include <fmt/format.h>

#include <algorithm>

#include "runner/report/markup.h"
#include "runner/report/overlay.h"
#include "runner/tables/labels.h"

namespace gfxrepro::report {

using tables::Cell;
using tables::Table;
using tables::TableRow;

Overlay::Overlay(const Page& page) {
    std::set<std::vector<std::string>> seen;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        if (!page.parts[run].experiment) continue;
        const Table& table = page.parts[run].table;
        runs_.push_back(run);
        tables_.push_back(&table);
        for (const tables::TableColumn& column : table.columns) {
            const auto isSame = [&](const auto& known) { return known.label == column.label; };
            if (std::ranges::none_of(columns_, isSame)) columns_.push_back(column);
        }
        std::map<std::vector<std::string>, const TableRow*>& byLabels = rowOf_.emplace_back();
        for (const TableRow& row : table.rows) {
            byLabels.try_emplace(row.labels, &row);
            if (seen.insert(row.labels).second) rows_.push_back(row.labels);
            for (std::size_t c = 0; c < row.cells.size(); ++c) {
                if (row.cells[c].printed) printedColumns_.insert(table.columns[c].label);
            }
        }
    }
}

namespace {

/// Which way a column is better.
std::string directionHtml(config::Better better) {
    if (better == config::Better::Neither) return "";
    return fmt::format(" <span class=\"sub\" title=\"{}\">{}</span>", config::betterText(better),
                       better == config::Better::Lower ? "↓" : "↑");
}

/// A column's own head: its last part, with its unit and which way it is better.
struct Head {
    std::vector<std::string> above;  // the parts before it: heads of several columns
    std::string own;
};

Head headOf(const tables::TableColumn& column, const tables::Words& words) {
    Head head;
    head.above = column.parts;
    std::string name = column.label;
    if (!head.above.empty()) {
        name = head.above.back();
        head.above.pop_back();
    }
    const tables::Quantity quantity = tables::quantityOf(name, words, column.unit);
    head.own = escapeXml(quantity.words);
    if (!quantity.unit.empty()) {
        head.own += fmt::format(" <span class=\"sub\">[{}]</span>", escapeXml(quantity.unit));
    }
    head.own += directionHtml(column.better);
    return head;
}

/// A head over columns; all that it says of them on pointing at it.
std::string columnHeadHtml(const tables::TableColumn& column, const std::string& text,
                           std::size_t width, std::size_t height) {
    std::string title = column.label;
    if (!column.doc.empty()) title += ": " + column.doc;
    std::string html =
        fmt::format("<th class=\"{}\" scope=\"{}\" title=\"{}\"", width > 1 ? "group" : "num",
                    width > 1 ? "colgroup" : "col", escapeXml(title));
    if (width > 1) html += fmt::format(" colspan=\"{}\"", width);
    if (height > 1) html += fmt::format(" rowspan=\"{}\"", height);
    return html + ">" + text + "</th>";
}

/// The parts of column heads that several columns share, a line each.
std::string sharedHeadsHtml(const Overlay& overlay, const std::vector<Head>& heads,
                            std::size_t level) {
    const auto partsOf = [&](std::size_t i) {
        std::vector<std::string> parts = heads[i].above;
        parts.resize(level + 1);
        return parts;
    };
    std::string html;
    for (std::size_t first = 0; first < heads.size();) {
        const auto isUnder = [&](std::size_t i) { return partsOf(i) == partsOf(first); };
        std::size_t last = first, width = 0;
        while (last < heads.size() && isUnder(last)) {
            width += overlay.widthOf(overlay.columns()[last++].label);
        }
        html +=
            fmt::format("<th class=\"group\" scope=\"colgroup\" colspan=\"{}\">{}</th>", width,
                        escapeXml(tables::shownName(partsOf(first)[level], overlay.first().words)));
        first = last;
    }
    return html;
}

}  // namespace

std::string headHtml(const Overlay& overlay, bool isComparison) {
    const tables::Words& words = overlay.first().words;
    std::vector<Head> heads;
    std::size_t levels = 0;
    for (const tables::TableColumn& column : overlay.columns()) {
        heads.push_back(headOf(column, words));
        levels = std::max(levels, heads.back().above.size());
    }
    const auto isGroup = [&](const auto& column) { return overlay.widthOf(column.label) > 1; };
    const bool hasSources = std::ranges::any_of(overlay.columns(), isGroup);
    const std::size_t height = levels + 1 + (hasSources ? 1 : 0);
    std::string html = "<thead><tr>";
    bool isFirst = true;
    for (const std::string& axis : overlay.first().rowAxes) {
        html +=
            fmt::format("<th class=\"axis{}\" scope=\"col\" rowspan=\"{}\" title=\"{}\">{}</th>",
                        isFirst ? " first" : "", height, escapeXml(axis),
                        escapeXml(tables::shownName(axis, words)));
        isFirst = false;
    }
    for (std::size_t level = 0; level < levels; ++level) {
        html += sharedHeadsHtml(overlay, heads, level) + "</tr>\n<tr>";
    }
    std::string below;
    for (std::size_t i = 0; i < heads.size(); ++i) {
        const tables::TableColumn& column = overlay.columns()[i];
        const std::size_t width = overlay.widthOf(column.label);
        html += columnHeadHtml(column, heads[i].own, width, hasSources && width == 1 ? 2 : 1);
        if (!isGroup(column)) continue;
        if (overlay.hasPrinted(column.label)) below += "<th class=\"sub\">printed</th>";
        for (const std::size_t run : overlay.runs()) {
            below += fmt::format("<th class=\"sub\">{}</th>",
                                 isComparison ? Model::letter(run) : "measured");
        }
    }
    html += "</tr>";
    if (hasSources) html += fmt::format("\n<tr>{}</tr>", below);
    return html + "</thead>\n";
}

}  // namespace gfxrepro::report
