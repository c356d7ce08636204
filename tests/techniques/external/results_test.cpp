#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "techniques/external/results.h"
#include "tests/support/support.h"
#include "tests/techniques/technique_recorder.h"

namespace gfxrepro::external {
namespace {

using test::errorText;
using test::TemporaryFolder;

std::vector<GivenMetric> metricsOf(const std::string& text, int frame = 0) {
    const TemporaryFolder folder;
    return metricsIn(folder.write("metrics.jsonl", text), frame);
}

std::string errorOf(const std::string& text) {
    return errorText([&] { metricsOf(text); });
}

TEST(MetricLines, AreReadInTheirOrder) {
    const auto metrics = metricsOf(
        "{\"metric\": \"rays\", \"value\": 12, \"unit\": \"ray\"}\n\n"
        "{\"metric\":\"time\",\"pass\":\"trace\",\"frame\":3,\"value\":1.5,\"unit\":\"ms\"}",
        3);
    ASSERT_EQ(metrics.size(), 2U);
    EXPECT_EQ(metrics[0].metric, "rays");
    EXPECT_EQ(metrics[0].value, 12.0);
    EXPECT_EQ(metrics[0].unit, "ray");
    EXPECT_EQ(metrics[0].pass, "");
    EXPECT_EQ(metrics[1].pass, "trace");
    EXPECT_EQ(metrics[1].value, 1.5);
    EXPECT_TRUE(metricsOf("").empty());
}

TEST(MetricLines, RefusesOthersByTheirNumber) {
    const std::string good = "{\"metric\": \"rays\", \"value\": 12, \"unit\": \"ray\"}\n";
    EXPECT_EQ(errorOf(good + "rays 12\n"), "line 2 of its metrics is no JSON object: rays 12");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": NaN, \"unit\": \"ray\"}"),
              "line 1 of its metrics is no JSON object, which has no NaN and no Infinity: "
              "{\"metric\": \"rays\", \"value\": NaN, \"unit\": \"ray\"}");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": null, \"unit\": \"ray\"}"),
              "line 1 of its metrics: \"value\" is null; allowed: a number");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": 1}"),
              "line 1 of its metrics: no \"unit\"; allowed: text");
    EXPECT_EQ(errorOf("{\"metric\": 7, \"value\": 1, \"unit\": \"1\"}"),
              "line 1 of its metrics: \"metric\" is 7; allowed: text");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"frame\": 1, \"value\": 1, \"unit\": \"ray\"}"),
              "line 1 of its metrics: \"frame\" is 1; it was asked for frame 0");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"vlaue\": 1, \"unit\": \"ray\"}"),
              "line 1 of its metrics: unknown key \"vlaue\"; allowed: metric, pass, frame, value, "
              "unit");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"value\": 1, \"value\": 2, \"unit\": \"ray\"}"),
              "line 1 of its metrics: \"value\" stands twice");
    EXPECT_EQ(errorOf("{\"metric\": \"rays\", \"val"),
              "line 1 of its metrics is no JSON object: {\"metric\": \"rays\", \"val");
}

TEST(MetricLines, OfSeveralFramesEachSaysItsOwn) {
    const TemporaryFolder folder;
    const auto metricsOfThree = [&](const std::string& text) {
        return metricsIn(folder.write("metrics.jsonl", text), 0, 3);
    };
    const auto line = [](const std::string& frame) {
        return "{\"metric\":\"rays\",\"pass\":\"trace\",\"frame\":" + frame +
               ",\"value\":7,\"unit\":\"ray\"}\n";
    };
    const auto metrics = metricsOfThree(line("2") + line("0") + line("1.0"));
    ASSERT_EQ(metrics.size(), 3U);
    EXPECT_EQ(metrics[0].frame, 2);
    EXPECT_EQ(metrics[0].value, 7.0);
    EXPECT_EQ(metrics[1].frame, 0);
    EXPECT_EQ(metrics[2].frame, 1);
    const auto errorOfThree = [&](const std::string& text) {
        return errorText([&] { metricsOfThree(text); });
    };
    const std::string head = "line 1 of its metrics: \"frame\" is ";
    for (const std::string bad : {"3", "-1", "0.5", "\"1\"", "[0]", "1e300"}) {
        EXPECT_TRUE(errorOfThree(line(bad)).starts_with(head)) << bad;
        EXPECT_TRUE(errorOfThree(line(bad)).ends_with("; allowed: 0 … 2")) << bad;
    }
    EXPECT_EQ(errorOfThree("{\"metric\": \"rays\", \"value\": 7, \"unit\": \"ray\"}"),
              "line 1 of its metrics: no \"frame\"; allowed: 0 … 2");
}

