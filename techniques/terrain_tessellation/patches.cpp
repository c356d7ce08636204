#include "techniques/terrain_tessellation/patches.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::terrain_tessellation {

Patch patchOf(const Tile& tile, const TileSettings& settings, int index) {
    const glm::ivec2 cell(index % settings.patchesPerTile, index / settings.patchesPerTile);
    return {tile.level, tile.firstBlock + cell * settings.blocksPerPatch};
}

int patchesOnMap(const Tile& tile, const TileSettings& settings, glm::ivec2 mapSizeSamples) {
    const int span = tile.sizeSamples / settings.patchesPerTile;
    const glm::ivec2 cells = mapSizeSamples - 1 - tile.originSample;
    const glm::ivec2 count =
        glm::clamp((cells + span - 1) / span, glm::ivec2(0), glm::ivec2(settings.patchesPerTile));
    return count.x * count.y;
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
    const glm::dvec2 spacing(metadata.spacingM());
    const bool isAlongZ = edge == kWest || edge == kEast;
    const HeightRange range = edgeRange(metadata, settings.tile, patch, edge);
    const glm::dvec2 ends = edgeEndsM(metadata, settings.tile, patch, edge);
    const double across = span * (isAlongZ ? spacing.y : spacing.x);
    const double distance = std::hypot(across, ends.y - ends.x);  // D, in space
    const double length =                                         // L_AB, Eq. (3)
        std::max(double(range.maxM) - range.minM, distance) + range.errorM;
    glm::dvec2 middle = glm::dvec2(patch.firstBlock * blockSamples) + 0.5 * span;
    if (edge == kWest) middle.x -= 0.5 * span;
    if (edge == kEast) middle.x += 0.5 * span;
    if (edge == kNorth) middle.y -= 0.5 * span;
    if (edge == kSouth) middle.y += 0.5 * span;
    const glm::dvec3 centre(middle.x * spacing.x, 0.5 * (double(range.minM) + range.maxM),
                            middle.y * spacing.y);

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

namespace {

/// What a call has to know of a patch or a skirt's part.
struct PatchCost {
    std::uint32_t number = 0;
    float distanceM = 0.0F;
    double triangles = 0.0;  // an upper bound
    bool mayBeClipped = false;
};

class PatchCosts {
  public:
    PatchCosts(const TerrainMetadata& metadata, const FactorSettings& settings,
               const kit::View& view, const PatchesToDraw& patches)
        : metadata_(metadata),
          settings_(settings),
          view_(view),
          patches_(patches),
          clipFromWorld_(glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld)),
          rows_(glm::transpose(view.clipFromWorld())),
          frustum_(frustumPlanes(view)) {}

    std::vector<PatchCost> all() const {
        std::vector<PatchCost> costs;
        const int m = settings_.tile.patchesPerTile;
        std::uint32_t number = 0;
        for (const Tile& tile : patches_.tiles) {
            for (int i = 0; i < m * m; ++i, ++number) {
                if (!patches_.hasSurface) continue;
                costs.push_back(ofPatch(patchOf(tile, settings_.tile, i)));
                costs.back().number = number;
            }
            for (int i = 0; patches_.hasSkirts && i < 4 * m; ++i) {
                const Edge rim = static_cast<Edge>(i / m);
                const int far = rim == kEast || rim == kSouth ? m - 1 : 0;
                const bool isAlongZ = rim == kWest || rim == kEast;
                const int cell = isAlongZ ? i % m * m + far : far * m + i % m;
                costs.push_back(ofSkirt(patchOf(tile, settings_.tile, cell), rim));
                costs.back().number = number++;
            }
        }
        return costs;
    }

  private:
    double factor(const Patch& patch, Edge edge) const {
        return edgeFactor(metadata_, settings_, view_, clipFromWorld_, patch, edge);
    }

    glm::bvec2 isBeyondMap(const Patch& patch) const {
        const glm::ivec2 origin = patch.firstBlock * metadata_.blockSizeSamples(patch.level);
        return glm::greaterThanEqual(origin, metadata_.sizeSamples() - 1);
    }

    PatchCost ofPatch(const Patch& patch) const {
        if (glm::any(isBeyondMap(patch))) return {};
        const int count = settings_.tile.blocksPerPatch;
        HeightRange range =
            metadata_.block(patch.level, patch.firstBlock.x, patch.firstBlock.y).whole;
        for (int i = 1; i < count * count; ++i) {
            const glm::ivec2 at = patch.firstBlock + glm::ivec2(i % count, i / count);
            range.add(metadata_.block(patch.level, at.x, at.y).whole);
        }
        PatchCost cost = ofBox(patch, glm::vec2(0.0F), glm::vec2(1.0F), range);
        if (cost.triangles == 0.0) return cost;
        std::array<double, 4> outer;
        for (const Edge edge : {kWest, kNorth, kEast, kSouth}) outer[edge] = factor(patch, edge);
        if (settings_.edges == EdgeRule::OwnPatch) {
            outer.fill(0.25 * (outer[0] + outer[1] + outer[2] + outer[3]));
        }
        cost.triangles = triangleBound(outer, settings_.inner);
        return cost;
    }

    PatchCost ofSkirt(const Patch& patch, Edge rim) const {
        const bool isAlongZ = rim == kWest || rim == kEast;
        if (isBeyondMap(patch)[isAlongZ ? 1 : 0]) return {};
        HeightRange range = edgeRange(metadata_, settings_.tile, patch, rim);
        range.minM = patches_.footM;
        const glm::vec2 low(rim == kEast ? 1.0F : 0.0F, rim == kSouth ? 1.0F : 0.0F);
        const glm::vec2 high(rim == kWest ? 0.0F : 1.0F, rim == kNorth ? 0.0F : 1.0F);
        PatchCost cost = ofBox(patch, low, high, range);
        if (cost.triangles == 0.0) return cost;
        double rimFactor = factor(patch, rim);
        if (settings_.edges == EdgeRule::OwnPatch) rimFactor = settings_.greatest;
        // Two segments downwards at most, of two triangles each.
        cost.triangles = 4.0 * (rimFactor + 2.0);
        return cost;
    }

    /// Of the box over a part of the patch's square, on the map; no triangles where it is culled.
    PatchCost ofBox(const Patch& patch, glm::vec2 low, glm::vec2 high,
                    const HeightRange& range) const {
        const float block = static_cast<float>(metadata_.blockSizeSamples(patch.level));
        const glm::vec2 origin(patch.firstBlock);
        const auto corner = [&](glm::vec2 part, float height) {
            const glm::vec2 sample =
                (origin + part * static_cast<float>(settings_.tile.blocksPerPatch)) * block;
            const glm::vec2 at =
                glm::min(sample, glm::vec2(metadata_.sizeSamples() - 1)) * metadata_.spacingM();
            return glm::vec3(at.x, height, at.y);
        };
        const glm::vec3 a = corner(low, range.minM), b = corner(high, range.maxM);
        PatchCost cost;
        cost.distanceM = glm::distance(view_.eyeWorld, glm::clamp(view_.eyeWorld, a, b));
        cost.mayBeClipped = !isWithinFrustum(a, b);
        cost.triangles = isCulled(0.5F * (a + b), 0.5F * glm::distance(a, b)) ? 0.0 : 1.0;
        return cost;
    }

    bool isCulled(const glm::vec3& centre, float radius) const {
        return patches_.isCulling &&
               std::any_of(frustum_.begin(), frustum_.end(), [&](const glm::vec4& plane) {
                   return glm::dot(plane, glm::vec4(centre, 1.0F)) < -radius;
               });
    }

    /// Strictly inside the frustum, where no vertex is clipped.
    bool isWithinFrustum(const glm::vec3& a, const glm::vec3& b) const {
        for (int i = 0; i < 8; ++i) {
            const glm::vec4 corner((i & 1) != 0 ? b.x : a.x, (i & 2) != 0 ? b.y : a.y,
                                   (i & 4) != 0 ? b.z : a.z, 1.0F);
            const glm::vec4 clip = corner * rows_;
            if (std::abs(clip.x) >= clip.w || std::abs(clip.y) >= clip.w ||
                std::abs(clip.z) >= clip.w) {
                return false;
            }
        }
        return true;
    }

    const TerrainMetadata& metadata_;
    const FactorSettings& settings_;
    const kit::View& view_;
    const PatchesToDraw& patches_;
    glm::dmat4 clipFromWorld_;
    glm::mat4 rows_;  // the rows of clipFromWorld
    std::array<glm::vec4, 6> frustum_;
};

/// A call that still takes patches.
struct OpenBatch {
    double limit = 0.0, triangles = 0.0;
    std::vector<std::uint32_t> numbers;

    void close(PatchBatches& to) {
        if (numbers.empty()) return;
        to.order.insert(to.order.end(), numbers.begin(), numbers.end());
        to.batches.push_back({static_cast<std::uint32_t>(numbers.size()), triangles});
        numbers.clear();
        triangles = 0.0;
    }
    void add(const PatchCost& patch, PatchBatches& to) {
        if (triangles + patch.triangles > limit) close(to);
        numbers.push_back(patch.number);
        triangles += patch.triangles;
    }
};

}  // namespace

PatchBatches batchPatches(const TerrainMetadata& metadata, const FactorSettings& settings,
                          const kit::View& view, const PatchesToDraw& patches,
                          const BatchLimits& limits) {
    std::vector<PatchCost> costs = PatchCosts(metadata, settings, view, patches).all();
    // The nearest first: hidden fragments fail the depth test before they are shaded.
    std::stable_sort(costs.begin(), costs.end(), [](const PatchCost& a, const PatchCost& b) {
        return a.distanceM < b.distanceM;
    });
    PatchBatches result;
    OpenBatch whole{static_cast<double>(limits.triangles), 0.0, {}};
    OpenBatch clipped{static_cast<double>(limits.clippedTriangles), 0.0, {}};
    for (const PatchCost& cost : costs) {
        // A culled patch has nothing to clip.
        (cost.mayBeClipped && cost.triangles > 0.0 ? clipped : whole).add(cost, result);
    }
    clipped.close(result);
    whole.close(result);
    return result;
}

}  // namespace gfxrepro::terrain_tessellation
