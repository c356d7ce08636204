// Predictions, shards, merges and submissions of the program, without a cluster.
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/records/images.h"
#include "runner/run/run.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

constexpr const char* kLayout =
    "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n";

/// `number` from 1 to `count` with these lines before the sweep; a table of the numbers.
fs::path writeNumbers(const TemporaryFolder& folder, int count, const std::string& lines = "") {
    return writeMockConfig(folder, lines + "sweep:\n  number: {range: [1, " +
                                       std::to_string(count) + "]}\n" + kLayout);
}

ProcessResult measure(const fs::path& config, const std::string& dir,
                      const std::vector<std::string>& more = {}) {
    return mockGfxrepro({"run", config, "--device", "software", "--quiet", "--out", dir}, more);
}

/// What stands behind the name of the case `number=N` in the output of `plan`.
std::string planLine(const std::string& out, int number) {
    const std::string end = "number=" + std::to_string(number);
    for (const std::string& line : split(out, '\n')) {
        if (line.ends_with(end)) return line;
    }
    return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at; (at = text.find(what)) != std::string::npos;) {
        text.replace(at, what.size(), by);
    }
    return text;
}

TEST(Plan, PredictsFromEarlierRuns) {
    const TemporaryFolder folder;
    const std::string config = writeNumbers(folder, 3, "params: {pause_ms: 5}\n");
    const ProcessResult before = mockGfxrepro({"plan", config});
    EXPECT_THAT(before.out, HasSubstr("no earlier run tells the time; --from RUN names one\n"));
    EXPECT_THAT(planLine(before.out, 1), HasSubstr("-     -       -"));
    const std::string dir = folder.path() / "earlier";
    ASSERT_EQ(measure(config, dir, {"--sweep", "number=1,2"}).exitCode, 0);

    const ProcessResult after =
        mockGfxrepro({"plan", config, "--from", dir, "--sweep", "number=1,2"});
    EXPECT_THAT(planLine(after.out, 1), HasSubstr(" MiB  same case "));
    EXPECT_THAT(after.out, HasSubstr("as " + dir + " tells\n"));
    const ProcessResult other = mockGfxrepro({"plan", config, "--from", dir});
    EXPECT_THAT(planLine(other.out, 3), ContainsRegex("120 s +- +- +- "));
    EXPECT_THAT(other.out, HasSubstr("no earlier run tells the time"))
        << "nothing rather than another case's";
    EXPECT_THAT(mockGfxrepro({"plan", config, "--from", dir, "--set", "measure.repeats=2"}).out,
                HasSubstr("same case, other run"));
    const ProcessResult none =
        endedWith(2, mockGfxrepro({"plan", config, "--from", folder.path() / "none"}));
    EXPECT_EQ(none.err, "gfxrepro: " + (folder.path() / "none").string() +
                            ": is not a run directory (it has no plan.json)\n");
}

TEST(Plan, NewestRunsTellAndBrokenOnesDoNotStop) {
    const TemporaryFolder folder;
    const std::string config = writeNumbers(folder, 2);
    const auto inFolder = [&](const std::string& command) {
        return shell("cd '" + folder.path().string() + "' && '" + GFXREPRO_MOCK_PROGRAM "' " +
                     command);
    };
    ASSERT_EQ(inFolder("run mock.yaml --device software --quiet").exitCode, 0);
    folder.write("runs/broken/plan.json", "{");
    folder.write("runs/broken/manifest.json", "{\"device_class\": \"software\"}");
    folder.write("runs/broken/journal.jsonl",
                 "{\"case\": \"x\", \"cost\": {\"load_s\": 0, \"setup_s\": 0, \"render_s\": 0, "
                 "\"record_s\": 0, \"peak_bytes\": 0}}\n");
    const ProcessResult plan = endedWith(0, inFolder("plan mock.yaml --device software"));
    EXPECT_THAT(plan.out, HasSubstr("expect about "));
    EXPECT_THAT(plan.out, HasSubstr("as runs/"));
    const ProcessResult run = inFolder("run mock.yaml --device software --out again");
    EXPECT_THAT(run.err, HasSubstr(" tells\n"));
}

using Shards = FolderTest;

TEST_F(Shards, MergeToTheTablesOfOneRun) {
    folder.write("own.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 5 5 5\nf 1 2 3\n");
    const std::string config = writeNumbers(folder, 10, "scene: own.obj\n");
    const std::string whole = folder.path() / "whole";
    const std::string merged = folder.path() / "merged";
    ASSERT_EQ(measure(config, whole).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"table", whole}).exitCode, 0);
    std::vector<std::string> merge = {"merge", "--out", merged};
    std::size_t rows = 0;
    for (const char* k : {"3", "1", "2"}) {  // in no order
        const std::string dir = folder.path() / (std::string("s") + k);
        endedWith(0, measure(config, dir, {"--shard", std::string(k) + "/3", "--from", whole}));
        rows += rowsOf(dir, "number").size();
        merge.push_back(dir);
    }
    EXPECT_EQ(rows, 10U);
    EXPECT_EQ(endedWith(0, mockGfxrepro(merge)).out,
              "merged 3 shards into " + merged +
                  ": 10 of 10 measured, 0 failed, 0 missing\nclaims: no claims\n"
                  "tables: " +
                  merged +
                  "/tables (CSV, Markdown, LaTeX)\n"
                  "report: " +
                  merged + "/report.html\n");
    expectSameTables(merged, whole);
    EXPECT_EQ(rowsOf(merged, "number").size(), 10U);
    const std::vector<records::ImageEntry> images = records::readImages(merged);
    for (const records::Record& row : rowsOf(merged, "number")) {
        EXPECT_TRUE(std::ranges::any_of(images, [&](const records::ImageEntry& image) {
            return image.caseId == row.caseId && image.name == "flat" &&
                   fs::exists(merged + '/' + image.exr);
        }));
    }
    const std::string list = readFile(merged + "/images/index.csv");
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 21);  // two images a case
    // A merge is a past like any other run, and may be made again.
    EXPECT_THAT(mockGfxrepro({"plan", config, "--from", merged}).out,
                HasSubstr("as " + merged + " tells\n"));
    EXPECT_EQ(mockGfxrepro(merge).exitCode, 0);
    expectSameTables(merged, whole);
    // Each shard's loader warned of the same.
    const std::string manifest = readFile(merged + "/manifest.json");
    const std::string warning = "own.obj': left out: a vertex that no face uses";
    ASSERT_THAT(manifest, HasSubstr(warning));
    EXPECT_EQ(manifest.find(warning), manifest.rfind(warning));
}

