#include <fmt/format.h>

#include "runner/html/parts.h"
#include "runner/report/markup.h"

namespace gfxrepro::html {

using report::escapeXml;

namespace {

std::string paragraph(const char* cssClass, const char* label, const std::string& text) {
    if (text.empty()) return "";
    return fmt::format("<p class=\"{}\"><span class=\"soft\">{}</span>{}</p>\n", cssClass, label,
                       escapeXml(text));
}

/// Every claim of any run, in the first run's order.
std::vector<const report::ClaimResult*> claimsOf(const Page& page) {
    std::vector<const report::ClaimResult*> claims;
    for (const RunPart& part : page.parts) {
        for (const report::ClaimResult& claim : part.claims) {
            bool isKnown = false;
            for (const report::ClaimResult* known : claims) isKnown |= known->id == claim.id;
            if (!isKnown) claims.push_back(&claim);
        }
    }
    return claims;
}

/// Whose claim it is, and of a time what kind.
std::string whoseHtml(const report::ClaimResult& claim) {
    std::string html(config::originName(claim.origin));
    if (claim.timeKind) html += fmt::format(", {}", config::timeKindName(*claim.timeKind));
    return html;
}

std::string requiredHtml(const report::ClaimResult& claim) {
    std::string html = escapeXml(claim.required);
    if (claim.boundFrom) {
        const std::string_view source = config::boundSourceName(*claim.boundFrom);
        html += fmt::format(" <span class=\"soft\">({})</span>", source);
    }
    return html;
}

std::string newsHtml(const report::ClaimResult& claim) {
    if (!claim.isNews()) return "";
    return fmt::format(" <span class=\"news\" title=\"known: {}\">news</span>",
                       verdictName(claim.known));
}

/// What the judging noted, and the known cause.
std::string whyHtml(const report::ClaimResult& claim) {
    const std::string cause =
        claim.because.empty()
            ? ""
            : fmt::format("{}{}",
                          claim.verdict == claim.known
                              ? ""
                              : fmt::format("Where it is {}: ", verdictName(claim.known)),
                          escapeXml(claim.because));
    return escapeXml(claim.reason) + (claim.reason.empty() || cause.empty() ? "" : ". ") + cause;
}

std::string claimsHtml(const Page& page, const Model& model) {
    const auto claims = claimsOf(page);
    if (claims.empty()) return "";
    std::string html =
        "<h3>Claims</h3>\n<div class=\"scroll\"><table class=\"claims\"><thead><tr>"
        "<th>claim</th>";
    if (model.isComparison()) html += "<th>run</th>";
    html +=
        "<th>verdict</th><th>whose</th><th>what it says</th><th>required</th><th>measured</th>"
        "<th>why</th><th>rests on</th></tr></thead>\n<tbody>\n";
    for (const report::ClaimResult* claim : claims) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            for (const report::ClaimResult& result : page.parts[run].claims) {
                if (result.id != claim->id) continue;
                html += fmt::format("<tr><td class=\"id\">{}</td>", escapeXml(result.id));
                if (model.isComparison()) html += fmt::format("<td>{}</td>", Model::letter(run));
                html += fmt::format(
                    "<td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"measured\">{}</td>"
                    "<td class=\"soft\">{}</td><td class=\"soft\">{}</td></tr>\n",
                    verdictBadge(result.verdict), newsHtml(result), whoseHtml(result),
                    escapeXml(result.text), requiredHtml(result), escapeXml(result.measured),
                    whyHtml(result), escapeXml(result.restsOn));
            }
        }
    }
    return html + "</tbody></table></div>\n";
}

std::string assumptionsHtml(const std::vector<config::Assumption>& assumptions) {
    if (assumptions.empty()) return "";
    std::string html =
        "<h3>Assumptions</h3>\n<div class=\"scroll\"><table class=\"claims\"><thead><tr>"
        "<th>what the paper left open</th><th>taken</th><th>range</th><th>why</th></tr></thead>\n"
        "<tbody>\n";
    for (const config::Assumption& assumption : assumptions) {
        const auto text = [](const config::Node& node) {
            return node.isNull() ? ""
                                 : escapeXml(node.isScalar() ? node.text() : node.toFlowText());
        };
        const std::string unit = assumption.unit.empty() ? "" : ' ' + escapeXml(assumption.unit);
        html +=
            fmt::format("<tr><td class=\"id\">{}</td><td>{}{}</td><td>{}</td><td>{}</td></tr>\n",
                        escapeXml(assumption.name), text(assumption.value),
                        assumption.value.isNull() ? "" : unit, text(assumption.range),
                        escapeXml(assumption.why));
    }
    return html + "</tbody></table></div>\n";
}

std::string curvesHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        for (const Curve& curve : page.parts[run].curves) {
            const std::string caption =
                fmt::format("{}{} <span class=\"soft\">{}{}</span>",
                            model.isComparison() ? Model::letter(run) + ": " : "",
                            escapeXml(curve.title), escapeXml(curve.script),
                            curve.problem.empty() ? "" : ": " + escapeXml(curve.problem));
            html += fmt::format("<figure class=\"curve\">{}<figcaption>{}</figcaption></figure>\n",
                                curve.svg, caption);
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
                report::statusName(failure.status), failure.message.empty() ? "" : " — ",
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
    const report::ReportContext& context = run.context;
    if (isImported(run)) {
        return fmt::format("<h3>Import it again</h3>\n<pre>{}</pre>\n", escapeXml(context.command));
    }
    const bool isOwn = part.experiment->kind == config::Experiment::Kind::Sweep;
    return fmt::format("<h3>Run it again</h3>\n<pre>gfxrepro reproduce {} --profile {}</pre>\n",
                       escapeXml(isOwn ? part.experiment->file.string() : part.table.id),
                       escapeXml(context.profile));
}

}  // namespace

std::string pageHtml(const Page& page, const Model& model) {
    std::string html = fmt::format(
        "<section class=\"page\" id=\"{}\">\n<h2>{}</h2>\n<p class=\"soft small\">{}</p>\n",
        escapeXml(page.slug), escapeXml(page.heading()), escapeXml(page.id));
    const RunPart* shown = page.shown();
    if (!shown) return html + claimsHtml(page, model) + "</section>\n";
    html += importedHtml(page, model);
    html += tableHtml(page, model);
    html += paragraph("small", "Printed numbers: ", shown->table.hardware);
    html += paragraph("small", "Remark: ", shown->table.remark);
    for (const std::string& note : shown->table.notes) html += paragraph("small soft", "", note);
    html += curvesHtml(page, model);
    html += claimsHtml(page, model);
    html += failuresHtml(page, model);
    html += imagesHtml(page, model);
    html += assumptionsHtml(shown->experiment->assumptions);
    html += againHtml(*shown, model.runs[static_cast<std::size_t>(shown - page.parts.data())]);
    html += casesHtml(page, model);
    return html + "</section>\n";
}

}  // namespace gfxrepro::html
