// How finely textures are read, on all sides: drawn surfaces, clusters' images and rays.
#pragma once

#include "engine/core/params.h"

namespace gfxrepro::reflections {

enum class TextureFilter {
    Footprint,    // averaged over what a sample, a texel or a ray covers, by levels half as fine
    FinestLevel,  // as they are
};

constexpr Choice<TextureFilter> kTextureFilters[] = {
    {TextureFilter::Footprint, "footprint", "averaged over what a sample, a texel or a ray covers"},
    {TextureFilter::FinestLevel, "finest_level", "as they are, however much a sample covers"},
};
constexpr ParamSpec kTextureFilterSpec = {"how textures are read"};

}  // namespace gfxrepro::reflections
