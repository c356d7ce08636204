#include "runner/run/program_cache.h"

#include <algorithm>

#include "engine/core/text.h"
#include "runner/run/child_process.h"

namespace gfxrepro::run {

namespace {

constexpr std::chrono::seconds kVersionLimit{20};

/// The first line that says something.
std::string firstLine(const std::string& output) {
    constexpr std::size_t kLongest = 200;
    for (const std::string& line : split(output, '\n')) {
        const std::string_view text = trimmed(line);
        if (!text.empty()) return std::string(text.substr(0, kLongest));
    }
    return "";
}

}  // namespace

std::vector<ProgramUse> ProgramCache::require(const Case& item, const Node& params) {
    const config::Program program = config::readProgram(item.program);
    const std::vector<config::ProgramFile> files =
        config::filesOf(program, program.valuesOf(params));
    const std::string key = config::programKey(files, digests_);
    if (const config::ProgramFile* absent = config::absentOf(files)) {
        throw UnsupportedError("the program '" + absent->name + "' is not on this machine");
    }
    if (!item.programKey.empty() && key != item.programKey) {
        throw Error("the program '" + files.front().name +
                    "', or a file that it reads, changed since the run was planned");
    }
    std::vector<ProgramUse> uses;
    for (const config::ProgramFile& file : files) {
        uses.push_back({file.name, digests_.of(file.path), ""});
    }
    if (program.version.empty()) return uses;
    // Of the file that is asked; of the program where another one is.
    const auto asked =
        std::ranges::find(files, program.version.front(), &config::ProgramFile::name);
    const std::size_t at =
        asked == files.end() ? 0 : static_cast<std::size_t>(asked - files.begin());
    uses[at].version = versionOf(program, uses[at].sha256);
    return uses;
}

std::string ProgramCache::versionOf(const config::Program& program, const std::string& sha256) {
    std::vector<std::string> command;
    for (const std::string& argument : program.version) {
        command.push_back(config::filled(argument, {{config::placeholder::kHere, program.here}}));
    }
    const auto [known, isNew] = versions_.try_emplace(sha256 + ' ' + joined(command, " "));
    if (!isNew) return known->second;
    const std::string path = config::findExecutable(command.front(), program.here).string();
    if (path.empty()) {
        throw UnsupportedError("the program '" + command.front() +
                               "', which says the version, is not on this machine");
    }
    command.front() = path;
    known->second = firstLine(runToEnd(command, kVersionLimit).output);
    return known->second;
}

}  // namespace gfxrepro::run
