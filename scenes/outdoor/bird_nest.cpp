// Generator `bird_nest`. About ten times life size: the bowl has a radius of one metre.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/scene/refine.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/shared/mesh_builder.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

// Streams of random numbers: parts do not change with each other's counts.
constexpr std::uint64_t kTwigStream = 1;
constexpr std::uint64_t kEggStream = 2;

/// The middle of the bowl's wall is the lower part of this ellipsoid around the origin; the wall
/// reaches from (1 − kWall) to (1 + kWall) times it.
constexpr glm::vec3 kBowlRadii(0.80F, 0.62F, 0.80F);
constexpr float kWall = 0.24F;
/// Twigs start no higher than this share of the ellipsoid's height: the rim curls in a little.
constexpr float kRim = 0.16F;

/// Of a twig of two stretches with its caps.
constexpr int leastTwigTriangles(int sides) {
    return 4 * sides + 2 * (sides - 2);
}
/// Of a twig, where `twigs` says nothing; with few triangles twigs get coarser, to the second
/// number, before they get fewer.
constexpr int kUsualTwigTriangles = 530;
constexpr int kCoarseTwigTriangles = 66;
/// Radii are stated for the number of twigs that the default count of triangles gives.
constexpr int kReferenceTwigs = 122;

/// Smooth step of x from 0 at `low` to 1 at `high`.
float ramp(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

/// Bell-shaped in (−1, 1).
float bell(Random& random) {
    const float a = random.uniform();
    const float b = random.uniform();
    const float c = random.uniform();
    return (a + b + c) * (2.0F / 3.0F) - 1.0F;
}

struct Twig {
    glm::vec3 middle;
    float shell;       // which multiple of the ellipsoid it follows
    float shellSlope;  // how much that changes a metre: twigs dive under others
    float headingRad;  // from the horizontal around the bowl, upwards
    float lengthM;
    float straightness;  // 0: follows the bowl, 1: its tangent
    float radiusM;
    float waveM;
    float wavePhaseRad;
    glm::vec3 color;
};

glm::vec3 twigColor(Random& random, bool isLining) {
    // Linear: dark wet wood, two browns, weathered grey, reddish bark; the lining is dry straw.
    constexpr std::array<glm::vec3, 5> kWood{{{0.075F, 0.043F, 0.024F},
                                              {0.150F, 0.088F, 0.045F},
                                              {0.235F, 0.150F, 0.080F},
                                              {0.215F, 0.180F, 0.140F},
                                              {0.170F, 0.075F, 0.040F}}};
    constexpr std::array<glm::vec3, 2> kStraw{{{0.46F, 0.35F, 0.18F}, {0.33F, 0.23F, 0.11F}}};
    const bool isStraw = random.uniform() < (isLining ? 0.75F : 0.06F);
    const float brightness = random.uniform(0.7F, 1.35F);
    const auto any = static_cast<std::size_t>(random.index(10));
    return brightness * (isStraw ? kStraw[any % 2] : kWood[any % 5]);
}

Twig makeTwig(Random& random, float thickness) {
    Twig twig{};
    // Height is uniform over a sphere's area; a third goes to the rim, which is the busiest part.
    const bool isRim = random.uniform() < 0.33F;
    const float height = isRim ? random.uniform(-0.25F, kRim) : random.uniform(-1.0F, kRim);
    const float azimuthRad = random.uniform(0.0F, 2.0F * kPi);
    const float across = std::sqrt(1.0F - height * height);
    const float depth = random.uniform(-1.0F, 1.0F);
    const bool isLining = depth < -0.6F;
    twig.shell = 1.0F + kWall * depth;
    twig.middle =
        twig.shell * kBowlRadii *
        glm::vec3(across * sdf::cosine(azimuthRad), height, across * sdf::sine(azimuthRad));
    twig.shellSlope = isLining ? 0.0F : 0.16F * bell(random);
    const float turnRad = random.uniform() < 0.3F ? 1.4F : 0.7F;
    twig.headingRad = turnRad * bell(random);
    twig.lengthM = random.uniform(0.55F, 1.75F);
    // A few have sprung out of the weave.
    const bool isLoose = depth > 0.2F && random.uniform() < 0.16F;
    twig.straightness = isLoose ? random.uniform(0.5F, 0.9F) : random.uniform(0.0F, 0.22F);
    if (isLoose) twig.lengthM = random.uniform(0.5F, 1.1F);
    twig.radiusM =
        thickness * (isLining ? random.uniform(0.005F, 0.008F) : random.uniform(0.007F, 0.015F));
    twig.waveM = random.uniform(0.0F, 0.022F);
    twig.wavePhaseRad = random.uniform(0.0F, 2.0F * kPi);
    twig.color = twigColor(random, isLining);
    return twig;
}

glm::vec3 shellNormal(const glm::vec3& point) {
    return glm::normalize(point / (kBowlRadii * kBowlRadii));
}

/// The direction along the shell, `headingRad` above the horizontal one around the bowl.
glm::vec3 headed(const glm::vec3& point, float headingRad) {
    const glm::vec3 normal = shellNormal(point);
    const glm::vec3 around = glm::normalize(glm::vec3(-point.z, 1e-6F, point.x));
    const glm::vec3 upwards = glm::cross(around, normal);
    return around * sdf::cosine(headingRad) + upwards * sdf::sine(headingRad);
}

/// Points from the twig's middle towards one end, `kSteps` steps.
constexpr int kSteps = 32;
using HalfPath = std::array<glm::vec3, kSteps + 1>;

HalfPath traced(const Twig& twig, bool isForward) {
    const float sign = isForward ? 1.0F : -1.0F;
    const float step = 0.5F * twig.lengthM / static_cast<float>(kSteps);
    const glm::vec3 start = sign * headed(twig.middle, twig.headingRad);
    glm::vec3 direction = start;
    glm::vec3 point = twig.middle;
    HalfPath path;
    path[0] = point;
    for (std::size_t i = 1; i < path.size(); ++i) {
        const float walkedM = step * static_cast<float>(i);
        const glm::vec3 normal = shellNormal(point);
        const glm::vec3 along = direction - normal * glm::dot(direction, normal);
        // On the wall it keeps its heading, as a bird bends twigs around; near the bottom, where
        // headings turn fast, it runs straight across.
        const float rho = std::sqrt(point.x * point.x + point.z * point.z);
        const float hold = 0.35F * ramp(0.2F, 0.7F, rho);
        direction = glm::normalize(glm::mix(along, sign * headed(point, twig.headingRad), hold));
        // Nothing that follows the bowl climbs over its rim.
        const float rim = kRim * kBowlRadii.y * twig.shell;
        direction.y = std::min(direction.y, std::max(0.0F, 4.0F * (rim - point.y)));
        point += direction * step;
        const float shell = twig.shell + sign * twig.shellSlope * walkedM;
        point *= shell / glm::length(point / kBowlRadii);
        path[i] = glm::mix(point, twig.middle + start * walkedM, twig.straightness);
    }
    return path;
}

void addTwig(const Twig& twig, int sides, int stretches, MeshBuilder& builder) {
    const HalfPath back = traced(twig, false);
    const HalfPath front = traced(twig, true);
    // A polygon of the circle's area: twigs are as thick whatever their sides.
    const float angleRad = 2.0F * kPi / static_cast<float>(sides);
    const float radiusM = twig.radiusM * std::sqrt(angleRad / sdf::sine(angleRad));
    std::vector<MeshBuilder::Station> stations;
    for (int i = 0; i <= stretches; ++i) {
        const float t = 2.0F * static_cast<float>(i) / static_cast<float>(stretches) - 1.0F;
        const HalfPath& half = t < 0.0F ? back : front;
        const float place = std::abs(t) * static_cast<float>(kSteps);
        const auto before = std::min(static_cast<std::size_t>(place), std::size_t{kSteps - 1});
        const glm::vec3 point =
            glm::mix(half[before], half[before + 1], place - static_cast<float>(before));
        const float wave = twig.waveM * sdf::sine(5.0F * t + twig.wavePhaseRad);
        const float taper = 1.0F - 0.35F * (t + 1.0F) * 0.5F - 0.4F * t * t * t * t;
        stations.push_back({point + shellNormal(point) * wave, radiusM * taper});
    }
    builder.setColor(twig.color);
    builder.addTube(stations, sides, true);
}

constexpr int kEggs = 4;
constexpr int kEggSides = 16;
constexpr int kEggRings = 11;  // between the poles
constexpr int kEggTriangles = 2 * kEggSides * kEggRings;

/// A surface of revolution around `axis`, blunter at its end; smooth normals.
void addEgg(const glm::vec3& centre, const glm::mat3& axes, float halfLengthM, float radiusM,
            MeshBuilder& builder) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::uvec3> triangles;
    const auto sides = static_cast<unsigned>(kEggSides);
    const auto put = [&](float y, float out, float slope, float angleRad) {
        const glm::vec3 radial(sdf::cosine(angleRad), 0.0F, sdf::sine(angleRad));
        const glm::vec3 up(0.0F, 1.0F, 0.0F);
        positions.push_back(centre + axes * (out * radial + y * up));
        normals.push_back(axes *
                          glm::normalize(radial * std::sqrt(1.0F - slope * slope) + up * slope));
    };
    put(halfLengthM, 0.0F, 1.0F, 0.0F);
    for (int ring = 1; ring <= kEggRings; ++ring) {
        const float polarRad = kPi * static_cast<float>(ring) / static_cast<float>(kEggRings + 1);
        const float s = sdf::sine(polarRad);
        const float c = sdf::cosine(polarRad);
        constexpr float kBluntness = 0.16F;
        const float out = radiusM * s * (1.0F + kBluntness * c);
        // Of (out, y) by the polar angle; the normal is across.
        const float outSlope = radiusM * (c + kBluntness * (c * c - s * s));
        const float run = halfLengthM * s;
        const float slope = outSlope / std::sqrt(outSlope * outSlope + run * run);
        for (int side = 0; side < kEggSides; ++side) {
            put(halfLengthM * c, out, slope,
                2.0F * kPi * static_cast<float>(side) / static_cast<float>(kEggSides));
        }
    }
    put(-halfLengthM, 0.0F, -1.0F, 0.0F);
    const auto last = static_cast<unsigned>(positions.size() - 1);
    for (unsigned side = 0; side < sides; ++side) {
        const unsigned next = (side + 1) % sides;
        triangles.emplace_back(0U, 1 + next, 1 + side);
        for (unsigned ring = 0; ring + 1 < static_cast<unsigned>(kEggRings); ++ring) {
            const unsigned above = 1 + ring * sides;
            triangles.emplace_back(above + side, above + next, above + sides + next);
            triangles.emplace_back(above + side, above + sides + next, above + sides + side);
        }
        triangles.emplace_back(last, last - sides + side, last - sides + next);
    }
    builder.addIndexed(positions, normals, triangles);
}

