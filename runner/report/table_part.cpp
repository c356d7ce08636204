// The table of a page: the tables of several runs laid over one another.
#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/tables/labels.h"
#include "runner/tables/nearness.h"
#include "runner/tables/printed.h"
#include "runner/tables/run_ratio.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

using tables::Cell;
using tables::Table;
using tables::TableRow;

namespace {

/// All rows and columns that any of the tables has: runs of other profiles have other rows.
class Overlay {
  public:
    /// With the columns of which `isShown`; of which it is not, they are as if no table had them.
    explicit Overlay(const Page& page,
                     const std::function<bool(const Table&, std::size_t)>& isShown);

    const std::vector<std::size_t>& runs() const { return runs_; }
    const std::vector<tables::TableColumn>& columns() const { return columns_; }
    const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// A row of the i-th table; null where it has none.
    const TableRow* find(std::size_t i, const std::vector<std::string>& labels) const {
        const auto row = rowOf_[i].find(labels);
        return row == rowOf_[i].end() ? nullptr : row->second;
    }
    const Cell* find(std::size_t i, const TableRow* row, const std::string& column) const {
        if (!row) return nullptr;
        const auto place = tables_[i]->findColumn(column);
        return place ? &row->cells[*place] : nullptr;
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
    /// The first that knows its words: kept results do not.
    const Table& first() const {
        const auto knows = [](const Table* table) { return !table->label.empty(); };
        const auto found = std::ranges::find_if(tables_, knows);
        return found == tables_.end() ? *tables_.front() : **found;
    }
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
    std::vector<tables::TableColumn> columns_;
    std::vector<std::vector<std::string>> rows_;
};

Overlay::Overlay(const Page& page, const std::function<bool(const Table&, std::size_t)>& isShown) {
    std::set<std::vector<std::string>> seen;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const Table& table = page.parts[run].table;
        if (table.columns.empty()) continue;
        runs_.push_back(run);
        tables_.push_back(&table);
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const tables::TableColumn& column = table.columns[i];
            const auto isSame = [&](const auto& known) { return known.label == column.label; };
            const auto known = std::ranges::find_if(columns_, isSame);
            if (known == columns_.end()) {
                if (isShown(table, i)) columns_.push_back(column);
            } else if (known->parts.empty()) {
                *known = column;  // kept results have their labels alone
            }
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

/// The heads of its columns: a line for each column axis, and one for printed and measured.
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
        if (overlay.hasPrinted(column.label))
            below += "<th class=\"sub\" scope=\"col\">printed</th>";
        for (const std::size_t run : overlay.runs()) {
            below += fmt::format("<th class=\"sub\" scope=\"col\">{}</th>",
                                 isComparison ? Model::letter(run) : "measured");
        }
    }
    html += "</tr>";
    if (hasSources) html += fmt::format("\n<tr>{}</tr>", below);
    return html + "</thead>\n";
}

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

/// "÷ A 1.05 [0.98, 1.12]" of a later run.
std::string ratioOfRunsHtml(const Cell& cell, const Cell* first) {
    const auto ratio = first ? tables::ratioOfRuns(cell, *first) : std::nullopt;
    if (!ratio) return "";
    std::string says = fmt::format("÷ A {:.3g}", ratio->ratio);
    if (ratio->interval) {
        says += fmt::format(" [{:.3g}, {:.3g}]", ratio->interval->low, ratio->interval->high);
    }
    return fmt::format("<span class=\"ratio of-runs\">{}</span>", says);
}

/// `place`: its id in the file, where something leads to it. `first` is the cell of run A, of a
/// later run.
std::string cellHtml(const Cell* cell, std::size_t run, const std::string& place,
                     const Cell* first) {
    if (!cell || !cell->isPlanned) return "<td></td>";
    std::string anchors;
    for (const std::string& id : cell->caseIds) anchors += caseAnchor(run, id) + ' ';
    if (!anchors.empty()) anchors.pop_back();
    std::string attributes =
        anchors.empty() ? "" : fmt::format(" data-cases=\"{}\"", escapeXml(anchors));
    if (!place.empty()) attributes += fmt::format(" id=\"{}\"", place);
    if (const std::string title = titleOf(*cell); !title.empty()) {
        attributes += fmt::format(" title=\"{}\"", escapeXml(title));
    }
    if (!cell->isOk()) {
        return fmt::format("<td class=\"num\"{}><span class=\"status\">{}</span></td>", attributes,
                           escapeXml(cell->measured));
    }
    std::string html = fmt::format("<td class=\"num{}\"{}>{}", cell->isWithinNoise ? " soft" : "",
                                   attributes, escapeXml(cell->measured));
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
        below = fmt::format("<span title=\"{}\">{}{}{}</span>", tables::boundsName(cell->bounds()),
                            escapeXml(cell->low), cell->hasInterval() ? "–" : " … ",
                            escapeXml(cell->high));
    }
    if (const std::string ratio = ratioHtml(*cell); !ratio.empty()) {
        below += (below.empty() ? "" : " ") + ratio;
    }
    if (!below.empty()) html += fmt::format("<span class=\"interval\">{}</span>", below);
    if (const std::string ratio = ratioOfRunsHtml(*cell, first); !ratio.empty()) {
        html += fmt::format("<span class=\"interval\">{}</span>", ratio);
    }
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

/// Of each cell that a point of a document's plot leads to its place in the file.
using CellPlaces = std::map<const Cell*, std::string>;

CellPlaces cellPlaces(const Page& page) {
    CellPlaces places;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const RunPart& part = page.parts[run];
        if (!part.experiment) continue;
        for (const auto& near : tables::nearnessOf(*part.experiment, part.table).cells) {
            places[&part.table.rows[near.row].cells[near.column]] =
                cellAnchor(page, run, near.row, near.column);
        }
    }
    return places;
}

