#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "runner/config/schema.h"
#include "runner/html/parts.h"
#include "runner/report/markup.h"
#include "runner/report/printed_parameters.h"

namespace gfxrepro::html {

using report::ClaimResult;
using report::escapeXml;
using report::Status;
using report::Verdict;

namespace {

constexpr std::array kVerdicts = {Verdict::Holds, Verdict::Fails, Verdict::Ambiguous,
                                  Verdict::Unmeasured, Verdict::NotApplicable};

/// What the manifest says at "gl.renderer", as text; empty where it says nothing.
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

std::string processorText(const nlohmann::ordered_json& manifest) {
    const std::string cpu = manifestText(manifest, "cpu");
    const std::string cores = manifestText(manifest, "cores");
    return cores.empty() ? cpu : fmt::format("{}, {} cores", cpu, cores);
}

/// "7 real, 6 stand-ins, 12 generated" and each by name.
std::string scenesHtml(const nlohmann::ordered_json& manifest) {
    if (!manifest.is_object() || !manifest.contains("scenes")) return "";
    std::map<std::string, std::vector<std::string>> ofKind;
    const nlohmann::ordered_json& scenes = manifest["scenes"];
    for (const auto& [name, scene] : scenes.items()) {
        ofKind[manifestText(scene, "kind")].push_back(name);
    }
    std::string html;
    for (const auto& [kind, names] : ofKind) {
        html += fmt::format("{}{} {} <span class=\"soft\">({})</span>", html.empty() ? "" : "; ",
                            names.size(), escapeXml(kind),
                            escapeXml(fmt::format("{}", fmt::join(names, ", "))));
    }
    return html;
}

/// "povray (version 3.7, SHA-256 0123456789ab); scene.pov (SHA-256 …)".
std::string programsHtml(const nlohmann::ordered_json& manifest) {
    if (!manifest.is_object() || !manifest.contains("programs")) return "";
    std::string html;
    for (const nlohmann::ordered_json& program : manifest["programs"]) {
        const std::string version = manifestText(program, "version");
        html += fmt::format("{}{} <span class=\"soft\">({}SHA-256 {})</span>",
                            html.empty() ? "" : "; ", escapeXml(manifestText(program, "file")),
                            version.empty() ? "" : escapeXml(version) + ", ",
                            escapeXml(manifestText(program, "sha256").substr(0, 12)));
    }
    return html;
}

/// What ran on what: a line a fact, a column a run.
std::string factsHtml(const Model& model) {
    using Fact = std::string (*)(const ReportRun&);
    static const std::pair<const char*, Fact> kFacts[] = {
        {"Device",
         [](const ReportRun& run) {
             return escapeXml(fmt::format("{} ({})", run.context.device, run.context.deviceClass));
         }},
        {"OpenGL",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "gl.version")); }},
        {"Processor", [](const ReportRun& run) { return escapeXml(processorText(run.manifest)); }},
        {"Profile", [](const ReportRun& run) { return escapeXml(run.context.profile); }},
        {"Commit", [](const ReportRun& run) { return escapeXml(run.context.commit); }},
        {"Build",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "build")); }},
        {"Started",
         [](const ReportRun& run) { return escapeXml(manifestText(run.manifest, "started")); }},
        {"Command", [](const ReportRun& run) { return escapeXml(run.context.command); }},
        {"Scenes", [](const ReportRun& run) { return scenesHtml(run.manifest); }},
        {"Programs", [](const ReportRun& run) { return programsHtml(run.manifest); }},
        {"Notes",
         [](const ReportRun& run) {
             if (!run.manifest.is_object()) return std::string();
             const auto notes = run.manifest.value("notes", std::vector<std::string>{});
             return escapeXml(fmt::format("{}", fmt::join(notes, "; ")));
         }},
        {"Folder",
         [](const ReportRun& run) {
             return escapeXml(run.folder.lexically_normal().filename().string());
         }},
    };
    std::string html = "<div class=\"scroll\"><table class=\"facts\">\n";
    if (model.isComparison()) {
        html += "<thead><tr><th></th>";
        for (std::size_t i = 0; i < model.runs.size(); ++i) {
            html += fmt::format("<th>{}</th>", Model::letter(i));
        }
        html += "</tr></thead>\n";
    }
    html += "<tbody>\n";
    for (const auto& [name, fact] : kFacts) {
        std::string cells;
        bool isSaid = false;
        for (const ReportRun& run : model.runs) {
            const std::string text = fact(run);
            isSaid |= !text.empty();
            cells += fmt::format("<td>{}</td>", text);
        }
        if (isSaid) html += fmt::format("<tr><th scope=\"row\">{}</th>{}</tr>\n", name, cells);
    }
    return html + "</tbody></table></div>\n";
}

