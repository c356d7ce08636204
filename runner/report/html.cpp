#include "runner/report/html.h"

#include <fmt/format.h>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "runner/core/files.h"
#include "runner/report/markup.h"
#include "runner/report/report.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

/// Beyond this the images stay files of their own: browsers open larger pages badly.
constexpr std::uintmax_t kEmbeddedImagesBytes = 20'000'000;

/// What manifest.json says at "gl.renderer", as text; empty where it says nothing.
std::string manifestText(const nlohmann::ordered_json& manifest, const std::string& path) {
    const nlohmann::ordered_json* node = &manifest;
    std::string_view rest = path;
    while (!rest.empty()) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const std::string key(rest.substr(0, dot));
        if (!node->is_object() || !node->contains(key)) return "";
        node = &(*node)[key];
        rest.remove_prefix(std::min(dot + 1, rest.size()));
    }
    return node->is_string() ? node->get<std::string>() : node->dump();
}

std::string factsHtml(const ReportContext& context, const nlohmann::ordered_json& manifest) {
    const std::vector<std::pair<std::string, std::string>> facts = {
        {"Device", fmt::format("{} ({})", context.device, context.deviceClass)},
        {"OpenGL", manifestText(manifest, "gl.version")},
        {"Processor", manifestText(manifest, "cpu")},
        {"Profile", context.profile},
        {"Commit", context.commit},
        {"Build", manifestText(manifest, "build")},
        {"Started", manifestText(manifest, "started")},
        {"Command", context.command},
    };
    std::string html = "<dl class=\"facts\">\n";
    for (const auto& [name, value] : facts) {
        if (value.empty()) continue;
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escapeXml(value));
    }
    return html + "</dl>\n";
}

std::string countsHtml(const std::vector<ReportSection>& sections) {
    std::map<Verdict, std::vector<ClaimResult>> alike;
    for (const ReportSection& section : sections) {
        for (const ClaimResult& claim : section.claims) alike[claim.verdict].push_back(claim);
    }
    std::string html = "<p class=\"counts\">";
    if (alike.empty()) html += "No claims.";
    for (const auto& [verdict, claims] : alike) {
        html += fmt::format("<span class=\"badge {}\">{}</span>", verdictName(verdict),
                            claimSummaryLine(claims));
    }
    return html + "</p>\n";
}

/// "zju2005" of "zju2005/2.1".
std::string paperOf(const std::string& table) {
    return table.substr(0, table.find('/'));
}

/// One line a table, its claims as coloured links; grouped by paper.
std::string gridHtml(const std::vector<ReportSection>& sections) {
    std::string html =
        "<div class=\"scroll\"><table class=\"grid\"><thead><tr><th>paper</th>"
        "<th>table</th><th>claims</th></tr></thead>\n<tbody>\n";
    std::string paper;
    for (const ReportSection& section : sections) {
        const std::string anchor = escapeXml(sectionAnchor(section));
        const std::string here = paperOf(section.table->id);
        std::string badges;
        for (const ClaimResult& claim : section.claims) {
            badges += fmt::format(
                "<a class=\"badge {}\" href=\"#{}\" title=\"{}\">{}</a>",
                verdictName(claim.verdict), anchor,
                escapeXml(fmt::format("{}: {}", verdictName(claim.verdict), claim.text)),
                escapeXml(claim.id));
        }
        html += fmt::format(
            "<tr><td>{}</td><td><a href=\"#{}\">{}</a> <span class=\"soft\">{}</span></td>"
            "<td>{}</td></tr>\n",
            here == paper ? "" : escapeXml(here), anchor, escapeXml(section.table->label),
            escapeXml(section.table->title), badges);
        paper = here;
    }
    return html + "</tbody></table></div>\n";
}

