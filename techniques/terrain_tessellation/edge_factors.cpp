#include "techniques/terrain_tessellation/edge_factors.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::terrain_tessellation {

Patch patchOf(const Tile& tile, const TileSettings& settings, int index) {
    const glm::ivec2 cell(index % settings.patchesPerTile, index / settings.patchesPerTile);
    return {tile.level, tile.firstBlock + cell * settings.blocksPerPatch};
}

HeightRange edgeRange(const TerrainMetadata& metadata, const TileSettings& settings,
                      const Patch& patch, Edge edge) {
    const int last = settings.blocksPerPatch - 1;
    const bool isAlongZ = edge == kWest || edge == kEast;
    const glm::ivec2 along = isAlongZ ? glm::ivec2(0, 1) : glm::ivec2(1, 0);
    glm::ivec2 block = patch.firstBlock;
    if (edge == kEast) block.x += last;
    if (edge == kSouth) block.y += last;
    HeightRange range = metadata.block(patch.level, block.x, block.y).edges[edge];
    for (int i = 0; i < last; ++i) {
        block += along;
        range.add(metadata.block(patch.level, block.x, block.y).edges[edge]);
    }
    return range;
}

glm::vec2 edgeEndsM(const TerrainMetadata& metadata, const TileSettings& settings,
                    const Patch& patch, Edge edge) {
    const int last = settings.blocksPerPatch - 1;
    const glm::ivec2 first(edge == kEast ? 1 : 0, edge == kSouth ? 1 : 0);
    const auto heightAt = [&](glm::ivec2 corner) {
        const glm::ivec2 block = patch.firstBlock + last * corner;
        return metadata.block(patch.level, block.x, block.y)
            .cornersM[static_cast<std::size_t>(corner.x + 2 * corner.y)];
    };
    const bool isAlongZ = edge == kWest || edge == kEast;
    return {heightAt(first), heightAt(first + (isAlongZ ? glm::ivec2(0, 1) : glm::ivec2(1, 0)))};
}

double edgeFactor(const TerrainMetadata& metadata, const FactorSettings& settings,
                  const kit::View& view, const Patch& patch, Edge edge) {
    const glm::dmat4 clipFromWorld = glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld);
    return edgeFactor(metadata, settings, view, clipFromWorld, patch, edge);
}

double edgeFactor(const TerrainMetadata& metadata, const FactorSettings& settings,
                  const kit::View& view, const glm::dmat4& clipFromWorld, const Patch& patch,
                  Edge edge) {
    const int blockSamples = metadata.blockSizeSamples(patch.level);
    const double span = settings.tile.blocksPerPatch * blockSamples;
    const double spacing = metadata.spacingM();
    const HeightRange range = edgeRange(metadata, settings.tile, patch, edge);
    const glm::dvec2 ends = edgeEndsM(metadata, settings.tile, patch, edge);
    const double distance = std::hypot(span * spacing, ends.y - ends.x);  // D, in space
    const double length =                                                 // L_AB, Eq. (3)
        std::max(double(range.maxM) - range.minM, distance) + range.errorM;
    glm::dvec2 middle = glm::dvec2(patch.firstBlock * blockSamples) + 0.5 * span;
    if (edge == kWest) middle.x -= 0.5 * span;
    if (edge == kEast) middle.x += 0.5 * span;
    if (edge == kNorth) middle.y -= 0.5 * span;
    if (edge == kSouth) middle.y += 0.5 * span;
    const glm::dvec3 centre(middle.x * spacing, 0.5 * (double(range.minM) + range.maxM),
                            middle.y * spacing);

    const glm::dvec2 halfPx = 0.5 * glm::dvec2(view.sizePx);
    const double nearest = view.nearM;
    const double focalPx = double(view.clipFromView[0].x) * halfPx.x;
    double lengthPx = 0.0;  // L_CD
    if (settings.segment == Segment::Vertical) {
        const glm::dvec3 half(0.0, 0.5 * length, 0.0);
        const glm::dvec4 c = clipFromWorld * glm::dvec4(centre - half, 1.0);
        const glm::dvec4 d = clipFromWorld * glm::dvec4(centre + half, 1.0);
        if (std::min(c.w, d.w) < nearest) return settings.greatest;
        lengthPx = glm::length((glm::dvec2(d) / d.w - glm::dvec2(c) / c.w) * halfPx);
    } else if (settings.segment == Segment::ViewFacing) {
        const double depth = (clipFromWorld * glm::dvec4(centre, 1.0)).w;
        lengthPx = length * focalPx / std::max(depth, nearest);
    } else {
        const double away = glm::distance(glm::dvec3(view.eyeWorld), centre);
        lengthPx = length * focalPx / std::max(away, nearest);
    }
    return std::clamp(lengthPx / settings.segmentPx, double(settings.smallest),
                      double(settings.greatest));
}

double innerFactor(InnerFactors inner, double a, double b) {
    if (inner == InnerFactors::Mean) return 0.5 * (a + b);
    return inner == InnerFactors::Minimum ? std::min(a, b) : std::max(a, b);
}

int patchVertices(const std::array<double, 4>& outer, InnerFactors inner) {
    const auto segments = [](double factor) {
        return 2 * static_cast<int>(std::ceil(0.5 * std::max(factor, 2.0)));
    };
    const int across = segments(innerFactor(inner, outer[1], outer[3]));
    const int down = segments(innerFactor(inner, outer[0], outer[2]));
    int count = (across - 1) * (down - 1);
    for (const double factor : outer) count += segments(factor);
    return count;
}

double triangleBound(const std::array<double, 4>& outer, InnerFactors inner) {
    // No spacing makes more than the factor and two segments of it.
    const double across = innerFactor(inner, outer[1], outer[3]) + 2.0;
    const double down = innerFactor(inner, outer[0], outer[2]) + 2.0;
    double rim = 0.0;
    for (const double factor : outer) rim += factor + 2.0;
    return 2.0 * across * down + rim;
}

}  // namespace gfxrepro::terrain_tessellation