TEST_F(Shards, MergeNamesWhatIsMissingAndARunGoesOn) {
    const std::string config = writeNumbers(folder, 4);
    const std::string s1 = folder.path() / "s1", s2 = folder.path() / "s2";
    const std::string merged = folder.path() / "merged", whole = folder.path() / "whole";
    ASSERT_EQ(measure(config, s1, {"--shard", "1/2"}).exitCode, 0);
    const ProcessResult partial = endedWith(4, mockGfxrepro({"merge", "--out", merged, s1, s2}));
    EXPECT_EQ(partial.err, s2 + ": there is no such folder\n");
    EXPECT_THAT(partial.out, HasSubstr("missing: shard 2/2\nmissing: sweep/mock number=2\n"
                                       "missing: sweep/mock number=4\nmerged 1 shard into " +
                                       merged + ": 2 of 4 measured, 0 failed, 2 missing\n"));
    EXPECT_THAT(partial.out,
                HasSubstr("what is missing or failed is measured by: gfxrepro run --resume " +
                          merged + "\n"));
    const ProcessResult rest = mockGfxrepro({"run", "--resume", merged});
    EXPECT_EQ(rest.out, "2 of 2 finished; records: " + merged + "/records.csv\n");
    ASSERT_EQ(mockGfxrepro({"table", merged}).exitCode, 0);
    ASSERT_EQ(measure(config, whole).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"table", whole}).exitCode, 0);
    expectSameTables(merged, whole);
    // What was measured into it is not overwritten.
    EXPECT_EQ(endedWith(2, mockGfxrepro({"merge", "--out", merged, s1})).err,
              "gfxrepro: " + merged +
                  ": holds a run that is no merge of these shards; give another folder\n");
    EXPECT_EQ(rowsOf(merged, "number").size(), 4U);
}

TEST_F(Shards, MergeRefusesOtherPlansAndNoRuns) {
    const std::string config = writeNumbers(folder, 4);
    const std::string s1 = folder.path() / "s1", s2 = folder.path() / "s2";
    ASSERT_EQ(measure(config, s1, {"--shard", "1/2"}).exitCode, 0);
    ASSERT_EQ(measure(config, s2, {"--shard", "2/2", "--set", "pause_ms=1"}).exitCode, 0);
    const ProcessResult result =
        endedWith(2, mockGfxrepro({"merge", "--out", folder.path() / "m", s1, s2}));
    EXPECT_THAT(result.err, HasSubstr(s1 + " and " + s2 + " are shards of different plans ("));
    EXPECT_THAT(result.err, HasSubstr("the config " + config + " changed\n"));
    EXPECT_FALSE(fs::exists(folder.path() / "m/plan.json"));
    const ProcessResult none =
        endedWith(2, mockGfxrepro({"merge", "--out", folder.path() / "m", folder.path()}));
    EXPECT_THAT(none.err, HasSubstr("gfxrepro: merge: none of the folders holds a run\n"));
    for (const auto& [name, why] :
         {std::pair{"none", "there is no such folder"}, {"data", "holds no run"}}) {
        folder.write("data/file", "");
        const std::string given = folder.path() / name;
        EXPECT_EQ(mockGfxrepro({"merge", given}).err,
                  given + ": " + why + "\ngfxrepro: merge: none of the folders holds a run\n");
    }
    EXPECT_EQ(mockGfxrepro({"merge", s1, s2}).err,
              "gfxrepro: merge: --out is missing: folder of the whole run; for example: gfxrepro "
              "merge shard-1 shard-2 --out whole\n");
}

TEST_F(Shards, TimesMeasuredElsewhereAreMeasuredAgain) {
    const std::string config = writeNumbers(folder, 3, "measure: {lane: timing, processes: 1}\n");
    const std::string dir = folder.path() / "run";
    ASSERT_EQ(measure(config, dir).exitCode, 0);
    // As if the run had begun elsewhere and had lost its last case.
    replaceIn(dir + "/manifest.json", "\"cpu\": \"", "\"cpu\": \"Another ");
    const auto rows = records::readRecords(dir + "/records.csv");
    loseRows(dir, [&](const auto& row) { return row.caseId == rows.back().caseId; });
    const std::size_t left = records::readRecords(dir + "/records.csv").size();
    const ProcessResult resumed = endedWith(0, mockGfxrepro({"run", "--resume", dir}));
    EXPECT_THAT(
        resumed.err,
        HasSubstr("sweep/mock: begun on another machine; its times are measured again on "));
    EXPECT_EQ(resumed.out, "3 of 3 finished; records: " + dir + "/records.csv\n");
    EXPECT_EQ(rowsOf(dir, "number").size(), 3U);
    EXPECT_EQ(records::readRecords(dir + "/records-replaced.csv").size(), left);
}

