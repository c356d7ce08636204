// The schema of the files that people write. A key is declared in the source that reads it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/key_schema.h"
#include "runner/config/outputs.h"

namespace gfxrepro::config {

/// The words of a claim, in the order of the enums of ClaimSpec.
inline constexpr std::array<std::string_view, 6> kOrigins = {
    "document", "derived", "ours", "definition", "calibrated", "existence"};
inline constexpr std::array<std::string_view, 3> kBoundSources = {"print", "text", "ours"};
inline constexpr std::array<std::string_view, 3> kTimeKinds = {"algorithmic", "architectural",
                                                               "absolute"};
/// What `because` may tell of, and where.
inline constexpr std::array<std::string_view, 3> kKnownVerdicts = {"fails", "ambiguous",
                                                                   "unmeasured"};
inline constexpr std::array<std::string_view, 2> kDeviceClasses = {"software", "gpu"};
/// Of scenes: a file was read for them, or a generator made them, if in a real one's place.
inline constexpr std::array<std::string_view, 2> kSceneClasses = {"files", "generated"};
inline constexpr std::array<std::string_view, 3> kProfiles = {"quick", "full", "paper"};

const std::vector<SchemaFile>& schema();
const SchemaSection& schemaSection(std::string_view name);
/// The keys of a section in the order of the schema.
std::vector<std::string> keysOf(std::string_view section);

/// What a JSON schema may say beyond the sections: names that other modules own.
struct SchemaNames {
    struct TechniqueNames {
        std::string name;
        std::vector<KeyInfo> params;
        Outputs outputs;
        bool isOpen = false;  // further parameters, metrics and passes are the config's
    };
    std::vector<TechniqueNames> techniques;
    std::vector<std::string> generators;
};

/// `kind`: experiment, preset (what experiments extend), scene or documents.
/// JSON Schema, draft 7, as text. Throws UsageError for an unknown kind.
std::string jsonSchema(std::string_view kind, const SchemaNames& names);

/// The keys of an experiment in aligned columns (`gfxrepro describe config`).
std::string describeConfig();
/// The keys of all files as Markdown tables, for configs/README.md.
std::string describeConfigInMarkdown();

}  // namespace gfxrepro::config
