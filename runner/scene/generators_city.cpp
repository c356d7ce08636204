#include <algorithm>
#include <cmath>

#include "runner/scene/fitted_camera.h"
#include "runner/scene/generators_city_parts.h"
#include "runner/scene/generators_outdoor.h"

namespace gfxrepro::scene {

namespace {

using namespace city_parts;

constexpr float kBlockM = 60.0F;
constexpr float kStreetM = 15.0F;
constexpr float kPitchM = kBlockM + kStreetM;
constexpr float kSidewalkM = 4.0F;
constexpr float kSidewalkHeightM = 0.2F;
/// What a block is given, about: 4 × 4 blocks make the default.
constexpr float kTrianglesPerBlock = 3400.0F;

/// A place for something small on a street.
struct Slot {
    enum class Kind { Car, Tree, Lamp };
    Kind kind = Kind::Car;
    glm::vec3 base{0.0F};
    glm::vec3 direction{1.0F, 0.0F, 0.0F};
    std::uint64_t seed = 0;
};

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

/// Splits across the longer side until a lot has the size of a building.
void split(const Lot& lot, float largestM, Random& random, std::vector<Lot>& lots) {
    const glm::vec2 size = lot.max - lot.min;
    const int axis = size.x > size.y ? 0 : 1;
    if (size[axis] <= largestM * random.uniform(0.85F, 1.15F)) {
        lots.push_back(lot);
        return;
    }
    const float cut = lot.min[axis] + size[axis] * random.uniform(0.4F, 0.6F);
    const float alleyM = random.index(3) == 0 ? 2.2F : 0.3F;
    Lot low = lot;
    Lot high = lot;
    low.max[axis] = cut - 0.5F * alleyM;
    high.min[axis] = cut + 0.5F * alleyM;
    split(low, largestM, random, lots);
    split(high, largestM, random, lots);
}

void planBlock(Plan& plan, int i, int j, Random& random) {
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

Plan planned(float blocks, std::uint64_t seed) {
    Plan plan;
    plan.blocks.x = std::max(1, static_cast<int>(std::sqrt(blocks) + 0.5F));
    plan.blocks.y =
        std::max(1, static_cast<int>(blocks / static_cast<float>(plan.blocks.x) + 0.5F));
    Random random(seed);
    for (int j = 0; j < plan.blocks.y; ++j) {
        for (int i = 0; i < plan.blocks.x; ++i) {
            planBlock(plan, i, j, random);
            planSlots(plan, i, j, random);
        }
    }
    for (std::size_t i = plan.slots.size(); i > 1; --i) {
        std::swap(plan.slots[i - 1], plan.slots[random.index(static_cast<std::uint32_t>(i))]);
    }
    plan.usualSlots = plan.slots.size() / 5;
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

Builders built(const Plan& plan, float detail, std::uint64_t seed) {
    Builders builders;
    addStreets(builders, plan);
    Random random(seed, 4);
    for (const Lot& lot : plan.lots) addBuilding(builders, lot, detail, random.next());
    for (const Lot& lot : plan.parks) addPark(builders, lot, random.next());
    for (std::size_t i = 0; i < plan.usualSlots; ++i) addSlot(builders, plan.slots[i]);
    return builders;
}

/// As many blocks as leave room for windows.
Plan fittingPlan(std::size_t triangles, std::uint64_t seed) {
    constexpr float kLeastDetail = 0.3F;
    float blocks = static_cast<float>(triangles) / kTrianglesPerBlock;
    for (;;) {
        Plan plan = planned(blocks, seed);
        const bool isLeast = plan.blocks == glm::ivec2(1);
        if (isLeast || built(plan, kLeastDetail, seed).triangleCount() <= triangles) return plan;
        blocks *= 0.9F;
    }
}

/// As many windows as the count allows, then cars, trees and lamps for what is missing.
Builders filled(const Plan& plan, std::size_t triangles, std::uint64_t seed) {
    constexpr int kBisections = 12;
    float low = 0.1F;
    float high = 4.0F;
    Builders best = built(plan, low, seed);
    for (int i = 0; i < kBisections; ++i) {
        const float detail = 0.5F * (low + high);
        Builders builders = built(plan, detail, seed);
        if (builders.triangleCount() <= triangles) {
            low = detail;
            best = std::move(builders);
        } else {
            high = detail;
        }
    }
    constexpr std::size_t kLargestSlot = 40;
    for (std::size_t i = plan.usualSlots;
         i < plan.slots.size() && best.triangleCount() + kLargestSlot <= triangles; ++i) {
        addSlot(best, plan.slots[i]);
    }
    return best;
}

void addMesh(Scene& scene, MeshBuilder& builder, const char* name, float roughness) {
    const int index = static_cast<int>(scene.meshes.size());
    Material material;
    material.name = name;
    material.baseColor = {1.0F, 1.0F, 1.0F, 1.0F};
    material.roughness = roughness;
    scene.materials.push_back(material);
    scene.meshes.push_back(builder.take(name, index));
    scene.instances.push_back({index, glm::mat4(1.0F)});
}

}  // namespace

Scene city(config::Params& params, std::uint64_t seed) {
    const int triangles = params.getInt(
        "triangles", 50'000, {"count, met to 2 %; more make a larger city", "", 5000, 1e6});
    params.finish();

    const auto wanted = static_cast<std::size_t>(triangles);
    const Plan plan = fittingPlan(wanted, seed);
    Builders builders = filled(plan, wanted, seed);
    Scene scene;
    addMesh(scene, builders.ground, "ground", 1.0F);
    addMesh(scene, builders.walls, "walls", 1.0F);
    addMesh(scene, builders.glass, "glass", 0.2F);
    addMesh(scene, builders.roofs, "roofs", 1.0F);
    addMesh(scene, builders.metal, "metal", 0.5F);
    addMesh(scene, builders.plants, "plants", 1.0F);
    // Over the roofs, at an angle to the streets.
    const glm::vec3 target(0.0F, 0.15F * scene.bounds().max.y, 0.0F);
    scene.cameras.push_back(fittedCamera(scene, target, {0.36F, 0.56F, 0.86F}, 0.7F, 0.88F));
    return scene;
}

}  // namespace gfxrepro::scene
