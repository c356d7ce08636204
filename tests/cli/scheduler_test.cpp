// The scheduler in this process, with the mock's workers: what a runner that is held up, or whose
// files take no more, makes of its cases.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <span>
#include <thread>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/config/experiment.h"
#include "runner/run/scheduler.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// Does something as soon as a unit has begun.
struct AtBegin : run::Observer {
    explicit AtBegin(std::function<void()> act) : act_(std::move(act)) {}
    void unitBegan(const run::Unit&) override { act_(); }
    void unitEnded(const run::Unit&, records::Status, const std::string&) override {}
    void tick(std::string_view) override {}

  private:
    std::function<void()> act_;
};

struct SchedulerTest : RunTest {
    /// Measures what a run of the config has planned into another folder.
    run::RunOutcome measure(const std::string& config, const std::function<void()>& atBegin,
                            std::size_t mostRecords = records::kMostRecords) {
        unsetenv("GFXREPRO_MOCK_LOG");
        const std::string planned = folder.path() / "planned";
        std::vector<std::string> arguments = {"run", config, "--out", planned};
        arguments.insert(arguments.begin() + 2, furtherConfigs.begin(), furtherConfigs.end());
        EXPECT_EQ(mockGfxrepro(arguments).exitCode, 0);
        fs::remove(folder.path() / "marker");
        const run::Plan plan = run::Plan::fromJsonFile(planned + "/plan.json");
        const run::RunDirectory directory = run::RunDirectory::create(dir);
        if (arePaired) setenv("GFXREPRO_MOCK_LOG", (folder.path() / "log").c_str(), 1);
        run::SchedulerOptions options{.device = "software", .assetsFolder = folder.path()};
        options.program = GFXREPRO_MOCK_PROGRAM;
        options.mostRecords = mostRecords;
        if (arePaired) options.preparedInPairs = {"sweep/mock"};
        options.jobs = jobs;
        run::PhaseClock phases;
        run::Rounds rounds(plan, {}, {});
        AtBegin observer(atBegin);
        return run::runUnits(run::unitsOf(plan), rounds, directory, options, phases, observer);
    }

    /// Of the units in the order in which they were given out.
    std::vector<std::string> scenesStarted() const {
        const run::Plan plan =
            run::Plan::fromJsonFile((folder.path() / "planned/plan.json").string());
        std::vector<std::string> scenes;
        run::forEachEvent(fs::path(dir) / "journal.jsonl", [&](run::Json&& event) {
            if (event.value("event", "") != "start") return;
            for (const config::Case& item : plan.cases) {
                if (item.id == event.value("case", "")) scenes.push_back(item.recordedScene());
            }
        });
        return scenes;
    }

    std::vector<std::string> furtherConfigs;  // measured in the same run
    bool arePaired = false;
    int jobs = 1;
};

/// Two workers, each at a scene of its own.
TEST_F(SchedulerTest, ASceneOfATableGoesToOneWorker) {
    jobs = 2;
    const run::RunOutcome outcome =
        measure(writeMockConfig(folder,
                                "sweep: {scene: [shadows/object_on_plane, shadows/town_square], "
                                "number: [1, 2, 3]}\nparams: {pause_ms: 100}\n"),
                [] {});
    EXPECT_EQ(outcome.finished, 6);
    const std::vector<std::string> scenes = scenesStarted();
    ASSERT_EQ(scenes.size(), 6U);
    EXPECT_NE(scenes[0], scenes[1]) << "the second worker begins with another scene";
    // Of each two that follow one is of each scene, whichever worker was first.
    EXPECT_EQ(std::ranges::count(std::span(scenes).first(4), scenes[0]), 2);
}

TEST_F(SchedulerTest, ASceneOfSeveralTablesGoesToOneWorker) {
    jobs = 2;
    const auto lines = [](const char* scene) {
        return "scene: shadows/" + std::string(scene) +
               "\nsweep: {number: [1, 2, 3]}\nparams: {pause_ms: 100}\n";
    };
    const std::string second = readFile(writeMockConfig(folder, lines("town_square")));
    furtherConfigs = {folder.write("second.yaml", "sweep_of: second" + second.substr(14))};
    const run::RunOutcome outcome =
        measure(writeMockConfig(folder, lines("object_on_plane")), [] {});
    EXPECT_EQ(outcome.finished, 6);
    const std::vector<std::string> scenes = scenesStarted();
    ASSERT_EQ(scenes.size(), 6U);
    EXPECT_NE(scenes[0], scenes[1]) << "the second worker begins with the other table";
    EXPECT_EQ(std::ranges::count(std::span(scenes).first(4), scenes[0]), 2);
}

/// The mock writes down what it does, and sets up for a while.
struct PairedUnits : SchedulerTest {
    PairedUnits() {
        arePaired = true;
        setenv("GFXREPRO_MOCK_SETUP_MS", "300", 1);
    }
    ~PairedUnits() override {
        unsetenv("GFXREPRO_MOCK_SETUP_MS");
        unsetenv("GFXREPRO_MOCK_LOG");
    }

    run::RunOutcome measureLogged(const std::string& lines) {
        const std::string config = writeMockConfig(folder, lines);
        return measure(config, [this] { turns.push_back(ownChildren().size()); });
    }
    std::vector<std::string> logLines() const {
        return split(std::string(trimmed(readFile(folder.path() / "log"))), '\n');
    }

    std::vector<std::size_t> turns;  // workers when a unit came to its frames
};