TEST_F(Shards, ValuesOfSeveralMachinesAreMarked) {
    const std::string config = writeNumbers(folder, 2);
    const std::string dir = folder.path() / "run", other = folder.path() / "other";
    ASSERT_EQ(measure(config, dir, {"--shard", "1/2"}).exitCode, 0);
    ASSERT_EQ(measure(config, other, {"--shard", "2/2"}).exitCode, 0);
    // As if the first shard had begun elsewhere and had lost its case.
    replaceIn(dir + "/manifest.json", "\"cpu\": \"", "\"cpu\": \"Another ");
    const auto hasNote = [](const std::string& run) {
        EXPECT_EQ(mockGfxrepro({"report", run}).exitCode, 0);
        for (const char* file : {"/tables/sweep-mock.md", "/report.html"}) {
            EXPECT_THAT(readFile(run + file), HasSubstr("measured on several machines, the times "
                                                        "of each table on one of them: Another "));
        }
    };
    const std::string merged = folder.path() / "merged";
    ASSERT_EQ(mockGfxrepro({"merge", "--out", merged, dir, other}).exitCode, 0);
    hasNote(merged);
    const ProcessResult beside =
        mockGfxrepro({"report", dir, other, "--out", folder.path() / "both.html"});
    EXPECT_THAT(beside.out, HasSubstr("warning: the runs are of several machines: Another "));
    EXPECT_THAT(readFile(folder.path() / "both.html"),
                HasSubstr("the runs are of several machines: Another "));

    fs::remove(dir + "/records.csv");
    EXPECT_THAT(endedWith(0, mockGfxrepro({"run", "--resume", dir})).err,
                HasSubstr("warning: begun on Another "));
    EXPECT_THAT(mockGfxrepro({"table", dir}).out, HasSubstr("warning: measured on several"));
    hasNote(dir);
    const ProcessResult again = mockGfxrepro({"run", "--resume", dir});  // measures nothing
    EXPECT_THAT(again.err, Not(HasSubstr("begun on")));
}

TEST(Resume, WithConfigsBeginsOrGoesOn) {
    const TemporaryFolder folder;
    const std::string config = writeNumbers(folder, 4);
    const std::string dir = folder.path() / "run";
    const std::vector<std::string> command = {"run", config,    "--device", "software", "--shard",
                                              "1/2", "--quiet", "--resume", dir};
    EXPECT_EQ(mockGfxrepro(command).out, "2 of 2 finished; records: " + dir + "/records.csv\n");
    EXPECT_EQ(mockGfxrepro(command).out, "0 of 0 finished; records: " + dir + "/records.csv\n");
    std::vector<std::string> other = command;
    other[5] = "2/2";
    EXPECT_EQ(mockGfxrepro(other).err,
              "gfxrepro: " + dir + ": holds a run with other --shard; give another folder\n");
    EXPECT_EQ(mockGfxrepro(command, {"--set", "pause_ms=1"}).err,
              "gfxrepro: " + dir + ": holds a run with other --set; give another folder\n");
    EXPECT_EQ(mockGfxrepro(command, {"--out", dir}).err,
              "gfxrepro: --out and --resume exclude each other: both name the folder\n");
}

using Submit = FolderTest;

TEST_F(Submit, CommandsMeasureAndMerge) {
    const std::string config =
        writeMockConfig(folder, std::string("sweep:\n  zip:\n    - {number: [1, 2, 3, 4, 5], "
                                            "behaviour: [ok, ok, throw, ok, ok]}\n") +
                                    kLayout);
    const std::string out = folder.path() / "it's out";  // a shell must not stumble
    const std::vector<std::string> command = {"submit", config,     "--device", "software", "--out",
                                              out,      "--engine", "commands", "--shards", "2"};
    const ProcessResult submitted = endedWith(0, mockGfxrepro(command));
    std::vector<std::string> lines = split(submitted.out, '\n');
    ASSERT_EQ(lines.size(), 4U) << submitted.out;  // two shards, the merge, the end
    EXPECT_EQ(lines[0] + '\n' + lines[1] + '\n', readFile(out + "/commands.txt"));
    EXPECT_EQ("#!/bin/sh\n" + lines[2] + '\n', readFile(out + "/merge.sh"));

    EXPECT_EQ(endedWith(4, mockGfxrepro({"submit", "--status", out})).out,
              "shard  done  failed  state\n1/2    0/3   0       not complete\n"
              "2/2    0/2   0       not complete\nmerge                not complete\n");
    EXPECT_EQ(shell(lines[0]).exitCode, 4);  // one case throws
    EXPECT_EQ(shell(lines[1]).exitCode, 0);
    EXPECT_EQ(shell(lines[1]).exitCode, 0);  // again: nothing to do
    EXPECT_THAT(endedWith(4, shell(lines[2])).out,
                HasSubstr(": 4 of 5 measured, 1 failed, 0 missing\n"));
    const ProcessResult done =
        endedWith(4, mockGfxrepro({"submit", "--status", out}));  // a case failed
    EXPECT_EQ(done.out,
              "shard  done  failed  state\n1/2    2/3   1       complete\n"
              "2/2    2/2   0       complete\nmerge  4/5   1       complete\n");
    EXPECT_EQ(replaced(mockGfxrepro(command, {"--set", "pause_ms=1"}).err, out, "OUT"),
              "5 cases in 2 shards of 2 to 3 units; no earlier run tells their time\n"
              "gfxrepro: OUT: holds another submission; give another folder\n");
}

