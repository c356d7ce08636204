// A run as a folder for others.
#include <fmt/core.h>

#include <filesystem>

#include "runner/batch/artifact.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"

namespace gfxrepro::cli {

int exportRun(const std::string& runDir, const std::string& out, const std::string& assets) {
    const std::string target = out.empty() ? runDir + "-artifact" : out;
    batch::writeArtifact(runDir, batch::readRun(runDir), openCatalog(assets), target);
    fmt::print("{}\n", target);
    return kExitOk;
}

}  // namespace gfxrepro::cli
