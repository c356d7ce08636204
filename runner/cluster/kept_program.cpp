#include "runner/cluster/kept_program.h"

#include <fmt/format.h>

#include <unistd.h>

#include <chrono>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "runner/run/child_process.h"
#include "runner/run/plan.h"

namespace gfxrepro::cluster {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::seconds kStartLimit{60};
constexpr const char* kSelf = "/proc/self/exe";

void copyParts(const fs::path& folder) {
    constexpr auto kAll = fs::copy_options::recursive;
    fs::create_directories(folder);
    fs::copy_file(kSelf, keptProgram(folder));  // also where another build has its name by now
    for (const char* name : {"shaders", "configs"}) {
        fs::copy(dataFolder(name), folder / name, kAll);
    }
    const fs::path libraries = fs::read_symlink(kSelf).parent_path() / "lib";  // scripts/bundle
    // Links stay links: what libstdc++.so.6 leads to says its release.
    if (fs::is_directory(libraries)) {
        fs::copy(libraries, folder / "lib", kAll | fs::copy_options::copy_symlinks);
    }
}

void requireBuild(const fs::path& folder, const std::string& buildId) {
    const std::string build = run::buildIdOf(keptProgram(folder), folder / "shaders");
    if (build == buildId) return;
    throw Error(
        fmt::format("{}: is not the program that was submitted (build {} then, {} now); "
                    "submit again, to another folder",
                    folder.string(), buildId.substr(0, 12), build.substr(0, 12)));
}

/// A disk may forbid it.
void requireRuns(const fs::path& folder) {
    const run::ProgramEnd end = run::runToEnd({keptProgram(folder), "--version"}, kStartLimit);
    if (end.exitCode == 0) return;
    throw Error(fmt::format("{}: cannot be run there (exit code {}): {}",
                            keptProgram(folder).string(), end.exitCode, end.output));
}

}  // namespace

fs::path keptProgram(const fs::path& folder) {
    return folder / "gfxrepro";
}

void keepProgram(const fs::path& folder, const std::string& buildId) {
    if (fs::exists(folder)) return requireBuild(folder, buildId);
    fs::path made = folder;  // all of it is there, or none
    made += ".tmp" + std::to_string(::getpid());
    try {
        copyParts(made);
        requireBuild(made, buildId);
        requireRuns(made);
        fs::rename(made, folder);
    } catch (const std::exception& error) {
        std::error_code ignored;
        fs::remove_all(made, ignored);
        fs::remove(folder.parent_path(), ignored);  // where there is nothing else
        throw Error(
            fmt::format("no copy of the program for the tasks could be made: {}", error.what()));
    }
}

}  // namespace gfxrepro::cluster
