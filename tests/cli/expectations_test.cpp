// expect-<device>.yaml: what is known to fail is not held against a run, and what it says is
// checked.
#include "runner/run/expectations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kDay = "2026-11-21";

/// By the lists beside a config of the folder.
run::Expectations expected(const TemporaryFolder& folder, const std::string& deviceClass) {
    return {run::findExpectations({folder.path() / "table-1.yaml"}), deviceClass, kDay};
}

/// The message about a file with this text, its folder as DIR.
std::string refusal(const std::string& text) {
    const TemporaryFolder folder;
    folder.write("expect-software.yaml", text);
    std::string message = errorText([&] { expected(folder, "software"); });
    const std::string prefix = folder.path().string();
    if (message.starts_with(prefix)) message.replace(0, prefix.size(), "DIR");
    return message;
}

TEST(Expectations, BadFilesAreRefusedInTheirPlace) {
    EXPECT_EQ(
        refusal("failures: []\n"),
        "DIR/expect-software.yaml:1:1: unknown list 'failures'; allowed: fails, flakes, skips");
    EXPECT_EQ(refusal("fails:\n  - crash\n"),
              "DIR/expect-software.yaml:2:5: fails: expected a map, found text");
    EXPECT_EQ(refusal("skips:\n  - {table: p/1, until: 2027-01-31}\n"),
              "DIR/expect-software.yaml:2:5: skips: 'reason' is missing");
    EXPECT_EQ(refusal("skips:\n  - {table: p/1, reason: slow, until: soon}\n"),
              "DIR/expect-software.yaml:2:39: until: found 'soon', expected a day such as "
              "2027-01-31");
    EXPECT_EQ(
        refusal("fails:\n  - {table: p/1, reason: r, until: 2027-01-31, status: broken}\n"),
        "DIR/expect-software.yaml:2:56: unknown status 'broken'; allowed: ok, ambiguous, flaky, "
        "unsupported, timeout, oom, crash, device-lost, missing, error");
}

config::Case caseWith(const std::string& experiment, const std::string& axes) {
    config::Case item;
    item.experiment = experiment;
    item.axes = parseYaml(axes, "axes");
    item.params = Node::map({});
    return item;
}

TEST(Expectations, MatchByTableAndAxesUntilTheirDay) {
    const TemporaryFolder folder;
    folder.write("expect-gpu.yaml",
                 "fails:\n"
                 "  - {table: p/1, at: {n: [1, 2]}, status: crash, reason: a, until: 2026-11-21}\n"
                 "  - {table: p/1, at: {n: 9}, reason: b, until: 2026-11-20}\n");
    run::Expectations list = expected(folder, "gpu");
    EXPECT_TRUE(list.isExpected(caseWith("p/1", "{n: 2}"), records::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 2}"), records::Status::Timeout));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 3}"), records::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/2", "{n: 2}"), records::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 9}"), records::Status::Crash));
    list.note(caseWith("p/1", "{n: 1}"), records::Status::Ok);
    const std::string file = folder.path() / "expect-gpu.yaml";
    EXPECT_THAT(list.complaints(),
                ElementsAre(file + ":2:5: the expectation is not needed: every case that it names "
                                   "passed (a)",
                            file + ":3:5: the expectation expired on 2026-11-20 (b)"));
    EXPECT_FALSE(
        expected(folder, "software").isExpected(caseWith("p/1", "{n: 2}"), records::Status::Crash));
}

TEST(Expectations, WhatTheyNameHasToBeThere) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(
        folder, "sweep: {behaviour: [ok, crash]}\nprofiles:\n  quick: {sweep: {number: [7]}}\n");
    const std::string list = folder.path() / "expect-software.yaml";
    const auto complaint = [&](const std::string& table, const std::string& at) {
        folder.write("expect-software.yaml", "fails:\n  - table: " + table + "\n    at: " + at +
                                                 "\n    reason: r\n    until: 9999-12-31\n");
        const ProcessResult check = mockGfxrepro({"check", config});
        EXPECT_EQ(check.exitCode, check.err.empty() ? 0 : 2);
        return check.err;
    };
    EXPECT_EQ(complaint("sweep/mock", "{behaviour: [crash, ok]}"), "");
    EXPECT_EQ(complaint("sweep/mock", "{number: 7}"), "") << "in the profile quick";
    EXPECT_EQ(complaint("sweep/mokc", "{}"),
              "gfxrepro: " + list +
                  ":2:5: table: no config beside the list is 'sweep/mokc'; did you mean "
                  "'sweep/mock'?\n");
    EXPECT_EQ(complaint("sweep/mock", "{behavior: crash}"),
              "gfxrepro: " + list +
                  ":3:20: at: 'behavior' is no axis or parameter of sweep/mock; did you mean "
                  "'behaviour'?\n");
    const std::string unknown =
        list + ":3:26: at: no case of sweep/mock has behaviour=crush; did you mean 'crash'?\n";
    EXPECT_EQ(complaint("sweep/mock", "{behaviour: [ok, crush]}"), "gfxrepro: " + unknown);
    const ProcessResult run = mockGfxrepro(
        {"run", config, "--device", "software", "--quiet", "--out", folder.path() / "run"});
    EXPECT_NE(run.err.find("warning: " + unknown), std::string::npos) << run.err;
}

