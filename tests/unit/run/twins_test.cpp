// Which cases are measured once, and what the others get.
#include "runner/run/twins.h"

#include <functional>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "runner/cluster/shards.h"
#include "runner/run/recorder.h"
#include "runner/run/rounds.h"
#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using config::Case;
using Lane = config::Measure::Lane;

TEST(Twins, AreOfOneWorkWhateverTheyAreCalled) {
    const Case item = makeCase("t/1", "a", 64);
    Case twin = makeCase("t/2", "a", 64);
    twin.axes = Node::map({});
    twin.given = Node::map({});
    twin.given.set("size", Node::number(64));
    twin.standsFor = Node::scalar("models/duck");
    twin.sceneSample = 1;
    twin.params.set("size", Node::scalar("64.0"));
    // Of rounds, which the timing lane alone has.
    twin.measure.timeBudgetS = 7.0;
    EXPECT_EQ(run::workKey(item), run::workKey(twin));
}

TEST(Twins, MayDifferByWhetherTheySavePictures) {
    Case item = makeCase("t/1", "a", 64);
    Case twin = makeCase("t/2", "a", 64);
    EXPECT_FALSE(run::savesPictures(twin));
    item.params.set("pictures", Node::scalar("false"));
    twin.params.set("pictures", Node::scalar("true"));
    EXPECT_EQ(run::workKey(item), run::workKey(twin));
    EXPECT_FALSE(run::savesPictures(item));
    EXPECT_TRUE(run::savesPictures(twin));
}

TEST(Twins, TheKeyIsTheHashOfATextThatLasts) {
    Case item = makeCase("t/1", "a", 64);
    item.seed = 18446744073709551615U;
    item.measure.repeats = 2;
    item.measure.processes = 3;
    item.measure.frames = 4;
    item.measure.timeLimitS = 5.5;
    EXPECT_EQ(run::workKey(item),
              sha256(R"({"technique":"mock","scene":null,"params":{"method":"a","size":64.0},)"
                     R"("output":[8.0,8.0],"measure":[0.0,2.0,3.0,4.0,5.5],)"
                     R"("seed":"18446744073709551615"})"));
}

TEST(Twins, DifferByAnythingThatIsMeasured) {
    const Case item = makeCase("t/1", "a", 64);
    const std::vector<std::pair<const char*, std::function<void(Case&)>>> changes = {
        {"technique", [](Case& c) { c.technique = "other"; }},
        {"scene", [](Case& c) { c.scene = Node::scalar("models/duck"); }},
        {"a parameter", [](Case& c) { c.params.set("size", Node::number(65)); }},
        {"one parameter more", [](Case& c) { c.params.set("bias", Node::number(0)); }},
        {"text and number", [](Case& c) { c.params.set("size", Node::scalar("64 m")); }},
        {"width", [](Case& c) { c.outputWidthPx = 9; }},
        {"height", [](Case& c) { c.outputHeightPx = 9; }},
        {"seed", [](Case& c) { ++c.seed; }},
        {"warm-up", [](Case& c) { c.measure.lane = Lane::Timing; }},
        {"repeats", [](Case& c) { ++c.measure.repeats; }},
        {"processes", [](Case& c) { ++c.measure.processes; }},
        {"frames", [](Case& c) { ++c.measure.frames; }},
        {"time limit", [](Case& c) { c.measure.timeLimitS += 1.0; }},
    };
    for (const auto& [what, change] : changes) {
        Case other = item;
        change(other);
        EXPECT_NE(run::workKey(other), run::workKey(item)) << what;
    }
}

TEST(Twins, AreOfTheQualityLaneOrOfWholeTablesOfTimes) {
    std::vector<Case> cases = {
        makeCase("t/1", "a", 1, Lane::Timing),
        makeCase("t/2", "a", 1, Lane::Timing),
        makeCase("t/1", "b", 1, Lane::Timing),
        makeCase("t/2", "c", 1, Lane::Timing),
        makeCase("q/1", "a", 1),
        makeCase("q/1", "b", 1),
        makeCase("q/2", "b", 1),
        makeCase("q/2", "a", 1),
        makeCase("q/3", "b", 1),
    };
    // Each of the two has a case that the other has not.
    EXPECT_THAT(run::firstTwins(cases), ElementsAre(0, 1, 2, 3, 4, 5, 5, 4, 5));
    EXPECT_THAT(run::withoutTwins(cases, {1, 2, 3, 4, 5, 6, 7, 8, 9}),
                ElementsAre(1, 2, 3, 4, 5, 6, 0, 0, 0));
    // All of the first are in the second, which stands behind it.
    cases[3] = makeCase("t/2", "b", 1, Lane::Timing);
    cases.push_back(makeCase("t/2", "c", 1, Lane::Timing));
    EXPECT_THAT(run::firstTwins(cases), ElementsAre(1, 1, 3, 3, 4, 5, 5, 4, 5, 9));
    EXPECT_THAT(run::lendersOfTimes(run::pointersTo(cases)), ElementsAre(Pair("t/1", "t/2")));
    EXPECT_THAT(cluster::indivisibleGroups(cases),
                ElementsAre(ElementsAre(0, 1, 2, 3, 9), ElementsAre(4, 7), ElementsAre(5, 6, 8)));
}

