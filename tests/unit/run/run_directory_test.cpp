// What a run writes into its log it can read again.
#include "runner/run/run_directory.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/run/run_files.h"
#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::StartsWith;

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

TEST(RunDirectory, WhatBeganIsInALogOfAnyLength) {
    const TemporaryFolder folder;
    const run::RunDirectory directory = run::RunDirectory::create(folder.path() / "run");
    const fs::path log = folder.path() / "run/journal.jsonl";
    constexpr std::uintmax_t kMost = std::uintmax_t{384} << 20;
    fs::resize_file(log, kMost);  // of which the disk has nothing
    const auto end = [&](int process) {
        directory.note({{"event", "case"},
                        {"case", "a"},
                        {"title", "t"},
                        {"process", process},
                        {"status", "crash"},
                        {"cost", {{"load_s", 1}}},
                        {"message", "m"},
                        {"output", "o"}});
    };
    for (int i = 0; i < 3; ++i) {
        directory.note({{"event", "start"}, {"case", "a"}, {"process", i}});
        end(i);
    }
    const MappedFile whole(log);
    std::vector<std::string> lines;
    for (const std::string& line : split(std::string(whole.text().substr(kMost)), '\n')) {
        if (line.empty()) continue;
        run::Json event = run::Json::parse(line);
        event.erase("time");
        lines.push_back(event.dump());
    }
    EXPECT_THAT(
        lines,
        testing::ElementsAre(
            R"({"event":"start","case":"a","process":0})",
            R"({"event":"in_short","message":"the journal has 384 MiB: what follows is without its texts"})",
            R"({"event":"case","case":"a","process":0,"status":"crash"})",
            R"({"event":"start","case":"a","process":1})",
            R"({"event":"case","case":"a","process":1,"status":"crash"})",
            R"({"event":"start","case":"a","process":2})",
            R"({"event":"case","case":"a","process":2,"status":"crash"})"));
}

TEST(RunDirectory, NothingIsMeasuredWhoseBeginningWouldNotBeRead) {
    const TemporaryFolder folder;
    const run::RunDirectory directory = run::RunDirectory::create(folder.path() / "run");
    fs::resize_file(folder.path() / "run/journal.jsonl", (std::uintmax_t{511} << 20) + 1);
    const auto start = [&] { directory.note({{"event", "start"}, {"process", 0}}); };
    EXPECT_EQ(
        errorText(start, folder.path()),
        "DIR/run/journal.jsonl: has 511 MiB, and a larger one is not read again: nothing more is "
        "measured into this folder");
}

}  // namespace
}  // namespace gfxrepro::test
