// The first screen: what ran on what, what of each document reproduced, and every claim in words.
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "engine/core/text.h"
#include "engine/image/png_io.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/tables/printed.h"

namespace gfxrepro::report {

using claims::ClaimResult;
using claims::Verdict;
using records::Status;

// What ran on what.

namespace {

using Json = nlohmann::ordered_json;

/// What the manifest says at "/gl/renderer", as text; empty where it says nothing.
std::string manifestText(const Json& manifest, const std::string& path) {
    const Json::json_pointer place(path);
    if (!manifest.contains(place)) return "";
    const Json& node = manifest[place];
    return node.is_string() ? node.get<std::string>() : node.dump();
}

std::string processorText(const Json& manifest) {
    const std::string cpu = manifestText(manifest, "/cpu");
    const std::string cores = manifestText(manifest, "/cores");
    return cores.empty() || cores == "0" ? cpu : fmt::format("{}, {} cores", cpu, cores);
}

/// "llvmpipe (LLVM 15.0.6, 256 bits) on Intel Xeon, 2 cores · quick profile · 2026-11-25".
std::string machineText(const ReportRun& run) {
    std::string text = run.context.device;
    if (const std::string cpu = processorText(run.manifest); !cpu.empty()) text += " on " + cpu;
    text += fmt::format(" · {} profile", run.context.profile);
    const std::string started = manifestText(run.manifest, "/started");
    if (!started.empty()) text += " · " + started.substr(0, started.find('T'));
    if (!run.context.commit.empty()) text += " · commit " + run.context.commit;
    return text;
}

/// "112 tables, 903 cases"; nothing of a run of which only verdicts are at hand.
std::string sizeText(const ReportRun& run) {
    if (run.experiments.empty()) return "";
    const auto counted = [](std::size_t count, const char* one, const char* several) {
        return fmt::format("{} {}", count, count == 1 ? one : several);
    };
    std::string text = counted(run.experiments.size(), "experiment", "experiments");
    if (!run.cases.empty()) text += ", " + counted(run.cases.size(), "case", "cases");
    return text;
}

/// "7 real; 6 in the place of models that were not at hand; 12 generated" and each by name.
std::string scenesHtml(const Json& manifest) {
    if (!manifest.is_object() || !manifest.contains("scenes")) return "";
    std::map<std::string, std::vector<std::string>> ofKind;
    const Json& scenes = manifest["scenes"];
    for (const auto& [name, scene] : scenes.items()) {
        ofKind[manifestText(scene, "/kind")].push_back(name);
    }
    std::string html;
    for (const auto& [kind, names] : ofKind) {
        const bool isStandIn = kind == "stand-in";
        html += fmt::format(
            "{}{} {} <span class=\"soft\">({})</span>", html.empty() ? "" : "; ", names.size(),
            isStandIn ? "in the place of models that were not at hand" : escapeXml(kind),
            escapeXml(joined(names)));
    }
    return html;
}

/// "povray (version 3.7, SHA-256 0123456789ab); scene.pov (SHA-256 …)".
std::string programsHtml(const Json& manifest) {
    if (!manifest.is_object() || !manifest.contains("programs")) return "";
    std::string html;
    for (const Json& program : manifest["programs"]) {
        const std::string version = manifestText(program, "/version");
        html += fmt::format("{}{} <span class=\"soft\">({}SHA-256 {})</span>",
                            html.empty() ? "" : "; ", escapeXml(manifestText(program, "/file")),
                            version.empty() ? "" : escapeXml(version) + ", ",
                            escapeXml(manifestText(program, "/sha256").substr(0, 12)));
    }
    return html;
}

/// A line a run: how many printed numbers of tables were measured, and at the printed parameters.
std::string printedHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        tables::PrintedCells count;
        for (const Page& page : model.pages) {
            const RunPart& part = page.parts[run];
            if (part.experiment) count.add(*part.experiment, part.table);
        }
        const std::string line = tables::printedCellsLine(count);
        if (line.empty()) continue;
        html += fmt::format("<p class=\"parameters\">{}{}</p>\n", model.boldLetter(run),
                            escapeXml(line));
    }
    return html;
}

