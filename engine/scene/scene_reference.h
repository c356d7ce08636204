// How configs and records name a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/node.h"

namespace gfxrepro::scene {

/// "outdoor/city", "outdoor/city@3" (at another seed), "outdoor/city?towers=4&width=0.5@3" (with
/// parameters of its generator), or a file ("scan.glb").
struct SceneReference {
    std::string name;                 // catalogued, or the file's path
    Node params = Node::map({});      // of the generator, laid over the catalogue's
    std::optional<std::string> seed;  // as written

    /// Throws Error for what stands behind a '?' and is no NAME=VALUE.
    static SceneReference from(const Node& reference);
    std::string text() const;
};

/// Whether a parameter or selector of this name is a reference: `scene`, and `scene_b`, `scene_c`,
/// … of techniques that take further models.
bool isSceneKey(std::string_view key);

/// Whether the reference is a file's path: it has a file extension.
bool isSceneFile(const std::string& reference);

/// The reference without seed and parameters.
std::string sceneName(const std::string& reference);

/// The same scene at another seed; one that `reference` has already is replaced.
Node withSeed(const Node& reference, std::uint64_t seed);

/// The same scene with these parameters of its generator laid over those that `reference` has.
/// Throws Error for a value that is no number, boolean or name.
Node withSceneParams(const Node& reference, const Node& params);

}  // namespace gfxrepro::scene
