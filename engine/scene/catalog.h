// The catalogue of named scenes: configs/scenes/**/*.yaml, each with its sources in order of
// preference.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/node.h"
#include "engine/scene/generators.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// A scene that is a height map's file, and how it is read.
struct HeightMapSource {
    HeightMapUnits units;
    std::optional<int> resampleTo;  // samples on the longer side
    float detailM = 0.0F;           // of noise between the file's samples, when resampled
    /// PNG of the ground's colours over the whole map, north on top, below the assets folder; may
    /// be empty. It becomes the scene's first material.
    std::string colourMap = {};
};

/// "real", "stand-in", "generated".
std::string_view kindName(Origin::Kind kind);

/// One way to get a scene: a file of the assets folder, possibly refined to a triangle count, or a
/// generator.
struct SceneSource {
    std::string file;  // relative to the assets folder, or absolute; empty: generated
    std::optional<long long>
        refineTo;        // triangles: longest edges are split until the count is reached
    bool isZUp = false;  // the file's up is +z: turned so that it is +y
    std::optional<long long> points;  // the surface sampled (or its points thinned) to this many
    std::optional<HeightMapSource> heightMap;  // `file` is one
    const GeneratorInfo* generator = nullptr;  // one of those the catalogue was given
    Node params;                               // of the generator
    std::uint64_t seed = 1;
    Origin::Kind kind = Origin::Kind::Real;
    SourceLocation where;

    /// Whether another seed makes another scene.
    bool isSeeded() const;
};

struct SceneEntry {
    std::string name;  // "models/dragon" = configs/scenes/models/dragon.yaml
    std::string doc;
    std::string canonical;  // where a user gets the real thing; may be empty
    std::string licence;    // its terms, in words; may be empty
    std::vector<SceneSource> sources;
    std::filesystem::path path;
};

/// Lays parameters over those of the source's generator; of a height map's own file they are
/// spacing_m (what the file says, or 1), height_scale_m (1) and no_data, of a model's own file up
/// (y or z). Throws Error where the scene `name` is none of these, and for what is not taken.
void takeParams(const std::string& name, const Node& params, SceneSource& source);

class Catalog {
  public:
    /// Reads every YAML file under `scenesFolder`, whose sources may name one of `generators`
    /// (which must outlive the catalogue). Throws Error on the first that is wrong.
    Catalog(const std::filesystem::path& scenesFolder, std::filesystem::path assetsFolder,
            std::span<const GeneratorInfo> generators);

    const std::map<std::string, SceneEntry>& entries() const { return entries_; }

    /// The source that load() would take: the first whose file is there, or a generator.
    /// A reference with a file extension is a user's own file, relative to the file that names it;
    /// one with a seed or parameters is a generated scene of those instead of its own
    /// (SceneReference). Throws Error for unknown names (with the nearest) and for entries
    /// none of whose sources is at hand (with where it looked and how to get it).
    SceneSource resolve(const Node& reference) const;
    /// Identity of the content: changes when the file, one that it draws in (filesBeside()), or the
    /// generator's parameters change.
    /// Remembers the digests of files by size and time, so not for several threads at once.
    std::string contentKey(const Node& reference) const;
    Scene load(const Node& reference) const;
    /// The names of its camera paths, then of its cameras; a scene is loaded once for them.
    /// Remembers them, so not for several threads at once.
    const std::vector<std::string>& viewNames(const Node& reference) const;

    const std::filesystem::path& assetsFolder() const { return assetsFolder_; }

  private:
    struct FileDigest {
        std::uintmax_t sizeBytes = 0;
        std::filesystem::file_time_type time;
        std::string sha256;
        std::vector<std::filesystem::path> beside;  // what else belongs to a model
    };
    const FileDigest& digestOf(const std::filesystem::path& path) const;
    const SceneEntry& entryNamed(const Node& reference) const;
    SceneSource sourceOf(const Node& reference) const;

    std::filesystem::path assetsFolder_;
    std::map<std::string, SceneEntry> entries_;
    mutable std::map<std::filesystem::path, FileDigest> digests_;
    mutable std::map<std::string, std::vector<std::string>>
        viewNames_;  // by reference, and the file that names a file
};

}  // namespace gfxrepro::scene
