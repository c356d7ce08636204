#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "techniques/external/results.h"
#include "tests/support/support.h"

namespace gfxrepro::external {
namespace {

using test::errorText;

TEST(Patterns, TakeTheirLastMatch) {
    const config::ProgramPattern pattern{"rays", "^Rays: +([0-9.eE+-]+)"};
    EXPECT_EQ(numberIn("Rays:  12\rRays:  64 (all)\nno Rays: 3\n", pattern), 64.0);
    EXPECT_EQ(numberIn("Rays: 0064\n", pattern), 64.0);
    EXPECT_EQ(numberIn("\x1b[1;32mRays: \x1b[32m64\x1b[0m\n", pattern), 64.0);
    EXPECT_EQ(numberIn("Rays: 1e-400\nRays: -1e-400\n", pattern), 0.0);  // as strtod reads it
    EXPECT_EQ(errorText([&] { numberIn("Rays: 1e400\n", pattern); }),
              "metric 'rays': its pattern finds '1e400'; allowed: a number");
    EXPECT_EQ(numberIn("nothing\n", pattern), std::nullopt);
    EXPECT_EQ(numberIn("", pattern), std::nullopt);
    EXPECT_EQ(errorText([&] { numberIn("Rays: 1.2.3\n", pattern); }),
              "metric 'rays': its pattern finds '1.2.3'; allowed: a number");
}

double numberOf(const std::string& regex, const std::string& output) {
    return numberIn(output, {"m", regex}).value();
}

std::string errorOfPattern(const std::string& regex, const std::string& line, double scale = 1.0) {
    return errorText([&] { numberIn(line, {"m", regex, scale}); });
}

TEST(Patterns, SearchLinesOfAnyLength) {
    const std::string rest = " " + std::string(1'000'000, 'x') + " ";
    EXPECT_EQ(numberOf("m=(\\d+)", "m=1\n" + rest + "m=7"), 7.0);
    EXPECT_EQ(numberOf("m=(\\d+)", rest + "m=7" + rest + "m=8" + rest), 8.0);
    EXPECT_EQ(numberOf("m=(\\d+)$", rest + "m=7" + rest + " m=8"), 8.0);
    EXPECT_EQ(numberIn(rest, {"m", "^m=(\\d+)"}), std::nullopt);
    EXPECT_EQ(numberIn(rest + "m=7", {"m", "^m=(\\d+)"}), std::nullopt);
    EXPECT_EQ(numberIn("m=7" + rest, {"m", "m=(\\d+)$"}), std::nullopt);
    // As in a short line: a lazy quantifier takes the first end.
    EXPECT_EQ(numberOf("m=.*?n=(\\d+)", "m=1 n=2;" + rest + "n=3"), 2.0);
}

TEST(Patterns, ALineThatAPatternCannotSearchIsAnError) {
    const std::string line = "a=1 b=2" + std::string(5000, 'x') + "m=7";
    const std::pair<const char*, const char*> cases[] = {{"^.*m=(\\d+)", "m=(\\d+)"},
                                                         {"(a=1).*\\1", "t=([0-9.]+)"},
                                                         {"a=(\\d)(?=.*m)", "t=([0-9.]+)"}};
    for (const auto& [regex, allowed] : cases) {
        EXPECT_EQ(
            errorText([&] {
                numberIn(line, {"m", regex});
            }),
            "metric 'm': a line of 5010 bytes, more than 4096, is searched by no pattern that "
            "matches more than 4096, looks ahead or refers back to a group; allowed: what stands "
            "beside the number alone, as '" +
                std::string(allowed) + "'")
            << regex;
    }
}

TEST(Patterns, ScaleTheirNumbers) {
    const std::string regex = R"(Trace Time: .*\(([0-9.]+) seconds\))";
    const std::string line = "  Trace Time:       0 hours  0 minutes  1 seconds (1.234 seconds)\n";
    EXPECT_DOUBLE_EQ(numberIn(line, {"trace_ms", regex, 1000.0}).value(), 1234.0);
}

TEST(Patterns, TakeTheLastMatchOfALineToo) {
    EXPECT_EQ(numberOf("m=(\\d+)", "m=1 m=2 m=3"), 3.0);
    EXPECT_EQ(numberOf("(\\d*)$", "m=1"), 1.0);
}

TEST(Patterns, WhatMovesTheCursorPartsNumbers) {
    const std::string digits = "m=([0-9]+)";
    EXPECT_EQ(numberOf(digits, "\x1b[1;32mm=\x1b[0m12\x1b[38:5:1m5\x1b[m"), 125.0);
    for (const char* step : {"1C", "2D", "K", "5;10H", "A", "2J", "4P", "?25l"}) {
        EXPECT_EQ(numberOf(digits, std::string("m=5\x1b[") + step + "x"), 5.0) << step;
    }
    EXPECT_EQ(numberOf(digits, "m=5\x1b[>4;1m6"), 56.0);
    EXPECT_EQ(numberOf(digits, "m=5\x1b[4"), 5.0);
    EXPECT_THAT(errorOfPattern(digits, "m=12\x1b(B\x1b[m.5"),  // as of `tput sgr0`
                testing::HasSubstr("finds '12' of '12.5'"));
}

TEST(Patterns, ReadWhatIsWholeOrWhoseNeighboursTheyName) {
    struct Case {
        const char *regex, *line;
        double value, scale = 1.0;
    };
    const std::vector<Case> cases = {
        {"m=([0-9]+)", "m=12", 12},
        {"m=([0-9]+)", "m=12.", 12},
        {"m=([0-9.]+)", "m=12.0.", 12},
        {"m=([0-9]+)", "m=12, n=3", 12},
        {"m=([0-9]+)", "m=12; 345", 12},
        {"m=([0-9]+)", "m=12,n=3", 12},
        {"m=([0-9]+)", "m=12) x", 12},
        {"m=([0-9]+)", "(m=12).", 12},
        {"m=([0-9]+)", "m=12 rays", 12},
        {"m=([0-9]+)", "m=12 | 345", 12},
        {"m=([0-9]+)", "m=12 (all)", 12},
        {"m=([0-9]+)", "m=12 [ms]", 12},
        {"m=([0-9]+)", "m=12\t", 12},
        {"m=([0-9]+)", "m=12\u00A0ms", 12},
        {"m=([0-9]+)", "m=12 MiB", 12},
        {"m=([0-9]+)", "m=12 ms.", 12},
        {"m=([0-9]+)", "m=12: x", 12},
        {"m=([0-9]+)", "m=12 degrees", 12},
        {"m=(-?[0-9.e+-]+)", "m=-1.5e-3,", -0.0015},
        {"m=([0-9.dD+-]+)", "m=1.5D+03", 1500},
        {"m=([0-9.dD+-]+)", "m=25d-2 s", 0.25},
        {"m=(\\S+)", "m=\u22125", -5},
        {"m=(\\S+)", "m=5e\u20133", 0.005},
        {"(-?[0-9.]+) ms", "(-5 ms)", -5},
        {"(-?[0-9.]+) ms", "t=-5 ms", -5},
        {"([0-9.]+)ms", "12ms", 12},
        {"([0-9.]+) ?%", "load 50%", 50},
        {"m=([0-9.]+)\u00B5s", "m=12\u00B5s", 12},
        {"\\$([0-9.]+)", "$12", 12},
        {"([0-9.]+) \u00B5s", "a 12 \u00B5s", 12},
        {"\"m\": ?([0-9.]+)", "{\"a\":1,\"m\":2.5,\"b\":3}", 2.5},
        {"\"m\": ?([0-9.]+)", "{\"m\": 25}", 25},
        {"\"m\":\\[([0-9.]+),", "{\"m\":[1.5,2.5]}", 1.5},
        {"\\[[0-9.]+,([0-9.]+)", "\"m\":[1.5,2.5]", 2.5},
        {"m=\"([0-9]+)\"", "m=\"12\" n=\"345\"", 12},
        {"m='([0-9]+)'", "m='12' n='345'", 12},
        {"^([^,]*),", "1.5,2,3", 1.5},
        {"^(?:[^,]*,){2}([0-9.]+),", "a,1,2.5,3", 2.5},
        {",([0-9.]+)$", "a,1,2.5", 2.5},
        {"^time,([0-9]+),", "time,3,4.5", 3},
        {"[,;]([0-9.]+)$", "1,12", 12},
        {"^bunny [0-9.]+ ([0-9.]+) [0-9.]+", "bunny 1.5 2.5 3.5", 2.5},
        {"^([0-9]+)\\s+[0-9]+", "128 256 512", 128},
        {"^[0-9]+ ([0-9]+)\\s+\\S+$", "128 256 512", 256},
        {"^(?:\\S+\\s+){2}([0-9.]+)", "64 128 256", 256},
        {"^\\S+ \\S+ ([0-9.]+) ms", "2026-11-30 12:05:06 120 ms", 120},
        {"BM\\S+ +([0-9.]+) ns", "BM_x/64 12 ns", 12},
        {"Frame \\d+ (\\d+) ms", "Frame 1 100 ms", 100},
        {"GPU\\d ([0-9]+) ms", "GPU0 128 ms", 128},
        {"([0-9]+)/[0-9]+", "tile 3/10", 3},
        {"tile ([0-9]+) /", "tile 3 / 10", 3},
        {"\\[(\\d+)/\\d+\\]", "[3/10]", 3},
        {"([0-9]+) of", "3 of 10", 3},
        {"[0-9]+x([0-9]+)", "10x1080", 1080},
        {"v4\\.([0-9]+)", "v4.12", 12},
        {"img-([0-9]+)", "img-0005", 5},
        {"#([0-9]+)", "frame #12", 12},
        {"Rays[.]+([0-9]+)", "Rays....12", 12},
        {"([0-9.]+) ms", "frame: 12 ms", 12},
        {"([0-9.]+) ms", "t = 12 ms", 12},
        {"([0-9.]+) ms", "<12 ms", 12},
        {"\\(([0-9.]+) s\\)", "12 min (720.0 s)", 720},
        {"([0-9.]+) ms", "pass took 12 ms", 12},
        {"rmse=([0-9.]+)", "rmse=0.5 psnr=30", 0.5},
        {"FPS: ([0-9]+)", "FPS: 1234 FrameTime: 0.811 ms", 1234},
        {"([0-9]+) triangles", "bunny.ply: 69451 triangles, 35947 vertices", 69451},
        {"copied, ([0-9.]+) s", "1048576 bytes (1.0 MB) copied, 12 s, 852 MB/s", 12},
        {"([0-9.]+) ms \u00B1", "1.23 ms \u00B1 4.5 \u00B5s per loop", 1.23},
        {"real\\s+0m([0-9.]+)s", "real\t0m1.234s", 1.234},
        {"([0-9]+)h [0-9]+m", "took 1h 2m 3s", 1},
        {"([0-9]+)h [0-9]+m [0-9]+s", "took 1h 2m 3s", 1},
        {"Time: [0-9]+:([0-9.]+)", "Time: 00:01.23 (Saving: 00:00.20)", 1.23},
        {"m=([0-9]+) million", "m=5 million", 5},
        {"m=([0-9]+)k", "m=5k", 5},
        {"m=([0-9]+)", "m=5M rays", 5000000.0, 1000000.0},
        {"m=([0-9]+)", "m=12 Mio", 12000000.0, 1000000.0},
        {"m=([0-9]+)", "m=12 Kilo", 12000.0, 1000.0},
        {"m=([0-9]+)", "m=3Ki", 3072, 1024.0},
        {"m=([0-9]+)", "m=3k", 3072, 1024.0},
        {"\\| *([0-9.]+) *\\|", "| 12.5 | x |", 12.5},
    };
    for (const Case& each : cases) {
        const std::optional<double> value = numberIn(each.line, {"m", each.regex, each.scale});
        EXPECT_EQ(value, each.value) << each.regex << " of " << each.line;
    }
}

/// What asks for this text.
std::string exactly(const std::string& text) {
    return std::regex_replace(text, std::regex(R"([.+])"), R"(\$&)");
}

TEST(Patterns, RefuseWhatMayBeAPartAndSayHowItIsRead) {
    struct Case {
        const char *regex, *line, *found, *whole, *before, *behind;
        double scale = 1.0;
    };
    const std::vector<Case> cases = {
        {"m=([0-9.]+)", "m=1.5e-03", "1.5", "1.5e-03", "", "e-[0-9]+"},
        {"m=([0-9.]+)", "m=2E7", "2", "2E7", "", "E[0-9]+"},
        {"m=([0-9.]+)", "m=1,234.5", "1", "1,234.5", "", ",[0-9]+\\.[0-9]+"},
        {"m=([0-9.]+)", "m=1'234", "1", "1'234", "", "'[0-9]+"},
        {"m=([0-9.]+)", "m=5.e3", "5.", "5.e3", "", "e[0-9]+"},
        {"m=([0-9.]+)", "m=0x1F", "0", "0x1F", "", "x[0-9]+F"},
        {"m=([0-9.]+)", "m=1.#INF", "1.", "1.#INF", "", "#INF"},
        {"m=([0-9.]+)", "m=1.5x10-3", "1.5", "1.5x10-3", "", "x[0-9]+-[0-9]+"},
        {"m=([0-9.]+)", "m=1d-3", "1", "1d-3", "", "d-[0-9]+"},
        {"m=([0-9.]+)", "m=2.d0", "2.", "2.d0", "", "d[0-9]+"},
        {"m=([0-9.]+)", "m=1.5-103", "1.5", "1.5-103", "", "-[0-9]+"},
        {"m=([0-9.]+)", "m=1.5\u00D710^3", "1.5", "1.5\u00D710^3", "", "\u00D7[0-9]+\\^[0-9]+"},
        {"m=([0-9.]+)", "m=1.5 x 10^3 s", "1.5", "1.5 x 10^3", "", " x [0-9]+\\^[0-9]+"},
        {"m=([0-9.]+)", "m=1.5*10**3", "1.5", "1.5*10**3", "", "\\*[0-9]+\\*\\*[0-9]+"},
        {"m=([0-9.]+)", "m=1.5\u00B710\u00B3", "1.5", "1.5\u00B710\u00B3", "",
         "\u00B7[0-9]+\u00B3"},
        {"m=([0-9.]+)", "m=1.5 * 1e3", "1.5", "1.5 *", "", " \\*"},
        {"m=([0-9.]+)", "m=1.5 e-3 s", "1.5", "1.5 e-3", "", " e-[0-9]+"},
        {"m=([0-9.]+)", "m=1.5e +03", "1.5", "1.5e +03", "", "e \\+[0-9]+"},
        {"m=([0-9.]+)", "m=1.5(2)e3", "1.5", "1.5(2)e3", "", "\\([0-9]+\\)e[0-9]+"},
        {"m=([0-9.]+)", "m=1.5 (2) e3", "1.5", "1.5 (2", "", " \\([0-9]+"},
        {"m=([0-9.]+)", "m=1.5 D+3", "1.5", "1.5 D+3", "", " D\\+[0-9]+"},
        {"m=([0-9.]+)", "m=1.5 10^3", "1.5", "1.5 10^3", "", " [0-9]+\\^[0-9]+"},
        {"m=([0-9.]+)", "m=12.5 \u00B1 0.2", "12.5", "12.5 \u00B1", "", " \u00B1"},
        {"m=([0-9.]+)", "m=3+4i", "3", "3+4i", "", "\\+[0-9]+i"},
        {"m=([0-9.]+)", "m=1.5 + 2i", "1.5", "1.5 +", "", " \\+"},
        {"m=([0-9.]+)", "m=12\u00B0", "12", "12\u00B0", "", "\u00B0"},
        {"m=([0-9.]+)", "m=12.5 \u00B5s", "12.5", "12.5 \u00B5s", "", " \u00B5s"},
        {"m=([0-9.]+)", "m=12!", "12", "12!", "", "!"},
        {"m=([0-9.]+)", "m=1.5~2", "1.5", "1.5~2", "", "~[0-9]+"},
        {"m=([0-9]+)", "m=12,5", "12", "12,5", "", ",[0-9]+"},
        {"m=([0-9]+)", "m=12.5 s", "12", "12.5", "", "\\.[0-9]+"},
        {"m=([0-9]+)", "m=1:23.45", "1", "1:23.45", "", ":[0-9]+\\.[0-9]+"},
        {"m=([0-9]+)", "m=1/2", "1", "1/2", "", "/[0-9]+"},
        {"m=([0-9]+)", "m=2^10", "2", "2^10", "", "\\^[0-9]+"},
        {"m=([0-9]+)", "m=10\u00B2", "10", "10\u00B2", "", "\u00B2"},
        {"m=([0-9]+)", "m=12\u00BD", "12", "12\u00BD", "", "\u00BD"},
        {"m=([0-9]+)", "m=1h30", "1", "1h30", "", "h[0-9]+"},
        {"m=([0-9]+)", "m=16#FF", "16", "16#FF", "", "#FF"},
        {"m=([0-9]+)", "m=5k", "5", "5k", "", "k"},
        {"m=([0-9]+)", "m=5M rays", "5", "5M", "", "M"},
        {"m=([0-9]+)", "m=12ms", "12", "12ms", "", "ms"},
        {"m=([0-9]+)", "m=50%", "50", "50%", "", "%"},
        {"m=([0-9]+)", "m=12\u0665", "12", "12\u0665", "", "\u0665"},
        {"m=([0-9]+)", "m=12\u200B5", "12", "12\u200B5", "", "\u200B[0-9]+"},
        {"m=([0-9]+)", "m=12\b5", "12", "12\b5", "", "\b[0-9]+"},
        {"m=([0-9]+)", "m=1&nbsp;234", "1", "1&nbsp;234", "", "&nbsp;[0-9]+"},
        {"m=([0-9]+)", "m=1\\,234", "1", "1\\,234", "", "\\\\,[0-9]+"},
        {"m=([0-9]+)", "m=1{,}234", "1", "1{,}234", "", "\\{,\\}[0-9]+"},
        {"m=([0-9]+)", "m=12\uFF0E5", "12", "12\uFF0E5", "", "\uFF0E[0-9]+"},
        {"m=([0-9]+)", "m=5\u00F78", "5", "5\u00F78", "", "\u00F7[0-9]+"},
        {"m=([0-9]+)",
         "m=1\xA0"
         "234",
         "1",
         "1\xA0"
         "234",
         "", "\xA0[0-9]+"},
        {"m=([0-9]+)", "m=1 234", "1", "1 234", "", " [0-9]+"},
        {"m=([0-9]+)", "m=1\t234", "1", "1\t234", "", "\\t[0-9]+"},
        {"m=([0-9]+)", "m=12 345 678 rays", "12", "12 345", "", " [0-9]+"},
        {"m=([0-9]+)", "m=1\u00A0234", "1", "1\u00A0234", "", "\u00A0[0-9]+"},
        {"m=([0-9]+)", "m=1\u2009234 567", "1", "1\u2009234", "", "\u2009[0-9]+"},
        {"m=([0-9]+)", "m=1\u202F234.5", "1", "1\u202F234.5", "", "\u202F[0-9]+\\.[0-9]+"},
        {"m=([0-9]+)", "m=12 5/8", "12", "12 5/8", "", " [0-9]+/[0-9]+"},
        {"m=([0-9]+)", "m=5 / 8 in", "5", "5 /", "", " /"},
        {"m=([0-9]+)", "m=12 \u00BD in", "12", "12 \u00BD", "", " \u00BD"},
        {"m=([0-9]+)", "m=12 and 1/2", "12", "12 and 1/2", "", " and [0-9]+/[0-9]+"},
        {"m=([0-9]+)", "m=12 - 20", "12", "12 -", "", " -"},
        {"m=([0-9]+)", "m=12 .5", "12", "12 .5", "", " \\.[0-9]+"},
        {"m=([0-9]+)", "m=12 ,5", "12", "12 ,5", "", " ,[0-9]+"},
        {"m=([0-9]+)", "m=0000 012", "0000", "0000 012", "", " [0-9]+"},
        {"m=([0-9]+)", "m=1920 x 1080", "1920", "1920 x 1080", "", " x [0-9]+"},
        {"m=([0-9]+)", "m=3 k", "3", "3 k", "", " k"},
        {"m=([0-9]+)", "m=3 Mi", "3", "3 Mi", "", " Mi"},
        {"m=([0-9]+)", "m=12 Mio rays", "12", "12 Mio", "", " Mio"},
        {"m=([0-9]+)", "m=2 Billion", "2", "2 Billion", "", " Billion"},
        {"m=([0-9]+)", "m=4 million rays", "4", "4 million", "", " million"},
        {"m=([0-9]+)", "m=5 dozen", "5", "5 dozen", "", " dozen"},
        {"m=([0-9]+)", "m=2m 3s", "2", "2m 3s", "", "m [0-9]+s"},
        {"m=([0-9]+)", "m=1h 2m 3s", "1", "1h 2m", "", "h [0-9]+m"},
        {"m=([0-9]+)", "m=2 min, 30 s", "2", "2 min, 30 s", "", " min, [0-9]+ s"},
        {"m=([0-9]+)", "m=2 min 30", "2", "2 min 30", "", " min [0-9]+"},
        {"m=([0-9]+)", "m=1 h and 5 min", "1", "1 h and 5 min", "", " h and [0-9]+ min"},
        {"m=([0-9]+)", "m=3 days, 2:03:04", "3", "3 days, 2:03:04", "",
         " days, [0-9]+:[0-9]+:[0-9]+"},
        {"m=([0-9]+)", "m=3 s 200 ms", "3", "3 s 200 ms", "", " s [0-9]+ ms"},
        {"m=([0-9]+)", "m=2 Minuten 5 s", "2", "2 Minuten 5 s", "", " Minuten [0-9]+ s"},
        {"m=([0-9]+)", "m=5 d 3 h", "5", "5 d 3", "", " d [0-9]+"},
        {"m=([0-9]+)", "m=2 heures 3 s", "2", "2 heures", "", " heures"},
        {"m=([0-9]+)", "m=3 MB 200 KB", "3", "3 MB", "", " MB"},
        {"m=([0-9]+)", "m=5 ft 3 in", "5", "5 ft", "", " ft"},
        {"m=([0-9]{2})", "m=123", "12", "123", "", ""},
        {"([0-9]{2})$", "m= 123", "23", "123", "", ""},
        {"m=([0-9]+),?", "m=1,234", "1", "1,234", "", ",[0-9]+"},
        {"m=([0-9]+)k?", "m=5k", "5", "5k", "", "k"},
        {"time: ([0-9]+).*ms", "time: 12.5 ms", "12", "12.5", "", "\\.[0-9]+"},
        {"m=([0-9.]+)\\D", "m=1.5D+03", "1.5", "1.5D+03", "", "D\\+[0-9]+"},
        {"([0-9.]+)e", "5e3", "5", "5e3", "", "e[0-9]+"},
        {"([0-9]+)m\\b", "2m 3s", "2", "2m 3s", "", "m [0-9]+s"},
        {"([0-9]+) m", "5 million", "5", "5 million", "", " million"},
        {"([0-9]+)/", "3/10", "3", "3/10", "", "/[0-9]+"},
        {"m=([0-9]+)\\s", "m=1 234 rays", "1", "1 234", "", " [0-9]+"},
        {"^([0-9]+) ", "128 256 512", "128", "128 256", "", " [0-9]+"},
        {"([0-9]+)[a-z]+", "12ms", "12", "12ms", "", "ms"},
        {"([0-9]+).* rays", "1 234 rays", "1", "1 234", "", " [0-9]+"},
        {"([0-9]+) ms", "Frame 1 100 ms", "100", "1 100", "[0-9]+ ", ""},
        {"([0-9]+) ms", "took 1 234 ms", "234", "1 234", "[0-9]+ ", ""},
        {"([0-9]+) ms", "GPU0 128 ms", "128", "GPU0 128", "GPU[0-9]+ ", ""},
        {"([0-9]+) ms", "12/20 200 ms", "200", "12/20 200", "[0-9]+/[0-9]+ ", ""},
        {"([0-9]+) ms", "n12,5 ms", "5", "n12,5", "n[0-9]+,", ""},
        {"([0-9]+) ms", "10:32:05 120 ms", "120", "10:32:05 120", "[0-9]+:[0-9]+:[0-9]+ ", ""},
        {"([0-9]+) ms", "5~120 ms", "120", "5~120", "[0-9]+~", ""},
        {"([0-9]+) ms", "<ok> - 12 ms", "12", "- 12", "- ", ""},
        {"([0-9]+) ms", "12 threads 40 ms", "40", "threads 40", "threads ", ""},
        {"([0-9]+) s", "12.5 s", "5", "12.5", "[0-9]+\\.", ""},
        {"([0-9]+) s", "in .5 s", "5", ".5", "\\.", ""},
        {"([0-9]+) s", "2 min, 30 s", "30", "2 min, 30", "[0-9]+ min, ", ""},
        {"([0-9]+) s", "2 minutes and 5 s", "5", "2 minutes and 5", "[0-9]+ minutes and ", ""},
        {"([0-9]+) s", "1 hr. 5 min. 3 s", "3", "5 min. 3", "[0-9]+ min\\. ", ""},
        {"([0-9]+) s", "1 h & 3 s", "3", "1 h & 3", "[0-9]+ h & ", ""},
        {"([0-9]+) s", "4 heures 3 s", "3", "heures 3", "heures ", ""},
        {"([0-9.]+) ?s", "took 1h 2m 3s", "3", "2m 3s", "[0-9]+m ", "s"},
        {"([0-9.]+) ?s", "took 0m1.234s", "1.234", "0m1.234s", "[0-9]+m", "s"},
        {"([0-9.]+) ?s", "real\t1m 2.35s", "2.35", "1m 2.35s", "[0-9]+m ", "s"},
        {"([0-9]+)$", "m=1e-5", "5", "1e-5", "[0-9]+e-", ""},
        {"([0-9]+)$", "m=1/2", "2", "1/2", "[0-9]+/", ""},
        {"([0-9]+)$", "m=2^10", "10", "2^10", "[0-9]+\\^", ""},
        {"([0-9]+)$", "took: 1:23", "23", "1:23", "[0-9]+:", ""},
        {"([0-9]+)$", "m=\u22125", "5", "\u22125", "\u2212", ""},
        {"([0-9]+)$", "v1.2", "2", "v1.2", "v[0-9]+\\.", ""},
        {"([0-9]+)$", "2026-11-30", "30", "2026-11-30", "[0-9]+-[0-9]+-", ""},
        {"([0-9]+)$", "t=x20", "20", "x20", "x", ""},
        {"([0-9]+)$", "a, 1,234", "234", "1,234", "[0-9]+,", ""},
        {"([0-9]+)$", "m=5\u22158", "8", "5\u22158", "[0-9]+\u2215", ""},
        {"([0-9]+)$", "total $5", "5", "$5", "\\$", ""},
        {"([0-9]+)$", "#5", "5", "#5", "#", ""},
        {"(-?[0-9]+)$", "10-20", "-20", "10-20", "[0-9]+-", ""},
        {"(-?[0-9]+)$", "img-0005", "-0005", "img-0005", "img-", ""},
        {"(-?[0-9]+)$", "m= 1.5 e-3", "-3", "1.5 e-3", "[0-9]+\\.[0-9]+ e-", ""},
        {"([0-9.]+)$", "out.12", ".12", "out.12", "out\\.", ""},
        {"([0-9.]+) ms", "10\u201320 ms", "20", "10\u201320", "[0-9]+\u2013", ""},
        {"([0-9]+) rays", "1,234 rays", "234", "1,234", "[0-9]+,", ""},
        {"([0-9]+) rays", "5 million 300 rays", "300", "5 million 300", "[0-9]+ million ", ""},
        {"([0-9]+) 567", "1 234 567 x", "234", "1 234 567", "[0-9]+ ", " [0-9]+"},
        {"h ([0-9.]+)", "1h 2m 3s", "2", "1h 2m 3s", "[0-9]+h ", "m [0-9]+s"},
        {"([0-9.]+) ms", "$.5 2 ms", "2", "$.5 2", "\\$\\.[0-9]+ ", ""},
        {"([0-9.]+) ms", "frame 3 took 4 ms", "4", "took 4", "took ", ""},
        {"t([0-9]+)", "t1,234", "1", "t1,234", "t", ",[0-9]+"},
        {"t([0-9]+)", "t1e5", "1", "t1e5", "t", "e[0-9]+"},
        {"PT([0-9]+)", "PT1M3.5S", "1", "PT1M3.5S", "PT", "M[0-9]+\\.[0-9]+S"},
        {"total, ([0-9]+)", "total, 1,234 rays", "1", "1,234", "", ",[0-9]+"},
        {"([0-9.]+)S$", "PT1M3.5S", "3.5", "PT1M3.5S", "PT[0-9]+M", "S"},
        {"([0-9.]+)", "trace.1.5e3", "3", "trace.1.5e3", "trace\\.[0-9]+\\.[0-9]+e", ""},
        {"\"m\": \"([0-9]+)", "{\"m\": \"12\u00D7\"}", "12", "12\u00D7", "", "\u00D7"},
        {"m=([0-9]+)", "m=3M", "3", "3M", "", "M", 1024.0},
        {"m=([0-9]+)", "m=3 thousand", "3", "3 thousand", "", " thousand", 1024.0},
        {"m=([0-9]+)", "m=3Mi", "3", "3Mi", "", "Mi", 1000000.0},
    };
    for (const Case& each : cases) {
        SCOPED_TRACE(fmt::format("{} of {}", each.regex, each.line));
        const std::string before(each.before), behind(each.behind);
        const std::string both = before.empty() || behind.empty() ? "" : " and ";
        const std::string better = before + behind;
        EXPECT_EQ(errorOfPattern(each.regex, each.line, each.scale),
                  fmt::format("metric 'm': its pattern finds '{}' of '{}'; allowed: a whole "
                              "number{}{}{}{}{}",
                              each.found, each.whole, better.empty() ? "" : ", or a pattern with ",
                              before.empty() ? "" : "'" + before + "' before", both,
                              behind.empty() ? "" : "'" + behind + "' behind",
                              better.empty() ? "" : " its group"));
        if (better.empty()) continue;
        // Followed, it is read; a mark before its digits may be none of the number.
        std::string found(each.found);
        if (before.ends_with(found.front()) && !std::isdigit(found.front())) found.erase(0, 1);
        EXPECT_EQ(numberOf(fmt::format("{}({}){}", before, exactly(found), behind), each.line),
                  std::stod(found));
    }
}

}  // namespace
}  // namespace gfxrepro::external
