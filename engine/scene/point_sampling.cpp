#include "engine/scene/point_sampling.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nanoflann.hpp>
#include <numeric>
#include <queue>
#include <tuple>

#include "engine/core/error.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {
namespace {

/// One rotation that makes element (p, q) zero.
void rotate(glm::dmat3& a, glm::dmat3& v, int p, int q) {
    if (a[p][q] == 0.0) return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 3; ++k) {  // columns p and q
        const double akp = a[p][k], akq = a[q][k];
        a[p][k] = c * akp - s * akq;
        a[q][k] = s * akp + c * akq;
    }
    for (int k = 0; k < 3; ++k) {  // rows p and q
        const double apk = a[k][p], aqk = a[k][q];
        a[k][p] = c * apk - s * aqk;
        a[k][q] = s * apk + c * aqk;
    }
    for (int k = 0; k < 3; ++k) {
        const double vkp = v[p][k], vkq = v[q][k];
        v[p][k] = c * vkp - s * vkq;
        v[q][k] = s * vkp + c * vkq;
    }
}

}  // namespace

glm::dvec3 Covariance::mean() const {
    return count_ == 0 ? origin_ : origin_ + sum_ / static_cast<double>(count_);
}

glm::dmat3 Covariance::matrix() const {
    if (count_ == 0) return glm::dmat3(0.0);
    const auto n = static_cast<double>(count_);
    return squares_ / n - glm::outerProduct(sum_ / n, sum_ / n);
}

Eigensystem eigensystem(const glm::dmat3& symmetric) {
    glm::dmat3 a = symmetric, v(1.0);
    constexpr int kSweeps = 12;  // converges quadratically: 6 or so reach double precision
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
    Eigensystem result;
    for (int k = 0; k < 3; ++k) {
        const int from = order[static_cast<std::size_t>(k)];
        result.values[k] = a[from][from];
        result.vectors[k] = v[from];
    }
    return result;
}

namespace {

/// Element `index` of the R₂ sequence, folded into the triangle.
glm::vec2 barycentricsAt(std::size_t index) {
    constexpr double kPlastic = 1.32471795724474602596;
    const double i = static_cast<double>(index) + 0.5;
    double u = std::fmod(i / kPlastic, 1.0), v = std::fmod(i / (kPlastic * kPlastic), 1.0);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return {static_cast<float>(u), static_cast<float>(v)};
}

/// 21 bits an axis, interleaved.
std::uint64_t mortonCode(const glm::vec3& unitPosition) {
    std::uint64_t code = 0;
    const glm::dvec3 scaled =
        glm::clamp(glm::dvec3(unitPosition), 0.0, 1.0) * static_cast<double>((1 << 21) - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::uint64_t>(scaled[axis]);
        for (int bit = 0; bit < 21; ++bit) code |= ((cell >> bit) & 1) << (3 * bit + axis);
    }
    return code;
}

}  // namespace

Mesh surfaceOf(const Scene& scene) {
    Mesh surface;
    bool isColored = false;
    for (const Instance& instance : scene.instances) {
        const Mesh& whole = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Mesh flat = whole.isFlat ? withTriangleNormals(whole) : Mesh{};
        const Mesh& mesh = whole.isFlat ? flat : whole;
        const glm::mat3 linear(instance.worldFromMesh);
        const glm::mat3 toWorld = glm::transpose(glm::inverse(linear));
        const glm::vec3 base(materialOf(scene, mesh).baseColor);
        isColored =
            isColored || !mesh.colors.empty() || (mesh.material >= 0 && base != glm::vec3(1.0F));
        const std::vector<glm::vec3> normals =
            mesh.normals.empty() ? vertexNormals(mesh) : mesh.normals;
        const auto first = static_cast<std::uint32_t>(surface.positions.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            surface.positions.emplace_back(instance.worldFromMesh *
                                           glm::vec4(mesh.positions[v], 1.0F));
            surface.normals.push_back(toWorld * normals[v]);
            surface.colors.push_back(mesh.colors.empty() ? base : base * mesh.colors[v]);
        }
        const bool isMirrored = glm::determinant(linear) < 0.0F;
        for (glm::uvec3 triangle : mesh.triangles) {
            if (isMirrored) std::swap(triangle.y, triangle.z);
            surface.triangles.push_back(triangle + first);
        }
    }
    if (!isColored) surface.colors.clear();
    return surface;
}

PointCloud sampledPoints(const Scene& scene, std::size_t count) {
    if (count == 0) throw Error("0 points wanted of a surface; allowed: at least 1");
    PointCloud points;
    points.surface = surfaceOf(scene);
    const Mesh& surface = points.surface;
    const auto areaOf = [&](const glm::uvec3& triangle) {
        const glm::vec3& corner = surface.positions[triangle.x];
        return 0.5 *
               static_cast<double>(glm::length(glm::cross(surface.positions[triangle.y] - corner,
                                                          surface.positions[triangle.z] - corner)));
    };
    double area = 0.0;
    for (const glm::uvec3& triangle : surface.triangles) area += areaOf(triangle);
    if (!(area > 0.0)) {
        throw Error(fmt::format("scene '{}' has no surface to take points from", scene.name));
    }
    points.whole = surface.bounds();
    const double step = area / static_cast<double>(count);
    points.positions.reserve(count);
    points.normals.reserve(count);
    if (!surface.colors.empty()) points.colors.reserve(count);
    double passed = 0.0;  // area before the triangle
    for (const glm::uvec3& triangle : surface.triangles) {
        passed += areaOf(triangle);
        // The last point is due by rounding even where the sum falls short of it.
        while (points.positions.size() < count &&
               (static_cast<double>(points.positions.size()) + 0.5) * step < passed) {
            const glm::vec2 weights = barycentricsAt(points.positions.size());
            points.positions.push_back(interpolated(surface.positions, triangle, weights));
            points.normals.push_back(unitOrZero(interpolated(surface.normals, triangle, weights)));
            if (!surface.colors.empty()) {
                points.colors.push_back(interpolated(surface.colors, triangle, weights));
            }
        }
    }
    // Small triangles in any order leave points nearly at random: discs of 4 times their share of
    // the area, up to 1.5 radii, leave e⁻⁹ of it bare; with 1.5 times the radius it would be e⁻⁵,
    // and close-ups would have pinholes.
    const double radius = 2.0 * std::sqrt(step / glm::pi<double>());
    points.radii.assign(points.positions.size(), static_cast<float>(radius));
    return points;
}

PointCloud thinnedPoints(const PointCloud& points, std::size_t count) {
    const std::size_t all = points.positions.size();
    if (count >= all) return points;
    const Box box = points.bounds();
    const glm::vec3 size = glm::max(box.size(), glm::vec3(1e-30F));  // flat clouds: any code
    std::vector<std::uint64_t> codes(all);
    for (std::size_t i = 0; i < all; ++i) {
        codes[i] = mortonCode((points.positions[i] - box.min) / size);
    }
    std::vector<std::size_t> order(all);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return codes[a] < codes[b]; });
    const auto grown = static_cast<float>(
        std::sqrt(static_cast<double>(all) / static_cast<double>(std::max<std::size_t>(count, 1))));
    PointCloud thinned;
    thinned.whole = box;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = order[k * all / count];
        thinned.positions.push_back(points.positions[i]);
        if (!points.normals.empty()) thinned.normals.push_back(points.normals[i]);
        if (!points.radii.empty()) thinned.radii.push_back(points.radii[i] * grown);
        if (!points.colors.empty()) thinned.colors.push_back(points.colors[i]);
    }
    return thinned;
}

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