Mesh eggs(std::uint64_t seed, int material) {
    Random random(seed, kEggStream);
    MeshBuilder builder;
    const float turnRad = random.uniform(0.0F, 2.0F * kPi);
    for (int i = 0; i < kEggs; ++i) {
        const float angleRad = turnRad + 2.0F * kPi * static_cast<float>(i) / kEggs;
        const glm::vec3 outwards(sdf::cosine(angleRad), 0.0F, sdf::sine(angleRad));
        // They lie on the lining, blunt ends up and outwards.
        const float leanRad = random.uniform(0.6F, 1.1F);
        const glm::vec3 axis =
            outwards * sdf::sine(leanRad) + glm::vec3(0, 1, 0) * sdf::cosine(leanRad);
        const glm::vec3 side = glm::normalize(glm::cross(axis, glm::vec3(0, 1, 0)));
        const glm::mat3 axes(side, axis, glm::cross(side, axis));
        const float brightness = random.uniform(0.85F, 1.0F);
        builder.setColor(brightness * glm::vec3(1.0F, random.uniform(0.96F, 1.0F), 1.0F));
        addEgg(outwards * 0.185F + glm::vec3(0.0F, -0.315F, 0.0F), axes, 0.165F, 0.122F, builder);
    }
    return builder.take("eggs", material);
}