TEST(Twins, ATableOfTimesTakesThemFromOneThatIsMeasured) {
    const auto lenders = [](const std::vector<Case>& cases) {
        return run::lendersOfTimes(run::pointersTo(cases));
    };
    const auto timed = [](const char* table, const char* method) {
        return makeCase(table, method, 1, Lane::Timing);
    };
    // One within another within a third; two alike; one that has a case twice.
    EXPECT_THAT(lenders({timed("t/1", "a"), timed("t/2", "a"), timed("t/2", "b"), timed("t/3", "a"),
                         timed("t/3", "b"), timed("t/3", "c")}),
                ElementsAre(Pair("t/1", "t/3"), Pair("t/2", "t/3")));
    EXPECT_THAT(lenders({timed("t/2", "a"), timed("t/1", "a"), timed("t/3", "a")}),
                ElementsAre(Pair("t/2", "t/1"), Pair("t/3", "t/1")));
    EXPECT_THAT(lenders({timed("t/1", "a"), timed("t/2", "a"), timed("t/2", "a")}), IsEmpty());
    // Of a table, never of pictures without times.
    EXPECT_THAT(lenders({timed("t/1", "a"), makeCase("q/1", "a", 1)}), IsEmpty());
    // Rounds are of their table.
    for (const bool mayContinue : {false, true}) {
        std::vector<Case> cases = {timed("t/1", "a"), timed("t/2", "a")};
        for (Case& item : cases) {
            item.measure.processes = mayContinue ? 6 : 2;
            item.measure.timeBudgetS = mayContinue ? 60.0 : 0.0;
        }
        EXPECT_THAT(lenders(cases), IsEmpty());
        EXPECT_THAT(run::firstTwins(cases), ElementsAre(0, 1));
    }
    // A time is of a case with its pictures, or of one without.
    std::vector<Case> cases = {timed("t/1", "a"), timed("t/2", "a")};
    cases[1].params.set("pictures", Node::scalar("true"));
    EXPECT_THAT(lenders(cases), IsEmpty());
}

TEST(Twins, GoToOneShardAndStayUnitsOfTheirTables) {
    const run::Plan plan{.cases = {makeCase("q/1", "a", 1), makeCase("q/1", "b", 1),
                                   makeCase("q/2", "b", 1), makeCase("q/2", "a", 1),
                                   makeCase("q/2", "c", 1)}};
    EXPECT_THAT(cluster::indivisibleGroups(plan.cases),
                ElementsAre(ElementsAre(0, 3), ElementsAre(1, 2), ElementsAre(4)));
    EXPECT_EQ(run::unitsOf(plan).size(), 5U);
    const std::vector<double> timesS =
        run::withoutTwins(plan.cases, std::vector<double>{3, 4, 4, 3, 6});
    // 6 → 0, 4 → 1, 3 → 1: twins weigh nothing.
    EXPECT_THAT(cluster::cutShards(plan.cases, timesS, 2), ElementsAre(1, 1, 1, 1, 0));
}

TEST(Twins, FilesAreSharedUnderTheTwinsNames) {
    const TemporaryFolder folder;
    Case measured = makeCase("t/1", "a", 1);
    measured.id = "111111111111";
    Case twin = makeCase("t/1", "a", 1);
    twin.id = "222222222222";
    twin.axes = Node::map({});
    const fs::path run = folder.path();
    writeFileAtomic(run / "images/t-1/method=a,size=1-111111111111-result-f0002.png", "png");
    writeFileAtomic(run / "images/t-1/method=a,size=1-111111111111-result-f0002.exr", "exr");
    // Of a try that ended before it was recorded.
    writeFileAtomic(run / "images/t-1/222222222222-result-f0002.png", "old");

    const records::ImageEntry image{"111111111111",
                                    "t/1",
                                    2,
                                    "result",
                                    "images/t-1/method=a,size=1-111111111111-result-f0002.png",
                                    "images/t-1/method=a,size=1-111111111111-result-f0002.exr",
                                    measured.title(),
                                    "truth"};
    records::ImageEntry expected = image;
    expected.caseId = "222222222222";
    expected.title = "t/1";
    expected.png = "images/t-1/222222222222-result-f0002.png";
    expected.exr = "images/t-1/222222222222-result-f0002.exr";
    EXPECT_THAT(run::shareFiles(run, measured, twin, {image}), ElementsAre(expected));
    EXPECT_EQ(readFile(run / expected.png), "png");
    EXPECT_EQ(readFile(run / expected.exr), "exr");

    twin.experiment = "t/2";
    EXPECT_EQ(run::shareFiles(run, measured, twin, {image}).front().png,
              "images/t-2/222222222222-result-f0002.png");
    EXPECT_EQ(readFile(run / "images/t-2/222222222222-result-f0002.png"), "png");

    measured.params.set("pictures", Node::scalar("true"));
    EXPECT_THAT(run::shareFiles(run, measured, twin, {image}), IsEmpty());
    twin.params.set("pictures", Node::scalar("true"));

    fs::remove(run / image.png);
    EXPECT_EQ(errorText([&] { run::shareFiles(run, measured, twin, {image}); }),
              "cannot write " + (run / "images/t-2/222222222222-result-f0002.png").string() +
                  ": No such file or directory");
}

TEST(FileStem, BeginsWithWhatVariesAndKeepsTheId) {
    Case item = makeCase("t/1", "a", 64);
    item.id = "111111111111";
    item.axes = Node::map({});
    EXPECT_EQ(run::fileStem(item), "t-1/111111111111-");
    item.axes.set("scene", Node::scalar("/home/me/my models/duck two.glb"));
    item.axes.set("light_ratio", Node::scalar("0.25"));
    EXPECT_EQ(run::fileStem(item), "t-1/scene=duck_two.glb,light_ratio=0.25-111111111111-");
    item.axes.set("note", Node::scalar(std::string(300, 'x')));
    EXPECT_LT(run::fileStem(item).size(), 120U);
    EXPECT_TRUE(run::fileStem(item).ends_with("xxx-111111111111-"));
}

}  // namespace
}  // namespace gfxrepro::test
