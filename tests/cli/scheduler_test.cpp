// The scheduler in this process, with the mock's workers: what a runner that is held up, or whose
// files take no more, makes of its cases.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <functional>
#include <thread>

#include "runner/run/scheduler.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using testing::HasSubstr;

/// Does something as soon as a unit has begun.
class AtBegin : public run::Observer {
  public:
    explicit AtBegin(std::function<void()> act) : act_(std::move(act)) {}
    void unitBegan(const run::Unit&) override { act_(); }
    void unitEnded(const run::Unit&, records::Status, const std::string&) override {}
    void tick(std::string_view) override {}

  private:
    std::function<void()> act_;
};

class SchedulerTest : public ::testing::Test {
  protected:
    /// Measures what a run of the config has planned into another folder.
    run::RunOutcome measure(const std::string& config, const std::function<void()>& atBegin,
                            std::size_t mostRecords = records::kMostRecords) {
        const std::string planned = folder.path() / "planned";
        EXPECT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", planned}).exitCode,
                  0);
        const run::Plan plan = run::Plan::fromJsonFile(planned + "/plan.json");
        const run::RunDirectory directory = run::RunDirectory::create(dir);
        run::SchedulerOptions options{.device = "software", .assetsFolder = folder.path()};
        options.program = GFXREPRO_MOCK_PROGRAM;
        options.mostRecords = mostRecords;
        run::PhaseClock phases;
        run::Rounds rounds(plan, {}, {});
        AtBegin observer(atBegin);
        return run::runUnits(run::unitsOf(plan), rounds, directory, options, phases, observer);
    }

    TemporaryFolder folder;
    std::string dir = folder.path() / "run";
};

TEST_F(SchedulerTest, StopsBeforeItsRecordsAreMoreThanAreRead) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2, 3, 4]}\n");
    ASSERT_EQ(
        mockGfxrepro({"run", config, "--device", "software", "--out", dir + "-whole"}).exitCode, 0);
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

}  // namespace
}  // namespace gfxrepro::test