TEST_F(Submit, WhatWasSubmittedIsMeasured) {
    const std::string config = writeNumbers(folder, 2);
    const std::string out = folder.path() / "out";
    const std::vector<std::string> command = {"submit", config,     "--device", "software", "--out",
                                              out,      "--engine", "commands", "--shards", "2"};
    const ProcessResult submitted = endedWith(0, mockGfxrepro(command));
    const std::vector<std::string> lines = split(submitted.out, '\n');
    ASSERT_EQ(shell(lines[0]).exitCode, 0);
    writeNumbers(folder, 3, "params: {pause_ms: 1}\n");
    const std::string warning = "warning: " + config + " changed; what was submitted is measured\n";
    EXPECT_THAT(endedWith(0, shell(lines[1])).err, HasSubstr(warning));
    EXPECT_THAT(endedWith(0, shell(lines[2])).out,
                HasSubstr(": 2 of 2 measured, 0 failed, 0 missing\n"));
    // Submitted once more it is the same submission.
    const ProcessResult again = endedWith(0, mockGfxrepro(command));
    EXPECT_THAT(again.err, HasSubstr(warning));
    EXPECT_EQ(again.out, submitted.out);

    // A shard that was removed is there again, as it was submitted.
    const std::string shard = out + "/shards/1", file = shard + "/plan.json";
    const std::string plan = readFile(file);
    fs::remove_all(out + "/shards");
    ASSERT_EQ(mockGfxrepro(command).exitCode, 0);
    EXPECT_EQ(readFile(file), plan);
    folder.write("out/submitted-program/shaders/other.glsl", "");
    const ProcessResult other = endedWith(2, shell(lines[0]));
    EXPECT_THAT(other.err,
                HasSubstr(shard + ": cannot be measured: the program or a shader changed (build "));
    EXPECT_THAT(other.err, HasSubstr(" now); submit again, to another folder\n"));
    EXPECT_THAT(
        mockGfxrepro(command).err,
        HasSubstr(out + "/submitted-program: is not the program that was submitted (build "));
    fs::remove(out + "/submitted-program/shaders/other.glsl");
    std::string changed = plan;
    changed.replace(changed.find("\"build\": \"") + 10, 12, "000000000000");
    writeFileAtomic(file, changed);
    EXPECT_THAT(shell(lines[0]).err,
                HasSubstr("is not the one that was planned: plan.json was changed\n"));
    EXPECT_FALSE(fs::exists(shard + "/records.csv"));
}

/// Submits `number` from 1 to `count` in shards of two cases each.
std::vector<std::string> submitPairs(const TemporaryFolder& folder, int count,
                                     const std::string& out) {
    const ProcessResult result =
        endedWith(0, mockGfxrepro({"submit", writeNumbers(folder, count), "--out", out, "--engine",
                                   "commands", "--shards", std::to_string(count / 2)}));
    std::vector<std::string> lines = split(trimmed(result.out), '\n');
    EXPECT_EQ(lines.size(), static_cast<std::size_t>(count / 2 + 1));
    return lines;
}

std::uintmax_t sizeOf(const fs::path& folder) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) bytes += entry.file_size();
    }
    return bytes;
}

/// What a shard keeps and says is of its own two cases, whatever the others have.
TEST_F(Submit, AShardHasTheSizeOfItsOwnCases) {
    std::uintmax_t planned[2], measured[2], command[2];
    for (const int i : {0, 1}) {
        const std::string out = folder.path() / std::to_string(i);
        const std::vector<std::string> lines = submitPairs(folder, i == 0 ? 8 : 800, out);
        planned[i] = sizeOf(out + "/shards/1");
        ASSERT_EQ(shell(lines[0]).exitCode, 0);
        measured[i] = sizeOf(out + "/shards/1");
        command[i] = lines.back().size();
        EXPECT_EQ(paramsOf(out + "/shards/1").size(), 2U);
    }
    EXPECT_GT(planned[0], 0U);
    EXPECT_LE(planned[1], planned[0] + 20) << "but for longer numbers";
    EXPECT_LE(measured[1], measured[0] + 500) << "but for what differs between two runs";
    EXPECT_EQ(command[1], command[0]) << "the merge names no shard";
}

/// What all shards have in common is read once, in the plan that they were cut from.
TEST_F(Submit, OfAShardTheExperimentsAreNotReadForAMerge) {
    const std::string out = folder.path() / "out", shard = out + "/shards/1";
    const std::vector<std::string> lines = submitPairs(folder, 4, out);
    ASSERT_EQ(shell(lines[0]).exitCode, 0);
    const run::StoredRun whole = run::readRun(shard), part = run::readPart(shard);
    ASSERT_EQ(part.plan.experiments.size(), 1U);
    EXPECT_TRUE(part.plan.experiments[0].sweep.isNull());
    EXPECT_FALSE(whole.plan.experiments[0].sweep.isNull());
    EXPECT_EQ(part.plan.experiments[0].document.toJson(),
              whole.plan.experiments[0].document.toJson());
    EXPECT_EQ(part.plan.cases.size(), whole.plan.cases.size());
    EXPECT_EQ(part.records, whole.records);
    ASSERT_EQ(mockGfxrepro({"merge", out}).exitCode, 4);
    EXPECT_FALSE(run::readPart(out).plan.experiments[0].sweep.isNull()) << "no shard";
}

TEST_F(Submit, AShardIsReadWhereverItIsAndMergedWithItsSubmission) {
    const std::string out = folder.path() / "out", alone = folder.path() / "alone";
    const std::vector<std::string> lines = submitPairs(folder, 4, out);
    EXPECT_EQ(
        endedWith(2, mockGfxrepro({"table", out + "/shards/1"})).err,
        "gfxrepro: " + out + "/shards/1: was planned, and not begun (it has no manifest.json)\n");
    EXPECT_EQ(mockGfxrepro({"merge", out}).err,
              "gfxrepro: merge: none of the folders holds a run\n");
    ASSERT_EQ(shell(lines[0]).exitCode, 0);
    fs::copy(out + "/shards/1", alone, fs::copy_options::recursive);
    for (const char* command : {"table", "report"}) {
        EXPECT_EQ(mockGfxrepro({command, alone}).exitCode, 0) << command;
    }
    fs::remove(alone + "/records.csv");
    const ProcessResult rest = mockGfxrepro({"run", "--resume", alone});
    EXPECT_EQ(rest.out, "2 of 2 finished; records: " + alone + "/records.csv\n");
    const ProcessResult merge =
        endedWith(2, mockGfxrepro({"merge", alone, "--out", folder.path() / "merged"}));
    EXPECT_EQ(merge.err, "gfxrepro: " + alone +
                             ": the plan that it is a shard of is neither in it (whole-plan.json) "
                             "nor two folders above it (submitted-plan.json): a shard of a "
                             "submission is merged with the submission's folder\n");
    // With its submission it may lie anywhere, and what was not begun is missing.
    fs::rename(out, folder.path() / "moved");
    const ProcessResult moved = endedWith(4, mockGfxrepro({"merge", folder.path() / "moved"}));
    EXPECT_EQ(moved.err, "");
    EXPECT_THAT(moved.out, HasSubstr("missing: shard 2/2\n"));
    EXPECT_THAT(moved.out, HasSubstr("merged 1 shard into " + (folder.path() / "moved").string() +
                                     ": 2 of 4 measured, 0 failed, 2 missing\n"));
}

