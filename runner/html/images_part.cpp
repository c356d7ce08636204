#include <fmt/format.h>

#include "runner/html/parts.h"
#include "runner/report/markup.h"

namespace gfxrepro::html {

using report::escapeXml;

namespace {

/// Where a page opens an image: the viewer reads what it needs from the data attributes.
std::string shotHtml(const Shot& shot, std::size_t run, bool isComparison) {
    std::string data =
        fmt::format(" data-run=\"{}\" data-case=\"{}\" data-title=\"{}\" data-name=\"{}\"",
                    isComparison ? Model::letter(run) : "", escapeXml(shot.caseId),
                    escapeXml(shot.caseTitle), escapeXml(shot.name));
    if (!shot.full.empty()) data += fmt::format(" data-full=\"{}\"", shot.full);
    if (!shot.truth.empty()) data += fmt::format(" data-truth=\"{}\"", escapeXml(shot.truth));
    if (!shot.flip.empty()) data += fmt::format(" data-flip=\"{}\"", shot.flip);
    std::string caption = escapeXml(shot.name);
    if (!shot.flip.empty()) {
        caption += fmt::format(" <span class=\"soft\">FLIP {:.4f} to {}</span>", shot.flipMean,
                               escapeXml(shot.truth));
    }
    return fmt::format(
        "<figure><button class=\"shot\"{}><img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\" "
        "loading=\"lazy\"></button><figcaption>{}</figcaption></figure>\n",
        data, shot.thumbnail, escapeXml(shot.caseTitle + " · " + shot.name), shot.width,
        shot.height, caption);
}

/// "scene=models/duck" of "zju2005/2.1 scene=models/duck": the page says the table.
std::string withoutTable(const std::string& title, const std::string& table) {
    return title.starts_with(table + ' ') ? title.substr(table.size() + 1) : title;
}

}  // namespace

std::string imagesHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        std::string caseId;
        for (const Shot& shot : page.parts[run].shots) {
            if (shot.caseId != caseId) {
                html += fmt::format("{}<h4>{}{}</h4>\n<div class=\"gallery\">\n",
                                    caseId.empty() ? "" : "</div>\n",
                                    model.isComparison() ? Model::letter(run) + ": " : "",
                                    escapeXml(withoutTable(shot.caseTitle, page.id)));
                caseId = shot.caseId;
            }
            html += shotHtml(shot, run, model.isComparison());
        }
        if (!caseId.empty()) html += "</div>\n";
    }
    return html.empty() ? "" : "<h3>Images</h3>\n" + html;
}

std::string casesHtml(const Page& page, const Model& model) {
    std::string html;
    std::size_t count = 0;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        for (const ReportCase* item : page.parts[run].cases) {
            ++count;
            html += fmt::format(
                "<article class=\"case\" id=\"{}\"><h4>{}{} <span class=\"soft\">case {}</span>"
                "</h4>\n<pre class=\"command\">{}</pre>\n",
                escapeXml(caseAnchor(run, item->id)),
                model.isComparison() ? Model::letter(run) + ": " : "",
                escapeXml(withoutTable(item->title, page.id)), escapeXml(item->id),
                escapeXml(item->command));
            std::string log;
            for (const std::string& line : item->log) log += escapeXml(line) + '\n';
            html += fmt::format("<pre class=\"log\">{}</pre></article>\n",
                                log.empty() ? "not run" : log);
        }
    }
    if (html.empty()) return "";
    return fmt::format(
        "<details class=\"cases\"><summary>Cases: {}, each with the command that runs it again and "
        "its log</summary>\n{}</details>\n",
        count, html);
}

}  // namespace gfxrepro::html
