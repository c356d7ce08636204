#include "techniques/terrain_tessellation/factor_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::terrain_tessellation {

FactorReplay::FactorReplay(const gl::ShaderLibrary& shaders, const DeviceTerrain& terrain,
                           const RenderSettings& settings)
    : terrain_(&terrain),
      settings_(settings),
      pass_(shaders, {"terrain_tessellation/factor_replay.comp.glsl"},
            terrainDefines(terrain, settings)) {}

std::vector<PatchFactors> FactorReplay::run(std::span<const Tile> tiles, const kit::View& view) {
    const int side = settings_.factors.tile.patchesPerTile;
    const auto count = tiles.size() * static_cast<std::size_t>(side * side);
    if (count == 0) return {};
    const std::vector<int> noLayers(tiles.size(), 0);  // heights are not read
    const gl::Buffer records = tileRecords(tiles, noLayers);
    const gl::Buffer factors(count * sizeof(PatchFactors));
    setTerrain(pass_, *terrain_, view);
    setFactors(pass_, settings_, view);
    pass_.set("patchCount", static_cast<int>(count));
    pass_.dispatch(
        {kit::groupsFor(count, 64), 1, 1},
        gl::Resources{{"Tiles", records}, {"Factors", factors}}.with(terrain_->resources()));
    return factors.read<PatchFactors>(count);
}

FactorHalving compareHalving(const FactorSettings& settings, std::span<const PatchFactors> factors,
                             std::span<const PatchFactors> coarser) {
    GFXREPRO_ASSERT_EQ(factors.size(), coarser.size());
    FactorHalving halving;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        for (int edge = 0; edge < 4; ++edge) {
            const float fine = factors[i].outer[edge], coarse = coarser[i].outer[edge];
            if (fine < 0.0F) continue;
            ++halving.edges;
            if (fine >= settings.greatest) ++halving.greatestEdges;
            if (fine >= settings.greatest || coarse <= settings.smallest) continue;
            ++halving.unclampedEdges;
            if (fine != 2.0F * coarse) ++halving.unhalvedEdges;
        }
    }
    return halving;
}

EdgeJumps edgeJumps(std::span<const PatchFactors> factors, InnerFactors inner) {
    EdgeJumps jumps;
    double sum = 0.0;
    int count = 0;
    for (const PatchFactors& patch : factors) {
        if (patch.outer.x < 0.0F) continue;
        for (int edge = 0; edge < 4; ++edge) {
            const double outer = patch.outer[edge], opposite = patch.outer[(edge + 2) % 4];
            const double jump = outer / innerFactor(inner, outer, opposite);
            if (jump <= 1.0) continue;
            sum += jump;
            ++count;
            jumps.greatest = std::max(jumps.greatest, jump);
        }
    }
    if (count > 0) jumps.mean = sum / count;
    return jumps;
}

EdgeAgreement compareEdges(std::span<const Tile> tiles, const TileSettings& settings,
                           std::span<const PatchFactors> factors) {
    // Level, first block along the edge, and whether it runs along x.
    std::map<std::array<int, 4>, float> seen;
    EdgeAgreement agreement;
    const int perTile = settings.patchesPerTile * settings.patchesPerTile;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        const Tile& tile = tiles[i / static_cast<std::size_t>(perTile)];
        const Patch patch = patchOf(tile, settings, static_cast<int>(i) % perTile);
        for (const Edge edge : {kWest, kNorth, kEast, kSouth}) {
            const float factor = factors[i].outer[edge];
            if (factor < 0.0F) continue;
            glm::ivec2 at = patch.firstBlock;
            if (edge == kEast) at.x += settings.blocksPerPatch;
            if (edge == kSouth) at.y += settings.blocksPerPatch;
            const bool isAlongX = edge == kNorth || edge == kSouth;
            const auto [place, isNew] =
                seen.try_emplace({patch.level, at.x, at.y, isAlongX ? 1 : 0}, factor);
            if (isNew) continue;
            ++agreement.sharedEdges;
            if (std::bit_cast<unsigned>(place->second) != std::bit_cast<unsigned>(factor)) {
                ++agreement.unequalEdges;
            }
        }
    }
    return agreement;
}

}  // namespace gfxrepro::terrain_tessellation
