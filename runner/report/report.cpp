#include "runner/report/report.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "engine/core/files.h"
#include "runner/report/markup.h"
#include "runner/report/parts.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

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

std::string pageTitle(const Model& model) {
    if (model.isOneTable()) return model.pages.front().heading();
    std::string names;
    for (const ReportRun& run : model.runs) {
        const std::string name = fs::absolute(run.folder).lexically_normal().filename().string();
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

/// A folder that goes when the report is written.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "gfxrepro-report-XXXXXX").string();
        if (!::mkdtemp(name.data())) {
            throw Error(fmt::format("cannot create {}: {}", name, std::strerror(errno)));
        }
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code isLeft;
        fs::remove_all(path_, isLeft);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

}  // namespace

std::string caseAnchor(std::size_t run, const std::string& caseId) {
    return fmt::format("{}-{}", Model::letter(run), caseId);
}

void writeReport(const fs::path& file, std::span<const ReportRun> runs,
                 const ReportOptions& options) {
    std::optional<ScratchFolder> scratch;
    if (options.embeds) scratch.emplace();
    const Model model = buildModel(runs, file, options, scratch ? scratch->path() : fs::path());
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n"
        "<title>gfxrepro: {}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        escapeXml(pageTitle(model)), kStyle);
    html += navigationHtml(model) + "<main>\n";
    // The first section is the one that the report opens with.
    if (!model.isOneTable()) html += overviewHtml(model);
    for (const Page& page : model.pages) html += pageHtml(page, model);
    if (model.isOneTable()) html += overviewHtml(model);
    html += fmt::format(
        "</main>\n<aside class=\"cases-shown\" hidden></aside>\n{}<script>\n{}"
        "</script>\n</body>\n</html>\n",
        kViewer, kScript);
    writeFileAtomic(file, html);
}

}  // namespace gfxrepro::report
