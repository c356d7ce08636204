#include <array>
#include <cmath>
#include <numbers>

#include "scenes/indoor/bathroom_parts.h"
#include "scenes/indoor/parts.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::bathroom_parts {

namespace {

using Station = MeshBuilder::Station;

constexpr float kCellM = 0.125F;  // of walls, so that their vertices can carry soft darkness

void addRod(MeshBuilder& builder, const glm::vec3& from, const glm::vec3& to, float radius,
            int sides) {
    const std::array stations{Station{from, radius}, Station{to, radius}};
    builder.addTube(stations, sides, true);
}

void addCorners(MeshBuilder& builder, const glm::vec3& min, const glm::vec3& max) {
    builder.addBox(0.5F * (min + max), 0.5F * (max - min));
}

/// The left, right and front wall between two heights.
void addThreeWalls(MeshBuilder& builder, float lowM, float highM, float tileM) {
    const glm::vec3 up(0.0F, highM - lowM, 0.0F);
    addGrid(builder, {0.0F, lowM, kRoom.z}, {0.0F, 0.0F, -kRoom.z}, up, kCellM, tileM);
    addGrid(builder, {kRoom.x, lowM, 0.0F}, {0.0F, 0.0F, kRoom.z}, up, kCellM, tileM);
    addGrid(builder, {kRoom.x, lowM, kRoom.z}, {-kRoom.x, 0.0F, 0.0F}, up, kCellM, tileM);
}

}  // namespace

void addTiledWalls(MeshBuilder& builder) {
    constexpr float kTileM = 0.63F;
    addThreeWalls(builder, 0.0F, kTilesM, kTileM);
    // The window wall beside the polished panel: behind the shower's wall.
    const float left = kRoom.x - kShowerRadiusM;
    addGrid(builder, {left, 0.0F, 0.0F}, {kShowerRadiusM, 0.0F, 0.0F}, {0.0F, kTilesM, 0.0F},
            kCellM, kTileM);
}

void addPaintedWalls(MeshBuilder& builder) {
    addThreeWalls(builder, kTilesM, kRoom.y, 1.0F);
    // Around the window.
    const auto wall = [&](float left, float low, float right, float high) {
        addGrid(builder, {left, low, 0.0F}, {right - left, 0.0F, 0.0F}, {0.0F, high - low, 0.0F},
                kCellM);
    };
    wall(0.0F, kWainscotM, kWindowMin.x, kRoom.y);
    wall(kWindowMin.x, kWainscotM, kWindowMax.x, kWindowMin.y);
    wall(kWindowMin.x, kWindowMax.y, kWindowMax.x, kRoom.y);
    wall(kWindowMax.x, kWainscotM, kRoom.x - kShowerRadiusM, kRoom.y);
    wall(kRoom.x - kShowerRadiusM, kTilesM, kRoom.x, kRoom.y);
    addGrid(builder, {0.0F, kRoom.y, 0.0F}, {kRoom.x, 0.0F, 0.0F}, {0.0F, 0.0F, kRoom.z}, 0.2F);
}

void addFloor(MeshBuilder& builder) {
    addGrid(builder, {0.0F, 0.0F, kRoom.z}, {kRoom.x, 0.0F, 0.0F}, {0.0F, 0.0F, -kRoom.z}, 0.1F,
            1.2F);
}

// A panelled door with its casing and handle, in the wall opposite the window.
void addDoor(MeshBuilder& builder) {
    constexpr float kLeft = 0.55F, kRight = 1.4F, kHigh = 2.05F, kCasing = 0.075F;
    const float z = kRoom.z;
    const auto board = [&](float x0, float y0, float x1, float y1, float out) {
        addCorners(builder, {x0, y0, z - out}, {x1, y1, z});
    };
    board(kLeft, 0.0F, kRight, kHigh, 0.02F);
    board(kLeft - kCasing, 0.0F, kLeft, kHigh + kCasing, 0.035F);
    board(kRight, 0.0F, kRight + kCasing, kHigh + kCasing, 0.035F);
    board(kLeft, kHigh, kRight, kHigh + kCasing, 0.035F);
    for (const float y : {0.16F, 1.1F}) {
        board(kLeft + 0.13F, y, kRight - 0.13F, y + 0.8F, 0.028F);
        board(kLeft + 0.17F, y + 0.04F, kRight - 0.17F, y + 0.76F, 0.034F);
    }
    const glm::vec3 handle(kLeft + 0.06F, 1.02F, z - 0.055F);
    addRod(builder, {handle.x, handle.y, z}, handle, 0.01F, 8);
    addRod(builder, handle, handle + glm::vec3(0.11F, 0.0F, 0.0F), 0.009F, 8);
}

