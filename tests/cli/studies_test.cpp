// What is made of runs for others: how claims depend on assumptions, and artifacts.

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

const char* const kClaim =
    "sweep: {behaviour: [ok]}\nparams: {number: 3}\n"
    "layout:\n  rows: behaviour\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n"
    "claims:\n  small: {says: the number is small, bound: n, at_most: 6}\n"
    "  any: {says: the number is there, bound: n, at_least: -1}\n"
    "assumptions:\n  number: {range: [0, 10], why: left open}\n"
    "  place: {value: none, range: any, why: left open}\n";

std::vector<std::string> sensitivityCommand(const std::string& config, const std::string& out) {
    return {"sensitivity", config, "--device", "software", "--profile", "full", "--out", out};
}

using Sensitivity = FolderTest;

TEST_F(Sensitivity, FindsTheNumberAtWhichAVerdictFlips) {
    const std::string config = writeMockConfig(folder, kClaim);
    const std::string out = folder.path() / "out";
    const std::vector<std::string> command = sensitivityCommand(config, out);
    const ProcessResult run = endedWith(0, mockGfxrepro(command));
    EXPECT_EQ(run.out,
              "sweep/mock small: holds unless number is 10 (flips between 5 and 10, near 6); rests "
              "on: number (of 1 tried)\n"
              "sweep/mock any: holds under all 4; rests on: none of the 1 tried\n" +
                  out + "/sweep-mock/sensitivity.md\n");
    EXPECT_THAT(readFile(out + "/sweep-mock/sensitivity.csv"),
                HasSubstr(",number,10,small,fails,10,"));
    EXPECT_THAT(readFile(out + "/sweep-mock/sensitivity.md"),
                HasSubstr("- place: no parameter of the technique\n"));
    // Again: the runs are there and only read.
    EXPECT_EQ(mockGfxrepro(command).out, run.out);
}

TEST_F(Sensitivity, ARangeThatNoCaseCanHaveIsRefused) {
    const std::string config = writeMockConfig(
        folder, std::string(kClaim) + "  pause_ms: {range: [100000, 20, 30], why: left open}\n");
    const std::string out = folder.path() / "out";
    const std::string why = "gfxrepro: " + config +
                            ":17:22: technique 'mock': pause_ms is 100000; allowed: 0 … 60000 ms\n";
    EXPECT_THAT(endedWith(2, mockGfxrepro(sensitivityCommand(config, out))).err, HasSubstr(why));
    EXPECT_EQ(mockGfxrepro({"check", config}).err, why);
}

TEST_F(Sensitivity, CasesThatFailedLeaveItIncomplete) {
    const std::string config = writeMockConfig(
        folder,
        "sweep: {number: [1, 2]}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n"
        "claims:\n  any: {says: the number is there, bound: n, at_least: -1}\n"
        "params: {behaviour: ok}\n"
        "assumptions:\n  behaviour: {range: [throw], why: left open}\n");
    const std::string out = folder.path() / "out";
    EXPECT_THAT(endedWith(4, mockGfxrepro(sensitivityCommand(config, out))).err,
                HasSubstr("sweep/mock: not all of its cases were measured; the runs are in " + out +
                          "/sweep-mock\n"));
}

TEST_F(Sensitivity, TriesTablesByTurnsWithinABudgetAndStartsFromARun) {
    const std::string config = writeMockConfig(folder, kClaim);
    const std::string run = folder.path() / "run", out = folder.path() / "out";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", run}).exitCode, 0);
    std::vector<std::string> command = sensitivityCommand(config, out);
    command.insert(command.end(), {"--from", run});
    const ProcessResult none = endedWith(0, mockGfxrepro(command, {"--budget", "0.001s"}));
    EXPECT_THAT(none.out, HasSubstr("sweep/mock any: holds under all 1; rests on: not tried\n"));
    const ProcessResult all = mockGfxrepro(command);
    EXPECT_THAT(all.out,
                HasSubstr("sweep/mock any: holds under all 4; rests on: none of the 1 tried\n"));
    EXPECT_FALSE(fs::exists(out + "/sweep-mock/as_configured"));
    for (const char* bad : {"20", "m", "0m", "-1m", "20 m", "20min", "nanm", "infh"}) {
        EXPECT_EQ(mockGfxrepro({"sensitivity", config, std::string("--budget=") + bad}).err,
                  std::string("gfxrepro: --budget is '") + bad +
                      "'; allowed: a time such as 90s, 20m or 1.5h\n");
    }
}