/// A run's facts by their names, the same of each run; empty where it does not say.
std::vector<std::pair<const char*, std::string>> factsOf(const ReportRun& run) {
    const Json& manifest = run.manifest;
    const auto linesOf = [&](const char* key) {
        return manifest.is_object() ? manifest.value(key, std::vector<std::string>{})
                                    : std::vector<std::string>();
    };
    const claims::ReportContext& context = run.context;
    return {{"Device", escapeXml(fmt::format("{} ({})", context.device, context.deviceClass))},
            {"OpenGL", escapeXml(manifestText(manifest, "/gl/version"))},
            {"Processor", escapeXml(processorText(manifest))},
            {"Profile", escapeXml(context.profile)},
            {"Commit", escapeXml(context.commit)},
            {"Build", escapeXml(manifestText(manifest, "/build"))},
            {"Started", escapeXml(manifestText(manifest, "/started"))},
            {"Command", escapeXml(context.command)},
            {"Scenes", scenesHtml(manifest)},
            {"Programs", programsHtml(manifest)},
            {"Notes", escapeXml(joined(linesOf("notes"), "; "))},
            {"Warnings", escapeXml(joined(linesOf("warnings"), "; "))},
            {"Folder", escapeXml(run.folder.lexically_normal().filename().string())}};
}

/// What ran on what: a line a fact, a column a run.
std::string factsHtml(const Model& model) {
    std::string html = "<div class=\"scroll\"><table class=\"facts\">\n";
    if (model.isComparison()) {
        html += "<thead><tr><td></td>";
        for (std::size_t i = 0; i < model.runs.size(); ++i) {
            html += fmt::format("<th scope=\"col\">{}</th>", Model::letter(i));
        }
        html += "</tr></thead>\n";
    }
    html += "<tbody>\n";
    std::vector<std::string> lines;
    std::vector<bool> areSaid;
    for (const ReportRun& run : model.runs) {
        const auto facts = factsOf(run);
        lines.resize(facts.size());
        areSaid.resize(facts.size());
        for (std::size_t i = 0; i < facts.size(); ++i) {
            if (lines[i].empty())
                lines[i] = fmt::format("<th scope=\"row\">{}</th>", facts[i].first);
            lines[i] += fmt::format("<td>{}</td>", facts[i].second);
            if (!facts[i].second.empty()) areSaid[i] = true;
        }
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (areSaid[i]) html += fmt::format("<tr>{}</tr>\n", lines[i]);
    }
    return html + "</tbody></table></div>\n";
}

}  // namespace

// What reproduced and what did not, and every claim.