// Two casements in a deep reveal, with a sill; the panes show what is outside.
void addWindow(MeshBuilder& builder, MeshBuilder& view) {
    constexpr float kDepth = 0.16F, kFrame = 0.05F;
    const glm::vec2 lo = kWindowMin, hi = kWindowMax, size = hi - lo;
    const glm::vec3 in(0.0F, 0.0F, kDepth);
    addGrid(builder, {lo.x, lo.y, 0.0F}, {0.0F, 0.0F, -kDepth}, {0.0F, size.y, 0.0F}, 0.2F);
    addGrid(builder, {hi.x, lo.y, -kDepth}, in, {0.0F, size.y, 0.0F}, 0.2F);
    addGrid(builder, {lo.x, hi.y, -kDepth}, {size.x, 0.0F, 0.0F}, in, 0.2F);
    addCorners(builder, {lo.x - 0.03F, lo.y - 0.03F, -kDepth}, {hi.x + 0.03F, lo.y, 0.035F});
    const float middle = 0.5F * (lo.x + hi.x);
    for (const auto& [left, right] : {std::pair(lo.x, middle), std::pair(middle, hi.x)}) {
        const auto bar = [&](float x0, float y0, float x1, float y1, float out) {
            addCorners(builder, {x0, y0, -kDepth}, {x1, y1, -kDepth + out});
        };
        bar(left, lo.y, left + kFrame, hi.y, 0.05F);
        bar(right - kFrame, lo.y, right, hi.y, 0.05F);
        bar(left + kFrame, lo.y, right - kFrame, lo.y + kFrame, 0.05F);
        bar(left + kFrame, hi.y - kFrame, right - kFrame, hi.y, 0.05F);
        const float crossing = lo.y + 0.64F * size.y;
        bar(left + kFrame, crossing - 0.014F, right - kFrame, crossing + 0.014F, 0.035F);
    }
    addRod(builder, {middle + 0.025F, lo.y + 0.42F, -kDepth + 0.07F},
           {middle + 0.025F, lo.y + 0.54F, -kDepth + 0.07F}, 0.009F, 12);
    indoor::addRectangle(view, {middle, 0.5F * (lo.y + hi.y), -kDepth + 0.012F},
                         {0.5F * size.x, 0.0F, 0.0F}, {0.0F, 0.5F * size.y, 0.0F});
}

