
#include <numbers>

#include "runner/core/error.h"
#include "runner/scene/refine.h"
#include "scenes/indoor/bathroom_parts.h"
#include "scenes/indoor/parts.h"
#include "scenes/indoor/rooms.h"

namespace gfxrepro::scene {

namespace {

using namespace bathroom_parts;

constexpr int kDiffuseTriangles = 44'000, kReflectiveTriangles = 46'000;

/// The scene as it grows: one mesh, material and instance an object.
class Room {
  public:
    int addTexture(image::Image8 texture) {
        scene.textures.push_back(std::move(texture));
        return static_cast<int>(scene.textures.size()) - 1;
    }

    /// Returns the instance. Reflectors are told by a reflectivity above 0.
    int add(MeshBuilder& builder, const char* name, const Material& material) {
        const int index = static_cast<int>(scene.meshes.size());
        builder.setColor(glm::vec3(1.0F));  // for what it builds next
        scene.materials.push_back(material);
        scene.materials.back().name = name;
        scene.meshes.push_back(builder.take(name, index));
        scene.instances.push_back({index, glm::mat4(1.0F)});
        return index;
    }
    int addDiffuse(MeshBuilder& builder, const char* name, const glm::vec3& color,
                   int texture = -1) {
        Material material;
        material.baseColor = glm::vec4(color, 1.0F);
        material.baseColorTexture = texture;
        return add(builder, name, material);
    }
    /// Brings the mesh to this many triangles; 0: as it is.
    int addReflector(MeshBuilder& builder, const char* name, const glm::vec3& color,
                     float reflectivity, int triangles, int texture = -1) {
        Material material;
        material.baseColor = glm::vec4(color, 1.0F);
        material.baseColorTexture = texture;
        material.roughness = 0.0F;
        material.metallic = reflectivity;
        const int instance = add(builder, name, material);
        Mesh& mesh = scene.meshes.back();
        if (triangles > 0) mesh = indoor::exactly(std::move(mesh), triangles);
        return instance;
    }

    /// Refines one object so that all of its kind together have this many.
    void fill(int instance, bool areReflectors, int triangles) {
        int others = 0;
        for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
            const bool isReflector = scene.materials[i].roughness == 0.0F;
            if (isReflector != areReflectors || static_cast<int>(i) == instance) continue;
            others += static_cast<int>(scene.meshes[i].triangles.size());
        }
        Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance)];
        mesh = indoor::exactly(std::move(mesh), triangles - others);
    }

    Scene scene;
};

Material foliage() {
    Material material;
    material.baseColor = glm::vec4(1.0F);
    material.isDoubleSided = true;
    return material;
}

/// Where a leaf at this place goes that grows before the window wall and beside the shower: what
/// is nearer than `kBendM` is pushed back, never nearer than `kLeastM`.
glm::vec3 clearOfWalls(glm::vec3 position) {
    constexpr float kBendM = 0.12F, kLeastM = 0.02F, kRoomM = kBendM - kLeastM;
    const auto pushed = [&](float distance) {
        return distance >= kBendM ? distance
                                  : kLeastM + kRoomM * kRoomM / (kRoomM + kBendM - distance);
    };
    position.z = pushed(position.z);
    const glm::vec2 fromCorner(position.x - kRoom.x, position.z);
    const float radius = glm::length(fromCorner);
    const glm::vec2 moved =
        fromCorner * ((kShowerRadiusM + pushed(radius - kShowerRadiusM)) / radius);
    return {kRoom.x + moved.x, position.y, moved.y};
}

Material glowing(const glm::vec3& color, const glm::vec3& emissive) {
    Material material;
    material.baseColor = glm::vec4(color, 1.0F);
    material.emissive = emissive;
    return material;
}

