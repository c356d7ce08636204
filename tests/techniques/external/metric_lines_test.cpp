#include "techniques/external/results.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/support.h"

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
    EXPECT_EQ(numberIn("nothing\n", pattern), std::nullopt);
    EXPECT_EQ(numberIn("", pattern), std::nullopt);
    EXPECT_EQ(errorText([&] { numberIn("Rays: 1.2.3\n", pattern); }),
              "metric 'rays': its pattern finds '1.2.3'; allowed: a number");
    // No line is so long that matching it would take the stack.
    EXPECT_EQ(numberIn("Rays: 5\n" + std::string(10'000'000, 'x'), pattern), 5.0);
}

}  // namespace
}  // namespace gfxrepro::external
