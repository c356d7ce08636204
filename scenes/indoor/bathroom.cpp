// The bathroom. Everything is built where it stands: x to the right, z from the window wall into
// the room, the floor at y = 0, in metres.
//
// Longer than other files: the data of one scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/random.h"
#include "scenes/indoor/parts.h"
#include "scenes/indoor/rooms.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

namespace {

using namespace indoor;
using Station = MeshBuilder::Station;

// --- where things stand ---

constexpr glm::vec3 kRoom(3.4F, 2.6F, 4.0F);
constexpr glm::vec3 kTubCentre(1.15F, 0.0F, 0.75F);
constexpr glm::vec2 kTubHalf(0.84F, 0.42F);
constexpr float kTubRimM = 0.59F;
/// The vanity hangs on the wall x = 0.
constexpr float kVanityZ = 2.4F, kVanityHalfM = 0.62F, kVanityDepthM = 0.52F;
constexpr float kVanityBottomM = 0.28F, kCounterM = 0.82F;
constexpr glm::vec3 kBasinCentre(0.27F, kCounterM, kVanityZ);
/// Against the wall x = kRoom.x.
constexpr float kToiletZ = 1.85F;
/// A quarter of a round tiled wall around the corner (kRoom.x, 0), open at its right end.
constexpr float kShowerRadiusM = 1.1F, kShowerWallM = 0.1F, kShowerHeightM = 2.06F;
constexpr float kTowelRailZ = 1.42F;
constexpr glm::vec3 kShavingMirror(0.3F, kCounterM, kVanityZ + 0.44F);  // its foot
constexpr glm::vec3 kDispenser(0.33F, kCounterM, kVanityZ - 0.36F);     // its foot
constexpr glm::vec3 kPendant(1.75F, 1.9F, 2.15F);                       // the rim's centre
/// A window in the wall z = 0.
constexpr glm::vec2 kWindowMin(0.55F, 1.2F), kWindowMax(1.75F, 2.2F);
constexpr float kWainscotM = 0.9F;  // height of the polished panel behind the tub
constexpr float kTilesM = 1.26F;    // height of the tiles on the other walls
constexpr glm::vec3 kBasket(3.08F, 0.0F, 2.78F);
constexpr glm::vec3 kStool(2.42F, 0.0F, 1.5F);
constexpr float kStoolM = 0.46F;
constexpr float kShelvesM[] = {1.22F, 1.58F};  // tops, on the wall x = kRoom.x

void addRod(MeshBuilder& builder, const glm::vec3& from, const glm::vec3& to, float radius,
            int sides) {
    const std::array stations{Station{from, radius}, Station{to, radius}};
    builder.addTube(stations, sides, true);
}

// --- glazed: tub, basin, vanity, toilet, shower wall ---

/// The point of a finely divided outline at v.
glm::vec2 outlineAt(const Outline& outline, float v) {
    const auto last = static_cast<float>(outline.size() - 1);
    return outline[static_cast<std::size_t>(v * last + 0.5F)];
}

/// An oval body from its outline of (inset from the half axes, height).
void addOvalBody(MeshBuilder& builder, const glm::vec3& centre, const glm::vec2& halfAxes,
                 float squareness, const Outline& outline, int sides) {
    const auto at = [&](float u, float v) {
        const glm::vec2 point = outlineAt(outline, v);
        const glm::vec2 axes = glm::max(halfAxes - point.x, glm::vec2(0.0F));
        const glm::vec2 xz = ovalAt(u, axes, squareness);
        return centre + glm::vec3(xz.x, point.y, xz.y);
    };
    addLoft(builder, at, {sides, static_cast<int>(outline.size()) - 1, true, glm::vec2(1.0F)});
}

/// Pieces of an outline one after the other, each with its own fineness.
Outline joined(std::initializer_list<std::pair<std::span<const glm::vec2>, int>> parts) {
    Outline all;
    for (const auto& [points, pieces] : parts) {
        const Outline part = smoothed(points, pieces);
        all.insert(all.end(), part.begin() + (all.empty() ? 0 : 1), part.end());
    }
    return all;
}

// The rim belongs to the outside; the inside begins where it has turned down.
void addTubOutside(MeshBuilder& builder) {
    constexpr glm::vec2 kWall[] = {{0.150F, 0.000F}, {0.148F, 0.012F}, {0.135F, 0.03F},
                                   {0.100F, 0.130F}, {0.062F, 0.300F}, {0.034F, 0.450F},
                                   {0.014F, 0.540F}};
    constexpr glm::vec2 kRim[] = {{0.014F, 0.540F}, {0.004F, 0.556F},   {0.000F, 0.570F},
                                  {0.006F, 0.584F}, {0.020F, kTubRimM}, {0.034F, 0.585F},
                                  {0.044F, 0.572F}, {0.052F, 0.548F}};
    addOvalBody(builder, kTubCentre, kTubHalf, 0.25F, joined({{kWall, 14}, {kRim, 20}}), 100);
}

void addTubInside(MeshBuilder& builder) {
    constexpr glm::vec2 kOutline[] = {{0.052F, 0.548F}, {0.062F, 0.500F},    {0.080F, 0.420F},
                                      {0.110F, 0.300F}, {0.150F, 0.205F},    {0.210F, 0.150F},
                                      {0.300F, 0.130F}, {kTubHalf.y, 0.124F}};
    addOvalBody(builder, kTubCentre, kTubHalf, 0.25F, smoothed(kOutline, 36), 100);
}

void addBasin(MeshBuilder& builder) {
    constexpr glm::vec2 kHalf(0.185F, 0.25F);
    constexpr glm::vec2 kOutline[] = {
        {0.085F, 0.000F}, {0.080F, 0.006F}, {0.050F, 0.040F}, {0.020F, 0.090F}, {0.003F, 0.132F},
        {0.000F, 0.142F}, {0.004F, 0.149F}, {0.010F, 0.149F}, {0.015F, 0.142F}, {0.024F, 0.118F},
        {0.048F, 0.070F}, {0.090F, 0.036F}, {0.140F, 0.026F}, {kHalf.x, 0.025F}};
    addOvalBody(builder, kBasinCentre, kHalf, 0.15F, smoothed(kOutline, 38), 48);
}

// A bow front of two lacquered drawers: half an oval in plan, with a shadow gap between them.
void addVanity(MeshBuilder& builder) {
    constexpr float kTop = kCounterM - 0.035F, kMiddle = 0.5F * (kVanityBottomM + kTop);
    constexpr glm::vec2 kOutline[] = {{kVanityDepthM, kVanityBottomM},
                                      {0.030F, kVanityBottomM},
                                      {0.012F, kVanityBottomM + 0.004F},
                                      {0.004F, kVanityBottomM + 0.014F},
                                      {0.000F, kVanityBottomM + 0.030F},
                                      {0.000F, kMiddle - 0.012F},
                                      {0.003F, kMiddle - 0.005F},
                                      {0.012F, kMiddle - 0.003F},
                                      {0.012F, kMiddle + 0.003F},
                                      {0.003F, kMiddle + 0.005F},
                                      {0.000F, kMiddle + 0.012F},
                                      {0.000F, kTop - 0.024F},
                                      {0.004F, kTop - 0.010F},
                                      {0.012F, kTop},
                                      {0.040F, kTop}};
    const auto at = [&](float u, float v) {
        const glm::vec2 point = kOutline[static_cast<std::size_t>(v * 14.0F + 0.5F)];
        const glm::vec2 axes =
            glm::max(glm::vec2(kVanityDepthM, kVanityHalfM) - point.x, glm::vec2(0.0F));
        // From −90° to 90° seen from above: from the wall at +z around the front to −z.
        const glm::vec2 xz = ovalAt(0.5F * u - 0.25F, axes, 0.55F);
        return glm::vec3(std::max(xz.x, 0.0F), point.y, kVanityZ + xz.y);
    };
    addLoft(builder, at, {56, 14, false, glm::vec2(1.0F)});
}

// Bowl on its foot, seat and lid, and the cistern behind them.
void addToilet(MeshBuilder& builder) {
    struct Section {
        float y, back, front, half;  // distances from the wall, half width
    };
    constexpr Section kSections[] = {
        {0.000F, 0.05F, 0.50F, 0.120F},   {0.012F, 0.045F, 0.51F, 0.125F},
        {0.100F, 0.05F, 0.51F, 0.122F},   {0.220F, 0.05F, 0.56F, 0.140F},
        {0.310F, 0.05F, 0.625F, 0.168F},  {0.360F, 0.05F, 0.645F, 0.178F},
        {0.388F, 0.05F, 0.650F, 0.180F},  {0.396F, 0.055F, 0.645F, 0.176F},
        {0.400F, 0.06F, 0.638F, 0.170F},  {0.404F, 0.06F, 0.645F, 0.176F},
        {0.412F, 0.055F, 0.660F, 0.186F}, {0.432F, 0.055F, 0.660F, 0.186F},
        {0.440F, 0.06F, 0.652F, 0.180F},  {0.446F, 0.10F, 0.600F, 0.140F},
        {0.450F, 0.36F, 0.36F, 0.0F}};
    constexpr int kLast = static_cast<int>(std::size(kSections)) - 1;
    constexpr int kSteps = 3;
    const auto at = [&](float u, float v) {
        const float place = v * static_cast<float>(kLast);
        const int i = std::min(static_cast<int>(place), kLast - 1);
        const float t = place - static_cast<float>(i);
        const Section &a = kSections[i], &b = kSections[i + 1];
        const float back = glm::mix(a.back, b.back, t), front = glm::mix(a.front, b.front, t);
        glm::vec2 xz = ovalAt(u, {0.5F * (front - back), glm::mix(a.half, b.half, t)}, 0.45F);
        // Narrower towards the front, as bowls are.
        if (front > back) xz.y *= 1.0F - 0.14F * (xz.x / (0.5F * (front - back)));
        return glm::vec3(kRoom.x - (0.5F * (front + back) + xz.x), glm::mix(a.y, b.y, t),
                         kToiletZ - xz.y);
    };
    addLoft(builder, at, {52, kLast * kSteps, true, glm::vec2(1.0F)});

    constexpr float kDepth = 0.17F, kHalf = 0.19F, kLow = 0.40F, kHigh = 0.80F;
    // Its lid stands out a little.
    constexpr glm::vec2 kCistern[] = {{0.085F, kLow},           {0.014F, kLow},
                                      {0.006F, kLow + 0.012F},  {0.004F, kLow + 0.04F},
                                      {0.004F, kHigh - 0.060F}, {0.003F, kHigh - 0.045F},
                                      {0.000F, kHigh - 0.035F}, {0.000F, kHigh - 0.014F},
                                      {0.006F, kHigh},          {0.085F, kHigh + 0.004F}};
    const Outline outline = smoothed(kCistern, 24);
    const glm::vec3 centre(kRoom.x - 0.5F * kDepth - 0.005F, 0.0F, kToiletZ);
    addOvalBody(builder, centre, {0.5F * kDepth, kHalf}, 0.85F, outline, 40);
}

void addShowerWall(MeshBuilder& builder) {
    constexpr float kArcRad = 1.26F;  // the rest of the quarter is the way in
    constexpr float kInnerM = kShowerRadiusM - kShowerWallM, kHalfM = 0.5F * kShowerWallM;
    constexpr float kTileM = 0.4F;
    constexpr glm::vec2 kCorner(kRoom.x, 0.0F);
    const auto onArc = [&](float angleRad, float radius) {
        return kCorner + radius * glm::vec2(-sdf::cosine(angleRad), sdf::sine(angleRad));
    };
    constexpr float kOutside = kArcRad * kShowerRadiusM, kInside = kArcRad * kInnerM;
    constexpr float kEnd = std::numbers::pi_v<float> * kHalfM;
    constexpr float kLength = kOutside + kEnd + kInside;
    // In plan: along the outside, around the free end, back along the inside.
    const auto plan = [&](float u) {
        const float way = u * kLength;
        if (way <= kOutside) return onArc(way / kShowerRadiusM, kShowerRadiusM);
        if (way >= kOutside + kEnd) return onArc((kLength - way) / kInnerM, kInnerM);
        const float turnRad = (way - kOutside) / kHalfM;
        const glm::vec2 out(-sdf::cosine(kArcRad), sdf::sine(kArcRad));
        const glm::vec2 along(sdf::sine(kArcRad), sdf::cosine(kArcRad));
        return onArc(kArcRad, kInnerM + kHalfM) +
               kHalfM * (out * sdf::cosine(turnRad) + along * sdf::sine(turnRad));
    };
    const auto wall = [&](float u, float v) {
        const glm::vec2 xz = plan(u);
        return glm::vec3(xz.x, v * kShowerHeightM, xz.y);
    };
    addLoft(builder, wall, {72, 12, false, {kLength / kTileM, kShowerHeightM / kTileM}});
    // The top, from the outside to the inside; its end is the half circle of the free end.
    const auto top = [&](float u, float v) {
        const float reach = kOutside + 0.5F * kEnd;
        const glm::vec2 outer = plan(u * reach / kLength);
        const glm::vec2 inner = plan((kLength - u * (kInside + 0.5F * kEnd)) / kLength);
        const glm::vec2 xz = glm::mix(outer, inner, v);
        return glm::vec3(xz.x, kShowerHeightM, xz.y);
    };
    addLoft(builder, top, {36, 1, false, {kOutside / kTileM, kShowerWallM / kTileM}});
}

// --- polished metal: taps, towel rail, shaving mirror, dispenser, pendant ---

/// Turned about the vertical through `foot`; heights count from it.
void addStanding(MeshBuilder& builder, std::span<const glm::vec2> outline, int pieces, int sides,
                 const glm::vec3& foot) {
    addLathe(builder, smoothed(outline, pieces), sides, placed(foot));
}

// A tall mixer behind the bowl, its spout reaching over it.
void addBasinTap(MeshBuilder& builder) {
    const glm::vec3 foot(0.058F, kCounterM, kVanityZ);
    constexpr glm::vec2 kBody[] = {{0.000F, 0.000F},  {0.029F, 0.000F}, {0.029F, 0.000F},
                                   {0.029F, 0.010F},  {0.029F, 0.010F}, {0.0215F, 0.012F},
                                   {0.0215F, 0.012F}, {0.0215F, 0.22F}, {0.024F, 0.235F},
                                   {0.024F, 0.262F},  {0.020F, 0.272F}, {0.000F, 0.274F}};
    addStanding(builder, kBody, 30, 28, foot);
    const std::array spout{Station{foot + glm::vec3(0.005F, 0.205F, 0.0F), 0.0145F},
                           Station{foot + glm::vec3(0.05F, 0.232F, 0.0F), 0.0145F},
                           Station{foot + glm::vec3(0.12F, 0.242F, 0.0F), 0.014F},
                           Station{foot + glm::vec3(0.155F, 0.232F, 0.0F), 0.013F},
                           Station{foot + glm::vec3(0.165F, 0.205F, 0.0F), 0.013F}};
    addBentTube(builder, spout, 26, 20);
    const std::array lever{Station{foot + glm::vec3(0.0F, 0.270F, 0.0F), 0.008F},
                           Station{foot + glm::vec3(0.03F, 0.288F, 0.0F), 0.0065F},
                           Station{foot + glm::vec3(0.085F, 0.312F, 0.0F), 0.0075F}};
    addBentTube(builder, lever, 12, 14);
}

// A pillar between wall and tub with its spout over the rim, two handles and a hand shower.
void addTubTap(MeshBuilder& builder) {
    const glm::vec3 foot(kTubCentre.x - 0.15F, 0.0F, 0.17F);
    constexpr glm::vec2 kFlange[] = {{0.000F, 0.000F}, {0.045F, 0.000F}, {0.045F, 0.000F},
                                     {0.044F, 0.010F}, {0.030F, 0.018F}, {0.022F, 0.024F}};
    addStanding(builder, kFlange, 10, 28, foot);
    const std::array pillar{Station{foot + glm::vec3(0.0F, 0.01F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.55F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.86F, 0.0F), 0.020F},
                            Station{foot + glm::vec3(0.0F, 0.95F, 0.035F), 0.019F},
                            Station{foot + glm::vec3(0.0F, 0.985F, 0.12F), 0.018F},
                            Station{foot + glm::vec3(0.0F, 0.96F, 0.22F), 0.018F},
                            Station{foot + glm::vec3(0.0F, 0.89F, 0.26F), 0.017F},
                            Station{foot + glm::vec3(0.0F, 0.85F, 0.262F), 0.017F}};
    addBentTube(builder, pillar, 44, 18);
    addRod(builder, foot + glm::vec3(-0.11F, 0.74F, 0.0F), foot + glm::vec3(0.11F, 0.74F, 0.0F),
           0.017F, 20);
    for (const float side : {-1.0F, 1.0F}) {
        constexpr glm::vec2 kKnob[] = {{0.000F, 0.000F}, {0.026F, 0.002F}, {0.030F, 0.010F},
                                       {0.030F, 0.034F}, {0.026F, 0.042F}, {0.000F, 0.044F}};
        const glm::mat4 outwards =
            placedAlong(foot + glm::vec3(side * 0.105F, 0.74F, 0.0F), glm::vec3(side, 0.0F, 0.0F));
        addLathe(builder, smoothed(kKnob, 14), 26, outwards);
    }
    // The hand shower stands in its cradle on the pillar, its hose hangs in a loop.
    const std::array grip{Station{foot + glm::vec3(0.055F, 0.70F, 0.028F), 0.010F},
                          Station{foot + glm::vec3(0.055F, 0.80F, 0.030F), 0.011F},
                          Station{foot + glm::vec3(0.055F, 0.885F, 0.034F), 0.011F},
                          Station{foot + glm::vec3(0.055F, 0.92F, 0.050F), 0.018F},
                          Station{foot + glm::vec3(0.055F, 0.925F, 0.075F), 0.026F}};
    addBentTube(builder, grip, 18, 16);
    const std::array hose{Station{foot + glm::vec3(0.055F, 0.70F, 0.028F), 0.006F},
                          Station{foot + glm::vec3(0.058F, 0.50F, 0.025F), 0.006F},
                          Station{foot + glm::vec3(0.085F, 0.36F, 0.010F), 0.006F},
                          Station{foot + glm::vec3(0.120F, 0.42F, 0.000F), 0.006F},
                          Station{foot + glm::vec3(0.085F, 0.62F, 0.000F), 0.006F},
                          Station{foot + glm::vec3(0.045F, 0.735F, 0.000F), 0.006F}};
    addBentTube(builder, hose, 34, 7);
    const std::array cradle{Station{foot + glm::vec3(0.0F, 0.80F, 0.0F), 0.007F},
                            Station{foot + glm::vec3(0.055F, 0.80F, 0.018F), 0.007F}};
    builder.addTube(cradle, 10, true);
}

// A ladder on the wall x = 0: rungs in groups, gaps between them for towels.
void addTowelRail(MeshBuilder& builder) {
    constexpr float kX = 0.085F, kLow = 0.35F, kHigh = 1.55F, kHalf = 0.23F;
    for (const float side : {-1.0F, 1.0F}) {
        const float z = kTowelRailZ + side * kHalf;
        const std::array post{
            Station{{kX, kLow, z}, 0.004F}, Station{{kX, kLow + 0.01F, z}, 0.018F},
            Station{{kX, 0.9F, z}, 0.018F}, Station{{kX, kHigh - 0.01F, z}, 0.018F},
            Station{{kX, kHigh, z}, 0.004F}};
        builder.addTube(post, 18, true);
        for (const float y : {kLow + 0.12F, kHigh - 0.12F}) {
            addRod(builder, {0.0F, y, z}, {kX, y, z}, 0.011F, 14);
        }
    }
    constexpr float kRungs[] = {0.42F, 0.48F, 0.54F, 0.60F, 0.74F, 0.80F, 0.86F,
                                0.92F, 1.06F, 1.12F, 1.18F, 1.36F, 1.42F, 1.48F};
    for (const float y : kRungs) {
        addRod(builder, {kX + 0.012F, y, kTowelRailZ - kHalf},
               {kX + 0.012F, y, kTowelRailZ + kHalf}, 0.0105F, 16);
    }
}

// A dish on a stand; concave, so that it magnifies.
void addShavingMirror(MeshBuilder& builder) {
    constexpr glm::vec2 kFoot[] = {
        {0.000F, 0.000F}, {0.062F, 0.000F}, {0.062F, 0.000F}, {0.062F, 0.006F}, {0.052F, 0.012F},
        {0.012F, 0.020F}, {0.0055F, 0.04F}, {0.0055F, 0.16F}, {0.008F, 0.17F},  {0.000F, 0.174F}};
    addStanding(builder, kFoot, 20, 20, kShavingMirror);
    constexpr glm::vec2 kDish[] = {{0.000F, -0.016F}, {0.040F, -0.014F}, {0.085F, -0.004F},
                                   {0.106F, 0.006F},  {0.112F, 0.014F},  {0.110F, 0.020F},
                                   {0.104F, 0.020F},  {0.100F, 0.014F},  {0.080F, 0.0058F},
                                   {0.050F, -0.002F}, {0.025F, -0.005F}, {0.000F, -0.006F}};
    const glm::mat4 facing = placedAlong(kShavingMirror + glm::vec3(0.014F, 0.285F, -0.01F),
                                         glm::vec3(1.0F, 0.12F, -0.75F));
    addLathe(builder, smoothed(kDish, 26), 36, facing);
    const std::array neck{Station{kShavingMirror + glm::vec3(0.0F, 0.165F, 0.0F), 0.0055F},
                          Station{kShavingMirror + glm::vec3(-0.004F, 0.225F, 0.003F), 0.0055F},
                          Station{kShavingMirror + glm::vec3(0.004F, 0.283F, -0.003F), 0.008F}};
    addBentTube(builder, neck, 10, 12);
}

void addDispenser(MeshBuilder& builder) {
    constexpr glm::vec2 kBottle[] = {
        {0.000F, 0.000F}, {0.032F, 0.000F}, {0.036F, 0.004F}, {0.037F, 0.012F}, {0.037F, 0.100F},
        {0.034F, 0.118F}, {0.020F, 0.128F}, {0.015F, 0.131F}, {0.015F, 0.150F}, {0.006F, 0.153F},
        {0.006F, 0.172F}, {0.011F, 0.175F}, {0.011F, 0.188F}, {0.000F, 0.190F}};
    addStanding(builder, kBottle, 32, 24, kDispenser);
    const std::array nozzle{Station{kDispenser + glm::vec3(0.0F, 0.182F, 0.0F), 0.0065F},
                            Station{kDispenser + glm::vec3(0.04F, 0.184F, 0.0F), 0.006F},
                            Station{kDispenser + glm::vec3(0.058F, 0.172F, 0.0F), 0.005F}};
    addBentTube(builder, nozzle, 12, 14);
}

// A bell, its inside as well, on a rod that reaches into the ceiling's rose.
void addPendant(MeshBuilder& builder) {
    constexpr glm::vec2 kBell[] = {
        {0.000F, 0.170F}, {0.030F, 0.168F}, {0.070F, 0.155F}, {0.125F, 0.110F}, {0.160F, 0.040F},
        {0.168F, 0.004F}, {0.168F, 0.004F}, {0.172F, 0.000F}, {0.172F, 0.000F}, {0.166F, 0.042F},
        {0.131F, 0.114F}, {0.075F, 0.161F}, {0.034F, 0.178F}, {0.022F, 0.190F}, {0.020F, 0.225F},
        {0.014F, 0.240F}, {0.004F, 0.246F}};
    // From the inside of the top outwards, down, and up again on the outside: outside on the right.
    addLathe(builder, smoothed(kBell, 34), 44, placed(kPendant));
    addRod(builder, kPendant + glm::vec3(0.0F, 0.24F, 0.0F),
           {kPendant.x, kRoom.y - 0.004F, kPendant.z}, 0.005F, 10);
}

// --- diffuse: walls, floor, door, window, woodwork, ironware, bottles, basket ---

constexpr float kCellM = 0.125F;  // of walls, so that their vertices can carry soft darkness

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
void addBathroomDoor(MeshBuilder& builder) {
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
void addBathroomWindow(MeshBuilder& builder, MeshBuilder& view) {
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
    addRectangle(view, {middle, 0.5F * (lo.y + hi.y), -kDepth + 0.012F},
                 {0.5F * size.x, 0.0F, 0.0F}, {0.0F, 0.5F * size.y, 0.0F});
}

/// Counter, wall shelves with their brackets, mirror frame, stool.
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
        addPanel(builder, {kRoom.x - 0.26F, top - 0.028F, 2.35F}, {kRoom.x, top, 3.3F}, 0.6F);
    }
    // The mirror's frame, with the glass a little in it.
    constexpr float kLow = 1.17F, kHigh = 2.07F, kHalf = 0.5F, kBar = 0.03F, kOut = 0.03F;
    const float z0 = kVanityZ - kHalf, z1 = kVanityZ + kHalf;
    addPanel(builder, {0.0F, kLow - kBar, z0 - kBar}, {kOut, kLow, z1 + kBar}, 0.6F);
    addPanel(builder, {0.0F, kHigh, z0 - kBar}, {kOut, kHigh + kBar, z1 + kBar}, 0.6F);
    addPanel(builder, {0.0F, kLow, z0 - kBar}, {kOut, kHigh, z0}, 0.6F);
    addPanel(builder, {0.0F, kLow, z1}, {kOut, kHigh, z1 + kBar}, 0.6F);
    // A round stool on three splayed legs.
    constexpr glm::vec2 kSeat[] = {{0.0F, -0.032F},   {0.15F, -0.032F},  {0.163F, -0.024F},
                                   {0.166F, -0.014F}, {0.163F, -0.005F}, {0.152F, 0.0F},
                                   {0.0F, 0.0F}};
    addLathe(builder, smoothed(kSeat, 16), 28, placed(kStool + glm::vec3(0.0F, kStoolM, 0.0F)),
             2.0F);
    for (int i = 0; i < 3; ++i) {
        const glm::vec2 out = ovalAt(static_cast<float>(i) / 3.0F + 0.1F, glm::vec2(1.0F), 0.0F);
        const std::array leg{
            Station{kStool + glm::vec3(0.165F * out.x, 0.003F, 0.165F * out.y), 0.011F},
            Station{kStool + glm::vec3(0.11F * out.x, kStoolM - 0.03F, 0.11F * out.y), 0.016F}};
        builder.addTube(leg, 14, true);
    }
    // The wall cabinet over the cistern; its door is a mirror.
    addPanel(builder, {kRoom.x - 0.15F, 1.34F, kToiletZ - 0.3F}, {kRoom.x, 2.0F, kToiletZ + 0.3F},
             0.6F);
    // The ledge on the polished panel.
    addPanel(builder, {0.0F, kWainscotM - 0.006F, 0.0F},
             {kRoom.x - kShowerRadiusM, kWainscotM + 0.022F, 0.03F}, 0.6F);
}

