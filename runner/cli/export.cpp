// A run as a folder for others.
#include <filesystem>

#include "runner/batch/artifact.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/results.h"

namespace gfxrepro::cli {

int exportRun(const Context& context, const std::string& runDir, const std::string& out,
              const std::string& assets) {
    const std::string target = out.empty() ? runDir + "-artifact" : out;
    const batch::StoredRun run = batch::readRun(runDir);
    batch::writeArtifact(runDir, run, openCatalog(context, assets), target);
    sayNotes(run.manifest);
    say("{}\n", target);
    return kExitOk;
}

}  // namespace gfxrepro::cli