TEST_F(Sensitivity, GoesOnWhereKeptResultsEnd) {
    const std::string keep = folder.path() / "keep";
    const auto kept = [&] { return readFile(keep + "/software-full.csv"); };
    const auto run = [&](const std::string& claim, const std::string& out,
                         const std::vector<std::string>& more) {
        std::vector<std::string> command =
            sensitivityCommand(writeMockConfig(folder, claim), folder.path() / out);
        command.insert(command.end(), {"--keep", keep});
        return mockGfxrepro(command, more);
    };
    const std::string wider = std::string(kClaim) + "  pause_ms: {range: [0, 1], why: left open}\n";
    ASSERT_EQ(run(kClaim, "a", {}).exitCode, 0);
    // No time is left to try the second assumption: what is kept says so.
    const ProcessResult none = run(wider, "none", {"--budget", "0.001s"});
    EXPECT_THAT(none.out, HasSubstr("; rests on: number (1 of 2 tried)\n"));
    EXPECT_THAT(kept(), HasSubstr(",pause_ms,1,,,,,,not made\n"));
    EXPECT_THAT(readFile(keep + "/README.md"), HasSubstr("| any | small: number (1 of 2 tried) |"));
    const ProcessResult more = run(wider, "b", {});
    EXPECT_THAT(more.err, HasSubstr("[5/5] sweep/mock pause_ms = 1\n"));
    EXPECT_THAT(more.err, Not(HasSubstr("number = "))) << "these are kept";
    EXPECT_THAT(more.out, HasSubstr("sweep/mock small: holds unless number is 10 (flips between 5 "
                                    "and 10, near 6); rests on: number (of 2 tried)\n"));
    EXPECT_THAT(kept(), HasSubstr(",number,10,small,fails,10,"));
    EXPECT_THAT(kept(), HasSubstr(",pause_ms,1,small,holds,3,"));
    // Another claim: nothing that is kept is of it.
    std::string other = kClaim;
    other.replace(other.find("at_most: 6"), 10, "at_most: 2");
    EXPECT_THAT(run(other, "c", {}).err, HasSubstr("[1/4] sweep/mock as configured\n"));
}

TEST_F(Sensitivity, TablesOfTimesAreNamed) {
    const std::string keep = folder.path() / "keep";
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {behaviour: [ok]}\nmeasure: {lane: timing, processes: 6}\n"
                        "layout: {rows: behaviour, columns: {ms: {metric: wall_time_ms}}}\n"
                        "claims: {fast: {says: fast, bound: ms, at_most: 5, kind: absolute}}\n");
    const ProcessResult run =
        mockGfxrepro(sensitivityCommand(config, folder.path() / "out"), {"--keep", keep});
    EXPECT_THAT(run.err, StartsWith("device "));
    EXPECT_THAT(run.err, EndsWith("\nsweep/mock: left out, all its claims are of times\n"));
    EXPECT_FALSE(fs::exists(keep));
}