/// Shower head and arm, flush button, paper holder, brackets: matt black.
void addIronware(MeshBuilder& builder) {
    // The rain shower: arm from the wall, its head over the tiled quarter.
    const glm::vec3 head(kRoom.x - 0.5F, 2.2F, 0.45F);
    const std::array arm{
        Station{{kRoom.x, 2.28F, head.z}, 0.012F}, Station{{head.x + 0.08F, 2.28F, head.z}, 0.012F},
        Station{{head.x, 2.26F, head.z}, 0.012F}, Station{{head.x, 2.2F, head.z}, 0.014F}};
    addBentTube(builder, arm, 12, 10);
    constexpr glm::vec2 kHead[] = {{0.0F, 0.0F},     {0.13F, 0.0F},   {0.14F, 0.004F},
                                   {0.14F, 0.012F},  {0.12F, 0.017F}, {0.03F, 0.024F},
                                   {0.018F, 0.036F}, {0.014F, 0.05F}};
    addLathe(builder, smoothed(kHead, 14), 30, placed(head - glm::vec3(0.0F, 0.04F, 0.0F)));
    // Flush button on the cistern.
    constexpr glm::vec2 kButton[] = {
        {0.025F, 0.0F}, {0.025F, 0.008F}, {0.022F, 0.011F}, {0.0F, 0.012F}};
    addLathe(builder, kButton, 28, placed({kRoom.x - 0.09F, 0.800F, kToiletZ}));
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
    addLathe(builder, smoothed(kRose, 6), 28, placed({kPendant.x, kRoom.y, kPendant.z}));
    // Holders of the wall lamps.
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 at(0.0F, 1.62F, kVanityZ + side * 0.68F);
        constexpr glm::vec2 kPlate[] = {
            {0.05F, 0.0F}, {0.05F, 0.012F}, {0.04F, 0.018F}, {0.0F, 0.018F}};
        addLathe(builder, kPlate, 28, placedAlong(at, {1.0F, 0.0F, 0.0F}));
        const std::array stem{Station{at, 0.009F},
                              Station{at + glm::vec3(0.07F, 0.0F, 0.0F), 0.009F},
                              Station{at + glm::vec3(0.1F, 0.03F, 0.0F), 0.009F},
                              Station{at + glm::vec3(0.1F, 0.075F, 0.0F), 0.02F}};
        addBentTube(builder, stem, 9, 8);
    }
}