/// Cells without a value, by table: what keeps this run from being whole.
std::string missingHtml(const std::vector<ReportSection>& sections) {
    std::string items;
    for (const ReportSection& section : sections) {
        std::map<Status, int> counts;
        for (const TableRow& row : section.table->rows) {
            for (const Cell& cell : row.cells) {
                if (cell.isPlanned && !cell.isOk()) ++counts[cell.status];
            }
        }
        if (counts.empty() && section.failures.empty()) continue;
        std::string what;
        for (const auto& [status, count] : counts) {
            what += fmt::format("{}{} {}", what.empty() ? "" : ", ", count, statusName(status));
        }
        if (!what.empty()) what = fmt::format("cells without a value: {}", what);
        if (!section.failures.empty()) {
            what += fmt::format("{}{} of its cases failed", what.empty() ? "" : "; ",
                                section.failures.size());
        }
        items +=
            fmt::format("<li><a href=\"#{}\">{}</a>: {}</li>\n", escapeXml(sectionAnchor(section)),
                        escapeXml(section.table->label), what);
    }
    if (items.empty()) return "<p class=\"soft\">Nothing is missing: every case finished.</p>\n";
    return fmt::format("<h3>What is missing</h3>\n<ul>\n{}</ul>\n", items);
}

/// The cases of a table whose last record of a process is no measurement.
std::vector<ReportSection::Failure> failuresOf(const std::string& table,
                                               const std::vector<Record>& records) {
    std::map<std::pair<std::string, int>, const Record*> last;
    std::vector<std::pair<std::string, int>> order;
    for (const Record& record : records) {
        if (record.table != table || record.isControl()) continue;
        const auto key = std::make_pair(record.caseId, record.process);
        if (!last.contains(key)) order.push_back(key);
        last[key] = &record;
    }
    std::vector<ReportSection::Failure> failures;
    for (const auto& key : order) {
        const Record& record = *last[key];
        if (record.status == Status::Ok) continue;
        std::string name = record.scene;
        if (!record.method.empty()) name += (name.empty() ? "" : ", ") + record.method;
        failures.push_back({fmt::format("{} (case {})", name.empty() ? table : name, record.caseId),
                            record.status, record.message});
    }
    return failures;
}

std::uintmax_t imagesBytes(const fs::path& runDir, const std::vector<ImageEntry>& images) {
    std::uintmax_t total = 0;
    for (const ImageEntry& image : images) {
        std::error_code isAbsent;
        const std::uintmax_t size = fs::file_size(runDir / image.png, isAbsent);
        if (!image.png.empty() && !isAbsent) total += size;
    }
    return total;
}

}  // namespace

std::string verdictBadge(Verdict verdict) {
    return fmt::format("<span class=\"badge {0}\">{0}</span>", verdictName(verdict));
}

std::string summaryHtml(const std::vector<ReportSection>& sections, const ReportContext& context,
                        const nlohmann::ordered_json& manifest) {
    return "<h1>Published tables, measured again</h1>\n" + factsHtml(context, manifest) +
           countsHtml(sections) + gridHtml(sections) + missingHtml(sections);
}

void writeReport(const fs::path& runDir, const std::vector<config::Experiment>& experiments,
                 const std::vector<Record>& records, const nlohmann::ordered_json& manifest,
                 const ReportContext& context) {
    const std::vector<Table> tables = buildTables(experiments, records);
    const std::vector<ImageEntry> images = readImages(runDir);
    const bool embedsImages = imagesBytes(runDir, images) <= kEmbeddedImagesBytes;
    std::vector<ReportSection> sections;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        ReportSection section;
        section.experiment = &experiments[i];
        section.table = &tables[i];
        section.claims = evaluateClaims(experiments[i], tables[i], context);
        for (const ImageEntry& image : images) {
            if (image.table == experiments[i].id) section.images.push_back(image);
        }
        section.failures = failuresOf(experiments[i].id, records);
        sections.push_back(std::move(section));
    }
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>gfxrepro: {}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n",
        escapeXml(runDir.lexically_normal().filename().string()), reportStyle());
    html += summaryHtml(sections, context, manifest);
    for (const ReportSection& section : sections) {
        html += sectionHtml(section, context, runDir, embedsImages);
    }
    writeFileAtomic(runDir / "report.html", html + "</main>\n</body>\n</html>\n");
}

}  // namespace gfxrepro::report
