// What a run writes into its log it can read again.
#include "runner/batch/run_directory.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <thread>

#include "runner/batch/run_files.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
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
    const auto create = [&] { batch::RunDirectory::create(folder.path() / "run"); };
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
    const batch::RunDirectory directory = batch::RunDirectory::create(folder.path() / "run");
    const std::string most(32768, '\1'), more = "begin" + std::string(100'000, '\1') + "end";
    directory.log(
        {{"event", "case"}, {"title", more}, {"as", more}, {"message", more}, {"output", more}});
    directory.log({{"event", "case"}, {"message", most}, {"output", most}});
    const std::vector<batch::Json> events = batch::readLog(folder.path() / "run/log.jsonl");
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
    const batch::RunDirectory directory = batch::RunDirectory::create(folder.path() / "run");
    const fs::path log = folder.path() / "run/log.jsonl";
    const auto lastAt = [&](std::uintmax_t sizeBytes) {
        fs::resize_file(log, sizeBytes);  // of which the disk has nothing
        directory.log({{"event", "case"}, {"message", "no end"}, {"output", "words"}});
        const MappedFile whole(log);
        return batch::Json::parse(whole.text().substr(sizeBytes));
    };
    EXPECT_EQ(lastAt(64 << 20)["output"], "words");
    const batch::Json beyond = lastAt((64 << 20) + 1);
    EXPECT_EQ(beyond["output"], "[5 bytes left out: the log has 64 MiB]");
    EXPECT_EQ(beyond["message"], "no end");
}

TEST(RunDirectory, ALogEndsWithOneLineThatSaysSo) {
    const TemporaryFolder folder;
    const batch::RunDirectory directory = batch::RunDirectory::create(folder.path() / "run");
    const fs::path log = folder.path() / "run/log.jsonl";
    fs::resize_file(log, batch::kMostWrittenLogBytes);  // of which the disk has nothing
    for (int i = 0; i < 3; ++i) directory.log({{"event", "start"}, {"process", i}});
    const MappedFile whole(log);
    const std::string written(whole.text().substr(batch::kMostWrittenLogBytes));
    const std::vector<std::string> lines = split(written, '\n');
    ASSERT_EQ(lines.size(), 3U) << written;
    EXPECT_EQ(batch::Json::parse(lines[0])["process"], 0);
    EXPECT_EQ(batch::Json::parse(lines[1])["event"], "full");
    EXPECT_EQ(batch::Json::parse(lines[1])["message"],
              "the log has 384 MiB: what follows is left out");
}

}  // namespace
}  // namespace gfxrepro::test
