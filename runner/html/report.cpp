#include "runner/html/report.h"

#include <fmt/format.h>

#include "runner/core/files.h"
#include "runner/html/parts.h"
#include "runner/report/markup.h"

namespace gfxrepro::html {

namespace fs = std::filesystem;

using report::escapeXml;

namespace {

/// From page to page; shown where the script turns pages.
std::string navigationHtml(const Model& model) {
    std::string html =
        "<nav class=\"pages\" hidden><a href=\"#overview\">Overview</a>\n"
        "<a class=\"previous\">← previous</a> <a class=\"next\">next →</a>\n"
        "<select aria-label=\"page\"><option value=\"overview\">Overview</option>";
    for (const Page& page : model.pages) {
        const std::string paper = page.isOwn() ? "" : page.paper() + " · ";
        html += fmt::format("<option value=\"{}\">{}{}</option>", escapeXml(page.slug),
                            escapeXml(paper), escapeXml(page.heading()));
    }
    return html + "</select></nav>\n";
}

std::string titleOf(const Model& model) {
    if (model.isOneOwn()) return model.pages.front().title;
    std::string names;
    for (const ReportRun& run : model.runs) {
        const std::string name = fs::absolute(run.folder).lexically_normal().filename().string();
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

}  // namespace

std::string caseAnchor(std::size_t run, const std::string& caseId) {
    return fmt::format("{}-{}", Model::letter(run), caseId);
}

void writeReport(const fs::path& file, std::span<const ReportRun> runs) {
    const Model model = buildModel(runs, file);
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n"
        "<title>gfxrepro: {}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        escapeXml(titleOf(model)), kStyle);
    html += navigationHtml(model) + "<main>\n";
    // The first section is the one that the report opens with.
    if (!model.isOneOwn()) html += overviewHtml(model);
    for (const Page& page : model.pages) html += pageHtml(page, model);
    if (model.isOneOwn()) html += overviewHtml(model);
    html += fmt::format(
        "</main>\n<aside class=\"cases-shown\" hidden></aside>\n{}<script>\n{}"
        "</script>\n</body>\n</html>\n",
        kViewer, kScript);
    writeFileAtomic(file, html);
}

}  // namespace gfxrepro::html
