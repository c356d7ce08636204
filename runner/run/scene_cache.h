// The scenes and programs that a worker holds, for the case at hand and for later ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/catalog.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

/// Least recently used scenes go when the rest would exceed the budget; those of the present case
/// stay whatever their size.
///
/// Generated scenes of a megabyte or more, and refined ones of a file, are kept as files in
/// cacheFolder()/scenes, for the next process: by generator or file, parameters, seed and the
/// program's build id. What cannot be written, or is torn, is made anew.
class SceneCache : public technique::SceneProvider {
  public:
    struct CachedScene {
        std::string reference;
        scene::Scene scene;
        std::size_t sizeBytes = 0;
        double loadTimeMs = 0.0;          // when it was read, perhaps for an earlier case
        long long peakResidentBytes = 0;  // of the process while it was read
        bool isOfThisCase = true;
    };

    /// The files together take at most `mostKeptBytes`: those used longest ago go.
    SceneCache(const scene::Catalog& catalog, std::size_t budgetBytes,
               std::uintmax_t mostKeptBytes = std::uintmax_t{1} << 30)
        : catalog_(catalog), budgetBytes_(budgetBytes), mostKeptBytes_(mostKeptBytes) {}

    /// Unpins everything; with a budget of zero, drops all scenes but `keep`.
    void beginCase(const std::string& keep);
    const CachedScene& get(const std::string& reference);
    const scene::Scene& load(const std::string& reference) override { return get(reference).scene; }

    /// Of scenes that the present case has not asked for.
    std::size_t otherBytes() const;
    const std::list<CachedScene>& entries() const { return entries_; }

  private:
    void trim();

    const scene::Catalog& catalog_;
    std::size_t budgetBytes_;
    std::uintmax_t mostKeptBytes_;
    std::list<CachedScene> entries_;  // the most recently used one first
};

class ProgramCache {
  public:
    /// In `folder` workers of one run leave each other what programs said of their versions.
    explicit ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The case's program with its version, and the files that it reads. Throws UnsupportedError
    /// where the program is not on this machine, and Error where it, or a file, is not what it was
    /// when the run was planned.
    std::vector<ProgramUse> require(const Case& item, const Node& params);

  private:
    std::string versionOf(const config::ExternalProgram& program, const std::string& sha256);

    std::filesystem::path folder_;
    config::FileDigests digests_;
};

}  // namespace gfxrepro::run
