// What is read of the machine in a folder that stands for /, and what is said of it.
#include "runner/run/machine_state.h"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using run::Json;
using run::MachineReading;
using run::MachineState;

/// A machine of two processors, as its kernel tells of it; seconds since it began to count.
class Machine {
  public:
    double busyS = 100.0, idleS = 900.0, stolenS = 0.0, ownS = 10.0, workerS = 2.0;

    const fs::path& root() const { return folder_.path(); }
    void write(const std::string& file, const std::string& text) const {
        folder_.write(file, text);
    }

    /// Writes what changes, and reads all.
    MachineReading read() const {
        const double ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
        const auto ticksOf = [&](double timeS) { return fmt::format("{:.0f}", timeS * ticks); };
        const std::string line =
            fmt::format("{} 0 0 {} 0 0 0 {} 0 0", ticksOf(busyS), ticksOf(idleS), ticksOf(stolenS));
        write("proc/stat", fmt::format("cpu  {0}\ncpu0 {0}\ncpu1 {0}\nintr 5 1 2\n", line));
        // The name may hold anything; its own time and that of the children that ended.
        write("proc/self/stat", fmt::format("7 (a) b (c) R 1 1 1 0 -1 4194304 0 0 0 0 {} 0 {} 0 20",
                                            ticksOf(0.5 * ownS), ticksOf(0.5 * ownS)));
        write("proc/self/task/7/children", "8 ");
        write("proc/8/stat",
              fmt::format("8 (worker) S 7 1 1 0 -1 4194304 0 0 0 0 0 {} 0 0 20", ticksOf(workerS)));
        return run::readMachine(root());
    }

  private:
    TemporaryFolder folder_;
};

MachineState stateOf(const MachineReading& before, const MachineReading& after) {
    MachineState state;
    state.add(before, after);
    return state;
}

TEST(MachineState, KnowsNothingWhereNothingIsTold) {
    const TemporaryFolder folder;
    const MachineReading reading = run::readMachine(folder.path());
    const MachineState state = stateOf(reading, reading);
    EXPECT_FALSE(state.isKnown());
    EXPECT_EQ(state.json(), Json::object());
    EXPECT_THAT(state.problems(), IsEmpty());
    EXPECT_EQ(state.sentence(), "");
}

/// What is said of two processors while these seconds were spent.
struct Spent {
    double busyS = 0.0, idleS = 0.0, stolenS = 0.0, ownS = 0.0, workerS = 0.0;

    MachineState state() const {
        Machine machine;
        const MachineReading before = machine.read();
        machine.busyS += busyS;
        machine.idleS += idleS;
        machine.stolenS += stolenS;
        machine.ownS += ownS;
        machine.workerS += workerS;
        return stateOf(before, machine.read());
    }
};

TEST(MachineState, SaysWhatTheWorkOfOthersAndTheHostTook) {
    const std::string quiet = "Nothing disturbed the machine while this was timed: ";
    // Our own work is not that of others.
    const MachineState own = Spent{.busyS = 20.0, .ownS = 4.0, .workerS = 15.9}.state();
    EXPECT_THAT(own.problems(), IsEmpty());
    EXPECT_EQ(own.sentence(), quiet + "other processes took 0.5 % of 2 processors, the host 0 %.");
    const Spent remainder{.busyS = 3.0, .idleS = 17.0, .workerS = 2.9999};
    EXPECT_EQ(remainder.state().sentence(),
              quiet + "other processes took 0 % of 2 processors, the host 0 %.");
    const MachineState loaded = Spent{.busyS = 15.6, .idleS = 4.4, .workerS = 8.0}.state();
    EXPECT_THAT(loaded.problems(), ElementsAre("other processes took 38 % of 2 processors"));
    EXPECT_EQ(loaded.sentence(),
              "The machine was disturbed while this was timed: other processes took 38 % of 2 "
              "processors.");
    const Spent stolen{.busyS = 10.0, .idleS = 9.4, .stolenS = 0.6, .workerS = 10.0};
    EXPECT_THAT(stolen.state().problems(),
                ElementsAre("the host took 3 % of the processors' time"));
    // What any system does of itself, and what is less than the kernel's ticks tell.
    const Spent little{.busyS = 0.9, .idleS = 18.95, .stolenS = 0.15};
    EXPECT_THAT(little.state().problems(), IsEmpty());
    EXPECT_THAT(Spent{.busyS = 0.1}.state().problems(), IsEmpty());
    EXPECT_EQ(Spent{.busyS = 0.1}.state().sentence(), "") << "nor called quiet";
}

