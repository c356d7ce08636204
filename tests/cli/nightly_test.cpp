// Nights of a fast and a slow build, as scripts/nightly measures them.

#include <chrono>
#include <filesystem>
#include <set>
#include <string>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// To open a device is most of what a short night takes.
constexpr const char* kTechnique = "mock_on_cpu";

struct Nightly : FolderTest {
    /// What nights look for in most tests shows without times.
    std::string measure() const {
        return isTimed ? "measure: {lane: timing, processes: 1, repeats: 2}\n"
                       : "measure: {lane: quality, processes: 1}\n";
    }
    /// A bundle of the mock program, slower by `extraUs` in each iteration, its picture of `shade`.
    std::string bundle(int extraUs) const {
        const std::string name = "bundle-" + std::to_string(extraUs);
        fs::create_directories(folder.path() / name);
        const fs::path program = writeProgram(
            folder, name + "/gfxrepro",
            "#!/bin/sh\nGFXREPRO_MOCK_EXTRA_MS=" + std::to_string(extraUs) +
                "e-3 GFXREPRO_MOCK_SHADE=" + shade + " exec " + GFXREPRO_MOCK_PROGRAM + " \"$@\"" +
                (isCrashing ? "$([ $1 != run ] || echo ' --set behaviour=crash')\n" : "\n"));
        return program.parent_path();
    }
    ProcessResult night(int extraUs, bool isFix = false, const std::string& reason = "") const {
        std::vector<std::string> arguments = {"/usr/bin/env", "GFXREPRO_NIGHTLY=" + state,
                                              GFXREPRO_SOURCE "/scripts/nightly"};
        if (isFix) arguments.emplace_back("--fix");
        if (!reason.empty()) arguments.insert(arguments.end(), {"--accept", reason});
        const fs::path config =
            writeMockConfig(folder, "params: {busy_ms: 20}\n" + measure(), kTechnique);
        arguments.insert(arguments.end(),
                         {"--rounds", isTimed ? "8" : "2", "--program", bundle(extraUs), config});
        return runProgram(arguments);
    }
    /// A night of a bundle whose program is this script, of two cases.
    ProcessResult nightOf(const std::string& script,
                          const std::vector<std::string>& options = {}) const {
        const fs::path program = writeProgram(folder, "broken/gfxrepro", "#!/bin/sh\n" + script);
        const fs::path config =
            writeMockConfig(folder, "sweep: {busy_ms: [18, 22]}\n" + measure(), kTechnique);
        std::vector<std::string> arguments = {"/usr/bin/env", "GFXREPRO_NIGHTLY=" + state,
                                              GFXREPRO_SOURCE "/scripts/nightly"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        arguments.insert(arguments.end(), {"--rounds", isTimed ? "8" : "2", "--program",
                                           program.parent_path(), config});
        return runProgram(arguments);
    }
    /// The program that later nights are compared with.
    std::string landed() const { return readFile(state + "/landed/gfxrepro"); }
    /// Runs below all nights.
    std::size_t keptRuns() const {
        std::size_t count = 0;
        for (const auto& entry : fs::recursive_directory_iterator(state)) {
            count += entry.path().filename() == "plan.json" ? 1 : 0;
        }
        return count;
    }
    void letAWeekPass() const {
        fs::last_write_time(state + "/fixed-compared",
                            fs::file_time_type::clock::now() - std::chrono::hours(24 * 8));
    }

    std::string state = folder.path() / "state";
    std::string shade = "0.5";
    bool isCrashing = false;
    bool isTimed = false;
};

TEST_F(Nightly, TheFirstNightIsWhatLaterOnesAreComparedWith) {
    EXPECT_EQ(endedWith(0, night(0)).out,
              "nightly: tonight's build is what later nights are compared with\n");
    EXPECT_EQ(landed(), readFile(state + "/fixed/gfxrepro"));
    EXPECT_FALSE(fs::exists(state + "/history.csv"));
}

TEST_F(Nightly, TheFirstNightLandsNothingThatCrashes) {
    isCrashing = true;
    EXPECT_EQ(night(0).exitCode, 4);
    EXPECT_FALSE(fs::exists(state + "/landed"));
    isCrashing = false;
    EXPECT_EQ(night(0).exitCode, 0);
    EXPECT_EQ(landed(), readFile(state + "/fixed/gfxrepro"));
}

const std::string kMock = GFXREPRO_MOCK_PROGRAM " \"$@\"";

TEST_F(Nightly, ABuildThatSaysNothingNeverLands) {
    const ProcessResult first = endedWith(2, nightOf("exit 0\n"));
    EXPECT_NE(first.err.find("/first has no record of some case\n"), std::string::npos)
        << first.err;
    EXPECT_FALSE(fs::exists(state + "/landed"));
    ASSERT_EQ(night(0).exitCode, 0);
    EXPECT_EQ(nightOf("exit 0\n").exitCode, 2);
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=0e-3 "));
}

TEST_F(Nightly, TheLastBuildJudgesAndEndsAsItsReportTells) {
    ASSERT_EQ(night(0).exitCode, 0);
    const std::string blind =
        "[ $1 != compare ] || { " + kMock + "; exit 0; }\nexec " + kMock + '\n';
    const std::string slow = "export GFXREPRO_MOCK_EXTRA_MS=15\n" + blind;
    isTimed = true;
    EXPECT_EQ(nightOf(slow).exitCode, 1) << "whatever it says itself";
    EXPECT_NE(landed().find("EXTRA_MS=0e-3 "), std::string::npos);
    // A judge that landed before, and ends with 0 whatever it found.
    folder.write("state/landed/gfxrepro", "#!/bin/sh\n" + blind);
    const ProcessResult judged = endedWith(2, nightOf(slow));
    EXPECT_NE(judged.err.find("nightly: the comparison ends with 0, and tells of "),
              std::string::npos)
        << judged.err;
    EXPECT_EQ(landed(), "#!/bin/sh\n" + blind);
}

TEST_F(Nightly, WhatIsLostIsFoundByTheLastBuild) {
    const std::string mock = "exec " + kMock + '\n';
    ASSERT_EQ(nightOf(mock).exitCode, 0);
    const std::string fewer = "[ $1 != run ] || exec " + kMock + " --only busy_ms=22\n" + mock;
    EXPECT_EQ(nightOf(fewer).exitCode, 1);
    EXPECT_EQ(landed().find("--only"), std::string::npos);
    EXPECT_EQ(nightOf(fewer, {"--fix"}).exitCode, 0) << "as it was said";
    EXPECT_NE(landed().find("--only"), std::string::npos);
}

/// The step of the workflow that shows a night.
std::string shownByWorkflow() {
    const std::string workflow = readFile(GFXREPRO_SOURCE "/.github/workflows/nightly.yml");
    const std::size_t begin = workflow.find("          night=");
    return workflow.substr(begin, workflow.find("\n      - ", begin) - begin);
}

TEST_F(Nightly, TheWorkflowShowsWhatTheNightHas) {
    const auto shown = [&] {
        fs::create_directories(folder.path() / "runs");
        if (!fs::exists(folder.path() / "runs/nightly")) {
            fs::create_directory_symlink(state, folder.path() / "runs/nightly");
        }
        return runProgram(
            {"/bin/bash", "-e", "-c", "cd " + folder.path().string() + '\n' + shownByWorkflow()},
            {"GITHUB_STEP_SUMMARY=/dev/stdout"});
    };
    EXPECT_EQ(shown().exitCode, 0) << "no night yet";
    isCrashing = true;
    ASSERT_EQ(night(0).exitCode, 4);
    EXPECT_EQ(endedWith(0, shown()).out, "");
    isCrashing = false;
    ASSERT_EQ(night(0).exitCode, 0);
    endedWith(0, shown());
    EXPECT_FALSE(fs::exists(folder.path() / "benchmark.json")) << "no times";
    letAWeekPass();
    isTimed = true;
    ASSERT_EQ(night(1).exitCode, 0);
    const ProcessResult later = endedWith(0, shown());
    EXPECT_THAT(later.out, HasSubstr("With the fixed build:\n"));
    EXPECT_TRUE(fs::exists(folder.path() / "benchmark.json"));
}

TEST_F(Nightly, TheSameBuildLandsAndASlowerOneAlarms) {
    isTimed = true;
    ASSERT_EQ(night(0).exitCode, 0);
    endedWith(0, night(1));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=1e-3 ")) << "a microsecond of 20 ms is nothing";
    EXPECT_TRUE(fs::exists(state + "/history.csv"));
    EXPECT_THAT(readFile(state + "/history.html"), HasSubstr("<svg"));
    const ProcessResult slow = endedWith(1, night(15000));
    EXPECT_THAT(slow.out, HasSubstr("alarm; measuring again\n"));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=1e-3 ")) << "a slower build does not land";
    EXPECT_GE(keptRuns(), 28U) << "those of the alarm: two looks at both builds";
    // As it is meant to be slower:
    const ProcessResult accepted = endedWith(0, night(15000, false, "it is \"right\" now"));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=15000e-3 "));
    EXPECT_FALSE(fs::exists(state + "/history.csv")) << "begins anew";
    const std::string reasons = readFile(state + "/accepted.csv");
    EXPECT_THAT(reasons, HasSubstr(",1,\"it is \"\"right\"\" now\"\n"));
    endedWith(0, night(0, true));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=0e-3 "));
}

TEST_F(Nightly, AReasonIsKeptOfTheFirstNightToo) {
    ASSERT_EQ(night(0, false, "from now on").exitCode, 0);
    const std::string reasons = readFile(state + "/accepted.csv");
    EXPECT_THAT(reasons, HasSubstr(",0,\"from now on\"\n"));
}

TEST_F(Nightly, ABuildWhosePictureChangedDoesNotLandAndTheEvidenceIsKept) {
    ASSERT_EQ(night(0).exitCode, 0);
    shade = "0.75";
    const ProcessResult other = endedWith(1, night(1));
    EXPECT_THAT(other.out, HasSubstr("picture/flat: changed: FLIP "));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=0e-3 "));
    std::size_t kept = 0;
    for (const auto& entry : fs::recursive_directory_iterator(state)) {
        const bool isKept = entry.path().string().find("/pictures/") != std::string::npos;
        kept += isKept && entry.is_regular_file() ? 1 : 0;
    }
    EXPECT_EQ(kept, 5U) << "two EXR files, two PNG files, and the map of differences";
}

TEST_F(Nightly, ABuildThatCrashesIsNotAcceptedAndASoundOneLandsAfterIt) {
    ASSERT_EQ(night(0).exitCode, 0);
    isCrashing = true;
    const ProcessResult refused = endedWith(1, night(1, false, "it is right"));
    EXPECT_THAT(refused.err, HasSubstr("nightly: not accepted: what the last build measured is "
                                       "lost, or a case did not finish\n"));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=0e-3 "));
    EXPECT_FALSE(fs::exists(state + "/accepted.csv"));
    EXPECT_EQ(night(1, true).exitCode, 4) << "nor does --fix";
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=0e-3 "));
    fs::remove_all(state + "/landed");
    fs::copy(bundle(1), state + "/landed");  // as where the landed one crashes since then
    endedWith(4, night(2));
    isCrashing = false;
    endedWith(0, night(3));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=3e-3 "));
}

TEST_F(Nightly, OneNightAtATimeAndAKilledOneLosesNothing) {
    ASSERT_EQ(night(0).exitCode, 0);
    fs::rename(state + "/landed", state + "/landed.old");  // as if it was killed while it landed
    fs::create_directories(state + "/landed.new");
    BackgroundProgram other({"/usr/bin/flock", "-F", state + "/lock", "/bin/sleep", "60"});
    while (runProgram({"/usr/bin/flock", "-n", state + "/lock", "/bin/true"}).exitCode == 0) {
    }
    EXPECT_EQ(endedWith(2, night(1)).err, "nightly: another night is under way in " + state + "\n");
    other.signal(SIGKILL);
    other.wait();
    EXPECT_EQ(night(1).exitCode, 0);
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=1e-3 "));
    EXPECT_FALSE(fs::exists(state + "/landed.old") || fs::exists(state + "/landed.new"));
}

TEST_F(Nightly, WhatGotSlowerLittleByLittleIsFoundEachWeekAndInTheHistory) {
    ASSERT_EQ(night(0).exitCode, 0);
    // As if many nights had landed under the floor.
    fs::remove_all(state + "/landed");
    fs::copy(bundle(15000), state + "/landed", fs::copy_options::recursive);
    letAWeekPass();
    isTimed = true;
    const ProcessResult week = night(15000);
    EXPECT_EQ(week.exitCode, 1) << week.out << week.err;
    EXPECT_THAT(week.out, HasSubstr("nightly: with the fixed build\nalarm; measuring again\n"));
    EXPECT_THAT(landed(), HasSubstr("EXTRA_MS=15000e-3 "));
    // Thirteen nights at a third of the time, and thirteen as tonight's, without an overlap.
    const std::string history = readFile(state + "/history.csv");
    const std::size_t begin = history.find("_time_ms,ms,") + 12;
    ASSERT_LT(begin, history.size());
    const std::size_t row = history.rfind('\n', begin) + 1;
    const double value = std::stod(history.substr(begin));
    std::string rows = history.substr(0, history.find('\n') + 1);
    for (int i = 0; i < 26; ++i) {
        const double own = (i < 13 ? 0.33 : 1.0) * value * (1.0 + 0.001 * i);
        rows += history.substr(row, begin - row) + std::to_string(own) + '\n';
    }
    writeFileAtomic(state + "/history.csv", rows);
    const ProcessResult step = endedWith(1, night(15000));
    EXPECT_THAT(step.out, HasSubstr("since night 14 of 27"));
}

TEST_F(Nightly, SaysWhatIsMissing) {
    const auto refusal = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"/usr/bin/env", "GFXREPRO_NIGHTLY=" + state,
                                             GFXREPRO_SOURCE "/scripts/nightly"});
        const ProcessResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 2) << "1 would be an alarm";
        return result.err;
    };
    EXPECT_EQ(refusal({"--rounds"}), "nightly: --rounds needs a value\n");
    EXPECT_EQ(refusal({"--accept"}), "nightly: --accept needs a value\n");
    EXPECT_EQ(refusal({"--program", "/nonexistent"}), "nightly: /nonexistent is no folder\n");
    EXPECT_EQ(refusal({"--fxi"}), "nightly: unknown option '--fxi'\n");
    EXPECT_EQ(refusal({"--renderer", "/nonexistent", "mine.yaml"}),
              "nightly: /nonexistent is no folder\n");
    EXPECT_EQ(refusal({"--renderer", folder.path()}),
              "nightly: --renderer needs CONFIG…, which say how it is called\n");
    EXPECT_EQ(refusal({"--renderer", folder.path(), "mine.yaml"}),
              "nightly: " + folder.path().string() +
                  " is copied into the nights' folder, and has it: " + state +
                  " (GFXREPRO_NIGHTLY names another)\n");
    EXPECT_FALSE(fs::exists(state));
}

TEST(NightlyConfigs, EveryTechniqueIsWatched) {
    // What external measures is not this project's to watch.
    const std::set<std::string> others = {"external", "kit", "reflections", "template"};
    const fs::path source = GFXREPRO_SOURCE;
    for (const fs::directory_entry& entry : fs::directory_iterator(source / "techniques")) {
        const std::string name = entry.path().filename();
        if (!entry.is_directory() || others.contains(name)) continue;
        EXPECT_TRUE(fs::exists(source / "configs/nightly" / (name + ".yaml"))) << name;
    }
}

}  // namespace
}  // namespace gfxrepro::test
