#include "runner/tables/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ranges>
#include <set>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/csv.h"

namespace gfxrepro::tables {

namespace fs = std::filesystem;

namespace {

/// Of a kept fit, behind the row axes.
constexpr std::array kFitColumns{"column",   "table", "printed", "measured",
                                 "residual", "rms",   "unit",    "edges"};

const Cell* cellOf(const TableRow& row, const Table& table, const std::string& column) {
    const auto at = table.findColumn(column);
    return at ? &row.cells[*at] : nullptr;
}

/// Of the root mean square.
std::string unitOf(const Fit& fit, const Table& table) {
    const auto at = table.findColumn(fit.targets.front().column);
    const std::string unit = at ? table.columns[*at].unit : "";
    return unit == "%" ? "in log-odds" : "in logarithms";
}

std::string rmsText(double rms, const std::string& unit) {
    return fmt::format("{:.2f} {}", rms, unit);
}

std::vector<std::string> edgesOf(const Fit& fit, const Table& table) {
    std::vector<std::string> edges;
    for (std::size_t axis = 0; axis < table.rowAxes.size(); ++axis) {
        const auto numberOf = [&](const FitRow& row) {
            return parseDouble(table.rows[row.row].labels[axis]);
        };
        const auto best = numberOf(fit.rows.front());
        const auto [least, greatest] =
            std::ranges::minmax(fit.rows | std::views::transform(numberOf));
        // Of words none is the last; of a single number nothing was fitted.
        if (!least || *least == *greatest || (best != least && best != greatest)) continue;
        edges.push_back(
            fmt::format("{} {:g} of {:g} to {:g}", table.rowAxes[axis], *best, *least, *greatest));
    }
    return edges;
}

}  // namespace

double logOdds(double pct) {
    constexpr double kFinestPct = 0.01;
    const double share = std::clamp(pct, kFinestPct, 100.0 - kFinestPct);
    return std::log(share / (100.0 - share));
}

Fit fitOf(const config::Experiment& experiment, const Table& table) {
    Fit fit{.targets = config::fitTargets(experiment), .rows = {}, .edges = {}};
    if (fit.targets.empty()) return fit;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        FitRow row{.row = i, .residuals = {}};
        double squares = 0.0;
        for (const config::FitTarget& target : fit.targets) {
            const Cell* cell = cellOf(table.rows[i], table, target.column);
            if (!cell || !cell->isOk() || cell->isPartial) break;
            const double measured = cell->values.front().value;
            row.residuals.push_back(measured - target.printed);
            const bool isShare = table.columns[*table.findColumn(target.column)].unit == "%";
            const auto scaled = [&](double value) {
                return isShare ? logOdds(value) : std::log(std::max(value, 0.0));
            };
            const double off = scaled(measured) - scaled(target.printed);
            squares += off * off;
        }
        if (row.residuals.size() < fit.targets.size()) {
            ++fit.unmeasured;
            continue;
        }
        row.rms = std::sqrt(squares / static_cast<double>(fit.targets.size()));
        fit.rows.push_back(std::move(row));
    }
    std::ranges::stable_sort(fit.rows, {}, &FitRow::rms);
    if (!fit.rows.empty()) fit.edges = edgesOf(fit, table);
    return fit;
}

std::vector<std::string> fitNotes(const Fit& fit, const Table& table) {
    if (fit.targets.empty()) return {};
    std::vector<std::string> notes;
    if (fit.unmeasured > 0) {
        notes.push_back(fmt::format("rows of the fit that are not measured: {}", fit.unmeasured));
    }
    if (fit.rows.empty()) return notes;
    const FitRow& best = fit.rows.front();
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < fit.targets.size(); ++i) {
        const config::FitTarget& target = fit.targets[i];
        cells.push_back(fmt::format("{} of {} {:g} → {:.2f} ({:+.2f})", target.column, target.table,
                                    target.printed, target.printed + best.residuals[i],
                                    best.residuals[i]));
    }
    notes.push_back(fmt::format(
        "Fitted to {} printed cells, none of which compares methods: {}. Root mean square of the "
        "residuals {}; printed → measured: {}",
        fit.targets.size(), table.rowName(best.row), rmsText(best.rms, unitOf(fit, table)),
        joined(cells)));
    if (!fit.edges.empty()) {
        notes.push_back(
            fmt::format("The best row lies at the edge of what was tried: {}", joined(fit.edges)));
    }
    if (fit.rows.size() > 1) {
        notes.push_back(fmt::format("Second best of {} rows: {}, {}", fit.rows.size(),
                                    table.rowName(fit.rows[1].row),
                                    rmsText(fit.rows[1].rms, unitOf(fit, table))));
    }
    return notes;
}