/// What casts the soft darkness of darken(): roughly what stands and hangs in the room.
constexpr Occluder kOccluders[] = {
    {{0.36F, 0.0F, 0.38F}, {1.94F, 0.58F, 1.12F}, true},
    {{0.0F, 0.28F, kVanityZ - 0.56F}, {0.46F, 0.82F, kVanityZ + 0.56F}, false},
    {{0.09F, 0.82F, kVanityZ - 0.24F}, {0.45F, 0.96F, kVanityZ + 0.24F}, true},
    {{2.78F, 0.0F, kToiletZ - 0.17F}, {3.38F, 0.44F, kToiletZ + 0.17F}, true},
    {{3.22F, 0.4F, kToiletZ - 0.18F}, {3.4F, 0.8F, kToiletZ + 0.18F}, false},
    {{3.25F, 1.34F, kToiletZ - 0.3F}, {3.4F, 2.0F, kToiletZ + 0.3F}, false},
    {{2.32F, 0.0F, -1.08F}, {4.48F, 2.06F, 1.08F}, true},
    {{2.88F, 0.0F, 2.58F}, {3.28F, 0.46F, 2.98F}, true},
    {{2.28F, 0.43F, 1.36F}, {2.56F, 0.57F, 1.64F}, true},
    {{3.14F, 1.19F, 2.35F}, {3.4F, 1.22F, 3.3F}, false},
    {{3.14F, 1.55F, 2.35F}, {3.4F, 1.58F, 3.3F}, false},
    {{3.16F, 1.58F, 2.4F}, {3.37F, 1.76F, 2.92F}, false},
    {{3.16F, 1.22F, 2.86F}, {3.37F, 1.34F, 3.25F}, false},
    {{0.06F, 0.66F, kTowelRailZ - 0.19F}, {0.13F, 1.2F, kTowelRailZ + 0.19F}, false},
    {{0.76F, 0.0F, 1.36F}, {1.64F, 0.02F, 1.88F}, false},
    {{2.0F, 0.0F, 0.06F}, {2.2F, 0.22F, 0.26F}, true},
};

void addShell(Room& room, std::uint64_t seed) {
    MeshBuilder builder, view;
    addTiledWalls(builder);
    room.addDiffuse(builder, "wall_tiles", glm::vec3(1.0F),
                    room.addTexture(glazedTilesTexture(
                        {{0.94F, 0.95F, 0.93F}, {0.76F, 0.77F, 0.75F}, 3, 6, 0.03F}, seed)));
    addPaintedWalls(builder);
    room.addDiffuse(builder, "painted_walls", {0.72F, 0.74F, 0.68F});
    addFloor(builder);
    room.addDiffuse(builder, "floor", glm::vec3(1.0F),
                    room.addTexture(indoor::tilesTexture({0.50F, 0.52F, 0.54F},
                                                         {0.36F, 0.37F, 0.38F}, 4, seed + 1)));
    addDoor(builder);
    room.addDiffuse(builder, "door", {0.78F, 0.79F, 0.76F});
    addWindow(builder, view);
    room.addDiffuse(builder, "window", {0.86F, 0.86F, 0.84F});
    Material outdoors = glowing(glm::vec3(1.0F), glm::vec3(0.0F));
    outdoors.baseColorTexture = room.addTexture(indoor::outdoorsTexture(seed + 2));
    outdoors.baseColor = glm::vec4(1.9F, 1.9F, 1.9F, 1.0F);  // as bright as day
    room.add(view, "outdoors", outdoors);
}

void addFurniture(Room& room, Random& random, std::uint64_t seed) {
    MeshBuilder builder;
    const int wood = room.addTexture(
        indoor::woodTexture({0.52F, 0.36F, 0.22F}, {0.72F, 0.54F, 0.36F}, seed + 3));
    addWoodwork(builder);
    room.addDiffuse(builder, "woodwork", glm::vec3(1.0F), wood);
    addIronware(builder);
    room.addDiffuse(builder, "ironware", {0.035F, 0.035F, 0.038F});
    addBottles(builder, random);
    room.addDiffuse(builder, "bottles", glm::vec3(1.0F));
    addWallLamps(builder);
    room.add(builder, "wall_lamps", glowing({0.9F, 0.87F, 0.8F}, glm::vec3(0.55F, 0.5F, 0.4F)));
    addBasket(builder);
    room.addDiffuse(builder, "basket", {0.55F, 0.38F, 0.2F});
    constexpr glm::vec3 kPot(2.08F, 0.0F, 0.16F);
    constexpr glm::vec2 kPotOutline[] = {
        {0.0F, 0.0F},    {0.078F, 0.0F},  {0.078F, 0.0F},   {0.108F, 0.21F},  {0.108F, 0.21F},
        {0.098F, 0.21F}, {0.098F, 0.21F}, {0.094F, 0.175F}, {0.094F, 0.175F}, {0.0F, 0.175F}};
    indoor::addLathe(builder, indoor::smoothed(kPotOutline, 14), 26, indoor::placed(kPot));
    room.addDiffuse(builder, "pot", {0.6F, 0.56F, 0.5F});
    indoor::addPalm(builder, 1.15F, 8, 2, random, indoor::placed(kPot + glm::vec3(0, 0.17F, 0)));
    room.add(builder, "palm", foliage());
    for (glm::vec3& position : room.scene.meshes.back().positions)
        position = clearOfWalls(position);
    constexpr glm::vec2 kPaper[] = {{0.022F, -0.05F}, {0.055F, -0.05F}, {0.055F, -0.05F},
                                    {0.055F, 0.05F},  {0.055F, 0.05F},  {0.022F, 0.05F}};
    indoor::addLathe(builder, kPaper, 32,
                     indoor::placedAlong({kRoom.x - 0.075F, 0.74F, kToiletZ + 0.42F}, {0, 0, 1}));
    room.addDiffuse(builder, "paper", glm::vec3(0.86F));
}