std::string rowHtml(const Overlay& overlay, std::size_t row, const ShownLabels& shown,
                    const CellPlaces& places) {
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
                            isMarked ? " <abbr title=\"another model in its place\">†</abbr>" : "");
    }
    for (const tables::TableColumn& column : overlay.columns()) {
        if (overlay.hasPrinted(column.label)) {
            html += fmt::format("<td class=\"num printed\">{}</td>",
                                escapeXml(overlay.printed(labels, column.label).value_or("")));
        }
        if (overlay.isOnlyPrinted()) continue;
        const Cell* first = nullptr;
        for (std::size_t i = 0; i < overlay.runs().size(); ++i) {
            const Cell* cell = overlay.find(i, overlay.find(i, labels), column.label);
            const auto place = places.find(cell);
            html += cellHtml(cell, overlay.runs()[i], place == places.end() ? "" : place->second,
                             first);
            if (overlay.runs()[i] == 0) first = cell;
        }
    }
    return html + "</tr>\n";
}

/// At which parameters each run measured; before the table, that nobody reads its numbers without.
std::string parametersHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        if (!page.parts[run].experiment) continue;
        const std::string line = tables::parametersLine(page.parts[run].table);
        if (line.empty()) continue;
        html += fmt::format("<p class=\"parameters\">{}{}</p>\n", model.boldLetter(run),
                            escapeXml(line));
    }
    return html;
}

/// What is alike in all rows of a table that nobody laid out.
std::string constantsHtml(const Page& page) {
    const RunPart* shown = page.shown();
    if (!shown || shown->table.constants.empty()) return "";
    return fmt::format("<p class=\"parameters\">In every row: {}.</p>\n",
                       escapeXml(joined(shown->table.constants)));
}