/// A line a run: how many of the documents' own claims have which verdict; below it the others.
std::string countsHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        std::map<Verdict, std::vector<ClaimResult>> own;
        std::vector<ClaimResult> others;
        for (const Page& page : model.pages) {
            for (const ClaimResult& claim : page.parts[run].claims) {
                (claim.isOfDocument() ? own[claim.verdict] : others).push_back(claim);
            }
        }
        html += "<p class=\"counts\">";
        if (model.isComparison()) {
            html += fmt::format("<b>{}</b> {} ", Model::letter(run),
                                escapeXml(runName(model.runs[run])));
        }
        html += own.empty() ? "No claim of a document. " : "Of the documents' own claims ";
        for (const auto& [verdict, claims] : own) {
            html += fmt::format("<span class=\"badge {}\">{}</span>", verdictName(verdict),
                                claimSummaryLine(claims));
        }
        if (!others.empty()) {
            html += fmt::format("<br><span class=\"soft\">Not counted: {}</span>",
                                originSummaryLine(others));
        }
        html += "</p>\n";
    }
    return html;
}

/// Verdicts that are not what the configs know.
std::string newsHtml(const Model& model) {
    std::string items;
    for (const Page& page : model.pages) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            for (const ClaimResult& claim : page.parts[run].claims) {
                if (!claim.isNews()) continue;
                items += fmt::format(
                    "<li>{}<a href=\"#{}\">{}</a> <strong>{}</strong> {}, known: {}</li>\n",
                    model.isComparison() ? Model::letter(run) + ": " : "", escapeXml(page.slug),
                    escapeXml(page.label), escapeXml(claim.id), verdictName(claim.verdict),
                    verdictName(claim.known));
            }
        }
    }
    if (items.empty()) return "";
    return fmt::format("<h3>What is news</h3>\n<ul>\n{}</ul>\n", items);
}

/// A line a run: how many printed numbers of tables were measured, and at the printed parameters.
std::string printedHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        report::PrintedCells count;
        for (const Page& page : model.pages) {
            const RunPart& part = page.parts[run];
            if (part.experiment) count.add(*part.experiment, part.table);
        }
        const std::string line = report::printedCellsLine(count);
        if (line.empty()) continue;
        const std::string letter =
            model.isComparison() ? fmt::format("<b>{}</b> ", Model::letter(run)) : "";
        html += fmt::format("<p class=\"parameters\">{}{}</p>\n", letter, escapeXml(line));
    }
    return html;
}

/// What the script filters the grid by; without it there is nothing to press.
std::string filtersHtml(const Model& model) {
    std::set<std::string> papers;
    for (const Page& page : model.pages) papers.insert(page.paper());
    std::string html =
        "<form class=\"filters\" hidden>\n<label>paper <select name=\"paper\">"
        "<option value=\"\">all</option>";
    for (const std::string& paper : papers) {
        html += fmt::format("<option>{}</option>", escapeXml(paper));
    }
    html +=
        "</select></label>\n<label>whose <select name=\"origin\"><option value=\"\">all</option>";
    for (const std::string_view origin : config::kOrigins) {
        html += fmt::format("<option>{}</option>", origin);
    }
    html +=
        "</select></label>\n<label>claim <input type=\"search\" name=\"text\" "
        "placeholder=\"id or words\"></label>\n<fieldset>";
    for (const Verdict verdict : kVerdicts) {
        html += fmt::format(
            "<label class=\"badge {0}\"><input type=\"checkbox\" name=\"verdict\" "
            "value=\"{0}\" checked> {0}</label>\n",
            verdictName(verdict));
    }
    html += "</fieldset>\n";
    if (model.isComparison()) {
        html += "<label><input type=\"checkbox\" name=\"differ\"> only where runs differ</label>\n";
    }
    return html + "<output></output>\n</form>\n";
}

/// One claim in one run, as a coloured link to its table.
std::string claimBadge(const ClaimResult& claim, const Page& page, const std::string& word) {
    const std::string measured =
        claim.measured.empty() ? claim.reason : fmt::format("measured {}", claim.measured);
    return fmt::format(
        "<a class=\"badge {0}{6}\" data-verdict=\"{0}\" data-origin=\"{5}\" data-text=\"{1}\" "
        "href=\"#{2}\" title=\"{3}\">{4}</a>",
        verdictName(claim.verdict), escapeXml(claim.id + ' ' + claim.text), escapeXml(page.slug),
        escapeXml(fmt::format("{}: {}; {}", verdictName(claim.verdict), claim.text, measured)),
        escapeXml(word), config::originName(claim.origin),
        claim.isOfDocument() ? "" : " uncounted");
}

std::string pageLink(const Page& page) {
    if (page.isOwn()) {
        return fmt::format("<a href=\"#{}\">{}</a>", escapeXml(page.slug), escapeXml(page.title));
    }
    return fmt::format("<a href=\"#{}\">{}</a> <span class=\"soft\">{}</span>",
                       escapeXml(page.slug), escapeXml(page.label), escapeXml(page.title));
}

/// A line a table; the claims of one device stand in it side by side.
std::string gridOfOneHtml(const Model& model) {
    std::string html =
        "<div class=\"scroll\"><table class=\"grid\"><thead><tr><th>paper</th>"
        "<th>table</th><th>claims</th></tr></thead>\n<tbody>\n";
    for (const Page& page : model.pages) {
        std::string badges;
        for (const ClaimResult& claim : page.parts.front().claims) {
            badges += claimBadge(claim, page, claim.id);
        }
        html += fmt::format("<tr data-paper=\"{0}\"><td>{0}</td><td>{1}</td><td>{2}</td></tr>\n",
                            escapeXml(page.paper()), pageLink(page), badges);
    }
    return html + "</tbody></table></div>\n";
}

