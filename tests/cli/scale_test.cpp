// What thousands of cases take: reading a run grows with its size, and no faster.
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// CPU time of the programs that this one has waited for.
double childrenS() {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// A finished run of `count` cases, which nobody measured.
std::string writeRun(const TemporaryFolder& folder, int count) {
    const std::string dir = folder.path() / std::to_string(count);
    const std::string config = writeMockConfig(
        folder, "params: {behaviour: throw}\nsweep: {number: {range: [1, " + std::to_string(count) +
                    "]}}\nlayout:\n  rows: number\n  columns: {n: {metric: number}, t: {metric: "
                    "fidelity_db}}\n");
    EXPECT_EQ(
        mockGfxrepro({"run", config, "--jobs", "1", "--quiet", "--max-failures", "1", "--out", dir})
            .exitCode,
        4);
    std::vector<records::Record> rows;
    const auto plan = nlohmann::ordered_json::parse(readFile(dir + "/plan.json"));
    for (const auto& item : plan["cases"]) {
        records::Record row;
        row.caseId = item["id"].get<std::string>();
        row.table = item["experiment"].get<std::string>();
        row.technique = row.table;
        row.lane = "quality";
        row.unit = "1";
        for (const char* metric : {"number", "fidelity_db"}) {
            row.metric = metric;
            row.value = item["params"]["number"].get<double>();
            rows.push_back(row);
        }
    }
    fs::remove(dir + "/records.csv");
    records::RecordWriter(dir + "/records.csv").append(rows);
    return dir;
}

TEST(Scale, FourTimesTheCasesTakeFourTimesAsLong) {
    const TemporaryFolder folder;
    const std::string small = writeRun(folder, 2000), large = writeRun(folder, 8000);
    const auto spentS = [](const std::vector<std::string>& command) {
        const double before = childrenS();
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 0) << command.front() << result.out << result.err;
        return childrenS() - before;
    };
    EXPECT_EQ(rowsOf(large, "number").size(), 8000U);
    for (const char* command : {"table", "claims", "report"}) {
        const double smallS = spentS({command, small}), largeS = spentS({command, large});
        // Linear is 4, quadratic 16; 0.3 s is the noise of a machine.
        EXPECT_LE(largeS, 9.0 * smallS + 0.3) << command << ": " << smallS << " s, then";
    }
    const double smallS = spentS({"run", "--resume", small, "--quiet"});
    const double largeS = spentS({"run", "--resume", large, "--quiet"});
    EXPECT_LE(largeS, 9.0 * smallS + 0.3) << "resume: " << smallS << " s, then";
}

}  // namespace
}  // namespace gfxrepro::test
