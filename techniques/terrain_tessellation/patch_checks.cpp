#include "techniques/terrain_tessellation/patch_checks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <tuple>
#include <vector>

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

namespace {

using Place = std::array<std::uint32_t, 4>;  // the bits in clip space

Place placeOf(const CapturedVertex& vertex) {
    Place place;
    for (int i = 0; i < 4; ++i) {
        place[static_cast<std::size_t>(i)] = std::bit_cast<std::uint32_t>(vertex.positionClip[i]);
    }
    return place;
}

/// Of a triangle, from its lesser end to its greater.
struct TriangleEdge {
    Place from, to;
    bool isTurned = false;  // it ran the other way
    bool mayBeOpen = false;

    auto ends() const { return std::tie(from, to); }
};

/// The squares that patches and tiles cover.
class Borders {
  public:
    Borders(std::span<const Tile> tiles, const TileSettings& settings,
            std::span<const PatchFactors> factors)
        : tiles_(tiles),
          factors_(factors),
          side_(settings.patchesPerTile),
          perTile_(side_ * side_) {
        GFXREPRO_ASSERT_EQ(factors.size(), tiles.size() * static_cast<std::size_t>(perTile_));
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const Tile& tile = tiles[i];
            drawn_[{tile.level, tile.originSample.x, tile.originSample.y}] = static_cast<int>(i);
        }
    }

    enum class Kind { Inside, BetweenPatches, BetweenTiles, Rim };
    Kind kindOf(const CapturedVertex& a, const CapturedVertex& b) const {
        const Tile& tile = tiles_[static_cast<std::size_t>(a.patch / perTile_)];
        const int span = tile.sizeSamples / side_;
        const glm::ivec2 cell = cellOf(a.patch);
        for (int axis = 0; axis < 2; ++axis) {
            if (a.at[axis] != b.at[axis]) continue;
            for (const int outwards : {-1, 1}) {
                const int line =
                    tile.originSample[axis] + (cell[axis] + (outwards > 0 ? 1 : 0)) * span;
                if (a.at[axis] != static_cast<float>(line)) continue;
                glm::ivec2 beyond = cell;
                beyond[axis] += outwards;
                return kindBeyond(a.patch / perTile_, beyond);
            }
        }
        return Kind::Inside;
    }
    bool isInside(const CapturedVertex& vertex) const {
        const Tile& tile = tiles_[static_cast<std::size_t>(vertex.patch / perTile_)];
        const auto span = static_cast<float>(tile.sizeSamples / side_);
        const glm::vec2 in =
            vertex.at - glm::vec2(tile.originSample) - glm::vec2(cellOf(vertex.patch)) * span;
        return in.x > 0.0F && in.y > 0.0F && in.x < span && in.y < span;
    }

  private:
    glm::ivec2 cellOf(int patch) const {
        return {patch % perTile_ % side_, patch % perTile_ / side_};
    }
    /// Of a border to a cell that may lie beyond the tile.
    Kind kindBeyond(int tileIndex, glm::ivec2 cell) const {
        const Tile& tile = tiles_[static_cast<std::size_t>(tileIndex)];
        const glm::ivec2 tileStep(glm::floor(glm::vec2(cell) / static_cast<float>(side_)));
        const glm::ivec2 origin = tile.originSample + tileStep * tile.sizeSamples;
        const auto other = drawn_.find({tile.level, origin.x, origin.y});
        if (other == drawn_.end()) return Kind::Rim;
        const glm::ivec2 inside = cell - tileStep * side_;
        const int patch = other->second * perTile_ + inside.y * side_ + inside.x;
        if (factors_[static_cast<std::size_t>(patch)].outer.x < 0.0F) return Kind::Rim;
        return tileStep == glm::ivec2(0) ? Kind::BetweenPatches : Kind::BetweenTiles;
    }

    std::span<const Tile> tiles_;
    std::span<const PatchFactors> factors_;
    int side_, perTile_;
    std::map<std::tuple<int, int, int>, int> drawn_;  // by level and origin
};

/// Those of a group of edges with the same ends that have no partner.
std::size_t openOf(std::span<const TriangleEdge> group) {
    std::size_t turned = 0, optional = 0;
    for (const TriangleEdge& edge : group) {
        if (edge.isTurned) ++turned;
        if (edge.mayBeOpen) ++optional;
    }
    const std::size_t straight = group.size() - turned;
    const std::size_t alone = straight > turned ? straight - turned : turned - straight;
    return alone > optional ? alone - optional : 0;
}

void countPatches(const Borders& borders, std::span<const CapturedVertex> vertices, Seams& seams) {
    using Corner = std::tuple<int, float, float>;  // patch, place
    std::vector<std::pair<Corner, bool>> corners;
    corners.reserve(vertices.size());
    for (const CapturedVertex& vertex : vertices) {
        corners.push_back({{vertex.patch, vertex.at.x, vertex.at.y}, borders.isInside(vertex)});
    }
    std::sort(corners.begin(), corners.end());
    std::size_t ofPatch = 0;
    for (std::size_t first = 0, next = 0; first < corners.size(); first = next) {
        while (next < corners.size() && corners[next].first == corners[first].first) ++next;
        const bool isNewPatch = first == 0 || std::get<0>(corners[first].first) !=
                                                  std::get<0>(corners[first - 1].first);
        ofPatch = isNewPatch ? 1 : ofPatch + 1;
        seams.mostVertices = std::max(seams.mostVertices, ofPatch);
        if (corners[first].second) seams.largestFan = std::max(seams.largestFan, next - first);
    }
}

}  // namespace

Seams checkSeams(std::span<const Tile> tiles, const TileSettings& settings,
                 std::span<const PatchFactors> factors, std::span<const CapturedVertex> vertices) {
    GFXREPRO_ASSERT_EQ(vertices.size() % 3, 0U);
    const Borders borders(tiles, settings, factors);
    Seams seams;
    std::vector<TriangleEdge> edges;
    edges.reserve(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const CapturedVertex& a = vertices[i];
        const CapturedVertex& b = vertices[i % 3 == 2 ? i - 2 : i + 1];
        TriangleEdge edge{placeOf(a), placeOf(b)};
        if (edge.from == edge.to) continue;
        const Borders::Kind kind = borders.kindOf(a, b);
        if (kind == Borders::Kind::BetweenPatches) ++seams.patchEdges;
        if (kind == Borders::Kind::BetweenTiles) ++seams.tileEdges;
        edge.mayBeOpen = kind == Borders::Kind::Rim;
        if (!edge.mayBeOpen) ++seams.edges;
        edge.isTurned = edge.to < edge.from;
        if (edge.isTurned) std::swap(edge.from, edge.to);
        edges.push_back(edge);
    }
    std::sort(edges.begin(), edges.end(),
              [](const TriangleEdge& a, const TriangleEdge& b) { return a.ends() < b.ends(); });
    for (std::size_t first = 0, next = 0; first < edges.size(); first = next) {
        while (next < edges.size() && edges[next].ends() == edges[first].ends()) ++next;
        seams.openEdges += openOf(std::span(edges).subspan(first, next - first));
    }
    countPatches(borders, vertices, seams);
    return seams;
}

}  // namespace gfxrepro::terrain_tessellation