namespace {

constexpr std::array kVerdicts = {Verdict::Holds, Verdict::Fails, Verdict::Ambiguous,
                                  Verdict::Unmeasured, Verdict::NotApplicable};
/// More examples than these are no summary.
constexpr std::size_t kExamples = 2;

using Counts = std::map<Verdict, std::size_t>;

std::size_t countOf(const Counts& counts, Verdict verdict) {
    const auto found = counts.find(verdict);
    return found == counts.end() ? 0 : found->second;
}

std::size_t sumOf(const Counts& counts) {
    std::size_t sum = 0;
    for (const auto& [verdict, count] : counts) sum += count;
    return sum;
}

/// The verdicts of one run on such claims.
Counts countClaims(const std::vector<const Page*>& pages, std::size_t run,
                   const std::function<bool(const ClaimResult&)>& isSuch) {
    Counts counts;
    for (const Page* page : pages) {
        for (const ClaimResult& claim : page->parts[run].claims) {
            if (isSuch(claim)) ++counts[claim.verdict];
        }
    }
    return counts;
}

/// "2 hold", "1 ambiguous".
std::string countText(Verdict verdict, std::size_t count) {
    const std::string word = verdict == Verdict::Holds && count != 1 ? "hold"
                             : verdict == Verdict::Fails && count != 1
                                 ? "fail"
                                 : std::string(verdictName(verdict));
    return fmt::format("{} {}", count, word);
}

/// "9 hold · 2 fail · 1 ambiguous".
std::string countsText(const Counts& counts) {
    std::vector<std::string> parts;
    for (const Verdict verdict : kVerdicts) {
        const std::size_t count = countOf(counts, verdict);
        if (count > 0) parts.push_back(countText(verdict, count));
    }
    return joined(parts, " · ");
}

/// The shares as lengths; each names itself by its sign, number and word, as far as it has room.
std::string tallyHtml(const Counts& counts) {
    std::string html =
        fmt::format("<div class=\"tally\" role=\"img\" aria-label=\"{}\">", countsText(counts));
    for (const Verdict verdict : kVerdicts) {
        const std::size_t count = countOf(counts, verdict);
        if (count == 0) continue;
        html += fmt::format("<span class=\"{}\" style=\"flex-grow:{}\">{} {}</span>",
                            verdictName(verdict), count, verdictSign(verdict),
                            countText(verdict, count));
    }
    return html + "</div>\n";
}

/// The first claims of that verdict, one a chapter first.
std::vector<std::pair<const Page*, const ClaimResult*>> examples(const DocumentPages& document,
                                                                 Verdict verdict) {
    std::vector<std::pair<const Page*, const ClaimResult*>> first, further;
    for (const DocumentPages::ChapterPages& chapter : document.chapters) {
        bool isFirst = true;
        for (const Page* page : chapter.pages) {
            for (const ClaimResult& claim : page->parts.front().claims) {
                const bool isMeant = claim.isCounted() && claim.verdict == verdict;
                // A sentence that goes on from the one before says nothing alone.
                if (!isMeant || claim.text.empty() || claim.text.starts_with("…")) continue;
                (isFirst ? first : further).emplace_back(page, &claim);
                isFirst = false;
            }
        }
    }
    first.insert(first.end(), further.begin(), further.end());
    if (first.size() > kExamples) first.resize(kExamples);
    return first;
}

std::string titledLink(const Page& page) {
    const std::string rest = page.isOwn() ? "" : fmt::format(" {}", escapeXml(page.title));
    return fmt::format("<a href=\"#{}\">{}</a>{}", escapeXml(page.slug),
                       escapeXml(page.isOwn() ? page.title : page.label), rest);
}

/// Statements alone do not say of what they speak: before each stands its table's title.
std::string examplesHtml(const DocumentPages& document, Verdict verdict) {
    std::string html;
    for (const auto& [page, claim] : examples(document, verdict)) {
        html += fmt::format("<li>{} {}: “{}”</li>\n", verdictBadge(verdict), titledLink(*page),
                            escapeXml(claim->text));
    }
    return html;
}

/// What one could judge, what of it holds, and what does not.
std::string paragraphHtml(const DocumentPages& document, const Counts& own) {
    const std::size_t holding = countOf(own, Verdict::Holds);
    const std::size_t failing = countOf(own, Verdict::Fails);
    const std::size_t untold = countOf(own, Verdict::Ambiguous) + countOf(own, Verdict::Unmeasured);
    const std::size_t elsewhere = countOf(own, Verdict::NotApplicable);
    std::string html = fmt::format(
        "Of {} statement{} of the document, {} could be judged here: <strong>{} hold{}</strong>, "
        "<strong>{} fail{}</strong>. ",
        sumOf(own), sumOf(own) == 1 ? "" : "s", holding + failing, holding, holding == 1 ? "s" : "",
        failing, failing == 1 ? "s" : "");
    const std::size_t inPart = countOf(
        countClaims(
            document.pages(), 0,
            [](const ClaimResult& claim) { return claim.isCounted() && !claim.holdsOn.empty(); }),
        Verdict::Fails);
    if (inPart > 0) {
        html += fmt::format("Of those that fail, {} hold{} on some of the scenes. ", inPart,
                            inPart == 1 ? "s" : "");
    }
    const std::size_t resting =
        countOf(countClaims(document.pages(), 0,
                            [](const ClaimResult& claim) {
                                return claim.isCounted() && claim.restsOnAssumption();
                            }),
                Verdict::Holds);
    if (resting > 0) {
        html += fmt::format(
            "Of those that hold, {} rest{} on a value of ours that the document "
            "leaves open. ",
            resting, resting == 1 ? "s" : "");
    }
    if (untold > 0) html += fmt::format("Of {} the numbers do not tell. ", untold);
    if (elsewhere > 0) html += fmt::format("{} ask for a GPU or another profile. ", elsewhere);
    if (holding > kExamples || failing > kExamples) html += "Among those that were judged:";
    html = fmt::format("<p>{}</p>\n", html);
    const std::string examples =
        examplesHtml(document, Verdict::Holds) + examplesHtml(document, Verdict::Fails);
    if (examples.empty()) return html;
    return html + "<ul class=\"examples\">\n" + examples + "</ul>\n";
}

std::string chaptersHtml(const DocumentPages& document) {
    if (document.chapters.size() < 2) return "";
    std::string html;
    for (const DocumentPages::ChapterPages& chapter : document.chapters) {
        const Counts own = countClaims(chapter.pages, 0, &ClaimResult::isCounted);
        if (own.empty()) continue;
        html +=
            fmt::format("<li><span>{}</span>{}</li>\n", escapeXml(chapter.title), tallyHtml(own));
    }
    return html.empty() ? "" : "<ul class=\"chapters\">\n" + html + "</ul>\n";
}

/// The mean difference of their PNGs' values below the run's folder; 1 where the sizes differ.
double shotDifference(const std::filesystem::path& runFolder, const Shot& a, const Shot& b) {
    const image::Image16 first = image::readPng16(runFolder / a.png);
    const image::Image16 second = image::readPng16(runFolder / b.png);
    if (first.width() != second.width() || first.height() != second.height() ||
        first.channels() != second.channels()) {
        return 1.0;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < first.values().size(); ++i) {
        sum += std::abs(int{first.values()[i]} - int{second.values()[i]});
    }
    return sum / (65535.0 * static_cast<double>(std::max<std::size_t>(first.values().size(), 1)));
}

std::string highlightsHtml(const DocumentPages& document, const Model& model) {
    std::string html;
    const auto difference = [&](std::size_t run, const Shot& a, const Shot& b) {
        return shotDifference(model.runs[run].folder, a, b);
    };
    for (const Highlight& one : highlightsOf(document.pages(), difference)) {
        html += fmt::format(
            "<figure><a href=\"#{0}\"><img src=\"{1}\" alt=\"{2}\" width=\"{3}\" "
            "height=\"{4}\"></a><figcaption>{5} {6} {7}</figcaption>"
            "</figure>\n",
            escapeXml(one.page->slug), smallPicture(*one.shot, model.places[one.run]),
            escapeXml(one.shot->caseTitle + " · " + one.shot->name), one.shot->width,
            one.shot->height, verdictBadge(one.claim->verdict), escapeXml(one.claim->text),
            pageLink(*one.page));
    }
    return html.empty() ? "" : "<div class=\"highlights\">\n" + html + "</div>\n";
}

/// What of a document reproduced: a bar, a paragraph, a bar for each chapter, how near its numbers
/// come, pictures.
std::string documentHtml(const DocumentPages& document, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        const Counts own = countClaims(document.pages(), run, &ClaimResult::isCounted);
        const Counts others =
            countClaims(document.pages(), run, std::not_fn(&ClaimResult::isCounted));
        if (own.empty() && others.empty()) continue;
        if (model.isComparison()) {
            html += fmt::format("<p><b>{}</b> {}</p>\n", Model::letter(run),
                                escapeXml(fmt::format("{}, {}", model.runs[run].context.profile,
                                                      model.runs[run].context.device)));
        }
        if (!own.empty()) {
            html += tallyHtml(own);
            if (run == 0) html += paragraphHtml(document, own);
        }
        if (!others.empty()) {
            html += fmt::format(
                "<p class=\"soft small\">Not counted: what the document does not state, what can "
                "hardly fail, what holds on part of its rows, and what says the same as another: "
                "{}.</p>\n",
                countsText(others));
        }
    }
    std::string near;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        near += nearnessHtml(document, model, run);
    }
    if (html.empty() && near.empty()) return "";
    if (!model.isComparison()) html += chaptersHtml(document);
    if (!near.empty()) {
        html = fmt::format("<div class=\"beside\">\n<div>\n{}</div>\n<div>\n{}</div>\n</div>\n",
                           html, near);
    }
    return fmt::format("<section class=\"document\">\n<h2>{}{}</h2>\n{}{}</section>\n",
                       escapeXml(document.id),
                       document.title.empty() ? "" : fmt::format(". {}", escapeXml(document.title)),
                       html, highlightsHtml(document, model));
}

