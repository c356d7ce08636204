// The living room: where things stand, one function a group of them, and the ways through it.
//
// The room is a box with y up; its windows are in the north wall (−z), the sofa stands before the
// south wall and looks at them, bookcase in the west, television in the east.
//
// Longer than other files: the data of one scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "scenes/indoor/parts.h"
#include "scenes/indoor/rooms.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

using namespace indoor;

// --- where things stand ---

constexpr glm::vec3 kHalfRoom(3.6F, 0.0F, 2.9F);
constexpr float kRoomHeightM = 2.85F;

constexpr glm::vec2 kWindowLow(0.75F, 0.55F), kWindowHigh(2.05F, 2.3F);  // |x|, y
constexpr glm::vec3 kRug(0.0F, 0.0F, 0.25F);
constexpr glm::vec2 kHalfRug(1.75F, 1.25F);
constexpr glm::vec3 kTable(0.0F, 0.44F, 0.3F);  // middle of the coffee table's top
constexpr glm::vec2 kHalfTable(0.68F, 0.38F);
constexpr glm::vec3 kSofa(0.0F, 0.0F, 1.72F);
constexpr glm::vec3 kArmchair(-1.85F, 0.0F, 0.1F);
constexpr glm::vec3 kBallChair(2.15F, 0.0F, -0.2F);
constexpr glm::vec3 kSideTable(-1.42F, 0.52F, 1.75F);
constexpr float kSideTableRadius = 0.27F;
constexpr glm::vec3 kChair(0.05F, 0.0F, -2.42F);
constexpr glm::vec3 kSideboard(3.32F, 0.6F, 0.35F);  // middle of its top
constexpr glm::vec2 kHalfSideboard(0.24F, 1.15F);
constexpr float kBookcaseWest = -3.6F, kBookcaseDepth = 0.32F;
constexpr glm::vec2 kBookcaseZ(-1.25F, 1.25F);
constexpr glm::vec3 kVase(-0.95F, 0.0F, -1.5F);
constexpr glm::vec3 kBall(0.75F, 0.3F, -1.45F);
constexpr glm::vec3 kColumns[] = {{-2.5F, 0.0F, -1.9F}, {2.5F, 0.0F, -1.9F}};
constexpr glm::vec3 kPots[] = {{-3.1F, 0.0F, 2.2F}, {3.05F, 0.0F, -2.35F}};
constexpr glm::vec3 kPedestal(-3.0F, 0.85F, -2.3F);  // middle of its top
constexpr glm::vec3 kLampFoot(1.62F, 0.0F, 1.9F);
constexpr glm::vec3 kLampShade(0.62F, 1.78F, 0.95F);   // middle of its rim
constexpr glm::vec3 kCeilingLamp(0.0F, 2.2F, -0.35F);  // middle of its rim
constexpr glm::vec3 kMirror(0.0F, 1.62F, 2.86F);
constexpr glm::vec2 kHalfMirror(0.85F, 0.55F);
constexpr glm::vec3 kTelevision(3.53F, 1.42F, 0.35F);
constexpr glm::vec2 kHalfTelevision(0.72F, 0.41F);  // along z, y

/// Diffuse builders, one a material.
struct Builders {
    MeshBuilder paint, wallpaper, oak, walnut, sofa, armchair, curtain, rug, pile, plants, books,
        landscape, abstraction, outdoors, plain, glow, chair;
    MeshBuilder* all[17] = {&paint,       &wallpaper, &oak,   &walnut, &sofa,  &armchair,
                            &curtain,     &rug,       &pile,  &plants, &books, &landscape,
                            &abstraction, &outdoors,  &plain, &glow,   &chair};

    Builders() = default;
    Builders(const Builders&) = delete;
    Builders& operator=(const Builders&) = delete;
    std::size_t triangleCount() const {
        std::size_t count = 0;
        for (const MeshBuilder* builder : all) count += builder->triangleCount();
        return count;
    }
};

/// How finely a part is divided: what `at detail 1` has n cells gets n · value, at least `least`.
struct Detail {
    float value = 1.0F;
    int cells(int n, int least = 1) const {
        return std::max(least, static_cast<int>(static_cast<float>(n) * value + 0.5F));
    }
};

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

/// How much light a place on the floor keeps beside and under the furniture: 0 … 1.
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

// --- walls, windows, door, pictures ---

constexpr glm::vec3 kWhite(0.80F, 0.78F, 0.73F);
constexpr glm::vec3 kPanelling(0.60F, 0.60F, 0.55F);
constexpr float kRailM = 0.9F;  // wallpaper above, panelling below

/// An upright wall from `from` to `to` (x, z), its outside to the left when seen from above with x
/// to the right and z down … towards the room when it goes around clockwise.
void addWall(MeshBuilder& builder, const glm::vec2& from, const glm::vec2& to, float low,
             float high) {
    constexpr float kCellM = 0.3F;
    constexpr float kTileM = 1.3F;
    const float length = glm::length(to - from);
    // Texture coordinates follow the wall's own length, and the papers meet over windows.
    const float start = std::abs(to.x - from.x) > std::abs(to.y - from.y) ? from.x : from.y;
    const auto at = [&](float u, float v) {
        const glm::vec2 p = glm::mix(from, to, u);
        return glm::vec3(p.x, low + (high - low) * v, p.y);
    };
    MeshBuilder part;
    addSheet(part, at, std::max(1, static_cast<int>(length / kCellM)),
             std::max(1, static_cast<int>((high - low) / kCellM)), {1.0F, 1.0F});
    const Mesh mesh = part.take("", 0);
    std::vector<glm::vec2> texcoords;
    for (const glm::vec2& uv : mesh.texcoords) {
        texcoords.push_back(glm::vec2(start + length * uv.x, -(low + (high - low) * uv.y)) /
                            kTileM);
    }
    builder.addIndexed(mesh.positions, mesh.normals, mesh.triangles, texcoords);
}

/// Wallpaper over panelling with a rail and a skirting board; `frames` raised fields.
void addDressedWall(Builders& b, const glm::vec2& from, const glm::vec2& to, int fields) {
    addWall(b.wallpaper, from, to, kRailM, kRoomHeightM);
    b.paint.setColor(kPanelling);
    addWall(b.paint, from, to, 0.0F, kRailM);
    const glm::vec2 along = (to - from) / glm::length(to - from);
    const glm::vec3 x(along.x, 0, along.y);
    const glm::vec3 z = glm::cross(x, glm::vec3(0, 1, 0));
    const glm::mat4 frame{{x, 0}, {0, 1, 0, 0}, {z, 0}, {from.x, 0, from.y, 1}};
    const float length = glm::length(to - from);
    b.paint.setColor(kWhite);
    addPanel(b.paint, {0, 0, 0}, {length, 0.11F, 0.018F}, 1.0F, frame);
    addPanel(b.paint, {0, 0.11F, 0}, {length, 0.125F, 0.010F}, 1.0F, frame);
    addPanel(b.paint, {0, kRailM - 0.025F, 0}, {length, kRailM + 0.025F, 0.022F}, 1.0F, frame);
    b.paint.setColor(kPanelling * 1.08F);
    const float width = length / static_cast<float>(fields);
    for (int k = 0; k < fields; ++k) {
        const float middle = width * (static_cast<float>(k) + 0.5F);
        addFrame(b.paint, nullptr, {0.5F * width - 0.11F, 0.26F}, 0.03F, 0.014F,
                 frame * placed({middle, 0.5F, 0.0F}));
    }
}

