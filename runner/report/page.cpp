// The page of a table, with its claims and cases.
#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <set>

#include "runner/config/schema.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/tables/labels.h"

namespace gfxrepro::report {

using claims::ClaimResult;
using claims::Verdict;

// Claims.

namespace {

/// What one sees of a verdict without its colour, and what the word means.
struct VerdictWords {
    Verdict verdict;
    const char* sign;
    const char* meaning;
    const char* ofOne;  // "1 holds"
    const char* ofSeveral;
};
constexpr VerdictWords kWords[] = {
    {Verdict::Holds, "✓", "what was measured agrees with the statement", "holds", "hold"},
    {Verdict::Fails, "✗",
     "on this machine, with these scenes, our implementation does not show what the document says: "
     "a result, no error of the run, with its reason beside it",
     "fails", "fail"},
    {Verdict::Ambiguous, "?", "the numbers are too few or scatter too much to tell",
     "cannot be told", "cannot be told"},
    {Verdict::Unmeasured, "○", "a case that it needs has no result", "was not measured",
     "were not measured"},
    {Verdict::NotApplicable, "–",
     "it asks for a GPU, for another profile, or for a scene that is like the printed one",
     "is not judged here", "are not judged here"},
};

const VerdictWords& wordsOf(Verdict verdict) {
    return *std::ranges::find(kWords, verdict, &VerdictWords::verdict);
}

/// Every claim of any run, in the first run's order.
std::vector<std::string> claimsOf(const Page& page) {
    std::vector<std::string> ids;
    for (const RunPart& part : page.parts) {
        for (const ClaimResult& claim : part.claims) {
            if (std::ranges::find(ids, claim.id) == ids.end()) ids.push_back(claim.id);
        }
    }
    return ids;
}

const ClaimResult* findClaim(const RunPart& part, const std::string& id) {
    const auto claim = std::ranges::find(part.claims, id, &ClaimResult::id);
    return claim == part.claims.end() ? nullptr : &*claim;
}

/// Whose claim it is, as people read it.
std::string_view originWords(config::ClaimSpec::Origin origin) {
    using Origin = config::ClaimSpec::Origin;
    switch (origin) {
        case Origin::Document:
            return "of the document";
        case Origin::Derived:
            return "read off its numbers";
        case Origin::Ours:
            return "an aim of ours";
        case Origin::Definition:
            return "true by construction";
        case Origin::Calibrated:
            return "of an input that was fitted";
        case Origin::Existence:
            return "can hardly fail";
    }
    return "";
}

/// What decides a time.
std::string_view timeWords(config::ClaimSpec::TimeKind kind) {
    using Kind = config::ClaimSpec::TimeKind;
    if (kind == Kind::Algorithmic) return "a time that counts of work decide";
    return kind == Kind::Architectural ? "a time that a GPU's units decide" : "a time as such";
}

/// Whose claim it is, of a time what decides it, and why it is not counted although the document
/// says it.
std::string whoseHtml(const ClaimResult& claim) {
    std::string text(originWords(claim.origin));
    if (claim.timeKind) text += fmt::format("; {}", timeWords(*claim.timeKind));
    if (!claim.rows.empty()) text += fmt::format("; on {}", claim.rows);
    if (claim.isRepeat) text += fmt::format("; counted as {}", claim.sameAs);
    return escapeXml(text);
}

std::string newsHtml(const ClaimResult& claim) {
    if (!claim.isNews()) return "";
    return fmt::format(" <span class=\"news\">expected: {}</span>", verdictName(*claim.known));
}

std::string paragraph(const std::string& label, const std::string& text,
                      const char* attributes = "") {
    if (text.empty()) return "";
    return fmt::format("<p{}><span class=\"soft\">{}</span>{}</p>\n", attributes, label,
                       escapeXml(text));
}

std::string_view boundText(config::ClaimSpec::BoundSource source) {
    using Source = config::ClaimSpec::BoundSource;
    if (source == Source::Text) return "the bound is the text's";
    return source == Source::Print ? "the bound is from the printed numbers" : "the bound is ours";
}

std::string requiredText(const ClaimResult& claim, const tables::Table& table) {
    if (claim.required.empty()) return "";
    const std::string text = tables::inWords(claim.required, table);
    if (!claim.boundFrom) return text;
    return fmt::format("{} ({})", text, boundText(*claim.boundFrom));
}

/// That nothing was tried is said once, below the meanings of the verdicts.
std::string restsOnText(const ClaimResult& claim) {
    const bool isNone = claim.restsOn == "not tried" || claim.restsOn == claims::kRestsOnUnknown;
    return isNone ? "" : claim.restsOn;
}

/// The place in results/findings that has the numbers, as a link where the folder is at hand.
std::string shownByHtml(const ClaimResult& claim, const Model& model) {
    const std::string place = "results/findings/" + claim.shownBy;
    if (claim.shownBy.empty() || model.findings.empty()) {
        return paragraph("shown by ", claim.shownBy.empty() ? "" : place);
    }
    return fmt::format("<p><span class=\"soft\">shown by </span><a href=\"{}/{}\">{}</a></p>\n",
                       model.findings, escapeXml(claim.shownBy), escapeXml(place));
}

/// What was measured beside what was asked for, in one line.
std::string measuredHtml(const ClaimResult& claim, const tables::Table& table) {
    const std::string required = requiredText(claim, table);
    std::string html;
    if (!claim.measured.empty()) {
        html += fmt::format("<span class=\"soft\">measured </span>{}", escapeXml(claim.measured));
    }
    if (!required.empty()) {
        html += fmt::format("{}<span class=\"soft\">asked for </span>{}", html.empty() ? "" : " · ",
                            escapeXml(required));
    }
    return html.empty() ? "" : fmt::format("<p>{}</p>\n", html);
}

/// What was found in one run, below the claim's words.
std::string detailHtml(const ClaimResult& claim, const tables::Table& table, const Model& model,
                       const std::string& letter, ClaimDetail detail) {
    std::string html;
    if (detail == ClaimDetail::Full) {
        html += measuredHtml(claim, table) +
                paragraph(claim.verdict == Verdict::Holds ? "noted: " : "why: ", whyText(claim)) +
                shownByHtml(claim, model) + paragraph("rests on ", restsOnText(claim));
    } else if (claim.verdict != Verdict::Holds && claim.verdict != Verdict::NotApplicable) {
        html += paragraph("why: ", whyText(claim));
    }
    if (html.empty() || letter.empty()) return html;
    return fmt::format("<div class=\"of-run\"><b>{}</b>\n{}</div>\n", letter, html);
}

/// A claim's place on the page of its table.
std::string claimAnchor(const Page& page, const std::string& id) {
    return escapeXml(fmt::format("{}:{}", page.slug, id));
}

std::string claimHtml(const Page& page, const std::string& id, const Model& model,
                      ClaimDetail detail) {
    std::string badges, details, says;
    std::string verdictNames;
    std::set<Verdict> verdicts;
    const ClaimResult* any = nullptr;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const ClaimResult* claim = findClaim(page.parts[run], id);
        if (!claim) continue;
        if (!any) any = claim;
        if (says.empty()) says = claim->text;  // kept verdicts come without it
        verdicts.insert(claim->verdict);
        verdictNames +=
            fmt::format("{}{}", verdictNames.empty() ? "" : " ", verdictName(claim->verdict));
        const std::string letter = model.isComparison() ? Model::letter(run) : "";
        badges += model.boldLetter(run) + verdictBadge(claim->verdict) + newsHtml(*claim) + ' ';
        details += detailHtml(*claim, page.parts[run].table, model, letter, detail);
    }
    const std::string text = says.empty() ? id : says;
    const std::string code =
        detail == ClaimDetail::Full
            ? escapeXml(id)
            : fmt::format("<a href=\"#{}\">{}</a>", claimAnchor(page, id), escapeXml(id));
    const std::string place =
        detail == ClaimDetail::Full ? fmt::format(" id=\"{}\"", claimAnchor(page, id)) : "";
    return fmt::format(
        "<li class=\"claim{}{}\"{} data-verdict=\"{}\" data-origin=\"{}\" data-text=\"{}\">"
        "<span class=\"verdicts\">{}</span> <span class=\"says\">{}</span> "
        "<span class=\"soft code\">{}, {}</span>\n{}</li>\n",
        any->isCounted() ? "" : " uncounted", verdicts.size() > 1 ? " differs" : "", place,
        verdictNames, config::originName(any->origin), escapeXml(id + ' ' + text), badges,
        escapeXml(text), code, whoseHtml(*any), details);
}

}  // namespace

