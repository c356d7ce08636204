// What the tests of the program share.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runner/records/records.h"
#include "tests/support/process.h"
#include "tests/support/support.h"

namespace gfxrepro::test {

/// A test with a folder, and the place of a run in it.
struct RunTest : FolderTest {
    const std::string dir = folder.path() / "run";
};

/// The program, and the one with the failing technique, whose cases are measured on the software
/// device where another is not named.
ProcessResult gfxrepro(std::vector<std::string> arguments,
                       const std::vector<std::string>& more = {});
ProcessResult mockGfxrepro(std::vector<std::string> arguments,
                           const std::vector<std::string>& more = {});

/// A line of a shell.
ProcessResult shell(const std::string& line);

/// A result that must have this exit code; a failure names the caller's line.
ProcessResult endedWith(int exitCode, ProcessResult result, int line = __builtin_LINE());

/// Standard error of what must end with exit code 2, with the folder's path as DIR.
std::string refusalOf(const ProcessResult& result, const TemporaryFolder& folder);

/// A config for a mock technique with these lines behind its head.
fs::path writeMockConfig(const TemporaryFolder& folder, const std::string& lines,
                         const std::string& technique = "mock");

/// A file that can be run.
fs::path writeProgram(const TemporaryFolder& folder, const std::string& name,
                      const std::string& text);

/// The tables of the mock's sweep are the same in two runs.
void expectSameTables(const fs::path& a, const fs::path& b);

/// As if these rows had been lost.
void loseRows(const fs::path& runDir, const std::function<bool(const records::Record&)>& isLost);

/// Writes the file with `to` in the place of the first `from`.
void replaceIn(const fs::path& file, const std::string& from, const std::string& to);

/// Rows of a metric.
std::vector<records::Record> rowsOf(const fs::path& runDir, const std::string& metric);

/// The parameters of the cases of a run's plan, by id.
std::map<std::string, nlohmann::json> paramsOf(const fs::path& runDir);

/// "value=status message" of every case in order of the rows, by the parameter `behaviour`.
std::vector<std::string> statusLines(const fs::path& runDir);

/// The processes that this thread started.
std::vector<pid_t> ownChildren();
/// The workers of the program that this thread runs in the background.
std::vector<pid_t> backgroundWorkers();

}  // namespace gfxrepro::test
