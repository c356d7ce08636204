#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "runner/core/error.h"
#include "scenes/indoor/living_room_parts.h"
#include "scenes/indoor/rooms.h"

namespace gfxrepro::scene {

namespace living_room {

std::size_t Builders::triangleCount() const {
    std::size_t count = 0;
    for (const MeshBuilder* builder : all) count += builder->triangleCount();
    return count;
}

int Detail::cells(int n, int least) const {
    return std::max(least, static_cast<int>(static_cast<float>(n) * value + 0.5F));
}

namespace {

/// A piece of furniture as the floor sees it.
struct Footprint {
    glm::vec2 centre, half;
    float darkness;  // how much of the light it keeps off
    float softM;     // how far it reaches
};

constexpr std::array kFootprints = {
    Footprint{{kSofa.x, kSofa.z}, {1.1F, 0.4F}, 0.75F, 0.16F},
    Footprint{{kArmchair.x, kArmchair.z}, {0.33F, 0.33F}, 0.7F, 0.16F},
    Footprint{{kTable.x, kTable.z}, {0.55F, 0.25F}, 0.35F, 0.3F},
    Footprint{{kBallChair.x, kBallChair.z}, {0.2F, 0.2F}, 0.65F, 0.3F},
    Footprint{{kSideboard.x, kSideboard.z}, {0.25F, 1.15F}, 0.6F, 0.14F},
    Footprint{{kBookcaseWest + 0.16F, 0.0F}, {0.15F, 1.24F}, 0.6F, 0.16F},
    Footprint{{kVase.x, kVase.z}, {0.08F, 0.08F}, 0.6F, 0.2F},
    Footprint{{kBall.x, kBall.z}, {0.02F, 0.02F}, 0.6F, 0.2F},
    Footprint{{kColumns[0].x, kColumns[0].z}, {0.2F, 0.2F}, 0.5F, 0.16F},
    Footprint{{kColumns[1].x, kColumns[1].z}, {0.2F, 0.2F}, 0.5F, 0.16F},
    Footprint{{kPots[0].x, kPots[0].z}, {0.14F, 0.14F}, 0.6F, 0.2F},
    Footprint{{kPots[1].x, kPots[1].z}, {0.14F, 0.14F}, 0.6F, 0.2F},
    Footprint{{kPedestal.x, kPedestal.z}, {0.2F, 0.2F}, 0.55F, 0.16F},
    Footprint{{kChair.x, kChair.z}, {0.16F, 0.16F}, 0.3F, 0.2F},
    Footprint{{kLampFoot.x, kLampFoot.z}, {0.12F, 0.12F}, 0.4F, 0.1F},
    Footprint{{kSideTable.x, kSideTable.z}, {0.12F, 0.12F}, 0.4F, 0.2F},
};

/// 1 on a surface, falling with the square of the distance.
float nearness(float distanceM, float reachM) {
    const float ratio = std::max(distanceM, 0.0F) / reachM;
    return 1.0F / (1.0F + ratio * ratio);
}

/// What the shading formula has no room for: less light in corners, near the floor and on
/// undersides, kept in the vertex colours.
void addAmbientOcclusion(Mesh& mesh, bool isShell) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3& p = mesh.positions[i];
        const glm::vec3& n = mesh.normals[i];
        float light = 1.0F;
        if (isShell) {
            const glm::vec2 toWall(kHalfRoom.x - std::abs(p.x), kHalfRoom.z - std::abs(p.z));
            // The wall that a point is on does not shade it.
            if (std::abs(n.x) < 0.7F) light *= 1.0F - 0.18F * nearness(toWall.x, 0.3F);
            if (std::abs(n.z) < 0.7F) light *= 1.0F - 0.18F * nearness(toWall.y, 0.3F);
            if (n.y > -0.7F) light *= 1.0F - 0.18F * nearness(kRoomHeightM - p.y, 0.3F);
            light *= 1.0F - 0.20F * nearness(p.y, 0.25F);
        } else {
            const float under = 1.0F - std::max(n.y, 0.0F);
            light *= 1.0F - 0.40F * under * nearness(p.y, 0.22F);
            light *= 1.0F + 0.30F * std::min(n.y, 0.0F);
        }
        mesh.colors[i] *= light;
    }
}

/// A distance to a wall, from −beyond on, brought to what is before the wall.
float bentBack(float distanceM, float bendM, float beyondM) {
    if (distanceM >= bendM) return distanceM;
    const float share = std::max((distanceM + beyondM) / (bendM + beyondM), 0.0F);
    return glm::mix(0.1F * bendM, bendM, share);
}

/// Leaves that would grow through a wall or a window pane are bent along it.
void keepInRoom(Mesh& leaves) {
    constexpr float kPane = kHalfRoom.z + 0.06F;
    for (glm::vec3& p : leaves.positions) {
        if (std::abs(p.x) < kWindowHigh.x) {  // the plant on the sill
            p.z = bentBack(p.z + kPane, 0.12F, 0.18F) - kPane;
            continue;
        }
        for (const int axis : {0, 2}) {
            const float kept =
                kHalfRoom[axis] - bentBack(kHalfRoom[axis] - std::abs(p[axis]), 0.3F, 0.4F);
            p[axis] = p[axis] < 0.0F ? -kept : kept;
        }
    }
    leaves.normals = vertexNormals(leaves);
}

/// All but the pile.
void build(Builders& builders, const Detail& detail, std::uint64_t seed) {
    addShell(builders);
    addPictures(builders);
    addTables(builders, detail);
    addLights(builders, detail);
    Random random(seed, 1);
    addCurtains(builders, detail, random);
    addSeats(builders, detail, random);
    addBookcase(builders, detail, random);
    addPlants(builders, detail, random);
}

/// As fine as leaves a fifth of the triangles to the rug's pile.
Detail fittingDetail(std::size_t triangles, std::uint64_t seed) {
    constexpr int kBisections = 10;
    float low = 0.1F;
    float high = 4.0F;
    for (int i = 0; i < kBisections; ++i) {
        const float middle = 0.5F * (low + high);
        Builders builders;
        build(builders, {middle}, seed);
        (builders.triangleCount() * 5 <= triangles * 4 ? low : high) = middle;
    }
    return {low};
}

struct Finish {
    const char* name;
    glm::vec3 color;
    int texture;  // −1: none
    bool isDoubleSided = false;
    glm::vec3 emissive{0.0F};
};

enum TextureIndex {
    kPlanks,
    kOak,
    kWalnut,
    kWallpaper,
    kMarble,
    kSofaCloth,
    kArmchairCloth,
    kCurtainCloth,
    kRugPattern,
    kLandscape,
    kAbstraction,
    kOutdoors
};

std::vector<image::Image8> textures(std::uint64_t seed) {
    using namespace indoor;
    std::vector<image::Image8> all;
    all.push_back(planksTexture({0.42F, 0.26F, 0.15F}, {0.66F, 0.45F, 0.28F}, 12, seed + 1));
    all.push_back(woodTexture({0.58F, 0.40F, 0.24F}, {0.78F, 0.60F, 0.40F}, seed + 2));
    all.push_back(woodTexture({0.27F, 0.16F, 0.10F}, {0.45F, 0.28F, 0.18F}, seed + 3));
    all.push_back(wallpaperTexture({0.72F, 0.75F, 0.68F}, {0.62F, 0.66F, 0.57F}, seed + 4));
    all.push_back(marbleTexture({0.86F, 0.83F, 0.78F}, {0.42F, 0.38F, 0.36F}, seed + 5));
    all.push_back(weaveTexture({0.72F, 0.70F, 0.66F}, {0.66F, 0.64F, 0.60F}, 24, seed + 6));
    all.push_back(weaveTexture({0.22F, 0.40F, 0.43F}, {0.18F, 0.34F, 0.38F}, 24, seed + 7));
    all.push_back(weaveTexture({0.84F, 0.74F, 0.58F}, {0.80F, 0.69F, 0.52F}, 32, seed + 8));
    all.push_back(rugTexture(seed + 9));
    all.push_back(paintingTexture(0, seed + 10));
    all.push_back(paintingTexture(1, seed + 11));
    all.push_back(outdoorsTexture(seed + 12));
    return all;
}

int addMaterial(Scene& scene, const Finish& finish) {
    Material material;
    material.name = finish.name;
    material.baseColor = glm::vec4(finish.color, 1.0F);
    material.baseColorTexture = finish.texture;
    material.isDoubleSided = finish.isDoubleSided;
    material.emissive = finish.emissive;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

int addInstance(Scene& scene, Mesh mesh) {
    const auto index = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({index, glm::mat4(1.0F)});
    return index;
}

void addDiffuse(Scene& scene, Builders& builders) {
    constexpr glm::vec3 kOne(1.0F);
    const std::array<std::pair<MeshBuilder*, Finish>, 17> finishes{
        {{&builders.paint, {"paint", kOne, -1}},
         {&builders.wallpaper, {"wallpaper", kOne, kWallpaper}},
         {&builders.oak, {"oak", kOne, kOak}},
         {&builders.walnut, {"walnut", kOne, kWalnut}},
         {&builders.sofa, {"sofa_cloth", kOne, kSofaCloth}},
         {&builders.armchair, {"armchair_cloth", kOne, kArmchairCloth}},
         {&builders.curtain, {"curtain_cloth", kOne, kCurtainCloth, true}},
         {&builders.rug, {"rug", kOne, kRugPattern}},
         {&builders.pile, {"rug_pile", kOne, -1, true}},
         {&builders.plants, {"leaves", kOne, -1, true}},
         {&builders.books, {"books", kOne, -1}},
         {&builders.landscape, {"landscape", kOne, kLandscape}},
         {&builders.abstraction, {"abstraction", kOne, kAbstraction}},
         {&builders.outdoors, {"outdoors", kOne, kOutdoors, false, glm::vec3(0.22F)}},
         {&builders.plain, {"plain", kOne, -1}},
         {&builders.glow, {"glow", glm::vec3(0.5F), -1, false, {0.62F, 0.55F, 0.42F}}},
         {&builders.chair, {"chair_oak", kOne, kOak}}}};
    for (const auto& [builder, finish] : finishes) {
        Mesh mesh = builder->take(finish.name, addMaterial(scene, finish));
        if (builder == &builders.plants) keepInRoom(mesh);
        const bool isShell = builder == &builders.paint || builder == &builders.wallpaper;
        const bool isDark = builder != &builders.outdoors && builder != &builders.glow &&
                            builder != &builders.pile && builder != &builders.rug;
        if (isDark) addAmbientOcclusion(mesh, isShell);
        addInstance(scene, std::move(mesh));
    }
}

void addReflectors(Scene& scene) {
    for (Reflector& reflector : reflectors()) {
        Finish finish{reflector.name.c_str(), reflector.baseColor, -1};
        if (reflector.texture == Reflector::Texture::Planks) finish.texture = kPlanks;
        if (reflector.texture == Reflector::Texture::Marble) finish.texture = kMarble;
        reflector.mesh.material = addMaterial(scene, finish);
        scene.materials.back().metallic = reflector.reflectivity;
        scene.materials.back().roughness = 0.0F;
        addInstance(scene, std::move(reflector.mesh));
    }
}

void addMotions(Scene& scene) {
    const auto instanceOf = [&](std::string_view name) {
        for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
            if (scene.meshes[i].name == name) return static_cast<int>(i);
        }
        throw Error("no such object");
    };
    constexpr float kTurn = 6.28318531F;
    constexpr glm::vec3 kUp(0, 1, 0);
    scene.motions.push_back({instanceOf("vase"), kVase, kUp, kTurn, {}, 1.0F});
    scene.motions.push_back({instanceOf("knot"), kPedestal, kUp, 2.0F * kTurn, {}, 1.0F});
    scene.motions.push_back({instanceOf("ball"), kBall, kUp, 0.0F, {0.16F, 0, 0}, 6.0F});
    scene.motions.push_back({instanceOf("chair_oak"), kChair, kUp, 0.0F, {0, 0, 0.08F}, 4.0F});
}

void addLamplight(Scene& scene) {
    scene.lights.push_back({kCeilingLamp + glm::vec3(0, -0.05F, 0), {0.46F, 0.42F, 0.36F}, 2.0F});
    scene.lights.push_back({{0.0F, 1.6F, -kHalfRoom.z - 0.3F}, {0.42F, 0.46F, 0.52F}, 2.2F});
    scene.lights.push_back({kLampShade + glm::vec3(0, -0.03F, 0), {0.34F, 0.29F, 0.21F}, 0.9F});
    scene.lights.push_back(
        {kSideboard + glm::vec3(-0.2F, 0.5F, 0.98F), {0.24F, 0.19F, 0.13F}, 0.6F});
}

}  // namespace

