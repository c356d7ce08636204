#include "runner/config/printed_section.h"

#include "engine/core/files.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

struct FitTest : ExperimentTest {
    void SetUp() override { writeTable("70"); }

    /// A table of two methods; `conventional` is the one printed number that a fit may see.
    void writeTable(const std::string& conventional, const std::string& others = "1") const {
        folder.write("p/table.yaml",
                     "table: p/1\ntitle: t\ntechnique: x\n"
                     "sweep: {scene: [grass, tree], method: [conventional, better]}\n"
                     "layout:\n  rows: scene\n  columns:\n"
                     "    plain: {where: {method: conventional}, metric: redundant_pct}\n"
                     "    ours: {where: {method: better}, metric: redundant_pct}\n"
                     "    both: {metric: redundant_pct}\n"
                     "    plain_min: {where: {method: conventional}, metric: min_pct}\n"
                     "printed:\n  calibrated: [" +
                         calibrated_ +
                         "]\n"
                         "  values: |\n    scene,plain,ours,both,plain_min\n"
                         "    grass," +
                         conventional + "," + others + "," + others + "," + others + "\n    tree," +
                         others + "," + others + "," + others + ",lost\n");
    }
    std::string calibrated_ = "{column: [plain, ours, both, plain_min]}";
    std::string text(const std::string& row, const std::string& column,
                     const std::string& method = "params: {method: conventional}") const {
        return "sweep_of: c\ntitle: t\ntechnique: x\n" + method +
               "\nscene: grass\nsweep: {spread: [0.1, 0.2]}\n"
               "layout: {rows: spread, columns: {a: redundant_pct}}\n"
               "fit:\n  a: {table: p/table.yaml, row: {scene: " +
               row + "}, column: " + column + "}\n";
    }
    std::string errorOf(const std::string& row, const std::string& column,
                        const std::string& method = "params: {method: conventional}") const {
        return loadError(text(row, column, method));
    }
};

TEST_F(FitTest, SeesTheNamedCellAlone) {
    const Experiment fit = load(text("grass", "plain"));
    ASSERT_EQ(fitTargets(fit).size(), 1U);
    EXPECT_EQ(fitTargets(fit)[0].column, "a");
    EXPECT_EQ(fitTargets(fit)[0].table, "p/1");
    EXPECT_EQ(fitTargets(fit)[0].printed, 70.0);
    // Whatever else is printed there: the experiment is the same, all of it.
    writeTable("70", "99");
    EXPECT_TRUE(load(text("grass", "plain")).document.sameContent(fit.document));
    writeTable("71", "99");
    EXPECT_FALSE(load(text("grass", "plain")).document.sameContent(fit.document));
    const Experiment again = experimentFromDocument(fit.document, fit.file);
    EXPECT_EQ(fitTargets(again).at(0).printed, 70.0) << "a plan has what it needs";
    EXPECT_TRUE(fitTargets(load("sweep_of: c\ntitle: t\ntechnique: x\n")).empty());
}

TEST_F(FitTest, RefusesCellsThatTheirTableDoesNotMark) {
    const std::string error =
        "DIR/zju/a.yaml:9:57: fit: 'a': p/1 does not mark the cell as one that was fitted "
        "('printed.calibrated')";
    for (const char* marked :
         {"", "{column: ours}", "{scene: tree}", "{scene: tree, column: plain}"}) {
        calibrated_ = marked;
        writeTable("70");
        EXPECT_EQ(errorOf("grass", "plain"), error) << marked;
    }
    for (const char* marked : {"{column: plain}", "{scene: [tree, grass]}",
                               "{column: ours}, {scene: grass, column: [both, plain]}"}) {
        calibrated_ = marked;
        writeTable("70");
        EXPECT_EQ(errorOf("grass", "plain"), "no error") << marked;
    }
}