TEST(MetricLines, RefusesOneThatIsTooDeep) {
    const std::string deep = "{\"metric\":" + std::string(2'000'000, '[');
    EXPECT_EQ(errorOf(deep), "line 1 of its metrics has more than 200 brackets in each other: " +
                                 deep.substr(0, 80) + "…");
    const std::string closed = deep + std::string(2'000'000, ']') + "}";
    EXPECT_EQ(errorOf(closed), errorOf(deep));
}

TEST(MetricLines, RefusesAFileThatIsGoneOrNoPlainOne) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "metrics.jsonl";
    const auto error = [&] { return errorText([&] { metricsIn(file, 0); }); };
    EXPECT_EQ(error(), "its file of metrics, metrics.jsonl, is gone; it is there to be added to");
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    const std::string notPlain =
        "its file of metrics, metrics.jsonl, is no plain file any more; it is there to be added to";
    EXPECT_EQ(error(), notPlain);
    std::filesystem::remove(file);
    std::filesystem::create_symlink(folder.write("other", ""), file);
    EXPECT_EQ(error(), notPlain);
}

TEST(MetricLines, APatternTakesItsLastMatch) {
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

TEST(MetricLines, APatternSearchesLinesOfAnyLength) {
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

TEST(MetricLines, ALineThatAPatternCannotSearchIsAnError) {
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

TEST(MetricLines, APatternsNumberIsScaled) {
    const std::string regex = R"(Trace Time: .*\(([0-9.]+) seconds\))";
    const std::string line = "  Trace Time:       0 hours  0 minutes  1 seconds (1.234 seconds)\n";
    EXPECT_DOUBLE_EQ(numberIn(line, {"trace_ms", regex, 1000.0}).value(), 1234.0);
}

TEST(MetricLines, APatternTakesTheLastMatchOfALineToo) {
    EXPECT_EQ(numberOf("m=(\\d+)", "m=1 m=2 m=3"), 3.0);
    EXPECT_EQ(numberOf("(\\d*)$", "m=1"), 1.0);
}

TEST(MetricLines, APatternTakesNoPartOfANumber) {
    const auto errorOfPattern = [](const std::string& regex, const std::string& line) {
        return errorText([&] { numberIn(line, {"m", regex}); });
    };
    const auto partOf = [](const std::string& part, const std::string& whole) {
        return "metric 'm': its pattern finds '" + part + "' of '" + whole +
               "'; allowed: a whole number, or a pattern that names what stands beside it";
    };
    const std::string digits = "m=([0-9]+)", decimal = "m=([0-9.]+)";
    EXPECT_EQ(errorOfPattern(decimal, "m=1.5e-03"), partOf("1.5", "1.5e-03"));
    EXPECT_EQ(errorOfPattern(decimal, "m=2E7"), partOf("2", "2E7"));
    EXPECT_EQ(errorOfPattern(decimal, "m=1,234.5"), partOf("1", "1,234.5"));
    EXPECT_EQ(errorOfPattern(decimal, "m=1'234"), partOf("1", "1'234"));
    EXPECT_EQ(errorOfPattern(digits, "m=12,5"), partOf("12", "12,5"));
    EXPECT_EQ(errorOfPattern(digits, "m=12.5 s"), partOf("12", "12.5"));
    EXPECT_EQ(errorOfPattern(digits, "m=5.e3"), partOf("5", "5.e3"));
    EXPECT_EQ(errorOfPattern(digits, "m=0x1F"), partOf("0", "0x1F"));
    EXPECT_EQ(errorOfPattern("m=([0-9]{2})", "m=123"), partOf("12", "123"));
    EXPECT_EQ(errorOfPattern("([0-9]+) s", "12.5 s"), partOf("5", "12.5"));
    EXPECT_EQ(errorOfPattern("([0-9]+) s", "in .5 s"), partOf("5", ".5"));
    EXPECT_EQ(errorOfPattern("([0-9]+) rays", "1,234 rays"), partOf("234", "1,234"));
    EXPECT_EQ(errorOfPattern("([0-9]+)$", "m=1e-5"), partOf("5", "1e-5"));
    EXPECT_EQ(errorOfPattern("m=.*?([0-9]+)", "m= -5"), partOf("5", "-5"));
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

TEST(MetricLines, APatternTakesNoPartOfWhatFortranAndTypesettersWrite) {
    const auto isPart = [](const std::string& regex, const std::string& line) {
        return errorText([&] {
                   numberIn(line, {"m", regex});
               })
            .ends_with("; allowed: a whole number, or a pattern that names what stands beside it");
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
    EXPECT_EQ(errorText([] {
                  numberIn("m=1.5 x 10^3 s", {"m", "m=([0-9.]+)"});
              }),
              "metric 'm': its pattern finds '1.5' of '1.5 x 10^3'; allowed: a whole number, or a "
              "pattern that names what stands beside it");
    // Read where the pattern takes all of it.
    EXPECT_EQ(numberOf("m=([0-9.dD+-]+)", "m=1.5D+03"), 1500.0);
    EXPECT_EQ(numberOf("m=([0-9.dD+-]+)", "m=25d-2 s"), 0.25);
    EXPECT_EQ(numberOf("m=(\\S+)", "m=1.5-103"), 1.5e-103);
    EXPECT_EQ(numberOf("m=(\\S+)", "m=-.5+101 s"), -5e100);
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

TEST(MetricLines, APatternTakesNoPartOfATimeOrAFraction) {
    const auto errorOf = [](const std::string& regex, const std::string& line, double scale = 1.0) {
        return errorText([&] { numberIn(line, {"m", regex, scale}); });
    };
    const auto partOf = [](const std::string& part, const std::string& whole) {
        return "metric 'm': its pattern finds '" + part + "' of '" + whole +
               "'; allowed: a whole number, or a pattern that names what stands beside it";
    };
    const std::string digits = "m=([0-9]+)", decimal = "m=([0-9.]+)";
    for (const char* whole :
         {"1:23.45", "1/2", "2^10", "2^-3", "2**10", "12\u00B75", "12\u066B5", "12\u00BD",
          "10\u00B2", "0b11", "0o17", "1h30", "1x2", "1.#QNAN", "5k", "5M", "16#FF"}) {
        const std::string token(whole);
        const std::string part = token.substr(0, token.find_first_not_of("0123456789"));
        EXPECT_EQ(errorOf(digits, "m=" + token + " rays"), partOf(part, token));
    }
    EXPECT_EQ(errorOf(decimal, "m=1.#INF"), partOf("1.", "1.#INF"));
    EXPECT_EQ(errorOf(decimal, "m=1.5x10-3"), partOf("1.5", "1.5x10-3"));
    EXPECT_EQ(errorOf(decimal, "m=1.5\u00D710-3"), partOf("1.5", "1.5\u00D710-3"));
    EXPECT_EQ(errorOf("took: .*?([0-9.]+)$", "took: 00:01:23.45"), partOf("23.45", "00:01:23.45"));
    EXPECT_EQ(errorOf("([0-9.]+)s?$", "took 1:23.45"), partOf("23.45", "1:23.45"));
    EXPECT_EQ(errorOf("([0-9]+)$", "m= 1/2"), partOf("2", "1/2"));
    EXPECT_EQ(errorOf("([0-9]+)$", "m= 2^10"), partOf("10", "2^10"));
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

TEST(MetricLines, APatternTakesNoPartOfWhatHasBlanks) {
    const auto errorOf = [](const std::string& regex, const std::string& line) {
        return errorText([&] { numberIn(line, {"m", regex}); });
    };
    const auto partOf = [](const std::string& part, const std::string& whole) {
        return "metric 'm': its pattern finds '" + part + "' of '" + whole +
               "'; allowed: a whole number, or a pattern that names what stands beside it";
    };
    const std::string digits = "m=([0-9]+)";
    EXPECT_EQ(errorOf(digits, "m=1 234"), partOf("1", "1 234"));
    EXPECT_EQ(errorOf(digits, "m=12 345 678 rays"), partOf("12", "12 345 678"));
    EXPECT_EQ(errorOf("m=(-?[0-9.]+)", "m=-1 234.5 s"), partOf("-1", "-1 234.5"));
    EXPECT_EQ(errorOf(digits, "m=12 5/8"), partOf("12", "12 5/8"));
    EXPECT_EQ(errorOf(digits, "m=12 \u00BD in"), partOf("12", "12 \u00BD"));
    EXPECT_EQ(errorOf(digits, "m=5 / 8 in"), partOf("5", "5 / 8"));
    EXPECT_EQ(errorOf(digits, "m=1&nbsp;234"), partOf("1", "1&nbsp;234"));
    EXPECT_EQ(errorOf("([0-9]+) ms", "Frame 1 100 ms"), partOf("100", "1 100"));
    EXPECT_EQ(errorOf("([0-9]+)$", "m= 1 234"), partOf("234", "1 234"));
    EXPECT_EQ(errorOf("([0-9.]+) s", "took 12 345 678.5 s"), partOf("678.5", "12 345 678.5"));
    EXPECT_EQ(errorOf("([0-9]+).*rays", "m= 1 234 rays"), partOf("1", "1 234"));
    EXPECT_EQ(errorOf("m=([0-9.]+)", "m=1.5 e-3 s"), partOf("1.5", "1.5 e-3"));
    EXPECT_EQ(errorOf("m=([0-9.]+)", "m=1.5e +03"), partOf("1.5", "1.5e +03"));
    EXPECT_EQ(errorOf("m=([0-9.]+)", "m=1.5(2)e3"), partOf("1.5", "1.5(2)e3"));
    EXPECT_EQ(errorOf("([0-9]+) ms", "took 3.2E 2 ms"), partOf("2", "3.2E 2"));
    EXPECT_EQ(errorOf("(-?[0-9]+)$", "m= 1.5 e-3"), partOf("-3", "1.5 e-3"));
    for (const char* whole : {"3Mi", "5 Ki", "3 k", "2.5 M", "4 million", "3mio", "2 billion"}) {
        const std::string text(whole);
        EXPECT_EQ(errorOf("m=([0-9.]+)", "m=" + text + " rays"),
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
        EXPECT_NE(errorOf("m=([0-9.]+)", "m=" + text + " rays"), "no error") << whole;
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
    EXPECT_EQ(errorOf("^([0-9]+) ", "128 256 512"), partOf("128", "128 256 512"));
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
        EXPECT_NE(errorOf(regex, line), "no error") << regex << " of " << line;
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

TEST(MetricLines, WhatMovesTheCursorPartsNumbers) {
    const std::string digits = "m=([0-9]+)";
    EXPECT_EQ(numberOf(digits, "\x1b[1;32mm=\x1b[0m12\x1b[38:5:1m5\x1b[m"), 125.0);
    for (const char* step : {"1C", "2D", "K", "5;10H", "A", "2J", "4P", "?25l"}) {
        EXPECT_EQ(numberOf(digits, std::string("m=5\x1b[") + step + "6 x"), 5.0) << step;
    }
    EXPECT_EQ(numberOf(digits, "m=5\x1b[>4;1m6"), 56.0);
    EXPECT_EQ(numberOf(digits, "m=5\x1b[4"), 5.0);
}

TEST(MetricLines, APatternTakesNoPartOfATimeOfSeveralUnits) {
    const auto errorOf = [](const std::string& regex, const std::string& line) {
        return errorText([&] { numberIn(line, {"m", regex}); });
    };
    const auto partOf = [](const std::string& part, const std::string& whole) {
        return "metric 'm': its pattern finds '" + part + "' of '" + whole +
               "'; allowed: a whole number, or a pattern that names what stands beside it";
    };
    const std::string seconds = "([0-9.]+) ?s";
    EXPECT_EQ(errorOf(seconds, "took 1h 2m 3s"), partOf("3", "1h 2m 3s"));
    EXPECT_EQ(errorOf(seconds, "took 0m1.234s"), partOf("1.234", "0m1.234s"));
    EXPECT_EQ(errorOf("real ([0-9.]+)", "real 0m1.234s"), partOf("0", "0m1.234s"));
    EXPECT_EQ(errorOf(seconds, "real\t1m 2.35s"), partOf("2.35", "1m 2.35s"));
    EXPECT_EQ(errorOf(seconds, "2 minutes and 5 seconds"), partOf("5", "2 minutes and 5 seconds"));
    EXPECT_EQ(errorOf(seconds, "took 3 min, 2.5 s."), partOf("2.5", "3 min, 2.5 s"));
    EXPECT_EQ(errorOf("([0-9.]+) ms", "2 s 300 ms"), partOf("300", "2 s 300 ms"));
    EXPECT_EQ(errorOf("([0-9.]+) us", "2 ms 300 us"), partOf("300", "2 ms 300 us"));
    EXPECT_EQ(errorOf("m=([0-9]+)", "m=1h 30m"), partOf("1", "1h 30m"));
    EXPECT_EQ(errorOf("m=([0-9]+)", "m=5d 3h"), partOf("5", "5d 3h"));
    EXPECT_EQ(errorOf("([0-9]+)m", "took 2m3s"), partOf("2", "2m3s"));
    for (const char* whole :
         {"3 sec 200 msec", "3 seconds 200 milliseconds", "3 s; 20 ms", "3s:200ms", "3 s + 20 ms",
          "3 Min 5 Sek", "3 days, 2:03:04", "3 weeks 2 days", "3 s  200 ms"}) {
        EXPECT_NE(errorOf("m=([0-9]+)", std::string("m=") + whole), "no error") << whole;
    }
    for (const char* whole :
         {"1 hr. 5 min. 3 s", "1 Min. 3 s", "1 Std 3 s", "1m:03 s", "1min+3 s", "-1m 3s",
          "1 week 3 s", "1 h & 3 s", "1h_3s", "1h-3s", "1 h / 3 s", "1 h und 3 s"}) {
        EXPECT_NE(errorOf("([0-9]+) ?s$", std::string("took ") + whole), "no error") << whole;
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

using image::ImageF;
using test::errorText;
using test::TemporaryFolder;

std::filesystem::path writeExr(const TemporaryFolder& folder, const std::string& name,
                               const ImageF& image) {
    image::ExrImage exr;
    exr.add(image, {"R", "G", "B"}, image::ExrPixelType::Float);
    image::writeExr(folder.path() / name, exr);
    return folder.path() / name;
}

std::filesystem::path writePng(const TemporaryFolder& folder, const std::string& name, int width,
                               std::uint8_t value) {
    image::writePng(folder.path() / name, image::Image8(width, 16, 3, value));
    return folder.path() / name;
}

using Pictures = test::FolderTest;

/// As it is compared, and what is recorded: sRGB 0.4 in linear light.
TEST_F(Pictures, APngIsComparedAsItIsStored) {
    const Picture test = readPicture(writePng(folder, "p.png", 16, 102), "p");
    EXPECT_FLOAT_EQ(test.stored.at(0, 0), 0.4F);
    EXPECT_NEAR(test.linear.at(0, 0), 0.1329, 1e-4);
}

TEST_F(Pictures, GreyKeepsItsAlpha) {
    image::ExrImage exr;
    exr.add(ImageF(4, 4, 1, 0.25F), {"Y"});
    exr.add(ImageF(4, 4, 1, 0.5F), {"A"});
    image::writeExr(folder.path() / "a.exr", exr);
    const Picture light = readPicture(folder.path() / "a.exr", "p");
    ASSERT_EQ(light.stored.channels(), 2);
    EXPECT_EQ(light.stored.at(1, 1, 0), 0.25F);
    EXPECT_EQ(light.linear.at(1, 1, 1), 0.5F);
}

TEST_F(Pictures, RefusesHalfAndWrongOnes) {
    const auto errorOf = [&](const std::filesystem::path& file, glm::ivec2 size = {0, 0}) {
        return errorText([&] { readPicture(file, "image 'result'", size); }, folder.path());
    };
    EXPECT_EQ(errorOf(folder.path() / "none.exr"), "image 'result': there is no file none.exr");
    EXPECT_EQ(errorOf(folder.path()),
              "image 'result': " + folder.path().filename().string() + " is a folder, no file");
    ASSERT_EQ(::mkfifo((folder.path() / "pipe.png").c_str(), 0600), 0);
    EXPECT_EQ(errorOf(folder.path() / "pipe.png"), "image 'result': pipe.png is a pipe, no file");
    EXPECT_EQ(errorOf(folder.write("x.jpg", "x")).substr(0, 16), "image 'result': ");
    const auto png = writePng(folder, "p.png", 16, 51);
    EXPECT_EQ(errorOf(png, {16, 16}), "no error");
    EXPECT_EQ(errorOf(png, {32, 16}), "image 'result': has 16 × 16 pixels; 32 × 16 were asked for");
    const std::string whole = readFile(png);
    const auto half = folder.write("half.png", whole.substr(0, whole.size() / 2));
    EXPECT_TRUE(errorOf(half).starts_with("image 'result': DIR/half.png: ")) << errorOf(half);
    ImageF image(16, 16, 3, 0.5F);
    const auto exr = writeExr(folder, "e.exr", image);
    const std::string wholeExr = readFile(exr);
    const auto halfExr = folder.write("half.exr", wholeExr.substr(0, wholeExr.size() / 2));
    EXPECT_TRUE(errorOf(halfExr).starts_with("image 'result': DIR/half.exr: ")) << errorOf(halfExr);
    image.at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(errorOf(writeExr(folder, "nan.exr", image)),
              "image 'result': holds nan at pixel (3, 2)");
}

TEST_F(Pictures, MayBeLinks) {
    std::filesystem::create_symlink(writePng(folder, "p.png", 16, 51), folder.path() / "link.png");
    EXPECT_EQ(readPicture(folder.path() / "link.png", "image 'result'").stored.width(), 16);
}

TEST_F(Pictures, OfSeveralSeedsAreTestedForOneExpectation) {
    const Samples a = {{1.0, 2.0}, {1.1, 2.1}, {0.9, 1.9}, {1.0, 2.1}};
    const Samples b = {{1.05, 2.05}, {0.95, 2.0}, {1.0, 1.95}, {1.02, 2.02}};
    const Samples far = {{1.05, 9.05}, {0.95, 9.0}, {1.0, 8.95}, {1.02, 9.02}};
    const auto pOf = [&](const Samples& truths) {
        test::MetricRecorder recorder;
        recordSameMean(a, truths, "result", recorder);
        return recorder.metrics.at("same_mean_p/result");
    };
    EXPECT_GT(pOf(b), 0.3);
    EXPECT_EQ(pOf(far), 2.0 / 70.0);
    const auto errorOf = [](const Samples& pictures, const Samples& truths) {
        test::MetricRecorder recorder;
        return errorText([&] { recordSameMean(pictures, truths, "result", recorder); });
    };
    const Samples fixed(3, {1.0, 2.0});
    EXPECT_EQ(errorOf(fixed, b),
              "image 'result': all 3 frames are the same picture: nothing is random, or {frame} is "
              "not the seed");
    EXPECT_EQ(errorOf(a, fixed),
              "image 'result': truth: all 3 frames are the same picture: nothing is random, or "
              "{frame} is not the seed");
    EXPECT_EQ(errorOf(a, {b[0], a[2]}),
              "image 'result': one of its frames is a picture of the truth: the two need seeds of "
              "their own");
}

TEST_F(Pictures, RefusesATruthOfAnotherKind) {
    const Picture exr = readPicture(writeExr(folder, "t.exr", ImageF(16, 16, 3, 0.5F)), "t");
    const Picture png = readPicture(writePng(folder, "p.png", 16, 51), "p");
    EXPECT_EQ(
        errorText([&] { requireOneKind(png, exr, "result"); }),
        "image 'result': one of it and its truth is linear, as EXR files are, the other sRGB, "
        "as PNG files are");
}

}  // namespace

}  // namespace gfxrepro::external
