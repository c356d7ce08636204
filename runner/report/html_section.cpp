#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/core/files.h"
#include "runner/report/html.h"
#include "runner/report/markup.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

std::string paragraph(const char* cssClass, const std::string& label, const std::string& text) {
    if (text.empty()) return "";
    return fmt::format("<p class=\"{}\">{}{}</p>\n", cssClass, label, escapeXml(text));
}

/// Whether a column has printed numbers, and so two columns in the page.
bool hasPrinted(const Table& table, std::size_t column) {
    for (const TableRow& row : table.rows) {
        if (row.cells[column].printed) return true;
    }
    return false;
}

/// Whether a column's printed numbers stand beside measured ones: not so where nothing is measured.
bool isPair(const Table& table, std::size_t column) {
    return hasPrinted(table, column) && !table.isOnlyPrinted;
}

std::string headHtml(const Table& table) {
    bool isTwoLines = false;
    for (std::size_t i = 0; i < table.columns.size(); ++i) isTwoLines |= isPair(table, i);
    const char* rowSpan = isTwoLines ? " rowspan=\"2\"" : "";
    std::string head = "<thead><tr>";
    std::string below;
    for (const std::string& axis : table.rowAxes) {
        head += fmt::format("<th class=\"axis\"{}>{}</th>", rowSpan, escapeXml(axis));
    }
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const TableColumn& column = table.columns[i];
        // "draw_ms" and "triangles" say their unit already.
        const bool isSaid = column.label.find(column.unit) != std::string::npos;
        const std::string unit =
            isSaid || column.unit == "1"
                ? ""
                : fmt::format(" <span class=\"sub\">{}</span>", escapeXml(column.unit));
        const bool isGroup = isPair(table, i);
        head += fmt::format("<th class=\"{}\"{}>{}{}</th>", isGroup ? "group" : "num",
                            isGroup ? " colspan=\"2\"" : rowSpan, escapeXml(column.label), unit);
        if (isGroup) below += "<th class=\"sub\">printed</th><th class=\"sub\">measured</th>";
    }
    head += "</tr>";
    if (isTwoLines) head += fmt::format("<tr>{}</tr>", below);
    return head + "</thead>\n";
}

std::string cellHtml(const Cell& cell) {
    if (!cell.isPlanned) return "<td></td>";
    const std::string title =
        cell.message.empty() ? "" : fmt::format(" title=\"{}\"", escapeXml(cell.message));
    if (!cell.isOk()) {
        return fmt::format("<td class=\"num\"{}><span class=\"status\">{}</span></td>", title,
                           escapeXml(cell.measured));
    }
    std::string html = fmt::format("<td class=\"num\">{}", escapeXml(cell.measured));
    if (!cell.low.empty() && cell.low != cell.high) {
        html += fmt::format("<span class=\"interval\">{}–{}</span>", escapeXml(cell.low),
                            escapeXml(cell.high));
    }
    return html + "</td>";
}

std::string tableHtml(const Table& table) {
    if (table.columns.empty() || table.rows.empty()) return "";
    std::string html = "<div class=\"scroll\"><table class=\"results\">\n" + headHtml(table);
    html += "<tbody>\n";
    bool hasStandIn = false;
    for (const TableRow& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.labels.size(); ++i) {
            const bool isMarked = i == 0 && row.source == SceneSource::StandIn;
            hasStandIn |= isMarked;
            html += fmt::format("<th scope=\"row\">{}{}</th>", escapeXml(row.labels[i]),
                                isMarked ? " <abbr title=\"stand-in\">†</abbr>" : "");
        }
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            if (hasPrinted(table, i)) {
                html += fmt::format("<td class=\"num printed\">{}</td>",
                                    escapeXml(row.cells[i].printed.value_or("")));
            }
            if (!table.isOnlyPrinted) html += cellHtml(row.cells[i]);
        }
        html += "</tr>\n";
    }
    html += "</tbody></table></div>\n";
    if (hasStandIn) {
        html +=
            "<p class=\"soft small\">† a stand-in with the printed counts: the real model was "
            "not at hand.</p>\n";
    }
    return html;
}