std::string verdictBadge(Verdict verdict) {
    return fmt::format("<span class=\"badge {0}\"><span aria-hidden=\"true\">{1}</span> {0}</span>",
                       verdictName(verdict), wordsOf(verdict).sign);
}

std::string verdictSign(Verdict verdict) {
    return wordsOf(verdict).sign;
}

std::string legendHtml() {
    std::string html = "<dl class=\"legend-of-verdicts\">\n";
    for (const VerdictWords& words : kWords) {
        html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", verdictBadge(words.verdict),
                            words.meaning);
    }
    return html +
           "</dl>\n<p class=\"soft small\">“Rests on” names the assumptions that turn a verdict "
           "round; of a claim without it none was tried (<code>gfxrepro sensitivity</code> tries "
           "them), or no folder of kept results was there to look in.</p>\n";
}

std::string claimsHtml(const Page& page, const Model& model, ClaimDetail detail) {
    std::string html;
    for (const std::string& id : claimsOf(page)) html += claimHtml(page, id, model, detail);
    if (html.empty()) return "";
    const char* cssClass = detail == ClaimDetail::Full ? "claims" : "claims short";
    return fmt::format("<ul class=\"{}\">\n{}</ul>\n", cssClass, html);
}

std::string filtersHtml(const Model& model) {
    std::set<std::string> papers;
    bool hasOwn = false;
    for (const Page& page : model.pages) {
        papers.insert(page.paper());
        for (const RunPart& part : page.parts) {
            hasOwn |= std::ranges::any_of(part.claims, &ClaimResult::isOfDocument);
        }
    }
    std::string html =
        "<form class=\"filters\" hidden>\n<label>document <select name=\"paper\">"
        "<option value=\"\">all</option>";
    for (const std::string& paper : papers) {
        html += fmt::format("<option>{}</option>", escapeXml(paper));
    }
    html +=
        "</select></label>\n<label>whose claim <select name=\"origin\"><option value=\"\">all"
        "</option>";
    for (std::size_t i = 0; i < config::kOrigins.size(); ++i) {
        const auto origin = static_cast<config::ClaimSpec::Origin>(i);
        const bool isChosen = hasOwn && origin == config::ClaimSpec::Origin::Document;
        html += fmt::format("<option value=\"{}\"{}>{}</option>", config::originName(origin),
                            isChosen ? " selected" : "", originWords(origin));
    }
    html +=
        "</select></label>\n<label>words <input type=\"search\" name=\"text\" "
        "placeholder=\"of the claim or table\"></label>\n<fieldset>";
    for (const VerdictWords& words : kWords) {
        html += fmt::format(
            "<label class=\"badge {0}\"><input type=\"checkbox\" name=\"verdict\" "
            "value=\"{0}\" checked> <span aria-hidden=\"true\">{1}</span> {0}</label>\n",
            verdictName(words.verdict), words.sign);
    }
    html += "</fieldset>\n";
    if (model.isComparison()) {
        html += "<label><input type=\"checkbox\" name=\"differ\"> only where runs differ</label>\n";
    }
    return html + "<output></output>\n</form>\n";
}

