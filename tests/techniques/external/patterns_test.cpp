#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
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

/// Without what a pattern would have to have.
std::string partIn(const std::string& regex, const std::string& line, double scale = 1.0) {
    const std::string error = errorOfPattern(regex, line, scale);
    return error.substr(0, error.find("; allowed: a whole number"));
}

std::string partOf(const std::string& part, const std::string& whole) {
    return "metric 'm': its pattern finds '" + part + "' of '" + whole + "'";
}

TEST(Patterns, SearchLinesOfAnyLength) {
    const std::string rest(1'000'000, 'x');
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
    for (const char* regex : {".*m=(\\d+)", "(a=1).*\\1", "a=(\\d)(?=.*m)"}) {
        EXPECT_EQ(
            errorText([&] {
                numberIn(line, {"m", regex});
            }),
            "metric 'm': a line of 5010 bytes, more than 4096, is searched by no pattern that "
            "matches more than 4096, looks ahead or refers back to a group")
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

TEST(Patterns, TakeNoPartOfANumber) {
    const std::string digits = "m=([0-9]+)", decimal = "m=([0-9.]+)";
    EXPECT_EQ(partIn(decimal, "m=1.5e-03"), partOf("1.5", "1.5e-03"));
    EXPECT_EQ(partIn(decimal, "m=2E7"), partOf("2", "2E7"));
    EXPECT_EQ(partIn(decimal, "m=1,234.5"), partOf("1", "1,234.5"));
    EXPECT_EQ(partIn(decimal, "m=1'234"), partOf("1", "1'234"));
    EXPECT_EQ(partIn(digits, "m=12,5"), partOf("12", "12,5"));
    EXPECT_EQ(partIn(digits, "m=12.5 s"), partOf("12", "12.5"));
    EXPECT_EQ(partIn(digits, "m=5.e3"), partOf("5", "5.e3"));
    EXPECT_EQ(partIn(digits, "m=0x1F"), partOf("0", "0x1F"));
    EXPECT_EQ(partIn("m=([0-9]{2})", "m=123"), partOf("12", "123"));
    EXPECT_EQ(partIn("([0-9]+) s", "12.5 s"), partOf("5", "12.5"));
    EXPECT_EQ(partIn("([0-9]+) s", "in .5 s"), partOf("5", ".5"));
    EXPECT_EQ(partIn("([0-9]+) rays", "1,234 rays"), partOf("234", "1,234"));
    EXPECT_EQ(partIn("([0-9]+)$", "m=1e-5"), partOf("5", "1e-5"));
    EXPECT_EQ(partIn("m=.*?([0-9]+)", "m= -5"), partOf("5", "-5"));
    // Whole ones: ends of sentences, lists, dates, names, leaders, units.
    EXPECT_EQ(numberOf(digits, "m=12."), 12.0);
    EXPECT_EQ(numberOf(digits, "m=12, n=3"), 12.0);
    EXPECT_EQ(numberOf("([0-9]+) rays", "m-5 rays"), 5.0);
    EXPECT_EQ(numberOf("Rays[.]+([0-9]+)", "Rays....12"), 12.0);
    EXPECT_EQ(numberOf(digits, "m=12ms"), 12.0);
    EXPECT_EQ(numberOf("m=(-?[0-9.e+-]+)", "m=-1.5e-3,"), -1.5e-3);
    // A pattern that names the comma knows what it separates.
    EXPECT_EQ(numberOf("^time,([0-9]+),", "time,3,4.5"), 3.0);
}

TEST(Patterns, TakeNoPartOfWhatFortranAndTypesettersWrite) {
    const auto isPart = [](const std::string& regex, const std::string& line) {
        return errorOfPattern(regex, line).find("; allowed: a whole number") != std::string::npos;
    };
    const std::string decimal = "m=([0-9.]+)";
    for (const char* whole : {"1d-3", "1.5D+03", "1.5D3", "2.d0", "1.5\u00D710^3", "1.5 x 10^3",
                              "1.5*10**3", "1.5\u00B710\u00B3", "1.5 \u00D7 10\u207B\u2074",
                              "1\u00A0234", "1\u202F234.5", "1\u2009234\u2009567", "1\u2019234",
                              "1.5-103", "1.5+103", ".5-103", "5e\u20133", "5e\u22123"}) {
        EXPECT_TRUE(isPart(decimal, std::string("m=") + whole)) << whole;
    }
    for (const char* whole :
         {"0x15", "0xA5", "0x1.8p3", "1d-3", "1.5D3", "1\u00A0234", "1.5e\u22123", "\u22125",
          "1\u2019234", "1.5-103", "0.-103", ".15+102", "\u20135", "\uFF0D5"}) {
        EXPECT_TRUE(isPart("([0-9]+)$", std::string("m= ") + whole)) << whole;
    }
    EXPECT_EQ(errorOfPattern("m=([0-9.]+)", "m=1.5 x 10^3 s"),
              "metric 'm': its pattern finds '1.5' of '1.5 x 10^3'; allowed: a whole number, or a "
              "pattern with ' x [0-9]+\\^[0-9]+' behind its group");
    // Read where the pattern takes all of it.
    EXPECT_EQ(numberOf("m=([0-9.dD+-]+)", "m=1.5D+03"), 1500.0);
    EXPECT_EQ(numberOf("m=([0-9.dD+-]+)", "m=25d-2 s"), 0.25);
    EXPECT_EQ(errorOfPattern("m=(\\S+)", "m=0.5-100"),  // may be a range
              "metric 'm': its pattern finds '0.5-100'; allowed: a number");
    EXPECT_EQ(numberOf("m=(\\S+)", "m=\u22125"), -5.0);
    EXPECT_EQ(numberOf("m=(\\S+)", "m=5e\u20133"), 5e-3);
    EXPECT_EQ(numberOf("([0-9.]+) ms", "10\u201320 ms"), 20.0);
    // Whole ones: sizes, days, names, products, blanks between columns.
    EXPECT_EQ(numberOf("x([0-9]+)$", "10x1080"), 1080.0);
    EXPECT_EQ(numberOf("([0-9]+)x", "16x10 tiles"), 16.0);
    EXPECT_EQ(numberOf("([0-9.]+)-", "1.5-20 ms"), 1.5);
    EXPECT_EQ(numberOf("-([0-9]+)", "100-103"), 103.0);
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=5d per h"), 5.0);
    EXPECT_EQ(numberOf("([0-9]+)$", "conv2d5"), 5.0);
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=3\u00A0ms"), 3.0);
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=1\u00A02\u00A03"), 1.0);
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=4 \u00B1 1"), 4.0);
}

TEST(Patterns, TakeNoPartOfATimeOrAFraction) {
    const std::string digits = "m=([0-9]+)", decimal = "m=([0-9.]+)";
    for (const char* whole :
         {"1:23.45", "1/2", "2^10", "2^-3", "2**10", "12\u00B75", "12\u066B5", "12\u00BD",
          "10\u00B2", "0b11", "0o17", "1h30", "1x2", "1.#QNAN", "5k", "5M", "16#FF"}) {
        const std::string token(whole);
        const std::string part = token.substr(0, token.find_first_not_of("0123456789"));
        EXPECT_EQ(partIn(digits, "m=" + token + " rays"), partOf(part, token));
    }
    EXPECT_EQ(partIn(decimal, "m=1.#INF"), partOf("1.", "1.#INF"));
    EXPECT_EQ(partIn(decimal, "m=1.5x10-3"), partOf("1.5", "1.5x10-3"));
    EXPECT_EQ(partIn(decimal, "m=1.5\u00D710-3"), partOf("1.5", "1.5\u00D710-3"));
    EXPECT_EQ(partIn("took: .*?([0-9.]+)$", "took: 00:01:23.45"), partOf("23.45", "00:01:23.45"));
    EXPECT_EQ(partIn("([0-9.]+)s?$", "took 1:23.45"), partOf("23.45", "1:23.45"));
    EXPECT_EQ(partIn("([0-9]+)$", "m= 1/2"), partOf("2", "1/2"));
    EXPECT_EQ(partIn("([0-9]+)$", "m= 2^10"), partOf("10", "2^10"));
    // Whole ones: units, names, and what the pattern names.
    for (const char* unit :
         {"ms", "s", "MB", "m", "GiB", "/s", " K", "m2", "cm3", "%", ":", "#", "/", "kHz", "f"}) {
        EXPECT_EQ(numberOf(decimal, std::string("m=2.5") + unit), 2.5) << unit;
    }
    EXPECT_EQ(numberOf("#([0-9]+)", "frame #12"), 12.0);
    EXPECT_EQ(numberOf("([0-9.]+) ms", "GPU0:12.5 ms"), 12.5);
    EXPECT_EQ(numberOf("([0-9.]+) ms", "frame:12.5 ms"), 12.5);
    EXPECT_EQ(numberOf("[0-9]+: ?([0-9.]+) ms", "3:12.5 ms"), 12.5);
    EXPECT_EQ(numberOf("([0-9]+)/[0-9]+", "tile 3/10"), 3.0);
    EXPECT_EQ(numberOf("([0-9]+)\\/", "tile 3/10"), 3.0);
    EXPECT_EQ(numberOf("m([0-9.]+)s", "0m1.234s"), 1.234);
    EXPECT_EQ(numberOf("m=([0-9]+)k", "m=5k"), 5.0);
    EXPECT_EQ(numberIn("m=5M rays", {"m", digits, 1e6}), 5e6);
}

TEST(Patterns, TakeNoPartOfWhatHasBlanks) {
    const std::string digits = "m=([0-9]+)";
    EXPECT_EQ(partIn(digits, "m=1 234"), partOf("1", "1 234"));
    EXPECT_EQ(partIn(digits, "m=12 345 678 rays"), partOf("12", "12 345 678"));
    EXPECT_EQ(partIn("m=(-?[0-9.]+)", "m=-1 234.5 s"), partOf("-1", "-1 234.5"));
    EXPECT_EQ(partIn(digits, "m=12 5/8"), partOf("12", "12 5/8"));
    EXPECT_EQ(partIn(digits, "m=12 \u00BD in"), partOf("12", "12 \u00BD"));
    EXPECT_EQ(partIn(digits, "m=5 / 8 in"), partOf("5", "5 / 8"));
    EXPECT_EQ(partIn(digits, "m=1&nbsp;234"), partOf("1", "1&nbsp;234"));
    EXPECT_EQ(partIn("([0-9]+) ms", "Frame 1 100 ms"), partOf("100", "1 100"));
    EXPECT_EQ(partIn("([0-9]+)$", "m= 1 234"), partOf("234", "1 234"));
    EXPECT_EQ(partIn("([0-9.]+) s", "took 12 345 678.5 s"), partOf("678.5", "12 345 678.5"));
    EXPECT_EQ(partIn("([0-9]+).*rays", "m= 1 234 rays"), partOf("1", "1 234"));
    EXPECT_EQ(partIn("m=([0-9.]+)", "m=1.5 e-3 s"), partOf("1.5", "1.5 e-3"));
    EXPECT_EQ(partIn("m=([0-9.]+)", "m=1.5e +03"), partOf("1.5", "1.5e +03"));
    EXPECT_EQ(partIn("m=([0-9.]+)", "m=1.5(2)e3"), partOf("1.5", "1.5(2)e3"));
    EXPECT_EQ(partIn("([0-9]+) ms", "took 3.2E 2 ms"), partOf("2", "3.2E 2"));
    EXPECT_EQ(partIn("(-?[0-9]+)$", "m= 1.5 e-3"), partOf("-3", "1.5 e-3"));
    for (const char* whole : {"3Mi", "5 Ki", "3 k", "2.5 M", "4 million", "3mio", "2 billion"}) {
        const std::string text(whole);
        EXPECT_EQ(partIn("m=([0-9.]+)", "m=" + text + " rays"),
                  partOf(text.substr(0, text.find_first_not_of("0123456789.")), text));
        EXPECT_EQ(numberOf("m=([0-9.]+) ?" + text.substr(text.find_first_not_of("0123456789. ")),
                           "m=" + text),
                  std::stod(text));
    }
    for (const char* whole :
         {"12 Mio", "3 Mrd", "1.2 Billion", "3 Thousand", "4 mln", "2 tsd", "5 Tera", "1.5P",
          "1.5 D+3", "1.5 (12) e3", "1.5 10^3", "5*1000", "5 \u2153", "5\u2155", "1\u2005234",
          "1\u205F234", "1\u00B4234", "1\u2032234"}) {
        const std::string text(whole);
        EXPECT_NE(partIn("m=([0-9.]+)", "m=" + text + " rays"), "no error") << whole;
    }
    EXPECT_EQ(numberIn("m=12 Mio", {"m", digits, 1e6}), 12e6);
    EXPECT_EQ(numberIn("m=12 Kilo", {"m", digits, 1000.0}), 12e3);
    EXPECT_EQ(numberIn("m=3Ki", {"m", digits, 1024.0}), 3072.0);
    EXPECT_EQ(numberIn("m=3 million", {"m", digits, 1e6}), 3e6);
    for (const char* text :
         {"m=3M", "m=3Mi", "m=3 M", "m=3 thousand"}) {  // of which a k is the scale
        EXPECT_NE(errorText([&] { numberIn(text, {"m", digits, 1024.0}); }), "no error") << text;
    }
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=3 MiB"), 3.0);
    EXPECT_EQ(numberOf("m=([0-9]+)", "m=3 e2e"), 3.0);
    // Columns, and what the pattern names.
    for (const char* column :
         {" 12", " 1.5", " 1234", "  234", "\t234", " x", " 128x128", ", 234"}) {
        EXPECT_EQ(numberOf(digits, std::string("m=1") + column), 1.0) << column;
    }
    EXPECT_EQ(numberOf("m=([0-9.]+)", "m=12.5 128"), 12.5);
    EXPECT_EQ(numberOf(digits, "m=1024 128"), 1024.0);
    EXPECT_EQ(partIn("^([0-9]+) ", "128 256 512"), partOf("128", "128 256 512"));
    EXPECT_EQ(numberOf("^([0-9]+)\\s+[0-9]+ +[0-9]+", "128 256 512"), 128.0);
    EXPECT_EQ(numberOf("^[0-9]+ ([0-9]+)\\s", "128 256 512"), 256.0);
    EXPECT_EQ(numberOf("^[0-9]+ +[0-9]+\\s+([0-9]+)", "128 256 512"), 512.0);
    EXPECT_EQ(numberOf("([0-9]+) ms", "GPU0 128 ms"), 128.0);
    EXPECT_EQ(numberOf("([0-9]+) ms", "10:32:05 120 ms"), 120.0);
    EXPECT_EQ(numberOf("([0-9]+) ms", "12/20 200 ms"), 200.0);
    EXPECT_EQ(numberOf("scene\\s+[0-9]+\\s+([0-9]+)", "scene 1 5 100"), 5.0);
    EXPECT_EQ(numberOf("([0-9]+) ms", "grid 4 e 3 ms"), 3.0);
    EXPECT_EQ(numberOf("Frame \\d+ (\\d+) ms", "Frame 1 100 ms"), 100.0);
    // What may be absent, a blank, a colon and a unit of time name nothing.
    for (const auto& [regex, line] : std::vector<std::pair<std::string, std::string>>{
             {"time: ([0-9]+).*ms", "time: 12.5 ms"},
             {"m=([0-9.]+)\\D", "m=1.5D+03"},
             {"m=([0-9]+),?", "m=1,234"},
             {"m=([0-9]+)\\.?", "m=12.5"},
             {"m=([0-9]+)k?", "m=5k"},
             {"([0-9]+) minutes?", "2 minutes 3 seconds"},
             {"([0-9]+)m\\b", "2m 3s"},
             {"GPU0 ([0-9.]+)", "GPU0 2 min 3 s"},
             {"GPU0 ([0-9.]+)", "GPU0 5 million rays"},
             {"GPU0 ([0-9.]+)", "GPU0 1 234 rays"},
             {"Frame [0-9]+ ([0-9.]+)", "Frame 12 1.5 e-3 s"},
             {"(-?[0-9.]+) ms", "10-20 ms"},
             {"(-?[0-9]+)$", "img-0005"},
             {"([0-9.]+)$", "out.12"},
             {" ([0-9]+) ms", "took 1 234 ms"},
             {"m=([0-9]+)\\s", "m=1 234 rays"},
             {" ([0-9.]+) s", "took 2 min, 30 s"},
             {":\\s*([0-9.]+)$", "took: 1:23.45"},
             {"m=([0-9]+)", "m=10\u207B\u2075"},
             {"m=([0-9]+)", "m=10**-3"},
             {"m=([0-9]+)", "m=10 ^ 3"},
             {"m=([0-9]+)", "m=2 Minuten 5 s"}}) {
        EXPECT_NE(partIn(regex, line), "no error") << regex << " of " << line;
    }
    for (const auto& [regex, line] :
         std::vector<std::pair<std::string, std::string>>{{"v4\\.([0-9]+)", "v4.12"},
                                                          {"shot1[.]([0-9]+)", "shot1.12.exr"},
                                                          {"[/]([0-9]+)", "3/12"},
                                                          {"([0-9.]+) ms", "GPU: 250 W, 12 ms"},
                                                          {"([0-9]+) ms", "16M 12 ms"},
                                                          {"FFT 3D ([0-9]+)", "FFT 3D 12 ms"},
                                                          {"-([0-9]+)", "0-12"},
                                                          {"^([0-9]+)-", "12-255"}}) {
        EXPECT_EQ(numberOf(regex, line), 12.0) << regex << " of " << line;
    }
    EXPECT_EQ(numberOf("tile ([0-9]+) / ", "tile 3 / 10"), 3.0);
    EXPECT_EQ(numberOf("\\[(\\d+)/\\d+\\]", "[3/10]"), 3.0);
    EXPECT_EQ(numberOf("^(?:[^,]*,){2}([0-9.]+)", "a,1,2.5,3"), 2.5);
    EXPECT_EQ(numberOf("\\(([0-9.]+) s\\)", "12 min (720.0 s)"), 720.0);
    EXPECT_EQ(numberOf("rmse=([0-9.]+)", "rmse=0.5 psnr=30"), 0.5);
    EXPECT_EQ(numberOf("([0-9]+)%", "12%"), 12.0);
    EXPECT_EQ(numberOf("n=([0-9]+)\u00D7", "n=16\u00D716"), 16.0);
}

/// What is beside a number and not understood is a part of it.
TEST(Patterns, TakeNoPartOfWhatTheyDoNotUnderstand) {
    for (const std::string whole : {"0.000 012",
                                    "0.123 456",
                                    "2m 3,5s",
                                    "2 min    3 s",
                                    "2 min\t3 s",
                                    "1 h 30",
                                    "2 min 30",
                                    "1-02:03:04",
                                    "1.5 h 3 s",
                                    "1 year 2 days",
                                    "2 minute(s) 3 s",
                                    "1.5(2)\u00D710^3",
                                    "1.5Q+03",
                                    "1.5b-3",
                                    "10^{3}",
                                    "10^(3)",
                                    "1.5*^-3",
                                    "3+4i",
                                    "1.5 + 2i",
                                    "1\u2003234",
                                    "1\u3000234",
                                    "1\u200B234",
                                    "1\uFEFF234",
                                    "1&thinsp;234",
                                    "1&#8239;234",
                                    "1\\,234",
                                    "1{,}234",
                                    "1\uFF0C234",
                                    "12\uFF0E5",
                                    "12\uFF155",
                                    "12\u0665",
                                    "5\u4E07",
                                    "5\u22158",
                                    "5\u00F78",
                                    "5 \u00F7 8",
                                    "12-1/2",
                                    "12 and 1/2",
                                    "5&frasl;8",
                                    "0.(3)",
                                    "12\u00B030'",
                                    "5 Millionen",
                                    "5 Milliarden",
                                    "5 hundred",
                                    "5 dozen",
                                    "5-million",
                                    "1.5 * 1e3",
                                    "1.5 \u2219 10^3",
                                    "1.5\u23E83",
                                    "1.5 \u00B1 0.2 x10^3",
                                    "12\b5"}) {
        const std::string first = whole.substr(0, whole.find_first_not_of("0123456789."));
        EXPECT_THAT(
            partIn("m=([0-9.]+)", "m=" + whole + ", n"),
            testing::StartsWith("metric 'm': its pattern finds '" + first + "' of '" + first));
    }
    for (const char* latin1 : {"1\xA0"
                               "234",
                               "12\xB7"
                               "5",
                               "12\xBD", "10\xB3",
                               "1.5\xD7"
                               "10^3",
                               "12\xB2"}) {
        EXPECT_NE(partIn("m=([0-9.]+)", std::string("m=") + latin1), "no error");
    }
    EXPECT_EQ(partIn("([0-9.]+) ?s", "took 2m 3,5s"),
              "metric 'm': its pattern finds '5' of '2m 3,5s'");
    EXPECT_EQ(partIn("([0-9.]+)S$", "PT1M3.5S"), partOf("3.5", "PT1M3.5S"));
    EXPECT_EQ(numberOf("PT([0-9.]+)S", "PT0.5S"), 0.5);
    EXPECT_EQ(numberOf("M([0-9.]+)S", "PT1M3.5S"), 3.5);
    // The number of a name is one.
    for (const auto& [regex, line] :
         std::vector<std::pair<std::string, std::string>>{{"t([0-9]+)", "t1,234"},
                                                          {"T([0-9.]+)", "T1.5e-3"},
                                                          {"time([0-9.]+)", "time1.5e3"},
                                                          {"t([0-9]+)", "t1:23.4"},
                                                          {"took([0-9.]+)", "took1h 2m 3s"},
                                                          {"n([0-9]+)", "n1\u00A0234"},
                                                          {"([0-9]+) ms", "n12,5 ms"},
                                                          {"([0-9.]+) ms", "lod-2\u202F345 ms"},
                                                          {"total, ([0-9]+)", "total, 1,234 rays"},
                                                          {"Total 3 ([0-9]+)", "Total 3 1 234"},
                                                          {"([0-9]+)k? rays", "5k rays"},
                                                          {"m=-?([0-9]+)", "m=-5"},
                                                          {".* ([0-9]+) ms", "took 1 234 ms"},
                                                          {"([0-9]+) m", "5 million"},
                                                          {"([0-9.]+)e", "5e3"},
                                                          {"([0-9.]+)", "trace.....1.5e3"}}) {
        EXPECT_NE(partIn(regex, line), "no error") << regex << " of " << line;
    }
}

TEST(Patterns, TakeWhatIsWhole) {
    for (const auto& [regex, line] : std::vector<std::pair<std::string, std::string>>{
             {"([0-9.]+) ms", "at 10 m, 12 ms"},
             {"([0-9.]+) ms", "total 10 s / 12 ms per frame"},
             {"([0-9.]+) ms", "total 10 s / 12 ms"},
             {"([0-9.]+) ms/frame", "10 s, 12 ms/frame"},
             {"([0-9.]+) ms", "5 s +-12 ms"},
             {"([0-9.]+) ms", "2D 12 ms"},
             {"([0-9]+)/100", "Epoch 2 12/100"},
             {"m=([0-9.]+)", "m=12in2"},
             {"m=([0-9.]+)", "m=12kgCO2"},
             {"m=([0-9.]+)", "m=12 T"},
             {"m=([0-9.]+)", "m=12.0."},
             {"m=([0-9.]+)", "m=12\u00B5s"},
             {"m=([0-9.]+)", "m=12\u20AC"},
             {"m=([0-9.]+)", "m=12\u2033"},
             {"([0-9.]+) ms", "trace.....12 ms"},
             {"([0-9.]+) ms", "\u23F1\uFE0F12 ms"},
             {"([0-9.]+) ms", "\u250212 ms\u2502"},
             {"m=([0-9.]+)", "m=12\u00A0ms"},
             {"([0-9]+)(?=/)", "12/20"},
             {"([0-9]+)(?: of|/)", "12/20"},
             {"[,;]([0-9.]+)$", "1,12"},
             {"^([0-9.]+)[,;]", "12,5"},
             {"([0-9]+)[x:]", "12x10"},
             {"\\[([0-9.]+)[,\\]]", "[12,1]"},
             {"BM\\S+ +([0-9.]+) ns", "BM_x/64 12 ns"}}) {
        EXPECT_EQ(numberOf(regex, line), 12.0) << regex << " of " << line;
    }
    // Of a name, a date, a path, the digits are none of a number.
    for (const char* before :
         {"bunny-2", "CUDA-12", "2026-11-30", "bunny_2", "BM_x/64", "#4", "x264", "10-12"}) {
        EXPECT_EQ(numberOf("([0-9.]+) ms", std::string(before) + " 345 ms"), 345.0) << before;
    }
    EXPECT_EQ(numberOf("m=([0-9.]+)", "m=6500K"), 6500.0);
}

TEST(Patterns, ThatAnErrorAsksForAreRead) {
    struct Case {
        const char *regex, *line, *allowed, *better;
        double value;
    };
    const std::string with = ", or a pattern with ", group = " its group";
    for (const Case& each : std::vector<Case>{
             {"([0-9]+) ms", "Frame 1 100 ms", "'[0-9]+ ' before", "[0-9]+ ([0-9]+) ms", 100.0},
             {"m=([0-9]+)", "m=12,5", "',[0-9]+' behind", "m=([0-9]+),[0-9]+", 12.0},
             {"m=([0-9.]+)", "m=1.5e-03", "'e-[0-9]+' behind", "m=([0-9.]+)e-[0-9]+", 1.5},
             {"([0-9]+)$", "took: 1:23", "'[0-9]+:' before", "[0-9]+:([0-9]+)$", 23.0},
             {"m=([0-9]+)", "m=5 million", "' million' behind", "m=([0-9]+) million", 5.0},
             {"m=([0-9]+)", "m=2m 3s", "'m [0-9]+s' behind", "m=([0-9]+)m [0-9]+s", 2.0},
             {"([0-9]+) s", "2 min, 30 s", "'[0-9]+ min, ' before", "[0-9]+ min, ([0-9]+) s", 30.0},
             {"h ([0-9.]+)", "1h 2m 3s", "'[0-9]+h ' before and 'm [0-9]+s' behind",
              "[0-9]+h ([0-9.]+)m [0-9]+s", 2.0},
             {"([0-9]+)$", "m=5\u22158", "'[0-9]+\u2215' before", "[0-9]+\u2215([0-9]+)$", 8.0},
             {"(-?[0-9]+)$", "10-20", "'-' before", "-([0-9]+)$", 20.0},
             {"([0-9]+) 567", "1 234 567 x", "'[0-9]+ ' before and ' [0-9]+' behind",
              "[0-9]+ ([0-9]+) [0-9]+", 234.0}}) {
        EXPECT_THAT(errorOfPattern(each.regex, each.line),
                    testing::EndsWith("; allowed: a whole number" + with + each.allowed + group));
        EXPECT_EQ(numberOf(each.better, each.line), each.value) << each.better;
    }
    EXPECT_THAT(errorOfPattern("m=([0-9]{2})", "m=123"),
                testing::EndsWith("; allowed: a whole number"));
}

TEST(Patterns, WhatMovesTheCursorPartsNumbers) {
    const std::string digits = "m=([0-9]+)";
    EXPECT_EQ(numberOf(digits, "\x1b[1;32mm=\x1b[0m12\x1b[38:5:1m5\x1b[m"), 125.0);
    for (const char* step : {"1C", "2D", "K", "5;10H", "A", "2J", "4P", "?25l"}) {
        EXPECT_EQ(numberOf(digits, std::string("m=5\x1b[") + step + "6 x"), 5.0) << step;
    }
    EXPECT_EQ(numberOf(digits, "m=5\x1b[>4;1m6"), 56.0);
    EXPECT_EQ(numberOf(digits, "m=5\x1b[4"), 5.0);
    EXPECT_EQ(partIn(digits, "m=12\x1b(B\x1b[m.5"), partOf("12", "12.5"));  // as of `tput sgr0`
}

TEST(Patterns, TakeNoPartOfATimeOfSeveralUnits) {
    const std::string seconds = "([0-9.]+) ?s";
    EXPECT_EQ(partIn(seconds, "took 1h 2m 3s"), partOf("3", "1h 2m 3s"));
    EXPECT_EQ(partIn(seconds, "took 0m1.234s"), partOf("1.234", "0m1.234s"));
    EXPECT_EQ(partIn("real ([0-9.]+)", "real 0m1.234s"), partOf("0", "0m1.234s"));
    EXPECT_EQ(partIn(seconds, "real\t1m 2.35s"), partOf("2.35", "1m 2.35s"));
    EXPECT_EQ(partIn(seconds, "2 minutes and 5 seconds"), partOf("5", "2 minutes and 5 seconds"));
    EXPECT_EQ(partIn(seconds, "took 3 min, 2.5 s."), partOf("2.5", "3 min, 2.5 s"));
    EXPECT_EQ(partIn("([0-9.]+) ms", "2 s 300 ms"), partOf("300", "2 s 300 ms"));
    EXPECT_EQ(partIn("([0-9.]+) us", "2 ms 300 us"), partOf("300", "2 ms 300 us"));
    EXPECT_EQ(partIn("m=([0-9]+)", "m=1h 30m"), partOf("1", "1h 30m"));
    EXPECT_EQ(partIn("m=([0-9]+)", "m=5d 3h"), partOf("5", "5d 3h"));
    EXPECT_EQ(partIn("([0-9]+)m", "took 2m3s"), partOf("2", "2m3s"));
    for (const char* whole :
         {"3 sec 200 msec", "3 seconds 200 milliseconds", "3 s; 20 ms", "3s:200ms", "3 s + 20 ms",
          "3 Min 5 Sek", "3 days, 2:03:04", "3 weeks 2 days", "3 s  200 ms"}) {
        EXPECT_NE(partIn("m=([0-9]+)", std::string("m=") + whole), "no error") << whole;
    }
    for (const char* whole :
         {"1 hr. 5 min. 3 s", "1 Min. 3 s", "1 Std 3 s", "1m:03 s", "1min+3 s", "-1m 3s",
          "1 week 3 s", "1 h & 3 s", "1h_3s", "1h-3s", "1 h / 3 s", "1 h und 3 s"}) {
        EXPECT_NE(partIn("([0-9]+) ?s$", std::string("took ") + whole), "no error") << whole;
    }
    // Each with a pattern of its own, columns, and times of one unit.
    EXPECT_EQ(numberOf("([0-9]+)h [0-9]+m", "took 1h 2m 3s"), 1.0);
    EXPECT_EQ(numberOf("h ([0-9]+)m [0-9]+", "took 1h 2m 3s"), 2.0);
    EXPECT_EQ(numberOf("m ([0-9]+)s", "took 1h 2m 3s"), 3.0);
    EXPECT_EQ(numberOf(seconds, "GPU 2 ms 3 s"), 3.0);
    EXPECT_EQ(numberOf(seconds, "frame 12 30 s"), 30.0);
    EXPECT_EQ(numberOf(seconds, "v2 3 s"), 3.0);
    EXPECT_EQ(numberOf("([0-9.]+) ms", "1.5 s 300 ms"), 300.0);
    EXPECT_EQ(numberOf("([0-9.]+) ?min", "12 min"), 12.0);
}

}  // namespace
}  // namespace gfxrepro::external
