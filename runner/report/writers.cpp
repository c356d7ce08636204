#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"
#include "runner/report/latex.h"
#include "runner/report/markup.h"
#include "runner/report/printed_parameters.h"
#include "runner/report/report.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

/// The statistics of a column, of all its rows, in the order of their formats.
std::vector<std::string> statisticsOf(const Table& table, std::size_t column) {
    std::vector<std::string> names;
    for (const TableRow& row : table.rows) {
        for (const Measured& measured : row.cells[column].values) {
            if (std::find(names.begin(), names.end(), measured.statistic) == names.end()) {
                names.push_back(measured.statistic);
            }
        }
    }
    if (names.empty()) names.emplace_back("");
    return names;
}

/// Nothing where there is nothing to say it of.
std::string_view atPrintedWord(const Table& table, const Cell& cell) {
    if (cell.values.empty() || !table.knowsPrintedParameters) return "";
    if (!cell.isAtPrintedParameters) return "no";
    return cell.openParameters.empty() ? "yes" : "as far as given";
}

bool hasCalibrated(const Table& table, std::size_t column) {
    return std::ranges::any_of(table.rows,
                               [&](const TableRow& row) { return row.cells[column].isCalibrated; });
}

std::string tableCsv(const Table& table) {
    std::string text;
    std::vector<std::vector<std::string>> statistics;
    CsvRow header(text);
    for (const std::string& axis : table.rowAxes) header.text(axis);
    if (table.hasSources()) header.text("source");
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& label = table.columns[i].label;
        statistics.push_back(statisticsOf(table, i));
        header.text(label + "_printed");
        for (const std::string& statistic : statistics[i]) {
            const std::string name = label + (statistics[i].size() > 1 ? "_" + statistic : "");
            header.text(name + "_measured").text(name + "_low").text(name + "_high");
            header.text(name + "_bounds");
        }
        header.text(label + "_status");
        if (table.isPublished) header.text(label + "_at_printed");
        if (hasCalibrated(table, i)) header.text(label + "_calibrated");
    }
    if (table.isPublished) header.text("parameters");
    header.end();
    for (const TableRow& row : table.rows) {
        CsvRow line(text);
        for (const std::string& label : row.labels) line.text(label);
        if (table.hasSources()) line.text(sceneSourceName(row.source));
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const Cell& cell = row.cells[i];
            line.text(cell.printed.value_or(""));
            for (const std::string& statistic : statistics[i]) {
                const Measured* measured = cell.find(statistic);
                if (measured) {
                    line.number(measured->value);
                    line.number(measured->interval.low).number(measured->interval.high);
                    line.text(boundsName(measured->bounds));
                } else {
                    line.text("").text("").text("").text("");
                }
            }
            line.text(cell.isPlanned ? statusName(cell.status) : "");
            if (table.isPublished) line.text(atPrintedWord(table, cell));
            if (hasCalibrated(table, i)) line.text(cell.isCalibrated ? "yes" : "no");
        }
        if (table.isPublished) line.text(parametersLine(table, row));
        line.end();
    }
    return text;
}

std::string markdownCell(const Cell& cell, bool isOnlyPrinted) {
    std::string text;
    if (cell.printed) text += escapeMarkdown(*cell.printed) + (isOnlyPrinted ? "" : " → ");
    text += cell.isPlanned ? escapeMarkdown(cell.measured) : "";
    if (cell.isPlanned && cell.isCalibrated) text += kCalibratedMark;
    if (cell.hasShownBounds()) {
        const bool isInterval = cell.bounds() == Bounds::Interval;
        text += fmt::format(fmt::runtime(isInterval ? " [{}, {}]" : " ({} … {})"),
                            escapeMarkdown(cell.low), escapeMarkdown(cell.high));
    }
    return text;
}

bool hasCountedShares(const Table& table) {
    return std::ranges::any_of(table.rows, [](const TableRow& row) {
        return std::ranges::any_of(row.cells, [](const Cell& cell) {
            return cell.hasShownBounds() && cell.bounds() == Bounds::Interval && cell.unit == "%";
        });
    });
}

/// What the bounds beside the numbers are.
std::string boundsLegend(const Table& table) {
    const char* interval = hasCountedShares(table)
                               ? " [95 % interval; of a share that was counted once, by its count "
                                 "alone: other scenes may differ by more]"
                               : " [95 % interval]";
    const bool hasPrinted = std::ranges::any_of(table.rows, [](const TableRow& row) {
        return std::ranges::any_of(row.cells,
                                   [](const Cell& cell) { return cell.printed.has_value(); });
    });
    return fmt::format("{}{}{}.", hasPrinted ? "Printed → measured" : "Measured",
                       table.hasShown(Bounds::Interval) ? interval : "",
                       table.hasShown(Bounds::Range)
                           ? " (range, min … max: too few processes for an interval)"
                           : "");
}

