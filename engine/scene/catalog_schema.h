// The keys of a scene of the catalogue.
#pragma once

#include <array>
#include <string_view>

#include "engine/core/key_schema.h"
#include "engine/scene/height_map.h"

namespace gfxrepro::scene {

// What numbers and names of a source may be.
inline constexpr NumberRange kCounts{.least = 1, .isWhole = true};
inline constexpr NumberRange kSamplesPerSide{
    .least = 1, .most = kMaxHeightFileSide, .isWhole = true};
inline constexpr NumberRange kSeeds{.least = 0, .isWhole = true};
inline constexpr NumberRange kMetres{.least = 1e-9, .most = 1e6};
inline constexpr std::array<std::string_view, 2> kUps = {"y", "z"};

SchemaFile sceneSchema();

}  // namespace gfxrepro::scene
