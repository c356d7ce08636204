#include <array>

#include "scenes/city/parts.h"
#include "scenes/shadows/shadow_scenes.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

using namespace city_parts;

constexpr float kHalfSquareM = 16.0F;  // the paved part
constexpr float kDepthM = 10.0F;       // of the houses around it

/// The city's materials and one for leaves, which are seen from both sides.
struct Square {
    Builders city;
    MeshBuilder leaves;
};

void addFlat(MeshBuilder& builder, const glm::vec2& low, const glm::vec2& high) {
    builder.addQuad({low.x, 0.0F, high.y}, {high.x, 0.0F, high.y}, {high.x, 0.0F, low.y},
                    {low.x, 0.0F, low.y});
}

/// Slabs in two greys on the square; one dark surface below the houses.
void addPaving(MeshBuilder& ground) {
    constexpr int kSlabs = 16;
    constexpr float kSlabM = 2.0F * kHalfSquareM / static_cast<float>(kSlabs);
    for (int j = 0; j < kSlabs; ++j) {
        for (int i = 0; i < kSlabs; ++i) {
            ground.setColor((i + j) % 2 == 0 ? glm::vec3(0.46F, 0.44F, 0.40F)
                                             : glm::vec3(0.38F, 0.36F, 0.33F));
            const glm::vec2 low = glm::vec2(i, j) * kSlabM - kHalfSquareM;
            addFlat(ground, low, low + kSlabM);
        }
    }
    ground.setColor({0.20F, 0.20F, 0.21F});
    constexpr float kOut = kHalfSquareM + kDepthM;
    addFlat(ground, {-kOut, -kOut}, {kOut, -kHalfSquareM});
    addFlat(ground, {-kOut, kHalfSquareM}, {kOut, kOut});
    addFlat(ground, {-kOut, -kHalfSquareM}, {-kHalfSquareM, kHalfSquareM});
    addFlat(ground, {kHalfSquareM, -kHalfSquareM}, {kOut, kHalfSquareM});
}

/// On three sides; the fourth is open to the camera.
void addHouses(Square& square, Random& random) {
    constexpr int kHouses = 3;
    constexpr float kWidthM = 2.0F * kHalfSquareM / static_cast<float>(kHouses);
    for (int side = 0; side < 3; ++side) {
        for (int i = 0; i < kHouses; ++i) {
            const float from = -kHalfSquareM + kWidthM * static_cast<float>(i);
            const float near = kHalfSquareM + 0.5F;
            const float far = kHalfSquareM + kDepthM;
            Lot lot;
            if (side == 0) {
                lot.min = {from, -far};
                lot.max = {from + kWidthM - 0.3F, -near};
            } else {
                lot.min = {side == 1 ? -far : near, from};
                lot.max = {side == 1 ? -near : far, from + kWidthM - 0.3F};
            }
            lot.heightM = random.uniform(8.0F, 14.0F);
            addBuilding(square.city, lot, 1.0F, random.next());
        }
    }
}

void addRod(MeshBuilder& builder, const glm::vec3& from, const glm::vec3& to, float radius) {
    const std::array stations{MeshBuilder::Station{from, radius}, MeshBuilder::Station{to, radius}};
    builder.addTube(stations, 5, true);
}

/// Posts and two rails from a to b.
void addRailing(MeshBuilder& metal, const glm::vec3& a, const glm::vec3& b) {
    metal.setColor({0.08F, 0.10F, 0.09F});
    const int bars = static_cast<int>(glm::length(b - a) / 0.25F);
    for (int i = 0; i <= bars; ++i) {
        const glm::vec3 foot = glm::mix(a, b, static_cast<float>(i) / static_cast<float>(bars));
        addRod(metal, foot, foot + kUp, i % 8 == 0 ? 0.03F : 0.01F);
    }
    addRod(metal, a + kUp, b + kUp, 0.025F);
    addRod(metal, a + 0.15F * kUp, b + 0.15F * kUp, 0.015F);
}

