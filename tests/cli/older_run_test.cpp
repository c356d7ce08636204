// A run of before, whose rows of records.csv have the parameters of their case (schema 2).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OlderRun : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::copy(fs::path(GFXREPRO_SOURCE) / "tests/cli/older_run", dir);
        ASSERT_THAT(readFile(dir + "/records.csv"), HasSubstr(",scene,params,frame,"));
    }

    TemporaryFolder folder;
    std::string dir = folder.path() / "run";
};

TEST_F(OlderRun, HasTheTableAndTheClaimThatItHad) {
    const ProcessResult table = mockGfxrepro({"table", dir});
    EXPECT_EQ(table.exitCode, 0) << table.err;
    EXPECT_EQ(readFile(dir + "/tables/demo2026-1.csv"),
              "number,shown_printed,shown_measured,shown_low,shown_high,shown_bounds,shown_status,"
              "shown_at_printed,parameters\n"
              "1,,1,1,1,,ok,yes,Measured at the parameters of the profile paper\n"
              "2,,2,2,2,,ok,yes,Measured at the parameters of the profile paper\n");
    const ProcessResult claims = mockGfxrepro({"claims", dir});
    EXPECT_EQ(claims.exitCode, 0) << claims.err;
    EXPECT_THAT(claims.out, HasSubstr("demo2026/1 holds: the number grows (grows); one sample\n"));
    EXPECT_EQ(mockGfxrepro({"report", dir}).exitCode, 0);
}

TEST_F(OlderRun, IsComparedWithOneOfToday) {
    const std::string config = folder.write(
        "demo.yaml",
        "table: demo2026/1\ntitle: A run of today\ntechnique: mock\noutput: {width: 8, height: 8}\n"
        "sweep: {number: [1, 2]}\nmeasure: {lane: quality, repeats: 1, warmup: 0}\n"
        "layout: {rows: number, columns: {shown: {metric: number}}}\n");
    const std::string today = folder.path() / "today";
    ASSERT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", today}).exitCode, 0);
    std::string manifest = readFile(today + "/manifest.json");
    writeFileAtomic(dir + "/manifest.json", manifest);  // as if on this machine
    const ProcessResult compared =
        mockGfxrepro({"compare", dir, today, "--out", folder.path() / "out"});
    EXPECT_EQ(compared.exitCode, 0) << compared.out << compared.err;
    EXPECT_THAT(compared.out, testing::Not(HasSubstr("only"))) << "the cases are the same";
}

TEST_F(OlderRun, IsNotGoneOnWith) {
    const std::string records = readFile(dir + "/records.csv");
    const ProcessResult resumed = mockGfxrepro({"run", "--resume", dir});
    EXPECT_EQ(resumed.exitCode, 2);
    EXPECT_THAT(resumed.err, HasSubstr("the program or a shader changed"));
    EXPECT_EQ(readFile(dir + "/records.csv"), records);
}

}  // namespace
}  // namespace gfxrepro::test
