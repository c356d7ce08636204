// What a preprocess made is made once, however many processes ask for it at once.
#include "techniques/kit/kept_file.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/support.h"

namespace gfxrepro::test {
namespace {

struct Maker {
    fs::path path;
    std::atomic<int> made = 0;

    std::string operator()() {
        return kit::foundOrMade<std::string>(
            path,
            [&]() -> std::optional<std::string> {
                return fs::is_regular_file(path) ? std::optional(readFile(path)) : std::nullopt;
            },
            [&] {
                ++made;
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
                kit::keepFile(path, "content");
                return std::string("content");
            });
    }
};

TEST(KeptFile, IsMadeByOneWhileTheOthersWait) {
    const TemporaryFolder folder;
    Maker maker{folder.path() / "kept/a"};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back([&] { EXPECT_EQ(maker(), "content"); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(maker.made, 1);
    EXPECT_FALSE(fs::exists(folder.path() / "kept/a.lock"));
}

TEST(KeptFile, IsMadeByEachWhereNothingCanBeKept) {
    const TemporaryFolder folder;
    Maker maker{folder.write("file", "") / "below/a"};
    EXPECT_EQ(maker(), "content");
    EXPECT_EQ(maker(), "content");
    EXPECT_EQ(maker.made, 2);
}

}  // namespace
}  // namespace gfxrepro::test