TEST(Expectations, RunFollowsThem) {
    const TemporaryFolder folder;
    const std::string config =
        writeMockConfig(folder, "sweep: {behaviour: [ok, crash, hang, throw]}\n");
    folder.write("expect-software.yaml",
                 "fails:\n"
                 "  - {table: sweep/mock, at: {behaviour: crash}, reason: it must, until: "
                 "9999-12-31}\n"
                 "  - {table: sweep/mock, at: {behaviour: ok}, reason: was bad, until: "
                 "9999-12-31}\n"
                 "skips:\n"
                 "  - {table: sweep/mock, at: {behaviour: hang}, reason: it hangs, until: "
                 "9999-12-31}\n");
    const std::string dir = folder.path() / "run";
    const ProcessResult run = mockGfxrepro({"run", config, "--device", "software", "--out", dir});
    EXPECT_EQ(run.exitCode, 4);
    EXPECT_EQ(run.out, "1 of 4 finished, 1 failed, 2 failed or skipped as expected; records: " +
                           dir + "/records.csv\n");
    EXPECT_THAT(statusLines(dir),
                testing::UnorderedElementsAre("ok: ok", "crash: crash (SIGSEGV: about to crash)",
                                              "hang: missing (skipped until 9999-12-31: it hangs)",
                                              "throw: error (nothing works)"));
    EXPECT_NE(run.err.find("expect-software.yaml:3:5: the expectation is not needed: every case "
                           "that it names passed (was bad)\n"),
              std::string::npos)
        << run.err;
}

class FrozenExpectations : public ::testing::Test {
  protected:
    void SetUp() override { expect("crash"); }
    /// That the case of this behaviour fails.
    void expect(const std::string& behaviour) const {
        folder.write("expect-software.yaml",
                     "fails:\n  - {table: sweep/mock, at: {behaviour: " + behaviour +
                         "}, reason: it must, until: 9999-12-31}\n");
    }

    TemporaryFolder folder;
    std::string config = writeMockConfig(folder, "sweep: {behaviour: [ok, crash]}\n");
    std::string list = folder.path() / "expect-software.yaml";
    std::string dir = folder.path() / "run";
};

TEST_F(FrozenExpectations, ARunThatGoesOnKnowsTheListAsItWas) {
    const ProcessResult run = mockGfxrepro({"run", config, "--device", "software", "--out", dir});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    expect("ok");
    const std::string warning = "warning: " + list +
                                " changed; the run goes on with its configs as they were when it "
                                "began\n";
    const ProcessResult changed = mockGfxrepro({"run", "--resume", dir});
    EXPECT_EQ(changed.exitCode, 0) << changed.out;
    EXPECT_THAT(changed.err, HasSubstr(warning));
    std::filesystem::remove(list);
    const ProcessResult gone = mockGfxrepro({"run", "--resume", dir});
    EXPECT_EQ(gone.exitCode, 0) << gone.out;
    EXPECT_THAT(gone.err, HasSubstr(warning));
    folder.write("expect-software.yaml", "fails: [");  // whatever it says
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).exitCode, 0);
}

TEST_F(FrozenExpectations, AListThatIsNewIsNotFollowed) {
    std::filesystem::remove(list);
    const auto resumed = [&] { return mockGfxrepro({"run", "--resume", dir}); };
    EXPECT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", dir}).exitCode, 4);
    EXPECT_THAT(resumed().err, Not(HasSubstr("changed")));
    expect("crash");
    const ProcessResult result = resumed();
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(result.err, HasSubstr("warning: " + list + " changed; the run goes on with"));
}

TEST_F(FrozenExpectations, WhatIsSubmittedHasItsList) {
    const std::string out = folder.path() / "out";
    ASSERT_EQ(mockGfxrepro({"submit", config, "--device", "software", "--out", out, "--engine",
                            "commands", "--shards", "1"})
                  .exitCode,
              0);
    expect("ok");
    const ProcessResult shard = runProgram({"/bin/sh", out + "/commands.txt"});
    EXPECT_EQ(shard.exitCode, 0) << shard.err;
    EXPECT_THAT(shard.err,
                HasSubstr("warning: " + list + " changed; what was submitted is measured\n"));
}

TEST_F(FrozenExpectations, ThoseOfAPlanAreNotEdited) {
    ASSERT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", dir}).exitCode, 0);
    std::string plan = readFile(dir + "/plan.json");
    const std::size_t at = plan.find("behaviour: crash}");
    ASSERT_NE(at, std::string::npos);
    writeFileAtomic(dir + "/plan.json", plan.replace(at, 17, "behaviour: throw}"));
    const ProcessResult table = mockGfxrepro({"table", dir});
    EXPECT_EQ(table.exitCode, 2);
    EXPECT_THAT(table.err, HasSubstr("planned: plan.json was changed\n"));
}

