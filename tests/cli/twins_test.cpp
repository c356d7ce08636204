// Equal cases of two tables are measured once and recorded for both.
#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// table-<index>.yaml of the mock with these lines.
std::string writeTable(const TemporaryFolder& folder, const std::string& index,
                       const std::string& lines) {
    return folder.write("table-" + index + ".yaml", "table: demo2026/" + index +
                                                        "\ntitle: T\ntechnique: mock\n" +
                                                        "output: {width: 8, height: 8}\n" + lines);
}

/// Two tables that have numbers 2 and 3 in common.
std::vector<std::string> writeTables(const TemporaryFolder& folder, const std::string& more = "") {
    const std::string layout =
        "layout:\n  rows: number\n  columns: {n: {metric: number}}\n  cell: \"{median:.0f}\"\n";
    return {writeTable(folder, "1", more + layout + "sweep: {number: [1, 2, 3]}\n"),
            writeTable(folder, "2", more + layout + "sweep: {number: [2, 3, 4]}\n")};
}

ProcessResult measureTwins(std::vector<std::string> configs, const std::string& dir,
                           const std::vector<std::string>& more = {}) {
    configs.insert(configs.begin(), "run");
    configs.insert(configs.end(), {"--jobs", "1", "--out", dir});
    return mockGfxrepro(configs, more);
}

/// The wall times of a table's cases by number: no two measurements have the same.
std::map<int, double> timesOf(const std::string& dir, const std::string& table) {
    std::map<int, double> times;
    const auto params = paramsOf(dir);
    for (const records::Record& row : rowsOf(dir, "wall_time_ms")) {
        if (row.table != table) continue;
        times[params.at(row.caseId).at("number").get<int>()] = row.value;
    }
    return times;
}

/// How often a worker was given a case: the lines of the log that are no twin's.
int measuredCount(const std::string& dir) {
    int count = 0;
    for (const std::string& line : split(readFile(dir + "/journal.jsonl"), '\n')) {
        const auto event = nlohmann::json::parse(line, nullptr, false);
        if (event.is_object() && event.value("event", "") == "case" && !event.contains("as")) {
            ++count;
        }
    }
    return count;
}

/// A run in which each table was measured by itself has the same tables.
void expectTablesOfTheirOwn(const std::vector<std::string>& configs, const std::string& dir) {
    ASSERT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    for (std::size_t i = 0; i < configs.size(); ++i) {
        const std::string index = std::to_string(i + 1);
        const std::string alone = dir + "-alone-" + index;
        ASSERT_EQ(measureTwins({configs[i]}, alone).exitCode, 0);
        ASSERT_EQ(mockGfxrepro({"table", alone}).exitCode, 0);
        const std::string name = "/tables/demo2026-" + index + ".csv";
        EXPECT_EQ(readFile(dir + name), readFile(alone + name)) << name;
    }
}

using Twins = test::RunTest;