/// Frame, mullions, sill and the walls of the opening.
void addWindow(Builders& b, float sign) {
    const float x0 = sign > 0 ? kWindowLow.x : -kWindowHigh.x;
    const float x1 = sign > 0 ? kWindowHigh.x : -kWindowLow.x;
    const float y0 = kWindowLow.y;
    const float y1 = kWindowHigh.y;
    const float z = -kHalfRoom.z;
    constexpr float kDeep = 0.16F;
    b.paint.setColor(kWhite);
    // Linings, a little proud of the wall as an architrave.
    addPanel(b.paint, {x0 - 0.07F, y0, z - kDeep}, {x0, y1, z + 0.02F});
    addPanel(b.paint, {x1, y0, z - kDeep}, {x1 + 0.07F, y1, z + 0.02F});
    addPanel(b.paint, {x0 - 0.07F, y1, z - kDeep}, {x1 + 0.07F, y1 + 0.08F, z + 0.02F});
    addPanel(b.paint, {x0 - 0.07F, y0 - 0.04F, z - kDeep}, {x1 + 0.07F, y0, z + 0.065F});
    const float back = z - 0.11F;
    const float front = z - 0.06F;
    const float middle = 0.5F * (x0 + x1);
    for (const float x : {x0, middle - 0.05F, x1 - 0.05F}) {
        addPanel(b.paint, {x, y0, back}, {x + (x == middle - 0.05F ? 0.1F : 0.05F), y1, front});
    }
    for (const float y : {y0, y1 - 0.06F}) {
        addPanel(b.paint, {x0, y, back}, {x1, y + 0.06F, front});
    }
    addPanel(b.paint, {x0, y1 - 0.5F, back + 0.01F}, {x1, y1 - 0.465F, front - 0.005F});
}

void addDoor(Builders& b) {
    const float z = kHalfRoom.z;
    const float x0 = 2.15F;
    const float x1 = 3.05F;
    constexpr float kHigh = 2.08F;
    addPanel(b.walnut, {x0, 0.005F, z - 0.05F}, {x1, kHigh, z}, 1.2F);
    b.paint.setColor(kWhite);
    addPanel(b.paint, {x0 - 0.09F, 0, z - 0.06F}, {x0, kHigh + 0.09F, z});
    addPanel(b.paint, {x1, 0, z - 0.06F}, {x1 + 0.09F, kHigh + 0.09F, z});
    addPanel(b.paint, {x0, kHigh, z - 0.06F}, {x1, kHigh + 0.09F, z});
    // Raised fields on the leaf, which faces −z, and a knob.
    const glm::mat4 turned = placed({0.5F * (x0 + x1), 0, z - 0.05F}, 3.14159265F);
    for (const float y : {0.55F, 1.45F}) {
        addFrame(b.walnut, nullptr, {0.27F, y < 1.0F ? 0.30F : 0.42F}, 0.03F, 0.016F,
                 turned * placed({0, y, 0}));
    }
    b.plain.setColor({0.55F, 0.42F, 0.20F});
    const Outline knob{{0.028F, 0},     {0.028F, 0.006F}, {0.01F, 0.012F}, {0.01F, 0.04F},
                       {0.03F, 0.055F}, {0.022F, 0.075F}, {0, 0.08F}};
    addTurned(b.plain, knob, 400, placedAlong({x0 + 0.08F, 1.0F, z - 0.05F}, {0, 0, -1}));
}

/// A moulding under the ceiling, along one wall.
void addCornice(MeshBuilder& builder, const glm::vec2& from, const glm::vec2& to) {
    const glm::vec2 along = (to - from) / glm::length(to - from);
    const glm::vec3 x(along.x, 0, along.y);
    const glm::vec3 z = glm::cross(x, glm::vec3(0, 1, 0));
    const auto at = [&](float u, float v) {
        // A quarter of a hollow from the wall up to the ceiling; ends meet in a mitre.
        const float in = 0.12F * v * v;
        const float length = glm::length(to - from);
        const glm::vec2 p = from + along * (in + (length - 2.0F * in) * u);
        return glm::vec3(p.x, kRoomHeightM - 0.12F * (1.0F - v) * (1.0F - v), p.y) + z * in;
    };
    addSheet(builder, at, 12, 6);
}

/// Walls, windows, door, mouldings.
void addShell(Builders& b) {
    const glm::vec3 h = kHalfRoom;
    // Clockwise from above with z down: north wall from east to west would face out, so west first.
    addDressedWall(b, {-h.x, h.z}, {-h.x, -h.z}, 6);
    addDressedWall(b, {h.x, -h.z}, {h.x, h.z}, 6);
    addDressedWall(b, {2.06F, h.z}, {-h.x, h.z}, 6);
    addWall(b.wallpaper, {3.14F, h.z}, {2.06F, h.z}, 2.17F, kRoomHeightM);
    addDressedWall(b, {h.x, h.z}, {3.14F, h.z}, 1);
    // North: the windows leave piers, and strips below and above.
    const float z = -h.z;
    addDressedWall(b, {-h.x, z}, {-kWindowHigh.x, z}, 2);
    addDressedWall(b, {-kWindowLow.x, z}, {kWindowLow.x, z}, 2);
    addDressedWall(b, {kWindowHigh.x, z}, {h.x, z}, 2);
    for (const float sign : {-1.0F, 1.0F}) {
        const float x0 = sign > 0 ? kWindowLow.x : -kWindowHigh.x;
        const float x1 = sign > 0 ? kWindowHigh.x : -kWindowLow.x;
        b.paint.setColor(kPanelling);
        addWall(b.paint, {x0, z}, {x1, z}, 0.0F, kWindowLow.y);
        addWall(b.wallpaper, {x0, z}, {x1, z}, kWindowHigh.y, kRoomHeightM);
        b.paint.setColor(kWhite);
        addPanel(b.paint, {x0, 0, z}, {x1, 0.11F, z + 0.018F});
        addWindow(b, sign);
    }
    addDoor(b);
    b.paint.setColor({0.80F, 0.79F, 0.76F});
    const auto ceiling = [&](float u, float v) {
        return glm::vec3(-h.x + 2.0F * h.x * u, kRoomHeightM, -h.z + 2.0F * h.z * v);
    };
    addSheet(b.paint, ceiling, 16, 14);
    b.paint.setColor(kWhite);
    addCornice(b.paint, {-h.x, h.z}, {-h.x, -h.z});
    addCornice(b.paint, {-h.x, -h.z}, {h.x, -h.z});
    addCornice(b.paint, {h.x, -h.z}, {h.x, h.z});
    addCornice(b.paint, {h.x, h.z}, {-h.x, h.z});
    // What the windows show.
    addRectangle(b.outdoors, {0, 1.45F, -h.z - 0.9F}, {4.2F, 0, 0}, {0, 2.1F, 0});
}

