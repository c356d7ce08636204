// Finding and loading what a command line names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/batch/plan.h"
#include "runner/cli/commands.h"
#include "runner/scene/catalog.h"

namespace gfxrepro::cli {

/// The files `configs/<paper>/*.yaml` of every paper, sorted. Folders that hold no papers (scenes,
/// presets, sweeps, smoke) are left out.
std::vector<std::filesystem::path> paperConfigs();

/// The config files behind "PAPER" and "PAPER/TABLE" (all papers for no name), as absolute paths;
/// a name that ends in .yaml is a config itself.
/// Throws UsageError for names that are none, with the nearest.
std::vector<std::string> findPaperConfigs(const std::vector<std::string>& names);

std::vector<config::Experiment> loadExperiments(const batch::Request& request,
                                                const std::string& profile);

scene::Catalog openCatalog(const std::string& assets);

/// Rows as aligned columns, two spaces apart.
std::string alignedColumns(const std::vector<std::vector<std::string>>& rows);

}  // namespace gfxrepro::cli
