// What a run that nobody watches meets: no reader of its progress, a driver that does not answer, a
// case that takes the runner with it, a device that is gone, a suspended machine.
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

std::string mockRun(const std::string& config, const std::string& dir) {
    return GFXREPRO_MOCK_PROGRAM " run " + config + " --device software --out " + dir;
}

std::string readShared(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Waits until as many units have begun in all.
void waitForStarts(const std::string& dir, std::size_t count) {
    const std::string start = "\"event\":\"start\"";
    for (int i = 0; i < 400; ++i) {
        const std::string log = readShared(dir + "/journal.jsonl");
        std::size_t found = 0;
        for (std::size_t at = log.find(start); at != std::string::npos;
             at = log.find(start, at + 1)) {
            ++found;
        }
        if (found >= count) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    FAIL() << "no unit has begun";
}

using Weekend = test::RunTest;

TEST_F(Weekend, NobodyReadsTheProgress) {
    const std::string config =
        writeMockConfig(folder, "params: {pause_ms: 300}\nsweep: {number: [1, 2, 3]}\n");
    EXPECT_EQ(shell(mockRun(config, dir + "1") + " 2>/dev/full").exitCode, 0);
    EXPECT_EQ(shell(mockRun(config, dir + "2") + " 0<&- 2>&-").exitCode, 0);
    EXPECT_EQ(shell("(" + mockRun(config, dir + "3") + " 2>&1; echo $? >" + dir +
                    "-code) | head -c 1 >/dev/null; cat " + dir + "-code")
                  .out,
              "2\n")
        << "its last words, on standard output, had no reader";
    for (const char* run : {"1", "2", "3"}) EXPECT_EQ(rowsOf(dir + run, "number").size(), 3U);
    EXPECT_EQ(shell(GFXREPRO_MOCK_PROGRAM " check nothere.yaml 2>/dev/full").exitCode, 2);
    const ProcessResult full = endedWith(2, shell(GFXREPRO_MOCK_PROGRAM " list scenes >/dev/full"));
    EXPECT_THAT(full.err, HasSubstr("No space left on device"));
    for (const char* question : {" --version", " --help", " run --help"}) {
        EXPECT_EQ(shell(GFXREPRO_MOCK_PROGRAM + std::string(question) + " >/dev/full").exitCode, 2)
            << question;
    }
}

TEST_F(Weekend, ADriverThatDoesNotAnswer) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const auto started = [&](const std::string& limit) {
        return runProgram({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out",
                           folder.path() / "run"},
                          {"GFXREPRO_MOCK_DRIVER_HANGS=1", "GFXREPRO_START_LIMIT_S=" + limit});
    };
    EXPECT_EQ(endedWith(3, started("1")).err,
              "gfxrepro: the driver did not open a device within 1 s\n");
    EXPECT_EQ(started("soon").err,
              "gfxrepro: GFXREPRO_START_LIMIT_S: expected a number of seconds, found 'soon'\n");
}

TEST_F(Weekend, DoctorAndScenesWaitForNoDriverEither) {
    const std::string pipe = folder.path() / "vendor.json";  // which the loader of drivers reads
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const std::string picture = folder.path() / "picture.png";
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"doctor"}, {"scene", "shapes/torus", "--render", picture}}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.begin(), GFXREPRO_MOCK_PROGRAM);
        const ProcessResult result = runProgram(
            arguments, {"__EGL_VENDOR_LIBRARY_FILENAMES=" + pipe, "GFXREPRO_START_LIMIT_S=1"});
        EXPECT_EQ(result.exitCode, 3) << command[0];
        EXPECT_EQ(result.err, "gfxrepro: a driver did not answer in time\n") << command[0];
    }
}