/// Every table with its claims in words, chapter by chapter.
std::string saidHtml(const Model& model) {
    const std::vector<DocumentPages> documents = model.byDocument();
    std::string html = "<div class=\"said\">\n";
    for (const DocumentPages& document : documents) {
        for (const DocumentPages::ChapterPages& chapter : document.chapters) {
            html += fmt::format("<section class=\"chapter\" data-paper=\"{}\">\n",
                                escapeXml(document.id));
            std::string title = chapter.title;
            if (documents.size() > 1 || title.empty()) {
                title = title.empty() ? document.id : fmt::format("{} · {}", document.id, title);
            }
            if (!model.isOneTable()) html += fmt::format("<h3>{}</h3>\n", escapeXml(title));
            for (const Page* page : chapter.pages) {
                html +=
                    fmt::format("<div class=\"of-page\" data-text=\"{}\">\n<h4>{}</h4>\n{}</div>\n",
                                escapeXml(page->label + ' ' + page->title), titledLink(*page),
                                claimsHtml(*page, model, ClaimDetail::Short));
            }
            html += "</section>\n";
        }
    }
    return html + "</div>\n";
}

/// What became of each number of two runs: what is not the same, and the others folded.
std::string comparedHtml(const Model& model) {
    if (model.comparedInAll.empty()) return "";
    const auto rowsOf = [&](bool isAlarm) {
        std::string rows;
        for (const ComparedNumber& one : model.compared) {
            if (one.isAlarm != isAlarm) continue;
            rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n",
                                escapeXml(one.title), escapeXml(one.verdict), escapeXml(one.says));
        }
        if (rows.empty()) return rows;
        return "<div class=\"scroll\"><table class=\"compared\">\n<thead><tr><th "
               "scope=\"col\">number"
               "</th><th scope=\"col\">verdict</th><th scope=\"col\">B ÷ A [95 %], or why</th></tr>"
               "</thead>\n<tbody>\n" +
               rows + "</tbody></table></div>\n";
    };
    std::string html =
        fmt::format("<p class=\"told\">{}</p>\n", escapeXml(model.comparedInAll)) + rowsOf(true);
    if (const std::string others = rowsOf(false); !others.empty()) {
        html += "<details><summary>All other numbers</summary>\n" + others + "</details>\n";
    }
    return html;
}