void addCurtains(Builders& b, const Detail& detail, Random& random) {
    const float z = -kHalfRoom.z + 0.16F;
    constexpr float kRodM = 2.5F;
    constexpr float kWidthM = 0.5F;
    for (const float sign : {-1.0F, 1.0F}) {
        const float x0 = sign > 0 ? kWindowLow.x : -kWindowHigh.x;
        const float x1 = sign > 0 ? kWindowHigh.x : -kWindowLow.x;
        for (const float x : {x0 - 0.22F, x1 + 0.22F - kWidthM}) {
            addCurtain(b.curtain, kWidthM, kRodM - 0.03F, 6, detail.cells(9, 4),
                       detail.cells(26, 2), random, placed({x, kRodM - 0.01F, z}));
        }
        const MeshBuilder::Station rod[] = {{{x0 - 0.28F, kRodM, z}, 0.014F},
                                            {{x1 + 0.28F, kRodM, z}, 0.014F}};
        b.plain.setColor({0.10F, 0.07F, 0.05F});
        b.plain.addTube(rod, 12, true);
        const Outline finial{{0, -0.03F}, {0.03F, 0}, {0, 0.03F}};
        for (const float x : {x0 - 0.29F, x1 + 0.29F}) {
            addTurned(b.plain, finial, 240, placedAlong({x, kRodM, z}, {1, 0, 0}));
        }
    }
}

void addPictures(Builders& b) {
    const float z = kHalfRoom.z;
    const glm::mat4 south = placed({0, 0, z}, kPi);  // faces −z: x runs west
    addFrame(b.walnut, &b.landscape, {0.5F, 0.36F}, 0.06F, 0.035F,
             south * placed({1.95F, 1.62F, 0}));
    addFrame(b.oak, &b.abstraction, {0.26F, 0.34F}, 0.04F, 0.03F,
             south * placed({-1.42F, 1.65F, 0}));
    // On the east wall, beside the television.
    const glm::mat4 east = placed({kHalfRoom.x, 0, 0}, -0.5F * kPi);  // x runs to +z
    addFrame(b.oak, &b.landscape, {0.36F, 0.27F}, 0.045F, 0.03F, east * placed({2.05F, 1.62F, 0}));
    const glm::mat4 north = placed({0, 0, -z});
    addFrame(b.walnut, &b.abstraction, {0.28F, 0.36F}, 0.05F, 0.03F, north * placed({0, 1.68F, 0}));
    // The mirror's frame; its glass is a reflector.
    addFrame(b.walnut, nullptr, kHalfMirror, 0.08F, 0.045F, south * placed({0, kMirror.y, 0}));
}

// --- furniture, books, plants, lamps ---

/// An upholstered block: 12 · (2 · 3 + 6)² triangles at detail 1.
RoundedBox upholstery(const glm::vec3& halfSize, float radius, const glm::vec3& bulge,
                      const Detail& detail) {
    RoundedBox box;
    box.halfSize = halfSize;
    box.radius = radius;
    box.edgeCells = detail.cells(3);
    box.faceCells = detail.cells(6);
    box.tileM = 0.22F;
    box.bulge = bulge;
    return box;
}

/// A turned leg from the floor up to `heightM`.
void addLeg(MeshBuilder& builder, const glm::vec3& place, float heightM, float radius,
            const Detail& detail) {
    const float r = radius;
    const float h = heightM;
    const Outline outline{{0, 0},
                          {0.6F * r, 0},
                          {0.6F * r, 0},
                          {0.75F * r, 0.03F * h},
                          {0.55F * r, 0.10F * h},
                          {0.9F * r, 0.55F * h},
                          {0.7F * r, 0.70F * h},
                          {1.05F * r, 0.76F * h},
                          {0.7F * r, 0.82F * h},
                          {1.1F * r, 0.88F * h},
                          {1.1F * r, h}};
    addTurned(builder, outline, std::max(280, detail.cells(560)), placed(place));
}

void addSofa(Builders& b, const Detail& detail) {
    const glm::mat4 f = placed(kSofa, kPi);  // faces −z; x runs west
    addRoundedBox(b.sofa, upholstery({1.02F, 0.13F, 0.42F}, 0.03F, {0, 0, 0}, detail),
                  f * placed({0, 0.23F, 0.0F}));
    for (const float side : {-1.0F, 1.0F}) {
        addRoundedBox(b.sofa, upholstery({0.12F, 0.27F, 0.45F}, 0.10F, {0.015F, 0.02F, 0}, detail),
                      f * placed({side * 1.08F, 0.36F, 0.0F}));
        for (const float depth : {-0.36F, 0.36F}) {
            addLeg(b.walnut, kSofa + glm::vec3(side * 1.05F, 0, depth), 0.12F, 0.03F, detail);
        }
    }
    addRoundedBox(b.sofa, upholstery({0.97F, 0.34F, 0.10F}, 0.08F, {0, 0.02F, 0.02F}, detail),
                  f * placed({0, 0.50F, -0.36F}));
    for (const float x : {-0.645F, 0.0F, 0.645F}) {
        addRoundedBox(b.sofa,
                      upholstery({0.32F, 0.085F, 0.34F}, 0.055F, {0.004F, 0.03F, 0.02F}, detail),
                      f * placed({x, 0.44F, 0.09F}));
        const glm::mat4 lean = f * placedAlong({x, 0.69F, -0.20F}, {0, 1, -0.22F});
        addRoundedBox(b.sofa,
                      upholstery({0.315F, 0.20F, 0.075F}, 0.06F, {0.004F, 0.02F, 0.05F}, detail),
                      lean);
    }
}

void addPillows(Builders& b, const Detail& detail, Random& random) {
    constexpr glm::vec3 kColors[] = {
        {0.50F, 0.16F, 0.10F}, {0.62F, 0.46F, 0.16F}, {0.12F, 0.26F, 0.32F}, {0.66F, 0.62F, 0.54F}};
    const glm::mat4 f = placed(kSofa, kPi);
    const float places[] = {-0.78F, -0.50F, 0.80F, 0.46F};
    for (int k = 0; k < 4; ++k) {
        b.plain.setColor(kColors[k]);
        const float x = places[k] + random.uniform(-0.03F, 0.03F);
        const float z = 0.03F + 0.10F * static_cast<float>(k % 2);
        const glm::mat4 lean = f * placed({x, 0, 0}, random.uniform(-0.3F, 0.3F)) *
                               placedAlong({0, 0.73F, z}, {0, 1, -0.35F});
        addPillow(b.plain, {0.22F, 0.22F, 0.085F}, detail.cells(16, 4), lean);
    }
}

void addArmchair(Builders& b, const Detail& detail) {
    const glm::mat4 f = placed(kArmchair, 0.5F * kPi - 0.12F);  // faces +x
    addRoundedBox(b.armchair, upholstery({0.32F, 0.12F, 0.38F}, 0.03F, {0, 0, 0}, detail),
                  f * placed({0, 0.25F, 0.0F}));
    addRoundedBox(b.armchair,
                  upholstery({0.29F, 0.08F, 0.33F}, 0.06F, {0.004F, 0.035F, 0.02F}, detail),
                  f * placed({0, 0.44F, 0.06F}));
    addRoundedBox(b.armchair, upholstery({0.34F, 0.36F, 0.09F}, 0.08F, {0, 0.03F, 0.05F}, detail),
                  f * placedAlong({0, 0.64F, -0.33F}, {0, 1, -0.16F}));
    for (const float side : {-1.0F, 1.0F}) {
        addRoundedBox(b.armchair,
                      upholstery({0.085F, 0.24F, 0.37F}, 0.075F, {0.015F, 0.015F, 0}, detail),
                      f * placed({side * 0.385F, 0.38F, 0.02F}));
        for (const float depth : {-0.30F, 0.32F}) {
            const glm::vec4 place = f * glm::vec4(side * 0.31F, 0, depth, 1);
            addLeg(b.walnut, glm::vec3(place), 0.15F, 0.03F, detail);
        }
    }
}

