// Where pictures of a page lie.
#include "runner/report/picture_grid.h"

#include <gmock/gmock.h>

namespace gfxrepro::report {
namespace {

using testing::ElementsAre;

tables::TableRow rowOf(const std::string& label, const std::vector<std::string>& cases) {
    tables::TableRow row;
    row.labels = {label};
    for (const std::vector<std::string>& ids : {std::vector{cases.back()}, cases}) {
        row.cells.emplace_back().caseIds = ids;
    }
    return row;
}

/// Methods "a" and "b" in rows, and each beside the first in a column of its own.
RunPart partOfRivals() {
    RunPart part;
    part.table.rowAxes = {"method"};
    part.table.columns.resize(2);
    part.table.columns[0].label = "frame_ms";
    part.table.columns[1].label = "frame ÷ a";
    part.table.rows = {rowOf("a", {"1"}), rowOf("b", {"1", "2"})};
    for (const std::string id : {"1", "2"}) {
        Shot shot;
        shot.caseId = id;
        shot.name = shot.baseName = "result";
        part.shots.push_back(shot);
    }
    return part;
}

std::vector<std::string> columnsOf(const Page& page, const Model& model) {
    const PageShots all = shotsOf(page, model);
    std::set<std::size_t> chosen;
    for (std::size_t i = 0; i < all.shots.size(); ++i) chosen.insert(i);
    return pictureGrid(page, all, {}, chosen).columns;
}

TEST(PictureGrid, TheFirstOfRivalsKeepsItsName) {
    const ReportRun run{};
    Page page;
    page.parts = {partOfRivals()};
    EXPECT_THAT(columnsOf(page, Model{{&run, 1}, {}, {}, {}}), ElementsAre("a", "b"));
}

TEST(PictureGrid, RunsStandBesideEachOther) {
    const std::vector<ReportRun> runs(2);
    Page page;
    page.parts = {partOfRivals(), partOfRivals()};
    EXPECT_THAT(columnsOf(page, Model{runs, {}, {}, {}}),
                ElementsAre("A, a", "B, a", "A, b", "B, b"));
}

}  // namespace
}  // namespace gfxrepro::report