void addWoodwork(MeshBuilder& builder) {
    // The counter: the vanity's oval, a little larger.
    const auto counter = [](float u, float v) {
        constexpr glm::vec2 kEdge[] = {{0.06F, 0.0F},   {0.008F, 0.0F},   {0.0F, 0.006F},
                                       {0.0F, 0.029F},  {0.008F, 0.035F}, {0.06F, 0.035F},
                                       {0.30F, 0.035F}, {0.54F, 0.035F}};
        const glm::vec2 point = kEdge[static_cast<std::size_t>(v * 7.0F + 0.5F)];
        const glm::vec2 axes = glm::max(
            glm::vec2(kVanityDepthM + 0.02F, kVanityHalfM + 0.02F) - point.x, glm::vec2(0.0F));
        const glm::vec2 xz = ovalAt(0.5F * u - 0.25F, axes, 0.55F);
        return glm::vec3(std::max(xz.x, 0.0F), kCounterM - 0.035F + point.y, kVanityZ + xz.y);
    };
    addLoft(builder, counter, {40, 7, false, glm::vec2(1.6F), true});
    for (const float top : kShelvesM) {
        indoor::addPanel(builder, {kRoom.x - 0.26F, top - 0.028F, 2.35F}, {kRoom.x, top, 3.3F},
                         0.6F);
    }
    // The mirror's frame, with the glass a little in it.
    constexpr float kLow = 1.17F, kHigh = 2.07F, kHalf = 0.5F, kBar = 0.03F, kOut = 0.03F;
    const float z0 = kVanityZ - kHalf, z1 = kVanityZ + kHalf;
    indoor::addPanel(builder, {0.0F, kLow - kBar, z0 - kBar}, {kOut, kLow, z1 + kBar}, 0.6F);
    indoor::addPanel(builder, {0.0F, kHigh, z0 - kBar}, {kOut, kHigh + kBar, z1 + kBar}, 0.6F);
    indoor::addPanel(builder, {0.0F, kLow, z0 - kBar}, {kOut, kHigh, z0}, 0.6F);
    indoor::addPanel(builder, {0.0F, kLow, z1}, {kOut, kHigh, z1 + kBar}, 0.6F);
    // A round stool on three splayed legs.
    constexpr glm::vec2 kSeat[] = {{0.0F, -0.032F},   {0.15F, -0.032F},  {0.163F, -0.024F},
                                   {0.166F, -0.014F}, {0.163F, -0.005F}, {0.152F, 0.0F},
                                   {0.0F, 0.0F}};
    indoor::addLathe(builder, indoor::smoothed(kSeat, 16), 28,
                     indoor::placed(kStool + glm::vec3(0.0F, kStoolM, 0.0F)), 2.0F);
    for (int i = 0; i < 3; ++i) {
        const glm::vec2 out = ovalAt(static_cast<float>(i) / 3.0F + 0.1F, glm::vec2(1.0F), 0.0F);
        const std::array leg{
            Station{kStool + glm::vec3(0.165F * out.x, 0.003F, 0.165F * out.y), 0.011F},
            Station{kStool + glm::vec3(0.11F * out.x, kStoolM - 0.03F, 0.11F * out.y), 0.016F}};
        builder.addTube(leg, 14, true);
    }
    // The wall cabinet over the cistern; its door is a mirror.
    indoor::addPanel(builder, {kRoom.x - 0.15F, 1.34F, kToiletZ - 0.3F},
                     {kRoom.x, 2.0F, kToiletZ + 0.3F}, 0.6F);
    // The ledge on the polished panel.
    indoor::addPanel(builder, {0.0F, kWainscotM - 0.006F, 0.0F},
                     {kRoom.x - kShowerRadiusM, kWainscotM + 0.022F, 0.03F}, 0.6F);
}

void addIronware(MeshBuilder& builder) {
    // The rain shower: arm from the wall, its head over the tiled quarter.
    const glm::vec3 head(kRoom.x - 0.5F, 2.2F, 0.45F);
    const std::array arm{
        Station{{kRoom.x, 2.28F, head.z}, 0.012F}, Station{{head.x + 0.08F, 2.28F, head.z}, 0.012F},
        Station{{head.x, 2.26F, head.z}, 0.012F}, Station{{head.x, 2.2F, head.z}, 0.014F}};
    indoor::addBentTube(builder, arm, 12, 10);
    constexpr glm::vec2 kHead[] = {{0.0F, 0.0F},     {0.13F, 0.0F},   {0.14F, 0.004F},
                                   {0.14F, 0.012F},  {0.12F, 0.017F}, {0.03F, 0.024F},
                                   {0.018F, 0.036F}, {0.014F, 0.05F}};
    indoor::addLathe(builder, indoor::smoothed(kHead, 14), 30,
                     indoor::placed(head - glm::vec3(0.0F, 0.04F, 0.0F)));
    // Flush button on the cistern.
    constexpr glm::vec2 kButton[] = {
        {0.025F, 0.0F}, {0.025F, 0.008F}, {0.022F, 0.011F}, {0.0F, 0.012F}};
    indoor::addLathe(builder, kButton, 28, indoor::placed({kRoom.x - 0.09F, 0.800F, kToiletZ}));
    // Paper holder on the right wall, with an arm through the roll.
    const glm::vec3 paper(kRoom.x - 0.075F, 0.74F, kToiletZ + 0.42F);
    addRod(builder, {kRoom.x, paper.y, paper.z - 0.065F}, {paper.x, paper.y, paper.z - 0.065F},
           0.008F, 12);
    addRod(builder, paper - glm::vec3(0.0F, 0.0F, 0.072F), paper + glm::vec3(0.0F, 0.0F, 0.065F),
           0.008F, 12);
    for (const float top : kShelvesM) {
        for (const float z : {2.5F, 3.15F}) {
            addCorners(builder, {kRoom.x - 0.24F, top - 0.04F, z - 0.01F},
                       {kRoom.x - 0.004F, top - 0.028F, z + 0.01F});
            addCorners(builder, {kRoom.x - 0.012F, top - 0.15F, z - 0.01F},
                       {kRoom.x, top - 0.04F, z + 0.01F});
        }
    }
    // The pendant's rose on the ceiling.
    constexpr glm::vec2 kRose[] = {
        {0.0F, -0.03F}, {0.1F, -0.024F}, {0.125F, -0.008F}, {0.125F, 0.0F}};
    indoor::addLathe(builder, indoor::smoothed(kRose, 6), 28,
                     indoor::placed({kPendant.x, kRoom.y, kPendant.z}));
    // Holders of the wall lamps.
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 at(0.0F, 1.62F, kVanityZ + side * 0.68F);
        constexpr glm::vec2 kPlate[] = {
            {0.05F, 0.0F}, {0.05F, 0.012F}, {0.04F, 0.018F}, {0.0F, 0.018F}};
        indoor::addLathe(builder, kPlate, 28, indoor::placedAlong(at, {1.0F, 0.0F, 0.0F}));
        const std::array stem{Station{at, 0.009F},
                              Station{at + glm::vec3(0.07F, 0.0F, 0.0F), 0.009F},
                              Station{at + glm::vec3(0.1F, 0.03F, 0.0F), 0.009F},
                              Station{at + glm::vec3(0.1F, 0.075F, 0.0F), 0.02F}};
        indoor::addBentTube(builder, stem, 9, 8);
    }
}

