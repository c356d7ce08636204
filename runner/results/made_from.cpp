#include "runner/results/made_from.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace gfxrepro::results {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFile = "made-from.txt";

}  // namespace

std::string madeFromLine(const fs::path& runDir, const run::Json& manifest) {
    return fmt::format("{}, started {}, plan {}\n",
                       fs::weakly_canonical(runDir).filename().string(),
                       manifest.value("started", "?"), manifest.value("plan", "?"));
}

void requireMadeFrom(const fs::path& folder, const std::string& lines) {
    if (fs::exists(folder / kFile)) {
        const std::string others = readFile(folder / kFile);
        if (others == lines) return;
        throw Error(fmt::format("{}: was made from another run ({}); give another folder",
                                folder.string(), others.substr(0, others.find('\n'))));
    }
    for (const char* name : {"plan.json", "manifest.json", "claims.csv", "tables", "junit.xml",
                             "report.html", "comparison.md"}) {
        if (!fs::exists(folder / name)) continue;
        throw Error(fmt::format("{}: has {}, and no {} says of which run; give another folder",
                                folder.string(), name, kFile));
    }
}

void noteMadeFrom(const fs::path& folder, const std::string& lines) {
    writeFileAtomic(folder / kFile, lines);
}

void takeFolder(const fs::path& folder, const fs::path& runDir, const run::Json& manifest) {
    std::error_code isAbsent;
    if (fs::equivalent(folder, runDir, isAbsent)) return;
    const std::string line = madeFromLine(runDir, manifest);
    requireMadeFrom(folder, line);
    noteMadeFrom(folder, line);
}

}  // namespace gfxrepro::results
