// What a run writes into its log it can read again.
#include "runner/run/run_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

TEST(RunDirectory, ALockOfOneThatIsGoingIsWaitedFor) {
    const TemporaryFolder folder;
    const int going = ::open(folder.write("run/lock", "").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::flock(going, LOCK_EX), 0);
    const auto create = [&] { run::RunDirectory::create(folder.path() / "run"); };
    EXPECT_EQ(errorText(create, folder.path()), "DIR/run: another run is writing to this folder");
    std::thread end([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        ::close(going);
    });
    create();
    end.join();
}

TEST(RunDirectory, TextsOfTheLogAreCut) {
    const TemporaryFolder folder;
    const run::RunDirectory directory = run::RunDirectory::create(folder.path() / "run");
    const std::string most(32768, '\1'), more = "begin" + std::string(100'000, '\1') + "end";
    directory.note(
        {{"event", "case"}, {"title", more}, {"as", more}, {"message", more}, {"output", more}});
    directory.note({{"event", "case"}, {"message", most}, {"output", most}});
    const std::vector<run::Json> events = run::readJournal(folder.path() / "run/journal.jsonl");
    ASSERT_EQ(events.size(), 2U);
    const std::string message = events[0]["message"], output = events[0]["output"];
    EXPECT_THAT(message, StartsWith("begin\1"));
    EXPECT_THAT(message, EndsWith("\1[67240 bytes left out]"));
    EXPECT_THAT(output, StartsWith("[67240 bytes left out]\1"));
    EXPECT_THAT(output, EndsWith("\1end"));
    EXPECT_EQ(events[1]["message"], most);
    EXPECT_EQ(events[1]["output"], most);
}

TEST(RunDirectory, ATornLineOfTheLogSwallowsNoOther) {
    const TemporaryFolder folder;
    const fs::path log = folder.write("run/journal.jsonl", R"({"event": "case", "mess)");
    folder.write("run/plan.json", "{}");
    run::RunDirectory::open(folder.path() / "run").note({{"event", "begin"}});
    const std::vector<run::Json> events = run::readJournal(log);
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0]["event"], "begin");
    folder.write("run/journal.jsonl",
                 "{\"event\": 1\n{\"event\": \"end\", \"event\": \"begin\"}\n");
    EXPECT_EQ(errorText([&] { run::readJournal(log); }, folder.path()),
              "DIR/run/journal.jsonl:2: has \"event\" twice");
}

TEST(RunDirectory, AFullLogTakesNoFurtherUnit) {
    const TemporaryFolder folder;
    const run::RunDirectory directory = run::RunDirectory::create(folder.path() / "run", 100);
    directory.note({{"event", "begin"}});
    directory.requireRoom();
    directory.note({{"event", "case"}, {"message", "long enough"}});
    EXPECT_EQ(errorText([&] { directory.requireRoom(); }, folder.path()),
              "DIR/run/journal.jsonl: has 119 bytes; with 100 or more it takes no further case. "
              "Measure the rest in a run of its own (--only, --shard)");
    directory.note({{"event", "end"}});
    EXPECT_EQ(run::readJournal(folder.path() / "run/journal.jsonl").size(), 3U);
}

TEST(RunDirectory, OutputsAreLeftOutOfALargeLog) {
    const TemporaryFolder folder;
    const run::RunDirectory directory = run::RunDirectory::create(folder.path() / "run");
    const fs::path log = folder.path() / "run/journal.jsonl";
    const auto lastAt = [&](std::uintmax_t sizeBytes) {
        fs::resize_file(log, sizeBytes);  // of which the disk has nothing
        directory.note({{"event", "case"}, {"message", "no end"}, {"output", "words"}});
        const MappedFile whole(log);
        return run::Json::parse(whole.text().substr(sizeBytes));
    };
    EXPECT_EQ(lastAt(64 << 20)["output"], "words");
    const run::Json beyond = lastAt((64 << 20) + 1);
    EXPECT_EQ(beyond["output"], "[5 bytes left out: the journal has 64 MiB]");
    EXPECT_EQ(beyond["message"], "no end");
}

}  // namespace
}  // namespace gfxrepro::test
