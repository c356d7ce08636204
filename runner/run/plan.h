// The plan: every case resolved and frozen before the first is run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/catalog.h"
#include "runner/config/experiment.h"
#include "runner/config/external_program.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

using config::Case;

/// What was asked for, so that a resumed run can ask for the same again.
struct Request {
    std::vector<std::string> configs;  // absolute paths
    std::vector<std::string> sets;     // --set, as written
    std::vector<std::string> sweeps;   // --sweep, as written
    std::vector<std::string> only;     // --only, as written
    std::string device = "auto";
};

/// Of a plan that has the cases of one of several runs alone: which of them it is.
struct Shard {
    int index = 1;  // from 1
    int count = 1;
    std::string whole = {};       // the SHA-256 of the file with the plan that was cut
    std::string device = "auto";  // to open, as all of that plan ask: a part may need none

    std::string name() const;  // "2/4"
};

/// Of plan.json: a larger one is neither written nor read.
inline constexpr std::uintmax_t kMostPlanBytes = std::uintmax_t{1} << 30;

struct Plan {
    Request request;
    std::string profile;
    std::string deviceClass;  // "software" | "gpu"
    std::uint64_t seed = 1;
    /// Of everything that a result depends on; with --only, and of a shard, that of the plan
    /// before.
    std::string hash;
    std::string buildId;                           // of the program and its shaders
    std::map<std::string, std::string> sceneKeys;  // scene reference → identity of its content
    std::vector<Case> cases;
    /// The experiments as loaded (file text after merging), so that tables can be made again from
    /// the run directory alone; with their cases under the profile `paper`, which no worker sees.
    std::vector<config::Experiment> experiments;
    std::optional<Shard> shard;  // none: it was not cut

    /// As JSON, in pieces: of 100,000 cases the whole text would take a fifth of the memory.
    void write(const std::function<void(std::string_view)>& to) const;
    /// The same to a file, which is there as a whole or not at all. Throws as requirePlanBytes().
    void writeFile(const std::filesystem::path& path,
                   std::uintmax_t mostBytes = kMostPlanBytes) const;
    static Plan fromJsonFile(const std::filesystem::path& path);
};

/// Of a plan: one of more could be written, and would be refused when it is read.
inline constexpr std::size_t kMostCases = 200'000;
/// Throws Error, naming the config, for more.
void requireCaseCount(std::size_t count, const config::Experiment& experiment);
/// Likewise of its units: its cases, each in all its processes.
inline constexpr std::size_t kMostUnits = 1'000'000;
/// Those of these cases, with all rounds that may follow.
std::size_t unitCount(std::span<const Case> cases);
/// Throws Error(where, …) for more.
void requireUnitCount(std::size_t count, const SourceLocation& where);

/// Of its plan.json.
std::uintmax_t planBytes(const Plan& plan);
/// Throws Error, naming its first config, for more.
void requirePlanBytes(const Plan& plan, std::uintmax_t bytes,
                      std::uintmax_t mostBytes = kMostPlanBytes);

/// The cases of one experiment with every parameter resolved; ids are still empty. A case is there
/// once for each seed of its scene. Throws Error for unknown techniques, parameters and scenes.
/// Needs no device.
std::vector<Case> resolveCases(const config::Experiment& experiment, const scene::Catalog& catalog,
                               std::span<const technique::TechniqueInfo> techniques,
                               std::uint64_t seed);

/// The same without what takes a scene's place, its seeds included; it need not be at hand.
std::vector<Case> resolveParameters(const config::Experiment& experiment,
                                    const scene::Catalog& catalog,
                                    std::span<const technique::TechniqueInfo> techniques,
                                    std::uint64_t seed);

/// The cases of the experiment under the profile `paper`: what tables compare a run's parameters
/// with. None where nothing is published. Scenes need not be at hand. Throws Error as resolveCases,
/// and for what `printed.at` names that is no parameter, or a value that the technique does not
/// take.
std::vector<Case> resolvePaperCases(const config::Experiment& experiment,
                                    const scene::Catalog& catalog,
                                    std::span<const technique::TechniqueInfo> techniques);

/// Expands, constructs each technique once a case (which validates all parameters), resolves
/// scenes, and hashes. Throws Error for anything that is wrong in a config.
Plan makePlan(const std::vector<config::Experiment>& experiments, const scene::Catalog& catalog,
              std::span<const technique::TechniqueInfo> techniques, const std::string& profile,
              const std::string& deviceClass, std::uint64_t seed);

/// Identity of the program's files as the case has it, as Case::programKey.
std::string programKeyOf(const Case& item, config::FileDigests& digests);

/// Makes it a plan for another class of device: the same cases, under the ids that they have there.
/// Its hash stays: all shards of a plan have one, and none of them knows the others' cases.
void rebind(Plan& plan, const std::string& deviceClass);

/// Why a run of this plan may not go on with this program, this class of device and these scenes;
/// empty when it may. What became of its configs does not matter: the plan has them as they were.
std::string whyNotResumable(const Plan& plan, const std::string& deviceClass,
                            const scene::Catalog& catalog);

/// Why results under `now` may not be put beside those under `then`; empty when they may.
std::string planDifference(const Plan& then, const Plan& now);

/// Identity of a program: SHA-256 over the executable and every shader file.
std::string buildIdOf(const std::filesystem::path& program, const std::filesystem::path& shaders);
/// Of the running one.
std::string programBuildId();

}  // namespace gfxrepro::run
