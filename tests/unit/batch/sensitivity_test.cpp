#include "runner/batch/sensitivity.h"

#include <gmock/gmock.h>

#include "runner/config/node.h"

namespace gfxrepro::batch {
namespace {

using report::ClaimResult;
using report::Verdict;
using testing::ElementsAre;
using testing::Pair;

config::Node node(const std::string& yaml) {
    return config::parseYaml(yaml, "t.yaml");
}

config::Assumption assumption(const std::string& name, const std::string& range) {
    config::Assumption result;
    result.name = name;
    result.range = node(range);
    return result;
}

Case caseWith(const std::string& params, const std::string& axes = "{}") {
    Case item;
    item.params = node(params);
    item.axes = node(axes);
    item.outputWidthPx = 512;
    return item;
}

std::vector<std::string> titles(const Variations& variations) {
    std::vector<std::string> all;
    for (const Variation& run : variations.runs) all.push_back(run.title());
    return all;
}

TEST(Sensitivity, VariesWhatIsAParameterWithAListForARange) {
    config::Experiment experiment;
    experiment.assumptions = {
        assumption("bias", "[0, 0.04]"),     assumption("size", "[16, 4096]"),
        assumption("kind", "[spot, point]"), assumption("output", "[256, 512]"),
        assumption("place", "[1, 2]"),       assumption("scene", "any"),
        assumption("method", "[a, b]"),      assumption("free", "any text")};
    const Variations variations = variationsOf(
        experiment,
        {caseWith("{bias: 0.02, size: 1024, kind: spot, method: a, free: 1}", "{method: a}")}, 3);
    EXPECT_THAT(titles(variations),
                ElementsAre("as configured", "bias = 0", "bias = 0.04", "size = 16", "size = 256",
                            "size = 4096", "kind = point", "output = 256", "output = 384"));
    EXPECT_THAT(variations.runs[7].sets, ElementsAre("output.width=256", "output.height=256"));
    EXPECT_THAT(variations.runs[1].sets, ElementsAre("params.bias=0"));
    EXPECT_THAT(variations.fixed,
                ElementsAre(Pair("place", "no parameter of the technique"),
                            Pair("scene", "no parameter of the technique"),
                            Pair("method", "an axis of the table: it is varied there"),
                            Pair("free", "its range is no list")));
}

Outcome outcome(const std::string& name, const std::string& value, Verdict verdict,
                const std::string& margin = "") {
    ClaimResult claim;
    claim.id = "C";
    claim.text = "a < b";
    claim.verdict = verdict;
    claim.margin = margin;
    Variation variation{name, value, std::nullopt, {}};
    if (!margin.empty()) variation.number = std::stod(value);
    return {variation, {claim}};
}

TEST(Sensitivity, SaysUnderWhatAClaimHolds) {
    const Outcome base = outcome("", "", Verdict::Holds, "");
    EXPECT_EQ(dependence({base, outcome("bias", "0", Verdict::Holds, "1")}, 0),
              "holds under all 2");
    EXPECT_EQ(
        dependence({outcome("", "", Verdict::Fails), outcome("bias", "0", Verdict::Ambiguous)}, 0),
        "holds under none of 2");
    // Margins 3 at 1 and −1 at 5: 0 at 4.
    EXPECT_EQ(dependence({base, outcome("bias", "1", Verdict::Holds, "3"),
                          outcome("bias", "5", Verdict::Fails, "-1"),
                          outcome("kind", "spot", Verdict::Holds)},
                         0),
              "holds unless bias is 5 (flips between 1 and 5, near 4)");
    EXPECT_EQ(dependence({outcome("", "", Verdict::Fails), outcome("kind", "a", Verdict::Fails),
                          outcome("kind", "b", Verdict::Holds)},
                         0),
              "holds only if kind is b");
}

TEST(Sensitivity, WritesTables) {
    config::Experiment experiment;
    experiment.id = "p/1";
    experiment.title = "T";
    const std::vector<Outcome> outcomes{outcome("", "", Verdict::Holds),
                                        outcome("kind", "b", Verdict::Fails)};
    EXPECT_EQ(sensitivityCsv(outcomes),
              "assumption,value,claim,verdict,measured,required,margin\n"
              ",,C,holds,,,\nkind,b,C,fails,,,\n");
    const std::string text =
        sensitivityMarkdown(experiment, outcomes, {{}, {{"scene", "its range is no list"}}});
    EXPECT_NE(text.find("| C | a \\< b | holds | holds unless kind is b |\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("| kind = b | fails:  |\n"), std::string::npos) << text;
    EXPECT_NE(text.find("- scene: its range is no list\n"), std::string::npos);
}

}  // namespace
}  // namespace gfxrepro::batch