TEST_F(Weekend, AFolderThatIsGoneOrAnothersEndsTheRun) {
    const std::string config =
        writeMockConfig(folder, "params: {pause_ms: 300}\nsweep: {number: [1, 2, 3, 4]}\n");
    const auto ended = [&](const std::string& into, const std::function<void()>& disturb) {
        BackgroundProgram run({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software",
                               "--jobs", "1", "--out", into});
        waitForStarts(into, 1);
        disturb();
        EXPECT_THAT(endedWith(2, run.wait()).err,
                    HasSubstr("gfxrepro: " + into + ": was removed or moved, or its lock"));
    };
    const std::string moved = folder.path() / "moved", locked = folder.path() / "locked";
    ended(moved, [&] { fs::rename(moved, moved + "-away"); });
    ended(locked, [&] { fs::remove(locked + "/lock"); });
    EXPECT_FALSE(fs::exists(moved)) << "nothing is written where it was";
    EXPECT_TRUE(rowsOf(locked, "number").empty()) << "another run may have measured it";
    endedWith(0, mockGfxrepro({"run", "--resume", locked}));
    EXPECT_EQ(rowsOf(locked, "number").size(), 4U);
}

/// While the first unit runs, and while the last does.
TEST_F(Weekend, RecordsAndListsOfImagesThatAreGoneAreNoticed) {
    const std::string config =
        writeMockConfig(folder, "params: {pause_ms: 600}\nsweep: {number: [1, 2]}\n");
    const auto replaced = [](const std::string& file) { writeFileAtomic(file, readShared(file)); };
    const auto removed = [](const std::string& file) { fs::remove(file); };
    const auto emptied = [](const std::string& file) { fs::resize_file(file, 0); };
    const auto made = [](const std::string& file) { writeFileAtomic(file, ""); };
    using Disturbance = std::function<void(const std::string&)>;
    const auto isNoticed = [&](std::size_t start, const char* file, const Disturbance& disturb) {
        const TemporaryFolder own;
        const std::string into = own.path() / "run";
        BackgroundProgram run({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software",
                               "--jobs", "1", "--out", into});
        waitForStarts(into, start);
        disturb(into + file);
        const ProcessResult result = run.wait();
        EXPECT_EQ(result.exitCode, 2) << file << start << result.out;
        EXPECT_EQ(result.out, "");
        EXPECT_THAT(result.err, HasSubstr("gfxrepro: " + into + file + ": was "));
        EXPECT_EQ(mockGfxrepro({"run", "--resume", into}).exitCode, 0);
        EXPECT_EQ(rowsOf(into, "number").size(), 2U);
    };
    for (const Disturbance& disturb :
         {Disturbance(replaced), Disturbance(removed), Disturbance(emptied)}) {
        for (const std::size_t start : {1U, 2U}) isNoticed(start, "/records.csv", disturb);
        isNoticed(2, "/images/index.csv", disturb);
    }
    isNoticed(1, "/images/index.csv", made);  // there is no list before the first picture
}

TEST_F(Weekend, WhatTheRunnerDidNotSurviveTwiceIsNotTriedAgain) {
    const std::string config = writeMockConfig(
        folder, "sweep: {behaviour: [hang, ok]}\nmeasure: {lane: quality, time_limit_s: 60}\n");
    const auto killedIn = [&](std::size_t start, std::vector<std::string> command) {
        command.insert(command.end(), {"--jobs", "1"});
        BackgroundProgram run(command);
        waitForStarts(dir, start);
        run.signal(SIGKILL);
        run.wait();
    };
    killedIn(1, {GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir});
    killedIn(2, {GFXREPRO_MOCK_PROGRAM, "run", "--resume", dir});
    for (int i = 0; i < 2; ++i) {
        endedWith(4, mockGfxrepro({"run", "--resume", dir}));
        EXPECT_THAT(statusLines(dir), Contains("hang: crash (the runner did not survive it, 2 "
                                               "times; resume with --retry to try it again)"));
        EXPECT_EQ(rowsOf(dir, "number").size(), 1U);
    }
    BackgroundProgram again({GFXREPRO_MOCK_PROGRAM, "run", "--resume", dir, "--retry"});
    waitForStarts(dir, 4);  // the other case was the third
    again.signal(SIGINT);
    EXPECT_EQ(again.wait().exitCode, 130);
}

