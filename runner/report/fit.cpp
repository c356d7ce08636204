#include "runner/report/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

namespace {

const Cell* cellOf(const TableRow& row, const Table& table, const std::string& column) {
    const auto at = std::ranges::find(table.columns, column, &TableColumn::label);
    return at == table.columns.end()
               ? nullptr
               : &row.cells[static_cast<std::size_t>(at - table.columns.begin())];
}

std::string unitOf(const Fit& fit, const Table& table) {
    const auto at =
        std::ranges::find(table.columns, fit.targets.front().column, &TableColumn::label);
    const std::string unit = at == table.columns.end() ? "" : at->unit;
    return unit == "%" ? " percentage points" : unit.empty() ? "" : " " + unit;
}

}  // namespace

Fit fitOf(const config::Experiment& experiment, const Table& table) {
    Fit fit{.targets = config::fitTargets(experiment), .rows = {}};
    if (fit.targets.empty()) return fit;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        FitRow row{.row = i, .residuals = {}};
        double squares = 0.0;
        for (const config::FitTarget& target : fit.targets) {
            const Cell* cell = cellOf(table.rows[i], table, target.column);
            if (!cell || !cell->isOk() || cell->isPartial) break;
            row.residuals.push_back(cell->values.front().value - target.printed);
            squares += row.residuals.back() * row.residuals.back();
        }
        if (row.residuals.size() < fit.targets.size()) {
            ++fit.unmeasured;
            continue;
        }
        row.rms = std::sqrt(squares / static_cast<double>(fit.targets.size()));
        fit.rows.push_back(std::move(row));
    }
    std::ranges::stable_sort(fit.rows, {}, &FitRow::rms);
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
        "residuals {:.2f}{}; printed → measured: {}",
        fit.targets.size(), table.rowName(best.row), best.rms, unitOf(fit, table), joined(cells)));
    if (fit.rows.size() > 1) {
        notes.push_back(fmt::format("Second best of {} rows: {}, {:.2f}{}", fit.rows.size(),
                                    table.rowName(fit.rows[1].row), fit.rows[1].rms,
                                    unitOf(fit, table)));
    }
    return notes;
}

std::string fitCsv(const Fit& fit, const Table& table) {
    if (fit.rows.empty()) return "";
    const FitRow& best = fit.rows.front();
    std::string text;
    CsvRow header(text);
    for (const std::string& axis : table.rowAxes) header.text(axis);
    for (const char* name : {"column", "table", "printed", "measured", "residual", "rms"}) {
        header.text(name);
    }
    header.end();
    for (std::size_t i = 0; i < fit.targets.size(); ++i) {
        const config::FitTarget& target = fit.targets[i];
        CsvRow line(text);
        for (const std::string& label : table.rows[best.row].labels) line.text(label);
        line.text(target.column).text(target.table).number(target.printed);
        line.number(target.printed + best.residuals[i]).number(best.residuals[i]);
        line.number(best.rms).end();
    }
    return text;
}

namespace {

/// Of one calibration, what concerns a table; empty where nothing does.
std::string calibrationNote(const std::string& table, const fs::path& file) {
    const std::string text = readFile(file);
    CsvReader reader(text, file.string());
    std::vector<std::string> header, row, fitted, cells;
    reader.next(header);
    const auto first = std::ranges::find(header, "column");
    const auto axes = static_cast<std::size_t>(first - header.begin());
    if (axes == header.size() || axes + 6 != header.size()) {
        throw Error(reader.location(),
                    "is no fit; its columns end in column, table, printed, "
                    "measured, residual, rms");
    }
    std::size_t count = 0;
    double rms = 0.0;
    while (reader.next(row)) {
        if (row.size() != header.size()) {
            throw Error(reader.location(),
                        fmt::format("{} fields; the head has {}", row.size(), header.size()));
        }
        const auto number = [&](std::size_t at) {
            const auto value = parseDouble(row[axes + at]);
            if (!value) throw Error(reader.location(), "'" + row[axes + at] + "' is no number");
            return *value;
        };
        ++count;
        rms = number(5);
        if (row[axes + 1] != table) continue;
        cells.push_back(fmt::format("{} {:g} → {:.2f}", row[axes], number(2), number(3)));
        if (!fitted.empty()) continue;
        for (std::size_t i = 0; i < axes; ++i) fitted.push_back(header[i] + " " + row[i]);
    }
    if (cells.empty()) return "";
    return fmt::format(
        "Calibrated blind, {}: {} fitted to {} printed cells that compare no methods; of this "
        "table {} (root mean square of all residuals {:.2f})",
        file.stem().string(), joined(fitted), count, joined(cells), rms);
}

}  // namespace

std::vector<std::string> calibrationNotes(const std::string& table, const fs::path& folder) {
    if (!fs::is_directory(folder)) return {};
    std::set<fs::path> files;
    for (const fs::directory_entry& file : fs::directory_iterator(folder)) {
        if (file.path().extension() == ".csv") files.insert(file.path());
    }
    std::vector<std::string> notes;
    for (const fs::path& file : files) {
        if (std::string note = calibrationNote(table, file); !note.empty()) {
            notes.push_back(std::move(note));
        }
    }
    return notes;
}

std::vector<std::string> calibrationNotes(const std::string& table) {
    return calibrationNotes(table, dataFolder("configs").parent_path() / "results/calibration");
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

}  // namespace gfxrepro::report