// The page.

namespace {

/// "1 holds ✓, 2 fail ✗ ✗": each sign leads to its claim.
std::string verdictsHtml(const Page& page, const RunPart& part, const ReportRun& run,
                         const std::function<bool(const ClaimResult&)>& isSuch) {
    struct Alike {
        std::string one, several, signs;
        std::size_t count = 0;
    };
    std::vector<Alike> parts;
    for (const VerdictWords& words : kWords) {
        // Of what is not judged here those that another device could tell stand apart.
        for (const bool isOfGpu : {true, false}) {
            Alike alike{words.ofOne, words.ofSeveral, ""};
            if (isOfGpu) alike = {"asks for a GPU", "ask for a GPU", ""};
            for (const ClaimResult& claim : part.claims) {
                const bool asksForGpu = claim.verdict == Verdict::NotApplicable &&
                                        run.context.deviceClass != "gpu" &&
                                        claims::isOfGpu(claim.timeKind, part.table);
                if (claim.verdict != words.verdict || asksForGpu != isOfGpu || !isSuch(claim))
                    continue;
                ++alike.count;
                const std::string says = escapeXml(claim.text.empty() ? claim.id : claim.text);
                alike.signs += fmt::format(
                    " <a class=\"mark {0}\" href=\"#{1}\" title=\"{2}\" aria-label=\"{0}: "
                    "{2}\">{3}</a>",
                    verdictName(claim.verdict), claimAnchor(page, claim.id), says, words.sign);
            }
            if (alike.count > 0) parts.push_back(std::move(alike));
        }
    }
    std::string html;
    for (const Alike& alike : parts) {
        html += fmt::format("{}{} {}{}", html.empty() ? "" : ", ", alike.count,
                            alike.count == 1 ? alike.one : alike.several, alike.signs);
    }
    return html;
}

/// What became of the statements of this table, a line each run.
std::string verdictLineHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const RunPart& part = page.parts[run];
        if (part.claims.empty()) continue;
        const auto counted =
            static_cast<std::size_t>(std::ranges::count_if(part.claims, &ClaimResult::isCounted));
        const std::size_t others = part.claims.size() - counted;
        std::string line;
        if (counted > 0) {
            line = fmt::format("Of {} statement{} of the document {}. ", counted,
                               counted == 1 ? "" : "s",
                               verdictsHtml(page, part, model.runs[run], &ClaimResult::isCounted));
        }
        if (others > 0) {
            // They are not the document's own, say what another does, or can hardly fail.
            line += fmt::format(
                "<span{}>Of {} {}claim{}{} {}.</span>", page.isOwn() ? "" : " class=\"soft\"",
                others, counted > 0 ? "further " : "", others == 1 ? "" : "s",
                page.isOwn()  ? ""
                : others == 1 ? " that is not counted"
                              : " that are not counted",
                verdictsHtml(page, part, model.runs[run], std::not_fn(&ClaimResult::isCounted)));
        }
        html += fmt::format("<p class=\"verdict-line\">{}{}</p>\n", model.boldLetter(run), line);
    }
    return html;
}