float floorLightAt(const glm::vec2& xz) {
    float light = 1.0F;
    for (const Footprint& f : kFootprints) {
        const glm::vec2 outside = glm::max(glm::abs(xz - f.centre) - f.half, 0.0F);
        light *= 1.0F - f.darkness * nearness(glm::length(outside), f.softM);
    }
    const glm::vec2 toWall(kHalfRoom.x - std::abs(xz.x), kHalfRoom.z - std::abs(xz.y));
    light *= 1.0F - 0.25F * nearness(std::min(toWall.x, toWall.y), 0.2F);
    return light;
}

void addRug(Builders& b, const image::Image8& pattern, int blades, Random& random) {
    constexpr float kCloth = 0.012F;
    constexpr int kCellsX = 20;
    constexpr int kCellsZ = 14;
    const auto at = [](float u, float v) {
        return kRug +
               glm::vec3(kHalfRug.x * (2.0F * u - 1.0F), kCloth, kHalfRug.y * (1.0F - 2.0F * v));
    };
    MeshBuilder cloth;
    indoor::addSheet(cloth, at, kCellsX, kCellsZ);
    const Mesh sheet = cloth.take("", 0);
    for (const glm::uvec3& t : sheet.triangles) {
        std::array<glm::vec3, 3> positions, normals;
        std::array<glm::vec2, 3> texcoords;
        for (int i = 0; i < 3; ++i) {
            positions[static_cast<std::size_t>(i)] = sheet.positions[t[i]];
            normals[static_cast<std::size_t>(i)] = {0, 1, 0};
            texcoords[static_cast<std::size_t>(i)] = sheet.texcoords[t[i]];
        }
        const std::array triangles{glm::uvec3(0, 1, 2)};
        const glm::vec3 middle = (positions[0] + positions[1] + positions[2]) / 3.0F;
        b.rug.setColor(glm::vec3(floorLightAt({middle.x, middle.z})));
        b.rug.addIndexed(positions, normals, triangles, texcoords);
    }
    // Wool covers the cloth as well whatever their number.
    const float width = std::sqrt(6.0F * 4.0F * kHalfRug.x * kHalfRug.y /
                                  static_cast<float>(std::max(blades, 1)) * 0.25F);
    const auto linear = [](std::uint8_t value) {
        const float c = static_cast<float>(value) / 255.0F;
        return c * (c * (c * 0.305306F + 0.682171F) + 0.0125229F);  // sRGB, to 0.002
    };
    for (int k = 0; k < blades; ++k) {
        const float u = random.uniform(0.004F, 0.996F);
        const float v = random.uniform(0.004F, 0.996F);
        const glm::vec3 p = at(u, v);
        const auto x = static_cast<int>(u * static_cast<float>(pattern.width()));
        const auto y = static_cast<int>(v * static_cast<float>(pattern.height()));
        const glm::vec3 wool(linear(pattern.at(x, y, 0)), linear(pattern.at(x, y, 1)),
                             linear(pattern.at(x, y, 2)));
        const glm::vec2 lean(random.uniform(-1.0F, 1.0F), random.uniform(-1.0F, 1.0F));
        const glm::vec3 across =
            0.5F * width * glm::normalize(glm::vec3(lean.y, 0, -lean.x) + glm::vec3(1e-3F, 0, 0));
        const glm::vec3 tip = p + glm::vec3(0.9F * width * lean.x, random.uniform(0.008F, 0.016F),
                                            0.9F * width * lean.y);
        // Lit as wool is: from the side it is turned to a little, from above mostly.
        const std::array positions{p - across, p + across, tip};
        const glm::vec3 normal = glm::normalize(glm::vec3(0.18F * lean.x, 1.0F, 0.18F * lean.y));
        const std::array normals{normal, normal, normal};
        const bool isUp =
            glm::cross(positions[1] - positions[0], positions[2] - positions[0]).y > 0.0F;
        const std::array triangles{isUp ? glm::uvec3(0, 1, 2) : glm::uvec3(0, 2, 1)};
        b.pile.setColor(wool * (floorLightAt({p.x, p.z}) * random.uniform(0.88F, 1.08F)));
        b.pile.addIndexed(positions, normals, triangles);
    }
}

}  // namespace living_room

Scene livingRoom(config::Params& params, std::uint64_t seed) {
    using namespace living_room;
    const int diffuse =
        params.getInt("diffuse_triangles", 150'000,
                      {"exact count on diffuse objects; 130,000 more are on reflective ones", "",
                       40'000, 400'000});
    params.finish();

    Scene scene;
    scene.textures = textures(seed);
    const auto wanted = static_cast<std::size_t>(diffuse);
    Builders builders;
    build(builders, fittingDetail(wanted, seed), seed);
    constexpr std::size_t kClothTriangles = 2 * 20 * 14;
    GFXREPRO_ASSERT(builders.triangleCount() + kClothTriangles <= wanted);
    Random random(seed, 2);
    addRug(builders, scene.textures[kRugPattern],
           static_cast<int>(wanted - builders.triangleCount() - kClothTriangles), random);
    addDiffuse(scene, builders);
    addReflectors(scene);
    addMotions(scene);
    addLamplight(scene);
    addCameras(scene);
    return scene;
}

}  // namespace gfxrepro::scene