/// What lies in the ball chair; its shell is a reflector.
void addBallChairCushions(Builders& b, const Detail& detail) {
    const glm::mat4 f = placed(kBallChair, -0.5F * kPi);  // faces −x
    RoundedBox seat = upholstery({0.30F, 0.075F, 0.27F}, 0.07F, {0, 0.03F, 0.02F}, detail);
    addRoundedBox(b.armchair, seat, f * placedAlong({0, 0.44F, 0.06F}, {0, 1, -0.12F}));
    seat.halfSize = {0.27F, 0.24F, 0.07F};
    seat.radius = 0.065F;
    seat.bulge = {0, 0.02F, 0.03F};
    addRoundedBox(b.armchair, seat, f * placedAlong({0, 0.74F, -0.27F}, {0, 1, -0.30F}));
}

/// A wooden chair of turned legs and a ladder back, facing +z; its own object, for it slides.
void addChair(Builders& b, const Detail& detail) {
    b.chair.setColor({1, 1, 1});
    const glm::mat4 f = placed(kChair);
    for (const float x : {-0.19F, 0.19F}) {
        addLeg(b.chair, kChair + glm::vec3(x, 0, 0.18F), 0.44F, 0.022F, detail);
        const MeshBuilder::Station post[] = {{kChair + glm::vec3(x, 0, -0.20F), 0.014F},
                                             {kChair + glm::vec3(x, 0.45F, -0.19F), 0.020F},
                                             {kChair + glm::vec3(x, 0.95F, -0.27F), 0.013F}};
        addBentTube(b.chair, post, detail.cells(14, 2), 10);
        const MeshBuilder::Station rung[] = {{kChair + glm::vec3(x, 0.18F, -0.20F), 0.010F},
                                             {kChair + glm::vec3(x, 0.18F, 0.0F), 0.014F},
                                             {kChair + glm::vec3(x, 0.18F, 0.18F), 0.010F}};
        addBentTube(b.chair, rung, detail.cells(6, 2), 8);
    }
    RoundedBox seat;
    seat.halfSize = {0.225F, 0.02F, 0.215F};
    seat.radius = 0.018F;
    seat.edgeCells = detail.cells(3);
    seat.faceCells = detail.cells(4);
    seat.tileM = 0.6F;
    addRoundedBox(b.chair, seat, f * placed({0, 0.455F, 0}));
    for (const float y : {0.62F, 0.74F, 0.86F}) {
        const float z = -0.19F - 0.16F * (y - 0.45F);
        const auto slat = [&](float side) {
            return [=](float u, float v) {
                const float c = 2.0F * u - 1.0F;
                const float bow = -0.03F * (1.0F - c * c);
                const float top = 0.06F + 0.02F * (1.0F - c * c);
                const float x = 0.19F * (side > 0 ? c : -c);
                return kChair +
                       glm::vec3(x, y + top * v, z - 0.16F * top * v + bow + side * 0.007F);
            };
        };
        for (const float side : {-1.0F, 1.0F}) {
            addSheet(b.chair, slat(side), detail.cells(10, 3), 2, {0.3F, 0.1F});
        }
    }
}

void addSeats(Builders& b, const Detail& detail, Random& random) {
    addSofa(b, detail);
    addPillows(b, detail, random);
    addArmchair(b, detail);
    addBallChairCushions(b, detail);
    addChair(b, detail);
}

