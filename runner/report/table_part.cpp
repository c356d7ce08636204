#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "runner/report/markup.h"
#include "runner/report/overlay.h"
#include "runner/report/parts.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

using tables::Cell;
using tables::Table;
using tables::TableRow;

namespace {

/// "×1.2" of the printed number, where both are of the same parameters, all of them given, and
/// nothing was fitted to it; a rate of what was, not a comparison of machines.
std::string ratioHtml(const Cell& cell) {
    if (!cell.isAtPrintedParameters || !cell.openParameters.empty() || cell.isCalibrated) return "";
    if (cell.values.empty() || cell.printedValues.empty() || !cell.printedValues[0]) return "";
    const double printed = *cell.printedValues[0];
    if (std::isinf(cell.values[0].value)) return "";
    if (printed == 0.0) return "";
    return fmt::format("<span class=\"ratio\" title=\"measured ÷ printed\">×{:.3g}</span>",
                       cell.values[0].value / printed);
}

/// What pointing at a cell tells: why it has no value, or why it is no multiple of what is printed.
std::string titleOf(const Cell& cell) {
    if (!cell.message.empty()) return cell.message;
    if (!cell.departures.empty()) return "at " + tables::departuresText(cell.departures);
    return cell.openParameters.empty() ? "" : "not given: " + tables::openText(cell.openParameters);
}

std::string cellHtml(const Cell* cell, std::size_t run) {
    if (!cell || !cell->isPlanned) return "<td></td>";
    std::string anchors;
    for (const std::string& id : cell->caseIds) anchors += caseAnchor(run, id) + ' ';
    if (!anchors.empty()) anchors.pop_back();
    std::string attributes =
        anchors.empty() ? "" : fmt::format(" data-cases=\"{}\"", escapeXml(anchors));
    if (const std::string title = titleOf(*cell); !title.empty()) {
        attributes += fmt::format(" title=\"{}\"", escapeXml(title));
    }
    if (!cell->isOk()) {
        return fmt::format("<td class=\"num\"{}><span class=\"status\">{}</span></td>", attributes,
                           escapeXml(cell->measured));
    }
    std::string html = fmt::format("<td class=\"num\"{}>{}", attributes, escapeXml(cell->measured));
    if (cell->isCalibrated) {
        html += fmt::format(" <abbr title=\"calibrated\">{}</abbr>", tables::kCalibratedMark);
    }
    if (cell->movedClock) {
        html += fmt::format(" <abbr title=\"{}\">{}</abbr>",
                            escapeXml(tables::movedClockLegend(*cell->movedClock)),
                            tables::kMovedClockMark);
    }
    std::string below;
    if (cell->hasShownBounds()) {
        const bool isInterval = cell->bounds() == tables::Bounds::Interval;
        below = fmt::format("<span title=\"{}\">{}{}{}</span>", tables::boundsName(cell->bounds()),
                            escapeXml(cell->low), isInterval ? "–" : " … ", escapeXml(cell->high));
    }
    if (const std::string ratio = ratioHtml(*cell); !ratio.empty()) {
        below += (below.empty() ? "" : " ") + ratio;
    }
    if (!below.empty()) html += fmt::format("<span class=\"interval\">{}</span>", below);
    return html + "</td>";
}

bool isStandIn(const Overlay& overlay, const std::vector<std::string>& labels) {
    for (std::size_t i = 0; i < overlay.runs().size(); ++i) {
        const TableRow* row = overlay.find(i, labels);
        if (row && row->source == tables::SceneSource::StandIn) return true;
    }
    return false;
}

/// How many rows from `row` on agree on the axes up to `axis`: their label stands once.
std::size_t heightOf(const Overlay& overlay, std::size_t row, std::size_t axis) {
    const auto& rows = overlay.rows();
    if (axis + 1 == rows[row].size()) return 1;
    const auto isSame = [&](std::size_t other) {
        return std::equal(rows[row].begin(),
                          rows[row].begin() + static_cast<std::ptrdiff_t>(axis) + 1,
                          rows[other].begin()) &&
               isStandIn(overlay, rows[row]) == isStandIn(overlay, rows[other]);
    };
    std::size_t last = row + 1;
    while (last < rows.size() && isSame(last)) ++last;
    return last - row;
}

using ShownLabels = std::vector<std::map<std::string, std::string>>;  // beside the row axes

std::string rowHtml(const Overlay& overlay, std::size_t row, const ShownLabels& shown) {
    const std::vector<std::string>& labels = overlay.rows()[row];
    std::string html = "<tr>";
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::size_t height = heightOf(overlay, row, i);
        if (row > 0 && heightOf(overlay, row - 1, i) > 1) continue;  // the row above has it
        const bool isMarked = i == 0 && isStandIn(overlay, labels);
        html += fmt::format("<th scope=\"{}\"{}{} title=\"{}\">{}{}</th>",
                            height > 1 ? "rowgroup" : "row", i == 0 ? " class=\"first\"" : "",
                            height > 1 ? fmt::format(" rowspan=\"{}\"", height) : "",
                            escapeXml(labels[i]), escapeXml(shown[i].at(labels[i])),
                            isMarked ? " <abbr title=\"stand-in\">†</abbr>" : "");
    }
    for (const tables::TableColumn& column : overlay.columns()) {
        if (overlay.hasPrinted(column.label)) {
            html += fmt::format("<td class=\"num printed\">{}</td>",
                                escapeXml(overlay.printed(labels, column.label).value_or("")));
        }
        if (overlay.isOnlyPrinted()) continue;
        for (std::size_t i = 0; i < overlay.runs().size(); ++i) {
            html +=
                cellHtml(overlay.find(i, overlay.find(i, labels), column.label), overlay.runs()[i]);
        }
    }
    return html + "</tr>\n";
}

}  // namespace

