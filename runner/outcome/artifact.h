// A run as an artifact for others: what was measured, with what, and how to measure it again.
#pragma once

#include <filesystem>

#include "runner/run/run.h"

namespace gfxrepro::outcome {

/// Writes the folder `target`, which must not exist, as a whole or not at all: plan, manifest,
/// records, tables, claims, report (made again there: the run's folder is left as it is) and log,
/// environment.txt, ASSETS.md with checksums and licences, configs/ (the experiments with all that
/// they extend laid in), scripts/<table>.sh without parameters, README.md with the measured minutes
/// and disk space of each table, SHA256SUMS. What the stamp for replicability in graphics and ACM's
/// badges ask for.
void writeArtifact(const std::filesystem::path& runDir, const run::StoredRun& run,
                   const scene::Catalog& catalog, const std::filesystem::path& target);

}  // namespace gfxrepro::outcome
