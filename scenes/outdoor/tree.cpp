#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/shared/fitted_camera.h"
#include "scenes/shared/mesh_builder.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

constexpr glm::vec3 kUp(0.0F, 1.0F, 0.0F);
constexpr float kDefaultTriangles = 113'000.0F;
constexpr int kLevels = 4;  // trunk, limbs, branches, twigs

using Station = MeshBuilder::Station;

/// What branches of one level are like.
struct Level {
    int sides;          // of the tube
    int segments;       // along it
    float wanderRad;    // how far a segment turns away from the last
    float liftPerM;     // how much it turns upwards
    float children;     // of a branch
    float childBegin;   // where along the branch they begin
    float lengthShare;  // of a child: of this branch's length
    float spreadRad;    // of a child against this branch
};

struct TreeTwig {
    std::array<glm::vec3, 3> points;
};

/// `direction` turned by `spreadRad` away from itself, towards `roundRad` about itself.
glm::vec3 turned(const glm::vec3& direction, float spreadRad, float roundRad) {
    const glm::vec3 x = anyAcross(direction);
    const glm::vec3 y = glm::cross(direction, x);
    return glm::normalize(direction * sdf::cosine(spreadRad) +
                          (x * sdf::cosine(roundRad) + y * sdf::sine(roundRad)) *
                              sdf::sine(spreadRad));
}

/// Grows the wood, limb by limb, and remembers the twigs for the leaves.
class Grower {
  public:
    /// The number of twigs grows with `share`, the wanted count against the default's.
    Grower(float share, std::uint64_t seed)
        : finer_(1.0F / std::max(1.0F, std::sqrt(share))), random_(seed) {
        const float more = std::sqrt(share);
        const int fewer = share < 0.4F ? 1 : 0;
        levels_[0] = {12 - 3 * fewer, 14, 0.05F, 0.05F, 20.0F, 0.20F, 0.62F, 1.15F};
        levels_[1] = {7 - 2 * fewer, 7, 0.13F, 0.06F, 10.0F * more, 0.18F, 0.46F, 0.85F};
        levels_[2] = {4 - fewer, 4, 0.20F, 0.05F, 9.0F * more, 0.12F, 0.42F, 0.80F};
        levels_[3] = {3, 2, 0.28F, -0.10F, 0.0F, 0.0F, 0.0F, 0.0F};
        for (int i = 1; i < 3; ++i) levels_[i].children = std::max(levels_[i].children, 2.0F);
    }

    void growTree(float heightM) { grow(0, {0, 0, 0}, kUp, heightM, 0.036F * heightM); }

    MeshBuilder& bark() { return bark_; }
    const std::vector<TreeTwig>& twigs() const { return twigs_; }

  private:
    void grow(int levelIndex, const glm::vec3& base, glm::vec3 direction, float lengthM,
              float radiusM) {
        const Level& level = levels_[levelIndex];
        std::vector<Station> stations{{base, radiusM}};
        std::vector<glm::vec3> directions{direction};
        const float stepM = lengthM / static_cast<float>(level.segments);
        for (int i = 1; i <= level.segments; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(level.segments);
            const float roundRad = random_.uniform(0.0F, 2.0F * kPi);
            direction = turned(direction, level.wanderRad * random_.uniform(), roundRad);
            direction = glm::normalize(direction + kUp * (level.liftPerM * stepM));
            const float taper = levelIndex == 0 ? 1.0F - 0.88F * t : 1.0F - 0.75F * t;
            stations.push_back({stations.back().position + direction * stepM, radiusM * taper});
            directions.push_back(direction);
        }
        if (levelIndex == 0) stations[0].radius *= 1.7F;  // the roots' flare
        const float grey = random_.uniform(0.85F, 1.15F);
        bark_.setColor(grey * glm::vec3(0.20F, 0.13F, 0.08F));
        bark_.addTube(stations, level.sides, false);
        if (levelIndex == kLevels - 1) {
            twigs_.push_back({{stations[0].position, stations[1].position, stations[2].position}});
            return;
        }
        growChildren(levelIndex, stations, directions, lengthM);
    }

