#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <queue>
#include <tuple>

#include "engine/core/error.h"
#include "engine/scene/covariance.h"
#include "engine/scene/load_text.h"
#include "engine/scene/point_sampling.h"

namespace gfxrepro::scene {

namespace {

constexpr std::size_t kNormalNeighbours = 16;
constexpr std::size_t kRadiusNeighbours = 6;

template <class T>
void keep(std::vector<T>& values, const std::vector<std::size_t>& indices) {
    if (values.empty()) return;
    std::vector<T> kept;
    kept.reserve(indices.size());
    for (const std::size_t i : indices) kept.push_back(values[i]);
    values = std::move(kept);
}

/// Leaves one of several points at the same place (the first) and none that is not finite.
void dropUseless(PointCloud& points, PointRepairs& repairs) {
    const auto& p = points.positions;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (isFinite(p[i])) order.push_back(i);
    }
    repairs.dropped = p.size() - order.size();
    const auto place = [&](std::size_t i) { return std::tie(p[i].x, p[i].y, p[i].z); };
    tbb::parallel_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tuple_cat(place(a), std::tie(a)) < std::tuple_cat(place(b), std::tie(b));
    });
    const auto end = std::unique(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return place(a) == place(b);
    });
    repairs.duplicates = static_cast<std::size_t>(order.end() - end);
    order.erase(end, order.end());
    tbb::parallel_sort(order.begin(), order.end());
    if (order.size() == p.size()) return;
    keep(points.normals, order);
    keep(points.radii, order);
    keep(points.colors, order);
    keep(points.positions, order);
}

/// A cloud as nanoflann reads it.
struct Adaptor {
    const std::vector<glm::vec3>& positions;
    std::size_t kdtree_get_point_count() const { return positions.size(); }
    float kdtree_get_pt(std::size_t index, std::size_t axis) const {
        return positions[index][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>,
                                                 Adaptor, 3, std::uint32_t>;

/// The nearest neighbours of every point, itself first.
struct Neighbours {
    std::vector<std::array<std::uint32_t, kNormalNeighbours + 1>> indices;
    std::vector<float> meanDistance;  // to the nearest kRadiusNeighbours others
    std::size_t count = 0;            // of `indices` that are valid: small clouds have fewer
};

Neighbours neighboursOf(const std::vector<glm::vec3>& positions) {
    const Adaptor adaptor{positions};
    Tree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree.buildIndex();
    Neighbours result;
    result.count = std::min(positions.size(), kNormalNeighbours + 1);
    result.indices.resize(positions.size());
    result.meanDistance.resize(positions.size());
    tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t i) {
        std::array<float, kNormalNeighbours + 1> squares{};
        tree.knnSearch(&positions[i].x, result.count, result.indices[i].data(), squares.data());
        const std::size_t others = std::min(result.count - 1, kRadiusNeighbours);
        float sum = 0.0F;
        for (std::size_t k = 1; k <= others; ++k) sum += std::sqrt(squares[k]);
        result.meanDistance[i] = others > 0 ? sum / static_cast<float>(others) : 1.0F;
    });
    return result;
}

glm::vec3 leastAxis(const std::vector<glm::vec3>& positions, const Neighbours& neighbours,
                    std::size_t point) {
    Covariance covariance;
    for (std::size_t k = 0; k < neighbours.count; ++k) {
        covariance.add(positions[neighbours.indices[point][k]]);
    }
    if (covariance.count() < 3) return {0.0F, 1.0F, 0.0F};
    return glm::vec3(eigensystem(covariance.matrix()).vectors[0]);
}

/// Turns estimated normals the way of their neighbours, the most parallel ones first (a spanning
/// tree as Prim makes it).
class Orientation {
  public:
    Orientation(PointCloud& points, const Neighbours& neighbours, std::vector<char> isOriented)
        : points_(points), neighbours_(neighbours), isOriented_(std::move(isOriented)) {}

