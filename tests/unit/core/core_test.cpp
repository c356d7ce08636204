#include <pwd.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/json_shape.h"
#include "engine/core/near_file.h"
#include "engine/core/output_files.h"
#include "engine/core/random.h"
#include "engine/core/text.h"
#include "tests/support/support.h"

namespace gfxrepro {
namespace {

TEST(Error, SaysWhere) {
    EXPECT_STREQ(Error({"a.yaml", 3, 7}, "unknown key 'x'").what(), "a.yaml:3:7: unknown key 'x'");
    EXPECT_STREQ(Error({"a.ply", 3, 0}, "short").what(), "a.ply:3: short");
    EXPECT_STREQ(Error(SourceLocation{}, "short").what(), "short");
}

TEST(Text, NearestNameFindsTyposOnly) {
    const std::vector<std::string> names = {"resolution", "method", "voxel_bits"};
    EXPECT_EQ(nearestName("resolutoin", names), "resolution");
    EXPECT_EQ(nearestName("Method", names), "method");
    EXPECT_EQ(nearestName("banana", names), std::nullopt);
    EXPECT_EQ(suggestion("metod", names), "; did you mean 'method'?");
    EXPECT_EQ(suggestion("", names), "");
}

TEST(NearFile, IsWhatLiesBesideAMisspeltPath) {
    const test::TemporaryFolder folder;
    folder.write("models/bunny.off", "");
    folder.write("models/run_1.yaml", "");
    folder.write("models/.hidden", "");
    const std::string at = folder.path().string() + "/";
    EXPECT_EQ(suggestedFile(at + "models/buny.off"),
              "; did you mean '" + at + "models/bunny.off'?");
    EXPECT_EQ(suggestedFile(at + "modles/bunny.off"),
              "; did you mean '" + at + "models/bunny.off'?");
    EXPECT_EQ(suggestedFile(at + "Models"), "; did you mean '" + at + "models'?");
    for (const char* other :
         {"modles/none.off", "models/run_2.yaml", "models/.hiden", "models", "models/bunny.off",
          "models/bunny.off/x", "models/beany.of", "models/many.off", "elsewhere"}) {
        EXPECT_EQ(suggestedFile(at + other), "") << other;
    }
    EXPECT_EQ(test::errorText([&] { readFile(at + "models/bunny.of"); }),
              "cannot read " + at + "models/bunny.of: No such file or directory; did you mean '" +
                  at + "models/bunny.off'?");
}

TEST(Text, NumbersAreDecimalOnly) {
    EXPECT_EQ(parseDouble("1e-3"), 1e-3);
    EXPECT_EQ(parseDouble("+2"), 2.0);
    EXPECT_EQ(parseDouble("0.5"), 0.5);
    EXPECT_EQ(parseInteger("-12"), -12);
    for (const char* text :
         {"010", "0x10", "", "-", "1 ", "nan", "inf", ".inf", "1e999", "1,5", "--1"}) {
        EXPECT_EQ(parseDouble(text), std::nullopt) << text;
    }
    EXPECT_EQ(parseInteger("1.0"), std::nullopt);
    EXPECT_EQ(parseInteger("99999999999999999999"), std::nullopt);
}

TEST(Text, SplitsTrimsAndJoins) {
    EXPECT_THAT(split("a,,b", ','), ElementsAre("a", "", "b"));
    EXPECT_EQ(trimmed(" \t a b\n"), "a b");
    EXPECT_EQ(trimmed("  "), "");
    const std::vector<std::string> items = {"a", "b"};
    EXPECT_EQ(joined(items), "a, b");
    const std::vector<std::string> gaps = {"", "a", "", ""};
    EXPECT_EQ(joined(gaps), ", a, , ");
}

using Files = FolderTest;

TEST_F(Files, CachesLieInTheHomeOfTheUserWithoutHOME) {
    const auto inEnvironment = [](const char* cache, const char* home) {
        const auto set = [](const char* name, const char* value) {
            return value ? ::setenv(name, value, 1) : ::unsetenv(name);
        };
        set("XDG_CACHE_HOME", cache);
        set("HOME", home);
        return cacheFolder().string();
    };
    const std::string cache = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
    const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
    EXPECT_EQ(inEnvironment("/c", "/h"), "/c/gfxrepro");
    EXPECT_EQ(inEnvironment(nullptr, "/h"), "/h/.cache/gfxrepro");
    const passwd* user = ::getpwuid(::getuid());
    EXPECT_EQ(
        inEnvironment(nullptr, nullptr),
        (user ? std::string(user->pw_dir) : fs::current_path().string()) + "/.cache/gfxrepro");
    inEnvironment(cache.empty() ? nullptr : cache.c_str(), home.empty() ? nullptr : home.c_str());
}

TEST(Hash, MatchesFips180) {
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    const TemporaryFolder folder;
    EXPECT_EQ(sha256OfFile(folder.write("abc", "abc")), sha256("abc"));
    EXPECT_THROW(sha256OfFile("/dev/zero"), Error);  // which has no end
    EXPECT_THROW(sha256OfFile(folder.path() / "absent"), Error);
}

TEST(JsonDepth, CountsBracketsOutsideOfStrings) {
    const auto nested = [](int levels) {
        return std::string(static_cast<std::size_t>(levels), '[') + "1";
    };
    EXPECT_FALSE(isTooDeepJson(nested(kMostJsonLevels)));
    EXPECT_TRUE(isTooDeepJson(nested(kMostJsonLevels + 1)));
    EXPECT_FALSE(isTooDeepJson(R"({"a\"": ")" + nested(kMostJsonLevels + 1) + "\"}"));
    std::string flat;
    for (int i = 0; i <= kMostJsonLevels; ++i) flat += "[{}],";
    EXPECT_FALSE(isTooDeepJson(flat));
}

TEST(Random, MatchesThePcgReference) {
    // First outputs of pcg32 with state 42 and stream 54, from the reference implementation's demo.
    Random random(42, 54);
    EXPECT_EQ(random.next(), 0xa15c02b7U);
    EXPECT_EQ(random.next(), 0x7b47f409U);
    EXPECT_EQ(random.next(), 0xba1d3330U);
}

TEST(Random, UniformIsInItsRange) {
    Random random(1);
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) {
        const float value = random.uniform();
        ASSERT_GE(value, 0.0F);
        ASSERT_LT(value, 1.0F);
        sum += value;
    }
    EXPECT_NEAR(sum / 10000, 0.5, 0.02);
    EXPECT_LT(random.index(3), 3U);
}

TEST_F(Files, NothingButAFileIsReplaced) {
    const auto kept = folder.write("kept", "mine");
    fs::create_symlink(kept, folder.path() / "link");
    fs::create_symlink("/nonexistent", folder.path() / "nowhere");
    ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    for (const char* name : {"link", "nowhere", "pipe"}) {
        EXPECT_EQ(
            errorText([&] { writeFileAtomic(folder.path() / name, "x"); }, folder.path()),
            std::string("cannot write DIR/") + name + ": a link, a pipe or a device, not a file");
    }
    EXPECT_EQ(errorText([] { writeFileAtomic("/dev/null", "x"); }),
              "cannot write /dev/null: a link, a pipe or a device, not a file");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(readFile(kept), "mine");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
}

TEST_F(Files, AtomicWriteReplacesWholeAndLeavesNothingBehind) {
    const auto path = folder.path() / "deep" / "file.txt";
    writeFileAtomic(path, "one");
    writeFileAtomic(path, "two");
    EXPECT_EQ(readFile(path), "two");
    EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1);
}