/// A batch system's limit and a closed terminal, thrice in one case: none is a death of the runner.
TEST_F(Weekend, AnInterruptionIsNoCrash) {
    const std::string config = writeMockConfig(folder, "params: {pause_ms: 2000}\n");
    std::vector<std::string> command = {
        GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir};
    std::size_t starts = 0;
    for (const int signal : {SIGTERM, SIGHUP, SIGHUP}) {
        BackgroundProgram run(command);
        waitForStarts(dir, ++starts);
        run.signal(signal);
        EXPECT_EQ(run.wait().exitCode, 130) << signal;
        command = {GFXREPRO_MOCK_PROGRAM, "run", "--resume", dir};
    }
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).exitCode, 0);
    EXPECT_EQ(
        shell("trap '' HUP; " + mockRun(config, dir + "2") + " & sleep 1; kill -HUP $!; wait $!")
            .exitCode,
        0)
        << "where hang-ups are ignored, as under nohup";
}

/// Kills a run of these configs twice during its first unit.
void killTwice(const std::vector<std::string>& configs, const std::string& dir) {
    for (const std::size_t start : {1U, 2U}) {
        std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "run", "--jobs", "1"};
        if (start == 1) {
            command.insert(command.end(), configs.begin(), configs.end());
            command.insert(command.end(), {"--device", "software", "--out", dir});
        } else {
            command.insert(command.end(), {"--resume", dir});
        }
        BackgroundProgram run(command);
        waitForStarts(dir, start);
        run.signal(SIGKILL);
        run.wait();
    }
}

constexpr const char* kHangs =
    "sweep: {behaviour: [hang, ok]}\nmeasure: {lane: quality, time_limit_s: 20}\n";

TEST_F(Weekend, WhatTookTheMachineDownInOneProcessIsNotTriedInTheOthers) {
    const std::string config = writeMockConfig(folder,
                                               "sweep: {behaviour: [hang, ok]}\nmeasure: {lane: "
                                               "quality, time_limit_s: 20, processes: 3}\n");
    killTwice({config}, dir);
    EXPECT_THAT(endedWith(4, mockGfxrepro({"run", "--resume", dir, "--jobs", "1"})).out,
                HasSubstr("3 of 6 finished, 3 failed; "));
    for (const records::Record& row : records::readRecords(dir + "/records.csv")) {
        if (row.status == records::Status::Ok) continue;
        EXPECT_EQ(row.status, records::Status::Crash) << "process " << row.process;
    }
    const std::string log = readFile(dir + "/journal.jsonl");
    EXPECT_THAT(log, Not(HasSubstr("\"process\":2,\"status\":\"timeout\"")));
}

TEST_F(Weekend, ATwinOfWhatTookTheMachineDownIsNotTriedEither) {
    std::vector<std::string> configs;
    for (const char* table : {"1", "2"}) {
        configs.push_back(folder.write(std::string("table-") + table + ".yaml",
                                       std::string("table: demo2026/") + table +
                                           "\ntitle: T\ntechnique: mock\n"
                                           "output: {width: 8, height: 8}\n" +
                                           kHangs));
    }
    killTwice(configs, dir);
    endedWith(4, mockGfxrepro({"run", "--resume", dir, "--jobs", "1"}));
    const std::string end = ", 2 times; resume with --retry to try it again)";
    EXPECT_THAT(
        statusLines(dir),
        UnorderedElementsAre(
            "hang: crash (the runner did not survive it" + end,
            "hang: crash (the runner did not survive its twin demo2026/1 behaviour=hang" + end,
            "ok: ok", "ok: ok"));
}

