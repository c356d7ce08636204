#include "runner/report/writers.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/records/csv.h"
#include "runner/report/markup.h"
#include "runner/tables/labels.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

// CSV and Markdown.

namespace {

/// The statistics of a column, of all its rows, in the order of their formats.
std::vector<std::string> statisticsOf(const tables::Table& table, std::size_t column) {
    std::vector<std::string> names;
    for (const tables::TableRow& row : table.rows) {
        for (const tables::Measured& measured : row.cells[column].values) {
            if (std::find(names.begin(), names.end(), measured.statistic) == names.end()) {
                names.push_back(measured.statistic);
            }
        }
    }
    if (names.empty()) names.emplace_back("");
    return names;
}

/// Nothing where there is nothing to say it of.
std::string_view atPrintedWord(const tables::Table& table, const tables::Cell& cell) {
    if (cell.values.empty() || !table.knowsPrintedParameters) return "";
    if (!cell.isAtPrintedParameters) return "no";
    if (table.isPrintUnsaid) return "not known";
    return cell.openParameters.empty() ? "yes" : "as far as given";
}

bool hasCalibrated(const tables::Table& table, std::size_t column) {
    return std::ranges::any_of(
        table.rows, [&](const tables::TableRow& row) { return row.cells[column].isCalibrated; });
}

/// Of an experiment of one's own a column without printed values says nothing of print.
bool saysPrinted(const tables::Table& table, std::size_t column) {
    return table.isPublished || std::ranges::any_of(table.rows, [&](const tables::TableRow& row) {
               return row.cells[column].printed.has_value();
           });
}

std::string tableCsv(const tables::Table& table) {
    std::string text;
    std::vector<std::vector<std::string>> statistics;
    // Asked once a column: all look at every row.
    std::vector<bool> isPrinted, isCalibrated, hasMovedClock, isPooled;
    records::CsvRow header(text);
    for (const std::string& axis : table.rowAxes) header.text(axis);
    if (table.hasSources()) header.text("source");
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& label = table.columns[i].label;
        statistics.push_back(statisticsOf(table, i));
        isPrinted.push_back(saysPrinted(table, i));
        isCalibrated.push_back(hasCalibrated(table, i));
        if (isPrinted[i]) header.text(label + "_printed");
        for (const std::string& statistic : statistics[i]) {
            const std::string name = label + (statistics[i].size() > 1 ? "_" + statistic : "");
            header.text(name + "_measured").text(name + "_low").text(name + "_high");
            header.text(name + "_bounds");
        }
        header.text(label + "_status");
        if (table.isPublished) header.text(label + "_at_printed");
        if (isCalibrated[i]) header.text(label + "_calibrated");
        hasMovedClock.push_back(tables::movedClock(table, i).has_value());
        if (hasMovedClock[i]) header.text(label + "_clock_low_ghz").text(label + "_clock_high_ghz");
        isPooled.push_back(std::ranges::any_of(
            table.rows, [&](const tables::TableRow& row) { return !row.cells[i].pooled.empty(); }));
        if (isPooled[i]) header.text(label + "_taken_over");
    }
    if (table.isPublished) header.text("parameters");
    header.end();
    for (const tables::TableRow& row : table.rows) {
        records::CsvRow line(text);
        for (const std::string& label : row.labels) line.text(label);
        if (table.hasSources()) line.text(tables::sceneSourceName(row.source));
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const tables::Cell& cell = row.cells[i];
            if (isPrinted[i]) line.text(cell.printed.value_or(""));
            for (const std::string& statistic : statistics[i]) {
                const tables::Measured* measured = cell.find(statistic);
                if (measured) {
                    line.number(measured->value);
                    line.number(measured->interval.low).number(measured->interval.high);
                    line.text(cell.boundsWord(*measured));
                } else {
                    line.text("").text("").text("").text("");
                }
            }
            line.text(cell.isPlanned ? records::statusName(cell.status) : "");
            if (table.isPublished) line.text(atPrintedWord(table, cell));
            if (isCalibrated[i]) line.text(cell.isCalibrated ? "yes" : "no");
            if (hasMovedClock[i] && cell.movedClock) {
                line.number(cell.movedClock->lowHz / 1e9).number(cell.movedClock->highHz / 1e9);
            } else if (hasMovedClock[i]) {
                line.text("").text("");
            }
            if (isPooled[i]) line.text(tables::pooledText(cell));
        }
        if (table.isPublished) line.text(tables::parametersLine(table, row));
        line.end();
    }
    return text;
}

std::string markdownCell(const tables::Cell& cell, bool isOnlyPrinted) {
    std::string text;
    if (cell.printed) text += escapeMarkdown(*cell.printed) + (isOnlyPrinted ? "" : " → ");
    text += cell.isPlanned ? escapeMarkdown(cell.measured) : "";
    if (cell.isPlanned && cell.isCalibrated) text += tables::kCalibratedMark;
    if (cell.movedClock) text += tables::kMovedClockMark;
    if (cell.hasShownBounds()) {
        text += fmt::format(fmt::runtime(cell.hasInterval() ? " [{}, {}]" : " ({} … {})"),
                            escapeMarkdown(cell.low), escapeMarkdown(cell.high));
    }
    return text;
}