TEST_F(Twins, AreMeasuredOnceAndFillBothTables) {
    const std::vector<std::string> configs = writeTables(folder);
    const ProcessResult run = endedWith(0, measureTwins(configs, dir));
    EXPECT_EQ(run.out, "6 of 6 finished, 2 as a twin; records: " + dir + "/records.csv\n");
    EXPECT_THAT(run.err, HasSubstr("] ok demo2026/2 number=3 (as demo2026/1 number=3)\n"));
    EXPECT_THAT(run.err, HasSubstr("[6/6] ok demo2026/2 number=4\n"));
    EXPECT_EQ(measuredCount(dir), 4);
    const std::map<int, double> first = timesOf(dir, "demo2026/1");
    const std::map<int, double> second = timesOf(dir, "demo2026/2");
    ASSERT_EQ(first.size(), 3U);
    ASSERT_EQ(second.size(), 3U);
    EXPECT_EQ(first.at(2), second.at(2));
    EXPECT_EQ(first.at(3), second.at(3));
    expectTablesOfTheirOwn(configs, dir);

    std::map<std::string, int> images;
    for (const records::ImageEntry& image : records::readImages(dir)) {
        ++images[image.table];
        EXPECT_TRUE(image.title.starts_with(image.table + " number=")) << image.title;
        EXPECT_THAT(image.png, HasSubstr(image.caseId));
        EXPECT_TRUE(fs::exists(fs::path(dir) / image.png)) << image.png;
        EXPECT_TRUE(fs::exists(fs::path(dir) / image.exr)) << image.exr;
    }
    EXPECT_EQ(images["demo2026/1"], 6);
    EXPECT_EQ(images["demo2026/2"], 6);
    ASSERT_EQ(mockGfxrepro({"report", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/report.html"), HasSubstr("measured as demo2026/1 number=3"));
}

TEST_F(Twins, NeverAmongTimesOfTablesThatHaveAPartInCommon) {
    endedWith(0, measureTwins(writeTables(folder, "measure: {lane: timing, processes: 1}\n"), dir));
    EXPECT_EQ(measuredCount(dir), 6);
    EXPECT_NE(timesOf(dir, "demo2026/1").at(2), timesOf(dir, "demo2026/2").at(2));
}

/// Numbers 2 and 3 of `processes` processes; and these and 1 in another table behind it.
std::vector<std::string> writeTimes(const TemporaryFolder& folder, int processes) {
    const std::string lines = fmt::format(
        "measure: {{lane: timing, processes: {}}}\n"
        "layout:\n  rows: number\n  columns: {{ms: {{metric: wall_time_ms}}}}\n",
        processes);
    return {writeTable(folder, "1", lines + "sweep: {number: [2, 3]}\n"),
            writeTable(folder, "2", lines + "sweep: {number: [1, 2, 3]}\n")};
}

TEST_F(Twins, ATableOfTimesWithinAnotherTakesThemAndSaysSo) {
    const std::vector<std::string> configs = writeTimes(folder, 1);
    const ProcessResult run = endedWith(0, measureTwins(configs, dir));
    EXPECT_THAT(run.out, HasSubstr("5 of 5 finished, 2 as a twin;"));
    EXPECT_THAT(run.err, HasSubstr("ok demo2026/1 number=2 (as demo2026/2 number=2)\n"));
    EXPECT_EQ(measuredCount(dir), 3);
    for (const int number : {2, 3}) {
        EXPECT_EQ(timesOf(dir, "demo2026/1").at(number), timesOf(dir, "demo2026/2").at(number));
    }
    ASSERT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"report", dir}).exitCode, 0);
    const std::string note = "Times are those of demo2026/2, which has these cases, too";
    const auto shown = [&](const std::string& file) { return readFile(dir + file); };
    for (const char* form : {".md", ".tex", ".csv"}) {
        EXPECT_THAT(shown(std::string("/tables/demo2026-1") + form), HasSubstr(note)) << form;
        EXPECT_THAT(shown(std::string("/tables/demo2026-2") + form), Not(HasSubstr(note))) << form;
    }
    EXPECT_THAT(shown("/report.html"), HasSubstr(note));
    const ProcessResult plan = mockGfxrepro({"plan", configs[0], configs[1], "--from", dir});
    EXPECT_THAT(plan.out, HasSubstr("5 cases (2 measured as another's twin), 6 iterations,"));
}

TEST_F(Twins, TimesOfSeveralProcessesAreOfTheirTable) {
    EXPECT_THAT(endedWith(0, measureTwins(writeTimes(folder, 2), dir)).out,
                HasSubstr("10 of 10 finished; "));
    EXPECT_EQ(measuredCount(dir), 10);
    ASSERT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/tables/demo2026-1.md"), Not(HasSubstr("Times are those of")));
}

TEST_F(Twins, ARunThatEndedBetweenTwoTablesOfTimesSaysWhoseEachIs) {
    ASSERT_EQ(measureTwins(writeTimes(folder, 1), dir).exitCode, 0);
    // As if the rows of number=3 had been written for the second table alone.
    const auto params = paramsOf(dir);
    loseRows(dir, [&](const records::Record& row) {
        return row.table == "demo2026/1" && params.at(row.caseId).at("number") == 3;
    });
    const ProcessResult rest = mockGfxrepro({"run", "--resume", dir, "--jobs", "1"});
    EXPECT_THAT(rest.out, HasSubstr("1 of 1 finished; ")) << rest.err;
    ASSERT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/tables/demo2026-1.md"),
                HasSubstr("Times of 1 of 2 cases are those of demo2026/2, which has these cases, "
                          "too; the others' were measured at another moment."));
}

TEST_F(Twins, ProcessesAreSharedOneByOne) {
    const ProcessResult run =
        endedWith(0, measureTwins(writeTables(folder, "measure: {processes: 2}\n"), dir));
    EXPECT_THAT(run.out, HasSubstr("12 of 12 finished, 4 as a twin;"));
    EXPECT_THAT(run.err, HasSubstr("demo2026/2 number=3, round 2 of 2 (as demo2026/1 number=3)\n"));
    EXPECT_EQ(measuredCount(dir), 8);
}

