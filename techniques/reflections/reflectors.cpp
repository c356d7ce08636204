#include "techniques/reflections/reflectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::reflections {

namespace {

constexpr float kTransmissive = 0.5F;

/// A channel of the texel at `texcoord`, 0 to 1; repeats.
float texelAt(const image::Image8& image, const glm::vec2& texcoord, int channel) {
    const glm::vec2 place =
        (texcoord - glm::floor(texcoord)) * glm::vec2(image.width(), image.height());
    const int x = std::clamp(static_cast<int>(place.x), 0, image.width() - 1);
    const int y = std::clamp(static_cast<int>(place.y), 0, image.height() - 1);
    return static_cast<float>(image.at(x, y, channel)) / 255.0F;
}

/// Whether some place of the mesh is as smooth as `maxRoughness`, and reflects, by the material's
/// texture. Looked at are the middles of a grid over each triangle.
bool reflectsByTexture(const scene::Mesh& mesh, const scene::Material& material,
                       const image::Image8& texture, float maxRoughness) {
    constexpr double kPlaces = 4096.0;
    const auto side = static_cast<int>(std::ceil(
        std::sqrt(kPlaces / static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1)))));
    const auto reflectsAt = [&](const glm::vec2& texcoord) {
        const float roughness = material.roughness * texelAt(texture, texcoord, 1);
        return roughness <= maxRoughness &&
               reflectivityOf(material, material.metallic * texelAt(texture, texcoord, 2)) > 0.0F;
    };
    for (const glm::uvec3& corners : mesh.triangles) {
        // side² small triangles: the upright ones, and those between them.
        for (int i = 0; i < side; ++i) {
            for (int j = 0; j < 2 * (side - i) - 1; ++j) {
                const float third = j % 2 == 0 ? 1.0F / 3.0F : 2.0F / 3.0F;
                const glm::vec2 b = (glm::vec2(i, j / 2) + third) / static_cast<float>(side);
                if (reflectsAt((1.0F - b.x - b.y) * mesh.texcoords[corners.x] +
                               b.x * mesh.texcoords[corners.y] + b.y * mesh.texcoords[corners.z])) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// What ReflectorRule says, of meshes that are not left out.
bool isReflector(const scene::Scene& scene, const scene::Mesh& mesh, float maxRoughness) {
    if (!isSmooth(scene, mesh, maxRoughness)) return false;
    const scene::Material material = materialOf(scene, mesh);
    return isTextured(mesh, material.metallicRoughnessTexture) ||
           reflectivityOf(material, material.metallic) > 0.0F;
}

}  // namespace

bool isTransmissive(const scene::Material& material) {
    return material.transmission > kTransmissive;
}

float headOnReflectivity(float indexOfRefraction) {
    const float ratio = (indexOfRefraction - 1.0F) / (indexOfRefraction + 1.0F);
    return ratio * ratio;
}

float in255ths(float value) {
    return std::round(255.0F * std::clamp(value, 0.0F, 1.0F)) / 255.0F;
}

bool isTextured(const scene::Mesh& mesh, int texture) {
    return texture >= 0 && !mesh.texcoords.empty();
}

float reflectivityOf(const scene::Material& material, float metallic) {
    return in255ths(std::max(metallic, headOnReflectivity(material.indexOfRefraction)));
}

bool isSmooth(const scene::Scene& scene, const scene::Mesh& mesh, float maxRoughness) {
    const scene::Material material = materialOf(scene, mesh);
    if (!isTextured(mesh, material.metallicRoughnessTexture)) {
        return material.roughness <= maxRoughness;
    }
    const auto texture = static_cast<std::size_t>(material.metallicRoughnessTexture);
    return reflectsByTexture(mesh, material, scene.textures[texture], maxRoughness);
}

std::set<std::string> reflectorNames(const scene::Scene& scene, const ReflectorRule& rule) {
    std::set<std::string> names;
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (isTransmissive(materialOf(scene, mesh)) || mesh.triangles.empty()) continue;
        if (isReflector(scene, mesh, rule.maxRoughness)) names.insert(mesh.name);
    }
    return names;
}

void requireReflectors(const scene::Scene& scene, const ReflectorRule& rule) {
    std::size_t triangles = 0, transmissive = 0;
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (isTransmissive(materialOf(scene, mesh))) {
            ++transmissive;
            continue;
        }
        triangles += mesh.triangles.size();
        if (triangles > 0 && isReflector(scene, mesh, rule.maxRoughness)) return;
    }
    const std::string leftOut =
        transmissive == 0 ? "" : fmt::format(" (transmissive objects left out: {})", transmissive);
    if (triangles == 0) {
        throw Error(fmt::format("scene '{}': reflections need triangles, it has none{}", scene.name,
                                leftOut));
    }
    throw Error(
        fmt::format("scene '{}' has no reflectors{}: no material's roughness is at most {}; "
                    "'reflector_roughness: 1' takes them all",
                    scene.name, leftOut, rule.maxRoughness));
}

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using glm::dvec3;