/// What the bounds beside the numbers are.
std::string boundsLegend(const tables::Table& table) {
    const bool hasTimes =
        table.hasCell([](const tables::Cell& cell) { return cell.hasInterval() && cell.isTime; });
    const bool hasShares = table.hasCell(&tables::Cell::isCountedShare);
    const std::string interval =
        fmt::format(" [95 % interval{}{}]", hasTimes ? ", of times that of this sitting" : "",
                    hasShares ? "; of a share that was counted once, by its count alone: other "
                                "scenes may differ by more"
                              : "");
    return fmt::format("{}{}{}.", table.hasPrinted() ? "Printed → measured" : "Measured",
                       table.hasShown(tables::Bounds::Interval) ? interval : "",
                       table.hasShown(tables::Bounds::Range)
                           ? " (range, min … max: too few processes for an interval)"
                           : "");
}

/// What stands below a table.
std::string notesMarkdown(const tables::Table& table,
                          const std::vector<std::map<std::string, std::string>>& shown) {
    std::string text;
    if (table.hasCalibrated()) {
        text += fmt::format("\n{} {}.\n", tables::kCalibratedMark, tables::kCalibratedLegend);
    }
    if (const auto clock = tables::movedClock(table)) {
        text +=
            fmt::format("\n{} {}.\n", tables::kMovedClockMark, tables::movedClockLegend(*clock));
    }
    if (!table.remark.empty()) text += fmt::format("\nRemark: {}\n", escapeMarkdown(table.remark));
    for (const std::string& note : table.notes)
        text += fmt::format("\nNote: {}\n", escapeMarkdown(note));
    std::vector<std::string> absent;
    for (const tables::TableRow& row : table.printedRows) {
        std::vector<std::string> said;
        for (std::size_t i = 0; i < row.labels.size(); ++i)
            said.push_back(shown[i].at(row.labels[i]));
        for (const tables::Cell& cell : row.cells) {
            if (cell.printed) said.push_back(*cell.printed);
        }
        absent.push_back(joined(said));
    }
    if (!absent.empty()) {
        text += fmt::format("\nNote: printed, but not part of this run: {}\n",
                            escapeMarkdown(joined(absent, "; ")));
    }
    return text;
}

std::string tableMarkdown(const tables::Table& table) {
    std::string text = fmt::format("# {}\n\n", escapeMarkdown(table.label + ". " + table.title));
    text += table.isOnlyPrinted ? "As printed; nothing is measured." : boundsLegend(table);
    if (!table.constants.empty()) {
        text += fmt::format("\n\nIn every row: {}.", escapeMarkdown(joined(table.constants)));
    }
    if (!table.hardware.empty())
        text += fmt::format(" Printed: {}.", escapeMarkdown(table.hardware));
    if (const std::string parameters = tables::parametersLine(table); !parameters.empty())
        text += "\n\n" + escapeMarkdown(parameters);
    text += "\n\n|";
    std::string rule = "|";
    for (const std::string& axis : table.rowAxes) {
        text += fmt::format(" {} |", escapeMarkdown(tables::shownName(axis, table.words)));
        rule += " --- |";
    }
    if (table.hasSources()) {
        text += " source |";
        rule += " --- |";
    }
    for (const tables::TableColumn& column : table.columns) {
        text +=
            fmt::format(" {} |", escapeMarkdown(tables::quantityOf(column, table.words).text()));
        rule += " ---: |";
    }
    text += "\n" + rule + "\n";
    std::vector<std::vector<std::string>> labels;
    for (const auto* rows : {&table.rows, &table.printedRows}) {
        for (const tables::TableRow& row : *rows) labels.push_back(row.labels);
    }
    const auto shown = tables::shownLabels(labels, table.words);
    for (const tables::TableRow& row : table.rows) {
        text += "|";
        for (std::size_t i = 0; i < row.labels.size(); ++i)
            text += fmt::format(" {} |", escapeMarkdown(shown[i].at(row.labels[i])));
        if (table.hasSources()) text += fmt::format(" {} |", tables::sceneSourceName(row.source));
        for (const tables::Cell& cell : row.cells)
            text += fmt::format(" {} |", markdownCell(cell, table.isOnlyPrinted));
        text += "\n";
    }
    return text + notesMarkdown(table, shown);
}

std::string claimsCsv(const std::vector<claims::ClaimResult>& results,
                      const claims::ReportContext& context) {
    std::string text = fmt::format("{}\n", fmt::join(claims::kClaimsColumns, ","));
    for (const claims::ClaimResult& result : results) {
        const std::string_view bound =
            result.boundFrom ? config::boundSourceName(*result.boundFrom) : "";
        const std::string_view kind = result.timeKind ? config::timeKindName(*result.timeKind) : "";
        records::CsvRow row(text);
        row.text(result.id).text(result.text).text(result.table);
        row.text(context.device).text(context.profile);
        row.text(config::originName(result.origin)).text(bound).text(kind);
        row.text(claims::verdictName(result.verdict))
            .text(result.known ? claims::verdictName(*result.known) : "");
        row.text(result.measured).text(result.required).text(result.margin).text(result.reason);
        row.text(result.because).text(result.restsOn).text(result.rows);
        row.text(result.holdsOn).text(result.sameAs).end();
    }
    return text;
}

}  // namespace