constexpr int kBranchSides = 12;
constexpr int kForkSides = 10;
constexpr int kBranchStretches = 24;
constexpr int kForkStretches = 14;
constexpr int kBranchTriangles = 2 * kBranchSides * kBranchStretches + 2 * (kBranchSides - 2) +
                                 2 * (2 * kForkSides * kForkStretches + 2 * (kForkSides - 2));

/// One limb from `a` over `b` to `c` (a quadratic curve), knobbly.
void addLimb(const std::array<glm::vec3, 3>& curve, float radiusM, float endRadiusM, int sides,
             int stretches, MeshBuilder& builder) {
    std::vector<MeshBuilder::Station> stations;
    for (int i = 0; i <= stretches; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(stretches);
        const glm::vec3 point =
            glm::mix(glm::mix(curve[0], curve[1], t), glm::mix(curve[1], curve[2], t), t);
        const float knob =
            1.0F + 0.07F * sdf::sine(23.0F * t) + 0.05F * sdf::sine(57.0F * t + 1.0F);
        stations.push_back({point, glm::mix(radiusM, endRadiusM, t) * knob});
    }
    builder.addTube(stations, sides, true);
}

/// A branch under the nest and two forks that hold it.
Mesh branch(int material) {
    MeshBuilder builder;
    builder.setColor({0.105F, 0.080F, 0.060F});
    addLimb({{{-1.08F, -1.04F, 0.40F}, {0.0F, -0.80F, 0.0F}, {1.08F, -0.92F, -0.32F}}}, 0.135F,
            0.085F, kBranchSides, kBranchStretches, builder);
    builder.setColor({0.125F, 0.098F, 0.072F});
    addLimb({{{-0.35F, -0.92F, 0.12F}, {0.45F, -0.85F, 0.85F}, {0.80F, -0.08F, 0.76F}}}, 0.075F,
            0.016F, kForkSides, kForkStretches, builder);
    addLimb({{{0.25F, -0.88F, -0.05F}, {-0.35F, -0.85F, -0.85F}, {-0.72F, -0.04F, -0.84F}}}, 0.075F,
            0.016F, kForkSides, kForkStretches, builder);
    return builder.take("branch", material);
}