/// A wire that sags as a parabola, and small flags that hang from it.
void addWire(Square& square, const glm::vec3& a, const glm::vec3& b) {
    constexpr int kPieces = 16;
    std::vector<MeshBuilder::Station> stations;
    for (int i = 0; i <= kPieces; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(kPieces);
        stations.push_back({glm::mix(a, b, t) - kUp * (3.2F * t * (1.0F - t)), 0.012F});
    }
    square.city.metal.setColor({0.05F, 0.05F, 0.05F});
    square.city.metal.addTube(stations, 4, true);
    const glm::vec3 along = 0.15F * glm::normalize(b - a);
    for (std::size_t i = 1; i + 1 < stations.size(); ++i) {
        square.leaves.setColor(i % 2 == 0 ? glm::vec3(0.7F, 0.10F, 0.08F)
                                          : glm::vec3(0.75F, 0.65F, 0.15F));
        const glm::vec3 at = stations[i].position;
        square.leaves.addTriangle(at - along, at - 0.35F * kUp, at + along);
    }
}

/// A trunk with boughs, and single leaves within a ball.
void addLeafyTree(Square& square, const glm::vec3& base, Random& random) {
    constexpr int kLeaves = 1500;
    constexpr float kCrownM = 1.6F;
    const glm::vec3 crown = base + 4.0F * kUp;
    square.city.plants.setColor({0.16F, 0.10F, 0.06F});
    const std::array trunk{MeshBuilder::Station{base, 0.16F}, MeshBuilder::Station{crown, 0.07F}};
    square.city.plants.addTube(trunk, 8, true);
    const auto inBall = [&] {
        for (;;) {
            const float z = random.uniform(-1.0F, 1.0F);
            const float y = random.uniform(-1.0F, 1.0F);
            const glm::vec3 p(random.uniform(-1.0F, 1.0F), y, z);
            if (glm::dot(p, p) <= 1.0F && glm::dot(p, p) > 0.01F) return p;
        }
    };
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 low = base + random.uniform(2.4F, 3.6F) * kUp;
        addRod(square.city.plants, low, crown + 0.8F * kCrownM * glm::normalize(inBall()), 0.03F);
    }
    for (int i = 0; i < kLeaves; ++i) {
        square.leaves.setColor(random.uniform(0.7F, 1.3F) * glm::vec3(0.10F, 0.28F, 0.05F));
        const glm::vec3 at = crown + kCrownM * inBall();
        const glm::vec3 along = 0.09F * glm::normalize(inBall());
        const glm::vec3 other = glm::abs(along.y) < 0.06F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        const glm::vec3 across = 0.05F * glm::normalize(glm::cross(along, other));
        square.leaves.addQuad(at - along, at + across, at + along, at - across);
    }
}

/// Benches, crates, and plates that lie 1 to 8 cm above the ground.
void addFurniture(Square& square, Random& random) {
    for (int i = 0; i < 4; ++i) {
        const glm::vec3 at(-6.0F + 4.0F * static_cast<float>(i), 0.0F, 7.0F);
        square.city.roofs.setColor({0.36F, 0.22F, 0.10F});
        for (int slat = 0; slat < 4; ++slat) {
            const float z = -0.24F + 0.16F * static_cast<float>(slat);
            square.city.roofs.addBox(at + glm::vec3(0.0F, 0.45F, z), {0.8F, 0.02F, 0.055F});
        }
        square.city.metal.setColor({0.10F, 0.10F, 0.11F});
        for (const float x : {-0.65F, 0.65F}) {
            square.city.metal.addBox(at + glm::vec3(x, 0.215F, 0.0F), {0.02F, 0.215F, 0.28F});
        }
        const float gap = 0.01F * static_cast<float>(1 << i);
        square.city.metal.setColor({0.42F, 0.40F, 0.36F});
        square.city.metal.addBox(at + glm::vec3(0.0F, gap + 0.01F, 2.6F), {0.9F, 0.01F, 0.5F});
    }
    for (int i = 0; i < 7; ++i) {
        square.city.roofs.setColor(random.uniform(0.8F, 1.2F) * glm::vec3(0.42F, 0.28F, 0.14F));
        const float half = random.uniform(0.25F, 0.45F);
        const float z = random.uniform(-3.0F, 6.0F);
        const glm::vec3 at(random.uniform(7.0F, 12.0F), 0.02F + half, z);
        square.city.roofs.addBox(at, glm::vec3(half));
    }
}

