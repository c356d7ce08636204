#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/error.h"
#include "engine/scene/refine.h"
#include "scenes/city/parts.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/shared/fitted_camera.h"

namespace gfxrepro::scene {
namespace {

using namespace city_parts;

constexpr float kBlockM = 60.0F;
constexpr float kStreetM = 15.0F;
constexpr float kPitchM = kBlockM + kStreetM;
constexpr float kSidewalkM = 4.0F;
constexpr float kSidewalkHeightM = 0.2F;
/// What a block is given, about: 3 × 3 blocks make the default.
constexpr float kTrianglesPerBlock = 3400.0F;
/// Nothing else would hold a shop front and a roof.
constexpr float kLeastHeightM = 6.0F;

/// A place for something small on a street.
struct Slot {
    enum class Kind { Car, Tree, Lamp };
    Kind kind = Kind::Car;
    glm::vec3 base{0.0F};
    glm::vec3 direction{1.0F, 0.0F, 0.0F};
    std::uint64_t seed = 0;
};

/// What is chosen beside the count of triangles.
struct Settings {
    int blocks = 0;  // along each side
    float height = 1.0F;
};

/// Of the places for trees, lamps and cars along the streets: what is taken before windows get the
/// other triangles.
constexpr float kStreetShare = 0.2F;

/// Everything but the triangles: does not depend on the detail.
struct Plan {
    glm::ivec2 blocks{1};
    std::vector<Lot> lots, parks;
    std::vector<Slot> slots;  // in random order
    std::size_t usualSlots = 0;
};

glm::vec2 blockCorner(const Plan& plan, int i, int j) {
    const glm::vec2 size = glm::vec2(plan.blocks) * kPitchM - kStreetM;
    return glm::vec2(i, j) * kPitchM - 0.5F * size;
}

/// 1 at the centre, 0 at the rim.
float densityAt(const Plan& plan, const glm::vec2& point) {
    const glm::vec2 relative = point / (glm::vec2(plan.blocks) * (0.5F * kPitchM));
    return std::clamp(1.12F - glm::length(relative), 0.0F, 1.0F);
}

float heightAt(float density, Random& random) {
    const float u = random.uniform();
    if (density < 0.28F && random.uniform() < 0.75F) return 8.0F + 3.5F * u;
    if (random.uniform() < 1.5F * density - 0.45F) {
        return 38.0F + 85.0F * density * (0.25F + 0.75F * u);
    }
    return 13.0F + 20.0F * u * (0.5F + 0.5F * density);
}

/// Splits across the longer side until a lot has the size of a building. The city's centre, the
/// origin, is left inside of one.
void split(const Lot& lot, float largestM, Random& random, std::vector<Lot>& lots) {
    const glm::vec2 size = lot.max - lot.min;
    const int axis = size.x > size.y ? 0 : 1;
    if (size[axis] <= largestM * random.uniform(0.85F, 1.15F)) {
        lots.push_back(lot);
        return;
    }
    float cut = lot.min[axis] + size[axis] * random.uniform(0.4F, 0.6F);
    const float alleyM = random.index(3) == 0 ? 2.2F : 0.3F;
    constexpr float kInsideM = 5.0F;
    const int other = 1 - axis;
    if (lot.min[other] < 0.0F && lot.max[other] > 0.0F && std::abs(cut) < kInsideM) {
        cut = cut < 0.0F ? -kInsideM : kInsideM;
    }
    Lot low = lot;
    Lot high = lot;
    low.max[axis] = cut - 0.5F * alleyM;
    high.min[axis] = cut + 0.5F * alleyM;
    split(low, largestM, random, lots);
    split(high, largestM, random, lots);
}

void planBlock(Plan& plan, int i, int j, const Settings& settings, Random& random) {
    const glm::vec2 corner = blockCorner(plan, i, j);
    Lot block;
    block.min = corner + kSidewalkM;
    block.max = corner + kBlockM - kSidewalkM;
    block.density = densityAt(plan, 0.5F * (block.min + block.max));
    const bool isCentre = block.density > 0.85F;
    if (plan.blocks.x * plan.blocks.y > 4 && !isCentre && random.index(11) == 0) {
        plan.parks.push_back(block);
        return;
    }
    std::vector<Lot> lots;
    split(block, block.density < 0.28F ? 19.0F : 27.0F, random, lots);
    for (Lot& lot : lots) {
        lot.density = densityAt(plan, 0.5F * (lot.min + lot.max));
        lot.heightM = heightAt(lot.density, random);
        // A tower on a narrow lot would be a board.
        const glm::vec2 size = lot.max - lot.min;
        lot.heightM = std::min(lot.heightM, 6.5F * std::min(size.x, size.y));
        lot.heightM = std::max(settings.height * lot.heightM, kLeastHeightM);
        plan.lots.push_back(lot);
    }
}

/// Along the four sides of a block: trees and lamps on the sidewalk, cars before it.
void planSlots(Plan& plan, int i, int j, Random& random) {
    const glm::vec2 centre = blockCorner(plan, i, j) + 0.5F * kBlockM;
    constexpr float kHalf = 0.5F * kBlockM;
    for (int side = 0; side < 4; ++side) {
        const float sign = side < 2 ? 1.0F : -1.0F;
        const glm::vec3 out = side % 2 == 0 ? glm::vec3(sign, 0, 0) : glm::vec3(0, 0, sign);
        const glm::vec3 along(-out.z, 0.0F, out.x);
        const auto place = [&](float alongM, float outM, float y) {
            return glm::vec3(centre.x, y, centre.y) + along * alongM + out * (kHalf + outM);
        };
        const auto add = [&](Slot::Kind kind, const glm::vec3& base, const glm::vec3& direction) {
            plan.slots.push_back({kind, base, direction, random.next()});
        };
        for (int k = 0; k < 6; ++k) {
            const float at = (static_cast<float>(k) - 2.5F) * 9.0F;
            add(Slot::Kind::Tree, place(at + random.uniform(-1.0F, 1.0F), -1.3F, kSidewalkHeightM),
                out);
        }
        for (int k = 0; k < 3; ++k) {
            const float at = (static_cast<float>(k) - 1.0F) * 18.0F;
            add(Slot::Kind::Lamp, place(at, -0.6F, kSidewalkHeightM), out);
        }
        for (int k = 0; k < 8; ++k) {
            const float at = (static_cast<float>(k) - 3.5F) * 6.6F + random.uniform(-0.6F, 0.6F);
            add(Slot::Kind::Car, place(at, 1.3F, 0.0F), along);
        }
        for (int k = 0; k < 4; ++k) {
            const float at = (static_cast<float>(k) - 1.5F) * 15.0F + random.uniform(-4.0F, 4.0F);
            add(Slot::Kind::Car, place(at, 4.9F, 0.0F), along);
        }
    }
}

/// `blocks` along each side.
Plan planned(int blocks, const Settings& settings, std::uint64_t seed) {
    Plan plan;
    plan.blocks = glm::ivec2(blocks);
    Random random(seed);
    for (int j = 0; j < plan.blocks.y; ++j) {
        for (int i = 0; i < plan.blocks.x; ++i) {
            planBlock(plan, i, j, settings, random);
            planSlots(plan, i, j, random);
        }
    }
    for (std::size_t i = plan.slots.size(); i > 1; --i) {
        std::swap(plan.slots[i - 1], plan.slots[random.index(static_cast<std::uint32_t>(i))]);
    }
    plan.usualSlots =
        static_cast<std::size_t>(kStreetShare * static_cast<float>(plan.slots.size()));
    return plan;
}

void addSlot(Builders& builders, const Slot& slot) {
    Random random(slot.seed, 3);
    switch (slot.kind) {
        case Slot::Kind::Car:
            return addCar(builders, slot.base, slot.direction, random);
        case Slot::Kind::Tree:
            return addTree(builders, slot.base, random.uniform(4.5F, 8.0F), random);
        case Slot::Kind::Lamp:
            return addLampPost(builders, slot.base, slot.direction);
    }
}

void addFlat(MeshBuilder& builder, const glm::vec2& low, const glm::vec2& high, float y) {
    builder.addQuad({low.x, y, high.y}, {high.x, y, high.y}, {high.x, y, low.y}, {low.x, y, low.y});
}

/// Asphalt by crossings and stretches of street, with dashes, and the blocks' slabs.
void addStreets(Builders& builders, const Plan& plan) {
    constexpr float kDashHeightM = 0.03F;  // above the asphalt, so that depth tests tell them apart
    constexpr glm::vec3 kAsphalt(0.085F, 0.085F, 0.09F);
    MeshBuilder& ground = builders.ground;
    for (int j = 0; j <= plan.blocks.y; ++j) {
        for (int i = 0; i <= plan.blocks.x; ++i) {
            const glm::vec2 high = blockCorner(plan, i, j);
            const glm::vec2 low = high - kStreetM;
            ground.setColor(kAsphalt);
            addFlat(ground, low, high, 0.0F);
            for (int axis = 0; axis < 2; ++axis) {
                if ((axis == 0 ? i == plan.blocks.x : j == plan.blocks.y)) continue;
                glm::vec2 from = low;
                glm::vec2 to = high;
                from[axis] = high[axis];
                to[axis] = high[axis] + kBlockM;
                ground.setColor(kAsphalt);
                addFlat(ground, from, to, 0.0F);
                ground.setColor({0.62F, 0.60F, 0.52F});
                for (int k = 0; k < 6; ++k) {
                    glm::vec2 dash = from;
                    dash[axis] += 4.0F + 9.6F * static_cast<float>(k);
                    dash[1 - axis] += 0.5F * kStreetM - 0.15F;
                    glm::vec2 size(0.3F);
                    size[axis] = 4.0F;
                    addFlat(ground, dash, dash + size, kDashHeightM);
                }
            }
        }
    }
    ground.setColor({0.36F, 0.35F, 0.33F});
    for (int j = 0; j < plan.blocks.y; ++j) {
        for (int i = 0; i < plan.blocks.x; ++i) {
            const glm::vec2 low = blockCorner(plan, i, j);
            addSolid(ground,
                     {{low.x, 0.0F, low.y}, {low.x + kBlockM, kSidewalkHeightM, low.y + kBlockM}});
        }
    }
}

Builders built(const Plan& plan, float windows, std::uint64_t seed) {
    Builders builders;
    addStreets(builders, plan);
    Random random(seed, 4);
    for (const Lot& lot : plan.lots) addBuilding(builders, lot, windows, random.next());
    for (const Lot& lot : plan.parks) addPark(builders, lot, random.next());
    for (std::size_t i = 0; i < plan.usualSlots; ++i) addSlot(builders, plan.slots[i]);
    return builders;
}

/// As many blocks as leave room for windows, an odd number along each side: a crossing would lie
/// under the centre otherwise.
Plan fittingPlan(std::size_t triangles, const Settings& settings, std::uint64_t seed) {
    constexpr float kLeastWindows = 0.3F;
    const float across = std::sqrt(static_cast<float>(triangles) / kTrianglesPerBlock);
    for (int blocks = 2 * static_cast<int>(0.5F * across) + 1;; blocks -= 2) {
        Plan plan = planned(blocks, settings, seed);
        if (blocks == 1 || built(plan, kLeastWindows, seed).triangleCount() <= triangles)
            return plan;
    }
}

/// What the count allows for, in windows.
constexpr float kFewestWindows = 0.1F;
constexpr float kMostWindows = 4.0F;

/// As many windows as the count allows, then cars, trees and lamps for what is missing, and at last
/// the ground's longest edges halved.
Builders filled(const Plan& plan, std::size_t triangles, std::uint64_t seed) {
    constexpr int kBisections = 12;
    float low = kFewestWindows;
    float high = kMostWindows;
    Builders best = built(plan, low, seed);
    for (int i = 0; i < kBisections; ++i) {
        const float windows = 0.5F * (low + high);
        Builders builders = built(plan, windows, seed);
        if (builders.triangleCount() <= triangles) {
            low = windows;
            best = std::move(builders);
        } else {
            high = windows;
        }
    }
    constexpr std::size_t kLargestSlot = 40;
    for (std::size_t i = plan.usualSlots;
         i < plan.slots.size() && best.triangleCount() + kLargestSlot <= triangles; ++i) {
        addSlot(best, plan.slots[i]);
    }
    return best;
}

/// Throws Error unless the city can have `triangles`, to the 2 % that the ground may take up.
void checkCount(const Params& params, const Plan& plan, std::size_t count, std::size_t triangles) {
    const bool isTooMany = count > triangles;
    if (!isTooMany && 50 * count >= 49 * triangles) return;
    const std::string across = std::to_string(plan.blocks.x);
    throw Error(params.locationOf("blocks"),
                "blocks: " + across + " × " + across + " blocks of such buildings have at " +
                    (isTooMany ? "least " : "most ") + std::to_string(count) +
                    " triangles, but 'triangles' is " + std::to_string(triangles));
}

}  // namespace

Scene city(Params& params, std::uint64_t seed) {
    const int triangles =
        params.getInt("triangles", 50'000, {"exact count; more make a larger city", "", 5000, 1e6});
    Settings settings;
    settings.blocks = params.getInt(
        "blocks", 0,
        {"along each side, odd: a building stands under the centre then, not a crossing; fewer "
         "have more windows; 0: as many as give a block some 3400 triangles",
         "", 0, 31});
    settings.height = static_cast<float>(params.getDouble(
        "building_height", 1.0, {"factor on the buildings' heights", "", 0.5, 3.0}));
    params.finish();
    if (settings.blocks > 0 && settings.blocks % 2 == 0) {
        throw Error(params.locationOf("blocks"),
                    "blocks: " + std::to_string(settings.blocks) +
                        " is even, which puts a crossing under the city's centre; allowed: 0 and "
                        "odd numbers");
    }

    const auto wanted = static_cast<std::size_t>(triangles);
    const Plan plan = settings.blocks > 0 ? planned(settings.blocks, settings, seed)
                                          : fittingPlan(wanted, settings, seed);
    Builders builders = filled(plan, wanted, seed);
    checkCount(params, plan, builders.triangleCount(), wanted);
    const std::size_t missing = wanted - builders.triangleCount();
    Scene scene;
    builders.ground.addTo(scene, "ground", 1.0F);
    Mesh& ground = scene.meshes.back();
    const std::size_t ofGround = ground.triangles.size() + missing;
    ground = refinedTo(std::move(ground), static_cast<long long>(ofGround));
    builders.walls.addTo(scene, "walls", 1.0F);
    builders.glass.addTo(scene, "glass", 0.2F);
    builders.roofs.addTo(scene, "roofs", 1.0F);
    builders.metal.addTo(scene, "metal", 0.5F);
    builders.plants.addTo(scene, "plants", 1.0F);
    GFXREPRO_ASSERT_EQ(scene.triangleCount(), wanted);
    // Over the roofs, at an angle to the streets.
    const glm::vec3 target(0.0F, 0.15F * scene.bounds().max.y, 0.0F);
    scene.cameras.push_back(fittedCamera(scene, target, {0.36F, 0.56F, 0.86F}, 0.7F, 0.88F));
    return scene;
}

}  // namespace gfxrepro::scene