    void run() {
        for (std::size_t i = 0; i < isOriented_.size(); ++i) {
            if (isOriented_[i]) pushNeighbours(i);
        }
        spread();
        // Parts that no given normal reaches: from their topmost point, where the outside is up.
        std::vector<std::size_t> byHeight(isOriented_.size());
        std::iota(byHeight.begin(), byHeight.end(), std::size_t{0});
        std::stable_sort(byHeight.begin(), byHeight.end(), [&](std::size_t a, std::size_t b) {
            return points_.positions[a].y > points_.positions[b].y;
        });
        for (const std::size_t i : byHeight) {
            if (isOriented_[i]) continue;
            if (points_.normals[i].y < 0.0F) points_.normals[i] = -points_.normals[i];
            isOriented_[i] = 1;
            pushNeighbours(i);
            spread();
        }
    }

  private:
    struct Edge {
        float parallelism;
        std::uint32_t from, to;
        bool operator<(const Edge& other) const {
            return std::tie(parallelism, other.from, other.to) <
                   std::tie(other.parallelism, from, to);
        }
    };
    void pushNeighbours(std::size_t from) {
        for (std::size_t k = 1; k < neighbours_.count; ++k) {
            const std::uint32_t to = neighbours_.indices[from][k];
            if (isOriented_[to]) continue;
            edges_.push({std::abs(glm::dot(points_.normals[from], points_.normals[to])),
                         static_cast<std::uint32_t>(from), to});
        }
    }
    void spread() {
        while (!edges_.empty()) {
            const Edge edge = edges_.top();
            edges_.pop();
            if (isOriented_[edge.to]) continue;
            glm::vec3& normal = points_.normals[edge.to];
            if (glm::dot(points_.normals[edge.from], normal) < 0.0F) normal = -normal;
            isOriented_[edge.to] = 1;
            pushNeighbours(edge.to);
        }
    }

    PointCloud& points_;
    const Neighbours& neighbours_;
    std::vector<char> isOriented_;
    std::priority_queue<Edge> edges_;
};

void completeNormals(PointCloud& points, const Neighbours& neighbours, std::vector<char> isGiven) {
    tbb::parallel_for(std::size_t{0}, isGiven.size(), [&](std::size_t i) {
        if (!isGiven[i]) points.normals[i] = leastAxis(points.positions, neighbours, i);
    });
    Orientation(points, neighbours, std::move(isGiven)).run();
}

}  // namespace

PointRepairs completePoints(PointCloud& points) {
    PointRepairs repairs;
    dropUseless(points, repairs);
    const std::size_t count = points.positions.size();
    if (count == 0) throw Error("no point with a finite position");

    points.normals.resize(count, glm::vec3(0.0F));
    points.radii.resize(count, 0.0F);
    std::vector<char> isGiven(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float length = isFinite(points.normals[i]) ? glm::length(points.normals[i]) : 0.0F;
        isGiven[i] = length > 0.0F;
        if (isGiven[i]) {
            points.normals[i] /= length;
        } else {
            ++repairs.normals;
        }
        if (!(std::isfinite(points.radii[i]) && points.radii[i] > 0.0F)) {
            points.radii[i] = 0.0F;
            ++repairs.radii;
        }
    }
    if (repairs.normals == 0 && repairs.radii == 0) return repairs;

    const Neighbours neighbours = neighboursOf(points.positions);
    // Points far from all others, as scanners leave them, must not become discs as large as that.
    constexpr float kMostOfMedian = 4.0F;
    std::vector<float> sorted(neighbours.meanDistance);
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    for (std::size_t i = 0; i < count; ++i) {
        if (points.radii[i] != 0.0F) continue;
        points.radii[i] = std::min(neighbours.meanDistance[i], kMostOfMedian * *middle);
    }
    if (repairs.normals > 0) completeNormals(points, neighbours, std::move(isGiven));
    return repairs;
}

}  // namespace gfxrepro::scene
