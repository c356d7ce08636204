// Generator `grass`: a square of meadow at life size.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/scene/refine.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/shared/mesh_builder.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

// Streams of random numbers: parts do not change with each other's counts.
constexpr std::uint64_t kBladeStream = 1;
constexpr std::uint64_t kFieldStream = 2;

constexpr float kSideM = 2.4F;  // of the square, around the origin
constexpr int kCells = 32;      // of the ground, along each side
constexpr int kGroundTriangles = 2 * kCells * kCells;

/// Both sides of two stretches, a quad and a tip.
constexpr int kLeastBladeTriangles = 6;
/// Of a blade, where `blades` says nothing.
constexpr int kUsualBladeTriangles = 28;
/// Widths are stated for the number of blades that the default count of triangles gives.
constexpr int kReferenceBlades = 1926;

/// A smooth function over the field, in [−1, 1]: a few waves in directions and phases from the
/// seed.
class Waves {
  public:
    Waves(Random& random, float shortestM, float longestM) {
        for (Wave& wave : waves_) {
            const float angleRad = random.uniform(0.0F, 2.0F * kPi);
            const float lengthM = random.uniform(shortestM, longestM);
            wave.frequency =
                glm::vec2(sdf::cosine(angleRad), sdf::sine(angleRad)) * (2.0F * kPi / lengthM);
            wave.phaseRad = random.uniform(0.0F, 2.0F * kPi);
        }
    }

    float at(const glm::vec2& place) const {
        float sum = 0.0F;
        for (const Wave& wave : waves_) {
            sum += sdf::sine(glm::dot(wave.frequency, place) + wave.phaseRad);
        }
        return sum / static_cast<float>(waves_.size());
    }

  private:
    struct Wave {
        glm::vec2 frequency{0.0F};
        float phaseRad = 0.0F;
    };
    std::array<Wave, 5> waves_;
};

/// What varies slowly over the field. It depends on the seed only, not on the count.
struct Field {
    Waves ground, height, hue, lean;

    explicit Field(Random random)
        : ground(random, 0.7F, 2.5F),
          height(random, 0.3F, 1.2F),
          hue(random, 0.25F, 1.5F),
          lean(random, 0.8F, 2.5F) {}

    /// Of the corner (column, row) of the ground's grid.
    glm::vec3 corner(int column, int row) const {
        const glm::vec2 place =
            (glm::vec2(column, row) / static_cast<float>(kCells) - 0.5F) * kSideM;
        return {place.x, 0.09F * ground.at(place), place.y};
    }

    /// The point of the ground's triangles above or below a place of the field.
    glm::vec3 groundPoint(const glm::vec2& place) const {
        const glm::vec2 cell = (place / kSideM + 0.5F) * static_cast<float>(kCells);
        const int column = std::clamp(static_cast<int>(cell.x), 0, kCells - 1);
        const int row = std::clamp(static_cast<int>(cell.y), 0, kCells - 1);
        const float u = cell.x - static_cast<float>(column);
        const float v = cell.y - static_cast<float>(row);
        // The diagonal runs from corner (0, 0) to (1, 1), as groundMesh() cuts the cell.
        const float low = corner(column, row).y;
        const float high = corner(column + 1, row + 1).y;
        const float y = u > v
                            ? low + (u - v) * (corner(column + 1, row).y - low) + v * (high - low)
                            : low + (v - u) * (corner(column, row + 1).y - low) + u * (high - low);
        return {place.x, y, place.y};
    }
};

Mesh groundMesh(const Field& field, int material) {
    Mesh mesh;
    mesh.name = "ground";
    mesh.material = material;
    for (int row = 0; row <= kCells; ++row) {
        for (int column = 0; column <= kCells; ++column) {
            const glm::vec3 corner = field.corner(column, row);
            mesh.positions.push_back(corner);
            // Earth, mossy where the grass is greenest.
            const float moss = 0.5F + 0.5F * field.hue.at({corner.x, corner.z});
            mesh.colors.push_back(glm::mix(glm::vec3(0.085F, 0.058F, 0.033F),
                                           glm::vec3(0.055F, 0.070F, 0.025F), moss));
        }
    }
    const auto indexOf = [](int column, int row) {
        return static_cast<unsigned>(row * (kCells + 1) + column);
    };
    for (int row = 0; row < kCells; ++row) {
        for (int column = 0; column < kCells; ++column) {
            const unsigned a = indexOf(column, row);
            const unsigned c = indexOf(column + 1, row + 1);
            mesh.triangles.emplace_back(a, indexOf(column, row + 1), c);
            mesh.triangles.emplace_back(a, c, indexOf(column + 1, row));
        }
    }
    mesh.normals = vertexNormals(mesh);
    return mesh;
}

