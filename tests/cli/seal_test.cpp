// Records that are changed after the run, and claims that are.
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct Seal : FolderTest {
    static constexpr const char* kBody =
        "sweep: {behaviour: [ok]}\nparams: {number: 3}\n"
        "layout:\n  rows: behaviour\n  columns:\n"
        "    n: {metric: number, format: \"{median:.0f}\"}\n"
        "claims:\n  small: {says: the number is small, bound: n, at_most: ";

    std::string config(int bound) const {
        return writeMockConfig(folder, kBody + std::to_string(bound) + "}\n");
    }
    void run() const {
        EXPECT_THAT(endedWith(0, mockGfxrepro({"reproduce", config(6), "--out", dir})).out,
                    Not(HasSubstr("warning")));
    }
    /// The number becomes 4.
    void changeRecords() const {
        replaceIn(dir + "/records.csv", "number,1,3,ok", "number,1,4,ok");
    }
    nlohmann::json manifest(const std::string& folderOf) const {
        return nlohmann::json::parse(readFile(folderOf + "/manifest.json"));
    }

    std::string dir = folder.path() / "run";
    const std::string warning = "warning: records.csv was changed after the run (SHA-256 ";
};

TEST_F(Seal, ARunSaysNothingOfItsOwnRecords) {
    run();
    EXPECT_EQ(manifest(dir)["sha256"].size(), 2U) << "records.csv and images/index.csv";
    for (const char* command : {"table", "claims", "report"}) {
        const ProcessResult result = mockGfxrepro({command, dir});
        EXPECT_EQ(result.exitCode, 0) << command;
        EXPECT_THAT(result.out, Not(HasSubstr("warning"))) << command;
    }
}

TEST_F(Seal, ChangedRecordsAreSaidByAllThatReadsThem) {
    run();
    changeRecords();
    for (const char* command : {"table", "claims", "report"}) {
        const ProcessResult result = mockGfxrepro({command, dir});
        EXPECT_EQ(result.exitCode, 0) << command;
        EXPECT_THAT(result.out, HasSubstr(warning)) << command;
    }
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.md"),
                HasSubstr("Note: records.csv was changed after the run"));
    EXPECT_THAT(readFile(dir + "/report.html"), HasSubstr("records.csv was changed after the run"));
    const std::string out = folder.path() / "out", artifact = folder.path() / "artifact";
    EXPECT_THAT(mockGfxrepro({"compare", dir, dir, "--out", out}).out,
                HasSubstr("warning: " + dir + ": records.csv was changed after the run"));
    EXPECT_THAT(readFile(out + "/comparison.md"), HasSubstr("was changed after the run"));
    EXPECT_THAT(mockGfxrepro({"export", dir, "--out", artifact}).out, HasSubstr(warning));
    EXPECT_THAT(manifest(artifact)["notes"].dump(),
                HasSubstr("records.csv was changed after the run"));
    EXPECT_EQ(manifest(artifact)["sha256"], manifest(dir)["sha256"]);
}

TEST_F(Seal, AResumedRunIsSealedAnewAndKeepsTheNote) {
    run();
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).exitCode, 0);
    EXPECT_THAT(mockGfxrepro({"table", dir}).out, Not(HasSubstr("warning")));
    changeRecords();
    EXPECT_THAT(endedWith(0, mockGfxrepro({"run", "--resume", dir})).err, HasSubstr(warning));
    EXPECT_THAT(mockGfxrepro({"table", dir}).out, HasSubstr(warning));
    EXPECT_EQ(manifest(dir)["notes"].size(), 1U);
}

TEST_F(Seal, ARunThatIsUnderWayHasNone) {
    run();
    nlohmann::json open = manifest(dir);
    open.erase("sha256");
    writeFileAtomic(dir + "/manifest.json", open.dump());
    changeRecords();
    EXPECT_THAT(mockGfxrepro({"table", dir}).out, Not(HasSubstr("warning")));
}

TEST_F(Seal, AMergeSaysWhichShardWasChanged) {
    const std::string file = config(6);
    ASSERT_EQ(mockGfxrepro({"run", file, "--shard", "1/1", "--out", dir}).exitCode, 0);
    changeRecords();
    const std::string merged = folder.path() / "merged";
    EXPECT_EQ(mockGfxrepro({"merge", "--out", merged, dir}).exitCode, 0);
    EXPECT_THAT(manifest(merged)["notes"].dump(), HasSubstr(dir + ": records.csv was changed"));
    EXPECT_EQ(manifest(merged)["sha256"].size(), 2U);
    const ProcessResult table = mockGfxrepro({"table", merged});
    EXPECT_THAT(table.out, HasSubstr("warning: " + dir + ": records.csv was changed"));
}