/// What stands under the numbers of this table.
std::string smallPrintHtml(const Page& page, const Model& model) {
    const auto has = [&](bool (*isSuch)(const Cell&)) {
        return std::ranges::any_of(page.parts,
                                   [&](const RunPart& part) { return part.table.hasCell(isSuch); });
    };
    std::vector<std::string> parts;
    if (has([](const Cell& cell) { return cell.hasInterval(); })) {
        parts.emplace_back("95 % interval a–b");
    }
    if (has([](const Cell& cell) { return cell.hasInterval() && cell.isTime; })) {
        parts.emplace_back("of a time that of this sitting: another run's may differ by more");
    }
    if (has([](const Cell& cell) { return cell.isCountedShare(); })) {
        parts.emplace_back(
            "of a share that was counted once by its count alone: other scenes may differ by more");
    }
    if (has([](const Cell& cell) { return cell.hasShownBounds() && !cell.hasInterval(); })) {
        parts.emplace_back("range a … b, of too few processes for an interval");
    }
    if (has([](const Cell& cell) { return cell.isWithinNoise; })) {
        parts.emplace_back("a grey ratio is within the noise");
    }
    if (has([](const Cell& cell) { return !ratioHtml(cell).empty(); })) {
        parts.emplace_back("× measured ÷ printed, where it was measured at the printed parameters");
    }
    if (model.isComparison()) {
        parts.emplace_back(
            "÷ A that of the first run, with 95 % where both have an interval; of times it holds "
            "what the machine did between the runs, too");
    }
    std::string says = joined(parts, " · ");
    if (!says.empty()) says = "Small print under a number: " + says + ". ";
    return fmt::format(
        "<p class=\"soft small\">{}<span class=\"on-screen\">Point at a row for its cases; click "
        "to "
        "keep them.</span></p>\n",
        says);
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

std::string resultsHtml(const Overlay& overlay, const Page& page, const Model& model) {
    std::string html = "<div class=\"scroll\"><table class=\"results\">\n" +
                       headHtml(overlay, model.isComparison()) + "<tbody>\n";
    const ShownLabels shown = tables::shownLabels(overlay.rows(), overlay.first().words);
    const CellPlaces places = cellPlaces(page);
    for (std::size_t row = 0; row < overlay.rows().size(); ++row) {
        html += rowHtml(overlay, row, shown, places);
    }
    return html + "</tbody></table></div>\n";
}

}  // namespace

std::string tableHtml(const Page& page, const Model& model) {
    // Of a table that nobody laid out the steps of a frame stand folded below what they come to.
    const bool isLaidOut = !page.shown() || !page.shown()->experiment->hasDefaultLayout();
    const auto isStep = [&](const Table& table, std::size_t column) {
        return !isLaidOut && std::ranges::any_of(table.rows, [&](const TableRow& row) {
            const std::string& metric = row.cells[column].metric;
            return metric == "gpu_time_ms" || metric == "cpu_time_ms";
        });
    };
    Overlay steps(page, isStep);
    Overlay overlay(page, std::not_fn(isStep));
    if (overlay.isEmpty()) std::swap(steps, overlay);
    if (overlay.isEmpty()) return "";
    std::string html = parametersHtml(page, model) + constantsHtml(page) +
                       resultsHtml(overlay, page, model) + absentRowsHtml(page);
    if (!steps.isEmpty()) {
        html += fmt::format(
            "<details class=\"steps\"><summary>Times of {} step{} of a "
            "frame</summary>\n{}</details>\n",
            steps.columns().size(), steps.columns().size() == 1 ? "" : "s",
            resultsHtml(steps, page, model));
    }
    html += smallPrintHtml(page, model);
    bool hasStandIn = false;
    for (const auto& labels : overlay.rows()) hasStandIn |= isStandIn(overlay, labels);
    const auto isMarked = [&](std::size_t run) { return page.parts[run].table.hasCalibrated(); };
    if (std::ranges::any_of(overlay.runs(), isMarked)) {
        html += fmt::format("<p class=\"soft small\">{} {}.</p>\n", tables::kCalibratedMark,
                            tables::kCalibratedLegend);
    }
    for (const std::size_t run : overlay.runs()) {
        const auto clock = tables::movedClock(page.parts[run].table);
        if (!clock) continue;
        html += fmt::format("<p class=\"soft small\">{}{} {}.</p>\n", model.prefix(run),
                            tables::kMovedClockMark, escapeXml(tables::movedClockLegend(*clock)));
    }
    if (hasStandIn) {
        html +=
            "<p class=\"soft small\">† measured on another model with the printed counts: the real "
            "one was not at hand.</p>\n";
    }
    return html;
}

}  // namespace gfxrepro::report