/// Two triangles side by side.
struct Border {
    std::uint32_t a = 0, b = 0;
    double lengthM = 0.0;
    double bend = 0.0;  // the angle from plane to plane, positive where convex
    bool isCrease = false;
};

/// Places closer than this part of the mesh's diagonal are one vertex: seams, where turned shapes
/// close up to rounding.
constexpr double kWeld = 1e-6;
/// Angles below are flat: rounding of positions bends planes by as much.
constexpr double kFlatRad = 1e-3;
/// How often each triangle goes with most of its neighbours: its own three edges may differ in sign
/// from those beside it along a curve that is drawn with few triangles.
constexpr int kRounds = 3;
/// Parts lie in about one plane where their normals and places along them round to the same of
/// these steps: to a unit, and to the mesh's diagonal.
constexpr double kNormalSteps = 4.0;
constexpr double kPlaneSteps = 50.0;

/// Of vertices: places rounded to kWeld.
using Cell = std::array<std::int64_t, 3>;
/// Teschner et al. 2003, "Optimized Spatial Hashing for Collision Detection of Deformable Objects".
struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        const auto unsignedOf = [&](std::size_t i) { return static_cast<std::size_t>(cell[i]); };
        return unsignedOf(0) * 73856093 ^ unsignedOf(1) * 19349663 ^ unsignedOf(2) * 83492791;
    }
};

class Joined {
  public:
    explicit Joined(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    std::uint32_t of(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

class Division {
  public:
    explicit Division(const scene::Mesh& mesh) : mesh_(mesh), joined_(mesh.triangles.size()) {
        measureTriangles();
        findBorders();
        creaseAroundPlanes();
        sides_ = bendingSides();
        for (const Border& border : borders_) {
            if (!border.isCrease && sides_[border.a] == sides_[border.b])
                joined_.join(border.a, border.b);
        }
        joinSmallOnes();
    }
    Parts parts() {
        Parts parts;
        std::map<std::uint32_t, std::uint32_t> numberOf;
        std::vector<double> bentArea;  // convex less concave, by part
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto next = static_cast<std::uint32_t>(numberOf.size());
            const std::uint32_t part = numberOf.emplace(joined_.of(t), next).first->second;
            if (part == bentArea.size()) bentArea.push_back(0.0);
            bentArea[part] += sides_[t] * areas_[t];
            parts.ofTriangle.push_back(part);
        }
        for (const double area : bentArea) parts.isConcave.push_back(area < 0.0 ? 1 : 0);
        return parts;
    }

  private:
    dvec3 corner(std::uint32_t triangle, int k) const {
        return dvec3(mesh_.positions[mesh_.triangles[triangle][k]]);
    }
    double leastArea() const {
        return double{kLeastPartShare} * std::accumulate(areas_.begin(), areas_.end(), 0.0);
    }
    void measureTriangles();
    bool isShadedFlat(std::uint32_t triangle) const;
    void findBorders();
    Border borderOf(std::uint32_t a, std::uint32_t b, const dvec3& from, const dvec3& to) const;
    void creaseAroundPlanes();
    std::vector<std::int8_t> bendingSides() const;
    /// Weighted by area.
    struct PartSum {
        dvec3 normal{0.0}, centre{0.0};
        double area = 0.0;
        bool isFlat() const { return glm::length(normal) > (1.0 - kFlatRad * kFlatRad) * area; }
    };
    std::map<std::uint32_t, PartSum> partSums();  // by their least triangle
    void joinSmallOnes();

    const scene::Mesh& mesh_;
    std::vector<dvec3> normals_;  // of triangles, turned as their vertices'; 0: degenerate
    std::vector<double> areas_;
    std::vector<bool> isShadedFlat_;
    std::vector<Border> borders_;
    std::vector<std::int8_t> sides_;  // −1: concave
    Joined joined_;
};

void Division::measureTriangles() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        dvec3 normal = glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
        const double twice = glm::length(normal);
        normal = twice > 0.0 ? normal / twice : dvec3(0.0);
        if (!mesh_.normals.empty()) {
            dvec3 wanted(0.0);
            for (int k = 0; k < 3; ++k) wanted += dvec3(mesh_.normals[mesh_.triangles[t][k]]);
            if (glm::dot(wanted, normal) < 0.0) normal = -normal;
        }
        normals_.push_back(normal);
        areas_.push_back(0.5 * twice);
        isShadedFlat_.push_back(isShadedFlat(t));
    }
}

