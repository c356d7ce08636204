#include "tests/cli/cli_support.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/core/files.h"

namespace gfxrepro::test {

ProcessResult gfxrepro(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.begin(), GFXREPRO_PROGRAM);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
}

ProcessResult mockGfxrepro(std::vector<std::string> arguments,
                           const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    static constexpr std::string_view kMeasuring[] = {"run", "reproduce", "plan", "submit"};
    const auto has = [&](const char* option) {
        return std::ranges::find(arguments, option) != arguments.end();
    };
    const bool measures = std::ranges::find(kMeasuring, arguments[0]) != std::end(kMeasuring);
    if (measures && !has("--device") && !has("--resume")) {
        arguments.insert(arguments.end(), {"--device", "software"});
    }
    arguments.insert(arguments.begin(), GFXREPRO_MOCK_PROGRAM);
    return runProgram(arguments);
}

ProcessResult shell(const std::string& line) {
    return runProgram({"/bin/sh", "-c", line});
}

ProcessResult endedWith(int exitCode, ProcessResult result, int line) {
    EXPECT_EQ(result.exitCode, exitCode) << "line " << line << ": " << result.out << result.err;
    return result;
}

std::string refusalOf(const ProcessResult& result, const TemporaryFolder& folder) {
    EXPECT_EQ(result.exitCode, 2) << result.out;
    return errorText([&] { throw Error(result.err); }, folder.path());
}

fs::path writeMockConfig(const TemporaryFolder& folder, const std::string& lines,
                         const std::string& technique) {
    const bool hasScene = lines.find("scene: ") != lines.npos;
    // Frames stand beside the size.
    constexpr std::string_view kFrames = "output: {frames: ";
    const bool hasFrames = lines.starts_with(kFrames);
    const std::string size = "output: {width: 8, height: 8";
    return folder.write(
        "mock.yaml",
        "sweep_of: mock\ntitle: A mock\ntechnique: " + technique + (hasScene ? "_of_scenes" : "") +
            "\n" + size + (hasFrames ? ", " + lines.substr(kFrames.find('{') + 1) : "}\n" + lines) +
            // Without a layout it would be timed, which tests of other things need not.
            (lines.find("measure:") == std::string::npos ? "measure: {lane: quality}\n" : ""));
}

fs::path writeProgram(const TemporaryFolder& folder, const std::string& name,
                      const std::string& text) {
    const fs::path program = folder.write(name, text);
    fs::permissions(program, fs::perms::owner_all);
    return program;
}

void expectSameTables(const fs::path& a, const fs::path& b) {
    for (const char* file : {"sweep-mock.csv", "sweep-mock.md", "sweep-mock.tex"}) {
        EXPECT_EQ(readFile(a / "tables" / file), readFile(b / "tables" / file)) << a << file;
    }
}

void loseRows(const fs::path& runDir, const std::function<bool(const records::Record&)>& isLost) {
    std::vector<records::Record> rows = records::readRecords(runDir / "records.csv");
    std::erase_if(rows, isLost);
    fs::remove(runDir / "records.csv");
    records::RecordWriter(runDir / "records.csv").append(rows);
}

void replaceIn(const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = readFile(file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << file << " has no " << from;
    writeFileAtomic(file, text.replace(at, from.size(), to));
}

std::vector<records::Record> rowsOf(const fs::path& runDir, const std::string& metric) {
    std::vector<records::Record> rows = records::readRecords(runDir / "records.csv");
    std::erase_if(rows, [&](const records::Record& row) { return row.metric != metric; });
    return rows;
}

std::map<std::string, nlohmann::json> paramsOf(const fs::path& runDir) {
    std::map<std::string, nlohmann::json> params;
    const auto plan = nlohmann::json::parse(readFile(runDir / "plan.json"));
    for (const auto& item : plan["cases"]) params[item["id"]] = item["params"];
    return params;
}

std::vector<std::string> statusLines(const fs::path& runDir) {
    std::vector<std::string> lines;
    std::string lastCase;
    const auto params = paramsOf(runDir);
    for (const records::Record& row : records::readRecords(runDir / "records.csv")) {
        if (row.caseId == lastCase) continue;
        lastCase = row.caseId;
        std::string line = params.at(row.caseId).at("behaviour").get<std::string>() + ": ";
        line += records::statusName(row.status);
        if (!row.message.empty()) line += " (" + row.message + ")";
        lines.push_back(line);
    }
    return lines;
}

namespace {

std::vector<pid_t> childrenOf(const std::string& task) {
    std::ifstream file("/proc/" + task + "/children");
    std::vector<pid_t> children;
    for (pid_t pid; file >> pid;) children.push_back(pid);
    return children;
}

}  // namespace

std::vector<pid_t> ownChildren() {
    return childrenOf("thread-self");
}

std::vector<pid_t> backgroundWorkers() {
    std::vector<pid_t> workers;
    for (const pid_t runner : ownChildren()) {
        const std::string pid = std::to_string(runner);
        for (const pid_t worker : childrenOf(pid + "/task/" + pid)) workers.push_back(worker);
    }
    return workers;
}

}  // namespace gfxrepro::test