/// Which of its claims are of times is known by what its cases will give.
TEST_F(Sensitivity, OfATableThatNobodyLaidOutTheOtherClaimsAreTried) {
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {behaviour: [ok]}\nparams: {number: 3}\nmeasure: {processes: 1}\n"
                        "claims:\n  few: {says: few, bound: number, at_most: 6}\n"
                        "  fast: {says: fast, bound: frame_ms, at_most: 9e9, kind: absolute}\n"
                        "assumptions: {number: {range: [0, 10], why: left open}}\n");
    const ProcessResult run =
        endedWith(0, mockGfxrepro(sensitivityCommand(config, folder.path() / "out")));
    EXPECT_THAT(run.err, Not(HasSubstr("exit code")));
    EXPECT_THAT(run.out, HasSubstr("sweep/mock few: holds unless number is 10 (flips between"));
}

TEST_F(Sensitivity, TriesTimesWhereTheyAreAskedForAndKeepsThem) {
    const std::string keep = folder.path() / "keep";
    const std::string fast =
        "sweep: {behaviour: [ok]}\nparams: {number: 1}\nmeasure: {lane: timing, processes: 6}\n"
        "layout: {rows: behaviour, columns: {ms: {metric: wall_time_ms}, n: {metric: number}}}\n"
        "claims:\n  fast: {says: fast, order: ms < 1000 * ms, kind: algorithmic}\n";
    const std::string few = "  few: {says: few, bound: n, at_most: 6}\n";
    const std::string open = "assumptions: {number: {range: [1, 10], why: left open}}\n";
    const auto run = [&](const std::string& claims, const std::vector<std::string>& more) {
        std::vector<std::string> command =
            sensitivityCommand(writeMockConfig(folder, claims + open), folder.path() / "out");
        command.insert(command.end(), {"--keep", keep});
        fs::remove_all(folder.path() / "out");
        return mockGfxrepro(command, more);
    };
    const auto kept = [&] { return readFile(keep + "/software-full.csv"); };
    // Of a table with other claims, too, these alone are tried first, then all.
    const std::string untold = "sweep/mock fast: not judged as configured";
    EXPECT_THAT(run(fast + few, {}).out, HasSubstr(untold));
    const ProcessResult all = run(fast + few, {"--times"});
    EXPECT_THAT(all.err, HasSubstr("sweep/mock as configured\n"));
    EXPECT_THAT(all.out, Not(HasSubstr(untold)));
    // What was tried stays where another study asks for no times.
    EXPECT_THAT(run(fast, {"--times"}).out, Not(HasSubstr(untold)));
    EXPECT_THAT(run(fast, {}).err, HasSubstr("left out, all its claims are of times\n"));
    EXPECT_THAT(kept(), HasSubstr(",number,10,fast,"));
}

TEST_F(Sensitivity, ReportsShowWhatIsKept) {
    const std::string config = writeMockConfig(folder, kClaim);
    // Kept results lie beside the configs.
    folder.write("configs/scenes/readme", "");
    const std::string keep = folder.path() / "results/sensitivity";
    const std::string out = folder.path() / "out", run = folder.path() / "run";
    ASSERT_EQ(mockGfxrepro(sensitivityCommand(config, out), {"--keep", keep}).exitCode, 0);
    EXPECT_EQ(readFile(keep + "/software-full.csv"), readFile(out + "/sweep-mock/sensitivity.csv"));
    EXPECT_THAT(readFile(keep + "/README.md"),
                HasSubstr("## [software-full](software-full.csv)\n| table | none | rests on |\n"
                          "| --- | --- | --- |\n"
                          "| sweep/mock | any | small: number (of 1 tried) |\n"));
    const std::vector<std::string> environment = {"GFXREPRO_DATA=" + folder.path().string()};
    const auto claims = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {
            GFXREPRO_MOCK_PROGRAM, "reproduce", config,  "--quiet", "--device", "software",
            "--profile",           "full",      "--out", run};
        arguments.insert(arguments.end(), more.begin(), more.end());
        fs::remove_all(run);
        endedWith(0, runProgram(arguments, environment));
        return readFile(run + "/claims.csv");
    };
    EXPECT_THAT(claims({}), HasSubstr("one sample,,number (of 1 tried),,,\n"));
    EXPECT_THAT(readFile(run + "/report.html"),
                HasSubstr("<span class=\"soft\">rests on </span>number (of 1 tried)</p>"));
    // Of another case they say nothing.
    EXPECT_THAT(claims({"--set", "number=4"}), HasSubstr("one sample,,not tried,,,\n"));
}

