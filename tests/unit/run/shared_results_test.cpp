// What cases of a worker share, and what keeps their results apart.
#include "runner/technique/shared_results.h"

#include <gtest/gtest.h>

#include "engine/core/node.h"

namespace gfxrepro::technique {
namespace {

struct Result {
    int number = 0;
    std::size_t sizeBytes() const { return 100; }
};

struct SharedResultsTest : ::testing::Test {
    void begin(const std::string& params, const std::string& work = "t scene 8 8 1 1") {
        shared.beginCase(work, parseYaml(params, "case.yaml"));
    }
    int get(std::initializer_list<const char*> regardless, const std::string& name = "truth") {
        return shared.get<Result>(name, regardless, [&] { return Result{++made}; })->number;
    }

    SharedResults shared{250};
    int made = 0;
};

TEST_F(SharedResultsTest, AreOfAllButTheParametersThatAreNamed) {
    begin("{method: a, tau: 1, view: north}");
    EXPECT_EQ(get({"method", "tau"}), 1);
    EXPECT_EQ(get({"method", "tau"}), 1) << "asked for again";
    begin("{method: b, tau: 2, view: north}");
    EXPECT_EQ(get({"method", "tau"}), 1);
    EXPECT_EQ(get({"method"}), 2) << "who names one parameter less has a result of their own";
    begin("{method: b, tau: 2, view: south}");
    EXPECT_EQ(get({"method", "tau"}), 3);
    begin("{method: b, tau: 2, view: south, pictures: true}");
    EXPECT_EQ(get({"method", "tau"}), 3) << "saving pictures is of no influence";
    begin("{method: b, tau: 2, view: south, new: 1}");
    EXPECT_EQ(get({"method", "tau"}), 4) << "a parameter that nobody thought of";
    begin("{method: b, tau: 2, view: south, new: 1}", "t scene 8 8 2 1");
    EXPECT_EQ(get({"method", "tau"}), 5) << "another seed";
    EXPECT_EQ(get({"method", "tau"}, "frame 1"), 6) << "another frame";
}

TEST_F(SharedResultsTest, ThoseAskedForLongestAgoGo) {
    for (const char* params : {"{n: 1}", "{n: 2}", "{n: 1}", "{n: 3}"}) {
        begin(params);
        get({});
    }
    EXPECT_EQ(made, 3);
    EXPECT_EQ(shared.otherBytes(), 100U) << "two have room, one of them is this case's";
    begin("{n: 1}");
    get({});
    EXPECT_EQ(made, 3);
    begin("{n: 2}");
    get({});
    EXPECT_EQ(made, 4);
}

TEST_F(SharedResultsTest, ACaseThatSharesNothingMakesItsOwn) {
    for (int i = 1; i <= 2; ++i) {
        EXPECT_EQ(
            sharedResult<Result>(nullptr, "truth", {}, [&] { return Result{++made}; })->number, i);
    }
}

}  // namespace
}  // namespace gfxrepro::technique