/// Verdicts other than those that the configs expect.
std::string unexpectedHtml(const Model& model) {
    std::string items;
    for (const Page& page : model.pages) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            for (const ClaimResult& claim : page.parts[run].claims) {
                if (!claim.isNews()) continue;
                items += fmt::format("<li>{}{} <strong>{}</strong>: {} ({}); expected: {}</li>\n",
                                     model.prefix(run), pageLink(page), verdictName(claim.verdict),
                                     escapeXml(claim.text.empty() ? claim.id : claim.text),
                                     escapeXml(claim.id), verdictName(*claim.known));
            }
        }
    }
    if (items.empty()) return "";
    return fmt::format("<h3>Other verdicts than expected</h3>\n<ul>\n{}</ul>\n", items);
}

/// Cells without a value, by table: what keeps this run from being whole.
std::string missingHtml(const Model& model) {
    std::string items;
    for (const Page& page : model.pages) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            const RunPart& part = page.parts[run];
            std::map<Status, int> counts;
            for (const tables::TableRow& row : part.table.rows) {
                for (const tables::Cell& cell : row.cells) {
                    if (cell.isPlanned && !cell.isOk()) ++counts[cell.status];
                }
            }
            if (counts.empty() && part.failures.empty()) continue;
            std::vector<std::string> what;
            for (const auto& [status, count] : counts) {
                what.push_back(fmt::format("{} {}", count, statusName(status)));
            }
            std::string text = what.empty() ? "" : "cells without a value: " + joined(what);
            if (!part.failures.empty()) {
                text += fmt::format("{}{} of its cases failed", text.empty() ? "" : "; ",
                                    part.failures.size());
            }
            items += fmt::format("<li>{}{}: {}</li>\n", model.prefix(run), pageLink(page), text);
        }
    }
    if (items.empty()) return "<p class=\"soft\">Nothing is missing: every case finished.</p>\n";
    return fmt::format("<h3>What is missing</h3>\n<ul>\n{}</ul>\n", items);
}

}  // namespace