TEST_F(Weekend, StopsWhereTheMachineIsNotToBeTrusted) {
    const std::string config = writeMockConfig(
        folder, "params: {behaviour: device_lost}\nsweep: {number: [1, 2, 3, 4]}\n");
    const ProcessResult lost =
        endedWith(4, mockGfxrepro({"run", config, "--jobs", "1", "--out", dir}));
    EXPECT_THAT(lost.err, HasSubstr("stopped: the device was lost in two cases in a row; continue "
                                    "with: gfxrepro run --resume " +
                                    dir));
    EXPECT_THAT(lost.out, HasSubstr("0 of 2 finished, 2 failed"));
    const std::string failing =
        writeMockConfig(folder, "params: {behaviour: throw}\nsweep: {number: [1, 2, 3, 4, 5]}\n");
    const ProcessResult stopped = endedWith(
        4,
        mockGfxrepro({"run", failing, "--jobs", "1", "--max-failures", "3", "--out", dir + "2"}));
    EXPECT_THAT(stopped.err, HasSubstr("stopped: 3 failed; "));
    EXPECT_THAT(stopped.out, HasSubstr("0 of 3 finished, 3 failed"));
}

TEST_F(Weekend, WhatAStopRuleCutShortWasSurvived) {
    const std::string config =
        writeMockConfig(folder, "params: {pause_ms: 1000}\nsweep: {behaviour: [throw, hang]}\n");
    const auto stopped = [&](std::vector<std::string> command) {
        command.insert(command.end(), {"--jobs", "2", "--max-failures", "1"});
        EXPECT_THAT(mockGfxrepro(command).err, HasSubstr("stopped: 1 failed; "));
    };
    stopped({"run", config, "--device", "software", "--out", dir});
    stopped({"run", "--resume", dir});
    waitForStarts(dir, 4);
    stopped({"run", "--resume", dir});
    EXPECT_THAT(statusLines(dir), ElementsAre("throw: error (nothing works)"));
}

/// Runs a case of a second, with a limit of two, whose first worker `suspend` holds up for longer.
void expectNoTimeout(const std::function<void(BackgroundProgram&, pid_t)>& suspend) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(
        folder, "params: {pause_ms: 1000}\nmeasure: {lane: quality, time_limit_s: 2}\n");
    const std::string dir = folder.path() / "run";
    BackgroundProgram run(
        {GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir});
    waitForStarts(dir, 1);
    const std::vector<pid_t> workers = backgroundWorkers();
    ASSERT_EQ(workers.size(), 1U);
    suspend(run, workers.front());
    EXPECT_EQ(run.wait().exitCode, 0);
    EXPECT_THAT(readFile(dir + "/journal.jsonl"), Not(HasSubstr("retry")));
    EXPECT_EQ(rowsOf(dir, "number").front().status, records::Status::Ok);
}

TEST_F(Weekend, ASuspendedRunMakesNoTimeouts) {
    expectNoTimeout([](BackgroundProgram& run, pid_t worker) {
        for (const int number : {SIGSTOP, SIGCONT}) {
            run.signal(number);
            ::kill(worker, number);
            if (number == SIGSTOP) std::this_thread::sleep_for(std::chrono::seconds(3));
        }
    });
}

TEST_F(Weekend, ASuspendedWorkerMakesNoTimeoutsEither) {
    expectNoTimeout([](BackgroundProgram&, pid_t worker) {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        ::kill(worker, SIGSTOP);
        std::this_thread::sleep_for(std::chrono::seconds(4));
        ::kill(worker, SIGCONT);
    });
}

TEST_F(Weekend, AWorkerThatReadsNothingHoldsNobodyUp) {
    const std::string config =
        writeMockConfig(folder, "params: {pause_ms: 1000, marker: " + std::string(600'000, 'x') +
                                    "}\nsweep: {number: [1, 2]}\n");
    BackgroundProgram run({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--jobs",
                           "1", "--out", dir});
    waitForStarts(dir, 1);
    run.signal(SIGSTOP);  // until the worker waits for a case, the first or the next
    std::this_thread::sleep_for(std::chrono::seconds(3));
    const std::vector<pid_t> workers = backgroundWorkers();
    ASSERT_EQ(workers.size(), 1U);
    ::kill(workers.front(), SIGSTOP);
    run.signal(SIGCONT);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const auto begin = std::chrono::steady_clock::now();
    run.signal(SIGINT);
    std::thread release([pid = workers.front()] {  // a runner that waits for it does so no longer
        std::this_thread::sleep_for(std::chrono::seconds(10));
        ::kill(pid, SIGCONT);
    });
    EXPECT_EQ(run.wait().exitCode, 130);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
    release.join();
}

TEST_F(Weekend, OtherFilesAmongTheRunsStopNoRun) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const fs::path runs = folder.path() / "runs";
    for (const char* name : {"folder", "pipe", "loop", "number"}) {
        folder.write(std::string("runs/") + name + "/plan.json", "{}");
    }
    fs::create_directory(runs / "folder/manifest.json");
    ASSERT_EQ(::mkfifo((runs / "pipe/manifest.json").c_str(), 0600), 0);
    fs::create_symlink("manifest.json", runs / "loop/manifest.json");
    folder.write("runs/number/manifest.json", "{\"device_class\": 5}");
    const std::string inside = "cd " + folder.path().string() + " && ";
    endedWith(0, shell(inside + mockRun(config, "mine")));
    endedWith(0, shell(inside + GFXREPRO_MOCK_PROGRAM " plan --device software " + config));
}