TEST_F(Submit, AReplacedPlanIsNotMerged) {
    const std::string out = folder.path() / "out", other = folder.path() / "other";
    for (const std::string& line : submitPairs(folder, 4, out)) {
        ASSERT_EQ(shell(line).exitCode, 0);
    }
    const std::string file = out + "/submitted-plan.json", plan = readFile(file);
    submitPairs(folder, 6, other);
    const std::string replaced = "no part of the submitted plan: it was replaced";
    const auto expectRefused = [&](const std::string& problem, const std::string& state) {
        EXPECT_THAT(
            endedWith(2, mockGfxrepro({"merge", out, "--out", folder.path() / "merged"})).err,
            HasSubstr(problem));
        EXPECT_FALSE(fs::exists(folder.path() / "merged/plan.json"));
        EXPECT_THAT(endedWith(4, mockGfxrepro({"submit", "--status", out})).out,
                    HasSubstr("2/2    2/2   0       " + state + '\n'));
    };
    fs::copy_file(other + "/submitted-plan.json", file, fs::copy_options::overwrite_existing);
    expectRefused(
        file + ": is not the plan that " + out + "/shards/1 is a shard of: it was changed\n",
        replaced);
    writeFileAtomic(file, plan + ' ');
    expectRefused(": it was changed\n", replaced);
    // So it is with a shard of another submission, and one that is there twice.
    writeFileAtomic(file, plan);
    fs::rename(out + "/shards/2", folder.path() / "kept");
    for (const std::string& line : submitPairs(folder, 6, other)) {
        ASSERT_EQ(shell(line).exitCode, 0);
    }
    fs::copy(other + "/shards/2", out + "/shards/2", fs::copy_options::recursive);
    expectRefused("/shards/2 are shards of different plans (", replaced);
    fs::remove_all(out + "/shards/2");
    fs::copy(out + "/shards/1", out + "/shards/2", fs::copy_options::recursive);
    expectRefused("/shards/2: these are no shards of one cut\n",
                  "the shard 1/2 once more: " + out + "/shards/1 holds it, too");
    fs::remove_all(out + "/shards/2");
    fs::rename(folder.path() / "kept", out + "/shards/2");
    EXPECT_THAT(mockGfxrepro({"submit", "--status", out}).out,
                HasSubstr("2/2    2/2   0       complete\n"));
    EXPECT_EQ(mockGfxrepro({"merge", out, "--out", folder.path() / "merged"}).exitCode, 0);
    // Of a submission that lost its plan, that is said.
    fs::remove(file);
    for (const char* described : {"", "{ broken"}) {
        writeFileAtomic(out + "/submission.json", described);
        EXPECT_THAT(endedWith(2, mockGfxrepro({"merge", out})).err,
                    HasSubstr("(submitted-plan.json)"));
    }
}

/// Each folder holds what it holds, and a status refuses what a merge refuses.
TEST_F(Submit, ShardsInEachOthersFoldersAreMergedAndTheOutputsOfAnotherAreNot) {
    const std::string out = folder.path() / "out", apart = folder.path() / "apart";
    for (const std::string& line : submitPairs(folder, 4, out)) {
        ASSERT_EQ(shell(line).exitCode, 0);
    }
    const auto exchange = [&](const std::string& file) {
        fs::rename(out + "/shards/1" + file, apart);
        fs::rename(out + "/shards/2" + file, out + "/shards/1" + file);
        fs::rename(apart, out + "/shards/2" + file);
    };
    const auto status = [&] { return mockGfxrepro({"submit", "--status", out}); };
    const auto merge = [&] { return mockGfxrepro({"merge", out}); };
    exchange("");
    EXPECT_EQ(merge().exitCode, 0);
    EXPECT_EQ(status().exitCode, 0) << status().out;
    exchange("/records.csv");
    EXPECT_THAT(merge().err, HasSubstr(" is not in the plan\n"));
    EXPECT_THAT(status().out,
                ContainsRegex("1/2 .* is not in the plan\n2/2 .* is not in the plan\n"));
    EXPECT_EQ(status().exitCode, 4);
    exchange("/manifest.json");
    const std::string problem =
        "/manifest.json: is of the plan [0-9a-f]+, shard 1/2, and the plan.json beside it is the "
        "plan [0-9a-f]+, shard 2/2\n";
    EXPECT_THAT(merge().err, ContainsRegex(problem));
    EXPECT_THAT(status().out, ContainsRegex("1/2 .*" + problem + "2/2 "));
    EXPECT_EQ(status().exitCode, 4);
}