/// At which parameters each run measured; before the table, that nobody reads its numbers without.
std::string parametersHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        if (!page.parts[run].experiment) continue;
        const std::string line = tables::parametersLine(page.parts[run].table);
        if (line.empty()) continue;
        const std::string letter =
            model.isComparison() ? fmt::format("<b>{}</b> ", Model::letter(run)) : "";
        html += fmt::format("<p class=\"parameters\">{}{}</p>\n", letter, escapeXml(line));
    }
    return html;
}

/// What is alike in all rows of a table that nobody laid out.
std::string constantsHtml(const Page& page) {
    const RunPart* shown = page.shown();
    if (!shown || shown->table.constants.empty()) return "";
    return fmt::format("<p class=\"parameters\">In every row: {}.</p>\n",
                       escapeXml(fmt::format("{}", fmt::join(shown->table.constants, ", "))));
}

/// What stands under the numbers of this table.
std::string smallPrintHtml(const Page& page) {
    bool hasIntervals = false, hasTimes = false, hasRanges = false, hasShares = false,
         hasRatios = false;
    for (const RunPart& part : page.parts) {
        if (!part.experiment || part.table.isOnlyPrinted) continue;
        for (const TableRow& row : part.table.rows) {
            for (const Cell& cell : row.cells) {
                hasRatios |= !ratioHtml(cell).empty();
                if (!cell.hasShownBounds()) continue;
                const bool isInterval = cell.bounds() == tables::Bounds::Interval;
                hasIntervals |= isInterval;
                hasRanges |= !isInterval;
                hasTimes |= isInterval && cell.isTime;
                hasShares |= isInterval && !cell.isTime && cell.unit == "%";
            }
        }
    }
    std::string says;
    const auto add = [&](const char* text) {
        says += fmt::format("{}{}", says.empty() ? "" : " · ", text);
    };
    if (hasIntervals) add("95 % interval a–b");
    if (hasTimes) add("of a time that of this sitting: another run's may differ by more");
    if (hasShares)
        add("of a share that was counted once by its count alone: other scenes may differ by more");
    if (hasRanges) add("range a … b, of too few processes for an interval");
    if (hasRatios) {
        add("× measured ÷ printed, where it was measured at the printed parameters");
    }
    if (!says.empty()) says = "Small print under a number: " + says + ". ";
    return fmt::format(
        "<p class=\"soft small\">{}Point at a row for its cases; click to keep them.</p>\n", says);
}

/// Printed rows that this run does not have, folded.
std::string absentRowsHtml(const Page& page) {
    const RunPart* shown = page.shown();
    if (!shown || shown->table.printedRows.empty()) return "";
    const Table& table = shown->table;
    std::string html = fmt::format(
        "<details class=\"absent\"><summary>{} printed row{} not part of this run</summary>\n"
        "<div class=\"scroll\"><table class=\"results\"><thead><tr>",
        table.printedRows.size(), table.printedRows.size() == 1 ? " is" : "s are");
    for (const std::string& axis : table.rowAxes) {
        html += fmt::format("<th class=\"axis\" scope=\"col\">{}</th>",
                            escapeXml(tables::shownName(axis, table.words)));
    }
    for (const tables::TableColumn& column : table.columns) {
        html += fmt::format("<th scope=\"col\">{}</th>",
                            escapeXml(tables::quantityOf(column, table.words).text()));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const TableRow& row : table.printedRows) {
        html += "<tr>";
        for (const std::string& label : row.labels) {
            html += fmt::format("<th scope=\"row\">{}</th>",
                                escapeXml(tables::shownName(label, table.words)));
        }
        for (const Cell& cell : row.cells) {
            html += fmt::format("<td class=\"num printed\">{}</td>",
                                escapeXml(cell.printed.value_or("")));
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table></div></details>\n";
}

std::string tableHtml(const Page& page, const Model& model) {
    const Overlay overlay(page);
    if (overlay.isEmpty()) return "";
    std::string html = parametersHtml(page, model) + constantsHtml(page) +
                       "<div class=\"scroll\"><table class=\"results\">\n" +
                       headHtml(overlay, model.isComparison()) + "<tbody>\n";
    bool hasStandIn = false;
    const ShownLabels shown = tables::shownLabels(overlay.rows(), overlay.first().words);
    for (std::size_t row = 0; row < overlay.rows().size(); ++row) {
        html += rowHtml(overlay, row, shown);
        hasStandIn |= isStandIn(overlay, overlay.rows()[row]);
    }
    html += "</tbody></table></div>\n" + absentRowsHtml(page) + smallPrintHtml(page);
    const auto isMarked = [&](std::size_t run) { return page.parts[run].table.hasCalibrated(); };
    if (std::ranges::any_of(overlay.runs(), isMarked)) {
        html += fmt::format("<p class=\"soft small\">{} {}.</p>\n", tables::kCalibratedMark,
                            tables::kCalibratedLegend);
    }
    for (const std::size_t run : overlay.runs()) {
        const auto clock = tables::movedClock(page.parts[run].table);
        if (!clock) continue;
        html += fmt::format("<p class=\"soft small\">{}{} {}.</p>\n",
                            model.isComparison() ? Model::letter(run) + ": " : "",
                            tables::kMovedClockMark, escapeXml(tables::movedClockLegend(*clock)));
    }
    if (hasStandIn) {
        html +=
            "<p class=\"soft small\">† a stand-in with the printed counts: the real model was "
            "not at hand.</p>\n";
    }
    return html;
}

}  // namespace gfxrepro::report