/// Returns the instance that takes the rest of the triangles.
int addTextiles(Room& room, Random& random) {
    MeshBuilder builder;
    addRolledTowels(builder);
    room.addDiffuse(builder, "rolled_towels", glm::vec3(1.0F));
    addBathMat(builder, random);
    room.addDiffuse(builder, "bath_mat", glm::vec3(1.0F));
    addTowels(builder);
    return room.addDiffuse(builder, "towels", glm::vec3(1.0F));
}

struct Moving {
    int pendant, dispenser, shavingMirror;
};

Moving addReflectors(Room& room, std::uint64_t seed) {
    constexpr glm::vec3 kCeramic(0.86F, 0.86F, 0.84F), kSteel(0.55F, 0.56F, 0.58F);
    constexpr float kGlazed = 0.3F, kChrome = 0.85F;
    MeshBuilder builder;
    const glm::vec3 zHalf(0.0F, 0.0F, -0.5F);
    indoor::addRectangle(builder, {0.02F, 1.62F, kVanityZ}, zHalf, {0.0F, 0.45F, 0.0F});
    room.addReflector(builder, "mirror", kSteel, 0.92F, 128);
    const float panelHalf = 0.5F * (kRoom.x - kShowerRadiusM);
    indoor::addRectangle(builder, {panelHalf, 0.5F * kWainscotM, 0.004F}, {panelHalf, 0.0F, 0.0F},
                         {0.0F, 0.5F * kWainscotM, 0.0F}, {2.3F, 1.0F});
    const int marble = room.addTexture(
        indoor::marbleTexture({0.80F, 0.78F, 0.74F}, {0.45F, 0.42F, 0.40F}, seed + 4));
    room.addReflector(builder, "wall_panel", glm::vec3(1.0F), 0.3F, 256, marble);
    indoor::addRectangle(builder, {kRoom.x - 0.154F, 1.67F, kToiletZ}, {0.0F, 0.0F, 0.285F},
                         {0.0F, 0.315F, 0.0F});
    room.addReflector(builder, "cabinet_door", kSteel, 0.9F, 64);

    addTubOutside(builder);
    room.addReflector(builder, "tub_outside", kCeramic, kGlazed, 0);
    addTubInside(builder);
    const int tubInside = room.addReflector(builder, "tub_inside", kCeramic, kGlazed, 0);
    addBasin(builder);
    room.addReflector(builder, "basin", kCeramic, kGlazed, 0);
    addVanity(builder);
    room.addReflector(builder, "vanity", {0.07F, 0.16F, 0.19F}, 0.25F, 0);
    addToilet(builder);
    room.addReflector(builder, "toilet", kCeramic, kGlazed, 0);
    addShowerWall(builder);
    const int mosaic = room.addTexture(
        glazedTilesTexture({{0.20F, 0.46F, 0.47F}, {0.66F, 0.70F, 0.68F}, 4, 8, 0.14F}, seed + 5));
    room.addReflector(builder, "shower_wall", glm::vec3(1.0F), 0.35F, 0, mosaic);
    addBasinTap(builder);
    room.addReflector(builder, "basin_tap", kSteel, kChrome, 0);
    addTubTap(builder);
    room.addReflector(builder, "tub_tap", kSteel, kChrome, 0);
    addTowelRail(builder);
    room.addReflector(builder, "towel_rail", kSteel, kChrome, 0);
    Moving moving{};
    addShavingMirror(builder);
    moving.shavingMirror = room.addReflector(builder, "shaving_mirror", kSteel, kChrome, 0);
    addDispenser(builder);
    moving.dispenser = room.addReflector(builder, "dispenser", kSteel, kChrome, 0);
    addPendant(builder);
    moving.pendant = room.addReflector(builder, "pendant", kSteel, kChrome, 0);
    room.fill(tubInside, true, kReflectiveTriangles);
    return moving;
}

