#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "runner/html/parts.h"
#include "runner/report/markup.h"
#include "runner/report/printed_parameters.h"

namespace gfxrepro::html {

using report::Cell;
using report::escapeXml;
using report::Table;
using report::TableRow;

namespace {

/// The tables of several runs laid over one another: a row or column that any of them has. Runs of
/// other profiles have other rows.
class Overlay {
  public:
    explicit Overlay(const Page& page) {
        std::set<std::vector<std::string>> seen;
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            if (!page.parts[run].experiment) continue;
            const Table& table = page.parts[run].table;
            runs_.push_back(run);
            tables_.push_back(&table);
            for (const report::TableColumn& column : table.columns) {
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

    const std::vector<std::size_t>& runs() const { return runs_; }
    const std::vector<report::TableColumn>& columns() const { return columns_; }
    const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// A row of the i-th table; null where it has none.
    const TableRow* find(std::size_t i, const std::vector<std::string>& labels) const {
        const auto row = rowOf_[i].find(labels);
        return row == rowOf_[i].end() ? nullptr : row->second;
    }
    const Cell* find(std::size_t i, const TableRow* row, const std::string& column) const {
        if (!row) return nullptr;
        for (std::size_t c = 0; c < tables_[i]->columns.size(); ++c) {
            if (tables_[i]->columns[c].label == column) return &row->cells[c];
        }
        return nullptr;
    }
    /// What the paper printed there; the same in every run that has the cell.
    std::optional<std::string> printed(const std::vector<std::string>& labels,
                                       const std::string& column) const {
        for (std::size_t i = 0; i < tables_.size(); ++i) {
            const Cell* cell = find(i, find(i, labels), column);
            if (cell && cell->printed) return cell->printed;
        }
        return std::nullopt;
    }
    bool hasPrinted(const std::string& column) const { return printedColumns_.contains(column); }
    bool isOnlyPrinted() const { return tables_.front()->isOnlyPrinted; }
    const Table& first() const { return *tables_.front(); }
    bool isEmpty() const { return tables_.empty() || columns_.empty() || rows_.empty(); }
    /// What stands under one column's head: the printed number, then a number a run.
    std::size_t widthOf(const std::string& column) const {
        return isOnlyPrinted() ? 1 : (hasPrinted(column) ? 1 : 0) + runs_.size();
    }

  private:
    std::vector<std::size_t> runs_;  // beside tables_: its index in the model
    std::vector<const Table*> tables_;
    std::vector<std::map<std::vector<std::string>, const TableRow*>> rowOf_;  // likewise
    std::set<std::string> printedColumns_;
    std::vector<report::TableColumn> columns_;
    std::vector<std::vector<std::string>> rows_;
};

/// Which way a column is better.
std::string directionHtml(config::Better better) {
    if (better == config::Better::Neither) return "";
    return fmt::format(" <span class=\"sub\" title=\"{}\">{}</span>", config::betterText(better),
                       better == config::Better::Lower ? "↓" : "↑");
}

std::string headHtml(const Overlay& overlay, bool isComparison) {
    const auto isGroup = [&](const auto& column) { return overlay.widthOf(column.label) > 1; };
    const bool isTwoLines = std::ranges::any_of(overlay.columns(), isGroup);
    const char* rowSpan = isTwoLines ? " rowspan=\"2\"" : "";
    std::string head = "<thead><tr>";
    std::string below;
    for (const std::string& axis : overlay.first().rowAxes) {
        head += fmt::format("<th class=\"axis\"{}>{}</th>", rowSpan, escapeXml(axis));
    }
    for (const report::TableColumn& column : overlay.columns()) {
        // "draw_ms" and "triangles" say their unit already.
        const bool isSaid = column.label.find(column.unit) != std::string::npos;
        const std::string unit =
            isSaid || column.unit == "1"
                ? ""
                : fmt::format(" <span class=\"sub\">{}</span>", escapeXml(column.unit));
        const std::string span = isGroup(column)
                                     ? fmt::format(" colspan=\"{}\"", overlay.widthOf(column.label))
                                     : std::string(rowSpan);
        const std::string title =
            column.doc.empty() ? "" : fmt::format(" title=\"{}\"", escapeXml(column.doc));
        head +=
            fmt::format("<th class=\"{}\"{}{}>{}{}{}</th>", isGroup(column) ? "group" : "num", span,
                        title, escapeXml(column.label), unit, directionHtml(column.better));
        if (!isGroup(column)) continue;
        if (overlay.hasPrinted(column.label)) below += "<th class=\"sub\">printed</th>";
        for (const std::size_t run : overlay.runs()) {
            below += fmt::format("<th class=\"sub\">{}</th>",
                                 isComparison ? Model::letter(run) : "measured");
        }
    }
    head += "</tr>";
    if (isTwoLines) head += fmt::format("<tr>{}</tr>", below);
    return head + "</thead>\n";
}

/// "×1.2" of the printed number, where both are of the same parameters; a rate of what was, not a
/// comparison of machines.
std::string ratioHtml(const Cell& cell) {
    if (!cell.isAtPrintedParameters) return "";
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
    if (!cell.departures.empty()) return "at " + report::departuresText(cell.departures);
    return cell.openParameters.empty() ? "" : "not given: " + report::openText(cell.openParameters);
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
        html += fmt::format(" <abbr title=\"calibrated\">{}</abbr>", report::kCalibratedMark);
    }
    std::string below;
    if (cell->hasShownBounds()) {
        const bool isInterval = cell->bounds() == report::Bounds::Interval;
        below = fmt::format("<span title=\"{}\">{}{}{}</span>", report::boundsName(cell->bounds()),
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
        if (row && row->source == report::SceneSource::StandIn) return true;
    }
    return false;
}

std::string rowHtml(const Overlay& overlay, const std::vector<std::string>& labels) {
    std::string html = "<tr>";
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const bool isMarked = i == 0 && isStandIn(overlay, labels);
        html += fmt::format("<th scope=\"row\">{}{}</th>", escapeXml(labels[i]),
                            isMarked ? " <abbr title=\"stand-in\">†</abbr>" : "");
    }
    for (const report::TableColumn& column : overlay.columns()) {
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
        const std::string line = report::parametersLine(page.parts[run].table);
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

std::string tableHtml(const Page& page, const Model& model) {
    const Overlay overlay(page);
    if (overlay.isEmpty()) return "";
    std::string html = parametersHtml(page, model) + constantsHtml(page) +
                       "<div class=\"scroll\"><table class=\"results\">\n" +
                       headHtml(overlay, model.isComparison()) + "<tbody>\n";
    bool hasStandIn = false;
    for (const std::vector<std::string>& labels : overlay.rows()) {
        html += rowHtml(overlay, labels);
        hasStandIn |= isStandIn(overlay, labels);
    }
    html += "</tbody></table></div>\n";
    if (!overlay.isOnlyPrinted()) {
        html +=
            "<p class=\"soft small\">Under a number: its 95 % interval a–b (of a share that was "
            "counted once: by its count alone, other scenes may differ by more), or, of too few "
            "processes for one, the range a … b; and, where it was measured at the printed "
            "parameters, as far as they are given, × what is printed. Point at a row for its "
            "cases; click to keep "
            "them.</p>\n";
    }
    const auto isMarked = [&](std::size_t run) { return page.parts[run].table.hasCalibrated(); };
    if (std::ranges::any_of(overlay.runs(), isMarked)) {
        html += fmt::format("<p class=\"soft small\">{} {}.</p>\n", report::kCalibratedMark,
                            report::kCalibratedLegend);
    }
    if (hasStandIn) {
        html +=
            "<p class=\"soft small\">† a stand-in with the printed counts: the real model was "
            "not at hand.</p>\n";
    }
    return html;
}

}  // namespace gfxrepro::html