std::string fitCsv(const Fit& fit, const Table& table) {
    if (fit.rows.empty()) return "";
    const FitRow& best = fit.rows.front();
    std::string text;
    records::CsvRow header(text);
    for (const std::string& axis : table.rowAxes) header.text(axis);
    for (const char* name : kFitColumns) header.text(name);
    header.end();
    for (std::size_t i = 0; i < fit.targets.size(); ++i) {
        const config::FitTarget& target = fit.targets[i];
        records::CsvRow line(text);
        for (const std::string& label : table.rows[best.row].labels) line.text(label);
        line.text(target.column).text(target.table).number(target.printed);
        line.number(target.printed + best.residuals[i]).number(best.residuals[i]);
        line.number(best.rms).text(unitOf(fit, table)).text(joined(fit.edges)).end();
    }
    return text;
}

namespace {

/// A line of a kept fit, by the names of its columns.
using FitLine = std::map<std::string, std::string>;

double numberOf(const FitLine& line, const std::string& name, const SourceLocation& where) {
    const auto value = parseDouble(line.at(name));
    if (!value) throw Error(where, fmt::format("{} '{}' is no number", name, line.at(name)));
    return *value;
}

/// Adds what one calibration says of the tables that it read.
void addCalibration(const fs::path& file, TableNotes& kept) {
    const std::string text = readFile(file);
    records::CsvReader reader(text, file.string());
    std::vector<std::string> header, row, fitted;
    reader.next(header);
    const auto first = std::ranges::find(header, "column");
    if (!std::ranges::equal(std::ranges::subrange(first, header.end()), kFitColumns)) {
        throw Error(reader.location(), fmt::format("is no fit, whose columns end in {}",
                                                   fmt::join(kFitColumns, ", ")));
    }
    std::map<std::string, std::vector<std::string>> cells;  // by table
    std::size_t count = 0;
    std::string rms, edges;
    for (; reader.next(row); ++count) {
        if (row.size() != header.size()) {
            throw Error(reader.location(),
                        fmt::format("{} fields; the head has {}", row.size(), header.size()));
        }
        FitLine line;
        for (std::size_t i = 0; i < row.size(); ++i) line[header[i]] = row[i];
        cells[line["table"]].push_back(fmt::format("{} {:g} → {:.2f}", line["column"],
                                                   numberOf(line, "printed", reader.location()),
                                                   numberOf(line, "measured", reader.location())));
        rms = rmsText(numberOf(line, "rms", reader.location()), line["unit"]);
        if (count > 0) continue;
        if (!line["edges"].empty()) edges = "; at the edge of what was tried: " + line["edges"];
        for (auto name = header.begin(); name != first; ++name) {
            fitted.push_back(*name + " " + line[*name]);
        }
    }
    for (const auto& [table, ofTable] : cells) {
        kept[table].push_back(fmt::format(
            "Calibrated blind, {}: {} fitted to {} printed cells that compare no methods; of this "
            "table {} (root mean square of all residuals {}{})",
            file.stem().string(), joined(fitted), count, joined(ofTable), rms, edges));
    }
}

}  // namespace

TableNotes keptCalibrations(const fs::path& folder) {
    TableNotes kept;
    if (!fs::is_directory(folder)) return kept;
    std::set<fs::path> files;
    for (const fs::directory_entry& file : entriesIn(folder)) {
        if (file.path().extension() == ".csv") files.insert(file.path());
    }
    for (const fs::path& file : files) addCalibration(file, kept);
    return kept;
}

void addNotes(const TableNotes& about, std::vector<Table>& tables) {
    for (Table& table : tables) {
        const auto notes = about.find(table.id);
        if (notes == about.end()) continue;
        table.notes.insert(table.notes.end(), notes->second.begin(), notes->second.end());
    }
}

void writeFits(const std::filesystem::path& runDir,
               const std::vector<config::Experiment>& experiments,
               const std::vector<Table>& tables) {
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        const std::string text = fitCsv(fitOf(experiments[i], tables[i]), tables[i]);
        if (text.empty()) continue;
        writeFileAtomic(runDir / "tables" / (tables[i].slug + ".fit.csv"), text);
    }
}

}  // namespace gfxrepro::tables