void addLights(Scene& scene) {
    scene.lights = {{{1.15F, 1.75F, 0.45F}, glm::vec3(0.42F, 0.46F, 0.52F), 1.5F},  // the window
                    {kPendant - glm::vec3(0.0F, 0.05F, 0.0F), glm::vec3(0.50F, 0.46F, 0.39F), 1.6F},
                    {{0.35F, 1.8F, kVanityZ}, glm::vec3(0.2F, 0.18F, 0.14F), 0.9F},  // wall lamps
                    {{2.6F, 2.1F, 3.4F}, glm::vec3(0.14F, 0.14F, 0.15F), 1.5F}};  // from the door
}

Camera lookingAt(const glm::vec3& position, const glm::vec3& target, float fovRad) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.verticalFovRad = fovRad;
    camera.nearM = 0.05F;
    camera.farM = 20.0F;
    return camera;
}

void addCameras(Scene& scene) {
    scene.cameras.push_back(lookingAt({3.02F, 1.62F, 3.75F}, {1.42F, 0.8F, 1.2F}, 1.12F));
    scene.cameras.back().name = "overview";
    constexpr float kFov = 1.0F;
    scene.paths.push_back({"path_1",
                           {lookingAt({2.3F, 1.5F, 3.0F}, {1.5F, 0.55F, 0.6F}, kFov),
                            lookingAt({1.8F, 1.5F, 2.6F}, {1.5F, 0.42F, 0.65F}, kFov),
                            lookingAt({1.3F, 1.6F, 2.3F}, {1.35F, 0.33F, 0.8F}, kFov),
                            lookingAt({1.1F, 1.55F, 2.35F}, {1.9F, 0.43F, 0.65F}, kFov),
                            lookingAt({1.4F, 1.4F, 2.3F}, {3.0F, 0.7F, 1.2F}, kFov)}});
    scene.paths.push_back({"path_2",
                           {lookingAt({1.65F, 1.45F, 2.85F}, {0.3F, 0.6F, 2.3F}, kFov),
                            lookingAt({1.35F, 1.4F, 2.6F}, {0.25F, 0.62F, 2.3F}, kFov),
                            lookingAt({1.35F, 1.42F, 2.05F}, {0.75F, 0.35F, 1.1F}, kFov),
                            lookingAt({1.5F, 1.55F, 2.05F}, {1.3F, 0.28F, 0.85F}, kFov),
                            lookingAt({1.7F, 1.4F, 2.2F}, {2.95F, 0.6F, 1.15F}, kFov)}});
    // From about the overview 0.3 m to its left and back: frames that show the whole room.
    scene.paths.push_back({"aside",
                           {lookingAt({3.02F, 1.62F, 3.7F}, {1.42F, 0.8F, 1.2F}, 1.12F),
                            lookingAt({2.72F, 1.62F, 3.7F}, {1.12F, 0.8F, 1.2F}, 1.12F),
                            lookingAt({3.02F, 1.62F, 3.7F}, {1.42F, 0.8F, 1.2F}, 1.12F)}});
}

}  // namespace

Scene bathroom(config::Params& params, std::uint64_t seed) {
    params.finish();
    Room room;
    Random random(seed, 11);
    addShell(room, seed);
    addFurniture(room, random, seed);
    const int towels = addTextiles(room, random);
    MeshBuilder builder;
    addBulb(builder);
    const int bulb = room.add(builder, "bulb", glowing(glm::vec3(1.0F), {0.7F, 0.65F, 0.55F}));
    room.fill(towels, false, kDiffuseTriangles);
    const Moving moving = addReflectors(room, seed);
    Scene& scene = room.scene;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (scene.materials[i].emissive == glm::vec3(0.0F)) darken(scene.meshes[i], kOccluders);
    }
    addLights(scene);
    addCameras(scene);
    const glm::vec3 swing(0.07F, 0.0F, 0.03F), up(0.0F, 1.0F, 0.0F);
    constexpr float kTwoPi = 2.0F * std::numbers::pi_v<float>;
    scene.motions = {{moving.pendant, kPendant, up, 0.0F, swing, 6.0F},
                     {bulb, kPendant, up, 0.0F, swing, 6.0F},
                     {moving.dispenser, kDispenser, up, 2.0F * kTwoPi, glm::vec3(0.0F), 1.0F},
                     {moving.shavingMirror, kShavingMirror, up, 0.5F, glm::vec3(0.0F), 1.0F}};
    return scene;
}

}  // namespace gfxrepro::scene