/// What has ended says itself what it came to; what was changed since is counted anew.
TEST_F(Submit, TheStatusOfWhatEndedNeedsNoWholePlan) {
    const std::string out = folder.path() / "out";
    for (const std::string& line : submitPairs(folder, 4, out)) {
        ASSERT_EQ(shell(line).exitCode, 0);
    }
    writeFileAtomic(out + "/plan.json", "of a thousand shards this would take long");
    const ProcessResult status = endedWith(0, mockGfxrepro({"submit", "--status", out}));
    EXPECT_EQ(status.out,
              "shard  done  failed  state\n1/2    2/2   0       complete\n"
              "2/2    2/2   0       complete\nmerge  4/4   0       complete\n");
    const std::string records = out + "/shards/2/records.csv";
    const std::string first = records::readRecords(records).front().caseId;
    loseRows(out + "/shards/2", [&](const auto& row) { return row.caseId == first; });
    EXPECT_THAT(mockGfxrepro({"submit", "--status", out}).out,
                HasSubstr("2/2    1/2   0       not complete\n"));
    // A run that lost its manifest is none that waits for its task.
    fs::remove(out + "/shards/2/manifest.json");
    EXPECT_THAT(mockGfxrepro({"run", "--resume", out + "/shards/2"}).err,
                HasSubstr("manifest.json"));
    EXPECT_TRUE(fs::exists(records));
}

TEST_F(Submit, TheProgramThatWasSubmittedRunsWhateverIsBuiltLater) {
    const std::string config = writeNumbers(folder, 2);
    const std::string out = folder.path() / "out", program = folder.path() / "built/gfxrepro";
    const fs::path shaders = fs::path(GFXREPRO_MOCK_PROGRAM).parent_path() / "../../shaders";
    fs::create_directories(folder.path() / "built");
    fs::copy_file(GFXREPRO_MOCK_PROGRAM, program);
    fs::copy(shaders, folder.path() / "built/shaders", fs::copy_options::recursive);
    fs::create_directory_symlink(GFXREPRO_SOURCE "/configs", folder.path() / "built/configs");
    const std::vector<std::string> command = {program,    "submit",   config, "--device",
                                              "software", "--out",    out,    "--engine",
                                              "commands", "--shards", "2"};
    const ProcessResult submitted = endedWith(0, runProgram(command));

    std::ofstream(program, std::ios::app) << "another build";
    folder.write("built/shaders/another.glsl", "");
    const std::string data = "GFXREPRO_DATA=" + (folder.path() / "built").string();
    const std::vector<std::string> lines = split(submitted.out, '\n');
    EXPECT_EQ(runProgram({"/bin/sh", "-c", lines[0]}, {data}).exitCode, 0);
    const ProcessResult again = runProgram(command);  // the shards go on with what began
    EXPECT_EQ(again.exitCode, 0) << again.err;
    EXPECT_EQ(again.out, submitted.out);
    fs::remove_all(folder.path() / "built");
    EXPECT_EQ(shell(lines[1]).exitCode, 0);
    EXPECT_THAT(endedWith(0, shell(lines[2])).out,
                HasSubstr(": 2 of 2 measured, 0 failed, 0 missing\n"));
}

TEST_F(Submit, WithoutACopyOfTheProgramNothingIsSubmitted) {
    const std::string config = writeNumbers(folder, 2);
    const fs::path out = folder.path() / "out";
    folder.write("data/shaders/a.glsl", "");
    fs::create_directories(folder.path() / "data/configs/scenes");
    ASSERT_EQ(::mkfifo((folder.path() / "data/shaders/pipe").c_str(), 0600), 0);
    EXPECT_THAT(endedWith(2, runProgram({GFXREPRO_MOCK_PROGRAM, "submit", config, "--device",
                                         "software", "--out", out, "--engine", "commands"},
                                        {"GFXREPRO_DATA=" + (folder.path() / "data").string()}))
                    .err,
                HasSubstr("gfxrepro: no copy of the program for the tasks could be made: "));
    EXPECT_FALSE(fs::exists(out));
}

/// A bundle has one: its C++ library under the name by which it is asked for.
TEST_F(Submit, LinksAmongTheProgramsLibrariesAreFollowed) {
    const std::string config = writeNumbers(folder, 2);
    const std::string out = folder.path() / "out", program = folder.path() / "bundle/gfxrepro";
    folder.write("bundle/lib/libsome.so.6.0.30", "a library");
    fs::create_symlink("libsome.so.6.0.30", folder.path() / "bundle/lib/libsome.so.6");
    fs::copy_file(GFXREPRO_MOCK_PROGRAM, program);
    const fs::path shaders = fs::path(GFXREPRO_MOCK_PROGRAM).parent_path() / "../../shaders";
    fs::copy(shaders, folder.path() / "bundle/shaders", fs::copy_options::recursive);
    fs::create_directory_symlink(GFXREPRO_SOURCE "/configs", folder.path() / "bundle/configs");
    const ProcessResult submitted =
        endedWith(0, runProgram({program, "submit", config, "--device", "software", "--out", out,
                                 "--engine", "commands", "--shards", "2"}));
    for (const std::string& line : split(submitted.out, '\n')) {
        EXPECT_EQ(shell(line).exitCode, 0) << line;
    }
    const std::string library = out + "/submitted-program/lib/libsome.so.6";
    EXPECT_EQ(readFile(library), "a library");
    EXPECT_FALSE(fs::is_symlink(library));
    EXPECT_TRUE(fs::equivalent(library, folder.path() / "bundle/lib/libsome.so.6.0.30"));
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"table", out}, {"report", out}, {"run", "--resume", out}}) {
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 0) << command.front() << ": " << result.err;
    }
}