TEST(MachineState, IsThrottledForHeatOrByALimit) {
    const Machine machine;
    const std::string core = "sys/devices/system/cpu/cpu{}/thermal_throttle/";
    const auto throttle = [&](int first, int second, int package) {
        for (const int cpu : {0, 1}) {
            const std::string folder = fmt::format(fmt::runtime(core), cpu);
            machine.write(folder + "core_throttle_count",
                          std::to_string(cpu == 0 ? first : second) + "\n");
            machine.write(folder + "package_throttle_count", std::to_string(package) + "\n");
        }
    };
    // What is no processor's folder counts nothing.
    machine.write("sys/devices/system/cpu/cpufreq/thermal_throttle/core_throttle_count", "99\n");
    machine.write("proc/self/cgroup", "0::/job\n");
    machine.write("sys/fs/cgroup/job/cpu.stat", "nr_throttled 3\nthrottled_usec 1000000\n");
    throttle(5, 7, 2);
    const MachineReading before = machine.read();
    EXPECT_THAT(stateOf(before, machine.read()).problems(), IsEmpty());
    throttle(6, 7, 4);
    EXPECT_THAT(stateOf(before, machine.read()).problems(),
                ElementsAre("cores were throttled for heat 3 times"));
    throttle(5, 7, 2);
    machine.write("sys/fs/cgroup/job/cpu.stat", "nr_throttled 9\nthrottled_usec 3500000\n");
    EXPECT_THAT(stateOf(before, machine.read()).problems(),
                ElementsAre("the CPU limit of its control group held it for 2.5 s"));
}

TEST(MachineState, IsHotFromItsFirstTripPointOn) {
    const Machine machine;
    const std::string zone = "sys/class/thermal/thermal_zone0/";
    machine.write(zone + "temp", "84000\n");
    machine.write(zone + "trip_point_0_type", "critical\n");
    machine.write(zone + "trip_point_0_temp", "100000\n");
    machine.write(zone + "trip_point_1_type", "passive\n");
    machine.write(zone + "trip_point_1_temp", "85000\n");
    machine.write(zone + "trip_point_2_type", "passive\n");
    machine.write(zone + "trip_point_2_temp", "0\n");  // none
    machine.write("sys/class/thermal/thermal_zone1/temp", "40000\n");
    const MachineReading before = machine.read();
    EXPECT_THAT(stateOf(before, before).problems(), IsEmpty());
    machine.write(zone + "temp", "86000\n");
    const MachineReading after = machine.read();
    EXPECT_THAT(stateOf(before, after).problems(),
                ElementsAre("it was hot, 86 °C of 85 °C at which it is slowed"));
    // Before, too: it cooled down while it was timed.
    EXPECT_THAT(stateOf(after, before).problems(), testing::SizeIs(1));
}

TEST(MachineState, IsTheSameReadFromWhatItWrote) {
    Machine machine;
    machine.write("sys/class/thermal/thermal_zone0/temp", "50000\n");
    const MachineReading before = machine.read();
    machine.busyS += 3.0;
    const Json json = stateOf(before, machine.read()).json();
    EXPECT_EQ(json, (Json{{"processors", 2},
                          {"processor_s", 3.0},
                          {"busy_s", 3.0},
                          {"own_s", 0.0},
                          {"stolen_s", 0.0},
                          {"hottest_c", 50.0},
                          {"hot_from_c", 95.0}}));
    EXPECT_EQ(MachineState::fromJson(json).json(), json);
}

/// Told of units as a scheduler does.
struct Told : run::Observer {
    int began = 0, ended = 0;
    void unitBegan(const run::Unit&) override { ++began; }
    void unitEnded(const run::Unit&, records::Status, const std::string&) override { ++ended; }
    void tick(std::string_view) override {}
};

/// A watch in a run folder of its own, over a machine and perhaps a GPU.
struct MachineWatch : testing::Test {
    TemporaryFolder runs_;
    run::RunDirectory directory = run::RunDirectory::create(runs_.path() / "run");
    Machine machine;
    Told told;
    std::optional<gl::GpuReading> gpu;
    run::MachineWatch watch{told, directory, {}, machine.root(), [&] { return gpu; }};

    void setClock(double clockHz) { gpu.emplace().clockHz = clockHz; }
    tables::MovedClocks moved() const {
        return run::movedClocks({{"machine_states", watch.states()}});
    }
};