void addWallLamps(MeshBuilder& globes) {
    constexpr glm::vec2 kGlobe[] = {
        {0.02F, -0.062F}, {0.046F, -0.046F}, {0.065F, 0.0F}, {0.046F, 0.046F}, {0.0F, 0.065F}};
    for (const float side : {-1.0F, 1.0F}) {
        addLathe(globes, smoothed(kGlobe, 12), 20, placed({0.1F, 1.755F, kVanityZ + side * 0.68F}));
    }
}

void addBulb(MeshBuilder& builder) {
    constexpr glm::vec2 kBulb[] = {{0.0F, 0.02F},   {0.03F, 0.03F},   {0.042F, 0.062F},
                                   {0.03F, 0.095F}, {0.016F, 0.125F}, {0.016F, 0.165F}};
    addLathe(builder, smoothed(kBulb, 12), 16, placed(kPendant));
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
        Outline outline = smoothed(bottle.outline, 15);
        for (glm::vec2& point : outline) point *= glm::vec2(bottle.radius, bottle.height);
        addLathe(builder, outline, 16, placed(bottle.foot));
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
    addLathe(builder, smoothed(outline, 11), 30, placed(kBasket));
}

// --- textiles ---

constexpr glm::vec3 kTerracotta(0.62F, 0.25F, 0.15F);
constexpr glm::vec3 kCream(0.80F, 0.74F, 0.64F);
constexpr glm::vec3 kSage(0.33F, 0.44F, 0.36F);