TEST_F(Submit, AShardWhosePlanWasChangedIsNotMerged) {
    const std::string out = folder.path() / "out";
    for (const std::string& line : submitPairs(folder, 4, out)) {
        ASSERT_EQ(shell(line).exitCode, 0);
    }
    const std::string file = out + "/shards/1/plan.json", plan = readFile(file);
    // In its parameters; in what was swept; in what was given.
    for (const char* member : {"\"params\":{", "\"axes\":{", "\"given\":{"}) {
        std::string changed = plan;
        const std::size_t at = changed.find("\"number\":", changed.find(member));
        ASSERT_NE(at, changed.npos);
        changed[changed.find_first_of("0123456789", at)] = '9';
        ASSERT_NE(changed, plan);
        writeFileAtomic(file, changed);
        const ProcessResult merge = mockGfxrepro({"merge", out, "--out", folder.path() / "merged"});
        EXPECT_EQ(merge.exitCode, 2) << member;
        const std::string problem = "is not the one that was planned: plan.json was changed\n";
        EXPECT_THAT(merge.err, HasSubstr(file + ": the case "));
        EXPECT_THAT(merge.err, HasSubstr(problem));
        EXPECT_FALSE(fs::exists(folder.path() / "merged"));
        EXPECT_THAT(endedWith(4, mockGfxrepro({"submit", "--status", out})).out,
                    ContainsRegex("1/2 .*/shards/1/plan.json: the case .*" + problem));
    }
}

TEST_F(Submit, DryRunWritesNothing) {
    const std::string config = writeNumbers(folder, 6, "measure: {lane: timing, processes: 1}\n");
    const std::string out = folder.path() / "out";
    const ProcessResult result = endedWith(
        0,
        mockGfxrepro({"submit", config, "--out", out, "--shards", "3", "--dry-run", "--partition",
                      "gpus", "--gres", "gpu:1", "--sbatch=--account=x", "--sbatch=--mem=8G"}));
    // Times of one table: one shard, alone on its node.
    EXPECT_EQ(result.err,
              "6 cases in 1 shard and not 3, as timing cases of one table and twins stay together, "
              "of 6 to 6 units; no earlier run tells their time\n");
    EXPECT_EQ(mockGfxrepro(
                  {"submit", writeNumbers(folder, 2), "--out", out, "--shards", "5", "--dry-run"})
                  .err,
              "2 cases in 2 shards and not 5, of 1 to 1 units; no earlier run tells their time\n");
    EXPECT_THAT(result.out, HasSubstr("#SBATCH --exclusive\n#SBATCH --partition=gpus\n"
                                      "#SBATCH --gres=gpu:1\n#SBATCH --account=x\n"
                                      "#SBATCH --mem=8G\nexec "));
    EXPECT_THAT(result.out, HasSubstr(" --resume " + out + "/shards/\"$SLURM_ARRAY_TASK_ID\"\n"));
    EXPECT_THAT(result.out, HasSubstr("sbatch --array=1 --output=" + out + "/task-%a.txt " + out +
                                      "/task.sh\nsbatch --dependency=afterany:JOB --output=" + out +
                                      "/merge.txt " + out + "/merge.sh\n"));
    EXPECT_FALSE(fs::exists(out));
}

/// A PATH whose sbatch and squeue say what the test wants.
std::string fakeSlurm(const TemporaryFolder& folder, const std::string& sbatch,
                      const std::string& squeue) {
    for (const auto& [name, script] : {std::pair{"sbatch", sbatch}, std::pair{"squeue", squeue}}) {
        writeProgram(folder, std::string("bin/") + name, "#!/bin/sh\n" + script);
    }
    return "PATH=" + (folder.path() / "bin").string() + ":/usr/bin:/bin";
}

TEST_F(Submit, SlurmIsAskedAndItsRefusalIsSaid) {
    const std::string config = writeNumbers(folder, 4);
    const std::string out = folder.path() / "out";
    const std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM,
                                              "submit",
                                              config,
                                              "--device",
                                              "software",
                                              "--out",
                                              out,
                                              "--shards",
                                              "2"};
    EXPECT_THAT(endedWith(2, runProgram(command,
                                        {fakeSlurm(folder, "echo 'invalid partition' >&2; exit 1\n",
                                                   "exit 1\n")}))
                    .err,
                HasSubstr("gfxrepro: sbatch did not take the job (exit code 1): invalid partition; "
                          "nothing was queued\n"));
    // Numbers may come with a cluster's name; the second job waits for the first.
    const std::string log = folder.path() / "log";
    const std::string path =
        fakeSlurm(folder, "echo \"$@\" >>'" + log + "'\necho '41;here'\n",
                  "echo \"$@\" >>'" + log + "'\nprintf '41_1 RUNNING\\n41_2 NODE_FAIL\\n'\n");
    const ProcessResult taken = runProgram(command, {path});
    EXPECT_EQ(taken.out, "array 41 (shards 1-2), merge 41; gfxrepro submit --status " + out + "\n");
    EXPECT_EQ(readFile(log),
              "--parsable --array=1-2 --output=" + out + "/task-%a.txt " + out +
                  "/task.sh\n--parsable --clusters=here --dependency=afterany:41 --output=" + out +
                  "/merge.txt " + out + "/merge.sh\n");
    const ProcessResult status =
        endedWith(4, runProgram({GFXREPRO_MOCK_PROGRAM, "submit", "--status", out}, {path}));
    EXPECT_THAT(status.out, HasSubstr("1/2    0/2   0       RUNNING\n"
                                      "2/2    0/2   0       stopped: NODE_FAIL\n"));
    EXPECT_THAT(readFile(log), HasSubstr("-j 41,41 -o %F_%K %T --clusters=here\n"));
    EXPECT_EQ(replaced(runProgram(command, {path}).err, out, "OUT"),
              "4 cases in 2 shards of 2 to 2 units; no earlier run tells their time\n"
              "gfxrepro: OUT: shard 1 is RUNNING already; wait, or scancel 41\n");
    // A queue that does not answer is no end, and the files go first.
    ASSERT_EQ(shell("SLURM_ARRAY_TASK_ID=1 exec sh '" + out + "/task.sh'").exitCode, 0);
    const std::string mute = fakeSlurm(folder, "echo 43\n", "exit 1\n");
    EXPECT_THAT(runProgram({GFXREPRO_MOCK_PROGRAM, "submit", "--status", out}, {mute}).out,
                HasSubstr("1/2    2/2   0       complete\n"
                          "2/2    0/2   0       unknown: the queue does not answer\n"));
    // So nothing is queued a second time that may be queued.
    const ProcessResult refusedAgain = endedWith(2, runProgram(command, {mute}));
    EXPECT_THAT(replaced(refusedAgain.err, out, "OUT"),
                HasSubstr("gfxrepro: OUT: the queue does not answer, so the merge may be queued; "
                          "look with squeue, and submit again with --force where nothing is\n"));
    // One that has forgotten the jobs answers. What is complete is left out.
    for (const char* answer :
         {"", "echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1\n"}) {
        EXPECT_EQ(runProgram(command, {fakeSlurm(folder, "echo 42\n", answer)}).out,
                  "array 42 (shards 2), merge 42; gfxrepro submit --status " + out + "\n");
    }
    std::vector<std::string> forced = command;
    forced.emplace_back("--force");
    EXPECT_EQ(runProgram(forced, {fakeSlurm(folder, "echo 43\n", "exit 1\n")}).out,
              "array 43 (shards 2), merge 43; gfxrepro submit --status " + out + "\n");
    EXPECT_THAT(runProgram(forced, {fakeSlurm(folder, "echo 44\n", "echo '43_2 SUSPENDED'\n")}).err,
                HasSubstr(": shard 2 is SUSPENDED already; wait, or scancel 43\n"));
}

