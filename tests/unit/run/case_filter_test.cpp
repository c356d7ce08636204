#include "runner/run/case_filter.h"

#include "tests/support/support.h"

namespace gfxrepro::run {
namespace {

Case caseOf(const std::string& id, const std::string& axes) {
    Case item;
    item.id = id;
    item.experiment = "zju2005/9.9";
    item.axes = parseYaml(axes, "axes");
    item.params = parseYaml("{resolution: 64, method: slices}", "params");
    item.scene = Node::scalar("models/duck");
    item.outputWidthPx = 32;
    item.outputHeightPx = 16;
    return item;
}

Plan plan() {
    return Plan{.cases = {caseOf("aa11", "{step: 1, view: [0, 1]}"), caseOf("aa22", "{step: 2.0}"),
                          caseOf("bb33", "{step: 2.0, packed: true}")}};
}

std::vector<std::string> left(const std::vector<std::string>& only) {
    Plan filtered = plan();
    keepOnly(filtered, only);
    std::vector<std::string> ids;
    for (const Case& item : filtered.cases) ids.push_back(item.id);
    return ids;
}

using Ids = std::vector<std::string>;

TEST(CaseFilter, APatternMayBeginWithAnything) {
    EXPECT_EQ(left({"scene=*duck"}), (Ids{"aa11", "aa22", "bb33"}));
    EXPECT_EQ(left({"method=*s|thin"}).size(), 3U);
    EXPECT_EQ(left({"step=[1]*"}), (Ids{"aa11"}));
    EXPECT_EQ(left({"resolution=?4"}).size(), 3U);
}

TEST(CaseFilter, KeepsWhatHasAllValues) {
    EXPECT_EQ(left({}), (Ids{"aa11", "aa22", "bb33"}));
    EXPECT_EQ(left({"step=2"}), (Ids{"aa22", "bb33"}));  // 2 is 2.0
    EXPECT_EQ(left({"step=2", "packed=true"}), (Ids{"bb33"}));
    EXPECT_EQ(left({"view=[0, 1]"}), (Ids{"aa11"}));
    EXPECT_EQ(left({"resolution=64", "scene=models/duck", "output.height=16"}).size(), 3U);
    EXPECT_EQ(left({"case=aa"}), (Ids{"aa11", "aa22"}));
    EXPECT_EQ(left({"case=aa1", "case=bb"}), (Ids{"aa11", "bb33"})) << "of one key any";
}

TEST(CaseFilter, SaysWhatThereIs) {
    EXPECT_EQ(errorText([] { left({"step=3"}); }),
              "--only step=3: no case has that value; there are 1, 2");
    EXPECT_EQ(errorText([] {
                  left({"step=1", "packed=true"});
              }),
              "--only: no case has all of step=1, packed=true");
    EXPECT_EQ(
        errorText([] { left({"stp=3"}); }),
        "--only stp=3: no case has 'stp'; did you mean 'step'? (axes here: packed, step, view)");
    EXPECT_EQ(errorText([] { left({"case=cc"}); }),
              "--only case=cc: no case has an id that begins so; ids change with the program, "
              "'gfxrepro plan' shows them");
}

TEST(CaseFilter, NamesOneCase) {
    const Plan all = plan();
    CaseNames names(all);
    EXPECT_EQ(names.onlyOf(all.cases[0]), (Ids{"step=1", "view=[0, 1]"}));
    EXPECT_EQ(names.onlyOf(all.cases[1]), (Ids{"case=aa22"}));  // its axes are bb33's, too
    EXPECT_EQ(names.onlyOf(all.cases[2]), (Ids{"step=2.0", "packed=true"}));
    for (const Case& item : all.cases) EXPECT_EQ(left(names.onlyOf(item)), (Ids{item.id}));
}

}  // namespace
}  // namespace gfxrepro::run
