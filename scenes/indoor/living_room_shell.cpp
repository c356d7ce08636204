#include <algorithm>

#include "scenes/indoor/living_room_parts.h"

namespace gfxrepro::scene::living_room {

namespace {

using namespace indoor;

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

}  // namespace

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
    constexpr float kPi = 3.14159265F;
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

}  // namespace gfxrepro::scene::living_room