void addWallLamps(MeshBuilder& globes) {
    constexpr glm::vec2 kGlobe[] = {
        {0.02F, -0.062F}, {0.046F, -0.046F}, {0.065F, 0.0F}, {0.046F, 0.046F}, {0.0F, 0.065F}};
    for (const float side : {-1.0F, 1.0F}) {
        indoor::addLathe(globes, indoor::smoothed(kGlobe, 12), 20,
                         indoor::placed({0.1F, 1.755F, kVanityZ + side * 0.68F}));
    }
}

void addBulb(MeshBuilder& builder) {
    constexpr glm::vec2 kBulb[] = {{0.0F, 0.02F},   {0.03F, 0.03F},   {0.042F, 0.062F},
                                   {0.03F, 0.095F}, {0.016F, 0.125F}, {0.016F, 0.165F}};
    indoor::addLathe(builder, indoor::smoothed(kBulb, 12), 16, indoor::placed(kPendant));
}

void addBottles(MeshBuilder& builder, Random& random) {
    constexpr glm::vec2 kTall[] = {{0.0F, 0.0F},    {0.85F, 0.0F},  {1.0F, 0.02F},  {1.0F, 0.70F},
                                   {0.95F, 0.76F},  {0.45F, 0.80F}, {0.42F, 0.81F}, {0.42F, 0.81F},
                                   {0.48F, 0.812F}, {0.48F, 0.98F}, {0.4F, 1.0F},   {0.0F, 1.0F}};
    constexpr glm::vec2 kRound[] = {{0.0F, 0.0F},   {0.6F, 0.0F},   {0.85F, 0.05F}, {1.0F, 0.3F},
                                    {0.9F, 0.52F},  {0.45F, 0.66F}, {0.3F, 0.72F},  {0.28F, 0.82F},
                                    {0.42F, 0.84F}, {0.42F, 0.98F}, {0.0F, 1.0F}};
    constexpr glm::vec2 kJar[] = {{0.0F, 0.0F},  {0.9F, 0.0F},   {1.0F, 0.05F},  {1.0F, 0.66F},
                                  {0.96F, 0.7F}, {0.96F, 0.72F}, {1.04F, 0.74F}, {1.04F, 0.96F},
                                  {0.95F, 1.0F}, {0.0F, 1.0F}};
    constexpr glm::vec3 kColors[] = {{0.42F, 0.16F, 0.05F}, {0.75F, 0.72F, 0.62F},
                                     {0.10F, 0.27F, 0.25F}, {0.70F, 0.42F, 0.30F},
                                     {0.20F, 0.28F, 0.16F}, {0.85F, 0.83F, 0.78F}};
    struct Bottle {
        std::span<const glm::vec2> outline;
        glm::vec3 foot;
        float radius, height;
    };
    const float top = kShelvesM[0], shelfX = kRoom.x - 0.13F;
    const Bottle bottles[] = {{kTall, {0.16F, kCounterM, kVanityZ - 0.42F}, 0.030F, 0.19F},
                              {kJar, {0.20F, kCounterM, kVanityZ - 0.50F}, 0.034F, 0.07F},
                              {kRound, {0.12F, kCounterM, kVanityZ + 0.36F}, 0.038F, 0.14F},
                              {kTall, {shelfX, top, 2.42F}, 0.034F, 0.22F},
                              {kTall, {shelfX - 0.03F, top, 2.51F}, 0.028F, 0.17F},
                              {kJar, {shelfX + 0.02F, top, 2.60F}, 0.042F, 0.10F},
                              {kRound, {shelfX, top, 2.70F}, 0.045F, 0.17F},
                              {kJar, {shelfX, kShelvesM[1], 3.20F}, 0.05F, 0.12F},
                              {kTall, {1.62F, kWindowMin.y, -0.04F}, 0.03F, 0.2F},
                              {kRound, {1.53F, kWindowMin.y, -0.05F}, 0.036F, 0.13F},
                              {kJar, {kRoom.x - 0.09F, 0.804F, kToiletZ - 0.12F}, 0.036F, 0.08F}};
    for (const Bottle& bottle : bottles) {
        builder.setColor(kColors[random.index(6)]);
        indoor::Outline outline = indoor::smoothed(bottle.outline, 15);
        for (glm::vec2& point : outline) point *= glm::vec2(bottle.radius, bottle.height);
        indoor::addLathe(builder, outline, 16, indoor::placed(bottle.foot));
    }
}