TEST_F(Files, WhatIsWrittenInPiecesIsThereAsAWhole) {
    const auto path = folder.write("file.txt", "old");
    const auto count = [&] { return std::distance(fs::directory_iterator(folder.path()), {}); };
    {
        AtomicFile file(path);
        file.write("never there");
        EXPECT_EQ(count(), 2);
    }
    EXPECT_EQ(readFile(path), "old");
    EXPECT_EQ(count(), 1);
    const std::string large(1'500'000, 'x');
    AtomicFile file(path);
    for (const std::string& piece : {std::string("a"), large, std::string("b"), large})
        file.write(piece);
    EXPECT_EQ(readFile(path), "old");
    file.commit();
    EXPECT_EQ(readFile(path), "a" + large + "b" + large);
    EXPECT_EQ(count(), 1);
}

TEST_F(Files, ACopyLeavesOutWhatIsBeingWrittenAlone) {
    for (const char* name :
         {"a.exr.tmp4711", "b.csv.tmp", "notes.tmpl", "c.tmp-old", "deep/d.tmp.png"}) {
        folder.write(std::string("from/") + name, "x");
    }
    const auto to = folder.path() / "to";
    copyTree(folder.path() / "from", to);
    for (const char* name : {"notes.tmpl", "c.tmp-old", "deep/d.tmp.png"}) {
        EXPECT_EQ(readFile(to / name), "x");
    }
    for (const char* name : {"a.exr.tmp4711", "b.csv.tmp"}) {
        EXPECT_FALSE(fs::exists(to / name)) << name;
    }
    const auto large = folder.write("large", "head");
    fs::resize_file(large, std::uintmax_t{1} << 35);  // nearly all of it a hole
    EXPECT_EQ(errorText([&] { copyTree(large, to / "large"); }, folder.path()),
              "cannot copy DIR/large: 34359738368 bytes; more than 16 GiB are not copied");
    EXPECT_FALSE(fs::exists(to / "large"));
}

TEST_F(Files, AFolderThatAKilledProcessLeftUnfinishedGoesWithTheNextOne) {
    const pid_t gone = ::fork();
    if (gone == 0) ::_exit(0);
    ::waitpid(gone, nullptr, 0);
    const std::string left = "out.tmp" + std::to_string(gone);
    folder.write(left + "/out/part", "");
    const std::string others[] = {"out.tmp" + std::to_string(::getppid()), "out.tmpx", "a" + left};
    for (const std::string& other : others) folder.write(other + "/part", "");
    writeFolder(folder.path() / "out", [](const fs::path& part) { makeFolder(part / "in"); });
    EXPECT_TRUE(fs::exists(folder.path() / "out/in"));
    EXPECT_FALSE(fs::exists(folder.path() / left));
    for (const std::string& other : others) EXPECT_TRUE(fs::exists(folder.path() / other)) << other;
}

TEST_F(Files, MissingFilesAndFoldersAreNamed) {
    EXPECT_EQ(errorText([&] { readFile(folder.path() / "none"); }, folder.path()),
              "cannot read DIR/none: No such file or directory");
    EXPECT_EQ(errorText([&] { readFile(folder.path()); }, folder.path()),
              "cannot read DIR: Is a directory");
    ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(errorText([&] { readFile(folder.path() / "pipe"); }, folder.path()),
              "cannot read DIR/pipe: a pipe or a device, not a file");
    const auto large = folder.write("large", "head");
    fs::resize_file(large, (std::uintmax_t{1} << 30) + 1);  // nearly all of it a hole
    EXPECT_EQ(errorText([&] { readFile(large); }, folder.path()),
              "cannot read DIR/large: 1073741825 bytes; at most 1 GiB are read at once");
    EXPECT_TRUE(readFile(folder.write("empty", "")).empty());
}

}  // namespace
}  // namespace gfxrepro