TEST_F(FitTest, RefusesWhatComparesMethods) {
    EXPECT_EQ(errorOf("grass", "ours"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method 'better', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(errorOf("grass", "both"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method '', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_THAT(errorOf("grass", "plain", "params: {}"),
                StartsWith("DIR/zju/a.yaml:9:6: fit: 'a': the cases are not all of one method"));
    EXPECT_EQ(loadError("sweep_of: c\ntitle: t\ntechnique: x\nscene: grass\n"
                        "sweep: {method: [conventional, better]}\n"
                        "layout: {rows: method, columns: {a: redundant_pct}}\n"
                        "fit:\n  a: {table: p/table.yaml, row: {scene: grass}, column: plain}\n"),
              "DIR/zju/a.yaml:8:6: fit: 'a': the cases are not all of one method in 'params'");
}

TEST_F(FitTest, FindsAColumnByTheLabelsOfAllItsAxes) {
    folder.write("p/table.yaml",
                 "table: p/1\ntitle: t\ntechnique: x\n"
                 "sweep: {scene: [grass, tree], method: [conventional, better]}\n"
                 "layout:\n  axes:\n    error:\n"
                 "      mean: {metric: redundant_pct}\n      worst: {metric: min_pct}\n"
                 "  rows: scene\n  columns: [error, method]\n"
                 "printed:\n  calibrated: [{scene: grass}]\n"
                 "  values: |\n    scene,mean_conventional,mean_better,worst_conventional\n"
                 "    grass,70,1,2\n    tree,3,4,5\n");
    EXPECT_EQ(fitTargets(load(text("grass", "mean_conventional"))).at(0).printed, 70.0);
    EXPECT_EQ(errorOf("grass", "mean_better"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method 'better', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(
        errorOf("grass", "worst_conventional"),
        "DIR/zju/a.yaml:9:57: fit: 'a': the column is redundant_pct, the printed cell min_pct");
}

TEST_F(FitTest, RefusesMethodsThatThePaperComparesEvenIfItMeasuresThem) {
    EXPECT_EQ(errorOf("grass", "ours", "params: {method: better}"), "no error");
    const std::string path = "p/table.yaml";
    const std::string table = readFile(folder.path() / path);
    folder.write(path, table + "  compared: [better]\n");
    EXPECT_EQ(errorOf("grass", "ours", "params: {method: better}"),
              "DIR/zju/a.yaml:9:57: fit: 'a': p/1 compares method 'better' with a usual one "
              "('compared'); a fit sees what compares no methods");
    EXPECT_EQ(errorOf("grass", "plain"), "no error");
}

TEST_F(FitTest, RefusesCellsThatAreNotThere) {
    EXPECT_EQ(errorOf("gras", "plain"), "DIR/zju/a.yaml:9:56: fit: 'a': no row gras is printed");
    EXPECT_EQ(errorOf("grass", "plane"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method '', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(
        errorOf("grass", "plain_min"),
        "DIR/zju/a.yaml:9:57: fit: 'a': the column is redundant_pct, the printed cell min_pct");
    const std::string start =
        "sweep_of: c\ntitle: t\ntechnique: x\nparams: {method: conventional}\n"
        "layout: {rows: method, columns: {a: redundant_pct}}\n";
    EXPECT_EQ(
        loadError(start + "fit: {b: {table: p/table.yaml, row: {scene: grass}, column: x}}\n"),
        "DIR/zju/a.yaml:6:7: fit: no column 'b'; did you mean 'a'?");
    EXPECT_THAT(
        loadError(start + "fit: {a: {table: p/none.yaml, row: {scene: grass}, column: x}}\n"),
        StartsWith("DIR/zju/a.yaml:6:18: fit: 'a': no file 'p/none.yaml' in DIR"));
    EXPECT_THAT(loadError(start + "fit: {a: {table: p/table.yaml, printed: 3}}\n"),
                StartsWith("DIR/zju/a.yaml:6:32: fit: 'a': unknown key 'printed'"));
    EXPECT_EQ(loadError("sweep_of: c\ntitle: t\ntechnique: x\nfit: {}\n"),
              "DIR/zju/a.yaml:4:1: 'fit' without 'layout'");
}

}  // namespace
}  // namespace gfxrepro::config