std::string claimsHtml(const std::vector<ClaimResult>& claims) {
    if (claims.empty()) return "";
    std::string html =
        "<h3>Claims</h3>\n<div class=\"scroll\"><table class=\"claims\"><thead><tr><th>claim</th>"
        "<th>verdict</th><th>what the paper says</th><th>required</th><th>measured</th>"
        "<th>reason</th></tr></thead>\n<tbody>\n";
    for (const ClaimResult& claim : claims) {
        html += fmt::format(
            "<tr><td class=\"id\">{}</td><td>{}</td><td>{}</td><td>{}</td>"
            "<td class=\"measured\">{}</td><td class=\"soft\">{}</td></tr>\n",
            escapeXml(claim.id), verdictBadge(claim.verdict), escapeXml(claim.text),
            escapeXml(claim.required), escapeXml(claim.measured), escapeXml(claim.reason));
    }
    return html + "</tbody></table></div>\n";
}

std::string assumptionsHtml(const std::vector<config::Assumption>& assumptions) {
    if (assumptions.empty()) return "";
    std::string html = "<h3>Assumptions</h3>\n<ul class=\"small\">\n";
    for (const config::Assumption& assumption : assumptions) {
        std::string text = escapeXml(assumption.name);
        if (!assumption.value.isNull())
            text += fmt::format(" = {}", escapeXml(assumption.value.toFlowText()));
        if (!assumption.unit.empty()) text += fmt::format(" {}", escapeXml(assumption.unit));
        if (!assumption.range.isNull()) {
            text += fmt::format(" <span class=\"soft\">(range {})</span>",
                                escapeXml(assumption.range.toFlowText()));
        }
        html += fmt::format("<li>{}: {}</li>\n", text, escapeXml(assumption.why));
    }
    return html + "</ul>\n";
}

/// The image itself where it is to lie in the page and can be read, else a reference to its file.
std::string imageSource(const fs::path& runDir, const std::string& png, bool embedsImages) {
    const fs::path path = runDir / png;
    if (embedsImages && fs::exists(path)) {
        return fmt::format("data:image/png;base64,{}", base64(readFile(path)));
    }
    return escapeXml(png);
}

std::string imagesHtml(const ReportSection& section, const fs::path& runDir, bool embedsImages) {
    std::string figures;
    for (const ImageEntry& image : section.images) {
        if (image.png.empty()) continue;
        const std::string frame =
            section.experiment->measure.frames > 1 ? fmt::format(", frame {}", image.frame) : "";
        const std::string caption = image.title + " · " + image.name + frame;
        figures += fmt::format(
            "<figure><img src=\"{}\" alt=\"{}\" loading=\"lazy\"><figcaption>{}</figcaption>"
            "</figure>\n",
            imageSource(runDir, image.png, embedsImages), escapeXml(caption), escapeXml(caption));
    }
    if (figures.empty()) return "";
    return fmt::format("<h3>Images</h3>\n<div class=\"gallery\">\n{}</div>\n", figures);
}

std::string failuresHtml(const std::vector<ReportSection::Failure>& failures) {
    if (failures.empty()) return "";
    std::string html = "<h3>Cases that did not finish well</h3>\n<ul class=\"small\">\n";
    for (const auto& failure : failures) {
        html += fmt::format("<li>{}: <span class=\"status\">{}</span>{}{}</li>\n",
                            escapeXml(failure.name), statusName(failure.status),
                            failure.message.empty() ? "" : " — ", escapeXml(failure.message));
    }
    return html + "</ul>\n";
}

}  // namespace

std::string sectionAnchor(const ReportSection& section) {
    return section.table->slug;
}

std::string sectionHtml(const ReportSection& section, const ReportContext& context,
                        const fs::path& runDir, bool embedsImages) {
    const Table& table = *section.table;
    std::string html =
        fmt::format("<section id=\"{}\">\n<h2>{}. {}</h2>\n<p class=\"soft small\">{}</p>\n",
                    escapeXml(sectionAnchor(section)), escapeXml(table.label),
                    escapeXml(table.title), escapeXml(table.id));
    html += tableHtml(table);
    html += paragraph("small", "<span class=\"soft\">Printed numbers:</span> ", table.hardware);
    html += paragraph("small", "<span class=\"soft\">Remark:</span> ", table.remark);
    for (const std::string& note : table.notes) html += paragraph("small soft", "", note);
    html += claimsHtml(section.claims);
    html += failuresHtml(section.failures);
    html += assumptionsHtml(section.experiment->assumptions);
    html += imagesHtml(section, runDir, embedsImages);
    const bool isOwn = section.experiment->kind == config::Experiment::Kind::Sweep;
    html +=
        fmt::format("<h3>Run this one again</h3>\n<pre>gfxrepro reproduce {} --profile {}</pre>\n",
                    escapeXml(isOwn ? section.experiment->file.string() : table.id),
                    escapeXml(context.profile));
    return html + "</section>\n";
}

}  // namespace gfxrepro::report