/// A towel over a rung along z: down in front by `frontM`, behind by `backM`.
struct Hanging {
    glm::vec3 rung;                      // middle of the rung's axis
    float widthM, frontM, backM, overM;  // overM: radius of the bend
};

void addHanging(MeshBuilder& builder, const Hanging& towel, int cellsAcross, int cellsDown) {
    const float bend = kPi * towel.overM;
    const float length = towel.frontM + bend + towel.backM;
    const auto at = [&](float u, float v) {
        // v from the front's hem up, over the rung, and down behind.
        const float z = (0.5F - u) * towel.widthM;
        const float way = v * length;
        float x = towel.overM, y = 0.0F, hung = 0.0F;
        if (way < towel.frontM) {
            hung = (towel.frontM - way) / towel.frontM;
            y = way - towel.frontM;
        } else if (way > towel.frontM + bend) {
            x = -towel.overM;
            y = towel.frontM + bend - way;
        } else {
            const float angleRad = (way - towel.frontM) / towel.overM;
            x = towel.overM * sdf::cosine(angleRad);
            y = towel.overM * sdf::sine(angleRad);
        }
        // Slack folds that grow towards the hem, in front only: behind is the wall.
        const float fold = 0.011F * hung * sdf::sine(17.0F * z + 1.0F) +
                           0.006F * hung * sdf::sine(31.0F * z + 2.0F * hung);
        return towel.rung + glm::vec3(x + fold + 0.006F * hung, y, z);
    };
    addCloth(builder, at, 0.013F, cellsAcross, cellsDown);
}

