// A run as a folder for others.

#include "runner/cli/console.h"
#include "runner/cli/data_commands.h"
#include "runner/cli/experiments.h"
#include "runner/cli/results.h"
#include "runner/results/artifact.h"
#include "runner/results/tidy.h"

namespace gfxrepro::cli {

int exportRun(const Context& context, const ExportOptions& options) {
    const std::string target = options.out.empty()
                                   ? options.runDir + (options.isTidy ? "-tidy" : "-artifact")
                                   : options.out;
    const run::StoredRun run = run::readRun(options.runDir);
    if (options.isTidy) {
        results::writeTidy(options.runDir, run, target);
    } else {
        results::writeArtifact(options.runDir, run, openCatalog(context, options.assets), target);
    }
    sayNotes(run.manifest);
    say("{}\n", target);
    return kExitOk;
}

}  // namespace gfxrepro::cli