/// By its vertices: one normal, that of its plane.
bool Division::isShadedFlat(std::uint32_t triangle) const {
    if (mesh_.normals.empty()) return false;
    const glm::uvec3& corners = mesh_.triangles[triangle];
    const glm::vec3& normal = mesh_.normals[corners.x];
    if (normal != mesh_.normals[corners.y] || normal != mesh_.normals[corners.z]) return false;
    const double along = glm::dot(dvec3(normal), normals_[triangle]);
    return along > (1.0 - kFlatRad * kFlatRad) * glm::length(dvec3(normal));
}

Border Division::borderOf(std::uint32_t a, std::uint32_t b, const dvec3& from,
                          const dvec3& to) const {
    Border border{a, b, glm::distance(from, to)};
    if (normals_[a] == dvec3(0.0) || normals_[b] == dvec3(0.0)) return border;
    const double cosine = std::clamp(glm::dot(normals_[a], normals_[b]), -1.0, 1.0);
    border.isCrease = cosine < double{kCreaseCosine};
    const double angle = std::acos(cosine);
    if (angle < kFlatRad) return border;
    // The corner of b that is not on the edge lies below the plane of a where they are convex.
    double height = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double at = glm::dot(corner(b, k) - from, normals_[a]);
        if (std::abs(at) > std::abs(height)) height = at;
    }
    border.bend = height < 0.0 ? angle : -angle;
    return border;
}

void Division::findBorders() {
    const double cell = std::max(kWeld * double{glm::length(mesh_.bounds().size())}, 1e-30);
    std::unordered_map<Cell, std::uint32_t, CellHash> vertexAt;
    std::vector<std::uint32_t> welded;
    for (const glm::vec3& position : mesh_.positions) {
        const dvec3 at = glm::round(dvec3(position) / cell);
        const Cell key = {static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y),
                          static_cast<std::int64_t>(at.z)};
        const auto next = static_cast<std::uint32_t>(vertexAt.size());
        welded.push_back(vertexAt.emplace(key, next).first->second);
    }
    std::unordered_map<std::uint64_t, std::uint32_t> triangleAt;  // by the edge's two vertices
    triangleAt.reserve(2 * mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = mesh_.triangles[t][k];
            const std::uint32_t to = mesh_.triangles[t][(k + 1) % 3];
            if (welded[from] == welded[to]) continue;
            const auto [least, most] = std::minmax(welded[from], welded[to]);
            const auto [other, isNew] = triangleAt.emplace(std::uint64_t{least} << 32 | most, t);
            if (isNew || other->second == t) continue;
            borders_.push_back(borderOf(other->second, t, dvec3(mesh_.positions[from]),
                                        dvec3(mesh_.positions[to])));
        }
    }
}

/// A large plane ends at a crease, at whatever angle, where both sides are shaded flat.
void Division::creaseAroundPlanes() {
    Joined planes(areas_.size());
    for (const Border& border : borders_) {
        if (border.bend == 0.0) planes.join(border.a, border.b);
    }
    std::vector<double> areaOf(areas_.size(), 0.0);
    for (std::uint32_t t = 0; t < areas_.size(); ++t) areaOf[planes.of(t)] += areas_[t];
    const double least = leastArea();
    for (Border& border : borders_) {
        if (border.bend == 0.0 || !isShadedFlat_[border.a] || !isShadedFlat_[border.b]) continue;
        const double larger = std::max(areaOf[planes.of(border.a)], areaOf[planes.of(border.b)]);
        border.isCrease = border.isCrease || larger >= least;
    }
}