    void growChildren(int levelIndex, const std::vector<Station>& stations,
                      const std::vector<glm::vec3>& directions, float lengthM) {
        const Level& level = levels_[levelIndex];
        const int count = static_cast<int>(level.children + random_.uniform());
        float roundRad = random_.uniform(0.0F, 2.0F * kPi);
        for (int k = 0; k < count; ++k) {
            // The last one goes on where the branch ends.
            const float share =
                (static_cast<float>(k) + random_.uniform(0.5F, 1.0F)) / static_cast<float>(count);
            const float t =
                k + 1 == count ? 1.0F : level.childBegin + (1.0F - level.childBegin) * share;
            const float at = t * static_cast<float>(level.segments);
            const auto segment = std::min(static_cast<std::size_t>(at),
                                          static_cast<std::size_t>(level.segments - 1));
            const float within = at - static_cast<float>(segment);
            const Station& a = stations[segment];
            const Station& b = stations[segment + 1];
            const glm::vec3 base = glm::mix(a.position, b.position, within);
            const float radius = glm::mix(a.radius, b.radius, within);

            // Golden angle: neighbours do not stand above each other.
            roundRad += 2.39996F + random_.uniform(-0.3F, 0.3F);
            const float spread = level.spreadRad * (1.25F - 0.6F * t) * random_.uniform(0.8F, 1.2F);
            const glm::vec3 direction = turned(directions[segment + 1], spread, roundRad);
            // A crown is widest at a third of its height, a spray at its base.
            const float rounded =
                levelIndex == 0
                    ? 0.42F + 0.58F * std::sqrt(
                                          std::max(0.0F, 1.0F - (t - 0.32F) * (t - 0.32F) / 0.47F))
                    : 1.0F - 0.55F * t;
            const float childM =
                level.lengthShare * lengthM * rounded * random_.uniform(0.75F, 1.15F);
            const float childRadius = std::min(0.62F * radius, 0.026F * childM + 0.002F) *
                                      (levelIndex == 0 ? 1.0F : finer_);
            grow(levelIndex + 1, base, direction, childM, childRadius);
        }
    }

    std::array<Level, kLevels> levels_{};
    float finer_;  // on the radius of branches and twigs: more of them are thinner
    Random random_;
    MeshBuilder bark_;
    std::vector<TreeTwig> twigs_;
};

/// The front of a leaf: `triangles` of them, two at least. Both halves run between the midrib,
/// which hangs in an arc from base to tip, and the outline; the leaf is folded along the midrib.
class LeafShape {
  public:
    LeafShape(const glm::vec3& base, const glm::vec3& direction, float lengthM, float rollRad)
        : base_(base), direction_(direction), lengthM_(lengthM) {
        const glm::vec3 across = anyAcross(direction);
        const glm::vec3 normal = glm::cross(direction, across);
        side_ = across * sdf::cosine(rollRad) + normal * sdf::sine(rollRad);
        up_ = glm::cross(direction, side_);
    }

    void add(MeshBuilder& builder, int triangles) const {
        const int ribs = triangles / 4;  // points between base and tip
        const int outline = triangles - 2 * ribs;
        addHalf(builder, ribs, (outline + 1) / 2, 1.0F);
        addHalf(builder, ribs, outline / 2, -1.0F);
    }

  private:
    /// `t` from base to tip, `half` 1 and −1 on the outline, 0 on the midrib.
    glm::vec3 at(float t, float half) const {
        const float width = 4.0F * t * (1.0F - t);
        const glm::vec3 rib =
            base_ + direction_ * (t * lengthM_) - kUp * (0.18F * t * t * lengthM_);
        return rib + (side_ * (0.4F * half) + up_ * (0.14F * std::abs(half))) * (width * lengthM_);
    }

