// expect-<device>.yaml: what is known to fail is not held against a run, and what it says is
// checked.
#include "runner/batch/expectations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using testing::ElementsAre;

constexpr const char* kDay = "2026-11-21";

/// The message about a file with this text, its folder as DIR.
std::string refusal(const std::string& text) {
    const TemporaryFolder folder;
    folder.write("expect-software.yaml", text);
    std::string message =
        errorText([&] { batch::Expectations({folder.path() / "table-1.yaml"}, "software", kDay); });
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

batch::Case caseWith(const std::string& experiment, const std::string& axes) {
    batch::Case item;
    item.experiment = experiment;
    item.axes = config::parseYaml(axes, "axes");
    item.params = config::Node::map({});
    return item;
}

TEST(Expectations, MatchByTableAndAxesUntilTheirDay) {
    const TemporaryFolder folder;
    folder.write("expect-gpu.yaml",
                 "fails:\n"
                 "  - {table: p/1, at: {n: [1, 2]}, status: crash, reason: a, until: 2026-11-21}\n"
                 "  - {table: p/1, at: {n: 9}, reason: b, until: 2026-11-20}\n");
    batch::Expectations list({folder.path() / "x.yaml"}, "gpu", kDay);
    EXPECT_TRUE(list.isExpected(caseWith("p/1", "{n: 2}"), report::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 2}"), report::Status::Timeout));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 3}"), report::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/2", "{n: 2}"), report::Status::Crash));
    EXPECT_FALSE(list.isExpected(caseWith("p/1", "{n: 9}"), report::Status::Crash));
    list.note(caseWith("p/1", "{n: 1}"), report::Status::Ok);
    const std::string file = folder.path() / "expect-gpu.yaml";
    EXPECT_THAT(list.complaints(),
                ElementsAre(file + ":2:5: the expectation is not needed: every case that it names "
                                   "passed (a)",
                            file + ":3:5: the expectation expired on 2026-11-20 (b)"));
    batch::Expectations other({folder.path() / "x.yaml"}, "software", kDay);
    EXPECT_FALSE(other.isExpected(caseWith("p/1", "{n: 2}"), report::Status::Crash));
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

}  // namespace
}  // namespace gfxrepro::test