/// −1 where the surface is concave, else 1.
std::vector<std::int8_t> Division::bendingSides() const {
    std::vector<double> bends(areas_.size(), 0.0);
    for (const Border& border : borders_) {
        if (border.isCrease) continue;
        bends[border.a] += border.bend * border.lengthM;
        bends[border.b] += border.bend * border.lengthM;
    }
    std::vector<int> sides;
    for (const double bend : bends) sides.push_back(bend < 0.0 ? -1 : bend > 0.0 ? 1 : 0);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<int> votes = sides;
        for (const Border& border : borders_) {
            if (border.isCrease) continue;
            votes[border.a] += sides[border.b];
            votes[border.b] += sides[border.a];
        }
        for (std::size_t t = 0; t < sides.size(); ++t) {
            if (votes[t] != 0) sides[t] = votes[t] < 0 ? -1 : 1;
        }
    }
    std::vector<std::int8_t> result;
    for (const int side : sides) result.push_back(side < 0 ? std::int8_t{-1} : std::int8_t{1});
    return result;
}

std::map<std::uint32_t, Division::PartSum> Division::partSums() {
    std::map<std::uint32_t, PartSum> sums;
    for (std::uint32_t t = 0; t < areas_.size(); ++t) {
        PartSum& sum = sums[joined_.of(t)];
        sum.area += areas_[t];
        sum.normal += areas_[t] * normals_[t];
        sum.centre += areas_[t] / 3.0 * (corner(t, 0) + corner(t, 1) + corner(t, 2));
    }
    return sums;
}

/// Smallest first, each with what it has the longest border with, but none across a crease with a
/// large plane, which would be one no more. Then those in about one plane, and the rest with each
/// other, but for planes of one normal: parts of two walls have no cluster in common.
void Division::joinSmallOnes() {
    const double least = leastArea();
    std::map<std::uint32_t, PartSum> sums = partSums();
    const auto smallOnes = [&] {
        std::vector<std::pair<double, std::uint32_t>> small;
        for (const auto& [part, sum] : sums) {
            if (sum.area < least) small.emplace_back(sum.area, part);
        }
        std::ranges::sort(small);
        return small;
    };
    const auto isLargePlane = [&](std::uint32_t part) {
        return sums[part].area >= least && sums[part].isFlat();
    };
    for (bool hasJoined = true; hasJoined; sums = partSums()) {
        hasJoined = false;
        std::map<Edge, double> lengthOf;
        for (const Border& border : borders_) {
            const std::uint32_t a = joined_.of(border.a), b = joined_.of(border.b);
            if (a == b || (border.isCrease && (isLargePlane(a) || isLargePlane(b)))) continue;
            lengthOf[{a, b}] += border.lengthM;
            lengthOf[{b, a}] += border.lengthM;
        }
        for (const auto& [area, part] : smallOnes()) {
            if (joined_.of(part) != part) continue;  // in this round, with a smaller one
            double longest = 0.0;
            std::uint32_t best = part;
            for (auto at = lengthOf.lower_bound({part, 0});
                 at != lengthOf.end() && at->first.first == part; ++at) {
                if (at->second > longest)
                    std::tie(longest, best) = std::pair(at->second, at->first.second);
            }
            if (best == part) continue;
            joined_.join(part, best);
            hasJoined = true;
        }
    }
    std::map<std::array<long, 4>, std::uint32_t> partIn;
    for (const auto& [area, part] : smallOnes()) {
        const dvec3 normal = sums[part].normal / std::max(area, 1e-300);
        const double at = glm::dot(normal, sums[part].centre / std::max(area, 1e-300)) /
                          double{glm::length(mesh_.bounds().size())};
        const std::array<long, 4> plane = {
            std::lround(normal.x * kNormalSteps), std::lround(normal.y * kNormalSteps),
            std::lround(normal.z * kNormalSteps), std::lround(at * kPlaneSteps)};
        joined_.join(part, partIn.emplace(plane, part).first->second);
    }
    sums = partSums();
    // Flat ones of one normal, which a cluster would have in common, go apart: the first of each
    // normal, and all that bends, is one part, the second of each another, …
    std::map<std::array<long, 3>, std::size_t> planesOf;
    std::vector<std::uint32_t> together;
    for (const auto& [area, part] : smallOnes()) {
        const dvec3 normal = sums[part].normal / std::max(area, 1e-300);
        const std::array<long, 3> way = {std::lround(normal.x * kNormalSteps),
                                         std::lround(normal.y * kNormalSteps),
                                         std::lround(normal.z * kNormalSteps)};
        const std::size_t at = sums[part].isFlat() ? planesOf[way]++ : 0;
        if (at < together.size())
            joined_.join(together[at], part);
        else
            together.push_back(part);
    }
}

