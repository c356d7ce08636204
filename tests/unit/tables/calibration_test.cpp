#include "runner/tables/calibration.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/support/support.h"

namespace gfxrepro::tables {
namespace {

/// A grid of `spread` with one measured value a column; none where it is negative.
Table tableOf(const std::vector<std::vector<double>>& rows) {
    Table table{.rowAxes = {"spread"}, .columns = {{"a", "%"}, {"b", "%"}}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        TableRow row{.labels = {std::to_string(i + 1)}, .cells = {}};
        for (const double value : rows[i]) {
            Cell& cell = row.cells.emplace_back();
            if (value < 0) continue;
            cell.status = records::Status::Ok;
            cell.values.emplace_back().value = value;
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

config::Experiment experimentOf() {
    config::Experiment experiment;
    experiment.document =
        parseYaml("fit: {a: {id: p/1, printed: 70}, b: {id: p/2, printed: 50}}", "t.yaml");
    return experiment;
}

TEST(Fit, TakesTheRowWithTheLeastSquares) {
    Table table = tableOf({{60, 50}, {73, 46}, {-1, 50}, {77, 57}});
    for (TableColumn& column : table.columns) column.unit = "ms";
    const Fit fit = fitOf(experimentOf(), table);
    ASSERT_EQ(fit.rows.size(), 3U);
    EXPECT_EQ(fit.unmeasured, 1U);
    EXPECT_EQ(fit.rows[0].row, 1U);
    EXPECT_THAT(fit.rows[0].residuals, ElementsAre(3.0, -4.0));
    EXPECT_NEAR(fit.rows[0].rms,
                std::hypot(std::log(73.0 / 70), std::log(46.0 / 50)) / std::sqrt(2.0), 1e-12)
        << "numbers that are no shares are held against each other by their ratio";
    EXPECT_EQ(fit.rows[1].row, 0U);
    EXPECT_THAT(fitNotes(fit, table),
                ElementsAre("rows of the fit that are not measured: 1",
                            "Fitted to 2 printed cells, none of which compares methods: spread=2. "
                            "Root mean square of the residuals 0.07 in logarithms; printed → "
                            "measured: a of p/1 70 → 73.00 (+3.00), b of p/2 50 → 46.00 (-4.00)",
                            "Second best of 3 rows: spread=1, 0.11 in logarithms"));
    const std::string rms = fmt::format("{}", fit.rows[0].rms);
    EXPECT_EQ(fitCsv(fit, table),
              "spread,column,table,printed,measured,residual,rms,unit,edges\n2,a,p/1,70,73,3," +
                  rms + ",in logarithms,\n2,b,p/2,50,46,-4," + rms + ",in logarithms,\n");
}

TEST(Fit, HoldsSharesAgainstEachOtherByLogOdds) {
    EXPECT_DOUBLE_EQ(logOdds(75), std::log(3.0));
    EXPECT_DOUBLE_EQ(logOdds(25), -logOdds(75));
    EXPECT_DOUBLE_EQ(logOdds(100), logOdds(99.99));
    EXPECT_DOUBLE_EQ(logOdds(0), logOdds(0.01));
    // Of 99 % and 50 %, 99.8 lacks a fifth of what it should, though it is 0.8 points off; 54 is 4.
    config::Experiment experiment;
    experiment.document =
        parseYaml("fit: {a: {id: p/1, printed: 99}, b: {id: p/2, printed: 50}}", "t.yaml");
    const Table table = tableOf({{99.8, 50}, {99, 54}});
    const Fit fit = fitOf(experiment, table);
    EXPECT_EQ(fit.rows[0].row, 1U);
    EXPECT_DOUBLE_EQ(fit.rows[0].rms, std::log(54.0 / 46.0) / std::sqrt(2.0));
    EXPECT_NEAR(fit.rows[1].rms, std::log(499.0 / 99.0) / std::sqrt(2.0), 1e-12);
    EXPECT_THAT(fitNotes(fit, table), Contains(HasSubstr("residuals 0.11 in log-odds; printed")));
}

TEST(Fit, TellsThatABetterRowMayLieBeyondTheGrid) {
    Table table = tableOf({{73, 46}, {60, 50}, {-1, 50}});
    table.rowAxes.insert(table.rowAxes.end(), {"leaves", "shape"});
    for (TableRow& row : table.rows) row.labels.insert(row.labels.end(), {"8000", "flat"});
    const Fit fit = fitOf(experimentOf(), table);
    // Of rows that are not measured nothing is known, of one number or words nothing lies beyond.
    EXPECT_THAT(fit.edges, ElementsAre("spread 1 of 1 to 2"));
    EXPECT_THAT(fitNotes(fit, table),
                Contains("The best row lies at the edge of what was tried: spread 1 of 1 to 2"));
    EXPECT_THAT(
        fitCsv(fit, table),
        HasSubstr("1,8000,flat,a,p/1,70,73,3,0.1539713236471667,in log-odds,spread 1 of 1 to 2\n"));
}

TEST(Fit, SaysNothingWithoutOne) {
    config::Experiment none;
    none.document = parseYaml("title: t", "t.yaml");
    EXPECT_THAT(fitNotes(fitOf(none, tableOf({{1, 2}})), tableOf({{1, 2}})), IsEmpty());
    const Table table = tableOf({{-1, 2}});
    EXPECT_THAT(fitNotes(fitOf(experimentOf(), table), table),
                ElementsAre("rows of the fit that are not measured: 1"));
    EXPECT_EQ(fitCsv(fitOf(experimentOf(), table), table), "");
}

TEST(Fit, IsSaidOnThePagesOfTheTablesThatItRead) {
    const TemporaryFolder folder;
    const Table grid = tableOf({{60, 50}, {73, 46}});
    folder.write("nest.csv", fitCsv(fitOf(experimentOf(), grid), grid));
    folder.write("nest.md", "not read");
    std::vector<Table> tables(2);
    tables[0].id = "p/1";
    tables[1].id = "p/3";
    addNotes(keptCalibrations(folder.path()), tables);
    EXPECT_THAT(
        tables[0].notes,
        ElementsAre("Calibrated blind, nest: spread 2 fitted to 2 printed cells that compare no "
                    "methods; of this table a 70 → 73.00 (root mean square of all residuals 0.15 "
                    "in log-odds; at the edge of what was tried: spread 2 of 1 to 2)"));
    EXPECT_THAT(tables[1].notes, IsEmpty());
    EXPECT_THAT(keptCalibrations(folder.path() / "none"), IsEmpty());
}

TEST(Fit, RefusesKeptFilesOfAnotherKind) {
    const TemporaryFolder folder;
    const auto errorOf = [&](const std::string& text) {
        folder.write("nest.csv", text);
        return errorText([&] { keptCalibrations(folder.path()); }, folder.path());
    };
    EXPECT_EQ(errorOf("spread,column\n1,a\n"),
              "DIR/nest.csv:1: is no fit, whose columns end in column, table, printed, measured, "
              "residual, rms, unit, edges");
    const std::string head = "spread,column,table,printed,measured,residual,rms,unit,edges\n";
    EXPECT_EQ(errorOf(head + "1,a,p/1,70\n"), "DIR/nest.csv:2: 4 fields; the head has 9");
    EXPECT_EQ(errorOf(head + "1,a,p/1,many,73,3,3,,\n"),
              "DIR/nest.csv:2: printed 'many' is no number");
}

}  // namespace
}  // namespace gfxrepro::tables
