#include "runner/tables/printed.h"

#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

/// Of a table with rows scene (duck, bunny) and a profile that measures the dragon, too.
std::string errorOf(const std::string& rows) {
    const std::string body =
        "layout: {rows: scene, columns: {ms: {metric: m, format: \"{mean:.2f}\"}, both: {metric: "
        "m, format: \"{mean:.1f}/{max:.1f}\"}}}\n"
        "printed:\n  values: |\n    scene,ms,both\n    # a remark\n" +
        rows;
    const config::Experiment whole = experimentFrom("sweep: {scene: [duck, bunny]}\n" + body);
    const config::Experiment paper = experimentFrom("sweep: {scene: [duck, dragon]}\n" + body);
    const std::vector<Table> tables = {buildTable(whole, Recorded()),
                                       buildTable(paper, Recorded())};
    const std::string text = errorText([&] { requirePrintedValues(whole, tables); });
    const std::size_t at = text.find(".yaml:");
    return at == std::string::npos ? text : text.substr(at + 6);
}

TEST(PrintedValues, HaveARowInSomeProfile) {
    EXPECT_EQ(errorOf("    duck,1,2/3\n    dragon,1,\n"), "no error");
    EXPECT_EQ(errorOf("    duck,1,2/3\n    dargon,1,\n"),
              "11: printed: no profile measures the row 'dargon,1,'; allowed: scene duck | bunny | "
              "dragon");
}

TEST(PrintedValues, AreWrittenAsTheirCells) {
    EXPECT_EQ(errorOf("    duck,12x8,\n"),
              "10: printed: ms is '12x8'; allowed: as the cell's format writes numbers, or empty "
              "where it is lost");
    EXPECT_EQ(errorOf("    duck,1,2\n").substr(0, 26), "10: printed: both is '2'; ");
    EXPECT_EQ(errorOf("    dragon,1e3,2/\n").substr(0, 25), "10: printed: both is '2/'");
    EXPECT_EQ(errorOf("    duck,,\n"), "no error");
}

}  // namespace
}  // namespace gfxrepro::tables