/// A towel folded into three layers, lying; the folds show at +z and −z.
void addFolded(MeshBuilder& builder, const glm::vec3& base, const glm::vec2& halfSize, float layerM,
               float turnRad, int cells) {
    const float straight = 2.0F * halfSize.y, bend = kPi * 0.5F * layerM;
    const float length = 3.0F * straight + 2.0F * bend;
    const float c = sdf::cosine(turnRad), s = sdf::sine(turnRad);
    const auto at = [&](float u, float v) {
        const float way = v * length;
        const int leg = std::min(static_cast<int>(way / (straight + bend)), 2);
        const float along = way - static_cast<float>(leg) * (straight + bend);
        const float sign = leg % 2 == 0 ? 1.0F : -1.0F;
        float y = (static_cast<float>(leg) + 0.5F) * layerM;
        float z = sign * (std::min(along, straight) - halfSize.y);
        if (along > straight) {
            const float angleRad = (along - straight) / (0.5F * layerM);
            y += 0.5F * layerM * (1.0F - sdf::cosine(angleRad));
            z += sign * 0.5F * layerM * sdf::sine(angleRad);
        }
        const float x = (2.0F * u - 1.0F) * halfSize.x;
        return base + glm::vec3(c * x + s * z, y, c * z - s * x);
    };
    addCloth(builder, at, 0.86F * layerM, 4, cells);
}

