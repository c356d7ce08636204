// Finding and loading what a command line names.
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/catalog.h"
#include "runner/cli/commands.h"
#include "runner/run/run.h"
#include "runner/tables/table.h"

namespace gfxrepro::cli {

/// The files `configs/<paper>/*.yaml` of every paper, sorted. Folders that hold no papers (scenes,
/// calibration, presets, sweeps, smoke, nightly) are left out.
std::vector<std::filesystem::path> paperConfigs();

/// Each "PAPER" and its "PAPER/TABLE"s.
std::vector<std::string> paperNames();
/// Each "PAPER/KIND-TABLE", as its file is called.
std::vector<std::string> paperFileNames();

/// The run directories in runs/, by name, which begins with their time: the newest last.
std::vector<std::filesystem::path> runFolders();

/// Whether the name ends in .yaml or .yml.
bool isYamlFile(const std::filesystem::path& name);

/// The config files behind "PAPER" and "PAPER/TABLE" (all papers for no name), as absolute paths;
/// "zju2005/figure-*" and "*/2.?" are patterns. A name that ends in .yaml or .yml is a config
/// itself.
/// Throws UsageError for names that are none, with the nearest.
std::vector<std::string> findPaperConfigs(const std::vector<std::string>& names);

std::vector<config::Experiment> loadExperiments(const run::Request& request,
                                                const std::string& profile);

/// What a selection asks for; its files as absolute paths.
run::Request requestOf(const Chosen& selection, const std::vector<std::string>& files);

/// A line that names it: the first of whatever measures.
void tellDevice(const gl::DeviceInfo& device);
/// The same of the one that is asked for; nothing where none opens.
void tellDevice(const std::string& asked);

/// "software" | "gpu". A case's identity holds it; a machine without a device plans for software.
std::string deviceClassFor(const Chosen& selection);

/// `asked`, or "none" for "auto" where nothing of the experiments needs a device.
std::string deviceFor(const Context& context, const std::string& asked,
                      const std::vector<config::Experiment>& experiments);

/// The table before anything is recorded. Throws Error for a column that a claim reads and that the
/// cases will not give.
tables::Table tableBefore(const Context& context, const config::Experiment& experiment,
                          std::span<const config::Case> cases);

/// Throws Error for what is wrong in an experiment of these cases, all that it has, so that nothing
/// is measured in vain. What loaders warn of goes to standard error, and to `told`, once.
void requireSound(const Context& context, const scene::Catalog& catalog,
                  const config::Experiment& experiment, std::span<const config::Case> cases,
                  std::set<std::string>& told);

/// Throws Error where a file that a program needs, or a program of the config's own folder, is not
/// there: no case could be measured.
void requireFiles(std::span<const config::Case> cases);

/// Throws Error where what was measured elsewhere is not what its config, a sound one, lays out: it
/// tells cases apart that the config does not, or lacks those that a `where` asks for.
void requireLaidOut(const Context& context, const scene::Catalog& catalog,
                    const run::StoredRun& imported);

/// Of sound experiments.
run::Plan planFor(const Context& context, const run::Request& request, const std::string& profile,
                  const std::string& assets, const std::string& deviceClass);

/// What is measured is what was planned; that a config says something else by now is worth a word,
/// with what comes of it.
void warnOfChangedConfigs(const run::Plan& plan, const std::string& consequence);

/// "zju2005-2.1" for one experiment, "zju2005" for several of a paper.
std::string runSlug(const run::Plan& plan);

scene::Catalog openCatalog(const Context& context, const std::string& assets);

/// Columns, two spaces apart, as wide as their widest text: all rows are seen before the first is
/// written, by whoever has not room for all of their lines.
class Columns {
  public:
    void fit(const std::vector<std::string>& row);
    /// The texts made printable, with a newline.
    std::string line(const std::vector<std::string>& row) const;

  private:
    std::vector<std::size_t> widths_;
};

/// All rows as lines of aligned columns.
std::string alignedColumns(const std::vector<std::vector<std::string>>& rows);

/// "real", "stand-in", "generated", or "missing" where none of its files is here.
std::string sceneState(const scene::Catalog& catalog, const std::string& name);

}  // namespace gfxrepro::cli