TEST_F(Seal, PicturesThatAreNotAsTheyWereRecordedAreNamed) {
    const std::string file = config(6);
    ASSERT_EQ(mockGfxrepro({"run", file, "--shard", "1/1", "--out", dir}).exitCode, 0);
    const records::ImageEntry image = records::readImages(dir).front();
    EXPECT_THAT(mockGfxrepro({"report", dir}).out, Not(HasSubstr("warning")));
    writeFileAtomic(dir + '/' + image.png, readFile(dir + '/' + image.png) + "x");
    fs::remove(dir + '/' + image.exr);
    const std::string said = "pictures are not as they were recorded: " + image.png +
                             " was changed, " + image.exr + " is missing";
    const std::string merged = folder.path() / "merged", artifact = folder.path() / "artifact";
    EXPECT_THAT(mockGfxrepro({"report", dir}).out, HasSubstr("warning: " + said));
    for (const char* command : {"run", "reproduce"}) {
        const ProcessResult resumed = mockGfxrepro({command, "--resume", dir});
        EXPECT_THAT(resumed.out + resumed.err, HasSubstr("warning: " + said)) << command;
    }
    EXPECT_THAT(readFile(dir + "/report.html"), HasSubstr(image.exr + " is missing"));
    EXPECT_THAT(mockGfxrepro({"export", dir, "--out", artifact}).out, HasSubstr(said));
    EXPECT_THAT(manifest(artifact)["notes"].dump(), HasSubstr(said));
    EXPECT_EQ(mockGfxrepro({"merge", "--out", merged, dir}).exitCode, 0);
    EXPECT_THAT(manifest(merged)["notes"].dump(), HasSubstr(dir + ": " + said));
}

/// Nothing but what the page would show of it is lost.
TEST_F(Seal, DamagedPicturesAreToldAsMissingOnesAre) {
    const std::string file = config(6);
    ASSERT_EQ(mockGfxrepro({"run", file, "--shard", "1/1", "--out", dir}).exitCode, 0);
    const std::string png = records::readImages(dir).front().png;
    const std::string whole = readFile(dir + '/' + png);
    std::string damaged = whole;
    damaged[whole.size() / 2] ^= 1;
    const std::string artifact = folder.path() / "artifact", merged = folder.path() / "merged";
    const std::string embedded = folder.path() / "one.html";
    for (const std::string& content : {damaged, whole.substr(0, whole.size() / 2), std::string()}) {
        writeFileAtomic(dir + '/' + png, content);
        for (const std::vector<std::string>& command :
             {std::vector<std::string>{"report", dir},
              {"report", dir, "--embed", "--out", embedded},
              {"export", dir, "--out", artifact}}) {
            const ProcessResult result = mockGfxrepro(command);
            EXPECT_EQ(result.exitCode, 0) << command.front() << ": " << result.err;
            EXPECT_THAT(result.out, HasSubstr(png + " was changed")) << command.front();
        }
        endedWith(0, mockGfxrepro({"merge", "--out", merged, dir}));
        EXPECT_THAT(manifest(merged)["notes"].dump(), HasSubstr(png + " was changed"));
        fs::remove_all(artifact);
        fs::remove_all(merged);
        fs::remove(embedded);
    }
}

/// Of what is measured again the old pictures are nothing to be told of.
TEST_F(Seal, ARunThatGoesOnNamesTheKeptPicturesThatAreNotAsTheyWere) {
    const std::string file = writeMockConfig(folder, "sweep: {number: [3, 4]}\n");
    ASSERT_EQ(mockGfxrepro({"run", file, "--out", dir}).exitCode, 0);
    const std::vector<records::ImageEntry> images = records::readImages(dir);
    const records::ImageEntry& kept = images.front();
    ASSERT_NE(kept.caseId, images.back().caseId);
    for (const records::ImageEntry* image : {&kept, &images.back()}) {
        writeFileAtomic(dir + '/' + image->png, readFile(dir + '/' + image->png) + "x");
    }
    loseRows(dir, [&](const auto& row) { return row.caseId != kept.caseId; });
    const ProcessResult resumed = mockGfxrepro({"run", "--resume", dir});
    EXPECT_THAT(resumed.out, HasSubstr("1 of 1 finished"));
    EXPECT_THAT(resumed.err, HasSubstr("warning: pictures are not as they were recorded: " +
                                       kept.png + " was changed\n"));
    EXPECT_THAT(mockGfxrepro({"report", dir}).out, HasSubstr(kept.png + " was changed\n"));
}

TEST_F(Seal, AnotherConfigJudgesApartAndSaysSo) {
    run();
    const std::string before = readFile(dir + "/claims.csv");
    const ProcessResult result = endedWith(1, mockGfxrepro({"claims", dir, "--config", config(2)}));
    EXPECT_THAT(result.out,
                HasSubstr("sweep/mock fails (news): the number is small (small); judged after the "
                          "run, by a config that it did not know; one sample\n"));
    EXPECT_THAT(result.out,
                HasSubstr("judged after the run: " + dir + "/judged-afterwards/claims.csv\n"));
    EXPECT_EQ(readFile(dir + "/claims.csv"), before);
    EXPECT_THAT(readFile(dir + "/judged-afterwards/claims.csv"), HasSubstr(",fails,holds,3,"));
    EXPECT_THAT(readFile(dir + "/judged-afterwards/tables/sweep-mock.md"),
                HasSubstr("Note: judged after the run, by a config that it did not know"));
    const std::string other =
        folder.write("other.yaml", "sweep_of: other\ntitle: t\ntechnique: mock\n");
    EXPECT_EQ(mockGfxrepro({"claims", dir, "--config", other}).err,
              "gfxrepro: " + other + ": sweep/other is not among what " + dir + " measured\n");
}

// A run has one verdict on each claim, whichever command judges it and however its scene is named.

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