/// A towel rolled up, lying along x.
void addRoll(MeshBuilder& builder, const glm::vec3& centre, float halfM, float radius) {
    constexpr float kTurns = 3.25F, kCore = 0.2F;
    const float pitch = radius * (1.0F - kCore) / kTurns;
    const auto at = [&](float u, float v) {
        const float angleRad = 2.0F * kPi * kTurns * v - 0.5F * kPi;
        const float r = radius * kCore + pitch * kTurns * v - 0.5F * pitch;
        return centre + glm::vec3((1.0F - 2.0F * u) * halfM, r * sdf::sine(angleRad),
                                  r * sdf::cosine(angleRad));
    };
    addCloth(builder, at, 0.93F * pitch, 2, 38);
}

/// Over the rail, on the stool, in the basket.
void addTowels(MeshBuilder& builder) {
    constexpr float kRailX = 0.097F;
    builder.setColor(kTerracotta);
    addHanging(builder, {{kRailX, 1.18F, kTowelRailZ}, 0.38F, 0.52F, 0.40F, 0.022F}, 20, 24);
    builder.setColor(kCream);
    addHanging(builder, {{kRailX, 1.48F, kTowelRailZ + 0.03F}, 0.28F, 0.21F, 0.15F, 0.022F}, 14,
               12);
    const glm::vec3 stool = kStool + glm::vec3(0.0F, kStoolM, 0.0F);
    builder.setColor(kSage);
    addFolded(builder, stool, {0.105F, 0.075F}, 0.020F, 0.25F, 36);
    builder.setColor(kCream);
    addFolded(builder, stool + glm::vec3(0.0F, 0.0605F, 0.0F), {0.098F, 0.07F}, 0.018F, 0.42F, 36);
    // Laundry in the basket: a crumpled cloth over a heap, its rim tucked in.
    builder.setColor(kCream * 0.95F);
    const auto heap = [](float u, float v) {
        const glm::vec2 xz = ovalAt(u, glm::vec2(0.178F * v), 0.0F);
        const float crumple =
            0.018F * sdf::sine(31.0F * xz.x + 9.0F * xz.y) * sdf::cosine(27.0F * xz.y) +
            0.010F * sdf::sine(60.0F * xz.y - 20.0F * xz.x);
        const float height = 0.475F - 1.6F * (xz.x * xz.x + xz.y * xz.y) + crumple * (1.0F - v * v);
        return kBasket + glm::vec3(xz.x, height, xz.y);
    };
    // From the rim inwards, so that its outside is up.
    addLoft(builder, [&](float u, float v) { return heap(u, 1.0F - v); }, {30, 12, true, {1, 1}});
}

/// On the shelves.
void addRolledTowels(MeshBuilder& builder) {
    constexpr glm::vec3 kColors[] = {kCream, kSage, kTerracotta};
    constexpr float kRadius = 0.062F, kX = kRoom.x - 0.135F;
    const auto add = [&](int color, float z, float y) {
        builder.setColor(kColors[color]);
        addRoll(builder, {kX, y, z}, 0.105F, kRadius);
    };
    const float upper = kShelvesM[1] + kRadius, lower = kShelvesM[0] + kRadius;
    for (int i = 0; i < 4; ++i) add(i % 2, 2.46F + 0.132F * static_cast<float>(i), upper);
    for (int i = 0; i < 3; ++i) {
        add(i % 2 == 0 ? 2 : 0, 2.526F + 0.132F * static_cast<float>(i), upper + 0.114F);
    }
    for (int i = 0; i < 3; ++i) add(i == 1 ? 1 : 2, 2.92F + 0.132F * static_cast<float>(i), lower);
}