std::string assumptionsHtml(const std::vector<config::Assumption>& assumptions,
                            const tables::Words& words) {
    if (assumptions.empty()) return "";
    std::string html =
        "<h3>Assumptions</h3>\n<div class=\"scroll\"><table class=\"assumed\"><thead><tr>"
        "<th scope=\"col\">what the paper left open</th><th scope=\"col\">taken</th>"
        "<th scope=\"col\">range</th><th scope=\"col\">why</th></tr></thead>\n"
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

std::string curvesHtml(const Page& page) {
    std::string html;
    for (const Curve& curve : page.curves) {
        html += fmt::format("<figure class=\"curve\">{}<figcaption>{}{}</figcaption></figure>\n",
                            curve.svg, escapeXml(curve.title),
                            curve.problem.empty() ? ""
                                                  : fmt::format(" <span class=\"soft\">({})</span>",
                                                                escapeXml(curve.problem)));
    }
    return html.empty() ? "" : "<h3>Curves</h3>\n<div class=\"curves\">\n" + html + "</div>\n";
}

/// Which methods are told apart, and by how much: before the table that shows it.
std::string comparisonHtml(const Page& page, const Model& model) {
    std::string html;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const tables::Table& table = page.parts[run].table;
        for (std::size_t i = 0; i < table.toldNotes; ++i) {
            html += fmt::format("<p class=\"told\">{}{}</p>\n", model.boldLetter(run),
                                escapeXml(table.notes[i]));
        }
    }
    return html;
}