std::string differencesHtml(const Model& model) {
    if (!model.isComparison()) return "";
    std::size_t common = 0, differing = 0;
    std::string items;
    for (const Page& page : model.pages) {
        std::map<std::string, std::vector<std::pair<std::size_t, const ClaimResult*>>> byId;
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            for (const ClaimResult& claim : page.parts[run].claims) {
                byId[claim.id].emplace_back(run, &claim);
            }
        }
        for (const auto& [id, said] : byId) {
            if (said.size() < 2) continue;
            ++common;
            const auto isFirsts = [&](const auto& one) {
                return one.second->verdict == said.front().second->verdict;
            };
            if (std::ranges::all_of(said, isFirsts)) continue;
            ++differing;
            std::string badges, words;
            for (const auto& [run, claim] : said) {
                badges += model.boldLetter(run) + verdictBadge(claim->verdict) + ' ';
                if (words.empty()) words = claim->text;
            }
            items += fmt::format("<li>{} {}: {}</li>\n", badges, pageLink(page),
                                 escapeXml(words.empty() ? id : words));
        }
    }
    if (common == 0) return comparedHtml(model);
    std::string html = fmt::format("<p class=\"told differences\">{} of {} verdicts differ{}</p>\n",
                                   differing, common, items.empty() ? "." : ":");
    if (!items.empty()) html += "<ul class=\"examples\">\n" + items + "</ul>\n";
    return html + comparedHtml(model);
}

std::string machineHtml(const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        const std::string size = sizeText(model.runs[run]);
        html +=
            fmt::format("<p class=\"machine\">{}{}{}</p>\n", model.boldLetter(run),
                        escapeXml(machineText(model.runs[run])), size.empty() ? "" : " · " + size);
    }
    return html;
}

std::string overviewHtml(const Model& model) {
    const bool isOwn = std::ranges::all_of(model.pages, &Page::isOwn);
    const char* title = model.isOneTable() ? "The run"
                        : isOwn            ? "Experiments"
                                           : "What reproduced, and what did not";
    const bool hasClaims = std::ranges::any_of(model.pages, [](const Page& page) {
        return std::ranges::any_of(page.parts,
                                   [](const RunPart& part) { return !part.claims.empty(); });
    });
    std::string html =
        fmt::format("<section class=\"page\" id=\"overview\">\n<h1 tabindex=\"-1\">{}</h1>\n",
                    title) +
        machineHtml(model) + (model.isOneTable() ? "" : differencesHtml(model)) +
        printedHtml(model);
    if (!model.isOneTable() || model.isComparison()) {
        for (const DocumentPages& document : model.byDocument()) {
            html += documentHtml(document, model);
        }
    }
    if (hasClaims && !model.isOneTable())
        html += "<h3>What the verdicts mean</h3>\n" + legendHtml();
    html += fmt::format("<h2>{}</h2>\n", hasClaims ? "Every claim, in words" : "All tables");
    return html + filtersHtml(model) + saidHtml(model) + unexpectedHtml(model) +
           missingHtml(model) + "<h3>Machine and run</h3>\n" + factsHtml(model) + "</section>\n";
}

}  // namespace gfxrepro::report