// A woven base with tufts: bent three-sided blades.
void addBathMat(MeshBuilder& builder, Random& random) {
    constexpr glm::vec3 kCentre(1.2F, 0.0F, 1.62F);
    constexpr glm::vec2 kHalf(0.44F, 0.26F);
    constexpr int kColumns = 50, kRows = 30;
    builder.setColor(kCream * 0.62F);
    builder.addBox(kCentre + glm::vec3(0.0F, 0.005F, 0.0F), {kHalf.x, 0.005F, kHalf.y});
    for (int j = 0; j < kRows; ++j) {
        for (int i = 0; i < kColumns; ++i) {
            const float row = static_cast<float>(j) + random.uniform(0.25F, 0.75F);
            const float column = static_cast<float>(i) + random.uniform(0.25F, 0.75F);
            const glm::vec2 cell(column / kColumns, row / kRows);
            const glm::vec2 xz = (2.0F * cell - 1.0F) * (kHalf - 0.01F);
            const glm::vec3 base = kCentre + glm::vec3(xz.x, 0.009F, xz.y);
            const float turn = random.uniform();
            const glm::vec2 lean = ovalAt(random.uniform(), glm::vec2(0.010F), 0.0F);
            const glm::vec3 tip = base + glm::vec3(lean.x, random.uniform(0.016F, 0.024F), lean.y);
            // A stripe along both ends.
            const bool isStripe = std::abs(std::abs(xz.x) - 0.33F) < 0.03F;
            builder.setColor((isStripe ? kTerracotta : kCream) * random.uniform(0.85F, 1.1F));
            std::array<glm::vec3, 4> positions, normals;
            positions[3] = tip;
            normals[3] = glm::vec3(0.0F, 1.0F, 0.0F);
            for (int k = 0; k < 3; ++k) {
                const glm::vec2 out =
                    ovalAt(turn + static_cast<float>(k) / 3.0F, glm::vec2(1.0F), 0.0F);
                positions[static_cast<std::size_t>(k)] =
                    base + glm::vec3(out.x * 0.0105F, 0.0F, out.y * 0.0105F);
                normals[static_cast<std::size_t>(k)] =
                    glm::normalize(glm::vec3(out.x, 0.9F, out.y));
            }
            constexpr glm::uvec3 kSides[] = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
            builder.addIndexed(positions, normals, kSides);
        }
    }
}

// --- light between things ---

/// What takes light from others: an upright box or an elliptic cylinder.
struct Occluder {
    glm::vec3 min, max;
    bool isRound = false;
};
constexpr int kDirections = 64;
constexpr float kRangeM = 0.9F;     // what is further away takes nothing
constexpr float kStrength = 0.85F;  // what is shut in on all sides keeps the rest
constexpr float kLiftM = 0.015F;  // rays start off the surface, whose own solid is only roughly it

/// Even over the cosine around +y: points of a Vogel spiral on the disc, lifted to the hemisphere.
std::array<glm::vec3, kDirections> hemisphere() {
    constexpr float kGoldenAngleRad = 2.39996323F;
    std::array<glm::vec3, kDirections> directions;
    for (int i = 0; i < kDirections; ++i) {
        const float squared = (static_cast<float>(i) + 0.5F) / static_cast<float>(kDirections);
        const float radius = std::sqrt(squared);
        const float angleRad = kGoldenAngleRad * static_cast<float>(i);
        directions[static_cast<std::size_t>(i)] = {radius * sdf::cosine(angleRad),
                                                   std::sqrt(1.0F - squared),
                                                   radius * sdf::sine(angleRad)};
    }
    return directions;
}

struct Interval {
    float low = 0.0F;
    float high = std::numeric_limits<float>::infinity();

    void cut(float a, float b) {
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
    }
};

void cutSlab(Interval& interval, float origin, float direction, float min, float max) {
    if (std::abs(direction) > 1e-6F) {
        interval.cut((min - origin) / direction, (max - origin) / direction);
    } else if (origin < min || origin > max) {
        interval.high = -1.0F;
    }
}

/// Where the ray enters the solid; infinite where it does not.
float distanceTo(const Occluder& occluder, const glm::vec3& origin, const glm::vec3& direction) {
    Interval interval;
    cutSlab(interval, origin.y, direction.y, occluder.min.y, occluder.max.y);
    if (occluder.isRound) {
        const glm::vec3 half = 0.5F * (occluder.max - occluder.min);
        const glm::vec3 o = (origin - 0.5F * (occluder.max + occluder.min)) / half;
        const glm::vec3 d = direction / half;
        const float a = d.x * d.x + d.z * d.z, b = o.x * d.x + o.z * d.z;
        const float c = o.x * o.x + o.z * o.z - 1.0F;
        const float discriminant = b * b - a * c;
        if (discriminant < 0.0F || (a < 1e-6F && c > 0.0F)) {
            interval.high = -1.0F;
        } else if (a >= 1e-6F) {
            const float root = std::sqrt(discriminant);
            interval.cut((-b - root) / a, (-b + root) / a);
        }
    } else {
        cutSlab(interval, origin.x, direction.x, occluder.min.x, occluder.max.x);
        cutSlab(interval, origin.z, direction.z, occluder.min.z, occluder.max.z);
    }
    return interval.low < interval.high ? interval.low : std::numeric_limits<float>::infinity();
}

float distanceToWalls(const glm::vec3& origin, const glm::vec3& direction) {
    Interval interval;
    for (int axis = 0; axis < 3; ++axis) {
        cutSlab(interval, origin[axis], direction[axis], 0.0F, kRoom[axis]);
    }
    return std::max(interval.high, 0.0F);
}

float opennessAt(const glm::vec3& position, const glm::vec3& normal,
                 std::span<const Occluder> occluders,
                 std::span<const glm::vec3, kDirections> directions) {
    const glm::vec3 origin = glm::clamp(position + normal * kLiftM, glm::vec3(0.0F), kRoom);
    const glm::vec3 axis = std::abs(normal.y) < 0.8F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(axis, normal));
    const glm::mat3 frame(tangent, normal, glm::cross(tangent, normal));
    float taken = 0.0F;
    for (const glm::vec3& local : directions) {
        const glm::vec3 direction = frame * local;
        float distance = distanceToWalls(origin, direction);
        for (const Occluder& occluder : occluders) {
            // Zero: the ray starts within, on the occluder's own surface.
            const float entry = distanceTo(occluder, origin, direction);
            if (entry > 0.0F) distance = std::min(distance, entry);
        }
        const float nearness = std::max(0.0F, 1.0F - distance / kRangeM);
        taken += nearness * nearness;
    }
    return 1.0F - kStrength * taken / static_cast<float>(kDirections);
}