    /// A strip between midrib and outline, always on from the end that lies behind.
    void addHalf(MeshBuilder& builder, int ribs, int outline, float half) const {
        const auto shareOf = [](int i, int count) {
            return static_cast<float>(i) / static_cast<float>(count + 1);
        };
        glm::vec3 rib = base_;
        glm::vec3 edge = at(shareOf(1, outline), half);
        const auto put = [&](const glm::vec3& next) {
            if (half > 0.0F) {
                builder.addTriangle(rib, next, edge);
            } else {
                builder.addTriangle(rib, edge, next);
            }
        };
        int i = 0;  // of the midrib; its point ribs + 1 is the tip
        int j = 1;  // of the outline
        while (i <= ribs) {
            // The outline stops before the tip, which closes the last triangle.
            const bool isRibNext =
                j == outline || (i < ribs && shareOf(i + 1, ribs) <= shareOf(j + 1, outline));
            const glm::vec3 next =
                isRibNext ? at(shareOf(i + 1, ribs), 0.0F) : at(shareOf(j + 1, outline), half);
            put(next);
            (isRibNext ? rib : edge) = next;
            ++(isRibNext ? i : j);
        }
    }

    glm::vec3 base_, direction_, side_{0.0F}, up_{0.0F};
    float lengthM_;
};

/// `count` leaves, dealt out evenly to the twigs, and `triangles` to them; their fronts.
void addLeaves(MeshBuilder& builder, const std::vector<TreeTwig>& twigs, std::size_t count,
               std::size_t triangles, float lengthM, std::uint64_t seed) {
    constexpr glm::vec3 kGreens[] = {
        {0.10F, 0.26F, 0.04F}, {0.15F, 0.33F, 0.05F}, {0.07F, 0.20F, 0.04F}, {0.22F, 0.36F, 0.07F}};
    Random random(seed, 1);
    for (std::size_t i = 0; i < count; ++i) {
        const TreeTwig& twig = twigs[i * twigs.size() / count];
        const float t = 2.0F * std::sqrt(random.uniform());  // denser towards the end
        const std::size_t segment = t < 1.0F ? 0 : 1;
        const glm::vec3& a = twig.points[segment];
        const glm::vec3& b = twig.points[segment + 1];
        const glm::vec3 base = glm::mix(a, b, t - static_cast<float>(segment));
        const float roundRad = random.uniform(0.0F, 2 * kPi);
        const glm::vec3 direction =
            turned(glm::normalize(b - a), random.uniform(0.5F, 1.5F), roundRad);
        const float light = random.uniform(0.8F, 1.2F);
        builder.setColor(kGreens[random.index(4)] * light);
        const float ownLengthM = lengthM * random.uniform(0.7F, 1.2F);
        const LeafShape leaf(base, direction, ownLengthM, random.uniform(0.0F, 2.0F * kPi));
        leaf.add(builder, static_cast<int>(triangles * (i + 1) / count - triangles * i / count));
    }
}

/// A low mound on a closed disc.
void addGround(MeshBuilder& builder, float radiusM) {
    constexpr unsigned kSides = 36;
    constexpr float kThicknessM = 0.35F;
    builder.setColor({0.16F, 0.24F, 0.08F});
    std::vector<glm::vec3> positions{{0.0F, 0.05F, 0.0F}};
    std::vector<glm::vec3> normals{kUp};
    std::vector<glm::uvec3> triangles;
    for (unsigned ring = 1; ring <= 3; ++ring) {
        const float r = static_cast<float>(ring) / 3.0F;
        const unsigned first = 1 + (ring - 1) * kSides;
        for (unsigned k = 0; k < kSides; ++k) {
            const float angleRad = 2.0F * kPi * static_cast<float>(k) / static_cast<float>(kSides);
            const glm::vec3 out(sdf::cosine(angleRad), 0.0F, -sdf::sine(angleRad));
            positions.push_back(out * (r * radiusM) + kUp * (0.05F - 0.3F * r * r));
            // The slope of 0.05 − 0.3 (x / radius)².
            normals.push_back(glm::normalize(kUp + out * (0.6F * r / radiusM)));
            const unsigned next = (k + 1) % kSides;
            if (ring == 1) {
                triangles.emplace_back(0, first + k, first + next);
            } else {
                triangles.emplace_back(first - kSides + k, first + k, first + next);
                triangles.emplace_back(first - kSides + k, first + next, first - kSides + next);
            }
        }
    }
    builder.addIndexed(positions, normals, triangles);
    builder.setColor({0.13F, 0.09F, 0.06F});
    const std::array rim{Station{{0.0F, -0.25F - kThicknessM, 0.0F}, radiusM},
                         Station{{0.0F, -0.25F, 0.0F}, radiusM}};
    builder.addTube(rim, static_cast<int>(kSides), false);
    std::vector<glm::vec3> low;
    std::vector<glm::uvec3> fan;
    for (unsigned k = 0; k < kSides; ++k) {
        low.push_back(positions[1 + 2 * kSides + k] - kUp * kThicknessM);
        if (k >= 2) fan.emplace_back(0, k, k - 1);
    }
    builder.addIndexed(low, std::vector<glm::vec3>(kSides, -kUp), fan);
}

}  // namespace

