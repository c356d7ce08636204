#include "techniques/terrain_tessellation/patch_batches.h"

#include <algorithm>
#include <array>

namespace gfxrepro::terrain_tessellation {

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

    PatchCost ofPatch(const Patch& patch) const {
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

    /// Of the box over a part of the patch's square; no triangles where it is culled.
    PatchCost ofBox(const Patch& patch, glm::vec2 low, glm::vec2 high,
                    const HeightRange& range) const {
        const float block = static_cast<float>(metadata_.blockSizeSamples(patch.level));
        const glm::vec2 origin(patch.firstBlock);
        const auto corner = [&](glm::vec2 part, float height) {
            const glm::vec2 at =
                (origin + part * static_cast<float>(settings_.tile.blocksPerPatch)) * block *
                metadata_.spacingM();
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