void writeTables(const fs::path& runDir, const std::vector<tables::Table>& tables,
                 const std::vector<std::string>& runNotes) {
    for (const tables::Table& table : tables) {
        if (table.columns.empty()) continue;
        const fs::path folder = runDir / "tables";
        writeFileAtomic(folder / (table.slug + ".csv"), tableCsv(table));
        writeFileAtomic(folder / (table.slug + ".md"), tableMarkdown(table));
        writeFileAtomic(folder / (table.slug + ".tex"), tableLatex(table, runNotes));
    }
}

// JUnit.

namespace {

using Outcome = JunitTest::Outcome;

JunitSuite suiteOf(const std::vector<records::CaseEnd>& cases) {
    std::map<std::string, int> known;
    JunitSuite suite{"cases", {}};
    for (const records::CaseEnd& one : cases) {
        // Those of several seeds of a scene have one title; others differ by what XML cannot write.
        const int count = ++known[escapeXml(one.title)];
        JunitTest test{one.table, one.title + (count > 1 ? fmt::format(" ({})", count) : "")};
        using Ended = records::CaseEnd::Outcome;
        if (one.outcome == Ended::Skipped) test.outcome = Outcome::Skipped;
        if (one.outcome == Ended::Failed) test.outcome = Outcome::Broken;
        test.type = one.text.substr(0, one.text.find(':'));
        test.message = one.text;
        test.seconds = one.seconds;
        suite.tests.push_back(std::move(test));
    }
    return suite;
}

JunitSuite suiteOf(const std::vector<claims::ClaimResult>& claims) {
    JunitSuite suite{"claims", {}};
    for (const claims::ClaimResult& claim : claims) {
        JunitTest test{claim.table, fmt::format("{} claim {}", claim.table, claim.id),
                       Outcome::Skipped, "claim"};
        if (claim.verdict == claims::Verdict::Holds) test.outcome = Outcome::Passed;
        if (claim.verdict == claims::Verdict::Fails) test.outcome = Outcome::Failed;
        test.message =
            fmt::format("{}: measured {}, required {}{}", claims::verdictName(claim.verdict),
                        claim.measured.empty() ? "nothing" : claim.measured, claim.required,
                        claim.reason.empty() ? "" : fmt::format(" ({})", claim.reason)) +
            (claim.because.empty() ? "" : fmt::format("; known: {}", claim.because));
        suite.tests.push_back(std::move(test));
    }
    return suite;
}

/// Some readers show the attribute, others the text.
std::string testXml(const JunitTest& test) {
    const std::string begin =
        fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                    escapeXml(test.group), escapeXml(test.name), test.seconds);
    if (test.outcome == Outcome::Passed) return begin + "/>\n";
    const std::string message = escapeXml(test.message);
    if (test.outcome == Outcome::Skipped) {
        return fmt::format("{}><skipped message=\"{}\"/></testcase>\n", begin, message);
    }
    const char* element = test.outcome == Outcome::Failed ? "failure" : "error";
    return fmt::format("{0}><{1} message=\"{2}\" type=\"{3}\">{2}</{1}></testcase>\n", begin,
                       element, message, escapeXml(test.type));
}

}  // namespace

void writeClaims(const fs::path& runDir, const std::vector<records::CaseEnd>& cases,
                 const std::vector<claims::ClaimResult>& results,
                 const claims::ReportContext& context, const std::string& started) {
    writeFileAtomic(runDir / "claims.csv", claimsCsv(results, context));
    writeFileAtomic(runDir / "junit.xml", junitXml({suiteOf(cases), suiteOf(results)}, started));
}

std::string junitXml(const std::vector<JunitSuite>& suites, const std::string& started) {
    std::string text = std::string(kXmlHead) + "<testsuites>\n";
    // Without the Z of UTC, which Ant's schema does not take.
    const std::string when = escapeXml(started.substr(0, started.find('Z')));
    int id = 0;
    for (const JunitSuite& suite : suites) {
        std::map<Outcome, int> counts;
        double seconds = 0.0;
        for (const JunitTest& test : suite.tests) {
            ++counts[test.outcome];
            seconds += test.seconds;
        }
        text += fmt::format(
            "<testsuite name=\"{0}\" package=\"gfxrepro\" id=\"{1}\" tests=\"{2}\" "
            "failures=\"{3}\" errors=\"{4}\" skipped=\"{5}\" time=\"{6:.3f}\" "
            "timestamp=\"{7}\" hostname=\"localhost\">\n<properties/>\n",
            escapeXml(suite.name), id++, suite.tests.size(), counts[Outcome::Failed],
            counts[Outcome::Broken], counts[Outcome::Skipped], seconds, when);
        for (const JunitTest& test : suite.tests) text += testXml(test);
        text += "<system-out/>\n<system-err/>\n</testsuite>\n";
    }
    return text + "</testsuites>\n";
}

}  // namespace gfxrepro::report