TEST_F(Weekend, WhatFailedGoesLastWhereFailuresStopTheRun) {
    const std::string config =
        writeMockConfig(folder, "sweep: {behaviour: [throw, bad_alloc, ok]}\n");
    const auto stopped = [&](std::vector<std::string> command) {
        command.insert(command.end(), {"--jobs", "1", "--max-failures", "2"});
        EXPECT_THAT(endedWith(4, mockGfxrepro(command)).err, HasSubstr("stopped: 2 failed; "));
    };
    stopped({"run", config, "--device", "software", "--out", dir});
    EXPECT_EQ(rowsOf(dir, "number").size(), 0U);
    stopped({"run", "--resume", dir});
    EXPECT_EQ(rowsOf(dir, "number").size(), 1U);
    EXPECT_EQ(statusLines(dir).size(), 3U);
}

TEST_F(Weekend, WhatKilledProcessesWereWritingIsSweptAtResume) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    ASSERT_EQ(shell(mockRun(config, dir)).exitCode, 0);
    const std::vector<std::string> left = {"run/images/sweep-mock/a.exr.tmp4711",
                                           "run/manifest.json.tmp12", "run/records.csv.tmp"};
    for (const std::string& file : left) folder.write(file, "torn");
    folder.write("run/images/notes.tmpl", "kept");
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).exitCode, 0);
    for (const std::string& file : left) EXPECT_FALSE(fs::exists(folder.path() / file)) << file;
    EXPECT_TRUE(fs::exists(dir + "/images/notes.tmpl"));
}

/// A run killed before it had a plan is not resumed, but begun again.
TEST_F(Weekend, WhatARunWithoutAPlanWasWritingIsSweptWhereItBeginsAgain) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const auto isKept = [&](const std::string& name) {
        folder.write(name + "/manifest.json.tmp12", "torn");
        endedWith(0, shell(mockRun(config, folder.path() / name)));
        return fs::exists(folder.path() / name / "manifest.json.tmp12");
    };
    folder.write("killed/lock", "");
    EXPECT_FALSE(isKept("killed"));
    EXPECT_TRUE(isKept("somebodys")) << "no run ever began in it";
}

TEST_F(Weekend, FilesOfOthersAreNotWrittenOver) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const std::string work = folder.path() / "work";
    folder.write("work/claims.csv", "my own\n");
    EXPECT_THAT(endedWith(2, shell(mockRun(config, work))).err,
                EndsWith("gfxrepro: " + work +
                         ": has a claims.csv that is of no run and would be written over; give "
                         "another folder\n"));
    EXPECT_EQ(readFile(work + "/claims.csv"), "my own\n");
    EXPECT_FALSE(fs::exists(work + "/lock"));
}

TEST_F(Weekend, TooFewDescriptorsAreSaid) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const ProcessResult result =
        shell("ulimit -n 12; exec " + mockRun(config, folder.path() / "run"));
    EXPECT_THAT(result.err, HasSubstr("cannot start: too few file descriptors (ulimit -n)"));
}

}  // namespace
}  // namespace gfxrepro::test