const ClaimResult* findClaim(const RunPart& part, const std::string& id) {
    for (const ClaimResult& claim : part.claims) {
        if (claim.id == id) return &claim;
    }
    return nullptr;
}

/// The lines of a table's claims, a column a run.
std::string comparedClaimsHtml(const Page& page) {
    std::string html;
    std::set<std::string> done;
    for (const RunPart& any : page.parts) {
        for (const ClaimResult& claim : any.claims) {
            if (!done.insert(claim.id).second) continue;
            std::string cells;
            std::set<Verdict> verdicts;
            std::string says = claim.text;  // kept verdicts come without it
            for (const RunPart& part : page.parts) {
                const ClaimResult* result = findClaim(part, claim.id);
                if (result) verdicts.insert(result->verdict);
                if (result && says.empty()) says = result->text;
                cells += fmt::format(
                    "<td>{}</td>",
                    result ? claimBadge(*result, page, std::string(verdictName(result->verdict)))
                           : "");
            }
            html += fmt::format(
                "<tr data-paper=\"{0}\"{1}><td>{0}</td><td><a href=\"#{2}\">{3}</a></td>"
                "<td><b>{4}</b> <span class=\"soft\">{5}</span></td>{6}</tr>\n",
                escapeXml(page.paper()), verdicts.size() > 1 ? " class=\"differs\"" : "",
                escapeXml(page.slug), escapeXml(page.label), escapeXml(claim.id), escapeXml(says),
                cells);
        }
    }
    return html;
}

/// A line a claim, a column a run.
std::string gridOfSeveralHtml(const Model& model) {
    std::string html =
        "<div class=\"scroll\"><table class=\"grid\"><thead><tr><th>paper</th>"
        "<th>table</th><th>claim</th>";
    for (std::size_t i = 0; i < model.runs.size(); ++i) {
        html += fmt::format("<th title=\"{}\">{}</th>", escapeXml(runName(model.runs[i])),
                            Model::letter(i));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const Page& page : model.pages) html += comparedClaimsHtml(page);
    return html + "</tbody></table></div>\n";
}

/// Cells without a value, by table: what keeps this run from being whole.
std::string missingHtml(const Model& model) {
    std::string items;
    for (const Page& page : model.pages) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            const RunPart& part = page.parts[run];
            std::map<Status, int> counts;
            for (const report::TableRow& row : part.table.rows) {
                for (const report::Cell& cell : row.cells) {
                    if (cell.isPlanned && !cell.isOk()) ++counts[cell.status];
                }
            }
            if (counts.empty() && part.failures.empty()) continue;
            std::string what;
            for (const auto& [status, count] : counts) {
                what += fmt::format("{}{} {}", what.empty() ? "" : ", ", count, statusName(status));
            }
            if (!what.empty()) what = fmt::format("cells without a value: {}", what);
            if (!part.failures.empty()) {
                what += fmt::format("{}{} of its cases failed", what.empty() ? "" : "; ",
                                    part.failures.size());
            }
            items += fmt::format("<li>{}<a href=\"#{}\">{}</a>: {}</li>\n",
                                 model.isComparison() ? Model::letter(run) + ": " : "",
                                 escapeXml(page.slug), escapeXml(page.label), what);
        }
    }
    if (items.empty()) return "<p class=\"soft\">Nothing is missing: every case finished.</p>\n";
    return fmt::format("<h3>What is missing</h3>\n<ul>\n{}</ul>\n", items);
}

}  // namespace

std::string verdictBadge(Verdict verdict) {
    return fmt::format("<span class=\"badge {0}\">{0}</span>", verdictName(verdict));
}

std::string runName(const ReportRun& run) {
    return fmt::format("{}, {}", run.context.profile, run.context.device);
}

std::string overviewHtml(const Model& model) {
    const bool isOwn = std::ranges::all_of(model.pages, &Page::isOwn);
    const std::string title = model.isOneOwn() ? escapeXml(model.pages.front().title)
                              : isOwn          ? "Experiments"
                                               : "Published tables, measured again";
    const bool hasClaims = std::ranges::any_of(model.pages, [](const Page& page) {
        return std::ranges::any_of(page.parts,
                                   [](const RunPart& part) { return !part.claims.empty(); });
    });
    return fmt::format("<section class=\"page\" id=\"overview\">\n<h1>{}</h1>\n", title) +
           (isOwn && !hasClaims ? "" : countsHtml(model)) + printedHtml(model) +
           filtersHtml(model) +
           (model.isComparison() ? gridOfSeveralHtml(model) : gridOfOneHtml(model)) +
           newsHtml(model) + missingHtml(model) + "<h3>What ran on what</h3>\n" + factsHtml(model) +
           "</section>\n";
}

}  // namespace gfxrepro::html
