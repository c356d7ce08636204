#include "runner/report/writers.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>

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

bool hasPrintedColumn(const tables::Table& table) {
    bool hasSome = table.isOnlyPrinted;
    for (std::size_t i = 0; i < table.columns.size(); ++i) hasSome |= saysPrinted(table, i);
    return hasSome;
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

void writeClaims(const fs::path& runDir, const std::vector<records::CaseEnd>& cases,
                 const std::vector<claims::ClaimResult>& results,
                 const claims::ReportContext& context) {
    writeFileAtomic(runDir / "claims.csv", claimsCsv(results, context));
    writeFileAtomic(runDir / "junit.xml", junitXml(cases, results));
}

// LaTeX.

namespace {

/// TeX's own names hold letters only; \csname takes the keys as they are. A key that is not there
/// is an error, where \csname alone would make an empty macro of it. Global, because the file is
/// read within a table.
constexpr std::string_view kMacros =
    "\\ifdefined\\gfxrepro\\else\n"
    "\\gdef\\gfxreproset#1#2{\\expandafter\\gdef\\csname gfxrepro/#1\\endcsname{#2}}\n"
    "\\gdef\\gfxrepro#1{\\ifcsname gfxrepro/#1\\endcsname"
    "\\csname gfxrepro/#1\\endcsname\\else\\errmessage{gfxrepro: no number #1}\\fi}\n"
    "\\fi\n";

/// Of calibrated cells, as TeX sets it.
constexpr const char* kMark = "\\textsuperscript{\\ddag}";
/// Of times that are not of one clock.
constexpr const char* kClockMark = "\\textsuperscript{\\S}";

std::string inOneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

/// `key`, or `key-2`, … where it is taken.
std::string unique(const std::string& key, std::set<std::string>& taken) {
    std::string candidate = key;
    for (int n = 2; !taken.insert(candidate).second; ++n) candidate = fmt::format("{}-{}", key, n);
    return candidate;
}

/// The labels of the rows; scenes of one's own as their files, wherever these lie.
std::vector<std::vector<std::string>> labelsOf(const tables::Table& table) {
    std::vector<std::vector<std::string>> rows;
    for (const tables::TableRow& row : table.rows) rows.push_back(row.labels);
    const auto shown = tables::shownLabels(rows, table.words);
    for (std::vector<std::string>& labels : rows) {
        for (std::size_t i = 0; i < labels.size(); ++i) {
            if (labels[i].starts_with('/')) labels[i] = shown[i].at(labels[i]);
        }
    }
    return rows;
}

std::string cite(const std::string& key) {
    return fmt::format("\\gfxrepro{{{}}}", key);
}

class LatexWriter {
  public:
    LatexWriter(const tables::Table& table, const std::vector<std::string>& runNotes)
        : table_(table), runNotes_(runNotes), rowLabels_(labelsOf(table)) {
        std::set<std::string> rows, columns;
        for (const std::vector<std::string>& labels : rowLabels_) {
            std::vector<std::string> parts;
            for (const std::string& label : labels) parts.push_back(latexKeyPart(label));
            rowKeys_.push_back(unique(joined(parts, "/"), rows));
        }
        for (const tables::TableColumn& column : table.columns) {
            columnKeys_.push_back(unique(latexKeyPart(column.label), columns));
        }
    }

    std::string write() {
        writeHead();
        if (!parameters_.empty()) set(table_.id, parameters_);
        for (std::size_t row = 0; row < table_.rows.size(); ++row) {
            for (std::size_t i = 0; i < table_.columns.size(); ++i) {
                writeNumbers(table_.rows[row].cells[i], key(row, i));
            }
        }
        writeColumns();
        for (std::size_t row = 0; row < table_.rows.size(); ++row) writeRow(row);
        text_ += "\\bottomrule\n\\end{tabular}\n";
        if (!parameters_.empty()) addNote(cite(table_.id));
        if (table_.hasCalibrated()) {
            addNote(fmt::format("{} {}.", kMark, tables::kCalibratedLegend));
        }
        if (const auto clock = tables::movedClock(table_)) {
            addNote(
                fmt::format("{} {}.", kClockMark, escapeLatex(tables::movedClockLegend(*clock))));
        }
        if (const std::string note = tables::seedNote(table_); !note.empty()) {
            addNote(escapeLatex(note));
        }
        for (const std::string& note : tables::cellNotes(table_)) addNote(escapeLatex(note));
        for (const std::string& note : runNotes_) {
            addNote(fmt::format("Note: {}.", escapeLatex(note)));
        }
        return std::move(text_);
    }

  private:
    std::string key(std::size_t row, std::size_t column) const {
        std::vector<std::string> parts = {table_.id};
        if (!rowKeys_[row].empty()) parts.push_back(rowKeys_[row]);
        parts.push_back(columnKeys_[column]);
        return joined(parts, "/");
    }

    void writeHead() {
        const bool hasCells = !table_.rows.empty() && !table_.columns.empty();
        const std::string example = hasCells ? key(0, 0) : table_.id;
        text_ += fmt::format(
            "% {}\n"
            "% Made by gfxrepro. Needs \\usepackage{{booktabs}}; \\input of this file sets the "
            "table.\n"
            "% Each number is a macro, for the text below the \\input; keys are "
            "table/row/column:\n",
            inOneLine(fmt::format("{}. {}", table_.label, table_.title)));
        if (!table_.isOnlyPrinted) {
            text_ += fmt::format(
                "%   {}  as measured\n"
                "%   likewise {}/low and /high, the ends of its bounds,\n"
                "%   and /bounds, what they are: 95 % interval (of times that of this "
                "sitting), the range of too few processes, or one seed, which has none;\n"
                "%   and, of several statistics in a cell, each below the cell's key\n",
                cite(example), example);
        }
        if (hasPrinted_) {
            text_ += fmt::format("%   {}  as printed\n", cite(example + "/printed"));
        }
        if (!parameters_.empty()) {
            text_ += fmt::format("%   {}  at which parameters it was measured\n", cite(table_.id));
        }
        text_ += kMacros;
    }

    void set(const std::string& key, const std::string& value) {
        text_ += fmt::format("\\gfxreproset{{{}}}{{{}}}\n", key, escapeLatex(value));
    }

    void writeNumbers(const tables::Cell& cell, const std::string& key) {
        if (cell.printed) set(key + "/printed", *cell.printed);
        if (!cell.isPlanned) return;
        set(key, cell.measured);
        if (cell.isCalibrated) set(key + "/calibrated", "yes");
        if (cell.movedClock) set(key + "/clock", tables::clockText(*cell.movedClock));
        if (!cell.low.empty()) {
            set(key + "/low", cell.low);
            set(key + "/high", cell.high);
            set(key + "/bounds", std::string(tables::boundsName(cell.bounds())));
        } else if (cell.isOfOneSeed()) {
            set(key + "/bounds", "one seed");
        }
        if (cell.values.size() < 2) return;
        for (const tables::Measured& measured : cell.values) {
            set(fmt::format("{}/{}", key, measured.statistic), measured.text);
            if (measured.low.empty()) continue;
            set(fmt::format("{}/{}/low", key, measured.statistic), measured.low);
            set(fmt::format("{}/{}/high", key, measured.statistic), measured.high);
        }
    }

    /// Printed and measured stand in columns of their own, so that numbers align; alone what there
    /// is of one alone.
    void writeColumns() {
        const std::size_t labels = table_.rowAxes.size() + (table_.hasSources() ? 1 : 0);
        const bool areBoth = hasPrinted_ && !table_.isOnlyPrinted;
        const std::size_t width = areBoth ? 2 : 1;
        text_ += fmt::format("\\begin{{tabular}}{{{}{}}}\n\\toprule\n", std::string(labels, 'l'),
                             std::string(width * table_.columns.size(), 'r'));
        std::vector<std::string> head, subhead;
        for (const std::string& axis : table_.rowAxes) head.push_back(escapeLatex(axis));
        if (table_.hasSources()) head.emplace_back("source");
        subhead.resize(head.size());
        for (const tables::TableColumn& column : table_.columns) {
            const std::string label = escapeLatex(column.label);
            head.push_back(areBoth ? fmt::format("\\multicolumn{{2}}{{c}}{{{}}}", label) : label);
            subhead.insert(subhead.end(), {"printed", "measured"});
        }
        text_ += joined(head, " & ") + " \\\\\n";
        if (areBoth) text_ += joined(subhead, " & ") + " \\\\\n";
        text_ += "\\midrule\n";
    }

    void writeRow(std::size_t index) {
        const tables::TableRow& row = table_.rows[index];
        std::vector<std::string> cells;
        // Braces: after \\ a bracket or star would be its argument.
        for (const std::string& label : rowLabels_[index]) {
            cells.push_back(fmt::format("{{{}}}", escapeLatex(label)));
        }
        if (table_.hasSources()) cells.emplace_back(tables::sceneSourceName(row.source));
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const tables::Cell& cell = row.cells[i];
            if (hasPrinted_) cells.push_back(cell.printed ? cite(key(index, i) + "/printed") : "");
            if (!table_.isOnlyPrinted) cells.push_back(measuredCell(cell, key(index, i)));
        }
        text_ += joined(cells, " & ") + " \\\\\n";
    }

    static std::string measuredCell(const tables::Cell& cell, const std::string& key) {
        if (!cell.isPlanned) return "";
        const std::string number =
            cite(key) + (cell.isCalibrated ? kMark : "") + (cell.movedClock ? kClockMark : "");
        if (!cell.hasShownBounds()) return number;
        return fmt::format(
            fmt::runtime(cell.hasInterval() ? "{} {{\\scriptsize[{}, {}]}}"
                                            : "{} {{\\scriptsize({} \\ldots\\ {})}}"),
            number, cite(key + "/low"), cite(key + "/high"));
    }

    /// Below the table, in its own paragraph.
    void addNote(const std::string& latex) {
        text_ += fmt::format("\\par{{\\footnotesize {}\\par}}\n", latex);
    }

    const tables::Table& table_;
    const std::vector<std::string>& runNotes_;
    const std::vector<std::vector<std::string>> rowLabels_;  // beside the rows
    const std::string parameters_ = tables::parametersLine(table_);
    const bool hasPrinted_ = hasPrintedColumn(table_);
    std::vector<std::string> rowKeys_;     // beside the rows
    std::vector<std::string> columnKeys_;  // beside the columns
    std::string text_;
};

}  // namespace

