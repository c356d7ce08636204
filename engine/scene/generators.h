// What a seeded scene generator is: same seed, same bytes, on every machine. The program gives its
// generators to whoever asks for one; this module has none.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/params.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// Part of the identity of generated scenes: goes up when a generator's output changes.
constexpr int kGeneratorVersion = 2;

/// A generator reads its parameters by declaration (so `describe` can print them), refuses unknown
/// ones, and returns a scene; its name and origin are the caller's to fill.
struct GeneratorInfo {
    std::string_view name;
    std::string_view summary;
    Scene (*generate)(Params& params, std::uint64_t seed);
    bool isSeeded = true;  // false: every seed makes the same scene
};

/// What the generator declares; throws Error where it does not take `values` (a map or null). No
/// scene is made.
std::vector<KeyInfo> declaredParams(const GeneratorInfo& generator, const Node& values);

/// Throws Error with the nearest name when none of `generators` has that name.
const GeneratorInfo& findGenerator(std::span<const GeneratorInfo> generators, std::string_view name,
                                   const SourceLocation& where);

}  // namespace gfxrepro::scene