/// The triangles of one part, with the vertices that they use.
scene::Mesh partOf(const scene::Mesh& mesh, const std::vector<std::uint32_t>& parts,
                   std::uint32_t part) {
    scene::Mesh result;
    result.name = mesh.name;
    result.material = mesh.material;
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> newVertex(mesh.positions.size(), kNone);
    for (std::size_t t = 0; t < parts.size(); ++t) {
        if (parts[t] != part) continue;
        glm::uvec3 corners(0);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            const bool isNew = newVertex[vertex] == kNone;
            if (isNew) newVertex[vertex] = static_cast<std::uint32_t>(result.positions.size());
            corners[k] = newVertex[vertex];
            if (!isNew) continue;
            result.positions.push_back(mesh.positions[vertex]);
            if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[vertex]);
            if (!mesh.texcoords.empty()) result.texcoords.push_back(mesh.texcoords[vertex]);
            if (!mesh.colors.empty()) result.colors.push_back(mesh.colors[vertex]);
        }
        result.triangles.push_back(corners);
    }
    return result;
}

}  // namespace

Parts partsOf(const scene::Mesh& mesh) {
    return Division(mesh).parts();
}

std::vector<PartOrigin> splitIntoParts(scene::Scene& scene,
                                       const std::function<bool(const scene::Mesh&)>& splits) {
    using NewMeshes = std::vector<std::pair<int, bool>>;  // and whether they are concave
    std::map<int, NewMeshes> partsOfMesh;
    const auto split = [&](int index) -> const NewMeshes& {
        const auto [at, isNew] = partsOfMesh.emplace(index, NewMeshes{{index, false}});
        if (!isNew) return at->second;
        // A copy: it grows the list that it is in. Normals are the whole's, also where it has none.
        scene::Mesh mesh = scene.meshes[static_cast<std::size_t>(index)];
        if (mesh.normals.size() != mesh.positions.size()) mesh.normals = scene::vertexNormals(mesh);
        const Parts parts = partsOf(mesh);
        const auto count = static_cast<std::uint32_t>(parts.isConcave.size());
        if (count < 2) return at->second;
        at->second.clear();
        for (std::uint32_t part = 0; part < count; ++part) {
            at->second.emplace_back(static_cast<int>(scene.meshes.size()),
                                    parts.isConcave[part] != 0);
            scene.meshes.push_back(partOf(mesh, parts.ofTriangle, part));
        }
        scene.meshes[static_cast<std::size_t>(index)] = {};  // all its instances are split
        return at->second;
    };
    std::vector<bool> isSplit;  // by mesh, before any of them is
    for (const scene::Mesh& mesh : scene.meshes) isSplit.push_back(splits(mesh));
    std::vector<scene::Instance> instances;
    std::vector<PartOrigin> origins;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const scene::Instance whole = scene.instances[i];
        const NewMeshes meshes = isSplit[static_cast<std::size_t>(whole.mesh)]
                                     ? split(whole.mesh)
                                     : NewMeshes{{whole.mesh, false}};
        for (const auto& [mesh, isConcave] : meshes) {
            instances.push_back({mesh, whole.worldFromMesh});
            origins.push_back({static_cast<int>(i), isConcave});
        }
    }
    std::vector<scene::Motion> motions;
    for (const scene::Motion& motion : scene.motions) {
        for (std::size_t i = 0; i < origins.size(); ++i) {
            if (origins[i].instance != motion.instance) continue;
            motions.push_back(motion);
            motions.back().instance = static_cast<int>(i);
        }
    }
    scene.instances = std::move(instances);
    scene.motions = std::move(motions);
    return origins;
}

}  // namespace gfxrepro::reflections