TEST_F(Submit, WhatWasRefusedIsNotQueued) {
    const std::string out = folder.path() / "out";
    const auto submitted = [&](const fs::path& config, const std::string& path) {
        return runProgram({GFXREPRO_MOCK_PROGRAM, "submit", config, "--device", "software", "--out",
                           out, "--shards", "1"},
                          {path});
    };
    endedWith(2,
              submitted(writeNumbers(folder, 2),
                        fakeSlurm(folder, "echo 'invalid partition' >&2; exit 1\n", "exit 1\n")));
    EXPECT_FALSE(fs::exists(out)) << "nothing else was there";
    EXPECT_EQ(mockGfxrepro({"submit", "--status", out}).err,
              "gfxrepro: " + out + ": holds no submission\n");
    fs::create_directories(folder.path() / "none");
    const ProcessResult missing = endedWith(
        2, submitted(writeNumbers(folder, 2), "PATH=" + (folder.path() / "none").string()));
    EXPECT_THAT(missing.err, HasSubstr("sbatch did not take the job (exit code 127): "));
    EXPECT_THAT(
        missing.err,
        HasSubstr(
            "; where there is no Slurm, --engine commands prints commands; nothing was queued\n"));
    EXPECT_FALSE(fs::exists(out));
    // What is queued then is what the config says then; so it is where a submit was killed.
    folder.write("out/submitted-plan.json", "of another day");
    endedWith(0, submitted(writeNumbers(folder, 3), fakeSlurm(folder, "echo 7\n", "exit 1\n")));
    endedWith(0, shell("SLURM_ARRAY_TASK_ID=1 exec sh '" + out + "/task.sh'"));
    EXPECT_EQ(rowsOf(out + "/shards/1", "number").size(), 3U);
}

TEST_F(Submit, ARefusedMergeAndAnAnswerWithoutANumber) {
    const std::string config = writeNumbers(folder, 2);
    const auto submitted = [&](const std::string& out, const std::string& sbatch) {
        return runProgram({GFXREPRO_MOCK_PROGRAM, "submit", config, "--device", "software", "--out",
                           folder.path() / out, "--shards", "1"},
                          {fakeSlurm(folder, sbatch, "exit 1\n")});
    };
    const ProcessResult merge = endedWith(
        2,
        submitted(
            "a",
            "case \"$*\" in *afterany*) echo 'no such dependency' >&2; exit 1;; esac\necho 41\n"));
    EXPECT_THAT(
        merge.err,
        HasSubstr("gfxrepro: the merge: sbatch did not take the job (exit code 1): no such "
                  "dependency; array 41 is queued; submit again when the shards are complete\n"));
    EXPECT_TRUE(fs::exists(folder.path() / "a/submitted-plan.json")) << "the array measures it";
    EXPECT_THAT(endedWith(2, submitted("a", "echo 42\n")).err,
                HasSubstr("/a: the queue does not answer, so shard 1 may be queued; "));
    EXPECT_THAT(endedWith(2, submitted("b", "echo 'Submitted batch job'\n")).err,
                HasSubstr("gfxrepro: sbatch gave no number of a job, so what is queued is not "
                          "known; squeue shows it: Submitted batch job\n"));
    EXPECT_TRUE(fs::exists(folder.path() / "b/submitted-plan.json"));
    EXPECT_THAT(endedWith(2, submitted("b", "echo 42\n")).err,
                HasSubstr("/b: sbatch gave no number of a job, so shard 1 may be "));
}

TEST_F(Submit, SaysWhatItNeeds) {
    EXPECT_EQ(mockGfxrepro({"submit"}).err,
              "gfxrepro: submit: give PAPER, PAPER/TABLE or config files and --out DIR, or "
              "--status DIR\n");
    EXPECT_EQ(mockGfxrepro({"submit", "--status", folder.path()}).err,
              "gfxrepro: " + folder.path().string() + ": holds no submission\n");
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const std::string file = folder.write("file", "words");
    for (const std::string& out : {file, file + "/in/it"}) {
        EXPECT_EQ(
            endedWith(2, mockGfxrepro({"submit", config, "--out", out, "--engine", "commands"}))
                .err,
            "gfxrepro: " + file + ": is a file; --out names a folder\n");
    }
    EXPECT_EQ(readFile(file), "words");
}

}  // namespace
}  // namespace gfxrepro::test
