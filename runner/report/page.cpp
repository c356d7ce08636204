#include <fmt/format.h>

#include "runner/report/markup.h"
#include "runner/report/parts.h"
#include "runner/tables/labels.h"

namespace gfxrepro::report {

namespace {

std::string classedParagraph(const char* cssClass, const char* label, const std::string& text) {
    if (text.empty()) return "";
    return fmt::format("<p class=\"{}\"><span class=\"soft\">{}</span>{}</p>\n", cssClass, label,
                       escapeXml(text));
}

std::string assumptionsHtml(const std::vector<config::Assumption>& assumptions,
                            const tables::Words& words) {
    if (assumptions.empty()) return "";
    std::string html =
        "<h3>Assumptions</h3>\n<div class=\"scroll\"><table class=\"assumed\"><thead><tr>"
        "<th>what the paper left open</th><th>taken</th><th>range</th><th>why</th></tr></thead>\n"
        "<tbody>\n";
    for (const config::Assumption& assumption : assumptions) {
        const auto text = [](const Node& node) {
            return node.isNull() ? ""
                                 : escapeXml(node.isScalar() ? node.text() : node.toFlowText());
        };
        const std::string unit = assumption.unit.empty() ? "" : ' ' + escapeXml(assumption.unit);
        html += fmt::format(
            "<tr><td title=\"{}\">{}</td><td>{}{}</td><td>{}</td><td>{}</td></tr>\n",
            escapeXml(assumption.name), escapeXml(tables::quantityOf(assumption.name, words).words),
            text(assumption.value), assumption.value.isNull() ? "" : unit, text(assumption.range),
            escapeXml(assumption.why));
    }
    return html + "</tbody></table></div>\n";
}

std::string curvesHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        for (const Curve* curve : page.parts[run].curves) {
            html += fmt::format(
                "<figure class=\"curve\">{}<figcaption>{}{}{}</figcaption></figure>\n", curve->svg,
                model.isComparison() ? Model::letter(run) + ": " : "", escapeXml(curve->title),
                curve->problem.empty()
                    ? ""
                    : fmt::format(" <span class=\"soft\">({})</span>", escapeXml(curve->problem)));
        }
    }
    return html.empty() ? "" : "<h3>Curves</h3>\n<div class=\"curves\">\n" + html + "</div>\n";
}

std::string failuresHtml(const Page& page, const Model& model) {
    std::string items;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        for (const Failure& failure : page.parts[run].failures) {
            items += fmt::format(
                "<li>{}{} (case <a href=\"#{}\">{}</a>): <span class=\"status\">{}</span>{}{}"
                "</li>\n",
                model.isComparison() ? Model::letter(run) + ": " : "", escapeXml(failure.name),
                escapeXml(caseAnchor(run, failure.caseId)), escapeXml(failure.caseId),
                records::statusName(failure.status), failure.message.empty() ? "" : " — ",
                escapeXml(failure.message));
        }
    }
    if (items.empty()) return "";
    return "<h3>Cases that did not finish well</h3>\n<ul class=\"small\">\n" + items + "</ul>\n";
}

bool isImported(const ReportRun& run) {
    return run.manifest.is_object() && run.manifest.contains("imported");
}

/// Which numbers were measured elsewhere, where there are some.
std::string importedHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const ReportRun& from = model.runs[run];
        if (!page.parts[run].experiment || !isImported(from)) continue;
        html += fmt::format(
            "<p class=\"small\"><span class=\"badge ambiguous\">imported</span> {}measured "
            "elsewhere, on {}, and not by this program; the numbers of {}.</p>\n",
            model.isComparison() ? Model::letter(run) + ": " : "", escapeXml(from.context.device),
            escapeXml(from.manifest["imported"].value("file", "a file")));
    }
    return html;
}

std::string againHtml(const RunPart& part, const ReportRun& run) {
    const claims::ReportContext& context = run.context;
    if (isImported(run)) {
        return fmt::format("<h3>Import it again</h3>\n<pre>{}</pre>\n", escapeXml(context.command));
    }
    const auto command = run.commands.find(part.table.id);
    if (command == run.commands.end()) return "";
    return fmt::format("<h3>Run it again</h3>\n<pre>{}</pre>\n", escapeXml(command->second));
}

}  // namespace

std::string pageHtml(const Page& page, const Model& model) {
    const char* heading = model.isOneTable() ? "h1" : "h2";
    std::string html = fmt::format(
        "<section class=\"page\" id=\"{0}\">\n<{1} tabindex=\"-1\">{2}</{1}>\n"
        "<p class=\"soft small\">{3}</p>\n{4}",
        escapeXml(page.slug), heading, escapeXml(page.heading()), escapeXml(page.id),
        model.isOneTable() ? machineHtml(model) : "");
    std::string claims = claimsHtml(page, model, ClaimDetail::Full);
    if (!claims.empty()) claims = "<h3>Claims</h3>\n" + claims;
    if (!claims.empty() && model.isOneTable()) {
        claims +=
            "<details><summary>What the verdicts mean</summary>\n" + legendHtml() + "</details>\n";
    }
    const RunPart* shown = page.shown();
    if (!shown) return html + claims + "</section>\n";
    html += importedHtml(page, model);
    const std::string images = imagesHtml(page, model);
    // Of a figure, or a table of pictures, the numbers come after them.
    const bool isPicture = shown->experiment->kind == config::Experiment::Kind::Figure ||
                           !shown->experiment->shows.empty();
    if (isPicture) html += images;
    html += tableHtml(page, model);
    html += classedParagraph("small", "Printed numbers: ", shown->table.hardware);
    html += classedParagraph("small", "Remark: ", shown->table.remark);
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const std::string whose = model.isComparison() ? Model::letter(run) + ": " : "";
        for (const std::string& note : page.parts[run].table.notes) {
            html += classedParagraph("small soft", whose.c_str(), note);
        }
    }
    html += curvesHtml(page, model);
    html += claims;
    html += failuresHtml(page, model);
    if (!isPicture) html += images;
    html += assumptionsHtml(shown->experiment->assumptions, shown->table.words);
    html += againHtml(*shown, model.runs[static_cast<std::size_t>(shown - page.parts.data())]);
    html += casesHtml(page, model);
    return html + "</section>\n";
}

}  // namespace gfxrepro::report