void addMesh(Scene& scene, MeshBuilder& builder, const char* name, float roughness,
             bool isDoubleSided = false) {
    if (builder.triangleCount() > 0) builder.addTo(scene, name, roughness, isDoubleSided);
}

void addCameraAndLights(Scene& scene) {
    Camera camera;
    camera.name = "open side";
    camera.position = {4.0F, 7.5F, 25.0F};
    camera.target = {-0.5F, 1.2F, 0.0F};
    camera.verticalFovRad = 0.75F;
    camera.nearM = 0.5F;
    camera.farM = 120.0F;
    scene.cameras.push_back(camera);
    const glm::vec3 moon(-22.0F, 32.0F, 20.0F);
    scene.lights.push_back({.position = moon, .intensity = glm::vec3(1.0F), .radiusM = 80.0F});
    for (const glm::vec2 at : {glm::vec2(8.0F, -8.0F), {-8.0F, -8.0F}, {8.0F, 10.0F}}) {
        scene.lights.push_back({.position = {at.x, 9.0F, at.y},
                                .intensity = glm::vec3(0.8F, 0.7F, 0.5F),
                                .radiusM = 12.0F});
    }
}

}  // namespace

Scene townSquare(Params& params, std::uint64_t seed) {
    params.finish();

    Random random(seed);
    Square square;
    addPaving(square.city.ground);
    addHouses(square, random);
    constexpr float kFence = 13.0F;
    addRailing(square.city.metal, {-kFence, 0.0F, -kFence}, {kFence, 0.0F, -kFence});
    addRailing(square.city.metal, {-kFence, 0.0F, -kFence}, {-kFence, 0.0F, kFence});
    for (const glm::vec2 at : {glm::vec2(-7.0F, -7.0F), {6.5F, -7.0F}, {-8.0F, 4.0F}}) {
        addLeafyTree(square, {at.x, 0.0F, at.y}, random);
    }
    constexpr glm::vec3 kPoles[] = {{-11, 0, 9}, {11, 0, 9}, {11, 0, -11}, {-11, 0, -11}};
    for (int i = 0; i < 4; ++i) {
        square.city.metal.setColor({0.30F, 0.31F, 0.32F});
        addRod(square.city.metal, kPoles[i], kPoles[i] + 6.0F * kUp, 0.05F);
        addWire(square, kPoles[i] + 5.9F * kUp, kPoles[(i + 1) % 4] + 5.9F * kUp);
    }
    for (const float x : {-3.0F, 3.0F}) addLampPost(square.city, {x, 0, -9}, {0, 0, 1});
    addCar(square.city, {1.5F, 0.0F, -3.5F}, {1, 0, 0}, random);
    addFurniture(square, random);

    Scene scene;
    addMesh(scene, square.city.ground, "ground", 1.0F);
    addMesh(scene, square.city.walls, "walls", 1.0F);
    addMesh(scene, square.city.glass, "glass", 0.2F);
    addMesh(scene, square.city.roofs, "roofs", 1.0F);
    addMesh(scene, square.city.metal, "metal", 0.5F);
    addMesh(scene, square.city.plants, "plants", 1.0F);
    addMesh(scene, square.leaves, "leaves", 1.0F, true);
    addCameraAndLights(scene);
    return scene;
}

}  // namespace gfxrepro::scene
