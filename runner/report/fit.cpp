#include "runner/report/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/csv.h"

namespace gfxrepro::report {

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