void addTables(Builders& b, const Detail& detail) {
    // Coffee table: a slab under the polished top, a shelf with books below, turned legs.
    RoundedBox slab;
    slab.halfSize = {kHalfTable.x, 0.02F, kHalfTable.y};
    slab.radius = 0.012F;
    slab.edgeCells = detail.cells(2);
    slab.faceCells = detail.cells(2);
    addRoundedBox(b.walnut, slab, placed(kTable - glm::vec3(0, 0.021F, 0)));
    addPanel(b.walnut, {kTable.x - 0.58F, 0.16F, kTable.z - 0.28F},
             {kTable.x + 0.58F, 0.18F, kTable.z + 0.28F}, 0.9F);
    for (const float x : {-0.60F, 0.60F}) {
        for (const float z : {-0.30F, 0.30F}) {
            addLeg(b.walnut, {kTable.x + x, 0.022F, kTable.z + z}, kTable.y - 0.06F, 0.034F,
                   detail);
        }
    }
    Random books(7);
    const glm::mat4 lying{{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {-0.02F, 0.181F, 0.40F, 1}};
    addBooks(b.books, 0.16F, 0.26F, 2, books, lying);

    // Side table: a round slab on one turned foot.
    const glm::vec3 s = kSideTable;
    const float r = kSideTableRadius;
    const Outline side{{0, 0},
                       {0.17F, 0},
                       {0.17F, 0},
                       {0.165F, 0.02F},
                       {0.05F, 0.05F},
                       {0.022F, 0.14F},
                       {0.04F, 0.30F},
                       {0.02F, 0.36F},
                       {0.03F, s.y - 0.05F},
                       {0.08F, s.y - 0.03F},
                       {r, s.y - 0.03F},
                       {r, s.y - 0.03F},
                       {r, s.y - 0.001F},
                       {r, s.y - 0.001F},
                       {0, s.y - 0.001F}};
    addTurned(b.walnut, side, std::max(450, detail.cells(1800)), placed({s.x, 0, s.z}));

    // Sideboard: body, plinth, two panelled doors between the lacquered panes.
    const glm::vec3 t = kSideboard;
    const glm::vec2 h = kHalfSideboard;
    addPanel(b.walnut, {t.x - h.x + 0.02F, 0.0F, t.z - h.y + 0.03F},
             {t.x + h.x, 0.08F, t.z + h.y - 0.03F}, 1.1F);
    addPanel(b.walnut, {t.x - h.x, 0.08F, t.z - h.y}, {t.x + h.x, t.y - 0.03F, t.z + h.y}, 1.1F);
    addPanel(b.walnut, {t.x - h.x - 0.015F, t.y - 0.03F, t.z - h.y - 0.015F},
             {t.x + h.x, t.y - 0.001F, t.z + h.y + 0.015F}, 1.1F);
    // The television's case; its screen is a reflector.
    b.plain.setColor({0.03F, 0.03F, 0.032F});
    addPanel(b.plain,
             {kTelevision.x + 0.002F, kTelevision.y - kHalfTelevision.y - 0.02F,
              kTelevision.z - kHalfTelevision.x - 0.02F},
             {kHalfRoom.x, kTelevision.y + kHalfTelevision.y + 0.02F,
              kTelevision.z + kHalfTelevision.x + 0.02F});
    // The knot's pedestal.
    const float p = kPedestal.y;
    const Outline pedestal{{0, 0},
                           {0.26F, 0},
                           {0.26F, 0},
                           {0.26F, 0.06F},
                           {0.26F, 0.06F},
                           {0.22F, 0.10F},
                           {0.19F, 0.14F},
                           {0.175F, 0.22F},
                           {0.165F, p - 0.16F},
                           {0.19F, p - 0.08F},
                           {0.22F, p - 0.06F},
                           {0.22F, p - 0.06F},
                           {0.22F, p},
                           {0.22F, p},
                           {0, p}};
    b.plain.setColor({0.66F, 0.63F, 0.57F});
    addTurned(b.plain, pedestal, std::max(450, detail.cells(2000)),
              placed({kPedestal.x, 0, kPedestal.z}));
}

void addBookcase(Builders& b, const Detail& detail, Random& random) {
    const float x0 = kBookcaseWest;
    const float x1 = x0 + kBookcaseDepth;
    const float z0 = kBookcaseZ.x;
    const float z1 = kBookcaseZ.y;
    constexpr float kTop = 2.25F;
    constexpr int kShelves = 6;
    addPanel(b.oak, {x0 + 0.02F, 0, z0}, {x0 + 0.035F, kTop, z1}, 0.9F);
    const float middle = 0.5F * (z0 + z1);
    for (const float z : {z0, middle - 0.0125F, z1 - 0.025F}) {
        addPanel(b.oak, {x0 + 0.035F, 0, z}, {x1, kTop, z + 0.025F}, 0.9F);
    }
    const float pitch = (kTop - 0.12F) / kShelves;
    for (int k = 0; k <= kShelves; ++k) {
        const float y = 0.08F + pitch * static_cast<float>(k);
        const float over = k == kShelves ? 0.03F : -0.003F;
        addPanel(b.oak, {x0 + 0.035F, y, z0 - over},
                 {x1 + std::max(over, -0.002F), y + 0.025F, z1 + over}, 0.9F);
        if (k == kShelves) break;
        for (const float z : {z0 + 0.03F, middle + 0.02F}) {
            // Facing +x: along −z seen from the front, so from the far end.
            const float length = 0.5F * (z1 - z0) - 0.06F;
            const glm::mat4 frame = placed({x1 - 0.04F, y + 0.025F, z + length}, 0.5F * kPi);
            const float used = random.index(5) == 0 ? 0.6F : 1.0F;
            addBooks(b.books, used * length, pitch - 0.05F, detail.cells(2), random, frame);
            if (used == 1.0F) continue;
            const glm::vec3 colors[] = {
                {0.16F, 0.28F, 0.34F}, {0.55F, 0.34F, 0.18F}, {0.66F, 0.60F, 0.48F}};
            b.plain.setColor(colors[random.index(3)]);
            const Outline jar{{0, 0},         {0.05F, 0},      {0.05F, 0},      {0.085F, 0.08F},
                              {0.07F, 0.15F}, {0.035F, 0.19F}, {0.045F, 0.21F}, {0.045F, 0.21F},
                              {0.04F, 0.21F}, {0.04F, 0.21F},  {0.03F, 0.19F},  {0, 0.17F}};
            addTurned(b.plain, jar, std::max(300, detail.cells(1200)),
                      placed({x0 + 0.17F, y + 0.025F, z + 0.17F}));
        }
    }
}

void addPlants(Builders& b, const Detail& detail, Random& random) {
    const int leafCells = detail.cells(3);
    for (int k = 0; k < 2; ++k) {
        const glm::vec3 soil = kPots[k] + glm::vec3(0, 0.42F, 0);
        b.plain.setColor({0.05F, 0.035F, 0.025F});
        const Outline earth{{0.225F, 0.0F}, {0.12F, 0.02F}, {0, 0.025F}};
        addTurned(b.plain, earth, 360, placed(soil));
        if (k == 0) addPalm(b.plants, 1.45F, 13, leafCells, random, placed(soil));
        if (k == 1) addBroadLeaves(b.plants, 1.55F, 150, leafCells, random, placed(soil));
    }
    // A small one on the window sill.
    const glm::vec3 sill(-1.2F, kWindowLow.y, -kHalfRoom.z + 0.03F);
    b.plain.setColor({0.52F, 0.24F, 0.14F});
    const Outline pot{{0, 0},           {0.045F, 0},     {0.045F, 0},     {0.06F, 0.10F},
                      {0.06F, 0.10F},   {0.068F, 0.10F}, {0.068F, 0.10F}, {0.068F, 0.125F},
                      {0.068F, 0.125F}, {0.06F, 0.125F}, {0.06F, 0.125F}, {0.055F, 0.10F},
                      {0, 0.10F}};
    addTurned(b.plain, pot, std::max(400, detail.cells(600)), placed(sill));
    addBroadLeaves(b.plants, 0.30F, 40, leafCells, random, placed(sill + glm::vec3(0, 0.10F, 0)));
}

void addLights(Builders& b, const Detail& detail) {
    // Bulbs in the hollow lamps, the table lamp's shade, the ceiling lamp's cord.
    const auto ball = [&](const glm::vec3& centre, float radius) {
        Outline outline;
        for (int k = 0; k <= 12; ++k) {
            const float angleRad = kPi * static_cast<float>(k) / 12.0F;
            outline.emplace_back(k % 12 == 0 ? 0.0F : radius * sdf::sine(angleRad),
                                 -radius * sdf::cosine(angleRad));
        }
        addTurned(b.glow, outline, std::max(400, detail.cells(800)), placed(centre));
    };
    ball(kCeilingLamp + glm::vec3(0, 0.06F, 0), 0.085F);
    ball(kLampShade + glm::vec3(0, 0.07F, 0), 0.06F);
    const MeshBuilder::Station cord[] = {{kCeilingLamp + glm::vec3(0, 0.265F, 0), 0.006F},
                                         {{kCeilingLamp.x, kRoomHeightM, kCeilingLamp.z}, 0.006F}};
    b.plain.setColor({0.08F, 0.08F, 0.08F});
    b.plain.addTube(cord, 10, true);
    const Outline rosette{{0, -0.035F}, {0.05F, -0.03F}, {0.06F, 0.0F}};
    addTurned(b.plain, rosette, 300, placed({kCeilingLamp.x, kRoomHeightM, kCeilingLamp.z}));
    // A cloth shade, with its inside.
    const Outline shade{{0.17F, 0},      {0.11F, 0.22F}, {0.11F, 0.22F}, {0.107F, 0.22F},
                        {0.107F, 0.22F}, {0.167F, 0},    {0.167F, 0},    {0.17F, 0}};
    b.glow.setColor({0.85F, 0.74F, 0.55F});
    addTurned(b.glow, shade, std::max(360, detail.cells(1400)),
              placed({kSideboard.x, kSideboard.y + 0.36F, kSideboard.z + 0.98F}));
    b.glow.setColor({1, 1, 1});
}

/// The rug's cloth, and exactly `blades` triangles of pile on it in the colours of its pattern.
void addRug(Builders& b, const image::Image8& pattern, int blades, Random& random) {
    constexpr float kCloth = 0.012F;
    constexpr int kCellsX = 20;
    constexpr int kCellsZ = 14;
    const auto at = [](float u, float v) {
        return kRug +
               glm::vec3(kHalfRug.x * (2.0F * u - 1.0F), kCloth, kHalfRug.y * (1.0F - 2.0F * v));
    };
    MeshBuilder cloth;
    addSheet(cloth, at, kCellsX, kCellsZ);
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
        const float leanZ = random.uniform(-1.0F, 1.0F);
        const glm::vec2 lean(random.uniform(-1.0F, 1.0F), leanZ);
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

// --- what reflects ---

/// A reflective object: a mesh of an exact number of triangles.
struct Reflector {
    std::string name;
    float reflectivity = 0.5F;
    glm::vec3 baseColor{0.5F};
    Mesh mesh;
    enum class Texture { None, Planks, Marble, Walnut } texture = Texture::None;
};

using Texture = Reflector::Texture;

constexpr glm::vec3 kChrome(0.42F, 0.43F, 0.45F), kCopper(0.55F, 0.27F, 0.15F),
    kBrass(0.52F, 0.38F, 0.15F), kBlack(0.03F, 0.03F, 0.035F);

class Collection {
  public:
    void add(const char* name, float reflectivity, const glm::vec3& color, MeshBuilder& builder,
             int triangles, Texture texture = Texture::None) {
        items_.push_back(
            {name, reflectivity, color, exactly(builder.take(name, 0), triangles), texture});
    }
    /// One turned part.
    void turn(const char* name, float reflectivity, const glm::vec3& color, const Outline& outline,
              int triangles, const glm::mat4& frame, Texture texture = Texture::None,
              float repeats = 1.0F) {
        MeshBuilder builder;
        addTurned(builder, outline, triangles, frame, repeats);
        add(name, reflectivity, color, builder, triangles, texture);
    }
    Reflector& last() { return items_.back(); }
    std::vector<Reflector> take() { return std::move(items_); }

  private:
    std::vector<Reflector> items_;
};

void addPlanar(Collection& all) {
    MeshBuilder builder;
    // Cells of 10 cm carry the shade beside the furniture.
    constexpr int kCellsX = 72;
    constexpr int kCellsZ = 58;
    const auto floor = [](float u, float v) {
        return glm::vec3(kHalfRoom.x * (2.0F * u - 1.0F), 0.0F, kHalfRoom.z * (1.0F - 2.0F * v));
    };
    addSheet(builder, floor, kCellsX, kCellsZ,
             {2.0F * kHalfRoom.x / 1.8F, 2.0F * kHalfRoom.z / 1.8F});
    all.add("floor", 0.35F, glm::vec3(1.0F), builder, 2 * kCellsX * kCellsZ, Texture::Planks);
    for (glm::vec3& normal : all.last().mesh.normals) normal = {0, 1, 0};
    for (std::size_t i = 0; i < all.last().mesh.positions.size(); ++i) {
        const glm::vec3& p = all.last().mesh.positions[i];
        all.last().mesh.colors[i] = glm::vec3(floorLightAt({p.x, p.z}));
    }
    addRoundedTop(builder, kHalfTable - 0.006F, 0.012F, 8, 0.0F, placed(kTable));
    all.add("coffee_table_top", 0.5F, {0.16F, 0.08F, 0.045F}, builder, 34);
    addRoundedTop(builder, glm::vec2(kSideTableRadius), kSideTableRadius, 12, 0.0F,
                  placed(kSideTable));
    all.add("side_table_top", 0.5F, {0.16F, 0.08F, 0.045F}, builder, 50);
    addRoundedTop(builder, kHalfSideboard + glm::vec2(0.0F, 0.01F), 0.01F, 4, 0.0F,
                  placed(kSideboard));
    all.add("sideboard_top", 0.45F, {0.16F, 0.08F, 0.045F}, builder, 18);
    addRectangle(builder, kMirror, {-kHalfMirror.x, 0, 0}, {0, kHalfMirror.y, 0});
    all.add("mirror", 0.95F, glm::vec3(0.6F), builder, 2);
    addRectangle(builder, kTelevision, {0, 0, kHalfTelevision.x}, {0, kHalfTelevision.y, 0});
    all.add("television", 0.3F, kBlack, builder, 2);
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 centre(kSideboard.x - kHalfSideboard.x - 0.004F, 0.32F,
                               kSideboard.z + 0.5F * side * kHalfSideboard.y);
        addRectangle(builder, centre, {0, 0, 0.5F * kHalfSideboard.y - 0.03F}, {0, 0.22F, 0});
        all.add(side < 0 ? "cabinet_pane_left" : "cabinet_pane_right", 0.55F, {0.10F, 0.02F, 0.02F},
                builder, 2);
    }
}

void addVases(Collection& all) {
    const Outline vase{{0, 0},           {0.17F, 0},     {0.17F, 0},      {0.20F, 0.03F},
                       {0.29F, 0.28F},   {0.35F, 0.56F}, {0.30F, 0.84F},  {0.16F, 1.02F},
                       {0.125F, 1.10F},  {0.15F, 1.18F}, {0.185F, 1.22F}, {0.185F, 1.225F},
                       {0.175F, 1.225F}, {0.14F, 1.18F}, {0.112F, 1.10F}, {0.145F, 1.02F},
                       {0.28F, 0.84F},   {0.33F, 0.56F}, {0.20F, 0.15F},  {0, 0.08F}};
    all.turn("vase", 0.6F, {0.05F, 0.13F, 0.30F}, vase, 14'000, placed(kVase));
    const Outline small{{0, 0},           {0.06F, 0},      {0.06F, 0},     {0.10F, 0.09F},
                        {0.085F, 0.17F},  {0.035F, 0.25F}, {0.03F, 0.31F}, {0.06F, 0.36F},
                        {0.055F, 0.362F}, {0.024F, 0.31F}, {0.03F, 0.25F}, {0.078F, 0.17F},
                        {0.08F, 0.09F},   {0, 0.03F}};
    all.turn("small_vase", 0.6F, {0.30F, 0.06F, 0.05F}, small, 4'000,
             placed(kSideboard + glm::vec3(0.0F, 0, -0.98F)));
    const Outline bowl{{0, 0},           {0.06F, 0},      {0.06F, 0},      {0.062F, 0.012F},
                       {0.13F, 0.045F},  {0.19F, 0.115F}, {0.192F, 0.12F}, {0.187F, 0.121F},
                       {0.125F, 0.053F}, {0.06F, 0.024F}, {0, 0.018F}};
    all.turn("bowl", 0.85F, kBrass, bowl, 5'000, placed(kTable + glm::vec3(0.40F, 0, 0.08F)));
    const Outline pot{{0, 0},           {0.17F, 0},      {0.17F, 0},      {0.24F, 0.12F},
                      {0.275F, 0.28F},  {0.25F, 0.44F},  {0.262F, 0.46F}, {0.255F, 0.475F},
                      {0.238F, 0.465F}, {0.228F, 0.44F}, {0.20F, 0.38F},  {0, 0.38F}};
    all.turn("pot_copper", 0.7F, kCopper, pot, 7'000, placed(kPots[0]));
    all.turn("pot_steel", 0.7F, kChrome, pot, 7'000, placed(kPots[1]));
}

void addTeapot(Collection& all) {
    constexpr float kSize = 0.105F;  // largest radius
    const glm::mat4 f = placed(kTable + glm::vec3(-0.22F, 0, -0.06F), 0.6F);
    const auto scaled = [](std::initializer_list<glm::vec2> points) {
        Outline outline;
        for (const glm::vec2& p : points) outline.push_back(p * kSize);
        return outline;
    };
    const auto station = [&](float x, float y, float r) {
        return MeshBuilder::Station{glm::vec3(f * glm::vec4(x * kSize, y * kSize, 0, 1)),
                                    r * kSize};
    };
    MeshBuilder builder;
    addTurned(builder,
              scaled({{0, 0},
                      {0.62F, 0},
                      {0.62F, 0},
                      {0.65F, 0.05F},
                      {0.90F, 0.30F},
                      {1.0F, 0.62F},
                      {0.90F, 0.98F},
                      {0.66F, 1.20F},
                      {0.66F, 1.20F},
                      {0.60F, 1.22F},
                      {0.56F, 1.19F},
                      {0.3F, 1.15F},
                      {0, 1.14F}}),
              6'400, f);
    addTurned(builder,
              scaled({{0.60F, 1.20F},
                      {0.58F, 1.25F},
                      {0.34F, 1.36F},
                      {0.12F, 1.42F},
                      {0.09F, 1.47F},
                      {0.16F, 1.55F},
                      {0.13F, 1.64F},
                      {0, 1.67F}}),
              2'200, f);
    const MeshBuilder::Station spout[] = {
        station(0.78F, 0.42F, 0.24F), station(1.12F, 0.58F, 0.18F), station(1.30F, 0.90F, 0.12F),
        station(1.42F, 1.16F, 0.09F), station(1.58F, 1.28F, 0.085F)};
    addBentTube(builder, spout, 34, 24);
    const MeshBuilder::Station handle[] = {
        station(-0.80F, 1.02F, 0.075F), station(-1.20F, 1.12F, 0.075F),
        station(-1.50F, 0.92F, 0.08F),  station(-1.42F, 0.58F, 0.075F),
        station(-1.12F, 0.36F, 0.07F),  station(-0.84F, 0.32F, 0.07F)};
    addBentTube(builder, handle, 44, 16);
    all.add("teapot", 0.8F, {0.50F, 0.48F, 0.42F}, builder, 12'000);
}

void addLamps(Collection& all) {
    MeshBuilder builder;
    // A foot on the floor, an arc over the sofa's end, the dish hanging from it.
    const Outline foot{{0, 0},          {0.17F, 0},     {0.17F, 0},     {0.17F, 0.025F},
                       {0.16F, 0.035F}, {0.03F, 0.05F}, {0.016F, 0.10F}};
    addTurned(builder, foot, 1'200, placed(kLampFoot));
    const glm::vec3 top = kLampShade + glm::vec3(0, 0.17F, 0);
    const glm::vec3 over = top - kLampFoot;
    const auto onArc = [&](float share, float y) {
        return MeshBuilder::Station{kLampFoot + glm::vec3(share * over.x, y, share * over.z),
                                    0.014F};
    };
    const MeshBuilder::Station arc[] = {
        onArc(0, 0.06F),     onArc(0.0F, 0.8F),   onArc(0.04F, 1.5F), onArc(0.22F, 2.02F),
        onArc(0.52F, 2.22F), onArc(0.85F, 2.16F), onArc(1.0F, 1.94F)};
    addBentTube(builder, arc, 84, 16);
    all.add("arc_lamp_stand", 0.9F, kChrome, builder, 4'000);
    const Outline dish{{0.235F, 0.0F},  {0.225F, 0.07F}, {0.17F, 0.14F},
                       {0.06F, 0.175F}, {0.0F, 0.18F},   {0.0F, 0.18F}};
    const Outline inside{{0, 0.165F},    {0.055F, 0.162F}, {0.16F, 0.13F}, {0.213F, 0.065F},
                         {0.225F, 0.0F}, {0.225F, 0.0F},   {0.235F, 0.0F}};
    const auto addDish = [&](const glm::vec3& place, float scale, int triangles) {
        // Inside from its top down to the rim, round it, and up outside: outlines turn the right
        // hand out when going up, so the inside is walked downwards.
        Outline both;
        for (const glm::vec2& p : inside) both.push_back(p * scale);
        for (const glm::vec2& p : dish) both.push_back(p * scale);
        both.pop_back();
        addTurned(builder, both, triangles, placed(place));
    };
    addDish(kLampShade, 1.0F, 8'000);
    all.add("arc_lamp_dish", 0.9F, kChrome, builder, 8'000);
    addDish(kCeilingLamp, 1.5F, 6'700);
    all.add("ceiling_lamp", 0.9F, kBrass, builder, 7'000);
    const Outline table{{0, 0},          {0.09F, 0},      {0.09F, 0},      {0.09F, 0.012F},
                        {0.03F, 0.03F},  {0.05F, 0.10F},  {0.085F, 0.17F}, {0.05F, 0.25F},
                        {0.015F, 0.30F}, {0.015F, 0.46F}, {0, 0.465F}};
    all.turn("table_lamp_foot", 0.9F, kChrome, table, 3'000,
             placed(kSideboard + glm::vec3(0, 0, 0.98F)));
    const Outline candlestick{{0, 0},          {0.055F, 0},     {0.055F, 0},      {0.05F, 0.012F},
                              {0.015F, 0.03F}, {0.012F, 0.06F}, {0.028F, 0.085F}, {0.012F, 0.11F},
                              {0.014F, 0.17F}, {0.032F, 0.19F}, {0.032F, 0.20F},  {0.012F, 0.20F},
                              {0, 0.20F}};
    all.turn("candlestick_left", 0.9F, kBrass, candlestick, 3'000,
             placed(kTable + glm::vec3(0.12F, 0, 0.22F)));
    all.turn("candlestick_right", 0.9F, kBrass, candlestick, 3'000,
             placed(kTable + glm::vec3(0.06F, 0, -0.24F)));
}

/// A sphere on a foot, open towards −x: chrome out- and inside.
void addBallChair(Collection& all) {
    MeshBuilder builder;
    const Outline foot{{0, 0},         {0.34F, 0},     {0.34F, 0},    {0.33F, 0.015F},
                       {0.12F, 0.05F}, {0.07F, 0.12F}, {0.09F, 0.20F}};
    addTurned(builder, foot, 2'000, placed(kBallChair));
    Outline shell;
    constexpr int kArc = 16;
    constexpr float kOpenRad = 2.22F;
    for (const float radius : {0.56F, 0.535F}) {
        for (int k = 0; k <= kArc; ++k) {
            const int j = radius > 0.55F ? k : kArc - k;
            const float angleRad = kOpenRad * static_cast<float>(j) / kArc;
            shell.emplace_back(j == 0 ? 0.0F : radius * sdf::sine(angleRad),
                               -radius * sdf::cosine(angleRad));
        }
    }
    addTurned(builder, shell, 12'000,
              placedAlong(kBallChair + glm::vec3(0, 0.72F, 0), {-1.0F, 0.16F, 0.12F}));
    all.add("ball_chair", 0.7F, kChrome, builder, 14'000);
}

/// A torus knot (2, 3) of polished bronze, on its pedestal.
void addKnot(Collection& all, int triangles) {
    constexpr int kSides = 36;
    const int length = triangles / (2 * kSides);
    MeshBuilder builder;
    const auto centreAt = [](float u) {
        const float a = 2.0F * kPi * u;
        const float r = 0.17F + 0.075F * sdf::cosine(3.0F * a);
        return glm::vec3(r * sdf::cosine(2.0F * a), 0.34F + r * sdf::sine(2.0F * a),
                         0.085F * sdf::sine(3.0F * a));
    };
    const auto at = [&](float u, float v) {
        // The frame is taken from the middle of the knot, which no tangent meets: it closes.
        const glm::vec3 c = centreAt(u);
        const glm::vec3 t = glm::normalize(centreAt(u + 0.002F) - centreAt(u - 0.002F));
        const glm::vec3 out = c - glm::vec3(0, 0.34F, 0);
        const glm::vec3 x = glm::normalize(out - t * glm::dot(out, t));
        const glm::vec3 y = glm::cross(x, t);
        const float a = v == 1.0F ? 0.0F : 2.0F * kPi * v;
        return kPedestal + c + 0.062F * (x * sdf::cosine(a) + y * sdf::sine(a));
    };
    // u wraps too: its last column repeats the first.
    const auto closed = [&](float u, float v) { return at(u == 1.0F ? 0.0F : u, v); };
    addSheet(builder, closed, length, kSides);
    all.add("knot", 0.8F, kCopper, builder, triangles);
}

/// 25 of them, 130,000 triangles.
std::vector<Reflector> reflectors() {
    Collection all;
    addPlanar(all);
    addVases(all);
    addTeapot(all);
    addLamps(all);
    addBallChair(all);
    Outline ball;
    for (int k = 0; k <= 16; ++k) {
        const float angleRad = kPi * static_cast<float>(k) / 16.0F;
        ball.emplace_back(k % 16 == 0 ? 0.0F : kBall.y * sdf::sine(angleRad),
                          -kBall.y * sdf::cosine(angleRad));
    }
    all.turn("ball", 0.9F, kChrome, ball, 8'000, placed(kBall));
    const float h = kRoomHeightM;
    const Outline column{{0.27F, 0},          {0.27F, 0.10F},      {0.27F, 0.10F},
                         {0.25F, 0.10F},      {0.25F, 0.10F},      {0.262F, 0.125F},
                         {0.25F, 0.15F},      {0.25F, 0.15F},      {0.22F, 0.17F},
                         {0.20F, 0.22F},      {0.20F, 0.22F},      {0.195F, h - 0.30F},
                         {0.195F, h - 0.30F}, {0.215F, h - 0.27F}, {0.195F, h - 0.24F},
                         {0.195F, h - 0.24F}, {0.25F, h - 0.12F},  {0.25F, h - 0.12F},
                         {0.27F, h - 0.12F},  {0.27F, h - 0.12F},  {0.27F, h}};
    all.turn("column_west", 0.4F, glm::vec3(1.0F), column, 4'000, placed(kColumns[0]),
             Texture::Marble, 2.0F);
    all.turn("column_east", 0.4F, glm::vec3(1.0F), column, 4'000, placed(kColumns[1]),
             Texture::Marble, 2.0F);
    addKnot(all, 14'538);
    return all.take();
}

// --- cameras and paths ---

constexpr float kFovRad = 0.95F;

Camera camera(std::string_view name, const glm::vec3& position, const glm::vec3& target,
              float verticalFovRad = kFovRad) {
    Camera result;
    result.name = name;
    result.position = position;
    result.target = target;
    result.verticalFovRad = verticalFovRad;
    result.nearM = 0.05F;
    result.farM = 20.0F;
    return result;
}

/// Position and target of each key.
CameraPath path(std::string_view name,
                std::initializer_list<std::pair<glm::vec3, glm::vec3>> keys) {
    CameraPath result;
    result.name = name;
    for (const auto& [position, target] : keys) {
        result.keys.push_back(camera(name, position, target));
    }
    return result;
}

void addCameras(Scene& scene) {
    // As [xie2017] Table 12, first row: floor, table, vase, teapot and lamp; second row: the vase.
    scene.cameras.push_back(
        camera("overview", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F));
    scene.cameras.push_back(camera("vase", {-0.05F, 1.05F, -0.55F}, {-0.95F, 0.66F, -1.5F}, 0.8F));
    // Standing people's ways over free floor. Keys were searched for views with the reflective and
    // planar shares of [xie2017] Tables 13 and 21: past the columns to the ball chair, and around
    // the vase.
    scene.paths.push_back(path("path_1", {{{-0.27F, 1.55F, -0.63F}, {1.18F, 1.24F, -0.87F}},
                                          {{0.07F, 1.57F, -0.78F}, {1.55F, 1.35F, -0.94F}},
                                          {{0.48F, 1.58F, -1.07F}, {1.92F, 1.18F, -1.02F}},
                                          {{0.74F, 1.57F, -0.83F}, {2.11F, 1.12F, -1.22F}},
                                          {{1.02F, 1.54F, -0.62F}, {2.36F, 1.00F, -1.02F}},
                                          {{1.25F, 1.53F, -0.39F}, {2.49F, 0.87F, -0.91F}},
                                          {{0.99F, 1.56F, 0.09F}, {1.99F, 0.88F, -0.80F}},
                                          {{0.96F, 1.60F, 0.51F}, {1.78F, 0.82F, -0.48F}},
                                          {{0.96F, 1.56F, 0.98F}, {1.62F, 0.81F, -0.14F}},
                                          {{1.31F, 1.60F, 1.16F}, {1.98F, 1.00F, -0.04F}},
                                          {{1.61F, 1.60F, 1.46F}, {1.79F, 0.84F, 0.18F}},
                                          {{2.15F, 1.60F, 1.51F}, {1.89F, 0.94F, 0.19F}},
                                          {{2.30F, 1.60F, 1.80F}, {1.91F, 0.96F, 0.50F}},
                                          {{2.58F, 1.55F, 1.95F}, {1.96F, 0.98F, 0.71F}}}));
    scene.paths.push_back(path("path_2", {{{0.46F, 1.33F, -2.00F}, {-0.96F, 0.95F, -1.69F}},
                                          {{0.10F, 1.38F, -1.57F}, {-1.33F, 0.93F, -1.60F}},
                                          {{0.17F, 1.35F, -1.24F}, {-1.16F, 0.74F, -1.58F}},
                                          {{-0.00F, 1.40F, -0.71F}, {-0.93F, 0.82F, -1.74F}},
                                          {{-0.37F, 1.45F, -0.59F}, {-1.11F, 0.80F, -1.72F}},
                                          {{-0.75F, 1.45F, -0.51F}, {-1.29F, 0.85F, -1.78F}},
                                          {{-1.08F, 1.41F, -0.59F}, {-0.88F, 0.73F, -1.91F}},
                                          {{-1.61F, 1.45F, -0.58F}, {-0.69F, 0.84F, -1.60F}},
                                          {{-1.83F, 1.48F, -0.79F}, {-0.72F, 0.78F, -1.51F}},
                                          {{-2.06F, 1.52F, -1.19F}, {-0.79F, 0.72F, -1.24F}},
                                          {{-1.93F, 1.47F, -1.76F}, {-0.71F, 0.77F, -1.24F}},
                                          {{-1.72F, 1.44F, -2.15F}, {-0.95F, 0.60F, -1.18F}},
                                          {{-1.45F, 1.42F, -2.34F}, {-0.70F, 0.72F, -1.25F}},
                                          {{-1.15F, 1.44F, -2.48F}, {-0.99F, 0.76F, -1.16F}}}));
    // From the overview 0.3 m to its left and back: frames that show the whole room.
    scene.paths.push_back(
        {"aside",
         {camera("aside", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F),
          camera("aside", {1.8575F, 1.60F, 1.73F}, {-0.8925F, 0.72F, -0.57F}, 1.0F),
          camera("aside", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F)}});
}

// --- the room ---

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

Scene livingRoom(Params& params, std::uint64_t seed) {
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