/// What else is to be known of the numbers, folded.
std::string remarksHtml(const Page& page, const Model& model) {
    const RunPart* shown = page.shown();
    std::string html;
    std::size_t count = 0;
    const auto add = [&](const std::string& label, const std::string& text) {
        html += paragraph(label, text);
        count += text.empty() ? 0 : 1;
    };
    add("", shown->table.remark);
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const tables::Table& table = page.parts[run].table;
        for (std::size_t i = table.toldNotes; i < table.notes.size(); ++i) {
            add(model.prefix(run), table.notes[i]);
        }
    }
    const std::string hardware =
        paragraph("Printed numbers: ", shown->table.hardware, " class=\"small\"");
    if (count == 0) return hardware;
    return fmt::format(
        "{}<details class=\"remarks\"><summary>Remarks: {}</summary>\n{}</details>\n", hardware,
        count, html);
}

std::string failuresHtml(const Page& page, const Model& model) {
    std::string items;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        for (const Failure& failure : page.parts[run].failures) {
            items += fmt::format(
                "<li>{}{} (case <a href=\"#{}\">{}</a>): <span class=\"status\">{}</span>{}{}"
                "</li>\n",
                model.prefix(run), escapeXml(failure.name),
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
            model.prefix(run), escapeXml(from.context.device),
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

/// Every case: its id, the command that runs it again, its log.
std::string casesHtml(const Page& page, const Model& model) {
    std::string html;
    std::size_t count = 0;
    for (std::size_t run = 0; run < page.parts.size(); ++run) {
        const ReportRun& of = model.runs[run];
        const auto commandOf = [&](const std::string& id) {
            const auto command = of.commands.find(id);
            return command == of.commands.end() ? "" : command->second;
        };
        for (const config::Case* item : page.parts[run].cases) {
            ++count;
            html += fmt::format(
                "<article class=\"case\" id=\"{}\"><h4>{}{} <span class=\"soft\">case {}</span>"
                "</h4>\n<pre class=\"command\">{}</pre>\n",
                escapeXml(caseAnchor(run, item->id)), model.prefix(run),
                escapeXml(tables::shownCase(item->title(), page.id, page.parts[run].table.words)),
                escapeXml(item->id), escapeXml(commandOf(item->id)));
            std::string log;
            if (const auto events = of.events.find(item->id); events != of.events.end()) {
                for (const std::string& line : events->second) log += escapeXml(line) + '\n';
            }
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

}  // namespace

std::string pageHtml(const Page& page, const Model& model) {
    const char* heading = model.isOneTable() ? "h1" : "h2";
    std::string html = fmt::format(
        "<section class=\"page\" id=\"{0}\">\n<{1} tabindex=\"-1\">{2}</{1}>\n"
        "<p class=\"soft small\">{3}</p>\n{4}{5}",
        escapeXml(page.slug), heading, escapeXml(page.heading()), escapeXml(page.id),
        verdictLineHtml(page, model),
        model.isOneTable() ? machineHtml(model) + differencesHtml(model) : "");
    std::string claims = claimsHtml(page, model, ClaimDetail::Full);
    if (!claims.empty()) claims = "<h3>Claims</h3>\n" + claims;
    if (!claims.empty() && model.isOneTable()) {
        claims +=
            "<details><summary>What the verdicts mean</summary>\n" + legendHtml() + "</details>\n";
    }
    const RunPart* shown = page.shown();
    if (!shown) return html + tableHtml(page, model) + claims + "</section>\n";
    html += importedHtml(page, model);
    const std::string images = imagesHtml(page, model);
    // Of a figure, or a table of pictures, the numbers come after them.
    const bool isPicture = shown->experiment->kind == config::ExperimentKind::Figure ||
                           !shown->experiment->shows.empty();
    if (isPicture) html += images;
    html += comparisonHtml(page, model) + tableHtml(page, model) + remarksHtml(page, model);
    html += claims;
    html += curvesHtml(page);
    html += failuresHtml(page, model);
    if (!isPicture) html += images;
    html += assumptionsHtml(shown->experiment->assumptions, shown->table.words);
    html += againHtml(*shown, model.runs[static_cast<std::size_t>(shown - page.parts.data())]);
    html += casesHtml(page, model);
    return html + "</section>\n";
}

}  // namespace gfxrepro::report
