#include <algorithm>
#include <cmath>

#include "scenes/indoor/living_room_parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::living_room {

namespace {

using namespace indoor;

constexpr float kPi = 3.14159265F;

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

}  // namespace

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

}  // namespace gfxrepro::scene::living_room
