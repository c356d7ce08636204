#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "runner/report/highlights.h"
#include "runner/report/markup.h"
#include "runner/report/parts.h"

namespace gfxrepro::report {

using claims::ClaimResult;
using claims::Verdict;
using records::Status;

namespace {

constexpr std::array kVerdicts = {Verdict::Holds, Verdict::Fails, Verdict::Ambiguous,
                                  Verdict::Unmeasured, Verdict::NotApplicable};
/// More examples than these are no summary.
constexpr std::size_t kExamples = 3;

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

/// The documents' own claims, or all the others, of one run.
Counts countClaims(const std::vector<const Page*>& pages, std::size_t run, bool isOwn) {
    Counts counts;
    for (const Page* page : pages) {
        for (const ClaimResult& claim : page->parts[run].claims) {
            if (claim.isOfDocument() == isOwn) ++counts[claim.verdict];
        }
    }
    return counts;
}

/// "9 hold · 2 fail · 1 ambiguous".
std::string countsText(const Counts& counts) {
    std::string text;
    for (const Verdict verdict : kVerdicts) {
        const std::size_t count = countOf(counts, verdict);
        if (count == 0) continue;
        const std::string word = verdict == Verdict::Holds   ? count == 1 ? "holds" : "hold"
                                 : verdict == Verdict::Fails ? count == 1 ? "fails" : "fail"
                                                             : std::string(verdictName(verdict));
        text += fmt::format("{}{} {}", text.empty() ? "" : " · ", count, word);
    }
    return text;
}

/// The shares as lengths; each names itself by its sign and number.
std::string tallyHtml(const Counts& counts) {
    std::string html =
        fmt::format("<div class=\"tally\" role=\"img\" aria-label=\"{}\">", countsText(counts));
    for (const Verdict verdict : kVerdicts) {
        const std::size_t count = countOf(counts, verdict);
        if (count == 0) continue;
        html += fmt::format("<span class=\"{}\" style=\"flex-grow:{}\">{} {}</span>",
                            verdictName(verdict), count, verdictSign(verdict), count);
    }
    return html + "</div>\n";
}

/// The first claims of that verdict, one a chapter first.
std::vector<std::pair<const Page*, const ClaimResult*>> examples(const DocumentPages& document,
                                                                 Verdict verdict) {
    std::vector<std::pair<const Page*, const ClaimResult*>> first, further;
    for (const DocumentPages::Chapter& chapter : document.chapters) {
        bool isFirst = true;
        for (const Page* page : chapter.pages) {
            for (const ClaimResult& claim : page->parts.front().claims) {
                const bool isMeant = claim.isOfDocument() && claim.verdict == verdict;
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

std::string examplesHtml(const char* before, const DocumentPages& document, Verdict verdict,
                         std::size_t count) {
    std::string items;
    for (const auto& [page, claim] : examples(document, verdict)) {
        items += fmt::format("{}“{}” (<a href=\"#{}\">{}</a>)", items.empty() ? "" : "; ",
                             escapeXml(claim->text), escapeXml(page->slug), escapeXml(page->label));
    }
    if (items.empty()) return "";
    return fmt::format("{}{}: {}. ", before, count > kExamples ? ", among others" : "", items);
}

/// What one could judge, what of it holds, and what does not.
std::string paragraphHtml(const DocumentPages& document, const Counts& own) {
    const std::size_t holding = countOf(own, Verdict::Holds);
    const std::size_t failing = countOf(own, Verdict::Fails);
    const std::size_t open = countOf(own, Verdict::Ambiguous) + countOf(own, Verdict::Unmeasured);
    const std::size_t elsewhere = countOf(own, Verdict::NotApplicable);
    std::string html = fmt::format(
        "Of {} statement{} of the document, {} could be judged here: <strong>{} hold{}</strong>, "
        "<strong>{} fail{}</strong>. ",
        sumOf(own), sumOf(own) == 1 ? "" : "s", holding + failing, holding, holding == 1 ? "s" : "",
        failing, failing == 1 ? "s" : "");
    if (open > 0) html += fmt::format("The numbers of {} do not tell. ", open);
    if (elsewhere > 0) html += fmt::format("{} ask for a GPU or another profile. ", elsewhere);
    return html + examplesHtml("Reproduced", document, Verdict::Holds, holding) +
           examplesHtml("Not reproduced", document, Verdict::Fails, failing);
}

std::string chaptersHtml(const DocumentPages& document) {
    if (document.chapters.size() < 2) return "";
    std::string html;
    for (const DocumentPages::Chapter& chapter : document.chapters) {
        const Counts own = countClaims(chapter.pages, 0, true);
        if (own.empty()) continue;
        html +=
            fmt::format("<li><span>{}</span>{}</li>\n", escapeXml(chapter.title), tallyHtml(own));
    }
    return html.empty() ? "" : "<ul class=\"chapters\">\n" + html + "</ul>\n";
}

std::string highlightsHtml(const DocumentPages& document, const Model& model) {
    std::string html;
    const auto difference = [&](std::size_t run, const Shot& a, const Shot& b) {
        return shotDifference(model.runs[run].folder, a, b);
    };
    for (const Highlight& one : highlightsOf(document.pages(), difference)) {
        html += fmt::format(
            "<figure><a href=\"#{0}\"><img src=\"{1}\" alt=\"{2}\" width=\"{3}\" "
            "height=\"{4}\"></a><figcaption>{5} {6} <a href=\"#{0}\">{7}</a></figcaption>"
            "</figure>\n",
            escapeXml(one.page->slug), smallPicture(*one.shot, model.places[one.run]),
            escapeXml(one.shot->caseTitle + " · " + one.shot->name), one.shot->width,
            one.shot->height, verdictBadge(one.claim->verdict), escapeXml(one.claim->text),
            escapeXml(one.page->label));
    }
    return html.empty() ? "" : "<div class=\"highlights\">\n" + html + "</div>\n";
}

/// What of a document reproduced: a bar, a paragraph, a bar for each chapter, pictures.
std::string documentHtml(const DocumentPages& document, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < model.runs.size(); ++run) {
        const Counts own = countClaims(document.pages(), run, true);
        const Counts others = countClaims(document.pages(), run, false);
        if (own.empty() && others.empty()) continue;
        if (model.isComparison()) {
            html += fmt::format("<p><b>{}</b> {}</p>\n", Model::letter(run),
                                escapeXml(runName(model.runs[run])));
        }
        if (!own.empty()) {
            html += tallyHtml(own);
            if (run == 0) html += fmt::format("<p>{}</p>\n", paragraphHtml(document, own));
        }
        if (!others.empty()) {
            html += fmt::format(
                "<p class=\"soft small\">Not counted, as the document does not state it: {}.</p>\n",
                countsText(others));
        }
    }
    if (html.empty()) return "";
    if (!model.isComparison()) html += chaptersHtml(document);
    return fmt::format("<section class=\"document\">\n<h2>{}{}</h2>\n{}{}</section>\n",
                       escapeXml(document.id),
                       document.title.empty() ? "" : fmt::format(". {}", escapeXml(document.title)),
                       html, highlightsHtml(document, model));
}

std::string pageLink(const Page& page) {
    const std::string rest = page.isOwn() ? "" : fmt::format(" {}", escapeXml(page.title));
    return fmt::format("<a href=\"#{}\">{}</a>{}", escapeXml(page.slug),
                       escapeXml(page.isOwn() ? page.title : page.label), rest);
}

/// Every table with its claims in words, chapter by chapter.
std::string saidHtml(const Model& model) {
    std::string html = "<div class=\"said\">\n";
    const std::vector<DocumentPages> documents = model.byDocument();
    for (const DocumentPages& document : documents) {
        for (const DocumentPages::Chapter& chapter : document.chapters) {
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
                                escapeXml(page->label + ' ' + page->title), pageLink(*page),
                                claimsHtml(*page, model, ClaimDetail::Short));
            }
            html += "</section>\n";
        }
    }
    return html + "</div>\n";
}

/// Verdicts that are not what the configs know.
std::string newsSection(const Model& model) {
    std::string items;
    for (const Page& page : model.pages) {
        for (std::size_t run = 0; run < page.parts.size(); ++run) {
            for (const ClaimResult& claim : page.parts[run].claims) {
                if (!claim.isNews()) continue;
                items += fmt::format(
                    "<li>{}<a href=\"#{}\">{}</a> <strong>{}</strong>: {} ({}); known: {}</li>\n",
                    model.isComparison() ? Model::letter(run) + ": " : "", escapeXml(page.slug),
                    escapeXml(page.label), verdictName(claim.verdict),
                    escapeXml(claim.text.empty() ? claim.id : claim.text), escapeXml(claim.id),
                    verdictName(*claim.known));
            }
        }
    }
    if (items.empty()) return "";
    return fmt::format("<h3>What is news</h3>\n<ul>\n{}</ul>\n", items);
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
        machineHtml(model) + printedHtml(model);
    if (!model.isOneTable() || model.isComparison()) {
        for (const DocumentPages& document : model.byDocument()) {
            html += documentHtml(document, model);
        }
    }
    if (hasClaims && !model.isOneTable())
        html += "<h3>What the verdicts mean</h3>\n" + legendHtml();
    html += fmt::format("<h2>{}</h2>\n", hasClaims ? "Every claim, in words" : "All tables");
    return html + filtersHtml(model) + saidHtml(model) + newsSection(model) + missingHtml(model) +
           "<h3>Machine and run</h3>\n" + factsHtml(model) + "</section>\n";
}

}  // namespace gfxrepro::report