int usualTwigs(int triangles) {
    return std::max(triangles / kUsualTwigTriangles,
                    std::min(kReferenceTwigs, triangles / kCoarseTwigTriangles));
}

/// About as many stretches a twig as make them five times as long as the sides are wide.
int sidesFor(int trianglesPerTwig) {
    const float sides = std::sqrt(static_cast<float>(trianglesPerTwig) / 5.0F);
    return std::clamp(static_cast<int>(sides + 0.5F), 3, 24);
}

/// `count` twigs of `triangles` together, any even number.
Mesh twigs(int triangles, int count, int sides, float thickness, std::uint64_t seed, int material) {
    const int stretches = (triangles - count * 2 * (sides - 2)) / (2 * sides);
    // Volume is length · radius²: with the usual number of twigs the bowl holds as much wood
    // whatever the count of triangles.
    const float scale = thickness * std::sqrt(static_cast<float>(kReferenceTwigs) /
                                              static_cast<float>(usualTwigs(triangles)));
    Random random(seed, kTwigStream);
    MeshBuilder builder;
    for (int i = 0; i < count; ++i) {
        const Twig twig = makeTwig(random, scale);
        addTwig(twig, sides, stretches / count + (i < stretches % count ? 1 : 0), builder);
    }
    // What is less than a stretch.
    Mesh mesh = refinedTo(builder.take("twigs", material), triangles);
    GFXREPRO_ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(triangles));
    return mesh;
}

Material diffuse(std::string_view name, const glm::vec3& color) {
    Material material;
    material.name = name;
    material.baseColor = glm::vec4(color, 1.0F);
    return material;
}

}  // namespace

Scene birdNest(Params& params, std::uint64_t seed) {
    const int triangles =
        params.getInt("triangles", 67'000,
                      {"exact count; even, for twigs, eggs and branch are closed", "", 5000, 4e6});
    const int wantedTwigs = params.getInt(
        "twigs", 0,
        {"twigs in the bowl, which share the triangles: fewer are rounder and smoother; 0: one for "
         "every 530 triangles",
         "", 0, 250'000});
    const double thickness = params.getDouble(
        "twig_thickness", 1.0, {"factor on the twigs' radii, whatever their number", "", 0.2, 5.0});
    const int wantedSides = params.getInt(
        "sides", 0,
        {"sides of a twig, 3 or more: fewer are wider, and stretches shorter; 0: such that "
         "stretches are five times as long as sides are wide",
         "", 0, 24});
    params.finish();
    if (triangles % 2 != 0) {
        throw Error(params.locationOf("triangles"),
                    "triangles: " + std::to_string(triangles) +
                        " is odd, but twigs, eggs and branch are closed, which takes an even "
                        "number");
    }
    const int ofTwigs = triangles - kEggs * kEggTriangles - kBranchTriangles;
    const int count = wantedTwigs > 0 ? wantedTwigs : usualTwigs(ofTwigs);
    if (wantedSides == 1 || wantedSides == 2) {
        throw Error(params.locationOf("sides"), "sides: " + std::to_string(wantedSides) +
                                                    " enclose nothing; allowed: 0 and 3 … 24");
    }
    const int leastOfTwig = leastTwigTriangles(std::max(wantedSides, 3));
    if (count > ofTwigs / leastOfTwig) {
        throw Error(params.locationOf("twigs"),
                    "twigs: " + std::to_string(count) + " take at least " +
                        std::to_string(static_cast<long long>(count) * leastOfTwig) +
                        " triangles, but " + std::to_string(ofTwigs) + " are left of " +
                        std::to_string(triangles) + " beside eggs and branch");
    }
    Scene scene;
    scene.materials = {diffuse("twigs", glm::vec3(1.0F)), diffuse("eggs", {0.30F, 0.60F, 0.62F}),
                       diffuse("bark", glm::vec3(1.0F))};
    const int sides = wantedSides > 0 ? wantedSides : sidesFor(ofTwigs / count);
    scene.meshes = {twigs(ofTwigs, count, sides, static_cast<float>(thickness), seed, 0),
                    eggs(seed, 1), branch(2)};
    scene.instances = {{0}, {1}, {2}};
    Camera camera;
    camera.name = "three_quarter";
    camera.target = {0.08F, -0.23F, 0.14F};
    camera.position = {1.36F, 1.69F, 2.70F};
    camera.nearM = 0.3F;
    camera.farM = 10.0F;
    scene.cameras = {camera};
    return scene;
}

}  // namespace gfxrepro::scene