TEST_F(SchedulerTest, StopsBeforeItsRecordsAreMoreThanAreRead) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2, 3, 4]}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir + "-whole"}).exitCode, 0);
    const std::size_t unitRows = records::readRecords(dir + "-whole/records.csv").size() / 4;
    const run::RunOutcome outcome = measure(
        config, [] {}, 2 * unitRows + 2);
    EXPECT_TRUE(outcome.isFull);
    EXPECT_THAT(outcome.stopReason, HasSubstr("Measure the rest in a run of its own"));
    EXPECT_EQ(outcome.finished, 2);
    EXPECT_EQ(records::readRecords(dir + "/records.csv").size(), 2 * unitRows);
}

/// The runner, and its worker with it, stand still while it is not asleep, as in a write.
TEST_F(SchedulerTest, TimeInWhichItLooksAtNothingCountsAgainstNoCase) {
    const std::string config = writeMockConfig(
        folder, "params: {pause_ms: 500}\nmeasure: {lane: quality, time_limit_s: 2}\n");
    const run::RunOutcome outcome = measure(config, [] {
        const std::vector<pid_t> workers = ownChildren();
        for (const pid_t worker : workers) ::kill(worker, SIGSTOP);
        std::this_thread::sleep_for(std::chrono::seconds(4));
        for (const pid_t worker : workers) ::kill(worker, SIGCONT);
    });
    EXPECT_EQ(outcome.finished, 1);
    EXPECT_EQ(outcome.flaky, 0);
}

TEST_F(PairedUnits, SetUpSideBySideAndDrawOneAfterTheOther) {
    for (const char* processes : {"1", "2"}) {  // workers that go on, and one for each unit
        fs::remove(folder.path() / "log");
        turns.clear();
        const run::RunOutcome outcome =
            measureLogged(std::string("sweep: {number: [1, 2]}\nparams: {pause_ms: 100}\n") +
                          "measure: {lane: timing, repeats: 1, processes: " + processes + "}\n");
        const int units = 2 * std::stoi(processes);
        EXPECT_EQ(outcome.finished, units);
        const std::vector<std::string> lines = logLines();
        ASSERT_EQ(lines.size(), 6U * static_cast<std::size_t>(units));
        for (std::size_t pair = 0; pair < lines.size(); pair += 12) {
            // The second round goes backwards.
            const std::string first = pair == 0 ? "1 " : "2 ", second = pair == 0 ? "2 " : "1 ";
            const auto at = lines.begin() + static_cast<std::ptrdiff_t>(pair);
            EXPECT_THAT(std::vector(at, at + 4),
                        UnorderedElementsAre("1 setup begins", "2 setup begins", "1 setup ends",
                                             "2 setup ends"));
            EXPECT_THAT(at[1], EndsWith("begins"));
            EXPECT_THAT(
                std::vector(at + 4, at + 12),  // each is drawn once before it is timed
                ElementsAre(first + "frame begins", first + "frame ends", first + "frame begins",
                            first + "frame ends", second + "frame begins", second + "frame ends",
                            second + "frame begins", second + "frame ends"));
        }
        fs::remove_all(folder.path() / "planned");
        fs::remove_all(dir);
    }
}

TEST_F(PairedUnits, AWaitIsNoPartOfALimit) {
    const run::RunOutcome outcome = measureLogged(
        "sweep: {number: [1, 2]}\nparams: {pause_ms: 1000}\n"
        "measure: {lane: timing, repeats: 1, processes: 1, time_limit_s: 3.5}\n");
    EXPECT_EQ(outcome.finished, 2);
    EXPECT_EQ(outcome.flaky, 0);
}

TEST_F(PairedUnits, WhenOneCrashesTheOtherGoesOnAndThenItIsTriedAlone) {
    const run::RunOutcome outcome = measureLogged(
        "sweep: {list: [[{behaviour: flake, number: 1}, {behaviour: ok, number: 2}]]}\n"
        "params: {marker: " +
        (folder.path() / "marker").string() +
        "}\nmeasure: {lane: timing, repeats: 1, processes: 1}\n");
    EXPECT_EQ(outcome.finished, 2);
    EXPECT_EQ(outcome.flaky, 1);
    EXPECT_THAT(turns, ElementsAre(2, 1, 1));
    const std::vector<std::string> lines = logLines();
    EXPECT_THAT(std::vector(lines.end() - 6, lines.end()),
                ElementsAre("1 setup begins", "1 setup ends", "1 frame begins", "1 frame ends",
                            "1 frame begins", "1 frame ends"));
}

TEST_F(SchedulerTest, TablesThatShowSetUpAreNotPreparedInPairs) {
    const technique::TechniqueInfo techniques[] = {
        {"t", "", nullptr, [] {
             return config::Outputs{{{"build_ms", "ms", "", config::Better::Lower, true,
                                      config::MetricInfo::Of::Either, true}},
                                    {{"draw", ""}, {"preprocess", "", true}}};
         }}};
    run::Plan plan;
    const auto add = [&](const std::string& id, const std::string& column) {
        const fs::path file = folder.write(
            id + ".yaml",
            "sweep_of: " + id + "\ntitle: T\ntechnique: t\nsweep: {n: [1, 2]}\n" +
                (column.empty() ? ""
                                : "layout:\n  rows: n\n  columns: {a: {metric: wall_time_ms}, b: " +
                                      column + "}\n"));
        plan.experiments.push_back(config::loadExperiment(file, {}, folder.path()));
    };
    add("frames", "{metric: gpu_time_ms, pass: draw}");
    add("own-metric", "{metric: build_ms}");
    add("load", "{metric: load_time_ms}");
    add("memory", "{metric: peak_memory_bytes}");
    add("pass", "{metric: cpu_time_ms, pass: preprocess}");
    add("equal", "{metric: wall_time_ms, equal: {metric: setup_time_ms, is: 5}}");
    add("all", "");
    EXPECT_THAT(run::preparedInPairs(plan, techniques), ElementsAre("sweep/frames"));
}

}  // namespace
}  // namespace gfxrepro::test