TEST_F(FrozenExpectations, AListThatCannotBeReadStopsNoCommandOnARun) {
    const fs::path configs = folder.path() / "configs";
    const std::string file = folder.write("configs/mock.yaml", readFile(config));
    const std::string moved = folder.write("configs/expect-software.yaml", readFile(list));
    ASSERT_EQ(mockGfxrepro({"run", file, "--device", "software", "--out", dir}).exitCode, 0);
    const auto judged = [&](const std::string& reason) {
        for (const char* command : {"table", "claims", "report"}) {
            const ProcessResult result = mockGfxrepro({command, dir});
            EXPECT_EQ(result.exitCode, 0) << command << result.err;
            EXPECT_THAT(result.err,
                        HasSubstr("warning: " + moved + " cannot be compared (" + reason));
        }
    };
    fs::remove(moved);
    fs::create_directory(moved);
    judged("cannot read " + moved + ": Is a directory); the run is judged by what it said");
    const ProcessResult resumed = mockGfxrepro({"run", "--resume", dir});
    EXPECT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr(moved + " cannot be compared (cannot read "));
    // A folder that does not even say whether it is there.
    fs::remove_all(configs);
    fs::create_symlink("configs", configs);
    judged("");
}

TEST_F(FrozenExpectations, EveryCommandThatReadsARunGoesByThem) {
    ASSERT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", dir}).exitCode, 0);
    const std::string shard = folder.path() / "shard", merged = folder.path() / "merged",
                      out = folder.path() / "out";
    ASSERT_EQ(
        mockGfxrepro({"run", config, "--device", "software", "--shard", "1/1", "--out", shard})
            .exitCode,
        0);
    expect("ok");
    for (const std::vector<std::string>& command : {std::vector<std::string>{"table", dir},
                                                    {"claims", dir},
                                                    {"claims", dir, "--config", config},
                                                    {"report", dir},
                                                    {"report", dir, dir, "--out", out + ".html"}}) {
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 0) << command.front() << result.out;
        EXPECT_THAT(result.out, HasSubstr("1 of 2 failed or skipped as expected\n"));
        EXPECT_THAT(result.out, Not(HasSubstr("incomplete")));
        EXPECT_THAT(result.err, HasSubstr("warning: " + list +
                                          " changed; the run is judged by what it said "
                                          "when the run was planned\n"));
    }
    EXPECT_EQ(mockGfxrepro({"compare", dir, dir, "--out", out}).exitCode, 0);
    const ProcessResult merge = mockGfxrepro({"merge", "--out", merged, shard});
    EXPECT_EQ(merge.exitCode, 0);
    EXPECT_THAT(merge.out, HasSubstr(": 1 of 2 measured, 0 failed, 0 missing, 1 failed or skipped "
                                     "as expected\n"));
    const std::string junit = readFile(dir + "/junit.xml");
    EXPECT_THAT(junit, HasSubstr("name=\"cases\" tests=\"2\" failures=\"0\" skipped=\"1\""));
    EXPECT_THAT(junit,
                HasSubstr("<skipped message=\"crash: SIGSEGV: about to crash; expected until "
                          "9999-12-31: it must\"/>"));
}

TEST_F(FrozenExpectations, WhatDidNotFailIsAFailureInJunit) {
    expect("ok");
    config = writeMockConfig(folder, "params: {behaviour: ok}\nsweep: {number: [1, 2]}\n");
    const ProcessResult run = mockGfxrepro({"run", config, "--device", "software", "--out", dir});
    const std::string complaint =
        list + ":2:5: the expectation is not needed: every case that it names passed (it must)\n";
    EXPECT_EQ(run.exitCode, 0) << "every case finished";
    EXPECT_THAT(run.err, HasSubstr(complaint));
    const ProcessResult claims = mockGfxrepro({"claims", dir});
    EXPECT_EQ(claims.exitCode, 0);
    EXPECT_THAT(claims.err, HasSubstr(complaint));
    const std::string junit = readFile(dir + "/junit.xml");
    EXPECT_THAT(junit, HasSubstr("name=\"cases\" tests=\"2\" failures=\"2\" skipped=\"0\""));
    EXPECT_THAT(junit, HasSubstr("<failure message=\"ended well, but was expected to fail until "
                                 "9999-12-31: it must (" +
                                 list + ":2:5)\"/>"));
}

TEST_F(FrozenExpectations, TheDayIsThatOfTheRun) {
    ASSERT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", dir}).exitCode, 0);
    std::string manifest = readFile(dir + "/manifest.json");
    const std::string started = "\"started\": \"";
    const std::size_t last = manifest.rfind(started);
    ASSERT_NE(last, std::string::npos);
    manifest.replace(last + started.size(), 4, "99999");  // a run of the year 99999
    writeFileAtomic(dir + "/manifest.json", manifest);
    const ProcessResult table = mockGfxrepro({"table", dir});
    EXPECT_EQ(table.exitCode, 4);
    EXPECT_THAT(table.err, HasSubstr("the expectation expired on 9999-12-31 (it must)\n"));
}

}  // namespace
}  // namespace gfxrepro::test