TEST_F(Twins, AResumedRunMeasuresWhatEitherTableLacks) {
    const std::vector<std::string> configs = writeTables(folder);
    ASSERT_EQ(measureTwins(configs, dir).exitCode, 0);
    const std::vector<records::Record> all = records::readRecords(dir + "/records.csv");
    const auto keep = [&](auto isKept) {
        std::vector<records::Record> rows;
        std::ranges::copy_if(all, std::back_inserter(rows), isKept);
        fs::remove(dir + "/records.csv");
        records::RecordWriter(dir + "/records.csv").append(rows);
    };
    // As if the runner had ended between the rows of number=2 and those of its twin.
    const std::map<int, double> before = timesOf(dir, "demo2026/1");
    keep([](const records::Record& row) { return row.table == "demo2026/1"; });
    const ProcessResult twin = mockGfxrepro({"run", "--resume", dir, "--jobs", "1"});
    EXPECT_THAT(twin.out, HasSubstr("3 of 3 finished; records: ")) << twin.err;
    EXPECT_EQ(timesOf(dir, "demo2026/1"), before);
    EXPECT_EQ(timesOf(dir, "demo2026/2").size(), 3U);
    // And as if it had measured nothing but number=1 and the twin of number=2.
    const auto params = paramsOf(dir);
    keep([&](const records::Record& row) {
        const int number = params.at(row.caseId).at("number").get<int>();
        return number == (row.table == "demo2026/1" ? 1 : 2);
    });
    const ProcessResult rest = mockGfxrepro({"run", "--resume", dir, "--jobs", "1"});
    EXPECT_THAT(rest.out, HasSubstr("4 of 4 finished, 1 as a twin; records: ")) << rest.err;
    expectTablesOfTheirOwn(configs, dir);
}

TEST_F(Twins, FailTogetherAndAreTriedAgainTogether) {
    const std::string marker = folder.path() / "marker";
    const std::vector<std::string> configs = {
        writeTable(folder, "1",
                   "sweep: {behaviour: [throw, flake]}\nparams: {marker: " + marker + "}\n"),
        writeTable(folder, "2",
                   "sweep: {behaviour: [flake, throw]}\nparams: {marker: " + marker + "}\n")};
    const ProcessResult run = endedWith(4, measureTwins(configs, dir));
    EXPECT_THAT(run.out, HasSubstr("2 of 4 finished, 1 as a twin, 2 flaky, 2 failed; records: "));
    EXPECT_THAT(
        run.err,
        HasSubstr(
            "error demo2026/2 behaviour=throw (as demo2026/1 behaviour=throw): nothing works\n"));
    EXPECT_EQ(measuredCount(dir), 2);
    const std::vector<std::string> lines = statusLines(dir);
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[0], "throw: error (nothing works)");
    EXPECT_EQ(lines[0], lines[1]);
    EXPECT_THAT(lines[2], HasSubstr("flake: flaky (passed at the second try; the first: crash: "));
    EXPECT_EQ(lines[2], lines[3]);
}

TEST_F(Twins, ShardsKeepThemTogetherAndMerge) {
    const std::vector<std::string> configs = writeTables(folder);
    const std::string merged = folder.path() / "merged";
    std::vector<std::string> merge = {"merge", "--out", merged};
    int measured = 0;
    for (const char* shard : {"1/2", "2/2"}) {
        const std::string part = folder.path() / (std::string("shard-") + shard[0]);
        ASSERT_EQ(measureTwins(configs, part, {"--shard", shard}).exitCode, 0);
        measured += measuredCount(part);
        merge.push_back(part);
    }
    EXPECT_EQ(measured, 4);
    endedWith(0, mockGfxrepro(merge));
    EXPECT_EQ(timesOf(merged, "demo2026/1").at(3), timesOf(merged, "demo2026/2").at(3));
    for (const records::ImageEntry& image : records::readImages(merged)) {
        EXPECT_TRUE(fs::exists(fs::path(merged) / image.png)) << image.png;
    }
    expectTablesOfTheirOwn(configs, merged);
}

TEST_F(Twins, OnlyLeavesThemAloneAndAPlanPredictsThemOnce) {
    const std::vector<std::string> configs = writeTables(folder);
    const ProcessResult run = measureTwins(configs, dir, {"--only", "number=3"});
    EXPECT_THAT(run.out, HasSubstr("2 of 2 finished, 1 as a twin;")) << run.err;
    const ProcessResult plan =
        endedWith(0, mockGfxrepro({"plan", configs[0], configs[1], "--from", dir}));
    EXPECT_THAT(plan.out, HasSubstr("6 cases (2 measured as another's twin), 4 iterations,"));
    EXPECT_THAT(plan.out, HasSubstr("no earlier run tells the time")) << "1 is far from 3";
    // Alone the second table is measured, and its time is known.
    const ProcessResult second = mockGfxrepro({"plan", configs[1], "--from", dir});
    EXPECT_THAT(second.out, HasSubstr("3 cases, 3 iterations,"));
    EXPECT_THAT(second.out, HasSubstr(" same case "));
}

}  // namespace
}  // namespace gfxrepro::test
