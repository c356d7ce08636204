// A run has one verdict on each claim, whichever command judges it and however its scene is named.

#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

TEST(Judging, ACauseOfGeneratedScenesIsOfThoseThatWereLoaded) {
    for (const char* lines : {"scene: models/duck\n", "scene: models/duck@3\n",
                              "scene: models/duck\nscene_params: {shape: hugo}\n",
                              "scene: models/duck\nscene_instead: {models/duck: shapes/sphere}\n",
                              "scene: models/duck\nscene_seeds: 2\nmeasure: {lane: quality}\n"}) {
        const TemporaryFolder folder;
        const std::string config = writeMockConfig(
            folder, std::string(lines) +
                        "layout:\n  rows: scene\n  columns: {n: {metric: number}}\n"
                        "claims:\n  none: {says: there is none, bound: n, at_most: -1, because: "
                        "{verdict: fails, scenes: generated, reason: there is one}}\n");
        const ProcessResult run =
            mockGfxrepro({"reproduce", config, "--out", folder.path() / "run"});
        EXPECT_EQ(run.exitCode, 1) << lines << run.err;
        EXPECT_THAT(run.out, HasSubstr("why: there is one")) << lines;
        EXPECT_THAT(run.out, Not(HasSubstr("news:"))) << lines;
    }
}

/// Without what says that a config came after the run.
std::string withoutMark(std::string text) {
    const std::string mark = "judged after the run, by a config that it did not know";
    for (const std::string& said : {mark + "; ", "Note: " + mark + "\n\n", std::string("\"")}) {
        for (std::size_t at; (at = text.find(said)) != text.npos;) text.erase(at, said.size());
    }
    return text;
}

TEST(Judging, TheRunsOwnConfigGivenAgainJudgesAlike) {
    const TemporaryFolder folder;
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {number: [1, 2]}\n"
                        "layout:\n  rows: number\n  columns: {n: {metric: number}}\n"
                        "claims:\n  small: {says: it is small, bound: n, at_most: 1, because: "
                        "{verdict: fails, reason: two is more}}\n");
    const std::string dir = folder.path() / "run";
    ASSERT_EQ(mockGfxrepro({"reproduce", config, "--only", "number=1", "--out", dir}).exitCode, 0);
    auto manifest = nlohmann::ordered_json::parse(readFile(dir + "/manifest.json"));
    manifest["machine_states"] = {{"sweep/mock", {{"hottest_c", 97.0}, {"hot_from_c", 95.0}}}};
    writeFileAtomic(dir + "/manifest.json", manifest.dump());
    ASSERT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    const std::string own = mockGfxrepro({"claims", dir}).out;
    EXPECT_THAT(own, HasSubstr("sweep/mock holds: it is small (small)"));
    EXPECT_THAT(withoutMark(mockGfxrepro({"claims", dir, "--config", config}).out),
                HasSubstr(own.substr(0, own.find('\n'))));
    const std::string afterwards = dir + "/judged-afterwards";
    EXPECT_EQ(withoutMark(readFile(afterwards + "/claims.csv")),
              withoutMark(readFile(dir + "/claims.csv")));
    for (const char* table : {"/tables/sweep-mock.md", "/tables/sweep-mock.csv"}) {
        EXPECT_EQ(withoutMark(readFile(afterwards + table)), withoutMark(readFile(dir + table)));
    }
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.md"), HasSubstr("it was hot, 97 °C"));
}

}  // namespace
}  // namespace gfxrepro::test