Scene tree(Params& params, std::uint64_t seed) {
    const int triangles =
        params.getInt("triangles", static_cast<int>(kDefaultTriangles),
                      {"exact count; even, for a leaf has two sides; more make finer twigs and "
                       "leaves",
                       "", 10'000, 2e6});
    const int wantedLeaves = params.getInt(
        "leaves", 0,
        {"leaves, which share the triangles that the wood leaves: fewer are rounder; 0: seven for "
         "every 40 of them",
         "", 0, 500'000});
    const double leafSize = params.getDouble(
        "leaf_size", 1.0, {"factor on the leaves' length, whatever their number", "", 0.2, 5.0});
    constexpr Choice<std::size_t> kFaces[] = {{1, "one", "not drawn from behind"},
                                              {2, "two", "one for each side"}};
    const std::size_t faces =
        params.getEnum("faces", std::size_t{2}, kFaces, {"polygons of a leaf"});
    params.finish();
    if (triangles % 2 != 0) {
        throw Error(params.locationOf("triangles"),
                    "triangles: " + std::to_string(triangles) +
                        " is odd, but a leaf has two sides, which takes an even number");
    }

    const auto wanted = static_cast<std::size_t>(triangles);
    const float share = static_cast<float>(triangles) / kDefaultTriangles;
    Grower grower(share, seed);
    grower.growTree(10.0F);
    MeshBuilder ground;
    addGround(ground, 3.2F);
    const std::size_t wood = grower.bark().triangleCount() + ground.triangleCount();
    GFXREPRO_ASSERT(wood < wanted && wood % 2 == 0);
    const std::size_t fronts = (wanted - wood) / faces;
    const std::size_t count = wantedLeaves > 0 ? static_cast<std::size_t>(wantedLeaves)
                                               : std::max((wanted - wood) * 7 / 40, std::size_t{1});
    if (count > fronts / 2) {
        throw Error(params.locationOf("leaves"),
                    "leaves: " + std::to_string(count) + " take at least " +
                        std::to_string(2 * faces * count) + " triangles, but " +
                        std::to_string(faces * fronts) + " are left of " +
                        std::to_string(triangles) + " beside wood and ground");
    }
    // The usual leaves' area together stays what it is.
    MeshBuilder leaves;
    addLeaves(leaves, grower.twigs(), count, fronts,
              static_cast<float>(leafSize) * 0.23F / std::sqrt(share), seed);

    Scene scene;
    ground.addTo(scene, "ground");
    grower.bark().addTo(scene, "bark");
    leaves.addTo(scene, "leaves");
    if (faces == 2) addBackSides(scene.meshes.back());
    GFXREPRO_ASSERT_EQ(scene.triangleCount(), wanted);
    const glm::vec3 target(0.0F, 0.5F * scene.bounds().max.y, 0.0F);
    scene.cameras.push_back(fittedCamera(scene, target, {0.55F, 0.22F, 1.0F}, 0.7F, 0.88F));
    return scene;
}

}  // namespace gfxrepro::scene