struct Blade {
    glm::vec3 root;
    float azimuthRad;  // of the bend
    float tiltRad;     // from the vertical, at the root
    float bendRad;     // further tilt at the tip
    float twistRad;    // of the tip against the root, around the blade's middle line
    float lengthM;
    float widthM;
    glm::vec3 rootColor, tipColor;
};

/// Linear colours of root and tip.
void colorBlade(Random& random, const Field& field, Blade& blade) {
    constexpr glm::vec3 kFresh(0.17F, 0.34F, 0.050F);
    constexpr glm::vec3 kDeep(0.050F, 0.145F, 0.035F);
    constexpr glm::vec3 kPale(0.34F, 0.40F, 0.10F);
    constexpr glm::vec3 kDry(0.44F, 0.34F, 0.15F);
    const float hue = 0.5F + 0.5F * field.hue.at({blade.root.x, blade.root.z});
    const float fresh = std::clamp(hue + random.uniform(-0.45F, 0.45F), 0.0F, 1.0F);
    const float brightness = random.uniform(0.75F, 1.2F);
    const bool isDry = random.uniform() < 0.05F;
    const glm::vec3 green = glm::mix(kDeep, kFresh, fresh);
    const glm::vec3 body = isDry ? kDry : green;
    const glm::vec3 tip = isDry ? kDry : glm::mix(green, kPale, random.uniform(0.1F, 0.7F));
    // Roots stand in the shade and are bleached or brown.
    blade.rootColor = brightness * glm::mix(body, glm::vec3(0.09F, 0.085F, 0.03F), 0.6F);
    blade.tipColor = brightness * tip;
}

Blade makeBlade(Random& random, const Field& field, float widthScale) {
    Blade blade{};
    const float x = random.uniform(-0.5F, 0.5F) * kSideM;
    const float z = random.uniform(-0.5F, 0.5F) * kSideM;
    blade.root = field.groundPoint({x, z});
    const float height = 1.0F + 0.45F * field.height.at({x, z});
    const bool isTall = random.uniform() < 0.08F;
    blade.lengthM = height * (isTall ? random.uniform(0.48F, 0.62F) : random.uniform(0.20F, 0.46F));
    // Blades bend every way, more of them with the wind.
    const float windRad = 0.9F + 0.9F * field.lean.at({x, z});
    const bool isWithWind = random.uniform() < 0.45F;
    blade.azimuthRad =
        isWithWind ? windRad + random.uniform(-0.7F, 0.7F) : random.uniform(0.0F, 2.0F * kPi);
    blade.tiltRad = random.uniform(0.02F, 0.45F);
    const float limp = random.uniform();
    blade.bendRad = 0.2F + (isTall ? 0.9F : 2.0F) * limp * limp;
    blade.twistRad = random.uniform(-1.2F, 1.2F);
    blade.widthM = widthScale * random.uniform(0.007F, 0.016F);
    colorBlade(random, field, blade);
    return blade;
}

/// The front of a curved strip that tapers to a point: all stretches are quads but the last. One
/// that is cut off ends in a quad, too.
void addBlade(const Blade& blade, int stretches, bool isCut, Mesh& mesh) {
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const glm::vec3 out(sdf::cosine(blade.azimuthRad), 0.0F, sdf::sine(blade.azimuthRad));
    const glm::vec3 across(-out.z, 0.0F, out.x);
    const auto first = static_cast<unsigned>(mesh.positions.size());
    const auto put = [&](const glm::vec3& position, const glm::vec3& normal, float t) {
        mesh.positions.push_back(position);
        mesh.normals.push_back(normal);
        mesh.colors.push_back(glm::mix(blade.rootColor, blade.tipColor, std::sqrt(t)));
    };
    glm::vec3 point = blade.root;
    const float step = blade.lengthM / static_cast<float>(stretches);
    for (int i = 0; i <= stretches; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(stretches);
        const float angleRad = blade.tiltRad + blade.bendRad * t * t;
        const glm::vec3 tangent = out * sdf::sine(angleRad) + up * sdf::cosine(angleRad);
        const glm::vec3 face = out * sdf::cosine(angleRad) - up * sdf::sine(angleRad);
        // The root is horizontal and stands on the ground, the tip turns.
        const float twistRad = blade.twistRad * t;
        const glm::vec3 side = across * sdf::cosine(twistRad) + face * sdf::sine(twistRad);
        const glm::vec3 normal = glm::normalize(glm::cross(side, tangent));
        if (i == stretches && !isCut) {
            put(point, normal, t);
        } else {
            const float taper = isCut ? 1.0F - 0.7F * t * t : 1.0F - t * t;
            const glm::vec3 half = 0.5F * blade.widthM * taper * side;
            put(point - half, normal, t);
            put(point + half, normal, t);
        }
        // The next stretch in the direction that holds at its middle.
        const float ahead = t + 0.5F / static_cast<float>(stretches);
        const float aheadRad = blade.tiltRad + blade.bendRad * ahead * ahead;
        point += step * (out * sdf::sine(aheadRad) + up * sdf::cosine(aheadRad));
    }
    const auto quads = static_cast<unsigned>(isCut ? stretches : stretches - 1);
    for (unsigned i = 0; i < quads; ++i) {
        const unsigned a = first + 2 * i;
        mesh.triangles.emplace_back(a, a + 1, a + 3);
        mesh.triangles.emplace_back(a, a + 3, a + 2);
    }
    if (isCut) return;
    const unsigned last = first + 2 * quads;
    mesh.triangles.emplace_back(last, last + 1, last + 2);
}

