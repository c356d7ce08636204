#include "techniques/point_splatting/linear_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>

#include "engine/core/error.h"
#include "engine/scene/covariance.h"

namespace gfxrepro::point_splatting {

namespace {

using Indices = std::span<std::uint32_t>;

/// The least axis-aligned cone around the mean of normals: its half angle; π where they cancel.
struct NormalCone {
    glm::vec3 mean{0.0F, 1.0F, 0.0F};
    float halfAngleRad = glm::pi<float>();
};
NormalCone coneOf(const scene::PointCloud& points, Indices indices) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t i : indices) sum += glm::dvec3(points.normals[i]);
    const double length = glm::length(sum);
    NormalCone cone;
    if (length < 1e-6 * static_cast<double>(indices.size())) return cone;
    cone.mean = glm::vec3(sum / length);
    float least = 1.0F;
    for (const std::uint32_t i : indices) {
        least = std::min(least, glm::dot(cone.mean, points.normals[i]));
    }
    cone.halfAngleRad = std::acos(std::clamp(least, -1.0F, 1.0F));
    return cone;
}

struct Spread {
    glm::dvec3 mean{0.0};
    scene::Eigensystem axes;
};
Spread spreadOf(const scene::PointCloud& points, Indices indices) {
    scene::Covariance covariance;
    for (const std::uint32_t i : indices) covariance.add(points.positions[i]);
    return {covariance.mean(), scene::eigensystem(covariance.matrix())};
}

/// Puts the points before the plane through the mean, across the principal axis, first; returns how
/// many they are. Halves where the plane does not divide.
std::size_t split(const scene::PointCloud& points, Indices indices, const Spread& spread) {
    const glm::dvec3 axis = spread.axes.vectors[2];
    const auto middle = std::partition(indices.begin(), indices.end(), [&](std::uint32_t i) {
        return glm::dot(glm::dvec3(points.positions[i]) - spread.mean, axis) < 0.0;
    });
    const auto before = static_cast<std::size_t>(middle - indices.begin());
    return before == 0 || before == indices.size() ? indices.size() / 2 : before;
}

/// Ranges of `indices` that are patches, in order.
using Ranges = std::vector<Indices>;

