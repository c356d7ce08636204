// What GitHub is told beside the lines of a change.
#include "runner/cli/annotations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kOnGitHub = {"GITHUB_ACTIONS=true"};

using Annotations = test::RunTest;

TEST_F(Annotations, NameThePlaceAndCannotBecomeAnotherCommand) {
    EXPECT_EQ(cli::annotation("error", {"a.yaml", 3, 5}, "T: a, b", "50 % lost\n::set-env::x"),
              "::error file=a.yaml,line=3,col=5,title=T%3A a%2C b::50 %25 lost%0A::set-env::x");
    EXPECT_EQ(cli::annotation("notice", {}, "", "m"), "::notice::m");
    EXPECT_EQ(cli::annotation("error", {"./b/../a.yaml", 0, 0}, "", "m"), "::error file=a.yaml::m");
}

TEST_F(Annotations, OfAConfigThatIsWrong) {
    const std::string config = writeMockConfig(folder, "params: {nummer: 1}\n");
    const std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "check", config};
    EXPECT_THAT(runProgram(command, kOnGitHub).err,
                HasSubstr("\n::error file=" + config + ",line=5,col=10::" + config));
    EXPECT_THAT(
        runProgram(command, {"GITHUB_ACTIONS=true", "GITHUB_WORKSPACE=" + folder.path().string()})
            .err,
        HasSubstr("\n::error file=mock.yaml,line=5,col=10::"));
    EXPECT_THAT(runProgram(command, {"GITHUB_ACTIONS="}).err, Not(HasSubstr("::error")));
}

TEST_F(Annotations, OfCasesAndClaimsThatFailed) {
    const std::string config = writeMockConfig(
        folder,
        "sweep: {number: [1, 2], behaviour: [ok, crash]}\n"
        "layout:\n  rows: number\n  columns:\n"
        "    n: {metric: number, where: {behaviour: ok}, format: \"{median:.0f}\"}\n"
        "claims:\n"
        "  known: {says: it is, bound: n, bound_from: ours, less_than: 1, "
        "because: {verdict: fails, reason: r}}\n"
        "  fresh: {says: it is, bound: n, bound_from: ours, less_than: 2}\n");
    const ProcessResult run =
        endedWith(4, runProgram({GFXREPRO_MOCK_PROGRAM, "reproduce", config, "--device", "software",
                                 "--quiet", "--out", dir},
                                kOnGitHub));
    const std::string file = "file=" + config;
    EXPECT_THAT(run.err, HasSubstr("::error " + file +
                                   ",title=sweep/mock number=1 "
                                   "behaviour=crash::crash: SIGSEGV"));
    EXPECT_THAT(run.err, HasSubstr("::notice " + file +
                                   ",line=11,col=3,title=sweep/mock known fails::it is;"));
    EXPECT_THAT(run.err, HasSubstr("::error " + file +
                                   ",line=12,col=3,title=sweep/mock fresh fails::it is;"));
}

}  // namespace
}  // namespace gfxrepro::test