int usualBlades(int triangles) {
    return triangles / kUsualBladeTriangles;
}

/// `count` blades of `triangles` together, any even number.
Mesh bladeMesh(int triangles, int count, float widthScale, const Field& field, std::uint64_t seed,
               int material) {
    // The front of a blade has an odd number of triangles: where their sum has the wrong parity,
    // one blade is cut off.
    const int fronts = triangles / 2;
    const bool isOneCut = (fronts + count) % 2 != 0;
    const long long stretches = (fronts + count) / 2;
    Random random(seed, kBladeStream);
    Mesh mesh;
    mesh.name = "blades";
    mesh.material = material;
    for (long long i = 0; i < count; ++i) {
        const long long ofBlade = stretches * (i + 1) / count - stretches * i / count;
        addBlade(makeBlade(random, field, widthScale), static_cast<int>(ofBlade),
                 isOneCut && i == 0, mesh);
    }
    addBackSides(mesh);
    GFXREPRO_ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(triangles));
    return mesh;
}

}  // namespace

Scene grass(Params& params, std::uint64_t seed) {
    const int triangles = params.getInt(
        "triangles", 56'000,
        {"exact count, ground of 2048 included; even, for a blade has two sides", "", 10'000, 4e6});
    const int wantedBlades = params.getInt(
        "blades", 0,
        {"blades on the field, which share the triangles: fewer bend more smoothly; 0: one for "
         "every 28 triangles",
         "", 0, 600'000});
    const double width = params.getDouble(
        "blade_width", 1.0, {"factor on the blades' width, whatever their number", "", 0.2, 5.0});
    const int ofBlade = params.getInt(
        "blade_triangles", 0,
        {"of a blade, both sides together, even: the ground takes what blades leave; 0: blades "
         "share what a ground of 2048 leaves",
         "", 0, 1000});
    params.finish();
    if (triangles % 2 != 0) {
        throw Error(params.locationOf("triangles"),
                    "triangles: " + std::to_string(triangles) +
                        " is odd, but a blade has two sides, which takes an even number");
    }
    if (ofBlade % 2 != 0) {
        throw Error(params.locationOf("blade_triangles"),
                    "blade_triangles: " + std::to_string(ofBlade) +
                        " is odd, but a blade has two sides, which takes an even number");
    }
    const int beside = triangles - kGroundTriangles;
    const int count = wantedBlades > 0 ? wantedBlades : usualBlades(beside);
    const int leastOfBlade = ofBlade > 0 ? ofBlade : kLeastBladeTriangles;
    if (count > beside / leastOfBlade) {
        throw Error(params.locationOf("blades"),
                    "blades: " + std::to_string(count) + " take at least " +
                        std::to_string(static_cast<long long>(count) * leastOfBlade) +
                        " triangles, but " + std::to_string(beside) + " are left of " +
                        std::to_string(triangles) + " beside the ground");
    }
    const int ofBlades = ofBlade > 0 ? count * ofBlade : beside;
    const Field field{Random(seed, kFieldStream)};
    Scene scene;
    Material blades;
    blades.name = "grass";
    blades.baseColor = glm::vec4(1.0F);
    Material earth;
    earth.name = "earth";
    earth.baseColor = glm::vec4(1.0F);
    scene.materials = {blades, earth};
    // Blades stay as wide against the distance to their neighbours, which is 1/√count for the
    // usual count. Their area then grows by √count: finer grass is denser grass, as from a lawn to
    // moss.
    const float widthScale =
        static_cast<float>(width) *
        std::sqrt(static_cast<float>(kReferenceBlades) / static_cast<float>(usualBlades(beside)));
    scene.meshes = {bladeMesh(ofBlades, count, widthScale, field, seed, 0), groundMesh(field, 1)};
    if (ofBlade > 0) scene.meshes[1] = refinedTo(std::move(scene.meshes[1]), triangles - ofBlades);
    scene.instances = {{0}, {1}};
    Camera camera;
    camera.name = "three_quarter";
    camera.target = {-0.13F, 0.02F, 0.05F};
    camera.position = {1.95F, 2.80F, 4.68F};
    camera.nearM = 0.5F;
    camera.farM = 15.0F;
    scene.cameras = {camera};
    return scene;
}

}  // namespace gfxrepro::scene