TEST_F(MachineWatch, AddsUpWhatItSeesOfEachTimedTable) {
    using Lane = config::Measure::Lane;
    machine.read();
    const auto run = [&](const config::Case& item, double othersS) {
        const run::Unit unit{&item, 0, {}};
        watch.unitBegan(unit);
        machine.busyS += 10.0 + othersS;
        machine.workerS += 10.0;
        machine.idleS += 10.0 - othersS;
        machine.read();
        watch.unitEnded(unit, records::Status::Ok, "");
    };
    const config::Case loaded = makeCase("t/1", "a", 1, Lane::Timing);
    const config::Case quiet = makeCase("t/2", "a", 1, Lane::Timing);
    const config::Case untimed = makeCase("t/3", "a", 1);
    run(loaded, 2.0);
    run(loaded, 6.0);
    run(quiet, 0.1);
    run(untimed, 9.0);
    EXPECT_EQ(told.began, 4);
    EXPECT_EQ(told.ended, 4);
    EXPECT_EQ(
        watch.warning(),
        "the machine was not quiet: while t/1 was timed other processes took 20 % of 2 processors");
    const Json manifest = {{"machine_states", watch.states()}};
    EXPECT_THAT(run::machineStateNote(manifest, "t/1"), HasSubstr("took 20 % of 2 processors"));
    EXPECT_THAT(run::machineStateNote(manifest, "t/2"),
                HasSubstr("Nothing disturbed the machine while this was timed: "));
    EXPECT_EQ(run::machineStateNote(manifest, "t/3"), "");
    EXPECT_EQ(run::machineStateNote(Json::object(), "t/1"), "");

    // A run that goes on knows what was before, but for times that are measured again.
    std::vector<Json> log = run::readJournal(directory.path() / "journal.jsonl");
    EXPECT_EQ(run::machineStatesIn(log).at("t/1").json(), watch.states().at("t/1"));
    log.push_back({{"event", "machine"}, {"table", "t/1"}});
    EXPECT_FALSE(run::machineStatesIn(log).contains("t/1"));
    EXPECT_TRUE(run::machineStatesIn(log).contains("t/2"));
}

/// Its clock rises while frames warm up and falls while a case loads: neither is in its times.
TEST_F(MachineWatch, TellsWhichCasesAreNotOfOneClock) {
    const auto see = [&](const char* phase, int clockMHz) {
        setClock(1e6 * clockMHz);
        watch.tick(phase);
    };
    const auto run = [&](const config::Case& item, int process, int first, int second) {
        const run::Unit unit{&item, process, {}};
        watch.unitBegan(unit);
        see("load", 345);
        see("warm-up", 510);
        see("render", first);
        see("render", second);
        see("", second);
        see("record", 345);
        watch.unitEnded(unit, records::Status::Ok, "");
    };
    using Lane = config::Measure::Lane;
    const config::Case steady = makeCase("t/1", "a", 1, Lane::Timing);
    const config::Case moving = makeCase("t/1", "b", 1, Lane::Timing);
    const config::Case apart = makeCase("t/1", "c", 1, Lane::Timing);
    run(steady, 0, 1980, 1950);
    run(moving, 0, 1980, 1410);
    run(apart, 0, 1980, 1980);
    run(apart, 1, 1695, 1695);
    const tables::MovedClocks expected = {{moving.id, {1.41e9, 1.98e9}},
                                          {apart.id, {1.695e9, 1.98e9}}};
    EXPECT_EQ(moved(), expected);
    // Of a run that goes on, too.
    const auto states = run::machineStatesIn(run::readJournal(directory.path() / "journal.jsonl"));
    const Json again = {{"machine_states", {{"t/1", states.at("t/1").json()}}}};
    EXPECT_EQ(run::movedClocks(again), expected);
    EXPECT_TRUE(run::movedClocks(Json::object()).empty());
}

/// A twin's times were taken on the machine as it was then.
TEST_F(MachineWatch, ATableThatTakesTimesTakesTheirState) {
    setClock(1.98e9);
    const config::Case item = makeCase("t/1", "a", 1, config::Measure::Lane::Timing);
    const config::Case twin = makeCase("t/2", "a", 1, config::Measure::Lane::Timing);
    const run::Unit unit{&item, 0, {}};
    watch.unitBegan(unit);
    watch.tick("render");
    setClock(1.41e9);
    watch.unitEnded(unit, records::Status::Ok, "");
    watch.unitEnded({&twin, 0, {}, {}, &item}, records::Status::Ok, "");
    const tables::MovedClocks expected = {{item.id, {1.41e9, 1.98e9}}, {twin.id, {1.41e9, 1.98e9}}};
    EXPECT_EQ(moved(), expected);
}

/// A frame that is drawn between two ticks: the clock behind it is its own.
TEST_F(MachineWatch, SeesTheClockOfShortFrames) {
    setClock(1.98e9);
    const config::Case item = makeCase("t/1", "a", 1, config::Measure::Lane::Timing);
    const run::Unit unit{&item, 0, {}};
    watch.unitBegan(unit);
    watch.tick("render");
    setClock(1.41e9);
    watch.unitEnded(unit, records::Status::Ok, "");
    EXPECT_EQ(moved().size(), 1U);
}

}  // namespace
}  // namespace gfxrepro::test