std::string latexKeyPart(const std::string& label) {
    std::string part;
    for (const char c : label) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isKept = byte < 0x80 && (std::isalnum(byte) != 0 || c == '.' || c == '+' ||
                                            c == '-' || c == '_');
        const bool isContinued = (byte & 0xC0) == 0x80;  // of one letter in UTF-8
        if (!isContinued) part += isKept ? c : '-';
    }
    return part.empty() ? "none" : part;
}

std::string tableLatex(const tables::Table& table, const std::vector<std::string>& runNotes) {
    return LatexWriter(table, runNotes).write();
}

// JUnit.

namespace {

using Outcome = records::CaseEnd::Outcome;

std::vector<JunitTest> testsOf(const std::vector<records::CaseEnd>& cases) {
    std::map<std::string, int> known;
    std::vector<JunitTest> tests;
    for (const records::CaseEnd& one : cases) {
        // Those of several seeds of a scene have one title; others differ by what XML cannot write.
        const int count = ++known[escapeXml(one.title)];
        tests.push_back({one.table, one.title + (count > 1 ? fmt::format(" ({})", count) : ""),
                         one.outcome, one.text});
    }
    return tests;
}

std::vector<JunitTest> testsOf(const std::vector<claims::ClaimResult>& claims) {
    std::vector<JunitTest> tests;
    for (const claims::ClaimResult& claim : claims) {
        JunitTest test{claim.table, fmt::format("{} claim {}", claim.table, claim.id),
                       Outcome::Skipped, ""};
        if (claim.verdict == claims::Verdict::Holds) test.outcome = Outcome::Measured;
        if (claim.verdict == claims::Verdict::Fails) test.outcome = Outcome::Failed;
        test.message =
            fmt::format("{}: measured {}, required {}{}", claims::verdictName(claim.verdict),
                        claim.measured.empty() ? "nothing" : claim.measured, claim.required,
                        claim.reason.empty() ? "" : fmt::format(" ({})", claim.reason)) +
            (claim.because.empty() ? "" : fmt::format("; known: {}", claim.because));
        tests.push_back(std::move(test));
    }
    return tests;
}

}  // namespace

std::string junitSuite(std::string_view name, const std::vector<JunitTest>& tests) {
    const auto count = [&](Outcome outcome) {
        return std::ranges::count(tests, outcome, &JunitTest::outcome);
    };
    std::string text =
        fmt::format("<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n", name,
                    tests.size(), count(Outcome::Failed), count(Outcome::Skipped));
    for (const JunitTest& test : tests) {
        text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escapeXml(test.group),
                            escapeXml(test.name));
        if (test.outcome == Outcome::Measured) {
            text += "/>\n";
            continue;
        }
        text += fmt::format("><{} message=\"{}\"/></testcase>\n",
                            test.outcome == Outcome::Failed ? "failure" : "skipped",
                            escapeXml(test.message));
    }
    return text + "</testsuite>\n";
}

std::string junitXml(const std::vector<records::CaseEnd>& cases,
                     const std::vector<claims::ClaimResult>& results) {
    return std::string(kXmlHead) + "<testsuites>\n" + junitSuite("cases", testsOf(cases)) +
           junitSuite("claims", testsOf(results)) + "</testsuites>\n";
}

}  // namespace gfxrepro::report