std::string tableMarkdown(const Table& table) {
    std::string text = fmt::format("# {}\n\n", escapeMarkdown(table.label + ". " + table.title));
    text += table.isOnlyPrinted ? "As printed; nothing is measured." : boundsLegend(table);
    if (!table.constants.empty()) {
        text += fmt::format("\n\nIn every row: {}.", escapeMarkdown(joined(table.constants)));
    }
    if (!table.hardware.empty())
        text += fmt::format(" Printed: {}.", escapeMarkdown(table.hardware));
    if (const std::string parameters = parametersLine(table); !parameters.empty())
        text += "\n\n" + escapeMarkdown(parameters);
    text += "\n\n|";
    std::string rule = "|";
    for (const std::string& axis : table.rowAxes) {
        text += fmt::format(" {} |", escapeMarkdown(axis));
        rule += " --- |";
    }
    if (table.hasSources()) {
        text += " source |";
        rule += " --- |";
    }
    for (const TableColumn& column : table.columns) {
        text += fmt::format(" {} |", escapeMarkdown(column.label));
        rule += " ---: |";
    }
    text += "\n" + rule + "\n";
    for (const TableRow& row : table.rows) {
        text += "|";
        for (const std::string& label : row.labels)
            text += fmt::format(" {} |", escapeMarkdown(label));
        if (table.hasSources()) text += fmt::format(" {} |", sceneSourceName(row.source));
        for (const Cell& cell : row.cells)
            text += fmt::format(" {} |", markdownCell(cell, table.isOnlyPrinted));
        text += "\n";
    }
    if (table.hasCalibrated()) {
        text += fmt::format("\n{} {}.\n", kCalibratedMark, kCalibratedLegend);
    }
    if (!table.remark.empty()) text += fmt::format("\nRemark: {}\n", escapeMarkdown(table.remark));
    for (const std::string& note : table.notes)
        text += fmt::format("\nNote: {}\n", escapeMarkdown(note));
    std::vector<std::string> absent;
    for (const TableRow& row : table.printedRows) {
        std::vector<std::string> said = row.labels;
        for (const Cell& cell : row.cells) {
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

std::string claimsCsv(const std::vector<ClaimResult>& results, const ReportContext& context) {
    std::string text = fmt::format("{}\n", fmt::join(kClaimsColumns, ","));
    for (const ClaimResult& result : results) {
        const std::string_view bound =
            result.boundFrom ? config::boundSourceName(*result.boundFrom) : "";
        const std::string_view kind = result.timeKind ? config::timeKindName(*result.timeKind) : "";
        CsvRow row(text);
        row.text(result.id).text(result.text).text(result.table);
        row.text(context.device).text(context.profile);
        row.text(config::originName(result.origin)).text(bound).text(kind);
        row.text(verdictName(result.verdict)).text(verdictName(result.known));
        row.text(result.measured).text(result.required).text(result.margin).text(result.reason);
        row.text(result.because).text(result.restsOn).end();
    }
    return text;
}

}  // namespace

std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const PlannedCase> planned,
                               const std::vector<Record>& records) {
    std::vector<Table> tables;
    for (const config::Experiment& experiment : experiments) {
        tables.push_back(buildTable(experiment, planned, records));
    }
    return tables;
}

void writeTables(const fs::path& runDir, const std::vector<Table>& tables) {
    for (const Table& table : tables) {
        if (table.columns.empty()) continue;
        const fs::path folder = runDir / "tables";
        writeFileAtomic(folder / (table.slug + ".csv"), tableCsv(table));
        writeFileAtomic(folder / (table.slug + ".md"), tableMarkdown(table));
        writeFileAtomic(folder / (table.slug + ".tex"), tableLatex(table));
    }
}

std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<Table>& tables,
                                        const ReportContext& context) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<ClaimResult> results;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        for (ClaimResult& result : evaluateClaims(experiments[i], tables[i], context)) {
            results.push_back(std::move(result));
        }
    }
    return results;
}

void writeClaims(const fs::path& runDir, const std::vector<CaseResult>& cases,
                 const std::vector<ClaimResult>& results, const ReportContext& context) {
    writeFileAtomic(runDir / "claims.csv", claimsCsv(results, context));
    writeFileAtomic(runDir / "junit.xml", junitXml(cases, results));
}

}  // namespace gfxrepro::report