/// Vertex colours darkened by what is near: the shading has no shadows, and things would float.
void darken(Mesh& mesh, std::span<const Occluder> occluders) {
    const auto directions = hemisphere();
    // Only what is near the mesh matters.
    Box reach = mesh.bounds();
    std::vector<Occluder> near;
    for (const Occluder& occluder : occluders) {
        const glm::vec3 apart = glm::max(occluder.min - reach.max, reach.min - occluder.max);
        if (std::max({apart.x, apart.y, apart.z}) < kRangeM) near.push_back(occluder);
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.colors[i] *= opennessAt(mesh.positions[i], mesh.normals[i], near, directions);
    }
}

// --- the room ---

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
        if (triangles > 0) mesh = exactly(std::move(mesh), triangles);
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
        mesh = exactly(std::move(mesh), triangles - others);
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

void addBathroomShell(Room& room, std::uint64_t seed) {
    MeshBuilder builder, view;
    addTiledWalls(builder);
    room.addDiffuse(builder, "wall_tiles", glm::vec3(1.0F),
                    room.addTexture(glazedTilesTexture(
                        {{0.94F, 0.95F, 0.93F}, {0.76F, 0.77F, 0.75F}, 3, 6, 0.03F}, seed)));
    addPaintedWalls(builder);
    room.addDiffuse(builder, "painted_walls", {0.72F, 0.74F, 0.68F});
    addFloor(builder);
    room.addDiffuse(
        builder, "floor", glm::vec3(1.0F),
        room.addTexture(tilesTexture({0.50F, 0.52F, 0.54F}, {0.36F, 0.37F, 0.38F}, 4, seed + 1)));
    addBathroomDoor(builder);
    room.addDiffuse(builder, "door", {0.78F, 0.79F, 0.76F});
    addBathroomWindow(builder, view);
    room.addDiffuse(builder, "window", {0.86F, 0.86F, 0.84F});
    Material outdoors = glowing(glm::vec3(1.0F), glm::vec3(0.0F));
    outdoors.baseColorTexture = room.addTexture(outdoorsTexture(seed + 2));
    outdoors.baseColor = glm::vec4(1.9F, 1.9F, 1.9F, 1.0F);  // as bright as day
    room.add(view, "outdoors", outdoors);
}

void addFurniture(Room& room, Random& random, std::uint64_t seed) {
    MeshBuilder builder;
    const int wood =
        room.addTexture(woodTexture({0.52F, 0.36F, 0.22F}, {0.72F, 0.54F, 0.36F}, seed + 3));
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
    addLathe(builder, smoothed(kPotOutline, 14), 26, placed(kPot));
    room.addDiffuse(builder, "pot", {0.6F, 0.56F, 0.5F});
    addPalm(builder, 1.15F, 8, 2, random, placed(kPot + glm::vec3(0, 0.17F, 0)));
    room.add(builder, "palm", foliage());
    for (glm::vec3& position : room.scene.meshes.back().positions)
        position = clearOfWalls(position);
    constexpr glm::vec2 kPaper[] = {{0.022F, -0.05F}, {0.055F, -0.05F}, {0.055F, -0.05F},
                                    {0.055F, 0.05F},  {0.055F, 0.05F},  {0.022F, 0.05F}};
    addLathe(builder, kPaper, 32,
             placedAlong({kRoom.x - 0.075F, 0.74F, kToiletZ + 0.42F}, {0, 0, 1}));
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

Moving addBathroomReflectors(Room& room, std::uint64_t seed) {
    constexpr glm::vec3 kCeramic(0.86F, 0.86F, 0.84F), kSteel(0.55F, 0.56F, 0.58F);
    constexpr float kGlazed = 0.3F, kChrome = 0.85F;
    MeshBuilder builder;
    const glm::vec3 zHalf(0.0F, 0.0F, -0.5F);
    addRectangle(builder, {0.02F, 1.62F, kVanityZ}, zHalf, {0.0F, 0.45F, 0.0F});
    room.addReflector(builder, "mirror", kSteel, 0.92F, 128);
    const float panelHalf = 0.5F * (kRoom.x - kShowerRadiusM);
    addRectangle(builder, {panelHalf, 0.5F * kWainscotM, 0.004F}, {panelHalf, 0.0F, 0.0F},
                 {0.0F, 0.5F * kWainscotM, 0.0F}, {2.3F, 1.0F});
    const int marble =
        room.addTexture(marbleTexture({0.80F, 0.78F, 0.74F}, {0.45F, 0.42F, 0.40F}, seed + 4));
    room.addReflector(builder, "wall_panel", glm::vec3(1.0F), 0.3F, 256, marble);
    addRectangle(builder, {kRoom.x - 0.154F, 1.67F, kToiletZ}, {0.0F, 0.0F, 0.285F},
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

void addBathroomLights(Scene& scene) {
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

void addBathroomCameras(Scene& scene) {
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

Scene bathroom(Params& params, std::uint64_t seed) {
    params.finish();
    Room room;
    Random random(seed, 11);
    addBathroomShell(room, seed);
    addFurniture(room, random, seed);
    const int towels = addTextiles(room, random);
    MeshBuilder builder;
    addBulb(builder);
    const int bulb = room.add(builder, "bulb", glowing(glm::vec3(1.0F), {0.7F, 0.65F, 0.55F}));
    room.fill(towels, false, kDiffuseTriangles);
    const Moving moving = addBathroomReflectors(room, seed);
    Scene& scene = room.scene;
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        if (scene.materials[i].emissive == glm::vec3(0.0F)) darken(scene.meshes[i], kOccluders);
    }
    addBathroomLights(scene);
    addBathroomCameras(scene);
    const glm::vec3 swing(0.07F, 0.0F, 0.03F), up(0.0F, 1.0F, 0.0F);
    constexpr float kTwoPi = 2.0F * std::numbers::pi_v<float>;
    scene.motions = {{moving.pendant, kPendant, up, 0.0F, swing, 6.0F},
                     {bulb, kPendant, up, 0.0F, swing, 6.0F},
                     {moving.dispenser, kDispenser, up, 2.0F * kTwoPi, glm::vec3(0.0F), 1.0F},
                     {moving.shavingMirror, kShavingMirror, up, 0.5F, glm::vec3(0.0F), 1.0F}};
    return scene;
}

}  // namespace gfxrepro::scene