Ranges cutIntoPatches(const scene::PointCloud& points, Indices indices,
                      const TreeSettings& settings) {
    const std::size_t count = indices.size();
    if (count <= settings.minPatchPoints ||
        (count <= settings.maxPatchPoints &&
         coneOf(points, indices).halfAngleRad <= settings.patchConeRad)) {
        return {indices};
    }
    const std::size_t before = split(points, indices, spreadOf(points, indices));
    Ranges first, second;
    const auto cutFirst = [&] { first = cutIntoPatches(points, indices.first(before), settings); };
    const auto cutSecond = [&] {
        second = cutIntoPatches(points, indices.subspan(before), settings);
    };
    constexpr std::size_t kWorthATask = 1U << 14;
    if (count > kWorthATask) {
        tbb::parallel_invoke(cutFirst, cutSecond);
    } else {
        cutFirst();
        cutSecond();
    }
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

/// A patch's points in breadth-first order, and its levels.
class LinearTree {
  public:
    LinearTree(const scene::PointCloud& points, Indices indices)
        : points_(points), order_(indices.size()), levels_(1) {
        std::vector<Indices> nodes{indices};
        std::size_t placed = 0;
        while (!nodes.empty()) {
            const bool isLast = levels_.size() == kMaxLevels;
            std::vector<Indices> next;
            for (Indices node : nodes) {
                if (isLast) {
                    for (const std::uint32_t i : node) order_[placed++] = i;
                } else {
                    order_[placed++] = takeNode(node, next);
                }
            }
            finishLevel(placed);
            nodes = std::move(next);
            if (!nodes.empty()) levels_.emplace_back();
        }
        // All points stand for themselves.
        levels_.back().radiusScale = 1.0F;
        for (Level& level : levels_) setRadii(level);
    }
    const std::vector<std::uint32_t>& order() const { return order_; }
    const std::vector<Level>& levels() const { return levels_; }

  private:
    /// The node's own point, the nearest to the mean; the others become its children.
    std::uint32_t takeNode(Indices node, std::vector<Indices>& children) {
        if (node.size() == 1) {
            coverage_.push_back(1.0F);
            return node[0];
        }
        const Spread spread = spreadOf(points_, node);
        const auto distance2 = [&](std::uint32_t i) {
            const glm::dvec3 away = glm::dvec3(points_.positions[i]) - spread.mean;
            return glm::dot(away, away);
        };
        const auto nearest =
            std::min_element(node.begin(), node.end(), [&](std::uint32_t a, std::uint32_t b) {
                return std::pair(distance2(a), a) < std::pair(distance2(b), b);
            });
        std::swap(node[0], *nearest);
        const std::uint32_t own = node[0];
        float reach = 0.0F;
        for (const std::uint32_t i : node) {
            reach = std::max(reach, glm::distance(points_.positions[i], points_.positions[own]));
        }
        coverage_.push_back(std::max(reach / points_.radii[own], 1.0F));
        const Indices rest = node.subspan(1);
        const std::size_t before = split(points_, rest, spread);
        if (before > 0) children.push_back(rest.first(before));
        if (before < rest.size()) children.push_back(rest.subspan(before));
        return own;
    }

    /// The scale that covers what nine of ten nodes stand for: the tenth would blur all others, and
    /// the discs of coarser nodes lie over it.
    void finishLevel(std::size_t placed) {
        Level& level = levels_.back();
        level.count = static_cast<std::uint32_t>(placed);
        if (coverage_.empty()) return;
        const auto rank = static_cast<std::ptrdiff_t>(coverage_.size() - 1) * 9 / 10;
        std::nth_element(coverage_.begin(), coverage_.begin() + rank, coverage_.end());
        level.radiusScale = coverage_[static_cast<std::size_t>(rank)];
        coverage_.clear();
    }

    void setRadii(Level& level) const {
        level.minRadius = std::numeric_limits<float>::max();
        double sum = 0.0;
        for (std::uint32_t k = 0; k < level.count; ++k) {
            const float radius = points_.radii[order_[k]] * level.radiusScale;
            level.minRadius = std::min(level.minRadius, radius);
            level.maxRadius = std::max(level.maxRadius, radius);
            sum += static_cast<double>(radius);
        }
        level.meanRadius = static_cast<float>(sum / static_cast<double>(level.count));
    }

    const scene::PointCloud& points_;
    std::vector<std::uint32_t> order_;
    std::vector<Level> levels_;
    std::vector<float> coverage_;  // of the level's nodes: reach in own radii
};

Patch patchOf(const scene::PointCloud& points, Indices indices) {
    Patch patch;
    patch.pointCount = static_cast<std::uint32_t>(indices.size());
    for (const std::uint32_t i : indices) patch.bounds.add(points.positions[i]);
    const NormalCone cone = coneOf(points, indices);
    patch.meanNormal = cone.mean;
    patch.coneRad = cone.halfAngleRad;
    const glm::dvec3 values = spreadOf(points, indices).axes.values;
    const double sum = values[0] + values[1] + values[2];
    patch.curvature = sum > 0.0 ? static_cast<float>(std::max(values[0], 0.0) / sum) : 0.0F;
    return patch;
}

}  // namespace

PointModel buildModel(const scene::PointCloud& points, const TreeSettings& settings) {
    const std::size_t count = points.positions.size();
    if (count == 0) throw Error("a point model of no points");
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0U);
    const Ranges ranges = cutIntoPatches(points, indices, settings);

    PointModel model;
    model.patches.resize(ranges.size());
    std::vector<std::vector<Level>> levels(ranges.size());
    std::vector<std::uint32_t> order(count);
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t p) {
        const Indices range = ranges[p];
        Patch& patch = model.patches[p];
        patch = patchOf(points, range);
        patch.firstPoint = static_cast<std::uint32_t>(range.data() - indices.data());
        const LinearTree tree(points, range);
        std::copy(tree.order().begin(), tree.order().end(), order.begin() + patch.firstPoint);
        levels[p] = tree.levels();
    });
    for (std::size_t p = 0; p < ranges.size(); ++p) {
        Patch& patch = model.patches[p];
        patch.firstLevel = static_cast<std::uint32_t>(model.levels.size());
        patch.levelCount = static_cast<std::uint32_t>(levels[p].size());
        model.levels.insert(model.levels.end(), levels[p].begin(), levels[p].end());
        model.bounds.add(patch.bounds);
    }
    model.positions.resize(count);
    model.normals.resize(count);
    model.radii.resize(count);
    model.colors.resize(points.colors.empty() ? 0 : count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
        const std::uint32_t from = order[k];
        model.positions[k] = points.positions[from];
        model.normals[k] = points.normals[from];
        model.radii[k] = points.radii[from];
        if (!model.colors.empty()) model.colors[k] = points.colors[from];
    });
    return model;
}

}  // namespace gfxrepro::point_splatting