TEST_F(Sensitivity, WhereNothingCouldBeKeptIsSaidOnce) {
    folder.write("configs/scenes/readme", "");
    const std::string config = folder.write(
        "t.yaml",
        "table: demo2026/1\ntitle: t\ntechnique: mock\nsweep: {number: [1, 2]}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number}\n"
        "claims:\n  A: {says: a, origin: ours, bound_from: ours, bound: n, at_least: -1}\n"
        "  B: {says: b, origin: ours, bound_from: ours, bound: n, at_least: -2}\n");
    const std::string run = folder.path() / "run", kept = folder.path() / "results/sensitivity";
    const auto out = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), GFXREPRO_MOCK_PROGRAM);
        const ProcessResult result =
            endedWith(0, runProgram(arguments, {"GFXREPRO_DATA=" + folder.path().string()}));
        return result.out;
    };
    const std::string line =
        "on which assumptions verdicts rest is not known: there is no " + kept + "\n";
    const auto timesSaid = [&](const std::string& text) {
        return (text.find(line) != text.npos) + (text.find(line) != text.rfind(line) ? 1 : 0);
    };
    EXPECT_EQ(timesSaid(out({"reproduce", config, "--device", "software", "--out", run})), 1);
    EXPECT_THAT(readFile(run + "/claims.csv"), HasSubstr(",not known,,,\n"));
    EXPECT_EQ(timesSaid(out({"claims", run, "--config", config})), 1);
    fs::create_directories(kept);
    EXPECT_EQ(timesSaid(out({"claims", run})), 0);
    EXPECT_THAT(readFile(run + "/claims.csv"), HasSubstr(",not tried,,,\n"));
    EXPECT_EQ(timesSaid(out({"claims", run, "--config", config})), 0);
    EXPECT_THAT(readFile(run + "/judged-afterwards/claims.csv"), HasSubstr(",not tried,,,\n"));
}

TEST(Export, AnArtifactCanBeMeasuredAgain) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(folder, kClaim);
    const std::string dir = folder.path() / "run", artifact = folder.path() / "artifact";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    EXPECT_EQ(endedWith(0, mockGfxrepro({"export", dir, "--out", artifact})).out, artifact + "\n");
    for (const char* name : {"plan.json", "records.csv", "claims.csv", "report.html", "ASSETS.md",
                             "environment.txt", "tables/sweep-mock.csv"}) {
        EXPECT_TRUE(fs::exists(fs::path(artifact) / name)) << name;
    }
    EXPECT_THAT(readFile(artifact + "/environment.txt"), HasSubstr("gl.renderer: llvmpipe"));
    EXPECT_THAT(readFile(artifact + "/README.md"), HasSubstr("| scripts/sweep-mock.sh | 0.0 | "));
    EXPECT_EQ(shell("cd " + artifact + " && sha256sum --quiet -c SHA256SUMS").exitCode, 0);
    const ProcessResult again =
        endedWith(0, runProgram({artifact + "/scripts/sweep-mock.sh"},
                                {std::string("GFXREPRO=") + GFXREPRO_MOCK_PROGRAM}));
    EXPECT_EQ(readFile(artifact + "/again/sweep-mock/tables/sweep-mock.csv"),
              readFile(artifact + "/tables/sweep-mock.csv"));
    EXPECT_EQ(mockGfxrepro({"export", dir, "--out", artifact}).err,
              "gfxrepro: " + artifact + ": is there already; give another folder\n");
}

}  // namespace
}  // namespace gfxrepro::test