// Canes woven around uprights, a rim, and a lining behind them.
void addBasket(MeshBuilder& builder) {
    constexpr int kUprights = 18, kCanes = 13, kStations = 3 * kUprights;
    constexpr float kHeight = 0.46F, kRadius = 0.20F, kTwoPi = 2.0F * std::numbers::pi_v<float>;
    const auto radiusAt = [](float y) { return kRadius * (0.86F + 0.14F * y / kHeight); };
    for (int i = 0; i < kCanes; ++i) {
        const float y = 0.016F + (kHeight - 0.03F) * static_cast<float>(i) / (kCanes - 1);
        std::vector<Station> cane;
        for (int k = 0; k <= kStations; ++k) {
            const float turn = static_cast<float>(k % kStations) / kStations;
            const float wave =
                sdf::cosine(kTwoPi * 0.5F * kUprights * turn) * (i % 2 == 0 ? 1.0F : -1.0F);
            const glm::vec2 xz = ovalAt(turn, glm::vec2(radiusAt(y) + 0.0085F * wave), 0.0F);
            cane.push_back({kBasket + glm::vec3(xz.x, y, xz.y), 0.0165F});
        }
        builder.addTube(cane, 4, false);
    }
    for (int i = 0; i < kUprights; ++i) {
        const glm::vec2 out = ovalAt(static_cast<float>(i) / kUprights, glm::vec2(1.0F), 0.0F);
        const float low = radiusAt(0.0F), high = radiusAt(kHeight);
        addRod(builder, kBasket + glm::vec3(low * out.x, 0.002F, low * out.y),
               kBasket + glm::vec3(high * out.x, kHeight, high * out.y), 0.006F, 5);
    }
    const float rim = radiusAt(kHeight);
    const glm::vec2 outline[] = {{rim - 0.018F, kHeight},          {rim - 0.01F, kHeight - 0.012F},
                                 {rim + 0.014F, kHeight - 0.012F}, {rim + 0.022F, kHeight},
                                 {rim + 0.014F, kHeight + 0.014F}, {rim - 0.01F, kHeight + 0.014F},
                                 {rim - 0.018F, kHeight},          {rim - 0.02F, 0.3F}};
    indoor::addLathe(builder, indoor::smoothed(outline, 11), 30, indoor::placed(kBasket));
}

}  // namespace gfxrepro::scene::bathroom_parts
