
#include <set>

#include "engine/core/random.h"
#include "engine/core/text.h"
#include "runner/config/experiment.h"
#include "tests/support/support.h"

namespace gfxrepro::config {
namespace {

/// Each point as "a=1 b=x".
std::vector<std::string> expand(std::string_view text) {
    std::vector<std::string> lines;
    for (const AxisPoint& point : expandSweep(parseYaml(text, "a.yaml"))) {
        std::vector<std::string> parts;
        for (const auto& [axis, value] : point) parts.push_back(axis + "=" + value.toFlowText());
        lines.push_back(joined(parts, " "));
    }
    return lines;
}

std::string sweepError(std::string_view text) {
    return errorText([&] { expand(text); });
}

TEST(Sweep, NothingIsOnePoint) {
    EXPECT_THAT(expand(""), ElementsAre(""));
    EXPECT_THAT(expand("{}"), ElementsAre(""));
}

TEST(Sweep, AxesMultiplyInTheOrderOfTheFile) {
    EXPECT_THAT(expand("{b: [1, 2], a: [x, [8, 8]]}"),
                ElementsAre("b=1 a=x", "b=1 a=[8, 8]", "b=2 a=x", "b=2 a=[8, 8]"));
}

TEST(Sweep, Ranges) {
    EXPECT_THAT(expand("d: {range: [1, 4]}"), ElementsAre("d=1", "d=2", "d=3", "d=4"));
    EXPECT_THAT(expand("d: {range: [0, 0.3, 0.1]}"), ElementsAre("d=0", "d=0.1", "d=0.2", "d=0.3"));
    EXPECT_THAT(expand("d: {range: [4, 1, -2]}"), ElementsAre("d=4", "d=2"));
    EXPECT_THAT(expand("d: {range: [3, 3]}"), ElementsAre("d=3"));
    EXPECT_THAT(expand("d: {log2: [64, 256]}"), ElementsAre("d=64", "d=128", "d=256"));
    EXPECT_THAT(expand("d: {log2: [0.25, 1]}"), ElementsAre("d=0.25", "d=0.5", "d=1"));
}

TEST(Sweep, BlocksAreAxesOfTheirOwn) {
    EXPECT_THAT(expand("{s: [a, b], zip: [{r: [64, 128], v: {range: [1, 2]}}]}"),
                ElementsAre("s=a r=64 v=1", "s=a r=128 v=2", "s=b r=64 v=1", "s=b r=128 v=2"));
    EXPECT_THAT(
        expand("list: [[{m: slices}, {m: worksheet, v: 1}], [{q: 1}, {q: 2}]]"),
        ElementsAre("m=slices q=1", "m=slices q=2", "m=worksheet v=1 q=1", "m=worksheet v=1 q=2"));
}

TEST(Sweep, ExcludeAndWhen) {
    EXPECT_THAT(expand("{s: [a, b], r: [1, 2], exclude: [{s: a, r: 2.0}, {s: b, r: [1]}]}"),
                ElementsAre("s=a r=1", "s=b r=2"));
    EXPECT_THAT(expand("{m: [x, y], n: [1, 2], when: {n: {m: x}}}"),
                ElementsAre("m=x n=1", "m=x n=2", "m=y"));
    EXPECT_THAT(expand("{m: [x, y, z], n: [1, 2], when: {n: {m: [x, z]}}, exclude: [{n: 2}]}"),
                ElementsAre("m=x n=1", "m=y", "m=z n=1"));
    // Without n there is nothing that k could depend on.
    EXPECT_THAT(expand("{m: [x, y], n: [1, 2], k: [5, 6], when: {k: {n: 1}, n: {m: x}}}"),
                ElementsAre("m=x n=1 k=5", "m=x n=1 k=6", "m=x n=2", "m=y"));
}

TEST(Sweep, BadAxes) {
    EXPECT_EQ(sweepError("[1]"), "a.yaml:1:1: sweep is [1]; allowed: a map, axis: values");
    EXPECT_EQ(sweepError("m: slices"),
              "a.yaml:1:4: axis 'm' is slices; allowed: a list, {range: [first, last, step]}, "
              "{log2: [first, last]}, or all, of a program's parameter that lists its values");
    EXPECT_EQ(
        sweepError("m: {rnage: [1, 2]}"),
        "a.yaml:1:4: axis 'm' is {rnage: [1, 2]}; allowed: a list, {range: [first, last, step]}, "
        "{log2: [first, last]}, or all, of a program's parameter that lists its values");
    EXPECT_EQ(sweepError("m: []"), "a.yaml:1:4: axis 'm' has no values");
    EXPECT_EQ(sweepError("m: [1, 2, 1.0]"), "a.yaml:1:11: axis 'm' has the value 1.0 twice");
    EXPECT_EQ(sweepError("m: {range: [1, 4, 0]}"),
              "a.yaml:1:12: range is [1, 4, 0]; allowed: a step that is not 0");
    EXPECT_EQ(sweepError("m: {range: [4, 1]}"),
              "a.yaml:1:12: range is [4, 1]; allowed: a step that leads from the first value to "
              "the last");
    EXPECT_EQ(sweepError("m: {range: [4]}"),
              "a.yaml:1:12: range is [4]; allowed: [first, last] or [first, last, step]");
    EXPECT_EQ(sweepError("m: {range: [a, 2]}"), "a.yaml:1:13: range is a; allowed: a number");
    EXPECT_EQ(sweepError("m: {range: [0, 1, 1e-9]}"),
              "a.yaml:1:12: axis 'm' has 1000000001 points; at most 1000000");
    for (const char* ends : {"[3, 64]", "[64, 100]", "[64, 8]", "[0, 8]", "[-2, 8]", "[8]"}) {
        EXPECT_EQ(sweepError(std::string("m: {log2: ") + ends + "}"),
                  std::string("a.yaml:1:11: log2 is ") + ends +
                      "; allowed: [first, last], powers of two, the smaller first");
    }
}

TEST(Sweep, BadBlocks) {
    EXPECT_EQ(sweepError("{a: [1], zip: [{b: [1, 2], c: [1]}]}"),
              "a.yaml:1:31: zip: axis 'c' has 1 values, but 'b' has 2");
    EXPECT_EQ(sweepError("{a: [1], zip: [{a: [1, 2]}]}"),
              "a.yaml:1:17: axis 'a' stands in the sweep twice");
    EXPECT_EQ(sweepError("{zip: [1]}"),
              "a.yaml:1:8: zip is 1; allowed: a list of maps, axis: values");
    EXPECT_EQ(sweepError("{zip: {a: [1]}}"), "a.yaml:1:7: expected a list, found a map");
    EXPECT_EQ(sweepError("{list: [{m: 1}]}"),
              "a.yaml:1:9: list is {m: 1}; allowed: a list of blocks, each a list of points {axis: "
              "value}");
    EXPECT_EQ(sweepError("{list: [[1]]}"),
              "a.yaml:1:10: a point of a list is 1; allowed: a map {axis: value}");
    EXPECT_EQ(sweepError("{list: [[{m: 1}], [{m: 2}]]}"),
              "a.yaml:1:21: axis 'm' stands in the sweep twice");
}

TEST(Sweep, BadConditions) {
    EXPECT_EQ(sweepError("{scene: [a], exclude: [{sceene: a}]}"),
              "a.yaml:1:25: exclude: unknown key 'sceene'; did you mean 'scene'?");
    EXPECT_EQ(sweepError("{scene: [a], exclude: [{q: a}]}"),
              "a.yaml:1:25: exclude: unknown key 'q'; allowed: scene");
    EXPECT_EQ(sweepError("{scene: [a], exclude: [{}]}"),
              "a.yaml:1:24: exclude is {}; allowed: a map {axis: value}");
    EXPECT_EQ(sweepError("{scene: [a], exclude: [{scene: a}]}"),
              "a.yaml:1:23: exclude leaves no point of the sweep");
    EXPECT_EQ(sweepError("{m: [a], n: [1], when: {k: {m: a}}}"),
              "a.yaml:1:25: when: unknown key 'k'; did you mean 'm'?");
    EXPECT_EQ(sweepError("{m: [a], n: [1], when: {n: {p: a}}}"),
              "a.yaml:1:29: when: unknown key 'p'; did you mean 'm'?");
}

TEST(Sweep, TooManyPointsAreCountedNotMade) {
    EXPECT_EQ(sweepError("{a: {range: [1, 1000]}, b: {range: [1, 1001]}}"),
              "a.yaml:1:1: the sweep has 1001000 points; at most 1000000");
    EXPECT_EQ(expand("{a: {range: [1, 100]}, b: {range: [1, 100]}}").size(), 10000U);
}

TEST(Sweep, PointsAreTheProductOfTheFactors) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        Node sweep = Node::map({});
        std::size_t product = 1;
        const std::uint32_t axisCount = random.index(4);
        for (std::uint32_t axis = 0; axis < axisCount; ++axis) {
            Node::Sequence values;
            for (std::uint32_t i = 0; i <= random.index(4); ++i) values.push_back(Node::number(i));
            product *= values.size();
            sweep.set("axis" + std::to_string(axis), Node::sequence(std::move(values)));
        }
        const auto points = expandSweep(sweep);
        ASSERT_EQ(points.size(), product);
        std::set<std::string> different;
        for (const AxisPoint& point : points) {
            ASSERT_EQ(point.size(), axisCount);
            std::string key;
            for (const auto& [axis, value] : point) key += axis + value.text() + " ";
            different.insert(key);
        }
        ASSERT_EQ(different.size(), product);
    }
}

}  // namespace
}  // namespace gfxrepro::config
